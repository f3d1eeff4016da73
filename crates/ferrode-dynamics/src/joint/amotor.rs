//! Angular motor: stops and motors for the relative rotation of two bodies, about up to three axes.
//!
//! With axes and angles of the caller's own choice (user mode), or about the three axes of Euler angles that the joint
//! measures itself: axis 0 is fixed to the first body, axis 2 to the second, axis 1 is perpendicular to both.

use super::axis::AxisFrame;
use super::limit_motor::{LimitMotor, LimitMotors, RowAxis};
use super::{JointError, JointModel, JointMut, JointRef, LimitedAxis};
use crate::Error;
use crate::ends::{Ends, StepContext};
use crate::error::{finite_number, unit};
use crate::rows::{JointRows, RowCount, Wrench};
use ferrode_math::{Vec3, plane_space, real};

/// Who chooses the axes and measures the angles.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum AMotorMode {
    /// The caller does both.
    #[default]
    User,
    /// The joint measures Euler angles about an axis of each body. Set the mode, then axes 0 and 2, after attaching;
    /// they must be perpendicular. The angle about axis 1 must stay inside −π/2 … π/2.
    Euler,
}

/// One axis of the motor.
#[derive(Clone, Copy, Debug)]
struct MotorAxis {
    /// In the joint's own order of the bodies.
    frame: AxisFrame,
    /// In the frame's coordinates; zero until it is set.
    axis: Vec3,
    angle: f64,
    limit_motor: LimitMotor,
}

/// The angular motor's data: its mode, and its axes, each with an angle, stops and a motor.
#[derive(Clone, Debug)]
pub struct AMotor {
    mode: AMotorMode,
    count: usize,
    axes: [MotorAxis; 3],
    /// Directions from which Euler angles count, fixed to the bodies of axis 0 and of axis 2.
    reference: [Vec3; 2],
}

impl AMotor {
    pub(crate) fn new(erp: f64, cfm: f64) -> Self {
        let limit_motor = LimitMotor::new(erp, cfm);
        let axis = MotorAxis { frame: AxisFrame::World, axis: Vec3::ZERO, angle: 0.0, limit_motor };
        Self { mode: AMotorMode::User, count: 0, axes: [axis; 3], reference: [Vec3::ZERO; 2] }
    }

    /// The axes in the world. The second one of Euler's follows from the others; where these are parallel it has no
    /// direction of its own, and is taken anywhere across them. Zero where axes were not set.
    fn world_axes(&self, ends: &Ends<'_>) -> [Vec3; 3] {
        match self.mode {
            AMotorMode::User => self.axes.map(|axis| axis.frame.rotation(ends) * axis.axis),
            AMotorMode::Euler => {
                let [a, b] = euler_ends(ends);
                let g0 = a.rotation * self.axes[0].axis;
                let g2 = b.rotation * self.axes[2].axis;
                let across = || if g0 == Vec3::ZERO { Vec3::ZERO } else { plane_space(g0).0 };
                [g0, g2.cross(g0).normalized().unwrap_or_else(across), g2]
            }
        }
    }

    /// The axes that rows act about. Those of Euler angles are not unit vectors when axes 0 and 2 are not perpendicular.
    fn effective_axes(&self, ends: &Ends<'_>) -> [Vec3; 3] {
        let [g0, g1, g2] = self.world_axes(ends);
        match self.mode {
            AMotorMode::User => [g0, g1, g2],
            AMotorMode::Euler => [g1.cross(g2), g1, g0.cross(g1)],
        }
    }

    /// Takes the present relative rotation for Euler angles 0.
    fn record_reference(&mut self, ends: &Ends<'_>) {
        let [a, b] = euler_ends(ends);
        let (axis0, axis2) = (self.axes[0].axis, self.axes[2].axis);
        self.reference =
            [a.rotation.transpose_mul(b.rotation * axis2), b.rotation.transpose_mul(a.rotation * axis0)];
    }

    fn euler_angles(&self, ends: &Ends<'_>) -> [f64; 3] {
        let [a, b] = euler_ends(ends);
        let [g0, g1, g2] = self.world_axes(ends);
        let reference_a = a.rotation * self.reference[0];
        let reference_b = b.rotation * self.reference[1];
        [
            -real::atan2(g2.dot(g0.cross(reference_a)), g2.dot(reference_a)),
            -real::atan2(g2.dot(g0), g2.dot(g0.cross(g1))),
            -real::atan2(reference_b.dot(g1), reference_b.dot(g1.cross(g2))),
        ]
    }

    /// Whether axis `i` has a row: an axis that was never set would give a row of zeros.
    fn has_row(&self, i: usize, axes: &[Vec3; 3]) -> bool {
        i < self.count && axes[i] != Vec3::ZERO && self.axes[i].limit_motor.is_active()
    }
}

