//! Queries about one object, and about what has changed.

use super::enumerators::{QueryNumber, read_enumerator};
use super::failure::{Failure, StatusCode};
use super::guard::guard;
use super::object::share;
use super::pair::CPlaced;
use super::pointers::{array, output};
use super::query::{CSceneAnswer, CSceneQuery, ask, ask_masked};
use super::scene::{SceneHandle, change};
use crate::base::math::Pose;
use crate::base::memory::with_capacity;
use crate::scene::object::ObjectId;
use crate::scene::{ObjectPair, Query, SceneEvents};

/// The changes since the last query of events.
#[derive(Debug, Clone, Copy)]
#[repr(C)]
pub struct CSceneEvents {
    /// Pairs of objects that have become near, in order of creation. Owned by the scene, valid until its next query of events.
    /// Null if began_count is 0.
    pub began: *const ObjectPair,
    /// Number of pairs.
    pub began_count: usize,
    /// Pairs of objects that are no longer near, including those of removed objects and deactivated pairs. Owned and valid as
    /// began. Null if ended_count is 0.
    pub ended: *const ObjectPair,
    /// Number of pairs.
    pub ended_count: usize,
}

impl CSceneEvents {
    const EMPTY: CSceneEvents =
        CSceneEvents { began: std::ptr::null(), began_count: 0, ended: std::ptr::null(), ended_count: 0 };

    fn new(events: &SceneEvents) -> CSceneEvents {
        let first = |pairs: &[ObjectPair]| if pairs.is_empty() { std::ptr::null() } else { pairs.as_ptr() };
        CSceneEvents {
            began: first(events.began),
            began_count: events.began.len(),
            ended: first(events.ended),
            ended_count: events.ended.len(),
        }
    }
}

/// Runs a query of that kind over the pairs of one object. query->error_budget is ignored. max_distance defaults to 0 for
/// contacts, else to infinity. The time depends on the number of near pairs, if nothing else has moved.
///
/// SWIFTPROX_ERROR_INVALID_ARGUMENT: also for an unknown kind. Else same errors as swiftprox_scene_query_intersection.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn swiftprox_scene_query_object(
    scene: *mut SceneHandle,
    id: ObjectId,
    kind: QueryNumber,
    query: *const CSceneQuery,
    answer: *mut CSceneAnswer,
) -> StatusCode {
    // SAFETY: the header's pointer rules.
    unsafe {
        ask(
            |scene, query| Ok(scene.query_object(id, read_kind(kind)?, query)?),
            default_max_distance(kind),
            scene,
            query,
            answer,
        )
    }
}

/// Like swiftprox_scene_query_object, for a body outside the scene: `piece_count` convex pieces, each with its pose in the world.
/// In results object 1 is an object of the scene. Object 2 has the null id, and piece2 is an index into `pieces`. Objects whose
/// groups have a bit of query->mask are tested; their masks, activation and filters do not apply.
///
/// SWIFTPROX_ERROR_INVALID_ARGUMENT: also for no pieces or an unknown kind. Else same errors as swiftprox_scene_query_intersection.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn swiftprox_scene_query_placed(
    scene: *mut SceneHandle,
    pieces: *const CPlaced,
    piece_count: usize,
    kind: QueryNumber,
    query: *const CSceneQuery,
    answer: *mut CSceneAnswer,
) -> StatusCode {
    // SAFETY: the header's pointer rules; a pose is twelve doubles, row by row, as is `Pose`.
    unsafe {
        ask_masked(
            |scene, query, mask| {
                let mut placed = with_capacity(piece_count)?;
                for (k, piece) in array(pieces, piece_count, "pieces")?.iter().enumerate() {
                    let shape = share(piece.shape, format_args!("pieces[{k}].shape"))?;
                    let pose = piece.pose.cast::<Pose>().as_ref();
                    placed.push((shape, *pose.ok_or_else(|| Failure::null(&format!("pieces[{k}].pose")))?));
                }
                match (&placed[..], mask) {
                    ([(shape, pose)], u32::MAX) => Ok(scene.query_placed(shape, pose, read_kind(kind)?, query)?),
                    _ => Ok(scene.query_placed_pieces(&placed, mask, read_kind(kind)?, query)?),
                }
            },
            default_max_distance(kind),
            scene,
            query,
            answer,
        )
    }
}

/// Lists pairs of objects that became or stopped being near since the last call; the first call lists all near pairs. Near means
/// touching (`distance` 0) or within `distance`, for any of their pieces. Like all queries it ends the results of earlier ones. A
/// scene has one such history. swiftprox_scene_listen has one per listener, and reports contact points. On failure `*events` is
/// empty, and the history is unchanged.
///
/// SWIFTPROX_ERROR_INVALID_ARGUMENT: distance is negative or NaN.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn swiftprox_scene_query_events(
    scene: *mut SceneHandle,
    distance: f64,
    events: *mut CSceneEvents,
) -> StatusCode {
    // SAFETY: the header's pointer rules.
    let refused = guard(|| unsafe { output(events, "events", CSceneEvents::EMPTY) });
    if refused != StatusCode::Ok {
        return refused;
    }
    // SAFETY: the header's pointer rules; `events` was written before.
    unsafe {
        change(scene, |scene| {
            events.write(CSceneEvents::new(&scene.query_events(distance)?));
            Ok(())
        })
    }
}

pub(super) fn read_kind(kind: QueryNumber) -> Result<Query, Failure> {
    read_enumerator(kind, "kind", "swiftprox_query_kind")
}

/// 0 for contacts, else infinity.
pub(super) fn default_max_distance(kind: QueryNumber) -> f64 {
    if kind == Query::Contact as i32 { 0.0 } else { f64::INFINITY }
}
