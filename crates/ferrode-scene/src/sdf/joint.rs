//! `<joint>`: what it joins, its axes, limits and dynamics.

use ferrode_math::Vec3;

use super::{Version, pose, read_name, reference_in, reference_text};
use crate::context::Context;
use crate::description::{JointAdvanced, Limits, Spring, StopSoftness};
use crate::draft::{self, JointKind};
use crate::error::{Result, did_you_mean};
use crate::source::Origin;
use crate::xml::{Children, Element};

const KINDS: [&str; 9] =
    ["revolute", "continuous", "prismatic", "ball", "universal", "revolute2", "fixed", "screw", "gearbox"];

const JOINT: Children = Children {
    single: &[
        "parent",
        "child",
        "pose",
        "axis",
        "axis2",
        "physics",
        "gearbox_ratio",
        "gearbox_reference_body",
        "thread_pitch",
        "screw_thread_pitch",
    ],
    many: &[],
    silent: &[],
    counted: &[("sensor", "sensors"), ("plugin", "plugins")],
    attributes: &["name", "type"],
};

pub(super) fn read(element: Element<'_>, version: Version, cx: &mut Context<'_>) -> Result<draft::Joint> {
    element.expect(&mut cx.notes, &JOINT);
    let name = read_name(element, version)?;
    let type_value = element.required_attribute("type")?;
    let type_name = type_value.word()?;
    let kind = match type_name {
        "revolute" | "continuous" => JointKind::Revolute,
        "prismatic" => JointKind::Prismatic,
        "ball" => JointKind::Ball,
        "universal" => JointKind::Universal,
        "revolute2" => JointKind::Revolute2,
        "fixed" => JointKind::Fixed,
        "screw" => JointKind::Screw { pitch: read_pitch(element, version)? },
        "gearbox" => JointKind::Gearbox {
            ratio: element.number_in("gearbox_ratio", 1.0)?,
            reference: reference_text(element.required("gearbox_reference_body")?)?,
        },
        other => {
            let error = type_value.error(format!("the joint type `{other}` is unknown"));
            return Err(match did_you_mean(other, KINDS) {
                Some(help) => error.with_help(help),
                None => error.with_help(format!("known types: {}", KINDS.join(", "))),
            });
        }
    };
    let needs = match kind {
        JointKind::Ball | JointKind::Fixed => 0,
        JointKind::Universal | JointKind::Revolute2 | JointKind::Gearbox { .. } => 2,
        _ => 1,
    };
    let mut axes = [None, None];
    for (index, tag) in ["axis", "axis2"].into_iter().enumerate() {
        axes[index] = match element.child(tag) {
            Some(axis) if index < needs => Some(read_axis(axis, version, cx)?),
            Some(axis) => {
                // A wheel's file may keep the axis of the hinge it was; it says nothing then, but must be sound.
                read_axis(axis, version, cx)?;
                None
            }
            None if index < needs => {
                return Err(element.error(format!("a {type_name} joint needs an <{tag}>")));
            }
            None => None,
        };
    }
    let [mut axis, axis2] = axes;
    if type_name == "continuous"
        && let Some(axis) = &mut axis
        && (axis.limits.lower.is_finite() || axis.limits.upper.is_finite())
    {
        let message = "a continuous joint has no limits: those given have no effect";
        cx.notes.suspicious(element.required("axis")?.origin(), message);
        axis.limits.lower = f64::NEG_INFINITY;
        axis.limits.upper = f64::INFINITY;
    }
    Ok(draft::Joint {
        name,
        origin: element.origin(),
        kind,
        parent: reference_text(element.required("parent")?)?,
        child: reference_text(element.required("child")?)?,
        placement: pose::read(element, cx)?,
        axis,
        axis2,
        advanced: match element.child("physics") {
            Some(physics) => read_advanced(physics, cx)?,
            None => JointAdvanced::default(),
        },
    })
}

