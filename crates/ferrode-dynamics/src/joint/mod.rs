//! Joints: their common data, life cycle, and one file per type.
//!
//! A joint type is a struct with the joint's own data (anchors and axes in body coordinates, limits and motors) that
//! implements [`JointData`]. Callers reach it through [`JointRef`] and [`JointMut`], which add the bodies at its ends.

mod amotor;
mod anchor;
mod axis;
mod ball;
mod contact;
mod dball;
mod dhinge;
mod fixed;
mod hinge;
mod hinge2;
mod limit_motor;
mod limited_axis;
mod lmotor;
mod null;
mod orientation;
mod own_softness;
mod param;
mod piston;
mod plane2d;
mod pr;
mod pu;
mod slider;
mod transmission;
mod universal;
mod universal_angles;

pub use amotor::{AMotor, AMotorMode};
pub use axis::AxisFrame;
pub use ball::Ball;
pub use contact::{Contact, Surface, SurfaceMode};
pub use dball::DBall;
pub use dhinge::DHinge;
pub use fixed::Fixed;
pub use hinge::Hinge;
pub use hinge2::Hinge2;
pub use limit_motor::{LimitMotor, LimitMotors, LimitState, OneLimitMotor};
pub use limited_axis::LimitedAxis;
pub use lmotor::LMotor;
pub use null::Null;
pub use own_softness::OwnSoftness;
pub use param::Param;
pub use piston::Piston;
pub use plane2d::Plane2D;
pub use pr::PR;
pub use pu::PU;
pub use slider::Slider;
pub use transmission::{Transmission, TransmissionMode};
pub use universal::Universal;

use crate::arena::{NIL, RawKey, key_type};
use crate::carried::Carried;
use crate::ends::{Ends, StepContext};
use crate::rows::{JointRows, RowCount, Wrench};
use crate::{BodyKey, Error, GroupKey, World};
use core::fmt;
use core::marker::PhantomData;
use ferrode_math::Vec3;

key_type!(
    /// Names a joint of a world. A stale key, or a key of another world, finds nothing.
    JointKey,
    "joint"
);

/// Which end of which joint stands in a body's joint list: twice the joint's slot, plus the end.
pub(crate) type Link = u32;

/// A joint's place in the joint list of one of its bodies.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Node {
    /// Slot of the body, or `NIL`.
    pub body: u32,
    pub next: Link,
    pub prev: Link,
}

impl Node {
    pub const DETACHED: Self = Self { body: NIL, next: NIL, prev: NIL };
}

/// Force and torque that a joint put on its bodies in the last step, world frame, torques about the centres of mass.
///
/// 1 is the joint's first body: for a joint attached as (world, body) that is the caller's second one. Forces of
/// motors pushing away from a stop are not included (ODE manual, `dJointSetFeedback`).
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct JointFeedback {
    /// Force on the first body, in newtons.
    pub force1: Vec3,
    /// Torque on the first body, in newton metres.
    pub torque1: Vec3,
    /// Force on the second body; kept as it was if there is none.
    pub force2: Vec3,
    /// Torque on the second body; kept as it was if there is none.
    pub torque2: Vec3,
}

/// A joint: what all types have in common, and the type's own data.
#[derive(Clone, Debug)]
pub(crate) struct Joint {
    pub nodes: [Node; 2],
    pub reverse: bool,
    pub enabled: bool,
    /// Whether `Substep` solves it as a part of an articulation; `None` as the settings say.
    pub exact: Option<bool>,
    /// Slot of its group, or `NIL`.
    pub group: u32,
    /// World list.
    pub next: u32,
    pub prev: u32,
    /// Few joints have it, and contacts come and go by thousands: apart, to keep them small.
    pub feedback: Option<Box<JointFeedback>>,
    pub user_data: u64,
    pub kind: JointKind,
}

