//! The fixed joint: glue.

use super::{JointError, JointModel, JointMut, orientation};
use crate::ends::{Ends, StepContext};
use crate::rows::{JointRows, RowCount};
use ferrode_math::{Quat, Vec3};

/// The fixed joint's data: the relative pose that it keeps, and its own ERP and CFM.
///
/// These two act on the position alone; the rotation is kept with the world's, as in ODE.
#[derive(Clone, Debug)]
pub struct Fixed {
    /// From the second body's centre to the first's, in the first body's coordinates; without a second body the first's
    /// place in the world.
    offset: Vec3,
    /// conj(q₁) q₂; zero, which corrects no rotation, until it is recorded.
    initial: Quat,
    erp: f64,
    cfm: f64,
}

impl Fixed {
    pub(crate) fn new(erp: f64, cfm: f64) -> Self {
        Self { offset: Vec3::ZERO, initial: Quat::new(0.0, 0.0, 0.0, 0.0), erp, cfm }
    }

    /// From the second body's centre to the first's as wanted, in the world; zero with one body.
    fn arm(&self, ends: &Ends<'_>) -> Vec3 {
        if ends.two() { ends.a().rotation * self.offset } else { Vec3::ZERO }
    }

    /// From the first body's centre to where it should be.
    fn way_back(&self, ends: &Ends<'_>) -> Vec3 {
        match ends.second {
            Some(b) => b.position - ends.a().position + self.arm(ends),
            None => self.offset - ends.a().position,
        }
    }
}

impl JointModel for Fixed {
    fn details(&self) -> Vec<(&'static str, Vec<f64>)> {
        vec![
            ("qrel", crate::foreign::numbers(self.initial)[..3].to_vec()),
            ("offset", self.offset.to_array().to_vec()),
        ]
    }

    fn row_count(&mut self, _ends: &Ends<'_>, _ctx: &StepContext) -> RowCount {
        RowCount::new(6, 6)
    }

    fn write_rows(&mut self, ends: &Ends<'_>, ctx: &StepContext, out: &mut JointRows<'_>) {
        let arm = self.arm(ends);
        let error = self.way_back(ends);
        let k = ctx.fps * self.erp;
        for ((row, u), slot) in out.rows[..3].iter_mut().zip([Vec3::X, Vec3::Y, Vec3::Z]).zip(0..) {
            row.linear1 = u;
            if ends.two() {
                row.set_jacobian(u, u.cross(arm), -u, Vec3::ZERO);
            }
            row.correct(k, u.dot(error));
            row.cfm = self.cfm;
            row.slot = slot;
        }
        orientation::write_rows(ends, ctx, self.initial, &mut out.rows[3..6], 3);
    }

    fn set_param(&mut self, n: i32, value: f64) {
        super::param::set_own_softness(n, value, &mut self.erp, &mut self.cfm);
    }

    fn param(&self, n: i32) -> f64 {
        super::param::own_softness(n, self.erp, self.cfm)
    }

    fn error(&self, ends: &Ends<'_>) -> JointError {
        JointError { position: self.way_back(ends).length(), angle: orientation::angle(ends, self.initial) }
    }
}

impl JointMut<'_, Fixed> {
    /// Records the present relative pose as the one to keep (`dJointSetFixed`). Call it once the joint is attached:
    /// attaching alone records nothing, and the joint would pull the centres together. Does nothing in limbo.
    pub fn set_fixed(&mut self) {
        let (fixed, ends) = self.parts();
        let Some(a) = ends.first else { return };
        fixed.offset = match ends.second {
            Some(b) => a.rotation.transpose_mul(a.position - b.position),
            None => a.position,
        };
        fixed.initial = ends.relative_rotation();
    }
}
