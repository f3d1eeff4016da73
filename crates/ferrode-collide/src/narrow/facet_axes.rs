//! ODE's way with a body and a mesh: each triangle for itself, by separating axes and clipping.
//!
//! What the rules say of a triangle can contradict the surface that it belongs to: a body that slides over a plane of
//! two triangles meets the edge between them. Such an answer is replaced by the part of the body's face over the triangle.
//!
//! ```text
//! near the body (tree) → plane reached, box around the body met ([`Sieve`])
//!   → the body's own axes ([`Rule`]) → contacts, or a ghost's replacement
//! ```
//! Most triangles near a body that touches are done with by the first two tests.

use super::body_trimesh::box_around;
use super::convex::touch;
use super::sieve::{Sieve, Sieved};
use super::support::Body;
use super::triangle::{Facet, Verdict, body_facet, face_facet, hidden_contact, judge};
use crate::shape::Neighbour;
use crate::{Contacts, Frame, GeomContact, Shape, TriMesh};
use ferrode_math::{Aabb, Vec3};

/// Most contacts with one triangle.
const MOST: usize = 16;
/// Contacts nearer than this, in metres, and with normals whose cosine is as near to one, are one.
const ONE: f64 = 1e-4;

/// How a kind of body touches triangles. Everything is in the body's own coordinates.
pub(super) trait Rule {
    /// Half the sides of the box around the body.
    fn half(&self) -> Vec3;
    /// The point furthest against a unit vector.
    fn lowest(&self, n: Vec3) -> Vec3;
    /// Whether triangles that do not face the body's middle count too.
    const BOTH_SIDES: bool;
    /// Adds the contacts with a triangle; whether no axis separates the two. `found` is empty before.
    fn touch(&self, near: &Near, flags: u8, found: &mut FacetContacts) -> bool;
}

/// A triangle near a body, in the body's own coordinates.
pub(super) struct Near {
    pub corners: [Vec3; 3],
    /// Unit, out of its front.
    pub normal: Vec3,
    /// How far the body's lowest point is below the plane; not negative.
    pub depth: f64,
}

/// What a rule finds between a body and a triangle, in the body's coordinates.
pub(super) struct FacetContacts {
    /// Unit, into the body.
    pub normal: Vec3,
    pub place: Place,
    /// Position and depth.
    list: [(Vec3, f64); MOST],
    count: usize,
}

/// Where the triangle bears the body.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Place {
    /// Where the deepest contact is: contacts are on the triangle.
    Deepest,
    /// At the corner or edge that is furthest along the normal.
    Furthest,
    /// Beside it.
    Nowhere,
}

impl FacetContacts {
    fn new() -> Self {
        Self { normal: Vec3::Z, place: Place::Deepest, list: [(Vec3::ZERO, 0.0); MOST], count: 0 }
    }

    #[inline]
    pub fn push(&mut self, position: Vec3, depth: f64) {
        if self.count < MOST {
            self.list[self.count] = (position, depth);
            self.count += 1;
        }
    }

    fn list(&self) -> &[(Vec3, f64)] {
        &self.list[..self.count]
    }

    /// What the surface says of these contacts.
    fn verdict(&self, near: &Near, neighbours: &[Neighbour; 3]) -> Verdict {
        let Some(&(deepest, _)) = self.list().iter().reduce(|a, b| if b.1 > a.1 { b } else { a }) else {
            return Verdict::Sound;
        };
        match self.place {
            Place::Nowhere => Verdict::Ghost,
            Place::Deepest => judge(&near.corners, near.normal, neighbours, self.normal, || deepest),
            Place::Furthest => {
                let furthest = || furthest(&near.corners, self.normal);
                judge(&near.corners, near.normal, neighbours, self.normal, furthest)
            }
        }
    }
}

