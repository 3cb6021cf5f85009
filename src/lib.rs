//! swiftprox: certified proximity queries between convex polyhedra.
//!
//! See `ARCHITECTURE.md` for the data flow; the modules below are listed in that order, each using only those above it.

pub mod error;
pub mod math;
pub mod simd;
pub mod double_double;
pub mod predicates;
pub mod mesh;
pub mod mesh_io;
pub mod polyhedron;
pub mod hull_build;
pub mod hull_check;
pub mod normal;
pub mod triangulation;
pub mod slack;
pub mod face_merge;
pub mod face_labels;
pub mod mass;
pub mod polyhedron_build;
pub mod progress;
pub mod quadric;
pub mod dobkin_kirkpatrick;
pub mod state;
pub mod voronoi;
pub mod frame;
pub mod certificate;
pub mod marching;
pub mod exact;
pub mod gjk;
pub mod enclosure;
pub mod overlap;
pub mod point_distance;
pub mod containment;
pub mod outer_cuts;
pub mod hierarchy;
pub mod shape;
pub mod contact_direction;
pub mod answer;
pub mod contact;
pub mod pair;
pub mod verify;
pub mod object;
mod activation;
pub mod scene;
pub mod ffi;
