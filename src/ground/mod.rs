//! Grounds: surfaces of triangles, such as soups and grids of heights, for bodies to rest on. A ground is not a body and need not
//! be convex or closed. Its triangles are compact; a query lays those out that a body may touch, and asks the pair layer of each.
//!
//! Distance and intersection are those of the surface as a set of points. Contacts are one-sided and free of ghost normals:
//! `normals.rs` has the rule.

mod tree;
mod triangles;
mod grid;
mod layout;
mod covers;
mod marks;
mod surface;
mod reach;
mod normals;
mod distance;
mod ray;
mod cast;
mod room;
mod answer;
mod grouping;
mod vertices;
mod lowest;
mod footing;
mod corner;
mod simplex;
mod common;
mod facing;
mod allowed;
mod inside;
mod contacts;

use crate::base::math::Pose;
pub use answer::{GroundContact, GroundContacts};
pub(crate) use cast::ground_cast_carried;
pub use cast::{GroundCastAnswer, ground_cast};
pub(crate) use contacts::add_contacts;
pub use contacts::ground_contacts;
pub(crate) use distance::nearest_triangle;
pub use distance::{GroundDistance, ground_distance};
pub use ray::GroundRayAnswer;
pub use surface::{Ground, HeightGrid};

/// A ground where it is.
#[derive(Debug, Clone, Copy)]
pub struct PlacedGround<'a> {
    /// Its triangles.
    pub ground: &'a Ground,
    /// Its pose.
    pub pose: &'a Pose,
}

impl Ground {
    /// The ground where `pose` says.
    pub fn at<'a>(&'a self, pose: &'a Pose) -> PlacedGround<'a> {
        PlacedGround { ground: self, pose }
    }
}
