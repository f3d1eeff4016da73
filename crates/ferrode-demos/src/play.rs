//! A running scene: a world, what drives it, and what is measured.

use crate::{Drawing, Failure, verdict::Findings};
use ferrode::World;

type Done = Result<(), Failure>;

/// State of a scene's own, with what acts before and after each step, what judges at the end, and what is drawn.
#[derive(Clone)]
struct Scripted<S> {
    state: S,
    before: fn(&mut S, &mut World) -> Done,
    after: fn(&mut S, &mut World) -> Done,
    check: fn(&S, &World) -> Result<Findings, Failure>,
    draw: fn(&S, &World, &mut Drawing),
}

trait Script: Send {
    fn before(&mut self, world: &mut World) -> Done;
    fn after(&mut self, world: &mut World) -> Done;
    fn check(&self, world: &World) -> Result<Findings, Failure>;
    fn draw(&self, world: &World, drawing: &mut Drawing);
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

    fn draw(&self, world: &World, drawing: &mut Drawing) {
        (self.draw)(&self.state, world, drawing);
    }

    fn boxed_clone(&self) -> Box<dyn Script> {
        Box::new(self.clone())
    }
}

/// What drives and judges a scene, apart from its world: for those who step the world themselves, as a viewer does.
///
/// A clone, with a clone of the world of the same moment, goes on to the same bits.
pub struct Director {
    h: f64,
    script: Box<dyn Script>,
}

impl Clone for Director {
    fn clone(&self) -> Self {
        Self { h: self.h, script: self.script.boxed_clone() }
    }
}

impl std::fmt::Debug for Director {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Director").field("h", &self.h).finish_non_exhaustive()
    }
}

impl Director {
    /// The step size that the scene is made for, s.
    pub fn step_size(&self) -> f64 {
        self.h
    }

    /// Drives the scene. To be called before each step.
    ///
    /// # Errors
    /// Whatever the engine refuses.
    pub fn before(&mut self, world: &mut World) -> Result<(), Failure> {
        self.script.before(world)
    }

    /// Measures. To be called after each step.
    ///
    /// # Errors
    /// Whatever the engine refuses.
    pub fn after(&mut self, world: &mut World) -> Result<(), Failure> {
        self.script.after(world)
    }

    /// What was measured up to now, if the demo's property holds.
    ///
    /// # Errors
    /// [`Failure::Property`] with what was measured if it does not hold.
    pub fn verdict(&self, world: &World) -> Result<String, Failure> {
        let quarantined = world.bodies().filter(|(_, body)| body.is_quarantined()).count();
        let findings = self.script.check(world)?;
        if quarantined > 0 {
            return findings.is("no body had to be quarantined", false).verdict();
        }
        findings.verdict()
    }

    /// What is to be seen beside the world's shapes.
    pub fn drawing(&self, world: &World) -> Drawing {
        let mut drawing = Drawing::default();
        self.script.draw(world, &mut drawing);
        drawing
    }
}

/// A running scene. A clone goes on to the same bits.
#[derive(Clone, Debug)]
pub struct Play {
    /// The world as it is now.
    pub world: World,
    director: Director,
}

impl Play {
    /// The step size, s.
    pub fn step_size(&self) -> f64 {
        self.director.step_size()
    }

    /// Simulated time, s.
    pub fn time(&self) -> f64 {
        self.world.time()
    }

    /// Steps from the start to a time.
    pub fn steps_to(&self, seconds: f64) -> u64 {
        (seconds / self.step_size()).round() as u64
    }

    /// Drives the scene and makes one step.
    ///
    /// # Errors
    /// Whatever the engine refuses.
    pub fn step(&mut self) -> Result<ferrode::Step, Failure> {
        self.director.before(&mut self.world)?;
        let step = self.world.step(self.director.step_size())?;
        self.director.after(&mut self.world)?;
        Ok(step)
    }

    /// What was measured up to now, if the demo's property holds.
    ///
    /// # Errors
    /// [`Failure::Property`] with what was measured if it does not hold.
    pub fn verdict(&self) -> Result<String, Failure> {
        self.director.verdict(&self.world)
    }

    /// What is to be seen beside the world's shapes.
    pub fn drawing(&self) -> Drawing {
        self.director.drawing(&self.world)
    }

    /// The world, and what drives it.
    pub fn into_parts(self) -> (World, Director) {
        (self.world, self.director)
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
        let script =
            Scripted { state, before: |_, _| Ok(()), after: |_, _| Ok(()), check, draw: |_, _, _| {} };
        Self { world, h, script }
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

    /// What is drawn beside the world's shapes.
    pub fn draw(mut self, draw: fn(&S, &World, &mut Drawing)) -> Self {
        self.script.draw = draw;
        self
    }

    /// What judges at the end.
    pub fn check(mut self, judge: fn(&S, &World) -> Result<Findings, Failure>) -> Result<Play, Failure> {
        self.script.check = judge;
        let director = Director { h: self.h, script: Box::new(self.script) };
        Ok(Play { world: self.world, director })
    }
}
