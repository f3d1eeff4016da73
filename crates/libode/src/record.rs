//! The records behind handles: worlds, bodies, joints and joint groups.
//!
//! A body's record **is** the body's state as the program sees it: getters return pointers into it, setters write to it,
//! and so may the program. [`take_in`](BodyRecord::take_in) carries what has changed to the engine before the engine
//! needs it, [`publish`](BodyRecord::publish) carries it back after the engine has changed it.

use crate::fault::{Fault, Outcome, from_engine};
use crate::mass::MassRecord;
use crate::memory::Lender;
use crate::real::{Real, Real4, Real12, mat3, matrix3, padded, quat, quaternion, vector};
use crate::slab::{Handle, Link, Pool, Record, Tag};
use core::cell::{Cell, RefCell};
use core::ffi::c_void;
use core::sync::atomic::{AtomicUsize, Ordering};
use ferrode_dynamics::{BodyKey, BodyState, DirectSettings, JointKey, JointType, World};
use std::collections::VecDeque;

pub type WorldId = Handle<WorldRecord>;
pub type BodyId = Handle<BodyRecord>;
pub type JointId = Handle<JointRecord>;
pub type GroupId = Handle<GroupRecord>;

/// What is called when a step has moved a body.
pub type MovedCallback = unsafe extern "C-unwind" fn(BodyId);

macro_rules! record {
    ($name:ident, $pool:ident, $kind:literal) => {
        static $pool: Pool<$name> = Pool::new();
        impl Record for $name {
            const KIND: usize = $kind;
            fn blank() -> Self {
                Self::default()
            }
            fn tag(&self) -> &Tag {
                &self.tag
            }
            fn pool() -> &'static Pool<Self> {
                &$pool
            }
        }
    };
}
pub(crate) use record;

/// A world.
#[derive(Default)]
pub struct WorldRecord {
    tag: Tag,
    /// The engine's world. During a moved callback it is the step's own reborrow.
    engine: Cell<Option<*mut World>>,
    /// Whose memory the engine's world is in, if it is the program's.
    lender: Cell<Option<Lender>>,
    /// The thread in which a step runs, 0 for none. For that thread, which only comes here from callbacks, the engine's state
    /// is the newer one, not the records'. Others must not be here; should one look all the same, as a program may that
    /// draws while it steps, it sees the records, not an engine at work.
    stepping: AtomicUsize,
    pub data: Cell<*const c_void>,
    pub settings: crate::stepping::StepSettings,
    /// Joints that want their forces written down.
    pub listeners: RefCell<Vec<JointId>>,
}
record!(WorldRecord, WORLDS, 1);

/// A body.
#[derive(Default)]
pub struct BodyRecord {
    tag: Tag,
    pub position: Cell<Real4>,
    pub quaternion: Cell<Real4>,
    pub rotation: Cell<Real12>,
    pub linear_velocity: Cell<Real4>,
    pub angular_velocity: Cell<Real4>,
    pub force: Cell<Real4>,
    pub torque: Cell<Real4>,
    pub mass: Cell<MassRecord>,
    pub world: Cell<Link<WorldRecord>>,
    pub key: Cell<Option<BodyKey>>,
    pub data: Cell<*mut c_void>,
    pub moved: Cell<Option<MovedCallback>>,
    pub first_geom: Cell<Link<crate::geom::GeomRecord>>,
}
record!(BodyRecord, BODIES, 2);

/// A joint.
#[derive(Default)]
pub struct JointRecord {
    tag: Tag,
    /// Null for a joint of a group whose world was destroyed.
    pub world: Cell<Link<WorldRecord>>,
    pub key: Cell<Option<JointKey>>,
    pub joint_type: Cell<Option<JointType>>,
    pub data: Cell<*mut c_void>,
    pub feedback: Cell<*mut FeedbackRecord>,
    pub grouped: Cell<bool>,
}
record!(JointRecord, JOINTS, 3);

