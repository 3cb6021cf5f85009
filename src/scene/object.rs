//! Objects of a scene: shapes with a pose, and the ids that name them.
//!
//! An id is a small value: a slot in the scene's table, the slot's generation, and the scene's tag. The generation
//! changes with every reuse of a slot, so an id outlives its object without ever naming another one.

use std::fmt;
use std::ops::Range;
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};

use crate::base::error::{Error, Result};
use crate::base::math::Pose;
use crate::base::memory::reserve;
use crate::shape::Shape;

const SLOT_BITS: u32 = 24;
const GENERATION_BITS: u32 = 20;
const SCENE_BITS: u32 = 20;
/// A slot whose generation has reached this is not used again.
const LAST_GENERATION: u32 = (1 << GENERATION_BITS) - 1;

/// Names an object of a scene. All zero, the default, names none; the id of a removed object is refused
/// for ever, that of another scene unless about a million scenes were made in between.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
#[repr(C)]
pub struct ObjectId {
    bits: u64,
}

impl ObjectId {
    /// Names no object.
    pub const NULL: ObjectId = ObjectId { bits: 0 };

    fn new(slot: usize, generation: u32, scene: u32) -> ObjectId {
        let upper = u64::from(scene) << GENERATION_BITS | u64::from(generation);
        ObjectId { bits: upper << SLOT_BITS | slot as u64 }
    }

    /// The id as a number, for C or for storage beside the caller's data. Opaque but for this: zero is null.
    pub fn to_bits(self) -> u64 {
        self.bits
    }

    /// The inverse of [`ObjectId::to_bits`]. Any number is safe: a scene refuses those it has not given out.
    pub fn from_bits(bits: u64) -> ObjectId {
        ObjectId { bits }
    }

    fn slot(self) -> usize {
        (self.bits & ((1 << SLOT_BITS) - 1)) as usize
    }

    fn generation(self) -> u32 {
        (self.bits >> SLOT_BITS) as u32 & LAST_GENERATION
    }

    fn scene(self) -> u32 {
        (self.bits >> (SLOT_BITS + GENERATION_BITS)) as u32
    }
}

impl fmt::Display for ObjectId {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{:#x}", self.bits)
    }
}

/// How an object begins.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ObjectOptions {
    /// Where it stands: world point = R·(local point) + T.
    pub pose: Pose,
    /// Two fixed objects are never tested against each other. A fixed object may still be moved on its own.
    pub fixed: bool,
    /// The caller's own; it comes back in every result.
    pub user_data: u64,
    /// The groups it is in, one bit each; the default is the first. Two objects are tested if each one's mask has a bit of the
    /// other's groups.
    pub groups: u32,
    /// The groups it is tested against; the default is all.
    pub mask: u32,
}

impl Default for ObjectOptions {
    fn default() -> Self {
        ObjectOptions { pose: Pose::IDENTITY, fixed: false, user_data: 0, groups: 1, mask: u32::MAX }
    }
}

/// When a word on the activation of pairs was said, and which: of two stamps the greater is the later.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Default)]
pub(crate) struct Stamp(u64);

impl Stamp {
    /// A later stamp than this.
    pub(crate) fn next(self, active: bool) -> Stamp {
        Stamp(((self.0 >> 1) + 1) << 1 | u64::from(active))
    }

    /// Whether the word was "active".
    pub(crate) fn active(self) -> bool {
        self.0 & 1 == 1
    }
}

/// One or several convex pieces that move together.
#[derive(Debug, Clone)]
pub struct Object {
    /// Convex pieces in one local frame, shared; at least one. They are never tested against each other.
    pub(crate) pieces: Vec<Arc<Shape>>,
    pub(crate) pose: Pose,
    /// Where each piece is in the object; none where all are at its origin.
    pub(crate) piece_poses: Vec<Pose>,
    pub(crate) fixed: bool,
    pub(crate) user_data: u64,
    pub(crate) groups: u32,
    pub(crate) mask: u32,
    /// The last word on the activation of its pairs.
    pub(crate) activation: Stamp,
    /// The first of its rows among the scene's proxies, one for each piece.
    pub(crate) first_proxy: u32,
    /// How many objects the scene had created before this one.
    serial: u64,
    /// Where it stands in the table's order of creation.
    place: u32,
    id: ObjectId,
}

