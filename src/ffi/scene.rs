//! Scenes: objects with ids and poses, activation, and queries whose results the scene owns.

use std::ffi::c_char;
use std::sync::Arc;

use super::shape::{CShapeOptions, read_arrays, read_options, read_path};
use super::{
    Checked, Failure, StatusCode, Versioned, array, exclusive, guard, input, keep_panics_quiet, output, read_bounds,
    read_levels, read_refinement, read_struct, write_struct,
};
use crate::error::Result;
use crate::math::{Matrix, Pose, ROTATION_LIMIT, Vector};
use crate::object::{ObjectId, ObjectOptions};
use crate::pair::{Bounds, Levels, Refinement};
use crate::scene::{PairResult, Scene, SceneAnswer, SceneOptions, SceneQuery, SceneStatistics};
use crate::shape::Shape;

/// Objects, their poses and the pairs that queries test. Make one with swift_scene_create.
#[derive(Debug)]
pub struct SceneHandle {
    scene: Scene,
    /// A change was begun and not ended: a panic left it, and what it left behind is unknown.
    poisoned: bool,
}

// The header's rule for threads needs this of both handles.
const _: () = {
    const fn is_shared_between_threads<T: Send + Sync>() {}
    is_shared_between_threads::<SceneHandle>();
    is_shared_between_threads::<Shape>();
};

/// How a scene is made. Fill it with swift_scene_options_init, then change what should differ.
#[derive(Debug, Clone, Copy)]
#[repr(C)]
pub struct CSceneOptions {
    /// Set by swift_scene_options_init.
    pub struct_size: usize,
    /// Largest accepted |RᵀR − I| entry of a pose, from 0 to 1e-2 (the default).
    pub rotation_limit: f64,
}

// SAFETY: repr(C), struct_size first.
unsafe impl Versioned for CSceneOptions {
    const NAME: &'static str = "swift_scene_options";
    const FIRST_SIZE: usize = size_of::<CSceneOptions>();
}

impl CSceneOptions {
    const DEFAULT: CSceneOptions =
        CSceneOptions { struct_size: size_of::<CSceneOptions>(), rotation_limit: ROTATION_LIMIT };
}

/// How an object begins. Fill it with swift_object_options_init, then change what should differ.
#[derive(Debug, Clone, Copy)]
#[repr(C)]
pub struct CObjectOptions {
    /// Set by swift_object_options_init.
    pub struct_size: usize,
    /// The caller's own; it comes back in every result. Default: 0.
    pub user_data: u64,
    /// Where it stands, row-major [R|T]. Default: the identity.
    pub pose: [f64; 12],
    /// Not 0: pairs of two such objects are never tested; it can still be moved. Default: 0.
    pub fixed: i32,
}

// SAFETY: repr(C), struct_size first.
unsafe impl Versioned for CObjectOptions {
    const NAME: &'static str = "swift_object_options";
    const FIRST_SIZE: usize = size_of::<CObjectOptions>();
}

impl CObjectOptions {
    const DEFAULT: CObjectOptions = CObjectOptions {
        struct_size: size_of::<CObjectOptions>(),
        user_data: 0,
        pose: [1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0],
        fixed: 0,
    };
}

/// What an object is. Set struct_size to sizeof(swift_object_info) before asking for it.
#[derive(Debug, Clone, Copy)]
#[repr(C)]
pub struct ObjectInfo {
    /// Set by the caller.
    pub struct_size: usize,
    /// The caller's own.
    pub user_data: u64,
    /// Number of convex pieces.
    pub piece_count: usize,
    /// Where it stands, row-major [R|T].
    pub pose: [f64; 12],
    /// 1 if it is fixed, else 0.
    pub fixed: i32,
}

// SAFETY: repr(C), struct_size first.
unsafe impl Versioned for ObjectInfo {
    const NAME: &'static str = "swift_object_info";
    const FIRST_SIZE: usize = size_of::<ObjectInfo>();
}

