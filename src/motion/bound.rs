//! The bounds that carry a proof from one moment to the next, and the rounding error of a pose.
//!
//! *Between two moments.* Along a fixed world direction n from object 2 to object 1 the gap of the bodies is the least n·x₁ over
//! points of object 1 less the greatest n·x₂ over those of object 2. If n·ẍ₁ − n·ẍ₂ ≤ K for all of them, each n·(x₁ − x₂) stays
//! above its chord less B·s(1 − s), B = K·h²/2, s from 0 to 1 over a time h; so does their minimum, the gap. Both bodies are taken
//! at the same time: bodies that move together cost nothing.
//!
//! *Along a direction that turns.* A face that turns with its body soon sticks out along a fixed n, wherever the nearest points
//! are: the gap closes long before the bodies touch. So let n(s) = (1 − s)n₀ + s·n₁ go from the normal at one moment to that at the
//! other, d = n₁ − n₀. It is no longer than 1, so that n(s)·(x₁ − x₂) > 0 proves as large a gap. Its second derivative is n·(ẍ₁ −
//! ẍ₂) + 2(d/h)·(ẋ₁ − ẋ₂). The first term is convex in n, so that both ends bound it. In the second d·(ẋ₁ − ẋ₂) differs by at most
//! A·h/2 from its mean, which is d·(Δx₁ − Δx₂)/h, for |d·(ẍ₁ − ẍ₂)| ≤ A. So
//!
//!   B = K·h²/2 + max d·(Δx₁ − Δx₂) + A·h²/2,
//!
//! for any motion: Δx, where a point is at one moment less where it was at the other, is known from both poses. If features stay
//! the nearest, d and Δx shrink with h: B does with h², the gap with h. (Swept radii take |n(s)|·r off the gap, which is no more
//! than r.)
//!
//! *Rounding.* A query is about the pose as computed. No point of the motion is farther than δ from where that pose has it; along a
//! unit direction no gap is then off by more than the sum of both δ, and bodies deeper in each other than that sum intersect.

use super::carried::Carried;
use super::kinds::{Callback, Motion, Screw};
use super::path::Path;
use crate::base::angles::LARGEST_ANGLE;
use crate::base::error::{Error, Result};
use crate::base::math::{Pose, STRETCH, UNIT_ROUNDOFF as U, Vector};
use crate::base::scalar::{Scalar, constant};
use crate::body::polyhedron::LARGEST;

/// Times are of at most this, 2¹⁰⁰, so that products with them stay far inside the doubles.
pub(super) const LARGEST_TIME: f64 = f64::from_bits((1023 + 100) << 52);

/// The loss to underflow of products of numbers in range, several times over.
pub(super) const UNDERFLOW: f64 = f64::from_bits((1023 - 800) << 52);

/// The bounds of one object over a range of times.
#[derive(Debug, Clone, Copy)]
pub(super) struct Travel {
    /// δ for any time of the range.
    pub rounding: f64,
    bend: Bend,
}

/// How a motion may curve.
#[derive(Debug, Clone, Copy)]
enum Bend {
    /// All points go straight, at a constant speed.
    None,
    /// All points turn about an axis: the unit vector along it, and ω²·r for the largest distance r of a point from it.
    Turn { axis: Vector, most: f64 },
    /// The largest acceleration.
    Any(f64),
}

impl Travel {
    /// # Errors
    /// [`Error::Argument`] for values so large that doubles do not bound them.
    pub fn new(body: &Carried, path: &Path, range: [f64; 2]) -> Result<Travel> {
        let from_axis = |screw: &Screw| distance_from_axis(body, screw, path);
        Travel::within(path, range, reach(body), from_axis)
    }

    /// Of all that is no farther than `lever` from the origin of the moving frame.
    ///
    /// # Errors
    /// As of [`Travel::new`].
    pub fn of_frame(path: &Path, range: [f64; 2], lever: f64) -> Result<Travel> {
        debug_assert!(lever >= 0.0);
        let reach = reach_from_centre(path.motion, lever);
        Travel::within(path, range, reach, |_| STRETCH * reach * (1.0 + 8.0 * U))
    }

