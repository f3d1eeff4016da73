//! Piston: translation along and rotation about one common axis.

use super::anchor::Anchors;
use super::axis::{angle_between, hinge_angle, reset_axes, set_axes, write_alignment_rows};
use super::limit_motor::{LimitMotor, RowAxis, limit_motors};
use super::{JointError, JointModel, JointMut, JointRef, LimitedAxis};
use crate::Error;
use crate::ends::{Ends, StepContext};
use crate::error::{finite, finite_number};
use crate::rows::{JointRows, RowCount, Wrench};
use ferrode_math::{Quat, Vec3, plane_space};

/// The piston's data: anchor, axis, the relative rotation that counts as angle 0, and stops and motors of both freedoms.
#[derive(Clone, Debug)]
pub struct Piston {
    anchors: Anchors,
    /// In the coordinates of the first and second body.
    axes: [Vec3; 2],
    /// conj(q₁) q₂ at angle 0.
    initial: Quat,
    prismatic: LimitMotor,
    rotation: LimitMotor,
}

limit_motors!(Piston { 1 => prismatic, 2 => rotation });

impl Piston {
    pub(crate) fn new(erp: f64, cfm: f64) -> Self {
        let limit_motor = LimitMotor::new(erp, cfm);
        Self {
            anchors: Anchors::default(),
            axes: [Vec3::X; 2],
            initial: Quat::IDENTITY,
            prismatic: limit_motor,
            rotation: limit_motor,
        }
    }

    /// The axis in the world, from the first body.
    fn axis(&self, ends: &Ends<'_>) -> Vec3 {
        ends.a().rotation * self.axes[0]
    }

    /// The caller's position: stops of the prismatic axis are tested against it.
    fn position(&self, ends: &Ends<'_>) -> f64 {
        ends.sign() * self.axis(ends).dot(self.anchors.world1(ends) - self.anchors.world2(ends))
    }

    /// The angle that stops are tested against: the caller's, but for a reversed joint, where it is the opposite.
    fn internal_angle(&self, ends: &Ends<'_>) -> f64 {
        hinge_angle(ends.relative_rotation() * self.initial.conjugate(), self.axes[0])
    }
}

impl JointModel for Piston {
    fn details(&self) -> Vec<(&'static str, Vec<f64>)> {
        vec![
            ("anchor1", self.anchors.first.to_array().to_vec()),
            ("anchor2", self.anchors.second.to_array().to_vec()),
            ("axis1", self.axes[0].to_array().to_vec()),
            ("axis2", self.axes[1].to_array().to_vec()),
            ("qrel", crate::foreign::numbers(self.initial)),
        ]
    }

    fn row_count(&mut self, ends: &Ends<'_>, _ctx: &StepContext) -> RowCount {
        let position = self.prismatic.has_linear_stops().then(|| self.position(ends));
        self.prismatic.test(position);
        // As in ODE any finite stop of the angle counts, also beyond ±π.
        let angle = self.rotation.has_linear_stops().then(|| self.internal_angle(ends));
        self.rotation.test(angle);
        RowCount::new(4 + self.prismatic.row_count() + self.rotation.row_count(), 4)
    }

    fn write_rows(&mut self, ends: &Ends<'_>, ctx: &StepContext, out: &mut JointRows<'_>) {
        let a = self.axis(ends);
        let b = ends.b().rotation * self.axes[1];
        write_alignment_rows(a, b, ctx.k(), ends.two(), &mut out.rows[..2], 0);

        // In reverse ODE negates this arm, but not the anchor that it is compared with.
        let arm = (self.anchors.world2(ends) - ends.a().position) * ends.sign();
        let error = arm - ends.a().rotation * self.anchors.first;
        let arm2 = ends.b().rotation * self.anchors.second;
        let (p, q) = plane_space(a);
        for (slot, (row, u)) in (2..).zip(out.rows[2..4].iter_mut().zip([p, q])) {
            row.linear1 = u;
            row.angular1 = arm.cross(u);
            if ends.two() {
                row.linear2 = -u;
                row.angular2 = u.cross(arm2);
            }
            row.correct(ctx.k(), u.dot(error));
            row.slot = slot;
        }

        let mut at = 4;
        self.prismatic.write_row(ends, ctx, RowAxis::Linear(a * ends.sign()), 4, out, &mut at);
        self.rotation.write_row(ends, ctx, RowAxis::Angular(a), 5, out, &mut at);
    }

    fn attached(&mut self, ends: &Ends<'_>) {
        let p = self.anchors.in_callers_order(ends)[0];
        self.anchors = Anchors::at(ends, p);
        self.axes = reset_axes(ends, self.axes[0]);
        self.initial = ends.relative_rotation();
    }

    fn limited_axes(&self, ends: &Ends<'_>) -> Vec<LimitedAxis> {
        let axis = self.axis(ends);
        let hand = ends.a().rotation * plane_space(self.axes[0]).0;
        let angle = self.internal_angle(ends);
        // As in ODE any finite stop of the angle counts, also beyond ±π.
        vec![
            LimitedAxis::sliding(1, axis * ends.sign(), self.position(ends), &self.prismatic),
            LimitedAxis::turning(2, axis, hand, angle, &self.rotation).with_any_stop(&self.rotation),
        ]
    }

    fn set_param(&mut self, n: i32, value: f64) {
        match n & 0xff00 {
            0x100 => self.rotation.set_param(n & 0xff, value),
            _ => self.prismatic.set_param(n, value),
        }
    }

    fn param(&self, n: i32) -> f64 {
        match n & 0xff00 {
            0x100 => self.rotation.param(n & 0xff),
            _ => self.prismatic.param(n),
        }
    }

