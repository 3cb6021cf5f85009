//! All that a scene holds, and its objects coming and going.

use std::ops::Range;
use std::sync::Arc;

use crate::base::error::{Error, Result};
use crate::base::math::Pose;
use crate::base::memory::{copied, filled};
use crate::base::simd::environment::with_default;
use crate::compound::{Compound, check_pose};
use crate::ground::Ground;
use crate::scene::world::activation::Activation;
use crate::scene::world::bodies::RowBody;
use crate::scene::world::object::{Arrangement, ObjectId, ObjectOptions, ObjectTable};
use crate::scene::world::object_view::Objects;
use crate::scene::world::piece_data::PieceData;
use crate::scene::world::proxies::{NewProxy, Proxies};
use crate::scene::world::rows::Label;
use crate::scene::world::testing::{Decided, PairFilter, Rules, is_tested};
use crate::shape::Shape;

/// Without a tolerance all pairs are near: so many are kept with their caches, unless the program sets another limit.
pub(crate) const DEFAULT_KEPT_PAIRS: u64 = 1 << 20;

/// So few pairs of pieces are all near.
const FEW_PAIRS: u64 = 16;

/// Objects, where they are, and the settings on the testing of their pairs.
#[derive(Debug)]
pub(crate) struct World {
    pub objects: ObjectTable,
    pub proxies: Proxies,
    pub piece_data: PieceData,
    pub activation: Activation,
    pub filter: Option<PairFilter>,
    /// The pairs of a program with a broad phase of its own; where there are none, the scene's own finds what is near.
    pub given: Option<Vec<[ObjectId; 2]>>,
    /// How many times queries have looked at pairs: what moves is stamped with it.
    pub passes: u64,
    /// Above this number of pairs of pieces, not all are kept.
    pub kept_pair_limit: u64,
}

impl World {
    pub fn new() -> World {
        World {
            objects: ObjectTable::new(),
            proxies: Proxies::default(),
            piece_data: PieceData::default(),
            activation: Activation::default(),
            filter: None,
            given: None,
            passes: 0,
            kept_pair_limit: DEFAULT_KEPT_PAIRS,
        }
    }

