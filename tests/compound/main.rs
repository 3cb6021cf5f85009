//! Compounds: trees of boxes over convex pieces, against all pairs of pieces and against rational numbers.

mod answers;
mod bodies;
mod casts;
mod depths;
mod more_queries;
mod tiny_gaps;
