//! Prismatic and universal: a universal joint whose anchor slides along an axis P of the first body.

use super::anchor::Anchors;
use super::limit_motor::{LimitMotor, RowAxis, limit_motors};
use super::universal_angles::UniversalAxes;
use super::{JointError, JointModel, JointMut, JointRef, LimitedAxis};
use crate::Error;
use crate::ends::{Ends, StepContext};
use crate::error::{finite, finite_number, unit};
use crate::rows::{JointRows, RowCount, Wrench};
use ferrode_math::{Vec3, plane_space};

/// The prismatic-universal joint's data: anchor, axes, zeros of the angles, and stops and motors of its three freedoms.
#[derive(Clone, Debug)]
pub struct PU {
    anchors: Anchors,
    axes: UniversalAxes,
    /// P in the first body's coordinates.
    prismatic_axis: Vec3,
    limit_motor1: LimitMotor,
    limit_motor2: LimitMotor,
    prismatic: LimitMotor,
}

limit_motors!(PU { 1 => limit_motor1, 2 => limit_motor2, 3 => prismatic });

impl PU {
    pub(crate) fn new(erp: f64, cfm: f64) -> Self {
        let limit_motor = LimitMotor::new(erp, cfm);
        Self {
            anchors: Anchors::default(),
            axes: UniversalAxes::new(Vec3::Y, Vec3::Z),
            prismatic_axis: Vec3::X,
            limit_motor1: limit_motor,
            limit_motor2: limit_motor,
            prismatic: limit_motor,
        }
    }

    /// P in the world.
    fn prismatic_axis(&self, ends: &Ends<'_>) -> Vec3 {
        ends.a().rotation * self.prismatic_axis
    }

    /// P as the rows take it: in reverse ODE forgets to rotate it to the world.
    fn row_axis(&self, ends: &Ends<'_>) -> Vec3 {
        if ends.reverse { self.prismatic_axis } else { self.prismatic_axis(ends) }
    }

    /// The caller's position: stops of the prismatic axis are tested against it.
    fn position(&self, ends: &Ends<'_>) -> f64 {
        ends.sign() * self.prismatic_axis(ends).dot(self.anchors.world1(ends) - self.anchors.world2(ends))
    }
}

impl JointModel for PU {
    fn details(&self) -> Vec<(&'static str, Vec<f64>)> {
        vec![
            ("anchor1", self.anchors.first.to_array().to_vec()),
            ("anchor2", self.anchors.second.to_array().to_vec()),
            ("axis1", self.axes.local[0].to_array().to_vec()),
            ("axis2", self.axes.local[1].to_array().to_vec()),
            ("axisP", self.prismatic_axis.to_array().to_vec()),
            ("qrel1", crate::foreign::numbers(self.axes.initial[0])),
            ("qrel2", crate::foreign::numbers(self.axes.initial[1])),
        ]
    }

    fn row_count(&mut self, ends: &Ends<'_>, _ctx: &StepContext) -> RowCount {
        let position = self.prismatic.has_linear_stops().then(|| self.position(ends));
        self.prismatic.test(position);
        let stops = [self.limit_motor1.has_angular_stops(), self.limit_motor2.has_angular_stops()];
        let angles = if stops == [false; 2] { [0.0; 2] } else { self.axes.angles(ends) };
        self.limit_motor1.test(stops[0].then_some(angles[0]));
        self.limit_motor2.test(stops[1].then_some(angles[1]));
        let freedoms = [&self.limit_motor1, &self.limit_motor2, &self.prismatic];
        RowCount::new(3 + freedoms.map(LimitMotor::row_count).iter().sum::<usize>(), 3)
    }

    fn write_rows(&mut self, ends: &Ends<'_>, ctx: &StepContext, out: &mut JointRows<'_>) {
        let row_axis = self.row_axis(ends);
        self.axes.write_perpendicular_row(ends, ctx, &mut out.rows[0], 0);
        let (p, q) = plane_space(row_axis);
        self.anchors.write_rows_along([p, q], [ctx.k(); 2], ends, &mut out.rows[1..3]);
        for (slot, row) in (1..).zip(&mut out.rows[1..3]) {
            row.slot = slot;
        }

        let mut at = 3;
        let (a, b) = (self.axes.world1(ends), self.axes.world2(ends));
        self.limit_motor1.write_row(ends, ctx, RowAxis::Angular(a), 3, out, &mut at);
        self.limit_motor2.write_row(ends, ctx, RowAxis::Angular(b), 4, out, &mut at);
        let sliding = RowAxis::TwoPoint {
            axis: row_axis * ends.sign(),
            arm1: ends.a().rotation * self.anchors.first,
            arm2: ends.b().rotation * self.anchors.second,
        };
        self.prismatic.write_row(ends, ctx, sliding, 5, out, &mut at);
    }

