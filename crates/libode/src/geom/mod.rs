//! Geoms and spaces: their records, where they are, and what has moved.
//!
//! A space is a geom, and both are one kind of record. A geom without a body, or with an offset, has its pose in the
//! record; else its pose is the body's, and getters point into the body's record.

mod classes;
mod collide;
mod convex;
mod heightfield;
mod kept;
mod mesh_choice;
mod pose;
mod shapes;
mod space;
mod trimesh;
mod wrapper;

use crate::fault::{Fault, Outcome, export, export_calling};
use crate::real::{Real, Real4, Real12, mat3, r, vec3, vector};
use crate::record::{BodyId, BodyRecord, Required, record};
use crate::slab::{Handle, Link, Pool, Record, Tag};
use core::cell::{Cell, RefCell};
use core::ffi::{c_int, c_ulong, c_void};
use ferrode_collide::{Frame, Shape};
use ferrode_math::{Aabb, Mat3, Vec3};
use kept::{Kept, KeptBox, Shown};

pub use classes::forget as forget_classes;
pub use space::SpaceData;

pub type GeomId = Handle<GeomRecord>;

/// The version of data of which a geom has taken over nothing.
const NO_BUILD: u64 = u64::MAX;

const LOCKED: Fault = Fault::user("Invalid operation for locked space");
const NOT_PLACEABLE: Fault = Fault::user("geom must be placeable");

/// ODE's numbers of the classes.
pub mod class {
    use core::ffi::c_int;
    pub const SPHERE: c_int = 0;
    pub const BOX: c_int = 1;
    pub const CAPSULE: c_int = 2;
    pub const CYLINDER: c_int = 3;
    pub const PLANE: c_int = 4;
    pub const RAY: c_int = 5;
    pub const CONVEX: c_int = 6;
    pub const TRANSFORM: c_int = 7;
    pub const TRIMESH: c_int = 8;
    pub const HEIGHTFIELD: c_int = 9;
    pub const SIMPLE_SPACE: c_int = 10;
    pub const HASH_SPACE: c_int = 11;
    pub const SWEEP_AND_PRUNE_SPACE: c_int = 12;
    pub const QUADTREE_SPACE: c_int = 13;
}

/// A geom or a space.
#[derive(Default)]
pub struct GeomRecord {
    tag: Tag,
    class: Cell<c_int>,
    data: Cell<*mut c_void>,
    body: Cell<Link<BodyRecord>>,
    next_on_body: Cell<Link<Self>>,
    space: Cell<Link<Self>>,
    /// Its number in the space's table.
    proxy: Cell<u32>,
    category: Cell<c_ulong>,
    collide: Cell<c_ulong>,
    disabled: Cell<bool>,
    /// The space that it is in has yet to learn its box. The spaces above a dirty geom are dirty.
    dirty: Cell<bool>,
    aabb: KeptBox,
    position: Shown<4>,
    rotation: Shown<12>,
    has_offset: Cell<bool>,
    offset_position: Cell<Real4>,
    offset_rotation: Cell<Real12>,
    /// Threads may look at one geom at once, so there is no count of who does.
    shape: Kept<Option<Shape>>,
    contents: RefCell<Option<Box<SpaceData>>>,
    /// Collisions that report this space's members now.
    locks: Cell<u32>,
    convex: convex::ConvexGeom,
    mesh: trimesh::MeshGeom,
    field: heightfield::FieldGeom,
    own: classes::ClassGeom,
}
record!(GeomRecord, GEOMS, 13);

impl GeomRecord {
    /// A geom of a class, with its shape unless it is a space, in a space or in none.
    fn create(
        class: c_int,
        shape: Option<Shape>,
        contents: Option<SpaceData>,
        space: GeomId,
    ) -> Outcome<GeomId> {
        let parent = if space.is_null() { None } else { Some(space.get()?) };
        if let Some(parent) = parent {
            parent.require_space()?;
            parent.require_unlocked()?;
        }
        let geom = GEOMS.create();
        geom.class.set(class);
        geom.category.set(c_ulong::MAX);
        geom.collide.set(c_ulong::MAX);
        geom.rotation.set(crate::real::matrix3(&Mat3::IDENTITY));
        geom.dirty.set(true);
        geom.shape.set(shape);
        *geom.contents.borrow_mut() = contents.map(Box::new);
        if let Some(parent) = parent {
            space::add(parent, geom)?;
        }
        Ok(GeomId::of(geom))
    }

    fn is_space(&self) -> bool {
        (class::SIMPLE_SPACE..=class::QUADTREE_SPACE).contains(&self.class.get())
    }

