use super::{Queries, better};
use crate::space::Probe;
use crate::{Frame, Geom, GeomKey, Shape, narrow};
use ferrode_math::{Pose, Vec3};

/// Where a moving shape met a geom.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ShapeCastHit {
    /// The geom that was hit.
    pub geom: GeomKey,
    /// The part of the path before the hit, 0 to 1; 0 for a geom that the shape touches at the start.
    pub fraction: f64,
    /// World position of the contact.
    pub position: Vec3,
    /// Unit normal of the contact, into the moving shape.
    pub normal: Vec3,
    /// Depth at the start; 0 unless the shape overlaps the geom there.
    pub depth: f64,
}

impl Queries<'_> {
    /// What a shape hits first that starts at `pose` and moves along `path` without turning. `None` for a ray, and if
    /// nothing that `filter` lets through is in the way; among equals the geom that was added first wins.
    pub fn shape_cast(
        &self,
        shape: &Shape,
        pose: &Pose,
        path: Vec3,
        filter: impl Fn(GeomKey, &Geom) -> bool,
    ) -> Option<ShapeCastHit> {
        if !path.is_finite() {
            return None;
        }
        let frame = Frame::from(pose);
        let aabb = shape.aabb_in(&frame);
        let mut best: Option<ShapeCastHit> = None;
        let mut ask = |key: GeomKey, geom: &Geom, limit: &mut f64| {
            if !filter(key, geom) {
                return;
            }
            let Some(hit) = narrow::shape_cast((shape, &frame), path, (geom.shape(), geom.frame())) else {
                return;
            };
            if better(hit.fraction, key, best.as_ref().map(|b| (b.fraction, b.geom))) {
                *limit = hit.fraction;
                let narrow::CastHit { fraction, position, normal, depth } = hit;
                best = Some(ShapeCastHit { geom: key, fraction, position, normal, depth });
            }
        };
        let mut limit = 1.0;
        if aabb.is_finite() {
            self.seek(&Probe::sweep(&aabb, path), &mut limit, &mut ask);
        } else {
            self.each(&mut |key, geom| ask(key, geom, &mut limit));
        }
        best
    }
}
