//! Articulations under `Substep`: joints that are solved together, exactly.

use ferrode::math::real;
use ferrode::math::simd::Level;
use ferrode::prelude::*;
use ferrode::{Ball, Hinge, JointKey};

const H: f64 = 1.0 / 60.0;
const G: f64 = 9.81;

fn world(stepper: Stepper) -> World {
    let mut world = World::new();
    world.stepper = stepper;
    world.set_gravity(Vec3::new(0.0, 0.0, -G)).unwrap();
    world.set_default_material(Material::with_friction(0.6)).unwrap();
    world
}

fn ground(world: &mut World) {
    let slab = Cuboid::new(Vec3::new(100.0, 100.0, 2.0)).unwrap();
    world.add_static(slab, Pose::from_position(-Vec3::Z)).unwrap();
}

fn change(world: &mut World, f: impl FnOnce(&mut ferrode::SubstepSettings)) {
    let mut settings = *world.dynamics().substep();
    f(&mut settings);
    world.set_substep(settings).unwrap();
}

/// Largest error of all joints, in metres and radians.
fn errors(world: &World) -> (f64, f64) {
    world
        .joints()
        .map(|joint| world.joint_error(joint).unwrap())
        .fold((0.0, 0.0), |worst: (f64, f64), e| (worst.0.max(e.position), worst.1.max(e.angle)))
}

/// Steps, and finds the largest errors on the way.
fn run(world: &mut World, h: f64, steps: usize) -> (f64, f64) {
    let mut worst = (0.0f64, 0.0f64);
    for _ in 0..steps {
        let step = world.step(h).unwrap();
        assert!(step.dynamics.quarantined.is_empty());
        let (position, angle) = errors(world);
        worst = (worst.0.max(position), worst.1.max(angle));
    }
    worst
}

fn link(world: &mut World, at: Vec3, sides: Vec3, mass: f64) -> BodyKey {
    let shape = Cuboid::new(sides).unwrap();
    let density = mass / (sides.x * sides.y * sides.z);
    world.add_body(BodyBuilder::new().at(at).with_shape(shape, density)).unwrap()
}

/// A torso with five limbs, 29 hinges with brakes: four limbs in a cross, the fifth up.
fn robot(world: &mut World, base: Vec3) -> Vec<BodyKey> {
    let mut links = vec![link(world, base, Vec3::new(0.4, 0.3, 0.6), 5.0)];
    for k in 0..29 {
        let (limb, joint) = (k % 5, k / 5);
        let direction = [Vec3::X, -Vec3::X, Vec3::Y, -Vec3::Y, Vec3::Z][limb];
        let anchor = base + direction * (0.4 + joint as f64 * 0.25);
        let sides = Vec3::splat(0.08) + direction.abs() * 0.17;
        let parent = if joint == 0 { links[0] } else { links[k - 4] };
        let axis = [Vec3::X, Vec3::Y, Vec3::Z][(limb / 2 + joint + 1) % 3];
        let body = link(world, anchor + direction * 0.125, sides, 0.5 + 0.1 * joint as f64);
        let hinge = world.add_hinge(Some(body), Some(parent), anchor, axis).unwrap();
        world.joint_mut::<Hinge>(hinge).unwrap().set_motor(0.0, 1.0 + joint as f64).unwrap();
        links.push(body);
    }
    links
}

/// A chain of thin rods from the origin along x.
fn chain(world: &mut World, count: usize, length: f64, mass: f64) -> Vec<BodyKey> {
    let mut links: Vec<BodyKey> = Vec::new();
    for i in 0..count {
        let at = Vec3::X * ((i as f64 + 0.5) * length);
        let body = link(world, at, Vec3::new(0.9 * length, 0.05, 0.05), mass);
        world.add_ball(Some(body), links.last().copied(), Vec3::X * (i as f64 * length)).unwrap();
        links.push(body);
    }
    links
}

fn energy(world: &World) -> f64 {
    world.bodies().map(|(_, b)| b.kinetic_energy() + b.mass().mass * G * b.position().z).sum()
}

