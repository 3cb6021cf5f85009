//! Vertices of well-known bodies.

use swiftprox::math::Vector;
use testkit::models;

/// A box about the origin.
pub fn cuboid(size: [f64; 3]) -> Vec<Vector> {
    models::cuboid(size.map(|side| 0.5 * side)).unwrap().vertices
}

/// A prism over a regular n-gon: first the bottom, then the top.
pub fn prism(n: usize, height: f64) -> Vec<Vector> {
    let ring = |z: f64| {
        (0..n).map(move |i| {
            let (sine, cosine) = (std::f64::consts::TAU * i as f64 / n as f64).sin_cos();
            Vector::new(cosine, sine, z)
        })
    };
    ring(0.0).chain(ring(height)).collect()
}
