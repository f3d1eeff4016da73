//! The contact of any two convex bodies: distance if their cores are apart, least overlap if not.

use super::epa::{Depth, epa};
use super::gjk::{EXACT, Gap, Simplex, gjk_from};
use super::line_gap::line_gap;
use super::stationary::least_near;
use super::support::Body;
use ferrode_math::Vec3;

/// Where and how deep two bodies touch.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Touch {
    /// Unit, into the first body.
    pub normal: Vec3,
    pub depth: f64,
    /// The deepest point of the first body within the second, and of the second within the first.
    pub a: Vec3,
    pub b: Vec3,
}

/// The contact of two convex bodies; `None` if they are apart.
pub(crate) fn touch(a: &Body<'_>, b: &Body<'_>) -> Option<Touch> {
    let margin = a.margin + b.margin;
    if let Some((pa, pb)) = line_gap(a, b) {
        return apart(a, b, pa, pb, pa - pb).filter(|t| t.depth >= 0.0);
    }
    match gap(a, b, margin) {
        Gap::Far => None,
        Gap::Apart { a: pa, b: pb, between, .. } => apart(a, b, pa, pb, between).filter(|t| t.depth >= 0.0),
        Gap::Overlap(simplex) => Some(overlapping(a, b, &simplex)),
    }
}

/// What is left of the squared distance to gain when Newton's method takes over on curved surfaces.
const NEAR: f64 = 1e-2;

/// The nearest points of two cores, as exactly as numbers allow, or a simplex about the origin if they overlap. Cores known
/// to be further apart than `limit` are not looked at closely.
///
/// On curved surfaces GJK alone converges slowly, and to points that are good to the root of what the distance is.
pub(crate) fn gap(a: &Body<'_>, b: &Body<'_>, limit: f64) -> Gap {
    let start = a.center - b.center;
    if !(a.is_round() || b.is_round()) {
        return gjk_from(a, b, limit, start, EXACT);
    }
    let scale = a.reach() + b.reach() + start.length();
    let mut found = gjk_from(a, b, limit, start, NEAR);
    for rest in [1e-6, EXACT, 0.0] {
        let Gap::Apart { between, simplex, .. } = &found else { break };
        let near = &simplex.vertices[..simplex.count];
        if let Some(l) = between.normalized().and_then(|n| least_near(a, b, -n, near, scale, 0.0))
            && l.depth < 0.0
        {
            return Gap::Apart { a: l.a, b: l.b, between: l.normal * l.depth, simplex: *simplex };
        }
        if rest > 0.0 {
            found = gjk_from(a, b, limit, *between, rest);
        }
    }
    found
}

/// What is left of the squared distance to gain for manifolds, whose numbers are in single precision.
const ROUGH_DISTANCE: f64 = 1e-9;

/// As [`touch`], and the nearest points of bodies that are apart by no more than `within`: their depth is negative.
/// Of those further apart, how much more it is at least. `guess` is the normal of a moment ago, if there is one.
///
/// Good to a millionth of the bodies' size: enough for manifolds, and far quicker on curved surfaces.
pub(crate) fn touch_within(
    a: &Body<'_>,
    b: &Body<'_>,
    within: f64,
    guess: Option<Vec3>,
) -> Result<Touch, f64> {
    // A little further is looked at closely, so that those who ask again know how long they need not.
    let more = 0.25 * a.reach().min(b.reach());
    let start = guess.unwrap_or(a.center - b.center);
    match gjk_from(a, b, a.margin + b.margin + within + more, start, ROUGH_DISTANCE) {
        Gap::Far => Err(more),
        Gap::Apart { a: pa, b: pb, between, .. } => match apart(a, b, pa, pb, between) {
            Some(t) if t.depth >= -within => Ok(t),
            Some(t) => Err(-t.depth - within),
            None => Err(0.0),
        },
        Gap::Overlap(simplex) => {
            if let Some(touch) = guess.and_then(|g| shallow(a, b, g)) {
                return Ok(touch);
            }
            Ok(match epa(a, b, &simplex) {
                Some(d) => deep(a, b, &d),
                None => flat(a, b, &simplex),
            })
        }
    }
}

