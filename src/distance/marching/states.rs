//! The states: tests of one pair of features, and where to go from there or what minimum it is. If a state has a vertex, that is
//! a vertex of the body NEAR, and the other body is "far".

use super::ahead::{prefetch_across, prefetch_edges, prefetch_ends};
use super::shortcuts::{NEARLY_UNIT, is_passed, over_another_feature, past_the_end};
use super::step::Step;
use super::walks::{Descent, WIDE_FACE, behind, walk_along_edge, walk_over_face};
use crate::base::math::{UNIT_ROUNDOFF, clamp};
use crate::base::scalar::{Scalar, constant};
use crate::base::simd::Lanes;
use crate::body::polyhedron::{NONE, Polyhedron};
use crate::distance::certificate::{
    Certify, Minimum, RIGID_MISFIT, edge_rounding, face_rounding, is_inside_sides, of_edge_at_vertex, of_edge_in_cone,
    of_facing_face, reciprocal_length,
};
use crate::placed::frame::Frame;
use crate::placed::state::{State, ordered};
use crate::placed::voronoi::{
    Corner, Rule, STRICT, VertexTest, edge_direction, end_of, plane_slopes, plane_values, test_vertex, violated_side,
};

#[inline(always)]
pub(super) fn vertex_vertex<L: Lanes, C: Certify<L>>(frame: &Frame<L>, indices: [u32; 2], certifier: &mut C) -> Step {
    let [body1, body2] = &frame.bodies;
    let (Some(corner1), Some(corner2)) =
        (Corner::of(body1.polyhedron, indices[0]), Corner::of(body2.polyhedron, indices[1]))
    else {
        return Step::nowhere();
    };
    let (point1, point2) = (&corner1.record.position, &corner2.record.position);
    let rotated = [body1.rotate(point1), body2.rotate(point2)];
    let direction = rotated[0].add(body1.offset).sub(rotated[1]);
    let towards = [body1.rotate_back(direction).negate(), body2.rotate_back(direction)];
    // At most √3 times the length, without the root for which the tests would wait.
    let bound = direction.norm1();
    let test1 = test_corner::<L, C>(corner1, towards[0], bound, frame.tolerance);
    let test2 = test_corner::<L, C>(corner2, towards[1], bound, frame.tolerance);
    Step::to(match (test1, test2) {
        (
            VertexTest::Leaves { edge, head, parameter },
            VertexTest::Leaves { edge: edge2, head: head2, parameter: parameter2 },
        ) => {
            // Both features change in one step (Ehmann & Lin 2000, §5.1).
            match (
                is_passed::<L, C>(body1.polyhedron, edge, parameter),
                is_passed::<L, C>(body2.polyhedron, edge2, parameter2),
            ) {
                (false, false) => State::edge_edge([edge, edge2]),
                (false, true) => State::vertex_edge(1, head2, edge),
                (true, false) => State::vertex_edge(0, head, edge2),
                (true, true) => State::vertex_vertex([head, head2]),
            }
        }
        (VertexTest::Leaves { edge, head, parameter }, _) => {
            if is_passed::<L, C>(body1.polyhedron, edge, parameter) {
                State::vertex_vertex([head, indices[1]])
            } else {
                State::vertex_edge(1, indices[1], edge)
            }
        }
        (_, VertexTest::Leaves { edge, head, parameter }) => {
            if is_passed::<L, C>(body2.polyhedron, edge, parameter) {
                State::vertex_vertex([indices[0], head])
            } else {
                State::vertex_edge(0, indices[0], edge)
            }
        }
        _ => {
            let square = direction.dot(direction);
            let (length, inverse) = (square.sqrt(), reciprocal_length(square));
            let minimum = Minimum {
                points: [L::from_vector(point1), L::from_vector(point2)],
                rotated,
                difference: direction,
                error: 0.0,
                direction,
                inverse,
                distance: length,
                projection: length,
                support_excess: excess_at_vertex(body1.polyhedron, test1, towards[0], inverse)
                    + excess_at_vertex(body2.polyhedron, test2, towards[1], inverse),
                point_error: 0.0,
                height: 0.0,
            };
            let at = State::vertex_vertex(indices);
            certifier.certify(frame, at, &minimum);
            return Step::minimum(at);
        }
    })
}

/// [`test_vertex`] as the certifier wants it.
#[inline(always)]
fn test_corner<L: Lanes, C: Certify<L>>(corner: Corner, towards: L, length: f64, tolerance: f64) -> VertexTest {
    if C::LOOKS_AHEAD {
        prefetch_edges::<L>(corner);
    }
    test_vertex(C::RULE, corner, towards, length, tolerance)
}

