//! What the sun sees: the box of light that holds everything that throws a shadow.

use crate::Light;
use crate::camera::transposed;
use ferrode_math::Vec3;

/// The shadow map's place in the world.
#[derive(Clone, Copy, Debug)]
pub struct SunView {
    /// Unit vector to the sun.
    pub direction: Vec3,
    /// From positions relative to the scene's origin to the map: x and y from −1 to 1, z from 0 (nearest to the sun) to 1.
    pub clip: [[f32; 4]; 4],
    /// Metres a texel.
    pub texel: f64,
}

/// Fits the map around balls (centre, radius), leaving out what is further than `reach` from `middle`: shadows far away
/// would only make those nearby coarse.
pub fn sun_view(
    light: &Light,
    balls: impl Iterator<Item = (Vec3, f64)>,
    middle: Vec3,
    reach: f64,
    texels: u32,
) -> SunView {
    let direction = light.from.normalized_or(Vec3::Z);
    let aside = if direction.z.abs() < 0.99 { Vec3::Z } else { Vec3::X };
    let right = aside.cross(direction).normalized_or(Vec3::X);
    let up = direction.cross(right);
    let (mut low, mut high) = (Vec3::splat(f64::INFINITY), Vec3::splat(f64::NEG_INFINITY));
    for (centre, radius) in balls {
        if (centre - middle).length() - radius > reach {
            continue;
        }
        let seen = Vec3::new(centre.dot(right), centre.dot(up), centre.dot(direction));
        let radius = Vec3::splat(radius.min(reach));
        (low, high) = (low.min(seen - radius), high.max(seen + radius));
    }
    if !(low.is_finite() && high.is_finite()) {
        (low, high) = (Vec3::splat(-1.0), Vec3::splat(1.0));
    }
    // In steps of a power of two and of whole texels, so that shadows don't crawl when bodies move.
    let texels = f64::from(texels.max(1));
    let need = (high.x - low.x).max(high.y - low.y) * 1.02 + 1e-6;
    let side = step_up(need);
    let texel = side / texels;
    let snap = |x: f64| (x / texel).floor() * texel;
    let (x, y) = (snap(0.5 * (low.x + high.x)), snap(0.5 * (low.y + high.y)));
    let (near, far) = (high.z + 0.01, low.z - 0.05 * side);
    let scale = 2.0 / side;
    let row = |axis: Vec3, s: f64, shift: f64| [axis.x * s, axis.y * s, axis.z * s, shift];
    let depth = 1.0 / (near - far);
    let rows = [
        row(right, scale, -x * scale),
        row(up, scale, -y * scale),
        row(direction, -depth, near * depth),
        [0.0, 0.0, 0.0, 1.0],
    ];
    SunView { direction, clip: transposed(&rows), texel }
}

/// The next of the numbers 2ⁿ·{1, 1.25, 1.5, 1.75} above.
fn step_up(x: f64) -> f64 {
    let mut base = 1e-3;
    while base * 2.0 < x {
        base *= 2.0;
    }
    [1.0, 1.25, 1.5, 1.75, 2.0].map(|f| f * base).into_iter().find(|s| *s >= x).unwrap_or(x)
}

#[cfg(test)]
mod tests {
    use super::sun_view;
    use crate::Light;
    use ferrode_math::Vec3;

    #[test]
    fn all_balls_fall_into_the_map() {
        let balls = [(Vec3::new(1.0, 2.0, 3.0), 0.5), (Vec3::new(-4.0, 0.0, 0.1), 1.0)];
        let view = sun_view(&Light::default(), balls.iter().copied(), Vec3::ZERO, 50.0, 1024);
        for (centre, radius) in balls {
            for side in [Vec3::X, -Vec3::X, Vec3::Y, -Vec3::Y, Vec3::Z, -Vec3::Z] {
                let p = centre + side * radius;
                let p = [p.x as f32, p.y as f32, p.z as f32, 1.0];
                let clip: [f32; 4] =
                    core::array::from_fn(|row| (0..4).map(|k| view.clip[k][row] * p[k]).sum());
                assert!(
                    clip[0].abs() <= 1.0 && clip[1].abs() <= 1.0 && clip[2] >= 0.0 && clip[2] <= 1.0,
                    "{clip:?}"
                );
            }
        }
        assert!(view.texel < 0.02);
    }
}
