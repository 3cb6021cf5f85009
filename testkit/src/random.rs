//! SplitMix64 (Steele, Lea & Flood 2014, "Fast splittable pseudorandom number generators") and what is drawn from it.

use swiftprox::math::{Matrix, Vector};

/// A generator; equal seeds give equal sequences everywhere, up to the rounding of the machine's `ln`, `cos` and `sin`.
pub struct Random(u64);

impl Random {
    pub fn new(seed: u64) -> Random {
        Random(seed)
    }

    pub fn next_u64(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    /// Uniform in [low, high).
    pub fn uniform(&mut self, low: f64, high: f64) -> f64 {
        let unit = (self.next_u64() >> 11) as f64 * (1.0 / (1u64 << 53) as f64);
        low + (high - low) * unit
    }

    /// Uniform in [-1, 1).
    pub fn signed(&mut self) -> f64 {
        self.uniform(-1.0, 1.0)
    }

    /// Uniform in 0..n.
    pub fn below(&mut self, n: usize) -> usize {
        (self.next_u64() % n as u64) as usize
    }

    /// One of the items.
    pub fn pick<T: Copy>(&mut self, items: &[T]) -> T {
        items[self.below(items.len())]
    }

    /// Every component uniform in [-1, 1).
    pub fn vector(&mut self) -> Vector {
        Vector::new(self.signed(), self.signed(), self.signed())
    }

    /// An integer vector with components in -n..=n.
    pub fn lattice(&mut self, n: usize) -> Vector {
        let mut component = || self.below(2 * n + 1) as f64 - n as f64;
        Vector::new(component(), component(), component())
    }

    /// A power of two between 2^from and 2^to.
    pub fn power(&mut self, from: i32, to: i32) -> f64 {
        2f64.powi(from + self.below((to - from + 1) as usize) as i32)
    }

    /// One of the 24 rotations of the cube: exact in doubles.
    pub fn quarter_turns(&mut self) -> Matrix {
        let x = Matrix::new(1.0, 0.0, 0.0, 0.0, 0.0, -1.0, 0.0, 1.0, 0.0);
        let y = Matrix::new(0.0, 0.0, 1.0, 0.0, 1.0, 0.0, -1.0, 0.0, 0.0);
        let mut turn = Matrix::identity();
        for _ in 0..self.below(6) {
            turn *= if self.below(2) == 0 { x } else { y };
        }
        turn
    }

    /// Standard normal (Box & Muller 1958).
    pub fn normal(&mut self) -> f64 {
        let radius = (-2.0 * (1.0 - self.uniform(0.0, 1.0)).ln()).sqrt();
        radius * self.uniform(0.0, std::f64::consts::TAU).cos()
    }

    /// Uniform on the unit sphere.
    pub fn direction(&mut self) -> Vector {
        loop {
            let v = Vector::new(self.normal(), self.normal(), self.normal());
            if v.norm() > 1e-3 {
                return v.normalize();
            }
        }
    }

    /// A turn by an angle uniform in [0, 2π) about an axis uniform on the sphere.
    pub fn rotation(&mut self) -> Matrix {
        let axis = self.direction();
        rotation(&axis, self.uniform(0.0, std::f64::consts::TAU))
    }
}

/// The matrix that turns by `angle` radians about a unit axis (Rodrigues' formula).
pub fn rotation(axis: &Vector, angle: f64) -> Matrix {
    let k = axis.cross_matrix();
    Matrix::identity() + k * angle.sin() + k * k * (1.0 - angle.cos())
}