#[test]
fn a_robot_under_two_hundred_boxes_keeps_its_joints() {
    // What the exact stepper leaves of the same robot, thrown to the ground alone.
    let mut alone = world(Stepper::Direct);
    ground(&mut alone);
    robot(&mut alone, Vec3::Z * 1.0);
    let direct = run(&mut alone, H, 120);

    let mut world = world(Stepper::Substep);
    ground(&mut world);
    let links = robot(&mut world, Vec3::Z * 1.0);
    world.set_articulation_exact(links[0], Some(true)).unwrap();
    for i in 0..200usize {
        let (x, y, z) = (i % 5, i / 5 % 5, i / 25);
        let at = Vec3::new(x as f64 - 2.0, y as f64 - 2.0 + 0.05 * (z % 3) as f64, 5.0 + z as f64) * 0.5;
        link(&mut world, at, Vec3::splat(0.4), 10.0);
    }
    let substep = run(&mut world, H, 240);
    println!("alone with Direct {direct:?}, under boxes with Substep {substep:?}");
    assert!(substep.0 <= direct.0.min(3e-3) && substep.1 <= 4e-3, "{substep:?}, {direct:?}");
    let lowest = world.bodies().map(|(_, b)| b.position().z).fold(f64::INFINITY, f64::min);
    assert!(lowest > -0.1, "{lowest}");
    let buried = world.body(links[0]).unwrap().position().z;
    assert!(buried < 1.5, "{buried}");
}

#[test]
fn a_chain_carries_a_hundredfold_mass() {
    let mut world = world(Stepper::Substep);
    let links = chain(&mut world, 20, 0.2, 0.1);
    let end = Vec3::X * 4.0;
    let weight = link(&mut world, end + Vec3::X * 0.1, Vec3::splat(0.2), 10.0);
    world.add_ball(Some(weight), links.last().copied(), end).unwrap();
    let (position, _) = run(&mut world, 1.0 / 240.0, 1200);
    println!("heavy end: {position} m");
    assert!(position < 2e-4, "{position}");
}

#[test]
fn a_long_chain_stays_closed() {
    let mut exact = world(Stepper::Substep);
    chain(&mut exact, 150, 0.2, 0.2);
    let mut loose = exact.clone();
    change(&mut loose, |settings| settings.exact_joints = false);
    let (exact, loose) = (run(&mut exact, H, 120), run(&mut loose, H, 120));
    println!("chain of 150: {} m, joint by joint {} m", exact.0, loose.0);
    assert!(exact.0 < 1e-3, "{exact:?}");
    assert!(loose.0 > 5.0 * exact.0, "{loose:?}");
}

/// A thousandth of a radian of swing, and a wild one.
#[test]
fn a_chain_does_not_gain_energy() {
    for count in [1, 2, 10] {
        let mut world = world(Stepper::Substep);
        change(&mut world, |settings| settings.sleep_speed = 0.0);
        chain(&mut world, count, 0.3, 0.5);
        let before = energy(&world);
        let scale = 0.5 * count as f64 * 0.5 * G * (0.3 * count as f64);
        let mut highest = f64::NEG_INFINITY;
        for _ in 0..600 {
            world.step(H).unwrap();
            highest = highest.max(energy(&world) - before);
        }
        let lost = before - energy(&world);
        println!("{count}: gained {:.2e}, lost {:.3} of {scale:.3} J", highest / scale, lost / scale);
        assert!(highest < 5e-3 * scale, "{count}: {highest} of {scale}");
    }
}

