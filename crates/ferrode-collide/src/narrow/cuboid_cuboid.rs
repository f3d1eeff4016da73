//! Box against box: separating axes, then clipping of the face that touches.

use super::closest_line_points;
use crate::{Contacts, Cuboid, Frame};
use core::f64::consts::PI;
use ferrode_math::{Vec3, real};

/// An edge axis must beat the best face axis by this factor, so that contacts keep to faces.
const EDGE_FACTOR: f64 = 1.05;

/// The axis along which two boxes overlap least.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BoxBox {
    /// Unit normal, from the first box to the second.
    pub normal: Vec3,
    /// Overlap along the normal, in metres.
    pub depth: f64,
    /// Which axis: 1…3 face of the first box, 4…6 of the second, 7 + 3 i + j edge i of the first × edge j of the
    /// second. ODE's code in `dBoxBox`.
    pub code: usize,
}

/// The two boxes as the separating axis test needs them.
struct Pair<'a> {
    f1: &'a Frame,
    f2: &'a Frame,
    half1: Vec3,
    half2: Vec3,
    /// From the first centre to the second, in either box's coordinates.
    between1: Vec3,
    between2: Vec3,
    /// r[i][j]: cosine between axis i of the first box and axis j of the second; and its absolute value.
    r: [[f64; 3]; 3],
    q: [[f64; 3]; 3],
}

impl<'a> Pair<'a> {
    fn new(a: &Cuboid, f1: &'a Frame, b: &Cuboid, f2: &'a Frame) -> Self {
        let between = f2.position - f1.position;
        let mut r = [[0.0; 3]; 3];
        let mut q = [[0.0; 3]; 3];
        for i in 0..3 {
            for j in 0..3 {
                r[i][j] = f1.axis(i).dot(f2.axis(j));
                q[i][j] = r[i][j].abs();
            }
        }
        Self {
            f1,
            f2,
            half1: a.half_sides(),
            half2: b.half_sides(),
            between1: f1.vector_to_local(between),
            between2: f2.vector_to_local(between),
            r,
            q,
        }
    }

    /// Signed distance of the centres and sum of the half extents along face axis `i` of the first box.
    fn face1(&self, i: usize) -> (f64, f64) {
        let q = &self.q[i];
        let h = self.half2;
        (self.between1[i], self.half1[i] + h.x * q[0] + h.y * q[1] + h.z * q[2])
    }

    /// The same along face axis `j` of the second box.
    fn face2(&self, j: usize) -> (f64, f64) {
        let q = &self.q;
        let h = self.half1;
        (self.between2[j], h.x * q[0][j] + h.y * q[1][j] + h.z * q[2][j] + self.half2[j])
    }

    /// The same along (edge i of the first) × (edge j of the second), unnormalised, and that axis in the first box.
    fn edges(&self, i: usize, j: usize) -> (f64, f64, Vec3) {
        let (i1, i2) = ((i + 1) % 3, (i + 2) % 3);
        let (j1, j2) = ((j + 1) % 3, (j + 2) % 3);
        let mut axis = Vec3::ZERO;
        axis[i1] = -self.r[i2][j];
        axis[i2] = self.r[i1][j];
        let distance = self.between1[i2] * self.r[i1][j] - self.between1[i1] * self.r[i2][j];
        let reach1 = self.half1[i1] * self.q[i2][j] + self.half1[i2] * self.q[i1][j];
        let reach2 = self.half2[j1] * self.q[i][j2] + self.half2[j2] * self.q[i][j1];
        (distance, reach1 + reach2, axis)
    }

    /// The axis of least overlap; `None` if one separates.
    fn least_overlap(&self) -> Option<BoxBox> {
        let mut best = f64::NEG_INFINITY;
        let mut normal = Vec3::ZERO;
        let mut code = 0;
        for i in 0..6 {
            let ((distance, reach), axis) = if i < 3 {
                (self.face1(i), self.f1.axis(i))
            } else {
                (self.face2(i - 3), self.f2.axis(i - 3))
            };
            let s = distance.abs() - reach;
            if !(s <= 0.0) {
                return None;
            }
            if s > best {
                best = s;
                normal = if distance < 0.0 { -axis } else { axis };
                code = i + 1;
            }
        }
        for i in 0..3 {
            for j in 0..3 {
                let (distance, reach, axis) = self.edges(i, j);
                let s = distance.abs() - reach;
                if s > 0.0 {
                    return None;
                }
                // Squares tell which is better; the length is needed only then. Of shorter axes, squares have lost digits.
                let square = axis.length_squared();
                let overlap = s * EDGE_FACTOR;
                if square > 1e-290 && overlap * overlap < best * best * square {
                    let length = square.sqrt();
                    best = s / length;
                    let axis = self.f1.vector_to_world(axis * (1.0 / length));
                    normal = if distance < 0.0 { -axis } else { axis };
                    code = 7 + 3 * i + j;
                }
            }
        }
        Some(BoxBox { normal, depth: -best, code })
    }

