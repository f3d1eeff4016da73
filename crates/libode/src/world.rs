//! Worlds: creation, parameters, and what new bodies inherit.

use crate::fault::{Outcome, export, export_calling, from_engine, message};
use crate::geom::leave_dying_body;
use crate::real::{OutVector, Real, f, r, vec3, vector3};
use crate::record::{BodyId, BodyRecord, JointId, Required, WorldId, WorldRecord, handle_of};
use crate::slab::{Link, Record};
use core::ffi::{c_int, c_uint, c_void};
use ferrode_dynamics::{AutoDisable, Damping, Error, QuickSettings, World};

/// What ODE's getter returns for a world whose new bodies disable themselves.
const AUTO_DISABLE_FLAG: c_int = 16;

/// Work on the engine's world that can be refused.
fn with(world: WorldId, work: impl FnOnce(&mut World) -> Result<(), Error>) -> Outcome<()> {
    world.get()?.engine(work).or_else(|error| from_engine(&error))
}

fn read<T>(world: WorldId, work: impl FnOnce(&World) -> T) -> Outcome<T> {
    Ok(world.get()?.engine(|engine| work(engine)))
}

fn auto_disable(world: WorldId, change: impl FnOnce(&mut AutoDisable)) -> Outcome<()> {
    with(world, |engine| {
        let mut settings = *engine.auto_disable();
        change(&mut settings);
        engine.set_auto_disable(settings)
    })
}

fn damping(world: WorldId, change: impl FnOnce(&mut Damping)) -> Outcome<()> {
    with(world, |engine| {
        let mut settings = *engine.damping();
        change(&mut settings);
        engine.set_damping(settings)
    })
}

fn quick(world: WorldId, change: impl FnOnce(&mut QuickSettings)) -> Outcome<()> {
    with(world, |engine| {
        let mut settings = *engine.quick();
        change(&mut settings);
        engine.set_quick(settings)
    })
}

/// A threshold as ODE keeps it: squared, so that its sign is lost.
pub fn threshold(x: Real) -> f64 {
    (f(x) * f(x)).sqrt()
}

/// Destroys a world and all in it; joints of groups stay with their groups, as empty shells. Returns their number.
fn destroy(world: &'static WorldRecord) -> usize {
    let (bodies, joints) = world.engine(|engine| {
        let bodies: Vec<BodyId> = engine.bodies().map(|(_, body)| handle_of(body.user_data())).collect();
        let joints: Vec<JointId> =
            engine.joints().filter_map(|key| engine.joint_user_data(key).ok()).map(handle_of).collect();
        (bodies, joints)
    });
    for body in bodies.into_iter().filter_map(BodyId::live) {
        leave_dying_body(body);
        BodyRecord::pool().destroy(body);
    }
    let mut orphans = 0;
    for joint in joints.into_iter().filter_map(JointId::live) {
        if joint.grouped.get() {
            joint.world.set(Link::NULL);
            joint.key.set(None);
            orphans += 1;
        } else {
            Record::pool().destroy(joint);
        }
    }
    *world.listeners.borrow_mut() = Vec::new();
    let room = world.destroy_engine();
    // Last, since the program's functions may not come back.
    world.settings.free_step_memory();
    WorldRecord::pool().destroy(world);
    if let Some((room, lender)) = room {
        // SAFETY: the lender's, and empty now.
        unsafe { lender.take_back(room) };
    }
    orphans
}

export_calling! {
    fn dWorldCreate() -> WorldId { WorldId::of(WorldRecord::create()) }
}

