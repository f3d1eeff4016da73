use super::closest_line_points;
use super::cutout::Cutout;
use super::facet_axes::{FacetContacts, Near, Place, Rule, each_facet, greater, lesser};
use crate::{Contacts, Cuboid, Frame, Shape, TriMesh};
use ferrode_math::Vec3;

/// By how much an edge's axis must be better than a face's.
const EDGE: f64 = 1.5;

/// A box and a mesh: for each triangle the axis of least overlap among its normal, the box's axes and the products of
/// edges, which must be better by half; then what of the box's face is below the triangle, what of the triangle is below
/// the box's face, or the point where two edges are nearest.
///
/// Along its normal a triangle pushes to the front only: a box that has sunk below a surface is lifted out. Where ODE's
/// rule contradicts the surface, as at edges within it, the part of the box's face over the triangle counts.
pub fn cuboid_trimesh(cuboid: &Cuboid, fa: &Frame, mesh: &TriMesh, fm: &Frame, out: &mut Contacts<'_>) {
    let rule = CuboidRule { half: cuboid.half_sides() };
    each_facet(&Shape::Cuboid(*cuboid), fa, mesh, fm, out, &rule);
}

struct CuboidRule {
    half: Vec3,
}

/// The axis of least overlap: overlap, unit normal into the box, and 0 for the triangle's normal, 1 to 3 for the box's axes,
/// 4 + 3 i + e for axis i with edge e.
struct Least {
    overlap: f64,
    normal: Vec3,
    code: usize,
}

const AXES: [Vec3; 3] = [Vec3::X, Vec3::Y, Vec3::Z];

impl Rule for CuboidRule {
    const BOTH_SIDES: bool = true;

    #[inline(always)]
    fn half(&self) -> Vec3 {
        self.half
    }

    #[inline(always)]
    fn lowest(&self, n: Vec3) -> Vec3 {
        Vec3::new(-self.half.x.copysign(n.x), -self.half.y.copysign(n.y), -self.half.z.copysign(n.z))
    }

    fn touch(&self, near: &Near, _: u8, found: &mut FacetContacts) -> bool {
        let Some(least) = self.least_overlap(near) else { return false };
        found.normal = least.normal;
        found.place = Place::Deepest;
        match least.code {
            0 => self.face_below_triangle(near, found),
            1..=3 => self.triangle_below_face(near, least.code - 1, found),
            _ => self.edges(near, &least, found),
        }
        true
    }
}

impl CuboidRule {
    #[inline(always)]
    fn least_overlap(&self, near: &Near) -> Option<Least> {
        let (v, h) = (&near.corners, self.half);
        let mut best = Least { overlap: near.depth, normal: near.normal, code: 0 };
        for i in 0..3 {
            let low = lesser(lesser(v[0][i], v[1][i]), v[2][i]);
            let high = greater(greater(v[0][i], v[1][i]), v[2][i]);
            let (ahead, behind) = (high + h[i], h[i] - low);
            if ahead < 0.0 || behind < 0.0 {
                return None;
            }
            let overlap = lesser(ahead, behind);
            if overlap < best.overlap {
                let normal = if ahead <= behind { AXES[i] } else { -AXES[i] };
                best = Least { overlap, normal, code: 1 + i };
            }
        }
        // Axis i × edge e has two components, and two of the triangle's corners are as far along it. What is compared is
        // squares: of axes that are better the length is needed, of others not.
        let edges = [v[1] - v[0], v[2] - v[1], v[0] - v[2]];
        let mut found = [[(0.0, 0.0, 0.0); 3]; 3];
        let mut apart = false;
        for (i, row) in found.iter_mut().enumerate() {
            let (j, k) = ((i + 1) % 3, (i + 2) % 3);
            for (e, axis) in row.iter_mut().enumerate() {
                let (x, y) = (-edges[e][k], edges[e][j]);
                let (p, q) = (x * v[e][j] + y * v[e][k], {
                    let third = v[(e + 2) % 3];
                    x * third[j] + y * third[k]
                });
                let reach = x.abs() * h[j] + y.abs() * h[k];
                let (ahead, behind) = (greater(p, q) + reach, reach - lesser(p, q));
                // A short axis says nothing.
                let square = x * x + y * y;
                apart |= (lesser(ahead, behind) < 0.0) & (square > f64::EPSILON);
                *axis = (ahead, behind, square);
            }
        }
        if apart {
            return None;
        }
        for (i, row) in found.iter().enumerate() {
            for (e, &(ahead, behind, square)) in row.iter().enumerate() {
                let overlap = lesser(ahead, behind) * EDGE;
                if overlap * overlap < best.overlap * best.overlap * square && square > f64::EPSILON {
                    let inverse = 1.0 / square.sqrt();
                    let (j, k) = ((i + 1) % 3, (i + 2) % 3);
                    let sign = if ahead <= behind { inverse } else { -inverse };
                    let mut normal = Vec3::ZERO;
                    normal[j] = -edges[e][k] * sign;
                    normal[k] = edges[e][j] * sign;
                    best = Least { overlap: lesser(ahead, behind) * inverse, normal, code: 4 + 3 * i + e };
                }
            }
        }
        Some(best)
    }

