//! The truth about bodies over which balls are swept, beside each other and over half-spaces: lengths that are square roots of
//! rational numbers, less radii, compared with doubles exactly.

use std::cmp::Ordering;

use dashu_ratio::RBig;
use swiftprox::math::{Pose, Vector};
use swiftprox::pair::HalfSpace;

use crate::cases::row_major;
use crate::oracle::{Truth, rational, transform};

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
