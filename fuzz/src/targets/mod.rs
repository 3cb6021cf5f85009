//! One file per fuzz target: what it makes of arbitrary bytes and checks. A check that fails panics.

pub mod c_calls;
pub mod casts;
pub mod compounds;
pub mod grounds;
pub mod hull;
pub mod mesh_readers;
pub mod pairs;
pub mod rays;
pub mod recordings;
pub mod shape_files;
pub mod swept;
