//! Compounds: bodies of several pieces, shared by count, and queries of two of them.

use std::ffi::c_void;
use std::sync::Arc;

use super::arrays::{CMesh, check_count, read_mesh};
use super::depth::{CDepthConfig, CManifoldConfig, check_room, read_depth_config, read_manifold_config};
use super::failure::{Checked, Failure, StatusCode};
use super::guard::{guard, keep_panics_quiet};
use super::motion::{CCastConfig, CMotion, called, cast_config, check_cast_enumerators, read_motion};
use super::object::share;
use super::pair::{CPairConfig, check_enumerators, check_signed_enumerators, read_config};
use super::pointers::{array, exclusive, handle, input, output, release, retained};
use super::shape_options::{ProgressCallback, in_steps};
use crate::base::error::Result;
use crate::base::math::Pose;
use crate::base::memory::{push, with_capacity};
use crate::compound::{
    self, Compound, CompoundAnswer, CompoundCache, CompoundCastAnswer, CompoundContact, CompoundContacts,
    CompoundDepth, CompoundPointAnswer, CompoundRayAnswer, CompoundSignedDistance, MovingCompound, Piece,
    PlacedCompound,
};
use crate::manifold::ManifoldPoint;
use crate::pair::PairConfig;
use crate::ray::Ray;
use crate::shape::Shape;

/// A compound at a pose, an argument of queries by value. Both pointers are only read during the call.
#[derive(Debug, Clone, Copy)]
#[repr(C)]
pub struct CPlacedCompound {
    /// The compound.
    pub compound: *const Compound,
    /// 12 doubles, the row-major 3x4 matrix [R|T].
    pub pose: *const f64,
}

/// The cache of a pair of compounds, owned by the caller; 13 kB. Zero it before the first query; any bytes are safe. It affects
/// speed, which of several equally near pieces is named, and how tight a verdict's `lower` is; never the verdict.
#[derive(Debug, Clone, Copy)]
#[repr(C)]
pub struct CCompoundCache {
    /// Opaque.
    pub words: [u32; 3328],
}

// A `CompoundCache` lives in the words, which leave it room to grow; any bytes make a valid one.
const _: () = {
    assert!(size_of::<CompoundCache>() <= size_of::<CCompoundCache>());
    assert!(align_of::<CompoundCache>() <= align_of::<CCompoundCache>());
};

/// Properties of a compound.
#[derive(Debug, Clone, Copy)]
#[repr(C)]
pub struct CompoundInfo {
    /// Number of pieces.
    pub piece_count: usize,
    /// Its memory in bytes, without its shapes.
    pub bytes: usize,
}

/// Creates a compound: the union of convex pieces, which may overlap. The caller owns it and gives it back with
/// swiftprox_compound_release. It takes its own share of each shape, so the caller may release its shares at once.
///
/// `poses` holds 12 numbers for each piece, row by row: its pose in the compound. Null means that all are at the identity. Such a
/// piece is exactly where the pose of the compound takes it. Others are at the product of both poses, each number rounded.
///
/// On failure `*compound` is null. SWIFTPROX_ERROR_INVALID_ARGUMENT: no pieces. SWIFTPROX_ERROR_LIMIT: more than 2^20.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn swiftprox_compound_create(
    shapes: *const *const Shape,
    poses: *const f64,
    count: usize,
    compound: *mut *const Compound,
) -> StatusCode {
    // SAFETY: the header's pointer rules; a pose is twelve doubles, row by row, as is `Pose`.
    create(compound, || unsafe {
        check_count(count, "count")?;
        let shapes = array(shapes, count, "shapes")?;
        let poses = if poses.is_null() { None } else { Some(array(poses.cast::<Pose>(), count, "poses")?) };
        let mut pieces = with_capacity(count)?;
        for (i, &shape) in shapes.iter().enumerate() {
            let pose = poses.map_or(Pose::IDENTITY, |poses| poses[i]);
            push(&mut pieces, Piece { shape: share(shape, format_args!("shapes[{i}]"))?, pose })?;
        }
        Ok(Compound::new(&pieces)?)
    })
}

