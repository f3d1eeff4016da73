//! Worlds built from files move as the files say: against formulas, for both ways round of each joint.

use ferrode::math::real;
use ferrode::{Slider, Vec3};
use ferrode_scene::description::{Body, JointId, LinkId, ModelId};
use ferrode_scene::{BuildOptions, LoadOptions, NamedWorld, Scene, build, load_str};

fn options() -> LoadOptions {
    LoadOptions { use_environment: false, ..LoadOptions::default() }
}

#[track_caller]
fn world(inside: &str) -> NamedWorld {
    let text = format!(
        "<sdf version='1.11'><world name='w'><gravity>0 0 -10</gravity>
         <physics type='ode'><max_step_size>0.01</max_step_size><ode><solver><type>world</type></solver></ode></physics>
         {inside}</world></sdf>"
    );
    let loaded = load_str("test.sdf", &text, &options()).unwrap_or_else(|error| panic!("{error}"));
    assert!(loaded.warnings.is_empty(), "{:?}", loaded.warnings);
    build(&loaded.scene, &BuildOptions::default()).unwrap_or_else(|error| panic!("{error}"))
}

#[track_caller]
fn model(inside: &str) -> NamedWorld {
    world(&format!("<model name='m'>{inside}</model>"))
}

/// A link of 1 kg and unit inertia on one joint about or along `axis`, with these dynamics.
#[track_caller]
fn on_axis(kind: &str, axis: &str, inside_axis: &str) -> NamedWorld {
    model(&format!(
        "<link name='l'/><joint name='j' type='{kind}'><parent>world</parent><child>l</child>
         <axis><xyz>{axis}</xyz>{inside_axis}</axis></joint>"
    ))
}

fn set_velocity(world: &mut NamedWorld, link: &str, linear: Vec3, angular: Vec3) {
    let body = world.link(link).unwrap().body().unwrap();
    let body = world.world.body_mut(body).unwrap();
    body.set_linear_velocity(linear).unwrap();
    body.set_angular_velocity(angular).unwrap();
}

fn steps(world: &mut NamedWorld, count: usize) {
    for _ in 0..count {
        world.step().unwrap();
    }
}

fn speed(world: &NamedWorld) -> f64 {
    world.joint("j").unwrap().velocity(0).unwrap()
}

fn place(world: &NamedWorld) -> f64 {
    world.joint("j").unwrap().position(0).unwrap()
}

const H: f64 = 0.01;

/// How far an axis goes in a step. As in ODE, rotations are integrated as a tangent: a step of h ω turns by 2 atan(h ω / 2).
fn turn(kind: &str, step: f64) -> f64 {
    if kind == "prismatic" { step } else { 2.0 * real::atan(0.5 * step) }
}

/// Both kinds of axis, horizontal for the slider so that gravity does nothing; mass and inertia are 1.
const KINDS: [(&str, &str); 2] = [("revolute", "0 0 1"), ("prismatic", "1 0 0")];

fn push(world: &mut NamedWorld, kind: &str, rate: f64) {
    match kind {
        "revolute" => set_velocity(world, "l", Vec3::ZERO, Vec3::Z * rate),
        _ => set_velocity(world, "l", Vec3::X * rate, Vec3::ZERO),
    }
}

#[test]
fn damping_is_implicit() {
    // v' = v / (1 + h c), also for a damper that would explode if it were explicit (h c = 5).
    for damping in [2.0, 500.0] {
        for (kind, axis) in KINDS {
            let mut world =
                on_axis(kind, axis, &format!("<dynamics><damping>{damping}</damping></dynamics>"));
            assert!(world.warnings.is_empty(), "{:?}", world.warnings);
            push(&mut world, kind, 3.0);
            let mut expected = 3.0;
            for _ in 0..20 {
                world.step().unwrap();
                expected /= 1.0 + H * damping;
                assert!(
                    (speed(&world) - expected).abs() < 1e-8 * 3.0,
                    "{kind} {}: {expected}",
                    speed(&world)
                );
            }
        }
    }
}

#[test]
fn friction_stops_an_axis_and_holds_it() {
    for (kind, axis) in KINDS {
        let mut world = on_axis(kind, axis, "<dynamics><friction>2</friction></dynamics>");
        push(&mut world, kind, 0.5);
        steps(&mut world, 10);
        assert!((speed(&world) - (0.5 - 10.0 * H * 2.0)).abs() < 1e-8, "{kind}: {}", speed(&world));
        steps(&mut world, 30);
        assert!(speed(&world).abs() < 1e-9, "{kind}: {}", speed(&world));
        let rest = place(&world);
        for _ in 0..50 {
            world.add_effort(JointId(0), 0, 1.9).unwrap();
            world.step().unwrap();
        }
        assert!((place(&world) - rest).abs() < 1e-8, "{kind} crept by {}", place(&world) - rest);
        for _ in 0..10 {
            world.add_effort(JointId(0), 0, 3.0).unwrap();
            world.step().unwrap();
        }
        assert!((speed(&world) - 10.0 * H).abs() < 1e-7, "{kind}: {}", speed(&world));
    }
}

