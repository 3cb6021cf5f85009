//! Tests of Voronoi regions: planes around edges and faces, neighbours around vertices, prisms over faces.

use crate::math::{UNIT_ROUNDOFF, Vector};
use crate::polyhedron::{Face, NONE, NeighbourBlock, PlaneBlock, Polyhedron};
use crate::simd::Lanes;

/// How far a vertex's neighbours lie in a direction.
#[derive(Clone, Copy)]
pub enum VertexTest {
    /// All strictly behind, rounding included.
    Strict,
    /// None ahead by more than the tolerance, some not strictly behind.
    Tied,
    /// One is ahead: the edge to it, or NONE where there is no edge between merged faces, and the neighbour.
    Leaves {
        /// The edge, or NONE.
        edge: u32,
        /// The neighbour.
        head: u32,
    },
}

/// Relative error of a computed slope g·ê: 6u of g = RᵀU for |U|, 3u of the stored unit direction, 3u of the product, and
/// the second order; g's length is bounded by its 1-norm.
pub const STRICT: f64 = 16.0 * UNIT_ROUNDOFF;

/// Tests all neighbours of a vertex in direction g (towards the other body), whose length is at most `length`.
#[inline(always)]
pub fn test_vertex<L: Lanes>(polyhedron: &Polyhedron, vertex: u32, g: L, length: f64, tolerance: f64) -> VertexTest {
    let block = &polyhedron.neighbours[vertex as usize];
    let [low, high] = slopes(block, g);
    let strict = L::splat(-STRICT * length);
    let more = polyhedron.vertices[vertex as usize].more;
    if low.greater(strict) | high.greater(strict) | more == 0 {
        return VertexTest::Strict;
    }
    test_vertex_further(polyhedron, vertex, g, length, tolerance)
}

/// The rest of [`test_vertex`]: some neighbour is not strictly behind, or there are more than eight.
#[inline(always)]
fn test_vertex_further<L: Lanes>(
    polyhedron: &Polyhedron,
    vertex: u32,
    g: L,
    length: f64,
    tolerance: f64,
) -> VertexTest {
    let (slope, edge, head) = steepest(polyhedron, vertex, g);
    if slope < -STRICT * length {
        VertexTest::Strict
    } else if slope <= tolerance {
        VertexTest::Tied
    } else if edge != NONE {
        VertexTest::Leaves { edge, head }
    } else {
        let [x, y, z, _] = g.to_array();
        leave_by_edge(polyhedron, vertex, Vector::new(x, y, z), tolerance, head)
    }
}

/// The neighbour with the greatest slope g·ê: the slope, the edge to it or NONE, and the neighbour itself.
#[inline(always)]
pub fn steepest<L: Lanes>(polyhedron: &Polyhedron, vertex: u32, g: L) -> (f64, u32, u32) {
    let mut best = steepest_of_block(&polyhedron.neighbours[vertex as usize], g);
    let record = &polyhedron.vertices[vertex as usize];
    for index in record.first_more..record.first_more + record.more {
        let other = steepest_of_block(&polyhedron.more_neighbours[index as usize], g);
        if other.0 > best.0 {
            best = other;
        }
    }
    best
}

/// A vertex farthest in direction g, by steepest hill climbing in plain rounding.
#[inline(always)]
pub fn climb<L: Lanes>(polyhedron: &Polyhedron, g: L, start: u32) -> u32 {
    let mut vertex = start;
    // Rounding could make steps along edges normal to g go round in circles; no path is longer than this.
    for _ in 0..polyhedron.vertices.len() {
        let (slope, _, head) = steepest(polyhedron, vertex, g);
        if slope <= 0.0 {
            break;
        }
        vertex = head;
    }
    vertex
}

#[inline(always)]
fn steepest_of_block<L: Lanes>(block: &NeighbourBlock, g: L) -> (f64, u32, u32) {
    let [low, high] = slopes(block, g);
    let ([a, b, c, d], [e, f, g, h]) = (low.to_array(), high.to_array());
    // A tournament; on a tie the lower lane wins.
    let better = |x: (f64, usize), y: (f64, usize)| if y.0 > x.0 { y } else { x };
    let low = better(better((a, 0), (b, 1)), better((c, 2), (d, 3)));
    let high = better(better((e, 4), (f, 5)), better((g, 6), (h, 7)));
    let (slope, lane) = better(low, high);
    (slope, block.edge[lane & 7], block.head[lane & 7])
}

/// The steepest neighbour is across a merged face: leave by the steepest real edge, or where none rises to the neighbour.
#[cold]
fn leave_by_edge(polyhedron: &Polyhedron, vertex: u32, g: Vector, tolerance: f64, head: u32) -> VertexTest {
    let mut best = (tolerance, VertexTest::Leaves { edge: NONE, head });
    for block in polyhedron.neighbour_blocks(vertex) {
        for lane in 0..8 {
            let slope = block.x[lane] * g.x + block.y[lane] * g.y + block.z[lane] * g.z;
            if slope > best.0 && block.edge[lane] != NONE {
                best = (slope, VertexTest::Leaves { edge: block.edge[lane], head: block.head[lane] });
            }
        }
    }
    best.1
}

