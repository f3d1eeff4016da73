//! The universal joint: a cross between two yokes. Holds a point, and keeps two axes, one fixed in each body,
//! perpendicular.

use super::anchor::Anchors;
use super::limit_motor::{LimitMotor, RowAxis, limit_motors};
use super::universal_angles::{UniversalAxes, frame};
use super::{JointError, JointModel, JointMut, JointRef, LimitedAxis};
use crate::Error;
use crate::ends::{Ends, StepContext};
use crate::error::{finite, finite_number, unit};
use crate::rows::{JointRows, RowCount};
use ferrode_math::{Quat, Vec3};

/// The universal joint's data: anchor, axes, zeros of the angles, and stops and motors of both axes.
///
/// Of a joint attached as (world, body), the caller's axis 1 is the joint's second and the other way round; parameters,
/// stops and motors stay with the joint's own axes, as in ODE.
#[derive(Clone, Debug)]
pub struct Universal {
    anchors: Anchors,
    axes: UniversalAxes,
    limit_motor1: LimitMotor,
    limit_motor2: LimitMotor,
}

limit_motors!(Universal { 1 => limit_motor1, 2 => limit_motor2 });

impl Universal {
    pub(crate) fn new(erp: f64, cfm: f64) -> Self {
        Self {
            anchors: Anchors::default(),
            axes: UniversalAxes::new(Vec3::X, Vec3::Y),
            limit_motor1: LimitMotor::new(erp, cfm),
            limit_motor2: LimitMotor::new(erp, cfm),
        }
    }
}

impl JointModel for Universal {
    fn details(&self) -> Vec<(&'static str, Vec<f64>)> {
        vec![
            ("anchor1", self.anchors.first.to_array().to_vec()),
            ("anchor2", self.anchors.second.to_array().to_vec()),
            ("axis1", self.axes.local[0].to_array().to_vec()),
            ("axis2", self.axes.local[1].to_array().to_vec()),
            ("qrel1", crate::foreign::numbers(self.axes.initial[0])),
            ("qrel2", crate::foreign::numbers(self.axes.initial[1])),
        ]
    }

    fn row_count(&mut self, ends: &Ends<'_>, _ctx: &StepContext) -> RowCount {
        let stops = [self.limit_motor1.has_angular_stops(), self.limit_motor2.has_angular_stops()];
        let angles = if stops == [false; 2] { [0.0; 2] } else { self.axes.angles(ends) };
        self.limit_motor1.test(stops[0].then_some(angles[0]));
        self.limit_motor2.test(stops[1].then_some(angles[1]));
        RowCount::new(4 + self.limit_motor1.row_count() + self.limit_motor2.row_count(), 4)
    }

    fn write_rows(&mut self, ends: &Ends<'_>, ctx: &StepContext, out: &mut JointRows<'_>) {
        self.anchors.write_rows(ends, ctx, ctx.erp, &mut out.rows[..3]);
        self.axes.write_perpendicular_row(ends, ctx, &mut out.rows[3], 3);
        let (a, b) = (self.axes.world1(ends), self.axes.world2(ends));
        let mut at = 4;
        self.limit_motor1.write_row(ends, ctx, RowAxis::Angular(a), 4, out, &mut at);
        self.limit_motor2.write_row(ends, ctx, RowAxis::Angular(b), 5, out, &mut at);
    }

    fn attached(&mut self, ends: &Ends<'_>) {
        let p = self.anchors.in_callers_order(ends)[0];
        self.anchors = Anchors::at(ends, p);
        self.axes.reattach(ends);
        self.axes.reset_angles(ends);
    }

    fn limited_axes(&self, ends: &Ends<'_>) -> Vec<LimitedAxis> {
        self.axes.limited(ends, [&self.limit_motor1, &self.limit_motor2])
    }

    fn set_param(&mut self, n: i32, value: f64) {
        if n & 0xff00 == 0x100 {
            self.limit_motor2.set_param(n & 0xff, value);
        } else {
            self.limit_motor1.set_param(n, value);
        }
    }

