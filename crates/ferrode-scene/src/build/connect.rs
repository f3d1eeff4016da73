//! Joints of the file become joints of the engine.
//!
//! The engine measures the first body relative to the second; a file, the child relative to the parent. So the child
//! is attached first. Where the child cannot move, the parent comes first and the axes are turned round, which is the
//! same motion seen from the other side. The hinge-2 wants the chassis, the parent, first.
//!
//! | file | engine | bodies | axis of the file → axis of the engine |
//! |---|---|---|---|
//! | revolute | hinge | child, parent | 1 → 1 |
//! | prismatic | slider | child, parent | 1 → 1 |
//! | ball | ball | child, parent | |
//! | fixed | fixed | child, parent | |
//! | universal | universal | child, parent | 1 (in the parent) → 2, 2 (in the child) → 1 |
//! | universal, child static | universal | parent, world | 1 → 1, 2 → 2 |
//! | screw | piston, with a coupling | child, parent | 1 (the angle) → 2 |
//! | gearbox | none, but a coupling | | |
//! | planar, parent or child static | linear and angular motor | the one that moves | 1 (the turn in the plane) → 3 |
//! | revolute2 | hinge-2 | parent, child | 1 → 1, 2 → 2; motor of 2 reversed |

use ferrode::{
    AMotor, BodyKey, Error, Hinge, Hinge2, JointKey, LimitMotor, Piston, Slider, Softness, Universal, Vec3,
    World,
};

use super::bodies::BuiltLink;
use super::planar::{self, Planar};
use super::{NamedWorld, refused, softness};
use crate::description::{Axis, Body, Joint, JointId, JointKind, Limits, Scene};
use crate::error::{Notes, Result};

/// What became of a joint.
#[derive(Clone, Debug)]
pub(super) struct BuiltJoint {
    pub key: JointKey,
    pub form: Form,
    /// The bodies of child and parent; `None` for the world and static links.
    pub child: Option<BodyKey>,
    pub parent: Option<BodyKey>,
    /// Of a planar joint.
    pub planar: Option<Planar>,
    /// For each axis that turns: how often it has gone round, and the angle it was last seen at.
    pub turns: [Turns; 2],
}

#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Turns {
    count: f64,
    angle: f64,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Form {
    Hinge,
    Slider,
    Ball,
    Fixed,
    Universal,
    Hinge2,
    Screw,
    Planar,
}

/// The stops and motor behind an axis of the file, for whoever drives it:
/// `world.joint_mut::<Hinge>(motor.joint)?.set_motor_of(motor.group, motor.sign * velocity, force)`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AxisMotor {
    /// The joint.
    pub joint: JointKey,
    /// The number of the axis in the engine's joint, from 1.
    pub group: usize,
    /// The motor's velocity is this times the file's.
    pub sign: f64,
}

pub(super) fn add_joints(
    world: &mut World,
    scene: &Scene,
    links: &[BuiltLink],
    step: f64,
    notes: &mut Notes,
) -> Result<Vec<Option<BuiltJoint>>> {
    scene.joints.iter().map(|joint| add_joint(world, joint, links, step, notes)).collect()
}

fn add_joint(
    world: &mut World,
    joint: &Joint,
    links: &[BuiltLink],
    step: f64,
    notes: &mut Notes,
) -> Result<Option<BuiltJoint>> {
    let body = |body: Body| body.link().and_then(|link| links[link.0].body);
    let (parent, child) = (body(joint.parent), body(joint.child));
    if parent.is_none() && child.is_none() {
        notes.suspicious(
            joint.origin.clone(),
            format!("joint `{}` is left out: neither of its links can move", joint.name),
        );
        return Ok(None);
    }
    let Some(form) = form_of(joint, parent, child, notes) else { return Ok(None) };
    let built = connect(world, joint, form, parent, child)
        .map_err(|error| refused(&joint.origin, &format!("joint `{}`", joint.name), error))?;
    set_limits(world, joint, &built, step)
        .and_then(|()| set_motor(world, joint, &built))
        .and_then(|()| Ok(world.set_joint_feedback(built.key, joint.advanced.provide_feedback)?))
        .map_err(|error| refused(&joint.origin, &format!("joint `{}`", joint.name), error))?;
    let advanced = &joint.advanced;
    if advanced.cfm.is_some_and(|cfm| cfm != 0.0) || advanced.erp.is_some_and(|erp| erp != 0.2) {
        let message = format!("joint `{}`: <cfm> and <erp> of the joint are the world's", joint.name);
        notes.not_supported(joint.origin.clone(), message);
    }
    Ok(Some(built))
}

