//! Contacts of geoms and pairs of spaces, as the program asks for them; boxes and segments by themselves.

use super::classes::{Collider, collider};
use super::mesh_choice::MeshChoice;
use super::space::{Pairs, pairs_between, pairs_within};
use super::wrapper::Unwrapped;
use super::{GeomId, GeomRecord};
use crate::contact::ContactGeomRecord;
use crate::fault::{Fault, Outcome, export, fence};
use crate::real::{InMatrix, InVector, Out, OutVector, Real, mat3, padded, r, vector, vector3};
use crate::record::Required;
use core::cell::RefCell;
use core::ffi::{c_int, c_uint, c_void};
use ferrode_collide::narrow::{closest_segment_points, collide_frames, cuboid_cuboid, cuboids_touch};
use ferrode_collide::{CollideOptions, Contacts, Cuboid, Frame, GeomContact};

/// `dNearCallback`.
type NearCallback = unsafe extern "C-unwind" fn(*mut c_void, GeomId, GeomId);

thread_local! {
    /// Memory for one call's contacts.
    static FOUND: RefCell<Vec<GeomContact>> = const { RefCell::new(Vec::new()) };
    /// Memory for one call's pairs; a call within its callbacks finds none here and makes its own.
    static PAIRS: RefCell<Pairs> = const { RefCell::new(Pairs::new()) };
}

/// The program's array of contacts, with a stride of its own.
#[derive(Clone, Copy)]
struct Target {
    first: *mut ContactGeomRecord,
    skip: usize,
}

impl Target {
    fn at(self, index: usize) -> *mut ContactGeomRecord {
        self.first.wrapping_byte_add(index * self.skip)
    }
}

/// Turns contacts round that the program has been given: they are between the geoms in the other order.
fn turn_round(target: Target, which: core::ops::Range<usize>) {
    for i in which {
        // SAFETY: so many contacts have been written into the program's array.
        unsafe {
            let mut record = target.at(i).read_unaligned();
            record.normal = record.normal.map(|x| -x);
            core::mem::swap(&mut record.geom1, &mut record.geom2);
            core::mem::swap(&mut record.side1, &mut record.side2);
            target.at(i).write_unaligned(record);
        }
    }
}

fn write(target: Target, at: usize, contact: &GeomContact, a: GeomId, b: GeomId) {
    let record = ContactGeomRecord {
        position: padded(contact.point.position),
        normal: padded(contact.point.normal),
        depth: r(contact.point.depth),
        geom1: core::ptr::with_exposed_provenance_mut(a.address()),
        geom2: core::ptr::with_exposed_provenance_mut(b.address()),
        side1: contact.side1,
        side2: contact.side2,
    };
    // SAFETY: the program's array has room for as many contacts as the flags ask for (the contract of dCollide), and
    // `at` is below that.
    unsafe { target.at(at).write_unaligned(record) };
}

/// Contacts of two geoms, from number `from` on, up to `max`; returns the next number.
fn contacts_of(
    a: &'static GeomRecord,
    b: &'static GeomRecord,
    flags: c_uint,
    target: Target,
    from: usize,
) -> usize {
    let options = CollideOptions::from_ode_flags(flags);
    let left = usize::from(options.max_contacts).saturating_sub(from);
    let same_body = !a.body.get().is_null() && a.body.get().same(b.body.get());
    if core::ptr::eq(a, b) || same_body || left == 0 {
        return from;
    }
    let flags = (flags & !0xffff) | left as c_uint;
    if let Some((collider, swapped)) = collider(a.class.get(), b.class.get()) {
        return from + by_program((a, b), flags, target, from, collider, swapped);
    }
    if a.is_silent() && b.is_silent() {
        return plain_contacts(a, b, CollideOptions { max_contacts: left as u16, ..options }, target, from);
    }
    // A wrapper in the second place is put first, and its contacts are turned round.
    if b.is_wrapper() {
        let to = solid_contacts(b, a, flags, target, from);
        turn_round(target, from..to);
        return to;
    }
    solid_contacts(a, b, flags, target, from)
}

