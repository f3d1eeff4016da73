//! Lanes of every width give the same bits.

use core::cell::Cell;
use ferrode_math::random::OdeRandom;
use ferrode_math::simd::{Kernel, Lanes, Level, Mask, NO_RECORD, Record, dispatch, dispatch_at};

/// Numbers of all sizes, with zeros of both signs, infinities and NaN among them.
fn numbers(count: usize, seed: u32) -> Vec<f32> {
    let mut random = OdeRandom::new(seed);
    (0..count)
        .map(|i| {
            let special = [0.0, -0.0, f32::INFINITY, f32::NEG_INFINITY, f32::NAN, f32::MIN_POSITIVE, 1e-41];
            match i % 11 {
                0 => special[(random.next_u32() as usize >> 3) % special.len()],
                k => {
                    let x = (f64::from(random.next_u32()) / 4294967296.0 - 0.5) as f32;
                    x * [1.0, 10.0, 1e-3, 1e6, 1e-20, 1e20][k % 6]
                }
            }
        })
        .collect()
}

/// Bits of a number, all NaN being one: their payloads are nobody's result.
fn bits(x: f32) -> u32 {
    if x.is_nan() { u32::MAX } else { x.to_bits() }
}

struct Elementwise<'a> {
    a: &'a [f32],
    b: &'a [f32],
}

impl Kernel for Elementwise<'_> {
    type Out = Vec<[u32; 12]>;

    #[inline(always)]
    fn run<L: Lanes>(self) -> Self::Out {
        let mut out = vec![[0; 12]; self.a.len()];
        for start in (0..self.a.len()).step_by(L::LANES) {
            let end = (start + L::LANES).min(self.a.len());
            let mut blocks = [L::Block::default(); 2];
            blocks[0].as_mut()[..end - start].copy_from_slice(&self.a[start..end]);
            blocks[1].as_mut()[..end - start].copy_from_slice(&self.b[start..end]);
            let (a, b) = (L::load(&blocks[0]), L::load(&blocks[1]));
            let pick = |mask| L::select(mask, a, b);
            let mut sum = a;
            sum += b;
            sum -= L::splat(0.3);
            sum *= L::from_f64(0.1);
            let results = [
                a + b,
                a - b,
                a * b,
                a / b,
                a.sqrt(),
                -a,
                a.min(b),
                a.max(b),
                pick(a.lt(b)),
                pick(a.le(b) & b.le(L::ONE) | !b.le(L::ZERO)),
                if a.lt(b).any() | !a.lt(b).any() { sum } else { L::ZERO },
                L::ZERO - a * b + L::ONE,
            ];
            for (k, r) in results.into_iter().enumerate() {
                let block = r.store();
                for (lane, x) in block.as_ref()[..end - start].iter().enumerate() {
                    out[start + lane][k] = bits(*x);
                }
            }
        }
        out
    }
}

#[test]
fn arithmetic_gives_the_same_bits_at_every_width() {
    let (a, b) = (numbers(4001, 1), numbers(4001, 2));
    let run = |level| dispatch_at(level, Elementwise { a: &a, b: &b });
    let scalar = run(Level::Scalar);
    // The scalar kind is the plain arithmetic of the language.
    for (i, (x, y)) in a.iter().zip(&b).enumerate() {
        assert_eq!(scalar[i][..5], [x + y, x - y, x * y, x / y, x.sqrt()].map(bits));
        assert_eq!(scalar[i][6], bits(if x < y { *x } else { *y }));
        assert_eq!(scalar[i][7], bits(if x > y { *x } else { *y }));
    }
    let mut seen = 0;
    for level in Level::ALL.into_iter().filter(|level| level.is_available()) {
        assert!(run(level) == scalar, "{level:?}");
        seen += 1;
    }
    assert!(seen >= 4);
    assert!(dispatch(Elementwise { a: &a, b: &b }) == scalar);
}

struct Double<'a> {
    records: &'a mut [Record],
    index: &'a [u32],
}

impl Kernel for Double<'_> {
    type Out = Vec<[u32; 8]>;

    /// Doubles the records named, and returns what was read.
    #[inline(always)]
    fn run<L: Lanes>(self) -> Self::Out {
        let cells = Cell::from_mut(self.records).as_slice_of_cells();
        let mut read = Vec::new();
        for chunk in self.index.chunks(L::LANES) {
            let mut index = L::Index::default();
            index.as_mut().fill(NO_RECORD);
            index.as_mut()[..chunk.len()].copy_from_slice(chunk);
            let numbers = L::gather(cells, &index);
            let blocks = numbers.map(L::store);
            let copies: Vec<Record> = (index.as_ref().iter())
                .map(|i| cells.get(*i as usize).map_or(Record::ZERO, Cell::get))
                .collect();
            assert!(L::transpose(|lane| &copies[lane]) == numbers);
            read.extend((0..chunk.len()).map(|lane| blocks.map(|b| b.as_ref()[lane].to_bits())));
            L::scatter(cells, &index, numbers.map(|x| x + x));
        }
        read
    }
}

#[test]
fn records_are_gathered_and_scattered() {
    let records: Vec<Record> =
        (0..100).map(|i| Record(core::array::from_fn(|k| (i * 8 + k) as f32))).collect();
    let mut index: Vec<u32> = (0..100).map(|i| (i * 37) % 100).collect();
    index.extend([NO_RECORD, 100, 5000, NO_RECORD]);
    index.swap(3, 101);
    index.swap(50, 103);
    for level in Level::ALL.into_iter().filter(|level| level.is_available()) {
        let mut changed = records.clone();
        let read = dispatch_at(level, Double { records: &mut changed, index: &index });
        assert_eq!(read.len(), index.len());
        for (i, read) in index.iter().zip(&read) {
            let expected = records.get(*i as usize).copied().unwrap_or_default();
            assert_eq!(*read, expected.0.map(f32::to_bits), "{level:?} record {i}");
        }
        for (before, after) in records.iter().zip(&changed) {
            assert_eq!(before.0.map(|x| x + x), after.0, "{level:?}");
        }
    }
}
