//! What is done to a scene, written down as it is done: a bug report and a benchmark in one file.
//!
//! A recording begins with eight bytes that say what it is and a version. Records follow, all numbers little-endian:
//!
//! | bytes | what |
//! |---|---|
//! | 4 | the kind |
//! | 4 | n, the length of the content |
//! | 4 | the lower half of the checksum of all bytes before |
//! | n | the content |
//! | 8 | the checksum of all bytes before |
//!
//! Checksums go on from record to record, so that one that is changed, lost or moved is found, and the checksum of a head is looked
//! at before its length is believed. The last record says that the recording was ended; without it the program was.
//!
//! Objects are numbered in order of creation, those that there were when the recording began first. Shapes are numbered, too, and
//! stand in the recording as in a file of their own ([`shape::file`](crate::shape::file)). A question is written and handed to the
//! system before it is answered: one that ends the program is the last record.

pub(crate) mod digest;
pub(crate) mod format;
pub(crate) mod recorder;
pub(crate) mod reader;

use std::io::Write;
use std::path::Path;
use std::sync::Arc;

use super::Scene;
use crate::base::error::{Error, Result};
use crate::base::files;
use crate::base::memory::{collected, push};
use crate::pair::Query;
use crate::scene::activation::Word;
use crate::scene::broad_phase::near_pairs::Testing;
use crate::scene::object::ObjectId;
use crate::scene::object_view::Objects;
use crate::scene::query::{SceneAnswer, SceneQuery};
use crate::shape::Shape;
use digest::Digest;
use format::{Decision, Record, Subject};
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

/// What a record is made with.
pub(crate) struct Notes<'a> {
    recorder: &'a mut Recorder,
    objects: Objects<'a>,
}

impl Notes<'_> {
    pub fn write(&mut self, record: &Record) -> Result<()> {
        self.recorder.write(record)
    }

    /// The number of an object that is there.
    pub fn number(&self, id: ObjectId) -> Result<u32> {
        self.recorder.number(self.objects.get(id)?.entry.serial())
    }

    pub fn numbers(&self, ids: &[ObjectId]) -> Result<Vec<u32>> {
        let mut numbers = Vec::new();
        ids.iter().try_for_each(|id| push(&mut numbers, self.number(*id)?))?;
        Ok(numbers)
    }

    fn pairs(&self, pairs: &[[ObjectId; 2]]) -> Result<Vec<[u32; 2]>> {
        let mut numbers = Vec::new();
        // Pairs of objects removed since are pairs no more.
        for [id1, id2] in pairs {
            if let (Ok(number1), Ok(number2)) = (self.number(*id1), self.number(*id2)) {
                push(&mut numbers, [number1, number2])?;
            }
        }
        Ok(numbers)
    }

    fn shape(&mut self, shape: &Arc<Shape>) -> Result<u32> {
        self.recorder.shape(shape)
    }

    pub fn object(&mut self, id: ObjectId) -> Result<()> {
        let object = self.objects.get(id)?;
        let mut pieces = Vec::new();
        object.pieces().iter().try_for_each(|piece| push(&mut pieces, self.shape(piece)?))?;
        self.write(&Record::Object { pieces: pieces.into(), options: object.options() })
    }

    pub fn given(&mut self, pairs: Option<&[[ObjectId; 2]]>) -> Result<()> {
        let pairs = pairs.map(|pairs| self.pairs(pairs)).transpose()?;
        self.write(&Record::Pairs(pairs.map(Into::into)))
    }

    fn decisions(&mut self, decisions: &[([ObjectId; 2], bool)]) -> Result<()> {
        let mut numbered: Vec<Decision> = Vec::new();
        for ([id1, id2], tested) in decisions {
            push(&mut numbered, Decision { pair: [self.number(*id1)?, self.number(*id2)?], is_tested: *tested })?;
        }
        if numbered.is_empty() { Ok(()) } else { self.write(&Record::Decisions(numbered.into())) }
    }
}

