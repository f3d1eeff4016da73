//! Joints: what all types share, and the macros by which the types' functions are declared.

mod group;
mod motors;
mod shared;
mod table;

use crate::fault::{Fault, Outcome, from_engine};
use crate::real::{Real, r, vector3};
use crate::record::{JointId, JointRecord, Required, WorldRecord};
use ferrode_dynamics::{
    AMotor, Ball, Contact, DBall, DHinge, Error, Fixed, Hinge, Hinge2, JointData, JointKey, JointMut,
    JointRef, LMotor, Null, PR, PU, Piston, Plane2D, Slider, Transmission, Universal,
};
use ferrode_math::Vec3;

/// A joint type's name as ODE's messages spell it.
pub trait Named: JointData {
    /// The fault for a joint of another type.
    const MISMATCH: Fault;
}

macro_rules! named {
    ($($joint:ident $text:literal;)+) => {
        $(impl Named for $joint {
            const MISMATCH: Fault = Fault::user(concat!("joint type is not ", $text));
        })+
    };
}

named! {
    Ball "Ball"; Hinge "Hinge"; Slider "Slider"; Contact "Contact"; Universal "Universal"; Hinge2 "Hinge2";
    Fixed "Fixed"; Null "Null"; AMotor "AMotor"; LMotor "LMotor"; Plane2D "Plane2D"; PR "PR"; PU "PU";
    Piston "Piston"; DBall "DBall"; DHinge "DHinge"; Transmission "Transmission";
}

const NO_JOINT: Fault = Fault::user("bad joint argument");
const NO_RESULT: Fault = Fault::user("bad result argument");

/// What the engine's getters give, as one kind.
trait Answer<T> {
    fn answer(self) -> Result<T, Error>;
}

impl Answer<f64> for f64 {
    fn answer(self) -> Result<f64, Error> {
        Ok(self)
    }
}

impl Answer<Vec3> for Vec3 {
    fn answer(self) -> Result<Vec3, Error> {
        Ok(self)
    }
}

impl<T> Answer<T> for Result<T, Error> {
    fn answer(self) -> Self {
        self
    }
}

/// The joint behind a handle, if it is of the type.
fn of_type<J: Named>(joint: JointId) -> Outcome<(&'static JointRecord, &'static WorldRecord, JointKey)> {
    let record = joint.get().map_err(|_| NO_JOINT)?;
    if record.joint_type.get() != Some(J::TYPE) {
        return Err(J::MISMATCH);
    }
    let (world, key) = record.place()?;
    Ok((record, world, key))
}

/// Takes in what the program wrote to the joint's bodies.
fn take_bodies_in(record: &JointRecord) -> Outcome<()> {
    record.bodies()?.iter().filter_map(|body| body.live()).for_each(|body| body.take_in());
    Ok(())
}

