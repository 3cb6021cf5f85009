//! The witness points of the nearest facet: points of both bodies, one over the other along the direction of least overlap.

use super::search::{Facet, FacetSearch, SUPPORT, TIE};
use crate::base::math::{UNIT_ROUNDOFF as U, Vector, clamp};
use crate::base::simd::Lanes;
use crate::body::polyhedron::{Edge, Polyhedron};
use crate::placed::state::FeatureId;

/// Points and the features that they are on. It is written in its place and not handed on: a copy would wait for its numbers (R1).
#[derive(Debug, Clone, Copy)]
pub struct FacetWitness {
    /// In centred coordinates: convex combinations of vertices.
    pub points: [Vector; 2],
    /// The same in world axes, relative to body 2's origin.
    world: [Vector; 2],
    /// The features that hold them.
    pub features: [FeatureId; 2],
}

impl FacetWitness {
    /// No points yet.
    pub const NONE: FacetWitness = FacetWitness {
        points: [Vector::new(0.0, 0.0, 0.0); 2],
        world: [Vector::new(0.0, 0.0, 0.0); 2],
        features: [FeatureId::Vertex(0); 2],
    };

    #[inline(always)]
    fn set(&mut self, body: usize, own: &Vector, world: &Vector, feature: FeatureId) {
        self.points[body] = *own;
        self.world[body] = *world;
        self.features[body] = feature;
    }
}

/// By how much the difference of the points may miss the overlap times the direction, over M.
const MISS: f64 = 64.0 * U;

/// The witness points of the best facet; whether rounding lets them be found.
#[inline(always)]
pub fn find<L: Lanes, const C: usize, const F: usize>(
    search: &FacetSearch<L, C, F>,
    direction: &Vector,
    overlap: f64,
    witness: &mut FacetWitness,
) -> bool {
    let is_found = match search.best.facet {
        Facet::Face(body, face) => {
            let outward = if body == 0 { *direction } else { -direction };
            WitnessSide { search, body, face, outward, overlap }.find(witness)
        }
        Facet::Edges(edges) => {
            on_edges(search, edges, witness);
            true
        }
    };
    let off = witness.world[0] - witness.world[1] - direction * overlap;
    // False for a NaN.
    is_found && off.norm() <= MISS * search.longest
}

/// The points of two edges that are over each other.
#[inline(always)]
fn on_edges<L: Lanes, const C: usize, const F: usize>(
    search: &FacetSearch<L, C, F>,
    edges: [u32; 2],
    witness: &mut FacetWitness,
) {
    let [body1, body2] = &search.frame.bodies;
    let [edge1, edge2] = edges;
    let (fan_edge1, fan_edge2) = (&search.fans[0].edges[edge1 as usize], &search.fans[1].edges[edge2 as usize]);
    let e = body1.rotate(&fan_edge1.direction).to_vector();
    let g = body2.rotate(&fan_edge2.direction).to_vector();
    let tail1 = search.placed[0].point(usize::from(fan_edge1.corners[0]));
    let tail2 = search.placed[1].point(usize::from(fan_edge2.corners[0]));
    let apart = tail1 - tail2;
    let (ee, eg, gg) = (e.norm_squared(), e.dot(&g), g.norm_squared());
    let (along_e, along_g) = (apart.dot(&e), apart.dot(&g));
    let square = e.cross(&g).norm_squared();
    let (s, t) = ((along_g * eg - along_e * gg) / square, (along_g * ee - along_e * eg) / square);
    let (record1, record2) = (&body1.polyhedron.edges[edge1 as usize], &body2.polyhedron.edges[edge2 as usize]);
    let (s, t) = (clamp(s, 0.0, record1.length), clamp(t, 0.0, record2.length));
    let own1 = record1.tail_position + fan_edge1.direction * s;
    let own2 = record2.tail_position + fan_edge2.direction * t;
    witness.set(0, &own1, &(tail1 + e * s), FeatureId::Edge(edge1));
    witness.set(1, &own2, &(tail2 + g * t), FeatureId::Edge(edge2));
}

