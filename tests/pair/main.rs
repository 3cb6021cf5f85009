//! Pair queries: the truth, its proof, and what an answer must not depend on.

mod batch;
mod exact_truth;
mod flat_edges;
mod forgery;
mod gradient;
mod high_valence;
mod invariance;
mod lookup;
mod metamorphic;
mod overlap;
mod pair_truth;
mod refused;
mod separating_axis;
mod skewed;
mod stretched;
mod support_maps;
mod verify;
mod witnesses;