    fn attached(&mut self, ends: &Ends<'_>) {
        let p = self.anchors.world2(ends);
        self.anchors = Anchors::at(ends, p);
        self.axes.reattach(ends);
        self.axes.reset_angles(ends);
    }

    fn limited_axes(&self, ends: &Ends<'_>) -> Vec<LimitedAxis> {
        let mut axes = self.axes.limited(ends, [&self.limit_motor1, &self.limit_motor2]);
        let along = self.prismatic_axis(ends) * ends.sign();
        axes.push(LimitedAxis::sliding(3, along, self.position(ends), &self.prismatic));
        axes
    }

    fn set_param(&mut self, n: i32, value: f64) {
        match n >> 8 {
            0 => self.limit_motor1.set_param(n, value),
            1 => self.limit_motor2.set_param(n & 0xff, value),
            2 => self.prismatic.set_param(n & 0xff, value),
            _ => {}
        }
    }

    fn param(&self, n: i32) -> f64 {
        match n >> 8 {
            0 => self.limit_motor1.param(n),
            1 => self.limit_motor2.param(n & 0xff),
            2 => self.prismatic.param(n & 0xff),
            _ => 0.0,
        }
    }

    fn error(&self, ends: &Ends<'_>) -> JointError {
        let gap = self.anchors.world1(ends) - self.anchors.world2(ends);
        JointError { position: self.prismatic_axis(ends).cross(gap).length(), angle: self.axes.error(ends) }
    }
}

impl JointRef<'_, PU> {
    /// The anchor as the joint's second body, or the world, sees it, in world coordinates: also of a joint attached as
    /// (world, body).
    pub fn anchor(&self) -> Vec3 {
        self.data.anchors.world2(&self.ends())
    }

    /// The universal joint's axis 1 in world coordinates.
    pub fn axis1(&self) -> Vec3 {
        self.data.axes.in_callers_order(&self.ends())[0]
    }

    /// The universal joint's axis 2 in world coordinates.
    pub fn axis2(&self) -> Vec3 {
        self.data.axes.in_callers_order(&self.ends())[1]
    }

    /// The prismatic axis in world coordinates, of unit length.
    pub fn axis3(&self) -> Vec3 {
        self.data.prismatic_axis(&self.ends())
    }

    /// The same as [`Self::axis3`].
    pub fn axis_p(&self) -> Vec3 {
        self.axis3()
    }

    /// Both angles, of one measurement; (0, 0) in limbo. For a joint attached as (world, body) they are exchanged, but not
    /// negated, as in ODE.
    pub fn angles(&self) -> [f64; 2] {
        let ends = self.ends();
        if ends.first.is_none() {
            return [0.0; 2];
        }
        let [angle1, angle2] = self.data.axes.angles(&ends);
        if ends.reverse { [angle2, angle1] } else { [angle1, angle2] }
    }

    /// The angle about axis 1, in −π … π; 0 in limbo.
    pub fn angle1(&self) -> f64 {
        self.single_angle(0)
    }

    /// The angle about axis 2, in −π … π; 0 in limbo.
    pub fn angle2(&self) -> f64 {
        self.single_angle(1)
    }

    fn single_angle(&self, index: usize) -> f64 {
        let ends = self.ends();
        if ends.first.is_none() {
            0.0
        } else if (index == 0) != ends.reverse {
            self.data.axes.angle1(&ends)
        } else {
            self.data.axes.angle2(&ends)
        }
    }

    /// The rate of the angle about axis 1, in rad/s; 0 in limbo.
    pub fn angle1_rate(&self) -> f64 {
        self.angle_rate(self.axis1())
    }

    /// The rate of the angle about axis 2, in rad/s; 0 in limbo.
    pub fn angle2_rate(&self) -> f64 {
        self.angle_rate(self.axis2())
    }

    fn angle_rate(&self, axis: Vec3) -> f64 {
        let ends = self.ends();
        axis.dot(ends.a().angular_velocity - ends.b().angular_velocity)
    }

    /// How far the first body has moved along the prismatic axis since the anchor was set, in metres.
    ///
    /// # Errors
    /// [`Error::NotAttached`] in limbo.
    pub fn position(&self) -> Result<f64, Error> {
        self.require_attached("prismatic-universal position")?;
        Ok(self.data.position(&self.ends()))
    }

    /// The rate of the position, in m/s; 0 in limbo. While a second body turns it differs from the position's derivative:
    /// ODE takes that body's part with the wrong sign.
    pub fn position_rate(&self) -> f64 {
        let ends = self.ends();
        let (a, b) = (ends.a(), ends.b());
        let arm2 = b.rotation * self.data.anchors.second;
        let anchor = b.position + arm2;
        let v1 = a.linear_velocity + (a.position - anchor).cross(a.angular_velocity);
        let v2 = b.linear_velocity + arm2.cross(b.angular_velocity);
        ends.sign() * self.data.prismatic_axis(&ends).dot(v1 - v2)
    }
}

