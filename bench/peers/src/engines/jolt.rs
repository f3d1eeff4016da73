//! Jolt through its C wrapper. This file is not safe Rust.

use super::parts::{groups, mass};
use crate::engine::Engine;
use crate::scene::{Form, Joint, Link, STEP, Scene, Solid};
use core::f64::consts::FRAC_PI_2;
use core::ffi::c_void;
use core::mem::zeroed;
use ferrode_math::{Pose, Quat, Vec3};
use oxijolt_sys::*;
use std::sync::OnceLock;

/// A world, which lives as long as the program.
pub struct Jolt {
    system: *mut JPH_PhysicsSystem,
    interface: *mut JPH_BodyInterface,
    jobs: *mut JPH_JobSystem,
    memory: *mut JPH_TempAllocator,
    bodies: Vec<(*mut JPH_Body, JPH_BodyID)>,
}

/// Layers of its collision filter, and those of its broad phase.
const FIXED: u32 = 0;
const SOLID: u32 = 1;
const GHOST: u32 = 2;
const LAYERS: u32 = 3;
const STILL: u8 = 0;
const MOVING: u8 = 1;

/// Room for what a step needs, of which only what it uses is ever touched.
const STEP_MEMORY: u32 = 256 << 20;

fn vector(v: Vec3) -> JPH_Vec3 {
    JPH_Vec3 { x: v.x as f32, y: v.y as f32, z: v.z as f32 }
}

fn quaternion(q: Quat) -> JPH_Quat {
    JPH_Quat { x: q.x as f32, y: q.y as f32, z: q.z as f32, w: q.w as f32 }
}

/// Runs a job at once, on the thread that queues it.
unsafe extern "C" fn run_job(_: *mut c_void, job: JPH_JobFunction, argument: *mut c_void) {
    if let Some(job) = job {
        // SAFETY: each job is run once, with its own argument.
        unsafe { job(argument) };
    }
}

unsafe extern "C" fn run_jobs(_: *mut c_void, job: JPH_JobFunction, arguments: *mut *mut c_void, count: u32) {
    for i in 0..count as usize {
        // SAFETY: as above; there are so many arguments.
        unsafe { run_job(core::ptr::null_mut(), job, *arguments.add(i)) };
    }
}

impl Jolt {
    /// The scene in Jolt. Panics if it does not take it.
    pub fn new(scene: &Scene, threads: usize) -> Self {
        static STARTED: OnceLock<bool> = OnceLock::new();
        // SAFETY: the library is started first; handles are those that it returned, and none is freed.
        unsafe {
            assert!(*STARTED.get_or_init(|| JPH_Init()), "Jolt starts");
            let system = system(scene.solids.len() as u32);
            JPH_PhysicsSystem_SetGravity(system, &vector(Vec3::Z * -scene.gravity));
            let jobs = if threads == 1 {
                JPH_JobSystemCallback_Create(&JPH_JobSystemConfig {
                    queueJob: Some(run_job),
                    queueJobs: Some(run_jobs),
                    maxConcurrency: 1,
                    ..zeroed()
                })
            } else {
                // The thread that steps works too.
                let workers = threads as i32 - 1;
                JPH_JobSystemThreadPool_Create(&JobSystemThreadPoolConfig { numThreads: workers, ..zeroed() })
            };
            let interface = JPH_PhysicsSystem_GetBodyInterfaceNoLock(system);
            let memory = JPH_TempAllocator_Create(STEP_MEMORY);
            let mut engine = Self { system, interface, jobs, memory, bodies: Vec::new() };
            let filters = filters(scene);
            for (solid, filter) in scene.solids.iter().zip(&filters) {
                engine.add(scene, solid, filter.as_ref());
            }
            JPH_PhysicsSystem_OptimizeBroadPhase(system);
            for joint in &scene.joints {
                engine.join(joint);
            }
            engine
        }
    }

