//! PhysX through its binding, rigid bodies and joints in maximal coordinates. This file is not safe Rust.

use super::parts::{along_x, frames, mass};
use crate::engine::Engine;
use crate::scene::{Form, Joint, Link, STEP, Scene, Solid};
use core::f64::consts::{FRAC_PI_2, TAU};
use core::ptr::{null, null_mut};
use ferrode_math::{Pose, Quat, Vec3, real};
use physx_sys::*;
use std::sync::OnceLock;

/// Which of its solvers.
#[derive(Clone, Copy)]
pub enum Solver {
    /// Its default, projected Gauss-Seidel.
    Default,
    /// The same with small steps inside ("temporal").
    Tgs,
}

/// A world, which lives as long as the program.
pub struct Physx {
    scene: *mut PxScene,
    actors: Vec<*mut PxRigidActor>,
    solver: Solver,
}

/// Groups of its filter.
const SOLID: u16 = 1;
const GHOST: u16 = 2;

/// What a program has one of.
struct Shared(*mut PxPhysics);

// SAFETY: PhysX allows calls to it from any thread.
unsafe impl Send for Shared {}
// SAFETY: as above.
unsafe impl Sync for Shared {}

fn physics() -> *mut PxPhysics {
    static PHYSICS: OnceLock<Shared> = OnceLock::new();
    let start = || {
        // SAFETY: this runs once.
        unsafe {
            phys_PxSetGroupCollisionFlag(GHOST, GHOST, false);
            Shared(physx_create_physics(physx_create_foundation()))
        }
    };
    PHYSICS.get_or_init(start).0
}

fn vector(v: Vec3) -> PxVec3 {
    PxVec3 { x: v.x as f32, y: v.y as f32, z: v.z as f32 }
}

fn transform(pose: &Pose) -> PxTransform {
    let q = pose.rotation;
    let q = PxQuat { x: q.x as f32, y: q.y as f32, z: q.z as f32, w: q.w as f32 };
    PxTransform { q, p: vector(pose.position) }
}

impl Physx {
    /// The scene in PhysX. Panics if it does not take it.
    pub fn new(scene: &Scene, threads: usize, solver: Solver) -> Self {
        // SAFETY: descriptions come from the library's own defaults; handles are those it returned, and none is freed.
        unsafe {
            let physics = physics();
            let mut desc = PxSceneDesc_new(PxPhysics_getTolerancesScale(physics));
            desc.gravity = vector(Vec3::Z * -scene.gravity);
            desc.filterShader = get_default_simulation_filter_shader();
            if let Solver::Tgs = solver {
                desc.solverType = PxSolverType::Tgs;
            }
            // The thread that steps works only if there are no others.
            let workers = if threads == 1 { 0 } else { threads as u32 };
            let wait = PxDefaultCpuDispatcherWaitForWorkMode::WaitForWork;
            desc.cpuDispatcher = phys_PxDefaultCpuDispatcherCreate(workers, null_mut(), wait, 0).cast();
            let world = PxPhysics_createScene_mut(physics, &desc);
            assert!(!world.is_null(), "PhysX makes a scene");
            let friction = scene.friction as f32;
            let material = PxPhysics_createMaterial_mut(physics, friction, friction, 0.0);
            let actors = scene.solids.iter().map(|solid| {
                let actor = actor(physics, material, scene, solid);
                PxScene_addActor_mut(world, actor.cast(), null());
                actor
            });
            let engine = Self { scene: world, actors: actors.collect(), solver };
            for joint in &scene.joints {
                engine.join(physics, scene, joint);
            }
            engine
        }
    }

