//! Mass properties against recorded figures of libode 0.16.2 and against the integrals themselves.

use ferrode_dynamics::{Axis, Error, Mass, MeshError};
use ferrode_math::{Mat3, Vec3, rotation};

#[track_caller]
fn close(a: f64, b: f64, tolerance: f64) {
    assert!((a - b).abs() <= tolerance * b.abs().max(1.0), "{a} is not {b}");
}

#[track_caller]
fn same(a: &Mass, b: &Mass, tolerance: f64) {
    close(a.mass, b.mass, tolerance);
    close(a.centre.x, b.centre.x, tolerance);
    close(a.centre.y, b.centre.y, tolerance);
    close(a.centre.z, b.centre.z, tolerance);
    for i in 0..3 {
        for j in 0..3 {
            close(a.inertia.rows[i][j], b.inertia.rows[i][j], tolerance);
        }
    }
}

#[test]
fn primitives_have_the_recorded_moments() {
    let m = Mass::sphere(1000.0, 0.1).unwrap();
    close(m.mass, 4.1887902047863914, 1e-15);
    close(m.inertia.rows[1][1], 0.016755160819145569, 1e-15);
    let m = Mass::capsule_total(2.0, Axis::Z, 0.3, 1.2).unwrap();
    close(m.inertia.rows[0][0], 0.47925, 1e-15);
    close(m.inertia.rows[2][2], 0.0855, 1e-15);
    let m = Mass::cylinder_total(2.0, Axis::X, 0.3, 1.2).unwrap();
    close(m.inertia.rows[0][0], 0.09, 1e-15);
    close(m.inertia.rows[1][1], 0.285, 1e-15);
    let m = Mass::cuboid(1.0, Vec3::new(1.0, 2.0, 3.0)).unwrap();
    close(m.mass, 6.0, 1e-15);
    same(&Mass { inertia: Mat3::from_diagonal(Vec3::new(6.5, 5.0, 2.5)), ..m }, &m, 1e-15);
}

#[test]
fn translating_and_rotating_give_the_recorded_tensors() {
    let m = Mass::cuboid(1.0, Vec3::new(1.0, 2.0, 3.0)).unwrap();
    let m = m.translate(Vec3::new(1.0, 2.0, 3.0)).unwrap();
    let want =
        Mass::parameters(6.0, Vec3::new(1.0, 2.0, 3.0), [84.5, 65.0, 32.5], [-12.0, -18.0, -36.0]).unwrap();
    same(&m, &want, 1e-14);
    let quarter = rotation::from_axis_and_angle(Vec3::Z, core::f64::consts::FRAC_PI_2);
    let want =
        Mass::parameters(6.0, Vec3::new(-2.0, 1.0, 3.0), [65.0, 84.5, 32.5], [12.0, 36.0, -18.0]).unwrap();
    same(&m.rotate(quarter).unwrap(), &want, 1e-14);
    let back = m.translate(Vec3::new(-1.0, -2.0, -3.0)).unwrap();
    same(&back, &Mass::cuboid(1.0, Vec3::new(1.0, 2.0, 3.0)).unwrap(), 1e-14);
}

#[test]
fn a_sum_is_the_whole() {
    let half = Mass::cuboid(2.0, Vec3::new(1.0, 2.0, 3.0)).unwrap();
    let sum = half.translate(Vec3::new(0.5, 0.0, 0.0)).unwrap() + half.translate(-Vec3::X * 0.5).unwrap();
    same(&sum, &Mass::cuboid(2.0, Vec3::new(2.0, 2.0, 3.0)).unwrap(), 1e-15);
    same(&(Mass::ZERO + half), &half, 0.0);
    assert_eq!(Mass::ZERO + Mass::ZERO, Mass::ZERO);
    let total = half.adjust(7.0).unwrap();
    close(total.inertia.rows[0][0], half.inertia.rows[0][0] * 7.0 / 12.0, 1e-15);
}

