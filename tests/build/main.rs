//! From points and polygons to a polyhedron.

mod hull;
mod hull_check;
mod hull_work;
mod polyhedron;

use swiftprox::math::Vector;

/// A rotation by no special angle about no special axis.
fn turned(v: &Vector) -> Vector {
    Vector::new(0.36 * v.x + 0.48 * v.y - 0.8 * v.z, -0.8 * v.x + 0.6 * v.y, 0.48 * v.x + 0.64 * v.y + 0.6 * v.z)
}
