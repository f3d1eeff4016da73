use super::heightfield_shape::Zone;
use super::reduce::reduce;
use super::support::Body;
use super::triangle::{Facet, body_facet};
use crate::shape::Neighbour;
use crate::{Contacts, Frame, Heightfield, Shape};
use ferrode_math::Vec3;

impl Heightfield {
    /// A half of the cell at column `x` and row `z`: the one at its lesser or its greater x and z, seen from above.
    pub(crate) fn facet(&self, x: i64, z: i64, upper: bool) -> Option<Facet> {
        // The corners, and for each edge the far corner of the triangle beyond.
        let (corners, apexes) = if upper {
            ([(1, 1), (1, 0), (0, 1)], [(2, 0), (0, 0), (0, 2)])
        } else {
            ([(0, 0), (0, 1), (1, 0)], [(-1, 1), (1, 1), (1, -1)])
        };
        let at = |(i, j): (i64, i64)| self.vertex(x + i, z + j);
        let corners = corners.map(at);
        let normal = (corners[1] - corners[0]).cross(corners[2] - corners[0]).normalized()?;
        let mut neighbours = [Neighbour::None; 3];
        for (e, apex) in apexes.into_iter().enumerate() {
            let (i, j) = (x + apex.0, z + apex.1);
            let within = |k: i64, n: usize| (0..n as i64).contains(&k);
            if self.is_wrapped() || (within(i, self.columns()) && within(j, self.rows())) {
                let (start, end, apex) = (corners[e], corners[(e + 1) % 3], at(apex));
                let other = (start - end).cross(apex - end).normalized_or(normal);
                neighbours[e] = Neighbour::across(start, end, apex, normal, other);
            }
        }
        Some(Facet { corners, normal, neighbours, index: -1 })
    }
}

/// Any convex shape of finite size and a heightfield: the contacts of all triangles below it, without doubles, as with
/// a mesh. A shape that has sunk below the surface has none.
pub fn body_heightfield(shape: &Shape, fa: &Frame, field: &Heightfield, ff: &Frame, out: &mut Contacts<'_>) {
    // All in the field's coordinates.
    let local = Frame::new(ff.point_to_local(fa.position), ff.rotation.transpose() * fa.rotation);
    let Some(body) = Body::of(shape, &local, Vec3::ZERO) else { return };
    let aabb = shape.aabb_in(&local);
    let Some(zone) = Zone::under(field, &aabb) else { return };
    if aabb.min.y > zone.high {
        return;
    }
    let middle = body.middle();
    {
        let mut all = out.all();
        for x in zone.x[0]..zone.x[1] {
            for z in zone.z[0]..zone.z[1] {
                for upper in [false, true] {
                    if let Some(facet) = field.facet(x, z, upper) {
                        body_facet(&body, middle, &facet, &mut all);
                    }
                }
            }
        }
    }
    reduce(out, body.reach());
    for c in out.added() {
        c.point.position = ff.point_to_world(c.point.position);
        c.point.normal = ff.vector_to_world(c.point.normal);
        // From midway to the body's own surface, as over a plane.
        c.point.position -= c.point.normal * (0.5 * c.point.depth);
    }
}
