//! Faces and edges of a polyhedron, laid out for separating axes.

use ferrode_math::Vec3;

/// Most faces that are worth trying one by one: beyond that, searches by support points are quicker.
pub(crate) const MOST_FACES: usize = 64;
/// Part of the polyhedron's size that a corner may be above a face.
const FLAT: f64 = 1e-9;

/// What axes a polyhedron has.
#[derive(Debug)]
pub(crate) struct Skeleton {
    /// Four faces at a time: the components of their outward normals, and their distances from the origin. The last is repeated
    /// to fill up.
    pub blocks: Vec<[[f64; 4]; 4]>,
    /// The normals again.
    pub normals: Vec<Vec3>,
    pub edges: Vec<Ridge>,
}

/// An edge of a polyhedron.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Ridge {
    /// One end.
    pub start: Vec3,
    /// To the other.
    pub along: Vec3,
    /// The numbers of the faces on its two sides.
    pub faces: [u8; 2],
}

impl Skeleton {
    /// Of the polyhedron with these corners, faces, and face planes; `None` if it has many, or is not closed and convex.
    pub fn of<'a>(
        points: &[Vec3],
        reach: f64,
        planes: &[(Vec3, f64)],
        face: impl Fn(usize) -> &'a [u32],
    ) -> Option<Self> {
        if planes.len() > MOST_FACES {
            return None;
        }
        let above = |&(n, d): &(Vec3, f64)| points.iter().any(|p| n.dot(*p) - d > FLAT * reach);
        if planes.iter().any(above) {
            return None;
        }
        // Each edge is walked once in either direction.
        let mut walks: Vec<(u32, u32, u8, bool)> = Vec::new();
        for i in 0..planes.len() {
            let corners = face(i);
            for (k, &p) in corners.iter().enumerate() {
                let q = corners[(k + 1) % corners.len()];
                walks.push((p.min(q), p.max(q), i as u8, p < q));
            }
        }
        walks.sort_unstable();
        let mut edges = Vec::with_capacity(walks.len() / 2);
        let (pairs, rest) = walks.as_chunks::<2>();
        for &[a, b] in pairs {
            if (a.0, a.1) != (b.0, b.1) || a.3 == b.3 || a.0 == a.1 {
                return None;
            }
            let (start, end) = (points[a.0 as usize], points[a.1 as usize]);
            edges.push(Ridge { start, along: end - start, faces: [a.2, b.2] });
        }
        // Three at one edge would be pairs in step with a neighbour's.
        let twice = pairs.windows(2).any(|w| (w[0][0].0, w[0][0].1) == (w[1][0].0, w[1][0].1));
        if !rest.is_empty() || twice {
            return None;
        }
        let blocks = planes
            .chunks(4)
            .map(|p| {
                let at = |l: usize| p[l.min(p.len() - 1)];
                let lanes = [0, 1, 2, 3].map(at);
                [lanes.map(|f| f.0.x), lanes.map(|f| f.0.y), lanes.map(|f| f.0.z), lanes.map(|f| f.1)]
            })
            .collect();
        Some(Self { blocks, normals: planes.iter().map(|f| f.0).collect(), edges })
    }
}
