//! Which triangles of a mesh a shape may touch, before any of their contacts are found.

use crate::{Frame, Shape, TriMesh};
use ferrode_math::{Aabb, Vec3};

/// The triangles of a mesh that meet the box around a box, capsule or cylinder in its own frame, those whose own boxes meet
/// a ball, or the world box of any other shape; in the order of the mesh's tree. It is what ODE asks a mesh's callbacks about.
pub fn triangle_candidates(shape: &Shape, fs: &Frame, mesh: &TriMesh, fm: &Frame) -> Vec<u32> {
    let local = Frame::new(fm.point_to_local(fs.position), fm.rotation.transpose() * fs.rotation);
    let around = shape.aabb_in(&local);
    let mut found = Vec::new();
    let mut all = |meets: &dyn Fn(u32) -> bool, around: &Aabb| {
        mesh.tree().query(around, |i| {
            if meets(i) {
                found.push(i);
            }
        });
    };
    let half = match shape {
        Shape::Sphere(ball) => {
            let near = |i: u32| {
                let corners = mesh.corners(i);
                let box_of = corners.iter().fold(Aabb::EMPTY, |b, p| b.union(&Aabb::new(*p, *p)));
                let nearest = local.position.max(box_of.min).min(box_of.max);
                (local.position - nearest).length_squared() <= ball.radius() * ball.radius()
            };
            all(&near, &around);
            return found;
        }
        Shape::Cuboid(cuboid) => cuboid.half_sides(),
        Shape::Capsule(c) => Vec3::new(c.radius(), c.radius(), 0.5 * c.length() + c.radius()),
        Shape::Cylinder(c) => Vec3::new(c.radius(), c.radius(), 0.5 * c.length()),
        _ => {
            all(&|_| true, &around);
            return found;
        }
    };
    // The box of a capsule or cylinder reaches beyond it.
    let center = local.position;
    let reach = |i: usize| {
        let r = local.rotation.rows[i];
        (r[0] * half.x).abs() + (r[1] * half.y).abs() + (r[2] * half.z).abs()
    };
    let around = Aabb::from_center(center, Vec3::new(reach(0), reach(1), reach(2)));
    all(&|i| triangle_meets_box(mesh.corners(i).map(|p| local.point_to_local(p)), half), &around);
    found
}

/// Whether a triangle and a box around the origin have a point in common: no face of the box, nor the triangle's plane, nor
/// two edges tell them apart (Gottschalk, Lin and Manocha, *OBBTree*, 1996).
fn triangle_meets_box(corners: [Vec3; 3], half: Vec3) -> bool {
    let edges = [corners[1] - corners[0], corners[2] - corners[1], corners[0] - corners[2]];
    let apart = |axis: Vec3| {
        let [a, b, c] = corners.map(|p| p.dot(axis));
        let reach = half.dot(axis.abs());
        a.min(b).min(c) > reach || a.max(b).max(c) < -reach
    };
    let axes = [Vec3::X, Vec3::Y, Vec3::Z];
    !(axes.into_iter().any(apart)
        || apart(edges[0].cross(edges[1]))
        || edges.into_iter().any(|edge| axes.into_iter().any(|axis| apart(axis.cross(edge)))))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_triangle_beside_an_edge_of_the_box_does_not_meet_it() {
        let half = Vec3::new(1.0, 1.0, 1.0);
        let triangle = |d: f64| [Vec3::new(d, 0.0, -3.0), Vec3::new(0.0, d, 3.0), Vec3::new(d, d, 0.0)];
        assert!(triangle_meets_box(triangle(1.9), half));
        assert!(!triangle_meets_box(triangle(4.1), half));
        // The boxes overlap, the shapes don't.
        let corner = [Vec3::new(1.9, 0.9, 0.0), Vec3::new(0.9, 1.9, 0.0), Vec3::new(1.9, 1.9, 0.5)];
        assert!(!triangle_meets_box(corner, half));
        assert!(triangle_meets_box(corner.map(|p| p - Vec3::new(0.4, 0.4, 0.0)), half));
    }
}
