//! The functions of joint types that fit no table: motors with numbered axes, modes, optional arguments.

use super::{change, get_vector, of_type, param, push, read, set_param};
use crate::fault::{Fault, Outcome, export};
use crate::real::{InVector, OutVector, Real, f, r, vec3, vector};
use crate::record::JointId;
use core::ffi::c_int;
use ferrode_dynamics::{
    AMotor, AMotorMode, AxisFrame, Error, Fixed, Hinge2, JointMut, LMotor, Param, Plane2D, Transmission,
    TransmissionMode,
};

/// The number of an axis, 0, 1 or 2.
fn axis_number(n: c_int) -> Outcome<usize> {
    usize::try_from(n).ok().filter(|n| *n < 3).ok_or(Fault::ARGUMENT)
}

fn frame(rel: c_int) -> Outcome<AxisFrame> {
    match rel {
        0 => Ok(AxisFrame::World),
        1 => Ok(AxisFrame::First),
        2 => Ok(AxisFrame::Second),
        _ => Err(Fault::ARGUMENT),
    }
}

fn frame_number(frame: AxisFrame) -> c_int {
    match frame {
        AxisFrame::World => 0,
        AxisFrame::First => 1,
        AxisFrame::Second => 2,
    }
}

/// The number of a parameter, if its group is one of three.
fn grouped(parameter: c_int) -> Outcome<c_int> {
    axis_number(parameter >> 8).map(|_| parameter)
}

/// How many axes: 0 … 3.
fn axis_count(count: c_int) -> Outcome<usize> {
    usize::try_from(count).ok().filter(|count| *count <= 3).ok_or(Fault::ARGUMENT)
}

