//! Single geoms of installed libode (double precision).

use core::ffi::{c_char, c_int, c_uint, c_void};
use ferrode_collide::Shape;
use ferrode_math::{Pose, Vec3};

type Id = *mut c_void;

/// A contact as libode writes it.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct ContactGeom {
    pos: [f64; 4],
    normal: [f64; 4],
    /// Depth in metres.
    pub depth: f64,
    geoms: [Id; 2],
    sides: [c_int; 2],
}

// A program built for the wrong layout must not run.
const _: () = assert!(size_of::<ContactGeom>() == 96);

const NOTHING: ContactGeom = ContactGeom {
    pos: [0.0; 4],
    normal: [0.0; 4],
    depth: 0.0,
    geoms: [core::ptr::null_mut(); 2],
    sides: [0; 2],
};

#[link(name = "ode")]
unsafe extern "C" {
    fn dInitODE2(flags: c_uint) -> c_int;
    fn dCheckConfiguration(token: *const c_char) -> c_int;
    fn dCreateSphere(space: Id, radius: f64) -> Id;
    fn dCreateBox(space: Id, x: f64, y: f64, z: f64) -> Id;
    fn dCreateCapsule(space: Id, radius: f64, length: f64) -> Id;
    fn dCreateCylinder(space: Id, radius: f64, length: f64) -> Id;
    fn dCreatePlane(space: Id, a: f64, b: f64, c: f64, d: f64) -> Id;
    fn dCreateRay(space: Id, length: f64) -> Id;
    fn dCreateConvex(
        space: Id,
        planes: *const f64,
        plane_count: c_uint,
        points: *const f64,
        point_count: c_uint,
        polygons: *const c_uint,
    ) -> Id;
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
    fn dGeomHeightfieldDataCreate() -> Id;
    fn dGeomHeightfieldDataBuildDouble(
        data: Id,
        heights: *const f64,
        copy: c_int,
        width: f64,
        depth: f64,
        columns: c_int,
        rows: c_int,
        scale: f64,
        offset: f64,
        thickness: f64,
        wrap: c_int,
    );
    fn dCreateHeightfield(space: Id, data: Id, placeable: c_int) -> Id;
    fn dGeomSetPosition(geom: Id, x: f64, y: f64, z: f64);
    fn dGeomSetQuaternion(geom: Id, q: *const f64);
    fn dCollide(a: Id, b: Id, flags: c_int, contacts: *mut ContactGeom, skip: c_int) -> c_int;
}

/// Starts the library; false if it is not built for double precision.
pub fn start() -> bool {
    // SAFETY: no arguments but a constant string; called once, by `main`.
    unsafe { dInitODE2(0) != 0 && dCheckConfiguration(c"ODE_double_precision".as_ptr()) != 0 }
}

/// What geoms of one size share: the data of meshes, fields and polyhedra, which stay for ever.
#[derive(Clone, Copy)]
pub enum Data {
    /// Nothing.
    None,
    /// A mesh's or a field's.
    Shared(Id),
    /// Planes, points and faces.
    Convex(&'static [f64], &'static [f64], &'static [c_uint]),
}

impl Data {
    /// For a shape.
    pub fn of(shape: &Shape) -> Self {
        match shape {
            Shape::Convex(c) => {
                let planes = (0..c.face_count()).flat_map(|i| {
                    let (n, d) = c.face_plane(i);
                    [n.x, n.y, n.z, d]
                });
                let points = c.points().iter().flat_map(|p| p.to_array());
                let faces = (0..c.face_count())
                    .flat_map(|i| [c.face(i).len() as c_uint].into_iter().chain(c.face(i).iter().copied()));
                Self::Convex(
                    planes.collect::<Vec<_>>().leak(),
                    points.collect::<Vec<_>>().leak(),
                    faces.collect::<Vec<_>>().leak(),
                )
            }
            Shape::TriMesh(m) => {
                let vertices: &'static [Vec3] = m.vertices().to_vec().leak();
                let triangles: &'static [[u32; 3]] = m.triangles().to_vec().leak();
                // SAFETY: the library keeps the arrays, which live for ever; strides and counts are theirs. 3 asks for
                // concave edges and face angles, as the manual advises.
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
                    Self::Shared(data)
                }
            }
            Shape::Heightfield(f) => {
                let (n, m) = (f.columns(), f.rows());
                let heights: Vec<f64> =
                    (0..n * m).map(|k| f.height((k % n) as i64, (k / n) as i64)).collect();
                // SAFETY: the library copies the heights.
                unsafe {
                    let data = dGeomHeightfieldDataCreate();
                    dGeomHeightfieldDataBuildDouble(
                        data,
                        heights.as_ptr(),
                        1,
                        f.width(),
                        f.depth(),
                        n as c_int,
                        m as c_int,
                        1.0,
                        0.0,
                        1.0,
                        0,
                    );
                    Self::Shared(data)
                }
            }
            _ => Self::None,
        }
    }
}

/// A geom in no space. Stays for ever.
#[derive(Clone, Copy)]
pub struct Geom(Id);

impl Geom {
    /// `None` for shapes that libode has not.
    pub fn new(shape: &Shape, data: &Data, pose: &Pose) -> Option<Self> {
        let null = core::ptr::null_mut();
        // SAFETY: the library is running; shared data live for ever.
        let id = unsafe {
            match (shape, data) {
                (Shape::Sphere(s), _) => dCreateSphere(null, s.radius()),
                (Shape::Cuboid(s), _) => {
                    let h = s.half_sides();
                    dCreateBox(null, 2.0 * h.x, 2.0 * h.y, 2.0 * h.z)
                }
                (Shape::Capsule(s), _) => dCreateCapsule(null, s.radius(), s.length()),
                (Shape::Cylinder(s), _) => dCreateCylinder(null, s.radius(), s.length()),
                (Shape::Ray(s), _) => dCreateRay(null, s.length()),
                (Shape::Plane(s), _) => {
                    let n = s.normal();
                    return Some(Self(dCreatePlane(null, n.x, n.y, n.z, s.d())));
                }
                (Shape::Convex(_), Data::Convex(planes, points, faces)) => dCreateConvex(
                    null,
                    planes.as_ptr(),
                    planes.len() as c_uint / 4,
                    points.as_ptr(),
                    points.len() as c_uint / 3,
                    faces.as_ptr(),
                ),
                (Shape::TriMesh(_), Data::Shared(data)) => {
                    dCreateTriMesh(null, *data, core::ptr::null(), core::ptr::null(), core::ptr::null())
                }
                (Shape::Heightfield(_), Data::Shared(data)) => dCreateHeightfield(null, *data, 1),
                _ => return None,
            }
        };
        let (p, q) = (pose.position, pose.rotation);
        // SAFETY: a placeable geom that was just made.
        unsafe {
            dGeomSetPosition(id, p.x, p.y, p.z);
            dGeomSetQuaternion(id, [q.w, q.x, q.y, q.z].as_ptr());
        }
        Some(Self(id))
    }

    /// Up to eight contacts.
    #[inline]
    pub fn collide(self, other: Self, list: &mut [ContactGeom; 8]) -> usize {
        // SAFETY: both geoms live; room for eight records of the size given.
        unsafe { dCollide(self.0, other.0, 8, list.as_mut_ptr(), 96) as usize }
    }
}

/// Room for contacts.
pub fn list() -> [ContactGeom; 8] {
    [NOTHING; 8]
}
