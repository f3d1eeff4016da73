//! Steps: what is taken in before, called meanwhile, and shown after.

use crate::fault::{Fault, Outcome, export, export_calling, fence, message};
use crate::misc;
use crate::real::{In, Out, Real, f, padded};
use crate::record::{BodyId, JointId, Required, WorldId, WorldRecord, handle_of};
use crate::threading::{FunctionsInfo, ImplementationId};
use core::cell::Cell;
use core::ffi::{c_int, c_uint, c_void};
use core::sync::atomic::{AtomicBool, Ordering};
use ferrode_dynamics::{BodyKey, JointFeedback, Stepper, World};
use ferrode_math::Vec3;
use ferrode_math::random::OdeRandom;

/// `dWorldStepReserveInfo`.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct ReserveInfo {
    struct_size: c_uint,
    reserve_factor: f32,
    reserve_minimum: c_uint,
}

impl Default for ReserveInfo {
    fn default() -> Self {
        Self { struct_size: size_of::<Self>() as c_uint, reserve_factor: 1.2, reserve_minimum: 65536 }
    }
}

/// `dWorldStepMemoryFunctionsInfo`.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct MemoryFunctions {
    struct_size: c_uint,
    alloc_block: Option<unsafe extern "C-unwind" fn(usize) -> *mut c_void>,
    shrink_block: Option<unsafe extern "C-unwind" fn(*mut c_void, usize, usize) -> *mut c_void>,
    free_block: Option<unsafe extern "C-unwind" fn(*mut c_void, usize)>,
}

/// A block that a program's memory manager gave, and the manager that takes it back.
#[derive(Clone, Copy, Debug)]
struct Block {
    address: *mut c_void,
    size: usize,
    manager: MemoryFunctions,
}

/// `dWorldSteppingThreadingParameters` of the newest ODE.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct ThreadLimits {
    /// Which of the others count: 1, 2, 4.
    which: c_uint,
    islands: c_uint,
    stepping: c_uint,
    solving: c_uint,
}

/// How a world steps, apart from the engine's own parameters.
#[derive(Default)]
pub struct StepSettings {
    /// What was asked for, which may be less than none.
    pub quick_iterations: Cell<Option<c_int>>,
    pub max_threads: Cell<c_uint>,
    /// Threads for one island, and for one solve less one (so that the default is 0): kept for their reader.
    island_threads: Cell<[c_uint; 2]>,
    pub dynamic: crate::dynamic_iterations::Settings,
    reserve: Cell<ReserveInfo>,
    manager: Cell<Option<MemoryFunctions>>,
    block: Cell<Option<Block>>,
    pub threading: Cell<Option<(FunctionsInfo, ImplementationId)>>,
}

impl StepSettings {
    /// Gives the program's memory manager its block back.
    pub fn free_step_memory(&self) {
        if let Some(Block { address, size, manager }) = self.block.take()
            && let Some(free) = manager.free_block
        {
            // SAFETY: the block came from this manager's alloc_block, with this size, and is given back once.
            unsafe { free(address, size) };
        }
    }

    /// Asks the program's memory manager for what ODE would work in. The engine has memory of its own; the program gets
    /// to see its manager used, in balance. `false` if it has no memory to give.
    fn reserve_step_memory(&self, bodies: usize, joints: usize) -> bool {
        let Some(manager) = self.manager.get() else { return true };
        let Some(alloc) = manager.alloc_block else { return true };
        let needed = 1024 + 256 * bodies + 1024 * joints;
        if self.block.get().is_some_and(|block| block.size >= needed) {
            return true;
        }
        self.free_step_memory();
        let policy = self.reserve.get();
        let size = ((needed as f64 * f64::from(policy.reserve_factor)) as usize)
            .max(policy.reserve_minimum as usize);
        // SAFETY: the program's own function, called as its header says.
        let address = unsafe { alloc(size) };
        if address.is_null() {
            return false;
        }
        self.block.set(Some(Block { address, size, manager }));
        true
    }
}

/// How a step is made.
#[derive(Clone, Copy, Debug)]
pub enum Method {
    Plain(Stepper),
    /// The old StepFast.
    Fast {
        iterations: c_uint,
        depth: c_uint,
    },
}

