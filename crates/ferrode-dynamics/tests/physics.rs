//! Laws that a step keeps: momentum, energy to first order, independence of the frame, springs as soft constraints.

use core::f64::consts::LN_2;
use ferrode_dynamics::{
    Ball, BodyKey, DBall, Error, Fixed, Hinge, JointKey, Mass, PR, PU, Param, Piston, QuickSettings, Slider,
    Softness, Stepper, Universal, World,
};
use ferrode_math::random::OdeRandom;
use ferrode_math::{Mat3, Pose, Quat, Vec3, plane_space, real};

const STEPPERS: [Stepper; 2] = [Stepper::Direct, Stepper::Quick];

/// Numbers in few digits.
fn scientific(numbers: &[f64]) -> String {
    numbers.iter().map(|x| format!("{x:.1e}")).collect::<Vec<_>>().join(" ")
}

fn random_vector(random: &mut OdeRandom, range: f64) -> Vec3 {
    random.next_vector(range)
}

/// A random rotation.
fn random_rotation(random: &mut OdeRandom) -> Quat {
    Quat::from_axis_angle(random_vector(random, 1.0), 3.0 * random.next_signed(1.0))
}

/// How many types of joints chains are made of.
const JOINTS: usize = 8;

/// The last type, which in ODE makes angular momentum once it is drawn out: its lever on the first body stays at the
/// anchor of that body.
const WITHOUT_PU: usize = JOINTS - 1;

/// Joins two bodies by the joint type of a number, with the anchor, an axis and a vector across it given in the world.
fn join(
    world: &mut World,
    number: usize,
    bodies: [BodyKey; 2],
    anchor: Vec3,
    [axis, across]: [Vec3; 2],
) -> Result<JointKey, Error> {
    let (a, b) = (Some(bodies[0]), Some(bodies[1]));
    macro_rules! joint {
        ($kind:ty, $($set:ident($($arg:expr),*)),+) => {{
            let key = world.create_joint::<$kind>(None)?;
            world.attach(key, a, b)?;
            let mut joint = world.joint_mut::<$kind>(key)?;
            $(joint.$set($($arg),*)?;)+
            key
        }};
    }
    Ok(match number % JOINTS {
        0 => joint!(Ball, set_anchor(anchor)),
        1 => joint!(Hinge, set_anchor(anchor), set_axis(axis), set_motor(0.5, 2.0)),
        2 => joint!(Universal, set_anchor(anchor), set_axis1(axis), set_axis2(across)),
        3 => joint!(Slider, set_axis(axis), set_limits(-0.02, 0.02)),
        4 => joint!(Piston, set_anchor(anchor), set_axis(axis)),
        5 => joint!(DBall, set_anchor1(anchor), set_anchor2(anchor + across * 0.3)),
        6 => joint!(PR, set_anchor(anchor), set_axis1(across), set_axis2(axis)),
        _ => {
            joint!(PU, set_anchor(anchor), set_axis1(across), set_axis2(axis.cross(across)), set_axis3(axis))
        }
    })
}

/// A chain of random bodies with random joints of the first `kinds` types, in no gravity, in a frame of its own within the
/// world.
fn random_chain(seed: u32, length: usize, kinds: usize, frame: Pose) -> Result<(World, Vec<BodyKey>), Error> {
    let mut random = OdeRandom::new(seed);
    let mut world = World::new();
    let mut bodies: Vec<BodyKey> = Vec::new();
    let mut at = Vec3::ZERO;
    for i in 0..length {
        at += Vec3::new(1.0, 0.0, 0.0) + random_vector(&mut random, 0.3);
        let key = world.create_body();
        let sides = Vec3::splat(0.6) + random_vector(&mut random, 0.4);
        let body = world.body_mut(key)?;
        body.set_mass(&Mass::cuboid_total(2.0 + random.next_signed(1.5), sides)?)?;
        body.set_pose(frame * Pose::new(at, random_rotation(&mut random)))?;
        body.set_linear_velocity(frame.transform_vector(random_vector(&mut random, 1.0)))?;
        body.set_angular_velocity(frame.transform_vector(random_vector(&mut random, 1.0)))?;
        let anchor = at - Vec3::new(0.5, 0.0, 0.0) + random_vector(&mut random, 0.1);
        let axis = random_vector(&mut random, 1.0).normalized_or(Vec3::Z);
        let kind = random.next_below(kinds as u32) as usize;
        if let Some(&previous) = bodies.last() {
            let ends = if i % 2 == 0 { [previous, key] } else { [key, previous] };
            let axes = [axis, plane_space(axis).0].map(|v| frame.transform_vector(v));
            join(&mut world, kind, ends, frame.transform_point(anchor), axes)?;
        }
        bodies.push(key);
    }
    Ok((world, bodies))
}