impl Scene {
    /// Writes down what is done to the scene from now on, in a file, replacing what was there, until [`Scene::end_recording`] or
    /// the scene's end. First comes what the scene holds. A [`Replay`](crate::scene::Replay) does it all again.
    ///
    /// All that changes what queries answer is written down, and each query with a digest of its answer; [workers](Workers) and
    /// statistics are not. Of a [pair filter](PairFilter) its decisions are. Shapes are written down once each. The file is
    /// brought up to date before each query. Where it cannot be written the recording ends; the scene goes on, and
    /// [`Scene::end_recording`] says why.
    ///
    /// What pairs remember from before is not written down. So the answers of a replay are bit for bit those of the scene only if
    /// it was recorded from its beginning, before its first object.
    ///
    /// [Workers]: crate::scene::Workers
    /// [PairFilter]: crate::scene::PairFilter
    ///
    /// # Errors
    /// [`Error::File`] if the file cannot be written or is no regular file, [`Error::Memory`]; what [`Scene::end_recording`] says
    /// of a recording that is going on, which ends. The scene is not recorded then.
    pub fn record(&mut self, path: &Path) -> Result<()> {
        self.end_recording()?;
        let file = files::create(path)?;
        self.begin_recording(Box::new(file), path.display().to_string())
    }

    /// As [`Scene::record`], to whatever takes bytes.
    ///
    /// # Errors
    /// As [`Scene::record`].
    pub fn record_to(&mut self, sink: impl Write + Send + Sync + 'static) -> Result<()> {
        self.end_recording()?;
        self.begin_recording(Box::new(sink), "the recording".into())
    }

    /// Ends the recording, if there is one.
    ///
    /// # Errors
    /// [`Error::File`], [`Error::Memory`], [`Error::Limit`] for the reason why it ended before or cannot be written to its end:
    /// what was done up to there can be replayed.
    pub fn end_recording(&mut self) -> Result<()> {
        self.note(|notes| notes.recorder.end());
        self.filter_is_watched(false);
        match std::mem::take(&mut self.recording) {
            Recording::Off | Recording::On(_) => Ok(()),
            Recording::Failed(error) => Err(error),
        }
    }

    /// Whether what is done to the scene is written down: a recording was begun, and nothing has ended it.
    pub fn is_recording(&self) -> bool {
        matches!(self.recording, Recording::On(_))
    }

    /// Why the recording ended early.
    pub(crate) fn recording_failure(&self) -> Option<&Error> {
        if let Recording::Failed(error) = &self.recording { Some(error) } else { None }
    }

    fn begin_recording(&mut self, sink: Box<dyn Write + Send + Sync>, name: String) -> Result<()> {
        let serials = collected(self.objects().map(|object| object.entry.serial()))?;
        let recorder = Recorder::new(sink, name, serials, self.objects.created())?;
        self.recording = Recording::On(Box::new(recorder));
        self.note_all();
        match self.recording_failure() {
            Some(_) => self.end_recording(),
            None => {
                self.filter_is_watched(true);
                Ok(())
            }
        }
    }

    /// Writes something down, if the scene is recorded; what cannot be written ends the recording.
    #[inline]
    pub(super) fn note(&mut self, write: impl FnOnce(&mut Notes) -> Result<()>) {
        let objects = Objects { table: &self.objects, proxies: &self.proxies };
        if let Recording::On(recorder) = &mut self.recording
            && let Err(error) = write(&mut Notes { recorder, objects })
        {
            recorder.give_up();
            self.recording = Recording::Failed(error);
            self.filter_is_watched(false);
        }
    }

    // Questions and answers.

    /// A query that is to be answered.
    pub(super) fn note_question(&mut self, subject: &Subject<ObjectId, &Arc<Shape>>, kind: Query, query: &SceneQuery) {
        self.note(|notes| {
            let subject = match subject {
                Subject::AllPairs => Subject::AllPairs,
                Subject::Object(id) => Subject::Object(notes.number(*id)?),
                Subject::Placed(shape, pose) => Subject::Placed(notes.shape(shape)?, *pose),
                Subject::Events => Subject::Events,
            };
            notes.write(&Record::Question { subject, kind, query: *query })?;
            notes.recorder.hand_over()
        });
    }

