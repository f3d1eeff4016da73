//! `<link>`, `<inertial>` and `<collision>`.

use ferrode_math::{Mat3, Pose};

use super::{Version, geometry, pose, read_name, surface};
use crate::context::Context;
use crate::description::{Collision, Inertial, Surface};
use crate::draft::{self, Automatic, PlacedCollision};
use crate::error::{Result, SceneError};
use crate::inertia;
use crate::source::Origin;
use crate::xml::{Children, Element};

const LINK: Children = Children {
    single: &[
        "pose",
        "inertial",
        "gravity",
        "kinematic",
        "self_collide",
        "enable_wind",
        "velocity_decay",
        "must_be_base_link",
    ],
    many: &["collision"],
    silent: &["visual", "light", "audio_sink", "audio_source", "battery", "particle_emitter", "projector"],
    counted: &[("sensor", "sensors"), ("plugin", "plugins")],
    attributes: &["name"],
};

pub(super) fn read(
    element: Element<'_>,
    version: Version,
    in_static: bool,
    cx: &mut Context<'_>,
) -> Result<draft::Link> {
    element.expect(&mut cx.notes, &LINK);
    let name = read_name(element, version)?;
    let (inertial, automatic) = match element.child("inertial") {
        Some(inertial) => read_inertial(inertial, in_static, cx)?,
        None => (Inertial::default(), None),
    };
    let mut collisions: Vec<PlacedCollision> = Vec::new();
    for child in element.all("collision") {
        let placed = read_collision(child, version, cx)?;
        if collisions.iter().any(|other| other.collision.name == placed.collision.name) {
            let message = format!("the link has another collision `{}`", placed.collision.name);
            return Err(child.error(message));
        }
        collisions.push(placed);
    }
    if element.flag_in("enable_wind", false)? {
        cx.notes.not_supported(element.required("enable_wind")?.origin(), "wind has no effect");
    }
    if element.flag_in("must_be_base_link", false)? {
        let message = "<must_be_base_link> has no effect: every link has six degrees of freedom";
        cx.notes.not_supported(element.required("must_be_base_link")?.origin(), message);
    }
    let (linear_damping, angular_damping) = match element.child("velocity_decay") {
        None => (0.0, 0.0),
        Some(decay) => {
            decay.expect(&mut cx.notes, &Children { single: &["linear", "angular"], ..Children::default() });
            let read = |name: &str| decay.child(name).map_or(Ok(0.0), |child| child.value().not_negative());
            (read("linear")?, read("angular")?)
        }
    };
    Ok(draft::Link {
        name,
        origin: element.origin(),
        placement: pose::read(element, cx)?,
        inertial,
        collisions,
        gravity: element.flag_in("gravity", true)?,
        kinematic: element.flag_in("kinematic", false)?,
        self_collide: element.child("self_collide").map(|child| child.value().flag()).transpose()?,
        linear_damping,
        angular_damping,
        automatic,
    })
}

const INERTIAL: Children = Children {
    single: &["mass", "pose", "inertia", "density", "fluid_added_mass"],
    many: &[],
    silent: &["auto_inertia_params"],
    counted: &[],
    attributes: &["auto"],
};

fn read_inertial(
    element: Element<'_>,
    in_static: bool,
    cx: &mut Context<'_>,
) -> Result<(Inertial, Option<Automatic>)> {
    element.expect(&mut cx.notes, &INERTIAL);
    let placement = pose::read(element, cx)?;
    if let Some(reference) = placement.relative_to {
        let message = "the pose of an inertial is always relative to its link";
        cx.notes.not_understood(reference.origin, message);
    }
    if let Some(added) = element.child("fluid_added_mass") {
        for entry in added.children() {
            if entry.value().number()? != 0.0 {
                cx.notes.not_supported(entry.origin(), "the added mass of a fluid has no effect");
                break;
            }
        }
    }
    let mass = element.child("mass");
    let mass_given = mass.map(|mass| mass.value().number()).transpose()?;
    let density = match element.child("density") {
        Some(density) => density.value().positive()?,
        None => 1000.0,
    };
    if element.attribute("auto").map_or(Ok(false), |value| value.flag())? {
        if let Some(mass) = mass {
            mass.value().positive()?;
        }
        let automatic = Automatic { origin: element.origin(), density, mass: mass_given };
        return Ok((Inertial::default(), Some(automatic)));
    }
    let mut inertial =
        Inertial { mass: mass_given.unwrap_or(1.0), pose: placement.pose, ..Inertial::default() };
    let tensor = element.child("inertia");
    if let Some(tensor) = tensor {
        inertial.inertia = read_tensor(tensor, cx)?;
    }
    let mass_place = mass.map_or_else(|| element.origin(), |mass| mass.value().origin());
    let tensor_place = tensor.unwrap_or(element).origin();
    check_inertial(&inertial, in_static, &mass_place, &tensor_place)?;
    Ok((inertial, None))
}

fn read_tensor(element: Element<'_>, cx: &mut Context<'_>) -> Result<Mat3> {
    element.expect(
        &mut cx.notes,
        &Children { single: &["ixx", "ixy", "ixz", "iyy", "iyz", "izz"], ..Children::default() },
    );
    let [xx, yy, zz] = ["ixx", "iyy", "izz"].map(|name| element.number_in(name, 1.0));
    let [xy, xz, yz] = ["ixy", "ixz", "iyz"].map(|name| element.number_in(name, 0.0));
    let (xx, yy, zz, xy, xz, yz) = (xx?, yy?, zz?, xy?, xz?, yz?);
    Ok(Mat3::from_rows([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]]))
}

/// A link that moves needs a positive mass and an inertia that a body can have. The mass of one that does not move
/// is of no account, but must not be negative.
pub(crate) fn check_inertial(
    inertial: &Inertial,
    in_static: bool,
    mass_place: &Origin,
    tensor_place: &Origin,
) -> Result<()> {
    let mass = inertial.mass;
    if mass < 0.0 || (mass == 0.0 && !in_static) {
        let message = format!("the mass must be positive, found {mass}");
        return Err(SceneError::new(mass_place.clone(), message));
    }
    if !in_static && let Some(reason) = inertia::impossible(&inertial.inertia) {
        return Err(SceneError::new(tensor_place.clone(), reason));
    }
    Ok(())
}

const COLLISION: Children = Children {
    single: &["pose", "geometry", "surface", "max_contacts", "density"],
    many: &[],
    silent: &["laser_retro", "auto_inertia_params"],
    counted: &[],
    attributes: &["name"],
};

fn read_collision(element: Element<'_>, version: Version, cx: &mut Context<'_>) -> Result<PlacedCollision> {
    element.expect(&mut cx.notes, &COLLISION);
    let placement = pose::read(element, cx)?;
    let collision = Collision {
        name: read_name(element, version)?,
        pose: Pose::IDENTITY,
        geometry: geometry::read(element.required("geometry")?, cx)?,
        surface: match element.child("surface") {
            Some(surface) => surface::read_surface(surface, cx)?,
            None => Surface::default(),
        },
        max_contacts: element.child("max_contacts").map(|child| child.value().count()).transpose()?,
        density: element.child("density").map(|child| child.value().positive()).transpose()?,
        origin: element.origin(),
    };
    Ok(PlacedCollision { collision, placement })
}
