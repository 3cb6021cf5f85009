//! Shapes: made from arrays or files, shared by count.

use std::ffi::{c_char, c_void};
use std::sync::Arc;

use super::arrays::{copy_triangles, copy_vertices, read_arrays, read_path, read_vectors};
use super::failure::{Checked, Failure, StatusCode};
use super::guard::{guard, keep_panics_quiet};
use super::pointers::{input, output};
use super::shape_options::{CShapeOptions, ProgressCallback, in_steps, read_options};
use super::structs::{Versioned, write_struct};
use crate::build::hull::check_points;
use crate::shape::file as shape_file;
use crate::shape::{Shape, precision_tolerance};

/// What a shape is. Set struct_size to sizeof(swiftprox_shape_info) before asking for it.
#[derive(Debug, Clone, Copy)]
#[repr(C)]
pub struct ShapeInfo {
    /// Set by the caller.
    pub struct_size: usize,
    /// Dimension of the hull: 3; 2 (a two-sided polygon), 1 (a segment) or 0 (a point) only where the input policy admits it.
    pub dimension: i32,
    /// Vertices of the hull.
    pub vertex_count: usize,
    /// Edges between faces that are not coplanar.
    pub edge_count: usize,
    /// Faces, coplanar triangles counted as one.
    pub face_count: usize,
    /// Triangles of the hull, as swiftprox_shape_copy_triangles gives them.
    pub triangle_count: usize,
    /// Volume; 0 without interior.
    pub volume: f64,
    /// Centre of mass of the volume, in the local frame; of a body without interior that of its area or length.
    pub centre_of_mass: [f64; 3],
    /// Largest distance of a vertex from the centre of mass.
    pub radius: f64,
    /// The corner of the bounding box where all coordinates are least, in the local frame.
    pub lower_corner: [f64; 3],
    /// The corner where they are greatest.
    pub upper_corner: [f64; 3],
    /// Memory that the shape holds, in bytes, levels included, however many share it.
    pub bytes: usize,
    /// Inertia tensor of a body of mass 1 and of uniform density about the centre of mass, in the axes of the local frame:
    /// row-major, symmetric, in units of length squared. Times a body's mass, density times volume, it is the inertia of that body.
    /// Of a body without interior the mass is spread over its area or length.
    pub inertia: [f64; 9],
    /// The radius of the ball that is swept over the body (swiftprox_shape_options), in the local frame; all other members are of
    /// the body without it.
    pub swept_radius: f64,
}

// SAFETY: repr(C), struct_size first, any bytes are valid.
unsafe impl Versioned for ShapeInfo {
    const NAME: &'static str = "swiftprox_shape_info";
}

impl ShapeInfo {
    /// What is said of no shape.
    const UNKNOWN: ShapeInfo = ShapeInfo {
        struct_size: size_of::<ShapeInfo>(),
        dimension: 0,
        vertex_count: 0,
        edge_count: 0,
        face_count: 0,
        triangle_count: 0,
        volume: f64::NAN,
        centre_of_mass: [f64::NAN; 3],
        radius: f64::NAN,
        lower_corner: [f64::NAN; 3],
        upper_corner: [f64::NAN; 3],
        bytes: 0,
        inertia: [f64::NAN; 9],
        swept_radius: f64::NAN,
    };
}

