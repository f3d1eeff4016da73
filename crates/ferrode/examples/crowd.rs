//! Scenes of many bodies, timed: `cargo run --release --example crowd -- pyramid 600`.
//!
//! Arguments: the scene (`pyramid`, `bin`, `ragdolls`, `robots`, `chain`, `heavy`), the number of steps, and optionally the
//! number of bodies, rows or robots, and `awake` to keep bodies from falling asleep, `substeps=8`, `frequency=60`, `damping=5`, `push=1`,
//! `threads=2`.

use ferrode::prelude::*;
use ferrode::{Ball, Hinge, JointError};
use std::time::Instant;

const H: f64 = 1.0 / 60.0;

fn main() -> Result<(), Error> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let word = |i: usize, or: &'static str| arguments.get(i).map_or(or, String::as_str).to_owned();
    let steps: usize = word(1, "300").parse().unwrap_or(300);
    let size: usize = word(2, "0").parse().unwrap_or(0);
    let mut world = World::new();
    world.stepper = Stepper::Substep;
    world.set_gravity(Vec3::new(0.0, 0.0, -9.81))?;
    world.set_default_material(Material::with_friction(0.6))?;
    let mut settings = *world.dynamics().substep();
    for argument in &arguments {
        let (name, value) = argument.split_once('=').unwrap_or((argument, ""));
        let number = value.parse().unwrap_or(0.0);
        match name {
            "awake" => settings.sleep_speed = 0.0,
            "substeps" => settings.substeps = number as u32,
            "frequency" => settings.contact.frequency = number,
            "damping" => settings.contact.damping_ratio = number,
            "loose" => settings.exact_joints = false,
            "jfrequency" => settings.joint.frequency = number,
            "jdamping" => settings.joint.damping_ratio = number,
            "threads" => world.set_threads(number as usize),
            "push" => settings.push_out_speed = number,
            _ => {}
        }
    }
    world.set_substep(settings)?;
    let or = |default: usize| if size == 0 { default } else { size };
    match word(0, "pyramid").as_str() {
        "pyramid" => pyramid(&mut world, or(40))?,
        "bin" => bin(&mut world, or(4096))?,
        "ragdolls" => ragdolls(&mut world, or(200))?,
        "robots" => robots(&mut world, or(64))?,
        "chain" => _ = chain(&mut world, or(1000))?,
        "heavy" => heavy(&mut world, or(20))?,
        other => {
            eprintln!("no scene {other}");
            return Ok(());
        }
    }
    let start: Vec<Vec3> = world.bodies().map(|(_, b)| b.position()).collect();
    let (mut times, mut deepest) = (Vec::new(), 0.0f64);
    let (mut widest, mut askew) = (0.0f64, 0.0f64);
    for i in 0..steps {
        let before = Instant::now();
        let step = world.step(H)?;
        times.push(before.elapsed().as_secs_f64() * 1e3);
        deepest = deepest.max(step.max_depth);
        widest = widest.max(joint_error(&world, |e| e.position));
        askew = askew.max(joint_error(&world, |e| e.angle));
        if (i + 1) % 60 == 0 {
            let moved = (world.bodies().zip(&start)).map(|((_, b), s)| (b.position() - *s).length());
            let last = &times[times.len() - 60..];
            println!(
                "{:5.1} s  {:7.3} ms  least {:7.3}  contacts {:6}  depth {:8.5}  awake {:5}  kinetic {:10.4}  moved {:.4}  error {:.6} m {:.6} rad",
                (i + 1) as f64 * H,
                last.iter().sum::<f64>() / last.len() as f64,
                last.iter().copied().fold(f64::INFINITY, f64::min),
                step.contacts,
                step.max_depth,
                world.bodies().filter(|(_, b)| b.is_enabled()).count(),
                world.bodies().map(|(_, b)| b.kinetic_energy()).sum::<f64>(),
                moved.fold(0.0, f64::max),
                joint_error(&world, |e| e.position),
                joint_error(&world, |e| e.angle),
            );
        }
    }
    times.sort_by(f64::total_cmp);
    let mean = times.iter().sum::<f64>() / times.len() as f64;
    println!(
        "mean {mean:.3} ms, median {:.3} ms; ever: depth {deepest:.5} m, joint error {widest:.6} m {askew:.6} rad",
        times[times.len() / 2]
    );
    Ok(())
}

fn joint_error(world: &World, part: impl Fn(JointError) -> f64) -> f64 {
    world.joints().filter_map(|j| world.joint_error(j).ok()).fold(0.0, |e, x| e.max(part(x)))
}