#[test]
fn loops_hold() {
    let mut world = world(Stepper::Substep);
    // Crank, coupler, rocker: a parallelogram in the x-z plane, with more rows than it needs.
    let pins = [Vec3::ZERO, Vec3::new(0.0, 0.0, 0.3), Vec3::new(1.0, 0.0, 0.3), Vec3::new(1.0, 0.0, 0.0)];
    let bars: Vec<BodyKey> = pins
        .windows(2)
        .map(|p| {
            let along = (p[1] - p[0]).abs();
            link(&mut world, (p[0] + p[1]) * 0.5, Vec3::splat(0.04) + along * 0.9, 1.0)
        })
        .collect();
    let ends = [
        (None, Some(bars[0])),
        (Some(bars[0]), Some(bars[1])),
        (Some(bars[1]), Some(bars[2])),
        (Some(bars[2]), None),
    ];
    let hinges: Vec<JointKey> =
        ends.iter().zip(pins).map(|((a, b), pin)| world.add_hinge(*b, *a, pin, Vec3::Y).unwrap()).collect();
    world.joint_mut::<Hinge>(hinges[0]).unwrap().set_motor(3.0, 50.0).unwrap();
    let worst = run(&mut world, H, 600);
    println!("four-bar: {worst:?}");
    assert!(worst.0 < 2e-4 && worst.1 < 1e-4, "{worst:?}");
    let rate = world.joint::<Hinge>(hinges[0]).unwrap().angle_rate();
    assert!((rate - 3.0).abs() < 1e-2, "{rate}");
    // The rocker turns with the crank.
    let difference =
        world.body(bars[0]).unwrap().angular_velocity() - world.body(bars[2]).unwrap().angular_velocity();
    assert!(difference.length() < 1e-3, "{difference:?}");
}

#[test]
fn motors_and_stops_act_on_the_whole_arm() {
    // Six light links along x; the motor at the base holds them all, or slips when it is too weak.
    let arm = |torque: f64| {
        let mut world = world(Stepper::Substep);
        change(&mut world, |settings| settings.sleep_speed = 0.0);
        let mut last = None;
        let mut base = None;
        for i in 0..6 {
            let at = Vec3::X * (i as f64 * 0.3);
            let body = link(&mut world, at + Vec3::X * 0.15, Vec3::new(0.27, 0.05, 0.05), 0.5);
            let hinge = world.add_hinge(Some(body), last, at, Vec3::Y).unwrap();
            let mut motor = world.joint_mut::<Hinge>(hinge).unwrap();
            motor.set_motor(0.0, if i == 0 { torque } else { 1e5 }).unwrap();
            base = base.or(Some(hinge));
            last = Some(body);
        }
        (world, base.unwrap(), last.unwrap())
    };
    // 3 kg at a lever of 0.9 m.
    let needed = 3.0 * G * 0.9;
    let (mut holds, base, tip) = arm(1.05 * needed);
    run(&mut holds, H, 300);
    let sag = holds.body(tip).unwrap().position().z;
    assert!(sag.abs() < 2e-3, "{sag}");
    assert!(holds.joint::<Hinge>(base).unwrap().angle().abs() < 1e-3);
    let (mut slips, base, _) = arm(0.8 * needed);
    run(&mut slips, H, 30);
    let angle = slips.joint::<Hinge>(base).unwrap().angle();
    // What is left of the torque turns the arm: α = 0.2 M g L/2 / (M L²/3).
    let expected = 0.5 * 0.2 * needed / (3.0 * 1.8 * 1.8 / 3.0) * 0.25;
    assert!((angle.abs() / expected - 1.0).abs() < 0.06, "{angle} {expected}");
    // A stop catches the falling arm.
    let (mut caught, base, tip) = arm(0.0);
    caught.joint_mut::<Hinge>(base).unwrap().set_limits(-0.5, 0.5).unwrap();
    run(&mut caught, H, 240);
    let angle = caught.joint::<Hinge>(base).unwrap().angle().abs();
    assert!((angle - 0.5).abs() < 2e-3, "{angle}");
    let down = caught.body(tip).unwrap().position();
    assert!((down.z + 1.65 * real::sin(0.5)).abs() < 5e-3, "{down:?}");
}

