//! The slider: lets the bodies move along one axis, fixed in the first, and keeps all else.

use super::axis::set_axes;
use super::limit_motor::{LimitMotor, RowAxis, limit_motors, midpoint_torque};
use super::{JointError, JointModel, JointMut, JointRef, LimitedAxis, orientation};
use crate::Error;
use crate::ends::{Ends, StepContext};
use crate::error::{finite, finite_number};
use crate::rows::{JointRows, RowCount, Wrench};
use ferrode_math::{Quat, Vec3, plane_space};

/// The slider's data: axis, the place and rotation that count as position 0, and the stops and motor.
#[derive(Clone, Debug)]
pub struct Slider {
    /// In the first body's coordinates.
    axis: Vec3,
    /// The first body's centre at position 0, in the second body's coordinates.
    offset: Vec3,
    /// conj(q₁) q₂ that is kept.
    initial: Quat,
    limit_motor: LimitMotor,
}

limit_motors!(Slider => limit_motor);

impl Slider {
    pub(crate) fn new(erp: f64, cfm: f64) -> Self {
        Self {
            axis: Vec3::X,
            offset: Vec3::ZERO,
            initial: Quat::IDENTITY,
            limit_motor: LimitMotor::new(erp, cfm),
        }
    }

    /// The axis in the world.
    fn axis(&self, ends: &Ends<'_>) -> Vec3 {
        ends.a().rotation * self.axis
    }

    /// From the first body's centre to where it stands at position 0.
    fn way_back(&self, ends: &Ends<'_>) -> Vec3 {
        ends.b().to_world_point(self.offset) - ends.a().position
    }

    fn position(&self, ends: &Ends<'_>) -> f64 {
        ends.sign() * -self.axis(ends).dot(self.way_back(ends))
    }

    fn reset(&mut self, ends: &Ends<'_>) {
        self.offset = ends.b().to_local_point(ends.a().position);
        self.initial = ends.relative_rotation();
    }
}

impl JointModel for Slider {
    fn details(&self) -> Vec<(&'static str, Vec<f64>)> {
        vec![
            ("axis1", self.axis.to_array().to_vec()),
            ("qrel", crate::foreign::numbers(self.initial)),
            ("offset", self.offset.to_array().to_vec()),
        ]
    }

    fn row_count(&mut self, ends: &Ends<'_>, _ctx: &StepContext) -> RowCount {
        let position = self.limit_motor.has_linear_stops().then(|| self.position(ends));
        self.limit_motor.test(position);
        RowCount::new(5 + self.limit_motor.row_count(), 5)
    }

    fn write_rows(&mut self, ends: &Ends<'_>, ctx: &StepContext, out: &mut JointRows<'_>) {
        orientation::write_rows(ends, ctx, self.initial, &mut out.rows[..3], 0);
        let a = self.axis(ends);
        let error = self.way_back(ends);
        let (p, q) = plane_space(a);
        for ((row, u), slot) in out.rows[3..5].iter_mut().zip([p, q]).zip(3..) {
            row.linear1 = u;
            if ends.two() {
                let t = midpoint_torque(ends, u);
                row.set_jacobian(u, t, -u, t);
            }
            row.correct(ctx.k(), u.dot(error));
            row.slot = slot;
        }
        let axis = RowAxis::Linear(a * ends.sign());
        self.limit_motor.write_row(ends, ctx, axis, 5, out, &mut 5);
    }

    fn attached(&mut self, ends: &Ends<'_>) {
        self.reset(ends);
    }

    fn limited_axes(&self, ends: &Ends<'_>) -> Vec<LimitedAxis> {
        let axis = self.axis(ends) * ends.sign();
        vec![LimitedAxis::sliding(1, axis, self.position(ends), &self.limit_motor)]
    }

    fn set_param(&mut self, n: i32, value: f64) {
        self.limit_motor.set_param(n, value);
    }

    fn param(&self, n: i32) -> f64 {
        self.limit_motor.param(n)
    }

    fn error(&self, ends: &Ends<'_>) -> JointError {
        let (a, d) = (self.axis(ends), self.way_back(ends));
        JointError { position: (d - a * a.dot(d)).length(), angle: orientation::angle(ends, self.initial) }
    }
}

impl JointRef<'_, Slider> {
    /// The axis in world coordinates, of unit length.
    pub fn axis(&self) -> Vec3 {
        self.data.axis(&self.ends())
    }

    /// The position in metres: positive when the first body has moved along the axis, away from the second.
    ///
    /// # Errors
    /// [`Error::NotAttached`].
    pub fn position(&self) -> Result<f64, Error> {
        self.require_attached("slider position")?;
        Ok(self.data.position(&self.ends()))
    }

    /// The rate of the position in m/s, from the velocities of the centres.
    ///
    /// # Errors
    /// [`Error::NotAttached`].
    pub fn position_rate(&self) -> Result<f64, Error> {
        self.require_attached("slider position rate")?;
        let ends = self.ends();
        let v = ends.a().linear_velocity - ends.b().linear_velocity;
        Ok(ends.sign() * self.data.axis(&ends).dot(v))
    }
}

impl JointMut<'_, Slider> {
    /// Sets the axis, in world coordinates and of any length, and makes the present position 0. Does nothing in limbo,
    /// as ODE.
    ///
    /// # Errors
    /// [`Error::NotFinite`], [`Error::ZeroVector`].
    pub fn set_axis(&mut self, axis: Vec3) -> Result<(), Error> {
        self.set_axis_delta(axis, Vec3::ZERO)
    }

    /// As [`Self::set_axis`], but of a joint with one body the place of position 0 is moved by `delta`, in world
    /// coordinates: also across the axis, which the joint then corrects. With two bodies `delta` is ignored.
    ///
    /// # Errors
    /// [`Error::NotFinite`], [`Error::ZeroVector`].
    pub fn set_axis_delta(&mut self, axis: Vec3, delta: Vec3) -> Result<(), Error> {
        finite("slider axis delta", delta)?;
        let (slider, ends) = self.parts();
        let axes = set_axes(&ends, "slider axis", axis)?;
        if ends.first.is_some() {
            slider.axis = axes[0];
            slider.reset(&ends);
            if !ends.two() {
                slider.offset += delta;
            }
        }
        Ok(())
    }

    /// Adds a force along the axis, in newtons, to the first body, and the opposite to the second, for the next step. The
    /// pair acts through the midpoint of the centres. Does nothing in limbo.
    ///
    /// # Errors
    /// [`Error::OutOfRange`] if it is not finite.
    pub fn add_force(&mut self, force: f64) -> Result<(), Error> {
        finite_number("slider force", force)?;
        let (slider, ends) = self.parts();
        let force = slider.axis(&ends) * (ends.sign() * force);
        let torque = if ends.two() { midpoint_torque(&ends, force) } else { Vec3::ZERO };
        self.add_wrenches([Wrench { force, torque }, Wrench { force: -force, torque }]);
        Ok(())
    }
}
