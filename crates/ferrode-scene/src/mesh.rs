//! Triangles: of mesh files (STL, OBJ, COLLADA) and of extruded outlines.

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::Path;

use earcut::Earcut;
use ferrode_math::Vec3;

use crate::description::{Geometry, Mesh};
use crate::heightmap;

/// A surface of triangles, counter-clockwise as seen from outside.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Triangles {
    /// The corners, in metres.
    pub vertices: Vec<Vec3>,
    /// The numbers of the corners of each triangle.
    pub triangles: Vec<[u32; 3]>,
}

impl Geometry {
    /// The triangles of a mesh, polyline or heightmap, in the collision's own frame; `None` for other shapes.
    ///
    /// # Errors
    /// Why the file cannot be read, or the outlines enclose nothing.
    pub fn triangles(&self) -> Option<Result<Triangles, String>> {
        match self {
            Geometry::Mesh(mesh) => Some(load(mesh)),
            Geometry::Polyline { outlines, height } => Some(extrude(outlines, *height)),
            Geometry::Heightmap { path: Some(path), size, position, .. } => {
                Some(heightmap::surface(path, *size, *position))
            }
            _ => None,
        }
    }
}

/// Reads a mesh file and scales it.
fn load(mesh: &Mesh) -> Result<Triangles, String> {
    let Some(path) = &mesh.path else { return Err(format!("`{}` has no file", mesh.uri)) };
    let mut read = read(path)?;
    if let Some(wanted) = &mesh.submesh {
        let names: Vec<String> = read.iter().map(|(name, _)| name.clone()).collect();
        read.retain(|(name, _)| name == wanted);
        if read.is_empty() {
            return Err(format!("`{}` has no part `{wanted}`, but: {}", mesh.uri, names.join(", ")));
        }
    }
    let mut all = Triangles::default();
    for (_, part) in read {
        let start = all.vertices.len() as u32;
        all.vertices.extend(part.vertices);
        all.triangles.extend(part.triangles.iter().map(|corners| corners.map(|corner| corner + start)));
    }
    if all.triangles.is_empty() {
        return Err(format!("`{}` holds no triangle", mesh.uri));
    }
    if mesh.submesh.is_some() && mesh.center_submesh {
        let low = all.vertices.iter().copied().fold(Vec3::splat(f64::INFINITY), Vec3::min);
        let high = all.vertices.iter().copied().fold(Vec3::splat(f64::NEG_INFINITY), Vec3::max);
        let middle = (low + high) * 0.5;
        all.vertices.iter_mut().for_each(|vertex| *vertex -= middle);
    }
    let scale = mesh.scale;
    all.vertices.iter_mut().for_each(|vertex| *vertex = vertex.component_mul(scale));
    if scale.x * scale.y * scale.z < 0.0 {
        // A mirror turns the triangles inside out.
        all.triangles.iter_mut().for_each(|corners| corners.swap(1, 2));
    }
    Ok(all)
}

fn read(path: &Path) -> Result<Vec<(String, Triangles)>, String> {
    // The file may be anything, and the crate that reads it is not ours: should it panic, that is an error too.
    let loaded = catch_unwind(AssertUnwindSafe(|| mesh_loader::Loader::default().load(path)));
    let scene = match loaded {
        Ok(Ok(scene)) => scene,
        Ok(Err(error)) => return Err(format!("`{}` cannot be read: {error}", path.display())),
        Err(_) => return Err(format!("`{}` cannot be read", path.display())),
    };
    let mut parts = Vec::with_capacity(scene.meshes.len());
    for mesh in scene.meshes {
        let vertices: Vec<Vec3> =
            mesh.vertices.iter().map(|vertex| Vec3::from_array(vertex.map(f64::from))).collect();
        let sound = vertices.iter().all(|vertex| vertex.is_finite())
            && mesh.faces.iter().flatten().all(|&corner| (corner as usize) < vertices.len());
        if !sound {
            return Err(format!(
                "`{}` holds numbers that are not finite, or corners it does not have",
                path.display()
            ));
        }
        parts.push((mesh.name.clone(), Triangles { vertices, triangles: mesh.faces }));
    }
    Ok(parts)
}

/// The body between closed outlines at z = 0 and the same at `height`. An outline inside an odd number of others is
/// a hole.
fn extrude(outlines: &[Vec<[f64; 2]>], height: f64) -> Result<Triangles, String> {
    let outlines: Vec<Vec<[f64; 2]>> = outlines.iter().map(|outline| without_repeats(outline)).collect();
    if outlines.iter().any(|outline| outline.len() < 3 || signed_area(outline) == 0.0) {
        return Err("an outline encloses nothing".to_owned());
    }
    let depth: Vec<usize> = outlines
        .iter()
        .enumerate()
        .map(|(index, outline)| {
            let others = outlines.iter().enumerate().filter(|&(other, _)| other != index);
            others.filter(|(_, other)| contains(other, outline[0])).count()
        })
        .collect();
    let mut body = Triangles::default();
    for (index, outline) in outlines.iter().enumerate().filter(|&(index, _)| depth[index].is_multiple_of(2)) {
        let mut rings = vec![wound(outline, true)];
        for (hole, ring) in outlines.iter().enumerate() {
            if depth[hole] == depth[index] + 1 && contains(outline, ring[0]) {
                rings.push(wound(ring, false));
            }
        }
        extrude_rings(&mut body, &rings, height);
    }
    Ok(body)
}

