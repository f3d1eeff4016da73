//! Lanes of aarch64: NEON, which every such machine has.

use super::portable::Block4;
use super::{Lanes, Mask};
use crate::Scalar;
use core::arch::aarch64::*;
use core::ops::{Add, AddAssign, BitAnd, BitOr, Div, Mul, MulAssign, Neg, Not, Sub, SubAssign};

/// Four lanes of NEON.
#[derive(Clone, Copy, Debug)]
#[repr(transparent)]
pub(super) struct F32x4(float32x4_t);

/// All bits of a lane set for true.
#[derive(Clone, Copy, Debug)]
pub(super) struct Mask4(uint32x4_t);

macro_rules! binary {
    ($($trait:ident $method:ident $intrinsic:ident $assign:ident $assign_method:ident;)+) => {$(
        impl $trait for F32x4 {
            type Output = Self;
            #[inline(always)]
            fn $method(self, b: Self) -> Self {
                // SAFETY: every aarch64 machine has NEON.
                Self(unsafe { $intrinsic(self.0, b.0) })
            }
        }

        impl $assign for F32x4 {
            #[inline(always)]
            fn $assign_method(&mut self, b: Self) {
                *self = self.$method(b);
            }
        }
    )+};
}

binary! {
    Add add vaddq_f32 AddAssign add_assign;
    Sub sub vsubq_f32 SubAssign sub_assign;
    Mul mul vmulq_f32 MulAssign mul_assign;
}

impl Div for F32x4 {
    type Output = Self;
    #[inline(always)]
    fn div(self, b: Self) -> Self {
        // SAFETY: every aarch64 machine has NEON.
        Self(unsafe { vdivq_f32(self.0, b.0) })
    }
}

impl Neg for F32x4 {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        // SAFETY: every aarch64 machine has NEON.
        Self(unsafe { vnegq_f32(self.0) })
    }
}

impl PartialEq for F32x4 {
    #[inline(always)]
    fn eq(&self, b: &Self) -> bool {
        self.store() == b.store()
    }
}

impl Default for F32x4 {
    #[inline(always)]
    fn default() -> Self {
        Self::ZERO
    }
}

impl Scalar for F32x4 {
    // SAFETY: a register of floats has the size of as many floats, and every pattern of bits is a value.
    const ZERO: Self = Self(unsafe { core::mem::transmute::<[f32; 4], float32x4_t>([0.0; 4]) });
    // SAFETY: as above.
    const ONE: Self = Self(unsafe { core::mem::transmute::<[f32; 4], float32x4_t>([1.0; 4]) });

    #[inline(always)]
    fn sqrt(self) -> Self {
        // SAFETY: every aarch64 machine has NEON.
        Self(unsafe { vsqrtq_f32(self.0) })
    }

    #[inline(always)]
    fn from_f64(x: f64) -> Self {
        Self::splat(x as f32)
    }
}

impl super::sealed::Sealed for F32x4 {}

impl Lanes for F32x4 {
    const LANES: usize = 4;
    type Mask = Mask4;
    type Block = Block4;
    type Index = [u32; 4];

    #[inline(always)]
    fn splat(x: f32) -> Self {
        // SAFETY: every aarch64 machine has NEON.
        Self(unsafe { vdupq_n_f32(x) })
    }

    #[inline(always)]
    fn load(block: &Block4) -> Self {
        // SAFETY: every aarch64 machine has NEON; a block holds four floats.
        Self(unsafe { vld1q_f32(block.0.as_ptr()) })
    }

    #[inline(always)]
    fn store(self) -> Block4 {
        let mut block = Block4::default();
        // SAFETY: as in `load`.
        unsafe { vst1q_f32(block.0.as_mut_ptr(), self.0) };
        block
    }

    #[inline(always)]
    fn lt(self, b: Self) -> Mask4 {
        // SAFETY: every aarch64 machine has NEON.
        Mask4(unsafe { vcltq_f32(self.0, b.0) })
    }

    #[inline(always)]
    fn le(self, b: Self) -> Mask4 {
        // SAFETY: every aarch64 machine has NEON.
        Mask4(unsafe { vcleq_f32(self.0, b.0) })
    }

    #[inline(always)]
    fn select(mask: Mask4, a: Self, b: Self) -> Self {
        // SAFETY: every aarch64 machine has NEON.
        Self(unsafe { vbslq_f32(mask.0, a.0, b.0) })
    }
}

impl BitAnd for Mask4 {
    type Output = Self;
    #[inline(always)]
    fn bitand(self, b: Self) -> Self {
        // SAFETY: every aarch64 machine has NEON.
        Self(unsafe { vandq_u32(self.0, b.0) })
    }
}

impl BitOr for Mask4 {
    type Output = Self;
    #[inline(always)]
    fn bitor(self, b: Self) -> Self {
        // SAFETY: every aarch64 machine has NEON.
        Self(unsafe { vorrq_u32(self.0, b.0) })
    }
}

impl Not for Mask4 {
    type Output = Self;
    #[inline(always)]
    fn not(self) -> Self {
        // SAFETY: every aarch64 machine has NEON.
        Self(unsafe { vmvnq_u32(self.0) })
    }
}

impl Mask for Mask4 {
    #[inline(always)]
    fn any(self) -> bool {
        // SAFETY: every aarch64 machine has NEON.
        unsafe { vmaxvq_u32(self.0) != 0 }
    }
}
