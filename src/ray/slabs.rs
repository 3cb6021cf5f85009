//! A bound from below on where a ray enters a box.

use crate::base::math::{UNIT_ROUNDOFF as U, Vector};

/// No point of a ray before this is in a box; infinite where none is. `ways` are the box's least and greatest coordinates from the
/// ray's origin along each axis, with the errors of these and of the direction taken into account. The quotients are right to 4u.
pub(crate) fn entry_of_box(ways: impl Fn(usize) -> [f64; 2], direction: &Vector, t_max: f64) -> f64 {
    debug_assert!(t_max >= 0.0);
    let (mut entry, mut exit) = (0.0, t_max);
    for k in 0..3 {
        let (ways, along) = (ways(k), direction[k]);
        if along == 0.0 {
            if ways[0] > 0.0 || ways[1] < 0.0 {
                return f64::INFINITY;
            }
            continue;
        }
        let [one, other] = ways.map(|way| way / along);
        let (first, last) = if along > 0.0 { (one, other) } else { (other, one) };
        // Away from each other, whichever their signs; comparisons are false for a NaN.
        let (first, last) = ((first - 8.0 * U * first.abs()).min(f64::MAX), last + 8.0 * U * last.abs());
        if first > entry {
            entry = first;
        }
        if last < exit {
            exit = last;
        }
    }
    if entry > exit { f64::INFINITY } else { entry }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::random::Random;

    /// Points of the ray in a box are not before its entry; a box beside the ray is not entered.
    #[test]
    fn no_point_in_a_box_is_before_the_entry() {
        let mut random = Random::new(0x51ab);
        for _ in 0..if cfg!(miri) { 50 } else { 20_000 } {
            let mut direction = random.direction();
            (0..3).filter(|_| random.below(4) == 0).for_each(|k| direction[k] = 0.0);
            let (way, half) = (random.uniform(0.0, 5.0), random.vector().abs().add_scalar(0.1));
            // From the ray's origin; the point after `way` is inside.
            let middle = direction * way + half.component_mul(&random.vector()) * 0.5;
            let ways = |k: usize| [middle[k] - half[k], middle[k] + half[k]];
            if direction != Vector::zeros() {
                assert!(entry_of_box(ways, &direction, f64::INFINITY) <= way);
                // Moved beside it across the ray by more than it is large.
                let across = direction.cross(&random.direction());
                let beside = across * (4.0 * half.norm() / across.norm());
                let ways = |k: usize| ways(k).map(|x| x + beside[k]);
                assert_eq!(entry_of_box(ways, &direction, f64::INFINITY), f64::INFINITY);
            }
        }
    }
}
