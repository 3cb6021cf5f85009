//! The direction of a contact: along which two bodies that intersect overlap little.
//!
//! Bodies that only touch are separated by a plane whose normal lies in the normal cones of both at the touching point. An
//! extreme ray of the cones' common part is perpendicular to two edges: both of one body (a face normal), or one of each. So
//! the normals and the cross products of edges at the vertices around the point hold a separating direction. Where the bodies
//! overlap, the same candidates at the vertices that reach farthest make a descent to a local minimum of the overlap; it is
//! no least depth.

use super::normal_cone::separating_direction;
use crate::base::math::{Pose, Vector};
use crate::polyhedron::Polyhedron;
use crate::solve::exact::VertexPair;

/// Pairs of vertices whose candidates are looked at: at a touching point one is enough.
const ROUND_LIMIT: u32 = 8;

/// Neighbours of a vertex beyond which not all are looked at, to bound the work at the apex of a cone: each candidate takes a
/// look at all of them.
const MOST_NEIGHBOURS: usize = 64;

/// How many are looked at then: those along which the direction found so far runs steepest. Where it is in the normal cone
/// these are the nearest to the cone's boundary, and on it the extreme rays are.
const STEEPEST_NEIGHBOURS: usize = 12;

/// How far, as a sine, a cross product of edges may miss a normal cone to be looked at; the overlap itself then decides.
const CONE_TOLERANCE: f64 = 1e-9;

/// How two bodies that intersect overlap along a direction.
#[derive(Debug, Clone, Copy)]
pub struct Overlap {
    /// In the world, from body 2 to body 1, a unit vector.
    pub direction: Vector,
    /// By how much body 2 would have to move against it to come free.
    pub depth: f64,
    /// The vertices that reach farthest along it.
    pub ends: VertexPair,
}

