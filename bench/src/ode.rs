//! Installed libode (double precision), as an [`Engine`]: the only file here that is not safe Rust.

use crate::engine::{ContactLine, Engine, Method, Mu};
use core::ffi::{c_int, c_uint, c_ulong, c_void};
use ferrode_math::{Quat, Vec3};

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
const PARAM_VEL: c_int = 2;
const PARAM_FMAX: c_int = 5;

// A program built for the wrong layout must not run: these are the sizes of libode 0.16 in double precision.
const _: () = assert!(size_of::<Contact>() == 248 && size_of::<Mass>() == 136);

#[link(name = "ode")]
unsafe extern "C" {
    fn dInitODE2(flags: c_uint) -> c_int;
    fn dCheckConfiguration(token: *const core::ffi::c_char) -> c_int;
    fn dRandSetSeed(seed: c_ulong);
    fn dWorldCreate() -> Id;
    fn dWorldDestroy(world: Id);
    fn dWorldSetGravity(world: Id, x: f64, y: f64, z: f64);
    #[allow(dead_code, reason = "not every program sets it")]
    fn dWorldSetCFM(world: Id, cfm: f64);
    fn dWorldStep(world: Id, h: f64) -> c_int;
    fn dWorldQuickStep(world: Id, h: f64) -> c_int;
    fn dBodyCreate(world: Id) -> Id;
    fn dBodySetMass(body: Id, mass: *const Mass);
    fn dBodySetPosition(body: Id, x: f64, y: f64, z: f64);
    fn dBodySetQuaternion(body: Id, q: *const f64);
    fn dBodyGetPosition(body: Id) -> *const f64;
    fn dBodyGetQuaternion(body: Id) -> *const f64;
    fn dBodyGetLinearVel(body: Id) -> *const f64;
    fn dMassSetBoxTotal(mass: *mut Mass, total: f64, x: f64, y: f64, z: f64);
    fn dJointGroupCreate(unused: c_int) -> Id;
    fn dJointGroupDestroy(group: Id);
    fn dJointGroupEmpty(group: Id);
    fn dJointCreateContact(world: Id, group: Id, contact: *const Contact) -> Id;
    fn dJointCreateBall(world: Id, group: Id) -> Id;
    fn dJointCreateHinge(world: Id, group: Id) -> Id;
    fn dJointAttach(joint: Id, first: Id, second: Id);
    fn dJointSetBallAnchor(joint: Id, x: f64, y: f64, z: f64);
    fn dJointSetHingeAnchor(joint: Id, x: f64, y: f64, z: f64);
    fn dJointSetHingeAxis(joint: Id, x: f64, y: f64, z: f64);
    fn dJointSetHingeParam(joint: Id, parameter: c_int, value: f64);
    fn dJointGetBallAnchor(joint: Id, out: *mut f64);
    fn dJointGetBallAnchor2(joint: Id, out: *mut f64);
    fn dJointGetHingeAnchor(joint: Id, out: *mut f64);
    fn dJointGetHingeAnchor2(joint: Id, out: *mut f64);
}

/// A world of libode's.
pub struct Ode {
    world: Id,
    contacts: Id,
    bodies: Vec<Id>,
    balls: Vec<Id>,
    hinges: Vec<Id>,
}

/// Starts the library once.
fn initialise() {
    static ONCE: std::sync::Once = std::sync::Once::new();
    ONCE.call_once(|| {
        // SAFETY: the first call into the library, made once; the token is a C string.
        let double = unsafe {
            dInitODE2(0);
            dCheckConfiguration(c"ODE_double_precision".as_ptr())
        };
        assert!(double != 0, "the installed libode is not of double precision");
    });
}

impl Ode {
    fn body(&self, body: Option<usize>) -> Id {
        body.map_or(core::ptr::null_mut(), |i| self.bodies[i])
    }

    /// The three numbers at a pointer that the library returned for a living body.
    ///
    /// # Safety
    /// `p` points to at least three numbers.
    unsafe fn read(p: *const f64) -> Vec3 {
        // SAFETY: the caller says so.
        unsafe { Vec3::new(*p, *p.add(1), *p.add(2)) }
    }
}

impl Drop for Ode {
    fn drop(&mut self) {
        // SAFETY: both are alive, and nothing of them is used after this.
        unsafe {
            dJointGroupDestroy(self.contacts);
            dWorldDestroy(self.world);
        }
    }
}

impl Engine for Ode {
    const NAME: &'static str = "libode";

    fn new(gravity: Vec3) -> Self {
        initialise();
        // SAFETY: the library is initialised.
        unsafe {
            dRandSetSeed(0);
            let world = dWorldCreate();
            dWorldSetGravity(world, gravity.x, gravity.y, gravity.z);
            let contacts = dJointGroupCreate(0);
            Self { world, contacts, bodies: Vec::new(), balls: Vec::new(), hinges: Vec::new() }
        }
    }