/// Creates a compound from a mesh that need not be convex or connected. The caller owns it and gives it back with
/// swiftprox_compound_release. `tolerance` is relative to the bounding-box diagonal, and decides what the pieces are:
///
/// 0: those that swiftprox_mesh_decompose cuts the surface into. They keep the surface exactly, and the mesh's numbers as features.
/// They leave hollows: a body that is wholly inside may touch no piece.
///
/// 1e-4 to 1: solid pieces. Together they hold the body, up to 1e-8 of the diagonal. No point of a piece is farther from the body
/// than the tolerance. Features are the pieces' own. Edges may have more than two faces, and faces turned the wrong way are turned,
/// as long as inside and outside can be told. Time grows as the surface over the square of the tolerance.
///
/// swiftprox_compound_get_piece gives the pieces, as for a scene. `progress` may be null. On failure `*compound` is null.
///
/// Same errors as swiftprox_mesh_decompose. With a tolerance above 0 also SWIFTPROX_ERROR_MESH: an edge has an odd number of faces,
/// or inside and outside cannot be told at it; and SWIFTPROX_ERROR_LIMIT: more than 2,048 cells are needed. Messages say the cure.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn swiftprox_compound_create_from_mesh(
    mesh: CMesh,
    tolerance: f64,
    progress: ProgressCallback,
    progress_user: *mut c_void,
    compound: *mut *const Compound,
) -> StatusCode {
    // SAFETY: the header's pointer rules.
    create(compound, || unsafe {
        let mesh = read_mesh(mesh)?;
        Ok(in_steps(progress, progress_user, |progress| Compound::from_mesh(&mesh, tolerance, progress))?)
    })
}

/// Adds a share of a compound, and returns the compound. Give each share back with swiftprox_compound_release. Safe from any
/// thread. For null it returns null.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn swiftprox_compound_retain(compound: *const Compound) -> *const Compound {
    // SAFETY: a live compound by the header's pointer rules; every one comes from Arc::into_raw.
    unsafe { retained(compound, "compound") }
}

/// Gives back one share of a compound; the last one frees it and its shares of shapes. Safe from any thread. Null is ignored.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn swiftprox_compound_release(compound: *const Compound) {
    // A bug in the freeing is told by the message and the log.
    let _: StatusCode = guard(|| {
        // SAFETY: a live compound by the header's pointer rules, and this share is given up.
        unsafe { release(compound, "compound") }
    });
}

/// Writes the properties of a compound. On failure all are 0.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn swiftprox_compound_get_info(compound: *const Compound, info: *mut CompoundInfo) -> StatusCode {
    // SAFETY: the header's pointer rules.
    guard(|| unsafe {
        output(info, "info", CompoundInfo { piece_count: 0, bytes: 0 })?;
        let compound = handle(compound, "compound")?;
        output(info, "info", CompoundInfo { piece_count: compound.piece_count(), bytes: compound.bytes() })
    })
}

/// Writes a piece of a compound: its shape, which lives as long as the compound (retain it to keep it longer), and 12 numbers for
/// its pose there. On failure the shape is null and the pose NaN.
///
/// SWIFTPROX_ERROR_INVALID_ARGUMENT: there is no such piece.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn swiftprox_compound_get_piece(
    compound: *const Compound,
    piece: u32,
    shape: *mut *const Shape,
    pose: *mut f64,
) -> StatusCode {
    // SAFETY: the header's pointer rules; a pose is twelve doubles, row by row, as is `Pose`.
    guard(|| unsafe {
        output(shape, "shape", std::ptr::null())?;
        output(pose.cast::<Pose>(), "pose", Pose { rows: [[f64::NAN; 4]; 3] })?;
        let compound = handle(compound, "compound")?;
        let Some(found) = compound.pieces().get(piece as usize) else {
            let message = format!("piece {piece} of a compound that has {}", compound.piece_count());
            return Err(Failure::new(StatusCode::ErrorInvalidArgument, message));
        };
        output(shape, "shape", Arc::as_ptr(&found.shape))?;
        output(pose.cast::<Pose>(), "pose", found.pose)
    })
}

