//! The camera: where the eye is, where it looks, and which pixel a point falls on.

use ferrode_math::{Aabb, Vec3, real};

/// A camera with perspective.
///
/// Pixels are counted from the upper left corner, x to the right and y down; a pixel's middle is at half numbers.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Camera {
    /// The eye.
    pub eye: Vec3,
    /// A point in the middle of the picture.
    pub target: Vec3,
    /// A direction that is up in the picture; it need not be square to the line of sight.
    pub up: Vec3,
    /// Angle from the lower to the upper edge of the picture, rad.
    pub field_of_view: f64,
}

/// The camera's axes in the world: right, up, forward.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Axes {
    pub right: Vec3,
    pub up: Vec3,
    pub forward: Vec3,
}

impl Camera {
    /// Looks from one point at another, z up, 40° from bottom to top.
    pub fn look_at(eye: Vec3, target: Vec3) -> Self {
        Self { eye, target, up: Vec3::Z, field_of_view: 40.0_f64.to_radians() }
    }

    /// Looks at `target` from `distance` away: from `heading` rad about z (0: from +x), `pitch` rad above the horizon.
    pub fn orbit(target: Vec3, distance: f64, heading: f64, pitch: f64) -> Self {
        let level = real::cos(pitch);
        let back = Vec3::new(level * real::cos(heading), level * real::sin(heading), real::sin(pitch));
        Self::look_at(target + back * distance, target)
    }

    /// Sees the whole of a box from a heading and pitch, in a picture of width to height `aspect`.
    pub fn framing(aabb: &Aabb, heading: f64, pitch: f64, aspect: f64) -> Self {
        let target = aabb.center();
        let mut camera = Self::orbit(target, 1.0, heading, pitch);
        let axes = camera.axes();
        let tall = real::tan(0.5 * camera.field_of_view);
        // Each corner must be within the sides of the pyramid whose tip is the eye.
        let half = aabb.extent() * 0.5;
        let mut distance: f64 = 0.1;
        for corner in 0..8_u8 {
            let side = |bit: u8| if corner & bit == 0 { -1.0 } else { 1.0 };
            let p = half.component_mul(Vec3::new(side(1), side(2), side(4)));
            let (x, y, z) = (p.dot(axes.right).abs(), p.dot(axes.up).abs(), p.dot(axes.forward));
            distance = distance.max(x / (tall * aspect) - z).max(y / tall - z);
        }
        camera.eye = target - axes.forward * (1.08 * distance);
        camera
    }

    /// How far the eye is from the target.
    pub fn distance(&self) -> f64 {
        (self.target - self.eye).length()
    }

    pub(crate) fn axes(&self) -> Axes {
        let forward = (self.target - self.eye).normalized_or(Vec3::X);
        let aside = if forward.x.abs() < 0.9 { Vec3::X } else { Vec3::Y };
        let right = forward.cross(self.up).normalized_or(forward.cross(aside).normalized_or(Vec3::Y));
        Axes { right, up: right.cross(forward), forward }
    }

    /// The unit vectors to the right, up and forward as seen from here.
    pub fn directions(&self) -> [Vec3; 3] {
        let axes = self.axes();
        [axes.right, axes.up, axes.forward]
    }

    /// The pixel that a point falls on in a picture of a size, and its distance along the line of sight; `None` for a point
    /// behind the eye.
    pub fn project(&self, point: Vec3, size: [u32; 2]) -> Option<([f64; 2], f64)> {
        let axes = self.axes();
        let p = point - self.eye;
        let depth = p.dot(axes.forward);
        if depth <= 0.0 {
            return None;
        }
        let half = size.map(|side| 0.5 * f64::from(side));
        let scale = half[1] / (real::tan(0.5 * self.field_of_view) * depth);
        Some(([half[0] + p.dot(axes.right) * scale, half[1] - p.dot(axes.up) * scale], depth))
    }

    /// The unit direction from the eye through a pixel of a picture of a size.
    pub fn ray(&self, pixel: [f64; 2], size: [u32; 2]) -> Vec3 {
        let axes = self.axes();
        let half = size.map(|side| 0.5 * f64::from(side));
        let scale = real::tan(0.5 * self.field_of_view) / half[1];
        let (x, y) = ((pixel[0] - half[0]) * scale, (half[1] - pixel[1]) * scale);
        (axes.forward + axes.right * x + axes.up * y).normalized_or(axes.forward)
    }

    /// The nearest distance that is drawn.
    pub(crate) fn near(&self) -> f64 {
        (0.02 * self.distance()).clamp(1e-3, 0.1)
    }

