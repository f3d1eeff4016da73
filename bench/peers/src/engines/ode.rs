//! Installed libode (double precision) with `dWorldQuickStep`, contact joints and a hash space: as its manual has it. This
//! file is not safe Rust.

use crate::engine::Engine;
use crate::scene::{Form, Link, STEP, Scene};
use core::ffi::{c_int, c_uint, c_ulong, c_void};
use ferrode_math::{Pose, Quat, Vec3};

type Id = *mut c_void;

#[repr(C)]
#[derive(Clone, Copy, Default)]
struct Surface {
    mode: c_int,
    mu: f64,
    unused: [f64; 13],
}

#[repr(C)]
#[derive(Clone, Copy)]
struct ContactGeom {
    pos: [f64; 4],
    normal: [f64; 4],
    depth: f64,
    geoms: [Id; 2],
    sides: [c_int; 2],
}

#[repr(C)]
#[derive(Clone, Copy)]
struct Contact {
    surface: Surface,
    geom: ContactGeom,
    fdir1: [f64; 4],
}

#[repr(C)]
struct Mass {
    mass: f64,
    centre: [f64; 4],
    inertia: [f64; 12],
}

const APPROX1: c_int = 0x7000;
const PARAM_LO_STOP: c_int = 0;
const PARAM_HI_STOP: c_int = 1;
const PARAM_VEL: c_int = 2;
const PARAM_FMAX: c_int = 5;
/// Contacts of one pair.
const MAX_CONTACTS: usize = 8;

// A program built for the wrong layout must not run: these are the sizes of libode 0.16 in double precision.
const _: () = assert!(size_of::<Contact>() == 248 && size_of::<Mass>() == 136);

type NearCallback = extern "C" fn(*mut c_void, Id, Id);

#[link(name = "ode")]
unsafe extern "C" {
    fn dInitODE2(flags: c_uint) -> c_int;
    fn dRandSetSeed(seed: c_ulong);
    fn dWorldCreate() -> Id;
    fn dWorldSetGravity(world: Id, x: f64, y: f64, z: f64);
    fn dWorldSetAutoDisableFlag(world: Id, on: c_int);
    fn dWorldQuickStep(world: Id, h: f64) -> c_int;
    fn dBodyCreate(world: Id) -> Id;
    fn dBodySetMass(body: Id, mass: *const Mass);
    fn dBodySetPosition(body: Id, x: f64, y: f64, z: f64);
    fn dBodySetQuaternion(body: Id, q: *const f64);
    fn dBodySetLinearVel(body: Id, x: f64, y: f64, z: f64);
    fn dBodyGetPosition(body: Id) -> *const f64;
    fn dBodyGetQuaternion(body: Id) -> *const f64;
    fn dMassSetBox(mass: *mut Mass, density: f64, x: f64, y: f64, z: f64);
    fn dMassSetSphere(mass: *mut Mass, density: f64, radius: f64);
    fn dMassSetCapsule(mass: *mut Mass, density: f64, axis: c_int, radius: f64, length: f64);
    fn dMassSetCylinder(mass: *mut Mass, density: f64, axis: c_int, radius: f64, length: f64);
    fn dJointGroupCreate(unused: c_int) -> Id;
    fn dJointGroupEmpty(group: Id);
    fn dJointCreateContact(world: Id, group: Id, contact: *const Contact) -> Id;
    fn dJointCreateBall(world: Id, group: Id) -> Id;
    fn dJointCreateHinge(world: Id, group: Id) -> Id;
    fn dJointAttach(joint: Id, first: Id, second: Id);
    fn dJointSetBallAnchor(joint: Id, x: f64, y: f64, z: f64);
    fn dJointSetHingeAnchor(joint: Id, x: f64, y: f64, z: f64);
    fn dJointSetHingeAxis(joint: Id, x: f64, y: f64, z: f64);
    fn dJointSetHingeParam(joint: Id, parameter: c_int, value: f64);
    fn dAreConnectedExcluding(a: Id, b: Id, joint_type: c_int) -> c_int;
    fn dHashSpaceCreate(parent: Id) -> Id;
    fn dSpaceCollide(space: Id, data: *mut c_void, callback: NearCallback);
    fn dCollide(a: Id, b: Id, flags: c_int, contacts: *mut ContactGeom, skip: c_int) -> c_int;
    fn dGeomSetBody(geom: Id, body: Id);
    fn dGeomGetBody(geom: Id) -> Id;
    fn dGeomSetPosition(geom: Id, x: f64, y: f64, z: f64);
    fn dGeomSetQuaternion(geom: Id, q: *const f64);
    fn dGeomSetCategoryBits(geom: Id, bits: c_ulong);
    fn dGeomSetCollideBits(geom: Id, bits: c_ulong);
    fn dCreateBox(space: Id, x: f64, y: f64, z: f64) -> Id;
    fn dCreateSphere(space: Id, radius: f64) -> Id;
    fn dCreateCapsule(space: Id, radius: f64, length: f64) -> Id;
    fn dCreateCylinder(space: Id, radius: f64, length: f64) -> Id;
    fn dGeomTriMeshDataCreate() -> Id;
    fn dGeomTriMeshDataBuildDouble(
        data: Id,
        vertices: *const c_void,
        vertex_stride: c_int,
        vertex_count: c_int,
        indices: *const c_void,
        index_count: c_int,
        triangle_stride: c_int,
    );
    fn dCreateTriMesh(space: Id, data: Id, a: *const c_void, b: *const c_void, c: *const c_void) -> Id;
}

