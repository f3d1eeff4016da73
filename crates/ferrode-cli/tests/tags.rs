//! What each physics, surface and joint tag does, on the small worlds of `worlds/tags`, against what it should do by
//! the textbook. Each world holds things that differ in one tag.

mod common;

use common::{Table, recorded, scratch, world};

/// `worlds/tags/NAME.sdf`, with parts replaced, run with options.
fn run(name: &str, case: &str, edits: &[(&str, &str)], options: &[&str]) -> (Table, serde_json::Value) {
    let mut text = std::fs::read_to_string(world(&format!("tags/{name}.sdf"))).unwrap();
    for (from, to) in edits {
        assert!(text.contains(from), "{name}.sdf has no {from}");
        text = text.replace(from, to);
    }
    let file = scratch(&format!("tag_{name}_{case}.sdf"));
    std::fs::write(&file, text).unwrap();
    recorded(file.to_str().unwrap(), &format!("tag_{name}_{case}.csv"), options)
}

#[track_caller]
fn close(found: f64, expected: f64, tolerance: f64) {
    assert!((found - expected).abs() <= tolerance, "{found}, expected {expected} ± {tolerance}");
}

/// Gravity pulls 3 m/s² along x and 8 m/s² down.
#[test]
fn friction_tags() {
    for stepper in ["quick", "direct"] {
        friction_with(stepper);
    }
}

fn friction_with(stepper: &str) {
    let (table, summary) = run("friction", stepper, &[], &["--time", "1", "--stepper", stepper]);
    assert_eq!(summary["solver_failures"], 0, "{stepper}");
    let v = |model: &str| table.last(&format!("link.{model}::body.vx[m/s]"));
    // Coulomb: a = gx − μ gz, or no motion.
    close(v("default"), 0.0, 1e-6);
    close(v("smooth"), 3.0 - 0.2 * 8.0, 0.01);
    close(v("rough"), 0.0, 1e-6);
    // Along fdir1 it is mu that counts, across it mu2.
    close(v("skate_along"), 3.0, 0.01);
    close(v("skate_across"), 0.0, 1e-6);
    // Slip gives way by slip · force. The pull of 2 · 3 N is shared by four corners.
    close(v("slip1_along"), 0.2 * 6.0 / 4.0, 0.003);
    close(v("slip2_along"), 0.1 * 6.0 / 4.0, 0.003);
    close(v("slip1_across"), 0.0, 1e-6);
    // mu is a limit for either surface: a smooth floor makes everything slide.
    let floor = (
        "</plane></geometry></collision>",
        "</plane></geometry><surface><friction><ode><mu>0.1</mu><mu2>0.1</mu2></ode></friction></surface></collision>",
    );
    let (table, _) = run("friction", "smooth_floor", &[floor], &["--time", "1"]);
    close(table.last("link.default::body.vx[m/s]"), 3.0 - 0.1 * 8.0, 0.01);
}

/// Gravity pulls 1 m/s² along x and 9 m/s² down.
#[test]
fn rolling_friction() {
    let (table, _) = run("rolling", "as_is", &[], &["--time", "1"]);
    let v = |model: &str| table.last(&format!("link.{model}::body.vx[m/s]"));
    // A ball that rolls: a (1 + I / m r²) = gx − ρ gz / r, with I = 0.4 m r².
    close(v("free"), 1.0 / 1.4, 0.01);
    close(v("braked"), (1.0 - 0.005 * 9.0 / 0.1) / 1.4, 0.01);
    close(v("held"), 0.0, 1e-4);
    // And they do roll.
    close(table.last("link.free::body.wy[rad/s]"), v("free") / 0.1, 0.1);
}

