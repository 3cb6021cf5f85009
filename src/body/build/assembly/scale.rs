//! Bodies of extreme size are laid out near size 1 and scaled back.

use crate::base::error::Result;
use crate::base::math::{Vector, binary_order, power_of_two};
use crate::base::memory::collected;
use crate::body::build::mass::bounding_box;
use crate::body::polyhedron::{LARGEST, MassProperties, PlaneBlock, Polyhedron, SMALLEST};

/// 1, or the power of two that brings a very large or very small body to a size near 1. In between squares of lengths and
/// products of planes with points can do no harm by overflow, nor by underflow next to u·ρ.
pub fn factor_to_middle_scale(points: &[Vector]) -> f64 {
    let size = points.iter().map(|p| p.amax()).fold(0.0, f64::max);
    if size == 0.0 || (SMALLEST..=LARGEST).contains(&size) {
        return 1.0;
    }
    power_of_two(-binary_order(size).clamp(-1000, 1000))
}

/// Undoes the scaling of a polyhedron that was laid out about the local origin, and whose labels are still indices of the points.
/// Vertices come back exactly and bounds remain bounds; the other values lost to underflow or overflow are data for a search that
/// bodies of such a size are too large or too small for anyway.
pub fn scale_back(polyhedron: &mut Polyhedron, centred: &[Vector], centre: Vector, factor: f64) -> Result<()> {
    for (vertex, label) in polyhedron.vertices.iter_mut().zip(&polyhedron.vertex_labels) {
        vertex.position = centred[*label as usize];
    }
    let bound = |x: &mut f64| *x = (*x * factor).next_up();
    let scale_block = |block: &mut PlaneBlock| block.offset.iter_mut().for_each(|x| *x *= factor);
    for edge in &mut polyhedron.edges {
        scale_block(&mut edge.planes);
        edge.length *= factor;
        edge.tail_position = polyhedron.vertices[edge.tail() as usize].position;
        bound(&mut edge.slack);
    }
    for face in &mut polyhedron.faces {
        scale_block(&mut face.planes);
        bound(&mut face.slack);
    }
    polyhedron.more_sides.iter_mut().for_each(scale_block);
    polyhedron.polygon_corners.iter_mut().for_each(|corner| *corner *= factor);
    polyhedron.bevels.iter_mut().for_each(|bevel| bound(&mut bevel.slack));
    bound(&mut polyhedron.radius);
    let positions: Vec<Vector> = collected(polyhedron.vertices.iter().map(|v| v.position))?;
    let [lower, upper] = bounding_box(&positions).map(|corner| corner + centre);
    let mass = &polyhedron.mass;
    polyhedron.centre = centre;
    polyhedron.mass = MassProperties {
        volume: mass.volume * factor * factor * factor,
        centre_of_mass: mass.centre_of_mass * factor + centre,
        radius: mass.radius * factor,
        lower,
        upper,
    };
    Ok(())
}
