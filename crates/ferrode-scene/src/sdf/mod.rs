//! Reads SDFormat, versions 1.4 to 1.12 (<http://sdformat.org/spec>).

mod geometry;
mod include;
mod joint;
mod link;
mod model;
mod physics;
mod pose;
mod surface;
mod world;

pub(crate) use geometry::{positive_lengths, read_mesh_reference};
pub(crate) use joint::check_order;
pub(crate) use link::check_inertial;
pub(crate) use pose::roll_pitch_yaw;
pub(crate) use surface::read_surface;

use ferrode_math::Vec3;

use crate::context::Context;
use crate::description::Physics;
use crate::draft;
use crate::error::Result;
use crate::xml::{Children, Element};

/// The version of a file: 1 and 7 for 1.7.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) struct Version(u32, u32);

/// SDF's gravity where a file gives none, m/s².
pub(crate) const GRAVITY: Vec3 = Vec3::new(0.0, 0.0, -9.8);

const OLDEST: Version = Version(1, 4);
const NEWEST: Version = Version(1, 12);

fn read_version(root: Element<'_>, cx: &mut Context<'_>) -> Result<Version> {
    let value = root.required_attribute("version")?;
    let parsed = value.text().split_once('.').and_then(|(major, minor)| {
        // Some files say 1.6.0.
        let minor = minor.split('.').next()?;
        Some(Version(major.parse().ok()?, minor.parse().ok()?))
    });
    let Some(version) = parsed else {
        return Err(value.error(format!("`{}` is not an SDF version such as 1.7", value.text())));
    };
    if version < OLDEST {
        let message = format!("SDF {} is too old: 1.4 to 1.12 are read", value.text());
        return Err(value.error(message).with_help("`gz sdf --print` converts old files"));
    }
    if version > NEWEST {
        let message = format!("SDF {} is newer than 1.12, and read as if it were 1.12", value.text());
        cx.notes.not_understood(value.origin(), message);
        return Ok(NEWEST);
    }
    Ok(version)
}

const ROOT: Children = Children {
    single: &[],
    many: &["world", "model"],
    silent: &["light"],
    counted: &[("actor", "actors")],
    attributes: &["version"],
};

/// Reads a file whose root element is `<sdf>`.
pub(crate) fn read(root: Element<'_>, cx: &mut Context<'_>) -> Result<draft::Scene> {
    let version = read_version(root, cx)?;
    root.expect(&mut cx.notes, &ROOT);
    let mut worlds = root.all("world");
    if let Some(first) = worlds.next() {
        if let Some(second) = worlds.next() {
            let message = "a file with several worlds: the first one is read";
            cx.notes.not_supported(second.origin(), message);
        }
        return world::read(first, version, cx);
    }
    let models =
        root.all("model").map(|model| model::read(model, version, 0, cx)).collect::<Result<Vec<_>>>()?;
    if models.is_empty() {
        return Err(root.error("the file holds neither a world nor a model"));
    }
    Ok(draft::Scene {
        name: None,
        gravity: GRAVITY,
        physics: Physics::default(),
        models,
        joints: Vec::new(),
        frames: Vec::new(),
    })
}

/// Checks a name that something gives itself: not empty, not one with a meaning of its own (since SDF 1.7), and
/// without the delimiter of scopes (since 1.8).
fn read_name(element: Element<'_>, version: Version) -> Result<String> {
    let value = element.required_attribute("name")?;
    let name = value.word()?;
    let reserved = name == "world" || (name.starts_with("__") && name.ends_with("__"));
    if reserved && version >= Version(1, 7) {
        return Err(value.error(format!("the name `{name}` is reserved")));
    }
    if name.contains("::") && version >= Version(1, 8) {
        return Err(value.error(format!("the name `{name}` holds the delimiter of scopes, `::`")));
    }
    Ok(name.to_owned())
}

/// A reference in an attribute; an empty one is none.
fn reference_in(element: Element<'_>, attribute: &str) -> Option<draft::Reference> {
    element
        .attribute(attribute)
        .filter(|value| !value.is_empty())
        .map(|value| draft::Reference { name: value.text().to_owned(), origin: value.origin() })
}

/// The reference that an element holds as its text.
fn reference_text(element: Element<'_>) -> Result<draft::Reference> {
    let value = element.value();
    Ok(draft::Reference { name: value.word()?.to_owned(), origin: value.origin() })
}

/// Reads the SDF elements that a URDF puts into its `<gazebo>` for the whole robot: links, joints and frames.
pub(crate) fn read_model_part(
    element: Element<'_>,
    model: &mut draft::Model,
    cx: &mut Context<'_>,
) -> Result<()> {
    match element.name() {
        "link" => model.links.push(link::read(element, NEWEST, model.is_static, cx)?),
        "joint" => model.joints.push(joint::read(element, NEWEST, cx)?),
        "frame" => model.frames.push(model::read_frame(element, NEWEST, cx)?),
        _ => {}
    }
    Ok(())
}
