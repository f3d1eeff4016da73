//! Contacts chosen so that bodies lie still and slide freely.

use super::compound::{Way, parts_with};
use super::dispatch::collide_in;
use super::{body_heightfield, body_trimesh, convex_bodies, heightfield_shape};
use crate::{CollideOptions, Contacts, Frame, GeomContact, Shape};
use ferrode_math::Pose;

/// As [`collide`](super::collide()), but where libode's answer leaves a body without hold, or catches it at edges within a
/// surface, a manifold of the features that face each other:
///
/// | pair | ODE's contacts | these |
/// |---|---|---|
/// | capsule and box | one, at whichever end is nearer: a lying capsule rocks for ever | both ends of the common stretch, with exact depth |
/// | ball and mesh | one for each triangle near, which push the ball sideways | one |
/// | convex body and heightfield | what the planes of the triangles cut, and corners of the field inside the body | as with a mesh |
///
/// All other pairs have the contacts of `collide`, which are manifolds already.
pub fn steady(
    a: (&Shape, &Pose),
    b: (&Shape, &Pose),
    options: CollideOptions,
    out: &mut Vec<GeomContact>,
) -> usize {
    steady_frames((a.0, &Frame::from(a.1)), (b.0, &Frame::from(b.1)), options, out)
}

/// As [`steady`], for callers who have the rotation matrices at hand.
pub fn steady_frames(
    a: (&Shape, &Frame),
    b: (&Shape, &Frame),
    options: CollideOptions,
    out: &mut Vec<GeomContact>,
) -> usize {
    let ((sa, fa), (sb, fb)) = (a, b);
    if options.max_contacts == 0 {
        return 0;
    }
    let mut list = Contacts::new(out, options);
    steady_in(sa, fa, sb, fb, &mut list);
    list.finish();
    list.len()
}

/// As [`steady_frames`], into a list begun elsewhere.
pub(super) fn steady_in(sa: &Shape, fa: &Frame, sb: &Shape, fb: &Frame, list: &mut Contacts<'_>) {
    match (sa, sb) {
        (Shape::Compound(compound), other) => parts_with(compound, fa, other, fb, Way::Steady, list),
        (other, Shape::Compound(compound)) => {
            parts_with(compound, fb, other, fa, Way::Steady, list);
            list.swap();
        }
        (Shape::Capsule(_), Shape::Cuboid(_)) | (Shape::Cuboid(_), Shape::Capsule(_)) => {
            convex_bodies(sa, fa, sb, fb, list);
        }
        (body, Shape::TriMesh(_) | Shape::Heightfield(_)) if is_body(body) => {
            body_surface(sa, fa, sb, fb, list);
        }
        (Shape::TriMesh(_) | Shape::Heightfield(_), body) if is_body(body) => {
            body_surface(sb, fb, sa, fa, list);
            list.swap();
        }
        _ => collide_in(sa, fa, sb, fb, list),
    }
}

/// Whether a shape is convex and of finite size.
fn is_body(shape: &Shape) -> bool {
    !matches!(shape, Shape::Plane(_) | Shape::Ray(_) | Shape::TriMesh(_) | Shape::Heightfield(_))
}

fn body_surface(body: &Shape, fa: &Frame, surface: &Shape, fb: &Frame, out: &mut Contacts<'_>) {
    match surface {
        Shape::TriMesh(mesh) => body_trimesh(body, fa, mesh, fb, out),
        Shape::Heightfield(field) => {
            body_heightfield(body, fa, field, fb, out);
            if out.is_empty() {
                // Sunk below the surface: the field is solid all the way down.
                heightfield_shape(field, fb, body, fa, out);
                out.swap();
            }
        }
        _ => {}
    }
}
