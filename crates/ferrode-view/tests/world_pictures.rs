//! Pictures of worlds hold their bodies where the engine's own rays meet them, and overlays show the engine's values.

mod common;

use common::canvas;
use ferrode::dynamics::{JointData, JointMut};
use ferrode::prelude::*;
use ferrode::{
    AMotor, AxisFrame, Compound, Cone, Convex, DHinge, Ellipsoid, Heightfield, Hinge, Hinge2, LMotor, PR, PU,
    Piston, Slider, Transmission, TriMesh, Universal,
};
use ferrode_view::joint_marks::{JointMarks, joint_marks};
use ferrode_view::overlay::{self, ArrowKind, Overlays, Scale};
use ferrode_view::painter::{Painter, bounds};
use ferrode_view::render::{Camera, Color, Quality, Scene};

const SIZE: [u32; 2] = [320, 200];

/// A body of each shape on a plane.
fn all_shapes() -> Result<World, Error> {
    let mut world = World::new();
    world.add_static(Plane::new(Vec3::Z, 0.0)?, Pose::IDENTITY)?;
    let corners = [Vec3::ZERO, Vec3::new(0.9, 0.0, 0.0), Vec3::new(0.2, 0.8, 0.0), Vec3::new(0.3, 0.3, 0.9)];
    let faces = vec![[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]];
    let shapes: Vec<Shape> = vec![
        Cuboid::new(Vec3::new(0.8, 0.6, 0.5))?.into(),
        Sphere::new(0.45)?.into(),
        Capsule::new(0.25, 0.6)?.into(),
        Cylinder::new(0.35, 0.7)?.into(),
        Cone::new(0.4, 0.9)?.into(),
        Ellipsoid::new(Vec3::new(0.5, 0.3, 0.4))?.into(),
        Convex::from_points(&corners)?.into(),
        TriMesh::new(corners.to_vec(), faces)?.into(),
        Compound::new([
            (Cuboid::new(Vec3::new(0.9, 0.2, 0.2))?.into(), Pose::IDENTITY),
            (Convex::from_points(&corners)?.into(), Pose::from_position(Vec3::new(0.2, 0.1, -0.2))),
            (Sphere::new(0.2)?.into(), Pose::from_position(Vec3::new(-0.5, 0.0, 0.1))),
        ])?
        .into(),
    ];
    let axis = Vec3::new(0.3, 0.5, 0.8).normalized_or(Vec3::Z);
    for (n, shape) in shapes.into_iter().enumerate() {
        let (column, row) = ((n % 5) as f64, (n / 5) as f64);
        let at = Vec3::new(1.3 * column - 2.6, 1.4 * row - 0.7, 0.8);
        let turn = Quat::from_axis_angle(axis, 0.5 + n as f64);
        world.add_body(BodyBuilder::new().at(at).rotated(turn).with_shape(shape, 500.0))?;
    }
    world.sync_geoms();
    Ok(world)
}

/// Compares each pixel with what the engine's ray through it meets, but for pixels within two of an edge. `red` says which of
/// the hits is drawn red.
fn compare(world: &mut World, scene: &Scene, camera: &Camera, red: impl Fn(&ferrode::GeomInfo) -> bool) {
    let Some(mut canvas) = canvas(SIZE, Quality::live()) else { return };
    let picture = canvas.draw(scene, camera).unwrap();
    let [width, height] = SIZE.map(|side| side as usize);
    let mut meets = vec![false; width * height];
    for y in 0..height {
        for x in 0..width {
            let along = camera.ray([x as f64 + 0.5, y as f64 + 0.5], SIZE);
            let hit = world.ray_cast(camera.eye, along, 100.0, |_| true).unwrap();
            meets[y * width + x] = hit.is_some_and(|hit| red(world.geom_info(hit.geom).unwrap()));
        }
    }
    let (mut covered, mut wrong) = (0, Vec::new());
    for y in 2..height - 2 {
        for x in 2..width - 2 {
            let inside = meets[y * width + x];
            let near = |dx: usize, dy: usize| meets[(y + dy - 2) * width + x + dx - 2] == inside;
            if (0..5).all(|dx| (0..5).all(|dy| near(dx, dy))) {
                covered += usize::from(inside);
                let [r, g, b, _] = picture.pixel(x as u32, y as u32).unwrap().map(i32::from);
                if (r > g + 25 && r > b + 25) != inside {
                    wrong.push((x, y, [r, g, b]));
                }
            }
        }
    }
    assert!(covered > 3000, "{covered} pixels only: the test says little");
    assert!(wrong.is_empty(), "{} of {covered}: {:?}", wrong.len(), &wrong[..wrong.len().min(5)]);
}

