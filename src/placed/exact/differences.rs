//! Facts about the differences of vertex pairs, in integers: the basis of a proof of depth, looked at one by one.

use std::cmp::Ordering;

use super::answer::ExactDistance;
use super::boundary::SupportScope;
use super::dyadic::{DyadicVector, IntVector, cross, dot};
use super::minkowski::MinkowskiDifference;
use super::simplex::{VertexPair, nearest_of_hull};
use crate::base::math::Vector;
use crate::placed::Pair;
use dashu_int::IBig;

/// The differences of the vertices of two placed bodies.
pub struct Differences<'a>(MinkowskiDifference<'a>);

impl<'a> Differences<'a> {
    /// For any finite poses.
    pub fn new(pair: &Pair<'a>) -> Differences<'a> {
        Differences(MinkowskiDifference::new(pair))
    }

    fn components(&self, pair: VertexPair) -> IntVector {
        self.0.corner(pair).position.components
    }

    /// On which side of the plane through the origin, a ray and the first difference the second one lies: the sign of det(ray, p,
    /// q).
    pub fn side_of_ray(&self, ray: &Vector, [p, q]: [VertexPair; 2]) -> Ordering {
        let ray = DyadicVector::from_doubles((*ray).into()).components;
        dot(&ray, &cross(&self.components(p), &self.components(q))).cmp(&IBig::ZERO)
    }

    /// On which side of a triangle the origin is: the sign of the determinant of its corners, positive seen clockwise from there.
    pub fn orientation(&self, [p, q, r]: [VertexPair; 3]) -> Ordering {
        let [p, q, r] = [p, q, r].map(|pair| self.components(pair));
        dot(&p, &cross(&q, &r)).cmp(&IBig::ZERO)
    }

    /// How far the hull of a few differences is from the origin.
    pub fn distance_of_hull(&self, pairs: &[VertexPair]) -> Option<ExactDistance> {
        let corners = self.0.corners(pairs);
        Some(ExactDistance::of_nearest(nearest_of_hull(corners.first()?.clone(), &corners)))
    }

    /// By how much the bodies overlap along a direction from body 2 to body 1, over all vertices; `None` if they do not.
    pub fn overlap_along(&self, direction: &Vector) -> Option<ExactDistance> {
        let against = Normal::new(DyadicVector::from_doubles((-direction).into()).components);
        self.height(&against, self.farthest(&against))
    }

    /// Both directions across two edges, each of either body; `None` where they are parallel.
    pub fn across(&self, edges: [PairEdge; 2]) -> Option<[Normal; 2]> {
        let [a, b] = edges.map(|edge| {
            let [tail, head] = edge.map(|pair| self.0.corner(pair).position);
            head.difference(tail).components
        });
        let normals = [Normal::new(cross(&a, &b)), Normal::new(cross(&b, &a))];
        (normals[0].square > IBig::ZERO).then_some(normals)
    }

    /// Whether a difference is at least so far along a direction, `least` from 0 on.
    pub fn is_beyond(&self, normal: &Normal, pair: VertexPair, least: f64) -> bool {
        self.height(normal, pair).is_some_and(|height| height.compare(least).is_ge())
    }

    /// Whether the bodies overlap by at least `least`, from 0 on, against a direction from body 2 to body 1, over all vertices.
    pub fn overlaps_by(&self, normal: &Normal, least: f64) -> bool {
        self.is_beyond(normal, self.farthest(normal), least)
    }

    fn farthest(&self, normal: &Normal) -> VertexPair {
        self.0.farthest([0, 0], &normal.components, SupportScope::OfAll).pair
    }

    /// How far a difference is along a direction; `None` if it is behind the origin.
    fn height(&self, Normal { components, square }: &Normal, pair: VertexPair) -> Option<ExactDistance> {
        let position = self.0.corner(pair).position;
        let height = dot(components, &position.components);
        (height >= IBig::ZERO).then(|| ExactDistance { height, square: square.clone(), exponent: position.exponent })
    }
}

/// Two differences with one body's vertex in common: an edge of the other body.
pub type PairEdge = [VertexPair; 2];

/// A direction of any length.
pub struct Normal {
    components: IntVector,
    square: IBig,
}

impl Normal {
    fn new(components: IntVector) -> Normal {
        Normal { square: dot(&components, &components), components }
    }
}
