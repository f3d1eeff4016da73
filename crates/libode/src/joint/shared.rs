//! What joints of all types can do: be created, attached, asked for their bodies, and destroyed.

use crate::contact::ContactRecord;
use crate::fault::{Fault, Outcome, export, from_engine};
use crate::real::In;
use crate::record::{
    BodyId, BodyRecord, FeedbackRecord, GroupId, GroupRecord, JointId, JointRecord, Required, WorldId,
    WorldRecord, handle_of, number_of,
};
use crate::slab::{Link, Record};
use crate::stepping::listen;
use core::ffi::{c_int, c_void};
use ferrode_dynamics::{BodyKey, Error, JointKey, JointType, World};

/// A record for a joint that `make` creates in the engine, with the number that leads back to the record.
pub fn create(
    world: &'static WorldRecord,
    group: GroupId,
    joint_type: JointType,
    make: impl FnOnce(&mut World, u64) -> Result<JointKey, Error>,
) -> Outcome<JointId> {
    let group = if group.is_null() { None } else { Some(group.get()?) };
    let record = group.and_then(GroupRecord::reuse).unwrap_or_else(|| JointRecord::pool().create());
    let handle = JointId::of(record);
    let Ok(key) = world.engine(|engine| make(engine, number_of(handle))) else {
        JointRecord::pool().destroy(record);
        return Err(Fault::ARGUMENT);
    };
    record.world.set(Link::to(world));
    record.key.set(Some(key));
    record.joint_type.set(Some(joint_type));
    if let Some(group) = group {
        record.grouped.set(true);
        group.joints.borrow_mut().push(Link::to(record));
    }
    Ok(handle)
}

/// Takes a joint out of its world.
pub fn leave_world(record: &'static JointRecord) {
    if let Ok((world, key)) = record.place() {
        if !record.feedback.get().is_null() {
            listen(world, JointId::of(record), false);
        }
        world.engine(|engine| engine.destroy_joint(key)).ok();
    }
}

fn destroy_record(record: &'static JointRecord) {
    leave_world(record);
    JointRecord::pool().destroy(record);
}

fn of(joint_type: JointType, world: WorldId, group: GroupId) -> Outcome<JointId> {
    create(world.get()?, group, joint_type, |engine, number| {
        let key = engine.create_joint_of_type(joint_type, None)?;
        engine.set_joint_user_data(key, number).map(|()| key)
    })
}