#[test]
fn bodies_of_all_shapes_cover_the_pixels_whose_rays_meet_them() {
    let mut world = all_shapes().unwrap();
    let mut painter = Painter::default();
    let bodies: Vec<BodyKey> = world.bodies().map(|(key, _)| key).collect();
    for body in bodies {
        painter.set_color(body, Color::rgb(220, 20, 20));
    }
    let mut scene = Scene::new();
    painter.paint(&world, &mut scene);
    let camera = Camera::framing(&bounds(&world).unwrap(), -1.1, 0.5, 1.6);
    compare(&mut world, &scene, &camera, |info| info.body.is_some());
}

#[test]
fn a_heightfield_covers_the_pixels_whose_rays_meet_it() {
    let mut world = World::new();
    let height = |x: usize, z: usize| 0.4 * ferrode::math::real::sin(x as f64) + 0.3 * (z % 3) as f64;
    let heights: Vec<f64> = (0..9 * 7).map(|n| height(n % 9, n / 9)).collect();
    let field = Heightfield::new(4.0, 3.0, 9, 7, heights, 0.0).unwrap();
    let turn = Pose::new(Vec3::ZERO, Heightfield::z_up());
    // On a body, which stays where it is, to be drawn in a colour.
    let body = BodyBuilder::new().kinematic().with_shape_at(field, 0.0, turn);
    let body = world.add_body(body).unwrap();
    let mut painter = Painter::default();
    painter.set_color(body, Color::rgb(220, 20, 20));
    let mut scene = Scene::new();
    painter.paint(&world, &mut scene);
    let camera = Camera::framing(&bounds(&world).unwrap(), -1.1, 0.6, 1.6);
    compare(&mut world, &scene, &camera, |_| true);
}

/// A cube on the ground beside one that hangs on a hinge with stops.
fn contacts_and_a_hinge() -> (World, JointKey) {
    let mut world = World::new();
    world.set_gravity(Vec3::new(0.0, 0.0, -9.81)).unwrap();
    world.add_static(Plane::new(Vec3::Z, 0.0).unwrap(), Pose::IDENTITY).unwrap();
    let cube = |at: Vec3| BodyBuilder::new().at(at).with_shape(Cuboid::new(Vec3::splat(0.6)).unwrap(), 300.0);
    world.add_body(cube(Vec3::new(-1.0, 0.0, 0.3))).unwrap();
    let hanging = world.add_body(cube(Vec3::new(1.0, 0.0, 1.2))).unwrap();
    let axis = Vec3::new(0.0, 0.8, 0.6);
    let hinge = world.add_hinge(Some(hanging), None, Vec3::new(1.3, 0.1, 1.5), axis).unwrap();
    world.joint_mut::<Hinge>(hinge).unwrap().set_limits(-0.5, 0.8).unwrap();
    overlay::record_joint_forces(&mut world).unwrap();
    for _ in 0..40 {
        world.step(0.005).unwrap();
    }
    (world, hinge)
}

#[test]
fn arrows_are_the_engines_contacts_and_joints() {
    let (world, hinge) = contacts_and_a_hinge();
    let scale = Scale { length: 0.5, per_newton: 1e-3 };
    let all =
        Overlays { contacts: true, forces: true, joints: true, joint_forces: true, ..Overlays::default() };
    let arrows = overlay::arrows(&world, &all, &scale);
    let of = |kind: ArrowKind| arrows.iter().filter(move |arrow| arrow.kind == kind);
    assert_eq!(world.contacts().len(), 4);
    for (contact, arrow) in world.contacts().iter().zip(of(ArrowKind::Normal)) {
        assert_eq!(arrow.from, contact.point.position);
        assert!((arrow.to - arrow.from - contact.point.normal * 0.5).length() < 1e-12);
    }
    let mut sum = Vec3::ZERO;
    for (contact, arrow) in world.contacts().iter().zip(of(ArrowKind::ContactForce)) {
        assert!((arrow.to - arrow.from - contact.force * 1e-3).length() < 1e-12);
        sum += (arrow.to - arrow.from) * 1e3;
    }
    // The four together carry the cube: 300 · 0.6³ kg.
    assert!((sum.length() - 64.8 * 9.81).abs() < 1.0, "{sum:?}");
    let joint = world.joint::<Hinge>(hinge).unwrap();
    let axis: Vec<_> = of(ArrowKind::Axis).collect();
    assert_eq!(axis.len(), 1);
    assert!((axis[0].to - axis[0].from - joint.axis()).length() < 1e-12, "1 m: half on either side");
    assert!(((axis[0].to + axis[0].from) * 0.5 - joint.anchor()).length() < 1e-12);
    let force: Vec<_> = of(ArrowKind::JointForce).collect();
    let feedback = world.joint_feedback(hinge).unwrap().unwrap();
    assert!((force[0].to - force[0].from - feedback.force1 * 1e-3).length() < 1e-12);
    assert_eq!(force[0].from, joint.anchor());
    let none = overlay::arrows(&world, &Overlays::default(), &scale);
    assert!(none.is_empty());
}

