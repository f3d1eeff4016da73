//! The least overlap near a direction, on curved surfaces.
//!
//! The overlap of two bodies along a unit vector n is the reach h(n) = max n · w over their difference. Near n it changes
//! by the tangential part of the support point w, and that at the rates of the radii of curvature less h: Newton's method
//! on the sphere of directions. Where the difference is ruled, as at the side of a cylinder or the edge of a box, h has a
//! valley across which the support point jumps; there the descent goes on along the great circle of the valley, and the
//! point that touches lies on the segment of the jump.

use super::stationary::Least;
use super::support::{Body, Vertex, difference};
use super::unit::{unit, unit_or};
use ferrode_math::{Vec3, plane_space};

/// Angle over which curvature is measured, in radians.
const PROBE: f64 = 1e-4;
/// Angle to either side of a valley at which its two walls are looked at.
const WALL: f64 = 1e-6;
/// Most steps of either kind.
const STEPS: usize = 8;
/// Part of the bodies' size that the support point may be beside the foot of the origin.
const AT_FOOT: f64 = 1e-8;
/// Furthest step, in radians.
const FURTHEST: f64 = 0.4;
/// A support point that goes further than this part of the bodies' size has jumped.
const JUMP: f64 = 0.02;

/// Goes down from the unit vector `n` with support point `at`. `None` if that does not end at a direction whose
/// neighbours overlap more.
pub(super) fn descend(a: &Body<'_>, b: &Body<'_>, mut n: Vec3, mut at: Vertex, scale: f64) -> Option<Least> {
    let mut h = n.dot(at.w);
    for _ in 0..STEPS {
        let off = at.w - n * h;
        if off.length_squared() <= (AT_FOOT * scale) * (AT_FOOT * scale) {
            return Some(Least { normal: n, depth: h, w: at.w, a: at.a, b: at.b, firm: true });
        }
        let (s, t) = plane_space(n);
        // How the support point moves when the direction turns towards s and towards t.
        let by_s = (difference(a, b, n + s * PROBE).w - at.w) * (1.0 / PROBE);
        let by_t = (difference(a, b, n + t * PROBE).w - at.w) * (1.0 / PROBE);
        let (ss, tt) = (s.dot(by_s) - h, t.dot(by_t) - h);
        let st = 0.5 * (t.dot(by_s) + s.dot(by_t));
        let (os, ot) = (s.dot(off), t.dot(off));
        let det = ss * tt - st * st;
        let step = if ss + tt > 0.0 && det > 0.0 {
            (s * (tt * os - st * ot) + t * (ss * ot - st * os)) * (1.0 / det)
        } else {
            // No bowl here: a short way straight down.
            off * (0.1 / scale)
        };
        let length = step.length();
        let step = if length > FURTHEST { step * (FURTHEST / length) } else { step };
        let m = unit(n - step)?;
        let next = difference(a, b, m);
        let reach = m.dot(next.w);
        let jump = next.w - at.w;
        if jump.length_squared() > (JUMP * scale) * (JUMP * scale) && next.w.dot(n) < h - 0.5 * off.dot(step)
        {
            return follow_valley(a, b, m, jump, scale);
        }
        if !(reach < h + 1e-12 * scale) {
            return follow_valley(a, b, m, jump, scale);
        }
        (n, at, h) = (m, next, reach);
    }
    None
}

/// Goes down the valley whose walls are the ends of the segment along `along`, from near `n`.
fn follow_valley(a: &Body<'_>, b: &Body<'_>, mut n: Vec3, along: Vec3, scale: f64) -> Option<Least> {
    let mut e = unit(along)?;
    for _ in 0..STEPS {
        // Onto the great circle across e, whose direction the walls tell better the nearer they are.
        n = unit(n - e * e.dot(n))?;
        let (p, q) = (difference(a, b, n + e * WALL), difference(a, b, n - e * WALL));
        let wall = p.w - q.w;
        if wall.length_squared() <= (JUMP * scale) * (JUMP * scale) {
            return None;
        }
        e = unit(wall)?;
        n = unit_or(n - e * e.dot(n), n);
        let t = e.cross(n);
        let slope = t.dot(p.w);
        if slope.abs() <= AT_FOOT * scale {
            // The foot of the origin must lie between the walls.
            let (up, down) = (e.dot(p.w), e.dot(q.w));
            if !(up >= 0.0 && down <= 0.0) {
                return None;
            }
            let share = -down / (up - down);
            let mix = |x: Vec3, y: Vec3| y + (x - y) * share;
            let w = mix(p.w, q.w);
            return Some(Least {
                normal: n,
                depth: n.dot(w),
                w,
                a: mix(p.a, q.a),
                b: mix(p.b, q.b),
                firm: true,
            });
        }
        let h = n.dot(p.w);
        let turned = difference(a, b, n + t * PROBE + e * WALL).w - p.w;
        let rate = t.dot(turned) * (1.0 / PROBE) - h;
        if !(rate > 0.0) {
            return None;
        }
        n = unit(n - t * (slope / rate).clamp(-FURTHEST, FURTHEST))?;
    }
    None
}
