//! Exact signs for plain points, for the hull and its checks.
//!
//! Four tiers decide each sign, the next only when the one before cannot:
//! 1. floating point with an error bound, argued at [`ExactPoints::plane`];
//! 2. double-double arithmetic with an error bound, argued at `double_double_height`: several
//!    times cheaper than tier 3 for points that are coplanar up to rounding, as those of a rotated
//!    box or prism are;
//! 3. adaptive expansions (crate `robust`; J. R. Shewchuk, "Adaptive Precision Floating-Point
//!    Arithmetic and Fast Robust Geometric Predicates", Discrete & Computational Geometry 18,
//!    1997), exact as long as nothing under- or overflows;
//! 4. instead of 2 and 3 for points whose exponents spread too far for them: tier 1 once more with
//!    exponents that do not end, then integers (crate `dashu-int`).
//!
//! Every sign here is invariant under a common power-of-two scaling of all points. So the points
//! are scaled until the largest coordinate lies in [1/2, 1), and nothing can overflow. If then no
//! non-zero coordinate is below 2⁻³⁰⁰, all coordinates are multiples of 2⁻³⁵³, every product of
//! three differences and every error term of an expansion is a multiple of 2⁻¹⁰⁵⁹, which doubles
//! hold: tiers 2 and 3 are what they claim. Otherwise tier 4 takes their place for every sign that
//! a point with such a coordinate has part in.

use dashu_int::IBig;
use dashu_int::ops::BitTest;
use robust::{Coord, Coord3D, orient2d, orient3d};

use crate::base::double_double::{two_sum, wide_cross, wide_dot};
use crate::base::error::Result;
use crate::base::extended_range::Extended;
use crate::base::math::{UNIT_ROUNDOFF, Vector, are_finite, power_of_two};
use crate::base::memory::{collected, copied, push, with_capacity};
use crate::base::progress::Progress;
use crate::base::scalar::{Ring, Scalar, constant, dot};

/// Below this (after scaling) a non-zero coordinate may make an expansion underflow; see the head
/// of this file. 2⁻³⁰⁰.
const SMALLEST_FOR_EXPANSIONS: f64 = f64::from_bits((1023 - 300) << 52);

/// Covers every underflow of tier 1, including that of the scaling itself: a plane's height takes
/// part in fewer than 100 roundings, each wrong by at most 2⁻¹⁰⁷⁴ absolutely when it underflows,
/// and multiplied by less than 2⁵ afterwards. 2⁻¹⁰⁰⁰.
const UNDERFLOW_GUARD: f64 = f64::from_bits((1023 - 1000) << 52);

/// The bound at [`ExactPoints::plane`], rounded up for the rounding of the bound itself.
pub const FILTER: f64 = 10.0 * UNIT_ROUNDOFF;

/// The bound at [`double_double_height`], rounded up for the rounding of the spread.
pub const DOUBLE_DOUBLE_FILTER: f64 = 26.0 * UNIT_ROUNDOFF * UNIT_ROUNDOFF;

/// A point set prepared for exact predicates. Points are named by their index.
#[derive(Debug, Clone)]
pub struct ExactPoints {
    /// The points times a power of two; largest coordinate in [1/2, 1) (or all are zero). Exact,
    /// unless `original` is there: then the smallest coordinates may have underflowed.
    scaled: Vec<[f64; 3]>,
    /// The points times another power of two, exactly; for sets that expansions cannot decide.
    original: Option<Vec<[f64; 3]>>,
    /// Points beyond those of `original`, each the average of four of them.
    averages: Vec<[u32; 4]>,
    /// Size of the scaled points' bounding box along each axis, rounded up.
    extent: [f64; 3],
    /// The points were multiplied by 2 to this power.
    scale: i32,
    /// Absolute part of the error bounds of tier 1: [`UNDERFLOW_GUARD`], or infinite when `scaled`
    /// is not to be trusted.
    guard: f64,
}

/// An oriented plane through three points, with a floating-point filter for the side on which
/// another point lies.
#[derive(Debug, Clone, Copy)]
pub struct FilteredPlane {
    corners: [u32; 3],
    /// (b − a) × (c − a), rounded.
    normal: [f64; 3],
    /// A computed height beyond ± this has the right sign.
    error: f64,
}

