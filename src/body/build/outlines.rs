//! The corners of a small body's faces.

use crate::base::error::Result;
use crate::base::math::Vector;
use crate::base::memory::{collected, extend, push};
use crate::body::polyhedron::fan::PointBlock;
use crate::body::polyhedron::outlines::Outlines;
use crate::body::polyhedron::{MOST_IN_BLOCKS, Polyhedron};

/// Those of a body.
///
/// # Errors
/// [`Error::Memory`](crate::base::error::Error::Memory).
pub fn outlines_of(polyhedron: &Polyhedron) -> Result<Outlines> {
    let mut outlines = Outlines::default();
    if polyhedron.dimension < 3 || polyhedron.vertices.len() > MOST_IN_BLOCKS {
        return Ok(outlines);
    }
    let sum: Vector = polyhedron.vertices.iter().map(|vertex| vertex.position).sum();
    outlines.middle = sum / polyhedron.vertices.len() as f64;
    outlines.shortest = polyhedron.edges.iter().map(|edge| edge.length).fold(f64::INFINITY, f64::min);
    for (face, record) in (0..).zip(&polyhedron.faces) {
        push(&mut outlines.starts, outlines.vertices.len() as u32)?;
        let fours = (0..record.side_count)
            .step_by(4)
            .map(|first| [0, 1, 2, 3].map(|lane| polyhedron.corner(face, (first + lane).min(record.side_count - 1))));
        extend(&mut outlines.vertices, fours)?;
    }
    push(&mut outlines.starts, outlines.vertices.len() as u32)?;
    outlines.blocks = collected(outlines.vertices.iter().map(|four| {
        let of = |axis: usize| four.map(|v| polyhedron.vertices[v as usize].position[axis]);
        PointBlock { x: of(0), y: of(1), z: of(2) }
    }))?;
    Ok(outlines)
}
