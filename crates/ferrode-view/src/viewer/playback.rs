//! Time: running, pausing, stepping, winding back.

use crate::demo::Direction;
use crate::setup::Setup;
use crate::viewer::source::Recording;
use ferrode::{BodyKey, Error, Pose, StepTimes, Stepper, Vec3, World};
use ferrode_scene::NamedWorld;
use ferrode_scene::description::LinkId;
use std::collections::VecDeque;
use std::sync::LazyLock;
use std::time::{Duration, Instant};

/// What a step said of itself.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct StepFacts {
    /// Wall time of the step, s.
    pub wall: f64,
    /// Contact points.
    pub contacts: usize,
    /// Deepest penetration, m.
    pub depth: f64,
    /// Largest natural residual of the islands that `Direct` solved; 0 for other steppers.
    pub residual: f64,
    /// Constraint rows.
    pub rows: usize,
    /// Pairs of boxes that overlapped.
    pub pairs: usize,
    /// Where the time of the step went.
    pub phases: StepTimes,
}

/// The clock that steps measure their phases by.
fn seconds() -> f64 {
    static START: LazyLock<Instant> = LazyLock::new(Instant::now);
    START.elapsed().as_secs_f64()
}

/// A world in time: one that is simulated, or one whose past was recorded.
#[derive(Debug)]
pub struct Playback {
    /// The world as it is shown.
    pub named: NamedWorld,
    /// Time stands still.
    pub paused: bool,
    /// Simulated seconds a second.
    pub speed: f64,
    /// Of the last step.
    pub facts: StepFacts,
    /// What drives the world, if it is a demo's.
    pub direction: Option<Direction>,
    setup: Setup,
    start: Moment,
    recording: Option<Recording>,
    /// States before this one, oldest first.
    history: VecDeque<Moment>,
    /// States after this one, which was wound back to: the nearest last. Time that runs makes others.
    ahead: Vec<Moment>,
    /// Seconds that are to be simulated yet.
    due: f64,
    /// Simulated before the world was built anew with another step size, s.
    earlier: f64,
    kept: f64,
}

/// A world and what drives it, at one time.
type Moment = (NamedWorld, Option<Direction>);

/// What can go wrong with a step: in the engine, or in a demo.
type Done = Result<(), Box<dyn std::error::Error + Send + Sync>>;

/// Seconds between the states that are kept for winding back.
const KEEP_EVERY: f64 = 1.0 / 15.0;
/// As many of them are kept.
const KEEP: usize = 300;
/// Of large worlds fewer states are kept: bodies in all of them.
const KEEP_BODIES: usize = 300_000;

impl Playback {
    /// A world to simulate.
    pub fn new(setup: Setup, mut named: NamedWorld) -> Self {
        named.world.set_step_clock(Some(seconds));
        Self {
            start: (named.clone(), None),
            named,
            direction: None,
            paused: false,
            speed: 1.0,
            facts: StepFacts::default(),
            setup,
            recording: None,
            history: VecDeque::new(),
            ahead: Vec::new(),
            due: 0.0,
            earlier: 0.0,
            kept: f64::NEG_INFINITY,
        }
    }

    /// A demo to run.
    pub fn of_demo(named: NamedWorld, direction: Direction) -> Self {
        let mut playback = Self::new(Setup::default(), named);
        playback.start.1 = Some(direction.clone());
        playback.direction = Some(direction);
        playback
    }

    /// A recording to show on a world.
    ///
    /// # Errors
    /// The engine refuses a recorded pose.
    pub fn of_recording(named: NamedWorld, recording: Recording) -> Result<Self, Error> {
        let mut playback = Self { recording: Some(recording), ..Self::new(Setup::default(), named) };
        playback.show_recorded()?;
        Ok(playback)
    }

    /// Whether it shows a recording.
    pub fn is_recording(&self) -> bool {
        self.recording.is_some()
    }

    /// The time that is shown, s.
    pub fn time(&self) -> f64 {
        self.recording.as_ref().map_or(self.earlier + self.named.world.time(), Recording::time)
    }

