//! Meshes of the shapes that have names.

use crate::mesh::{Mesh, Vertex};
use ferrode_math::real::{cos, sin};
use std::f64::consts::{FRAC_PI_2, PI, TAU};

/// A builder of strips and fans.
#[derive(Default)]
struct Builder {
    vertices: Vec<Vertex>,
    indices: Vec<u32>,
}

impl Builder {
    fn push(&mut self, local: [f64; 3], core: [f64; 3], normal: [f64; 3]) -> u32 {
        let narrow = |v: [f64; 3]| v.map(|x| x as f32);
        let n = self.vertices.len() as u32;
        self.vertices.push(Vertex { local: narrow(local), core: narrow(core), normal: narrow(normal) });
        n
    }

    fn quad(&mut self, [a, b, c, d]: [u32; 4]) {
        self.indices.extend([a, b, c, a, c, d]);
    }

    /// Sides of a body of revolution about z: `profile` lists (distance from the axis, z of local, z of core, normal's part
    /// outward, normal's part along z) from bottom to top.
    fn revolve(&mut self, profile: &[[f64; 5]], sides: u32) {
        let start = self.vertices.len() as u32;
        for [r, z, core, out, along] in profile {
            for k in 0..=sides {
                let angle = TAU * f64::from(k) / f64::from(sides);
                let (c, s) = (cos(angle), sin(angle));
                self.push([r * c, r * s, *z], [0.0, 0.0, *core], [out * c, out * s, *along]);
            }
        }
        let row = sides + 1;
        for i in 0..profile.len() as u32 - 1 {
            for k in 0..sides {
                let at = start + i * row + k;
                self.quad([at, at + 1, at + row + 1, at + row]);
            }
        }
    }

    /// A flat disc at z of core, facing up (1) or down (−1).
    fn disc(&mut self, core: f64, sides: u32) {
        let centre = self.push([0.0; 3], [0.0, 0.0, core], [0.0, 0.0, core]);
        for k in 0..=sides {
            let angle = TAU * f64::from(k) / f64::from(sides);
            self.push([cos(angle), sin(angle), 0.0], [0.0, 0.0, core], [0.0, 0.0, core]);
        }
        for k in 1..=sides {
            let (a, b) = (centre + k, centre + k + 1);
            self.indices.extend(if core > 0.0 { [centre, a, b] } else { [centre, b, a] });
        }
    }

    fn mesh(self) -> Mesh {
        Mesh::from_parts(self.vertices, self.indices)
    }
}

/// Round from −90° to 90° of latitude, `core` apart at the equator: a sphere for 0, a capsule for 1.
fn round(sides: u32, rings: u32, core: f64) -> Mesh {
    let ring = |i: u32, core: f64| {
        let angle = -FRAC_PI_2 + PI * f64::from(i) / f64::from(rings);
        let (c, s) = (cos(angle), sin(angle));
        [c, s, core, c, s]
    };
    let mut profile: Vec<_> = (0..=rings / 2).map(|i| ring(i, -core)).collect();
    profile.extend((rings / 2 + u32::from(core == 0.0)..=rings).map(|i| ring(i, core)));
    let mut builder = Builder::default();
    builder.revolve(&profile, sides);
    builder.mesh()
}

/// Radii: the radius along each axis.
pub fn sphere() -> Mesh {
    Mesh::sphere(32)
}

/// Radii: the radius; half: half the length without caps, along z.
pub fn capsule() -> Mesh {
    Mesh::capsule(24)
}

/// Radii: the radius; half: half the length, along z.
pub fn cylinder() -> Mesh {
    Mesh::cylinder(36)
}

impl Mesh {
    /// A ball of radius 1 with so many corners round its equator; at least 4, a multiple of 4.
    pub fn sphere(sides: u32) -> Self {
        let sides = sides.clamp(4, 1024).next_multiple_of(4);
        round(sides, sides / 2, 0.0)
    }