/// A world, and keys of two of its bodies; `None` is the static world.
type Pair = (&'static WorldRecord, [Option<BodyKey>; 2]);

/// Two bodies of one world that a question is about; one of them may be the static world.
fn pair(a: BodyId, b: BodyId) -> Outcome<Option<Pair>> {
    let place = |body: BodyId| if body.is_null() { Ok(None) } else { body.get()?.place().map(Some) };
    let (first, second) = (place(a)?, place(b)?);
    let Some((world, _)) = first.or(second) else { return Err(Fault::ARGUMENT) };
    let strangers = matches!((first, second), (Some((a, _)), Some((b, _))) if !core::ptr::eq(a, b));
    Ok((!strangers).then(|| (world, [first.map(|(_, key)| key), second.map(|(_, key)| key)])))
}

/// What `work` makes of the joints that connect two bodies, newest first.
fn connecting<T: Default>(
    a: BodyId,
    b: BodyId,
    work: impl FnOnce(&World, &mut dyn Iterator<Item = JointKey>) -> T,
) -> Outcome<T> {
    let Some((world, [a, b])) = pair(a, b)? else { return Ok(T::default()) };
    world.engine(|engine| match engine.connecting_joints(a, b) {
        Ok(mut joints) => Ok(work(engine, &mut joints)),
        Err(_) => Err(Fault::ARGUMENT),
    })
}

/// Whether a joint of a type for which `test` holds connects two bodies.
fn are_connected(a: BodyId, b: BodyId, test: impl Fn(JointType) -> bool) -> Outcome<bool> {
    a.get()?;
    let Some((world, [a, b])) = pair(a, b)? else { return Ok(false) };
    world.engine(|engine| engine.any_joint_between(a, b, test).map_err(|_| Fault::ARGUMENT))
}

fn handle_in(world: &World, joint: JointKey) -> JointId {
    world.joint_user_data(joint).map_or(JointId::NULL, handle_of)
}

fn attach(joint: JointId, first: BodyId, second: BodyId) -> Outcome<()> {
    let joint = joint.get().map_err(|_| super::NO_JOINT)?;
    let (world, key) = joint.place()?;
    let records = [first, second].map(|body| if body.is_null() { Ok(None) } else { body.get().map(Some) });
    let [first, second] = records;
    let (first, second) = (first?, second?);
    if let (Some(a), Some(b)) = (first, second)
        && core::ptr::eq(a, b)
    {
        return Err(Fault::user("can't have body1==body2"));
    }
    for body in [first, second].into_iter().flatten() {
        if !body.world.get().is_to(world) {
            return Err(Fault::user("joint and bodies must be in same world"));
        }
        // A contact's frame is the world's: it does not look at the bodies when it is attached.
        if joint.joint_type.get() != Some(JointType::Contact) {
            body.take_in();
        }
    }
    let key_of = |body: Option<&BodyRecord>| body.and_then(|body| body.key.get());
    match world.engine(|engine| engine.attach(key, key_of(first), key_of(second))) {
        Ok(()) => Ok(()),
        Err(Error::NeedsTwoBodies(_)) => Err(Fault::user("joint can not be attached to just one body")),
        Err(error) => from_engine(&error),
    }
}

fn set_enabled(joint: JointId, on: bool) -> Outcome<()> {
    let (world, key) = joint.get()?.place()?;
    world.engine(|engine| engine.set_joint_enabled(key, on)).or_else(|error| from_engine(&error))
}

macro_rules! creators {
    ($($name:ident $joint:ident;)+) => {
        export! { $(fn $name(world: WorldId, group: GroupId) -> JointId { of(JointType::$joint, world, group)? })+ }
    };
}

creators! {
    dJointCreateBall Ball;
    dJointCreateHinge Hinge;
    dJointCreateSlider Slider;
    dJointCreateUniversal Universal;
    dJointCreateHinge2 Hinge2;
    dJointCreatePR PR;
    dJointCreatePU PU;
    dJointCreatePiston Piston;
    dJointCreateFixed Fixed;
    dJointCreateNull Null;
    dJointCreateAMotor AMotor;
    dJointCreateLMotor LMotor;
    dJointCreatePlane2D Plane2D;
    dJointCreateDBall DBall;
    dJointCreateDHinge DHinge;
    dJointCreateTransmission Transmission;
}

export! {
    fn dJointCreateContact(world: WorldId, group: GroupId, contact: In<ContactRecord>) -> JointId {
        let world = world.get()?;
        contact.look(|[contact]| {
            create(world, group, JointType::Contact, |engine, number| {
                Ok(engine.create_contact_unchecked(number, |out| contact.write_to(out)))
            })
        })??
    }

    /// Without effect for a joint of a group.
    fn dJointDestroy(joint: JointId) {
        let joint = joint.get()?;
        if !joint.grouped.get() {
            destroy_record(joint);
        }
    }

    fn dJointAttach(joint: JointId, body1: BodyId, body2: BodyId) { attach(joint, body1, body2)? }
    fn dJointEnable(joint: JointId) { set_enabled(joint, true)? }
    fn dJointDisable(joint: JointId) { set_enabled(joint, false)? }
    fn dJointIsEnabled(joint: JointId) -> c_int {
        let (world, key) = joint.get()?.place()?;
        world.engine(|engine| engine.is_joint_enabled(key)).unwrap_or(false).into()
    }
    fn dJointSetData(joint: JointId, data: *mut c_void) { joint.get()?.data.set(data) }
    fn dJointGetData(joint: JointId) -> *mut c_void { joint.get()?.data.get() }
    fn dJointGetType(joint: JointId) -> c_int { joint.get()?.joint_type.get().map_or(0, JointType::number) }

    fn dJointGetNumBodies(joint: JointId) -> c_int {
        let joint = joint.get().map_err(|_| super::NO_JOINT)?;
        if joint.world.get().is_null() {
            return Ok(0);
        }
        joint.bodies()?.iter().filter(|body| !body.is_null()).count() as c_int
    }
    fn dJointGetBody(joint: JointId, index: c_int) -> BodyId {
        let joint = joint.get()?;
        if joint.world.get().is_null() {
            return Ok(BodyId::NULL);
        }
        let bodies = joint.bodies()?;
        usize::try_from(index).ok().and_then(|index| bodies.get(index).copied()).unwrap_or(BodyId::NULL)
    }

    fn dJointSetFeedback(joint: JointId, feedback: *mut FeedbackRecord) {
        let record = joint.get()?;
        let (world, key) = record.place()?;
        record.feedback.set(feedback);
        world.engine(|engine| engine.set_joint_feedback(key, !feedback.is_null())).ok();
        listen(world, joint, !feedback.is_null())
    }
    fn dJointGetFeedback(joint: JointId) -> *mut FeedbackRecord { joint.get()?.feedback.get() }

    fn dConnectingJoint(body1: BodyId, body2: BodyId) -> JointId {
        connecting(body1, body2, |world, joints| joints.next().map(|key| handle_in(world, key)))?.unwrap_or(JointId::NULL)
    }
    fn dConnectingJointList(body1: BodyId, body2: BodyId, list: *mut JointId) -> c_int {
        let joints: Vec<JointId> = connecting(body1, body2, |world, joints| {
            joints.map(|key| handle_in(world, key)).collect()
        })?;
        if list.is_null() && !joints.is_empty() {
            return Err(Fault::ARGUMENT);
        }
        for (i, joint) in joints.iter().enumerate() {
            // SAFETY: not null, and the caller supplies room for all joints (the function's contract).
            unsafe { list.add(i).write(*joint) };
        }
        joints.len() as c_int
    }
    fn dAreConnected(body1: BodyId, body2: BodyId) -> c_int { are_connected(body1, body2, |_| true)?.into() }
    fn dAreConnectedExcluding(body1: BodyId, body2: BodyId, joint_type: c_int) -> c_int {
        are_connected(body1, body2, |other| other.number() != joint_type)?.into()
    }
}
