//! Records: their kinds, and what each holds.

use std::borrow::Cow;
use std::sync::Arc;

use crate::base::binary::{Reader, Writer};
use crate::base::enumerator::{Enumerator, enumerator};
use crate::base::error::Result;
use crate::base::math::{Pose, Vector};
use crate::ground::{Ground, HeightGrid};
use crate::pair::Query;
use crate::scene::change::{Change, RecordedNames};
use crate::scene::recording::digest::Digest;
use crate::scene::search::query::{PiecePairs, PlacedBody, SceneQuery, Subject};
use crate::scene::world::object::ObjectOptions;
use crate::shape::Shape;
use crate::shape::file::{from_bytes, to_bytes};

/// The first bytes of a recording. The last byte keeps it from passing for text.
pub(crate) const MAGIC: [u8; 8] = *b"SWFTREC\x1a";

/// The version that is written, and the only one that is read.
pub(crate) const VERSION: u32 = 3;

/// Numbers of kinds of records, never used again.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[repr(i32)]
pub(crate) enum RecordKind {
    End = 0,
    Scene = 1,
    Shape = 2,
    Object = 3,
    Copy = 4,
    Remove = 5,
    Fixed = 6,
    Groups = 7,
    UserData = 8,
    Pose = 9,
    Poses = 10,
    AllPoses = 11,
    PiecePose = 12,
    PairActive = 13,
    ObjectActive = 14,
    AllActive = 15,
    Filter = 16,
    FilterAgain = 17,
    Pairs = 18,
    Shrink = 19,
    Question = 20,
    Decisions = 21,
    Answer = 22,
    Failed = 23,
    KeptPairLimit = 24,
    PieceUserData = 30,
    GroundData = 31,
    Ground = 32,
    CompoundData = 33,
    Compound = 34,
}

enumerator!(RecordKind {
    End,
    Scene,
    Shape,
    Object,
    Copy,
    Remove,
    Fixed,
    Groups,
    UserData,
    Pose,
    Poses,
    AllPoses,
    PiecePose,
    PairActive,
    ObjectActive,
    AllActive,
    Filter,
    FilterAgain,
    Pairs,
    Shrink,
    Question,
    Decisions,
    Answer,
    Failed,
    KeptPairLimit,
    PieceUserData,
    GroundData,
    Ground,
    CompoundData,
    Compound
});

/// A filter's word on a pair of objects.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct RecordedDecision {
    pub pair: [u32; 2],
    pub is_tested: bool,
}

