//! The engines, one file each.

#[cfg(feature = "box3d")]
mod box3d;
mod ferrode;
mod ode;
mod rapier;

use crate::engine::Choice;
use ferrode_math::{Quat, Vec3};

/// All engines that were built in.
pub fn all() -> Vec<Choice> {
    vec![
        Choice { name: "ferrode", threads: true, build: |s, t| Box::new(ferrode::Ferrode::new(s, t)) },
        #[cfg(feature = "box3d")]
        Choice { name: "box3d", threads: true, build: |s, t| Box::new(box3d::Box3d::new(s, t)) },
        Choice {
            name: "rapier f32",
            threads: true,
            build: |s, t| Box::new(rapier::single::Rapier::new(s, t)),
        },
        Choice {
            name: "rapier f64",
            threads: true,
            build: |s, t| Box::new(rapier::double::Rapier::new(s, t)),
        },
        Choice { name: "libode", threads: false, build: |s, _| Box::new(ode::Ode::new(s)) },
    ]
}

/// A rotation whose z axis lies along a unit vector, for engines whose hinges turn about z.
fn frame_along(z: Vec3) -> Quat {
    let (from, turn) = (Vec3::Z, Vec3::Z.cross(z));
    match turn.normalized() {
        Some(axis) => Quat::from_axis_angle(axis, ferrode_math::real::atan2(turn.length(), from.dot(z))),
        None if z.z > 0.0 => Quat::IDENTITY,
        None => Quat::from_axis_angle(Vec3::X, core::f64::consts::PI),
    }
}
