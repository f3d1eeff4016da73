//! Reads URDF (<http://wiki.ros.org/urdf/XML>) with Gazebo's extensions
//! (<http://sdformat.org/tutorials?tut=sdformat_urdf_extensions>).

mod gazebo;
mod joint;
mod link;
mod tree;

use ferrode_math::{Pose, Vec3};

use crate::context::Context;
use crate::description::{OdePhysics, Physics};
use crate::draft::{self, Placement};
use crate::error::Result;
use crate::sdf;
use crate::xml::{Children, Element};

const ROBOT: Children = Children {
    single: &[],
    many: &["link", "joint", "gazebo"],
    silent: &["material"],
    counted: &[
        ("transmission", "transmissions"),
        ("sensor", "sensors"),
        ("ros2_control", "controller settings"),
    ],
    attributes: &["name", "version"],
};

/// Reads a file whose root element is `<robot>`.
pub(crate) fn read(root: Element<'_>, cx: &mut Context<'_>) -> Result<draft::Scene> {
    Ok(draft::Scene {
        name: None,
        gravity: sdf::GRAVITY,
        physics: physics(),
        models: vec![read_model(root, cx)?],
        joints: Vec::new(),
        frames: Vec::new(),
    })
}

/// How to step a robot: URDF says nothing of it, so the choice is ours.
///
/// A humanoid has links of 0.1 kg between links of 10 kg. With SDF's step of 1 ms and 50 sweeps the quick solver leaves the
/// joints of a falling one 2 mm apart; with these, less than 0.5 mm.
fn physics() -> Physics {
    let defaults = Physics::default();
    let ode = OdePhysics { iterations: 100, ..defaults.ode };
    Physics { max_step_size: 0.0005, ode, ..defaults }
}

/// Reads the robot as a model: its links hang on one another by their joints' origins.
pub(crate) fn read_model(root: Element<'_>, cx: &mut Context<'_>) -> Result<draft::Model> {
    root.expect(&mut cx.notes, &ROBOT);
    let mut links = root.all("link").map(|element| link::read(element, cx)).collect::<Result<Vec<_>>>()?;
    let mut joints = root.all("joint").map(|element| joint::read(element, cx)).collect::<Result<Vec<_>>>()?;
    if links.is_empty() {
        return Err(root.error("the robot has no link"));
    }
    tree::check(root, &links, &joints)?;
    tree::take_out_world(&mut links, &mut joints);
    tree::place_links(&mut links, &joints);

    let mut model = draft::Model {
        name: root.required_attribute("name")?.word()?.to_owned(),
        origin: root.origin(),
        placement: Placement::default(),
        placement_frame: None,
        canonical_link: None,
        is_static: false,
        self_collide: false,
        allow_auto_disable: true,
        links,
        // A floating joint leaves everything free: it only says where its child begins.
        joints: joints.into_iter().filter_map(joint::Joint::into_draft).collect(),
        frames: Vec::new(),
        models: Vec::new(),
        shared_names: true,
        lump_fixed: cx.options.merge_fixed_joints.then(Vec::new),
    };
    for element in root.all("gazebo") {
        gazebo::apply(element, &mut model, cx)?;
    }
    Ok(model)
}

/// `<origin xyz="…" rpy="…"/>` of an element, or no displacement.
fn read_origin(parent: Element<'_>, cx: &mut Context<'_>) -> Result<Pose> {
    let Some(origin) = parent.child("origin") else { return Ok(Pose::IDENTITY) };
    origin.expect(&mut cx.notes, &Children { attributes: &["xyz", "rpy"], ..Children::default() });
    let read = |name: &str| -> Result<[f64; 3]> {
        match origin.attribute(name).filter(|value| !value.is_empty()) {
            Some(value) => value.numbers::<3>(),
            None => Ok([0.0; 3]),
        }
    };
    let [roll, pitch, yaw] = read("rpy")?;
    Ok(Pose::new(Vec3::from_array(read("xyz")?), sdf::roll_pitch_yaw(roll, pitch, yaw)))
}
