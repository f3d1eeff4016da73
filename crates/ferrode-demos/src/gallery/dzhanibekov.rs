//! A wing nut in free flight turns over again and again: rotation about the middle axis of inertia is unstable
//! (Dzhanibekov 1985; Poinsot 1834).

use super::prelude::*;

pub(super) const DEMO: Demo = Demo {
    name: "dzhanibekov",
    subject: Subject::Spin,
    about: "a wing nut in free flight turns over again and again",
    property: "it turns over at least three times; its angular momentum stays, within 1 %",
    seconds: 20.0,
    picture_at: 7.0,
    show: &[],
    camera: Camera::new([0.95, -1.1, 0.75], [0.0, 0.0, 0.0]),
    build,
};

#[derive(Clone)]
struct Nut {
    nut: BodyKey,
    momentum: Vec3,
    up: bool,
    turned: u32,
    drift: f64,
    /// Of a wing's tip.
    trail: Trail,
}

fn momentum(body: &ferrode::Body) -> Vec3 {
    body.inertia_world() * body.angular_velocity()
}

fn build() -> Result<Play, Failure> {
    let mut world = World::new();
    world.stepper = Stepper::Direct;
    let builder = BodyBuilder::new()
        .with_shape(Cuboid::new(at(0.7, 0.1, 0.04))?, 1000.0)
        .with_shape_at(
            Cylinder::new(0.06, 0.3)?,
            1000.0,
            Pose { position: at(0.0, 0.15, 0.0), rotation: turn(Vec3::X, 90.0) },
        )
        .with_spin(at(0.001, 6.0, 0.0));
    let nut = world.add_body(builder)?;
    let start = momentum(body(&world, nut)?);
    Stage::new(
        world,
        0.0002,
        Nut { nut, momentum: start, up: true, turned: 0, drift: 0.0, trail: Trail::default() },
    )
    .after(|nut, world| {
        let body = world.body(nut.nut)?;
        nut.trail.follow(body.position() + body.vector_to_world(Vec3::Y) * 0.3, 50);
        let along = body.vector_to_world(Vec3::Y).y;
        if (nut.up && along < -0.8) || (!nut.up && along > 0.8) {
            nut.up = !nut.up;
            nut.turned += 1;
        }
        let now = momentum(body);
        nut.drift = nut.drift.max((now - nut.momentum).length() / nut.momentum.length());
        Ok(())
    })
    .draw(|nut, _, drawing| {
        drawing.path(&nut.trail);
    })
    .check(|nut, _| {
        Ok(Findings::new().at_least("turned over", f64::from(nut.turned), 3.0).at_most(
            "angular momentum changed by (part)",
            nut.drift,
            0.01,
        ))
    })
}
