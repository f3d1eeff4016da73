//! Two boxes: fifteen axes, then the incident face clipped to the reference rectangle.
//!
//! All in single precision in the coordinates of the first box, relative to its centre: what is lost is a ten-millionth
//! of the boxes' size. (Gottschalk, Lin and Manocha, *OBBTree*, 1996, for the axes; Sutherland and Hodgman, *Reentrant
//! polygon clipping*, 1974, against four sides that are parallel to coordinate axes.)

use super::{Axis, Favours, MANIFOLD_POINTS, Manifold, ManifoldPoint, Vec3f, turn};
use crate::{Cuboid, Frame};

pub(super) enum Answer {
    /// Further apart than the margin, by this.
    Apart(f32),
    Touch,
    /// Nearer than the margin along all axes, but no face reaches over the other.
    Unclear,
}

/// Axes with a squared sine below this are parallel: the faces say it all.
const PARALLEL: f32 = 1e-4;
/// By how much of the smaller size another axis must be better than a face, or than the last one.
const PREFER: f32 = 1e-3;
/// How much deeper than a product of edges the points over a face may be, as a part and of the smaller size, if their
/// normals are all but the same. Boxes that lie on each other a little askew are about as deep along such a product; its
/// one point would let them rock, and its normal turns with each step.
const FACE_PART: f32 = 0.05;
const FACE_LEAD: f32 = 1e-2;
/// Normals are all but the same from this cosine on: eight degrees.
const LEANING: f32 = 0.99;
/// Among overlapping faces the last one stays while no other is shallower by this part.
const LAST_FACE: f32 = 0.05;
/// Corners of a rectangle cut at four sides.
const CORNERS: usize = 8;

/// The first box: half sides; the second: half sides, its axes in the first one's coordinates, and its centre.
struct Pair {
    ha: [f32; 3],
    hb: [f32; 3],
    /// `r[i][j]`: axis i of A times axis j of B.
    r: [[f32; 3]; 3],
    t: [f32; 3],
}

const NEXT: [usize; 3] = [1, 2, 0];
const LAST: [usize; 3] = [2, 0, 1];

#[inline(always)]
fn pick(a: f32, b: f32) -> f32 {
    if a > b { a } else { b }
}

impl Pair {
    /// The gap along a face normal of A.
    #[inline(always)]
    fn face_a(&self, i: usize) -> f32 {
        let r = &self.r[i];
        let (ha, hb) = (&self.ha, &self.hb);
        self.t[i].abs() - ha[i] - (r[0].abs() * hb[0] + r[1].abs() * hb[1] + r[2].abs() * hb[2])
    }

    /// The centre of B along its own axis j.
    #[inline(always)]
    fn along_b(&self, j: usize) -> f32 {
        let (r, t) = (&self.r, &self.t);
        t[0] * r[0][j] + t[1] * r[1][j] + t[2] * r[2][j]
    }

    #[inline(always)]
    fn face_b(&self, j: usize) -> f32 {
        let (r, ha) = (&self.r, &self.ha);
        self.along_b(j).abs()
            - self.hb[j]
            - (r[0][j].abs() * ha[0] + r[1][j].abs() * ha[1] + r[2][j].abs() * ha[2])
    }

    /// The gap along a product of edges times the sine of their angle, and the square of that sine.
    #[inline(always)]
    fn edge(&self, i: usize, j: usize) -> (f32, f32) {
        let (r, t, ha, hb) = (&self.r, &self.t, &self.ha, &self.hb);
        let (i1, i2, j1, j2) = (NEXT[i], LAST[i], NEXT[j], LAST[j]);
        let d = (t[i2] * r[i1][j] - t[i1] * r[i2][j]).abs();
        let a = ha[i1] * r[i2][j].abs() + ha[i2] * r[i1][j].abs();
        let b = hb[j1] * r[i][j2].abs() + hb[j2] * r[i][j1].abs();
        (d - a - b, 1.0 - r[i][j] * r[i][j])
    }

    /// Whether a product of edges is all but the normal of a face.
    fn leans(&self, i: usize, j: usize, face: usize) -> bool {
        let r = &self.r;
        let (i1, i2) = (NEXT[i], LAST[i]);
        // Axis i of A times axis j of B, in A's coordinates.
        let mut n = [0.0f32; 3];
        n[i1] = -r[i2][j];
        n[i2] = r[i1][j];
        let along = if face < 3 {
            n[face]
        } else {
            n[0] * r[0][face - 3] + n[1] * r[1][face - 3] + n[2] * r[2][face - 3]
        };
        along * along > LEANING * LEANING * (n[0] * n[0] + n[1] * n[1] + n[2] * n[2])
    }

