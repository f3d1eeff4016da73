//! Steps that are like those before them allocate nothing.

use ferrode_dynamics::{Ball, Contact, Hinge, Mass, Param, StepReport, Stepper, Surface, World};
use ferrode_math::{ContactPoint, Vec3};

const H: f64 = 0.005;

/// A chain of hinges with brakes, a chain of ball joints, and boxes on the ground, each of its own island.
fn world() -> World {
    let mut world = World::new();
    world.set_gravity(Vec3::new(0.0, 0.0, -9.81)).unwrap();
    let mut last = None;
    for i in 0..60 {
        let body = world.create_body();
        let at = Vec3::new(0.2 * f64::from(i), 5.0 * f64::from(i / 30), 10.0);
        let b = world.body_mut(body).unwrap();
        b.set_mass(&Mass::cuboid_total(1.0, Vec3::new(0.2, 0.1, 0.1)).unwrap()).unwrap();
        b.set_position(at).unwrap();
        if i == 30 {
            last = None;
        }
        let anchor = at - Vec3::new(0.1, 0.0, 0.0);
        if i < 30 {
            let joint = world.create_joint::<Ball>(None).unwrap();
            world.attach(joint, Some(body), last).unwrap();
            world.joint_mut::<Ball>(joint).unwrap().set_anchor(anchor).unwrap();
        } else {
            let joint = world.create_joint::<Hinge>(None).unwrap();
            world.attach(joint, Some(body), last).unwrap();
            let mut hinge = world.joint_mut::<Hinge>(joint).unwrap();
            hinge.set_anchor(anchor).unwrap();
            hinge.set_axis(Vec3::Y).unwrap();
            world.set_joint_param(joint, Param::FMax, 1, 2.0).unwrap();
        }
        last = Some(body);
    }
    world
}

#[test]
fn steady_steps_allocate_nothing() {
    for stepper in [Stepper::Direct, Stepper::Quick] {
        let mut world = world();
        let contacts = world.create_group();
        let mut boxes = Vec::new();
        for i in 0..16 {
            let body = world.create_body();
            let b = world.body_mut(body).unwrap();
            b.set_mass(&Mass::cuboid_total(1.0, Vec3::splat(1.0)).unwrap()).unwrap();
            b.set_position(Vec3::new(3.0 * f64::from(i / 4), 0.0, 0.5 + f64::from(i % 4))).unwrap();
            boxes.push(body);
        }
        let mut report = StepReport::default();
        let mut step = |world: &mut World| {
            for (i, body) in boxes.iter().enumerate() {
                let below = (i % 4 > 0).then(|| boxes[i - 1]);
                for corner in 0..4 {
                    let (x, y) = (f64::from(corner % 2) - 0.5, f64::from(corner / 2) - 0.5);
                    let position = Vec3::new(3.0 * (i / 4) as f64 + x, y, (i % 4) as f64);
                    let point = ContactPoint { position, normal: Vec3::Z, depth: 0.0 };
                    let contact = Contact::at(point, Surface::with_friction(0.5));
                    let joint = world.create_contact(Some(contacts), &contact).unwrap();
                    world.attach(joint, Some(*body), below).unwrap();
                }
            }
            world.step_into(stepper, H, &mut report).unwrap();
            world.empty_group(contacts).unwrap();
        };
        for _ in 0..30 {
            step(&mut world);
        }
        let counted = allocation_counter::measure(|| {
            for _ in 0..30 {
                step(&mut world);
            }
        });
        assert_eq!(counted.count_total, 0, "{stepper:?}: {counted:?}");
        assert_eq!(report.islands, 6);
    }
}
