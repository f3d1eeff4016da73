//! What a world or robot file says, free of its format: the input of the world builder, and something to look
//! into without building a world.
//!
//! All references are resolved: poses are in the world frame (or the link's, where said so), axes are unit
//! vectors, joints name links by [`LinkId`]. Lengths are metres, masses kilograms, angles radians, times seconds.

mod geometry;
mod joint;
mod link;
mod physics;
mod surface;

pub use geometry::{Geometry, Mesh};
pub use joint::{Axis, Body, Joint, JointAdvanced, JointKind, Limits, Mimic, Spring, StopSoftness};
pub use link::{Collision, Inertial, Link};
pub use physics::{FrictionModel, OdePhysics, OdeSolver, Physics};
pub use surface::{Bounce, ContactSurface, Friction, Surface, Torsional};

use ferrode_math::{Pose, Vec3};

use crate::source::Origin;

/// The place of a [`Model`] in [`Scene::models`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct ModelId(pub usize);

/// The place of a [`Link`] in [`Scene::links`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct LinkId(pub usize);

/// The place of a [`Joint`] in [`Scene::joints`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct JointId(pub usize);

/// A whole file: the world's settings and everything in it.
///
/// Models, links, joints and frames stand in the order of the file, a model before those nested in it. Their
/// names are scoped as the SDF specification scopes them: `robot::arm::elbow` is `elbow` in the model `arm` in the
/// model `robot`.
#[derive(Clone, Debug)]
pub struct Scene {
    /// The world's name; `None` for a file that holds a model only.
    pub name: Option<String>,
    /// Acceleration of gravity, m/s².
    pub gravity: Vec3,
    /// Step size and solver.
    pub physics: Physics,
    /// The models, nested ones included.
    pub models: Vec<Model>,
    /// The links of all models.
    pub links: Vec<Link>,
    /// The joints of all models, and of the world.
    pub joints: Vec<Joint>,
    /// The explicit frames of all models and of the world.
    pub frames: Vec<Frame>,
}

/// A model: links and joints that belong together.
#[derive(Clone, Debug)]
pub struct Model {
    /// Scoped name.
    pub name: String,
    /// The model this one is nested in.
    pub parent: Option<ModelId>,
    /// The model frame, in the world.
    pub pose: Pose,
    /// It cannot move. Holds for the models nested in it as well.
    pub is_static: bool,
    /// It may be put to sleep when it is at rest.
    pub allow_auto_disable: bool,
    /// The link that the model frame moves with; `None` for a model without links.
    pub canonical_link: Option<LinkId>,
    /// Where the file says so.
    pub origin: Origin,
}

/// A named frame.
#[derive(Clone, Debug)]
pub struct Frame {
    /// Scoped name.
    pub name: String,
    /// What it moves with.
    pub attached_to: Body,
    /// The frame, in the world.
    pub pose: Pose,
}

impl Scene {
    /// The link of this name: scoped (`robot::base`), or bare (`base`) if only one link has it.
    pub fn link(&self, name: &str) -> Option<&Link> {
        find(&self.links, name, |link| &link.name)
    }

    /// The joint of this name: scoped (`robot::elbow`), or bare (`elbow`) if only one joint has it.
    pub fn joint(&self, name: &str) -> Option<&Joint> {
        find(&self.joints, name, |joint| &joint.name)
    }

    /// The model of this name: scoped, or bare if only one model has it.
    pub fn model(&self, name: &str) -> Option<&Model> {
        find(&self.models, name, |model| &model.name)
    }

    /// The frame of this name: scoped, or bare if only one frame has it.
    pub fn frame(&self, name: &str) -> Option<&Frame> {
        find(&self.frames, name, |frame| &frame.name)
    }

    /// Whether a link belongs to a static model.
    pub fn is_static(&self, link: LinkId) -> bool {
        self.links
            .get(link.0)
            .and_then(|link| self.models.get(link.model.0))
            .is_some_and(|model| model.is_static)
    }

    /// Moves all models that are not static, with what is in them. Models that are joined to the world move with
    /// their joints.
    pub fn translate_moving(&mut self, by: Vec3) {
        let moves: Vec<bool> = self.models.iter().map(|model| !model.is_static).collect();
        for (model, _) in self.models.iter_mut().zip(&moves).filter(|(_, moves)| **moves) {
            model.pose.position += by;
        }
        let moves = |model: ModelId| moves.get(model.0).copied().unwrap_or(false);
        for link in self.links.iter_mut().filter(|link| moves(link.model)) {
            link.pose.position += by;
        }
        for joint in self.joints.iter_mut().filter(|joint| joint.model.is_none_or(moves)) {
            joint.pose.position += by;
        }
        for frame in &mut self.frames {
            if let Body::Link(LinkId(link)) = frame.attached_to
                && self.links.get(link).is_some_and(|link| moves(link.model))
            {
                frame.pose.position += by;
            }
        }
    }

    /// The masses of all links that can move, added up, kg.
    pub fn moving_mass(&self) -> f64 {
        let moving = self.links.iter().enumerate().filter(|&(index, _)| !self.is_static(LinkId(index)));
        moving.map(|(_, link)| link.inertial.mass).sum()
    }
}

/// The item of this scoped name, or else the only one whose scoped name ends in `::name`.
pub(crate) fn find<'a, T>(items: &'a [T], name: &str, name_of: impl Fn(&T) -> &str) -> Option<&'a T> {
    find_index(items, name, name_of).map(|index| &items[index])
}

/// The place of what [`find`] finds.
pub(crate) fn find_index<T>(items: &[T], name: &str, name_of: impl Fn(&T) -> &str) -> Option<usize> {
    if let Some(exact) = items.iter().position(|item| name_of(item) == name) {
        return Some(exact);
    }
    let ends_so = |item: &T| name_of(item).strip_suffix(name).is_some_and(|scope| scope.ends_with("::"));
    let first = items.iter().position(ends_so)?;
    let alone = !items[first + 1..].iter().any(ends_so);
    alone.then_some(first)
}

#[cfg(test)]
mod tests {
    use super::find;

    #[test]
    fn bare_names_are_found_when_they_are_the_only_ones() {
        let names = ["a::x", "b::x", "b::y", "xy", "y2::z::w"];
        let look = |name| find(&names, name, |n| n).copied();
        assert_eq!(look("a::x"), Some("a::x"));
        assert_eq!(look("x"), None);
        assert_eq!(look("y"), Some("b::y"));
        assert_eq!(look("z::w"), Some("y2::z::w"));
        assert_eq!(look("::w"), None);
        assert_eq!(look(""), None);
    }
}
