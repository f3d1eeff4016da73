//! Pictures of worlds hold their bodies where the engine's own rays meet them, and overlays show the engine's values.

mod common;

use common::canvas;
use ferrode::prelude::*;
use ferrode::{Cone, Convex, Ellipsoid, Heightfield, Hinge, TriMesh};
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
    ];
    let axis = Vec3::new(0.3, 0.5, 0.8).normalized_or(Vec3::Z);
    for (n, shape) in shapes.into_iter().enumerate() {
        let (column, row) = ((n % 4) as f64, (n / 4) as f64);
        let at = Vec3::new(1.3 * column - 2.0, 1.4 * row - 0.7, 0.8);
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
