//! Grounds among the objects of a scene. Each has a row as a piece has, so that all that finds, filters and orders pairs takes it
//! for one; the row's shape is a box around the ground. What answers a pair asks [`RowBodies`] first whether one of the two is one.

use crate::answer::{Feature, FeatureKind};
use crate::base::error::Result;
use crate::ground::{Ground, nearest_triangle};
use crate::pair::{PairAnswer, PairConfig, Placed, Query};
#[cfg(doc)]
use crate::scene::world::bodies::RowBodies;

/// A pair of which one is a ground.
#[derive(Debug, Clone, Copy)]
pub(crate) struct GroundPair<'a> {
    pub ground: &'a Ground,
    /// Which of the two it is.
    pub side: usize,
}

impl GroundPair<'_> {
    /// Answers a query; of the ground's body only the pose counts. The feature of the ground is the triangle, as a face.
    ///
    /// # Errors
    /// As of [`nearest_triangle`].
    pub fn ask(&self, query: Query, bodies: [Placed; 2], config: &PairConfig, answer: &mut PairAnswer) -> Result<()> {
        let GroundPair { ground, side } = *self;
        let found = nearest_triangle(query, bodies[1 - side], ground.at(bodies[side].pose), config)?;
        *answer = found.answer;
        if (found.triangle as usize) < ground.triangle_count() {
            answer.feature2 = face(found.triangle);
        }
        if side == 0 {
            *answer = answer.reversed();
        }
        Ok(())
    }
}

/// A triangle of a ground as a feature.
pub(crate) fn face(triangle: u32) -> Feature {
    Feature { kind: FeatureKind::Face, ids: [triangle, 0] }
}
