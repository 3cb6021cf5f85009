//! Answers on two compounds: plain data, laid out for C.

use crate::manifold::{Manifold, ManifoldPoint};
use crate::motion::CastAnswer;
use crate::pair::{PairAnswer, SignedDistance};
use crate::point::PointAnswer;
use crate::ray::RayAnswer;

/// The answer to a query of two compounds.
#[derive(Debug, Clone, Copy, PartialEq)]
#[repr(C)]
pub struct CompoundAnswer {
    /// Outcome and interval are those of the compounds. The rest is about two of their pieces: the nearest, or some that intersect.
    /// Local points are in the frames of these pieces, features in their numbering. Points, normal and features stay unset where no
    /// two pieces are named.
    pub answer: PairAnswer,
    /// The piece of compound 1; its number of pieces where none is named.
    pub piece1: u32,
    /// The piece of compound 2, likewise.
    pub piece2: u32,
}

impl Default for CompoundAnswer {
    fn default() -> Self {
        CompoundAnswer { answer: PairAnswer::UNSAID, piece1: 0, piece2: 0 }
    }
}

/// The signed distance of two compounds.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
#[repr(C)]
pub struct CompoundSignedDistance {
    /// Outcome and interval are those of the compounds, the rest is about two of their pieces, with the least signed distance.
    pub distance: SignedDistance,
    /// The piece of compound 1; its number of pieces where none is named.
    pub piece1: u32,
    /// The piece of compound 2, likewise.
    pub piece2: u32,
}

/// How deep two compounds are in each other: the length of the least translation of compound 1 at which no two pieces overlap, so
/// that a plane has one on either side. Touching is allowed.
#[derive(Debug, Clone, Copy, PartialEq)]
#[repr(C)]
pub struct CompoundDepth {
    /// The signed distance of the compounds: whether they meet, which two pieces are the deepest in each other, and where.
    pub deepest: CompoundSignedDistance,
    /// Lower end of the rigorous interval: the depth of the deepest two pieces. 0 where the compounds are apart or touch.
    pub lower: f64,
    /// Upper end: the translation is no longer. 0 only where the compounds are apart or touch; infinite where none was found:
    /// of poses at the limit of what is accepted, and of bodies near the largest doubles.
    pub upper: f64,
    /// A translation in the world that frees: added to the pose of compound 1, each number rounded, it leaves no two pieces that
    /// overlap. NaN where none was found.
    pub translation: [f64; 3],
}

/// Says nothing.
impl Default for CompoundDepth {
    fn default() -> Self {
        let deepest = CompoundSignedDistance::default();
        CompoundDepth { deepest, lower: f64::NAN, upper: f64::NAN, translation: [f64::NAN; 3] }
    }
}

/// A contact of two compounds: the manifold of two of their pieces.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
#[repr(C)]
pub struct CompoundContact {
    /// The manifold of the two pieces.
    pub manifold: Manifold,
    /// The first of its points among all of the answer.
    pub first_point: u32,
    /// The piece of compound 1.
    pub piece1: u32,
    /// The piece of compound 2.
    pub piece2: u32,
}

/// The contacts of two compounds, in order of the pieces.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct CompoundContacts {
    /// One for each two pieces in contact.
    pub contacts: Vec<CompoundContact>,
    /// The points of all.
    pub points: Vec<ManifoldPoint>,
}

/// The answer to a cast of two compounds.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
#[repr(C)]
pub struct CompoundCastAnswer {
    /// Outcome, times and clearance are those of the compounds. Upper, contact and proof are about two of their pieces: those that
    /// meet first or, where none do, those that end the cast. Local points are in the frames of these pieces.
    pub answer: CastAnswer,
    /// The piece of compound 1; its number of pieces where none is named.
    pub piece1: u32,
    /// The piece of compound 2, likewise.
    pub piece2: u32,
}

/// The part of a ray that is in a compound. The number of pieces stands for none.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
#[repr(C)]
pub struct CompoundRayAnswer {
    /// Outcome and entry are those of the compound. Exit, normal and feature are those of the piece that the ray enters first, or
    /// that it begins in: it may leave that and be in another.
    pub answer: RayAnswer,
    /// That piece.
    pub piece: u32,
}

/// Position of a point relative to a compound. The number of pieces stands for none.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
#[repr(C)]
pub struct CompoundPointAnswer {
    /// Inside: in the interior of a piece. On: on the surface of one and in the interior of none, be it where two pieces join.
    /// Distance and all else are those of the piece with the least signed distance. Inside a compound that is how deep the point
    /// is in one piece: its surface is at least as far.
    pub answer: PointAnswer,
    /// That piece.
    pub piece: u32,
}
