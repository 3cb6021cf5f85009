//! Objects of a scene: shapes with a pose, and the ids that name them.
//!
//! An id is a small value: a slot in the scene's table, the slot's generation, and the scene's tag. The generation
//! changes with every reuse of a slot, so an id outlives its object without ever naming another one.

use std::fmt;
use std::num::NonZeroU32;
use std::ops::Range;
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};

use crate::base::error::{Error, Result};
use crate::base::math::Pose;
use crate::base::memory::reserve_sparingly;
use crate::compound::{Compound, check_pose};

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
        debug_assert!(slot < 1 << SLOT_BITS && generation <= LAST_GENERATION);
        let upper = u64::from(scene) << GENERATION_BITS | u64::from(generation);
        ObjectId { bits: upper << SLOT_BITS | slot as u64 }
    }

    /// The id as a number, for C or for storage beside the caller's data. Opaque, except that zero is null.
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
    /// The pose: world point = R·(local point) + T.
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

/// The time of a word on the activation of pairs, and its kind: of two stamps the greater is the later.
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

/// The table's entry for an object. The rest is in the rows of its pieces.
#[derive(Debug)]
pub(crate) struct Entry {
    /// The first of its rows among the scene's proxies, one for each piece.
    pub first_proxy: u32,
    piece_count: NonZeroU32,
    /// The last word on the activation of its pairs.
    pub activation: Stamp,
    /// How many objects the scene had created before this one.
    serial: u64,
    /// None where all pieces are at its origin: the pose is that of each piece then.
    pub arrangement: Option<Box<Arrangement>>,
}

/// The pose of an object, and of each of its pieces in it.
#[derive(Debug, Clone)]
pub(crate) struct Arrangement {
    pub pose: Pose,
    pub piece_poses: Vec<Pose>,
    /// The compound that it is, where a pose may be refused for its pieces' sake.
    pub compound: Option<Arc<Compound>>,
}

impl Arrangement {
    /// Refuses a pose of the object at which that of a piece is refused.
    ///
    /// # Errors
    /// [`Error::Pose`].
    pub fn check(&self, pose: &Pose) -> Result<()> {
        self.compound.as_ref().map_or(Ok(()), |compound| check_pose(&compound.at(pose).placed_pieces()))
    }
}

impl Entry {
    /// Its permanent place in the order of creation.
    pub fn serial(&self) -> u64 {
        self.serial
    }

    /// Its rows among the scene's proxies.
    pub fn proxies(&self) -> Range<usize> {
        let first = self.first_proxy as usize;
        first..first + self.piece_count.get() as usize
    }

    /// Its only row, where the object's pose is that of its one piece.
    #[inline(always)]
    pub fn only_proxy(&self) -> Option<usize> {
        (self.piece_count == NonZeroU32::MIN && self.arrangement.is_none()).then_some(self.first_proxy as usize)
    }

    /// Sets the pose from now on, if its pieces have poses of their own; else the poses of the pieces give it.
    pub fn stand_at(&mut self, pose: &Pose) {
        if let Some(arrangement) = &mut self.arrangement {
            arrangement.pose = *pose;
        }
    }
}

#[derive(Debug)]
struct Slot {
    /// That of the object in it, or of the last one; 0 before the first.
    generation: u32,
    holds: Holds,
}

#[derive(Debug)]
enum Holds {
    Object(Entry),
    /// Nothing, and after it `next` is the slot to be used again, or [`NONE`].
    Nothing {
        next: u32,
    },
}

/// The objects of one scene, by id.
#[derive(Debug)]
pub(crate) struct ObjectTable {
    scene: u32,
    slots: Vec<Slot>,
    /// The slot to be used again, or [`NONE`]: the one emptied last.
    free: u32,
    count: usize,
    created: u64,
}

/// No slot.
const NONE: u32 = u32::MAX;

/// Numbers of proxies leave one bit of 32 to the trees.
const MOST_PROXIES: usize = 1 << 31;

impl ObjectTable {
    pub(crate) fn new() -> ObjectTable {
        static SCENES: AtomicU64 = AtomicU64::new(0);
        let count = SCENES.fetch_add(1, Ordering::Relaxed);
        // Tags repeat after 2²⁰ − 1 scenes; zero is left to the null id.
        let scene = (count % ((1 << SCENE_BITS) - 1)) as u32 + 1;
        ObjectTable { scene, slots: Vec::new(), free: NONE, count: 0, created: 0 }
    }

    /// Adds an object, whose pieces have these rows.
    ///
    /// # Errors
    /// [`Error::Argument`] without rows, [`Error::Limit`] when there are no ids left, [`Error::Memory`]; nothing is added then.
    pub(crate) fn insert(&mut self, proxies: Range<usize>) -> Result<ObjectId> {
        if proxies.end > MOST_PROXIES {
            return Err(Error::Limit(format!("a scene holds at most {MOST_PROXIES} pieces")));
        }
        let first_proxy = proxies.start as u32;
        let Some(piece_count) = NonZeroU32::new(proxies.len() as u32) else {
            return Err(Error::Argument("an object needs at least one piece".into()));
        };
        let slot = self.empty_slot()?;
        let Slot { generation, holds } = &mut self.slots[slot];
        if let Holds::Nothing { next } = *holds {
            self.free = next;
        }
        *generation += 1;
        let (activation, serial) = (Stamp::default(), self.created);
        *holds = Holds::Object(Entry { first_proxy, piece_count, activation, serial, arrangement: None });
        self.count += 1;
        self.created += 1;
        Ok(ObjectId::new(slot, *generation, self.scene))
    }

