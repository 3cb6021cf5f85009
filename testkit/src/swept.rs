//! The truth about bodies over which balls are swept, beside each other and over half-spaces: lengths that are square roots of
//! rational numbers, less radii, compared with doubles exactly.

use std::cmp::Ordering;

use dashu_ratio::RBig;
use swiftprox::math::{Pose, Vector};
use swiftprox::pair::HalfSpace;

use crate::any_size::depth::depth;
use crate::any_size::integers::place;
use crate::any_size::nearest::nearest;
use crate::cases::row_major;
use crate::oracle::{Truth, rational, transform};
use crate::orbits::pose_pair;

/// A square root with a sign, less a sum of radii.
pub struct Length {
    is_negative: bool,
    square: RBig,
    radii: RBig,
}

impl Length {
    /// How far bodies are apart whose polytopes have this distance. Where those intersect the bodies are at least as deep as it
    /// says.
    pub fn between(polytopes: &Truth, radii: [f64; 2]) -> Length {
        let square = polytopes.squared_distance.clone();
        Length { is_negative: false, square, radii: rational(radii[0]) + rational(radii[1]) }
    }

    /// The signed distance of bodies over points, and whether that is exact: of polytopes in each other whose depth takes more than
    /// `limit` vertices of their Minkowski difference it may be less.
    pub fn signed(points: [&[[f64; 3]]; 2], poses: &[Pose; 2], radii: [f64; 2], limit: usize) -> (Length, bool) {
        let radii = rational(radii[0]) + rational(radii[1]);
        let [first, second] = poses.each_ref().map(|pose| (pose.rotation(), pose.translation()));
        let both = pose_pair(&first.0, &first.1, &second.0, &second.1);
        let placed = place(points[0], points[1], &both);
        let square = nearest(&placed).world_square(&placed);
        if !square.is_zero() || limit == 0 {
            let is_exact = !square.is_zero();
            return (Length { is_negative: false, square, radii }, is_exact);
        }
        let found = depth(&placed, limit);
        let is_exact = found.lower_square == found.upper_square;
        let square = found.lower_square * rational(2.0).pow(2 * placed.exponent as isize);
        // Those that touch are not less than 0 apart.
        (Length { is_negative: !square.is_zero(), square, radii }, is_exact)
    }

    /// The largest double that is less and the smallest that is more, from an interval that holds it.
    pub fn beside(&self, [lower, upper]: [f64; 2]) -> [f64; 2] {
        assert!(self.lies_between(lower, upper), "it is not in [{lower:e}, {upper:e}]");
        // Integers in the order of doubles.
        let order = |x: f64| x.to_bits() as i64 ^ ((x.to_bits() as i64 >> 63) as u64 >> 1) as i64;
        let double = |order: i64| f64::from_bits((order ^ ((order >> 63) as u64 >> 1) as i64) as u64);
        let first = |is_found: &dyn Fn(Ordering) -> bool| {
            let (mut before, mut after) = (order(lower.next_down()), order(upper.next_up()));
            while after - before > 1 {
                let middle = before + (after - before) / 2;
                *(if is_found(self.compared_with(double(middle))) { &mut after } else { &mut before }) = middle;
            }
            double(after)
        };
        [first(&|of_truth| of_truth.is_le()).next_down(), first(&|of_truth| of_truth.is_lt())]
    }

    /// How high a ball about a point of a body, such as a vertex, is above the plane of a half-space.
    pub fn above(half_space: &HalfSpace, pose: &Pose, point: &Vector, radius: f64) -> Length {
        let world = transform(&row_major(pose), &<[f64; 3]>::from(*point).map(rational));
        let normal = half_space.normal.map(rational);
        let terms = normal.iter().zip(&world).map(|(along, place)| along * place);
        let product = terms.fold(rational(-half_space.offset), |sum, term| sum + term);
        let norm = normal.iter().map(|along| along * along).fold(RBig::ZERO, |sum, term| sum + term);
        Length { is_negative: product < RBig::ZERO, square: &product * &product / norm, radii: rational(radius) }
    }

    /// Whether lower ≤ it ≤ upper; both may be infinite.
    pub fn lies_between(&self, lower: f64, upper: f64) -> bool {
        self.compared_with(lower).is_ge() && self.compared_with(upper).is_le()
    }

    /// Its order to a bound.
    pub fn compared_with(&self, bound: f64) -> Ordering {
        if bound.is_infinite() {
            return 0.0_f64.total_cmp(&bound);
        }
        let root = rational(bound) + &self.radii;
        let by_size = self.square.cmp(&(&root * &root));
        match (self.is_negative, root < RBig::ZERO) {
            (false, false) => by_size,
            (true, true) => by_size.reverse(),
            (false, true) => Ordering::Greater,
            (true, false) => Ordering::Less,
        }
    }
}
