//! The direction of a contact: along which two bodies that intersect overlap little.
//!
//! Bodies that only touch are separated by a plane whose normal lies in the normal cones of both at the touching point. An
//! extreme ray of the cones' common part is perpendicular to two edges: both of one body (a face normal), or one of each. So
//! the normals and the cross products of edges at the vertices around the point hold a separating direction. Where the bodies
//! overlap, the same candidates at the vertices that reach farthest make a descent to a local minimum of the overlap; it is
//! no least depth.

use crate::exact::VertexPair;
use crate::math::{Pose, Vector};
use crate::polyhedron::{NONE, NeighbourBlock, Polyhedron};

/// Pairs of vertices whose candidates are looked at: at a touching point one is enough.
const ROUND_LIMIT: u32 = 8;

/// Neighbours of a vertex that serve as factors of cross products, to bound the work at the apex of a cone.
const FACTOR_LIMIT: usize = 64;

/// How far, as a sine, a cross product of edges may miss a normal cone to be looked at; the overlap itself then decides.
const CONE_TOLERANCE: f64 = 1e-9;

/// Two placed bodies, and the least overlap found.
struct Search<'a> {
    polyhedra: [&'a Polyhedron; 2],
    poses: [&'a Pose; 2],
    /// World, from body 2 to body 1, a unit vector.
    direction: Vector,
    overlap: f64,
    /// The vertices that reach farthest along it.
    ends: VertexPair,
}

/// A world unit direction from body 2 to body 1 for a pair that intersects. `pairs` are vertex pairs whose differences hold the
/// origin in their hull.
pub fn contact_direction(polyhedra: [&Polyhedron; 2], poses: [&Pose; 2], pairs: &[VertexPair]) -> Vector {
    let ends = pairs.first().copied().unwrap_or_default();
    let mut search = Search { polyhedra, poses, direction: Vector::x(), overlap: f64::INFINITY, ends };
    let world_centre = |i: usize| poses[i].transform(&polyhedra[i].mass.centre_of_mass);
    search.consider(&(world_centre(0) - world_centre(1)));
    for &pair in pairs {
        search.consider_normals(pair);
    }
    search.consider_cross_products(ends);
    let mut from = search.ends;
    for _ in 0..ROUND_LIMIT {
        search.consider_normals(from);
        search.consider_cross_products(from);
        if search.ends == from {
            break;
        }
        from = search.ends;
    }
    search.direction
}

impl Search<'_> {
    /// Takes a direction of any length if the bodies overlap less along it.
    fn consider(&mut self, direction: &Vector) {
        let length = direction.norm();
        if length == 0.0 || !length.is_finite() {
            return;
        }
        let direction = direction / length;
        let mut overlap = -direction.dot(&(self.poses[0].translation() - self.poses[1].translation()));
        let mut ends = self.ends;
        for (i, end) in ends.iter_mut().enumerate() {
            let (polyhedron, towards) = (self.polyhedra[i], self.towards(i, &direction));
            // A climb that starts at a flat vertex does not leave it along the normal of its face, either way.
            let start = if is_flat(polyhedron, *end) { polyhedron.edges[0].tail } else { *end };
            (*end, _) = polyhedron.support(&towards, start);
            overlap += towards.dot(&polyhedron.local_position(*end));
        }
        if overlap < self.overlap {
            (self.direction, self.overlap, self.ends) = (direction, overlap, ends);
        }
    }

    /// The normals of the faces around two vertices.
    fn consider_normals(&mut self, pair: VertexPair) {
        for (i, polyhedron) in self.polyhedra.into_iter().enumerate() {
            for block in polyhedron.neighbour_blocks(pair[i]) {
                for edge in block.edge {
                    // NONE is beyond all indices.
                    let Some(edge) = polyhedron.edges.get(edge as usize) else { continue };
                    for normal in &edge.normals {
                        self.consider_normal(i, normal);
                    }
                }
            }
            if is_flat(polyhedron, pair[i]) {
                for (triangle, &face) in polyhedron.triangles.iter().zip(&polyhedron.face_of_triangle) {
                    if triangle.contains(&pair[i]) {
                        self.consider_normal(i, &polyhedron.faces[face as usize].normal);
                    }
                }
            }
        }
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
        for first in factors(self.polyhedra[0], pair[0]) {
            let first = self.poses[0].rotate(&first);
            for second in factors(self.polyhedra[1], pair[1]) {
                let product = first.cross(&self.poses[1].rotate(&second));
                self.consider_in_cones(product, pair);
            }
        }
        // A segment has no plane of its own and a point no direction: they are crossed with the axes.
        if self.polyhedra[0].dimension.min(self.polyhedra[1].dimension) < 2 {
            for (i, polyhedron) in self.polyhedra.into_iter().enumerate() {
                for factor in factors(polyhedron, pair[i]) {
                    let world = self.poses[i].rotate(&factor);
                    for axis in [Vector::x(), Vector::y(), Vector::z()] {
                        self.consider_in_cones(world.cross(&axis), pair);
                    }
                }
            }
        }
    }

    fn consider_in_cones(&mut self, direction: Vector, pair: VertexPair) {
        for direction in [direction, -direction] {
            let is_in_cone = |i: usize| {
                let towards = self.towards(i, &direction);
                let limit = CONE_TOLERANCE * towards.norm();
                self.polyhedra[i]
                    .neighbour_blocks(pair[i])
                    .all(|block| (0..8).all(|lane| block_direction(block, lane).dot(&towards) <= limit))
            };
            if is_in_cone(0) && is_in_cone(1) {
                self.consider(&direction);
            }
        }
    }
}

/// Whether a vertex only lies inside a merged face or edge.
fn is_flat(polyhedron: &Polyhedron, vertex: u32) -> bool {
    !polyhedron.edges.is_empty()
        && polyhedron.neighbour_blocks(vertex).all(|block| block.edge.iter().all(|&edge| edge == NONE))
}

/// Vectors along the edges from a vertex to its neighbours, the largest component ±1, so that no product leaves the range of
/// doubles; at most `FACTOR_LIMIT`.
fn factors(polyhedron: &Polyhedron, vertex: u32) -> impl Iterator<Item = Vector> {
    let own = polyhedron.vertices[vertex as usize].position;
    // Unused lanes repeat lane 0.
    let heads = |block: &NeighbourBlock| {
        let head = block.head;
        (0..8).filter(move |&lane| lane == 0 || head[lane] != head[0]).map(move |lane| head[lane])
    };
    polyhedron
        .neighbour_blocks(vertex)
        .flat_map(heads)
        .map(move |head| polyhedron.vertices[head as usize].position - own)
        .map(|along| along / along.amax())
        .take(FACTOR_LIMIT)
}

fn block_direction(block: &NeighbourBlock, lane: usize) -> Vector {
    Vector::new(block.x[lane], block.y[lane], block.z[lane])
}
