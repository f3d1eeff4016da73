//! Worlds that no file describes: names for what a program built.

use ferrode::{BodyKey, Hinge, Hinge2, JointKey, JointType, Pose, Slider, Universal, Vec3, World};
use ferrode_math::Mat3;

use super::NamedWorld;
use super::bodies::BuiltLink;
use super::connect::{BuiltJoint, Form, Turns};
use crate::description::{
    Axis, Body, Inertial, Joint, JointAdvanced, JointKind, Limits, Link, LinkId, Model, ModelId, Physics,
    Scene,
};
use crate::source::{Origin, Source};

impl NamedWorld {
    /// Takes a world that a program built, to be stepped by `step_size` seconds, and names what is in it: each body is a model
    /// of one link, called by the shape of its first geom and a number (`Cuboid 3`), and each joint of a type that files
    /// have is called by its type and a number. Joints of other types work, but have no name.
    ///
    /// [`NamedWorld::scene`] describes the world for those who look things up; it is not enough to build it again.
    pub fn of_world(world: World, step_size: f64, name: &str) -> Self {
        let origin = Origin::new(&Source::from_text(name, ""), 0..0, "world");
        let mut scene = Scene {
            name: Some(name.to_owned()),
            gravity: world.gravity(),
            physics: Physics { max_step_size: step_size, ..Physics::default() },
            models: Vec::new(),
            links: Vec::new(),
            joints: Vec::new(),
            frames: Vec::new(),
        };
        let (mut links, mut joints) = (Vec::new(), Vec::new());
        let bodies: Vec<BodyKey> = world.bodies().map(|(key, _)| key).collect();
        // The world lists the newest first; people count from the first that was made.
        for (number, key) in bodies.into_iter().rev().enumerate() {
            let model = ModelId(number);
            let link = link(&world, key, model, number, &origin);
            scene.models.push(Model {
                name: link.name.clone(),
                parent: None,
                pose: link.pose,
                is_static: false,
                allow_auto_disable: false,
                canonical_link: Some(LinkId(number)),
                origin: origin.clone(),
            });
            scene.links.push(link);
            let geoms = world.body_geoms(key).map(<[_]>::to_vec).unwrap_or_default();
            links.push(BuiltLink { body: Some(key), geoms });
        }
        let keys: Vec<JointKey> = world.joints().collect();
        for key in keys.into_iter().rev() {
            let found = joint(&world, key, &links, scene.joints.len(), &origin);
            let Some((described, built)) = found else { continue };
            scene.joints.push(described);
            joints.push(Some(built));
        }
        Self {
            world,
            scene,
            warnings: Vec::new(),
            step_size,
            links,
            joints,
            passive: Vec::new(),
            couplings: Vec::new(),
        }
    }
}

fn link(world: &World, key: BodyKey, model: ModelId, number: usize, origin: &Origin) -> Link {
    let body = world.body(key).ok();
    let mass = body.map(|body| *body.mass());
    let first = world.body_geoms(key).ok().and_then(|geoms| geoms.first().copied());
    let shape = first.and_then(|geom| world.geom(geom).ok()).map(|geom| format!("{:?}", geom.shape().kind()));
    Link {
        name: format!("{} {}", shape.as_deref().unwrap_or("Body"), number + 1),
        model,
        pose: body.map_or(Pose::IDENTITY, |body| body.pose()),
        inertial: Inertial {
            mass: mass.map_or(0.0, |mass| mass.mass),
            pose: Pose::IDENTITY,
            inertia: mass.map_or(Mat3::ZERO, |mass| mass.inertia),
        },
        collisions: Vec::new(),
        gravity: body.is_none_or(|body| body.gravity_mode()),
        kinematic: body.is_some_and(|body| body.is_kinematic()),
        self_collide: true,
        linear_damping: 0.0,
        angular_damping: 0.0,
        origin: origin.clone(),
    }
}

/// A joint of a type that files have, described and as it is.
fn joint(
    world: &World,
    key: JointKey,
    links: &[BuiltLink],
    number: usize,
    origin: &Origin,
) -> Option<(Joint, BuiltJoint)> {
    let [first, second] = world.joint_bodies(key).ok()?;
    let (kind, form, axes) = match world.joint_type(key).ok()? {
        JointType::Hinge => {
            (JointKind::Revolute, Form::Hinge, [Some(world.joint::<Hinge>(key).ok()?.axis()), None])
        }
        JointType::Slider => {
            (JointKind::Prismatic, Form::Slider, [Some(world.joint::<Slider>(key).ok()?.axis()), None])
        }
        JointType::Universal => {
            let joint = world.joint::<Universal>(key).ok()?;
            // The file's first axis is in the parent, the engine's second body.
            (JointKind::Universal, Form::Universal, [Some(joint.axis2()), Some(joint.axis1())])
        }
        JointType::Hinge2 => {
            let joint = world.joint::<Hinge2>(key).ok()?;
            (JointKind::Revolute2, Form::Hinge2, [Some(-joint.axis1()), Some(joint.axis2())])
        }
        JointType::Ball => (JointKind::Ball, Form::Ball, [None; 2]),
        JointType::Fixed => (JointKind::Fixed, Form::Fixed, [None; 2]),
        _ => return None,
    };
    // The chassis of a hinge-2 comes first, and is the parent; the others have the child first.
    let (child, parent) = if form == Form::Hinge2 { (second, first) } else { (first, second) };
    let place = |body: Option<BodyKey>| match links.iter().position(|link| link.body == body) {
        Some(index) if body.is_some() => Body::Link(LinkId(index)),
        _ => Body::World,
    };
    let axis = |direction: Vec3| Axis {
        direction,
        limits: Limits::default(),
        damping: 0.0,
        friction: 0.0,
        spring: None,
        mimic: None,
    };
    let described = Joint {
        name: format!("{kind:?} {}", number + 1),
        model: None,
        kind,
        parent: place(parent),
        child: place(child),
        pose: Pose::IDENTITY,
        axis: axes[0].map(axis),
        axis2: axes[1].map(axis),
        advanced: JointAdvanced::default(),
        origin: origin.clone(),
    };
    let built = BuiltJoint { key, form, child, parent, planar: None, turns: [Turns::default(); 2] };
    Some((described, built))
}
