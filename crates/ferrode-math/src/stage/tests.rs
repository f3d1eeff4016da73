use super::{Crew, Exclusive, Lent, Lot, Pieces, chunks, cut};
use crate::simd::{Kernel, Lanes, Level, NO_RECORD, Record, Work, dispatch_at};
use core::sync::atomic::{AtomicBool, AtomicU32, Ordering};
use std::panic::{AssertUnwindSafe, catch_unwind};

#[test]
fn every_task_is_done_once() {
    for threads in [1, 2, 3, 5] {
        let crew = Crew::new(threads);
        for round in 0..300 {
            let tasks = [0, 1, 2, 3, 7, 64, 1000, 10_000][round % 8];
            let done: Vec<AtomicU32> = (0..tasks).map(|_| AtomicU32::new(0)).collect();
            crew.run(tasks, |i| {
                done[i].fetch_add(1, Ordering::Relaxed);
            });
            assert!(done.iter().all(|d| d.load(Ordering::Relaxed) == 1), "{threads} threads, {tasks} tasks");
            if round % 50 == 0 {
                crew.rest();
                std::thread::sleep(std::time::Duration::from_millis(5));
            }
        }
    }
}

#[test]
fn helpers_take_part() {
    let crew = Crew::new(2);
    assert_eq!(crew.threads(), 2);
    // Each waits for the other: one thread alone would not come back.
    let there = [AtomicBool::new(false), AtomicBool::new(false)];
    crew.run(2, |i| {
        there[i].store(true, Ordering::Release);
        while !there[1 - i].load(Ordering::Acquire) {
            std::thread::yield_now();
        }
    });
}

#[test]
fn pieces_are_cut_at_the_same_places() {
    let crew = Crew::new(3);
    let (mut a, mut b, mut c) = (vec![0usize; 1000], vec![0u8; 3000], vec![0; 10]);
    crew.each((chunks(&mut a, 100), chunks(&mut b, 300), chunks(&mut c, 1)), |i, (a, b, c)| {
        a.fill(i);
        b.fill(i as u8);
        c[0] = a.len() + b.len();
    });
    assert!(a.iter().enumerate().all(|(i, x)| *x == i / 100));
    assert!(b.iter().enumerate().all(|(i, x)| *x as usize == i / 300));
    assert_eq!(c, [400; 10]);
}

#[test]
fn a_panic_comes_to_the_caller_and_the_crew_goes_on() {
    let crew = Crew::new(3);
    for round in 0..50 {
        let done = AtomicU32::new(0);
        let outcome = catch_unwind(AssertUnwindSafe(|| {
            crew.run(100, |i| {
                done.fetch_add(1, Ordering::Relaxed);
                assert!(i != 37 + round, "task {i}");
            });
        }));
        let message = *outcome.unwrap_err().downcast::<String>().unwrap();
        assert_eq!(message, format!("task {}", 37 + round));
        assert_eq!(done.load(Ordering::Relaxed), 100);
        crew.run(100, |_| {
            done.fetch_add(1, Ordering::Relaxed);
        });
        assert_eq!(done.load(Ordering::Relaxed), 200);
    }
}

#[test]
fn who_finds_the_helpers_busy_works_alone() {
    let crew = Crew::new(2);
    let done = AtomicU32::new(0);
    crew.run(8, |_| {
        crew.run(8, |_| {
            done.fetch_add(1, Ordering::Relaxed);
        });
    });
    std::thread::scope(|scope| {
        for _ in 0..3 {
            scope.spawn(|| {
                for _ in 0..200 {
                    crew.run(8, |_| {
                        done.fetch_add(1, Ordering::Relaxed);
                    });
                }
            });
        }
    });
    assert_eq!(done.into_inner(), 64 + 4800);
}

/// Adds to records, group by group; tells how many lots each group came in, and how many of them tasks of the crew had.
struct Add<'a> {
    crew: &'a Crew,
    rows: &'a [[u32; 2]],
    groups: &'a [Vec<usize>],
    records: &'a mut [Record],
}