/// Makes a shape from a polygon mesh; the caller owns it and gives it back with swiftprox_shape_release. The arrays are copied.
///
/// `vertices` holds 3 * vertex_count coordinates. `indices` holds the 0-based vertex numbers of all faces, one face after the
/// other, each counter-clockwise seen from outside; `valences` the number of vertices of each face, or null when all are
/// triangles. The mesh must be closed, a 2-manifold, consistently oriented, connected, convex and without unused vertices,
/// unless the options say otherwise. Answers name features by these numbers.
///
/// On failure `*shape` is null. `options` may be null for the defaults.
///
/// SWIFTPROX_ERROR_MESH: the mesh breaks the contract, or a coordinate is not finite.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn swiftprox_shape_create_from_mesh(
    vertices: *const f64,
    vertex_count: usize,
    indices: *const u32,
    valences: *const u32,
    face_count: usize,
    options: *const CShapeOptions,
    shape: *mut *const Shape,
) -> StatusCode {
    // SAFETY: the header's pointer rules.
    create(shape, || unsafe {
        let making = read_options(options)?;
        let mesh = read_arrays(vertices, vertex_count, indices, valences, face_count)?;
        Ok(making.run(|options, progress| Shape::from_mesh_in_steps(&mesh, options, progress))?)
    })
}

/// Writes how far from convex a mesh may be because of the precision of its coordinates, relative to its bounding box's diagonal:
/// four units of the last place in which they are written (decimals, significant digits, floats), at least 1e-9 and at most 0.005.
/// `vertices` holds 3 * vertex_count coordinates as they were written down, before any transform. On failure it is NaN.
///
/// SWIFTPROX_ERROR_MESH: a coordinate is not finite. SWIFTPROX_ERROR_INVALID_ARGUMENT: there are no vertices.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn swiftprox_mesh_estimate_tolerance(
    vertices: *const f64,
    vertex_count: usize,
    tolerance: *mut f64,
) -> StatusCode {
    // SAFETY: the header's pointer rules.
    guard(|| unsafe {
        output(tolerance, "tolerance", f64::NAN)?;
        let vertices = read_vectors(vertices, vertex_count, "vertices")?;
        check_points(&vertices)?;
        tolerance.write(precision_tolerance(&vertices));
        Ok(())
    })
}

/// Makes a shape from the convex hull of `point_count` points, 3 coordinates each; the caller owns it and gives it back with
/// swiftprox_shape_release. The array is copied. Features of answers name vertices by their place in `points` (the first of equal
/// ones), faces by numbers of the hull's own, from 0 and below swiftprox_shape_info.face_count.
///
/// On failure `*shape` is null. `options` may be null for the defaults, which refuse a hull without interior.
///
/// SWIFTPROX_ERROR_MESH: a coordinate is not finite, or the options do not admit a hull of that dimension.
/// SWIFTPROX_ERROR_INVALID_ARGUMENT: no points, or an option out of range. SWIFTPROX_ERROR_LIMIT: too many points.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn swiftprox_shape_create_from_points(
    points: *const f64,
    point_count: usize,
    options: *const CShapeOptions,
    shape: *mut *const Shape,
) -> StatusCode {
    // SAFETY: the header's pointer rules.
    create(shape, || unsafe {
        let making = read_options(options)?;
        let points = read_vectors(points, point_count, "points")?;
        Ok(making.run(|options, progress| Shape::from_points_in_steps(&points, options, progress))?)
    })
}

/// Makes the box [-x, x] x [-y, y] x [-z, z] from its half extents, 3 numbers. A ball of `radius` is swept over it: 0 leaves edges
/// and corners sharp, more rounds them and makes the box larger by as much. Vertex i has bit 0 of i set where x is positive, bit 1
/// for y, bit 2 for z. The caller owns the shape and gives it back with swiftprox_shape_release. On failure `*shape` is null.
///
/// SWIFTPROX_ERROR_INVALID_ARGUMENT: a half extent is not positive, or a number is negative, larger than 2^1000 or NaN.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn swiftprox_shape_create_box(
    half_extents: *const f64,
    radius: f64,
    shape: *mut *const Shape,
) -> StatusCode {
    // SAFETY: the header's pointer rules.
    create(shape, || unsafe {
        let half_extents = read_vectors(half_extents, 1, "half_extents")?;
        Ok(Shape::from_box(&half_extents[0], radius)?)
    })
}

