//! Limits and motors: the row that a joint adds along or about an axis of its freedom.

/// Stops and motor of one axis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LimitMotor {}
