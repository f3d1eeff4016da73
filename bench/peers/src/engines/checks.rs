//! Whether every driver builds the scene that it is given: small scenes whose outcome follows from mechanics, with the room
//! that soft and iterated solvers take.

use super::parts::mass;
use crate::engine::Choice;
use crate::scene::{Form, Joint, Link, STEP, Scene, Solid};
use ferrode_math::{Pose, Quat, Vec3, real};
use std::sync::{Mutex, PoisonError};

/// What went wrong, in all engines.
#[derive(Default)]
struct Faults(Vec<String>);

impl Faults {
    /// Notes an engine whose value is not in the range.
    fn expect(&mut self, choice: &Choice, what: &str, value: f64, range: core::ops::RangeInclusive<f64>) {
        if !range.contains(&value) {
            self.0.push(format!("{}: {what} {value}, not in {range:?}", choice.name));
        }
    }
}

impl Drop for Faults {
    fn drop(&mut self) {
        assert!(self.0.is_empty() || std::thread::panicking(), "\n{}", self.0.join("\n"));
    }
}

fn about(value: f64, room: f64) -> core::ops::RangeInclusive<f64> {
    value - room..=value + room
}

/// Engines that can run here.
fn all() -> Vec<Choice> {
    let mut all = super::all();
    all.retain(|choice| {
        let why = (choice.refuses)(&scene(0.0));
        why.iter().for_each(|why| eprintln!("SKIPPED: {}: {why}", choice.name));
        why.is_none()
    });
    all
}

fn scene(gravity: f64) -> Scene {
    Scene {
        name: "check".into(),
        steps: 0,
        first: 0,
        friction: 0.6,
        gravity,
        sleeping: false,
        solids: Vec::new(),
        joints: Vec::new(),
    }
}

/// Poses after each step.
fn run(choice: &Choice, scene: &Scene, steps: usize) -> Vec<Vec<Pose>> {
    // Some libraries allow worlds to be made on one thread only.
    static ALONE: Mutex<()> = Mutex::new(());
    let _alone = ALONE.lock().unwrap_or_else(PoisonError::into_inner);
    let mut engine = (choice.build)(scene, 1);
    let mut step = |_| {
        engine.step();
        let mut poses = Vec::new();
        engine.poses(&mut poses);
        assert_eq!(poses.len(), scene.solids.len());
        poses
    };
    (0..steps).map(&mut step).collect()
}

fn last(choice: &Choice, scene: &Scene, steps: usize) -> Vec<Pose> {
    run(choice, scene, steps).pop().unwrap_or_default()
}

fn hinge(axis: Vec3, stops: Option<(f64, f64)>, brake: Option<f64>) -> Joint {
    Joint { a: 0, b: None, anchor: Vec3::ZERO, link: Link::Hinge { axis, stops, brake } }
}

const LONG: Vec3 = Vec3::new(1.0, 0.1, 0.1);

/// A bar of one kilogram that points along x from the hinge, and falls about y.
fn bar(joint: Joint) -> Scene {
    let mut scene = scene(9.81);
    scene.add(Form::Cuboid(LONG), Vec3::X * 0.5, Some(100.0));
    scene.joints.push(joint);
    scene
}

/// How far a solid has turned about y.
fn turned(pose: &Pose) -> f64 {
    let x = pose.transform_vector(Vec3::X);
    real::atan2(-x.z, x.x)
}

#[test]
fn a_falling_bar_comes_to_the_stop_of_its_side() {
    let mut faults = Faults::default();
    for choice in all() {
        for (axis, stop) in [(Vec3::Y, 0.5), (-Vec3::Y, 0.3)] {
            for fixed in [false, true] {
                let mut scene = bar(hinge(axis, Some((-0.3, 0.5)), None));
                if fixed {
                    scene.joints[0].b = Some(scene.add(Form::Cuboid(LONG), Vec3::X * -1.5, None));
                }
                let angle = turned(&last(&choice, &scene, 180)[0]);
                faults.expect(&choice, "angle", angle, about(stop, 0.05));
            }
        }
    }
}

#[test]
fn two_bars_turn_against_each_other_up_to_a_stop() {
    let mut faults = Faults::default();
    for choice in all() {
        for (way, stop) in [(1.0, 0.8), (-1.0, 0.4)] {
            let mut scene = scene(0.0);
            let a = scene.add(Form::Cuboid(LONG), Vec3::X * 0.5, Some(100.0));
            let b = scene.add(Form::Cuboid(LONG), Vec3::X * -0.5, Some(10_000.0));
            scene.solids[a].velocity = Vec3::Y * way;
            scene.joints.push(Joint { b: Some(b), ..hinge(Vec3::Z, Some((-0.4, 0.8)), None) });
            let mut widest: f64 = 0.0;
            for poses in run(&choice, &scene, 120) {
                let (x, y) = (poses[a].transform_vector(Vec3::X), poses[b].transform_vector(Vec3::X));
                widest = widest.max(way * real::atan2(y.cross(x).z, x.dot(y)));
            }
            faults.expect(&choice, "widest angle", widest, about(stop, 0.08));
        }
    }
}

