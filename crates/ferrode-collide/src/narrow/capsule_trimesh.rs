use super::facet_axes::{FacetContacts, LeastOverlap, Near, Place, Rule, clip_segment, each_facet, greater};
use crate::{Capsule, Contacts, Frame, Shape, TriMesh};
use ferrode_math::Vec3;

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
    fn lowest(&self, n: Vec3) -> Vec3 {
        Vec3::new(0.0, 0.0, -self.length.copysign(n.z)) - n * self.radius
    }

    fn touch(&self, near: &Near, flags: u8, found: &mut FacetContacts) -> bool {
        self.contacts(near, flags, found).is_some()
    }
}

impl CapsuleRule {
    fn contacts(&self, near: &Near, flags: u8, found: &mut FacetContacts) -> Option<()> {
        let v = &near.corners;
        let mut best = LeastOverlap::new(near, SHORTEST);
        let reach = |axis: Vec3, length: f64| axis.z.abs() * self.length + self.radius * length;
        let caps = [Vec3::Z * self.length, Vec3::Z * -self.length];
        let edges = [v[1] - v[0], v[2] - v[1], v[0] - v[2]];
        let owns = |bit: usize| flags & (1 << bit) != 0;
        for e in (0..3).filter(|&e| owns(e)) {
            best.test(Vec3::new(-edges[e].y, edges[e].x, 0.0), reach, 1.0, 1)?;
            for cap in caps {
                best.test((cap - v[e]).cross(edges[e]).cross(edges[e]), reach, 1.0, 1)?;
            }
        }
        for i in (0..3).filter(|&i| owns(3 + i)) {
            for cap in caps {
                let d = v[i] - cap;
                // (d × z) × z.
                best.test(Vec3::new(-d.x, -d.y, 0.0), reach, 1.0, 1)?;
                best.test(d, reach, 1.0, 1)?;
            }
        }
        let n = best.normal;
        found.normal = n;
        found.place = Place::Furthest;
        let line = clip_segment(caps.map(|cap| cap - n * self.radius), v, near.normal);
        let level = best.level();
        for p in line.into_iter().flatten() {
            found.push(p, greater(level - n.dot(p), 0.0));
        }
        Some(())
    }
}
