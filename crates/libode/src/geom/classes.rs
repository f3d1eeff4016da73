//! Classes of the program's own, overridden colliders, and the old wrapper that moves another geom.

use super::{GeomId, GeomRecord, class, of_class};
use crate::contact::ContactGeomRecord;
use crate::fault::{Fault, Outcome, export, export_calling};
use crate::real::{In, Real};
use crate::record::Required;
use core::cell::Cell;
use core::ffi::{c_int, c_void};
use core::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Mutex, PoisonError};

/// `dColliderFn`.
pub type Collider =
    unsafe extern "C-unwind" fn(GeomId, GeomId, c_int, *mut ContactGeomRecord, c_int) -> c_int;

/// `dGeomClass`.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct ClassRecord {
    bytes: c_int,
    collider: Option<unsafe extern "C-unwind" fn(c_int) -> Option<Collider>>,
    aabb: Option<unsafe extern "C-unwind" fn(GeomId, *mut Real)>,
    aabb_test: Option<unsafe extern "C-unwind" fn(GeomId, GeomId, *mut Real) -> c_int>,
    destructor: Option<unsafe extern "C-unwind" fn(GeomId)>,
}

const CLASSES: usize = 18;
pub(super) const FIRST_USER: c_int = 14;
const USERS: usize = 4;

/// What the program has registered.
struct Registry {
    classes: Vec<ClassRecord>,
    overrides: [[Option<(Collider, bool)>; CLASSES]; CLASSES],
}

/// Whether the program has registered anything: where it hasn't, nobody looks.
static ANY: AtomicBool = AtomicBool::new(false);

static REGISTRY: Mutex<Registry> =
    Mutex::new(Registry { classes: Vec::new(), overrides: [[None; CLASSES]; CLASSES] });

fn registry<T>(work: impl FnOnce(&mut Registry) -> T) -> T {
    work(&mut REGISTRY.lock().unwrap_or_else(PoisonError::into_inner))
}

/// Forgets the program's classes, as closing the library does.
pub fn forget() {
    registry(|registry| {
        ANY.store(false, Ordering::Release);
        registry.classes.clear();
        registry.overrides = [[None; CLASSES]; CLASSES];
    });
}

fn class_of(number: c_int) -> Option<ClassRecord> {
    if number < FIRST_USER {
        return None;
    }
    let place = usize::try_from(number - FIRST_USER).ok()?;
    registry(|registry| registry.classes.get(place).copied())
}

/// What only geoms of the program's classes, and wrappers, have.
#[derive(Default)]
pub struct ClassGeom {
    /// The program's bytes, zero at first, from its memory handler, and their number.
    block: Cell<Option<(*mut c_void, usize)>>,
    /// The geom that a wrapper moves.
    inner: Cell<GeomId>,
    owns: Cell<bool>,
    info: Cell<bool>,
}

impl ClassGeom {
    fn free(&self) {
        if let Some((block, size)) = self.block.take() {
            // SAFETY: from `zeros` in `dCreateGeom`, with this size; taken, so given back once.
            unsafe { crate::memory::dFree(block, size) };
        }
    }
}

impl GeomRecord {
    /// The box by the class's own function.
    pub fn user_aabb(&self) -> Option<[Real; 6]> {
        let aabb = class_of(self.class.get())?.aabb?;
        let mut six = [0.0; 6];
        // SAFETY: the program's own function, called as the header says with room for six numbers.
        unsafe { aabb(GeomId::from_address(core::ptr::from_ref(self).addr()), six.as_mut_ptr()) };
        Some(six)
    }

    /// Whether the class's own test of boxes, if it has one, lets a pair through.
    pub fn admits(&'static self, other: &'static Self) -> bool {
        if self.class.get() < FIRST_USER {
            return true;
        }
        let Some(test) = class_of(self.class.get()).and_then(|class| class.aabb_test) else { return true };
        let mut six = super::six(&other.current_aabb());
        // SAFETY: the program's own function, called as the header says with the other geom's box.
        unsafe { test(GeomId::of(self), GeomId::of(other), six.as_mut_ptr()) != 0 }
    }

    /// The geom that a wrapper moves.
    pub fn inner(&self) -> Option<&'static Self> {
        self.is_wrapper().then(|| self.own.inner.get().live()).flatten()
    }

    /// Whether contacts of a wrapper name the wrapper itself.
    pub fn names_itself(&self) -> bool {
        self.own.info.get()
    }

    /// Ends what the class has added to a geom that is about to die.
    pub fn end_class(&'static self) -> Outcome<()> {
        if let Some(destructor) = class_of(self.class.get()).and_then(|class| class.destructor) {
            // SAFETY: the program's own function, called as the header says.
            unsafe { destructor(GeomId::of(self)) };
        }
        if let Some(inner) = self.inner().filter(|_| self.own.owns.get()) {
            inner.destroy()?;
        }
        self.own.free();
        Ok(())
    }
}

