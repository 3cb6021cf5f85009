//! Grounds: made from arrays, shared by count, and asked about bodies.

use std::sync::Arc;

use super::arrays::{check_count, read_vectors};
use super::depth::{CManifoldConfig, check_room, read_manifold_config};
use super::enumerators::{QueryNumber, read_enumerator};
use super::failure::{Checked, StatusCode};
use super::guard::{guard, keep_panics_quiet};
use super::pair::{CPairConfig, CPlaced, body, read_config};
use super::pointers::{array, handle, input, output, release, retained};
use crate::base::math::Pose;
use crate::base::memory::with_capacity;
use crate::ground::{
    Ground, GroundContact, GroundContacts, GroundDistance, GroundRayAnswer, HeightGrid, PlacedGround, ground_contacts,
    ground_distance,
};
use crate::manifold::ManifoldPoint;
use crate::ray::{Ray, RayAnswer};

/// Creates a ground from triangles. The caller owns it and gives it back with swiftprox_ground_release. The arrays are copied.
///
/// `vertices` holds 3 * vertex_count coordinates, `corners` 3 * triangle_count vertex numbers from 0. Triangles push bodies out of
/// their front, where corners run counter-clockwise. They may form any surface, or none. Two triangles share an edge if its ends
/// are equal and its directions opposite; bodies slide over it. Triangles without area, or smaller than 2^-200, are skipped, but
/// keep their numbers.
///
/// On failure `*ground` is null. SWIFTPROX_ERROR_MESH: a coordinate is not finite or beyond 2^200, a vertex number is too large, or
/// no triangle has an area. SWIFTPROX_ERROR_LIMIT: more than 2^30 triangles.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn swiftprox_ground_create_from_triangles(
    vertices: *const f64,
    vertex_count: usize,
    corners: *const u32,
    triangle_count: usize,
    ground: *mut *const Ground,
) -> StatusCode {
    // SAFETY: the header's pointer rules; three numbers are as aligned as one.
    create(ground, || unsafe {
        let vertices = read_vectors(vertices, vertex_count, "vertices")?;
        check_count(triangle_count, "triangle_count")?;
        Ok(Ground::from_triangles(&vertices, array(corners.cast::<[u32; 3]>(), triangle_count, "corners")?)?)
    })
}

/// Creates a ground from heights over a grid in the xy plane. The caller owns it and gives it back with swiftprox_ground_release.
/// The heights are copied.
///
/// `heights` holds rows * columns numbers, row by row, each row along x. NaN is a hole; cells with one at a corner are holes.
/// Vertex i * columns + j is at (j * column_spacing, i * row_spacing, height). The diagonal of each cell runs from its least to its
/// greatest corner; both triangles face up. Let c = i * (columns - 1) + j for the least corner. Triangle 2 * c has the corner along
/// x, triangle 2 * c + 1 the other.
///
/// On failure `*ground` is null. SWIFTPROX_ERROR_INVALID_ARGUMENT: fewer than two rows or columns, or a spacing that is not
/// finite and at least 2^-199. SWIFTPROX_ERROR_MESH: a coordinate is infinite or beyond 2^200, or all cells are holes.
/// SWIFTPROX_ERROR_LIMIT: more than 2^29 heights.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn swiftprox_ground_create_from_heights(
    rows: usize,
    columns: usize,
    row_spacing: f64,
    column_spacing: f64,
    heights: *const f64,
    ground: *mut *const Ground,
) -> StatusCode {
    // SAFETY: the header's pointer rules.
    create(ground, || unsafe {
        let count = rows.saturating_mul(columns);
        check_count(count, "rows * columns")?;
        let heights = array(heights, count, "heights")?;
        Ok(Ground::from_heights(&HeightGrid { rows, columns, spacing: [column_spacing, row_spacing], heights })?)
    })
}

/// Creates one ground from several, such as the tiles of a terrain: bodies slide over the seams. The caller owns it and gives it
/// back with swiftprox_ground_release. Shares of the others are not kept.
///
/// `grounds` holds `count` grounds, `poses` 12 numbers for each of them, row by row. Vertices and triangles keep their order: those
/// of the first ground, then those of the second. The new ground is as thick as the thickest of them.
///
/// On failure `*ground` is null. SWIFTPROX_ERROR_INVALID_ARGUMENT: count is 0. SWIFTPROX_ERROR_POSE: a pose is not a rotation.
/// SWIFTPROX_ERROR_LIMIT: more than 2^30 triangles or 2^32 vertices in all.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn swiftprox_ground_create_from_grounds(
    grounds: *const *const Ground,
    poses: *const f64,
    count: usize,
    ground: *mut *const Ground,
) -> StatusCode {
    // SAFETY: the header's pointer rules; a pose is twelve doubles, row by row, as is `Pose`.
    create(ground, || unsafe {
        let grounds = array(grounds, count, "grounds")?;
        let poses = array(poses.cast::<Pose>(), count, "poses")?;
        let mut placed = with_capacity(count)?;
        for (ground, pose) in grounds.iter().zip(poses) {
            placed.push(handle(*ground, "grounds")?.at(pose));
        }
        Ok(Ground::from_grounds(&placed)?)
    })
}

