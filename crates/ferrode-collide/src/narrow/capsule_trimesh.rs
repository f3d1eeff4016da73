use super::facet_axes::{
    FacetContacts, Least, LeastOverlap, Near, Place, Rule, clip_segment, each_facet, greater, level,
};
use crate::{Capsule, Contacts, Frame, Shape, TriMesh};
use ferrode_math::simd::{Mask, Quad};
use ferrode_math::{Vec3, Vector3};

/// Shortest axis that says anything.
const SHORTEST: f64 = 1e-5;

/// A capsule and a mesh: for each triangle that has the capsule's middle before it, the axis of least overlap among its
/// normal and those that its own edges and corners make with the capsule; then the line of the capsule that is deepest,
/// as far as it is over the triangle. Contacts lie on the capsule.
///
/// Where ODE's rule contradicts the surface, as at edges within it, the part of the capsule's line over the triangle counts.
pub fn capsule_trimesh(capsule: &Capsule, fa: &Frame, mesh: &TriMesh, fm: &Frame, out: &mut Contacts<'_>) {
    let rule = CapsuleRule { radius: capsule.radius(), length: 0.5 * capsule.length() };
    each_facet(&Shape::Capsule(*capsule), fa, mesh, fm, out, &rule);
}

struct CapsuleRule {
    radius: f64,
    /// Half that of the axis.
    length: f64,
}

impl Rule for CapsuleRule {
    const BOTH_SIDES: bool = false;

    #[inline(always)]
    fn half(&self) -> Vec3 {
        Vec3::new(self.radius, self.radius, self.radius + self.length)
    }

    #[inline(always)]
    fn lowest<Q: Quad>(&self, n: Vector3<Q>) -> Vector3<Q> {
        let end = Vector3::new(Q::ZERO, Q::ZERO, -Q::splat(self.length).copysign(n.z));
        end - n * Q::splat(self.radius)
    }

    #[inline(always)]
    fn axes<Q: Quad>(&self, near: &Near<Q>, flags: [u8; 4], wanted: Q::Mask) -> Least<Q> {
        let v = &near.corners;
        let mut best = Axes { best: LeastOverlap::new(near, SHORTEST, wanted), rule: self };
        let edges = [v[1] - v[0], v[2] - v[1], v[0] - v[2]];
        let length = Q::splat(self.length);
        let caps = [Vector3::new(Q::ZERO, Q::ZERO, length), Vector3::new(Q::ZERO, Q::ZERO, -length)];
        for e in 0..3 {
            let own = owners::<Q>(flags, e) & best.best.every();
            if own.any() {
                best.test(Vector3::new(-edges[e].y, edges[e].x, Q::ZERO), own);
                best.test((caps[0] - v[e]).cross(edges[e]).cross(edges[e]), own);
                best.test((caps[1] - v[e]).cross(edges[e]).cross(edges[e]), own);
            }
        }
        for (i, corner) in v.iter().enumerate() {
            let own = owners::<Q>(flags, 3 + i) & best.best.every();
            if own.any() {
                for cap in &caps {
                    let d = *corner - *cap;
                    // (d × z) × z.
                    best.test(Vector3::new(-d.x, -d.y, Q::ZERO), own);
                    best.test(d, own);
                }
            }
        }
        best.best.found()
    }

    fn contacts(&self, near: &Near<f64>, least: &Least<f64>, found: &mut FacetContacts) {
        let (v, n) = (&near.corners, least.normal);
        found.normal = n;
        found.place = Place::Furthest;
        let caps = [Vec3::Z * self.length, Vec3::Z * -self.length];
        let line = clip_segment(caps.map(|cap| cap - n * self.radius), v, near.normal);
        let level = level(v, n);
        for p in line.into_iter().flatten() {
            found.push(p, greater(level - n.dot(p), 0.0));
        }
    }
}

/// Which of four triangles have a bit set.
#[inline(always)]
fn owners<Q: Quad>(flags: [u8; 4], bit: usize) -> Q::Mask {
    let [a, b, c, d] = flags;
    let own = |f: u8| f64::from(f >> bit & 1);
    Q::ZERO.lt(Q::load(&[own(a), own(b), own(c), own(d)]))
}

struct Axes<'a, Q: Quad> {
    best: LeastOverlap<Q>,
    rule: &'a CapsuleRule,
}

impl<Q: Quad> Axes<'_, Q> {
    #[inline(always)]
    fn test(&mut self, axis: Vector3<Q>, own: Q::Mask) {
        let square = axis.length_squared();
        let length = square.sqrt();
        let reach = axis.z.abs() * Q::splat(self.rule.length) + Q::splat(self.rule.radius) * length;
        self.best.test(axis, square, length, reach, own);
    }
}
