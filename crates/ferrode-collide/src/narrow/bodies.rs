use super::convex::touch;
use super::manifold::add_manifold;
use super::support::Body;
use crate::{Contacts, Frame, Shape};

/// Any two convex shapes of finite size, by their support functions: GJK while their cores are apart, EPA for the least
/// overlap, and the features that face each other clipped to a manifold of up to eight points.
///
/// Other shapes have no contacts here.
pub fn convex_bodies(a: &Shape, fa: &Frame, b: &Shape, fb: &Frame, out: &mut Contacts<'_>) {
    let origin = fa.position;
    if let (Some(a), Some(b)) = (Body::of(a, fa, origin), Body::of(b, fb, origin))
        && let Some(t) = touch(&a, &b)
    {
        add_manifold(&a, &b, &t, origin, out);
    }
}
