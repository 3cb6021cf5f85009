//! When a moving body first meets a ground: its way is cut into parts, and the triangles near each part are cast at one by one.

use super::PlacedGround;
use super::reach::GroundReach;
use super::tree::{FOUR, FourBoxes, NodeBounds, Visit};
use crate::base::error::{Error, Result};
use crate::base::simd::environment::with_default;
#[cfg(doc)]
use crate::motion::cast;
use crate::motion::{Carried, CastAnswer, CastConfig, CastOutcome, Motion, Moving, PartEnd, Swept, cast_carried};
use crate::pair::PairCache;
use crate::shape::TriangleShape;

/// The answer of a cast of a body at a ground.
#[derive(Debug, Clone, Copy, PartialEq)]
#[repr(C)]
pub struct GroundCastAnswer {
    /// That of a cast of the body, object 1, at the surface as a set of points. Of several triangles that are hit
    /// within the time tolerance, contact and proof are those of one, at times of its own.
    pub answer: CastAnswer,
    /// The triangle that is hit, or nearly; the number of triangles if none is.
    pub triangle: u32,
}

/// By how many time tolerances a part of the way is asked about beyond its end.
const LONGER: f64 = 16.0;

/// Whether a moving body stays farther from a ground at rest than `config.max_distance`, or when it first does not. Certain as
/// [`cast`] is.
///
/// # Errors
/// As of [`cast`]. [`Error::Argument`] also for `config.ignores_parting`: a body that rests on a ground parts from some triangles
/// alone. [`Error::Memory`]: about 4 kB are requested.
pub fn ground_cast(body: Moving, ground: PlacedGround, config: &CastConfig) -> Result<GroundCastAnswer> {
    ground_cast_carried(body.into(), ground, config)
}

/// The same of a piece of a moving object.
///
/// # Errors
/// As of [`ground_cast`].
pub(crate) fn ground_cast_carried(
    body: Carried,
    ground: PlacedGround,
    config: &CastConfig,
) -> Result<GroundCastAnswer> {
    with_default(|| {
        config.check()?;
        if config.ignores_parting {
            return Err(Error::Argument("ignores_parting is for pairs of bodies: clear it for a ground".into()));
        }
        ground.pose.check()?;
        let count = ground.ground.triangle_count() as u32;
        let fixed = Motion::Fixed(*ground.pose);
        let free = CastAnswer { outcome: CastOutcome::Free, time_lower: config.time_end, ..CastAnswer::default() };
        let mut first = FirstTouch {
            body,
            fixed: &fixed,
            ground,
            config: *config,
            scratch: ground.ground.triangle_shape().copy()?,
            found: GroundCastAnswer { answer: free, triangle: count },
            range_end: config.time_end,
            lower: config.time_end,
            clearance: f64::INFINITY,
            queries: 0,
            bounds: ground.ground.layout().bounds(),
            part_end: config.time_end,
            stretch: 1.0,
        };
        let swept = Swept::new(body, config.range())?;
        let mut before: Option<(f64, NodeBounds)> = None;
        for place in swept.places() {
            let PartEnd { time, pose, off } = place?;
            let reach = GroundReach::new(body.shape.at(&pose), ground)?;
            let beyond = ((off + config.max_distance) / reach.stretch).next_up();
            let here = reach.bounds.grown(beyond);
            if let Some((from, there)) = before.replace((time, here)) {
                first.stretch = reach.stretch;
                first.bounds = here.union(&there);
                first.part_end = time;
                // A contact where a part ends is proved a little later.
                let end = (time + LONGER * config.time_tolerance).min(config.time_end);
                (first.config.time_begin, first.config.time_end) = (from, end);
                ground.ground.layout().walk(&mut first)?;
                if first.found.answer.outcome != CastOutcome::Free {
                    break;
                }
            }
        }
        Ok(first.answer())
    })
}

/// The first contact with the triangles that walks have reached.
struct FirstTouch<'a> {
    body: Carried<'a>,
    fixed: &'a Motion<'a>,
    ground: PlacedGround<'a>,
    /// Its range is that of the part, up to the first contact so far.
    config: CastConfig,
    scratch: TriangleShape,
    found: GroundCastAnswer,
    /// The end of the whole range.
    range_end: f64,
    /// Free of all triangles up to here.
    lower: f64,
    /// Free bodies are so far from all triangles, beyond `max_distance`.
    clearance: f64,
    queries: u32,
    /// What the body sweeps over in the part, grown by `max_distance`, in the frame of the ground.
    bounds: NodeBounds,
    /// What begins after it is the next part's to find, unless it is the last.
    part_end: f64,
    stretch: f64,
}

impl Visit for FirstTouch<'_> {
    fn keys(&self, boxes: &FourBoxes) -> [f64; FOUR] {
        self.bounds.gaps(boxes)
    }

    fn goes_to(&mut self, _: &NodeBounds, gap: f64) -> bool {
        if gap > 0.0 {
            self.clearance = self.clearance.min(gap * self.stretch);
        }
        // A NaN, of boxes beyond the doubles, rules nothing out.
        !(gap > 0.0)
    }

    fn triangle(&mut self, triangle: u32) -> Result<bool> {
        let own = self.ground.ground.triangle(triangle);
        let bounds = NodeBounds::of(&own.corners);
        if !self.goes_to(&bounds, bounds.gap(&self.bounds)) {
            return Ok(true);
        }
        let mut answer = CastAnswer::default();
        let other = Moving { shape: self.scratch.of(&own), motion: self.fixed };
        let (bodies, range) = ([self.body, other.into()], self.config.range());
        cast_carried(bodies, range, &mut PairCache::default(), &self.config, &mut answer)?;
        self.queries += answer.queries;
        let is_free = answer.outcome == CastOutcome::Free;
        let is_later = !is_free && answer.time_lower >= self.part_end && self.part_end < self.range_end;
        match answer.outcome {
            _ if is_later => {}
            CastOutcome::Free | CastOutcome::None => {
                self.clearance = self.clearance.min(answer.clearance - self.config.max_distance);
            }
            CastOutcome::Hit | CastOutcome::Near | CastOutcome::Budget => {
                self.lower = self.lower.min(answer.time_lower);
                let known = &self.found.answer;
                let is_first = match (known.outcome, answer.outcome) {
                    (CastOutcome::Hit, CastOutcome::Hit) => answer.time_upper < known.time_upper,
                    (CastOutcome::Hit, _) => false,
                    (_, CastOutcome::Hit) => true,
                    (CastOutcome::Free, _) => true,
                    _ => answer.time_lower < known.time_lower,
                };
                if is_first {
                    self.found = GroundCastAnswer { answer, triangle };
                }
                let end = if answer.outcome == CastOutcome::Hit { answer.time_upper } else { self.config.time_end };
                self.config.time_end = self.config.time_end.min(end);
            }
        }
        // At the beginning of the part, nothing can be earlier.
        Ok(self.found.answer.outcome != CastOutcome::Hit || self.lower > self.config.time_begin)
    }
}

impl FirstTouch<'_> {
    fn answer(self) -> GroundCastAnswer {
        let mut found = self.found;
        found.answer.queries = self.queries;
        match found.answer.outcome {
            CastOutcome::Free => found.answer.clearance = self.config.max_distance + self.clearance.max(0.0),
            _ => found.answer.time_lower = self.lower,
        }
        found
    }
}
