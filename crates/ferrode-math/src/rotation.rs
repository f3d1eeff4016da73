//! ODE's rotation functions (manual, "Rotation functions"), with their conventions.

use crate::{Mat3, Quat, Vec3, real};

/// Two unit vectors that span the plane orthogonal to the unit vector `n`; (n, p, q) is right-handed, q = n × p.
///
/// The choice decides the friction directions of a contact, so it is ODE's (`dPlaneSpace`). It jumps where
/// |n.z| = 1/√2.
#[inline]
pub fn plane_space(n: Vec3) -> (Vec3, Vec3) {
    // Which component takes part is as good as random: selections cost less than a branch.
    let steep = n.z.abs() > core::f64::consts::FRAC_1_SQRT_2;
    let (u, v) = if steep { (n.z, n.x) } else { (n.x, n.z) };
    let a = n.y * n.y + u * u;
    let k = 1.0 / a.sqrt();
    let (y, u, a) = (n.y * k, u * k, a * k);
    let (across, along) = (-(v * y), -(v * u));
    if steep {
        (Vec3::new(0.0, -u, y), Vec3::new(a, across, along))
    } else {
        (Vec3::new(-y, u, 0.0), Vec3::new(along, across, a))
    }
}

/// The rotation matrix about `axis` (need not be a unit vector) by `angle`; a zero axis gives the identity
/// (`dRFromAxisAndAngle`).
pub fn from_axis_and_angle(axis: Vec3, angle: f64) -> Mat3 {
    Quat::from_axis_angle(axis, angle).to_matrix()
}

/// ODE's `dRFromEulerAngles`: the **transpose** of Rz(psi) Ry(theta) Rx(phi), i.e. Rx(−phi) Ry(−theta) Rz(−psi).
///
/// For the usual roll-pitch-yaw rotation from body to world use [`from_roll_pitch_yaw`].
pub fn from_euler_angles(phi: f64, theta: f64, psi: f64) -> Mat3 {
    from_roll_pitch_yaw(phi, theta, psi).transpose()
}

/// Rz(yaw) Ry(pitch) Rx(roll): rotations about the fixed axes x, then y, then z, as SDF and URDF have them.
pub fn from_roll_pitch_yaw(roll: f64, pitch: f64, yaw: f64) -> Mat3 {
    let (sr, cr) = (real::sin(roll), real::cos(roll));
    let (sp, cp) = (real::sin(pitch), real::cos(pitch));
    let (sy, cy) = (real::sin(yaw), real::cos(yaw));
    Mat3::from_rows([
        [cy * cp, cy * sp * sr - sy * cr, cy * sp * cr + sy * sr],
        [sy * cp, sy * sp * sr + cy * cr, sy * sp * cr - cy * sr],
        [-sp, cp * sr, cp * cr],
    ])
}

/// The rotation whose columns are x along `a`, y in the plane of `a` and `b`, and z = x × y (`dRFrom2Axes`).
/// `None` if one of them is zero or they are parallel.
pub fn from_two_axes(a: Vec3, b: Vec3) -> Option<Mat3> {
    let x = a.normalized()?;
    let b = b.normalized()?;
    let y = (b - x * x.dot(b)).normalized()?;
    Some(Mat3::from_columns(x, y, x.cross(y)))
}

/// A rotation whose z column is along `a`, the others by [`plane_space`] (`dRFromZAxis`). `None` if `a` is zero.
pub fn from_z_axis(a: Vec3) -> Option<Mat3> {
    let n = a.normalized()?;
    let (p, q) = plane_space(n);
    Some(Mat3::from_columns(p, q, n))
}

/// The proper rotation nearest to the first row of `m`, then its second: Gram–Schmidt by rows.
///
/// `None` if the first row is zero or the second is parallel to it. ODE's `dOrthogonalizeR` forgets to store the
/// corrected second row; see [`orthogonalize_as_ode`].
pub fn orthogonalize(m: &Mat3) -> Option<Mat3> {
    let a = m.row(0).normalized()?;
    let b = (m.row(1) - a * a.dot(m.row(1))).normalized()?;
    Some(Mat3::from_rows([a.to_array(), b.to_array(), a.cross(b).to_array()]))
}

/// As [`orthogonalize`], with ODE's slip: when the second row is not orthogonal to the first, its corrected value is
/// used for the third row but the second keeps its original numbers.
pub fn orthogonalize_as_ode(m: &Mat3) -> Option<Mat3> {
    let a = m.row(0).normalized()?;
    let projection = a.dot(m.row(1));
    if projection == 0.0 {
        let b = m.row(1).normalized()?;
        return Some(Mat3::from_rows([a.to_array(), b.to_array(), a.cross(b).to_array()]));
    }
    let b = (m.row(1) - a * projection).normalized()?;
    Some(Mat3::from_rows([a.to_array(), m.rows[1], a.cross(b).to_array()]))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn near(a: Vec3, b: [f64; 3]) {
        assert!((a - Vec3::from_array(b)).abs_max() < 1e-15, "{a:?} {b:?}");
    }

    #[test]
    fn euler_angles_are_odes() {
        let m = from_euler_angles(0.1, 0.2, 0.3);
        near(m.row(0), [0.93629336358419923, 0.28962947762551555, -0.19866933079506122]);
        near(m.row(1), [-0.27509584731824371, 0.95642508584923247, 0.09784339500725571]);
        near(m.row(2), [0.21835066314633444, -0.036957013524625083, 0.97517032720181596]);
    }

    #[test]
    fn plane_space_is_right_handed() {
        for n in [Vec3::Z, Vec3::X, -Vec3::Z, Vec3::new(0.3, -0.5, 0.8), Vec3::new(0.9, 0.1, -0.2)] {
            let n = n.normalized().unwrap();
            let (p, q) = plane_space(n);
            assert!((n.cross(p) - q).length() < 1e-15);
            assert!((p.length() - 1.0).abs() < 1e-15 && n.dot(p).abs() < 1e-15);
        }
        assert_eq!(plane_space(Vec3::Z).0, Vec3::new(0.0, -1.0, 0.0));
    }

    #[test]
    fn orthogonalisation_and_its_slip() {
        let m = Mat3::from_rows([[2.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 0.0, 5.0]]);
        assert_eq!(orthogonalize(&m).unwrap(), Mat3::IDENTITY);
        assert_eq!(orthogonalize_as_ode(&m).unwrap().rows[1], [1.0, 1.0, 0.0]);
        assert_eq!(orthogonalize(&Mat3::ZERO), None);
    }
}
