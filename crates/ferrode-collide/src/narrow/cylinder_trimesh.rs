use super::cutout::Cutout;
use super::facet_axes::{
    FacetContacts, LeastOverlap, Near, Place, Rule, clip_segment, each_facet, greater, lesser,
};
use super::unit::unit;
use crate::{Contacts, Cylinder, Frame, Shape, TriMesh};
use ferrode_math::Vec3;

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
    fn lowest(&self, n: Vec3) -> Vec3 {
        let around = (n.x * n.x + n.y * n.y).sqrt();
        let scale = if around > 0.0 { -self.radius / around } else { 0.0 };
        Vec3::new(n.x * scale, n.y * scale, -self.length.copysign(n.z))
    }

    fn touch(&self, near: &Near, _: u8, found: &mut FacetContacts) -> bool {
        self.contacts(near, found).is_some()
    }
}

impl CylinderRule {
    fn contacts(&self, near: &Near, found: &mut FacetContacts) -> Option<()> {
        let v = &near.corners;
        let reach = |axis: Vec3, _: f64| {
            axis.z.abs() * self.length + self.radius * (axis.x * axis.x + axis.y * axis.y).sqrt()
        };
        // Along axes across the cylinder's.
        let around = |_: Vec3, length: f64| self.radius * length;
        let mut best = LeastOverlap::new(near, SHORTEST);
        let edges = [v[1] - v[0], v[2] - v[1], v[0] - v[2]];
        for edge in edges {
            best.test(Vec3::new(-edge.y, edge.x, 0.0), around, 1.0, 1)?;
        }
        for corner in v {
            best.test(Vec3::new(-corner.x, -corner.y, 0.0), around, 1.0, 1)?;
        }
        best.test(Vec3::Z, |_, _| self.length, 1.0, 1)?;
        // Where the line of an edge crosses the plane of a rim, the rim's tangent and the edge span a plane that may separate.
        let inverse = edges.map(|edge| {
            let level = edge.z * edge.z < SHORTEST * SHORTEST * edge.length_squared();
            (!level).then(|| 1.0 / edge.z)
        });
        for rim in [self.length, -self.length] {
            for (e, edge) in edges.iter().enumerate() {
                let Some(inverse) = inverse[e] else { continue };
                let share = (rim - v[e].z) * inverse;
                let (x, y) = (v[e].x + edge.x * share, v[e].y + edge.y * share);
                // (x, y, 0) × z × edge.
                let axis = Vec3::new(-x * edge.z, -y * edge.z, x * edge.x + y * edge.y);
                best.test(axis, reach, 1.0, 1)?;
            }
        }
        let n = best.normal;
        found.normal = n;
        if n.z.abs() < CAP {
            found.place = Place::Furthest;
            let side = unit(Vec3::new(n.x, n.y, 0.0))? * self.radius;
            let ends = [Vec3::new(-side.x, -side.y, self.length), Vec3::new(-side.x, -side.y, -self.length)];
            let level = best.level();
            for p in clip_segment(ends, v, near.normal).into_iter().flatten() {
                found.push(p, greater(level - n.dot(p), 0.0));
            }
            return Some(());
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
        let reach = reach(n, 1.0);
        for &p in triangle.corners() {
            let depth = reach + p.dot(n);
            if depth >= 0.0 {
                found.push(p, depth);
            }
        }
        Some(())
    }
}