    /// # Safety
    /// All solids have been added.
    unsafe fn join(&self, physics: *mut PxPhysics, scene: &Scene, joint: &Joint) {
        // PhysX turns the second actor against the first.
        let first = joint.b.map_or(null_mut(), |b| self.actors[b]);
        let second = self.actors[joint.a];
        // SAFETY: as the caller says.
        unsafe {
            match joint.link {
                Link::Ball => {
                    let (on_a, on_b) = frames(scene, joint, Quat::IDENTITY);
                    let (on_a, on_b) = (transform(&on_a), transform(&on_b));
                    let ball = phys_PxSphericalJointCreate(physics, first, &on_b, second, &on_a);
                    assert!(!ball.is_null(), "PhysX makes a joint");
                }
                Link::Hinge { axis, stops, brake } => {
                    let (on_a, on_b) = frames(scene, joint, along_x(axis));
                    let (on_a, on_b) = (transform(&on_a), transform(&on_b));
                    let hinge = phys_PxRevoluteJointCreate(physics, first, &on_b, second, &on_a);
                    assert!(!hinge.is_null(), "PhysX makes a joint");
                    if let Some((low, high)) = stops {
                        let limit = PxJointAngularLimitPair_new(low as f32, high as f32, -1.0);
                        PxRevoluteJoint_setLimit_mut(hinge, &limit);
                        let flag = PxRevoluteJointFlag::LimitEnabled;
                        PxRevoluteJoint_setRevoluteJointFlag_mut(hinge, flag, true);
                    }
                    if let Some(torque) = brake {
                        let flag = PxConstraintFlag::DriveLimitsAreForces;
                        PxJoint_setConstraintFlag_mut(hinge.cast(), flag, true);
                        PxRevoluteJoint_setDriveVelocity_mut(hinge, 0.0, true);
                        PxRevoluteJoint_setDriveForceLimit_mut(hinge, torque as f32);
                        let flag = PxRevoluteJointFlag::DriveEnabled;
                        PxRevoluteJoint_setRevoluteJointFlag_mut(hinge, flag, true);
                    }
                }
            }
        }
    }
}

/// # Safety
/// Physics and material live.
unsafe fn actor(
    physics: *mut PxPhysics,
    material: *mut PxMaterial,
    scene: &Scene,
    solid: &Solid,
) -> *mut PxRigidActor {
    // SAFETY: as the caller says; geometries are copied.
    unsafe {
        let pose = transform(&solid.pose);
        let actor: *mut PxRigidActor = match solid.density {
            Some(_) => PxPhysics_createRigidDynamic_mut(physics, &pose).cast(),
            None => PxPhysics_createRigidStatic_mut(physics, &pose).cast(),
        };
        let attach = |geometry: *const PxGeometry, at: &Pose| {
            let flags = PxShapeFlags::SimulationShape | PxShapeFlags::SceneQueryShape;
            let shape = PxPhysics_createShape_mut(physics, geometry, material, true, flags);
            PxShape_setLocalPose_mut(shape, &transform(at));
            PxRigidActor_attachShape_mut(actor, shape);
        };
        let none = Pose::IDENTITY;
        match &solid.form {
            Form::Cuboid(sides) => {
                let cuboid = PxBoxGeometry_new_1(vector(*sides * 0.5));
                attach((&raw const cuboid).cast(), &none);
            }
            Form::Sphere(radius) => {
                let sphere = PxSphereGeometry_new(*radius as f32);
                attach((&raw const sphere).cast(), &none);
            }
            Form::Capsule(radius, length) => {
                // Its capsules lie along x.
                let upright = Pose::new(Vec3::ZERO, Quat::from_axis_angle(Vec3::Y, FRAC_PI_2));
                let capsule = PxCapsuleGeometry_new(*radius as f32, (0.5 * length) as f32);
                attach((&raw const capsule).cast(), &upright);
            }
            Form::Cylinder(radius, length) => {
                let hull = prism(physics, *radius, *length);
                attach((&raw const hull).cast(), &none);
            }
            Form::Mesh(vertices, triangles) => {
                let mesh = mesh(physics, vertices, triangles);
                attach((&raw const mesh).cast(), &none);
            }
        }
        phys_PxSetGroup(actor.cast(), if solid.ghost { GHOST } else { SOLID });
        if solid.density.is_some() {
            let (mass, moments) = mass(solid);
            let body: *mut PxRigidBody = actor.cast();
            PxRigidBody_setMass_mut(body, mass as f32);
            PxRigidBody_setMassSpaceInertiaTensor_mut(body, &vector(moments));
            // The scene has no air.
            PxRigidBody_setLinearDamping_mut(body, 0.0);
            PxRigidBody_setAngularDamping_mut(body, 0.0);
            let body: *mut PxRigidDynamic = actor.cast();
            PxRigidDynamic_setLinearVelocity_mut(body, &vector(solid.velocity), true);
            if !scene.sleeping {
                PxRigidDynamic_setSleepThreshold_mut(body, 0.0);
            }
        }
        actor
    }
}

