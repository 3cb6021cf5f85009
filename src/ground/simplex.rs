//! The distance of a body's polyhedron and a triangle over its placed vertices (Gilbert, Johnson & Keerthi 1988), for triangles
//! that neither the lowest vertex nor a face decides.

use super::lowest::{Limit, Lowest, PlacedTriangle, local_point};
use super::reach::GroundReach;
use super::vertices::Vertices;
use crate::answer::{feature_of_vertices, label};
use crate::base::math::Vector;
use crate::pair::{Feature, FeatureKind, SignedDistance};

/// A search that has not ended after so many vertices is left to the pair layer.
const MOST_STEPS: usize = 32;

/// The result of a search.
pub(super) enum NearestOfTriangle {
    /// The triangle is farther from the body than `max_distance`.
    Beyond,
    Apart(SignedDistance),
    /// The polyhedron and the triangle have points in common.
    Meeting,
    /// Rounding hides it.
    Open,
}

/// Differences of vertices of the body and corners of the triangle, and the weights of those that make the point nearest to the
/// origin.
struct TriangleSimplex {
    points: [Vector; 4],
    pairs: [(u32, usize); 4],
    weights: [f64; 4],
    count: usize,
}

/// Searches from the lowest vertex along a triangle's normal.
///
/// A difference is off by less than `error` of the triangle. So all of the body is at least `lower` from the triangle along any
/// direction that is tried, and the point of the simplex is one of the differences of both up to that.
pub(super) fn nearest(
    body: &Vertices,
    reach: &GroundReach,
    triangle: &PlacedTriangle,
    lowest: &Lowest,
    limit: Limit,
) -> NearestOfTriangle {
    let PlacedTriangle { corners, error, .. } = *triangle;
    let square = |k: usize| (lowest.world - corners[k]).norm_squared();
    let first = (1..3).fold(0, |best, k| if square(k) < square(best) { k } else { best });
    let mut nearest = lowest.world - corners[first];
    let mut simplex = TriangleSimplex {
        points: [nearest; 4],
        pairs: [(lowest.vertex, first); 4],
        weights: [1.0, 0.0, 0.0, 0.0],
        count: 1,
    };
    for _ in 0..MOST_STEPS {
        let distance = nearest.norm();
        // False for a NaN.
        if !(distance > 32.0 * error) {
            return NearestOfTriangle::Open;
        }
        let up = nearest / distance;
        let vertex = body.lowest(&up, simplex.pairs[0].0);
        let world = body.point(vertex);
        let height = |k: usize| up.dot(&(world - corners[k]));
        let corner = (1..3).fold(0, |best, k| if height(k) < height(best) { k } else { best });
        let lower = height(corner) - body.excess(vertex, &up) - error;
        if limit.is_beyond(lower) {
            return NearestOfTriangle::Beyond;
        }
        let upper = distance + error;
        let is_known = simplex.pairs[..simplex.count].contains(&(vertex, corner));
        if is_known || upper - lower <= 4.0 * error {
            if !(lower > 0.0 && upper - lower <= 16.0 * error) {
                return NearestOfTriangle::Open;
            }
            return match limit.distance([lower, upper], distance) {
                Some(found) => NearestOfTriangle::Apart(simplex.contact(body, reach, triangle, &up, found)),
                None => NearestOfTriangle::Open,
            };
        }
        (simplex.points[simplex.count], simplex.pairs[simplex.count]) = (world - corners[corner], (vertex, corner));
        simplex.count += 1;
        match simplex.reduce(error) {
            Some(point) => nearest = point,
            None => return NearestOfTriangle::Meeting,
        }
    }
    NearestOfTriangle::Open
}