#[test]
fn a_ragdoll_stays_whole() {
    let mut world = world(Stepper::Substep);
    ground(&mut world);
    for i in 0..5 {
        let at = Vec3::new(i as f64 * 0.9, 0.0, 1.3 + 0.2 * i as f64);
        let mut limb = |centre: Vec3, sides: Vec3| {
            link(&mut world, at + centre, sides, 800.0 * sides.x * sides.y * sides.z)
        };
        let chest = limb(Vec3::new(0.0, 0.0, 0.4), Vec3::new(0.35, 0.2, 0.5));
        let head = limb(Vec3::new(0.0, 0.0, 0.82), Vec3::splat(0.2));
        let mut parts = vec![(chest, head, Vec3::new(0.0, 0.0, 0.68), None)];
        for s in [-1.0, 1.0] {
            let upper = limb(Vec3::new(0.3 * s, 0.03, 0.45), Vec3::new(0.1, 0.1, 0.3));
            let lower = limb(Vec3::new(0.3 * s, 0.03, 0.12), Vec3::new(0.08, 0.08, 0.3));
            let thigh = limb(Vec3::new(0.1 * s, 0.0, -0.07), Vec3::new(0.14, 0.14, 0.4));
            let shin = limb(Vec3::new(0.1 * s, 0.0, -0.5), Vec3::new(0.1, 0.1, 0.4));
            parts.push((chest, upper, Vec3::new(0.25 * s, 0.0, 0.62), None));
            parts.push((upper, lower, Vec3::new(0.3 * s, 0.0, 0.28), Some((-2.0, 0.0))));
            parts.push((chest, thigh, Vec3::new(0.1 * s, 0.0, 0.14), None));
            parts.push((thigh, shin, Vec3::new(0.1 * s, 0.0, -0.28), Some((0.0, 2.0))));
        }
        for (a, b, anchor, limits) in parts {
            match limits {
                None => _ = world.add_ball(Some(a), Some(b), at + anchor).unwrap(),
                Some((low, high)) => {
                    let knee = world.add_hinge(Some(a), Some(b), at + anchor, Vec3::X).unwrap();
                    world.joint_mut::<Hinge>(knee).unwrap().set_limits(low, high).unwrap();
                }
            }
        }
        let push = Vec3::new(2.0, 0.5, 0.0);
        world.body_mut(chest).unwrap().set_linear_velocity(push).unwrap();
    }
    let worst = run(&mut world, H, 300);
    println!("ragdolls: {worst:?}");
    assert!(worst.0 < 1e-3 && worst.1 < 4e-3, "{worst:?}");
    let kinetic: f64 = world.bodies().map(|(_, b)| b.kinetic_energy()).sum();
    assert!(kinetic < 5.0, "{kinetic}");
}

#[test]
fn a_robot_sleeps_and_wakes_as_a_whole() {
    let mut world = world(Stepper::Substep);
    ground(&mut world);
    let links = robot(&mut world, Vec3::Z * 0.4);
    run(&mut world, H, 360);
    let awake = |world: &World| links.iter().filter(|key| world.body(**key).unwrap().is_enabled()).count();
    assert_eq!(awake(&world), 0);
    let fist = world.body(links[25]).unwrap().position();
    link(&mut world, fist + Vec3::Z * 1.0, Vec3::splat(0.2), 5.0);
    let mut woken = false;
    let mut worst = (0.0f64, 0.0f64);
    for _ in 0..60 {
        let now = run(&mut world, H, 1);
        worst = (worst.0.max(now.0), worst.1.max(now.1));
        woken |= awake(&world) == links.len();
    }
    assert!(woken && worst.0 < 1e-3, "{woken} {worst:?}");
}

#[test]
fn joints_may_break_and_come_back() {
    let mut world = world(Stepper::Substep);
    let links = chain(&mut world, 12, 0.3, 0.5);
    run(&mut world, H, 60);
    let middle = world.joints().find(|j| world.joint_bodies(*j).unwrap().contains(&Some(links[6]))).unwrap();
    world.destroy_joint(middle).unwrap();
    let last = *links.last().unwrap();
    let before = world.body(last).unwrap().position().z;
    let worst = run(&mut world, H, 90);
    assert!(worst.0 < 1e-3, "{worst:?}");
    assert!(world.body(last).unwrap().position().z < before - 3.0, "what is cut off falls");
    // A new joint takes it along again, from where it is.
    let at = world.body(last).unwrap().position();
    world.add_ball(Some(last), None, at).unwrap();
    let worst = run(&mut world, H, 240);
    assert!(worst.0 < 3e-3, "{worst:?}");
    assert!((world.body(last).unwrap().position() - at).length() < 1e-3);
}

