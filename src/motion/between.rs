//! The motion from one pose to another.

use super::bound::rounding_of_pose;
use super::kinds::{Motion, Screw, check_finite};
use super::path::Path;
use crate::base::angles::arctangent;
use crate::base::error::{Result, check_range};
use crate::base::math::{Matrix, Pose, UNIT_ROUNDOFF as U, Vector};
use crate::base::simd::environment::with_default;

/// The motion about a centre, given in the object's frame, that starts at `first` at time 0 and by the shortest turn reaches
/// `second` at time 1; and how far from there at most a point ends that is at most `reach` from the centre: rounding, and
/// whatever one of the two rotations is more distorted than the other.
///
/// # Errors
/// `Error::Pose` for a pose that is not accepted; `Error::Argument` for a centre that is not finite and a reach that is not from 0
/// to the largest double.
pub fn motion_between(first: &Pose, second: &Pose, centre: &Vector, reach: f64) -> Result<(Screw, f64)> {
    with_default(|| {
        first.check()?;
        second.check()?;
        check_finite("centre", centre)?;
        check_range("reach", reach, 0.0..=f64::MAX)?;
        let rotation = shortest_turn(&(second.rotation() * first.rotation().transpose()));
        let velocity = second.translation() - first.translation() + (second.rotate(centre) - first.rotate(centre));
        let screw = Screw { start: *first, centre: *centre, velocity, rotation };
        Ok((screw, end_error(screw, second, reach)?))
    })
}

/// How far a point within `reach` of the centre may be at time 1 from where `second` has it.
fn end_error(screw: Screw, second: &Pose, reach: f64) -> Result<f64> {
    let motion = Motion::Screw(screw);
    let path = Path::new(&motion);
    let end = path.pose(1.0)?;
    let differences = end.rotation() - second.rotation();
    let centres =
        (end.translation() - second.translation()) + (end.rotate(&screw.centre) - second.rotate(&screw.centre));
    // Rounded a dozen times, each by u of what is there.
    let size = end.translation().norm() + second.translation().norm() + 4.0 * screw.centre.norm();
    // Of a point p it counts |p| + |c|, and |p| is at most the reach and |c|.
    let rounding = rounding_of_pose(&path, 1.0, reach + 2.0 * screw.centre.norm() * (1.0 + 8.0 * U));
    Ok((rounding + differences.norm() * reach + centres.norm() + 16.0 * U * size) * (1.0 + 32.0 * U))
}

/// The vector along the axis of a rotation, as long as its angle from 0 to π. By the largest of the four components of the
/// quaternion (S. W. Shepperd, "Quaternion from Rotation Matrix", 1978), so that no digits are lost near 0 and π.
fn shortest_turn(r: &Matrix) -> Vector {
    let squares = [
        1.0 + r.trace(),
        1.0 + r[(0, 0)] - r[(1, 1)] - r[(2, 2)],
        1.0 - r[(0, 0)] + r[(1, 1)] - r[(2, 2)],
        1.0 - r[(0, 0)] - r[(1, 1)] + r[(2, 2)],
    ];
    let differences = [r[(2, 1)] - r[(1, 2)], r[(0, 2)] - r[(2, 0)], r[(1, 0)] - r[(0, 1)]];
    let sum = |i: usize, j: usize| r[(i, j)] + r[(j, i)];
    let largest = (0..4).fold(0, |best, k| if squares[k] > squares[best] { k } else { best });
    let [x, y, z] = differences;
    let (w, part) = match largest {
        0 => (squares[0], Vector::new(x, y, z)),
        1 => (x, Vector::new(squares[1], sum(0, 1), sum(0, 2))),
        2 => (y, Vector::new(sum(0, 1), squares[2], sum(1, 2))),
        _ => (z, Vector::new(sum(0, 2), sum(1, 2), squares[3])),
    };
    let (part, w) = if w < 0.0 { (-part, -w) } else { (part, w) };
    let length = part.norm();
    if length > 0.0 { part * (2.0 * arctangent(length, w) / length) } else { Vector::zeros() }
}

#[cfg(test)]
mod tests {
    use super::*;
    use swiftprox::random::Random;

    #[test]
    fn motions_end_where_they_should() {
        let mut random = Random::new(0xbe);
        for round in 0..2_000 {
            let [first, second] = [0, 1].map(|i| {
                let turn = if round % 3 == 0 { random.quarter_turns() } else { random.rotation() };
                let far = if round % 5 == 4 { 1e9 } else { 1.0 };
                Pose::new(&turn, &(random.vector() * far * f64::from(i + 1)))
            });
            let centre = if round % 2 == 0 { Vector::zeros() } else { random.vector() };
            let (screw, error) = motion_between(&first, &second, &centre, 1.0).unwrap();
            assert!(screw.rotation.norm() <= std::f64::consts::PI * (1.0 + 8.0 * U));
            let motion = Motion::Screw(screw);
            let end = Path::new(&motion).pose(1.0).unwrap();
            let point = centre + random.direction();
            assert!((end.transform(&point) - second.transform(&point)).norm() <= error);
            let size = second.translation().norm() + 8.0;
            assert!(error <= 800.0 * U * size, "{round}: {error:e}");
        }
    }
}
