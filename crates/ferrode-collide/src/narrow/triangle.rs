//! A triangle of a surface against a body.

use super::convex::{Touch, touch};
use super::gjk::{EXACT, Gap, gjk_from};
use super::hull_facet::{Axes, hull_facet};
use super::manifold::{add_face_contacts, add_manifold, add_part_over};
use super::over_face::over_face;
use super::support::Body;
use crate::shape::Neighbour;
use crate::{Contacts, GeomContact};
use ferrode_math::{Aabb, Vec3};

/// A triangle with its front, and what lies beyond its edges.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Facet {
    pub corners: [Vec3; 3],
    /// Unit.
    pub normal: Vec3,
    pub neighbours: [Neighbour; 3],
    /// Its number in the surface.
    pub index: i32,
}

impl Facet {
    /// Height of a point over the triangle's plane.
    #[inline]
    pub fn height(&self, p: Vec3) -> f64 {
        self.normal.dot(p - self.corners[0])
    }

    /// The triangle's point nearest to `p`.
    pub fn nearest(&self, p: Vec3) -> Vec3 {
        let [a, b, c] = self.corners.map(|x| x - p);
        let (places, weights, n) = super::gjk::nearest_of_triangle(a, b, c);
        let mut q = Vec3::ZERO;
        for k in 0..n {
            q += self.corners[places[k]] * weights[k];
        }
        q
    }

    /// A length like the triangle's.
    pub fn scale(&self) -> f64 {
        (self.corners[1] - self.corners[0]).abs_max() + (self.corners[2] - self.corners[0]).abs_max()
    }

    /// The unit direction in the plane that leads out over edge `e`.
    pub fn outward(&self, e: usize) -> Vec3 {
        (self.corners[(e + 1) % 3] - self.corners[e]).cross(self.normal).normalized_or(Vec3::ZERO)
    }
}

/// Cosines nearer than this are one direction.
pub(crate) const SAME: f64 = 1e-6;
/// Sines less than this are rounding.
const LEAN: f64 = 1e-9;

/// Adds the contacts of a body with a triangle, normals into the body, if the body's middle is before the triangle.
///
/// A body that slides over a surface must not be caught by the edges within it. So a normal at an edge is kept only if
/// it lies between those of the two triangles there; else the triangle's own normal counts, with the part of the body's
/// face that is over the triangle.
pub(crate) fn body_facet(body: &Body<'_>, middle: Vec3, facet: &Facet, out: &mut Contacts<'_>) {
    near_facet(body, middle, facet, true, out);
}

/// As [`body_facet`]; `may_touch` is false if it is known that the two do not meet.
pub(super) fn near_facet(
    body: &Body<'_>,
    middle: Vec3,
    facet: &Facet,
    may_touch: bool,
    out: &mut Contacts<'_>,
) {
    let n = facet.normal;
    if !(facet.height(middle) >= 0.0) {
        return;
    }
    let lowest = body.support(-n);
    if !(facet.height(lowest) <= body.margin) {
        return;
    }
    let triangle = Body::triangle(facet.corners);
    let first = out.len();
    // Where the surface goes on beyond every edge without a bend outward, nothing but the face pushes, however deep.
    let inner = facet.neighbours.iter().all(|n| matches!(n, Neighbour::FlatOrConcave));
    if inner && body.margin == 0.0 {
        let overlap = || match hull_facet(body, middle, facet, lowest) {
            Some(axes) => !matches!(axes, Axes::Apart),
            None => {
                let start = body.center - triangle.center;
                matches!(gjk_from(body, &triangle, 0.0, start, EXACT), Gap::Overlap(_))
            }
        };
        if may_touch && overlap() {
            add_face(body, middle, facet, 0.5, out);
        } else {
            add_hidden_contact(body, middle, facet, lowest, out);
        }
        for c in &mut out.added()[first..] {
            c.side2 = facet.index;
        }
        return;
    }
    let by_axes = || match hull_facet(body, middle, facet, lowest) {
        Some(Axes::Apart) => None,
        Some(Axes::Least(t)) => Some(t),
        Some(Axes::Overlap) | None => touch(body, &triangle),
    };
    let found = if may_touch { over_face(body, middle, facet, lowest).or_else(by_axes) } else { None };
    match found {
        // Beyond an edge within the surface the neighbour bears the body.
        Some(t) if t.normal.dot(n) > 1.0 - SAME && !at_inner_edge(facet, &t) => {
            add_manifold(body, &triangle, &Touch { normal: n, ..t }, Vec3::ZERO, out);
        }
        Some(t) if t.normal.dot(n) <= 1.0 - SAME && allowed(facet, &t) => {
            add_manifold(body, &triangle, &t, Vec3::ZERO, out)
        }
        Some(_) => add_face_contacts(body, &triangle, n, out),
        None => add_hidden_contact(body, middle, facet, lowest, out),
    }
    // Other triangles that the body leaves sooner: looked for once.
    let mut elsewhere = None;
    let mut kept = first;
    for i in first..out.len() {
        let mut c = out.added()[i];
        let on_face = !(c.point.normal.dot(n) < 1.0 - SAME);
        if !on_face
            || *elsewhere.get_or_insert_with(|| least_elsewhere(body, facet, middle))
                >= c.point.depth * (1.0 - 1e-6)
        {
            c.side2 = facet.index;
            out.added()[kept] = c;
            kept += 1;
        }
    }
    out.truncate(kept);
}