/// Sets a parameter of one of a plane-2d joint's motors; unknown numbers have no effect.
fn plane_param(
    joint: JointId,
    parameter: c_int,
    set: impl FnOnce(&mut JointMut<'_, Plane2D>, Param) -> Result<(), Error>,
) -> Outcome<()> {
    let param = usize::try_from(parameter).ok().and_then(|n| Param::ALL.get(n).copied());
    change::<Plane2D>(joint, |j| param.map_or(Ok(()), |param| set(j, param)))
}

export! {
    fn dJointSetFixed(joint: JointId) { change::<Fixed>(joint, |j| { j.set_fixed(); Ok(()) })? }

    fn dJointSetHinge2Axes(joint: JointId, axis1: InVector, axis2: InVector) {
        let given = |axis: InVector| axis.optional().map(|axis| vector(&axis));
        let (first, second) = (given(axis1), given(axis2));
        if first.is_none() && second.is_none() {
            return Err(Fault::ARGUMENT);
        }
        change::<Hinge2>(joint, |j| j.set_axes(first, second))?
    }

    // ---- angular motor ----

    fn dJointSetAMotorMode(joint: JointId, mode: c_int) {
        let mode = match mode {
            0 => AMotorMode::User,
            1 => AMotorMode::Euler,
            _ => return Err(Fault::ARGUMENT),
        };
        change::<AMotor>(joint, |j| { j.set_mode(mode); Ok(()) })?
    }
    fn dJointGetAMotorMode(joint: JointId) -> c_int {
        match read::<AMotor, _>(joint, |j| j.mode())? { AMotorMode::Euler => 1, _ => 0 }
    }
    fn dJointSetAMotorNumAxes(joint: JointId, count: c_int) {
        of_type::<AMotor>(joint)?;
        let count = axis_count(count)?;
        change::<AMotor>(joint, |j| { j.set_axis_count(count); Ok(()) })?
    }
    fn dJointGetAMotorNumAxes(joint: JointId) -> c_int { read::<AMotor, _>(joint, |j| j.axis_count())? as c_int }
    fn dJointSetAMotorAxis(joint: JointId, number: c_int, rel: c_int, x: Real, y: Real, z: Real) {
        of_type::<AMotor>(joint)?;
        let (number, frame) = (axis_number(number)?, frame(rel)?);
        change::<AMotor>(joint, |j| j.set_axis(number, frame, vec3(x, y, z)))?
    }
    fn dJointGetAMotorAxis(joint: JointId, number: c_int, result: OutVector) {
        of_type::<AMotor>(joint)?;
        let number = axis_number(number)?;
        get_vector::<AMotor, _>(joint, result, |j| j.axis(number))?
    }
    fn dJointGetAMotorAxisRel(joint: JointId, number: c_int) -> c_int {
        of_type::<AMotor>(joint)?;
        let number = axis_number(number)?;
        frame_number(read::<AMotor, _>(joint, |j| j.axis_frame(number))?)
    }
    fn dJointSetAMotorAngle(joint: JointId, number: c_int, angle: Real) {
        of_type::<AMotor>(joint)?;
        let number = axis_number(number)?;
        change::<AMotor>(joint, |j| j.set_angle(number, f(angle)))?
    }
    fn dJointGetAMotorAngle(joint: JointId, number: c_int) -> Real {
        of_type::<AMotor>(joint)?;
        let number = axis_number(number)?;
        r(read::<AMotor, _>(joint, |j| j.angle(number))?)
    }
    fn dJointGetAMotorAngleRate(joint: JointId, number: c_int) -> Real {
        of_type::<AMotor>(joint)?;
        let number = axis_number(number)?;
        r(read::<AMotor, _>(joint, |j| j.angle_rate(number))?)
    }
    fn dJointSetAMotorParam(joint: JointId, parameter: c_int, value: Real) {
        of_type::<AMotor>(joint)?;
        set_param::<AMotor>(joint, grouped(parameter)?, f(value))?
    }
    fn dJointGetAMotorParam(joint: JointId, parameter: c_int) -> Real {
        of_type::<AMotor>(joint)?;
        param::<AMotor>(joint, grouped(parameter)?)?
    }
    fn dJointAddAMotorTorques(joint: JointId, torque1: Real, torque2: Real, torque3: Real) {
        push::<AMotor>(joint, |j| j.add_torques(f(torque1), f(torque2), f(torque3)))?
    }

    // ---- linear motor ----

    fn dJointSetLMotorNumAxes(joint: JointId, count: c_int) {
        // ODE clamps here, and asserts for the angular motor.
        let count = count.clamp(0, 3) as usize;
        change::<LMotor>(joint, |j| { j.set_axis_count(count); Ok(()) })?
    }
    fn dJointGetLMotorNumAxes(joint: JointId) -> c_int { read::<LMotor, _>(joint, |j| j.axis_count())? as c_int }
    fn dJointSetLMotorAxis(joint: JointId, number: c_int, rel: c_int, x: Real, y: Real, z: Real) {
        of_type::<LMotor>(joint)?;
        let (number, frame) = (axis_number(number)?, frame(rel)?);
        change::<LMotor>(joint, |j| j.set_axis(number, frame, vec3(x, y, z)))?
    }
    fn dJointGetLMotorAxis(joint: JointId, number: c_int, result: OutVector) {
        of_type::<LMotor>(joint)?;
        let number = axis_number(number)?;
        get_vector::<LMotor, _>(joint, result, |j| j.axis(number))?
    }
    fn dJointSetLMotorParam(joint: JointId, parameter: c_int, value: Real) {
        of_type::<LMotor>(joint)?;
        set_param::<LMotor>(joint, grouped(parameter)?, f(value))?
    }
    fn dJointGetLMotorParam(joint: JointId, parameter: c_int) -> Real {
        of_type::<LMotor>(joint)?;
        param::<LMotor>(joint, grouped(parameter)?)?
    }

    // ---- plane-2d ----

    fn dJointSetPlane2DXParam(joint: JointId, parameter: c_int, value: Real) {
        plane_param(joint, parameter, |j, param| j.set_x_param(param, f(value)))?
    }
    fn dJointSetPlane2DYParam(joint: JointId, parameter: c_int, value: Real) {
        plane_param(joint, parameter, |j, param| j.set_y_param(param, f(value)))?
    }
    fn dJointSetPlane2DAngleParam(joint: JointId, parameter: c_int, value: Real) {
        plane_param(joint, parameter, |j, param| j.set_angle_param(param, f(value)))?
    }

    // ---- transmission ----

    fn dJointSetTransmissionMode(joint: JointId, mode: c_int) {
        of_type::<Transmission>(joint)?;
        let mode = match mode {
            0 => TransmissionMode::ParallelAxes,
            1 => TransmissionMode::IntersectingAxes,
            2 => TransmissionMode::ChainDrive,
            _ => return Err(Fault::user("invalid joint mode")),
        };
        change::<Transmission>(joint, |j| { j.set_mode(mode); Ok(()) })?
    }
    fn dJointGetTransmissionMode(joint: JointId) -> c_int {
        match read::<Transmission, _>(joint, |j| j.mode())? {
            TransmissionMode::ParallelAxes => 0,
            TransmissionMode::IntersectingAxes => 1,
            _ => 2,
        }
    }
}

#[cfg(test)]
mod tests {
    #[test]
    fn axis_numbers() {
        assert!(super::axis_number(-1).is_err() && super::axis_number(3).is_err());
        assert_eq!(super::axis_number(2).ok(), Some(2));
    }
}