/// A motor of 0.2 N m turns balls that press 30 N on the floor.
#[test]
fn torsional_friction() {
    let (table, _) = run("torsion", "as_is", &[], &["--time", "1"]);
    let w = |model: &str| table.last(&format!("link.{model}::ball.wz[rad/s]"));
    // Up to 3π/16 · coefficient · patch radius · force: the sheet of the SDF specification.
    let torque =
        |coefficient: f64, patch: f64| 3.0 * std::f64::consts::PI / 16.0 * coefficient * patch * 30.0;
    close(w("none"), 0.2 / 0.008, 0.05);
    close(w("some"), (0.2 - torque(1.0, 0.005)) / 0.008, 0.2);
    close(w("more"), (0.2 - torque(1.0, 0.008)) / 0.008, 0.2);
    close(w("held"), 0.0, 1e-3);
}

/// Balls fall 1 m at 10 m/s².
#[test]
fn bounce_tags() {
    let (table, _) = run("bounce", "as_is", &[], &["--time", "1.3"]);
    let z = |model: &str| table.column(&format!("link.{model}::body.z[m]"));
    // Highest after the first touch, at 0.447 s.
    let rebound = |model: &str| z(model)[460..].iter().fold(0.0_f64, |top, z| top.max(z - 0.1));
    close(rebound("dead"), 0.0, 1e-3);
    close(rebound("half"), 0.25, 0.01);
    close(rebound("lively"), 0.81, 0.02);
    close(rebound("below_threshold"), 0.0, 1e-3);
}

/// Balls press 20 N on the floor.
#[test]
fn softness_tags() {
    let (table, _) = run("softness", "as_is", &[], &["--time", "3"]);
    let depth = |model: &str| 0.1 - table.last(&format!("link.{model}::body.z[m]"));
    close(depth("hard"), 0.0, 1e-5);
    // F = kp · depth.
    close(depth("spring"), 20.0 / 2000.0, 1e-5);
    close(depth("soft_spring"), 20.0 / 1000.0, 1e-5);
    // The constraint's own law at rest: ERP/h · depth = CFM · F.
    close(depth("soft_cfm"), 0.02 * 20.0 * 0.001 / 0.2, 1e-6);
    close(depth("soft_erp"), 0.02 * 20.0 * 0.001 / 0.4, 1e-6);
    // Less kd, more swing: 1 N s/m on 2 kg and 2000 N/m is 1 % of critical, 200 N s/m is beyond it.
    let deepest = |model: &str| {
        table.column(&format!("link.{model}::body.z[m]")).iter().fold(0.0_f64, |deep, z| deep.max(0.1 - z))
    };
    assert!(deepest("undamped") > 1.8 * 0.01, "{}", deepest("undamped"));
    close(deepest("spring"), 0.01, 1e-4);
}

#[test]
fn correction_tags() {
    let (table, _) = run("correction", "as_is", &[], &["--time", "1"]);
    let z = |model: &str| table.last(&format!("link.{model}::body.z[m]"));
    // What is deeper than the layer comes out as far as the layer; what is not stays where it is.
    close(z("resting"), 0.1, 1e-5);
    close(z("sunk"), 0.1 - 0.002, 1e-4);
    // And it comes out no faster than it may.
    let fastest = |table: &Table| table.column("link.sunk::body.vz[m/s]").into_iter().fold(0.0, f64::max);
    close(fastest(&table), 0.1, 1e-6);
    let (table, _) = run("correction", "fast", &[("_vel>0.1<", "_vel>0.5<")], &["--time", "1"]);
    close(fastest(&table), 0.5, 1e-6);
    let (table, _) = run("correction", "deep", &[("_layer>0.002<", "_layer>0.005<")], &["--time", "1"]);
    close(table.last("link.sunk::body.z[m]"), 0.1 - 0.005, 1e-4);
}

#[test]
fn filter_tags() {
    let (table, _) = run("filter", "as_is", &[], &["--time", "1"]);
    let stands = |model: &str| table.last(&format!("link.{model}::body.z[m]")) > 0.0;
    assert!(stands("default") && stands("both_bits") && stands("is_what_the_floor_wants"));
    assert!(!stands("other_bit") && !stands("ghost"));
}