#[test]
fn drawn_arrows_lie_where_the_engine_says() {
    let Some(mut canvas) = canvas(SIZE, Quality::live()) else { return };
    let (world, hinge) = contacts_and_a_hinge();
    let scale = Scale { length: 0.5, per_newton: 1e-3 };
    let camera = Camera::look_at(Vec3::new(1.5, -4.0, 2.0), Vec3::new(0.2, 0.0, 0.8));
    let draw = |canvas: &mut ferrode_view::render::Canvas, overlays: Overlays| {
        let mut scene = Scene::new();
        Painter::default().paint(&world, &mut scene);
        overlay::draw(&world, &overlays, &scale, &mut scene);
        canvas.draw(&scene, &camera).unwrap()
    };
    let plain = draw(&mut canvas, Overlays::default());
    let seen = |picture: &ferrode_view::render::Picture, p: Vec3| {
        let ([x, y], _) = camera.project(p, SIZE).unwrap();
        picture.pixel(x as u32, y as u32).unwrap()
    };
    let contacts = draw(&mut canvas, Overlays { contacts: true, ..Overlays::default() });
    for contact in world.contacts() {
        let middle = contact.point.position + contact.point.normal * 0.25;
        let [r, g, b, _] = seen(&contacts, middle);
        assert!(b > 150 && b > r && b > g, "normals are blue: {:?}", [r, g, b]);
        assert_ne!(seen(&plain, middle), seen(&contacts, middle));
        let [r, g, b, _] = seen(&contacts, contact.point.position);
        assert!(r > 150 && r > 2 * g && r > 2 * b, "points are red: {:?}", [r, g, b]);
    }
    let joints = draw(&mut canvas, Overlays { joints: true, ..Overlays::default() });
    let joint = world.joint::<Hinge>(hinge).unwrap();
    for along in [-0.35, -0.2, 0.2, 0.35] {
        let [r, g, b, _] = seen(&joints, joint.anchor() + joint.axis() * along);
        assert!(g > 120 && g > r && g > b, "axes are green: {:?} at {along}", [r, g, b]);
    }
}

