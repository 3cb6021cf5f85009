//! The fan of a small body ([`Fan`]), and the proof that it covers the sphere of directions.
//!
//! Around a corner the arcs between its faces' normals make a loop, for each face has two sides there. All these normals look
//! along one axis, so that the loop bounds a patch of the sphere within the cone of the normals. The loops of all corners cancel:
//! each arc is walked once from either end of its edge. So the patches are a closed surface that winds around the sphere equally
//! often about every direction, up to those on arcs. It does so about one generic direction, which is counted; then each direction
//! is in the patch of a corner, or in the closure of one.

use crate::base::double_double::{DoubleDouble, wide_dot, widen};
use crate::base::error::Result;
use crate::base::math::{Vector, power_of_two};
use crate::base::memory::{collected, copied, filled, with_capacity};
use crate::body::polyhedron::fan::{FaceBlock, Fan, FanEdge, MOST_CORNERS, MOST_EDGES, MOST_FACES, PointBlock};
use crate::body::polyhedron::{LARGEST, Polyhedron, SMALLEST};

/// The greatest κ: a corner whose normals are farther from their axis, by more than 89°, is a needle's tip or on a blade's edge.
const MOST_SPREAD: f64 = 64.0;

/// An upper bound of |Rᵀn| for a unit vector n and an accepted R, and of its reciprocal.
const STRETCH: f64 = 1.016;

/// The fan of a body; `None` for bodies without interior, with many corners, with a needle's tip, and beyond the range of double
/// precision's error bounds.
///
/// # Errors
/// [`Error::Memory`](crate::base::error::Error::Memory).
pub fn fan_of(polyhedron: &Polyhedron) -> Result<Option<Fan>> {
    let is_small = polyhedron.dimension == 3
        && polyhedron.corner_count() <= MOST_CORNERS
        && polyhedron.faces.len() <= MOST_FACES
        && polyhedron.edges.len() <= MOST_EDGES
        && (SMALLEST..=LARGEST).contains(&polyhedron.radius);
    if !is_small {
        return Ok(None);
    }
    let mut corners = collected(polyhedron.edges.iter().flat_map(|edge| [edge.tail(), edge.head()]))?;
    corners.sort_unstable();
    corners.dedup();
    let Some(arcs) = arcs_around_corners(polyhedron, &corners)? else { return Ok(None) };
    let axes = axes_of(&arcs, corners.len())?;
    let reaches = collected(polyhedron.faces.iter().map(|face| reach_along(polyhedron, &face.normal)))?;
    // For each corner κ, rounded up, and how far the planes of its faces are beyond it.
    let (mut spreads, mut misses) = (filled(0.0_f64, corners.len())?, filled(0.0_f64, corners.len())?);
    for arc in &arcs {
        let (normal, position) = (&arc.normals[0], polyhedron.vertices[corners[arc.corner] as usize].position);
        let spread = (1.0 + 1e-12) / axes[arc.corner].dot(normal);
        // Infinite for a NaN.
        let spread = if spread > 0.0 { spread } else { f64::INFINITY };
        spreads[arc.corner] = spreads[arc.corner].max(spread);
        let miss = (reaches[arc.faces[0] as usize] - wide_dot(&widen(normal), &widen(&position))).hi;
        misses[arc.corner] = misses[arc.corner].max(miss + power_of_two(-90) * polyhedron.radius);
    }
    let face_slack = misses.iter().copied().fold(0.0, f64::max);
    let slack_of = |corner: usize| STRETCH * spreads[corner] * misses[corner];
    if !(spreads.iter().all(|spread| *spread <= MOST_SPREAD) && covers_sphere(&arcs, &axes)) {
        return Ok(None);
    }
    let corner_of = |vertex: u32| corners.binary_search(&vertex).unwrap_or(0) as u8;
    let edges = collected(polyhedron.edges.iter().map(|edge| FanEdge {
        direction: Vector::new(edge.planes.x[0], edge.planes.y[0], edge.planes.z[0]),
        // Both ends are on both faces up to σ: n = s·a + t·b has s + t ≤ κ|n|, and |n·(head − tail)| ≤ (s + t)σ.
        lean: slack_of(corner_of(edge.tail()).into()).max(slack_of(corner_of(edge.head()).into())) / edge.length,
        faces: [edge.left() as u8, edge.right() as u8],
        corners: [corner_of(edge.tail()), corner_of(edge.head())],
    }))?;
    Ok(Some(Fan {
        points: point_blocks(polyhedron, &corners)?,
        planes: plane_blocks(polyhedron, &reaches)?,
        edges,
        face_slack,
        cell_slack: (0..corners.len()).map(slack_of).fold(0.0, f64::max),
        corners,
    }))
}

/// An arc as seen from a corner: from the right face of an edge to the left one, looking out along the edge.
struct Arc {
    corner: usize,
    faces: [u32; 2],
    normals: [Vector; 2],
}

/// The arcs around all corners; `None` unless they make closed loops.
fn arcs_around_corners(polyhedron: &Polyhedron, corners: &[u32]) -> Result<Option<Vec<Arc>>> {
    let mut arcs = with_capacity(2 * polyhedron.edges.len())?;
    for edge in &polyhedron.edges {
        let ends = [(edge.tail(), [edge.right(), edge.left()]), (edge.head(), [edge.left(), edge.right()])];
        for (vertex, faces) in ends {
            let Ok(corner) = corners.binary_search(&vertex) else { return Ok(None) };
            let normals = faces.map(|face| polyhedron.faces[face as usize].normal);
            arcs.push(Arc { corner, faces, normals });
        }
    }
    // Every face that is left towards is left from as often.
    let mut ends = with_capacity(2 * arcs.len())?;
    ends.extend(arcs.iter().flat_map(|arc| [(arc.corner, arc.faces[0], -1), (arc.corner, arc.faces[1], 1)]));
    ends.sort_unstable();
    let is_closed =
        ends.chunk_by(|a, b| (a.0, a.1) == (b.0, b.1)).all(|same| same.iter().map(|end| end.2).sum::<i32>() == 0);
    Ok(is_closed.then_some(arcs))
}