impl ExactPoints {
    /// Prepares finite points; fewer than 2³² of them.
    ///
    /// # Errors
    /// [`crate::base::error::Error::Memory`].
    pub fn new(points: &[Vector]) -> Result<ExactPoints> {
        ExactPoints::new_in_steps(points, &mut Progress::new(&mut |_| true))
    }

    /// Same as [`ExactPoints::new`], with progress reports.
    ///
    /// # Errors
    /// [`crate::base::error::Error::Cancelled`] when the caller does not want to go on.
    pub fn new_in_steps(points: &[Vector], progress: &mut Progress) -> Result<ExactPoints> {
        debug_assert!(u32::try_from(points.len()).is_ok() && points.iter().all(are_finite));
        let largest = points.iter().flat_map(|p| p.iter()).fold(0.0_f64, |m, x| m.max(x.abs()));
        let scale = -exponent_above(largest);
        let mut scaled: Vec<[f64; 3]> = with_capacity(points.len())?;
        let (mut low, mut high) = ([f64::INFINITY; 3], [f64::NEG_INFINITY; 3]);
        let mut expansions_are_exact = true;
        for (done, p) in points.iter().enumerate() {
            progress.step(done, points.len())?;
            let s = [0, 1, 2].map(|k| times_power_of_two(p[k], scale));
            for k in 0..3 {
                (low[k], high[k]) = (low[k].min(s[k]), high[k].max(s[k]));
                expansions_are_exact &= p[k] == 0.0 || s[k].abs() >= SMALLEST_FOR_EXPANSIONS;
            }
            scaled.push(s);
        }
        let original = match expansions_are_exact {
            true => None,
            false => Some(collected(points.iter().map(|p| (*p).into()))?),
        };
        let extent = [0, 1, 2].map(|k| (high[k] - low[k]).max(0.0).next_up());
        Ok(ExactPoints { scaled, original, averages: Vec::new(), extent, scale, guard: UNDERFLOW_GUARD })
    }

    /// Appends the exact average of four of the points it was made of (a point may be named more than once). It need not be a
    /// point of doubles, so all signs that it has part in come from integers: slow.
    ///
    /// # Errors
    /// [`crate::base::error::Error::Memory`].
    pub fn push_average(&mut self, corners: [u32; 4]) -> Result<()> {
        debug_assert!(corners.iter().all(|i| (*i as usize) < self.scaled.len() - self.averages.len()));
        if self.original.is_none() {
            self.original = Some(copied(&self.scaled)?);
        }
        push(&mut self.averages, corners)?;
        let rounded = |k: usize| corners.iter().map(|&i| 0.25 * self.scaled[i as usize][k]).sum();
        let rounded = [0, 1, 2].map(rounded);
        push(&mut self.scaled, rounded)?;
        // The rounded copy is good for nothing but steering.
        self.guard = f64::INFINITY;
        Ok(())
    }

    /// The number of points.
    pub fn len(&self) -> usize {
        self.scaled.len()
    }

    /// Whether there are no points.
    pub fn is_empty(&self) -> bool {
        self.scaled.is_empty()
    }

    /// The scaled coordinates of point `p`: good for steering, not for deciding.
    pub fn approximate(&self, p: u32) -> Vector {
        Vector::from(self.scaled[p as usize])
    }

    /// A length in the units of [`ExactPoints::approximate`].
    pub fn to_scaled(&self, length: f64) -> f64 {
        times_power_of_two(length, self.scale)
    }

    /// A length in the units of the points as they were given.
    pub fn from_scaled(&self, length: f64) -> f64 {
        times_power_of_two(length, -self.scale)
    }

    /// The sign of det(b − a, c − a, d − a): positive when the triangle a, b, c is seen
    /// counter-clockwise from d, so when d lies strictly outside the face (a, b, c) of a hull; 0
    /// when the four are coplanar. Its magnitude is about that of the determinant of the scaled
    /// points; where tier 4 decides, it is below 2⁻¹⁰⁰⁰ and grows with the determinant.
    pub fn orientation(&self, corners: [u32; 3], d: u32) -> f64 {
        let [a, b, c] = corners.map(|i| &self.scaled[i as usize]);
        let (normal, permanent) = normal_and_permanent([a, b, c]);
        let p = &self.scaled[d as usize];
        let (height, spread) = height_and_spread(normal, permanent, *a, *p);
        if height.abs() > FILTER * spread + self.guard {
            return height;
        }
        let named = [corners[0], corners[1], corners[2], d];
        if let Some(original) = self.original_where_needed(&named) {
            return self.wide_range_orientation(original, named);
        }
        // Cheap and common. With no spread all products vanish, exactly: d lies in a plane normal
        // to an axis, say.
        if spread == 0.0 || [a, b, c].contains(&p) {
            return 0.0;
        }
        let height = double_double_height([a, b, c], p);
        if height.abs() > DOUBLE_DOUBLE_FILTER * spread {
            return height;
        }
        // `robust` is positive for d below a counter-clockwise triangle; two corners swapped make
        // it positive above.
        let [a, b, c, d] = [a, b, c, p].map(|&[x, y, z]| Coord3D { x, y, z });
        orient3d(a, c, b, d)
    }

