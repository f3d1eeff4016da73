//! Triangle meshes: data that geoms share, and the geoms' own callbacks.
//!
//! The arrays stay the program's: they are read when the data are built, and again when the program says that it has
//! changed them.

use super::kept::Kept;
use super::{GeomId, GeomRecord, class, of_class};
use crate::fault::{Fault, Outcome, export, export_unless};
use crate::mass::{MassPointer, store_checked};
use crate::real::{In, Out, OutVector, Real, f, vector3};
use crate::record::{Required, record};
use crate::slab::{Handle, Held, Pool, Record, Tag};
use core::cell::Cell;
use core::ffi::{c_int, c_uint, c_void};
use core::sync::atomic::{AtomicU64, Ordering};
use ferrode_collide::narrow::ContactMerge;
use ferrode_collide::{Frame, Shape, TriMesh};
use ferrode_dynamics::Mass;
use ferrode_math::Vec3;

pub type MeshId = Handle<MeshRecord>;

pub type TriCallback = unsafe extern "C-unwind" fn(GeomId, GeomId, c_int) -> c_int;
pub type ArrayCallback = unsafe extern "C-unwind" fn(GeomId, GeomId, *const c_int, c_int);
pub type RayCallback = unsafe extern "C-unwind" fn(GeomId, GeomId, c_int, Real, Real) -> c_int;
pub type MergeCallback = unsafe extern "C-unwind" fn(GeomId, c_int, c_int) -> c_int;

/// The program's arrays.
#[derive(Clone, Copy)]
struct Arrays {
    vertices: *const u8,
    single: bool,
    vertex_stride: usize,
    vertex_count: usize,
    indices: *const u8,
    triangle_count: usize,
    triangle_stride: usize,
}

/// A mesh's data.
#[derive(Default)]
pub struct MeshRecord {
    tag: Tag,
    arrays: Cell<Option<Arrays>>,
    mesh: Kept<Option<TriMesh>>,
    /// An older mesh of the same triangles, whose memory the next update can use.
    spare: Kept<Option<TriMesh>>,
    /// Counts builds, so that geoms see that theirs is an old one.
    version: AtomicU64,
    normals: Cell<*mut c_void>,
    /// A byte a triangle: edges and vertices to use, as preprocessing found them. The program may change them.
    flags: Cell<Option<*mut [u8]>>,
    given_flags: Cell<*mut u8>,
    preprocessed: Cell<c_uint>,
}
record!(MeshRecord, MESHES, 14);

/// What only a mesh's geom has.
#[derive(Default)]
pub struct MeshGeom {
    pub data: Cell<MeshId>,
    version: AtomicU64,
    pub tri: Cell<Option<TriCallback>>,
    pub array: Cell<Option<ArrayCallback>>,
    pub ray: Cell<Option<RayCallback>>,
    pub merge: Cell<Option<MergeCallback>>,
    /// For spheres, boxes and capsules.
    coherence: Cell<[bool; 3]>,
    last_transform: Cell<[Real; 16]>,
    pub merge_mode: Cell<c_int>,
}

impl MeshGeom {
    /// Whether no function of the program's is asked about triangles, or named contacts.
    #[inline]
    pub fn is_silent(&self) -> bool {
        self.tri.get().is_none()
            && self.array.get().is_none()
            && self.ray.get().is_none()
            && self.merge.get().is_none()
    }

    /// The program's function that names contacts of several triangles, where there are such contacts.
    pub fn names_merged(&self) -> Option<MergeCallback> {
        self.merge.get().filter(|_| self.merge() == ContactMerge::Full)
    }

    /// How contacts with balls are merged.
    pub fn merge(&self) -> ContactMerge {
        match self.merge_mode.get() {
            2 => ContactMerge::Normals,
            3 => ContactMerge::Full,
            _ => ContactMerge::None,
        }
    }
}

impl MeshRecord {
    fn vertices(arrays: &Arrays) -> Vec<Vec3> {
        let vertex = |i: usize| {
            let at = arrays.vertices.wrapping_add(i * arrays.vertex_stride);
            // SAFETY: the program keeps its arrays, as long and strided as it said, until the data are destroyed (the
            // contract of the build functions).
            let v = unsafe {
                if arrays.single {
                    at.cast::<[f32; 3]>().read_unaligned().map(f64::from)
                } else {
                    at.cast::<[f64; 3]>().read_unaligned()
                }
            };
            Vec3::from_array(v)
        };
        (0..arrays.vertex_count).map(vertex).collect()
    }

