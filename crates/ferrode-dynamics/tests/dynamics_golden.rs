//! Replays cases recorded from libode 0.16.2: free spinning bodies, a pendulum, contacts of every kind, a redundant box,
//! mixed joints and contacts; with both steppers, random seeds included.

use ferrode_dynamics::{
    Ball, BodyKey, Contact, Damping, Error, GroupKey, Hinge, JointKey, Mass, Stepper, Surface, SurfaceMode,
    World,
};
use ferrode_math::{ContactPoint, Mat3, Quat, Vec3};
use std::collections::BTreeMap;

const H: f64 = 0.01;

/// The recorded numbers of a case at a step, by name.
type Recorded = BTreeMap<String, Vec<f64>>;

fn recorded(case: &str, stepper: Stepper) -> Vec<(usize, String, Recorded)> {
    let name = format!("{case} {stepper:?}");
    include_str!("data/dynamics_golden.txt")
        .lines()
        .filter(|line| !line.starts_with('#') && !line.is_empty())
        .filter_map(|line| {
            let fields: Vec<&str> = line.split('|').map(str::trim).collect();
            (fields[0] == name || fields[0] == format!("{case} both")).then(|| {
                let values = fields[3].split(';').map(|group| {
                    let mut words = group.split_whitespace();
                    let key = words.next().expect("a group begins with its name").to_string();
                    (key, words.map(|w| w.parse().expect("a number")).collect())
                });
                (fields[1].parse().expect("a step"), fields[2].to_string(), values.collect())
            })
        })
        .collect()
}

/// What a case shows after a step: by body and name.
type State = BTreeMap<(String, String), Vec<f64>>;

fn body_state(state: &mut State, world: &World, body: BodyKey, name: &str) -> Result<(), Error> {
    let b = world.body(body)?;
    let key = |what: &str| (name.to_string(), what.to_string());
    state.insert(key("p"), b.position().to_array().to_vec());
    state.insert(key("q"), b.quaternion().to_array().to_vec());
    state.insert(key("v"), b.linear_velocity().to_array().to_vec());
    state.insert(key("w"), b.angular_velocity().to_array().to_vec());
    Ok(())
}

fn feedback_state(
    state: &mut State,
    world: &World,
    joint: JointKey,
    name: &str,
    tick: &str,
) -> Result<(), Error> {
    let f = *world.joint_feedback(joint)?.expect("feedback was asked for");
    for (what, v) in [("f1", f.force1), ("t1", f.torque1), ("f2", f.force2), ("t2", f.torque2)] {
        state.insert((name.to_string(), format!("{what}{tick}")), v.to_array().to_vec());
    }
    Ok(())
}

/// Runs a case and compares every recorded number; `tolerance` is absolute, as the figures are of order 1 to 100.
fn replay(
    case: &str,
    stepper: Stepper,
    tolerance: f64,
    mut step: impl FnMut(usize) -> Result<State, Error>,
) -> Result<f64, Error> {
    let wanted = recorded(case, stepper);
    assert!(!wanted.is_empty(), "no figures for {case} {stepper:?}");
    let last = wanted.iter().map(|(s, ..)| *s).max().unwrap_or(0);
    let mut worst: f64 = 0.0;
    for now in 1..=last {
        let state = step(now)?;
        for (_, body, values) in wanted.iter().filter(|(s, ..)| *s == now) {
            for (what, want) in values {
                let got = &state[&(body.clone(), what.clone())];
                assert_eq!(got.len(), want.len(), "{case} {what}");
                for (g, w) in got.iter().zip(want) {
                    let difference = (g - w).abs() / (1.0 + w.abs());
                    worst = worst.max(difference);
                    assert!(
                        difference <= tolerance,
                        "{case} {stepper:?} step {now} {body} {what}: {g} for {w}"
                    );
                }
            }
        }
    }
    println!("{case} {stepper:?}: worst difference {worst:.1e}");
    Ok(worst)
}

