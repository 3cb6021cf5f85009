//! Shapes: made from arrays or files, shared by count.

use std::ffi::{c_char, c_void};
use std::sync::Arc;

use super::arrays::{CMesh, copy_triangles, copy_vertices, read_mesh, read_path, read_vectors};
use super::failure::{Checked, Failure, StatusCode};
use super::guard::{guard, keep_panics_quiet};
use super::pointers::{handle, output, release, retained};
use super::shape_options::{CShapeOptions, ProgressCallback, in_steps, read_options};
use super::structs::{Versioned, write_struct};
use crate::body::build::hull::check_points;
use crate::shape::{Shape, file as shape_file, precision_tolerance};

/// Properties of a shape. Set struct_size to sizeof(swiftprox_shape_info) before the call.
#[derive(Debug, Clone, Copy)]
#[repr(C)]
pub struct ShapeInfo {
    /// Set by the caller.
    pub struct_size: usize,
    /// Dimension of the hull: 3. With some input policies also 2 (a two-sided polygon), 1 (a segment) or 0 (a point).
    pub dimension: i32,
    /// Vertices of the hull.
    pub vertex_count: usize,
    /// Edges between faces that are not coplanar.
    pub edge_count: usize,
    /// Faces; coplanar triangles count as one.
    pub face_count: usize,
    /// Triangles of the hull, as in swiftprox_shape_copy_triangles.
    pub triangle_count: usize,
    /// Volume; 0 without interior.
    pub volume: f64,
    /// Centre of mass of the volume, in the local frame. Bodies without interior: centre of their area or length.
    pub centre_of_mass: [f64; 3],
    /// Largest distance of a vertex from the centre of mass.
    pub radius: f64,
    /// The corner of the bounding box with the least coordinates, in the local frame.
    pub lower_corner: [f64; 3],
    /// The corner of the bounding box with the greatest coordinates, in the local frame.
    pub upper_corner: [f64; 3],
    /// Memory of the shape in bytes, levels included; sharing does not change it.
    pub bytes: usize,
    /// Inertia tensor for mass 1 and uniform density about the centre of mass, in local axes. Row-major, symmetric, in length
    /// squared; multiply it by the mass. Without interior the mass is spread over area or length.
    pub inertia: [f64; 9],
    /// Radius of the swept ball (swiftprox_shape_options), in the local frame. All other members describe the body without it.
    pub swept_radius: f64,
    /// How far a cylinder, cone or ellipsoid reaches beyond its polyhedron at most, at any pose; 0 for other shapes. Volume, box
    /// and inertia are the polyhedron's.
    pub deviation: f64,
}

// SAFETY: repr(C), struct_size first, any bytes are valid.
unsafe impl Versioned for ShapeInfo {
    const NAME: &'static str = "swiftprox_shape_info";
}

impl ShapeInfo {
    /// The info of no shape.
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
        deviation: f64::NAN,
    };
}

/// Creates a shape from a polygon mesh. Release it with swiftprox_shape_release. The arrays are copied.
///
/// Answers name features by the mesh's numbers of vertices and faces. Unless the options allow more, the mesh must be a closed,
/// consistently oriented, connected, convex 2-manifold without unused vertices.
///
/// On failure `*shape` is null. SWIFTPROX_ERROR_MESH: the mesh breaks these rules, or a coordinate is not finite.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn swiftprox_shape_create_from_mesh(
    mesh: CMesh,
    options: *const CShapeOptions,
    shape: *mut *const Shape,
) -> StatusCode {
    // SAFETY: the header's pointer rules.
    create(shape, || unsafe {
        let making = read_options(options)?;
        let mesh = read_mesh(mesh)?;
        Ok(making.run(|options, progress| Shape::from_mesh_in_steps(&mesh, options, progress))?)
    })
}

/// Estimates how far from convex a mesh may be through the precision of its coordinates, relative to its bounding-box diagonal. The
/// result is four units in the last written place (decimals, significant digits or floats), from 1e-9 to 0.005. `vertices` holds
/// 3 * vertex_count coordinates as written, before any transform. On failure the tolerance is NaN.
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

/// Creates a shape from the convex hull of `point_count` points, 3 coordinates each. Release it with swiftprox_shape_release. The
/// array is copied. Answers name vertices by their place in `points` (the first of equal points). Faces are numbered from 0 to
/// below swiftprox_shape_info.face_count.
///
/// On failure `*shape` is null. SWIFTPROX_ERROR_MESH: a coordinate is not finite, or the options refuse the hull's dimension (the
/// defaults require an interior). SWIFTPROX_ERROR_INVALID_ARGUMENT: no points, or an option out of range.
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

