use super::convex::touch;
use super::dispatch::apart;
use super::hull_cuboid::hull_cuboid;
use super::hull_facet::Axes;
use super::hull_hull::hull_hull;
use super::manifold::add_manifold;
use super::support::Body;
use crate::{Contacts, Frame, Shape};
use ferrode_math::Vec3;

/// Any two convex shapes of finite size, by their support functions: GJK while their cores are apart, EPA for the least
/// overlap, and the features that face each other clipped to a manifold of up to eight points.
///
/// Shapes of unlike kinds have the same contacts in either order, but for the sign of the normal. Other shapes have none
/// here.
pub fn convex_bodies(a: &Shape, fa: &Frame, b: &Shape, fb: &Frame, out: &mut Contacts<'_>) {
    if apart(fa, fb, a.reach() + b.reach()) {
        return;
    }
    if (a.kind() as usize) > b.kind() as usize {
        out.in_other_order(|out| in_order(b, fb, a, fa, out));
    } else {
        in_order(a, fa, b, fb, out);
    }
}

fn in_order(a: &Shape, fa: &Frame, b: &Shape, fb: &Frame, out: &mut Contacts<'_>) {
    in_first_frame(fa, fb, out, |fa, fb, out| {
        let (Some(a), Some(b)) = (Body::of(a, fa, Vec3::ZERO), Body::of(b, fb, Vec3::ZERO)) else { return };
        let found = match hull_cuboid(&a, &b).or_else(|| hull_hull(&a, &b)) {
            Some(Axes::Apart) => None,
            Some(Axes::Least(t)) => Some(t),
            Some(Axes::Overlap) | None => touch(&a, &b),
        };
        if let Some(t) = found {
            add_manifold(&a, &b, &t, Vec3::ZERO, out);
        }
    });
}

/// Finds contacts in the coordinates of the first shape, so that they do not depend on where the pair is in the world
/// and how it is turned: what iterates takes the same way to its answer.
pub(super) fn in_first_frame(
    fa: &Frame,
    fb: &Frame,
    out: &mut Contacts<'_>,
    find: impl FnOnce(&Frame, &Frame, &mut Contacts<'_>),
) {
    let local = Frame::new(fa.point_to_local(fb.position), fa.rotation.transpose() * fb.rotation);
    let first = out.len();
    find(&Frame::IDENTITY, &local, out);
    for c in &mut out.added()[first..] {
        c.point.position = fa.point_to_world(c.point.position);
        c.point.normal = fa.vector_to_world(c.point.normal);
    }
}