#[test]
fn joints_can_be_left_to_the_sweeps() {
    let mut world = world(Stepper::Substep);
    chain(&mut world, 100, 0.2, 0.2);
    let keys: Vec<JointKey> = world.joints().collect();
    assert_eq!(world.joint_exact(keys[0]).unwrap(), None);
    let run_with = |mark: Option<bool>, default: bool| {
        let mut world = world.clone();
        change(&mut world, |settings| settings.exact_joints = default);
        for key in &keys {
            world.joint_mut::<Ball>(*key).unwrap().set_exact(mark);
        }
        run(&mut world, H, 60).0
    };
    let (exact, loose) = (run_with(None, true), run_with(None, false));
    assert!(loose > 10.0 * exact, "{loose} {exact}");
    assert_eq!(run_with(Some(true), false), exact);
    assert_eq!(run_with(Some(false), true), loose);
}

#[test]
fn rows_that_are_carried_along_do_as_written_ones() {
    // An arm of hinges and balls in turn falls, where joints whose forces are recorded write their rows.
    let fall = |written: fn(usize) -> bool, base: Vec3| {
        let mut world = world(Stepper::Substep);
        change(&mut world, |settings| settings.sleep_speed = 0.0);
        let mut last = None;
        for i in 0..8 {
            let at = base + Vec3::X * (i as f64 * 0.3);
            let sides = Vec3::new(0.26, 0.06, 0.04);
            let body = link(&mut world, at + Vec3::X * 0.15, sides, 0.5 + 0.1 * i as f64);
            let joint = if i % 2 == 0 {
                let axis = if i % 4 == 0 { Vec3::Y } else { Vec3::new(0.0, 0.6, 0.8) };
                let hinge = world.add_hinge(Some(body), last, at, axis).unwrap();
                if i == 4 {
                    world.joint_mut::<Hinge>(hinge).unwrap().set_motor(2.0, 0.5).unwrap();
                }
                hinge
            } else {
                world.add_ball(Some(body), last, at).unwrap()
            };
            world.set_joint_feedback(joint, written(i)).unwrap();
            last = Some(body);
        }
        let (position, angle) = run(&mut world, H, 30);
        assert!(position < 1e-6 && angle < 1e-5, "{position} {angle}");
        world.bodies().map(|(_, body)| body.position() - base).collect::<Vec<_>>()
    };
    let expected = fall(|_| true, Vec3::ZERO);
    assert!(expected.iter().any(|p| p.z < -0.5), "{expected:?}");
    let far = Vec3::new(1e7, -1e7, 1e7);
    for found in [fall(|_| false, Vec3::ZERO), fall(|i| i % 3 == 1, Vec3::ZERO), fall(|_| false, far)] {
        for (a, b) in expected.iter().zip(&found) {
            assert!((*a - *b).length() < 1e-4, "{a:?} {b:?}");
        }
    }
}

fn hash(world: &World) -> u64 {
    world.bodies().fold(0, |hash: u64, (_, body)| {
        let (p, q, v) = (body.position(), body.quaternion(), body.angular_velocity());
        [p.x, p.y, p.z, q.w, q.x, v.x, v.y, v.z]
            .iter()
            .fold(hash, |hash, x| (hash ^ x.to_bits()).wrapping_mul(0x100_0000_01b3).rotate_left(5))
    })
}