/// The corner furthest along `d`, or the middle of the edge if two are as far.
fn furthest(corners: &[Vec3; 3], d: Vec3) -> Vec3 {
    let far = [d.dot(corners[0]), d.dot(corners[1]), d.dot(corners[2])];
    let scale = (corners[1] - corners[0]).abs_max() + (corners[2] - corners[0]).abs_max();
    let near = greater(greater(far[0], far[1]), far[2]) - super::triangle::SAME * scale;
    let (mut sum, mut count) = (Vec3::ZERO, 0.0);
    for (p, _) in corners.iter().zip(far).filter(|(_, f)| *f >= near) {
        sum += *p;
        count += 1.0;
    }
    sum * (1.0 / count)
}

// One instruction each, unlike `f64::min` and `f64::max`, which look out for NaN.
#[inline(always)]
pub(super) fn lesser(a: f64, b: f64) -> f64 {
    if a < b { a } else { b }
}

#[inline(always)]
pub(super) fn greater(a: f64, b: f64) -> f64 {
    if a > b { a } else { b }
}

/// The least overlap of a body and a triangle over some axes.
pub(super) struct LeastOverlap {
    corners: [Vec3; 3],
    /// Squared length up to which axes say nothing.
    shortest: f64,
    pub overlap: f64,
    /// Unit, into the body.
    pub normal: Vec3,
    /// Which axis it was.
    pub code: usize,
}

impl LeastOverlap {
    /// The overlap along the triangle's normal, out of its front.
    #[inline(always)]
    pub fn new(near: &Near, shortest: f64) -> Self {
        Self {
            corners: near.corners,
            shortest: shortest * shortest,
            overlap: near.depth,
            normal: near.normal,
            code: 0,
        }
    }

    /// Tries an axis of any length, which must be better than the best by a factor; `None` if it separates. `reach` tells
    /// from the axis and its length how far the body, which has a centre of symmetry, reaches along it.
    #[inline(always)]
    pub fn test(
        &mut self,
        axis: Vec3,
        reach: impl FnOnce(Vec3, f64) -> f64,
        factor: f64,
        code: usize,
    ) -> Option<()> {
        let square = axis.length_squared();
        if square <= self.shortest {
            return Some(());
        }
        let length = square.sqrt();
        let reach = reach(axis, length);
        let p = [axis.dot(self.corners[0]), axis.dot(self.corners[1]), axis.dot(self.corners[2])];
        let (low, high) = (lesser(lesser(p[0], p[1]), p[2]), greater(greater(p[0], p[1]), p[2]));
        let (ahead, behind) = (high + reach, reach - low);
        if ahead < 0.0 || behind < 0.0 {
            return None;
        }
        let overlap = lesser(ahead, behind);
        if overlap * factor < self.overlap * length {
            let inverse = 1.0 / length;
            self.overlap = overlap * inverse;
            self.normal = axis * if ahead <= behind { inverse } else { -inverse };
            self.code = code;
        }
        Some(())
    }

    /// How far the triangle reaches along the normal.
    pub fn level(&self) -> f64 {
        let n = self.normal;
        let p = [n.dot(self.corners[0]), n.dot(self.corners[1]), n.dot(self.corners[2])];
        greater(greater(p[0], p[1]), p[2])
    }
}

/// The part of a segment below a triangle and over it, its edges widened by 10⁻⁵ over their length.
pub(super) fn clip_segment(ends: [Vec3; 2], corners: &[Vec3; 3], normal: Vec3) -> Option<[Vec3; 2]> {
    const SLACK: f64 = 1e-5;
    let [mut p, mut q] = ends;
    for k in 0..4 {
        let (n, at, slack) = match k {
            0 => (normal, corners[0], 0.0),
            _ => ((corners[k % 3] - corners[k - 1]).cross(normal), corners[k - 1], SLACK),
        };
        let (hp, hq) = (n.dot(p - at) - slack, n.dot(q - at) - slack);
        if hp > 0.0 && hq > 0.0 {
            return None;
        }
        if hp > 0.0 {
            p += (q - p) * (hp / (hp - hq));
        } else if hq > 0.0 {
            q += (p - q) * (hq / (hq - hp));
        }
    }
    Some([p, q])
}

