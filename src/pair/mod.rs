//! Pair queries: pure functions of two immutable shapes, two poses and a small cache that the caller owns. `ladder` shows every
//! way in which an answer comes about.

mod answer;
mod placed;
mod contact;
#[doc(hidden)]
pub mod start;
mod config;
mod levels;
mod habit;
mod cache;
mod depth;
mod ladder;
mod signed_distance;
mod radii;
mod round;
mod swept;
mod queries;
mod batch;
mod half_space;
mod manifold;
mod gradient;
pub mod verify;

pub use answer::{DecidedBy, Feature, FeatureKind, Outcome, PairAnswer, Statistics};
pub use batch::{PairQuestion, batch};
pub use cache::PairCache;
pub(crate) use config::check_accuracy;
pub use config::{Levels, PairConfig, Query, Refinement, Start};
pub(crate) use contact::{feature_of_vertices, label, normalised, placed_points};
pub use depth::{DepthAnswer, DepthCache, DepthConfig, DepthEnding, DepthStatistics};
pub use gradient::{Gradient, gradient};
pub use half_space::{HalfSpace, half_space_distance};
pub(crate) use ladder::least_error;
pub(crate) use manifold::{
    Fill, Known, Reference, Sink, add_points, four_of_points, half_space_manifold_into, manifold_along, manifold_into,
    manifold_of, witness,
};
pub use manifold::{
    Manifold, ManifoldCache, ManifoldConfig, ManifoldPoint, half_space_manifold, manifold, manifold_with_distance,
};
pub use placed::Placed;
pub use queries::{approximate, contact, depth, distance, intersection, intersection_by_marching, signed_distance};
pub(crate) use radii::{Radii, moved, sum_above, sum_below};
pub use signed_distance::{SignedDistance, SignedDistanceCache};