#[test]
fn a_brake_holds_up_to_its_torque() {
    let mut faults = Faults::default();
    for choice in all() {
        // The bar's weight turns it with 4.9 N m. Some brakes creep; without one it falls by 1.8 in that time.
        let angle = |brake: f64| turned(&last(&choice, &bar(hinge(Vec3::Y, None, Some(brake))), 60)[0]);
        let (held, slipped) = (angle(10.0), angle(2.0));
        faults.expect(&choice, "angle of a strong brake", held, about(0.0, 0.2));
        faults.expect(&choice, "angle of a weak brake", slipped, 0.5..=3.0);
    }
}

fn forms() -> [Form; 4] {
    [
        Form::Cuboid(Vec3::new(0.6, 0.4, 0.3)),
        Form::Sphere(0.25),
        Form::Capsule(0.15, 0.6),
        Form::Cylinder(0.2, 0.7),
    ]
}

#[test]
fn two_solids_share_momentum_by_their_masses() {
    let mut faults = Faults::default();
    for choice in all() {
        for form in forms() {
            let mut scene = scene(0.0);
            let a = scene.add(form.clone(), Vec3::X, Some(1000.0));
            let b = scene.add(Form::Cuboid(Vec3::splat(0.4)), -Vec3::X, Some(1000.0));
            scene.solids[a].velocity = Vec3::Y;
            scene.joints.push(Joint { a, b: Some(b), anchor: Vec3::ZERO, link: Link::Ball });
            let poses = last(&choice, &scene, 60);
            let (m, n) = (mass(&scene.solids[a]).0, mass(&scene.solids[b]).0);
            let middle = (poses[a].position.y * m + poses[b].position.y * n) / (m + n);
            let expected = 60.0 * STEP * m / (m + n);
            faults.expect(&choice, &format!("{form:?}, path"), middle, about(expected, 0.02));
            let apart = (poses[a].transform_point(-Vec3::X) - poses[b].transform_point(Vec3::X)).length();
            faults.expect(&choice, &format!("{form:?}, anchors"), apart, 0.0..=0.05);
        }
    }
}

#[test]
fn a_pendulum_falls_by_its_moment_of_inertia() {
    const ARM: f64 = 0.2;
    let mut faults = Faults::default();
    for choice in all() {
        for form in forms() {
            let mut scene = scene(9.81);
            let at = Vec3::X * ARM;
            scene.add(form.clone(), at, Some(1000.0));
            // Its z axis lies along x.
            scene.solids[0].pose =
                Pose::new(at, Quat::from_axis_angle(Vec3::Y, core::f64::consts::FRAC_PI_2));
            scene.joints.push(hinge(Vec3::Y, None, None));
            let z = last(&choice, &scene, 20)[0].transform_vector(Vec3::Z);
            let angle = real::atan2(-z.z, z.x);
            let (m, inertia) = mass(&scene.solids[0]);
            let fall = |parts: u32| {
                let (mut angle, mut speed, step) = (0.0, 0.0, STEP / f64::from(parts));
                for _ in 0..20 * parts {
                    speed += step * m * 9.81 * ARM * real::cos(angle) / (inertia.y + m * ARM * ARM);
                    angle += step * speed;
                }
                angle
            };
            // Between what follows from very short steps and from the scene's.
            let range = fall(100) - 0.02..=fall(1) + 0.02;
            faults.expect(&choice, &format!("{form:?}, angle"), angle, range);
        }
    }
}

fn ground(scene: &mut Scene) {
    scene.add(Form::Cuboid(Vec3::new(20.0, 20.0, 2.0)), -Vec3::Z, None);
}

#[test]
fn ghosts_pass_through_ghosts_alone() {
    let mut faults = Faults::default();
    for choice in all() {
        for (low, high, rest) in
            [(true, true, 0.5), (true, false, 1.5), (false, true, 1.5), (false, false, 1.5)]
        {
            let mut scene = scene(9.81);
            ground(&mut scene);
            for (ghost, height) in [(low, 0.5), (high, 1.5)] {
                let i = scene.add(Form::Cuboid(Vec3::splat(1.0)), Vec3::Z * height, Some(1000.0));
                scene.solids[i].ghost = ghost;
            }
            let z = last(&choice, &scene, 90)[2].position.z;
            faults.expect(&choice, "height", z, about(rest, 0.05));
        }
    }
}