struct AddLot<'a, L: Lanes>(Lot<'a, L, u32>);

impl<L: Lanes> Work<L> for AddLot<'_, L> {
    #[inline(always)]
    fn run(mut self) {
        for i in 0..self.0.len() {
            let (item, touch) = self.0.get(i);
            *item += 1;
            let sum = L::splat(*item as f32);
            for side in 0..2 {
                touch.scatter(side, touch.gather(side).map(|x| x * L::splat(1.5) + sum));
            }
        }
    }
}

impl Kernel for Add<'_> {
    type Out = Vec<[u32; 2]>;

    fn run<L: Lanes>(self) -> Vec<[u32; 2]> {
        let mut lists = Exclusive::<L>::default();
        let rows = lists.begin(self.groups.iter().cloned(), self.rows.len());
        for (row, pair) in rows.iter_mut().zip(self.rows) {
            for (index, record) in row.iter_mut().zip(pair) {
                index.as_mut().fill(NO_RECORD);
                index.as_mut()[0] = *record;
            }
        }
        lists.verify(self.crew, self.records.len());
        let mut items: Vec<u32> = (0..self.rows.len() as u32).collect();
        let mut lots = Vec::new();
        let mut first = 0;
        for (group, ends) in self.groups.iter().enumerate() {
            let (count, tasks, end) = (AtomicU32::new(0), AtomicU32::new(0), ends[ends.len() - 1]);
            let items = &mut items[core::mem::replace(&mut first, end)..end];
            lists.sweep(self.crew, group, items, self.records, |lot| {
                count.fetch_add(1, Ordering::Relaxed);
                tasks.fetch_add(u32::from(self.crew.is_busy()), Ordering::Relaxed);
                L::enter(AddLot(lot));
            });
            lots.push([count.into_inner(), tasks.into_inner()]);
        }
        lots
    }
}

#[test]
fn parts_that_share_records_are_worked_on_in_order() {
    // The parts of the first group have records of their own, those of the second share one, one of the third has one that is not there,
    // and in the fourth a part has one twice, which is its own affair.
    let mut rows: Vec<[u32; 2]> = (0..32).map(|i| [2 * i, 2 * i + 1]).collect();
    rows.extend((0..20).map(|i| [i, if i == 11 { 3 } else { 63 - i }]));
    rows.extend((0..12).map(|i| [i, if i == 5 { 64 } else { NO_RECORD }]));
    rows.extend((0..12).map(|i| [i / 3, if i == 5 { 1 } else { 63 - i }]));
    let lots = |first: usize, end: usize| (first + 3..end).step_by(3).chain([end]).collect();
    let groups: [Vec<usize>; 4] = [lots(0, 32), lots(32, 52), lots(52, 64), lots(64, 76)];
    let run = |threads, level| {
        let mut records: Vec<Record> = (0..64).map(|i| Record([i as f32; 8])).collect();
        let crew = Crew::new(threads);
        let lots =
            dispatch_at(level, Add { crew: &crew, rows: &rows, groups: &groups, records: &mut records });
        let bits: Vec<u32> = records.iter().flat_map(|r| r.0.map(f32::to_bits)).collect();
        (lots, bits)
    };
    let (lots, alone) = run(1, Level::Scalar);
    assert_eq!(lots, [11, 7, 4, 4].map(|n| [n, 0]));
    for level in Level::ALL.into_iter().filter(|level| level.is_available()) {
        for threads in [1, 2, 4] {
            let (lots, bits) = run(threads, level);
            let shared = if threads == 1 { [0; 4] } else { [11, 0, 0, 4] };
            assert_eq!(
                lots.iter().map(|lots| lots[1]).collect::<Vec<_>>(),
                shared,
                "{level:?}, {threads} threads"
            );
            assert!(bits == alone, "{level:?}, {threads} threads");
        }
    }
}

