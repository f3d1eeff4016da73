//! ODE's way with a body and a mesh: each triangle for itself, by separating axes and clipping.
//!
//! What the rules say of a triangle can contradict the surface that it belongs to: a body that slides over a plane of
//! two triangles meets the edge between them. Such an answer is replaced by that of [`body_facet`].

use super::body_trimesh::body_trimesh;
use super::convex::touch;
use super::support::Body;
use super::triangle::{Facet, Verdict, body_facet, hidden_contact, judge};
use crate::{Contacts, Frame, GeomContact, Shape, TriMesh};
use ferrode_math::{Aabb, Vec3};

/// Most contacts with one triangle.
const MOST: usize = 16;
/// Contacts nearer than this, in metres, and with normals whose cosine is as near to one, are one.
const ONE: f64 = 1e-4;

/// What a rule finds between a body and a triangle.
pub(super) struct FacetContacts {
    /// Unit, into the body.
    normal: Vec3,
    /// Position and depth.
    list: [(Vec3, f64); MOST],
    count: usize,
    place: Place,
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
    /// No contacts yet.
    pub fn new(normal: Vec3, place: Place) -> Self {
        Self { normal, list: [(Vec3::ZERO, 0.0); MOST], count: 0, place }
    }

    pub fn push(&mut self, position: Vec3, depth: f64) {
        if self.count < MOST {
            self.list[self.count] = (position, depth);
            self.count += 1;
        }
    }

    /// What the surface says of these contacts.
    fn verdict(&self, facet: &Facet) -> Verdict {
        let Some(&(deepest, _)) = self.list[..self.count].iter().reduce(|a, b| if b.1 > a.1 { b } else { a })
        else {
            return Verdict::Sound;
        };
        let point = match self.place {
            Place::Deepest => deepest,
            Place::Nowhere => return Verdict::Ghost,
            Place::Furthest => facet.furthest(self.normal),
        };
        judge(facet, self.normal, point)
    }
}

/// The least overlap of a body and a triangle over some axes.
pub(super) struct LeastOverlap<F> {
    /// The triangle's corners from the body's centre.
    pub corners: [Vec3; 3],
    /// Half the body's extent along a unit vector; the body has a centre of symmetry.
    pub reach: F,
    /// Shorter axes say nothing.
    pub shortest: f64,
    pub overlap: f64,
    /// Unit, into the body.
    pub normal: Vec3,
    /// Which axis it was.
    pub code: usize,
}

impl<F: Fn(Vec3) -> f64> LeastOverlap<F> {
    /// The overlap along the triangle's normal, out of its front.
    pub fn new(corners: [Vec3; 3], normal: Vec3, reach: F, shortest: f64) -> Self {
        let overlap = normal.dot(corners[0]) + reach(normal);
        Self { corners, reach, shortest, overlap, normal, code: 0 }
    }

    /// Tries an axis of any length, which must be better than the best by a factor; `None` if it separates.
    #[inline]
    pub fn test(&mut self, axis: Vec3, factor: f64, code: usize) -> Option<()> {
        let square = axis.length_squared();
        if square <= self.shortest * self.shortest {
            return Some(());
        }
        let n = axis * (1.0 / square.sqrt());
        let reach = (self.reach)(n);
        let p = self.corners.map(|v| n.dot(v));
        let (low, high) = (p[0].min(p[1]).min(p[2]), p[0].max(p[1]).max(p[2]));
        let (ahead, behind) = (high + reach, reach - low);
        if ahead < 0.0 || behind < 0.0 {
            return None;
        }
        let (overlap, normal) = if ahead <= behind { (ahead, n) } else { (behind, -n) };
        if overlap * factor < self.overlap {
            (self.overlap, self.normal, self.code) = (overlap, normal, code);
        }
        Some(())
    }

    /// How far the triangle reaches along the normal.
    pub fn level(&self) -> f64 {
        let p = self.corners.map(|v| self.normal.dot(v));
        p[0].max(p[1]).max(p[2])
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

/// Applies a rule to all triangles near a body; the rule gets the body's frame in the mesh's coordinates. Contacts at one
/// place with one normal are one, the deeper.
pub(super) fn each_facet(
    shape: &Shape,
    fa: &Frame,
    mesh: &TriMesh,
    fm: &Frame,
    out: &mut Contacts<'_>,
    rule: impl Fn(&Frame, &Facet) -> Option<FacetContacts>,
) {
    let at = fm.point_to_local(fa.position);
    let reach = shape.reach() * (1.0 + 1e-9);
    if !mesh.bounds().overlaps(&Aabb::from_center(at, Vec3::splat(reach))) {
        return;
    }
    let local = Frame::new(at, fm.rotation.transpose() * fa.rotation);
    let Some(body) = Body::of(shape, &local, Vec3::ZERO) else { return };
    let mut overlap = false;
    {
        let mut all = out.all();
        mesh.tree().query(&shape.aabb_in(&local), |i| {
            let Some(facet) = mesh.facet(i) else { return };
            let Some(found) = rule(&local, &facet) else {
                move_down(&mut all, |out| hidden_contact(&body, body.middle(), &facet, out));
                return;
            };
            overlap = true;
            let verdict = found.verdict(&facet);
            if verdict == Verdict::Ghost {
                own_contacts(&body, &facet, &mut all);
                return;
            }
            for &(p, depth) in &found.list[..found.count] {
                let mut c = GeomContact::new(p, found.normal, depth);
                c.side2 = facet.index;
                if verdict == Verdict::FromBehind {
                    c.side1 = FROM_BEHIND;
                }
                add_distinct(c, &mut all);
            }
        });
        drop_unsupported(&mut all);
        // Clipping may lose what overlaps.
        if overlap && all.is_empty() {
            mesh.tree().query(&shape.aabb_in(&local), |i| {
                if let Some(facet) = mesh.facet(i) {
                    own_contacts(&body, &facet, &mut all);
                }
            });
        }
    }
    super::reduce::keep_wanted(out, body.reach());
    if overlap && out.is_empty() {
        lift_out(&body, mesh, &shape.aabb_in(&local), out);
    }
    for c in out.added() {
        c.point.position = fm.point_to_world(c.point.position);
        c.point.normal = fm.vector_to_world(c.point.normal);
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
    mesh.tree().query(aabb, |i| {
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
        (k.point.position - c.point.position).abs_max() < ONE
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

/// A convex body without a rule of its own, and a mesh: the contacts of `body_trimesh`, or if it has sunk through the surface
/// the one that lifts it out.
pub(super) fn convex_trimesh(shape: &Shape, fa: &Frame, mesh: &TriMesh, fm: &Frame, out: &mut Contacts<'_>) {
    body_trimesh(shape, fa, mesh, fm, out);
    if !out.is_empty() {
        return;
    }
    let at = fm.point_to_local(fa.position);
    if !mesh.bounds().overlaps(&Aabb::from_center(at, Vec3::splat(shape.reach() * (1.0 + 1e-9)))) {
        return;
    }
    let local = Frame::new(at, fm.rotation.transpose() * fa.rotation);
    let Some(body) = Body::of(shape, &local, Vec3::ZERO) else { return };
    lift_out(&body, mesh, &shape.aabb_in(&local), out);
    for c in out.added() {
        c.point.position = fm.point_to_world(c.point.position);
        c.point.normal = fm.vector_to_world(c.point.normal);
    }
}
