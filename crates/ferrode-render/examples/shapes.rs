//! Draws one of each shape into a picture: `cargo run --example shapes -- OUT.png [live | SAMPLES,MAP,TAPS]`.

use ferrode_math::{Pose, Quat, Vec3};
use ferrode_render::{Camera, Canvas, Color, Ground, Layer, Mesh, Paint, Pattern, Quality, Scene};
use std::sync::Arc;

fn scene() -> Scene {
    let mut scene = Scene::new();
    scene.ground(Ground::default());
    let at = |x: f64, y: f64, z: f64, turn: f64| {
        Pose::new(
            Vec3::new(x, y, z),
            Quat::from_axis_angle(Vec3::new(0.0, 0.3, 1.0).normalized_or(Vec3::Z), turn),
        )
    };
    let paint = |n: usize| Paint::from(Color::of(n));
    let aside = Quat::from_axis_angle(Vec3::X, std::f64::consts::FRAC_PI_2);
    scene.cuboid(
        &Pose::new(Vec3::new(0.0, 0.0, 0.5), Quat::from_axis_angle(Vec3::Z, 0.4)),
        Vec3::splat(1.0),
        paint(0),
    );
    scene.cuboid(&Pose::from_position(Vec3::new(0.1, 0.0, 1.15)), Vec3::new(1.4, 0.5, 0.3), paint(5));
    scene.sphere(&at(-1.6, -0.6, 0.5, 0.5), 0.5, paint(1).with_pattern(Pattern::Octants));
    scene.capsule(&Pose::new(Vec3::new(1.6, 0.6, 0.3), aside), 0.3, 1.0, paint(2));
    scene.cylinder(&Pose::from_position(Vec3::new(-1.4, 1.2, 0.4)), 0.4, 0.8, paint(3));
    scene.cone(&Pose::from_position(Vec3::new(0.4, 1.8, 0.5)), 0.5, 1.0, paint(4));
    scene.ellipsoid(&at(1.4, -1.0, 0.3, 0.3), Vec3::new(0.6, 0.4, 0.3), paint(6));
    scene.cuboid(
        &Pose::from_position(Vec3::new(-0.6, -1.7, 0.15)),
        Vec3::new(1.0, 0.3, 0.3),
        paint(2).with_pattern(Pattern::Wood),
    );
    scene.cuboid(
        &Pose::from_position(Vec3::new(2.6, 1.9, 0.4)),
        Vec3::splat(0.8),
        Paint::from(Color::BLUE.with_alpha(0.4)),
    );
    let corners = [
        Vec3::new(-0.5, -0.4, 0.0),
        Vec3::new(0.5, -0.4, 0.0),
        Vec3::new(0.0, 0.5, 0.0),
        Vec3::new(0.0, 0.0, 0.9),
    ];
    let tetrahedron = Arc::new(Mesh::new(&corners, &[[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]]));
    scene.mesh(&Pose::from_position(Vec3::new(-2.8, 0.5, 0.0)), &tetrahedron, Vec3::splat(1.0), paint(7));
    scene.arrow(
        Vec3::new(0.0, 0.0, 0.5),
        Vec3::new(0.0, 0.0, 2.2),
        0.02,
        Paint::from(Color::RED).glowing(),
        Layer::Over,
    );
    scene.wire_box(
        &Pose::from_position(Vec3::new(-1.6, -0.6, 0.5)),
        Vec3::splat(1.0),
        1.5,
        Color::BLACK,
        Layer::World,
    );
    // A wall in the back, to see many.
    for i in 0..10 {
        for j in 0..6 {
            let shift = f64::from(j % 2) * 0.3;
            let p = Vec3::new(-3.0 + 0.62 * f64::from(i) + shift, 4.0, 0.15 + 0.3 * f64::from(j));
            scene.cuboid(
                &Pose::from_position(p),
                Vec3::new(0.6, 0.3, 0.3),
                Paint::from(Color::rgb(214, 170, 130)),
            );
        }
    }
    scene
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let args: Vec<String> = std::env::args().skip(1).collect();
    let out = args.first().map_or("shapes.png", String::as_str);
    let quality =
        match args.get(1).map(|text| text.split(',').map(str::parse).collect::<Result<Vec<u32>, _>>()) {
            None => Quality::fine(),
            Some(Ok(numbers)) if numbers.len() == 3 => Quality {
                samples: numbers[0],
                shadow_map: numbers[1],
                shadow_samples: numbers[2],
                ..Quality::live()
            },
            Some(_) => Quality::live(),
        };
    let mut canvas = Canvas::new(1280, 720, quality)?;
    println!("{}", canvas.gpu().name());
    let camera = Camera::look_at(Vec3::new(3.2, -6.0, 3.4), Vec3::new(-0.1, 0.5, 0.5));
    let scene = scene();
    let picture = canvas.draw(&scene, &camera)?;
    let start = std::time::Instant::now();
    for _ in 0..10 {
        canvas.draw(&scene, &camera)?;
    }
    println!("{:.1} ms a picture", start.elapsed().as_secs_f64() * 100.0);
    image::save_buffer(out, &picture.pixels, picture.width, picture.height, image::ColorType::Rgba8)?;
    Ok(())
}
