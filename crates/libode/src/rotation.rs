//! Rotations and small vectors.

use crate::fault::{Fault, Outcome, USER, export, guard, message};
use crate::real::{
    InMatrix, InQuaternion, InVector, Out, OutMatrix, OutQuaternion, OutVector, Real, f, mat3, matrix3, quat,
    quaternion, r, vec3, vector, vector3,
};
use core::ffi::c_int;
use ferrode_math::{Mat3, Quat, plane_space, rotation};

const NO_DIRECTION: Fault = Fault::internal("assertion \"!bSafeNormalize3Fault\" failed");
const NO_ROTATION: Fault = Fault::internal("assertion \"!bSafeNormalize4Fault\" failed");

/// Normalises in place; whether that could be done. `None` leaves the vector as it was.
fn normalize3(v: OutVector) -> Outcome<bool> {
    let unit = vector(&v.get()?).normalized();
    if let Some(unit) = unit {
        v.set(vector3(unit))?;
    }
    Ok(unit.is_some())
}

/// By the plain length, as ODE: no scaling against overflow.
fn normalize4(v: Out<Real, 4>) -> Outcome<bool> {
    let given = v.get()?.map(f);
    let squared = given.iter().map(|x| x * x).sum::<f64>();
    let good = squared > 0.0;
    if good {
        let k = 1.0 / squared.sqrt();
        v.set(given.map(|x| r(x * k)))?;
    }
    Ok(good)
}

fn product(
    to: OutQuaternion,
    b: InQuaternion,
    c: InQuaternion,
    of: impl FnOnce(Quat, Quat) -> Quat,
) -> Outcome<()> {
    to.set(quaternion(of(quat(&b.get()?), quat(&c.get()?))))
}

export! {
    fn dRSetIdentity(to: OutMatrix) { to.set(matrix3(&Mat3::IDENTITY))? }
    fn dRFromAxisAndAngle(to: OutMatrix, x: Real, y: Real, z: Real, angle: Real) {
        to.set(matrix3(&rotation::from_axis_and_angle(vec3(x, y, z), f(angle))))?
    }
    fn dRFromEulerAngles(to: OutMatrix, phi: Real, theta: Real, psi: Real) {
        to.set(matrix3(&rotation::from_euler_angles(f(phi), f(theta), f(psi))))?
    }
    fn dRFromZAxis(to: OutMatrix, x: Real, y: Real, z: Real) {
        to.check(Fault::ARGUMENT)?;
        to.set(matrix3(&rotation::from_z_axis(vec3(x, y, z)).ok_or(NO_DIRECTION)?))?
    }
    fn dRfromQ(to: OutMatrix, q: InQuaternion) { to.set(matrix3(&quat(&q.get()?).to_matrix()))? }
    fn dQfromR(to: OutQuaternion, m: InMatrix) { to.set(quaternion(Quat::from_matrix(&mat3(&m.get()?))))? }

    fn dQSetIdentity(to: OutQuaternion) { to.set(quaternion(Quat::IDENTITY))? }
    fn dQFromAxisAndAngle(to: OutQuaternion, x: Real, y: Real, z: Real, angle: Real) {
        to.set(quaternion(Quat::from_axis_angle(vec3(x, y, z), f(angle))))?
    }
    fn dQMultiply0(to: OutQuaternion, b: InQuaternion, c: InQuaternion) { product(to, b, c, |b, c| b * c)? }
    fn dQMultiply1(to: OutQuaternion, b: InQuaternion, c: InQuaternion) {
        product(to, b, c, |b, c| b.conjugate() * c)?
    }
    fn dQMultiply2(to: OutQuaternion, b: InQuaternion, c: InQuaternion) {
        product(to, b, c, |b, c| b * c.conjugate())?
    }
    fn dQMultiply3(to: OutQuaternion, b: InQuaternion, c: InQuaternion) {
        product(to, b, c, |b, c| b.conjugate() * c.conjugate())?
    }
    fn dDQfromW(to: OutQuaternion, w: InVector, q: InQuaternion) {
        to.set(quaternion(quat(&q.get()?).derivative(vector(&w.get()?))))?
    }

    fn dSafeNormalize3(v: OutVector) -> c_int { normalize3(v)?.into() }
    fn dSafeNormalize4(v: Out<Real, 4>) -> c_int { normalize4(v)?.into() }
    fn dNormalize3(v: OutVector) { if !normalize3(v)? { return Err(NO_DIRECTION) } }
    fn dNormalize4(v: Out<Real, 4>) { if !normalize4(v)? { return Err(NO_ROTATION) } }
    fn dPlaneSpace(n: InVector, p: OutVector, q: OutVector) {
        p.check(Fault::ARGUMENT)?;
        q.check(Fault::ARGUMENT)?;
        let (first, second) = plane_space(vector(&n.get()?));
        p.set(vector3(first))?;
        q.set(vector3(second))?
    }
    fn dOrthogonalizeR(m: OutMatrix) -> c_int {
        let straight = rotation::orthogonalize_as_ode(&mat3(&m.get()?));
        if let Some(straight) = &straight {
            m.set(matrix3(straight))?;
        }
        straight.is_some().into()
    }
}

/// The rotation whose x axis is along `a` and whose y axis is in the plane of `a` and `b`. Two that span no plane give a
/// message and leave the matrix alone.
#[unsafe(no_mangle)]
pub unsafe extern "C-unwind" fn dRFrom2Axes(
    to: OutMatrix,
    ax: Real,
    ay: Real,
    az: Real,
    bx: Real,
    by: Real,
    bz: Real,
) {
    let good = guard("dRFrom2Axes", || {
        to.check(Fault::ARGUMENT)?;
        let made = rotation::from_two_axes(vec3(ax, ay, az), vec3(bx, by, bz));
        if let Some(made) = &made {
            to.set(matrix3(made))?;
        }
        Ok(made.is_some())
    });
    if !good {
        message(USER, "zero length vector", "dRFrom2Axes");
    }
}
