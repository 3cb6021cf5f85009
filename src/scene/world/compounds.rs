//! Compounds among the objects of a scene: one row each, whose shape is a box around it. A pair with one is answered by the
//! compound layer, one with a ground piece by piece.

use crate::base::error::{Error, Result};
use crate::base::math::Pose;
use crate::compound::{
    self, Compound, CompoundAnswer, GrowingCache, MORE, PieceCaches, PlacedPieces, SinglePiece, near_pieces,
    with_pieces,
};
use crate::ground::Ground;
use crate::pair::{self, Outcome, PairAnswer, PairConfig, Placed, Query};
use crate::scene::world::grounds::GroundPair;
use crate::shape::Shape;

/// One of a pair.
#[derive(Clone, Copy)]
pub(crate) enum CompoundSide<'a> {
    Shape(&'a Shape),
    Ground(&'a Ground),
    Compound(&'a Compound),
}

/// A pair of which one is a compound, or both are.
#[derive(Clone, Copy)]
pub(crate) struct CompoundPair<'a> {
    pub sides: [CompoundSide<'a>; 2],
    pub poses: [&'a Pose; 2],
}

/// The pieces that an answer is about: of each that is a compound its number.
pub(crate) type NamedPieces = [Option<u32>; 2];

impl<'a> CompoundPair<'a> {
    /// Answers a query. Approximate ones are answered exactly; of intersecting pieces a query of contacts has points and a normal.
    ///
    /// # Errors
    /// As of [`compound::distance`], or of [`nearest_triangle`](crate::ground::nearest_triangle).
    #[inline(never)]
    pub fn ask(
        &self,
        query: Query,
        cache: &mut GrowingCache,
        config: &PairConfig,
        answer: &mut PairAnswer,
    ) -> Result<NamedPieces> {
        if let Some((ground, side)) = self.ground() {
            return self.ask_ground(GroundPair { ground, side }, query, config, answer);
        }
        self.with_bodies(|bodies| {
            let asked = if query == Query::Intersection { query } else { Query::Distance };
            let exact = PairConfig { absolute_error: 0.0, relative_error: 0.0, step_budget: u32::MAX, ..*config };
            let mut found = CompoundAnswer::default();
            compound::ask(asked, bodies, cache, &exact, &mut found)?;
            *answer = found.answer;
            let pieces = [found.piece1, found.piece2];
            if query == Query::Contact && answer.outcome == Outcome::Intersecting {
                with_pieces(bodies, pieces, |placed| pair::contact(placed, cache.of(pieces), &exact, answer))?;
            }
            Ok(self.named(pieces))
        })
    }

    /// The ground, and which of the two it is.
    pub fn ground(&self) -> Option<(&'a Ground, usize)> {
        match self.sides {
            [CompoundSide::Ground(ground), _] => Some((ground, 0)),
            [_, CompoundSide::Ground(ground)] => Some((ground, 1)),
            _ => None,
        }
    }

    /// The pieces that are of compounds.
    pub fn named(&self, pieces: [u32; 2]) -> NamedPieces {
        let of = |k: usize| matches!(self.sides[k], CompoundSide::Compound(_)).then_some(pieces[k]);
        [of(0), of(1)]
    }

    /// Calls `work` with the pieces of both, of which none is a ground.
    fn with_bodies<T>(&self, work: impl FnOnce(&[PlacedPieces; 2]) -> Result<T>) -> Result<T> {
        let [pose1, pose2] = self.poses;
        match self.sides {
            [CompoundSide::Compound(one), CompoundSide::Compound(other)] => {
                work(&[one.at(pose1).placed_pieces(), other.at(pose2).placed_pieces()])
            }
            [CompoundSide::Compound(one), CompoundSide::Shape(other)] => {
                work(&[one.at(pose1).placed_pieces(), SinglePiece::new(other).at(pose2)])
            }
            [CompoundSide::Shape(one), CompoundSide::Compound(other)] => {
                work(&[SinglePiece::new(one).at(pose1), other.at(pose2).placed_pieces()])
            }
            _ => Err(Error::Bug("no pair of a compound and pieces".into())),
        }
    }

    /// Piece by piece; the feature of the ground is the triangle, as a face.
    fn ask_ground(
        &self,
        ground: GroundPair,
        query: Query,
        config: &PairConfig,
        answer: &mut PairAnswer,
    ) -> Result<NamedPieces> {
        let CompoundSide::Compound(compound) = self.sides[1 - ground.side] else {
            return Err(Error::Bug("no pair of a compound and a ground".into()));
        };
        let pieces = compound.at(self.poses[1 - ground.side]).placed_pieces();
        let place = Shape::surrounding(&ground.ground.bounds(), f64::INFINITY)?;
        let at = place.at(self.poses[ground.side]);
        let mut config = *config;
        let tolerance = config.max_distance;
        let (mut lower, mut named) = (f64::INFINITY, None);
        for number in 0..pieces.count() as u32 {
            let (mut room, mut found) = (Pose::IDENTITY, PairAnswer::default());
            let piece = pieces.piece(number, &mut room);
            let bodies = if ground.side == 0 { [at, piece] } else { [piece, at] };
            ground.ask(query, bodies, &config, &mut found)?;
            lower = found.lower.min(lower);
            let is_nearer = match (found.outcome, named) {
                (Outcome::Intersecting, _) => true,
                (Outcome::Separated, None) => true,
                (Outcome::Separated, Some(_)) => found.upper < answer.upper,
                _ => false,
            };
            if is_nearer {
                (*answer, named) = (found, Some(number));
                if found.outcome == Outcome::Intersecting {
                    break;
                }
                config.max_distance = (found.upper * MORE).min(tolerance);
            } else if named.is_none() {
                *answer = found;
            }
        }
        answer.lower = lower;
        let mut names = [None; 2];
        names[1 - ground.side] = named;
        Ok(names)
    }

    /// What a query of contacts with details asks: all pairs of pieces that may be no farther apart than `max_distance`, in order,
    /// and a lower bound of the distance of all others.
    ///
    /// # Errors
    /// [`Error::Memory`].
    pub fn near_pieces(&self, max_distance: f64) -> Result<(Vec<[u32; 2]>, f64)> {
        self.with_bodies(|bodies| near_pieces(bodies, max_distance))
    }

    /// Two pieces where they are.
    ///
    /// # Errors
    /// Those of `work`.
    pub fn with_pieces<T>(&self, pieces: [u32; 2], work: impl FnOnce([Placed; 2]) -> Result<T>) -> Result<T> {
        let [pose1, pose2] = self.poses;
        let [mut own1, mut own2] = [Pose::IDENTITY; 2];
        work([placed(self.sides[0], pose1, pieces[0], &mut own1)?, placed(self.sides[1], pose2, pieces[1], &mut own2)?])
    }
}

/// A piece of one of a pair, where it is.
fn placed<'a>(side: CompoundSide<'a>, pose: &'a Pose, piece: u32, room: &'a mut Pose) -> Result<Placed<'a>> {
    match side {
        CompoundSide::Shape(shape) => Ok(shape.at(pose)),
        CompoundSide::Compound(compound) => Ok(compound.at(pose).placed_pieces().piece(piece, room)),
        CompoundSide::Ground(_) => Err(Error::Bug("a ground has no pieces".into())),
    }
}
