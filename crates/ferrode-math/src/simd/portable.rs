//! Lanes as arrays: the fallback, and what the other kinds are tested against.

use super::sealed::Sealed;
use super::{Block, Lanes, Mask, Record};
use crate::Scalar;
use core::cell::Cell;
use core::ops::{Add, AddAssign, BitAnd, BitOr, Div, Mul, MulAssign, Neg, Not, Sub, SubAssign};

/// The lanes of an array.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(C)]
pub(super) struct Portable<const N: usize>([f32; N]);

/// A truth value per element.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct PortableMask<const N: usize>([bool; N]);

/// Numbers in memory, aligned to their size.
macro_rules! blocks {
    ($($name:ident, $n:literal, $align:literal;)+) => {$(
        #[derive(Clone, Copy, Debug, Default, PartialEq)]
        #[repr(C, align($align))]
        pub(super) struct $name(pub [f32; $n]);

        impl AsRef<[f32]> for $name {
            #[inline(always)]
            fn as_ref(&self) -> &[f32] {
                &self.0
            }
        }

        impl AsMut<[f32]> for $name {
            #[inline(always)]
            fn as_mut(&mut self) -> &mut [f32] {
                &mut self.0
            }
        }

        impl Block for $name {}

        impl Sealed for Portable<$n> {}

        impl Lanes for Portable<$n> {
            const LANES: usize = $n;
            type Mask = PortableMask<$n>;
            type Block = $name;
            type Index = [u32; $n];

            #[inline(always)]
            fn splat(x: f32) -> Self {
                Self([x; $n])
            }

            #[inline(always)]
            fn load(block: &$name) -> Self {
                Self(block.0)
            }

            #[inline(always)]
            fn store(self) -> $name {
                $name(self.0)
            }

            #[inline(always)]
            fn lt(self, b: Self) -> Self::Mask {
                PortableMask(core::array::from_fn(|i| self.0[i] < b.0[i]))
            }

            #[inline(always)]
            fn le(self, b: Self) -> Self::Mask {
                PortableMask(core::array::from_fn(|i| self.0[i] <= b.0[i]))
            }

            #[inline(always)]
            fn select(mask: Self::Mask, a: Self, b: Self) -> Self {
                Self(core::array::from_fn(|i| if mask.0[i] { a.0[i] } else { b.0[i] }))
            }
        }
    )+};
}

blocks! {
    Block1, 1, 4;
    Block4, 4, 16;
    Block8, 8, 32;
    Block16, 16, 64;
}

/// As [`Lanes::gather`], number by number.
#[inline(always)]
pub(super) fn gather<L: Lanes>(records: &[Cell<Record>], index: &[u32]) -> [L; 8] {
    let mut blocks = [L::Block::default(); 8];
    for (lane, i) in index.iter().enumerate() {
        let record = records.get(*i as usize).map_or(Record::ZERO, Cell::get);
        for (block, x) in blocks.iter_mut().zip(record.0) {
            block.as_mut()[lane] = x;
        }
    }
    blocks.map(|block| L::load(&block))
}

/// As [`Lanes::transpose`], number by number.
#[inline(always)]
pub(super) fn transpose<'a, L: Lanes>(record: impl Fn(usize) -> &'a Record) -> [L; 8] {
    let mut blocks = [L::Block::default(); 8];
    for lane in 0..L::LANES {
        for (block, x) in blocks.iter_mut().zip(record(lane).0) {
            block.as_mut()[lane] = x;
        }
    }
    blocks.map(|block| L::load(&block))
}

/// As [`Lanes::scatter`], number by number.
#[inline(always)]
pub(super) fn scatter<L: Lanes>(records: &[Cell<Record>], index: &[u32], numbers: [L; 8]) {
    let blocks = numbers.map(L::store);
    for (lane, i) in index.iter().enumerate() {
        if let Some(cell) = records.get(*i as usize) {
            cell.set(Record(core::array::from_fn(|k| blocks[k].as_ref()[lane])));
        }
    }
}

impl<const N: usize> Default for Portable<N> {
    #[inline(always)]
    fn default() -> Self {
        Self([0.0; N])
    }
}

macro_rules! elementwise {
    ($($trait:ident $method:ident $op:tt, $assign:ident $assign_method:ident;)+) => {$(
        impl<const N: usize> $trait for Portable<N> {
            type Output = Self;
            #[inline(always)]
            fn $method(self, b: Self) -> Self {
                Self(core::array::from_fn(|i| self.0[i] $op b.0[i]))
            }
        }

        impl<const N: usize> $assign for Portable<N> {
            #[inline(always)]
            fn $assign_method(&mut self, b: Self) {
                *self = *self $op b;
            }
        }
    )+};
}

elementwise! {
    Add add +, AddAssign add_assign;
    Sub sub -, SubAssign sub_assign;
    Mul mul *, MulAssign mul_assign;
}

impl<const N: usize> Div for Portable<N> {
    type Output = Self;
    #[inline(always)]
    fn div(self, b: Self) -> Self {
        Self(core::array::from_fn(|i| self.0[i] / b.0[i]))
    }
}

impl<const N: usize> Neg for Portable<N> {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        Self(self.0.map(|x| -x))
    }
}

impl<const N: usize> Scalar for Portable<N> {
    const ZERO: Self = Self([0.0; N]);
    const ONE: Self = Self([1.0; N]);
    #[inline(always)]
    fn sqrt(self) -> Self {
        Self(self.0.map(f32::sqrt))
    }
    #[inline(always)]
    fn from_f64(x: f64) -> Self {
        Self([x as f32; N])
    }
}

impl<const N: usize> BitAnd for PortableMask<N> {
    type Output = Self;
    #[inline(always)]
    fn bitand(self, b: Self) -> Self {
        Self(core::array::from_fn(|i| self.0[i] & b.0[i]))
    }
}

impl<const N: usize> BitOr for PortableMask<N> {
    type Output = Self;
    #[inline(always)]
    fn bitor(self, b: Self) -> Self {
        Self(core::array::from_fn(|i| self.0[i] | b.0[i]))
    }
}

impl<const N: usize> Not for PortableMask<N> {
    type Output = Self;
    #[inline(always)]
    fn not(self) -> Self {
        Self(self.0.map(|m| !m))
    }
}

impl<const N: usize> Mask for PortableMask<N> {
    #[inline(always)]
    fn any(self) -> bool {
        self.0.iter().any(|m| *m)
    }
}
