//! A step of a world with shapes by [`Stepper::Substep`](crate::Stepper::Substep): pairs and manifolds are kept from step to
//! step, and no contact joints are made.
//!
//! ```text
//! geoms follow bodies → pair cache: near pairs, manifolds refreshed or found anew → contacts for the solver
//!   → dynamics' step → impulses back into the manifolds → what was too fast is stopped at what stands still → events
//! ```

mod contacts;
mod continuous;
mod geoms;
mod report;
mod surfaces;

use crate::{Error, Step, World};
use contacts::Filled;
use ferrode_collide::pairs::{PairCache, PairSettings};
use ferrode_dynamics::ContactManifold;
use geoms::{Followed, Known};
use surfaces::SurfaceTable;

/// What `Substep` keeps of a world's shapes. Plain data: a clone steps to the same bits.
#[derive(Clone, Debug)]
pub(crate) struct Pipeline {
    pairs: PairCache,
    /// By the geoms' slots.
    known: Vec<Option<Known>>,
    /// How often bodies had been struck off the world's roll at the end of the last step, and the geoms to look at in this one.
    seen_roll: Option<u64>,
    called: Vec<u32>,
    /// The world's versions that `known` and the manifolds were made for.
    seen_geoms: Option<u64>,
    seen_rules: (u64, u64),
    /// By the contacts' places in the cache.
    manifolds: Vec<ContactManifold>,
    surfaces: SurfaceTable,
    /// The least distance that a geom may move in a step before it could pass through something.
    least_thickness: f32,
    /// What tasks found.
    followed: Vec<Followed>,
    filled: Vec<Filled>,
    /// Of the last step.
    max_depth: f64,
    points: usize,
}

impl Default for Pipeline {
    fn default() -> Self {
        Self {
            pairs: PairCache::new(PairSettings::default()),
            known: Vec::new(),
            seen_roll: None,
            called: Vec::new(),
            seen_geoms: None,
            seen_rules: (0, 0),
            manifolds: Vec::new(),
            surfaces: SurfaceTable::default(),
            least_thickness: f32::INFINITY,
            followed: Vec::new(),
            filled: Vec::new(),
            max_depth: 0.0,
            points: 0,
        }
    }
}

impl World {
    /// As [`World::step`], with the stepper `Substep`.
    pub(crate) fn step_substep(&mut self, h: f64) -> Result<Step, Error> {
        if let Some(step) = self.step_asleep(h) {
            return Ok(step);
        }
        let mut pipeline = self.pipeline.take().unwrap_or_default();
        let result = self.step_pipeline(h, &mut pipeline);
        self.pipeline = Some(pipeline);
        result
    }

    /// A step in which nothing is awake, nothing was changed by hand, and so nothing happens; `None` where it may.
    fn step_asleep(&mut self, h: f64) -> Option<Step> {
        let pipeline = self.pipeline.as_mut()?;
        let same = pipeline.seen_geoms == Some(self.geom_version)
            && pipeline.seen_rules == (self.rules_version, self.dynamics.topology_version())
            && pipeline.seen_roll == Some(self.dynamics.roll_call().1)
            && pipeline.pairs.is_idle();
        if !(same && self.dynamics.step_asleep(h)) {
            return None;
        }
        (pipeline.points, pipeline.max_depth) = (0, 0.0);
        self.contacts.clear();
        self.events.clear();
        self.lazy_contacts.take();
        let pairs = pipeline.pairs.pair_count();
        self.advance_clock(h);
        Some(Step { pairs, ..Step::default() })
    }

    fn step_pipeline(&mut self, h: f64, pipeline: &mut Pipeline) -> Result<Step, Error> {
        let crew = self.dynamics.crew().clone();
        self.follow_bodies(h, &crew, pipeline);
        self.update_pairs(&crew, pipeline);
        self.fill_manifolds(h, &crew, pipeline);
        let surfaces = &pipeline.surfaces.list;
        let dynamics = {
            // Those that sleep too: if their bodies are woken in this step, they hold already.
            let used = pipeline.pairs.used_places();
            self.dynamics.step_with_awake_manifolds(h, &mut pipeline.manifolds, used, surfaces)?
        };
        pipeline.keep_impulses(&crew);
        crew.rest();
        self.stop_fast_bodies(pipeline)?;
        pipeline.seen_roll = Some(self.dynamics.roll_call().1);
        self.report_substep(pipeline);
        self.advance_clock(h);
        Ok(Step {
            pairs: pipeline.pairs.pair_count(),
            contacts: pipeline.points,
            max_depth: pipeline.max_depth,
            dynamics,
        })
    }
}
