//! Cooperative matrix functions. Each gives what the plain function of `matrix` gives; the resource objects tell which
//! sizes it was asked for, and are checked like any handle.

use crate::fault::{Fault, Outcome, export};
use crate::matrix::{by_pointer, unsigned};
use crate::real::{In, Real};
use crate::record::{Required, record};
use crate::slab::{Handle, Pool, Record, Tag};
use crate::threading::{FunctionsInfo, ImplementationId};
use core::cell::Cell;
use core::ffi::c_uint;

type CooperativeId = Handle<Cooperative>;
type RequirementsId = Handle<Requirements>;
type ResourcesId = Handle<Resources>;

/// Threads to work together.
#[derive(Default)]
pub struct Cooperative {
    tag: Tag,
}
record!(Cooperative, COOPERATIVES, 10);

/// What functions will need: threads and rows.
#[derive(Default)]
pub struct Requirements {
    tag: Tag,
    cooperative: Cell<CooperativeId>,
    threads: Cell<usize>,
    rows: Cell<usize>,
}
record!(Requirements, REQUIREMENTS, 11);

/// What was asked for, had.
#[derive(Default)]
pub struct Resources {
    tag: Tag,
    rows: Cell<usize>,
}
record!(Resources, RESOURCES, 12);

impl Requirements {
    fn merge(&self, threads: usize, rows: usize) {
        self.threads.set(self.threads.get().max(threads));
        self.rows.set(self.rows.get().max(rows));
    }
}

/// Destroying nothing is allowed.
fn destroy<T: Record>(handle: Handle<T>) -> Outcome<()> {
    if !handle.is_null() {
        T::pool().destroy(handle.get()?);
    }
    Ok(())
}

fn estimate(requirements: RequirementsId, threads: c_uint, rows: c_uint) -> Outcome<()> {
    requirements.get()?.merge(unsigned(threads), unsigned(rows));
    Ok(())
}

/// The number of rows, if the resources are good for so many.
fn rows(resources: ResourcesId, count: c_uint) -> Outcome<usize> {
    let count = unsigned(count);
    if count > resources.get()?.rows.get() { Err(Fault::ARGUMENT) } else { Ok(count) }
}

export! {
    fn dCooperativeCreate(_functions: In<FunctionsInfo>, _implementation: ImplementationId) -> CooperativeId {
        CooperativeId::of(Cooperative::pool().create())
    }
    fn dCooperativeDestroy(cooperative: CooperativeId) { destroy(cooperative)? }

    fn dResourceRequirementsCreate(cooperative: CooperativeId) -> RequirementsId {
        cooperative.get()?;
        let requirements = Requirements::pool().create();
        requirements.cooperative.set(cooperative);
        RequirementsId::of(requirements)
    }
    fn dResourceRequirementsDestroy(requirements: RequirementsId) { destroy(requirements)? }
    fn dResourceRequirementsClone(requirements: RequirementsId) -> RequirementsId {
        let original = requirements.get()?;
        let clone = Requirements::pool().create();
        clone.cooperative.set(original.cooperative.get());
        clone.merge(original.threads.get(), original.rows.get());
        RequirementsId::of(clone)
    }
    fn dResourceRequirementsMergeIn(summary: RequirementsId, extra: RequirementsId) {
        let extra = extra.get()?;
        summary.get()?.merge(extra.threads.get(), extra.rows.get())
    }
    fn dResourceContainerAcquire(requirements: RequirementsId) -> ResourcesId {
        let rows = requirements.get()?.rows.get();
        let resources = Resources::pool().create();
        resources.rows.set(rows);
        ResourcesId::of(resources)
    }
    fn dResourceContainerDestroy(resources: ResourcesId) { destroy(resources)? }

    fn dEstimateCooperativelyFactorLDLTResourceRequirements(
        requirements: RequirementsId, threads: c_uint, rows: c_uint,
    ) { estimate(requirements, threads, rows)? }
    fn dEstimateCooperativelySolveLDLTResourceRequirements(
        requirements: RequirementsId, threads: c_uint, rows: c_uint,
    ) { estimate(requirements, threads, rows)? }
    fn dEstimateCooperativelySolveL1StraightResourceRequirements(
        requirements: RequirementsId, threads: c_uint, rows: c_uint,
    ) { estimate(requirements, threads, rows)? }
    fn dEstimateCooperativelySolveL1TransposedResourceRequirements(
        requirements: RequirementsId, threads: c_uint, rows: c_uint,
    ) { estimate(requirements, threads, rows)? }
    fn dEstimateCooperativelyScaleVectorResourceRequirements(
        requirements: RequirementsId, threads: c_uint, elements: c_uint,
    ) { estimate(requirements, threads, elements)? }

    fn dCooperativelyFactorLDLT(
        resources: ResourcesId, _threads: c_uint, a: *mut Real, d: *mut Real, count: c_uint, skip: c_uint,
    ) { by_pointer::factor(a, d, rows(resources, count)?, unsigned(skip))? }
    fn dCooperativelySolveLDLT(
        resources: ResourcesId, _threads: c_uint, l: *const Real, d: *const Real, b: *mut Real,
        count: c_uint, skip: c_uint,
    ) { by_pointer::solve(l, d, b, rows(resources, count)?, unsigned(skip))? }
    fn dCooperativelySolveL1Straight(
        resources: ResourcesId, _threads: c_uint, l: *const Real, b: *mut Real, count: c_uint, skip: c_uint,
    ) { by_pointer::solve_l1(l, b, rows(resources, count)?, unsigned(skip))? }
    fn dCooperativelySolveL1Transposed(
        resources: ResourcesId, _threads: c_uint, l: *const Real, b: *mut Real, count: c_uint, skip: c_uint,
    ) { by_pointer::solve_l1t(l, b, rows(resources, count)?, unsigned(skip))? }
    fn dCooperativelyScaleVector(
        resources: ResourcesId, _threads: c_uint, data: *mut Real, scale: *const Real, count: c_uint,
    ) { by_pointer::scale(data, scale, rows(resources, count)?)? }
}
