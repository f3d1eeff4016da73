//! Limits and motors: the row that a joint adds along or about an axis of its freedom.
//!
//! ```text
//!                 LoStop                            HiStop
//!   … no entry …    |----------- free travel ---------|    … no entry …       position or angle x →
//!      stop row:    λ ≥ 0       motor row: |λ| ≤ FMax      λ ≤ 0
//! ```
//!
//! There is one row for both: inside the range it is the motor's, at a stop it is the stop's, and the motor acts as a
//! plain force beside it (ODE manual, "Stop and motor parameters").

use super::{JointData, JointMut, JointRef, Param};
use crate::carried::{Drive, is_spring};
use crate::ends::{Ends, StepContext};
use crate::error::not_nan;
use crate::rows::{JointRows, Row, RowKind};
use crate::{Error, Softness};
use core::f64::consts::PI;
use ferrode_math::Vec3;

/// Where an axis stands in its range.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum LimitState {
    /// Between its stops, or without stops that count.
    #[default]
    Free,
    /// At or below its low stop.
    AtLow,
    /// At or above its high stop.
    AtHigh,
}

/// Stops and motor of one axis of a joint. Radians, rad/s and N m for an angular axis; metres, m/s and N for a linear
/// one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LimitMotor {
    low: f64,
    high: f64,
    velocity: f64,
    max_force: f64,
    fudge: f64,
    bounce: f64,
    cfm: f64,
    stop_erp: f64,
    stop_cfm: f64,
    /// As of the latest step.
    state: LimitState,
    /// How far beyond the stop: ≤ 0 at the low one, ≥ 0 at the high one.
    excess: f64,
}

/// What a limit and motor row acts along or about: a unit axis in the world, and the form of the Jacobian.
#[derive(Clone, Copy, Debug)]
pub(crate) enum RowAxis {
    /// Relative angular velocity about the axis.
    Angular(Vec3),
    /// Relative velocity of the centres along the axis. The force acts on the line through the midpoint of the centres,
    /// so that it makes no net couple.
    Linear(Vec3),
    /// Relative velocity along the axis of two points, given by their arms from the centres of mass, in the world.
    TwoPoint { axis: Vec3, arm1: Vec3, arm2: Vec3 },
}

impl LimitMotor {
    /// No stops, no motor; softness as the world's when the joint is created.
    pub(crate) fn new(erp: f64, cfm: f64) -> Self {
        Self {
            low: f64::NEG_INFINITY,
            high: f64::INFINITY,
            velocity: 0.0,
            max_force: 0.0,
            fudge: 1.0,
            bounce: 0.0,
            cfm,
            stop_erp: erp,
            stop_cfm: cfm,
            state: LimitState::Free,
            excess: 0.0,
        }
    }

    /// The stops, low and high; infinite for none.
    pub fn limits(&self) -> (f64, f64) {
        (self.low, self.high)
    }

    /// Sets the stops; −∞ and ∞ for none. Equal ones lock the axis, a low stop above the high one means no stops. An
    /// angle is measured within −π … π, so stops work well inside that range only.
    ///
    /// # Errors
    /// [`Error::OutOfRange`] for NaN.
    pub fn set_limits(&mut self, low: f64, high: f64) -> Result<(), Error> {
        not_nan("low stop", low)?;
        not_nan("high stop", high)?;
        (self.low, self.high) = (low, high);
        Ok(())
    }

    /// The motor's wanted velocity.
    pub fn motor_velocity(&self) -> f64 {
        self.velocity
    }

    /// The largest force or torque of the motor; 0 for no motor.
    pub fn max_force(&self) -> f64 {
        self.max_force
    }

    /// Has a motor drive the axis at a velocity, of the first body relative to the second, with at most the given force
    /// or torque; 0 switches it off.
    ///
    /// # Errors
    /// [`Error::OutOfRange`] for a velocity that is not finite, or a force that is NaN or negative.
    pub fn set_motor(&mut self, velocity: f64, max_force: f64) -> Result<(), Error> {
        crate::error::finite_number("motor velocity", velocity)?;
        at_least_zero("motor force", max_force)?;
        (self.velocity, self.max_force) = (velocity, max_force);
        Ok(())
    }

    /// The part of the motor's force that acts when it drives away from a stop.
    pub fn fudge_factor(&self) -> f64 {
        self.fudge
    }

