//! From the triangles of the hull to faces: triangles in one plane up to rounding become one convex polygon, and boundary
//! vertices on a line up to rounding become inner points of one edge.
//!
//! "Up to rounding" is [`merge_bound`]. Nothing that is decided here touches the truth of an answer: the body stays the exact
//! hull, and each face's slack is computed from the plane it gets. Merging saves marching from stepping over edges that the
//! caller never made; too little of it costs steps, too much of it costs width of the interval.

mod faces;
mod corners;
mod regions;

use std::f64::consts::PI;

use crate::base::error::Result;
use crate::base::math::{UNIT_ROUNDOFF, Vector};
use crate::base::memory::{collected, filled, push, with_capacity};
use crate::base::progress::Progress;
use crate::body::polyhedron::NONE;
use crate::body::polyhedron::triangulation::Triangulation;
use corners::straighten_edges;
pub use faces::{MergedFaces, Triangles};
use regions::coplanar_regions;

/// The distance from a plane or a line within which vertices count as lying on it, for vertices within `radius` of the local
/// origin: 16uρ.
///
/// A point of a planar polygon that was rotated in double precision misses the rotated plane by up to 3√3·uρ, typically by
/// uρ; a fourth point misses the plane through three others by that times 1 + Σ|barycentric coordinates|, at most 6 while a
/// region's reference triangle is at least half the largest (`regions.rs`). So planar input comes back whole, while a dihedral
/// angle of 1e-12 on a body of size 1 puts the next vertex 500 times the bound away.
pub fn merge_bound(radius: f64) -> f64 {
    16.0 * UNIT_ROUNDOFF * radius
}

/// Merges the triangles of a hull; `bound` is [`merge_bound`].
///
/// # Errors
/// [`crate::base::error::Error::Cancelled`] when the caller does not want to go on; [`crate::base::error::Error::Memory`].
pub fn merge_faces(triangles: &Triangles, bound: f64, progress: &mut Progress) -> Result<MergedFaces> {
    let &Triangles { surface, positions, normals, .. } = triangles;
    let of_regions = &mut progress.part(0.0, 0.5);
    let (mut region_of, mut region_normals) = coplanar_regions(triangles, bound, of_regions)?;
    let mut first = 0.5;
    loop {
        // Hardly ever a second round.
        let middle = 0.5 * (first + 1.0);
        let progress = &mut progress.part(first, middle);
        first = middle;
        let of_numbers = &mut progress.part(0.0, 0.1);
        let mut faces = number_faces(surface, positions.len(), &region_of, &region_normals, of_numbers)?;
        straighten_edges(surface, positions, &mut faces, bound, &mut progress.part(0.1, 0.7))?;
        start_at_corners(surface, &mut faces)?;
        let mut sizes = filled(0_u32, faces.normals.len())?;
        faces.face_of.iter().for_each(|f| sizes[*f as usize] += 1);
        let mut dented = with_capacity(faces.normals.len())?;
        let of_convexity = &mut progress.part(0.7, 1.0);
        for (face, size) in sizes.iter().enumerate() {
            of_convexity.steps(*size as usize, face, sizes.len())?;
            dented.push(*size > 1 && !is_convex(surface, positions, &faces, face));
        }
        if !dented.contains(&true) {
            return Ok(faces);
        }
        // Back to triangles, which are convex; each round leaves fewer merged faces.
        for (t, region) in region_of.iter_mut().enumerate().filter(|(t, _)| dented[faces.face_of[*t] as usize]) {
            *region = region_normals.len() as u32;
            push(&mut region_normals, normals[t])?;
        }
    }
}

/// Whether a face, which is a disk, is a convex polygon up to rounding: whether it turns left at every corner. A right turn by
/// an angle of 32u still passes: it leaves the farthest corner no more than 64uρ outside the prolonged side. A side as short as
/// the bound may lean out of the plane; beyond 60° it has no good direction within the plane. Where a side comes back on the
/// one before, the corner may be a needle's tip or a spike that sticks out of a face: counted as left turns, spikes wind the
/// sides around the face more than once.
fn is_convex(surface: &Triangulation, positions: &[Vector], faces: &MergedFaces, face: usize) -> bool {
    const SMALLEST_TURN: f64 = -32.0 * UNIT_ROUNDOFF;
    let normal = &faces.normals[face];
    let side = |first: u32| {
        let last = faces.last_of_edge(surface, first);
        let vector = positions[surface.head(last) as usize] - positions[surface.tail(first) as usize];
        (faces.next_on_boundary(surface, last), vector)
    };
    let first = faces.first_half_edges[face];
    let (mut h, mut previous) = side(first);
    let mut corners = 0;
    let mut winding = 0.0;
    loop {
        let (after, vector) = side(h);
        let turn = normal.dot(&previous.cross(&vector));
        if normal.dot(&vector).abs() > 0.87 * vector.norm() {
            return false;
        }
        if turn < SMALLEST_TURN * previous.norm() * vector.norm() {
            return false;
        }
        corners += 1;
        winding += turn.max(0.0).atan2(previous.dot(&vector));
        if h == first {
            return corners >= 3 && winding < 3.0 * PI;
        }
        (h, previous) = (after, vector);
    }
}

/// Numbers the regions in order of their lowest vertex.
fn number_faces(
    surface: &Triangulation,
    vertex_count: usize,
    region_of: &[u32],
    region_normals: &[Vector],
    progress: &mut Progress,
) -> Result<MergedFaces> {
    debug_assert!(region_of.iter().all(|r| (*r as usize) < region_normals.len()));
    let mut number = filled(NONE, region_normals.len())?;
    let mut normals = with_capacity(region_normals.len())?;
    for v in 0..vertex_count as u32 {
        progress.steps(surface.around(v).len(), v as usize, vertex_count)?;
        for &h in surface.around(v) {
            let region = region_of[h as usize / 3] as usize;
            if number[region] == NONE {
                number[region] = normals.len() as u32;
                normals.push(region_normals[region]);
            }
        }
    }
    let face_of = collected(region_of.iter().map(|&r| number[r as usize]))?;
    Ok(MergedFaces { face_of, normals, first_half_edges: Vec::new(), corners: Vec::new() })
}

/// Chooses each face's first half-edge: the first one at a corner, in order of vertices.
fn start_at_corners(surface: &Triangulation, faces: &mut MergedFaces) -> Result<()> {
    let mut first = filled(NONE, faces.normals.len())?;
    for v in (0..faces.corners.len() as u32).filter(|v| faces.corners[*v as usize]) {
        for &h in surface.around(v) {
            if faces.is_boundary(surface, h) && first[faces.left(h) as usize] == NONE {
                first[faces.left(h) as usize] = h;
            }
        }
    }
    faces.first_half_edges = first;
    Ok(())
}
