//! Records that tasks reach by index, no two of them the same.

use super::{Crew, chunks, cut};
use crate::simd::{Lanes, NO_RECORD, Record};
use core::cell::Cell;
use core::ops::Range;
use core::sync::atomic::{AtomicBool, AtomicU16, Ordering};

/// For each item of a list the records that it touches: two of them per lane. The list is in groups, and these in parts. Items of a part
/// are worked on in turn; the parts of one group touch different records, which [`Exclusive::verify`] makes sure of, and may be worked on
/// side by side.
///
/// ```
/// use ferrode_math::simd::{Kernel, Lanes, NO_RECORD, Record, Work, dispatch};
/// use ferrode_math::stage::{Crew, Exclusive, Lot};
///
/// /// Swaps the records (0, 1) and (2, 3).
/// struct Swap<'a>(&'a Crew, &'a mut [Record]);
/// struct SwapLot<'a, L: Lanes>(Lot<'a, L, ()>);
///
/// impl<L: Lanes> Work<L> for SwapLot<'_, L> {
///     #[inline(always)]
///     fn run(mut self) {
///         for i in 0..self.0.len() {
///             let (_, touch) = self.0.get(i);
///             let (a, b) = (touch.gather(0), touch.gather(1));
///             touch.scatter(0, b);
///             touch.scatter(1, a);
///         }
///     }
/// }
///
/// impl Kernel for Swap<'_> {
///     type Out = ();
///     fn run<L: Lanes>(self) {
///         let mut pairs = Exclusive::<L>::default();
///         // One group of two parts, of one item each.
///         for (row, pair) in pairs.begin([[1, 2]], 2).iter_mut().zip([[0, 1], [2, 3]]) {
///             for (index, record) in row.iter_mut().zip(pair) {
///                 index.as_mut().fill(NO_RECORD);
///                 index.as_mut()[0] = record;
///             }
///         }
///         pairs.verify(self.0, self.1.len());
///         pairs.sweep(self.0, 0, &mut [(); 2], self.1, |lot| L::enter(SwapLot(lot)));
///     }
/// }
///
/// let mut records: Vec<Record> = (0..4).map(|i| Record([i as f32; 8])).collect();
/// dispatch(Swap(&Crew::new(2), &mut records));
/// assert_eq!(records[3].0[0], 2.0);
/// ```
#[derive(Debug)]
pub struct Exclusive<L: Lanes> {
    rows: Vec<[L::Index; 2]>,
    /// Ends of the parts of all groups.
    ends: Vec<usize>,
    groups: Vec<Group>,
}

#[derive(Debug, Default)]
struct Group {
    /// Where its items begin.
    first: usize,
    /// Places in the ends of parts.
    parts: Range<usize>,
    /// No record is touched by two parts.
    apart: AtomicBool,
    /// For each record a part that touches it, if one does.
    owners: Vec<AtomicU16>,
}

/// Most parts of a group that are worked on side by side.
const MOST_PARTS: usize = u16::MAX as usize;

impl<L: Lanes> Default for Exclusive<L> {
    fn default() -> Self {
        Self { rows: Vec::new(), ends: Vec::new(), groups: Vec::new() }
    }
}

impl<L: Lanes> Exclusive<L> {
    /// Starts anew: for each group, one after the other, the ends of its parts in the list of items. Returns a row for each item to be
    /// filled in: the records' indices, or [`NO_RECORD`].
    pub fn begin<G: IntoIterator<Item = usize>>(
        &mut self,
        groups: impl IntoIterator<Item = G>,
        items: usize,
    ) -> &mut [[L::Index; 2]] {
        self.ends.clear();
        let (mut count, mut first) = (0, 0);
        for ends in groups {
            if count == self.groups.len() {
                self.groups.push(Group::default());
            }
            let start = self.ends.len();
            let mut end = first;
            for next in ends {
                end = next.clamp(end, items.max(end));
                self.ends.push(end);
            }
            let group = &mut self.groups[count];
            (group.first, group.parts) = (first, start..self.ends.len());
            *group.apart.get_mut() = false;
            first = end;
            count += 1;
        }
        self.groups.truncate(count);
        self.rows.resize(items, [L::Index::default(); 2]);
        &mut self.rows
    }

