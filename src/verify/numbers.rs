//! The numbers of an answer of any kind: each is finite, or NaN with all that belongs to it.

use super::checks::unverified;
use crate::answer::{Feature, FeatureKind, PairAnswer};
use crate::base::error::Result;
use crate::depth::DepthAnswer;
use crate::manifold::ManifoldPoint;

/// The numbers of an answer.
pub struct AnswerNumbers {
    /// Lower end, best estimate and upper end of the interval.
    interval: [f64; 3],
    /// Both local witness points, then both in the world.
    points: [[f64; 3]; 4],
    normal: [f64; 3],
    features: [Feature; 2],
}

impl From<&PairAnswer> for AnswerNumbers {
    fn from(answer: &PairAnswer) -> AnswerNumbers {
        AnswerNumbers {
            interval: [answer.lower, answer.distance, answer.upper],
            points: [answer.local1, answer.local2, answer.world1, answer.world2],
            normal: answer.normal,
            features: [answer.feature1, answer.feature2],
        }
    }
}

impl From<&DepthAnswer> for AnswerNumbers {
    fn from(answer: &DepthAnswer) -> AnswerNumbers {
        AnswerNumbers {
            interval: [answer.lower, answer.depth, answer.upper],
            points: [answer.local1, answer.local2, answer.world1, answer.world2],
            normal: answer.normal,
            features: [answer.feature1, answer.feature2],
        }
    }
}

impl AnswerNumbers {
    /// The numbers of a manifold point with this normal: the interval is that of its gap.
    pub fn of_point(point: &ManifoldPoint, normal: &[f64; 3]) -> AnswerNumbers {
        AnswerNumbers {
            interval: [point.gap_lower, point.gap_lower, point.gap_upper],
            points: [point.local1, point.local2, point.world1, point.world2],
            normal: *normal,
            features: [point.feature1, point.feature2],
        }
    }
}

const POINTS: [&str; 4] =
    ["witness point 1", "witness point 2", "witness point 1 in the world", "witness point 2 in the world"];

/// Refuses an answer with a number that is not finite. Three things may be: the upper end of an interval, and of a distance above
/// all doubles the estimate, too; a coordinate in the world beyond them, which the comparison with its local point then judges; and
/// what stays unset, which is NaN: the normal as a whole, the points with the features as a whole.
pub fn check_numbers(numbers: &AnswerNumbers) -> Result<()> {
    let AnswerNumbers { interval, points, normal, .. } = numbers;
    let [lower, best, upper] = *interval;
    let is_number = |x: f64| x.is_finite() || x == f64::INFINITY;
    if !(lower.is_finite() && (best.is_finite() || (is_number(best) && lower == f64::MAX)) && is_number(upper)) {
        return Err(unverified(format!("an interval from lower to upper of {lower:e}, {best:e}, {upper:e}")));
    }
    let is_unsaid = normal.iter().all(|x| x.is_nan());
    if !(is_unsaid || normal.iter().all(|x| x.is_finite())) {
        return Err(unverified(format!("the normal is not a unit vector: {normal:?}")));
    }
    if !are_points_said(numbers) {
        return Ok(());
    }
    for (index, (what, point)) in POINTS.iter().zip(points).enumerate() {
        let is_local = index < 2;
        if point.iter().any(|x| x.is_nan() || (is_local && x.is_infinite())) {
            return Err(unverified(format!("{what} is {point:?}")));
        }
    }
    Ok(())
}

/// Whether any witness point or feature is reported.
pub fn are_points_said(AnswerNumbers { points, features, .. }: &AnswerNumbers) -> bool {
    points.iter().flatten().any(|x| !x.is_nan()) || features.iter().any(|feature| feature.kind != FeatureKind::None)
}
