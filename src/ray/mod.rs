//! Rays: where a ray enters a placed shape and where it leaves it, as intervals that hold.
//!
//! The hull's planes give bounds of both places: the body is behind each plane, up to its slack. A walk over the surface proposes
//! the faces through which the ray comes and goes. A hit is proved where the ray passes through the polygon of such a face's
//! corners, a miss where the bound of coming lies behind that of going (Cyrus & Beck 1978). Where rounding hides either, integers
//! decide.
//!
//! A body with a swept radius is its hull with a ball, which stays round in the world: the same proofs, by planes that support it
//! and balls in it.
//!
//! A curved body lies between its polyhedron and that with a ball of its deviation: a ray at both tells between which places it
//! enters and leaves the body.

mod query;
mod answer;
mod line;
mod walk;
mod exact;
mod search;
mod rounded;
mod swept_exact;
mod swept;
mod slabs;

pub use answer::{RayAnswer, RayOutcome};
#[doc(hidden)]
pub use line::SIDE;
pub use query::Ray;
pub(crate) use slabs::entry_of_box;

use crate::answer::sum_above;
use crate::base::error::Result;
use crate::base::math::Pose;
use crate::base::memory::in_integers;
use crate::base::simd::environment::with_default;
use crate::body::polyhedron::Polyhedron;
use crate::pair::Placed;

/// Casts a ray at a body, see [`RayAnswer`]: guaranteed, whatever the magnitudes. A ray that only touches hits.
///
/// # Errors
/// [`Error::Pose`](crate::base::error::Error::Pose) for a pose that is not accepted, as in [`crate::pair::distance`].
/// [`Error::Argument`](crate::base::error::Error::Argument) for an origin or a direction that is not finite, a direction of 0,
/// and a `t_max` that is negative or NaN.
/// [`Error::Memory`](crate::base::error::Error::Memory) where there is none for integers.
pub fn cast_ray(body: Placed, ray: &Ray) -> Result<RayAnswer> {
    with_default(|| {
        ray.check()?;
        body.pose.check()?;
        cast_at(body, ray, search::cast, swept::cast)
    })
}

/// The same of a ray and a pose that are accepted, in integers alone: both ends are neighbouring doubles.
///
/// # Errors
/// [`Error::Memory`](crate::base::error::Error::Memory) where there is none for integers.
pub(crate) fn cast_ray_in_integers(body: Placed, ray: &Ray) -> Result<RayAnswer> {
    cast_at(body, ray, search::cast_in_integers, swept::cast_in_integers)
}

/// By a cast at polyhedra, and one at polyhedra with a ball of a radius.
fn cast_at(
    body: Placed,
    ray: &Ray,
    cast: fn(&Polyhedron, &Pose, &Ray) -> Result<RayAnswer>,
    cast_with_ball: fn(&Polyhedron, &Pose, &Ray, f64) -> RayAnswer,
) -> Result<RayAnswer> {
    let (polyhedron, pose) = (body.shape.polyhedron(), body.pose);
    let (radius, deviation) = (body.shape.swept_radius(), body.shape.deviation());
    let within = |radius: f64| in_integers(|| cast_with_ball(polyhedron, pose, ray, radius));
    let inner = if radius == 0.0 { cast(polyhedron, pose, ray)? } else { within(radius)? };
    Ok(if deviation == 0.0 { inner } else { between(&inner, &within(sum_above(radius, deviation))?) })
}

/// The answer of a body that holds one and is in the other.
fn between(inner: &RayAnswer, outer: &RayAnswer) -> RayAnswer {
    let (exact, steps) = (inner.exact.max(outer.exact), inner.steps + outer.steps);
    let outcome = match (inner.outcome, outer.outcome) {
        (_, RayOutcome::Miss) => RayOutcome::Miss,
        // It was in the inner body before.
        (RayOutcome::Inside, _) => RayOutcome::Inside,
        (RayOutcome::Hit, RayOutcome::Hit) => RayOutcome::Hit,
        _ => RayOutcome::Undecided,
    };
    if outcome == RayOutcome::Miss {
        return RayAnswer { exact, steps, ..*outer };
    }
    let last = if inner.outcome == RayOutcome::Miss {
        [outer.exit[1], outer.entry[0]]
    } else {
        [inner.entry[1], inner.exit[0]]
    };
    let (entry, exit) = ([outer.entry[0], last[0]], [last[1], outer.exit[1]]);
    RayAnswer { outcome, exact, entry, exit, steps, ..*inner }
}
