//! Changes since a listener's last query: pairs and points that began, persist or ended.

use super::enumerators::QueryNumber;
use super::failure::StatusCode;
use super::guard::guard;
use super::object_query::{default_max_distance, read_kind};
use super::pointers::{exclusive, output};
use super::query::{CSceneAnswer, CSceneQuery, ask};
use super::scene::SceneHandle;
use crate::base::simd::environment::with_default;
use crate::scene::{Listener, ListenerEvents, PairEvent, PointEvent};

/// The events of a listener.
#[derive(Debug, Clone, Copy)]
#[repr(C)]
pub struct CListenerEvents {
    /// All listed pairs, and pairs that are no longer listed, in the order of results. Owned by the listener; valid until its
    /// next call or its end. Null if count is 0.
    pub pairs: *const PairEvent,
    /// Number of pairs.
    pub count: usize,
    /// Their points, if the query asks for manifolds; those of a pair begin at its first_point. Owned and valid as pairs. Null
    /// if point_count is 0.
    pub points: *const PointEvent,
    /// Number of points.
    pub point_count: usize,
}

impl CListenerEvents {
    const EMPTY: CListenerEvents =
        CListenerEvents { pairs: std::ptr::null(), count: 0, points: std::ptr::null(), point_count: 0 };

    fn new(events: &ListenerEvents) -> CListenerEvents {
        let ListenerEvents { pairs, points } = events;
        CListenerEvents {
            pairs: if pairs.is_empty() { std::ptr::null() } else { pairs.as_ptr() },
            count: pairs.len(),
            points: if points.is_empty() { std::ptr::null() } else { points.as_ptr() },
            point_count: points.len(),
        }
    }
}

/// Creates a listener with no history. The caller owns it and frees it with swiftprox_listener_destroy. On failure `*listener` is
/// null.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn swiftprox_listener_create(listener: *mut *mut Listener) -> StatusCode {
    // SAFETY: the header's pointer rules.
    guard(|| unsafe {
        output(listener, "listener", std::ptr::null_mut())?;
        listener.write(Box::into_raw(Box::default()));
        Ok(())
    })
}

/// Frees a listener and the events it owns. Null is ignored.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn swiftprox_listener_destroy(listener: *mut Listener) {
    if !listener.is_null() {
        // SAFETY: the header's pointer rules; every one comes from Box::into_raw.
        drop(unsafe { Box::from_raw(listener) });
    }
}

/// Runs a query of that kind over all pairs, and reports the changes since the listener's last call. Pairs of pieces and contact
/// points have begun, persist or have ended; in the first call all begin. Contacts with query->detail
/// SWIFTPROX_CONTACT_DETAIL_MANIFOLD have points; answer->points holds their positions.
///
/// Each listener has its own history, which other queries do not affect. Use one listener per max_distance; it defaults to 0 for
/// contacts, else infinity. Removed objects, deactivated pairs and pairs of another scene have ended. Recordings include the query.
///
/// On failure answer and events are empty, and the history is unchanged. SWIFTPROX_ERROR_INVALID_ARGUMENT: also for an unknown
/// kind, or if query->early_exit is set. Else same errors as swiftprox_scene_query_contact.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn swiftprox_scene_listen(
    scene: *mut SceneHandle,
    listener: *mut Listener,
    kind: QueryNumber,
    query: *const CSceneQuery,
    answer: *mut CSceneAnswer,
    events: *mut CListenerEvents,
) -> StatusCode {
    // SAFETY: the header's pointer rules.
    let refused = guard(|| unsafe { output(events, "events", CListenerEvents::EMPTY) });
    if refused != StatusCode::Ok {
        return refused;
    }
    // SAFETY: the header's pointer rules; `events` was written before.
    unsafe {
        ask(
            |scene, query| {
                let (listener, kind) = (exclusive(listener, "listener")?, read_kind(kind)?);
                let (answer, heard) = with_default(|| scene.listen(listener, kind, query))?;
                events.write(CListenerEvents::new(&heard));
                Ok(answer)
            },
            default_max_distance(kind),
            scene,
            query,
            answer,
        )
    }
}
