//! Casts: families of motions that are hard for them, and a judge that knows nothing of how they are made.

pub mod families;
pub mod judge;

use std::sync::Arc;

use swiftprox::math::{Matrix, Pose, Vector};
use swiftprox::motion::{CastConfig, Motion, Moving, Screw};
use swiftprox::shape::Shape;

use crate::random::rotation;

/// A pair in motion, and how the judge looks at it.
pub struct Case {
    pub shapes: [Arc<Shape>; 2],
    pub motions: [Motion<'static>; 2],
    pub config: CastConfig,
    /// Whether poses at fractions of 2⁻¹⁰ are exact.
    pub is_exact: bool,
}

impl Case {
    pub fn bodies(&self) -> [Moving<'_>; 2] {
        [0, 1].map(|i| Moving { shape: &self.shapes[i], motion: &self.motions[i] })
    }

    /// By other formulas than the library's.
    pub fn poses(&self, time: f64) -> [Pose; 2] {
        [0, 1].map(|i| pose_at(&self.motions[i], time))
    }
}

/// Rodrigues' formula with the machine's sine.
pub fn pose_at(motion: &Motion, time: f64) -> Pose {
    match motion {
        Motion::Fixed(pose) => *pose,
        Motion::Affine { start, end } => {
            let mut pose = *start;
            for (i, row) in pose.rows.iter_mut().enumerate() {
                for (k, entry) in row.iter_mut().enumerate() {
                    *entry += time * (end.rows[i][k] - *entry);
                }
            }
            pose
        }
        Motion::Screw(Screw { start, centre, velocity, rotation: turn }) => {
            let angle = turn.norm();
            let turned = if angle > 0.0 { rotation(&(turn / angle), angle * time) } else { Matrix::identity() };
            let matrix = if angle > 0.0 { turned * start.rotation() } else { start.rotation() };
            let fixed = if angle > 0.0 { start.rotate(centre) - matrix * centre } else { Vector::zeros() };
            Pose::new(&matrix, &(start.translation() + velocity * time + fixed))
        }
        Motion::Callback(callback) => (callback.pose)(time),
    }
}