    fn within(path: &Path, range: [f64; 2], reach: f64, from_axis: impl FnOnce(&Screw) -> f64) -> Result<Travel> {
        debug_assert!(range[0] <= range[1]);
        let longest = range[0].abs().max(range[1].abs());
        check_sizes(path, longest, reach)?;
        let turn = &path.turn;
        let bend = match path.motion {
            Motion::Fixed(_) | Motion::Affine { .. } => Bend::None,
            Motion::Screw(screw) if turn.speed > 0.0 => {
                // The axis is off by 6.5u, the square of the speed by 12u.
                let most = turn.speed * turn.speed * from_axis(screw) * (1.0 + 64.0 * U);
                Bend::Turn { axis: turn.axis, most }
            }
            Motion::Screw(_) => Bend::None,
            Motion::Callback(Callback { bend, .. }) => Bend::Any(*bend),
        };
        Ok(Travel { rounding: rounding_of_pose(path, longest, reach), bend })
    }

    /// No point accelerates by more along a vector of at most unit length, right to 8u, or against it: times that length.
    ///
    /// A turning point accelerates towards the axis, by ω²·r. Only the part of the direction across the axis counts; its rounding
    /// error is below 32u.
    pub fn acceleration(&self, direction: &Vector) -> f64 {
        debug_assert!(direction.norm_squared() <= 1.0 + 1e-9);
        match self.bend {
            Bend::None => 0.0,
            Bend::Turn { axis, most } => {
                let across = direction - axis * axis.dot(direction);
                most * (across.norm() * (1.0 + 16.0 * U) + 32.0 * U)
            }
            Bend::Any(most) => most * direction.norm() * (1.0 + 32.0 * U),
        }
    }

    /// No point accelerates by more, along any vector.
    pub fn most_acceleration(&self) -> f64 {
        match self.bend {
            Bend::None => 0.0,
            Bend::Turn { most, .. } => most * (1.0 + 16.0 * U),
            Bend::Any(most) => most,
        }
    }
}

/// No point of the body is farther from the point of the moving frame that the motion's pose keeps.
fn reach(body: &Carried) -> f64 {
    let lever = body.shape.extent().lever;
    let lever = body.place.map_or(lever, |place| STRETCH * lever + place.translation().norm() * (1.0 + 8.0 * U));
    reach_from_centre(body.motion, lever)
}

/// The same for points within `lever` of the moving frame's origin.
fn reach_from_centre(motion: &Motion, lever: f64) -> f64 {
    match motion {
        Motion::Screw(screw) => (lever + screw.centre.norm()) * (1.0 + 8.0 * U),
        _ => lever,
    }
}

/// No point of the body is farther from the axis: by its box or by its bounding sphere, whichever gives less.
///
/// The distance of a point p is |\[a\]R(p − c)|. Entries of \[a\]R err by 11u in the spectral norm ([`rounding_of_pose`]), their
/// products with a vector by 5.3u more, a place's by 5.4u, and each of four sums by u: less than 32u of all lengths. These are
/// those of the centres and the place, at most ρ to the middle of the box and at most ρ along each of its sides.
fn distance_from_axis(body: &Carried, screw: &Screw, path: &Path) -> f64 {
    let polyhedron = body.shape.polyhedron();
    let (middle, half) = body.shape.extent().box_about_centre();
    let placed = |p: Vector| body.place.map_or(p, |place| place.transform(&p));
    let of_point = |p: Vector| path.by_sine.rotate(&(placed(p) - screw.centre));
    let [x, y, z] = [0, 1, 2].map(|axis| {
        let mut side = Vector::zeros();
        side[axis] = half[axis];
        path.by_sine.rotate(&body.place.map_or(side, |place| place.rotate(&side)))
    });
    let middle = of_point(polyhedron.centre + middle);
    // A corner and the one opposite.
    let of_diagonal = |side: Vector| (middle + side).norm_squared().max((middle - side).norm_squared());
    let farthest = [x + y + z, x + y - z, x - y + z, x - y - z].map(of_diagonal).into_iter().fold(0.0, f64::max).sqrt();
    let (stretch, place) = body.place.map_or((STRETCH, 0.0), |place| (STRETCH * STRETCH, place.translation().norm()));
    let around_sphere = of_point(polyhedron.centre).norm() + stretch * polyhedron.radius;
    let size = polyhedron.radius + polyhedron.centre.norm() + screw.centre.norm() + place;
    farthest.min(around_sphere) + 160.0 * U * size
}

