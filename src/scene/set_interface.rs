//! The questions that several threads can ask a scene at once: each takes the scene by a shared reference, and changes nothing in
//! it.

use crate::base::error::{Error, Result};
use crate::base::math::Pose;
use crate::base::simd::environment::with_default;
use crate::ground::PlacedGround;
use crate::manifold::ManifoldConfig;
use crate::motion::{CastConfig, Motion};
use crate::pair::{self, HalfSpace, PairAnswer, PairConfig, PairQuestion, Query};
use crate::ray::Ray;
use crate::scene::door::Scene;
use crate::scene::sets::casts::{self, SceneCastAnswer};
use crate::scene::sets::first_hit::{self, FirstHit, PoseOrder};
use crate::scene::sets::grounds::{self, Floor, GroupFilter, SceneGroundContacts};
use crate::scene::sets::members::{self, Boxes, ObjectSet};
use crate::scene::sets::nearest::{self, Against, LeastDistance};
use crate::scene::sets::others::Others;
use crate::scene::sets::rays::{self, RayHits, SceneRayHit};
use crate::scene::sets::scratch::SetScratch;

/// The set that leaves nobody out.
const NOBODY: ObjectSet = ObjectSet { ids: &[], poses: None, among: false };

impl Scene {
    /// Makes questions about sets fast after objects were moved, added or removed: they find what is near by the trees of the broad
    /// phase, which this brings up to date. It changes no answer. Without it they go through what has changed one by one, and
    /// through all pieces if many have.
    ///
    /// # Errors
    /// [`Error::Memory`](crate::base::error::Error::Memory); questions then take longer.
    pub fn prepare(&mut self) -> Result<()> {
        let Scene { world, near, recording, workers, .. } = self;
        world.watch_filter(recording.is_on());
        let fitted = with_default(|| near.fit_trees(world, workers));
        recording.decisions(world.decided(), &world.objects);
        fitted
    }

    /// The least distance between two sets of objects, or between a set and all other objects (`against` is `None`), with its
    /// interval and a pair that has it; for sets farther apart than `max_distance` no more than that is reported.
    ///
    /// Pairs are those that queries test: activation, groups and the filter are heeded. Two fixed objects are left out, unless
    /// the question gives the poses of those of a set. Pairs of two objects of the first set are asked about if it requests that.
    ///
    /// # Errors
    /// [`Error::Handle`](crate::base::error::Error::Handle) for an id that is null, stale or another scene's;
    /// [`Error::Argument`](crate::base::error::Error::Argument) unless a set with poses has one for each object, and for a cut-off
    /// that is negative or NaN; [`Error::Pose`](crate::base::error::Error::Pose) for a pose that is not accepted,
    /// [`Error::Memory`](crate::base::error::Error::Memory).
    pub fn least_distance(
        &self,
        set: &ObjectSet,
        against: Option<&ObjectSet>,
        max_distance: f64,
        scratch: &mut SetScratch,
    ) -> Result<LeastDistance> {
        with_default(|| {
            let SetScratch { members, second, candidates, caches, .. } = scratch;
            members::list(&self.world, set, Boxes::Made, members)?;
            if let Some(against) = against {
                members::list(&self.world, against, Boxes::LeftOut, second)?;
            }
            let question = nearest::NearestQuestion {
                world: &self.world,
                members,
                against: against.map_or(Against::Others(self.others(set)), |_| Against::Set(second)),
                among: set.among,
                moved: set.poses.is_some() || against.is_some_and(|against| against.poses.is_some()),
                max_distance,
            };
            nearest::least_distance(question, candidates, caches)
        })
    }