fn ground(world: &mut World) -> Result<(), Error> {
    world.add_static(
        Cuboid::new(Vec3::new(200.0, 200.0, 2.0))?,
        Pose::from_position(Vec3::new(0.0, 0.0, -1.0)),
    )?;
    Ok(())
}

fn pyramid(world: &mut World, rows: usize) -> Result<(), Error> {
    ground(world)?;
    for row in 0..rows {
        for i in 0..rows - row {
            let x = (i as f64 - 0.5 * (rows - row - 1) as f64) * 1.05;
            let at = Vec3::new(x, 0.0, 0.5 + row as f64);
            world.add_body(BodyBuilder::new().at(at).with_shape(Cuboid::new(Vec3::splat(1.0))?, 1000.0))?;
        }
    }
    Ok(())
}

fn bin(world: &mut World, count: usize) -> Result<(), Error> {
    let per_side = ((count as f64).cbrt_portable() * 0.8).ceil().max(2.0);
    let half = per_side * 0.55;
    ground(world)?;
    for (x, y) in [(1.0, 0.0), (-1.0, 0.0), (0.0, 1.0), (0.0, -1.0)] {
        let size = Vec3::new(
            if x == 0.0 { 2.0 * half + 2.0 } else { 1.0 },
            if y == 0.0 { 2.0 * half + 2.0 } else { 1.0 },
            40.0,
        );
        let at = Vec3::new(x * (half + 0.5), y * (half + 0.5), 20.0);
        world.add_static(Cuboid::new(size)?, Pose::from_position(at))?;
    }
    let n = per_side as usize;
    for i in 0..count {
        let (x, y, z) = (i % n, (i / n) % n, i / (n * n));
        let jitter = |k: usize| ((i * 7919 + k * 104_729) % 1000) as f64 * 1e-4 - 0.05;
        let at = Vec3::new(
            (x as f64 - 0.5 * (n - 1) as f64) * 1.05 + jitter(1),
            (y as f64 - 0.5 * (n - 1) as f64) * 1.05 + jitter(2),
            0.7 + z as f64 * 1.2,
        );
        world.add_body(
            BodyBuilder::new()
                .at(at)
                .rotated(Quat::from_axis_angle(Vec3::new(1.0, 0.3, 0.2), jitter(3) * 4.0))
                .with_shape(Cuboid::new(Vec3::splat(0.9))?, 1000.0),
        )?;
    }
    Ok(())
}

trait Cbrt {
    fn cbrt_portable(self) -> f64;
}

impl Cbrt for f64 {
    fn cbrt_portable(self) -> f64 {
        ferrode::math::real::cbrt(self)
    }
}

/// A body of eleven parts: torso, head, arms and legs of two parts each, hands and feet left out.
fn ragdolls(world: &mut World, count: usize) -> Result<(), Error> {
    ground(world)?;
    let side = (count as f64).sqrt().ceil() as usize;
    for i in 0..count {
        let origin = Vec3::new((i % side) as f64 * 1.2, (i / side) as f64 * 1.2, 1.5 + (i % 7) as f64 * 0.3);
        ragdoll(world, origin)?;
    }
    Ok(())
}

fn ragdoll(world: &mut World, at: Vec3) -> Result<(), Error> {
    let mut limb = |centre: Vec3, radius: f64, length: f64| -> Result<BodyKey, Error> {
        world.add_body(BodyBuilder::new().at(at + centre).with_shape(Capsule::new(radius, length)?, 1000.0))
    };
    let pelvis = limb(Vec3::new(0.0, 0.0, 0.0), 0.13, 0.1)?;
    let chest = limb(Vec3::new(0.0, 0.0, 0.4), 0.15, 0.2)?;
    let head = limb(Vec3::new(0.0, 0.0, 0.85), 0.1, 0.08)?;
    let mut joints =
        vec![(pelvis, chest, Vec3::new(0.0, 0.0, 0.2), None), (chest, head, Vec3::new(0.0, 0.0, 0.7), None)];
    for s in [-1.0, 1.0] {
        let upper_arm = limb(Vec3::new(0.28 * s, 0.0, 0.4), 0.06, 0.2)?;
        let lower_arm = limb(Vec3::new(0.28 * s, 0.0, 0.05), 0.05, 0.2)?;
        let thigh = limb(Vec3::new(0.14 * s, 0.0, -0.4), 0.08, 0.3)?;
        let shin = limb(Vec3::new(0.14 * s, 0.0, -0.9), 0.06, 0.3)?;
        joints.push((chest, upper_arm, Vec3::new(0.25 * s, 0.0, 0.55), None));
        joints.push((upper_arm, lower_arm, Vec3::new(0.28 * s, 0.0, 0.22), Some((-2.0, 0.0))));
        joints.push((pelvis, thigh, Vec3::new(0.14 * s, 0.0, -0.15), None));
        joints.push((thigh, shin, Vec3::new(0.14 * s, 0.0, -0.65), Some((0.0, 2.0))));
    }
    for (a, b, anchor, hinge) in joints {
        match hinge {
            None => {
                let joint = world.create_joint::<Ball>(None)?;
                world.attach(joint, Some(a), Some(b))?;
                world.joint_mut::<Ball>(joint)?.set_anchor(at + anchor)?;
            }
            Some((low, high)) => {
                let joint = world.create_joint::<Hinge>(None)?;
                world.attach(joint, Some(a), Some(b))?;
                let mut hinge = world.joint_mut::<Hinge>(joint)?;
                hinge.set_anchor(at + anchor)?;
                hinge.set_axis(Vec3::X)?;
                hinge.set_limits(low, high)?;
            }
        }
    }
    Ok(())
}