    /// Looks whether the parts of each group touch different ones of `records` records. Parts that don't are worked on one
    /// after the other, as all are where there is one thread.
    pub fn verify(&mut self, crew: &Crew, records: usize) {
        if crew.threads() == 1 {
            return;
        }
        let Self { rows, ends, groups } = self;
        let mut tasks = 0;
        for group in groups.iter_mut().filter(|group| group.is_shared()) {
            group.owners.resize_with(records, AtomicU16::default);
            *group.apart.get_mut() = true;
            tasks += group.parts.len();
        }
        if tasks == 0 {
            return;
        }
        let (rows, ends, groups) = (&*rows, &*ends, &*groups);
        let part = |task: usize, look: &(dyn Fn(&Group, u16, u32) + Sync)| {
            let Some((group, number)) = shared_part(groups, task) else { return };
            let items = group.items(ends, number);
            for i in rows.get(items).unwrap_or_default().iter().flatten().flat_map(|index| index.as_ref()) {
                if *i != NO_RECORD {
                    look(group, number as u16, *i);
                }
            }
        };
        // Each writes itself down at its records; where two do, one of them finds the other there.
        crew.run(tasks, |task| {
            part(task, &|group, number, i| match group.owners.get(i as usize) {
                Some(owner) => owner.store(number, Ordering::Relaxed),
                None => group.apart.store(false, Ordering::Relaxed),
            });
        });
        crew.run(tasks, |task| {
            part(task, &|group, number, i| {
                if group.owners.get(i as usize).is_none_or(|owner| owner.load(Ordering::Relaxed) != number) {
                    group.apart.store(false, Ordering::Relaxed);
                }
            });
        });
    }

    /// Calls `work` with the items of each part of a group, side by side: `items` are those of the group, in the order of its rows.
    pub fn sweep<T: Send>(
        &self,
        crew: &Crew,
        group: usize,
        items: &mut [T],
        records: &mut [Record],
        work: impl Fn(Lot<'_, L, T>) + Sync,
    ) {
        let Some(group) = self.groups.get(group) else { return };
        let whole = Cell::from_mut(records).as_slice_of_cells();
        let rows = |part: usize| self.rows.get(group.items(&self.ends, part)).unwrap_or_default();
        let apart = group.apart.load(Ordering::Relaxed);
        if !apart || crew.threads() == 1 {
            let mut rest = items;
            for part in 0..group.parts.len() {
                let rows = rows(part);
                let (items, after) = rest.split_at_mut(rows.len().min(rest.len()));
                rest = after;
                work(Lot { rows, items, records: whole });
            }
            return;
        }
        let shared = Shared { start: whole.as_ptr(), len: whole.len() };
        let ends = &self.ends[group.parts.clone()];
        crew.each(cut(items, group.first, ends), |number, items| {
            // SAFETY: the cells are borrowed for the whole call. Through a lot they are reached by the indices of its rows alone
            // (`Touch` keeps them to itself, and `Lanes` is sealed). Those of one part were found to be none of another part's, rows
            // can't change meanwhile, and each part is worked on by one task: so no cell is reached by two tasks.
            let records = unsafe { shared.cells() };
            work(Lot { rows: rows(number), items, records });
        });
    }
}

impl<L: Lanes> Exclusive<L> {
    /// Calls `work` with each of `owners`, side by side: one for each part of a group, with the records of several lists that it owns: those that
    /// the part's rows touch.
    pub fn lend<T: Send, const N: usize>(
        &self,
        crew: &Crew,
        group: usize,
        owners: &mut [T],
        lists: [&mut [Record]; N],
        work: impl Fn(&mut T, Lent<'_, L, N>) + Sync,
    ) {
        let Some(group) = self.groups.get(group) else { return };
        let lists = lists.map(|list| Cell::from_mut(list).as_slice_of_cells());
        let rows = |part: usize| self.rows.get(group.items(&self.ends, part)).unwrap_or_default();
        if !group.apart.load(Ordering::Relaxed) || crew.threads() == 1 {
            for (part, owner) in owners.iter_mut().enumerate().take(group.parts.len()) {
                work(owner, Lent { rows: rows(part), lists });
            }
            return;
        }
        let shared = lists.map(|list| Shared { start: list.as_ptr(), len: list.len() });
        let count = owners.len().min(group.parts.len());
        crew.each(chunks(&mut owners[..count], 1), |part, owner| {
            // SAFETY: as in `sweep`; the parts' records were found to be different ones in any list, for it is their numbers that differ.
            let lists = shared.each_ref().map(|list| unsafe { list.cells() });
            work(&mut owner[0], Lent { rows: rows(part), lists });
        });
    }
}

impl Group {
    /// Whether there is something to share out.
    fn is_shared(&self) -> bool {
        (2..=MOST_PARTS).contains(&self.parts.len())
    }

