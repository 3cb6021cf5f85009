//! A recording done again, step by step, and its answers checked.

use std::collections::HashMap;
use std::io::Read;
use std::path::Path;
use std::sync::{Arc, Mutex};

use crate::base::error::{Error, Result};
use crate::base::files::open_to_read;
use crate::base::locks::locked;
use crate::base::math::Pose;
use crate::base::memory::{lacking, push, with_capacity};
use crate::compound::{Compound, Piece};
use crate::ground::Ground;
use crate::pair::Query;
use crate::scene::change::{Change, RecordedNames, Rename, Themselves};
use crate::scene::door::Scene;
use crate::scene::recording::digest::Digest;
use crate::scene::recording::format::{Record, RecordedDecision};
use crate::scene::recording::reader::{NextRecord, RecordReader};
use crate::scene::search::query::{PlacedBody, SceneAnswer, SceneQuery, Subject};
use crate::scene::world::object::ObjectId;
use crate::scene::world::testing::PairFilter;
use crate::shape::Shape;

/// Repeats a [recording](Scene::record) of a scene.
///
/// A step is the changes up to a query, and the query. [`Replay::read`] reads one, [`Replay::change`] makes its changes,
/// [`Replay::ask`] makes its query; a program may make others instead, of the scene itself. A file of any content is safe: it is
/// an error, or does to the scene what a program could.
///
/// ```no_run
/// use swiftprox::scene::{Replay, Scene};
///
/// let mut replay = Replay::open("crash.swiftprox".as_ref())?;
/// let mut scene = Scene::new();
/// while let Some(step) = replay.read()? {
///     replay.change(&mut scene)?;
///     if step.query.is_some() {
///         replay.ask(&mut scene, None)?.check?;
///     }
/// }
/// # Ok::<(), swiftprox::error::Error>(())
/// ```
#[derive(Debug)]
pub struct Replay {
    reader: RecordReader,
    /// Bytes of the whole recording; 0 where it is not known.
    length: u64,
    is_whole: bool,
    shapes: Vec<Arc<Shape>>,
    grounds: Vec<Arc<Ground>>,
    compounds: Vec<Arc<Compound>>,
    /// All objects that there ever were, by number.
    ids: Vec<ObjectId>,
    decisions: Arc<Mutex<Decisions>>,
    /// The changes of the step that was read, until it is done.
    changes: Vec<Record<'static>>,
    decided: Vec<RecordedDecision>,
    question: Option<ReplayQuestion>,
    /// The first record of the next step.
    ahead: Option<Record<'static>>,
    state: ReplayState,
}

#[derive(Debug, Clone, PartialEq)]
enum ReplayState {
    /// There may be more to read.
    Reading,
    /// The recording was ended.
    Ended,
    /// The program that was recorded was.
    CutOff,
    /// It is damaged from here on, or cannot be done.
    Failed(Error),
}

#[derive(Debug, Clone)]
struct ReplayQuestion {
    subject: Subject<'static, u32, u32>,
    kind: Query,
    query: SceneQuery,
    outcome: Recorded,
}

/// The outcome of a question.
#[derive(Debug, Clone, Copy)]
enum Recorded {
    /// It ended the program, or the recording.
    Nothing,
    Failure,
    Answer(Digest),
}

/// The recorded filter's decisions since it was set or asked anew.
#[derive(Debug, Default)]
struct Decisions {
    known: HashMap<[ObjectId; 2], bool>,
    /// It was asked of a pair that is not known.
    has_guessed: bool,
}

/// A step that was read.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ReplayStep {
    /// Its query, and what that was asked for; none of a query that was refused, and at the end of the recording.
    pub query: Option<(Query, SceneQuery)>,
    /// How much of the recording is read, from 0 to 1; NaN where its length is not known.
    pub fraction: f64,
}

/// The answer to a recorded query.
#[derive(Debug, Clone, PartialEq)]
pub struct ReplayAnswer<'a> {
    /// As of the query itself; for one about events, the pairs of pieces that are near.
    pub answer: SceneAnswer<'a>,
    /// Whether it gives the same result as the recorded one: the same pairs are listed, with the same outcomes, and the sums of
    /// lower ends and upper ends are those of intervals that have a number in common. That holds wherever a recording is
    /// replayed, except for queries with a step budget, whose answers are not checked. Else [`Error::Unverified`] reports the
    /// difference.
    pub check: Result<()>,
    /// Whether its distances, intervals, points, normals and depths are bit for bit the recorded ones. They need not be with
    /// another version of the library, on another processor, or where the recording began in the middle of the scene's life.
    pub is_identical: bool,
}