    /// The sign of the orientation of a, b, c after dropping coordinate `axis`, the remaining two
    /// in cyclic order (axis 2: x, y; axis 0: y, z; axis 1: z, x): positive when counter-clockwise.
    /// It is the sign of component `axis` of (b − a) × (c − a).
    pub fn projected_orientation(&self, axis: usize, [a, b, c]: [u32; 3]) -> f64 {
        debug_assert!(axis < 3);
        let (first, second) = ((axis + 1) % 3, (axis + 2) % 3);
        if let Some(original) = self.original_where_needed(&[a, b, c]) {
            let [x, y] = [first, second].map(|axis| self.integers(original, [a, b, c], axis));
            let left = (&x.values[1] - &x.values[0]) * (&y.values[2] - &y.values[0]);
            let right = (&y.values[1] - &y.values[0]) * (&x.values[2] - &x.values[0]);
            return leading(&(left - right), x.exponent + y.exponent).rank();
        }
        let coord = |i: u32| Coord { x: self.scaled[i as usize][first], y: self.scaled[i as usize][second] };
        orient2d(coord(a), coord(b), coord(c))
    }

    /// Whether three points lie exactly on one line (or coincide).
    pub fn collinear(&self, corners: [u32; 3]) -> bool {
        (0..3).all(|axis| self.projected_orientation(axis, corners) == 0.0)
    }

    /// The plane through three points, for many calls of [`ExactPoints::height`].
    pub fn plane(&self, corners: [u32; 3]) -> FilteredPlane {
        let (normal, permanent) = normal_and_permanent(corners.map(|i| &self.scaled[i as usize]));
        // height = Σ nₖ·dₖ with dₖ = pₖ − aₖ. Components of e = b − a and f = c − a have relative
        // error u; a component of n, a difference of two products, is off by at most 4u·N, where N,
        // the "permanent", is the same with a plus sign, N = |e_y·f_z| + |e_z·f_y|. dₖ has relative
        // error u, the product and the two sums 3u more: altogether at most (8u + O(u²))·Σ Nₖ·|dₖ|,
        // and |dₖ| is at most the size of the bounding box.
        let spread: f64 = (0..3).map(|k| permanent[k] * self.extent[k]).sum();
        FilteredPlane { corners, normal, error: FILTER * spread + self.guard }
    }

    /// How far point `p` lies above the plane, in units of the length of its unscaled normal. The sign is exact, the magnitude
    /// what [`ExactPoints::orientation`] says: among several points, the one with the largest is about the farthest, however
    /// small.
    pub fn height(&self, plane: &FilteredPlane, p: u32) -> f64 {
        let a = &self.scaled[plane.corners[0] as usize];
        let point = &self.scaled[p as usize];
        let n = &plane.normal;
        let (height, _) = height_and_spread(*n, *n, *a, *point);
        if height.abs() > plane.error { height } else { self.small_height(plane, p) }
    }

    /// An upper bound of the distance of point `p` from the plane, in the units of [`ExactPoints::approximate`]; +∞ for a
    /// triangle so thin that double precision does not see its plane.
    pub fn distance_bound(&self, plane: &FilteredPlane, p: u32) -> f64 {
        if plane.corners.contains(&p) {
            return 0.0;
        }
        // Both are off by the bound at `plane`; the factor covers the remaining rounding.
        let (normal, permanent) = normal_and_permanent(plane.corners.map(|i| &self.scaled[i as usize]));
        let length = Vector::from(normal).norm() - 8.0 * UNIT_ROUNDOFF * permanent.iter().sum::<f64>();
        // A rank may decide where the filter does not.
        let height = self.height(plane, p).abs().max(plane.error);
        let bound = (height + plane.error) / length * (1.0 + 16.0 * UNIT_ROUNDOFF);
        if length > 0.0 { bound } else { f64::INFINITY }
    }