#[test]
fn springs_are_implicit_too() {
    // v' = (v − h k (q − q₀)) / (1 + h c + h² k), q' = q + h v'; the second spring is far too stiff to be explicit.
    for (stiffness, damping) in [(40.0, 0.5), (1e6, 0.0)] {
        for (kind, axis) in KINDS {
            let dynamics = format!(
                "<dynamics><spring_stiffness>{stiffness}</spring_stiffness><spring_reference>0.2</spring_reference>
                 <damping>{damping}</damping></dynamics>"
            );
            let mut world = on_axis(kind, axis, &dynamics);
            let (mut q, mut v) = (0.0, 0.0);
            for _ in 0..100 {
                world.step().unwrap();
                v = (v - H * stiffness * (q - 0.2)) / (1.0 + H * damping + H * H * stiffness);
                q += turn(kind, H * v);
                assert!((place(&world) - q).abs() < 1e-7, "{kind}: {} {q}", place(&world));
            }
        }
    }
}

#[test]
fn damping_and_friction_act_together() {
    for (kind, axis) in KINDS {
        let mut world =
            on_axis(kind, axis, "<dynamics><damping>3</damping><friction>2</friction></dynamics>");
        push(&mut world, kind, -1.0);
        let mut expected: f64 = -1.0;
        for _ in 0..15 {
            world.step().unwrap();
            expected = (expected + H * 2.0) / (1.0 + H * 3.0);
            assert!((speed(&world) - expected).abs() < 1e-7, "{kind}: {} {expected}", speed(&world));
        }
        steps(&mut world, 60);
        assert!(speed(&world).abs() < 1e-7, "{kind}: {}", speed(&world));
    }
}

#[test]
fn stops_give_way_like_their_spring() {
    // A torque of 5 against a stop of 100: 0.05 beyond it.
    for (kind, axis) in KINDS {
        let limit = "<limit><lower>-1</lower><upper>0.3</upper><stiffness>100</stiffness><dissipation>20</dissipation></limit>";
        let mut world = on_axis(kind, axis, limit);
        for _ in 0..1500 {
            world.add_effort(JointId(0), 0, 5.0).unwrap();
            world.step().unwrap();
        }
        assert!((place(&world) - 0.35).abs() < 1e-6, "{kind}: {}", place(&world));
    }
}

#[test]
fn efforts_are_limited() {
    let mut world = on_axis("revolute", "0 0 1", "<limit><effort>2</effort></limit>");
    world.add_effort(JointId(0), 0, -50.0).unwrap();
    world.step().unwrap();
    assert!((speed(&world) + 2.0 * H).abs() < 1e-9, "{}", speed(&world));
    let mut world = on_axis("revolute", "0 0 1", "<limit><velocity>0.5</velocity></limit>");
    for _ in 0..100 {
        world.add_effort(JointId(0), 0, 3.0).unwrap();
        world.step().unwrap();
    }
    assert!((0.5..0.5 + 3.0 * H).contains(&speed(&world)), "{}", speed(&world));
}

#[test]
fn a_pendulum_starts_as_its_moments_say() {
    // 2 kg, 0.5 m below and 0.3 m beside a pivot along y: α = m g x / (I + m r²).
    let mut world = model(
        "<pose>1 2 3 0 0 0</pose>
         <link name='l'><inertial><pose>0.3 0 -0.5 0.4 0 0</pose><mass>2</mass>
         <inertia><ixx>0.3</ixx><iyy>0.2</iyy><izz>0.2</izz></inertia></inertial></link>
         <joint name='j' type='revolute'><parent>world</parent><child>l</child><axis><xyz>0 1 0</xyz></axis></joint>",
    );
    let before = world.link("l").unwrap().pose();
    assert!((before.position - Vec3::new(1.0, 2.0, 3.0)).length() < 1e-12);
    world.step().unwrap();
    // Gravity along −z at x = 0.3 turns about +y.
    let alpha = 2.0 * 10.0 * 0.3 / (0.2 + 2.0 * (0.09 + 0.25));
    assert!((speed(&world) - H * alpha).abs() < 1e-9, "{} {}", speed(&world), H * alpha);
    // The link's origin is the pivot, which stays.
    assert!((world.link("l").unwrap().pose().position - before.position).length() < 1e-4);
}

