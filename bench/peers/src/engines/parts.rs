//! What several engines want to be told in the same way: frames of joints, masses.

use crate::scene::{Form, Joint, Scene, Solid};
use core::f64::consts::{FRAC_PI_2, PI};
use ferrode_math::{Pose, Quat, Vec3, real};

/// A rotation whose z axis lies along a unit vector, for engines whose hinges turn about z.
pub fn along_z(z: Vec3) -> Quat {
    let (from, turn) = (Vec3::Z, Vec3::Z.cross(z));
    match turn.normalized() {
        Some(axis) => Quat::from_axis_angle(axis, real::atan2(turn.length(), from.dot(z))),
        None if z.z > 0.0 => Quat::IDENTITY,
        None => Quat::from_axis_angle(Vec3::X, PI),
    }
}

/// A rotation whose x axis lies along a unit vector.
pub fn along_x(x: Vec3) -> Quat {
    along_z(x) * Quat::from_axis_angle(Vec3::Y, -FRAC_PI_2)
}

/// A joint's frame on each of its two solids, the second one's in the world if it has none; `turn` is the frame's rotation in
/// the world.
pub fn frames(scene: &Scene, joint: &Joint, turn: Quat) -> (Pose, Pose) {
    let on = |solid: Option<usize>| {
        let pose = solid.map_or(Pose::IDENTITY, |i| scene.solids[i].pose);
        Pose::new(pose.inverse_transform_point(joint.anchor), pose.rotation.conjugate() * turn)
    };
    (on(Some(joint.a)), on(joint.b))
}

/// Mass and moments of inertia about the axes of a solid's frame, from its form and density; zeros for what never moves.
pub fn mass(solid: &Solid) -> (f64, Vec3) {
    let Some(density) = solid.density else { return (0.0, Vec3::ZERO) };
    // Mass and moments of a cylinder along z.
    let round = |radius: f64, length: f64| {
        let mass = density * PI * radius * radius * length;
        let across = mass * (radius * radius / 4.0 + length * length / 12.0);
        (mass, Vec3::new(across, across, mass * radius * radius / 2.0))
    };
    match solid.form {
        Form::Cuboid(s) => {
            let mass = density * s.x * s.y * s.z;
            let squares = Vec3::new(s.y * s.y + s.z * s.z, s.x * s.x + s.z * s.z, s.x * s.x + s.y * s.y);
            (mass, squares * (mass / 12.0))
        }
        Form::Sphere(radius) => {
            let mass = density * 4.0 / 3.0 * PI * radius * radius * radius;
            (mass, Vec3::splat(0.4 * mass * radius * radius))
        }
        Form::Cylinder(radius, length) => round(radius, length),
        Form::Capsule(radius, length) => {
            let (middle, inertia) = round(radius, length);
            let caps = density * 4.0 / 3.0 * PI * radius * radius * radius;
            // Two half balls whose centres of mass are 3/8 of the radius from their flat sides, at half the length.
            let about = caps * 0.4 * radius * radius;
            let across = about + caps * (length * length / 4.0 + 0.375 * radius * length);
            (middle + caps, inertia + Vec3::new(across, across, about))
        }
        Form::Mesh(..) => (0.0, Vec3::ZERO),
    }
}

/// What hangs together by joints, for engines that filter pairs within groups: each solid's group, its number within, and the
/// sizes of the groups.
pub fn groups(scene: &Scene) -> (Vec<u32>, Vec<u32>, Vec<u32>) {
    let mut root: Vec<usize> = (0..scene.solids.len()).collect();
    let find = |root: &mut Vec<usize>, mut i: usize| {
        while root[i] != i {
            root[i] = root[root[i]];
            i = root[i];
        }
        i
    };
    for joint in &scene.joints {
        let Some(b) = joint.b else { continue };
        let (a, b) = (find(&mut root, joint.a), find(&mut root, b));
        root[a.max(b)] = a.min(b);
    }
    let (mut group, mut member, mut sizes) = (Vec::new(), Vec::new(), Vec::new());
    for i in 0..root.len() {
        let first = find(&mut root, i);
        if first == i {
            group.push(sizes.len() as u32);
            sizes.push(0);
        } else {
            group.push(group[first]);
        }
        let size: &mut u32 = &mut sizes[group[i] as usize];
        member.push(*size);
        *size += 1;
    }
    (group, member, sizes)
}
