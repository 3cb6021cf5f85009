//! Vertices, edges and faces with their planes, as marching wants them in memory.

use crate::base::error::{Error, Result};
use crate::base::math::{UNIT_ROUNDOFF, Vector, length};
use crate::base::memory::{copied, extend, filled, push, reserve, with_capacity};
use crate::base::normal::unit;
use crate::base::progress::Progress;
use crate::body::build::merge::MergedFaces;
use crate::body::build::slack::RiseBounds;
use crate::body::polyhedron::triangulation::Triangulation;
use crate::body::polyhedron::{Bevel, Edge, MergedFace, NONE, NeighbourBlock, PlaneBlock, Polyhedron, Vertex};

/// The neighbours of a vertex with the edges to them: those along edges first, else counter-clockwise, each once (in a flat
/// hull a diagonal occurs on both sides).
pub fn neighbours_of(surface: &Triangulation, edge_of: &[u32], v: u32, flat: bool) -> Result<Vec<(u32, u32)>> {
    let around = surface.around(v);
    let mut all: Vec<(u32, u32)> = with_capacity(around.len())?;
    all.extend(around.iter().map(|h| (surface.head(*h), edge_of[*h as usize])));
    if flat {
        all.sort_unstable();
        all.dedup_by_key(|(w, _)| *w);
    }
    // Few vertices have neighbours of both kinds.
    let has_edge = |neighbour: &&(u32, u32)| neighbour.1 != NONE;
    if all.is_sorted_by_key(|(_, edge)| *edge == NONE) {
        return Ok(all);
    }
    let mut neighbours = with_capacity(all.len())?;
    neighbours.extend(all.iter().filter(has_edge));
    neighbours.extend(all.iter().filter(|neighbour| !has_edge(neighbour)));
    Ok(neighbours)
}

/// The plane through the side of a face that runs from one vertex to another counter-clockwise, inside positive: its normal and
/// offset. Both faces of an edge measure from the same end along the same direction.
fn side_plane(positions: &[Vector], normal: &Vector, from: u32, to: u32) -> (Vector, f64) {
    let (tail, head) = (&positions[from.min(to) as usize], &positions[from.max(to) as usize]);
    let direction = unit(&(head - tail));
    let inward = if from < to { normal.cross(&direction) } else { direction.cross(normal) };
    // The edge may lean out of the rounded plane by a little, so normalise.
    let inward = unit(&inward);
    (inward, -inward.dot(tail))
}

/// The least sine of what is provably a dihedral angle: the planes' normals and products with them are each right to some 8u.
const SMALLEST_SINE: f64 = 64.0 * UNIT_ROUNDOFF;

/// The edge of a segment, which has no faces: nothing lies beside it, so its cone is all that is across it.
pub(super) fn segment_edge(positions: &[Vector]) -> Edge {
    let (tail, head) = (&positions[0], &positions[1]);
    let direction = unit(&(head - tail));
    let length = length(&(head - tail));
    // As of unused sides: every point is far inside.
    let mut planes = PlaneBlock { x: [0.0; 4], y: [0.0; 4], z: [0.0; 4], offset: [f64::MAX; 4] };
    let start = direction.dot(tail);
    set_plane(&mut planes, 0, &direction, -start);
    set_plane(&mut planes, 1, &-direction, length + start);
    Edge {
        planes,
        tail_position: *tail,
        length,
        slack: 0.0,
        across: [0, 1, NONE, NONE],
        labels: [NONE; 2],
        normals: [Vector::zeros(); 2],
        reciprocal_sine: f64::INFINITY,
        bevel: NONE,
    }
}

/// An edge from its ends, the lower one first, and the faces beside it.
pub(super) fn edge_between(
    [tail, head]: [u32; 2],
    positions: &[Vector],
    [left, right]: [u32; 2],
    normals: &[Vector],
    slacks: &[f64],
) -> Edge {
    let (a, b) = (&positions[tail as usize], &positions[head as usize]);
    let direction = unit(&(b - a));
    let length = length(&(b - a));
    let normals = [normals[left as usize], normals[right as usize]];
    let (side_left, offset_left) = side_plane(positions, &normals[0], tail, head);
    let (side_right, offset_right) = side_plane(positions, &normals[1], head, tail);
    let mut planes = PlaneBlock { x: [0.0; 4], y: [0.0; 4], z: [0.0; 4], offset: [0.0; 4] };
    let start = direction.dot(a);
    set_plane(&mut planes, 0, &direction, -start);
    set_plane(&mut planes, 1, &-direction, length + start);
    set_plane(&mut planes, 2, &-side_left, -offset_left);
    set_plane(&mut planes, 3, &-side_right, -offset_right);
    let sine = -normals[0].dot(&side_right);
    // If rounding hides the dihedral angle, as between coplanar triangles that were not merged, the two side planes bound no
    // wedge but a whole plane, of which half is inside the body. A quick look takes it for the normal cone, so it must not do.
    let is_flat = sine <= SMALLEST_SINE && normals[0].dot(&normals[1]) > 0.0;
    let slack = if is_flat { f64::INFINITY } else { slacks[left as usize].max(slacks[right as usize]) };
    Edge {
        planes,
        tail_position: *a,
        length,
        slack,
        across: [tail, head, left, right],
        labels: [NONE; 2],
        normals,
        reciprocal_sine: if sine > 0.0 { 1.0 / sine } else { f64::INFINITY },
        bevel: NONE,
    }
}

