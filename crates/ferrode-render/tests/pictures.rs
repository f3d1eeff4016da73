//! Pictures hold what they must: each shape covers the pixels that it covers in the camera's eyes, and no others.
//!
//! The tests ask for a Vulkan or OpenGL driver (software will do) and say so when there is none.

use ferrode_math::{Pose, Quat, Vec3};
use ferrode_render::{
    Camera, Canvas, Color, Ground, Layer, Mesh, Paint, Picture, Quality, RenderError, Scene,
};
use std::sync::Arc;

const SIZE: [u32; 2] = [320, 200];

/// A canvas, or `None` (said loudly) without a driver.
fn canvas(quality: Quality) -> Option<Canvas> {
    match Canvas::new(SIZE[0], SIZE[1], quality) {
        Ok(canvas) => Some(canvas),
        Err(error @ RenderError::NoDriver(_)) if std::env::var_os("FERRODE_NEEDS_DRIVER").is_none() => {
            eprintln!("SKIPPED: {error}");
            None
        }
        Err(error) => panic!("{error}"),
    }
}

fn camera() -> Camera {
    Camera::look_at(Vec3::new(2.6, -3.2, 2.2), Vec3::new(0.1, 0.0, 0.6))
}

/// Red things before anything else: nothing in sky or ground is as red.
fn is_red([r, g, b, _]: [u8; 4]) -> bool {
    r > 70 && u32::from(r) > 2 * u32::from(g) && u32::from(r) > 2 * u32::from(b)
}

/// Red without highlights: silhouettes are looked at, not light.
fn red() -> Paint {
    Paint::from(Color::rgb(230, 30, 30)).glowing()
}

/// Draws one thing over ground, and compares each pixel with whether the ray through it meets the thing, leaving out a border
/// of `border` pixels.
fn compare(name: &str, border: i32, add: impl Fn(&mut Scene), hit: impl Fn(Vec3, Vec3) -> bool) {
    for quality in [Quality::live(), Quality { shadow_map: 256, ..Quality::fine() }] {
        let Some(mut canvas) = canvas(quality) else { return };
        let mut scene = Scene::new();
        scene.ground(Ground::default());
        add(&mut scene);
        let camera = camera();
        let picture = canvas.draw(&scene, &camera).unwrap();
        let meets = |x: i32, y: i32| {
            let along = camera.ray([f64::from(x) + 0.5, f64::from(y) + 0.5], SIZE);
            hit(camera.eye, along)
        };
        let (mut covered, mut wrong) = (0, 0);
        for y in 0..SIZE[1] as i32 {
            for x in 0..SIZE[0] as i32 {
                let inside = meets(x, y);
                let near = (-border..=border).step_by(border as usize);
                let clear = near.clone().all(|dx| near.clone().all(|dy| meets(x + dx, y + dy) == inside));
                if clear {
                    covered += u32::from(inside);
                    let seen = is_red(picture.pixel(x as u32, y as u32).unwrap());
                    wrong += u32::from(seen != inside);
                }
            }
        }
        assert!(covered > 800, "{name} covers {covered} pixels only: the test says little");
        assert_eq!(wrong, 0, "{name}: pixels that are red and should not be, or the other way round");
    }
}

fn pose() -> Pose {
    let axis = Vec3::new(1.0, 2.0, 0.5).normalized().unwrap();
    Pose::new(Vec3::new(0.1, 0.1, 0.9), Quat::from_axis_angle(axis, 0.7))
}

/// Whether a ray comes within a distance of a segment: that of a capsule.
fn near_segment(eye: Vec3, along: Vec3, a: Vec3, b: Vec3, radius: f64) -> bool {
    (0..=400).any(|i| {
        let p = a.lerp(b, f64::from(i) / 400.0) - eye;
        (p - along * p.dot(along)).length() < radius
    })
}

#[test]
fn a_ball_is_where_it_is() {
    let centre = pose().position;
    compare(
        "ball",
        2,
        |scene| scene.sphere(&pose(), 0.6, red()),
        |eye, along| near_segment(eye, along, centre, centre, 0.6),
    );
}