/// What a query over a scene is asked for. Fill it with swift_scene_query_init, then change what should differ.
#[derive(Debug, Clone, Copy)]
#[repr(C)]
pub struct CSceneQuery {
    /// Set by swift_scene_query_init.
    pub struct_size: usize,
    /// List pairs up to this distance, intersecting ones always; from 0 to infinity (the default: all pairs). A pair whose
    /// interval does not exclude it is listed, so that none is missed. swift_scene_query_intersection does not look at it.
    pub distance_tolerance: f64,
    /// Not 0: stop at the first intersecting pair, and list no pairs at all then. Default: 0.
    pub early_exit: i32,
    /// A swift_bounds: which interval the answers carry; with a finite distance tolerance the tight one always. Default: the
    /// tight one.
    pub bounds: i32,
    /// swift_scene_query_approximate_distance: upper - lower of a pair may be as large as this ... Default: 0.
    pub absolute_error: f64,
    /// ... or as this times lower. Both 0 (the default): as narrow as exact answers.
    pub relative_error: f64,
    /// swift_scene_query_approximate_distance: finite, it is what upper - lower of all tested pairs together may come to, in
    /// equal shares, whatever the two errors say. Default: infinity.
    pub error_budget: f64,
    /// swift_scene_query_approximate_distance: steps of marching after which a pair stops with what it has, 1 or more. Default:
    /// UINT32_MAX, no limit.
    pub step_budget: u32,
    /// A swift_levels: which levels of detail queries go through. Default: the automatic choice.
    pub levels: i32,
    /// A swift_refinement: how they go from level to level. Default: the adaptive one.
    pub refinement: i32,
}

// SAFETY: repr(C), struct_size first.
unsafe impl Versioned for CSceneQuery {
    const NAME: &'static str = "swift_scene_query";
    const FIRST_SIZE: usize = size_of::<CSceneQuery>();
}

impl CSceneQuery {
    const DEFAULT: CSceneQuery = CSceneQuery {
        struct_size: size_of::<CSceneQuery>(),
        distance_tolerance: f64::INFINITY,
        early_exit: 0,
        bounds: Bounds::Tight as i32,
        absolute_error: 0.0,
        relative_error: 0.0,
        error_budget: f64::INFINITY,
        step_budget: u32::MAX,
        levels: Levels::Automatic as i32,
        refinement: Refinement::Adaptive as i32,
    };
}

/// What a query over a scene found.
#[derive(Debug, Clone, Copy)]
#[repr(C)]
pub struct CSceneAnswer {
    /// The pairs that the query lists, by object 1, object 2, piece 1, piece 2, objects in order of creation. Owned by the
    /// scene, valid until its next call that takes it by a pointer that is not const. Null when count is 0.
    pub pairs: *const PairResult,
    /// How many pairs.
    pub count: usize,
    /// 1 if any tested pair intersects, else 0.
    pub intersecting: i32,
}

impl CSceneAnswer {
    const EMPTY: CSceneAnswer = CSceneAnswer { pairs: std::ptr::null(), count: 0, intersecting: 0 };
}

// --- Scenes --------------------------------------------------------------------------------------------------------------

/// Fills `options` with the defaults, struct_size included.
///
/// SWIFT_ERROR_NULL_POINTER: options is null.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn swift_scene_options_init(options: *mut CSceneOptions) -> StatusCode {
    // SAFETY: the header's pointer rules.
    guard(|| unsafe { output(options, "options", CSceneOptions::DEFAULT) })
}

/// Makes an empty scene; the caller gives it back with swift_scene_destroy. On failure `*scene` is null. `options` may be null
/// for the defaults.
///
/// SWIFT_ERROR_INVALID_ARGUMENT: the rotation limit is out of range. SWIFT_ERROR_NULL_POINTER, SWIFT_ERROR_STRUCT_SIZE: the
/// message names the argument.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn swift_scene_create(options: *const CSceneOptions, scene: *mut *mut SceneHandle) -> StatusCode {
    // SAFETY: the header's pointer rules.
    guard(|| unsafe {
        output(scene, "scene", std::ptr::null_mut())?;
        keep_panics_quiet();
        let options = read_struct(options, CSceneOptions::DEFAULT)?;
        let options = SceneOptions { rotation_limit: options.rotation_limit };
        let handle = SceneHandle { scene: Scene::new(&options)?, poisoned: false };
        scene.write(Box::into_raw(Box::new(handle)));
        Ok(())
    })
}

/// Ends a scene, a poisoned one too; its shares of shapes are given back, its ids and results end with it. Null is ignored.
///
/// SWIFT_ERROR_BUG: the scene is gone, but perhaps not all of its memory.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn swift_scene_destroy(scene: *mut SceneHandle) -> StatusCode {
    guard(|| {
        if !scene.is_null() {
            // SAFETY: a live scene by the header's pointer rules; every one comes from Box::into_raw.
            drop(unsafe { Box::from_raw(scene) });
        }
        Ok(())
    })
}

// --- Objects -------------------------------------------------------------------------------------------------------------