/// Creates a solid ground from another. It pushes out bodies whose centres of mass are behind a triangle by up to `thickness`, even
/// if they touch no triangle. Use infinity for closed surfaces. A thickness of 0 is that of other grounds. The caller owns it and
/// gives it back with swiftprox_ground_release.
///
/// On failure `*solid` is null. SWIFTPROX_ERROR_INVALID_ARGUMENT: thickness is negative or NaN.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn swiftprox_ground_create_solid(
    ground: *const Ground,
    thickness: f64,
    solid: *mut *const Ground,
) -> StatusCode {
    // SAFETY: the header's pointer rules.
    create(solid, || unsafe { Ok(handle(ground, "ground")?.try_clone()?.with_thickness(thickness)?) })
}

/// Adds a share of a ground, and returns the ground. Give each share back with swiftprox_ground_release. Safe from any thread. For
/// null it returns null.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn swiftprox_ground_retain(ground: *const Ground) -> *const Ground {
    // SAFETY: a live ground by the header's pointer rules; every one comes from Arc::into_raw.
    unsafe { retained(ground, "ground") }
}

/// Gives back one share of a ground; the last one frees it. Safe from any thread. Null is ignored.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn swiftprox_ground_release(ground: *const Ground) {
    // A bug in the freeing is told by the message and the log.
    let _: StatusCode = guard(|| {
        // SAFETY: a live ground by the header's pointer rules, and this share is given up.
        unsafe { release(ground, "ground") }
    });
}

/// A ground at a pose, an argument by value. Both pointers are only read during the call.
#[derive(Debug, Clone, Copy)]
#[repr(C)]
pub struct CPlacedGround {
    /// The ground.
    pub ground: *const Ground,
    /// 12 doubles, the row-major 3x4 matrix [R|T].
    pub pose: *const f64,
}

/// # Safety
/// The pointers meet the header's pointer rules for `'a`.
pub(super) unsafe fn read_placed<'a>(ground: CPlacedGround) -> Checked<PlacedGround<'a>> {
    // SAFETY: by the caller; a pose is twelve doubles, row by row, as is `Pose`.
    unsafe { Ok(handle(ground.ground, "ground.ground")?.at(input(ground.pose.cast::<Pose>(), "ground.pose")?)) }
}

/// Properties of a ground.
#[derive(Debug, Clone, Copy)]
#[repr(C)]
pub struct GroundInfo {
    /// Number of vertices given.
    pub vertex_count: usize,
    /// Number of triangles, including skipped ones.
    pub triangle_count: usize,
    /// Its memory in bytes.
    pub bytes: usize,
}

/// Writes the properties of a ground. On failure all are 0.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn swiftprox_ground_get_info(ground: *const Ground, info: *mut GroundInfo) -> StatusCode {
    // SAFETY: the header's pointer rules.
    guard(|| unsafe {
        output(info, "info", GroundInfo { vertex_count: 0, triangle_count: 0, bytes: 0 })?;
        let ground = handle(ground, "ground")?;
        let (vertex_count, triangle_count) = (ground.vertex_count(), ground.triangle_count());
        output(info, "info", GroundInfo { vertex_count, triangle_count, bytes: ground.bytes() })
    })
}

/// Copies `count` triangles of a ground, beginning with number `first`, in the ground's frame. A large ground is read in parts.
///
/// `points` receives 9 coordinates of each triangle, corner by corner, and `corners` its 3 vertex numbers. Either may be null. The
/// corners of a skipped triangle are one vertex; at a hole of a grid its height is 0.
///
/// SWIFTPROX_ERROR_INVALID_ARGUMENT: the ground has no such triangles; nothing is written.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn swiftprox_ground_copy_triangles(
    ground: *const Ground,
    first: usize,
    count: usize,
    points: *mut f64,
    corners: *mut u32,
) -> StatusCode {
    guard(|| {
        // SAFETY: the header's pointer rules.
        let ground = unsafe { handle(ground, "ground") }?;
        let triangles = ground.triangles(first, count)?;
        for (k, (vertices, places)) in triangles.enumerate() {
            if !points.is_null() {
                // SAFETY: not null, room for `count` triangles, and the caller's array is not ours.
                unsafe { points.cast::<[[f64; 3]; 3]>().add(k).write(places.map(Into::into)) };
            }
            if !corners.is_null() {
                // SAFETY: as above.
                unsafe { corners.cast::<[u32; 3]>().add(k).write(vertices) };
            }
        }
        Ok(())
    })
}