/// The motion of a joint with two axes, each way round: the parent moves, the child moves, both move.
#[test]
fn positions_and_velocities_have_the_sense_of_the_file() {
    let joint = |kind: &str, parent: &str, child: &str| {
        let axes = match kind {
            "universal" | "revolute2" => "<axis><xyz>0 0 1</xyz></axis><axis2><xyz>1 0 0</xyz></axis2>",
            _ => "<axis><xyz>0 0 1</xyz></axis>",
        };
        format!(
            "<model name='wall'><static>1</static><link name='wall'/></model>
             <model name='m'><link name='a'><gravity>0</gravity></link><link name='b'><gravity>0</gravity></link></model>
             <joint name='j' type='{kind}'><parent>{parent}</parent><child>{child}</child>{axes}</joint>"
        )
    };
    let cases = [("wall::wall", "m::b"), ("m::a", "wall::wall"), ("m::a", "m::b"), ("world", "m::b")];
    for kind in ["revolute", "prismatic", "universal", "revolute2"] {
        for (parent, child) in cases {
            for axis in 0..2 {
                let mut world = world(&joint(kind, parent, child));
                assert!(world.warnings.is_empty(), "{:?}", world.warnings);
                let named = world.joint("j").unwrap();
                let axes = if matches!(kind, "universal" | "revolute2") { 2 } else { 1 };
                assert_eq!(named.axis_count(), axes, "{kind}");
                if axis >= axes {
                    continue;
                }
                // The child goes forwards at 0.3, the parent backwards at 0.2, if they can.
                let along = [Vec3::Z, Vec3::X][axis];
                let mut rate = 0.0;
                for (link, own, sign) in [(parent, -0.2, -1.0), (child, 0.3, 1.0)] {
                    if !link.starts_with('m') {
                        continue;
                    }
                    rate += sign * own;
                    if kind == "prismatic" {
                        set_velocity(&mut world, link, along * own, Vec3::ZERO);
                    } else {
                        set_velocity(&mut world, link, Vec3::ZERO, along * own);
                    }
                }
                let what = format!("{kind} axis {axis} of {parent} and {child}");
                let found = world.joint("j").unwrap().velocity(axis).unwrap();
                assert!((found - rate).abs() < 1e-12, "{what}: {found} is not {rate}");
                steps(&mut world, 50);
                let named = world.joint("j").unwrap();
                let found = named.position(axis).unwrap();
                assert!((found - 50.0 * H * rate).abs() < 1e-6, "{what}: {found} is not {}", 50.0 * H * rate);
                assert_eq!(named.unit(axis), Some(if kind == "prismatic" { "m" } else { "rad" }));
                // A motor drives the same way.
                let motor = world.axis_motor(JointId(0), axis).unwrap();
                let kind_of = world.world.joint_type(motor.joint).unwrap();
                let velocity = motor.sign * 0.7;
                let dynamics = &mut world.world;
                match kind_of {
                    ferrode::JointType::Hinge => dynamics
                        .joint_mut::<ferrode::Hinge>(motor.joint)
                        .unwrap()
                        .set_motor_of(motor.group, velocity, 100.0)
                        .map(drop),
                    ferrode::JointType::Slider => dynamics
                        .joint_mut::<Slider>(motor.joint)
                        .unwrap()
                        .set_motor_of(motor.group, velocity, 100.0)
                        .map(drop),
                    ferrode::JointType::Universal => dynamics
                        .joint_mut::<ferrode::Universal>(motor.joint)
                        .unwrap()
                        .set_motor_of(motor.group, velocity, 100.0)
                        .map(drop),
                    _ => dynamics
                        .joint_mut::<ferrode::Hinge2>(motor.joint)
                        .unwrap()
                        .set_motor_of(motor.group, velocity, 100.0)
                        .map(drop),
                }
                .unwrap();
                steps(&mut world, 20);
                let found = world.joint("j").unwrap().velocity(axis).unwrap();
                assert!((found - 0.7).abs() < 1e-5, "{what}: motor gives {found}");
            }
        }
    }
}

#[test]
fn damping_acts_on_each_axis_of_a_joint_with_two() {
    for kind in ["universal", "revolute2"] {
        for axis in 0..2 {
            let mut world = model(&format!(
                "<link name='a'><gravity>0</gravity></link><link name='b'><gravity>0</gravity></link>
                 <joint name='j' type='{kind}'><parent>a</parent><child>b</child>
                 <axis><xyz>0 0 1</xyz><dynamics><damping>2</damping></dynamics></axis>
                 <axis2><xyz>1 0 0</xyz><dynamics><damping>5</damping></dynamics></axis2></joint>"
            ));
            let along = [Vec3::Z, Vec3::X][axis];
            set_velocity(&mut world, "b", Vec3::ZERO, along * 0.5);
            set_velocity(&mut world, "a", Vec3::ZERO, -along * 0.5);
            world.step().unwrap();
            // Two unit inertias: the relative speed falls with 1 / (1 + 2 h c).
            let expected = 1.0 / (1.0 + 2.0 * H * [2.0, 5.0][axis]);
            let found = world.joint("j").unwrap().velocity(axis).unwrap();
            assert!((found - expected).abs() < 1e-6, "{kind} axis {axis}: {found} is not {expected}");
        }
    }
}

#[test]
fn turns_are_counted() {
    let mut world = on_axis("continuous", "0 0 1", "");
    push(&mut world, "revolute", 20.0);
    steps(&mut world, 200);
    let expected = 200.0 * turn("revolute", H * 20.0);
    assert!((place(&world) - expected).abs() < 1e-6, "{} {expected}", place(&world));
}

