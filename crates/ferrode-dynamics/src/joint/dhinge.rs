//! Double hinge: two parallel hinge axes, one on each body, at a constant distance, like a bicycle chain's link.

use super::axis::write_alignment_rows;
use super::dball::{Rod, distance};
use super::limit_motor::midpoint_torque;
use super::{JointError, JointModel, JointMut, JointRef};
use crate::Error;
use crate::ends::{Ends, StepContext};
use crate::error::{finite, unit};
use crate::rows::{JointRows, RowCount};
use ferrode_math::Vec3;

/// The double hinge's data: two anchors and their distance, one axis in both bodies, and its own ERP and CFM.
#[derive(Clone, Debug)]
pub struct DHinge {
    rod: Rod,
    /// The axis in the first and second body's coordinates; none until it is set.
    axes: Option<[Vec3; 2]>,
    erp: f64,
    cfm: f64,
}

impl DHinge {
    pub(crate) fn new(erp: f64, cfm: f64) -> Self {
        Self { rod: Rod::default(), axes: None, erp, cfm }
    }
}

impl JointModel for DHinge {
    /// Without an axis only the distance is kept: ODE has rows of NaN then.
    fn row_count(&mut self, _ends: &Ends<'_>, _ctx: &StepContext) -> RowCount {
        if self.axes.is_some() { RowCount::new(4, 4) } else { RowCount::new(1, 1) }
    }

    fn write_rows(&mut self, ends: &Ends<'_>, ctx: &StepContext, out: &mut JointRows<'_>) {
        if let [row, ..] = out.rows {
            self.rod.write_row(ends, ctx, self.erp, self.cfm, row);
        }
        // The other rows have the joint's own ERP, but the world's CFM.
        let ([_, align @ .., axial], Some(axes)) = (&mut *out.rows, self.axes) else { return };
        let k = ctx.fps * self.erp;
        let a = ends.a().rotation * axes[0];
        write_alignment_rows(a, ends.b().rotation * axes[1], k, ends.two(), align, 1);
        axial.linear1 = a;
        if ends.two() {
            let arm = midpoint_torque(ends, a);
            axial.set_jacobian(a, arm, -a, arm);
        }
        axial.correct(k, -a.dot(self.rod.span(ends)));
        axial.slot = 3;
    }

    fn attached(&mut self, ends: &Ends<'_>) {
        self.rod.measure(ends);
    }

    fn set_param(&mut self, n: i32, value: f64) {
        super::param::set_own_softness(n, value, &mut self.erp, &mut self.cfm);
    }

    fn param(&self, n: i32) -> f64 {
        super::param::own_softness(n, self.erp, self.cfm)
    }

    fn error(&self, ends: &Ends<'_>) -> JointError {
        let stretch = self.rod.stretch(ends).abs();
        let Some(axes) = self.axes else { return JointError { position: stretch, angle: 0.0 } };
        let a = ends.a().rotation * axes[0];
        let b = ends.b().rotation * axes[1];
        JointError {
            position: stretch.max(a.dot(self.rod.span(ends)).abs()),
            angle: super::axis::angle_between(a, b),
        }
    }
}

impl JointRef<'_, DHinge> {
    /// The axis as the first body sees it, in world coordinates; zero until it is set.
    pub fn axis(&self) -> Vec3 {
        self.data.axes.map_or(Vec3::ZERO, |axes| self.ends().a().rotation * axes[0])
    }

    /// The first body's anchor, in world coordinates.
    pub fn anchor1(&self) -> Vec3 {
        self.data.rod.anchors.in_callers_order(&self.ends())[0]
    }

    /// The second body's anchor, in world coordinates.
    pub fn anchor2(&self) -> Vec3 {
        self.data.rod.anchors.in_callers_order(&self.ends())[1]
    }

    /// The distance that the joint keeps, in metres.
    pub fn distance(&self) -> f64 {
        self.data.rod.length
    }
}

impl JointMut<'_, DHinge> {
    /// Sets the axis of both bodies from one world vector of any length.
    ///
    /// # Errors
    /// [`Error::NotFinite`], [`Error::ZeroVector`]; [`Error::NotAttached`] in limbo.
    pub fn set_axis(&mut self, axis: Vec3) -> Result<(), Error> {
        let what = "double hinge axis";
        let axis = unit(what, axis)?;
        let (hinge, ends) = self.attached_parts(what)?;
        hinge.axes = Some([ends.a().rotation.transpose_mul(axis), ends.b().rotation.transpose_mul(axis)]);
        Ok(())
    }

    /// Sets the first body's anchor, in world coordinates, and takes the present distance of the anchors as the one to
    /// keep. Without that body the point stays fixed in the world.
    ///
    /// # Errors
    /// [`Error::NotFinite`].
    pub fn set_anchor1(&mut self, anchor: Vec3) -> Result<(), Error> {
        finite("double hinge anchor 1", anchor)?;
        let (hinge, ends) = self.parts();
        hinge.rod.set_anchor(&ends, 0, anchor);
        Ok(())
    }

    /// As [`Self::set_anchor1`], for the second body.
    ///
    /// # Errors
    /// [`Error::NotFinite`].
    pub fn set_anchor2(&mut self, anchor: Vec3) -> Result<(), Error> {
        finite("double hinge anchor 2", anchor)?;
        let (hinge, ends) = self.parts();
        hinge.rod.set_anchor(&ends, 1, anchor);
        Ok(())
    }

    /// Sets the distance to keep, in metres; ODE offers this through the double ball's function only. Call it last:
    /// attaching and setting anchors measure it anew.
    ///
    /// # Errors
    /// [`Error::OutOfRange`] unless it is finite and not negative.
    pub fn set_distance(&mut self, length: f64) -> Result<(), Error> {
        self.parts().0.rod.length = distance(length)?;
        Ok(())
    }
}