#[inline(always)]
pub(super) fn vertex_edge<L: Lanes, C: Certify<L>, const NEAR: usize>(
    frame: &Frame<L>,
    vertex: u32,
    edge: u32,
    certifier: &mut C,
) -> Step {
    let (body, far) = (&frame.bodies[NEAR], &frame.bodies[1 - NEAR]);
    let (Some(corner), Some(record)) = (Corner::of(body.polyhedron, vertex), far.polyhedron.edges.get(edge as usize))
    else {
        return Step::nowhere();
    };
    let position = &corner.record.position;
    let rotated = body.rotate(position);
    let point = far.rotate_back(rotated.add(body.offset));
    prefetch_across::<L>(far.polyhedron, record);
    let values = plane_values(&record.planes, point);
    let inside = values.greater(L::splat(MARGIN * frame.tolerance));
    let least = L::splat(-frame.tolerance);
    if inside != 0b1111 && least.greater(values) != 0 {
        let lane = C::RULE.violated(values, least);
        let across = record.across[lane & 3];
        if lane < 2
            && let Some(state) = past_the_end::<L, C, NEAR>(frame, corner, rotated, across)
        {
            return Step::to(state);
        }
        return Step::to(State::across_edge(NEAR, vertex, lane, across));
    }
    // All in world axes: no transpose stands for an inverse. The difference of the nearest points, perpendicular to the edge.
    let along = edge_direction(&record.planes);
    let tail = &record.tail_position;
    let (along_world, tail_world) = (far.rotate(&along), far.rotate(tail));
    let from_far = rotated.add(body.offset);
    let from_tail = from_far.sub(tail_world);
    // The reciprocal of |Rê|², which a rigid R leaves at 1 up to rounding: there one step of Newton's iteration makes it.
    let stretched = along_world.dot(along_world);
    let correction = if frame.rigid { correction(stretched) } else { 1.0 / stretched };
    let free = projected(from_tail.dot(along_world), correction);
    let t = clamp(free, 0.0, record.length);
    let difference = from_foot(from_tail, along_world, t);
    let mut direction = difference;
    let distance_squared = difference.dot(difference);
    let mut square = distance_squared;
    // Close to a long edge the rounding of x − tail leaves a part along the edge that a second time removes.
    let mut leaning = t;
    if t * t > 16.0 * distance_squared {
        leaning = projected(difference.dot(along_world), correction);
        direction = along_world.negated_mul_add(L::splat(leaning), difference);
        square = direction.dot(direction);
    }
    let towards_far = body.rotate_back(direction).negate();
    let test = test_corner::<L, C>(corner, towards_far, direction.norm1(), frame.tolerance);
    if let VertexTest::Leaves { edge: leaving, head, parameter } = test {
        return Step::to(if is_passed::<L, C>(body.polyhedron, leaving, parameter) {
            State::vertex_edge(NEAR, head, edge)
        } else {
            State::edge_edge(ordered(NEAR, leaving, edge))
        });
    }
    let distance = distance_squared.sqrt();
    let inverse = reciprocal_length(square);
    let projection = direction.dot(difference) * inverse;
    // Far enough inside all four planes the foot lies on the edge and RᵀU in the cone of its normals, except for a part along the
    // edge: of 10.3u·|x − tail| + 6.4u|U| by rounding, the length of x − tail being at most |U| + t; 12u allow for how much the
    // planes of a feature miss each other.
    let is_plain = frame.rigid & (inside == 0b1111);
    let misfit = misfit_across_edge(leaning, inverse);
    let support_excess = if is_plain { of_edge_in_cone(far.polyhedron, record, misfit) } else { f64::INFINITY };
    // R·tail is one of the products that the frame's bound is for; R·ê, the length of x − tail and the last difference come on top.
    let error = error_along(t, distance);
    let foot = L::from_vector(&along).mul_add(L::splat(t), L::from_vector(tail));
    let minimum = Minimum {
        points: in_order::<L, NEAR>(L::from_vector(position), foot),
        // Not x − (x − foot), which loses the foot's digits where x is far away.
        rotated: in_order::<L, NEAR>(rotated, along_world.mul_add(L::splat(t), tail_world)),
        difference: signed::<L, NEAR>(difference),
        error,
        direction: signed::<L, NEAR>(direction),
        inverse,
        distance,
        projection,
        support_excess: support_excess + excess_at_vertex(body.polyhedron, test, towards_far, inverse),
        point_error: edge_rounding(far.polyhedron),
        height: 0.0,
    };
    let at = State::vertex_edge(NEAR, vertex, edge);
    certifier.certify(frame, at, &minimum);
    Step::minimum(at)
}

