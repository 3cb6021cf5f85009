//! Surfaces in convex pieces.

use std::ffi::c_void;

use super::arrays::{check_capacity, read_arrays};
use super::failure::{Failure, StatusCode};
use super::guard::guard;
use super::shape_options::{ProgressCallback, in_steps};
use crate::decomposition::decompose;

/// Where swiftprox_mesh_decompose writes the triangles of a surface, piece by piece. The arrays are the caller's.
#[derive(Debug, Clone, Copy)]
#[repr(C)]
pub struct CDecomposition {
    /// Receives the vertices of each triangle, 3 * capacity numbers, counter-clockwise seen from outside: those of one piece
    /// follow each other. Of exactly equal vertices the first is named.
    pub corners: *mut u32,
    /// Receives for each triangle the face of the mesh that it is a part of, or is null.
    pub faces: *mut u32,
    /// Receives for each triangle the number of its piece, ascending from 0, or is null.
    pub pieces: *mut u32,
    /// Triangles for which the arrays have room. Two fewer than corners, summed over the faces of three or more, are always
    /// enough.
    pub capacity: usize,
    /// Receives the number of triangles; 0 on failure.
    pub triangle_count: usize,
    /// Receives the number of pieces; 0 on failure.
    pub piece_count: usize,
}

/// Cuts the surface of a mesh into convex pieces, as the decomposer of SWIFT++ did. The mesh need not be convex, and may be in
/// several parts. Each triangle of the surface is in one piece; the piece's body is the convex hull of its triangles, which lie
/// on that hull.
///
/// Of a closed surface, outside of which its faces run counter-clockwise, the hulls are inside of the body: bodies that are apart
/// are as far apart as their pieces. Pieces may overlap, and need not fill the body, so that a body wholly inside of another may
/// not meet one of its pieces. Surfaces without inside, which are open, or cavities, become flat pieces. A mesh whose closed
/// parts are all inside out is turned.
///
/// For an object of a scene make a shape of each piece k with swiftprox_shape_create_from_mesh: the same vertices, the corners of
/// the piece's triangles, no valences, input = SWIFTPROX_INPUT_PATCH; and hand all of them to swiftprox_scene_add_object.
///
/// `vertices`, `indices` and `valences` are as swiftprox_shape_create_from_mesh takes them; a face need not be convex, and is to
/// be flat about. `tolerance` is relative to the bounding box's diagonal: what is that close to a plane counts as on it, and a
/// piece may be about that far beyond the surface; 0 is exact. swiftprox_mesh_estimate_tolerance says what the coordinates
/// excuse. Without it, plane faces that were turned and rounded come to pieces. It takes time in proportion to the square of the
/// triangles at worst, one to two seconds for 10,000. `progress` learns how far it is and can cancel it, or is null;
/// `progress_user` is handed to it.
///
/// SWIFTPROX_ERROR_MESH: a coordinate is not finite; an index is out of range; an edge belongs to more than two faces, or to two in
/// the same direction; a face crosses itself; no face has an area: the message names face, edge or vertex.
/// SWIFTPROX_ERROR_INVALID_ARGUMENT: tolerance is out of [0, 1], or capacity is too small: nothing is written to the arrays, and
/// the message says how many are needed.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn swiftprox_mesh_decompose(
    vertices: *const f64,
    vertex_count: usize,
    indices: *const u32,
    valences: *const u32,
    face_count: usize,
    tolerance: f64,
    progress: ProgressCallback,
    progress_user: *mut c_void,
    decomposition: *mut CDecomposition,
) -> StatusCode {
    guard(|| {
        // SAFETY: the header's pointer rules: the caller's struct is valid, and nobody else uses it.
        let output = unsafe { decomposition.as_mut() }.ok_or_else(|| Failure::null("decomposition"))?;
        (output.triangle_count, output.piece_count) = (0, 0);
        // SAFETY: the header's pointer rules.
        let mesh = unsafe { read_arrays(vertices, vertex_count, indices, valences, face_count) }?;
        if output.corners.is_null() {
            return Err(Failure::null("decomposition->corners"));
        }
        let found = in_steps(progress, progress_user, |progress| decompose(&mesh, tolerance, progress))?;
        check_capacity(output.corners, "decomposition->corners", output.capacity, found.triangles.len())?;
        for (t, corners) in found.triangles.iter().enumerate() {
            // SAFETY: t is below the capacity.
            unsafe { output.corners.cast::<[u32; 3]>().add(t).write(*corners) };
        }
        for (piece, ends) in (0..).zip(found.starts.windows(2)) {
            for t in ends[0] as usize..ends[1] as usize {
                if !output.faces.is_null() {
                    // SAFETY: t is below the capacity.
                    unsafe { output.faces.add(t).write(found.faces[t]) };
                }
                if !output.pieces.is_null() {
                    // SAFETY: t is below the capacity.
                    unsafe { output.pieces.add(t).write(piece) };
                }
            }
        }
        (output.triangle_count, output.piece_count) = (found.triangles.len(), found.piece_count());
        Ok(())
    })
}