/// A face of a body that the other is least deep below.
struct WitnessSide<'a, 'b, L, const C: usize, const F: usize> {
    search: &'a FacetSearch<'b, L, C, F>,
    body: usize,
    face: u32,
    /// The unit normal.
    outward: Vector,
    overlap: f64,
}

impl<L: Lanes, const C: usize, const F: usize> WitnessSide<'_, '_, L, C, F> {
    fn polyhedron(&self, body: usize) -> &Polyhedron {
        self.search.frame.bodies[body].polyhedron
    }

    /// A point on the face, and one of the other body below it: on one corner, on an edge, or on a face that is parallel. Whether
    /// there are such points.
    #[inline(always)]
    fn find(&self, witness: &mut FacetWitness) -> bool {
        let WitnessSide { search, body, outward, .. } = self;
        let other = 1 - body;
        let corners = &search.fans[other].corners;
        let least = search.placed[other].least::<L>(outward);
        let mut deepest = search.placed[other].at_most::<L>(outward, least + (TIE + SUPPORT) * search.longest);
        deepest &= u64::MAX >> (64 - corners.len());
        if deepest.count_ones() == 1 {
            let corner = deepest.trailing_zeros() as usize;
            let world = search.placed[other].point(corner);
            let vertex = search.fans[other].corners[corner];
            witness.set(other, self.own(other, corner), &world, FeatureId::Vertex(vertex));
            return self.on_face(*body, self.face, &self.above(&world), witness);
        }
        self.over_edge(deepest, witness) || self.over_face(witness)
    }

    /// Over a point of the other body.
    fn above(&self, point: &Vector) -> Vector {
        point + self.outward * self.overlap
    }

    /// A corner in the body's own coordinates.
    #[inline(always)]
    fn own(&self, body: usize, corner: usize) -> &Vector {
        let vertex = self.search.fans[body].corners[corner];
        &self.polyhedron(body).vertices[vertex as usize].position
    }

    /// The middle of the longest part of an edge between two deepest corners that is below the face.
    fn over_edge(&self, deepest: u64, witness: &mut FacetWitness) -> bool {
        let WitnessSide { search, body, .. } = self;
        let other = 1 - body;
        let mut best = (-SLIGHTLY, None);
        for (index, edge) in search.fans[other].edges.iter().enumerate() {
            if edge.corners.iter().all(|corner| deepest >> corner & 1 == 1) {
                let ends = edge.corners.map(|corner| search.placed[other].point(usize::from(corner)));
                let [from, to] = self.part_below(&ends);
                let length = (to - from) * (ends[1] - ends[0]).norm();
                if length > best.0 * search.longest {
                    best = (length / search.longest, Some((index, ends, clamp(0.5 * (from + to), 0.0, 1.0))));
                }
            }
        }
        let Some((index, ends, t)) = best.1 else { return false };
        let record = &self.polyhedron(other).edges[index];
        let own = record.tail_position + search.fans[other].edges[index].direction * (t * record.length);
        let world = ends[0] + (ends[1] - ends[0]) * t;
        witness.set(other, &own, &world, FeatureId::Edge(index as u32));
        self.on_face(*body, self.face, &self.above(&world), witness)
    }

    /// From where to where a segment is below the face; the wrong way round where it is not.
    fn part_below(&self, [tail, head]: &[Vector; 2]) -> [f64; 2] {
        let [mut from, mut to] = [0.0_f64, 1.0_f64];
        let polygon = WitnessPolygon::of(self.search, self.body, self.face);
        for side in 0..polygon.count() {
            let (a, b) = (polygon.corner(side), polygon.corner((side + 1) % polygon.count()));
            let inward = self.outward.cross(&(b - a));
            let [at_tail, at_head] = [inward.dot(&(tail - a)), inward.dot(&(head - a))];
            let rise = at_head - at_tail;
            if rise > 0.0 {
                from = from.max(-at_tail / rise);
            } else if rise < 0.0 {
                to = to.min(-at_tail / rise);
            } else if at_tail < 0.0 {
                to = f64::NEG_INFINITY;
            }
        }
        [from, to]
    }

