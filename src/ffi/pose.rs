//! Where objects of a scene and their pieces are.

use super::failure::{Checked, Failure, StatusCode};
use super::guard::guard;
use super::object::check_piece;
use super::pointers::{array, input, output};
use super::scene::{SceneHandle, change, look};
use crate::base::math::{Matrix, Pose, Vector};
use crate::base::memory::collected;
use crate::scene::Scene;
use crate::scene::object::ObjectId;

/// Moves an object, a fixed one too: `pose` is 12 doubles, row-major [R|T]. On failure it stays where it is.
///
/// SWIFTPROX_ERROR_HANDLE: id names no object of this scene. SWIFTPROX_ERROR_POSE: the pose is refused.
/// SWIFTPROX_ERROR_NULL_POINTER: scene or pose is null. SWIFTPROX_ERROR_POISONED.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn swiftprox_scene_set_pose(
    scene: *mut SceneHandle,
    id: ObjectId,
    pose: *const f64,
) -> StatusCode {
    // SAFETY: the header's pointer rules; a pose is twelve doubles, row by row, as is `Pose`.
    unsafe { change(scene, |scene| Ok(scene.set_pose(id, input(pose.cast::<Pose>(), "pose")?)?)) }
}

/// As swiftprox_scene_set_pose, from a row-major 3x3 `rotation` and a `translation`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn swiftprox_scene_set_transform(
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

/// Moves the objects of `count` ids, fixed ones too: `poses` holds 12 doubles for each. Of an object that is given twice the later
/// pose counts. Null `ids` are all objects that are not fixed, in order of creation. On failure all stay where they are; the
/// message says which pose or id is refused. Workers share the work where it is in order of creation.
///
/// SWIFTPROX_ERROR_HANDLE: an id names no object of this scene. SWIFTPROX_ERROR_POSE: a pose is refused.
/// SWIFTPROX_ERROR_INVALID_ARGUMENT: ids is null, and count is not the number of objects that are not fixed.
/// SWIFTPROX_ERROR_MEMORY. SWIFTPROX_ERROR_NULL_POINTER: scene or poses is null. SWIFTPROX_ERROR_POISONED.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn swiftprox_scene_set_poses(
    scene: *mut SceneHandle,
    ids: *const ObjectId,
    poses: *const f64,
    count: usize,
) -> StatusCode {
    // SAFETY: the header's pointer rules; see swiftprox_scene_set_pose.
    unsafe {
        change(scene, |scene| {
            check_pose_count(scene, ids, count)?;
            set_poses(scene, ids, array(poses.cast::<Pose>(), count, "poses")?)
        })
    }
}

/// As swiftprox_scene_set_poses, from 9 doubles of `rotations` and 3 of `translations` for each object.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn swiftprox_scene_set_transforms(
    scene: *mut SceneHandle,
    ids: *const ObjectId,
    rotations: *const f64,
    translations: *const f64,
    count: usize,
) -> StatusCode {
    // SAFETY: the header's pointer rules.
    unsafe {
        change(scene, |scene| {
            check_pose_count(scene, ids, count)?;
            let rotations = array(rotations.cast::<[f64; 9]>(), count, "rotations")?;
            let translations = array(translations.cast::<[f64; 3]>(), count, "translations")?;
            let pose_of = |(rotation, translation)| pose(rotation, translation);
            let poses: Vec<Pose> = collected(rotations.iter().zip(translations).map(pose_of))?;
            set_poses(scene, ids, &poses)
        })
    }
}

/// Moves one piece within its object, by its number from 0: `pose` is 12 doubles, row-major [R|T]. The piece is in the world where
/// the object's pose times this one puts it, each of the twelve numbers rounded; its exact body is what these give. Points and
/// features of results are in the piece's own frame. On failure it stays where it is.
///
/// SWIFTPROX_ERROR_HANDLE: id names no object of this scene. SWIFTPROX_ERROR_INVALID_ARGUMENT: the object has no such piece.
/// SWIFTPROX_ERROR_POSE: the pose is refused, alone or with the object's. SWIFTPROX_ERROR_MEMORY.
/// SWIFTPROX_ERROR_NULL_POINTER: scene or pose is null. SWIFTPROX_ERROR_POISONED.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn swiftprox_scene_set_piece_pose(
    scene: *mut SceneHandle,
    id: ObjectId,
    piece: u32,
    pose: *const f64,
) -> StatusCode {
    // SAFETY: the header's pointer rules; see swiftprox_scene_set_pose.
    unsafe { change(scene, |scene| Ok(scene.set_piece_pose(id, piece, input(pose.cast::<Pose>(), "pose")?)?)) }
}

/// Writes where a piece of an object is in the world, 12 doubles, row-major [R|T]: the pose for which queries answer, as
/// swiftprox_pair_verify takes it. On failure they are NaN.
///
/// SWIFTPROX_ERROR_HANDLE: id names no object of this scene. SWIFTPROX_ERROR_INVALID_ARGUMENT: the object has no such piece.
/// SWIFTPROX_ERROR_NULL_POINTER: scene or pose is null. SWIFTPROX_ERROR_POISONED.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn swiftprox_scene_get_piece_pose(
    scene: *const SceneHandle,
    id: ObjectId,
    piece: u32,
    pose: *mut f64,
) -> StatusCode {
    let pose = pose.cast::<[f64; 12]>();
    // SAFETY: the header's pointer rules.
    guard(|| unsafe {
        output(pose, "pose", [f64::NAN; 12])?;
        look(scene, |scene| {
            let object = scene.object(id)?;
            check_piece(&object, piece as usize)?;
            let world = object.piece_pose_in_world(piece as usize);
            pose.write(std::array::from_fn(|i| world.rows[i / 4][i % 4]));
            Ok(())
        })
    })
}

// --- What the functions above share --------------------------------------------------------------------------------------

/// A pose from a rotation and a translation.
fn pose(rotation: &[f64; 9], translation: &[f64; 3]) -> Pose {
    Pose::new(&Matrix::from_row_slice(rotation), &Vector::from(*translation))
}

/// Refuses a wrong number of poses of all objects before any of them is read.
fn check_pose_count(scene: &Scene, ids: *const ObjectId, count: usize) -> Checked<()> {
    let moving = scene.objects().filter(|object| !object.fixed()).count();
    if ids.is_null() && count != moving {
        let message = format!(
            "ids is null, which means all, and there are {count} poses for {moving} objects that are not fixed"
        );
        return Err(Failure::new(StatusCode::ErrorInvalidArgument, message));
    }
    Ok(())
}

/// Moves the objects of ids, or without ids all that are not fixed.
///
/// # Safety
/// `ids` is null or as long as the poses.
unsafe fn set_poses(scene: &mut Scene, ids: *const ObjectId, poses: &[Pose]) -> Checked<()> {
    if ids.is_null() {
        return Ok(scene.set_all_poses(poses)?);
    }
    // SAFETY: by the caller.
    Ok(scene.set_poses(unsafe { array(ids, poses.len(), "ids") }?, poses)?)
}