    /// At which of many times a set of objects is no farther from something than `max_distance`: all other objects, and if the set
    /// says so one another. `poses` are those of all objects at the first time, then at the second, and so on; those of the set are
    /// not looked at, nor are poses of times that are not tried. Pairs are those that queries test; both may be fixed.
    ///
    /// # Errors
    /// As [`Scene::least_distance`], and [`Error::Argument`](crate::base::error::Error::Argument) for poses that do not come out
    /// even and a `max_distance` that is negative, infinite or NaN.
    pub fn first_hit(
        &self,
        set: &ObjectSet,
        poses: &[Pose],
        order: PoseOrder,
        max_distance: f64,
        scratch: &mut SetScratch,
    ) -> Result<FirstHit> {
        with_default(|| {
            let SetScratch { members, open, found, caches, .. } = scratch;
            let question = first_hit::FirstHitQuestion { others: self.others(set), poses, order, max_distance };
            first_hit::first_hit(question, &mut first_hit::FirstHitRoom { members, open, found, caches })
        })
    }

    /// The pieces that a ray meets, of objects whose groups have a bit of `mask`: the first piece, all in order, or any. Places
    /// are intervals that hold, same as for [`cast_ray`](crate::ray::cast_ray). Pieces that are met at one place, as far as
    /// doubles tell, are in order of creation.
    ///
    /// # Errors
    /// As [`cast_ray`](crate::ray::cast_ray), and [`Error::Memory`](crate::base::error::Error::Memory).
    pub fn cast_ray<'a>(
        &self,
        ray: &Ray,
        wanted: RayHits,
        mask: u32,
        scratch: &'a mut SetScratch,
    ) -> Result<&'a [SceneRayHit]> {
        with_default(|| {
            let SetScratch { open, found, nearing, hits, .. } = scratch;
            let question = rays::RayQuestion { others: self.others(&NOBODY), ray, hits: wanted, mask };
            rays::cast(question, &mut rays::RayRoom { open, found, nearing, hits })?;
            Ok(&hits[..])
        })
    }

    /// Whether moving objects stay farther than `config.max_distance` from all others, which rest, or when they first do not:
    /// certain, same as for [`motion::cast`](crate::motion::cast()). One motion moves all objects of the set as one body, else each
    /// has its own; pieces with poses of their own move with their object. Pairs of two of them are asked about if the set requests
    /// that; its poses are not looked at. Pairs are those that queries test; both may be fixed. `config.step_budget` is that of
    /// each pair.
    ///
    /// # Errors
    /// [`Error::Handle`](crate::base::error::Error::Handle) for an id that is null, stale or another scene's;
    /// [`Error::Argument`](crate::base::error::Error::Argument) unless there is one motion or one for each object, for a ground in
    /// the set, and where an object comes near one while `config.ignores_parting` is set; same as for
    /// [`motion::cast`](crate::motion::cast()), and [`Error::Memory`](crate::base::error::Error::Memory).
    pub fn cast(
        &self,
        set: &ObjectSet,
        motions: &[Motion],
        config: &CastConfig,
        scratch: &mut SetScratch,
    ) -> Result<SceneCastAnswer> {
        with_default(|| {
            let SetScratch { movers, boxes, open, found, approaches, caches, .. } = scratch;
            let question = casts::CastQuestion { others: self.others(set), motions, config };
            casts::cast(question, &mut casts::CastRoom { movers, boxes, open, found, approaches, caches })
        })
    }

    /// [`Scene::cast`] of many edges, whose motions stand one behind the other: one for each edge, or one for each object of the
    /// set at each edge. Each edge has an answer of its own.
    ///
    /// # Errors
    /// As [`Scene::cast`], naming the edge, and [`Error::Argument`](crate::base::error::Error::Argument) for motions that do not
    /// come out even. Answers of edges before it stay.
    pub fn cast_batch(
        &self,
        set: &ObjectSet,
        motions: &[Motion],
        config: &CastConfig,
        scratch: &mut SetScratch,
        answers: &mut [SceneCastAnswer],
    ) -> Result<()> {
        let edges = answers.len();
        let each = if motions.len() == edges { 1 } else { set.ids.len() };
        if motions.len() != edges * each {
            let are = format!("{} motions for {edges} edges of a set of {} objects", motions.len(), set.ids.len());
            return Err(Error::Argument(format!("{are}: give one for each edge, or for each object at each edge")));
        }
        for (k, (answer, motions)) in answers.iter_mut().zip(motions.chunks(each.max(1))).enumerate() {
            *answer = self
                .cast(set, motions, config, scratch)
                .map_err(|error| error.about(&format!("edge {k} of {edges}")))?;
        }
        Ok(())
    }

    /// The contacts of objects, all or those of a set, with a ground that is in no scene, or up to `config.max_distance` apart from
    /// it. Each piece gets the result of [`ground_contacts`](crate::ground::ground_contacts).
    ///
    /// Objects are asked whose groups and mask go with the filter's; activation and the scene's filter are about pairs, and do
    /// not count. Fixed objects are left out, unless the set gives their poses. The set's `among` is not looked at.
    ///
    /// # Errors
    /// [`Error::Handle`](crate::base::error::Error::Handle) for an id that is null, stale or another scene's;
    /// [`Error::Argument`](crate::base::error::Error::Argument) for a ground in the set, and unless a set with poses has one for
    /// each;
    /// [`Error::Pose`](crate::base::error::Error::Pose) for a pose that is not accepted; same as for
    /// [`ground_contacts`](crate::ground::ground_contacts), and [`Error::Memory`](crate::base::error::Error::Memory).
    pub fn ground_contacts<'a>(
        &self,
        set: Option<&ObjectSet>,
        ground: PlacedGround,
        config: &ManifoldConfig,
        filter: GroupFilter,
        scratch: &'a mut SetScratch,
    ) -> Result<SceneGroundContacts<'a>> {
        self.floor_contacts(set, Some((Floor::Ground(ground), filter)), config, scratch)
    }

    /// The same with the grounds that are objects of the scene, each contact naming its own. Pairs are those that queries test, so
    /// that activation and the scene's filter count here.
    ///
    /// # Errors
    /// As [`Scene::ground_contacts`].
    pub fn own_ground_contacts<'a>(
        &self,
        set: Option<&ObjectSet>,
        config: &ManifoldConfig,
        scratch: &'a mut SetScratch,
    ) -> Result<SceneGroundContacts<'a>> {
        self.floor_contacts(set, None, config, scratch)
    }

    /// The same for a half-space: a contact for each piece that is within `max_distance`, as
    /// [`half_space_manifold`](crate::manifold::half_space_manifold) gives it.
    ///
    /// # Errors
    /// As [`Scene::ground_contacts`] and [`half_space_manifold`](crate::manifold::half_space_manifold).
    pub fn half_space_contacts<'a>(
        &self,
        set: Option<&ObjectSet>,
        half_space: &HalfSpace,
        config: &ManifoldConfig,
        filter: GroupFilter,
        scratch: &'a mut SetScratch,
    ) -> Result<SceneGroundContacts<'a>> {
        self.floor_contacts(set, Some((Floor::HalfSpace(half_space), filter)), config, scratch)
    }

    fn floor_contacts<'a>(
        &self,
        set: Option<&ObjectSet>,
        floor: Option<(Floor, GroupFilter)>,
        config: &ManifoldConfig,
        scratch: &'a mut SetScratch,
    ) -> Result<SceneGroundContacts<'a>> {
        with_default(|| {
            let SetScratch { members, open, found: rows, near_grounds: near, ground, contacts, .. } = scratch;
            let question = grounds::GroundQuestion { others: self.others(&NOBODY), set, floor, config };
            grounds::find(question, &mut grounds::SetGroundRoom { members, open, rows, near, ground, contacts })?;
            Ok(SceneGroundContacts { contacts: &contacts[..], points: &ground.points })
        })
    }

    /// [`pair::batch()`] with the scene's workers; nothing of the scene is asked or changed.
    ///
    /// # Errors
    /// As [`pair::batch()`].
    pub fn ask_pairs(
        &mut self,
        query: Query,
        pairs: &mut [PairQuestion],
        config: &PairConfig,
        answers: &mut [PairAnswer],
    ) -> Result<()> {
        pair::batch(query, pairs, config, answers, Some(&self.workers))
    }

    /// All that is not in a set.
    fn others<'a>(&'a self, set: &'a ObjectSet<'a>) -> Others<'a> {
        Others { world: &self.world, trees: self.near.fitted_trees(&self.world.proxies), set }
    }
}
