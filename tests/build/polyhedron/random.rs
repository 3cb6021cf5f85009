//! Random shapes.

use swiftprox::math::Vector;

use testkit::random::Random;

/// The points turned by one random rotation, in plain double precision.
pub fn turned(random: &mut Random, points: &[Vector]) -> Vec<Vector> {
    let turn = random.rotation();
    points.iter().map(|p| turn * p).collect()
}

/// Random points on an ellipsoid.
pub fn ellipsoid(random: &mut Random, count: usize, semi_axes: [f64; 3]) -> Vec<Vector> {
    (0..count).map(|_| random.direction().component_mul(&Vector::from(semi_axes))).collect()
}
