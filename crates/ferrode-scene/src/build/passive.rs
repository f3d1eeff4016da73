//! Springs, damping, friction and wide stops: what acts along an axis by itself. The choice of rows is explained in the module
//! above.

use ferrode::dynamics::AxisFrame;
use ferrode::{AMotor, Error, JointKey, Slider, Softness};

use super::connect::{Form, set_stops, stop_softness};
use super::{NamedWorld, refused};
use crate::description::{Axis, JointId, Spring};
use crate::error::{Notes, Result};

/// What must be brought up to date before each step.
#[derive(Clone, Debug)]
pub(super) struct Passive {
    joint: JointId,
    axis: usize,
    row: RowPlace,
    spring: Option<(Spring, Softness)>,
    damping: f64,
    friction: f64,
    /// Stops beyond half a turn: the number of their axis in the angular motor.
    stops: Option<usize>,
    /// Of a prismatic axis with friction and more: which way it slides; 0 while it sticks.
    sliding: f64,
}

/// Where the rows are.
#[derive(Clone, Copy, Debug)]
enum RowPlace {
    /// Axis 1 of an angular motor beside the joint.
    Beside(JointKey),
    /// The joint's own motor.
    Own,
}

pub(super) fn add(built: &mut NamedWorld, notes: &mut Notes) -> Result<()> {
    for index in 0..built.scene.joints.len() {
        let Some(joint) = built.joints[index].clone() else { continue };
        let described = built.scene.joints[index].clone();
        for (axis_index, axis) in [&described.axis, &described.axis2].into_iter().enumerate() {
            let Some(axis) = axis else { continue };
            if joint.motor(axis_index).is_none() {
                continue;
            }
            let driven = described.advanced.max_force.is_some_and(|force| force > 0.0);
            let (id, name) = (JointId(index), &described.name);
            let refused = |error: Error| refused(&described.origin, &format!("joint `{name}`"), error);
            let wide = joint.has_wide_stops(axis_index, &axis.limits);
            let acts = axis.damping > 0.0 || axis.friction > 0.0 || axis.spring.is_some() || wide;
            if !acts {
                continue;
            }
            if joint.form == Form::Slider && driven {
                let message = format!(
                    "prismatic joint `{name}`: spring, damping and friction have no effect beside its motor"
                );
                notes.not_supported(described.origin.clone(), message);
                continue;
            }
            add_rows(built, id, axis_index, axis).map_err(refused)?;
        }
    }
    Ok(())
}

fn add_rows(
    built: &mut NamedWorld,
    joint: JointId,
    axis: usize,
    described: &Axis,
) -> std::result::Result<(), Error> {
    let step = built.step_size;
    let softness = described.spring.map(|spring| {
        let softness = Softness::from_spring(spring.stiffness, described.damping, step);
        softness.map(|softness| (spring, softness))
    });
    let spring = softness.transpose()?;
    let joint_of_engine = built.joints[joint.0].clone();
    let Some(connected) = joint_of_engine else { return Ok(()) };
    let mut passive = Passive {
        joint,
        axis,
        row: RowPlace::Own,
        spring,
        damping: described.damping,
        friction: described.friction,
        stops: None,
        sliding: 0.0,
    };
    if connected.is_angular() {
        let key = add_angular_motor(built, &connected, axis, &passive)?;
        passive.row = RowPlace::Beside(key);
        if connected.has_wide_stops(axis, &described.limits) {
            passive.stops = Some(add_wide_stops(built, joint, key, described)?);
        }
    }
    // Dampers and friction beside the joint stay as they are made.
    let changes = passive.spring.is_some() || passive.stops.is_some();
    if changes || matches!(passive.row, RowPlace::Own) {
        built.passive.push(passive);
    }
    Ok(())
}

/// An angular motor about an axis of a joint: axis 1 for spring and damper, the next for friction, the next for stops.
/// An axis without motor and stops has no row.
fn add_angular_motor(
    built: &mut NamedWorld,
    joint: &super::connect::BuiltJoint,
    axis: usize,
    passive: &Passive,
) -> std::result::Result<JointKey, Error> {
    let Some(direction) = joint.axis(&built.world, axis) else { return Ok(joint.key) };
    // The axis is fixed in the child, but for the first of two, which is fixed in the parent.
    let in_parent = axis == 0 && matches!(joint.form, Form::Universal | Form::Hinge2);
    let (first, second, direction, frame) = match (joint.child, joint.parent) {
        (None, parent) => {
            (parent, None, -direction, if in_parent { AxisFrame::First } else { AxisFrame::World })
        }
        (child, parent) => {
            (child, parent, direction, if in_parent { AxisFrame::Second } else { AxisFrame::First })
        }
    };
    let soft = passive.is_soft();
    let world = &mut built.world;
    let key = world.create_joint::<AMotor>(None)?;
    world.attach(key, first, second)?;
    let mut motor = world.joint_mut::<AMotor>(key)?;
    let count = usize::from(soft) + usize::from(passive.friction > 0.0);
    motor.set_axis_count(3);
    for index in 0..3 {
        motor.set_axis(index, frame, direction)?;
    }
    if soft && passive.spring.is_none() {
        let damper = motor.limit_motor_of_mut(1)?;
        damper.set_motor(0.0, f64::INFINITY)?;
        damper.set_motor_cfm(1.0 / passive.damping)?;
    }
    if passive.friction > 0.0 {
        motor.limit_motor_of_mut(count)?.set_motor(0.0, passive.friction)?;
    }
    Ok(key)
}

