//! The camera in the user's hand: it orbits a point, and flies.

use ferrode_math::{Aabb, Vec3};
use ferrode_render::Camera;

/// A camera that turns about a point.
#[derive(Clone, Copy, Debug)]
pub struct Orbit {
    target: Vec3,
    distance: f64,
    /// About z from +x, rad.
    heading: f64,
    /// Above the horizon, rad.
    pitch: f64,
}

/// Radians a pixel.
const TURN: f64 = 0.006;
/// As near to straight down as the camera goes, rad.
const STEEPEST: f64 = 1.55;

impl Orbit {
    /// One that sees what a camera sees.
    pub fn from_camera(camera: &Camera) -> Self {
        use ferrode_math::real::{asin, atan2};
        let back = camera.eye - camera.target;
        let distance = back.length().max(1e-6);
        Self {
            target: camera.target,
            distance,
            heading: atan2(back.y, back.x),
            pitch: asin((back.z / distance).clamp(-1.0, 1.0)).clamp(-STEEPEST, STEEPEST),
        }
    }

    /// The camera.
    pub fn camera(&self) -> Camera {
        Camera::orbit(self.target, self.distance, self.heading, self.pitch)
    }

    /// The camera, moved aside so that the target is in the middle of a picture whose last columns, `covered` pixels of them, are
    /// behind something else; `height` is that of the picture in pixels.
    pub fn camera_beside(&self, covered: f64, height: f64) -> Camera {
        let mut camera = self.camera();
        let aside = camera.directions()[0] * (0.5 * covered * self.metres_a_pixel(height));
        camera.eye += aside;
        camera.target += aside;
        camera
    }

    /// Metres at the target's depth a pixel of a picture of a height.
    fn metres_a_pixel(&self, height: f64) -> f64 {
        let tall = ferrode_math::real::tan(0.5 * self.camera().field_of_view);
        2.0 * self.distance * tall / height.max(1.0)
    }

    /// Turns about the target by a move of the mouse in pixels.
    pub fn turn(&mut self, dx: f64, dy: f64) {
        self.heading -= dx * TURN;
        self.pitch = (self.pitch + dy * TURN).clamp(-STEEPEST, STEEPEST);
    }

    /// Moves sideways and up with the mouse, so that the target stays under it; `height` is that of the picture in pixels.
    pub fn pan(&mut self, dx: f64, dy: f64, height: f64) {
        let [right, up, _] = self.camera().directions();
        self.target += (up * dy - right * dx) * self.metres_a_pixel(height);
    }

    /// Goes nearer (positive) or farther.
    pub fn zoom(&mut self, notches: f64) {
        self.distance = (self.distance * ferrode_math::real::exp(-0.12 * notches)).clamp(0.01, 1e5);
    }

    /// Goes farther by a factor.
    pub fn back_off(&mut self, factor: f64) {
        self.distance *= factor;
    }

    /// Flies: to the right, up and forward, in distances to the target a second.
    pub fn fly(&mut self, [x, y, z]: [f64; 3], seconds: f64) {
        let [right, _, forward] = self.camera().directions();
        self.target += (right * x + Vec3::Z * y + forward * z) * (self.distance * seconds);
    }

    /// The point that it turns about.
    pub fn target(&self) -> Vec3 {
        self.target
    }

    /// Looks at another point.
    pub fn look_at(&mut self, target: Vec3) {
        self.target = target;
    }

    /// Sees the whole of a box, from where it is.
    pub fn frame(&mut self, bounds: &Aabb, aspect: f64) {
        *self = Self::from_camera(&Camera::framing(bounds, self.heading, self.pitch, aspect));
    }
}

#[cfg(test)]
mod tests {
    use super::Orbit;
    use ferrode_math::Vec3;
    use ferrode_render::Camera;

    #[test]
    fn it_starts_where_the_camera_was_and_pans_with_the_mouse() {
        let camera = Camera::look_at(Vec3::new(3.0, -2.0, 1.5), Vec3::new(0.2, 0.1, 0.3));
        let mut orbit = Orbit::from_camera(&camera);
        let same = orbit.camera();
        assert!((same.eye - camera.eye).length() < 1e-9);
        let point = camera.target;
        let (before, _) = orbit.camera().project(point, [800, 600]).unwrap();
        orbit.pan(30.0, -20.0, 600.0);
        let (after, _) = orbit.camera().project(point, [800, 600]).unwrap();
        assert!((after[0] - before[0] - 30.0).abs() < 1e-6 && (after[1] - before[1] + 20.0).abs() < 1e-6);
    }

    #[test]
    fn beside_a_panel_the_target_is_in_the_middle_of_the_rest() {
        let camera = Camera::look_at(Vec3::new(3.0, -2.0, 1.5), Vec3::new(0.2, 0.1, 0.3));
        let orbit = Orbit::from_camera(&camera);
        let (at, _) = orbit.camera_beside(200.0, 600.0).project(orbit.target(), [800, 600]).unwrap();
        assert!((at[0] - 300.0).abs() < 1e-6 && (at[1] - 300.0).abs() < 1e-6, "{at:?}");
    }
}
