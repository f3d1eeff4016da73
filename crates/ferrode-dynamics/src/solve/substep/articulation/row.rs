//! Rows of joints in lanes.

use super::sweep::Aim;
use super::triple::dot;
use crate::solve::substep::joints::JointRow;
use ferrode_math::simd::{Lanes, Mask};

/// Part of the diagonal that is added to it.
pub(super) const SOFTNESS: f32 = 1e-6;
/// Velocity, in m/s or rad/s, by which a row has to strive away from its bound to be freed.
const RELEASE: f32 = 1e-4;

/// How a row takes part.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) enum Role {
    /// It fills up a node, and does nothing.
    #[default]
    Filling,
    /// Without bounds.
    Plain,
    /// A spring, that stays one in the relaxing pass.
    Spring,
    /// With bounds, in some lane.
    Bounded,
}

/// The same row of several joints.
#[derive(Clone, Copy, Debug)]
pub(super) struct LaneRow<L: Lanes> {
    /// The scaled Jacobian's angular parts. The linear parts are their joint's.
    pub angular: [[L; 3]; 2],
    pub impulse: L,
    /// Wanted velocity with the correction, in the biased and the relaxing pass.
    pub wanted: [L; 2],
    /// Error of position, of rows without bounds that are no springs.
    pub error: L,
    pub gamma: L,
    /// What is added to the diagonal beside γ.
    pub softness: L,
    /// 1 where the row takes part, 0 where its impulse is fixed.
    pub free: L,
    pub role: Role,
}

impl<L: Lanes> LaneRow<L> {
    pub fn new(role: Role) -> Self {
        Self {
            angular: [[L::ZERO; 3]; 2],
            impulse: L::ZERO,
            wanted: [L::ZERO; 2],
            error: L::ZERO,
            gamma: L::ZERO,
            softness: L::ZERO,
            free: if role == Role::Filling { L::ZERO } else { L::ONE },
            role,
        }
    }

    /// What is left of J̃ ũ − target − bias + Γ λ at an impulse λ.
    #[inline(always)]
    pub fn residual(&self, aim: Aim, velocity: L, impulse: L) -> L {
        velocity - self.wanted[usize::from(aim == Aim::Relax)] + (self.gamma + self.softness) * impulse
    }

    /// The angular part of J̃ ũ.
    #[inline(always)]
    pub fn turning(&self, u: [&[L; 6]; 2]) -> L {
        dot(&self.angular[0], &angular(u[0])) + dot(&self.angular[1], &angular(u[1]))
    }
}

#[inline(always)]
pub(super) fn angular<L: Lanes>(u: &[L; 6]) -> [L; 3] {
    [u[3], u[4], u[5]]
}

#[inline(always)]
pub(super) fn linear<L: Lanes>(u: &[L; 6]) -> [L; 3] {
    [u[0], u[1], u[2]]
}

/// The bounds of a row.
#[derive(Clone, Copy, Debug)]
pub(super) struct Bound<L: Lanes> {
    /// Place of the row, and its joint.
    pub row: u32,
    pub joint: u32,
    pub lo: L,
    pub hi: L,
    /// The impulse where the row does not take part.
    pub fixed: L,
}

impl<L: Lanes> Bound<L> {
    #[inline(always)]
    pub fn clamp(&self, x: L) -> L {
        x.max(self.lo).min(self.hi)
    }

    /// Where an impulse x at a bound and what is left of the row's equation ask for the row to give way.
    #[inline(always)]
    pub fn gives_way(&self, x: L, residual: L) -> L::Mask {
        let from_lo = x.le(self.lo) & residual.lt(L::splat(-RELEASE));
        let from_hi = self.hi.le(x) & L::splat(RELEASE).lt(residual);
        self.lo.lt(self.hi) & (from_lo | from_hi)
    }

