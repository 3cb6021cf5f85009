//! A facet that is the parallelogram of two edges.

use super::facet::{Disc, GiftWrap, NextFacet, Proved, encloses, is_good, lowest, middle, rounding};
use super::wide_disc::WideDisc;
use crate::base::math::Vector;
use crate::base::simd::{Lanes, Work};
use crate::body::polyhedron::NONE;
use crate::depth::facets::search::Facet;
use crate::placed::frame::Frame;
use crate::placed::state::FeatureId;

/// The sine's square above which two edges have a facet: the normal's direction errs by 8u over the sine, and the height with it.
const LEAST_SQUARE: f64 = 1e-6;

/// A share of the way from one point to another.
#[inline(always)]
fn part_of<L: Lanes>([tail, head]: [&Vector; 2], share: f64) -> L {
    let tail = L::from_vector(tail);
    L::from_vector(head).sub(tail).mul_add(L::splat(share), tail)
}

/// A facet that is the parallelogram of two edges.
pub struct AtEdges<'a, L> {
    pub frame: &'a Frame<'a, L>,
    pub edges: [u32; 2],
}

impl<L: Lanes> Work for AtEdges<'_, L> {
    type Output = Result<Proved<L>, NextFacet>;

    #[inline(always)]
    fn run(&mut self) -> Self::Output {
        let AtEdges { frame, edges } = *self;
        let [body1, body2] = &frame.bodies;
        let [polyhedron1, polyhedron2] = frame.polyhedra();
        let (Some(edge1), Some(edge2)) =
            (polyhedron1.edges.get(edges[0] as usize), polyhedron2.edges.get(edges[1] as usize))
        else {
            return Err(NextFacet::Nothing);
        };
        let ends = [
            [&edge1.tail_position, &polyhedron1.vertices[edge1.head() as usize].position],
            [&edge2.tail_position, &polyhedron2.vertices[edge2.head() as usize].position],
        ];
        // From body 1's origin, in world axes.
        let [a, b] = [body1.rotate(ends[0][0]), body1.rotate(ends[0][1])];
        let [c, d] = [body2.rotate(ends[1][0]).sub(body1.offset), body2.rotate(ends[1][1]).sub(body1.offset)];
        let (e, g) = (b.sub(a), d.sub(c));
        let across = e.cross(g);
        let [square, of_e, of_g] = [across.dot(across), e.dot(e), g.dot(g)];
        if !(square > LEAST_SQUARE * of_e * of_g) {
            return Err(self.beside(across));
        }
        let unit = across.mul(L::splat(1.0 / square.sqrt()));
        let start = a.sub(c);
        let m = if unit.dot(start) < 0.0 { unit.negate() } else { unit };
        let (top, _, above) = lowest(polyhedron1, body1.rotate_back(m).negate(), Some(edge1.tail()));
        let (bottom, _, below) = lowest(polyhedron2, body2.rotate_back(m), Some(edge2.tail()));
        let error = rounding(frame, polyhedron1, polyhedron2);
        // C reaches as high, and the corners of the parallelogram are as high.
        let upper = m.dot(body1.offset) - top - bottom + above + below + error;
        let heights = [m.dot(a), m.dot(b), m.dot(c), m.dot(d)];
        let mut lower = heights[0].min(heights[1]) - heights[2].max(heights[3]) - error;
        if !is_good(frame, lower, upper) {
            return Err(self.beside(m));
        }
        // How far the origin's foot is from the lines along e through both ends of g, and along g through both ends of e.
        let (beside_e, beside_g) = (m.cross(e), m.cross(g));
        let (per_e, per_g) = (1.0 / of_e.sqrt(), 1.0 / of_g.sqrt());
        let along_e = [beside_e.dot(start) * per_e, beside_e.dot(start.sub(g)) * per_e];
        let along_g = [beside_g.dot(start) * per_g, beside_g.dot(start.add(e)) * per_g];
        let sign_e = if along_e[0] > along_e[1] { 1.0 } else { -1.0 };
        let sign_g = if along_g[0] > along_g[1] { 1.0 } else { -1.0 };
        let inside = [sign_e * along_e[0], -sign_e * along_e[1], sign_g * along_g[0], -sign_g * along_g[1]];
        let mut side = 0;
        for other in 1..4 {
            side = if inside[other] < inside[side] { other } else { side };
        }
        if !(inside[side] > 0.0) {
            return Err(L::out_of_line(&mut self.beyond(side, m, [e, g])));
        }
        let around = middle(frame, body1, body2, m, error);
        let small = Disc { radius: inside[side] - 4.0 * error, lower };
        if !encloses(small.radius, around, upper) {
            let wrap = self.beyond(side, m, [e, g]);
            let faces =
                [self.face_most_across(wrap.body, wrap.m), self.face_most_across(1 - wrap.body, wrap.m.negate())];
            let facet = Facet::Edges(edges);
            match L::out_of_line(&mut WideDisc { wrap, facet, faces, error, small, upper, around }) {
                Some(proved) => lower = proved,
                None => return Err(NextFacet::Nothing),
            }
        }
        // a + s·e is over c + t·g along m.
        let (per, between) = (1.0 / across.dot(m), c.sub(a));
        let (s, t) = (between.cross(g).dot(m) * per, between.cross(e).dot(m) * per);
        let points = [part_of(ends[0], s), part_of(ends[1], t)];
        let (depth, features) = (0.5 * (lower + upper), [FeatureId::Edge(edges[0]), FeatureId::Edge(edges[1])]);
        Ok(Proved { lower, upper, depth, direction: m, points, features, facet: Facet::Edges(edges), steps: 0 })
    }
}