    /// Room for so many objects more, after which there are `rows` rows.
    ///
    /// # Errors
    /// [`Error::Limit`] when there are not as many ids left, [`Error::Memory`].
    pub(crate) fn reserve(&mut self, count: usize, rows: usize) -> Result<()> {
        if rows > MOST_PROXIES {
            return Err(Error::Limit(format!("a scene holds at most {MOST_PROXIES} pieces")));
        }
        let (mut new, mut free) = (count, self.free);
        while new > 0
            && let Some(Slot { holds: Holds::Nothing { next }, .. }) = self.slots.get(free as usize)
        {
            (new, free) = (new - 1, *next);
        }
        if self.slots.len() + new > 1 << SLOT_BITS {
            return Err(Error::Limit(format!("a scene holds at most {} objects", 1 << SLOT_BITS)));
        }
        reserve_sparingly(&mut self.slots, new)
    }

    /// The next to be used.
    fn empty_slot(&mut self) -> Result<usize> {
        if self.free == NONE {
            if self.slots.len() == 1 << SLOT_BITS {
                return Err(Error::Limit(format!("a scene holds at most {} objects", 1 << SLOT_BITS)));
            }
            reserve_sparingly(&mut self.slots, 1)?;
            self.free = self.slots.len() as u32;
            self.slots.push(Slot { generation: 0, holds: Holds::Nothing { next: NONE } });
        }
        Ok(self.free as usize)
    }

    /// Removes an object; its id is stale from now on.
    ///
    /// # Errors
    /// [`Error::Handle`] as [`ObjectTable::get`].
    pub(crate) fn remove(&mut self, id: ObjectId) -> Result<()> {
        self.get(id)?;
        self.count -= 1;
        let Slot { generation, holds } = &mut self.slots[id.slot()];
        *holds = Holds::Nothing { next: self.free };
        if *generation < LAST_GENERATION {
            self.free = id.slot() as u32;
        }
        Ok(())
    }

    /// The object of an id.
    ///
    /// # Errors
    /// [`Error::Handle`] for an id that is null, stale or another scene's.
    #[inline]
    pub(crate) fn get(&self, id: ObjectId) -> Result<&Entry> {
        match self.slots.get(id.slot()) {
            Some(Slot { generation, holds: Holds::Object(entry) }) if self.is_id(id, *generation) => Ok(entry),
            _ => Err(self.refusal(id)),
        }
    }

    /// As [`ObjectTable::get`], for changing it.
    #[inline(always)]
    pub(crate) fn get_mut(&mut self, id: ObjectId) -> Result<&mut Entry> {
        // The shared borrow ends before the exclusive one begins; a match on the exclusive one would hold it too long.
        self.get(id)?;
        match &mut self.slots[id.slot()].holds {
            Holds::Object(entry) => Ok(entry),
            Holds::Nothing { .. } => Err(Error::Bug(format!("object id {id} has no object"))),
        }
    }

    /// The rows of an object; for one that is gone there are none.
    pub(crate) fn rows_of(&self, id: ObjectId) -> Range<usize> {
        self.get(id).map_or(0..0, Entry::proxies)
    }

    /// Whether an id is that of the object in its slot, which has this generation.
    fn is_id(&self, id: ObjectId, generation: u32) -> bool {
        (id.generation(), id.scene()) == (generation, self.scene)
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

    /// Numbers the proxies anew: number k of old becomes `numbers[k]`.
    pub(crate) fn renumber(&mut self, numbers: &[u32]) {
        for slot in &mut self.slots {
            if let Holds::Object(entry) = &mut slot.holds {
                entry.first_proxy = numbers[entry.first_proxy as usize];
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

    /// A table with `count` objects of a piece each.
    fn table(count: usize) -> (ObjectTable, Vec<ObjectId>) {
        let mut table = ObjectTable::new();
        let ids = (0..count).map(|_| insert(&mut table)).collect();
        (table, ids)
    }

    fn insert(table: &mut ObjectTable) -> ObjectId {
        let row = table.len();
        table.insert(row..row + 1).unwrap()
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
            assert!(table.get(id).is_ok());
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
    fn slots_are_used_again_the_one_emptied_last_first() {
        let (mut table, ids) = table(4);
        for k in [0, 2, 1] {
            table.remove(ids[k]).unwrap();
        }
        for k in [1, 2, 0] {
            let again = insert(&mut table);
            assert_eq!(again.slot(), ids[k].slot());
            assert_ne!(again, ids[k]);
            assert!(message(&table, ids[k]).contains("stale"));
        }
        assert_eq!((insert(&mut table).slot(), table.len(), table.created()), (4, 5, 8));
    }

    #[test]
    fn an_object_without_pieces_is_refused() {
        let mut table = ObjectTable::new();
        assert!(matches!(table.insert(3..3), Err(Error::Argument(_))));
        assert_eq!((table.len(), insert(&mut table).slot()), (0, 0));
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
