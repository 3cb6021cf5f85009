//! Poses along a motion, which is prepared once: one of a screw is a sum of three matrices.

use super::kinds::{Motion, Screw, between, check_at};
use super::turn::{Turn, crossed, entry};
use crate::base::error::Result;
use crate::base::math::{Pose, Vector};
use crate::base::simd::environment::with_callers;

/// A motion, prepared.
#[derive(Debug, Clone, Copy)]
pub(super) struct Path<'a> {
    pub motion: &'a Motion<'a>,
    /// How a screw turns.
    pub turn: Turn,
    /// Of a screw that turns about the unit axis a, \[a\]R and −\[a\]R·c,
    pub by_sine: Pose,
    /// \[a\]²R and −\[a\]²R·c: exp(θ\[a\])R is R + sin θ·\[a\]R + (1 − cos θ)·\[a\]²R.
    pub by_versine: Pose,
    /// Where its centre is at time 0.
    pivot: Vector,
}

impl<'a> Path<'a> {
    #[inline]
    pub fn new(motion: &'a Motion<'a>) -> Path<'a> {
        let (zeros, still) = (Pose { rows: [[0.0; 4]; 3] }, Turn { axis: Vector::zeros(), speed: 0.0 });
        let mut path = Path { motion, turn: still, by_sine: zeros, by_versine: zeros, pivot: Vector::zeros() };
        if let Motion::Screw(Screw { start, centre, rotation, .. }) = motion {
            let lever = start.rotate(centre);
            path.turn = Turn::new(rotation);
            path.pivot = start.translation() + lever;
            let mut rows = start.rows;
            (rows[0][3], rows[1][3], rows[2][3]) = (-lever.x, -lever.y, -lever.z);
            path.by_sine.rows = across(&path.turn.axis, &rows);
            path.by_versine.rows = across(&path.turn.axis, &path.by_sine.rows);
        }
        path
    }

    /// The pose of the object at a time, up to rounding.
    ///
    /// # Errors
    /// [`Error::Pose`](crate::base::error::Error::Pose) for a pose that is not accepted.
    #[inline]
    pub fn pose(&self, time: f64) -> Result<Pose> {
        match self.motion {
            Motion::Fixed(pose) => Ok(*pose),
            Motion::Screw(screw) => Ok(self.of_screw(screw, time)),
            Motion::Affine { start, end } => {
                let pose = between(start, end, time);
                check_at(&pose, "the affine motion", time)?;
                Ok(pose)
            }
            Motion::Callback(callback) => {
                let pose = with_callers(|| (callback.pose)(time));
                check_at(&pose, "the motion's callback", time)?;
                Ok(pose)
            }
        }
    }

    /// The order of the sums is that of `rounding_of_pose`.
    #[inline]
    fn of_screw(&self, Screw { start, velocity, .. }: &Screw, time: f64) -> Pose {
        let mut pose = *start;
        for (row, v) in pose.rows.iter_mut().zip(velocity.iter()) {
            row[3] += time * v;
        }
        if self.turn.speed == 0.0 {
            return pose;
        }
        let weights = self.turn.weights(time);
        for (row, (sine, versine)) in pose.rows.iter_mut().zip(self.by_sine.rows.iter().zip(&self.by_versine.rows)) {
            for k in 0..4 {
                row[k] = entry(row[k], [sine[k], versine[k]], weights);
            }
        }
        pose
    }

    /// About how fast a point of the object is at a time, given in its own frame and where it is then. It only guides the search:
    /// for a callback, a difference quotient over `moment` gives it.
    pub fn velocity(&self, time: f64, moment: f64, [point, is_at]: [&Vector; 2]) -> Result<Vector> {
        Ok(match self.motion {
            Motion::Fixed(_) => Vector::zeros(),
            Motion::Screw(Screw { velocity, rotation, .. }) => {
                velocity + rotation.cross(&(is_at - (self.pivot + velocity * time)))
            }
            Motion::Affine { start, end } => end.transform(point) - start.transform(point),
            Motion::Callback(_) => (self.pose(time + moment)?.transform(point) - is_at) / moment,
        })
    }
}

