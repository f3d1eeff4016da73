use super::convex::{Touch, touch};
use super::facet_axes::lift_out;
use super::manifold::add_manifold;
use super::ray_trimesh::ray_triangle;
use super::reduce::reduce;
use super::sieve::{Numbers, Sieve};
use super::support::{Body, Core};
use super::triangle::{Facet, near_facet};
use crate::space::Probe;
use crate::{Contacts, Frame, GeomContact, Shape, TriMesh};
use ferrode_math::{Aabb, Vec3};

impl TriMesh {
    /// Triangle `i` in the mesh's coordinates; `None` if it has no area.
    pub(crate) fn facet(&self, i: u32) -> Option<Facet> {
        let normal = self.normal(i);
        (normal.length_squared() > 0.0).then(|| Facet {
            corners: self.corners(i),
            normal,
            neighbours: *self.neighbours(i),
            index: i as i32,
        })
    }
}

/// Any convex shape of finite size and a mesh: the contacts of all triangles, without doubles.
///
/// Contacts lie on the body. `side2` of one is the triangle. Where there are more contacts than wanted, the deepest and the most different
/// stay.
pub fn body_trimesh(shape: &Shape, fa: &Frame, mesh: &TriMesh, fm: &Frame, out: &mut Contacts<'_>) {
    in_mesh(shape, fa, mesh, fm, |body, around| on_surface(body, mesh, around, fm, out));
}

/// A convex body without a rule of its own, and a mesh: the contacts of [`body_trimesh`], or if it has sunk through the surface
/// the one that lifts it out.
pub(super) fn convex_trimesh(shape: &Shape, fa: &Frame, mesh: &TriMesh, fm: &Frame, out: &mut Contacts<'_>) {
    in_mesh(shape, fa, mesh, fm, |body, around| {
        on_surface(body, mesh, around, fm, out);
        if !out.is_empty() {
            return;
        }
        lift_out(body, mesh, around, out);
        for c in out.added() {
            c.point.position = fm.point_to_world(c.point.position);
            c.point.normal = fm.vector_to_world(c.point.normal);
        }
    });
}

