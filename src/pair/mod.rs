//! Pair queries: pure functions of two immutable shapes, two poses and a small cache that the caller owns. `ladder` shows every
//! way in which an answer comes about.

#[doc(hidden)]
pub mod start;
mod levels;
mod habit;
mod cache;
mod ladder;
mod signed_distance;
mod round;
mod swept;
mod queries;
mod batch;
mod half_space;
mod gradient;

pub use crate::answer::{
    DecidedBy, Feature, FeatureKind, Levels, Outcome, PairAnswer, PairConfig, Query, Refinement, Start, Statistics,
};
pub use crate::depth::{DepthAnswer, DepthCache, DepthConfig, DepthEnding, DepthStatistics};
pub use crate::shape::Placed;
pub use batch::{PairQuestion, batch};
pub use cache::PairCache;
pub use gradient::{Gradient, gradient};
pub use half_space::{HalfSpace, half_space_distance};
pub(crate) use half_space::{above_plane, middle, of_lowest};
pub(crate) use ladder::{for_each_state, least_error};
#[doc(hidden)]
pub use ladder::{shrunk, square_between, square_of_rigid, together};
pub use queries::{approximate, contact, depth, distance, intersection, intersection_by_marching, signed_distance};
#[doc(hidden)]
pub use round::{NearestOfRound, ends_of_points, ends_of_segments};
pub(crate) use signed_distance::fill_at_rest;
pub use signed_distance::{SignedDistance, SignedDistanceCache};
