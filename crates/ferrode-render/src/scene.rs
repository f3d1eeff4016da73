//! What is to be drawn: shapes at poses, anew for each picture.

use crate::instance::{Instance, instance};
use crate::mesh::to_f32;
use crate::{Color, Light, Mesh, Paint, Pattern, Sky};
use ferrode_math::{Pose, Quat, Vec3};
use std::sync::{Arc, LazyLock};

/// Where a thing is drawn.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Layer {
    /// Among the others: hidden by what is before it.
    #[default]
    World,
    /// Over all others, for what is inside bodies.
    Over,
}

/// An endless plane with a grid, that fades into the horizon.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ground {
    /// A point of it; the grid's lines cross there.
    pub point: Vec3,
    /// Unit vector out of it.
    pub normal: Vec3,
    /// Its colour.
    pub color: Color,
    /// Distance between the grid's lines, m; each tenth is stronger. 0 for no grid.
    pub grid: f64,
    /// How its colour varies; only a plain one has a grid.
    pub pattern: Pattern,
}

impl Default for Ground {
    fn default() -> Self {
        let color = Color::rgb(206, 203, 196);
        Self { point: Vec3::ZERO, normal: Vec3::Z, color, grid: 1.0, pattern: Pattern::Plain }
    }
}

/// The meshes of the shapes with names.
pub(crate) struct Shapes {
    pub sphere: Arc<Mesh>,
    pub capsule: Arc<Mesh>,
    pub cylinder: Arc<Mesh>,
    pub cone: Arc<Mesh>,
    pub cuboid: Arc<Mesh>,
    pub rounded_cuboid: Arc<Mesh>,
    pub coarse_sphere: Arc<Mesh>,
    pub coarse_capsule: Arc<Mesh>,
    pub coarse_cylinder: Arc<Mesh>,
}

impl Shapes {
    /// A mesh of fewer corners that looks the same from far away.
    pub fn coarse(&self, mesh: &Arc<Mesh>) -> Option<&Arc<Mesh>> {
        let pairs = [
            (&self.sphere, &self.coarse_sphere),
            (&self.capsule, &self.coarse_capsule),
            (&self.cylinder, &self.coarse_cylinder),
        ];
        pairs.into_iter().find(|(fine, _)| Arc::ptr_eq(fine, mesh)).map(|(_, coarse)| coarse)
    }
}

pub(crate) static SHAPES: LazyLock<Shapes> = LazyLock::new(|| Shapes {
    sphere: Arc::new(crate::shapes::sphere()),
    capsule: Arc::new(crate::shapes::capsule()),
    cylinder: Arc::new(crate::shapes::cylinder()),
    cone: Arc::new(crate::shapes::cone()),
    cuboid: Arc::new(crate::shapes::cuboid()),
    rounded_cuboid: Arc::new(crate::shapes::rounded_cuboid()),
    coarse_sphere: Arc::new(Mesh::sphere(16)),
    coarse_capsule: Arc::new(Mesh::capsule(12)),
    coarse_cylinder: Arc::new(Mesh::cylinder(16)),
});

/// A mesh at a place.
#[derive(Clone, Debug)]
pub(crate) struct Item {
    pub mesh: Arc<Mesh>,
    pub instance: Instance,
    /// Centre (relative to the scene's origin) and radius of a ball around it.
    pub ball: (Vec3, f64),
    pub shadow: bool,
    pub layer: Layer,
}

/// A line: ends relative to the scene's origin, width in pixels, colour.
pub(crate) type Line = [f32; 12];

/// Triangles given corner by corner.
#[derive(Clone, Debug)]
pub(crate) struct Loose {
    pub vertices: Vec<[f32; 9]>,
    pub instance: Instance,
    pub shadow: bool,
}

/// What is to be drawn. All lengths are metres, all poses in the world.
#[derive(Clone, Debug, Default)]
pub struct Scene {
    /// The sun.
    pub light: Light,
    /// The background.
    pub sky: Sky,
    pub(crate) origin: Vec3,
    pub(crate) grounds: Vec<Ground>,
    pub(crate) items: Vec<Item>,
    pub(crate) loose: Vec<Loose>,
    pub(crate) lines: Vec<Line>,
    pub(crate) lines_over: Vec<Line>,
}

impl Scene {
    /// An empty scene.
    pub fn new() -> Self {
        Self::default()
    }

    /// An empty scene around a point. The graphics card counts in single precision from there: choose a point near what is
    /// looked at, if that is far from the world's origin.
    pub fn around(origin: Vec3) -> Self {
        Self { origin, ..Self::default() }
    }

    /// Removes all that was drawn, for the next picture; keeps memory, sun and sky.
    pub fn clear(&mut self, origin: Vec3) {
        self.origin = origin;
        self.grounds.clear();
        self.items.clear();
        self.loose.clear();
        self.lines.clear();
        self.lines_over.clear();
    }

