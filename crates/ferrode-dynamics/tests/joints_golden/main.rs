//! Replays what libode 0.16.2 did with every joint type: setters, getters, parameters, five steps of `Direct`, forces.
//!
//! `tests/data/joints_golden.json` holds the recorded figures, without what repeats; see the README there. If the
//! variable FERRODE_SPEC names a folder with the full recording of the same name, that is replayed as well.

mod calls;
mod data;

use data::{Case, Golden, State};
use ferrode_dynamics::{BodyKey, Contact, JointKey, Mass, Stepper, Surface, SurfaceMode, World};
use ferrode_math::{ContactPoint, Mat3, Quat, Vec3};
use std::collections::BTreeMap;

/// Steps: sums in another order differ in the last bits, and an ill-conditioned solve magnifies that.
const DYNAMIC: f64 = 1e-9;
/// Functions of a given pose.
const PROBE: f64 = 1e-12;

#[test]
fn joints_do_as_recorded() {
    replay(&data::read(include_str!("../data/joints_golden.json")));
}

#[test]
fn joints_do_as_in_the_full_recording() {
    let Some(folder) = std::env::var_os("FERRODE_SPEC") else {
        eprintln!("skipped: FERRODE_SPEC names no folder with the full recording");
        return;
    };
    let path = std::path::Path::new(&folder).join("joints_golden.json");
    let text = std::fs::read_to_string(&path).unwrap_or_else(|e| panic!("{}: {e}", path.display()));
    replay(&data::read(&text));
}

/// What one joint type has come to.
#[derive(Default)]
struct Tally {
    cases: usize,
    figures: usize,
    worst: f64,
    worst_probe: f64,
    /// The case and figure that the worst difference is of.
    place: String,
}

/// Replays all, prints a line per joint type, and fails with all figures that are off.
fn replay(golden: &Golden) {
    let mut tallies: BTreeMap<&str, Tally> = BTreeMap::new();
    let mut faults = Vec::new();
    for case in &golden.cases {
        let tally = tallies.entry(&case.joint).or_default();
        tally.cases += 1;
        Replay { case, tally, faults: &mut faults }.run();
    }
    for table in &golden.params {
        let tally = tallies.entry(&table.joint).or_default();
        replay_params(table, tally, &mut faults);
    }
    println!("{:<13}{:>6}{:>9}{:>11}{:>11}  worst at", "joint", "cases", "figures", "steps", "poses");
    for (joint, t) in &tallies {
        println!(
            "{joint:<13}{:>6}{:>9}{:>11.1e}{:>11.1e}  {}",
            t.cases, t.figures, t.worst, t.worst_probe, t.place
        );
    }
    // A file that lost its cases must not pass.
    assert_eq!(tallies.len(), 17, "joint types in the recording");
    assert_eq!(golden.cases.len(), 184 + 34);
    assert_eq!(golden.params.len(), 14);
    assert!(
        faults.is_empty(),
        "{} figures are off, first:\n{}",
        faults.len(),
        faults[..faults.len().min(20)].join("\n")
    );
}

struct Replay<'a> {
    case: &'a Case,
    tally: &'a mut Tally,
    faults: &'a mut Vec<String>,
}

impl Replay<'_> {
    fn run(&mut self) {
        let case = self.case;
        let mut world = World::new();
        world.set_gravity(Vec3::from_array(case.gravity)).unwrap();
        world.set_erp(case.erp).unwrap();
        world.set_cfm(case.cfm).unwrap();
        let bodies: Vec<BodyKey> = case.bodies.iter().map(|setup| make_body(&mut world, setup)).collect();
        let joint = match case.joint.as_str() {
            "Contact" => world.create_contact(None, &contact(case)),
            name => world.create_joint_of_type(calls::joint_type(name), None),
        }
        .unwrap();
        if let Some(erp) = case.later_erp {
            world.set_erp(erp).unwrap();
        }
        if let Some(cfm) = case.later_cfm {
            world.set_cfm(cfm).unwrap();
        }
        let [first, second] = case.attach.map(|i| i.map(|i| bodies[i]));
        world.attach(joint, first, second).unwrap();
        world.set_joint_feedback(joint, true).unwrap();
        for call in &case.calls {
            self.call(&mut world, joint, call);
        }
        self.compare_answers(&world, joint, "after setup", &case.setup, PROBE);

        for probe in &case.probes {
            for (body, state) in bodies.iter().zip(&probe.bodies) {
                set_state(&mut world, *body, state);
            }
            self.compare_answers(&world, joint, "probe", &probe.answers, PROBE);
        }
        let mut number = 0;
        for step in &case.steps {
            while number < step.number {
                for call in &case.calls_before_each_step {
                    self.call(&mut world, joint, call);
                }
                world.step(Stepper::Direct, case.step_size).unwrap();
                number += 1;
            }
            let at = format!("step {number}");
            for (i, (body, want)) in bodies.iter().zip(&step.bodies).enumerate() {
                self.compare(&format!("{at} body {i}"), &state(&world, *body), want, DYNAMIC);
            }
            let f = *world.joint_feedback(joint).unwrap().expect("feedback is on");
            let have: Vec<f64> =
                [f.force1, f.torque1, f.force2, f.torque2].iter().flat_map(|v| v.to_array()).collect();
            self.compare(&format!("{at} feedback"), &have, &step.feedback, DYNAMIC);
            self.compare_answers(&world, joint, &at, &step.answers, DYNAMIC);
        }
    }

    fn call(&mut self, world: &mut World, joint: JointKey, call: &data::Call) {
        if let Err(error) = calls::call(world, joint, call) {
            self.faults.push(format!("{} {}: {error}", self.case.id, call.function));
        }
    }

    fn compare_answers(
        &mut self,
        world: &World,
        joint: JointKey,
        at: &str,
        want: &[Vec<f64>],
        tolerance: f64,
    ) {
        assert_eq!(self.case.getters.len(), want.len());
        for (getter, want) in self.case.getters.iter().zip(want) {
            match calls::get(world, joint, getter) {
                Ok(have) => self.compare(&format!("{at} {getter}"), &have.0, want, tolerance),
                Err(error) => self.faults.push(format!("{} {at} {getter}: {error}", self.case.id)),
            }
        }
    }

    fn compare(&mut self, what: &str, have: &[f64], want: &[f64], tolerance: f64) {
        assert_eq!(have.len(), want.len(), "{} {what}", self.case.id);
        for (x, y) in have.iter().zip(want) {
            let difference = (x - y).abs() / (1.0 + y.abs());
            let difference = if difference.is_nan() { f64::INFINITY } else { difference };
            self.tally.figures += 1;
            let worst = if tolerance == PROBE { &mut self.tally.worst_probe } else { &mut self.tally.worst };
            if difference > *worst {
                *worst = difference;
                if tolerance != PROBE {
                    self.tally.place = format!("{} {what}", self.case.id);
                }
            }
            if difference > tolerance {
                self.faults.push(format!("{} {what}: {x} instead of {y}", self.case.id));
            }
        }
    }
}

