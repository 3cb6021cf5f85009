//! Levels of detail: simpler polyhedra around a body, each with a bound of how far it stands off. A level kind proposes points;
//! what bounds, measures and links them is in [`hierarchy`].

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