/// An arm of five hinges with a motor, a brake and stops, which hangs from the world and falls against them.
fn arm(world: &mut World, base: Vec3, mass: f64) -> Vec<BodyKey> {
    let mut links: Vec<BodyKey> = Vec::new();
    for i in 0..5 {
        let at = base + Vec3::X * (i as f64 * 0.3);
        let body = link(world, at + Vec3::X * 0.15, Vec3::new(0.26, 0.06, 0.04), mass + 0.1 * i as f64);
        let axis = if i % 2 == 0 { Vec3::Y } else { Vec3::new(0.0, 0.6, 0.8) };
        let hinge = world.add_hinge(Some(body), links.last().copied(), at, axis).unwrap();
        let mut hinge = world.joint_mut::<Hinge>(hinge).unwrap();
        match i {
            1 => hinge.set_motor(2.0, 0.5).unwrap(),
            3 => hinge.set_motor(0.0, 0.3).unwrap(),
            _ => hinge.set_limits(-0.4, 0.3).unwrap(),
        };
        links.push(body);
    }
    links
}

#[test]
fn alone_and_in_company_articulations_move_alike() {
    let fall = |company: bool| {
        let mut world = world(Stepper::Substep);
        change(&mut world, |settings| settings.sleep_speed = 0.0);
        let links = arm(&mut world, Vec3::ZERO, 0.5);
        if company {
            // Built alike, and on a table.
            let table = Cuboid::new(Vec3::new(3.0, 1.0, 0.2)).unwrap();
            world.add_static(table, Pose::from_position(Vec3::new(0.7, 5.0, -0.12))).unwrap();
            arm(&mut world, Vec3::Y * 5.0, 0.5);
        }
        let (position, angle) = run(&mut world, H, 60);
        assert!(position < 1e-5 && angle < 1e-4, "{position} {angle}");
        links.iter().map(|key| world.body(*key).unwrap().position()).collect::<Vec<_>>()
    };
    let (alone, company) = (fall(false), fall(true));
    assert!(alone.iter().any(|p| p.z < -0.2), "{alone:?}");
    for (a, b) in alone.iter().zip(&company) {
        assert!((*a - *b).length() < 1e-3, "{a:?} {b:?}");
    }
}

#[test]
fn lanes_of_every_width_give_the_same_bits_alone_too() {
    // Arms of one shape that reach their stops one after the other, at no contact with anything.
    let mut start = world(Stepper::Substep);
    for i in 0..19 {
        arm(&mut start, Vec3::Y * i as f64, 0.5 + 0.2 * i as f64);
    }
    let run_at = |level: Option<Level>| {
        let mut world = start.clone();
        change(&mut world, |settings| settings.lanes = level);
        for _ in 0..90 {
            world.step(H).unwrap();
        }
        hash(&world)
    };
    let expected = run_at(None);
    for level in Level::ALL.into_iter().filter(|level| level.is_available()) {
        assert_eq!(run_at(Some(level)), expected, "{level:?}");
    }
}

#[test]
fn lanes_of_every_width_give_the_same_bits() {
    let mut start = world(Stepper::Substep);
    ground(&mut start);
    // Shapes that come once, thrice, and nineteen times, which leaves some lanes empty at every width.
    robot(&mut start, Vec3::new(0.0, 0.0, 1.2));
    for (count, links, y) in [(3, 4, 4.0), (19, 2, -4.0)] {
        for i in 0..count {
            let mut last = None;
            for k in 0..links {
                let at = Vec3::new(i as f64 * 0.5, y + 0.3 * k as f64, 1.0 + 0.05 * i as f64);
                let body = link(&mut start, at, Vec3::splat(0.2), 1.0 + i as f64);
                if let Some(last) = last {
                    let hinge =
                        start.add_hinge(Some(body), Some(last), at - Vec3::Y * 0.15, Vec3::X).unwrap();
                    start.joint_mut::<Hinge>(hinge).unwrap().set_limits(-0.1 * i as f64, 0.3).unwrap();
                    // It writes its rows, the others carry theirs along.
                    start.set_joint_feedback(hinge, k == 2).unwrap();
                }
                last = Some(body);
            }
        }
    }
    let run_at = |level: Option<Level>| {
        let mut world = start.clone();
        change(&mut world, |settings| settings.lanes = level);
        for _ in 0..90 {
            world.step(H).unwrap();
        }
        hash(&world)
    };
    let expected = run_at(None);
    for level in Level::ALL.into_iter().filter(|level| level.is_available()) {
        assert_eq!(run_at(Some(level)), expected, "{level:?}");
    }
}
