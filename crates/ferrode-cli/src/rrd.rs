//! Recordings for Rerun's viewer, through its SDK.
//!
//! | entity | |
//! |---|---|
//! | `world/links/NAME` | pose of the link's frame at each recorded step |
//! | `world/links/NAME/geom0` … | its shapes, in the link's coordinates |
//! | `world/static/geom0` … | shapes that cannot move; planes as thin squares |
//! | `world/contacts` | forces of contacts on the first body as arrows, as long in metres as they are parts of all weight |
//! | `joints/NAME/position`, `…/velocity` | rad or m, rad/s or m/s; of the second axis `position2` |
//! | `energy/kinetic`, `energy/potential` | J |
//!
//! The timeline is `time`, simulated seconds.

use crate::exit::Failure;
use crate::simulation::Simulation;
use ferrode::prelude::*;
use ferrode_scene::description::{JointId, LinkId};
use rerun::{EntityPath, EntityPathPart, RecordingStream, RecordingStreamError};
use std::path::{Path, PathBuf};

/// Half the side of the square that stands for a plane, in metres.
const PLANE: f64 = 25.0;

/// A recording under way.
pub struct Recording {
    stream: RecordingStream,
    file: PathBuf,
    links: Vec<(LinkId, EntityPath)>,
    /// Joint, axis, paths of position and velocity.
    axes: Vec<(JointId, usize, [EntityPath; 2])>,
    /// Of all bodies, in newtons; at least a little.
    weight: f64,
}

/// An entity's path: names may hold anything.
fn path(parts: &[&str]) -> EntityPath {
    EntityPath::new(parts.iter().map(|part| EntityPathPart::new(*part)).collect())
}

fn single(v: Vec3) -> [f32; 3] {
    [v.x as f32, v.y as f32, v.z as f32]
}

fn transform(pose: &Pose) -> rerun::Transform3D {
    let q = pose.rotation;
    let [x, y, z, w] = [q.x, q.y, q.z, q.w].map(|x| x as f32);
    rerun::Transform3D::from_translation_rotation(
        single(pose.position),
        rerun::Quaternion::from_xyzw([x, y, z, w]),
    )
}

impl Recording {
    /// Starts a recording with the shapes of all geoms.
    ///
    /// # Errors
    /// The file cannot be written.
    pub fn create(file: &Path, simulation: &Simulation) -> Result<Self, Failure> {
        let stream =
            rerun::RecordingStreamBuilder::new("ferrode").save(file).map_err(|error| failure(file, error))?;
        let (scene, world) = (simulation.scene(), simulation.world());
        let all = (0..scene.links.len()).map(LinkId);
        let links = all.filter(|link| simulation.moves(*link));
        let links: Vec<(LinkId, EntityPath)> =
            links.map(|link| (link, path(&["world", "links", &scene.links[link.0].name]))).collect();
        let mut axes = Vec::new();
        for (index, joint) in scene.joints.iter().enumerate() {
            let id = JointId(index);
            for (axis, number) in ["", "2"].into_iter().enumerate() {
                if simulation.joint_position(id, axis).is_some() {
                    let value = |name: &str| path(&["joints", &joint.name, &format!("{name}{number}")]);
                    axes.push((id, axis, [value("position"), value("velocity")]));
                }
            }
        }
        let gravity = world.dynamics().gravity().length();
        let mass: f64 = world.bodies().map(|(_, body)| body.mass().mass).sum();
        let weight = (mass * gravity).max(1e-6);
        let recording = Self { stream, file: file.to_owned(), links, axes, weight };
        recording.shapes(simulation).map_err(|error| failure(file, error))?;
        Ok(recording)
    }

    fn shapes(&self, simulation: &Simulation) -> Result<(), RecordingStreamError> {
        let world = simulation.world();
        self.stream.log_static("world", &rerun::ViewCoordinates::RIGHT_HAND_Z_UP())?;
        let owner = |body: BodyKey| self.links.iter().find(|link| simulation.link_body(link.0) == Some(body));
        for (number, info) in world.geoms().enumerate() {
            let Ok(geom) = world.geom(info.key) else { continue };
            let name = format!("geom{number}");
            let (entity, pose) = match info.body.and_then(owner) {
                Some((link, entity)) => {
                    let pose = simulation.link_pose(*link).inverse() * *geom.pose();
                    (entity.join(&path(&[&name])), pose)
                }
                None => (path(&["world", "static", &name]), *geom.pose()),
            };
            self.shape(&entity, geom.shape(), &pose)?;
        }
        Ok(())
    }