/// Calls `find` with a body, and the box around it, in the coordinates of a mesh, unless the two are apart.
#[inline]
fn in_mesh(shape: &Shape, fa: &Frame, mesh: &TriMesh, fm: &Frame, find: impl FnOnce(&Body<'_>, &Aabb)) {
    let reach = shape.reach() * (1.0 + 1e-9);
    let at = fm.point_to_local(fa.position);
    if !mesh.bounds().overlaps(&Aabb::from_center(at, Vec3::splat(reach))) {
        return;
    }
    let local = Frame::new(at, fm.rotation.transpose() * fa.rotation);
    if let Some(body) = Body::of(shape, &local, Vec3::ZERO) {
        find(&body, &shape.aabb_in(&local));
    }
}

fn on_surface(body: &Body<'_>, mesh: &TriMesh, around: &Aabb, fm: &Frame, out: &mut Contacts<'_>) {
    let middle = body.middle();
    {
        let mut all = out.all();
        // That a triangle does not face the middle is seen below; that of the box is another.
        let (frame, half) = box_around(body);
        let sieve = Sieve::new(mesh, frame, half, true);
        sieve.each(&Numbers::near(mesh, around), |i, meets_box| {
            if let Some(facet) = mesh.facet(i) {
                near_facet(body, middle, &facet, meets_box, &mut all);
            }
        });
        drop_long_ways(body, mesh, &mut all);
        let found = all.len();
        drop_beyond(mesh, &mut all);
        if found > 0 && all.is_empty() {
            least_touch(body, mesh, around, &mut all);
        }
    }
    reduce(out, body.reach());
    for c in out.added() {
        c.point.position = fm.point_to_world(c.point.position);
        c.point.normal = fm.vector_to_world(c.point.normal);
        // From midway to the body's own surface, as over a plane.
        c.point.position -= c.point.normal * (0.5 * c.point.depth);
    }
}

/// The box around a body along its own axes: where it is, and half its sides.
pub(super) fn box_around(body: &Body<'_>) -> (Frame, Vec3) {
    if let Core::Hull(hull) = body.core {
        let bounds = hull.bounds();
        return (Frame::new(body.place(bounds.center()), body.rotation), bounds.extent() * 0.5);
    }
    let (mut middle, mut half) = (Vec3::ZERO, Vec3::ZERO);
    for k in 0..3 {
        let axis = body.axis(k);
        let high = axis.dot(body.support(axis)) + body.margin;
        let low = axis.dot(body.support(-axis)) - body.margin;
        middle += axis * (0.5 * (high + low));
        half[k] = 0.5 * (high - low);
    }
    (Frame::new(middle, body.rotation), half)
}

/// Drops contacts with faces whose deep end is not below the surface: a pole in the hole of a ring ends before the plane of a
/// triangle of the ring, and on the other side of the ring. Where a body is deeper than a triangle is large, what lies
/// between its deep end and the triangle tells.
fn drop_beyond(mesh: &TriMesh, out: &mut Contacts<'_>) {
    let list = out.added();
    let mut kept = 0;
    for i in 0..list.len() {
        let c = list[i];
        let facet = mesh.facet(c.side2 as u32);
        let deep = facet.is_some_and(|facet| {
            c.point.normal.dot(facet.normal) > 1.0 - SAME && c.point.depth > facet.scale()
        });
        if !deep || !leaves(mesh, c.point.position, c.point.normal, c.point.depth) {
            list[kept] = c;
            kept += 1;
        }
    }
    out.truncate(kept);
}

/// Whether another triangle lies across the way from a face down to the deep end of a contact; `middle` is midway.
fn leaves(mesh: &TriMesh, middle: Vec3, normal: Vec3, depth: f64) -> bool {
    let margin = 1e-6 * depth;
    let (start, length) = (middle + normal * (0.5 * depth - margin), depth - 2.0 * margin);
    let mut limit = length;
    let mut crossed = false;
    mesh.tree().seek(&Probe::ray(start, -normal), &mut limit, |i, limit| {
        if ray_triangle(start, -normal, *limit, mesh.corners(i), mesh.normal(i)).is_some() {
            crossed = true;
            *limit = 0.0;
        }
    });
    crossed
}

/// The contact of the triangle that the body leaves soonest, whatever its neighbours say: at a saddle of a surface no
/// triangle has the direction in which the body leaves among its own.
fn least_touch(body: &Body<'_>, mesh: &TriMesh, around: &Aabb, out: &mut Contacts<'_>) {
    let mut least: Option<(Touch, u32)> = None;
    mesh.tree().query(around, |i| {
        if mesh.normal(i).length_squared() > 0.0
            && let Some(t) = touch(body, &Body::triangle(mesh.corners(i)))
            && least.as_ref().is_none_or(|(best, of)| (t.depth, i) < (best.depth, *of))
        {
            least = Some((t, i));
        }
    });
    let Some((t, i)) = least else { return };
    let first = out.len();
    add_manifold(body, &Body::triangle(mesh.corners(i)), &t, Vec3::ZERO, out);
    for c in &mut out.added()[first..] {
        c.side2 = i as i32;
    }
}

/// Cosines nearer than this are one direction.
const SAME: f64 = 1e-6;

/// Drops contacts with faces that a body leaves sooner over an edge or corner nearby: if what parts it from the edge parts it
/// from the face as well, the face would push it the long way.
fn drop_long_ways(body: &Body<'_>, mesh: &TriMesh, out: &mut Contacts<'_>) {
    let list = out.added();
    let on_face = |c: &GeomContact| c.point.normal.dot(mesh.normal(c.side2 as u32)) > 1.0 - SAME;
    // Contacts over edges first.
    let mut edges = 0;
    for i in 0..list.len() {
        if !on_face(&list[i]) {
            list.swap(i, edges);
            edges += 1;
        }
    }
    let mut kept = edges;
    for i in edges..list.len() {
        let c = list[i];
        let sooner = list[..edges].iter().any(|k| {
            k.point.depth < c.point.depth * (1.0 - SAME) && {
                let step = k.point.normal * (k.point.depth * (1.0 + SAME));
                let mut moved = *body;
                moved.center += step;
                touch(&moved, &Body::triangle(mesh.corners(c.side2 as u32))).is_none()
            }
        });
        if !sooner {
            list[kept] = c;
            kept += 1;
        }
    }
    out.truncate(kept);
}
