//! What can be wrong with the input of a solver. Every variant names the thing and the value.

use std::fmt;

/// An error in what the caller handed over. The solvers check first and touch the outputs only when all is well.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum LcpError {
    /// A slice is too short for the sizes given.
    Size {
        /// Which argument.
        what: &'static str,
        /// The number of elements it must hold.
        need: usize,
        /// The number of elements it holds.
        got: usize,
    },
    /// A leading dimension is smaller than the number of columns.
    Stride {
        /// The number of columns.
        columns: usize,
        /// The leading dimension given.
        stride: usize,
    },
    /// An index lies outside its range.
    Index {
        /// Which argument.
        what: &'static str,
        /// The value given.
        index: usize,
        /// The first value that is too large.
        end: usize,
    },
    /// A row's bounds do not contain zero (`lo <= 0 <= hi` is required), or are not numbers.
    Bounds {
        /// The row.
        row: usize,
        /// Its lower bound.
        lo: f64,
        /// Its upper bound.
        hi: f64,
    },
    /// A row's friction index names no row.
    FrictionIndex {
        /// The row.
        row: usize,
        /// The index given.
        findex: i32,
    },
    /// A row names a body that does not exist, or the same body twice.
    Body {
        /// The row.
        row: usize,
        /// The two body indices given.
        body: [u32; 2],
    },
    /// A parameter is not a usable number.
    Parameter {
        /// Which parameter.
        what: &'static str,
        /// The value given.
        value: f64,
    },
}

impl fmt::Display for LcpError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match *self {
            LcpError::Size { what, need, got } => {
                write!(f, "{what} holds {got} elements but {need} are needed")
            }
            LcpError::Stride { columns, stride } => {
                write!(f, "the leading dimension {stride} is smaller than the {columns} columns")
            }
            LcpError::Index { what, index, end } => {
                write!(f, "{what} is {index} but must be below {end}")
            }
            LcpError::Bounds { row, lo, hi } => {
                write!(f, "the bounds of row {row}, [{lo}, {hi}], do not contain zero")
            }
            LcpError::FrictionIndex { row, findex } => {
                write!(f, "the friction index {findex} of row {row} names no row")
            }
            LcpError::Body { row, body } => {
                write!(
                    f,
                    "row {row} names the bodies {} and {}: unknown, or the same twice",
                    body[0], body[1]
                )
            }
            LcpError::Parameter { what, value } => write!(f, "{what} is {value}, which cannot be used"),
        }
    }
}

impl std::error::Error for LcpError {}

/// Fails unless a slice of `got` elements holds `need`.
pub(crate) fn check_len(what: &'static str, got: usize, need: usize) -> Result<(), LcpError> {
    if got < need { Err(LcpError::Size { what, need, got }) } else { Ok(()) }
}

/// Fails unless a slice of `got` elements holds a `rows` x `columns` matrix with leading dimension `stride`.
/// The padding of the last row need not be there.
pub(crate) fn check_matrix(
    what: &'static str,
    got: usize,
    rows: usize,
    columns: usize,
    stride: usize,
) -> Result<(), LcpError> {
    if rows == 0 || columns == 0 {
        return Ok(());
    }
    if stride < columns {
        return Err(LcpError::Stride { columns, stride });
    }
    let need = (rows - 1).checked_mul(stride).and_then(|k| k.checked_add(columns)).unwrap_or(usize::MAX);
    check_len(what, got, need)
}