#[test]
fn a_box_is_where_it_is() {
    let sides = Vec3::new(1.0, 0.6, 1.4);
    let hit = |eye: Vec3, along: Vec3| {
        let (eye, along) = (pose().inverse_transform_point(eye), pose().inverse_transform_vector(along));
        let (mut enter, mut leave) = (0.0_f64, f64::INFINITY);
        for (o, d, h) in [(eye.x, along.x, 0.5), (eye.y, along.y, 0.3), (eye.z, along.z, 0.7)] {
            let (t1, t2) = ((-h - o) / d, (h - o) / d);
            (enter, leave) = (enter.max(t1.min(t2)), leave.min(t1.max(t2)));
        }
        enter < leave
    };
    compare("box", 2, |scene| scene.cuboid(&pose(), sides, red()), hit);
}

#[test]
fn a_capsule_is_where_it_is() {
    let end = |z: f64| pose().transform_point(Vec3::new(0.0, 0.0, z));
    compare(
        "capsule",
        2,
        |scene| scene.capsule(&pose(), 0.3, 1.0, red()),
        |eye, along| near_segment(eye, along, end(-0.5), end(0.5), 0.3),
    );
}

#[test]
fn cylinders_cones_and_ellipsoids_are_where_they_are() {
    // Sampled: along the ray, is a point inside?
    let sampled = |inside: &dyn Fn(Vec3) -> bool, eye: Vec3, along: Vec3| {
        let (eye, along) = (pose().inverse_transform_point(eye), pose().inverse_transform_vector(along));
        (0..700).any(|i| inside(eye + along * (2.5 + 0.005 * f64::from(i))))
    };
    let flat = |p: Vec3| Vec3::new(p.x, p.y, 0.0).length();
    let cylinder = |p: Vec3| flat(p) < 0.5 && p.z.abs() < 0.6;
    compare(
        "cylinder",
        3,
        |scene| scene.cylinder(&pose(), 0.5, 1.2, red()),
        |eye, along| sampled(&cylinder, eye, along),
    );
    let cone = |p: Vec3| p.z.abs() < 0.6 && flat(p) < 0.5 * (0.6 - p.z) / 1.2;
    compare("cone", 3, |scene| scene.cone(&pose(), 0.5, 1.2, red()), |eye, along| sampled(&cone, eye, along));
    let ellipsoid = |p: Vec3| Vec3::new(p.x / 0.8, p.y / 0.4, p.z / 0.5).length() < 1.0;
    compare(
        "ellipsoid",
        3,
        |scene| scene.ellipsoid(&pose(), Vec3::new(0.8, 0.4, 0.5), red()),
        |eye, along| sampled(&ellipsoid, eye, along),
    );
}

/// Whether a ray meets a triangle (Möller and Trumbore, 1997).
fn meets_triangle(eye: Vec3, along: Vec3, [a, b, c]: [Vec3; 3]) -> bool {
    let (e1, e2) = (b - a, c - a);
    let p = along.cross(e2);
    let det = e1.dot(p);
    let s = (eye - a) * (1.0 / det);
    let (u, v) = (s.dot(p), s.cross(e1).dot(along));
    u >= 0.0 && v >= 0.0 && u + v <= 1.0
}

#[test]
fn meshes_and_loose_triangles_are_where_they_are() {
    let corners = [Vec3::new(-0.8, -0.3, -0.5), Vec3::new(0.9, -0.2, -0.3), Vec3::new(0.0, 0.6, 0.8)];
    let inside =
        |eye: Vec3, along: Vec3| meets_triangle(eye, along, corners.map(|c| pose().transform_point(c)));
    let mesh = Arc::new(Mesh::new(&corners, &[[0, 1, 2]]));
    let scale = Vec3::splat(1.0);
    compare("mesh", 2, |scene| scene.mesh(&pose(), &mesh, scale, red()), inside);
    compare("triangle", 2, |scene| scene.triangles(&pose(), &[corners], red()), inside);
}

