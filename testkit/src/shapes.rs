//! Shapes and poses that tests write down.

use swiftprox::math::{Matrix, Pose, Vector};
use swiftprox::shape::{InputPolicy, Shape, ShapeOptions};

use crate::models;

/// The hull of points, of any dimension.
pub fn hull(points: &[Vector]) -> Shape {
    let options = ShapeOptions { input: InputPolicy::Hull, ..ShapeOptions::default() };
    Shape::from_points(points, &options).unwrap()
}

/// A box with the given half sides about the local origin.
pub fn cuboid(half: [f64; 3]) -> Shape {
    hull(&models::cuboid(half).unwrap().vertices)
}

/// A pose that is not turned.
pub fn at(x: f64, y: f64, z: f64) -> Pose {
    Pose::new(&Matrix::identity(), &Vector::new(x, y, z))
}
