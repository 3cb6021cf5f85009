//! Walks of a vertex or a point along an edge over a face of the other body: to where it leaves the face's prism, to the edge's
//! end, or into the face.

use super::shortcuts::NEARLY_UNIT;
use super::step::{Step, Transition};
use crate::base::math::Vector;
use crate::base::simd::{Lanes, Work};
use crate::body::polyhedron::{NONE, PlaneBlock, Polyhedron, clear_slope};
use crate::placed::frame::{Body, Frame};
use crate::placed::state::{State, ordered};
use crate::placed::voronoi::{
    Corner, Rule, edge_direction, exit_of_prism, plane_slopes, plane_values, steepest, violated_side,
};

/// A vertex over a face descends along the edge `leaving` to the neighbour `head`, towards the face: to the edge's end, or to the
/// side of the prism where it leaves.
#[inline(always)]
pub(super) fn walk_over_face<L: Lanes, const NEAR: usize>(
    frame: &Frame<L>,
    vertex: u32,
    face: u32,
    [point, values]: [L; 2],
    [leaving, head]: [u32; 2],
) -> Step {
    let (body, far) = (&frame.bodies[NEAR], &frame.bodies[1 - NEAR]);
    // The far end of the edge, which need not be the neighbour: a vertex within the edge is a neighbour, too. From such a vertex
    // only the neighbour is guaranteed to be ahead, and from a flat vertex the edge may not lead there.
    let edge_at = |v: u32| body.polyhedron.vertices[v as usize].neighbours.edge[0];
    let (end, leaving) = match body.polyhedron.edges.get(leaving as usize) {
        Some(record) if record.tail() == vertex => (record.head(), leaving),
        Some(record) if record.head() == vertex => (record.tail(), leaving),
        Some(record) if edge_at(vertex) == leaving => {
            let is_along = record.tail() == head || record.head() == head || edge_at(head) == leaving;
            (head, if is_along { leaving } else { NONE })
        }
        _ => (head, NONE),
    };
    let end_position = &body.polyhedron.vertices[end as usize].position;
    let end_point = far.rotate_back(body.rotate(end_position).add(body.offset));
    let record = &far.polyhedron.faces[face as usize];
    let end_values = plane_values(&record.planes, end_point);
    let (fraction, side) = exit_of_prism(far.polyhedron, record, [point, end_point], [values, end_values], NONE);
    let ([height, ..], [end_height, ..]) = (values.to_array(), end_values.to_array());
    if height + fraction * (end_height - height) <= 0.0 {
        return Step::crossing(State::vertex_face(NEAR, vertex, face));
    }
    Step::to(match side {
        Some(side) if leaving != NONE => {
            let far_edge = far.polyhedron.side(record, side);
            State::edge_edge(ordered(NEAR, leaving, far_edge))
        }
        _ => State::vertex_face(NEAR, end, face),
    })
}

/// Faces of this many sides are wide enough for a vertex to descend over them by several edges. Each takes a step of marching,
/// and two searches among the sides.
pub(super) const WIDE_FACE: u32 = 8;

/// Edges of a descent; a longer one is gone down in several.
const LONGEST_DESCENT: usize = 64;

/// A vertex of a body over a wide face of the other body goes down the steepest edges, and not over the boundary.
// The bodies are copied: a reference to the frame would have it put into memory in every query (5 % of a coherent one).
pub(super) struct Descent<'a, L> {
    /// The vertex's body.
    near: Body<'a, L>,
    /// The face's body.
    far: Body<'a, L>,
    tolerance: f64,
    face: u32,
    /// Towards the face, as the vertex's body sees it; nearly unit.
    down: L,
    /// The vertex below it.
    next: u32,
}

impl<L: Lanes> Work for Descent<'_, L> {
    /// A lower vertex over the face, or [`NONE`] where bisection finds none.
    type Output = u32;

    #[inline(always)]
    fn run(&mut self) -> u32 {
        let mut way = [self.next; LONGEST_DESCENT];
        let last = self.descend(&mut way);
        // The lowest comes first: where the face is wider than the body it is over the face.
        let (mut found, mut low, mut high, mut probe) = (NONE, 0, last + 1, last);
        loop {
            if self.is_over_face(way[probe]) {
                found = way[probe];
                low = probe + 1;
            } else {
                high = probe;
            }
            if low >= high {
                return found;
            }
            probe = low + (high - low) / 2;
        }
    }
}

