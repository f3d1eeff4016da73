//! Prismatic and rotoide: the first body slides along an axis P of its own, relative to an anchor that turns about an
//! axis R of both bodies. P and R must be perpendicular.

use super::anchor::Anchors;
use super::axis::{angle_between, hinge_angle, reset_axes, set_axes};
use super::limit_motor::{LimitMotor, RowAxis, limit_motors};
use super::{JointError, JointModel, JointMut, JointRef, LimitedAxis};
use crate::Error;
use crate::ends::{Ends, StepContext};
use crate::error::{finite, finite_number, unit};
use crate::rows::{JointRows, RowCount, Wrench};
use ferrode_math::{Quat, Vec3};

/// The prismatic-rotoide joint's data: anchor, axes, the relative rotation that counts as angle 0, and stops and motors
/// of both freedoms.
#[derive(Clone, Debug)]
pub struct PR {
    anchors: Anchors,
    /// P in the first body's coordinates.
    prismatic_axis: Vec3,
    /// R in the coordinates of the first and second body.
    rotoide_axes: [Vec3; 2],
    /// conj(q₁) q₂ at angle 0.
    initial: Quat,
    prismatic: LimitMotor,
    rotoide: LimitMotor,
}

limit_motors!(PR { 1 => prismatic, 2 => rotoide });

impl PR {
    pub(crate) fn new(erp: f64, cfm: f64) -> Self {
        let limit_motor = LimitMotor::new(erp, cfm);
        Self {
            anchors: Anchors::default(),
            prismatic_axis: Vec3::Y,
            rotoide_axes: [Vec3::X; 2],
            initial: Quat::IDENTITY,
            prismatic: limit_motor,
            rotoide: limit_motor,
        }
    }

    /// P in the world.
    fn prismatic_axis(&self, ends: &Ends<'_>) -> Vec3 {
        ends.a().rotation * self.prismatic_axis
    }

    /// R in the world, from the first body.
    fn rotoide_axis(&self, ends: &Ends<'_>) -> Vec3 {
        ends.a().rotation * self.rotoide_axes[0]
    }

    /// The caller's position: stops of the prismatic axis are tested against it.
    fn position(&self, ends: &Ends<'_>) -> f64 {
        ends.sign() * self.prismatic_axis(ends).dot(self.anchors.world1(ends) - self.anchors.world2(ends))
    }

    /// The angle that stops are tested against: the caller's, but for a reversed joint, where it is the opposite.
    fn internal_angle(&self, ends: &Ends<'_>) -> f64 {
        hinge_angle(ends.relative_rotation() * self.initial.conjugate(), self.rotoide_axes[0])
    }
}

impl JointModel for PR {
    fn details(&self) -> Vec<(&'static str, Vec<f64>)> {
        vec![
            ("anchor2", self.anchors.second.to_array().to_vec()),
            ("axisR1", self.rotoide_axes[0].to_array().to_vec()),
            ("axisR2", self.rotoide_axes[1].to_array().to_vec()),
            ("axisP1", self.prismatic_axis.to_array().to_vec()),
            ("qrel", crate::foreign::numbers(self.initial)),
            ("offset", self.anchors.first.to_array().to_vec()),
        ]
    }

    fn row_count(&mut self, ends: &Ends<'_>, _ctx: &StepContext) -> RowCount {
        let position = self.prismatic.has_linear_stops().then(|| self.position(ends));
        self.prismatic.test(position);
        let angle = self.rotoide.has_angular_stops().then(|| self.internal_angle(ends));
        self.rotoide.test(angle);
        RowCount::new(4 + self.prismatic.row_count() + self.rotoide.row_count(), 4)
    }

    fn write_rows(&mut self, ends: &Ends<'_>, ctx: &StepContext, out: &mut JointRows<'_>) {
        let k = ctx.k();
        let p = self.prismatic_axis(ends);
        let a = self.rotoide_axis(ends);
        let b = ends.b().rotation * self.rotoide_axes[1];
        let across = a.cross(p);
        // In reverse ODE negates this arm, but not the anchor that it is compared with.
        let arm = (self.anchors.world2(ends) - ends.a().position) * ends.sign();
        let error = arm - ends.a().rotation * self.anchors.first;
        let arm2 = ends.b().rotation * self.anchors.second;

        let [align_p, align_across, along_a, along_across, ..] = out.rows else { return };
        let tilt = a.cross(b);
        for (slot, row, u) in [(0, align_p, p), (1, align_across, across)] {
            row.set_angular(u, ends.two());
            row.correct(k, tilt.dot(u));
            row.slot = slot;
        }
        // The torque on the second body is about its own axis R.
        for (slot, row, u, u2) in [(2, along_a, a, b), (3, along_across, across, across)] {
            row.linear1 = u;
            row.angular1 = arm.cross(u);
            if ends.two() {
                row.linear2 = -u;
                row.angular2 = u2.cross(arm2);
            }
            row.correct(k, u.dot(error));
            row.slot = slot;
        }

        let mut at = 4;
        self.prismatic.write_row(ends, ctx, RowAxis::Linear(p * ends.sign()), 4, out, &mut at);
        self.rotoide.write_row(ends, ctx, RowAxis::Angular(a), 5, out, &mut at);
    }

    fn attached(&mut self, ends: &Ends<'_>) {
        let p = self.anchors.world2(ends);
        self.anchors = Anchors::at(ends, p);
        self.rotoide_axes = reset_axes(ends, self.rotoide_axes[0]);
        self.initial = ends.relative_rotation();
    }