/// Adds the body between rings, the first one around and counter-clockwise, the others holes and clockwise.
fn extrude_rings(body: &mut Triangles, rings: &[Vec<[f64; 2]>], height: f64) {
    let start = body.vertices.len() as u32;
    let points: Vec<[f64; 2]> = rings.iter().flatten().copied().collect();
    let count = points.len() as u32;
    let mut holes: Vec<u32> = Vec::new();
    let mut at = 0;
    for ring in &rings[..rings.len() - 1] {
        at += ring.len() as u32;
        holes.push(at);
    }
    let mut flat: Vec<u32> = Vec::new();
    Earcut::new().earcut(points.iter().copied(), &holes, &mut flat);
    for z in [0.0, height] {
        body.vertices.extend(points.iter().map(|&[x, y]| Vec3::new(x, y, z)));
    }
    for corners in flat.chunks_exact(3) {
        let [a, b, c] = [corners[0], corners[1], corners[2]];
        let [pa, pb, pc] = [a, b, c].map(|corner| points[corner as usize]);
        // Up on top, down at the bottom, whichever way the triangulation goes round.
        let (b, c) = if signed_area(&[pa, pb, pc]) > 0.0 { (b, c) } else { (c, b) };
        body.triangles.push([start + a, start + c, start + b]);
        body.triangles.push([start + count + a, start + count + b, start + count + c]);
    }
    let mut first = start;
    for ring in rings {
        let length = ring.len() as u32;
        for index in 0..length {
            let (a, b) = (first + index, first + (index + 1) % length);
            body.triangles.push([a, b, b + count]);
            body.triangles.push([a, b + count, a + count]);
        }
        first += length;
    }
}

fn without_repeats(outline: &[[f64; 2]]) -> Vec<[f64; 2]> {
    let mut points: Vec<[f64; 2]> = Vec::with_capacity(outline.len());
    for &point in outline {
        if points.last() != Some(&point) {
            points.push(point);
        }
    }
    // A file may or may not close the outline by repeating its first point.
    if points.len() > 1 && points.first() == points.last() {
        points.pop();
    }
    points
}

/// Positive if counter-clockwise.
fn signed_area(outline: &[[f64; 2]]) -> f64 {
    let next = outline.iter().cycle().skip(1);
    outline.iter().zip(next).map(|(a, b)| a[0] * b[1] - b[0] * a[1]).sum::<f64>() * 0.5
}

fn wound(outline: &[[f64; 2]], counter_clockwise: bool) -> Vec<[f64; 2]> {
    let mut points = outline.to_vec();
    if (signed_area(outline) > 0.0) != counter_clockwise {
        points.reverse();
    }
    points
}

/// Whether a point lies inside an outline: by the number of edges to its right.
fn contains(outline: &[[f64; 2]], [x, y]: [f64; 2]) -> bool {
    let next = outline.iter().cycle().skip(1);
    let crossed = outline
        .iter()
        .zip(next)
        .filter(|(a, b)| (a[1] > y) != (b[1] > y) && x < a[0] + (y - a[1]) / (b[1] - a[1]) * (b[0] - a[0]));
    !crossed.count().is_multiple_of(2)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn volume(body: &Triangles) -> f64 {
        body.triangles
            .iter()
            .map(|corners| {
                let [a, b, c] = corners.map(|corner| body.vertices[corner as usize]);
                a.dot(b.cross(c)) / 6.0
            })
            .sum()
    }

    fn square(side: f64, clockwise: bool) -> Vec<[f64; 2]> {
        let h = 0.5 * side;
        let mut points = vec![[-h, -h], [h, -h], [h, h], [-h, h]];
        if clockwise {
            points.reverse();
        }
        points
    }

    #[test]
    fn outlines_become_closed_bodies() {
        for clockwise in [false, true] {
            let plain = extrude(&[square(2.0, clockwise)], 3.0).unwrap();
            assert!((volume(&plain) - 12.0).abs() < 1e-12);
            // A square with a hole in which a smaller square stands.
            let nested = [square(1.0, clockwise), square(4.0, clockwise), square(3.0, !clockwise)];
            let body = extrude(&nested, 0.5).unwrap();
            assert!((volume(&body) - 0.5 * (16.0 - 9.0 + 1.0)).abs() < 1e-12, "{}", volume(&body));
            // Closed: each edge is used once each way.
            let mut edges = Vec::new();
            for [a, b, c] in &body.triangles {
                edges.extend([(*a, *b), (*b, *c), (*c, *a)]);
            }
            assert!(edges.iter().all(|&(a, b)| edges.contains(&(b, a))));
        }
    }

    #[test]
    fn outlines_that_are_not_convex_are_triangulated() {
        let arrow = vec![[-0.5, -0.5], [-0.5, 0.5], [0.5, 0.5], [0.0, 0.0], [0.5, -0.5], [-0.5, -0.5]];
        assert!((volume(&extrude(&[arrow], 1.0).unwrap()) - 0.75).abs() < 1e-12);
        assert!(extrude(&[vec![[0.0, 0.0], [1.0, 1.0], [2.0, 2.0]]], 1.0).is_err());
    }
}
