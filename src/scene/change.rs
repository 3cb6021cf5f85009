//! Everything that can be done to a scene and changes what its queries answer. The scene applies a change and has it written down,
//! a recording turns it into bytes and back, a replay applies it again.

use std::borrow::Cow;
use std::fmt::Debug;
use std::sync::Arc;

use crate::base::error::Result;
use crate::base::math::Pose;
use crate::base::memory::{copied, push};
use crate::compound::Compound;
use crate::ground::Ground;
use crate::scene::world::object::{ObjectId, ObjectOptions};
use crate::scene::world::testing::PairFilter;
use crate::shape::Shape;

/// The names that stand for objects, shapes, grounds, compounds and filters.
pub(crate) trait Names {
    type Object: Copy + Debug;
    type Shape: Clone + Debug;
    type Ground: Debug;
    type Compound: Debug;
    type Filter: Debug;
}

/// In a scene: themselves.
#[derive(Debug)]
pub(crate) struct Themselves;

impl Names for Themselves {
    type Object = ObjectId;
    type Shape = Arc<Shape>;
    type Ground = Arc<Ground>;
    type Compound = Arc<Compound>;
    type Filter = PairFilter;
}

/// In a recording: numbers, and of filters nothing.
#[derive(Debug)]
pub(crate) struct RecordedNames;

impl Names for RecordedNames {
    type Object = u32;
    type Shape = u32;
    type Ground = u32;
    type Compound = u32;
    type Filter = ();
}

/// One change. The methods of [`Scene`](crate::scene::Scene) describe what each does.
#[derive(Debug)]
pub(crate) enum Change<'a, N: Names> {
    /// Adds an object, the next in order of creation.
    Object {
        pieces: Cow<'a, [N::Shape]>,
        options: ObjectOptions,
    },
    /// As above, which is a ground.
    Ground {
        ground: N::Ground,
        options: ObjectOptions,
    },
    /// As above, which is a compound.
    Compound {
        compound: N::Compound,
        options: ObjectOptions,
    },
    /// As above, like another one.
    Copy(N::Object),
    Remove(N::Object),
    Fixed(N::Object, bool),
    Groups {
        object: N::Object,
        groups: u32,
        mask: u32,
    },
    UserData(N::Object, u64),
    PieceUserData {
        object: N::Object,
        piece: u32,
        user_data: u64,
    },
    Pose(N::Object, Cow<'a, Pose>),
    Poses(Cow<'a, [N::Object]>, Cow<'a, [Pose]>),
    AllPoses(Cow<'a, [Pose]>),
    PiecePose {
        object: N::Object,
        piece: u32,
        pose: Pose,
    },
    PairActive([N::Object; 2], bool),
    ObjectActive(N::Object, bool),
    AllActive(bool),
    Filter(Option<N::Filter>),
    FilterAgain,
    Pairs(Option<Cow<'a, [[N::Object; 2]]>>),
    KeptPairLimit(u64),
    Shrink,
}

/// A translation of things to their other names.
pub(crate) trait Rename<From: Names, To: Names> {
    /// # Errors
    /// If it has no other name.
    fn object(&mut self, object: From::Object) -> Result<To::Object>;
    /// # Errors
    /// As above.
    fn shape(&mut self, shape: &From::Shape) -> Result<To::Shape>;
    /// # Errors
    /// As above.
    fn ground(&mut self, ground: &From::Ground) -> Result<To::Ground>;
    /// # Errors
    /// As above.
    fn compound(&mut self, compound: &From::Compound) -> Result<To::Compound>;
    fn filter(&mut self, filter: &From::Filter) -> To::Filter;
}

impl<From: Names> Change<'_, From> {
    /// The same change with the other names of all that it is about.
    ///
    /// # Errors
    /// Those of `names`, and [`Error::Memory`](crate::base::error::Error::Memory).
    pub fn renamed<To: Names>(&self, names: &mut impl Rename<From, To>) -> Result<Change<'static, To>> {
        Ok(match self {
            Change::Object { pieces, options } => {
                Change::Object { pieces: all(pieces, |shape| names.shape(shape))?, options: *options }
            }
            Change::Ground { ground, options } => Change::Ground { ground: names.ground(ground)?, options: *options },
            Change::Compound { compound, options } => {
                Change::Compound { compound: names.compound(compound)?, options: *options }
            }
            Change::Copy(object) => Change::Copy(names.object(*object)?),
            Change::Remove(object) => Change::Remove(names.object(*object)?),
            Change::Fixed(object, fixed) => Change::Fixed(names.object(*object)?, *fixed),
            Change::Groups { object, groups, mask } => {
                Change::Groups { object: names.object(*object)?, groups: *groups, mask: *mask }
            }
            Change::UserData(object, user_data) => Change::UserData(names.object(*object)?, *user_data),
            Change::PieceUserData { object, piece, user_data } => {
                Change::PieceUserData { object: names.object(*object)?, piece: *piece, user_data: *user_data }
            }
            Change::Pose(object, pose) => Change::Pose(names.object(*object)?, Cow::Owned(**pose)),
            Change::Poses(objects, poses) => {
                Change::Poses(all(objects, |object| names.object(*object))?, copied(poses)?.into())
            }
            Change::AllPoses(poses) => Change::AllPoses(copied(poses)?.into()),
            Change::PiecePose { object, piece, pose } => {
                Change::PiecePose { object: names.object(*object)?, piece: *piece, pose: *pose }
            }
            Change::PairActive(pair, active) => Change::PairActive(both(pair, names)?, *active),
            Change::ObjectActive(object, active) => Change::ObjectActive(names.object(*object)?, *active),
            Change::AllActive(active) => Change::AllActive(*active),
            Change::Filter(filter) => Change::Filter(filter.as_ref().map(|filter| names.filter(filter))),
            Change::FilterAgain => Change::FilterAgain,
            Change::Pairs(pairs) => {
                let renamed = pairs.as_ref().map(|pairs| all(pairs, |pair| both(pair, names)));
                Change::Pairs(renamed.transpose()?)
            }
            Change::KeptPairLimit(limit) => Change::KeptPairLimit(*limit),
            Change::Shrink => Change::Shrink,
        })
    }
}

fn both<From: Names, To: Names>(
    pair: &[From::Object; 2],
    names: &mut impl Rename<From, To>,
) -> Result<[To::Object; 2]> {
    Ok([names.object(pair[0])?, names.object(pair[1])?])
}

/// Other names for all things of a list.
fn all<A, B: Clone>(list: &[A], mut rename: impl FnMut(&A) -> Result<B>) -> Result<Cow<'static, [B]>> {
    let mut renamed = Vec::new();
    list.iter().try_for_each(|thing| push(&mut renamed, rename(thing)?))?;
    Ok(renamed.into())
}