/// Computes the distance of two compounds: the least of any two pieces, with an interval that holds it. Witness points, normal and
/// features are those of the nearest two pieces, which are named. Intersecting compounds have distance 0 and name two pieces that
/// intersect, with the proof.
///
/// `cache` and `config` are as for swiftprox_pair_distance. Beyond config->max_distance no pieces are named. On failure the
/// answer is reset and its outcome is SWIFTPROX_OUTCOME_NONE; SWIFTPROX_ERROR_BUG also resets the cache.
///
/// SWIFTPROX_ERROR_POSE: also where the product of a compound's and a piece's pose is refused. SWIFTPROX_ERROR_INVALID_ARGUMENT: a
/// member of config is out of range.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn swiftprox_compound_distance(
    object1: CPlacedCompound,
    object2: CPlacedCompound,
    cache: *mut CCompoundCache,
    config: *const CPairConfig,
    answer: *mut CompoundAnswer,
) -> StatusCode {
    // SAFETY: the header's pointer rules.
    unsafe { query(compound::distance, [object1, object2], cache, config, answer) }
}

/// Decides only whether two compounds intersect, and names two pieces that do. Compounds that are apart get lower > 0, an infinite
/// upper and no pieces; with a finite config->max_distance those within it get two pieces, and others
/// SWIFTPROX_OUTCOME_BEYOND. Same arguments and errors as swiftprox_compound_distance.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn swiftprox_compound_intersection(
    object1: CPlacedCompound,
    object2: CPlacedCompound,
    cache: *mut CCompoundCache,
    config: *const CPairConfig,
    answer: *mut CompoundAnswer,
) -> StatusCode {
    // SAFETY: the header's pointer rules.
    unsafe { query(compound::intersection, [object1, object2], cache, config, answer) }
}

/// Computes the least signed distance of any two pieces: how far compounds are apart, or minus how deep the deepest two pieces are
/// in each other. The translation that parts intersecting compounds is at least as long as that depth, and may be longer: to free
/// two pieces may push others into each other. Same arguments and errors as swiftprox_compound_distance.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn swiftprox_compound_signed_distance(
    object1: CPlacedCompound,
    object2: CPlacedCompound,
    cache: *mut CCompoundCache,
    config: *const CPairConfig,
    answer: *mut CompoundSignedDistance,
) -> StatusCode {
    // SAFETY: the header's pointer rules.
    unsafe { query(compound::signed_distance, [object1, object2], cache, config, answer) }
}

/// Computes how deep two compounds are in each other: the length of the least translation of object 1 at which no two pieces
/// overlap. The answer is an interval, from the depth of the deepest two pieces to the length of a translation that is proved to
/// free, and that translation. It need not be the least. No cache: equal arguments give equal answers.
///
/// `config` may be null. The search ends early where upper - lower is within one of its errors, or after step_budget
/// translations; the library's own limit is 2,000. Same errors as swiftprox_compound_signed_distance. On failure the answer is
/// reset, and its deepest.distance.outcome is SWIFTPROX_OUTCOME_NONE.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn swiftprox_compound_depth(
    object1: CPlacedCompound,
    object2: CPlacedCompound,
    config: *const CDepthConfig,
    answer: *mut CompoundDepth,
) -> StatusCode {
    let status = guard(|| {
        // SAFETY: the header's pointer rules.
        unsafe {
            output(answer, "answer", CompoundDepth::default())?;
            Ok(compound::depth(bodies(object1, object2)?, &read_depth_config(config)?, &mut *answer)?)
        }
    });
    if status == StatusCode::ErrorBug && !answer.is_null() {
        // SAFETY: not null, writable by the caller.
        unsafe { answer.write(CompoundDepth::default()) };
    }
    status
}