    fn triangles(arrays: &Arrays) -> impl Iterator<Item = [u32; 3]> {
        (0..arrays.triangle_count).map(|i| {
            let at = arrays.indices.wrapping_add(i * arrays.triangle_stride);
            // SAFETY: as in `vertices`.
            unsafe { at.cast::<[u32; 3]>().read_unaligned() }
        })
    }

    /// Reads the arrays and builds the mesh.
    fn build(&self) -> Outcome<()> {
        let arrays = self.arrays.get().ok_or(Fault::ARGUMENT)?;
        let mesh = TriMesh::new(Self::vertices(&arrays), Self::triangles(&arrays).collect());
        let mesh = self.flagged(mesh.map_err(|_| Fault::ARGUMENT)?)?;
        self.spare.set(None);
        self.publish(Some(mesh));
        Ok(())
    }

    /// Reads the vertices anew. What was built before the last build is used again, when geoms have let go of it.
    fn update(&self) -> Outcome<()> {
        let arrays = self.arrays.get().ok_or(Fault::ARGUMENT)?;
        let same = |mesh: &TriMesh| Self::triangles(&arrays).eq(mesh.triangles().iter().copied());
        let Some(mesh) = self.mesh.with(Option::clone).filter(same) else { return self.build() };
        let mut next = self.spare.change(Option::take).unwrap_or_else(|| mesh.clone());
        next.set_vertices(&Self::vertices(&arrays)).map_err(|_| Fault::ARGUMENT)?;
        self.spare.set(Some(mesh));
        self.publish(Some(next));
        Ok(())
    }

    fn publish(&self, mesh: Option<TriMesh>) {
        self.mesh.set(mesh);
        self.version.fetch_add(1, Ordering::Relaxed);
    }

    fn start(&self, arrays: Arrays, normals: *const c_void) -> Outcome<()> {
        if arrays.vertices.is_null() || arrays.indices.is_null() {
            return Err(Fault::ARGUMENT);
        }
        self.arrays.set(Some(arrays));
        self.normals.set(normals.cast_mut());
        self.free_flags();
        self.given_flags.set(core::ptr::null_mut());
        self.preprocessed.set(0);
        self.build()
    }

    fn triangle_count(&self) -> usize {
        self.mesh.with(|mesh| mesh.as_ref().map_or(0, |mesh| mesh.triangles().len()))
    }

    /// Where the flags are: the program's own, or those of preprocessing.
    fn flags_pointer(&self) -> *mut u8 {
        let given = self.given_flags.get();
        if given.is_null() {
            self.flags.get().map_or(core::ptr::null_mut(), <*mut [u8]>::cast)
        } else {
            given
        }
    }

    fn free_flags(&self) {
        if let Some(flags) = self.flags.take() {
            // SAFETY: from Box::into_raw in `keep_flags`; taken, so given back once.
            drop(unsafe { Box::from_raw(flags) });
        }
    }

    fn keep_flags(&self, flags: Vec<u8>) {
        self.free_flags();
        self.flags.set(Some(Box::into_raw(flags.into())));
    }

    /// A mesh with the edges and vertices to use that the program has given, or preprocessing has found; ODE uses all if
    /// there are none.
    fn flagged(&self, mesh: TriMesh) -> Outcome<TriMesh> {
        let (start, count) = (self.flags_pointer(), mesh.triangles().len());
        if start.is_null() {
            return Ok(mesh);
        }
        // SAFETY: not null, so a byte a triangle: ours, or the program's (the contract of the functions that give them).
        let flags = (0..count).map(|i| unsafe { start.add(i).read() }).collect();
        mesh.with_use_flags(flags).map_err(|_| Fault::ARGUMENT)
    }

    /// Takes the program's flags, or goes back to those of preprocessing.
    fn give_flags(&self, flags: *mut u8) -> Outcome<()> {
        self.given_flags.set(flags);
        self.refresh_flags()
    }

    /// Takes over flags that have changed.
    fn refresh_flags(&self) -> Outcome<()> {
        self.spare.set(None);
        let mesh = self.mesh.with(Option::clone);
        self.publish(mesh.map(|mesh| self.flagged(mesh)).transpose()?);
        Ok(())
    }
}