#[test]
fn a_file_may_set_motors() {
    let mut world = model(
        "<link name='l'/><joint name='j' type='revolute'><parent>world</parent><child>l</child><axis/>
         <physics><ode><velocity>-1.5</velocity><max_force>100</max_force></ode></physics></joint>",
    );
    steps(&mut world, 10);
    assert!((speed(&world) + 1.5).abs() < 1e-6, "{}", speed(&world));
    // Of a revolute2 it is the wheel that is driven.
    let mut world = model(
        "<link name='a'><gravity>0</gravity></link><link name='b'><gravity>0</gravity></link>
         <joint name='j' type='revolute2'><parent>a</parent><child>b</child><axis><limit><lower>0</lower><upper>0</upper></limit></axis>
         <axis2><xyz>0 1 0</xyz></axis2><physics><ode><velocity>2</velocity><max_force>100</max_force></ode></physics></joint>",
    );
    steps(&mut world, 10);
    let wheel = world.joint("j").unwrap().velocity(1).unwrap();
    assert!((wheel - 2.0).abs() < 1e-5, "{wheel}");
}

/// Two unit inertias on the world, the second following the first.
fn pair_with_mimic(mimic: &str) -> NamedWorld {
    let joint = |name: &str, link: &str, inside: &str| {
        format!(
            "<link name='{link}'/><joint name='{name}' type='revolute'><parent>world</parent><child>{link}</child>
             <axis><xyz>0 0 1</xyz>{inside}</axis></joint>"
        )
    };
    let world = model(&format!("{}{}", joint("j", "l", ""), joint("f", "k", mimic)));
    assert!(world.warnings.is_empty(), "{:?}", world.warnings);
    world
}

#[test]
fn a_follower_follows_and_its_leader_feels_it() {
    let mimic =
        "<mimic joint='j'><multiplier>-2</multiplier><offset>0.1</offset><reference>0.05</reference></mimic>";
    let mut world = pair_with_mimic(mimic);
    for _ in 0..150 {
        world.add_effort(JointId(0), 0, 0.5).unwrap();
        world.step().unwrap();
    }
    let (leader, follower) = (place(&world), world.joint("f").unwrap().position(0).unwrap());
    assert!((follower - (-2.0 * (leader - 0.05) + 0.1)).abs() < 1e-5, "{follower} {leader}");
    // The inertia seen at the leader is 1 + 2² · 1. The offset is made up for at the start, which moves both.
    let mut plain = pair_with_mimic("<mimic joint='j'><multiplier>-2</multiplier></mimic>");
    for _ in 0..100 {
        plain.add_effort(JointId(0), 0, 0.5).unwrap();
        plain.step().unwrap();
    }
    assert!((speed(&plain) - 100.0 * H * 0.5 / 5.0).abs() < 1e-6, "{}", speed(&plain));
    // The follower pushes its leader, too.
    for _ in 0..100 {
        plain.add_effort(JointId(1), 0, 0.25).unwrap();
        plain.step().unwrap();
    }
    assert!((speed(&plain) - 0.0).abs() < 1e-6, "{}", speed(&plain));
}

#[test]
fn a_screw_turns_as_it_falls() {
    // (m + I (2π/p)²) a = −m g, and one turn for each pitch.
    for pitch in [0.5, -0.25] {
        let mut world = model(&format!(
            "<link name='l'/><joint name='j' type='screw'><parent>world</parent><child>l</child>
             <axis><xyz>0 0 1</xyz></axis><screw_thread_pitch>{pitch}</screw_thread_pitch></joint>"
        ));
        assert!(world.warnings.is_empty(), "{:?}", world.warnings);
        let per_metre = 2.0 * std::f64::consts::PI / pitch;
        let steps = 200;
        for _ in 0..steps {
            world.step().unwrap();
        }
        let (slide, angle) = (world.link("l").unwrap().pose().position.z, place(&world));
        assert!((slide * per_metre - angle).abs() < 1e-3 * angle.abs(), "{slide} m, {angle} rad");
        let expected = -10.0 / (1.0 + per_metre * per_metre) * H * steps as f64;
        let fall = world.link("l").unwrap().velocity().0.z;
        assert!((fall - expected).abs() < 2e-3 * expected.abs(), "{fall} {expected}");
    }
}

#[test]
fn a_screw_stops_at_its_limits() {
    let mut world = model(
        "<link name='l'/><joint name='j' type='screw'><parent>world</parent><child>l</child>
         <axis><xyz>0 0 1</xyz><limit><lower>-20</lower><upper>20</upper></limit></axis>
         <screw_thread_pitch>0.1</screw_thread_pitch></joint>",
    );
    for _ in 0..1500 {
        world.add_effort(JointId(0), 0, 30.0).unwrap();
        world.step().unwrap();
    }
    assert!((place(&world) - 20.0).abs() < 0.05, "{}", place(&world));
}