/// It has no cylinders: a prism of 16 sides.
///
/// # Safety
/// Physics lives.
unsafe fn prism(physics: *mut PxPhysics, radius: f64, length: f64) -> PxConvexMeshGeometry {
    let corner = |i: u32| {
        let angle = f64::from(i % 16) * TAU / 16.0;
        let z = if i < 16 { -0.5 } else { 0.5 };
        vector(Vec3::new(radius * real::cos(angle), radius * real::sin(angle), z * length))
    };
    let corners: Vec<PxVec3> = (0..32).map(corner).collect();
    // SAFETY: as the caller says; the corners are copied.
    unsafe {
        let mut desc = PxConvexMeshDesc_new();
        desc.points.stride = size_of::<PxVec3>() as u32;
        desc.points.data = corners.as_ptr().cast();
        desc.points.count = corners.len() as u32;
        desc.flags = PxConvexFlags::ComputeConvex;
        let params = PxCookingParams_new(PxPhysics_getTolerancesScale(physics));
        let place = PxPhysics_getPhysicsInsertionCallback_mut(physics);
        let hull = phys_PxCreateConvexMesh(&params, &desc, place, null_mut());
        assert!(!hull.is_null(), "PhysX takes a prism for a hull");
        PxConvexMeshGeometry_new(hull, &PxMeshScale_new(), PxConvexMeshGeometryFlags::empty())
    }
}

/// # Safety
/// Physics lives.
unsafe fn mesh(physics: *mut PxPhysics, vertices: &[Vec3], triangles: &[[u32; 3]]) -> PxTriangleMeshGeometry {
    let vertices: Vec<PxVec3> = vertices.iter().copied().map(vector).collect();
    // SAFETY: as the caller says; the arrays are copied.
    unsafe {
        let mut desc = PxTriangleMeshDesc_new();
        desc.points.stride = size_of::<PxVec3>() as u32;
        desc.points.data = vertices.as_ptr().cast();
        desc.points.count = vertices.len() as u32;
        desc.triangles.stride = size_of::<[u32; 3]>() as u32;
        desc.triangles.data = triangles.as_ptr().cast();
        desc.triangles.count = triangles.len() as u32;
        let params = PxCookingParams_new(PxPhysics_getTolerancesScale(physics));
        let place = PxPhysics_getPhysicsInsertionCallback_mut(physics);
        let mesh = phys_PxCreateTriangleMesh(&params, &desc, place, null_mut());
        assert!(!mesh.is_null(), "PhysX takes the mesh");
        PxTriangleMeshGeometry_new(mesh, &PxMeshScale_new(), PxMeshGeometryFlags::empty())
    }
}

impl Engine for Physx {
    fn about(&self) -> String {
        let solver = match self.solver {
            Solver::Default => "PGS, its defaults",
            Solver::Tgs => "TGS, else its defaults",
        };
        format!(
            "physx 5.1.3 (binding physx-sys 0.11.5), {solver}, without its damping; joints in maximal coordinates, prisms of 16 sides for cylinders"
        )
    }

    fn step(&mut self) {
        let mut error = 0;
        // SAFETY: the scene lives.
        unsafe {
            PxScene_simulate_mut(self.scene, STEP as f32, null_mut(), null_mut(), 0, true);
            PxScene_fetchResults_mut(self.scene, true, &mut error);
        }
        assert_eq!(error, 0, "PhysX steps");
    }

    fn poses(&self, out: &mut Vec<Pose>) {
        out.clear();
        out.extend(self.actors.iter().map(|actor| {
            // SAFETY: the actors live.
            let PxTransform { p, q } = unsafe { PxRigidActor_getGlobalPose(*actor) };
            let turn = Vec3::new(q.x.into(), q.y.into(), q.z.into());
            Pose::new(Vec3::new(p.x.into(), p.y.into(), p.z.into()), Quat::from_parts(q.w.into(), turn))
        }));
    }
}