/// Pose and inertia of each body, to measure momenta with.
fn places(world: &World) -> Vec<(Vec3, Mat3)> {
    world.bodies().map(|(_, b)| (b.position(), b.inertia_world())).collect()
}

/// Linear and angular momentum (about the origin) of the world's velocities at the given places.
fn momenta(world: &World, places: &[(Vec3, Mat3)]) -> (Vec3, Vec3) {
    let (mut p, mut l) = (Vec3::ZERO, Vec3::ZERO);
    for ((_, body), (position, inertia)) in world.bodies().zip(places) {
        let m = body.linear_velocity() * body.mass().mass;
        p += m;
        l += position.cross(m) + *inertia * body.angular_velocity();
    }
    (p, l)
}

/// Forces of all joints cancel, and so do their torques about any point while anchors coincide: in the first step, whose
/// velocities are measured where the bodies were.
#[test]
fn joints_make_no_momentum() -> Result<(), Error> {
    let mut worst: f64 = 0.0;
    for seed in 0..50 {
        for stepper in STEPPERS {
            let (mut world, bodies) = random_chain(seed, 9, JOINTS, Pose::IDENTITY)?;
            for body in &bodies {
                world.body_mut(*body)?.set_gyroscopic_mode(false);
            }
            let places = places(&world);
            let before = momenta(&world, &places);
            world.step(stepper, 0.01)?;
            let after = momenta(&world, &places);
            let change = (after.0 - before.0).length().max((after.1 - before.1).length());
            worst = worst.max(change);
            assert!(change < 1e-11, "seed {seed} {stepper:?}: {change:e}");
        }
    }
    println!("largest change of momentum in a step: {worst:.1e}");
    Ok(())
}

/// Linear momentum stays to rounding. Angular momentum changes as positions move under constant velocities, and by the
/// implicit gyroscopic torque: by less the smaller the step, in first order.
#[test]
fn chains_keep_momentum() -> Result<(), Error> {
    for stepper in STEPPERS {
        let mut drifts = [0.0; 4];
        for seed in 0..10 {
            for (drift, halvings) in drifts.iter_mut().zip(0..) {
                let (mut world, _) = random_chain(seed, 6, WITHOUT_PU, Pose::IDENTITY)?;
                let steps = 100 << halvings;
                let before = momenta(&world, &places(&world));
                for _ in 0..steps {
                    world.step(stepper, 0.5 / f64::from(steps))?;
                }
                let after = momenta(&world, &places(&world));
                let linear = (after.0 - before.0).length();
                assert!(linear < 1e-11, "seed {seed} {stepper:?}: linear momentum drifts by {linear:e}");
                *drift += (after.1 - before.1).length() / before.1.length() / 10.0;
            }
        }
        let orders: Vec<f64> = drifts.windows(2).map(|d| real::log(d[0] / d[1]) / LN_2).collect();
        println!(
            "{stepper:?}: relative drift of angular momentum in 0.5 s {}, orders {orders:.2?}",
            scientific(&drifts)
        );
        assert!(drifts[3] < 1e-4, "{drifts:?}");
        assert!((0.95..1.05).contains(&orders[2]), "{orders:?}");
    }
    Ok(())
}

