//! Which of the triangles near a body are worth a closer look, four at a time.

use crate::{Frame, TriMesh};
use ferrode_math::simd::{Mask, Ordered, Quad, QuadKernel, dispatch_quads};
use ferrode_math::{Aabb, Matrix3, Vec3, Vector3};

/// Numbers of triangles: a few in place, as most searches find, and any number behind.
pub(super) struct Numbers {
    first: [u32; Self::FIRST],
    count: usize,
    /// In whole fours, of which `behind` count.
    more: Vec<u32>,
    behind: usize,
}

impl Numbers {
    const FIRST: usize = 68;

    /// The triangles whose boxes overlap `around`, and a few beside these, in the order of the mesh's tree.
    #[inline]
    pub fn near(mesh: &TriMesh, around: &Aabb) -> Self {
        let mut found = Self::NONE;
        found.find(mesh, around);
        found
    }

    /// None yet.
    pub const NONE: Self = Self { first: [0; Self::FIRST], count: 0, more: Vec::new(), behind: 0 };

    /// Fills what holds none as [`near`](Self::near) does.
    #[inline(never)]
    pub fn find(&mut self, mesh: &TriMesh, around: &Aabb) {
        let Self { first, count, more, .. } = self;
        mesh.tree().query_leaves(around, |leaf, members| {
            if let Some(place) = first.get_mut(*count..).and_then(<[u32]>::first_chunk_mut) {
                *place = *leaf;
                *count += members;
            } else {
                more.extend(&leaf[..members]);
            }
        });
        self.behind = self.more.len();
        self.more.resize(self.behind.next_multiple_of(4), 0);
    }

    /// All of them, one by one.
    pub fn each(&self) -> impl Iterator<Item = u32> {
        self.first[..self.count].iter().chain(&self.more[..self.behind]).copied()
    }

    /// Four at a time, of which the first few count, and how many these are. The others are triangles of the mesh too. By
    /// reference: reading four at once what was just written in other portions would make the processor wait.
    #[inline(always)]
    pub fn fours(&self) -> impl Iterator<Item = (&[u32; 4], usize)> {
        let part = |of: &'_ [u32], count: usize| (count.div_ceil(4).min(of.len() / 4), count);
        let ((first, count), (more, behind)) = (part(&self.first, self.count), part(&self.more, self.behind));
        let first = self.first.as_chunks().0[..first].iter().enumerate();
        let more = self.more.as_chunks().0[..more].iter().enumerate();
        first
            .map(move |(k, four)| (four, (count - 4 * k).min(4)))
            .chain(more.map(move |(k, four)| (four, (behind - 4 * k).min(4))))
    }
}

/// A box around a body, in the mesh's coordinates.
pub(super) struct Sieve<'a> {
    pub mesh: &'a TriMesh,
    /// Where its middle is, and its axes.
    frame: Frame,
    half: Vec3,
    /// More than rounding, in metres.
    slack: f64,
    /// Whether triangles that do not face the box's middle count too.
    both_sides: bool,
}

/// A triangle, or one in each lane, in the coordinates of the box.
#[derive(Clone, Copy)]
pub(super) struct Sieved<T: Ordered> {
    pub normal: Vector3<T>,
    pub corners: [Vector3<T>; 3],
    /// Of the box's middle over the triangle's plane.
    pub height: T,
    /// Whether it stays in the sieve.
    pub stays: T::Mask,
    /// Whether the triangle meets the box, as far as the box's own axes tell.
    pub meets_box: T::Mask,
}

/// The same vector in every lane.
#[inline(always)]
pub(super) fn splat<Q: Quad>(v: Vec3) -> Vector3<Q> {
    Vector3::new(Q::splat(v.x), Q::splat(v.y), Q::splat(v.z))
}

/// A vector in each lane.
#[inline(always)]
fn lanes<Q: Quad>(a: &[f64; 4], b: &[f64; 4], c: &[f64; 4], d: &[f64; 4]) -> Vector3<Q> {
    let [x, y, z, _] = Q::columns([Q::load(a), Q::load(b), Q::load(c), Q::load(d)]);
    Vector3::new(x, y, z)
}

impl<'a> Sieve<'a> {
    pub fn new(mesh: &'a TriMesh, frame: Frame, half: Vec3, both_sides: bool) -> Self {
        Self { mesh, frame, half, slack: 1e-9 * (half.x + half.y + half.z), both_sides }
    }

