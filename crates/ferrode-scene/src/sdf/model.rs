//! `<model>` and `<frame>`.

use super::include::{self, Included};
use super::{Version, joint, link, pose, read_name, reference_in};
use crate::context::Context;
use crate::draft;
use crate::error::Result;
use crate::xml::{Children, Element};

/// Models nested deeper than this are taken for a mistake, and not followed to the end of the stack.
pub(super) const DEEPEST: usize = 64;

const MODEL: Children = Children {
    single: &["pose", "static", "self_collide", "allow_auto_disable", "enable_wind"],
    many: &["link", "joint", "frame", "model", "include"],
    silent: &["gripper"],
    counted: &[("plugin", "plugins")],
    attributes: &["name", "namespace", "canonical_link", "placement_frame"],
};

const FRAME: Children = Children {
    single: &["pose"],
    many: &[],
    silent: &[],
    counted: &[],
    attributes: &["name", "attached_to"],
};

/// Reads a model. `depth` counts the models and includes around it.
pub(super) fn read(
    element: Element<'_>,
    version: Version,
    depth: usize,
    cx: &mut Context<'_>,
) -> Result<draft::Model> {
    if depth >= DEEPEST {
        return Err(element.error(format!("models are nested more than {DEEPEST} deep")));
    }
    element.expect(&mut cx.notes, &MODEL);
    let mut model = draft::Model {
        name: read_name(element, version)?,
        origin: element.origin(),
        placement: pose::read(element, cx)?,
        placement_frame: reference_in(element, "placement_frame"),
        canonical_link: reference_in(element, "canonical_link"),
        is_static: element.flag_in("static", false)?,
        self_collide: element.flag_in("self_collide", false)?,
        allow_auto_disable: element.flag_in("allow_auto_disable", true)?,
        links: Vec::new(),
        joints: Vec::new(),
        frames: Vec::new(),
        models: Vec::new(),
        shared_names: version < Version(1, 7),
        lump_fixed: None,
    };
    if element.flag_in("enable_wind", false)? {
        cx.notes.not_supported(element.required("enable_wind")?.origin(), "wind has no effect");
    }
    for child in element.children() {
        match child.name() {
            "link" => model.links.push(link::read(child, version, model.is_static, cx)?),
            "joint" => model.joints.push(joint::read(child, version, cx)?),
            "frame" => model.frames.push(read_frame(child, version, cx)?),
            "model" => model.models.push(read(child, version, depth + 1, cx)?),
            "include" => match include::read(child, version, depth + 1, cx)? {
                Included::Model { model: nested, merge: false } => model.models.push(*nested),
                Included::Model { model: nested, merge: true } => {
                    include::merge_into_model(&mut model, *nested)?
                }
                Included::Nothing => {}
            },
            _ => {}
        }
    }
    if model.links.is_empty() && model.models.is_empty() && !model.is_static {
        return Err(element.error(format!("model `{}` has no link", model.name)));
    }
    Ok(model)
}

pub(super) fn read_frame(
    element: Element<'_>,
    version: Version,
    cx: &mut Context<'_>,
) -> Result<draft::Frame> {
    element.expect(&mut cx.notes, &FRAME);
    Ok(draft::Frame {
        name: read_name(element, version)?,
        origin: element.origin(),
        attached_to: reference_in(element, "attached_to"),
        placement: pose::read(element, cx)?,
        proxy: false,
    })
}
