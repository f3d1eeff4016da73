//! Bodies: state, forces, mass, and how they are stepped.

use crate::fault::{Fault, Outcome, export, from_engine};
use crate::geom::{body_moved, leave_dying_body};
use crate::mass::MassRecord;
use crate::real::{
    In, InMatrix, InQuaternion, Out, OutMatrix, OutQuaternion, OutVector, Real, Real4, f, mat3, matrix3,
    padded, quat, quaternion, r, vec3, vector, vector3,
};
use crate::record::{BodyId, BodyRecord, JointId, MovedCallback, Required, WorldId, handle_of};
use crate::slab::Record;
use crate::world::threshold;
use core::cell::Cell;
use core::ffi::{c_int, c_uint, c_void};
use ferrode_dynamics::{AutoDisable, Body, Damping, Error};
use ferrode_math::{Mat3, Quat, Vec3, rotation};

/// What ODE's getter returns for a body on which the gyroscopic torque acts.
const GYROSCOPIC_FLAG: c_int = 256;

fn with(body: BodyId, work: impl FnOnce(&mut Body) -> Result<(), Error>) -> Outcome<()> {
    body.get()?.engine(work)?.or_else(|error| from_engine(&error))
}

fn read<T>(body: BodyId, work: impl FnOnce(&Body) -> T) -> Outcome<T> {
    body.get()?.engine(|body| work(body))
}

fn auto_disable(body: BodyId, change: impl FnOnce(&mut AutoDisable)) -> Outcome<()> {
    with(body, |body| {
        let mut settings = *body.auto_disable();
        change(&mut settings);
        body.set_auto_disable(settings)
    })
}

fn damping(body: BodyId, change: impl FnOnce(&mut Damping)) -> Outcome<()> {
    with(body, |body| {
        let mut settings = *body.damping();
        change(&mut settings);
        body.set_damping(settings)
    })
}

/// Work on the engine's world that a body belongs to, and its key.
fn with_world(
    body: BodyId,
    work: impl FnOnce(&mut ferrode_dynamics::World, ferrode_dynamics::BodyKey) -> Result<(), Error>,
) -> Outcome<()> {
    let (world, key) = body.get()?.place()?;
    world.engine(|engine| work(engine, key)).or_else(|error| from_engine(&error))
}

/// Position and rotation as the record has them.
fn frame(body: &BodyRecord) -> (Vec3, Mat3) {
    (vector(&body.position.get()), mat3(&body.rotation.get()))
}

fn add(to: &Cell<Real4>, what: Vec3) {
    let old = to.get();
    let sum = padded(vector(&old) + what);
    to.set([sum[0], sum[1], sum[2], old[3]]);
}

/// Adds a force at an arm from the centre of mass; both are functions of position and rotation.
fn push(body: BodyId, force: impl FnOnce(Mat3) -> Vec3, arm: impl FnOnce(Vec3, Mat3) -> Vec3) -> Outcome<()> {
    body.get()?.change(|body| {
        let (position, rotation) = frame(body);
        let force = force(rotation);
        add(&body.force, force);
        add(&body.torque, arm(position, rotation).cross(force));
    });
    Ok(())
}

/// A new quaternion, normalised, and its matrix.
fn turn(body: &BodyRecord, q: Quat, m: &Mat3) -> Outcome<()> {
    body.change(|body| {
        body.quaternion.set(quaternion(q));
        body.rotation.set(matrix3(m));
    });
    body_moved(body)
}

const NO_DIRECTION: Fault = Fault::internal("assertion \"the quaternion can be normalised\" failed");

/// Gives a body a rotation, straightened out.
pub fn rotate(body: &BodyRecord, given: &Mat3) -> Outcome<()> {
    // As in ODE the quaternion is that of the matrix as given.
    let straight = rotation::orthogonalize_as_ode(given).ok_or(Fault::ARGUMENT)?;
    turn(body, Quat::from_matrix(given).normalized().ok_or(NO_DIRECTION)?, &straight)
}

/// Gives a body a quaternion, normalised.
pub fn orient(body: &BodyRecord, q: Quat) -> Outcome<()> {
    let q = q.normalized().ok_or(NO_DIRECTION)?;
    turn(body, q, &q.to_matrix())
}

/// The address of a part of the record: it stays for the body's life, and the engine keeps it up to date.
fn pointer<T: Copy + 'static>(
    body: BodyId,
    part: impl FnOnce(&'static BodyRecord) -> &'static Cell<T>,
) -> Outcome<*const Real> {
    let record = body.get()?;
    record.current();
    Ok(part(record).as_ptr().cast_const().cast())
}

