//! Rays: where a ray enters a placed shape and where it leaves it, as intervals that hold.
//!
//! The hull's planes give bounds of both places: the body is behind each plane, up to its slack. A walk over the surface proposes
//! the faces through which the ray comes and goes. A hit is proved where the ray passes through the polygon of such a face's
//! corners, a miss where the bound of coming lies behind that of going (Cyrus & Beck 1978). Where rounding hides either, integers
//! decide.

mod query;
mod answer;
mod line;
mod walk;
mod exact;
mod search;

pub use answer::{RayAnswer, RayOutcome};
pub use query::Ray;

use crate::base::error::{Error, Result};
use crate::base::math::ROTATION_LIMIT;
use crate::base::simd::environment::with_default;
use crate::pair::Placed;

/// Where a ray meets a body, see [`RayAnswer`]: certain, whatever the magnitudes. A ray that only touches hits.
///
/// # Errors
/// [`Error::Pose`](crate::base::error::Error::Pose) for a pose that is not accepted, as in [`crate::pair::distance`].
/// [`Error::Argument`] for an origin or a direction that is not finite, a direction of 0, a `t_max` that is negative or NaN, and a
/// shape with a swept radius. [`Error::Memory`] where there is none for integers.
pub fn cast_ray(body: Placed, ray: &Ray) -> Result<RayAnswer> {
    with_default(|| {
        ray.check()?;
        body.pose.check(ROTATION_LIMIT)?;
        let radius = body.shape.swept_radius();
        if radius > 0.0 {
            return Err(Error::Argument(format!(
                "the shape has a swept radius of {radius:e}: rays are cast at shapes without one, a distance tells how near they pass"
            )));
        }
        search::cast(body.shape.polyhedron(), body.pose, ray)
    })
}

/// The same of a ray and a pose that are accepted, in integers alone: both ends are neighbouring doubles.
///
/// # Errors
/// [`Error::Memory`] where there is none for integers.
pub(crate) fn cast_ray_in_integers(body: Placed, ray: &Ray) -> Result<RayAnswer> {
    search::cast_in_integers(body.shape.polyhedron(), body.pose, ray)
}
