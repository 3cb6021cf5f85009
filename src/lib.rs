//! swiftprox: certified proximity queries between convex polyhedra.
//!
//! ```
//! use swiftprox::math::{Matrix, Pose, Vector};
//! use swiftprox::pair::{self, Outcome, PairAnswer, PairCache, PairConfig};
//! use swiftprox::shape::{Shape, ShapeOptions};
//!
//! let corners = [Vector::zeros(), Vector::x(), Vector::y(), Vector::z()];
//! let tetrahedron = Shape::from_points(&corners, &ShapeOptions::default())?;
//! let (here, there) = (Pose::IDENTITY, Pose::new(&Matrix::identity(), &Vector::new(3.0, 0.0, 0.0)));
//! let mut cache = PairCache::default(); // keep one for each pair
//! let mut answer = PairAnswer::default();
//! pair::distance(&tetrahedron, &here, &tetrahedron, &there, &mut cache, &PairConfig::default(), &mut answer)?;
//! assert_eq!(answer.outcome, Outcome::Separated);
//! assert!(answer.lower <= 2.0 && 2.0 <= answer.upper);
//! # Ok::<(), swiftprox::error::Error>(())
//! ```
//!
//! [`pair`] queries are pure functions; a [`scene`] keeps objects, poses and caches and answers for all pairs at once. The C
//! interface is documented in `include/swiftprox.h`, what both share in `docs/conventions.md`.
//!
//! See `ARCHITECTURE.md` for the data flow; the modules below are listed in that order, each using only those above it.

// What is hidden from the documentation is public for tests, benchmarks, fuzzing and examples alone: it is no interface, and
// changes without notice.

pub mod error;
mod memory;
pub mod files;
mod enumerator;
pub mod math;
#[doc(hidden)]
pub mod simd;
pub mod progress;
mod sorting;
mod locality;
#[doc(hidden)]
pub mod double_double;
mod extended_range;
#[doc(hidden)]
pub mod predicates;
mod normal;
pub mod mesh;
pub mod mesh_io;
#[doc(hidden)]
pub mod lookup;
#[doc(hidden)]
pub mod polyhedron;
mod triangulation;
mod surface_walk;
#[doc(hidden)]
pub mod lookup_build;
#[doc(hidden)]
pub mod hull_build;
#[doc(hidden)]
pub mod hull_check;
mod slack;
mod face_merge;
mod face_labels;
mod mass;
#[doc(hidden)]
pub mod polyhedron_build;
#[doc(hidden)]
pub mod quadric;
mod dobkin_kirkpatrick;
#[doc(hidden)]
pub mod state;
mod side_search;
#[doc(hidden)]
pub mod voronoi;
#[doc(hidden)]
pub mod nearest_vertex;
#[doc(hidden)]
pub mod start;
#[doc(hidden)]
pub mod frame;
#[doc(hidden)]
pub mod certificate;
mod separating_axis;
#[doc(hidden)]
pub mod marching;
#[doc(hidden)]
pub mod exact;
mod gjk;
#[doc(hidden)]
pub mod enclosure;
mod overlap;
#[doc(hidden)]
pub mod point_distance;
#[doc(hidden)]
pub mod containment;
#[doc(hidden)]
pub mod outer_cuts;
pub mod hierarchy;
pub mod shape;
pub mod shape_file;
mod normal_cone;
mod descent;
mod contact_direction;
mod answer;
mod contact;
pub mod pair;
pub mod verify;
pub mod object;
mod activation;
pub mod scene;
#[doc(hidden)]
pub mod ffi;

// Unit tests draw from the generator of the benchmarks, which knows this crate by its name.
#[cfg(test)]
extern crate self as swiftprox;
#[cfg(test)]
#[path = "../benches/common/random.rs"]
mod random;
