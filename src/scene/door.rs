//! The one door of a scene: every change or question comes through here, is done once, and is written down if it is recorded.

use std::sync::Arc;

use crate::base::error::{Error, Result};
use crate::base::simd::environment::with_default;
use crate::base::workers::Workers;
use crate::pair::Query;
use crate::scene::change::{Change, Themselves};
use crate::scene::near::broad_phase::{BroadPhase, News};
use crate::scene::recording::Recording;
use crate::scene::search::ask::{Search, Searched};
use crate::scene::search::query::{SceneAnswer, SceneQuery, Subject};
use crate::scene::world::content::World;
use crate::scene::world::object::ObjectId;
use crate::shape::Shape;

/// Objects, poses and the pairs that are tested.
///
/// A new pair is active, a pair of two fixed objects never exists. A setting for a pair, an object or all holds for the pairs
/// there are until a later setting covers them; objects added later begin with all their pairs active. Deactivated pairs are not
/// tested, and keep their caches while they are near.
#[derive(Debug)]
pub struct Scene {
    pub(super) world: World,
    pub(super) near: BroadPhase,
    pub(super) search: Search,
    pub(super) recording: Recording,
    /// The workers that share the work on poses and queries.
    pub(super) workers: Workers,
}

impl Scene {
    /// An empty scene.
    #[allow(clippy::new_without_default, reason = "`Default` would be a second way to say it")]
    pub fn new() -> Scene {
        Scene {
            world: World::new(),
            near: BroadPhase::default(),
            search: Search::default(),
            recording: Recording::Off,
            workers: Workers::none(),
        }
    }

    /// Does something to the scene, and writes it down if it was done; gives the object that it adds.
    ///
    /// # Errors
    /// As the method of the same name; nothing has changed then.
    #[inline(always)]
    pub(super) fn change(&mut self, change: Change<Themselves>) -> Result<Option<ObjectId>> {
        if self.recording.is_on() { self.apply_and_note(change) } else { self.apply(change) }
    }

    /// Out of the way of changes that are not written down: those stay where they are made.
    #[inline(never)]
    fn apply_and_note(&mut self, change: Change<Themselves>) -> Result<Option<ObjectId>> {
        // An object that the change removes has its number until then.
        let note = self.recording.prepare(&change, &self.world.objects);
        let added = self.apply(change)?;
        self.recording.note(note);
        Ok(added)
    }

    #[inline(always)]
    fn apply(&mut self, change: Change<Themselves>) -> Result<Option<ObjectId>> {
        let Scene { world, near, search, workers, .. } = self;
        match change {
            Change::Object { pieces, options } => {
                near.reserve(pieces.len())?;
                let added = world.add(&pieces, &options)?;
                near.grow(world.proxies.len());
                return Ok(Some(added));
            }
            Change::Ground { ground, options } => {
                near.reserve(1)?;
                let added = world.add_ground(&ground, &options)?;
                near.grow(world.proxies.len());
                return Ok(Some(added));
            }
            Change::Compound { compound, options } => {
                near.reserve(1)?;
                let added = world.add_compound(&compound, &options)?;
                near.grow(world.proxies.len());
                return Ok(Some(added));
            }
            Change::Copy(original) => {
                near.reserve(world.rows_of(original).len())?;
                let added = world.copy(original)?;
                near.grow(world.proxies.len());
                return Ok(Some(added));
            }
            Change::Remove(id) => {
                let object = world.view().get(id)?;
                near.take_out(object.proxies(), object.fixed());
                world.remove(id)?;
            }
            Change::Fixed(id, fixed) => {
                let object = world.view().get(id)?;
                if object.ground().is_some() && !fixed {
                    let is_ground = format!("object {id} is a ground, and grounds are fixed");
                    return Err(Error::Argument(format!("{is_ground}: leave it so, its pose may be set all the same")));
                }
                if object.fixed() != fixed {
                    near.take_out(object.proxies(), object.fixed());
                    world.set_fixed(id, fixed)?;
                }
            }
            Change::Groups { object, groups, mask } => world.set_groups(object, groups, mask)?,
            Change::UserData(id, user_data) => {
                world.set_user_data(id, user_data)?;
                // No result with the old number is given again.
                search.forget();
            }
            Change::PieceUserData { object, piece, user_data } => {
                world.set_piece_user_data(object, piece, user_data)?;
            }
            Change::Pose(id, pose) => world.set_pose(id, &pose)?,
            Change::Poses(ids, poses) => world.set_poses(&ids, &poses, workers)?,
            Change::AllPoses(poses) => world.set_all_poses(&poses, workers)?,
            Change::PiecePose { object, piece, pose } => world.set_piece_pose(object, piece, &pose)?,
            Change::PairActive(pair, active) => {
                let pair = world.set_pair_active(pair, active)?;
                near.set_active(world, pair, active);
            }
            Change::ObjectActive(id, active) => {
                world.activation.set_object(&mut world.objects.get_mut(id)?.activation, active);
                near.hear(News::Activation);
            }
            Change::AllActive(active) => {
                world.activation.set_all(active);
                near.hear(News::Activation);
            }
            Change::Filter(filter) => {
                world.filter = filter;
                near.hear(News::Filter);
            }
            Change::FilterAgain => near.hear(News::Filter),
            Change::Pairs(pairs) => {
                world.set_given(pairs.as_deref())?;
                near.begin_anew();
            }
            Change::KeptPairLimit(limit) => world.kept_pair_limit = limit,
            Change::Shrink => self.shrink_all()?,
        }
        Ok(None)
    }

    fn shrink_all(&mut self) -> Result<()> {
        let Scene { world, near, search, recording, workers } = self;
        let tolerance = near.tolerance();
        world.watch_filter(recording.is_on());
        let updated = near.update(world, if world.keeps_list(tolerance) { tolerance } else { 0.0 }, workers);
        recording.decisions(world.decided(), &world.objects);
        updated?;
        near.shrink()?;
        search.shrink();
        Ok(())
    }

    /// Answers a question, and writes both down.
    ///
    /// # Errors
    /// See [`Scene::query_intersection`]; nothing is listed then, and nothing is counted.
    #[inline(always)]
    pub(super) fn ask(
        &mut self,
        subject: &Subject<ObjectId, Arc<Shape>>,
        kind: Query,
        query: &SceneQuery,
    ) -> Result<SceneAnswer<'_>> {
        if self.recording.is_on() {
            return self.ask_and_note(subject, kind, query);
        }
        let Scene { world, near, search, workers, .. } = self;
        search.ask(&mut Searched { world, near, workers }, subject, kind, query)?;
        Ok(search.answer())
    }

    #[inline(never)]
    fn ask_and_note(
        &mut self,
        subject: &Subject<ObjectId, Arc<Shape>>,
        kind: Query,
        query: &SceneQuery,
    ) -> Result<SceneAnswer<'_>> {
        let Scene { world, near, search, recording, workers } = self;
        recording.question(subject, kind, query, &world.objects);
        world.watch_filter(recording.is_on());
        let asked = search.ask(&mut Searched { world, near, workers }, subject, kind, query);
        let answer = asked.map(|()| search.answer());
        recording.decisions(world.decided(), &world.objects);
        with_default(|| recording.answer(answer.as_ref().ok(), query, world));
        answer
    }
}
