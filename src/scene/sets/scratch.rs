//! What a question about a set works in.

use crate::ground::GroundContacts;
use crate::scene::near::tree::Branch;
use crate::scene::sets::caches::Caches;
use crate::scene::sets::casts::{Approach, Mover, SweptBox};
use crate::scene::sets::grounds::SceneGroundContact;
use crate::scene::sets::members::Member;
use crate::scene::sets::nearest::Candidates;
use crate::scene::sets::rays::{Nearing, SceneRayHit};

/// Room to work in for questions that threads ask a scene at once: about sets of objects, and of rays, grounds and half-spaces. One
/// thread at a time uses it, for any scenes.
///
/// Of sets it keeps what pairs of objects remember, which changes how fast an answer comes and which of several nearest points it
/// gives, never a verdict. Of rays, grounds and half-spaces it keeps nothing but the room and the last answer: whatever it has
/// seen, they are answered bit for bit as with a new one.
#[derive(Debug, Default)]
pub struct SetScratch {
    pub(crate) members: Vec<Member>,
    /// Of the second set.
    pub(crate) second: Vec<Member>,
    pub(crate) candidates: Candidates,
    pub(crate) caches: Caches,
    /// Branches of a tree that are to be looked at.
    pub(crate) open: Vec<Branch>,
    /// Pieces whose boxes came into question.
    pub(crate) found: Vec<u32>,
    pub(crate) nearing: Vec<Nearing>,
    /// What the last ray met.
    pub(crate) hits: Vec<SceneRayHit>,
    pub(crate) movers: Vec<Mover>,
    pub(crate) boxes: Vec<SweptBox>,
    pub(crate) approaches: Vec<Approach>,
    /// Where the last piece meets a ground, and the points of all pieces.
    pub(crate) ground: GroundContacts,
    pub(crate) contacts: Vec<SceneGroundContact>,
}
