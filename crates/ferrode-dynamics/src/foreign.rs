//! What a C interface over this crate needs and Rust callers don't: raw state, ODE's numbers for parameters, and a look at
//! every body that a step moves. Hidden from the documentation; the checked functions are the interface.

use crate::arena::NIL;
use crate::body::Body;
use crate::joint::{Contact, JointKind};
use crate::{BodyKey, Error, JointFeedback, JointKey, JointType, StepReport, Stepper, World};
use ferrode_math::random::OdeRandom;
use ferrode_math::{Mat3, Quat, Vec3};

/// All that a program can see of a body's motion, as it is stored.
#[doc(hidden)]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BodyState {
    pub position: Vec3,
    pub quaternion: Quat,
    pub rotation: Mat3,
    pub linear_velocity: Vec3,
    pub angular_velocity: Vec3,
    pub force: Vec3,
    pub torque: Vec3,
}

/// Called when a step has moved a body, after the body's own moved callback.
#[doc(hidden)]
pub type MovedObserver<'a> = &'a mut dyn FnMut(&mut World, BodyKey);

/// A quaternion's numbers.
pub(crate) fn numbers(q: Quat) -> Vec<f64> {
    vec![q.w, q.x, q.y, q.z]
}

impl Body {
    #[doc(hidden)]
    pub fn state(&self) -> BodyState {
        let f = &self.frame;
        BodyState {
            position: f.position,
            quaternion: f.quaternion,
            rotation: f.rotation,
            linear_velocity: f.linear_velocity,
            angular_velocity: f.angular_velocity,
            force: self.force,
            torque: self.torque,
        }
    }

    /// Stores a state as it is, finite or not; a step takes a body out whose state isn't. A state that is finite again
    /// takes it back in.
    #[doc(hidden)]
    pub fn set_state(&mut self, state: &BodyState) {
        let f = &mut self.frame;
        let moved =
            f.position != state.position || f.quaternion != state.quaternion || f.rotation != state.rotation;
        f.position = state.position;
        f.quaternion = state.quaternion;
        f.rotation = state.rotation;
        f.linear_velocity = state.linear_velocity;
        f.angular_velocity = state.angular_velocity;
        self.force = state.force;
        self.torque = state.torque;
        if moved {
            self.pose_version = self.pose_version.wrapping_add(1);
        }
        if self.quarantined && self.is_finite() {
            self.quarantined = false;
        }
    }

    /// Steps and seconds that are left until the body disables itself.
    #[doc(hidden)]
    pub fn idle_countdowns(&self) -> (i32, f64) {
        (self.idleness.steps_left, self.idleness.time_left)
    }
}

impl World {
    /// As [`World::step_with_random`]; `moved` is called for every body that was moved, where its moved callback is. It
    /// may change the world in any way, unless it is said that it `looks_only`.
    ///
    /// # Errors
    /// As [`World::step`].
    #[doc(hidden)]
    pub fn step_observed(
        &mut self,
        stepper: Stepper,
        h: f64,
        random: &mut OdeRandom,
        (moved, looks_only): (MovedObserver<'_>, bool),
    ) -> Result<StepReport, Error> {
        let mut report = StepReport::default();
        let moved = crate::step::Moved { observer: Some(moved), looks_only };
        self.step_in_full(stepper, h, random, moved, &mut report)?;
        Ok(report)
    }

    /// A joint's recorded forces, to mark them before a step.
    ///
    /// # Errors
    /// [`Error::NoSuchJoint`].
    #[doc(hidden)]
    pub fn joint_feedback_mut(&mut self, joint: JointKey) -> Result<Option<&mut JointFeedback>, Error> {
        let index = self.joint_index(joint)?;
        Ok(self.joints.at_mut(index).feedback.as_deref_mut())
    }

    /// Sets the parameter of ODE's number, whatever the value.
    ///
    /// # Errors
    /// [`Error::NoSuchJoint`].
    #[doc(hidden)]
    pub fn set_joint_param_number(&mut self, joint: JointKey, n: i32, value: f64) -> Result<(), Error> {
        let index = self.joint_index(joint)?;
        self.joints.at_mut(index).kind.model_mut().set_param(n, value);
        Ok(())
    }

    /// The parameter of ODE's number; 0 for unknown ones.
    ///
    /// # Errors
    /// [`Error::NoSuchJoint`].
    #[doc(hidden)]
    pub fn joint_param_number(&self, joint: JointKey, n: i32) -> Result<f64, Error> {
        Ok(self.joints.at(self.joint_index(joint)?).kind.model().param(n))
    }

    /// The joint's own numbers as ODE's interchange format names them, in body coordinates.
    ///
    /// # Errors
    /// [`Error::NoSuchJoint`].
    #[doc(hidden)]
    pub fn joint_details(&self, joint: JointKey) -> Result<Vec<(&'static str, Vec<f64>)>, Error> {
        Ok(self.joints.at(self.joint_index(joint)?).kind.model().details())
    }

    /// A contact joint in limbo, whatever the numbers: `write` writes them over those of an earlier contact. The caller's number of the joint is
    /// `user_data`.
    #[doc(hidden)]
    #[inline]
    pub fn create_contact_unchecked(&mut self, user_data: u64, write: impl FnOnce(&mut Contact)) -> JointKey {
        let contact = self.contact_box(write);
        self.push_joint(JointKind::Contact(contact), NIL, user_data)
    }

    /// Whether `test` holds for the type of any joint that links the two; `None` for one of them stands for the static
    /// world.
    ///
    /// # Errors
    /// [`Error::NoSuchBody`].
    #[doc(hidden)]
    pub fn any_joint_between(
        &self,
        a: Option<BodyKey>,
        b: Option<BodyKey>,
        test: impl Fn(JointType) -> bool,
    ) -> Result<bool, Error> {
        let index = |key: Option<BodyKey>| key.map_or(Ok(NIL), |key| self.body_index(key));
        let (a, b) = (index(a)?, index(b)?);
        let count = |body: u32| if body == NIL { usize::MAX } else { self.bodies.at(body).joint_count };
        // Each joint is in the lists of both its bodies: the shorter one will do.
        let (from, to) = if count(b) < count(a) { (b, a) } else { (a, b) };
        if from == NIL {
            return Ok(false);
        }
        let mut link = self.bodies.at(from).first_joint;
        while link != NIL {
            let joint = self.joints.at(link >> 1);
            let side = (link & 1) as usize;
            if joint.nodes[1 - side].body == to && test(joint.kind.joint_type()) {
                return Ok(true);
            }
            link = joint.nodes[side].next;
        }
        Ok(false)
    }
}