    /// Sets the part of the motor's force that acts when it drives away from a stop: less than 1 if the axis jumps there.
    ///
    /// # Errors
    /// [`Error::OutOfRange`] outside 0 … 1.
    pub fn set_fudge_factor(&mut self, fudge: f64) -> Result<(), Error> {
        if !(0.0..=1.0).contains(&fudge) {
            return Err(Error::OutOfRange {
                what: "fudge factor",
                value: fudge,
                expected: "a number from 0 to 1",
            });
        }
        self.fudge = fudge;
        Ok(())
    }

    /// Restitution at the stops.
    pub fn bounce(&self) -> f64 {
        self.bounce
    }

    /// Sets the restitution at the stops: 0 for none, 1 for all of the speed.
    ///
    /// # Errors
    /// [`Error::OutOfRange`] if it is not finite.
    pub fn set_bounce(&mut self, bounce: f64) -> Result<(), Error> {
        self.bounce = crate::error::finite_number("bounce", bounce)?;
        Ok(())
    }

    /// Constraint force mixing of the motor.
    pub fn motor_cfm(&self) -> f64 {
        self.cfm
    }

    /// Sets the constraint force mixing of the motor.
    ///
    /// # Errors
    /// [`Error::OutOfRange`] if it is not finite.
    pub fn set_motor_cfm(&mut self, cfm: f64) -> Result<(), Error> {
        self.cfm = crate::error::finite_number("motor CFM", cfm)?;
        Ok(())
    }

    /// Softness of the stops.
    pub fn stop_softness(&self) -> Softness {
        Softness { erp: self.stop_erp, cfm: self.stop_cfm }
    }

    /// Sets the softness of the stops, e.g. [`Softness::from_spring`].
    ///
    /// # Errors
    /// [`Error::OutOfRange`] if a number is not finite.
    pub fn set_stop_softness(&mut self, softness: Softness) -> Result<(), Error> {
        crate::error::finite_number("stop ERP", softness.erp)?;
        crate::error::finite_number("stop CFM", softness.cfm)?;
        (self.stop_erp, self.stop_cfm) = (softness.erp, softness.cfm);
        Ok(())
    }

    /// Where the axis stood in its range at the start of the latest step.
    pub fn state(&self) -> LimitState {
        self.state
    }

    /// What acts about or along the axis at a place, or at any without stops that count, as far as a solver can carry it along: not a
    /// motor with stops, nor stops that bounce, lock or are springs.
    pub(crate) fn carried(&self, place: Option<f64>, ctx: &StepContext) -> Option<Drive> {
        let stops = (self.low.is_finite() || self.high.is_finite()).then_some(place).flatten();
        let Some(x) = stops else {
            let motor = Drive::Motor { velocity: self.velocity, force: self.max_force, cfm: self.cfm };
            return Some(if self.max_force > 0.0 { motor } else { Drive::Free });
        };
        if self.max_force > 0.0 || self.bounce > 0.0 || self.low == self.high || is_spring(self.stop_cfm, ctx)
        {
            return None;
        }
        let room = |stop: f64, room: f64| if stop.is_finite() { room } else { f64::INFINITY };
        let (below, above) = (room(self.low, x - self.low), room(self.high, self.high - x));
        Some(Drive::Stop { room: below.min(above), upper: above < below, cfm: self.stop_cfm })
    }

    /// How far the axis was beyond its stop at the start of the latest step: negative below the low one, positive above
    /// the high one, 0 between.
    pub fn excess(&self) -> f64 {
        self.excess
    }

    /// Sets the parameter of ODE's number within its group. Numbers that are no limit's or motor's, negative `FMax` and
    /// fudge factors outside 0 … 1 are ignored, as ODE does.
    pub(crate) fn set_param(&mut self, n: i32, value: f64) {
        match Param::from_number(n) {
            Some(Param::LoStop) => self.low = value,
            Some(Param::HiStop) => self.high = value,
            Some(Param::Vel) => self.velocity = value,
            Some(Param::FMax) if value >= 0.0 => self.max_force = value,
            Some(Param::FudgeFactor) if (0.0..=1.0).contains(&value) => self.fudge = value,
            Some(Param::Bounce) => self.bounce = value,
            Some(Param::Cfm) => self.cfm = value,
            Some(Param::StopErp) => self.stop_erp = value,
            Some(Param::StopCfm) => self.stop_cfm = value,
            _ => {}
        }
    }