/// One step, as all entry points make it.
pub fn step(world: &'static WorldRecord, method: Method, stepsize: Real) -> Outcome<c_int> {
    let h = f(stepsize);
    if h.is_nan() || h <= 0.0 || h.is_infinite() {
        return Err(Fault::user("stepsize must be > 0"));
    }
    let (bodies, joints) = world.engine(|engine| (engine.body_count(), engine.joint_count()));
    if !world.settings.reserve_step_memory(bodies, joints) {
        return Ok(0);
    }
    // A callback that left by longjmp may have left this set.
    world.set_stepping(false);
    world.take_in_all();
    mark_feedback(world);

    let seed = misc::seed();
    let mut random = OdeRandom::new(seed);
    let mut observe = |engine: &mut World, key: BodyKey| call_back(world, engine, key);
    let engine = world.engine(core::ptr::from_mut);
    world.set_stepping(true);
    // SAFETY: as in `WorldRecord::engine`; when the step calls out, `call_back` lends its own reborrow to other calls.
    let engine_world = unsafe { &mut *engine };
    let report = match method {
        Method::Plain(stepper) => {
            // Without callbacks of the program's nothing changes the engine's world meanwhile.
            let looks_only = !WATCHED.load(Ordering::Relaxed);
            engine_world.step_observed(stepper, h, &mut random, (&mut observe, looks_only))
        }
        Method::Fast { iterations, depth } => {
            engine_world.step_fast(h, iterations, depth, &mut random, &mut observe)
        }
    };
    world.restore(Some(engine));
    world.set_stepping(false);
    if random.seed() != seed {
        misc::set_seed(random.seed());
    }
    world.publish_all();
    write_feedback(world);
    let report = report.map_err(|_| Fault::user("stepsize must be > 0"))?;
    if matches!(method, Method::Plain(Stepper::Quick)) {
        crate::dynamic_iterations::count(world, &report);
    }
    for _ in 0..report.lcp_failures {
        message(3, "LCP internal error: no step length", "");
    }
    Ok(1)
}

/// Whether any body has had a moved callback. Until then nobody looks at bodies during a step: they are shown after it.
static WATCHED: AtomicBool = AtomicBool::new(false);

/// Has bodies shown one by one as steps move them, for callbacks to see.
pub fn watch() {
    WATCHED.store(true, Ordering::Relaxed);
}

/// Shows a body that was just moved and calls its moved callback, if it has one. What the callback changes holds.
fn call_back(world: &'static WorldRecord, engine: &mut World, key: BodyKey) {
    let Ok(body) = engine.body(key) else { return };
    let handle: BodyId = handle_of(body.user_data());
    let Some(record) = handle.live() else { return };
    if WATCHED.load(Ordering::Relaxed) {
        record.show(&body.state());
    }
    // A space that is locked, by a step within a near callback, learns of it when it is asked again.
    crate::geom::body_moved(record).ok();
    let Some(moved) = record.moved.get() else { return };
    let before = world.lend(engine);
    // SAFETY: the program's own function, called as its header says, with the handle that it set it for. No reference to
    // the engine is used meanwhile but what `lend` lends.
    unsafe { moved(handle) };
    world.restore(before);
    if let Some(record) = handle.live() {
        record.take_in_to(engine);
    }
}

/// Marks all recorded forces, to tell afterwards which joints the step has written for.
fn mark_feedback(world: &WorldRecord) {
    let listeners = world.listeners.borrow();
    world.engine(|engine| {
        for joint in listeners.iter().filter_map(|joint| joint.live()) {
            if let Some(Ok(Some(feedback))) = joint.key.get().map(|key| engine.joint_feedback_mut(key)) {
                let mark = Vec3::splat(f64::NAN);
                *feedback = JointFeedback { force1: mark, torque1: mark, force2: mark, torque2: mark };
            }
        }
    });
}

/// Copies forces to the program's records. ODE leaves a record as it was if its joint had no rows, and the second body's
/// part if there is none.
fn write_feedback(world: &WorldRecord) {
    let listeners = world.listeners.borrow();
    world.engine(|engine| {
        for joint in listeners.iter().filter_map(|joint| joint.live()) {
            let Some(Ok(Some(feedback))) = joint.key.get().map(|key| engine.joint_feedback(key)) else {
                continue;
            };
            let target = joint.feedback.get();
            if target.is_null() || feedback.force1.x.is_nan() {
                continue;
            }
            // SAFETY: the program keeps the record it gave until it sets another, or the joint dies (the contract of
            // dJointSetFeedback).
            let target = unsafe { &mut *target };
            target.force1 = padded(feedback.force1);
            target.torque1 = padded(feedback.torque1);
            if !feedback.force2.x.is_nan() {
                target.force2 = padded(feedback.force2);
                target.torque2 = padded(feedback.torque2);
            }
        }
    });
}

/// A joint starts or stops to have its forces written down.
pub fn listen(world: &WorldRecord, joint: JointId, on: bool) {
    let mut listeners = world.listeners.borrow_mut();
    let place = listeners.iter().position(|other| other.address() == joint.address());
    match (place, on) {
        (None, true) => listeners.push(joint),
        (Some(place), false) => drop(listeners.swap_remove(place)),
        _ => {}
    }
}

