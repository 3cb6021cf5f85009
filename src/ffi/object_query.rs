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

/// What has changed since the last query about events.
#[derive(Debug, Clone, Copy)]
#[repr(C)]
pub struct CSceneEvents {
    /// Pairs of objects that are near and were not, in order of creation. Owned by the scene, valid until its next query about
    /// events. Null when began_count is 0.
    pub began: *const ObjectPair,
    /// How many.
    pub began_count: usize,
    /// Pairs of objects that were near and are not, those of removed objects and of deactivated pairs among them. Owned and valid
    /// as began are. Null when ended_count is 0.
    pub ended: *const ObjectPair,
    /// How many.
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

/// As the query of that kind, of the pairs of one object alone: what it touches or comes near. query->error_budget is not heeded;
/// the tolerance of contacts is 0 and of others infinity unless query says otherwise. It takes as long as the pairs that are near,
/// if nothing else has moved.
///
/// SWIFTPROX_ERROR_INVALID_ARGUMENT also for an unknown kind. Other errors as of swiftprox_scene_query_intersection.
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
            default_tolerance(kind),
            scene,
            query,
            answer,
        )
    }
}

/// As swiftprox_scene_query_object, of a body that is not in the scene: `piece_count` convex pieces, each where it is in the world.
/// Each object of the scene is object 1 of its results; object 2 has the null id, and piece2 is the piece's place in `pieces`.
/// Objects are asked whose groups have a bit of query->mask, whatever their own masks, activation and filters say.
///
/// SWIFTPROX_ERROR_INVALID_ARGUMENT also without pieces and for an unknown kind. Other errors as of
/// swiftprox_scene_query_intersection.
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
            default_tolerance(kind),
            scene,
            query,
            answer,
        )
    }
}

/// Which pairs of objects began or ended touching (`distance` 0), or being within a distance, since the last call; the first call
/// lists all that are. Objects are near if any of their pieces are. It is a query as others are: results of queries before end. The
/// scene has one such memory; swiftprox_scene_listen has one for each listener, and tells of contact points. On failure `*events`
/// is empty, and what was near stays remembered.
///
/// SWIFTPROX_ERROR_INVALID_ARGUMENT: the distance is negative or NaN.
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

/// Of contacts 0, of all others infinity.
pub(super) fn default_tolerance(kind: QueryNumber) -> f64 {
    if kind == Query::Contact as i32 { 0.0 } else { f64::INFINITY }
}