impl Replay {
    /// From a file that [`Scene::record`] has written.
    ///
    /// # Errors
    /// [`Error::File`] if it cannot be read, is no regular file, no recording or one of another version; [`Error::Memory`].
    pub fn open(path: &Path) -> Result<Replay> {
        let name = path.display().to_string();
        let (file, length) = open_to_read(path, &name)?;
        Replay::begin(Box::new(std::io::BufReader::new(file)), name, length)
    }

    /// From any source of the bytes of a recording.
    ///
    /// # Errors
    /// As [`Replay::open`].
    pub fn from_reader(source: impl Read + Send + Sync + 'static) -> Result<Replay> {
        Replay::begin(Box::new(source), "the recording".into(), 0)
    }

    fn begin(source: Box<dyn Read + Send + Sync>, name: String, length: u64) -> Result<Replay> {
        let mut reader = RecordReader::new(source, name)?;
        let start = reader.position();
        let is_whole = match reader.next()? {
            NextRecord::Record(Record::Scene { is_whole }) => is_whole,
            NextRecord::Record(_) => return Err(reader.damaged(start, "the first one is not about the scene")),
            NextRecord::CutOff => return Err(reader.damaged(start, "it is cut off")),
        };
        Ok(Replay {
            reader,
            length,
            is_whole,
            shapes: Vec::new(),
            grounds: Vec::new(),
            compounds: Vec::new(),
            ids: Vec::new(),
            decisions: Arc::default(),
            changes: Vec::new(),
            decided: Vec::new(),
            question: None,
            ahead: None,
            state: ReplayState::Reading,
        })
    }

    /// Whether the scene was recorded from its beginning.
    pub fn is_whole(&self) -> bool {
        self.is_whole
    }

    /// Whether the data ends before the recording was ended, for instance because the recorded program was.
    pub fn is_cut_off(&self) -> bool {
        self.state == ReplayState::CutOff
    }

    // --- Reading -----------------------------------------------------------------------------------------------------------------

    /// Reads the next step; `None` when there is none. A recording that is cut off ends with its last whole record.
    ///
    /// # Errors
    /// [`Error::File`] for a recording that is damaged: the steps before stay good, the message says where it is.
    /// [`Error::Memory`]. [`Error::Argument`] if the step before has not been done.
    pub fn read(&mut self) -> Result<Option<ReplayStep>> {
        if !self.changes.is_empty() || !self.decided.is_empty() {
            return Err(Error::Argument("the step that was read before has not been done".into()));
        }
        self.question = None;
        if let ReplayState::Failed(error) = &self.state {
            return Err(error.clone());
        }
        if let Err(error) = self.read_step() {
            (self.changes, self.decided, self.question) = (Vec::new(), Vec::new(), None);
            self.state = ReplayState::Failed(error.clone());
            return Err(error);
        }
        if self.changes.is_empty() && self.question.is_none() {
            return Ok(None);
        }
        let is_asked = |question: &ReplayQuestion| !matches!(question.outcome, Recorded::Failure);
        let query = self
            .question
            .as_ref()
            .filter(|question| is_asked(question))
            .map(|question| (question.kind, question.query));
        let fraction = if self.length > 0 { self.reader.position() as f64 / self.length as f64 } else { f64::NAN };
        Ok(Some(ReplayStep { query, fraction }))
    }

    fn read_step(&mut self) -> Result<()> {
        while let Some((start, record)) = self.next_record()? {
            match (record, &mut self.question) {
                (Record::Shape(shape), _) => push(&mut self.shapes, shape)?,
                (Record::Ground(ground), _) => push(&mut self.grounds, ground)?,
                (Record::Compound(pieces), _) => self.add_compound(&pieces)?,
                (Record::Question { subject, kind, query }, None) => {
                    self.question = Some(ReplayQuestion { subject, kind, query, outcome: Recorded::Nothing });
                }
                (Record::Decisions(decisions), None) => push(&mut self.changes, Record::Decisions(decisions))?,
                (Record::Decisions(decisions), Some(_)) => self.decided = decisions.into_owned(),
                (Record::Answer(digest), Some(question)) => {
                    question.outcome = Recorded::Answer(digest);
                    return Ok(());
                }
                (Record::Failed, Some(question)) => {
                    question.outcome = Recorded::Failure;
                    return Ok(());
                }
                (Record::Answer(_) | Record::Failed, None) => {
                    return Err(self.reader.damaged(start, "an answer without a question"));
                }
                (Record::Scene { .. }, _) => return Err(self.reader.damaged(start, "a scene within a scene")),
                // A question without an answer ended the program.
                (record, Some(_)) => {
                    self.ahead = Some(record);
                    return Ok(());
                }
                (record, None) => push(&mut self.changes, record)?,
            }
        }
        Ok(())
    }

