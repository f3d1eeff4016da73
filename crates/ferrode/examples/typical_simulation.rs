//! A typical simulation, stage by stage, in the order of the ODE manual's list: first with every part made by hand, as
//! an ODE program does it, then the same scene in the short way.
//!
//! The scene: a box hangs from a hinge as the bob of a pendulum, is pushed for a moment, and knocks a ball over the
//! ground.

use ferrode::prelude::*;
use ferrode::{CollideOptions, Contact, Geom, GeomContact, Hinge, SpaceKind};
use ferrode::{collide, dynamics};

const STEP: f64 = 0.01;
const STEPS: usize = 300;
const PIVOT: Vec3 = Vec3::new(0.0, 0.0, 2.0);
const BOB_START: Vec3 = Vec3::new(-1.5, 0.0, 2.0);
const BALL_START: Vec3 = Vec3::new(0.5, 0.0, 0.25);

/// What the two versions are compared by: where bob and ball end.
type End = (Vec3, Vec3);

fn by_hand() -> Result<End, Error> {
    // 1. A world for the dynamics.
    let mut world = dynamics::World::new();
    world.set_gravity(Vec3::new(0.0, 0.0, -9.81))?;

    // 2. Its bodies.
    let bob = world.create_body();
    let ball = world.create_body();
    world.body_mut(bob)?.set_mass(&Mass::cuboid(800.0, Vec3::splat(0.4))?)?;
    world.body_mut(ball)?.set_mass(&Mass::sphere(500.0, 0.25)?)?;

    // 3. Where each body is, and how it moves.
    world.body_mut(bob)?.set_position(BOB_START)?;
    world.body_mut(ball)?.set_position(BALL_START)?;

    // 4. Its joints, which link nothing yet.
    let hinge = world.create_joint::<Hinge>(None)?;

    // 5. Which bodies the joints link. `None` is the static world.
    world.attach(hinge, Some(bob), None)?;

    // 6. The joints' anchors, axes and limits: in world coordinates, with the bodies where they are now.
    let mut pendulum = world.joint_mut::<Hinge>(hinge)?;
    pendulum.set_anchor(PIVOT)?;
    pendulum.set_axis(Vec3::Y)?;

    // 7. A world for collisions, and shapes in it.
    let mut colliders = collide::Colliders::new();
    let space = colliders.add_space(None, SpaceKind::HASH)?;
    colliders.add_geom(Some(space), Geom::new(Plane::new(Vec3::Z, 0.0)?))?;
    let geoms = [
        (colliders.add_geom(Some(space), Geom::new(Cuboid::new(Vec3::splat(0.4))?))?, bob),
        (colliders.add_geom(Some(space), Geom::new(Sphere::new(0.25)?))?, ball),
    ];
    let body_of = |geom: GeomKey| geoms.iter().find(|(g, _)| *g == geom).map(|(_, body)| *body);

    // 8. A group for the joints that contacts will make.
    let contacts = world.create_group();

    // 9. The loop.
    for step in 0..STEPS {
        // Push.
        if step < 10 {
            world.body_mut(bob)?.add_force(Vec3::new(0.0, 0.0, -100.0))?;
        }

        // Change joints: brake the pendulum for the last second.
        if step == STEPS - 100 {
            world.joint_mut::<Hinge>(hinge)?.set_motor(0.0, 50.0)?;
        }

        // Find what touches.
        for (geom, body) in geoms {
            colliders.set_pose(geom, world.body(body)?.pose())?;
        }
        let mut found: Vec<(GeomKey, GeomKey, GeomContact)> = Vec::new();
        colliders.collide(space, |colliders, a, b| {
            colliders.contacts(a, b, CollideOptions::new(4), &mut found);
        })?;

        // Make a contact joint of each point, in the group.
        for (a, b, contact) in found {
            let contact = Contact::at(contact.point, Surface::with_friction(0.5));
            let joint = world.create_contact(Some(contacts), &contact)?;
            world.attach(joint, body_of(a), body_of(b))?;
        }

        // Step.
        world.step(Stepper::Direct, STEP)?;

        // The contacts have done their work: empty the group.
        world.empty_group(contacts)?;
    }

    // 10. Both worlds end here, as they go out of scope.
    Ok((world.body(bob)?.position(), world.body(ball)?.position()))
}

fn in_short() -> Result<End, Error> {
    // A `World` holds bodies and shapes, and its step looks for contacts by itself.
    let mut world = World::new();
    world.stepper = Stepper::Direct;
    world.set_gravity(Vec3::new(0.0, 0.0, -9.81))?;
    world.set_max_contacts(4);
    world.add_static(Plane::new(Vec3::Z, 0.0)?, Pose::IDENTITY)?;
    let bob = BodyBuilder::new().at(BOB_START).with_shape(Cuboid::new(Vec3::splat(0.4))?, 800.0);
    let bob = world.add_body(bob)?;
    let ball = world.add_body(BodyBuilder::new().at(BALL_START).with_shape(Sphere::new(0.25)?, 500.0))?;
    let hinge = world.add_hinge(Some(bob), None, PIVOT, Vec3::Y)?;
    for step in 0..STEPS {
        if step < 10 {
            world.body_mut(bob)?.add_force(Vec3::new(0.0, 0.0, -100.0))?;
        }
        if step == STEPS - 100 {
            world.joint_mut::<Hinge>(hinge)?.set_motor(0.0, 50.0)?;
        }
        world.step(STEP)?;
    }
    Ok((world.body(bob)?.position(), world.body(ball)?.position()))
}

fn main() -> Result<(), Error> {
    let (bob, ball) = by_hand()?;
    println!("The bob ends at ({:.3}, {:.3}, {:.3}),", bob.x, bob.y, bob.z);
    println!("the ball at ({:.3}, {:.3}, {:.3}).", ball.x, ball.y, ball.z);
    assert!(((bob - PIVOT).length() - 1.5).abs() < 0.01, "the bob still hangs from its pivot");
    assert!(ball.x > 2.0, "the ball was knocked away");
    assert!((ball.z - 0.25).abs() < 1e-3, "the ball rolls on the ground");
    // The two spaces find contacts in different orders, and so sums round differently in the last digit.
    let (short_bob, short_ball) = in_short()?;
    let apart = (short_bob - bob).length().max((short_ball - ball).length());
    assert!(apart < 1e-12, "both ways make the same steps: {apart}");
    Ok(())
}
