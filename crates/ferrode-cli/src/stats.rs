//! What a run was like, gathered step by step.

use crate::simulation::Simulation;
use ferrode::{Energy, Step};
use ferrode_scene::description::JointId;
use std::time::Duration;

/// The largest of some values, and where and when it was seen.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Largest {
    /// The value; 0 if there was none.
    pub value: f64,
    /// Simulated time, s.
    pub time: f64,
    /// Index of the thing that had it.
    pub index: usize,
}

impl Largest {
    /// Whether this value is the largest now.
    fn see(&mut self, value: f64, time: f64, index: usize) -> bool {
        // A value that is no number would hide behind every comparison: the worst there is.
        let larger = value > self.value || (value.is_nan() && !self.value.is_nan());
        if larger {
            *self = Self { value, time, index };
        }
        larger
    }
}

/// What a run was like.
#[derive(Clone, Debug, Default)]
pub struct Stats {
    /// Steps made.
    pub steps: u64,
    /// Simulated time, s.
    pub time: f64,
    /// What each step took, ns.
    step_times: Vec<u64>,
    contacts: u64,
    /// Most contact points in a step.
    pub contacts_max: usize,
    /// At the start.
    pub energy_start: Energy,
    /// At the end.
    pub energy_end: Energy,
    /// Largest kinetic energy, J.
    pub max_kinetic: f64,
    /// Largest distance of the energy from that at the start, J.
    pub energy_error: Largest,
    /// Deepest penetration, m.
    pub penetration: Largest,
    /// The links that it is between.
    pub penetration_between: Option<[String; 2]>,
    /// Largest distance between the two sides of a joint, m.
    pub joint_position_error: Largest,
    /// Largest angle between the two sides of a joint, rad.
    pub joint_angle_error: Largest,
    /// Islands that the direct solver gave up on, all steps together.
    pub solver_failures: u64,
    /// Bodies asleep at the end.
    pub sleeping: usize,
    /// Bodies taken out, each counted when it happened.
    pub quarantined: usize,
}

impl Stats {
    /// Before the first step of about `steps`.
    pub fn start(simulation: &Simulation, steps: u64) -> Self {
        let energy = simulation.world().energy();
        Self {
            // A run may be asked to take forever; its memory is not taken beforehand.
            step_times: Vec::with_capacity(steps.min(1 << 20) as usize),
            energy_start: energy,
            energy_end: energy,
            max_kinetic: energy.kinetic,
            ..Self::default()
        }
    }

    /// After a step that took `duration`.
    pub fn see(&mut self, simulation: &Simulation, step: &Step, duration: Duration) {
        self.steps += 1;
        let time = simulation.world().time();
        self.time = time;
        self.step_times.push(u64::try_from(duration.as_nanos()).unwrap_or(u64::MAX));
        self.contacts += step.contacts as u64;
        self.contacts_max = self.contacts_max.max(step.contacts);
        if self.penetration.see(step.max_depth, time, 0) {
            self.penetration_between = simulation.deepest_contact();
        }
        self.solver_failures += step.dynamics.lcp_failures as u64;
        self.quarantined += step.dynamics.quarantined.len();
        let energy = simulation.world().energy();
        self.energy_error.see((energy.total() - self.energy_start.total()).abs(), time, 0);
        self.max_kinetic = self.max_kinetic.max(energy.kinetic);
        self.energy_end = energy;
        for index in 0..simulation.scene().joints.len() {
            if let Some((position, angle)) = simulation.joint_error(JointId(index)) {
                self.joint_position_error.see(position, time, index);
                self.joint_angle_error.see(angle, time, index);
            }
        }
    }

    /// After the last step.
    pub fn finish(&mut self, simulation: &Simulation) {
        self.sleeping = simulation.world().bodies().filter(|(_, body)| !body.is_enabled()).count();
        self.quarantined = self.quarantined.max(simulation.quarantined().len());
    }

    /// Whether everything stayed finite.
    pub fn is_finite(&self) -> bool {
        self.quarantined == 0 && self.energy_end.total().is_finite() && self.penetration.value.is_finite()
    }

    /// Time that all steps took, s.
    pub fn wall(&self) -> f64 {
        self.step_times.iter().map(|ns| *ns as f64).sum::<f64>() / 1e9
    }

    /// Simulated time over the time it took.
    pub fn real_time_factor(&self) -> f64 {
        let wall = self.wall();
        if wall > 0.0 { self.time / wall } else { 0.0 }
    }

    /// Contact points a step.
    pub fn contacts_mean(&self) -> f64 {
        if self.steps > 0 { self.contacts as f64 / self.steps as f64 } else { 0.0 }
    }

    /// The time below which the given part of the steps stayed (nearest rank), s; 0 without steps.
    pub fn step_time_quantile(&self, part: f64) -> f64 {
        let mut sorted = self.step_times.clone();
        sorted.sort_unstable();
        let rank = (part * sorted.len() as f64).ceil() as usize;
        sorted.get(rank.max(1) - 1).map_or(0.0, |ns| *ns as f64 / 1e9)
    }

    /// What the energy has changed by, J.
    pub fn energy_change(&self) -> f64 {
        self.energy_end.total() - self.energy_start.total()
    }
}

#[cfg(test)]
mod tests {
    use super::{Largest, Stats};

    #[test]
    fn quantiles_are_by_nearest_rank() {
        let mut stats = Stats { step_times: (1..=200).rev().collect(), ..Stats::default() };
        assert_eq!(stats.step_time_quantile(0.5), 100e-9);
        assert_eq!(stats.step_time_quantile(0.99), 198e-9);
        stats.step_times = vec![7];
        assert_eq!(stats.step_time_quantile(0.99), 7e-9);
        stats.step_times.clear();
        assert_eq!((stats.step_time_quantile(0.5), stats.real_time_factor()), (0.0, 0.0));
    }

    #[test]
    fn no_number_is_the_largest_number() {
        let mut largest = Largest::default();
        largest.see(2.0, 0.1, 0);
        largest.see(f64::NAN, 0.2, 1);
        largest.see(3.0, 0.3, 2);
        assert!(largest.value.is_nan() && largest.index == 1);
    }
}
