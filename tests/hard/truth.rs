//! The truth about a pose of a sequence, in integers and rationals.

use testkit::any_size::integers::place;
use testkit::any_size::nearest::nearest;

use testkit::PosePair;
use testkit::hard::Sequence;
use testkit::oracle::Truth;

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