/// ∫1, ∫x, ∫xxᵀ of a solid of unit density by the midpoint rule.
fn sampled(half_box: Vec3, inside: impl Fn(Vec3) -> bool) -> Mass {
    let n = 120;
    let cell = half_box * (2.0 / f64::from(n));
    let dm = cell.x * cell.y * cell.z;
    let mut sum = Mass::ZERO;
    for (i, j, k) in (0..n * n * n).map(|c| (c % n, c / n % n, c / n / n)) {
        let [x, y, z] = [i, j, k].map(|c| f64::from(c) + 0.5);
        let p = Vec3::new(x * cell.x, y * cell.y, z * cell.z) - half_box;
        if inside(p) {
            let c = Mat3::cross(p);
            sum.mass += dm;
            sum.centre += p * dm;
            sum.inertia += c * c * -dm;
        }
    }
    sum.centre *= 1.0 / sum.mass;
    sum
}

#[test]
fn round_solids_have_the_moments_of_their_samples() {
    let across = |p: Vec3| p.y * p.y + p.z * p.z;
    let cases: [(Mass, Mass); 4] = [
        (
            Mass::capsule(1.0, Axis::X, 0.5, 1.0).unwrap(),
            sampled(Vec3::new(1.0, 0.5, 0.5), |p| {
                let x = (p.x.abs() - 0.5).max(0.0);
                x * x + across(p) < 0.25
            }),
        ),
        (Mass::cylinder(1.0, Axis::X, 0.5, 1.0).unwrap(), sampled(Vec3::splat(0.5), |p| across(p) < 0.25)),
        (
            Mass::cone(1.0, Axis::X, 1.0, 2.0).unwrap(),
            sampled(Vec3::splat(1.0), |p| across(p) < 0.25 * (1.0 - p.x) * (1.0 - p.x)),
        ),
        (
            Mass::ellipsoid(1.0, Vec3::new(1.0, 0.5, 0.7)).unwrap(),
            sampled(Vec3::new(1.0, 0.5, 0.7), |p| p.x * p.x + p.y * p.y / 0.25 + p.z * p.z / 0.49 < 1.0),
        ),
    ];
    for (exact, sampled) in cases {
        same(&exact, &sampled, 2e-3);
    }
}

#[test]
fn axes_only_permute_the_tensor() {
    for make in [Mass::cylinder, Mass::capsule, Mass::cone] {
        let [x, y, z] = [Axis::X, Axis::Y, Axis::Z].map(|axis| make(3.0, axis, 0.3, 1.1).unwrap());
        let to_y = Mat3::from_columns(Vec3::Y, Vec3::Z, Vec3::X);
        same(&x.rotate(to_y).unwrap(), &y, 1e-15);
        same(&y.rotate(to_y).unwrap(), &z, 1e-15);
    }
}

fn box_mesh(centre: Vec3, sides: Vec3) -> (Vec<Vec3>, Vec<[u32; 3]>) {
    let corner = |i: u32| {
        let side = |bit: u32| if i & bit != 0 { 0.5 } else { -0.5 };
        centre + Vec3::new(sides.x * side(1), sides.y * side(2), sides.z * side(4))
    };
    let quads = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    let triangles = quads.iter().flat_map(|q| [[q[0], q[1], q[2]], [q[0], q[2], q[3]]]).collect();
    ((0..8).map(corner).collect(), triangles)
}

#[test]
fn a_box_mesh_is_a_box() {
    let sides = Vec3::new(1.0, 2.0, 3.0);
    for centre in [Vec3::ZERO, Vec3::new(1.0, -2.0, 0.5), Vec3::new(1e3, 0.0, 0.0)] {
        let (vertices, triangles) = box_mesh(centre, sides);
        let mesh = Mass::trimesh(2.5, &vertices, &triangles).unwrap();
        let solid = Mass::cuboid(2.5, sides).unwrap();
        same(&mesh, &solid.translate(centre).unwrap(), 1e-14);
        close(mesh.about_centre().rows[0][0], solid.inertia.rows[0][0], 1e-8);
    }
}

