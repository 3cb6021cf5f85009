//! Pair queries: pure functions of two immutable shapes, two poses and a small cache that the caller owns. `ladder` shows every
//! way in which an answer comes about.

mod answer;
mod placed;
mod contact;
#[doc(hidden)]
pub mod start;
mod config;
mod levels;
mod cache;
mod depth;
mod ladder;
mod queries;
mod batch;
mod signed_distance;
mod manifold;
pub mod verify;

pub use answer::{DecidedBy, Feature, FeatureKind, Outcome, PairAnswer, Statistics};
pub use batch::{PairQuestion, batch};
pub use cache::PairCache;
pub(crate) use config::check_accuracy;
pub use config::{Levels, PairConfig, Query, Refinement, Start};
pub(crate) use contact::{label, normalised};
pub use depth::{DepthAnswer, DepthCache, DepthConfig, DepthEnding, DepthStatistics, depth};
pub(crate) use ladder::least_error;
pub(crate) use manifold::{Known, Reference, Sink, manifold_into, manifold_of};
pub use manifold::{Manifold, ManifoldCache, ManifoldConfig, ManifoldPoint, manifold};
pub use placed::Placed;
pub use queries::{approximate, contact, distance, intersection, intersection_by_marching};
pub use signed_distance::{SignedDistance, SignedDistanceCache, signed_distance};