    /// Guesses where the row takes part, from its impulse x and its velocity before the sweep. Whether that is another answer than before.
    #[inline(always)]
    pub fn guess(&mut self, row: &mut LaneRow<L>, aim: Aim, velocity: L, x: L) -> bool {
        let inside = self.lo.lt(x) & x.lt(self.hi);
        let free = inside | self.gives_way(x, row.residual(aim, velocity, x));
        let free = L::select(free, L::ONE, L::ZERO);
        let other = (free.lt(row.free) | row.free.lt(free)).any();
        (row.free, self.fixed) = (free, self.clamp(x));
        other
    }

    /// Puts the row to its bound where the impulse `new` is beyond, and where `freeing` frees it if it strives away. Whether it did.
    #[inline(always)]
    pub fn correct(&mut self, row: &mut LaneRow<L>, aim: Aim, velocity: L, new: L, freeing: bool) -> bool {
        let takes_part = L::ZERO.lt(row.free);
        let beyond = takes_part & (new.lt(self.lo) | self.hi.lt(new));
        let mut freed = beyond & !beyond;
        if freeing {
            freed = self.gives_way(new, row.residual(aim, velocity, new)) & !takes_part;
        }
        self.fixed = L::select(beyond, self.clamp(new), self.fixed);
        row.free = L::select(beyond, L::ZERO, L::select(freed, L::ONE, row.free));
        (beyond | freed).any()
    }
}

/// Rows as a joint has written them, of several joints, for the lanes to be filled one after the other.
#[derive(Clone, Copy, Debug)]
pub(super) struct Written<L: Lanes> {
    jacobian: [[L::Block; 6]; 2],
    target: L::Block,
    bias: [L::Block; 2],
    error: L::Block,
    gamma: L::Block,
    lo: L::Block,
    hi: L::Block,
    impulse: L::Block,
    role: Role,
}

impl<L: Lanes> Written<L> {
    pub fn new() -> Self {
        let zero = L::Block::default();
        Self {
            jacobian: [[zero; 6]; 2],
            target: zero,
            bias: [zero; 2],
            error: zero,
            gamma: zero,
            lo: L::splat(f32::NEG_INFINITY).store(),
            hi: L::splat(f32::INFINITY).store(),
            impulse: zero,
            role: Role::Plain,
        }
    }

    #[inline(always)]
    pub fn set(&mut self, lane: usize, row: &JointRow) {
        for (to, from) in self.jacobian.iter_mut().zip(&row.jacobian) {
            for (to, from) in to.iter_mut().zip(from) {
                to.as_mut()[lane] = *from;
            }
        }
        self.target.as_mut()[lane] = row.target;
        self.bias[0].as_mut()[lane] = row.bias;
        self.bias[1].as_mut()[lane] = if row.spring { row.bias } else { 0.0 };
        self.error.as_mut()[lane] = row.error;
        self.gamma.as_mut()[lane] = row.gamma;
        self.lo.as_mut()[lane] = row.lo;
        self.hi.as_mut()[lane] = row.hi;
        self.impulse.as_mut()[lane] = row.impulse;
        if row.lo > f32::NEG_INFINITY || row.hi < f32::INFINITY {
            self.role = Role::Bounded;
        } else if row.spring && self.role == Role::Plain {
            self.role = Role::Spring;
        }
    }

    /// The row, its linear parts and its bounds, in world units still.
    #[inline(always)]
    pub fn row(&self) -> (LaneRow<L>, [[L; 3]; 2], [L; 2]) {
        let mut row = LaneRow::new(self.role);
        let mut linear = [[L::ZERO; 3]; 2];
        for ((linear, angular), jacobian) in linear.iter_mut().zip(&mut row.angular).zip(&self.jacobian) {
            for (to, from) in linear.iter_mut().chain(angular).zip(jacobian) {
                *to = L::load(from);
            }
        }
        for (wanted, bias) in row.wanted.iter_mut().zip(&self.bias) {
            *wanted = L::load(&self.target) + L::load(bias);
        }
        row.error = L::load(&self.error);
        row.gamma = L::load(&self.gamma);
        row.impulse = L::load(&self.impulse);
        (row, linear, [L::load(&self.lo), L::load(&self.hi)])
    }
}