impl JointMut<'_, PU> {
    /// Sets the anchor, in world coordinates, and makes the present position and angles 0. Does nothing in limbo.
    ///
    /// # Errors
    /// [`Error::NotFinite`].
    pub fn set_anchor(&mut self, anchor: Vec3) -> Result<(), Error> {
        self.set_anchor_displaced(anchor, Vec3::ZERO, |_| 0.0)
    }

    /// As [`Self::set_anchor`], as if the first body stood at `delta` from where it is: the position reads minus the
    /// component of `delta` along the prismatic axis then. ODE deprecates it for [`Self::set_anchor_offset`].
    ///
    /// # Errors
    /// [`Error::NotFinite`].
    pub fn set_anchor_delta(&mut self, anchor: Vec3, delta: Vec3) -> Result<(), Error> {
        self.set_anchor_displaced(anchor, delta, |_| 1.0)
    }

    /// As [`Self::set_anchor`], as if the first body had been moved by `offset` since: the position reads the component of
    /// `offset` along the prismatic axis then.
    ///
    /// # Errors
    /// [`Error::NotFinite`].
    pub fn set_anchor_offset(&mut self, anchor: Vec3, offset: Vec3) -> Result<(), Error> {
        self.set_anchor_displaced(anchor, offset, |ends| -ends.sign())
    }

    fn set_anchor_displaced(
        &mut self,
        anchor: Vec3,
        by: Vec3,
        factor: impl Fn(&Ends<'_>) -> f64,
    ) -> Result<(), Error> {
        finite("prismatic-universal anchor", anchor)?;
        finite("prismatic-universal anchor offset", by)?;
        let (pu, ends) = self.parts();
        if ends.first.is_some() {
            pu.anchors = Anchors::at_displaced(&ends, anchor, by * factor(&ends));
            pu.axes.reset_angles(&ends);
        }
        Ok(())
    }

    /// Sets axis 1, in world coordinates and of any length, and makes the present angles 0. Does nothing in limbo. For a
    /// joint with one body the axis of the world's side keeps its length, as in ODE; give unit vectors.
    ///
    /// # Errors
    /// [`Error::NotFinite`], [`Error::ZeroVector`].
    pub fn set_axis1(&mut self, axis: Vec3) -> Result<(), Error> {
        self.set_universal_axis(0, "prismatic-universal axis 1", axis)
    }

    /// As [`Self::set_axis1`], for axis 2.
    ///
    /// # Errors
    /// [`Error::NotFinite`], [`Error::ZeroVector`].
    pub fn set_axis2(&mut self, axis: Vec3) -> Result<(), Error> {
        self.set_universal_axis(1, "prismatic-universal axis 2", axis)
    }

    fn set_universal_axis(&mut self, index: usize, what: &'static str, axis: Vec3) -> Result<(), Error> {
        let direction = unit(what, axis)?;
        let (pu, ends) = self.parts();
        if ends.first.is_some() {
            pu.axes.set(&ends, index, direction, axis);
            pu.axes.reset_angles(&ends);
        }
        Ok(())
    }

    /// The same as [`Self::set_axis3`].
    ///
    /// # Errors
    /// [`Error::NotFinite`], [`Error::ZeroVector`].
    pub fn set_axis_p(&mut self, axis: Vec3) -> Result<(), Error> {
        self.set_axis3(axis)
    }

    /// Sets the prismatic axis, in world coordinates and of any length, and makes the present angles 0. Does nothing in
    /// limbo.
    ///
    /// # Errors
    /// [`Error::NotFinite`], [`Error::ZeroVector`].
    pub fn set_axis3(&mut self, axis: Vec3) -> Result<(), Error> {
        let axis = unit("prismatic axis", axis)?;
        let (pu, ends) = self.parts();
        if ends.first.is_some() {
            pu.prismatic_axis = ends.a().rotation.transpose_mul(axis);
            pu.axes.reset_angles(&ends);
        }
        Ok(())
    }

    /// Adds torques about axis 1 and axis 2, in newton metres, to the first body, and the opposite to the second, for the
    /// next step. Does nothing in limbo.
    ///
    /// # Errors
    /// [`Error::OutOfRange`] if one is not finite.
    pub fn add_torques(&mut self, torque1: f64, torque2: f64) -> Result<(), Error> {
        finite_number("prismatic-universal torque 1", torque1)?;
        finite_number("prismatic-universal torque 2", torque2)?;
        let (pu, ends) = self.parts();
        let (torque1, torque2) = if ends.reverse { (-torque2, -torque1) } else { (torque1, torque2) };
        let torque = pu.axes.world1(&ends) * torque1 + pu.axes.world2(&ends) * torque2;
        self.add_wrenches([
            Wrench { force: Vec3::ZERO, torque },
            Wrench { force: Vec3::ZERO, torque: -torque },
        ]);
        Ok(())
    }
}