/// Two placed bodies, and the least overlap found.
struct Search<'a> {
    polyhedra: [&'a Polyhedron; 2],
    poses: [&'a Pose; 2],
    least: Overlap,
    /// Vertices that reach far along other directions, and where they are in their bodies.
    met: [(VertexPair, [Vector; 2]); 8],
    /// The entry of `met` to be overwritten next.
    oldest: usize,
}

/// The least overlap found of a pair that intersects. `pairs` are vertex pairs whose differences hold the origin in their hull.
pub fn contact_direction(polyhedra: [&Polyhedron; 2], poses: [&Pose; 2], pairs: &[VertexPair]) -> Overlap {
    let ends = pairs.first().copied().unwrap_or_default();
    let mut met = [(ends, positions(polyhedra, ends)); 8];
    for (known, pair) in met.iter_mut().zip(pairs) {
        *known = (*pair, positions(polyhedra, *pair));
    }
    let oldest = pairs.len().min(7);
    let least = Overlap { direction: Vector::x(), depth: f64::INFINITY, ends };
    let mut search = Search { polyhedra, poses, least, met, oldest };
    let world_centre = |i: usize| poses[i].transform(&polyhedra[i].mass.centre_of_mass);
    search.consider(&(world_centre(0) - world_centre(1)));
    let has_many = |i: usize| pairs.iter().any(|pair| has_many_neighbours(polyhedra[i], pair[i]));
    if (has_many(0) || has_many(1))
        && let Some(direction) = separating_direction(polyhedra, poses, pairs)
    {
        search.consider(&direction);
        search.consider(&-direction);
    }
    for (k, pair) in pairs.iter().enumerate() {
        for i in 0..2 {
            if pairs[..k].iter().all(|other| other[i] != pair[i]) {
                search.consider_normals(i, pair[i]);
            }
        }
    }
    for pair in pairs {
        search.consider_cross_products(*pair);
    }
    let mut from = search.least.ends;
    for _ in 0..ROUND_LIMIT {
        search.consider_normals(0, from[0]);
        search.consider_normals(1, from[1]);
        search.consider_cross_products(from);
        if search.least.ends == from {
            break;
        }
        from = search.least.ends;
    }
    search.least
}

/// Where two vertices are in their bodies.
fn positions(polyhedra: [&Polyhedron; 2], pair: VertexPair) -> [Vector; 2] {
    [0, 1].map(|i| polyhedra[i].local_position(pair[i]))
}

impl Search<'_> {
    /// Takes a direction of any length if the bodies overlap less along it.
    fn consider(&mut self, direction: &Vector) {
        let length = direction.norm();
        if length == 0.0 || !length.is_finite() {
            return;
        }
        let direction = direction / length;
        let apart = -direction.dot(&(self.poses[0].translation() - self.poses[1].translation()));
        let towards = [self.towards(0, &direction), self.towards(1, &direction)];
        // No body reaches less far than a vertex of it, which rules most directions out at once.
        let mut ends = self.least.ends;
        let mut reach = [0, 1].map(|i| towards[i].dot(&self.polyhedra[i].local_position(ends[i])));
        for (pair, positions) in &self.met {
            for i in 0..2 {
                let height = towards[i].dot(&positions[i]);
                if height > reach[i] {
                    (ends[i], reach[i]) = (pair[i], height);
                }
            }
        }
        if apart + reach[0] + reach[1] >= self.least.depth {
            return;
        }
        for (i, end) in ends.iter_mut().enumerate() {
            let polyhedron = self.polyhedra[i];
            // A climb that starts at a flat vertex does not leave it along the normal of its face, either way.
            let start = if polyhedron.face_around(*end).is_some() { polyhedron.edges[0].tail() } else { *end };
            (*end, _) = polyhedron.support(&towards[i], start);
        }
        let positions = positions(self.polyhedra, ends);
        self.met[self.oldest] = (ends, positions);
        self.oldest = (self.oldest + 1) % self.met.len();
        let depth = apart + towards[0].dot(&positions[0]) + towards[1].dot(&positions[1]);
        if depth < self.least.depth {
            self.least = Overlap { direction, depth, ends };
        }
    }

    /// The normals of the faces around a vertex.
    fn consider_normals(&mut self, i: usize, vertex: u32) {
        let polyhedron = self.polyhedra[i];
        if has_many_neighbours(polyhedron, vertex) {
            for neighbour in self.neighbours(i, vertex).as_slice() {
                // NONE is beyond all indices.
                let Some(edge) = polyhedron.edges.get(neighbour.edge as usize) else { continue };
                edge.normals.iter().for_each(|normal| self.consider_normal(i, normal));
            }
        } else {
            for block in polyhedron.neighbour_blocks(vertex) {
                for (lane, edge) in block.edge.iter().enumerate() {
                    let Some(edge) = polyhedron.edges.get(*edge as usize) else { continue };
                    // Unused lanes repeat lane 0.
                    if lane > 0 && block.head[lane] == block.head[0] {
                        break;
                    }
                    // Every face is on the left of one edge away from the vertex. Inside an edge it is on either.
                    if edge.head() != vertex {
                        self.consider_normal(i, &edge.normals[0]);
                    }
                    if edge.tail() != vertex {
                        self.consider_normal(i, &edge.normals[1]);
                    }
                }
            }
        }
        if let Some(face) = polyhedron.face_around(vertex) {
            self.consider_normal(i, &polyhedron.faces[face as usize].normal);
        }
    }

    /// The neighbours of a vertex that are looked at.
    fn neighbours(&self, i: usize, vertex: u32) -> Neighbours {
        Neighbours::new(self.polyhedra[i], vertex, &self.towards(i, &self.least.direction))
    }

    /// An outward face normal of one body, in its own frame.
    fn consider_normal(&mut self, i: usize, normal: &Vector) {
        let world = self.poses[i].rotate(normal);
        self.consider(&if i == 0 { -world } else { world });
    }

    /// A world direction from body 2 to body 1 as one of the bodies sees it: towards the other.
    fn towards(&self, i: usize, direction: &Vector) -> Vector {
        self.poses[i].rotate_back(&if i == 0 { -direction } else { *direction })
    }

    /// The cross products of edges at two vertices that lie in the normal cones of both.
    fn consider_cross_products(&mut self, pair: VertexPair) {
        let (polyhedra, poses) = (self.polyhedra, self.poses);
        let neighbours = [self.neighbours(0, pair[0]), self.neighbours(1, pair[1])];
        let factor = |i: usize, neighbour: &Neighbour| {
            let position = |v: u32| polyhedra[i].vertices[v as usize].position;
            let along = position(neighbour.head) - position(pair[i]);
            // The largest component ±1, so that no product leaves the range of doubles.
            poses[i].rotate(&(along / along.amax()))
        };
        for first in neighbours[0].as_slice() {
            let first = factor(0, first);
            for second in neighbours[1].as_slice() {
                self.consider_in_cones(first.cross(&factor(1, second)), pair, &neighbours);
            }
        }
        // A segment has no plane of its own and a point no direction: they are crossed with the axes.
        if polyhedra[0].dimension.min(polyhedra[1].dimension) < 2 {
            for (i, own) in neighbours.iter().enumerate() {
                for neighbour in own.as_slice() {
                    let world = factor(i, neighbour);
                    for axis in [Vector::x(), Vector::y(), Vector::z()] {
                        self.consider_in_cones(world.cross(&axis), pair, &neighbours);
                    }
                }
            }
        }
    }

    /// Both senses of a direction, where they lie in the normal cones of a pair of vertices; `neighbours` are some of theirs.
    fn consider_in_cones(&mut self, direction: Vector, pair: VertexPair, neighbours: &[Neighbours; 2]) {
        for direction in [direction, -direction] {
            let is_in_cone = |i: usize| {
                let towards = self.towards(i, &direction);
                let length = towards.norm();
                let is_behind = |slope: f64| slope <= CONE_TOLERANCE * length;
                neighbours[i].as_slice().iter().all(|neighbour| is_behind(neighbour.direction.dot(&towards)))
                    && self.polyhedra[i]
                        .steepest_closely(pair[i], &towards, length)
                        .is_none_or(|steepest| is_behind(steepest.slope))
            };
            if is_in_cone(0) && is_in_cone(1) {
                self.consider(&direction);
            }
        }
    }
}