#[test]
fn a_gearbox_turns_its_wheels_against_each_other() {
    let wheel = |name: &str, x: f64| {
        format!(
            "<link name='{name}'><pose>{x} 0 0 0 0 0</pose></link>
             <joint name='axle_{name}' type='continuous'><parent>base</parent><child>{name}</child><axis><xyz>0 0 1</xyz></axis></joint>"
        )
    };
    let mut world = model(&format!(
        "<link name='base'/>{}{}
         <joint name='gears' type='gearbox'><parent>in</parent><child>out</child>
         <gearbox_ratio>3</gearbox_ratio><gearbox_reference_body>base</gearbox_reference_body>
         <axis><xyz>0 0 1</xyz></axis><axis2><xyz>0 0 1</xyz></axis2></joint>
         <joint name='foot' type='fixed'><parent>world</parent><child>base</child></joint>",
        wheel("in", 0.0),
        wheel("out", 1.0)
    ));
    assert!(world.warnings.is_empty(), "{:?}", world.warnings);
    let driven = world.joint("axle_in").unwrap().id();
    for _ in 0..200 {
        world.add_effort(driven, 0, 2.0).unwrap();
        world.step().unwrap();
    }
    let at = |name: &str| world.joint(name).unwrap().position(0).unwrap();
    assert!((at("axle_out") + 3.0 * at("axle_in")).abs() < 1e-3, "{} {}", at("axle_in"), at("axle_out"));
    // 1 + 3² · 1 at the driven wheel.
    let rate = world.joint("axle_in").unwrap().velocity(0).unwrap();
    assert!((rate - 200.0 * H * 2.0 / 10.0).abs() < 1e-3, "{rate}");
}

#[test]
fn couplings_keep_momentum() {
    // A screw between two free bodies: neither momentum nor angular momentum about the origin changes.
    let mut world = world(
        "<model name='m'><link name='a'><gravity>0</gravity><inertial><mass>3</mass></inertial></link>
         <link name='b'><gravity>0</gravity><pose>0.4 0.1 0.3 0 0 0</pose></link>
         <joint name='j' type='screw'><parent>a</parent><child>b</child><axis><xyz>0 0 1</xyz></axis>
         <screw_thread_pitch>0.5</screw_thread_pitch></joint></model>",
    );
    set_velocity(&mut world, "b", Vec3::Z * 0.5, Vec3::new(0.1, 0.0, 1.0));
    let momenta = |world: &NamedWorld| {
        let (mut linear, mut angular) = (Vec3::ZERO, Vec3::ZERO);
        for name in ["a", "b"] {
            let body = world.world.body(world.link(name).unwrap().body().unwrap()).unwrap();
            let p = body.linear_velocity() * body.mass().mass;
            linear += p;
            angular += body.position().cross(p) + body.inertia_world() * body.angular_velocity();
        }
        (linear, angular)
    };
    let before = momenta(&world);
    steps(&mut world, 100);
    let after = momenta(&world);
    assert!((after.0 - before.0).length() < 1e-9, "{:?} {:?}", before.0, after.0);
    assert!((after.1 - before.1).length() < 0.02 * before.1.length(), "{:?} {:?}", before.1, after.1);
}

const GROUND: &str = "<model name='ground'><static>true</static><pose>0 0 -1 0 0 0</pose><link name='ground'>
    <collision name='c'><geometry><plane/></geometry></collision></link></model>";

#[test]
fn things_rest_on_the_ground_and_links_of_a_model_pass_through_each_other() {
    let ball = |name: &str, z: f64, more: &str| {
        format!(
            "<link name='{name}'><pose>0 0 {z} 0 0 0</pose>{more}
             <collision name='c'><geometry><sphere><radius>0.25</radius></sphere></geometry></collision></link>"
        )
    };
    let height = |more: &str| {
        let inside =
            format!("{GROUND}<model name='m'>{}{}</model>", ball("low", -0.5, ""), ball("high", 0.5, more));
        let mut world = world(&inside);
        steps(&mut world, 300);
        (world.link("low").unwrap().pose().position.z, world.link("high").unwrap().pose().position.z)
    };
    let (low, high) = height("");
    assert!((low + 0.75).abs() < 2e-3 && (high + 0.75).abs() < 2e-3, "{low} {high}");
    let (low, high) = height("<self_collide>1</self_collide>");
    assert!((low + 0.75).abs() < 2e-3 && (high + 0.25).abs() < 4e-3, "{low} {high}");
}

#[test]
fn links_joined_to_a_static_one_pass_through_it() {
    let inside = "<model name='post'><static>1</static><link name='post'>
        <collision name='c'><geometry><box/></geometry></collision></link></model>
        <model name='m'><link name='l'><collision name='c'><geometry><box/></geometry></collision></link></model>
        <joint name='j' type='revolute'><parent>post::post</parent><child>m::l</child><axis/></joint>";
    let mut world = world(inside);
    set_velocity(&mut world, "l", Vec3::ZERO, Vec3::Z);
    steps(&mut world, 10);
    assert!(world.world.contacts().is_empty());
    assert!((speed(&world) - 1.0).abs() < 1e-9);
}

