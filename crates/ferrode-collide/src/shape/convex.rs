use super::skeleton::Skeleton;
use super::{LARGEST, ShapeError, hull};
use crate::Frame;
use ferrode_math::{Aabb, Mat3, Vec3};
use std::sync::Arc;

/// A convex polyhedron. Copies share their data.
#[derive(Clone, Debug)]
pub struct Convex {
    data: Arc<Polyhedron>,
}

#[derive(Debug)]
struct Polyhedron {
    points: Vec<Vec3>,
    /// The same, four at a time by components; the last is repeated to fill up.
    blocks: Vec<[[f64; 4]; 3]>,
    faces: Vec<Face>,
    /// Corners of all faces, one after another.
    corners: Vec<u32>,
    volume: f64,
    middle: Vec3,
    /// Distance of the furthest corner from the local origin.
    reach: f64,
    /// The box around it along its own axes.
    bounds: Aabb,
    /// If it has few faces.
    skeleton: Option<Skeleton>,
}

/// A face of a polyhedron.
#[derive(Clone, Copy, Debug)]
struct Face {
    normal: Vec3,
    d: f64,
    start: u32,
    count: u32,
}

impl PartialEq for Convex {
    fn eq(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.data, &other.data)
            || (self.data.points == other.data.points && self.data.corners == other.data.corners)
    }
}

impl Convex {
    /// The convex hull of a cloud of points, which must not be flat. Points inside are left out; triangles in one plane
    /// become one face.
    pub fn from_points(points: &[Vec3]) -> Result<Self, ShapeError> {
        check_points(points)?;
        let hull = hull::hull(points)?;
        Self::from_faces(&hull.points, &hull.faces)
    }

    /// The polyhedron with the given corners and faces; each face lists its corners counter-clockwise as seen from
    /// outside (ODE's `dCreateConvex`). That it is convex is up to the caller.
    pub fn from_faces<F: AsRef<[u32]>>(points: &[Vec3], faces: &[F]) -> Result<Self, ShapeError> {
        check_points(points)?;
        let mut data = Polyhedron {
            points: points.to_vec(),
            blocks: points
                .chunks(4)
                .map(|p| [0, 1, 2].map(|k| [0, 1, 2, 3].map(|l| p[l.min(p.len() - 1)][k])))
                .collect(),
            faces: Vec::with_capacity(faces.len()),
            corners: Vec::new(),
            volume: 0.0,
            reach: points.iter().map(|p| p.length()).fold(0.0, f64::max),
            middle: points.iter().fold(Vec3::ZERO, |sum, &p| sum + p) / points.len() as f64,
            bounds: points.iter().fold(Aabb::EMPTY, |b, &p| b.union(&Aabb::new(p, p))),
            skeleton: None,
        };
        let center = data.middle;
        for face in faces {
            let face = face.as_ref();
            if face.len() < 3 {
                return Err(ShapeError {
                    what: "number of corners of a convex face",
                    value: face.len() as f64,
                });
            }
            if let Some(bad) = face.iter().find(|&&i| i as usize >= points.len()) {
                return Err(ShapeError { what: "corner number of a convex face", value: f64::from(*bad) });
            }
            // Newell's sum: right for faces with corners in line, and for slightly warped ones.
            let at = |k: usize| points[face[k % face.len()] as usize] - center;
            let area = (0..face.len()).fold(Vec3::ZERO, |sum, k| sum + at(k).cross(at(k + 1)));
            let Some(normal) = area.normalized() else {
                return Err(ShapeError { what: "area of a convex face", value: area.length() });
            };
            let d = (0..face.len()).map(|k| normal.dot(at(k))).sum::<f64>() / face.len() as f64;
            data.volume += area.length() * d / 6.0;
            data.faces.push(Face {
                normal,
                d: d + normal.dot(center),
                start: data.corners.len() as u32,
                count: face.len() as u32,
            });
            data.corners.extend_from_slice(face);
        }
        if faces.len() < 4 {
            return Err(ShapeError {
                what: "number of faces of a convex polyhedron",
                value: faces.len() as f64,
            });
        }
        let planes: Vec<_> = data.faces.iter().map(|f| (f.normal, f.d)).collect();
        data.skeleton = Skeleton::of(points, data.reach, &planes, |i| faces[i].as_ref());
        Ok(Self { data: Arc::new(data) })
    }