    /// What came of it; `stopped` says that it stopped at the last result, `None` that it failed.
    pub(super) fn note_answer(&mut self, stopped: Option<bool>) {
        self.note_decisions();
        if !self.is_recording() {
            return;
        }
        let digest = stopped.map(|stopped| self.digest(stopped));
        self.note(|notes| notes.write(&digest.map_or(Record::Failed, Record::Answer)));
    }

    /// What the filter has decided since the last time.
    pub(super) fn note_decisions(&mut self) {
        if let Some(decisions) = self.filter.as_mut().and_then(|filter| filter.decided()) {
            self.note(|notes| notes.decisions(&decisions?));
        }
    }

    fn digest(&self, stopped: bool) -> Digest {
        let answer = self.said(stopped);
        let Recording::On(recorder) = &self.recording else { return Digest::of(&answer, |_| u32::MAX) };
        let number = |id| self.objects.get(id).and_then(|object| recorder.number(object.serial()));
        Digest::of(&answer, |id| number(id).unwrap_or(u32::MAX))
    }

    /// What the last search found.
    pub(super) fn said(&self, stopped: bool) -> SceneAnswer<'_> {
        let (results, intersecting) = (self.findings.results(), self.findings.intersecting);
        let pairs = if stopped { &[] } else { results };
        let (found, contacts) = (if stopped { results.last() } else { None }, self.findings.contacts.view());
        SceneAnswer { intersecting, pairs, found, contacts }
    }

    // What there is when a recording begins.

    fn note_all(&mut self) {
        let (rotation_limit, is_whole) = (self.rotation_limit, self.objects.created() == 0);
        self.note(|notes| notes.write(&Record::Scene { rotation_limit, is_whole }));
        self.note(|notes| {
            for object in notes.objects.iter() {
                notes.object(object.id())?;
                let number = notes.number(object.id())?;
                for (piece, pose) in (0..).zip(object.piece_poses()) {
                    notes.write(&Record::PiecePose { object: number, piece, pose: *pose })?;
                }
            }
            Ok(())
        });
        let (activation, given) = (std::mem::take(&mut self.activation), self.given.take());
        self.note(|notes| {
            let stamps = notes.objects.iter().map(|object| (object.id(), object.entry.activation));
            for (word, active) in activation.words(stamps)? {
                match word {
                    Word::All => notes.write(&Record::AllActive(active))?,
                    Word::Object(id) => notes.write(&Record::ObjectActive(notes.number(id)?, active))?,
                    // Of objects removed since they are kept for a while.
                    Word::Pair(pair) => notes
                        .pairs(&[pair])?
                        .iter()
                        .try_for_each(|pair| notes.write(&Record::PairActive(*pair, active)))?,
                }
            }
            if given.is_some() { notes.given(given.as_deref()) } else { Ok(()) }
        });
        (self.activation, self.given) = (activation, given);
        if self.filter.is_some() {
            self.note(|notes| notes.write(&Record::Filter(true)));
            let decided = self.near_decisions();
            self.note(|notes| notes.decisions(&decided?));
        }
    }

    /// What the filter has said of the pairs that are near.
    fn near_decisions(&self) -> Result<Vec<([ObjectId; 2], bool)>> {
        let mut decisions = Vec::new();
        for pair in &self.broad_phase.near.pairs {
            let ids = pair.proxies.map(|proxy| self.proxies.labels[proxy as usize].object);
            if ids.iter().all(|id| self.objects.get(*id).is_ok()) {
                push(&mut decisions, (ids, pair.testing != Testing::Rejected))?;
            }
        }
        Ok(decisions)
    }

    pub(super) fn filter_is_watched(&mut self, watched: bool) {
        if let Some(filter) = &mut self.filter {
            filter.watch(watched);
        }
    }
}