fn spinning_box(
    case: &str,
    stepper: Stepper,
    set_up: impl Fn(&mut World, BodyKey) -> Result<(), Error>,
) -> Result<(), Error> {
    let mut world = World::new();
    world.set_gravity(Vec3::new(0.0, 0.0, -9.81))?;
    let key = world.create_body();
    let body = world.body_mut(key)?;
    body.set_mass(&Mass {
        mass: 6.0,
        centre: Vec3::ZERO,
        inertia: Mat3::from_diagonal(Vec3::new(6.5, 5.0, 2.5)),
    })?;
    body.set_position(Vec3::new(0.0, 0.0, 10.0))?;
    body.set_linear_velocity(Vec3::X)?;
    body.set_angular_velocity(Vec3::new(1.0, 2.0, 3.0))?;
    set_up(&mut world, key)?;
    replay(case, stepper, 1e-15, |_| {
        world.step(stepper, H)?;
        let mut state = State::new();
        body_state(&mut state, &world, key, "-")?;
        Ok(state)
    })?;
    Ok(())
}

#[test]
fn a_free_spinning_box() -> Result<(), Error> {
    for stepper in [Stepper::Direct, Stepper::Quick] {
        spinning_box("A0", stepper, |_, _| Ok(()))?;
        spinning_box("A1", stepper, |world, key| {
            world.body_mut(key)?.set_gyroscopic_mode(false);
            Ok(())
        })?;
        spinning_box("A2", stepper, |world, key| {
            world.body_mut(key)?.set_finite_rotation_mode(true);
            Ok(())
        })?;
        spinning_box("A3", stepper, |world, key| {
            let body = world.body_mut(key)?;
            body.set_finite_rotation_mode(true);
            body.set_finite_rotation_axis(Vec3::Z)
        })?;
        spinning_box("A4", stepper, |world, key| {
            let body = world.body_mut(key)?;
            body.set_damping(Damping { linear_scale: 0.1, angular_scale: 0.2, ..Damping::default() })?;
            body.set_max_angular_speed(2.0)
        })?;
        spinning_box("A5", stepper, |world, key| {
            let body = world.body_mut(key)?;
            body.set_quaternion(Quat::new(0.5, 0.5, -0.5, 0.5))?;
            body.add_force_at_relative_position(Vec3::new(1.0, 2.0, 3.0), Vec3::new(0.1, 0.2, 0.3))?;
            body.add_relative_torque(Vec3::new(0.5, 0.0, 0.0))
        })?;
    }
    Ok(())
}

#[test]
fn a_hinge_pendulum() -> Result<(), Error> {
    for stepper in [Stepper::Direct, Stepper::Quick] {
        let mut world = World::new();
        world.set_gravity(Vec3::new(0.0, 0.0, -9.81))?;
        let key = world.create_body();
        world.body_mut(key)?.set_mass(&Mass::cuboid_total(2.0, Vec3::new(1.0, 0.2, 0.2))?)?;
        world.body_mut(key)?.set_position(Vec3::new(0.5, 0.0, 0.0))?;
        let joint = world.create_joint::<Hinge>(None)?;
        world.attach(joint, Some(key), None)?;
        world.joint_mut::<Hinge>(joint)?.set_anchor(Vec3::ZERO)?;
        world.joint_mut::<Hinge>(joint)?.set_axis(Vec3::Y)?;
        world.set_joint_feedback(joint, true)?;
        replay("B", stepper, 1e-12, |_| {
            world.step(stepper, H)?;
            let mut state = State::new();
            body_state(&mut state, &world, key, "-")?;
            feedback_state(&mut state, &world, joint, "-", "")?;
            let hinge = world.joint::<Hinge>(joint)?;
            state.insert(("-".into(), "angle".into()), vec![hinge.angle()]);
            state.insert(("-".into(), "rate".into()), vec![hinge.angle_rate()]);
            state.insert(("-".into(), "seed".into()), vec![f64::from(world.random().seed())]);
            Ok(state)
        })?;
    }
    Ok(())
}

struct SphereCase {
    world: World,
    body: BodyKey,
    group: GroupKey,
}

impl SphereCase {
    fn new() -> Result<Self, Error> {
        let mut world = World::new();
        world.set_gravity(Vec3::new(0.0, 0.0, -9.81))?;
        let body = world.create_body();
        let b = world.body_mut(body)?;
        b.set_mass(&Mass::sphere_total(1.0, 0.5)?)?;
        b.set_position(Vec3::new(0.0, 0.0, 0.49))?;
        b.set_linear_velocity(Vec3::X)?;
        let group = world.create_group();
        Ok(Self { world, body, group })
    }