/// Which edges (1, 2, 4) and vertices (8, 16, 32) of each triangle to use: convex and boundary edges and vertices
/// without concave edges, each in one triangle.
fn use_flags(mesh: &TriMesh) -> Vec<u8> {
    let triangles = mesh.triangles();
    let mut edges = std::collections::BTreeMap::<(u32, u32), Vec<(usize, usize)>>::new();
    for (t, triangle) in triangles.iter().enumerate() {
        for e in 0..3 {
            let (a, b) = (triangle[e], triangle[(e + 1) % 3]);
            edges.entry((a.min(b), a.max(b))).or_default().push((t, e));
        }
    }
    let mut flags = vec![0; triangles.len()];
    let mut concave = vec![false; mesh.vertices().len()];
    for (ends, sides) in &edges {
        let bends_in = matches!(sides[..], [first, second] if is_concave(mesh, first, second));
        if bends_in {
            concave[ends.0 as usize] = true;
            concave[ends.1 as usize] = true;
        } else {
            flags[sides[0].0] |= 1 << sides[0].1;
        }
    }
    for (t, triangle) in triangles.iter().enumerate() {
        for (i, vertex) in triangle.iter().enumerate() {
            if !core::mem::replace(&mut concave[*vertex as usize], true) {
                flags[t] |= 8 << i;
            }
        }
    }
    flags
}

/// Whether the second triangle rises above the first beyond their common edge.
fn is_concave(mesh: &TriMesh, (t1, e1): (usize, usize), (t2, e2): (usize, usize)) -> bool {
    let at = |t: usize, i: usize| mesh.vertices()[mesh.triangles()[t][i % 3] as usize];
    let normal = (at(t1, 1) - at(t1, 0)).cross(at(t1, 2) - at(t1, 0));
    let (start, end, apex) = (at(t1, e1), at(t1, e1 + 1), at(t2, e2 + 2));
    let along = end - start;
    let h = (apex - start) - along * ((apex - start).dot(along) / along.length_squared());
    let rise = normal.dot(h);
    rise > 0.0 && rise * rise >= 1e-12 * normal.length_squared() * h.length_squared()
}

impl GeomRecord {
    /// Takes over the mesh's latest build.
    pub fn refresh_mesh(&self) {
        if self.class.get() != class::TRIMESH {
            return;
        }
        let Some(data) = self.mesh.data.get().live() else { return };
        let version = data.version.load(Ordering::Relaxed);
        if self.mesh.version.load(Ordering::Acquire) == version {
            return;
        }
        // The first of several threads that find a new build takes it over.
        let _held = Held::content(self);
        if self.mesh.version.load(Ordering::Acquire) != version {
            let merge = self.mesh.merge();
            let mesh = data.mesh.with(Option::clone).map(|mesh| mesh.with_sphere_merge(merge));
            self.shape.set(mesh.map(Shape::from));
            self.mesh.version.store(version, Ordering::Release);
        }
    }

    fn trimesh(&self) -> Outcome<TriMesh> {
        self.refresh_mesh();
        self.shape.with(|shape| match shape {
            Some(Shape::TriMesh(mesh)) => Ok(mesh.clone()),
            _ => Err(Fault::ARGUMENT),
        })
    }
}

fn mesh_geom(geom: GeomId) -> Outcome<&'static GeomRecord> {
    of_class(geom, class::TRIMESH, "The argument is not a trimesh")
}

/// As [`mesh_geom`], in the words of the functions of the last transform.
fn moving(geom: GeomId) -> Outcome<&'static GeomRecord> {
    of_class(geom, class::TRIMESH, "The geom is not a trimesh")
}

/// A triangle's corners in the world.
fn corners(geom: GeomId, index: c_int) -> Outcome<[Vec3; 3]> {
    let geom = mesh_geom(geom)?;
    let mesh = geom.trimesh()?;
    let index = usize::try_from(index).ok().filter(|i| *i < mesh.triangles().len()).ok_or(Fault::ARGUMENT)?;
    let frame = geom.frame();
    Ok(mesh.corners(index as u32).map(|p| frame.point_to_world(p)))
}

fn arrays(
    vertices: *const c_void,
    single: bool,
    vertex_stride: c_int,
    vertex_count: c_int,
    indices: *const c_void,
    index_count: c_int,
    triangle_stride: c_int,
) -> Outcome<Arrays> {
    let size = |n: c_int| usize::try_from(n).map_err(|_| Fault::ARGUMENT);
    Ok(Arrays {
        vertices: vertices.cast(),
        single,
        vertex_stride: size(vertex_stride)?,
        vertex_count: size(vertex_count)?,
        indices: indices.cast(),
        triangle_count: size(index_count)? / 3,
        triangle_stride: size(triangle_stride)?,
    })
}

