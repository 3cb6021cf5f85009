//! The corners of a small body's faces and contact faces.

use crate::base::error::Result;
use crate::base::math::Vector;
use crate::base::memory::{collected, extend, push};
use crate::body::polyhedron::fan::PointBlock;
use crate::body::polyhedron::outlines::Outlines;
use crate::body::polyhedron::{ContactFaces, MOST_IN_BLOCKS, PlaneBlock, Polyhedron};

/// Those of a body.
///
/// # Errors
/// [`Error::Memory`](crate::base::error::Error::Memory).
pub fn outlines_of(polyhedron: &Polyhedron) -> Result<Outlines> {
    let mut outlines = Outlines::default();
    if polyhedron.dimension < 3 {
        return Ok(outlines);
    }
    let sum: Vector = polyhedron.vertices.iter().map(|vertex| vertex.position).sum();
    outlines.middle = sum / polyhedron.vertices.len() as f64;
    outlines.shortest = polyhedron.edges.iter().map(|edge| edge.length).fold(f64::INFINITY, f64::min);
    if polyhedron.vertices.len() > MOST_IN_BLOCKS {
        return Ok(outlines);
    }
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

/// Gives a polyhedron contact faces. Their corners are put into the plane in the middle of the slab, along its normal: seen from
/// anywhere they are a convex polygon.
///
/// # Errors
/// [`Error::Memory`](crate::base::error::Error::Memory).
pub fn give_contact_faces(polyhedron: &mut Polyhedron, found: ContactFaces) -> Result<()> {
    let outlines = &mut polyhedron.outlines;
    let are_kept = !outlines.is_empty();
    for face in found.faces.iter().filter(|_| are_kept) {
        let own = &found.corners[face.first_corner as usize..][..face.corner_count as usize];
        let on_plane = |vertex: u32| {
            let position = polyhedron.vertices[vertex as usize].position;
            position - face.normal * (face.normal.dot(&position) - face.middle)
        };
        for first in (0..own.len()).step_by(4) {
            let four = [0, 1, 2, 3].map(|lane| (first + lane).min(own.len() - 1));
            let corners = four.map(|corner| on_plane(own[corner]));
            let sides = four.map(|corner| on_plane(own[(corner + 1) % own.len()]) - on_plane(own[corner]));
            let inward = sides.map(|side| face.normal.cross(&side).normalize());
            outlines.shortest = sides.iter().map(|side| side.norm()).fold(outlines.shortest, f64::min);
            let of = |vectors: &[Vector; 4], axis: usize| vectors.map(|vector| vector[axis]);
            let [x, y, z] = [0, 1, 2].map(|axis| of(&inward, axis));
            let offset = std::array::from_fn(|lane| -inward[lane].dot(&corners[lane]));
            push(&mut outlines.contact_sides, PlaneBlock { x, y, z, offset })?;
            let [x, y, z] = [0, 1, 2].map(|axis| of(&corners, axis));
            push(&mut outlines.blocks, PointBlock { x, y, z })?;
            push(&mut outlines.vertices, four.map(|corner| own[corner]))?;
        }
        push(&mut outlines.starts, outlines.vertices.len() as u32)?;
    }
    polyhedron.contact_faces = found;
    Ok(())
}
