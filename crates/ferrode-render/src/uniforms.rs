//! A scene's numbers as the shader wants them.

use crate::mesh::to_f32;
use crate::shadow::SunView;
use crate::{Camera, Ground, Scene};
use ferrode_math::Vec3;

/// The shader's `Globals`.
pub fn globals(scene: &Scene, camera: &Camera, sun: &SunView, size: [u32; 2], shadow_side: u32) -> [f32; 64] {
    let aspect = f64::from(size[0]) / f64::from(size[1]);
    let tall = ferrode_math::real::tan(0.5 * camera.field_of_view);
    let axes = camera.axes();
    let four = |v: Vec3, w: f64| {
        let [x, y, z] = to_f32(v);
        [x, y, z, w as f32]
    };
    let tint = |color: crate::Color, w: f32| {
        let [r, g, b, _] = color.linear();
        [r, g, b, w]
    };
    let fade = (7.0 * camera.distance()).max(8.0);
    let vectors: [[f32; 4]; 16] = {
        let c = camera.clip_matrix(scene.origin, aspect);
        let s = sun.clip;
        [
            c[0],
            c[1],
            c[2],
            c[3],
            s[0],
            s[1],
            s[2],
            s[3],
            four(camera.eye - scene.origin, camera.near()),
            four(sun.direction, f64::from(scene.light.strength)),
            tint(scene.sky.zenith, scene.light.shadow),
            tint(scene.sky.horizon, fade as f32),
            four(axes.right * (tall * aspect), f64::from(scene.sky.clouds.clamp(0.0, 1.0))),
            four(axes.up * tall, 0.0),
            four(axes.forward, 0.0),
            [size[0] as f32, size[1] as f32, shadow_side as f32, sun.texel as f32],
        ]
    };
    core::array::from_fn(|n| vectors[n / 4][n % 4])
}

/// Patterns on a ground look the same so much further, m (`PERIOD` in the shader).
const PATTERN_PERIOD: f64 = 64.0;

/// A ground as the shader wants it.
pub fn plane(ground: &Ground, origin: Vec3, camera: &Camera) -> [f32; 20] {
    let normal = ground.normal.normalized_or(Vec3::Z);
    let aside = if normal.x.abs() < 0.9 { Vec3::X } else { Vec3::Y };
    let first = (aside - normal * aside.dot(normal)).normalized_or(Vec3::X);
    let second = normal.cross(first);
    let middle = camera.target - normal * (camera.target - ground.point).dot(normal);
    // The grid counts from the crossing nearest to the middle, of those at whole tens of steps from the given point: single
    // precision is enough there.
    let (grid, tens) = match ground.pattern {
        crate::Pattern::Plain => (ground.grid, ground.grid * 10.0),
        _ => (0.0, PATTERN_PERIOD),
    };
    let snap = |axis: Vec3| {
        let along = (middle - ground.point).dot(axis);
        if tens > 0.0 { (along / tens).round() * tens } else { along }
    };
    let point = ground.point + first * snap(first) + second * snap(second);
    let reach = (60.0 * camera.distance()).max(60.0);
    let mut out = [0.0; 20];
    let parts = [(point - origin, grid), (first, reach), (second, 0.0)];
    for (n, (v, w)) in parts.into_iter().enumerate() {
        out[4 * n..4 * n + 3].copy_from_slice(&to_f32(v));
        out[4 * n + 3] = w as f32;
    }
    out[12..16].copy_from_slice(&ground.color.linear());
    out[16..19].copy_from_slice(&to_f32(middle - origin));
    out[19] = f32::from(ground.pattern as u8);
    out
}
