//! Bodies over which balls are swept: spheres, capsules and hulls with round edges, against distances of points and polyhedra in
//! rational numbers, less their radii.

mod curved;
mod half_spaces;
mod magnitudes;
mod pairs;
mod round;
mod scenes;
mod verify;

use swiftprox::math::Vector;
use swiftprox::shape::{InputPolicy, Shape, ShapeOptions};

/// The hull of points, of any dimension, with a ball of a radius swept over it.
fn swept(points: &[Vector], swept_radius: f64) -> Shape {
    let options = ShapeOptions { input: InputPolicy::Hull, swept_radius, ..ShapeOptions::default() };
    Shape::from_points(points, &options).unwrap()
}

fn sphere(radius: f64) -> Shape {
    swept(&[Vector::zeros()], radius)
}

/// Along the first axis.
fn capsule(half: f64, radius: f64) -> Shape {
    swept(&[Vector::new(-half, 0.0, 0.0), Vector::new(half, 0.0, 0.0)], radius)
}
