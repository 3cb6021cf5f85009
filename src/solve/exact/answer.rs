//! What integers found, in doubles where they do.

use super::dyadic::{bounds_of_quotient_by_root, decode, dot, fraction_to_double, leading_bits};
use super::simplex::{Simplex, VertexPair};
use crate::base::math::Vector;
use dashu_int::IBig;
use std::cmp::Ordering;

/// What integer arithmetic found, for the objects R·v + T exactly as the doubles give them.
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
    /// What a simplex that holds the nearest point says.
    pub(super) fn new(simplex: &Simplex, iterations: u32) -> ExactAnswer {
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
            pairs: simplex.corners.iter().map(|c| c.pair).collect(),
            weights: simplex.weights.iter().map(|w| fraction_to_double(w, &total)).collect(),
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
    /// Of the nearest point P, which a simplex holds.
    pub(super) fn of_nearest(simplex: Simplex) -> ExactDistance {
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

    /// The same against a sum of doubles, of which +∞ may be one.
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

    /// By how much the distance exceeds a sum of doubles that are not negative: doubles below and above, both at least 0. `None`
    /// where it does not.
    pub fn excess(&self, parts: &[f64]) -> Option<(f64, f64)> {
        let (sum, exponent) = exact_sum(parts);
        if self.is_zero() {
            return None;
        }
        let ([own, others], exponent) = self.squares(&sum, exponent);
        if own <= others {
            return None;
        }
        // d − s = (d² − s²)/(d + s), where nothing cancels any more: both parts of the sum are rounded, and the sum, and the
        // quotient.
        let (lower, upper) = bounds_of_quotient_by_root(&(own - others), &(&self.square * &self.square), exponent);
        let (nearest, farthest) = self.bounds();
        let least = parts.iter().fold(nearest, |sum, part| (sum + part).next_down());
        let most = parts.iter().fold(farthest, |sum, part| (sum + part).next_up());
        Some(((lower / most).next_down().max(0.0), (upper / least).next_up()))
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