impl<'a, L: Lanes> Descent<'a, L> {
    #[inline(always)]
    pub(super) fn of<const NEAR: usize>(frame: &Frame<'a, L>, face: u32, down: L, next: u32) -> Descent<'a, L> {
        let (near, far) = (frame.bodies[NEAR], frame.bodies[1 - NEAR]);
        Descent { near, far, tolerance: frame.tolerance, face, down, next }
    }

    /// Writes the vertices of the way down behind the first and gives the place of the last. Hubs are not passed: to look at all
    /// of their neighbours takes longer than a step.
    #[inline(always)]
    fn descend(&self, way: &mut [u32; LONGEST_DESCENT]) -> usize {
        for last in 0..LONGEST_DESCENT - 1 {
            let Some(corner) = Corner::of(self.near.polyhedron, way[last]) else { return last };
            if corner.record.more > 1 {
                return last;
            }
            let (slope, edge, head) = steepest(corner, self.down);
            if !(slope > clear_slope(NEARLY_UNIT)) | (edge == NONE) {
                return last;
            }
            way[last + 1] = head;
        }
        LONGEST_DESCENT - 1
    }

    #[inline(always)]
    fn is_over_face(&self, vertex: u32) -> bool {
        let Descent { near, far, .. } = self;
        let face = &far.polyhedron.faces[self.face as usize];
        let position = &near.polyhedron.vertices[vertex as usize].position;
        let point = far.rotate_back(near.rotate(position).add(near.offset));
        let values = plane_values(&face.planes, point);
        let [height, ..] = values.to_array();
        (height > 0.0) && violated_side(Rule::Most, far.polyhedron, face, [point, values], self.tolerance).is_none()
    }
}

/// The point at parameter `t` of body NEAR's edge lies over the face beside the other body's edge: walks along the edge, which
/// descends towards the face, until it ends or leaves the face's prism. `lane` (2 or 3) of the far edge's planes looks out of
/// the face.
#[inline(always)]
pub(super) fn walk_along_edge<L: Lanes, const NEAR: usize>(
    frame: &Frame<L>,
    indices: [u32; 2],
    t: f64,
    face: u32,
    (far_planes, lane): (&PlaneBlock, usize),
) -> Step {
    let (body, far) = (&frame.bodies[NEAR], &frame.bodies[1 - NEAR]);
    let (edge, far_edge) = (indices[NEAR], indices[1 - NEAR]);
    let record = &body.polyhedron.edges[edge as usize];
    let along = edge_direction(&record.planes);
    let point = far.rotate_back(body.rotate(&(record.tail_position + along * t)).add(body.offset));
    let direction = far.rotate_back(body.rotate(&along));
    // Into the face is away from the far edge.
    let forward = plane_slopes(far_planes, direction).to_array()[lane] <= 0.0;
    let end = if forward { record.head() } else { record.tail() };
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
        return Step::crossing(State::vertex_face(NEAR, end, face));
    }
    Step::to(match side {
        Some(side) => {
            let side = far.polyhedron.side(face_record, side);
            State::edge_edge(ordered(NEAR, edge, side))
        }
        None => State::vertex_face(NEAR, end, face),
    })
}

/// A vertex, or a point near it, behind a face: jumps to the far body's support vertex towards the point.
#[inline(always)]
pub(super) fn behind<const NEAR: usize>(far: &Polyhedron, vertex: u32, face: u32, point: &Vector) -> Step {
    let support = support_towards(far, point, face);
    Step { transition: Transition::Behind, at: State::vertex_vertex(ordered(NEAR, vertex, support)) }
}

/// Out of line, with a number for an answer: a step would be handed back in memory, where then all steps would be made.
#[inline(never)]
fn support_towards(far: &Polyhedron, point: &Vector, face: u32) -> u32 {
    far.support(point, far.faces[face as usize].vertex).0
}
