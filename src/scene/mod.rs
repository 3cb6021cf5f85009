//! A scene: objects with poses, the pairs of them that are tested, and queries over all these pairs.
//!
//! Queries list their results by object 1, object 2, piece 1, piece 2, objects in order of creation; object 1 is always
//! the earlier created of the two. What a query answers depends on the objects, their poses and the activation alone:
//! not on earlier queries, on other objects or on how the objects came to where they are. (Where nearest points are not
//! unique, any of them may be given, and of an approximate distance any interval that is narrow enough, or as the step budget
//! leaves it.)

pub mod object;
mod activation;

use std::sync::Arc;

use crate::base::error::{Error, Result, check_range};
use crate::base::math::{Pose, ROTATION_LIMIT};
use crate::base::memory::{copied, reserve, with_capacity};
use crate::base::simd::environment::with_default;
use crate::pair::{self, DecidedBy, Levels, Outcome, PairAnswer, PairCache, PairConfig, Refinement, Start};
use crate::scene::activation::Activation;
use crate::scene::object::{Object, ObjectId, ObjectOptions, ObjectTable};
use crate::shape::Shape;

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

/// What a query over a scene is asked for.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SceneQuery {
    /// Stop at the first intersecting pair in the order of results, and then list no pairs at all: [`SceneAnswer::found`] is it.
    pub early_exit: bool,
    /// List pairs whose true distance is at most this, intersecting ones always, and those that a step budget leaves open; from 0
    /// to +∞ (the default: all pairs). [`Scene::query_intersection`] does without it, but refuses one out of range.
    pub distance_tolerance: f64,
    /// [`Scene::query_approximate_distance`]: `upper − lower` of a pair may be as large as this …
    pub absolute_error: f64,
    /// … or as this times `lower`. Both 0 (the default): as narrow as exact answers.
    pub relative_error: f64,
    /// [`Scene::query_approximate_distance`]: finite, it is what `upper − lower` of all tested pairs together may come to, in
    /// equal shares, whatever the two errors say; a pair whose share is less than that is answered as narrowly as by exact queries.
    /// Default: +∞.
    pub error_budget: f64,
    /// [`Scene::query_approximate_distance`]: as [`PairConfig::step_budget`], of each pair.
    pub step_budget: u32,
    /// Which levels of detail queries go through.
    pub levels: Levels,
    /// How they go from level to level.
    pub refinement: Refinement,
    /// Where marching starts in each pair.
    pub start: Start,
}

impl Default for SceneQuery {
    fn default() -> Self {
        SceneQuery {
            early_exit: false,
            distance_tolerance: f64::INFINITY,
            absolute_error: 0.0,
            relative_error: 0.0,
            error_budget: f64::INFINITY,
            step_budget: u32::MAX,
            levels: Levels::Automatic,
            refinement: Refinement::Adaptive,
            start: Start::Automatic,
        }
    }
}

/// One pair of convex pieces in a query's list.
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

/// What a query over a scene found.
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
}

/// What the queries of a scene did since it was made or [`Scene::reset_statistics`] was called.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
#[repr(C)]
pub struct SceneStatistics {
    /// Queries.
    pub queries: u64,
    /// Pairs of convex pieces tested.
    pub pairs: u64,
    /// … of which Voronoi marching decided.
    pub marched: u64,
    /// … of which the vertex pairs or the separating axis of the query before decided.
    pub coherent: u64,
    /// … of which Gilbert-Johnson-Keerthi in floating point decided.
    pub fallback: u64,
    /// … of which integer arithmetic decided.
    pub exact: u64,
    /// Feature pairs visited by Voronoi marching.
    pub marching_steps: u64,
    /// Iterations of Gilbert-Johnson-Keerthi in floating point.
    pub fallback_iterations: u64,
    /// Iterations in integer arithmetic.
    pub exact_iterations: u64,
    /// Of the pairs, those that an approximate query stopped at because their interval was narrow enough.
    pub within_tolerance: u64,
    /// … of which the step budget ran out.
    pub budget_spent: u64,
    /// Of the pairs, how many were answered by which level of detail: the coarser one of the two objects', 0 for the objects
    /// themselves; the last entry is for all levels beyond, too.
    pub by_level: [u64; 8],
    /// Sum of `upper − lower` over the pairs that queries about distances answered as [`Outcome::Separated`] or left
    /// [`Outcome::Undecided`]. Queries of intersection add nothing: their intervals are wide and only prove the verdict.
    pub error_spent: f64,
    /// Of the pairs, those whose bounding spheres decided.
    pub bounding_spheres: u64,
}

impl SceneStatistics {
    fn count(&mut self, answer: &PairAnswer) {
        self.pairs += 1;
        *match answer.decided_by {
            DecidedBy::None => return,
            DecidedBy::Marching => &mut self.marched,
            DecidedBy::Coherence => &mut self.coherent,
            DecidedBy::Fallback => &mut self.fallback,
            DecidedBy::Integers => &mut self.exact,
            DecidedBy::Tolerance => &mut self.within_tolerance,
            DecidedBy::Budget => &mut self.budget_spent,
            DecidedBy::BoundingSpheres => &mut self.bounding_spheres,
        } += 1;
        self.marching_steps += u64::from(answer.statistics.marching_steps);
        self.fallback_iterations += u64::from(answer.statistics.fallback_iterations);
        self.exact_iterations += u64::from(answer.statistics.exact_iterations);
        let [level1, level2] = answer.statistics.levels.map(usize::from);
        self.by_level[level1.max(level2).min(self.by_level.len() - 1)] += 1;
    }
}