    /// A compound of shapes that were read before.
    fn add_compound(&mut self, pieces: &[(u32, Pose)]) -> Result<()> {
        let mut known = with_capacity(pieces.len())?;
        for (number, pose) in pieces {
            known.push(Piece { shape: shape(&self.shapes, *number)?.clone(), pose: *pose });
        }
        let made = Compound::new(&known).map_err(|error| error.unless_memory(|error| self.reader.refused(error)))?;
        push(&mut self.compounds, Arc::new(made))
    }

    /// The next record and where it begins.
    fn next_record(&mut self) -> Result<Option<(u64, Record<'static>)>> {
        let start = self.reader.position();
        if let Some(record) = self.ahead.take() {
            return Ok(Some((start, record)));
        }
        if self.state != ReplayState::Reading {
            return Ok(None);
        }
        match self.reader.next()? {
            NextRecord::Record(Record::End) => self.state = ReplayState::Ended,
            NextRecord::CutOff => self.state = ReplayState::CutOff,
            NextRecord::Record(record) => return Ok(Some((start, record))),
        }
        Ok(None)
    }

    // --- Doing -------------------------------------------------------------------------------------------------------------------

    /// Makes the changes of the step that was read, except its query.
    ///
    /// # Errors
    /// [`Error::File`] for a recording that the scene refuses: it is another scene, or a damaged recording. It cannot be
    /// continued. [`Error::Memory`].
    pub fn change(&mut self, scene: &mut Scene) -> Result<()> {
        let (changes, decided) = (std::mem::take(&mut self.changes), std::mem::take(&mut self.decided));
        let done = changes.into_iter().try_for_each(|record| self.change_one(scene, record));
        let done = done.and_then(|()| self.learn(scene, &decided));
        done.map_err(|error| {
            let refused = error.unless_memory(|error| self.reader.refused(error));
            self.state = ReplayState::Failed(refused.clone());
            refused
        })
    }

    fn change_one(&mut self, scene: &mut Scene, record: Record) -> Result<()> {
        match record {
            Record::Change(change) => {
                if let Change::Filter(_) | Change::FilterAgain = change {
                    locked(&self.decisions).known.clear();
                }
                let Replay { shapes, grounds, compounds, ids, decisions, .. } = self;
                let change = change.renamed(&mut KnownObjects { shapes, grounds, compounds, ids, decisions })?;
                scene.change(change)?.map_or(Ok(()), |id| push(&mut self.ids, id))
            }
            Record::Decisions(decisions) => self.learn(scene, &decisions),
            // The others are no changes.
            Record::End
            | Record::Scene { .. }
            | Record::Shape(_)
            | Record::Ground(_)
            | Record::Compound(_)
            | Record::Question { .. }
            | Record::Answer(_)
            | Record::Failed => Ok(()),
        }
    }

    /// Takes the decisions of the recorded filter.
    fn learn(&self, scene: &mut Scene, decisions: &[RecordedDecision]) -> Result<()> {
        let mut all = locked(&self.decisions);
        for RecordedDecision { pair: [object1, object2], is_tested } in decisions {
            let pair = [id(&self.ids, *object1)?, id(&self.ids, *object2)?];
            let count = all.known.len() + 1;
            all.known.try_reserve(1).map_err(|e| lacking::<([ObjectId; 2], bool)>(count, &e))?;
            all.known.insert(pair, *is_tested);
        }
        // Pairs may be near here that were not there, and the other way round: all is asked anew once more is known.
        if !decisions.is_empty() && std::mem::take(&mut all.has_guessed) {
            drop(all);
            scene.filter_again();
        }
        Ok(())
    }

