use super::facet_axes::{FacetContacts, LeastOverlap, Place, clip_segment, each_facet};
use super::polygon::Polygon;
use super::triangle::Facet;
use crate::{Contacts, Cylinder, Frame, Shape, TriMesh};
use core::f64::consts::FRAC_PI_8;
use ferrode_math::{Vec3, real};

/// Shortest axis that says anything, and least cosine of an edge and the cylinder's axis at which it meets the rims.
const SHORTEST: f64 = 1e-5;
/// Cosine of normal and axis from which a contact is at the cap rather than the side.
const CAP: f64 = 0.9;

/// A cylinder and a mesh: for each triangle that has the cylinder's middle before it, the axis of least overlap among its
/// normal, the cylinder's axis and those that edges and corners make with side and rims; then the line of the cylinder
/// that is deepest, as far as it is over the triangle, or what of the triangle is over the cap, taken as an octagon about
/// its circle.
///
/// Where ODE's rule contradicts the surface, as at edges within it, the contacts are those of `body_trimesh`.
pub fn cylinder_trimesh(cylinder: &Cylinder, fa: &Frame, mesh: &TriMesh, fm: &Frame, out: &mut Contacts<'_>) {
    let (radius, half) = (cylinder.radius(), 0.5 * cylinder.length());
    each_facet(&Shape::Cylinder(*cylinder), fa, mesh, fm, out, |fc, facet| {
        cylinder_facet(radius, half, fc, facet)
    });
}

fn cylinder_facet(radius: f64, half: f64, fc: &Frame, t: &Facet) -> Option<FacetContacts> {
    if t.height(fc.position) < 0.0 {
        return None;
    }
    let v = t.corners.map(|p| p - fc.position);
    let u = fc.axis(2);
    // The sine by the cross product: from a cosine near 1 it would be rounding's root.
    let reach = |d: Vec3| d.dot(u).abs() * half + radius * u.cross(d).length();
    let mut best = LeastOverlap::new(v, t.normal, reach, SHORTEST);
    if best.overlap < 0.0 {
        return None;
    }
    let edges = [v[1] - v[0], v[2] - v[1], v[0] - v[2]];
    for edge in edges {
        best.test(u.cross(edge), 1.0, 1)?;
    }
    for corner in v {
        best.test(u.cross(u.cross(corner)), 1.0, 1)?;
    }
    best.test(u, 1.0, 1)?;
    // Where the line of an edge crosses the plane of a rim, the rim's tangent and the edge span a plane that may separate.
    for rim in [u * half, u * -half] {
        for (e, edge) in edges.iter().enumerate() {
            let along = edge.dot(u);
            if along.abs() < SHORTEST * edge.length() {
                continue;
            }
            let crossing = v[e] + *edge * ((rim - v[e]).dot(u) / along);
            best.test((crossing - rim).cross(u).cross(*edge), 1.0, 1)?;
        }
    }
    let n = best.normal;
    let c = n.dot(u);
    if c.abs() < CAP {
        let side = (n - u * c).normalized()? * radius;
        let mut found = FacetContacts::new(n, Place::Furthest);
        let line = clip_segment([u * half - side, u * -half - side], &v, t.normal);
        for p in line.into_iter().flatten() {
            found.push(fc.position + p, (best.level() - n.dot(p)).max(0.0));
        }
        return Some(found);
    }
    let inward = if c > 0.0 { u } else { -u };
    let cap = inward * -half;
    let mut triangle = Polygon::new(&v);
    triangle.clip(inward, -inward.dot(cap));
    for k in 0..8 {
        let angle = FRAC_PI_8 + f64::from(k) * 2.0 * FRAC_PI_8;
        let radial = fc.axis(0) * real::cos(angle) + fc.axis(1) * real::sin(angle);
        triangle.clip(-radial, radial.dot(cap) + radius);
    }
    let reach = (best.reach)(n);
    let mut found = FacetContacts::new(n, Place::Deepest);
    for &p in triangle.corners() {
        let depth = reach + p.dot(n);
        if depth >= 0.0 {
            found.push(fc.position + p, depth);
        }
    }
    Some(found)
}
