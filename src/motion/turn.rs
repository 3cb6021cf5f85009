//! Turns about an axis, right to a bound that is derived here.

use crate::base::angles::sin_cos;
use crate::base::math::Vector;
use crate::base::scalar::{Scalar, constant, dot};

/// A constant angular velocity.
#[derive(Debug, Clone, Copy)]
pub(super) struct Turn {
    /// The unit axis, off by at most 6.5u of its length; 0 where nothing turns.
    pub axis: Vector,
    /// Radians per unit of time, off by at most 5.5u of themselves.
    pub speed: f64,
}

impl Turn {
    /// From the vector along the axis whose length is the speed, all of it finite.
    ///
    /// Scaled so that its largest component is 1, for any size. Quotients err by u, the sum of squares by 5u, its root by 3.5u,
    /// speed and axis by two more roundings.
    pub fn new(rotation: &Vector) -> Turn {
        let scale = rotation.amax();
        if !(scale > 0.0) {
            return Turn { axis: Vector::zeros(), speed: 0.0 };
        }
        let (axis, speed) = axis_and_speed((*rotation).into(), scale);
        Turn { axis: axis.into(), speed }
    }

    /// The sine of the angle turned by after a time, and 1 less its cosine, both exactly 0 at time 0. The angle is at most
    /// `LARGEST_ANGLE` and errs by 6.5u of itself, 5.5u of the speed and a product; beside that the sine is off by 4u, the other
    /// by a rounding more, 6u.
    pub fn weights(&self, time: f64) -> [f64; 2] {
        let (sine, cosine) = sin_cos(angle(time, self.speed));
        [sine, versine(cosine)]
    }
}

/// A vector over its length, and its length; the scale is its largest component.
#[inline(always)]
pub fn axis_and_speed<S: Scalar>(rotation: [S; 3], scale: S) -> ([S; 3], S) {
    let scaled = rotation.map(|x| x / scale);
    let length = dot(scaled, scaled).sqrt();
    (scaled.map(|x| x / length), length * scale)
}

/// The angle of a turn.
#[inline(always)]
pub fn angle<S: Scalar>(time: S, speed: S) -> S {
    time * speed
}

/// 1 less a cosine.
#[inline(always)]
pub fn versine<S: Scalar>(cosine: S) -> S {
    constant::<S>(1.0) - cosine
}

/// a × b.
#[inline(always)]
pub fn crossed<S: Scalar>(a: [S; 3], b: [S; 3]) -> [S; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

/// An entry of a pose from those of the three matrices that it is a sum of.
#[inline(always)]
pub fn entry<S: Scalar>(start: S, parts: [S; 2], weights: [S; 2]) -> S {
    start + (weights[0] * parts[0] + weights[1] * parts[1])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_time_turns_nothing() {
        let turn = Turn::new(&Vector::new(3.0, -1e-3, 7e5));
        assert_eq!(turn.weights(0.0), [0.0; 2]);
        assert_eq!(Turn::new(&Vector::zeros()).weights(9.0), [0.0; 2]);
        // Whatever the size of the vector.
        let small = Turn::new(&(Vector::new(3.0, -1.0, 0.5) * f64::MIN_POSITIVE));
        assert!((small.axis.norm() - 1.0).abs() < 1e-3 && small.speed > 0.0);
    }
}
