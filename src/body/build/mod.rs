//! From polygons or points to a polyhedron: the exact hull, the noise of the input, merged faces, and how far each plane misses
//! the hull.

#[doc(hidden)]
pub mod hull;
#[doc(hidden)]
pub mod check;
#[doc(hidden)]
pub mod slack;
pub(crate) mod merge;
pub(crate) mod spread;
pub(crate) mod labels;
pub(crate) mod mass;
pub(crate) mod fan;
pub(crate) mod outlines;
#[doc(hidden)]
pub mod assembly;
pub(crate) mod contact_faces;