    /// Looks at four triangles. One stays if it faces the middle, the box reaches its plane, and it meets the box or is beside
    /// it but perhaps over its lowest point.
    #[inline(always)]
    pub fn sift<Q: Quad>(&self, of: &[u32; 4]) -> Sieved<Q> {
        let (at, half, slack) =
            (splat::<Q>(self.frame.position), splat::<Q>(self.half), Q::splat(self.slack));
        let (mesh, r) = (self.mesh, &self.frame.rotation.rows);
        let (i, j) = (mesh.padded(of[0]), mesh.padded(of[1]));
        let (k, l) = (mesh.padded(of[2]), mesh.padded(of[3]));
        let normal = lanes::<Q>(&i.normal, &j.normal, &k.normal, &l.normal);
        let corner = [
            lanes::<Q>(&i.corners[0], &j.corners[0], &k.corners[0], &l.corners[0]) - at,
            lanes::<Q>(&i.corners[1], &j.corners[1], &k.corners[1], &l.corners[1]) - at,
            lanes::<Q>(&i.corners[2], &j.corners[2], &k.corners[2], &l.corners[2]) - at,
        ];
        let height = -normal.dot(corner[0]);
        let axes = Matrix3 {
            rows: [
                [Q::splat(r[0][0]), Q::splat(r[0][1]), Q::splat(r[0][2])],
                [Q::splat(r[1][0]), Q::splat(r[1][1]), Q::splat(r[1][2])],
                [Q::splat(r[2][0]), Q::splat(r[2][1]), Q::splat(r[2][2])],
            ],
        };
        let normal = axes.transpose_mul(normal);
        let steep = Vector3::new(normal.x.abs(), normal.y.abs(), normal.z.abs());
        let depth = steep.dot(half) + slack - height;
        let corners =
            [axes.transpose_mul(corner[0]), axes.transpose_mul(corner[1]), axes.transpose_mul(corner[2])];
        let [p, q, s] = &corners;
        // The body's lowest point may be below a triangle beside the box. It is not deeper than the box is, and the gap
        // along an axis is no wider than what a move up the normal bridges.
        let (x, y, z) = (gap(p.x, q.x, s.x, half.x), gap(p.y, q.y, s.y, half.y), gap(p.z, q.z, s.z, half.z));
        let beside = (depth * steep.x + slack).lt(x)
            | (depth * steep.y + slack).lt(y)
            | (depth * steep.z + slack).lt(z);
        let mut stays = Q::ZERO.le(depth) & !beside;
        if !self.both_sides {
            stays = stays & !height.lt(Q::ZERO);
        }
        let widest = x.greater(y).greater(z);
        Sieved { normal, corners, height, stays, meets_box: widest.le(Q::ZERO) }
    }

    /// Calls `found` with each triangle that stays, and whether it meets the box as far as the box's own axes tell.
    pub fn each(&self, of: &Numbers, found: impl FnMut(u32, bool)) {
        dispatch_quads(Each { sieve: self, of, found });
    }
}

/// How far three numbers are beyond −half and half.
#[inline(always)]
fn gap<Q: Quad>(p: Q, q: Q, r: Q, half: Q) -> Q {
    let (low, high) = (p.lesser(q).lesser(r), p.greater(q).greater(r));
    (low - half).greater(-high - half)
}

struct Each<'a, F> {
    sieve: &'a Sieve<'a>,
    of: &'a Numbers,
    found: F,
}

impl<F: FnMut(u32, bool)> QuadKernel for Each<'_, F> {
    type Out = ();

    #[inline(always)]
    fn run<Q: Quad>(mut self) {
        for (four, count) in self.of.fours() {
            let near = self.sieve.sift::<Q>(four);
            if !near.stays.any() {
                continue;
            }
            let (stays, meets) = (Q::bits(near.stays), Q::bits(near.meets_box));
            for (l, &i) in four.iter().enumerate().take(count) {
                if stays >> l & 1 != 0 {
                    (self.found)(i, meets >> l & 1 != 0);
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_those_of_the_tree_in_its_order() {
        // A strip of triangles along x, of which a box sees none, few, or more than there is room for in place.
        let vertices = (0..203).map(|i| Vec3::new(f64::from(i), f64::from(i % 2), 0.0)).collect();
        let mesh = TriMesh::new(vertices, (0..201).map(|i| [i, i + 1, i + 2]).collect()).unwrap();
        let mut most = 0;
        for length in [-1.0, 0.5, 5.0, 40.0, 68.0, 69.0, 90.0, 300.0] {
            let around = Aabb::new(Vec3::new(-0.5, 0.0, -1.0), Vec3::new(length - 0.5, 1.0, 1.0));
            let mut expected = Vec::new();
            mesh.tree().query(&around, |i| expected.push(i));
            most = most.max(expected.len());
            let numbers = Numbers::near(&mesh, &around);
            assert_eq!(numbers.each().collect::<Vec<_>>(), expected);
            let fours = numbers.fours().flat_map(|(four, count)| four.iter().copied().take(count));
            assert_eq!(fours.collect::<Vec<_>>(), expected);
            assert!(numbers.fours().all(|(four, _)| four.iter().all(|i| *i < 201)));
        }
        assert!(most > 2 * Numbers::FIRST);
    }

    /// What the sieve keeps of four triangles, and which of them meet the box.
    struct Sifted<'a>(&'a Sieve<'a>, [u32; 4]);

    impl QuadKernel for Sifted<'_> {
        type Out = (u8, u8);

        #[inline(always)]
        fn run<Q: Quad>(self) -> (u8, u8) {
            let near = self.0.sift::<Q>(&self.1);
            (Q::bits(near.stays), Q::bits(near.meets_box))
        }
    }

    #[test]
    fn what_faces_the_middle_and_meets_the_box_stays() {
        let triangle = |x: f64, z: f64, turned: bool| {
            let [a, b, c] = [Vec3::new(x, 0.0, z), Vec3::new(x + 1.0, 0.0, z), Vec3::new(x, 1.0, z)];
            if turned { [a, c, b] } else { [a, b, c] }
        };
        // Below the middle; the same from behind; beside the box; below it.
        let soup = [
            triangle(-0.3, -0.5, false),
            triangle(-0.3, -0.5, true),
            triangle(3.0, -0.5, false),
            triangle(-0.3, -1.1, false),
        ];
        let mesh = TriMesh::from_triangles(&soup).unwrap();
        let half = Vec3::splat(1.0);
        let sieve = |both_sides| Sieve::new(&mesh, Frame::IDENTITY, half, both_sides);
        let (stays, meets) = dispatch_quads(Sifted(&sieve(false), [0, 1, 2, 3]));
        assert_eq!(stays, 0b0001);
        assert_eq!(meets, 0b0011);
        assert_eq!(dispatch_quads(Sifted(&sieve(true), [0, 1, 2, 3])).0, 0b0011);
        assert_eq!(dispatch_quads(Sifted(&sieve(true), [3, 2, 1, 0])).0, 0b1100);
    }
}
