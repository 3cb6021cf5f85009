//! The results of integers, in doubles where they fit.

use super::dyadic::{bounds_of_quotient_by_root, decode, dot, fraction_to_double, leading_bits, magnitude};
use super::simplex::{ExactSimplex, VertexPair};
use crate::base::math::Vector;
use crate::base::memory::listed;
use dashu_int::IBig;
use dashu_int::ops::{BitTest, SquareRootRem};
use std::cmp::Ordering;

/// Bits to which a difference of roots is computed before it is rounded to the 53 of a double, and a few for its estimate.
const DIFFERENCE_BITS: usize = 72;

/// The result of integer arithmetic, for the objects R·v + T exactly as the doubles give them.
#[derive(Debug, Clone, PartialEq)]
pub struct ExactAnswer {
    /// Whether the closed sets have a common point (touching included).
    pub intersecting: bool,
    /// 0 when intersecting, else lower ≤ distance ≤ upper: neighbouring doubles, or both the distance itself. A separated
    /// pair has lower 0 only if its distance is smaller than any positive double, upper +∞ only if it exceeds all of them.
    pub lower: f64,
    /// Upper end.
    pub upper: f64,
    /// Vertex pairs (1 to 4): intersecting: their differences hold the origin in their hull; separated: the nearest point of
    /// their hull is the nearest point of A − B.
    pub pairs: Vec<VertexPair>,
    /// Convex weights of the pairs, rounded down: the witness points are Σ weightₖ·vertexₖ (one point if intersecting).
    pub weights: Vec<f64>,
    /// Separated: the unit vector from B to A along the shortest connection, rounded; zero when intersecting.
    pub direction: Vector,
    /// Iterations, at least 1: one for the start, and one for each support vertex of the Minkowski difference that was asked for.
    pub iterations: u32,
}

impl ExactAnswer {
    /// The answer of a simplex that holds the nearest point.
    pub(super) fn new(simplex: &ExactSimplex, iterations: u32) -> ExactAnswer {
        let total: IBig = simplex.weights.iter().sum();
        let intersecting = simplex.holds_origin();
        let (lower, upper, direction) = if intersecting {
            (0.0, 0.0, Vector::zeros())
        } else {
            // |P| = P·corner/|P|, with the multiple of P on both sides.
            let square = dot(&simplex.direction, &simplex.direction);
            let (lower, upper) = bounds_of_quotient_by_root(&simplex.height, &square, simplex.exponent());
            (lower, upper, leading_bits(&simplex.direction).normalize())
        };
        ExactAnswer {
            intersecting,
            lower,
            upper,
            pairs: listed(simplex.corners.iter().map(|c| c.pair)),
            weights: listed(simplex.weights.iter().map(|w| fraction_to_double(w, &total))),
            direction,
            iterations,
        }
    }
}

/// A distance, height / √square · 2^exponent, without any rounding.
#[derive(Debug, Clone)]
pub struct ExactDistance {
    pub(super) height: IBig,
    /// Not used when the distance is 0.
    pub(super) square: IBig,
    pub(super) exponent: i32,
}

impl ExactDistance {
    /// The distance of the nearest point P, which a simplex holds.
    pub(super) fn of_nearest(simplex: ExactSimplex) -> ExactDistance {
        let square = dot(&simplex.direction, &simplex.direction);
        ExactDistance { exponent: simplex.exponent(), square, height: simplex.height }
    }

    /// Whether the closed sets have a common point.
    pub fn is_zero(&self) -> bool {
        self.height.is_zero()
    }

    /// The distance against a double that is not negative, by their squares.
    pub fn compare(&self, other: f64) -> Ordering {
        self.compare_sum(&[other])
    }

    /// The same against a sum of doubles, one of which may be +∞.
    pub fn compare_sum(&self, parts: &[f64]) -> Ordering {
        debug_assert!(parts.iter().all(|part| *part > f64::NEG_INFINITY), "{parts:?}");
        if parts.contains(&f64::INFINITY) {
            return Ordering::Less;
        }
        let (sum, exponent) = exact_sum(parts);
        if sum < IBig::ZERO {
            return Ordering::Greater;
        }
        if self.is_zero() || sum.is_zero() {
            return (!self.is_zero()).cmp(&!sum.is_zero());
        }
        let ([own, others], _) = self.squares(&sum, exponent);
        own.cmp(&others)
    }

    /// By how much the distance exceeds a sum of doubles that are not negative: the doubles next to it, below and above. `None`
    /// where it does not.
    pub fn excess(&self, parts: &[f64]) -> Option<(f64, f64)> {
        debug_assert!(parts.iter().all(|part| *part >= 0.0), "{parts:?}");
        let (sum, exponent) = exact_sum(parts);
        if self.is_zero() {
            return None;
        }
        let ([own, others], _) = self.squares(&sum, exponent);
        if own <= others {
            return None;
        }
        // With h and s over one power of two and q the square, it is (√(q·h²) − q·s)/q, and √(q·h²) − q·s is at least √q·(h² −
        // q·s²)/2h. So many further bits of the root leave more of the difference than a double has, after any cancellation.
        let common = self.exponent.min(exponent);
        let height = &self.height << (self.exponent - common) as usize;
        let sum = sum << (exponent - common) as usize;
        let bits = |x: &IBig| x.bit_len();
        let shift = (DIFFERENCE_BITS + bits(&height)).saturating_sub(bits(&(own - others)) + bits(&self.square) / 2);
        let (root, rest) = magnitude(&((&self.square * &height * &height) << (2 * shift))).sqrt_rem();
        let least = IBig::from(root) - ((&self.square * sum) << shift);
        let most = if rest.is_zero() { least.clone() } else { &least + IBig::ONE };
        let divisor = &self.square << shift;
        let quotient = |numerator: &IBig| bounds_of_quotient_by_root(numerator, &(&divisor * &divisor), common);
        Some((quotient(&least).0, quotient(&most).1))
    }

    /// Whether it is less than another one.
    pub(super) fn is_less_than(&self, other: &ExactDistance) -> bool {
        let square = |of: &ExactDistance, beside: &ExactDistance| {
            let shift = 2 * (of.exponent - of.exponent.min(beside.exponent)) as usize;
            (&of.height * &of.height * &beside.square) << shift
        };
        square(self, other) < square(other, self)
    }

    /// The squares of the distance and of sum·2^exponent, both times the square of the direction, over one power of two.
    fn squares(&self, sum: &IBig, exponent: i32) -> ([IBig; 2], i32) {
        let (mut own, mut others) = (&self.height * &self.height, sum * sum * &self.square);
        let shift = 2 * self.exponent.abs_diff(exponent) as usize;
        if self.exponent > exponent {
            own <<= shift;
        } else {
            others <<= shift;
        }
        ([own, others], 2 * self.exponent.min(exponent))
    }

    /// The doubles next to it, below and above; both the same when it is one.
    pub fn bounds(&self) -> (f64, f64) {
        if self.is_zero() { (0.0, 0.0) } else { bounds_of_quotient_by_root(&self.height, &self.square, self.exponent) }
    }
}

/// The sum of finite doubles, as an integer times a power of two.
fn exact_sum(parts: &[f64]) -> (IBig, i32) {
    let decoded = || parts.iter().map(|part| decode(*part));
    let exponent = decoded().filter(|(mantissa, _)| *mantissa != 0).map(|(_, exponent)| exponent).min().unwrap_or(0);
    let sum = decoded().filter(|(mantissa, _)| *mantissa != 0);
    (sum.map(|(mantissa, own)| IBig::from(mantissa) << (own - exponent) as usize).sum(), exponent)
}
