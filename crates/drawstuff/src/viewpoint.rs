//! Where the camera is, and how the mouse moves it.

use ferrode_math::{Vec3, real};
use ferrode_render::Camera;

/// The camera: place, and heading, pitch and roll in degrees.
///
/// Heading 0 looks along x, 90 along y; pitch 0 is level, positive looks up; a positive roll leans the head to the right.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Viewpoint {
    /// Its place, m.
    pub xyz: [f32; 3],
    /// Heading, pitch, roll, degrees.
    pub hpr: [f32; 3],
}

/// Angle from the lower to the upper edge of the picture, degrees.
const FIELD_OF_VIEW: f64 = 50.0;
/// Degrees a pixel.
const TURN: f32 = 0.5;
/// Metres a pixel.
const MOVE: f32 = 0.01;

/// Which way a drag of the mouse moves the camera. The scene follows the hand.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Drag {
    /// Heading and pitch.
    Turn,
    /// Forward and sideways.
    Walk,
    /// Up and sideways.
    Lift,
}

impl Drag {
    /// What the pressed buttons do.
    pub fn of(left: bool, middle: bool, right: bool) -> Option<Self> {
        match (left, middle, right) {
            (_, true, _) | (true, _, true) => Some(Self::Lift),
            (true, ..) => Some(Self::Turn),
            (.., true) => Some(Self::Walk),
            _ => None,
        }
    }
}

impl Viewpoint {
    /// What programs see that set none.
    pub const START: Self = Self { xyz: [2.0, 0.0, 1.0], hpr: [180.0, 0.0, 0.0] };

    /// Moves by a drag of so many pixels to the right and down.
    pub fn drag(&mut self, how: Drag, right: f32, down: f32) {
        let heading = f64::from(self.hpr[0]).to_radians();
        let (c, s) = (real::cos(heading) as f32, real::sin(heading) as f32);
        let [x, y, z] = &mut self.xyz;
        match how {
            Drag::Turn => {
                self.hpr[0] = wrapped(self.hpr[0] + TURN * right);
                self.hpr[1] = (self.hpr[1] + TURN * down).clamp(-90.0, 90.0);
                return;
            }
            Drag::Walk => {
                *x -= MOVE * down * c;
                *y -= MOVE * down * s;
            }
            Drag::Lift => *z += MOVE * down,
        }
        // To the left as seen from here.
        *x -= MOVE * right * s;
        *y += MOVE * right * c;
    }

    /// The renderer's camera.
    pub fn camera(&self) -> Camera {
        let [h, p, r] = self.hpr.map(|degrees| f64::from(degrees).to_radians());
        let ((sh, ch), (sp, cp), (sr, cr)) = (sin_cos(h), sin_cos(p), sin_cos(r));
        let forward = Vec3::new(ch * cp, sh * cp, sp);
        let level_up = Vec3::new(-ch * sp, -sh * sp, cp);
        let up = level_up * cr + forward.cross(level_up) * sr;
        let eye = Vec3::from_array(self.xyz.map(f64::from));
        // Shadows and the nearest distance that is drawn go by the distance to what is looked at: the ground, say.
        let reach = if sp < 0.0 && eye.z > 0.0 { eye.z / -sp } else { 5.0 };
        let target = eye + forward * reach.clamp(3.0, 60.0);
        Camera { eye, target, up, field_of_view: FIELD_OF_VIEW.to_radians() }
    }
}

fn sin_cos(angle: f64) -> (f64, f64) {
    (real::sin(angle), real::cos(angle))
}

/// The same angle between −180° and 180°.
fn wrapped(degrees: f32) -> f32 {
    let turns = ((degrees + 180.0) / 360.0).floor();
    degrees - 360.0 * turns
}

#[cfg(test)]
mod tests {
    use super::{Drag, Viewpoint};
    use ferrode_math::Vec3;

    fn near(a: Vec3, b: Vec3) {
        assert!((a - b).length() < 1e-6, "{a:?} {b:?}");
    }

    #[test]
    fn angles_are_heading_pitch_and_roll() {
        let at = |hpr| Viewpoint { xyz: [1.0, 2.0, 3.0], hpr }.camera().directions();
        let [right, up, forward] = at([90.0, 0.0, 0.0]);
        near(forward, Vec3::Y);
        near(right, Vec3::X);
        near(up, Vec3::Z);
        near(at([0.0, -30.0, 0.0])[2], Vec3::new(0.75_f64.sqrt(), 0.0, -0.5));
        near(at([0.0, 0.0, 90.0])[1], -Vec3::Y);
        // Straight down is no exception: up in the picture is where the heading points.
        near(at([90.0, -90.0, 0.0])[1], Vec3::Y);
        near(Viewpoint::START.camera().directions()[2], -Vec3::X);
    }

    #[test]
    fn the_scene_follows_the_mouse() {
        let start = Viewpoint { xyz: [0.0, 0.0, 1.0], hpr: [90.0, 0.0, 0.0] };
        let dragged = |how, right, down| {
            let mut view = start;
            view.drag(how, right, down);
            view
        };
        assert_eq!(dragged(Drag::Turn, 20.0, -10.0).hpr, [100.0, -5.0, 0.0]);
        assert_eq!(dragged(Drag::Turn, 200.0, 400.0).hpr, [-170.0, 90.0, 0.0]);
        let place = |view: Viewpoint| Vec3::from_array(view.xyz.map(f64::from));
        near(place(dragged(Drag::Walk, 0.0, -100.0)), Vec3::new(0.0, 1.0, 1.0));
        near(place(dragged(Drag::Walk, 50.0, 0.0)), Vec3::new(-0.5, 0.0, 1.0));
        near(place(dragged(Drag::Lift, 0.0, 100.0)), Vec3::new(0.0, 0.0, 2.0));
        assert_eq!(Drag::of(true, false, true), Some(Drag::Lift));
        assert_eq!(Drag::of(false, false, false), None);
    }
}