    fn param(&self, n: i32) -> f64 {
        if n & 0xff00 == 0x100 { self.limit_motor2.param(n & 0xff) } else { self.limit_motor1.param(n) }
    }

    fn error(&self, ends: &Ends<'_>) -> JointError {
        JointError { position: self.anchors.distance(ends), angle: self.axes.error(ends) }
    }
}

impl JointRef<'_, Universal> {
    /// The anchor as the first body sees it, in world coordinates.
    pub fn anchor(&self) -> Vec3 {
        self.data.anchors.in_callers_order(&self.ends())[0]
    }

    /// The anchor as the second body sees it, in world coordinates.
    pub fn anchor2(&self) -> Vec3 {
        self.data.anchors.in_callers_order(&self.ends())[1]
    }

    /// Axis 1, fixed in the caller's first body, in world coordinates.
    pub fn axis1(&self) -> Vec3 {
        self.data.axes.in_callers_order(&self.ends())[0]
    }

    /// Axis 2, fixed in the caller's second body, in world coordinates. That of the static world has the length it was
    /// given.
    pub fn axis2(&self) -> Vec3 {
        self.data.axes.in_callers_order(&self.ends())[1]
    }

    /// Both angles, −π … π: positive when the first body turns positively relative to the second about axis 1, axis 2;
    /// 0 in limbo. They are 0 as of the last setting of the anchor or an axis.
    pub fn angles(&self) -> [f64; 2] {
        self.callers_angles(|axes, ends| axes.angles(ends))
    }

    /// The angle about axis 1.
    pub fn angle1(&self) -> f64 {
        self.callers_angles(|axes, ends| [axes.angle1(ends), axes.angle2(ends)])[0]
    }

    /// The angle about axis 2.
    pub fn angle2(&self) -> f64 {
        self.callers_angles(|axes, ends| [axes.angle1(ends), axes.angle2(ends)])[1]
    }

    /// In reverse the joint's own angles change places, and its first one its sign.
    fn callers_angles(&self, own: impl Fn(&UniversalAxes, &Ends<'_>) -> [f64; 2]) -> [f64; 2] {
        let ends = self.ends();
        if ends.first.is_none() {
            return [0.0; 2];
        }
        let [angle1, angle2] = own(&self.data.axes, &ends);
        if ends.reverse { [angle2, -angle1] } else { [angle1, angle2] }
    }

    /// Angular velocity about axis 1, of the joint's first body relative to its second, in rad/s; 0 in limbo.
    pub fn angle1_rate(&self) -> f64 {
        self.rates()[0]
    }

    /// Angular velocity about axis 2. For a joint attached as (world, body) its sign is opposite to the angle's, as in
    /// ODE.
    pub fn angle2_rate(&self) -> f64 {
        self.rates()[1]
    }

    fn rates(&self) -> [f64; 2] {
        let ends = self.ends();
        let w = ends.a().angular_velocity - ends.b().angular_velocity;
        self.data.axes.in_callers_order(&ends).map(|axis| axis.dot(w))
    }
}

