//! Mass of the solid that a triangle mesh bounds.
//!
//! Volume integrals become surface integrals by the divergence theorem, e.g. ∫x² dV = ∮ x³/3 nₓ dA, and those of cubic
//! polynomials over a triangle are exact: with the corner values x₀ x₁ x₂ and so on, and s for their sums,
//! the mean of x y z over it is (sₓ s_y s_z + sₓ Σyz + s_y Σxz + s_z Σxy + 2 Σxyz) / 60.
//! (The moments are those of B. Mirtich, "Fast and accurate computation of polyhedral mass properties", 1996.)

use super::{Mass, shapes::positive};
use crate::Error;
use crate::error::finite;
use core::fmt;
use ferrode_math::{Mat3, Vec3};

/// Why a mesh bounds no solid.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum MeshError {
    /// A triangle names a vertex that is not there.
    NoSuchVertex {
        /// The triangle's number.
        triangle: usize,
        /// The vertex that it names.
        vertex: u32,
        /// How many vertices there are.
        vertices: usize,
    },
    /// The surface has a border, or neighbours that wind differently: the edge is not run through as often one way as the
    /// other.
    Open {
        /// The edge's ends.
        edge: [Vec3; 2],
    },
    /// The triangles wind clockwise seen from outside, or enclose nothing.
    NotOutward {
        /// The signed volume.
        volume: f64,
    },
}

impl fmt::Display for MeshError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::NoSuchVertex { triangle, vertex, vertices } => {
                write!(f, "triangle {triangle} names vertex {vertex}, but the mesh has {vertices}")
            }
            Self::Open { edge: [a, b] } => write!(
                f,
                "the mesh is not closed at the edge from ({}, {}, {}) to ({}, {}, {})",
                a.x, a.y, a.z, b.x, b.y, b.z
            ),
            Self::NotOutward { volume } => {
                write!(
                    f,
                    "the mesh encloses the volume {volume}; triangles must wind counter-clockwise seen from outside"
                )
            }
        }
    }
}

impl Mass {
    /// The solid of `density` within a closed triangle mesh, whose triangles wind counter-clockwise seen from outside.
    /// Vertices at exactly the same place count as one.
    ///
    /// # Errors
    /// [`Error::Mesh`] for an open or inverted mesh; [`Error::OutOfRange`], [`Error::NotFinite`].
    pub fn trimesh(density: f64, vertices: &[Vec3], triangles: &[[u32; 3]]) -> Result<Self, Error> {
        positive("density", density)?;
        let corners = corners(vertices, triangles)?;
        check_closed(vertices, triangles)?;
        // About a point of the mesh: about a far origin the moments would cancel to nothing.
        let start = corners.first().map_or(Vec3::ZERO, |t| t[0]);
        let m = Moments::of(&corners, start);
        outward(m.volume)?;
        let centre = m.first * (1.0 / m.volume);
        let about_start = Self { mass: m.volume * density, centre, inertia: m.inertia(density) };
        let made = about_start.translate(start)?;
        made.check()?;
        Ok(made)
    }

    /// As [`Mass::trimesh`], with the total mass given.
    ///
    /// # Errors
    /// As [`Mass::trimesh`].
    pub fn trimesh_total(mass: f64, vertices: &[Vec3], triangles: &[[u32; 3]]) -> Result<Self, Error> {
        positive("mass", mass)?;
        Self::trimesh(1.0, vertices, triangles)?.adjust(mass)
    }

    /// ODE's `dMassSetTrimesh`, whose inertia is too large for a mesh that is not centred at the origin: the parallel-axis
    /// term enters twice. It also takes open meshes, and integrates what triangles there are.
    ///
    /// # Errors
    /// [`Error::Mesh`] for a volume that is not positive; [`Error::OutOfRange`], [`Error::NotFinite`].
    pub fn trimesh_as_ode(density: f64, vertices: &[Vec3], triangles: &[[u32; 3]]) -> Result<Self, Error> {
        positive("density", density)?;
        let m = Moments::of(&corners(vertices, triangles)?, Vec3::ZERO);
        outward(m.volume)?;
        let about_origin = Self { mass: m.volume * density, centre: Vec3::ZERO, inertia: m.inertia(density) };
        about_origin.translate(m.first * (1.0 / m.volume))
    }

    /// ODE's `dMassSetTrimeshTotal`: as [`Mass::trimesh_as_ode`], with the total mass given.
    ///
    /// # Errors
    /// As [`Mass::trimesh_as_ode`].
    pub fn trimesh_total_as_ode(mass: f64, vertices: &[Vec3], triangles: &[[u32; 3]]) -> Result<Self, Error> {
        positive("mass", mass)?;
        Self::trimesh_as_ode(1.0, vertices, triangles)?.adjust(mass)
    }
}

fn outward(volume: f64) -> Result<(), Error> {
    if volume > 0.0 { Ok(()) } else { Err(Error::Mesh(MeshError::NotOutward { volume })) }
}

