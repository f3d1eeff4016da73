//! ODE's way with a body and a mesh: each triangle for itself, by separating axes and clipping.
//!
//! What the rules say of a triangle can contradict the surface that it belongs to: a body that slides over a plane of
//! two triangles meets the edge between them. Such an answer is replaced by the part of the body's face over the triangle.
//!
//! ```text
//! near the body (tree) → plane reached, box around the body met ([`Sieve`])
//!   → the body's own axes ([`Rule`]) → contacts, or a ghost's replacement
//! ```
//! Most triangles near a body that touches are done with by the first three steps, which look at four at a time; those
//! that pass the sieve are gathered in fours anew.

use super::body_trimesh::box_around;
use super::convex::touch;
use super::sieve::{Numbers, Sieve};
use super::support::Body;
use super::triangle::{Facet, Verdict, body_facet, face_facet, hidden_contact, judge};
use crate::shape::Neighbour;
use crate::{Contacts, Frame, GeomContact, Shape, TriMesh};
use ferrode_math::simd::{Mask, Ordered, Quad, QuadKernel, dispatch_quads};
use ferrode_math::{Aabb, Vec3, Vector3};

/// Most contacts with one triangle.
const MOST: usize = 16;
/// Contacts nearer than this, in metres, and with normals whose cosine is as near to one, are one.
const ONE: f64 = 1e-4;

/// How a kind of body touches triangles. Everything is in the body's own coordinates.
pub(super) trait Rule {
    /// Half the sides of the box around the body.
    fn half(&self) -> Vec3;
    /// The point furthest against a unit vector.
    fn lowest<Q: Quad>(&self, n: Vector3<Q>) -> Vector3<Q>;
    /// Whether triangles that do not face the body's middle count too.
    const BOTH_SIDES: bool;
    /// The axis of least overlap with each of four triangles, of which those in `wanted` count. `flags` are the triangles'.
    fn axes<Q: Quad>(&self, near: &Near<Q>, flags: [u8; 4], wanted: Q::Mask) -> Least<Q>;
    /// Adds the contacts with a triangle that no axis separates from the body. `found` is empty before.
    fn contacts(&self, near: &Near<f64>, least: &Least<f64>, found: &mut FacetContacts);
}

/// A triangle near a body, or one in each lane, in the body's own coordinates.
pub(super) struct Near<T> {
    pub corners: [Vector3<T>; 3],
    /// Unit, out of its front.
    pub normal: Vector3<T>,
    /// How far the body's lowest point is below the plane; not negative.
    pub depth: T,
}

