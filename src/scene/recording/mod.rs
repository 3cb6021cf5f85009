//! A record of each change to a scene and each query, written as it is made: a bug report and a benchmark in one file.
//!
//! A recording begins with eight bytes that give its type and version. Records follow, all numbers little-endian:
//!
//! | bytes | what |
//! |---|---|
//! | 4 | the kind |
//! | 4 | n, the length of the content |
//! | 4 | the lower half of the checksum of all bytes before |
//! | n | the content |
//! | 8 | the checksum of all bytes before |
//!
//! Checksums go on from record to record, so that one that is changed, lost or moved is found, and the checksum of a head is
//! looked at before its length is believed. The last record tells that the recording was ended; without it the program was.
//!
//! Objects are numbered in order of creation, those that there were when the recording began first. Shapes are numbered, too, and
//! stand in the recording as in a file of their own ([`shape::file`](crate::shape::file)); so do grounds, as heights or triangles,
//! and compounds, by the numbers and poses of their pieces.
//! A question is written and handed to the system before it is answered: one that ends the program is the last record.

pub(crate) mod digest;
pub(crate) mod format;
pub(crate) mod recorder;
pub(crate) mod reader;

use std::io::Write;
use std::sync::Arc;

use crate::base::error::{Error, Result};
use crate::base::memory::{collected, push};
use crate::compound::Compound;
use crate::ground::Ground;
use crate::pair::Query;
use crate::scene::change::{Change, RecordedNames, Rename, Themselves};
use crate::scene::search::query::{PlacedBody, SceneAnswer, SceneQuery, Subject};
use crate::scene::world::activation::Word;
use crate::scene::world::content::{DEFAULT_KEPT_PAIRS, World};
use crate::scene::world::object::{ObjectId, ObjectTable};
use crate::scene::world::testing::{Decided, PairFilter};
use crate::shape::Shape;
use digest::Digest;
use format::{Record, RecordedDecision};
use recorder::Recorder;

/// Whether what is done to a scene is written down.
#[derive(Debug, Default)]
pub(crate) enum Recording {
    #[default]
    Off,
    On(Box<Recorder>),
    /// It ended early, and nobody has ended it yet.
    Failed(Error),
}

impl Recording {
    /// Begins with the content of a scene, whose filter has decided so about the pairs that are near.
    ///
    /// # Errors
    /// See [`Scene::record`](crate::scene::Scene::record).
    pub fn begin(
        sink: Box<dyn Write + Send + Sync>,
        name: String,
        world: &World,
        decided: &[Decided],
    ) -> Result<Recording> {
        let serials = collected(world.view().iter().map(|object| object.entry.serial()))?;
        let mut recorder = Recorder::new(sink, name, serials, world.objects.created())?;
        let written = write_world(&mut recorder, world).and_then(|()| {
            write_decisions(&mut Numbering { recorder: &mut recorder, objects: &world.objects }, decided)
        });
        if let Err(error) = written {
            recorder.give_up();
            return Err(error);
        }
        Ok(Recording::On(Box::new(recorder)))
    }

    pub fn is_on(&self) -> bool {
        matches!(self, Recording::On(_))
    }

    /// Why it ended early.
    pub fn failure(&self) -> Option<&Error> {
        if let Recording::Failed(error) = self { Some(error) } else { None }
    }

    /// Ends it, if there is one.
    ///
    /// # Errors
    /// See [`Scene::end_recording`](crate::scene::Scene::end_recording).
    pub fn end(&mut self) -> Result<()> {
        self.write(|recorder| recorder.end());
        match std::mem::take(self) {
            Recording::Off | Recording::On(_) => Ok(()),
            Recording::Failed(error) => Err(error),
        }
    }

    /// The records to be written for a change once it has been made: nothing for one that the scene will refuse for its ids.
    #[inline]
    pub fn prepare(
        &mut self,
        change: &Change<Themselves>,
        objects: &ObjectTable,
    ) -> Option<Change<'static, RecordedNames>> {
        let Recording::On(recorder) = self else { return None };
        match change.renamed(&mut Numbering { recorder, objects }) {
            Ok(change) => Some(change),
            Err(Error::Handle(_)) => None,
            Err(error) => {
                self.fail(error);
                None
            }
        }
    }

    /// Writes down a change that was prepared.
    #[inline]
    pub fn note(&mut self, change: Option<Change<RecordedNames>>) {
        if let Some(change) = change {
            self.write(|recorder| recorder.write(&Record::Change(change)));
        }
    }

    /// Writes down a query before it is answered: it outlives the program.
    pub fn question(
        &mut self,
        subject: &Subject<ObjectId, Arc<Shape>>,
        kind: Query,
        query: &SceneQuery,
        objects: &ObjectTable,
    ) {
        self.write(|recorder| {
            let subject = match subject {
                Subject::AllPairs => Subject::AllPairs,
                Subject::Object(id) => Subject::Object(recorder.number(objects.get(*id)?.serial())?),
                Subject::Placed(PlacedBody { pieces, mask }) => {
                    let mut numbered = Vec::new();
                    pieces.iter().try_for_each(|(shape, pose)| push(&mut numbered, (recorder.shape(shape)?, *pose)))?;
                    Subject::Placed(PlacedBody { pieces: numbered.into(), mask: *mask })
                }
                Subject::Events => Subject::Events,
            };
            recorder.write(&Record::Question { subject, kind, query: *query })?;
            recorder.hand_over()
        });
    }

    /// Writes down the decisions of a filter, or why they are not known.
    pub fn decisions(&mut self, decided: Result<Vec<Decided>>, objects: &ObjectTable) {
        self.write(|recorder| write_decisions(&mut Numbering { recorder, objects }, &decided?));
    }

    /// Writes down the answer to the last query; none of one that was refused.
    pub fn answer(&mut self, answer: Option<&SceneAnswer>, query: &SceneQuery, world: &World) {
        self.write(|recorder| {
            let number = |id| {
                let found = world.objects.get(id).and_then(|object| recorder.number(object.serial()));
                (found.unwrap_or(u32::MAX), world.is_compound(id))
            };
            let digest = answer.map(|answer| Digest::of(answer, query, number));
            recorder.write(&digest.map_or(Record::Failed, Record::Answer))
        });
    }

    /// Writes something down, if there is a recording; a record that cannot be written ends it.
    fn write(&mut self, write: impl FnOnce(&mut Recorder) -> Result<()>) {
        if let Recording::On(recorder) = self
            && let Err(error) = write(recorder)
        {
            self.fail(error);
        }
    }

    fn fail(&mut self, error: Error) {
        if let Recording::On(recorder) = self {
            recorder.give_up();
        }
        *self = Recording::Failed(error);
    }
}