    /// The objects, for reading.
    pub fn view(&self) -> Objects<'_> {
        Objects { table: &self.objects, proxies: &self.proxies, piece_data: &self.piece_data }
    }

    /// The pieces, the settings for which pairs of them are tested, and which pairs the program gives.
    pub fn parts(&mut self) -> (&mut Proxies, Rules<'_>, Option<&[[ObjectId; 2]]>) {
        let World { objects, proxies, activation, filter, given, .. } = self;
        (proxies, Rules { objects, activation, filter: filter.as_mut() }, given.as_deref())
    }

    /// Adds an object, all of whose pairs are active.
    ///
    /// # Errors
    /// See [`Scene::add_object`](crate::scene::Scene::add_object).
    pub fn add(&mut self, pieces: &[Arc<Shape>], options: &ObjectOptions) -> Result<ObjectId> {
        with_default(|| options.pose.check())?;
        self.proxies.reserve(pieces.len())?;
        let first = self.proxies.len();
        let id = self.objects.insert(first..first + pieces.len())?;
        self.activation.set_object(&mut self.objects.get_mut(id)?.activation, true);
        for (piece, shape) in (0..).zip(pieces) {
            let ObjectOptions { user_data, fixed, groups, mask, .. } = *options;
            let label = Label { object: id, user_data, piece, fixed, groups, mask };
            self.proxies.push(NewProxy { shape: shape.clone(), pose: options.pose, label });
        }
        Ok(id)
    }

    /// Adds a ground, which is fixed.
    ///
    /// # Errors
    /// See [`Scene::add_ground`](crate::scene::Scene::add_ground).
    pub fn add_ground(&mut self, ground: &Arc<Ground>, options: &ObjectOptions) -> Result<ObjectId> {
        let around = Arc::new(Shape::surrounding(&ground.bounds(), f64::INFINITY)?);
        self.proxies.bodies.reserve()?;
        let row = self.proxies.len();
        let id = self.add(&[around], &ObjectOptions { fixed: true, ..*options })?;
        self.proxies.bodies.push(row, RowBody::Ground(ground.clone()));
        Ok(id)
    }

    /// Adds a compound.
    ///
    /// # Errors
    /// See [`Scene::add_compound`](crate::scene::Scene::add_compound).
    pub fn add_compound(&mut self, compound: &Arc<Compound>, options: &ObjectOptions) -> Result<ObjectId> {
        with_default(|| check_pose(&compound.at(&options.pose).placed_pieces()))?;
        let around = compound.surrounding()?;
        self.proxies.bodies.reserve()?;
        let row = self.proxies.len();
        let piece_poses = filled(Pose::IDENTITY, 1)?;
        let id = self.add(&[around], options)?;
        self.proxies.bodies.push(row, RowBody::Compound(compound.clone()));
        if compound.has_placed_pieces() {
            let arrangement = Arrangement { pose: options.pose, piece_poses, compound: Some(compound.clone()) };
            self.objects.get_mut(id)?.arrangement = Some(Box::new(arrangement));
        }
        Ok(id)
    }

    /// Whether an object is a compound.
    pub fn is_compound(&self, id: ObjectId) -> bool {
        self.view().get(id).is_ok_and(|object| object.compound().is_some())
    }

    /// Refuses objects of which one could not be added: so many of a piece each, with these options.
    ///
    /// # Errors
    /// See [`Scene::add_shapes`](crate::scene::Scene::add_shapes).
    pub fn check_additions(&self, count: usize, options: &[ObjectOptions]) -> Result<()> {
        if options.len() != count {
            return Err(Error::Argument(format!("{} options for {count} shapes", options.len())));
        }
        with_default(|| {
            options.iter().enumerate().try_for_each(|(k, options)| {
                let named = |error: Error| Error::Pose(format!("options[{k}]: {}", error.message()));
                options.pose.check().map_err(named)
            })
        })
    }

    /// Room for so many objects of a piece each.
    ///
    /// # Errors
    /// [`Error::Limit`], [`Error::Memory`].
    pub fn reserve(&mut self, count: usize) -> Result<()> {
        self.objects.reserve(count, self.proxies.len() + count)?;
        self.proxies.reserve(count)
    }

    /// Refuses objects of which one could not be removed; `sorted` has the bits of each id and its place, ascending.
    ///
    /// # Errors
    /// See [`Scene::remove_objects`](crate::scene::Scene::remove_objects).
    pub fn check_removals(&self, ids: &[ObjectId], sorted: &[(u64, usize)]) -> Result<()> {
        debug_assert!(sorted.len() == ids.len() && sorted.is_sorted());
        for (k, id) in ids.iter().enumerate() {
            self.objects.get(*id).map_err(|error| Error::Handle(format!("ids[{k}]: {}", error.message())))?;
        }
        match sorted.windows(2).filter(|two| two[0].0 == two[1].0).map(|two| two[1].1).min() {
            Some(k) => Err(Error::Argument(format!("ids[{k}]: object {} is given twice", ids[k]))),
            None => Ok(()),
        }
    }

    /// Sets the caller's number of a piece.
    ///
    /// # Errors
    /// As [`World::remove`]; [`Error::Argument`] for a piece that the object does not have, [`Error::Memory`].
    pub fn set_piece_user_data(&mut self, id: ObjectId, piece: u32, user_data: u64) -> Result<()> {
        let (piece, object) = (piece as usize, self.view().get(id)?);
        object.refuse_absent(piece)?;
        let count = object.pieces().len();
        self.piece_data.set(id, [piece, count], user_data)
    }

    /// Adds an object that is like another one.
    ///
    /// # Errors
    /// See [`Scene::copy_object`](crate::scene::Scene::copy_object).
    pub fn copy(&mut self, id: ObjectId) -> Result<ObjectId> {
        let original = self.view().get(id)?;
        if let Some(ground) = original.ground() {
            let (ground, options) = (ground.clone(), original.options());
            return self.add_ground(&ground, &options);
        }
        if let Some(compound) = original.compound() {
            let (compound, options) = (compound.clone(), original.options());
            return self.add_compound(&compound, &options);
        }
        let (options, piece_poses) = (original.options(), copied(original.piece_poses())?);
        let pieces = copied(original.pieces())?;
        let piece_data = self.piece_data.copy_of(id)?;
        let copy = self.add(&pieces, &options)?;
        self.put_pieces(copy, piece_poses)?;
        self.piece_data.put(copy, piece_data);
        Ok(copy)
    }

    /// Removes an object.
    ///
    /// # Errors
    /// [`Error::Handle`] for an id that is null, stale or another scene's.
    pub fn remove(&mut self, id: ObjectId) -> Result<()> {
        for proxy in self.objects.get(id)?.proxies() {
            self.proxies.end(proxy);
        }
        self.piece_data.forget(id);
        self.objects.remove(id)
    }

    /// Fixes an object or lets it move.
    ///
    /// # Errors
    /// As [`World::remove`].
    pub fn set_fixed(&mut self, id: ObjectId, fixed: bool) -> Result<()> {
        debug_assert!(fixed || self.view().get(id)?.ground().is_none());
        for proxy in self.objects.get(id)?.proxies() {
            self.proxies.labels[proxy].fixed = fixed;
            self.proxies.look_for_pairs_of(proxy);
        }
        Ok(())
    }

    /// Sets the filter bits of an object.
    ///
    /// # Errors
    /// As [`World::remove`].
    pub fn set_groups(&mut self, id: ObjectId, groups: u32, mask: u32) -> Result<()> {
        for proxy in self.objects.get(id)?.proxies() {
            let label = &mut self.proxies.labels[proxy];
            if (label.groups, label.mask) != (groups, mask) {
                (label.groups, label.mask) = (groups, mask);
                self.proxies.look_for_pairs_of(proxy);
            }
        }
        Ok(())
    }

    /// Sets the caller's number of an object.
    ///
    /// # Errors
    /// As [`World::remove`].
    pub fn set_user_data(&mut self, id: ObjectId, user_data: u64) -> Result<()> {
        for proxy in self.objects.get(id)?.proxies() {
            self.proxies.labels[proxy].user_data = user_data;
        }
        Ok(())
    }

    /// Two different objects, the earlier created first.
    ///
    /// # Errors
    /// As [`World::remove`], and [`Error::Argument`] for one object twice.
    pub fn ordered_pair(&self, [id1, id2]: [ObjectId; 2]) -> Result<[ObjectId; 2]> {
        let [first1, first2] = [self.objects.get(id1)?.first_proxy, self.objects.get(id2)?.first_proxy];
        match first1.cmp(&first2) {
            std::cmp::Ordering::Less => Ok([id1, id2]),
            std::cmp::Ordering::Equal => {
                Err(Error::Argument(format!("object {id1} is given twice: an object makes no pair with itself")))
            }
            std::cmp::Ordering::Greater => Ok([id2, id1]),
        }
    }

    /// Whether a question that changes nothing tests a pair of pieces. `moved`: one of them is elsewhere for the question, so that
    /// both may be of fixed objects.
    pub fn is_tested(&self, [a, b]: [usize; 2], moved: bool) -> bool {
        let World { objects, proxies, activation, filter, given, .. } = self;
        if !proxies.bodies.is_empty()
            && [a, b].iter().all(|row| matches!(proxies.bodies.get(*row), Some(RowBody::Ground(_))))
        {
            return false;
        }
        if !(if moved { proxies.may_meet_moved(a, b) } else { proxies.may_meet(a, b) }) {
            return false;
        }
        let labels = [a.min(b), a.max(b)].map(|proxy| &proxies.labels[proxy]);
        let [earlier, later] = labels.map(|label| label.object);
        let is_given =
            given.as_ref().is_none_or(|given| given.contains(&[earlier, later]) || given.contains(&[later, earlier]));
        is_given && is_tested(objects, activation, filter.as_ref(), labels)
    }

    /// Whether a pair is tested when it is near, regardless of the filter.
    ///
    /// # Errors
    /// As [`World::ordered_pair`].
    pub fn is_pair_active(&self, ids: [ObjectId; 2]) -> Result<bool> {
        let pair = self.ordered_pair(ids)?;
        let [object1, object2] = [self.objects.get(pair[0])?, self.objects.get(pair[1])?];
        Ok(self.proxies.may_meet(object1.first_proxy as usize, object2.first_proxy as usize)
            && self.activation.is_active(pair, [object1.activation, object2.activation]))
    }

    /// Says of a pair whether it is active; gives the earlier created object first.
    ///
    /// # Errors
    /// As [`World::ordered_pair`], and [`Error::Memory`].
    pub fn set_pair_active(&mut self, ids: [ObjectId; 2], active: bool) -> Result<[ObjectId; 2]> {
        let pair = self.ordered_pair(ids)?;
        let objects = &self.objects;
        self.activation.set_pair(pair, active, |id| objects.get(id).is_ok())?;
        Ok(pair)
    }

    /// Whether the filter, if there is one, remembers what it decides …
    pub fn watch_filter(&mut self, watched: bool) {
        if let Some(filter) = &mut self.filter {
            filter.watch(watched);
        }
    }

    /// … and what it has decided since; an error if not all is known.
    pub fn decided(&mut self) -> Result<Vec<Decided>> {
        self.filter.as_mut().map_or(Ok(Vec::new()), PairFilter::decided)
    }

    /// Takes the pairs that a program gives, or none.
    ///
    /// # Errors
    /// See [`Scene::set_pairs`](crate::scene::Scene::set_pairs).
    pub fn set_given(&mut self, pairs: Option<&[[ObjectId; 2]]>) -> Result<()> {
        for (k, ids) in pairs.unwrap_or_default().iter().enumerate() {
            self.ordered_pair(*ids).map_err(|error| match error {
                Error::Handle(message) => Error::Handle(format!("pair {k}: {message}")),
                other => Error::Argument(format!("pair {k}: {}", other.message())),
            })?;
        }
        self.given = pairs.map(copied).transpose()?;
        Ok(())
    }

    /// The rows of an object; for one that is gone there are none.
    pub fn rows_of(&self, id: ObjectId) -> Range<usize> {
        self.objects.rows_of(id)
    }

    /// Whether all that a query with this tolerance may list is kept in a list.
    pub fn keeps_list(&self, tolerance: f64) -> bool {
        tolerance < f64::INFINITY || self.is_small() || self.given.is_some()
    }

    /// Whether all pairs may be kept.
    pub fn is_small(&self) -> bool {
        self.pair_count() <= self.kept_pair_limit
    }

    /// Whether pairs are so few that all are kept for any question.
    pub fn has_few_pairs(&self) -> bool {
        self.pair_count() <= FEW_PAIRS.min(self.kept_pair_limit)
    }

    /// The number of pairs of two pieces, whether they may meet or not.
    fn pair_count(&self) -> u64 {
        // At most 2³¹: the product fits.
        let count = (self.proxies.len() - self.proxies.gone) as u64;
        count * count.saturating_sub(1) / 2
    }
}
