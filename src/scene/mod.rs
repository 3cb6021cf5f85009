//! A scene: objects with poses, the pairs of them that are tested, and queries over all these pairs.
//!
//! ```text
//! changes ─► world/ (poses, spheres, boxes, odometers) ─► near/ (which pairs are near, what they remember) ─► search/ ─► results
//!     └────► recording/ ─► bytes ─► replay
//! ```
//!
//! Queries list their results by object 1, object 2, piece 1, piece 2, objects in order of creation; object 1 is always the
//! earlier created of the two. The answer of a query depends on the objects, their poses and the activation alone: not on earlier
//! queries, on other objects or on how the objects came to where they are. (Where nearest points are not unique, any of them may
//! be given, and for an approximate distance any interval that is narrow enough, or as the step budget leaves it. Status and
//! statistics of an answer tell how it was found, and that depends on the pair's cache.)

pub(crate) mod world;
pub(crate) mod near;
pub(crate) mod search;
pub(crate) mod sets;
pub(crate) mod change;
pub(crate) mod recording;
mod door;
mod interface;
mod bulk;
mod set_interface;
mod drawing;
mod replay;

pub use crate::base::workers::Workers;
pub use crate::pair::Query;
pub use door::Scene;
pub use replay::{Replay, ReplayAnswer, ReplayStep};
pub use search::listener::{EventState, Listener, ListenerEvents, PairEvent, PointEvent};
pub use search::query::{
    Contact, ContactDetail, ObjectPair, PairResult, PiecePairs, SceneAnswer, SceneContacts, SceneEvents, SceneQuery,
};
pub use search::statistics::SceneStatistics;
pub use sets::casts::SceneCastAnswer;
pub use sets::first_hit::{FirstHit, PoseOrder};
pub use sets::grounds::{GroupFilter, SceneGroundContact, SceneGroundContacts};
pub use sets::members::ObjectSet;
pub use sets::nearest::LeastDistance;
pub use sets::rays::{RayHits, SceneRayHit};
pub use sets::scratch::SetScratch;
pub use world::object;
pub use world::object_view::Object;
pub use world::testing::PairFilter;
