//! Axes that move in a fixed proportion: screws, gearboxes, and joints that mimic others.
//!
//! A coupling demands C = Σ cᵢ qᵢ − d = 0 of the positions qᵢ of two axes. The bodies of the axes are two to four, and
//! the engine's constraint rows join two, so couplings are enforced before each step instead: by the force λ along
//! them that, with the forces already on the bodies, makes C fade by the world's ERP,
//!
//! ```text
//! Ċ after the step = J (v + h M⁻¹ (f + Jᵀ λ)) = −ERP · C / h
//! ```
//!
//! with J and M those of the bodies alone. The force acts on all of them, Jᵀ λ, so that momentum is kept: a leader feels
//! what its follower pushes. What the step's own constraints then add (joints, contacts, motors) is made up for in the
//! next one. Taken alone a body gives way more than in its mechanism, so λ is rather too small than too large, which
//! is the stable side.

use ferrode::{BodyKey, Error, JointKey, Piston, Quat, Vec3, World};

use super::NamedWorld;
use super::connect::Turns;
use crate::description::{Body, JointId, JointKind};
use crate::error::Notes;

/// Two axes in a fixed proportion.
#[derive(Clone, Debug)]
pub(super) struct Coupling {
    /// The joint of the file that it belongs to.
    pub joint: JointId,
    /// Of a follower: its axis.
    pub axis: usize,
    terms: [(f64, Measure); 2],
    offset: f64,
}

/// A position that a coupling speaks of.
#[derive(Clone, Debug)]
enum Measure {
    /// Of an axis of a joint.
    Axis { joint: JointId, axis: usize },
    /// How far a piston has moved.
    Slide { joint: JointId, piston: JointKey },
    /// The angle of a body about an axis fixed in a reference body.
    Twist(Twist),
}

#[derive(Clone, Debug)]
struct Twist {
    body: Option<BodyKey>,
    reference: Option<BodyKey>,
    /// In the reference body, of unit length.
    axis: Vec3,
    /// From the reference to the body, at the start.
    initial: Quat,
    turns: Turns,
}

/// A force and torque on a body, or how its velocities enter a rate.
type Wrench = (BodyKey, Vec3, Vec3);

pub(super) fn add(built: &mut NamedWorld, notes: &mut Notes) {
    for index in 0..built.scene.joints.len() {
        let described = &built.scene.joints[index];
        let coupling = match described.kind {
            JointKind::Screw { pitch } => screw(built, JointId(index), pitch),
            JointKind::Gearbox { ratio, reference } => {
                gearbox(built, JointId(index), ratio, reference, notes)
            }
            _ => None,
        };
        built.couplings.extend(coupling);
        for axis in 0..2 {
            built.couplings.extend(follower(built, JointId(index), axis, notes));
        }
    }
}

/// The slide is `pitch` a turn.
fn screw(built: &NamedWorld, joint: JointId, pitch: f64) -> Option<Coupling> {
    let piston = built.joint_key(joint)?;
    let per_radian = pitch / (2.0 * std::f64::consts::PI);
    Some(Coupling {
        joint,
        axis: 0,
        terms: [(1.0, Measure::Slide { joint, piston }), (-per_radian, Measure::Axis { joint, axis: 0 })],
        offset: 0.0,
    })
}

/// θ2 + ratio · θ1 = 0, both angles measured from the reference.
fn gearbox(
    built: &NamedWorld,
    joint: JointId,
    ratio: f64,
    reference: Body,
    notes: &mut Notes,
) -> Option<Coupling> {
    let described = &built.scene.joints[joint.0];
    let body = |body: Body| body.link().and_then(|link| built.link_body(link));
    let (parent, child, reference) = (body(described.parent), body(described.child), body(reference));
    let (Some(axis), Some(axis2)) = (&described.axis, &described.axis2) else { return None };
    if (parent, reference) == (None, None) || (child, reference) == (None, None) {
        let message = format!("gearbox `{}` is left out: it couples bodies that cannot turn", described.name);
        notes.suspicious(described.origin.clone(), message);
        return None;
    }
    let twist = |body, direction| Measure::Twist(Twist::new(&built.world, body, reference, direction));
    Some(Coupling {
        joint,
        axis: 0,
        terms: [(1.0, twist(child, axis2.direction)), (ratio, twist(parent, axis.direction))],
        offset: 0.0,
    })
}

/// follower = multiplier · (leader − reference) + offset.
fn follower(built: &NamedWorld, joint: JointId, axis: usize, notes: &mut Notes) -> Option<Coupling> {
    let described = &built.scene.joints[joint.0];
    let mimic = [&described.axis, &described.axis2][axis].as_ref()?.mimic?;
    let leader_axis = usize::from(mimic.second_axis);
    let has = |joint, axis| built.joint_position(joint, axis).is_some();
    if !has(joint, axis) || !has(mimic.leader, leader_axis) {
        let leader = built.scene.joints.get(mimic.leader.0).map_or("?", |leader| &leader.name);
        let message =
            format!("joint `{}` does not mimic `{leader}`: one of the axes is not there", described.name);
        notes.not_supported(described.origin.clone(), message);
        return None;
    }
    Some(Coupling {
        joint,
        axis,
        terms: [
            (1.0, Measure::Axis { joint, axis }),
            (-mimic.multiplier, Measure::Axis { joint: mimic.leader, axis: leader_axis }),
        ],
        offset: mimic.offset - mimic.multiplier * mimic.reference,
    })
}