    /// The parameter of ODE's number within its group; 0 for numbers that are no limit's or motor's.
    pub(crate) fn param(&self, n: i32) -> f64 {
        match Param::from_number(n) {
            Some(Param::LoStop) => self.low,
            Some(Param::HiStop) => self.high,
            Some(Param::Vel) => self.velocity,
            Some(Param::FMax) => self.max_force,
            Some(Param::FudgeFactor) => self.fudge,
            Some(Param::Bounce) => self.bounce,
            Some(Param::Cfm) => self.cfm,
            Some(Param::StopErp) => self.stop_erp,
            Some(Param::StopCfm) => self.stop_cfm,
            _ => 0.0,
        }
    }

    /// Tests a value against the stops, whatever these are; `None` for stops that don't count. An infinite stop is none
    /// (ODE would take one on the wrong side for an infinite error).
    pub(crate) fn test(&mut self, x: Option<f64>) {
        (self.state, self.excess) = match x {
            Some(x) if x <= self.low && self.low.is_finite() => (LimitState::AtLow, x - self.low),
            Some(x) if x >= self.high && self.high.is_finite() => (LimitState::AtHigh, x - self.high),
            _ => (LimitState::Free, 0.0),
        };
    }

    /// Whether stops of an angle count: one within −π … π, and both in order.
    pub(crate) fn has_angular_stops(&self) -> bool {
        (self.low >= -PI || self.high <= PI) && self.low <= self.high
    }

    /// Whether stops of a position count: one finite, and both in order.
    pub(crate) fn has_linear_stops(&self) -> bool {
        (self.low > f64::NEG_INFINITY || self.high < f64::INFINITY) && self.low <= self.high
    }

    /// Whether the axis has a row in this step.
    pub(crate) fn is_active(&self) -> bool {
        self.max_force > 0.0 || self.state != LimitState::Free
    }

    /// [`Self::is_active`] as a number of rows.
    pub(crate) fn row_count(&self) -> usize {
        usize::from(self.is_active())
    }

    /// Whether a motor of this velocity drives away from the stop that the axis is at.
    fn drives_away(&self) -> bool {
        match self.state {
            LimitState::Free => false,
            LimitState::AtLow => self.velocity > 0.0,
            LimitState::AtHigh => self.velocity < 0.0,
        }
    }

    /// If the axis has a row in this step, fills `out.rows[*at]` and advances `at`. `slot` is the row's stable number
    /// within the joint.
    ///
    /// A motor at a stop adds its force to `out.forces` instead. An unlimited one would make that infinite: driving away
    /// from the stop it stays a motor row, and towards the stop it adds nothing.
    pub(crate) fn write_row(
        &self,
        ends: &Ends<'_>,
        ctx: &StepContext,
        axis: RowAxis,
        slot: u8,
        out: &mut JointRows<'_>,
        at: &mut usize,
    ) {
        if !self.is_active() {
            return;
        }
        let Some(row) = out.rows.get_mut(*at) else { return };
        *at += 1;
        row.slot = slot;
        axis.write_jacobian(ends, row);

        let at_stop = self.state != LimitState::Free;
        let locked = at_stop && self.low == self.high;
        let unlimited = self.max_force == f64::INFINITY;
        if !at_stop || (unlimited && !locked && self.drives_away()) {
            self.write_motor(row);
            return;
        }
        self.write_stop(ctx, row);
        if locked {
            return;
        }
        if self.bounce > 0.0 {
            self.write_bounce(axis.speed(ends, row), row);
        }
        if self.max_force > 0.0 && !unlimited {
            let force = self.force_at_stop();
            out.forces[0].force += row.linear1 * force;
            out.forces[0].torque += row.angular1 * force;
            out.forces[1].force += row.linear2 * force;
            out.forces[1].torque += row.angular2 * force;
        }
    }

    fn write_motor(&self, row: &mut Row) {
        row.kind = RowKind::Motor;
        row.c = self.velocity;
        row.velocity_target = self.velocity;
        row.cfm = self.cfm;
        (row.lo, row.hi) = (-self.max_force, self.max_force);
    }

