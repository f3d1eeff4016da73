//! ferrode-math