/// g·ê for the eight lanes of a block.
#[inline(always)]
fn slopes<L: Lanes>(block: &NeighbourBlock, g: L) -> [L; 2] {
    let (x, y, z) = (g.splat_x(), g.splat_y(), g.splat_z());
    let half = |bx: &[f64; 4], by: &[f64; 4], bz: &[f64; 4]| {
        L::load(bz).mul_add(z, L::load(by).mul_add(y, L::load(bx).mul(x)))
    };
    let (x_low, x_high) = halves(&block.x);
    let (y_low, y_high) = halves(&block.y);
    let (z_low, z_high) = halves(&block.z);
    [half(x_low, y_low, z_low), half(x_high, y_high, z_high)]
}

#[inline(always)]
fn halves(x: &[f64; 8]) -> (&[f64; 4], &[f64; 4]) {
    let (parts, _) = x.as_chunks::<4>();
    (&parts[0], &parts[1])
}

/// Values of the four planes at a point.
#[inline(always)]
pub fn plane_values<L: Lanes>(planes: &PlaneBlock, point: L) -> L {
    let part = L::load(&planes.x).mul_add(point.splat_x(), L::load(&planes.offset));
    let part = L::load(&planes.y).mul_add(point.splat_y(), part);
    L::load(&planes.z).mul_add(point.splat_z(), part)
}

/// Products of the four normals with a direction.
#[inline(always)]
pub fn plane_slopes<L: Lanes>(planes: &PlaneBlock, direction: L) -> L {
    let part = L::load(&planes.x).mul(direction.splat_x());
    let part = L::load(&planes.y).mul_add(direction.splat_y(), part);
    L::load(&planes.z).mul_add(direction.splat_z(), part)
}

/// The unit direction of an edge.
#[inline(always)]
pub fn edge_direction(planes: &PlaneBlock) -> Vector {
    Vector::new(planes.x[0], planes.y[0], planes.z[0])
}

/// The lane of the least value among those in the mask (lowest lane on a tie).
#[inline(always)]
pub fn most_negative(values: [f64; 4], mask: u32) -> usize {
    let mut best = 0;
    let mut least = f64::INFINITY;
    for (lane, &value) in values.iter().enumerate() {
        if mask & (1 << lane) != 0 && value < least {
            least = value;
            best = lane;
        }
    }
    best
}

/// The side of a face whose plane is violated most, if any is by more than the tolerance. `first` are the values of the face's
/// first block.
#[inline(always)]
pub fn most_violated_side<L: Lanes>(
    polyhedron: &Polyhedron,
    face: &Face,
    first: L,
    point: L,
    tolerance: f64,
) -> Option<u32> {
    let mut worst = (-tolerance, None);
    let mut look = |side: u32, value: f64| {
        if value < worst.0 {
            worst = (value, Some(side));
        }
    };
    let [_, a, b, c] = first.to_array();
    look(0, a);
    look(1, b);
    look(2, c);
    for (index, block) in polyhedron.further_sides(face).iter().enumerate() {
        let values = plane_values(block, point);
        if L::splat(-tolerance).greater(values) != 0 {
            for (lane, value) in values.to_array().into_iter().enumerate() {
                look(3 + 4 * index as u32 + lane as u32, value);
            }
        }
    }
    worst.1
}

/// Where the way from one point to another leaves the prism over a face: the fraction of the way and the side, or (1, None).
/// `skip` is an edge whose side does not count: the way begins on it.
#[inline(always)]
pub fn exit_of_prism<L: Lanes>(
    polyhedron: &Polyhedron,
    face: &Face,
    [from, to]: [L; 2],
    [from_first, to_first]: [L; 2],
    skip: u32,
) -> (f64, Option<u32>) {
    let mut exit = (1.0, None);
    let mut look = |side: u32, start: f64, end: f64| {
        if end < 0.0 && end < start && polyhedron.sides[(face.first_side + side) as usize] != skip {
            let fraction = start.max(0.0) / (start.max(0.0) - end);
            if fraction < exit.0 {
                exit = (fraction, Some(side));
            }
        }
    };
    let (start, end) = (from_first.to_array(), to_first.to_array());
    for lane in 1..4 {
        look(lane as u32 - 1, start[lane], end[lane]);
    }
    for (index, block) in polyhedron.further_sides(face).iter().enumerate() {
        let (start, end) = (plane_values(block, from).to_array(), plane_values(block, to).to_array());
        for lane in 0..4 {
            let side = 3 + 4 * index as u32 + lane as u32;
            if side < face.side_count {
                look(side, start[lane], end[lane]);
            }
        }
    }
    exit
}

/// The end of an edge at which a parameter was clamped.
#[inline(always)]
pub fn end_of(parameter: f64, length: f64, tail: u32, head: u32) -> Option<u32> {
    if parameter <= 0.0 {
        Some(tail)
    } else if parameter >= length {
        Some(head)
    } else {
        None
    }
}