/// The slack that a short edge of merged faces adds to a quick look. Its vertices are in the faces' planes within
/// [`merge_bound`](crate::body::build::merge::merge_bound), so it leans out of them by s = |n·ê| of up to 16uρ over its length. A
/// quick look takes for the cone of the normals the directions across the edge between the normals' parts across it, n − (n·ê)ê. As
/// combinations of the normals these miss by s each, and no point of the body is farther from the edge than 2ρ. The looks allow for
/// the lean of a triangle's edge by rounding: the product is right to 3u, and s up to 5u is within the 12u that they have for this.
pub(super) fn slack_of_leaning(edge: &Edge, radius: f64) -> f64 {
    let along = plane_normal(&edge.planes, 0);
    let leaning = edge.normals.map(|normal| normal.dot(&along).abs()).into_iter().fold(0.0, f64::max);
    if leaning <= 2.0 * UNIT_ROUNDOFF {
        0.0
    } else if leaning < LARGEST_LEANING {
        2.0 * radius * leaning
    } else {
        // The parts across the edge are much shorter than the normals, or there are none.
        f64::INFINITY
    }
}

/// For edges that lean less, the normals' parts across them are as long as the normals to a part in two million.
const LARGEST_LEANING: f64 = 1e-3;

/// Writes one lane of a plane block.
pub(super) fn set_plane(block: &mut PlaneBlock, lane: usize, normal: &Vector, offset: f64) {
    (block.x[lane], block.y[lane], block.z[lane]) = (normal.x, normal.y, normal.z);
    block.offset[lane] = offset;
}

/// The normal in one lane of a plane block.
pub(super) fn plane_normal(block: &PlaneBlock, lane: usize) -> Vector {
    Vector::new(block.x[lane], block.y[lane], block.z[lane])
}

/// A hull whose triangles are merged into faces.
pub(super) struct MergedHull<'a> {
    pub surface: &'a Triangulation,
    pub positions: &'a [Vector],
    pub merged: &'a MergedFaces,
    /// σ of each face.
    pub slacks: &'a [f64],
}

impl Polyhedron {
    /// Adds the next vertex with its neighbour blocks.
    pub(super) fn add_vertex(&mut self, positions: &[Vector], v: u32, neighbours: &[(u32, u32)]) -> Result<()> {
        let position = positions[v as usize];
        let mut blocks = neighbours.chunks(8).map(|chunk| {
            let mut block = NeighbourBlock { x: [0.0; 8], y: [0.0; 8], z: [0.0; 8], head: [0; 8], edge: [NONE; 8] };
            for lane in 0..8 {
                let (head, edge) = chunk[if lane < chunk.len() { lane } else { 0 }];
                let direction = unit(&(positions[head as usize] - position));
                [block.x[lane], block.y[lane], block.z[lane]] =
                    [direction.x, direction.y, direction.z].map(|d| d as f32);
                (block.head[lane], block.edge[lane]) = (head, edge);
            }
            block
        });
        let first = blocks.next();
        let first_more = self.more_neighbours.len() as u32;
        extend(&mut self.more_neighbours, blocks)?;
        let more = self.more_neighbours.len() as u32 - first_more;
        extend(&mut self.vertices, first.map(|neighbours| Vertex { position, first_more, more, neighbours }))
    }

    /// Adds all edges, ordered by their lower vertex, and the bevels of the sharp ones. Returns the edge of each half-edge, NONE
    /// inside faces.
    ///
    /// # Errors
    /// [`Error::Cancelled`] when the caller does not want to go on.
    pub(super) fn add_edges(
        &mut self,
        hull: &MergedHull,
        rises: &mut RiseBounds,
        progress: &mut Progress,
    ) -> Result<Vec<u32>> {
        let MergedHull { surface, positions, merged, slacks } = *hull;
        let mut edge_of = filled(NONE, surface.twins.len())?;
        // Euler: corners − edges + faces = 2.
        let most = merged.normals.len() + merged.corners.iter().filter(|c| **c).count();
        reserve(&mut self.edges, most)?;
        for tail in (0..positions.len() as u32).filter(|v| merged.corners[*v as usize]) {
            progress.steps(4 * surface.around(tail).len(), tail as usize, positions.len())?;
            for &first in surface.around(tail) {
                if !merged.is_boundary(surface, first) || edge_of[first as usize] != NONE {
                    continue;
                }
                let id = self.edges.len() as u32;
                let last = merged.last_of_edge(surface, first);
                let after = |h: &u32| (*h != last).then(|| merged.next_on_boundary(surface, *h));
                let half_edges = std::iter::successors(Some(first), after);
                for h in half_edges.clone() {
                    edge_of[h as usize] = id;
                    edge_of[surface.twins[h as usize] as usize] = id;
                }
                let faces = [merged.left(first), merged.left(surface.twins[first as usize])];
                let mut edge = edge_between([tail, surface.head(last)], positions, faces, &merged.normals, slacks);
                if edge.normals[0].dot(&edge.normals[1]) < 0.0 {
                    edge.bevel = self.bevels.len() as u32;
                    let bevel = bevel_of(&edge, half_edges.map(|h| surface.head(h)), rises);
                    edge.slack = edge.slack.max(bevel.slack);
                    push(&mut self.bevels, bevel)?;
                }
                edge.slack += slack_of_leaning(&edge, self.radius);
                push(&mut self.edges, edge)?;
            }
        }
        Ok(edge_of)
    }

