//! Decides in exact arithmetic whether two convex hulls intersect, and how far apart they are if not: the judge of the
//! C tests where this library and another one disagree. It uses nothing of the library.
//!
//! Standard input, words separated by white space: the number of points of body A and their coordinates, the same for B,
//! then any number of poses of 24 numbers, the row-major 3x4 `[R|T]` of A and of B. Standard output, a line a pose:
//! `intersecting 0 0` or `separated LOWER UPPER`, the largest double that is not above the distance and the smallest that is
//! not below. The bodies are the hulls of R·v + T, exactly as the doubles say; touching is intersecting.
//!
//! Method: P. Wolfe, Finding the nearest point in a polytope, Math. Programming 11 (1976), on the difference body, in
//! integers and rationals. In exact arithmetic it ends after finitely many steps, at a point that is proved by a look at
//! every vertex: x is nearest to the origin when x·w ≥ x·x for all vertices w of the difference body.

use std::io::Read;
use std::process::ExitCode;

use dashu_int::{IBig, UBig, ops::SquareRoot};
use dashu_ratio::RBig;

/// A point as integers, in units of a common power of two.
type Point = [IBig; 3];

fn main() -> ExitCode {
    let mut text = String::new();
    if let Err(e) = std::io::stdin().read_to_string(&mut text) {
        eprintln!("exact_oracle: {e}");
        return ExitCode::from(2);
    }
    match answers(&text) {
        Ok(lines) => {
            print!("{lines}");
            ExitCode::SUCCESS
        }
        Err(message) => {
            eprintln!("exact_oracle: {message}");
            ExitCode::from(2)
        }
    }
}

/// One line for every pose in the input.
fn answers(text: &str) -> Result<String, String> {
    let mut words = text.split_ascii_whitespace();
    let a = read_points(&mut words)?;
    let b = read_points(&mut words)?;
    let numbers: Vec<f64> = words.map(read_number).collect::<Result<_, _>>()?;
    let (poses, []) = numbers.as_chunks::<24>() else {
        return Err(format!("{} numbers are not a whole number of poses", numbers.len()));
    };
    let mut lines = String::new();
    for pose in poses {
        let (pose_a, pose_b) = pose.split_at(12);
        let exponent = lowest_exponent(&a, pose_a).min(lowest_exponent(&b, pose_b));
        let world_a = place(&a, pose_a, exponent);
        let world_b = place(&b, pose_b, exponent);
        lines += &match squared_distance(&world_a, &world_b) {
            None => "intersecting 0 0\n".to_string(),
            Some(square) => {
                let (lower, upper) = square_root(square, exponent);
                format!("separated {lower:e} {upper:e}\n")
            }
        };
    }
    Ok(lines)
}

fn read_number(word: &str) -> Result<f64, String> {
    match word.parse::<f64>() {
        Ok(x) if x.is_finite() => Ok(x),
        _ => Err(format!("{word:?} is not a finite number")),
    }
}

