//! The least overlap next to a direction, to the last bits.
//!
//! The overlap of two bodies along a unit vector m is the reach h(m) = max m · w over their difference. Where it is least
//! (for bodies that are apart: most negative), the plane across m touches the difference at w = h m, the foot of the
//! origin. Which parts of the two surfaces meet there decides how many equations are left for m:
//!
//! | parts | what is left |
//! |---|---|
//! | a flat face | nothing: m is its normal |
//! | two ruled ones (edge, side of a cylinder or cone) | nothing: m is where two circles of directions cross |
//! | one ruled, one round or a corner | an angle on a circle |
//! | round ones (rim, ellipsoid) and corners | two angles |
//!
//! Newton's method finds the angles: the slope of h is the part of w across m, and it changes at the rates of the radii of
//! curvature less h, for which corners, rims and ellipsoids have formulas. If the foot then lies beside a part, or m points away
//! from it, the neighbouring part takes its place. The result is checked against the support functions of the whole bodies, so
//! that a point found is one where the overlap is stationary, and of bodies apart the nearest.

mod part;

use super::support::{Body, Vertex, difference};
use super::unit::unit;
use ferrode_math::{Vec3, plane_space};
use part::{Beside, Bound, ON_AXIS, Part};

/// A direction whose neighbours all overlap more.
#[derive(Clone, Copy, Debug)]
pub(super) struct Least {
    /// Unit.
    pub normal: Vec3,
    pub depth: f64,
    /// The point of the difference that touches the plane across the normal, which is the foot of the origin there, and
    /// the points of the two bodies.
    pub w: Vec3,
    pub a: Vec3,
    pub b: Vec3,
    /// Whether directions some way around overlap more, as far as the parts that touch tell.
    pub firm: bool,
}

/// Most steps in all, with the same parts, and from parts to others, and most times that a disc is left for its rim; then it goes
/// round in circles. Of 15,000 searches that ended well, 70 took more; one from nearer by may not.
const STEPS: usize = 24;
const ALIKE: usize = 8;
const CHANGES: usize = 8;
const DISCS: usize = 1;
/// Furthest step, in radians.
const FURTHEST: f64 = 0.3;
/// How often a step is cut to a quarter that would lead across a disc.
const SHORTER: usize = 4;
/// After a step no longer than this, in radians, another would change nothing but rounding.
const SETTLED: f64 = 1e-8;
/// Part of the bodies' size that the foot may be beside the touching points: what rounding makes of lines nearly parallel.
const AT_FOOT: f64 = 1e-10;
/// Part of the bodies' size by which they may reach further than the parts that touch.
const REACH: f64 = 1e-11;
/// Part of the depth that the way to a part's end, and the rise of the slope, must have for a way out to be firm.
const FIRM: f64 = 0.2;
/// Squared sine of the angle between lines below which they are parallel.
const PARALLEL: f64 = 1e-20;

/// What a step came to.
enum Step {
    /// The next direction, how far it is, and how fast the slope rises in the direction where that is slowest.
    Turn(Vec3, f64, f64),
    /// Nothing is left to choose.
    Settled(Vec3),
}

/// Goes from the unit vector `m`, near the least overlap, to it; `found` are support points of the difference near there.
/// `None` if that does not end at a direction whose neighbours overlap more, and that overlaps by no more than `most`.
pub(super) fn least_near(
    a: &Body<'_>,
    b: &Body<'_>,
    m: Vec3,
    found: &[Vertex],
    scale: f64,
    most: f64,
) -> Option<Least> {
    let mut points = [Vec3::ZERO; 3];
    let count = found.len().min(3);
    let mut part = |body: &Body<'_>, of: fn(&Vertex) -> Vec3, d: Vec3, discs: bool| {
        points.iter_mut().zip(found).for_each(|(p, v)| *p = of(v));
        Part::through(body, &points[..count], d, discs)
    };
    let (pa, pb) = (part(a, |v| v.a, m, false)?, part(b, |v| v.b, -m, false)?);
    let discs = pa.may_be_disc(m) || pb.may_be_disc(-m);
    let least = go_down(a, b, m, pa, pb, scale).filter(|l| l.depth <= most);
    if least.is_some() || !discs {
        return least;
    }
    let (pa, pb) = (part(a, |v| v.a, m, true)?, part(b, |v| v.b, -m, true)?);
    go_down(a, b, m, pa, pb, scale).filter(|l| l.depth <= most)
}