/// Creates the box [-x, x] x [-y, y] x [-z, z] from its half extents, 3 numbers. A ball of `radius` is swept over it: it rounds
/// edges and corners and enlarges the box; 0 keeps them sharp. In vertex i, bits 0, 1 and 2 of i mean positive x, y and z. Release
/// it with swiftprox_shape_release. On failure `*shape` is null.
///
/// SWIFTPROX_ERROR_INVALID_ARGUMENT: a half extent is not positive, the radius is negative, or a number is above 2^1000 or NaN.
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

/// Creates the sphere with this radius about the local origin. Release it with swiftprox_shape_release. On failure `*shape` is
/// null.
///
/// SWIFTPROX_ERROR_INVALID_ARGUMENT: the radius is negative, above 2^1000 or NaN.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn swiftprox_shape_create_sphere(radius: f64, shape: *mut *const Shape) -> StatusCode {
    // SAFETY: the header's pointer rules.
    create(shape, || Ok(Shape::from_sphere(radius)?))
}

/// Creates a capsule: all points within `radius` of the segment with vertices 0 at (0, 0, -half_length) and 1 at (0, 0,
/// half_length). Release it with swiftprox_shape_release. On failure `*shape` is null.
///
/// SWIFTPROX_ERROR_INVALID_ARGUMENT: a number is negative, above 2^1000 or NaN.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn swiftprox_shape_create_capsule(
    half_length: f64,
    radius: f64,
    shape: *mut *const Shape,
) -> StatusCode {
    // SAFETY: the header's pointer rules.
    create(shape, || Ok(Shape::from_capsule(half_length, radius)?))
}

/// Creates a cylinder about the z axis, from z = -half_height to half_height. Release it with swiftprox_shape_release. On
/// failure `*shape` is null.
///
/// Its polyhedron is a prism. Vertex k of n is at the bottom, at the angle 2 pi k / n from x; vertex n + k is above it. A
/// deviation of 0 means 1e-4 of the radius.
///
/// SWIFTPROX_ERROR_INVALID_ARGUMENT: a length is not from 2^-960 to 2^1000, or the deviation is negative, above 2^1000, NaN, or
/// so small that the prism had more than 2048 sides; the message tells the least.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn swiftprox_shape_create_cylinder(
    radius: f64,
    half_height: f64,
    deviation: f64,
    shape: *mut *const Shape,
) -> StatusCode {
    // SAFETY: the header's pointer rules.
    create(shape, || Ok(Shape::from_cylinder(radius, half_height, deviation)?))
}

/// Creates a cone about the z axis, with its base at z = -half_height and its tip at z = half_height. Release it with
/// swiftprox_shape_release. On failure `*shape` is null.
///
/// Deviation and vertices of the base are as in swiftprox_shape_create_cylinder; vertex n is the tip. Same errors as there.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn swiftprox_shape_create_cone(
    radius: f64,
    half_height: f64,
    deviation: f64,
    shape: *mut *const Shape,
) -> StatusCode {
    // SAFETY: the header's pointer rules.
    create(shape, || Ok(Shape::from_cone(radius, half_height, deviation)?))
}

/// Creates an ellipsoid about the local origin with three semi-axes along x, y and z. Release it with swiftprox_shape_release.
/// On failure `*shape` is null. A deviation of 0 means 1e-3 of the largest semi-axis. For a sphere
/// swiftprox_shape_create_sphere is exact.
///
/// SWIFTPROX_ERROR_INVALID_ARGUMENT: a semi-axis is not from 2^-960 to 2^1000, or the deviation is negative, above 2^1000, NaN,
/// or so small that the polyhedron had more than 4002 vertices; the message tells the least.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn swiftprox_shape_create_ellipsoid(
    semi_axes: *const f64,
    deviation: f64,
    shape: *mut *const Shape,
) -> StatusCode {
    // SAFETY: the header's pointer rules.
    create(shape, || unsafe {
        let semi_axes = read_vectors(semi_axes, 1, "semi_axes")?;
        Ok(Shape::from_ellipsoid(&semi_axes[0], deviation)?)
    })
}

