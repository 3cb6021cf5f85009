//! What has begun, goes on and has ended since a listener last asked.

use super::enumerators::QueryNumber;
use super::failure::StatusCode;
use super::guard::guard;
use super::object_query::{default_tolerance, read_kind};
use super::pointers::{exclusive, output};
use super::query::{CSceneAnswer, CSceneQuery, ask};
use super::scene::SceneHandle;
use crate::scene::{Listener, ListenerEvents, PairEvent, PointEvent};

/// What a listener hears.
#[derive(Debug, Clone, Copy)]
#[repr(C)]
pub struct CListenerEvents {
    /// All pairs that the query lists, and those that were listed and are not, in the order of results. Owned by the listener,
    /// valid until it asks again or its end. Null when count is 0.
    pub pairs: *const PairEvent,
    /// How many.
    pub count: usize,
    /// Their points, where the query asks for manifolds: those of a pair begin at its first_point. Owned and valid as pairs are.
    /// Null when point_count is 0.
    pub points: *const PointEvent,
    /// How many.
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

/// Makes a listener that remembers nothing yet; the caller owns it and gives it back with swiftprox_listener_destroy. On failure
/// `*listener` is null.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn swiftprox_listener_create(listener: *mut *mut Listener) -> StatusCode {
    // SAFETY: the header's pointer rules.
    guard(|| unsafe {
        output(listener, "listener", std::ptr::null_mut())?;
        listener.write(Box::into_raw(Box::default()));
        Ok(())
    })
}

/// Gives back what swiftprox_listener_create made, and the events that it owns. Null is ignored.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn swiftprox_listener_destroy(listener: *mut Listener) {
    if !listener.is_null() {
        // SAFETY: the header's pointer rules; every one comes from Box::into_raw.
        drop(unsafe { Box::from_raw(listener) });
    }
}

/// As the query of that kind over all pairs, and what has changed since the listener last asked: which pairs of pieces and which
/// contact points have begun, which persist and which have ended. The first time all begin. Contacts with query->detail
/// SWIFTPROX_CONTACT_DETAIL_MANIFOLD have points; swiftprox_scene_get_contacts hands over where they are.
///
/// A pair counts as long as the query lists it; of another tolerance, another listener. Each listener remembers for itself: what
/// others and other queries ask changes nothing of that. Removed objects, deactivated pairs and all that a former scene listed have
/// ended. A recording notes the query. The tolerance of contacts is 0 and of others infinity unless query says otherwise.
///
/// On failure answer and events are empty, and the listener remembers what it did. SWIFTPROX_ERROR_INVALID_ARGUMENT also for an
/// unknown kind, and if query->early_exit is set. SWIFTPROX_ERROR_NULL_POINTER also if listener or events is null. Other errors as
/// of swiftprox_scene_query_contact.
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
                let (answer, heard) = scene.listen(exclusive(listener, "listener")?, read_kind(kind)?, query)?;
                events.write(CListenerEvents::new(&heard));
                Ok(answer)
            },
            default_tolerance(kind),
            scene,
            query,
            answer,
        )
    }
}