fn read_points<'a>(words: &mut impl Iterator<Item = &'a str>) -> Result<Vec<[f64; 3]>, String> {
    let count = words.next().and_then(|word| word.parse::<usize>().ok()).filter(|&n| n > 0);
    let count = count.ok_or("the number of points is missing")?;
    let mut points = Vec::new();
    for i in 0..count {
        let mut point = [0.0; 3];
        for x in &mut point {
            *x = read_number(words.next().ok_or(format!("point {i} is missing"))?)?;
        }
        points.push(point);
    }
    Ok(points)
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
fn place(points: &[[f64; 3]], pose: &[f64], exponent: i32) -> Vec<Point> {
    let units = |mantissa: i128, e: i32| IBig::from(mantissa) << (e - exponent).max(0) as usize;
    let rows = [0, 1, 2].map(|i| [0, 1, 2, 3].map(|j| decode(pose[4 * i + j])));
    let place_one = |point: &[f64; 3]| {
        let decoded = point.map(decode);
        rows.map(|row| {
            let mut sum = units(row[3].0.into(), row[3].1);
            for ((r, er), (v, ev)) in row.iter().zip(decoded) {
                sum += units(i128::from(*r) * i128::from(v), er + ev);
            }
            sum
        })
    };
    points.iter().map(place_one).collect()
}

fn dot(a: &Point, b: &Point) -> IBig {
    &a[0] * &b[0] + &a[1] * &b[1] + &a[2] * &b[2]
}

fn difference(a: &Point, b: &Point) -> Point {
    [&a[0] - &b[0], &a[1] - &b[1], &a[2] - &b[2]]
}

/// The square of the distance between two hulls, or `None` when they have a common point.
fn squared_distance(a: &[Point], b: &[Point]) -> Option<RBig> {
    // Wolfe's corral: affinely independent points, and x, the point nearest to the origin of their affine hull, inside
    // their convex hull.
    let mut corral = vec![difference(&a[0], &b[0])];
    let mut weights = vec![RBig::ONE];
    loop {
        let (x, denominator) = combination(&corral, &weights);
        let square = dot(&x, &x);
        if square.is_zero() {
            return None;
        }
        let lowest = a.iter().min_by_key(|p| dot(&x, p))?;
        let highest = b.iter().max_by_key(|p| dot(&x, p))?;
        let w = difference(lowest, highest);
        if dot(&x, &w) * IBig::from(denominator.clone()) >= square {
            return Some(RBig::from_parts(square, denominator.sqr()));
        }
        corral.push(w);
        weights.push(RBig::ZERO);
        // Minor cycles: move x to the nearest point of the affine hull, or as far as the convex hull goes.
        loop {
            let target = affine_minimiser(&corral);
            let steps = weights.iter().zip(&target).filter(|(_, t)| **t <= RBig::ZERO);
            let Some(step) = steps.map(|(w, t)| w / (w - t)).min() else {
                weights = target;
                break;
            };
            for (w, t) in weights.iter_mut().zip(&target) {
                *w = &*w + &step * (t - &*w);
            }
            let kept: Vec<bool> = weights.iter().map(|w| !w.is_zero()).collect();
            let mut keep = kept.iter();
            corral.retain(|_| keep.next() == Some(&true));
            weights.retain(|w| !w.is_zero());
        }
    }
}

/// Σ weight·point as integers over a common denominator.
fn combination(points: &[Point], weights: &[RBig]) -> (Point, UBig) {
    let denominator = weights.iter().fold(UBig::ONE, |product, w| product * w.denominator());
    let mut sum = [IBig::ZERO, IBig::ZERO, IBig::ZERO];
    for (point, weight) in points.iter().zip(weights) {
        let whole = weight.numerator() * IBig::from(&denominator / weight.denominator());
        for (s, p) in sum.iter_mut().zip(point) {
            *s += &whole * p;
        }
    }
    (sum, denominator)
}

/// The weights, summing to 1, of the point nearest to the origin in the affine hull of affinely independent points: they
/// solve p_i·Σ w_j p_j = m for all i, and Σ w_j = 1.
fn affine_minimiser(points: &[Point]) -> Vec<RBig> {
    let n = points.len() + 1;
    let mut rows: Vec<Vec<RBig>> = vec![vec![RBig::ONE; n + 1]];
    rows[0][n - 1] = RBig::ZERO;
    for p in points {
        let mut row: Vec<RBig> = points.iter().map(|q| RBig::from(dot(p, q))).collect();
        row.extend([RBig::from(-1), RBig::ZERO]);
        rows.push(row);
    }
    for k in 0..n {
        // Affine independence makes the system regular, so that there is a pivot.
        let pivot = (k..n).find(|&i| !rows[i][k].is_zero()).expect("affinely independent points");
        rows.swap(k, pivot);
        let pivot_row = rows[k].clone();
        for (i, row) in rows.iter_mut().enumerate() {
            if i != k && !row[k].is_zero() {
                let factor = &row[k] / &pivot_row[k];
                for (x, p) in row.iter_mut().zip(&pivot_row) {
                    *x = &*x - &factor * p;
                }
            }
        }
    }
    (0..n - 1).map(|k| &rows[k][n] / &rows[k][k]).collect()
}

/// The largest double not above √square·2^exponent and the smallest not below, for results in the normal range.
fn square_root(square: RBig, exponent: i32) -> (f64, f64) {
    // √square·2^shift has at least 64 bits in front of its point.
    let (numerator, denominator) = square.into_parts();
    let numerator = UBig::try_from(numerator).expect("a square is not negative");
    let bits = |n: &UBig| dashu_int::ops::BitTest::bit_len(n) as i32;
    let shift = (128 + bits(&denominator) - bits(&numerator)).max(0) / 2 + 1;
    let scaled = numerator << (2 * shift as usize);
    let quotient = &scaled / &denominator;
    let root = quotient.sqrt();
    let surplus = bits(&root) - f64::MANTISSA_DIGITS as i32;
    let head = &root >> surplus as usize;
    let exact = &head << surplus as usize == root && root.sqr() * denominator == scaled;
    let lower = times_power_of_two(head.to_f64().value(), exponent - shift + surplus);
    (lower, if exact { lower } else { lower.next_up() })
}

/// x·2^exponent, in two steps because 2^exponent alone may overflow or underflow.
fn times_power_of_two(x: f64, exponent: i32) -> f64 {
    let half = exponent / 2;
    x * 2.0_f64.powi(half) * 2.0_f64.powi(exponent - half)
}
