use super::closest_line_points;
use super::facet_axes::{FacetContacts, LeastOverlap, Place, each_facet};
use super::polygon::Polygon;
use super::triangle::Facet;
use crate::{Contacts, Cuboid, Frame, Shape, TriMesh};
use ferrode_math::Vec3;

/// By how much an edge's axis must be better than a face's.
const EDGE: f64 = 1.5;

/// A box and a mesh: for each triangle the axis of least overlap among its normal, the box's axes and the products of
/// edges, which must be better by half; then what of the box's face is below the triangle, what of the triangle is below
/// the box's face, or the point where two edges are nearest.
///
/// Along its normal a triangle pushes to the front only: a box that has sunk below a surface is lifted out. Where ODE's
/// rule contradicts the surface, as at edges within it, the contacts are those of `body_trimesh`.
pub fn cuboid_trimesh(cuboid: &Cuboid, fa: &Frame, mesh: &TriMesh, fm: &Frame, out: &mut Contacts<'_>) {
    let half = cuboid.half_sides();
    each_facet(&Shape::Cuboid(*cuboid), fa, mesh, fm, out, |fb, facet| cuboid_facet(half, fb, facet));
}

fn cuboid_facet(half: Vec3, fb: &Frame, t: &Facet) -> Option<FacetContacts> {
    let v = t.corners.map(|p| p - fb.position);
    let axes = [fb.axis(0), fb.axis(1), fb.axis(2)];
    let reach = |d: Vec3| {
        (d.dot(axes[0]) * half.x).abs() + (d.dot(axes[1]) * half.y).abs() + (d.dot(axes[2]) * half.z).abs()
    };
    let mut best = LeastOverlap::new(v, t.normal, reach, f64::EPSILON.sqrt());
    if best.overlap < 0.0 {
        return None;
    }
    for (i, &axis) in axes.iter().enumerate() {
        best.test(axis, 1.0, 1 + i)?;
    }
    let edges = [v[1] - v[0], v[2] - v[1], v[0] - v[2]];
    for (i, axis) in axes.iter().enumerate() {
        for (e, edge) in edges.iter().enumerate() {
            best.test(axis.cross(*edge), EDGE, 4 + 3 * i + e)?;
        }
    }
    let n = best.normal;
    Some(match best.code {
        0 => {
            // The box's face that looks at the triangle.
            let along = axes.map(|a| n.dot(a));
            let i = (1..3).fold(0, |b, i| if along[i].abs() > along[b].abs() { i } else { b });
            let sign = if along[i] > 0.0 { -1.0 } else { 1.0 };
            let (j, k) = ((i + 1) % 3, (i + 2) % 3);
            let center = axes[i] * (sign * half[i]);
            let (x, y) = (axes[j] * half[j], axes[k] * half[k]);
            let mut face = Polygon::new(&[center + x + y, center - x + y, center - x - y, center + x - y]);
            for (e, corner) in v.iter().enumerate() {
                let outward = t.outward(e);
                face.keep_below(outward, outward.dot(*corner));
            }
            let level = n.dot(v[0]);
            face.keep_below(n, level);
            let mut found = FacetContacts::new(n, Place::Deepest);
            face.corners().iter().for_each(|&p| found.push(fb.position + p, (level - n.dot(p)).max(0.0)));
            found
        }
        code @ 1..=3 => {
            let i = code - 1;
            let mut triangle = Polygon::new(&v);
            for j in [(i + 1) % 3, (i + 2) % 3] {
                triangle.keep_below(axes[j], half[j]);
                triangle.keep_below(-axes[j], half[j]);
            }
            triangle.keep_below(-n, half[i]);
            let mut found = FacetContacts::new(n, Place::Deepest);
            triangle
                .corners()
                .iter()
                .for_each(|&p| found.push(fb.position + p, (half[i] + n.dot(p)).max(0.0)));
            found
        }
        code => {
            let (i, e) = ((code - 4) / 3, (code - 4) % 3);
            let mut p = Vec3::ZERO;
            for k in (0..3).filter(|&k| k != i) {
                p -= axes[k] * half[k].copysign(n.dot(axes[k]));
            }
            let length = edges[e].length();
            let edge = edges[e] * (1.0 / length);
            let (x, y) = closest_line_points(p, axes[i], v[e], edge);
            let middle = (p + axes[i] * x + v[e] + edge * y) * 0.5;
            // The lines may pass each other beyond the ends of the edges.
            let slack = 1e-6 * length.max(half[i]);
            let met = x.abs() <= half[i] + slack && (-slack..=length + slack).contains(&y);
            let mut found = FacetContacts::new(n, if met { Place::Furthest } else { Place::Nowhere });
            found.push(fb.position + middle, best.overlap);
            found
        }
    })
}
