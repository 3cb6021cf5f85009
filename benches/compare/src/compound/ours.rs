//! This library's compounds.

use std::sync::Arc;

use swiftprox::compound::{Compound, CompoundAnswer, CompoundCache, Piece, distance, intersection};
use swiftprox::error::Error;
use swiftprox::math::{Pose, Vector};
use swiftprox::pair::{Outcome, PairConfig};
use swiftprox::shape::{Shape, ShapeOptions};
use testkit::PosePair;

use super::Method;
use super::pairs::Asked;

pub const NAME: &str = "swiftprox";

pub fn shapes(pieces: &[Vec<Vector>]) -> Result<Vec<Arc<Shape>>, Error> {
    pieces.iter().map(|points| Ok(Arc::new(Shape::from_points(points, &ShapeOptions::default())?))).collect()
}

pub fn compound(pieces: &[Vec<Vector>]) -> Result<Compound, Error> {
    let piece = |shape| Piece { shape, pose: Pose::IDENTITY };
    Compound::new(&shapes(pieces)?.into_iter().map(piece).collect::<Vec<_>>())
}

pub fn poses_of(pair: &PosePair) -> [Pose; 2] {
    [0, 12].map(|first| Pose { rows: std::array::from_fn(|row| std::array::from_fn(|k| pair[first + 4 * row + k])) })
}

pub struct Ours<'a> {
    compound: &'a Compound,
    poses: &'a [PosePair],
    asked: Asked,
    config: PairConfig,
    cache: CompoundCache,
    answer: CompoundAnswer,
}

impl<'a> Ours<'a> {
    pub fn new(compound: &'a Compound, poses: &'a [PosePair], asked: Asked) -> Ours<'a> {
        let (config, cache) = (PairConfig::default(), CompoundCache::default());
        Ours { compound, poses, asked, config, cache, answer: CompoundAnswer::default() }
    }
}

impl Method for Ours<'_> {
    fn name(&self) -> &'static str {
        NAME
    }

    fn forget(&mut self) {
        self.cache = CompoundCache::default();
    }

    fn ask(&mut self, k: usize) -> f64 {
        let poses = poses_of(&self.poses[k]);
        let bodies = [self.compound.at(&poses[0]), self.compound.at(&poses[1])];
        let query = if self.asked == Asked::Verdict { intersection } else { distance };
        if let Err(error) = query(bodies, &mut self.cache, &self.config, &mut self.answer) {
            panic!("{error}");
        }
        match self.asked {
            Asked::Verdict => f64::from(u8::from(self.answer.answer.outcome != Outcome::Intersecting)),
            Asked::Distance => self.answer.answer.distance,
        }
    }
}