    /// A capsule along z, of radius 1 and half length 1, with so many corners round it (at least 4, a multiple of 4); for
    /// [`Scene::stretched`](crate::Scene::stretched).
    pub fn capsule(sides: u32) -> Self {
        let sides = sides.clamp(4, 1024).next_multiple_of(4);
        round(sides, sides / 2, 1.0)
    }

    /// A cylinder along z, of radius 1 and half length 1, with so many corners round it (at least 3); for
    /// [`Scene::stretched`](crate::Scene::stretched).
    pub fn cylinder(sides: u32) -> Self {
        let sides = sides.clamp(3, 1024);
        let mut builder = Builder::default();
        builder.revolve(&[[1.0, 0.0, -1.0, 1.0, 0.0], [1.0, 0.0, 1.0, 1.0, 0.0]], sides);
        builder.disc(1.0, sides);
        builder.disc(-1.0, sides);
        builder.mesh()
    }
}

/// Radii: the radius of the base in x and y, the height in z (it scales normals only); half: half the height. The tip is up.
pub fn cone() -> Mesh {
    const SIDES: u32 = 36;
    let mut builder = Builder::default();
    builder.revolve(&[[1.0, 0.0, -1.0, 1.0, 1.0], [0.0, 0.0, 1.0, 1.0, 1.0]], SIDES);
    builder.disc(-1.0, SIDES);
    builder.mesh()
}

const CORNERS: [[f64; 2]; 4] = [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]];

/// A point from its coordinates along the axis `k`, the next one and the one after.
fn along(k: usize, [a, b, c]: [f64; 3]) -> [f64; 3] {
    let mut point = [0.0; 3];
    (point[k], point[(k + 1) % 3], point[(k + 2) % 3]) = (a, b, c);
    point
}

/// Half: half the sides.
pub fn cuboid() -> Mesh {
    let mut builder = Builder::default();
    for k in 0..3 {
        for side in [-1.0, 1.0] {
            let normal = along(k, [side, 0.0, 0.0]);
            let mut face = CORNERS.map(|[b, c]| builder.push([0.0; 3], along(k, [side, b, c]), normal));
            if side < 0.0 {
                face.reverse();
            }
            builder.quad(face);
        }
    }
    builder.mesh()
}

/// Radii: the radius of the edges; half: half the sides less that radius.
pub fn rounded_cuboid() -> Mesh {
    /// Faces across a quarter turn of an edge.
    const ARC: usize = 2;
    let mut builder = Builder::default();
    // Each of the six faces is a grid whose outer strips bend round the edges by 45°; neighbours meet in the middle.
    let angles: Vec<f64> = (0..=ARC).map(|i| std::f64::consts::FRAC_PI_4 * i as f64 / ARC as f64).collect();
    let mut lines: Vec<(f64, f64)> = angles.iter().rev().map(|a| (-1.0, -sin(*a) / cos(*a))).collect();
    lines.extend(angles.iter().map(|a| (1.0, sin(*a) / cos(*a))));
    let n = lines.len() as u32;
    for k in 0..3 {
        for side in [-1.0, 1.0] {
            let start = builder.vertices.len() as u32;
            for (core_b, bend_b) in &lines {
                for (core_c, bend_c) in &lines {
                    let length = ferrode_math::Vec3::new(1.0, *bend_b, *bend_c).length();
                    let normal = along(k, [side / length, bend_b / length, bend_c / length]);
                    builder.push(normal, along(k, [side, *core_b, *core_c]), normal);
                }
            }
            for i in 0..n - 1 {
                for j in 0..n - 1 {
                    let at = start + i * n + j;
                    let mut face = [at, at + n, at + n + 1, at + 1];
                    if side < 0.0 {
                        face.reverse();
                    }
                    builder.quad(face);
                }
            }
        }
    }
    builder.mesh()
}

#[cfg(test)]
mod tests {
    use super::{capsule, cone, cuboid, cylinder, rounded_cuboid, sphere};
    use crate::Mesh;
    use ferrode_math::Vec3;

