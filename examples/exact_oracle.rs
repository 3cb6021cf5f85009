//! Decides in exact arithmetic whether two convex hulls intersect, and how far apart they are if not: the judge of the
//! C tests where this library and another one disagree. It uses nothing of the library.
//!
//! Standard input, words separated by white space: the number of points of body A and their coordinates, the same for B,
//! then any number of poses of 24 numbers, the row-major 3x4 `[R|T]` of A and of B. Standard output, a line a pose:
//! `intersecting 0 0` or `separated LOWER UPPER`, the largest double that is not above the distance and the smallest that is
//! not below. The bodies are the hulls of R·v + T, exactly as the doubles say; touching is intersecting.
//!
//! The method is told in `testkit/src/any_size/nearest.rs`.

use std::io::Read;
use std::process::ExitCode;

use dashu_int::{UBig, ops::SquareRoot};
use dashu_ratio::RBig;

use testkit::any_size::integers::place;
use testkit::any_size::nearest::nearest;

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
        let placed = place(&a, &b, pose);
        let square = nearest(&placed).square;
        lines += &if square.is_zero() {
            "intersecting 0 0\n".to_string()
        } else {
            let (lower, upper) = square_root(square, placed.exponent);
            format!("separated {lower:e} {upper:e}\n")
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
