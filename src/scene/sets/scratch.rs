//! The scratch memory of a question about a set.

use crate::ground::GroundContacts;
use crate::scene::near::tree::Branch;
use crate::scene::sets::caches::Caches;
use crate::scene::sets::casts::{Approach, Mover, SweptBox};
use crate::scene::sets::grounds::SceneGroundContact;
use crate::scene::sets::members::Member;
use crate::scene::sets::nearest::SetCandidates;
use crate::scene::sets::rays::{Nearing, SceneRayHit};

/// Scratch memory for questions that threads ask a scene at once: about sets of objects, and about rays, grounds and half-spaces.
/// One thread at a time uses it, for any scenes.
///
/// For sets it keeps the caches of pairs of objects. These change how fast an answer comes, which of several nearest points it
/// gives, and which of several pairs that hit a first hit names; never a verdict. For rays, grounds and half-spaces it keeps
/// nothing but the room and the last answer. Whatever it has seen, they are answered bit for bit as with a new one.
#[derive(Debug, Default)]
pub struct SetScratch {
    pub(crate) members: Vec<Member>,
    /// The members of the second set.
    pub(crate) second: Vec<Member>,
    pub(crate) candidates: SetCandidates,
    pub(crate) caches: Caches,
    /// Branches of a tree that still must be looked at.
    pub(crate) open: Vec<Branch>,
    /// Pieces whose boxes came into question.
    pub(crate) found: Vec<u32>,
    pub(crate) nearing: Vec<Nearing>,
    /// The hits of the last ray.
    pub(crate) hits: Vec<SceneRayHit>,
    pub(crate) movers: Vec<Mover>,
    pub(crate) boxes: Vec<SweptBox>,
    pub(crate) approaches: Vec<Approach>,
    /// The contacts of the last piece with a ground, and the points of all pieces.
    pub(crate) ground: GroundContacts,
    pub(crate) contacts: Vec<SceneGroundContact>,
    /// Pieces and the grounds that they may touch.
    pub(crate) near_grounds: Vec<[u32; 2]>,
}