/// One record. Objects and shapes are numbers.
#[derive(Debug)]
pub(crate) enum Record<'a> {
    /// The recording was ended.
    End,
    /// The first record; whether the scene had never had an object.
    Scene {
        is_whole: bool,
    },
    /// The next number's.
    Shape(Arc<Shape>),
    /// As above.
    Ground(Arc<Ground>),
    /// As above, by the numbers and the poses of its pieces.
    Compound(Cow<'a, [(u32, Pose)]>),
    Change(Change<'a, RecordedNames>),
    Question {
        subject: Subject<'static, u32, u32>,
        kind: Query,
        query: SceneQuery,
    },
    /// Those of the question before.
    Decisions(Cow<'a, [RecordedDecision]>),
    /// To the question before.
    Answer(Digest),
    /// The question before was refused.
    Failed,
}

impl Record<'_> {
    pub fn kind(&self) -> RecordKind {
        match self {
            Record::End => RecordKind::End,
            Record::Scene { .. } => RecordKind::Scene,
            Record::Shape(_) => RecordKind::Shape,
            Record::Ground(_) => RecordKind::GroundData,
            Record::Compound(_) => RecordKind::CompoundData,
            Record::Change(change) => kind_of(change),
            Record::Question { .. } => RecordKind::Question,
            Record::Decisions(_) => RecordKind::Decisions,
            Record::Answer(_) => RecordKind::Answer,
            Record::Failed => RecordKind::Failed,
        }
    }

    /// Appends the content.
    ///
    /// # Errors
    /// [`Error::Memory`](crate::base::error::Error::Memory).
    pub fn write(&self, to: &mut Writer) -> Result<()> {
        match self {
            Record::End | Record::Failed => Ok(()),
            Record::Scene { is_whole } => to.flag(*is_whole),
            Record::Shape(shape) => crate::base::memory::extend(&mut to.bytes, to_bytes(shape)?),
            Record::Ground(ground) => to.ground(ground),
            Record::Compound(pieces) => to.pieces(pieces),
            Record::Change(change) => write_change(change, to),
            Record::Question { subject, kind, query } => {
                to.subject(subject)?;
                to.number(*kind as u32)?;
                to.query(query)
            }
            Record::Decisions(decisions) => {
                to.number(decisions.len() as u32)?;
                decisions.iter().try_for_each(|decision| {
                    to.pair(&decision.pair)?;
                    to.flag(decision.is_tested)
                })
            }
            Record::Answer(digest) => digest.write(to),
        }
    }

    /// A record from its content.
    ///
    /// # Errors
    /// [`Error::File`](crate::base::error::Error::File) for what is no recording,
    /// [`Error::Memory`](crate::base::error::Error::Memory).
    pub fn read(kind: RecordKind, from: &mut Reader) -> Result<Record<'static>> {
        let record = match kind {
            RecordKind::End => Record::End,
            RecordKind::Scene => Record::Scene { is_whole: from.flag()? },
            RecordKind::Shape => Record::Shape(Arc::new(from_bytes(from.take(from.rest.len())?)?)),
            RecordKind::GroundData => Record::Ground(Arc::new(from.ground()?)),
            RecordKind::CompoundData => Record::Compound(from.pieces()?.into()),
            RecordKind::Question => {
                Record::Question { subject: from.subject()?, kind: from.choice()?, query: from.query()? }
            }
            RecordKind::Decisions => {
                let decision = |from: &mut Reader| Ok(RecordedDecision { pair: from.pair()?, is_tested: from.flag()? });
                Record::Decisions(from.list(9, decision)?.into())
            }
            RecordKind::Answer => Record::Answer(Digest::read(from)?),
            RecordKind::Failed => Record::Failed,
            of_change => Record::Change(read_change(of_change, from)?),
        };
        if from.rest.is_empty() { Ok(record) } else { from.damaged("there is more behind its end") }
    }
}

// --- Changes -----------------------------------------------------------------------------------------------------------------

fn kind_of(change: &Change<RecordedNames>) -> RecordKind {
    match change {
        Change::Object { .. } => RecordKind::Object,
        Change::Ground { .. } => RecordKind::Ground,
        Change::Compound { .. } => RecordKind::Compound,
        Change::Copy(..) => RecordKind::Copy,
        Change::Remove(..) => RecordKind::Remove,
        Change::Fixed(..) => RecordKind::Fixed,
        Change::Groups { .. } => RecordKind::Groups,
        Change::UserData(..) => RecordKind::UserData,
        Change::PieceUserData { .. } => RecordKind::PieceUserData,
        Change::Pose(..) => RecordKind::Pose,
        Change::Poses(..) => RecordKind::Poses,
        Change::AllPoses(..) => RecordKind::AllPoses,
        Change::PiecePose { .. } => RecordKind::PiecePose,
        Change::PairActive(..) => RecordKind::PairActive,
        Change::ObjectActive(..) => RecordKind::ObjectActive,
        Change::AllActive(..) => RecordKind::AllActive,
        Change::Filter(..) => RecordKind::Filter,
        Change::FilterAgain => RecordKind::FilterAgain,
        Change::Pairs(..) => RecordKind::Pairs,
        Change::KeptPairLimit(..) => RecordKind::KeptPairLimit,
        Change::Shrink => RecordKind::Shrink,
    }
}