/// A rod on a hinge without friction loses energy in proportion to the step.
#[test]
fn pendulum_energy_converges_in_first_order() -> Result<(), Error> {
    let energy = |world: &World, rod: BodyKey| -> Result<f64, Error> {
        let rod = world.body(rod)?;
        Ok(rod.kinetic_energy() + rod.mass().mass * 9.81 * rod.position().z)
    };
    let mut losses = Vec::new();
    for halvings in 0..5 {
        let steps = 800 << halvings;
        let mut world = World::new();
        world.set_gravity(Vec3::new(0.0, 0.0, -9.81))?;
        let rod = world.create_body();
        world.body_mut(rod)?.set_mass(&Mass::cuboid_total(2.0, Vec3::new(1.0, 0.1, 0.1))?)?;
        world.body_mut(rod)?.set_position(Vec3::new(0.5, 0.0, 0.0))?;
        let hinge = world.create_joint::<Hinge>(None)?;
        world.attach(hinge, Some(rod), None)?;
        world.joint_mut::<Hinge>(hinge)?.set_anchor(Vec3::ZERO)?;
        world.joint_mut::<Hinge>(hinge)?.set_axis(Vec3::Y)?;
        for _ in 0..steps {
            world.step(Stepper::Direct, 2.0 / f64::from(steps))?;
        }
        // The rod falls by its half length, 0.5 m, from the horizontal: that is the energy of the swing.
        losses.push(-energy(&world, rod)? / (2.0 * 9.81 * 0.5));
    }
    let orders: Vec<f64> = losses.windows(2).map(|l| real::log(l[0] / l[1]) / LN_2).collect();
    println!(
        "part of a pendulum's energy lost in 2 s, h = 2.5 ms and halves of it: {}, orders {orders:.2?}",
        scientific(&losses)
    );
    assert!(losses[0] > 0.0 && losses[0] < 0.1, "{losses:?}");
    assert!((0.98..1.02).contains(&orders[3]), "{orders:?}");
    Ok(())
}

/// The largest distance of bodies of two worlds, the second seen from a frame.
fn distance(a: &World, b: &World, frame: Pose) -> f64 {
    let mut worst: f64 = 0.0;
    for ((_, a), (_, b)) in a.bodies().zip(b.bodies()) {
        let position = (frame.transform_point(a.position()) - b.position()).length();
        let velocity = (frame.transform_vector(a.linear_velocity()) - b.linear_velocity()).length();
        let spin = (frame.transform_vector(a.angular_velocity()) - b.angular_velocity()).length();
        worst = worst.max(position).max(velocity).max(spin);
    }
    worst
}

/// A scene that is moved and turned as a whole does the same. `Direct` solves exactly; the sweeps of `Quick` go along the
/// world's axes, so that only their limit is free of them.
#[test]
fn frames_do_not_matter() -> Result<(), Error> {
    let turned = Quat::from_axis_angle(Vec3::new(0.3, -0.8, 0.5), 1.1);
    let cases = [
        ("translated", Pose::from_position(Vec3::new(3.0, -4.0, 5.0)), 20),
        ("turned", Pose::new(Vec3::ZERO, turned), 3000),
        ("both", Pose::new(Vec3::new(-1.0, 2.0, 1.0), turned), 3000),
    ];
    for (name, frame, iterations) in cases {
        for stepper in STEPPERS {
            let mut worst: f64 = 0.0;
            for seed in 0..10 {
                let run = |frame: Pose| -> Result<World, Error> {
                    let (mut world, _) = random_chain(seed, 5, JOINTS, frame)?;
                    world.set_gravity(frame.transform_vector(Vec3::new(0.0, 0.0, -9.81)))?;
                    world.set_quick(QuickSettings { iterations, ..QuickSettings::default() })?;
                    for _ in 0..30 {
                        world.step(stepper, 0.01)?;
                    }
                    Ok(world)
                };
                let difference = distance(&run(Pose::IDENTITY)?, &run(frame)?, frame);
                worst = worst.max(difference);
                assert!(difference < 1e-11, "{name} {stepper:?} seed {seed}: {difference:e}");
            }
            println!("{name} {stepper:?}: {worst:.1e}");
        }
    }
    Ok(())
}

/// A mass on a spring and damper along a line, integrated implicitly: m (v' − v) = h (f − kp (x + h v') − kd v').
struct Oscillator {
    mass: f64,
    kp: f64,
    kd: f64,
    force: f64,
    x: f64,
    v: f64,
}

impl Oscillator {
    fn step(&mut self, h: f64) {
        let pull = self.mass * self.v + h * (self.force - self.kp * self.x);
        self.v = pull / (self.mass + h * h * self.kp + h * self.kd);
        self.x += h * self.v;
    }
}