    /// One-sided, unless the stops are equal.
    fn write_stop(&self, ctx: &StepContext, row: &mut Row) {
        row.kind = RowKind::Limit;
        row.correct(ctx.fps * self.stop_erp, -self.excess);
        row.cfm = self.stop_cfm;
        if self.low != self.high {
            match self.state {
                LimitState::AtLow => row.lo = 0.0,
                _ => row.hi = 0.0,
            }
        }
    }

    /// Asks for the speed away from the stop that returns the part `bounce` of the speed `u`, if that is towards it.
    fn write_bounce(&self, u: f64, row: &mut Row) {
        let back = -self.bounce * u;
        match self.state {
            LimitState::AtLow if u < 0.0 => row.c = row.c.max(back),
            LimitState::AtHigh if u > 0.0 => row.c = row.c.min(back),
            _ => return,
        }
        row.restitution_target = back;
    }

    /// The motor's force along the axis at a stop: all its might in its direction of motion, or towards the stop if its
    /// velocity is 0. The fudge factor scales it when it drives away.
    fn force_at_stop(&self) -> f64 {
        let forward = self.velocity > 0.0 || (self.velocity == 0.0 && self.state == LimitState::AtHigh);
        let force = if forward { self.max_force } else { -self.max_force };
        if self.drives_away() { self.fudge * force } else { force }
    }
}

impl RowAxis {
    fn write_jacobian(self, ends: &Ends<'_>, row: &mut Row) {
        match self {
            Self::Angular(a) => row.set_angular(a, ends.two()),
            Self::Linear(a) => {
                row.linear1 = a;
                if ends.two() {
                    let t = midpoint_torque(ends, a);
                    row.set_jacobian(a, t, -a, t);
                }
            }
            Self::TwoPoint { axis, arm1, arm2 } => {
                row.linear1 = axis;
                row.angular1 = arm1.cross(axis);
                if ends.two() {
                    row.linear2 = -axis;
                    row.angular2 = -arm2.cross(axis);
                }
            }
        }
    }

    /// The relative speed that a stop bounces. For a linear axis it is that of the centres alone, as in ODE.
    fn speed(self, ends: &Ends<'_>, row: &Row) -> f64 {
        let (b1, b2) = (ends.a(), ends.b());
        match self {
            Self::Angular(a) => a.dot(b1.angular_velocity - b2.angular_velocity),
            Self::Linear(a) => a.dot(b1.linear_velocity - b2.linear_velocity),
            Self::TwoPoint { .. } => {
                row.linear1.dot(b1.linear_velocity)
                    + row.angular1.dot(b1.angular_velocity)
                    + row.linear2.dot(b2.linear_velocity)
                    + row.angular2.dot(b2.angular_velocity)
            }
        }
    }
}

/// The torque on each of two bodies that goes with a unit force along `a` on the first and −`a` on the second, so that
/// the force acts through the midpoint of the centres of mass.
pub(crate) fn midpoint_torque(ends: &Ends<'_>, a: Vec3) -> Vec3 {
    ((ends.b().position - ends.a().position) * 0.5).cross(a)
}

fn at_least_zero(what: &'static str, value: f64) -> Result<f64, Error> {
    if value >= 0.0 {
        Ok(value)
    } else {
        Err(Error::OutOfRange { what, value, expected: "a number of at least 0" })
    }
}

/// Joint types with limits and motors: on one, two or three axes, numbered from 1 like the groups of parameters.
pub trait LimitMotors: JointData {
    #[doc(hidden)]
    fn axis(&self, number: usize) -> Option<&LimitMotor>;
    #[doc(hidden)]
    fn axis_mut(&mut self, number: usize) -> Option<&mut LimitMotor>;
}

/// Joint types with limits and a motor on a single axis.
pub trait OneLimitMotor: LimitMotors {
    #[doc(hidden)]
    fn only_axis(&self) -> &LimitMotor;
    #[doc(hidden)]
    fn only_axis_mut(&mut self) -> &mut LimitMotor;
}

