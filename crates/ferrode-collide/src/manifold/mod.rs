//! Contact manifolds: where two geoms touch, or are about to, in a form that a solver can keep from step to step.
//!
//! [`collide`](crate::narrow::collide()) lists contacts as ODE does; this is our own answer to the same question. A
//! [`Manifold`] has one normal and at most four points, the deepest among them, the others far apart. Each point is known
//! by a feature number, so that the impulses of one step start the next, and by an anchor on either geom, so that
//! [`Manifold::refresh`] gives depths and normal after a small motion for a tenth of the price of finding them.
//!
//! ```text
//!            A                     anchor_a   the point of A that is deepest in B     (A's coordinates)
//!        ____|____                 anchor_b   the point of B that is deepest in A     (B's coordinates)
//!       |    ^ n  |                normal     out of B, into A                        (world)
//!     __|_   |    |__ surface      depth      n · (anchor_b − anchor_a): positive if they overlap, negative for a
//!    |  '*---|----*' |   of B                 speculative point, which is apart but within the margin
//! ```
//!
//! Which way the faces are found:
//!
//! | pair | method |
//! |---|---|
//! | box, box | fifteen axes, the axis of the last step first; the incident face clipped to the reference rectangle; single precision in the coordinates of one box |
//! | sphere with sphere, box | formula |
//! | two convex shapes | GJK while they are apart, EPA for the least overlap; then the faces or edges that face each other, clipped |
//! | convex shape, plane | corners below the plane |
//! | convex shape, mesh or heightfield | as two convex shapes, triangle by triangle; a normal counts only if the neighbours across the edge allow it (no ghost hits); points of one normal form one manifold |
//! | mesh, mesh; custom shapes; compounds | contacts of [`collide`](crate::narrow::collide()), grouped by normal |

mod boxes;
mod candidates;
mod convex;
mod patch;
mod plane;
mod surface;

#[cfg(test)]
mod tests;

use crate::narrow::collides;
use crate::{Frame, Shape};
pub use candidates::Workspace;
use ferrode_math::{Mat3, Vec3, Vector3};
use patch::Patch;

/// Most points of a manifold.
pub const MANIFOLD_POINTS: usize = 4;

/// A vector in single precision: what is small or relative.
pub type Vec3f = Vector3<f32>;

/// A contact of a manifold.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[repr(C)]
pub struct ManifoldPoint {
    /// The point on the surface of A, in the coordinates of geom A.
    pub anchor_a: Vec3f,
    /// The point on the surface of B, in the coordinates of geom B, from the manifold's [`origin_b`](Manifold::origin_b).
    pub anchor_b: Vec3f,
    /// Penetration depth in metres; negative if the points are apart.
    pub depth: f32,
    /// The features that meet here: the same number as long as it is the same contact; unique within the manifold.
    pub feature: u32,
    /// For the solver: impulses along the normal and two tangents. New points have zero, known ones keep what they had.
    pub impulse: [f32; 3],
}

/// Up to four contacts with one normal.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(C)]
pub struct Manifold {
    /// What anchors on B are relative to, in B's coordinates: zero unless B is large, when it is a place near the
    /// contact, so that single precision is enough for the anchors.
    pub origin_b: Vec3,
    /// World unit vector out of B into A: the way A leaves soonest.
    pub normal: Vec3f,
    /// The normal in the coordinates of the geom whose face it belongs to.
    local_normal: Vec3f,
    /// The triangle of A at the first point; −1 for shapes without parts.
    pub part_a: i32,
    /// The triangle of B at the first point; −1 for shapes without parts.
    pub part_b: i32,
    points: [ManifoldPoint; MANIFOLD_POINTS],
    count: u8,
    /// Whether the normal turns with A.
    normal_of_a: bool,
    /// For the solver: impulses about the normal and of rolling about two tangents.
    pub twist: [f32; 3],
}

