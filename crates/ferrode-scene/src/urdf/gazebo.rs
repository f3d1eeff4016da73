//! `<gazebo>`: what a URDF says to the simulator in SDF's terms.

use ferrode_math::Vec3;

use crate::context::Context;
use crate::description::{Spring, StopSoftness};
use crate::draft::{self, JointKind};
use crate::error::{Result, did_you_mean};
use crate::sdf;
use crate::xml::{Children, Element};

/// Applies one `<gazebo>` to the robot, or to the link or joint that it refers to.
pub(super) fn apply(element: Element<'_>, model: &mut draft::Model, cx: &mut Context<'_>) -> Result<()> {
    let Some(reference) = element.attribute("reference").filter(|reference| !reference.is_empty()) else {
        return apply_to_robot(element, model, cx);
    };
    let name = reference.text();
    let mut found = false;
    // A link and a joint may share the name; then both are meant by what fits each.
    let joint_index = model.joints.iter().position(|joint| joint.name == name);
    if let Some(link) = model.links.iter_mut().find(|link| link.name == name) {
        found = true;
        let both = joint_index.is_some();
        apply_to_link(element, link, both, cx)?;
    }
    if let Some(index) = joint_index {
        apply_to_joint(element, model, index, found, cx)?;
        found = true;
    }
    if !found && element.children().next().is_some() {
        let names =
            model.links.iter().map(|link| &link.name).chain(model.joints.iter().map(|joint| &joint.name));
        let help = did_you_mean(name, names.map(String::as_str));
        let warning = crate::error::Warning::new(
            crate::error::WarningKind::Suspicious,
            reference.origin(),
            format!("<gazebo> refers to `{name}`, which is neither a link nor a joint, and has no effect"),
        );
        cx.notes.push(match help {
            Some(help) => warning.with_help(help),
            None => warning,
        });
    }
    Ok(())
}

const FOR_ROBOT: Children = Children {
    single: &["static", "self_collide", "allow_auto_disable"],
    many: &["link", "joint", "frame"],
    silent: &[],
    counted: &[("plugin", "plugins"), ("sensor", "sensors")],
    attributes: &["reference"],
};

fn apply_to_robot(element: Element<'_>, model: &mut draft::Model, cx: &mut Context<'_>) -> Result<()> {
    element.expect(&mut cx.notes, &FOR_ROBOT);
    model.is_static = element.flag_in("static", model.is_static)?;
    model.self_collide = element.flag_in("self_collide", model.self_collide)?;
    model.allow_auto_disable = element.flag_in("allow_auto_disable", model.allow_auto_disable)?;
    for child in element.children() {
        sdf::read_model_part(child, model, cx)?;
    }
    Ok(())
}

const FOR_LINK: Children = Children {
    single: &[
        "mu1",
        "mu2",
        "fdir1",
        "kp",
        "kd",
        "maxVel",
        "minDepth",
        "maxContacts",
        "selfCollide",
        "self_collide",
        "turnGravityOff",
        "gravity",
        "dampingFactor",
        "kinematic",
        "velocity_decay",
        "collision",
    ],
    many: &[],
    silent: &["material", "visual", "laserRetro"],
    counted: &[("plugin", "plugins"), ("sensor", "sensors")],
    attributes: &["reference"],
};

const FOR_JOINT: Children = Children {
    single: &[
        "stopCfm",
        "stopErp",
        "stopKp",
        "stopKd",
        "fudgeFactor",
        "provideFeedback",
        "implicitSpringDamper",
        "cfmDamping",
        "springStiffness",
        "springReference",
        "disableFixedJointLumping",
        "preserveFixedJoint",
    ],
    many: &[],
    silent: &[],
    counted: &[("plugin", "plugins"), ("sensor", "sensors")],
    attributes: &["reference"],
};

/// All that fits a link or a joint, where both have the name.
const FOR_BOTH: Children = Children {
    single: FOR_LINK.single,
    many: FOR_JOINT.single,
    silent: FOR_LINK.silent,
    counted: FOR_LINK.counted,
    attributes: FOR_LINK.attributes,
};

