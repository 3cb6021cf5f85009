//! Surfaces in convex pieces.

use std::ffi::c_void;

use super::arrays::{CMesh, check_capacity, read_mesh};
use super::failure::{Failure, StatusCode};
use super::guard::guard;
use super::shape_options::{ProgressCallback, in_steps};
use crate::body::decomposition::decompose;

/// Output of swiftprox_mesh_decompose: the triangles of a surface, piece by piece. The caller owns the arrays.
#[derive(Debug, Clone, Copy)]
#[repr(C)]
pub struct CDecomposition {
    /// Receives 3 vertex numbers per triangle, counter-clockwise seen from outside, piece by piece. Equal vertices get the number
    /// of the first. Room: 3 * capacity numbers.
    pub corners: *mut u32,
    /// Receives the mesh face of each triangle; may be null.
    pub faces: *mut u32,
    /// Receives the piece number of each triangle, ascending from 0; may be null.
    pub pieces: *mut u32,
    /// Room of the arrays in triangles. The sum of (corners - 2) over all faces of three or more corners is always enough.
    pub capacity: usize,
    /// Receives the number of triangles; 0 on failure.
    pub triangle_count: usize,
    /// Receives the number of pieces; 0 on failure.
    pub piece_count: usize,
}

/// Cuts the surface of a mesh into convex pieces, as the decomposer of SWIFT++ did. The mesh need not be convex or connected.
/// Each triangle belongs to one piece and lies on that piece's convex hull.
///
/// For closed surfaces with outward faces the hulls stay inside the body, so separated bodies have the distance of their
/// pieces. Pieces need not fill the body: a body wholly inside another may touch no piece. Open surfaces and cavities become
/// flat pieces. A mesh with all closed parts inside out is turned.
///
/// Make a shape of each piece with swiftprox_shape_create_from_mesh: same vertices, its triangles, no valences, input =
/// SWIFTPROX_INPUT_PATCH. Pass all shapes to swiftprox_scene_add_object.
///
/// Faces must be nearly flat. `convexity_tolerance` is relative to the bounding-box diagonal: points that close to a plane
/// count as on it. 0 is exact, but splits flat faces with rounded vertices; swiftprox_mesh_estimate_tolerance suggests a value.
/// For solid pieces use swiftprox_compound_create_from_mesh with a tolerance above 0.
/// Time is at worst quadratic, one to two seconds for 10,000 triangles. `progress` may be null.
///
/// SWIFTPROX_ERROR_MESH: a coordinate is not finite, an index is out of range, a face crosses itself, no face has an area, or
/// an edge has more than two faces or two in one direction. SWIFTPROX_ERROR_INVALID_ARGUMENT: the tolerance is outside [0, 1],
/// or capacity is too small. Then the arrays are unchanged, and the message gives the room needed.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn swiftprox_mesh_decompose(
    mesh: CMesh,
    convexity_tolerance: f64,
    progress: ProgressCallback,
    progress_user: *mut c_void,
    decomposition: *mut CDecomposition,
) -> StatusCode {
    guard(|| {
        // SAFETY: the header's pointer rules: the caller's struct is valid, and nobody else uses it.
        let output = unsafe { decomposition.as_mut() }.ok_or_else(|| Failure::null("decomposition"))?;
        (output.triangle_count, output.piece_count) = (0, 0);
        // SAFETY: the header's pointer rules.
        let mesh = unsafe { read_mesh(mesh) }?;
        if output.corners.is_null() {
            return Err(Failure::null("decomposition->corners"));
        }
        let found = in_steps(progress, progress_user, |progress| decompose(&mesh, convexity_tolerance, progress))?;
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
