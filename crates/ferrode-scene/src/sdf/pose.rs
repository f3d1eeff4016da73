//! `<pose>`: position and rotation, relative to a frame.

use ferrode_math::{Pose, Quat, Vec3, real};

use super::reference_in;
use crate::context::Context;
use crate::draft::Placement;
use crate::error::Result;
use crate::xml::{Children, Element, Value};

const POSE: Children = Children {
    single: &[],
    many: &[],
    silent: &[],
    counted: &[],
    attributes: &["relative_to", "rotation_format", "degrees", "frame"],
};

/// The `<pose>` of an element, or no displacement.
pub(super) fn read(parent: Element<'_>, cx: &mut Context<'_>) -> Result<Placement> {
    match parent.child("pose") {
        Some(pose) => read_element(pose, cx),
        None => Ok(Placement::default()),
    }
}

fn read_element(element: Element<'_>, cx: &mut Context<'_>) -> Result<Placement> {
    element.expect(&mut cx.notes, &POSE);
    if let Some(frame) = element.attribute("frame").filter(|frame| !frame.is_empty()) {
        // SDF 1.5 and 1.6 had this attribute without ever saying what it means.
        let message = "attribute `frame` of <pose> has no effect";
        cx.notes.push(
            crate::error::Warning::new(crate::error::WarningKind::NotUnderstood, frame.origin(), message)
                .with_help("since SDF 1.7 it is called `relative_to`"),
        );
    }
    let degrees = element.attribute("degrees").map_or(Ok(false), |value| value.flag())?;
    let quaternion = match element.attribute("rotation_format") {
        None => false,
        Some(value) => match value.text() {
            "euler_rpy" | "" => false,
            "quat_xyzw" if degrees => {
                return Err(value.error("a quaternion has no degrees"));
            }
            "quat_xyzw" => true,
            other => {
                return Err(value.error(format!(
                    "the rotation format `{other}` is unknown: `euler_rpy` and `quat_xyzw` are known"
                )));
            }
        },
    };
    let value = element.value();
    let pose = if value.is_empty() {
        Pose::IDENTITY
    } else if quaternion {
        let [x, y, z, qx, qy, qz, qw] = value.numbers::<7>()?;
        let rotation =
            Quat::new(qw, qx, qy, qz).normalized().ok_or_else(|| value.error("the quaternion is zero"))?;
        Pose::new(Vec3::new(x, y, z), rotation)
    } else {
        from_six(&value, degrees)?
    };
    Ok(Placement { pose, relative_to: reference_in(element, "relative_to") })
}

fn from_six(value: &Value<'_>, degrees: bool) -> Result<Pose> {
    let [x, y, z, roll, pitch, yaw] = value.numbers::<6>()?;
    let unit = if degrees { std::f64::consts::PI / 180.0 } else { 1.0 };
    Ok(Pose::new(Vec3::new(x, y, z), roll_pitch_yaw(roll * unit, pitch * unit, yaw * unit)))
}

/// Rotations about the fixed axes x, then y, then z: Rz(yaw) Ry(pitch) Rx(roll), as SDF and URDF have them.
/// By half angles, so that zero angles give exactly no rotation.
pub(crate) fn roll_pitch_yaw(roll: f64, pitch: f64, yaw: f64) -> Quat {
    let half = |angle: f64| (real::cos(0.5 * angle), real::sin(0.5 * angle));
    let ((cr, sr), (cp, sp), (cy, sy)) = (half(roll), half(pitch), half(yaw));
    Quat::new(
        cy * cp * cr + sy * sp * sr,
        cy * cp * sr - sy * sp * cr,
        cy * sp * cr + sy * cp * sr,
        sy * cp * cr - cy * sp * sr,
    )
}

#[cfg(test)]
mod tests {
    use super::*;
    use ferrode_math::rotation::from_roll_pitch_yaw;

    #[test]
    fn half_angles_agree_with_the_product_of_matrices() {
        for (roll, pitch, yaw) in [(0.3, -0.7, 2.0), (-1.5, 1.2, -3.0), (3.0, 1.57, 0.1)] {
            let quaternion = roll_pitch_yaw(roll, pitch, yaw).to_matrix();
            let matrix = from_roll_pitch_yaw(roll, pitch, yaw);
            for (a, b) in quaternion.rows.iter().flatten().zip(matrix.rows.iter().flatten()) {
                assert!((a - b).abs() < 1e-15, "{quaternion:?} {matrix:?}");
            }
        }
        assert_eq!(roll_pitch_yaw(0.0, 0.0, 0.0), Quat::IDENTITY);
    }
}
