//! `<link>`: inertial and collisions.

use ferrode_math::{Mat3, Pose, Vec3};

use super::read_origin;
use crate::context::Context;
use crate::description::{Collision, Geometry, Inertial, Surface};
use crate::draft::{self, PlacedCollision, Placement};
use crate::error::Result;
use crate::sdf;
use crate::xml::{Children, Element};

const LINK: Children = Children {
    single: &["inertial"],
    many: &["collision"],
    silent: &["visual"],
    counted: &[("sensor", "sensors")],
    attributes: &["name", "type"],
};

pub(super) fn read(element: Element<'_>, cx: &mut Context<'_>) -> Result<draft::Link> {
    element.expect(&mut cx.notes, &LINK);
    let name = element.required_attribute("name")?.word()?.to_owned();
    let inertial = match element.child("inertial") {
        Some(inertial) => read_inertial(inertial, cx)?,
        None => massless(),
    };
    let mut collisions: Vec<PlacedCollision> = Vec::new();
    for (index, child) in element.all("collision").enumerate() {
        let mut placed = read_collision(child, cx)?;
        let collision = &mut placed.collision;
        // Names are optional and need not differ in a URDF; they must differ here.
        let taken = |name: &str| collisions.iter().any(|other| other.collision.name == name);
        if collision.name.is_empty() || taken(&collision.name) {
            let stem =
                if collision.name.is_empty() { format!("{name}_collision") } else { collision.name.clone() };
            collision.name = if taken(&stem) { format!("{stem}_{index}") } else { stem };
        }
        collisions.push(placed);
    }
    Ok(draft::Link {
        name,
        origin: element.origin(),
        placement: Placement::default(),
        inertial,
        collisions,
        gravity: true,
        kinematic: false,
        self_collide: None,
        linear_damping: 0.0,
        angular_damping: 0.0,
        automatic: None,
    })
}

fn massless() -> Inertial {
    Inertial { mass: 0.0, pose: Pose::IDENTITY, inertia: Mat3::ZERO }
}

fn read_inertial(element: Element<'_>, cx: &mut Context<'_>) -> Result<Inertial> {
    element
        .expect(&mut cx.notes, &Children { single: &["origin", "mass", "inertia"], ..Children::default() });
    let mass_element = element.required("mass")?;
    mass_element.expect(&mut cx.notes, &Children { attributes: &["value"], ..Children::default() });
    let mass_value = mass_element.required_attribute("value")?;
    let mass = mass_value.not_negative()?;
    let tensor = element.required("inertia")?;
    const ENTRIES: &[&str] = &["ixx", "ixy", "ixz", "iyy", "iyz", "izz"];
    tensor.expect(&mut cx.notes, &Children { attributes: ENTRIES, ..Children::default() });
    let moment = |name: &str| tensor.required_attribute(name)?.number();
    let product = |name: &str| tensor.attribute(name).map_or(Ok(0.0), |value| value.number());
    let (xx, yy, zz) = (moment("ixx")?, moment("iyy")?, moment("izz")?);
    let (xy, xz, yz) = (product("ixy")?, product("ixz")?, product("iyz")?);
    let pose = read_origin(element, cx)?;
    if mass == 0.0 {
        return Ok(massless());
    }
    let inertia = Mat3::from_rows([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]]);
    let inertial = Inertial { mass, pose, inertia };
    sdf::check_inertial(&inertial, false, &mass_value.origin(), &tensor.origin())?;
    Ok(inertial)
}

const COLLISION: Children = Children {
    single: &["origin", "geometry"],
    many: &[],
    silent: &["verbose", "material"],
    counted: &[],
    attributes: &["name", "group"],
};

fn read_collision(element: Element<'_>, cx: &mut Context<'_>) -> Result<PlacedCollision> {
    element.expect(&mut cx.notes, &COLLISION);
    let collision = Collision {
        name: element.attribute("name").map_or(String::new(), |value| value.text().to_owned()),
        pose: Pose::IDENTITY,
        geometry: read_geometry(element.required("geometry")?, cx)?,
        surface: Surface::default(),
        max_contacts: None,
        density: None,
        origin: element.origin(),
    };
    Ok(PlacedCollision {
        collision,
        placement: Placement { pose: read_origin(element, cx)?, relative_to: None },
    })
}

const SHAPES: &[&str] = &["box", "sphere", "cylinder", "capsule", "mesh"];

fn read_geometry(element: Element<'_>, cx: &mut Context<'_>) -> Result<Geometry> {
    element.expect(&mut cx.notes, &Children { many: SHAPES, ..Children::default() });
    let mut shapes = element.children().filter(|child| SHAPES.contains(&child.name()));
    let Some(shape) = shapes.next() else {
        return Err(element.error("<geometry> holds no shape that is known").with_help(SHAPES.join(", ")));
    };
    if let Some(second) = shapes.next() {
        let message = format!("<geometry> holds a {} and a {}: one is allowed", shape.name(), second.name());
        return Err(second.error(message));
    }
    let attributes: &'static [&'static str] = match shape.name() {
        "box" => &["size"],
        "sphere" => &["radius"],
        "mesh" => &["filename", "scale"],
        _ => &["radius", "length"],
    };
    shape.expect(&mut cx.notes, &Children { attributes, ..Children::default() });
    let positive = |name: &str| shape.required_attribute(name)?.positive();
    Ok(match shape.name() {
        "box" => {
            Geometry::Cuboid { size: sdf::positive_lengths(&shape.required_attribute("size")?, "size")? }
        }
        "sphere" => Geometry::Sphere { radius: positive("radius")? },
        "cylinder" => Geometry::Cylinder { radius: positive("radius")?, length: positive("length")? },
        "capsule" => Geometry::Capsule { radius: positive("radius")?, length: positive("length")? },
        _ => {
            let scale = match shape.attribute("scale") {
                None => Vec3::splat(1.0),
                Some(value) => {
                    let scale = match value.number_list()?.as_slice() {
                        &[all] => Vec3::splat(all),
                        &[x, y, z] => Vec3::new(x, y, z),
                        other => {
                            let message =
                                format!("attribute `scale` should be 3 numbers, found {}", other.len());
                            return Err(value.error(message));
                        }
                    };
                    if scale.x == 0.0 || scale.y == 0.0 || scale.z == 0.0 {
                        return Err(value.error("a mesh must not be scaled by zero"));
                    }
                    scale
                }
            };
            Geometry::Mesh(sdf::read_mesh_reference(&shape.required_attribute("filename")?, scale, cx)?)
        }
    })
}