    /// Its axes, unless it has many, or is not closed and convex.
    #[inline]
    pub(crate) fn skeleton(&self) -> Option<&Skeleton> {
        self.data.skeleton.as_ref()
    }

    /// The corners.
    pub fn points(&self) -> &[Vec3] {
        &self.data.points
    }

    /// Number of faces.
    pub fn face_count(&self) -> usize {
        self.data.faces.len()
    }

    /// The corner numbers of face `i`, counter-clockwise as seen from outside.
    pub fn face(&self, i: usize) -> &[u32] {
        let f = &self.data.faces[i];
        &self.data.corners[f.start as usize..(f.start + f.count) as usize]
    }

    /// Outward unit normal of face `i`, and its distance from the origin.
    #[inline]
    pub fn face_plane(&self, i: usize) -> (Vec3, f64) {
        let f = &self.data.faces[i];
        (f.normal, f.d)
    }

    /// Volume in cubic metres.
    pub fn volume(&self) -> f64 {
        self.data.volume
    }

    /// The mean of the corners, a point within.
    pub fn middle(&self) -> Vec3 {
        self.data.middle
    }

    /// The corner furthest along `d`; of equals the first.
    #[inline]
    pub fn support(&self, d: Vec3) -> Vec3 {
        // Four corners at a time without a branch: which is furthest cannot be foretold.
        let mut most = [f64::NEG_INFINITY; 4];
        let mut place = [0u64; 4];
        for (i, [x, y, z]) in self.data.blocks.iter().enumerate() {
            for l in 0..4 {
                let along = d.x * x[l] + d.y * y[l] + d.z * z[l];
                let further = along > most[l];
                most[l] = if further { along } else { most[l] };
                place[l] = if further { i as u64 } else { place[l] };
            }
        }
        let mut best = 0;
        for l in 1..4 {
            if most[l] > most[best] || (most[l] == most[best] && place[l] < place[best]) {
                best = l;
            }
        }
        let [x, y, z] = &self.data.blocks[place[best] as usize];
        Vec3::new(x[best], y[best], z[best])
    }

    /// The corners four at a time, by components; the last is repeated to fill up.
    #[inline]
    pub(crate) fn blocks(&self) -> &[[[f64; 4]; 3]] {
        &self.data.blocks
    }

    /// The face whose normal is most along `d`.
    pub fn face_along(&self, d: Vec3) -> usize {
        let mut best = 0;
        let mut most = f64::NEG_INFINITY;
        for (i, f) in self.data.faces.iter().enumerate() {
            let along = f.normal.dot(d);
            if along > most {
                (best, most) = (i, along);
            }
        }
        best
    }

    /// Distance of the furthest corner from the local origin.
    #[inline]
    pub fn reach(&self) -> f64 {
        self.data.reach
    }

    /// The box around it along its own axes.
    #[inline]
    pub fn bounds(&self) -> &Aabb {
        &self.data.bounds
    }

    /// The world box around the polyhedron.
    pub fn aabb(&self, frame: &Frame) -> Aabb {
        let (low, high) = self.extent(&frame.rotation);
        Aabb::new(frame.position + low, frame.position + high)
    }

    /// The least and greatest coordinates of its corners when it is turned.
    #[inline]
    pub(crate) fn extent(&self, rotation: &Mat3) -> (Vec3, Vec3) {
        let (mut low, mut high) = ([[f64::INFINITY; 4]; 3], [[f64::NEG_INFINITY; 4]; 3]);
        for [x, y, z] in &self.data.blocks {
            for (i, r) in rotation.rows.iter().enumerate() {
                for l in 0..4 {
                    let p = r[0] * x[l] + r[1] * y[l] + r[2] * z[l];
                    low[i][l] = if p < low[i][l] { p } else { low[i][l] };
                    high[i][l] = if p > high[i][l] { p } else { high[i][l] };
                }
            }
        }
        let least = |[a, b, c, d]: [f64; 4]| a.min(b).min(c.min(d));
        let most = |[a, b, c, d]: [f64; 4]| a.max(b).max(c.max(d));
        (
            Vec3::new(least(low[0]), least(low[1]), least(low[2])),
            Vec3::new(most(high[0]), most(high[1]), most(high[2])),
        )
    }
}