/// Fills `options` with the defaults, struct_size included.
///
/// SWIFT_ERROR_NULL_POINTER: options is null.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn swift_object_options_init(options: *mut CObjectOptions) -> StatusCode {
    // SAFETY: the header's pointer rules.
    guard(|| unsafe { output(options, "options", CObjectOptions::DEFAULT) })
}

/// Adds an object of one or several convex pieces in one local frame. All its pairs are active. The scene takes a share of each
/// shape: the caller's own may be released at once. On failure nothing is added and `*id` is 0, which names no object.
/// `options` may be null for the defaults.
///
/// SWIFT_ERROR_INVALID_ARGUMENT: no pieces. SWIFT_ERROR_POSE: the pose is refused. SWIFT_ERROR_LIMIT: more objects or pieces
/// than a scene holds. SWIFT_ERROR_NULL_POINTER, SWIFT_ERROR_STRUCT_SIZE: the message names the argument. SWIFT_ERROR_POISONED.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn swift_scene_add_object(
    scene: *mut SceneHandle,
    pieces: *const *const Shape,
    piece_count: usize,
    options: *const CObjectOptions,
    id: *mut ObjectId,
) -> StatusCode {
    // SAFETY: the header's pointer rules.
    unsafe {
        add(scene, options, id, || {
            let pieces = array(pieces, piece_count, "pieces")?;
            let share = |(i, &piece): (usize, &*const Shape)| {
                if piece.is_null() {
                    return Err(Failure::null(&format!("pieces[{i}]")));
                }
                // A live shape, which came from Arc::into_raw: one more share of it.
                Arc::increment_strong_count(piece);
                Ok(Arc::from_raw(piece))
            };
            pieces.iter().enumerate().map(share).collect()
        })
    }
}

/// Makes a shape as swift_shape_create_from_mesh does and adds an object of that one piece as swift_scene_add_object does, with
/// the arguments and the errors of both. Both options may be null for the defaults.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn swift_scene_add_mesh(
    scene: *mut SceneHandle,
    vertices: *const f64,
    vertex_count: usize,
    indices: *const u32,
    valences: *const u32,
    face_count: usize,
    shape_options: *const CShapeOptions,
    object_options: *const CObjectOptions,
    id: *mut ObjectId,
) -> StatusCode {
    // SAFETY: the header's pointer rules.
    unsafe {
        add(scene, object_options, id, || {
            let making = read_options(shape_options)?;
            let mesh = read_arrays(vertices, vertex_count, indices, valences, face_count)?;
            let shape = making.run(|options, progress| Shape::from_mesh_in_steps(&mesh, options, progress))?;
            Ok(vec![Arc::new(shape)])
        })
    }
}

/// Makes a shape as swift_shape_create_from_file does and adds an object of that one piece as swift_scene_add_object does, with
/// the arguments and the errors of both. Both options may be null for the defaults.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn swift_scene_add_file(
    scene: *mut SceneHandle,
    path: *const c_char,
    shape_options: *const CShapeOptions,
    object_options: *const CObjectOptions,
    id: *mut ObjectId,
) -> StatusCode {
    // SAFETY: the header's pointer rules.
    unsafe {
        add(scene, object_options, id, || {
            let making = read_options(shape_options)?;
            let path = read_path(path)?;
            let shape = making.run(|options, progress| Shape::from_file_in_steps(path, options, progress))?;
            Ok(vec![Arc::new(shape)])
        })
    }
}

/// Adds an object with the pieces (shared), the pose, the fixedness and the user data of `original`. All its pairs are active,
/// whatever those of its original are. On failure nothing is added and `*id` is 0.
///
/// SWIFT_ERROR_HANDLE: original names no object of this scene. SWIFT_ERROR_LIMIT: more objects than a scene holds.
/// SWIFT_ERROR_NULL_POINTER: the message names the argument. SWIFT_ERROR_POISONED.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn swift_scene_copy_object(
    scene: *mut SceneHandle,
    original: ObjectId,
    id: *mut ObjectId,
) -> StatusCode {
    // SAFETY: the header's pointer rules.
    unsafe {
        change(scene, |scene| {
            output(id, "id", ObjectId::NULL)?;
            id.write(scene.copy_object(original)?);
            Ok(())
        })
    }
}

/// Removes an object and its pairs. Its id is refused from now on; all other ids stay as they are.
///
/// SWIFT_ERROR_HANDLE: id names no object of this scene. SWIFT_ERROR_NULL_POINTER: scene is null. SWIFT_ERROR_POISONED.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn swift_scene_remove_object(scene: *mut SceneHandle, id: ObjectId) -> StatusCode {
    // SAFETY: the header's pointer rules.
    unsafe { change(scene, |scene| Ok(scene.remove_object(id)?)) }
}

