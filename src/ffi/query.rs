//! Queries over a scene, whose results the scene owns, and their statistics.

use super::enumerators::{ContactDetailNumber, PiecePairsNumber, read_enumerator};
use super::failure::{Checked, StatusCode};
use super::guard::{caught, guard};
use super::pointers::output;
use super::scene::{SceneHandle, change, change_guarded, look};
use super::structs::{Versioned, view_struct};
use super::tuning::{CPairTuning, PairTuning, read_pair_tuning};
use std::mem::MaybeUninit;

use crate::manifold::ManifoldPoint;
use crate::pair::SignedDistance;
use crate::scene::{
    Contact, ContactDetail, PairResult, PiecePairs, Scene, SceneAnswer, SceneContacts, SceneQuery, SceneStatistics,
};

/// Default of swiftprox_scene_query.max_distance: 0 for swiftprox_scene_query_contact, infinity for all other queries.
pub const DEFAULT_MAX_DISTANCE: f64 = -1.0;

/// Options of a query over a scene. Initialise with SWIFTPROX_SCENE_QUERY_DEFAULT.
#[derive(Debug, Clone, Copy)]
#[repr(C)]
pub struct CSceneQuery {
    /// Set by SWIFTPROX_SCENE_QUERY_DEFAULT.
    pub struct_size: usize,
    /// Pairs whose true distance is at most this are listed, from 0 to infinity (all pairs). Intersecting pairs, and pairs that
    /// a step budget leaves undecided, are always listed. Default: SWIFTPROX_DEFAULT_MAX_DISTANCE, which is 0 for contacts, else
    /// infinity. swiftprox_scene_query_intersection only checks its range.
    pub max_distance: f64,
    /// swiftprox_scene_query_approximate: upper - lower of a pair may be at most the larger of this ... Default: 0.
    pub absolute_error: f64,
    /// ... and this times lower. Default: 0. If both are 0, intervals are as narrow as exact answers.
    pub relative_error: f64,
    /// swiftprox_scene_query_approximate: if finite, the limit of the sum of upper - lower over all listed pairs, beyond what
    /// exact answers need. It replaces both errors. Only pairs that support maps or levels of detail can answer with a share of
    /// it take one. All other pairs are answered exactly. So are all pairs if the scene does not keep all pairs
    /// (swiftprox_scene_set_kept_pair_limit). Default: infinity.
    pub error_budget: f64,
    /// swiftprox_scene_query_approximate: the largest number of marching steps per pair, 1 or more. A pair then stops with the
    /// interval it has. Default: UINT32_MAX, no limit.
    pub step_budget: u32,
    /// Not 0: stop at the first intersecting pair, in the order of results, of those that piece_pairs selects. It is
    /// swiftprox_scene_answer.found; no pairs are listed then. Default: 0.
    pub early_exit: i32,
    /// Where pairs start and which levels of detail they use (swiftprox/tuning.h). Default: null, the automatic choice.
    pub tuning: *const CPairTuning,
    /// swiftprox_scene_query_contact: what each pair's contact adds to its answer. absolute_error, relative_error and
    /// step_budget then apply to the depths. Other queries refuse it. Default: SWIFTPROX_CONTACT_DETAIL_NONE.
    pub detail: ContactDetailNumber,
    /// swiftprox_scene_query_placed: the groups of objects to test, one bit each. Default: 0, which means all.
    pub mask: u32,
    /// Which pairs of pieces are listed for every two objects. Default: SWIFTPROX_PIECE_PAIRS_EVERY.
    pub piece_pairs: PiecePairsNumber,
}

// SAFETY: repr(C), struct_size first, any bytes are valid.
unsafe impl Versioned for CSceneQuery {
    const NAME: &'static str = "swiftprox_scene_query";
}

impl CSceneQuery {
    /// The defaults, as in the header.
    pub const DEFAULT: CSceneQuery = CSceneQuery {
        struct_size: size_of::<CSceneQuery>(),
        max_distance: DEFAULT_MAX_DISTANCE,
        absolute_error: 0.0,
        relative_error: 0.0,
        error_budget: f64::INFINITY,
        step_budget: u32::MAX,
        early_exit: 0,
        tuning: std::ptr::null(),
        detail: ContactDetail::None as i32,
        mask: 0,
        piece_pairs: PiecePairs::Every as i32,
    };
}

