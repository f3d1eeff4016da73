//! `<joint>`: what it joins, where, its axis, limits and dynamics.

use ferrode_math::{Pose, Vec3};

use super::read_origin;
use crate::context::Context;
use crate::description::{JointAdvanced, Limits};
use crate::draft::{self, JointKind, Placement, Reference};
use crate::error::{Result, did_you_mean};
use crate::sdf;
use crate::source::Origin;
use crate::xml::{Children, Element};

/// A joint, not yet in the form that both formats share.
pub(super) struct Joint {
    pub name: String,
    pub origin: Origin,
    /// `None` for a floating joint.
    pub kind: Option<JointKind>,
    pub parent: Reference,
    pub child: Reference,
    /// The joint frame and the child's link frame, in the parent's link frame.
    pub pose: Pose,
    pub axis: Option<draft::Axis>,
}

impl Joint {
    pub(super) fn into_draft(self) -> Option<draft::Joint> {
        Some(draft::Joint {
            name: self.name,
            origin: self.origin,
            kind: self.kind?,
            placement: place(self.pose, &self.parent),
            parent: self.parent,
            child: self.child,
            axis: self.axis,
            axis2: None,
            advanced: JointAdvanced::default(),
        })
    }
}

/// A pose in the frame of a link; the world's frame is that of the model.
pub(super) fn place(pose: Pose, parent: &Reference) -> Placement {
    let relative_to = (parent.name != "world").then(|| parent.clone());
    let in_model = || Reference { name: "__model__".to_owned(), origin: parent.origin.clone() };
    Placement { pose, relative_to: Some(relative_to.unwrap_or_else(in_model)) }
}

const KINDS: [&str; 6] = ["revolute", "continuous", "prismatic", "fixed", "floating", "planar"];

const JOINT: Children = Children {
    single: &["parent", "child", "origin", "axis", "limit", "dynamics", "mimic"],
    many: &[],
    // These concern whoever drives the joint.
    silent: &["safety_controller", "calibration"],
    counted: &[],
    attributes: &["name", "type"],
};

pub(super) fn read(element: Element<'_>, cx: &mut Context<'_>) -> Result<Joint> {
    element.expect(&mut cx.notes, &JOINT);
    let name = element.required_attribute("name")?.word()?.to_owned();
    let type_value = element.required_attribute("type")?;
    let type_name = type_value.word()?;
    let kind = match type_name {
        "revolute" | "continuous" => Some(JointKind::Revolute),
        "prismatic" => Some(JointKind::Prismatic),
        "fixed" => Some(JointKind::Fixed),
        "planar" => Some(JointKind::Planar),
        "floating" => None,
        other => {
            let error = type_value.error(format!("the joint type `{other}` is unknown"));
            return Err(match did_you_mean(other, KINDS) {
                Some(help) => error.with_help(help),
                None => error.with_help(format!("known types: {}", KINDS.join(", "))),
            });
        }
    };
    let end = |tag: &str| -> Result<Reference> {
        let value = element.required(tag)?.required_attribute("link")?;
        Ok(Reference { name: value.word()?.to_owned(), origin: value.origin() })
    };
    let (parent, child) = (end("parent")?, end("child")?);
    let axis = read_axis(element, type_name, cx)?;
    let has_axis = !matches!(type_name, "fixed" | "floating");
    Ok(Joint {
        name,
        origin: element.origin(),
        kind,
        parent,
        child,
        pose: read_origin(element, cx)?,
        axis: has_axis.then_some(axis),
    })
}

fn read_axis(element: Element<'_>, type_name: &str, cx: &mut Context<'_>) -> Result<draft::Axis> {
    let mut direction = Vec3::X;
    if let Some(axis) = element.child("axis") {
        axis.expect(&mut cx.notes, &Children { attributes: &["xyz"], ..Children::default() });
        if let Some(value) = axis.attribute("xyz") {
            let numbers = value.numbers::<3>()?;
            let unit = Vec3::from_array(numbers).normalized();
            direction = match unit {
                Some(unit) => unit,
                // Exporters write 0 0 0 for joints that have no axis.
                None if matches!(type_name, "fixed" | "floating") => Vec3::X,
                None => return Err(value.error("the axis of a joint must not be zero")),
            };
        }
    }
    let mut limits = Limits::default();
    match element.child("limit") {
        Some(limit) => {
            limit.expect(
                &mut cx.notes,
                &Children { attributes: &["lower", "upper", "effort", "velocity"], ..Children::default() },
            );
            let end = |name: &str| limit.attribute(name).map_or(Ok(0.0), |value| value.number_or_infinite());
            let (lower, upper) = (end("lower")?, end("upper")?);
            if matches!(type_name, "revolute" | "prismatic") {
                (limits.lower, limits.upper) = (lower, upper);
                let place = limit.attribute("lower").map_or_else(|| limit.origin(), |value| value.origin());
                sdf::check_order(&limits, &place)?;
            }
            let most = |name: &str| -> Result<Option<f64>> {
                match limit.attribute(name) {
                    Some(value) => {
                        Ok(Some(value.number_or_infinite()?).filter(|most| (0.0..1e16).contains(most)))
                    }
                    None => Ok(None),
                }
            };
            (limits.effort, limits.velocity) = (most("effort")?, most("velocity")?);
        }
        None if matches!(type_name, "revolute" | "prismatic") => {
            return Err(element.error(format!("a {type_name} joint needs a <limit>")));
        }
        None => {}
    }
    let (mut damping, mut friction) = (0.0, 0.0);
    if let Some(dynamics) = element.child("dynamics") {
        dynamics
            .expect(&mut cx.notes, &Children { attributes: &["damping", "friction"], ..Children::default() });
        let read = |name: &str| dynamics.attribute(name).map_or(Ok(0.0), |value| value.not_negative());
        (damping, friction) = (read("damping")?, read("friction")?);
    }
    let mimic = match element.child("mimic") {
        None => None,
        Some(mimic) => {
            mimic.expect(
                &mut cx.notes,
                &Children { attributes: &["joint", "multiplier", "offset"], ..Children::default() },
            );
            let leader = mimic.required_attribute("joint")?;
            let read =
                |name: &str, default: f64| mimic.attribute(name).map_or(Ok(default), |value| value.number());
            Some(draft::Mimic {
                leader: Reference { name: leader.word()?.to_owned(), origin: leader.origin() },
                second_axis: false,
                multiplier: read("multiplier", 1.0)?,
                offset: read("offset", 0.0)?,
                reference: 0.0,
            })
        }
    };
    Ok(draft::Axis { xyz: direction, expressed_in: None, limits, damping, friction, spring: None, mimic })
}
