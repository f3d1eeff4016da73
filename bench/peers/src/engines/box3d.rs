//! Box3D through its C interface. This file is not safe Rust.

use super::parts::along_z;
use crate::engine::Engine;
use crate::scene::{Form, Joint, Link, STEP, Scene, Solid};
use box3d_sys as sys;
use ferrode_math::{Pose, Quat, Vec3, real};

/// A world, which lives as long as the program.
pub struct Box3d {
    world: sys::b3WorldId,
    bodies: Vec<sys::b3BodyId>,
}

fn vector(v: Vec3) -> sys::b3Vec3 {
    sys::b3Vec3 { x: v.x as f32, y: v.y as f32, z: v.z as f32 }
}

fn quaternion(q: Quat) -> sys::b3Quat {
    sys::b3Quat { v: vector(Vec3::new(q.x, q.y, q.z)), s: q.w as f32 }
}

impl Box3d {
    /// The scene in Box3D.
    pub fn new(scene: &Scene, threads: usize) -> Self {
        // SAFETY: definitions come from the library's own defaults; handles are those it returned.
        unsafe {
            let mut def = sys::b3DefaultWorldDef();
            def.gravity = vector(Vec3::Z * -scene.gravity);
            def.enableSleep = scene.sleeping;
            def.workerCount = threads as u32;
            let world = sys::b3CreateWorld(&def);
            let bodies = scene.solids.iter().map(|solid| add(world, scene, solid)).collect();
            let engine = Self { world, bodies };
            let origin = sys::b3CreateBody(world, &sys::b3DefaultBodyDef());
            for joint in &scene.joints {
                engine.join(scene, joint, origin);
            }
            engine
        }
    }

    /// # Safety
    /// The world and its bodies live.
    unsafe fn join(&self, scene: &Scene, joint: &Joint, origin: sys::b3BodyId) {
        let frame = |solid: Option<usize>, turn: Quat| {
            let pose = solid.map_or(Pose::IDENTITY, |i| scene.solids[i].pose);
            let local = pose.rotation.conjugate() * turn;
            sys::b3Transform { p: vector(pose.inverse_transform_point(joint.anchor)), q: quaternion(local) }
        };
        let place = |base: &mut sys::b3JointDef, turn: Quat| {
            base.bodyIdA = self.bodies[joint.a];
            base.bodyIdB = joint.b.map_or(origin, |b| self.bodies[b]);
            base.localFrameA = frame(Some(joint.a), turn);
            base.localFrameB = frame(joint.b, turn);
            base.collideConnected = false;
        };
        // SAFETY: as the caller says.
        unsafe {
            match joint.link {
                Link::Ball => {
                    let mut def = sys::b3DefaultSphericalJointDef();
                    place(&mut def.base, Quat::IDENTITY);
                    sys::b3CreateSphericalJoint(self.world, &def);
                }
                Link::Hinge { axis, stops, brake } => {
                    let mut def = sys::b3DefaultRevoluteJointDef();
                    place(&mut def.base, along_z(axis));
                    if let Some((low, high)) = stops {
                        // Box3D turns the second body against the first.
                        (def.enableLimit, def.lowerAngle, def.upperAngle) = (true, -high as f32, -low as f32);
                    }
                    if let Some(torque) = brake {
                        (def.enableMotor, def.motorSpeed, def.maxMotorTorque) = (true, 0.0, torque as f32);
                    }
                    sys::b3CreateRevoluteJoint(self.world, &def);
                }
            }
        }
    }
}