/// The bodies of Euler axes 0 and 2: the caller's first and second.
fn euler_ends<'a>(ends: &Ends<'a>) -> [&'a crate::ends::Frame; 2] {
    if ends.reverse { [ends.b(), ends.a()] } else { [ends.a(), ends.b()] }
}

impl LimitMotors for AMotor {
    fn axis(&self, number: usize) -> Option<&LimitMotor> {
        Some(&self.axes.get(number.checked_sub(1)?)?.limit_motor)
    }
    fn axis_mut(&mut self, number: usize) -> Option<&mut LimitMotor> {
        Some(&mut self.axes.get_mut(number.checked_sub(1)?)?.limit_motor)
    }
}

impl JointModel for AMotor {
    fn details(&self) -> Vec<(&'static str, Vec<f64>)> {
        vec![
            ("num", vec![self.count as f64]),
            ("mode", vec![f64::from(u8::from(self.mode == AMotorMode::Euler))]),
            ("rel", self.axes.iter().map(|axis| f64::from(axis.frame as u8)).collect()),
            ("axis1", self.axes[0].axis.to_array().to_vec()),
            ("axis2", self.axes[1].axis.to_array().to_vec()),
            ("axis3", self.axes[2].axis.to_array().to_vec()),
            ("angle1", vec![self.axes[0].angle]),
            ("angle2", vec![self.axes[1].angle]),
            ("angle3", vec![self.axes[2].angle]),
        ]
    }

    fn row_count(&mut self, ends: &Ends<'_>, _ctx: &StepContext) -> RowCount {
        if self.mode == AMotorMode::Euler {
            let angles = self.euler_angles(ends);
            for (axis, angle) in self.axes.iter_mut().zip(angles) {
                axis.angle = angle;
            }
        }
        for (i, axis) in self.axes.iter_mut().enumerate() {
            axis.limit_motor.test((i < self.count).then_some(axis.angle));
        }
        let axes = self.effective_axes(ends);
        RowCount::new((0..3).filter(|i| self.has_row(*i, &axes)).count(), 0)
    }

    fn write_rows(&mut self, ends: &Ends<'_>, ctx: &StepContext, out: &mut JointRows<'_>) {
        let axes = self.effective_axes(ends);
        let mut at = 0;
        for i in (0..3).filter(|i| self.has_row(*i, &axes)) {
            self.axes[i].limit_motor.write_row(ends, ctx, RowAxis::Angular(axes[i]), i as u8, out, &mut at);
        }
    }

    fn limited_axes(&self, ends: &Ends<'_>) -> Vec<LimitedAxis> {
        let axes = self.effective_axes(ends);
        let [g0, g1, g2] = self.world_axes(ends);
        let angles = match self.mode {
            AMotorMode::Euler => self.euler_angles(ends),
            AMotorMode::User => self.axes.each_ref().map(|axis| axis.angle),
        };
        // Across the axis that is fixed in the joint's first body, the one along with that; the others along with the cross.
        let own = if ends.reverse { 2 } else { 0 };
        let first = ends.a().rotation * plane_space(ends.a().rotation.transpose_mul(axes[own])).0;
        let hands = if ends.reverse { [g1, g2, first] } else { [first, g0, g1] };
        let sign = if self.mode == AMotorMode::Euler { ends.sign() } else { 1.0 };
        let there = (0..self.count.min(3)).filter(|i| axes[*i] != Vec3::ZERO);
        there
            .map(|i| {
                LimitedAxis::turning(i + 1, axes[i] * sign, hands[i], angles[i], &self.axes[i].limit_motor)
            })
            .collect()
    }

    fn set_param(&mut self, n: i32, value: f64) {
        self.axes[super::param::axis_index(n)].limit_motor.set_param(n & 0xff, value);
    }

    fn param(&self, n: i32) -> f64 {
        self.axes[super::param::axis_index(n)].limit_motor.param(n & 0xff)
    }

    /// How far an angle is beyond its stop, as of the latest step's start.
    fn error(&self, _ends: &Ends<'_>) -> JointError {
        let excess = self.axes.iter().map(|axis| axis.limit_motor.excess().abs());
        JointError { position: 0.0, angle: excess.fold(0.0, f64::max) }
    }
}