/// A joint group: joints of any worlds that are destroyed together.
#[derive(Default)]
pub struct GroupRecord {
    tag: Tag,
    /// Oldest first.
    pub joints: RefCell<Vec<Link<JointRecord>>>,
    /// Records of joints that were destroyed with the group's others: nobody else's, to be used again by this group.
    pub spare: RefCell<VecDeque<Link<JointRecord>>>,
}
record!(GroupRecord, GROUPS, 4);

/// `dJointFeedback`: memory of the program's.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct FeedbackRecord {
    pub force1: Real4,
    pub torque1: Real4,
    pub force2: Real4,
    pub torque2: Real4,
}

impl<T> Default for Handle<T> {
    fn default() -> Self {
        Self::NULL
    }
}

/// Islands with fewer rows are solved by Dantzig's method.
const DENSE_ROWS: usize = 100;

impl WorldRecord {
    /// A record for a new world. The program's memory handler may be called.
    pub fn create() -> &'static Self {
        let room = Lender::room::<World>();
        let record = WORLDS.create();
        let mut world = World::new();
        // ODE's default for float; the engine has that for double.
        if cfg!(feature = "single") {
            world.set_cfm(1e-5).ok();
        }
        // Small islands by ODE's own method: sooner, and with ODE's choice among forces that the problem leaves open.
        let direct = DirectSettings { dense_rows: DENSE_ROWS, ..*world.direct() };
        world.set_direct(direct);
        record.lender.set(room.map(|(_, lender)| lender));
        record.engine.set(Some(match room {
            Some((room, _)) => {
                // SAFETY: room for a world, aligned, nobody else's.
                unsafe { room.write(world) };
                room.as_ptr()
            }
            None => Box::into_raw(Box::new(world)),
        }));
        record
    }

    /// Work on the engine's world. The engine never calls out but from a step, which hands over its own reference first,
    /// and `work` must not call out either.
    #[inline]
    pub fn engine<T>(&self, work: impl FnOnce(&mut World) -> T) -> T {
        let engine = self.engine.get();
        // A living record has a world; a dead one is never reached through a handle.
        let engine = engine.expect("a living world has an engine");
        // SAFETY: the pointer is from `create`, or a reborrow that a step lends out while it waits for a
        // callback. A world is used by one thread at a time (the C interface's contract), `work` does not call out, so no
        // other reference is in use.
        work(unsafe { &mut *engine })
    }

    /// A step of this thread begins or ends.
    pub fn set_stepping(&self, on: bool) {
        self.stepping.store(if on { this_thread() } else { 0 }, Ordering::Relaxed);
    }

    /// Whether a step of this thread runs.
    #[inline]
    fn steps_here(&self) -> bool {
        let thread = self.stepping.load(Ordering::Relaxed);
        thread != 0 && thread == this_thread()
    }

    fn is_stepping(&self) -> bool {
        self.stepping.load(Ordering::Relaxed) != 0
    }

    /// The pointer by which calls reach the engine; a step exchanges it while it calls out.
    pub fn lend(&self, engine: *mut World) -> Option<*mut World> {
        self.engine.replace(Some(engine))
    }

    /// Gives the pointer back that [`WorldRecord::lend`] took.
    pub fn restore(&self, engine: Option<*mut World>) {
        self.engine.set(engine);
    }

    /// Takes all bodies' outside changes in.
    pub fn take_in_all(&self) {
        self.engine(|world| {
            let mut bodies: Vec<BodyId> = Vec::with_capacity(world.body_count());
            bodies.extend(world.bodies().map(|(_, body)| handle_of(body.user_data())));
            for body in bodies.into_iter().filter_map(BodyId::live) {
                body.take_in_to(world);
            }
        });
    }

    /// Shows all bodies' states.
    pub fn publish_all(&self) {
        self.engine(|world| {
            for (_, body) in world.bodies() {
                if let Some(record) = handle_of::<BodyRecord>(body.user_data()).live() {
                    record.show(&body.state());
                }
            }
        });
    }

    /// Destroys the world's engine; what is left of the record is the caller's to clear, as is the room that it was in, if
    /// that is the program's. During a step the engine is only forgotten, since the step still runs on it.
    pub fn destroy_engine(&self) -> Option<(*mut World, Lender)> {
        let engine = self.engine.take().filter(|_| !self.is_stepping())?;
        if let Some(lender) = self.lender.take() {
            // SAFETY: written in `create`, no step runs on it, and it is out of the record now.
            unsafe { engine.drop_in_place() };
            return Some((engine, lender));
        }
        // SAFETY: from Box::into_raw in `create`; the rest as above.
        drop(unsafe { Box::from_raw(engine) });
        None
    }
}

