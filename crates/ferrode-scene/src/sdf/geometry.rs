//! `<geometry>`: the shape of a collision.

use ferrode_math::Vec3;

use crate::context::Context;
use crate::description::{Geometry, Mesh};
use crate::error::Result;
use crate::uri::{self, Found};
use crate::xml::{Children, Element, Value};

const SHAPES: &[&str] = &[
    "box",
    "sphere",
    "cylinder",
    "capsule",
    "ellipsoid",
    "cone",
    "plane",
    "mesh",
    "polyline",
    "heightmap",
    "image",
    "empty",
];

/// The one shape in a `<geometry>`. Several polylines are one: outlines and holes.
pub(super) fn read(element: Element<'_>, cx: &mut Context<'_>) -> Result<Geometry> {
    element.expect(&mut cx.notes, &Children { many: SHAPES, ..Children::default() });
    let mut shapes = element.children().filter(|child| SHAPES.contains(&child.name()));
    let Some(shape) = shapes.next() else {
        return Err(element.error("<geometry> holds no shape that is known").with_help(SHAPES.join(", ")));
    };
    if let Some(second) = shapes.find(|other| shape.name() != "polyline" || other.name() != "polyline") {
        let message = format!("<geometry> holds a {} and a {}: one is allowed", shape.name(), second.name());
        return Err(second.error(message));
    }
    read_shape(shape, element, cx)
}

fn expect(shape: Element<'_>, cx: &mut Context<'_>, single: &'static [&'static str]) {
    shape.expect(&mut cx.notes, &Children { single, ..Children::default() });
}

fn length(shape: Element<'_>, name: &str, default: f64) -> Result<f64> {
    shape.child(name).map_or(Ok(default), |child| child.value().positive())
}

fn lengths(shape: Element<'_>, name: &str) -> Result<Vec3> {
    let Some(child) = shape.child(name) else { return Ok(Vec3::splat(1.0)) };
    positive_lengths(&child.value(), name)
}

/// Three lengths above zero.
pub(crate) fn positive_lengths(value: &Value<'_>, name: &str) -> Result<Vec3> {
    let numbers = value.numbers::<3>()?;
    if let Some(bad) = numbers.iter().find(|&&number| number <= 0.0) {
        return Err(
            value.error(format!("each of the three lengths in `{name}` must be positive, found {bad}"))
        );
    }
    Ok(Vec3::from_array(numbers))
}

fn read_shape(shape: Element<'_>, geometry: Element<'_>, cx: &mut Context<'_>) -> Result<Geometry> {
    Ok(match shape.name() {
        "box" => {
            expect(shape, cx, &["size"]);
            Geometry::Cuboid { size: lengths(shape, "size")? }
        }
        "sphere" => {
            expect(shape, cx, &["radius"]);
            Geometry::Sphere { radius: length(shape, "radius", 1.0)? }
        }
        "cylinder" => {
            expect(shape, cx, &["radius", "length"]);
            Geometry::Cylinder {
                radius: length(shape, "radius", 1.0)?,
                length: length(shape, "length", 1.0)?,
            }
        }
        "capsule" => {
            expect(shape, cx, &["radius", "length"]);
            Geometry::Capsule { radius: length(shape, "radius", 0.5)?, length: length(shape, "length", 1.0)? }
        }
        "cone" => {
            expect(shape, cx, &["radius", "length"]);
            Geometry::Cone { radius: length(shape, "radius", 0.5)?, length: length(shape, "length", 1.0)? }
        }
        "ellipsoid" => {
            expect(shape, cx, &["radii"]);
            Geometry::Ellipsoid { radii: lengths(shape, "radii")? }
        }
        "plane" => {
            // The size is for looking at: the plane of a collision is infinite.
            expect(shape, cx, &["normal", "size"]);
            let normal = match shape.child("normal") {
                None => Vec3::Z,
                Some(child) => {
                    let value = child.value();
                    Vec3::from_array(value.numbers::<3>()?)
                        .normalized()
                        .ok_or_else(|| value.error("the normal of a plane must not be zero"))?
                }
            };
            if let Some(size) = shape.child("size") {
                size.value().numbers::<2>()?;
            }
            Geometry::Plane { normal }
        }
        "mesh" => read_mesh(shape, cx)?,
        "polyline" => read_polylines(geometry, cx)?,
        "heightmap" => read_heightmap(shape, cx)?,
        "image" => {
            let uri = shape.required("uri")?.value().word()?.to_owned();
            Geometry::Image { uri }
        }
        _ => Geometry::Empty,
    })
}

