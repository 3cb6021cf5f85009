//! The C interface: with `base/simd/` the only unsafe code. One file per noun; the first ones hold what every entry point shares.
//!
//! The contract that every pointer must meet (alignment, lifetime, exclusive use behind a non-const pointer) is stated once,
//! in the head of `swiftprox.h`; the `SAFETY` comments below call it "the header's pointer rules".

#![allow(unsafe_code, reason = "this is where C comes in; the lint stays on everywhere else")]
#![allow(clippy::missing_safety_doc, reason = "the header's pointer rules, stated once, are the safety section of all")]

mod failure;
mod enumerators;
mod log;
mod guard;
mod pointers;
mod structs;
// In the order of the header.
pub mod library;
pub mod allocator;
pub mod arrays;
pub mod mesh_reader;
pub mod tuning;
pub mod shape_options;
pub mod shape;
pub mod level;
pub mod decomposition;
pub mod pair;
pub mod depth;
pub mod half_space;
pub mod ground;
pub mod motion;
pub mod ray;
pub mod point;
pub mod gradient;
mod task_loan;
pub mod workers;
pub mod scene;
pub mod object;
pub mod many_objects;
pub mod pose;
pub mod query;
pub mod filter;
pub mod object_query;
pub mod listener;
pub mod object_set;
pub mod scene_ground;
pub mod pair_batch;
pub mod compound;
pub mod draw;
pub mod record;

pub use failure::StatusCode;