/// The world, or libode's words for a bad one.
fn known(world: WorldId) -> Outcome<&'static WorldRecord> {
    world.get().map_err(|_| Fault::user("bad world argument"))
}

pub fn step_on(world: WorldId, method: Method, stepsize: Real) -> Outcome<c_int> {
    crate::threading::run_step(known(world)?, method, stepsize)
}

/// One step by the exact solver.
#[unsafe(no_mangle)]
pub unsafe extern "C-unwind" fn dWorldStep(world: WorldId, stepsize: Real) -> c_int {
    fence("dWorldStep", || step_on(world, Method::Plain(Stepper::Direct), stepsize))
}

/// One step by the iterative solver.
#[unsafe(no_mangle)]
pub unsafe extern "C-unwind" fn dWorldQuickStep(world: WorldId, stepsize: Real) -> c_int {
    fence("dWorldQuickStep", || step_on(world, Method::Plain(Stepper::Quick), stepsize))
}

export! {
    fn dWorldSetStepIslandsProcessingMaxThreadCount(world: WorldId, count: c_uint) {
        world.get()?.settings.max_threads.set(count)
    }
    fn dWorldGetStepIslandsProcessingMaxThreadCount(world: WorldId) -> c_uint {
        world.get()?.settings.max_threads.get()
    }
    /// Of the newest ODE. A step runs whole in one thread, so these limits hold; what was set can be read.
    fn dWorldSetSteppingThreadingParameters(world: WorldId, limits: In<ThreadLimits>) {
        let (world, [limits]) = (world.get()?, limits.get()?);
        let [mut stepping, mut solving] = world.settings.island_threads.get();
        if limits.which & 1 != 0 {
            world.settings.max_threads.set(limits.islands);
        }
        if limits.which & 2 != 0 {
            stepping = limits.stepping;
        }
        if limits.which & 4 != 0 {
            solving = limits.solving.wrapping_sub(1);
        }
        world.settings.island_threads.set([stepping, solving])
    }
    fn dWorldGetSteppingThreadingParameters(world: WorldId, limits: Out<ThreadLimits>) {
        let (world, [mut given]) = (world.get()?, limits.get()?);
        let [stepping, solving] = world.settings.island_threads.get();
        if given.which & 1 != 0 {
            given.islands = world.settings.max_threads.get();
        }
        if given.which & 2 != 0 {
            given.stepping = stepping;
        }
        if given.which & 4 != 0 {
            given.solving = solving.wrapping_add(1);
        }
        limits.set([given])?
    }
    fn dWorldSetStepMemoryReservationPolicy(world: WorldId, policy: In<ReserveInfo>) -> c_int {
        let world = known(world)?;
        let policy = policy.optional().map(|[policy]| policy);
        if policy.is_some_and(|p| p.struct_size as usize != size_of::<ReserveInfo>() || p.reserve_factor < 1.0) {
            return Err(Fault::user("Bad policy info"));
        }
        world.settings.reserve.set(policy.unwrap_or_default());
        1
    }
    fn dWorldSetStepThreadingImplementation(
        world: WorldId, functions: In<FunctionsInfo>, implementation: ImplementationId,
    ) {
        let functions = functions.optional().map(|[functions]| functions);
        if functions.is_some_and(|f| (f.struct_size as usize) < size_of::<FunctionsInfo>()) {
            return Err(Fault::user("Bad threading functions info"));
        }
        known(world)?.settings.threading.set(functions.map(|functions| (functions, implementation)))
    }
}

export_calling! {
    fn dWorldCleanupWorkingMemory(world: WorldId) { known(world)?.settings.free_step_memory() }
    /// A world's working memory stays its own; with another's it takes over that one's manager and reserve.
    fn dWorldUseSharedWorkingMemory(world: WorldId, from: WorldId) -> c_int {
        let world = known(world)?;
        let from = if from.is_null() { None } else { Some(&from.get()?.settings) };
        world.settings.free_step_memory();
        world.settings.manager.set(from.and_then(|from| from.manager.get()));
        world.settings.reserve.set(from.map(|from| from.reserve.get()).unwrap_or_default());
        1
    }
    fn dWorldSetStepMemoryManager(world: WorldId, functions: In<MemoryFunctions>) -> c_int {
        let world = known(world)?;
        let functions = functions.optional().map(|[functions]| functions);
        if functions.is_some_and(|m| m.struct_size as usize != size_of::<MemoryFunctions>()
            || m.alloc_block.is_none() || m.free_block.is_none()) {
            return Err(Fault::user("Bad memory functions info"));
        }
        world.settings.free_step_memory();
        world.settings.manager.set(functions);
        1
    }
}
