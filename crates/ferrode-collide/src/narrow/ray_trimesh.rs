use crate::space::Probe;
use crate::{Contacts, Frame, GeomContact, Ray, TriMesh};
use ferrode_math::Vec3;

/// A ray and a mesh: all hits, nearest first, or as the ray's options say; `side2` is the triangle.
///
/// Normals are the triangles' own, whichever side is hit. With `first_contact` or `closest_hit` only the nearest hit is
/// reported; `backface_cull` passes through triangles seen from behind.
pub fn ray_trimesh(ray: &Ray, fr: &Frame, mesh: &TriMesh, fm: &Frame, out: &mut Contacts<'_>) {
    let (o, u) = ray.line(fr);
    let (start, direction) = (fm.point_to_local(o), fm.vector_to_local(u));
    let nearest = ray.first_contact || ray.closest_hit;
    let mut limit = ray.length();
    let probe = Probe::ray(start, direction);
    if probe.enter_aabb(mesh.bounds(), limit).is_none() {
        return;
    }
    {
        let mut all = out.all();
        mesh.tree().seek(&probe, &mut limit, |i, limit| {
            let n = mesh.normal(i);
            if !(ray.backface_cull && n.dot(direction) > 0.0)
                && let Some(alpha) = ray_triangle(start, direction, *limit, mesh.corners(i), n)
            {
                if nearest {
                    *limit = alpha;
                }
                let mut c = GeomContact::new(o + u * alpha, fm.vector_to_world(n), alpha);
                c.side2 = i as i32;
                all.push_contact(c);
            }
        });
    }
    let wanted = if nearest { 1 } else { out.capacity() };
    out.added().sort_unstable_by(|a, b| a.point.depth.total_cmp(&b.point.depth).then(a.side2.cmp(&b.side2)));
    let found = out.len();
    out.truncate(found.min(wanted));
}

/// Where a ray meets a triangle, from either side.
///
/// The signs of the volumes that the ray spans with the edges decide; neighbours compute the same volume for their
/// common edge, so that no ray slips between them.
#[inline(always)]
pub(super) fn ray_triangle(
    start: Vec3,
    direction: Vec3,
    length: f64,
    corners: [Vec3; 3],
    normal: Vec3,
) -> Option<f64> {
    // Also of one without area, whose normal is zero.
    let slope = normal.dot(direction);
    if slope == 0.0 {
        return None;
    }
    let [a, b, c] = corners.map(|p| p - start);
    let (x, y) = (direction.dot(a.cross(b)), direction.dot(b.cross(c)));
    if (x > 0.0 && y < 0.0) || (x < 0.0 && y > 0.0) {
        return None;
    }
    let z = direction.dot(c.cross(a));
    if !((x >= 0.0 && y >= 0.0 && z >= 0.0) || (x <= 0.0 && y <= 0.0 && z <= 0.0)) {
        return None;
    }
    let alpha = normal.dot(a) / slope;
    (alpha >= 0.0 && alpha <= length).then_some(alpha)
}