    /// # Safety
    /// The system lives, and so does the filter of the group.
    unsafe fn add(&mut self, scene: &Scene, solid: &Solid, group: Option<&JPH_CollisionGroup>) {
        let moves = solid.density.is_some();
        let (motion, layer) = match (moves, solid.ghost) {
            (false, _) => (JPH_MotionType_Static, FIXED),
            (true, false) => (JPH_MotionType_Dynamic, SOLID),
            (true, true) => (JPH_MotionType_Dynamic, GHOST),
        };
        // SAFETY: as the caller says; settings are copied.
        unsafe {
            let (p, q) = (vector(solid.pose.position), quaternion(solid.pose.rotation));
            let settings = JPH_BodyCreationSettings_Create3(shape(&solid.form), &p, &q, motion, layer);
            JPH_BodyCreationSettings_SetFriction(settings, scene.friction as f32);
            JPH_BodyCreationSettings_SetAllowSleeping(settings, scene.sleeping);
            if moves {
                // The scene has no air.
                JPH_BodyCreationSettings_SetLinearDamping(settings, 0.0);
                JPH_BodyCreationSettings_SetAngularDamping(settings, 0.0);
                JPH_BodyCreationSettings_SetLinearVelocity(settings, &vector(solid.velocity));
                let (mass, moments) = mass(solid);
                let mut inertia: JPH_Mat4 = zeroed();
                inertia.column[0].x = moments.x as f32;
                inertia.column[1].y = moments.y as f32;
                inertia.column[2].z = moments.z as f32;
                inertia.column[3].w = 1.0;
                let given = JPH_OverrideMassProperties_MassAndInertiaProvided;
                JPH_BodyCreationSettings_SetOverrideMassProperties(settings, given);
                let mass = JPH_MassProperties { mass: mass as f32, inertia };
                JPH_BodyCreationSettings_SetMassPropertiesOverride(settings, &mass);
            }
            if let Some(group) = group {
                JPH_BodyCreationSettings_SetCollisionGroup(settings, group);
            }
            let body = JPH_BodyInterface_CreateBody(self.interface, settings);
            assert!(!body.is_null(), "{}: Jolt has room for all bodies", scene.name);
            JPH_BodyCreationSettings_Destroy(settings);
            let id = JPH_Body_GetID(body);
            let wake = if moves { JPH_Activation_Activate } else { JPH_Activation_DontActivate };
            JPH_BodyInterface_AddBody(self.interface, id, wake);
            self.bodies.push((body, id));
        }
    }

    /// # Safety
    /// All solids have been added.
    unsafe fn join(&self, joint: &Joint) {
        // SAFETY: as the caller says.
        unsafe {
            let first = joint.b.map_or(JPH_Body_GetFixedToWorldBody(), |b| self.bodies[b].0);
            let (second, at) = (self.bodies[joint.a].0, vector(joint.anchor));
            let constraint: *mut JPH_Constraint = match joint.link {
                Link::Ball => {
                    let mut settings = zeroed();
                    JPH_PointConstraintSettings_Init(&mut settings);
                    settings.space = JPH_ConstraintSpace_WorldSpace;
                    (settings.point1, settings.point2) = (at, at);
                    JPH_PointConstraint_Create(&settings, first, second).cast()
                }
                Link::Hinge { axis, stops, brake } => {
                    let mut settings = zeroed();
                    JPH_HingeConstraintSettings_Init(&mut settings);
                    settings.space = JPH_ConstraintSpace_WorldSpace;
                    (settings.point1, settings.point2) = (at, at);
                    let turn = super::parts::along_z(axis);
                    let (axis, normal) = (vector(axis), vector(turn.rotate(Vec3::X)));
                    (settings.hingeAxis1, settings.hingeAxis2) = (axis, axis);
                    (settings.normalAxis1, settings.normalAxis2) = (normal, normal);
                    if let Some((low, high)) = stops {
                        (settings.limitsMin, settings.limitsMax) = (low as f32, high as f32);
                    }
                    settings.maxFrictionTorque = brake.unwrap_or(0.0) as f32;
                    JPH_HingeConstraint_Create(&settings, first, second).cast()
                }
            };
            JPH_PhysicsSystem_AddConstraint(self.system, constraint);
        }
    }
}

/// A world with room for so many bodies and their contacts.
///
/// # Safety
/// The library has been started.
unsafe fn system(bodies: u32) -> *mut JPH_PhysicsSystem {
    // SAFETY: handles come from the calls just before.
    unsafe {
        let pairs = JPH_ObjectLayerPairFilterTable_Create(LAYERS);
        for (a, b) in [(FIXED, SOLID), (FIXED, GHOST), (SOLID, SOLID), (SOLID, GHOST)] {
            JPH_ObjectLayerPairFilterTable_EnableCollision(pairs, a, b);
        }
        let broad = JPH_BroadPhaseLayerInterfaceTable_Create(LAYERS, 2);
        for (layer, below) in [(FIXED, STILL), (SOLID, MOVING), (GHOST, MOVING)] {
            JPH_BroadPhaseLayerInterfaceTable_MapObjectToBroadPhaseLayer(broad, layer, below);
        }
        let system = JPH_PhysicsSystem_Create(&JPH_PhysicsSystemSettings {
            maxBodies: bodies.max(1024),
            maxBodyPairs: (16 * bodies).max(65536),
            maxContactConstraints: (8 * bodies).max(10240),
            broadPhaseLayerInterface: broad,
            objectLayerPairFilter: pairs,
            objectVsBroadPhaseLayerFilter: JPH_ObjectVsBroadPhaseLayerFilterTable_Create(
                broad, 2, pairs, LAYERS,
            ),
            ..zeroed()
        });
        assert!(!system.is_null(), "Jolt makes a world");
        system
    }
}