fn simple(
    vertices: *const Real,
    count: c_int,
    indices: *const c_uint,
    index_count: c_int,
) -> Outcome<Arrays> {
    let (stride, single) = ((4 * size_of::<Real>()) as c_int, size_of::<Real>() == 4);
    arrays(vertices.cast(), single, stride, count, indices.cast(), index_count, 12)
}

fn required(data: MeshId) -> Outcome<&'static MeshRecord> {
    data.get().map_err(|_| Fault::user("The argument is not a trimesh data"))
}

fn preprocess(data: MeshId, requests: c_uint) -> Outcome<c_int> {
    let data = required(data)?;
    if data.preprocessed.get() & requests != 0 {
        return Err(Fault::user("Repeated preprocessing has been requested"));
    }
    data.preprocessed.set(data.preprocessed.get() | requests);
    if requests & 1 != 0 {
        let flags = data.mesh.with(|mesh| mesh.as_ref().map(use_flags)).unwrap_or_default();
        data.keep_flags(flags);
        data.refresh_flags()?;
    }
    Ok(1)
}

/// The mesh of a geom in the world, for its mass.
fn world_mesh(geom: GeomId) -> Outcome<(Vec<Vec3>, Vec<[u32; 3]>)> {
    let geom = mesh_geom(geom)?;
    let mesh = geom.trimesh()?;
    let frame: Frame = geom.frame();
    let vertices = mesh.vertices().iter().map(|p| frame.point_to_world(*p)).collect();
    Ok((vertices, mesh.triangles().to_vec()))
}

/// Whether a class may have its contacts remembered: sphere, box, capsule.
fn coherent_class(geom_class: c_int) -> Option<usize> {
    usize::try_from(geom_class).ok().filter(|class| *class < 3)
}

