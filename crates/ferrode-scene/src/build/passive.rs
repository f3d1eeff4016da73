//! Springs, damping, friction and followers: what acts along an axis by itself. The choice of rows is explained in the
//! module above.

use ferrode::dynamics::AxisFrame;
use ferrode::{AMotor, Error, JointKey, Slider, Softness};

use super::connect::Form;
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

/// An axis that follows another.
#[derive(Clone, Debug)]
pub(super) struct Follower {
    joint: JointId,
    axis: usize,
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
            if axis.mimic.is_some() {
                follow(built, id, axis_index, axis, notes);
            }
            let acts = axis.damping > 0.0 || axis.friction > 0.0 || axis.spring.is_some();
            if !acts {
                continue;
            }
            if joint.form == Form::Slider && (driven || axis.mimic.is_some()) {
                let message = format!(
                    "prismatic joint `{name}`: spring, damping and friction have no effect beside a motor or <mimic>"
                );
                notes.not_supported(described.origin.clone(), message);
                continue;
            }
            add_rows(built, id, axis_index, axis).map_err(refused)?;
        }
    }
    Ok(())
}

fn follow(built: &mut NamedWorld, joint: JointId, axis: usize, described: &Axis, notes: &mut Notes) {
    let Some(mimic) = described.mimic else { return };
    let follower = &built.scene.joints[joint.0];
    let Some(leader) = built.scene.joints.get(mimic.leader.0) else { return };
    if built.joint_position(mimic.leader, usize::from(mimic.second_axis)).is_none() {
        let message =
            format!("joint `{}` follows nothing: `{}` has no such axis", follower.name, leader.name);
        notes.not_supported(follower.origin.clone(), message);
        return;
    }
    let message = format!(
        "joint `{}` is driven after `{}`, which does not feel it: the engine's constraints join two bodies only",
        follower.name, leader.name
    );
    notes.not_supported(follower.origin.clone(), message);
    built.followers.push(Follower { joint, axis });
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
        sliding: 0.0,
    };
    if connected.is_angular() {
        passive.row = RowPlace::Beside(add_angular_motor(built, &connected, axis, &passive)?);
    }
    // Dampers and friction beside the joint stay as they are made.
    if passive.spring.is_some() || matches!(passive.row, RowPlace::Own) {
        built.passive.push(passive);
    }
    Ok(())
}

/// An angular motor about an axis of a joint: axis 1 for spring and damper, the next for friction.
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
    motor.set_axis_count(count);
    for index in 0..count {
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
                if self.spring.is_some()
                    && let Some(position) = joint.position(&built.world, self.axis)
                {
                    let (velocity, cfm) = self.target(position, step);
                    let mut motor = built.world.joint_mut::<AMotor>(key)?;
                    let motor = motor.limit_motor_of_mut(1)?;
                    motor.set_motor(velocity, f64::INFINITY)?;
                    motor.set_motor_cfm(cfm)?;
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
    /// Brings springs and followers up to date with where the axes are.
    pub(super) fn update_passive(&mut self) -> std::result::Result<(), Error> {
        let mut passive = std::mem::take(&mut self.passive);
        let updated = passive.iter_mut().try_for_each(|passive| passive.update(self));
        self.passive = passive;
        let followers = std::mem::take(&mut self.followers);
        let followed = followers.iter().try_for_each(|follower| follower.update(self));
        self.followers = followers;
        updated.and(followed)
    }

    /// Leaves the motor of a joint's axis to the caller: its spring, damping, friction (of a prismatic joint) and
    /// `<mimic>` no longer touch it. Those of an angular axis have rows of their own and go on.
    pub fn release_axis(&mut self, joint: JointId, axis: usize) {
        self.passive.retain(|passive| {
            !matches!(passive.row, RowPlace::Own) || passive.joint != joint || passive.axis != axis
        });
        self.followers.retain(|follower| follower.joint != joint || follower.axis != axis);
    }
}

impl Follower {
    /// Aims at being, at the end of the step, where the leader will be if it keeps its velocity.
    fn update(&self, built: &mut NamedWorld) -> std::result::Result<(), Error> {
        let described = &built.scene.joints[self.joint.0];
        let Some(axis) = [&described.axis, &described.axis2][self.axis].as_ref() else { return Ok(()) };
        let Some(mimic) = axis.mimic else { return Ok(()) };
        let leader_axis = usize::from(mimic.second_axis);
        let Some(leader) = built.joint_position(mimic.leader, leader_axis) else { return Ok(()) };
        let rate = built.joint_velocity(mimic.leader, leader_axis).unwrap_or(0.0);
        let Some(own) = built.joint_position(self.joint, self.axis) else { return Ok(()) };
        let step = built.step_size;
        let wanted = mimic.multiplier * (leader + step * rate - mimic.reference) + mimic.offset;
        let force = axis.limits.effort.filter(|&effort| effort > 0.0).unwrap_or(f64::INFINITY);
        let Some(joint) = built.joints[self.joint.0].clone() else { return Ok(()) };
        let Some(motor) = joint.motor(self.axis) else { return Ok(()) };
        let velocity = motor.sign * (wanted - own) / step;
        joint.with_motor(&mut built.world, motor.group, |row| row.set_motor(velocity, force))
    }
}
