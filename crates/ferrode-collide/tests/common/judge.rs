//! Whether a contact contradicts the geometry, by brute force over all triangles and none of the crate's pairs.

use ferrode_collide::{Frame, GeomContact, Heightfield, Shape, TriMesh, point_depth};
use ferrode_math::{Aabb, Vec3, rotation};

/// Lengths and cosines nearer than this are one: meshes of libode are of single precision.
const NEAR: f64 = 1e-4;

/// The triangles of a mesh or heightfield in the world.
pub struct Surface {
    triangles: Vec<[Vec3; 3]>,
    /// Whether there is an inside that a field's or mesh's triangles close or bound from above.
    is_field: bool,
}

impl Surface {
    /// Of a field only the triangles near a box in the world; `None` of other shapes.
    pub fn of(shape: &Shape, frame: &Frame, around: &Aabb) -> Option<Self> {
        match shape {
            Shape::TriMesh(mesh) => Some(Self::of_mesh(mesh, frame)),
            Shape::Heightfield(field) => Some(Self::of_field(field, frame, around)),
            _ => None,
        }
    }

    fn of_mesh(mesh: &TriMesh, frame: &Frame) -> Self {
        let place = |t: &[u32; 3]| t.map(|v| frame.point_to_world(mesh.vertices()[v as usize]));
        Self { triangles: mesh.triangles().iter().map(place).collect(), is_field: false }
    }

    fn of_field(field: &Heightfield, frame: &Frame, around: &Aabb) -> Self {
        let (center, half) = (around.center(), around.extent() * 0.5);
        let reach = half.length();
        let local = frame.point_to_local(center);
        let (sx, sz) = field.cell();
        let range = |c: f64, whole: f64, size: f64, n: usize| {
            let from = ((c - reach + 0.5 * whole) / size).floor() as i64 - 1;
            let to = ((c + reach + 0.5 * whole) / size).ceil() as i64 + 1;
            if field.is_wrapped() { (from, to) } else { (from.max(0), to.min(n as i64 - 1)) }
        };
        let (x0, x1) = range(local.x, field.width(), sx, field.columns());
        let (z0, z1) = range(local.z, field.depth(), sz, field.rows());
        let mut triangles = Vec::new();
        for x in x0..x1 {
            for z in z0..z1 {
                let [a, b, c, d] = [(0, 0), (1, 0), (0, 1), (1, 1)]
                    .map(|(i, j)| frame.point_to_world(field.vertex(x + i, z + j)));
                triangles.extend([[a, c, b], [d, b, c]]);
            }
        }
        Self { triangles, is_field: true }
    }

    /// Metres from a point to the nearest triangle.
    pub fn distance(&self, p: Vec3) -> f64 {
        self.triangles.iter().map(|t| distance(t, p)).fold(f64::INFINITY, f64::min)
    }

    /// Whether the point is at, below or inside the surface: the nearest triangles, if there are several, agree that it is
    /// behind them.
    pub fn is_behind(&self, p: Vec3) -> bool {
        let least = self.distance(p);
        let mut near = self.triangles.iter().filter(|t| distance(t, p) <= least + 1e-9);
        near.any(|t| normal(t).dot(p - t[0]) <= NEAR)
    }

    /// Whether the surface goes on beyond triangle `i`, where that is furthest along `m` or where the contact is, further
    /// along `m`: then `m` is no normal that the surface has there.
    fn rises(&self, i: usize, m: Vec3, p: Vec3) -> bool {
        let level = self.triangles[i].map(|v| m.dot(v)).into_iter().fold(f64::NEG_INFINITY, f64::max);
        let at = |q: Vec3, t: &[Vec3; 3]| {
            distance(t, q) < NEAR && t.iter().any(|v| m.dot(*v - q) > NEAR)
        };
        let furthest = self.triangles[i].iter().filter(|v| m.dot(**v) > level - 1e-6);
        let others = || self.triangles.iter().enumerate().filter(|(j, _)| *j != i).map(|(_, t)| t);
        furthest.clone().all(|v| others().any(|t| at(*v, t))) && furthest.count() > 0
            || distance(&self.triangles[i], p) < NEAR && others().any(|t| at(p, t))
    }

    fn normal(&self, i: usize) -> Vec3 {
        normal(&self.triangles[i])
    }

    /// How far along `d` a ray meets the surface, and whether it leaves through a back.
    fn ray(&self, from: Vec3, d: Vec3) -> Option<(f64, bool)> {
        let hit = |t: &[Vec3; 3]| {
            let n = normal(t);
            let slope = n.dot(d);
            let alpha = n.dot(t[0] - from) / slope;
            let inside = distance(t, from + d * alpha) < 1e-7;
            (slope != 0.0 && alpha > 1e-7 && inside).then_some((alpha, slope > 0.0))
        };
        self.triangles.iter().filter_map(hit).min_by(|a, b| a.0.total_cmp(&b.0))
    }
}

