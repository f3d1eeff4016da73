//! The null joint: connects bodies, so that they share an island, and constrains nothing.

use super::JointModel;
use crate::ends::{Ends, StepContext};
use crate::rows::{JointRows, RowCount};

/// The null joint's data: none.
#[derive(Clone, Debug)]
pub struct Null {}

impl Null {
    pub(crate) fn new(_erp: f64, _cfm: f64) -> Self {
        Self {}
    }
}

impl JointModel for Null {
    fn row_count(&mut self, _ends: &Ends<'_>, _ctx: &StepContext) -> RowCount {
        RowCount::default()
    }

    fn write_rows(&mut self, _ends: &Ends<'_>, _ctx: &StepContext, _out: &mut JointRows<'_>) {}
}