    /// The height where the filter cannot decide its sign.
    #[cold]
    fn small_height(&self, plane: &FilteredPlane, p: u32) -> f64 {
        self.orientation(plane.corners, p)
    }

    /// The points as they were given, if expansions cannot decide these, all named: one is an average, or a coordinate is too
    /// small.
    fn original_where_needed(&self, named: &[u32]) -> Option<&[[f64; 3]]> {
        let original = self.original.as_deref()?;
        let is_in_reach = |i: &u32| {
            let scaled = &self.scaled[*i as usize];
            let is_exact = |p: &[f64; 3]| (0..3).all(|k| p[k] == 0.0 || scaled[k].abs() >= SMALLEST_FOR_EXPANSIONS);
            original.get(*i as usize).is_some_and(is_exact)
        };
        (!named.iter().all(is_in_reach)).then_some(original)
    }

    /// Tier 4.
    #[cold]
    fn wide_range_orientation(&self, original: &[[f64; 3]], named: [u32; 4]) -> f64 {
        if let [Some(a), Some(b), Some(c), Some(p)] = named.map(|i| original.get(i as usize)) {
            if [a, b, c].contains(&p) {
                return 0.0;
            }
            // The bound is that at `plane`: no operation here under- or overflows.
            let (height, spread) = extended_height([a, b, c], p);
            let beyond = height.abs() - Extended::from(FILTER) * spread;
            if beyond.mantissa > 0.0 || spread.mantissa == 0.0 {
                return height.rank();
            }
        }
        // The determinant keeps its sign when an axis is scaled, so each has units of its own: the numbers are as short as can be.
        let axes = [0, 1, 2].map(|axis| self.integers(original, named, axis));
        let difference = |point: usize| axes.each_ref().map(|axis| &axis.values[point] - &axis.values[0]);
        let (e, f, g) = (difference(1), difference(2), difference(3));
        let minor = |i: usize, j: usize| &e[i] * &f[j] - &e[j] * &f[i];
        let determinant = minor(1, 2) * &g[0] + minor(2, 0) * &g[1] + minor(0, 1) * &g[2];
        leading(&determinant, axes.iter().map(|axis| axis.exponent).sum()).rank()
    }

    /// One coordinate of some points, as integers.
    fn integers<const N: usize>(&self, original: &[[f64; 3]], named: [u32; N], axis: usize) -> Integers<N> {
        // If there are averages, every point is the sum of four, in units of a quarter.
        let count = if self.averages.is_empty() { 1 } else { 4 };
        let terms = named.map(|i| {
            let corners = (i as usize).checked_sub(original.len()).map_or([i; 4], |average| self.averages[average]);
            corners.map(|corner| mantissa_and_exponent(original[corner as usize][axis]))
        });
        let nonzero = terms.iter().flatten().filter(|(mantissa, _)| *mantissa != 0);
        let lowest = nonzero.map(|(_, exponent)| *exponent).min().unwrap_or(0);
        let integer = |&(mantissa, exponent): &(i64, i32)| match mantissa {
            0 => IBig::ZERO,
            _ => IBig::from(mantissa) << ((exponent - lowest) as usize),
        };
        Integers {
            values: terms.map(|terms| terms[..count].iter().map(integer).sum()),
            exponent: lowest - count.ilog2() as i32,
        }
    }
}

/// Numbers values·2^exponent.
struct Integers<const N: usize> {
    values: [IBig; N],
    exponent: i32,
}

/// The leading bits of value·2^exponent.
fn leading(value: &IBig, exponent: i32) -> Extended {
    let excess = value.bit_len().saturating_sub(62);
    let bits = i64::try_from(value.clone() >> excess).unwrap_or(0);
    Extended { mantissa: bits as f64, exponent: exponent + excess as i32 }
}

