//! What looks at facets have in common: their proof, bounds of the bodies along a facet's normal, and the way to the next facet.

use crate::base::math::{UNIT_ROUNDOFF as U, Vector};
use crate::base::simd::{Lanes, Work};
use crate::body::polyhedron::{MergedFace, NONE, Polyhedron};
use crate::depth::facets::search::Facet;
use crate::depth::polytope::farthest;
use crate::placed::frame::{Body, Frame};
use crate::placed::state::FeatureId;

/// A depth that a facet proves.
#[derive(Clone, Copy)]
pub struct Proved<L> {
    /// The depth is at least this, more than 0 …
    pub lower: f64,
    /// … and at most this.
    pub upper: f64,
    /// The overlap of the witness points, in between.
    pub depth: f64,
    /// The unit vector, from the inside of C to the boundary, along which the bodies overlap least.
    pub direction: L,
    /// The witness points in centred coordinates.
    pub points: [L; 2],
    /// The features that hold them.
    pub features: [FeatureId; 2],
    /// The facet.
    pub facet: Facet,
    /// Facets walked over.
    pub steps: u32,
}

/// How wide an interval may be over the pair's size or distance: a little less than is promised.
const WIDEST: f64 = 176.0 * U;

/// Lengths that decide nothing but whether the lemma's condition holds are right to far less than this part of themselves.
pub const SURELY: f64 = 1e-9;

/// The result of a look at one facet that proves nothing.
pub enum NextFacet {
    /// The foot is beyond a side of it: the facet there.
    Facet(Facet),
    Nothing,
}

/// By how much the heights of a facet and of the bodies along its normal, of unit length, may be off; also what is taken off
/// lengths across it, twice.
///
/// A face with the stored normal n of a body with the radius ρ is at n·v = −`offset`, up to σ and 4uρ (the heights that `offset` is
/// the middle of err by 3u). In the world m = s·R·n as computed is off by 6.3u, and n·v = (RᵀR·n)·v up to 29u (`RIGID_DEFECT`),
/// with s·`offset` 40.3uρ. Of a skewed R the vector is R⁻ᵀ·n by cofactors, 11u, their determinant 10u, and s 6u: less. The other
/// body's heights take 5.3u for Rᵀm and 3u for the product: 8.3u of its radius. Δ is right to 2u|Δ|, its product to 3u; the sums to
/// 3u of all. m's length is 1 up to 5u, times the depth, at most an eighth of all: u. So 45u, 15u and 11u. With edges m is any
/// vector, of a length right to 5u, and all of these are less.
#[inline(always)]
pub fn rounding<L>(frame: &Frame<L>, own: &Polyhedron, other: &Polyhedron) -> f64 {
    U * (45.0 * own.radius + 15.0 * other.radius + 11.0 * frame.separation)
}

/// The deepest depth that is proved, over size and distance.
const SHALLOW: f64 = 0.125;

/// Whether an interval is above 0, narrow and shallow; not of a NaN.
#[inline(always)]
pub fn is_good<L>(frame: &Frame<L>, lower: f64, upper: f64) -> bool {
    let scale = if frame.separation > frame.size { frame.separation } else { frame.size };
    lower > 0.0 && upper - lower <= WIDEST * scale && upper <= SHALLOW * (frame.size + frame.separation)
}

/// How many times as short a length may become that a skewed R places: ‖RᵀR − I‖ is at most 0.03.
const SHORTENED: f64 = 0.98;

/// A vertex that is about the lowest along a direction in the body's axes, its height, and by how much the body may be lower;
/// climbed to from another where there are many.
#[inline(always)]
pub fn lowest<L: Lanes>(polyhedron: &Polyhedron, along: L, start: Option<u32>) -> (f64, u32, f64) {
    if polyhedron.vertex_blocks.is_empty() {
        return L::out_of_line(&mut LowestOfMany { polyhedron, along, start });
    }
    let (height, vertex) = lowest_in_blocks(polyhedron, along);
    (height, vertex, 0.0)
}