    /// The point midway between the two edges that touch.
    fn edge_contact(&self, hit: &BoxBox) -> Vec3 {
        let mut pa = self.f1.position;
        let mut pb = self.f2.position;
        for k in 0..3 {
            let (a, b) = (self.f1.axis(k), self.f2.axis(k));
            pa += if hit.normal.dot(a) > 0.0 { a * self.half1[k] } else { a * -self.half1[k] };
            pb -= if hit.normal.dot(b) > 0.0 { b * self.half2[k] } else { b * -self.half2[k] };
        }
        let (i, j) = ((hit.code - 7) / 3, (hit.code - 7) % 3);
        let (ua, ub) = (self.f1.axis(i), self.f2.axis(j));
        let (alpha, beta) = closest_line_points(pa, ua, pb, ub);
        ((pa + ua * alpha) + (pb + ub * beta)) * 0.5
    }

    /// The points of the incident face within the reference face; how many.
    fn face_contacts(&self, hit: &BoxBox, max: usize, out: &mut [(Vec3, f64); 8]) -> usize {
        let (fa, fb, ha, hb, normal, axis) = if hit.code <= 3 {
            (self.f1, self.f2, self.half1, self.half2, hit.normal, hit.code - 1)
        } else {
            (self.f2, self.f1, self.half2, self.half1, -hit.normal, hit.code - 4)
        };
        // The incident face: that of the other box most opposed to the normal.
        let nr = fb.vector_to_local(normal);
        let anr = nr.abs();
        let incident = if anr.y > anr.x {
            if anr.y > anr.z { 1 } else { 2 }
        } else if anr.x > anr.z {
            0
        } else {
            2
        };
        let others = |i: usize| match i {
            0 => (1, 2),
            1 => (0, 2),
            _ => (0, 1),
        };
        let ((a1, a2), (c1, c2)) = (others(incident), others(axis));
        let reach = if nr[incident] < 0.0 { hb[incident] } else { -hb[incident] };
        let center = fb.position - fa.position + fb.axis(incident) * reach;

        // Both faces in the plane of the reference face.
        let (x, y) = (fa.axis(c1), fa.axis(c2));
        let (u, v) = (fb.axis(a1), fb.axis(a2));
        let (cx, cy) = (center.dot(x), center.dot(y));
        let (m11, m12, m21, m22) = (x.dot(u), x.dot(v), y.dot(u), y.dot(v));
        let (k1, k2) = (m11 * hb[a1], m21 * hb[a1]);
        let (k3, k4) = (m12 * hb[a2], m22 * hb[a2]);
        let quad = [
            [cx - k1 - k3, cy - k2 - k4],
            [cx - k1 + k3, cy - k2 + k4],
            [cx + k1 + k3, cy + k2 + k4],
            [cx + k1 - k3, cy + k2 - k4],
        ];
        let mut clipped = [[0.0; 2]; 8];
        let n = clip_quad(quad, [ha[c1], ha[c2]], &mut clipped);

        // Lift each point back onto the incident face and keep those below the reference face.
        let det = m11 * m22 - m12 * m21;
        if n == 0 || det == 0.0 {
            return 0;
        }
        let scale = 1.0 / det;
        let (m11, m12, m21, m22) = (m11 * scale, m12 * scale, m21 * scale, m22 * scale);
        let mut flat = [[0.0; 2]; 8];
        let mut found = [(Vec3::ZERO, 0.0); 8];
        let mut count = 0;
        for p in &clipped[..n] {
            let (dx, dy) = (p[0] - cx, p[1] - cy);
            let point = center + u * (m22 * dx - m12 * dy) + v * (m11 * dy - m21 * dx);
            let depth = ha[axis] - normal.dot(point);
            if depth >= 0.0 {
                found[count] = (point + fa.position, depth);
                flat[count] = *p;
                count += 1;
            }
        }
        if count <= max {
            out[..count].copy_from_slice(&found[..count]);
            return count;
        }
        let mut deepest = 0;
        for i in 1..count {
            if found[i].1 > found[deepest].1 {
                deepest = i;
            }
        }
        let mut chosen = [0; 8];
        spread_points(&flat[..count], max, deepest, &mut chosen);
        for (slot, &i) in out.iter_mut().zip(&chosen[..max]) {
            *slot = found[i];
        }
        max
    }
}