#[test]
fn the_mesh_quirk_adds_the_parallel_axis_term_twice() {
    let (vertices, triangles) = box_mesh(Vec3::X, Vec3::splat(1.0));
    let ode = Mass::trimesh_total_as_ode(1.0, &vertices, &triangles).unwrap();
    let want = Mass::parameters(1.0, Vec3::X, [1.0 / 6.0, 13.0 / 6.0, 13.0 / 6.0], [0.0; 3]).unwrap();
    same(&ode, &want, 1e-14);
    let right = Mass::trimesh_total(1.0, &vertices, &triangles).unwrap();
    close(right.inertia.rows[1][1], 7.0 / 6.0, 1e-14);
}

#[test]
fn a_mesh_that_bounds_no_solid_is_an_error() {
    let (vertices, mut triangles) = box_mesh(Vec3::ZERO, Vec3::splat(1.0));
    // Each triangle with corners of its own, as an STL file has them, is still closed.
    let soup: Vec<Vec3> = triangles.iter().flatten().map(|v| vertices[*v as usize]).collect();
    let own: Vec<[u32; 3]> = (0..12).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect();
    assert!(Mass::trimesh(1.0, &soup, &own).is_ok());

    let inverted: Vec<[u32; 3]> = triangles.iter().map(|t| [t[0], t[2], t[1]]).collect();
    let fault = Mass::trimesh(1.0, &vertices, &inverted).unwrap_err();
    assert!(matches!(fault, Error::Mesh(MeshError::NotOutward { volume }) if (volume + 1.0).abs() < 1e-15));

    let last = triangles.pop().unwrap();
    let fault = Mass::trimesh(1.0, &vertices, &triangles).unwrap_err();
    assert!(matches!(fault, Error::Mesh(MeshError::Open { .. })), "{fault}");
    triangles.push([last[0], last[2], last[1]]);
    assert!(matches!(Mass::trimesh(1.0, &vertices, &triangles), Err(Error::Mesh(MeshError::Open { .. }))));
    triangles.push([0, 1, 8]);
    assert_eq!(
        Mass::trimesh(1.0, &vertices, &triangles).unwrap_err().to_string(),
        "triangle 12 names vertex 8, but the mesh has 8"
    );
    assert!(matches!(Mass::trimesh(1.0, &[], &[]), Err(Error::Mesh(MeshError::NotOutward { .. }))));
}

#[test]
fn bad_numbers_are_named() {
    let text = |r: Result<Mass, Error>| r.unwrap_err().to_string();
    assert_eq!(text(Mass::sphere(-1.0, 0.1)), "density must be a positive number, not -1");
    assert_eq!(text(Mass::sphere(1.0, -0.1)), "sphere radius must be a positive number, not -0.1");
    assert_eq!(
        text(Mass::cuboid(1.0, Vec3::new(1.0, 0.0, 1.0))),
        "box side y must be a positive number, not 0"
    );
    assert_eq!(
        text(Mass::capsule_total(f64::NAN, Axis::X, 1.0, 1.0)),
        "mass must be a positive number, not NaN"
    );
    assert_eq!(
        text(Mass::cone(1.0, Axis::X, 1.0, f64::INFINITY)),
        "cone length must be a positive number, not inf"
    );
    assert_eq!(Mass::ZERO.adjust(1.0), Err(Error::MassNotPositive(0.0)));
    assert_eq!(Mass::ZERO.check(), Err(Error::MassNotPositive(0.0)));
    assert!(Mass::sphere(1.0, 1e-200).is_err(), "its volume underflows");
    let m = Mass::default();
    assert!(matches!(m.translate(Vec3::splat(f64::NAN)), Err(Error::NotFinite { .. })));
    assert!(matches!(m.rotate(Mat3::ZERO), Err(Error::NotARotation { .. })));
    assert!(matches!(
        Mass::parameters(1.0, Vec3::X, [1.0, 1.0, 1.0], [0.0; 3]),
        Err(Error::InertiaNotPositiveDefinite { about: "the centre of mass" })
    ));
}