/// The engine's joint for one of the file; `None`, with a warning, if it has none.
fn form_of(
    joint: &Joint,
    parent: Option<BodyKey>,
    child: Option<BodyKey>,
    notes: &mut Notes,
) -> Option<Form> {
    let both_move = parent.is_some() && child.is_some();
    let perpendicular = match (&joint.axis, &joint.axis2) {
        (Some(a), Some(b)) => a.direction.dot(b.direction).abs() < 1e-6,
        _ => true,
    };
    match joint.kind {
        JointKind::Revolute => return Some(Form::Hinge),
        JointKind::Prismatic => return Some(Form::Slider),
        JointKind::Ball => return Some(Form::Ball),
        JointKind::Fixed => return Some(Form::Fixed),
        JointKind::Screw { .. } => return Some(Form::Screw),
        JointKind::Planar if !both_move => return Some(Form::Planar),
        // It holds nothing: other joints hold its bodies. What it couples is seen to elsewhere.
        JointKind::Gearbox { .. } => return None,
        JointKind::Universal if perpendicular => return Some(Form::Universal),
        // Two axes that are not perpendicular: the hinge-2 keeps the angle between them.
        JointKind::Universal | JointKind::Revolute2 if both_move => return Some(Form::Hinge2),
        JointKind::Revolute2 if perpendicular => return Some(Form::Universal),
        _ => {}
    }
    let why = match joint.kind {
        JointKind::Universal | JointKind::Revolute2 => {
            "with axes that are not perpendicular it needs two links that can move"
        }
        JointKind::Planar => "its plane must not move: the parent must be the world or a static link",
        _ => "the engine has no such joint",
    };
    notes.not_supported(
        joint.origin.clone(),
        format!("the {} joint `{}` is left out: {why}", joint.kind.name(), joint.name),
    );
    None
}

fn connect(
    world: &mut World,
    joint: &Joint,
    form: Form,
    parent: Option<BodyKey>,
    child: Option<BodyKey>,
) -> std::result::Result<BuiltJoint, Error> {
    let anchor = joint.pose.position;
    let direction = |axis: &Option<Axis>| axis.as_ref().map_or(Vec3::Z, |axis| axis.direction);
    let (axis, axis2) = (direction(&joint.axis), direction(&joint.axis2));
    // Seen from the parent, where the child cannot move.
    let flipped = child.is_none();
    let (first, second) = if flipped { (parent, None) } else { (child, parent) };
    let sign = if flipped { -1.0 } else { 1.0 };
    let mut planar = None;
    let key = match form {
        Form::Planar => match first {
            Some(body) => {
                let held = planar::connect(world, body, axis * sign)?;
                let key = held.key();
                planar = Some(held);
                key
            }
            None => world.create_joint::<ferrode::Null>(None)?,
        },
        Form::Hinge => world.add_hinge(first, second, anchor, axis * sign)?,
        Form::Slider => world.add_slider(first, second, axis * sign)?,
        Form::Ball => world.add_ball(first, second, anchor)?,
        Form::Fixed => world.add_fixed(first, second)?,
        Form::Universal if flipped => world.add_universal(first, second, anchor, -axis, -axis2)?,
        Form::Universal => world.add_universal(first, second, anchor, axis2, axis)?,
        Form::Screw => {
            let key = world.create_joint::<Piston>(None)?;
            world.attach(key, first, second)?;
            let mut piston = world.joint_mut::<Piston>(key)?;
            piston.set_anchor(anchor)?;
            piston.set_axis(axis * sign)?;
            key
        }
        Form::Hinge2 => {
            let key = world.create_joint::<Hinge2>(None)?;
            world.attach(key, parent, child)?;
            let mut hinge2 = world.joint_mut::<Hinge2>(key)?;
            hinge2.set_anchor(anchor)?;
            hinge2.set_axes(Some(-axis), Some(axis2))?;
            if let Some(suspension) = joint.advanced.suspension {
                hinge2.set_suspension(Softness { erp: suspension.erp, cfm: suspension.cfm })?;
            }
            key
        }
    };
    Ok(BuiltJoint { key, form, child, parent, planar, turns: [Turns::default(); 2] })
}