/// n = (b − a) × (c − a), rounded, and the same with all minus signs of the cross product made
/// plus.
#[inline(always)]
pub fn normal_and_permanent<S: Scalar>([a, b, c]: [&[S; 3]; 3]) -> ([S; 3], [S; 3]) {
    let e = [b[0] - a[0], b[1] - a[1], b[2] - a[2]];
    let f = [c[0] - a[0], c[1] - a[1], c[2] - a[2]];
    let mut normal = [constant(0.0); 3];
    let mut permanent = [constant(0.0); 3];
    for k in 0..3 {
        let (i, j) = ((k + 1) % 3, (k + 2) % 3);
        let (left, right) = (e[i] * f[j], e[j] * f[i]);
        normal[k] = left - right;
        permanent[k] = left.abs() + right.abs();
    }
    (normal, permanent)
}

/// n·(p − a), and the same of magnitudes with the permanent.
#[inline(always)]
pub fn height_and_spread<S: Scalar>(normal: [S; 3], permanent: [S; 3], a: [S; 3], p: [S; 3]) -> (S, S) {
    let d = [p[0] - a[0], p[1] - a[1], p[2] - a[2]];
    (dot(normal, d), dot(permanent, [d[0].abs(), d[1].abs(), d[2].abs()]))
}

/// det(b − a, c − a, p − a), off by at most 25u²·spread (and the rounding of two words to one,
/// which keeps the sign), with the spread of [`ExactPoints::orientation`]. The differences are
/// exact; a component of the normal is off by 11u² of its permanent (8 the products, 3 the
/// difference), its product with the third difference by 8u² more, the two sums by 6u².
fn double_double_height([a, b, c]: [&[f64; 3]; 3], p: &[f64; 3]) -> f64 {
    let from_a = |q: &[f64; 3]| [0, 1, 2].map(|k| two_sum(q[k], -a[k]));
    wide_height(from_a(b), from_a(c), from_a(p)).hi
}

/// (e × f)·g.
#[inline]
pub fn wide_height<D: Ring>(e: [D; 3], f: [D; 3], g: [D; 3]) -> D {
    wide_dot(&wide_cross(&e, &f), &g)
}

/// det(b − a, c − a, p − a) and the spread of [`ExactPoints::orientation`].
fn extended_height([a, b, c]: [&[f64; 3]; 3], p: &[f64; 3]) -> (Extended, Extended) {
    let from_a = |q: &[f64; 3]| [0, 1, 2].map(|k| Extended::difference(q[k], a[k]));
    let (e, f, g) = (from_a(b), from_a(c), from_a(p));
    let term = |k: usize| {
        let (i, j) = ((k + 1) % 3, (k + 2) % 3);
        let (left, right) = (e[i] * f[j], e[j] * f[i]);
        ((left - right) * g[k], (left.abs() + right.abs()) * g[k].abs())
    };
    let [x, y, z] = [0, 1, 2].map(term);
    (x.0 + y.0 + z.0, x.1 + y.1 + z.1)
}

/// x = mantissa·2^exponent, exactly. By its bits alone: a comparison takes a subnormal number for 0 where these are flushed.
pub fn mantissa_and_exponent(x: f64) -> (i64, i32) {
    let bits = x.to_bits();
    let biased = ((bits >> 52) & 0x7ff) as i32;
    let fraction = (bits & ((1 << 52) - 1)) as i64;
    let (magnitude, exponent) = if biased == 0 { (fraction, -1074) } else { (fraction | (1 << 52), biased - 1075) };
    (if bits >> 63 == 1 { -magnitude } else { magnitude }, exponent)
}

/// The e with 2^(e−1) ≤ x < 2^e, for x ≥ 0; 0 for x = 0.
fn exponent_above(x: f64) -> i32 {
    debug_assert!(x >= 0.0);
    let (mantissa, exponent) = mantissa_and_exponent(x);
    if mantissa == 0 { 0 } else { exponent + 64 - mantissa.leading_zeros() as i32 }
}

/// x·2^exponent, for |exponent| ≤ 2000; rounded only where the result is subnormal.
fn times_power_of_two(x: f64, exponent: i32) -> f64 {
    debug_assert!(exponent.abs() <= 2000);
    // Two factors, because 2^exponent alone may be out of range.
    let half = exponent / 2;
    x * power_of_two(half) * power_of_two(exponent - half)
}

#[cfg(test)]
mod tests {
    use super::*;
    use dashu_ratio::RBig;
    use swiftprox::random::Random;

    /// Fewer under Miri, which is slow.
    fn rounds(count: usize) -> usize {
        if cfg!(miri) { count / 200 } else { count }
    }