impl Object {
    /// Its id.
    pub fn id(&self) -> ObjectId {
        self.id
    }

    /// Its convex pieces.
    pub fn pieces(&self) -> &[Arc<Shape>] {
        &self.pieces
    }

    /// Where it stands.
    pub fn pose(&self) -> &Pose {
        &self.pose
    }

    /// Where a piece is in the object.
    ///
    /// # Panics
    /// Without such a piece.
    pub fn piece_pose(&self, piece: usize) -> &Pose {
        assert!(piece < self.pieces.len(), "piece {piece} of {}", self.pieces.len());
        self.piece_poses.get(piece).unwrap_or(&Pose::IDENTITY)
    }

    /// Where a piece is in the world: the pose for which queries answer.
    ///
    /// # Panics
    /// Without such a piece.
    pub fn piece_pose_in_world(&self, piece: usize) -> Pose {
        if self.piece_poses.is_empty() { self.pose } else { composed(&self.pose, self.piece_pose(piece)) }
    }

    /// What it was made of, but for the pieces.
    pub(crate) fn options(&self) -> ObjectOptions {
        let Object { pose, fixed, user_data, groups, mask, .. } = *self;
        ObjectOptions { pose, fixed, user_data, groups, mask }
    }

    /// Whether the two may make a pair, activation and the program's filter aside.
    pub(crate) fn may_meet(&self, other: &Object) -> bool {
        !(self.fixed && other.fixed) && self.groups & other.mask != 0 && other.groups & self.mask != 0
    }

    /// The groups it is in.
    pub fn groups(&self) -> u32 {
        self.groups
    }

    /// The groups it is tested against.
    pub fn mask(&self) -> u32 {
        self.mask
    }

    /// Whether it is fixed.
    pub fn fixed(&self) -> bool {
        self.fixed
    }

    /// The caller's own number.
    pub fn user_data(&self) -> u64 {
        self.user_data
    }

    /// Its place in the order of creation, for ever.
    pub(crate) fn serial(&self) -> u64 {
        self.serial
    }

    /// Its rows among the scene's proxies.
    pub(crate) fn proxies(&self) -> Range<usize> {
        let first = self.first_proxy as usize;
        first..first + self.pieces.len()
    }
}

/// The pose of what is at `inner` in a frame that is at `outer`, each number rounded.
pub(crate) fn composed(outer: &Pose, inner: &Pose) -> Pose {
    Pose::new(&(outer.rotation() * inner.rotation()), &outer.transform(&inner.translation()))
}

#[derive(Debug)]
struct Slot {
    /// That of the object in it, or of the last one; 0 before the first.
    generation: u32,
    object: Option<Object>,
}

/// The objects of one scene, by id and in order of creation.
#[derive(Debug)]
pub(crate) struct ObjectTable {
    scene: u32,
    slots: Vec<Slot>,
    /// Slots to be used again, the last one first; with room for all slots, so that removing needs no memory.
    free: Vec<u32>,
    /// Slots of the objects in order of creation, [`GONE`] in the places of those removed.
    order: Vec<u32>,
    count: usize,
    created: u64,
}

/// No slot.
const GONE: u32 = u32::MAX;

impl ObjectTable {
    pub(crate) fn new() -> ObjectTable {
        static SCENES: AtomicU64 = AtomicU64::new(0);
        let count = SCENES.fetch_add(1, Ordering::Relaxed);
        // Tags repeat after 2²⁰ − 1 scenes; zero is left to the null id.
        let scene = (count % ((1 << SCENE_BITS) - 1)) as u32 + 1;
        ObjectTable { scene, slots: Vec::new(), free: Vec::new(), order: Vec::new(), count: 0, created: 0 }
    }