#[test]
fn far_from_the_origin_things_are_as_sharp() {
    let far = Vec3::new(4.0e6, -7.0e6, 2.0e5);
    let Some(mut canvas) = canvas(Quality::live()) else { return };
    let draw = |canvas: &mut Canvas, shift: Vec3| -> Picture {
        let mut scene = Scene::around(shift);
        scene.ground(Ground { point: shift, ..Ground::default() });
        scene.cuboid(&Pose::new(pose().position + shift, pose().rotation), Vec3::splat(1.0), red());
        let near = camera();
        canvas.draw(&scene, &Camera { eye: near.eye + shift, target: near.target + shift, ..near }).unwrap()
    };
    let (here, there) = (draw(&mut canvas, Vec3::ZERO), draw(&mut canvas, far));
    let differ = here.pixels.iter().zip(&there.pixels).filter(|(a, b)| a.abs_diff(**b) > 24).count();
    assert!(differ < 400, "{differ} of {} bytes differ", here.pixels.len());
}

#[test]
fn a_ball_throws_its_shadow_away_from_the_sun() {
    let Some(mut canvas) = canvas(Quality::live()) else { return };
    let mut scene = Scene::new();
    scene.light.from = Vec3::new(0.5, 0.0, 1.0);
    scene.ground(Ground { grid: 0.0, ..Ground::default() });
    let ball = Pose::from_position(Vec3::new(0.0, 0.0, 1.0));
    scene.sphere(&ball, 0.3, Paint::from(Color::RED));
    let camera = camera();
    let picture = canvas.draw(&scene, &camera).unwrap();
    let brightness = |p: Vec3| {
        let ([x, y], _) = camera.project(p, SIZE).unwrap();
        let [r, g, b, _] = picture.pixel(x as u32, y as u32).unwrap();
        u32::from(r) + u32::from(g) + u32::from(b)
    };
    // From (0, 0, 1) down along (−0.5, 0, −1).
    let (shadow, mirrored) = (brightness(Vec3::new(-0.5, 0.0, 0.0)), brightness(Vec3::new(0.5, 0.0, 0.0)));
    assert!(shadow + 90 < mirrored, "{shadow} in the shadow, {mirrored} outside");
}

#[test]
fn lines_and_the_layer_over_all() {
    let Some(mut canvas) = canvas(Quality::live()) else { return };
    let (a, b) = (Vec3::new(-1.0, 0.3, 0.8), Vec3::new(1.0, -0.2, 0.9));
    for (layer, seen) in [(Layer::World, false), (Layer::Over, true)] {
        let mut scene = Scene::new();
        scene.line(a, b, 4.0, Color::rgb(255, 0, 0), layer);
        // A wall between the line's middle and the eye, that leaves its ends free.
        let camera = camera();
        let middle = a.lerp(b, 0.5);
        let wall = middle.lerp(camera.eye, 0.3);
        scene.sphere(&Pose::from_position(wall), 0.25, Paint::from(Color::BLUE));
        let picture = canvas.draw(&scene, &camera).unwrap();
        let red_at = |t: f64| {
            let ([x, y], _) = camera.project(a.lerp(b, t), SIZE).unwrap();
            is_red(picture.pixel(x as u32, y as u32).unwrap())
        };
        assert!(red_at(0.05) && red_at(0.95), "{layer:?}: the ends are free");
        assert_eq!(red_at(0.5), seen, "{layer:?}");
    }
}

#[test]
fn glass_lets_what_is_behind_shine_through() {
    let Some(mut canvas) = canvas(Quality::live()) else { return };
    let camera = camera();
    let mut scene = Scene::new();
    let behind = camera.target + (camera.target - camera.eye).normalized().unwrap() * 0.8;
    scene.sphere(&Pose::from_position(behind), 0.4, red());
    let alone = canvas.draw(&scene, &camera).unwrap().pixel(160, 100).unwrap();
    scene.sphere(
        &Pose::from_position(camera.target),
        0.3,
        Paint::from(Color::BLUE.with_alpha(0.5)).glowing(),
    );
    let both = canvas.draw(&scene, &camera).unwrap().pixel(160, 100).unwrap();
    assert!(both[2] > alone[2] + 60 && both[0] > 120, "{alone:?} {both:?}");
}

#[test]
fn sizes_that_cannot_be_are_refused() {
    let Some(canvas) = canvas(Quality::live()) else { return };
    let most = canvas.gpu().largest();
    for (width, height) in [(0, 10), (10, 0), (most + 1, 10)] {
        let error = Canvas::on(canvas.gpu().clone(), width, height, Quality::live()).unwrap_err();
        assert_eq!(error, RenderError::Size { width, height, most });
        assert!(error.to_string().contains(&format!("{width}x{height}")));
    }
}
