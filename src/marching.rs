//! Voronoi marching between two convex polyhedra: from a pair of features to the pair that holds the nearest points.
//!
//! A state moves to the neighbour across the most violated plane (Ehmann & Lin 2000, §5.1; Lin & Canny 1991; Mirtich 1998),
//! all planes of a state being tested in one short vector chain. In a minimum the optimality conditions hold: each nearest
//! point lies in its feature, and the direction between them in the normal cones of both features.
//!
//! Marching proposes. What it finds is accepted by the certificate alone, which is fused with the last step; what it cannot
//! finish (a suspected penetration, a cycle, the step limit) is decided elsewhere.

use crate::certificate::{
    Certify, Minimum, RIGID_MISFIT, edge_rounding, face_rounding, is_inside_sides, of_edge_in_cone, of_facing_face,
    reciprocal_length,
};
use crate::frame::Frame;
use crate::math::{UNIT_ROUNDOFF, Vector, clamp};
use crate::polyhedron::{NONE, PlaneBlock, Polyhedron};
use crate::simd::Lanes;
use crate::state::{Kind, State};
use crate::voronoi::{
    STRICT, VertexTest, edge_direction, end_of, exit_of_prism, most_violated_side, plane_slopes, plane_values,
    test_vertex,
};

/// What marching came to.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum March {
    /// A minimum at this state; the judge has seen it.
    Minimum(State),
    /// The step limit was met on the way to this state.
    Limit(State),
    /// A penetration is suspected, or a cycle was met, at this state.
    Open(State),
}

/// What one state's tests say.
pub enum Step {
    /// To go on from this state.
    Move(State),
    /// A minimum; the judge has seen it.
    Minimum,
    /// A vertex lies over the face and behind it: a penetration, or the wrong side of the other body. Where to go on.
    Behind(State),
    /// An edge of one body crosses a face of the other.
    Crossing(State),
}

/// Tests one state; a minimum goes to `judge`.
#[inline(always)]
pub fn visit<L: Lanes, J: Certify<L>>(frame: &Frame<L>, state: State, judge: &mut J) -> Step {
    let [first, second] = state.indices;
    match state.kind {
        Kind::VertexVertex => vertex_vertex(frame, [first, second], judge),
        Kind::VertexEdge => vertex_edge::<L, J, 0>(frame, first, second, judge),
        Kind::EdgeVertex => vertex_edge::<L, J, 1>(frame, second, first, judge),
        Kind::VertexFace => vertex_face::<L, J, 0>(frame, first, second, judge),
        Kind::FaceVertex => vertex_face::<L, J, 1>(frame, second, first, judge),
        Kind::EdgeEdge => edge_edge(frame, [first, second], judge),
    }
}

/// Marches from `start`; a minimum goes to `judge`. Returns the number of states visited too.
#[inline(always)]
pub fn march<L: Lanes, J: Certify<L>>(frame: &Frame<L>, start: State, step_limit: u32, judge: &mut J) -> (March, u32) {
    let mut state = start;
    // Brent's cycle detection: a state seen at a power of two and met again.
    let mut mark = start;
    let mut steps = 0;
    let mut jumped = false;
    loop {
        steps += 1;
        let next = match visit(frame, state, judge) {
            Step::Minimum => return (March::Minimum(state), steps),
            Step::Move(next) => next,
            Step::Crossing(at) => return (March::Open(at), steps),
            // A local minimum of Voronoi marching (Mirtich 1998, §4.3) is left once; the second time penetration is likely, and
            // decided elsewhere.
            Step::Behind(next) if jumped => return (March::Open(next), steps),
            Step::Behind(next) => {
                jumped = true;
                next
            }
        };
        if next == mark {
            return (March::Open(next), steps);
        }
        if steps >= step_limit {
            return (March::Limit(next), steps);
        }
        if steps.is_power_of_two() {
            mark = next;
        }
        state = next;
    }
}

