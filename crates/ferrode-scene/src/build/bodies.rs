//! Links become bodies, or parts of the static world.

use ferrode::{BodyKey, GeomKey, Mass, World};

use super::solids::FromFiles;
use super::{refused, shapes};
use crate::description::{Link, LinkId, Scene};
use crate::error::{Notes, Result};

/// What became of a link.
#[derive(Clone, Debug)]
pub(super) struct BuiltLink {
    /// `None`: it cannot move.
    pub body: Option<BodyKey>,
    pub geoms: Vec<GeomKey>,
}

pub(super) fn add_links(
    world: &mut World,
    scene: &Scene,
    step: f64,
    notes: &mut Notes,
) -> Result<Vec<BuiltLink>> {
    let jointed = models_with_joints(scene);
    let mut making = shapes::Making { step, files: FromFiles::default() };
    let mut built = Vec::with_capacity(scene.links.len());
    for (index, link) in scene.links.iter().enumerate() {
        let body = if scene.is_static(LinkId(index)) {
            None
        } else {
            let body = add_body(world, link).map_err(|error| refused(&link.origin, "the link", error))?;
            // SDF lets models without joints fall asleep.
            if scene.models.get(link.model.0).is_some_and(|model| model.allow_auto_disable)
                && !jointed[link.model.0]
                && !link.kinematic
            {
                world
                    .set_body_auto_disable_flag(body, true)
                    .map_err(|error| refused(&link.origin, "the link", error))?;
            }
            Some(body)
        };
        let geoms = shapes::add_geoms(world, scene, link, body, &mut making, notes)?;
        built.push(BuiltLink { body, geoms });
    }
    Ok(built)
}

/// By model: whether a joint holds one of its links.
fn models_with_joints(scene: &Scene) -> Vec<bool> {
    let mut jointed = vec![false; scene.models.len()];
    for joint in &scene.joints {
        for LinkId(link) in [joint.parent.link(), joint.child.link()].into_iter().flatten() {
            if let Some(link) = scene.links.get(link)
                && let Some(flag) = jointed.get_mut(link.model.0)
            {
                *flag = true;
            }
        }
    }
    jointed
}

fn add_body(world: &mut World, link: &Link) -> std::result::Result<BodyKey, ferrode::Error> {
    let key = world.create_body();
    let body = world.body_mut(key)?;
    body.set_pose(link.pose * link.inertial.pose)?;
    if link.kinematic {
        body.set_kinematic();
    } else {
        let mass = Mass { mass: link.inertial.mass, inertia: link.inertial.inertia, ..Mass::default() };
        body.set_mass(&mass)?;
    }
    body.set_gravity_mode(link.gravity);
    if link.linear_damping != 0.0 || link.angular_damping != 0.0 {
        let mut damping = *body.damping();
        (damping.linear_scale, damping.angular_scale) = (link.linear_damping, link.angular_damping);
        body.set_damping(damping)?;
    }
    Ok(key)
}
