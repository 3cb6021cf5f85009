//! Random numbers and shapes from a seed.

use swiftprox::math::Vector;

/// SplitMix64 (G. L. Steele, D. Lea, C. H. Flood, 2014).
pub struct SplitMix64(pub u64);

impl SplitMix64 {
    pub fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    pub fn below(&mut self, bound: u64) -> u64 {
        self.next() % bound
    }

    /// Uniform in [−1, 1).
    pub fn symmetric(&mut self) -> f64 {
        (self.next() >> 10) as f64 / (1_u64 << 53) as f64 - 1.0
    }

    /// Uniform in a cube.
    pub fn vector(&mut self) -> Vector {
        Vector::from_fn(|_, _| self.symmetric())
    }

    /// Uniform on the unit sphere.
    pub fn direction(&mut self) -> Vector {
        loop {
            let v = self.vector();
            if v.norm_squared() <= 1.0 && v.norm_squared() > 0.01 {
                return v.normalize();
            }
        }
    }

    /// The points turned by one random rotation, in plain double precision.
    pub fn rotate(&mut self, points: &[Vector]) -> Vec<Vector> {
        let z = self.direction();
        let x = z.cross(&self.direction()).normalize();
        let y = z.cross(&x);
        points.iter().map(|p| x * p.x + y * p.y + z * p.z).collect()
    }

    /// Random points on an ellipsoid.
    pub fn ellipsoid(&mut self, count: usize, semi_axes: [f64; 3]) -> Vec<Vector> {
        (0..count).map(|_| self.direction().component_mul(&Vector::from(semi_axes))).collect()
    }
}
