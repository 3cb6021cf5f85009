//! A convex polyhedron as queries run on it: features beside the numbers that their tests need, and the tables that say where to
//! start. It is data; later stages make it.

#[doc(hidden)]
pub mod lookup;
pub(crate) mod polygon_search;
#[doc(hidden)]
pub mod fan;
pub(crate) mod contact_faces;
mod planes;
#[doc(hidden)]
pub mod outlines;
mod layout;
mod polygon_at;
pub(crate) mod triangulation;
pub(crate) mod surface_walk;

pub use contact_faces::{ContactFace, ContactFaces, FacePart};
pub use layout::*;
pub use planes::PlaneBlock;