/// Overlap, in parts of the smaller body, up to which the nearest way out is taken to be the last one.
const SHALLOW: f64 = 0.03;

/// The least overlap near a direction, of bodies that overlap little.
///
/// Moved apart along the direction, the bodies have a distance, whose normal is nearer to the one of least overlap: the
/// nearer, the less they overlap and the flatter they are (the error shrinks by overlap over radius of curvature).
fn shallow(a: &Body<'_>, b: &Body<'_>, guess: Vec3) -> Option<Touch> {
    let size = a.reach().min(b.reach());
    let overlap = |n: Vec3| n.dot(b.support(n) - a.support(-n));
    let mut n = guess.normalized()?;
    let mut depth = overlap(n);
    let mut moved = *a;
    for _ in 0..4 {
        if !(depth <= SHALLOW * size) {
            return None;
        }
        let shift = n * (depth.max(0.0) + 0.02 * size);
        moved.center = a.center + shift;
        let Gap::Apart { a: pa, b: pb, between, .. } = gjk_from(&moved, b, f64::INFINITY, n, ROUGH_DISTANCE)
        else {
            return None;
        };
        let m = between.normalized()?;
        let better = overlap(m);
        let close = m.dot(n) > 1.0 - 1e-9;
        if close || better >= depth - 1e-9 * size {
            // The points belong to m; of the two normals they differ in nothing that counts.
            if better > depth + 1e-6 * size {
                return None;
            }
            let margin = a.margin + b.margin;
            let pa = pa - shift;
            return Some(Touch {
                normal: m,
                depth: better + margin,
                a: pa - m * a.margin,
                b: pb + m * b.margin,
            });
        }
        (n, depth) = (m, better);
    }
    None
}

/// Bodies whose cores are apart.
fn apart(a: &Body<'_>, b: &Body<'_>, pa: Vec3, pb: Vec3, between: Vec3) -> Option<Touch> {
    let distance = between.length();
    let normal = between.normalized()?;
    let depth = a.margin + b.margin - distance;
    Some(Touch { normal, depth, a: pa - normal * a.margin, b: pb + normal * b.margin })
}

/// Bodies whose cores share a point.
fn overlapping(a: &Body<'_>, b: &Body<'_>, simplex: &Simplex) -> Touch {
    match epa(a, b, simplex) {
        Some(d) => deep(a, b, &d),
        None => flat(a, b, simplex),
    }
}

fn deep(a: &Body<'_>, b: &Body<'_>, d: &Depth) -> Touch {
    Touch {
        normal: -d.normal,
        depth: d.depth + a.margin + b.margin,
        a: d.a + d.normal * a.margin,
        b: d.b - d.normal * b.margin,
    }
}

/// The difference of the cores is flat: they cross without depth, and part across it.
fn flat(a: &Body<'_>, b: &Body<'_>, simplex: &Simplex) -> Touch {
    let (pa, pb) = simplex.witnesses();
    let normal = flat_normal(a, b);
    Touch { normal, depth: a.margin + b.margin, a: pa - normal * a.margin, b: pb + normal * b.margin }
}

