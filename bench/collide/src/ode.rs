//! Installed libode (double precision): the only file here that is not safe Rust.

use crate::scene::{Body, Solid};
use core::ffi::{c_int, c_uint, c_void};
use ferrode_math::Vec3;

type Id = *mut c_void;

#[repr(C)]
#[derive(Clone, Copy)]
struct ContactGeom {
    pos: [f64; 4],
    normal: [f64; 4],
    depth: f64,
    geoms: [Id; 2],
    sides: [c_int; 2],
}

// A program built for the wrong layout must not run.
const _: () = assert!(size_of::<ContactGeom>() == 96);

type NearCallback = extern "C" fn(*mut c_void, Id, Id);

#[link(name = "ode")]
unsafe extern "C" {
    fn dInitODE2(flags: c_uint) -> c_int;
    fn dCheckConfiguration(token: *const core::ffi::c_char) -> c_int;
    fn dSimpleSpaceCreate(parent: Id) -> Id;
    fn dHashSpaceCreate(parent: Id) -> Id;
    fn dSweepAndPruneSpaceCreate(parent: Id, axes: c_int) -> Id;
    fn dQuadTreeSpaceCreate(parent: Id, centre: *const f64, extents: *const f64, depth: c_int) -> Id;
    fn dSpaceDestroy(space: Id);
    fn dSpaceCollide(space: Id, data: *mut c_void, callback: NearCallback);
    fn dSpaceCollide2(a: Id, b: Id, data: *mut c_void, callback: NearCallback);
    fn dCreateSphere(space: Id, radius: f64) -> Id;
    fn dCreateBox(space: Id, x: f64, y: f64, z: f64) -> Id;
    fn dCreateRay(space: Id, length: f64) -> Id;
    fn dGeomRaySet(ray: Id, px: f64, py: f64, pz: f64, dx: f64, dy: f64, dz: f64);
    fn dGeomRaySetClosestHit(ray: Id, closest: c_int);
    fn dGeomDestroy(geom: Id);
    fn dGeomSetPosition(geom: Id, x: f64, y: f64, z: f64);
    fn dGeomSetQuaternion(geom: Id, q: *const f64);
    fn dCollide(a: Id, b: Id, flags: c_int, contacts: *mut ContactGeom, skip: c_int) -> c_int;
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
    fn dGeomTriMeshDataPreprocess2(data: Id, flags: c_uint, extra: *const isize) -> c_int;
    fn dCreateTriMesh(space: Id, data: Id, a: *const c_void, b: *const c_void, c: *const c_void) -> Id;
}

/// Starts the library; false if it is not built for double precision.
pub fn start() -> bool {
    // SAFETY: no arguments but a constant string; may be called once, by `main`.
    unsafe { dInitODE2(0) != 0 && dCheckConfiguration(c"ODE_double_precision".as_ptr()) != 0 }
}

/// The spaces of the library.
#[derive(Clone, Copy, Debug)]
pub enum Kind {
    /// All pairs.
    Simple,
    /// Hash space, default levels.
    Hash,
    /// Sweep and prune, axes xzy.
    Sap,
    /// Quadtree of depth 6.
    Quadtree,
}

/// A space with geoms.
pub struct Space {
    id: Id,
    geoms: Vec<Id>,
    ray: Id,
}

#[derive(Default)]
struct Count {
    pairs: usize,
    contacts: usize,
    narrow: bool,
}

extern "C" fn count(data: *mut c_void, a: Id, b: Id) {
    // SAFETY: `data` is the `Count` of the caller of dSpaceCollide, who does not touch it meanwhile.
    let count = unsafe { &mut *data.cast::<Count>() };
    count.pairs += 1;
    if count.narrow {
        let mut list = [const {
            ContactGeom {
                pos: [0.0; 4],
                normal: [0.0; 4],
                depth: 0.0,
                geoms: [core::ptr::null_mut(); 2],
                sides: [0; 2],
            }
        }; 8];
        // SAFETY: room for eight records of the size given.
        count.contacts += unsafe { dCollide(a, b, 8, list.as_mut_ptr(), 96) } as usize;
    }
}

struct Nearest {
    depth: f64,
}

