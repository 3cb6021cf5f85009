//! Queries settled at a glance: bounding spheres that are apart, balls inside that overlap, or the axis that separated the bodies
//! the last time.

use super::query::{PairQuery, Surfaces, Sweep};
use crate::answer::{DecidedBy, Outcome, Query, Statistics, contact};
use crate::base::math::UNIT_ROUNDOFF as U;
use crate::base::scalar::{Scalar, constant, dot};
use crate::base::simd::{self, Kernel, Lanes};
use crate::body::polyhedron::SMALLEST;
use crate::distance::certificate::reciprocal_length;
use crate::distance::separating_axis::{self, AxisSearch, AxisTrial};
use crate::placed::frame::{Frame, are_acceptable};
use crate::shape::Placed;

impl<S: Sweep> PairQuery<'_, S> {
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
        let Some(swept) = self.sweep.inner_radius(query) else { return false };
        debug_assert!(swept >= 0.0);
        let [body1, body2] = self.bodies;
        let inner = together([body1.shape.extent().inner_radius, body2.shape.extent().inner_radius], swept);
        (inner >= SMALLEST)
            && self.square_between_origins() < square_of_rigid(inner)
            && self.is_simple()
            && (simd::dispatch(&mut InnerBalls { pair: self }) || self.placed_balls_overlap(swept))
    }

    #[inline(always)]
    fn square_between_origins(&self) -> f64 {
        // Not by `map`, which the compiler may leave out of line.
        let [from, to] = self.poses();
        let [[.., x1], [.., y1], [.., z1]] = from.rows;
        let [[.., x2], [.., y2], [.., z2]] = to.rows;
        square_between([x1, y1, z1], [x2, y2, z2])
    }

    /// The same of rotations that are not rigid.
    #[cold]
    #[inline(never)]
    fn placed_balls_overlap(&mut self, swept: f64) -> bool {
        if !are_acceptable(self.poses()) {
            return false;
        }
        let placed = |body: Placed| shrunk(body.shape.extent().inner_radius, body.pose.rotation_defect());
        let inner = together(self.bodies.map(placed), swept);
        let overlap = inner >= SMALLEST && self.square_between_origins() < inner * inner;
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

/// The square of the difference of two translations, right to 5u of itself; it may underflow.
#[inline(always)]
pub fn square_between<S: Scalar>([x, y, z]: [S; 3], to: [S; 3]) -> S {
    let difference = [x - to[0], y - to[1], z - to[2]];
    dot(difference, difference)
}

/// The sum of two radii and what is swept, right to 2u of itself. A radius below 0, of a segment whose middle is not its origin,
/// is too low by more than rounding and a pose make of it.
#[inline(always)]
pub fn together<S: Scalar>([radius1, radius2]: [S; 2], swept: S) -> S {
    radius1 + radius2 + swept
}

/// What [`square_between`] has to be below for balls to overlap whose radii have this sum before rigid rotations shrink them, by
/// half of [`RIGID_DEFECT`](crate::placed::frame::RIGID_DEFECT) at most: 29u of the square, 5u of the other, 6u of this one.
#[inline(always)]
pub fn square_of_rigid<S: Scalar>(inner: S) -> S {
    inner * inner * constant(1.0 - 42.0 * U)
}

/// A radius after a rotation: with d the largest entry of |RᵀR − I|, at most 1e-2 and computed to 4u, R shrinks no vector by more
/// than 2d of its length. Of the 16u beside that, measuring takes 8u, rounding here 2.1u, that of both squares 5u.
#[inline(always)]
pub fn shrunk<S: Scalar>(radius: S, defect: S) -> S {
    radius * (constant::<S>(1.0) - constant::<S>(2.0) * (defect + constant(8.0 * U)))
}

/// Bounding spheres that seem farther apart than is enough.
struct SphereGlance<'a, 'b, S> {
    pair: &'a mut PairQuery<'b, S>,
    enough: f64,
}

impl<S: Sweep> Kernel for SphereGlance<'_, '_, S> {
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
        pair.settle(&interval, frame.separation);
        let offset = frame.bodies[0].offset;
        contact::fill_normal(pair.answer, offset.mul(L::splat(reciprocal_length(offset.dot(offset)))));
        true
    }
}

/// Inner balls that overlap if the poses are rigid.
struct InnerBalls<'a, 'b, S> {
    pair: &'a mut PairQuery<'b, S>,
}

impl<S: Sweep> Kernel for InnerBalls<'_, '_, S> {
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
struct SeparationGlance<'a, 'b, S> {
    pair: &'a mut PairQuery<'b, S>,
}

impl<S: Sweep> Kernel for SeparationGlance<'_, '_, S> {
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
pub(super) fn answer_by_axis<L: Lanes, S: Sweep>(trial: &AxisTrial<L>, frame: &Frame<L>, pair: &mut PairQuery<S>) {
    let unit = trial.direction.mul(L::splat(trial.inverse));
    pair.cache.remember_axis(trial.vertices, frame.bodies[0].rotate_back(unit).to_vector());
    fill_trial(trial, pair);
}

/// The answer of an axis that separates.
#[inline(always)]
fn fill_trial<L: Lanes, S: Sweep>(trial: &AxisTrial<L>, pair: &mut PairQuery<S>) {
    pair.answer.decided_by = DecidedBy::Coherence;
    pair.answer.statistics = Statistics { marching_steps: trial.steps, ..Statistics::default() };
    match pair.settle(&trial.interval, trial.distance) {
        Surfaces::Nothing => contact::fill_nothing(pair.answer),
        _ => contact::fill_normal(pair.answer, trial.direction.mul(L::splat(trial.inverse))),
    }
}