/// From the unit vector `m` and the parts that face it to those where the overlap is least.
fn go_down(a: &Body<'_>, b: &Body<'_>, mut m: Vec3, mut pa: Part, mut pb: Part, scale: f64) -> Option<Least> {
    let slack = 1e-15 * scale;
    // Whether the foot was found to lie beside a disc: then its rim is not left across it any more.
    let mut off_disc = false;
    // The direction of last looking beside the axis of a disc.
    let mut leaning = m;
    let (mut alike, mut changes, mut discs) = (0, 0, 0);
    for _ in 0..STEPS {
        if alike > ALIKE || changes > CHANGES || discs > DISCS {
            return None;
        }
        alike += 1;
        let (mut next, mut settled, bend) = match step(a, b, &pa, &pb, m, scale)? {
            Step::Turn(next, length, bend) => (next, length <= SETTLED, bend),
            Step::Settled(next) => (next, true, f64::INFINITY),
        };
        if off_disc {
            for _ in 0..SHORTER {
                if pa.crosses(next, m) || pb.crosses(-next, -m) {
                    (next, settled) = (unit(m * 3.0 + next)?, false);
                }
            }
        }
        // The parts may not face the new direction any more.
        let (mut la, mut lb) = (pa.left(a, next, m, slack), pb.left(b, -next, -m, slack));
        // On a face the other body has the furthest point, wherever that is.
        if is_flat(&pa) {
            (pb, lb) = (Part::through(b, &[b.support(-next)], -next, false)?, None);
        } else if is_flat(&pb) {
            (pa, la) = (Part::through(a, &[a.support(next)], next, false)?, None);
        }
        if !settled {
            leaning = m;
        }
        m = next;
        if la.is_some() || lb.is_some() {
            pa = la.unwrap_or(pa);
            pb = lb.unwrap_or(pb);
            (alike, changes) = (0, changes + 1);
            continue;
        }
        if !settled {
            continue;
        }
        match foot(a, b, &pa, &pb, m)? {
            Foot::At(pa, pb, inside) => {
                let whole = difference(a, b, m);
                let w = pa - pb;
                let depth = m.dot(w);
                let off = w - m * depth;
                let good = off.length_squared() <= (AT_FOOT * scale) * (AT_FOOT * scale)
                    && m.dot(whole.w) - depth <= REACH * scale;
                // Turning by a small angle t changes the overlap by inside · t, or bend · t²/2, less depth · t²/2.
                let firm = inside >= FIRM * depth && bend >= FIRM * depth;
                return good.then_some(Least { normal: m, depth, w, a: pa, b: pb, firm });
            }
            Foot::Beside(na, nb) => {
                if is_disc(&pa) || is_disc(&pb) {
                    // Off its axis again, where the rim has a direction.
                    m = if m.dot(leaning) < ON_AXIS { leaning } else { rim_direction(a, b, &pa, &pb, m)? };
                    off_disc = true;
                    discs += 1;
                }
                (alike, changes) = (0, changes + 1);
                pa = na.unwrap_or(pa);
                pb = nb.unwrap_or(pb);
            }
        }
    }
    None
}

fn is_disc(p: &Part) -> bool {
    matches!(p, Part::Disc { .. })
}

fn is_flat(p: &Part) -> bool {
    matches!(p, Part::Triangle { .. } | Part::Disc { .. })
}

/// For a disc with the foot beside it: the direction between its rim and the other body.
fn rim_direction(a: &Body<'_>, b: &Body<'_>, pa: &Part, pb: &Part, m: Vec3) -> Option<Vec3> {
    let w = if is_disc(pa) {
        let q = b.support(-m);
        pa.rim_towards(q)? - q
    } else {
        let q = a.support(m);
        q - pb.rim_towards(q)?
    };
    unit(w).map(|w| if w.dot(m) < 0.0 { -w } else { w })
}

