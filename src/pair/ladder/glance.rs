//! Queries settled at a glance: bounding spheres that are apart, balls inside that overlap, or the axis that separated the bodies
//! the last time.

use super::query::PairQuery;
use crate::answer::{DecidedBy, Outcome, Query, Statistics, contact};
use crate::base::math::UNIT_ROUNDOFF as U;
use crate::base::simd::{self, Kernel, Lanes};
use crate::body::polyhedron::SMALLEST;
use crate::distance::certificate::reciprocal_length;
use crate::distance::separating_axis::{self, AxisSearch, AxisTrial};
use crate::placed::frame::{Frame, are_acceptable};
use crate::shape::Placed;

impl PairQuery<'_> {
    /// Whether the bounding spheres are farther apart than is enough; the answer then reports that, and the cache stays as it is.
    #[inline(always)]
    pub(super) fn spheres_are_far_apart(&mut self) -> bool {
        let enough = self.enough();
        if enough == f64::INFINITY {
            return false;
        }
        let [body1, body2] = self.polyhedra();
        let radii = body1.radius + body2.radius + enough;
        (self.square_between_origins() > radii * radii)
            && self.is_simple()
            && simd::dispatch(&mut SphereGlance { pair: self, enough })
    }

    /// Whether balls inside the bodies overlap, for a verdict; the cache stays as it is.
    #[inline(always)]
    pub(super) fn inner_balls_overlap(&mut self, query: Query) -> bool {
        query == Query::Intersection && self.balls_overlap(0.0)
    }

    /// The same of bodies over which balls are swept whose radii have this sum, rounded down. Sums of radii lose 6u of their
    /// square at most.
    #[inline(always)]
    pub(super) fn balls_overlap(&mut self, swept: f64) -> bool {
        debug_assert!(swept >= 0.0);
        let [body1, body2] = self.bodies;
        let inner = body1.shape.extent().inner_radius + body2.shape.extent().inner_radius + swept;
        (inner >= SMALLEST)
            && self.square_between_origins() < inner * inner * (1.0 - 256.0 * U)
            && self.is_simple()
            && (simd::dispatch(&mut InnerBalls { pair: self }) || self.placed_balls_overlap(swept))
    }

    /// Of the difference of the translations, right to 5u of itself; it may underflow.
    #[inline(always)]
    fn square_between_origins(&self) -> f64 {
        let [pose1, pose2] = self.poses();
        let [x, y, z] = [0, 1, 2].map(|i| pose1.rows[i][3] - pose2.rows[i][3]);
        x * x + y * y + z * z
    }

    /// The same of rotations that are not rigid: with d the largest entry of |RᵀR − I|, at most 1e-2 and computed to 4u, R shrinks
    /// no vector by more than 2d of its length.
    #[cold]
    #[inline(never)]
    fn placed_balls_overlap(&mut self, swept: f64) -> bool {
        if !are_acceptable(self.poses()) {
            return false;
        }
        let inner =
            |body: &Placed| body.shape.extent().inner_radius * (1.0 - 2.0 * (body.pose.rotation_defect() + 8.0 * U));
        let inner = inner(&self.bodies[0]) + inner(&self.bodies[1]) + swept;
        let overlap = inner >= SMALLEST && self.square_between_origins() < inner * inner * (1.0 - 32.0 * U);
        if overlap {
            self.fill_overlap();
        }
        overlap
    }

    #[inline(always)]
    fn fill_overlap(&mut self) {
        let answer = &mut *self.answer;
        answer.outcome = Outcome::Intersecting;
        answer.decided_by = DecidedBy::InscribedSpheres;
        (answer.distance, answer.lower, answer.upper) = (0.0, 0.0, 0.0);
        answer.proof_count = 0;
        answer.statistics = Statistics::default();
        contact::fill_nothing(answer);
    }

    /// Whether the axis of the last verdict, or one that it leads to, separates the bodies.
    #[inline(always)]
    pub(super) fn last_axis_separates(&mut self, query: Query) -> bool {
        query == Query::Intersection
            && self.cache.axis(self.polyhedra()).is_some()
            && simd::dispatch(&mut SeparationGlance { pair: self })
    }
}

/// Bounding spheres that seem farther apart than is enough.
struct SphereGlance<'a, 'b> {
    pair: &'a mut PairQuery<'b>,
    enough: f64,
}

impl Kernel for SphereGlance<'_, '_> {
    type Output = bool;

    #[inline(always)]
    fn run<L: Lanes>(&mut self) -> bool {
        let pair = &mut *self.pair;
        let frame = pair.frame_of_simple::<L>();
        let interval = separating_axis::between_spheres(&frame);
        if !(frame.in_range & (interval.lower > self.enough)) {
            return false;
        }
        pair.answer.decided_by = DecidedBy::BoundingSpheres;
        pair.answer.statistics = Statistics::default();
        pair.set_interval(&interval, frame.separation);
        let offset = frame.bodies[0].offset;
        contact::fill_normal(pair.answer, offset.mul(L::splat(reciprocal_length(offset.dot(offset)))));
        true
    }
}

/// Inner balls that overlap if the poses are rigid: then R shrinks them by less than 58u, and the squares leave 64u each.
struct InnerBalls<'a, 'b> {
    pair: &'a mut PairQuery<'b>,
}

impl Kernel for InnerBalls<'_, '_> {
    type Output = bool;

    #[inline(always)]
    fn run<L: Lanes>(&mut self) -> bool {
        let is_in_range = self.pair.frame_of_simple::<L>().in_range;
        if is_in_range {
            self.pair.fill_overlap();
        }
        is_in_range
    }
}

/// The common case of the verdict alone: the axis of the last query separates, or nearly.
struct SeparationGlance<'a, 'b> {
    pair: &'a mut PairQuery<'b>,
}

impl Kernel for SeparationGlance<'_, '_> {
    type Output = bool;

    #[inline(always)]
    fn run<L: Lanes>(&mut self) -> bool {
        let pair = &mut *self.pair;
        let frame = pair.frame_of_simple::<L>();
        let Some(axis) = pair.cache.axis(pair.polyhedra()) else { return false };
        if !frame.in_range {
            return false;
        }
        let trial = AxisTrial::of_axis(&frame, &axis);
        if trial.separates() && pair.is_settled_by(&trial.interval) {
            pair.cache.move_axis(trial.vertices);
            fill_trial(&trial, pair);
            return true;
        }
        let mut search = AxisSearch { frame: &frame, trial };
        L::out_of_line(&mut search);
        let is_answer = search.trial.separates() && pair.is_settled_by(&search.trial.interval);
        if is_answer {
            answer_by_axis(&search.trial, &frame, pair);
        }
        is_answer
    }
}

/// The answer of a new axis that separates; the cache keeps it beside the features that it has.
#[inline(always)]
pub(super) fn answer_by_axis<L: Lanes>(trial: &AxisTrial<L>, frame: &Frame<L>, pair: &mut PairQuery) {
    let unit = trial.direction.mul(L::splat(trial.inverse));
    pair.cache.remember_axis(trial.vertices, frame.bodies[0].rotate_back(unit).to_vector());
    fill_trial(trial, pair);
}

/// The answer of an axis that separates.
#[inline(always)]
fn fill_trial<L: Lanes>(trial: &AxisTrial<L>, pair: &mut PairQuery) {
    pair.answer.decided_by = DecidedBy::Coherence;
    pair.answer.statistics = Statistics { marching_steps: trial.steps, ..Statistics::default() };
    pair.set_interval(&trial.interval, trial.distance);
    contact::fill_normal(pair.answer, trial.direction.mul(L::splat(trial.inverse)));
}