fn write_change(change: &Change<RecordedNames>, to: &mut Writer) -> Result<()> {
    match change {
        Change::Object { pieces, options } => {
            to.numbers(pieces)?;
            to.options(options)
        }
        Change::Ground { ground, options } => {
            to.number(*ground)?;
            to.options(options)
        }
        Change::Compound { compound, options } => {
            to.number(*compound)?;
            to.options(options)
        }
        Change::Copy(object) | Change::Remove(object) => to.number(*object),
        Change::Fixed(object, flag) | Change::ObjectActive(object, flag) => {
            to.number(*object)?;
            to.flag(*flag)
        }
        Change::Groups { object, groups, mask } => {
            [object, groups, mask].iter().try_for_each(|number| to.number(**number))
        }
        Change::UserData(object, user_data) => {
            to.number(*object)?;
            to.raw(user_data.to_le_bytes())
        }
        Change::PieceUserData { object, piece, user_data } => {
            to.number(*object)?;
            to.number(*piece)?;
            to.raw(user_data.to_le_bytes())
        }
        Change::Pose(object, pose) => {
            to.number(*object)?;
            to.pose(pose)
        }
        Change::Poses(objects, poses) => {
            to.numbers(objects)?;
            to.poses(poses)
        }
        Change::AllPoses(poses) => to.poses(poses),
        Change::PiecePose { object, piece, pose } => {
            to.number(*object)?;
            to.number(*piece)?;
            to.pose(pose)
        }
        Change::PairActive(pair, flag) => {
            to.pair(pair)?;
            to.flag(*flag)
        }
        Change::AllActive(flag) => to.flag(*flag),
        Change::Filter(filter) => to.flag(filter.is_some()),
        Change::FilterAgain | Change::Shrink => Ok(()),
        Change::KeptPairLimit(limit) => to.raw(limit.to_le_bytes()),
        Change::Pairs(pairs) => {
            to.flag(pairs.is_some())?;
            let pairs = pairs.as_deref().unwrap_or_default();
            to.number(pairs.len() as u32)?;
            pairs.iter().try_for_each(|pair| to.pair(pair))
        }
    }
}

/// The change of a kind of record; other kinds mean no change.
fn read_change(kind: RecordKind, from: &mut Reader) -> Result<Change<'static, RecordedNames>> {
    Ok(match kind {
        RecordKind::Object => Change::Object { pieces: from.numbers()?.into(), options: from.options()? },
        RecordKind::Ground => Change::Ground { ground: from.number()?, options: from.options()? },
        RecordKind::Compound => Change::Compound { compound: from.number()?, options: from.options()? },
        RecordKind::Copy => Change::Copy(from.number()?),
        RecordKind::Remove => Change::Remove(from.number()?),
        RecordKind::Fixed => Change::Fixed(from.number()?, from.flag()?),
        RecordKind::Groups => Change::Groups { object: from.number()?, groups: from.number()?, mask: from.number()? },
        RecordKind::UserData => Change::UserData(from.number()?, u64::from_le_bytes(from.raw()?)),
        RecordKind::PieceUserData => Change::PieceUserData {
            object: from.number()?,
            piece: from.number()?,
            user_data: u64::from_le_bytes(from.raw()?),
        },
        RecordKind::Pose => Change::Pose(from.number()?, Cow::Owned(from.pose()?)),
        RecordKind::Poses => Change::Poses(from.numbers()?.into(), from.poses()?.into()),
        RecordKind::AllPoses => Change::AllPoses(from.poses()?.into()),
        RecordKind::PiecePose => {
            Change::PiecePose { object: from.number()?, piece: from.number()?, pose: from.pose()? }
        }
        RecordKind::PairActive => Change::PairActive(from.pair()?, from.flag()?),
        RecordKind::ObjectActive => Change::ObjectActive(from.number()?, from.flag()?),
        RecordKind::AllActive => Change::AllActive(from.flag()?),
        RecordKind::Filter => Change::Filter(from.flag()?.then_some(())),
        RecordKind::FilterAgain => Change::FilterAgain,
        RecordKind::Pairs => {
            let (is_some, pairs) = (from.flag()?, from.list(8, Reader::pair)?);
            Change::Pairs(is_some.then_some(pairs.into()))
        }
        RecordKind::KeptPairLimit => Change::KeptPairLimit(u64::from_le_bytes(from.raw()?)),
        RecordKind::Shrink => Change::Shrink,
        _ => return from.damaged("it is no change"),
    })
}

