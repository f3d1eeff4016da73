//! A chain with a heavy end, by each stepper at the same step size: a mass ratio of 100 is what iterations find hard.

use super::prelude::*;

const LINKS: usize = 10;
/// How far the quick one is drawn beside the exact one, m.
const ASIDE: f64 = 2.2;
const H: f64 = 1.0 / 240.0;

pub(super) const DEMO: Demo = Demo {
    name: "steppers",
    subject: Subject::Engine,
    about: "a chain with a heavy end, by the exact stepper and by the quick one",
    property: "joints open by under 2 mm with Direct, and by more than ten times as much with Quick",
    seconds: 4.0,
    picture_at: 1.2,
    show: &[],
    camera: Camera::new([1.6, -5.8, 2.4], [0.9, 0.0, 1.7]),
    build,
};

#[derive(Clone)]
struct Both {
    quick: World,
    worst: [f64; 2],
}

fn chain(stepper: Stepper) -> Result<World, Failure> {
    let mut world = air(stepper)?;
    let pivot = at(0.0, 0.0, 3.0);
    let lean = turn(Vec3::Y, -30.0);
    let node = |i: usize| pivot + lean.rotate(at(0.0, 0.0, -0.2 * i as f64));
    let mut last = None;
    for i in 0..LINKS {
        let link = add_capsule(&mut world, 0.03, 1000.0, [node(i), node(i + 1)])?;
        world.add_ball(Some(link), last, node(i))?;
        last = Some(link);
    }
    let link_mass = last.map_or(Ok(1.0), |key| body(&world, key).map(|body| body.mass().mass))?;
    let builder = BodyBuilder::new()
        .at(node(LINKS) + lean.rotate(at(0.0, 0.0, -0.25)))
        .with_mass(Mass::sphere_total(100.0 * link_mass, 0.25)?)
        .with_shape(Sphere::new(0.25)?, 0.0);
    let weight = world.add_body(builder)?;
    world.add_ball(Some(weight), last, node(LINKS))?;
    Ok(world)
}

fn build() -> Result<Play, Failure> {
    let quick = chain(Stepper::Quick)?;
    Stage::new(chain(Stepper::Direct)?, H, Both { quick, worst: [0.0; 2] })
        .after(|both, world| {
            both.quick.step(H)?;
            for (worst, world) in both.worst.iter_mut().zip([&*world, &both.quick]) {
                *worst = worst.max(joint_errors(world)?.0);
            }
            Ok(())
        })
        .draw(|both, _, drawing| {
            drawing.floor = Some(0.0);
            drawing.rod(at(-0.5, 0.0, 3.05), at(ASIDE + 0.5, 0.0, 3.05), 0.05, Tint::FRAME);
            // The same chain by the quick stepper, beside.
            for info in both.quick.geoms() {
                let Ok(geom) = both.quick.geom(info.key) else { continue };
                let pose = Pose { position: geom.pose().position + at(ASIDE, 0.0, 0.0), ..*geom.pose() };
                drawing.solid(Ok(geom.shape().clone()), pose, Tint::PATH);
            }
        })
        .check(|both, _| {
            let [direct, quick] = both.worst;
            Ok(Findings::new().at_most("with Direct joints open by (m)", direct, 2e-3).at_least(
                "with Quick by so many times more",
                quick / direct,
                10.0,
            ))
        })
}
