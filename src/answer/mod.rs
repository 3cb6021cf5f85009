//! Configs and answers of pair queries: outcome, interval, witness points, features, swept radii taken off.

mod pair_answer;
pub(crate) mod contact;
mod config;
mod radii;

pub(crate) use config::{Accuracy, check_accuracy};
pub use config::{Levels, PairConfig, Query, Refinement, Start};
pub(crate) use contact::{PlacedPoints, faces_at, feature_of_vertices, fill_nothing, label, normalised, placed_points};
pub use pair_answer::{DecidedBy, Feature, FeatureKind, Outcome, PairAnswer, Statistics};
pub(crate) use radii::{Radii, Side, move_points, moved, sum_above, sum_below};
