//! Worlds as scenes: each geom as a shape at its place.

use ferrode::{BodyKey, GeomKey, Shape, World};
use ferrode_math::{Aabb, Pose, Vec3};
use ferrode_render::{Color, Ground, Mesh, Paint, Pattern, Scene};
use ferrode_scene::NamedWorld;
use ferrode_scene::description::LinkId;
use std::collections::BTreeMap;
use std::sync::Arc;

/// What colours tell.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Coloring {
    /// Which body it is.
    #[default]
    Bodies,
    /// Who sleeps: sleepers are pale blue, kinematic bodies yellow.
    Sleep,
    /// Which island it is in: bodies that joints and contacts connect have one colour.
    Islands,
}

/// Draws worlds. Keep it from picture to picture: it remembers meshes and colours.
#[derive(Debug, Default)]
pub struct Painter {
    /// What colours tell.
    pub coloring: Coloring,
    /// A body to show in a lighter colour.
    pub selected: Option<BodyKey>,
    /// Height of a floor to draw if the world has no plane of its own, for shadows to fall on (lower, where bodies are
    /// lower); `None` for none.
    pub floor: Option<f64>,
    colors: BTreeMap<BodyKey, Color>,
    /// By geom and part of a compound.
    meshes: BTreeMap<(GeomKey, usize), Arc<Mesh>>,
    islands: BTreeMap<BodyKey, usize>,
}

/// Things that don't move.
const STATIC: Color = Color::rgb(186, 180, 170);
const ASLEEP: Color = Color::rgb(150, 172, 200);
const KINEMATIC: Color = Color::rgb(236, 200, 92);
const AWAKE: Color = Color::rgb(222, 120, 86);

impl Painter {
    /// A painter that gives the bodies of each model related colours.
    pub fn for_named(named: &NamedWorld) -> Self {
        let mut painter = Self::default();
        let scene = &named.scene;
        let mut links_of = vec![0_usize; scene.models.len()];
        for link in &scene.links {
            links_of[link.model.0] += 1;
        }
        let mut seen = vec![0_usize; scene.models.len()];
        for (index, link) in scene.links.iter().enumerate() {
            let model = link.model.0;
            let nth = seen[model];
            seen[model] += 1;
            let Some(body) = named.link_body(LinkId(index)) else { continue };
            let base = Color::of(model);
            let color = match (links_of[model], nth % 3) {
                (1, _) | (_, 0) => base,
                (_, 1) => base.mixed(Color::WHITE, 0.45),
                (_, _) => base.mixed(Color::BLACK, 0.35),
            };
            painter.colors.insert(body, color);
        }
        painter
    }

    /// Sets the colour of a body.
    pub fn set_color(&mut self, body: BodyKey, color: Color) {
        self.colors.insert(body, color);
    }

    /// The colour that a body has of its own.
    pub fn color_of(&mut self, body: BodyKey) -> Color {
        let next = Color::of(self.colors.len());
        *self.colors.entry(body).or_insert(next)
    }

    fn color(&mut self, world: &World, body: Option<BodyKey>) -> Color {
        let Some(key) = body else { return STATIC };
        let own = self.color_of(key);
        let Ok(state) = world.body(key) else { return own };
        let color = match self.coloring {
            Coloring::Bodies => own,
            Coloring::Sleep if state.is_kinematic() => KINEMATIC,
            Coloring::Sleep if state.is_enabled() => AWAKE,
            Coloring::Sleep => ASLEEP,
            Coloring::Islands => match self.islands.get(&key) {
                Some(island) if state.is_enabled() => Color::of(*island),
                _ => ASLEEP,
            },
        };
        if self.selected == Some(key) { color.mixed(Color::WHITE, 0.45) } else { color }
    }