#[test]
fn a_loop_of_bars_stays_closed() {
    let mut faults = Faults::default();
    for choice in all() {
        for hinged in [false, true] {
            let mut scene = scene(9.81);
            let corners = [Vec3::ZERO, Vec3::X, Vec3::new(1.0, 0.0, -1.0), -Vec3::Z];
            for i in 0..4 {
                let (from, to) = (corners[i], corners[(i + 1) % 4]);
                let sides = (to - from).abs() * 0.9 + Vec3::splat(0.05);
                scene.add(Form::Cuboid(sides), (from + to) * 0.5, Some(1000.0));
            }
            let link =
                if hinged { Link::Hinge { axis: Vec3::Y, stops: None, brake: None } } else { Link::Ball };
            scene.joints.push(Joint { a: 0, b: None, anchor: Vec3::ZERO, link });
            for (i, anchor) in corners.into_iter().enumerate() {
                scene.joints.push(Joint { a: i, b: Some((i + 3) % 4), anchor, link });
            }
            let poses = last(&choice, &scene, 60);
            for joint in &scene.joints {
                let on = |i: usize| {
                    poses[i].transform_point(scene.solids[i].pose.inverse_transform_point(joint.anchor))
                };
                let gap = (on(joint.a) - joint.b.map_or(joint.anchor, on)).length();
                faults.expect(&choice, "anchors", gap, 0.0..=0.05);
            }
        }
    }
}

#[test]
fn joined_solids_do_not_push_each_other() {
    let mut faults = Faults::default();
    for choice in all() {
        for link in [Link::Ball, Link::Hinge { axis: Vec3::Y, stops: None, brake: None }] {
            let mut scene = scene(0.0);
            let a = scene.add(Form::Cuboid(Vec3::splat(1.0)), Vec3::new(0.3, 0.1, 0.2), Some(1000.0));
            let b = scene.add(Form::Cuboid(Vec3::splat(1.0)), -Vec3::X * 0.3, Some(1000.0));
            scene.joints.push(Joint { a, b: Some(b), anchor: Vec3::Z, link });
            for (pose, solid) in last(&choice, &scene, 60).iter().zip(&scene.solids) {
                let moved = (pose.position - solid.pose.position).length();
                faults.expect(&choice, &format!("{link:?}, path"), moved, 0.0..=1e-3);
            }
        }
    }
}

#[test]
fn friction_holds_on_slopes_up_to_its_coefficient() {
    let mut faults = Faults::default();
    for choice in all() {
        for (slope, expected) in [(0.45, 0.0), (0.785, 1.39)] {
            let mut scene = scene(9.81);
            let turn = Quat::from_axis_angle(Vec3::Y, slope);
            for (form, height, density) in [
                (Form::Cuboid(Vec3::new(20.0, 20.0, 2.0)), -1.0, None),
                (Form::Cuboid(Vec3::new(1.0, 1.0, 0.5)), 0.25, Some(1000.0)),
            ] {
                let at = turn.rotate(Vec3::Z * height);
                let i = scene.add(form, at, density);
                scene.solids[i].pose = Pose::new(at, turn);
            }
            let moved = (last(&choice, &scene, 60)[1].position - scene.solids[1].pose.position).length();
            faults.expect(&choice, &format!("slope {slope}, path"), moved, about(expected, 0.15));
        }
    }
}

#[test]
fn all_forms_rest_on_a_mesh() {
    let mut faults = Faults::default();
    for choice in all() {
        for (form, rest) in forms().into_iter().zip([0.15, 0.25, 0.45, 0.35]) {
            let mut scene = scene(9.81);
            // Squares as large as those of the scenes.
            let corner = |i: u32| Vec3::new(f64::from(i % 9) - 4.0, f64::from(i / 9) - 4.0, 0.0);
            let square = |i: u32| (i % 9 < 8).then_some([[i, i + 1, i + 10], [i, i + 10, i + 9]]);
            let triangles = (0..72).filter_map(square).flatten().collect();
            scene.add(Form::Mesh((0..81).map(corner).collect(), triangles), Vec3::ZERO, None);
            scene.add(form.clone(), Vec3::new(0.4, 0.7, rest + 0.05), Some(1000.0));
            // A capsule on its end may topple later.
            let z = last(&choice, &scene, 40)[1].position.z;
            faults.expect(&choice, &format!("{form:?}, height"), z, about(rest, 0.06));
        }
    }
}

#[test]
fn nothing_slows_a_free_solid() {
    let mut faults = Faults::default();
    for choice in all() {
        let mut scene = scene(0.0);
        scene.add(Form::Sphere(0.5), Vec3::ZERO, Some(1000.0));
        scene.solids[0].velocity = Vec3::new(3.0, -4.0, 0.0);
        let p = last(&choice, &scene, 300)[0].position;
        let off = (p - Vec3::new(15.0, -20.0, 0.0)).length();
        faults.expect(&choice, "off its way by", off, 0.0..=0.01);
    }
}

/// Solids are listed in the scene's order.
#[test]
fn poses_come_in_the_order_of_the_scene() {
    let mut faults = Faults::default();
    for choice in all() {
        let mut scene = scene(0.0);
        for i in 0..40 {
            let density = (i % 3 != 0).then_some(1000.0);
            scene.add(Form::Sphere(0.1), Vec3::new(f64::from(i), 0.5, -0.25), density);
        }
        let poses = last(&choice, &scene, 1);
        let far = |(pose, solid): (&Pose, &Solid)| (pose.position - solid.pose.position).length();
        let worst = poses.iter().zip(&scene.solids).map(far).fold(0.0, f64::max);
        faults.expect(&choice, "off its place by", worst, 0.0..=1e-5);
    }
}