/// Whether a point is over a triangle, by its edges.
fn is_over(corners: &[Vec3; 3], normal: Vec3, p: Vec3) -> bool {
    (0..3).all(|e| (corners[(e + 1) % 3] - corners[e]).cross(normal).dot(p - corners[e]) <= 0.0)
}

/// Applies a rule to all triangles near a body. Contacts at one place with one normal are one, the deeper.
pub(super) fn each_facet<R: Rule>(
    shape: &Shape,
    fa: &Frame,
    mesh: &TriMesh,
    fm: &Frame,
    out: &mut Contacts<'_>,
    rule: &R,
) {
    let at = fm.point_to_local(fa.position);
    let reach = shape.reach() * (1.0 + 1e-9);
    if !mesh.bounds().overlaps(&Aabb::from_center(at, Vec3::splat(reach))) {
        return;
    }
    let local = Frame::new(at, fm.rotation.transpose() * fa.rotation);
    let around = shape.aabb_in(&local);
    if !mesh.bounds().overlaps(&around) {
        return;
    }
    let Some(body) = Body::of(shape, &local, Vec3::ZERO) else { return };
    let overlap = {
        let mut search = Search {
            rule,
            mesh,
            local: &local,
            body: &body,
            sieve: Sieve::new(mesh, local, rule.half(), R::BOTH_SIDES),
            found: FacetContacts::new(),
            overlap: false,
            all: out.all(),
        };
        mesh.tree().query(&around, |i| search.look_at(i));
        let Search { mut all, overlap, .. } = search;
        drop_unsupported(&mut all);
        // Clipping may lose what overlaps.
        if overlap && all.is_empty() {
            mesh.tree().query(&around, |i| {
                if let Some(facet) = mesh.facet(i) {
                    own_contacts(&body, &facet, &mut all);
                }
            });
        }
        overlap
    };
    super::reduce::keep_wanted(out, body.reach());
    if overlap && out.is_empty() {
        lift_out(&body, mesh, &around, out);
    }
    for c in out.added() {
        c.point.position = fm.point_to_world(c.point.position);
        c.point.normal = fm.vector_to_world(c.point.normal);
    }
}

/// Finds the contacts of a body with triangles, in the mesh's coordinates.
struct Search<'a, R> {
    rule: &'a R,
    mesh: &'a TriMesh,
    local: &'a Frame,
    body: &'a Body<'a>,
    /// The box around the body.
    sieve: Sieve<'a>,
    /// Working memory.
    found: FacetContacts,
    /// Whether any triangle overlaps the body.
    overlap: bool,
    all: Contacts<'a>,
}

impl<R: Rule> Search<'_, R> {
    /// Looks at a triangle.
    #[inline(always)]
    fn look_at(&mut self, i: u32) {
        if let Some(Sieved { normal, corners, height, meets_box }) = self.sieve.sift(i) {
            self.consider(i, normal, corners, height, meets_box);
        }
    }

    /// Looks at a triangle by its normal and corners in the body's own coordinates.
    #[inline(never)]
    fn consider(&mut self, i: u32, n: Vec3, corners: [Vec3; 3], height: f64, meets_box: bool) {
        let lowest = self.rule.lowest(n);
        let depth = -height - n.dot(lowest);
        if !(depth >= 0.0) || n == Vec3::ZERO {
            return;
        }
        let near = Near { corners, normal: n, depth };
        self.found.count = 0;
        if !(meets_box && self.rule.touch(&near, self.mesh.use_flags(i), &mut self.found)) {
            if height >= 0.0
                && is_over(&near.corners, n, lowest)
                && let Some(facet) = self.mesh.facet(i)
            {
                let body = self.body;
                move_down(&mut self.all, |out| hidden_contact(body, body.middle(), &facet, out));
            }
            return;
        }
        self.overlap = true;
        let verdict = self.found.verdict(&near, self.mesh.neighbours(i));
        if verdict == Verdict::Ghost {
            if let Some(facet) = self.mesh.facet(i) {
                face_facet(self.body, self.body.middle(), &facet, &mut self.all);
            }
            return;
        }
        let normal = self.local.vector_to_world(self.found.normal);
        for &(p, depth) in self.found.list() {
            let mut c = GeomContact::new(self.local.point_to_world(p), normal, depth);
            c.side2 = i as i32;
            if verdict == Verdict::FromBehind {
                c.side1 = FROM_BEHIND;
            }
            add_distinct(c, &mut self.all);
        }
    }
}