/// How far at most a point of a body is, at the body's pose as computed, from where the pose of the moving frame as computed has
/// it: the rounding error of the product of that pose and the place.
///
/// Each entry of the rotation errs by 3u of its three terms, and the Frobenius norms of the factors are at most 1.77: below 9.5u in
/// the spectral norm. The product R·T of the place errs by 3u of its terms, below 5.4u|T|, the sum by u of the computed
/// translation.
pub(super) fn rounding_of_place(body: &Carried, pose: &Pose) -> f64 {
    body.place.map_or(0.0, |place| {
        let (of_place, of_pose) = (place.translation().norm(), pose.translation().norm());
        U * (10.0 * body.shape.extent().lever + 6.0 * of_place + 2.0 * of_pose) + UNDERFLOW
    })
}

/// The error of a turned rotation, in u of the angle …
pub const OF_ANGLE: f64 = 8.0;

/// … and in u beside that, see [`rounding_of_pose`].
pub const OF_TURN: f64 = 96.0;

/// How far at most a point p is from where the computed pose has it, at a time of up to `longest`. Of a screw with the centre c
/// |p| + |c| is within `reach`, of another motion |p|. At time 0, and at 1 of an affine motion, poses are exact ([`is_exact`]).
///
/// *Screw.* R(t) = R + s·P₁ + q·P₂ for P₁ = \[a\]R, P₂ = \[a\]²R, s = sin θ, q = 1 − cos θ. The angle errs by 6.5u of itself and
/// R(t) by 1.015 times as much. The axis is off by 6.5u: P₁ by 6.6u, P₂ by 13.2u. An entry of a product with \[a\] errs by 2u of
/// its two terms; \[|a|\] has the spectral norm 2/√3, R and P₁ have a Frobenius norm of 1.75: 4.1u for P₁, twice that for P₂.
///
/// With these, 10.7u and 21.4u, s·P₁ + q·P₂ errs by at most 21.4u + |(10.7, 21.4)|u, below 45.4u; by 4u of s and 6u of q
/// ([`Turn::weights`](super::turn::Turn::weights)) 10.2u more. The two products and two sums of an entry are each of at most |R|,
/// |s·P₁| or |q·P₂|: below 3u(1 + |s| + q)·1.75 < 18u. All is below (7·angle + 74)u.
///
/// The last column is T + t·v − (s·P₁ + q·P₂)c by the same products of −R·c, which is rounded by 5.3u|c|: by s and q below 13u|c|
/// more. So a point p is off by (7·angle + 74)u(|p| + |c|) + 13u|c|, and by 2u|T| + 3u|t·v|.
///
/// *Affine.* Each entry errs by 3u of its two terms, the Frobenius norm of R is at most 1.77.
pub(super) fn rounding_of_pose(path: &Path, longest: f64, reach: f64) -> f64 {
    debug_assert!(longest >= 0.0 && reach >= 0.0);
    let length = |v: &Vector| v.norm() * (1.0 + 8.0 * U);
    match path.motion {
        Motion::Fixed(_) => 0.0,
        Motion::Screw(Screw { start, centre, velocity, rotation }) => {
            let (moves, turns) = (velocity.amax() > 0.0, rotation.amax() > 0.0);
            let (centre, way) = (length(centre), longest * length(velocity));
            // A body that turns about its own origin stays there exactly.
            let keeps_translation = !moves && (!turns || centre == 0.0);
            let of_translation =
                if keeps_translation { 0.0 } else { 4.0 * (length(&start.translation()) + way) + 16.0 * centre };
            let of_turn = if turns { (OF_ANGLE * longest * path.turn.speed + OF_TURN) * reach } else { 0.0 };
            let underflow = if moves || turns { UNDERFLOW } else { 0.0 };
            U * (of_translation + of_turn) + underflow
        }
        Motion::Affine { start, end } => {
            let weights = [1.0 + longest, longest];
            let size = |pose: &Pose| 1.77 * reach + length(&pose.translation());
            4.0 * U * (weights[0] * size(start) + weights[1] * size(end)) + UNDERFLOW
        }
        Motion::Callback(Callback { rounding, .. }) => *rounding,
    }
}

