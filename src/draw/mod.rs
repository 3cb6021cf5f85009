//! Shapes, answers and searches as lines, points and texts, for the author of an engine who looks for what a query did.
//!
//! Nothing on the way of a query knows of it: the query is asked anew, cold, and its march is the same query with budgets of one
//! step, two, three; the polytope is read out of the cache of a depth.

mod target;
mod body;
mod answer;
mod march;
mod pair;

pub use pair::pair;
pub(crate) use target::Pen;
pub use target::{Draw, DrawKind};

use crate::base::error::Result;
use crate::base::simd::environment::with_default;
use crate::shape::Placed;

/// Draws the edges of a shape; see [`DrawKind::Edge`].
///
/// # Errors
/// [`Error::Pose`](crate::base::error::Error::Pose) for a pose that is not accepted; nothing is drawn then.
pub fn shape(body: Placed, draw: &mut dyn Draw) -> Result<()> {
    body.pose.check()?;
    with_default(|| Pen::new(draw).shape(body));
    Ok(())
}
