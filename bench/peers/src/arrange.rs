//! How the parts of a scene are laid out: heaps, crowds, chains. Every number follows from the part's own.

use crate::scene::{Form, Joint, Link, Scene};
use ferrode_math::{Pose, Quat, Vec3, real};
use serde::Deserialize;

/// A part of a scene. Lengths in metres.
#[derive(Deserialize)]
#[serde(tag = "kind", rename_all = "lowercase", deny_unknown_fields)]
pub enum Part {
    /// A slab whose top is z = 0.
    Ground,
    /// Boxes in rows, each on two of the row below.
    Pyramid {
        /// Boxes of the lowest row.
        rows: usize,
        /// Side of a box.
        side: f64,
        /// Between boxes of a row.
        gap: f64,
    },
    /// Boxes, slightly turned and shifted, that fall into a pit with walls.
    Bin {
        /// How many.
        count: usize,
        /// Side of a box.
        side: f64,
    },
    /// Figures of eleven capsules with ball joints and hinges with stops.
    Ragdolls {
        /// How many.
        count: usize,
    },
    /// Links of a chain that starts level and hangs from its first end.
    Chain {
        /// How many.
        links: usize,
        /// Mass of the last link over that of the others.
        end_mass: f64,
    },
    /// A torso hinged to the world, and five limbs, 30 hinges with brakes in all.
    Robots {
        /// How many.
        count: usize,
    },
    /// Hills as a mesh of triangles.
    Terrain {
        /// Squares along a side, two triangles each.
        cells: u32,
        /// Side of a square.
        cell: f64,
        /// Half of the height of a hill over its valley.
        height: f64,
    },
    /// Boxes, spheres, capsules and cylinders in turn, in layers.
    Mixed {
        /// How many.
        count: usize,
        /// From centre to centre.
        spacing: f64,
        /// Height of the lowest layer.
        above: f64,
    },
    /// Boxes and spheres in a cube of space, each on its way.
    Spread {
        /// How many.
        count: usize,
        /// Side of the cube.
        size: f64,
        /// Largest speed along an axis, m/s.
        speed: f64,
    },
    /// Towers of boxes, apart from each other.
    Towers {
        /// How many towers.
        count: usize,
        /// Boxes of a tower.
        height: usize,
        /// Side of a box.
        side: f64,
        /// From tower to tower.
        spacing: f64,
    },
}

const DENSITY: Option<f64> = Some(1000.0);

/// Numbers that look random, the same for every engine: a linear congruence (Knuth, MMIX).
struct Numbers(u64);

impl Numbers {
    /// Between −1 and 1.
    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1u64 << 52) as f64 - 1.0
    }

    fn vector(&mut self) -> Vec3 {
        Vec3::new(self.next(), self.next(), self.next())
    }
}

/// The place of number `i` in a grid of `side` times `side` in the middle of the ground.
fn place(i: usize, side: usize, spacing: f64) -> Vec3 {
    let middle = 0.5 * (side - 1) as f64;
    Vec3::new((i % side) as f64 - middle, (i / side % side) as f64 - middle, 0.0) * spacing
}

fn ceil_root(count: usize) -> usize {
    (1..).find(|side| side * side >= count).unwrap_or(1)
}

