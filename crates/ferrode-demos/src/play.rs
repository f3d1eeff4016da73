//! A running scene: a world, what drives it, and what is measured.

use crate::{Failure, verdict::Findings};
use ferrode::World;

type Done = Result<(), Failure>;

/// State of a scene's own, with what acts before and after each step, and what judges at the end.
#[derive(Clone)]
struct Scripted<S> {
    state: S,
    before: fn(&mut S, &mut World) -> Done,
    after: fn(&mut S, &mut World) -> Done,
    check: fn(&S, &World) -> Result<Findings, Failure>,
}

trait Script: Send {
    fn before(&mut self, world: &mut World) -> Done;
    fn after(&mut self, world: &mut World) -> Done;
    fn check(&self, world: &World) -> Result<Findings, Failure>;
    fn boxed_clone(&self) -> Box<dyn Script>;
}

impl<S: Clone + Send + 'static> Script for Scripted<S> {
    fn before(&mut self, world: &mut World) -> Done {
        (self.before)(&mut self.state, world)
    }

    fn after(&mut self, world: &mut World) -> Done {
        (self.after)(&mut self.state, world)
    }

    fn check(&self, world: &World) -> Result<Findings, Failure> {
        (self.check)(&self.state, world)
    }

    fn boxed_clone(&self) -> Box<dyn Script> {
        Box::new(self.clone())
    }
}

/// A running scene. A clone goes on to the same bits.
pub struct Play {
    /// The world as it is now.
    pub world: World,
    h: f64,
    script: Box<dyn Script>,
}

impl Clone for Play {
    fn clone(&self) -> Self {
        Self { world: self.world.clone(), h: self.h, script: self.script.boxed_clone() }
    }
}

impl std::fmt::Debug for Play {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Play").field("world", &self.world).field("h", &self.h).finish_non_exhaustive()
    }
}

impl Play {
    /// The step size, s.
    pub fn step_size(&self) -> f64 {
        self.h
    }

    /// Simulated time, s.
    pub fn time(&self) -> f64 {
        self.world.time()
    }

    /// Steps from the start to a time.
    pub fn steps_to(&self, seconds: f64) -> u64 {
        (seconds / self.h).round() as u64
    }

    /// Drives the scene and makes one step.
    ///
    /// # Errors
    /// Whatever the engine refuses.
    pub fn step(&mut self) -> Result<ferrode::Step, Failure> {
        self.script.before(&mut self.world)?;
        let step = self.world.step(self.h)?;
        self.script.after(&mut self.world)?;
        Ok(step)
    }

    /// What was measured up to now, if the demo's property holds.
    ///
    /// # Errors
    /// [`Failure::Property`] with what was measured if it does not hold.
    pub fn verdict(&self) -> Result<String, Failure> {
        let quarantined = self.world.bodies().filter(|(_, body)| body.is_quarantined()).count();
        let findings = self.script.check(&self.world)?;
        if quarantined > 0 {
            return findings.is("no body had to be quarantined", false).verdict();
        }
        findings.verdict()
    }
}

/// Puts a [`Play`] together.
pub(crate) struct Stage<S> {
    world: World,
    h: f64,
    script: Scripted<S>,
}

impl<S: Clone + Send + 'static> Stage<S> {
    /// A world that is stepped by `h` seconds, and what the script remembers.
    pub fn new(world: World, h: f64, state: S) -> Self {
        let check = |_: &S, _: &World| Ok(Findings::new().is("this demo has a property", false));
        Self { world, h, script: Scripted { state, before: |_, _| Ok(()), after: |_, _| Ok(()), check } }
    }

    /// What acts before each step: motors, forces.
    pub fn before(mut self, act: fn(&mut S, &mut World) -> Done) -> Self {
        self.script.before = act;
        self
    }

    /// What looks on after each step.
    pub fn after(mut self, look: fn(&mut S, &mut World) -> Done) -> Self {
        self.script.after = look;
        self
    }

    /// What judges at the end.
    pub fn check(mut self, judge: fn(&S, &World) -> Result<Findings, Failure>) -> Result<Play, Failure> {
        self.script.check = judge;
        Ok(Play { world: self.world, h: self.h, script: Box::new(self.script) })
    }
}
