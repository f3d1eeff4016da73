//! `Direct` solves equal robots together, to the bits that each has by itself.

use ferrode::prelude::*;
use ferrode::{DirectMethod, Hinge, IslandSolve, mass_of};

const STEPS: usize = 200;
const ROBOTS: u32 = 7;
const BODIES: usize = 17;

/// A robot of four arms on a free trunk: hinges with motors, of which the weak ones slip, and limits that arms reach at different times.
fn add_robot(world: &mut World, robot: u32) {
    let at = Vec3::new(10.0 * f64::from(robot), 0.0, 5.0);
    let turn = Quat::from_axis_angle(Vec3::new(0.1, 1.0, 0.3), 0.2 * f64::from(robot));
    let part = |size: Vec3, at: Vec3| {
        let mass = mass_of(&Cuboid::new(size).unwrap().into(), 500.0).unwrap();
        BodyBuilder::new().at(at).rotated(turn).with_mass(mass)
    };
    let trunk = world.add_body(part(Vec3::new(0.4, 0.3, 0.6), at)).unwrap();
    for arm in 0..4 {
        let out = turn.rotate([Vec3::X, -Vec3::X, Vec3::Z, Vec3::Y][arm]);
        let mut before = trunk;
        for i in 0..4 {
            let (i, anchor) = (f64::from(i), at + out * (0.3 + 0.3 * f64::from(i)));
            let link = world.add_body(part(Vec3::splat(0.12), anchor + out * 0.15)).unwrap();
            let axis = turn.rotate(if arm < 2 { Vec3::Y } else { Vec3::X });
            let hinge = world.add_hinge(Some(link), Some(before), anchor, axis).unwrap();
            let mut hinge = world.joint_mut::<Hinge>(hinge).unwrap();
            hinge.set_motor(1.5 - 0.4 * i + 0.1 * f64::from(robot), 0.3 + 4.0 * i).unwrap();
            if arm == 1 {
                hinge.set_limits(-0.4, 0.3).unwrap();
            }
            before = link;
        }
    }
}

fn world_of(robots: impl Iterator<Item = u32>) -> World {
    let mut world = World::new();
    world.stepper = Stepper::Direct;
    world.set_gravity(Vec3::new(0.0, 0.0, -9.81)).unwrap();
    robots.for_each(|robot| add_robot(&mut world, robot));
    world
}

/// Steps, and returns per step, for each robot from the last on, a hash of its bodies, and its island's factorisations.
fn run(world: &mut World) -> Vec<Vec<(u64, u32)>> {
    let mut steps = Vec::new();
    for _ in 0..STEPS {
        let step = world.step(0.01).unwrap();
        let of_sparse =
            |solve: &IslandSolve| solve.certified() && solve.method == DirectMethod::BlockPivoting;
        assert!(step.dynamics.solves.iter().all(of_sparse));
        let mut hashes = [0xcbf2_9ce4_8422_2325u64; ROBOTS as usize];
        for (i, (_, body)) in world.bodies().enumerate() {
            let (p, q) = (body.position(), body.quaternion());
            let (v, w) = (body.linear_velocity(), body.angular_velocity());
            for x in [p.x, p.y, p.z, q.w, q.x, q.y, q.z, v.x, v.y, v.z, w.x, w.y, w.z] {
                // Newest first, as islands are.
                let hash = &mut hashes[i / BODIES];
                *hash = (*hash ^ x.to_bits()).wrapping_mul(0x0100_0000_01b3);
            }
        }
        let counts = step.dynamics.solves.iter().map(|solve| solve.factorisations);
        steps.push(hashes.into_iter().zip(counts).collect());
    }
    steps
}

#[test]
fn equal_robots_move_as_each_alone() {
    let together = run(&mut world_of(0..ROBOTS));
    let mut pivots = 0;
    for robot in 0..ROBOTS {
        let alone = run(&mut world_of(robot..robot + 1));
        for (step, (together, alone)) in together.iter().zip(&alone).enumerate() {
            assert_eq!(together[(ROBOTS - 1 - robot) as usize], alone[0], "robot {robot}, step {step}");
            pivots += alone[0].1 - 1;
        }
    }
    assert!(pivots > 20, "motors slip and limits are reached: {pivots}");
}