// ---------------------------------------------------------------------------------------------------------------------
// The states. Where a state has a vertex, that is a vertex of the body NEAR, and the other body is "far".
// ---------------------------------------------------------------------------------------------------------------------

#[inline(always)]
fn vertex_vertex<L: Lanes, J: Certify<L>>(frame: &Frame<L>, indices: [u32; 2], judge: &mut J) -> Step {
    let [body1, body2] = &frame.bodies;
    let point1 = &body1.polyhedron.vertices[indices[0] as usize].position;
    let point2 = &body2.polyhedron.vertices[indices[1] as usize].position;
    let rotated = [body1.rotate(point1), body2.rotate(point2)];
    let direction = rotated[0].add(body1.offset).sub(rotated[1]);
    let towards = [body1.rotate_back(direction).negate(), body2.rotate_back(direction)];
    let square = direction.dot(direction);
    let length = square.sqrt();
    let test1 = test_vertex(body1.polyhedron, indices[0], towards[0], length, frame.tolerance);
    let test2 = test_vertex(body2.polyhedron, indices[1], towards[1], length, frame.tolerance);
    Step::Move(match (test1, test2) {
        (VertexTest::Leaves { edge, head }, VertexTest::Leaves { edge: edge2, head: head2 }) => {
            // Both features change in one step (Ehmann & Lin 2000, §5.1).
            match (edge == NONE, edge2 == NONE) {
                (false, false) => State::edge_edge([edge, edge2]),
                (false, true) => State::vertex_edge(1, head2, edge),
                (true, false) => State::vertex_edge(0, head, edge2),
                (true, true) => State::vertex_vertex([head, head2]),
            }
        }
        (VertexTest::Leaves { edge: NONE, head }, _) => State::vertex_vertex([head, indices[1]]),
        (VertexTest::Leaves { edge, .. }, _) => State::vertex_edge(1, indices[1], edge),
        (_, VertexTest::Leaves { edge: NONE, head }) => State::vertex_vertex([indices[0], head]),
        (_, VertexTest::Leaves { edge, .. }) => State::vertex_edge(0, indices[0], edge),
        _ => {
            let minimum = Minimum {
                points: [L::from_vector(point1), L::from_vector(point2)],
                rotated,
                direction,
                inverse: reciprocal_length(square),
                beyond: beyond_vertex(test1) + beyond_vertex(test2),
                outside: 0.0,
                height: 0.0,
            };
            judge.certify(frame, State::vertex_vertex(indices), &minimum);
            return Step::Minimum;
        }
    })
}