/// The type of contact joints.
const CONTACT: c_int = 4;

/// A world, which lives as long as the program.
pub struct Ode {
    world: Id,
    space: Id,
    contacts: Id,
    friction: f64,
    solids: Vec<Result<Id, Pose>>,
}

impl Ode {
    /// The scene in libode.
    pub fn new(scene: &Scene) -> Self {
        // SAFETY: the library is started first; every handle passed on was returned by it just before, and what it keeps by
        // pointer (a mesh's vertices and indices) is never freed.
        unsafe {
            dInitODE2(0);
            dRandSetSeed(0);
            let (world, space) = (dWorldCreate(), dHashSpaceCreate(core::ptr::null_mut()));
            dWorldSetGravity(world, 0.0, 0.0, -scene.gravity);
            dWorldSetAutoDisableFlag(world, c_int::from(scene.sleeping));
            let mut engine = Self {
                world,
                space,
                contacts: dJointGroupCreate(0),
                friction: scene.friction,
                solids: Vec::new(),
            };
            engine.add_solids(scene);
            engine.add_joints(scene);
            engine
        }
    }

    /// # Safety
    /// World and space live.
    unsafe fn add_solids(&mut self, scene: &Scene) {
        for solid in &scene.solids {
            let density = solid.density.unwrap_or(1000.0);
            let mut mass = Mass { mass: 0.0, centre: [0.0; 4], inertia: [0.0; 12] };
            let (p, q, v) = (solid.pose.position, solid.pose.rotation, solid.velocity);
            let q = [q.w, q.x, q.y, q.z];
            // SAFETY: handles live, and arrays have the library's layout.
            unsafe {
                let geom = match &solid.form {
                    Form::Cuboid(s) => {
                        dMassSetBox(&mut mass, density, s.x, s.y, s.z);
                        dCreateBox(self.space, s.x, s.y, s.z)
                    }
                    Form::Sphere(radius) => {
                        dMassSetSphere(&mut mass, density, *radius);
                        dCreateSphere(self.space, *radius)
                    }
                    Form::Capsule(radius, length) => {
                        dMassSetCapsule(&mut mass, density, 3, *radius, *length);
                        dCreateCapsule(self.space, *radius, *length)
                    }
                    Form::Cylinder(radius, length) => {
                        dMassSetCylinder(&mut mass, density, 3, *radius, *length);
                        dCreateCylinder(self.space, *radius, *length)
                    }
                    Form::Mesh(vertices, triangles) => self.mesh(vertices, triangles),
                };
                if solid.ghost {
                    dGeomSetCategoryBits(geom, 2);
                    dGeomSetCollideBits(geom, 1);
                } else {
                    dGeomSetCategoryBits(geom, 1);
                }
                if solid.density.is_none() {
                    dGeomSetPosition(geom, p.x, p.y, p.z);
                    dGeomSetQuaternion(geom, q.as_ptr());
                    self.solids.push(Err(solid.pose));
                    continue;
                }
                let body = dBodyCreate(self.world);
                dBodySetMass(body, &mass);
                dBodySetPosition(body, p.x, p.y, p.z);
                dBodySetQuaternion(body, q.as_ptr());
                dBodySetLinearVel(body, v.x, v.y, v.z);
                dGeomSetBody(geom, body);
                self.solids.push(Ok(body));
            }
        }
    }

