//! An inverted pendulum on a cart, kept upright by a controller that reads joints and drives one.

use super::prelude::*;
use ferrode::{Hinge, Slider};

pub(super) const DEMO: Demo = Demo {
    name: "balance",
    subject: Subject::Creatures,
    about: "a cart balances a pole, and is pushed twice",
    property: "after eight seconds the pole is upright to 0.5° and the cart back at its place to 2 cm",
    seconds: 10.0,
    picture_at: 1.3,
    show: &[],
    camera: Camera::new([0.9, -3.7, 1.8], [0.0, 0.0, 0.8]),
    build,
};

#[derive(Clone)]
struct Cart {
    cart: BodyKey,
    pole: BodyKey,
    rail: JointKey,
    pivot: JointKey,
}

fn build() -> Result<Play, Failure> {
    let mut world = ground(Stepper::Direct)?;
    let cart = add_box(&mut world, at(0.5, 0.3, 0.2), 100.0, at(0.0, 0.0, 0.6))?;
    let pole = add_box(&mut world, at(0.05, 0.05, 1.2), 300.0, at(0.0, 0.0, 1.3))?;
    let rail = world.add_slider(Some(cart), None, Vec3::X)?;
    let pivot = world.add_hinge(Some(pole), Some(cart), at(0.0, 0.0, 0.7), Vec3::Y)?;
    let track = add_wall(&mut world, at(4.0, 0.06, 0.06), Pose::from_position(at(0.0, 0.0, 0.47)))?;
    world.set_geom_bits(track, 0, 0)?;
    Stage::new(world, 0.002, Cart { cart, pole, rail, pivot })
        .before(|s, world| {
            // Two pushes at the pole's tip.
            let t = world.time();
            if (1.0..1.1).contains(&t) || (4.0..4.1).contains(&t) {
                let push = if t < 2.0 { 8.0 } else { -12.0 };
                let tip = place(world, s.pole)? + at(0.0, 0.0, 0.5);
                world.body_mut(s.pole)?.add_force_at_position(at(push, 0.0, 0.0), tip)?;
            }
            // State feedback, its gains from a linear-quadratic regulator; a lean ahead is a positive angle about y.
            let (x, v) = {
                let rail = world.joint::<Slider>(s.rail)?;
                (rail.position()?, rail.position_rate()?)
            };
            let (lean, rate) = {
                let pivot = world.joint::<Hinge>(s.pivot)?;
                (pivot.angle(), pivot.angle_rate())
            };
            let force = 44.7 * x + 50.1 * v + 286.6 * lean + 79.5 * rate;
            world.joint_mut::<Slider>(s.rail)?.add_force(force)?;
            Ok(())
        })
        .draw(|_, _, drawing| {
            for x in [-1.9, 1.9] {
                drawing.block(at(0.08, 0.2, 0.47), at(x, 0.0, 0.235), Tint::FRAME);
            }
        })
        .check(|s, world| {
            let lean = world.joint::<Hinge>(s.pivot)?.angle().to_degrees();
            Ok(Findings::new().at_most("the pole leans by (degrees)", lean.abs(), 0.5).at_most(
                "the cart is off by (m)",
                place(world, s.cart)?.x.abs(),
                0.02,
            ))
        })
}
