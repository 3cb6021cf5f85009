//! The content of a scene: objects, their pieces, where these are and how far they have moved, and which pairs are tested.

pub mod object;
pub(crate) mod activation;
pub(crate) mod boxes;
pub(crate) mod rows;
pub(crate) mod grounds;
pub(crate) mod compounds;
pub(crate) mod bodies;
pub(crate) mod proxies;
pub(crate) mod piece_data;
pub(crate) mod object_view;
pub(crate) mod testing;
pub(crate) mod content;
mod poses;