#[test]
fn a_soft_ball_joint_is_an_implicit_spring() -> Result<(), Error> {
    let h = 0.01;
    for (kp, kd) in [(400.0, 7.0), (1e5, 0.0), (0.0, 12.0), (30.0, 200.0)] {
        for stepper in STEPPERS {
            let mut world = World::new();
            world.set_gravity(Vec3::new(0.0, 0.0, -9.81))?;
            world.set_quick(QuickSettings { iterations: 100, ..QuickSettings::default() })?;
            let body = world.create_body();
            world.body_mut(body)?.set_mass(&Mass::sphere_total(2.5, 0.3)?)?;
            let ball = world.create_joint::<Ball>(None)?;
            world.attach(ball, Some(body), None)?;
            world.joint_mut::<Ball>(ball)?.set_anchor(Vec3::ZERO)?;
            let soft = Softness::from_spring(kp, kd, h)?;
            world.set_joint_param(ball, Param::Erp, 1, soft.erp)?;
            world.set_joint_param(ball, Param::Cfm, 1, soft.cfm)?;
            world.body_mut(body)?.set_linear_velocity(Vec3::new(0.4, 0.0, 1.0))?;

            let axis = |force, v| Oscillator { mass: 2.5, kp, kd, force, x: 0.0, v };
            let (mut sideways, mut upright) = (axis(0.0, 0.4), axis(-9.81 * 2.5, 1.0));
            let mut worst: f64 = 0.0;
            for _ in 0..500 {
                world.step(stepper, h)?;
                sideways.step(h);
                upright.step(h);
                let p = world.body(body)?.position();
                worst = worst.max((p.x - sideways.x).abs()).max((p.z - upright.x).abs()).max(p.y.abs());
            }
            println!("ball, kp {kp} kd {kd} {stepper:?}: {worst:.1e}");
            assert!(worst < 1e-12, "kp {kp} kd {kd} {stepper:?}: {worst:e}");
        }
    }
    Ok(())
}

#[test]
fn a_soft_stop_is_an_implicit_spring() -> Result<(), Error> {
    let (h, kp, kd) = (0.005, 900.0, 4.0);
    let soft = Softness::from_spring(kp, kd, h)?;
    let mut world = World::new();
    world.set_gravity(Vec3::new(0.0, 0.0, -9.81))?;
    let body = world.create_body();
    world.body_mut(body)?.set_mass(&Mass::sphere_total(1.5, 0.3)?)?;
    let slider = world.create_joint::<Slider>(None)?;
    world.attach(slider, Some(body), None)?;
    let mut joint = world.joint_mut::<Slider>(slider)?;
    joint.set_axis(Vec3::Z)?;
    joint.set_limits(0.0, 0.0)?;
    joint.limit_motor_mut().set_stop_softness(soft)?;
    let mut spring = Oscillator { mass: 1.5, kp, kd, force: -1.5 * 9.81, x: 0.0, v: 0.0 };
    let mut worst: f64 = 0.0;
    for _ in 0..1000 {
        world.step(Stepper::Direct, h)?;
        spring.step(h);
        worst = worst.max((world.joint::<Slider>(slider)?.position()? - spring.x).abs());
    }
    println!("soft stop: {worst:.1e}");
    assert!(worst < 1e-13, "{worst:e}");
    // It comes to rest where the spring carries the weight.
    assert!((spring.x + 1.5 * 9.81 / kp).abs() < 1e-3, "{}", spring.x);
    Ok(())
}

/// Bodies glued together fall as one, whatever their masses.
#[test]
fn fixed_bodies_fall_as_one() -> Result<(), Error> {
    let mut world = World::new();
    world.set_gravity(Vec3::new(0.0, 0.0, -9.81))?;
    let bodies = [world.create_body(), world.create_body()];
    for (body, (mass, x)) in bodies.into_iter().zip([(1e-3, 0.0), (1e3, 1.0)]) {
        world.body_mut(body)?.set_mass(&Mass::sphere_total(mass, 0.2)?)?;
        world.body_mut(body)?.set_position(Vec3::new(x, 0.0, 0.0))?;
    }
    let glue = world.create_joint::<Fixed>(None)?;
    world.attach(glue, Some(bodies[0]), Some(bodies[1]))?;
    world.joint_mut::<Fixed>(glue)?.set_fixed();
    for _ in 0..100 {
        world.step(Stepper::Direct, 0.01)?;
    }
    // Semi-implicit Euler: x = −g h² n (n + 1)/2.
    let fallen = -9.81 * 0.01 * 0.01 * 100.0 * 101.0 / 2.0;
    for (body, x) in bodies.into_iter().zip([0.0, 1.0]) {
        let gap = (world.body(body)?.position() - Vec3::new(x, 0.0, fallen)).length();
        assert!(gap < 1e-9, "{gap:e}");
    }
    Ok(())
}