/// Returns the distance of a shape (object 1) to a ground, or only whether they intersect. `kind` is SWIFTPROX_QUERY_KIND_DISTANCE
/// or SWIFTPROX_QUERY_KIND_INTERSECTION. The ground counts as a set of points. Guarantees and `config` are as for
/// swiftprox_pair_distance and swiftprox_pair_intersection. There is no cache.
///
/// On failure the answer is reset. SWIFTPROX_ERROR_INVALID_ARGUMENT: another kind, or a member of config is out of range. The call
/// allocates about 4 kB.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn swiftprox_pair_ground_distance(
    kind: QueryNumber,
    object: CPlaced,
    ground: CPlacedGround,
    config: *const CPairConfig,
    answer: *mut GroundDistance,
) -> StatusCode {
    // SAFETY: the header's pointer rules.
    guard(|| unsafe {
        output(answer, "answer", GroundDistance::default())?;
        let query = read_enumerator(kind, "kind", "swiftprox_query_kind")?;
        let (object, ground) = (body(object, ["object.shape", "object.pose"])?, read_placed(ground)?);
        output(answer, "answer", ground_distance(query, object, ground, &read_config(config)?)?)
    })
}

/// Casts a ray at a ground and finds where it first meets the surface, from either side. Guarantees are as for
/// swiftprox_shape_cast_ray; the triangle is named, and the normal is its plane's, against the ray.
///
/// On failure the answer is reset. Same errors as swiftprox_shape_cast_ray. The call allocates about 4 kB.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn swiftprox_ground_cast_ray(
    ground: CPlacedGround,
    ray: *const Ray,
    answer: *mut GroundRayAnswer,
) -> StatusCode {
    // SAFETY: the header's pointer rules.
    guard(|| unsafe {
        output(answer, "answer", GroundRayAnswer { answer: RayAnswer::default(), triangle: 0 })?;
        output(answer, "answer", read_placed(ground)?.cast_ray(input(ray, "ray")?)?)
    })
}

/// Numbers of contacts with a ground and of their points.
#[derive(Debug, Clone, Copy, Default)]
#[repr(C)]
pub struct GroundCount {
    /// Contacts found.
    pub contact_count: usize,
    /// Points found.
    pub point_count: usize,
}

/// Room for what swiftprox_pair_ground_contacts finds, by value. What does not fit is left out.
#[derive(Debug, Clone, Copy)]
#[repr(C)]
pub struct CGroundRoom {
    /// Receives contacts, sorted by triangle.
    pub contacts: *mut GroundContact,
    /// Room of `contacts`; 0 allows null.
    pub contact_capacity: usize,
    /// Receives points. Those of contact c begin at its first_point; there are manifold.point_count.
    pub points: *mut ManifoldPoint,
    /// Room of `points`; 0 allows null.
    pub point_capacity: usize,
}

/// Finds the contacts of a shape (object 1) with a ground, up to config->max_distance apart. Each contact has points and one normal
/// out of the ground. `room` receives what fits, `count` all numbers found.
///
/// A triangle acts only on bodies whose centre of mass is not behind its plane by more than the ground's thickness. The normal is
/// the direction of least distance or overlap among those that are normal to the surface at the touched point. So bodies slide
/// freely over flat and concave edges, and no contact is much deeper than the body is in.
///
/// If config->reduces is set, at most four points stay on each side of the body. Contacts with normals within 45 degrees of the
/// deepest are on one side.
///
/// On failure the counts are 0; contacts and points are unchanged. Same errors as swiftprox_pair_manifold. SWIFTPROX_ERROR_LIMIT: a
/// capacity is larger than memory.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn swiftprox_pair_ground_contacts(
    object: CPlaced,
    ground: CPlacedGround,
    config: *const CManifoldConfig,
    room: CGroundRoom,
    count: *mut GroundCount,
) -> StatusCode {
    let CGroundRoom { contacts, contact_capacity, points, point_capacity } = room;
    guard(|| {
        // SAFETY: the header's pointer rules.
        let (object, ground, config) = unsafe {
            output(count, "count", GroundCount::default())?;
            (body(object, ["object.shape", "object.pose"])?, read_placed(ground)?, read_manifold_config(config)?)
        };
        check_room(contacts, "room.contacts", contact_capacity)?;
        check_room(points, "room.points", point_capacity)?;
        let mut found = GroundContacts::default();
        ground_contacts(object, ground, &config, &mut found)?;
        for (place, contact) in found.contacts.iter().take(contact_capacity).enumerate() {
            // SAFETY: not null, and place < capacity.
            unsafe { contacts.add(place).write(*contact) };
        }
        for (place, point) in found.points.iter().take(point_capacity).enumerate() {
            // SAFETY: as above.
            unsafe { points.add(place).write(*point) };
        }
        let all = GroundCount { contact_count: found.contacts.len(), point_count: found.points.len() };
        // SAFETY: the header's pointer rules.
        unsafe { output(count, "count", all) }
    })
}

fn create(ground: *mut *const Ground, make: impl FnOnce() -> Checked<Ground>) -> StatusCode {
    guard(|| {
        // SAFETY: the header's pointer rules.
        unsafe { output(ground, "ground", std::ptr::null()) }?;
        keep_panics_quiet();
        let made = Arc::into_raw(Arc::new(make()?));
        // SAFETY: as above.
        unsafe { output(ground, "ground", made) }
    })
}