/// A pair of convex pieces that queries test, with what it remembers from query to query.
#[derive(Debug)]
struct TestedPair {
    objects: [ObjectId; 2],
    pieces: [u32; 2],
    cache: PairCache,
}

/// One of the pair queries of [`pair`].
type Solver = fn(&Shape, &Pose, &Shape, &Pose, &mut PairCache, &PairConfig, &mut PairAnswer) -> Result<()>;

/// Objects, poses and the pairs that are tested.
///
/// A new pair is active, a pair of two fixed objects never exists. What is said of a pair, an object or all holds for
/// the pairs there are until something later is said that covers them; objects added later begin with all their pairs
/// active. Deactivated pairs are not tested and remember nothing.
#[derive(Debug)]
pub struct Scene {
    objects: ObjectTable,
    activation: Activation,
    rotation_limit: f64,
    /// What queries test, in the order of results; out of date while `pairs_changed`.
    pairs: Vec<TestedPair>,
    pairs_changed: bool,
    results: Vec<PairResult>,
    statistics: SceneStatistics,
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
            activation: Activation::default(),
            rotation_limit,
            pairs: Vec::new(),
            pairs_changed: false,
            results: Vec::new(),
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
        let id = self.objects.insert(pieces, options)?;
        self.activation.set_object(self.objects.get_mut(id)?, true);
        self.pairs_changed = true;
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
        self.objects.remove(id)?;
        self.pairs_changed = true;
        Ok(())
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
        self.objects.get_mut(id)?.user_data = user_data;
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
        with_default(|| pose.check(self.rotation_limit))?;
        object.pose = *pose;
        Ok(())
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
        self.objects.for_each_mut(|object| {
            if !object.fixed
                && let Some(pose) = poses.next()
            {
                object.pose = *pose;
            }
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
        self.activation.set_pair(pair, active, |id| objects.get(id).is_ok())?;
        self.pairs_changed = true;
        Ok(())
    }

    /// Activates or deactivates all pairs that an object is in.
    ///
    /// # Errors
    /// [`Error::Handle`] for an id that is null, stale or another scene's.
    pub fn set_object_active(&mut self, id: ObjectId, active: bool) -> Result<()> {
        self.activation.set_object(self.objects.get_mut(id)?, active);
        self.pairs_changed = true;
        Ok(())
    }

    /// Activates or deactivates all pairs.
    pub fn set_all_active(&mut self, active: bool) {
        self.activation.set_all(active);
        self.pairs_changed = true;
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
        match object1.serial().cmp(&object2.serial()) {
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

    // --- Pairs ---

    /// The pairs of objects that queries test, in the order of results.
    fn tested_objects(&self) -> impl Iterator<Item = (&Object, &Object)> {
        let mut later = self.objects.iter();
        std::iter::from_fn(move || {
            let object1 = later.next()?;
            Some(later.clone().map(move |object2| (object1, object2)))
        })
        .flatten()
        .filter(|&(object1, object2)| self.tests(object1, object2))
    }

    /// Gives back the memory that is kept for later: that of the results, and that of pairs that are no more. What the others
    /// remember stays.
    ///
    /// # Errors
    /// [`Error::Memory`] if there is none for a smaller list of pairs; nothing has changed then.
    pub fn shrink(&mut self) -> Result<()> {
        self.update_pairs()?;
        self.results = Vec::new();
        Ok(())
    }

    /// Brings `pairs` up to date. Pairs that stay keep what they remember.
    fn update_pairs(&mut self) -> Result<()> {
        if !self.pairs_changed {
            return Ok(());
        }
        let count = self.tested_objects().map(|(o1, o2)| o1.pieces.len() * o2.pieces.len()).sum();
        let mut pairs: Vec<TestedPair> = with_capacity(count)?;
        // Both lists are in order of creation: the old place of a pair is found by walking along.
        let mut old = self.pairs.iter().filter_map(|pair| Some((self.order_key(pair)?, pair.cache))).peekable();
        for (object1, object2) in self.tested_objects() {
            for piece1 in 0..object1.pieces.len() as u32 {
                for piece2 in 0..object2.pieces.len() as u32 {
                    let key = (object1.serial(), object2.serial(), piece1, piece2);
                    while old.next_if(|&(old_key, _)| old_key < key).is_some() {}
                    let cache = old.next_if(|&(old_key, _)| old_key == key).map(|(_, cache)| cache);
                    pairs.push(TestedPair {
                        objects: [object1.id(), object2.id()],
                        pieces: [piece1, piece2],
                        cache: cache.unwrap_or_default(),
                    });
                }
            }
        }
        self.pairs = pairs;
        self.pairs_changed = false;
        Ok(())
    }

    /// Where a pair stands in the order of results; none when one of its objects was removed.
    fn order_key(&self, pair: &TestedPair) -> Option<(u64, u64, u32, u32)> {
        let serial = |id| self.objects.get(id).ok().map(Object::serial);
        Some((serial(pair.objects[0])?, serial(pair.objects[1])?, pair.pieces[0], pair.pieces[1]))
    }

    // --- Queries ---

    /// Lists the intersecting pairs (touching ones are), each with its verdict alone.
    ///
    /// # Errors
    /// [`Error::Argument`] for a tolerance, an error or a budget that is negative or NaN and a step budget of 0, also where the
    /// query does without them; [`Error::Memory`] when that for a changed list of pairs is not there: the next query tries again.
    pub fn query_intersection(&mut self, query: &SceneQuery) -> Result<SceneAnswer<'_>> {
        self.run(query, None, pair::intersection)
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
        self.run(query, Some(query.distance_tolerance), pair::distance)
    }

    /// As [`Scene::query_exact_distance`], and intersecting pairs have finite witness points and a unit normal as well
    /// ([`pair::contact`]).
    ///
    /// # Errors
    /// As [`Scene::query_intersection`].
    pub fn query_contacts(&mut self, query: &SceneQuery) -> Result<SceneAnswer<'_>> {
        self.run(query, Some(query.distance_tolerance), pair::contact)
    }

    /// As [`Scene::query_exact_distance`], each distance as narrow as the query asks for and no narrower
    /// ([`pair::approximate`]). A pair whose step budget ran out before the verdict ([`Outcome::Undecided`]) is listed and does
    /// not count as intersecting.
    ///
    /// # Errors
    /// As [`Scene::query_intersection`].
    pub fn query_approximate_distance(&mut self, query: &SceneQuery) -> Result<SceneAnswer<'_>> {
        self.run(query, Some(query.distance_tolerance), pair::approximate)
    }