/// Says in which fields a joint type keeps the limits and motors of its axes 1, 2, 3: `limit_motors!(PR { 1 =>
/// prismatic, 2 => rotoide })`, or `limit_motors!(Hinge => limit_motor)` for a single axis.
macro_rules! limit_motors {
    ($joint:ident => $field:ident) => {
        $crate::joint::limit_motor::limit_motors!($joint { 1 => $field });
        impl $crate::joint::limit_motor::OneLimitMotor for $joint {
            fn only_axis(&self) -> &$crate::joint::limit_motor::LimitMotor {
                &self.$field
            }
            fn only_axis_mut(&mut self) -> &mut $crate::joint::limit_motor::LimitMotor {
                &mut self.$field
            }
        }
    };
    ($joint:ident { $($number:literal => $field:ident),+ $(,)? }) => {
        impl $crate::joint::limit_motor::LimitMotors for $joint {
            fn axis(&self, number: usize) -> Option<&$crate::joint::limit_motor::LimitMotor> {
                match number { $($number => Some(&self.$field),)+ _ => None }
            }
            fn axis_mut(&mut self, number: usize) -> Option<&mut $crate::joint::limit_motor::LimitMotor> {
                match number { $($number => Some(&mut self.$field),)+ _ => None }
            }
        }
    };
}
pub(crate) use limit_motors;

fn no_axis(number: usize) -> Error {
    Error::OutOfRange {
        what: "number of the axis",
        value: number as f64,
        expected: "1, or 2 or 3 if the joint has as many axes with limits and motors",
    }
}

impl<'w, J: LimitMotors> JointRef<'w, J> {
    /// Stops and motor of axis 1, 2 or 3: the axis of that group of parameters.
    ///
    /// # Errors
    /// [`Error::OutOfRange`] if the joint has no such axis.
    pub fn limit_motor_of(&self, axis: usize) -> Result<&'w LimitMotor, Error> {
        self.data.axis(axis).ok_or_else(|| no_axis(axis))
    }
}

impl<J: LimitMotors> JointMut<'_, J> {
    /// Stops and motor of axis 1, 2 or 3, to change.
    ///
    /// # Errors
    /// [`Error::OutOfRange`] if the joint has no such axis.
    pub fn limit_motor_of_mut(&mut self, axis: usize) -> Result<&mut LimitMotor, Error> {
        self.parts().0.axis_mut(axis).ok_or_else(|| no_axis(axis))
    }

    /// Sets the stops of axis 1, 2 or 3; see [`LimitMotor::set_limits`].
    ///
    /// # Errors
    /// [`Error::OutOfRange`] for NaN, or if the joint has no such axis.
    pub fn set_limits_of(&mut self, axis: usize, low: f64, high: f64) -> Result<&mut Self, Error> {
        self.limit_motor_of_mut(axis)?.set_limits(low, high)?;
        Ok(self)
    }

    /// Sets the motor of axis 1, 2 or 3; see [`LimitMotor::set_motor`].
    ///
    /// # Errors
    /// As [`LimitMotor::set_motor`]; [`Error::OutOfRange`] if the joint has no such axis.
    pub fn set_motor_of(&mut self, axis: usize, velocity: f64, max_force: f64) -> Result<&mut Self, Error> {
        self.limit_motor_of_mut(axis)?.set_motor(velocity, max_force)?;
        Ok(self)
    }
}

impl<'w, J: OneLimitMotor> JointRef<'w, J> {
    /// The joint's stops and motor.
    pub fn limit_motor(&self) -> &'w LimitMotor {
        self.data.only_axis()
    }
}

impl<J: OneLimitMotor> JointMut<'_, J> {
    /// The joint's stops and motor, to change.
    pub fn limit_motor_mut(&mut self) -> &mut LimitMotor {
        self.parts().0.only_axis_mut()
    }

    /// Sets the joint's stops; see [`LimitMotor::set_limits`].
    ///
    /// # Errors
    /// [`Error::OutOfRange`] for NaN.
    pub fn set_limits(&mut self, low: f64, high: f64) -> Result<&mut Self, Error> {
        self.limit_motor_mut().set_limits(low, high)?;
        Ok(self)
    }

    /// Sets the joint's motor; see [`LimitMotor::set_motor`].
    ///
    /// # Errors
    /// As [`LimitMotor::set_motor`].
    pub fn set_motor(&mut self, velocity: f64, max_force: f64) -> Result<&mut Self, Error> {
        self.limit_motor_mut().set_motor(velocity, max_force)?;
        Ok(self)
    }
}