fn read_mesh(shape: Element<'_>, cx: &mut Context<'_>) -> Result<Geometry> {
    const MESH: Children = Children {
        single: &["uri", "scale", "submesh"],
        many: &[],
        silent: &["convex_decomposition"],
        counted: &[],
        attributes: &["optimization"],
    };
    shape.expect(&mut cx.notes, &MESH);
    let optimization = shape.attribute("optimization").filter(|value| !value.is_empty());
    let convex_hull = optimization.as_ref().is_some_and(|value| value.text() == "convex_hull");
    if let Some(optimization) = optimization.filter(|_| !convex_hull) {
        let message = format!("the mesh is used as it is, without `{}`", optimization.text());
        cx.notes.not_supported(optimization.origin(), message);
    }
    let scale = match shape.child("scale") {
        None => Vec3::splat(1.0),
        Some(child) => read_scale(&child.value())?,
    };
    let uri = shape.required("uri")?.value();
    let mut mesh = read_mesh_reference(&uri, scale, cx)?;
    mesh.convex_hull = convex_hull;
    if let Some(submesh) = shape.child("submesh") {
        mesh.submesh = Some(submesh.required("name")?.value().word()?.to_owned());
        mesh.center_submesh = submesh.flag_in("center", false)?;
    }
    Ok(Geometry::Mesh(mesh))
}

fn read_scale(value: &Value<'_>) -> Result<Vec3> {
    let scale = Vec3::from_array(value.numbers::<3>()?);
    if scale.x == 0.0 || scale.y == 0.0 || scale.z == 0.0 {
        return Err(value.error("a mesh must not be scaled by zero"));
    }
    Ok(scale)
}

/// A mesh by its URI. A file that is not there is a warning here: whoever needs the triangles makes it an error.
pub(crate) fn read_mesh_reference(uri: &Value<'_>, scale: Vec3, cx: &mut Context<'_>) -> Result<Mesh> {
    let text = uri.word()?;
    let origin = uri.origin();
    let path = match uri::find(text, origin.source(), &cx.options.search_path()) {
        Found::Path(path) => Some(path),
        Found::Nothing(message) => {
            cx.notes.not_supported(origin, format!("the mesh has no file: {message}"));
            None
        }
    };
    Ok(Mesh { uri: text.to_owned(), path, scale, submesh: None, center_submesh: false, convex_hull: false })
}

fn read_polylines(geometry: Element<'_>, cx: &mut Context<'_>) -> Result<Geometry> {
    let mut outlines = Vec::new();
    let mut height = None;
    for polyline in geometry.all("polyline") {
        polyline.expect(
            &mut cx.notes,
            &Children { single: &["height"], many: &["point"], ..Children::default() },
        );
        let points =
            polyline.all("point").map(|point| point.value().numbers::<2>()).collect::<Result<Vec<_>>>()?;
        if points.len() < 3 {
            return Err(polyline.error(format!("a polyline needs 3 points, found {}", points.len())));
        }
        outlines.push(points);
        let own = length(polyline, "height", 1.0)?;
        height.get_or_insert(own);
    }
    Ok(Geometry::Polyline { outlines, height: height.unwrap_or(1.0) })
}

fn read_heightmap(shape: Element<'_>, cx: &mut Context<'_>) -> Result<Geometry> {
    const HEIGHTMAP: Children = Children {
        single: &["uri", "size", "pos", "sampling"],
        many: &[],
        silent: &["texture", "blend", "use_terrain_paging"],
        counted: &[],
        attributes: &[],
    };
    shape.expect(&mut cx.notes, &HEIGHTMAP);
    let uri = shape.required("uri")?.value();
    let path = match uri::find(uri.word()?, uri.origin().source(), &cx.options.search_path()) {
        Found::Path(path) => Some(path),
        Found::Nothing(message) => {
            cx.notes.not_supported(uri.origin(), format!("the heightmap has no file: {message}"));
            None
        }
    };
    let position = match shape.child("pos") {
        None => Vec3::ZERO,
        Some(child) => Vec3::from_array(child.value().numbers::<3>()?),
    };
    Ok(Geometry::Heightmap { uri: uri.text().to_owned(), path, size: lengths(shape, "size")?, position })
}
