//! Arrays and paths that C hands over, and arrays that it has room for.

use std::ffi::c_char;
use std::path::Path;

use super::failure::{Checked, Failure, StatusCode};
use super::pointers::{array, string};
use crate::base::math::Vector;
use crate::base::memory::{collected, copied};
use crate::body::mesh::PolygonMesh;
use crate::body::polyhedron::Polyhedron;

/// Copies vertices in the local frame.
///
/// # Safety
/// `vertices` has room for `capacity` vertices or is null.
pub(super) unsafe fn copy_vertices(polyhedron: &Polyhedron, vertices: *mut f64, capacity: usize) -> Checked<()> {
    check_capacity(vertices, "vertices", capacity, polyhedron.vertices.len())?;
    for i in 0..polyhedron.vertices.len() {
        let point: [f64; 3] = polyhedron.local_position(i as u32).into();
        // SAFETY: not null, and i < capacity.
        unsafe { vertices.cast::<[f64; 3]>().add(i).write(point) };
    }
    Ok(())
}

/// Copies triangles.
///
/// # Safety
/// `corners` has room for `capacity` triangles or is null.
pub(super) unsafe fn copy_triangles(polyhedron: &Polyhedron, corners: *mut u32, capacity: usize) -> Checked<()> {
    let triangles = &polyhedron.triangles;
    check_capacity(corners, "corners", capacity, triangles.len())?;
    // SAFETY: not null, room for the triangles, and the caller's array is not ours.
    unsafe { corners.cast::<[u32; 3]>().copy_from_nonoverlapping(triangles.as_ptr(), triangles.len()) };
    Ok(())
}

/// A polygon mesh, an argument by value. The caller owns the arrays.
#[derive(Debug, Clone, Copy)]
#[repr(C)]
pub struct CMesh {
    /// 3 * vertex_count coordinates.
    pub vertices: *const f64,
    /// Number of vertices.
    pub vertex_count: usize,
    /// 0-based vertex numbers of all faces in turn, counter-clockwise seen from outside.
    pub indices: *const u32,
    /// Number of vertices of each face; null means triangles.
    pub valences: *const u32,
    /// Number of faces.
    pub face_count: usize,
}

/// A mesh from a caller's arrays.
///
/// # Safety
/// The arrays meet the header's pointer rules.
pub(super) unsafe fn read_mesh(mesh: CMesh) -> Checked<PolygonMesh> {
    let CMesh { vertices, vertex_count, indices, valences, face_count } = mesh;
    check_count(vertex_count, "mesh.vertex_count")?;
    // SAFETY: by the caller.
    let (faces, points) =
        unsafe { (read_faces(indices, valences, face_count)?, read_vectors(vertices, vertex_count, "mesh.vertices")?) };
    Ok(PolygonMesh::new(points, copied(faces.indices)?, faces.valences)?)
}

/// Faces in a caller's arrays.
pub(super) struct Faces<'a> {
    pub indices: &'a [u32],
    /// Without it all are triangles.
    pub valences: Option<&'a [u32]>,
}

/// Faces from a caller's arrays.
///
/// # Safety
/// The arrays meet the header's pointer rules for `'a`.
pub(super) unsafe fn read_faces<'a>(
    indices: *const u32,
    valences: *const u32,
    face_count: usize,
) -> Checked<Faces<'a>> {
    check_count(face_count, "face_count")?;
    // SAFETY: by the caller.
    let given = |pointer| unsafe { array(pointer, face_count, "valences") };
    let valences: Option<&[u32]> = if valences.is_null() { None } else { Some(given(valences)?) };
    let corners = match valences {
        None => 3 * face_count as u64,
        Some(valences) => valences.iter().map(|&valence| u64::from(valence)).sum(),
    };
    // Before anything is read: a wrong valence must not make us read beyond the caller's array.
    let corners = usize::try_from(corners).unwrap_or(usize::MAX);
    check_count(corners, "the number of indices")?;
    // SAFETY: by the caller.
    Ok(Faces { indices: unsafe { array(indices, corners, "indices") }?, valences })
}

/// Points from a caller's array of coordinates.
///
/// # Safety
/// `coordinates` meets the header's pointer rules.
pub(super) unsafe fn read_vectors(coordinates: *const f64, count: usize, name: &str) -> Checked<Vec<Vector>> {
    check_count(count, "the number of points")?;
    // SAFETY: by the caller; three doubles are as aligned as one.
    let points = unsafe { array(coordinates.cast::<[f64; 3]>(), count, name) }?;
    Ok(collected(points.iter().map(|&point| Vector::from(point)))?)
}

/// No system takes a longer path: such a one is no path, and too long for a message.
const LONGEST_PATH: usize = 1 << 15;

/// A path from a caller's string.
///
/// # Safety
/// `path` meets the header's pointer rules.
pub(super) unsafe fn read_path<'a>(path: *const c_char) -> Checked<&'a Path> {
    // SAFETY: by the caller.
    let path = unsafe { string(path, "path") }?;
    let length = path.to_bytes().len();
    if length > LONGEST_PATH {
        let message = format!("the path has {length} bytes, more than {LONGEST_PATH}");
        return Err(Failure::new(StatusCode::ErrorInvalidArgument, message));
    }
    #[cfg(unix)]
    return Ok(Path::new(<std::ffi::OsStr as std::os::unix::ffi::OsStrExt>::from_bytes(path.to_bytes())));
    #[cfg(not(unix))]
    return match path.to_str() {
        Ok(path) => Ok(Path::new(path)),
        Err(_) => Err(Failure::new(StatusCode::ErrorInvalidArgument, "the path is not UTF-8")),
    };
}

/// Refuses counts that do not fit 32 bits before anything is read: they are overflows or negative numbers of the caller.
pub(super) fn check_count(count: usize, name: &str) -> Checked<()> {
    if count > u32::MAX as usize {
        let message = format!("{name} is {count}, more than the limit of {}", u32::MAX);
        return Err(Failure::new(StatusCode::ErrorLimit, message));
    }
    Ok(())
}

/// Refuses null or too little room.
pub(super) fn check_capacity<T>(pointer: *mut T, name: &str, capacity: usize, needed: usize) -> Checked<()> {
    if pointer.is_null() {
        return Err(Failure::null(name));
    }
    if capacity < needed {
        let message = format!("`{name}` has room for {capacity}, {needed} are needed");
        return Err(Failure::new(StatusCode::ErrorInvalidArgument, message));
    }
    Ok(())
}