/// Metres per turn, right-handed. The older `thread_pitch` means radians per metre, left-handed.
fn read_pitch(element: Element<'_>, version: Version) -> Result<f64> {
    let not_zero = |child: Element<'_>| {
        let value = child.value();
        let number = value.number()?;
        if number == 0.0 { Err(value.error("the pitch of a screw must not be zero")) } else { Ok(number) }
    };
    if let Some(pitch) = element.child("screw_thread_pitch") {
        return not_zero(pitch);
    }
    let old = match element.child("thread_pitch") {
        Some(pitch) => not_zero(pitch)?,
        // Both default to 1, each in its own units.
        None if version >= Version(1, 10) => return Ok(1.0),
        None => 1.0,
    };
    Ok(-2.0 * std::f64::consts::PI / old)
}

const AXIS: Children = Children {
    single: &["xyz", "dynamics", "limit", "mimic", "use_parent_model_frame", "initial_position"],
    many: &[],
    silent: &[],
    counted: &[],
    attributes: &[],
};

fn read_axis(element: Element<'_>, version: Version, cx: &mut Context<'_>) -> Result<draft::Axis> {
    element.expect(&mut cx.notes, &AXIS);
    let mut direction = Vec3::Z;
    let mut expressed_in = None;
    if let Some(xyz) = element.child("xyz") {
        xyz.expect(&mut cx.notes, &Children { attributes: &["expressed_in"], ..Children::default() });
        let value = xyz.value();
        direction = Vec3::from_array(value.numbers::<3>()?)
            .normalized()
            .ok_or_else(|| value.error("the axis of a joint must not be zero"))?;
        expressed_in = reference_in(xyz, "expressed_in");
    }
    // SDF 1.4 always meant the frame of the model; 1.5 and 1.6 asked; since 1.7 the frame has a name.
    let in_model = element.flag_in("use_parent_model_frame", version < Version(1, 5))?;
    if in_model && expressed_in.is_none() {
        expressed_in = Some(draft::Reference { name: "__model__".to_owned(), origin: element.origin() });
    }
    if let Some(initial) = element.child("initial_position")
        && initial.value().number()? != 0.0
    {
        cx.notes.not_supported(initial.origin(), "joints start at the position that the poses give");
    }
    let mut axis = draft::Axis {
        xyz: direction,
        expressed_in,
        limits: Limits::default(),
        damping: 0.0,
        friction: 0.0,
        spring: None,
        mimic: element.child("mimic").map(|mimic| read_mimic(mimic, cx)).transpose()?,
    };
    if let Some(limit) = element.child("limit") {
        axis.limits = read_limits(limit, cx)?;
    }
    if let Some(dynamics) = element.child("dynamics") {
        dynamics.expect(
            &mut cx.notes,
            &Children {
                single: &["damping", "friction", "spring_reference", "spring_stiffness"],
                ..Children::default()
            },
        );
        let read = |name: &str| dynamics.child(name).map_or(Ok(0.0), |child| child.value().not_negative());
        axis.damping = read("damping")?;
        axis.friction = read("friction")?;
        let stiffness = read("spring_stiffness")?;
        let reference = dynamics.number_in("spring_reference", 0.0)?;
        axis.spring = (stiffness > 0.0).then_some(Spring { stiffness, reference });
    }
    Ok(axis)
}

fn read_limits(element: Element<'_>, cx: &mut Context<'_>) -> Result<Limits> {
    element.expect(
        &mut cx.notes,
        &Children {
            single: &["lower", "upper", "effort", "velocity", "stiffness", "dissipation"],
            ..Children::default()
        },
    );
    let end = |name: &str, none: f64| -> Result<f64> {
        match element.child(name) {
            Some(child) => Ok(open_ended(child.value().number_or_infinite()?)),
            None => Ok(none),
        }
    };
    let most = |name: &str| -> Result<Option<f64>> {
        match element.child(name) {
            // A negative value says that there is none.
            Some(child) => {
                Ok(Some(child.value().number_or_infinite()?).filter(|most| (0.0..1e16).contains(most)))
            }
            None => Ok(None),
        }
    };
    let mut limits = Limits {
        lower: end("lower", f64::NEG_INFINITY)?,
        upper: end("upper", f64::INFINITY)?,
        effort: most("effort")?,
        velocity: most("velocity")?,
        ..Limits::default()
    };
    if let Some(stiffness) = element.child("stiffness") {
        limits.stiffness = stiffness.value().not_negative()?;
    }
    if let Some(dissipation) = element.child("dissipation") {
        limits.dissipation = dissipation.value().not_negative()?;
    }
    let place = element.child("lower").unwrap_or(element).value().origin();
    check_order(&limits, &place)?;
    Ok(limits)
}