impl TriangleSimplex {
    /// Keeps what makes the point nearest to the origin. `None` if the origin is certainly in the simplex, and then in the
    /// difference of both: a ball about it of more than the error of the points is.
    fn reduce(&mut self, error: f64) -> Option<Vector> {
        debug_assert!((2..=4).contains(&self.count));
        let [a, b, c, _] = self.points;
        match self.count {
            2 => Some(self.keep([0, 1, 1], on_segment(&a, &b))),
            3 => Some(self.keep([0, 1, 2], on_triangle(&a, &b, &c))),
            _ => {
                let mut best: Option<([usize; 3], [f64; 3], f64)> = None;
                for [i, j, k, rest] in [[0, 1, 2, 3], [0, 1, 3, 2], [0, 2, 3, 1], [1, 2, 3, 0]] {
                    let [a, b, c] = [i, j, k].map(|at| self.points[at]);
                    let (p, q) = (b - a, c - a);
                    let normal = p.cross(&q);
                    let (origin, other) = (-normal.dot(&a), normal.dot(&(self.points[rest] - a)));
                    if (origin > 0.0) == (other > 0.0) {
                        // The product is right to 8u of the lengths, of which the error is 64u.
                        let least = error * (4.0 * normal.norm() + p.norm() * q.norm());
                        if origin.abs() > least && other.abs() > least {
                            continue;
                        }
                    }
                    let weights = on_triangle(&a, &b, &c);
                    let square = (a * weights[0] + b * weights[1] + c * weights[2]).norm_squared();
                    if best.is_none_or(|(.., before)| square < before) {
                        best = Some(([i, j, k], weights, square));
                    }
                }
                best.map(|(which, weights, _)| self.keep(which, weights))
            }
        }
    }

    /// Keeps the points of these that have a weight, and returns their sum.
    fn keep(&mut self, which: [usize; 3], weights: [f64; 3]) -> Vector {
        debug_assert!((weights.iter().sum::<f64>() - 1.0).abs() < 1e-9);
        let (points, pairs) = (self.points, self.pairs);
        let mut nearest = Vector::zeros();
        self.count = 0;
        for (from, weight) in which.into_iter().zip(weights) {
            if weight > 0.0 {
                let to = self.count;
                (self.points[to], self.pairs[to], self.weights[to]) = (points[from], pairs[from], weight);
                nearest += points[from] * weight;
                self.count += 1;
            }
        }
        nearest
    }

    /// The contact of both along a direction.
    fn contact(
        &self,
        body: &Vertices,
        reach: &GroundReach,
        triangle: &PlacedTriangle,
        up: &Vector,
        found: SignedDistance,
    ) -> SignedDistance {
        let (mut own, mut on) = (Vector::zeros(), Vector::zeros());
        let (mut vertices, mut vertex_count) = ([0; 4], 0);
        let (mut corners, mut corner_count) = ([0; 3], 0);
        for (&(vertex, corner), weight) in self.pairs[..self.count].iter().zip(self.weights) {
            own += body.point(vertex) * weight;
            on += triangle.corners[corner] * weight;
            if !vertices[..vertex_count].contains(&vertex) {
                vertices[vertex_count] = vertex;
                vertex_count += 1;
            }
            if !corners[..corner_count].contains(&corner) {
                corners[corner_count] = corner;
                corner_count += 1;
            }
        }
        let (polyhedron, pose) = (body.polyhedron(), body.pose());
        let (local, towards) = (local_point(pose, &own) - polyhedron.centre, pose.rotate_back(&-up));
        let feature = feature_of_vertices(polyhedron, &vertices[..vertex_count], &local, &towards, triangle.error);
        let labels = triangle.own.labels;
        let (kind, ids) = match corners[..corner_count] {
            [one] => (FeatureKind::Vertex, [labels[one], 0]),
            [one, other] => (FeatureKind::Edge, [labels[one], labels[other]]),
            _ => (FeatureKind::Face, [triangle.own.label, 0]),
        };
        let world1 = own - up * body.body.shape.swept_radius();
        SignedDistance {
            local1: local_point(pose, &world1).into(),
            local2: reach.point(&on).into(),
            world1: world1.into(),
            world2: on.into(),
            // The sum with +0 turns −0 into 0.
            normal: up.add_scalar(0.0).into(),
            feature1: label(polyhedron, feature, &local),
            feature2: Feature { kind, ids },
            ..found
        }
    }
}

/// The weights of the point of a segment nearest to the origin; the third is 0.
fn on_segment(a: &Vector, b: &Vector) -> [f64; 3] {
    let way = b - a;
    let part = -a.dot(&way) / way.norm_squared();
    // A NaN, of a segment without length, is the first end.
    if !(part > 0.0) {
        [1.0, 0.0, 0.0]
    } else if part >= 1.0 {
        [0.0, 1.0, 0.0]
    } else {
        [1.0 - part, part, 0.0]
    }
}