    /// Adds a ground plane.
    pub fn ground(&mut self, ground: Ground) {
        self.grounds.push(ground);
    }

    fn add(
        &mut self,
        mesh: &Arc<Mesh>,
        pose: &Pose,
        sizes: [Vec3; 2],
        radius: f64,
        paint: Paint,
        layer: Layer,
    ) {
        if !(pose.is_finite() && radius.is_finite()) {
            return;
        }
        self.items.push(Item {
            mesh: Arc::clone(mesh),
            instance: instance(pose, self.origin, sizes[0], sizes[1], &paint),
            ball: (pose.position - self.origin, radius),
            shadow: paint.shadow && paint.color.a > 0.5,
            layer,
        });
    }

    /// A box of full side lengths.
    pub fn cuboid(&mut self, pose: &Pose, sides: Vec3, paint: Paint) {
        self.cuboid_in(pose, sides, paint, Layer::World);
    }

    /// A box of full side lengths, in a layer.
    pub fn cuboid_in(&mut self, pose: &Pose, sides: Vec3, paint: Paint, layer: Layer) {
        let half = sides * 0.5;
        self.add(&SHAPES.cuboid, pose, [Vec3::splat(1.0), half], half.length(), paint, layer);
    }

    /// A ball.
    pub fn sphere(&mut self, pose: &Pose, radius: f64, paint: Paint) {
        self.sphere_in(pose, radius, paint, Layer::World);
    }

    /// A ball, in a layer.
    pub fn sphere_in(&mut self, pose: &Pose, radius: f64, paint: Paint, layer: Layer) {
        self.add(&SHAPES.sphere, pose, [Vec3::splat(radius), Vec3::ZERO], radius, paint, layer);
    }

    /// An ellipsoid of three half axes.
    pub fn ellipsoid(&mut self, pose: &Pose, radii: Vec3, paint: Paint) {
        self.add(&SHAPES.sphere, pose, [radii, Vec3::ZERO], radii.abs_max(), paint, Layer::World);
    }

    /// A capsule along z; the length is that between the centres of its caps.
    pub fn capsule(&mut self, pose: &Pose, radius: f64, length: f64, paint: Paint) {
        let half = Vec3::new(0.0, 0.0, 0.5 * length);
        self.add(&SHAPES.capsule, pose, [Vec3::splat(radius), half], radius + half.z, paint, Layer::World);
    }

    /// A cylinder along z.
    pub fn cylinder(&mut self, pose: &Pose, radius: f64, length: f64, paint: Paint) {
        self.cylinder_in(pose, radius, length, paint, Layer::World);
    }

    /// A cylinder along z, in a layer.
    pub fn cylinder_in(&mut self, pose: &Pose, radius: f64, length: f64, paint: Paint, layer: Layer) {
        let half = Vec3::new(0.0, 0.0, 0.5 * length);
        self.add(&SHAPES.cylinder, pose, [Vec3::splat(radius), half], radius + half.z, paint, layer);
    }

    /// A cone along z, its tip up, the middle of its height at the pose.
    pub fn cone(&mut self, pose: &Pose, radius: f64, length: f64, paint: Paint) {
        self.cone_in(pose, radius, length, paint, Layer::World);
    }

    /// A cone along z, in a layer.
    pub fn cone_in(&mut self, pose: &Pose, radius: f64, length: f64, paint: Paint, layer: Layer) {
        let sizes = [Vec3::new(radius, radius, length), Vec3::new(0.0, 0.0, 0.5 * length)];
        self.add(&SHAPES.cone, pose, sizes, radius + 0.5 * length, paint, layer);
    }

    /// A mesh whose corners are scaled along its own axes, and whose cores (see [`Vertex`](crate::Vertex)) by half lengths:
    /// [`Mesh::capsule`], say, of radius and half length.
    pub fn stretched(&mut self, pose: &Pose, mesh: &Arc<Mesh>, radii: Vec3, half: Vec3, paint: Paint) {
        let radius = mesh.radius() * radii.abs_max() + half.length();
        self.add(mesh, pose, [radii, half], radius, paint, Layer::World);
    }

    /// A mesh, scaled along its own axes.
    pub fn mesh(&mut self, pose: &Pose, mesh: &Arc<Mesh>, scale: Vec3, paint: Paint) {
        let radius = mesh.radius() * scale.abs_max();
        self.add(mesh, pose, [scale, Vec3::ZERO], radius, paint, Layer::World);
    }

    /// Triangles that change from picture to picture, in the coordinates of a pose; flat, and seen from both sides. For those
    /// that stay the same a [`Mesh`] is quicker.
    pub fn triangles(&mut self, pose: &Pose, triangles: &[[Vec3; 3]], paint: Paint) {
        let mut vertices = Vec::with_capacity(triangles.len() * 3);
        for [a, b, c] in triangles {
            let normal = to_f32((*b - *a).cross(*c - *a).normalized_or(Vec3::Z));
            for corner in [a, b, c] {
                let local = to_f32(*corner);
                vertices.push(crate::Vertex { local, core: [0.0; 3], normal }.to_array());
            }
        }
        let instance = instance(pose, self.origin, Vec3::splat(1.0), Vec3::ZERO, &paint);
        self.loose.push(Loose { vertices, instance, shadow: paint.shadow && paint.color.a > 0.5 });
    }

