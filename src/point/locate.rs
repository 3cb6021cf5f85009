//! Location of a point relative to a body: the signed distance of the two.

use super::answer::{PointAnswer, PointLocation};
use super::check_finite;
use crate::base::error::Result;
use crate::base::math::{Matrix, Pose, Vector};
use crate::base::simd::environment::with_default;
use crate::pair::{Outcome, PairConfig, Placed, SignedDistance, SignedDistanceCache, signed_distance};
use crate::shape::{InputPolicy, Shape, ShapeOptions};

/// Locates a point of the world relative to a body: inside, on it or outside, with the distance from its surface and the nearest
/// feature. Guaranteed, whatever the magnitudes: integers decide where doubles cannot tell. It allocates.
///
/// # Errors
/// [`Error::Argument`](crate::base::error::Error::Argument) for a point that is not finite,
/// [`Error::Pose`](crate::base::error::Error::Pose) for a pose that is not accepted, as in [`crate::pair::distance`],
/// [`Error::Memory`](crate::base::error::Error::Memory).
pub fn locate_point(body: Placed, point: [f64; 3]) -> Result<PointAnswer> {
    with_default(|| {
        check_finite("point", &point)?;
        // A vertex at the origin is where its translation says, exactly.
        let options = ShapeOptions { input: InputPolicy::Hull, ..ShapeOptions::default() };
        let vertex = Shape::from_points(&[Vector::zeros()], &options)?;
        let there = Pose::new(&Matrix::identity(), &point.into());
        let (mut cache, mut signed) = (SignedDistanceCache::default(), SignedDistance::default());
        signed_distance([vertex.at(&there), body], &mut cache, &PairConfig::default(), &mut signed)?;
        let answer = PointAnswer::new(location(&signed, body.shape.deviation()), &signed);
        Ok(PointAnswer { normal: normal(&answer, &point.into()), ..answer })
    })
}

/// Below this share of the largest coordinate, the rounding of the nearest point hides the direction to it.
const TOO_NEAR: f64 = 1e-6;

/// The direction from the nearest point to a point outside. That which proves the distance may lean along the short edge of a
/// sliver; it stays where points are too near to tell.
fn normal(answer: &PointAnswer, point: &Vector) -> [f64; 3] {
    let (nearest, largest) = (Vector::from(answer.world), point.amax());
    let along = point - nearest;
    let length = along.norm();
    // False for a NaN.
    let tells = length > TOO_NEAR * nearest.amax().max(largest) && length < f64::INFINITY;
    if answer.location == PointLocation::Outside && tells { (along / length).into() } else { answer.normal }
}

/// If a common point is all of one body, the depth is 0 just where it is on the surface of the other. A greater depth is never
/// reported as 0 at both ends.
fn location(signed: &SignedDistance, deviation: f64) -> PointLocation {
    match signed.outcome {
        Outcome::Intersecting if signed.lower == 0.0 => PointLocation::On,
        // On the polyhedron of a curved body.
        Outcome::Intersecting if signed.upper == 0.0 && deviation > 0.0 => PointLocation::Undecided,
        Outcome::Intersecting => PointLocation::Inside,
        Outcome::Undecided => PointLocation::Undecided,
        _ => PointLocation::Outside,
    }
}
