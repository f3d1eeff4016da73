//! Constant steps for a program whose frames take as long as they take.

use ferrode_dynamics::Error;

/// Turns frame times into whole steps of constant size.
///
/// Steps of varying size are bad for a simulation (ODE manual, "Variable step size"): a resting contact settles at another
/// depth for each size, so it trembles. Step with a constant size instead, as often as the frame time asks, and draw the state
/// between the last two steps.
///
/// ```
/// use ferrode::FixedStep;
/// # fn main() -> Result<(), ferrode::Error> {
/// let mut clock = FixedStep::new(0.01)?;
/// let (steps, alpha) = clock.advance(0.025);
/// assert_eq!(steps, 2);
/// assert!((alpha - 0.5).abs() < 1e-12); // draw halfway between the last two states
/// # Ok(()) }
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FixedStep {
    step: f64,
    left: f64,
    max_steps: u32,
}

impl FixedStep {
    /// A clock with steps of `step` seconds, and at most 8 steps a frame.
    ///
    /// # Errors
    /// [`Error::OutOfRange`] unless the step is positive and finite.
    pub fn new(step: f64) -> Result<Self, crate::Error> {
        if !(step > 0.0 && step.is_finite()) {
            let expected = "a positive number of seconds";
            return Err(Error::OutOfRange { what: "step size", value: step, expected }.into());
        }
        Ok(Self { step, left: 0.0, max_steps: 8 })
    }

    /// The same clock with another limit of steps a frame. What a frame asks beyond it is dropped: the simulation then
    /// runs slower than real time instead of falling ever further behind.
    #[must_use]
    pub fn with_max_steps(mut self, max_steps: u32) -> Self {
        self.max_steps = max_steps.max(1);
        self
    }

    /// The step size in seconds.
    pub fn step(&self) -> f64 {
        self.step
    }

    /// Takes a frame of `frame_time` seconds in; returns how many steps to make now, and how far the present lies
    /// between the last two states: 0 at the one before last, 1 at the last.
    ///
    /// Negative and non-finite times count as none.
    pub fn advance(&mut self, frame_time: f64) -> (u32, f64) {
        if frame_time > 0.0 && frame_time.is_finite() {
            self.left += frame_time;
        }
        let wanted = (self.left / self.step).floor();
        let steps = wanted.min(f64::from(self.max_steps));
        self.left -= wanted * self.step;
        // Rounding may leave a hair below zero or at a whole step.
        self.left = self.left.clamp(0.0, self.step);
        (steps as u32, self.left / self.step)
    }
}

#[cfg(test)]
mod tests {
    use super::FixedStep;

    #[test]
    fn all_time_is_stepped() {
        let mut clock = FixedStep::new(0.01).unwrap();
        let total: u32 = (0..1000).map(|i| clock.advance(0.003 + 0.002 * f64::from(i % 3)).0).sum();
        // Frames of 3, 5 and 7 ms: 5 s in 1000 frames, less the part of a step that is left.
        assert!((499..=500).contains(&total), "{total}");
    }

    #[test]
    fn hiccups_are_dropped() {
        let mut clock = FixedStep::new(0.01).unwrap().with_max_steps(4);
        assert_eq!(clock.advance(10.0).0, 4);
        assert_eq!(clock.advance(0.0).0, 0, "the rest is not made up for");
        assert_eq!(clock.advance(f64::NAN).0, 0);
        assert!(FixedStep::new(-1.0).is_err());
    }
}
