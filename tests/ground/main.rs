//! Grounds: distances against all triangles in rational numbers; contacts that no inner edge gives a normal of its own.

mod attack;
mod casts;
mod contacts;
mod distances;
mod input;
mod kicks;
mod nearest;
mod rays;
mod soups;

use swiftprox::ground::{Ground, HeightGrid};
use swiftprox::math::Vector;
use testkit::random::Random;

/// Vertices and triangles of hills over a square grid of side 1: no triangle is steeper than `steepest`, the tangent of an angle.
fn hills(random: &mut Random, side: usize, steepest: f64) -> (Vec<Vector>, Vec<[u32; 3]>) {
    // Of a cell's four heights within h the slopes of its triangles along both axes are at most 2h.
    let height = 0.5 * steepest / std::f64::consts::SQRT_2;
    let vertices =
        (0..side * side).map(|at| Vector::new((at % side) as f64, (at / side) as f64, random.uniform(-height, height)));
    let vertices: Vec<Vector> = vertices.collect();
    let mut triangles = Vec::new();
    for at in (0..side - 1).flat_map(|i| (0..side - 1).map(move |j| (i * side + j) as u32)) {
        let side = side as u32;
        triangles.extend([[at, at + 1, at + side + 1], [at, at + side + 1, at + side]]);
    }
    (vertices, triangles)
}

fn level(rows: usize, columns: usize, spacing: f64) -> Ground {
    let heights = vec![0.0; rows * columns];
    Ground::from_heights(&HeightGrid { rows, columns, spacing: [spacing; 2], heights: &heights }).unwrap()
}