/// Creates a shape from a mesh file. Release it with swiftprox_shape_release. The format is that of a registered reader
/// (swiftprox_library_register_mesh_reader) for the first bytes, else TRI, POLY, OFF, OBJ or STL by extension, else by content.
/// Answers count vertices and faces from 0 in file order or reader order. STL vertices count by first mention; STL triangles with
/// two equal corners do not count.
///
/// On failure `*shape` is null. SWIFTPROX_ERROR_FILE: the file is unreadable, not a regular file, above 4 GiB or malformed; the
/// message names file and line. SWIFTPROX_ERROR_MESH: see swiftprox_shape_create_from_mesh.
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

/// Creates a copy of a shape with every length multiplied by `scale`, a power of two. Release it with swiftprox_shape_release.
/// Vertices, levels of detail and distances scale exactly; labels stay. It takes up to half the time of making the shape.
/// `progress` (may be null, gets `progress_user`) reports progress and can cancel.
///
/// For other scales make the shape anew with swiftprox_shape_options.scale. To turn or move a shape, use poses.
///
/// On failure `*shape` is null. SWIFTPROX_ERROR_INVALID_ARGUMENT: scale is not a positive power of two, or lengths leave the range
/// of doubles.
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
        let source = handle(source, "source")?;
        Ok(in_steps(progress, progress_user, |progress| source.scaled(scale, progress))?)
    })
}

/// Saves a shape in a file and replaces its content. Levels of detail are saved, except automatic ones; these and the look-up table
/// are made again when needed. Any machine can load the file; older libraries may refuse it.
///
/// SWIFTPROX_ERROR_FILE: the file cannot be written or is not a regular file; the message names it and the cause.
/// SWIFTPROX_ERROR_MEMORY leaves the file as it was.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn swiftprox_shape_save(shape: *const Shape, path: *const c_char) -> StatusCode {
    guard(|| {
        // SAFETY: the header's pointer rules.
        let (shape, path) = unsafe { (handle(shape, "shape")?, read_path(path)?) };
        Ok(shape_file::save(shape, path)?)
    })
}

/// Loads a shape saved by swiftprox_shape_save. Release it with swiftprox_shape_release. Hull, labels, levels, table and answers
/// are the same. Data is checked again, so loading takes up to half the time of making the shape. `progress` (may be null, gets
/// `progress_user`) reports progress and can cancel.
///
/// On failure `*shape` is null. SWIFTPROX_ERROR_FILE: the file is unreadable, not a regular file, above 4 GiB, not a shape file, of
/// another version or damaged; the message says which.
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

/// Adds one reference to a shape and returns the shape. Each call needs its own swiftprox_shape_release. Safe from any thread. Null
/// returns null.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn swiftprox_shape_retain(shape: *const Shape) -> *const Shape {
    // SAFETY: a live shape by the header's pointer rules; every one comes from Arc::into_raw.
    unsafe { retained(shape, "shape") }
}

/// Drops one reference to a shape that the caller owns. The last reference frees the shape; scenes hold their own. Safe from any
/// thread. Null is ignored.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn swiftprox_shape_release(shape: *const Shape) {
    // A bug in the freeing is told by the message and the log.
    let _: StatusCode = guard(|| {
        // SAFETY: a live shape by the header's pointer rules, and this share is given up.
        unsafe { release(shape, "shape") }
    });
}

/// Makes in advance the look-up table, support maps and automatic levels of detail, which queries make on first use. The levels
/// take about twice as long as making the shape. After that no query of this shape allocates or waits for them.
///
/// `progress` (may be null, gets `progress_user`) reports progress, except while the table is made, and can cancel. Safe from any
/// thread; concurrent queries do not wait but may make the levels twice.
///
/// SWIFTPROX_ERROR_CANCELLED, SWIFTPROX_ERROR_MEMORY: no levels are made, a finished table stays, and the shape stays usable.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn swiftprox_shape_prepare(
    shape: *const Shape,
    progress: ProgressCallback,
    progress_user: *mut c_void,
) -> StatusCode {
    guard(|| {
        // SAFETY: the header's pointer rules.
        let shape = unsafe { handle(shape, "shape") }?;
        Ok(in_steps(progress, progress_user, |progress| shape.prepare(progress))?)
    })
}

