//! How finely coordinates were written down: to so many decimals, to so many significant digits, or as floats.

use std::fmt::{LowerExp, Write};

use crate::base::math::Vector;

/// Doubles that went through text have fewer significant digits; computed doubles nearly always have as many.
const FULL_DIGITS: usize = 15;

/// … and floats.
const FULL_DIGITS_OF_FLOATS: usize = 8;

/// The last place of the coarsest coordinates: the largest distance between two neighbours among the numbers that they could have
/// been. A coordinate that was rounded is off by half of it at most. 0 where all are 0.
///
/// Text of k decimals has its longest numbers in one decade only, since each decade less costs a digit. Longest numbers in two
/// decades are significant digits, of which the largest coordinates have the coarsest place. Both count in shortest form: for
/// floats, the shortest that gives the float back. A few numbers may all end in zeros that are not written: the place is then
/// taken for coarser.
pub fn coordinate_unit(points: &[Vector]) -> f64 {
    let coordinates = || points.iter().flat_map(|point| point.iter().copied()).filter(|x| *x != 0.0);
    let largest = coordinates().fold(0.0, |largest: f64, x| largest.max(x.abs()));
    // The power of two of the binade that holds the largest.
    let power = f64::from_bits(largest.to_bits() >> 52 << 52);
    if coordinates().all(|x| f64::from(x as f32) == x) {
        text_unit(coordinates().map(|x| x as f32), FULL_DIGITS_OF_FLOATS).max(power * f64::from(f32::EPSILON))
    } else {
        text_unit(coordinates(), FULL_DIGITS).max(power * f64::EPSILON)
    }
}

/// The last place of decimal text; 0 where there are as many digits as a computed number has, or no numbers.
fn text_unit(numbers: impl Iterator<Item = impl LowerExp>, full_digits: usize) -> f64 {
    let mut room = String::new();
    let mut top = i32::MIN;
    let mut longest = 0;
    // The decades of those that are as long: the lowest and the highest.
    let mut decades = (0, 0);
    for number in numbers {
        let (digits, decade) = shortest_form(number, &mut room);
        if digits >= full_digits {
            return 0.0;
        }
        top = top.max(decade);
        if digits > longest {
            (longest, decades) = (digits, (decade, decade));
        } else if digits == longest {
            decades = (decades.0.min(decade), decades.1.max(decade));
        }
    }
    if longest == 0 {
        return 0.0;
    }
    let first_place = if decades.0 < decades.1 { top } else { decades.1 };
    10.0_f64.powi(first_place - (longest as i32 - 1))
}

/// How many significant digits a number has that is not 0, and the power of ten of the first one.
fn shortest_form(number: impl LowerExp, room: &mut String) -> (usize, i32) {
    room.clear();
    // Writing to a string does not fail.
    let _ = write!(room, "{number:e}");
    let (mantissa, exponent) = room.split_once('e').unwrap_or((room, "0"));
    (mantissa.bytes().filter(u8::is_ascii_digit).count(), exponent.parse().unwrap_or(0))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn unit_of(coordinates: [f64; 3]) -> f64 {
        coordinate_unit(&[Vector::from(coordinates)])
    }

    fn is_about(unit: f64, expected: f64) -> bool {
        (unit - expected).abs() <= 1e-12 * expected
    }

    #[test]
    fn decimals_are_found_whichever_coordinates_show_them() {
        assert!(is_about(unit_of([0.123, -0.5, 12.253]), 1e-3));
        assert!(is_about(unit_of([10.0, -10.0, 9.876]), 1e-3), "the largest show none");
        assert!(is_about(unit_of([0.00012, 0.5, 3.0]), 1e-5));
        assert!(is_about(unit_of([250.0, 125.0, -1000.0]), 1.0));
    }

    #[test]
    fn significant_digits_are_those_of_the_largest() {
        assert!(is_about(unit_of([123.456, 0.123457, -6.12323e-17]), 1e-3));
    }

    #[test]
    fn floats_have_the_last_place_of_their_type() {
        let floats = [1000.1_f32 + 1.0 / 3.0, 1.0 / 3.0, -0.7].map(f64::from);
        assert_eq!(unit_of(floats), 2.0_f64.powi(9 - 23));
        // Text that was read into floats: 0.123 is not one exactly.
        assert!(is_about(unit_of([0.123_f32, 0.5, 0.25].map(f64::from)), 1e-3));
    }

    #[test]
    fn computed_doubles_and_nothing_leave_no_doubt() {
        assert_eq!(unit_of([1.0 / 3.0, 0.5, 3.0]), 2.0 * f64::EPSILON);
        assert_eq!(unit_of([0.0; 3]), 0.0);
        assert_eq!(coordinate_unit(&[]), 0.0);
    }
}