    /// World (relative to `origin`) to clip space, columns first: depth 1 at the near plane, 0 infinitely far away, which
    /// spreads the precision of floating-point depths evenly.
    pub(crate) fn clip_matrix(&self, origin: Vec3, aspect: f64) -> [[f32; 4]; 4] {
        let axes = self.axes();
        let tall = 1.0 / real::tan(0.5 * self.field_of_view);
        let eye = self.eye - origin;
        let row =
            |axis: Vec3, scale: f64| [axis.x * scale, axis.y * scale, axis.z * scale, -axis.dot(eye) * scale];
        let rows = [
            row(axes.right, tall / aspect),
            row(axes.up, tall),
            [0.0, 0.0, 0.0, self.near()],
            row(axes.forward, 1.0),
        ];
        transposed(&rows)
    }
}

/// Rows in double precision as the columns that shaders want.
pub(crate) fn transposed(rows: &[[f64; 4]; 4]) -> [[f32; 4]; 4] {
    core::array::from_fn(|column| core::array::from_fn(|row| rows[row][column] as f32))
}

#[cfg(test)]
mod tests {
    use super::Camera;
    use ferrode_math::{Aabb, Vec3};

    #[test]
    fn rays_go_where_points_fall() {
        let camera = Camera::look_at(Vec3::new(3.0, -2.0, 1.5), Vec3::new(0.2, 0.1, 0.3));
        for point in [Vec3::ZERO, Vec3::new(0.5, 0.4, -0.3), Vec3::new(-2.0, 3.0, 1.0)] {
            let (pixel, _) = camera.project(point, [640, 360]).unwrap();
            let along = camera.ray(pixel, [640, 360]);
            assert!((along - (point - camera.eye).normalized().unwrap()).length() < 1e-12);
        }
        assert!(camera.project(Vec3::new(6.0, -4.0, 2.0), [640, 360]).is_none());
        let (middle, depth) = camera.project(camera.target, [640, 360]).unwrap();
        assert!((middle[0] - 320.0).abs() < 1e-9 && (middle[1] - 180.0).abs() < 1e-9);
        assert!((depth - camera.distance()).abs() < 1e-12);
    }

    #[test]
    fn the_clip_matrix_agrees_with_projection() {
        let camera = Camera::look_at(Vec3::new(103.0, -2.0, 1.5), Vec3::new(100.0, 0.1, 0.3));
        let (size, origin) = ([800, 400], Vec3::new(100.0, 0.0, 0.0));
        let m = camera.clip_matrix(origin, 2.0);
        let point = Vec3::new(100.4, 0.7, 0.2);
        let p = point - origin;
        let p = [p.x as f32, p.y as f32, p.z as f32, 1.0];
        let clip: [f32; 4] = core::array::from_fn(|row| (0..4).map(|k| m[k][row] * p[k]).sum());
        let (pixel, depth) = camera.project(point, size).unwrap();
        assert!((f64::from(clip[3]) - depth).abs() < 1e-5);
        assert!((400.0 * f64::from(1.0 + clip[0] / clip[3]) - pixel[0]).abs() < 1e-3);
        assert!((200.0 * f64::from(1.0 - clip[1] / clip[3]) - pixel[1]).abs() < 1e-3);
        assert!(clip[2] > 0.0 && clip[2] < clip[3]);
    }

    #[test]
    fn a_framed_box_is_in_the_picture_and_fills_it() {
        let aabb = Aabb { min: Vec3::new(-1.0, 2.0, 0.0), max: Vec3::new(3.0, 2.5, 7.0) };
        for (heading, pitch, size) in
            [(0.3, 0.2, [300, 200]), (-2.0, 1.2, [200, 300]), (1.5, 0.0, [500, 100])]
        {
            let camera = Camera::framing(&aabb, heading, pitch, f64::from(size[0]) / f64::from(size[1]));
            let mut reach: f64 = 0.0;
            for corner in 0..8 {
                let pick = |bit: u8, low: f64, high: f64| if corner & bit == 0 { low } else { high };
                let p = Vec3::new(pick(1, -1.0, 3.0), pick(2, 2.0, 2.5), pick(4, 0.0, 7.0));
                let ([x, y], _) = camera.project(p, size).unwrap();
                let [w, h] = size.map(f64::from);
                reach = reach.max((2.0 * x / w - 1.0).abs()).max((2.0 * y / h - 1.0).abs());
            }
            assert!(reach < 1.0 && reach > 0.8, "{reach}");
        }
    }
}
