//! Vertices of well-known bodies.

use swiftprox::math::Vector;
use testkit::models;

/// A box about the origin.
pub fn cuboid(size: [f64; 3]) -> Vec<Vector> {
    models::cuboid(size.map(|side| 0.5 * side)).unwrap().vertices
}

/// A prism over a regular n-gon: first the bottom, then the top.
pub fn prism(n: usize, height: f64) -> Vec<Vector> {
    let mesh = models::prism(n as u32, 0.5 * height).unwrap();
    mesh.vertices.iter().map(|corner| corner + Vector::z() * (0.5 * height)).collect()
}
