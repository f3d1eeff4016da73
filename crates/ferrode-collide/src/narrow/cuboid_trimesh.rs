use super::closest_line_points;
use super::cutout::Cutout;
use super::facet_axes::{FacetContacts, Least, Near, Place, Rule, each_facet, greater};
use super::sieve::splat;
use crate::{Contacts, Cuboid, Frame, Shape, TriMesh};
use ferrode_math::simd::{Mask, Quad};
use ferrode_math::{Vec3, Vector3};

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

const AXES: [Vec3; 3] = [Vec3::X, Vec3::Y, Vec3::Z];

impl Rule for CuboidRule {
    const BOTH_SIDES: bool = true;

    #[inline(always)]
    fn half(&self) -> Vec3 {
        self.half
    }

    #[inline(always)]
    fn lowest<Q: Quad>(&self, n: Vector3<Q>) -> Vector3<Q> {
        let h = splat::<Q>(self.half);
        Vector3::new(-h.x.copysign(n.x), -h.y.copysign(n.y), -h.z.copysign(n.z))
    }

    /// The code is 0 for the triangle's normal, 1 to 3 for the box's axes, 4 + 3 i + e for axis i with edge e. The normal
    /// follows from the code and the scale.
    #[inline(always)]
    fn axes<Q: Quad>(&self, near: &Near<Q>, _: [u8; 4], wanted: Q::Mask) -> Least<Q> {
        let [a, b, c] = near.corners;
        let v = [a.to_array(), b.to_array(), c.to_array()];
        let h = splat::<Q>(self.half).to_array();
        let mut best =
            Least { apart: !wanted, overlap: near.depth, normal: near.normal, code: Q::ZERO, scale: Q::ONE };
        for i in 0..3 {
            let low = v[0][i].lesser(v[1][i]).lesser(v[2][i]);
            let high = v[0][i].greater(v[1][i]).greater(v[2][i]);
            let (ahead, behind) = (high + h[i], h[i] - low);
            best.apart = best.apart | ahead.lt(Q::ZERO) | behind.lt(Q::ZERO);
            let overlap = ahead.lesser(behind);
            let better = overlap.lt(best.overlap);
            best.overlap = Q::select(better, overlap, best.overlap);
            best.code = Q::select(better, Q::from_f64((1 + i) as f64), best.code);
            best.scale = Q::select(better, Q::select(ahead.le(behind), Q::ONE, -Q::ONE), best.scale);
        }
        if !(!best.apart).any() {
            return best;
        }
        // Axis i × edge e has two components, and two of the triangle's corners are as far along it. What is compared is
        // squares: of axes that are better the length is needed, of others not.
        let (least, edge) = (Q::splat(f64::EPSILON), Q::splat(EDGE));
        for i in 0..3 {
            let (j, k) = ((i + 1) % 3, (i + 2) % 3);
            for e in 0..3 {
                let (a, b, third) = (&v[e], &v[(e + 1) % 3], &v[(e + 2) % 3]);
                let (x, y) = (-(b[k] - a[k]), b[j] - a[j]);
                let (p, q) = (x * a[j] + y * a[k], x * third[j] + y * third[k]);
                let reach = x.abs() * h[j] + y.abs() * h[k];
                let (ahead, behind) = (p.greater(q) + reach, reach - p.lesser(q));
                // A short axis says nothing.
                let square = x * x + y * y;
                let says = least.lt(square);
                let overlap = ahead.lesser(behind);
                best.apart = best.apart | (overlap.lt(Q::ZERO) & says);
                let dear = overlap * edge;
                let better = (dear * dear).lt(best.overlap * best.overlap * square) & says;
                if better.any() {
                    let inverse = Q::ONE / square.sqrt();
                    best.overlap = Q::select(better, overlap * inverse, best.overlap);
                    best.code = Q::select(better, Q::from_f64((4 + 3 * i + e) as f64), best.code);
                    let scale = Q::select(ahead.le(behind), inverse, -inverse);
                    best.scale = Q::select(better, scale, best.scale);
                }
            }
        }
        best
    }

    fn contacts(&self, near: &Near<f64>, least: &Least<f64>, found: &mut FacetContacts) {
        found.place = Place::Deepest;
        let code = least.code as usize;
        match code {
            0 => {
                found.normal = near.normal;
                self.face_below_triangle(near, found);
            }
            1..=3 => {
                let axis = AXES[code - 1];
                found.normal = if least.scale > 0.0 { axis } else { -axis };
                self.triangle_below_face(near, code - 1, found);
            }
            _ => {
                let (i, e) = ((code - 4) / 3 % 3, (code - 4) % 3);
                let (j, k) = ((i + 1) % 3, (i + 2) % 3);
                let edge = near.corners[(e + 1) % 3] - near.corners[e];
                found.normal = Vec3::ZERO;
                found.normal[j] = -edge[k] * least.scale;
                found.normal[k] = edge[j] * least.scale;
                self.edges(near, (i, e), least.overlap, found);
            }
        }
    }
}

impl CuboidRule {
    /// What of the box's face that looks at the triangle is over the triangle and below it.
    fn face_below_triangle(&self, near: &Near<f64>, found: &mut FacetContacts) {
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
    fn triangle_below_face(&self, near: &Near<f64>, i: usize, found: &mut FacetContacts) {
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
    fn edges(&self, near: &Near<f64>, (i, e): (usize, usize), overlap: f64, found: &mut FacetContacts) {
        let (v, n, h) = (&near.corners, found.normal, self.half);
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
        found.push(middle, overlap);
    }
}