    fn exact_determinant(points: &[Vector; 4]) -> RBig {
        let [a, b, c, d] = points.map(|p| [p.x, p.y, p.z].map(|x| RBig::try_from(x).unwrap()));
        let from_a = |p: &[RBig; 3]| [0, 1, 2].map(|k| &p[k] - &a[k]);
        let (e, f, g) = (from_a(&b), from_a(&c), from_a(&d));
        (0..3).fold(RBig::ZERO, |sum, k| {
            let (i, j) = ((k + 1) % 3, (k + 2) % 3);
            sum + (&e[i] * &f[j] - &e[j] * &f[i]) * &g[k]
        })
    }

    fn sign(x: &RBig) -> f64 {
        if *x == RBig::ZERO {
            0.0
        } else if *x > RBig::ZERO {
            1.0
        } else {
            -1.0
        }
    }

    fn sign_of(x: f64) -> f64 {
        if x == 0.0 { 0.0 } else { x.signum() }
    }

    /// Four points, the last in the plane of the others up to a few roundings, or a little more, or
    /// equal to one of them.
    fn nearly_coplanar(random: &mut Random) -> [Vector; 4] {
        let [a, b, c] = [random.vector(), random.vector(), random.vector()];
        let (s, t) = (random.signed(), random.signed());
        let mut d = a + (b - a) * s + (c - a) * t;
        match random.next_u64() % 4 {
            0 => d = b,
            1 => d.x = d.x.next_up(),
            2 => d.z += 1e-12,
            _ => {}
        }
        [a, b, c, d]
    }

