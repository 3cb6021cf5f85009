//! A face of one body over the lowest vertex of the other.

use super::facet::{
    Disc, GiftWrap, NextFacet, Proved, encloses, is_good, least_inside, lowest, lowest_in_blocks, middle, most_across,
    on_face, rounding, shortest_of_unit, side_of,
};
use super::wide_disc::WideDisc;
use crate::base::simd::{Lanes, Work};
use crate::body::polyhedron::NONE;
use crate::depth::facets::search::Facet;
use crate::placed::frame::Frame;
use crate::placed::state::FeatureId;

/// A face of large bodies or of skewed ones.
pub struct AtFace<'a, L> {
    pub frame: &'a Frame<'a, L>,
    pub body: usize,
    pub face: u32,
}

impl<L: Lanes> Work for AtFace<'_, L> {
    type Output = Result<Proved<L>, NextFacet>;

    #[inline(always)]
    fn run(&mut self) -> Self::Output {
        look_at_face::<L, false>(self.frame, self.body, self.face)
    }
}

/// A face of a body over the other's lowest vertex. `PLAIN`: of small bodies in rigid poses.
#[inline(always)]
pub fn look_at_face<L: Lanes, const PLAIN: bool>(
    frame: &Frame<L>,
    body: usize,
    face: u32,
) -> Result<Proved<L>, NextFacet> {
    let (own, other) = (&frame.bodies[body], &frame.bodies[1 - body]);
    let Some(record) = own.polyhedron.faces.get(face as usize) else { return Err(NextFacet::Nothing) };
    let normal = L::from_vector(&record.normal);
    let turned = if PLAIN { own.rotate_lanes(normal) } else { own.lift(normal) };
    // Of unit length up to 3u: 1/√(1 + x) is 1 − x/2 for an x of 44u, as of rigid poses.
    let square = turned.dot(turned);
    let scale = if PLAIN || frame.rigid { 1.5 - 0.5 * square } else { 1.0 / square.sqrt() };
    let m = turned.mul(L::splat(scale));
    let down = other.rotate_back(m);
    let (height, vertex, excess) = if PLAIN {
        let (height, vertex) = lowest_in_blocks(other.polyhedron, down);
        (height, vertex, 0.0)
    } else {
        lowest(other.polyhedron, down, None)
    };
    let depth = m.dot(own.offset) - scale * record.planes.offset[0] - height;
    let error = rounding(frame, own.polyhedron, other.polyhedron);
    // |RᵀR⁻ᵀn| is 1.
    let slack = if PLAIN { record.slack } else { record.slack * scale };
    let (lower, upper) = (depth - slack - error, depth + slack + error + excess);
    if !is_good(frame, lower, upper) {
        return Err(NextFacet::Nothing);
    }
    let deepest = &other.polyhedron.vertices[vertex as usize].position;
    let below = other.rotate(deepest).sub(own.offset);
    let mut below = if PLAIN { own.rotate_back(below) } else { own.turn_back(below) };
    if !(PLAIN || frame.rigid) {
        // On the face, in the direction of m.
        let along = own.turn_back(m);
        let height = (normal.dot(below) + record.planes.offset[0]) / normal.dot(along);
        below = along.negated_mul_add(L::splat(height), below);
    }
    // Sides and their offsets are right to some 10u of 3ρ, the place to less than twice `error`.
    let (inside, side) = least_inside(own.polyhedron, record, below);
    // A foot on a side, rounding apart, is under faces that are parallel, or never far from the next facet.
    if !(inside > -error) {
        let (edge, away) = side_of(own, record, side);
        return Err(L::out_of_line(&mut GiftWrap { frame, body, edge, vertex, m, away, from: [face, NONE] }));
    }
    let around = middle(frame, own, other, m, error);
    let small = Disc { radius: (inside - 2.0 * error) * shortest_of_unit(frame), lower };
    let facet = Facet::Face(body, face);
    let lower = if encloses(small.radius, around, upper) {
        lower
    } else {
        let (patch, _) = most_across(other.polyhedron, vertex, other.rotate_back(m).negate());
        let (edge, away) = side_of(own, record, side);
        let wrap = GiftWrap { frame, body, edge, vertex, m, away, from: [face, NONE] };
        match L::out_of_line(&mut WideDisc { wrap, facet, faces: [face, patch], error, small, upper, around }) {
            Some(lower) => lower,
            None => return Err(NextFacet::Nothing),
        }
    };
    let (mut points, mut features) =
        ([on_face(record, below), L::from_vector(deepest)], [FeatureId::Face(face), FeatureId::Vertex(vertex)]);
    let mut direction = m;
    if body == 1 {
        (points, features, direction) = ([points[1], points[0]], [features[1], features[0]], m.negate());
    }
    Ok(Proved { lower, upper, depth, direction, points, features, facet, steps: 0 })
}
