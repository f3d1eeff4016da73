//! Auto-disable: bodies that stay slow fall asleep (ODE manual, "Automatic enabling and disabling").

use crate::body::Body;
use ferrode_math::Vec3;

/// When a body disables itself. A body without joints (contacts included) never does.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AutoDisable {
    /// Whether it does at all.
    pub enabled: bool,
    /// Linear speed in m/s up to which the body counts as idle; ∞ to ignore it.
    pub linear_threshold: f64,
    /// Angular speed in rad/s up to which the body counts as idle; ∞ to ignore it.
    pub angular_threshold: f64,
    /// Steps in a row that it must be idle; 0 or less to ignore them.
    pub steps: i32,
    /// Seconds in a row that it must be idle; 0 to ignore them.
    pub time: f64,
    /// Steps over which the velocities are averaged; 0 never disables.
    pub average_samples: u32,
}

impl Default for AutoDisable {
    fn default() -> Self {
        Self {
            enabled: false,
            linear_threshold: 0.01,
            angular_threshold: 0.01,
            steps: 10,
            time: 0.0,
            average_samples: 1,
        }
    }
}

/// How long a body has been idle, and the velocities it is judged by.
#[derive(Clone, Debug, Default)]
pub(crate) struct Idleness {
    pub steps_left: i32,
    pub time_left: f64,
    samples: Vec<(Vec3, Vec3)>,
    next: usize,
    full: bool,
}

impl Idleness {
    pub fn new(settings: &AutoDisable) -> Self {
        let mut idleness = Self::default();
        idleness.restart(settings);
        idleness
    }

    /// Starts both countdowns again.
    pub fn restart(&mut self, settings: &AutoDisable) {
        self.steps_left = settings.steps;
        self.time_left = settings.time;
    }

    /// Forgets the velocities seen so far, as a change of the sample count does.
    pub fn forget_samples(&mut self) {
        self.samples.clear();
        self.next = 0;
        self.full = false;
    }

    /// Takes this step's velocities in; true once the averages over all samples are idle.
    fn is_idle(&mut self, settings: &AutoDisable, linear: Vec3, angular: Vec3) -> bool {
        let count = settings.average_samples as usize;
        if self.samples.len() != count {
            self.samples.resize(count, (Vec3::ZERO, Vec3::ZERO));
        }
        self.samples[self.next] = (linear, angular);
        self.next += 1;
        if self.next == count {
            self.next = 0;
            self.full = true;
        }
        if !self.full {
            return false;
        }
        let (mut v, mut w) = self.samples[0];
        for (linear, angular) in &self.samples[1..] {
            v += *linear;
            w += *angular;
        }
        if count > 1 {
            let k = 1.0 / count as f64;
            v *= k;
            w *= k;
        }
        let (linear, angular) = (settings.linear_threshold, settings.angular_threshold);
        v.length_squared() <= linear * linear && w.length_squared() <= angular * angular
    }
}

impl Body {
    /// Judges the body once, at the start of a step of `h` seconds, and disables it if its time has come.
    pub(crate) fn update_auto_disable(&mut self, h: f64) {
        let settings = self.auto_disable;
        if self.joint_count == 0 || !settings.enabled || !self.enabled || settings.average_samples == 0 {
            return;
        }
        let (v, w) = (self.frame.linear_velocity, self.frame.angular_velocity);
        if self.idleness.is_idle(&settings, v, w) {
            self.idleness.steps_left = self.idleness.steps_left.saturating_sub(1);
            self.idleness.time_left -= h;
        } else {
            self.idleness.restart(&settings);
        }
        if self.idleness.steps_left <= 0 && self.idleness.time_left <= 0.0 {
            self.enabled = false;
            self.frame.linear_velocity = Vec3::ZERO;
            self.frame.angular_velocity = Vec3::ZERO;
        }
    }
}