    /// The gap along an axis by its number: faces of A, faces of B, then nine products.
    #[inline(always)]
    fn gap(&self, axis: usize) -> f32 {
        match axis {
            0..3 => self.face_a(axis),
            3..6 => self.face_b(axis - 3),
            _ => {
                let (gap, square) = self.edge((axis - 6) / 3 % 3, (axis - 6) % 3);
                if square > PARALLEL { gap / square.sqrt() } else { f32::NEG_INFINITY }
            }
        }
    }
}

/// The manifold of two boxes; `axis` is what the last call left.
#[inline]
pub(super) fn boxes(
    a: &Cuboid,
    fa: &Frame,
    b: &Cuboid,
    fb: &Frame,
    margin: f32,
    axis: &mut Axis,
    out: &mut Manifold,
) -> Answer {
    let (ra, rb) = (&fa.rotation.rows, &fb.rotation.rows);
    let d = fb.position - fa.position;
    let d = [d.x as f32, d.y as f32, d.z as f32];
    let single = |m: &[[f64; 3]; 3]| m.map(|row| row.map(|x| x as f32));
    let (ma, mb) = (single(ra), single(rb));
    let half = |c: &Cuboid| {
        let h = c.half_sides();
        [h.x as f32, h.y as f32, h.z as f32]
    };
    let mut pair = Pair { ha: half(a), hb: half(b), r: [[0.0; 3]; 3], t: [0.0; 3] };
    #[allow(clippy::needless_range_loop)]
    for i in 0..3 {
        pair.t[i] = ma[0][i] * d[0] + ma[1][i] * d[1] + ma[2][i] * d[2];
        for j in 0..3 {
            pair.r[i][j] = ma[0][i] * mb[0][j] + ma[1][i] * mb[1][j] + ma[2][i] * mb[2][j];
        }
    }
    let last = usize::from(axis.number.wrapping_sub(1));
    if last < 15 {
        // Mostly what separated them still does.
        let gap = pair.gap(last);
        if gap > margin {
            return Answer::Apart(gap - margin);
        }
    }
    search(&pair, fa, fb, margin, axis, out)
}

/// The gap that an axis must be above to win over one with the gap `best`: a part of its depth, and a lead.
#[inline(always)]
fn bar(best: f32, part: f32, lead: f32) -> f32 {
    (if best < 0.0 { best * part } else { best }) + lead
}

fn search(pair: &Pair, fa: &Frame, fb: &Frame, margin: f32, axis: &mut Axis, out: &mut Manifold) -> Answer {
    let last = usize::from(axis.number.wrapping_sub(1));
    let least = |h: &[f32; 3]| {
        let m = if h[0] < h[1] { h[0] } else { h[1] };
        if m < h[2] { m } else { h[2] }
    };
    let (sa, sb) = (least(&pair.ha), least(&pair.hb));
    let prefer = PREFER * if sa < sb { sa } else { sb };
    // The best face; among near equals the last one, then the first.
    let first = if axis.favours == Favours::B { 3 } else { 0 };
    let mut best = (f32::NEG_INFINITY, first);
    for k in 0..6 {
        let k = if k + first < 6 { k + first } else { k + first - 6 };
        let gap = if k < 3 { pair.face_a(k) } else { pair.face_b(k - 3) };
        if gap > margin {
            axis.number = k as u8 + 1;
            return Answer::Apart(gap - margin);
        }
        // The last axis wins unless it is clearly worse.
        let wins = if k == last {
            gap > bar(best.0, 1.0 + LAST_FACE, -prefer)
        } else if best.1 == last {
            gap > bar(best.0, 1.0 - LAST_FACE, 2.0 * prefer)
        } else {
            gap > best.0 + prefer
        };
        if k == first || wins {
            best = (gap, k);
        }
    }
    let face = best;
    for i in 0..3 {
        for j in 0..3 {
            let (gap, square) = pair.edge(i, j);
            let k = 6 + 3 * i + j;
            // A gap over the sine is further from zero: below this it can neither separate nor win.
            let bar = if k == last { face.0 } else { best.0 + prefer };
            if gap <= bar && gap <= margin {
                continue;
            }
            if square <= PARALLEL {
                continue;
            }
            let gap = gap / square.sqrt();
            if gap > margin {
                axis.number = k as u8 + 1;
                return Answer::Apart(gap - margin);
            }
            if gap > bar && gap > best.0 - if k == last { prefer } else { 0.0 } {
                best = (gap, k);
            }
        }
    }
    let face_at = |k: usize, wanted: Wanted, out: &mut Manifold| match k {
        0..3 => face_contact::<true>(pair, k, wanted, margin, fa, fb, out),
        _ => face_contact::<false>(pair, k - 3, wanted, margin, fa, fb, out),
    };
    let (gap, k) = best;
    let slack = 1e-3 * (sa + sb);
    if k >= 6 && gap < 0.0 && pair.leans((k - 6) / 3, (k - 6) % 3, face.1) {
        // All but the face's normal: if what lies over the face is wide and no deeper, it holds better.
        let wanted = Wanted {
            points: 3,
            least: -gap - slack,
            most: -gap * (1.0 + FACE_PART) + FACE_LEAD * if sa < sb { sa } else { sb },
        };
        if let Answer::Touch = face_at(face.1, wanted, out) {
            axis.number = face.1 as u8 + 1;
            return Answer::Touch;
        }
    }
    axis.number = k as u8 + 1;
    if k < 6 {
        face_at(k, Wanted { points: 1, least: -gap - slack, most: f32::INFINITY }, out)
    } else {
        edge_contact(pair, (k - 6) / 3, (k - 6) % 3, gap, fa, fb, out)
    }
}

