//! How far a body is from a ground: the least over its triangles, each answered by the pair layer.

use super::PlacedGround;
use super::reach::GroundReach;
use super::tree::{FOUR, FourBoxes, NodeBounds, Visit};
use crate::base::error::{Error, Result};
use crate::base::simd::environment::with_default;
use crate::pair::{self, Outcome, PairAnswer, PairCache, PairConfig, Placed, Query};
use crate::shape::TriangleShape;

/// The answer for a body, which is object 1, and a ground.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
#[repr(C)]
pub struct GroundDistance {
    /// Same as for a body and the surface as a set of points. Features of object 2 are in the ground's numbering: vertices, edges
    /// by their vertices, a face is a triangle. For a pair beyond `max_distance` only `lower` is reported.
    pub answer: PairAnswer,
    /// The triangle that the answer is about: the nearest, or the first that was found to intersect. It is the number of triangles
    /// where the answer is about none.
    pub triangle: u32,
}

/// How far a body is from a ground, or whether they intersect: `query` is [`Query::Distance`] or [`Query::Intersection`], and the
/// answer is as certain as that of [`pair::distance`] or [`pair::intersection`].
///
/// # Errors
/// [`Error::Argument`] for another query; else same as these two, for both poses; [`Error::Memory`]: about 4 kB are requested.
pub fn ground_distance(
    query: Query,
    body: Placed,
    ground: PlacedGround,
    config: &PairConfig,
) -> Result<GroundDistance> {
    if let Query::Approximate | Query::Contact = query {
        return Err(Error::Argument("a ground is asked for distance or intersection".into()));
    }
    nearest_triangle(query, body, ground, config)
}

/// The same for any query: a distance is exact where it may be approximate, and of [`Query::Contact`] the points and the normal of
/// an intersecting answer are those of its triangle.
///
/// # Errors
/// As of [`ground_distance`].
pub(crate) fn nearest_triangle(
    query: Query,
    body: Placed,
    ground: PlacedGround,
    config: &PairConfig,
) -> Result<GroundDistance> {
    with_default(|| {
        let ask: Ask = match query {
            Query::Distance | Query::Approximate => pair::distance,
            Query::Intersection => pair::intersection,
            Query::Contact => pair::contact,
        };
        config.check(query)?;
        body.pose.check()?;
        ground.pose.check()?;
        let is_verdict = query == Query::Intersection && config.max_distance == f64::INFINITY;
        let count = ground.ground.triangle_count() as u32;
        let reach = GroundReach::new(body, ground)?;
        let unsaid = PairAnswer { outcome: Outcome::Separated, upper: f64::INFINITY, ..PairAnswer::UNSAID };
        let mut least = LeastToGround {
            ask,
            body,
            ground,
            config: *config,
            scratch: ground.ground.triangle_shape().copy()?,
            nearest: GroundDistance { answer: unsaid, triangle: count },
            lower: f64::INFINITY,
            enough: if is_verdict { 0.0 } else { config.max_distance },
            is_verdict,
            is_open: false,
            reach,
        };
        ground.ground.layout().walk(&mut least)?;
        Ok(least.answer())
    })
}

type Ask = fn([Placed; 2], &mut PairCache, &PairConfig, &mut PairAnswer) -> Result<()>;

/// The least distance of the triangles that a walk has reached.
struct LeastToGround<'a> {
    ask: Ask,
    body: Placed<'a>,
    ground: PlacedGround<'a>,
    reach: GroundReach,
    config: PairConfig,
    scratch: TriangleShape,
    nearest: GroundDistance,
    /// All that has been looked at or passed by is at least this far away.
    lower: f64,
    /// Anything farther away no longer counts.
    enough: f64,
    is_verdict: bool,
    /// A curved body may intersect one of them.
    is_open: bool,
}

impl Visit for LeastToGround<'_> {
    fn keys(&self, boxes: &FourBoxes) -> [f64; FOUR] {
        self.reach.bounds.gaps(boxes)
    }

    fn goes_to(&mut self, bounds: &NodeBounds, gap: f64) -> bool {
        let mut gap = gap * self.reach.stretch;
        // From far away, all triangles are about as far.
        if gap <= self.enough && gap > self.body.shape.polyhedron().radius {
            gap = gap.max(self.reach.gap_along_way(self.body, bounds));
        }
        let goes = gap <= self.enough;
        if !goes {
            self.lower = self.lower.min(gap);
        }
        goes
    }

    fn triangle(&mut self, triangle: u32) -> Result<bool> {
        let own = self.ground.ground.triangle(triangle);
        let bounds = NodeBounds::of(&own.corners);
        if !self.goes_to(&bounds, bounds.gap(&self.reach.bounds)) {
            return Ok(true);
        }
        let mut answer = PairAnswer::default();
        let shape = self.scratch.of(&own);
        let bodies = [self.body, shape.at(self.ground.pose)];
        if !self.is_verdict {
            self.config.max_distance = self.enough;
        }
        (self.ask)(bodies, &mut PairCache::default(), &self.config, &mut answer)?;
        self.lower = self.lower.min(answer.lower);
        match answer.outcome {
            Outcome::Intersecting => {
                self.nearest = GroundDistance { answer, triangle };
                return Ok(false);
            }
            Outcome::Undecided => self.is_open = true,
            Outcome::Separated if !self.is_verdict => {}
            Outcome::Separated | Outcome::Beyond | Outcome::None => return Ok(true),
        }
        // The upper end may be infinite: distances need not be doubles.
        if !self.is_found() || answer.upper < self.nearest.answer.upper {
            if !self.is_verdict {
                self.enough = answer.upper;
            }
            self.nearest = GroundDistance { answer, triangle };
        }
        Ok(true)
    }
}

impl LeastToGround<'_> {
    fn is_found(&self) -> bool {
        self.nearest.triangle < self.ground.ground.triangle_count() as u32
    }

    fn answer(self) -> GroundDistance {
        let GroundDistance { mut answer, triangle } = self.nearest;
        if answer.outcome == Outcome::Intersecting {
            return self.nearest;
        }
        answer.lower = self.lower;
        if self.is_open {
            answer.outcome = Outcome::Undecided;
        } else if !self.is_found() {
            // A verdict without a tolerance finds no nearest.
            answer.outcome = if self.is_verdict { Outcome::Separated } else { Outcome::Beyond };
            answer.distance = answer.lower;
        }
        GroundDistance { answer, triangle }
    }
}
