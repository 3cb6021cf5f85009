//! Which pairs of objects a scene tests, by the program's own word.

use std::ffi::c_void;

use super::failure::StatusCode;
use super::log::must_return;
use super::pointers::array;
use super::scene::{SceneHandle, change};
use crate::scene::PairFilter;
use crate::scene::object::ObjectId;

/// Returns whether a pair of objects is tested: not 0, or 0. object1 was created first; `user` is the pointer given with the
/// callback. It must always return the same for a pair. It runs in the thread that queries, must return, and must not use the
/// scene. A C++ exception that leaves it ends the program.
pub type PairFilterCallback =
    Option<unsafe extern "C-unwind" fn(object1: ObjectId, object2: ObjectId, user: *mut c_void) -> i32>;

/// A callback's companions from call to call.
struct User(*mut c_void);

// SAFETY: the pointer is only ever handed back to the callback, which swiftprox_scene_set_pair_filter requires to be callable from
// every thread that uses the scene.
unsafe impl Send for User {}
// SAFETY: as above.
unsafe impl Sync for User {}

/// Sets a filter that decides which pairs of objects are tested. It is called once for each pair of pieces that comes near. Queries
/// of many objects without a max_distance call it each time. Null (the default): no filter. Each call of this function makes the
/// scene ask again about near pairs, so set the same filter again after its decisions change. Any thread that queries the scene may
/// call the filter.
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

/// Restricts queries to the given pairs of objects, however near others are; for programs with their own broad phase. `pairs` holds
/// 2 ids for each of `count` pairs, in any order. Duplicates are tested once. Activation, filters and fixed objects are respected
/// as usual; pairs of objects removed later are dropped. Remaining pairs keep their caches. On failure the former pairs stay.
///
/// SWIFTPROX_ERROR_INVALID_ARGUMENT: a pair names one object twice. The message says which.
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

/// Undoes swiftprox_scene_set_pairs: the scene finds near pairs by itself again.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn swiftprox_scene_reset_pairs(scene: *mut SceneHandle) -> StatusCode {
    // SAFETY: the header's pointer rules.
    unsafe { change(scene, |scene| Ok(scene.set_pairs(None)?)) }
}
