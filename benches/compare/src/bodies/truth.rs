//! The truth about some of the poses, in integers and rationals by other algorithms than the library's.

use dashu_ratio::RBig;
use testkit::PosePair;
use testkit::any_size::depth::depth;
use testkit::any_size::integers::place;
use testkit::any_size::nearest::nearest;

use super::list::Body;
use super::methods::Question;

/// Poses of a scene that are judged, evenly spread: integers take milliseconds a pose.
const JUDGED: usize = 12;
/// Vertices of the Minkowski difference that are looked for until a depth is left between two bounds.
const MOST_VERTICES: usize = 300;

/// About one pose.
pub struct Truth {
    pub pose: usize,
    /// Between what the distance or depth lies: the same twice up to rounding where the search came to its end. 0 is exact.
    pub bounds: [f64; 2],
    /// By how much rounding may have moved the bounds.
    slack: f64,
}

impl Truth {
    pub fn of_some(body: &Body, poses: &[PosePair], question: Question) -> Vec<Truth> {
        let vertices =
            body.meshes.each_ref().map(|mesh| mesh.vertices.iter().map(|v| [v.x, v.y, v.z]).collect::<Vec<_>>());
        let count = JUDGED.min(poses.len());
        let judged = (0..count).map(|k| k * poses.len() / count);
        judged
            .map(|pose| {
                let placed = place(&vertices[0], &vertices[1], &poses[pose]);
                let unit = 2f64.powi(placed.exponent);
                let length = |square: &RBig| root(square) * unit;
                let radius: f64 = body.radii.iter().sum();
                let apart = length(&nearest(&placed).square);
                let is_deep = matches!(question, Question::Depth | Question::Manifold);
                let bounds = match (is_deep, apart > 0.0) {
                    (false, _) => [(apart - radius).max(0.0); 2],
                    // Only the balls meet.
                    (true, true) => [radius - apart; 2],
                    (true, false) => {
                        let found = depth(&placed, MOST_VERTICES);
                        [found.lower_square, found.upper_square].map(|square| length(&square) + radius)
                    }
                };
                // The rounding of a fraction, of a root, of the radii's sum and of a difference: 1.5u, 1.5u, u and u.
                Truth { pose, bounds, slack: f64::EPSILON * (bounds[1] + 2.0 * radius) }
            })
            .collect()
    }

    /// How far what a method says is from the truth.
    pub fn error(&self, said: f64) -> f64 {
        let [lower, upper] = self.bounds;
        (lower - said).max(said - upper).max(0.0)
    }

    /// Whether an interval has nothing in common with the truth.
    pub fn is_missed_by(&self, [lower, upper]: [f64; 2]) -> bool {
        lower > self.bounds[1] + self.slack || upper < self.bounds[0] - self.slack
    }
}

/// √square. The fraction is rounded once, and so is the root.
fn root(square: &RBig) -> f64 {
    square.to_f64().value().sqrt()
}
