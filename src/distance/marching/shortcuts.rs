//! Short cuts: where the tests of a state determine more than the next feature of one body, the states between are left out. That
//! saves a tenth of them and more where a motion passes several features.
//!
//! They only propose, as all marching does. If a state is left out, some test of it would have led on, or its features are parts
//! of those that marching goes on with, from which it comes back to them; the cycle detection catches any remaining cycle.

use crate::base::simd::Lanes;
use crate::body::polyhedron::{MergedFace, NONE, Polyhedron, clear_slope};
use crate::distance::certificate::Certify;
use crate::placed::frame::Frame;
use crate::placed::state::{State, ordered};
use crate::placed::voronoi::{Corner, Rule, STRICT, plane_values, steepest};

/// An upper bound of the length of a vector that is unit up to 1 %.
pub(super) const NEARLY_UNIT: f64 = 1.02;

/// An edge along which to leave a vertex.
struct Leaving {
    edge: u32,
    /// The neighbour.
    head: u32,
    /// How far along the edge the nearest point on its line is.
    parameter: f32,
}

/// The edge along which a vertex rises most steeply in direction g, whose length is at most `length`, if it clearly rises, and by
/// more than a tolerance. A vertex with many neighbours is not asked: to look at all of them in every state that a march over the
/// other body visits takes longer than the states that it saves.
#[inline(always)]
fn leaving<L: Lanes>(corner: Corner, g: L, length: f64, tolerance: f64) -> Option<Leaving> {
    if corner.record.more > 1 {
        return None;
    }
    let (parameter, edge, head) = steepest(corner, g);
    let rises = (parameter > clear_slope(length)) & (f64::from(parameter) > tolerance);
    (rises & (edge != NONE)).then_some(Leaving { edge, head, parameter })
}

/// Whether the nearest point on the line of an edge, `parameter` from where it begins, is beyond its other end, so that the
/// neighbour there, mostly that end, is the next feature, not the edge; or whether there is no edge, only the neighbour.
#[inline(always)]
pub(super) fn is_passed<L: Lanes, C: Certify<L>>(polyhedron: &Polyhedron, edge: u32, parameter: f32) -> bool {
    match polyhedron.edges.get(edge as usize) {
        Some(edge) => (C::RULE == Rule::Most) & (f64::from(parameter) >= edge.length),
        None => true,
    }
}

/// A vertex lies beyond an end of the far body's edge: where it leaves towards that end, both features change in one step, as
/// between two vertices (Ehmann & Lin 2000, §5.1).
#[inline(always)]
pub(super) fn past_the_end<L: Lanes, C: Certify<L>, const NEAR: usize>(
    frame: &Frame<L>,
    corner: Corner,
    rotated: L,
    end: u32,
) -> Option<State> {
    if C::RULE == Rule::First {
        return None;
    }
    let (body, far) = (&frame.bodies[NEAR], &frame.bodies[1 - NEAR]);
    let end_position = &far.polyhedron.vertices[end as usize].position;
    let direction = rotated.add(body.offset).sub(far.rotate(end_position));
    let towards_far = body.rotate_back(direction).negate();
    let Leaving { edge, head, parameter } = leaving(corner, towards_far, direction.norm1(), frame.tolerance)?;
    Some(if is_passed::<L, C>(body.polyhedron, edge, parameter) {
        State::vertex_vertex(ordered(NEAR, head, end))
    } else {
        State::vertex_edge(1 - NEAR, end, edge)
    })
}

/// A vertex lies off a side of the far body's face. If it leaves towards the face's plane, the edge along which it does and the
/// side are next; where it lies off the side's own region, what lies across that.
#[inline(always)]
pub(super) fn over_another_feature<L: Lanes, C: Certify<L>, const NEAR: usize>(
    frame: &Frame<L>,
    corner: Corner,
    face: &MergedFace,
    side: u32,
    [point, values]: [L; 2],
) -> Option<State> {
    if C::RULE == Rule::First {
        return None;
    }
    let (body, far) = (&frame.bodies[NEAR], &frame.bodies[1 - NEAR]);
    let [height, ..] = values.to_array();
    if height > 0.0 {
        let towards_far = body.rotate_back(far.lift(L::from_vector(&face.normal))).negate();
        if let Some(Leaving { edge, .. }) = leaving(corner, towards_far, NEARLY_UNIT, STRICT) {
            return Some(State::edge_edge(ordered(NEAR, edge, side)));
        }
    }
    let record = &far.polyhedron.edges[side as usize];
    let values = plane_values(&record.planes, point);
    let least = L::splat(-frame.tolerance);
    // No closure (R2).
    if least.greater(values) == 0 {
        return None;
    }
    let lane = Rule::Most.violated(values, least);
    Some(State::across_edge(NEAR, corner.index, lane, record.across[lane & 3]))
}
