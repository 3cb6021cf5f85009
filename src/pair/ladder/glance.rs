//! Queries settled at a glance: bounding spheres that are apart, or the axis that separated the bodies the last time.

use super::query::PairQuery;
use crate::base::simd::{self, Kernel, Lanes};
use crate::pair::answer::{DecidedBy, Statistics};
use crate::pair::config::Query;
use crate::pair::contact;
use crate::solve::certificate::reciprocal_length;
use crate::solve::separating_axis::{self, AxisSearch, Trial};

impl PairQuery<'_> {
    /// Whether the bounding spheres are farther apart than is enough; the answer then reports that, and the cache stays as it is.
    #[inline(always)]
    pub(super) fn spheres_are_far_apart(&mut self) -> bool {
        let enough = self.enough();
        if enough == f64::INFINITY {
            return false;
        }
        let ([body1, body2], [pose1, pose2]) = (self.polyhedra(), self.poses());
        let radii = body1.radius + body2.radius + enough;
        let [x, y, z] = [0, 1, 2].map(|i| pose1.rows[i][3] - pose2.rows[i][3]);
        (x * x + y * y + z * z > radii * radii)
            && self.is_simple()
            && simd::dispatch(&mut Spheres { pair: self, enough })
    }

    /// Whether the axis of the last verdict, or one that it leads to, separates the bodies.
    #[inline(always)]
    pub(super) fn last_axis_separates(&mut self, query: Query) -> bool {
        query == Query::Intersection
            && self.cache.axis(self.polyhedra()).is_some()
            && simd::dispatch(&mut Separation { pair: self })
    }
}

/// Bounding spheres that seem farther apart than is enough.
struct Spheres<'a, 'b> {
    pair: &'a mut PairQuery<'b>,
    enough: f64,
}

impl Kernel for Spheres<'_, '_> {
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

/// The common case of the verdict alone: the axis of the last query separates, or nearly.
struct Separation<'a, 'b> {
    pair: &'a mut PairQuery<'b>,
}

impl Kernel for Separation<'_, '_> {
    type Output = bool;

    #[inline(always)]
    fn run<L: Lanes>(&mut self) -> bool {
        let pair = &mut *self.pair;
        let frame = pair.frame_of_simple::<L>();
        let Some(axis) = pair.cache.axis(pair.polyhedra()) else { return false };
        if !frame.in_range {
            return false;
        }
        let trial = Trial::of_axis(&frame, &axis);
        if trial.separates() && pair.is_settled_by(&trial.interval) {
            pair.cache.move_axis(trial.vertices);
            fill_trial(&trial, pair);
            return true;
        }
        let mut search = AxisSearch { frame: &frame, trial };
        L::out_of_line(&mut search);
        let trial = &search.trial;
        let is_answer = trial.separates() && pair.is_settled_by(&trial.interval);
        if is_answer {
            let unit = trial.direction.mul(L::splat(trial.inverse));
            pair.cache.remember_axis(trial.vertices, frame.bodies[0].rotate_back(unit).to_vector());
            fill_trial(trial, pair);
        }
        is_answer
    }
}

/// The answer of an axis that separates.
#[inline(always)]
fn fill_trial<L: Lanes>(trial: &Trial<L>, pair: &mut PairQuery) {
    pair.answer.decided_by = DecidedBy::Coherence;
    pair.answer.statistics = Statistics { marching_steps: trial.steps, ..Statistics::default() };
    pair.set_interval(&trial.interval, trial.distance);
    contact::fill_normal(pair.answer, trial.direction.mul(L::splat(trial.inverse)));
}
