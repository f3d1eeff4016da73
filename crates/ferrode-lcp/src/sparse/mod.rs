//! Sparse factorisation over the graph of bodies and joints: six unknowns per body, rows that join at most two bodies.
//!
//! Constraint forces `lambda` and the accelerations they cause obey `A lambda = r` with `A = J M^-1 J^T + S`, `S` the
//! diagonal of CFM/h. Forming `A` is what makes a dense solver slow: it couples all rows that share a body. The same equations with
//! the accelerations kept as unknowns are as sparse as the mechanism. With the inverse mass split as `M^-1 = C C^T` and `y`
//! the acceleration in the coordinates of `C` (so that its mass is 1), and Jacobians `J C`, still called `J`,
//!
//! ```text
//!     [ 1   -J^T ] [ y      ]   [ 0 ]
//!     [ J     S  ] [ lambda ] = [ r ]
//! ```
//!
//! What is eliminated when decides the cost and what rounding leaves:
//!
//! - Contacts, of which there are many to a pair of bodies, and limits: their forces first, which adds `J^T S^-1 J` to the blocks of
//!   the bodies (they are *folded*). However many rows a pair has, that makes one block of 6x6 on the diagonal per body and one per pair.
//! - Light bodies, which carry nothing but up to three joints: before the joints. Their block is the unit matrix, so this costs products
//!   `J_i J_j^T` between their joints and nothing else. A chain of ball joints becomes a band of 3x3 blocks.
//! - The forces of a joint: after one of its bodies, never by dividing by its own `S` alone, which would lose the digits that `S` is
//!   smaller by. What is left is symmetric and quasi-definite, positive for bodies and negative for joints, and has a factor `L D L^T`,
//!   `D` the signs, in any order.
//!
//! ```text
//!     chain o-o-o-o    joints: x .       L: x          tree: eliminate leaves first, nothing fills in
//!                              x x .        x x
//!                                x x          x x      loops and piles: least degree first
//! ```
//!
//! With folded rows the system is stiff: `S^-1` is 1e8 and more against a mass of 1, so one solve knows the forces to seven digits or so.
//! Refinement in the full system of `y` and `lambda` (`system`) brings the rest: each step shrinks the error by about `eps |J|^2 / S`, and
//! `S` is never taken below `1e-10 |J|^2` (what is missing is made good by proximal steps, [`crate::pivoting`]).
//!
//! - `ordering`: which unknown to eliminate next, and the shape of the factor;
//! - `symbolic`: that shape, with where each pair of bodies stands in it, kept while the topology stands;
//! - `matrix`: what the rows put into it;
//! - `factor`: the numbers, column by column from the left, so that after a change only the columns from the changed ones to the
//!   root are done again;
//! - `kernels`: blocks of 3 or 6 rows and columns; `rows`: products with rows;
//! - `abreast`: the same for several islands of one shape at once.
//!
//! (T. Davis, "Direct Methods for Sparse Linear Systems", 2006; D. Baraff, "Linear-time dynamics using Lagrange multipliers",
//! SIGGRAPH 1996; R. Vanderbei, "Symmetric quasi-definite matrices", SIAM J. Optim. 5, 1995; J. Liu, "The role of elimination trees in sparse factorization", 1990.)

pub(crate) mod abreast;
pub(crate) mod factor;
pub(crate) mod kernels;
mod matrix;
pub mod ordering;
pub(crate) mod rows;
pub(crate) mod symbolic;
pub(crate) mod system;

/// Stands for the static world where a body is asked for.
pub const NO_SPARSE_BODY: u32 = u32::MAX;

/// A run of rows that act on the same bodies, such as those of one joint.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct RowBlock {
    /// The bodies, or [`NO_SPARSE_BODY`].
    pub bodies: [u32; 2],
    /// First row.
    pub first: u32,
    /// Number of rows.
    pub count: u32,
}

impl RowBlock {
    pub(crate) fn range(&self) -> core::ops::Range<usize> {
        self.first as usize..(self.first + self.count) as usize
    }
}

/// The Jacobian of one row against its two bodies, times the factor `C` of their inverse mass: `J M^-1 J^T` is then
/// the product of these with themselves.
pub type ScaledRow = [[f64; 6]; 2];
