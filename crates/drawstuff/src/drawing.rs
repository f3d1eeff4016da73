//! The frame that is being drawn: what the program's calls add up to.

use crate::note::{self, Note};
use crate::switches::Switches;
use ferrode_math::{Pose, Vec3};
use ferrode_render::{Color, Ground, Layer, Light, Mesh, Paint, Pattern, Scene, Sky};
use std::sync::Arc;

/// How the next thing is drawn.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pen {
    /// Colour, with opacity.
    pub color: Color,
    /// `DS_NONE` to `DS_SKY`; others are as none.
    pub texture: i32,
    /// Edges only.
    pub wireframe: bool,
}

impl Pen {
    /// As every frame begins.
    pub const START: Self = Self { color: Color::WHITE, texture: 0, wireframe: false };

    fn pattern(&self) -> Pattern {
        match self.texture {
            1 => Pattern::Wood,
            2 => Pattern::Checkered,
            3 => Pattern::Earth,
            4 => Pattern::Clouds,
            _ => Pattern::Plain,
        }
    }

    fn name(&self) -> &'static str {
        match self.texture {
            1 => " wood",
            2 => " checkered",
            3 => " ground",
            4 => " sky",
            _ => " plain",
        }
    }
}

/// Width of lines, pixels.
const LINE: f32 = 1.5;

/// How finely round shapes are divided.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Fineness {
    /// Of balls.
    pub sphere: i32,
    /// Of capsules and cylinders.
    pub capsule: i32,
}

impl Fineness {
    /// Unless a program asks for others.
    pub const START: Self = Self { sphere: 1, capsule: 3 };

    /// Corners round a ball: 32 at the usual quality 1.
    fn round_sphere(self) -> u32 {
        16 << self.sphere.clamp(0, 4)
    }

    /// Corners round a capsule: 32 at the usual quality 3.
    fn round_capsule(self) -> u32 {
        4 << self.capsule.clamp(1, 6)
    }
}

/// Meshes of round shapes, made when the first is drawn.
#[derive(Debug)]
struct Meshes {
    sphere: Arc<Mesh>,
    capsule: Arc<Mesh>,
    cylinder: Arc<Mesh>,
}

/// Triangles with the same pose and paint, which are drawn at once.
#[derive(Debug)]
struct Batch {
    pose: Pose,
    paint: Paint,
    triangles: Vec<[Vec3; 3]>,
}

/// A shape with a mesh.
#[derive(Clone, Copy, Debug)]
pub enum Round {
    /// Of a radius.
    Sphere(f64),
    /// Length without caps, radius.
    Capsule(f64, f64),
    /// Length, radius.
    Cylinder(f64, f64),
}

/// A frame.
#[derive(Debug)]
pub struct Drawing {
    /// How the next thing is drawn.
    pub pen: Pen,
    /// How finely round shapes are divided.
    pub fineness: Fineness,
    /// Calls are written down.
    pub noted: bool,
    /// Calls become pictures.
    pub shown: bool,
    text: String,
    scene: Scene,
    textures: bool,
    meshes: Option<Meshes>,
    batch: Option<Batch>,
}

impl Drawing {
    /// An empty one.
    pub fn new() -> Self {
        Self {
            pen: Pen::START,
            fineness: Fineness::START,
            noted: false,
            shown: false,
            text: String::new(),
            scene: Scene::new(),
            textures: true,
            meshes: None,
            batch: None,
        }
    }

    /// Begins a frame: ground and sky.
    pub fn begin(&mut self, switches: &Switches) {
        self.pen = Pen::START;
        self.text.clear();
        self.batch = None;
        self.textures = switches.textures;
        let Switches { textures, shadows, .. } = *switches;
        self.scene.clear(Vec3::ZERO);
        let shadow = if shadows { 1.0 } else { 0.0 };
        self.scene.light = Light { from: Vec3::new(1.0, 0.4, 1.0), shadow, ..Light::default() };
        self.scene.sky = Sky { clouds: if textures { 0.9 } else { 0.0 }, ..Sky::default() };
        if textures {
            self.scene.sky.zenith = Color::rgb(96, 146, 206);
        }
        let pattern = if textures { Pattern::Earth } else { Pattern::Plain };
        self.scene.ground(Ground { pattern, ..Ground::default() });
    }