#[test]
fn friction_and_bounce_come_from_the_surface() {
    // A block on a slope of 0.3 rad slides if mu < tan 0.3 = 0.309.
    let slide = |mu: f64| {
        let mut world = world(&format!(
            "<model name='slope'><static>true</static><pose>0 0 0 0 0.3 0</pose><link name='s'>
             <collision name='c'><geometry><plane/></geometry></collision></link></model>
             <model name='m'><pose>0 0 0 0 0.3 0</pose><link name='l'><pose>0 0 0.1 0 0 0</pose>
             <collision name='c'><geometry><box><size>1 1 0.2</size></box></geometry>
             <surface><friction><ode><mu>{mu}</mu><mu2>{mu}</mu2></ode></friction></surface></collision></link></model>"
        ));
        steps(&mut world, 100);
        world.link("l").unwrap().velocity().0.length()
    };
    assert!(slide(0.35) < 1e-3, "{}", slide(0.35));
    // g (sin − mu cos) t, less what the friction pyramid's quirks take.
    let expected = 10.0 * (real::sin(0.3) - 0.2 * real::cos(0.3));
    assert!((slide(0.2) - expected).abs() < 0.05 * expected, "{} {expected}", slide(0.2));

    let bounce = "<surface><bounce><restitution_coefficient>0.8</restitution_coefficient><threshold>0.1</threshold></bounce></surface>";
    let mut world = world(&format!(
        "{GROUND}<model name='m'><link name='l'><collision name='c'><geometry><sphere><radius>0.5</radius></sphere></geometry>
         {bounce}</collision></link></model>"
    ));
    let (mut fastest, mut up) = (0.0f64, 0.0f64);
    for _ in 0..60 {
        world.step().unwrap();
        let v = world.link("l").unwrap().velocity().0.z;
        fastest = fastest.min(v);
        up = up.max(v);
    }
    assert!((up + 0.8 * fastest).abs() < 0.11, "{up} after {fastest}");
}

#[test]
fn kinematic_links_and_links_without_gravity_stay() {
    let mut world = model(
        "<link name='k'><kinematic>1</kinematic></link><link name='g'><gravity>0</gravity></link><link name='f'/>
         <link name='d'><velocity_decay><linear>0.1</linear></velocity_decay></link>",
    );
    steps(&mut world, 10);
    let z = |name: &str| world.link(name).unwrap().pose().position.z;
    assert_eq!((z("k"), z("g")), (0.0, 0.0));
    assert!((z("f") + 10.0 * H * H * 55.0).abs() < 1e-9, "{}", z("f"));
    assert!(z("d") > z("f") && z("d") < 0.0);
}

#[test]
fn what_the_engine_lacks_is_named() {
    let text = "<sdf version='1.12'><model name='m'>
<link name='l'>
<collision name='c'><geometry><image><uri>x</uri></image></geometry></collision></link>
<link name='k'/>
<joint name='s' type='universal'><parent>world</parent><child>k</child><axis/><axis2/></joint></model></sdf>";
    let scene = load_str("test.sdf", text, &options()).unwrap().scene;
    let world = build(&scene, &BuildOptions::default()).unwrap();
    let lines: Vec<(Option<usize>, &str)> = world.warnings.iter().map(|w| (w.line(), w.message())).collect();
    assert_eq!(lines[0], (Some(3), "collision `c` is left out: the shape `image` is not supported"));
    assert_eq!(lines[1].0, Some(5));
    assert!(world.joint("s").unwrap().key().is_none());
    let strict = BuildOptions { strict: true, ..BuildOptions::default() };
    let error = build(&scene, &strict).expect_err("strict");
    assert_eq!(error.line(), Some(3));
}

#[test]
fn a_welded_link_stays() {
    let mut world = model("<pose>0 0 2 0 0 0</pose><link name='l'/>");
    world.weld(LinkId(0)).unwrap();
    steps(&mut world, 50);
    assert!((world.link("l").unwrap().pose().position.z - 2.0).abs() < 1e-6);
}

#[test]
fn a_spring_holds_against_friction_within_its_band() {
    // Released 0.3 from rest, spring 10, friction 2: it stops within 2 / 10 of the reference and stays.
    for (kind, axis) in KINDS {
        let dynamics =
            "<dynamics><spring_stiffness>10</spring_stiffness><spring_reference>0.9</spring_reference>
             <damping>0.5</damping><friction>2</friction></dynamics>";
        let mut world = on_axis(kind, axis, dynamics);
        steps(&mut world, 600);
        let rest = place(&world);
        assert!((rest - 0.9).abs() < 0.2 && rest > 0.3, "{kind}: {rest}");
        steps(&mut world, 100);
        assert!((place(&world) - rest).abs() < 1e-6, "{kind}: {}", place(&world) - rest);
        // Within the band it does not start at all.
        let mut world = on_axis(kind, axis, &dynamics.replace("0.9", "0.15"));
        steps(&mut world, 100);
        assert!(place(&world).abs() < 1e-6, "{kind}: {}", place(&world));
    }
}

#[test]
fn stops_may_be_turns_away() {
    let limit = "<limit><lower>-4</lower><upper>15</upper></limit><dynamics><damping>0.1</damping><friction>0.1</friction></dynamics>";
    let mut world = on_axis("revolute", "0 0 1", limit);
    assert!(world.warnings.is_empty(), "{:?}", world.warnings);
    for (effort, end) in [(3.0, 15.0), (-3.0, -4.0)] {
        for _ in 0..1500 {
            world.add_effort(JointId(0), 0, effort).unwrap();
            world.step().unwrap();
        }
        assert!((place(&world) - end).abs() < 1e-3, "{} {end}", place(&world));
    }
}

