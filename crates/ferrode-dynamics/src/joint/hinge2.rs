//! The hinge-2: two hinges in series, for a car's wheel. Axis 1 (steering, suspension) is fixed in the first body, the
//! chassis; axis 2 (the axle) in the second, the wheel. The joint keeps the angle between them as it was set.

use super::anchor::Anchors;
use super::axis::angle_between;
use super::limit_motor::{LimitMotor, RowAxis, limit_motors};
use super::{JointError, JointModel, JointMut, JointRef, LimitedAxis, Param};
use crate::ends::{Ends, StepContext};
use crate::error::{finite, finite_number, unit};
use crate::rows::{JointRows, RowCount};
use crate::{Error, Softness};
use ferrode_math::{Vec3, plane_space, real};

/// The hinge-2's data: anchor, axes, reference directions of the angles, stops and motors, and the suspension.
#[derive(Clone, Debug)]
pub struct Hinge2 {
    anchors: Anchors,
    /// Axis 1 in the first body's coordinates, axis 2 in the second's.
    axes: [Vec3; 2],
    /// Wanted cosine and sine of the angle between the axes.
    cosine: f64,
    sine: f64,
    /// Directions across axis 1, in the first body's coordinates: where axis 2 is at angle 1 = 0, and a quarter turn on.
    reference1: [Vec3; 2],
    /// Directions across axis 2, in the second body's coordinates: where axis 1 is at angle 2 = 0, and a quarter turn on.
    reference2: [Vec3; 2],
    limit_motor1: LimitMotor,
    limit_motor2: LimitMotor,
    suspension: Softness,
}

limit_motors!(Hinge2 { 1 => limit_motor1, 2 => limit_motor2 });

impl Hinge2 {
    pub(crate) fn new(erp: f64, cfm: f64) -> Self {
        Self {
            anchors: Anchors::default(),
            axes: [Vec3::X, Vec3::Y],
            cosine: 0.0,
            sine: 0.0,
            reference1: [Vec3::X, Vec3::Y],
            reference2: [Vec3::X, Vec3::Y],
            limit_motor1: LimitMotor::new(erp, cfm),
            limit_motor2: LimitMotor::new(erp, cfm),
            suspension: Softness { erp, cfm },
        }
    }

    /// Both axes in the world.
    fn world_axes(&self, ends: &Ends<'_>) -> (Vec3, Vec3) {
        (ends.a().rotation * self.axes[0], ends.b().rotation * self.axes[1])
    }

    fn angle1(&self, ends: &Ends<'_>) -> f64 {
        let (_, b) = self.world_axes(ends);
        let s = ends.a().rotation.transpose_mul(b);
        -real::atan2(self.reference1[1].dot(s), self.reference1[0].dot(s))
    }

    fn angle2(&self, ends: &Ends<'_>) -> f64 {
        let (a, _) = self.world_axes(ends);
        let s = ends.b().rotation.transpose_mul(a);
        -real::atan2(self.reference2[1].dot(s), self.reference2[0].dot(s))
    }

    /// Takes the present angle between the axes as the wanted one.
    fn record_angle_between(&mut self, ends: &Ends<'_>) {
        let (a, b) = self.world_axes(ends);
        (self.cosine, self.sine) = (a.dot(b), a.cross(b).length());
    }

    /// Makes the present angles 0. Parallel axes, which have no angles, leave the references as they were.
    fn record_references(&mut self, ends: &Ends<'_>) {
        let (a, b) = self.world_axes(ends);
        let d = a.dot(b);
        if let (Some(bp), Some(ap)) = ((b - a * d).normalized(), (a - b * d).normalized()) {
            self.reference1 = [bp, a.cross(bp)].map(|v| ends.a().rotation.transpose_mul(v));
            self.reference2 = [ap, b.cross(ap)].map(|v| ends.b().rotation.transpose_mul(v));
        }
    }
}

impl JointModel for Hinge2 {
    fn details(&self) -> Vec<(&'static str, Vec<f64>)> {
        vec![
            ("anchor1", self.anchors.first.to_array().to_vec()),
            ("anchor2", self.anchors.second.to_array().to_vec()),
            ("axis1", self.axes[0].to_array().to_vec()),
            ("axis2", self.axes[1].to_array().to_vec()),
            ("v1", self.reference1[0].to_array().to_vec()),
            ("v2", self.reference1[1].to_array().to_vec()),
            ("susp_erp", vec![self.suspension.erp]),
            ("susp_cfm", vec![self.suspension.cfm]),
        ]
    }