/// Makes the sphere of a radius about the local origin. Owned and given back as any shape. On failure `*shape` is null.
///
/// SWIFTPROX_ERROR_INVALID_ARGUMENT: the radius is negative, larger than 2^1000 or NaN.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn swiftprox_shape_create_sphere(radius: f64, shape: *mut *const Shape) -> StatusCode {
    // SAFETY: the header's pointer rules.
    create(shape, || Ok(Shape::from_sphere(radius)?))
}

/// Makes the capsule of a radius about the segment from (0, 0, -half_length), vertex 0, to (0, 0, half_length), vertex 1: a
/// cylinder along z with half a sphere at either end. Owned and given back as any shape. On failure `*shape` is null.
///
/// SWIFTPROX_ERROR_INVALID_ARGUMENT: a number is negative, larger than 2^1000 or NaN.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn swiftprox_shape_create_capsule(
    half_length: f64,
    radius: f64,
    shape: *mut *const Shape,
) -> StatusCode {
    // SAFETY: the header's pointer rules.
    create(shape, || Ok(Shape::from_capsule(half_length, radius)?))
}

/// Makes a shape from a mesh file; the caller owns it and gives it back with swiftprox_shape_release.
///
/// The file is read by the reader that swiftprox_library_register_mesh_reader has registered for its first bytes if there is one,
/// else as TRI, POLY, OFF, OBJ or STL, by its extension, else by its content. Features of answers count vertices and faces from 0
/// in the order of the file, or in which the reader adds them; of STL vertices in the order in which they are first mentioned, and
/// no triangles with two equal corners.
///
/// On failure `*shape` is null. `options` may be null for the defaults.
///
/// SWIFTPROX_ERROR_FILE: the file cannot be read, is no regular file (a pipe and a device are refused, not waited for), is larger
/// than 4 GiB (4,294,967,296 bytes) or does not parse; the message names the line, or the registered reader and what it says.
/// SWIFTPROX_ERROR_MESH: its mesh breaks the contract (see swiftprox_shape_create_from_mesh). Both messages name the file.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn swiftprox_shape_create_from_file(
    path: *const c_char,
    options: *const CShapeOptions,
    shape: *mut *const Shape,
) -> StatusCode {
    // SAFETY: the header's pointer rules.
    create(shape, || unsafe {
        let making = read_options(options)?;
        let path = read_path(path)?;
        Ok(making.run(|options, progress| Shape::from_file_in_steps(path, options, progress))?)
    })
}

/// Makes a copy of a shape with every length multiplied by `scale`, a power of two; the caller owns it and gives it back with
/// swiftprox_shape_release. Vertices, levels of detail and distances are exactly those multiplied, and labels are the same. Levels
/// are not built anew, automatic ones are taken over if they are made; what answers rely on is proved and measured again, which
/// takes up to half as long as making the shape did. `progress` learns how far it is and can cancel it, or is null; `progress_user`
/// is handed to it.
///
/// A shape that is turned or moved needs no copy: objects share it, each with a pose, and so do pieces of one object. At any other
/// scale vertices would be rounded, so such a shape is made anew with swiftprox_shape_options.scale; one that is stretched or
/// mirrored is made from other vertices. On failure `*shape` is null.
///
/// SWIFTPROX_ERROR_INVALID_ARGUMENT: scale is no positive power of two, or lengths would leave the range of doubles.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn swiftprox_shape_create_scaled(
    source: *const Shape,
    scale: f64,
    progress: ProgressCallback,
    progress_user: *mut c_void,
    shape: *mut *const Shape,
) -> StatusCode {
    // SAFETY: the header's pointer rules.
    create(shape, || unsafe {
        let source = input(source, "source")?;
        Ok(in_steps(progress, progress_user, |progress| source.scaled(scale, progress))?)
    })
}

