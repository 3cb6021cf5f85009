//! Compounds: bodies of several convex pieces, with a tree of boxes over them. A query of two compounds walks both trees at once,
//! and asks the pair layer of the pieces whose boxes do not answer.
//!
//! A compound is the union of its pieces. Verdicts and distances are those of the union; signed distances are of pairs of pieces,
//! and [`depth`] is the interval of the union's.

mod fit;
mod tree;
mod body;
mod placed;
mod between;
mod walk;
mod front;
mod cache;
mod approach;
mod answer;
mod queries;
mod signed_distance;
mod half_spaces;
mod depth;
mod contacts;
mod single;
mod verify;
mod verify_depth;
mod cast;

use crate::base::math::Pose;
use crate::motion::Motion;
pub use answer::{
    CompoundAnswer, CompoundCastAnswer, CompoundContact, CompoundContacts, CompoundDepth, CompoundPointAnswer,
    CompoundRayAnswer, CompoundSignedDistance,
};
pub(crate) use between::check_pose;
pub use body::{Compound, Piece};
pub use cache::CompoundCache;
pub(crate) use cache::{GrowingCache, PieceCaches};
pub(crate) use cast::cast_pieces;
pub use cast::{cast, verify_cast};
pub use contacts::contacts;
pub(crate) use contacts::near_pieces;
pub use depth::depth;
pub(crate) use placed::{PlacedPieces, SinglePiece, with_pieces};
pub(crate) use queries::{MORE, ask};
pub use queries::{distance, intersection};
pub use signed_distance::signed_distance;
pub(crate) use single::cast_ray_in_integers;
pub use single::{cast_ray, locate_point};
pub use verify::verify;
pub use verify_depth::verify_depth;

/// A compound where it is.
#[derive(Debug, Clone, Copy)]
pub struct PlacedCompound<'a> {
    /// Its pieces.
    pub compound: &'a Compound,
    /// Its pose.
    pub pose: &'a Pose,
}

/// A compound and how it moves. A point p of a piece is where the motion has the point pose·p of the compound, in real arithmetic.
#[derive(Debug, Clone, Copy)]
pub struct MovingCompound<'a> {
    /// Its pieces.
    pub compound: &'a Compound,
    /// Its motion.
    pub motion: &'a Motion<'a>,
}

impl Compound {
    /// The compound where `pose` says.
    #[inline(always)]
    pub fn at<'a>(&'a self, pose: &'a Pose) -> PlacedCompound<'a> {
        PlacedCompound { compound: self, pose }
    }
}