/// A step towards the direction of least overlap of two parts.
fn step(a: &Body<'_>, b: &Body<'_>, pa: &Part, pb: &Part, m: Vec3, scale: f64) -> Option<Step> {
    let (ba, bb) = (pa.bound(), pb.bound());
    match (ba, bb) {
        (Bound::Fixed(n), _) => return Some(Step::Settled(n)),
        (_, Bound::Fixed(n)) => return Some(Step::Settled(-n)),
        (Bound::Circle(e, x), Bound::Circle(f, y)) => {
            let across = e.cross(f);
            let square = across.length_squared();
            if square > PARALLEL {
                return crossing(e, x, f, -y, m).map(Step::Settled);
            }
            return on_circle(a, b, pa, pb, e, x, m, scale);
        }
        (Bound::Circle(e, x), Bound::Free) => return on_circle(a, b, pa, pb, e, x, m, scale),
        (Bound::Free, Bound::Circle(e, x)) => return on_circle(a, b, pa, pb, e, -x, m, scale),
        (Bound::Free, Bound::Free) => {}
    }
    let (s, t) = plane_space(m);
    let (qa, ja) = pa.point(a, m, s, t);
    let (qb, jb) = pb.point(b, -m, s, t);
    let w = qa - qb;
    let h = m.dot(w);
    let (ss, st, tt) = (ja[0] + jb[0] - h, ja[1] + jb[1], ja[2] + jb[2] - h);
    let (os, ot) = (s.dot(w), t.dot(w));
    let det = ss * tt - st * st;
    let turn = if ss + tt > 0.0 && det > 0.0 {
        (s * (tt * os - st * ot) + t * (ss * ot - st * os)) * (1.0 / det)
    } else {
        // No bowl here: straight down, to where other parts take over.
        let off = s * os + t * ot;
        let length = off.length();
        if !(length > 1e-9 * scale) {
            return None;
        }
        off * (FURTHEST / length)
    };
    let length = turn.length();
    let turn = if length > FURTHEST { turn * (FURTHEST / length) } else { turn };
    // The lesser eigenvalue.
    let bend = 0.5 * (ss + tt - ((ss - tt) * (ss - tt) + 4.0 * st * st).sqrt());
    Some(Step::Turn(unit(m - turn)?, length, bend))
}

/// The unit vector nearest to `m` whose products with the unit vectors `e` and `f` are `x` and `y`.
fn crossing(e: Vec3, x: f64, f: Vec3, y: f64, m: Vec3) -> Option<Vec3> {
    let c = e.dot(f);
    let n = e.cross(f);
    let square = n.length_squared();
    let (i, j) = ((x - y * c) / square, (y - x * c) / square);
    let flat = e * i + f * j;
    let rest = 1.0 - flat.length_squared();
    if !(rest > 0.0) {
        return None;
    }
    let up = n * (rest / square).sqrt();
    unit(if n.dot(m) < 0.0 { flat - up } else { flat + up })
}

/// A step on the circle of directions whose product with `e` is `x`.
#[allow(clippy::too_many_arguments)]
fn on_circle(
    a: &Body<'_>,
    b: &Body<'_>,
    pa: &Part,
    pb: &Part,
    e: Vec3,
    x: f64,
    m: Vec3,
    scale: f64,
) -> Option<Step> {
    let radius = (1.0 - x * x).max(0.0).sqrt();
    // Onto the circle first: only there the slope along it tells where to go.
    let out = unit(m - e * e.dot(m))?;
    let on = e * x + out * radius;
    let tangent = e.cross(out);
    let (qa, ja) = pa.point(a, on, tangent, e);
    let (qb, jb) = pb.point(b, -on, tangent, e);
    let w = qa - qb;
    let slope = tangent.dot(w);
    // The margin of a cylinder's side goes with the direction: it bends as much as it reaches.
    let margin = |p: &Part| if let Part::Line { margin, .. } = p { *margin } else { 0.0 };
    let margins = margin(pa) + margin(pb);
    let rate = radius * (ja[0] + jb[0]) - out.dot(w) + margins;
    let turn = if rate > 0.0 {
        slope / rate
    } else {
        if !(slope.abs() > 1e-9 * scale) {
            return None;
        }
        FURTHEST.copysign(slope)
    };
    let turn = turn.clamp(-FURTHEST, FURTHEST);
    let out = unit(out - tangent * turn)?;
    let next = e * x + out * radius;
    Some(Step::Turn(next, (next - m).length(), rate))
}

