//! Continuous collision: a body that moves further in one step than it is thick is stopped where its shape first meets what
//! stands still.
//!
//! Speculative points already keep most bodies from crossing a gap. This is the net below them: the geom is cast along its
//! path, against static geoms only. What it touches at the start does not stop it, or nothing could slide; there its core,
//! a ball within it, is cast instead.

use super::Pipeline;
use crate::{Error, World};
use ferrode_collide::{Geom, GeomKey, Queries, Shape, Sphere};
use ferrode_dynamics::BodyKey;
use ferrode_math::{Pose, Vec3};

/// A geom that may move too far.
#[derive(Clone, Copy, Debug)]
pub(super) struct Fast {
    pub geom: GeomKey,
    pub body: BodyKey,
    /// The body's pose before the step.
    pub start: Pose,
}

/// Most geoms that a shape is looked past because it touches them at the start.
const PASSED: usize = 8;

impl World {
    /// Puts bodies back that went through something.
    pub(super) fn stop_fast_bodies(&mut self, pipeline: &mut Pipeline) -> Result<(), Error> {
        if pipeline.fast.is_empty() {
            return Ok(());
        }
        let Self { dynamics, colliders, space, geom_infos, pair_surfaces, .. } = self;
        let queries = colliders.queries(*space)?;
        for fast in &pipeline.fast {
            let Ok(body) = dynamics.body(fast.body) else { continue };
            let path = body.position() - fast.start.position;
            let stops = |key: GeomKey, other: &Geom| {
                let info = geom_infos.get(other.user() as usize).and_then(Option::as_ref);
                let pair = (fast.geom.min(key), fast.geom.max(key));
                info.is_some_and(|info| info.body.is_none())
                    && pair_surfaces.get(&pair).is_none_or(Option::is_some)
            };
            // A limb is stopped when it is about to go through, not when it touches, and takes along what hangs on it.
            let jointed = dynamics.body_joints(fast.body)?.next().is_some();
            let Some(fraction) = first_hit(&queries, fast, path, jointed, stops) else { continue };
            let (bodies, held) = dynamics.articulation_of(fast.body)?;
            let back = path * (fraction - 1.0);
            for key in if held { &bodies[..1] } else { &bodies } {
                let body = dynamics.body_mut(*key)?;
                let position = body.position() + back;
                body.set_position(position)?;
            }
        }
        Ok(())
    }
}

/// The part of the path that a geom, or its core, can go, of what stands still and is not passed by wish.
fn first_hit(
    queries: &Queries<'_>,
    fast: &Fast,
    path: Vec3,
    core_only: bool,
    stops: impl Fn(GeomKey, &Geom) -> bool,
) -> Option<f64> {
    let geom = queries.colliders().geom(fast.geom)?;
    let pose = fast.start * geom.offset().copied().unwrap_or_default();
    let (category, collide) = (geom.category_bits(), geom.collide_bits());
    let meets = |g: &Geom| category & g.collide_bits() != 0 || g.category_bits() & collide != 0;
    let mut passed = [None; PASSED];
    let mut nearest: Option<f64> = None;
    let nearer = |nearest: Option<f64>, x: f64| Some(nearest.map_or(x, |n| n.min(x)));
    for i in 0..PASSED {
        let filter = |key: GeomKey, g: &Geom| meets(g) && !passed[..i].contains(&Some(key)) && stops(key, g);
        let Some(hit) = queries.shape_cast(geom.shape(), &pose, path, filter) else { break };
        if hit.fraction > 0.0 && hit.depth <= 0.0 && !core_only {
            return nearer(nearest, hit.fraction);
        }
        if let Some(fraction) = cast_core(queries, geom.shape(), &pose, path, hit.geom) {
            nearest = nearer(nearest, fraction);
        }
        passed[i] = Some(hit.geom);
    }
    nearest
}

/// Casts a ball of half the size of the largest that fits into the shape, at its centre, against one geom.
fn cast_core(queries: &Queries<'_>, shape: &Shape, pose: &Pose, path: Vec3, against: GeomKey) -> Option<f64> {
    let own = shape.aabb_in(&ferrode_collide::Frame::IDENTITY);
    let e = own.extent();
    let radius = 0.25 * e.x.min(e.y).min(e.z);
    let core = Shape::from(Sphere::new(radius).ok()?);
    let centre = Pose::from_position(pose.transform_point(own.center()));
    let hit = queries.shape_cast(&core, &centre, path, |key, _| key == against)?;
    (hit.fraction > 0.0 && hit.depth <= 0.0).then_some(hit.fraction)
}
