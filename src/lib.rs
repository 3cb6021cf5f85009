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
//! pair::distance([tetrahedron.at(&here), tetrahedron.at(&there)], &mut cache, &PairConfig::default(), &mut answer)?;
//! assert_eq!(answer.outcome, Outcome::Separated);
//! assert!(answer.lower <= 2.0 && 2.0 <= answer.upper);
//! # Ok::<(), swiftprox::error::Error>(())
//! ```
//!
//! [`pair`] queries are pure functions; a [`scene`] keeps objects, poses and caches and answers for all pairs at once. The C
//! interface is documented in `include/swiftprox.h`, the conventions of both in `docs/conventions.md`.
//!
//! See `ARCHITECTURE.md` for the data flow; the folders below are stages in that order, each using only those above it.

// Items hidden from the documentation are public for tests, benchmarks, fuzzing and examples alone: they are no interface, and
// change without notice.

#[doc(hidden)]
pub mod base;
#[doc(hidden)]
pub mod body;
#[doc(hidden)]
pub mod placed;
#[doc(hidden)]
pub mod distance;
pub mod shape;
mod answer;
#[doc(hidden)]
pub mod depth;
pub mod pair;
pub mod manifold;
pub mod verify;
pub mod motion;
pub mod ray;
pub mod point;
pub mod compound;
pub mod ground;
pub mod draw;
pub mod scene;
#[doc(hidden)]
pub mod ffi;

pub use base::{error, files, math, progress};
pub use body::mesh;
pub use body::mesh::io as mesh_io;
pub use scene::object;
pub use shape::file as shape_file;
pub use shape::levels::hierarchy;

// Unit tests draw from the generator of the testkit, which knows this crate by its name. They cannot link the testkit: it would
// bring another copy of this crate, with the same C functions.
#[cfg(test)]
extern crate self as swiftprox;
#[cfg(test)]
#[allow(dead_code, reason = "unit tests use a part of it")]
#[path = "../testkit/src/random.rs"]
mod random;
