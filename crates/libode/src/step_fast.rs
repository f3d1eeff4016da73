//! The StepFast functions of old manuals (ODE 0.4 to 0.11). libode 0.16.2 lacks them.

use crate::fault::{Outcome, export, fence};
use crate::real::Real;
use crate::record::{Required, WorldId};
use crate::stepping::{Method, step_on};
use core::ffi::{c_int, c_uint};
use core::sync::atomic::{AtomicU32, Ordering};

/// Layers of sleeping bodies that an awake one wakes; one number for all worlds, as it was in ODE.
static DEPTH: AtomicU32 = AtomicU32::new(2);

/// One step in substeps, joint by joint. Fewer substeps than one are one.
#[unsafe(no_mangle)]
pub unsafe extern "C-unwind" fn dWorldStepFast1(world: WorldId, stepsize: Real, max_iterations: c_int) {
    fence("dWorldStepFast1", || -> Outcome<()> {
        let iterations = c_uint::try_from(max_iterations).unwrap_or(1).max(1);
        let depth = DEPTH.load(Ordering::Relaxed);
        step_on(world, Method::Fast { iterations, depth }, stepsize).map(|_| ())
    });
}

export! {
    fn dWorldSetAutoEnableDepthSF1(world: WorldId, depth: c_int) {
        world.get()?;
        DEPTH.store(c_uint::try_from(depth).unwrap_or(0), Ordering::Relaxed)
    }
    fn dWorldGetAutoEnableDepthSF1(world: WorldId) -> c_int {
        world.get()?;
        DEPTH.load(Ordering::Relaxed).try_into().unwrap_or(c_int::MAX)
    }
}