extern "C" fn nearest(data: *mut c_void, a: Id, b: Id) {
    // SAFETY: as in `count`.
    let nearest = unsafe { &mut *data.cast::<Nearest>() };
    let mut hit = ContactGeom {
        pos: [0.0; 4],
        normal: [0.0; 4],
        depth: 0.0,
        geoms: [core::ptr::null_mut(); 2],
        sides: [0; 2],
    };
    // SAFETY: room for one record.
    if unsafe { dCollide(a, b, 1, &mut hit, 96) } > 0 && hit.depth < nearest.depth {
        nearest.depth = hit.depth;
    }
}

impl Space {
    /// A space of the given kind with these bodies; `side` is that of the cube that holds them.
    pub fn new(kind: Kind, bodies: &[Body], side: f64) -> Self {
        let null = core::ptr::null_mut();
        // SAFETY: the library is running; all handles are its own.
        unsafe {
            let id = match kind {
                Kind::Simple => dSimpleSpaceCreate(null),
                Kind::Hash => dHashSpaceCreate(null),
                Kind::Sap => dSweepAndPruneSpaceCreate(null, 24),
                Kind::Quadtree => {
                    dQuadTreeSpaceCreate(null, [0.5 * side; 4].as_ptr(), [0.6 * side; 4].as_ptr(), 6)
                }
            };
            let geoms = bodies
                .iter()
                .map(|b| {
                    let geom = match b.solid {
                        Solid::Ball(r) => dCreateSphere(id, r),
                        Solid::Cuboid(s) => dCreateBox(id, s.x, s.y, s.z),
                    };
                    let (p, q) = (b.position, b.rotation);
                    dGeomSetPosition(geom, p.x, p.y, p.z);
                    dGeomSetQuaternion(geom, [q.w, q.x, q.y, q.z].as_ptr());
                    geom
                })
                .collect();
            let ray = dCreateRay(null, 1.0);
            dGeomRaySetClosestHit(ray, 1);
            Self { id, geoms, ray }
        }
    }

    /// A space with one mesh.
    pub fn mesh(vertices: &'static [Vec3], triangles: &'static [[u32; 3]]) -> Self {
        let mut space = Self::new(Kind::Simple, &[], 1.0);
        // SAFETY: the library keeps the arrays, which live for ever; strides and counts are theirs.
        unsafe {
            let data = dGeomTriMeshDataCreate();
            dGeomTriMeshDataBuildDouble(
                data,
                vertices.as_ptr().cast(),
                24,
                vertices.len() as c_int,
                triangles.as_ptr().cast(),
                3 * triangles.len() as c_int,
                12,
            );
            dGeomTriMeshDataPreprocess2(data, 3, core::ptr::null());
            let null = core::ptr::null();
            space.geoms.push(dCreateTriMesh(space.id, data, null, null, null));
        }
        space
    }

    /// Moves a geom.
    pub fn put(&mut self, i: usize, p: Vec3) {
        // SAFETY: a geom of this space, which is not being searched.
        unsafe { dGeomSetPosition(self.geoms[i], p.x, p.y, p.z) }
    }

    /// Numbers of pairs and of contacts (if `narrow`).
    pub fn collide(&mut self, narrow: bool) -> (usize, usize) {
        let mut data = Count { narrow, ..Count::default() };
        // SAFETY: `data` outlives the call.
        unsafe { dSpaceCollide(self.id, (&raw mut data).cast(), count) };
        (data.pairs, data.contacts)
    }

    /// Distance of the first hit along a ray of unit direction.
    pub fn cast(&mut self, from: Vec3, direction: Vec3, length: f64) -> Option<f64> {
        let mut data = Nearest { depth: f64::INFINITY };
        // SAFETY: as in `collide`.
        unsafe {
            let d = direction;
            dGeomRaySetLength(self.ray, length);
            dGeomRaySet(self.ray, from.x, from.y, from.z, d.x, d.y, d.z);
            dSpaceCollide2(self.ray, self.id, (&raw mut data).cast(), nearest);
        }
        (data.depth <= length).then_some(data.depth)
    }
}

#[link(name = "ode")]
unsafe extern "C" {
    fn dGeomRaySetLength(ray: Id, length: f64);
}

impl Drop for Space {
    fn drop(&mut self) {
        // SAFETY: made by `new`; the space takes its geoms along.
        unsafe {
            dGeomDestroy(self.ray);
            dSpaceDestroy(self.id);
        }
    }
}