    /// One step on a contact made by hand, attached as (body, world), or (world, body) with the normal turned round.
    fn step(
        &mut self,
        stepper: Stepper,
        surface: Surface,
        fdir1: Vec3,
        reversed: bool,
    ) -> Result<State, Error> {
        let Self { world, body, group } = self;
        let p = world.body(*body)?.position();
        let normal = if reversed { -Vec3::Z } else { Vec3::Z };
        let point = ContactPoint { position: Vec3::new(p.x, p.y, 0.0), normal, depth: 0.5 - p.z };
        let joint = world.create_contact(Some(*group), &Contact { surface, point, fdir1 })?;
        let (a, b) = if reversed { (None, Some(*body)) } else { (Some(*body), None) };
        world.attach(joint, a, b)?;
        world.set_joint_feedback(joint, true)?;
        world.step(stepper, H)?;
        let mut state = State::new();
        body_state(&mut state, world, *body, "-")?;
        feedback_state(&mut state, world, joint, "-", "")?;
        state.insert(("-".into(), "seed".into()), vec![f64::from(world.random().seed())]);
        world.empty_group(*group)?;
        Ok(state)
    }
}

#[test]
fn a_sphere_on_contacts_of_every_kind() -> Result<(), Error> {
    let (direct, quick) = ([Stepper::Direct], [Stepper::Direct, Stepper::Quick]);
    let base = Surface::with_friction(0.5);
    let constant = |mu: f64| Surface { mu, ..Surface::default() };
    let moving = Surface {
        mode: SurfaceMode::FDIR1 | SurfaceMode::MOTION1 | SurfaceMode::SLIP1 | SurfaceMode::SLIP2 | base.mode,
        motion1: 0.7,
        slip1: 0.01,
        slip2: 0.02,
        ..base
    }
    .with_mu2(0.3);
    let soft = Surface {
        mode: base.mode | SurfaceMode::SOFT_ERP | SurfaceMode::SOFT_CFM,
        soft_erp: 0.5,
        soft_cfm: 1e-3,
        ..base
    };
    let rolling = Surface { mode: base.mode | SurfaceMode::ROLLING, rho: 0.05, ..base };
    type SetUp = fn(&mut SphereCase) -> Result<(), Error>;
    let nothing: SetUp = |_| Ok(());
    let falling: SetUp =
        |c| c.world.body_mut(c.body).and_then(|b| b.set_linear_velocity(Vec3::new(1.0, 0.0, -3.0)));
    let slow: SetUp = |c| c.world.set_contact_max_correcting_velocity(0.1);
    let layer: SetUp = |c| c.world.set_contact_surface_layer(0.004);
    let cases: [(&str, &[Stepper], Surface, SetUp); 9] = [
        ("C0", &quick, base, nothing),
        ("C1", &quick, constant(f64::INFINITY), nothing),
        ("C2", &quick, base.with_bounce(0.6, 0.1), falling),
        ("C3", &quick, soft, nothing),
        ("C4", &quick, moving, nothing),
        ("C5", &quick, rolling, nothing),
        ("C6", &direct, base, slow),
        ("C7", &direct, base, layer),
        ("C8", &direct, constant(0.5), nothing),
    ];
    for (case, steppers, surface, set_up) in cases {
        for stepper in steppers {
            let mut sphere = SphereCase::new()?;
            set_up(&mut sphere)?;
            replay(case, *stepper, 1e-12, |_| sphere.step(*stepper, surface, Vec3::Y, false))?;
        }
    }
    Ok(())
}

#[test]
fn a_reversed_contact_is_the_same_contact() -> Result<(), Error> {
    // C9: normal and friction direction turned round, attached as (world, body): equal to C0 in all digits.
    let surface = Surface { mode: SurfaceMode::APPROX1 | SurfaceMode::FDIR1, mu: 0.5, ..Surface::default() };
    let mut sphere = SphereCase::new()?;
    replay("C0", Stepper::Direct, 1e-12, |_| sphere.step(Stepper::Direct, surface, Vec3::X, true))?;
    Ok(())
}