impl Coupling {
    /// Enforces the coupling in the step to come.
    pub(super) fn apply(&self, built: &mut NamedWorld) -> Result<(), Error> {
        let step = built.step_size;
        let mut error = -self.offset;
        let mut jacobian: Vec<Wrench> = Vec::with_capacity(4);
        for (factor, measure) in &self.terms {
            let Some(value) = measure.value(built) else { return Ok(()) };
            error += factor * value;
            for (body, force, torque) in measure.jacobian(built).into_iter().flatten() {
                let (force, torque) = (force * *factor, torque * *factor);
                match jacobian.iter_mut().find(|(known, ..)| *known == body) {
                    Some(entry) => {
                        entry.1 += force;
                        entry.2 += torque;
                    }
                    None => jacobian.push((body, force, torque)),
                }
            }
        }
        let gravity = built.world.gravity();
        let (mut rate, mut give) = (0.0, 0.0);
        for (key, force, torque) in &jacobian {
            let body = built.world.body(*key)?;
            let (mut v, mut w) = (body.linear_velocity(), body.angular_velocity());
            if let Some(inverse) = body.inertia_world().inverse().filter(|_| !body.is_kinematic()) {
                v += body.force() * (step * body.inv_mass());
                if body.gravity_mode() {
                    v += gravity * step;
                }
                w += inverse * body.torque() * step;
                give += force.length_squared() * body.inv_mass() + torque.dot(inverse * *torque);
            }
            rate += force.dot(v) + torque.dot(w);
        }
        if give <= 0.0 {
            return Ok(());
        }
        let wanted = -built.world.erp() * error / step;
        let strength = (wanted - rate) / (step * give);
        for (key, force, torque) in jacobian {
            let body = built.world.body_mut(key)?;
            body.add_force(force * strength)?;
            body.add_torque(torque * strength)?;
        }
        Ok(())
    }

    /// Counts the turns of angles that it measures by itself.
    pub(super) fn follow_turns(&mut self, world: &World) {
        for (_, measure) in &mut self.terms {
            if let Measure::Twist(twist) = measure {
                let raw = twist.raw(world);
                twist.turns.follow(raw);
            }
        }
    }
}

impl Measure {
    fn value(&self, built: &NamedWorld) -> Option<f64> {
        match self {
            Measure::Axis { joint, axis } => built.joint_position(*joint, *axis),
            Measure::Slide { piston, .. } => Some(built.world.joint::<Piston>(*piston).ok()?.position()),
            Measure::Twist(twist) => Some(twist.turns.at(twist.raw(&built.world))),
        }
    }

    /// How the velocities of the bodies make up the rate.
    fn jacobian(&self, built: &NamedWorld) -> [Option<Wrench>; 2] {
        let (direction, plus, minus, angular) = match self {
            Measure::Axis { joint, axis } => {
                let Some(connected) = built.built(*joint) else { return [None; 2] };
                let Some(direction) = connected.axis(&built.world, *axis) else { return [None; 2] };
                (direction, connected.child, connected.parent, connected.is_angular())
            }
            Measure::Slide { joint, .. } => {
                let Some(connected) = built.built(*joint) else { return [None; 2] };
                let Some(direction) = connected.axis(&built.world, 0) else { return [None; 2] };
                (direction, connected.child, connected.parent, false)
            }
            Measure::Twist(twist) => (twist.direction(&built.world), twist.body, twist.reference, true),
        };
        // A slide is measured between the points that coincide at the centre of the first body there is.
        let position = |key: Option<BodyKey>| Some(built.world.body(key?).ok()?.position());
        let at = position(plus).or(position(minus)).unwrap_or(Vec3::ZERO);
        [(plus, direction), (minus, -direction)].map(|(key, direction)| {
            let key = key?;
            if angular {
                return Some((key, Vec3::ZERO, direction));
            }
            let arm = at - position(Some(key))?;
            Some((key, direction, arm.cross(direction)))
        })
    }
}

impl Twist {
    fn new(world: &World, body: Option<BodyKey>, reference: Option<BodyKey>, direction: Vec3) -> Self {
        let own = rotation(world, reference);
        let initial = own.conjugate() * rotation(world, body);
        let axis = own.conjugate().rotate(direction);
        Self { body, reference, axis, initial, turns: Turns::default() }
    }

    fn direction(&self, world: &World) -> Vec3 {
        rotation(world, self.reference).rotate(self.axis)
    }

    /// The angle within half a turn.
    fn raw(&self, world: &World) -> f64 {
        let now = rotation(world, self.reference).conjugate() * rotation(world, self.body);
        super::twist_angle(now * self.initial.conjugate(), self.axis)
    }
}

fn rotation(world: &World, body: Option<BodyKey>) -> Quat {
    body.and_then(|key| world.body(key).ok()).map_or(Quat::IDENTITY, |body| body.quaternion())
}
