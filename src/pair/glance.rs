//! What settles a query at a glance: bounding spheres that are apart, or the axis that separated the bodies the last time.

use super::contact;
use super::query::{PairQuery, Query, set_interval};
use super::{DecidedBy, PairAnswer, PairConfig, Statistics};
use crate::base::simd::{self, Kernel, Lanes};
use crate::solve::certificate::reciprocal_length;
use crate::solve::frame::Frame;
use crate::solve::separating_axis::{self, AxisSearch, Trial};

impl PairQuery<'_> {
    /// Whether the bounding spheres are farther apart than is enough; the answer then says so, and the cache stays as it is.
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
    pub(super) fn last_axis_separates(&mut self) -> bool {
        self.query == Query::Intersection
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
        let (polyhedra, poses) = (self.pair.polyhedra(), self.pair.poses());
        let &mut PairQuery { config, ref mut answer, .. } = self.pair;
        let frame = Frame::<L>::of_rigid(polyhedra, poses);
        let interval = separating_axis::between_spheres(&frame);
        if !(frame.in_range & (interval.lower > self.enough)) {
            return false;
        }
        answer.decided_by = DecidedBy::BoundingSpheres;
        answer.statistics = Statistics::default();
        set_interval(answer, &interval, frame.separation, config.distance_tolerance);
        let offset = frame.bodies[0].offset;
        contact::fill_normal(answer, offset.mul(L::splat(reciprocal_length(offset.dot(offset)))));
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
        let (polyhedra, poses) = (self.pair.polyhedra(), self.pair.poses());
        let &mut PairQuery { ref mut cache, config, ref mut answer, .. } = self.pair;
        let frame = Frame::<L>::of_rigid(polyhedra, poses);
        let Some(axis) = cache.axis(polyhedra) else { return false };
        if !frame.in_range {
            return false;
        }
        let trial = Trial::of_axis(&frame, &axis);
        if trial.separates() && trial.interval.settles(config.distance_tolerance) {
            cache.move_axis(trial.vertices);
            fill_trial(&trial, config, answer);
            return true;
        }
        let mut search = AxisSearch { frame: &frame, trial };
        L::out_of_line(&mut search);
        let trial = &search.trial;
        let is_answer = trial.separates() && trial.interval.settles(config.distance_tolerance);
        if is_answer {
            let unit = trial.direction.mul(L::splat(trial.inverse));
            cache.remember_axis(trial.vertices, frame.bodies[0].rotate_back(unit).to_vector());
            fill_trial(trial, config, answer);
        }
        is_answer
    }
}

/// The answer of an axis that separates.
#[inline(always)]
fn fill_trial<L: Lanes>(trial: &Trial<L>, config: &PairConfig, answer: &mut PairAnswer) {
    answer.decided_by = DecidedBy::Coherence;
    answer.statistics = Statistics { marching_steps: trial.steps, ..Statistics::default() };
    set_interval(answer, &trial.interval, trial.distance, config.distance_tolerance);
    contact::fill_normal(answer, trial.direction.mul(L::splat(trial.inverse)));
}