/// The triangles' corners.
fn corners(vertices: &[Vec3], triangles: &[[u32; 3]]) -> Result<Vec<[Vec3; 3]>, Error> {
    let corner = |triangle: usize, vertex: u32| match vertices.get(vertex as usize) {
        Some(v) => finite("mesh vertex", *v),
        None => Err(Error::Mesh(MeshError::NoSuchVertex { triangle, vertex, vertices: vertices.len() })),
    };
    let all = |(i, t): (usize, &[u32; 3])| Ok([corner(i, t[0])?, corner(i, t[1])?, corner(i, t[2])?]);
    triangles.iter().enumerate().map(all).collect()
}

/// Every edge must be run through as often from a to b as from b to a.
fn check_closed(vertices: &[Vec3], triangles: &[[u32; 3]]) -> Result<(), Error> {
    // Adding 0 makes −0 equal to 0 in a total order.
    let key = |v: u32| vertices[v as usize].to_array().map(|x| (x + 0.0).to_bits());
    let mut by_place: Vec<u32> = (0..vertices.len() as u32).collect();
    by_place.sort_by_key(|v| key(*v));
    let mut name = vec![0; vertices.len()];
    let mut last = 0;
    for v in by_place {
        if key(v) != key(last) {
            last = v;
        }
        name[v as usize] = last;
    }
    let mut edges: Vec<(u32, u32, i32)> = Vec::with_capacity(3 * triangles.len());
    for t in triangles {
        for (a, b) in [(t[0], t[1]), (t[1], t[2]), (t[2], t[0])] {
            let (a, b) = (name[a as usize], name[b as usize]);
            match a.cmp(&b) {
                core::cmp::Ordering::Less => edges.push((a, b, 1)),
                core::cmp::Ordering::Greater => edges.push((b, a, -1)),
                core::cmp::Ordering::Equal => {}
            }
        }
    }
    edges.sort_unstable();
    for same in edges.chunk_by(|x, y| (x.0, x.1) == (y.0, y.1)) {
        if same.iter().map(|e| e.2).sum::<i32>() != 0 {
            let edge = [vertices[same[0].0 as usize], vertices[same[0].1 as usize]];
            return Err(Error::Mesh(MeshError::Open { edge }));
        }
    }
    Ok(())
}

/// Integrals over the enclosed volume.
#[derive(Clone, Copy, Debug, Default)]
struct Moments {
    volume: f64,
    /// ∫x, ∫y, ∫z.
    first: Vec3,
    /// ∫x², ∫y², ∫z².
    squares: Vec3,
    /// ∫xy, ∫yz, ∫zx.
    products: Vec3,
}

impl Moments {
    /// With positions relative to `origin`.
    fn of(triangles: &[[Vec3; 3]], origin: Vec3) -> Self {
        let mut sum = Self::default();
        for t in triangles {
            let [a, b, c] = t.map(|v| v - origin);
            // The area, along the normal.
            let n = (b - a).cross(c - a) * 0.5;
            let (x, y, z) = ([a.x, b.x, c.x], [a.y, b.y, c.y], [a.z, b.z, c.z]);
            sum.volume += n.x * (x[0] + x[1] + x[2]) / 3.0;
            sum.first += Vec3::new(n.x * mean_square(x), n.y * mean_square(y), n.z * mean_square(z)) * 0.5;
            let cubes = Vec3::new(n.x * mean(x, x, x), n.y * mean(y, y, y), n.z * mean(z, z, z));
            sum.squares += cubes * (1.0 / 3.0);
            let mixed = Vec3::new(n.x * mean(x, x, y), n.y * mean(y, y, z), n.z * mean(z, z, x));
            sum.products += mixed * 0.5;
        }
        sum
    }

    fn inertia(&self, density: f64) -> Mat3 {
        let (s, p) = (self.squares, self.products);
        let m = Mat3::from_rows([[s.y + s.z, -p.x, -p.z], [-p.x, s.z + s.x, -p.y], [-p.z, -p.y, s.x + s.y]]);
        m * density
    }
}

/// Mean of x² over a triangle, by its corner values.
fn mean_square(x: [f64; 3]) -> f64 {
    let s = x[0] + x[1] + x[2];
    (s * s + x[0] * x[0] + x[1] * x[1] + x[2] * x[2]) / 12.0
}

/// Mean of x y z over a triangle, by their corner values.
fn mean(x: [f64; 3], y: [f64; 3], z: [f64; 3]) -> f64 {
    let sum = |a: [f64; 3]| a[0] + a[1] + a[2];
    let dot = |a: [f64; 3], b: [f64; 3]| a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
    let all = x[0] * y[0] * z[0] + x[1] * y[1] * z[1] + x[2] * y[2] * z[2];
    (sum(x) * sum(y) * sum(z) + sum(x) * dot(y, z) + sum(y) * dot(x, z) + sum(z) * dot(x, y) + 2.0 * all)
        / 60.0
}