/// Whether the pose at a time is the motion's own, without rounding.
pub(super) fn is_exact(motion: &Motion, time: f64) -> bool {
    match motion {
        Motion::Fixed(_) => true,
        Motion::Screw(_) => time == 0.0,
        Motion::Affine { .. } => time == 0.0 || time == 1.0,
        Motion::Callback(Callback { rounding, .. }) => *rounding == 0.0,
    }
}

/// The least gap between two moments, rounded down, from the gaps at both and B, `sag`.
///
/// (1 − s)g₀ + s·g₁ − B·s(1 − s) is least at s = (B − (g₁ − g₀))/2B, if that is between 0 and 1. Directions are of unit length up
/// to 4u: with the rounding here that is less than 32u.
pub(super) fn least_between(gaps: [f64; 2], sag: f64) -> f64 {
    debug_assert!(sag >= 0.0 || sag.is_nan());
    let [first, last] = gaps;
    let rise = last - first;
    let least = if sag > rise.abs() { least_within(first, rise, sag) } else { first.min(last) };
    let rounded = least - LEAST_BETWEEN * (first.abs() + last.abs() + sag);
    // An infinite value or a NaN proves nothing.
    if rounded.is_finite() { rounded } else { f64::NEG_INFINITY }
}

/// The error of [`least_between`], over both gaps and B.
pub const LEAST_BETWEEN: f64 = 32.0 * U;

/// The least of a chord less B·s(1 − s), where that is within.
#[inline(always)]
pub fn least_within<S: Scalar>(first: S, rise: S, sag: S) -> S {
    let excess = sag - rise;
    first - excess * excess / (constant::<S>(4.0) * sag)
}

fn check_sizes(path: &Path, longest: f64, reach: f64) -> Result<()> {
    if !(longest <= LARGEST_TIME) {
        return Err(Error::Argument(format!(
            "a time is {longest:e}, it must be at most {LARGEST_TIME:e} in magnitude"
        )));
    }
    let angle = longest * path.turn.speed;
    if !(angle <= LARGEST_ANGLE) {
        return Err(Error::Argument(format!(
            "a motion turns by {angle:e} radians, it may turn by {LARGEST_ANGLE:e}: ask in parts"
        )));
    }
    let far = match path.motion {
        Motion::Fixed(pose) => pose.translation().amax(),
        Motion::Screw(screw) => screw.start.translation().amax().max(longest * screw.velocity.amax()),
        Motion::Affine { start, end } => (1.0 + longest) * start.translation().amax().max(end.translation().amax()),
        Motion::Callback(_) => 0.0,
    };
    if !(far.max(reach) <= LARGEST) {
        return Err(Error::Argument(format!("a motion reaches {:e}, it may reach {LARGEST:e}", far.max(reach))));
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_least_gap_is_that_of_the_sagging_chord() {
        for (gaps, sag) in [([1.0, 2.0], 0.0), ([1.0, 1.0], 1.0), ([3.0, 0.5], 1.96), ([1e-12, 5.0], 5e-7)] {
            let chord = |s: f64| (1.0 - s) * gaps[0] + s * gaps[1] - sag * s * (1.0 - s);
            let least = (0..=10_000).map(|k| chord(f64::from(k) / 1e4)).fold(f64::INFINITY, f64::min);
            let bound = least_between(gaps, sag);
            assert!(bound <= least && bound > least - 1e-6, "{gaps:?}: {bound} {least}");
        }
        assert_eq!(least_between([1.0, f64::NEG_INFINITY], 0.0), f64::NEG_INFINITY);
        assert_eq!(least_between([1.0, 1.0], f64::INFINITY), f64::NEG_INFINITY);
        assert_eq!(least_between([1.0, f64::NAN], 0.5), f64::NEG_INFINITY);
    }
}
