//! What touches or comes near one object: of the scene, or a shape that is put somewhere for the question alone.

use std::sync::{Arc, Mutex};

use super::filters::testing;
use super::{Asked, Scene};
use crate::base::error::Result;
use crate::base::math::Pose;
use crate::base::memory::{collected, push};
use crate::pair::Query;
use crate::scene::broad_phase::near_pairs::{NearPair, NearPairs, Testing};
use crate::scene::narrow_phase::Own;
use crate::scene::object::ObjectId;
use crate::scene::proxies::NewProxy;
use crate::scene::query::{SceneAnswer, SceneQuery};
use crate::scene::recording::format::Subject;
use crate::scene::rows::Label;
use crate::shape::Shape;

impl Scene {
    /// As the query of this kind, of the pairs of one object alone: what it touches or comes near. An error budget is not heeded.
    ///
    /// # Errors
    /// [`Error::Handle`](crate::base::error::Error::Handle) for an id that is null, stale or another scene's, and as
    /// [`Scene::query_intersection`].
    pub fn query_object(&mut self, id: ObjectId, kind: Query, query: &SceneQuery) -> Result<SceneAnswer<'_>> {
        self.objects.get(id)?;
        self.answer(&Subject::Object(id), kind, query, |scene| {
            let asked = Asked::new(query, kind)?;
            scene.begin_pass();
            if scene.keeps_list(asked.tolerance()) {
                scene.update_near_pairs(asked.tolerance())?;
                scene.ask_near_object(id, &asked, query.early_exit)
            } else {
                scene.ask_any_object(id, &asked, query.early_exit)
            }
        })
    }

    /// The pairs of an object that are in the list.
    fn ask_near_object(&mut self, id: ObjectId, asked: &Asked, early_exit: bool) -> Result<bool> {
        let rows = self.objects.get(id)?.proxies();
        let near = &mut self.broad_phase.near;
        let is_own = |pair: &&NearPair| pair.proxies.iter().any(|&proxy| rows.contains(&(proxy as usize)));
        let mut pairs = collected(near.pairs.iter().filter(is_own).copied())?;
        let pass = asked.pass(&self.proxies, early_exit, None);
        let NearPairs { caches, contacts, .. } = near;
        contacts.make_room(if asked.details.is_some() { caches.len() } else { 0 })?;
        let stopped = pass.run(&mut pairs, &mut Own { caches, contacts: Some(contacts) }, &mut self.findings)?;
        self.statistics.add(&self.findings.statistics);
        Ok(stopped)
    }

    /// The pairs of an object with all others.
    fn ask_any_object(&mut self, id: ObjectId, asked: &Asked, early_exit: bool) -> Result<bool> {
        let own = self.objects.get(id)?.proxies();
        let (objects, activation, filter) = (&self.objects, &self.activation, &mut self.filter);
        let mut pairs = Vec::new();
        for other in self.proxies.of_objects() {
            let [one, other] = if other.start < own.start { [other, own.clone()] } else { [own.clone(), other] };
            for a in one {
                for b in other.clone() {
                    let labels = [&self.proxies.labels[a], &self.proxies.labels[b]];
                    if self.proxies.may_meet(a, b) && testing(objects, activation, filter, labels) == Testing::Active {
                        add(&mut pairs, [a, b])?;
                    }
                }
            }
        }
        self.ask_cold(&mut pairs, asked, early_exit)
    }

    /// As [`Scene::query_object`], of a shape that is in no scene, put at `pose` for this question: each object of the scene is
    /// object 1, object 2 has the null id. All objects are asked, whatever activation and filters say.
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
        self.answer(&Subject::Placed(shape, *pose), kind, query, |scene| {
            pose.check(scene.rotation_limit)?;
            let asked = Asked::new(query, kind)?;
            scene.begin_pass();
            let tolerance = asked.tolerance();
            // Boxes are good for their tolerance where the scene itself finds the pairs.
            let by_boxes = scene.given.is_none() && scene.keeps_list(tolerance);
            if by_boxes {
                scene.update_near_pairs(tolerance)?;
            }
            scene.proxies.reserve(1)?;
            let label = Label { object: ObjectId::NULL, user_data: 0, piece: 0, fixed: false, groups: 0, mask: 0 };
            let own = scene.proxies.push_unseen(NewProxy { shape: shape.clone(), pose: *pose, label });
            let stopped = scene.ask_placed(own, by_boxes, &asked, query.early_exit);
            scene.proxies.pop_unseen();
            stopped
        })
    }

    /// The pairs of the last row with all objects, or with those whose boxes overlap its own.
    fn ask_placed(&mut self, own: usize, by_boxes: bool, asked: &Asked, early_exit: bool) -> Result<bool> {
        if by_boxes {
            self.proxies.refit(own, self.broad_phase.tolerance());
        }
        let proxies = &self.proxies;
        let is_near = |other: usize| !by_boxes || proxies.boxes[other].overlaps(&proxies.boxes[own]);
        let mut pairs = Vec::new();
        for other in (0..own).filter(|&other| !proxies.is_gone(other) && is_near(other)) {
            add(&mut pairs, [other, own])?;
        }
        self.ask_cold(&mut pairs, asked, early_exit)
    }

    /// Pairs that remember nothing.
    fn ask_cold(&mut self, pairs: &mut [NearPair], asked: &Asked, early_exit: bool) -> Result<bool> {
        let mut caches = collected(pairs.iter().map(|_| Mutex::default()))?;
        let pass = asked.pass(&self.proxies, early_exit, None);
        let stopped = pass.run(pairs, &mut Own { caches: &mut caches, contacts: None }, &mut self.findings)?;
        self.statistics.add(&self.findings.statistics);
        Ok(stopped)
    }
}

/// One more pair, with a cache of its own.
fn add(pairs: &mut Vec<NearPair>, [a, b]: [usize; 2]) -> Result<()> {
    let cache = pairs.len() as u32;
    push(pairs, NearPair { cache, ..NearPair::new([a as u32, b as u32]) })
}