impl<L: Lanes> AtEdges<'_, L> {
    /// The face beside a body's edge whose normal is most along a direction.
    #[inline(always)]
    fn face_most_across(&self, body: usize, direction: L) -> u32 {
        let placed = &self.frame.bodies[body];
        let record = &placed.polyhedron.edges[self.edges[body] as usize];
        let along = placed.rotate_back(direction);
        let [left, right] = &record.normals;
        let is_left = along.dot(L::from_vector(left)) >= along.dot(L::from_vector(right));
        if is_left { record.left() } else { record.right() }
    }

    /// Where the edges have no facet any more: of the faces beside them that which is most across a direction.
    #[inline(always)]
    fn beside(&self, direction: L) -> NextFacet {
        let (mut most, mut best) = (0.0, NextFacet::Nothing);
        for (body, edge) in self.edges.into_iter().enumerate() {
            let placed = &self.frame.bodies[body];
            let record = &placed.polyhedron.edges[edge as usize];
            let along = placed.rotate_back(direction);
            let per = 1.0 / direction.dot(direction).sqrt();
            for (face, normal) in [record.left(), record.right()].into_iter().zip(&record.normals) {
                let cosine = (along.dot(L::from_vector(normal)) * per).abs();
                if cosine > most {
                    (most, best) = (cosine, NextFacet::Facet(Facet::Face(body, face)));
                }
            }
        }
        best
    }

    /// To the facet beyond a side of the parallelogram: along e at the tail or the head of g, or along g at the tail or the head
    /// of e.
    #[inline(always)]
    fn beyond(&self, side: usize, m: L, [e, g]: [L; 2]) -> GiftWrap<'_, L> {
        let AtEdges { frame, edges: [edge1, edge2] } = *self;
        let ends = |body: usize, edge: u32| {
            let record = &frame.bodies[body].polyhedron.edges[edge as usize];
            [record.tail(), record.head()]
        };
        let (body, edge, vertex, normal, along, out, other) = if side < 2 {
            // C is a − c along −g.
            let out = if side == 0 { g } else { g.negate() };
            (0, edge1, ends(1, edge2)[side], m, e, out, edge2)
        } else {
            let out = if side == 2 { e } else { e.negate() };
            (1, edge2, ends(0, edge1)[side - 2], m.negate(), g, out, edge1)
        };
        let across = m.cross(along);
        let away = if across.dot(out) < 0.0 { across.negate() } else { across };
        let away = away.mul(L::splat(1.0 / away.dot(away).sqrt()));
        GiftWrap { frame, body, edge, vertex, m: normal, away, from: [NONE, other] }
    }
}
