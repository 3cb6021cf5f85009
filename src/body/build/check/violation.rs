//! The error for a mesh that breaks the contract.

use crate::base::error::{Error, Result};

/// Which option admits a body that lies in a plane.
pub const FLAT_HINT: &str = "the input policy Flat (SWIFTPROX_INPUT_FLAT) admits bodies without interior";

/// Which option admits a body that is a segment or a point.
pub const HULL_HINT: &str = "the input policy Hull (SWIFTPROX_INPUT_HULL) admits segments and points";

/// The refusal.
///
/// # Errors
/// Always.
pub fn violation<T>(message: String) -> Result<T> {
    Err(Error::Mesh(message))
}
