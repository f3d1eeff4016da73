//! `<world>`: settings, models, and joints and frames outside of models.

use ferrode_math::Vec3;

use super::include::{self, Included};
use super::{GRAVITY, Version, joint, model, physics, read_name};
use crate::context::Context;
use crate::description::Physics;
use crate::draft;
use crate::error::Result;
use crate::xml::{Children, Element};

const WORLD: Children = Children {
    single: &["gravity", "wind"],
    many: &["physics", "model", "include", "joint", "frame"],
    silent: &[
        "light",
        "scene",
        "gui",
        "audio",
        "atmosphere",
        "magnetic_field",
        "spherical_coordinates",
        "particle_emitter",
    ],
    counted: &[("plugin", "plugins"), ("actor", "actors"), ("road", "roads")],
    attributes: &["name", "namespace"],
};

pub(super) fn read(element: Element<'_>, version: Version, cx: &mut Context<'_>) -> Result<draft::Scene> {
    element.expect(&mut cx.notes, &WORLD);
    let name = read_name(element, version)?;
    let mut scene = draft::Scene {
        name: Some(name),
        gravity: GRAVITY,
        physics: Physics::default(),
        models: Vec::new(),
        joints: Vec::new(),
        frames: Vec::new(),
    };
    let chosen = physics::chosen(element, cx)?;
    if let Some(chosen) = chosen {
        scene.physics = physics::read(chosen, cx)?;
    }
    // Up to SDF 1.5 gravity stood in <physics>.
    let gravity = element.child("gravity").or_else(|| chosen.and_then(|physics| physics.child("gravity")));
    if let Some(gravity) = gravity {
        scene.gravity = Vec3::from_array(gravity.value().numbers::<3>()?);
    }
    if let Some(wind) = element.child("wind")
        && let Some(velocity) = wind.child("linear_velocity")
        && velocity.value().numbers::<3>()? != [0.0; 3]
    {
        cx.notes.not_supported(velocity.origin(), "wind has no effect");
    }
    for child in element.children() {
        match child.name() {
            "model" => scene.models.push(model::read(child, version, 0, cx)?),
            "include" => match include::read(child, version, 0, cx)? {
                Included::Model { model, merge: false } => scene.models.push(*model),
                Included::Model { model, merge: true } => {
                    include::merge_into_world(&mut scene, *model, child)?
                }
                Included::Nothing => {}
            },
            "joint" => scene.joints.push(joint::read(child, version, cx)?),
            "frame" => scene.frames.push(model::read_frame(child, version, cx)?),
            _ => {}
        }
    }
    Ok(scene)
}