/// Reads a joint of a type.
fn read<J: Named, T>(joint: JointId, work: impl FnOnce(JointRef<'_, J>) -> T) -> Outcome<T> {
    let (record, world, key) = of_type::<J>(joint)?;
    take_bodies_in(record)?;
    world.engine(|engine| engine.joint::<J>(key).map(work).map_err(|_| Fault::ARGUMENT))
}

/// Changes a joint of a type.
fn change<J: Named>(
    joint: JointId,
    work: impl FnOnce(&mut JointMut<'_, J>) -> Result<(), Error>,
) -> Outcome<()> {
    let (record, world, key) = of_type::<J>(joint)?;
    take_bodies_in(record)?;
    let done = world.engine(|engine| engine.joint_mut::<J>(key).and_then(|mut joint| work(&mut joint)));
    match done {
        // Without bodies ODE does not look at the axis.
        Err(Error::ZeroVector { .. }) if record.bodies()?.iter().all(|body| body.is_null()) => Ok(()),
        done => done.or_else(|error| from_engine(&error)),
    }
}

/// Adds forces by way of a joint, and shows the bodies' new sums.
fn push<J: Named>(
    joint: JointId,
    work: impl FnOnce(&mut JointMut<'_, J>) -> Result<(), Error>,
) -> Outcome<()> {
    change(joint, work)?;
    let (record, world, _) = of_type::<J>(joint)?;
    record.bodies()?.iter().filter_map(|body| body.live()).for_each(|body| body.publish(world));
    Ok(())
}

/// The engine's answer to a getter; one that makes no sense is a fault, as ODE would follow a null pointer.
fn answer<T>(answer: Result<T, Error>) -> Outcome<T> {
    answer.map_err(|error| from_engine(&error).err().unwrap_or(Fault::ARGUMENT))
}

fn set_param<J: Named>(joint: JointId, n: i32, value: f64) -> Outcome<()> {
    let (_, world, key) = of_type::<J>(joint)?;
    world.engine(|engine| engine.set_joint_param_number(key, n, value)).or_else(|error| from_engine(&error))
}

fn param<J: Named>(joint: JointId, n: i32) -> Outcome<Real> {
    let (_, world, key) = of_type::<J>(joint)?;
    Ok(r(world.engine(|engine| engine.joint_param_number(key, n)).map_err(|_| Fault::ARGUMENT)?))
}

fn get_vector<J: Named, A: Answer<Vec3>>(
    joint: JointId,
    result: crate::real::OutVector,
    get: impl FnOnce(JointRef<'_, J>) -> A,
) -> Outcome<()> {
    of_type::<J>(joint)?;
    result.check(NO_RESULT)?;
    result.set(vector3(answer(read::<J, _>(joint, get)?.answer())?))
}

fn get_real<J: Named, A: Answer<f64>>(
    joint: JointId,
    get: impl FnOnce(JointRef<'_, J>) -> A,
) -> Outcome<Real> {
    Ok(r(answer(read::<J, _>(joint, get)?.answer())?))
}

/// Declares the functions of one joint type, each by the engine's method that does the work: what kind of function it is,
/// its exported name, the method.
macro_rules! joint_functions {
    ($joint:ident: $($kind:ident $name:ident $method:ident;)+) => {
        $(joint_functions!(@$kind $joint $name $method);)+
    };
    // Sets a point or an axis.
    (@vector $joint:ident $name:ident $method:ident) => {
        export! { fn $name(joint: JointId, x: Real, y: Real, z: Real) {
            change::<$joint>(joint, |j| j.$method(vec3(x, y, z)))?
        } }
    };
    // Sets a point or an axis, and a displacement.
    (@vector_offset $joint:ident $name:ident $method:ident) => {
        export! { fn $name(joint: JointId, x: Real, y: Real, z: Real, dx: Real, dy: Real, dz: Real) {
            change::<$joint>(joint, |j| j.$method(vec3(x, y, z), vec3(dx, dy, dz)))?
        } }
    };
    // Sets an axis and the angle that it stands at.
    (@axis_angle $joint:ident $name:ident $method:ident) => {
        export! { fn $name(joint: JointId, x: Real, y: Real, z: Real, angle: Real) {
            change::<$joint>(joint, |j| j.$method(vec3(x, y, z), f(angle)))?
        } }
    };
    // Sets an axis and two angles.
    (@axis_angles $joint:ident $name:ident $method:ident) => {
        export! { fn $name(joint: JointId, x: Real, y: Real, z: Real, offset1: Real, offset2: Real) {
            change::<$joint>(joint, |j| j.$method(vec3(x, y, z), f(offset1), f(offset2)))?
        } }
    };
    // Sets a number.
    (@real $joint:ident $name:ident $method:ident) => {
        export! { fn $name(joint: JointId, value: Real) { change::<$joint>(joint, |j| j.$method(f(value)))? } }
    };
    // Adds one force or torque.
    (@push $joint:ident $name:ident $method:ident) => {
        export! { fn $name(joint: JointId, force: Real) { push::<$joint>(joint, |j| j.$method(f(force)))? } }
    };
    // Adds two torques.
    (@push2 $joint:ident $name:ident $method:ident) => {
        export! { fn $name(joint: JointId, torque1: Real, torque2: Real) {
            push::<$joint>(joint, |j| j.$method(f(torque1), f(torque2)))?
        } }
    };
    // Gets a point or an axis.
    (@get_vector $joint:ident $name:ident $method:ident) => {
        export! { fn $name(joint: JointId, result: OutVector) {
            get_vector::<$joint, _>(joint, result, |j| j.$method())?
        } }
    };
    // Gets a number.
    (@get_real $joint:ident $name:ident $method:ident) => {
        export! { fn $name(joint: JointId) -> Real { get_real::<$joint, _>(joint, |j| j.$method())? } }
    };
    // Gets two angles.
    (@get_reals $joint:ident $name:ident $method:ident) => {
        export! { fn $name(joint: JointId, angle1: Out<Real>, angle2: Out<Real>) {
            let [first, second] = read::<$joint, _>(joint, |j| j.$method())?;
            angle1.set_if_wanted([r(first)]);
            angle2.set_if_wanted([r(second)])
        } }
    };
    // Sets and gets the numbered parameters: two names.
    (@params $joint:ident $set:ident $get:ident) => {
        export! {
            fn $set(joint: JointId, parameter: c_int, value: Real) {
                set_param::<$joint>(joint, parameter, f(value))?
            }
            fn $get(joint: JointId, parameter: c_int) -> Real { param::<$joint>(joint, parameter)? }
        }
    };
}
pub(crate) use joint_functions;
