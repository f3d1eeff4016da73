//! Convex hull of a cloud of points (quickhull: Barber, Dobkin and Huhdanpaa, 1996).

use super::ShapeError;
use ferrode_math::Vec3;
use std::collections::HashMap;

/// The corners that are left, and the faces, counter-clockwise as seen from outside.
pub(super) struct Hull {
    pub points: Vec<Vec3>,
    pub faces: Vec<Vec<u32>>,
}

struct Triangle {
    v: [u32; 3],
    normal: Vec3,
    d: f64,
    /// Points above this triangle that are not yet in the hull, and the furthest.
    outside: Vec<u32>,
    furthest: (f64, u32),
    alive: bool,
}

/// Points nearer to a face than this part of the cloud's size lie on it.
const THICK: f64 = 1e-10;
/// Normals whose cosine is beyond this belong to one face.
const COPLANAR: f64 = 1.0 - 1e-10;

struct Builder<'a> {
    points: &'a [Vec3],
    triangles: Vec<Triangle>,
    /// The triangle alive that has each edge in this direction. Only looked up, never walked.
    edges: HashMap<(u32, u32), usize>,
    slack: f64,
}

impl Builder<'_> {
    fn at(&self, i: u32) -> Vec3 {
        self.points[i as usize]
    }

    fn add(&mut self, v: [u32; 3]) {
        let [a, b, c] = v.map(|i| self.at(i));
        let normal = (b - a).cross(c - a).normalized_or(Vec3::ZERO);
        let d = normal.dot((a + b + c) * (1.0 / 3.0));
        for (from, to) in sides(v) {
            self.edges.insert((from, to), self.triangles.len());
        }
        self.triangles.push(Triangle { v, normal, d, outside: Vec::new(), furthest: (0.0, 0), alive: true });
    }

    /// Gives a point to the first of the triangles from `first` on that it is above.
    fn assign(&mut self, point: u32, first: usize) {
        let p = self.at(point);
        for t in &mut self.triangles[first..] {
            let height = t.normal.dot(p) - t.d;
            if t.alive && height > self.slack {
                t.outside.push(point);
                if height > t.furthest.0 {
                    t.furthest = (height, point);
                }
                return;
            }
        }
    }
}

/// The edges of a triangle.
fn sides(v: [u32; 3]) -> [(u32, u32); 3] {
    [(v[0], v[1]), (v[1], v[2]), (v[2], v[0])]
}

/// The hull of at least four finite points.
pub(super) fn hull(points: &[Vec3]) -> Result<Hull, ShapeError> {
    let low = points.iter().fold(points[0], |m, &p| m.min(p));
    let high = points.iter().fold(points[0], |m, &p| m.max(p));
    let size = (high - low).abs_max();
    let slack = THICK * size;
    let furthest = |measure: &dyn Fn(Vec3) -> f64| {
        let mut best = (f64::NEG_INFINITY, 0u32);
        for (i, &p) in points.iter().enumerate() {
            let m = measure(p);
            if m > best.0 {
                best = (m, i as u32);
            }
        }
        best
    };
    let at = |i: u32| points[i as usize];
    let thin = |what, value: f64| if value > slack { Ok(()) } else { Err(ShapeError { what, value }) };
    let a = furthest(&|p| -p.x).1;
    let (length, b) = furthest(&|p| (p - at(a)).length());
    thin("length of a convex polyhedron", length)?;
    let line = (at(b) - at(a)) / length;
    let (width, c) = furthest(&|p| (p - at(a)).cross(line).length());
    thin("width of a convex polyhedron", width)?;
    let n = (at(b) - at(a)).cross(at(c) - at(a)).normalized_or(Vec3::Z);
    let (thickness, d) = furthest(&|p| (p - at(a)).dot(n).abs());
    thin("thickness of a convex polyhedron", thickness)?;

    let mut builder = Builder { points, triangles: Vec::new(), edges: HashMap::new(), slack };
    let (b, c) = if (at(d) - at(a)).dot(n) > 0.0 { (c, b) } else { (b, c) };
    for v in [[a, b, c], [a, d, b], [b, d, c], [c, d, a]] {
        builder.add(v);
    }
    for i in 0..points.len() as u32 {
        if ![a, b, c, d].contains(&i) {
            builder.assign(i, 0);
        }
    }
    let mut pending: Vec<usize> = (0..builder.triangles.len()).collect();
    while let Some(i) = pending.pop() {
        if builder.triangles[i].alive && !builder.triangles[i].outside.is_empty() {
            let first = builder.triangles.len();
            expand(&mut builder, i);
            pending.extend(first..builder.triangles.len());
        }
    }
    merge(&builder)
}