/// The results of a query over a scene.
#[derive(Debug, Clone, Copy)]
#[repr(C)]
pub struct CSceneAnswer {
    /// The listed pairs, sorted by object 1, object 2, piece 1, piece 2, with objects in order of creation. The scene owns
    /// them. They are valid until its next query, swiftprox_scene_shrink, or its end. Objects may be moved, added and removed
    /// meanwhile. Null if count is 0.
    pub pairs: *const PairResult,
    /// Number of pairs.
    pub count: usize,
    /// 1 if any tested pair intersects, else 0. With SWIFTPROX_PIECE_PAIRS_FIRST later pairs are not tested.
    pub intersecting: i32,
    /// The intersecting pair at which the query stopped (swiftprox_scene_query.early_exit), else null. Of the pairs
    /// that swiftprox_scene_query.piece_pairs selects, it is the first intersecting one in the order of pairs, but a step
    /// budget may leave an earlier one undecided. It holds the query's usual answer. Owned and valid as pairs.
    pub found: *const PairResult,
    /// With swiftprox_scene_query.detail: one contact per listed pair, in the same order; after an early exit, only that of
    /// found. Owned and valid as pairs. Null if contact_count is 0.
    pub contacts: *const Contact,
    /// Number of contacts: 0 without a detail.
    pub contact_count: usize,
    /// The points of all manifolds; those of a contact begin at its first_point. Owned and valid as pairs. Null if point_count
    /// is 0.
    pub points: *const ManifoldPoint,
    /// Number of points.
    pub point_count: usize,
}

impl CSceneAnswer {
    /// The answer of a failed query.
    pub const EMPTY: CSceneAnswer = CSceneAnswer {
        pairs: std::ptr::null(),
        count: 0,
        intersecting: 0,
        found: std::ptr::null(),
        contacts: std::ptr::null(),
        contact_count: 0,
        points: std::ptr::null(),
        point_count: 0,
    };

    pub(super) fn new(answer: &SceneAnswer) -> CSceneAnswer {
        let SceneContacts { contacts, points } = answer.contacts;
        CSceneAnswer {
            pairs: pointer_to(answer.pairs),
            count: answer.pairs.len(),
            intersecting: i32::from(answer.intersecting),
            found: answer.found.map_or(std::ptr::null(), std::ptr::from_ref),
            contacts: pointer_to(contacts),
            contact_count: contacts.len(),
            points: pointer_to(points),
            point_count: points.len(),
        }
    }
}

/// Null for an empty slice.
fn pointer_to<T>(slice: &[T]) -> *const T {
    if slice.is_empty() { std::ptr::null() } else { slice.as_ptr() }
}

/// Lists the intersecting pairs, touching ones included. Each answer has only outcome, decided_by, proof, statistics, and distance,
/// lower and upper, which are 0. Cylinders, cones and ellipsoids that may intersect are listed, too, as undecided; `intersecting`
/// does not count them. A null `query` means the defaults. On failure the answer is empty.
///
/// No accepted pair makes a query fail. SWIFTPROX_ERROR_INVALID_ARGUMENT: a member of query is out of range, even one this query
/// does not use. SWIFTPROX_ERROR_MEMORY: no memory for a changed list of pairs; the next query tries again.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn swiftprox_scene_query_intersection(
    scene: *mut SceneHandle,
    query: *const CSceneQuery,
    answer: *mut CSceneAnswer,
) -> StatusCode {
    // SAFETY: the header's pointer rules.
    unsafe { ask(|scene, query| Ok(scene.query_intersection(query)?), f64::INFINITY, scene, query, answer) }
}

/// Lists the pairs within query->max_distance, intersecting ones included, with answers as from swiftprox_pair_distance.
/// Separated pairs have distance, lower, upper, points in all frames, normal and features. Intersecting pairs have the proof; for
/// them distance, lower and upper are 0. Same errors as swiftprox_scene_query_intersection.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn swiftprox_scene_query_distance(
    scene: *mut SceneHandle,
    query: *const CSceneQuery,
    answer: *mut CSceneAnswer,
) -> StatusCode {
    // SAFETY: the header's pointer rules.
    unsafe { ask(|scene, query| Ok(scene.query_distance(query)?), f64::INFINITY, scene, query, answer) }
}

/// Like swiftprox_scene_query_distance, but each interval is only as narrow as query->absolute_error, relative_error or
/// error_budget require. Answers are as from swiftprox_pair_approximate. A pair whose step budget ran out before the verdict
/// (SWIFTPROX_OUTCOME_UNDECIDED) is listed, but does not count as intersecting. Same errors as swiftprox_scene_query_intersection.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn swiftprox_scene_query_approximate(
    scene: *mut SceneHandle,
    query: *const CSceneQuery,
    answer: *mut CSceneAnswer,
) -> StatusCode {
    // SAFETY: the header's pointer rules.
    unsafe { ask(|scene, query| Ok(scene.query_approximate(query)?), f64::INFINITY, scene, query, answer) }
}

