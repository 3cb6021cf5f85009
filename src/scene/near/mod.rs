//! Which pairs of pieces are near, and the cache of each: a list over boxes that leave room for motion, kept from query to query.
//!
//! Every pair of pieces whose distance is at most the list's tolerance τ is in the list: along each axis the gap between the two
//! is then at most τ, and each box is grown by at least τ/2. A query with a larger tolerance has all boxes fitted anew. The rest
//! of the list's content depends on how the objects came to where they are; so no answer may depend on that.

pub(crate) mod tree;
mod grid;
mod tolerance;
pub(crate) mod candidates;
pub(crate) mod contact_memory;
pub(crate) mod near_pairs;
pub(crate) mod broad_phase;