    /// # Safety
    /// The space lives.
    unsafe fn mesh(&self, vertices: &[Vec3], triangles: &[[u32; 3]]) -> Id {
        let vertices: &'static [[f64; 3]] = vertices.iter().map(|v| v.to_array()).collect::<Vec<_>>().leak();
        let triangles: &'static [[u32; 3]] = triangles.to_vec().leak();
        // SAFETY: the arrays are never freed, and have the counts and strides that are given.
        unsafe {
            let data = dGeomTriMeshDataCreate();
            dGeomTriMeshDataBuildDouble(
                data,
                vertices.as_ptr().cast(),
                size_of::<[f64; 3]>() as c_int,
                vertices.len() as c_int,
                triangles.as_ptr().cast(),
                3 * triangles.len() as c_int,
                size_of::<[u32; 3]>() as c_int,
            );
            let null = core::ptr::null();
            dCreateTriMesh(self.space, data, null, null, null)
        }
    }

    /// # Safety
    /// All solids are alive.
    unsafe fn add_joints(&self, scene: &Scene) {
        let body = |i: usize| self.solids[i].unwrap_or(core::ptr::null_mut());
        for joint in &scene.joints {
            let (a, b, at) = (body(joint.a), joint.b.map_or(core::ptr::null_mut(), body), joint.anchor);
            // SAFETY: world and bodies live.
            unsafe {
                match joint.link {
                    Link::Ball => {
                        let ball = dJointCreateBall(self.world, core::ptr::null_mut());
                        dJointAttach(ball, a, b);
                        dJointSetBallAnchor(ball, at.x, at.y, at.z);
                    }
                    Link::Hinge { axis, stops, brake } => {
                        let hinge = dJointCreateHinge(self.world, core::ptr::null_mut());
                        dJointAttach(hinge, a, b);
                        dJointSetHingeAnchor(hinge, at.x, at.y, at.z);
                        dJointSetHingeAxis(hinge, axis.x, axis.y, axis.z);
                        if let Some((low, high)) = stops {
                            dJointSetHingeParam(hinge, PARAM_LO_STOP, low);
                            dJointSetHingeParam(hinge, PARAM_HI_STOP, high);
                        }
                        if let Some(torque) = brake {
                            dJointSetHingeParam(hinge, PARAM_VEL, 0.0);
                            dJointSetHingeParam(hinge, PARAM_FMAX, torque);
                        }
                    }
                }
            }
        }
    }
}

/// Makes contact joints for two geoms whose boxes overlap; `data` is the [`Ode`].
extern "C" fn near(data: *mut c_void, a: Id, b: Id) {
    // SAFETY: `dSpaceCollide` passes on the pointer that it was given in `step`, and two living geoms.
    unsafe {
        let ode = &*data.cast::<Ode>();
        let (first, second) = (dGeomGetBody(a), dGeomGetBody(b));
        if first.is_null() && second.is_null() {
            return;
        }
        if !first.is_null() && !second.is_null() && dAreConnectedExcluding(first, second, CONTACT) != 0 {
            return;
        }
        let surface = Surface { mode: APPROX1, mu: ode.friction, ..Surface::default() };
        let geom = ContactGeom {
            pos: [0.0; 4],
            normal: [0.0; 4],
            depth: 0.0,
            geoms: [core::ptr::null_mut(); 2],
            sides: [-1; 2],
        };
        let mut contacts = [Contact { surface, geom, fdir1: [0.0; 4] }; MAX_CONTACTS];
        let skip = size_of::<Contact>() as c_int;
        let n = dCollide(a, b, MAX_CONTACTS as c_int, &mut contacts[0].geom, skip);
        for contact in &contacts[..n.clamp(0, MAX_CONTACTS as c_int) as usize] {
            let joint = dJointCreateContact(ode.world, ode.contacts, contact);
            dJointAttach(joint, first, second);
        }
    }
}

impl Engine for Ode {
    fn about(&self) -> String {
        "libode (Debian, double precision), dWorldQuickStep, hash space, its defaults".into()
    }

    fn step(&mut self) {
        let data: *mut Self = self;
        // SAFETY: everything lives, and the callback only reads `self`.
        unsafe {
            dSpaceCollide(self.space, data.cast(), near);
            dWorldQuickStep(self.world, STEP);
            dJointGroupEmpty(self.contacts);
        }
    }

    fn poses(&self, out: &mut Vec<Pose>) {
        out.clear();
        out.extend(self.solids.iter().map(|solid| match solid {
            Err(pose) => *pose,
            // SAFETY: the body lives, and the library's arrays have three and four numbers.
            Ok(body) => unsafe {
                let (p, q) = (dBodyGetPosition(*body), dBodyGetQuaternion(*body));
                Pose::new(
                    Vec3::new(*p, *p.add(1), *p.add(2)),
                    Quat::from_parts(*q, Vec3::new(*q.add(1), *q.add(2), *q.add(3))),
                )
            },
        }));
    }
}