    fn shape(&self, entity: &EntityPath, shape: &Shape, pose: &Pose) -> Result<(), RecordingStreamError> {
        let (stream, to) = (&self.stream, || entity.clone());
        let place = |pose: &Pose| stream.log_static(to(), &transform(pose));
        let ends = |half: f64| ([[0.0, 0.0, -half as f32]], [[0.0, 0.0, half as f32]]);
        match shape {
            Shape::Plane(plane) => {
                // The square's normal is its z axis.
                let across = Vec3::Z.cross(plane.normal()).normalized_or(Vec3::X);
                let turn = Quat::from_axis_angle(across, plane.normal().z.clamp(-1.0, 1.0).acos());
                place(&(*pose * Pose::new(plane.normal() * plane.d(), turn)))?;
                let square = rerun::Boxes3D::from_half_sizes([single(Vec3::new(PLANE, PLANE, 0.0))]);
                stream.log_static(to(), &square)
            }
            Shape::Compound(compound) => {
                for (i, (part, at)) in compound.parts().enumerate() {
                    self.shape(&entity.join(&path(&[&format!("part{i}")])), part, &(*pose * *at))?;
                }
                Ok(())
            }
            Shape::Sphere(s) => {
                place(pose)?;
                let half = single(Vec3::splat(s.radius()));
                stream.log_static(to(), &solid_ellipsoid(half))
            }
            Shape::Ellipsoid(s) => {
                place(pose)?;
                stream.log_static(to(), &solid_ellipsoid(single(s.radii())))
            }
            Shape::Cuboid(s) => {
                place(pose)?;
                let half = rerun::Boxes3D::from_half_sizes([single(s.half_sides())]);
                stream.log_static(to(), &half.with_fill_mode(rerun::FillMode::Solid))
            }
            Shape::Capsule(s) => {
                place(pose)?;
                let (from, end) = ends(0.5 * s.length());
                let capsule = rerun::Capsules3D::from_endpoints_and_radii(from, end, [s.radius() as f32]);
                stream.log_static(to(), &capsule.with_fill_mode(rerun::FillMode::Solid))
            }
            Shape::Cylinder(s) => {
                place(pose)?;
                let cylinder =
                    rerun::Cylinders3D::from_lengths_and_radii([s.length() as f32], [s.radius() as f32]);
                stream.log_static(to(), &cylinder.with_fill_mode(rerun::FillMode::Solid))
            }
            other => {
                let Some((corners, triangles)) = other.triangles().or_else(|| cone(other)) else {
                    return Ok(());
                };
                place(pose)?;
                let mesh =
                    rerun::Mesh3D::new(corners.iter().map(|v| single(*v))).with_triangle_indices(triangles);
                stream.log_static(to(), &mesh)
            }
        }
    }

    /// Writes the present state.
    ///
    /// # Errors
    /// The file cannot be written.
    pub fn record(&mut self, simulation: &Simulation) -> Result<(), Failure> {
        self.state(simulation).map_err(|error| failure(&self.file, error))
    }

    fn state(&self, simulation: &Simulation) -> Result<(), RecordingStreamError> {
        let (stream, world) = (&self.stream, simulation.world());
        stream.set_duration_secs("time", world.time());
        for (link, entity) in &self.links {
            stream.log(entity.clone(), &transform(&simulation.link_pose(*link)))?;
        }
        for (joint, axis, [position, velocity]) in &self.axes {
            for (entity, value) in [
                (position, simulation.joint_position(*joint, *axis)),
                (velocity, simulation.joint_velocity(*joint, *axis)),
            ] {
                stream.log(entity.clone(), &rerun::Scalars::new([value.unwrap_or(f64::NAN)]))?;
            }
        }
        let energy = world.energy();
        stream.log("energy/kinetic", &rerun::Scalars::new([energy.kinetic]))?;
        stream.log("energy/potential", &rerun::Scalars::new([energy.potential]))?;
        let contacts = world.contacts();
        let arrows =
            rerun::Arrows3D::from_vectors(contacts.iter().map(|c| single(c.force * (1.0 / self.weight))))
                .with_origins(contacts.iter().map(|c| single(c.point.position)));
        stream.log("world/contacts", &arrows)
    }

    /// Writes what is left.
    ///
    /// # Errors
    /// The file cannot be written.
    pub fn finish(self) -> Result<(), Failure> {
        self.stream.flush_blocking().map_err(|error| failure(&self.file, error))
    }
}

fn solid_ellipsoid(half: [f32; 3]) -> rerun::Ellipsoids3D {
    rerun::Ellipsoids3D::from_half_sizes([half]).with_fill_mode(rerun::FillMode::Solid)
}

/// A cone of 32 sides, with its base; Rerun has none.
fn cone(shape: &Shape) -> Option<(Vec<Vec3>, Vec<[u32; 3]>)> {
    const SIDES: u32 = 32;
    let Shape::Cone(cone) = shape else { return None };
    let half = 0.5 * cone.length();
    let mut corners = vec![Vec3::new(0.0, 0.0, half), Vec3::new(0.0, 0.0, -half)];
    let mut triangles = Vec::new();
    for i in 0..SIDES {
        let angle = std::f64::consts::TAU * f64::from(i) / f64::from(SIDES);
        corners.push(Vec3::new(cone.radius() * angle.cos(), cone.radius() * angle.sin(), -half));
        let (here, next) = (2 + i, 2 + (i + 1) % SIDES);
        triangles.extend([[0, here, next], [1, next, here]]);
    }
    Some((corners, triangles))
}

fn failure(file: &Path, error: impl std::error::Error + Send + Sync + 'static) -> Failure {
    Failure::output(file.display(), &std::io::Error::other(error))
}