/// Adds the contacts of the body's face, edge or corner that is over the triangle, at the body's surface, if the body's middle
/// is before the triangle: what is left when no direction over an edge is one in which the surface could push.
pub(super) fn face_facet(body: &Body<'_>, middle: Vec3, facet: &Facet, out: &mut Contacts<'_>) {
    if !faces(body, middle, facet) {
        return;
    }
    add_face(body, middle, facet, 0.0, out);
}

/// As [`face_facet`], the contacts further up by a part of their depth.
fn add_face(body: &Body<'_>, middle: Vec3, facet: &Facet, share: f64, out: &mut Contacts<'_>) {
    let n = facet.normal;
    let most = least_elsewhere(body, facet, middle) / (1.0 - 1e-6);
    add_part_over(body, &facet.corners, n, |p, depth| {
        if depth <= most {
            let mut c = GeomContact::new(p + n * (share * depth), n, depth);
            c.side2 = facet.index;
            out.push_contact(c);
        }
    });
}

/// The least depth of the body below the triangles beyond convex edges that also have its middle before them.
fn least_elsewhere(body: &Body<'_>, facet: &Facet, middle: Vec3) -> f64 {
    let mut least = f64::INFINITY;
    for (neighbour, &corner) in facet.neighbours.iter().zip(&facet.corners) {
        if let Neighbour::Convex(other) = *neighbour
            && other.dot(middle - corner) > 0.0
        {
            let depth = other.dot(corner - body.support(-other)) + body.margin;
            if depth >= 0.0 && depth < least {
                least = depth;
            }
        }
    }
    least
}

/// Whether a body's middle is before a triangle, and the body reaches its plane.
fn faces(body: &Body<'_>, middle: Vec3, facet: &Facet) -> bool {
    facet.height(middle) >= 0.0 && facet.height(body.support(-facet.normal)) <= body.margin
}

/// The contact of a body with a triangle that it does not meet, although its lowest point is below it: see
/// [`add_hidden_contact`].
pub(super) fn hidden_contact(body: &Body<'_>, middle: Vec3, facet: &Facet, out: &mut Contacts<'_>) {
    if faces(body, middle, facet) {
        add_hidden_contact(body, middle, facet, body.support(-facet.normal), out);
    }
}

/// The lowest point of a body that entered the surface over a neighbour and so does not meet this triangle, although it
/// lies below it. `core` is the core's lowest point.
fn add_hidden_contact(body: &Body<'_>, middle: Vec3, facet: &Facet, core: Vec3, out: &mut Contacts<'_>) {
    let n = facet.normal;
    let lowest = core - n * body.margin;
    let (above, depth) = (facet.height(middle), -facet.height(lowest));
    if depth <= 0.0 {
        return;
    }
    let entry = middle + (lowest - middle) * (above / (above + depth));
    for e in 0..3 {
        // Of any length: only signs count.
        let outward = (facet.corners[(e + 1) % 3] - facet.corners[e]).cross(n);
        let beyond = |p: Vec3| outward.dot(p - facet.corners[e]) > 0.0;
        if beyond(lowest) || (beyond(entry) && facet.neighbours[e] != Neighbour::FlatOrConcave) {
            return;
        }
    }
    let mut c = GeomContact::new(lowest + n * (0.5 * depth), n, depth);
    c.side2 = facet.index;
    out.push_contact(c);
}

