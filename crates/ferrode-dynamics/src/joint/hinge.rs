//! The hinge: holds a point and an axis of one body to those of the other, and leaves the turn about the axis.

use super::anchor::Anchors;
use super::axis::{hinge_angle, reset_axes, set_axes, write_alignment_rows};
use super::limit_motor::{LimitMotor, RowAxis, limit_motors};
use super::{JointError, JointModel, JointMut, JointRef, LimitedAxis};
use crate::Error;
use crate::carried::{Carried, CarriedHinge};
use crate::ends::{Ends, StepContext};
use crate::error::{finite, finite_number};
use crate::rows::{JointRows, RowCount};
use ferrode_math::{Quat, Vec3, plane_space};

/// The hinge's data: anchor, axis, the relative rotation that counts as angle 0, and the stops and motor.
#[derive(Clone, Debug)]
pub struct Hinge {
    anchors: Anchors,
    /// In the coordinates of the first and second body.
    axes: [Vec3; 2],
    /// conj(q₁) q₂ at angle 0.
    initial: Quat,
    limit_motor: LimitMotor,
}

limit_motors!(Hinge => limit_motor);

impl Hinge {
    pub(crate) fn new(erp: f64, cfm: f64) -> Self {
        Self {
            anchors: Anchors::default(),
            axes: [Vec3::X; 2],
            initial: Quat::IDENTITY,
            limit_motor: LimitMotor::new(erp, cfm),
        }
    }

    /// The axis in the world, from the first body.
    fn axis(&self, ends: &Ends<'_>) -> Vec3 {
        ends.a().rotation * self.axes[0]
    }

    /// The angle that stops are tested against: the caller's, but for a reversed joint, where it is the opposite.
    fn internal_angle(&self, ends: &Ends<'_>) -> f64 {
        hinge_angle(ends.relative_rotation() * self.initial.conjugate(), self.axes[0])
    }
}

impl JointModel for Hinge {
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
        let angle = self.limit_motor.has_angular_stops().then(|| self.internal_angle(ends));
        self.limit_motor.test(angle);
        RowCount::new(5 + self.limit_motor.row_count(), 5)
    }

    fn write_rows(&mut self, ends: &Ends<'_>, ctx: &StepContext, out: &mut JointRows<'_>) {
        self.anchors.write_rows(ends, ctx, ctx.erp, &mut out.rows[..3]);
        let a = self.axis(ends);
        let b = ends.b().rotation * self.axes[1];
        write_alignment_rows(a, b, ctx.k(), ends.two(), &mut out.rows[3..5], 3);
        self.limit_motor.write_row(ends, ctx, RowAxis::Angular(a), 5, out, &mut 5);
    }

    fn carried(&mut self, ends: &Ends<'_>, ctx: &StepContext) -> Option<Carried> {
        let angle = self.limit_motor.has_angular_stops().then(|| self.internal_angle(ends));
        self.limit_motor.test(angle);
        let drive = self.limit_motor.carried(angle, ctx)?;
        let mut carried = self.anchors.carried(ends, ctx.cfm);
        let axis = self.axis(ends);
        let slip = ends.b().rotation * self.axes[1] - axis;
        carried.hinge = Some(CarriedHinge { axis, slip, across: plane_space(axis).into(), drive });
        Some(carried)
    }

    fn attached(&mut self, ends: &Ends<'_>) {
        let p = self.anchors.in_callers_order(ends)[0];
        self.anchors = Anchors::at(ends, p);
        self.axes = reset_axes(ends, self.axes[0]);
        self.initial = ends.relative_rotation();
    }

    fn limited_axes(&self, ends: &Ends<'_>) -> Vec<LimitedAxis> {
        let hand = ends.a().rotation * plane_space(self.axes[0]).0;
        let angle = self.internal_angle(ends);
        vec![LimitedAxis::turning(1, self.axis(ends), hand, angle, &self.limit_motor)]
    }

    fn set_param(&mut self, n: i32, value: f64) {
        self.limit_motor.set_param(n, value);
    }

    fn param(&self, n: i32) -> f64 {
        self.limit_motor.param(n)
    }

    fn error(&self, ends: &Ends<'_>) -> JointError {
        JointError {
            position: self.anchors.distance(ends),
            angle: super::axis::angle_between(self.axis(ends), ends.b().rotation * self.axes[1]),
        }
    }
}

impl JointRef<'_, Hinge> {
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

    /// The angle in −π … π: positive when the first body has turned about the axis, relative to the second, by the right
    /// hand; 0 in limbo.
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

impl JointMut<'_, Hinge> {
    /// Sets the anchor, in world coordinates, and makes the present angle 0. Does nothing in limbo, as ODE.
    ///
    /// # Errors
    /// [`Error::NotFinite`].
    pub fn set_anchor(&mut self, anchor: Vec3) -> Result<(), Error> {
        self.set_anchor_delta(anchor, Vec3::ZERO)
    }

    /// As [`Self::set_anchor`], but of a joint with one body the world's side is put at `anchor + delta`, and the joint
    /// then closes the gap. With two bodies `delta` is ignored.
    ///
    /// # Errors
    /// [`Error::NotFinite`].
    pub fn set_anchor_delta(&mut self, anchor: Vec3, delta: Vec3) -> Result<(), Error> {
        finite("hinge anchor", anchor)?;
        finite("hinge anchor delta", delta)?;
        let (hinge, ends) = self.parts();
        if ends.first.is_some() {
            hinge.anchors = Anchors::at(&ends, anchor);
            if !ends.two() {
                hinge.anchors.second += delta;
            }
            hinge.initial = ends.relative_rotation();
        }
        Ok(())
    }

    /// Sets the axis, in world coordinates and of any length, and makes the present angle 0. Does nothing in limbo.
    ///
    /// # Errors
    /// [`Error::NotFinite`], [`Error::ZeroVector`].
    pub fn set_axis(&mut self, axis: Vec3) -> Result<(), Error> {
        let (hinge, ends) = self.parts();
        let axes = set_axes(&ends, "hinge axis", axis)?;
        if ends.first.is_some() {
            hinge.axes = axes;
            hinge.initial = ends.relative_rotation();
        }
        Ok(())
    }

    /// ODE's `dJointSetHingeAxisOffset`: sets the axis, then shifts the zero of the angle by `angle` radians.
    ///
    /// With bodies turned by φ about the axis relative to coincidence, the angle reads 2 φ − `angle` then, as in ODE;
    /// from aligned bodies −`angle`. For other relative orientations the angle has no meaning.
    ///
    /// # Errors
    /// [`Error::NotFinite`], [`Error::ZeroVector`], [`Error::OutOfRange`] if the angle is not finite.
    pub fn set_axis_offset(&mut self, axis: Vec3, angle: f64) -> Result<(), Error> {
        finite_number("hinge angle offset", angle)?;
        self.set_axis(axis)?;
        let (hinge, ends) = self.parts();
        if ends.first.is_some() {
            let turn = Quat::from_axis_angle(axis, ends.sign() * angle);
            hinge.initial = (hinge.initial * turn).conjugate();
        }
        Ok(())
    }

    /// Adds a torque about the axis, in newton metres, to the first body, and the opposite to the second, for the next
    /// step. Does nothing in limbo.
    ///
    /// # Errors
    /// [`Error::OutOfRange`] if it is not finite.
    pub fn add_torque(&mut self, torque: f64) -> Result<(), Error> {
        finite_number("hinge torque", torque)?;
        let (hinge, ends) = self.parts();
        let torque = hinge.axis(&ends) * (ends.sign() * torque);
        self.add_opposite_torques(torque);
        Ok(())
    }
}