/// Saves a shape in a file, replacing what was there: with its levels of detail, except automatic ones, which are made again
/// when they are needed, as the look-up table is. Any machine can load it, with the levels that are saved: built anew, those of a
/// machine with other vector units may be slightly different ones. A version of this library that does not know the version of the
/// file refuses it.
///
/// SWIFTPROX_ERROR_FILE: the file cannot be written or is no regular one (nothing waits for the reader of a pipe); the message
/// names it and says why. SWIFTPROX_ERROR_MEMORY: the file is as it was.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn swiftprox_shape_save(shape: *const Shape, path: *const c_char) -> StatusCode {
    guard(|| {
        // SAFETY: the header's pointer rules.
        let (shape, path) = unsafe { (input(shape, "shape")?, read_path(path)?) };
        Ok(shape_file::save(shape, path)?)
    })
}

/// Loads a shape that swiftprox_shape_save has saved; the caller owns it and gives it back with swiftprox_shape_release. It has the
/// same hull, labels, levels and table, for the same answers. What answers
/// rely on is not believed but proved and measured again, so loading takes up to about half as long as making the shape did,
/// levels included; a damaged file is refused. `progress` learns how far it is and can cancel it, or is null; `progress_user` is
/// handed to it.
///
/// On failure `*shape` is null.
///
/// SWIFTPROX_ERROR_FILE: the file cannot be read, is no regular file, is larger than 4 GiB (4,294,967,296 bytes), is no shape file,
/// of another version or damaged; the message names it and says what is wrong.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn swiftprox_shape_load(
    path: *const c_char,
    progress: ProgressCallback,
    progress_user: *mut c_void,
    shape: *mut *const Shape,
) -> StatusCode {
    // SAFETY: the header's pointer rules.
    create(shape, || unsafe {
        let path = read_path(path)?;
        Ok(in_steps(progress, progress_user, |progress| shape_file::load_in_steps(path, progress))?)
    })
}

/// Gives the caller one more share of a shape, to be given back with a swiftprox_shape_release of its own; returns the shape. Safe
/// from any thread. Of null it returns null.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn swiftprox_shape_retain(shape: *const Shape) -> *const Shape {
    if !shape.is_null() {
        // SAFETY: a live shape by the header's pointer rules; every one comes from Arc::into_raw.
        unsafe { Arc::increment_strong_count(shape) };
    }
    shape
}

/// Gives back one share of a shape that the caller owns, from a function that made the shape or from swiftprox_shape_retain. The
/// last share frees the shape; scenes hold shares of their own. Safe from any thread. Null is ignored.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn swiftprox_shape_release(shape: *const Shape) {
    // A bug in the freeing is told by the message and the log.
    let _: StatusCode = guard(|| {
        if !shape.is_null() {
            // SAFETY: a live shape by the header's pointer rules, and this share is given up; see swiftprox_shape_retain.
            unsafe { Arc::decrement_strong_count(shape) };
        }
        Ok(())
    });
}

/// Makes now what a query of a shape would make when it first needs it: the look-up table, maps of the support function, and
/// automatic levels of detail, which take about twice as long as making the shape did. After that no query of this shape allocates
/// or waits for that.
///
/// `progress` learns how far it is and can cancel it, or is null; `progress_user` is handed to it. Nothing is reported while
/// the table is made, a small part of the time, of needles up to a third. Safe from any thread: a query that needs the levels
/// meanwhile, or another swiftprox_shape_prepare, does not wait but makes them, too, and what comes second is dropped.
///
/// SWIFTPROX_ERROR_CANCELLED: progress said so; SWIFTPROX_ERROR_MEMORY: in both cases no levels are made, a table that was made
/// stays, and the shape can be used as before.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn swiftprox_shape_prepare(
    shape: *const Shape,
    progress: ProgressCallback,
    progress_user: *mut c_void,
) -> StatusCode {
    guard(|| {
        // SAFETY: the header's pointer rules.
        let shape = unsafe { input(shape, "shape") }?;
        Ok(in_steps(progress, progress_user, |progress| shape.prepare(progress))?)
    })
}

