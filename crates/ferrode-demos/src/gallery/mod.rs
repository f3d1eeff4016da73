//! The scenes, one a file.

mod amotor;
mod balance;
mod basket;
mod bounce;
mod box_stack;
mod buggy;
mod cards;
mod chain;
mod convex;
mod conveyor;
mod crowd;
mod cylinders;
mod dominoes;
mod double_ball;
mod double_hinge;
mod dzhanibekov;
mod feedback;
mod four_bar;
mod friction;
mod gyroscope;
mod heightfield;
mod hinge;
mod hinge2;
mod lmotor;
mod motors;
mod moving_mesh;
mod newtons_cradle;
mod pendulum_wave;
mod piston;
mod plane2d;
mod platforms;
mod prismatic_rotoide;
mod prismatic_universal;
mod pyramid;
mod ragdolls;
mod robot;
mod rolling_friction;
mod shapes;
mod slider;
mod space_stress;
mod steppers;
mod table;
mod tracks;
mod transmission;
mod trebuchet;
mod universal;
mod walker;
mod wall_crash;

/// What every scene needs.
mod prelude {
    pub(super) use crate::demo::{Camera, Demo, Subject};
    pub(super) use crate::drawing::{Tint, Trail};
    pub(super) use crate::kit::*;
    pub(super) use crate::play::{Play, Stage};
    pub(super) use crate::verdict::{Failure, Findings};
    pub(super) use ferrode::prelude::*;
}

/// Lists the scenes, and makes a test of each.
macro_rules! gallery {
    ($($scene:ident),+ $(,)?) => {
        /// All scenes of the gallery: ODE's subjects first, then what goes beyond.
        pub const ALL: &[&crate::Demo] = &[$(&$scene::DEMO),+];

        #[cfg(test)]
        mod tests {
            $(
                #[test]
                fn $scene() {
                    match super::$scene::DEMO.run() {
                        Ok(found) => println!("{found}"),
                        Err(failure) => panic!("{failure}"),
                    }
                }
            )+
        }
    };
}

gallery! {
    box_stack, pyramid, shapes, buggy, chain, convex, moving_mesh, heightfield, wall_crash, cards, cylinders, hinge, slider,
    universal, hinge2, prismatic_rotoide, prismatic_universal, piston, double_ball, double_hinge, transmission, motors, amotor,
    lmotor, feedback, friction, rolling_friction, gyroscope, platforms, plane2d, tracks, conveyor, basket, space_stress, steppers,
    ragdolls, robot, newtons_cradle, four_bar, dzhanibekov, dominoes, walker, trebuchet, pendulum_wave, bounce, balance, table,
    crowd,
}