/// The program's collider for two classes, and whether it takes them in the other order.
pub fn collider(a: c_int, b: c_int) -> Option<(Collider, bool)> {
    if !ANY.load(Ordering::Acquire) {
        return None;
    }
    let (i, j) = (usize::try_from(a).ok()?, usize::try_from(b).ok()?);
    if let Some(found) = registry(|registry| *registry.overrides.get(i)?.get(j)?) {
        return Some(found);
    }
    // A class of the program's gets to see the geom within.
    if a == class::TRANSFORM || b == class::TRANSFORM {
        return None;
    }
    let choose = |of: c_int, other: c_int| {
        let chooser = class_of(of)?.collider?;
        // SAFETY: the program's own function, called as the header says.
        unsafe { chooser(other) }
    };
    // Two geoms of one class come in the other order, as with an override.
    let same = a == b;
    let found =
        choose(a, b).map(|found| (found, same)).or_else(|| choose(b, a).map(|found| (found, true)))?;
    registry(|registry| {
        registry.overrides[i][j] = Some(found);
        registry.overrides[j][i] = Some((found.0, same || !found.1));
    });
    Some(found)
}

fn transform(geom: GeomId) -> Outcome<&'static GeomRecord> {
    of_class(geom, class::TRANSFORM, "argument not a geom transform")
}

export! {
    fn dCreateGeomClass(description: In<ClassRecord>) -> c_int {
        let [description] = description.get()?;
        if description.bytes < 0 || description.collider.is_none() || description.aabb.is_none() {
            return Err(Fault::user("bad geom class"));
        }
        registry(|registry| {
            if registry.classes.len() == USERS {
                return Err(Fault::user("too many user classes, you must increase the limit and recompile ODE"));
            }
            registry.classes.push(description);
            ANY.store(true, Ordering::Release);
            Ok(FIRST_USER + registry.classes.len() as c_int - 1)
        })?
    }
    fn dGeomGetClassData(geom: GeomId) -> *mut c_void {
        let custom = |geom: &&GeomRecord| class_of(geom.class.get()).is_some();
        let geom = geom.live().filter(custom).ok_or(Fault::user("not a custom class"))?;
        geom.own.block.get().map_or(core::ptr::null_mut(), |(block, _)| block)
    }
    fn dSetColliderOverride(i: c_int, j: c_int, collider: Option<Collider>) {
        let place = |n: c_int| usize::try_from(n).ok().filter(|n| *n < CLASSES).ok_or(Fault::ARGUMENT);
        let (i, j) = (place(i)?, place(j)?);
        registry(|registry| {
            ANY.store(true, Ordering::Release);
            registry.overrides[i][j] = collider.map(|collider| (collider, false));
            registry.overrides[j][i] = collider.map(|collider| (collider, true));
        })
    }

    fn dCreateGeomTransform(space: GeomId) -> GeomId { GeomRecord::create(class::TRANSFORM, None, None, space)? }
    fn dGeomTransformGetGeom(geom: GeomId) -> GeomId { transform(geom)?.own.inner.get() }
    fn dGeomTransformSetCleanup(geom: GeomId, mode: c_int) { transform(geom)?.own.owns.set(mode != 0) }
    fn dGeomTransformGetCleanup(geom: GeomId) -> c_int { transform(geom)?.own.owns.get().into() }
    fn dGeomTransformSetInfo(geom: GeomId, mode: c_int) { transform(geom)?.own.info.set(mode != 0) }
    fn dGeomTransformGetInfo(geom: GeomId) -> c_int { transform(geom)?.own.info.get().into() }
}

export_calling! {
    fn dCreateGeom(class: c_int) -> GeomId {
        let bytes = class_of(class).ok_or(Fault::user("not a custom class"))?.bytes as usize;
        let block = crate::memory::zeros(bytes);
        let handle = GeomRecord::create(class, None, None, GeomId::NULL)?;
        handle.get()?.own.block.set(Some((block, bytes)));
        handle
    }
    fn dGeomTransformSetGeom(geom: GeomId, inner: GeomId) {
        let geom = transform(geom)?;
        if let Some(old) = geom.inner().filter(|_| geom.own.owns.get()) {
            old.destroy()?;
        }
        geom.own.inner.set(inner);
        geom.moved()?
    }
}
