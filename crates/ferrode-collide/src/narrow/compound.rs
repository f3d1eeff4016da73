//! Compounds: each part on its own, the contacts of all of them chosen from.

use super::cast::{CastHit, shape_cast};
use super::dispatch::collide_in;
use super::distance::{Distance, distance_frames};
use super::reduce::reduce;
use super::steady::steady_in;
use crate::shape::{seen_from, within};
use crate::{Compound, Contacts, Frame, Shape};
use ferrode_math::{Aabb, Vec3};

/// How the contacts of a part are found.
#[derive(Clone, Copy)]
pub(super) enum Way {
    Collide,
    Steady,
}

/// A compound and any other shape: the contacts of its parts, `side1` the number of the part. Of a ray's hits the
/// nearest come first; if there are more of others than wanted, the deepest stays, and those that differ most.
pub fn compound_shape(compound: &Compound, fa: &Frame, other: &Shape, fb: &Frame, out: &mut Contacts<'_>) {
    parts_with(compound, fa, other, fb, Way::Collide, out);
}

pub(super) fn parts_with(
    compound: &Compound,
    fa: &Frame,
    other: &Shape,
    fb: &Frame,
    way: Way,
    out: &mut Contacts<'_>,
) {
    let first = out.len();
    compound.parts_in(&around(compound, fa, other, fb), |i| {
        let (part, at) = compound.part(i);
        let mut list = out.all();
        let frame = within(fa, at);
        match way {
            Way::Collide => collide_in(part, &frame, other, fb, &mut list),
            Way::Steady => steady_in(part, &frame, other, fb, &mut list),
        }
        for c in list.added() {
            c.side1 = i as i32;
        }
    });
    if let Shape::Ray(ray) = other {
        let wanted = if ray.closest_hit { 1 } else { out.capacity() };
        // Equal distances by the number of the part.
        let order = |c: &crate::GeomContact| (c.point.depth, c.side1);
        out.added()[first..].sort_unstable_by(|a, b| {
            let ((x, i), (y, j)) = (order(a), order(b));
            x.total_cmp(&y).then(i.cmp(&j))
        });
        if out.len() > wanted {
            out.truncate(wanted);
        }
        return;
    }
    // By part, whatever way the tree is walked.
    out.added()[first..].sort_by_key(|c| c.side1);
    reduce(out, compound.reach().min(other.reach()));
}

/// Where to look for parts: the other shape's box in the compound's coordinates.
fn around(compound: &Compound, fa: &Frame, other: &Shape, fb: &Frame) -> Aabb {
    match other {
        // Its box is that of the half-space.
        Shape::Plane(_) => Aabb::EVERYTHING,
        _ => {
            let local = other.aabb_in(&seen_from(fa, fb));
            // Rounding of the relative pose.
            let hair = 1e-12 * (compound.reach() + (fa.position - fb.position).length());
            if local.is_finite() { local.expanded(hair) } else { Aabb::EVERYTHING }
        }
    }
}

/// Part of a compound's size by which two distances are one.
const EQUAL: f64 = 1e-12;

/// The least distance of a part; of equals that of the first, whatever rounding makes of them.
pub(super) fn compound_distance(
    compound: &Compound,
    fa: &Frame,
    other: (&Shape, &Frame),
) -> Option<Distance> {
    let mut best: Option<Distance> = None;
    let equal = EQUAL * compound.reach();
    compound.parts_in(&Aabb::EVERYTHING, |i| {
        let (part, at) = compound.part(i);
        if let Some(d) = distance_frames((part, &within(fa, at)), other)
            && best.is_none_or(|b| d.distance < b.distance - equal)
        {
            best = Some(d);
        }
    });
    best
}

/// The first hit of a part that moves along `path`.
pub(super) fn compound_cast(
    compound: &Compound,
    fa: &Frame,
    path: Vec3,
    other: (&Shape, &Frame),
) -> Option<CastHit> {
    let mut best: Option<CastHit> = None;
    compound.parts_in(&Aabb::EVERYTHING, |i| {
        let (part, at) = compound.part(i);
        if let Some(hit) = shape_cast((part, &within(fa, at)), path, other)
            && hit.before(best)
        {
            best = Some(hit);
        }
    });
    best
}