impl Default for Manifold {
    fn default() -> Self {
        Self {
            origin_b: Vec3::ZERO,
            normal: Vec3f::Z,
            local_normal: Vec3f::Z,
            part_a: -1,
            part_b: -1,
            points: [ManifoldPoint::default(); MANIFOLD_POINTS],
            count: 0,
            normal_of_a: false,
            twist: [0.0; 3],
        }
    }
}

/// A matrix in single precision times a vector: what is turned is small.
#[inline(always)]
fn turn(m: &Mat3, v: Vec3f) -> Vec3f {
    let r = &m.rows;
    let row = |i: usize| r[i][0] as f32 * v.x + r[i][1] as f32 * v.y + r[i][2] as f32 * v.z;
    Vec3f::new(row(0), row(1), row(2))
}

#[inline(always)]
fn single(v: Vec3) -> Vec3f {
    Vec3f::new(v.x as f32, v.y as f32, v.z as f32)
}

#[inline(always)]
fn double(v: Vec3f) -> Vec3 {
    Vec3::new(v.x.into(), v.y.into(), v.z.into())
}

impl Manifold {
    /// The contacts, the deepest of the time they were found first.
    #[inline]
    pub fn points(&self) -> &[ManifoldPoint] {
        &self.points[..usize::from(self.count)]
    }

    /// The contacts, for a solver to put its impulses in.
    #[inline]
    pub fn points_mut(&mut self) -> &mut [ManifoldPoint] {
        &mut self.points[..usize::from(self.count)]
    }

    /// Whether there is no contact: never true of what a search found.
    pub fn is_empty(&self) -> bool {
        self.count == 0
    }

    /// The greatest depth.
    pub fn depth(&self) -> f32 {
        self.points().iter().fold(f32::NEG_INFINITY, |d, p| if p.depth > d { p.depth } else { d })
    }

    /// The world place of point `i` on A.
    pub fn place_a(&self, i: usize, a: &Frame) -> Vec3 {
        a.point_to_world(double(self.points[i].anchor_a))
    }

    /// The world place of point `i` on B.
    pub fn place_b(&self, i: usize, b: &Frame) -> Vec3 {
        b.point_to_world(self.origin_b + double(self.points[i].anchor_b))
    }

    /// Normal and depths for new frames, from the anchors alone: exact for corners over a face, and to second order in
    /// the motion since the manifold was found for all else. No points appear; those that part keep a negative depth.
    #[inline]
    pub fn refresh(&mut self, a: &Frame, b: &Frame) {
        let rotation = if self.normal_of_a { &a.rotation } else { &b.rotation };
        let n = turn(rotation, self.local_normal);
        self.normal = n;
        // From A to B in double precision, the rest in single.
        let mut between = b.position - a.position;
        if self.origin_b != Vec3::ZERO {
            between += b.rotation * self.origin_b;
        }
        let apart = n.dot(single(between));
        // The normal in either geom's coordinates: one product a point.
        let (na, nb) = (back(&a.rotation, n), back(&b.rotation, n));
        for p in &mut self.points[..usize::from(self.count)] {
            p.depth = apart + nb.dot(p.anchor_b) - na.dot(p.anchor_a);
        }
    }

