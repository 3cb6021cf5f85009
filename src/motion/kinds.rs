//! How an object moves: where each of its points is at each time.

use std::fmt;

use crate::base::error::{Error, Result, check_range};
use crate::base::math::{Pose, Vector};

/// How an object moves. Every kind defines exactly, in real arithmetic on its doubles, where a point is at a time; answers hold
/// for that, the rounding of poses included.
#[derive(Debug, Clone, Copy)]
pub enum Motion<'a> {
    /// It stays.
    Fixed(Pose),
    /// It turns at a constant rate about a centre that moves on a line.
    Screw(Screw),
    /// Each entry of the pose changes at a constant rate: (1 − t)·start + t·end. In between an object that turns is distorted, so
    /// this is for turns of up to 0.2 radians: beyond, poses are refused.
    Affine {
        /// The pose at time 0.
        start: Pose,
        /// The pose at time 1.
        end: Pose,
    },
    /// The result of the caller's function.
    Callback(Callback<'a>),
}

/// A point p of the object is at T + R·c + t·velocity + exp(t\[rotation\])·R·(p − c) at time t, for the pose \[R|T\] at time 0 and
/// the centre c.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Screw {
    /// The pose at time 0.
    pub start: Pose,
    /// The point it turns about, in its own frame.
    pub centre: Vector,
    /// The velocity of the centre, in the world.
    pub velocity: Vector,
    /// Along the axis in the world, as long as the angular velocity in radians per unit of time. All turned by may be 2²⁰ radians.
    pub rotation: Vector,
}

/// A motion that a function gives. The caller promises two bounds for all points of the object and all times that are asked about;
/// answers are as right as these.
#[derive(Clone, Copy)]
pub struct Callback<'a> {
    /// The pose of the object at a time. The same time gives the same pose.
    pub pose: &'a dyn Fn(f64) -> Pose,
    /// No point's acceleration is larger.
    pub bend: f64,
    /// No point is farther from where the motion that is meant has it.
    pub rounding: f64,
}

impl fmt::Debug for Callback<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Callback").field("bend", &self.bend).field("rounding", &self.rounding).finish_non_exhaustive()
    }
}

impl Motion<'_> {
    /// Refuses a motion with a number out of its range.
    ///
    /// # Errors
    /// [`Error::Pose`], [`Error::Argument`].
    pub(super) fn check(&self) -> Result<()> {
        match self {
            Motion::Fixed(pose) => pose.check(),
            Motion::Screw(Screw { start, centre, velocity, rotation }) => {
                check_finite("centre", centre)?;
                check_finite("velocity", velocity)?;
                check_finite("rotation", rotation)?;
                start.check()
            }
            Motion::Affine { start, end } => {
                start.check()?;
                end.check()?;
                // Between orthonormal ends the middle is the worst.
                check_at(&between(start, end, 0.5), "the affine motion", 0.5)
            }
            Motion::Callback(Callback { bend, rounding, .. }) => {
                check_range("bend", *bend, 0.0..=f64::MAX)?;
                check_range("rounding", *rounding, 0.0..=f64::MAX)
            }
        }
    }
}

/// (1 − t)·start + t·end, entry by entry.
pub(super) fn between(start: &Pose, end: &Pose, time: f64) -> Pose {
    let rest = 1.0 - time;
    Pose { rows: [0, 1, 2].map(|i| [0, 1, 2, 3].map(|k| rest * start.rows[i][k] + time * end.rows[i][k])) }
}

pub(super) fn check_at(pose: &Pose, what: &str, time: f64) -> Result<()> {
    pose.check().map_err(|error| Error::Pose(format!("{what} at time {time:?}: {}", error.message())))
}

pub(super) fn check_finite(name: &str, vector: &Vector) -> Result<()> {
    if vector.iter().all(|x| x.is_finite()) {
        return Ok(());
    }
    let [x, y, z]: [f64; 3] = (*vector).into();
    Err(Error::Argument(format!("the motion's {name} is ({x:?}, {y:?}, {z:?}), it must be finite")))
}