impl JointRef<'_, AMotor> {
    /// Who chooses the axes and measures the angles.
    pub fn mode(&self) -> AMotorMode {
        self.data.mode
    }

    /// How many axes are in use.
    pub fn axis_count(&self) -> usize {
        self.data.count
    }

    /// Axis 0, 1 or 2 (larger numbers mean 2), in world coordinates; zero until it is set. In Euler mode it is the axis
    /// that stops and motor act about, which need not be a unit vector.
    pub fn axis(&self, index: usize) -> Vec3 {
        self.data.effective_axes(&self.ends())[index.min(2)]
    }

    /// What axis 0, 1 or 2 (larger numbers mean 2) is fixed to, in the caller's order of the bodies.
    pub fn axis_frame(&self, index: usize) -> AxisFrame {
        let frame = self.data.axes[index.min(2)].frame;
        if self.ends().reverse { frame.exchanged() } else { frame }
    }

    /// The angle about axis 0, 1 or 2 (larger numbers mean 2), in radians. In user mode what the caller set; in Euler
    /// mode as of the latest step's start, and 0 before the first step.
    pub fn angle(&self, index: usize) -> f64 {
        self.data.axes[index.min(2)].angle
    }

    /// The relative angular velocity along [`Self::axis`], in rad/s.
    pub fn angle_rate(&self, index: usize) -> f64 {
        let ends = self.ends();
        ends.sign() * self.axis(index).dot(ends.a().angular_velocity - ends.b().angular_velocity)
    }
}

impl JointMut<'_, AMotor> {
    /// Sets the mode. Euler mode has three axes, and takes the present relative rotation for angles 0; back in user mode
    /// there are still three.
    pub fn set_mode(&mut self, mode: AMotorMode) {
        let (motor, ends) = self.parts();
        motor.mode = mode;
        if mode == AMotorMode::Euler {
            motor.count = 3;
            motor.record_reference(&ends);
        }
    }

    /// Sets how many axes are in use; more than 3 mean 3. Euler mode always has 3.
    pub fn set_axis_count(&mut self, count: usize) {
        let motor = self.parts().0;
        motor.count = if motor.mode == AMotorMode::Euler { 3 } else { count.min(3) };
    }

    /// Sets axis 0, 1 or 2 (larger numbers mean 2) from a world vector of any length, and what it is fixed to, in the
    /// caller's order of the bodies.
    ///
    /// In Euler mode axis 0 must be fixed to the first body and axis 2 to the second, and the present relative rotation
    /// counts as angles 0. An axis given there for the world is taken for one in that body's coordinates, as in ODE.
    ///
    /// # Errors
    /// [`Error::NotFinite`], [`Error::ZeroVector`]; [`Error::NotAttached`] if it is fixed to the body of a joint in limbo;
    /// [`Error::WrongMode`] for a Euler axis fixed to the other body.
    pub fn set_axis(&mut self, index: usize, frame: AxisFrame, axis: Vec3) -> Result<(), Error> {
        let what = "angular motor axis";
        let axis = unit(what, axis)?;
        let index = index.min(2);
        let (motor, ends) = self.parts();
        if motor.mode == AMotorMode::Euler
            && matches!((index, frame), (0, AxisFrame::Second) | (2, AxisFrame::First))
        {
            return Err(Error::WrongMode {
                what: "in Euler mode axis 0 is fixed to the first body, and axis 2 to the second",
            });
        }
        let frame = if ends.reverse { frame.exchanged() } else { frame };
        let (motor, ends) = match frame {
            AxisFrame::First => self.attached_parts(what)?,
            _ => self.parts(),
        };
        motor.axes[index].frame = frame;
        motor.axes[index].axis = frame.rotation(&ends).transpose_mul(axis);
        if motor.mode == AMotorMode::Euler {
            motor.record_reference(&ends);
        }
        Ok(())
    }

    /// Says what the angle about axis 0, 1 or 2 (larger numbers mean 2) is, in radians, for the stops to be tested
    /// against.
    ///
    /// # Errors
    /// [`Error::OutOfRange`] if it is not finite; [`Error::WrongMode`] in Euler mode, which measures angles itself.
    pub fn set_angle(&mut self, index: usize, angle: f64) -> Result<(), Error> {
        finite_number("angular motor angle", angle)?;
        let motor = self.parts().0;
        if motor.mode == AMotorMode::Euler {
            return Err(Error::WrongMode { what: "an angular motor's angles are set in user mode only" });
        }
        motor.axes[index.min(2)].angle = angle;
        Ok(())
    }

    /// Adds torques about the axes in use, in newton metres, to the first body, and the opposite to the second, for the
    /// next step. In Euler mode they act about axis 0, axis 1 and axis 2 themselves, not about the effective axes. Does
    /// nothing in limbo.
    ///
    /// # Errors
    /// [`Error::OutOfRange`] if one is not finite.
    pub fn add_torques(&mut self, torque1: f64, torque2: f64, torque3: f64) -> Result<(), Error> {
        let torques = [torque1, torque2, torque3];
        for torque in torques {
            finite_number("angular motor torque", torque)?;
        }
        let (motor, ends) = self.parts();
        let axes = motor.world_axes(&ends);
        let mut torque = Vec3::ZERO;
        for i in 0..motor.count {
            torque += axes[i] * torques[i];
        }
        let torque = torque * ends.sign();
        self.add_wrenches([
            Wrench { force: Vec3::ZERO, torque },
            Wrench { force: Vec3::ZERO, torque: -torque },
        ]);
        Ok(())
    }
}
