//! A scene: objects with poses, the pairs of them that are tested, and queries over all these pairs.
//!
//! ```text
//! poses ─► proxies (spheres, boxes, odometers) ─► broad_phase: near pairs ─► narrow_phase: a first look, the pair layer ─► results
//! ```
//!
//! Queries list their results by object 1, object 2, piece 1, piece 2, objects in order of creation; object 1 is always
//! the earlier created of the two. What a query answers depends on the objects, their poses and the activation alone:
//! not on earlier queries, on other objects or on how the objects came to where they are. (Where nearest points are not
//! unique, any of them may be given, and of an approximate distance any interval that is narrow enough, or as the step budget
//! leaves it. Status and statistics of an answer tell how it was found, and that depends on what the pair remembers.)

pub mod object;
mod activation;
mod query;
mod statistics;
mod boxes;
mod rows;
mod proxies;
mod object_view;
mod contacts;
mod broad_phase;
mod findings;
mod narrow_phase;
mod parts;
pub(crate) mod recording;
mod poses;
mod filters;
mod run;
mod object_query;
mod events;
mod replay;

use std::sync::Arc;

#[cfg(doc)]
use crate::base::error::Error;
use crate::base::error::{Result, check_range};
#[cfg(doc)]
use crate::base::math::Pose;
use crate::base::math::ROTATION_LIMIT;
use crate::base::memory::copied;
use crate::base::simd::environment::with_default;
use crate::pair::PairConfig;
#[cfg(doc)]
use crate::pair::{self, Outcome};
use crate::scene::activation::Activation;
use crate::scene::broad_phase::BroadPhase;
use crate::scene::contacts::Details;
use crate::scene::events::Events;
use crate::scene::findings::{Before, Findings};
use crate::scene::object::{ObjectId, ObjectOptions, ObjectTable};
use crate::scene::object_view::Objects;
use crate::scene::parts::PartFindings;
use crate::scene::proxies::{NewProxy, Proxies};
use crate::scene::recording::Recording;
use crate::scene::recording::format::Record;
use crate::scene::rows::Label;
use crate::shape::Shape;

pub use crate::base::workers::Workers;
pub use crate::pair::Query;
pub use events::{ObjectPair, SceneEvents};
pub use filters::PairFilter;
pub use object_view::Object;
pub use query::{Contact, ContactDetail, PairResult, SceneAnswer, SceneContacts, SceneQuery};
pub use replay::{Replay, ReplayAnswer, ReplayStep};
pub use statistics::SceneStatistics;

/// How a scene is made.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SceneOptions {
    /// Largest accepted |RᵀR − I| entry of a pose, from 0 to [`ROTATION_LIMIT`] (the default).
    pub rotation_limit: f64,
}

impl Default for SceneOptions {
    fn default() -> Self {
        SceneOptions { rotation_limit: ROTATION_LIMIT }
    }
}

/// Objects, poses and the pairs that are tested.
///
/// A new pair is active, a pair of two fixed objects never exists. What is said of a pair, an object or all holds for
/// the pairs there are until something later is said that covers them; objects added later begin with all their pairs
/// active. Deactivated pairs are not tested, and keep what they remember while they are near.
#[derive(Debug)]
pub struct Scene {
    objects: ObjectTable,
    proxies: Proxies,
    broad_phase: BroadPhase,
    activation: Activation,
    filter: Option<PairFilter>,
    /// What was said on the testing of pairs and is not yet said to the near ones.
    news: News,
    /// The pairs of a program with a broad phase of its own; where there are none, the scene's own finds what is near.
    given: Option<Vec<[ObjectId; 2]>>,
    rotation_limit: f64,
    /// How many times queries have looked at the pairs.
    passes: u64,
    /// What the last one asked, if it came to its end, and where its results are.
    last: Option<Asked>,
    findings: Findings,
    /// The results of the query before, or what is left of them.
    before: Before,
    events: Events,
    /// Who works on poses and queries, and what each part of a pass found.
    workers: Workers,
    parts: Vec<PartFindings>,
    recording: Recording,
    statistics: SceneStatistics,
}

/// What is to be said to the near pairs, the later including the earlier.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum News {
    None,
    /// Activation has changed.
    Activation,
    /// All are to be filtered anew.
    Filter,
}

/// What makes two queries the same.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Asked {
    config: PairConfig,
    query: Query,
    details: Option<Details>,
}