    fn row_count(&mut self, ends: &Ends<'_>, _ctx: &StepContext) -> RowCount {
        let angle = self.limit_motor1.has_angular_stops().then(|| self.angle1(ends));
        self.limit_motor1.test(angle);
        // Axis 2 has a motor, but no stops, as in ODE.
        self.limit_motor2.test(None);
        RowCount::new(4 + self.limit_motor1.row_count() + self.limit_motor2.row_count(), 4)
    }

    fn write_rows(&mut self, ends: &Ends<'_>, ctx: &StepContext, out: &mut JointRows<'_>) {
        let (a, b) = self.world_axes(ends);
        let (p, q) = plane_space(a);
        let k = ctx.k();
        let factors = [ctx.fps * self.suspension.erp, k, k];
        self.anchors.write_rows_along([a, p, q], factors, ends, &mut out.rows[..3]);
        out.rows[0].cfm = self.suspension.cfm;

        // Parallel axes have no common normal: turn about any vector across axis 1 then (ODE divides by zero).
        let cross = a.cross(b);
        let n = cross.normalized().unwrap_or(p);
        let row = &mut out.rows[3];
        row.set_angular(n, ends.two());
        row.correct(k, self.cosine * cross.length() - self.sine * a.dot(b));
        row.slot = 3;

        let mut at = 4;
        self.limit_motor1.write_row(ends, ctx, RowAxis::Angular(a), 4, out, &mut at);
        self.limit_motor2.write_row(ends, ctx, RowAxis::Angular(b), 5, out, &mut at);
    }

    fn attached(&mut self, ends: &Ends<'_>) {
        self.anchors = Anchors::at(ends, self.anchors.world1(ends));
        self.record_angle_between(ends);
        self.record_references(ends);
    }

    fn limited_axes(&self, ends: &Ends<'_>) -> Vec<LimitedAxis> {
        // Axis 2 has no stops.
        let hand = ends.a().rotation * self.reference1[0];
        let (axis, _) = self.world_axes(ends);
        vec![LimitedAxis::turning(1, axis, hand, self.angle1(ends), &self.limit_motor1)]
    }

    fn set_param(&mut self, n: i32, value: f64) {
        match Param::from_number(n) {
            _ if n & 0xff00 == 0x100 => self.limit_motor2.set_param(n & 0xff, value),
            Some(Param::SuspensionErp) => self.suspension.erp = value,
            Some(Param::SuspensionCfm) => self.suspension.cfm = value,
            _ => self.limit_motor1.set_param(n, value),
        }
    }

    fn param(&self, n: i32) -> f64 {
        match Param::from_number(n) {
            _ if n & 0xff00 == 0x100 => self.limit_motor2.param(n & 0xff),
            Some(Param::SuspensionErp) => self.suspension.erp,
            Some(Param::SuspensionCfm) => self.suspension.cfm,
            _ => self.limit_motor1.param(n),
        }
    }

    /// The travel of the suspension is no error.
    fn error(&self, ends: &Ends<'_>) -> JointError {
        let (a, b) = self.world_axes(ends);
        let d = self.anchors.world2(ends) - self.anchors.world1(ends);
        JointError {
            position: (d - a * a.dot(d)).length(),
            angle: (angle_between(a, b) - real::atan2(self.sine, self.cosine)).abs(),
        }
    }
}

impl JointRef<'_, Hinge2> {
    /// The anchor as the first body sees it, in world coordinates.
    pub fn anchor(&self) -> Vec3 {
        self.data.anchors.world1(&self.ends())
    }

    /// The anchor as the second body sees it, in world coordinates. From [`Self::anchor`] it differs by the travel of the
    /// suspension.
    pub fn anchor2(&self) -> Vec3 {
        self.data.anchors.world2(&self.ends())
    }

    /// Axis 1, fixed in the first body, in world coordinates.
    pub fn axis1(&self) -> Vec3 {
        self.data.world_axes(&self.ends()).0
    }

    /// Axis 2, fixed in the second body, in world coordinates.
    pub fn axis2(&self) -> Vec3 {
        self.data.world_axes(&self.ends()).1
    }

    /// The angle about axis 1, −π … π, positive when the first body turns positively relative to the second; 0 in limbo.
    pub fn angle1(&self) -> f64 {
        let ends = self.ends();
        if ends.first.is_none() { 0.0 } else { self.data.angle1(&ends) }
    }

    /// The angle about axis 2, −π … π, positive when the **second** body turns positively relative to the first, as in
    /// ODE; 0 in limbo.
    pub fn angle2(&self) -> f64 {
        let ends = self.ends();
        if ends.first.is_none() { 0.0 } else { self.data.angle2(&ends) }
    }

    /// Angular velocity about axis 1, of the first body relative to the second, in rad/s; 0 in limbo.
    pub fn angle1_rate(&self) -> f64 {
        self.axis1().dot(self.relative_angular_velocity())
    }

    /// Angular velocity about axis 2, of the first body relative to the second, in rad/s: the opposite of the rate of
    /// [`Self::angle2`], as in ODE; 0 in limbo.
    pub fn angle2_rate(&self) -> f64 {
        self.axis2().dot(self.relative_angular_velocity())
    }

    fn relative_angular_velocity(&self) -> Vec3 {
        let ends = self.ends();
        ends.a().angular_velocity - ends.b().angular_velocity
    }

    /// The softness of the suspension, along axis 1.
    pub fn suspension(&self) -> Softness {
        self.data.suspension
    }
}