/// Checks an answer of swiftprox_compound_depth independently of the search that found it. SWIFTPROX_OK: it is right for these
/// compounds and poses.
///
/// The named pieces are checked as by swiftprox_pair_depth_verify, compounds that are apart as by swiftprox_compound_verify. No two
/// pieces are deeper. The translation, which is no longer than upper, is proved to leave each two pieces apart or touching, by
/// their boxes or one by one. Errors are those of these two.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn swiftprox_compound_depth_verify(
    object1: CPlacedCompound,
    object2: CPlacedCompound,
    answer: *const CompoundDepth,
) -> StatusCode {
    guard(|| {
        // SAFETY: the header's pointer rules; an answer whose enumerators are valid is one, whatever else it holds.
        let (bodies, answer) = unsafe {
            if answer.is_null() {
                return Err(Failure::null("answer"));
            }
            check_signed_enumerators(&raw const (*answer).deepest.distance, "answer->deepest.distance")?;
            (bodies(object1, object2)?, &*answer)
        };
        Ok(compound::verify_depth(bodies, answer)?)
    })
}

/// Room for the contacts of two compounds. The caller owns the arrays, which may be null if their capacity is 0.
#[derive(Debug, Clone, Copy)]
#[repr(C)]
pub struct CCompoundContacts {
    /// Receives as many contacts as fit.
    pub contacts: *mut CompoundContact,
    /// Room for contacts.
    pub contact_capacity: usize,
    /// Receives as many points as fit.
    pub points: *mut ManifoldPoint,
    /// Room for points.
    pub point_capacity: usize,
    /// Receives the number of contacts found; 0 on failure.
    pub contact_count: usize,
    /// Receives the number of points found; 0 on failure.
    pub point_count: usize,
}

/// Finds the contacts of two compounds: the manifold of each two pieces up to config->max_distance apart, sorted by pieces, each as
/// swiftprox_pair_manifold finds it. Points of contact c begin at its first_point; there are manifold.point_count. A body on a seam
/// of two pieces has contacts with both.
///
/// On failure the counts are 0; contacts and points are unchanged. Same errors as swiftprox_pair_manifold. SWIFTPROX_ERROR_LIMIT: a
/// capacity is larger than memory.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn swiftprox_compound_get_contacts(
    object1: CPlacedCompound,
    object2: CPlacedCompound,
    config: *const CManifoldConfig,
    contacts: *mut CCompoundContacts,
) -> StatusCode {
    guard(|| {
        // SAFETY: the header's pointer rules.
        let (room, bodies, config) = unsafe {
            let room = exclusive(contacts, "contacts")?;
            (room.contact_count, room.point_count) = (0, 0);
            (room, bodies(object1, object2)?, read_manifold_config(config)?)
        };
        check_room(room.contacts, "contacts->contacts", room.contact_capacity)?;
        check_room(room.points, "contacts->points", room.point_capacity)?;
        let mut found = CompoundContacts::default();
        compound::contacts(bodies, &config, &mut found)?;
        for (place, contact) in found.contacts.iter().take(room.contact_capacity).enumerate() {
            // SAFETY: not null, and place < capacity.
            unsafe { room.contacts.add(place).write(*contact) };
        }
        for (place, point) in found.points.iter().take(room.point_capacity).enumerate() {
            // SAFETY: as above.
            unsafe { room.points.add(place).write(*point) };
        }
        (room.contact_count, room.point_count) = (found.contacts.len(), found.points.len());
        Ok(())
    })
}

/// Casts a ray at a compound and finds where it first enters a piece, as swiftprox_shape_cast_ray does for each. Same errors. On
/// failure the answer is reset.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn swiftprox_compound_cast_ray(
    object: CPlacedCompound,
    ray: *const Ray,
    answer: *mut CompoundRayAnswer,
) -> StatusCode {
    // SAFETY: the header's pointer rules.
    guard(|| unsafe {
        output(answer, "answer", CompoundRayAnswer::default())?;
        let body = body(object, ["object.compound", "object.pose"])?;
        output(answer, "answer", compound::cast_ray(body, input(ray, "ray")?)?)
    })
}

/// Locates a point of the world relative to a compound: by the piece with the least signed distance, as
/// swiftprox_shape_locate_point does for each. Same errors. On failure the answer is reset.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn swiftprox_compound_locate_point(
    object: CPlacedCompound,
    point: *const f64,
    answer: *mut CompoundPointAnswer,
) -> StatusCode {
    // SAFETY: the header's pointer rules; a point is three doubles.
    guard(|| unsafe {
        output(answer, "answer", CompoundPointAnswer::default())?;
        let body = body(object, ["object.compound", "object.pose"])?;
        output(answer, "answer", compound::locate_point(body, *input(point.cast::<[f64; 3]>(), "point")?)?)
    })
}

