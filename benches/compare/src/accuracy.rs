//! How a method's answers differ from those of another.

use crate::method::Reply;
use crate::setting::Query;
use crate::timing::median;

/// Answers farther apart than this, relative to the distance, are counted as disagreement.
const AGREEMENT: f64 = 1e-6;

/// How a method's answers differ from the reference's.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Accuracy {
    /// Another verdict, a distance off by more than [`AGREEMENT`], or no answer.
    pub disagreements: usize,
    /// Of |distance − reference|, where both separate; models have radius 1.
    pub median_error: f64,
    pub worst_error: f64,
}

impl Accuracy {
    /// Of all replies, beside those of the method that counts as right.
    pub fn of(query: Query, replies: &[Reply], reference: &[Reply]) -> Accuracy {
        let (mut disagreements, mut errors) = (0, Vec::new());
        for (reply, reference) in replies.iter().zip(reference) {
            let error = (reply.distance - reference.distance).abs();
            let same_verdict = (reply.distance > 0.0) == (reference.distance > 0.0);
            // Negated, so that NaN disagrees.
            let verdict_alone = query == Query::Intersection;
            if !(same_verdict && (verdict_alone || error <= AGREEMENT * reference.distance)) {
                disagreements += 1;
            }
            if reply.distance > 0.0 && reference.distance > 0.0 && !verdict_alone {
                errors.push(error);
            }
        }
        let median_error = median(&mut errors);
        Accuracy { disagreements, median_error, worst_error: errors.last().copied().unwrap_or(f64::NAN) }
    }
}