/// Says what a shape is: set info->struct_size to sizeof(swiftprox_shape_info) first. On failure real numbers are NaN, all else 0.
/// The inertia takes time in proportion to the triangles.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn swiftprox_shape_get_info(shape: *const Shape, info: *mut ShapeInfo) -> StatusCode {
    guard(|| {
        // SAFETY: the header's pointer rules.
        unsafe { write_struct(info, "info", &ShapeInfo::UNKNOWN) }?;
        // SAFETY: the header's pointer rules.
        let shape = unsafe { input(shape, "shape") }?;
        let (polyhedron, inertia) = (shape.polyhedron(), shape.inertia());
        let value = ShapeInfo {
            struct_size: size_of::<ShapeInfo>(),
            dimension: i32::from(polyhedron.dimension),
            vertex_count: polyhedron.vertices.len(),
            edge_count: polyhedron.edges.len(),
            face_count: polyhedron.faces.len(),
            triangle_count: polyhedron.triangles.len(),
            volume: polyhedron.mass.volume,
            centre_of_mass: polyhedron.mass.centre_of_mass.into(),
            radius: polyhedron.mass.radius,
            lower_corner: polyhedron.mass.lower.into(),
            upper_corner: polyhedron.mass.upper.into(),
            bytes: shape.bytes(),
            inertia: std::array::from_fn(|k| inertia[(k / 3, k % 3)]),
            swept_radius: shape.swept_radius(),
        };
        // SAFETY: the header's pointer rules.
        unsafe { write_struct(info, "info", &value) }
    })
}

/// Copies the vertices of the hull, in the local frame: `capacity` is how many `vertices` has room for (3 coordinates each),
/// at least swiftprox_shape_info.vertex_count. `labels` receives the caller's number of each vertex, or is null.
///
/// SWIFTPROX_ERROR_INVALID_ARGUMENT: capacity is too small; nothing is written.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn swiftprox_shape_copy_vertices(
    shape: *const Shape,
    vertices: *mut f64,
    labels: *mut u32,
    capacity: usize,
) -> StatusCode {
    guard(|| {
        // SAFETY: the header's pointer rules.
        let polyhedron = unsafe { input(shape, "shape") }?.polyhedron();
        // SAFETY: the header's pointer rules.
        unsafe { copy_vertices(polyhedron, vertices, capacity) }?;
        if !labels.is_null() {
            let source = polyhedron.vertex_labels.as_ptr();
            // SAFETY: as many labels as vertices, at most capacity; the caller's array is not ours.
            unsafe { labels.copy_from_nonoverlapping(source, polyhedron.vertex_labels.len()) };
        }
        Ok(())
    })
}

/// Copies the triangles of the hull, 3 corners each, counter-clockwise seen from outside, as places in what
/// swiftprox_shape_copy_vertices gives: `capacity` is how many triangles `corners` has room for, at least
/// swiftprox_shape_info.triangle_count. Faces of more than three sides come as several triangles; a body of dimension 1 or 0 has
/// none.
///
/// SWIFTPROX_ERROR_INVALID_ARGUMENT: capacity is too small; nothing is written.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn swiftprox_shape_copy_triangles(
    shape: *const Shape,
    corners: *mut u32,
    capacity: usize,
) -> StatusCode {
    guard(|| {
        // SAFETY: the header's pointer rules.
        let polyhedron = unsafe { input(shape, "shape") }?.polyhedron();
        // SAFETY: the header's pointer rules.
        unsafe { copy_triangles(polyhedron, corners, capacity) }
    })
}

/// A face of a shape's hull: all coplanar triangles, a convex polygon.
#[derive(Debug, Clone, Copy)]
#[repr(C)]
pub struct CFace {
    /// Outward, a unit vector up to rounding, in the local frame.
    pub normal: [f64; 3],
    /// The product of the normal with a corner, rounded: normal * x = offset in the face's plane.
    pub offset: f64,
    /// How many corners the face has.
    pub corner_count: usize,
    /// How many of the caller's polygons are merged in it, 1 at least.
    pub label_count: usize,
}

