use super::{Shape, ShapeError};
use crate::Frame;
use crate::space::tree::AabbTree;
use ferrode_math::{Aabb, Pose};
use std::sync::Arc;

/// Several shapes as one, each at its own pose. Copies share their data.
///
/// ```
/// use ferrode_collide::{CollideOptions, Compound, Cuboid, Shape, Sphere, narrow};
/// use ferrode_math::{Pose, Vec3};
///
/// # fn main() -> Result<(), ferrode_collide::ShapeError> {
/// // A dumb-bell: two balls and a bar.
/// let ball = Shape::from(Sphere::new(0.5)?);
/// let bar = Shape::from(Cuboid::new(Vec3::new(2.0, 0.1, 0.1))?);
/// let at = |x: f64| Pose::from_position(Vec3::X * x);
/// let dumb_bell = Shape::from(Compound::new([(ball.clone(), at(-1.0)), (bar, at(0.0)), (ball.clone(), at(1.0))])?);
/// let mut contacts = Vec::new();
/// let above = Pose::from_position(Vec3::new(1.0, 0.0, 0.9));
/// narrow::collide((&ball, &above), (&dumb_bell, &Pose::IDENTITY), CollideOptions::new(4), &mut contacts);
/// assert!(contacts.len() == 1 && (contacts[0].point.depth - 0.1).abs() < 1e-12);
/// assert_eq!(contacts[0].side2, 2); // the third part
/// # Ok(()) }
/// ```
#[derive(Clone, Debug)]
pub struct Compound(Arc<Parts>);

#[derive(Debug)]
struct Parts {
    parts: Vec<(Shape, Frame)>,
    poses: Vec<Pose>,
    tree: AabbTree,
    reach: f64,
}

impl PartialEq for Compound {
    fn eq(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.0, &other.0)
            || (self.0.poses == other.0.poses
                && self.0.parts.iter().map(|p| &p.0).eq(other.0.parts.iter().map(|p| &p.0)))
    }
}

impl Compound {
    /// The union of shapes at poses in the compound's own coordinates. Compounds among them count by their parts.
    ///
    /// # Errors
    /// If there are no parts, a pose is not finite, or a part has no end or is a ray.
    pub fn new(parts: impl IntoIterator<Item = (Shape, Pose)>) -> Result<Self, ShapeError> {
        let (mut all, mut poses) = (Vec::new(), Vec::new());
        let mut add = |shape: Shape, pose: Pose| {
            all.push((shape, Frame::from(&pose)));
            poses.push(pose);
        };
        for (shape, pose) in parts {
            match shape {
                Shape::Compound(inner) => {
                    for (i, (part, _)) in inner.0.parts.iter().enumerate() {
                        add(part.clone(), pose * inner.0.poses[i]);
                    }
                }
                other => add(other, pose),
            }
        }
        let wrong = |what, value| Err(ShapeError { what, value });
        if all.is_empty() {
            return wrong("number of parts of a compound", 0.0);
        }
        let mut boxes = Vec::with_capacity(all.len());
        for (i, (shape, frame)) in all.iter().enumerate() {
            let turn = frame.rotation.rows.concat().iter().sum::<f64>();
            if !(frame.position.is_finite() && turn.is_finite()) {
                return wrong("pose of a compound's part", i as f64);
            }
            if matches!(shape, Shape::Plane(_) | Shape::Ray(_)) {
                return wrong("plane or ray as a compound's part", i as f64);
            }
            let around = shape.aabb_in(frame);
            if !(around.is_finite() && around.min.abs().max(around.max.abs()).abs_max() <= super::LARGEST) {
                return wrong("extent of a compound's part", i as f64);
            }
            boxes.push(around);
        }
        let bounds = boxes.iter().fold(Aabb::EMPTY, |b, x| b.union(x));
        let reach = bounds.min.abs().max(bounds.max.abs()).length();
        Ok(Self(Arc::new(Parts { parts: all, poses, tree: AabbTree::build(&boxes), reach })))
    }

    /// Number of parts; a contact's `side1` or `side2` counts them from 0.
    pub fn len(&self) -> usize {
        self.0.parts.len()
    }

