//! Plane-2D: keeps a body's centre in the world plane z = 0 and its angular velocity along z.
//!
//! Rounding tilts the body over time, and the joint does not repair that: a program should set the rotation back to one
//! about z now and then (ODE manual, "Plane2D").

use super::limit_motor::{LimitMotor, RowAxis, limit_motors};
use super::{JointError, JointModel, JointMut, Param};
use crate::Error;
use crate::ends::{Ends, StepContext};
use crate::error::not_nan;
use crate::rows::{JointRows, RowCount};
use ferrode_math::Vec3;

/// The plane-2D joint's data: motors along x and y and about z. Their stops have no effect, as in ODE.
#[derive(Clone, Debug)]
pub struct Plane2D {
    x: LimitMotor,
    y: LimitMotor,
    angle: LimitMotor,
}

limit_motors!(Plane2D { 1 => x, 2 => y, 3 => angle });

impl Plane2D {
    pub(crate) fn new(erp: f64, cfm: f64) -> Self {
        let motor = LimitMotor::new(erp, cfm);
        Self { x: motor, y: motor, angle: motor }
    }

    fn motors(&self) -> [(&LimitMotor, RowAxis); 3] {
        [
            (&self.x, RowAxis::Linear(Vec3::X)),
            (&self.y, RowAxis::Linear(Vec3::Y)),
            (&self.angle, RowAxis::Angular(Vec3::Z)),
        ]
    }
}

impl JointModel for Plane2D {
    fn row_count(&mut self, _ends: &Ends<'_>, _ctx: &StepContext) -> RowCount {
        let motors: usize = self.motors().iter().map(|(motor, _)| motor.row_count()).sum();
        RowCount::new(3 + motors, 3)
    }

    fn write_rows(&mut self, ends: &Ends<'_>, ctx: &StepContext, out: &mut JointRows<'_>) {
        // These act on the first body alone, even if there is a second one.
        if let [height, spin_x, spin_y, ..] = out.rows {
            height.linear1 = Vec3::Z;
            height.correct(ctx.k(), -ends.a().position.z);
            spin_x.angular1 = Vec3::X;
            spin_x.slot = 1;
            spin_y.angular1 = Vec3::Y;
            spin_y.slot = 2;
        }
        let mut at = 3;
        for (slot, (motor, axis)) in (3..).zip(self.motors()) {
            motor.write_row(ends, ctx, axis, slot, out, &mut at);
        }
    }

    /// Groups 1, 2, 3 are x, y and the angle; ODE has separate functions for them.
    fn set_param(&mut self, n: i32, value: f64) {
        match n >> 8 {
            0 => self.x.set_param(n, value),
            1 => self.y.set_param(n & 0xff, value),
            2 => self.angle.set_param(n & 0xff, value),
            _ => {}
        }
    }

    fn param(&self, n: i32) -> f64 {
        match n >> 8 {
            0 => self.x.param(n),
            1 => self.y.param(n & 0xff),
            2 => self.angle.param(n & 0xff),
            _ => 0.0,
        }
    }

    fn error(&self, ends: &Ends<'_>) -> JointError {
        JointError { position: ends.a().position.z.abs(), angle: 0.0 }
    }
}

impl JointMut<'_, Plane2D> {
    /// Sets a parameter of the motor along x: as [`crate::World::set_joint_param`] with group 1.
    ///
    /// # Errors
    /// [`Error::OutOfRange`] for NaN.
    pub fn set_x_param(&mut self, param: Param, value: f64) -> Result<(), Error> {
        not_nan(param.name(), value)?;
        self.parts().0.x.set_param(param as i32, value);
        Ok(())
    }

    /// Sets a parameter of the motor along y: as [`crate::World::set_joint_param`] with group 2.
    ///
    /// # Errors
    /// [`Error::OutOfRange`] for NaN.
    pub fn set_y_param(&mut self, param: Param, value: f64) -> Result<(), Error> {
        not_nan(param.name(), value)?;
        self.parts().0.y.set_param(param as i32, value);
        Ok(())
    }

    /// Sets a parameter of the motor about z: as [`crate::World::set_joint_param`] with group 3.
    ///
    /// # Errors
    /// [`Error::OutOfRange`] for NaN.
    pub fn set_angle_param(&mut self, param: Param, value: f64) -> Result<(), Error> {
        not_nan(param.name(), value)?;
        self.parts().0.angle.set_param(param as i32, value);
        Ok(())
    }
}
