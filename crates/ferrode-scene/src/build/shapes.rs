//! Collisions become geoms with materials; which pairs never touch.

use ferrode::{BodyKey, GeomKey, Material, Plane, Pose, World};

use super::bodies::BuiltLink;
use super::solids::FromFiles;
use super::{refused, softness};
use crate::description::{Body, Collision, Geometry, Link, LinkId, ModelId, Scene, Surface};
use crate::error::{Notes, Result};

/// What all collisions of a world are made with.
pub(super) struct Making {
    /// The step size that soft materials are for.
    pub step: f64,
    pub files: FromFiles,
}

/// Adds the collisions of a link, to its body or to the static world.
pub(super) fn add_geoms(
    world: &mut World,
    scene: &Scene,
    link: &Link,
    body: Option<BodyKey>,
    making: &mut Making,
    notes: &mut Notes,
) -> Result<Vec<GeomKey>> {
    let mut geoms = Vec::with_capacity(link.collisions.len());
    for collision in &link.collisions {
        let refused = |error: ferrode::Error| refused(&collision.origin, "the collision", error);
        let in_world = link.pose * collision.pose;
        let mut material = material(&collision.surface, making.step);
        let key = if let (Geometry::Plane { normal }, None) = (&collision.geometry, body) {
            // A plane has no pose of its own: it is written in the world, and so is its friction direction.
            let normal = in_world.transform_vector(*normal);
            let plane =
                Plane::new(normal, normal.dot(in_world.position)).map_err(|error| refused(error.into()))?;
            material.friction_direction = material.friction_direction.map(|d| in_world.transform_vector(d));
            world.add_static(plane, Pose::IDENTITY).map_err(refused)?
        } else {
            let Some(shape) = making.files.shape(collision, notes).map_err(refused)? else { continue };
            match body {
                Some(body) => {
                    let offset = link.inertial.pose.inverse() * collision.pose;
                    world.add_geom(body, shape, offset).map_err(refused)?
                }
                None => world.add_static(shape, in_world).map_err(refused)?,
            }
        };
        world.set_material(key, material).map_err(refused)?;
        set_filter(world, key, &collision.surface).map_err(refused)?;
        note_unsupported(scene, collision, notes);
        geoms.push(key);
    }
    Ok(geoms)
}

/// The material of a surface. Stiffness and damping win over ERP and CFM, as they say more; a surface that gives
/// neither is as soft as the world.
///
/// Torsional friction is a torque of at most 3π/16 · coefficient · patch radius · normal force: that of a circular
/// contact under Hertz's pressure.
fn material(surface: &Surface, step: f64) -> Material {
    let (friction, contact) = (&surface.friction, &surface.contact);
    let softness = if contact.kp.is_some() || contact.kd.is_some() {
        softness(contact.kp.unwrap_or(1e12), contact.kd.unwrap_or(1.0), step)
    } else if contact.soft_cfm.is_some() || contact.soft_erp.is_some() {
        Some(ferrode::Softness { erp: contact.soft_erp.unwrap_or(0.2), cfm: contact.soft_cfm.unwrap_or(0.0) })
    } else {
        None
    };
    let spinning = friction
        .torsional
        .as_ref()
        .filter(|torsional| torsional.use_patch_radius)
        .map_or(0.0, |t| 3.0 * std::f64::consts::PI / 16.0 * t.coefficient * t.patch_radius);
    Material {
        friction: friction.mu,
        friction2: (friction.mu2 != friction.mu).then_some(friction.mu2),
        friction_direction: friction.fdir1,
        restitution: surface.bounce.restitution,
        // SDF's default threshold, 100 km/s, is meant for surfaces that don't bounce; the larger one of two counts.
        restitution_threshold: if surface.bounce.restitution > 0.0 { surface.bounce.threshold } else { 0.0 },
        rolling: friction.rolling.unwrap_or(0.0),
        spinning,
        slip1: friction.slip1,
        slip2: friction.slip2,
        softness,
        max_correcting_velocity: contact.max_vel,
        surface_layer: contact.min_depth,
        ..Material::default()
    }
}

fn set_filter(
    world: &mut World,
    geom: GeomKey,
    surface: &Surface,
) -> std::result::Result<(), ferrode::Error> {
    let contact = &surface.contact;
    if contact.without_force {
        return world.set_geom_bits(geom, 0, 0);
    }
    let collide = u64::from(contact.collide_bitmask);
    let category = contact.category_bitmask.map_or(collide, u64::from);
    world.set_geom_bits(geom, category, collide)
}

fn note_unsupported(scene: &Scene, collision: &Collision, notes: &mut Notes) {
    let mut note = |message: String| {
        notes.not_supported(collision.origin.clone(), format!("collision `{}`: {message}", collision.name));
    };
    if collision.max_contacts.is_some_and(|most| most < scene.physics.max_contacts) {
        note(format!("<max_contacts> is the world's, {}", scene.physics.max_contacts));
    }
    if let Some(torsional) = &collision.surface.friction.torsional {
        if !torsional.use_patch_radius && torsional.coefficient > 0.0 && torsional.surface_radius > 0.0 {
            note(
                "torsional friction that grows with the depth is not supported: give a <patch_radius>"
                    .to_owned(),
            );
        }
        if torsional.slip > 0.0 {
            note("torsional slip is not supported".to_owned());
        }
    }
}

/// Keeps links of one model from colliding with each other, unless one of them says otherwise, and links from
/// colliding with static ones that they are joined to.
///
/// A model nested in another counts as part of it: an arm should not push away the hand that is mounted in it.
pub(super) fn exclude_pairs(world: &mut World, scene: &Scene, links: &[BuiltLink]) -> Result<()> {
    let mut members: Vec<Vec<usize>> = vec![Vec::new(); scene.models.len()];
    for (index, link) in scene.links.iter().enumerate() {
        if !links[index].geoms.is_empty() {
            members[outermost(scene, link.model).0].push(index);
        }
    }
    for members in members {
        for (position, &a) in members.iter().enumerate() {
            for &b in &members[position + 1..] {
                let fixed = links[a].body.is_none() && links[b].body.is_none();
                if !fixed && !scene.links[a].self_collide && !scene.links[b].self_collide {
                    exclude(world, scene, links, a, b)?;
                }
            }
        }
    }
    for joint in &scene.joints {
        if let (Body::Link(LinkId(a)), Body::Link(LinkId(b))) = (joint.parent, joint.child)
            && links[a].body.is_some() != links[b].body.is_some()
        {
            exclude(world, scene, links, a, b)?;
        }
    }
    Ok(())
}

fn exclude(world: &mut World, scene: &Scene, links: &[BuiltLink], a: usize, b: usize) -> Result<()> {
    for &first in &links[a].geoms {
        for &second in &links[b].geoms {
            world
                .set_pair_surface(first, second, None)
                .map_err(|error| refused(&scene.links[b].origin, "the pair of links", error))?;
        }
    }
    Ok(())
}

fn outermost(scene: &Scene, mut model: ModelId) -> ModelId {
    while let Some(parent) = scene.models.get(model.0).and_then(|model| model.parent) {
        model = parent;
    }
    model
}
