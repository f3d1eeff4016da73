//! What a camera can see.

use crate::{Camera, Scene};
use ferrode_math::{Vec3, real};

/// The pyramid between the eye and the picture's edges.
#[derive(Clone, Copy, Debug)]
pub struct ViewCone {
    /// Relative to the scene's origin.
    eye: Vec3,
    forward: Vec3,
    /// Unit normals of the four sides, inward.
    sides: [Vec3; 4],
    near: f64,
    /// Pixels that a metre fills at a distance of a metre.
    scale: f64,
}

impl ViewCone {
    /// Of a camera, for a picture of a size.
    pub fn new(camera: &Camera, scene: &Scene, [width, height]: [u32; 2]) -> Self {
        let [right, up, forward] = camera.directions();
        let tall = real::tan(0.5 * camera.field_of_view);
        let wide = tall * f64::from(width) / f64::from(height.max(1));
        let side = |across: Vec3, reach: f64| (forward * reach - across).normalized_or(forward);
        Self {
            eye: camera.eye - scene.origin,
            forward,
            sides: [side(right, wide), side(-right, wide), side(up, tall), side(-up, tall)],
            near: camera.near(),
            scale: 0.5 * f64::from(height) / tall,
        }
    }

    /// Whether a ball may be seen: some beside the corners are let through.
    pub fn holds(&self, (centre, radius): (Vec3, f64)) -> bool {
        let p = centre - self.eye;
        p.dot(self.forward) + radius >= self.near
            && self.sides.iter().all(|side| p.dot(*side) + radius >= 0.0)
    }

    /// The radius of a ball in the picture, in pixels; infinite for one around the eye.
    pub fn pixels(&self, (centre, radius): (Vec3, f64)) -> f64 {
        let depth = (centre - self.eye).dot(self.forward);
        if depth > radius { self.scale * radius / depth } else { f64::INFINITY }
    }
}

#[cfg(test)]
mod tests {
    use super::ViewCone;
    use crate::{Camera, Scene};
    use ferrode_math::Vec3;

    #[test]
    fn balls_are_held_as_long_as_a_part_of_them_is_in_the_picture() {
        let camera = Camera::look_at(Vec3::new(3.0, -2.0, 1.5), Vec3::new(0.2, 0.1, 0.3));
        let size = [640, 360];
        let cone = ViewCone::new(&camera, &Scene::new(), size);
        let [_, _, forward] = camera.directions();
        for (pixel, depth, radius, held) in [
            ([320.0, 180.0], 3.0, 0.1, true),
            ([-5.0, 180.0], 3.0, 0.1, true),
            ([-200.0, 180.0], 3.0, 0.1, false),
            ([320.0, 362.0], 3.0, 0.1, true),
            ([320.0, 500.0], 3.0, 0.1, false),
            ([320.0, 180.0], -3.0, 0.1, false),
            ([320.0, 180.0], -3.0, 4.0, true),
        ] {
            let along = camera.ray(pixel, size);
            let centre = camera.eye + along * (depth / along.dot(forward));
            assert_eq!(cone.holds((centre, radius)), held, "{pixel:?} {depth} {radius}");
        }
        // A metre at ten metres, as the camera projects it.
        let [right, ..] = camera.directions();
        let centre = camera.eye + forward * 10.0;
        let ([left, _], [edge, _]) =
            (camera.project(centre, size).unwrap().0, camera.project(centre + right, size).unwrap().0);
        assert!((cone.pixels((centre, 1.0)) - (edge - left)).abs() < 1e-9);
    }
}
