//! Objects of a scene: added, removed, moved, and asked what they are.

use std::ffi::c_char;
use std::sync::Arc;

use super::arrays::{read_arrays, read_path};
use super::scene::{SceneHandle, change, look};
use super::shape_options::{CShapeOptions, read_options};
use super::{Checked, Failure, StatusCode, Versioned, array, guard, input, output, read_struct, write_struct};
use crate::base::math::{Matrix, Pose, Vector};
use crate::base::memory::{collected, with_capacity};
use crate::scene::Scene;
use crate::scene::object::{ObjectId, ObjectOptions};
use crate::shape::Shape;

/// How an object begins. Fill it with swiftprox_object_options_init, then change what should differ.
#[derive(Debug, Clone, Copy)]
#[repr(C)]
pub struct CObjectOptions {
    /// Set by swiftprox_object_options_init.
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
    const NAME: &'static str = "swiftprox_object_options";
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

/// What an object is. Set struct_size to sizeof(swiftprox_object_info) before asking for it.
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
    const NAME: &'static str = "swiftprox_object_info";
    const FIRST_SIZE: usize = size_of::<ObjectInfo>();
}

impl ObjectInfo {
    /// What is said of no object.
    const UNKNOWN: ObjectInfo = ObjectInfo {
        struct_size: size_of::<ObjectInfo>(),
        user_data: 0,
        piece_count: 0,
        pose: [f64::NAN; 12],
        fixed: 0,
    };
}

// --- Objects -------------------------------------------------------------------------------------------------------------

/// Fills `options` with the defaults, struct_size included.
///
/// SWIFTPROX_ERROR_NULL_POINTER: options is null.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn swiftprox_object_options_init(options: *mut CObjectOptions) -> StatusCode {
    // SAFETY: the header's pointer rules.
    guard(|| unsafe { output(options, "options", CObjectOptions::DEFAULT) })
}

/// Adds an object of one or several convex pieces in one local frame. All its pairs are active. The scene takes a share of each
/// shape: the caller's own may be released at once. On failure nothing is added and `*id` is 0, which names no object.
/// `options` may be null for the defaults.
///
/// SWIFTPROX_ERROR_INVALID_ARGUMENT: no pieces. SWIFTPROX_ERROR_POSE: the pose is refused. SWIFTPROX_ERROR_LIMIT: more objects or
/// pieces than a scene holds. SWIFTPROX_ERROR_MEMORY. SWIFTPROX_ERROR_NULL_POINTER, SWIFTPROX_ERROR_STRUCT_SIZE: the message names
/// the argument. SWIFTPROX_ERROR_POISONED.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn swiftprox_scene_add_object(
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
            let mut shares = with_capacity(pieces.len())?;
            for piece in pieces.iter().enumerate() {
                shares.push(share(piece)?);
            }
            Ok(shares)
        })
    }
}

/// Makes a shape as swiftprox_shape_create_from_mesh does and adds an object of that one piece as swiftprox_scene_add_object does,
/// with the arguments and the errors of both. Both options may be null for the defaults.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn swiftprox_scene_add_mesh(
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

/// Makes a shape as swiftprox_shape_create_from_file does and adds an object of that one piece as swiftprox_scene_add_object does,
/// with the arguments and the errors of both. Both options may be null for the defaults.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn swiftprox_scene_add_file(
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
/// SWIFTPROX_ERROR_HANDLE: original names no object of this scene. SWIFTPROX_ERROR_LIMIT: more objects than a scene holds.
/// SWIFTPROX_ERROR_MEMORY.
/// SWIFTPROX_ERROR_NULL_POINTER: the message names the argument. SWIFTPROX_ERROR_POISONED.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn swiftprox_scene_copy_object(
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
/// SWIFTPROX_ERROR_HANDLE: id names no object of this scene. SWIFTPROX_ERROR_NULL_POINTER: scene is null. SWIFTPROX_ERROR_POISONED.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn swiftprox_scene_remove_object(scene: *mut SceneHandle, id: ObjectId) -> StatusCode {
    // SAFETY: the header's pointer rules.
    unsafe { change(scene, |scene| Ok(scene.remove_object(id)?)) }
}

/// Sets the number that comes back in every result of this object.
///
/// SWIFTPROX_ERROR_HANDLE: id names no object of this scene. SWIFTPROX_ERROR_NULL_POINTER: scene is null. SWIFTPROX_ERROR_POISONED.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn swiftprox_scene_set_user_data(
    scene: *mut SceneHandle,
    id: ObjectId,
    user_data: u64,
) -> StatusCode {
    // SAFETY: the header's pointer rules.
    unsafe { change(scene, |scene| Ok(scene.set_user_data(id, user_data)?)) }
}

