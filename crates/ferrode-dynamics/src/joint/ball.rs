//! Ball and socket: holds a point of one body to a point of the other.

use super::anchor::Anchors;
use super::{JointError, JointModel, JointMut, JointRef};
use crate::Error;
use crate::carried::{Carried, is_spring};
use crate::ends::{Ends, StepContext};
use crate::error::finite;
use crate::rows::{JointRows, RowCount};
use ferrode_math::Vec3;

/// The ball joint's data: the anchor, and its own ERP and CFM.
#[derive(Clone, Debug)]
pub struct Ball {
    anchors: Anchors,
    erp: f64,
    cfm: f64,
}

impl Ball {
    pub(crate) fn new(erp: f64, cfm: f64) -> Self {
        Self { anchors: Anchors::default(), erp, cfm }
    }
}

impl JointModel for Ball {
    fn details(&self) -> Vec<(&'static str, Vec<f64>)> {
        vec![
            ("anchor1", self.anchors.first.to_array().to_vec()),
            ("anchor2", self.anchors.second.to_array().to_vec()),
        ]
    }

    fn row_count(&mut self, _ends: &Ends<'_>, _ctx: &StepContext) -> RowCount {
        RowCount::new(3, 3)
    }

    fn write_rows(&mut self, ends: &Ends<'_>, ctx: &StepContext, out: &mut JointRows<'_>) {
        self.anchors.write_rows(ends, ctx, self.erp, out.rows);
        for row in out.rows.iter_mut() {
            row.cfm = self.cfm;
        }
    }

    fn carried(&mut self, ends: &Ends<'_>, ctx: &StepContext) -> Option<Carried> {
        (!is_spring(self.cfm, ctx)).then(|| self.anchors.carried(ends, self.cfm))
    }

    fn attached(&mut self, ends: &Ends<'_>) {
        // ODE reads the anchor as its getter reports it, and sets it again.
        let p = self.anchors.in_callers_order(ends)[0];
        self.anchors = Anchors::at(ends, p);
    }

    fn set_param(&mut self, n: i32, value: f64) {
        super::param::set_own_softness(n, value, &mut self.erp, &mut self.cfm);
    }

    fn param(&self, n: i32) -> f64 {
        super::param::own_softness(n, self.erp, self.cfm)
    }

    fn error(&self, ends: &Ends<'_>) -> JointError {
        JointError { position: (self.anchors.world1(ends) - self.anchors.world2(ends)).length(), angle: 0.0 }
    }
}

impl JointRef<'_, Ball> {
    /// The anchor as the first body sees it, in world coordinates.
    pub fn anchor(&self) -> Vec3 {
        self.data.anchors.in_callers_order(&self.ends())[0]
    }

    /// The anchor as the second body sees it, in world coordinates. Its distance from [`Self::anchor`] is the
    /// joint's error.
    pub fn anchor2(&self) -> Vec3 {
        self.data.anchors.in_callers_order(&self.ends())[1]
    }
}

impl JointMut<'_, Ball> {
    /// Sets the anchor, in world coordinates. Does nothing in limbo, as ODE.
    ///
    /// # Errors
    /// [`Error::NotFinite`].
    pub fn set_anchor(&mut self, anchor: Vec3) -> Result<(), Error> {
        finite("ball anchor", anchor)?;
        let (ball, ends) = self.parts();
        if ends.first.is_some() {
            ball.anchors = Anchors::at(&ends, anchor);
        }
        Ok(())
    }

    /// Sets the second side's point directly: in the second body's **own** coordinates, or world coordinates without
    /// a second body. The joint then closes the gap.
    ///
    /// # Errors
    /// [`Error::NotFinite`].
    pub fn set_anchor2(&mut self, anchor: Vec3) -> Result<(), Error> {
        finite("ball anchor 2", anchor)?;
        self.parts().0.anchors.second = anchor;
        Ok(())
    }
}