#[test]
fn all_solids_come_to_rest() {
    let mesh = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/data/meshes/box.obj");
    let mesh = mesh.display();
    // Shape, and how high its origin lies when it rests as it starts.
    let cases = [
        ("<box><size>1 1 1</size></box>".to_owned(), 0.5),
        ("<cylinder><radius>0.5</radius><length>1</length></cylinder>".to_owned(), 0.5),
        ("<cone><radius>0.5</radius><length>1</length></cone>".to_owned(), 0.5),
        ("<ellipsoid><radii>0.5 0.4 0.3</radii></ellipsoid>".to_owned(), 0.3),
        ("<polyline><point>0 0</point><point>1 0</point><point>0 1</point><height>0.5</height></polyline>".to_owned(), 0.0),
        (
            "<polyline><point>-1 -1</point><point>1 -1</point><point>0 0</point><point>1 1</point><point>-1 1</point>
             <height>0.5</height></polyline>"
                .to_owned(),
            0.0,
        ),
        (format!("<mesh><uri>{mesh}</uri></mesh>"), 0.0),
        (format!("<mesh optimization='convex_hull'><uri>{mesh}</uri><scale>0.5 0.5 0.1</scale></mesh>"), 0.0),
    ];
    for (shape, rest) in cases {
        let text = format!(
            "<sdf version='1.12'><world name='w'><physics type='ode'><max_step_size>0.005</max_step_size></physics>{GROUND}
             <model name='m'><link name='l'><inertial auto='true'/><collision name='c'><geometry>{shape}</geometry>
             </collision></link></model></world></sdf>"
        );
        let loaded = load_str("test.sdf", &text, &options()).unwrap_or_else(|error| panic!("{error}"));
        assert!(loaded.warnings.is_empty(), "{:?}", loaded.warnings);
        let mut world =
            build(&loaded.scene, &BuildOptions::default()).unwrap_or_else(|error| panic!("{error}"));
        assert!(world.warnings.is_empty(), "{:?}", world.warnings);
        let start = world.link("l").unwrap().pose().position.z;
        steps(&mut world, 400);
        let height = world.link("l").unwrap().pose().position.z + 1.0;
        assert!(
            height < start + 1.0 && (height - rest).abs() < 5e-3,
            "{shape}: rests at {height}, not {rest}"
        );
        assert!(world.link("l").unwrap().velocity().0.length() < 0.05, "{shape}");
    }
}

#[test]
fn terrain_carries_what_falls_on_it() {
    // A valley: 0.5 high at both ends of x, 0 in the middle. A ball rolls in it.
    let path = std::path::Path::new(env!("CARGO_TARGET_TMPDIR")).join("valley.png");
    let image =
        image::GrayImage::from_fn(17, 17, |x, _| image::Luma([(x as i32 - 8).unsigned_abs() as u8 * 31]));
    image.save(&path).unwrap();
    let terrain = format!(
        "<model name='t'><static>1</static><link name='t'><collision name='c'><geometry><heightmap><uri>{}</uri>
         <size>8 8 2</size><pos>0 0 -1</pos></heightmap></geometry></collision></link></model>",
        path.display()
    );
    let mut world = world(&format!(
        "{terrain}<model name='m'><pose>1.5 0.3 0.09 0 0 0</pose><link name='l'><velocity_decay><linear>0.01</linear></velocity_decay>
         <collision name='c'><geometry><sphere><radius>0.3</radius></sphere></geometry></collision></link></model>"
    ));
    assert!(world.warnings.is_empty(), "{:?}", world.warnings);
    let slope = 0.5f64 * 248.0 / 255.0;
    let mut lowest = f64::INFINITY;
    for _ in 0..600 {
        world.step().unwrap();
        let at = world.link("l").unwrap().pose().position;
        assert!(at.x.abs() < 1.6, "{at:?}");
        // Distance of the ball's centre from the slope on its side.
        lowest = lowest.min((at.z + 1.0 - slope * at.x.abs()) / (1.0 + slope * slope).sqrt());
    }
    assert!((lowest - 0.3).abs() < 0.02, "{lowest}");
    assert!(!world.world.contacts().is_empty());
}

#[test]
fn scenes_that_do_not_hang_together_are_refused() {
    let text = "<sdf version='1.11'><model name='m'><link name='l'/><link name='k'/>
        <joint name='j' type='revolute'><parent>l</parent><child>k</child><axis><mimic joint='i'/></axis></joint>
        <joint name='i' type='revolute'><parent>world</parent><child>l</child><axis/></joint></model></sdf>";
    let scene = load_str("test.sdf", text, &options()).unwrap().scene;
    let refused = |change: fn(&mut Scene)| {
        let mut scene = scene.clone();
        change(&mut scene);
        build(&scene, &BuildOptions::default()).map(drop).expect_err("a broken scene").message().to_owned()
    };
    assert_eq!(
        refused(|scene| scene.joints[0].child = Body::Link(LinkId(9))),
        "joint `m::j` holds link 9 of 2"
    );
    assert_eq!(
        refused(|scene| scene.joints[0].child = scene.joints[0].parent),
        "joint `m::j` joins a body to itself"
    );
    assert_eq!(refused(|scene| scene.links[1].model = ModelId(3)), "link `m::k` belongs to model 3 of 1");
    assert!(refused(|scene| scene.models[0].parent = Some(ModelId(0))).contains("does not stand before it"));
    assert!(refused(|scene| drop(scene.joints.pop())).contains("mimics joint 1 of 1"));
    assert!(refused(|scene| scene.physics.max_step_size = f64::NAN).contains("step size"));
    assert!(refused(|scene| scene.gravity.x = f64::NAN).contains("physics settings"));
    assert!(refused(|scene| scene.links[0].inertial.mass = -1.0).contains("refuses the link"));
    assert!(refused(|scene| scene.links[0].pose.position.x = f64::INFINITY).contains("refuses the link"));
}