    /// Takes over the impulses of what `old`, of the same pair, had at the same features; points with new ones from
    /// those within `reach` metres on either geom: a corner that slid onto another triangle, a clipped edge.
    pub fn inherit(&mut self, old: &Self, reach: f32) {
        self.twist = old.twist;
        let shift = single(self.origin_b - old.origin_b);
        let mut taken = 0u32;
        let mut known = 0u32;
        let count = usize::from(self.count);
        for (i, p) in self.points[..count].iter_mut().enumerate() {
            // Mostly they come in the same order.
            let same = |j: usize| j < usize::from(old.count) && old.points[j].feature == p.feature;
            let j = if same(i) { Some(i) } else { (0..usize::from(old.count)).find(|&j| same(j)) };
            if let Some(j) = j.filter(|j| taken & (1 << j) == 0) {
                p.impulse = old.points[j].impulse;
                taken |= 1 << j;
                known |= 1 << i;
            }
        }
        if known == (1 << count) - 1 || taken == (1 << old.count) - 1 {
            return;
        }
        for (i, p) in self.points[..count].iter_mut().enumerate() {
            if known & (1 << i) != 0 {
                continue;
            }
            let mut best = (reach * reach, None);
            for (j, q) in old.points().iter().enumerate().filter(|(j, _)| taken & (1 << j) == 0) {
                let (da, db) = (p.anchor_a - q.anchor_a, p.anchor_b + shift - q.anchor_b);
                let (da, db) = (da.length_squared(), db.length_squared());
                let square = if da < db { da } else { db };
                if square < best.0 {
                    best = (square, Some(j));
                }
            }
            if let Some(j) = best.1 {
                p.impulse = old.points[j].impulse;
                taken |= 1 << j;
            }
        }
    }

    /// The same manifold of the pair in the other order.
    #[must_use]
    pub fn swapped(mut self) -> Self {
        let reach = |p: &ManifoldPoint| p.anchor_a;
        let origin = self.points().first().map(reach).filter(|p| p.length_squared() > FAR * FAR);
        let old = self.origin_b;
        self.origin_b = origin.map_or(Vec3::ZERO, double);
        for p in &mut self.points[..usize::from(self.count)] {
            let (a, b) = (double(p.anchor_a), old + double(p.anchor_b));
            p.anchor_a = single(b);
            p.anchor_b = single(a - self.origin_b);
        }
        self.normal = -self.normal;
        self.local_normal = -self.local_normal;
        self.normal_of_a = !self.normal_of_a;
        core::mem::swap(&mut self.part_a, &mut self.part_b);
        self
    }
}

/// Further than this from B's origin, anchors on B count from a place nearby.
const FAR: f32 = 16.0;

/// The transpose of a matrix times a vector, in single precision.
#[inline(always)]
fn back(m: &Mat3, v: Vec3f) -> Vec3f {
    let r = &m.rows;
    let column = |j: usize| r[0][j] as f32 * v.x + r[1][j] as f32 * v.y + r[2][j] as f32 * v.z;
    Vec3f::new(column(0), column(1), column(2))
}

/// What a search remembers of a pair: the axis that separated the shapes, or along which they overlapped least.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Axis {
    /// Of two boxes: the number of the axis, from 1.
    number: u8,
    /// Of other shapes: the direction from B to A, in the first shape's coordinates, in 127ths; zero if not known.
    direction: [i8; 3],
    /// Whose face gives the normal where one of either is about as good.
    favours: Favours,
}

/// The shape whose faces are favoured.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
enum Favours {
    #[default]
    None,
    A,
    B,
}

impl Axis {
    /// For a pair of which one stands still for ever: normals are those of its faces where they may be. What slides over a floor of many
    /// parts feels one direction then, and not its own tilt by the softness of contacts.
    pub fn of_fixed(a: bool, b: bool) -> Self {
        let favours = match (a, b) {
            (true, false) => Favours::A,
            (false, true) => Favours::B,
            _ => Favours::None,
        };
        Self { favours, ..Self::default() }
    }

    fn direction(&self) -> Option<Vec3> {
        (self.direction != [0; 3]).then(|| Vec3::from_array(self.direction.map(f64::from)))
    }

    fn set_direction(&mut self, d: Vec3) {
        let d = d.normalized_or(Vec3::ZERO) * 127.0;
        self.direction = d.to_array().map(|x| x as i8);
    }
}

/// Whether a pair can have several manifolds: one of the shapes is not convex, or not known to be.
pub fn is_concave(a: &Shape, b: &Shape) -> bool {
    let concave = |s: &Shape| {
        matches!(s, Shape::TriMesh(_) | Shape::Heightfield(_) | Shape::Custom(_) | Shape::Compound(_))
    };
    concave(a) || concave(b)
}