/// The axis along which a body and a triangle overlap least, or one in each lane.
#[derive(Clone, Copy)]
pub(super) struct Least<T: Ordered> {
    /// Where some axis separates the two; nothing else counts there.
    pub apart: T::Mask,
    pub overlap: T,
    /// Unit, into the body.
    pub normal: Vector3<T>,
    /// What the rule wants to know of the axis.
    pub code: T,
    pub scale: T,
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
    #[inline(always)]
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
    fn verdict(&self, near: &Near<f64>, neighbours: &[Neighbour; 3]) -> Verdict {
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

/// The least overlap of a body with each of four triangles over some axes.
pub(super) struct LeastOverlap<Q: Quad> {
    corners: [Vector3<Q>; 3],
    /// Squared length up to which axes say nothing.
    shortest: Q,
    apart: Q::Mask,
    overlap: Q,
    normal: Vector3<Q>,
}

impl<Q: Quad> LeastOverlap<Q> {
    /// The overlap along the triangle's normal, out of its front. All that are not `wanted` count as apart.
    #[inline(always)]
    pub fn new(near: &Near<Q>, shortest: f64, wanted: Q::Mask) -> Self {
        Self {
            corners: near.corners,
            shortest: Q::splat(shortest * shortest),
            apart: !wanted,
            overlap: near.depth,
            normal: near.normal,
        }
    }

    /// Tries an axis where `says` is true. The body, which has a centre of symmetry, reaches along it as far as `reach` says;
    /// `square` and `length` are the axis's.
    #[inline(always)]
    pub fn test(&mut self, axis: Vector3<Q>, square: Q, length: Q, reach: Q, says: Q::Mask) {
        let says = says & !square.le(self.shortest);
        let [p, q, r] = [axis.dot(self.corners[0]), axis.dot(self.corners[1]), axis.dot(self.corners[2])];
        let (low, high) = (p.lesser(q).lesser(r), p.greater(q).greater(r));
        let (ahead, behind) = (high + reach, reach - low);
        let overlap = ahead.lesser(behind);
        self.apart = self.apart | (says & (ahead.lt(Q::ZERO) | behind.lt(Q::ZERO)));
        let better = says & overlap.lt(self.overlap * length);
        if better.any() {
            let inverse = Q::ONE / length;
            let signed = Q::select(ahead.le(behind), inverse, -inverse);
            self.overlap = Q::select(better, overlap * inverse, self.overlap);
            self.normal = select(better, axis * signed, self.normal);
        }
    }

    /// Whether axes separate all.
    #[inline(always)]
    pub fn all_apart(&self) -> bool {
        !(!self.apart).any()
    }

    /// Where there is an axis to speak of.
    #[inline(always)]
    pub fn every(&self) -> Q::Mask {
        !self.apart
    }

    /// What was found.
    #[inline(always)]
    pub fn found(self) -> Least<Q> {
        let Self { apart, overlap, normal, .. } = self;
        Least { apart, overlap, normal, code: Q::ZERO, scale: Q::ZERO }
    }
}

/// `a` where the mask is true, `b` elsewhere.
#[inline(always)]
fn select<Q: Quad>(mask: Q::Mask, a: Vector3<Q>, b: Vector3<Q>) -> Vector3<Q> {
    Vector3::new(Q::select(mask, a.x, b.x), Q::select(mask, a.y, b.y), Q::select(mask, a.z, b.z))
}

/// How far a triangle reaches along a direction.
#[inline]
pub(super) fn level(corners: &[Vec3; 3], n: Vec3) -> f64 {
    let p = [n.dot(corners[0]), n.dot(corners[1]), n.dot(corners[2])];
    greater(greater(p[0], p[1]), p[2])
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
#[inline(always)]
fn is_over<Q: Quad>(corners: &[Vector3<Q>; 3], normal: Vector3<Q>, p: Vector3<Q>) -> Q::Mask {
    let [a, b, c] = *corners;
    (b - a).cross(normal).dot(p - a).le(Q::ZERO)
        & (c - b).cross(normal).dot(p - b).le(Q::ZERO)
        & (a - c).cross(normal).dot(p - c).le(Q::ZERO)
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
    let mut near = Numbers::NONE;
    near.find(mesh, &around);
    let mut found = FacetContacts::new();
    let overlap = {
        let mut search = Search {
            rule,
            mesh,
            local: &local,
            body: &body,
            sieve: Sieve::new(mesh, local, rule.half(), R::BOTH_SIDES),
            found: &mut found,
            overlap: false,
            all: out.all(),
        };
        dispatch_quads(Look { search: &mut search, at: &near });
        let Search { mut all, overlap, .. } = search;
        drop_unsupported(&mut all);
        // Clipping may lose what overlaps.
        if overlap && all.is_empty() {
            for facet in near.each().filter_map(|i| mesh.facet(i)) {
                own_contacts(&body, &facet, &mut all);
            }
        }
        overlap
    };
    super::reduce::keep_wanted(out, body.reach());
    if overlap && out.is_empty() {
        lift_among(&near, &body, mesh, out);
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
    found: &'a mut FacetContacts,
    /// Whether any triangle overlaps the body.
    overlap: bool,
    all: Contacts<'a>,
}

/// Up to four triangles that have passed the sieve, by lanes.
struct Batch {
    count: usize,
    numbers: [u32; 4],
    flags: [u8; 4],
    meets_box: [f64; 4],
    corners: [[[f64; 4]; 3]; 3],
    normal: [[f64; 4]; 3],
    height: [f64; 4],
    depth: [f64; 4],
}

impl Batch {
    const EMPTY: Self = Self {
        count: 0,
        numbers: [0; 4],
        flags: [0; 4],
        meets_box: [0.0; 4],
        corners: [[[0.0; 4]; 3]; 3],
        normal: [[0.0; 4]; 3],
        height: [0.0; 4],
        depth: [0.0; 4],
    };

    /// Adds lane `from` of another.
    #[inline(always)]
    fn take(&mut self, of: &Self, from: usize, number: u32, flags: u8, meets_box: bool) {
        let (l, from) = (self.count & 3, from & 3);
        self.numbers[l] = number;
        self.flags[l] = flags;
        self.meets_box[l] = f64::from(u8::from(meets_box));
        for c in 0..3 {
            for k in 0..3 {
                self.corners[c][k][l] = of.corners[c][k][from];
            }
        }
        for k in 0..3 {
            self.normal[k][l] = of.normal[k][from];
        }
        self.height[l] = of.height[from];
        self.depth[l] = of.depth[from];
        self.count += 1;
    }

    #[inline(always)]
    fn put<Q: Quad>(&mut self, corners: &[Vector3<Q>; 3], normal: Vector3<Q>, height: Q, depth: Q) {
        for (to, from) in self.corners.iter_mut().zip(corners) {
            store(*from, to);
        }
        store(normal, &mut self.normal);
        height.store(&mut self.height);
        depth.store(&mut self.depth);
    }

    #[inline(always)]
    fn near<Q: Quad>(&self) -> Near<Q> {
        let corners = [load(&self.corners[0]), load(&self.corners[1]), load(&self.corners[2])];
        Near { corners, normal: load(&self.normal), depth: Q::load(&self.depth) }
    }

    #[inline(always)]
    fn lane(&self, l: usize) -> Near<f64> {
        let at = |v: &[[f64; 4]; 3]| Vec3::new(v[0][l & 3], v[1][l & 3], v[2][l & 3]);
        let corners = [at(&self.corners[0]), at(&self.corners[1]), at(&self.corners[2])];
        Near { corners, normal: at(&self.normal), depth: self.depth[l & 3] }
    }
}

#[inline(always)]
fn load<Q: Quad>(from: &[[f64; 4]; 3]) -> Vector3<Q> {
    Vector3::new(Q::load(&from[0]), Q::load(&from[1]), Q::load(&from[2]))
}

#[inline(always)]
fn store<Q: Quad>(v: Vector3<Q>, to: &mut [[f64; 4]; 3]) {
    let [x, y, z] = to;
    v.x.store(x);
    v.y.store(y);
    v.z.store(z);
}

/// A search through the triangles near a body.
struct Look<'a, 'b, R> {
    search: &'a mut Search<'b, R>,
    at: &'a Numbers,
}

impl<R: Rule> QuadKernel for Look<'_, '_, R> {
    type Out = ();

    #[inline(always)]
    fn run<Q: Quad>(self) {
        let Self { search, at } = self;
        let (mut sifted, mut batch) = (Batch::EMPTY, Batch::EMPTY);
        for (four, count) in at.fours() {
            let near = search.sieve.sift::<Q>(four);
            let n = near.normal;
            let depth = -near.height - n.dot(search.rule.lowest(n));
            // A triangle without area has no normal.
            let sound = Q::ZERO.lt(n.x.abs() + n.y.abs() + n.z.abs());
            let mut stay = Q::bits(near.stays & Q::ZERO.le(depth) & sound) & ((1 << count) - 1);
            if stay == 0 {
                continue;
            }
            sifted.put(&near.corners, n, near.height, depth);
            let meets = Q::bits(near.meets_box);
            while stay != 0 {
                let l = (stay.trailing_zeros() & 3) as usize;
                stay &= stay - 1;
                let flags = search.mesh.use_flags(four[l]);
                batch.take(&sifted, l, four[l], flags, meets >> l & 1 != 0);
                if batch.count == 4 {
                    search.consider::<Q>(&batch);
                    batch.count = 0;
                }
            }
        }
        if batch.count > 0 {
            search.consider::<Q>(&batch);
        }
    }
}

impl<R: Rule> Search<'_, R> {
    /// Looks at up to four triangles.
    #[inline(always)]
    fn consider<Q: Quad>(&mut self, batch: &Batch) {
        let near = batch.near::<Q>();
        let present = (1u8 << batch.count) - 1;
        let wanted = Q::ZERO.lt(Q::load(&batch.meets_box));
        let least = self.rule.axes(&near, batch.flags, wanted);
        let touching = Q::bits(wanted & !least.apart) & present;
        let beside = !touching & present;
        let over = if beside == 0 {
            0
        } else {
            let faces = Q::ZERO.le(Q::load(&batch.height));
            let over = is_over(&near.corners, near.normal, self.rule.lowest(near.normal));
            Q::bits(faces & over) & beside
        };
        let mut any = touching | over;
        if any == 0 {
            return;
        }
        let (mut overlap, mut code, mut scale) = ([0.0; 4], [0.0; 4], [0.0; 4]);
        let mut normal = [[0.0; 4]; 3];
        least.overlap.store(&mut overlap);
        least.code.store(&mut code);
        least.scale.store(&mut scale);
        store(least.normal, &mut normal);
        while any != 0 {
            let l = (any.trailing_zeros() & 3) as usize;
            any &= any - 1;
            if over >> l & 1 != 0 {
                self.pass_over(batch.numbers[l]);
            } else {
                let least = Least {
                    apart: false,
                    overlap: overlap[l],
                    normal: Vec3::new(normal[0][l], normal[1][l], normal[2][l]),
                    code: code[l],
                    scale: scale[l],
                };
                self.touch(batch.numbers[l], &batch.lane(l), &least);
            }
        }
    }

    /// Adds what a body has below a triangle that it does not touch.
    #[inline(never)]
    fn pass_over(&mut self, i: u32) {
        if let Some(facet) = self.mesh.facet(i) {
            let body = self.body;
            move_down(&mut self.all, |out| hidden_contact(body, body.middle(), &facet, out));
        }
    }

    /// Adds the contacts with a triangle that no axis separates from the body.
    #[inline(never)]
    fn touch(&mut self, i: u32, near: &Near<f64>, least: &Least<f64>) {
        self.overlap = true;
        self.found.count = 0;
        self.rule.contacts(near, least, self.found);
        let verdict = self.found.verdict(near, self.mesh.neighbours(i));
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
    lift_among(&Numbers::near(mesh, aabb), body, mesh, out);
}

/// As [`lift_out`], out of one of these triangles.
fn lift_among(near: &Numbers, body: &Body<'_>, mesh: &TriMesh, out: &mut Contacts<'_>) {
    let mut best: Option<GeomContact> = None;
    let (frame, half) = box_around(body);
    Sieve::new(mesh, frame, half, true).each(near, |i, meets_box| {
        let Some(facet) = mesh.facet(i).filter(|_| meets_box) else { return };
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
