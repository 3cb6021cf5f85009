//! Exact numbers written in decimals, with more digits than doubles have.

use dashu_int::ops::{BitTest, SquareRoot};
use dashu_int::{IBig, UBig};
use dashu_ratio::RBig;

/// Digits of what is written.
const DIGITS: i32 = 37;

/// √square·2^exponent, rounded down and rounded up to [`DIGITS`] digits; the same twice where that is exact.
pub fn root_enclosure(square: &RBig, exponent: i32) -> [String; 2] {
    if square.is_zero() {
        return ["0".to_string(), "0".to_string()];
    }
    let (numerator, denominator) = scaled(square, 2 * exponent);
    let numerator = UBig::try_from(numerator).expect("a square is not negative");
    let places = DIGITS - decimal_exponent(&numerator, &denominator).div_euclid(2);
    let (numerator, denominator) = times_power_of_ten(numerator, denominator, 2 * places);
    let root = (&numerator / &denominator).sqrt();
    let is_exact = root.sqr() * &denominator == numerator;
    let above = if is_exact { root.clone() } else { &root + UBig::ONE };
    [written(false, &root, -places), written(false, &above, -places)]
}

/// x·2^exponent, rounded towards 0.
pub fn rounded(x: &RBig, exponent: i32) -> String {
    if x.is_zero() {
        return "0".to_string();
    }
    let (numerator, denominator) = scaled(x, exponent);
    let is_negative = numerator < IBig::ZERO;
    let numerator = UBig::try_from(if is_negative { -numerator } else { numerator }).expect("not negative");
    let places = DIGITS - decimal_exponent(&numerator, &denominator);
    let (numerator, denominator) = times_power_of_ten(numerator, denominator, places);
    written(is_negative, &(numerator / denominator), -places)
}

/// The unit vector of an integer vector that is not 0.
pub fn direction(v: &[IBig; 3]) -> [String; 3] {
    let square = v.iter().fold(IBig::ZERO, |sum, x| sum + x * x);
    let square = UBig::try_from(square).expect("a square");
    v.each_ref().map(|x| {
        let [root, _] = root_enclosure(&RBig::from_parts(x * x, square.clone()), 0);
        if *x < IBig::ZERO { format!("-{root}") } else { root }
    })
}

/// x·2^exponent as a fraction.
fn scaled(x: &RBig, exponent: i32) -> (IBig, UBig) {
    let (numerator, denominator) = x.clone().into_parts();
    let shift = exponent.unsigned_abs() as usize;
    if exponent >= 0 { (numerator << shift, denominator) } else { (numerator, denominator << shift) }
}

/// log10 of a fraction, to within 1.
fn decimal_exponent(numerator: &UBig, denominator: &UBig) -> i32 {
    let bits = numerator.bit_len() as f64 - denominator.bit_len() as f64;
    (bits * std::f64::consts::LOG10_2).floor() as i32
}

fn times_power_of_ten(numerator: UBig, denominator: UBig, power: i32) -> (UBig, UBig) {
    let ten = UBig::from(10u8).pow(power.unsigned_abs() as usize);
    if power >= 0 { (numerator * ten, denominator) } else { (numerator, denominator * ten) }
}

/// An integer times a power of ten.
fn written(is_negative: bool, integer: &UBig, power: i32) -> String {
    let digits = integer.to_string();
    let (head, tail) = digits.split_at(1);
    let tail = tail.trim_end_matches('0');
    let point = if tail.is_empty() { "" } else { "." };
    let sign = if is_negative { "-" } else { "" };
    format!("{sign}{head}{point}{tail}e{}", power + digits.len() as i32 - 1)
}
