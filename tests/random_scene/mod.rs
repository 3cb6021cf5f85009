//! Deterministic random shapes and poses for tests of scenes.

use std::sync::Arc;

use swiftprox::math::{Matrix, Pose, Vector};
use swiftprox::shape::{Shape, ShapeOptions};

/// SplitMix64 (Steele, Lea & Flood 2014).
pub struct Random(pub u64);

impl Random {
    pub fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    pub fn below(&mut self, bound: usize) -> usize {
        (self.next() % bound as u64) as usize
    }

    /// Uniform in −1 … 1.
    pub fn signed(&mut self) -> f64 {
        (self.next() >> 11) as f64 * 2.0_f64.powi(-52) - 1.0
    }

    /// A vector in the cube of half side `size`.
    pub fn vector(&mut self, size: f64) -> Vector {
        Vector::new(self.signed(), self.signed(), self.signed()) * size
    }

    /// A uniformly distributed unit vector.
    pub fn direction(&mut self) -> Vector {
        loop {
            let v = self.vector(1.0);
            if (0.01..1.0).contains(&v.norm_squared()) {
                return v.normalize();
            }
        }
    }

    /// The product of two random half turns: any rotation.
    pub fn rotation(&mut self) -> Matrix {
        let mut half_turn = || {
            let axis = self.direction();
            axis * axis.transpose() * 2.0 - Matrix::identity()
        };
        half_turn() * half_turn()
    }

    /// Any rotation, a translation in the cube of half side `size`.
    pub fn pose(&mut self, size: f64) -> Pose {
        Pose::new(&self.rotation(), &self.vector(size))
    }
}

/// A box with the given half sides about the local origin.
pub fn cuboid(half: [f64; 3]) -> Arc<Shape> {
    let corner = |k: usize| {
        let side = |axis: usize| {
            if k >> axis & 1 == 1 { half[axis] } else { -half[axis] }
        };
        Vector::new(side(0), side(1), side(2))
    };
    let corners: Vec<Vector> = (0..8).map(corner).collect();
    Arc::new(Shape::from_points(&corners, &ShapeOptions::default()).unwrap())
}

/// The hull of random points on an ellipsoid with the given half axes about `centre`.
pub fn ellipsoid(random: &mut Random, points: usize, half: [f64; 3], centre: Vector) -> Arc<Shape> {
    let axes = Vector::from(half);
    let points: Vec<Vector> = (0..points).map(|_| random.direction().component_mul(&axes) + centre).collect();
    Arc::new(Shape::from_points(&points, &ShapeOptions::default()).unwrap())
}