/// The lowest vertex of a body that has them in blocks, and its height.
#[inline(always)]
pub fn lowest_in_blocks<L: Lanes>(polyhedron: &Polyhedron, along: L) -> (f64, u32) {
    let [x, y, z] = [along.splat_x(), along.splat_y(), along.splat_z()];
    let (mut least, mut place) = (L::splat(f64::INFINITY), L::splat(0.0));
    let (mut at, four) = (L::splat(0.0), L::splat(4.0));
    for block in &polyhedron.vertex_blocks {
        let height = x.mul_add(L::load(&block.x), y.mul_add(L::load(&block.y), z.mul(L::load(&block.z))));
        place = at.where_greater(least, height, place);
        least = least.min(height);
        at = at.add(four);
    }
    let (height, lane) = least.least();
    let vertex = place.to_array()[lane & 3] as usize + lane;
    (height, vertex.min(polyhedron.vertices.len() - 1) as u32)
}

struct LowestOfMany<'a, L> {
    polyhedron: &'a Polyhedron,
    along: L,
    start: Option<u32>,
}

impl<L: Lanes> Work for LowestOfMany<'_, L> {
    type Output = (f64, u32, f64);

    #[inline(always)]
    fn run(&mut self) -> Self::Output {
        let LowestOfMany { polyhedron, along, start } = *self;
        let (vertex, excess) = farthest(polyhedron, along.negate(), start);
        let height = along.dot(L::from_vector(&polyhedron.vertices[vertex as usize].position));
        (height, vertex, excess * (1.0 + 64.0 * U))
    }
}

/// Whether the lemma's condition holds: of a disc of radius `r` at heights up to `top`, and a point `h` below the origin, `a`
/// aside.
#[inline(always)]
pub fn encloses(r: f64, [h, a]: [f64; 2], top: f64) -> bool {
    let (arm, rise) = (r + a, h + top);
    let over = r * h - a * top;
    r > 0.0 && h > 0.0 && over > 0.0 && over * over * (1.0 - SURELY) >= top * top * (arm * arm + rise * rise)
}

/// How deep below the origin the middles of both bodies are along a direction, and how far aside. Each middle is a convex
/// combination of vertices, right to (2 + count)·uρ: each of its sums errs by u of itself.
#[inline(always)]
pub fn middle<L: Lanes>(frame: &Frame<L>, own: &Body<L>, other: &Body<L>, m: L, error: f64) -> [f64; 2] {
    let (middle1, middle2) = (&own.polyhedron.outlines.middle, &other.polyhedron.outlines.middle);
    let apart = own.rotate(middle1).sub(other.rotate(middle2)).add(own.offset);
    let height = m.dot(apart);
    let aside = m.negated_mul_add(L::splat(height), apart);
    let count = own.polyhedron.vertices.len() + other.polyhedron.vertices.len();
    let off = 2.0 * error + (8 + count) as f64 * U * frame.size;
    [-height - off, aside.dot(aside).sqrt() + off]
}

/// A disc of C around the origin's foot, across a direction up to what its lowest place is lower.
#[derive(Clone, Copy)]
pub struct Disc {
    pub radius: f64,
    /// No place of it is lower along the direction.
    pub lower: f64,
}

/// The face at a vertex whose normal is most along a direction in the body's axes, and the cosine.
#[inline(always)]
pub fn most_across<L: Lanes>(polyhedron: &Polyhedron, vertex: u32, along: L) -> (u32, f64) {
    let (mut best, mut most) = (0, f64::NEG_INFINITY);
    for block in polyhedron.neighbour_blocks(vertex) {
        // No closures: the compiler may leave them without the vector unit's instructions (R2).
        for edge in block.edge {
            if edge == NONE {
                continue;
            }
            let edge = &polyhedron.edges[edge as usize];
            // Around the vertex each face comes with one edge as its left one.
            let at = usize::from(edge.tail() != vertex);
            let cosine = L::from_vector(&edge.normals[at]).dot(along);
            if cosine > most {
                (best, most) = ([edge.left(), edge.right()][at], cosine);
            }
        }
    }
    (best, most)
}

/// How long a vector of length 1 is at least that is placed.
#[inline(always)]
pub fn shortest_of_unit<L>(frame: &Frame<L>) -> f64 {
    if frame.rigid { 1.0 } else { SHORTENED }
}

/// Gift wrapping: the facet across the side that an edge of a body and a vertex of the other make.
pub struct GiftWrap<'a, L> {
    pub frame: &'a Frame<'a, L>,
    /// The one with the edge.
    pub body: usize,
    pub edge: u32,
    pub vertex: u32,
    /// The normal of the facet, out of this body.
    pub m: L,
    /// In its plane, away from it.
    pub away: L,
    /// The face of this body and the edge of the other that the facet is of.
    pub from: [u32; 2],
}

