//! Levels of detail: simpler polyhedra around a body, each with a bound of how far it stands off.
//!
//! A level kind proposes points: [`quadric`], [`dobkin_kirkpatrick`] and [`outer_cuts`]. Another one stands beside them, and is
//! named in [`hierarchy::HierarchyKind`]. The code that bounds, measures and links the levels of all kinds is in [`hierarchy`].

#[doc(hidden)]
pub mod quadric;
pub(crate) mod dobkin_kirkpatrick;
#[doc(hidden)]
pub mod point_distance;
#[doc(hidden)]
pub mod containment;
#[doc(hidden)]
pub mod outer_cuts;
pub mod hierarchy;