#[inline(always)]
pub(super) fn vertex_face<L: Lanes, C: Certify<L>, const NEAR: usize>(
    frame: &Frame<L>,
    vertex: u32,
    face: u32,
    certifier: &mut C,
) -> Step {
    let (body, far) = (&frame.bodies[NEAR], &frame.bodies[1 - NEAR]);
    let (Some(corner), Some(record)) = (Corner::of(body.polyhedron, vertex), far.polyhedron.faces.get(face as usize))
    else {
        return Step::nowhere();
    };
    let position = &corner.record.position;
    let rotated = body.rotate(position);
    let point = far.rotate_back(rotated.add(body.offset));
    for side in record.first_sides {
        L::prefetch(&far.polyhedron.edges, side);
    }
    // Lane 0 is the height over the face, lanes 1 to 3 the sides.
    let values = plane_values(&record.planes, point);
    // The sides' planes are upright, so the foot lies as deep inside them as the point, up to less than the tolerance.
    let inside = values.greater(L::splat(MARGIN * frame.tolerance)) & 0b1110 == 0b1110;
    if (record.side_count > 3) | !inside
        && let Some(side) = violated_side(C::RULE, far.polyhedron, record, [point, values], frame.tolerance)
    {
        let edge = far.polyhedron.side(record, side);
        let another = over_another_feature::<L, C, NEAR>(frame, corner, record, edge, [point, values]);
        return Step::to(another.unwrap_or(State::vertex_edge(NEAR, vertex, edge)));
    }
    let [height, ..] = values.to_array();
    if height <= 0.0 {
        return behind::<NEAR>(far.polyhedron, vertex, face, &point.to_vector());
    }
    let normal = L::from_vector(&record.normal);
    let direction = far.lift(normal);
    let towards_far = body.rotate_back(direction).negate();
    let test = test_corner::<L, C>(corner, towards_far, NEARLY_UNIT, STRICT);
    if let VertexTest::Leaves { edge: leaving, head, .. } = test {
        if (record.side_count >= WIDE_FACE) & (C::RULE == Rule::Most) {
            let lower = L::out_of_line(&mut Descent::of::<NEAR>(frame, face, towards_far, head));
            if lower != NONE {
                return Step::to(State::vertex_face(NEAR, lower, face));
            }
        }
        return walk_over_face::<L, NEAR>(frame, vertex, face, [point, values], [leaving, head]);
    }
    let foot = normal.negated_mul_add(L::splat(height), point);
    let square = direction.dot(direction);
    let is_plain = frame.rigid && inside && (record.side_count == 3 || is_inside_sides(far.polyhedron, record, foot));
    let (inverse, support_excess) = if is_plain {
        // |U|² = 1 + ε, |ε| < 100u: one step of Newton's iteration for the reciprocal root.
        (1.5 - 0.5 * square, of_facing_face(far.polyhedron, record, height, RIGID_MISFIT))
    } else {
        (reciprocal_length(square), f64::INFINITY)
    };
    let rotated_foot = far.rotate_lanes(foot);
    let difference = rotated.add(body.offset).sub(rotated_foot);
    let minimum = Minimum {
        points: in_order::<L, NEAR>(L::from_vector(position), foot),
        rotated: in_order::<L, NEAR>(rotated, rotated_foot),
        difference: signed::<L, NEAR>(difference),
        error: 0.0,
        direction: signed::<L, NEAR>(direction),
        inverse,
        distance: difference.dot(difference).sqrt(),
        projection: direction.dot(difference) * inverse,
        support_excess: support_excess + excess_at_vertex(body.polyhedron, test, towards_far, inverse),
        point_error: record.slack + face_rounding(far.polyhedron.radius, height),
        height,
    };
    let at = State::vertex_face(NEAR, vertex, face);
    certifier.certify(frame, at, &minimum);
    Step::minimum(at)
}

/// A point as many tolerances, 96u·(ρ₁ + ρ₂ + |Δ|) in all, inside the planes of a feature counts as provably inside.
///
/// Over a triangle, whose sides do not lean: its foot q has to be inside by 24u·max(ρ, |q|), see [`is_inside_sides`]; the foot's
/// values differ from the point's by a few u of the height and of both points' magnitudes. By an edge: with x seen from the far
/// body as p = Rᵀx and U = x − R·foot, RᵀU = p − foot − E·foot, E = RᵀR − I. The planes' values for p differ from those for RᵀU +
/// foot by 29u·ρ for E, 8u(|p| + ρ) for planes and their values, 6u|p| for the product and, for x, 8u(ρ₁ + ρ₂) + 2u|Δ| + 2u|p|:
/// at most 62u·(ρ₁ + ρ₂ + |Δ|) in all.
const MARGIN: f64 = 3.0;

