//! Installed Bullet (single precision) through `bullet.cpp`. This file is not safe Rust.

use super::parts::{along_z, frames, mass};
use crate::engine::Engine;
use crate::scene::{Form, Joint, Link, STEP, Scene, Solid};
use core::ffi::{c_int, c_void};
use ferrode_math::{Pose, Quat, Vec3};

type World = *mut c_void;
type Shape = *mut c_void;

unsafe extern "C" {
    fn bench_bullet_world(gravity: f32, sleeping: bool) -> World;
    fn bench_bullet_box(sides: *const f32) -> Shape;
    fn bench_bullet_sphere(radius: f32) -> Shape;
    fn bench_bullet_capsule(radius: f32, length: f32) -> Shape;
    fn bench_bullet_cylinder(radius: f32, length: f32) -> Shape;
    fn bench_bullet_mesh(
        vertices: *mut f32,
        vertex_count: c_int,
        indices: *mut c_int,
        triangle_count: c_int,
    ) -> Shape;
    fn bench_bullet_body(
        world: World,
        shape: Shape,
        pose: *const f32,
        velocity: *const f32,
        mass: f32,
        inertia: *const f32,
        friction: f32,
        ghost: bool,
    );
    fn bench_bullet_ball(world: World, a: c_int, b: c_int, at_a: *const f32, at_b: *const f32);
    fn bench_bullet_hinge(
        world: World,
        a: c_int,
        b: c_int,
        frame_a: *const f32,
        frame_b: *const f32,
        low: f32,
        high: f32,
        brake: f32,
    );
    fn bench_bullet_step(world: World, step: f32);
    fn bench_bullet_pose(world: World, body: c_int, pose: *mut f32);
    fn bench_bullet_version() -> c_int;
}

/// A world, which lives as long as the program.
pub struct Bullet {
    world: World,
    bodies: c_int,
}

fn vector(v: Vec3) -> [f32; 3] {
    v.to_array().map(|x| x as f32)
}

fn frame(pose: &Pose) -> [f32; 7] {
    let (p, q) = (pose.position, pose.rotation);
    [p.x, p.y, p.z, q.x, q.y, q.z, q.w].map(|x| x as f32)
}

impl Bullet {
    /// The scene in Bullet.
    pub fn new(scene: &Scene) -> Self {
        // SAFETY: the world is never freed.
        let world = unsafe { bench_bullet_world(scene.gravity as f32, scene.sleeping) };
        let engine = Self { world, bodies: scene.solids.len() as c_int };
        for solid in &scene.solids {
            engine.add(scene, solid);
        }
        for joint in &scene.joints {
            engine.join(scene, joint);
        }
        engine
    }

    fn add(&self, scene: &Scene, solid: &Solid) {
        let (mass, inertia) = mass(solid);
        // Bullet multiplies the coefficients of two bodies.
        let friction = scene.friction.sqrt() as f32;
        // SAFETY: arrays have the lengths that `bullet.cpp` reads, and those that it keeps (a mesh's) are never freed.
        unsafe {
            let shape = match &solid.form {
                Form::Cuboid(sides) => bench_bullet_box(vector(*sides).as_ptr()),
                Form::Sphere(radius) => bench_bullet_sphere(*radius as f32),
                Form::Capsule(radius, length) => bench_bullet_capsule(*radius as f32, *length as f32),
                Form::Cylinder(radius, length) => bench_bullet_cylinder(*radius as f32, *length as f32),
                Form::Mesh(vertices, triangles) => {
                    let vertices: &'static mut [f32] =
                        vertices.iter().copied().flat_map(vector).collect::<Vec<_>>().leak();
                    let indices: &'static mut [c_int] =
                        triangles.iter().flatten().map(|i| *i as c_int).collect::<Vec<_>>().leak();
                    let (corners, count) = (vertices.len() / 3, indices.len() / 3);
                    let (vertices, indices) = (vertices.as_mut_ptr(), indices.as_mut_ptr());
                    bench_bullet_mesh(vertices, corners as c_int, indices, count as c_int)
                }
            };
            let (pose, velocity, inertia) = (frame(&solid.pose), vector(solid.velocity), vector(inertia));
            bench_bullet_body(
                self.world,
                shape,
                pose.as_ptr(),
                velocity.as_ptr(),
                mass as f32,
                inertia.as_ptr(),
                friction,
                solid.ghost,
            );
        }
    }

    fn join(&self, scene: &Scene, joint: &Joint) {
        let (a, b) = (joint.a as c_int, joint.b.map_or(-1, |b| b as c_int));
        // SAFETY: both bodies have been added, and arrays have the lengths that `bullet.cpp` reads.
        unsafe {
            match joint.link {
                Link::Ball => {
                    let (at_a, at_b) = frames(scene, joint, Quat::IDENTITY);
                    let (at_a, at_b) = (vector(at_a.position), vector(at_b.position));
                    bench_bullet_ball(self.world, a, b, at_a.as_ptr(), at_b.as_ptr());
                }
                Link::Hinge { axis, stops, brake } => {
                    let (on_a, on_b) = frames(scene, joint, along_z(axis));
                    let (low, high) = stops.unwrap_or((1.0, -1.0));
                    let impulse = brake.unwrap_or(0.0) * STEP;
                    bench_bullet_hinge(
                        self.world,
                        a,
                        b,
                        frame(&on_a).as_ptr(),
                        frame(&on_b).as_ptr(),
                        low as f32,
                        high as f32,
                        impulse as f32,
                    );
                }
            }
        }
    }
}

impl Engine for Bullet {
    fn about(&self) -> String {
        // SAFETY: it only returns a number.
        let version = unsafe { bench_bullet_version() };
        let (major, minor) = (version / 100, version % 100);
        format!(
            "bullet {major}.{minor} (as installed, single precision), btDiscreteDynamicsWorld with sequential impulses, its defaults"
        )
    }

    fn step(&mut self) {
        // SAFETY: the world lives.
        unsafe { bench_bullet_step(self.world, STEP as f32) };
    }

    fn poses(&self, out: &mut Vec<Pose>) {
        out.clear();
        out.extend((0..self.bodies).map(|i| {
            let mut pose = [0.0; 7];
            // SAFETY: there are so many bodies, and a pose has seven numbers.
            unsafe { bench_bullet_pose(self.world, i, pose.as_mut_ptr()) };
            let [x, y, z, i, j, k, w] = pose.map(f64::from);
            Pose::new(Vec3::new(x, y, z), Quat::from_parts(w, Vec3::new(i, j, k)))
        }));
    }
}