/// ±1e16 is SDF's old way to write "no limit".
fn open_ended(end: f64) -> f64 {
    if end >= 1e16 {
        f64::INFINITY
    } else if end <= -1e16 {
        f64::NEG_INFINITY
    } else {
        end
    }
}

/// The lower limit must not lie above the upper.
pub(crate) fn check_order(limits: &Limits, place: &Origin) -> Result<()> {
    if limits.lower > limits.upper {
        let message = format!("the lower limit {} is above the upper limit {}", limits.lower, limits.upper);
        return Err(crate::error::SceneError::new(place.clone(), message));
    }
    Ok(())
}

fn read_mimic(element: Element<'_>, cx: &mut Context<'_>) -> Result<draft::Mimic> {
    element.expect(
        &mut cx.notes,
        &Children {
            single: &["multiplier", "offset", "reference"],
            attributes: &["joint", "axis"],
            ..Children::default()
        },
    );
    let leader = element.required_attribute("joint")?;
    let second_axis = match element.attribute("axis") {
        None => false,
        Some(value) => match value.text() {
            "axis" => false,
            "axis2" => true,
            other => return Err(value.error(format!("`{other}` should be `axis` or `axis2`"))),
        },
    };
    Ok(draft::Mimic {
        leader: draft::Reference { name: leader.word()?.to_owned(), origin: leader.origin() },
        second_axis,
        multiplier: element.number_in("multiplier", 1.0)?,
        offset: element.number_in("offset", 0.0)?,
        reference: element.number_in("reference", 0.0)?,
    })
}

fn read_advanced(element: Element<'_>, cx: &mut Context<'_>) -> Result<JointAdvanced> {
    element.expect(
        &mut cx.notes,
        &Children {
            single: &["ode", "provide_feedback"],
            counted: &[("simbody", "settings for other engines")],
            ..Children::default()
        },
    );
    let mut advanced = JointAdvanced {
        provide_feedback: element.flag_in("provide_feedback", false)?,
        ..JointAdvanced::default()
    };
    let Some(ode) = element.child("ode") else { return Ok(advanced) };
    ode.expect(
        &mut cx.notes,
        &Children {
            single: &[
                "provide_feedback",
                "cfm_damping",
                "implicit_spring_damper",
                "fudge_factor",
                "cfm",
                "erp",
                "bounce",
                "max_force",
                "velocity",
                "limit",
                "suspension",
            ],
            ..Children::default()
        },
    );
    advanced.provide_feedback |= ode.flag_in("provide_feedback", false)?;
    advanced.implicit_spring_damper =
        ode.flag_in("implicit_spring_damper", false)? || ode.flag_in("cfm_damping", false)?;
    let optional = |name: &str| ode.child(name).map(|child| child.value().not_negative()).transpose();
    advanced.fudge_factor = optional("fudge_factor")?;
    advanced.cfm = optional("cfm")?;
    advanced.erp = optional("erp")?;
    advanced.bounce = optional("bounce")?;
    advanced.max_force = optional("max_force")?;
    advanced.velocity = ode.optional_number_in("velocity")?;
    advanced.stop = ode.child("limit").map(|stop| read_stop(stop, cx)).transpose()?;
    advanced.suspension = ode.child("suspension").map(|suspension| read_stop(suspension, cx)).transpose()?;
    Ok(advanced)
}

fn read_stop(element: Element<'_>, cx: &mut Context<'_>) -> Result<StopSoftness> {
    element.expect(&mut cx.notes, &Children { single: &["cfm", "erp"], ..Children::default() });
    let read = |name: &str, default: f64| {
        element.child(name).map_or(Ok(default), |child| child.value().not_negative())
    };
    Ok(StopSoftness { cfm: read("cfm", 0.0)?, erp: read("erp", 0.2)? })
}
