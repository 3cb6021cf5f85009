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
mod proxies;
mod broad_phase;
mod narrow_phase;
mod run;

use std::sync::Arc;

use crate::base::error::{Error, Result, check_range};
use crate::base::math::{Pose, ROTATION_LIMIT};
use crate::base::memory::copied;
use crate::base::simd::environment::with_default;
#[cfg(doc)]
use crate::pair::{self, Outcome};
use crate::pair::{PairConfig, Query};
use crate::scene::activation::Activation;
use crate::scene::broad_phase::BroadPhase;
use crate::scene::broad_phase::near_pairs::Testing;
use crate::scene::narrow_phase::Findings;
use crate::scene::object::{Object, ObjectId, ObjectOptions, ObjectTable};
use crate::scene::proxies::{Label, NewProxy, Proxies};
use crate::shape::Shape;

pub use query::{PairResult, SceneAnswer, SceneQuery};
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
/// active. Deactivated pairs are not tested and remember nothing.
#[derive(Debug)]
pub struct Scene {
    objects: ObjectTable,
    proxies: Proxies,
    broad_phase: BroadPhase,
    activation: Activation,
    /// What was said on activation is not yet said to the near pairs.
    activation_changed: bool,
    rotation_limit: f64,
    /// How many times queries have looked at the pairs.
    passes: u64,
    /// What the last one asked, if it came to its end, and where its results are.
    last: Option<Asked>,
    findings: Findings,
    /// The results of the query before, or what is left of them.
    before: Vec<PairResult>,
    statistics: SceneStatistics,
}