fn set_limits(
    world: &mut World,
    joint: &Joint,
    built: &BuiltJoint,
    step: f64,
) -> std::result::Result<(), Error> {
    for (index, axis) in [&joint.axis, &joint.axis2].into_iter().enumerate() {
        let Some(axis) = axis else { continue };
        let Some(motor) = built.motor(index) else { continue };
        let limits = &axis.limits;
        let stops = limits.lower.is_finite() || limits.upper.is_finite();
        if !stops {
            continue;
        }
        // Stops that an angle within half a turn does not reach are an angular motor's: see `passive`.
        if built.has_wide_stops(index, limits) {
            continue;
        }
        let softness = stop_softness(joint, limits, step);
        built.with_motor(world, motor.group, |limit_motor| {
            set_stops(limit_motor, joint, limits, softness)?;
            if let Some(fudge) = joint.advanced.fudge_factor {
                limit_motor.set_fudge_factor(fudge.min(1.0))?;
            }
            Ok(())
        })?;
    }
    Ok(())
}

/// Sets where an axis ends and how softly.
pub(super) fn set_stops(
    limit_motor: &mut LimitMotor,
    joint: &Joint,
    limits: &Limits,
    softness: Option<Softness>,
) -> std::result::Result<(), ferrode::dynamics::Error> {
    limit_motor.set_limits(limits.lower, limits.upper)?;
    if let Some(softness) = softness {
        limit_motor.set_stop_softness(softness)?;
    }
    if let Some(bounce) = joint.advanced.bounce {
        limit_motor.set_bounce(bounce)?;
    }
    Ok(())
}

/// The softness of a joint's stops: ODE's own terms if the file has them, or else their spring and damper.
pub(super) fn stop_softness(joint: &Joint, limits: &Limits, step: f64) -> Option<Softness> {
    match joint.advanced.stop {
        Some(stop) => Some(Softness { erp: stop.erp, cfm: stop.cfm }),
        None => softness(limits.stiffness, limits.dissipation, step),
    }
}

/// `<velocity>` and `<max_force>` drive the only axis; of a revolute2 the second, which is the wheel's.
fn set_motor(world: &mut World, joint: &Joint, built: &BuiltJoint) -> std::result::Result<(), Error> {
    let Some(force) = joint.advanced.max_force.filter(|&force| force > 0.0) else { return Ok(()) };
    let index = usize::from(joint.kind == JointKind::Revolute2);
    let Some(motor) = built.motor(index) else { return Ok(()) };
    let velocity = motor.sign * joint.advanced.velocity.unwrap_or(0.0);
    built.with_motor(world, motor.group, |limit_motor| limit_motor.set_motor(velocity, force))
}

impl BuiltJoint {
    fn flipped(&self) -> bool {
        self.child.is_none()
    }

    /// The engine's stops and motor for an axis of the file.
    pub(super) fn motor(&self, axis: usize) -> Option<AxisMotor> {
        let (group, sign) = match (self.form, axis) {
            (Form::Hinge | Form::Slider, 0) => (1, 1.0),
            (Form::Screw, 0) => (2, 1.0),
            (Form::Planar, 0) => (3, 1.0),
            (Form::Universal, 0 | 1) => (if self.flipped() { axis + 1 } else { 2 - axis }, 1.0),
            (Form::Hinge2, 0) => (1, 1.0),
            (Form::Hinge2, 1) => (2, -1.0),
            _ => return None,
        };
        Some(AxisMotor { joint: self.key, group, sign })
    }

    /// Changes the engine's stops and motor of an axis.
    pub(super) fn with_motor(
        &self,
        world: &mut World,
        group: usize,
        change: impl FnOnce(&mut LimitMotor) -> std::result::Result<(), ferrode::dynamics::Error>,
    ) -> std::result::Result<(), Error> {
        match self.form {
            Form::Hinge => change(world.joint_mut::<Hinge>(self.key)?.limit_motor_of_mut(group)?)?,
            Form::Slider => change(world.joint_mut::<Slider>(self.key)?.limit_motor_of_mut(group)?)?,
            Form::Universal => change(world.joint_mut::<Universal>(self.key)?.limit_motor_of_mut(group)?)?,
            Form::Hinge2 => change(world.joint_mut::<Hinge2>(self.key)?.limit_motor_of_mut(group)?)?,
            Form::Screw => change(world.joint_mut::<Piston>(self.key)?.limit_motor_of_mut(group)?)?,
            Form::Planar => change(world.joint_mut::<AMotor>(self.key)?.limit_motor_of_mut(group)?)?,
            Form::Ball | Form::Fixed => {}
        }
        Ok(())
    }

