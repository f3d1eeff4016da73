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
    times: StepTimes,
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
            times: StepTimes::with_capacity(steps),
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
        self.times.push(duration);
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
        self.times.total.as_secs_f64()
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

    /// The time below which the given part of the steps stayed, s; 0 without steps.
    pub fn step_time_quantile(&self, part: f64) -> f64 {
        self.times.quantile(part)
    }

    /// What the energy has changed by, J.
    pub fn energy_change(&self) -> f64 {
        self.energy_end.total() - self.energy_start.total()
    }
}

/// What steps took: of all, or of each n-th if they are many, so that long runs don't fill the memory.
#[derive(Clone, Debug)]
struct StepTimes {
    /// ns
    kept: Vec<u64>,
    /// Each so many are kept.
    stride: u64,
    seen: u64,
    total: Duration,
}

impl Default for StepTimes {
    fn default() -> Self {
        Self { kept: Vec::new(), stride: 1, seen: 0, total: Duration::ZERO }
    }
}

impl StepTimes {
    /// Most times that are kept.
    const MOST: usize = 1 << 20;

    fn with_capacity(steps: u64) -> Self {
        let capacity = usize::try_from(steps).unwrap_or(Self::MOST).min(Self::MOST);
        Self { kept: Vec::with_capacity(capacity), ..Self::default() }
    }

    fn push(&mut self, duration: Duration) {
        self.total += duration;
        if self.seen.is_multiple_of(self.stride) {
            if self.kept.len() == Self::MOST {
                let mut number = 0;
                self.kept.retain(|_| {
                    number += 1;
                    number % 2 == 1
                });
                self.stride *= 2;
            }
            if self.seen.is_multiple_of(self.stride) {
                self.kept.push(u64::try_from(duration.as_nanos()).unwrap_or(u64::MAX));
            }
        }
        self.seen += 1;
    }

    /// By nearest rank.
    fn quantile(&self, part: f64) -> f64 {
        let mut sorted = self.kept.clone();
        sorted.sort_unstable();
        let rank = (part * sorted.len() as f64).ceil() as usize;
        sorted.get(rank.max(1) - 1).map_or(0.0, |ns| *ns as f64 / 1e9)
    }
}

#[cfg(test)]
mod tests {
    use super::{Largest, StepTimes};
    use std::time::Duration;

    #[test]
    fn quantiles_are_by_nearest_rank() {
        let mut times = StepTimes::default();
        assert_eq!(times.quantile(0.5), 0.0);
        times.push(Duration::from_nanos(7));
        assert_eq!(times.quantile(0.99), 7e-9);
        let mut times = StepTimes::default();
        (1..=200).rev().for_each(|ns| times.push(Duration::from_nanos(ns)));
        assert_eq!((times.quantile(0.5), times.quantile(0.99)), (100e-9, 198e-9));
        assert_eq!(times.total, Duration::from_nanos(200 * 201 / 2));
    }

    #[test]
    fn long_runs_keep_each_nth_step() {
        let mut times = StepTimes::default();
        let steps = 5 * StepTimes::MOST as u64;
        (0..steps).for_each(|ns| times.push(Duration::from_nanos(ns)));
        assert_eq!(times.stride, 8);
        assert!(times.kept.len() <= StepTimes::MOST);
        assert!(times.kept.iter().enumerate().all(|(index, ns)| *ns == 8 * index as u64));
        assert_eq!(times.total, Duration::from_nanos(steps * (steps - 1) / 2));
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
