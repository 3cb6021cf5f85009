//! Names that functions had before, for programs that were compiled or written with them: each does what its new name says.

use super::failure::StatusCode;
use super::filter::swiftprox_scene_reset_pairs;
use super::query::{
    CSceneAnswer, CSceneQuery, swiftprox_scene_query_approximate, swiftprox_scene_query_contact,
    swiftprox_scene_query_distance,
};
use super::scene::SceneHandle;

/// Former name of swiftprox_scene_query_distance, which lists what is within a tolerance.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn swiftprox_scene_query_tolerance(
    scene: *mut SceneHandle,
    query: *const CSceneQuery,
    answer: *mut CSceneAnswer,
) -> StatusCode {
    // SAFETY: the header's pointer rules.
    unsafe { swiftprox_scene_query_distance(scene, query, answer) }
}

/// Former name of swiftprox_scene_query_distance.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn swiftprox_scene_query_exact_distance(
    scene: *mut SceneHandle,
    query: *const CSceneQuery,
    answer: *mut CSceneAnswer,
) -> StatusCode {
    // SAFETY: the header's pointer rules.
    unsafe { swiftprox_scene_query_distance(scene, query, answer) }
}

/// Former name of swiftprox_scene_query_approximate.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn swiftprox_scene_query_approximate_distance(
    scene: *mut SceneHandle,
    query: *const CSceneQuery,
    answer: *mut CSceneAnswer,
) -> StatusCode {
    // SAFETY: the header's pointer rules.
    unsafe { swiftprox_scene_query_approximate(scene, query, answer) }
}

/// Former name of swiftprox_scene_query_contact.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn swiftprox_scene_query_contacts(
    scene: *mut SceneHandle,
    query: *const CSceneQuery,
    answer: *mut CSceneAnswer,
) -> StatusCode {
    // SAFETY: the header's pointer rules.
    unsafe { swiftprox_scene_query_contact(scene, query, answer) }
}

/// Former name of swiftprox_scene_reset_pairs.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn swiftprox_scene_find_pairs(scene: *mut SceneHandle) -> StatusCode {
    // SAFETY: the header's pointer rules.
    unsafe { swiftprox_scene_reset_pairs(scene) }
}