fn normal(t: &[Vec3; 3]) -> Vec3 {
    (t[1] - t[0]).cross(t[2] - t[0]).normalized().unwrap_or(Vec3::ZERO)
}

/// Distance of a point from a triangle, by projecting to its plane, its sides and its corners.
fn distance(t: &[Vec3; 3], p: Vec3) -> f64 {
    let n = normal(t);
    let inside = (0..3).all(|e| (t[(e + 1) % 3] - t[e]).cross(p - t[e]).dot(n) >= 0.0);
    if inside {
        return n.dot(p - t[0]).abs();
    }
    (0..3)
        .map(|e| {
            let side = t[(e + 1) % 3] - t[e];
            let s = (side.dot(p - t[e]) / side.length_squared()).clamp(0.0, 1.0);
            (p - (t[e] + side * s)).length()
        })
        .fold(f64::INFINITY, f64::min)
}

/// The least and greatest coordinate of a shape along a direction.
pub fn extent(shape: &Shape, frame: &Frame, d: Vec3) -> (f64, f64) {
    let turn = rotation::from_z_axis(d).unwrap().transpose();
    let aabb = shape.aabb_in(&Frame::new(turn * frame.position, turn * frame.rotation));
    (aabb.min.z, aabb.max.z)
}

/// A pair of geoms whose contacts are judged.
pub struct Judge<'a> {
    pub shapes: [&'a Shape; 2],
    pub frames: [&'a Frame; 2],
    pub surfaces: [Option<Surface>; 2],
}

impl<'a> Judge<'a> {
    pub fn new(a: &'a (Shape, Frame), b: &'a (Shape, Frame)) -> Self {
        let around = |s: &(Shape, Frame)| s.0.aabb_in(&s.1);
        let surfaces = [Surface::of(&a.0, &a.1, &around(b)), Surface::of(&b.0, &b.1, &around(a))];
        Self { shapes: [&a.0, &b.0], frames: [&a.1, &b.1], surfaces }
    }

    /// How far a point is from the solid of geom `k`: inside, nothing.
    fn outside(&self, k: usize, p: Vec3) -> f64 {
        match &self.surfaces[k] {
            Some(s) if s.is_behind(p) => 0.0,
            Some(s) => s.distance(p),
            None => point_depth(self.shapes[k], self.frames[k], p).map_or(0.0, |d| (-d).max(0.0)),
        }
    }

    /// Why a contact contradicts the geometry; `None` if nothing speaks against it. `sides` are the triangles it names.
    pub fn fault(&self, c: &GeomContact, sides: [i64; 2]) -> Option<&'static str> {
        let (p, n, depth) = (c.point.position, c.point.normal, c.point.depth);
        if !(n.length() - 1.0).abs().lt(&1e-6) || !depth.is_finite() || !p.is_finite() {
            return Some("no unit normal");
        }
        let into = [n, -n];
        // The point lies within either solid, or as far from it as the contact is deep.
        for k in 0..2 {
            if self.outside(k, p) > depth + NEAR {
                return Some("the point is beside a body");
            }
        }
        for k in 0..2 {
            // The surface is that of geom k; m points away from it, into the other.
            let (Some(surface), m) = (&self.surfaces[k], into[1 - k]) else { continue };
            let convex = matches!(self.shapes[1 - k], Shape::Convex(_));
            if let Ok(i) = usize::try_from(sides[k])
                && !convex
                && !surface.is_field
            {
                if m.dot(surface.normal(i)) < -1e-6 {
                    return Some("the normal points into the triangle");
                }
                if self.surfaces[1 - k].is_none() && surface.rises(i, m, p) {
                    return Some("the surface rises beyond the triangle");
                }
            }
            // Of two surfaces: the point of the one that is inside the other.
            if self.surfaces[1 - k].is_some() && !surface.is_field && depth > NEAR {
                let other = self.surfaces[1 - k].as_ref().unwrap();
                if other.is_field {
                    if sides == [-1, -1] && other.distance(p) < NEAR {
                        // A corner of the field: down out of the mesh.
                        return match surface.ray(p, m * -1.0) {
                            Some((way, true)) if (way - depth).abs() < NEAR => None,
                            _ => Some("the way out of the mesh has another length"),
                        };
                    }
                } else if surface.distance(p) > NEAR && surface.distance(p) < 0.5 * depth {
                    return Some("the surface is less than half as far elsewhere");
                }
            }
            if convex && !surface.is_field && depth > NEAR {
                // Depth is what the body reaches below some triangle along the normal.
                let low = extent(self.shapes[1 - k], self.frames[1 - k], m).0;
                let fits = |t: &[Vec3; 3]| {
                    let high = t.map(|v| m.dot(v)).into_iter().fold(f64::NEG_INFINITY, f64::max);
                    (high - low - depth).abs() < NEAR
                };
                if !surface.triangles.iter().any(fits) {
                    return Some("the depth is no triangle's along the normal");
                }
            }
        }
        None
    }
}
