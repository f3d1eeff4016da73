//! Geometries of the file become shapes of the engine.

use ferrode::collide::{Convex, TriMesh};
use ferrode::{Capsule, Cuboid, Cylinder, Error, Shape, Sphere, Vec3};

use crate::description::{Collision, Geometry};
use crate::error::Notes;

/// The shape of a collision; `None`, with a warning, if the engine has none.
///
/// Ellipsoids and cones become polyhedra, and a warning says how far these lie within. Meshes, terrain and outlines
/// that are not convex become surfaces of triangles.
pub(super) fn shape(collision: &Collision, notes: &mut Notes) -> Result<Option<Shape>, Error> {
    Ok(Some(match &collision.geometry {
        Geometry::Cuboid { size } => Cuboid::new(*size)?.into(),
        Geometry::Sphere { radius } => Sphere::new(*radius)?.into(),
        Geometry::Cylinder { radius, length } => Cylinder::new(*radius, *length)?.into(),
        Geometry::Capsule { radius, length } => Capsule::new(*radius, *length)?.into(),
        // An ellipsoid of equal axes is a sphere.
        Geometry::Ellipsoid { radii } if radii.x == radii.y && radii.y == radii.z => {
            Sphere::new(radii.x)?.into()
        }
        Geometry::Ellipsoid { radii } => {
            let polyhedron = ellipsoid(*radii)?;
            let within = gap(&polyhedron, |normal| normal.component_mul(*radii).length());
            note_polyhedron(collision, &polyhedron, within, notes);
            polyhedron.into()
        }
        Geometry::Cone { radius, length } => {
            let polyhedron = cone(*radius, *length)?;
            let within = gap(&polyhedron, |normal| {
                let across = (normal.x * normal.x + normal.y * normal.y).sqrt();
                (0.5 * length * normal.z).max(radius * across - 0.5 * length * normal.z)
            });
            note_polyhedron(collision, &polyhedron, within, notes);
            polyhedron.into()
        }
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

fn note_polyhedron(collision: &Collision, polyhedron: &Convex, within: f64, notes: &mut Notes) {
    let message = format!(
        "the {} of collision `{}` is a polyhedron of {} corners here, up to {:.2} mm within",
        collision.geometry.kind(),
        collision.name,
        polyhedron.points().len(),
        1000.0 * within
    );
    notes.not_supported(collision.origin.clone(), message);
}

/// How far a body reaches beyond the faces of an inscribed polyhedron. `support` is the body's reach along a unit
/// vector.
fn gap(polyhedron: &Convex, support: impl Fn(Vec3) -> f64) -> f64 {
    (0..polyhedron.face_count())
        .map(|face| {
            let (normal, distance) = polyhedron.face_plane(face);
            support(normal) - distance
        })
        .fold(0.0, f64::max)
}

/// A sphere of triangles, stretched: the icosahedron with its edges halved twice.
fn ellipsoid(radii: Vec3) -> Result<Convex, Error> {
    let golden = 0.5 * (1.0 + 5.0f64.sqrt());
    let mut points: Vec<Vec3> = Vec::new();
    for (a, b) in [(1.0, golden), (1.0, -golden), (-1.0, golden), (-1.0, -golden)] {
        points.extend([Vec3::new(0.0, a, b), Vec3::new(a, b, 0.0), Vec3::new(b, 0.0, a)]);
    }
    // Halving all edges of the polyhedron so far: two points are joined if no third lies nearer to both.
    let mut edge = 2.0 / (1.0 + golden * golden).sqrt();
    points.iter_mut().for_each(|point| *point = point.normalized_or(Vec3::X));
    for _ in 0..2 {
        let mut middles = Vec::new();
        for (index, &a) in points.iter().enumerate() {
            for &b in &points[index + 1..] {
                if (a - b).length() < 1.3 * edge {
                    middles.push(((a + b) * 0.5).normalized_or(Vec3::X));
                }
            }
        }
        points.extend(middles);
        edge *= 0.55;
    }
    let stretched: Vec<Vec3> = points.iter().map(|point| point.component_mul(radii)).collect();
    Ok(Convex::from_points(&stretched)?)
}

/// A pyramid over a polygon of 32 corners.
fn cone(radius: f64, length: f64) -> Result<Convex, Error> {
    const CORNERS: usize = 32;
    let mut points = vec![Vec3::new(0.0, 0.0, 0.5 * length)];
    points.extend((0..CORNERS).map(|corner| {
        let angle = 2.0 * std::f64::consts::PI * corner as f64 / CORNERS as f64;
        let (x, y) = (ferrode::math::real::cos(angle), ferrode::math::real::sin(angle));
        Vec3::new(radius * x, radius * y, -0.5 * length)
    }));
    Ok(Convex::from_points(&points)?)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn polyhedra_are_close_to_what_they_stand_for() {
        let pi = std::f64::consts::PI;
        let radii = Vec3::new(0.2, 0.3, 0.5);
        let body = ellipsoid(radii).unwrap();
        // Icosahedron, edges halved twice: 12 + 30 + 120 corners.
        assert_eq!(body.points().len(), 162);
        let full = 4.0 / 3.0 * pi * 0.2 * 0.3 * 0.5;
        assert!(body.volume() < full && body.volume() > 0.95 * full, "{} {full}", body.volume());
        let within = gap(&body, |normal| normal.component_mul(radii).length());
        assert!(within > 0.0 && within < 0.025 * 0.5, "{within}");

        let body = cone(0.5, 2.0).unwrap();
        let full = pi * 0.25 * 2.0 / 3.0;
        assert!(body.volume() < full && body.volume() > 0.99 * full);
        let within = gap(&body, |normal| {
            let across = (normal.x * normal.x + normal.y * normal.y).sqrt();
            normal.z.max(0.5 * across - normal.z)
        });
        assert!(within > 0.0 && within < 0.005 * 0.5, "{within}");
    }
}