    /// Whether it is just its shape at its place: nothing is shared with the program, and it is not asked.
    #[inline]
    fn is_plain(&self) -> bool {
        (class::SPHERE..=class::PLANE).contains(&self.class.get())
    }

    /// Whether it is just its shape at its place, or a mesh about which the program is not asked; takes over the mesh's latest build.
    #[inline]
    fn is_silent(&self) -> bool {
        let silent_mesh = || self.class.get() == class::TRIMESH && self.mesh.is_silent();
        self.is_plain()
            || (silent_mesh() && {
                self.refresh_mesh();
                true
            })
    }

    fn require_space(&self) -> Outcome<()> {
        if self.is_space() { Ok(()) } else { Err(Fault::user("argument not a space")) }
    }

    fn require_unlocked(&self) -> Outcome<()> {
        if self.locks.get() > 0 { Err(LOCKED) } else { Ok(()) }
    }

    fn is_placeable(&self) -> bool {
        match self.class.get() {
            class::PLANE => false,
            class::HEIGHTFIELD => self.field.placeable.get(),
            _ => !self.is_space(),
        }
    }

    fn require_placeable(&self) -> Outcome<()> {
        if self.is_placeable() { Ok(()) } else { Err(NOT_PLACEABLE) }
    }

    fn on_body(&self) -> Option<&'static BodyRecord> {
        self.body.get().live()
    }

    /// The space that the geom is in.
    fn parent(&self) -> Option<&'static Self> {
        self.space.get().live()
    }

    /// Whether spaces look at it: enabled, and of some size.
    fn is_visible(&self) -> bool {
        !self.disabled.get() && !self.shape.with(|shape| shape.as_ref().is_some_and(Shape::is_zero_sized))
    }

    /// The geom's pose within its body.
    fn offset(&self) -> Option<Frame> {
        let offset = || Frame::new(vector(&self.offset_position.get()), mat3(&self.offset_rotation.get()));
        self.has_offset.get().then(offset)
    }

    /// Where the geom is in the world. One with an offset has its record brought up to date.
    fn frame(&self) -> Frame {
        let Some(body) = self.on_body() else {
            return Frame::new(vector(&self.position.get()), mat3(&self.rotation.get()));
        };
        let body = body.current();
        let (p, m) = (vector(&body.position.get()), mat3(&body.rotation.get()));
        let Some(offset) = self.offset() else { return Frame::new(p, m) };
        let frame = Frame::new(p + m * offset.position, m * offset.rotation);
        let (position, rotation) =
            (crate::real::padded(frame.position), crate::real::matrix3(&frame.rotation));
        // Threads may look at one geom at once: what is up to date is not written.
        if self.position.get() != position {
            self.position.set(position);
        }
        if self.rotation.get() != rotation {
            self.rotation.set(rotation);
        }
        frame
    }

    /// The world box, brought up to date.
    fn current_aabb(&self) -> Aabb {
        self.aabb.get().unwrap_or_else(|| {
            let aabb = self.measure();
            self.aabb.set(&aabb);
            aabb
        })
    }

    /// The world box, afresh. The program's own function may be asked, so nothing is borrowed meanwhile.
    fn measure(&self) -> Aabb {
        if self.is_space() {
            let members = space::look(self, space::SpaceData::list).unwrap_or_default();
            return space::aabb_of(self.class.get(), &members);
        }
        if let Some(six) = self.user_aabb() {
            return aabb_of_six(six);
        }
        match self.solid() {
            Some((geom, frame)) if geom.class.get() >= classes::FIRST_USER => {
                let _there = wrapper::Unwrapped::new(geom, self, &frame);
                geom.user_aabb().map_or(Aabb::EMPTY, aabb_of_six)
            }
            Some((geom, frame)) => geom.unbounded_field_aabb(&frame).unwrap_or_else(|| {
                geom.shape.with(|shape| shape.as_ref().map_or(Aabb::EMPTY, |shape| shape.aabb_in(&frame)))
            }),
            None => Aabb::new(Vec3::ZERO, Vec3::ZERO),
        }
    }

    /// Takes over what the program has changed in data that it shares with the geom.
    fn refresh(&self) {
        match self.class.get() {
            class::CONVEX => self.refresh_convex(),
            class::TRIMESH => self.refresh_mesh(),
            class::HEIGHTFIELD => self.refresh_field(),
            _ => {}
        }
    }

    /// Notes that pose or shape have changed: the space it is in puts it first, and spaces above learn of it.
    fn moved(&self) -> Outcome<()> {
        let mut above = self.parent();
        while let Some(space) = above {
            space.require_unlocked()?;
            above = space.parent();
        }
        self.aabb.forget();
        let mut dirty = self.dirty.replace(true);
        let mut proxy = self.proxy.get();
        let mut above = self.parent();
        while let Some(space) = above {
            if !dirty && let Some(contents) = &mut *space.contents.borrow_mut() {
                contents.moved(proxy);
                dirty = space.dirty.replace(true);
                proxy = space.proxy.get();
            }
            space.aabb.forget();
            above = space.parent();
        }
        Ok(())
    }

    /// Tells the space about bits, body, and whether to look at the geom.
    fn tell_space(&self) {
        if let Some(space) = self.parent()
            && let Some(contents) = &mut *space.contents.borrow_mut()
        {
            contents.refresh(self);
        }
    }

    /// Takes the geom off its body; it stays where it is.
    fn leave_body(&'static self) {
        let Some(body) = self.on_body() else { return };
        let frame = self.frame();
        self.position.set(crate::real::padded(frame.position));
        self.rotation.set(crate::real::matrix3(&frame.rotation));
        if body.first_geom.get().is_to(self) {
            body.first_geom.set(self.next_on_body.get());
        } else {
            let mut other = body.first_geom.get().live();
            while let Some(geom) = other {
                if geom.next_on_body.get().is_to(self) {
                    geom.next_on_body.set(self.next_on_body.get());
                    break;
                }
                other = geom.next_on_body.get().live();
            }
        }
        self.next_on_body.set(Link::NULL);
        self.body.set(Link::NULL);
        self.has_offset.set(false);
    }

    fn join_body(&'static self, body: &'static BodyRecord) {
        self.body.set(Link::to(body));
        self.next_on_body.set(body.first_geom.get());
        body.first_geom.set(Link::to(self));
    }

    /// Destroys a geom, or a space with what it owns.
    fn destroy(&'static self) -> Outcome<()> {
        if let Some(parent) = self.parent() {
            parent.require_unlocked()?;
        }
        self.require_unlocked()?;
        if self.is_space() {
            space::empty(self)?;
        }
        self.end_class()?;
        self.leave_body();
        if let Some(parent) = self.parent() {
            space::remove(parent, self)?;
        }
        self.shape.set(None);
        self.forget_convex();
        *self.contents.borrow_mut() = None;
        GEOMS.destroy(self);
        Ok(())
    }
}

