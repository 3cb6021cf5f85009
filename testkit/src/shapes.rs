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

/// Points on the surface of a box about the origin, so many along each edge.
pub fn lattice_box(half: [f64; 3], along: usize) -> Vec<Vector> {
    let coordinate = |k: usize, i: usize| half[k] * (2.0 * i as f64 / (along - 1) as f64 - 1.0);
    let all = (0..along * along * along).map(|n| [n % along, n / along % along, n / along / along]);
    let is_outside = |place: &[usize; 3]| place.iter().any(|i| *i == 0 || *i == along - 1);
    all.filter(is_outside).map(|[i, j, k]| Vector::new(coordinate(0, i), coordinate(1, j), coordinate(2, k))).collect()
}

/// A pose that is not turned.
pub fn at(x: f64, y: f64, z: f64) -> Pose {
    Pose::new(&Matrix::identity(), &Vector::new(x, y, z))
}
