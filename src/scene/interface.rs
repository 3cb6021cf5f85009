//! The changes and questions that a scene accepts: each method makes one of them.

use std::borrow::Cow;
use std::io::Write;
use std::path::Path;
use std::sync::Arc;

use crate::base::error::{Error, Result};
use crate::base::files;
use crate::base::math::Pose;
use crate::base::workers::Workers;
use crate::compound::Compound;
use crate::ground::Ground;
#[cfg(doc)]
use crate::pair::{self, Outcome};
use crate::pair::{Query, SignedDistance};
use crate::scene::change::{Change, Themselves};
use crate::scene::door::Scene;
use crate::scene::recording::Recording;
use crate::scene::search::listener::{Listener, ListenerEvents};
use crate::scene::search::query::{PlacedBody, SceneAnswer, SceneContacts, SceneEvents, SceneQuery, Subject};
use crate::scene::search::statistics::SceneStatistics;
use crate::scene::world::object::{ObjectId, ObjectOptions};
use crate::scene::world::object_view::Object;
use crate::scene::world::testing::PairFilter;
use crate::shape::Shape;

impl Scene {
    // --- Objects -----------------------------------------------------------------------------------------------------------------

    /// Adds an object of one or several convex pieces in one local frame. All its pairs are active.
    ///
    /// # Errors
    /// [`Error::Argument`] without pieces, [`Error::Pose`] for a pose that is not accepted, [`Error::Limit`] when there are
    /// no ids left, [`Error::Memory`]. Nothing is added then.
    pub fn add_object(&mut self, pieces: Vec<Arc<Shape>>, options: &ObjectOptions) -> Result<ObjectId> {
        self.adding(Change::Object { pieces: pieces.into(), options: *options })
    }

    /// Adds a ground as an object. It is fixed, whatever the options say, but may be moved by [`Scene::set_pose`]. All of a scene
    /// sees it: a result names it as its piece 0, and the triangle as a feature that is a face. Two grounds make no pair.
    ///
    /// Queries answer a pair with it as [`ground_distance`](crate::ground::ground_distance) does, approximate ones exactly; a
    /// [`SceneQuery::detail`] adds nothing to it: [`Scene::own_ground_contacts`] gives its contacts.
    ///
    /// # Errors
    /// As [`Scene::add_object`].
    pub fn add_ground(&mut self, ground: Arc<Ground>, options: &ObjectOptions) -> Result<ObjectId> {
        self.adding(Change::Ground { ground, options: *options })
    }

    /// Adds a compound as an object: one row in all that finds pairs, however many pieces it has. Each near pair of objects with it
    /// has one answer, as of [`compound::distance`](crate::compound::distance()), and a result names the piece that it is about.
    /// With a [`SceneQuery::detail`] there is one result for each two pieces no farther apart than `max_distance`, as of pieces
    /// that are objects. Approximate queries answer it exactly. Its pieces stay where they are in it.
    ///
    /// # Errors
    /// As [`Scene::add_object`], [`Error::Pose`] also for a pose at which that of a piece is refused.
    pub fn add_compound(&mut self, compound: Arc<Compound>, options: &ObjectOptions) -> Result<ObjectId> {
        self.adding(Change::Compound { compound, options: *options })
    }

    /// Adds an object with the pieces (shared), the poses, the fixedness, the filter bits and the user data of another one. All
    /// its pairs are active, regardless of those of its original.
    ///
    /// # Errors
    /// [`Error::Handle`] for an id that is null, stale or another scene's, [`Error::Limit`] when there are no ids left,
    /// [`Error::Memory`]. Nothing is added then.
    pub fn copy_object(&mut self, id: ObjectId) -> Result<ObjectId> {
        self.adding(Change::Copy(id))
    }

    fn adding(&mut self, change: Change<Themselves>) -> Result<ObjectId> {
        self.change(change)?.ok_or_else(|| Error::Bug("an object was to be added, and none was".into()))
    }

    /// Removes an object and its pairs. Its id is stale from now on; all other ids stay as they are.
    ///
    /// # Errors
    /// [`Error::Handle`] for an id that is null, stale or another scene's.
    pub fn remove_object(&mut self, id: ObjectId) -> Result<()> {
        self.doing(Change::Remove(id))
    }

    #[inline(always)]
    fn doing(&mut self, change: Change<Themselves>) -> Result<()> {
        self.change(change).map(|_| ())
    }