    /// An axis of the file in the world, now; `None` if the joint has no such axis.
    pub(super) fn axis(&self, world: &World, axis: usize) -> Option<Vec3> {
        let sign = if self.flipped() { -1.0 } else { 1.0 };
        Some(match (self.form, axis) {
            (Form::Hinge, 0) => world.joint::<Hinge>(self.key).ok()?.axis() * sign,
            (Form::Slider, 0) => world.joint::<Slider>(self.key).ok()?.axis() * sign,
            (Form::Screw, 0) => world.joint::<Piston>(self.key).ok()?.axis() * sign,
            (Form::Planar, 0) => self.planar.as_ref()?.normal() * sign,
            (Form::Universal, 0 | 1) => {
                let universal = world.joint::<Universal>(self.key).ok()?;
                match self.motor(axis)?.group {
                    1 => universal.axis1() * sign,
                    _ => universal.axis2() * sign,
                }
            }
            (Form::Hinge2, 0) => -world.joint::<Hinge2>(self.key).ok()?.axis1(),
            (Form::Hinge2, 1) => world.joint::<Hinge2>(self.key).ok()?.axis2(),
            _ => return None,
        })
    }

    /// The position of an axis in the file's sense: metres, or radians within half a turn.
    fn raw_position(&self, world: &World, axis: usize) -> Option<f64> {
        Some(match (self.form, axis) {
            (Form::Hinge, 0) => world.joint::<Hinge>(self.key).ok()?.angle(),
            (Form::Slider, 0) => world.joint::<Slider>(self.key).ok()?.position().ok()?,
            (Form::Screw, 0) => world.joint::<Piston>(self.key).ok()?.angle(),
            (Form::Planar, 0) => self.planar.as_ref()?.angle(world),
            (Form::Universal, 0 | 1) => {
                let universal = world.joint::<Universal>(self.key).ok()?;
                universal.angles()[self.motor(axis)?.group - 1]
            }
            (Form::Hinge2, 0) => world.joint::<Hinge2>(self.key).ok()?.angle1(),
            (Form::Hinge2, 1) => world.joint::<Hinge2>(self.key).ok()?.angle2(),
            _ => return None,
        })
    }

    /// Whether an axis has stops that the joint itself does not keep: beyond half a turn, which its angle does not
    /// reach; any of a screw, which turns too often; any of a hinge-2's second axis, which ODE's joint ignores.
    pub(super) fn has_wide_stops(&self, axis: usize, limits: &Limits) -> bool {
        let never = self.form == Form::Screw || (self.form, axis) == (Form::Hinge2, 1);
        let wide = |end: f64| end.is_finite() && (end.abs() > std::f64::consts::PI || never);
        self.is_angular() && (wide(limits.lower) || wide(limits.upper))
    }

    pub(super) fn is_angular(&self) -> bool {
        !matches!(self.form, Form::Slider | Form::Ball | Form::Fixed)
    }

    /// The position of an axis, turns included.
    pub(super) fn position(&self, world: &World, axis: usize) -> Option<f64> {
        let raw = self.raw_position(world, axis)?;
        if !self.is_angular() {
            return Some(raw);
        }
        Some(self.turns[axis].at(raw))
    }

    /// The velocity of an axis: the child's relative to the parent.
    pub(super) fn velocity(&self, world: &World, axis: usize) -> Option<f64> {
        let direction = self.axis(world, axis)?;
        let body = |key: Option<BodyKey>| key.and_then(|key| world.body(key).ok());
        let (child, parent) = (body(self.child), body(self.parent));
        if self.is_angular() {
            let spin = |body: Option<&ferrode::Body>| body.map_or(Vec3::ZERO, |body| body.angular_velocity());
            return Some(direction.dot(spin(child) - spin(parent)));
        }
        // The two points that coincide where the child's centre is; the joint's own rate leaves out the rotation.
        let at = child.or(parent)?.position();
        let speed = |body: Option<&ferrode::Body>| body.map_or(Vec3::ZERO, |body| body.point_velocity(at));
        Some(direction.dot(speed(child) - speed(parent)))
    }
}