/// How many points there must be over a face at least, and between what the greatest depth must be.
#[derive(Clone, Copy)]
struct Wanted {
    points: usize,
    least: f32,
    most: f32,
}

/// A corner of the clipped face in the reference box's coordinates: over its plane at (u, v), and how deep; with the
/// numbers of the lines it lies between.
#[derive(Clone, Copy, Default)]
struct Corner {
    u: f32,
    v: f32,
    depth: f32,
    /// The line to the next corner.
    line: u8,
}

/// Clips to `sign · x ≤ half` for x = u or v.
#[inline(always)]
fn clip<const U: bool>(
    list: &[Corner; CORNERS],
    count: usize,
    sign: f32,
    half: f32,
    line: u8,
    kept: &mut [Corner; CORNERS],
) -> usize {
    let beyond = |c: &Corner| sign * if U { c.u } else { c.v } - half;
    let mut n = 0;
    let mut push = |c: Corner| {
        if n < CORNERS {
            kept[n] = c;
            n += 1;
        }
    };
    let mut here = beyond(&list[0]);
    for i in 0..count {
        let (c, next) = (&list[i], &list[if i + 1 == count { 0 } else { i + 1 }]);
        let there = beyond(next);
        if here <= 0.0 {
            push(*c);
        }
        if (here <= 0.0) != (there <= 0.0) {
            let s = here / (here - there);
            let between = |x: f32, y: f32| x + (y - x) * s;
            let mut cut = Corner {
                u: between(c.u, next.u),
                v: between(c.v, next.v),
                depth: between(c.depth, next.depth),
                // Going out, the next line is the side; coming in, the rest of this one.
                line: if here <= 0.0 { line } else { c.line },
            };
            if U {
                cut.u = sign * half;
            } else {
                cut.v = sign * half;
            }
            push(cut);
        }
        here = there;
    }
    n
}