    /// First and last time of a recording, or of what is kept.
    pub fn range(&self) -> [f64; 2] {
        if let Some(recording) = &self.recording {
            return recording.range();
        }
        let time = |moment: Option<&Moment>| moment.map_or(self.time(), |m| self.earlier + m.0.world.time());
        [time(self.history.front()), time(self.ahead.first())]
    }

    /// Lets wall time pass: makes the steps that fall into it, but for no longer than `most`. `before` is called before each.
    ///
    /// # Errors
    /// The engine refuses a step.
    pub fn advance(&mut self, seconds: f64, most: Duration, mut before: impl FnMut(&mut World, f64)) -> Done {
        if self.paused {
            return Ok(());
        }
        self.due += seconds * self.speed;
        if let Some(recording) = &mut self.recording {
            let time = recording.time() + self.due;
            self.due = 0.0;
            recording.seek(time);
            return Ok(self.show_recorded()?);
        }
        let start = Instant::now();
        while self.due >= self.named.step_size() {
            self.due -= self.named.step_size();
            self.step(&mut before)?;
            if start.elapsed() > most {
                // Slower than time: let the rest go.
                self.due = 0.0;
            }
        }
        self.follow();
        Ok(())
    }

    /// Some steppers move bodies alone: geoms follow before they are drawn.
    fn follow(&mut self) {
        if self.named.world.stepper == Stepper::Substep {
            self.named.world.sync_geoms();
        }
    }

    /// Makes one step (or shows the next recorded moment).
    ///
    /// # Errors
    /// The engine refuses the step, or a demo's own doing.
    pub fn single_step(&mut self, before: &mut impl FnMut(&mut World, f64)) -> Done {
        self.step(before)?;
        self.follow();
        Ok(())
    }

    fn step(&mut self, before: &mut impl FnMut(&mut World, f64)) -> Done {
        if let Some(recording) = &mut self.recording {
            recording.next();
            return Ok(self.show_recorded()?);
        }
        self.keep();
        let h = self.named.step_size();
        before(&mut self.named.world, h);
        let clock = Instant::now();
        let step = match &mut self.direction {
            Some(direction) => direction.step(&mut self.named)?,
            None => self.named.step()?,
        };
        self.facts = StepFacts {
            wall: clock.elapsed().as_secs_f64(),
            contacts: step.contacts,
            depth: step.max_depth,
            residual: step.dynamics.solves.iter().map(|solve| solve.residual).fold(0.0, f64::max),
            rows: step.dynamics.rows,
            pairs: step.pairs,
            phases: self.named.world.step_times().unwrap_or_default(),
        };
        Ok(())
    }

    /// The world is about to be changed: what came after this moment does not hold any more.
    pub fn depart(&mut self) {
        self.ahead.clear();
    }

    fn keep(&mut self) {
        self.depart();
        let time = self.named.world.time();
        if time < self.kept + KEEP_EVERY {
            return;
        }
        self.kept = time;
        let most = (KEEP_BODIES / self.named.world.body_count().max(1)).clamp(2, KEEP);
        while self.history.len() >= most {
            self.history.pop_front();
        }
        self.history.push_back((self.named.clone(), self.direction.clone()));
    }

    /// Goes back to the state kept before this one; `false` if there is none.
    ///
    /// # Errors
    /// The engine refuses a recorded pose.
    pub fn back(&mut self) -> Result<bool, Error> {
        self.paused = true;
        if let Some(recording) = &mut self.recording {
            recording.previous();
            return self.show_recorded().map(|()| true);
        }
        Ok(self.one_back())
    }

    /// Goes to a time as nearly as states were kept, back or forth; in a recording, to any time.
    ///
    /// # Errors
    /// The engine refuses a recorded pose.
    pub fn seek(&mut self, time: f64) -> Result<(), Error> {
        if let Some(recording) = &mut self.recording {
            recording.seek(time);
            return self.show_recorded();
        }
        while self.time() > time && self.one_back() {}
        while self.ahead.last().is_some_and(|next| self.earlier + next.0.world.time() <= time) {
            let Some(next) = self.ahead.pop() else { break };
            let left = self.take(next);
            self.history.push_back(left);
        }
        Ok(())
    }