// --- What records are made of ------------------------------------------------------------------------------------------------

impl Writer {
    pub(super) fn flag(&mut self, flag: bool) -> Result<()> {
        self.raw([u8::from(flag)])
    }

    fn options(&mut self, options: &ObjectOptions) -> Result<()> {
        let ObjectOptions { pose, fixed, user_data, groups, mask } = options;
        self.pose(pose)?;
        self.flag(*fixed)?;
        self.raw(user_data.to_le_bytes())?;
        self.number(*groups)?;
        self.number(*mask)
    }

    /// By its heights, or with 0 columns by its triangles.
    fn ground(&mut self, ground: &Ground) -> Result<()> {
        self.real(ground.thickness())?;
        let [columns, rows] = ground.height_grid().map_or([0; 2], |grid| [grid.columns, grid.rows]);
        self.number(columns as u32)?;
        self.number(rows as u32)?;
        if let Some(HeightGrid { spacing, heights, .. }) = ground.height_grid() {
            spacing.into_iter().try_for_each(|step| self.real(step))?;
            self.number(heights.len() as u32)?;
            return heights.iter().try_for_each(|height| self.real(*height));
        }
        self.number(ground.vertex_count() as u32)?;
        ground.vertices().try_for_each(|vertex| vertex.iter().try_for_each(|x| self.real(*x)))?;
        self.number(ground.triangle_count() as u32)?;
        ground.corners().try_for_each(|corners| corners.iter().try_for_each(|v| self.number(*v)))
    }

    fn pieces(&mut self, pieces: &[(u32, Pose)]) -> Result<()> {
        self.number(pieces.len() as u32)?;
        pieces.iter().try_for_each(|(shape, pose)| {
            self.number(*shape)?;
            self.pose(pose)
        })
    }

    fn pair(&mut self, pair: &[u32; 2]) -> Result<()> {
        pair.iter().try_for_each(|number| self.number(*number))
    }

    fn pose(&mut self, pose: &Pose) -> Result<()> {
        pose.rows.as_flattened().iter().try_for_each(|x| self.real(*x))
    }

    fn poses(&mut self, poses: &[Pose]) -> Result<()> {
        self.number(poses.len() as u32)?;
        poses.iter().try_for_each(|pose| self.pose(pose))
    }

    fn subject(&mut self, subject: &Subject<u32, u32>) -> Result<()> {
        match subject {
            Subject::AllPairs => self.raw([0]),
            Subject::Object(object) => {
                self.raw([1])?;
                self.number(*object)
            }
            Subject::Placed(PlacedBody { pieces, mask }) => {
                if let ([(shape, pose)], None) = (&**pieces, mask) {
                    self.raw([2])?;
                    self.number(*shape)?;
                    return self.pose(pose);
                }
                self.raw([4])?;
                self.flag(mask.is_some())?;
                self.number(mask.unwrap_or_default())?;
                self.pieces(pieces)
            }
            Subject::Events => self.raw([3]),
        }
    }

    fn query(&mut self, query: &SceneQuery) -> Result<()> {
        let SceneQuery {
            early_exit,
            max_distance,
            absolute_error,
            relative_error,
            error_budget,
            step_budget,
            levels,
            refinement,
            start,
            detail,
            piece_pairs,
        } = *query;
        self.flag(early_exit)?;
        for real in [max_distance, absolute_error, relative_error, error_budget] {
            self.real(real)?;
        }
        let choices = [step_budget, levels as u32, refinement as u32, start as u32, detail as u32];
        choices.iter().try_for_each(|x| self.number(*x))?;
        // Recordings of a time without this choice are read, too.
        if piece_pairs == PiecePairs::Every { Ok(()) } else { self.number(piece_pairs as u32) }
    }
}

