//! The options and the answer of a query over a scene.

use std::borrow::Cow;

use crate::base::error::{Error, Result};
use crate::base::math::Pose;
use crate::manifold::{Manifold, ManifoldPoint};
use crate::pair::{DepthAnswer, Levels, Outcome, PairAnswer, Refinement, SignedDistance, Start};
use crate::scene::world::object::ObjectId;

/// The options of a query over a scene.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SceneQuery {
    /// Stop at the first intersecting pair in the order of results, and then list no pairs at all: [`SceneAnswer::found`] is it.
    pub early_exit: bool,
    /// List pairs whose true distance is at most this, intersecting ones always, and those that a step budget leaves open; from 0
    /// to +∞ (the default: all pairs, which takes time in proportion to their number).
    /// [`query_intersection`](crate::scene::Scene::query_intersection) needs none, but refuses one out of range.
    pub max_distance: f64,
    /// [Approximate queries](crate::scene::Scene::query_approximate): `upper − lower` of a pair may be as large as this …
    pub absolute_error: f64,
    /// … or as this times `lower`. Both 0 (the default): as narrow as exact answers.
    pub relative_error: f64,
    /// [Approximate queries](crate::scene::Scene::query_approximate): finite, it is what `upper − lower` of all listed pairs
    /// together may come to, whatever the two errors say, beside what exact answers take. Pairs that maps of support functions or
    /// levels of detail may answer with a share of it take one, regardless; others are answered as by exact queries, and so are
    /// all where the scene does not keep all pairs ([`set_kept_pair_limit`](crate::scene::Scene::set_kept_pair_limit)). Default:
    /// +∞.
    pub error_budget: f64,
    /// [Approximate queries](crate::scene::Scene::query_approximate): as
    /// [`PairConfig::step_budget`](crate::pair::PairConfig::step_budget), of each pair.
    pub step_budget: u32,
    /// Which levels of detail queries go through.
    pub levels: Levels,
    /// How they go from level to level.
    pub refinement: Refinement,
    /// The start of marching in each pair.
    pub start: Start,
    /// [Contacts](crate::scene::Scene::query_contact): the details of each pair beside its answer. `absolute_error`,
    /// `relative_error` and `step_budget` are then those of the depths, and points with a gap above `max_distance` are left out.
    pub detail: ContactDetail,
    /// Which pairs of pieces are listed for every two objects.
    pub piece_pairs: PiecePairs,
}

/// The subject of a query.
#[derive(Debug, Clone)]
pub(crate) enum Subject<'a, Object, Shape: Clone> {
    AllPairs,
    Object(Object),
    Placed(PlacedBody<'a, Shape>),
    /// The changes since the last query of this kind; its distance is the query's tolerance.
    Events,
}

/// A body that is in no scene, put somewhere for one question.
#[derive(Debug, Clone)]
pub(crate) struct PlacedBody<'a, Shape: Clone> {
    /// Its convex pieces, and where each is in the world.
    pub pieces: Cow<'a, [(Shape, Pose)]>,
    /// Objects are asked whose groups have a bit of it; without one all.
    pub mask: Option<u32>,
}

impl<Shape: Clone> PlacedBody<'_, Shape> {
    /// Refuses a body of no pieces, and poses that are not accepted.
    ///
    /// # Errors
    /// [`Error::Argument`], [`Error::Pose`].
    pub fn check(&self) -> Result<()> {
        match &*self.pieces {
            [] => Err(Error::Argument("a placed body needs at least one piece".into())),
            [(_, pose)] => pose.check(),
            pieces => (0..).zip(pieces).try_for_each(|(k, (_, pose)): (usize, _)| {
                pose.check().map_err(|error| error.about(&format!("pose {k} of {}", pieces.len())))
            }),
        }
    }
}

/// Details that a query of contacts returns for each pair beside its answer.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[repr(i32)]
pub enum ContactDetail {
    /// Nothing.
    #[default]
    None = 0,
    /// How deep intersecting pairs are in each other.
    Depth = 1,
    /// That, and the manifold, also of listed pairs that are apart.
    Manifold = 2,
    /// That, and of more than four points of a manifold four: the deepest, the farthest from it and the extremes on either side of
    /// the line between them. None is moved.
    ReducedManifold = 3,
}

/// Which pairs of convex pieces a query lists for every two objects, of those within its distance. Pieces of compounds make pairs
/// only for contacts with a detail.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[repr(i32)]
pub enum PiecePairs {
    /// Every pair.
    #[default]
    Every = 0,
    /// The first pair in the order of results. Later ones are not tested: where it is apart, another may intersect.
    First = 1,
    /// The nearest pair: the first that intersects, else the first with the least upper. Its lower is the least of all, so its
    /// interval holds the distance between the two objects. If no pair intersects but one is undecided, the listed outcome is
    /// undecided. Earlier queries may decide between pairs whose intervals overlap.
    Nearest = 2,
}