    fn limited_axes(&self, ends: &Ends<'_>) -> Vec<LimitedAxis> {
        let along = self.prismatic_axis(ends) * ends.sign();
        let hand = ends.a().rotation * self.prismatic_axis;
        let angle = self.internal_angle(ends);
        vec![
            LimitedAxis::sliding(1, along, self.position(ends), &self.prismatic),
            LimitedAxis::turning(2, self.rotoide_axis(ends), hand, angle, &self.rotoide),
        ]
    }

    fn set_param(&mut self, n: i32, value: f64) {
        match n & 0xff00 {
            0x100 => self.rotoide.set_param(n & 0xff, value),
            _ => self.prismatic.set_param(n, value),
        }
    }

    fn param(&self, n: i32) -> f64 {
        match n & 0xff00 {
            0x100 => self.rotoide.param(n & 0xff),
            _ => self.prismatic.param(n),
        }
    }

    fn error(&self, ends: &Ends<'_>) -> JointError {
        let gap = self.anchors.world1(ends) - self.anchors.world2(ends);
        JointError {
            position: self.prismatic_axis(ends).cross(gap).length(),
            angle: angle_between(self.rotoide_axis(ends), ends.b().rotation * self.rotoide_axes[1]),
        }
    }
}

impl JointRef<'_, PR> {
    /// The anchor as the joint's second body, or the world, sees it, in world coordinates: also of a joint attached as
    /// (world, body).
    pub fn anchor(&self) -> Vec3 {
        self.data.anchors.world2(&self.ends())
    }

    /// The prismatic axis in world coordinates, of unit length.
    pub fn axis1(&self) -> Vec3 {
        self.data.prismatic_axis(&self.ends())
    }

    /// The rotoide axis in world coordinates, of unit length.
    pub fn axis2(&self) -> Vec3 {
        self.data.rotoide_axis(&self.ends())
    }

    /// How far the first body has moved along the prismatic axis since the anchor was set, in metres.
    ///
    /// # Errors
    /// [`Error::NotAttached`] in limbo.
    pub fn position(&self) -> Result<f64, Error> {
        self.require_attached("prismatic-rotoide position")?;
        Ok(self.data.position(&self.ends()))
    }

    /// The rate of the position in m/s, from the velocities of the first body's centre and the second body's anchor.
    ///
    /// # Errors
    /// [`Error::NotAttached`] in limbo.
    pub fn position_rate(&self) -> Result<f64, Error> {
        self.require_attached("prismatic-rotoide position rate")?;
        let ends = self.ends();
        let b = ends.b();
        let arm2 = b.rotation * self.data.anchors.second;
        let v2 = b.linear_velocity + b.angular_velocity.cross(arm2);
        Ok(ends.sign() * self.data.prismatic_axis(&ends).dot(ends.a().linear_velocity - v2))
    }

    /// The angle in −π … π: positive when the first body has turned about the rotoide axis, relative to the second; 0 in
    /// limbo.
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
        ends.sign() * self.data.rotoide_axis(&ends).dot(w)
    }
}

impl JointMut<'_, PR> {
    /// Sets the anchor, in world coordinates, and makes the present position 0; the angle keeps its zero. Does nothing in
    /// limbo.
    ///
    /// # Errors
    /// [`Error::NotFinite`].
    pub fn set_anchor(&mut self, anchor: Vec3) -> Result<(), Error> {
        finite("prismatic-rotoide anchor", anchor)?;
        let (pr, ends) = self.parts();
        if ends.first.is_some() {
            pr.anchors = Anchors::at(&ends, anchor);
        }
        Ok(())
    }

    /// Sets the prismatic axis, in world coordinates and of any length, and makes the present angle 0. Does nothing in
    /// limbo. It must be perpendicular to the rotoide axis when the joint is stepped.
    ///
    /// # Errors
    /// [`Error::NotFinite`], [`Error::ZeroVector`].
    pub fn set_axis1(&mut self, axis: Vec3) -> Result<(), Error> {
        let axis = unit("prismatic axis", axis)?;
        let (pr, ends) = self.parts();
        if ends.first.is_some() {
            pr.prismatic_axis = ends.a().rotation.transpose_mul(axis);
            pr.initial = ends.relative_rotation();
        }
        Ok(())
    }

    /// Sets the rotoide axis, in world coordinates and of any length, and makes the present angle 0. Does nothing in
    /// limbo.
    ///
    /// # Errors
    /// [`Error::NotFinite`], [`Error::ZeroVector`].
    pub fn set_axis2(&mut self, axis: Vec3) -> Result<(), Error> {
        let (pr, ends) = self.parts();
        let axes = set_axes(&ends, "rotoide axis", axis)?;
        if ends.first.is_some() {
            pr.rotoide_axes = axes;
            pr.initial = ends.relative_rotation();
        }
        Ok(())
    }

    /// Adds a torque about the rotoide axis, in newton metres, to the first body, and the opposite to the second, for the
    /// next step. Does nothing in limbo.
    ///
    /// # Errors
    /// [`Error::OutOfRange`] if it is not finite.
    pub fn add_torque(&mut self, torque: f64) -> Result<(), Error> {
        finite_number("rotoide torque", torque)?;
        let (pr, ends) = self.parts();
        let torque = pr.rotoide_axis(&ends) * (ends.sign() * torque);
        self.add_wrenches([
            Wrench { force: Vec3::ZERO, torque },
            Wrench { force: Vec3::ZERO, torque: -torque },
        ]);
        Ok(())
    }
}
