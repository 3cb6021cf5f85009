//! Nearest points of two convex hulls: P. Wolfe, Finding the nearest point in a polytope, Math. Programming 11 (1976), on the
//! Minkowski difference, in integers and rationals. In exact arithmetic it ends after finitely many steps, at a point that is
//! proved by a look at every vertex: x is nearest to the origin when x·w ≥ x·x for all vertices w of the Minkowski difference.

use dashu_int::{IBig, UBig};
use dashu_ratio::RBig;

use super::integers::{Body, IntegerPair, Point, difference, dot, negative};

/// The nearest points of two hulls.
pub struct Nearest {
    /// The square of the distance; 0 exactly when the closed hulls have a common point.
    pub square: RBig,
    /// Vertices of A and of B, in pairs, and the weights, summing to 1, that make the nearest points of them.
    pub pairs: Vec<[usize; 2]>,
    pub weights: Vec<RBig>,
}

/// In units of the placed vertices.
pub fn nearest(placed: &IntegerPair) -> Nearest {
    let IntegerPair { a, b, .. } = placed;
    // Wolfe's corral: affinely independent points, and x, the point nearest to the origin of their affine hull, inside
    // their convex hull.
    let mut pairs = vec![[0, 0]];
    let mut corral = vec![difference(&a.vertex(0), &b.vertex(0))];
    let mut weights = vec![RBig::ONE];
    loop {
        let (x, denominator) = combination(&corral, &weights);
        let square = dot(&x, &x);
        if square.is_zero() {
            return Nearest { square: RBig::ZERO, pairs, weights };
        }
        let (lowest, highest) = (a.farthest(&negative(&x)), b.farthest(&x));
        let w = difference(&a.vertex(lowest), &b.vertex(highest));
        if dot(&x, &w) * IBig::from(denominator.clone()) >= square {
            return Nearest { square: RBig::from_parts(square, denominator.sqr()), pairs, weights };
        }
        pairs.push([lowest, highest]);
        corral.push(w);
        weights.push(RBig::ZERO);
        // Minor cycles: move x to the nearest point of the affine hull, or as far as the convex hull goes.
        loop {
            let target = affine_minimiser(&corral);
            let steps = weights.iter().zip(&target).filter(|(_, t)| **t <= RBig::ZERO);
            let Some(step) = steps.map(|(w, t)| w / (w - t)).min() else {
                weights = target;
                break;
            };
            for (w, t) in weights.iter_mut().zip(&target) {
                *w = &*w + &step * (t - &*w);
            }
            let kept: Vec<bool> = weights.iter().map(|w| !w.is_zero()).collect();
            let mut keep = kept.iter();
            corral.retain(|_| keep.next() == Some(&true));
            let mut keep = kept.iter();
            pairs.retain(|_| keep.next() == Some(&true));
            weights.retain(|w| !w.is_zero());
        }
    }
}

impl Nearest {
    /// The square of the distance in the world's unit, not that of the placed vertices.
    pub fn world_square(&self, placed: &IntegerPair) -> RBig {
        let unit = RBig::from(IBig::ONE << placed.exponent.unsigned_abs() as usize);
        if placed.exponent < 0 { &self.square / (&unit * &unit) } else { &self.square * (&unit * &unit) }
    }

    /// The nearest point of one body, which is A for `side` 0, B for 1.
    pub fn point(&self, body: &Body, side: usize) -> [RBig; 3] {
        let corners: Vec<Point> = self.pairs.iter().map(|pair| body.vertex(pair[side])).collect();
        let (sum, denominator) = combination(&corners, &self.weights);
        sum.map(|x| RBig::from_parts(x, denominator.clone()))
    }
}

/// Σ weight·point as integers over a common denominator.
fn combination(points: &[Point], weights: &[RBig]) -> (Point, UBig) {
    let denominator = weights.iter().fold(UBig::ONE, |product, w| product * w.denominator());
    let mut sum = [IBig::ZERO, IBig::ZERO, IBig::ZERO];
    for (point, weight) in points.iter().zip(weights) {
        let whole = weight.numerator() * IBig::from(&denominator / weight.denominator());
        for (s, p) in sum.iter_mut().zip(point) {
            *s += &whole * p;
        }
    }
    (sum, denominator)
}

/// The weights, summing to 1, of the point nearest to the origin in the affine hull of affinely independent points: they
/// solve p_i·Σ w_j p_j = m for all i, and Σ w_j = 1.
pub fn affine_minimiser(points: &[Point]) -> Vec<RBig> {
    let n = points.len() + 1;
    let mut rows: Vec<Vec<RBig>> = vec![vec![RBig::ONE; n + 1]];
    rows[0][n - 1] = RBig::ZERO;
    for p in points {
        let mut row: Vec<RBig> = points.iter().map(|q| RBig::from(dot(p, q))).collect();
        row.extend([RBig::from(-1), RBig::ZERO]);
        rows.push(row);
    }
    for k in 0..n {
        // Affine independence makes the system regular, so that there is a pivot.
        let pivot = (k..n).find(|&i| !rows[i][k].is_zero()).expect("affinely independent points");
        rows.swap(k, pivot);
        let pivot_row = rows[k].clone();
        for (i, row) in rows.iter_mut().enumerate() {
            if i != k && !row[k].is_zero() {
                let factor = &row[k] / &pivot_row[k];
                for (x, p) in row.iter_mut().zip(&pivot_row) {
                    *x = &*x - &factor * p;
                }
            }
        }
    }
    (0..n - 1).map(|k| &rows[k][n] / &rows[k][k]).collect()
}