    /// Adds an object; the caller has checked the pieces and the pose.
    ///
    /// # Errors
    /// [`Error::Limit`] when there are no ids left, [`Error::Memory`]; nothing is added then.
    pub(crate) fn insert(
        &mut self,
        pieces: Vec<Arc<Shape>>,
        options: &ObjectOptions,
        first_proxy: u32,
    ) -> Result<ObjectId> {
        reserve(&mut self.order, 1)?;
        let slot = match self.free.pop() {
            Some(slot) => slot as usize,
            None if self.slots.len() < 1 << SLOT_BITS => {
                reserve(&mut self.slots, 1)?;
                reserve(&mut self.free, self.slots.len() + 1)?;
                self.slots.push(Slot { generation: 0, object: None });
                self.slots.len() - 1
            }
            None => {
                return Err(Error::Limit(format!("a scene holds at most {} objects", 1 << SLOT_BITS)));
            }
        };
        self.slots[slot].generation += 1;
        let id = ObjectId::new(slot, self.slots[slot].generation, self.scene);
        let ObjectOptions { pose, fixed, user_data, groups, mask } = *options;
        let (activation, place) = (Stamp::default(), self.order.len() as u32);
        self.slots[slot].object = Some(Object {
            pieces,
            pose,
            piece_poses: Vec::new(),
            fixed,
            user_data,
            groups,
            mask,
            activation,
            first_proxy,
            serial: self.created,
            place,
            id,
        });
        self.count += 1;
        self.created += 1;
        self.order.push(slot as u32);
        Ok(id)
    }

    /// Removes an object; its id is stale from now on.
    ///
    /// # Errors
    /// [`Error::Handle`] as [`ObjectTable::get`].
    pub(crate) fn remove(&mut self, id: ObjectId) -> Result<()> {
        let place = self.get(id)?.place as usize;
        let slot = id.slot();
        self.order[place] = GONE;
        self.count -= 1;
        self.slots[slot].object = None;
        // Seldom enough that removing one takes constant time on average.
        if self.order.len() > 2 * self.count + 64 {
            self.close_gaps();
        }
        if self.slots[slot].generation < LAST_GENERATION {
            self.free.push(slot as u32);
        }
        Ok(())
    }

    fn close_gaps(&mut self) {
        self.order.retain(|&slot| slot != GONE);
        for (place, &slot) in (0..).zip(&self.order) {
            if let Some(object) = &mut self.slots[slot as usize].object {
                object.place = place;
            }
        }
    }

    /// The object of an id.
    ///
    /// # Errors
    /// [`Error::Handle`] for an id that is null, stale or another scene's.
    pub(crate) fn get(&self, id: ObjectId) -> Result<&Object> {
        match self.slots.get(id.slot()).and_then(|slot| slot.object.as_ref()) {
            Some(object) if object.id == id => Ok(object),
            _ => Err(self.refusal(id)),
        }
    }

    /// As [`ObjectTable::get`], for changing it.
    pub(crate) fn get_mut(&mut self, id: ObjectId) -> Result<&mut Object> {
        // The shared borrow ends before the exclusive one begins; a match on the exclusive one would hold it too long.
        self.get(id)?;
        self.slots[id.slot()].object.as_mut().ok_or_else(|| Error::Bug(format!("object id {id} has no object")))
    }

    /// Why an id that names no object of this scene does not.
    #[cold]
    fn refusal(&self, id: ObjectId) -> Error {
        Error::Handle(if id == ObjectId::NULL {
            "the object id is null".into()
        } else if id.scene() != self.scene {
            format!("object id {id} is not of this scene")
        } else if self.slots.get(id.slot()).is_some_and(|slot| (1..=slot.generation).contains(&id.generation())) {
            format!("object id {id} is stale: its object was removed")
        } else {
            format!("object id {id} was never given out")
        })
    }

    /// The objects in order of creation.
    pub(crate) fn iter(&self) -> impl Iterator<Item = &Object> + Clone {
        self.order.iter().filter_map(|&slot| self.slots.get(slot as usize)?.object.as_ref())
    }