/// Sets the number that comes back in every result of this object.
///
/// SWIFT_ERROR_HANDLE: id names no object of this scene. SWIFT_ERROR_NULL_POINTER: scene is null. SWIFT_ERROR_POISONED.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn swift_scene_set_user_data(
    scene: *mut SceneHandle,
    id: ObjectId,
    user_data: u64,
) -> StatusCode {
    // SAFETY: the header's pointer rules.
    unsafe { change(scene, |scene| Ok(scene.set_user_data(id, user_data)?)) }
}

/// Says what an object is: set info->struct_size to sizeof(swift_object_info) first.
///
/// SWIFT_ERROR_HANDLE: id names no object of this scene. SWIFT_ERROR_NULL_POINTER: scene or info is null.
/// SWIFT_ERROR_STRUCT_SIZE: info->struct_size is none that is known. SWIFT_ERROR_POISONED.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn swift_scene_get_object_info(
    scene: *const SceneHandle,
    id: ObjectId,
    info: *mut ObjectInfo,
) -> StatusCode {
    // SAFETY: the header's pointer rules.
    guard(|| unsafe {
        let object = look(scene)?.object(id)?;
        let value = ObjectInfo {
            struct_size: size_of::<ObjectInfo>(),
            user_data: object.user_data(),
            piece_count: object.pieces().len(),
            pose: std::array::from_fn(|i| object.pose().rows[i / 4][i % 4]),
            fixed: i32::from(object.fixed()),
        };
        write_struct(info, "info", &value)
    })
}

/// Gives a piece of an object, by its number from 0. The scene owns the share: take one more with swift_shape_retain to keep
/// the shape longer than the object. On failure `*shape` is null.
///
/// SWIFT_ERROR_HANDLE: id names no object of this scene. SWIFT_ERROR_INVALID_ARGUMENT: the object has no such piece.
/// SWIFT_ERROR_NULL_POINTER: scene or shape is null. SWIFT_ERROR_POISONED.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn swift_scene_get_piece(
    scene: *const SceneHandle,
    id: ObjectId,
    piece: usize,
    shape: *mut *const Shape,
) -> StatusCode {
    // SAFETY: the header's pointer rules.
    guard(|| unsafe {
        output(shape, "shape", std::ptr::null())?;
        let pieces = look(scene)?.object(id)?.pieces();
        let found = pieces.get(piece).ok_or_else(|| {
            let message = format!("piece {piece} of an object with {}", pieces.len());
            Failure::new(StatusCode::ErrorInvalidArgument, message)
        })?;
        shape.write(Arc::as_ptr(found));
        Ok(())
    })
}

// --- Poses ---------------------------------------------------------------------------------------------------------------

/// Moves an object, a fixed one too: `pose` is 12 doubles, row-major [R|T]. On failure it stays where it is.
///
/// SWIFT_ERROR_HANDLE: id names no object of this scene. SWIFT_ERROR_POSE: the pose is refused. SWIFT_ERROR_NULL_POINTER: scene
/// or pose is null. SWIFT_ERROR_POISONED.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn swift_scene_set_pose(scene: *mut SceneHandle, id: ObjectId, pose: *const f64) -> StatusCode {
    // SAFETY: the header's pointer rules; a pose is twelve doubles, row by row, as is `Pose`.
    unsafe { change(scene, |scene| Ok(scene.set_pose(id, input(pose.cast::<Pose>(), "pose")?)?)) }
}

/// As swift_scene_set_pose, from a row-major 3x3 `rotation` and a `translation`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn swift_scene_set_transform(
    scene: *mut SceneHandle,
    id: ObjectId,
    rotation: *const f64,
    translation: *const f64,
) -> StatusCode {
    // SAFETY: the header's pointer rules.
    unsafe {
        change(scene, |scene| {
            let rotation = input(rotation.cast::<[f64; 9]>(), "rotation")?;
            let translation = input(translation.cast::<[f64; 3]>(), "translation")?;
            Ok(scene.set_pose(id, &pose(rotation, translation))?)
        })
    }
}

