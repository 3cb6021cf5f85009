//! Which pairs of objects a scene tests, by the program's own word.

use std::ffi::c_void;

use super::failure::StatusCode;
use super::log::must_return;
use super::pointers::array;
use super::scene::{SceneHandle, change};
use crate::scene::PairFilter;
use crate::scene::object::ObjectId;

/// Says whether a pair of objects is to be tested (not 0) or not (0), the earlier created object first; `user` is the pointer given
/// with the callback. It should always say the same of a pair. It runs in the thread that queries, must return, and cannot use the
/// scene; a C++ exception that leaves it ends the program.
pub type PairFilterCallback =
    Option<unsafe extern "C-unwind" fn(object1: ObjectId, object2: ObjectId, user: *mut c_void) -> i32>;

/// What goes with a callback from call to call.
struct User(*mut c_void);

// SAFETY: the pointer is only ever handed back to the callback, which swiftprox_scene_set_pair_filter requires to be callable from
// every thread that uses the scene.
unsafe impl Send for User {}
// SAFETY: as above.
unsafe impl Sync for User {}

/// Asks `filter` of each pair of objects whether it is to be tested, once for each of its pairs of pieces when that comes near, and
/// of many objects without a tolerance in each query. Null: none is asked, as before the first call. All pairs that are near are
/// asked anew: set the same filter again when it has changed its mind. The callback may be called from every thread that queries the scene.
///
/// SWIFTPROX_ERROR_NULL_POINTER: scene is null. SWIFTPROX_ERROR_POISONED.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn swiftprox_scene_set_pair_filter(
    scene: *mut SceneHandle,
    filter: PairFilterCallback,
    user: *mut c_void,
) -> StatusCode {
    let user = User(user);
    // SAFETY: the header's pointer rules.
    unsafe {
        change(scene, |scene| {
            scene.set_pair_filter(filter.map(|callback| {
                PairFilter::new(move |object1, object2| {
                    let User(pointer) = &user;
                    // The callback takes any two ids of the scene and its own user pointer.
                    must_return(|| callback(object1, object2, *pointer)) != 0
                })
            }));
            Ok(())
        })
    }
}

/// From now on queries test these pairs of objects and no others, however near: for a program with a broad phase of its own.
/// `pairs` holds 2 ids for each of the `count`, in any order; what is there twice is tested once. Activation, filters and fixed
/// objects are heeded as ever; objects removed later are in no pair. Pairs that stay keep what they remember. On failure the pairs
/// of before stay.
///
/// SWIFTPROX_ERROR_HANDLE: an id names no object of this scene. SWIFTPROX_ERROR_INVALID_ARGUMENT: one object twice in a pair. The
/// message says which. SWIFTPROX_ERROR_MEMORY. SWIFTPROX_ERROR_NULL_POINTER: scene or pairs is null. SWIFTPROX_ERROR_POISONED.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn swiftprox_scene_set_pairs(
    scene: *mut SceneHandle,
    pairs: *const ObjectId,
    count: usize,
) -> StatusCode {
    // SAFETY: the header's pointer rules; two ids next to each other are an array of two.
    unsafe {
        change(scene, |scene| {
            let pairs = array(pairs.cast::<[ObjectId; 2]>(), count, "pairs")?;
            Ok(scene.set_pairs(Some(pairs))?)
        })
    }
}

/// Takes back what swiftprox_scene_set_pairs has set: from now on the scene finds the pairs that are near by itself, as it did
/// before.
///
/// SWIFTPROX_ERROR_NULL_POINTER: scene is null. SWIFTPROX_ERROR_POISONED.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn swiftprox_scene_reset_pairs(scene: *mut SceneHandle) -> StatusCode {
    // SAFETY: the header's pointer rules.
    unsafe { change(scene, |scene| Ok(scene.set_pairs(None)?)) }
}
