//! A frame that a motion moves, for bodies of several pieces: where it is at a time, and how far its points get from there.

use super::bound::Travel;
use super::config::check_times;
use super::kinds::Motion;
use super::path::Path;
use crate::base::error::Result;
use crate::base::math::{Pose, UNIT_ROUNDOFF as U, Vector};

/// A moving frame with all that is near its origin.
pub(crate) struct MovingFrame<'a> {
    path: Path<'a>,
    travel: Travel,
    lever: f64,
}

/// A time and the frame's pose there, up to rounding.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Stop {
    pub time: f64,
    pub pose: Pose,
}

impl<'a> MovingFrame<'a> {
    /// For points no farther than `lever` from the frame's origin.
    ///
    /// # Errors
    /// Those of the motion, same as for [`super::cast`]; [`Error::Argument`](crate::base::error::Error::Argument) for times out
    /// of range.
    pub fn new(motion: &'a Motion<'a>, lever: f64, range: [f64; 2]) -> Result<MovingFrame<'a>> {
        check_times(range)?;
        motion.check()?;
        let path = Path::new(motion);
        Ok(MovingFrame { path, travel: Travel::of_frame(&path, range, lever)?, lever })
    }

    /// # Errors
    /// [`Error::Pose`](crate::base::error::Error::Pose) for a pose that no query accepts.
    pub fn at(&self, time: f64) -> Result<Stop> {
        let pose = self.path.pose(time)?;
        pose.check()?;
        Ok(Stop { time, pose })
    }

    /// From the first stop to the last, no point of the motion is farther than this from where the pose in the middle has it.
    ///
    /// A point x that accelerates by at most a stays within a·h²/8 of its chord over a time h. The chord itself has moved by at
    /// most w·|x(end) − x(begin)| from the middle, with w the larger of both parts over h. So x is within a·h²/4 + w·|x(end) −
    /// x(begin)| of x(middle). Poses as computed are off by δ: 2w·δ of both ends, δ of the middle. Between two of them a point
    /// moves by at most |ΔT| + ‖ΔR‖·lever, in the Frobenius norm. All terms are positive, and each is right to 24u: differences of
    /// doubles to u. Squares of entries of ΔR that underflow are below u² together; products that do, below what δ has for that.
    pub fn drift(&self, [begin, middle, end]: [&Stop; 3]) -> f64 {
        debug_assert!(begin.time <= middle.time && middle.time <= end.time);
        let h = end.time - begin.time;
        let Travel { rounding, .. } = self.travel;
        // In this order: the square of a short time underflows.
        let of_bend = 0.25 * (self.travel.most_acceleration() * h * h);
        if !(h > 0.0) {
            return 2.0 * rounding;
        }
        let share = (middle.time - begin.time).max(end.time - middle.time) / h;
        let step = length(&(end.pose.translation() - begin.pose.translation()));
        let turned = (end.pose.rotation() - begin.pose.rotation()).norm() + U;
        (of_bend + share * (step + turned * self.lever) + 3.0 * rounding) * (1.0 + 32.0 * U)
    }
}

/// Right to 8u for any size: scaled, so that no square leaves the doubles.
fn length(v: &Vector) -> f64 {
    let scale = v.amax();
    if scale > 0.0 { (v / scale).norm() * scale } else { 0.0 }
}

#[cfg(test)]
mod tests {
    use super::super::kinds::{Callback, Screw};
    use super::*;
    use crate::base::math::Matrix;
    use swiftprox::random::Random;

    /// Of screws about any centre, fast and slow, of affine motions and callbacks; the bound is of the size of what is seen.
    #[test]
    fn no_point_drifts_farther() {
        let mut random = Random::new(0xd1);
        let mut share = 0.0_f64;
        for round in 0..if cfg!(miri) { 4 } else { 400 } {
            let scale = [1.0, 1e-160, 1e55, 1.0][round % 4];
            let start = Pose::new(&random.rotation(), &(random.vector() * scale));
            let screw = Screw {
                start,
                centre: random.vector() * scale,
                velocity: random.vector() * scale,
                rotation: random.vector() * [0.0, 0.1, 3.0][round % 3],
            };
            let turning = Motion::Screw(screw);
            let path = Path::new(&turning);
            let called = move |time: f64| path.pose(time).unwrap();
            let motions = [
                Motion::Fixed(start),
                Motion::Screw(screw),
                Motion::Affine { start, end: Pose::new(&start.rotation(), &(random.vector() * scale)) },
                Motion::Callback(Callback { pose: &called, bend: 100.0 * scale, rounding: 1e-12 * scale }),
            ];
            for motion in &motions {
                let range = [random.uniform(-1.0, 0.0), random.uniform(0.0, 1.0)];
                let frame = MovingFrame::new(motion, 2.0 * scale, range).unwrap();
                let stops = [range[0], 0.5 * (range[0] + range[1]), range[1]].map(|time| frame.at(time).unwrap());
                let bound = frame.drift([&stops[0], &stops[1], &stops[2]]);
                for k in 0..=16 {
                    let time = range[0] + (range[1] - range[0]) * f64::from(k) / 16.0;
                    let there = frame.at(time.clamp(range[0], range[1])).unwrap();
                    let point = random.direction() * (2.0 * scale);
                    let way = length(&(there.pose.transform(&point) - stops[1].pose.transform(&point)));
                    assert!(way <= bound, "{round}: {way:e} {bound:e}");
                    share = share.max(if matches!(motion, Motion::Screw(_)) { way / bound } else { 0.0 });
                }
            }
        }
        assert!(cfg!(miri) || share > 0.5, "{share}");
        let still = Motion::Fixed(Pose::new(&Matrix::identity(), &Vector::x()));
        let frame = MovingFrame::new(&still, 1.0, [0.0, 0.0]).unwrap();
        let stop = frame.at(0.0).unwrap();
        assert_eq!(frame.drift([&stop, &stop, &stop]), 0.0);
    }
}