#[test]
fn a_box_on_four_contacts() -> Result<(), Error> {
    let cases = [
        ("D5", 1e-5, Stepper::Direct, 1e-12),
        // Four contacts are redundant and this CFM hardly regularises them.
        ("D10", 1e-10, Stepper::Direct, 1e-10),
        ("D10", 1e-10, Stepper::Quick, 1e-12),
        ("D5", 1e-5, Stepper::Quick, 1e-12),
    ];
    for (case, cfm, stepper, tolerance) in cases {
        let mut world = World::new();
        world.set_gravity(Vec3::new(0.0, 0.0, -9.81))?;
        world.set_cfm(cfm)?;
        let key = world.create_body();
        let body = world.body_mut(key)?;
        body.set_mass(&Mass::cuboid_total(1.0, Vec3::splat(1.0))?)?;
        body.set_position(Vec3::new(0.0, 0.0, 0.495))?;
        body.set_linear_velocity(Vec3::new(0.3, 0.1, 0.0))?;
        body.set_angular_velocity(Vec3::new(0.0, 0.0, 0.5))?;
        let group = world.create_group();
        replay(case, stepper, tolerance, |_| {
            for (x, y) in [(0.5, 0.5), (0.5, -0.5), (-0.5, 0.5), (-0.5, -0.5)] {
                let position = world.body(key)?.relative_point_position(Vec3::new(x, y, -0.5));
                let point = ContactPoint { position, normal: Vec3::Z, depth: -position.z };
                let joint =
                    world.create_contact(Some(group), &Contact::at(point, Surface::with_friction(0.4)))?;
                world.attach(joint, Some(key), None)?;
            }
            world.step(stepper, H)?;
            world.empty_group(group)?;
            let mut state = State::new();
            body_state(&mut state, &world, key, "-")?;
            state.insert(("-".into(), "seed".into()), vec![f64::from(world.random().seed())]);
            Ok(state)
        })?;
    }
    Ok(())
}

#[test]
fn two_spheres_with_a_ball_joint_and_a_contact() -> Result<(), Error> {
    for stepper in [Stepper::Direct, Stepper::Quick] {
        let mut world = World::new();
        world.set_gravity(Vec3::new(0.0, 0.0, -9.81))?;
        let (a, b) = (world.create_body(), world.create_body());
        let body = world.body_mut(a)?;
        body.set_mass(&Mass::sphere_total(1.0, 0.5)?)?;
        body.set_position(Vec3::new(0.0, 0.0, 0.49))?;
        body.set_linear_velocity(Vec3::new(0.5, 0.0, 0.0))?;
        let body = world.body_mut(b)?;
        body.set_mass(&Mass::sphere_total(2.0, 0.5)?)?;
        body.set_position(Vec3::new(0.0, 0.3, 1.4))?;
        body.set_angular_velocity(Vec3::new(0.1, 0.2, 0.3))?;
        let ball = world.create_joint::<Ball>(None)?;
        world.attach(ball, Some(a), Some(b))?;
        world.joint_mut::<Ball>(ball)?.set_anchor(Vec3::new(0.0, 0.1, 0.95))?;
        world.set_joint_feedback(ball, true)?;
        let group = world.create_group();
        replay("E", stepper, 1e-12, |_| {
            let p = world.body(a)?.position();
            let point =
                ContactPoint { position: Vec3::new(p.x, p.y, 0.0), normal: Vec3::Z, depth: 0.5 - p.z };
            let joint =
                world.create_contact(Some(group), &Contact::at(point, Surface::with_friction(0.5)))?;
            world.attach(joint, Some(a), None)?;
            world.set_joint_feedback(joint, true)?;
            world.step(stepper, H)?;
            let mut state = State::new();
            body_state(&mut state, &world, a, "a")?;
            body_state(&mut state, &world, b, "b")?;
            feedback_state(&mut state, &world, ball, "b", "")?;
            feedback_state(&mut state, &world, joint, "b", "'")?;
            state.insert(("b".into(), "seed".into()), vec![f64::from(world.random().seed())]);
            world.empty_group(group)?;
            Ok(state)
        })?;
    }
    Ok(())
}