#[test]
fn cuts_that_overlap_are_refused() {
    let mut list = [0u8; 10];
    for ends in [&[4, 3][..], &[11], &[2, 5, 13]] {
        assert!(catch_unwind(AssertUnwindSafe(|| cut(&mut list, 0, ends).count())).is_err(), "{ends:?}");
    }
    let crew = Crew::new(2);
    crew.each(cut(&mut list, 5, &[5, 8, 14]), |i, piece| piece.fill(i as u8 + 1));
    assert_eq!(list, [2, 2, 2, 3, 3, 3, 3, 3, 3, 0]);
}

/// Gives each owner the sum of its records, and adds one to these in both lists; tells how many owners were served by tasks of the crew.
struct Serve<'a> {
    crew: &'a Crew,
    rows: &'a [[u32; 2]],
    ends: &'a [usize],
    owners: &'a mut [f32],
    lists: [&'a mut [Record]; 2],
}

struct ServeOne<'a, L: Lanes>(&'a mut f32, Lent<'a, L, 2>, usize);

impl<L: Lanes> Work<L> for ServeOne<'_, L> {
    #[inline(always)]
    fn run(self) {
        let Self(sum, lent, records) = self;
        for i in 0..records {
            for list in 0..2 {
                let numbers = lent.gather(list, i);
                *sum += numbers[0].store().as_ref()[0];
                lent.scatter(list, i, numbers.map(|x| x + L::ONE));
            }
        }
    }
}

impl Kernel for Serve<'_> {
    type Out = u32;

    fn run<L: Lanes>(self) -> u32 {
        let mut lists = Exclusive::<L>::default();
        for (row, pair) in lists.begin([self.ends.to_vec()], self.rows.len()).iter_mut().zip(self.rows) {
            for (index, record) in row.iter_mut().zip(pair) {
                index.as_mut().fill(NO_RECORD);
                index.as_mut()[0] = *record;
            }
        }
        lists.verify(self.crew, self.lists[0].len());
        let served = AtomicU32::new(0);
        lists.lend(self.crew, 0, self.owners, self.lists, |owner, lent| {
            served.fetch_add(u32::from(self.crew.is_busy()), Ordering::Relaxed);
            L::enter(ServeOne(owner, lent, 4));
        });
        served.into_inner()
    }
}

#[test]
fn owners_are_lent_their_records_alone() {
    // Two rows each, of records of their own; or the last owner has one of the first's.
    for (shares, last) in [(false, 31), (true, 2)] {
        let rows: Vec<[u32; 2]> = (0..16).map(|i| [2 * i, if i == 15 { last } else { 2 * i + 1 }]).collect();
        let ends: Vec<usize> = (1..=8).map(|i| 2 * i).collect();
        let run = |threads, level| {
            let (mut owners, mut one) = ([0.0; 8], [Record::ZERO; 32]);
            one.iter_mut().enumerate().for_each(|(i, r)| r.0 = [i as f32; 8]);
            let mut two = one;
            let (crew, lists) = (Crew::new(threads), [&mut one[..], &mut two[..]]);
            let serve = Serve { crew: &crew, rows: &rows, ends: &ends, owners: &mut owners, lists };
            (dispatch_at(level, serve), owners, one.map(|r| r.0), two.map(|r| r.0))
        };
        let alone = run(1, Level::Scalar);
        assert_eq!(alone.0, 0);
        assert_eq!(alone.1[1], 2.0 * (4.0 + 5.0 + 6.0 + 7.0));
        for level in Level::ALL.into_iter().filter(|level| level.is_available()) {
            let together = run(3, level);
            assert_eq!(together.0, if shares { 0 } else { 8 }, "{level:?}");
            assert!((together.1, together.2, together.3) == (alone.1, alone.2, alone.3), "{level:?}");
        }
    }
}
