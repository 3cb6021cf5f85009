//! Approximate distances by look-ups of both bodies' support functions: an approximate query need not find the nearest features.

use super::query::{NoBalls, PairQuery, Sweep};
use crate::answer::{DecidedBy, Levels, Query, Start, Statistics, contact};
use crate::base::error::Result;
use crate::base::simd::{self, Kernel, Lanes};
use crate::body::tables::support_map::{Choice, Grids};
use crate::distance::certificate::reciprocal_length;
use crate::distance::support_search::SupportSearch;
use crate::pair::cache::Lean;
use crate::placed::frame::Frame;
use crate::shape::Shape;

/// The square of an angle times the root of the vertices: pairs that move by less from query to query are answered faster by
/// marching from their last features. For bodies of 1,002 vertices that is 2.2°, of 10,002 0.7°.
const STILL: f64 = 1.44;

/// From which error on maps of support functions may answer an approximate query about two bodies; infinite where they never do.
#[inline(always)]
pub(super) fn least_error(shapes: [&Shape; 2]) -> f64 {
    let [error1, error2] = [shapes[0].support_map.least_error(), shapes[1].support_map.least_error()];
    if error1 > error2 { error1 } else { error2 }
}

impl<S: Sweep> PairQuery<'_, S> {
    /// Whether look-ups of the support functions may answer it: that takes bodies of many vertices and an error that leaves room.
    #[inline(always)]
    pub(super) fn may_ask_support_maps(&self, query: Query) -> bool {
        (query == Query::Approximate)
            && (self.config.levels == Levels::Automatic)
                & (self.config.start == Start::Automatic)
                & !self.has_budget(query)
                & self.is_simple()
            && self.surely_most_error() >= least_error(self.shapes())
    }
}

impl<'a> PairQuery<'a, NoBalls> {
    /// Whether look-ups answer it; answer and cache are then written.
    #[inline(always)]
    pub(super) fn support_maps_answer(&mut self) -> Result<bool> {
        let Some(grids) = self.grids()? else { return Ok(false) };
        Ok(simd::dispatch(&mut SupportMaps { pair: self, grids }))
    }

    /// The grids that are fine enough for the error, made where they are missing, unless the query is refused.
    #[inline(always)]
    fn grids(&self) -> Result<Option<[Grids<'a>; 2]>> {
        let ([shape1, shape2], error) = (self.shapes(), self.surely_most_error());
        let mut choices = [grids_of(shape1, error), grids_of(shape2, error)];
        if matches!(choices, [Choice::NotMade, _] | [_, Choice::NotMade]) {
            self.check_poses()?;
            shape1.support_map.make_for(shape1.polyhedron(), error);
            shape2.support_map.make_for(shape2.polyhedron(), error);
            choices = [grids_of(shape1, error), grids_of(shape2, error)];
        }
        Ok(match choices {
            [Choice::Grids(first), Choice::Grids(second)] => Some([first, second]),
            _ => None,
        })
    }
}

#[inline(always)]
fn grids_of(shape: &Shape, error: f64) -> Choice<'_> {
    shape.support_map.choose(error)
}

struct SupportMaps<'a, 'b> {
    pair: &'a mut PairQuery<'b, NoBalls>,
    grids: [Grids<'b>; 2],
}

impl Kernel for SupportMaps<'_, '_> {
    type Output = bool;

    #[inline(always)]
    fn run<L: Lanes>(&mut self) -> bool {
        let frame = self.pair.frame_of_simple::<L>();
        if !frame.in_range {
            return false;
        }
        let first = first_direction(self.pair, &frame);
        let mut search = SupportSearch::new(&frame, self.grids, first);
        let accuracy = self.pair.accuracy();
        loop {
            search.look();
            let found = search.interval();
            if accuracy.is_met_by(found.lower, found.upper) {
                break;
            }
            if !search.advance() {
                return false;
            }
        }
        let (found, normal) = (search.interval(), search.normal());
        let pair = &mut *self.pair;
        pair.answer.decided_by = DecidedBy::Tolerance;
        pair.answer.statistics = Statistics::default();
        pair.set_open_interval(&found, found.lower);
        contact::fill_normal(pair.answer, normal);
        let lean = Lean::of(normal.dot(frame.bodies[0].offset) / frame.separation);
        pair.cache.remember_direction(frame.bodies[0].rotate_back(normal).to_vector(), lean);
        let [body1, body2] = frame.polyhedra();
        let still = STILL / body1.vertices.len().max(body2.vertices.len()) as f64;
        pair.cache.note_look_ups(!frame.has_moved(&pair.cache.marker, still));
        frame.mark(&mut pair.cache.marker);
        true
    }
}

/// The direction of the last query where the bodies lie as they did, else that of the line between their origins.
#[inline(always)]
fn first_direction<L: Lanes>(pair: &PairQuery<NoBalls>, frame: &Frame<L>) -> L {
    let offset = frame.bodies[0].offset;
    let between = offset.mul(L::splat(reciprocal_length(offset.dot(offset))));
    let Some((axis, lean)) = pair.cache.direction() else { return between };
    let direction = frame.bodies[0].rotate(&axis);
    let direction = direction.mul(L::splat(reciprocal_length(direction.dot(direction))));
    if lean.is_near(direction.dot(between)) { direction } else { between }
}
