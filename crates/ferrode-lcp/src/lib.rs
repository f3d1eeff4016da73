#![forbid(unsafe_code)]
//! Dense and iterative solvers for boxed linear complementarity problems: numbers only, no bodies.
//!
//! - [`problem`] states the problem: `w = A x - b`, each unknown within its bounds or its slack pushing it there.
//! - [`dantzig`] solves it exactly by pivoting; [`sor`] approximately by projected successive over-relaxation.
//! - [`pivoting`] solves it exactly, for mechanisms of any size, on the factorisation in [`sparse`].
//! - [`residual`] says how good an answer is.
//! - [`dense`], [`cholesky`], [`ldlt`] are the dense matrix functions that ODE programs know.
//!
//! Results are the same bits on every machine: sums have a fixed order, and products are never fused with sums.

mod block_rows;
pub mod cholesky;
pub mod condensed;
pub mod dantzig;
pub mod dense;
mod envelope;
mod error;
mod kernel;
pub mod ldlt;
pub mod pivoting;
pub mod problem;
pub mod residual;
pub mod sor;
pub mod sparse;

pub use condensed::{CondensedReport, CondensedWorkspace, solve_condensed};
pub use dantzig::{
    DantzigOptions, DantzigReport, DantzigStatus, DantzigWorkspace, solve_dantzig, solve_dantzig_with,
};
pub use error::LcpError;
pub use pivoting::{
    ABREAST, AbreastWorkspace, PivotingOptions, PivotingReport, PivotingWorkspace, RowState, SparseLcp,
    abreast, solve_abreast, solve_pivoting,
};
pub use problem::BoxedLcp;
pub use residual::natural_residual;
pub use sor::{
    DynamicIterations, InfTimesZero, LoneRow, NO_BODY, SorAcceleration, SorBody, SorExit, SorParams,
    SorReport, SorRow, SorWorkspace, begin_sor_alone, begin_sor_rows, finish_sor, solve_sor, solve_sor_rows,
};
pub use sparse::{NO_SPARSE_BODY, RowBlock, ScaledRow};