/// Whether the body leaves sooner past the triangle beyond a convex edge, which also has its middle before it: then a
/// contact with this one's face would push it the long way.
pub(crate) fn nearer_elsewhere(
    body: &Body<'_>,
    facet: &Facet,
    middle: Vec3,
    normal: Vec3,
    found: f64,
) -> bool {
    if normal.dot(facet.normal) < 1.0 - SAME {
        return false;
    }
    (0..3).any(|e| match facet.neighbours[e] {
        Neighbour::Convex(other) if other.dot(middle - facet.corners[e]) > 0.0 => {
            let depth = other.dot(facet.corners[e] - body.support(-other)) + body.margin;
            depth >= 0.0 && depth < found * (1.0 - 1e-6)
        }
        _ => false,
    })
}

/// Whether a touch is at an edge that the surface goes on beyond without a bend outward.
pub(crate) fn at_inner_edge(facet: &Facet, t: &Touch) -> bool {
    let scale = facet.scale();
    (0..3).any(|e| {
        facet.neighbours[e] == Neighbour::FlatOrConcave
            && facet.outward(e).dot(facet.corners[e] - t.b) <= 1e-6 * scale
    })
}

/// Whether the normal of a touch is one that the surface has at that point.
pub(crate) fn allowed(facet: &Facet, t: &Touch) -> bool {
    let along = t.normal.dot(facet.normal);
    if along < -SAME {
        return false;
    }
    let scale = facet.scale();
    for e in 0..3 {
        let out = facet.outward(e);
        // How far inside the edge the point is.
        if out.dot(facet.corners[e] - t.b) > 1e-6 * scale {
            continue;
        }
        match facet.neighbours[e] {
            Neighbour::None => {}
            // At a corner where this edge ends the normal may lean away from it.
            Neighbour::FlatOrConcave => {
                if t.normal.dot(out) > SAME {
                    return false;
                }
            }
            Neighbour::Convex(other) => {
                if t.normal.dot(out) < -SAME || along < other.dot(facet.normal) - SAME {
                    return false;
                }
            }
        }
    }
    true
}

/// What a surface says of a contact that has another normal than the triangle's.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Verdict {
    /// Nothing speaks against it.
    Sound,
    /// The normal points into the triangle: right only if a triangle that faces it is touched as well.
    FromBehind,
    /// The point is at an edge beyond which the surface goes on flat or rises, and the normal leans over that edge: there is
    /// nothing that could push that way.
    Ghost,
}

/// Judges the normal of a contact at a point of a triangle, which is asked for only if it matters.
#[inline]
pub(super) fn judge(
    corners: &[Vec3; 3],
    face: Vec3,
    neighbours: &[Neighbour; 3],
    normal: Vec3,
    point: impl FnOnce() -> Vec3,
) -> Verdict {
    let along = normal.dot(face);
    if along > 0.0 && (normal - face * along).length_squared() <= LEAN * LEAN {
        return Verdict::Sound;
    }
    if along < -LEAN {
        return Verdict::FromBehind;
    }
    // Directions out over the edges, as long as these: only their signs and squares matter.
    let leans = |e: usize| {
        let out = (corners[(e + 1) % 3] - corners[e]).cross(face);
        let lean = normal.dot(out);
        let inner = matches!(neighbours[e], Neighbour::FlatOrConcave);
        (inner && lean > 0.0 && lean * lean > LEAN * LEAN * out.length_squared()).then_some(out)
    };
    let leaning = [leans(0), leans(1), leans(2)];
    if leaning == [None; 3] {
        return Verdict::Sound;
    }
    let point = point();
    let near = 1e-6 * ((corners[1] - corners[0]).abs_max() + (corners[2] - corners[0]).abs_max());
    let ghost = (0..3).any(|e| {
        leaning[e].is_some_and(|out| {
            let inside = out.dot(corners[e] - point);
            inside <= 0.0 || inside * inside <= near * near * out.length_squared()
        })
    });
    if ghost { Verdict::Ghost } else { Verdict::Sound }
}

/// The box around a body, in the coordinates it is placed in.
pub(crate) fn bounds(body: &Body<'_>) -> Aabb {
    let along = |d: Vec3| body.support(d).dot(d) + body.margin;
    Aabb::new(
        Vec3::new(-along(-Vec3::X), -along(-Vec3::Y), -along(-Vec3::Z)),
        Vec3::new(along(Vec3::X), along(Vec3::Y), along(Vec3::Z)),
    )
}
