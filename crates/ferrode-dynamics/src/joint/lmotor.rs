//! Linear motor: drives the relative velocity of two bodies along up to three axes. It has no stops.

use super::axis::AxisFrame;
use super::limit_motor::{LimitMotor, LimitMotors, RowAxis};
use super::{JointModel, JointMut, JointRef};
use crate::Error;
use crate::ends::{Ends, StepContext};
use crate::error::unit;
use crate::rows::{JointRows, RowCount};
use ferrode_math::Vec3;

/// One axis of the motor.
#[derive(Clone, Copy, Debug)]
struct MotorAxis {
    frame: AxisFrame,
    /// In the frame's coordinates; zero until it is set.
    axis: Vec3,
    motor: LimitMotor,
}

/// The linear motor's data: its axes, each with a motor. Their stops have no effect, as in ODE.
#[derive(Clone, Debug)]
pub struct LMotor {
    count: usize,
    axes: [MotorAxis; 3],
}

impl LMotor {
    pub(crate) fn new(erp: f64, cfm: f64) -> Self {
        let motor = LimitMotor::new(erp, cfm);
        Self { count: 0, axes: [MotorAxis { frame: AxisFrame::World, axis: Vec3::ZERO, motor }; 3] }
    }

    /// The axes in use that are set, with their numbers. An axis that was never set would give a row of zeros.
    fn driven(&self) -> impl Iterator<Item = (u8, &MotorAxis)> {
        (0u8..).zip(&self.axes[..self.count]).filter(|(_, axis)| axis.axis != Vec3::ZERO)
    }
}

impl LimitMotors for LMotor {
    fn axis(&self, number: usize) -> Option<&LimitMotor> {
        Some(&self.axes.get(number.checked_sub(1)?)?.motor)
    }
    fn axis_mut(&mut self, number: usize) -> Option<&mut LimitMotor> {
        Some(&mut self.axes.get_mut(number.checked_sub(1)?)?.motor)
    }
}

impl JointModel for LMotor {
    fn details(&self) -> Vec<(&'static str, Vec<f64>)> {
        vec![
            ("num", vec![self.count as f64]),
            ("rel", self.axes.iter().map(|axis| f64::from(axis.frame as u8)).collect()),
            ("axis1", self.axes[0].axis.to_array().to_vec()),
            ("axis2", self.axes[1].axis.to_array().to_vec()),
            ("axis3", self.axes[2].axis.to_array().to_vec()),
        ]
    }

    fn row_count(&mut self, _ends: &Ends<'_>, _ctx: &StepContext) -> RowCount {
        RowCount::new(self.driven().map(|(_, axis)| axis.motor.row_count()).sum(), 0)
    }

    fn write_rows(&mut self, ends: &Ends<'_>, ctx: &StepContext, out: &mut JointRows<'_>) {
        let mut at = 0;
        for (slot, axis) in self.driven() {
            let direction = axis.frame.rotation(ends) * axis.axis;
            axis.motor.write_row(ends, ctx, RowAxis::Linear(direction), slot, out, &mut at);
        }
    }

    fn set_param(&mut self, n: i32, value: f64) {
        self.axes[super::param::axis_index(n)].motor.set_param(n & 0xff, value);
    }

    fn param(&self, n: i32) -> f64 {
        self.axes[super::param::axis_index(n)].motor.param(n & 0xff)
    }
}

impl JointRef<'_, LMotor> {
    /// How many axes are in use.
    pub fn axis_count(&self) -> usize {
        self.data.count
    }

    /// Axis 0, 1 or 2 (larger numbers mean 2) as it is kept: in the coordinates of what it is fixed to, **not** of the
    /// world, as in ODE. Zero until it is set.
    pub fn axis(&self, index: usize) -> Vec3 {
        self.data.axes[index.min(2)].axis
    }

    /// What axis 0, 1 or 2 (larger numbers mean 2) is fixed to.
    pub fn axis_frame(&self, index: usize) -> AxisFrame {
        self.data.axes[index.min(2)].frame
    }
}

impl JointMut<'_, LMotor> {
    /// Sets how many axes are in use; more than 3 mean 3.
    pub fn set_axis_count(&mut self, count: usize) {
        self.parts().0.count = count.min(3);
    }

    /// Sets axis 0, 1 or 2 (larger numbers mean 2) from a world vector of any length, and what it is fixed to: the world,
    /// or a body in the joint's own order, in which a single body is always the first.
    ///
    /// # Errors
    /// [`Error::NotFinite`], [`Error::ZeroVector`]; [`Error::NotAttached`] in limbo, unless it is fixed to the world.
    pub fn set_axis(&mut self, index: usize, frame: AxisFrame, axis: Vec3) -> Result<(), Error> {
        let what = "linear motor axis";
        let axis = unit(what, axis)?;
        let (motor, ends) = match frame {
            AxisFrame::World => self.parts(),
            _ => self.attached_parts(what)?,
        };
        let frame = if frame == AxisFrame::Second && !ends.two() { AxisFrame::First } else { frame };
        let slot = &mut motor.axes[index.min(2)];
        (slot.frame, slot.axis) = (frame, frame.rotation(&ends).transpose_mul(axis));
        Ok(())
    }
}