/// What every joint type tells the step. Lives in the crate: joints are ODE's, users make theirs from these.
pub(crate) trait JointModel {
    /// Measures limits and counts rows (ODE's "info 1").
    fn row_count(&mut self, ends: &Ends<'_>, ctx: &StepContext) -> RowCount;

    /// Fills as many rows as were counted (ODE's "info 2"); may add forces.
    fn write_rows(&mut self, ends: &Ends<'_>, ctx: &StepContext, out: &mut JointRows<'_>);

    /// What the joint's rows are made of, if they change with the bodies' motion alone; measures limits then. Such a joint adds no forces.
    fn carried(&mut self, _ends: &Ends<'_>, _ctx: &StepContext) -> Option<Carried> {
        None
    }

    /// Recomputes relative values after the joint was attached to at least one body.
    fn attached(&mut self, _ends: &Ends<'_>) {}

    /// Sets the parameter of ODE's number `n` (0x100 a group); unknown ones are ignored, as ODE does.
    fn set_param(&mut self, _n: i32, _value: f64) {}

    /// The parameter of ODE's number `n`; unknown ones read 0.
    fn param(&self, _n: i32) -> f64 {
        0.0
    }

    /// The joint's own numbers as ODE's interchange format names them, in body coordinates.
    fn details(&self) -> Vec<(&'static str, Vec<f64>)> {
        Vec::new()
    }

    /// The axes that can have stops, of an attached joint.
    fn limited_axes(&self, _ends: &Ends<'_>) -> Vec<LimitedAxis> {
        Vec::new()
    }

    /// Position error that is left, as the largest of metres and radians; for reports.
    fn error(&self, _ends: &Ends<'_>) -> JointError {
        JointError::default()
    }
}

/// How far a joint's bodies are from where it wants them.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct JointError {
    /// Distance in metres.
    pub position: f64,
    /// Angle in radians.
    pub angle: f64,
}

/// Declares the joint types: the enum of data, the enum of types, and the way from a type to its data.
macro_rules! joint_types {
    ($($(#[$doc:meta])* $name:ident = $number:literal, $word:literal, $two:literal;)+) => {
        /// The types of joints, with ODE's numbers.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
        #[repr(u8)]
        #[non_exhaustive]
        pub enum JointType {
            $($(#[$doc])* $name = $number,)+
        }

        impl JointType {
            /// All types, in the order of their numbers.
            pub const ALL: &[Self] = &[$(Self::$name),+];

            /// ODE's number of the type.
            pub const fn number(self) -> i32 {
                self as i32
            }

            /// Whether the joint can't be attached to a single body.
            pub const fn needs_two_bodies(self) -> bool {
                match self { $(Self::$name => $two,)+ }
            }
        }

        impl fmt::Display for JointType {
            fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str(match self { $(Self::$name => $word,)+ })
            }
        }

        /// A joint's own data, by type.
        #[derive(Clone, Debug)]
        pub(crate) enum JointKind {
            $($name(Box<$name>),)+
        }

        impl JointKind {
            pub fn joint_type(&self) -> JointType {
                match self { $(Self::$name(_) => JointType::$name,)+ }
            }

            pub fn model(&self) -> &dyn JointModel {
                match self { $(Self::$name(data) => &**data,)+ }
            }

            #[inline]
            pub fn model_mut(&mut self) -> &mut dyn JointModel {
                match self { $(Self::$name(data) => &mut **data,)+ }
            }

            /// A joint of the given type with ODE's defaults; `None` for contacts, which need a contact.
            pub fn new(joint_type: JointType, erp: f64, cfm: f64) -> Self {
                match joint_type { $(JointType::$name => Self::$name(Box::new($name::new(erp, cfm))),)+ }
            }
        }

        $(
            impl sealed::Sealed for $name {}
            impl JointData for $name {
                const TYPE: JointType = JointType::$name;
                fn from_kind(kind: sealed::Kind<'_>) -> Option<&Self> {
                    match kind.0 { JointKind::$name(data) => Some(data), _ => None }
                }
                fn from_kind_mut(kind: sealed::KindMut<'_>) -> Option<&mut Self> {
                    match kind.0 { JointKind::$name(data) => Some(data), _ => None }
                }
            }
        )+
    };
}

joint_types! {
    /// Ball and socket.
    Ball = 1, "ball", false;
    /// Rotation about one axis.
    Hinge = 2, "hinge", false;
    /// Translation along one axis.
    Slider = 3, "slider", false;
    /// Non-penetration and friction.
    Contact = 4, "contact", false;
    /// Rotation about two perpendicular axes.
    Universal = 5, "universal", false;
    /// Two hinges in series, with suspension: a car's wheel.
    Hinge2 = 6, "hinge-2", true;
    /// Glue.
    Fixed = 7, "fixed", false;
    /// No constraint; only connects.
    Null = 8, "null", false;
    /// Motors and limits for relative rotation.
    AMotor = 9, "angular motor", false;
    /// Motors for relative translation.
    LMotor = 10, "linear motor", false;
    /// Keeps a body in the plane z = 0.
    Plane2D = 11, "plane-2d", false;
    /// Prismatic and rotoide.
    PR = 12, "prismatic-rotoide", false;
    /// Prismatic and universal.
    PU = 13, "prismatic-universal", false;
    /// Translation along and rotation about one axis.
    Piston = 14, "piston", false;
    /// Two anchors at a constant distance.
    DBall = 15, "double ball", false;
    /// Two parallel hinge axes at a constant distance.
    DHinge = 16, "double hinge", false;
    /// Gears, bevel gears, chain drive.
    Transmission = 17, "transmission", true;
}

mod sealed {
    use super::JointKind;
    pub trait Sealed {}
    pub struct Kind<'a>(pub(crate) &'a JointKind);
    pub struct KindMut<'a>(pub(crate) &'a mut JointKind);
}

/// The data of one joint type. Implemented by the types of this crate only.
pub trait JointData: sealed::Sealed + Sized {
    /// The type.
    const TYPE: JointType;
    #[doc(hidden)]
    fn from_kind(kind: sealed::Kind<'_>) -> Option<&Self>;
    #[doc(hidden)]
    fn from_kind_mut(kind: sealed::KindMut<'_>) -> Option<&mut Self>;
}

impl Joint {
    #[inline]
    pub fn new(kind: JointKind) -> Self {
        Self {
            nodes: [Node::DETACHED; 2],
            reverse: false,
            enabled: true,
            exact: None,
            group: NIL,
            next: NIL,
            prev: NIL,
            feedback: None,
            user_data: 0,
            kind,
        }
    }
}

/// A joint of a known type, with the bodies at its ends, to read.
#[derive(Debug)]
pub struct JointRef<'w, J> {
    pub(crate) world: &'w World,
    pub(crate) index: u32,
    pub(crate) data: &'w J,
}

impl<J> Clone for JointRef<'_, J> {
    fn clone(&self) -> Self {
        *self
    }
}

impl<J> Copy for JointRef<'_, J> {}

/// A joint of a known type, with the bodies at its ends, to change.
#[derive(Debug)]
pub struct JointMut<'w, J> {
    pub(crate) world: &'w mut World,
    pub(crate) index: u32,
    pub(crate) data: PhantomData<J>,
}

impl<'w, J: JointData> JointRef<'w, J> {
    /// The joint's key.
    pub fn key(&self) -> JointKey {
        JointKey(self.world.joints.key_of(self.index))
    }