impl Turns {
    /// The angle nearest to where it was last seen, of those that `raw` may mean.
    pub(super) fn at(&self, raw: f64) -> f64 {
        let turn = 2.0 * std::f64::consts::PI;
        let mut count = self.count;
        if raw - self.angle > 0.5 * turn {
            count -= 1.0;
        } else if raw - self.angle < -0.5 * turn {
            count += 1.0;
        }
        raw + count * turn
    }

    /// Takes note of the angle.
    pub(super) fn follow(&mut self, raw: f64) {
        let turn = 2.0 * std::f64::consts::PI;
        *self = Self { count: ((self.at(raw) - raw) / turn).round(), angle: raw };
    }
}

impl NamedWorld {
    /// Counts the turns that angles have made.
    pub(super) fn follow_turns(&mut self) {
        for joint in self.joints.iter_mut().flatten().filter(|joint| joint.is_angular()) {
            for axis in 0..2 {
                if let Some(raw) = joint.raw_position(&self.world, axis) {
                    joint.turns[axis].follow(raw);
                }
            }
        }
        for coupling in &mut self.couplings {
            coupling.follow_turns(&self.world);
        }
    }

    /// The engine's joint; `None` if it could not be built, see the warnings.
    pub fn joint_key(&self, joint: JointId) -> Option<JointKey> {
        self.built(joint).map(|built| built.key)
    }

    pub(super) fn built(&self, joint: JointId) -> Option<&BuiltJoint> {
        self.joints.get(joint.0)?.as_ref()
    }

    /// The position of a joint's axis 0 or 1 in the file's sense: of the child relative to the parent, 0 where the
    /// file puts them. Metres, or radians with the turns counted that [`NamedWorld::step`] has seen. `None` if it has
    /// no such axis.
    pub fn joint_position(&self, joint: JointId, axis: usize) -> Option<f64> {
        self.built(joint)?.position(&self.world, axis)
    }

    /// The velocity of a joint's axis 0 or 1 in the file's sense, m/s or rad/s. `None` if it has no such axis.
    pub fn joint_velocity(&self, joint: JointId, axis: usize) -> Option<f64> {
        self.built(joint)?.velocity(&self.world, axis)
    }

    /// The stops and motor behind a joint's axis 0 or 1. `None` if it has no such axis.
    pub fn axis_motor(&self, joint: JointId, axis: usize) -> Option<AxisMotor> {
        self.built(joint)?.motor(axis)
    }

    /// Adds a force (N) or torque (N·m) along a joint's axis 0 or 1 for the next step, on the child, and its
    /// opposite on the parent. It is cut to the effort limit of the axis, and is nothing if it would drive an axis that
    /// has reached its velocity limit on in the same direction: these are limits of an actuator.
    ///
    /// # Errors
    /// As the engine's for a number that is not finite. A joint or axis that is not there gets nothing.
    pub fn add_effort(&mut self, joint: JointId, axis: usize, effort: f64) -> std::result::Result<(), Error> {
        let Some(built) = self.joints.get(joint.0).and_then(Option::as_ref) else { return Ok(()) };
        let Some(direction) = built.axis(&self.world, axis) else { return Ok(()) };
        let described = self.scene.joints.get(joint.0);
        let limits = described.and_then(|joint| [&joint.axis, &joint.axis2][axis.min(1)].as_ref());
        let most = limits.and_then(|axis| axis.limits.effort).unwrap_or(f64::INFINITY);
        let mut effort = effort.clamp(-most, most);
        let fastest = limits.and_then(|axis| axis.limits.velocity).unwrap_or(f64::INFINITY);
        let velocity = built.velocity(&self.world, axis).unwrap_or(0.0);
        if velocity.abs() >= fastest && velocity * effort > 0.0 {
            effort = 0.0;
        }
        if built.form == Form::Slider {
            return Ok(self.world.joint_mut::<Slider>(built.key)?.add_force(effort)?);
        }
        for (body, sign) in [(built.child, 1.0), (built.parent, -1.0)] {
            if let Some(body) = body {
                self.world.body_mut(body)?.add_torque(direction * (sign * effort))?;
            }
        }
        Ok(())
    }
}