    /// The items of a part.
    fn items(&self, ends: &[usize], part: usize) -> Range<usize> {
        let at = self.parts.start + part;
        let first = if part == 0 { self.first } else { ends[at - 1] };
        first..ends[at]
    }
}

/// A part by its number among the parts of all groups that have several.
fn shared_part(groups: &[Group], mut number: usize) -> Option<(&Group, usize)> {
    for group in groups.iter().filter(|group| group.is_shared()) {
        if number < group.parts.len() {
            return Some((group, number));
        }
        number -= group.parts.len();
    }
    None
}

/// Cells on their way to other threads.
struct Shared {
    start: *const Cell<Record>,
    len: usize,
}

// SAFETY: it only carries an address; who uses it has to say why.
unsafe impl Sync for Shared {}

impl Shared {
    /// # Safety
    /// The cells live as long as the result, and no two threads reach the same one.
    unsafe fn cells<'a>(&self) -> &'a [Cell<Record>] {
        // SAFETY: the caller's promise.
        unsafe { core::slice::from_raw_parts(self.start, self.len) }
    }
}

/// The records of `N` lists that a part's rows touch, numbered in the order of the rows: two per row.
pub struct Lent<'a, L: Lanes, const N: usize> {
    rows: &'a [[L::Index; 2]],
    lists: [&'a [Cell<Record>]; N],
}

impl<L: Lanes, const N: usize> Lent<'_, L, N> {
    /// The numbers of each lane's record with a number, in one of the lists.
    ///
    /// # Panics
    /// If there are fewer records or lists.
    #[inline(always)]
    pub fn gather(&self, list: usize, number: usize) -> [L; 8] {
        L::gather(self.lists[list], &self.rows[number / 2][number % 2])
    }

    /// Writes them.
    ///
    /// # Panics
    /// If there are fewer records or lists.
    #[inline(always)]
    pub fn scatter(&self, list: usize, number: usize, numbers: [L; 8]) {
        L::scatter(self.lists[list], &self.rows[number / 2][number % 2], numbers);
    }
}

/// Some items of a group, with the records that they touch.
pub struct Lot<'a, L: Lanes, T> {
    rows: &'a [[L::Index; 2]],
    items: &'a mut [T],
    records: &'a [Cell<Record>],
}

impl<L: Lanes, T> Lot<'_, L, T> {
    /// Number of items.
    #[inline(always)]
    pub fn len(&self) -> usize {
        self.items.len().min(self.rows.len())
    }

    /// Whether there is none.
    #[inline(always)]
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// An item, and the records that it touches.
    #[inline(always)]
    pub fn get(&mut self, i: usize) -> (&mut T, Touch<'_, L>) {
        (&mut self.items[i], Touch { index: &self.rows[i], records: self.records })
    }
}

/// The records that an item touches, two per lane.
pub struct Touch<'a, L: Lanes> {
    index: &'a [L::Index; 2],
    records: &'a [Cell<Record>],
}

impl<L: Lanes> Touch<'_, L> {
    /// The numbers of the first or second record of each lane.
    #[inline(always)]
    pub fn gather(&self, side: usize) -> [L; 8] {
        L::gather(self.records, &self.index[side])
    }

    /// Writes the first or second record of each lane.
    #[inline(always)]
    pub fn scatter(&self, side: usize, numbers: [L; 8]) {
        L::scatter(self.records, &self.index[side], numbers);
    }

    /// The numbers of the same places in another list, which nobody changes meanwhile.
    #[inline(always)]
    pub fn gather_from(&self, list: &[Record], side: usize) -> [L; 8] {
        let index = self.index[side].as_ref();
        L::transpose(|lane| list.get(index[lane] as usize).unwrap_or(&Record::ZERO))
    }
}