#[inline(always)]
fn vertex_edge<L: Lanes, J: Certify<L>, const NEAR: usize>(
    frame: &Frame<L>,
    vertex: u32,
    edge: u32,
    judge: &mut J,
) -> Step {
    let (body, far) = (&frame.bodies[NEAR], &frame.bodies[1 - NEAR]);
    let position = &body.polyhedron.vertices[vertex as usize].position;
    let rotated = body.rotate(position);
    let point = far.rotate_back(rotated.add(body.offset));
    let record = &far.polyhedron.edges[edge as usize];
    let values = plane_values(&record.planes, point);
    let inside = values.greater(L::splat(frame.tolerance));
    if inside != 0b1111 {
        let outside = L::splat(-frame.tolerance).greater(values);
        if outside != 0 {
            let (_, lane) = values.least();
            let across = [record.tail, record.head, record.left, record.right][lane & 3];
            let indices = ordered::<NEAR>(vertex, across);
            return Step::Move(if lane < 2 {
                State::vertex_vertex(indices)
            } else {
                State::vertex_face(NEAR, vertex, across)
            });
        }
    }
    let along = edge_direction(&record.planes);
    let tail = &far.polyhedron.vertices[record.tail as usize].position;
    let [parameter, ..] = values.to_array();
    let t = clamp(parameter, 0.0, record.length);
    // The component across the edge, taken twice: the second time removes what the first one's rounding left.
    let (along, tail) = (L::from_vector(&along), L::from_vector(tail));
    let from_tail = point.sub(tail);
    let across = along.negated_mul_add(L::splat(from_tail.dot(along)), from_tail);
    let across = along.negated_mul_add(L::splat(across.dot(along)), across);
    let direction = far.lift(across);
    let towards_far = body.rotate_back(direction).negate();
    let square = direction.dot(direction);
    let test = test_vertex(body.polyhedron, vertex, towards_far, square.sqrt(), frame.tolerance);
    if let VertexTest::Leaves { edge: leaving, head } = test {
        return Step::Move(if leaving == NONE {
            State::vertex_edge(NEAR, head, edge)
        } else {
            State::edge_edge(ordered::<NEAR>(leaving, edge))
        });
    }
    // A point inside the last two planes by the tolerance, which pass through the edge, lies across it in the cone of the normals.
    let is_plain = frame.rigid & (inside & 0b1100 == 0b1100);
    let beyond = if is_plain { of_edge_in_cone(far.polyhedron, record, RIGID_MISFIT) } else { f64::INFINITY };
    let foot = along.mul_add(L::splat(t), tail);
    let minimum = minimum_of::<L, NEAR>(
        [L::from_vector(position), foot],
        [rotated, far.rotate_lanes(foot)],
        direction,
        [reciprocal_length(square), beyond + beyond_vertex(test), edge_rounding(far.polyhedron), 0.0],
    );
    judge.certify(frame, State::vertex_edge(NEAR, vertex, edge), &minimum);
    Step::Minimum
}

#[inline(always)]
fn vertex_face<L: Lanes, J: Certify<L>, const NEAR: usize>(
    frame: &Frame<L>,
    vertex: u32,
    face: u32,
    judge: &mut J,
) -> Step {
    let (body, far) = (&frame.bodies[NEAR], &frame.bodies[1 - NEAR]);
    let position = &body.polyhedron.vertices[vertex as usize].position;
    let rotated = body.rotate(position);
    let point = far.rotate_back(rotated.add(body.offset));
    let record = &far.polyhedron.faces[face as usize];
    // Lane 0 is the height over the face, lanes 1 to 3 the sides.
    let values = plane_values(&record.planes, point);
    // The sides' planes are upright, so the foot lies as deep inside them as the point, up to less than the tolerance.
    let inside = values.greater(L::splat(SIDE_MARGIN * frame.tolerance)) & 0b1110 == 0b1110;
    if (record.side_count > 3) | !inside
        && let Some(side) = most_violated_side(far.polyhedron, record, values, point, frame.tolerance)
    {
        let edge = far.polyhedron.sides[(record.first_side + side) as usize];
        return Step::Move(State::vertex_edge(NEAR, vertex, edge));
    }
    let [height, ..] = values.to_array();
    if height <= 0.0 {
        return behind::<NEAR>(far.polyhedron, vertex, face, &point.to_vector());
    }
    let normal = L::from_vector(&record.normal);
    let direction = far.lift(normal);
    let towards_far = body.rotate_back(direction).negate();
    let test = test_vertex(body.polyhedron, vertex, towards_far, NEARLY_UNIT, STRICT);
    if let VertexTest::Leaves { edge: leaving, head } = test {
        return walk_over_face::<L, NEAR>(frame, vertex, face, [point, values], leaving, head);
    }
    let foot = normal.negated_mul_add(L::splat(height), point);
    let square = direction.dot(direction);
    let is_plain = frame.rigid && inside && (record.side_count == 3 || is_inside_sides(far.polyhedron, record, foot));
    let (inverse, beyond) = if is_plain {
        // |U|² = 1 + ε, |ε| < 100u: one step of Newton's iteration for the reciprocal root.
        (1.5 - 0.5 * square, of_facing_face(far.polyhedron, record, height, RIGID_MISFIT))
    } else {
        (reciprocal_length(square), f64::INFINITY)
    };
    let outside = record.slack + face_rounding(far.polyhedron, height);
    let minimum = minimum_of::<L, NEAR>(
        [L::from_vector(position), foot],
        [rotated, far.rotate_lanes(foot)],
        direction,
        [inverse, beyond + beyond_vertex(test), outside, height],
    );
    judge.certify(frame, State::vertex_face(NEAR, vertex, face), &minimum);
    Step::Minimum
}