/// Numbers for the objects, shapes, grounds and compounds in a scene. All but objects are written down when they first get one.
struct Numbering<'a> {
    recorder: &'a mut Recorder,
    objects: &'a ObjectTable,
}

impl Rename<Themselves, RecordedNames> for Numbering<'_> {
    fn object(&mut self, object: ObjectId) -> Result<u32> {
        self.recorder.number(self.objects.get(object)?.serial())
    }

    fn shape(&mut self, shape: &Arc<Shape>) -> Result<u32> {
        self.recorder.shape(shape)
    }

    fn ground(&mut self, ground: &Arc<Ground>) -> Result<u32> {
        self.recorder.ground(ground)
    }

    fn compound(&mut self, compound: &Arc<Compound>) -> Result<u32> {
        self.recorder.compound(compound)
    }

    fn filter(&mut self, _: &PairFilter) {}
}

/// Writes the state in which a recording begins, except decisions.
fn write_world(recorder: &mut Recorder, world: &World) -> Result<()> {
    let objects = &world.objects;
    recorder.write(&Record::Scene { is_whole: objects.created() == 0 })?;
    let mut write = |change: Change<Themselves>| {
        let change = change.renamed(&mut Numbering { recorder, objects })?;
        recorder.write(&Record::Change(change))
    };
    if world.kept_pair_limit != DEFAULT_KEPT_PAIRS {
        write(Change::KeptPairLimit(world.kept_pair_limit))?;
    }
    for object in world.view().iter() {
        write(match (object.ground(), object.compound()) {
            (Some(ground), _) => Change::Ground { ground: ground.clone(), options: object.options() },
            (_, Some(compound)) => Change::Compound { compound: compound.clone(), options: object.options() },
            _ => Change::Object { pieces: object.pieces().into(), options: object.options() },
        })?;
        for (piece, pose) in (0..).zip(object.piece_poses()) {
            write(Change::PiecePose { object: object.id(), piece, pose: *pose })?;
        }
        for (piece, user_data) in (0..).zip(object.piece_numbers()).filter(|(_, user_data)| **user_data != 0) {
            write(Change::PieceUserData { object: object.id(), piece, user_data: *user_data })?;
        }
    }
    let stamps = world.view().iter().map(|object| (object.id(), object.entry.activation));
    for (word, active) in world.activation.words(stamps)? {
        match word {
            Word::All => write(Change::AllActive(active))?,
            Word::Object(id) => write(Change::ObjectActive(id, active))?,
            // Words on objects removed since are kept for a while.
            Word::Pair(pair) if is_there(objects, &pair) => write(Change::PairActive(pair, active))?,
            Word::Pair(_) => {}
        }
    }
    if let Some(given) = &world.given {
        // Pairs of objects removed since are pairs no more.
        let pairs = collected(given.iter().copied().filter(|pair| is_there(objects, pair)))?;
        write(Change::Pairs(Some(pairs.into())))?;
    }
    if world.filter.is_some() {
        recorder.write(&Record::Change(Change::Filter(Some(()))))?;
    }
    Ok(())
}

fn is_there(objects: &ObjectTable, pair: &[ObjectId; 2]) -> bool {
    pair.iter().all(|id| objects.get(*id).is_ok())
}

fn write_decisions(numbers: &mut Numbering, decided: &[Decided]) -> Result<()> {
    let mut decisions: Vec<RecordedDecision> = Vec::new();
    for ([id1, id2], is_tested) in decided {
        let pair = [numbers.object(*id1)?, numbers.object(*id2)?];
        push(&mut decisions, RecordedDecision { pair, is_tested: *is_tested })?;
    }
    if decisions.is_empty() { Ok(()) } else { numbers.recorder.write(&Record::Decisions(decisions.into())) }
}
