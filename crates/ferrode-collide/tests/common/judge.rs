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

    /// Whether `m` is a normal of the surface where triangle `i` bears a contact: at `place` if that is on it, else where the
    /// triangle is furthest along `m`. Normals there are those between the normals of all triangles that meet.
    fn has_normal(&self, i: usize, m: Vec3, place: Vec3) -> bool {
        let own = &self.triangles[i];
        let at = if distance(own, place) < NEAR {
            place
        } else {
            let level = own.map(|v| m.dot(v)).into_iter().fold(f64::NEG_INFINITY, f64::max);
            let far: Vec<Vec3> = own.iter().copied().filter(|v| m.dot(*v) > level - 1e-6).collect();
            far.iter().fold(Vec3::ZERO, |s, v| s + *v) * (1.0 / far.len() as f64)
        };
        let meet: Vec<Vec3> = self.triangles.iter().filter(|t| distance(t, at) < NEAR).map(normal).collect();
        is_between(m, &meet)
    }

    /// The triangles within a depth of a point.
    fn near(&self, p: Vec3, depth: f64) -> impl Iterator<Item = usize> {
        (0..self.triangles.len()).filter(move |&i| distance(&self.triangles[i], p) < depth + NEAR)
    }

    /// Whether `m` is a normal where triangle `i` is nearest to a point.
    fn bears(&self, i: usize, m: Vec3, p: Vec3) -> bool {
        self.has_normal(i, m, nearest(&self.triangles[i], p))
    }

    /// Whether the surface goes on, flat or rising, further along `m` beside a point.
    fn rises_at(&self, m: Vec3, p: Vec3) -> bool {
        (0..self.triangles.len()).any(|i| {
            distance(&self.triangles[i], p) < NEAR && {
                let own = &self.triangles[i];
                let n = normal(own);
                self.triangles.iter().enumerate().any(|(j, t)| {
                    j != i
                        && distance(t, p) < NEAR
                        && t.iter().any(|v| m.dot(*v - p) > NEAR && n.dot(*v - own[0]) > -NEAR)
                        && own.iter().filter(|v| t.iter().any(|w| (*w - **v).length() < NEAR)).count() == 2
                })
            }
        })
    }

    /// How far along `d` a ray meets triangles, from either side, in order.
    pub fn hits(&self, from: Vec3, d: Vec3, length: f64) -> Vec<f64> {
        let hit = |t: &[Vec3; 3]| {
            let n = normal(t);
            let alpha = n.dot(t[0] - from) / n.dot(d);
            let inside = alpha.is_finite() && distance(t, from + d * alpha) < 1e-7;
            (inside && (-1e-9..=length + 1e-9).contains(&alpha)).then_some(alpha)
        };
        let mut hits: Vec<_> = self.triangles.iter().filter_map(hit).collect();
        hits.sort_by(f64::total_cmp);
        hits
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

/// Whether a unit vector is a sum of the given ones with weights that are not negative: the residual of such a sum, made
/// least weight by weight, is nothing.
fn is_between(m: Vec3, of: &[Vec3]) -> bool {
    let mut weights = vec![0.0; of.len()];
    let mut rest = m;
    for _ in 0..500 {
        for (w, n) in weights.iter_mut().zip(of) {
            let next = f64::max(0.0, *w + rest.dot(*n));
            rest -= *n * (next - *w);
            *w = next;
        }
    }
    rest.length() < 1e-3
}

/// The point of a triangle nearest to another, by projecting to its plane, its sides and its corners.
fn nearest(t: &[Vec3; 3], p: Vec3) -> Vec3 {
    let n = normal(t);
    let inside = (0..3).all(|e| (t[(e + 1) % 3] - t[e]).cross(p - t[e]).dot(n) >= 0.0);
    if inside {
        return p - n * n.dot(p - t[0]);
    }
    let on_side = |e: usize| {
        let side = t[(e + 1) % 3] - t[e];
        t[e] + side * (side.dot(p - t[e]) / side.length_squared()).clamp(0.0, 1.0)
    };
    (0..3)
        .map(on_side)
        .min_by(|x, y| (*x - p).length_squared().total_cmp(&(*y - p).length_squared()))
        .unwrap()
}

fn distance(t: &[Vec3; 3], p: Vec3) -> f64 {
    (nearest(t, p) - p).length()
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

    /// Why a contact contradicts the geometry; `None` if nothing speaks against it. It is one of
    /// `list`, which has the triangles that they name. Of our own contacts only what needs no opinion is asked: unit normals,
    /// points within the bodies, lengths of ways out.
    pub fn fault(&self, list: &[(GeomContact, [i64; 2])], c: usize, own: bool) -> Option<&'static str> {
        let (c, sides) = &list[c];
        let (p, n, depth) = (c.point.position, c.point.normal, c.point.depth);
        if !(n.length() - 1.0).abs().lt(&1e-6) || !depth.is_finite() || !p.is_finite() {
            return Some("no unit normal");
        }
        let into = [n, -n];
        let same = |k: &&(GeomContact, [i64; 2])| k.0.point.normal.dot(n) > 1.0 - 1e-6 && k.0 != *c;
        let is_deepest = !list.iter().filter(same).any(|k| k.0.point.depth > depth + NEAR);
        // A rule decides on all contacts with a triangle at once, by the deepest.
        let (place, _) = list
            .iter()
            .filter(|k| k.1 == *sides && k.0.point.normal.dot(n) > 1.0 - 1e-6)
            .map(|k| (k.0.point.position, k.0.point.depth))
            .fold((p, depth), |a, b| if b.1 > a.1 { b } else { a });
        // The point lies within either solid, or as far from it as the contact is deep.
        for k in 0..2 {
            // The cap of a cylinder is an octagon about its circle.
            let octagon = if let Shape::Cylinder(s) = self.shapes[k] { 0.083 * s.radius() } else { 0.0 };
            if self.outside(k, p) > depth + NEAR + octagon {
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
                && self.surfaces[1 - k].is_none()
                && !own
                && !surface.has_normal(i, m, place)
            {
                return Some("the surface has no such normal there");
            }
            // Of two surfaces: the point of the one that is inside the other.
            if self.surfaces[1 - k].is_some() && !surface.is_field && depth > NEAR {
                let other = self.surfaces[1 - k].as_ref().unwrap();
                if other.is_field {
                    if *sides == [-1, -1] && other.distance(p) < NEAR {
                        // A corner of the field: down out of the mesh.
                        return match surface.ray(p, m) {
                            Some((way, true)) if (way - depth).abs() < NEAR => None,
                            _ => Some("the way out of the mesh has another length"),
                        };
                    }
                } else if surface.distance(p) > NEAR && surface.distance(p) < 0.5 * depth {
                    return Some("the surface is less than half as far elsewhere");
                } else if !own
                    && surface.distance(p) < NEAR
                    && other.distance(p) < NEAR
                    && depth > 10.0 * NEAR
                {
                    return Some("the point is on both surfaces");
                } else if !own
                    && !surface.near(p, depth).any(|i| surface.bears(i, m, p))
                    && !other.near(p, depth).any(|i| other.bears(i, m * -1.0, p))
                {
                    return Some("the surface has no such normal there");
                } else if !own && other.distance(p) < NEAR && other.rises_at(m * -1.0, p) {
                    return Some("the mesh goes on deeper beside the point");
                }
            }
            // libode names no triangles of convex bodies' contacts: any near will do.
            if convex
                && !own
                && !surface.is_field
                && let Some(fault) = self.convex_fault(1 - k, surface, c, m, is_deepest)
            {
                return Some(fault);
            }
        }
        None
    }

    fn convex_fault(
        &self,
        body: usize,
        surface: &Surface,
        c: &GeomContact,
        m: Vec3,
        is_deepest: bool,
    ) -> Option<&'static str> {
        let (p, depth) = (c.point.position, c.point.depth);
        let near = || surface.triangles.iter().enumerate().filter(|(_, t)| distance(t, p) < depth + NEAR);
        if !near().any(|(i, t)| surface.has_normal(i, m, nearest(t, p))) {
            return Some("the surface has no such normal there");
        }
        // Depth is what the body reaches below some triangle along the normal.
        let low = extent(self.shapes[body], self.frames[body], m).0;
        let fits = |t: &[Vec3; 3]| {
            let high = t.map(|v| m.dot(v)).into_iter().fold(f64::NEG_INFINITY, f64::max);
            (high - low - depth).abs() < NEAR
        };
        if is_deepest && depth > NEAR && !near().any(|(_, t)| fits(t)) {
            return Some("the depth is no triangle's along the normal");
        }
        // How far the body reaches below the surface on the line through the point.
        let inside =
            |t: f64| point_depth(self.shapes[body], self.frames[body], p + m * t).is_some_and(|d| d > 0.0);
        let steps = || (-300..=300).map(|k| f64::from(k) * 0.01 + 1e-5);
        if let Some(first) = steps().find(|&t| inside(t)) {
            let (mut below, mut above) = (first - 0.01, first);
            for _ in 0..50 {
                let middle = 0.5 * (below + above);
                *(if inside(middle) { &mut above } else { &mut below }) = middle;
            }
            let up = |t: &[Vec3; 3]| {
                let n = normal(t);
                let way = n.dot(t[0] - p) / n.dot(m);
                (n.dot(m) > 1e-6 && distance(t, p + m * way) < NEAR).then_some(way - above)
            };
            let overlaps: Vec<f64> = surface.triangles.iter().filter_map(up).filter(|w| *w > 0.0).collect();
            if !overlaps.is_empty() && overlaps.iter().all(|w| (w - depth).abs() > 1e-3) {
                return Some("the bodies overlap by another length at the point");
            }
        }
        None
    }
}