/// Clips a quadrilateral to the rectangle |x| ≤ half[0], |y| ≤ half[1]; returns the number of corners (at most 8).
///
/// Sutherland and Hodgman's method, sides in the order −x, +x, −y, +y; a point on a side counts as outside and is
/// found again as a crossing.
fn clip_quad(quad: [[f64; 2]; 4], half: [f64; 2], out: &mut [[f64; 2]; 8]) -> usize {
    let mut current = [[0.0; 2]; 8];
    current[..4].copy_from_slice(&quad);
    let mut n = 4;
    for dim in 0..2 {
        for sign in [-1.0, 1.0] {
            let mut next = [[0.0; 2]; 8];
            let mut m = 0;
            for i in 0..n {
                let (p, q) = (current[i], current[(i + 1) % n]);
                let inside = |p: [f64; 2]| sign * p[dim] < half[dim];
                if inside(p) && m < 8 {
                    next[m] = p;
                    m += 1;
                }
                if inside(p) != inside(q) && m < 8 {
                    let other = 1 - dim;
                    let bound = sign * half[dim];
                    next[m][dim] = bound;
                    next[m][other] = p[other] + (q[other] - p[other]) / (q[dim] - p[dim]) * (bound - p[dim]);
                    m += 1;
                }
            }
            (current, n) = (next, m);
        }
    }
    *out = current;
    n
}

/// Chooses `m` corners of a polygon spread about its centroid: corner `first`, then for each k < m the unused one
/// nearest in angle to that of `first` + 2πk/m.
fn spread_points(points: &[[f64; 2]], m: usize, first: usize, chosen: &mut [usize; 8]) {
    let n = points.len();
    let center = match n {
        1 => points[0],
        2 => [0.5 * (points[0][0] + points[1][0]), 0.5 * (points[0][1] + points[1][1])],
        _ => {
            let (mut area, mut x, mut y) = (0.0, 0.0, 0.0);
            for i in 0..n {
                let (p, q) = (points[i], points[(i + 1) % n]);
                let cross = p[0] * q[1] - q[0] * p[1];
                area += cross;
                x += cross * (p[0] + q[0]);
                y += cross * (p[1] + q[1]);
            }
            let scale = if area.abs() > f64::EPSILON { 1.0 / (3.0 * area) } else { 1e18 };
            [x * scale, y * scale]
        }
    };
    let mut angles = [0.0; 8];
    for (angle, p) in angles.iter_mut().zip(points) {
        *angle = real::atan2(p[1] - center[1], p[0] - center[0]);
    }
    let mut used = [false; 8];
    used[first] = true;
    chosen[0] = first;
    for (k, slot) in chosen.iter_mut().enumerate().take(m).skip(1) {
        let mut target = k as f64 * (2.0 * PI / m as f64) + angles[first];
        if target > PI {
            target -= 2.0 * PI;
        }
        let mut least = f64::INFINITY;
        *slot = first;
        for i in 0..n {
            if !used[i] {
                let mut difference = (angles[i] - target).abs();
                if difference > PI {
                    difference = 2.0 * PI - difference;
                }
                if difference < least {
                    least = difference;
                    *slot = i;
                }
            }
        }
        used[*slot] = true;
    }
}

/// Two boxes: up to eight contacts, all with the normal of the axis of least overlap.
///
/// A face against anything gives the corners of the incident face clipped to the reference face, each with its own
/// depth; an edge against an edge the point midway. If fewer are wanted, the deepest and others spread round the
/// polygon. Returns the axis; `None` if the boxes are apart.
///
/// If contacts are unimportant, the first box's x axis is taken for the normal when it gives any, as in libode, which
/// then tests no other axis and so reports boxes that are apart; here all axes are tested.
pub fn cuboid_cuboid(
    a: &Cuboid,
    fa: &Frame,
    b: &Cuboid,
    fb: &Frame,
    out: &mut Contacts<'_>,
) -> Option<BoxBox> {
    let pair = Pair::new(a, fa, b, fb);
    let hit = pair.least_overlap()?;
    let mut points = [(Vec3::ZERO, 0.0); 8];
    let max = out.capacity().max(1);
    if out.options().unimportant {
        let (distance, reach) = pair.face1(0);
        let normal = if distance < 0.0 { -fa.axis(0) } else { fa.axis(0) };
        let first = BoxBox { normal, depth: reach - distance.abs(), code: 1 };
        let n = pair.face_contacts(&first, max, &mut points);
        if n > 0 {
            for &(p, depth) in &points[..n] {
                out.push(p, -normal, depth);
            }
            return Some(first);
        }
    }
    if hit.code >= 7 {
        out.push(pair.edge_contact(&hit), -hit.normal, hit.depth);
        return Some(hit);
    }
    let n = pair.face_contacts(&hit, max, &mut points);
    for &(p, depth) in &points[..n] {
        out.push(p, -hit.normal, depth);
    }
    Some(hit)
}

/// Whether two boxes touch: the fifteen-axis test alone (ODE's `dBoxTouchesBox`).
pub fn cuboids_touch(a: &Cuboid, fa: &Frame, b: &Cuboid, fb: &Frame) -> bool {
    Pair::new(a, fa, b, fb).least_overlap().is_some()
}
