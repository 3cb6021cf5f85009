//! Compounds: bodies of several convex pieces, with a tree of boxes over them. A query of two compounds walks both trees at once,
//! and asks the pair layer of the pieces whose boxes do not answer.
//!
//! A compound is the union of its pieces. Verdicts and distances are those of the union; depths are of pairs of pieces, see
//! [`signed_distance`].

mod fit;
mod tree;
mod body;
mod between;
mod cache;
mod walk;
mod answer;
mod queries;
mod signed_distance;
mod contacts;
mod single;
mod verify;

use crate::base::math::Pose;
pub use answer::{
    CompoundAnswer, CompoundContact, CompoundContacts, CompoundPointAnswer, CompoundRayAnswer, CompoundSignedDistance,
};
pub use body::{Compound, Piece};
pub use cache::CompoundCache;
pub use contacts::contacts;
pub use queries::{distance, intersection};
pub use signed_distance::signed_distance;
pub use single::{cast_ray, locate_point};
pub use verify::verify;

/// A compound where it is.
#[derive(Debug, Clone, Copy)]
pub struct PlacedCompound<'a> {
    /// Its pieces.
    pub compound: &'a Compound,
    /// Its pose.
    pub pose: &'a Pose,
}

impl Compound {
    /// The compound where `pose` says.
    #[inline(always)]
    pub fn at<'a>(&'a self, pose: &'a Pose) -> PlacedCompound<'a> {
        PlacedCompound { compound: self, pose }
    }
}
