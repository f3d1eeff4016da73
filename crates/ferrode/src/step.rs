//! One step of a world with shapes.

use crate::{Error, World};
use ferrode_dynamics::{StepReport, StepTimes, Stepper};

/// What happened in a step.
#[derive(Clone, Debug, Default, PartialEq)]
#[non_exhaustive]
pub struct Step {
    /// Pairs of geoms whose boxes overlapped.
    pub pairs: usize,
    /// Contact points.
    pub contacts: usize,
    /// Deepest penetration found at the start of the step, in metres.
    pub max_depth: f64,
    /// The stepping of bodies and joints.
    pub dynamics: StepReport,
}

impl World {
    /// Advances the world by `h` seconds: broad phase → narrow phase → contact joints → step → events.
    ///
    /// With [`Stepper::Substep`] pairs and contacts are kept from step to step, no contact joints are made, and geoms' poses
    /// in [`World::colliders`] follow their bodies only when [`World::sync_geoms`] or [`World::queries`] asks them to.
    ///
    /// Keep `h` constant; see [`FixedStep`](crate::FixedStep).
    ///
    /// # Errors
    /// [`Error::Dynamics`] for a step that is not positive and finite; nothing is stepped then.
    pub fn step(&mut self, h: f64) -> Result<Step, Error> {
        self.dynamics.impulse_to_force(h, ferrode_math::Vec3::ZERO)?;
        self.last_h = h;
        let clock = self.dynamics.step_clock();
        let start = clock.map(|clock| clock());
        let done = self.step_with_stepper(h);
        if let (Some(clock), Some(start), Some(times)) = (clock, start, self.dynamics.step_times()) {
            // All that is not the stepping of bodies.
            self.collision_time = clock() - start - times.total();
        }
        done
    }

    /// Where the time of the last step went; `None` without a [clock](ferrode_dynamics::World::set_step_clock).
    pub fn step_times(&self) -> Option<StepTimes> {
        let mut times = self.dynamics.step_times()?;
        times.collision = self.collision_time.max(0.0);
        Some(times)
    }

    fn step_with_stepper(&mut self, h: f64) -> Result<Step, Error> {
        if self.stepper == Stepper::Substep {
            return self.step_substep(h);
        }
        let mut scratch = core::mem::take(&mut self.scratch);
        let result = self.step_with(h, &mut scratch);
        self.scratch = scratch;
        result
    }

    fn step_with(&mut self, h: f64, scratch: &mut crate::world::Scratch) -> Result<Step, Error> {
        self.lazy_contacts.take();
        self.sync_geoms();
        self.find_pairs(scratch)?;
        self.make_contacts(scratch)?;
        let dynamics = self.dynamics.step(self.stepper, h)?;
        self.finish_contacts()?;
        self.find_events(&mut scratch.touching);
        self.sync_geoms();
        self.advance_clock(h);
        Ok(Step {
            pairs: scratch.pairs.len(),
            contacts: self.contacts.len(),
            max_depth: self.contacts.iter().map(|c| c.point.depth).fold(0.0, f64::max),
            dynamics,
        })
    }

    /// Counts the step. The times are summed with compensation (Kahan, 1965), so that a thousand steps of 1 ms are 1 s.
    pub(crate) fn advance_clock(&mut self, h: f64) {
        let step = h - self.time_rest;
        let sum = self.time + step;
        self.time_rest = (sum - self.time) - step;
        self.time = sum;
        self.steps += 1;
    }
}