/// A joint of a type between two bodies, set up by hand, and what is to be seen of it.
fn marks_of<J: JointData>(set: impl Fn(&mut JointMut<'_, J>)) -> (World, JointKey, JointMarks) {
    let mut world = World::new();
    let turn = |x: f64| Quat::from_axis_angle(Vec3::new(0.6, 0.0, 0.8), x);
    let mut add = |at: Vec3, x: f64| {
        world.add_body(BodyBuilder::new().at(at).rotated(turn(x)).with_shape(Sphere::new(0.1).unwrap(), 1e3))
    };
    let (a, b) = (add(Vec3::new(0.4, 0.1, 0.2), 0.3).unwrap(), add(Vec3::new(-0.5, 0.2, 0.9), 1.1).unwrap());
    let joint = world.create_joint::<J>(None).unwrap();
    world.attach(joint, Some(a), Some(b)).unwrap();
    set(&mut world.joint_mut::<J>(joint).unwrap());
    let marks = joint_marks(world.dynamics(), joint).unwrap();
    (world, joint, marks)
}

/// Arrows lie along the axes, and through the anchor, that the joint was given.
fn check_axes<J: JointData>(wanted: &[(Vec3, Vec3)], set: impl Fn(&mut JointMut<'_, J>)) {
    let (world, _, marks) = marks_of::<J>(set);
    let kind = std::any::type_name::<J>();
    let scale = Scale { length: 0.5, per_newton: 1e-3 };
    let overlays = Overlays { joints: true, ..Overlays::default() };
    let arrows = overlay::arrows(&world, &overlays, &scale);
    assert_eq!((arrows.len(), marks.axes.len()), (wanted.len(), wanted.len()), "{kind}");
    for (arrow, (at, along)) in arrows.iter().zip(wanted) {
        assert_eq!(arrow.kind, ArrowKind::Axis);
        assert!((arrow.to - arrow.from - *along).length() < 1e-9, "{kind}: {arrow:?}, {along:?}");
        let middle = (arrow.from + arrow.to) * 0.5 - *at;
        assert!(middle.length() < 1e-9, "{kind}: {arrow:?}, {at:?}");
    }
}

#[test]
fn axes_of_all_joints_are_drawn_where_they_were_set() {
    let at = Vec3::new(0.1, 0.2, 0.3);
    let (x, y) = (Vec3::new(0.6, 0.0, 0.8), Vec3::Y);
    let z = x.cross(y);
    let (first, middle) = (Vec3::new(0.4, 0.1, 0.2), Vec3::new(-0.05, 0.15, 0.55));
    check_axes::<Hinge>(&[(at, x)], |joint| {
        joint.set_anchor(at).unwrap();
        joint.set_axis(x).unwrap();
    });
    check_axes::<Slider>(&[(first, x)], |joint| joint.set_axis(x).unwrap());
    check_axes::<Piston>(&[(at, x)], |joint| {
        joint.set_anchor(at).unwrap();
        joint.set_axis(x).unwrap();
    });
    check_axes::<Universal>(&[(at, x), (at, y)], |joint| {
        joint.set_anchor(at).unwrap();
        joint.set_axis1(x).unwrap();
        joint.set_axis2(y).unwrap();
    });
    check_axes::<Hinge2>(&[(at, x), (at, y)], |joint| {
        joint.set_anchor(at).unwrap();
        joint.set_axes(Some(x), Some(y)).unwrap();
    });
    check_axes::<PR>(&[(at, x), (at, y)], |joint| {
        joint.set_anchor(at).unwrap();
        joint.set_axis1(x).unwrap();
        joint.set_axis2(y).unwrap();
    });
    check_axes::<PU>(&[(at, x), (at, y), (at, z)], |joint| {
        joint.set_anchor(at).unwrap();
        joint.set_axis1(x).unwrap();
        joint.set_axis2(y).unwrap();
        joint.set_axis3(z).unwrap();
    });
    check_axes::<DHinge>(&[(at, x), (at + y, x)], |joint| {
        joint.set_axis(x).unwrap();
        joint.set_anchor1(at).unwrap();
        joint.set_anchor2(at + y).unwrap();
    });
    check_axes::<Transmission>(&[(at, x), (at + z, x)], |joint| {
        joint.set_axis(x).unwrap();
        joint.set_anchor1(at).unwrap();
        joint.set_anchor2(at + z).unwrap();
    });
    check_axes::<AMotor>(&[(middle, x), (middle, y)], |joint| {
        joint.set_axis_count(2);
        joint.set_axis(0, AxisFrame::World, x).unwrap();
        joint.set_axis(1, AxisFrame::First, y).unwrap();
    });
    check_axes::<LMotor>(&[(middle, x), (middle, y)], |joint| {
        joint.set_axis_count(2);
        joint.set_axis(0, AxisFrame::World, x).unwrap();
        joint.set_axis(1, AxisFrame::Second, y).unwrap();
    });
}

#[test]
fn ranges_of_all_joints_with_stops_are_drawn() {
    fn numbers<J: JointData>(set: impl Fn(&mut JointMut<'_, J>)) -> Vec<(usize, bool, f64, f64)> {
        let (_, _, marks) = marks_of::<J>(set);
        marks.ranges.iter().map(|r| (r.limit.number, r.limit.turns, r.limit.low, r.limit.high)).collect()
    }
    let both = |turns: [bool; 3], count: usize| -> Vec<(usize, bool, f64, f64)> {
        (0..count).map(|n| (n + 1, turns[n], -0.3, 0.4)).collect()
    };
    let (low, high) = (-0.3, 0.4);
    macro_rules! stops {
        ($joint:ident, $($axis:literal),+) => {
            numbers::<$joint>(|joint| {
                $(joint.set_limits_of($axis, low, high).unwrap();)+
            })
        };
    }
    assert_eq!(stops!(Hinge, 1), both([true; 3], 1));
    assert_eq!(stops!(Slider, 1), both([false; 3], 1));
    assert_eq!(stops!(Universal, 1, 2), both([true; 3], 2));
    assert_eq!(stops!(Hinge2, 1), both([true; 3], 1));
    assert_eq!(stops!(PR, 1, 2), both([false, true, true], 2));
    assert_eq!(stops!(PU, 1, 2, 3), both([true, true, false], 3));
    assert_eq!(stops!(Piston, 1, 2), both([false, true, true], 2));
    let motor = numbers::<AMotor>(|joint| {
        joint.set_axis_count(1);
        joint.set_axis(0, AxisFrame::World, Vec3::X).unwrap();
        joint.set_limits_of(1, low, high).unwrap();
    });
    assert_eq!(motor, both([true; 3], 1));
    assert!(numbers::<Hinge>(|_| {}).is_empty(), "no stops, nothing to see");
}

#[test]
fn a_pendulum_at_its_stop_has_its_hand_on_it() {
    let mut world = World::new();
    world.set_gravity(Vec3::new(0.0, 0.0, -9.81)).unwrap();
    let ball = BodyBuilder::new().at(Vec3::new(0.5, 0.0, 0.0)).with_shape(Sphere::new(0.1).unwrap(), 1e3);
    let ball = world.add_body(ball).unwrap();
    for reversed in [false, true] {
        let mut world = world.clone();
        let joint = world.create_joint::<Hinge>(None).unwrap();
        let ends = if reversed { [None, Some(ball)] } else { [Some(ball), None] };
        world.attach(joint, ends[0], ends[1]).unwrap();
        let mut hinge = world.joint_mut::<Hinge>(joint).unwrap();
        hinge.set_anchor(Vec3::ZERO).unwrap();
        hinge.set_axis(Vec3::Y).unwrap();
        hinge.set_limits(-0.7, 0.7).unwrap();
        let marks = |world: &World| joint_marks(world.dynamics(), joint).unwrap().ranges[0];
        let start = marks(&world);
        let stops: Vec<Vec3> = start.stops().map(|stop| start.place(stop, 1.0)).collect();
        // It falls down to a stop and comes to rest on it; the stops, in the world, stay where they were.
        world.stepper = Stepper::Direct;
        for _ in 0..600 {
            world.step(0.005).unwrap();
            let now = marks(&world);
            for (stop, was) in now.stops().zip(&stops) {
                assert!((now.place(stop, 1.0) - *was).length() < 2e-3, "stops don't turn along");
            }
        }
        let end = marks(&world);
        let lines = overlay::range_lines(&end, 1.0);
        let [from, hand] = *lines.last().unwrap();
        assert!(from.length() < 1e-3);
        let away = stops.iter().map(|stop| (hand / hand.length() - *stop).length()).fold(1.0, f64::min);
        assert!(away < 0.02, "the hand lies {away} rad from the nearest stop");
        // The ball itself hangs 0.7 rad below the horizon, and the hand turned as far.
        let down = world.body(ball).unwrap().position();
        assert!((ferrode::math::real::atan2(-down.z, down.x) - 0.7).abs() < 0.02, "{down:?}");
        let began = start.place(start.limit.position, 1.0);
        assert!((began.dot(hand / hand.length()) - ferrode::math::real::cos(0.7)).abs() < 0.02);
    }
}

#[test]
fn a_body_at_the_stop_of_its_slider_is_at_the_end_of_its_rail() {
    let mut world = World::new();
    world.set_gravity(Vec3::new(0.0, 0.0, -9.81)).unwrap();
    let ball = world.add_body(BodyBuilder::new().with_shape(Sphere::new(0.1).unwrap(), 1e3)).unwrap();
    let axis = Vec3::new(0.6, 0.0, 0.8);
    let slider = world.create_joint::<Slider>(None).unwrap();
    world.attach(slider, Some(ball), None).unwrap();
    world.joint_mut::<Slider>(slider).unwrap().set_axis(axis).unwrap();
    world.joint_mut::<Slider>(slider).unwrap().set_limits(-0.5, 0.2).unwrap();
    let marks = |world: &World| joint_marks(world.dynamics(), slider).unwrap().ranges[0];
    let rail = overlay::range_lines(&marks(&world), 1.0)[0];
    assert!((rail[0] + axis * 0.5).length() < 1e-9 && (rail[1] - axis * 0.2).length() < 1e-9, "{rail:?}");
    world.stepper = Stepper::Direct;
    for _ in 0..400 {
        world.step(0.005).unwrap();
    }
    assert!((world.body(ball).unwrap().position() - rail[0]).length() < 0.01);
    let now = overlay::range_lines(&marks(&world), 1.0)[0];
    assert!((now[0] - rail[0]).length() < 1e-3 && (now[1] - rail[1]).length() < 1e-3, "the rail stays");
}