impl Part {
    /// Adds the part to a scene.
    pub fn lay_out(&self, scene: &mut Scene) {
        match *self {
            Self::Ground => ground(scene),
            Self::Pyramid { rows, side, gap } => {
                for row in 0..rows {
                    for i in 0..rows - row {
                        let x = (i as f64 - 0.5 * (rows - row - 1) as f64) * (side + gap);
                        let at = Vec3::new(x, 0.0, (row as f64 + 0.5) * side);
                        scene.add(Form::Cuboid(Vec3::splat(side)), at, DENSITY);
                    }
                }
            }
            Self::Bin { count, side } => bin(scene, count, side),
            Self::Ragdolls { count } => {
                let side = ceil_root(count);
                for i in 0..count {
                    let height = 1.5 + (i % 7) as f64 * 0.3;
                    ragdoll(scene, place(i, side, 1.2) + Vec3::Z * height);
                }
            }
            Self::Chain { links, end_mass } => chain(scene, links, end_mass),
            Self::Robots { count } => {
                for i in 0..count {
                    robot(scene, Vec3::new((i % 8) as f64 * 5.0, (i / 8) as f64 * 5.0, 3.0));
                }
            }
            Self::Terrain { cells, cell, height } => terrain(scene, cells, cell, height),
            Self::Mixed { count, spacing, above } => {
                let side = ceil_root(count / 4).max(1);
                for i in 0..count {
                    let layer = i / (side * side);
                    let at = place(i, side, spacing) + Vec3::Z * (above + layer as f64 * spacing);
                    let form = match i % 4 {
                        0 => Form::Cuboid(Vec3::new(0.9, 0.7, 0.5)),
                        1 => Form::Sphere(0.4),
                        2 => Form::Capsule(0.3, 0.6),
                        _ => Form::Cylinder(0.35, 0.7),
                    };
                    scene.add(form, at, DENSITY);
                }
            }
            Self::Spread { count, size, speed } => {
                let mut numbers = Numbers(7);
                for i in 0..count {
                    let form = if i % 2 == 0 { Form::Sphere(0.5) } else { Form::Cuboid(Vec3::splat(1.0)) };
                    let solid = scene.add(form, numbers.vector() * (0.5 * size), DENSITY);
                    scene.solids[solid].velocity = numbers.vector() * speed;
                }
            }
            Self::Towers { count, height, side, spacing } => {
                for i in 0..count {
                    let foot = place(i, ceil_root(count), spacing);
                    for k in 0..height {
                        let at = foot + Vec3::Z * ((k as f64 + 0.5) * side);
                        scene.add(Form::Cuboid(Vec3::splat(side)), at, DENSITY);
                    }
                }
            }
        }
    }
}

fn ground(scene: &mut Scene) {
    scene.add(Form::Cuboid(Vec3::new(400.0, 400.0, 2.0)), Vec3::new(0.0, 0.0, -1.0), None);
}

fn bin(scene: &mut Scene, count: usize, side: f64) {
    let pitch = side + 0.15;
    let n = (1..).find(|n: &usize| 2 * n.pow(3) >= count).unwrap_or(1);
    let half = 0.5 * n as f64 * pitch + 0.1;
    ground(scene);
    for (x, y) in [(1.0, 0.0), (-1.0, 0.0), (0.0, 1.0), (0.0, -1.0)] {
        let long = 2.0 * half + 2.0;
        let wall = Vec3::new(if x == 0.0 { long } else { 1.0 }, if y == 0.0 { long } else { 1.0 }, 60.0);
        scene.add(Form::Cuboid(wall), Vec3::new(x * (half + 0.5), y * (half + 0.5), 30.0), None);
    }
    let mut numbers = Numbers(1);
    for i in 0..count {
        let layer = (i / (n * n)) as f64;
        let jitter = numbers.vector() * 0.05;
        let at =
            place(i, n, pitch) + Vec3::Z * (0.7 + layer * (side + 0.3)) + Vec3::new(jitter.x, jitter.y, 0.0);
        let body = scene.add(Form::Cuboid(Vec3::splat(side)), at, DENSITY);
        scene.solids[body].pose.rotation = Quat::from_axis_angle(Vec3::new(1.0, 0.3, 0.2), 4.0 * jitter.z);
    }
}

