//! This library's compounds.

use std::sync::Arc;

use swiftprox::compound::{Compound, CompoundAnswer, CompoundCache, Piece, distance, intersection};
use swiftprox::math::{Pose, Vector};
use swiftprox::pair::{Outcome, PairConfig};
use swiftprox::shape::{Shape, ShapeOptions};
use testkit::PosePair;

use super::{Asked, Bodies};

pub fn compound(pieces: &[Vec<Vector>]) -> Result<Compound, swiftprox::error::Error> {
    let piece = |points: &Vec<Vector>| {
        let shape = Arc::new(Shape::from_points(points, &ShapeOptions::default())?);
        Ok(Piece { shape, pose: Pose::IDENTITY })
    };
    Compound::new(&pieces.iter().map(piece).collect::<Result<Vec<_>, swiftprox::error::Error>>()?)
}

pub struct Ours<'a> {
    compound: &'a Compound,
    asked: Asked,
    config: PairConfig,
    cache: CompoundCache,
    answer: CompoundAnswer,
}

impl<'a> Ours<'a> {
    pub fn new(compound: &'a Compound, asked: Asked) -> Ours<'a> {
        let (config, cache) = (PairConfig::default(), CompoundCache::default());
        Ours { compound, asked, config, cache, answer: CompoundAnswer::default() }
    }
}

impl Bodies for Ours<'_> {
    fn name(&self) -> &'static str {
        "swiftprox"
    }

    fn forget(&mut self) {
        self.cache = CompoundCache::default();
    }

    fn ask(&mut self, poses: &PosePair) -> f64 {
        let pose = |first: usize| Pose {
            rows: std::array::from_fn(|row| std::array::from_fn(|k| poses[first + 4 * row + k])),
        };
        let poses = [pose(0), pose(12)];
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