fn apply_to_link(
    element: Element<'_>,
    link: &mut draft::Link,
    both: bool,
    cx: &mut Context<'_>,
) -> Result<()> {
    element.expect(&mut cx.notes, if both { &FOR_BOTH } else { &FOR_LINK });
    let not_negative = |name: &str| element.child(name).map(|child| child.value().not_negative()).transpose();
    let (mu1, mu2) = (not_negative("mu1")?, not_negative("mu2")?);
    let (kp, kd) = (not_negative("kp")?, not_negative("kd")?);
    let (max_vel, min_depth) = (not_negative("maxVel")?, not_negative("minDepth")?);
    let max_contacts = element.child("maxContacts").map(|child| child.value().count()).transpose()?;
    let fdir1 = element.child("fdir1").map(|child| child.value().numbers::<3>()).transpose()?;
    for PlacedSurface { surface, contacts } in surfaces(link) {
        if let Some(mu) = mu1 {
            surface.friction.mu = mu;
        }
        if let Some(mu) = mu2 {
            surface.friction.mu2 = mu;
        }
        if let Some(direction) = fdir1 {
            surface.friction.fdir1 = Vec3::from_array(direction).normalized();
        }
        surface.contact.kp = kp.or(surface.contact.kp);
        surface.contact.kd = kd.or(surface.contact.kd);
        surface.contact.max_vel = max_vel.or(surface.contact.max_vel);
        surface.contact.min_depth = min_depth.or(surface.contact.min_depth);
        *contacts = max_contacts.or(*contacts);
    }
    if let Some(collision) = element.child("collision") {
        apply_to_collisions(collision, link, cx)?;
    }
    for name in ["selfCollide", "self_collide"] {
        if let Some(child) = element.child(name) {
            link.self_collide = Some(child.value().flag()?);
        }
    }
    link.gravity = element.flag_in("gravity", link.gravity)?;
    if element.child("turnGravityOff").is_some() {
        link.gravity = !element.flag_in("turnGravityOff", false)?;
    }
    link.kinematic = element.flag_in("kinematic", link.kinematic)?;
    if let Some(damping) = not_negative("dampingFactor")? {
        (link.linear_damping, link.angular_damping) = (damping, damping);
    }
    if let Some(decay) = element.child("velocity_decay") {
        link.linear_damping = decay.number_in("linear", link.linear_damping)?;
        link.angular_damping = decay.number_in("angular", link.angular_damping)?;
    }
    Ok(())
}

struct PlacedSurface<'a> {
    surface: &'a mut crate::description::Surface,
    contacts: &'a mut Option<u32>,
}

fn surfaces(link: &mut draft::Link) -> impl Iterator<Item = PlacedSurface<'_>> {
    link.collisions.iter_mut().map(|placed| PlacedSurface {
        surface: &mut placed.collision.surface,
        contacts: &mut placed.collision.max_contacts,
    })
}

/// `<collision>` in `<gazebo>` speaks of all collisions of the link.
fn apply_to_collisions(element: Element<'_>, link: &mut draft::Link, cx: &mut Context<'_>) -> Result<()> {
    element.expect(
        &mut cx.notes,
        &Children {
            single: &["surface", "max_contacts"],
            silent: &["laser_retro"],
            attributes: &["name"],
            ..Children::default()
        },
    );
    let read = element.child("surface").map(|child| sdf::read_surface(child, cx)).transpose()?;
    let max_contacts = element.child("max_contacts").map(|child| child.value().count()).transpose()?;
    for PlacedSurface { surface, contacts } in surfaces(link) {
        if let Some(read) = &read {
            *surface = read.clone();
        }
        *contacts = max_contacts.or(*contacts);
    }
    Ok(())
}

fn apply_to_joint(
    element: Element<'_>,
    model: &mut draft::Model,
    index: usize,
    checked: bool,
    cx: &mut Context<'_>,
) -> Result<()> {
    if !checked {
        element.expect(&mut cx.notes, &FOR_JOINT);
    }
    let joint = &mut model.joints[index];
    let not_negative = |name: &str| element.child(name).map(|child| child.value().not_negative()).transpose();
    let (cfm, erp) = (not_negative("stopCfm")?, not_negative("stopErp")?);
    if cfm.is_some() || erp.is_some() {
        let stop = joint.advanced.stop.get_or_insert(StopSoftness { cfm: 0.0, erp: 0.2 });
        stop.cfm = cfm.unwrap_or(stop.cfm);
        stop.erp = erp.unwrap_or(stop.erp);
    }
    joint.advanced.fudge_factor = not_negative("fudgeFactor")?.or(joint.advanced.fudge_factor);
    joint.advanced.provide_feedback = element.flag_in("provideFeedback", joint.advanced.provide_feedback)?;
    joint.advanced.implicit_spring_damper |=
        element.flag_in("implicitSpringDamper", false)? || element.flag_in("cfmDamping", false)?;
    let (stop_stiffness, stop_damping) = (not_negative("stopKp")?, not_negative("stopKd")?);
    let stiffness = not_negative("springStiffness")?;
    let reference = element.optional_number_in("springReference")?;
    if let Some(axis) = &mut joint.axis {
        axis.limits.stiffness = stop_stiffness.unwrap_or(axis.limits.stiffness);
        axis.limits.dissipation = stop_damping.unwrap_or(axis.limits.dissipation);
        let spring = axis.spring.unwrap_or(Spring { stiffness: 0.0, reference: 0.0 });
        let spring = Spring {
            stiffness: stiffness.unwrap_or(spring.stiffness),
            reference: reference.unwrap_or(spring.reference),
        };
        axis.spring = (spring.stiffness > 0.0).then_some(spring);
    }
    let keep = element.flag_in("disableFixedJointLumping", false)?
        || element.flag_in("preserveFixedJoint", false)?;
    if keep && matches!(joint.kind, JointKind::Fixed) {
        let name = joint.name.clone();
        if let Some(kept) = &mut model.lump_fixed {
            kept.push(name);
        }
    }
    Ok(())
}