fn make_body(world: &mut World, setup: &data::BodySetup) -> BodyKey {
    let i = setup.inertia;
    let inertia = Mat3::from_rows([[i[0], i[1], i[2]], [i[3], i[4], i[5]], [i[6], i[7], i[8]]]);
    let body = world.create_body();
    let mass = Mass { mass: setup.mass, centre: Vec3::ZERO, inertia };
    world.body_mut(body).unwrap().set_mass(&mass).unwrap();
    set_state(world, body, &setup.state);
    body
}

fn set_state(world: &mut World, body: BodyKey, s: &State) {
    let body = world.body_mut(body).unwrap();
    body.set_position(Vec3::new(s[0], s[1], s[2])).unwrap();
    // The recorded quaternion is normalised already. To normalise it again may change its last bits, and the sign of an
    // angle hangs on these where a body has turned across the axis: find a multiple that comes out as recorded.
    let q = Quat::new(s[3], s[4], s[5], s[6]);
    let exact = (0..1000).any(|i| {
        body.set_quaternion(q.scale(1.0 + 0.01 * i as f64)).unwrap();
        body.quaternion() == q
    });
    assert!(exact, "no multiple of {q:?} is normalised to it");
    body.set_linear_velocity(Vec3::new(s[7], s[8], s[9])).unwrap();
    body.set_angular_velocity(Vec3::new(s[10], s[11], s[12])).unwrap();
}

fn state(world: &World, body: BodyKey) -> Vec<f64> {
    let body = world.body(body).unwrap();
    let mut s = body.position().to_array().to_vec();
    s.extend(body.quaternion().to_array());
    s.extend(body.linear_velocity().to_array());
    s.extend(body.angular_velocity().to_array());
    s
}

fn contact(case: &Case) -> Contact {
    let number = |name: &str| match case.contact[name].as_str() {
        Some("inf") => f64::INFINITY,
        _ => case.contact[name].as_f64().unwrap_or_else(|| panic!("{}: no {name}", case.id)),
    };
    let vector = |name: &str| {
        let v = &case.contact[name];
        Vec3::from_array([0, 1, 2].map(|i| v[i].as_f64().unwrap_or_else(|| panic!("{}: no {name}", case.id))))
    };
    Contact {
        surface: Surface {
            mode: SurfaceMode(number("mode") as u32),
            mu: number("mu"),
            mu2: number("mu2"),
            bounce: number("bounce"),
            bounce_velocity: number("bounce_vel"),
            soft_erp: number("soft_erp"),
            soft_cfm: number("soft_cfm"),
            motion1: number("motion1"),
            slip1: number("slip1"),
            ..Surface::default()
        },
        point: ContactPoint { position: vector("pos"), normal: vector("normal"), depth: number("depth") },
        fdir1: vector("fdir1"),
    }
}

/// Defaults of all 42 parameters of a joint in limbo, then all written, then all read.
fn replay_params(table: &data::ParamTable, tally: &mut Tally, faults: &mut Vec<String>) {
    let mut world = World::new();
    world.set_erp(table.erp).unwrap();
    world.set_cfm(table.cfm).unwrap();
    let joint = world.create_joint_of_type(calls::joint_type(&table.joint), None).unwrap();
    let mut check = |world: &World, what: &str, n: f64, want: f64| {
        let (param, group) = calls::param(n);
        let have = world.joint_param(joint, param, group).unwrap();
        tally.figures += 1;
        if have != want {
            faults.push(format!("{} parameter {n} {what}: {have} instead of {want}", table.joint));
        }
    };
    assert_eq!(table.rows.len(), 42, "{}", table.joint);
    for [n, default, _, _] in &table.rows {
        check(&world, "by default", *n, *default);
    }
    for [n, _, written, _] in &table.rows {
        let (param, group) = calls::param(*n);
        world.set_joint_param(joint, param, group, *written).unwrap();
    }
    for [n, _, _, read] in &table.rows {
        check(&world, "after writing", *n, *read);
    }
}