/// Moves all objects that are not fixed, in order of creation: `poses` holds 12 doubles for each of the `count`. On failure all
/// stay where they are.
///
/// SWIFT_ERROR_INVALID_ARGUMENT: count is not the number of objects that are not fixed. SWIFT_ERROR_POSE: a pose is refused;
/// the message names it. SWIFT_ERROR_NULL_POINTER: scene or poses is null. SWIFT_ERROR_POISONED.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn swift_scene_set_all_poses(
    scene: *mut SceneHandle,
    poses: *const f64,
    count: usize,
) -> StatusCode {
    // SAFETY: the header's pointer rules; see swift_scene_set_pose.
    unsafe {
        change(scene, |scene| {
            check_pose_count(scene, count)?;
            Ok(scene.set_all_poses(array(poses.cast::<Pose>(), count, "poses")?)?)
        })
    }
}

/// As swift_scene_set_all_poses, from 9 doubles of `rotations` and 3 of `translations` for each object.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn swift_scene_set_all_transforms(
    scene: *mut SceneHandle,
    rotations: *const f64,
    translations: *const f64,
    count: usize,
) -> StatusCode {
    // SAFETY: the header's pointer rules.
    unsafe {
        change(scene, |scene| {
            check_pose_count(scene, count)?;
            let rotations = array(rotations.cast::<[f64; 9]>(), count, "rotations")?;
            let translations = array(translations.cast::<[f64; 3]>(), count, "translations")?;
            let poses: Vec<Pose> =
                rotations.iter().zip(translations).map(|(rotation, translation)| pose(rotation, translation)).collect();
            Ok(scene.set_all_poses(&poses)?)
        })
    }
}

// --- Activation ----------------------------------------------------------------------------------------------------------

/// Activates the pair of two objects, in either order, with all its pairs of pieces. Two fixed objects are never tested all the
/// same.
///
/// SWIFT_ERROR_HANDLE: an id names no object of this scene. SWIFT_ERROR_INVALID_ARGUMENT: one object twice.
/// SWIFT_ERROR_NULL_POINTER: scene is null. SWIFT_ERROR_POISONED.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn swift_scene_activate_pair(
    scene: *mut SceneHandle,
    id1: ObjectId,
    id2: ObjectId,
) -> StatusCode {
    // SAFETY: the header's pointer rules.
    unsafe { change(scene, |scene| Ok(scene.set_pair_active(id1, id2, true)?)) }
}

/// Deactivates the pair of two objects: queries leave it out. Errors as of swift_scene_activate_pair.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn swift_scene_deactivate_pair(
    scene: *mut SceneHandle,
    id1: ObjectId,
    id2: ObjectId,
) -> StatusCode {
    // SAFETY: the header's pointer rules.
    unsafe { change(scene, |scene| Ok(scene.set_pair_active(id1, id2, false)?)) }
}

/// Activates all pairs that an object is in now.
///
/// SWIFT_ERROR_HANDLE: id names no object of this scene. SWIFT_ERROR_NULL_POINTER: scene is null. SWIFT_ERROR_POISONED.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn swift_scene_activate_object(scene: *mut SceneHandle, id: ObjectId) -> StatusCode {
    // SAFETY: the header's pointer rules.
    unsafe { change(scene, |scene| Ok(scene.set_object_active(id, true)?)) }
}

/// Deactivates all pairs that an object is in now. Errors as of swift_scene_activate_object.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn swift_scene_deactivate_object(scene: *mut SceneHandle, id: ObjectId) -> StatusCode {
    // SAFETY: the header's pointer rules.
    unsafe { change(scene, |scene| Ok(scene.set_object_active(id, false)?)) }
}

/// Activates all pairs that there are now. Objects added later begin with all their pairs active in any case.
///
/// SWIFT_ERROR_NULL_POINTER: scene is null. SWIFT_ERROR_POISONED.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn swift_scene_activate_all(scene: *mut SceneHandle) -> StatusCode {
    // SAFETY: the header's pointer rules.
    unsafe {
        change(scene, |scene| {
            scene.set_all_active(true);
            Ok(())
        })
    }
}

/// Deactivates all pairs that there are now. Errors as of swift_scene_activate_all.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn swift_scene_deactivate_all(scene: *mut SceneHandle) -> StatusCode {
    // SAFETY: the header's pointer rules.
    unsafe {
        change(scene, |scene| {
            scene.set_all_active(false);
            Ok(())
        })
    }
}

/// Sets `*active` to 1 if queries test the pair of two objects, given in either order, else to 0 (also on failure).
///
/// Errors as of swift_scene_activate_pair; SWIFT_ERROR_NULL_POINTER also when active is null.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn swift_scene_is_pair_active(
    scene: *const SceneHandle,
    id1: ObjectId,
    id2: ObjectId,
    active: *mut i32,
) -> StatusCode {
    // SAFETY: the header's pointer rules.
    guard(|| unsafe {
        output(active, "active", 0)?;
        active.write(i32::from(look(scene)?.is_pair_active(id1, id2)?));
        Ok(())
    })
}