/// Masses of 2 kg on upright rails, 20 N down.
#[test]
fn axis_tags() {
    let (table, _) = run("rails", "as_is", &[], &["--time", "2"]);
    let z = |model: &str| table.last(&format!("joint.{model}::rail.position[m]"));
    let v = |model: &str| table.last(&format!("joint.{model}::rail.velocity[m/s]"));
    close(v("free"), -20.0, 0.01);
    // Terminal speed m g / c.
    close(v("damping"), -20.0 / 20.0, 1e-3);
    close(v("friction"), -(20.0 - 5.0) / 2.0 * 2.0, 0.02);
    close(z("stuck"), 0.0, 1e-5);
    close(z("spring"), 0.1 - 20.0 / 100.0, 1e-3);
    // A stop's stiffness is 1e8 N/m unless said otherwise.
    close(z("stop"), -0.2, 1e-4);
    close(z("soft_stop"), -0.2 - 20.0 / 1000.0, 1e-4);
    close(z("ode_stop"), -0.2 - 0.001 * 20.0 * 0.001 / 0.2, 1e-7);
    // Lifted at its speed while it is strong enough; else it only slows the fall.
    close(v("motor"), 0.3, 1e-4);
    close(v("weak_motor"), -(20.0 - 15.0) / 2.0 * 2.0, 0.02);
    // A rebound rises by bounce² of the fall, and falls 0.2 m in 0.2 s.
    let path = table.column("joint.bouncy_stop::rail.position[m]");
    let top = path[210..].iter().fold(-1.0_f64, |top, z| top.max(*z));
    close(top, -0.2 + 0.25 * 0.2, 0.003);
}

/// A motor that drives away from its stop starts with the fudged part of its force.
#[test]
fn fudge_factor() {
    let (table, _) = run("rails", "fudge", &[], &["--steps", "1"]);
    let v = |model: &str| table.last(&format!("joint.{model}::rail.velocity[m/s]"));
    // (60 − 20) N on 2 kg for 1 ms; a tenth of the force does not lift the mass.
    close(v("full_push"), 0.02, 1e-9);
    close(v("fudged_push"), 0.0, 1e-6);
}

#[test]
fn the_solver_that_the_file_names() {
    let (_, quick) = run("solver", "quick", &[], &["--time", "1"]);
    let (_, world) = run("solver", "world", &[("<type>quick<", "<type>world<")], &["--time", "1"]);
    assert_eq!((quick["stepper"].as_str(), world["stepper"].as_str()), (Some("quick"), Some("direct")));
    let error = |run: &serde_json::Value| run["joint_error_max_m"].as_f64().unwrap();
    // A hundred times the weight at the end of a chain: the exact solver hardly stretches it.
    assert!(error(&world) < 1e-6, "{}", error(&world));
    assert!(error(&quick) > 1e3 * error(&world), "{}", error(&quick));
    // The command line has the last word.
    let (_, forced) = run("solver", "forced", &[], &["--steps", "1", "--stepper", "direct"]);
    assert_eq!(forced["stepper"], "direct");
}

#[test]
fn iterations_and_over_relaxation() {
    let stretch = |case: &str, edits: &[(&str, &str)]| {
        run("solver", case, edits, &["--time", "1"]).1["joint_error_max_m"].as_f64().unwrap()
    };
    let few = stretch("few", &[("<iters>50<", "<iters>10<")]);
    let as_is = stretch("as_is", &[]);
    let many = stretch("many", &[("<iters>50<", "<iters>400<")]);
    assert!(few > 2.0 * as_is && as_is > 2.0 * many, "{few} {as_is} {many}");
    // Over-relaxation carries forces along a chain faster, under-relaxation slower.
    let under = stretch("under", &[("<sor>1.3<", "<sor>0.7<")]);
    assert!(under > 1.3 * as_is, "{under} {as_is}");
}