    /// A line between two points of the world, `width` pixels wide.
    pub fn line(&mut self, from: Vec3, to: Vec3, width: f32, color: Color, layer: Layer) {
        let ([ax, ay, az], [bx, by, bz]) = (to_f32(from - self.origin), to_f32(to - self.origin));
        let [r, g, b, a] = color.linear();
        let line = [ax, ay, az, width, bx, by, bz, 0.0, r, g, b, a];
        match layer {
            Layer::World => self.lines.push(line),
            Layer::Over => self.lines_over.push(line),
        }
    }

    /// The twelve edges of a box.
    pub fn wire_box(&mut self, pose: &Pose, sides: Vec3, width: f32, color: Color, layer: Layer) {
        let corner = |n: u8| {
            let side = |bit: u8| if n & bit == 0 { -0.5 } else { 0.5 };
            pose.transform_point(sides.component_mul(Vec3::new(side(1), side(2), side(4))))
        };
        for n in 0..8_u8 {
            for bit in [1, 2, 4] {
                if n & bit == 0 {
                    self.line(corner(n), corner(n | bit), width, color, layer);
                }
            }
        }
    }

    /// The edges of a mesh's triangles, scaled along its own axes.
    pub fn wire_mesh(&mut self, pose: &Pose, mesh: &Mesh, scale: Vec3, width: f32, color: Color) {
        self.wire_stretched(pose, mesh, [scale, Vec3::ZERO], width, color);
    }

    /// The edges of a mesh's triangles, scaled by radii and half lengths as by [`Scene::stretched`].
    pub fn wire_stretched(
        &mut self,
        pose: &Pose,
        mesh: &Mesh,
        [radii, half]: [Vec3; 2],
        width: f32,
        color: Color,
    ) {
        for t in mesh.indices.chunks_exact(3) {
            let corner = |i: usize| {
                let vertex = &mesh.vertices[t[i] as usize];
                let [local, core] = [vertex.local, vertex.core].map(|v| Vec3::from_array(v.map(f64::from)));
                pose.transform_point(local.component_mul(radii) + core.component_mul(half))
            };
            for (a, b) in [(0, 1), (1, 2), (2, 0)] {
                self.line(corner(a), corner(b), width, color, Layer::World);
            }
        }
    }

    /// An arrow between two points of the world: a shaft of a radius, and a head.
    pub fn arrow(&mut self, from: Vec3, to: Vec3, radius: f64, paint: Paint, layer: Layer) {
        let along = to - from;
        let (length, Some(axis)) = (along.length(), along.normalized()) else { return };
        let rotation = turn_z_to(axis);
        let head = (5.0 * radius).min(0.6 * length);
        let shaft = length - head;
        let middle = Pose::new(from + axis * (0.5 * shaft), rotation);
        self.cylinder_in(&middle, radius, shaft, paint, layer);
        let tip = Pose::new(from + axis * (shaft + 0.5 * head), rotation);
        self.cone_in(&tip, 2.4 * radius, head, paint, layer);
    }

    /// How many shapes there are.
    pub fn shape_count(&self) -> usize {
        self.items.len()
    }
}

/// The shortest turn from z to a unit vector.
pub(crate) fn turn_z_to(axis: Vec3) -> Quat {
    let half = Vec3::Z + axis;
    if half.length() < 1e-6 {
        return Quat::new(0.0, 1.0, 0.0, 0.0);
    }
    let half = half.normalized_or(Vec3::Z);
    Quat::from_parts(Vec3::Z.dot(half), Vec3::Z.cross(half))
}

#[cfg(test)]
mod tests {
    use super::{Scene, turn_z_to};
    use crate::{Color, Layer, Paint};
    use ferrode_math::{Pose, Vec3};

    #[test]
    fn z_turns_to_any_direction() {
        for axis in [Vec3::X, -Vec3::Z, Vec3::Z, Vec3::new(0.6, 0.0, -0.8), Vec3::new(-0.36, 0.48, 0.8)] {
            assert!((turn_z_to(axis).rotate(Vec3::Z) - axis).length() < 1e-12, "{axis:?}");
        }
    }

    #[test]
    fn numbers_that_are_none_are_left_out() {
        let mut scene = Scene::new();
        scene.sphere(&Pose::from_position(Vec3::new(f64::NAN, 0.0, 0.0)), 1.0, Paint::from(Color::RED));
        scene.arrow(Vec3::X, Vec3::X, 0.1, Paint::from(Color::RED), Layer::World);
        assert_eq!(scene.shape_count(), 0);
    }
}