impl JointMut<'_, Universal> {
    /// Sets the anchor, in world coordinates, and makes the present angles 0. Does nothing in limbo, as ODE.
    ///
    /// # Errors
    /// [`Error::NotFinite`].
    pub fn set_anchor(&mut self, anchor: Vec3) -> Result<(), Error> {
        finite("universal anchor", anchor)?;
        let (joint, ends) = self.parts();
        if ends.first.is_some() {
            joint.anchors = Anchors::at(&ends, anchor);
            joint.axes.reset_angles(&ends);
        }
        Ok(())
    }

    /// Sets axis 1, in world coordinates and of any length, and makes the present angles 0. Does nothing in limbo.
    ///
    /// The axes should be perpendicular once both are set; the joint pulls them so.
    ///
    /// # Errors
    /// [`Error::NotFinite`], [`Error::ZeroVector`].
    pub fn set_axis1(&mut self, axis: Vec3) -> Result<(), Error> {
        self.set_axis("universal axis 1", 0, axis)
    }

    /// Sets axis 2; see [`Self::set_axis1`].
    ///
    /// # Errors
    /// [`Error::NotFinite`], [`Error::ZeroVector`].
    pub fn set_axis2(&mut self, axis: Vec3) -> Result<(), Error> {
        self.set_axis("universal axis 2", 1, axis)
    }

    fn set_axis(&mut self, what: &'static str, index: usize, axis: Vec3) -> Result<(), Error> {
        let unit = unit(what, axis)?;
        let (joint, ends) = self.parts();
        if ends.first.is_some() {
            joint.axes.set(&ends, index, unit, axis);
            joint.axes.reset_angles(&ends);
        }
        Ok(())
    }

    /// Sets axis 1 so that the present angles count as `angle1` and `angle2`, in radians. With one body `angle2` has no
    /// effect, as in ODE.
    ///
    /// # Errors
    /// [`Error::NotFinite`], [`Error::ZeroVector`]; [`Error::OutOfRange`] for angles that are not finite;
    /// [`Error::ParallelAxes`]; [`Error::WrongMode`] for a joint attached as (world, body), for which ODE's formula has no
    /// value.
    pub fn set_axis1_offset(&mut self, axis: Vec3, angle1: f64, angle2: f64) -> Result<(), Error> {
        self.set_axis_offset("universal axis 1", 0, axis, [angle1, angle2])
    }

    /// Sets axis 2 so that the present angles count as `angle1` and `angle2`, in radians. With one body only one of them
    /// has an effect, as in ODE: attached as (body, world) `angle1`, as (world, body) `angle2`.
    ///
    /// # Errors
    /// [`Error::NotFinite`], [`Error::ZeroVector`]; [`Error::OutOfRange`] for angles that are not finite;
    /// [`Error::ParallelAxes`].
    pub fn set_axis2_offset(&mut self, axis: Vec3, angle1: f64, angle2: f64) -> Result<(), Error> {
        self.set_axis_offset("universal axis 2", 1, axis, [angle1, angle2])
    }

    fn set_axis_offset(
        &mut self,
        what: &'static str,
        index: usize,
        axis: Vec3,
        [angle1, angle2]: [f64; 2],
    ) -> Result<(), Error> {
        let unit = unit(what, axis)?;
        finite_number("universal angle 1 offset", angle1)?;
        finite_number("universal angle 2 offset", angle2)?;
        let (joint, ends) = self.parts();
        if ends.first.is_none() {
            return Ok(());
        }
        if ends.reverse && index == 0 {
            return Err(Error::WrongMode {
                what: "an offset with universal axis 1 needs a joint attached as (body, body) or (body, world)",
            });
        }
        // In reverse ODE's two assignments give (−angle2, angle2).
        let angle1 = if ends.reverse { -angle2 } else { angle1 };
        let mut axes = joint.axes;
        axes.set(&ends, index, unit, axis);
        let (a, b) = (axes.world1(&ends), axes.world2(&ends));
        let (Some(ab), Some(ba)) = (frame(a, b), frame(b, a)) else {
            return Err(Error::ParallelAxes { what: "universal axes 1 and 2" });
        };
        axes.initial[0] = ends.a().quaternion.conjugate() * (Quat::from_axis_angle(a, angle1) * ab);
        axes.initial[1] = match ends.second {
            Some(second) => second.quaternion.conjugate() * (Quat::from_axis_angle(b, -angle2) * ba),
            None => ba,
        };
        joint.axes = axes;
        Ok(())
    }

    /// Adds torques about axis 1 and axis 2, in newton metres, to the first body, and the opposite to the second, for the
    /// next step. Does nothing in limbo.
    ///
    /// # Errors
    /// [`Error::OutOfRange`] if one is not finite.
    pub fn add_torques(&mut self, torque1: f64, torque2: f64) -> Result<(), Error> {
        finite_number("universal torque 1", torque1)?;
        finite_number("universal torque 2", torque2)?;
        let (joint, ends) = self.parts();
        let [axis1, axis2] = joint.axes.in_callers_order(&ends);
        let torque = (axis1 * torque1 + axis2 * torque2) * ends.sign();
        self.add_opposite_torques(torque);
        Ok(())
    }
}