impl<L: Lanes> Work for GiftWrap<'_, L> {
    type Output = NextFacet;

    #[inline(always)]
    fn run(&mut self) -> NextFacet {
        self.next()
    }
}

impl<L: Lanes> GiftWrap<'_, L> {
    /// The plane of the facet turns around the side: what it meets after the least angle is the next.
    #[inline(always)]
    pub fn next(&self) -> NextFacet {
        let GiftWrap { frame, body, edge, vertex, m, away, from } = *self;
        let (own, other) = (&frame.bodies[body], &frame.bodies[1 - body]);
        let record = &own.polyhedron.edges[edge as usize];
        // Next to a half turn.
        let (mut best, mut found) = ([-1.0, f64::MIN_POSITIVE], NextFacet::Nothing);
        for (face, normal) in [record.left(), record.right()].into_iter().zip(&record.normals) {
            let normal = own.rotate(normal);
            let angle = [normal.dot(m), normal.dot(away)];
            if face != from[0] && angle[1] > 0.0 && comes_before(angle, best) {
                (best, found) = (angle, NextFacet::Facet(Facet::Face(body, face)));
            }
        }
        let (down, across) = (other.rotate_back(m), other.rotate_back(away));
        let place = L::from_vector(&other.polyhedron.vertices[vertex as usize].position);
        for block in other.polyhedron.neighbour_blocks(vertex) {
            for (head, turned) in block.head.into_iter().zip(block.edge) {
                if turned == NONE || turned == from[1] {
                    continue;
                }
                let to = L::from_vector(&other.polyhedron.vertices[head as usize].position).sub(place);
                // No vertex is lower, rounding apart.
                let angle = [-to.dot(across), to.dot(down).max(0.0)];
                if comes_before(angle, best) {
                    let edges = if body == 0 { [edge, turned] } else { [turned, edge] };
                    (best, found) = (angle, NextFacet::Facet(Facet::Edges(edges)));
                }
            }
        }
        found
    }
}

/// Whether one angle from 0 to a half turn is less than another, by their cosines and sines up to a factor.
#[inline(always)]
fn comes_before([x, y]: [f64; 2], [other_x, other_y]: [f64; 2]) -> bool {
    x * other_y - y * other_x > 0.0
}

/// The foot of a point on a face's plane.
#[inline(always)]
pub fn on_face<L: Lanes>(face: &MergedFace, point: L) -> L {
    let normal = L::from_vector(&face.normal);
    normal.negated_mul_add(L::splat(normal.dot(point) + face.planes.offset[0]), point)
}

/// How far a place is inside the nearest side of a face, and which that is.
#[inline(always)]
pub fn least_inside<L: Lanes>(polyhedron: &Polyhedron, face: &MergedFace, place: L) -> (f64, usize) {
    let [x, y, z] = [place.splat_x(), place.splat_y(), place.splat_z()];
    let planes = &face.planes;
    let value = x.mul_add(
        L::load(&planes.x),
        y.mul_add(L::load(&planes.y), z.mul_add(L::load(&planes.z), L::load(&planes.offset))),
    );
    let (mut least, mut first) = (value.with_first(L::splat(f64::INFINITY)), L::splat(-1.0));
    let (mut at, four) = (L::splat(3.0), L::splat(4.0));
    for planes in polyhedron.further_sides(face) {
        let value = x.mul_add(
            L::load(&planes.x),
            y.mul_add(L::load(&planes.y), z.mul_add(L::load(&planes.z), L::load(&planes.offset))),
        );
        first = at.where_greater(least, value, first);
        least = least.min(value);
        at = at.add(four);
    }
    let (inside, lane) = least.least();
    (inside, (first.to_array()[lane & 3] + lane as f64) as usize)
}

/// The edge at a side of a face, and the direction in the plane of the face away from it.
#[inline(always)]
pub fn side_of<L: Lanes>(body: &Body<L>, face: &MergedFace, side: usize) -> (u32, L) {
    let side = side.min(face.side_count as usize - 1);
    let [x, y, z, _] = body.polyhedron.side_plane(face, side);
    (body.polyhedron.side(face, side as u32), body.rotate(&Vector::new(x, y, z)).negate())
}
