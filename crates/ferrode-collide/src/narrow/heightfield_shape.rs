use super::dispatch::collide_frames;
use super::heightfield_trimesh::heightfield_trimesh;
use super::reduce::reduce;
use crate::{CollideOptions, Contacts, Convex, Frame, GeomContact, Heightfield, Plane, Shape};
use core::cell::Cell;
use ferrode_math::{Aabb, Vec3};

/// Most contacts that one triangle's plane gives.
const PER_PLANE: u16 = 10;
/// Heights nearer than this are equal.
const EQUAL: f64 = f64::EPSILON;

/// A heightfield and any shape that collides with planes; normals point into the field.
///
/// As in ODE: the shape is collided with the plane of each triangle it may reach, and of the contacts those over the
/// triangle count. A shape as wide as cells also touches with the field's corners that are inside it. What is wholly
/// below the field is pushed up by one contact.
pub fn heightfield_shape(field: &Heightfield, ff: &Frame, shape: &Shape, fs: &Frame, out: &mut Contacts<'_>) {
    // All in the field's coordinates.
    let at = ff.point_to_local(fs.position);
    let beside = match shape {
        Shape::Ray(ray) => {
            let along = ff.vector_to_local(fs.axis(2)) * (0.5 * ray.length());
            field.is_beside(at + along, 0.5 * ray.length())
        }
        Shape::TriMesh(mesh) => {
            let bounds = mesh.bounds();
            let middle = ff.point_to_local(fs.point_to_world(bounds.center()));
            field.is_beside(middle, 0.5 * bounds.extent().length())
        }
        _ => field.is_beside(at, shape.reach()),
    };
    if beside {
        return;
    }
    let local = Frame::new(at, ff.rotation.transpose() * fs.rotation);
    let aabb = shape.aabb_in(&local);
    let Some(zone) = Zone::under(field, &aabb) else { return };
    {
        let mut all = out.all();
        collide_zone(field, &zone, shape, &local, &aabb, &mut all);
    }
    let (sx, sz) = field.cell();
    reduce(out, sx.min(sz));
    for c in out.added() {
        c.point.position = ff.point_to_world(c.point.position);
        c.point.normal = ff.vector_to_world(c.point.normal);
    }
}

/// The grid corners under a box, both ends included.
pub(crate) struct Zone {
    pub x: [i64; 2],
    pub z: [i64; 2],
    pub low: f64,
    pub high: f64,
}

/// Beyond this many cells a shape is taken to lie over all of the field.
const MOST_CELLS: f64 = 1e9;

impl Zone {
    pub fn under(field: &Heightfield, aabb: &Aabb) -> Option<Self> {
        let (sx, sz) = field.cell();
        let (w, d) = (0.5 * field.width(), 0.5 * field.depth());
        let wrap = field.is_wrapped();
        if !wrap && (aabb.min.x > w || aabb.max.x < -w || aabb.min.z > d || aabb.max.z < -d) {
            return None;
        }
        let range = |low: f64, high: f64, half: f64, size: f64, n: usize| {
            let from = ((low + half) / size).next_down().floor().clamp(-MOST_CELLS, MOST_CELLS) as i64;
            let to = ((high + half) / size).next_up().ceil().clamp(-MOST_CELLS, MOST_CELLS) as i64;
            let last = n as i64 - 1;
            if wrap {
                // More than one repetition would be seen again.
                [from, to.min(from + 4 * last)]
            } else {
                [from.max(0), to.min(last)]
            }
        };
        let x = range(aabb.min.x, aabb.max.x, w, sx, field.columns());
        let z = range(aabb.min.z, aabb.max.z, d, sz, field.rows());
        let (mut low, mut high) = (f64::INFINITY, f64::NEG_INFINITY);
        for j in z[0]..=z[1] {
            for i in x[0]..=x[1] {
                let h = field.height(i, j);
                low = low.min(h);
                high = high.max(h);
            }
        }
        (low <= high).then_some(Self { x, z, low, high })
    }
}

/// Working memory, kept so that a call allocates nothing.
#[derive(Default)]
struct Work {
    tiles: Vec<Tile>,
    /// Column and row of corners that are done.
    used: Vec<[i64; 2]>,
    found: Vec<GeomContact>,
}

thread_local! {
    static WORK: Cell<Work> =
        const { Cell::new(Work { tiles: Vec::new(), used: Vec::new(), found: Vec::new() }) };
}

fn collide_zone(
    field: &Heightfield,
    zone: &Zone,
    shape: &Shape,
    local: &Frame,
    aabb: &Aabb,
    out: &mut Contacts<'_>,
) {
    if aabb.min.y - zone.high > -EQUAL {
        return;
    }
    let is_ray = matches!(shape, Shape::Ray(_));
    if zone.low - aabb.max.y > -EQUAL {
        if !is_ray {
            let p = Vec3::new(local.position.x, zone.low, local.position.z);
            out.push(p, -Vec3::Y, zone.low - aabb.max.y);
        }
        return;
    }
    let wide = {
        let (sx, sz) = field.cell();
        let e = aabb.extent();
        e.x > 1.5 * sx || e.z > 1.5 * sz
    };
    if let Shape::TriMesh(mesh) = shape {
        return heightfield_trimesh(field, zone, mesh, local, out);
    }
    // When a thread ends, its memory goes first; what is destroyed after may still collide.
    let mut work = WORK.try_with(Cell::take).unwrap_or_default();
    let Work { tiles, used, found } = &mut work;
    tiles.clear();
    used.clear();
    for x in zone.x[0]..zone.x[1] {
        let [from, to] = rows(field, zone, shape, local, x);
        for z in from..to {
            let at = |i: i64, j: i64| ([x + i, z + j], field.vertex(x + i, z + j));
            let (a, b, c, d) = (at(0, 0), at(1, 0), at(0, 1), at(1, 1));
            tiles.extend(Tile::new([a, b, c], false, aabb.min.y));
            tiles.extend(Tile::new([d, c, b], true, aabb.min.y));
        }
    }
    for tile in tiles.iter_mut() {
        // What touches a triangle has no need of its corners.
        if tile.collide(shape, local, found, out) {
            used.extend(tile.corners.map(|c| c.0));
        }
    }
    // Of the others libode asks by a ray from the corner, which finds nothing.
    if wide && matches!(shape, Shape::Sphere(_) | Shape::Cuboid(_) | Shape::Capsule(_)) {
        add_corners(shape, local, tiles, used, out);
    }
    WORK.try_with(|kept| kept.set(work)).ok();
}