/// A direction across two cores whose difference is flat, on the side of the first one's centre.
fn flat_normal(a: &Body<'_>, b: &Body<'_>) -> Vec3 {
    let between = a.center - b.center;
    let across = a.axis(2).cross(b.axis(2));
    let n = across
        .normalized()
        .or_else(|| (between - a.axis(2) * a.axis(2).dot(between)).normalized())
        .unwrap_or_else(|| a.axis(0));
    if n.dot(between) < 0.0 { -n } else { n }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::narrow::{closest_segment_cuboid, closest_segment_points, cuboid_cuboid};
    use crate::{Capsule, CollideOptions, Contacts, Cuboid, Frame, Sphere};
    use ferrode_math::{Pose, Quat};
    use proptest::prelude::*;
    use proptest::test_runner::RngSeed;

    fn frame() -> impl Strategy<Value = Frame> {
        (prop::array::uniform3(-1.5..1.5f64), prop::array::uniform4(-1.0..1.0f64)).prop_map(|(p, q)| {
            let q = Quat::from_array(q).normalized().unwrap_or(Quat::IDENTITY);
            Frame::from(&Pose::new(Vec3::from_array(p), q))
        })
    }

    fn half_sides() -> impl Strategy<Value = Vec3> {
        prop::array::uniform3(0.1..1.0f64).prop_map(Vec3::from_array)
    }

    proptest! {
        #![proptest_config(ProptestConfig { cases: 1000, failure_persistence: None, rng_seed: RngSeed::Fixed(1), ..Default::default() })]

        /// Against the fifteen axes: an edge axis may lose against a face in `cuboid_cuboid` by 5 %, never otherwise.
        #[test]
        fn boxes_agree_with_separating_axes(fa in frame(), fb in frame(), ha in half_sides(), hb in half_sides()) {
            let (ca, cb) = (Cuboid::from_half_sides(ha).unwrap(), Cuboid::from_half_sides(hb).unwrap());
            let mut list = Vec::new();
            let mut out = Contacts::new(&mut list, CollideOptions::new(1));
            let sat = cuboid_cuboid(&ca, &fa, &cb, &fb, &mut out);
            let gjk = touch(&Body::cuboid(&ca, &fa, fa.position), &Body::cuboid(&cb, &fb, fa.position));
            match (sat, gjk) {
                (None, None) => {}
                (Some(s), Some(g)) => {
                    prop_assert!(g.depth <= s.depth + 1e-9, "{s:?} {g:?}");
                    prop_assert!(g.depth * 1.05 >= s.depth - 1e-9, "{s:?} {g:?}");
                    prop_assert!((g.normal.dot(g.b - g.a) - g.depth).abs() < 1e-7, "{g:?}");
                }
                (s, g) => {
                    let depth = s.map_or(0.0, |s| s.depth) + g.map_or(0.0, |g| g.depth);
                    prop_assert!(depth < 1e-9, "{s:?} {g:?}");
                }
            }
        }

        /// Rounded bodies whose cores are apart: the distance has a formula.
        #[test]
        fn rounded_bodies_agree_with_formulas(
            fa in frame(), fb in frame(), half in half_sides(), r in 0.1..1.0f64, s in 0.1..1.0f64,
        ) {
            let (c1, c2) = (Capsule::new(r, half.x).unwrap(), Capsule::new(s, half.y).unwrap());
            let (b1, b2) = (Body::capsule(&c1, &fa, fa.position), Body::capsule(&c2, &fb, fa.position));
            let ((p1, p2), (q1, q2)) = (c1.segment(&fa), c2.segment(&fb));
            let (p, q) = closest_segment_points(p1, p2, q1, q2);
            let want = r + s - (p - q).length();
            let got = touch(&b1, &b2).map_or(-1.0, |t| t.depth);
            prop_assert!(if want < 0.0 { got < 0.0 } else { (got - want).abs() < 1e-9 }, "{want} {got}");

            let cuboid = Cuboid::from_half_sides(half).unwrap();
            let (p, q) = closest_segment_cuboid(p1, p2, &cuboid, &fb);
            let want = r - (p - q).length();
            let got = touch(&b1, &Body::cuboid(&cuboid, &fb, fa.position)).map_or(-1.0, |t| t.depth);
            if (p - q).length() > 1e-9 {
                prop_assert!(if want < 0.0 { got < 0.0 } else { (got - want).abs() < 1e-9 }, "{want} {got}");
            } else {
                prop_assert!(got >= r, "{got}");
            }

            let ball = Sphere::new(s).unwrap();
            let mut list = Vec::new();
            let mut out = Contacts::new(&mut list, CollideOptions::new(1));
            crate::narrow::sphere_cuboid(&ball, &fa, &cuboid, &fb, &mut out);
            let got = touch(&Body::sphere(&ball, &fa, fa.position), &Body::cuboid(&cuboid, &fb, fa.position));
            match (list.first(), got) {
                (None, None) => {}
                (Some(w), Some(g)) => prop_assert!((w.point.depth - g.depth).abs() < 1e-9, "{w:?} {g:?}"),
                (w, g) => prop_assert!(false, "{w:?} {g:?}"),
            }
        }
    }
}