export_unless! { "no-trimesh";
    fn dGeomTriMeshDataCreate() -> MeshId { MeshId::of(MeshRecord::pool().create()) }
    fn dGeomTriMeshDataDestroy(data: MeshId) {
        if !data.is_null() {
            let data = required(data)?;
            data.mesh.set(None);
            data.spare.set(None);
            data.free_flags();
            MeshRecord::pool().destroy(data);
        }
    }
    fn dGeomTriMeshDataBuildSingle(
        data: MeshId, vertices: *const c_void, vertex_stride: c_int, vertex_count: c_int, indices: *const c_void,
        index_count: c_int, tri_stride: c_int,
    ) {
        let arrays = arrays(vertices, true, vertex_stride, vertex_count, indices, index_count, tri_stride)?;
        required(data)?.start(arrays, core::ptr::null())?
    }
    #[allow(clippy::too_many_arguments)]
    fn dGeomTriMeshDataBuildSingle1(
        data: MeshId, vertices: *const c_void, vertex_stride: c_int, vertex_count: c_int, indices: *const c_void,
        index_count: c_int, tri_stride: c_int, normals: *const c_void,
    ) {
        let arrays = arrays(vertices, true, vertex_stride, vertex_count, indices, index_count, tri_stride)?;
        required(data)?.start(arrays, normals)?
    }
    fn dGeomTriMeshDataBuildDouble(
        data: MeshId, vertices: *const c_void, vertex_stride: c_int, vertex_count: c_int, indices: *const c_void,
        index_count: c_int, tri_stride: c_int,
    ) {
        let arrays = arrays(vertices, false, vertex_stride, vertex_count, indices, index_count, tri_stride)?;
        required(data)?.start(arrays, core::ptr::null())?
    }
    #[allow(clippy::too_many_arguments)]
    fn dGeomTriMeshDataBuildDouble1(
        data: MeshId, vertices: *const c_void, vertex_stride: c_int, vertex_count: c_int, indices: *const c_void,
        index_count: c_int, tri_stride: c_int, normals: *const c_void,
    ) {
        let arrays = arrays(vertices, false, vertex_stride, vertex_count, indices, index_count, tri_stride)?;
        required(data)?.start(arrays, normals)?
    }
    fn dGeomTriMeshDataBuildSimple(
        data: MeshId, vertices: *const Real, vertex_count: c_int, indices: *const c_uint, index_count: c_int,
    ) {
        required(data)?.start(simple(vertices, vertex_count, indices, index_count)?, core::ptr::null())?
    }
    fn dGeomTriMeshDataBuildSimple1(
        data: MeshId, vertices: *const Real, vertex_count: c_int, indices: *const c_uint, index_count: c_int,
        normals: *const c_int,
    ) {
        required(data)?.start(simple(vertices, vertex_count, indices, index_count)?, normals.cast())?
    }
    fn dGeomTriMeshDataUpdate(data: MeshId) { required(data)?.update()? }
    fn dGeomTriMeshDataPreprocess(data: MeshId) -> c_int { preprocess(data, 1)? }
    /// Angles need no preparation here: the mesh knows what lies beyond each edge.
    fn dGeomTriMeshDataPreprocess2(data: MeshId, requests: c_uint, _extra: *const isize) -> c_int {
        preprocess(data, requests)?
    }
    fn dGeomTriMeshDataSet(data: MeshId, id: c_int, content: *mut c_void) {
        let data = required(data)?;
        match id {
            0 => data.normals.set(content),
            1 => data.give_flags(content.cast())?,
            _ => return Err(Fault::user("invalid data type")),
        }
    }
    fn dGeomTriMeshDataGet2(data: MeshId, id: c_int, size: Out<usize>) -> *mut c_void {
        let data = required(data)?;
        let (pointer, bytes) = match id {
            0 => (data.normals.get(), data.triangle_count() * 3 * size_of::<Real>()),
            1 => (data.flags_pointer().cast(), data.triangle_count()),
            _ => return Err(Fault::user("invalid data type")),
        };
        size.set_if_wanted([if pointer.is_null() { 0 } else { bytes }]);
        pointer
    }
    /// Declared by the headers, though libode lacks it.
    fn dGeomTriMeshDataGet(data: MeshId, id: c_int) -> *mut c_void {
        let data = required(data)?;
        match id {
            0 => data.normals.get(),
            1 => data.flags_pointer().cast(),
            _ => return Err(Fault::user("invalid data type")),
        }
    }
    fn dGeomTriMeshDataGetBuffer(data: MeshId, buffer: Out<*mut u8>, length: Out<c_int>) {
        let data = required(data)?;
        let pointer = data.flags_pointer();
        buffer.set_if_wanted([pointer]);
        length.set_if_wanted([if pointer.is_null() { 0 } else { data.triangle_count() as c_int }])
    }
    fn dGeomTriMeshDataSetBuffer(data: MeshId, buffer: *mut u8) { required(data)?.give_flags(buffer)? }

    fn dCreateTriMesh(
        space: GeomId, data: MeshId, tri: Option<TriCallback>, array: Option<ArrayCallback>, ray: Option<RayCallback>,
    ) -> GeomId {
        if !data.is_null() {
            data.get()?;
        }
        let handle = GeomRecord::create(class::TRIMESH, None, None, space)?;
        let geom = handle.get()?;
        geom.mesh.data.set(data);
        geom.mesh.tri.set(tri);
        geom.mesh.array.set(array);
        geom.mesh.ray.set(ray);
        geom.refresh_mesh();
        handle
    }
    fn dGeomTriMeshSetData(geom: GeomId, data: MeshId) {
        let geom = mesh_geom(geom)?;
        data.get()?;
        geom.mesh.data.set(data);
        geom.mesh.version.store(super::NO_BUILD, Ordering::Release);
        geom.refresh_mesh();
        geom.moved()?
    }
    fn dGeomTriMeshGetData(geom: GeomId) -> MeshId { mesh_geom(geom)?.mesh.data.get() }
    fn dGeomTriMeshGetTriMeshDataID(geom: GeomId) -> MeshId { mesh_geom(geom)?.mesh.data.get() }
    fn dGeomTriMeshSetCallback(geom: GeomId, callback: Option<TriCallback>) { mesh_geom(geom)?.mesh.tri.set(callback) }
    fn dGeomTriMeshGetCallback(geom: GeomId) -> Option<TriCallback> { mesh_geom(geom)?.mesh.tri.get() }
    fn dGeomTriMeshSetArrayCallback(geom: GeomId, callback: Option<ArrayCallback>) {
        mesh_geom(geom)?.mesh.array.set(callback)
    }
    fn dGeomTriMeshGetArrayCallback(geom: GeomId) -> Option<ArrayCallback> { mesh_geom(geom)?.mesh.array.get() }
    fn dGeomTriMeshSetRayCallback(geom: GeomId, callback: Option<RayCallback>) {
        mesh_geom(geom)?.mesh.ray.set(callback)
    }
    fn dGeomTriMeshGetRayCallback(geom: GeomId) -> Option<RayCallback> { mesh_geom(geom)?.mesh.ray.get() }
    fn dGeomTriMeshSetTriMergeCallback(geom: GeomId, callback: Option<MergeCallback>) {
        mesh_geom(geom)?.mesh.merge.set(callback)
    }
    fn dGeomTriMeshGetTriMergeCallback(geom: GeomId) -> Option<MergeCallback> { mesh_geom(geom)?.mesh.merge.get() }
    /// Nothing is remembered between calls, so there is nothing to switch; the switch is kept for its reader.
    fn dGeomTriMeshEnableTC(geom: GeomId, geom_class: c_int, enable: c_int) {
        let geom = mesh_geom(geom)?;
        if let Some(place) = coherent_class(geom_class) {
            let mut coherence = geom.mesh.coherence.get();
            coherence[place] = enable != 0;
            geom.mesh.coherence.set(coherence);
        }
    }
    fn dGeomTriMeshIsTCEnabled(geom: GeomId, geom_class: c_int) -> c_int {
        let geom = mesh_geom(geom)?;
        coherent_class(geom_class).is_some_and(|place| geom.mesh.coherence.get()[place]).into()
    }
    fn dGeomTriMeshClearTCCache(geom: GeomId) { mesh_geom(geom)?; }
    fn dGeomTriMeshSetLastTransform(geom: GeomId, transform: In<Real, 16>) {
        moving(geom)?.mesh.last_transform.set(transform.get()?)
    }
    fn dGeomTriMeshGetLastTransform(geom: GeomId) -> *const Real {
        moving(geom)?.mesh.last_transform.as_ptr().cast_const().cast()
    }
    fn dGeomTriMeshGetTriangle(geom: GeomId, index: c_int, v0: OutVector, v1: OutVector, v2: OutVector) {
        for (out, corner) in [v0, v1, v2].into_iter().zip(corners(geom, index)?) {
            out.set_if_wanted(vector3(corner));
        }
    }
    fn dGeomTriMeshGetPoint(geom: GeomId, index: c_int, u: Real, v: Real, point: OutVector) {
        let [a, b, c] = corners(geom, index)?;
        point.set(vector3(a * (1.0 - f(u) - f(v)) + b * f(u) + c * f(v)))?
    }
    fn dGeomTriMeshGetTriangleCount(geom: GeomId) -> c_int {
        mesh_geom(geom)?.mesh.data.get().live().map_or(0, MeshRecord::triangle_count) as c_int
    }

    fn dMassSetTrimesh(mass: MassPointer, density: Real, geom: GeomId) {
        mass.check(Fault::ARGUMENT)?;
        let (vertices, triangles) = world_mesh(geom)?;
        let made = Mass::trimesh_as_ode(f(density), &vertices, &triangles).map_err(|_| Fault::ARGUMENT)?;
        store_checked(mass, &made)?
    }
    fn dMassSetTrimeshTotal(mass: MassPointer, total: Real, geom: GeomId) {
        mass.check(Fault::ARGUMENT)?;
        let (vertices, triangles) = world_mesh(geom)?;
        let made = Mass::trimesh_total_as_ode(f(total), &vertices, &triangles).map_err(|_| Fault::ARGUMENT)?;
        store_checked(mass, &made)?
    }
}

export! {
    /// Meshes alone answer: whether and how contacts with spheres are merged.
    fn dGeomLowLevelControl(
        geom: GeomId, control_class: c_int, code: c_int, value: *mut c_int, size: Out<c_int>,
    ) -> c_int {
        let geom = geom.get()?;
        let [given] = size.get()?;
        if geom.class.get() != class::TRIMESH || control_class != 1 || !(0..=2).contains(&code) {
            return Err(Fault::ARGUMENT);
        }
        let wanted = if code == 0 { 0 } else { size_of::<c_int>() as c_int };
        if given != wanted || (wanted > 0 && value.is_null()) {
            size.set([wanted])?;
            return Ok(0);
        }
        match code {
            // SAFETY: not null, and as large as the caller says (the function's contract).
            1 => match unsafe { value.read() } {
                mode @ 0..=3 => {
                    geom.mesh.merge_mode.set(mode);
                    geom.mesh.version.store(super::NO_BUILD, Ordering::Release);
                }
                _ => return Err(Fault::ARGUMENT),
            },
            // SAFETY: as above.
            2 => unsafe { value.write(geom.mesh.merge_mode.get().max(1)) },
            _ => {}
        }
        1
    }
}
