//! A bound of the coordinates' errors in an input, from the coordinates and the polygons themselves.

use crate::base::math::Vector;
use crate::body::mesh::PolygonMesh;

/// The noise of any input, relative to its size: modellers write six digits.
const OF_ANY_INPUT: f64 = 1e-6;

/// Coordinates of so few decimals that half of the last is more of the size than this are round numbers, not rounded ones.
const MOST_OF_DECIMALS: f64 = 1e-5;

/// Polygons that are farther out of a plane than this, relative to the size, are not meant to be flat.
const MOST_OF_POLYGONS: f64 = 1e-3;

/// The most decimals that are distinguished from all digits of a double.
const MOST_DECIMALS: i32 = 9;

/// The rounding error of a number near 1 in single precision, 2⁻²⁴.
const SINGLE_ROUNDOFF: f64 = 0.5 * f32::EPSILON as f64;

/// A bound of a coordinate's error: the largest of the noise of any input, the rounding to single precision or to decimals where
/// all coordinates have passed through that, and how far given polygons are out of their planes.
pub fn default_noise(points: &[Vector], polygons: Option<&PolygonMesh>) -> f64 {
    let [lower, upper] = [f64::min, f64::max].map(|pick: fn(f64, f64) -> f64| {
        points.iter().copied().reduce(|a, b| a.zip_map(&b, pick)).unwrap_or_else(Vector::zeros)
    });
    // Halves first: the difference may leave the range of doubles.
    let size = (upper * 0.5 - lower * 0.5).norm();
    let largest = lower.amax().max(upper.amax());
    let mut noise = OF_ANY_INPUT * size;
    let mut coordinates = points.iter().flat_map(|p| p.iter().copied());
    if coordinates.clone().all(|x| f64::from(x as f32) == x) {
        noise = noise.max(largest * SINGLE_ROUNDOFF);
    }
    let decimals = coordinates.try_fold(0, |known, x| (known..=MOST_DECIMALS).find(|k| has_decimals(x, *k)));
    if let Some(decimals) = decimals {
        let half = 0.5 * 10_f64.powi(-decimals);
        // As the limit is a decimal itself, a size of 1 up to rounding is within it.
        if half <= MOST_OF_DECIMALS * size * 1.01 {
            noise = noise.max(half);
        }
    }
    let out = polygons.map_or(0.0, |mesh| farthest_out_of_plane(points, mesh));
    noise.max(out.min(MOST_OF_POLYGONS * size))
}

/// Whether a number is the one read from a text with so many decimals.
fn has_decimals(x: f64, decimals: i32) -> bool {
    let power = 10_f64.powi(decimals);
    (x * power).round() / power == x
}

/// How far a corner of a polygon lies out of the plane through its polygon's middle, at most.
fn farthest_out_of_plane(points: &[Vector], mesh: &PolygonMesh) -> f64 {
    let mut farthest = 0.0_f64;
    for range in mesh.starts.windows(2).filter(|range| range[1] - range[0] > 3) {
        let corners = &mesh.indices[range[0] as usize..range[1] as usize];
        let first = points[corners[0] as usize];
        let arm = |v: u32| points[v as usize] - first;
        // Newell's normal (Sutherland, Sproull & Schumacker 1974).
        let normal: Vector = corners.windows(2).map(|side| arm(side[0]).cross(&arm(side[1]))).sum();
        let length = normal.norm();
        if length > 0.0 && length.is_finite() {
            let heights = corners.iter().map(|v| normal.dot(&arm(*v)) / length);
            let [low, high] = heights.fold([0.0_f64; 2], |[low, high], h| [low.min(h), high.max(h)]);
            farthest = farthest.max(0.5 * (high - low));
        }
    }
    farthest
}

#[cfg(test)]
mod tests {
    use super::*;

    fn noise_of(corner: f64, other: f64) -> f64 {
        default_noise(&[Vector::repeat(-corner), Vector::new(corner, corner, other)], None)
    }

    #[test]
    fn the_noise_is_told_from_the_digits() {
        let third = 1.0 / 3.0;
        let size = |corner: f64| corner * 3_f64.sqrt();
        let floor = |corner| 1e-6 * size(corner);
        assert!((noise_of(1.0, third) / floor(1.0) - 1.0).abs() < 0.2);
        // Floats far from the origin: their last digit is more than a millionth of the size.
        let far = [100.0_f32, 100.1].map(|x| Vector::repeat(f64::from(x)));
        assert_eq!(default_noise(&far, None), f64::from(100.1_f32) * SINGLE_ROUNDOFF);
        // Five decimals of a body of size 1.
        assert_eq!(noise_of(1.0, 0.333_33), 0.5e-5);
        // One decimal is a round number.
        assert!(noise_of(1.0, 0.3) < 2e-6);
    }

    #[test]
    fn polygons_out_of_plane_say_how_far_up_to_a_limit() {
        for (rise, expected) in [(1e-4, 0.25e-4), (1.0, 1e-3)] {
            let points = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, rise], [0.0, 1.0, 0.0]].map(Vector::from);
            let mesh = PolygonMesh::new(points.to_vec(), vec![0, 1, 2, 3], Some(&[4])).unwrap();
            let noise = default_noise(&points, Some(&mesh));
            assert!((0.5..2.0).contains(&(noise / expected)), "{rise:e}: {noise:e}");
        }
    }
}