/// Where the foot of the origin is.
enum Foot {
    /// The points of the two bodies, and how far the next end or edge of a part is at least.
    At(Vec3, Vec3, f64),
    /// Beside these parts, on those.
    Beside(Option<Part>, Option<Part>),
}

fn foot(a: &Body<'_>, b: &Body<'_>, pa: &Part, pb: &Part, m: Vec3) -> Option<Foot> {
    let (qa, _) = pa.point(a, m, Vec3::ZERO, Vec3::ZERO);
    let (qb, _) = pb.point(b, -m, Vec3::ZERO, Vec3::ZERO);
    let w = qa - qb;
    let h = m.dot(w);
    if is_flat(pa) || is_flat(pb) {
        // The other's furthest point, seen on the face.
        if is_flat(pa) {
            let qb = b.support(-m);
            let qa = qb + m * m.dot(qa - qb);
            return Some(match pa.beside(qa) {
                Beside::Within(inside) => Foot::At(qa, qb, inside),
                Beside::On(p) => Foot::Beside(Some(p), None),
            });
        }
        let qa = a.support(m);
        let qb = qa - m * m.dot(qa - qb);
        return Some(match pb.beside(qb) {
            Beside::Within(inside) => Foot::At(qa, qb, inside),
            Beside::On(p) => Foot::Beside(None, Some(p)),
        });
    }
    let off = w - m * h;
    let (ra, rb) = (pa.ruling(a, m), pb.ruling(b, -m));
    let (x, y) = match (ra, rb) {
        (None, None) => (0.0, 0.0),
        (Some(u), None) => (-off.dot(u) / u.length_squared(), 0.0),
        (None, Some(v)) => (0.0, off.dot(v) / v.length_squared()),
        (Some(u), Some(v)) => {
            let det = u.cross(v).dot(m);
            if det * det > PARALLEL * u.length_squared() * v.length_squared() {
                (-(off.cross(v).dot(m)) / det, -(off.cross(u).dot(m)) / det)
            } else {
                // Side by side: the middle of their common stretch, or the ends that face each other. Shares of b's line
                // by those of a's: y = (along + x) · rate.
                let along = off.dot(u) / u.length_squared();
                let rate = u.dot(v) / v.length_squared();
                let ((a_lo, a_hi), (b_lo, b_hi)) = (pa.shares(), pb.shares());
                let (p, q) = (b_lo / rate - along, b_hi / rate - along);
                let (lo, hi) = (a_lo.max(p.min(q)), a_hi.min(p.max(q)));
                let x = if lo <= hi {
                    0.5 * (lo + hi)
                } else if lo > a_hi {
                    // Both ends, as neither line has the foot.
                    return Some(Foot::Beside(pa.beyond(a, lo), pb.beyond(b, (along + a_hi) * rate)));
                } else {
                    return Some(Foot::Beside(pa.beyond(a, hi), pb.beyond(b, (along + a_lo) * rate)));
                };
                (x, (along + x) * rate)
            }
        }
    };
    let (na, nb) = (pa.beyond(a, x), pb.beyond(b, y));
    if na.is_some() || nb.is_some() {
        return Some(Foot::Beside(na, nb));
    }
    let along = |q: Vec3, r: Option<Vec3>, x: f64| r.map_or(q, |r| q + r * x);
    let inside = |p: &Part, r: Option<Vec3>, x: f64| {
        r.map_or(f64::INFINITY, |r| {
            let (lo, hi) = p.shares();
            (x - lo).min(hi - x) * r.length()
        })
    };
    let inside = inside(pa, ra, x).min(inside(pb, rb, y));
    // The field between two lines is as much narrower as they are parallel.
    let sine = match (ra, rb) {
        (Some(u), Some(v)) => u.cross(v).length() / (u.length() * v.length()),
        _ => 1.0,
    };
    Some(Foot::At(along(qa, ra, x), along(qb, rb, y), inside * sine))
}