#[inline(always)]
pub(super) fn edge_edge<L: Lanes, C: Certify<L>>(frame: &Frame<L>, indices: [u32; 2], certifier: &mut C) -> Step {
    let [body1, body2] = &frame.bodies;
    let [edges1, edges2] = [&body1.polyhedron.edges, &body2.polyhedron.edges];
    let (Some(record1), Some(record2)) = (edges1.get(indices[0] as usize), edges2.get(indices[1] as usize)) else {
        return Step::nowhere();
    };
    prefetch_ends::<L>(body1.polyhedron, record1);
    prefetch_ends::<L>(body2.polyhedron, record2);
    let (along1, along2) = (edge_direction(&record1.planes), edge_direction(&record2.planes));
    let (world1, world2) = (body1.rotate(&along1), body2.rotate(&along2));
    let (tail1, tail2) = (&record1.tail_position, &record2.tail_position);
    let (rotated1, rotated2) = (body1.rotate(tail1), body2.rotate(tail2));
    let between = rotated1.add(body1.offset).sub(rotated2);
    let mut normal = world1.cross(world2);
    // sin² of the angle from the cross product: 1 − cos² has no digits left below 1e-8.
    let sine_squared = normal.dot(normal);
    let cosine = world1.dot(world2);
    let (c, f) = (world1.dot(between), world2.dot(between));
    // |Rê|²: 1 up to rounding, except where R stretches.
    let squares = if frame.rigid { [1.0; 2] } else { [world1.dot(world1), world2.dot(world2)] };
    let inverses = if frame.rigid { [1.0; 2] } else { squares.map(f64::recip) };
    // Nearest points of two segments (Ericson 2005, §5.1.9). Parallel ones, whose cross product is rounding, start at a tail.
    let (length1, length2) = (record1.length, record2.length);
    let parallel = sine_squared <= PARALLEL;
    let free = if parallel { 0.0 } else { (cosine * f - c * squares[1]) / sine_squared };
    let mut s = clamp(free, 0.0, length1);
    let t_free = (cosine * s + f) * inverses[1];
    let t = clamp(t_free, 0.0, length2);
    if t != t_free {
        s = clamp((cosine * t - c) * inverses[0], 0.0, length1);
    }
    let end1 = end_of(s, length1, record1.tail(), record1.head());
    let end2 = end_of(t, length2, record2.tail(), record2.head());
    match (end1, end2) {
        (Some(vertex1), Some(vertex2)) => return Step::to(State::vertex_vertex([vertex1, vertex2])),
        (Some(vertex), None) => return Step::to(State::vertex_edge(0, vertex, indices[1])),
        (None, Some(vertex)) => return Step::to(State::vertex_edge(1, vertex, indices[0])),
        (None, None) => {}
    }
    if parallel {
        // Every point is nearest; let a vertex and the other edge finish.
        let vertex = if s <= 0.5 * length1 { record1.tail() } else { record1.head() };
        return Step::to(State::vertex_edge(0, vertex, indices[1]));
    }
    if between.dot(normal) < 0.0 {
        normal = normal.negate();
    }
    let towards = [body1.rotate_back(normal).negate(), body2.rotate_back(normal)];
    // In the normal cone of an edge the direction leaves both faces; the first two lanes are along the edge and vanish.
    let bound = normal.norm1();
    let slack = L::splat(-STRICT * if bound > 2.0 * STRICT { bound } else { 2.0 * STRICT });
    let values1 = plane_slopes(&record1.planes, towards[0]);
    let values2 = plane_slopes(&record2.planes, towards[1]);
    let across = L::upper_halves(values1, values2);
    if slack.greater(across) != 0 {
        let lane = C::RULE.violated(across, slack);
        return if lane < 2 {
            let face = if lane == 0 { record1.left() } else { record1.right() };
            walk_along_edge::<L, 1>(frame, indices, t, face, (&record1.planes, lane + 2))
        } else {
            let face = if lane == 2 { record2.left() } else { record2.right() };
            walk_along_edge::<L, 0>(frame, indices, s, face, (&record2.planes, lane))
        };
    }
    // For g = RᵀU, |U| = sine, the part along the edge is U·Rê: Rê errs by 5.3u, the cross product by u|U| and 2.1u. Across it
    // the slopes, found not negative, err by 5.3u|U| for RᵀU and 3.1u|U| for the products; 12u allow for how much the planes of a
    // feature miss each other.
    let inverse = reciprocal_length(sine_squared);
    let misfit = misfit_between_edges(inverse);
    let is_plain = L::splat(0.0).greater(across) == 0;
    let support_excess = if is_plain {
        of_edge_in_cone(body1.polyhedron, record1, misfit) + of_edge_in_cone(body2.polyhedron, record2, misfit)
    } else {
        f64::INFINITY
    };
    let points = [
        L::from_vector(&along1).mul_add(L::splat(s), L::from_vector(tail1)),
        L::from_vector(&along2).mul_add(L::splat(t), L::from_vector(tail2)),
    ];
    let rotated = [world1.mul_add(L::splat(s), rotated1), world2.mul_add(L::splat(t), rotated2)];
    let difference = between_feet(between, [world1, world2], [s, t]);
    let distance = difference.dot(difference).sqrt();
    let minimum = Minimum {
        points,
        rotated,
        difference,
        // R·tail are the products that the frame's bound is for; R·ê, the length of x − y between the tails and two sums come
        // on top.
        error: error_along(s + t, distance),
        direction: normal,
        inverse,
        distance,
        projection: normal.dot(difference) * inverse,
        support_excess,
        point_error: edge_rounding(body1.polyhedron) + edge_rounding(body2.polyhedron),
        height: 0.0,
    };
    let at = State::edge_edge(indices);
    certifier.certify(frame, at, &minimum);
    Step::minimum(at)
}