fn check_points(points: &[Vec3]) -> Result<(), ShapeError> {
    if points.len() < 4 {
        return Err(ShapeError {
            what: "number of points of a convex polyhedron",
            value: points.len() as f64,
        });
    }
    match points.iter().find(|p| !(p.is_finite() && p.abs_max() <= LARGEST)) {
        Some(p) => Err(ShapeError { what: "coordinate of a convex polyhedron's point", value: p.abs_max() }),
        None => Ok(()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use ferrode_math::random::OdeRandom;

    #[test]
    fn hull_of_a_cube_with_points_inside_and_on_it() {
        let mut points = Vec::new();
        for i in 0..27u8 {
            let c = |k: u8| f64::from(i / k % 3) - 1.0;
            points.push(Vec3::new(c(1), c(3), c(9)));
        }
        let hull = Convex::from_points(&points).unwrap();
        assert_eq!((hull.points().len(), hull.face_count()), (8, 6));
        assert!((hull.volume() - 8.0).abs() < 1e-12);
        for i in 0..6 {
            let (n, d) = hull.face_plane(i);
            assert_eq!(hull.face(i).len(), 4);
            assert!((d - 1.0).abs() < 1e-12 && (n.abs_max() - 1.0).abs() < 1e-12);
        }
    }

    #[test]
    fn hulls_hold_all_their_points() {
        let mut random = OdeRandom::new(3);
        let mut number = || f64::from(random.next_u32()) / 4294967296.0 - 0.5;
        for n in [4, 5, 8, 20, 100, 500] {
            for round in 0..5 {
                let points: Vec<_> = (0..n)
                    .map(|_| {
                        let p = Vec3::new(number(), number(), number());
                        // Every second cloud on a sphere, where all points are corners.
                        if round % 2 == 0 { p } else { p.normalized().unwrap_or(Vec3::X) }
                    })
                    .collect();
                let hull = Convex::from_points(&points).unwrap();
                for p in &points {
                    for i in 0..hull.face_count() {
                        let (n, d) = hull.face_plane(i);
                        assert!(n.dot(*p) - d < 1e-9, "{n:?} {d} {p:?}");
                    }
                }
                if round % 2 == 1 {
                    assert_eq!(hull.points().len(), n);
                }
                // Closed: each edge is met once from either side (Euler).
                let edges: usize = (0..hull.face_count()).map(|i| hull.face(i).len()).sum::<usize>() / 2;
                assert_eq!(hull.points().len() + hull.face_count(), edges + 2);
            }
        }
    }

    #[test]
    fn flat_and_bad_clouds_are_errors() {
        let flat = [Vec3::ZERO, Vec3::X, Vec3::Y, Vec3::new(1.0, 1.0, 0.0), Vec3::new(0.3, 0.2, 0.0)];
        assert!(Convex::from_points(&flat).is_err());
        assert!(Convex::from_points(&[Vec3::ZERO; 6]).is_err());
        assert!(Convex::from_points(&flat[..3]).is_err());
        assert!(Convex::from_points(&[Vec3::X * f64::NAN; 4]).is_err());
        let mut points = vec![Vec3::ZERO, Vec3::X, Vec3::Y, Vec3::Z];
        points.push(Vec3::new(0.1, f64::NAN, 0.1));
        assert!(Convex::from_points(&points).is_err());
        assert!(Convex::from_faces(&flat, &[[0, 1, 9], [0, 1, 2], [0, 1, 3], [0, 2, 3]]).is_err());
    }
}