/// The weights of the point of a triangle nearest to the origin (Ericson, Real-Time Collision Detection, 2005, §5.1.5).
fn on_triangle(a: &Vector, b: &Vector, c: &Vector) -> [f64; 3] {
    let (ab, ac) = (b - a, c - a);
    let [d1, d2] = [-ab.dot(a), -ac.dot(a)];
    if d1 <= 0.0 && d2 <= 0.0 {
        return [1.0, 0.0, 0.0];
    }
    let [d3, d4] = [-ab.dot(b), -ac.dot(b)];
    if d3 >= 0.0 && d4 <= d3 {
        return [0.0, 1.0, 0.0];
    }
    let vc = d1 * d4 - d3 * d2;
    if vc <= 0.0 && d1 >= 0.0 && d3 <= 0.0 {
        let part = d1 / (d1 - d3);
        return [1.0 - part, part, 0.0];
    }
    let [d5, d6] = [-ab.dot(c), -ac.dot(c)];
    if d6 >= 0.0 && d5 <= d6 {
        return [0.0, 0.0, 1.0];
    }
    let vb = d5 * d2 - d1 * d6;
    if vb <= 0.0 && d2 >= 0.0 && d6 <= 0.0 {
        let part = d2 / (d2 - d6);
        return [1.0 - part, 0.0, part];
    }
    let va = d3 * d6 - d5 * d4;
    let [p, q] = [d4 - d3, d5 - d6];
    if va <= 0.0 && p >= 0.0 && q >= 0.0 {
        let part = p / (p + q);
        return [0.0, 1.0 - part, part];
    }
    let sum = va + vb + vc;
    // A NaN, of a triangle without area, is its first side.
    if sum > 0.0 { [va / sum, vb / sum, vc / sum] } else { on_segment(a, b) }
}

#[cfg(test)]
mod tests {
    use super::super::contacts::near_hills::near_hills;
    use super::*;
    use crate::pair::{self, Outcome, PairAnswer, PairCache, PairConfig};
    use crate::shape::TriangleShape;

    /// Verdicts are those of the pair layer, which decides in integers, and so are distances.
    #[test]
    fn what_a_search_tells_is_so() {
        let mut shape = TriangleShape::new().unwrap();
        let mut seen = [0; 4];
        near_hills(0x51e, 90, |near, random| {
            let triangle = near.triangle;
            let limit = Limit { radius: 0.0, max_distance: random.uniform(0.0, 0.3) };
            let lowest = Lowest::new(near.vertices, triangle, &triangle.up, 0);
            let found = nearest(near.vertices, near.reach, triangle, &lowest, limit);
            let bodies = [near.vertices.body, shape.of(&triangle.own).at(near.place)];
            let mut truth = PairAnswer::default();
            pair::distance(bodies, &mut PairCache::default(), &PairConfig::default(), &mut truth).unwrap();
            match found {
                NearestOfTriangle::Beyond => assert!(truth.upper > limit.max_distance),
                NearestOfTriangle::Meeting => assert_eq!(truth.outcome, Outcome::Intersecting),
                NearestOfTriangle::Apart(contact) => {
                    assert_eq!(truth.outcome, Outcome::Separated);
                    assert!(contact.lower <= truth.upper && truth.lower <= contact.upper);
                    let [one, other] = [contact.world1, contact.world2].map(Vector::from);
                    let normal = Vector::from(contact.normal);
                    assert!((one - other - normal * contact.distance).norm() < 1e-12);
                    assert!((normal - Vector::from(truth.normal)).norm() < 1e-6);
                }
                NearestOfTriangle::Open => {}
            }
            seen[match found {
                NearestOfTriangle::Beyond => 0,
                NearestOfTriangle::Meeting => 1,
                NearestOfTriangle::Apart(_) => 2,
                NearestOfTriangle::Open => 3,
            }] += 1;
        });
        assert!(cfg!(miri) || seen[..3].iter().all(|count| *count > 50) && seen[3] == 0, "{seen:?}");
    }
}