    pub(crate) fn ends(&self) -> Ends<'w> {
        self.world.ends_of(self.index)
    }

    /// The error unless the joint is attached to a body.
    pub(crate) fn require_attached(&self, what: &'static str) -> Result<(), Error> {
        require_attached(&self.ends(), self.key(), what)
    }
}

fn require_attached(ends: &Ends<'_>, joint: JointKey, what: &'static str) -> Result<(), Error> {
    if ends.first.is_some() { Ok(()) } else { Err(Error::NotAttached { joint, what }) }
}

impl<J: JointData> JointMut<'_, J> {
    /// The joint's key.
    pub fn key(&self) -> JointKey {
        JointKey(self.world.joints.key_of(self.index))
    }

    /// The same joint, to read.
    pub fn as_ref(&self) -> JointRef<'_, J> {
        let kind = &self.world.joints.at(self.index).kind;
        let data = J::from_kind(sealed::Kind(kind)).expect("a JointMut is made for joints of its type only");
        JointRef { world: self.world, index: self.index, data }
    }

    /// The joint's data and the bodies at its ends.
    pub(crate) fn parts(&mut self) -> (&mut J, Ends<'_>) {
        let joint = self.world.joints.at_mut(self.index);
        let ends = crate::world::ends_in(&self.world.bodies, joint);
        let data = J::from_kind_mut(sealed::KindMut(&mut joint.kind))
            .expect("a JointMut is made for joints of its type");
        (data, ends)
    }

    /// As [`JointMut::parts`], or the error unless the joint is attached to a body.
    pub(crate) fn attached_parts(&mut self, what: &'static str) -> Result<(&mut J, Ends<'_>), Error> {
        let key = self.key();
        let (data, ends) = self.parts();
        require_attached(&ends, key, what)?;
        Ok((data, ends))
    }

    /// Adds a force and torque to the accumulators of each of the joint's bodies.
    pub(crate) fn add_wrenches(&mut self, wrenches: [Wrench; 2]) {
        let bodies = self.world.joints.at(self.index).nodes.map(|n| n.body);
        for (body, wrench) in bodies.into_iter().zip(wrenches) {
            if body != NIL {
                let body = self.world.bodies.at_mut(body);
                body.force += wrench.force;
                body.torque += wrench.torque;
            }
        }
    }

    /// Adds a torque to the first body and the opposite one to the second.
    pub(crate) fn add_opposite_torques(&mut self, torque: Vec3) {
        let wrench = |torque| Wrench { force: Vec3::ZERO, torque };
        self.add_wrenches([wrench(torque), wrench(-torque)]);
    }

    /// Says whether `Substep` solves the joint exactly, as a part of an articulation: see [`World::set_joint_exact`].
    pub fn set_exact(&mut self, exact: Option<bool>) -> &mut Self {
        self.world.joints.at_mut(self.index).exact = exact;
        self
    }

    /// Attaches the joint to its bodies; `None` stands for the static world, two `None` for limbo.
    ///
    /// # Errors
    /// As [`World::attach`].
    pub fn attach(&mut self, first: Option<BodyKey>, second: Option<BodyKey>) -> Result<&mut Self, Error> {
        self.world.attach(self.key(), first, second)?;
        Ok(self)
    }
}

