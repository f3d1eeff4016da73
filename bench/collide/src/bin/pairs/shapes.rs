//! The shapes of the pair bench: four sizes of each class.

use ferrode_collide::{
    Capsule, Cone, Convex, Cuboid, Cylinder, Ellipsoid, Heightfield, Plane, Ray, Shape, Sphere, TriMesh,
};
use ferrode_math::Vec3;
use std::error::Error;

/// Sizes of each class.
pub const SIZES: usize = 4;
/// Side of the square that surfaces cover, in metres.
pub const SIDE: f64 = 8.0;
/// Cells of a surface along each side.
const CELLS: u32 = 16;

/// A class of geoms.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Class {
    /// A ray of two metres.
    Ray,
    /// A ball.
    Sphere,
    /// A box.
    Box,
    /// A capsule.
    Capsule,
    /// A cylinder.
    Cylinder,
    /// Tetrahedron, wedge, icosahedron and a hull of 24 points.
    Convex,
    /// An ellipsoid, which libode has not.
    Ellipsoid,
    /// A cone, which libode has not.
    Cone,
    /// A closed mesh of the size of the other bodies, or, if the other geom is a body, hills.
    Trimesh,
    /// Hills.
    Heightfield,
    /// A half-space.
    Plane,
}

impl Class {
    /// All, in the order of a pair's geoms: what the other can be laid on comes last.
    pub const ALL: [Self; 11] = [
        Self::Ray,
        Self::Sphere,
        Self::Box,
        Self::Capsule,
        Self::Cylinder,
        Self::Convex,
        Self::Ellipsoid,
        Self::Cone,
        Self::Trimesh,
        Self::Heightfield,
        Self::Plane,
    ];

    /// Its name in tables.
    pub fn name(self) -> &'static str {
        match self {
            Self::Ray => "ray",
            Self::Sphere => "sphere",
            Self::Box => "box",
            Self::Capsule => "capsule",
            Self::Cylinder => "cylinder",
            Self::Convex => "convex",
            Self::Ellipsoid => "ellipsoid",
            Self::Cone => "cone",
            Self::Trimesh => "trimesh",
            Self::Heightfield => "heightfield",
            Self::Plane => "plane",
        }
    }

    /// Whether geoms of this class are what others lie on.
    pub fn is_ground(self) -> bool {
        matches!(self, Self::Trimesh | Self::Heightfield | Self::Plane)
    }
}

/// Height of the hills.
pub fn height(x: f64, y: f64) -> f64 {
    0.25 * (1.3 * x).sin() + 0.2 * (1.7 * y + 0.5).cos()
}

/// The sizes of a class; `ground` is for meshes that others lie on.
pub fn sizes(class: Class, ground: bool) -> Result<Vec<Shape>, Box<dyn Error>> {
    (0..SIZES).map(|i| size(class, ground, i)).collect()
}

fn size(class: Class, ground: bool, i: usize) -> Result<Shape, Box<dyn Error>> {
    let s = [0.3, 0.4, 0.5, 0.6][i];
    Ok(match class {
        Class::Ray => Ray::new(2.0)?.into(),
        Class::Sphere => Sphere::new(s)?.into(),
        Class::Box => Cuboid::new(Vec3::new(1.6 * s, s, 0.9))?.into(),
        Class::Capsule => Capsule::new(0.6 * s, 0.8)?.into(),
        Class::Cylinder => Cylinder::new(s, [1.0, 0.4, 0.8, 0.5][i])?.into(),
        Class::Convex => convex(i)?.into(),
        Class::Ellipsoid => Ellipsoid::new(Vec3::new(s, 0.4, 0.6 * s))?.into(),
        Class::Cone => Cone::new(s, 0.9)?.into(),
        Class::Trimesh if ground => hills()?.into(),
        Class::Trimesh => pebble(s)?.into(),
        Class::Heightfield => {
            let n = CELLS as usize + 1;
            let cell = SIDE / f64::from(CELLS);
            // Rows run along the field's z, which is the world's −y once it is turned up.
            let at = |k: usize| (k % n, k / n);
            let heights = (0..n * n)
                .map(|k| height(at(k).0 as f64 * cell - 0.5 * SIDE, 0.5 * SIDE - at(k).1 as f64 * cell))
                .collect();
            Heightfield::new(SIDE, SIDE, n, n, heights, 1.0)?.into()
        }
        Class::Plane => {
            let tilt =
                [Vec3::Z, Vec3::new(0.1, 0.0, 1.0), Vec3::new(0.2, -0.3, 1.0), Vec3::new(-0.5, 0.4, 1.0)];
            Plane::new(tilt[i], 0.05 * i as f64)?.into()
        }
    })
}

