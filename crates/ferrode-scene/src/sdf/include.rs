//! `<include>`: models from other files, nested or merged.

use std::path::{Path, PathBuf};

use super::model::DEEPEST;
use super::{Version, model, pose, read_version, reference_text};
use crate::context::Context;
use crate::draft::{self, Placement, Reference};
use crate::error::Result;
use crate::frames;
use crate::source::Source;
use crate::urdf;
use crate::uri::{self, Found};
use crate::xml::{self, Children, Element};

/// What an include brings.
pub(super) enum Included {
    Model {
        model: Box<draft::Model>,
        merge: bool,
    },
    /// A light or the like.
    Nothing,
}

const INCLUDE: Children = Children {
    single: &["uri", "name", "pose", "static", "placement_frame"],
    many: &[],
    silent: &[],
    counted: &[("plugin", "plugins")],
    attributes: &["merge"],
};

pub(super) fn read(
    element: Element<'_>,
    version: Version,
    depth: usize,
    cx: &mut Context<'_>,
) -> Result<Included> {
    if depth >= DEEPEST {
        return Err(element.error(format!("models are nested more than {DEEPEST} deep")));
    }
    element.expect(&mut cx.notes, &INCLUDE);
    let merge = element.attribute("merge").map_or(Ok(false), |value| value.flag())?;
    let uri = element.required("uri")?.value();
    let found = match uri::find(uri.word()?, element.source(), &cx.options.search_path()) {
        Found::Path(path) => path,
        Found::Nothing(message) => {
            return Err(uri.error(message).with_help(
                "give the folder that holds the model as a model path, or in GZ_SIM_RESOURCE_PATH",
            ));
        }
    };
    let path = model_file(&found).map_err(|message| uri.error(message))?;
    let model = cx
        .read_file(&path, |cx, source| read_model(source, depth, cx))
        // An error without a place of its own is placed here: the file could not be opened.
        .map_err(|error| match error.origin() {
            Some(_) => error,
            None => uri.error(format!("`{}` {}", path.display(), error.message())),
        })?;
    let Some(mut model) = model else { return Ok(Included::Nothing) };

    if let Some(name) = element.child("name") {
        let value = name.value();
        model.name = value.word()?.to_owned();
        if model.name.contains("::") && version >= Version(1, 8) {
            return Err(value.error(format!("the name `{}` holds the delimiter of scopes, `::`", model.name)));
        }
    }
    if element.child("static").is_some() {
        model.is_static = element.flag_in("static", false)?;
    }
    if let Some(frame) = element.child("placement_frame") {
        if element.child("pose").is_none() {
            return Err(frame.error("a <placement_frame> needs a <pose>"));
        }
        model.placement_frame = Some(reference_text(frame)?);
    }
    if element.child("pose").is_some() {
        model.placement = pose::read(element, cx)?;
    }
    model.origin = element.origin();
    Ok(Included::Model { model: Box::new(model), merge })
}

/// The file of a model: itself, or what `model.config` names, the newest version that can be read.
fn model_file(found: &Path) -> std::result::Result<PathBuf, String> {
    if !found.is_dir() {
        return Ok(found.to_path_buf());
    }
    let config =
        ["model.config", "manifest.xml"].map(|name| found.join(name)).into_iter().find(|path| path.exists());
    let Some(config) = config else {
        let plain = found.join("model.sdf");
        if plain.exists() {
            return Ok(plain);
        }
        return Err(format!("`{}` holds no model.config", found.display()));
    };
    let text =
        std::fs::read_to_string(&config).map_err(|error| format!("`{}`: {error}", config.display()))?;
    let named = xml::with_root(&Source::from_file(&config, text), |root| {
        let mut best: Option<(Version, String)> = None;
        for sdf in root.all("sdf") {
            let version = sdf.attribute("version").and_then(|value| {
                let (major, minor) = value.text().split_once('.')?;
                Some(Version(major.parse().ok()?, minor.parse().ok()?))
            });
            let version = version.unwrap_or(super::OLDEST);
            let newer = best.as_ref().is_none_or(|(so_far, _)| version > *so_far);
            if version <= super::NEWEST && newer {
                best = Some((version, sdf.value().word()?.to_owned()));
            }
        }
        Ok(best)
    })
    .map_err(|error| format!("`{}`: {}", config.display(), error.message()))?;
    match named {
        Some((_, file)) => Ok(found.join(file)),
        None => Err(format!("`{}` names no <sdf> file", config.display())),
    }
}