/// A point of a triangle's prism deeper inside its sides than this many tolerances, 96u·(ρ₁ + ρ₂ + |Δ|) in all, has its foot inside
/// by [`is_inside_sides`]: that asks for 64u·ρ, and the foot's values differ from the point's by a few u of the height and of both
/// points' magnitudes.
const SIDE_MARGIN: f64 = 3.0;

/// An upper bound of the length of a vector that is unit up to 1 %.
const NEARLY_UNIT: f64 = 1.02;

/// A vertex over a face descends along an edge towards it: to the edge's end, or to the side of the prism where it leaves.
#[inline(always)]
fn walk_over_face<L: Lanes, const NEAR: usize>(
    frame: &Frame<L>,
    vertex: u32,
    face: u32,
    [point, values]: [L; 2],
    leaving: u32,
    head: u32,
) -> Step {
    let (body, far) = (&frame.bodies[NEAR], &frame.bodies[1 - NEAR]);
    // The far end of the edge, which need not be the neighbour: a vertex within the edge is a neighbour, too.
    let end = if leaving == NONE {
        head
    } else {
        let record = &body.polyhedron.edges[leaving as usize];
        if record.tail == vertex { record.head } else { record.tail }
    };
    let end_position = &body.polyhedron.vertices[end as usize].position;
    let end_point = far.rotate_back(body.rotate(end_position).add(body.offset));
    let record = &far.polyhedron.faces[face as usize];
    let end_values = plane_values(&record.planes, end_point);
    let (fraction, side) = exit_of_prism(far.polyhedron, record, [point, end_point], [values, end_values], NONE);
    let ([height, ..], [end_height, ..]) = (values.to_array(), end_values.to_array());
    if height + fraction * (end_height - height) <= 0.0 {
        return Step::Crossing(State::vertex_face(NEAR, vertex, face));
    }
    Step::Move(match side {
        Some(side) if leaving != NONE => {
            let far_edge = far.polyhedron.sides[(record.first_side + side) as usize];
            State::edge_edge(if NEAR == 0 { [leaving, far_edge] } else { [far_edge, leaving] })
        }
        _ => State::vertex_face(NEAR, end, face),
    })
}