/// For each corner, a unit vector that all of its faces' normals look along, as closely as it is found: from their sum on towards
/// the centre of the least ball around them (Bădoiu and Clarkson 2003). The sum alone need not be one: at the base of a pyramid
/// two steep sides outweigh the base.
fn axes_of(arcs: &[Arc], count: usize) -> Result<Vec<Vector>> {
    let mut axes = filled(Vector::zeros(), count)?;
    for arc in arcs {
        axes[arc.corner] += arc.normals[0] + arc.normals[1];
    }
    axes.iter_mut().for_each(|axis| *axis /= axis.norm());
    let (mut best, mut centres) = (filled((f64::NEG_INFINITY, Vector::zeros()), count)?, copied(&axes)?);
    // For each corner, the least product of its axis with a normal, and that normal.
    let mut least = filled((f64::INFINITY, Vector::zeros()), count)?;
    for round in 1..=ROUNDS_OF_CENTRES {
        least.fill((f64::INFINITY, Vector::zeros()));
        for arc in arcs {
            let product = axes[arc.corner].dot(&arc.normals[0]);
            if product < least[arc.corner].0 {
                least[arc.corner] = (product, arc.normals[0]);
            }
        }
        for (corner, &(product, normal)) in least.iter().enumerate() {
            if product > best[corner].0 {
                best[corner] = (product, axes[corner]);
            }
            let centre = centres[corner];
            centres[corner] = centre + (normal - centre) / f64::from(1 + round);
            axes[corner] = centres[corner] / centres[corner].norm();
        }
    }
    collected(best.into_iter().map(|(_, axis)| axis))
}

/// Steps towards the centre of a least ball: after so many it is found to one part in eight of the ball's radius.
const ROUNDS_OF_CENTRES: u32 = 64;

/// Directions without symmetry, one of which is to be clear of all arcs.
const GENERIC: [[f64; 3]; 4] =
    [[0.2137, 0.5411, 0.8131], [-0.7419, 0.3137, 0.5923], [0.6131, -0.7717, 0.1693], [-0.3319, -0.4273, -0.8423]];

/// A determinant of unit vectors beyond this has the right sign.
const CLEAR: f64 = 1e-12;

/// Whether the patches go round the sphere: whether their signed number about a direction is not 0.
fn covers_sphere(arcs: &[Arc], axes: &[Vector]) -> bool {
    let windings = GENERIC.iter().map(|g| winding_about(&Vector::from(*g), arcs, axes));
    windings.flatten().next().is_some_and(|winding| winding != 0)
}

/// How often the patches wind around a direction, each patch as triangles from its axis to its arcs; `None` if it meets the side of
/// one.
fn winding_about(g: &Vector, arcs: &[Arc], axes: &[Vector]) -> Option<i32> {
    let mut winding = 0;
    for arc in arcs {
        let (q, [a, b]) = (&axes[arc.corner], &arc.normals);
        let sides = [g.dot(&a.cross(b)), q.dot(&g.cross(b)), q.dot(&a.cross(g))];
        // All three look along the axis: a direction that looks back from it is in the opposite triangle at most.
        if g.dot(q) <= 0.0 || (sides.iter().any(|x| *x > CLEAR) && sides.iter().any(|x| *x < -CLEAR)) {
            continue;
        }
        if sides.iter().any(|x| x.abs() <= CLEAR) {
            return None;
        }
        winding += if sides[0] > 0.0 { 1 } else { -1 };
    }
    Some(winding)
}

fn point_blocks(polyhedron: &Polyhedron, corners: &[u32]) -> Result<Vec<PointBlock>> {
    collected(corners.chunks(4).map(|four| {
        let of = |axis: usize| {
            std::array::from_fn(|i| polyhedron.vertices[four[i.min(four.len() - 1)] as usize].position[axis])
        };
        PointBlock { x: of(0), y: of(1), z: of(2) }
    }))
}

/// How far a body reaches along a direction of about unit length: right to 2⁻⁹⁹ρ.
fn reach_along(polyhedron: &Polyhedron, direction: &Vector) -> DoubleDouble {
    let wide = widen(direction);
    let products = polyhedron.vertices.iter().map(|vertex| wide_dot(&wide, &widen(&vertex.position)));
    let farther = |a: DoubleDouble, b: DoubleDouble| if (b - a).hi > 0.0 { b } else { a };
    products.reduce(farther).unwrap_or_default()
}

fn plane_blocks(polyhedron: &Polyhedron, reaches: &[DoubleDouble]) -> Result<Vec<FaceBlock>> {
    collected(polyhedron.faces.chunks(4).zip(reaches.chunks(4)).map(|(four, reaches)| {
        let at = |i: usize| i.min(four.len() - 1);
        let of = |axis: usize| std::array::from_fn(|i| four[at(i)].normal[axis]);
        FaceBlock { x: of(0), y: of(1), z: of(2), reach: std::array::from_fn(|i| reaches[at(i)].hi) }
    }))
}
