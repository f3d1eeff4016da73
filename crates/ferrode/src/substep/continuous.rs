//! Continuous collision: a body that moved further in one step than it is thick is stopped where its shape first meets what
//! stands still.
//!
//! Speculative points already keep most bodies from crossing a gap. This is the net below them: the geom is cast along its
//! path, against static geoms only. What it touches at the start does not stop it, or nothing could slide; there its core,
//! a ball within it, is cast instead, and where that touches too, the core's centre. So no centre ever crosses a surface, however the body
//! turns.

use super::Pipeline;
use crate::{Error, World};
use ferrode_collide::{Geom, GeomKey, Queries, Shape, Sphere};
use ferrode_dynamics::BodyKey;
use ferrode_math::{Pose, Quat, Vec3};

/// A geom that moved far in this step.
#[derive(Clone, Copy, Debug)]
struct Fast {
    geom: GeomKey,
    body: BodyKey,
    /// The geom's pose before the step, and how far it went.
    start: Pose,
    path: Vec3,
}

/// Most geoms that a shape is looked past because it touches them at the start.
const PASSED: usize = 8;

impl World {
    /// Puts bodies back that went through something.
    pub(super) fn stop_fast_bodies(&mut self, pipeline: &Pipeline) -> Result<(), Error> {
        let mut bodies = self.dynamics.moved_far(f64::from(pipeline.least_thickness)).peekable();
        if bodies.peek().is_none() {
            return Ok(());
        }
        let fast: Vec<Fast> = bodies.flat_map(|body| self.fast_geoms(body, pipeline)).collect();
        let Self { dynamics, colliders, space, geom_infos, pair_surfaces, .. } = self;
        let queries = colliders.queries(*space)?;
        for fast in &fast {
            let stops = |key: GeomKey, other: &Geom| {
                let info = geom_infos.get(other.user() as usize).and_then(Option::as_ref);
                let pair = (fast.geom.min(key), fast.geom.max(key));
                info.is_some_and(|info| info.body.is_none())
                    && pair_surfaces.get(&pair).is_none_or(Option::is_some)
            };
            // A limb is stopped when it is about to go through, not when it touches, and takes along what hangs on it.
            let jointed = dynamics.body_joints(fast.body)?.next().is_some();
            let Some(fraction) = first_hit(&queries, fast, jointed, stops) else { continue };
            let (bodies, held) = dynamics.articulation_of(fast.body)?;
            let back = fast.path * (fraction - 1.0);
            for key in if held { &bodies[..1] } else { &bodies } {
                let body = dynamics.body_mut(*key)?;
                let position = body.position() + back;
                body.set_position(position)?;
            }
        }
        Ok(())
    }

    /// The geoms of a body that moved further than they are thick.
    fn fast_geoms<'a>(&'a self, body: BodyKey, pipeline: &'a Pipeline) -> impl Iterator<Item = Fast> + 'a {
        let geoms = self.geoms_of_body.get(&body).map_or(&[][..], Vec::as_slice);
        let pose = self.dynamics.body(body).ok().map(|b| b.pose());
        geoms.iter().filter_map(move |key| {
            let slot = self.geom_slot(*key).ok()?;
            let known = pipeline.known.get(slot)?.as_ref()?;
            let frame = pipeline.pairs.frame(slot as u32)?;
            let end = pose?.transform_point(known.offset.unwrap_or_default().position);
            let path = end - frame.position;
            let thickness = f64::from(known.thickness);
            let start = Pose::new(frame.position, Quat::from_matrix(&frame.rotation));
            let fast = path.length_squared() > thickness * thickness;
            fast.then_some(Fast { geom: *key, body, start, path })
        })
    }
}

/// The part of the path that a geom, or its core, can go, of what stands still and is not passed by wish.
fn first_hit(
    queries: &Queries<'_>,
    fast: &Fast,
    core_only: bool,
    stops: impl Fn(GeomKey, &Geom) -> bool,
) -> Option<f64> {
    let geom = queries.colliders().geom(fast.geom)?;
    let (pose, path) = (fast.start, fast.path);
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

/// Casts a ball of half the size of the largest that fits into the shape, at its centre, against one geom; its centre, if the ball touches
/// that at the start.
fn cast_core(queries: &Queries<'_>, shape: &Shape, pose: &Pose, path: Vec3, against: GeomKey) -> Option<f64> {
    let own = shape.aabb_in(&ferrode_collide::Frame::IDENTITY);
    let e = own.extent();
    let radius = 0.25 * e.x.min(e.y).min(e.z);
    let core = Shape::from(Sphere::new(radius).ok()?);
    let centre = pose.transform_point(own.center());
    let hit = queries.shape_cast(&core, &Pose::from_position(centre), path, |key, _| key == against)?;
    if hit.fraction > 0.0 && hit.depth <= 0.0 {
        return Some(hit.fraction);
    }
    let length = path.length();
    let hit = queries.ray_cast(centre, path, length, |key, _| key == against)?;
    // It stays half the core's radius in front of the surface, or where it is.
    let slope = hit.normal.dot(path).abs() / length;
    let gap = 0.5 * radius / slope.max(1e-6);
    Some((hit.distance - gap).max(0.0) / length)
}
