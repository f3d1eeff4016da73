//! One shape of each class.

use ferrode_collide::*;
use ferrode_math::{Pose, Quat, Vec3};

fn tetrahedron() -> TriMesh {
    let corners = vec![
        Vec3::new(0.5, 0.5, 0.5),
        Vec3::new(0.5, -0.5, -0.5),
        Vec3::new(-0.5, 0.5, -0.5),
        Vec3::new(-0.5, -0.5, 0.5),
    ];
    TriMesh::new(corners, vec![[0, 1, 2], [0, 3, 1], [0, 2, 3], [1, 3, 2]]).unwrap()
}

/// A cylinder and a box across its end.
fn compound() -> Shape {
    let turn = Quat::from_axis_angle(Vec3::new(0.3, 1.0, 0.2), 0.7);
    Compound::new([
        (Cylinder::new(0.2, 0.8).unwrap().into(), Pose::from_position(Vec3::new(0.0, 0.1, -0.1))),
        (Cuboid::new(Vec3::new(0.9, 0.3, 0.2)).unwrap().into(), Pose::new(Vec3::new(0.1, 0.0, 0.35), turn)),
    ])
    .unwrap()
    .into()
}

/// One of each class.
pub fn classes() -> Vec<(&'static str, Shape)> {
    let heights = (0..49).map(|i| 0.05 * f64::from(i * 11 % 7)).collect();
    let points: Vec<Vec3> = (0..12)
        .map(|i| {
            let t = f64::from(i);
            Vec3::new((t * 7.0) % 5.0 - 2.0, (t * 3.0) % 5.0 - 2.0, (t * 11.0) % 7.0 - 3.0) * 0.2
        })
        .collect();
    vec![
        ("sphere", Sphere::new(0.5).unwrap().into()),
        ("box", Cuboid::new(Vec3::new(0.9, 0.7, 0.5)).unwrap().into()),
        ("capsule", Capsule::new(0.3, 0.8).unwrap().into()),
        ("cylinder", Cylinder::new(0.4, 0.9).unwrap().into()),
        ("plane", Plane::new(Vec3::new(0.3, -0.2, 0.9), 0.1).unwrap().into()),
        ("ray", Ray::new(3.0).unwrap().into()),
        ("convex", Convex::from_points(&points).unwrap().into()),
        ("mesh", tetrahedron().into()),
        ("heightfield", Heightfield::new(3.0, 3.0, 7, 7, heights, 1.0).unwrap().into()),
        ("ellipsoid", Ellipsoid::new(Vec3::new(0.6, 0.4, 0.3)).unwrap().into()),
        ("cone", Cone::new(0.4, 0.9).unwrap().into()),
        ("compound", compound()),
    ]
}

/// Where a shape stands after `m` moves the world: a plane carries its place in its equation.
pub fn moved(shape: &Shape, at: &Pose, m: &Pose) -> (Shape, Pose) {
    match shape {
        Shape::Plane(p) => {
            let n = m.rotation.rotate(p.normal());
            (Plane::new(n, p.d() + n.dot(m.position)).unwrap().into(), *at)
        }
        other => (other.clone(), *m * *at),
    }
}
