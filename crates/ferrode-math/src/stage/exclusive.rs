//! Records that tasks reach by index, no two of them the same.

use super::{Crew, chunks};
use crate::simd::{Lanes, NO_RECORD, Record};
use core::cell::Cell;
use core::ops::Range;

/// For each item of a list the records that it touches: two of them per lane. The list is in groups; items of one group touch
/// different records, which [`Exclusive::verify`] makes sure of, and may be worked on side by side.
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
///         for (row, pair) in pairs.begin([0..2], 2).iter_mut().zip([[0, 1], [2, 3]]) {
///             for (index, record) in row.iter_mut().zip(pair) {
///                 index.as_mut().fill(NO_RECORD);
///                 index.as_mut()[0] = record;
///             }
///         }
///         pairs.verify(self.0, self.1.len());
///         pairs.sweep(self.0, 0, 1, &mut [(); 2], self.1, |lot| L::enter(SwapLot(lot)));
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
    groups: Vec<Group>,
}

#[derive(Clone, Debug, Default)]
struct Group {
    items: Range<usize>,
    /// No record is touched twice.
    apart: bool,
    /// A bit per record, for finding that out.
    seen: Vec<u64>,
}

impl<L: Lanes> Default for Exclusive<L> {
    fn default() -> Self {
        Self { rows: Vec::new(), groups: Vec::new() }
    }
}

impl<L: Lanes> Exclusive<L> {
    /// Starts anew with the items of each group, and returns a row for each item to be filled in: the records' indices, or
    /// [`NO_RECORD`].
    pub fn begin(
        &mut self,
        groups: impl IntoIterator<Item = Range<usize>>,
        items: usize,
    ) -> &mut [[L::Index; 2]] {
        let mut count = 0;
        for range in groups {
            if count == self.groups.len() {
                self.groups.push(Group::default());
            }
            let items = range.start.min(items)..range.end.min(items);
            (self.groups[count].items, self.groups[count].apart) = (items, false);
            count += 1;
        }
        self.groups.truncate(count);
        self.rows.resize(items, [L::Index::default(); 2]);
        &mut self.rows
    }

    /// Looks whether the items of each group touch different ones of `records` records. Items of groups that don't are worked on one
    /// after the other.
    pub fn verify(&mut self, crew: &Crew, records: usize) {
        let Self { rows, groups } = self;
        crew.each(chunks(groups, 1), |_, group| {
            for group in group {
                group.seen.clear();
                group.seen.resize(records.div_ceil(64), 0);
                let rows = rows.get(group.items.clone()).unwrap_or_default();
                let mut apart = true;
                for i in rows.iter().flatten().flat_map(|index| index.as_ref()) {
                    if *i == NO_RECORD {
                        continue;
                    }
                    let bit = 1u64 << (i & 63);
                    match group.seen.get_mut((i >> 6) as usize) {
                        Some(word) if *word & bit == 0 => *word |= bit,
                        _ => apart = false,
                    }
                }
                group.apart = apart;
            }
        });
    }

    /// Calls `work` with all items of a group in lots of `size`, side by side: `items` are those of the group, in the order of its rows.
    pub fn sweep<T: Send>(
        &self,
        crew: &Crew,
        group: usize,
        size: usize,
        items: &mut [T],
        records: &mut [Record],
        work: impl Fn(Lot<'_, L, T>) + Sync,
    ) {
        let Some(group) = self.groups.get(group) else { return };
        let rows = self.rows.get(group.items.clone()).unwrap_or_default();
        let whole = Cell::from_mut(records).as_slice_of_cells();
        if !group.apart || crew.threads() == 1 {
            return work(Lot { rows, items, records: whole });
        }
        let shared = Shared { start: whole.as_ptr(), len: whole.len() };
        crew.each(chunks(items, size), |number, items| {
            let rows = rows.get(number * size..).unwrap_or_default();
            // SAFETY: the cells are borrowed for the whole call. Through a lot they are reached by the indices of its rows alone
            // (`Touch` keeps them to itself, and `Lanes` is sealed). Those of one group were found to be all different, rows
            // can't change meanwhile, and each lot has rows of its own: so no cell is reached by two tasks.
            let records = unsafe { shared.cells() };
            work(Lot { rows, items, records });
        });
    }
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
