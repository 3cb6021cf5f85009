//! The truth about a pose of a sequence, in integers and rationals.

#[path = "../oracle/any_size/mod.rs"]
mod any_size;

use any_size::integers::place;
use any_size::nearest::nearest;

use crate::common::PosePair;
use crate::common::hard::Sequence;
use crate::oracle::Truth;

/// The vertices of a sequence's bodies.
pub struct ExactPair {
    points: [Vec<[f64; 3]>; 2],
}

impl ExactPair {
    pub fn of(sequence: &Sequence) -> ExactPair {
        ExactPair { points: sequence.bodies.each_ref().map(|body| body.vertices.iter().map(|&v| v.into()).collect()) }
    }

    pub fn truth(&self, pair: &PosePair) -> Truth {
        let placed = place(&self.points[0], &self.points[1], pair);
        Truth { squared_distance: nearest(&placed).world_square(&placed) }
    }
}