impl Scene {
    /// An empty scene.
    ///
    /// # Errors
    /// [`Error::Argument`] for a rotation limit that is negative, NaN or above [`ROTATION_LIMIT`].
    pub fn new(options: &SceneOptions) -> Result<Scene> {
        let rotation_limit = options.rotation_limit;
        with_default(|| check_range("rotation_limit", rotation_limit, 0.0..=ROTATION_LIMIT))?;
        Ok(Scene {
            objects: ObjectTable::new(),
            proxies: Proxies::default(),
            broad_phase: BroadPhase::default(),
            activation: Activation::default(),
            filter: None,
            news: News::None,
            given: None,
            rotation_limit,
            passes: 0,
            last: None,
            findings: Findings::default(),
            before: Before::default(),
            events: Events::default(),
            workers: Workers::none(),
            parts: Vec::new(),
            recording: Recording::Off,
            statistics: SceneStatistics::default(),
        })
    }

    /// Lets several threads work on a query and on poses that are set together, or one again. It changes no bit of any answer.
    /// Queries that stop early, those without a tolerance over many objects, and few pairs or objects are left to the caller's
    /// thread.
    pub fn set_workers(&mut self, workers: Option<Workers>) {
        self.workers = workers.unwrap_or_else(Workers::none);
    }

    // --- Objects ---

    /// Adds an object of one or several convex pieces in one local frame. All its pairs are active.
    ///
    /// # Errors
    /// [`Error::Argument`] without pieces, [`Error::Pose`] for a pose that is not accepted, [`Error::Limit`] when there are
    /// no ids left, [`Error::Memory`]. Nothing is added then.
    pub fn add_object(&mut self, pieces: Vec<Arc<Shape>>, options: &ObjectOptions) -> Result<ObjectId> {
        let id = self.insert(pieces, options)?;
        self.note(|notes| notes.object(id));
        Ok(id)
    }

    fn insert(&mut self, pieces: Vec<Arc<Shape>>, options: &ObjectOptions) -> Result<ObjectId> {
        with_default(|| options.pose.check(self.rotation_limit))?;
        self.proxies.reserve(pieces.len())?;
        self.broad_phase.reserve(pieces.len())?;
        let first = self.proxies.len();
        let id = self.objects.insert(first..first + pieces.len())?;
        self.activation.set_object(&mut self.objects.get_mut(id)?.activation, true);
        for (piece, shape) in (0..).zip(pieces) {
            let ObjectOptions { user_data, fixed, groups, mask, .. } = *options;
            let label = Label { object: id, user_data, piece, fixed, groups, mask };
            self.proxies.push(NewProxy { shape, pose: options.pose, label });
            self.broad_phase.push();
        }
        Ok(id)
    }

    /// Adds an object with the pieces (shared), the poses, the fixedness, the filter bits and the user data of another one. All its
    /// pairs are active, whatever those of its original are.
    ///
    /// # Errors
    /// [`Error::Handle`] for an id that is null, stale or another scene's, [`Error::Limit`] when there are no ids left,
    /// [`Error::Memory`]. Nothing is added then.
    pub fn copy_object(&mut self, id: ObjectId) -> Result<ObjectId> {
        let original = self.object(id)?;
        let options = original.options();
        let piece_poses = copied(original.piece_poses())?;
        let copy = self.insert(copied(original.pieces())?, &options)?;
        self.put_pieces(copy, piece_poses)?;
        self.note(|notes| notes.write(&Record::Copy(notes.number(id)?)));
        Ok(copy)
    }

    /// Removes an object and its pairs. Its id is stale from now on; all other ids stay as they are.
    ///
    /// # Errors
    /// [`Error::Handle`] for an id that is null, stale or another scene's.
    pub fn remove_object(&mut self, id: ObjectId) -> Result<()> {
        self.objects.get(id)?;
        self.note(|notes| notes.write(&Record::Remove(notes.number(id)?)));
        for proxy in self.objects.get(id)?.proxies() {
            self.broad_phase.take_out(proxy, self.proxies.labels[proxy].fixed);
            self.proxies.end(proxy);
        }
        self.objects.remove(id)
    }