/// What is known of a pair of convex shapes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Touching {
    /// Further apart than the margin, by at least so much.
    Apart(f64),
    /// A manifold was written.
    Yes,
}

/// The manifold of two convex shapes, one of which may be a plane, with all points not further apart than `margin`.
///
/// `axis` is what the last call for this pair left there. `out` is overwritten if the answer is [`Touching::Yes`]; its
/// former points then decide which of several equal ones to keep, and hand on their impulses. Pairs that never touch
/// (rays, two planes), and concave ones, are [`Touching::Apart`] for ever.
pub fn convex_manifold(
    a: (&Shape, &Frame),
    b: (&Shape, &Frame),
    margin: f64,
    axis: &mut Axis,
    out: &mut Manifold,
) -> Touching {
    if let (Shape::Cuboid(ca), Shape::Cuboid(cb)) = (a.0, b.0) {
        match boxes::boxes(ca, a.1, cb, b.1, margin as f32, axis, out) {
            boxes::Answer::Apart(d) => return Touching::Apart(d.into()),
            boxes::Answer::Touch => return Touching::Yes,
            // Two corners, or a corner and an edge, are nearest: no separating axis of boxes tells how far.
            boxes::Answer::Unclear => {}
        }
    }
    if matches!(a.0, Shape::Plane(_)) {
        let mut turned = out.swapped();
        let answer = convex_manifold(b, a, margin, axis, &mut turned);
        if answer == Touching::Yes {
            *out = turned.swapped();
        }
        return answer;
    }
    let mut patch = Patch::new();
    let answer = match b.0 {
        Shape::Plane(plane) => plane::body_plane(a.0, a.1, plane, margin, &mut patch),
        _ => {
            let guess =
                if out.count > 0 { Some(a.1.vector_to_local(double(out.normal))) } else { axis.direction() };
            convex::pair(a, b, margin, guess, axis, &mut patch)
        }
    };
    if answer == Touching::Yes {
        patch.write(out);
    }
    answer
}

/// All manifolds of two shapes of any kind, added to `out`: several where one of them is not convex. Returns how much
/// further apart than the margin they are at least; zero if that is not known, or if they touch.
///
/// Nothing is allocated once `work` and `out` have grown.
pub fn manifolds(
    a: (&Shape, &Frame),
    b: (&Shape, &Frame),
    margin: f64,
    work: &mut Workspace,
    out: &mut Vec<Manifold>,
) -> f64 {
    if !collides(a.0.kind(), b.0.kind()) || matches!(a.0, Shape::Ray(_)) || matches!(b.0, Shape::Ray(_)) {
        return f64::INFINITY;
    }
    if !is_concave(a.0, b.0) {
        let mut one = Manifold::default();
        return match convex_manifold(a, b, margin, &mut Axis::default(), &mut one) {
            Touching::Apart(by) => by,
            Touching::Yes => {
                if one.is_sound() {
                    out.push(one);
                }
                0.0
            }
        };
    }
    let first = out.len();
    surface::manifolds(a, b, margin, work, out);
    out.retain_from(first);
    0.0
}

/// Drops what is no number.
trait Sound {
    fn retain_from(&mut self, first: usize);
}

impl Sound for Vec<Manifold> {
    fn retain_from(&mut self, first: usize) {
        let mut kept = first;
        for i in first..self.len() {
            if self[i].is_sound() {
                self[kept] = self[i];
                kept += 1;
            }
        }
        self.truncate(kept);
    }
}

impl Manifold {
    /// Whether it has points and all its numbers are finite.
    pub(crate) fn is_sound(&self) -> bool {
        let n = self.normal;
        self.count > 0
            && (n.x + n.y + n.z).is_finite()
            && self.points().iter().all(|p| {
                let s = p.anchor_a + p.anchor_b;
                (s.x + s.y + s.z + p.depth).is_finite()
            })
    }
}