/// Stops on the next free axis of an angular motor, which tests them against an angle that it is told: that with the
/// turns counted. The number of the axis.
fn add_wide_stops(
    built: &mut NamedWorld,
    joint: JointId,
    key: JointKey,
    described: &Axis,
) -> std::result::Result<usize, Error> {
    let soft = described.damping > 0.0 || described.spring.is_some();
    let number = 1 + usize::from(soft) + usize::from(described.friction > 0.0);
    let softness = stop_softness(&built.scene.joints[joint.0], &described.limits, built.step_size);
    let mut motor = built.world.joint_mut::<AMotor>(key)?;
    let row = motor.limit_motor_of_mut(number)?;
    set_stops(row, &built.scene.joints[joint.0], &described.limits, softness)?;
    Ok(number)
}

impl Passive {
    fn is_soft(&self) -> bool {
        self.damping > 0.0 || self.spring.is_some()
    }

    /// The velocity that spring and damper aim at, and their softness. The row then gives the force
    /// λ = −k (q + h v − q₀) − c v of the end of the step: ERP/h = k / (h k + c), CFM = 1 / (h k + c).
    fn target(&self, position: f64, step: f64) -> (f64, f64) {
        match self.spring {
            Some((spring, softness)) => (-softness.erp / step * (position - spring.reference), softness.cfm),
            None => (0.0, 1.0 / self.damping),
        }
    }

    fn update(&mut self, built: &mut NamedWorld) -> std::result::Result<(), Error> {
        let Some(joint) = built.joints[self.joint.0].clone() else { return Ok(()) };
        let step = built.step_size;
        match self.row {
            RowPlace::Beside(key) => {
                let Some(position) = joint.position(&built.world, self.axis) else { return Ok(()) };
                let mut motor = built.world.joint_mut::<AMotor>(key)?;
                if self.spring.is_some() {
                    let (velocity, cfm) = self.target(position, step);
                    let row = motor.limit_motor_of_mut(1)?;
                    row.set_motor(velocity, f64::INFINITY)?;
                    row.set_motor_cfm(cfm)?;
                }
                if let Some(number) = self.stops {
                    motor.set_angle(number - 1, position)?;
                }
            }
            RowPlace::Own => {
                let position = joint.position(&built.world, self.axis).unwrap_or(0.0);
                let velocity = joint.velocity(&built.world, self.axis).unwrap_or(0.0);
                let hard = built.world.cfm();
                let Some(motor) = joint.motor(self.axis) else { return Ok(()) };
                let own = self.own_motor(position, velocity, step, hard);
                joint.with_motor(&mut built.world, motor.group, |row| {
                    row.set_motor(own.velocity, own.force)?;
                    row.set_motor_cfm(own.cfm)
                })?;
                if own.beside != 0.0 {
                    built.world.joint_mut::<Slider>(joint.key)?.add_force(own.beside)?;
                }
            }
        }
        Ok(())
    }

    /// What the only motor of a prismatic joint is to do. With friction beside spring or damper the axis either
    /// sticks or slides. It sticks once its velocity turns round, held by at most the friction against the spring,
    /// which is then a plain force. It slides as soon as that doesn't hold; the friction then shifts the velocity that
    /// the soft row aims at, so that its force is less by the friction.
    fn own_motor(&mut self, position: f64, velocity: f64, step: f64, hard: f64) -> OwnMotor {
        if !self.is_soft() {
            return OwnMotor { velocity: 0.0, force: self.friction, cfm: hard, beside: 0.0 };
        }
        let (target, cfm) = self.target(position, step);
        if self.friction == 0.0 {
            return OwnMotor { velocity: target, force: f64::INFINITY, cfm, beside: 0.0 };
        }
        if self.sliding == 0.0 {
            self.sliding = if velocity.abs() > STILL { velocity.signum() } else { 0.0 };
        } else if velocity * self.sliding <= 0.0 {
            self.sliding = 0.0;
        }
        if self.sliding == 0.0 {
            let spring =
                self.spring.map_or(0.0, |(spring, _)| spring.stiffness * (spring.reference - position));
            return OwnMotor { velocity: 0.0, force: self.friction, cfm: hard, beside: spring };
        }
        let velocity = target - self.friction * self.sliding * cfm;
        OwnMotor { velocity, force: f64::INFINITY, cfm, beside: 0.0 }
    }
}

/// Slower than this, m/s, an axis with friction is at rest: what a hard row leaves.
const STILL: f64 = 1e-7;

struct OwnMotor {
    velocity: f64,
    force: f64,
    cfm: f64,
    /// A force beside it.
    beside: f64,
}

impl NamedWorld {
    /// Brings springs up to date with where the axes are, and enforces couplings.
    pub(super) fn update_passive(&mut self) -> std::result::Result<(), Error> {
        let mut passive = std::mem::take(&mut self.passive);
        let updated = passive.iter_mut().try_for_each(|passive| passive.update(self));
        self.passive = passive;
        let planar = self.joints.iter().flatten().filter_map(|joint| joint.planar.as_ref());
        let held = planar.map(|planar| planar.update(&mut self.world, self.step_size));
        let held = held.collect::<std::result::Result<(), Error>>();
        let couplings = std::mem::take(&mut self.couplings);
        let coupled = couplings.iter().try_for_each(|coupling| coupling.apply(self));
        self.couplings = couplings;
        updated.and(held).and(coupled)
    }

    /// Leaves the motor of a joint's axis to the caller. The spring, damping and friction of a prismatic joint no longer
    /// touch it; those of an angular axis have rows of their own and go on. A follower no longer follows.
    pub fn release_axis(&mut self, joint: JointId, axis: usize) {
        self.passive.retain(|passive| {
            !matches!(passive.row, RowPlace::Own) || passive.joint != joint || passive.axis != axis
        });
        self.couplings.retain(|coupling| coupling.joint != joint || coupling.axis != axis);
    }
}
