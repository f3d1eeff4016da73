//! The hinge joint.

use super::JointModel;
use crate::ends::{Ends, StepContext};
use crate::rows::{JointRows, RowCount};

/// The hinge joint's data.
#[derive(Clone, Debug)]
pub struct Hinge {}

impl Hinge {
    pub(crate) fn new(_erp: f64, _cfm: f64) -> Self {
        Self {}
    }
}

impl JointModel for Hinge {
    fn row_count(&mut self, _ends: &Ends<'_>, _ctx: &StepContext) -> RowCount {
        RowCount::default()
    }

    fn write_rows(&mut self, _ends: &Ends<'_>, _ctx: &StepContext, _out: &mut JointRows<'_>) {}
}