/// A neighbour of a vertex.
#[derive(Clone, Copy, Default)]
struct Neighbour {
    head: u32,
    /// The edge to it, or NONE.
    edge: u32,
    /// The unit vector to it.
    direction: Vector,
    /// How steeply that runs along the direction asked about.
    slope: f64,
}

/// Some neighbours of a vertex.
struct Neighbours {
    list: [Neighbour; MOST_NEIGHBOURS],
    count: usize,
}

impl Neighbours {
    /// All neighbours of a vertex; of more than `MOST_NEIGHBOURS` the steepest along `towards`.
    fn new(polyhedron: &Polyhedron, vertex: u32, towards: &Vector) -> Neighbours {
        let mut chosen = Neighbours { list: [Neighbour::default(); MOST_NEIGHBOURS], count: 0 };
        let has_many = has_many_neighbours(polyhedron, vertex);
        let mut least = f64::NEG_INFINITY;
        for block in polyhedron.neighbour_blocks(vertex) {
            let directions = block.head.map(|head| polyhedron.direction_to(vertex, head));
            let slopes = directions.map(|direction| direction.dot(towards));
            if has_many && slopes.iter().all(|slope| *slope <= least) {
                continue;
            }
            // Unused lanes repeat lane 0.
            for lane in (0..8).filter(|&lane| lane == 0 || block.head[lane] != block.head[0]) {
                let (head, edge) = (block.head[lane], block.edge[lane]);
                let neighbour = Neighbour { head, edge, direction: directions[lane], slope: slopes[lane] };
                if has_many {
                    least = chosen.insert(neighbour, STEEPEST_NEIGHBOURS);
                } else {
                    chosen.list[chosen.count] = neighbour;
                    chosen.count += 1;
                }
            }
        }
        chosen
    }

    /// Adds a neighbour if it belongs to the `count` steepest, the steepest first; returns what the next has to be steeper than.
    fn insert(&mut self, neighbour: Neighbour, count: usize) -> f64 {
        if self.count < count {
            self.count += 1;
        } else if self.list[count - 1].slope >= neighbour.slope {
            return self.list[count - 1].slope;
        }
        let mut place = self.count - 1;
        while place > 0 && self.list[place - 1].slope < neighbour.slope {
            self.list[place] = self.list[place - 1];
            place -= 1;
        }
        self.list[place] = neighbour;
        if self.count < count { f64::NEG_INFINITY } else { self.list[count - 1].slope }
    }

    fn as_slice(&self) -> &[Neighbour] {
        &self.list[..self.count]
    }
}

/// Whether a vertex has more than `MOST_NEIGHBOURS` neighbours.
fn has_many_neighbours(polyhedron: &Polyhedron, vertex: u32) -> bool {
    polyhedron.neighbour_capacity(vertex) > MOST_NEIGHBOURS
}