#[inline(always)]
fn face_contact<const A: bool>(
    pair: &Pair,
    i: usize,
    wanted: Wanted,
    margin: f32,
    fa: &Frame,
    fb: &Frame,
    out: &mut Manifold,
) -> Answer {
    // The reference box and the other; `axis(k, j)`: reference axis k times the other's axis j.
    let (hr, ho) = if A { (&pair.ha, &pair.hb) } else { (&pair.hb, &pair.ha) };
    let axis = |k: usize, j: usize| if A { pair.r[k][j] } else { pair.r[j][k] };
    // The other's centre in the reference box's coordinates.
    let centre = |k: usize| if A { pair.t[k] } else { -pair.along_b(k) };
    let (iu, iv) = (NEXT[i], LAST[i]);
    let (cu, cv, cw) = (centre(iu), centre(iv), centre(i));
    // The face looks at the other.
    let side = if cw < 0.0 { -1.0f32 } else { 1.0 };
    // The other's face that looks back most.
    let w = [side * axis(i, 0), side * axis(i, 1), side * axis(i, 2)];
    let j = if w[0].abs() >= w[1].abs() && w[0].abs() >= w[2].abs() {
        0
    } else if w[1].abs() >= w[2].abs() {
        1
    } else {
        2
    };
    let (j1, j2) = (NEXT[j], LAST[j]);
    let back = if w[j] < 0.0 { ho[j] } else { -ho[j] };
    // Its centre and half edges, in (u, v, height over the reference face).
    let m = [cu + axis(iu, j) * back, cv + axis(iv, j) * back, side * cw - hr[i] + w[j] * back];
    let e = [axis(iu, j1) * ho[j1], axis(iv, j1) * ho[j1], w[j1] * ho[j1]];
    let f = [axis(iu, j2) * ho[j2], axis(iv, j2) * ho[j2], w[j2] * ho[j2]];
    let corner = |x: f32, y: f32, line: u8| Corner {
        u: m[0] + x * e[0] + y * f[0],
        v: m[1] + x * e[1] + y * f[1],
        depth: -(m[2] + x * e[2] + y * f[2]),
        line,
    };
    let mut list = [Corner::default(); CORNERS];
    // Lines 0 to 3 are the face's own edges, 4 to 7 the sides of the reference rectangle.
    list[0] = corner(-1.0, -1.0, 0);
    list[1] = corner(1.0, -1.0, 1);
    list[2] = corner(1.0, 1.0, 2);
    list[3] = corner(-1.0, 1.0, 3);
    let mut count = 4;
    let (hu, hv) = (hr[iu], hr[iv]);
    let (ru, rv) = (e[0].abs() + f[0].abs(), e[1].abs() + f[1].abs());
    let mut kept = [Corner::default(); CORNERS];
    // Most sides cut nothing when boxes are piled neatly.
    if m[0] + ru > hu {
        count = clip::<true>(&list, count, 1.0, hu, 4, &mut kept);
        list = kept;
    }
    if m[0] - ru < -hu && count > 0 {
        count = clip::<true>(&list, count, -1.0, hu, 5, &mut kept);
        list = kept;
    }
    if m[1] + rv > hv && count > 0 {
        count = clip::<false>(&list, count, 1.0, hv, 6, &mut kept);
        list = kept;
    }
    if m[1] - rv < -hv && count > 0 {
        count = clip::<false>(&list, count, -1.0, hv, 7, &mut kept);
        list = kept;
    }
    let (near, far) = (u32::from(!A) << 3 | (i as u32) << 1 | u32::from(side < 0.0), {
        (j as u32) << 1 | u32::from(w[j] < 0.0)
    });
    // Names of the corners, and those near enough.
    let mut names = [0u32; CORNERS];
    let mut n = 0;
    let mut before = if count > 0 { list[count - 1].line } else { 0 };
    let mut deepest = f32::NEG_INFINITY;
    for c in 0..count {
        let corner = list[c];
        let (x, y) = if before < corner.line { (before, corner.line) } else { (corner.line, before) };
        before = corner.line;
        if corner.depth >= -margin {
            names[n] = 1 << 16 | near << 12 | far << 8 | u32::from(x) << 4 | u32::from(y);
            list[n] = corner;
            deepest = pick(deepest, corner.depth);
            n += 1;
        }
    }
    // Apart, and what is nearest is not over the face: the axes do not tell the distance. Overlapping, it is rounding.
    let size = hu + hv;
    if n < wanted.points || deepest < wanted.least || deepest > wanted.most {
        return Answer::Unclear;
    }
    let mut chosen = [0, 1, 2, 3];
    if n > MANIFOLD_POINTS {
        n = choose(&list[..n], &names, deepest, out, &mut chosen);
    }
    let old = *out;
    // Into A: against A's own face, along B's.
    let local_side = if A { -side } else { side };
    let mut local = Vec3f::ZERO;
    local[i] = local_side;
    let rotation = if A { &fa.rotation } else { &fb.rotation };
    out.origin_b = ferrode_math::Vec3::ZERO;
    out.normal = turn(rotation, local);
    out.local_normal = local;
    out.normal_of_a = A;
    out.count = n as u8;
    for (p, &c) in out.points.iter_mut().zip(&chosen[..n]) {
        let corner = list[c];
        let mut on_face = Vec3f::ZERO;
        on_face[iu] = corner.u;
        on_face[iv] = corner.v;
        on_face[i] = side * hr[i];
        let mut other = on_face;
        other[i] -= side * corner.depth;
        // Into the other's coordinates.
        let x = [other.x - centre(0), other.y - centre(1), other.z - centre(2)];
        let local = |k: usize| x[0] * axis(0, k) + x[1] * axis(1, k) + x[2] * axis(2, k);
        let other = Vec3f::new(local(0), local(1), local(2));
        let (anchor_a, anchor_b) = if A { (on_face, other) } else { (other, on_face) };
        *p = ManifoldPoint { anchor_a, anchor_b, depth: corner.depth, feature: names[c], impulse: [0.0; 3] };
    }
    if old.count > 0 {
        out.inherit(&old, 0.1 * size);
    }
    Answer::Touch
}

