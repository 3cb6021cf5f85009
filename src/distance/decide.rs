//! Proves a pair's verdict when marching alone cannot: the fallback, then integers.

use crate::base::math::{Vector, clamp};
use crate::base::simd::{self, Kernel, Lanes};
use crate::body::polyhedron::Polyhedron;
use crate::distance::certificate::Interval;
use crate::distance::enclosure::{self, Enclosure};
use crate::distance::gjk::{self, GjkSupports};
use crate::placed::Pair;
use crate::placed::exact::{self, VertexPair};
use crate::placed::frame::Frame;

/// A decided pair.
#[derive(Debug, Clone, PartialEq)]
pub enum Decision {
    /// Disjoint, `interval.lower > 0` (0 for a distance below the smallest double).
    Separated {
        /// Nearest points in centred local coordinates.
        points: [Vector; 2],
        /// World direction from body 2 to body 1, not normalised.
        direction: Vector,
        /// The rigorous interval.
        interval: Interval,
        /// The vertices whose convex combinations the points are.
        pairs: Pairs,
    },
    /// The closed bodies have a common point.
    Intersecting {
        /// Vertex pairs whose differences hold the origin in their hull.
        pairs: Pairs,
        /// Convex weights of the pairs that give the origin, up to rounding.
        weights: [f64; 4],
    },
}

/// One to four vertex pairs.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Pairs {
    list: [VertexPair; 4],
    count: u8,
}

impl Pairs {
    /// From a slice; entries beyond the fourth are dropped.
    pub fn new(pairs: &[VertexPair]) -> Pairs {
        let mut list = [[0; 2]; 4];
        let count = pairs.len().min(4);
        list[..count].copy_from_slice(&pairs[..count]);
        Pairs { list, count: count as u8 }
    }

    /// As a slice.
    pub fn as_slice(&self) -> &[VertexPair] {
        &self.list[..usize::from(self.count)]
    }
}

/// How much effort a decision took.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Effort {
    /// Iterations in floating point.
    pub fallback_iterations: u32,
    /// Iterations in integers.
    pub exact_iterations: u32,
}

/// The result that an interval must deliver.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Wanted {
    /// It is as narrow as answers must be, else it need only prove the verdict.
    pub tight: bool,
    /// It is on one side of this, as far as doubles can tell: the integers' interval always tells, as its ends are neighbours and
    /// the true distance is between them, or both are it. `upper` is at most the tolerance just where the true distance is.
    pub max_distance: f64,
}

impl Wanted {
    fn is_met_by(&self, interval: &Interval, size: f64) -> bool {
        let is_narrow = if self.tight { interval.is_tight(size) } else { interval.lower > 0.0 };
        is_narrow && interval.settles(self.max_distance)
    }
}

/// Decides a pair from a hint of one to four vertex pairs (indices in range). Unless `in_range` (see [`Frame`]) the magnitudes are
/// beyond the error bounds of double precision, and integers decide at once.
///
/// # Panics
/// Fails where integers get no memory, same as [`in_integers`](crate::base::memory::in_integers).
pub fn decide(pair: &Pair, in_range: bool, hint: &[VertexPair], wanted: Wanted) -> (Decision, Effort) {
    let polyhedra = pair.polyhedra;
    let mut effort = Effort::default();
    let mut start = Pairs::new(hint);
    if in_range {
        let (proposal, iterations) = simd::dispatch_to_avx2(&mut Propose { pair: *pair, hint, wanted });
        effort.fallback_iterations = iterations;
        match proposal {
            Proposal::Separated(nearest) => {
                let gjk::Nearest { points, direction, interval, simplex } = nearest;
                let pairs = Pairs::new(&simplex.pairs[..simplex.count]);
                return (Decision::Separated { points, direction, interval, pairs }, effort);
            }
            Proposal::Enclosed(Enclosure { pairs, weights }) => {
                return (Decision::Intersecting { pairs: Pairs::new(&pairs), weights }, effort);
            }
            Proposal::Open(pairs) => start = pairs,
        }
    }
    let answer = exact::solve(pair, start.as_slice());
    effort.exact_iterations = answer.iterations;
    let pairs = Pairs::new(&answer.pairs);
    let mut weights = [0.0; 4];
    for (weight, exact) in weights.iter_mut().zip(&answer.weights) {
        *weight = *exact;
    }
    let decision = if !answer.intersecting {
        Decision::Separated {
            points: combinations(polyhedra, pairs.as_slice(), &weights),
            direction: answer.direction,
            interval: Interval { lower: answer.lower, upper: answer.upper },
            pairs,
        }
    } else {
        Decision::Intersecting { pairs, weights }
    };
    (decision, effort)
}

/// The floating-point result for a pair.
enum Proposal {
    /// Proved, and as tight as was asked.
    Separated(gjk::Nearest),
    /// Proved.
    Enclosed(Enclosure),
    /// Nothing: where to go on.
    Open(Pairs),
}

/// Gilbert-Johnson-Keerthi and the search for an enclosing tetrahedron, compiled for the machine's vector units.
struct Propose<'a> {
    pair: Pair<'a>,
    hint: &'a [VertexPair],
    wanted: Wanted,
}

impl Kernel for Propose<'_> {
    type Output = (Proposal, u32);

    #[inline(always)]
    fn run<L: Lanes>(&mut self) -> (Proposal, u32) {
        let &mut Propose { pair, hint, wanted } = self;
        let frame = Frame::<L>::new(&pair);
        let mut supports = GjkSupports::new(hint);
        let (outcome, iterations) = gjk::solve(&frame, &mut supports, hint, wanted.tight);
        let simplex = match outcome {
            gjk::GjkResult::Nearest(nearest) => {
                if wanted.is_met_by(&nearest.interval, frame.size) {
                    return (Proposal::Separated(nearest), iterations);
                }
                nearest.simplex
            }
            gjk::GjkResult::Enclosed(simplex) => simplex,
        };
        let pairs = Pairs::new(&simplex.pairs[..simplex.count]);
        match enclosure::enclose(&frame, &mut supports, pairs.as_slice()) {
            Some(enclosure) => (Proposal::Enclosed(enclosure), iterations),
            None => (Proposal::Open(pairs), iterations),
        }
    }
}

/// Convex combinations of the pairs' vertices, in centred local coordinates.
pub fn combinations(polyhedra: [&Polyhedron; 2], pairs: &[VertexPair], weights: &[f64; 4]) -> [Vector; 2] {
    std::array::from_fn(|i| {
        let combination = |unit: f64| {
            let position = |k: usize| polyhedra[i].vertices[pairs[k][i] as usize].position * unit;
            let first = position(0);
            (1..pairs.len()).fold(first, |sum, k| sum + (position(k) - first) * weights[k])
        };
        let sum = combination(1.0);
        if sum.iter().all(|x| x.is_finite()) {
            return sum;
        }
        // Between the largest doubles differences overflow, but no point is beyond its ends.
        combination(0.125).map(|x| clamp(8.0 * x, -f64::MAX, f64::MAX))
    })
}
