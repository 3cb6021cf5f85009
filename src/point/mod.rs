//! A point and a placed body: where the point is, and which vertex of the body is farthest along a direction.
//!
//! A point is a body of one vertex, and goes up the same ladder as any pair; there is no second solver.

mod answer;
mod locate;
mod support;

pub use answer::{PointAnswer, PointLocation, SupportVertex};
pub use locate::locate_point;
pub use support::support;

use crate::base::error::{Error, Result};

/// Refuses numbers that are not finite.
///
/// # Errors
/// [`Error::Argument`], naming the first.
pub(crate) fn check_finite(name: &str, numbers: &[f64; 3]) -> Result<()> {
    match numbers.iter().position(|x| !x.is_finite()) {
        None => Ok(()),
        Some(k) => Err(Error::Argument(format!("{name}[{k}] is {}, it must be finite", numbers[k]))),
    }
}
