//! Where the camera stands, from the command line.

use ferrode_math::{Aabb, Vec3};
use ferrode_render::Camera;

/// What `--camera` asks for.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ViewPoint {
    /// Degrees about z (0: from +x) and above the horizon; as near as everything fits in, times a factor.
    Around {
        /// Degrees about z.
        heading: f64,
        /// Degrees above the horizon.
        pitch: f64,
        /// Factor of the distance.
        distance: f64,
    },
    /// From a point to a point.
    LookAt {
        /// The eye.
        eye: Vec3,
        /// The point in the middle.
        target: Vec3,
    },
}

impl Default for ViewPoint {
    fn default() -> Self {
        Self::Around { heading: -58.0, pitch: 20.0, distance: 1.0 }
    }
}

impl ViewPoint {
    /// Reads `HEADING,PITCH`, `HEADING,PITCH,DISTANCE` or `EX,EY,EZ,TX,TY,TZ`.
    ///
    /// # Errors
    /// What was expected.
    pub fn parse(text: &str) -> Result<Self, String> {
        let expected = || {
            "expected HEADING,PITCH in degrees, with a factor of the distance as third number, or six numbers: \
             the eye's and the target's coordinates"
                .to_owned()
        };
        let parse = |part: &str| part.trim().parse::<f64>().ok().filter(|x| x.is_finite());
        let numbers: Option<Vec<f64>> = text.split(',').map(parse).collect();
        match *numbers.ok_or_else(expected)? {
            [heading, pitch] => Ok(Self::Around { heading, pitch, distance: 1.0 }),
            [heading, pitch, distance] if distance > 0.0 => Ok(Self::Around { heading, pitch, distance }),
            [a, b, c, x, y, z] if [a, b, c] != [x, y, z] => {
                Ok(Self::LookAt { eye: Vec3::new(a, b, c), target: Vec3::new(x, y, z) })
            }
            _ => Err(expected()),
        }
    }

    /// The camera that sees a box so, in a picture of width to height `aspect`.
    pub fn camera(&self, bounds: &Aabb, aspect: f64) -> Camera {
        match *self {
            Self::Around { heading, pitch, distance } => {
                let (heading, pitch) = (heading.to_radians(), pitch.clamp(-89.5, 89.5).to_radians());
                let mut camera = Camera::framing(bounds, heading, pitch, aspect);
                camera.eye = camera.target + (camera.eye - camera.target) * distance;
                camera
            }
            Self::LookAt { eye, target } => Camera::look_at(eye, target),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::ViewPoint;
    use ferrode_math::Vec3;

    #[test]
    fn two_three_or_six_numbers() {
        let around = |heading, pitch, distance| Ok(ViewPoint::Around { heading, pitch, distance });
        assert_eq!(ViewPoint::parse("30,-5"), around(30.0, -5.0, 1.0));
        assert_eq!(ViewPoint::parse(" 30, 15 ,0.5"), around(30.0, 15.0, 0.5));
        let (eye, target) = (Vec3::new(1.0, 2.0, 3.0), Vec3::new(0.0, 0.0, 0.5));
        assert_eq!(ViewPoint::parse("1,2,3,0,0,.5"), Ok(ViewPoint::LookAt { eye, target }));
        for wrong in ["", "1", "a,b", "1,2,0", "1,2,3,4", "1,2,3,1,2,3", "nan,1"] {
            assert!(ViewPoint::parse(wrong).is_err(), "{wrong}");
        }
    }
}