    /// An object, for reading.
    ///
    /// # Errors
    /// [`Error::Handle`] for an id that is null, stale or another scene's.
    pub fn object(&self, id: ObjectId) -> Result<Object<'_>> {
        self.world.view().get(id)
    }

    /// All objects in order of creation.
    pub fn objects(&self) -> impl Iterator<Item = Object<'_>> {
        self.world.view().iter()
    }

    /// The number of objects.
    pub fn object_count(&self) -> usize {
        self.world.objects.len()
    }

    /// Fixes an object or lets it move: two fixed ones are never tested. The caches of its pairs stay.
    ///
    /// # Errors
    /// [`Error::Handle`] for an id that is null, stale or another scene's; [`Error::Argument`] for a ground that is to move.
    pub fn set_fixed(&mut self, id: ObjectId, fixed: bool) -> Result<()> {
        self.doing(Change::Fixed(id, fixed))
    }

    /// Sets the filter bits of an object ([`ObjectOptions::groups`]).
    ///
    /// # Errors
    /// [`Error::Handle`] for an id that is null, stale or another scene's.
    pub fn set_filter(&mut self, id: ObjectId, groups: u32, mask: u32) -> Result<()> {
        self.doing(Change::Groups { object: id, groups, mask })
    }

    /// Sets the number that comes back in every result of this object.
    ///
    /// # Errors
    /// [`Error::Handle`] for an id that is null, stale or another scene's.
    pub fn set_user_data(&mut self, id: ObjectId, user_data: u64) -> Result<()> {
        self.doing(Change::UserData(id, user_data))
    }

    /// Sets the caller's number of a piece, which [`Object::piece_user_data`] and the events of listeners give; 0 before. Results
    /// name the object and the piece.
    ///
    /// # Errors
    /// [`Error::Handle`] for an id that is null, stale or another scene's, [`Error::Argument`] for a piece that the object does not
    /// have, [`Error::Memory`].
    pub fn set_piece_user_data(&mut self, id: ObjectId, piece: u32, user_data: u64) -> Result<()> {
        self.doing(Change::PieceUserData { object: id, piece, user_data })
    }

    // --- Poses -------------------------------------------------------------------------------------------------------------------

    /// Moves an object, a fixed one too. For twelve numbers see [`Pose::from_row_major`], for R and T [`Pose::new`].
    ///
    /// # Errors
    /// [`Error::Handle`] for an id that is null, stale or another scene's, [`Error::Pose`] for a pose that is not accepted;
    /// the object then stays where it is.
    pub fn set_pose(&mut self, id: ObjectId, pose: &Pose) -> Result<()> {
        self.doing(Change::Pose(id, Cow::Borrowed(pose)))
    }

    /// Moves the objects of these ids, each to its pose. If an object is given twice, the later pose counts. Several threads
    /// share the work if ids are in order of creation.
    ///
    /// # Errors
    /// [`Error::Argument`] unless there is one pose for each, as [`Scene::set_pose`], and [`Error::Memory`]; all objects then stay
    /// where they are.
    pub fn set_poses(&mut self, ids: &[ObjectId], poses: &[Pose]) -> Result<()> {
        self.doing(Change::Poses(ids.into(), poses.into()))
    }

    /// Moves all objects that are not fixed, in order of creation. Several threads share the work.
    ///
    /// # Errors
    /// [`Error::Argument`] unless there is one pose for each, [`Error::Pose`] for a pose that is not accepted, [`Error::Memory`];
    /// all objects then stay where they are.
    pub fn set_all_poses(&mut self, poses: &[Pose]) -> Result<()> {
        self.doing(Change::AllPoses(poses.into()))
    }

    /// Moves one piece within its object: its place in the world is that of the object times `pose`, each of the twelve numbers
    /// rounded; the exact body is the one that these rounded numbers give. Points and features of results are in the piece's own
    /// frame.
    ///
    /// # Errors
    /// [`Error::Handle`] for an id that is null, stale or another scene's, [`Error::Argument`] for a piece that the object does not
    /// have, [`Error::Pose`] for a pose that is not accepted, alone or with the object's, [`Error::Memory`]; the piece then stays
    /// where it is.
    pub fn set_piece_pose(&mut self, id: ObjectId, piece: u32, pose: &Pose) -> Result<()> {
        self.doing(Change::PiecePose { object: id, piece, pose: *pose })
    }

    // --- Which pairs are tested --------------------------------------------------------------------------------------------------

    /// Activates or deactivates the pair of two objects, in either order, with all its pairs of pieces. No effect on two
    /// fixed objects.
    ///
    /// # Errors
    /// [`Error::Handle`] for an id that is null, stale or another scene's, [`Error::Argument`] for one object twice,
    /// [`Error::Memory`]; the pair stays as it is.
    pub fn set_pair_active(&mut self, id1: ObjectId, id2: ObjectId, active: bool) -> Result<()> {
        self.doing(Change::PairActive([id1, id2], active))
    }

    /// Activates or deactivates all pairs that an object is in.
    ///
    /// # Errors
    /// [`Error::Handle`] for an id that is null, stale or another scene's.
    pub fn set_object_active(&mut self, id: ObjectId, active: bool) -> Result<()> {
        self.doing(Change::ObjectActive(id, active))
    }

    /// Activates or deactivates all pairs.
    pub fn set_all_active(&mut self, active: bool) {
        self.surely(Change::AllActive(active));
    }

    /// Makes a change that cannot be refused.
    fn surely(&mut self, change: Change<Themselves>) {
        let done = self.change(change);
        debug_assert!(done.is_ok(), "{done:?}");
    }

    /// Whether queries test the pair of two objects when it is near, given in either order; the filter is not asked.
    ///
    /// # Errors
    /// As [`Scene::set_pair_active`].
    pub fn is_pair_active(&self, id1: ObjectId, id2: ObjectId) -> Result<bool> {
        self.world.is_pair_active([id1, id2])
    }

    /// Asks `filter` for each pair of objects whether it should be tested, once for each of its pairs of pieces when that becomes
    /// near, and in queries without a `max_distance` of many objects each time. `None`: none is asked. All pairs that are near are
    /// asked anew. The filter is called with the earlier created object first, and should always decide the same for a pair; it
    /// cannot use the scene.
    pub fn set_pair_filter(&mut self, filter: Option<PairFilter>) {
        self.surely(Change::Filter(filter));
    }

    /// Asks the filter anew about all pairs that are near.
    pub fn filter_again(&mut self) {
        self.surely(Change::FilterAgain);
    }

    /// From now on queries test these pairs of objects and no others, however near: for a program with a broad phase of its own.
    /// Any order will do, and a pair given twice is tested once. Activation, filters and fixed objects are heeded as ever; ids of
    /// objects removed later name no pair. Pairs that stay keep their caches. `None`: the scene finds the pairs again.
    ///
    /// # Errors
    /// [`Error::Handle`] for an id that is null, stale or another scene's, [`Error::Argument`] for one object twice in a pair,
    /// [`Error::Memory`]; the pairs of before stay.
    pub fn set_pairs(&mut self, pairs: Option<&[[ObjectId; 2]]>) -> Result<()> {
        self.doing(Change::Pairs(pairs.map(Into::into)))
    }

    // --- Queries -----------------------------------------------------------------------------------------------------------------

    /// Lists the intersecting pairs (touching ones are), each with its verdict alone. Pairs of curved shapes that their deviation
    /// leaves undecided are listed, too, and do not count as intersecting.
    ///
    /// # Errors
    /// [`Error::Argument`] for a `max_distance`, an error or a budget that is negative or NaN and a step budget of 0, also where
    /// the query needs none of them; [`Error::Memory`] when that for a changed list of pairs is not there: the next query tries
    /// again.
    pub fn query_intersection(&mut self, query: &SceneQuery) -> Result<SceneAnswer<'_>> {
        self.ask(&Subject::AllPairs, Query::Intersection, query)
    }

    /// Lists the pairs whose distance is at most `max_distance`, and the intersecting ones, with distance, witness
    /// points, normal and features ([`pair::distance`]).
    ///
    /// # Errors
    /// As [`Scene::query_intersection`].
    pub fn query_distance(&mut self, query: &SceneQuery) -> Result<SceneAnswer<'_>> {
        self.ask(&Subject::AllPairs, Query::Distance, query)
    }

    /// As [`Scene::query_distance`], and intersecting pairs have finite witness points and a unit normal as well
    /// ([`pair::contact`]).
    ///
    /// With a [`SceneQuery::detail`] the answers are those of [`Scene::query_distance`], and [`SceneAnswer::contacts`] reports
    /// how deep each pair is, and where its objects meet: results as of [`pair::depth()`] and `manifold::manifold`.
    ///
    /// # Errors
    /// As [`Scene::query_intersection`], for a `detail` as well; and [`Error::Memory`] when that for depths and points is not
    /// there.
    pub fn query_contact(&mut self, query: &SceneQuery) -> Result<SceneAnswer<'_>> {
        self.ask(&Subject::AllPairs, Query::Contact, query)
    }

    /// As [`Scene::query_distance`], each distance as narrow as the query asks for and no narrower
    /// ([`pair::approximate`]). A pair whose step budget ran out before the verdict ([`Outcome::Undecided`]) is listed and does
    /// not count as intersecting.
    ///
    /// # Errors
    /// As [`Scene::query_intersection`].
    pub fn query_approximate(&mut self, query: &SceneQuery) -> Result<SceneAnswer<'_>> {
        self.ask(&Subject::AllPairs, Query::Approximate, query)
    }

    /// As the query of this kind, for the pairs of one object alone: what it touches or comes near. An error budget is not
    /// heeded.
    ///
    /// # Errors
    /// [`Error::Handle`](crate::base::error::Error::Handle) for an id that is null, stale or another scene's, and as
    /// [`Scene::query_intersection`].
    pub fn query_object(&mut self, id: ObjectId, kind: Query, query: &SceneQuery) -> Result<SceneAnswer<'_>> {
        self.world.objects.get(id)?;
        self.ask(&Subject::Object(id), kind, query)
    }

    /// As [`Scene::query_object`], for a shape that is in no scene, put at `pose` for this question: each object of the scene is
    /// object 1, object 2 has the null id. All objects are asked, regardless of activation and filters.
    ///
    /// # Errors
    /// [`Error::Pose`](crate::base::error::Error::Pose) for a pose that is not accepted, and as [`Scene::query_intersection`].
    pub fn query_placed(
        &mut self,
        shape: &Arc<Shape>,
        pose: &Pose,
        kind: Query,
        query: &SceneQuery,
    ) -> Result<SceneAnswer<'_>> {
        let pieces = [(shape.clone(), *pose)];
        self.ask(&Subject::Placed(PlacedBody { pieces: pieces[..].into(), mask: None }), kind, query)
    }

    /// As [`Scene::query_placed`], for a body of several convex pieces, each with its pose in the world: `piece2` of a result
    /// tells which. Objects are asked whose groups ([`ObjectOptions::groups`]) have a bit of `mask`, regardless of their own
    /// masks, activation and filters.
    ///
    /// # Errors
    /// [`Error::Argument`] without pieces, and as [`Scene::query_placed`].
    pub fn query_placed_pieces(
        &mut self,
        pieces: &[(Arc<Shape>, Pose)],
        mask: u32,
        kind: Query,
        query: &SceneQuery,
    ) -> Result<SceneAnswer<'_>> {
        self.ask(&Subject::Placed(PlacedBody { pieces: pieces.into(), mask: Some(mask) }), kind, query)
    }

    /// Which pairs of objects began or ended touching (`distance` 0), or being within a distance, since the last call; the first
    /// call lists all that are. Objects are near if any of their pieces are. It is a query like others, and [`SceneAnswer::pairs`]
    /// of those before it end.
    ///
    /// [`SceneAnswer::pairs`]: crate::scene::SceneAnswer::pairs
    ///
    /// # Errors
    /// As [`Scene::query_intersection`], for a distance that is negative or NaN; the near pairs stay remembered.
    pub fn query_events(&mut self, distance: f64) -> Result<SceneEvents<'_>> {
        let query = SceneQuery { max_distance: distance, ..SceneQuery::default() };
        let kind = if distance == 0.0 { Query::Intersection } else { Query::Distance };
        self.ask(&Subject::Events, kind, &query)?;
        self.search.compare(&self.world.objects)
    }

    /// As the query of this kind, and which of the pairs and contact points that it lists were not listed when the listener last
    /// asked, which were, and which are no more. Every listener has its own memory: queries of others change nothing of that. A
    /// recording notes the query.
    ///
    /// # Errors
    /// As [`Scene::query_intersection`]; [`Error::Argument`] if the query is to stop early, [`Error::Memory`]. The listener still
    /// remembers the listing of its last query.
    pub fn listen<'a>(
        &'a mut self,
        listener: &'a mut Listener,
        kind: Query,
        query: &SceneQuery,
    ) -> Result<(SceneAnswer<'a>, ListenerEvents<'a>)> {
        Listener::check(query)?;
        self.ask(&Subject::AllPairs, kind, query)?;
        let answer = self.search.answer();
        listener.hear(&answer, &self.world)?;
        Ok((answer, listener.events()))
    }

    /// The last query's details beside its answers: [`SceneAnswer::contacts`].
    pub fn contacts(&self) -> SceneContacts<'_> {
        self.search.answer().contacts
    }

    /// How far one of the pairs of the last query of contacts is apart, or how deep: [`SceneAnswer::signed_distance`].
    ///
    /// # Errors
    /// As of that.
    pub fn signed_distance(&self, number: usize) -> Result<SignedDistance> {
        self.search.answer().signed_distance(number)
    }

    /// The statistics of the queries.
    pub fn statistics(&self) -> &SceneStatistics {
        &self.search.statistics
    }

    /// Sets all statistics to zero.
    pub fn reset_statistics(&mut self) {
        self.search.statistics = SceneStatistics::default();
    }

    // --- Work and memory ---------------------------------------------------------------------------------------------------------

    /// Lets several threads work on a query and on poses that are set together, or one again. It changes no bit of any answer.
    /// Queries that stop early, those without a `max_distance` over many objects, and few pairs or objects are left to the caller's
    /// thread.
    pub fn set_workers(&mut self, workers: Option<Workers>) {
        self.workers = workers.unwrap_or_else(Workers::none);
    }

    /// Queries without a `max_distance` are about all pairs of pieces. While these are no more than `limit`, each keeps its last
    /// answer, which makes the next one several times faster and takes about 150 bytes, if there is memory for that. Above
    /// `limit`, only near pairs keep their caches. Results and their order are the same. Default: 2²⁰ pairs, about 150 MB, which
    /// 1,448 single pieces make.
    pub fn set_kept_pair_limit(&mut self, limit: u64) {
        self.surely(Change::KeptPairLimit(limit));
    }

    /// Gives back the memory that is kept for later: that of the results, and room for pairs that are no more. The caches of the
    /// others stay.
    ///
    /// # Errors
    /// [`Error::Memory`] if there is none to bring the near pairs up to date; no result is lost then.
    pub fn shrink(&mut self) -> Result<()> {
        self.doing(Change::Shrink)
    }

    /// Pairs whose depth is remembered: how many there is room for, and how many there are.
    #[doc(hidden)]
    pub fn remembered_depths(&self) -> [usize; 2] {
        self.near.list.contacts.depth_counts()
    }

    // --- Recordings --------------------------------------------------------------------------------------------------------------

    /// Writes down what is done to the scene from now on, in a file, replacing what was there, until [`Scene::end_recording`] or
    /// the scene's end. First comes the content of the scene. A [`Replay`](crate::scene::Replay) does it all again.
    ///
    /// All that changes what queries answer is written down, and each query with a digest of its answer; [workers](Workers) and
    /// statistics are not. For a [pair filter](PairFilter), its decisions are written down. Shapes are written down once each.
    /// The file is brought up to date before each query. If it cannot be written, the recording ends; the scene goes on, and
    /// [`Scene::end_recording`] reports why.
    ///
    /// Caches of pairs from before are not written down. So the answers of a replay are bit for bit those of the scene only if it
    /// was recorded from its beginning, before its first object.
    ///
    /// [Workers]: crate::scene::Workers
    /// [PairFilter]: crate::scene::PairFilter
    ///
    /// # Errors
    /// [`Error::File`] if the file cannot be written or is no regular file, [`Error::Memory`]; the errors that
    /// [`Scene::end_recording`] reports for a recording that is going on, which ends. The scene is not recorded then.
    pub fn record(&mut self, path: &Path) -> Result<()> {
        self.end_recording()?;
        let file = files::create(path)?;
        self.begin_recording(Box::new(file), path.display().to_string())
    }

    /// As [`Scene::record`], to any sink of bytes.
    ///
    /// # Errors
    /// As [`Scene::record`].
    pub fn record_to(&mut self, sink: impl Write + Send + Sync + 'static) -> Result<()> {
        self.end_recording()?;
        self.begin_recording(Box::new(sink), "the recording".into())
    }

    fn begin_recording(&mut self, sink: Box<dyn Write + Send + Sync>, name: String) -> Result<()> {
        let decided = if self.world.filter.is_some() { self.near.decisions(&self.world)? } else { Vec::new() };
        self.recording = Recording::begin(sink, name, &self.world, &decided)?;
        Ok(())
    }

    /// Ends the recording, if there is one.
    ///
    /// # Errors
    /// [`Error::File`], [`Error::Memory`], [`Error::Limit`] for the reason why it ended before or cannot be written to its end:
    /// what was done up to there can be replayed.
    pub fn end_recording(&mut self) -> Result<()> {
        self.recording.end()
    }

    /// Whether what is done to the scene is written down: a recording was begun, and nothing has ended it.
    pub fn is_recording(&self) -> bool {
        self.recording.is_on()
    }

    /// Why the recording ended early.
    pub(crate) fn recording_failure(&self) -> Option<&Error> {
        self.recording.failure()
    }
}
