//! A spring between the mouse and a body.

use ferrode::{BodyKey, Error, World};
use ferrode_math::Vec3;
use ferrode_render::Camera;
use std::collections::{BTreeMap, BTreeSet};

/// A grip on a body: a critically damped spring from a point of it to the mouse.
#[derive(Clone, Copy, Debug)]
pub struct Grab {
    /// The body.
    pub body: BodyKey,
    /// Where it is held, in its own frame.
    pub local: Vec3,
    /// Where the mouse is, in the world.
    pub target: Vec3,
    /// Distance of the point from the eye's plane, which stays.
    depth: f64,
    /// What the spring has to move: the body and all that is joined to it, kg.
    mass: f64,
}

/// Natural frequency of the spring, rad/s.
const STIFF: f64 = 18.0;

impl Grab {
    /// Takes hold of a body at a point of the world. Static and kinematic bodies cannot be held: `None`.
    pub fn new(world: &World, body: BodyKey, point: Vec3, camera: &Camera) -> Option<Self> {
        let state = world.body(body).ok()?;
        if state.is_kinematic() {
            return None;
        }
        let depth = (point - camera.eye).dot(camera.directions()[2]);
        Some(Self {
            body,
            local: state.position_relative_point(point),
            target: point,
            depth,
            mass: joined_mass(world, body),
        })
    }

    /// Follows the mouse: the target is where the ray through it has the depth at which the body was taken.
    pub fn follow(&mut self, camera: &Camera, along: Vec3) {
        let forward = camera.directions()[2];
        let slant = along.dot(forward);
        if slant > 1e-6 {
            self.target = camera.eye + along * (self.depth / slant);
        }
    }

    /// Where it is held now, in the world.
    pub fn point(&self, world: &World) -> Option<Vec3> {
        Some(world.body(self.body).ok()?.relative_point_position(self.local))
    }

    /// Pulls, before a step of `h` seconds.
    ///
    /// # Errors
    /// The body is gone.
    pub fn pull(&self, world: &mut World, h: f64) -> Result<(), Error> {
        let weight = world.gravity() * -self.mass;
        let body = world.body_mut(self.body)?;
        body.enable();
        let point = body.relative_point_position(self.local);
        let velocity = body.point_velocity(point);
        // Explicit springs are stable while frequency times step stays well below 2.
        let stiff = STIFF.min(0.4 / h);
        let (k, c) = (self.mass * stiff * stiff, 2.0 * self.mass * stiff);
        let force = (self.target - point) * k - velocity * c + weight;
        body.add_force_at_position(force, point)?;
        // A body on a string would swing for long.
        let brake = body.inertia_world() * body.angular_velocity() * (-0.3 * stiff);
        body.add_torque(brake)?;
        Ok(())
    }
}

/// The mass of a body and of all bodies that joints hold to it.
fn joined_mass(world: &World, body: BodyKey) -> f64 {
    let mut neighbours: BTreeMap<BodyKey, Vec<BodyKey>> = BTreeMap::new();
    for [a, b] in world.joints().filter_map(|joint| world.joint_bodies(joint).ok()) {
        if let (Some(a), Some(b)) = (a, b) {
            neighbours.entry(a).or_default().push(b);
            neighbours.entry(b).or_default().push(a);
        }
    }
    let (mut seen, mut open, mut mass) = (BTreeSet::from([body]), vec![body], 0.0);
    while let Some(key) = open.pop() {
        mass += world.body(key).map_or(0.0, |state| state.mass().mass);
        for next in neighbours.get(&key).into_iter().flatten() {
            if seen.insert(*next) {
                open.push(*next);
            }
        }
    }
    mass
}

#[cfg(test)]
mod tests {
    use super::Grab;
    use ferrode::prelude::*;
    use ferrode_render::Camera;

    #[test]
    fn a_held_ball_comes_to_the_mouse_and_flies_on_when_let_go() -> Result<(), Error> {
        let mut world = World::new();
        world.set_gravity(Vec3::new(0.0, 0.0, -9.81))?;
        let ball = world.add_body(BodyBuilder::new().with_shape(Sphere::new(0.2)?, 1000.0))?;
        let camera = Camera::look_at(Vec3::new(0.0, -5.0, 0.0), Vec3::ZERO);
        let mut grab = Grab::new(&world, ball, Vec3::new(0.0, -0.2, 0.0), &camera).unwrap();
        let goal = Vec3::new(1.0, -0.2, 0.5);
        grab.follow(&camera, (goal - camera.eye).normalized().unwrap());
        assert!((grab.target - goal).length() < 1e-9);
        for _ in 0..200 {
            grab.pull(&mut world, 0.01)?;
            world.step(0.01)?;
        }
        assert!((grab.point(&world).unwrap() - goal).length() < 0.01);
        grab.follow(&camera, (goal + Vec3::X - camera.eye).normalized().unwrap());
        for _ in 0..8 {
            grab.pull(&mut world, 0.01)?;
            world.step(0.01)?;
        }
        assert!(world.body(ball)?.linear_velocity().x > 2.0, "thrown");
        Ok(())
    }
}