    fn set_cfm(&mut self, cfm: f64) {
        // SAFETY: the world lives.
        unsafe { dWorldSetCFM(self.world, cfm) }
    }

    fn add_box(&mut self, mass: f64, sides: Vec3, position: Vec3, rotation: Quat) -> usize {
        let q = [rotation.w, rotation.x, rotation.y, rotation.z];
        let mut m = Mass { mass: 0.0, centre: [0.0; 4], inertia: [0.0; 12] };
        // SAFETY: the world lives; `m` and `q` have the library's layout and outlive the calls.
        unsafe {
            let body = dBodyCreate(self.world);
            dMassSetBoxTotal(&mut m, mass, sides.x, sides.y, sides.z);
            dBodySetMass(body, &m);
            dBodySetPosition(body, position.x, position.y, position.z);
            dBodySetQuaternion(body, q.as_ptr());
            self.bodies.push(body);
        }
        self.bodies.len() - 1
    }

    fn add_ball(&mut self, first: Option<usize>, second: Option<usize>, anchor: Vec3) {
        // SAFETY: world and bodies live as long as `self`.
        unsafe {
            let joint = dJointCreateBall(self.world, core::ptr::null_mut());
            dJointAttach(joint, self.body(first), self.body(second));
            dJointSetBallAnchor(joint, anchor.x, anchor.y, anchor.z);
            self.balls.push(joint);
        }
    }

    fn add_hinge(
        &mut self,
        first: Option<usize>,
        second: Option<usize>,
        anchor: Vec3,
        axis: Vec3,
        brake: Option<f64>,
    ) {
        // SAFETY: world and bodies live as long as `self`.
        unsafe {
            let joint = dJointCreateHinge(self.world, core::ptr::null_mut());
            dJointAttach(joint, self.body(first), self.body(second));
            dJointSetHingeAnchor(joint, anchor.x, anchor.y, anchor.z);
            dJointSetHingeAxis(joint, axis.x, axis.y, axis.z);
            if let Some(torque) = brake {
                dJointSetHingeParam(joint, PARAM_VEL, 0.0);
                dJointSetHingeParam(joint, PARAM_FMAX, torque);
            }
            self.hinges.push(joint);
        }
    }

    fn step(&mut self, method: Method, h: f64, contacts: &[ContactLine], Mu(mu): Mu) {
        let surface = Surface { mode: APPROX1, mu, ..Surface::default() };
        for line in contacts {
            let wide = |v: Vec3| [v.x, v.y, v.z, 0.0];
            let geom = ContactGeom {
                pos: wide(line.point.position),
                normal: wide(line.point.normal),
                depth: line.point.depth,
                geoms: [core::ptr::null_mut(); 2],
                sides: [-1; 2],
            };
            let contact = Contact { surface, geom, fdir1: [0.0; 4] };
            // SAFETY: world, group and bodies live; the library copies the contact.
            unsafe {
                let joint = dJointCreateContact(self.world, self.contacts, &contact);
                dJointAttach(joint, self.body(Some(line.first)), self.body(line.second));
            }
        }
        // SAFETY: as above.
        let ok = unsafe {
            let ok = match method {
                Method::Direct => dWorldStep(self.world, h),
                Method::Quick => dWorldQuickStep(self.world, h),
            };
            dJointGroupEmpty(self.contacts);
            ok
        };
        assert!(ok != 0, "libode could not step");
    }

    fn poses(&self) -> Vec<(Vec3, Quat)> {
        let pose = |body: &Id| {
            // SAFETY: the bodies live, and their positions and quaternions have three and four numbers.
            unsafe {
                let q = dBodyGetQuaternion(*body);
                (Self::read(dBodyGetPosition(*body)), Quat::from_parts(*q, Self::read(q.add(1))))
            }
        };
        self.bodies.iter().map(pose).collect()
    }

    fn speeds(&self) -> Vec<Vec3> {
        // SAFETY: the bodies live, and velocities have three numbers.
        self.bodies.iter().map(|body| unsafe { Self::read(dBodyGetLinearVel(*body)) }).collect()
    }

    fn joint_error(&self) -> f64 {
        let mut ends = [[0.0; 4]; 2];
        let mut worst: f64 = 0.0;
        let mut measure = |joint: Id, get: [unsafe extern "C" fn(Id, *mut f64); 2]| {
            // SAFETY: the joint lives, is of the getters' type, and they write at most four numbers.
            let gap = unsafe {
                get[0](joint, ends[0].as_mut_ptr());
                get[1](joint, ends[1].as_mut_ptr());
                Self::read(ends[0].as_ptr()) - Self::read(ends[1].as_ptr())
            };
            worst = worst.max(gap.length());
        };
        self.balls.iter().for_each(|j| measure(*j, [dJointGetBallAnchor, dJointGetBallAnchor2]));
        self.hinges.iter().for_each(|j| measure(*j, [dJointGetHingeAnchor, dJointGetHingeAnchor2]));
        worst
    }
}
