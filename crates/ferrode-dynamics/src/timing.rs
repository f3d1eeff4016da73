//! Where the time of a step goes, by a clock that the caller lends: the engine has none of its own, and no result depends on it.

use crate::World;

/// Tells the seconds since some moment.
pub type StepClock = fn() -> f64;

/// Where the time of a step went, s.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[non_exhaustive]
pub struct StepTimes {
    /// Finding pairs and contacts; 0 for a world without shapes.
    pub collision: f64,
    /// Finding islands, gathering bodies, writing rows.
    pub assembly: f64,
    /// Finding the constraint forces. `Substep` moves its copies of the bodies meanwhile.
    pub solve: f64,
    /// Velocities, poses, callbacks, sleep.
    pub integrate: f64,
}

impl StepTimes {
    /// The sum of the phases.
    pub fn total(&self) -> f64 {
        self.collision + self.assembly + self.solve + self.integrate
    }
}

/// A phase of [`StepTimes`] that happens in this crate.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Phase {
    Assembly,
    Solve,
    Integrate,
}

/// The stopwatch of a world: without a clock it costs one comparison a phase.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Timing {
    clock: Option<StepClock>,
    /// When the running phase began.
    mark: f64,
    times: StepTimes,
}

impl Timing {
    pub fn begin(&mut self) {
        if let Some(clock) = self.clock {
            (self.times, self.mark) = (StepTimes::default(), clock());
        }
    }

    /// The time since the last call was spent on a phase.
    pub fn spent_on(&mut self, phase: Phase) {
        let Some(clock) = self.clock else { return };
        let now = clock();
        let total = match phase {
            Phase::Assembly => &mut self.times.assembly,
            Phase::Solve => &mut self.times.solve,
            Phase::Integrate => &mut self.times.integrate,
        };
        *total += now - self.mark;
        self.mark = now;
    }
}

impl World {
    /// Lends a clock, by which steps from now on measure their phases; `None`, as in a new world, for no measuring. A clone
    /// has the same clock.
    ///
    /// ```
    /// use ferrode_dynamics::{Stepper, World};
    /// use std::{sync::LazyLock, time::Instant};
    /// # fn main() -> Result<(), ferrode_dynamics::Error> {
    /// fn seconds() -> f64 {
    ///     static START: LazyLock<Instant> = LazyLock::new(Instant::now);
    ///     START.elapsed().as_secs_f64()
    /// }
    /// let mut world = World::new();
    /// world.create_body();
    /// world.set_step_clock(Some(seconds));
    /// world.step(Stepper::Direct, 0.01)?;
    /// println!("{:?}", world.step_times());
    /// # Ok(()) }
    /// ```
    pub fn set_step_clock(&mut self, clock: Option<StepClock>) {
        self.timing = Timing { clock, ..Timing::default() };
    }

    /// The clock that was lent.
    pub fn step_clock(&self) -> Option<StepClock> {
        self.timing.clock
    }

    /// Where the time of the last step went; `None` without a [clock](World::set_step_clock). All zero before the first step.
    pub fn step_times(&self) -> Option<StepTimes> {
        self.timing.clock.map(|_| self.timing.times)
    }
}

#[cfg(test)]
mod tests {
    use crate::{Stepper, World};
    use ferrode_math::Vec3;
    use std::cell::Cell;

    thread_local!(static CALLS: Cell<u32> = const { Cell::new(0) });

    /// A second a call: times count the phases.
    fn calls() -> f64 {
        CALLS.with(|calls| calls.replace(calls.get() + 1).into())
    }

    fn two_islands() -> World {
        let mut world = World::new();
        world.set_gravity(Vec3::new(0.0, 0.0, -9.81)).unwrap();
        for n in 0..2 {
            let body = world.create_body();
            world.body_mut(body).unwrap().set_position(Vec3::new(f64::from(n), 0.0, 0.0)).unwrap();
            let joint = world.create_joint::<crate::Ball>(None).unwrap();
            world.attach(joint, Some(body), None).unwrap();
        }
        world
    }

    #[test]
    fn phases_take_the_time_between_calls_of_the_clock() {
        // `Quick` takes two islands in, and solves both at once; `Direct` does all with both, since they are alike.
        let [both, one] = [[2.0, 3.0, 2.0], [1.0, 1.0, 1.0]];
        for (stepper, phases) in [(Stepper::Direct, one), (Stepper::Quick, both), (Stepper::Substep, one)] {
            let mut world = two_islands();
            world.step(stepper, 0.01).unwrap();
            assert_eq!(world.step_times(), None);
            world.set_step_clock(Some(calls));
            assert_eq!(world.step_times().map(|times| times.total()), Some(0.0));
            for _ in 0..2 {
                world.step(stepper, 0.01).unwrap();
                let times = world.step_times().unwrap();
                assert_eq!([times.assembly, times.solve, times.integrate], phases, "{stepper:?}");
                assert_eq!(times.collision, 0.0);
            }
            world.set_step_clock(None);
            assert_eq!(world.step_times(), None);
        }
    }

    #[test]
    fn a_clock_changes_no_bit() {
        for stepper in [Stepper::Direct, Stepper::Quick, Stepper::Substep] {
            let (mut plain, mut timed) = (two_islands(), two_islands());
            timed.set_step_clock(Some(calls));
            for _ in 0..20 {
                assert_eq!(plain.step(stepper, 0.01), timed.step(stepper, 0.01));
            }
            let places = |world: &World| -> Vec<_> {
                world.bodies().map(|(_, body)| body.position().to_array().map(f64::to_bits)).collect()
            };
            assert_eq!(places(&plain), places(&timed));
        }
    }
}