/// Velocity of the body's matter at an arm from the centre of mass.
fn velocity_at(body: &BodyRecord, arm: Vec3) -> Vec3 {
    vector(&body.linear_velocity.get()) + vector(&body.angular_velocity.get()).cross(arm)
}

export! {
    fn dBodyCreate(world: WorldId) -> BodyId { BodyId::of(BodyRecord::create(world.get()?)) }

    fn dBodyDestroy(body: BodyId) {
        leave_dying_body(body.get()?);
        with_world(body, |engine, key| engine.destroy_body(key))?;
        BodyRecord::pool().destroy(body.get()?);
    }

    fn dBodyGetWorld(body: BodyId) -> WorldId { body.get()?.world.get().handle() }
    fn dBodySetData(body: BodyId, data: *mut c_void) { body.get()?.data.set(data) }
    fn dBodyGetData(body: BodyId) -> *mut c_void { body.get()?.data.get() }

    // ---- state ----

    fn dBodySetPosition(body: BodyId, x: Real, y: Real, z: Real) {
        let body = body.get()?;
        body.change(|body| body.position.set([x, y, z, 0.0]));
        body_moved(body)?
    }
    fn dBodySetRotation(body: BodyId, rotation: InMatrix) {
        rotate(body.get()?, &mat3(&rotation.get()?))?
    }
    fn dBodySetQuaternion(body: BodyId, q: InQuaternion) { orient(body.get()?, quat(&q.get()?))? }
    fn dBodySetLinearVel(body: BodyId, x: Real, y: Real, z: Real) {
        body.get()?.change(|body| body.linear_velocity.set([x, y, z, 0.0]))
    }
    fn dBodySetAngularVel(body: BodyId, x: Real, y: Real, z: Real) {
        body.get()?.change(|body| body.angular_velocity.set([x, y, z, 0.0]))
    }
    fn dBodySetForce(body: BodyId, x: Real, y: Real, z: Real) {
        body.get()?.change(|body| body.force.set([x, y, z, 0.0]))
    }
    fn dBodySetTorque(body: BodyId, x: Real, y: Real, z: Real) {
        body.get()?.change(|body| body.torque.set([x, y, z, 0.0]))
    }

    fn dBodyGetPosition(body: BodyId) -> *const Real { pointer(body, |body| &body.position)? }
    fn dBodyGetRotation(body: BodyId) -> *const Real { pointer(body, |body| &body.rotation)? }
    fn dBodyGetQuaternion(body: BodyId) -> *const Real { pointer(body, |body| &body.quaternion)? }
    fn dBodyGetLinearVel(body: BodyId) -> *const Real { pointer(body, |body| &body.linear_velocity)? }
    fn dBodyGetAngularVel(body: BodyId) -> *const Real { pointer(body, |body| &body.angular_velocity)? }
    fn dBodyGetForce(body: BodyId) -> *const Real { pointer(body, |body| &body.force)? }
    fn dBodyGetTorque(body: BodyId) -> *const Real { pointer(body, |body| &body.torque)? }

    fn dBodyCopyPosition(body: BodyId, position: OutVector) {
        position.set(vector3(vector(&body.get()?.current().position.get())))?
    }
    fn dBodyCopyRotation(body: BodyId, rotation: OutMatrix) {
        rotation.set(body.get()?.current().rotation.get())?
    }
    fn dBodyCopyQuaternion(body: BodyId, q: OutQuaternion) {
        q.set(body.get()?.current().quaternion.get())?
    }

    // ---- mass ----

    fn dBodySetMass(body: BodyId, mass: In<MassRecord>) {
        let body = body.get()?;
        let [record] = mass.get()?;
        let mass = record.to_engine();
        if mass.check().is_err() {
            return Err(Fault::internal("assertion \"dMassCheck(mass)\" failed"));
        }
        if mass.centre.abs_max() > f(Real::EPSILON) {
            return Err(Fault::user("The centre of mass must be at the origin."));
        }
        body.engine(|body| body.set_mass(&mass))?.or_else(|error| from_engine(&error))?;
        body.mass.set(record)
    }
    fn dBodyGetMass(body: BodyId, mass: Out<MassRecord>) { mass.set([body.get()?.mass.get()])? }
    fn dBodySetKinematic(body: BodyId) { body.get()?.engine(Body::set_kinematic)? }
    fn dBodySetDynamic(body: BodyId) { body.get()?.engine(Body::set_dynamic)? }
    fn dBodyIsKinematic(body: BodyId) -> c_int { read(body, Body::is_kinematic)?.into() }

    // ---- forces ----

    fn dBodyAddForce(body: BodyId, x: Real, y: Real, z: Real) {
        body.get()?.change(|body| add(&body.force, vec3(x, y, z)))
    }
    fn dBodyAddTorque(body: BodyId, x: Real, y: Real, z: Real) {
        body.get()?.change(|body| add(&body.torque, vec3(x, y, z)))
    }
    fn dBodyAddRelForce(body: BodyId, x: Real, y: Real, z: Real) {
        body.get()?.change(|body| add(&body.force, frame(body).1 * vec3(x, y, z)))
    }
    fn dBodyAddRelTorque(body: BodyId, x: Real, y: Real, z: Real) {
        body.get()?.change(|body| add(&body.torque, frame(body).1 * vec3(x, y, z)))
    }
    fn dBodyAddForceAtPos(body: BodyId, fx: Real, fy: Real, fz: Real, px: Real, py: Real, pz: Real) {
        push(body, |_| vec3(fx, fy, fz), |position, _| vec3(px, py, pz) - position)?
    }
    fn dBodyAddForceAtRelPos(body: BodyId, fx: Real, fy: Real, fz: Real, px: Real, py: Real, pz: Real) {
        push(body, |_| vec3(fx, fy, fz), |_, rotation| rotation * vec3(px, py, pz))?
    }
    fn dBodyAddRelForceAtPos(body: BodyId, fx: Real, fy: Real, fz: Real, px: Real, py: Real, pz: Real) {
        push(body, |rotation| rotation * vec3(fx, fy, fz), |position, _| vec3(px, py, pz) - position)?
    }
    fn dBodyAddRelForceAtRelPos(body: BodyId, fx: Real, fy: Real, fz: Real, px: Real, py: Real, pz: Real) {
        push(body, |rotation| rotation * vec3(fx, fy, fz), |_, rotation| rotation * vec3(px, py, pz))?
    }

    // ---- points and vectors ----

    fn dBodyGetRelPointPos(body: BodyId, x: Real, y: Real, z: Real, result: OutVector) {
        let (position, rotation) = frame(body.get()?.current());
        result.set(vector3(position + rotation * vec3(x, y, z)))?
    }
    fn dBodyGetRelPointVel(body: BodyId, x: Real, y: Real, z: Real, result: OutVector) {
        let body = body.get()?.current();
        result.set(vector3(velocity_at(body, frame(body).1 * vec3(x, y, z))))?
    }
    fn dBodyGetPointVel(body: BodyId, x: Real, y: Real, z: Real, result: OutVector) {
        let body = body.get()?.current();
        result.set(vector3(velocity_at(body, vec3(x, y, z) - frame(body).0)))?
    }
    fn dBodyGetPosRelPoint(body: BodyId, x: Real, y: Real, z: Real, result: OutVector) {
        let (position, rotation) = frame(body.get()?.current());
        result.set(vector3(rotation.transpose_mul(vec3(x, y, z) - position)))?
    }
    fn dBodyVectorToWorld(body: BodyId, x: Real, y: Real, z: Real, result: OutVector) {
        result.set(vector3(frame(body.get()?.current()).1 * vec3(x, y, z)))?
    }
    fn dBodyVectorFromWorld(body: BodyId, x: Real, y: Real, z: Real, result: OutVector) {
        result.set(vector3(frame(body.get()?.current()).1.transpose_mul(vec3(x, y, z))))?
    }

    // ---- sleeping ----

    fn dBodyEnable(body: BodyId) { body.get()?.engine(Body::enable)? }
    fn dBodyDisable(body: BodyId) { body.get()?.engine(Body::disable)? }
    fn dBodyIsEnabled(body: BodyId) -> c_int { read(body, Body::is_enabled)?.into() }

    fn dBodySetAutoDisableFlag(body: BodyId, on: c_int) {
        with_world(body, |engine, key| engine.set_body_auto_disable_flag(key, on != 0))?
    }
    fn dBodyGetAutoDisableFlag(body: BodyId) -> c_int { read(body, |b| b.auto_disable().enabled)?.into() }
    fn dBodySetAutoDisableDefaults(body: BodyId) {
        with_world(body, |engine, key| engine.set_body_auto_disable_defaults(key))?
    }
    fn dBodySetAutoDisableLinearThreshold(body: BodyId, x: Real) {
        auto_disable(body, |a| a.linear_threshold = threshold(x))?
    }
    fn dBodyGetAutoDisableLinearThreshold(body: BodyId) -> Real {
        r(read(body, |b| b.auto_disable().linear_threshold)?)
    }
    fn dBodySetAutoDisableAngularThreshold(body: BodyId, x: Real) {
        auto_disable(body, |a| a.angular_threshold = threshold(x))?
    }
    fn dBodyGetAutoDisableAngularThreshold(body: BodyId) -> Real {
        r(read(body, |b| b.auto_disable().angular_threshold)?)
    }
    fn dBodySetAutoDisableSteps(body: BodyId, steps: c_int) { auto_disable(body, |a| a.steps = steps)? }
    fn dBodyGetAutoDisableSteps(body: BodyId) -> c_int { read(body, |b| b.auto_disable().steps)? }
    fn dBodySetAutoDisableTime(body: BodyId, time: Real) { auto_disable(body, |a| a.time = f(time))? }
    fn dBodyGetAutoDisableTime(body: BodyId) -> Real { r(read(body, |b| b.auto_disable().time)?) }
    fn dBodySetAutoDisableAverageSamplesCount(body: BodyId, count: c_uint) {
        auto_disable(body, |a| a.average_samples = count)?
    }
    fn dBodyGetAutoDisableAverageSamplesCount(body: BodyId) -> c_int {
        read(body, |b| b.auto_disable().average_samples)? as c_int
    }

    // ---- how it is stepped ----

    fn dBodySetLinearDamping(body: BodyId, scale: Real) { damping(body, |d| d.linear_scale = f(scale))? }
    fn dBodyGetLinearDamping(body: BodyId) -> Real { r(read(body, |b| b.damping().linear_scale)?) }
    fn dBodySetAngularDamping(body: BodyId, scale: Real) { damping(body, |d| d.angular_scale = f(scale))? }
    fn dBodyGetAngularDamping(body: BodyId) -> Real { r(read(body, |b| b.damping().angular_scale)?) }
    fn dBodySetDamping(body: BodyId, linear: Real, angular: Real) {
        damping(body, |d| (d.linear_scale, d.angular_scale) = (f(linear), f(angular)))?
    }
    fn dBodySetLinearDampingThreshold(body: BodyId, x: Real) {
        damping(body, |d| d.linear_threshold = threshold(x))?
    }
    fn dBodyGetLinearDampingThreshold(body: BodyId) -> Real { r(read(body, |b| b.damping().linear_threshold)?) }
    fn dBodySetAngularDampingThreshold(body: BodyId, x: Real) {
        damping(body, |d| d.angular_threshold = threshold(x))?
    }
    fn dBodyGetAngularDampingThreshold(body: BodyId) -> Real { r(read(body, |b| b.damping().angular_threshold)?) }
    fn dBodySetDampingDefaults(body: BodyId) {
        with_world(body, |engine, key| engine.set_body_damping_defaults(key))?
    }
    fn dBodySetMaxAngularSpeed(body: BodyId, speed: Real) { with(body, |b| b.set_max_angular_speed(f(speed)))? }
    fn dBodyGetMaxAngularSpeed(body: BodyId) -> Real { r(read(body, Body::max_angular_speed)?) }
    fn dBodySetGravityMode(body: BodyId, on: c_int) { body.get()?.engine(|b| b.set_gravity_mode(on != 0))? }
    fn dBodyGetGravityMode(body: BodyId) -> c_int { read(body, Body::gravity_mode)?.into() }
    fn dBodySetGyroscopicMode(body: BodyId, on: c_int) { body.get()?.engine(|b| b.set_gyroscopic_mode(on != 0))? }
    fn dBodyGetGyroscopicMode(body: BodyId) -> c_int {
        if read(body, Body::gyroscopic_mode)? { GYROSCOPIC_FLAG } else { 0 }
    }
    fn dBodySetFiniteRotationMode(body: BodyId, on: c_int) {
        body.get()?.engine(|b| b.set_finite_rotation_mode(on != 0))?
    }
    fn dBodyGetFiniteRotationMode(body: BodyId) -> c_int { read(body, Body::finite_rotation_mode)?.into() }
    fn dBodySetFiniteRotationAxis(body: BodyId, x: Real, y: Real, z: Real) {
        with(body, |b| b.set_finite_rotation_axis(vec3(x, y, z)))?
    }
    fn dBodyGetFiniteRotationAxis(body: BodyId, axis: OutVector) {
        axis.set(vector3(read(body, Body::finite_rotation_axis)?))?
    }
    fn dBodySetMovedCallback(body: BodyId, callback: Option<MovedCallback>) {
        let body = body.get()?;
        crate::stepping::watch();
        body.moved.set(callback)
    }

    // ---- joints ----

    fn dBodyGetNumJoints(body: BodyId) -> c_int { read(body, Body::joint_count)? as c_int }
    fn dBodyGetJoint(body: BodyId, index: c_int) -> JointId {
        let (world, key) = body.get()?.place()?;
        let Ok(index) = usize::try_from(index) else { return Ok(JointId::NULL) };
        world.engine(|engine| {
            let joint = engine.body_joints(key).ok().and_then(|mut joints| joints.nth(index));
            joint.and_then(|joint| engine.joint_user_data(joint).ok()).map_or(JointId::NULL, handle_of)
        })
    }
}
