//! The engines, one file each.

#[cfg(feature = "box3d")]
mod box3d;
#[cfg(feature = "bullet")]
mod bullet;
#[cfg(test)]
mod checks;
mod ferrode;
#[cfg(feature = "jolt")]
mod jolt;
#[cfg(feature = "mujoco")]
mod mujoco;
mod ode;
#[allow(dead_code, reason = "each engine uses some of them")]
mod parts;
#[cfg(feature = "physx")]
mod physx;
mod rapier;

use crate::engine::{Choice, Engine};
use crate::scene::Scene;

/// An engine that takes every scene.
fn choice(name: &'static str, threads: bool, build: fn(&Scene, usize) -> Box<dyn Engine>) -> Choice {
    Choice { name, threads, refuses: |_| None, build }
}

/// All engines that were built in.
pub fn all() -> Vec<Choice> {
    vec![
        choice("ferrode", true, |s, t| Box::new(ferrode::Ferrode::new(s, t))),
        #[cfg(feature = "box3d")]
        choice("box3d", true, |s, t| Box::new(box3d::Box3d::new(s, t))),
        choice("rapier f32", true, |s, t| Box::new(rapier::single::Rapier::new(s, t))),
        choice("rapier f64", true, |s, t| Box::new(rapier::double::Rapier::new(s, t))),
        #[cfg(feature = "bullet")]
        choice("bullet", false, |s, _| Box::new(bullet::Bullet::new(s))),
        #[cfg(feature = "jolt")]
        choice("jolt", true, |s, t| Box::new(jolt::Jolt::new(s, t))),
        #[cfg(feature = "mujoco")]
        Choice {
            refuses: mujoco::refuses,
            ..choice("mujoco", false, |s, _| Box::new(mujoco::Mujoco::new(s)))
        },
        #[cfg(feature = "physx")]
        choice("physx", true, |s, t| Box::new(physx::Physx::new(s, t, physx::Solver::Default))),
        #[cfg(feature = "physx")]
        choice("physx tgs", true, |s, t| Box::new(physx::Physx::new(s, t, physx::Solver::Tgs))),
        choice("libode", false, |s, _| Box::new(ode::Ode::new(s))),
    ]
}