#[inline(always)]
fn edge_edge<L: Lanes, J: Certify<L>>(frame: &Frame<L>, indices: [u32; 2], judge: &mut J) -> Step {
    let [body1, body2] = &frame.bodies;
    let record1 = &body1.polyhedron.edges[indices[0] as usize];
    let record2 = &body2.polyhedron.edges[indices[1] as usize];
    let (along1, along2) = (edge_direction(&record1.planes), edge_direction(&record2.planes));
    let (world1, world2) = (body1.rotate(&along1), body2.rotate(&along2));
    let tail1 = &body1.polyhedron.vertices[record1.tail as usize].position;
    let tail2 = &body2.polyhedron.vertices[record2.tail as usize].position;
    let between = frame.difference(tail1, tail2);
    let mut normal = world1.cross(world2);
    // sin² of the angle from the cross product: 1 − cos² has no digits left below 1e-8.
    let sine_squared = normal.dot(normal);
    let cosine = world1.dot(world2);
    let (c, f) = (world1.dot(between), world2.dot(between));
    // Nearest points of two segments (Ericson 2005, §5.1.9). Parallel ones, whose cross product is rounding, start at a tail.
    let (length1, length2) = (record1.length, record2.length);
    let parallel = sine_squared <= PARALLEL;
    let free = if parallel { 0.0 } else { (cosine * f - c) / sine_squared };
    let mut s = clamp(free, 0.0, length1);
    let t_free = cosine * s + f;
    let t = clamp(t_free, 0.0, length2);
    if t != t_free {
        s = clamp(cosine * t - c, 0.0, length1);
    }
    let end1 = end_of(s, length1, record1.tail, record1.head);
    let end2 = end_of(t, length2, record2.tail, record2.head);
    match (end1, end2) {
        (Some(vertex1), Some(vertex2)) => return Step::Move(State::vertex_vertex([vertex1, vertex2])),
        (Some(vertex), None) => return Step::Move(State::vertex_edge(0, vertex, indices[1])),
        (None, Some(vertex)) => return Step::Move(State::vertex_edge(1, vertex, indices[0])),
        (None, None) => {}
    }
    if parallel {
        // Every point is nearest; let a vertex and the other edge finish.
        let vertex = if s <= 0.5 * length1 { record1.tail } else { record1.head };
        return Step::Move(State::vertex_edge(0, vertex, indices[1]));
    }
    if between.dot(normal) < 0.0 {
        normal = normal.negate();
    }
    let towards = [body1.rotate_back(normal).negate(), body2.rotate_back(normal)];
    // In the normal cone of an edge the direction leaves both faces; the first two lanes are along the edge and vanish.
    let sine = sine_squared.sqrt();
    let slack = L::splat(-STRICT * if sine > 2.0 * STRICT { sine } else { 2.0 * STRICT });
    let values1 = plane_slopes(&record1.planes, towards[0]);
    let values2 = plane_slopes(&record2.planes, towards[1]);
    let across = L::upper_halves(values1, values2);
    if slack.greater(across) != 0 {
        let (_, lane) = across.least();
        return if lane < 2 {
            let face = if lane == 0 { record1.left } else { record1.right };
            walk_along_edge::<L, 1>(frame, indices, t, face, &record1.planes, lane + 2)
        } else {
            let face = if lane == 2 { record2.left } else { record2.right };
            walk_along_edge::<L, 0>(frame, indices, s, face, &record2.planes, lane)
        };
    }
    // Of g = RᵀU, |U| = sine, the part along the edge is the rounding of U and of the rotated unit directions, 12u; across it g
    // is in the cone up to its own rounding.
    let inverse = reciprocal_length(sine_squared);
    let misfit = 40.0 * UNIT_ROUNDOFF + 16.0 * UNIT_ROUNDOFF * inverse;
    let is_plain = L::splat(0.0).greater(across) == 0;
    let beyond = if is_plain {
        of_edge_in_cone(body1.polyhedron, record1, misfit) + of_edge_in_cone(body2.polyhedron, record2, misfit)
    } else {
        f64::INFINITY
    };
    let points = [
        L::from_vector(&along1).mul_add(L::splat(s), L::from_vector(tail1)),
        L::from_vector(&along2).mul_add(L::splat(t), L::from_vector(tail2)),
    ];
    let minimum = Minimum {
        points,
        rotated: [body1.rotate_lanes(points[0]), body2.rotate_lanes(points[1])],
        direction: normal,
        inverse,
        beyond,
        outside: edge_rounding(body1.polyhedron) + edge_rounding(body2.polyhedron),
        height: 0.0,
    };
    judge.certify(frame, State::edge_edge(indices), &minimum);
    Step::Minimum
}

/// Below this sin² of the angle between two edges their cross product of unit vectors (error 4u a component) has fewer than
/// two digits.
const PARALLEL: f64 = 1e-28;