impl JointMut<'_, Hinge2> {
    /// Sets the anchor, in world coordinates, and makes the present angles 0. Does nothing in limbo, as ODE.
    ///
    /// # Errors
    /// [`Error::NotFinite`].
    pub fn set_anchor(&mut self, anchor: Vec3) -> Result<(), Error> {
        finite("hinge-2 anchor", anchor)?;
        let (joint, ends) = self.parts();
        if ends.first.is_some() {
            joint.anchors = Anchors::at(&ends, anchor);
            joint.record_references(&ends);
        }
        Ok(())
    }

    /// Sets one or both axes, in world coordinates and of any length. The angle between them is kept from now on, and the
    /// present angles are 0.
    ///
    /// # Errors
    /// [`Error::NotAttached`], [`Error::NotFinite`], [`Error::ZeroVector`]; [`Error::ParallelAxes`] if both are given and
    /// parallel; [`Error::WrongMode`] if none is given.
    pub fn set_axes(&mut self, axis1: Option<Vec3>, axis2: Option<Vec3>) -> Result<(), Error> {
        let axis1 = axis1.map(|axis| unit("hinge-2 axis 1", axis)).transpose()?;
        let axis2 = axis2.map(|axis| unit("hinge-2 axis 2", axis)).transpose()?;
        match (axis1, axis2) {
            (None, None) => {
                return Err(Error::WrongMode { what: "setting hinge-2 axes needs axis 1, axis 2 or both" });
            }
            (Some(a), Some(b)) if a.cross(b).normalized().is_none() => {
                return Err(Error::ParallelAxes { what: "hinge-2 axes 1 and 2" });
            }
            _ => {}
        }
        let (joint, ends) = self.attached_parts("setting hinge-2 axes")?;
        if let Some(axis) = axis1 {
            joint.axes[0] = ends.a().rotation.transpose_mul(axis);
        }
        if let Some(axis) = axis2 {
            joint.axes[1] = ends.b().rotation.transpose_mul(axis);
        }
        joint.record_angle_between(&ends);
        joint.record_references(&ends);
        Ok(())
    }

    /// Sets axis 1 alone. With the other's present value the two may be parallel meanwhile; prefer [`Self::set_axes`].
    ///
    /// # Errors
    /// [`Error::NotAttached`], [`Error::NotFinite`], [`Error::ZeroVector`].
    pub fn set_axis1(&mut self, axis: Vec3) -> Result<(), Error> {
        self.set_axes(Some(axis), None)
    }

    /// Sets axis 2 alone; see [`Self::set_axis1`].
    ///
    /// # Errors
    /// [`Error::NotAttached`], [`Error::NotFinite`], [`Error::ZeroVector`].
    pub fn set_axis2(&mut self, axis: Vec3) -> Result<(), Error> {
        self.set_axes(None, Some(axis))
    }

    /// Sets the softness of the suspension, e.g. [`Softness::from_spring`].
    ///
    /// # Errors
    /// [`Error::OutOfRange`] if a number is not finite.
    pub fn set_suspension(&mut self, softness: Softness) -> Result<(), Error> {
        finite_number("suspension ERP", softness.erp)?;
        finite_number("suspension CFM", softness.cfm)?;
        self.parts().0.suspension = softness;
        Ok(())
    }

    /// Adds torques about axis 1 and axis 2, in newton metres, to the first body, and the opposite to the second, for the
    /// next step. Does nothing in limbo.
    ///
    /// # Errors
    /// [`Error::OutOfRange`] if one is not finite.
    pub fn add_torques(&mut self, torque1: f64, torque2: f64) -> Result<(), Error> {
        finite_number("hinge-2 torque 1", torque1)?;
        finite_number("hinge-2 torque 2", torque2)?;
        let (joint, ends) = self.parts();
        let (a, b) = joint.world_axes(&ends);
        let torque = a * torque1 + b * torque2;
        self.add_opposite_torques(torque);
        Ok(())
    }
}
