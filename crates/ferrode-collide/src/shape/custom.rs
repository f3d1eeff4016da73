use crate::narrow::Distance;
use crate::{Contacts, Frame, Shape};
use core::fmt;
use ferrode_math::{Aabb, Vec3};
use std::sync::Arc;

/// A kind of shape of one's own (ODE's user classes).
///
/// ```
/// use ferrode_collide::{
///     CollideOptions, Contacts, Custom, CustomShape, Frame, Shape, Sphere, ray_cast, narrow,
/// };
/// use ferrode_math::{Aabb, Pose, Vec3};
///
/// /// All that is further from its centre than a radius: a room to stay in.
/// #[derive(Debug)]
/// struct Hollow(f64);
///
/// impl CustomShape for Hollow {
///     fn aabb(&self, _: &Frame) -> Aabb {
///         Aabb::EVERYTHING
///     }
///
///     fn collide(&self, frame: &Frame, other: &Shape, at: &Frame, out: &mut Contacts<'_>) -> bool {
///         let Shape::Sphere(ball) = other else { return false };
///         let from = at.position - frame.position;
///         let (depth, outward) = (from.length() + ball.radius() - self.0, from.normalized_or(Vec3::Z));
///         if depth >= 0.0 {
///             out.push(frame.position + outward * self.0, outward, depth);
///         }
///         true
///     }
///
///     fn point_depth(&self, frame: &Frame, point: Vec3) -> Option<f64> {
///         Some((point - frame.position).length() - self.0)
///     }
/// }
///
/// # fn main() -> Result<(), ferrode_collide::ShapeError> {
/// let room = Shape::from(Custom::new(Hollow(10.0)));
/// let ball = Shape::from(Sphere::new(1.0)?);
/// let at = Pose::from_position(Vec3::X * 9.5);
/// let mut contacts = Vec::new();
/// // Normals point into the first shape, whichever is asked first.
/// narrow::collide((&ball, &at), (&room, &Pose::IDENTITY), CollideOptions::new(4), &mut contacts);
/// assert_eq!((contacts[0].point.depth, contacts[0].point.normal), (0.5, -Vec3::X));
/// # Ok(()) }
/// ```
pub trait CustomShape: fmt::Debug + Send + Sync {
    /// The world box around the shape in `frame`; [`Aabb::EVERYTHING`] if it has none. It must not shrink or grow while the
    /// geom stays where it is.
    fn aabb(&self, frame: &Frame) -> Aabb;

    /// Adds the contacts with another shape, their normals into this one, and returns true; or returns false if it knows
    /// nothing of such shapes. A custom `other` is then asked in turn; other pairs do not touch. Rays are shapes, too:
    /// the depth of a hit is the distance along the ray.
    fn collide(&self, frame: &Frame, other: &Shape, other_frame: &Frame, out: &mut Contacts<'_>) -> bool;

    /// The point furthest along `direction`, of any length but zero, both in the shape's own coordinates. For convex shapes of
    /// finite size: distances, nearest points and casts are then found as for any other convex body. `None`, for every
    /// direction, if the shape is not convex.
    fn support(&self, _direction: Vec3) -> Option<Vec3> {
        None
    }

    /// The distance of this shape, the first, from another: for shapes that are not convex, or that know better. Casts of such
    /// shapes, and onto them, go as far as nothing is nearer and look again, so it must never be too long.
    ///
    /// `None` if it knows nothing of such shapes: then a convex shape is asked for its [support](Self::support), and the
    /// distance of a ball follows from the [depth of its centre](Self::point_depth).
    fn distance(&self, _frame: &Frame, _other: &Shape, _other_frame: &Frame) -> Option<Distance> {
        None
    }

    /// Depth of a point in metres: the distance to the surface, negative outside. `None` if the shape cannot tell.
    fn point_depth(&self, _frame: &Frame, _point: Vec3) -> Option<f64> {
        None
    }

    /// Volume in cubic metres; zero for surfaces.
    fn volume(&self) -> f64 {
        0.0
    }
}

/// A [`CustomShape`] as a shape among others. Copies share it, and are equal.
#[derive(Clone, Debug)]
pub struct Custom(Arc<dyn CustomShape>);

impl Custom {
    /// Wraps a shape of one's own.
    pub fn new(shape: impl CustomShape + 'static) -> Self {
        Self(Arc::new(shape))
    }

    /// The shape.
    pub fn get(&self) -> &dyn CustomShape {
        &*self.0
    }
}

impl PartialEq for Custom {
    fn eq(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.0, &other.0)
    }
}