/// The number below `count` with the greatest measure, and that.
#[inline(always)]
fn best(count: usize, measure: impl Fn(usize) -> f32) -> (usize, f32) {
    let mut best = (0, f32::NEG_INFINITY);
    for i in 0..count {
        let m = measure(i);
        if m > best.1 {
            best = (i, m);
        }
    }
    best
}

/// As for all patches: the deepest, the furthest from it, the widest on either side; known ones stay.
#[inline(never)]
fn choose(
    list: &[Corner],
    names: &[u32; CORNERS],
    deepest: f32,
    old: &Manifold,
    chosen: &mut [usize; MANIFOLD_POINTS],
) -> usize {
    let mut known = [1.0f32; CORNERS];
    let (mut lo, mut hi) = (list[0].u, list[0].u);
    for (i, c) in list.iter().enumerate() {
        if old.points().iter().any(|p| p.feature == names[i]) {
            known[i] = 1.2;
        }
        lo = if c.u < lo { c.u } else { lo };
        hi = if c.u > hi { c.u } else { hi };
    }
    let same = 1e-5 * (hi - lo);
    let first =
        best(list.len(), |i| if list[i].depth >= deepest - same { known[i] } else { f32::NEG_INFINITY }).0;
    let from = |i: usize| (list[i].u - list[first].u, list[i].v - list[first].v);
    let second = best(list.len(), |i| {
        let (u, v) = from(i);
        (u * u + v * v) * known[i]
    })
    .0;
    (chosen[0], chosen[1]) = (first, second);
    let (su, sv) = from(second);
    let enough = 1e-6 * (su * su + sv * sv);
    let mut n = 2;
    for side in [1.0f32, -1.0] {
        let (i, area) = best(list.len(), |i| {
            let (u, v) = from(i);
            side * (su * v - sv * u) * known[i]
        });
        if area > enough && !chosen[..n].contains(&i) {
            chosen[n] = i;
            n += 1;
        }
    }
    n
}

/// Two edges that cross: one point.
fn edge_contact(
    pair: &Pair,
    i: usize,
    j: usize,
    gap: f32,
    fa: &Frame,
    fb: &Frame,
    out: &mut Manifold,
) -> Answer {
    let r = &pair.r;
    let t = Vec3f::from_array(pair.t);
    let mut ua = Vec3f::ZERO;
    ua[i] = 1.0;
    let column = |k: usize| Vec3f::new(r[0][k], r[1][k], r[2][k]);
    let ub = column(j);
    let cross = ua.cross(ub);
    let mut n = cross * (1.0 / cross.length());
    // Into A: away from B's centre.
    if n.dot(t) > 0.0 {
        n = -n;
    }
    // The middles of the edges that face each other.
    let (mut pa, mut pb) = (Vec3f::ZERO, t);
    let mut names = [0u32; 2];
    for k in [NEXT[i], LAST[i]] {
        let positive = n[k] < 0.0;
        pa[k] = if positive { pair.ha[k] } else { -pair.ha[k] };
        names[0] = names[0] << 1 | u32::from(positive);
    }
    for k in [NEXT[j], LAST[j]] {
        let positive = n.dot(column(k)) > 0.0;
        pb += column(k) * if positive { pair.hb[k] } else { -pair.hb[k] };
        names[1] = names[1] << 1 | u32::from(positive);
    }
    // The nearest points of the two lines.
    let c = ua.dot(ub);
    let between = pb - pa;
    let (da, db) = (ua.dot(between), ub.dot(between));
    let scale = 1.0 / (1.0 - c * c);
    let (x, y) = ((da - c * db) * scale, (c * da - db) * scale);
    let (ha, hb) = (pair.ha[i], pair.hb[j]);
    let slack = 1e-3 * (ha + hb);
    if x.abs() > ha + slack || y.abs() > hb + slack {
        return Answer::Unclear;
    }
    let (pa, pb) = (pa + ua * x, pb + ub * y);
    let old = *out;
    let d = pb - t;
    let local = Vec3f::new(column(0).dot(d), column(1).dot(d), column(2).dot(d));
    out.origin_b = ferrode_math::Vec3::ZERO;
    out.normal = turn(&fa.rotation, n);
    // Both edges turn it; when they are level it turns with B.
    out.local_normal = super::back(&fb.rotation, out.normal);
    out.normal_of_a = false;
    out.count = 1;
    let feature = 2 << 16 | (i as u32) << 12 | (j as u32) << 8 | names[0] << 4 | names[1];
    out.points[0] = ManifoldPoint { anchor_a: pa, anchor_b: local, depth: -gap, feature, impulse: [0.0; 3] };
    if old.count > 0 {
        out.inherit(&old, 0.1 * (ha + hb));
    }
    Answer::Touch
}