impl Default for SceneQuery {
    fn default() -> Self {
        SceneQuery {
            early_exit: false,
            max_distance: f64::INFINITY,
            absolute_error: 0.0,
            relative_error: 0.0,
            error_budget: f64::INFINITY,
            step_budget: u32::MAX,
            levels: Levels::Automatic,
            refinement: Refinement::Adaptive,
            start: Start::Automatic,
            detail: ContactDetail::None,
            piece_pairs: PiecePairs::Every,
        }
    }
}

/// One pair of convex pieces in a query's list. A compound is named with the piece that the answer is about.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
#[repr(C)]
pub struct PairResult {
    /// The earlier created object.
    pub object1: ObjectId,
    /// The later created object.
    pub object2: ObjectId,
    /// The caller's own number of object 1.
    pub user_data1: u64,
    /// The caller's own number of object 2.
    pub user_data2: u64,
    /// Which piece of object 1.
    pub piece1: u32,
    /// Which piece of object 2.
    pub piece2: u32,
    /// The answer.
    pub answer: PairAnswer,
}

impl PairResult {
    /// Names the pieces of what is a compound.
    pub(crate) fn name_pieces(&mut self, [piece1, piece2]: [Option<u32>; 2]) {
        self.piece1 = piece1.unwrap_or(self.piece1);
        self.piece2 = piece2.unwrap_or(self.piece2);
    }
}

/// A query of contacts returns this for a pair beside its answer. Parts not asked for are unset; with a ground all are.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
#[repr(C)]
pub struct Contact {
    /// Depth of the two; unset if they do not intersect.
    pub depth: DepthAnswer,
    /// Their contact points.
    pub manifold: Manifold,
    /// Start of the manifold's points among all points; there are manifold.point_count.
    pub first_point: usize,
}

/// The details of a query of contacts beside its answers.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct SceneContacts<'a> {
    /// One for each of the pairs, in their order; for a query that stopped, that of [`SceneAnswer::found`]. Empty where none were
    /// asked for.
    pub contacts: &'a [Contact],
    /// The points of their manifolds.
    pub points: &'a [ManifoldPoint],
}

impl<'a> SceneContacts<'a> {
    /// The points of one of the contacts.
    pub fn points_of(&self, contact: &Contact) -> &'a [ManifoldPoint] {
        &self.points[contact.first_point..][..contact.manifold.point_count as usize]
    }
}

/// The answer of a query over a scene.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SceneAnswer<'a> {
    /// Whether any tested pair intersects.
    pub intersecting: bool,
    /// The pairs that the query lists, in the scene's order. Owned by the scene until its next query.
    pub pairs: &'a [PairResult],
    /// The intersecting pair at which the query stopped, if it did ([`SceneQuery::early_exit`]): of all that intersect the first in
    /// the scene's order, with what the query says of such pairs. (A step budget may leave an earlier one undecided.) Owned as
    /// `pairs` are.
    pub found: Option<&'a PairResult>,
    /// The details asked for beside the answers. Owned as `pairs` are.
    pub contacts: SceneContacts<'a>,
}

impl SceneAnswer<'_> {
    /// The distance of a pair, or minus how deep it is, as one interval through zero. The pair is that of one of the `contacts`, by
    /// its number among them. It is put together from what the query has said.
    ///
    /// # Errors
    /// [`Error::Argument`] if there are not so many contacts, and for a ground that the piece touches.
    pub fn signed_distance(&self, number: usize) -> Result<SignedDistance> {
        let pair = self.found.or(self.pairs.get(number));
        let (Some(Contact { depth, .. }), Some(PairResult { answer, .. })) = (self.contacts.contacts.get(number), pair)
        else {
            let count = self.contacts.contacts.len();
            return Err(Error::Argument(format!(
                "there is no contact {number}, the last query said {count}: ask for contacts with their depths"
            )));
        };
        if answer.outcome == Outcome::Intersecting && depth.outcome == Outcome::None {
            return Err(Error::Argument(format!(
                "contact {number} is with a ground, whose depth this query does not find: ask for the ground's contacts"
            )));
        }
        let is_deep = depth.outcome == Outcome::Intersecting;
        Ok(if is_deep { SignedDistance::from(depth) } else { SignedDistance::from(answer) })
    }
}

/// A pair of objects, the earlier created first.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[repr(C)]
pub struct ObjectPair {
    /// The earlier created object.
    pub object1: ObjectId,
    /// The later created object.
    pub object2: ObjectId,
    /// The caller's own number of object 1.
    pub user_data1: u64,
    /// The caller's own number of object 2.
    pub user_data2: u64,
}

/// The changes, in order of creation.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SceneEvents<'a> {
    /// Pairs that are near and were not. Owned by the scene until its next query about events.
    pub began: &'a [ObjectPair],
    /// Pairs that were near and are not, those of removed objects and of deactivated pairs among them. Owned as `began` are.
    pub ended: &'a [ObjectPair],
}
