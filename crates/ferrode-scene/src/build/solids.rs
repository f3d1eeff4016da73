//! Geometries of the file become shapes of the engine.

use ferrode::collide::{Cone, Convex, Ellipsoid, TriMesh};
use ferrode::{Capsule, Cuboid, Cylinder, Error, Shape, Sphere};

use crate::description::{Collision, Geometry};
use crate::error::Notes;

/// The shape of a collision; `None`, with a warning, if the engine has none.
///
/// Meshes, terrain and outlines that are not convex become surfaces of triangles.
fn shape(collision: &Collision, notes: &mut Notes) -> Result<Option<Shape>, Error> {
    Ok(Some(match &collision.geometry {
        Geometry::Cuboid { size } => Cuboid::new(*size)?.into(),
        Geometry::Sphere { radius } => Sphere::new(*radius)?.into(),
        Geometry::Cylinder { radius, length } => Cylinder::new(*radius, *length)?.into(),
        Geometry::Capsule { radius, length } => Capsule::new(*radius, *length)?.into(),
        // An ellipsoid of equal axes is a sphere.
        Geometry::Ellipsoid { radii } if radii.x == radii.y && radii.y == radii.z => {
            Sphere::new(radii.x)?.into()
        }
        Geometry::Ellipsoid { radii } => Ellipsoid::new(*radii)?.into(),
        Geometry::Cone { radius, length } => Cone::new(*radius, *length)?.into(),
        Geometry::Mesh(mesh) if mesh.path.is_none() => {
            leave_out(collision, "its mesh has no file", notes);
            return Ok(None);
        }
        Geometry::Heightmap { path: None, .. } => {
            leave_out(collision, "its image has no file", notes);
            return Ok(None);
        }
        Geometry::Mesh(_) | Geometry::Polyline { .. } | Geometry::Heightmap { .. } => {
            return triangles(collision, notes);
        }
        Geometry::Plane { .. } => {
            leave_out(collision, "only static models have planes", notes);
            return Ok(None);
        }
        Geometry::Empty => return Ok(None),
        Geometry::Image { .. } => {
            leave_out(collision, "the shape `image` is not supported", notes);
            return Ok(None);
        }
    }))
}

/// Shapes made from files: a wheel's mesh is read once for all its wheels.
#[derive(Debug, Default)]
pub(super) struct FromFiles(Vec<(Geometry, Shape)>);

impl FromFiles {
    /// As [`shape`], but remembers what comes from files.
    pub(super) fn shape(&mut self, collision: &Collision, notes: &mut Notes) -> Result<Option<Shape>, Error> {
        if !matches!(collision.geometry, Geometry::Mesh(_) | Geometry::Heightmap { .. }) {
            return shape(collision, notes);
        }
        if let Some((_, known)) = self.0.iter().find(|(geometry, _)| *geometry == collision.geometry) {
            return Ok(Some(known.clone()));
        }
        let made = shape(collision, notes)?;
        self.0.extend(made.clone().map(|made| (collision.geometry.clone(), made)));
        Ok(made)
    }
}

fn leave_out(collision: &Collision, why: &str, notes: &mut Notes) {
    let message = format!("collision `{}` is left out: {why}", collision.name);
    notes.not_supported(collision.origin.clone(), message);
}

fn triangles(collision: &Collision, notes: &mut Notes) -> Result<Option<Shape>, Error> {
    let triangles = match collision.geometry.triangles() {
        Some(Ok(triangles)) => triangles,
        Some(Err(why)) => {
            leave_out(collision, &why, notes);
            return Ok(None);
        }
        None => return Ok(None),
    };
    if matches!(&collision.geometry, Geometry::Mesh(mesh) if mesh.convex_hull) {
        return Ok(Some(Convex::from_points(&triangles.vertices)?.into()));
    }
    let outlined = matches!(collision.geometry, Geometry::Polyline { .. });
    let hull = if outlined { Convex::from_points(&triangles.vertices).ok() } else { None };
    let surface = TriMesh::new(triangles.vertices, triangles.triangles)?;
    Ok(Some(match hull {
        // Nothing is added by closing it up: it is convex, and a convex body makes the better contacts.
        Some(hull) if hull.volume() - surface.volume() <= 1e-9 * hull.volume() => hull.into(),
        _ => surface.into(),
    }))
}