// --- Queries -------------------------------------------------------------------------------------------------------------

/// Fills `query` with the defaults, struct_size included.
///
/// SWIFT_ERROR_NULL_POINTER: query is null.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn swift_scene_query_init(query: *mut CSceneQuery) -> StatusCode {
    // SAFETY: the header's pointer rules.
    guard(|| unsafe { output(query, "query", CSceneQuery::DEFAULT) })
}

/// Lists the intersecting pairs (touching ones are), each with its verdict alone. `query` may be null for the defaults.
///
/// SWIFT_ERROR_INVALID_ARGUMENT: a member of query is out of range. SWIFT_ERROR_LIMIT: no memory for the list of pairs.
/// SWIFT_ERROR_NULL_POINTER, SWIFT_ERROR_STRUCT_SIZE: the message names the argument. SWIFT_ERROR_POISONED. The answer is empty
/// then. What a scene has accepted it answers: no pair makes a query fail.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn swift_scene_query_intersection(
    scene: *mut SceneHandle,
    query: *const CSceneQuery,
    answer: *mut CSceneAnswer,
) -> StatusCode {
    // SAFETY: the header's pointer rules.
    unsafe { ask(Scene::query_intersection, scene, query, answer) }
}

/// Lists the pairs whose distance is at most the distance tolerance, intersecting ones included. Errors as of
/// swift_scene_query_intersection.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn swift_scene_query_tolerance(
    scene: *mut SceneHandle,
    query: *const CSceneQuery,
    answer: *mut CSceneAnswer,
) -> StatusCode {
    // SAFETY: the header's pointer rules.
    unsafe { ask(Scene::query_tolerance, scene, query, answer) }
}

/// Lists the pairs whose distance is at most the distance tolerance, intersecting ones included, with what swift_pair_distance
/// says of each. Errors as of swift_scene_query_intersection.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn swift_scene_query_exact_distance(
    scene: *mut SceneHandle,
    query: *const CSceneQuery,
    answer: *mut CSceneAnswer,
) -> StatusCode {
    // SAFETY: the header's pointer rules.
    unsafe { ask(Scene::query_exact_distance, scene, query, answer) }
}

/// As swift_scene_query_exact_distance, each distance as narrow as query->absolute_error, relative_error or error_budget ask
/// for and no narrower, with what swift_pair_approximate says of each pair. A pair whose step budget ran out before the verdict
/// (SWIFT_OUTCOME_UNDECIDED) is listed and does not count as intersecting. Errors as of swift_scene_query_intersection.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn swift_scene_query_approximate_distance(
    scene: *mut SceneHandle,
    query: *const CSceneQuery,
    answer: *mut CSceneAnswer,
) -> StatusCode {
    // SAFETY: the header's pointer rules.
    unsafe { ask(Scene::query_approximate_distance, scene, query, answer) }
}

/// As swift_scene_query_exact_distance, with what swift_pair_contact says of each pair. Errors as of
/// swift_scene_query_intersection.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn swift_scene_query_contacts(
    scene: *mut SceneHandle,
    query: *const CSceneQuery,
    answer: *mut CSceneAnswer,
) -> StatusCode {
    // SAFETY: the header's pointer rules.
    unsafe { ask(Scene::query_contacts, scene, query, answer) }
}

/// What the queries of a scene did since it was made or swift_scene_reset_statistics was called.
///
/// SWIFT_ERROR_NULL_POINTER: scene or statistics is null. SWIFT_ERROR_POISONED.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn swift_scene_get_statistics(
    scene: *const SceneHandle,
    statistics: *mut SceneStatistics,
) -> StatusCode {
    // SAFETY: the header's pointer rules.
    guard(|| unsafe { output(statistics, "statistics", *look(scene)?.statistics()) })
}

/// Sets the statistics of a scene to zero.
///
/// SWIFT_ERROR_NULL_POINTER: scene is null. SWIFT_ERROR_POISONED.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn swift_scene_reset_statistics(scene: *mut SceneHandle) -> StatusCode {
    // SAFETY: the header's pointer rules.
    unsafe {
        change(scene, |scene| {
            scene.reset_statistics();
            Ok(())
        })
    }
}

// --- What the functions above share --------------------------------------------------------------------------------------

