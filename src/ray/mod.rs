//! Rays: where a ray enters a placed shape and where it leaves it, as intervals that hold.
//!
//! The hull's planes give bounds of both places: the body is behind each plane, up to its slack. A walk over the surface proposes
//! the faces through which the ray comes and goes. A hit is proved where the ray passes through the polygon of such a face's
//! corners, a miss where the bound of coming lies behind that of going (Cyrus & Beck 1978). Where rounding hides either, integers
//! decide.
//!
//! A body with a swept radius is its hull with a ball, which stays round in the world: the same proofs, by planes that support it
//! and balls in it.

mod query;
mod answer;
mod line;
mod walk;
mod exact;
mod search;
mod rounded;
mod swept_exact;
mod swept;

pub use answer::{RayAnswer, RayOutcome};
#[doc(hidden)]
pub use line::SIDE;
pub use query::Ray;

use crate::base::error::Result;
use crate::base::memory::in_integers;
use crate::base::simd::environment::with_default;
use crate::pair::Placed;

/// Casts a ray at a body, see [`RayAnswer`]: guaranteed, whatever the magnitudes. A ray that only touches hits.
///
/// # Errors
/// [`Error::Pose`](crate::base::error::Error::Pose) for a pose that is not accepted, as in [`crate::pair::distance`].
/// [`Error::Argument`](crate::base::error::Error::Argument) for an origin or a direction that is not finite, a direction of 0,
/// and a `t_max` that is negative or NaN. [`Error::Memory`](crate::base::error::Error::Memory) where there is none for integers.
pub fn cast_ray(body: Placed, ray: &Ray) -> Result<RayAnswer> {
    with_default(|| {
        ray.check()?;
        body.pose.check()?;
        match body.shape.swept_radius() {
            0.0 => search::cast(body.shape.polyhedron(), body.pose, ray),
            radius => in_integers(|| swept::cast(body.shape.polyhedron(), body.pose, ray, radius)),
        }
    })
}

/// The same of a ray and a pose that are accepted, in integers alone: both ends are neighbouring doubles.
///
/// # Errors
/// [`Error::Memory`](crate::base::error::Error::Memory) where there is none for integers.
pub(crate) fn cast_ray_in_integers(body: Placed, ray: &Ray) -> Result<RayAnswer> {
    match body.shape.swept_radius() {
        0.0 => search::cast_in_integers(body.shape.polyhedron(), body.pose, ray),
        radius => in_integers(|| swept::cast_in_integers(body.shape.polyhedron(), body.pose, ray, radius)),
    }
}