/// Checks an answer of swiftprox_compound_distance or swiftprox_compound_intersection independently of the search that found it.
/// SWIFTPROX_OK: it is right for these compounds and poses.
///
/// The pieces that are named are checked as by swiftprox_pair_verify. Unless they intersect, every two pieces are proved to be at
/// least lower apart, by their boxes or one by one. That boxes contain their pieces is not checked again. Same errors as
/// swiftprox_pair_verify; SWIFTPROX_ERROR_INVALID_ARGUMENT also for numbers of pieces that the compounds do not have.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn swiftprox_compound_verify(
    object1: CPlacedCompound,
    object2: CPlacedCompound,
    answer: *const CompoundAnswer,
) -> StatusCode {
    guard(|| {
        // SAFETY: the header's pointer rules; an answer whose enumerators are valid is one, whatever else it holds.
        let (bodies, answer) = unsafe {
            if answer.is_null() {
                return Err(Failure::null("answer"));
            }
            check_enumerators(&raw const (*answer).answer, "answer->answer")?;
            (bodies(object1, object2)?, &*answer)
        };
        Ok(compound::verify(bodies, answer)?)
    })
}

/// A compound and how it moves, an argument by value. Both pointers are only read during the call.
#[derive(Debug, Clone, Copy)]
#[repr(C)]
pub struct CMovingCompound {
    /// The compound.
    pub compound: *const Compound,
    /// Its motion.
    pub motion: *const CMotion,
}

/// Decides whether two moving compounds stay farther apart than config->max_distance, or when they first do not. Guarantees and
/// members are as for swiftprox_pair_cast; the step budget is for each two pieces. A hit names the two pieces that meet first, as
/// far as intervals of time tell.
///
/// `cache` may be shared with swiftprox_compound_distance. It affects speed and the choice of times within the guaranteed bounds.
/// On failure the answer is reset and its outcome is SWIFTPROX_CAST_OUTCOME_NONE; SWIFTPROX_ERROR_BUG also resets the cache. Same
/// errors as swiftprox_pair_cast. SWIFTPROX_ERROR_INVALID_ARGUMENT: also if config->ignores_parting is set.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn swiftprox_compound_cast(
    object1: CMovingCompound,
    object2: CMovingCompound,
    cache: *mut CCompoundCache,
    config: *const CCastConfig,
    answer: *mut CompoundCastAnswer,
) -> StatusCode {
    // SAFETY: the caller's; any bytes make a valid cache.
    let status = guard(|| unsafe {
        output(answer, "answer", CompoundCastAnswer::default())?;
        let cache = exclusive(cache.cast::<CompoundCache>(), "cache")?;
        with_moving([object1, object2], |bodies| {
            Ok(compound::cast(bodies, cache, &cast_config(config)?, &mut *answer)?)
        })
    });
    if status == StatusCode::ErrorBug {
        // SAFETY: null, or writable by the caller.
        unsafe { reset(cache, answer) };
    }
    status
}

/// Checks an answer of swiftprox_compound_cast for the same motions and config, independently of its search. SWIFTPROX_OK: it is
/// right.
///
/// The pieces that are named are checked as by swiftprox_pair_cast_verify. All others are proved to be farther apart than
/// max_distance, and at least clearance, up to time_lower, by their boxes or one by one. That boxes contain their pieces is not
/// checked again. Same errors as swiftprox_pair_cast_verify; SWIFTPROX_ERROR_INVALID_ARGUMENT also for numbers of pieces that the
/// compounds do not have.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn swiftprox_compound_cast_verify(
    object1: CMovingCompound,
    object2: CMovingCompound,
    config: *const CCastConfig,
    answer: *const CompoundCastAnswer,
) -> StatusCode {
    guard(|| {
        // SAFETY: the header's pointer rules; an answer whose enumerators are valid is one, whatever else it holds.
        let (config, answer) = unsafe {
            if answer.is_null() {
                return Err(Failure::null("answer"));
            }
            check_cast_enumerators(&raw const (*answer).answer, "answer->answer")?;
            (cast_config(config)?, &*answer)
        };
        // SAFETY: the header's pointer rules.
        unsafe { with_moving([object1, object2], |bodies| Ok(compound::verify_cast(bodies, &config, answer)?)) }
    })
}