fn poisoned() -> Failure {
    Failure::new(
        StatusCode::ErrorPoisoned,
        "the scene met a bug in an earlier call; all that can be done with it is to destroy it",
    )
}

/// A scene to read.
///
/// # Safety
/// `scene` meets the header's pointer rules.
unsafe fn look<'a>(scene: *const SceneHandle) -> Checked<&'a Scene> {
    // SAFETY: by the caller.
    let handle = unsafe { input(scene, "scene") }?;
    if handle.poisoned { Err(poisoned()) } else { Ok(&handle.scene) }
}

/// Runs `body` on a scene that nobody else uses; if a panic leaves `body`, the scene stays poisoned.
///
/// # Safety
/// `scene` meets the header's pointer rules.
unsafe fn change(scene: *mut SceneHandle, body: impl FnOnce(&mut Scene) -> Checked<()>) -> StatusCode {
    guard(|| {
        // SAFETY: by the caller.
        let handle = unsafe { exclusive(scene, "scene") }?;
        if handle.poisoned {
            return Err(poisoned());
        }
        handle.poisoned = true;
        let result = body(&mut handle.scene);
        handle.poisoned = false;
        result
    })
}

/// Adds an object of the pieces that `make` makes.
///
/// # Safety
/// The pointers meet the header's pointer rules.
unsafe fn add(
    scene: *mut SceneHandle,
    options: *const CObjectOptions,
    id: *mut ObjectId,
    make: impl FnOnce() -> Checked<Vec<Arc<Shape>>>,
) -> StatusCode {
    let mut made = None;
    // Made outside the scene: a bug in the making of shapes does not spoil it.
    let status = guard(|| {
        // SAFETY: by the caller.
        unsafe { output(id, "id", ObjectId::NULL) }?;
        // SAFETY: by the caller.
        let options = unsafe { read_struct(options, CObjectOptions::DEFAULT) }?;
        let options = ObjectOptions {
            pose: Pose::from_row_major(&options.pose),
            fixed: options.fixed != 0,
            user_data: options.user_data,
        };
        made = Some((make()?, options));
        Ok(())
    });
    let Some((pieces, options)) = made else {
        return status;
    };
    // SAFETY: by the caller; `id` was written before.
    unsafe {
        change(scene, |scene| {
            id.write(scene.add_object(pieces, &options)?);
            Ok(())
        })
    }
}

/// A pose from a rotation and a translation.
fn pose(rotation: &[f64; 9], translation: &[f64; 3]) -> Pose {
    Pose::new(&Matrix::from_row_slice(rotation), &Vector::from(*translation))
}

/// Refuses a wrong number of poses before any of them is read.
fn check_pose_count(scene: &Scene, count: usize) -> Checked<()> {
    let moving = scene.objects().filter(|object| !object.fixed()).count();
    if count != moving {
        let message = format!("{count} poses for {moving} objects that are not fixed");
        return Err(Failure::new(StatusCode::ErrorInvalidArgument, message));
    }
    Ok(())
}

