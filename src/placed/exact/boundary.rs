//! The position of the origin: outside the Minkowski difference, on its boundary or inside, in integers.
//!
//! The carrier of the origin, a simplex of differences that has it in its relative interior, spans a linear space to which every
//! supporting plane at the origin is perpendicular. So what is left is the same question one to three dimensions lower, across that
//! space: the descent of Gilbert-Johnson-Keerthi among the differences projected across it either meets a direction along which no
//! vertex lies ahead of the origin, a normal, or ends at a carrier in the projection, and the space grows. Every descent ends since
//! |P| falls strictly, and there are at most three.

use super::answer::ExactAnswer;
use super::dyadic::{IntVector, bounds_of_quotient_by_root, cross, dot, leading_bits};
use super::minkowski::MinkowskiDifference;
use super::simplex::{DifferenceVertex, ExactSimplex, VertexPair};
use crate::base::math::Vector;
use crate::base::memory::listed;
use crate::placed::Pair;
use dashu_int::IBig;

/// The relative position of two bodies.
#[derive(Debug, Clone, PartialEq)]
pub enum Position {
    /// Apart.
    Separated(ExactAnswer),
    /// They have common points, and a plane with one on either side.
    Touching {
        /// From body 2 to body 1, the plane's unit normal, rounded.
        normal: Vector,
        /// The answer of [`super::solve`].
        common: ExactAnswer,
    },
    /// They have common inner points.
    Overlapping(ExactAnswer),
}

/// Which vertices a support is searched among.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum SupportScope {
    /// From neighbour to neighbour.
    Climbed,
    /// All, regardless of their neighbours.
    OfAll,
}

/// The relative position of two bodies, exactly, for any finite poses. `start` is the same as for [`super::solve`].
pub fn locate(pair: &Pair, start: &[VertexPair], supports: SupportScope) -> Position {
    let difference = MinkowskiDifference::new(pair);
    let (mut simplex, mut iterations) = difference.descend(start);
    if supports == SupportScope::OfAll {
        while !simplex.holds_origin() && simplex.improve(&difference.support_of_all(&simplex)) {}
    }
    if !simplex.holds_origin() {
        return Position::Separated(ExactAnswer::new(&simplex, iterations));
    }
    let normal = supporting_normal(&difference, &simplex, supports, &mut iterations);
    let common = ExactAnswer::new(&simplex, iterations);
    match normal {
        Some(normal) => Position::Touching { normal: -leading_bits(&normal).normalize(), common },
        None => Position::Overlapping(common),
    }
}

/// An upper bound of the least overlap, for any magnitudes: the least of those along the world's axes. And the unit vector from
/// body 2 to body 1 along which that is.
pub fn overlap_along_axes(pair: &Pair) -> (f64, Vector) {
    let difference = MinkowskiDifference::new(pair);
    let mut least = (f64::INFINITY, Vector::x());
    for axis in 0..3 {
        for sign in [IBig::ONE, IBig::NEG_ONE] {
            let mut along = [IBig::ZERO; 3];
            along[axis] = sign;
            let farthest = difference.farthest([0, 0], &along, SupportScope::OfAll);
            let height = dot(&along, &farthest.position.components);
            if height < IBig::ZERO {
                continue;
            }
            let (_, overlap) = match height.is_zero() {
                true => (0.0, 0.0),
                false => bounds_of_quotient_by_root(&height, &IBig::ONE, farthest.position.exponent),
            };
            if overlap < least.0 {
                least = (overlap, -leading_bits(&along).normalize());
            }
        }
    }
    least
}

impl MinkowskiDifference<'_> {
    /// A vertex pair farthest along a direction.
    pub(super) fn farthest(&self, from: VertexPair, along: &IntVector, supports: SupportScope) -> DifferenceVertex {
        let against = [0, 1, 2].map(|k| -&along[k]);
        let (towards_a, towards_b) = (self.a.local_direction(along), self.b.local_direction(&against));
        self.corner(match supports {
            SupportScope::Climbed => [self.a.support(from[0], &towards_a), self.b.support(from[1], &towards_b)],
            SupportScope::OfAll => [self.a.support_of_all(&towards_a), self.b.support_of_all(&towards_b)],
        })
    }
}

/// A direction along which no difference is ahead of the origin, which `carrier` has in its relative interior; `None` if the origin
/// is inside the Minkowski difference.
fn supporting_normal(
    difference: &MinkowskiDifference,
    carrier: &ExactSimplex,
    supports: SupportScope,
    iterations: &mut u32,
) -> Option<IntVector> {
    let mut from = carrier.corners[0].pair;
    // All but one of a carrier's corners are linearly independent, and span the last.
    let spanning = |simplex: &ExactSimplex| -> Vec<IntVector> {
        listed(simplex.corners[1..].iter().map(|corner| corner.position.components.clone()))
    };
    let mut space = spanning(carrier);
    loop {
        // Directions to begin with, perpendicular to the space.
        let candidates: Vec<IntVector> = match &space[..] {
            [] => listed([[IBig::ONE, IBig::ZERO, IBig::ZERO]]),
            [along] => listed([across(along)]),
            [first, second] => {
                let normal = cross(first, second);
                let opposite = [0, 1, 2].map(|k| -&normal[k]);
                listed([normal, opposite])
            }
            _ => return None,
        };
        let mut found = None;
        for along in candidates {
            *iterations += 1;
            let farthest = difference.farthest(from, &along, supports);
            if dot(&along, &farthest.position.components) <= IBig::ZERO {
                return Some(along);
            }
            found = Some(farthest);
        }
        if space.len() == 2 {
            return None;
        }
        let mut simplex = ExactSimplex::new(projected(found?, &space));
        while !simplex.holds_origin() {
            *iterations += 1;
            from = simplex.corners[0].pair;
            let along = [0, 1, 2].map(|k| -&simplex.direction[k]);
            let farthest = difference.farthest(from, &along, supports);
            if dot(&along, &farthest.position.components) <= IBig::ZERO {
                return Some(along);
            }
            // It is on the origin's side of the plane through P: |P| falls.
            simplex.improve(&projected(farthest, &space));
        }
        // There is room for three.
        space.extend(spanning(&simplex));
    }
}

/// Not 0 and perpendicular to a vector that is not 0.
fn across(along: &IntVector) -> IntVector {
    let axes = [0, 1, 2].map(|axis| [0, 1, 2].map(|k| if k == axis { IBig::ONE } else { IBig::ZERO }));
    let products = axes.map(|axis| cross(along, &axis));
    // Perpendicular to two axes it cannot be along both of them.
    let [first, second, _] = products;
    if first.iter().all(IBig::is_zero) { second } else { first }
}

/// A positive multiple, the same for all, of a corner's part perpendicular to the space, which has one dimension or none.
fn projected(mut corner: DifferenceVertex, space: &[IntVector]) -> DifferenceVertex {
    if let [along] = space {
        let (square, part) = (dot(along, along), dot(along, &corner.position.components));
        let components = &corner.position.components;
        corner.position.components = [0, 1, 2].map(|k| &square * &components[k] - &part * &along[k]);
    }
    corner
}