    /// What of the box's face that looks at the triangle is over the triangle and below it.
    fn face_below_triangle(&self, near: &Near, found: &mut FacetContacts) {
        let (v, n, h) = (&near.corners, near.normal, self.half);
        let i = (1..3).fold(0, |b, i| if n[i].abs() > n[b].abs() { i } else { b });
        let (j, k) = ((i + 1) % 3, (i + 2) % 3);
        let mut corner = [Vec3::ZERO; 4];
        for (p, (x, y)) in corner.iter_mut().zip([(1.0, 1.0), (-1.0, 1.0), (-1.0, -1.0), (1.0, -1.0)]) {
            p[i] = if n[i] > 0.0 { -h[i] } else { h[i] };
            p[j] = x * h[j];
            p[k] = y * h[k];
        }
        let mut face = Cutout::new(&corner);
        let level = n.dot(v[0]);
        face.keep_below(n, level);
        for e in 0..3 {
            let outward = (v[(e + 1) % 3] - v[e]).cross(n);
            face.keep_below(outward, outward.dot(v[e]));
        }
        face.corners().iter().for_each(|&p| found.push(p, greater(level - n.dot(p), 0.0)));
    }

    /// What of the triangle is over a face of the box, the one that looks along −normal, and below it.
    fn triangle_below_face(&self, near: &Near, i: usize, found: &mut FacetContacts) {
        let (n, h) = (found.normal, self.half);
        let mut triangle = Cutout::new(&near.corners);
        for j in [(i + 1) % 3, (i + 2) % 3] {
            triangle.keep_below(AXES[j], h[j]);
            triangle.keep_below(-AXES[j], h[j]);
        }
        triangle.keep_below(-n, h[i]);
        triangle.corners().iter().for_each(|&p| found.push(p, greater(h[i] + n.dot(p), 0.0)));
    }

    /// The point midway between the edges that touch.
    fn edges(&self, near: &Near, least: &Least, found: &mut FacetContacts) {
        let (v, n, h) = (&near.corners, least.normal, self.half);
        let (i, e) = ((least.code - 4) / 3, (least.code - 4) % 3);
        let mut p = Vec3::ZERO;
        for k in (0..3).filter(|&k| k != i) {
            p[k] = -h[k].copysign(n[k]);
        }
        let along = v[(e + 1) % 3] - v[e];
        let length = along.length();
        let edge = along * (1.0 / length);
        let (x, y) = closest_line_points(p, AXES[i], v[e], edge);
        let middle = (p + AXES[i] * x + v[e] + edge * y) * 0.5;
        // The lines may pass each other beyond the ends of the edges.
        let slack = 1e-6 * greater(length, h[i]);
        let met = x.abs() <= h[i] + slack && (-slack..=length + slack).contains(&y);
        found.place = if met { Place::Furthest } else { Place::Nowhere };
        found.push(middle, least.overlap);
    }
}
