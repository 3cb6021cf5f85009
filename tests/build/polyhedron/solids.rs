//! Vertices of well-known bodies.

use swiftprox::math::Vector;

/// A box about the origin.
pub fn cuboid(size: [f64; 3]) -> Vec<Vector> {
    (0..8).map(|i| Vector::from_fn(|k, _| if i >> k & 1 == 1 { 0.5 * size[k] } else { -0.5 * size[k] })).collect()
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
