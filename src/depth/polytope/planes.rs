//! The planes of triangles, four at a time: the pass that takes most of a query's time.

use super::storage::{NO_PLANE, Polytope};
use super::{PairRounding, SHORTEST_NORMAL};
use crate::base::math::Vector;
use crate::base::simd::Lanes;

/// The least values over some triangles.
#[derive(Debug, Clone, Copy)]
pub struct Least {
    /// The distance from [`Polytope::distances`].
    pub distance: f64,
    /// How high the centre is below its plane, as computed.
    pub height: f64,
}

/// Computes the planes of triangles `from..to`, which are not none, as seen from the `centre`.
#[inline(always)]
pub fn evaluate<L: Lanes, const V: usize, const T: usize>(
    polytope: &mut Polytope<V, T>,
    rounding: &PairRounding,
    centre: &Vector,
    from: usize,
    to: usize,
) -> Least {
    let [plane_error, determinant_error] = [L::splat(rounding.plane), L::splat(rounding.determinant)];
    let [centre_x, centre_y, centre_z] = [L::splat(centre.x), L::splat(centre.y), L::splat(centre.z)];
    let (shortest, none, one) = (L::splat(SHORTEST_NORMAL), L::splat(NO_PLANE), L::splat(1.0));
    let [mut least_distance, mut least_height] = [L::splat(f64::INFINITY); 2];
    // Four at a time: the last stands in for missing ones.
    let last = polytope.corners[to - 1];
    polytope.corners[to..to + 3].fill(last);
    let mut first = from;
    while first < to {
        let &[a, b, c, d] = &polytope.corners[first..first + 4] else { break };
        let four = [&a, &b, &c, &d];
        let p: [L; 3] = components(&polytope.positions, &four, 0);
        let q: [L; 3] = components(&polytope.positions, &four, 1);
        let r: [L; 3] = components(&polytope.positions, &four, 2);
        let [ex, ey, ez] = [q[0].sub(p[0]), q[1].sub(p[1]), q[2].sub(p[2])];
        let [gx, gy, gz] = [r[0].sub(p[0]), r[1].sub(p[1]), r[2].sub(p[2])];
        let nx = ez.negated_mul_add(gy, ey.mul(gz));
        let ny = ex.negated_mul_add(gz, ez.mul(gx));
        let nz = ey.negated_mul_add(gx, ex.mul(gy));
        let length = nx.mul_add(nx, ny.mul_add(ny, nz.mul(nz))).sqrt();
        let inverse = one.div(length.max(shortest));
        let [ux, uy, uz] = [nx.mul(inverse), ny.mul(inverse), nz.mul(inverse)];
        let above = |v: &[L; 3]| ux.mul_add(v[0], uy.mul_add(v[1], uz.mul(v[2])));
        let [over_p, over_q, over_r] = [above(&p), above(&q), above(&r)];
        let distance = over_p.min(over_q).min(over_r).sub(plane_error);
        let height = over_p.sub(above(&[centre_x, centre_y, centre_z]));
        let distance = distance.where_greater(length, shortest, none);
        let height = height.where_greater(length, shortest, none);
        least_distance = least_distance.min(distance);
        least_height = least_height.min(height);
        // The determinant is length·(over_p + …), see `PairRounding::determinant`; the distance has been lessened by its rounding.
        let edges = ex.mul_add(ex, ey.mul_add(ey, ez.mul(ez))).mul(gx.mul_add(gx, gy.mul_add(gy, gz.mul(gz))));
        let certain = distance.mul(length).greater(determinant_error.mul(edges.sqrt()));
        // Values written beyond the last are overwritten before they are used.
        polytope.normals[0][first..first + 4].copy_from_slice(&ux.to_array());
        polytope.normals[1][first..first + 4].copy_from_slice(&uy.to_array());
        polytope.normals[2][first..first + 4].copy_from_slice(&uz.to_array());
        polytope.distances[first..first + 4].copy_from_slice(&distance.to_array());
        // Bit i moves to byte i.
        let bytes = (certain.wrapping_mul(0x0020_4081) & 0x0101_0101).to_le_bytes();
        polytope.certain[first..first + 4].copy_from_slice(&bytes);
        first += 4;
    }
    Least { distance: least_distance.least().0, height: least_height.least().0 }
}

/// The coordinates of a corner of four triangles. (Mapping an array would call a closure that is compiled without the lanes'
/// instructions.)
#[inline(always)]
fn components<L: Lanes, const V: usize>(
    positions: &[[f64; 4]; V],
    [a, b, c, d]: &[&[u8; 4]; 4],
    corner: usize,
) -> [L; 3] {
    L::components(&[
        L::load(&positions[usize::from(a[corner])]),
        L::load(&positions[usize::from(b[corner])]),
        L::load(&positions[usize::from(c[corner])]),
        L::load(&positions[usize::from(d[corner])]),
    ])
}

/// The triangle of the least distance, and that; of several any.
#[inline(always)]
pub fn nearest<L: Lanes, const V: usize, const T: usize>(polytope: &Polytope<V, T>) -> (usize, f64) {
    let (mut least, mut place) = (L::splat(f64::INFINITY), L::splat(0.0));
    let (mut at, step) = (L::load(&[0.0, 1.0, 2.0, 3.0]), L::splat(4.0));
    let (fours, rest) = polytope.distances[..polytope.triangle_count].as_chunks::<4>();
    for four in fours {
        let distance = L::load(four);
        place = at.where_greater(least, distance, place);
        least = least.min(distance);
        at = at.add(step);
    }
    let (mut value, lane) = least.least();
    let mut nearest = place.to_array()[lane & 3] as usize;
    for (place, distance) in rest.iter().enumerate() {
        if *distance < value {
            (nearest, value) = (4 * fours.len() + place, *distance);
        }
    }
    (nearest, value)
}
