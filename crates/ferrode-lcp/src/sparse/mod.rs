//! Sparse factorisation over the graph of bodies: six unknowns per body, rows that join at most two bodies.
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
//! Eliminating the forces first gives `H y = J^T S^-1 r` with `H = 1 + J^T S^-1 J`: symmetric positive definite, one block of 6x6
//! per body on the diagonal and one per pair of bodies beside it, however many rows the pair has.
//!
//! ```text
//!     chain o-o-o-o    H: x .          L: x          tree: eliminate leaves first, nothing fills in
//!                         x x .           x x
//!                           x x .           x x      loops and piles: least degree first
//!                             x x             x x
//! ```
//!
//! `H` is stiff: `S^-1` is 1e8 and more against a mass of 1, so one solve knows the forces to seven digits or so. Refinement in the
//! full system of `y` and `lambda` (`system`) brings the rest: each step shrinks the error by about `eps |J|^2 / S`, and `S` is
//! never taken below `1e-10 |J|^2` (what is missing is made good by proximal steps, [`crate::pivoting`]). No row is ever eliminated
//! by dividing by its own `S` alone after its bodies are gone, which would lose everything.
//!
//! - `ordering`: which body to eliminate next, and the shape of the factor;
//! - `symbolic`: that shape, with where each pair of bodies stands in it, kept while the topology stands;
//! - `factor`: the numbers, `H = L L^T`, column by column from the left, so that after a change only the columns from the
//!   changed bodies to the root are done again;
//! - `kernel6`: blocks of 6x6.
//!
//! (T. Davis, "Direct Methods for Sparse Linear Systems", 2006; D. Baraff, "Linear-time dynamics using Lagrange multipliers",
//! SIGGRAPH 1996; J. Liu, "The role of elimination trees in sparse factorization", 1990.)

pub(crate) mod factor;
pub(crate) mod kernel6;
pub(crate) mod ordering;
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