    /// Makes the query of the step that was read and done, and holds the answer against the recorded one. With a distance tolerance
    /// of the caller's it is another query, whose answer is not checked.
    ///
    /// # Errors
    /// Those of the query. [`Error::Argument`] if there is none, or the step is not done.
    pub fn ask<'a>(&mut self, scene: &'a mut Scene, tolerance: Option<f64>) -> Result<ReplayAnswer<'a>> {
        let is_open = self.changes.is_empty() && self.decided.is_empty();
        let Some(ReplayQuestion { subject, kind, mut query, outcome }) = self.question.clone().filter(|_| is_open)
        else {
            return Err(Error::Argument("the step has no query, or has not been done".into()));
        };
        query.max_distance = tolerance.unwrap_or(query.max_distance);
        match subject {
            Subject::AllPairs => scene.ask(&Subject::AllPairs, kind, &query).map(drop)?,
            Subject::Object(object) => scene.query_object(id(&self.ids, object)?, kind, &query).map(drop)?,
            Subject::Placed(PlacedBody { pieces, mask }) => {
                let mut known = Vec::new();
                pieces.iter().try_for_each(|(k, pose)| push(&mut known, (shape(&self.shapes, *k)?.clone(), *pose)))?;
                scene.ask(&Subject::Placed(PlacedBody { pieces: known.into(), mask }), kind, &query).map(drop)?;
            }
            Subject::Events => scene.query_events(query.max_distance).map(drop)?,
        }
        let scene = &*scene;
        let answer = scene.search.answer();
        let name = |id| (self.number(scene, id).unwrap_or(u32::MAX), scene.world.is_compound(id));
        let digest = Digest::of(&answer, &query, name);
        let (Recorded::Answer(recorded), None) = (outcome, tolerance) else {
            return Ok(ReplayAnswer { answer, check: Ok(()), is_identical: false });
        };
        let check = if query.step_budget == u32::MAX { digest.check(&recorded) } else { Ok(()) };
        Ok(ReplayAnswer { answer, check, is_identical: digest.is(&recorded) })
    }

    /// The number of an object of the scene: how many there were before it in the recording.
    ///
    /// # Errors
    /// [`Error::Handle`] for an id that is null, stale or another scene's.
    pub fn number(&self, scene: &Scene, id: ObjectId) -> Result<u32> {
        Ok(scene.world.objects.get(id)?.serial() as u32)
    }
}

impl Decisions {
    fn say(&mut self, pair: [ObjectId; 2]) -> bool {
        let said = self.known.get(&pair).copied();
        self.has_guessed |= said.is_none();
        said.unwrap_or(true)
    }
}

/// The values that a replay has for the numbers of a recording.
struct KnownObjects<'a> {
    shapes: &'a [Arc<Shape>],
    grounds: &'a [Arc<Ground>],
    compounds: &'a [Arc<Compound>],
    ids: &'a [ObjectId],
    decisions: &'a Arc<Mutex<Decisions>>,
}

impl Rename<RecordedNames, Themselves> for KnownObjects<'_> {
    fn object(&mut self, object: u32) -> Result<ObjectId> {
        id(self.ids, object)
    }

    fn shape(&mut self, number: &u32) -> Result<Arc<Shape>> {
        shape(self.shapes, *number).cloned()
    }

    fn ground(&mut self, number: &u32) -> Result<Arc<Ground>> {
        let absent = || Error::File(format!("ground {number} of {}", self.grounds.len()));
        self.grounds.get(*number as usize).cloned().ok_or_else(absent)
    }

    fn compound(&mut self, number: &u32) -> Result<Arc<Compound>> {
        let absent = || Error::File(format!("compound {number} of {}", self.compounds.len()));
        self.compounds.get(*number as usize).cloned().ok_or_else(absent)
    }

    fn filter(&mut self, (): &()) -> PairFilter {
        let decisions = self.decisions.clone();
        PairFilter::new(move |object1, object2| locked(&decisions).say([object1, object2]))
    }
}

fn id(ids: &[ObjectId], number: u32) -> Result<ObjectId> {
    let absent = || Error::File(format!("object {number} of {}", ids.len()));
    ids.get(number as usize).copied().ok_or_else(absent)
}

fn shape(shapes: &[Arc<Shape>], number: u32) -> Result<&Arc<Shape>> {
    let absent = || Error::File(format!("shape {number} of {}", shapes.len()));
    shapes.get(number as usize).ok_or_else(absent)
}