    /// To the state kept before this one, if there is one.
    fn one_back(&mut self) -> bool {
        while let Some(state) = self.history.pop_back() {
            if state.0.world.time() < self.named.world.time() {
                let left = self.take(state);
                self.ahead.push(left);
                return true;
            }
        }
        false
    }

    /// Shows a state, and gives the one that was shown. The stepper stays the one that was chosen.
    fn take(&mut self, (mut named, direction): Moment) -> Moment {
        named.world.stepper = self.named.world.stepper;
        // Time that runs on from here keeps this state again.
        (self.due, self.kept) = (0.0, f64::NEG_INFINITY);
        (std::mem::replace(&mut self.named, named), std::mem::replace(&mut self.direction, direction))
    }

    /// Begins anew.
    ///
    /// # Errors
    /// The engine refuses a recorded pose.
    pub fn reset(&mut self) -> Result<(), Error> {
        if let Some(recording) = &mut self.recording {
            let [first, _] = recording.range();
            recording.seek(first);
            return self.show_recorded();
        }
        self.history.clear();
        self.depart();
        let stepper = self.named.world.stepper;
        (self.named, self.direction) = self.start.clone();
        self.named.world.stepper = stepper;
        (self.due, self.earlier, self.kept) = (0.0, 0.0, f64::NEG_INFINITY);
        Ok(())
    }

    /// The stepper.
    pub fn stepper(&self) -> Stepper {
        self.named.world.stepper
    }

    /// Changes the stepper.
    pub fn set_stepper(&mut self, stepper: Stepper) {
        self.named.world.stepper = stepper;
    }

    /// Changes the step size while time runs. Softness of contacts, stops and springs depends on it, so the world is built
    /// anew for it, and takes over where everything is and how it moves; what was shot or dropped is not taken along.
    ///
    /// # Errors
    /// The step size is no positive number, or a demo's, which was made for its own.
    pub fn set_step_size(&mut self, h: f64) -> Result<(), String> {
        if self.direction.is_some() {
            return Err("a demo keeps its step size: what it measures depends on it".to_owned());
        }
        if self.recording.is_some() {
            return Ok(());
        }
        let time = self.time();
        let stepper = self.named.world.stepper;
        let mut rebuilt = self.setup.build(&self.start.0.scene, Some(h))?;
        rebuilt.world.set_step_clock(Some(seconds));
        self.start = (rebuilt.clone(), None);
        let states: Vec<State> = (0..self.named.scene.links.len()).map(|n| self.state(LinkId(n))).collect();
        for (index, state) in states.into_iter().enumerate() {
            let Some((body, state)) = rebuilt.link_body(LinkId(index)).zip(state) else { continue };
            restore(&mut rebuilt.world, body, &state).map_err(|error| error.to_string())?;
        }
        rebuilt.world.stepper = stepper;
        self.history.clear();
        self.depart();
        (self.earlier, self.kept, self.due) = (time, f64::NEG_INFINITY, 0.0);
        self.named = rebuilt;
        Ok(())
    }

    fn state(&self, link: LinkId) -> State {
        let body = self.named.world.body(self.named.link_body(link)?).ok()?;
        Some((body.pose(), body.linear_velocity(), body.angular_velocity(), body.is_enabled()))
    }

    fn show_recorded(&mut self) -> Result<(), Error> {
        let Some(recording) = &self.recording else { return Ok(()) };
        for (name, pose) in recording.poses() {
            let Some(link) = self.named.link(name) else { continue };
            let (id, inertial) = (link.id(), link.description().inertial.pose);
            let Some(body) = self.named.link_body(id) else { continue };
            self.named.world.body_mut(body)?.set_pose(pose * inertial)?;
        }
        self.named.world.sync_geoms();
        Ok(())
    }
}

/// Where a body is and how it moves.
type State = Option<(Pose, Vec3, Vec3, bool)>;

fn restore(
    world: &mut World,
    body: BodyKey,
    (pose, linear, angular, enabled): &(Pose, Vec3, Vec3, bool),
) -> Result<(), Error> {
    let body = world.body_mut(body)?;
    body.set_pose(*pose)?;
    body.set_linear_velocity(*linear)?;
    body.set_angular_velocity(*angular)?;
    if !enabled {
        body.disable();
    }
    Ok(())
}
