//! A shape at a place.

use crate::filter::ALL_BITS;
use crate::space::TurnedBox;
use crate::{Frame, Shape};
use ferrode_math::{Aabb, Pose};

/// A shape, where it is, and what it may touch. A plain value that knows neither bodies nor worlds.
#[derive(Clone, Debug, PartialEq)]
pub struct Geom {
    pub(crate) shape: Shape,
    pub(crate) pose: Pose,
    pub(crate) frame: Frame,
    pub(crate) offset: Option<Pose>,
    /// What this geom is. All bits at first.
    pub(crate) category_bits: u64,
    /// What it collides with. All bits at first.
    pub(crate) collide_bits: u64,
    pub(crate) enabled: bool,
    pub(crate) body: Option<u64>,
    pub(crate) user: u64,
}

impl Geom {
    /// A geom at the origin, in all categories, enabled, on no body.
    pub fn new(shape: impl Into<Shape>) -> Self {
        Self {
            shape: shape.into(),
            pose: Pose::IDENTITY,
            frame: Frame::IDENTITY,
            offset: None,
            category_bits: ALL_BITS,
            collide_bits: ALL_BITS,
            enabled: true,
            body: None,
            user: 0,
        }
    }

    /// The same geom at another world pose. A plane has no pose; it stays where it is.
    #[must_use]
    pub fn at(mut self, pose: Pose) -> Self {
        if self.shape.is_placeable() {
            self.pose = pose;
            self.frame = Frame::from(&pose);
        }
        self
    }

    /// The same geom with other category and collide bits.
    #[must_use]
    pub fn with_bits(mut self, category: u64, collide: u64) -> Self {
        self.category_bits = category;
        self.collide_bits = collide;
        self
    }

    /// The same geom on a body: `body` is any number that tells bodies apart, `offset` the geom's pose in the body.
    /// Two geoms on one body do not collide.
    #[must_use]
    pub fn on_body(mut self, body: u64, offset: Option<Pose>) -> Self {
        self.body = Some(body);
        self.offset = offset;
        self
    }

    /// The same geom with a number for the user's own purposes.
    #[must_use]
    pub fn with_user(mut self, user: u64) -> Self {
        self.user = user;
        self
    }

    /// The shape.
    pub fn shape(&self) -> &Shape {
        &self.shape
    }

    /// World pose.
    pub fn pose(&self) -> &Pose {
        &self.pose
    }

    /// World position and rotation matrix.
    pub fn frame(&self) -> &Frame {
        &self.frame
    }

    /// Pose in the body's coordinates, if there is one.
    pub fn offset(&self) -> Option<&Pose> {
        self.offset.as_ref()
    }

    /// What this geom is.
    pub fn category_bits(&self) -> u64 {
        self.category_bits
    }

    /// What it collides with.
    pub fn collide_bits(&self) -> u64 {
        self.collide_bits
    }

    /// Whether spaces look at this geom.
    pub fn is_enabled(&self) -> bool {
        self.enabled
    }

    /// The number of the body it is on.
    pub fn body(&self) -> Option<u64> {
        self.body
    }

    /// The user's number.
    pub fn user(&self) -> u64 {
        self.user
    }

    /// A box that is turned with the geom and holds all of it, where one is known.
    pub(crate) fn turned_box(&self) -> Option<TurnedBox> {
        // What others wrote may say what it likes of its box; a field may change its heights as it is asked; compounds may have such parts.
        if matches!(self.shape, Shape::Custom(_) | Shape::Heightfield(_) | Shape::Compound(_)) {
            return None;
        }
        let local = self.shape.aabb_in(&Frame::IDENTITY);
        let frame = Frame::new(self.frame.point_to_world(local.center()), self.frame.rotation);
        let turned = TurnedBox { frame, half: local.extent() * 0.5 };
        (turned.half.is_finite() && turned.frame.position.is_finite()).then_some(turned)
    }

    /// The world box around the geom.
    pub fn aabb(&self) -> Aabb {
        self.shape.aabb_in(&self.frame)
    }
}

macro_rules! into_shape {
    ($($name:ident)*) => {$(
        impl From<crate::$name> for Shape {
            fn from(s: crate::$name) -> Self {
                Self::$name(s)
            }
        }
    )*};
}

into_shape!(Sphere Cuboid Capsule Cylinder Plane Ray Convex TriMesh Ellipsoid Cone Heightfield Custom Compound);
