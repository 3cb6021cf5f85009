//! The events for a listener: which pairs and contact points are newly listed since it last asked, which still are, and which are
//! no longer listed. Each listener has its own memory.

use std::cmp::Ordering;

use crate::base::error::{Error, Result};
use crate::base::memory::{extend, push};
use crate::scene::search::query::{PairResult, SceneAnswer, SceneQuery};
use crate::scene::world::content::World;
use crate::scene::world::object::ObjectId;

/// State of a pair or contact point since the listener's last query.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[repr(i32)]
pub enum EventState {
    /// It is listed and was not.
    Began = 1,
    /// It is listed and was.
    Persists = 2,
    /// It was listed and is not.
    Ended = 3,
}

/// The placeholder for a result or a point of an event that has ended: C's SIZE_MAX.
const NO_PLACE: usize = usize::MAX;

/// A pair of convex pieces that is listed, or was when the listener last asked.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[repr(C)]
pub struct PairEvent {
    /// The earlier created object; it may have been removed since where the pair has ended.
    pub object1: ObjectId,
    /// The later created object.
    pub object2: ObjectId,
    /// The caller's own number of object 1; of a pair that has ended the one of then.
    pub user_data1: u64,
    /// The caller's own number of object 2.
    pub user_data2: u64,
    /// The caller's own number of the piece of object 1; as those of the objects.
    pub piece_user_data1: u64,
    /// The caller's own number of the piece of object 2.
    pub piece_user_data2: u64,
    /// Which piece of object 1.
    pub piece1: u32,
    /// Which piece of object 2.
    pub piece2: u32,
    /// State of the two pieces.
    pub state: EventState,
    /// State of the two objects; they are listed if any of their pieces are.
    pub objects_state: EventState,
    /// Its place among the pairs of the answer, and among contacts if they were asked for; SIZE_MAX where it has ended.
    pub result: usize,
    /// Start of its points among all points of the events.
    pub first_point: usize,
    /// How many: those of its contact in their order, and behind them those that are gone.
    pub point_count: usize,
}

/// A contact point that there is, or was when the listener last asked.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[repr(C)]
pub struct PointEvent {
    /// The point's id: within a pair points of equal ids are one for events.
    pub id: u64,
    /// Its place among the points of the contacts; SIZE_MAX where it is gone.
    pub point: usize,
    /// Its state.
    pub state: EventState,
}

/// The events that a listener has received. Owned by the listener until it asks again.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ListenerEvents<'a> {
    /// All pairs that the query lists, and those that were listed and are not, in the scene's order.
    pub pairs: &'a [PairEvent],
    /// Their points, where the query asks for manifolds.
    pub points: &'a [PointEvent],
}

impl<'a> ListenerEvents<'a> {
    /// The points of one of the pairs.
    pub fn points_of(&self, pair: &PairEvent) -> &'a [PointEvent] {
        &self.points[pair.first_point..][..pair.point_count]
    }
}

/// Remembers what its last query of a scene listed. Other listeners do not affect it. When it queries another scene, all pairs of
/// the former one have ended.
#[derive(Debug, Default)]
pub struct Listener {
    was: Listed,
    /// The current listing, until it is compared.
    is: Listed,
    pairs: Vec<PairEvent>,
    points: Vec<PointEvent>,
}

/// Pairs that were listed, and the ids of their points.
#[derive(Debug, Default)]
struct Listed {
    pairs: Vec<ListedPair>,
    /// Those of each pair ascending.
    ids: Vec<u64>,
}

#[derive(Debug, Clone, Copy)]
struct ListedPair {
    /// Its objects' permanent positions in the order of creation.
    serials: [u64; 2],
    objects: [ObjectId; 2],
    user_data: [u64; 2],
    pieces: [u32; 2],
    /// The same, but 0 of a compound with one result, which any piece may be named in.
    keys: [u32; 2],
    piece_user_data: [u64; 2],
    /// The end of its ids; they begin where those of the pair before end.
    ids_end: usize,
}

impl ListedPair {
    /// The scene's order. For objects of two scenes, the serials may be the same.
    fn order(&self, other: &ListedPair) -> Ordering {
        let key = |pair: &ListedPair| (pair.serials, pair.objects.map(ObjectId::to_bits), pair.keys);
        key(self).cmp(&key(other))
    }
}

impl Listed {
    /// Takes the listing of an answer.
    fn take(&mut self, answer: &SceneAnswer, world: &World) -> Result<()> {
        self.pairs.clear();
        self.ids.clear();
        let contacts = answer.contacts;
        let has_contacts = !contacts.contacts.is_empty();
        for (at, result) in answer.pairs.iter().enumerate() {
            let &PairResult { object1, object2, user_data1, user_data2, piece1, piece2, .. } = result;
            let begin = self.ids.len();
            if let Some(contact) = contacts.contacts.get(at) {
                extend(&mut self.ids, contacts.points_of(contact).iter().map(|point| point.id))?;
                self.ids[begin..].sort_unstable();
            }
            let pair = ListedPair {
                serials: [world.objects.get(object1)?.serial(), world.objects.get(object2)?.serial()],
                objects: [object1, object2],
                user_data: [user_data1, user_data2],
                pieces: [piece1, piece2],
                keys: [(object1, piece1), (object2, piece2)]
                    .map(|(id, piece)| if !has_contacts && world.is_compound(id) { 0 } else { piece }),
                piece_user_data: [(object1, piece1), (object2, piece2)]
                    .map(|(object, piece)| world.piece_data.get(object, piece as usize)),
                ids_end: self.ids.len(),
            };
            push(&mut self.pairs, pair)?;
        }
        Ok(())
    }