/// As many contacts of any two geoms, wrappers taken off, as `flags` ask for, from number `from` on; returns the next number.
fn solid_contacts(
    a: &'static GeomRecord,
    b: &'static GeomRecord,
    flags: c_uint,
    target: Target,
    from: usize,
) -> usize {
    let options = CollideOptions::from_ode_flags(flags);
    let left = usize::from(options.max_contacts);
    let (Some((sa, fa)), Some((sb, fb))) = (a.solid(), b.solid()) else { return from };
    let (mut fa, mut fb) = (fa, fb);
    let names = (a.named_wrapper(), b.named_wrapper());
    if (a.is_wrapper() || b.is_wrapper())
        && let Some((collider, swapped)) = collider(sa.class.get(), sb.class.get())
    {
        let _there = (Unwrapped::new(sa, a, &fa), Unwrapped::new(sb, b, &fb));
        let count = by_program((sa, sb), flags, target, from, collider, swapped);
        name_wrappers(target, from..from + count, names);
        return from + count;
    }
    let (view_a, view_b) = (sa.view_for(&fa, sb, &fb), sb.view_for(&fb, sa, &fa));
    let choice = MeshChoice::of(sa, &fa, sb, &fb);
    // Hits are asked about one by one: all are needed to choose from.
    let asks_hits = choice.as_ref().is_some_and(MeshChoice::asks_hits);
    let max_contacts = if asks_hits { u16::MAX } else { left as u16 };
    let options = CollideOptions { max_contacts, ..options };
    // In a static destructor the thread's memory may be gone.
    let mut found = FOUND.try_with(RefCell::take).unwrap_or_default();
    found.clear();
    let (view_a, view_b) = match &choice {
        Some(choice) => choice.views(view_a, view_b),
        None => (view_a, view_b),
    };
    (fa, fb) = (view_a.frame(fa), view_b.frame(fb));
    view_a.with(sa, |sa| {
        view_b.with(sb, |sb| {
            if let (Some(sa), Some(sb)) = (sa, sb) {
                collide_frames((sa, &fa), (sb, &fb), options, &mut found);
            }
        });
    });
    if let Some(choice) = choice {
        choice.finish(&mut found);
    }
    let (ga, gb) = (names.0.unwrap_or(GeomId::of(sa)), names.1.unwrap_or(GeomId::of(sb)));
    for (i, contact) in found.iter().take(left).enumerate() {
        write(target, from + i, contact, ga, gb);
    }
    let count = found.len().min(left);
    FOUND.try_with(|kept| *kept.borrow_mut() = found).ok();
    from + count
}

/// Contacts of two geoms about which the program is not asked, as [`contacts_of`].
#[inline]
fn plain_contacts(
    a: &'static GeomRecord,
    b: &'static GeomRecord,
    options: CollideOptions,
    target: Target,
    from: usize,
) -> usize {
    let (fa, fb) = (a.frame(), b.frame());
    let (ga, gb) = (GeomId::of(a), GeomId::of(b));
    let find = |found: &mut Vec<GeomContact>| {
        found.clear();
        a.shape.with(|sa| {
            b.shape.with(|sb| {
                if let (Some(sa), Some(sb)) = (sa, sb) {
                    collide_frames((sa, &fa), (sb, &fb), options, found);
                }
            });
        });
        let count = found.len().min(usize::from(options.max_contacts));
        for (i, contact) in found[..count].iter().enumerate() {
            write(target, from + i, contact, ga, gb);
        }
        from + count
    };
    // In a static destructor the thread's memory may be gone.
    FOUND.try_with(|found| find(&mut found.borrow_mut())).unwrap_or_else(|_| find(&mut Vec::new()))
}

/// Contacts by a collider of the program's. Given the geoms in the other order, its contacts are turned round.
fn by_program(
    (a, b): (&'static GeomRecord, &'static GeomRecord),
    flags: c_uint,
    target: Target,
    from: usize,
    collider: Collider,
    swapped: bool,
) -> usize {
    let (ga, gb) = (GeomId::of(a), GeomId::of(b));
    let (first, second) = if swapped { (gb, ga) } else { (ga, gb) };
    // SAFETY: the program's own function, called as its header says, with room for as many contacts as asked for.
    let count =
        unsafe { collider(first, second, flags.cast_signed(), target.at(from), target.skip as c_int) };
    let count = usize::try_from(count).unwrap_or(0).min((flags & 0xffff) as usize);
    if swapped {
        turn_round(target, from..from + count);
    }
    count
}