    /// Adds all faces with their sides.
    pub(super) fn add_faces(&mut self, hull: &MergedHull, edge_of: &[u32], progress: &mut Progress) -> Result<()> {
        let MergedHull { surface, positions, merged, slacks } = *hull;
        reserve(&mut self.faces, merged.normals.len())?;
        reserve(&mut self.sides, 2 * self.edges.len())?;
        for (face, normal) in merged.normals.iter().enumerate() {
            let first = merged.first_half_edges[face];
            let first_side = self.sides.len();
            let first_more = self.more_sides.len();
            let mut planes = PlaneBlock { x: [0.0; 4], y: [0.0; 4], z: [0.0; 4], offset: [0.0; 4] };
            let (mut low, mut high) = (f64::INFINITY, f64::NEG_INFINITY);
            let mut h = first;
            loop {
                let last = merged.last_of_edge(surface, h);
                progress.steps(4, face, merged.normals.len())?;
                let (tail, head) = (surface.tail(h), surface.head(last));
                let height = normal.dot(&positions[tail as usize]);
                (low, high) = (low.min(height), high.max(height));
                // The edge has this plane, too; but there it is far away in memory.
                let (side, offset) = side_plane(positions, normal, tail, head);
                match self.sides.len() - first_side {
                    i @ 0..3 => set_plane(&mut planes, 1 + i, &side, offset),
                    i => self.add_further_side((i - 3) % 4, &side, offset)?,
                }
                push(&mut self.sides, edge_of[h as usize])?;
                h = merged.next_on_boundary(surface, last);
                if h == first {
                    break;
                }
            }
            let side_count = self.sides.len() - first_side;
            if side_count < 3 {
                return Err(Error::Bug(format!("face {face} has {side_count} sides")));
            }
            set_plane(&mut planes, 0, normal, -0.5 * (low + high));
            let first_sides = [0, 1, 2].map(|side| self.sides[first_side + side]);
            self.faces.push(MergedFace {
                planes,
                slack: slacks[face],
                first_side: first_side as u32,
                side_count: side_count as u32,
                first_more: first_more as u32,
                vertex: surface.tail(first),
                label: NONE,
                first_sides,
                normal: merged.normals[face],
            });
        }
        Ok(())
    }

    /// Finds the vertices inside merged faces: no edge leads to a neighbour of theirs.
    pub(super) fn find_flat_vertices(&mut self, progress: &mut Progress) -> Result<()> {
        let is_flat = |v: &&u32| self.vertices[**v as usize].neighbours.edge[0] == NONE;
        for (done, (triangle, &face)) in self.triangles.iter().zip(&self.face_of_triangle).enumerate() {
            progress.step(done, self.triangles.len())?;
            extend(&mut self.flat_vertices, triangle.iter().filter(is_flat).map(|v| [*v, face]))?;
        }
        self.flat_vertices.sort_unstable();
        self.flat_vertices.dedup();
        self.flat_vertices = copied(&self.flat_vertices)?;
        Ok(())
    }

    /// Adds one of the sides beyond the third of the last face; lane 0 begins a block.
    fn add_further_side(&mut self, lane: usize, side: &Vector, offset: f64) -> Result<()> {
        if lane == 0 {
            // No infinity: differences and quotients of unused lanes have a value, too.
            let unused = PlaneBlock { x: [0.0; 4], y: [0.0; 4], z: [0.0; 4], offset: [f64::MAX; 4] };
            push(&mut self.more_sides, unused)?;
        }
        if let Some(block) = self.more_sides.last_mut() {
            set_plane(block, lane, side, offset);
        }
        Ok(())
    }
}

/// The plane that halves a sharp edge; `vertices` are those of the edge beyond its tail, flat ones included: a query may end at any
/// of them. n_left + n_right cancels for a thin plate; minus the sum of the inward side directions has the same direction and does
/// not.
fn bevel_of(edge: &Edge, vertices: impl Iterator<Item = u32>, rises: &mut RiseBounds) -> Bevel {
    let normal = unit(&(plane_normal(&edge.planes, 2) + plane_normal(&edge.planes, 3)));
    // No limit: the exterior angles of the sharp edges at a vertex sum to less than 2π, so there are at most three.
    let rise = rises.rise(&normal, edge.tail(), usize::MAX).unwrap_or(f64::INFINITY);
    let fall = rises.fall(&normal, edge.tail(), vertices);
    Bevel { normal, slack: (rise + fall) * (1.0 + 4.0 * UNIT_ROUNDOFF) }
}