impl World {
    /// Creates a joint in limbo, with ODE's defaults; joint-local ERP and CFM are the world's of this moment.
    ///
    /// A joint in a group is destroyed by emptying the group.
    ///
    /// # Errors
    /// [`Error::NoSuchGroup`].
    ///
    /// # Example
    /// ```
    /// use ferrode_dynamics::{Hinge, World};
    /// use ferrode_math::Vec3;
    /// # fn main() -> Result<(), ferrode_dynamics::Error> {
    /// let mut world = World::new();
    /// let door = world.create_body();
    /// let hinge = world.create_joint::<Hinge>(None)?;
    /// world.attach(hinge, Some(door), None)?;
    /// world.joint_mut::<Hinge>(hinge)?.set_anchor(Vec3::new(-0.5, 0.0, 0.0))?;
    /// world.joint_mut::<Hinge>(hinge)?.set_axis(Vec3::Z)?;
    /// assert_eq!(world.joint::<Hinge>(hinge)?.angle(), 0.0);
    /// # Ok(()) }
    /// ```
    pub fn create_joint<J: JointData>(&mut self, group: Option<GroupKey>) -> Result<JointKey, Error> {
        self.create_joint_of_type(J::TYPE, group)
    }

    /// As [`World::create_joint`], with the type as a value. A contact made so has a zero normal and no friction.
    ///
    /// # Errors
    /// [`Error::NoSuchGroup`].
    pub fn create_joint_of_type(
        &mut self,
        joint_type: JointType,
        group: Option<GroupKey>,
    ) -> Result<JointKey, Error> {
        let kind = JointKind::new(joint_type, self.erp(), self.cfm());
        self.insert_joint(kind, group)
    }

