use super::heightfield_shape::Zone;
use super::ray_trimesh::ray_triangle;
use super::reduce::keep_wanted;
use crate::space::Probe;
use crate::{Contacts, Frame, GeomContact, Heightfield, TriMesh};
use ferrode_math::Vec3;

/// Half a cell: the triangle at its lesser, or its greater, x and z.
struct Half {
    corners: [Vec3; 3],
    /// Unit, up.
    normal: Vec3,
}

impl Half {
    fn new(field: &Heightfield, x: i64, z: i64, upper: bool) -> Option<Self> {
        let at = |i: i64, j: i64| field.vertex(x + i, z + j);
        let corners = if upper { [at(1, 1), at(1, 0), at(0, 1)] } else { [at(0, 0), at(0, 1), at(1, 0)] };
        let normal = (corners[1] - corners[0]).cross(corners[2] - corners[0]).normalized()?;
        Some(Self { corners, normal })
    }

    fn depth(&self, p: Vec3) -> f64 {
        self.normal.dot(self.corners[0] - p)
    }
}

/// Column and row of a cell, and whether it is the half at the greater x and z.
type Place = (i64, i64, bool);

/// The half cell over or under a point in the field's coordinates.
fn place_of(field: &Heightfield, zone: &Zone, p: Vec3) -> Option<Place> {
    let (sx, sz) = field.cell();
    let (u, v) = ((p.x + 0.5 * field.width()) / sx, (p.z + 0.5 * field.depth()) / sz);
    // The last row and column end at the rim.
    let cell = |u: f64, range: [i64; 2]| {
        let i = u.floor() as i64;
        let i = if i == range[1] && u == range[1] as f64 { i - 1 } else { i };
        (range[0]..range[1]).contains(&i).then_some(i)
    };
    let (x, z) = (cell(u, zone.x)?, cell(v, zone.z)?);
    Some((x, z, (u - x as f64) + (v - z as f64) >= 1.0))
}

/// A heightfield and a mesh: the mesh's vertices below the surface, by the plane of the triangle above them, and the
/// corners of the field inside the mesh, by the way down out of it; normals point into the field.
///
/// libode looks at no more than ten vertices for each plane, and measures the corners' depths the other way, up through the
/// mesh: of these its contacts are the vertices'.
pub(super) fn heightfield_trimesh(
    field: &Heightfield,
    zone: &Zone,
    mesh: &TriMesh,
    local: &Frame,
    out: &mut Contacts<'_>,
) {
    {
        let mut all = out.all();
        for (i, &v) in mesh.vertices().iter().enumerate() {
            let Some(first) = mesh.first_triangle(i as u32) else { continue };
            let p = local.point_to_world(v);
            let Some((x, z, upper)) = place_of(field, zone, p) else { continue };
            let Some(half) = Half::new(field, x, z, upper) else { continue };
            let depth = half.depth(p);
            if depth > 0.0 {
                let mut c = GeomContact::new(p, -half.normal, depth);
                c.side2 = first as i32;
                all.push_contact(c);
            }
        }
        let vertices = all.len();
        for x in zone.x[0]..=zone.x[1] {
            for z in zone.z[0]..=zone.z[1] {
                add_corner(field, zone, mesh, local, (x, z), vertices, &mut all);
            }
        }
    }
    let (sx, sz) = field.cell();
    keep_wanted(out, sx.min(sz));
}

/// The contact of a corner of the field that is inside the mesh, unless a vertex of the mesh is below a triangle at that
/// corner already.
fn add_corner(
    field: &Heightfield,
    zone: &Zone,
    mesh: &TriMesh,
    local: &Frame,
    (x, z): (i64, i64),
    vertices: usize,
    out: &mut Contacts<'_>,
) {
    let corner = field.vertex(x, z);
    let start = local.point_to_local(corner);
    if !mesh.bounds().contains_point(start) {
        return;
    }
    // The triangles that meet there.
    let around = [
        (x - 1, z - 1, true),
        (x - 1, z, false),
        (x - 1, z, true),
        (x, z - 1, false),
        (x, z - 1, true),
        (x, z, false),
    ];
    let within = |p: &Place| (zone.x[0]..zone.x[1]).contains(&p.0) && (zone.z[0]..zone.z[1]).contains(&p.1);
    let taken = |c: &GeomContact| {
        place_of(field, zone, c.point.position).is_some_and(|place| around.contains(&place))
    };
    if out.added()[..vertices].iter().any(taken) {
        return;
    }
    let Some(half) =
        around.iter().filter(|p| within(p)).find_map(|&(x, z, upper)| Half::new(field, x, z, upper))
    else {
        return;
    };
    // Down: the first triangle met is left through its back if the corner is inside.
    let down = local.vector_to_local(-half.normal);
    let mut limit = f64::INFINITY;
    let mut leaves = false;
    mesh.tree().seek(&Probe::ray(start, down), &mut limit, |i, limit| {
        let n = mesh.normal(i);
        if let Some(alpha) = ray_triangle(start, down, *limit, mesh.corners(i), n) {
            *limit = alpha;
            leaves = n.dot(down) > 0.0;
        }
    });
    if leaves && limit.is_finite() {
        out.push(corner, -half.normal, limit);
    }
}