    /// The ids of the points of the pair at a place.
    fn ids_of(&self, at: usize) -> &[u64] {
        let begin = if at == 0 { 0 } else { self.pairs[at - 1].ids_end };
        &self.ids[begin..self.pairs[at].ids_end]
    }
}

impl Listener {
    /// Refuses queries after which nothing is known of some pairs.
    ///
    /// # Errors
    /// [`Error::Argument`].
    pub(crate) fn check(query: &SceneQuery) -> Result<()> {
        if query.early_exit {
            return Err(Error::Argument("early_exit is set: a listener needs all pairs, not the first".into()));
        }
        Ok(())
    }

    /// Computes the changes, now that the scene answers this.
    ///
    /// # Errors
    /// [`Error::Memory`]; the earlier listing stays remembered, and no events are reported.
    pub(crate) fn hear(&mut self, answer: &SceneAnswer, world: &World) -> Result<()> {
        self.pairs.clear();
        self.points.clear();
        let heard = self.is.take(answer, world).and_then(|()| self.compare(answer));
        if heard.is_err() {
            self.pairs.clear();
            self.points.clear();
            return heard;
        }
        std::mem::swap(&mut self.was, &mut self.is);
        Ok(())
    }

    /// The events of the last query.
    pub fn events(&self) -> ListenerEvents<'_> {
        ListenerEvents { pairs: &self.pairs, points: &self.points }
    }

    /// Goes through both lists, which are in one order.
    fn compare(&mut self, answer: &SceneAnswer) -> Result<()> {
        let (mut old, mut new) = (0, 0);
        loop {
            let order = match (self.was.pairs.get(old), self.is.pairs.get(new)) {
                (Some(was), Some(is)) => was.order(is),
                (Some(_), None) => Ordering::Less,
                (None, Some(_)) => Ordering::Greater,
                (None, None) => break,
            };
            match order {
                Ordering::Less => self.tell_ended(old)?,
                Ordering::Equal => self.tell_listed(answer, Some(old), new)?,
                Ordering::Greater => self.tell_listed(answer, None, new)?,
            }
            old += usize::from(order.is_le());
            new += usize::from(order.is_ge());
        }
        self.tell_of_objects();
        Ok(())
    }

    fn tell_ended(&mut self, old: usize) -> Result<()> {
        let first_point = self.points.len();
        let gone = self.was.ids_of(old).iter().map(|&id| PointEvent::gone(id));
        extend(&mut self.points, gone)?;
        self.tell(self.was.pairs[old], EventState::Ended, NO_PLACE, first_point)
    }

    /// Reports a pair that is listed, and was listed before if it has an old place.
    fn tell_listed(&mut self, answer: &SceneAnswer, old: Option<usize>, new: usize) -> Result<()> {
        let Listener { was, is, points, .. } = self;
        let (before, now) = (old.map_or(&[][..], |old| was.ids_of(old)), is.ids_of(new));
        let first_point = points.len();
        if let Some(contact) = answer.contacts.contacts.get(new) {
            let there = answer.contacts.points_of(contact).iter().zip(contact.first_point..);
            extend(points, there.map(|(point, place)| PointEvent::listed(point.id, place, before)))?;
        }
        let gone = before.iter().filter(|id| now.binary_search(id).is_err());
        extend(points, gone.map(|&id| PointEvent::gone(id)))?;
        let state = if old.is_some() { EventState::Persists } else { EventState::Began };
        self.tell(self.is.pairs[new], state, new, first_point)
    }

    fn tell(&mut self, pair: ListedPair, state: EventState, result: usize, first_point: usize) -> Result<()> {
        let ListedPair { objects: [object1, object2], user_data: [user_data1, user_data2], .. } = pair;
        let ([piece1, piece2], [piece_user_data1, piece_user_data2]) = (pair.pieces, pair.piece_user_data);
        let event = PairEvent {
            object1,
            object2,
            user_data1,
            user_data2,
            piece_user_data1,
            piece_user_data2,
            piece1,
            piece2,
            state,
            objects_state: state,
            result,
            first_point,
            point_count: self.points.len() - first_point,
        };
        push(&mut self.pairs, event)
    }

    /// Pairs of pieces of the same objects are next to each other: if all of them begin or end, the objects do.
    fn tell_of_objects(&mut self) {
        let is_same = |a: &PairEvent, b: &PairEvent| (a.object1, a.object2) == (b.object1, b.object2);
        for pairs in self.pairs.chunk_by_mut(is_same) {
            let first = pairs[0].state;
            let state = if pairs.iter().all(|pair| pair.state == first) { first } else { EventState::Persists };
            pairs.iter_mut().for_each(|pair| pair.objects_state = state);
        }
    }
}

impl PointEvent {
    fn gone(id: u64) -> PointEvent {
        PointEvent { id, point: NO_PLACE, state: EventState::Ended }
    }

    /// `before`: the ids of the pair's points when the listener last asked, ascending.
    fn listed(id: u64, point: usize, before: &[u64]) -> PointEvent {
        debug_assert!(before.is_sorted());
        let state = if before.binary_search(&id).is_ok() { EventState::Persists } else { EventState::Began };
        PointEvent { id, point, state }
    }
}