/// Below this sin² of the angle between two edges their cross product of unit vectors (error 4u a component) has fewer than
/// two digits.
const PARALLEL: f64 = 1e-28;

/// A point seen from the foot at t of an edge, `from_tail` from its tail.
#[inline(always)]
pub fn from_foot<L: Lanes>(from_tail: L, along: L, t: f64) -> L {
    along.negated_mul_add(L::splat(t), from_tail)
}

/// A point at s of one edge seen from that at t of another, whose tails are so far from each other.
#[inline(always)]
pub fn between_feet<L: Lanes>(tails: L, [along1, along2]: [L; 2], [s, t]: [f64; 2]) -> L {
    along2.negated_mul_add(L::splat(t), along1.mul_add(L::splat(s), tails))
}

/// One step of Newton's iteration for 1/x, where x is near 1.
#[inline(always)]
pub fn correction<S: Scalar>(x: S) -> S {
    constant::<S>(2.0) - x
}

/// A product with a vector whose length is about 1, over its square.
#[inline(always)]
pub fn projected<S: Scalar>(product: S, correction: S) -> S {
    product * correction
}

/// How far a direction across an edge, of reciprocal length `inverse`, is out of the cone of its normals: what [`from_foot`]
/// leaves.
#[inline(always)]
pub fn misfit_across_edge<S: Scalar>(leaning: S, inverse: S) -> S {
    constant::<S>(UNIT_ROUNDOFF) * (constant::<S>(29.0) + constant::<S>(10.5) * leaning.abs() * inverse)
}

/// How far the cross product of two edges, of reciprocal length `inverse`, is out of the cone of either's normals.
#[inline(always)]
pub fn misfit_between_edges<S: Scalar>(inverse: S) -> S {
    constant::<S>(UNIT_ROUNDOFF) * (constant::<S>(28.0) + constant::<S>(3.0) * inverse)
}

/// The error that points on edges add to a difference: they are so far from the tails, in all.
#[inline(always)]
pub fn error_along<S: Scalar>(along: S, distance: S) -> S {
    constant::<S>(10.0 * UNIT_ROUNDOFF) * (along + distance)
}

/// The NEAR body's part and the other's, in the order of the bodies.
#[inline(always)]
fn in_order<L: Lanes, const NEAR: usize>(near: L, far: L) -> [L; 2] {
    if NEAR == 0 { [near, far] } else { [far, near] }
}

/// A direction from the far body to body NEAR as one from body 2 to body 1.
#[inline(always)]
fn signed<L: Lanes, const NEAR: usize>(direction: L) -> L {
    if NEAR == 0 { direction } else { direction.negate() }
}

/// δ/|U| of a vertex: 0 if all neighbours lie strictly behind; else by the edge to one that ties, as where faces or edges are
/// parallel; `towards` is the direction in the body's axes, with the reciprocal length of U.
#[inline(always)]
fn excess_at_vertex<L: Lanes>(polyhedron: &Polyhedron, test: VertexTest, towards: L, inverse: f64) -> f64 {
    match test {
        VertexTest::Strict => 0.0,
        VertexTest::Tied { edge } => of_edge_at_vertex(polyhedron, edge, &towards.to_vector()) * inverse,
        VertexTest::Leaves { .. } => f64::INFINITY,
    }
}