    /// What the queries did.
    pub fn statistics(&self) -> &SceneStatistics {
        &self.statistics
    }

    /// Sets all statistics to zero.
    pub fn reset_statistics(&mut self) {
        self.statistics = SceneStatistics::default();
    }

    /// Solves every tested pair and lists those within `tolerance`; without one only the verdict is asked for, and intersecting
    /// pairs are listed.
    fn run(&mut self, query: &SceneQuery, tolerance: Option<f64>, solver: Solver) -> Result<SceneAnswer<'_>> {
        with_default(|| self.solve_all(query, tolerance, solver))
    }

    fn solve_all(&mut self, query: &SceneQuery, tolerance: Option<f64>, solver: Solver) -> Result<SceneAnswer<'_>> {
        check_range("distance_tolerance", query.distance_tolerance, 0.0..=f64::INFINITY)?;
        pair::check_accuracy(query.absolute_error, query.relative_error, query.step_budget)?;
        check_range("error_budget", query.error_budget, 0.0..=f64::INFINITY)?;
        self.update_pairs()?;
        self.results.clear();
        // From here on a query needs no memory.
        reserve(&mut self.results, self.pairs.len())?;
        self.statistics.queries += 1;
        let share = query.error_budget / self.pairs.len() as f64;
        let [absolute_error, relative_error] =
            if share < f64::INFINITY { [share, 0.0] } else { [query.absolute_error, query.relative_error] };
        let config = PairConfig {
            distance_tolerance: tolerance.unwrap_or(f64::INFINITY),
            absolute_error,
            relative_error,
            step_budget: query.step_budget,
            levels: query.levels,
            refinement: query.refinement,
            start: query.start,
            ..PairConfig::default()
        };
        let mut intersecting = false;
        for pair in &mut self.pairs {
            let (object1, object2) = (self.objects.get(pair.objects[0])?, self.objects.get(pair.objects[1])?);
            let [piece1, piece2] = pair.pieces;
            let shape1 = &object1.pieces[piece1 as usize];
            let shape2 = &object2.pieces[piece2 as usize];
            let mut answer = PairAnswer::default();
            // Nothing is left to refuse: shapes are sound once made, poses and tolerances have been checked.
            solver(shape1, &object1.pose, shape2, &object2.pose, &mut pair.cache, &config, &mut answer)?;
            self.statistics.count(&answer);
            let is_listed = match answer.outcome {
                Outcome::Intersecting => true,
                Outcome::Separated | Outcome::Undecided => tolerance.is_some(),
                Outcome::Beyond | Outcome::None => false,
            };
            if is_listed {
                self.statistics.error_spent += answer.upper - answer.lower;
                self.results.push(PairResult {
                    object1: object1.id(),
                    object2: object2.id(),
                    user_data1: object1.user_data,
                    user_data2: object2.user_data,
                    piece1,
                    piece2,
                    answer,
                });
            }
            if answer.outcome == Outcome::Intersecting {
                intersecting = true;
                if query.early_exit {
                    return Ok(SceneAnswer { intersecting, pairs: &[], found: self.results.last() });
                }
            }
        }
        Ok(SceneAnswer { intersecting, pairs: &self.results, found: None })
    }
}