/// Corners of the field inside the shape, with the normal of the first triangle it passed by. Those in `used` are done.
fn add_corners(
    shape: &Shape,
    local: &Frame,
    tiles: &[Tile],
    used: &mut Vec<[i64; 2]>,
    out: &mut Contacts<'_>,
) {
    for tile in tiles.iter().filter(|t| t.missed) {
        for (place, corner) in tile.corners {
            if used.contains(&place) {
                continue;
            }
            if let Some(depth) = crate::point_depth(shape, local, corner).filter(|&d| d > 0.0) {
                used.push(place);
                out.push(corner, -tile.plane.normal(), depth);
            }
        }
    }
}

/// The cells of column `x` to look at: all under the box, or of a long ray those under its path.
fn rows(field: &Heightfield, zone: &Zone, shape: &Shape, local: &Frame, x: i64) -> [i64; 2] {
    let Shape::Ray(ray) = shape else { return zone.z };
    let (sx, sz) = field.cell();
    let (o, u) = ray.line(local);
    // In cells from the field's corner.
    let (x0, z0) = ((o.x + 0.5 * field.width()) / sx, (o.z + 0.5 * field.depth()) / sz);
    let (dx, dz) = (u.x * ray.length() / sx, u.z * ray.length() / sz);
    if dx == 0.0 {
        return zone.z;
    }
    let at = |edge: f64| z0 + dz * ((edge - x0) / dx).clamp(0.0, 1.0);
    // A hair wider than the column, against rounding.
    let (a, b) = (at(x as f64 - 1e-6), at(x as f64 + 1.0 + 1e-6));
    let from = (a.min(b) - 1e-6).floor().max(zone.z[0] as f64) as i64;
    let to = ((a.max(b) + 1e-6).floor() + 1.0).min(zone.z[1] as f64) as i64;
    [from, to]
}

/// Half a cell: a triangle of the field.
struct Tile {
    /// Column and row, and place, of the corners; that opposite the diagonal first.
    corners: [([i64; 2], Vec3); 3],
    /// Whether it is the half at the greater x and z.
    upper: bool,
    plane: Plane,
    /// The shape is below the plane, but not over the triangle.
    missed: bool,
}

impl Tile {
    /// The triangle, unless it is no higher than `floor`.
    fn new(corners: [([i64; 2], Vec3); 3], upper: bool, floor: f64) -> Option<Self> {
        let [p, q, r] = corners.map(|c| c.1);
        if p.y.max(q.y).max(r.y) <= floor {
            return None;
        }
        // Both halves turn the same way; their normals look up.
        let plane = Plane::through(p, (r - p).cross(q - p)).ok()?;
        Some(Self { corners, upper, plane, missed: false })
    }

    /// The contacts of a shape with the triangle's plane that are over the triangle; whether there are any.
    fn collide(
        &mut self,
        shape: &Shape,
        local: &Frame,
        found: &mut Vec<GeomContact>,
        out: &mut Contacts<'_>,
    ) -> bool {
        if let Shape::Convex(hull) = shape
            && wholly_below(hull, local, &self.plane)
        {
            return false;
        }
        found.clear();
        let options = CollideOptions { max_contacts: PER_PLANE, ..out.options() };
        let ground = Shape::Plane(self.plane);
        collide_frames((shape, local), (&ground, &Frame::IDENTITY), options, found);
        let [p, q, r] = self.corners.map(|c| c.1);
        let (ux, uz) = (q.x - p.x + (r.x - p.x), q.z - p.z + (r.z - p.z));
        let mut accepted = false;
        for c in found.iter() {
            // Shares of the cell's sides, from the corner opposite the diagonal.
            let (s, t) = ((c.point.position.x - p.x) / ux, (c.point.position.z - p.z) / uz);
            // A ray along an edge hits once.
            let again = matches!(shape, Shape::Ray(_))
                && out.added().iter().any(|k| (k.point.depth - c.point.depth).abs() < 1e-9);
            if !again && s >= 0.0 && t >= 0.0 && if self.upper { s + t <= 1.0 } else { s + t < 1.0 } {
                accepted = true;
                let mut contact = GeomContact::new(c.point.position, -self.plane.normal(), c.point.depth);
                // A mesh tells which of its triangles touches.
                contact.side2 = c.side1;
                out.push_contact(contact);
            }
        }
        self.missed = !accepted && !found.is_empty();
        accepted
    }
}

/// Whether a polyhedron is below a plane altogether. Over a slope that says nothing about the triangle.
fn wholly_below(hull: &Convex, frame: &Frame, plane: &Plane) -> bool {
    hull.points().iter().all(|&p| plane.depth(frame.point_to_world(p)) > 0.0)
}
