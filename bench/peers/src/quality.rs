//! What an engine's answer is worth, judged from the solids' poses alone, by the same measure for all.

use crate::scene::{Form, Link, STEP, Scene};
use ferrode_collide::{
    Capsule, CollideOptions, Colliders, Cuboid, Cylinder, Geom, Shape, ShapeError, SpaceKind, Sphere, TriMesh,
};
use ferrode_math::{Pose, Vec3};
use serde::{Deserialize, Deserializer, Serialize};

/// Lengths in metres, angles in radians, speeds in m/s.
#[derive(Clone, Copy, Debug, Default, Deserialize, Serialize)]
pub struct Quality {
    /// Largest depth of a contact, and the mean over pairs that overlap.
    pub deepest: f64,
    /// The mean.
    pub mean_depth: f64,
    /// How far a joint's two anchors lie apart at most.
    #[serde(deserialize_with = "number_or_infinity")]
    pub joint_error: f64,
    /// How far the two axes of a hinge point apart at most.
    #[serde(deserialize_with = "number_or_infinity")]
    pub axis_error: f64,
    /// How far a body is from where it began, at most.
    pub moved: f64,
    /// The fastest body in the last step, and the mean.
    pub fastest: f64,
    /// The mean speed.
    pub mean_speed: f64,
    /// Bodies below the ground, far away or without a place.
    pub lost: usize,
}

/// The collision shape of a form.
///
/// # Errors
/// A form whose sizes are none.
pub fn shape(form: &Form) -> Result<Shape, ShapeError> {
    Ok(match form {
        Form::Cuboid(sides) => Cuboid::new(*sides)?.into(),
        Form::Sphere(radius) => Sphere::new(*radius)?.into(),
        Form::Capsule(radius, length) => Capsule::new(*radius, *length)?.into(),
        Form::Cylinder(radius, length) => Cylinder::new(*radius, *length)?.into(),
        Form::Mesh(vertices, triangles) => TriMesh::new(vertices.clone(), triangles.clone())?.into(),
    })
}

impl Quality {
    /// Judges a scene by its poses, and those a step before.
    pub fn judge(scene: &Scene, before: &[Pose], after: &[Pose]) -> Self {
        let mut quality = Self::default();
        quality.judge_motion(scene, before, after);
        quality.judge_joints(scene, after);
        quality.judge_contacts(scene, after);
        quality
    }

    fn judge_motion(&mut self, scene: &Scene, before: &[Pose], after: &[Pose]) {
        let mut count = 0;
        for (solid, (p, q)) in scene.solids.iter().zip(before.iter().zip(after)) {
            if solid.density.is_none() {
                continue;
            }
            let speed = (q.position - p.position).length() / STEP;
            let moved = (q.position - solid.pose.position).length();
            if !moved.is_finite() || moved > 1e4 || scene.gravity > 0.0 && q.position.z < -500.0 {
                self.lost += 1;
                continue;
            }
            self.moved = self.moved.max(moved);
            self.fastest = self.fastest.max(speed);
            self.mean_speed += speed;
            count += 1;
        }
        self.mean_speed /= f64::from(count.max(1));
    }

    fn judge_joints(&mut self, scene: &Scene, after: &[Pose]) {
        for joint in &scene.joints {
            let place = |i: usize, world: Vec3| {
                after[i].transform_point(scene.solids[i].pose.inverse_transform_point(world))
            };
            let turn = |i: usize, world: Vec3| {
                after[i].transform_vector(scene.solids[i].pose.inverse_transform_vector(world))
            };
            let apart =
                place(joint.a, joint.anchor) - joint.b.map_or(joint.anchor, |b| place(b, joint.anchor));
            self.joint_error = worst(self.joint_error, apart.length());
            if let Link::Hinge { axis, .. } = joint.link {
                let (a, b) = (turn(joint.a, axis), joint.b.map_or(axis, |b| turn(b, axis)));
                self.axis_error =
                    worst(self.axis_error, ferrode_math::real::atan2(a.cross(b).length(), a.dot(b)));
            }
        }
    }

    fn judge_contacts(&mut self, scene: &Scene, after: &[Pose]) {
        let mut colliders = Colliders::new();
        let Ok(space) = colliders.add_space(None, SpaceKind::Bvh) else { return };
        let mut numbers = std::collections::HashMap::new();
        for (i, (solid, pose)) in scene.solids.iter().zip(after).enumerate() {
            let finite = pose.position.is_finite() && pose.position.length() < 1e4;
            let Some(shape) = shape(&solid.form).ok().filter(|_| finite) else { continue };
            let Ok(key) = colliders.add_geom(Some(space), Geom::new(shape)) else { continue };
            if colliders.set_pose(key, *pose).is_ok() {
                numbers.insert(key, i);
            }
        }
        let mut joined: Vec<(usize, usize)> =
            scene.joints.iter().filter_map(|j| Some((j.a.min(j.b?), j.a.max(j.b?)))).collect();
        joined.sort_unstable();
        let (mut found, mut sum, mut pairs) = (Vec::new(), 0.0, 0);
        let searched = colliders.collide(space, |colliders, x, y| {
            found.clear();
            colliders.contacts(x, y, CollideOptions::new(16), &mut found);
            let Some((a, b, _)) = found.first() else { return };
            let (Some(a), Some(b)) = (numbers.get(a), numbers.get(b)) else { return };
            let (a, b) = (*a.min(b), *a.max(b));
            let fixed = |i: usize| scene.solids[i].density.is_none();
            let ghosts = scene.solids[a].ghost && scene.solids[b].ghost;
            if ghosts || fixed(a) && fixed(b) || joined.binary_search(&(a, b)).is_ok() {
                return;
            }
            let deepest = found.iter().map(|c| c.2.point.depth).fold(0.0, f64::max);
            (sum, pairs) = (sum + deepest, pairs + 1);
            self.deepest = self.deepest.max(deepest);
        });
        if searched.is_ok() {
            self.mean_depth = sum / f64::from(pairs.max(1));
        }
    }
}

/// JSON has no infinity, and null in its place.
fn number_or_infinity<'de, D: Deserializer<'de>>(from: D) -> Result<f64, D::Error> {
    Ok(Option::deserialize(from)?.unwrap_or(f64::INFINITY))
}

/// The larger; what is no number counts as infinite.
fn worst(a: f64, b: f64) -> f64 {
    if b.is_nan() { f64::INFINITY } else { a.max(b) }
}