fn ragdoll(scene: &mut Scene, at: Vec3) {
    let mut limb = |centre: Vec3, radius: f64, length: f64| {
        scene.add(Form::Capsule(radius, length), at + centre, DENSITY)
    };
    let pelvis = limb(Vec3::ZERO, 0.13, 0.1);
    let chest = limb(Vec3::Z * 0.4, 0.15, 0.2);
    let head = limb(Vec3::Z * 0.85, 0.1, 0.08);
    let mut joints = vec![(pelvis, chest, Vec3::Z * 0.2, None), (chest, head, Vec3::Z * 0.7, None)];
    for s in [-1.0, 1.0] {
        let upper_arm = limb(Vec3::new(0.28 * s, 0.0, 0.4), 0.06, 0.2);
        let lower_arm = limb(Vec3::new(0.28 * s, 0.0, 0.05), 0.05, 0.2);
        let thigh = limb(Vec3::new(0.14 * s, 0.0, -0.4), 0.08, 0.3);
        let shin = limb(Vec3::new(0.14 * s, 0.0, -0.9), 0.06, 0.3);
        joints.push((chest, upper_arm, Vec3::new(0.25 * s, 0.0, 0.55), None));
        joints.push((upper_arm, lower_arm, Vec3::new(0.28 * s, 0.0, 0.22), Some((-2.0, 0.0))));
        joints.push((pelvis, thigh, Vec3::new(0.14 * s, 0.0, -0.15), None));
        joints.push((thigh, shin, Vec3::new(0.14 * s, 0.0, -0.65), Some((0.0, 2.0))));
    }
    for (a, b, anchor, stops) in joints {
        let link = match stops {
            None => Link::Ball,
            Some(_) => Link::Hinge { axis: Vec3::X, stops, brake: None },
        };
        scene.joints.push(Joint { a, b: Some(b), anchor: at + anchor, link });
    }
}

fn chain(scene: &mut Scene, links: usize, end_mass: f64) {
    let pitch = 0.4;
    let mut before = None;
    for i in 0..links {
        let density = if i + 1 == links { 1000.0 * end_mass } else { 1000.0 };
        let at = Vec3::new((i as f64 + 0.5) * pitch, 0.0, 0.0);
        let link = scene.add(Form::Capsule(0.05, 0.25), at, Some(density));
        let solid = &mut scene.solids[link];
        solid.pose = Pose::new(at, Quat::from_axis_angle(Vec3::Y, core::f64::consts::FRAC_PI_2));
        solid.ghost = true;
        let anchor = Vec3::new(i as f64 * pitch, 0.0, 0.0);
        scene.joints.push(Joint { a: link, b: before, anchor, link: Link::Ball });
        before = Some(link);
    }
}

fn robot(scene: &mut Scene, base: Vec3) {
    let axes = [Vec3::X, Vec3::Y, Vec3::Z];
    let mut part = |mass: f64, sides: Vec3, at: Vec3| {
        let body = scene.add(Form::Cuboid(sides), at, Some(mass / (sides.x * sides.y * sides.z)));
        scene.solids[body].ghost = true;
        body
    };
    let torso = part(5.0, Vec3::new(0.4, 0.3, 0.6), base);
    let mut hinges = vec![(torso, None, base, Vec3::Z, 5.0)];
    for k in 0..29 {
        let (limb, joint) = (k % 5, k / 5);
        let direction = [Vec3::X, -Vec3::X, Vec3::Y, -Vec3::Y, Vec3::Z][limb];
        let length = 0.25;
        let parent = if joint == 0 { torso } else { torso + k + 1 - 5 };
        let anchor = base + direction * (0.4 + joint as f64 * length);
        let sides = Vec3::splat(0.08) + direction.abs() * (length - 0.08);
        let body = part(0.5 + 0.1 * joint as f64, sides, anchor + direction * (0.5 * length));
        hinges.push((body, Some(parent), anchor, axes[(limb / 2 + joint + 1) % 3], 1.0 + joint as f64));
    }
    for (a, b, anchor, axis, brake) in hinges {
        let link = Link::Hinge { axis, stops: None, brake: Some(brake) };
        scene.joints.push(Joint { a, b, anchor, link });
    }
}

fn terrain(scene: &mut Scene, cells: u32, cell: f64, height: f64) {
    let (n, middle) = (cells + 1, 0.5 * f64::from(cells) * cell);
    let mut vertices = Vec::new();
    for j in 0..n {
        for i in 0..n {
            let (x, y) = (f64::from(i) * cell - middle, f64::from(j) * cell - middle);
            vertices.push(Vec3::new(x, y, height * real::sin(0.3 * x) * real::cos(0.25 * y)));
        }
    }
    let mut triangles = Vec::new();
    for j in 0..cells {
        for i in 0..cells {
            let a = j * n + i;
            triangles.push([a, a + 1, a + n + 1]);
            triangles.push([a, a + n + 1, a + n]);
        }
    }
    scene.add(Form::Mesh(vertices, triangles), Vec3::ZERO, None);
}