/// The handle that was kept as a number of the caller's in the engine.
pub fn handle_of<T: Record>(user_data: u64) -> Handle<T> {
    Handle::from_address(user_data as usize)
}

/// A number that no other living thread has.
fn this_thread() -> usize {
    thread_local! {
        static HERE: u8 = const { 0 };
    }
    // Nothing to drop, so that it is there to the end.
    HERE.with(|here| core::ptr::from_ref(here).addr())
}

/// The number to keep in the engine.
pub fn number_of<T: Record>(handle: Handle<T>) -> u64 {
    handle.address() as u64
}

/// Whether two groups of reals differ in any bit: −0 is not 0 here, and a NaN equals itself.
fn differ<const N: usize>(a: &[Real; N], b: &[Real; N]) -> bool {
    a.iter().zip(b).any(|(a, b)| a.to_bits() != b.to_bits())
}

/// As [`differ`], for the three components of padded vectors.
fn differ3(a: &Real4, b: &Real4) -> bool {
    (0..3).any(|i| a[i].to_bits() != b[i].to_bits())
}

impl BodyRecord {
    /// A record for a new body of a world.
    pub fn create(world: &'static WorldRecord) -> &'static Self {
        let record = BODIES.create();
        record.world.set(Link::to(world));
        world.engine(|engine| {
            let key = engine.create_body();
            if let Ok(body) = engine.body_mut(key) {
                body.set_user_data(number_of(BodyId::of(record)));
                record.show(&body.state());
            }
            record.key.set(Some(key));
        });
        record.mass.set(MassRecord::UNIT);
        record
    }

    /// The body's world and key.
    pub fn place(&self) -> Outcome<(&'static WorldRecord, BodyKey)> {
        let world = self.world.get().live().ok_or(Fault::ARGUMENT)?;
        Ok((world, self.key.get().ok_or(Fault::ARGUMENT)?))
    }

    /// Work on the engine's body. The state that it sees is the record's.
    pub fn engine<T>(&self, work: impl FnOnce(&mut ferrode_dynamics::Body) -> T) -> Outcome<T> {
        let (world, key) = self.place()?;
        world.engine(|engine| match engine.body_mut(key) {
            Ok(body) => Ok(work(body)),
            Err(error) => Err(from_engine(&error).err().unwrap_or(Fault::ARGUMENT)),
        })
    }

    /// Changes the state in the record. During a step the engine's state is the newer one: it is shown first, and takes
    /// the change in at once.
    #[inline]
    pub fn change(&self, work: impl FnOnce(&Self)) {
        let stepping = self.world.get().live().filter(|world| world.steps_here());
        if let Some(world) = stepping {
            self.publish(world);
            work(self);
            world.engine(|engine| self.take_in_to(engine));
        } else {
            work(self);
        }
    }

    /// The state as it is now, for a getter.
    #[inline]
    pub fn current(&self) -> &Self {
        if let Some(world) = self.world.get().live().filter(|world| world.steps_here()) {
            self.publish(world);
        }
        self
    }

    /// Shows the engine's state.
    pub fn publish(&self, world: &WorldRecord) {
        let Some(key) = self.key.get() else { return };
        world.engine(|engine| {
            if let Ok(body) = engine.body(key) {
                self.show(&body.state());
            }
        });
    }

    pub fn show(&self, state: &BodyState) {
        self.position.set(padded(state.position));
        self.quaternion.set(quaternion(state.quaternion));
        self.rotation.set(matrix3(&state.rotation));
        self.linear_velocity.set(padded(state.linear_velocity));
        self.angular_velocity.set(padded(state.angular_velocity));
        self.force.set(padded(state.force));
        self.torque.set(padded(state.torque));
    }

    /// Takes outside changes in, before the engine needs the body. During a step there is nothing to take in.
    pub fn take_in(&self) {
        if let Some(world) = self.world.get().live().filter(|world| !world.is_stepping()) {
            world.engine(|engine| self.take_in_to(engine));
        }
    }

    /// Only what differs from what was shown is taken in: with reals narrower than the engine's the rest keeps its digits.
    pub fn take_in_to(&self, engine: &mut World) {
        let Some(Ok(body)) = self.key.get().map(|key| engine.body_mut(key)) else { return };
        let mut state = body.state();
        let mut changed = false;
        let mut vectors = [
            (&self.position, &mut state.position),
            (&self.linear_velocity, &mut state.linear_velocity),
            (&self.angular_velocity, &mut state.angular_velocity),
            (&self.force, &mut state.force),
            (&self.torque, &mut state.torque),
        ];
        for (shown, engines) in &mut vectors {
            let shown = shown.get();
            if differ3(&shown, &padded(**engines)) {
                **engines = vector(&shown);
                changed = true;
            }
        }
        if differ(&self.quaternion.get(), &quaternion(state.quaternion)) {
            state.quaternion = quat(&self.quaternion.get());
            changed = true;
        }
        let rotation = mat3(&self.rotation.get());
        if differ(&matrix3(&rotation), &matrix3(&state.rotation)) {
            state.rotation = rotation;
            changed = true;
        }
        if changed {
            body.set_state(&state);
        }
    }

    /// The body of a key, in a world where every body has its record.
    pub fn of_key(engine: &World, key: Option<BodyKey>) -> BodyId {
        let body = key.and_then(|key| engine.body(key).ok());
        body.map_or(BodyId::NULL, |body| handle_of(body.user_data()))
    }
}

impl JointRecord {
    /// Makes a dead record that a group has kept a blank living one.
    pub fn renew(&self) {
        self.world.set(Link::NULL);
        self.key.set(None);
        self.joint_type.set(None);
        self.data.set(core::ptr::null_mut());
        self.feedback.set(core::ptr::null_mut());
        self.grouped.set(false);
        self.tag.revive();
    }

    /// The joint's world and key.
    pub fn place(&self) -> Outcome<(&'static WorldRecord, JointKey)> {
        let world = self.world.get().live().ok_or(Fault::ARGUMENT)?;
        Ok((world, self.key.get().ok_or(Fault::ARGUMENT)?))
    }

    /// The records of the joint's bodies, in the order of the call that attached them.
    pub fn bodies(&self) -> Outcome<[BodyId; 2]> {
        let (world, key) = self.place()?;
        world.engine(|engine| {
            let keys = engine.joint_bodies(key).map_err(|_| Fault::ARGUMENT)?;
            Ok(keys.map(|key| BodyRecord::of_key(engine, key)))
        })
    }
}

/// The living record behind a handle, or ODE's fault for a bad one.
pub trait Required<T> {
    /// The record, or the fault.
    fn get(self) -> Outcome<&'static T>;
}

impl<T: Record> Required<T> for Handle<T> {
    #[inline]
    fn get(self) -> Outcome<&'static T> {
        self.live().ok_or(Fault::ARGUMENT)
    }
}