    /// What was drawn.
    pub fn scene(&mut self) -> &Scene {
        self.flush();
        &self.scene
    }

    /// The calls.
    pub fn text(&self) -> &str {
        &self.text
    }

    /// Writes a call down, with the pen.
    pub fn note(&mut self, name: &str, parts: &[(&str, &dyn Note)], solid: bool) {
        if !self.noted {
            return;
        }
        let Color { r, g, b, a } = self.pen.color;
        let color = [r, g, b, a];
        let mut all = parts.to_vec();
        all.push(("color", &color));
        let wire = if solid && !self.pen.wireframe { "" } else { " wire" };
        let end = format!("{}{wire}", self.pen.name());
        note::line(&mut self.text, name, &all, &end);
    }

    fn paint(&self) -> Paint {
        let paint = Paint::from(self.pen.color);
        if self.textures { paint.with_pattern(self.pen.pattern()) } else { paint }
    }

    /// A box of full side lengths.
    pub fn cuboid(&mut self, pose: &Pose, sides: Vec3) {
        if !self.shown {
        } else if self.pen.wireframe {
            self.scene.wire_box(pose, sides, LINE, self.pen.color, Layer::World);
        } else {
            let paint = self.paint();
            self.scene.cuboid(pose, sides, paint);
        }
    }

    /// A round shape.
    pub fn round(&mut self, pose: &Pose, shape: Round) {
        if !self.shown {
            return;
        }
        let fineness = self.fineness;
        let meshes = self.meshes.get_or_insert_with(|| Meshes {
            sphere: Arc::new(Mesh::sphere(fineness.round_sphere())),
            capsule: Arc::new(Mesh::capsule(fineness.round_capsule())),
            cylinder: Arc::new(Mesh::cylinder(fineness.round_capsule())),
        });
        let (mesh, radius, length) = match shape {
            Round::Sphere(radius) => (&meshes.sphere, radius, 0.0),
            Round::Capsule(length, radius) => (&meshes.capsule, radius, length),
            Round::Cylinder(length, radius) => (&meshes.cylinder, radius, length),
        };
        let mesh = Arc::clone(mesh);
        let (radii, half) = (Vec3::splat(radius), Vec3::new(0.0, 0.0, 0.5 * length));
        if self.pen.wireframe {
            self.scene.wire_stretched(pose, &mesh, [radii, half], LINE, self.pen.color);
        } else {
            let paint = self.paint();
            self.scene.stretched(pose, &mesh, radii, half, paint);
        }
    }

    /// Triangles in the coordinates of a pose.
    pub fn triangles(&mut self, pose: &Pose, triangles: &[[Vec3; 3]], solid: bool) {
        let finite = |t: &&[Vec3; 3]| t.iter().all(|corner| corner.is_finite());
        if !(self.shown && pose.is_finite()) {
            return;
        }
        if !solid || self.pen.wireframe {
            for triangle in triangles.iter().filter(finite) {
                let [a, b, c] = triangle.map(|corner| pose.transform_point(corner));
                for (from, to) in [(a, b), (b, c), (c, a)] {
                    self.scene.line(from, to, LINE, self.pen.color, Layer::World);
                }
            }
            return;
        }
        let paint = self.paint();
        if !self.batch.as_ref().is_some_and(|batch| batch.pose == *pose && batch.paint == paint) {
            self.flush();
        }
        let batch = self.batch.get_or_insert_with(|| Batch { pose: *pose, paint, triangles: Vec::new() });
        batch.triangles.extend(triangles.iter().filter(finite));
    }

    /// A line in the world.
    pub fn line(&mut self, from: Vec3, to: Vec3) {
        if self.shown && from.is_finite() && to.is_finite() {
            self.scene.line(from, to, LINE, self.pen.color, Layer::World);
        }
    }

    fn flush(&mut self) {
        if let Some(batch) = self.batch.take() {
            self.scene.triangles(&batch.pose, &batch.triangles, batch.paint);
        }
    }
}