/// The point at parameter `t` of body NEAR's edge lies over the face beside the other body's edge: walks along the edge, which
/// descends towards the face, until it ends or leaves the face's prism. `lane` (2 or 3) of the far edge's planes looks out of
/// the face.
#[inline(always)]
fn walk_along_edge<L: Lanes, const NEAR: usize>(
    frame: &Frame<L>,
    indices: [u32; 2],
    t: f64,
    face: u32,
    far_planes: &PlaneBlock,
    lane: usize,
) -> Step {
    let (body, far) = (&frame.bodies[NEAR], &frame.bodies[1 - NEAR]);
    let (edge, far_edge) = (indices[NEAR], indices[1 - NEAR]);
    let record = &body.polyhedron.edges[edge as usize];
    let along = edge_direction(&record.planes);
    let tail = &body.polyhedron.vertices[record.tail as usize].position;
    let point = far.rotate_back(body.rotate(&(tail + along * t)).add(body.offset));
    let direction = far.rotate_back(body.rotate(&along));
    // Into the face is away from the far edge.
    let forward = plane_slopes(far_planes, direction).to_array()[lane] <= 0.0;
    let end = if forward { record.head } else { record.tail };
    let face_record = &far.polyhedron.faces[face as usize];
    let values = plane_values(&face_record.planes, point);
    let [height, ..] = values.to_array();
    if height <= 0.0 {
        return behind::<NEAR>(far.polyhedron, end, face, &point.to_vector());
    }
    let end_position = &body.polyhedron.vertices[end as usize].position;
    let end_point = far.rotate_back(body.rotate(end_position).add(body.offset));
    let end_values = plane_values(&face_record.planes, end_point);
    let (fraction, side) =
        exit_of_prism(far.polyhedron, face_record, [point, end_point], [values, end_values], far_edge);
    let [end_height, ..] = end_values.to_array();
    if height + fraction * (end_height - height) <= 0.0 {
        return Step::Crossing(State::vertex_face(NEAR, end, face));
    }
    Step::Move(match side {
        Some(side) => {
            let side = far.polyhedron.sides[(face_record.first_side + side) as usize];
            State::edge_edge(if NEAR == 0 { [edge, side] } else { [side, edge] })
        }
        None => State::vertex_face(NEAR, end, face),
    })
}

/// A vertex, or a point near it, behind a face: jumps to the far body's support vertex towards the point.
#[inline(never)]
fn behind<const NEAR: usize>(far: &Polyhedron, vertex: u32, face: u32, point: &Vector) -> Step {
    let (support, _) = far.support(point, far.faces[face as usize].vertex);
    Step::Behind(State::vertex_vertex(if NEAR == 0 { [vertex, support] } else { [support, vertex] }))
}

/// A minimum from what the state has as near and far; `direction` is from the far body to the near one; the numbers are `inverse`,
/// `beyond`, `outside` and `height`.
#[inline(always)]
fn minimum_of<L: Lanes, const NEAR: usize>(
    [near_point, far_point]: [L; 2],
    [near_rotated, far_rotated]: [L; 2],
    direction: L,
    [inverse, beyond, outside, height]: [f64; 4],
) -> Minimum<L> {
    if NEAR == 0 {
        let (points, rotated) = ([near_point, far_point], [near_rotated, far_rotated]);
        Minimum { points, rotated, direction, inverse, beyond, outside, height }
    } else {
        let (points, rotated) = ([far_point, near_point], [far_rotated, near_rotated]);
        Minimum { points, rotated, direction: direction.negate(), inverse, beyond, outside, height }
    }
}

/// The index of body NEAR's feature and that of the other body's, in the order of the bodies.
#[inline(always)]
fn ordered<const NEAR: usize>(near: u32, far: u32) -> [u32; 2] {
    if NEAR == 0 { [near, far] } else { [far, near] }
}

/// δ of a vertex: 0 if all neighbours lie strictly behind; otherwise a closer look has to tell.
#[inline(always)]
fn beyond_vertex(test: VertexTest) -> f64 {
    if matches!(test, VertexTest::Strict) { 0.0 } else { f64::INFINITY }
}
