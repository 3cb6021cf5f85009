//! Deterministic random shapes and poses for tests of scenes.

use std::sync::Arc;

pub use crate::random::Random;
use crate::shapes;
use swiftprox::math::{Pose, Vector};
use swiftprox::shape::{Shape, ShapeOptions};

/// Any rotation, a translation in the cube of half side `size`.
pub fn random_pose(random: &mut Random, size: f64) -> Pose {
    Pose::new(&random.rotation(), &(random.vector() * size))
}

/// A box with the given half sides about the local origin.
pub fn cuboid(half: [f64; 3]) -> Arc<Shape> {
    Arc::new(shapes::cuboid(half))
}

/// The hull of random points on an ellipsoid with the given half axes about `centre`.
pub fn ellipsoid(random: &mut Random, points: usize, half: [f64; 3], centre: Vector) -> Arc<Shape> {
    let axes = Vector::from(half);
    let points: Vec<Vector> = (0..points).map(|_| random.direction().component_mul(&axes) + centre).collect();
    Arc::new(Shape::from_points(&points, &ShapeOptions::default()).unwrap())
}