#[test]
fn softness_of_the_world() {
    let sag = |case: &str, edits: &[(&str, &str)]| {
        let mut all = vec![("<type>quick<", "<type>world<")];
        all.extend(edits);
        let (table, _) = run("solver", case, &all, &["--time", "2"]);
        3.0 - 0.9 - table.last("link.chain::link_5.z[m]")
    };
    // Each joint gives way until ERP/h · gap = CFM · F; they carry 1040, 1030, 1020, 1010 and 1000 N.
    let expected = |cfm: f64, erp: f64| cfm * 5100.0 * 0.002 / erp;
    close(sag("hard", &[]), 0.0, 1e-6);
    close(sag("cfm", &[("<cfm>0<", "<cfm>1e-4<")]), expected(1e-4, 0.2), 1e-5);
    close(
        sag("cfm_erp", &[("<cfm>0<", "<cfm>1e-4<"), ("<erp>0.2<", "<erp>0.6<")]),
        expected(1e-4, 0.6),
        1e-5,
    );
}

#[test]
fn steps_contacts_and_gravity() {
    let (_, as_is) = run("solver", "steps", &[], &["--time", "1"]);
    assert_eq!((as_is["steps"].as_u64(), as_is["step_size_s"].as_f64()), (Some(500), Some(0.002)));
    assert_eq!(as_is["contacts_max"], 4);
    let edits =
        [("<max_step_size>0.002<", "<max_step_size>0.004<"), ("<max_contacts>20<", "<max_contacts>1<")];
    let (_, other) = run("solver", "other_steps", &edits, &["--time", "1"]);
    assert_eq!((other["steps"].as_u64(), other["step_size_s"].as_f64()), (Some(250), Some(0.004)));
    assert_eq!(other["contacts_max"], 1);
    let (_, finer) = run("solver", "finer_steps", &[], &["--time", "1", "--dt", "0.001"]);
    assert_eq!(finer["steps"], 1000);
    let (table, _) =
        run("bounce", "no_gravity", &[("0 0 -10</gravity>", "0 0 0</gravity>")], &["--time", "0.5"]);
    close(table.last("link.dead::body.z[m]"), 1.1, 1e-12);
}

/// Tags that the engine cannot follow are told of, never passed over in silence.
#[test]
fn tags_act_or_are_warned_of() {
    let physics = [
        ("cone", "<sor>1.3</sor>", "<sor>1.3</sor><friction_model>cone_model</friction_model>"),
        ("box_model", "<sor>1.3</sor>", "<sor>1.3</sor><friction_model>box_model</friction_model>"),
        ("precon", "<sor>1.3</sor>", "<sor>1.3</sor><precon_iters>10</precon_iters>"),
        (
            "rescaling",
            "<sor>1.3</sor>",
            "<sor>1.3</sor><use_dynamic_moi_rescaling>1</use_dynamic_moi_rescaling>",
        ),
    ];
    let (as_is, plain) = run("solver", "plain", &[], &["--time", "0.5"]);
    assert_eq!(plain["warnings"], 0);
    for (case, from, to) in physics {
        let (table, summary) = run("solver", case, &[(from, to)], &["--time", "0.5"]);
        assert!(table != as_is || summary["warnings"] == 1, "{case}: {summary}");
    }
}

/// `<min_depth>` leaves a contact at a depth, `<max_vel>` caps what pushes it out.
#[test]
fn contacts_are_corrected_as_their_surfaces_say() {
    let spring = "<kp>2000</kp><kd>200</kd>";
    let height = |case: &str, tag: &str, time: &str| {
        let to = format!("{spring}{tag}");
        let (table, summary) = run("softness", case, &[(spring, &to)], &["--time", time]);
        assert_eq!(summary["warnings"], 0, "{case}");
        table.last("link.spring::body.z[m]")
    };
    // 20 N on 2000 N/m: 10 mm deep, beyond the depth that is left.
    close(height("no_min_depth", "", "2"), 0.1 - 0.01, 1e-5);
    close(height("min_depth", "<min_depth>0.003</min_depth>", "2"), 0.1 - 0.013, 1e-5);
    // The contact gives (h kp + kd)(c - v), with c capped at 0.05 m/s: too little for 20 N, so the ball sinks at a
    // steady v = 0.05 - 20 / (0.001 * 2000 + 200).
    let tag = "<max_vel>0.05</max_vel>";
    let rate = (height("max_vel_later", tag, "1.5") - height("max_vel", tag, "1")) / 0.5;
    close(rate, 0.05 - 20.0 / 202.0, 1e-4);
}