/// Adds the point furthest above triangle `start` to the hull.
fn expand(builder: &mut Builder<'_>, start: usize) {
    let apex = builder.triangles[start].furthest.1;
    let p = builder.at(apex);
    // The triangles that see the point are connected through their edges; only such may go, else rounding could tear
    // a second hole.
    let mut visible = vec![start];
    builder.triangles[start].alive = false;
    let mut horizon: Vec<(u32, u32)> = Vec::new();
    let mut orphans = Vec::new();
    let mut k = 0;
    while k < visible.len() {
        for (from, to) in sides(builder.triangles[visible[k]].v) {
            let Some(&other) = builder.edges.get(&(to, from)) else { continue };
            let t = &mut builder.triangles[other];
            if t.alive {
                if t.normal.dot(p) - t.d > 0.0 {
                    t.alive = false;
                    visible.push(other);
                } else {
                    horizon.push((from, to));
                }
            }
        }
        k += 1;
    }
    for &i in &visible {
        orphans.append(&mut builder.triangles[i].outside);
        for side in sides(builder.triangles[i].v) {
            builder.edges.remove(&side);
        }
    }
    // A triangle may have turned out to see the point after one of its edges was noted.
    horizon.retain(|&(from, to)| builder.edges.contains_key(&(to, from)));
    let first = builder.triangles.len();
    for (from, to) in horizon {
        builder.add([from, to, apex]);
    }
    for point in orphans {
        if point != apex {
            builder.assign(point, first);
        }
    }
}

/// Joins triangles in one plane to faces and numbers the corners that are left.
fn merge(builder: &Builder<'_>) -> Result<Hull, ShapeError> {
    let triangles = &builder.triangles;
    let mut face_of = vec![usize::MAX; triangles.len()];
    let mut faces: Vec<Vec<u32>> = Vec::new();
    for start in 0..triangles.len() {
        if !triangles[start].alive || face_of[start] != usize::MAX {
            continue;
        }
        let normal = triangles[start].normal;
        let face = faces.len();
        face_of[start] = face;
        let mut group = vec![start];
        let mut k = 0;
        while k < group.len() {
            for (from, to) in sides(triangles[group[k]].v) {
                if let Some(&i) = builder.edges.get(&(to, from))
                    && face_of[i] == usize::MAX
                    && triangles[i].normal.dot(normal) > COPLANAR
                {
                    face_of[i] = face;
                    group.push(i);
                }
            }
            k += 1;
        }
        let mut edges: Vec<(u32, u32)> = Vec::new();
        for &i in &group {
            for (from, to) in sides(triangles[i].v) {
                match edges.iter().position(|&e| e == (to, from)) {
                    Some(k) => {
                        edges.swap_remove(k);
                    }
                    None => edges.push((from, to)),
                }
            }
        }
        let Some(&(first, _)) = edges.first() else { continue };
        let mut outline = Vec::with_capacity(edges.len());
        let mut current = first;
        while let Some(k) = edges.iter().position(|e| e.0 == current) {
            outline.push(current);
            current = edges.swap_remove(k).1;
        }
        faces.push(outline);
    }
    // A corner in line with its neighbours lies on two faces only: it is none.
    let mut uses = vec![0u32; builder.points.len()];
    for f in &faces {
        for &v in f {
            uses[v as usize] += 1;
        }
    }
    let mut number = vec![u32::MAX; builder.points.len()];
    let mut points = Vec::new();
    for (i, &count) in uses.iter().enumerate() {
        if count >= 3 {
            number[i] = points.len() as u32;
            points.push(builder.points[i]);
        }
    }
    for f in &mut faces {
        f.retain(|&v| uses[v as usize] >= 3);
        for v in f.iter_mut() {
            *v = number[*v as usize];
        }
    }
    faces.retain(|f| f.len() >= 3);
    if faces.len() < 4 {
        return Err(ShapeError { what: "number of faces of a convex hull", value: faces.len() as f64 });
    }
    Ok(Hull { points, faces })
}