    /// An object, for reading.
    ///
    /// # Errors
    /// [`Error::Handle`] for an id that is null, stale or another scene's.
    pub fn object(&self, id: ObjectId) -> Result<Object<'_>> {
        self.view().get(id)
    }

    /// All objects in order of creation.
    pub fn objects(&self) -> impl Iterator<Item = Object<'_>> {
        self.view().iter()
    }

    fn view(&self) -> Objects<'_> {
        Objects { table: &self.objects, proxies: &self.proxies }
    }

    /// The number of objects.
    pub fn object_count(&self) -> usize {
        self.objects.len()
    }

    /// Fixes an object or lets it move: two fixed ones are never tested. What its pairs remember stays.
    ///
    /// # Errors
    /// [`Error::Handle`] for an id that is null, stale or another scene's.
    pub fn set_fixed(&mut self, id: ObjectId, fixed: bool) -> Result<()> {
        for proxy in self.objects.get(id)?.proxies() {
            let was_fixed = std::mem::replace(&mut self.proxies.labels[proxy].fixed, fixed);
            if fixed != was_fixed {
                self.broad_phase.take_out(proxy, was_fixed);
                self.proxies.look_for_pairs_of(proxy);
            }
        }
        self.note(|notes| notes.write(&Record::Fixed(notes.number(id)?, fixed)));
        Ok(())
    }

    /// Sets the filter bits of an object ([`ObjectOptions::groups`]).
    ///
    /// # Errors
    /// [`Error::Handle`] for an id that is null, stale or another scene's.
    pub fn set_filter(&mut self, id: ObjectId, groups: u32, mask: u32) -> Result<()> {
        for proxy in self.objects.get(id)?.proxies() {
            let label = &mut self.proxies.labels[proxy];
            if (label.groups, label.mask) != (groups, mask) {
                (label.groups, label.mask) = (groups, mask);
                self.proxies.look_for_pairs_of(proxy);
            }
        }
        self.note(|notes| notes.write(&Record::Groups { object: notes.number(id)?, groups, mask }));
        Ok(())
    }

    /// Sets the number that comes back in every result of this object.
    ///
    /// # Errors
    /// [`Error::Handle`] for an id that is null, stale or another scene's.
    pub fn set_user_data(&mut self, id: ObjectId, user_data: u64) -> Result<()> {
        for proxy in self.objects.get(id)?.proxies() {
            self.proxies.labels[proxy].user_data = user_data;
        }
        // No result with the old number is given again.
        self.last = None;
        self.note(|notes| notes.write(&Record::UserData(notes.number(id)?, user_data)));
        Ok(())
    }

    // --- Queries ---

    /// Lists the intersecting pairs (touching ones are), each with its verdict alone.
    ///
    /// # Errors
    /// [`Error::Argument`] for a tolerance, an error or a budget that is negative or NaN and a step budget of 0, also where the
    /// query does without them; [`Error::Memory`] when that for a changed list of pairs is not there: the next query tries again.
    pub fn query_intersection(&mut self, query: &SceneQuery) -> Result<SceneAnswer<'_>> {
        self.run(query, Query::Intersection)
    }

    /// Lists the pairs whose distance is at most the distance tolerance, intersecting ones included. Its answers say what those of
    /// [`Scene::query_exact_distance`] do.
    ///
    /// # Errors
    /// As [`Scene::query_intersection`].
    pub fn query_tolerance(&mut self, query: &SceneQuery) -> Result<SceneAnswer<'_>> {
        self.query_exact_distance(query)
    }

    /// Lists the pairs whose distance is at most the distance tolerance, and the intersecting ones, with distance, witness
    /// points, normal and features ([`pair::distance`]).
    ///
    /// # Errors
    /// As [`Scene::query_intersection`].
    pub fn query_exact_distance(&mut self, query: &SceneQuery) -> Result<SceneAnswer<'_>> {
        self.run(query, Query::Distance)
    }

    /// As [`Scene::query_exact_distance`], and intersecting pairs have finite witness points and a unit normal as well
    /// ([`pair::contact`]).
    ///
    /// With a [`SceneQuery::detail`] the answers say what those of [`Scene::query_exact_distance`] do, and
    /// [`SceneAnswer::contacts`] how deep each pair is, and where its objects meet: what [`pair::depth()`] and [`pair::manifold()`]
    /// say.
    ///
    /// # Errors
    /// As [`Scene::query_intersection`], for a margin as well; and [`Error::Memory`] when that for depths and points is not there.
    pub fn query_contacts(&mut self, query: &SceneQuery) -> Result<SceneAnswer<'_>> {
        self.run(query, Query::Contact)
    }

    /// As [`Scene::query_exact_distance`], each distance as narrow as the query asks for and no narrower
    /// ([`pair::approximate`]). A pair whose step budget ran out before the verdict ([`Outcome::Undecided`]) is listed and does
    /// not count as intersecting.
    ///
    /// # Errors
    /// As [`Scene::query_intersection`].
    pub fn query_approximate_distance(&mut self, query: &SceneQuery) -> Result<SceneAnswer<'_>> {
        self.run(query, Query::Approximate)
    }

    /// What the last query said beside its answers: [`SceneAnswer::contacts`].
    pub fn contacts(&self) -> SceneContacts<'_> {
        self.findings.contacts.view()
    }

    /// Pairs whose depth is remembered: how many there is room for, and how many there are.
    #[doc(hidden)]
    pub fn remembered_depths(&self) -> [usize; 2] {
        self.broad_phase.near.contacts.depth_counts()
    }

    /// What the queries did.
    pub fn statistics(&self) -> &SceneStatistics {
        &self.statistics
    }

    /// Sets all statistics to zero.
    pub fn reset_statistics(&mut self) {
        self.statistics = SceneStatistics::default();
    }
}