impl Reader<'_> {
    pub(super) fn flag(&mut self) -> Result<bool> {
        match self.raw()? {
            [0] => Ok(false),
            [1] => Ok(true),
            _ => self.damaged("a flag is neither 0 nor 1"),
        }
    }

    fn options(&mut self) -> Result<ObjectOptions> {
        Ok(ObjectOptions {
            pose: self.pose()?,
            fixed: self.flag()?,
            user_data: u64::from_le_bytes(self.raw()?),
            groups: self.number()?,
            mask: self.number()?,
        })
    }

    fn ground(&mut self) -> Result<Ground> {
        let thickness = self.real()?;
        let [columns, rows] = [self.number()? as usize, self.number()? as usize];
        if columns > 0 {
            let spacing = [self.real()?, self.real()?];
            let heights = self.list(8, |from| from.real())?;
            let grid = HeightGrid { rows, columns, spacing, heights: &heights };
            return Ground::from_heights(&grid)?.with_thickness(thickness);
        }
        let vertices = self.list(24, |from| Ok(Vector::new(from.real()?, from.real()?, from.real()?)))?;
        let triangles = self.list(12, |from| Ok([from.number()?, from.number()?, from.number()?]))?;
        Ground::from_triangles(&vertices, &triangles)?.with_thickness(thickness)
    }

    fn pair(&mut self) -> Result<[u32; 2]> {
        Ok([self.number()?, self.number()?])
    }

    fn choice<T: Enumerator>(&mut self) -> Result<T> {
        let number = self.number()?;
        let found = i32::try_from(number).ok().and_then(T::from_number);
        found.map_or_else(|| self.damaged("an unknown choice"), Ok)
    }

    fn pose(&mut self) -> Result<Pose> {
        let mut pose = Pose::IDENTITY;
        for number in pose.rows.as_flattened_mut() {
            *number = self.real()?;
        }
        Ok(pose)
    }

    fn poses(&mut self) -> Result<Vec<Pose>> {
        self.list(size_of::<Pose>(), Reader::pose)
    }

    fn piece(&mut self) -> Result<(u32, Pose)> {
        Ok((self.number()?, self.pose()?))
    }

    fn pieces(&mut self) -> Result<Vec<(u32, Pose)>> {
        self.list(size_of::<u32>() + size_of::<Pose>(), Reader::piece)
    }

    fn subject(&mut self) -> Result<Subject<'static, u32, u32>> {
        match self.raw()? {
            [0] => Ok(Subject::AllPairs),
            [1] => Ok(Subject::Object(self.number()?)),
            [2] => Ok(Subject::Placed(PlacedBody { pieces: vec![self.piece()?].into(), mask: None })),
            [3] => Ok(Subject::Events),
            [4] => {
                let (has_mask, mask) = (self.flag()?, self.number()?);
                let pieces = self.pieces()?.into();
                Ok(Subject::Placed(PlacedBody { pieces, mask: has_mask.then_some(mask) }))
            }
            _ => self.damaged("a query about nothing known"),
        }
    }

    fn query(&mut self) -> Result<SceneQuery> {
        Ok(SceneQuery {
            early_exit: self.flag()?,
            max_distance: self.real()?,
            absolute_error: self.real()?,
            relative_error: self.real()?,
            error_budget: self.real()?,
            step_budget: self.number()?,
            levels: self.choice()?,
            refinement: self.choice()?,
            start: self.choice()?,
            detail: self.choice()?,
            piece_pairs: if self.rest.is_empty() { PiecePairs::Every } else { self.choice()? },
        })
    }
}