/// Contacts that the program's own collider has made name the wrappers that want it.
fn name_wrappers(target: Target, which: core::ops::Range<usize>, names: (Option<GeomId>, Option<GeomId>)) {
    if names.0.is_none() && names.1.is_none() {
        return;
    }
    let name = |name: GeomId| core::ptr::with_exposed_provenance_mut(name.address());
    for i in which {
        // SAFETY: so many contacts have been written into the program's array.
        unsafe {
            let mut record = target.at(i).read_unaligned();
            record.geom1 = names.0.map_or(record.geom1, name);
            record.geom2 = names.1.map_or(record.geom2, name);
            target.at(i).write_unaligned(record);
        }
    }
}

fn collide(
    a: &'static GeomRecord,
    b: &'static GeomRecord,
    flags: c_uint,
    target: Target,
    from: usize,
) -> Outcome<usize> {
    if !a.is_space() && !b.is_space() {
        return Ok(contacts_of(a, b, flags, target, from));
    }
    let mut pairs = Pairs::new();
    pairs_between(a, b, &mut pairs)?;
    let mut count = from;
    for (a, b) in pairs {
        if count < (flags & 0xffff) as usize
            && let (Some(a), Some(b)) = (a.live(), b.live())
            && a.admits(b)
            && b.admits(a)
        {
            count = collide(a, b, flags, target, count)?;
        }
    }
    Ok(count)
}

/// Locks spaces while the program is told of their pairs. An escape by `longjmp` leaves them locked, as in ODE.
struct Lock<'a>(&'a [&'static GeomRecord]);

impl<'a> Lock<'a> {
    fn new(spaces: &'a [&'static GeomRecord]) -> Self {
        spaces.iter().for_each(|space| space.locks.set(space.locks.get() + 1));
        Self(spaces)
    }
}

impl Drop for Lock<'_> {
    fn drop(&mut self) {
        self.0.iter().for_each(|space| space.locks.set(space.locks.get().saturating_sub(1)));
    }
}