    /// Whether there are no parts: never.
    pub fn is_empty(&self) -> bool {
        self.0.parts.is_empty()
    }

    /// The parts, and their poses in the compound's coordinates.
    pub fn parts(&self) -> impl ExactSizeIterator<Item = (&Shape, &Pose)> {
        self.0.parts.iter().map(|p| &p.0).zip(&self.0.poses)
    }

    /// Part `i`, and its frame in the compound's coordinates.
    pub(crate) fn part(&self, i: u32) -> (&Shape, &Frame) {
        let (shape, frame) = &self.0.parts[i as usize];
        (shape, frame)
    }

    /// Calls `found` with the number of each part whose box, in the compound's coordinates, meets `around`.
    pub(crate) fn parts_in(&self, around: &Aabb, mut found: impl FnMut(u32)) {
        if around.is_finite() {
            self.0.tree.query(around, found);
        } else {
            (0..self.len() as u32).for_each(&mut found);
        }
    }

    /// Distance from the origin of its frame that no part is beyond.
    #[inline]
    pub(crate) fn reach(&self) -> f64 {
        self.0.reach
    }

    /// Sum of the volumes of the parts in cubic metres: where they overlap, it counts twice.
    pub fn volume(&self) -> f64 {
        self.0.parts.iter().map(|p| p.0.volume()).sum()
    }

    /// The world box around the parts.
    pub fn aabb(&self, frame: &Frame) -> Aabb {
        self.0.parts.iter().fold(Aabb::EMPTY, |b, (shape, at)| b.union(&shape.aabb_in(&within(frame, at))))
    }
}

/// The frame `inner`, given in the coordinates of `outer`, in the world.
pub(crate) fn within(outer: &Frame, inner: &Frame) -> Frame {
    Frame::new(outer.point_to_world(inner.position), outer.rotation * inner.rotation)
}

/// A shape's frame in the coordinates of another.
pub(crate) fn seen_from(outer: &Frame, frame: &Frame) -> Frame {
    Frame::new(outer.point_to_local(frame.position), outer.rotation.transpose() * frame.rotation)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Custom, CustomShape, Plane, Ray, Sphere};
    use ferrode_math::Vec3;

    #[derive(Debug)]
    struct Endless;

    impl CustomShape for Endless {
        fn aabb(&self, _: &Frame) -> Aabb {
            Aabb::EVERYTHING
        }

        fn collide(&self, _: &Frame, _: &Shape, _: &Frame, _: &mut crate::Contacts<'_>) -> bool {
            false
        }
    }

    #[test]
    fn what_cannot_be_a_part_is_an_error() {
        let ball = Shape::from(Sphere::new(1.0).unwrap());
        assert!(Compound::new([]).is_err());
        let nowhere = Pose::from_position(Vec3::X * f64::NAN);
        assert!(Compound::new([(ball.clone(), nowhere)]).is_err());
        for odd in [
            Shape::from(Plane::new(Vec3::Z, 0.0).unwrap()),
            Shape::from(Ray::new(1.0).unwrap()),
            Custom::new(Endless).into(),
        ] {
            assert!(Compound::new([(ball.clone(), Pose::IDENTITY), (odd, Pose::IDENTITY)]).is_err());
        }
    }

    #[test]
    fn compounds_of_compounds_have_all_their_parts() {
        let ball = Shape::from(Sphere::new(1.0).unwrap());
        let at = |x: f64| Pose::from_position(Vec3::X * x);
        let two = Compound::new([(ball.clone(), at(-1.0)), (ball.clone(), at(1.0))]).unwrap();
        let four = Compound::new([(two.clone().into(), at(-4.0)), (two.into(), at(4.0))]).unwrap();
        let places: Vec<f64> = four.parts().map(|p| p.1.position.x).collect();
        assert_eq!(places, [-5.0, -3.0, 3.0, 5.0]);
        assert_eq!(four.aabb(&Frame::IDENTITY).max.x, 6.0);
        assert!((four.volume() - 4.0 * ball.volume()).abs() < 1e-12);
    }
}
