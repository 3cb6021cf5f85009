//! Where the nearest facet is: points of both bodies, one over the other along the direction of least overlap.

use super::search::{Facet, SUPPORT, Search, TIE};
use crate::base::math::{UNIT_ROUNDOFF as U, Vector, clamp};
use crate::base::simd::Lanes;
use crate::polyhedron::{Edge, Polyhedron};
use crate::solve::state::FeatureId;

/// Points and the features that they are on.
#[derive(Debug, Clone, Copy)]
pub struct Witness {
    /// In centred coordinates: convex combinations of vertices.
    pub points: [Vector; 2],
    /// What holds them.
    pub features: [FeatureId; 2],
}

/// By how much the difference of the points may miss the overlap times the direction, over M.
const MISS: f64 = 64.0 * U;

/// A point of a body: in its centred coordinates and in the world.
#[derive(Clone, Copy)]
struct WitnessPoint {
    own: Vector,
    world: Vector,
    feature: FeatureId,
}

/// The witness points of the best facet; `None` where rounding does not let them be found.
#[inline(always)]
pub fn find<L: Lanes, const C: usize, const F: usize>(
    search: &Search<L, C, F>,
    direction: &Vector,
    overlap: f64,
) -> Option<Witness> {
    let places = match search.best.facet {
        Facet::Face(body, face) => {
            let outward = if body == 0 { *direction } else { -direction };
            let side = Side { search, body, face, outward, overlap };
            let [on_face, on_other] = side.places()?;
            if body == 0 { [on_face, on_other] } else { [on_other, on_face] }
        }
        Facet::Edges(edges) => on_edges(search, edges),
    };
    let [place1, place2] = places;
    let off = place1.world - place2.world - direction * overlap;
    // False for a NaN.
    let is_near = off.norm() <= MISS * search.longest;
    let witness = Witness { points: [place1.own, place2.own], features: [place1.feature, place2.feature] };
    if is_near { Some(witness) } else { None }
}

/// The points of two edges that are over each other.
#[inline(always)]
fn on_edges<L: Lanes, const C: usize, const F: usize>(search: &Search<L, C, F>, edges: [u32; 2]) -> [WitnessPoint; 2] {
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
    let place = |polyhedron: &Polyhedron, edge: u32, t: f64, tail: &Vector, along: &Vector, own: &Vector| {
        let record = &polyhedron.edges[edge as usize];
        let t = clamp(t, 0.0, record.length);
        WitnessPoint { own: record.tail_position + own * t, world: tail + along * t, feature: FeatureId::Edge(edge) }
    };
    let (s, t) = ((along_g * eg - along_e * gg) / square, (along_g * ee - along_e * eg) / square);
    [
        place(body1.polyhedron, edge1, s, &tail1, &e, &fan_edge1.direction),
        place(body2.polyhedron, edge2, t, &tail2, &g, &fan_edge2.direction),
    ]
}

/// A face of a body that the other is least deep below.
struct Side<'a, 'b, L, const C: usize, const F: usize> {
    search: &'a Search<'b, L, C, F>,
    body: usize,
    face: u32,
    /// The unit normal.
    outward: Vector,
    overlap: f64,
}

impl<L: Lanes, const C: usize, const F: usize> Side<'_, '_, L, C, F> {
    fn polyhedron(&self, body: usize) -> &Polyhedron {
        self.search.frame.bodies[body].polyhedron
    }

    /// A point on the face, and one of the other body below it: of one corner, of an edge, or of a face that is parallel.
    #[inline(always)]
    fn places(&self) -> Option<[WitnessPoint; 2]> {
        let Side { search, body, outward, .. } = self;
        let other = 1 - body;
        let corners = &search.fans[other].corners;
        let least = search.placed[other].least::<L>(outward);
        let mut deepest = search.placed[other].at_most::<L>(outward, least + (TIE + SUPPORT) * search.longest);
        deepest &= u64::MAX >> (64 - corners.len());
        if deepest.count_ones() == 1 {
            let corner = deepest.trailing_zeros() as usize;
            let place = self.at_corner(other, corner);
            return Some([self.on_face(*body, self.face, &self.above(&place.world))?, place]);
        }
        self.over_edge(deepest).or_else(|| self.over_face())
    }

    /// Over a point of the other body.
    fn above(&self, point: &Vector) -> Vector {
        point + self.outward * self.overlap
    }

    fn at_corner(&self, body: usize, corner: usize) -> WitnessPoint {
        let vertex = self.search.fans[body].corners[corner];
        WitnessPoint {
            own: self.polyhedron(body).vertices[vertex as usize].position,
            world: self.search.placed[body].point(corner),
            feature: FeatureId::Vertex(vertex),
        }
    }

    /// The middle of the longest part of an edge between two deepest corners that is below the face.
    fn over_edge(&self, deepest: u64) -> Option<[WitnessPoint; 2]> {
        let Side { search, body, .. } = self;
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
        let (index, ends, t) = best.1?;
        let record = &self.polyhedron(other).edges[index];
        let place = WitnessPoint {
            own: record.tail_position + search.fans[other].edges[index].direction * (t * record.length),
            world: ends[0] + (ends[1] - ends[0]) * t,
            feature: FeatureId::Edge(index as u32),
        };
        Some([self.on_face(*body, self.face, &self.above(&place.world))?, place])
    }

    /// From where to where a segment is below the face; the wrong way round where it is not.
    fn part_below(&self, [tail, head]: &[Vector; 2]) -> [f64; 2] {
        let [mut from, mut to] = [0.0_f64, 1.0_f64];
        let polygon = Polygon::of(self.search, self.body, self.face);
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
    fn over_face(&self) -> Option<[WitnessPoint; 2]> {
        let Side { search, body, outward, .. } = self;
        let other = 1 - body;
        let against = |face: &usize| search.placed[other].normal(*face).dot(outward);
        let faces = 0..self.polyhedron(other).faces.len();
        let below = faces.reduce(|a, b| if against(&b) < against(&a) { b } else { a })?;
        let polygon = Polygon::of(search, *body, self.face);
        let share = 1.0 / polygon.count() as f64;
        let [mut own, mut world] = [Vector::zeros(); 2];
        for side in 0..polygon.count() {
            let place = self.at_corner(*body, polygon.place(side));
            (own, world) = (own + place.own * share, world + place.world * share);
        }
        let place = WitnessPoint { own, world, feature: FeatureId::Face(self.face) };
        Some([place, self.on_face(other, below as u32, &(world - outward * self.overlap))?])
    }

    /// The point of a face nearest to one over it, about: in the triangle of a fan around its first corner.
    fn on_face(&self, body: usize, face: u32, point: &Vector) -> Option<WitnessPoint> {
        let polygon = Polygon::of(self.search, body, face);
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
            let place = self.at_corner(body, polygon.place(corner));
            (own, world) = (own + place.own * weight, world + place.world * weight);
        }
        if area > 0.0 { Some(WitnessPoint { own, world, feature: FeatureId::Face(face) }) } else { None }
    }
}

/// A segment that misses a polygon by less than this, over M, touches it.
const SLIGHTLY: f64 = 64.0 * U;

/// The corners of a placed face, counter-clockwise.
struct Polygon<'a, 'b, L, const C: usize, const F: usize> {
    search: &'a Search<'b, L, C, F>,
    body: usize,
    face: u32,
}

impl<'a, 'b, L: Lanes, const C: usize, const F: usize> Polygon<'a, 'b, L, C, F> {
    fn of(search: &'a Search<'b, L, C, F>, body: usize, face: u32) -> Self {
        Polygon { search, body, face }
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