/// What makes two queries the same.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Asked {
    config: PairConfig,
    query: Query,
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
            activation_changed: false,
            rotation_limit,
            passes: 0,
            last: None,
            findings: Findings::default(),
            before: Vec::new(),
            statistics: SceneStatistics::default(),
        })
    }

    // --- Objects ---

    /// Adds an object of one or several convex pieces in one local frame. All its pairs are active.
    ///
    /// # Errors
    /// [`Error::Argument`] without pieces, [`Error::Pose`] for a pose that is not accepted, [`Error::Limit`] when there are
    /// no ids left, [`Error::Memory`]. Nothing is added then.
    pub fn add_object(&mut self, pieces: Vec<Arc<Shape>>, options: &ObjectOptions) -> Result<ObjectId> {
        if pieces.is_empty() {
            return Err(Error::Argument("an object needs at least one piece".into()));
        }
        if u32::try_from(pieces.len()).is_err() {
            return Err(Error::Limit(format!("{} pieces do not fit 32 bits", pieces.len())));
        }
        with_default(|| options.pose.check(self.rotation_limit))?;
        self.proxies.reserve(pieces.len())?;
        self.broad_phase.reserve(pieces.len())?;
        let id = self.objects.insert(pieces, options, self.proxies.len() as u32)?;
        let object = self.objects.get_mut(id)?;
        self.activation.set_object(object, true);
        for (piece, shape) in (0..).zip(&object.pieces) {
            let label = Label { object: id, user_data: options.user_data, piece, fixed: options.fixed };
            self.proxies.push(NewProxy { shape: shape.clone(), pose: options.pose, label });
            self.broad_phase.push();
        }
        Ok(id)
    }

    /// Adds an object with the pieces (shared), the pose, the fixedness and the user data of another one. All its pairs
    /// are active, whatever those of its original are.
    ///
    /// # Errors
    /// [`Error::Handle`] for an id that is null, stale or another scene's, [`Error::Limit`] when there are no ids left,
    /// [`Error::Memory`]. Nothing is added then.
    pub fn copy_object(&mut self, id: ObjectId) -> Result<ObjectId> {
        let original = self.objects.get(id)?;
        let options = ObjectOptions { pose: original.pose, fixed: original.fixed, user_data: original.user_data };
        self.add_object(copied(&original.pieces)?, &options)
    }

    /// Removes an object and its pairs. Its id is stale from now on; all other ids stay as they are.
    ///
    /// # Errors
    /// [`Error::Handle`] for an id that is null, stale or another scene's.
    pub fn remove_object(&mut self, id: ObjectId) -> Result<()> {
        let object = self.objects.get(id)?;
        for proxy in object.proxies() {
            self.broad_phase.take_out(proxy, object.fixed);
            self.proxies.end(proxy);
        }
        self.objects.remove(id)
    }

    /// An object, for reading.
    ///
    /// # Errors
    /// [`Error::Handle`] for an id that is null, stale or another scene's.
    pub fn object(&self, id: ObjectId) -> Result<&Object> {
        self.objects.get(id)
    }

    /// All objects in order of creation.
    pub fn objects(&self) -> impl Iterator<Item = &Object> {
        self.objects.iter()
    }

    /// The number of objects.
    pub fn object_count(&self) -> usize {
        self.objects.len()
    }

    /// Sets the number that comes back in every result of this object.
    ///
    /// # Errors
    /// [`Error::Handle`] for an id that is null, stale or another scene's.
    pub fn set_user_data(&mut self, id: ObjectId, user_data: u64) -> Result<()> {
        let object = self.objects.get_mut(id)?;
        object.user_data = user_data;
        for proxy in object.proxies() {
            self.proxies.labels[proxy].user_data = user_data;
        }
        Ok(())
    }

    // --- Poses ---

    /// Moves an object, a fixed one too. For twelve numbers see [`Pose::from_row_major`], for R and T [`Pose::new`].
    ///
    /// # Errors
    /// [`Error::Handle`] for an id that is null, stale or another scene's, [`Error::Pose`] for a pose that is not accepted;
    /// the object then stays where it is.
    pub fn set_pose(&mut self, id: ObjectId, pose: &Pose) -> Result<()> {
        let object = self.objects.get_mut(id)?;
        let (proxies, passes, limit) = (&mut self.proxies, self.passes, self.rotation_limit);
        with_default(|| {
            pose.check(limit)?;
            place(object, pose, proxies, passes);
            Ok(())
        })
    }

    /// Moves all objects that are not fixed, in order of creation.
    ///
    /// # Errors
    /// [`Error::Argument`] unless there is one pose for each, [`Error::Pose`] for a pose that is not accepted; all objects then
    /// stay where they are.
    pub fn set_all_poses(&mut self, poses: &[Pose]) -> Result<()> {
        let moving = self.objects.iter().filter(|object| !object.fixed).count();
        if poses.len() != moving {
            return Err(Error::Argument(format!("{} poses for {moving} objects that are not fixed", poses.len())));
        }
        for (k, pose) in poses.iter().enumerate() {
            with_default(|| pose.check(self.rotation_limit))
                .map_err(|e| Error::Pose(format!("pose {k} of {moving}: {e}")))?;
        }
        let mut poses = poses.iter();
        let (proxies, passes) = (&mut self.proxies, self.passes);
        with_default(|| {
            self.objects.for_each_mut(|object| {
                if !object.fixed
                    && let Some(pose) = poses.next()
                {
                    place(object, pose, proxies, passes);
                }
            });
        });
        Ok(())
    }

    // --- Activation ---

    /// Activates or deactivates the pair of two objects, in either order, with all its pairs of pieces. No effect on two
    /// fixed objects.
    ///
    /// # Errors
    /// [`Error::Handle`] for an id that is null, stale or another scene's, [`Error::Argument`] for one object twice,
    /// [`Error::Memory`]; the pair stays as it is.
    pub fn set_pair_active(&mut self, id1: ObjectId, id2: ObjectId, active: bool) -> Result<()> {
        let (object1, object2) = self.ordered_pair(id1, id2)?;
        let pair = [object1.id(), object2.id()];
        let objects = &self.objects;
        let pieces = (object1.proxies(), object2.proxies());
        self.activation.set_pair(pair, active, |id| objects.get(id).is_ok())?;
        let testing = if active { Testing::Active } else { Testing::Inactive };
        for proxy1 in pieces.0 {
            for proxy2 in pieces.1.clone() {
                self.broad_phase.near.set_testing(&self.proxies.firsts, [proxy1 as u32, proxy2 as u32], testing);
            }
        }
        Ok(())
    }

    /// Activates or deactivates all pairs that an object is in.
    ///
    /// # Errors
    /// [`Error::Handle`] for an id that is null, stale or another scene's.
    pub fn set_object_active(&mut self, id: ObjectId, active: bool) -> Result<()> {
        self.activation.set_object(self.objects.get_mut(id)?, active);
        self.activation_changed = true;
        Ok(())
    }

    /// Activates or deactivates all pairs.
    pub fn set_all_active(&mut self, active: bool) {
        self.activation.set_all(active);
        self.activation_changed = true;
    }

    /// Whether queries test the pair of two objects, given in either order.
    ///
    /// # Errors
    /// As [`Scene::set_pair_active`].
    pub fn is_pair_active(&self, id1: ObjectId, id2: ObjectId) -> Result<bool> {
        let (object1, object2) = self.ordered_pair(id1, id2)?;
        Ok(self.tests(object1, object2))
    }

    /// Two different objects, the earlier created first.
    fn ordered_pair(&self, id1: ObjectId, id2: ObjectId) -> Result<(&Object, &Object)> {
        let (object1, object2) = (self.objects.get(id1)?, self.objects.get(id2)?);
        match object1.first_proxy.cmp(&object2.first_proxy) {
            std::cmp::Ordering::Less => Ok((object1, object2)),
            std::cmp::Ordering::Equal => {
                Err(Error::Argument(format!("object {id1} is given twice: an object makes no pair with itself")))
            }
            std::cmp::Ordering::Greater => Ok((object2, object1)),
        }
    }

    /// Whether queries test the pair, the earlier created object first.
    fn tests(&self, object1: &Object, object2: &Object) -> bool {
        !(object1.fixed && object2.fixed) && self.activation.is_active(object1, object2)
    }

    // --- Near pairs ---

    /// Brings the near pairs up to date: all that a query with this tolerance may list are among them.
    ///
    /// # Errors
    /// [`Error::Memory`].
    fn update_near_pairs(&mut self, tolerance: f64) -> Result<()> {
        let (objects, activation) = (&self.objects, &self.activation);
        let testing = |pair: [&Label; 2]| testing(objects, activation, pair);
        if self.activation_changed {
            self.broad_phase.near.for_each_testing(&self.proxies.labels, testing);
            self.activation_changed = false;
        }
        self.broad_phase.update(&mut self.proxies, tolerance, testing)?;
        if self.proxies.has_many_gone()
            && let Some(numbers) = self.broad_phase.renumber(&mut self.proxies)
        {
            let renumber = |object: &mut Object| object.first_proxy = numbers[object.first_proxy as usize];
            self.objects.for_each_mut(renumber);
        }
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
    /// # Errors
    /// As [`Scene::query_intersection`].
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

    /// What the queries did.
    pub fn statistics(&self) -> &SceneStatistics {
        &self.statistics
    }

    /// Sets all statistics to zero.
    pub fn reset_statistics(&mut self) {
        self.statistics = SceneStatistics::default();
    }
}

/// Puts all pieces of an object elsewhere. `passes`: how many times queries have looked at the pairs.
fn place(object: &mut Object, pose: &Pose, proxies: &mut Proxies, passes: u64) {
    object.pose = *pose;
    for proxy in object.proxies() {
        proxies.place(proxy, pose, passes);
    }
}

/// Whether a near pair is tested, the earlier created object first.
fn testing(objects: &ObjectTable, activation: &Activation, labels: [&Label; 2]) -> Testing {
    match labels.map(|label| objects.get(label.object)) {
        [Ok(object1), Ok(object2)] if activation.is_active(object1, object2) => Testing::Active,
        _ => Testing::Inactive,
    }
}
