//! The point of an intersection of half-spaces that is nearest to the origin: a few half-spaces, added one by one.
//!
//! A half-space that does not hold the nearest point so far has the next one on its plane. It is the nearest point of that plane,
//! or of its common points with one or two others: whichever is in all half-spaces and has the least length.

use crate::base::math::Vector;

/// So many half-spaces have room.
pub(super) const MOST_HALF_SPACES: usize = 16;

/// Planes are taken for parallel where the determinant of their unit normals is less than this.
const LEAST_DETERMINANT: f64 = 1e-7;

/// The points x with `normal`·x ≥ `offset`.
#[derive(Debug, Clone, Copy)]
struct UpperHalfSpace {
    normal: Vector,
    offset: f64,
}

/// Half-spaces and the nearest of their common points.
#[derive(Debug, Clone, Copy)]
pub(super) struct HalfSpaces {
    all: [UpperHalfSpace; MOST_HALF_SPACES],
    count: usize,
    /// A point may be out of a half-space by so much.
    tolerance: f64,
    nearest: Option<Vector>,
}

impl HalfSpaces {
    /// None: all of space.
    pub fn new(tolerance: f64) -> HalfSpaces {
        debug_assert!(tolerance >= 0.0);
        let all = [UpperHalfSpace { normal: Vector::zeros(), offset: 0.0 }; MOST_HALF_SPACES];
        HalfSpaces { all, count: 0, tolerance, nearest: Some(Vector::zeros()) }
    }

    /// The common point nearest to the origin; `None` where none was found, or there was no room.
    pub fn nearest(&self) -> Option<Vector> {
        self.nearest
    }

    /// Adds the points x with `normal`·x ≥ `offset`, of a unit normal.
    pub fn add(&mut self, normal: Vector, offset: f64) {
        if self.count == MOST_HALF_SPACES {
            self.nearest = None;
            return;
        }
        let added = UpperHalfSpace { normal, offset };
        self.all[self.count] = added;
        self.count += 1;
        if let Some(nearest) = self.nearest
            && !self.is_in(&added, &nearest)
        {
            self.nearest = self.nearest_on(&added);
        }
    }

    fn is_in(&self, space: &UpperHalfSpace, x: &Vector) -> bool {
        space.normal.dot(x) >= space.offset - self.tolerance
    }

    /// The nearest common point on the plane of the last half-space.
    fn nearest_on(&self, last: &UpperHalfSpace) -> Option<Vector> {
        let others = &self.all[..self.count - 1];
        let mut best: Option<(f64, Vector)> = None;
        let mut consider = |x: Vector| {
            let length = x.norm();
            let is_less = length.is_finite() && best.is_none_or(|(least, _)| length < least);
            if is_less && others.iter().all(|other| self.is_in(other, &x)) {
                best = Some((length, x));
            }
        };
        let a = last.normal;
        consider(a * last.offset);
        for (k, second) in others.iter().enumerate() {
            let b = second.normal;
            let cosine = a.dot(&b);
            let determinant = 1.0 - cosine * cosine;
            if determinant > LEAST_DETERMINANT {
                let of_a = (last.offset - cosine * second.offset) / determinant;
                let of_b = (second.offset - cosine * last.offset) / determinant;
                consider(a * of_a + b * of_b);
            }
            for third in &others[..k] {
                let c = third.normal;
                let determinant = a.dot(&b.cross(&c));
                if determinant.abs() > LEAST_DETERMINANT {
                    let sum = b.cross(&c) * last.offset + c.cross(&a) * second.offset + a.cross(&b) * third.offset;
                    consider(sum / determinant);
                }
            }
        }
        best.map(|(_, x)| x)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use swiftprox::random::Random;

    #[test]
    fn known_points_are_found() {
        let mut spaces = HalfSpaces::new(1e-12);
        assert_eq!(spaces.nearest(), Some(Vector::zeros()));
        spaces.add(Vector::x(), -1.0);
        assert_eq!(spaces.nearest(), Some(Vector::zeros()));
        spaces.add(Vector::x(), 2.0);
        assert_eq!(spaces.nearest(), Some(Vector::new(2.0, 0.0, 0.0)));
        spaces.add(Vector::new(0.6, 0.8, 0.0), 5.2);
        assert!((spaces.nearest().unwrap() - Vector::new(3.12, 4.16, 0.0)).norm() < 1e-12);
        spaces.add(-Vector::y(), -2.0);
        assert!((spaces.nearest().unwrap() - Vector::new(6.0, 2.0, 0.0)).norm() < 1e-12);
        spaces.add(Vector::z(), 1.0);
        assert!((spaces.nearest().unwrap() - Vector::new(6.0, 2.0, 1.0)).norm() < 1e-12);
        spaces.add(-Vector::x(), 0.0);
        assert_eq!(spaces.nearest(), None);
    }

    /// Against projections from half-space to half-space (Dykstra), which come near the nearest point.
    #[test]
    fn the_nearest_point_is_in_all() {
        let mut random = Random::new(0x4a5);
        for _ in 0..if cfg!(miri) { 3 } else { 300 } {
            let mut spaces = HalfSpaces::new(1e-9);
            let inside = random.vector() * 2.0;
            let count = 1 + random.below(MOST_HALF_SPACES);
            for _ in 0..count {
                let normal = random.direction();
                spaces.add(normal, normal.dot(&inside) - random.uniform(0.0, 0.5));
            }
            let found = spaces.nearest().unwrap();
            assert!(found.norm() <= inside.norm() + 1e-9);
            let (mut x, mut corrections) = (Vector::zeros(), vec![Vector::zeros(); count]);
            for _ in 0..3000 {
                for (space, correction) in spaces.all.iter().zip(&mut corrections) {
                    let y = x + *correction;
                    x = y + space.normal * (space.offset - space.normal.dot(&y)).max(0.0);
                    *correction = y - x;
                }
            }
            assert!((found - x).norm() < 1e-3, "{found} {x}");
            assert!(spaces.all[..count].iter().all(|space| spaces.is_in(space, &found)));
        }
    }
}