/// # Safety
/// The world lives.
unsafe fn add(world: sys::b3WorldId, scene: &Scene, solid: &Solid) -> sys::b3BodyId {
    // SAFETY: as the caller says; what the library keeps by pointer (a mesh) is never freed.
    unsafe {
        let mut def = sys::b3DefaultBodyDef();
        if solid.density.is_some() {
            def.type_ = sys::b3BodyType_b3_dynamicBody;
        }
        def.position = vector(solid.pose.position);
        def.rotation = quaternion(solid.pose.rotation);
        def.linearVelocity = vector(solid.velocity);
        let body = sys::b3CreateBody(world, &def);
        let mut shape = sys::b3DefaultShapeDef();
        shape.density = solid.density.unwrap_or(1000.0) as f32;
        shape.baseMaterial.friction = scene.friction as f32;
        (shape.filter.categoryBits, shape.filter.maskBits) = if solid.ghost { (2, 1) } else { (1, u64::MAX) };
        let along = |half: f64| vector(Vec3::Z * half);
        match &solid.form {
            Form::Cuboid(sides) => {
                let half = vector(*sides * 0.5);
                let hull = sys::b3MakeBoxHull(half.x, half.y, half.z);
                sys::b3CreateHullShape(body, &shape, &hull.base);
            }
            Form::Sphere(radius) => {
                let sphere = sys::b3Sphere { center: along(0.0), radius: *radius as f32 };
                sys::b3CreateSphereShape(body, &shape, &sphere);
            }
            Form::Capsule(radius, length) => {
                let (center1, center2) = (along(-0.5 * length), along(0.5 * length));
                let capsule = sys::b3Capsule { center1, center2, radius: *radius as f32 };
                sys::b3CreateCapsuleShape(body, &shape, &capsule);
            }
            Form::Cylinder(radius, length) => {
                // It has no cylinders: a prism of 16 sides.
                let corner = |i: u32| {
                    let angle = f64::from(i % 16) * core::f64::consts::TAU / 16.0;
                    let z = if i < 16 { -0.5 } else { 0.5 };
                    vector(Vec3::new(radius * real::cos(angle), radius * real::sin(angle), z * length))
                };
                let corners: Vec<sys::b3Vec3> = (0..32).map(corner).collect();
                let hull = sys::b3CreateHull(corners.as_ptr(), corners.len() as i32, 32);
                assert!(!hull.is_null(), "Box3D takes a prism for a hull");
                sys::b3CreateHullShape(body, &shape, hull);
            }
            Form::Mesh(vertices, triangles) => {
                let vertices: &'static mut [_] =
                    vertices.iter().copied().map(vector).collect::<Vec<_>>().leak();
                let indices: &'static mut [_] =
                    triangles.iter().flatten().map(|i| *i as i32).collect::<Vec<_>>().leak();
                let def = sys::b3MeshDef {
                    vertices: vertices.as_mut_ptr(),
                    indices: indices.as_mut_ptr(),
                    materialIndices: core::ptr::null_mut(),
                    weldTolerance: 0.0,
                    vertexCount: vertices.len() as i32,
                    triangleCount: triangles.len() as i32,
                    weldVertices: false,
                    useMedianSplit: false,
                    identifyEdges: true,
                };
                let mesh = sys::b3CreateMesh(&def, core::ptr::null_mut(), 0);
                assert!(!mesh.is_null(), "Box3D takes the mesh");
                sys::b3CreateMeshShape(body, &shape, mesh, vector(Vec3::splat(1.0)));
            }
        }
        body
    }
}

impl Engine for Box3d {
    fn about(&self) -> String {
        "box3d (binding box3d-sys 0.1.16), its defaults, 4 substeps".into()
    }

    fn step(&mut self) {
        // SAFETY: the world lives.
        unsafe { sys::b3World_Step(self.world, STEP as f32, 4) };
    }

    fn poses(&self, out: &mut Vec<Pose>) {
        let wide = |v: sys::b3Vec3| Vec3::new(v.x.into(), v.y.into(), v.z.into());
        out.clear();
        out.extend(self.bodies.iter().map(|body| {
            // SAFETY: the bodies live.
            let (p, q) = unsafe { (sys::b3Body_GetPosition(*body), sys::b3Body_GetRotation(*body)) };
            Pose::new(wide(p), Quat::from_parts(q.s.into(), wide(q.v)))
        }));
    }
}