/// Like swiftprox_scene_query_distance, with answers as from swiftprox_pair_contact. max_distance defaults to 0, so only touching
/// or intersecting pairs are listed.
///
/// With a query->detail the answers are those of swiftprox_scene_query_distance, and answer->contacts holds depths and contact
/// points, as from swiftprox_pair_depth and swiftprox_pair_manifold. Same errors as swiftprox_scene_query_intersection.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn swiftprox_scene_query_contact(
    scene: *mut SceneHandle,
    query: *const CSceneQuery,
    answer: *mut CSceneAnswer,
) -> StatusCode {
    // SAFETY: the header's pointer rules.
    unsafe { ask(|scene, query| Ok(scene.query_contact(query)?), 0.0, scene, query, answer) }
}

/// Returns the signed distance of a pair of the last query of contacts: its distance, or minus its penetration depth. One interval
/// spans zero; normal and witness points are as from swiftprox_pair_signed_distance. It takes no further search. `number` is an
/// index into swiftprox_scene_answer.contacts. On failure the answer's numbers are NaN.
///
/// SWIFTPROX_ERROR_INVALID_ARGUMENT: number is too large, or the last query was not of contacts with a
/// swiftprox_scene_query.detail.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn swiftprox_scene_get_signed_distance(
    scene: *const SceneHandle,
    number: usize,
    answer: *mut SignedDistance,
) -> StatusCode {
    // SAFETY: the header's pointer rules.
    guard(|| unsafe {
        output(answer, "answer", SignedDistance::default())?;
        look(scene, |scene| {
            answer.write(scene.signed_distance(number)?);
            Ok(())
        })
    })
}

/// Returns statistics of all queries since the scene was made or swiftprox_scene_reset_statistics was called. On failure
/// error_spent is NaN, all else 0.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn swiftprox_scene_get_statistics(
    scene: *const SceneHandle,
    statistics: *mut SceneStatistics,
) -> StatusCode {
    // SAFETY: the header's pointer rules.
    guard(|| unsafe {
        let unknown = SceneStatistics { error_spent: f64::NAN, ..SceneStatistics::default() };
        output(statistics, "statistics", unknown)?;
        look(scene, |scene| {
            statistics.write(*scene.statistics());
            Ok(())
        })
    })
}

/// Sets the statistics of a scene to zero.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn swiftprox_scene_reset_statistics(scene: *mut SceneHandle) -> StatusCode {
    // SAFETY: the header's pointer rules.
    unsafe {
        change(scene, |scene| {
            scene.reset_statistics();
            Ok(())
        })
    }
}

// --- What the functions above share --------------------------------------------------------------------------------------

/// As [`ask_masked`], of a query that knows no groups.
///
/// # Safety
/// The pointers meet the header's pointer rules.
pub(super) unsafe fn ask(
    run: impl for<'a> FnOnce(&'a mut Scene, &SceneQuery) -> Checked<SceneAnswer<'a>>,
    by_default: f64,
    scene: *mut SceneHandle,
    query: *const CSceneQuery,
    answer: *mut CSceneAnswer,
) -> StatusCode {
    // SAFETY: by the caller.
    unsafe { ask_masked(|scene, query, _| run(scene, query), by_default, scene, query, answer) }
}

/// Runs a query and shows its results where the scene has them. `by_default` is the query's own default.
/// The groups of the query are handed over beside it. `run` sees to the environment of floating point itself, as scenes do.
///
/// # Safety
/// The pointers meet the header's pointer rules.
pub(super) unsafe fn ask_masked(
    run: impl for<'a> FnOnce(&'a mut Scene, &SceneQuery, u32) -> Checked<SceneAnswer<'a>>,
    by_default: f64,
    scene: *mut SceneHandle,
    query: *const CSceneQuery,
    answer: *mut CSceneAnswer,
) -> StatusCode {
    // SAFETY: by the caller.
    caught(|| unsafe {
        // Before the scene does anything.
        output(answer, "answer", CSceneAnswer::EMPTY)?;
        change_guarded(scene, |scene| {
            let (mut older, defaults) = (MaybeUninit::uninit(), CSceneQuery::DEFAULT);
            let query = if query.is_null() { &defaults } else { view_struct(query, &defaults, &mut older)? };
            let PairTuning { start, levels, refinement } = read_pair_tuning(query.tuning)?;
            // By its bits: a signalling NaN may trap here.
            let is_default = query.max_distance.to_bits() == DEFAULT_MAX_DISTANCE.to_bits();
            let mask = if query.mask == 0 { u32::MAX } else { query.mask };
            let query = SceneQuery {
                early_exit: query.early_exit != 0,
                max_distance: if is_default { by_default } else { query.max_distance },
                absolute_error: query.absolute_error,
                relative_error: query.relative_error,
                error_budget: query.error_budget,
                step_budget: query.step_budget,
                levels,
                refinement,
                start,
                detail: read_enumerator(query.detail, "query->detail", "swiftprox_contact_detail")?,
                piece_pairs: read_enumerator(query.piece_pairs, "query->piece_pairs", "swiftprox_piece_pairs")?,
            };
            let said = CSceneAnswer::new(&run(scene, &query, mask)?);
            answer.write(said);
            Ok(())
        })
    })
}