/// Says what an object is: set info->struct_size to sizeof(swiftprox_object_info) first. On failure the pose is NaN, all else 0.
///
/// SWIFTPROX_ERROR_HANDLE: id names no object of this scene. SWIFTPROX_ERROR_NULL_POINTER: scene or info is null.
/// SWIFTPROX_ERROR_STRUCT_SIZE: info->struct_size is none that is known. SWIFTPROX_ERROR_POISONED.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn swiftprox_scene_get_object_info(
    scene: *const SceneHandle,
    id: ObjectId,
    info: *mut ObjectInfo,
) -> StatusCode {
    // SAFETY: the header's pointer rules.
    guard(|| unsafe {
        write_struct(info, "info", &ObjectInfo::UNKNOWN)?;
        look(scene, |scene| {
            let object = scene.object(id)?;
            let value = ObjectInfo {
                struct_size: size_of::<ObjectInfo>(),
                user_data: object.user_data(),
                piece_count: object.pieces().len(),
                pose: std::array::from_fn(|i| object.pose().rows[i / 4][i % 4]),
                fixed: i32::from(object.fixed()),
            };
            write_struct(info, "info", &value)
        })
    })
}

/// Gives a piece of an object, by its number from 0. The scene owns the share: take one more with swiftprox_shape_retain to keep
/// the shape longer than the object. On failure `*shape` is null.
///
/// SWIFTPROX_ERROR_HANDLE: id names no object of this scene. SWIFTPROX_ERROR_INVALID_ARGUMENT: the object has no such piece.
/// SWIFTPROX_ERROR_NULL_POINTER: scene or shape is null. SWIFTPROX_ERROR_POISONED.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn swiftprox_scene_get_piece(
    scene: *const SceneHandle,
    id: ObjectId,
    piece: usize,
    shape: *mut *const Shape,
) -> StatusCode {
    // SAFETY: the header's pointer rules.
    guard(|| unsafe {
        output(shape, "shape", std::ptr::null())?;
        look(scene, |scene| {
            let pieces = scene.object(id)?.pieces();
            let found = pieces.get(piece).ok_or_else(|| {
                let message = format!("piece {piece} of an object with {}", pieces.len());
                Failure::new(StatusCode::ErrorInvalidArgument, message)
            })?;
            shape.write(Arc::as_ptr(found));
            Ok(())
        })
    })
}

// --- Poses ---------------------------------------------------------------------------------------------------------------

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

/// Moves all objects that are not fixed, in order of creation: `poses` holds 12 doubles for each of the `count`. On failure all
/// stay where they are.
///
/// SWIFTPROX_ERROR_INVALID_ARGUMENT: count is not the number of objects that are not fixed. SWIFTPROX_ERROR_POSE: a pose is
/// refused; the message names it. SWIFTPROX_ERROR_NULL_POINTER: scene or poses is null. SWIFTPROX_ERROR_POISONED.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn swiftprox_scene_set_all_poses(
    scene: *mut SceneHandle,
    poses: *const f64,
    count: usize,
) -> StatusCode {
    // SAFETY: the header's pointer rules; see swiftprox_scene_set_pose.
    unsafe {
        change(scene, |scene| {
            check_pose_count(scene, count)?;
            Ok(scene.set_all_poses(array(poses.cast::<Pose>(), count, "poses")?)?)
        })
    }
}

/// As swiftprox_scene_set_all_poses, from 9 doubles of `rotations` and 3 of `translations` for each object; SWIFTPROX_ERROR_MEMORY,
/// too.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn swiftprox_scene_set_all_transforms(
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
            let pose_of = |(rotation, translation)| pose(rotation, translation);
            let poses: Vec<Pose> = collected(rotations.iter().zip(translations).map(pose_of))?;
            Ok(scene.set_all_poses(&poses)?)
        })
    }
}

// --- What the functions above share --------------------------------------------------------------------------------------

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
            ..ObjectOptions::default()
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

#[cfg(test)]
mod tests {
    use super::super::scene::{swiftprox_scene_activate_all, swiftprox_scene_create, swiftprox_scene_destroy};
    use super::*;
    use std::ptr::{null, null_mut};

    #[test]
    fn a_panic_in_the_making_of_a_shape_leaves_the_scene_usable() {
        let mut scene = null_mut();
        let mut id = ObjectId::from_bits(7);
        // SAFETY: a living scene, used by this thread only, and room for every output.
        unsafe {
            assert_eq!(swiftprox_scene_create(null(), &mut scene), StatusCode::Ok);
            let status = add(scene, null(), &mut id, || panic!("injected"));
            assert_eq!(status, StatusCode::ErrorBug);
            assert_eq!(id, ObjectId::NULL);
            assert_eq!(swiftprox_scene_activate_all(scene), StatusCode::Ok);
            assert_eq!(swiftprox_scene_destroy(scene), StatusCode::Ok);
        }
    }
}
