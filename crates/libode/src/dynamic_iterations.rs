//! Sweeps of QuickStep by need: functions of the newest ODE, which libode 0.16.2 lacks. Off until a program asks, so that
//! nothing else changes.

use crate::fault::{Fault, Outcome, export, from_engine};
use crate::real::{In, Out, Real, f, r};
use crate::record::{Required, WorldId, WorldRecord};
use core::cell::Cell;
use core::ffi::{c_int, c_uint};
use core::sync::atomic::{AtomicU32, Ordering};
use ferrode_dynamics::{DynamicIterations, StepReport};

/// `dWorldQuickStepIterationCount_DynamicAdjustmentStatistics`: memory of the program's.
#[repr(C)]
pub struct Statistics {
    struct_size: c_uint,
    iteration_count: AtomicU32,
    premature_exits: AtomicU32,
    prolonged_execs: AtomicU32,
    full_extra_execs: AtomicU32,
}

/// What a program has set.
#[derive(Default)]
pub struct Settings {
    /// The change that ends the iteration, the factor of added sweeps, the change that ends these.
    numbers: Cell<Numbers>,
    sink: Cell<*const Statistics>,
}

#[derive(Clone, Copy)]
struct Numbers([f64; 3]);

impl Default for Numbers {
    /// Neither fewer nor more sweeps; the last number is ODE's, a float.
    fn default() -> Self {
        Self([0.0, 0.0, f64::from(1e-2_f32)])
    }
}

/// Tells the engine; also after the number of sweeps has changed, of which the added ones are a fraction.
pub fn apply(world: &WorldRecord) -> Outcome<()> {
    let Numbers([premature, factor, requirement]) = world.settings.dynamic.numbers.get();
    world
        .engine(|engine| {
            let mut settings = *engine.quick();
            let extra_iterations = (f64::from(settings.iterations) * factor) as u32;
            let dynamic = DynamicIterations {
                premature_exit_delta: premature,
                extra_iterations,
                extra_requirement_delta: requirement,
            };
            settings.dynamic = (extra_iterations != 0 || premature != 0.0).then_some(dynamic);
            engine.set_quick(settings)
        })
        .or_else(|error| from_engine(&error))
}

/// Counts an iterative step where the program wants it counted. As in ODE `iteration_count` counts islands.
pub fn count(world: &WorldRecord, report: &StepReport) {
    let sink = world.settings.dynamic.sink.get();
    if sink.is_null() {
        return;
    }
    // SAFETY: the program keeps the record until it attaches another or none (the contract of the function that attached
    // it), and reads it as it would any number that other threads may change.
    let sink = unsafe { &*sink };
    let add = |to: &AtomicU32, n: usize| to.fetch_add(n as u32, Ordering::Relaxed);
    add(&sink.iteration_count, report.islands);
    add(&sink.premature_exits, report.premature_exits);
    add(&sink.prolonged_execs, report.prolonged_solves);
    add(&sink.full_extra_execs, report.full_extra_solves);
}

export! {
    /// A null pointer leaves a number as it is.
    fn dWorldSetQuickStepDynamicIterationParameters(
        world: WorldId, premature_exit_delta: In<Real>, max_extra_factor: In<Real>, extra_requirement_delta: In<Real>,
    ) {
        let world = world.get()?;
        let Numbers(mut numbers) = world.settings.dynamic.numbers.get();
        let given = [premature_exit_delta, max_extra_factor, extra_requirement_delta].map(In::optional);
        if given.iter().all(Option::is_none) {
            return Err(Fault::ARGUMENT);
        }
        for (number, given) in numbers.iter_mut().zip(given) {
            if let Some([given]) = given {
                *number = f(given);
            }
        }
        if !numbers.iter().all(|number| *number >= 0.0) {
            return Err(Fault::ARGUMENT);
        }
        world.settings.dynamic.numbers.set(Numbers(numbers));
        apply(world)?
    }
    fn dWorldGetQuickStepDynamicIterationParameters(
        world: WorldId, premature_exit_delta: Out<Real>, max_extra_factor: Out<Real>, extra_requirement_delta: Out<Real>,
    ) {
        let Numbers([premature, factor, requirement]) = world.get()?.settings.dynamic.numbers.get();
        premature_exit_delta.set_if_wanted([r(premature)]);
        max_extra_factor.set_if_wanted([r(factor)]);
        extra_requirement_delta.set_if_wanted([r(requirement)])
    }
    /// 1 if the record is good: its size is known. Null takes it away again.
    fn dWorldAttachQuickStepDynamicIterationStatisticsSink(world: WorldId, sink: In<c_uint>, ) -> c_int {
        let world = world.get()?;
        if let Some([size]) = sink.optional()
            && ((size as usize) < size_of::<Statistics>() || !size.is_multiple_of(4))
        {
            return Ok(0);
        }
        world.settings.dynamic.sink.set(sink.address().cast());
        1
    }
}