    #[test]
    fn positive_means_seen_counter_clockwise() {
        let points = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.3, 0.3, 1.0], [5.0, 5.0, 0.0]];
        let exact = ExactPoints::new(&points.map(Vector::from)).unwrap();
        assert!(exact.orientation([0, 1, 2], 3) > 0.0);
        assert!(exact.orientation([0, 2, 1], 3) < 0.0);
        assert_eq!(exact.orientation([0, 1, 2], 4), 0.0);
        assert!(exact.height(&exact.plane([0, 1, 2]), 3) > 0.0);
        assert!(exact.projected_orientation(2, [0, 1, 2]) > 0.0);
        assert_eq!(exact.projected_orientation(0, [0, 1, 2]), 0.0);
    }

    #[test]
    fn orientation_and_height_have_the_exact_sign() {
        let mut random = Random::new(11);
        // The last two are out of reach of expansions.
        let frames = [
            [1.0, 1.0, 1.0],
            [1.0, 1.0, 1e-9],
            [1e-12, 1.0, 1e-3],
            [1e-99, 1.0, 1.0],
            [1.0, 1e-130, 1e200],
            [1e-310, 1.0, 1.0],
        ];
        for round in 0..rounds(20_000) {
            let frame = Vector::from(frames[round % frames.len()]);
            let points = nearly_coplanar(&mut random).map(|p| p.component_mul(&frame));
            let truth = sign(&exact_determinant(&points));
            let exact = ExactPoints::new(&points).unwrap();
            assert_eq!(sign_of(exact.orientation([0, 1, 2], 3)), truth, "{points:?}");
            assert_eq!(sign_of(exact.height(&exact.plane([0, 1, 2]), 3)), truth, "{points:?}");
        }
    }

    /// Coordinates of any exponents in one set: the sign is exact, and of two points above a plane that only tier 4 tells, the
    /// farther one is the higher.
    #[test]
    fn any_exponents_have_the_exact_sign_and_order() {
        let mut random = Random::new(15);
        let mut any = |exponents: u64| {
            let exponent = (1023 - exponents / 2 + random.next_u64() % exponents).min(2046);
            f64::from_bits(random.next_u64() & !(0x7ff << 52) | exponent << 52)
        };
        let mut ranks = 0;
        for round in 0..rounds(5_000) {
            let exponents = [2046, 1400, 700][round % 3];
            let mut points = [(); 5].map(|()| Vector::from_fn(|_, _| any(exponents)));
            if round % 4 == 0 {
                // In the plane up to a rounding.
                points[3] = 0.5 * points[0] + 0.5 * points[1];
                points[4] = Vector::new(points[3].x, points[3].y.next_up(), points[3].z);
            }
            let [a, b, c, d, e] = points;
            let exact = ExactPoints::new(&points).unwrap();
            let plane = exact.plane([0, 1, 2]);
            let truths = [d, e].map(|p| exact_determinant(&[a, b, c, p]));
            let heights = [3, 4].map(|p| exact.height(&plane, p));
            for (height, truth) in heights.iter().zip(&truths) {
                assert_eq!(sign_of(*height), sign(truth), "{points:?}");
            }
            if heights.iter().all(|height| *height != 0.0 && height.abs() < UNDERFLOW_GUARD) {
                let [first, second] = truths.map(|truth| truth.clone() * truth);
                // Not told apart are those that differ by a rounding.
                let ratio = RBig::from(1_000_001) / RBig::from(1_000_000);
                assert!(heights[0].abs() >= heights[1].abs() || first < &second * &ratio, "{points:?}");
                assert!(heights[1].abs() >= heights[0].abs() || second < &first * &ratio, "{points:?}");
                ranks += 1;
            }
        }
        assert!(cfg!(miri) || ranks > 100, "{ranks}");
    }

    /// Small integers times one odd factor: coplanar and collinear ones among them are so exactly.
    #[test]
    fn exact_zeros_are_found() {
        let mut random = Random::new(12);
        let mut zeros = 0;
        for round in 0..rounds(20_000) {
            let factor = [1.0, 3.7e-5, 1e-305][round % 3];
            let points = [(); 4].map(|()| random.vector().map(|x| (3.0 * x).round() * 8.0 * factor));
            let truth = sign(&exact_determinant(&points));
            assert_eq!(sign_of(ExactPoints::new(&points).unwrap().orientation([0, 1, 2], 3)), truth);
            zeros += usize::from(truth == 0.0);
        }
        assert!(zeros >= if cfg!(miri) { 1 } else { 1000 }, "{zeros}");
    }

    #[test]
    fn projections_have_the_exact_sign() {
        let mut random = Random::new(13);
        for round in 0..rounds(5_000) {
            let scale = [1.0, 1e-200, 1e-310][round % 3];
            let (a, b) = (random.vector(), random.vector());
            let c = a + (b - a) * random.signed();
            let points = [a, b, c].map(|p| Vector::new(p.x, p.y * scale, p.z));
            let exact = ExactPoints::new(&points).unwrap();
            for axis in 0..3 {
                // Flattened along the axis and seen from above.
                let [a, b, c] = points.map(|mut p| {
                    p[axis] = 0.0;
                    p
                });
                let mut above = a;
                above[axis] = 1.0;
                let truth = sign(&exact_determinant(&[a, b, c, above]));
                assert_eq!(sign_of(exact.projected_orientation(axis, [0, 1, 2])), truth);
            }
        }
    }

    #[test]
    fn the_double_double_bound_holds() {
        let mut random = Random::new(14);
        let mut worst = 0.0_f64;
        for _ in 0..rounds(20_000) {
            let points = nearly_coplanar(&mut random);
            let [a, b, c, d] = points.map(<[f64; 3]>::from);
            let computed = double_double_height([&a, &b, &c], &d);
            let exact = exact_determinant(&points);
            let error = (RBig::try_from(computed).unwrap() - exact).to_f64().value().abs();
            // Only the high word is returned; dropping the low one cannot change the sign.
            let error = error - UNIT_ROUNDOFF * computed.abs();
            let (_, permanent) = normal_and_permanent([&a, &b, &c]);
            let spread: f64 = (0..3).map(|k| permanent[k] * (d[k] - a[k]).abs()).sum();
            if spread > 0.0 {
                worst = worst.max(error / (UNIT_ROUNDOFF * UNIT_ROUNDOFF * spread));
            }
        }
        assert!(worst <= 25.0, "{worst} u²");
    }

    #[test]
    fn averages_are_exact() {
        let d = 5e-324;
        let points = [[0.0, 0.0, 0.0], [d, 0.0, 0.0], [0.0, d, 0.0], [0.0, 0.0, d]].map(Vector::from);
        let mut exact = ExactPoints::new(&points).unwrap();
        exact.push_average([0, 1, 2, 3]).unwrap();
        exact.push_average([0, 0, 1, 2]).unwrap();
        for face in [[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]] {
            assert!(exact.orientation(face, 4) < 0.0, "{face:?}");
            assert!(exact.height(&exact.plane(face), 4) < 0.0, "{face:?}");
        }
        assert_eq!(exact.orientation([0, 1, 2], 5), 0.0);
        assert!(exact.orientation([1, 2, 3], 5) < 0.0);
    }
}