/// The geom behind a handle if it is of a class, or the class's own fault.
fn of_class(geom: GeomId, class: c_int, fault: &'static str) -> Outcome<&'static GeomRecord> {
    geom.live().filter(|geom| geom.class.get() == class).ok_or(Fault::user(fault))
}

/// Tells all geoms of a body that it has moved.
pub fn body_moved(body: &BodyRecord) -> Outcome<()> {
    let mut geom = body.first_geom.get().live();
    while let Some(one) = geom {
        one.moved()?;
        geom = one.next_on_body.get().live();
    }
    Ok(())
}

/// All geoms of a body, the last attached first.
pub fn all_of(body: &'static BodyRecord) -> Vec<GeomId> {
    let first = body.first_geom.get().live();
    core::iter::successors(first, |geom| geom.next_on_body.get().live()).map(GeomId::of).collect()
}

impl GeomRecord {
    /// The geom as the lines of ODE's interchange format.
    pub fn described(&self) -> Vec<String> {
        let mut lines = Vec::new();
        for (name, bits) in [("category_bits", self.category.get()), ("collide_bits", self.collide.get())] {
            if bits != c_ulong::MAX {
                lines.push(format!("{name} = {bits}"));
            }
        }
        if self.disabled.get() {
            lines.push("disabled = 1,".into());
        }
        let (kind, sizes): (_, Vec<(&str, String)>) = self.shape.with(|shape| match shape {
            Some(Shape::Sphere(s)) => ("sphere", vec![("radius", s.radius().to_string())]),
            Some(Shape::Cuboid(s)) => {
                let [x, y, z] = s.sides().to_array();
                ("box", vec![("sides", format!("{{{x},{y},{z}}}"))])
            }
            Some(Shape::Capsule(s)) => {
                ("capsule", vec![("radius", s.radius().to_string()), ("length", s.length().to_string())])
            }
            Some(Shape::Cylinder(s)) => {
                ("cylinder", vec![("radius", s.radius().to_string()), ("length", s.length().to_string())])
            }
            Some(Shape::Ray(s)) => ("ray", vec![("length", s.length().to_string())]),
            Some(Shape::Convex(_)) => ("convex", Vec::new()),
            Some(Shape::TriMesh(_)) => ("trimesh", Vec::new()),
            Some(Shape::Heightfield(_)) => ("heightfield", Vec::new()),
            _ => ("unknown", Vec::new()),
        });
        lines.push(format!("type = \"{kind}\","));
        lines.extend(sizes.into_iter().map(|(name, value)| format!("{name} = {value},")));
        lines
    }
}

/// Takes all geoms off a body that is about to die.
pub fn leave_dying_body(body: &BodyRecord) {
    while let Some(geom) = body.first_geom.get().live() {
        geom.leave_body();
        geom.tell_space();
        if body.first_geom.get().is_to(geom) {
            return;
        }
    }
}

fn set_body(geom: GeomId, body: BodyId) -> Outcome<()> {
    let geom = geom.get()?;
    let target = if body.is_null() { None } else { Some(body.get()?) };
    if target.is_some() {
        geom.require_placeable()?;
    }
    if let Some(parent) = geom.parent() {
        parent.require_unlocked()?;
    }
    if let Some(target) = target {
        if !geom.body.get().is_to(target) {
            geom.leave_body();
            geom.join_body(target);
        }
        geom.moved()?;
    } else {
        geom.leave_body();
    }
    geom.tell_space();
    Ok(())
}

fn set_bits(geom: GeomId, set: impl FnOnce(&GeomRecord)) -> Outcome<()> {
    let geom = geom.get()?;
    if let Some(parent) = geom.parent() {
        parent.require_unlocked()?;
    }
    set(geom);
    geom.tell_space();
    Ok(())
}

fn set_enabled(geom: GeomId, enabled: bool) -> Outcome<()> {
    let geom = geom.get()?;
    geom.disabled.set(!enabled);
    geom.tell_space();
    Ok(())
}

/// A box from ODE's order.
fn aabb_of_six([ax, bx, ay, by, az, bz]: [Real; 6]) -> Aabb {
    Aabb::new(vec3(ax, ay, az), vec3(bx, by, bz))
}

/// A box in ODE's order.
fn six(aabb: &Aabb) -> [Real; 6] {
    let (a, b): (Vec3, Vec3) = (aabb.min, aabb.max);
    [r(a.x), r(b.x), r(a.y), r(b.y), r(a.z), r(b.z)]
}

export! {
    fn dGeomSetData(geom: GeomId, data: *mut c_void) { geom.get()?.data.set(data) }
    fn dGeomGetData(geom: GeomId) -> *mut c_void { geom.get()?.data.get() }
    fn dGeomGetClass(geom: GeomId) -> c_int { geom.get()?.class.get() }
    fn dGeomIsSpace(geom: GeomId) -> c_int { geom.get()?.is_space().into() }
    fn dGeomGetSpace(geom: GeomId) -> GeomId { geom.get()?.space.get().handle() }
    fn dGeomSetBody(geom: GeomId, body: BodyId) { set_body(geom, body)? }
    fn dGeomGetBody(geom: GeomId) -> BodyId { geom.get()?.body.get().handle() }
    fn dGeomMoved(geom: GeomId) { geom.get()?.moved()? }
    fn dBodyGetFirstGeom(body: BodyId) -> GeomId { body.get()?.first_geom.get().handle() }
    fn dBodyGetNextGeom(geom: GeomId) -> GeomId { geom.get()?.next_on_body.get().handle() }
    fn dGeomGetBodyNext(geom: GeomId) -> GeomId { geom.get()?.next_on_body.get().handle() }
    fn dInfiniteAABB(_geom: GeomId, aabb: crate::real::Out<Real, 6>) { aabb.set(six(&Aabb::EVERYTHING))? }
    fn dGeomSetCategoryBits(geom: GeomId, bits: c_ulong) { set_bits(geom, |geom| geom.category.set(bits))? }
    fn dGeomGetCategoryBits(geom: GeomId) -> c_ulong { geom.get()?.category.get() }
    fn dGeomSetCollideBits(geom: GeomId, bits: c_ulong) { set_bits(geom, |geom| geom.collide.set(bits))? }
    fn dGeomGetCollideBits(geom: GeomId) -> c_ulong { geom.get()?.collide.get() }
    fn dGeomEnable(geom: GeomId) { set_enabled(geom, true)? }
    fn dGeomDisable(geom: GeomId) { set_enabled(geom, false)? }
    fn dGeomIsEnabled(geom: GeomId) -> c_int { (!geom.get()?.disabled.get()).into() }
}

export_calling! {
    fn dGeomDestroy(geom: GeomId) { geom.get()?.destroy()? }
    fn dGeomGetAABB(geom: GeomId, aabb: crate::real::Out<Real, 6>) { aabb.set(six(&geom.get()?.current_aabb()))? }
}