#[test]
fn joints_with_two_axes_stop_on_each() {
    let limit = |low: f64, high: f64| format!("<limit><lower>{low}</lower><upper>{high}</upper></limit>");
    for kind in ["universal", "revolute2"] {
        for (parent, child) in [("a", "b"), ("b", "a")] {
            for axis in 0..2 {
                let mut world = model(&format!(
                    "<link name='a'><gravity>0</gravity></link><link name='b'><gravity>0</gravity></link>
                     <joint name='j' type='{kind}'><parent>{parent}</parent><child>{child}</child>
                     <axis><xyz>0 0 1</xyz>{}<dynamics><damping>1</damping></dynamics></axis>
                     <axis2><xyz>1 0 0</xyz>{}<dynamics><damping>1</damping></dynamics></axis2></joint>
                     <joint name='foot' type='fixed'><parent>world</parent><child>a</child></joint>",
                    limit(-0.3, 0.4),
                    limit(-0.5, 0.6)
                ));
                assert!(world.warnings.is_empty(), "{:?}", world.warnings);
                for (effort, ends) in [(2.0, [0.4, 0.6]), (-2.0, [-0.3, -0.5])] {
                    for _ in 0..300 {
                        world.add_effort(JointId(0), axis, effort).unwrap();
                        world.step().unwrap();
                    }
                    let found = world.joint("j").unwrap().position(axis).unwrap();
                    let what = format!("{kind} of {parent} and {child}, axis {axis}");
                    assert!((found - ends[axis]).abs() < 1e-3, "{what}: {found} is not {}", ends[axis]);
                }
            }
        }
    }
}

#[test]
fn the_quick_stepper_finds_the_same_springs_dampers_and_friction() {
    for (kind, axis) in KINDS {
        let dynamics = "<dynamics><spring_stiffness>40</spring_stiffness><damping>2</damping></dynamics>";
        let run = |stepper: ferrode::Stepper| {
            let mut world = on_axis(kind, axis, dynamics);
            world.world.stepper = stepper;
            push(&mut world, kind, 1.0);
            steps(&mut world, 50);
            (place(&world), speed(&world))
        };
        let (exact, quick) = (run(ferrode::Stepper::Direct), run(ferrode::Stepper::Quick));
        assert!(
            (exact.0 - quick.0).abs() < 1e-6 && (exact.1 - quick.1).abs() < 1e-5,
            "{kind}: {exact:?} {quick:?}"
        );
    }
}

#[test]
fn a_world_of_a_program_gets_names_and_steps_to_the_same_bits() -> Result<(), ferrode::Error> {
    use ferrode::{BodyBuilder, Cuboid, Sphere, World};
    let mut world = World::new();
    world.set_gravity(Vec3::new(0.0, 0.0, -9.81))?;
    let root = world.add_body(BodyBuilder::new().with_shape(Cuboid::new(Vec3::splat(0.4))?, 500.0))?;
    let arm = BodyBuilder::new().at(Vec3::new(1.0, 0.0, 0.0)).with_shape(Sphere::new(0.2)?, 500.0);
    let arm = world.add_body(arm)?;
    let bare = world.create_body();
    world.add_fixed(Some(root), None)?;
    let hinge = world.add_hinge(Some(arm), Some(root), Vec3::ZERO, Vec3::Y)?;
    let mut alone = world.clone();
    let mut named = NamedWorld::of_world(world, 0.01, "test");
    assert_eq!(named.step_size(), 0.01);
    for (name, key) in [("Cuboid 1", root), ("Sphere 2", arm), ("Body 3", bare)] {
        assert_eq!(named.link(name).unwrap().body(), Some(key), "{name}");
    }
    let joint = named.joint("Revolute 2").unwrap();
    assert_eq!((joint.key(), joint.description().child), (Some(hinge), Body::Link(LinkId(1))));
    for _ in 0..50 {
        named.step()?;
        alone.step(0.01)?;
    }
    assert_eq!(named.world.body(arm)?.pose(), alone.body(arm)?.pose());
    let joint = named.joint("Revolute 2").unwrap();
    let angle = alone.joint::<ferrode::Hinge>(hinge)?.angle();
    assert!((joint.position(0).unwrap() - angle).abs() < 1e-12 && angle > 0.3, "{angle}");
    assert_eq!(joint.unit(0), Some("rad"));
    assert_eq!(named.link("Sphere 2").unwrap().pose().position, alone.body(arm)?.position());
    Ok(())
}
