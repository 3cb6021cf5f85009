//! Placed vertices as integers in units of a power of two: R·v + T exactly as the doubles say.

use dashu_int::ops::{Abs, BitTest};
use dashu_int::{IBig, UBig};

/// A point or a vector as integers, in units of a common power of two.
pub type Point = [IBig; 3];

/// Two bodies at their poses.
pub struct IntegerPair<'a> {
    pub a: Body<'a>,
    pub b: Body<'a>,
    /// The unit of every coordinate is 2^exponent.
    pub exponent: i32,
}

/// A body at its pose: the points R·v + T, made integers one by one where they are asked for.
pub struct Body<'a> {
    points: &'a [[f64; 3]],
    /// The row-major 3x4 `[R|T]`.
    pose: &'a [f64],
    exponent: i32,
    /// A bound of |R|·|v|, over all vertices and summed over components.
    reach: f64,
}

/// R·v + T of the vertices of two bodies; `pose` is the row-major 3x4 `[R|T]` of A and then of B.
pub fn place<'a>(a: &'a [[f64; 3]], b: &'a [[f64; 3]], pose: &'a [f64; 24]) -> IntegerPair<'a> {
    let (pose_a, pose_b) = pose.split_at(12);
    let exponent = lowest_exponent(a, pose_a).min(lowest_exponent(b, pose_b));
    let body = |points: &'a [[f64; 3]], pose: &'a [f64]| {
        let rotation: f64 = (0..12).filter(|k| k % 4 != 3).map(|k| pose[k].abs()).sum();
        let largest = points.iter().flatten().map(|x| x.abs()).fold(0.0, f64::max);
        Body { points, pose, exponent, reach: rotation * largest }
    };
    IntegerPair { a: body(a, pose_a), b: body(b, pose_b), exponent }
}

impl Body<'_> {
    /// The number of vertices.
    pub fn count(&self) -> usize {
        self.points.len()
    }

    /// R·v + T of a vertex in units of 2^exponent.
    pub fn vertex(&self, index: usize) -> Point {
        let units = |mantissa: i128, e: i32| IBig::from(mantissa) << (e - self.exponent).max(0) as usize;
        let decoded = self.points[index].map(decode);
        [0, 1, 2].map(|row| {
            let [r @ .., t] = [0, 1, 2, 3].map(|column| decode(self.pose[4 * row + column]));
            let mut sum = units(t.0.into(), t.1);
            for ((r, er), (v, ev)) in r.into_iter().zip(decoded) {
                sum += units(i128::from(r) * i128::from(v), er + ev);
            }
            sum
        })
    }

    /// A vertex that no other lies above in a direction. Doubles tell which come into question, integers which it is.
    pub fn farthest(&self, direction: &Point) -> usize {
        let rough = rounded(direction);
        let local = [0, 1, 2].map(|k| (0..3).map(|row| self.pose[4 * row + k] * rough[row]).sum::<f64>());
        let height = |v: &[f64; 3]| local[0] * v[0] + local[1] * v[1] + local[2] * v[2];
        let heights: Vec<f64> = self.points.iter().map(height).collect();
        let highest = heights.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        // |direction| ≤ 1 in every component, each off by 2u, and a dozen roundings follow, all of them relative to `reach`:
        // a height is off by less than 16u·reach. Where numbers may leave the range of doubles every vertex is looked at.
        let is_usual = self.reach == 0.0 || (1e-200..1e200).contains(&self.reach);
        let lowest = if is_usual { highest - 64.0 * f64::EPSILON * self.reach } else { f64::NEG_INFINITY };
        let candidates = (0..self.count()).filter(|&i| !(heights[i] < lowest));
        let mut best: Option<(IBig, usize)> = None;
        for i in candidates {
            let exact = dot(direction, &self.vertex(i));
            if best.as_ref().is_none_or(|(most, _)| exact > *most) {
                best = Some((exact, i));
            }
        }
        best.expect("a vertex").1
    }
}

/// A vector along another, its largest component between 1/4 and 1 in magnitude, each off by 2u of that.
fn rounded(direction: &Point) -> [f64; 3] {
    let bits = |x: &IBig| UBig::try_from(x.abs()).expect("a magnitude").bit_len();
    let most = direction.iter().map(bits).fold(0, usize::max);
    // 62 bits are left, cut off and then rounded to 53; below the cut is less than 2^-61 of the largest.
    let (shift, scale) = (most.saturating_sub(62), 0.5f64.powi(most.min(62) as i32));
    direction.each_ref().map(|x| (x >> shift).to_f64().value() * scale)
}

pub fn dot(a: &Point, b: &Point) -> IBig {
    &a[0] * &b[0] + &a[1] * &b[1] + &a[2] * &b[2]
}

pub fn negative(v: &Point) -> Point {
    v.each_ref().map(|x| -x)
}

pub fn difference(a: &Point, b: &Point) -> Point {
    [&a[0] - &b[0], &a[1] - &b[1], &a[2] - &b[2]]
}

pub fn cross(a: &Point, b: &Point) -> Point {
    [&a[1] * &b[2] - &a[2] * &b[1], &a[2] * &b[0] - &a[0] * &b[2], &a[0] * &b[1] - &a[1] * &b[0]]
}

pub fn is_zero(v: &Point) -> bool {
    v.iter().all(IBig::is_zero)
}

/// A double as mantissa·2^exponent, the mantissa odd or zero.
fn decode(x: f64) -> (i64, i32) {
    let bits = x.to_bits();
    let fraction = (bits & ((1 << 52) - 1)) as i64;
    let (mantissa, exponent) = match (bits >> 52 & 0x7ff) as i32 {
        0 => (fraction, -1074),
        biased => (fraction | 1 << 52, biased - 1075),
    };
    if mantissa == 0 {
        return (0, 0);
    }
    let zeros = mantissa.trailing_zeros();
    let odd = mantissa >> zeros;
    (if x < 0.0 { -odd } else { odd }, exponent + zeros as i32)
}

/// The exponent of a power of two that divides every coordinate of R·v + T.
fn lowest_exponent(points: &[[f64; 3]], pose: &[f64]) -> i32 {
    let lowest =
        |numbers: &mut dyn Iterator<Item = f64>| numbers.filter(|&x| x != 0.0).map(|x| decode(x).1).min().unwrap_or(0);
    let of_points = lowest(&mut points.iter().flatten().copied());
    let of_rotation = lowest(&mut (0..12).filter(|k| k % 4 != 3).map(|k| pose[k]));
    let of_translation = lowest(&mut [pose[3], pose[7], pose[11]].into_iter());
    (of_points + of_rotation).min(of_translation)
}