impl CFace {
    /// What is said of no face.
    const UNKNOWN: CFace = CFace { normal: [f64::NAN; 3], offset: f64::NAN, corner_count: 0, label_count: 0 };
}

/// Says what a face of a shape is, by its place from 0 to below swiftprox_shape_info.face_count. `corners` receives its corners,
/// counter-clockwise seen from outside, as places in what swiftprox_shape_copy_vertices gives; `labels` the caller's polygons that
/// are merged in it, ascending, or the face's own number where the hull was made without polygons. Each gets as many as there is
/// room for, and may be null with no room. swiftprox_shape_find_face tells the place of a face of an answer.
///
/// On failure `*face` is reset. SWIFTPROX_ERROR_INVALID_ARGUMENT: the shape has no such face.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn swiftprox_shape_get_face(
    shape: *const Shape,
    index: usize,
    face: *mut CFace,
    corners: *mut u32,
    corner_capacity: usize,
    labels: *mut u32,
    label_capacity: usize,
) -> StatusCode {
    guard(|| {
        // SAFETY: the header's pointer rules.
        unsafe { output(face, "face", CFace::UNKNOWN) }?;
        // SAFETY: the header's pointer rules.
        let shape = unsafe { input(shape, "shape") }?;
        let found = shape.face(index).ok_or_else(|| {
            let message = format!("face {index} of a shape with {} faces", shape.face_count());
            Failure::new(StatusCode::ErrorInvalidArgument, message)
        })?;
        for (array, capacity, name) in [(corners, corner_capacity, "corners"), (labels, label_capacity, "labels")] {
            if array.is_null() && capacity > 0 {
                return Err(Failure::null(name));
            }
        }
        for (place, corner) in found.corners().take(corner_capacity).enumerate() {
            // SAFETY: not null, and place < capacity.
            unsafe { corners.add(place).write(corner) };
        }
        for (place, label) in found.labels().iter().take(label_capacity).enumerate() {
            // SAFETY: as above.
            unsafe { labels.add(place).write(*label) };
        }
        let value = CFace {
            normal: found.normal(),
            offset: found.offset(),
            corner_count: found.corners().len(),
            label_count: found.labels().len(),
        };
        // SAFETY: the header's pointer rules.
        unsafe { output(face, "face", value) }
    })
}

/// The place of a face, for swiftprox_shape_get_face: of the one that the caller's polygon `label` is a part of, which is the id
/// of a face in an answer. Of several the first. Takes time in proportion to the faces. On failure `*index` is SIZE_MAX.
///
/// SWIFTPROX_ERROR_INVALID_ARGUMENT: no face has the label.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn swiftprox_shape_find_face(shape: *const Shape, label: u32, index: *mut usize) -> StatusCode {
    guard(|| {
        // SAFETY: the header's pointer rules.
        let shape = unsafe {
            output(index, "index", usize::MAX)?;
            input(shape, "shape")?
        };
        let found = shape.find_face(label).ok_or_else(|| {
            Failure::new(StatusCode::ErrorInvalidArgument, format!("no face of the shape has the label {label}"))
        })?;
        // SAFETY: the header's pointer rules.
        unsafe { output(index, "index", found) }
    })
}

// --- What the functions above share --------------------------------------------------------------------------------------

/// Runs `make` in the guard and hands its shape to the caller, or null.
pub(super) fn create(shape: *mut *const Shape, make: impl FnOnce() -> Checked<Shape>) -> StatusCode {
    guard(|| {
        // SAFETY: the header's pointer rules.
        unsafe { output(shape, "shape", std::ptr::null()) }?;
        keep_panics_quiet();
        let made = Arc::into_raw(Arc::new(make()?));
        // SAFETY: as above.
        unsafe { output(shape, "shape", made) }
    })
}