/// The axis times each column.
#[inline]
fn across(axis: &Vector, [x, y, z]: &[[f64; 4]; 3]) -> [[f64; 4]; 3] {
    let mut rows = [[0.0; 4]; 3];
    for k in 0..4 {
        [rows[0][k], rows[1][k], rows[2][k]] = crossed([axis.x, axis.y, axis.z], [x[k], y[k], z[k]]);
    }
    rows
}

#[cfg(test)]
mod tests {
    use super::super::bound::rounding_of_pose;
    use super::*;
    use crate::base::double_double::{DoubleDouble, WideVector, narrow, two_product, wide_cross, wide_dot, widen};
    use crate::base::math::Matrix;
    use swiftprox::random::Random;

    fn sum(a: &WideVector, b: &WideVector) -> WideVector {
        [0, 1, 2].map(|i| a[i] + b[i])
    }

    fn turned(pose: &Pose, v: &WideVector) -> WideVector {
        pose.rows.map(|row| wide_dot(&[row[0], row[1], row[2]].map(DoubleDouble::from), v))
    }

    /// Where a screw has a point, in double-doubles: by the exponential's series, in parts of at most a radian.
    fn place(screw: &Screw, time: f64, point: &Vector) -> WideVector {
        let parts = (time * screw.rotation.norm()).abs().max(1.0).log2().ceil().exp2();
        let [x, y, z] = screw.rotation.into();
        let turn = [x, y, z].map(|w| two_product(time / parts, w));
        let centre = widen(&screw.centre);
        let mut lever = turned(&screw.start, &[0, 1, 2].map(|i| DoubleDouble::from(point[i]) - centre[i]));
        for _ in 0..parts as u32 {
            let mut term = lever;
            for k in 1..30 {
                let inverse = 1.0 / f64::from(k);
                let product = two_product(inverse, f64::from(k));
                let inverse = DoubleDouble { hi: inverse, lo: ((1.0 - product.hi) - product.lo) * inverse };
                term = wide_cross(&turn, &term).map(|x| x * inverse);
                lever = sum(&lever, &term);
            }
        }
        let moved =
            [0, 1, 2].map(|i| DoubleDouble::from(screw.start.rows[i][3]) + two_product(time, screw.velocity[i]));
        sum(&sum(&moved, &turned(&screw.start, &centre)), &lever)
    }

    /// Of screws with skewed rotations, slow and fast, about centres near and far; the bound is of the size of what is seen.
    #[test]
    fn poses_are_as_far_off_as_is_said() {
        let mut random = Random::new(0x9a);
        let mut most = 0.0_f64;
        for round in 0..if cfg!(miri) { 8 } else { 4_000 } {
            let skew = Matrix::from_fn(|_, _| [0.0, 3e-3][round % 2] * random.signed());
            let far = [0.0, 1.0, 1e3, 1e-3][round % 4];
            let screw = Screw {
                start: Pose::new(&(random.rotation() + skew), &(random.vector() * [1.0, 0.0, 1e2][round % 3])),
                centre: random.vector() * far,
                velocity: random.vector() * [0.0, 1.0][round / 2 % 2],
                rotation: random.vector() * [1.0, 1e-8, 4.0, 100.0, 1.0][round % 5],
            };
            let motion = Motion::Screw(screw);
            let path = Path::new(&motion);
            let (time, point) = (random.uniform(-1.0, 2.0), random.vector());
            let pose = path.pose(time).unwrap();
            let [x, y, z] = place(&screw, time, &point);
            let found = sum(&widen(&pose.translation()), &turned(&pose, &widen(&point)));
            let off = narrow(&[found[0] - x, found[1] - y, found[2] - z]).norm();
            let bound = rounding_of_pose(&path, time.abs(), point.norm() + screw.centre.norm());
            assert!(off <= bound, "{round}: {off:e} {bound:e}");
            most = most.max(off / bound);
        }
        assert!(cfg!(miri) || (0.05..0.6).contains(&most), "{most}");
    }

    #[test]
    fn a_pose_at_the_beginning_is_exact() {
        let mut random = Random::new(0x9b);
        for _ in 0..100 {
            let start = Pose::new(&random.rotation(), &random.vector());
            let screw = Screw { start, centre: random.vector(), velocity: random.vector(), rotation: random.vector() };
            assert_eq!(Path::new(&Motion::Screw(screw)).pose(0.0).unwrap(), start);
        }
    }
}