    /// The objects in order of creation, for changing them.
    pub(crate) fn for_each_mut(&mut self, mut change: impl FnMut(&mut Object)) {
        for &slot in &self.order {
            if let Some(Slot { object: Some(object), .. }) = self.slots.get_mut(slot as usize) {
                change(object);
            }
        }
    }

    /// How many there have ever been.
    pub(crate) fn created(&self) -> u64 {
        self.created
    }

    /// How many there are.
    pub(crate) fn len(&self) -> usize {
        self.count
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A table with `count` objects that have no pieces: the table does not look at them.
    fn table(count: usize) -> (ObjectTable, Vec<ObjectId>) {
        let mut table = ObjectTable::new();
        let ids = (0..count).map(|_| insert(&mut table)).collect();
        (table, ids)
    }

    fn insert(table: &mut ObjectTable) -> ObjectId {
        table.insert(Vec::new(), &ObjectOptions::default(), 0).unwrap()
    }

    fn message(table: &ObjectTable, id: ObjectId) -> String {
        match table.get(id) {
            Err(Error::Handle(message)) => message,
            other => panic!("{id}: {other:?}"),
        }
    }

    #[test]
    fn an_id_survives_its_bits_and_is_never_zero() {
        let (table, ids) = table(3);
        for id in ids {
            assert_ne!(id.to_bits(), 0);
            assert_eq!(ObjectId::from_bits(id.to_bits()), id);
            assert_eq!(table.get(id).unwrap().id(), id);
        }
        assert_eq!(ObjectId::default(), ObjectId::NULL);
    }

    #[test]
    fn every_refusal_says_why() {
        let (mut table, ids) = table(2);
        let (other, foreign) = self::table(2);
        table.remove(ids[0]).unwrap();
        assert!(message(&table, ObjectId::NULL).contains("null"));
        assert!(message(&table, ids[0]).contains("stale"));
        assert!(message(&table, foreign[1]).contains("not of this scene"));
        assert!(message(&other, ids[1]).contains("not of this scene"));
        let unborn = ObjectId::new(7, 1, table.scene);
        assert!(message(&table, unborn).contains("never given out"));
        let future = ObjectId::new(1, 2, table.scene);
        assert!(message(&table, future).contains("never given out"));
        assert!(matches!(table.remove(ids[0]), Err(Error::Handle(_))));
        assert!(matches!(table.get_mut(ids[0]), Err(Error::Handle(_))));
    }

    #[test]
    fn a_slot_used_again_gives_another_id_and_the_last_place_in_order() {
        let (mut table, ids) = table(3);
        table.remove(ids[0]).unwrap();
        let again = insert(&mut table);
        assert_eq!(again.slot(), ids[0].slot());
        assert_ne!(again, ids[0]);
        assert!(message(&table, ids[0]).contains("stale"));
        let order: Vec<ObjectId> = table.iter().map(Object::id).collect();
        assert_eq!(order, [ids[1], ids[2], again]);
    }

    #[test]
    fn a_table_emptied_object_by_object_keeps_its_order_and_no_gaps() {
        let (mut table, mut ids) = table(500);
        while ids.len() > 3 {
            table.remove(ids.remove(ids.len() * 7 / 11)).unwrap();
            let order: Vec<ObjectId> = table.iter().map(Object::id).collect();
            assert_eq!((order, table.len()), (ids.clone(), ids.len()));
            assert!(table.order.len() <= 2 * ids.len() + 64);
        }
    }

    #[test]
    fn a_slot_without_generations_left_is_retired() {
        let (mut table, ids) = table(1);
        table.remove(ids[0]).unwrap();
        table.slots[0].generation = LAST_GENERATION - 1;
        let last = insert(&mut table);
        assert_eq!((last.slot(), last.generation()), (0, LAST_GENERATION));
        table.remove(last).unwrap();
        assert_eq!(insert(&mut table).slot(), 1);
        assert!(message(&table, last).contains("stale"));
    }
}