/// The contacts of `body_trimesh` with one triangle.
fn own_contacts(body: &Body<'_>, facet: &Facet, out: &mut Contacts<'_>) {
    move_down(out, |out| body_facet(body, body.middle(), facet, out));
}

/// Moves the contacts that are added from midway to the body's own surface.
fn move_down(out: &mut Contacts<'_>, add: impl FnOnce(&mut Contacts<'_>)) {
    let first = out.len();
    add(out);
    for c in &mut out.added()[first..] {
        c.point.position -= c.point.normal * (0.5 * c.point.depth);
    }
}

/// The contact of a body that has sunk through a surface, so that nothing that it touches faces its middle: out of the front
/// of the triangle that it leaves soonest. All is in the mesh's coordinates; `aabb` is the body's.
pub(super) fn lift_out(body: &Body<'_>, mesh: &TriMesh, aabb: &Aabb, out: &mut Contacts<'_>) {
    let mut best: Option<GeomContact> = None;
    let (frame, half) = box_around(body);
    let sieve = Sieve::new(mesh, frame, half, true);
    mesh.tree().query(aabb, |i| {
        if !sieve.sift(i).is_some_and(|near| near.meets_box) {
            return;
        }
        let Some(facet) = mesh.facet(i) else { return };
        let n = facet.normal;
        let lowest = body.support(-n) - n * body.margin;
        let depth = -facet.height(lowest);
        let straddles = depth > 0.0 && facet.height(body.support(n)) + body.margin > 0.0;
        if straddles
            && best.is_none_or(|b| depth < b.point.depth)
            && touch(body, &Body::triangle(facet.corners)).is_some()
        {
            let mut c = GeomContact::new(lowest, n, depth);
            c.side2 = facet.index;
            best = Some(c);
        }
    });
    if let Some(c) = best {
        out.push_contact(c);
    }
}

/// Marks, in `side1`, a contact whose normal points into its triangle.
const FROM_BEHIND: i32 = -2;

/// Of the contacts from behind those stay that push as a deeper one from the front does.
fn drop_unsupported(out: &mut Contacts<'_>) {
    let list = out.added();
    let mut kept = 0;
    for i in 0..list.len() {
        let c = list[i];
        if c.side1 == FROM_BEHIND {
            let faces = |k: &GeomContact| {
                k.side1 != FROM_BEHIND
                    && k.point.normal.dot(c.point.normal) > 1.0 - 1e-6
                    && k.point.depth >= c.point.depth * (1.0 - 1e-6)
            };
            if !list.iter().any(faces) {
                continue;
            }
        }
        list[kept] = c;
        kept += 1;
    }
    for c in &mut list[..kept] {
        c.side1 = -1;
    }
    out.truncate(kept);
}

fn add_distinct(c: GeomContact, out: &mut Contacts<'_>) {
    let one = |k: &&mut GeomContact| {
        let d = k.point.position - c.point.position;
        (d.x.abs() < ONE) & (d.y.abs() < ONE) & (d.z.abs() < ONE)
            && k.point.normal.dot(c.point.normal) > 1.0 - ONE
    };
    let Some(k) = out.added().iter_mut().find(one) else {
        out.push_contact(c);
        return;
    };
    let from_behind = k.side1 == FROM_BEHIND && c.side1 == FROM_BEHIND;
    if c.point.depth > k.point.depth {
        *k = c;
    }
    // One of the two faces the body.
    if !from_behind {
        k.side1 = -1;
    }
}
