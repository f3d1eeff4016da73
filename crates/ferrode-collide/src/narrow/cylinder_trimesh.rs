use super::cutout::Cutout;
use super::facet_axes::{
    FacetContacts, Least, LeastOverlap, Near, Place, Rule, clip_segment, each_facet, greater, lesser, level,
};
use super::unit::unit;
use crate::{Contacts, Cylinder, Frame, Shape, TriMesh};
use ferrode_math::simd::Quad;
use ferrode_math::{Vec3, Vector3};

/// Shortest axis that says anything, and least cosine of an edge and the cylinder's axis at which it meets the rims.
const SHORTEST: f64 = 1e-5;
/// Cosine of normal and axis from which a contact is at the cap rather than the side.
const CAP: f64 = 0.9;
/// Cosine and sine of 22.5°.
const COS: f64 = 0.923_879_532_511_286_7;
const SIN: f64 = 0.382_683_432_365_089_8;
/// Directions across the sides of an octagon.
const OCTAGON: [(f64, f64); 8] =
    [(COS, SIN), (SIN, COS), (-SIN, COS), (-COS, SIN), (-COS, -SIN), (-SIN, -COS), (SIN, -COS), (COS, -SIN)];

/// A cylinder and a mesh: for each triangle that has the cylinder's middle before it, the axis of least overlap among its
/// normal, the cylinder's axis and those that edges and corners make with side and rims; then the line of the cylinder
/// that is deepest, as far as it is over the triangle, or what of the triangle is over the cap, taken as an octagon about
/// its circle.
///
/// Where ODE's rule contradicts the surface, as at edges within it, the part of the cylinder's line or cap over the triangle
/// counts.
pub fn cylinder_trimesh(cylinder: &Cylinder, fa: &Frame, mesh: &TriMesh, fm: &Frame, out: &mut Contacts<'_>) {
    let rule = CylinderRule { radius: cylinder.radius(), length: 0.5 * cylinder.length() };
    each_facet(&Shape::Cylinder(*cylinder), fa, mesh, fm, out, &rule);
}

struct CylinderRule {
    radius: f64,
    /// Half.
    length: f64,
}

impl Rule for CylinderRule {
    const BOTH_SIDES: bool = false;

    #[inline(always)]
    fn half(&self) -> Vec3 {
        Vec3::new(self.radius, self.radius, self.length)
    }

    #[inline(always)]
    fn lowest<Q: Quad>(&self, n: Vector3<Q>) -> Vector3<Q> {
        let around = (n.x * n.x + n.y * n.y).sqrt();
        let scale = Q::select(Q::ZERO.lt(around), Q::splat(-self.radius) / around, Q::ZERO);
        Vector3::new(n.x * scale, n.y * scale, -Q::splat(self.length).copysign(n.z))
    }

    #[inline(always)]
    fn axes<Q: Quad>(&self, near: &Near<Q>, _: [u8; 4], wanted: Q::Mask) -> Least<Q> {
        let v = &near.corners;
        let (radius, half) = (Q::splat(self.radius), Q::splat(self.length));
        let mut best = LeastOverlap::new(near, SHORTEST, wanted);
        let edges = [v[1] - v[0], v[2] - v[1], v[0] - v[2]];
        // Axes across the cylinder's.
        for edge in &edges {
            let axis = Vector3::new(-edge.y, edge.x, Q::ZERO);
            let length = axis.length_squared().sqrt();
            best.test(axis, axis.length_squared(), length, radius * length, wanted);
        }
        for corner in v {
            let axis = Vector3::new(-corner.x, -corner.y, Q::ZERO);
            let length = axis.length_squared().sqrt();
            best.test(axis, axis.length_squared(), length, radius * length, wanted);
        }
        best.test(Vector3::Z, Q::ONE, Q::ONE, half, wanted);
        if best.all_apart() {
            return best.found();
        }
        // Where the line of an edge crosses the plane of a rim, the rim's tangent and the edge span a plane that may separate.
        let least = Q::splat(SHORTEST * SHORTEST);
        let inverse = [Q::ONE / edges[0].z, Q::ONE / edges[1].z, Q::ONE / edges[2].z];
        for end in 0..2 {
            let rim = if end == 0 { half } else { -half };
            for e in 0..3 {
                let edge = edges[e];
                let crosses = wanted & !(edge.z * edge.z).lt(least * edge.length_squared());
                let share = (rim - v[e].z) * inverse[e];
                let (x, y) = (v[e].x + edge.x * share, v[e].y + edge.y * share);
                // (x, y, 0) × z × edge.
                let axis = Vector3::new(-x * edge.z, -y * edge.z, x * edge.x + y * edge.y);
                let square = axis.length_squared();
                let reach = axis.z.abs() * half + radius * (axis.x * axis.x + axis.y * axis.y).sqrt();
                best.test(axis, square, square.sqrt(), reach, crosses);
            }
        }
        best.found()
    }

    fn contacts(&self, near: &Near<f64>, least: &Least<f64>, found: &mut FacetContacts) {
        let (v, n) = (&near.corners, least.normal);
        found.normal = n;
        if n.z.abs() < CAP {
            found.place = Place::Furthest;
            let Some(side) = unit(Vec3::new(n.x, n.y, 0.0)) else { return };
            let side = side * self.radius;
            let ends = [Vec3::new(-side.x, -side.y, self.length), Vec3::new(-side.x, -side.y, -self.length)];
            let level = level(v, n);
            for p in clip_segment(ends, v, near.normal).into_iter().flatten() {
                found.push(p, greater(level - n.dot(p), 0.0));
            }
            return;
        }
        found.place = Place::Deepest;
        let inward = if n.z > 0.0 { Vec3::Z } else { -Vec3::Z };
        let mut triangle = Cutout::new(v);
        triangle.clip(inward, self.length);
        // Most triangles are within the octagon, or near it on one side only.
        let (mut low, mut high) = (Vec3::splat(f64::INFINITY), Vec3::splat(f64::NEG_INFINITY));
        for p in triangle.corners() {
            low = Vec3::new(lesser(low.x, p.x), lesser(low.y, p.y), 0.0);
            high = Vec3::new(greater(high.x, p.x), greater(high.y, p.y), 0.0);
        }
        for (x, y) in OCTAGON {
            let most = x * if x > 0.0 { high.x } else { low.x } + y * if y > 0.0 { high.y } else { low.y };
            if most > self.radius {
                triangle.clip(Vec3::new(-x, -y, 0.0), self.radius);
            }
        }
        let reach = n.z.abs() * self.length + self.radius * (n.x * n.x + n.y * n.y).sqrt();
        for &p in triangle.corners() {
            let depth = reach + p.dot(n);
            if depth >= 0.0 {
                found.push(p, depth);
            }
        }
    }
}