/// Runs what asks about two moving compounds, in Rust's terms.
///
/// # Safety
/// The pointers meet the header's pointer rules.
unsafe fn with_moving(
    [object1, object2]: [CMovingCompound; 2],
    run: impl FnOnce([MovingCompound; 2]) -> Checked<()>,
) -> Checked<()> {
    // SAFETY: the header's pointer rules.
    let (compound1, motion1, compound2, motion2) = unsafe {
        (
            handle(object1.compound, "object1.compound")?,
            input(object1.motion, "object1.motion")?,
            handle(object2.compound, "object2.compound")?,
            input(object2.motion, "object2.motion")?,
        )
    };
    let (pose1, pose2) = (called(motion1), called(motion2));
    let first = read_motion(motion1, &pose1, "object1.motion")?;
    let second = read_motion(motion2, &pose2, "object2.motion")?;
    run([
        MovingCompound { compound: compound1, motion: &first },
        MovingCompound { compound: compound2, motion: &second },
    ])
}

/// A compound where it is, in Rust's terms.
///
/// # Safety
/// The pointers meet the header's pointer rules for `'a`.
unsafe fn body<'a>(object: CPlacedCompound, names: [&str; 2]) -> Checked<PlacedCompound<'a>> {
    // SAFETY: by the caller; a pose is twelve doubles, row by row, as is `Pose`.
    unsafe { Ok(handle(object.compound, names[0])?.at(input(object.pose.cast::<Pose>(), names[1])?)) }
}

/// The two of a pair.
///
/// # Safety
/// As of [`body`].
unsafe fn bodies<'a>(object1: CPlacedCompound, object2: CPlacedCompound) -> Checked<[PlacedCompound<'a>; 2]> {
    // SAFETY: by the caller.
    unsafe {
        Ok([body(object1, ["object1.compound", "object1.pose"])?, body(object2, ["object2.compound", "object2.pose"])?])
    }
}

/// Checks the arguments of a query and runs it.
///
/// # Safety
/// The pointers meet the header's pointer rules.
unsafe fn query<A: Copy + Default>(
    run: impl Fn([PlacedCompound; 2], &mut CompoundCache, &PairConfig, &mut A) -> Result<()>,
    [object1, object2]: [CPlacedCompound; 2],
    cache: *mut CCompoundCache,
    config: *const CPairConfig,
    answer: *mut A,
) -> StatusCode {
    // SAFETY: the caller's; any bytes make a valid cache.
    let status = guard(|| unsafe {
        output(answer, "answer", A::default())?;
        let bodies = bodies(object1, object2)?;
        let cache = exclusive(cache.cast::<CompoundCache>(), "cache")?;
        Ok(run(bodies, cache, &read_config(config)?, &mut *answer)?)
    });
    if status == StatusCode::ErrorBug {
        // SAFETY: null, or writable by the caller.
        unsafe { reset(cache, answer) };
    }
    status
}

/// What stands after a bug.
///
/// # Safety
/// Each is null, or writable.
unsafe fn reset<A: Default>(cache: *mut CCompoundCache, answer: *mut A) {
    // SAFETY: by the caller; any bytes make a valid cache.
    unsafe {
        if let Some(cache) = cache.cast::<CompoundCache>().as_mut() {
            *cache = CompoundCache::default();
        }
        if !answer.is_null() {
            answer.write(A::default());
        }
    }
}

fn create(compound: *mut *const Compound, make: impl FnOnce() -> Checked<Compound>) -> StatusCode {
    guard(|| {
        // SAFETY: the header's pointer rules.
        unsafe { output(compound, "compound", std::ptr::null()) }?;
        keep_panics_quiet();
        let made = Arc::into_raw(Arc::new(make()?));
        // SAFETY: as above.
        unsafe { output(compound, "compound", made) }
    })
}
