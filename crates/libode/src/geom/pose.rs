//! Where geoms are: their own poses, their bodies', and offsets within these.

use super::{GeomId, GeomRecord, body_moved};
use crate::body;
use crate::fault::{Fault, Outcome, export};
use crate::real::{
    InMatrix, InQuaternion, OutMatrix, OutQuaternion, OutVector, Real, Real4, Real12, mat3, matrix3, padded,
    quat, quaternion, vec3, vector, vector3,
};
use crate::record::Required;
use core::ffi::c_int;
use ferrode_collide::Frame;
use ferrode_math::{Mat3, Quat, Vec3};

/// What getters point to when there is no offset.
static NO_OFFSET: [Real; 4] = [0.0; 4];
static NO_TURN: [Real; 12] = [1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0];

fn placeable(geom: GeomId) -> Outcome<&'static GeomRecord> {
    let geom = geom.get()?;
    geom.require_placeable()?;
    Ok(geom)
}

/// Puts a geom somewhere: moves its body, if it has one, so that the geom lands there.
pub fn place(geom: &GeomRecord, frame: &Frame, turned: bool) -> Outcome<()> {
    let Some(body) = geom.on_body() else {
        geom.position.set(padded(frame.position));
        geom.rotation.set(matrix3(&frame.rotation));
        return geom.moved();
    };
    let (position, rotation) = match geom.offset() {
        None => (frame.position, frame.rotation),
        Some(offset) => {
            let rotation = frame.rotation * offset.rotation.transpose();
            (frame.position - rotation * offset.position, rotation)
        }
    };
    if turned {
        body::rotate(body, &rotation)?;
    }
    body.change(|body| body.position.set(padded(position)));
    body_moved(body)
}

fn on_body(geom: GeomId) -> Outcome<(&'static GeomRecord, Frame)> {
    let geom = placeable(geom)?;
    let body = geom.on_body().ok_or(Fault::user("geom must be on a body"))?.current();
    Ok((geom, Frame::new(vector(&body.position.get()), mat3(&body.rotation.get()))))
}

fn set_offset(geom: &GeomRecord, position: Vec3, rotation: &Mat3) -> Outcome<()> {
    geom.offset_position.set(padded(position));
    geom.offset_rotation.set(matrix3(rotation));
    geom.has_offset.set(true);
    geom.moved()
}

/// Sets one part of the offset, the other stays.
fn change_offset(geom: GeomId, change: impl FnOnce(&mut Frame)) -> Outcome<()> {
    let (geom, _) = on_body(geom)?;
    let mut offset = geom.offset().unwrap_or(Frame::IDENTITY);
    change(&mut offset);
    set_offset(geom, offset.position, &offset.rotation)
}

fn set_offset_world_rotation(geom: GeomId, rotation: &Mat3) -> Outcome<()> {
    let (geom, body) = on_body(geom)?;
    let position = body.point_to_local(geom.frame().position);
    set_offset(geom, position, &(body.rotation.transpose() * *rotation))
}

/// Copies a matrix to the program; as in ODE the padding there stays as it is.
fn copy(mut m: Real12, to: OutMatrix) -> Outcome<()> {
    let there = to.get()?;
    for pad in [3, 7, 11] {
        m[pad] = there[pad];
    }
    to.set(m)
}

/// Where the pose's numbers are: in the body's record if the geom is just where the body is.
fn pointer(
    geom: GeomId,
    own: fn(&GeomRecord) -> *mut Real,
    bodys: fn(&crate::record::BodyRecord) -> *mut Real,
) -> Outcome<*const Real> {
    let geom = placeable(geom)?;
    geom.frame();
    Ok(match geom.on_body() {
        Some(body) if !geom.has_offset.get() => bodys(body),
        _ => own(geom),
    })
}

/// A point or vector by the geom's frame; one without a pose gives it back.
fn by_frame(
    geom: GeomId,
    v: Vec3,
    result: OutVector,
    work: impl FnOnce(&Frame, Vec3) -> Vec3,
) -> Outcome<()> {
    let geom = geom.get()?;
    result.set(vector3(if geom.is_placeable() { work(&geom.frame(), v) } else { v }))
}

fn offset_position(geom: &GeomRecord) -> Real4 {
    if geom.has_offset.get() { geom.offset_position.get() } else { NO_OFFSET }
}

fn offset_rotation(geom: &GeomRecord) -> Real12 {
    if geom.has_offset.get() { geom.offset_rotation.get() } else { NO_TURN }
}