    /// Creates a contact joint in limbo; the contact is copied (ODE manual, `dJointCreateContact`).
    ///
    /// # Errors
    /// [`Error::NoSuchGroup`]; [`Error::NotFinite`] if position, normal or depth are not finite.
    pub fn create_contact(&mut self, group: Option<GroupKey>, contact: &Contact) -> Result<JointKey, Error> {
        contact.check()?;
        let contact = self.contact_box(|spare| spare.clone_from(contact));
        self.insert_joint(JointKind::Contact(contact), group)
    }

    /// The joint, to read it by its type.
    ///
    /// # Errors
    /// [`Error::NoSuchJoint`], [`Error::WrongJointType`].
    pub fn joint<J: JointData>(&self, joint: JointKey) -> Result<JointRef<'_, J>, Error> {
        let index = self.joint_index(joint)?;
        let kind = &self.joints.at(index).kind;
        match J::from_kind(sealed::Kind(kind)) {
            Some(data) => Ok(JointRef { world: self, index, data }),
            None => Err(Error::WrongJointType { joint, found: kind.joint_type(), expected: J::TYPE }),
        }
    }

    /// The joint, to change it by its type.
    ///
    /// # Errors
    /// [`Error::NoSuchJoint`], [`Error::WrongJointType`].
    pub fn joint_mut<J: JointData>(&mut self, joint: JointKey) -> Result<JointMut<'_, J>, Error> {
        let index = self.joint::<J>(joint)?.index;
        Ok(JointMut { world: self, index, data: PhantomData })
    }

    /// Sets a parameter by name and group: 1 for the first axis, 2 for the second, 3 for the third.
    ///
    /// A parameter that this type of joint does not know is ignored, as are a negative `FMax` and a fudge factor
    /// outside 0 … 1 (ODE manual, "parameter functions").
    ///
    /// # Errors
    /// [`Error::NoSuchJoint`]; [`Error::OutOfRange`] for NaN, or a group other than 1, 2, 3.
    pub fn set_joint_param(
        &mut self,
        joint: JointKey,
        param: Param,
        group: usize,
        value: f64,
    ) -> Result<(), Error> {
        crate::error::not_nan(param.name(), value)?;
        let n = param.number_in_group(group)?;
        let index = self.joint_index(joint)?;
        self.joints.at_mut(index).kind.model_mut().set_param(n, value);
        Ok(())
    }

    /// The parameter of a name and group; 0 if this type of joint does not know it.
    ///
    /// # Errors
    /// [`Error::NoSuchJoint`]; [`Error::OutOfRange`] for a group other than 1, 2, 3.
    pub fn joint_param(&self, joint: JointKey, param: Param, group: usize) -> Result<f64, Error> {
        let n = param.number_in_group(group)?;
        Ok(self.joints.at(self.joint_index(joint)?).kind.model().param(n))
    }

    /// How far the joint's bodies are from where it wants them.
    ///
    /// # Errors
    /// [`Error::NoSuchJoint`].
    pub fn joint_error(&self, joint: JointKey) -> Result<JointError, Error> {
        let index = self.joint_index(joint)?;
        Ok(self.joints.at(index).kind.model().error(&self.ends_of(index)))
    }

    pub(crate) fn joint_index(&self, joint: JointKey) -> Result<u32, Error> {
        self.joints.index_of(joint.0).ok_or(Error::NoSuchJoint(joint))
    }

    pub(crate) fn joint_key(&self, index: u32) -> JointKey {
        JointKey(RawKey { ..self.joints.key_of(index) })
    }
}