    /// The middle of the face's corners, where all of it is over a face of the other body.
    fn over_face(&self, witness: &mut FacetWitness) -> bool {
        let WitnessSide { search, body, outward, .. } = self;
        let other = 1 - body;
        let against = |face: &usize| search.placed[other].normal(*face).dot(outward);
        let faces = 0..self.polyhedron(other).faces.len();
        let Some(below) = faces.reduce(|a, b| if against(&b) < against(&a) { b } else { a }) else { return false };
        let polygon = WitnessPolygon::of(search, *body, self.face);
        let share = 1.0 / polygon.count() as f64;
        let [mut own, mut world] = [Vector::zeros(); 2];
        for side in 0..polygon.count() {
            let corner = polygon.place(side);
            (own, world) = (own + self.own(*body, corner) * share, world + search.placed[*body].point(corner) * share);
        }
        witness.set(*body, &own, &world, FeatureId::Face(self.face));
        self.on_face(other, below as u32, &(world - outward * self.overlap), witness)
    }

    /// The point of a face nearest to one over it, about: in the triangle of a fan around its first corner. Whether there is one.
    fn on_face(&self, body: usize, face: u32, point: &Vector, witness: &mut FacetWitness) -> bool {
        let polygon = WitnessPolygon::of(self.search, body, face);
        let normal = self.search.placed[body].normal(face as usize);
        let first = polygon.corner(0);
        let towards = point - first;
        let side = |corner: usize| normal.dot(&(polygon.corner(corner) - first).cross(&towards));
        let last = (2..polygon.count() - 1).take_while(|corner| side(*corner) >= 0.0).last().unwrap_or(1);
        let (p, q) = (polygon.corner(last) - first, polygon.corner(last + 1) - first);
        let area = normal.dot(&p.cross(&q));
        let weight = |area_of_part: f64| clamp(area_of_part / area, 0.0, 1.0);
        let (of_p, of_q) = (weight(normal.dot(&towards.cross(&q))), weight(normal.dot(&p.cross(&towards))));
        let sum = (of_p + of_q).max(1.0);
        let weights = [(0, 1.0 - (of_p + of_q) / sum), (last, of_p / sum), (last + 1, of_q / sum)];
        let [mut own, mut world] = [Vector::zeros(); 2];
        for (corner, weight) in weights {
            let corner = polygon.place(corner);
            let placed = self.search.placed[body].point(corner);
            (own, world) = (own + self.own(body, corner) * weight, world + placed * weight);
        }
        witness.set(body, &own, &world, FeatureId::Face(face));
        area > 0.0
    }
}

/// A segment that misses a polygon by less than this, over M, touches it.
const SLIGHTLY: f64 = 64.0 * U;

/// The corners of a placed face, counter-clockwise.
struct WitnessPolygon<'a, 'b, L, const C: usize, const F: usize> {
    search: &'a FacetSearch<'b, L, C, F>,
    body: usize,
    face: u32,
}

impl<'a, 'b, L: Lanes, const C: usize, const F: usize> WitnessPolygon<'a, 'b, L, C, F> {
    fn of(search: &'a FacetSearch<'b, L, C, F>, body: usize, face: u32) -> Self {
        WitnessPolygon { search, body, face }
    }

    fn count(&self) -> usize {
        self.search.frame.bodies[self.body].polyhedron.faces[self.face as usize].side_count as usize
    }

    /// The place of a corner in the fan.
    fn place(&self, side: usize) -> usize {
        let polyhedron = self.search.frame.bodies[self.body].polyhedron;
        let index = polyhedron.side(&polyhedron.faces[self.face as usize], side as u32) as usize;
        let edge: &Edge = &polyhedron.edges[index];
        let [tail, head] = self.search.fans[self.body].edges[index].corners;
        usize::from(if edge.left() == self.face { tail } else { head })
    }

    fn corner(&self, side: usize) -> Vector {
        self.search.placed[self.body].point(self.place(side))
    }
}
