//! Many objects added or removed at once.

use super::failure::{Checked, Failure, StatusCode};
use super::guard::guard;
use super::object::{CObjectOptions, object_options, share};
use super::pointers::array;
use super::scene::{SceneHandle, change};
use crate::base::memory::with_capacity;
use crate::scene::object::{ObjectId, ObjectOptions};
use crate::shape::Shape;

/// Adds one object of one convex piece for each of `count` shapes, in order, like swiftprox_scene_add_object. `options` is an array
/// of `count` structs, each initialised with SWIFTPROX_OBJECT_OPTIONS_DEFAULT, or null for the defaults. `ids` receives the ids.
///
/// On failure nothing is added and all ids are null. The message names the first refused place. Same errors as
/// swiftprox_scene_add_object. SWIFTPROX_ERROR_STRUCT_SIZE: also if the options differ in size.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn swiftprox_scene_add_objects(
    scene: *mut SceneHandle,
    shapes: *const *const Shape,
    options: *const CObjectOptions,
    count: usize,
    ids: *mut ObjectId,
) -> StatusCode {
    // SAFETY: the header's pointer rules.
    let refused = guard(|| unsafe {
        array(ids.cast_const(), count, "ids")?;
        (0..count).for_each(|k| ids.add(k).write(ObjectId::NULL));
        Ok(())
    });
    if refused != StatusCode::Ok {
        return refused;
    }
    // SAFETY: the header's pointer rules; `ids` was written before.
    unsafe {
        change(scene, |scene| {
            let mut shares = with_capacity(count)?;
            for (k, &shape) in array(shapes, count, "shapes")?.iter().enumerate() {
                shares.push(share(shape, format_args!("shapes[{k}]"))?);
            }
            let added = scene.add_shapes(&shares, &all_object_options(options, count)?)?;
            added.iter().enumerate().for_each(|(k, id)| ids.add(k).write(*id));
            Ok(())
        })
    }
}

/// Removes `count` objects and their pairs, like swiftprox_scene_remove_object.
///
/// On failure nothing is removed; the message names the first refused id. SWIFTPROX_ERROR_HANDLE: it names no object of this scene.
/// SWIFTPROX_ERROR_INVALID_ARGUMENT: it is given twice.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn swiftprox_scene_remove_objects(
    scene: *mut SceneHandle,
    ids: *const ObjectId,
    count: usize,
) -> StatusCode {
    // SAFETY: the header's pointer rules.
    unsafe { change(scene, |scene| Ok(scene.remove_objects(array(ids, count, "ids")?)?)) }
}

// --- What the functions above share --------------------------------------------------------------------------------------

/// How `count` objects begin: each as one behind the other has it, or all as by default.
///
/// # Safety
/// `options` is null, or points to `count` structs of one size that meet the header's pointer rules.
unsafe fn all_object_options(options: *const CObjectOptions, count: usize) -> Checked<Vec<ObjectOptions>> {
    let mut all = with_capacity(count)?;
    // SAFETY: by the caller; struct_size is the first member.
    let size = if options.is_null() || count == 0 { 0 } else { unsafe { options.cast::<usize>().read() } };
    if !size.is_multiple_of(align_of::<CObjectOptions>()) {
        let message = format!("options[0]: struct_size is {size}; begin with SWIFTPROX_OBJECT_OPTIONS_DEFAULT");
        return Err(Failure::new(StatusCode::ErrorStructSize, message));
    }
    for k in 0..count {
        // SAFETY: by the caller: all before had this size.
        let place = unsafe { options.byte_add(k * size) };
        // SAFETY: as above.
        if !place.is_null() && unsafe { place.cast::<usize>().read() } != size {
            let message = format!(
                "options[{k}] has another struct_size than the first: begin each with SWIFTPROX_OBJECT_OPTIONS_DEFAULT"
            );
            return Err(Failure::new(StatusCode::ErrorStructSize, message));
        }
        // SAFETY: by the caller.
        let (own, body) = unsafe { object_options(place) }?;
        if body.is_some() {
            let message = format!(
                "options[{k}].ground or compound is set: add grounds and compounds one by one by swiftprox_scene_add_object"
            );
            return Err(Failure::new(StatusCode::ErrorInvalidArgument, message));
        }
        all.push(own);
    }
    Ok(all)
}