export! {
    fn dGeomSetPosition(geom: GeomId, x: Real, y: Real, z: Real) {
        let geom = placeable(geom)?;
        let mut frame = geom.frame();
        frame.position = vec3(x, y, z);
        place(geom, &frame, false)?
    }
    fn dGeomSetRotation(geom: GeomId, rotation: InMatrix) {
        let geom = placeable(geom)?;
        let mut frame = geom.frame();
        frame.rotation = mat3(&rotation.get()?);
        place(geom, &frame, true)?
    }
    /// As in ODE the body of a geom with an offset gets the quaternion itself in the end, so that the geom is turned by
    /// its offset too much.
    fn dGeomSetQuaternion(geom: GeomId, q: InQuaternion) {
        let geom = placeable(geom)?;
        let q = quat(&q.get()?);
        if geom.on_body().is_none() || geom.has_offset.get() {
            let mut frame = geom.frame();
            frame.rotation = q.to_matrix();
            place(geom, &frame, true)?;
        }
        if let Some(body) = geom.on_body() {
            body::orient(body, q)?;
        }
    }
    fn dGeomGetPosition(geom: GeomId) -> *const Real {
        pointer(geom, |geom| geom.position.as_ptr(), |body| body.position.as_ptr().cast())?
    }
    fn dGeomGetRotation(geom: GeomId) -> *const Real {
        pointer(geom, |geom| geom.rotation.as_ptr(), |body| body.rotation.as_ptr().cast())?
    }
    fn dGeomCopyPosition(geom: GeomId, position: OutVector) {
        position.set(vector3(placeable(geom)?.frame().position))?
    }
    fn dGeomCopyRotation(geom: GeomId, rotation: OutMatrix) {
        let frame = placeable(geom)?.frame();
        copy(matrix3(&frame.rotation), rotation)?
    }
    fn dGeomGetQuaternion(geom: GeomId, q: OutQuaternion) {
        let geom = placeable(geom)?;
        match geom.on_body() {
            Some(body) if !geom.has_offset.get() => q.set(body.current().quaternion.get())?,
            _ => q.set(quaternion(Quat::from_matrix(&geom.frame().rotation)))?,
        }
    }

    fn dGeomSetOffsetPosition(geom: GeomId, x: Real, y: Real, z: Real) {
        change_offset(geom, |offset| offset.position = vec3(x, y, z))?
    }
    fn dGeomSetOffsetRotation(geom: GeomId, rotation: InMatrix) {
        let rotation = mat3(&rotation.get()?);
        change_offset(geom, |offset| offset.rotation = rotation)?
    }
    fn dGeomSetOffsetQuaternion(geom: GeomId, q: InQuaternion) {
        let rotation = quat(&q.get()?).to_matrix();
        change_offset(geom, |offset| offset.rotation = rotation)?
    }
    fn dGeomSetOffsetWorldPosition(geom: GeomId, x: Real, y: Real, z: Real) {
        let (_, body) = on_body(geom)?;
        change_offset(geom, |offset| offset.position = body.point_to_local(vec3(x, y, z)))?
    }
    fn dGeomSetOffsetWorldRotation(geom: GeomId, rotation: InMatrix) {
        set_offset_world_rotation(geom, &mat3(&rotation.get()?))?
    }
    fn dGeomSetOffsetWorldQuaternion(geom: GeomId, q: InQuaternion) {
        set_offset_world_rotation(geom, &quat(&q.get()?).to_matrix())?
    }
    fn dGeomClearOffset(geom: GeomId) {
        let geom = placeable(geom)?;
        if geom.has_offset.replace(false) {
            geom.moved()?;
        }
    }
    /// Also of a geom that has no place, as for the getters of offsets: there is none.
    fn dGeomIsOffset(geom: GeomId) -> c_int { geom.get()?.has_offset.get().into() }
    fn dGeomGetOffsetPosition(geom: GeomId) -> *const Real {
        let geom = geom.get()?;
        if geom.has_offset.get() { geom.offset_position.as_ptr().cast_const().cast() } else { NO_OFFSET.as_ptr() }
    }
    fn dGeomGetOffsetRotation(geom: GeomId) -> *const Real {
        let geom = geom.get()?;
        if geom.has_offset.get() { geom.offset_rotation.as_ptr().cast_const().cast() } else { NO_TURN.as_ptr() }
    }
    fn dGeomCopyOffsetPosition(geom: GeomId, position: OutVector) {
        position.set(vector3(vector(&offset_position(geom.get()?))))?
    }
    fn dGeomCopyOffsetRotation(geom: GeomId, rotation: OutMatrix) {
        copy(offset_rotation(geom.get()?), rotation)?
    }
    fn dGeomGetOffsetQuaternion(geom: GeomId, q: OutQuaternion) {
        q.set(quaternion(Quat::from_matrix(&mat3(&offset_rotation(geom.get()?)))))?
    }

    fn dGeomGetRelPointPos(geom: GeomId, x: Real, y: Real, z: Real, result: OutVector) {
        by_frame(geom, vec3(x, y, z), result, Frame::point_to_world)?
    }
    fn dGeomGetPosRelPoint(geom: GeomId, x: Real, y: Real, z: Real, result: OutVector) {
        by_frame(geom, vec3(x, y, z), result, Frame::point_to_local)?
    }
    fn dGeomVectorToWorld(geom: GeomId, x: Real, y: Real, z: Real, result: OutVector) {
        by_frame(geom, vec3(x, y, z), result, Frame::vector_to_world)?
    }
    fn dGeomVectorFromWorld(geom: GeomId, x: Real, y: Real, z: Real, result: OutVector) {
        by_frame(geom, vec3(x, y, z), result, Frame::vector_to_local)?
    }
}
