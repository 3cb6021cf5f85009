//! Levels of detail: those that a caller gives, and what the levels of a shape are.

use super::arrays::{CMesh, copy_triangles, copy_vertices, read_mesh};
use super::failure::{Checked, Failure, StatusCode};
use super::guard::guard;
use super::pointers::{array, handle};
use super::shape::create;
use super::shape_options::{CShapeOptions, read_options};
use super::structs::{Versioned, write_struct};
use crate::base::memory::with_capacity;
use crate::body::polyhedron::Polyhedron;
use crate::shape::Shape;

/// Properties of a level of detail. Set struct_size to sizeof(swiftprox_level_info) before the call.
#[derive(Debug, Clone, Copy)]
#[repr(C)]
pub struct LevelInfo {
    /// Set by the caller.
    pub struct_size: usize,
    /// Vertices of the level's hull.
    pub vertex_count: usize,
    /// Edges between faces that are not coplanar.
    pub edge_count: usize,
    /// Faces; coplanar triangles count as one.
    pub face_count: usize,
    /// Triangles of the level's hull.
    pub triangle_count: usize,
    /// Upper bound of the largest distance of the level's points from the body, rounding included; 0 for level 0, the body.
    pub deviation: f64,
    /// Memory of the level in bytes.
    pub bytes: usize,
}

// SAFETY: repr(C), struct_size first, any bytes are valid.
unsafe impl Versioned for LevelInfo {
    const NAME: &'static str = "swiftprox_level_info";
}

impl LevelInfo {
    /// The info of no level.
    const UNKNOWN: LevelInfo = LevelInfo {
        struct_size: size_of::<LevelInfo>(),
        vertex_count: 0,
        edge_count: 0,
        face_count: 0,
        triangle_count: 0,
        deviation: f64::NAN,
        bytes: 0,
    };
}

/// Creates a shape with the caller's levels of detail, finest first. Release it with swiftprox_shape_release. The arrays are
/// copied. `levels[0]` is the body, as for swiftprox_shape_create_from_mesh. Each other level is the convex hull of its vertices;
/// its faces are ignored. It is moved to the centre of mass of the next finer level and scaled until it bounds the body.
///
/// options->tuning->hierarchy must be SWIFTPROX_HIERARCHY_NONE or automatic. The input transform applies to all levels.
///
/// On failure `*shape` is null. SWIFTPROX_ERROR_MESH: the body breaks the rules of swiftprox_shape_create_from_mesh, or a level has
/// no interior; the message names it.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn swiftprox_shape_create_from_levels(
    levels: *const CMesh,
    level_count: usize,
    options: *const CShapeOptions,
    shape: *mut *const Shape,
) -> StatusCode {
    // SAFETY: the header's pointer rules.
    create(shape, || unsafe {
        let making = read_options(options)?;
        let levels = array(levels, level_count, "levels")?;
        let mut meshes = with_capacity(levels.len())?;
        for (i, level) in levels.iter().enumerate() {
            let read = read_mesh(if i == 0 { *level } else { CMesh { face_count: 0, ..*level } });
            let in_level = |f: Failure| Failure { status: f.status, message: format!("levels[{i}]: {}", f.message) };
            meshes.push(read.map_err(in_level)?);
        }
        Ok(making.run(|options, progress| Shape::from_levels(&meshes, options, progress))?)
    })
}

/// Writes the properties of a level of detail. `level` is from 0, the body, to swiftprox_shape_tuning_info.level_count, the
/// coarsest. Set info->struct_size to sizeof(swiftprox_level_info) first. On failure the deviation is NaN, all else 0.
///
/// SWIFTPROX_ERROR_INVALID_ARGUMENT: there is no such level.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn swiftprox_shape_get_level_info(
    shape: *const Shape,
    level: usize,
    info: *mut LevelInfo,
) -> StatusCode {
    guard(|| {
        // SAFETY: the header's pointer rules.
        unsafe { write_struct(info, "info", &LevelInfo::UNKNOWN) }?;
        // SAFETY: the header's pointer rules.
        let shape = unsafe { handle(shape, "shape") }?;
        let polyhedron = polyhedron_of(shape, level)?;
        let coarse = level.checked_sub(1).map(|i| &shape.hierarchy().levels[i]);
        let value = LevelInfo {
            struct_size: size_of::<LevelInfo>(),
            vertex_count: polyhedron.vertices.len(),
            edge_count: polyhedron.edges.len(),
            face_count: polyhedron.faces.len(),
            triangle_count: polyhedron.triangles.len(),
            deviation: coarse.map_or(0.0, |level| level.deviation),
            bytes: coarse.map_or(size_of::<Polyhedron>() + polyhedron.heap_bytes(), |level| level.bytes()),
        };
        // SAFETY: the header's pointer rules.
        unsafe { write_struct(info, "info", &value) }
    })
}

/// Copies the vertices of a level of detail in the local frame, 3 coordinates each. `level` is from 0, the body, to
/// swiftprox_shape_tuning_info.level_count. `capacity` is the room in vertices, at least swiftprox_level_info.vertex_count. Bodies
/// far from their origin have coordinates rounded by one unit in the last place.
///
/// SWIFTPROX_ERROR_INVALID_ARGUMENT: there is no such level, or capacity is too small; nothing is written.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn swiftprox_shape_copy_level_vertices(
    shape: *const Shape,
    level: usize,
    vertices: *mut f64,
    capacity: usize,
) -> StatusCode {
    guard(|| {
        // SAFETY: the header's pointer rules.
        let polyhedron = polyhedron_of(unsafe { handle(shape, "shape") }?, level)?;
        // SAFETY: the header's pointer rules.
        unsafe { copy_vertices(polyhedron, vertices, capacity) }
    })
}

/// Copies the triangles of a level of detail: 3 corners each, counter-clockwise seen from outside, as indices into the vertices of
/// swiftprox_shape_copy_level_vertices. `capacity` is the room in triangles, at least swiftprox_level_info.triangle_count.
///
/// SWIFTPROX_ERROR_INVALID_ARGUMENT: there is no such level, or capacity is too small; nothing is written.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn swiftprox_shape_copy_level_triangles(
    shape: *const Shape,
    level: usize,
    corners: *mut u32,
    capacity: usize,
) -> StatusCode {
    guard(|| {
        // SAFETY: the header's pointer rules.
        let polyhedron = polyhedron_of(unsafe { handle(shape, "shape") }?, level)?;
        // SAFETY: the header's pointer rules.
        unsafe { copy_triangles(polyhedron, corners, capacity) }
    })
}

/// The body itself for level 0, or a level of detail.
fn polyhedron_of(shape: &Shape, level: usize) -> Checked<&Polyhedron> {
    let levels = &shape.hierarchy().levels;
    match level {
        0 => Ok(shape.polyhedron()),
        _ => levels.get(level - 1).map(|level| &level.polyhedron).ok_or_else(|| {
            let message = format!("there is no level {level}: the shape has {} beside the body", levels.len());
            Failure::new(StatusCode::ErrorInvalidArgument, message)
        }),
    }
}
