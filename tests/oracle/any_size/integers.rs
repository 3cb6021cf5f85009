//! Placed vertices as integers in units of a power of two: R·v + T exactly as the doubles say.

use dashu_int::IBig;

/// A point or a vector as integers, in units of a common power of two.
pub type Point = [IBig; 3];

/// Two bodies at their poses.
pub struct Placed {
    pub a: Vec<Point>,
    pub b: Vec<Point>,
    /// The unit of every coordinate is 2^exponent.
    pub exponent: i32,
}

/// R·v + T of the vertices of two bodies; `pose` is the row-major 3x4 `[R|T]` of A and then of B.
pub fn place(a: &[[f64; 3]], b: &[[f64; 3]], pose: &[f64; 24]) -> Placed {
    let (pose_a, pose_b) = pose.split_at(12);
    let exponent = lowest_exponent(a, pose_a).min(lowest_exponent(b, pose_b));
    Placed { a: place_one(a, pose_a, exponent), b: place_one(b, pose_b, exponent), exponent }
}

pub fn dot(a: &Point, b: &Point) -> IBig {
    &a[0] * &b[0] + &a[1] * &b[1] + &a[2] * &b[2]
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

/// R·v + T in units of 2^exponent.
fn place_one(points: &[[f64; 3]], pose: &[f64], exponent: i32) -> Vec<Point> {
    let units = |mantissa: i128, e: i32| IBig::from(mantissa) << (e - exponent).max(0) as usize;
    let rows = [0, 1, 2].map(|i| [0, 1, 2, 3].map(|j| decode(pose[4 * i + j])));
    let place = |point: &[f64; 3]| {
        let decoded = point.map(decode);
        rows.map(|row| {
            let mut sum = units(row[3].0.into(), row[3].1);
            for ((r, er), (v, ev)) in row.iter().zip(decoded) {
                sum += units(i128::from(*r) * i128::from(v), er + ev);
            }
            sum
        })
    };
    points.iter().map(place).collect()
}