/// Robots of a torso, hinged to the world, and five limbs: 30 hinges with brakes each.
fn robots(world: &mut World, count: usize) -> Result<(), Error> {
    let axes = [Vec3::X, Vec3::Y, Vec3::Z];
    for robot in 0..count {
        let base = Vec3::new((robot % 8) as f64 * 5.0, (robot / 8) as f64 * 5.0, 3.0);
        let mut link = |at: Vec3, sides: Vec3, mass: f64, parent, anchor, axis, brake| -> Result<_, Error> {
            let shape = Cuboid::new(sides)?;
            let body = world.add_body(
                BodyBuilder::new().at(at).with_shape(shape, mass / (sides.x * sides.y * sides.z)),
            )?;
            let joint = world.add_hinge(Some(body), parent, anchor, axis)?;
            world.joint_mut::<Hinge>(joint)?.set_motor(0.0, brake)?;
            Ok(body)
        };
        let mut links = vec![link(base, Vec3::new(0.4, 0.3, 0.6), 5.0, None, base, Vec3::Z, 5.0)?];
        for k in 0..29 {
            let (limb, joint) = (k % 5, k / 5);
            let direction = [Vec3::X, -Vec3::X, Vec3::Y, -Vec3::Y, Vec3::Z][limb];
            let anchor = base + direction * (0.4 + joint as f64 * 0.25);
            let sides = Vec3::splat(0.08) + direction.abs() * 0.17;
            let parent = if joint == 0 { links[0] } else { links[k + 1 - 5] };
            let axis = axes[(limb / 2 + joint + 1) % 3];
            let (mass, brake) = (0.5 + 0.1 * joint as f64, 1.0 + joint as f64);
            links.push(link(anchor + direction * 0.125, sides, mass, Some(parent), anchor, axis, brake)?);
        }
    }
    Ok(())
}

/// A chain with a ball of a hundred times a link's mass at its end.
fn heavy(world: &mut World, links: usize) -> Result<(), Error> {
    let last = chain(world, links)?;
    let mass = last.map_or(Ok(1.0), |key| world.body(key).map(|body| body.mass().mass))?;
    let end = Vec3::X * (links as f64 * 0.4);
    let radius: f64 = 0.3;
    let density = 100.0 * mass / (4.0 / 3.0 * core::f64::consts::PI * radius * radius * radius);
    let shape = Sphere::new(radius)?;
    let ball = world.add_body(BodyBuilder::new().at(end + Vec3::X * radius).with_shape(shape, density))?;
    world.add_ball(Some(ball), last, end)?;
    Ok(())
}

/// A chain of capsules that hangs from its first; its last.
fn chain(world: &mut World, links: usize) -> Result<Option<BodyKey>, Error> {
    let mut before = None;
    for i in 0..links {
        let at = Vec3::new(i as f64 * 0.4 + 0.2, 0.0, 0.0);
        let lying = Quat::from_axis_angle(Vec3::Y, core::f64::consts::FRAC_PI_2);
        let body = world.add_body(
            BodyBuilder::new().at(at).rotated(lying).with_shape(Capsule::new(0.05, 0.25)?, 1000.0),
        )?;
        let joint = world.create_joint::<Ball>(None)?;
        world.attach(joint, Some(body), before)?;
        world.joint_mut::<Ball>(joint)?.set_anchor(Vec3::new(i as f64 * 0.4, 0.0, 0.0))?;
        before = Some(body);
    }
    Ok(before)
}