fn convex(i: usize) -> Result<Convex, Box<dyn Error>> {
    let golden = 0.5 * (1.0 + 5.0f64.sqrt());
    let mut points = Vec::new();
    match i {
        0 => points.extend([
            Vec3::new(0.4, 0.4, 0.4),
            Vec3::new(0.4, -0.4, -0.4),
            Vec3::new(-0.4, 0.4, -0.4),
            Vec3::new(-0.4, -0.4, 0.4),
        ]),
        1 => {
            for x in [-0.4, 0.4] {
                points.extend([Vec3::new(x, -0.3, -0.3), Vec3::new(x, 0.5, -0.3), Vec3::new(x, -0.3, 0.4)]);
            }
        }
        2 => {
            for s in [-1.0, 1.0] {
                for t in [-golden, golden] {
                    points.extend([Vec3::new(0.0, s, t), Vec3::new(s, t, 0.0), Vec3::new(t, 0.0, s)]);
                }
            }
            points.iter_mut().for_each(|p| *p *= 0.25);
        }
        _ => {
            // Evenly over a ball, by the golden angle.
            for k in 0..24 {
                let z = 1.0 - (2.0 * f64::from(k) + 1.0) / 24.0;
                let (r, angle) = ((1.0 - z * z).sqrt(), f64::from(k) * 2.399963);
                points.push(Vec3::new(0.5 * r * angle.cos(), 0.4 * r * angle.sin(), 0.5 * z));
            }
        }
    }
    Ok(Convex::from_points(&points)?)
}

/// The hills as a mesh of 512 triangles.
fn hills() -> Result<TriMesh, Box<dyn Error>> {
    let cell = SIDE / f64::from(CELLS);
    let mut vertices = Vec::new();
    for i in 0..=CELLS {
        for j in 0..=CELLS {
            let (x, y) = (f64::from(i) * cell - 0.5 * SIDE, f64::from(j) * cell - 0.5 * SIDE);
            vertices.push(Vec3::new(x, y, height(x, y)));
        }
    }
    let mut triangles = Vec::new();
    for i in 0..CELLS {
        for j in 0..CELLS {
            let a = i * (CELLS + 1) + j;
            let (b, c, d) = (a + 1, a + CELLS + 1, a + CELLS + 2);
            triangles.extend([[a, c, b], [b, c, d]]);
        }
    }
    Ok(TriMesh::new(vertices, triangles)?)
}

/// A bumpy ball of 320 triangles: an icosahedron divided twice.
fn pebble(radius: f64) -> Result<TriMesh, Box<dyn Error>> {
    let base = convex(2)?;
    let mut points: Vec<Vec3> = base.points().to_vec();
    let mut triangles: Vec<[u32; 3]> =
        (0..base.face_count()).map(|f| [base.face(f)[0], base.face(f)[1], base.face(f)[2]]).collect();
    for _ in 0..2 {
        let mut middles = std::collections::BTreeMap::new();
        let mut next = Vec::new();
        for t in &triangles {
            let m: Vec<u32> = (0..3)
                .map(|k| {
                    let (a, b) = (t[k], t[(k + 1) % 3]);
                    *middles.entry((a.min(b), a.max(b))).or_insert_with(|| {
                        points.push((points[a as usize] + points[b as usize]) * 0.5);
                        points.len() as u32 - 1
                    })
                })
                .collect();
            next.extend([[t[0], m[0], m[2]], [t[1], m[1], m[0]], [t[2], m[2], m[1]], [m[0], m[1], m[2]]]);
        }
        triangles = next;
    }
    for p in &mut points {
        let n = p.normalized_or(Vec3::Z);
        *p = n * (radius * (1.0 + 0.1 * (5.0 * n.x).sin() * (4.0 * n.y).cos()));
    }
    Ok(TriMesh::new(points, triangles)?)
}
