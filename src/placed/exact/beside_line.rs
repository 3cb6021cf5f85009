//! How far places and stretches of a line are from a placed body, in integers.

use std::cmp::Ordering;

use dashu_int::IBig;

use super::answer::{ExactAnswer, ExactDistance};
use super::body::ExactBody;
use super::dyadic::{DyadicVector, dot};
use super::simplex::{DifferenceVertex, ExactSimplex, VertexPair};
use crate::base::math::Pose;
use crate::body::polyhedron::Polyhedron;

/// A place on a line: this many times its direction from its origin, mantissa · 2^exponent. Exponents may leave those of doubles.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct LinePlace {
    pub mantissa: i64,
    pub exponent: i32,
}

/// A line and a body.
pub(crate) struct BesideLine<'a> {
    body: ExactBody<'a>,
    origin: DyadicVector,
    direction: DyadicVector,
}

/// The part of the body that is nearest to a stretch of the line.
pub(crate) struct NearestToLine {
    /// Differences of the body's vertices and the stretch's ends.
    simplex: ExactSimplex,
    /// The sign of P·d for the shortest vector P from the stretch to the body and the line's direction d.
    ahead: Ordering,
}

impl<'a> BesideLine<'a> {
    /// Accepts any finite numbers.
    pub fn new(polyhedron: &'a Polyhedron, pose: &Pose, origin: [f64; 3], direction: [f64; 3]) -> BesideLine<'a> {
        BesideLine {
            body: ExactBody::new(polyhedron, pose),
            origin: DyadicVector::from_doubles(origin),
            direction: DyadicVector::from_doubles(direction),
        }
    }

    fn point(&self, place: LinePlace) -> DyadicVector {
        let mantissa = IBig::from(place.mantissa);
        let components = self.direction.components.each_ref().map(|component| component * &mantissa);
        DyadicVector { components, exponent: self.direction.exponent + place.exponent }.sum(self.origin.clone())
    }

    /// The nearest points of the body and of the stretch between two places, by the descent of a pair whose second body are these.
    pub fn nearest(&self, stretch: [LinePlace; 2]) -> NearestToLine {
        let ends = stretch.map(|place| self.point(place));
        let span = ends[1].clone().difference(ends[0].clone()).components;
        let corner = |pair: VertexPair| {
            let position = self.body.world_vertex(pair[0]).difference(ends[pair[1] as usize].clone());
            DifferenceVertex { pair, position }
        };
        let mut simplex = ExactSimplex::new(corner([0, 0]));
        while !simplex.holds_origin() {
            let against = simplex.direction.each_ref().map(|component| -component);
            let vertex = self.body.support(simplex.corners[0].pair[0], &self.body.local_direction(&against));
            let end = u32::from(dot(&simplex.direction, &span) > IBig::ZERO);
            if !simplex.improve(&corner([vertex, end])) {
                break;
            }
        }
        let ahead = dot(&simplex.direction, &self.direction.components).cmp(&IBig::ZERO);
        NearestToLine { simplex, ahead }
    }
}

impl NearestToLine {
    /// The distance against a finite double that is not negative.
    pub fn compare(&self, length: f64) -> Ordering {
        ExactDistance::of_nearest(self.simplex.copied()).compare(length)
    }

    /// Whether the distance of a single place that is outside the body gets less or greater along the line.
    pub fn slope(&self) -> Ordering {
        self.ahead.reverse()
    }

    /// The pairs have vertices of the body first; the direction is from the line to the body.
    pub fn answer(&self) -> ExactAnswer {
        ExactAnswer::new(&self.simplex, 1)
    }
}