export! {
    fn dWorldSetData(world: WorldId, data: *mut c_void) { world.get()?.data.set(data) }
    fn dWorldGetData(world: WorldId) -> *mut c_void { world.get()?.data.get().cast_mut() }

    fn dWorldSetGravity(world: WorldId, x: Real, y: Real, z: Real) {
        with(world, |engine| engine.set_gravity(vec3(x, y, z)))?
    }
    fn dWorldGetGravity(world: WorldId, gravity: OutVector) {
        gravity.set(vector3(read(world, World::gravity)?))?
    }
    fn dWorldSetERP(world: WorldId, erp: Real) { with(world, |engine| engine.set_erp(f(erp)))? }
    fn dWorldGetERP(world: WorldId) -> Real { r(read(world, World::erp)?) }
    fn dWorldSetCFM(world: WorldId, cfm: Real) { with(world, |engine| engine.set_cfm(f(cfm)))? }
    fn dWorldGetCFM(world: WorldId) -> Real { r(read(world, World::cfm)?) }

    fn dWorldSetAutoDisableFlag(world: WorldId, on: c_int) { auto_disable(world, |a| a.enabled = on != 0)? }
    fn dWorldGetAutoDisableFlag(world: WorldId) -> c_int {
        if read(world, |w| w.auto_disable().enabled)? { AUTO_DISABLE_FLAG } else { 0 }
    }
    fn dWorldSetAutoDisableLinearThreshold(world: WorldId, x: Real) {
        auto_disable(world, |a| a.linear_threshold = threshold(x))?
    }
    fn dWorldGetAutoDisableLinearThreshold(world: WorldId) -> Real {
        r(read(world, |w| w.auto_disable().linear_threshold)?)
    }
    fn dWorldSetAutoDisableAngularThreshold(world: WorldId, x: Real) {
        auto_disable(world, |a| a.angular_threshold = threshold(x))?
    }
    fn dWorldGetAutoDisableAngularThreshold(world: WorldId) -> Real {
        r(read(world, |w| w.auto_disable().angular_threshold)?)
    }
    fn dWorldSetAutoDisableSteps(world: WorldId, steps: c_int) { auto_disable(world, |a| a.steps = steps)? }
    fn dWorldGetAutoDisableSteps(world: WorldId) -> c_int { read(world, |w| w.auto_disable().steps)? }
    fn dWorldSetAutoDisableTime(world: WorldId, time: Real) { auto_disable(world, |a| a.time = f(time))? }
    fn dWorldGetAutoDisableTime(world: WorldId) -> Real { r(read(world, |w| w.auto_disable().time)?) }
    fn dWorldSetAutoDisableAverageSamplesCount(world: WorldId, count: c_uint) {
        auto_disable(world, |a| a.average_samples = count)?
    }
    fn dWorldGetAutoDisableAverageSamplesCount(world: WorldId) -> c_int {
        read(world, |w| w.auto_disable().average_samples)? as c_int
    }

    fn dWorldSetLinearDamping(world: WorldId, scale: Real) { damping(world, |d| d.linear_scale = f(scale))? }
    fn dWorldGetLinearDamping(world: WorldId) -> Real { r(read(world, |w| w.damping().linear_scale)?) }
    fn dWorldSetAngularDamping(world: WorldId, scale: Real) { damping(world, |d| d.angular_scale = f(scale))? }
    fn dWorldGetAngularDamping(world: WorldId) -> Real { r(read(world, |w| w.damping().angular_scale)?) }
    fn dWorldSetDamping(world: WorldId, linear: Real, angular: Real) {
        damping(world, |d| (d.linear_scale, d.angular_scale) = (f(linear), f(angular)))?
    }
    fn dWorldSetLinearDampingThreshold(world: WorldId, x: Real) {
        damping(world, |d| d.linear_threshold = threshold(x))?
    }
    fn dWorldGetLinearDampingThreshold(world: WorldId) -> Real {
        r(read(world, |w| w.damping().linear_threshold)?)
    }
    fn dWorldSetAngularDampingThreshold(world: WorldId, x: Real) {
        damping(world, |d| d.angular_threshold = threshold(x))?
    }
    fn dWorldGetAngularDampingThreshold(world: WorldId) -> Real {
        r(read(world, |w| w.damping().angular_threshold)?)
    }
    fn dWorldSetMaxAngularSpeed(world: WorldId, speed: Real) {
        with(world, |engine| engine.set_max_angular_speed(f(speed)))?
    }
    fn dWorldGetMaxAngularSpeed(world: WorldId) -> Real { r(read(world, World::max_angular_speed)?) }

    fn dWorldSetContactMaxCorrectingVel(world: WorldId, velocity: Real) {
        with(world, |engine| engine.set_contact_max_correcting_velocity(f(velocity)))?
    }
    fn dWorldGetContactMaxCorrectingVel(world: WorldId) -> Real {
        r(read(world, World::contact_max_correcting_velocity)?)
    }
    fn dWorldSetContactSurfaceLayer(world: WorldId, depth: Real) {
        with(world, |engine| engine.set_contact_surface_layer(f(depth)))?
    }
    fn dWorldGetContactSurfaceLayer(world: WorldId) -> Real { r(read(world, World::contact_surface_layer)?) }

    /// ODE would take a negative number for some thousand million sweeps; here it stands for none.
    fn dWorldSetQuickStepNumIterations(world: WorldId, count: c_int) {
        world.get()?.settings.quick_iterations.set(Some(count));
        quick(world, |q| q.iterations = count.max(0).cast_unsigned())?;
        crate::dynamic_iterations::apply(world.get()?)?
    }
    fn dWorldGetQuickStepNumIterations(world: WorldId) -> c_int {
        let asked = world.get()?.settings.quick_iterations.get();
        asked.unwrap_or(read(world, |w| w.quick().iterations)? as c_int)
    }
    fn dWorldSetQuickStepW(world: WorldId, w: Real) { quick(world, |q| q.over_relaxation = f(w))? }
    fn dWorldGetQuickStepW(world: WorldId) -> Real { r(read(world, |w| w.quick().over_relaxation)?) }

    fn dWorldImpulseToForce(world: WorldId, stepsize: Real, x: Real, y: Real, z: Real, force: OutVector) {
        world.get()?;
        let h = f(stepsize);
        force.set(vector3(vec3(x, y, z) * (1.0 / h)))?
    }
}

/// Destroys a world; for every joint that a group keeps there is a message, as in ODE.
#[unsafe(no_mangle)]
pub unsafe extern "C-unwind" fn dWorldDestroy(world: WorldId) {
    let orphans = crate::fault::fence("dWorldDestroy", || Ok(destroy(world.get()?)));
    for _ in 0..orphans {
        message(0, "warning: destroying world containing grouped joints", "");
    }
}
