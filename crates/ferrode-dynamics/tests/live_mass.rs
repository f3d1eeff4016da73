//! Mass properties against the installed libode.

mod oracle;

use ferrode_dynamics::{Axis, Mass};
use ferrode_math::random::OdeRandom;
use ferrode_math::{Vec3, rotation};
use oracle::Line;
use oracle::engine::mass_record;

#[test]
fn masses_are_those_of_libode() {
    let mut random = OdeRandom::new(7);
    let mut size = || 0.1 + 2.0 * random.next_real();
    let mut script = Vec::new();
    let mut ours: Vec<Mass> = Vec::new();
    let axes = [Axis::X, Axis::Y, Axis::Z];
    for i in 0..60 {
        let (d, a, b, c) = (size(), size(), size(), size());
        let axis = axes[i % 3];
        let mut case = |op: &'static str, numbers: &[f64], mass: Result<Mass, _>| {
            script.push(Line::new(op, 0, numbers));
            ours.push(mass.expect("sizes are positive"));
        };
        let round = [d, (i % 3 + 1) as f64, a, b];
        let sides = Vec3::new(a, b, c);
        case("MassSphere", &[d, a], Mass::sphere(d, a));
        case("MassSphereTotal", &[d, a], Mass::sphere_total(d, a));
        case("MassBox", &[d, a, b, c], Mass::cuboid(d, sides));
        case("MassBoxTotal", &[d, a, b, c], Mass::cuboid_total(d, sides));
        case("MassCylinder", &round, Mass::cylinder(d, axis, a, b));
        case("MassCylinderTotal", &round, Mass::cylinder_total(d, axis, a, b));
        case("MassCapsule", &round, Mass::capsule(d, axis, a, b));
        case("MassCapsuleTotal", &round, Mass::capsule_total(d, axis, a, b));

        let (t, n, angle) = (Vec3::new(size(), -size(), size()), Vec3::new(-size(), size(), size()), size());
        let (d2, r2, total) = (size(), size(), size());
        let turned = rotation::from_axis_and_angle(n, angle);
        let moved = Mass::cuboid(d, sides).and_then(|m| m.translate(t)).and_then(|m| m.rotate(turned));
        let whole = moved.and_then(|m| (m + Mass::sphere(d2, r2)?).adjust(total));
        let numbers = [d, a, b, c, t.x, t.y, t.z, n.x, n.y, n.z, angle, d2, r2, total];
        case("MassChain", &numbers, whole);

        // A tetrahedron somewhere: with ODE's doubled parallel-axis term; and one face less.
        // libode reads mesh vertices in single precision.
        let at = |p: [f64; 3]| {
            let p = Vec3::from_array(p) + t;
            Vec3::from_array(p.to_array().map(|x| f64::from(x as f32)))
        };
        let corners = [at([0.0, 0.0, 0.0]), at([a, 0.0, 0.1]), at([0.2, b, 0.0]), at([0.0, 0.3, c])];
        let faces = [[0u32, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]];
        for count in [4, 3] {
            let mut numbers = vec![d, 4.0, f64::from(count)];
            numbers.extend(corners.iter().flat_map(|p| p.to_array()));
            let faces = &faces[4 - count as usize..];
            numbers.extend(faces.iter().flatten().map(|v| f64::from(*v)));
            let open = Mass::trimesh_as_ode(d, &corners, faces);
            if open.is_err() {
                continue;
            }
            case("MassTrimesh", &numbers, open);
            case("MassTrimeshTotal", &numbers, Mass::trimesh_total_as_ode(d, &corners, faces));
        }
    }
    let Some(theirs) = oracle::run(&script) else { return };
    assert_eq!(theirs.abort, None);
    // libode also grumbles about some masses; the numbers are compared all the same.
    let theirs: Vec<_> = theirs.records.into_iter().filter(|record| record.what != "message").collect();
    assert_eq!(theirs.len(), ours.len());
    let mut worst: f64 = 0.0;
    for ((line, mass), record) in script.iter().zip(&ours).zip(&theirs) {
        let difference = mass_record(mass).difference(record);
        assert!(difference < 1e-12, "{line}: {mass:?}\n{record:?}");
        worst = worst.max(difference);
    }
    println!("{} masses, worst relative difference {worst:.1e}", ours.len());
}