/// Calls back for each pair whose geoms still live and may be seen. Nothing of ours is borrowed meanwhile.
fn tell(pairs: &Pairs, spaces: &[&'static GeomRecord], data: *mut c_void, callback: NearCallback) {
    let _lock = Lock::new(spaces);
    for (a, b) in pairs {
        if let (Some(first), Some(second)) = (a.live(), b.live())
            && first.admits(second)
            && second.admits(first)
        {
            // SAFETY: the program's own function, called as its header says.
            unsafe { callback(data, a.handle(), b.handle()) };
        }
    }
}

/// An empty list. Nothing is borrowed while the program is called; in a static destructor the thread's memory may be gone.
fn take_pairs() -> Pairs {
    let mut pairs = PAIRS.try_with(RefCell::take).unwrap_or_default();
    pairs.clear();
    pairs
}

/// Calls back for each pair of a space's members that may touch.
#[unsafe(no_mangle)]
pub unsafe extern "C-unwind" fn dSpaceCollide(
    space: GeomId,
    data: *mut c_void,
    callback: Option<NearCallback>,
) {
    fence("dSpaceCollide", || {
        let space = space.get()?;
        space.require_space()?;
        let callback = callback.ok_or(Fault::ARGUMENT)?;
        let mut pairs = take_pairs();
        pairs_within(space, &mut pairs)?;
        tell(&pairs, &[space], data, callback);
        PAIRS.try_with(|kept| *kept.borrow_mut() = pairs).ok();
        Ok(())
    });
}

/// Calls back for each pair with one from each geom or space that may touch.
#[unsafe(no_mangle)]
pub unsafe extern "C-unwind" fn dSpaceCollide2(
    a: GeomId,
    b: GeomId,
    data: *mut c_void,
    callback: Option<NearCallback>,
) {
    fence("dSpaceCollide2", || {
        let (a, b) = (a.get()?, b.get()?);
        let callback = callback.ok_or(Fault::ARGUMENT)?;
        let mut pairs = take_pairs();
        pairs_between(a, b, &mut pairs)?;
        let sides = [a, b];
        let spaces: &[_] = match (a.is_space(), b.is_space()) {
            (true, true) => &sides,
            (true, false) => &sides[..1],
            (false, true) => &sides[1..],
            (false, false) => &[],
        };
        tell(&pairs, spaces, data, callback);
        PAIRS.try_with(|kept| *kept.borrow_mut() = pairs).ok();
        Ok(())
    });
}

/// Finds the contacts of two geoms, or of the members of spaces.
#[unsafe(no_mangle)]
pub unsafe extern "C-unwind" fn dCollide(
    o1: GeomId,
    o2: GeomId,
    flags: c_int,
    contact: *mut ContactGeomRecord,
    skip: c_int,
) -> c_int {
    fence("dCollide", || {
        let (a, b) = (o1.get()?, o2.get()?);
        let flags = flags.cast_unsigned();
        if flags & 0xffff == 0 {
            return Err(Fault::user("no contacts requested"));
        }
        if contact.is_null() {
            return Err(Fault::ARGUMENT);
        }
        if !crate::init::is_started() {
            return Err(Fault::user("dInitODE2 must be called first"));
        }
        if core::ptr::eq(a, b) {
            return Ok(0);
        }
        let skip = usize::try_from(skip).ok().filter(|skip| *skip >= size_of::<ContactGeomRecord>());
        let skip = skip.ok_or(Fault::internal("assertion \"skip >= sizeof(dContactGeom)\" failed"))?;
        Ok(collide(a, b, flags, Target { first: contact, skip }, 0)? as c_int)
    })
}

/// A box at a place, from C's arrays.
fn box_at(position: InVector, rotation: InMatrix, sides: InVector) -> Outcome<(Cuboid, Frame)> {
    let cuboid = Cuboid::new(vector(&sides.get()?)).map_err(|_| Fault::ARGUMENT)?;
    Ok((cuboid, Frame::new(vector(&position.get()?), mat3(&rotation.get()?))))
}

export! {
    #[allow(clippy::too_many_arguments)]
    fn dBoxBox(
        p1: InVector, r1: InMatrix, side1: InVector, p2: InVector, r2: InMatrix, side2: InVector, normal: OutVector,
        depth: Out<Real>, return_code: Out<c_int>, flags: c_int, contact: *mut ContactGeomRecord, skip: c_int,
    ) -> c_int {
        let ((a, fa), (b, fb)) = (box_at(p1, r1, side1)?, box_at(p2, r2, side2)?);
        let skip = usize::try_from(skip).ok().filter(|skip| *skip >= size_of::<ContactGeomRecord>());
        let target = Target { first: contact, skip: skip.ok_or(Fault::ARGUMENT)? };
        if contact.is_null() {
            return Err(Fault::ARGUMENT);
        }
        let flags = flags.cast_unsigned();
        let flags = if flags & 0xffff == 0 { flags | 1 } else { flags };
        let mut found = Vec::new();
        let mut contacts = Contacts::new(&mut found, CollideOptions::from_ode_flags(flags));
        let Some(hit) = cuboid_cuboid(&a, &fa, &b, &fb, &mut contacts) else { return Ok(0) };
        normal.set(vector3(hit.normal))?;
        depth.set([r(hit.depth)])?;
        return_code.set([hit.code as c_int])?;
        for (i, contact) in found.iter().enumerate() {
            let record = target.at(i);
            // SAFETY: the program's array has room for as many contacts as asked for (the function's contract); only
            // position and depth are written.
            unsafe {
                (&raw mut (*record).position).cast::<[Real; 3]>().write_unaligned(vector3(contact.point.position));
                (&raw mut (*record).depth).write_unaligned(r(contact.point.depth));
            }
        }
        found.len() as c_int
    }
    fn dBoxTouchesBox(
        p1: InVector, r1: InMatrix, side1: InVector, p2: InVector, r2: InMatrix, side2: InVector,
    ) -> c_int {
        let ((a, fa), (b, fb)) = (box_at(p1, r1, side1)?, box_at(p2, r2, side2)?);
        cuboids_touch(&a, &fa, &b, &fb).into()
    }
    fn dClosestLineSegmentPoints(
        a1: InVector, a2: InVector, b1: InVector, b2: InVector, cp1: OutVector, cp2: OutVector,
    ) {
        let point = |p: InVector| p.get().map(|p| vector(&p));
        let (first, second) = closest_segment_points(point(a1)?, point(a2)?, point(b1)?, point(b2)?);
        cp1.set(vector3(first))?;
        cp2.set(vector3(second))?
    }
}