#[cfg(test)]
mod tests {
    use super::super::library::swiftprox_library_last_error_message;
    use super::super::object::swiftprox_scene_add_object;
    use super::super::scene::{swiftprox_scene_create, swiftprox_scene_destroy, swiftprox_scene_set_pair_active};
    use super::*;
    use crate::base::math::Vector;
    use crate::scene::object::ObjectId;
    use crate::shape::{Shape, ShapeOptions};
    use std::ffi::CStr;
    use std::ptr::{null, null_mut};
    use std::sync::Arc;

    fn last_message() -> String {
        let message = swiftprox_library_last_error_message();
        // SAFETY: never null, terminated, and unchanged until the next failure of this thread.
        unsafe { CStr::from_ptr(message) }.to_string_lossy().into_owned()
    }

    fn new_scene() -> *mut SceneHandle {
        let mut scene = null_mut();
        // SAFETY: null options, and room for a pointer.
        assert_eq!(unsafe { swiftprox_scene_create(null(), &mut scene) }, StatusCode::Ok);
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
            assert!(last_message().contains("query.rs"), "{}", last_message());

            let mut answer = CSceneAnswer { count: 7, intersecting: 7, ..CSceneAnswer::EMPTY };
            let mut statistics = SceneStatistics::default();
            assert_eq!(swiftprox_scene_query_contact(broken, null(), &mut answer), StatusCode::ErrorPoisoned);
            assert_eq!((answer.count, answer.intersecting), (0, 0));
            assert_eq!(swiftprox_scene_set_pair_active(broken, null(), null(), 1), StatusCode::ErrorPoisoned);
            assert_eq!(swiftprox_scene_get_statistics(broken, &mut statistics), StatusCode::ErrorPoisoned);
            assert_eq!(swiftprox_scene_query_contact(sound, null(), &mut answer), StatusCode::Ok);
            assert_eq!(swiftprox_scene_destroy(broken), StatusCode::Ok);
            assert_eq!(swiftprox_scene_destroy(sound), StatusCode::Ok);
        }
    }

    #[test]
    fn a_panic_in_a_query_poisons_its_scene_and_none_that_shares_its_shapes() {
        let corners = [Vector::zeros(), Vector::x(), Vector::y(), Vector::z()];
        let shape = Arc::new(Shape::from_points(&corners, &ShapeOptions::default()).unwrap());
        let (broken, sound) = (new_scene(), new_scene());
        let pieces = [Arc::as_ptr(&shape)];
        let mut id = ObjectId::NULL;
        let mut answer = CSceneAnswer { count: 7, intersecting: 7, ..CSceneAnswer::EMPTY };
        // SAFETY: living scenes, used by this thread only, a living shape, and room for every output.
        unsafe {
            for scene in [broken, broken, sound, sound] {
                assert_eq!(swiftprox_scene_add_object(scene, pieces.as_ptr(), 1, null(), &mut id), StatusCode::Ok);
            }
            let status = ask(
                |scene, query| {
                    // Half of it is done.
                    let _ = scene.query_contact(query);
                    panic!("injected")
                },
                0.0,
                broken,
                null(),
                &mut answer,
            );
            assert_eq!(status, StatusCode::ErrorBug);
            assert_eq!((answer.count, answer.intersecting), (0, 0));
            assert_eq!(swiftprox_scene_query_contact(broken, null(), &mut answer), StatusCode::ErrorPoisoned);
            assert_eq!(swiftprox_scene_query_contact(sound, null(), &mut answer), StatusCode::Ok);
            assert_eq!((answer.count, answer.intersecting), (1, 1));
            assert_eq!(swiftprox_scene_destroy(broken), StatusCode::Ok);
            assert_eq!(swiftprox_scene_query_contact(sound, null(), &mut answer), StatusCode::Ok);
            assert_eq!(swiftprox_scene_destroy(sound), StatusCode::Ok);
        }
        assert_eq!(Arc::strong_count(&shape), 1, "a poisoned scene gives its shares back, too");
    }
}