    fn corners(mesh: &Mesh, radii: Vec3, half: Vec3) -> Vec<[Vec3; 3]> {
        let wide = |v: [f32; 3]| Vec3::from_array(v.map(f64::from));
        let corner = |i: &u32| {
            let v = mesh.vertices[*i as usize];
            wide(v.local).component_mul(radii) + wide(v.core).component_mul(half)
        };
        mesh.indices.chunks(3).map(|t| [corner(&t[0]), corner(&t[1]), corner(&t[2])]).collect()
    }

    /// Six times the volume inside, by the divergence theorem: right only if every face is there and turned outward.
    fn volume(mesh: &Mesh, radii: Vec3, half: Vec3) -> f64 {
        corners(mesh, radii, half).iter().map(|[a, b, c]| a.dot(b.cross(*c)) / 6.0).sum()
    }

    #[test]
    fn shapes_are_closed_and_have_their_volumes() {
        use std::f64::consts::PI;
        let near =
            |got: f64, want: f64, share: f64| assert!((got / want - 1.0).abs() < share, "{got} {want}");
        let r = Vec3::splat(0.5);
        near(volume(&sphere(), Vec3::new(0.5, 1.0, 2.0), Vec3::ZERO), 4.0 / 3.0 * PI, 0.03);
        let long = Vec3::new(0.0, 0.0, 1.5);
        near(volume(&capsule(), r, long), 4.0 / 3.0 * PI * 0.125 + PI * 0.25 * 3.0, 0.03);
        near(volume(&cylinder(), r, long), PI * 0.25 * 3.0, 0.01);
        near(volume(&cone(), Vec3::new(0.5, 0.5, 3.0), long), PI * 0.25 * 3.0 / 3.0, 0.01);
        let half = Vec3::new(0.5, 1.0, 1.5);
        near(volume(&cuboid(), r, half), 6.0, 1e-6);
        // A box, rounded: the inner box, six slabs, twelve quarter cylinders and eight eighths of a sphere.
        let (e, h) = (0.1, half - Vec3::splat(0.1));
        let slabs = 8.0 * e * (h.x * h.y + h.y * h.z + h.z * h.x);
        let edges = 2.0 * PI * e * e * (h.x + h.y + h.z);
        let whole = 8.0 * h.x * h.y * h.z + slabs + edges + 4.0 / 3.0 * PI * e * e * e;
        near(volume(&rounded_cuboid(), Vec3::splat(e), h), whole, 2e-3);
    }

    #[test]
    fn normals_point_as_the_faces_do() {
        for (name, mesh, radii, half) in [
            ("sphere", sphere(), Vec3::splat(1.0), Vec3::ZERO),
            ("capsule", capsule(), Vec3::splat(0.5), Vec3::Z),
            ("cylinder", cylinder(), Vec3::splat(0.5), Vec3::Z),
            ("cone", cone(), Vec3::new(0.5, 0.5, 2.0), Vec3::Z),
            ("cuboid", cuboid(), Vec3::ZERO, Vec3::splat(1.0)),
            ("rounded", rounded_cuboid(), Vec3::splat(0.1), Vec3::splat(0.9)),
        ] {
            for (t, [a, b, c]) in mesh.indices.chunks(3).zip(corners(&mesh, radii, half)) {
                let face = (b - a).cross(c - a);
                if face.length() < 1e-9 {
                    continue; // where circles shrink to a point
                }
                for i in t {
                    let v = mesh.vertices[*i as usize].normal;
                    let n = Vec3::new(
                        f64::from(v[0]) / radii.x.max(1e-9),
                        f64::from(v[1]) / radii.y.max(1e-9),
                        f64::from(v[2]) / radii.z.max(1e-9),
                    );
                    let cosine = n.normalized().unwrap().dot(face.normalized().unwrap());
                    assert!(cosine > 0.7, "{name}: {cosine}");
                }
            }
        }
    }
}