/// Runs a query and shows its results where the scene has them.
///
/// # Safety
/// The pointers meet the header's pointer rules.
unsafe fn ask(
    run: for<'a> fn(&'a mut Scene, &SceneQuery) -> Result<SceneAnswer<'a>>,
    scene: *mut SceneHandle,
    query: *const CSceneQuery,
    answer: *mut CSceneAnswer,
) -> StatusCode {
    let mut found = CSceneAnswer::EMPTY;
    // SAFETY: by the caller.
    let status = unsafe {
        change(scene, |scene| {
            let query = read_struct(query, CSceneQuery::DEFAULT)?;
            let query = SceneQuery {
                early_exit: query.early_exit != 0,
                distance_tolerance: query.distance_tolerance,
                bounds: read_bounds(query.bounds, "query")?,
                absolute_error: query.absolute_error,
                relative_error: query.relative_error,
                error_budget: query.error_budget,
                step_budget: query.step_budget,
                levels: read_levels(query.levels, "query")?,
                refinement: read_refinement(query.refinement, "query")?,
            };
            let listed = run(scene, &query)?;
            if !listed.pairs.is_empty() {
                found.pairs = listed.pairs.as_ptr();
            }
            found.count = listed.pairs.len();
            found.intersecting = i32::from(listed.intersecting);
            Ok(())
        })
    };
    // SAFETY: by the caller.
    match guard(|| unsafe { output(answer, "answer", found) }) {
        StatusCode::Ok => status,
        failure => failure,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::shape::ShapeOptions;
    use std::ffi::CStr;
    use std::ptr::{null, null_mut};

    fn last_message() -> String {
        let message = super::super::library::swift_library_last_error_message();
        // SAFETY: never null, terminated, and unchanged until the next failure of this thread.
        unsafe { CStr::from_ptr(message) }.to_string_lossy().into_owned()
    }

    fn new_scene() -> *mut SceneHandle {
        let mut scene = null_mut();
        // SAFETY: null options, and room for a pointer.
        assert_eq!(unsafe { swift_scene_create(null(), &mut scene) }, StatusCode::Ok);
        scene
    }

    #[test]
    fn a_panic_becomes_a_status_with_its_message_and_poisons_its_scene_only() {
        let (broken, sound) = (new_scene(), new_scene());
        // SAFETY: living scenes, used by this thread only, and room for every output.
        unsafe {
            let status = change(broken, |_| panic!("injected {}", 42));
            assert_eq!(status, StatusCode::ErrorBug);
            assert!(last_message().contains("injected 42"), "{}", last_message());
            assert!(last_message().contains("scene.rs"), "{}", last_message());

            let mut answer = CSceneAnswer { pairs: null(), count: 7, intersecting: 7 };
            let mut statistics = SceneStatistics::default();
            assert_eq!(swift_scene_query_contacts(broken, null(), &mut answer), StatusCode::ErrorPoisoned);
            assert_eq!((answer.count, answer.intersecting), (0, 0));
            assert_eq!(swift_scene_activate_all(broken), StatusCode::ErrorPoisoned);
            assert_eq!(swift_scene_get_statistics(broken, &mut statistics), StatusCode::ErrorPoisoned);
            assert_eq!(swift_scene_query_contacts(sound, null(), &mut answer), StatusCode::Ok);
            assert_eq!(swift_scene_destroy(broken), StatusCode::Ok);
            assert_eq!(swift_scene_destroy(sound), StatusCode::Ok);
        }
    }

    #[test]
    fn a_panic_in_a_query_poisons_its_scene_and_none_that_shares_its_shapes() {
        let corners = [Vector::zeros(), Vector::x(), Vector::y(), Vector::z()];
        let shape = Arc::new(Shape::from_points(&corners, &ShapeOptions::default()).unwrap());
        let (broken, sound) = (new_scene(), new_scene());
        let pieces = [Arc::as_ptr(&shape)];
        let mut id = ObjectId::NULL;
        let mut answer = CSceneAnswer { pairs: null(), count: 7, intersecting: 7 };
        // SAFETY: living scenes, used by this thread only, a living shape, and room for every output.
        unsafe {
            for scene in [broken, broken, sound, sound] {
                assert_eq!(swift_scene_add_object(scene, pieces.as_ptr(), 1, null(), &mut id), StatusCode::Ok);
            }
            let run = |scene: &mut Scene, query: &SceneQuery| -> Result<SceneAnswer<'static>> {
                // Half of it is done.
                let _ = scene.query_contacts(query);
                panic!("injected")
            };
            assert_eq!(ask(run, broken, null(), &mut answer), StatusCode::ErrorBug);
            assert_eq!((answer.count, answer.intersecting), (0, 0));
            assert_eq!(swift_scene_query_contacts(broken, null(), &mut answer), StatusCode::ErrorPoisoned);
            assert_eq!(swift_scene_query_contacts(sound, null(), &mut answer), StatusCode::Ok);
            assert_eq!((answer.count, answer.intersecting), (1, 1));
            assert_eq!(swift_scene_destroy(broken), StatusCode::Ok);
            assert_eq!(swift_scene_query_contacts(sound, null(), &mut answer), StatusCode::Ok);
            assert_eq!(swift_scene_destroy(sound), StatusCode::Ok);
        }
        assert_eq!(Arc::strong_count(&shape), 1, "a poisoned scene gives its shares back, too");
    }

    #[test]
    fn a_panic_in_the_making_of_a_shape_leaves_the_scene_usable() {
        let scene = new_scene();
        let mut id = ObjectId::from_bits(7);
        // SAFETY: a living scene, used by this thread only, and room for every output.
        unsafe {
            let status = add(scene, null(), &mut id, || panic!("injected"));
            assert_eq!(status, StatusCode::ErrorBug);
            assert_eq!(id, ObjectId::NULL);
            assert_eq!(swift_scene_activate_all(scene), StatusCode::Ok);
            assert_eq!(swift_scene_destroy(scene), StatusCode::Ok);
        }
    }
}