/// Of each solid with joints, the group in which it meets all but those that it is joined to.
///
/// # Safety
/// The library has been started.
unsafe fn filters(scene: &Scene) -> Vec<Option<JPH_CollisionGroup>> {
    let (group, member, sizes) = groups(scene);
    // SAFETY: members are fewer than their group's size.
    unsafe {
        let tables: Vec<_> = sizes.iter().map(|size| JPH_GroupFilterTable_Create(*size)).collect();
        for joint in &scene.joints {
            let Some(b) = joint.b else { continue };
            JPH_GroupFilterTable_DisableCollision(tables[group[b] as usize], member[joint.a], member[b]);
        }
        let of = |i: usize| {
            let filter: *const JPH_GroupFilter = tables[group[i] as usize].cast();
            let group = JPH_CollisionGroup { groupFilter: filter, groupID: group[i], subGroupID: member[i] };
            (sizes[group.groupID as usize] > 1).then_some(group)
        };
        (0..scene.solids.len()).map(of).collect()
    }
}

/// # Safety
/// The library has been started.
unsafe fn shape(form: &Form) -> *const JPH_Shape {
    // Its capsules and cylinders lie along y.
    let upright = |shape: *const JPH_Shape| {
        let turn = quaternion(Quat::from_axis_angle(Vec3::X, FRAC_PI_2));
        // SAFETY: the shape was made just before.
        unsafe { JPH_RotatedTranslatedShape_Create(&vector(Vec3::ZERO), &turn, shape).cast_const().cast() }
    };
    // SAFETY: arrays have the lengths given and are copied.
    unsafe {
        match form {
            Form::Cuboid(sides) => {
                // Thinner boxes than its default allows have sharper edges.
                let round = (0.25 * sides.x.min(sides.y).min(sides.z)).min(JPH_DEFAULT_CONVEX_RADIUS);
                JPH_BoxShape_Create(&vector(*sides * 0.5), round as f32).cast_const().cast()
            }
            Form::Sphere(radius) => JPH_SphereShape_Create(*radius as f32).cast_const().cast(),
            Form::Capsule(radius, length) => {
                upright(JPH_CapsuleShape_Create((0.5 * length) as f32, *radius as f32).cast_const().cast())
            }
            Form::Cylinder(radius, length) => {
                upright(JPH_CylinderShape_Create((0.5 * length) as f32, *radius as f32).cast_const().cast())
            }
            Form::Mesh(vertices, triangles) => {
                let vertices: Vec<JPH_Vec3> = vertices.iter().copied().map(vector).collect();
                let triangle = |[i1, i2, i3]: &[u32; 3]| JPH_IndexedTriangle {
                    i1: *i1,
                    i2: *i2,
                    i3: *i3,
                    materialIndex: 0,
                    userData: 0,
                };
                let triangles: Vec<JPH_IndexedTriangle> = triangles.iter().map(triangle).collect();
                let (corners, count) = (vertices.len() as u32, triangles.len() as u32);
                let settings =
                    JPH_MeshShapeSettings_Create2(vertices.as_ptr(), corners, triangles.as_ptr(), count);
                let mesh = JPH_MeshShapeSettings_CreateShape(settings);
                assert!(!mesh.is_null(), "Jolt takes the mesh");
                mesh.cast_const().cast()
            }
        }
    }
}

impl Engine for Jolt {
    fn about(&self) -> String {
        "jolt 5.6.0 (binding oxijolt-sys 1.5.0), its defaults, 1 collision step, without its damping".into()
    }

    fn step(&mut self) {
        // SAFETY: all live.
        let error = unsafe { JPH_PhysicsSystem_Update2(self.system, STEP as f32, 1, self.memory, self.jobs) };
        assert_eq!(error, JPH_PhysicsUpdateError_None, "Jolt has room for all contacts");
    }

    fn poses(&self, out: &mut Vec<Pose>) {
        out.clear();
        out.extend(self.bodies.iter().map(|(_, id)| {
            // SAFETY: the bodies live.
            unsafe {
                let (mut p, mut q) = (zeroed(), zeroed());
                JPH_BodyInterface_GetPositionAndRotation(self.interface, *id, &mut p, &mut q);
                let turn = Vec3::new(q.x.into(), q.y.into(), q.z.into());
                Pose::new(Vec3::new(p.x.into(), p.y.into(), p.z.into()), Quat::from_parts(q.w.into(), turn))
            }
        }));
    }
}