/// Writes the properties of a shape. Set info->struct_size to sizeof(swiftprox_shape_info) first. The inertia takes time linear in
/// the number of triangles. On failure real numbers are NaN, all else 0.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn swiftprox_shape_get_info(shape: *const Shape, info: *mut ShapeInfo) -> StatusCode {
    guard(|| {
        // SAFETY: the header's pointer rules.
        unsafe { write_struct(info, "info", &ShapeInfo::UNKNOWN) }?;
        // SAFETY: the header's pointer rules.
        let shape = unsafe { handle(shape, "shape") }?;
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
            deviation: shape.deviation(),
        };
        // SAFETY: the header's pointer rules.
        unsafe { write_struct(info, "info", &value) }
    })
}

/// Copies the vertices of the hull in the local frame, 3 coordinates each. `capacity` is the room in vertices, at least
/// swiftprox_shape_info.vertex_count. `labels`, if not null, receives the caller's number of each vertex.
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
        let polyhedron = unsafe { handle(shape, "shape") }?.polyhedron();
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

/// Copies the triangles of the hull: 3 corners each, counter-clockwise seen from outside, as indices into the vertices of
/// swiftprox_shape_copy_vertices. `capacity` is the room in triangles, at least swiftprox_shape_info.triangle_count. Larger faces
/// are split into triangles; bodies of dimension 1 or 0 have none.
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
        let polyhedron = unsafe { handle(shape, "shape") }?.polyhedron();
        // SAFETY: the header's pointer rules.
        unsafe { copy_triangles(polyhedron, corners, capacity) }
    })
}

/// A face of a shape's hull: a convex polygon of all coplanar triangles.
#[derive(Debug, Clone, Copy)]
#[repr(C)]
pub struct CFace {
    /// Outward unit normal, rounded, in the local frame.
    pub normal: [f64; 3],
    /// The face's plane is normal * x = offset, rounded.
    pub offset: f64,
    /// Number of corners.
    pub corner_count: usize,
    /// Number of the caller's polygons merged in the face, at least 1.
    pub label_count: usize,
}

impl CFace {
    /// The info of no face.
    const UNKNOWN: CFace = CFace { normal: [f64::NAN; 3], offset: f64::NAN, corner_count: 0, label_count: 0 };
}

/// Room for what swiftprox_shape_get_face finds, by value; `{NULL, 0, NULL, 0}` requests only the plane and the numbers. What does
/// not fit is left out.
#[derive(Debug, Clone, Copy)]
#[repr(C)]
pub struct CFaceRoom {
    /// Receives the corners counter-clockwise seen from outside, as indices into the vertices of swiftprox_shape_copy_vertices.
    pub corners: *mut u32,
    /// Room of `corners`; 0 allows null.
    pub corner_capacity: usize,
    /// Receives the caller's polygons of the face, ascending, or the face's own number if the hull was made without polygons.
    pub labels: *mut u32,
    /// Room of `labels`; 0 allows null.
    pub label_capacity: usize,
}

/// Writes a face of a shape; `index` is from 0 to below swiftprox_shape_info.face_count. For a face of an answer use
/// swiftprox_shape_find_face.
///
/// On failure `*face` is reset. SWIFTPROX_ERROR_INVALID_ARGUMENT: there is no such face.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn swiftprox_shape_get_face(
    shape: *const Shape,
    index: usize,
    room: CFaceRoom,
    face: *mut CFace,
) -> StatusCode {
    let CFaceRoom { corners, corner_capacity, labels, label_capacity } = room;
    guard(|| {
        // SAFETY: the header's pointer rules.
        unsafe { output(face, "face", CFace::UNKNOWN) }?;
        // SAFETY: the header's pointer rules.
        let shape = unsafe { handle(shape, "shape") }?;
        let found = shape.face(index).ok_or_else(|| {
            let message = format!("face {index} of a shape with {} faces", shape.face_count());
            Failure::new(StatusCode::ErrorInvalidArgument, message)
        })?;
        for (array, capacity, name) in
            [(corners, corner_capacity, "room.corners"), (labels, label_capacity, "room.labels")]
        {
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

/// Finds the index, for swiftprox_shape_get_face, of the first face that contains the caller's polygon `label`. Face ids of answers
/// are such labels. Time is linear in the number of faces. On failure `*index` is SIZE_MAX.
///
/// SWIFTPROX_ERROR_INVALID_ARGUMENT: no face has the label.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn swiftprox_shape_find_face(shape: *const Shape, label: u32, index: *mut usize) -> StatusCode {
    guard(|| {
        // SAFETY: the header's pointer rules.
        let shape = unsafe {
            output(index, "index", usize::MAX)?;
            handle(shape, "shape")?
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
