//! Poses of a scene's objects and of their pieces.

use super::failure::{Checked, Failure, StatusCode};
use super::guard::guard;
use super::object::check_piece;
use super::pointers::{array, input, output};
use super::scene::{SceneHandle, change, change_in_any, look};
use crate::base::math::{Matrix, Pose, Vector};
use crate::base::memory::collected;
use crate::scene::Scene;
use crate::scene::object::ObjectId;

/// Makes a pose, 12 doubles, from a quaternion x, y, z, w (the order of Eigen's coefficients and of ROS) and a translation.
///
/// SWIFTPROX_ERROR_POSE: a number is not finite, or the quaternion's length is not 1 to 1e-2. The pose is then NaN.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn swiftprox_pose_from_quaternion(
    quaternion: *const f64,
    translation: *const f64,
    pose: *mut f64,
) -> StatusCode {
    // SAFETY: the header's pointer rules.
    guard(|| unsafe {
        output(pose.cast::<[f64; 12]>(), "pose", [f64::NAN; 12])?;
        let [x, y, z, w] = *input(quaternion.cast::<[f64; 4]>(), "quaternion")?;
        let &[tx, ty, tz] = input(translation.cast::<[f64; 3]>(), "translation")?;
        let length = (x * x + y * y + z * z + w * w).sqrt();
        if !((length - 1.0).abs() <= 1e-2) {
            let message = format!("the quaternion's length is {length:e}, it must be 1: divide it by its length");
            return Err(Failure::new(StatusCode::ErrorPose, message));
        }
        let [x, y, z, w] = [x, y, z, w].map(|part| part / length);
        let rotation = [
            [1.0 - 2.0 * (y * y + z * z), 2.0 * (x * y - w * z), 2.0 * (x * z + w * y)],
            [2.0 * (x * y + w * z), 1.0 - 2.0 * (x * x + z * z), 2.0 * (y * z - w * x)],
            [2.0 * (x * z - w * y), 2.0 * (y * z + w * x), 1.0 - 2.0 * (x * x + y * y)],
        ];
        let [a, b, c] = rotation;
        let made = Pose { rows: [[a[0], a[1], a[2], tx], [b[0], b[1], b[2], ty], [c[0], c[1], c[2], tz]] };
        made.check()?;
        output(pose.cast::<Pose>(), "pose", made)
    })
}

/// Makes a pose, 12 doubles, from the 16 numbers of a column-major 4x4 matrix, as OpenGL, glm and Eigen have them.
///
/// SWIFTPROX_ERROR_POSE: the last row is not 0 0 0 1, as in a transposed matrix, or the pose is refused. The pose is then NaN.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn swiftprox_pose_from_column_major(matrix: *const f64, pose: *mut f64) -> StatusCode {
    // SAFETY: the header's pointer rules.
    guard(|| unsafe {
        output(pose.cast::<[f64; 12]>(), "pose", [f64::NAN; 12])?;
        let m = input(matrix.cast::<[[f64; 4]; 4]>(), "matrix")?;
        let last = m.map(|column| column[3]);
        if last != [0.0, 0.0, 0.0, 1.0] {
            let message =
                format!("the last row of the matrix is {last:?}, not 0 0 0 1: is it row-major, or a projection?");
            return Err(Failure::new(StatusCode::ErrorPose, message));
        }
        let made = Pose { rows: std::array::from_fn(|row| std::array::from_fn(|column| m[column][row])) };
        made.check()?;
        output(pose.cast::<Pose>(), "pose", made)
    })
}

/// Moves an object, also a fixed one. `pose` is 12 doubles, row-major [R|T]. On failure the object does not move.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn swiftprox_scene_set_pose(
    scene: *mut SceneHandle,
    id: ObjectId,
    pose: *const f64,
) -> StatusCode {
    // SAFETY: the header's pointer rules; a pose is twelve doubles, row by row, as is `Pose`.
    unsafe { change_in_any(scene, |scene| Ok(scene.set_pose(id, input(pose.cast::<Pose>(), "pose")?)?)) }
}

/// Like swiftprox_scene_set_pose, with a row-major 3x3 `rotation` and a `translation`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn swiftprox_scene_set_transform(
    scene: *mut SceneHandle,
    id: ObjectId,
    rotation: *const f64,
    translation: *const f64,
) -> StatusCode {
    // SAFETY: the header's pointer rules.
    unsafe {
        change_in_any(scene, |scene| {
            let rotation = input(rotation.cast::<[f64; 9]>(), "rotation")?;
            let translation = input(translation.cast::<[f64; 3]>(), "translation")?;
            Ok(scene.set_pose(id, &pose(rotation, translation))?)
        })
    }
}

/// Moves `count` objects, also fixed ones. `poses` holds 12 doubles per id; the last pose of a repeated id counts. Null `ids` means
/// all objects that are not fixed, in order of creation. Workers share the work if ids are in order of creation. On failure no
/// object moves; the message names the refused pose or id.
///
/// SWIFTPROX_ERROR_INVALID_ARGUMENT: ids is null, and count is not the number of objects that are not fixed.
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

/// Like swiftprox_scene_set_poses, with 9 doubles of `rotations` and 3 of `translations` per object.
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

/// Moves a piece, numbered from 0, within its object. `pose` is 12 doubles, row-major [R|T]. The piece's pose in the world is the
/// object's pose times this one, each entry rounded; queries take the rounded pose as exact. Points and features of results are in
/// the piece's own frame. On failure the piece does not move.
///
/// SWIFTPROX_ERROR_INVALID_ARGUMENT: there is no such piece. SWIFTPROX_ERROR_POSE: the pose is refused, alone or with the object's.
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

/// Writes a piece's pose in the world: 12 doubles, row-major [R|T]. Queries use this pose, and swiftprox_pair_verify takes it. On
/// failure the doubles are NaN.
///
/// SWIFTPROX_ERROR_INVALID_ARGUMENT: there is no such piece.
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