    fn error(&self, ends: &Ends<'_>) -> JointError {
        let a = self.axis(ends);
        JointError {
            position: a.cross(self.anchors.world1(ends) - self.anchors.world2(ends)).length(),
            angle: angle_between(a, ends.b().rotation * self.axes[1]),
        }
    }
}

impl JointRef<'_, Piston> {
    /// The anchor as the first body sees it, in world coordinates.
    pub fn anchor(&self) -> Vec3 {
        self.data.anchors.in_callers_order(&self.ends())[0]
    }

    /// The anchor as the second body sees it, in world coordinates.
    pub fn anchor2(&self) -> Vec3 {
        self.data.anchors.in_callers_order(&self.ends())[1]
    }

    /// The axis in world coordinates, of unit length.
    pub fn axis(&self) -> Vec3 {
        self.data.axis(&self.ends())
    }

    /// How far the first body has moved along the axis since the anchor was set, relative to the second, in metres; 0 in
    /// limbo.
    pub fn position(&self) -> f64 {
        let ends = self.ends();
        if ends.first.is_none() { 0.0 } else { self.data.position(&ends) }
    }

    /// The rate of the position in m/s, from the velocities of the centres alone; 0 in limbo.
    pub fn position_rate(&self) -> f64 {
        let ends = self.ends();
        let v = ends.a().linear_velocity - ends.b().linear_velocity;
        ends.sign() * self.data.axis(&ends).dot(v)
    }

    /// The angle in −π … π: positive when the first body has turned about the axis, relative to the second; 0 in limbo.
    ///
    /// For a joint attached as (world, body) the stops and the motor act on the opposite of this angle, as in ODE.
    pub fn angle(&self) -> f64 {
        let ends = self.ends();
        if ends.first.is_none() { 0.0 } else { ends.sign() * self.data.internal_angle(&ends) }
    }

    /// The rate of the angle, in rad/s; 0 in limbo.
    pub fn angle_rate(&self) -> f64 {
        let ends = self.ends();
        let w = ends.a().angular_velocity - ends.b().angular_velocity;
        ends.sign() * self.data.axis(&ends).dot(w)
    }
}

impl JointMut<'_, Piston> {
    /// Sets the anchor, in world coordinates, and makes the present position and angle 0. Does nothing in limbo.
    ///
    /// # Errors
    /// [`Error::NotFinite`].
    pub fn set_anchor(&mut self, anchor: Vec3) -> Result<(), Error> {
        self.set_anchor_offset(anchor, Vec3::ZERO)
    }

    /// As [`Self::set_anchor`], but makes the present position the component of `offset` along the axis, as if the first
    /// body had been moved by `offset` since. Does nothing in limbo.
    ///
    /// # Errors
    /// [`Error::NotFinite`].
    pub fn set_anchor_offset(&mut self, anchor: Vec3, offset: Vec3) -> Result<(), Error> {
        finite("piston anchor", anchor)?;
        finite("piston anchor offset", offset)?;
        let (piston, ends) = self.parts();
        if ends.first.is_some() {
            piston.anchors = Anchors::at_displaced(&ends, anchor, offset * -ends.sign());
            piston.initial = ends.relative_rotation();
        }
        Ok(())
    }

    /// Sets the axis, in world coordinates and of any length, and makes the present angle 0. Does nothing in limbo.
    ///
    /// # Errors
    /// [`Error::NotFinite`], [`Error::ZeroVector`].
    pub fn set_axis(&mut self, axis: Vec3) -> Result<(), Error> {
        let (piston, ends) = self.parts();
        let axes = set_axes(&ends, "piston axis", axis)?;
        if ends.first.is_some() {
            piston.axes = axes;
            piston.initial = ends.relative_rotation();
        }
        Ok(())
    }

    /// ODE's `dJointSetPistonAxisDelta`, deprecated there: as [`Self::set_axis`], then puts the first body's anchor at the
    /// difference of the centres less `delta`. In general the position has no meaning then; use
    /// [`Self::set_anchor_offset`].
    ///
    /// # Errors
    /// [`Error::NotFinite`], [`Error::ZeroVector`]; [`Error::NotAttached`] in limbo.
    pub fn set_axis_delta(&mut self, axis: Vec3, delta: Vec3) -> Result<(), Error> {
        finite("piston axis delta", delta)?;
        self.as_ref().require_attached("piston axis delta")?;
        self.set_axis(axis)?;
        let (piston, ends) = self.parts();
        let between = ends.a().position - ends.b().position - delta;
        piston.anchors.first = ends.a().rotation.transpose_mul(between);
        Ok(())
    }

    /// Adds a force along the axis, in newtons, to the first body, and the opposite to the second, for the next step.
    ///
    /// As in ODE a joint attached as (world, body) adds nothing, and between two bodies the torques of the two forces
    /// about the anchors have the same sign, so they do not cancel. Does nothing in limbo.
    ///
    /// # Errors
    /// [`Error::OutOfRange`] if it is not finite.
    pub fn add_force(&mut self, force: f64) -> Result<(), Error> {
        finite_number("piston force", force)?;
        let (piston, ends) = self.parts();
        if ends.reverse {
            return Ok(());
        }
        let force = piston.axis(&ends) * force;
        let mut wrenches = [force, -force].map(|force| Wrench { force, torque: Vec3::ZERO });
        if ends.two() {
            wrenches[0].torque = (ends.a().rotation * piston.anchors.first).cross(force);
            wrenches[1].torque = (ends.b().rotation * piston.anchors.second).cross(force);
        }
        self.add_wrenches(wrenches);
        Ok(())
    }
}