fn read_model(source: &Source, depth: usize, cx: &mut Context<'_>) -> Result<Option<draft::Model>> {
    xml::with_root(source, |root| match root.name() {
        "robot" => urdf::read_model(root, cx).map(Some),
        "sdf" => {
            let version = read_version(root, cx)?;
            let mut models = root.all("model");
            match models.next() {
                Some(first) => {
                    if let Some(second) = models.next() {
                        return Err(second.error("an included file may hold one model"));
                    }
                    model::read(first, version, depth, cx).map(Some)
                }
                None if root.child("light").is_some() => Ok(None),
                None if root.child("actor").is_some() => {
                    cx.notes.count(source.name(), "actors");
                    Ok(None)
                }
                None => Err(root.error("the included file holds no model")),
            }
        }
        other => Err(root.error(format!("the included file is neither SDF nor URDF: its root is <{other}>"))),
    })
}

/// Puts the contents of a model into the one around it. A frame stands for the frame that the merged model had,
/// and everything that was placed in that is placed in this.
pub(super) fn merge_into_model(model: &mut draft::Model, merged: draft::Model) -> Result<()> {
    let contents = prepare(merged, "__model__")?;
    model.frames.extend(contents.frames);
    model.links.extend(contents.links);
    model.joints.extend(contents.joints);
    model.models.extend(contents.models);
    Ok(())
}

/// Puts the contents of a model into the world; it must have no links of its own.
pub(super) fn merge_into_world(
    scene: &mut draft::Scene,
    merged: draft::Model,
    place: Element<'_>,
) -> Result<()> {
    if let Some(link) = merged.links.first() {
        let message =
            format!("a model with links of its own (`{}`) cannot be merged into the world", link.name);
        return Err(place.error(message));
    }
    let contents = prepare(merged, "world")?;
    scene.frames.extend(contents.frames);
    scene.joints.extend(contents.joints);
    scene.models.extend(contents.models);
    Ok(())
}

/// `outer` is the name that the scope around has for its own frame.
fn prepare(mut model: draft::Model, outer: &str) -> Result<draft::Model> {
    let proxy = format!("_merged__{}__model__", model.name);
    let mut placement = std::mem::take(&mut model.placement);
    if let Some(frame) = &model.placement_frame {
        placement.pose = placement.pose * frames::pose_in_model(&model, frame)?.inverse();
    }
    let origin = model.origin.clone();
    let to_proxy = || Reference { name: proxy.clone(), origin: origin.clone() };
    let redirect = |reference: &mut Option<Reference>, implied: bool| match reference {
        Some(named) if named.name == "__model__" => named.name = proxy.clone(),
        None if implied => *reference = Some(to_proxy()),
        _ => {}
    };
    let redirect_placement =
        |placement: &mut Placement, implied| redirect(&mut placement.relative_to, implied);
    for link in &mut model.links {
        redirect_placement(&mut link.placement, true);
        for collision in &mut link.collisions {
            redirect_placement(&mut collision.placement, false);
        }
    }
    for joint in &mut model.joints {
        redirect_placement(&mut joint.placement, false);
        for axis in [&mut joint.axis, &mut joint.axis2].into_iter().flatten() {
            redirect(&mut axis.expressed_in, false);
        }
        for end in [&mut joint.parent, &mut joint.child] {
            if end.name == "__model__" {
                end.name = proxy.clone();
            }
        }
    }
    for frame in &mut model.frames {
        let attached = frame.attached_to.is_some();
        redirect_placement(&mut frame.placement, !attached);
        redirect(&mut frame.attached_to, true);
    }
    for nested in &mut model.models {
        redirect_placement(&mut nested.placement, true);
    }
    // Attached to what the merged model's frame moved with, but placed where the include says.
    let attached_to = model
        .canonical_link
        .clone()
        .or_else(|| {
            model.links.first().map(|link| Reference { name: link.name.clone(), origin: origin.clone() })
        })
        .or_else(|| {
            model.models.first().map(|nested| Reference { name: nested.name.clone(), origin: origin.clone() })
        });
    if placement.relative_to.is_none() && attached_to.is_some() {
        placement.relative_to = Some(Reference { name: outer.to_owned(), origin: origin.clone() });
    }
    model.frames.push(draft::Frame { name: proxy.clone(), origin, attached_to, placement, proxy: true });
    Ok(model)
}