    /// Adds all geoms of a world to a scene.
    pub fn paint(&mut self, world: &World, scene: &mut Scene) {
        if self.coloring == Coloring::Islands {
            self.islands = crate::islands::islands(world);
        }
        let mut grounded = false;
        for info in world.geoms() {
            let Ok(geom) = world.geom(info.key) else { continue };
            let color = self.color(world, info.body);
            grounded |= matches!(geom.shape(), Shape::Plane(_) | Shape::Heightfield(_));
            self.shape(Some((info.key, 0)), geom.shape(), geom.pose(), Paint::from(color), scene);
        }
        if let (Some(height), false) = (self.floor, grounded) {
            // It must not hide what comes down to it.
            let lowest = bounds(world).map_or(height, |bounds| bounds.min.z);
            let point = Vec3::new(0.0, 0.0, height.min(lowest));
            scene.ground(Ground { point, grid: 0.0, color: Color::rgb(222, 222, 220), ..Ground::default() });
        }
    }

    /// Adds a shape. Meshes are remembered for the geom, and the part of its compound, that they are of.
    pub(crate) fn shape(
        &mut self,
        key: Option<(GeomKey, usize)>,
        shape: &Shape,
        pose: &Pose,
        paint: Paint,
        scene: &mut Scene,
    ) {
        match shape {
            Shape::Sphere(s) => scene.sphere(pose, s.radius(), paint.with_pattern(Pattern::Octants)),
            Shape::Cuboid(s) => scene.cuboid(pose, s.sides(), paint),
            Shape::Capsule(s) => scene.capsule(pose, s.radius(), s.length(), paint),
            Shape::Cylinder(s) => scene.cylinder(pose, s.radius(), s.length(), paint),
            Shape::Cone(s) => scene.cone(pose, s.radius(), s.length(), paint),
            Shape::Ellipsoid(s) => scene.ellipsoid(pose, s.radii(), paint.with_pattern(Pattern::Octants)),
            Shape::Plane(s) => {
                let normal = pose.transform_vector(s.normal());
                let point = pose.transform_point(s.normal() * s.d());
                // The grid's lines cross where the world's axes come down.
                scene.ground(Ground { point, normal, ..Ground::default() });
            }
            Shape::Ray(s) => {
                let end = pose.transform_point(Vec3::new(0.0, 0.0, s.length()));
                scene.line(pose.position, end, 2.0, paint.color, ferrode_render::Layer::World);
            }
            Shape::Compound(compound) => {
                for (i, (part, at)) in compound.parts().enumerate() {
                    self.shape(key.map(|(geom, _)| (geom, i)), part, &(*pose * *at), paint, scene);
                }
            }
            _ => {
                let Some(mesh) = self.mesh(key, shape) else { return };
                scene.mesh(pose, &mesh, Vec3::splat(1.0), paint);
            }
        }
    }

    fn mesh(&mut self, key: Option<(GeomKey, usize)>, shape: &Shape) -> Option<Arc<Mesh>> {
        if let Some(mesh) = key.and_then(|key| self.meshes.get(&key)) {
            return Some(Arc::clone(mesh));
        }
        let (corners, triangles) = shape.triangles()?;
        let mesh = Arc::new(Mesh::new(&corners, &triangles));
        if let Some(key) = key {
            self.meshes.insert(key, Arc::clone(&mesh));
        }
        Some(mesh)
    }
}

/// A box around all that can move, or around everything finite if nothing can; `None` for an empty world.
pub fn bounds(world: &World) -> Option<Aabb> {
    let mut all: [Option<Aabb>; 2] = [None, None];
    for info in world.geoms() {
        let Ok(geom) = world.geom(info.key) else { continue };
        let aabb = geom.shape().aabb(geom.pose());
        if !aabb.is_finite() || aabb.extent().abs_max() > 1e6 {
            continue;
        }
        let place = &mut all[usize::from(info.body.is_none())];
        *place = Some(place.map_or(aabb, |sum| sum.union(&aabb)));
    }
    for (_, body) in world.bodies() {
        let point = Aabb { min: body.position(), max: body.position() };
        if point.is_finite() {
            all[0] = Some(all[0].map_or(point, |sum| sum.union(&point)));
        }
    }
    all[0].or(all[1])
}
