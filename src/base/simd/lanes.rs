//! Four doubles: the operations that a query needs, and plain arrays that do them on any machine.

use super::Work;
use super::twins::{PortableTwins, Twins};
use crate::base::double_double::two_product;
use crate::base::math::Vector;

/// Four doubles. For a vector in three dimensions, lanes 0 to 2 are the components and lane 3 is unspecified.
pub trait Lanes: Copy {
    /// Two vectors in single precision.
    type Twins: Twins;
    /// Whether [`Lanes::mul_add`] is fused.
    const IS_FUSED: bool;
    /// Two vectors, rounded to single precision.
    fn twins(self, second: Self) -> Self::Twins;
    /// All lanes equal.
    fn splat(x: f64) -> Self;
    /// From memory.
    fn load(x: &[f64; 4]) -> Self;
    /// To memory.
    fn to_array(self) -> [f64; 4];
    /// Lanes 0 to 2 to memory.
    fn store_vector(self, to: &mut [f64; 3]);
    /// From the bits of single-precision numbers in memory.
    fn load_single(x: &[u32; 4]) -> Self;
    /// To memory, as the bits of single-precision numbers.
    fn store_single(self, to: &mut [u32; 4]);
    /// A vector.
    fn from_vector(v: &Vector) -> Self;
    /// Lanes 0 to 2.
    fn to_vector(self) -> Vector;
    /// Sum.
    fn add(self, other: Self) -> Self;
    /// Difference.
    fn sub(self, other: Self) -> Self;
    /// Product.
    fn mul(self, other: Self) -> Self;
    /// self·factor + addend; fused where the machine can, which only lowers the rounding error.
    fn mul_add(self, factor: Self, addend: Self) -> Self;
    /// addend − self·factor, like [`Lanes::mul_add`].
    fn negated_mul_add(self, factor: Self, addend: Self) -> Self;
    /// The vector with its sign changed.
    fn negate(self) -> Self;
    /// Bit i is set where lane i is greater than that of `other`; a NaN is not.
    fn greater(self, other: Self) -> u32;
    /// All lanes equal to lane 0.
    fn splat_x(self) -> Self;
    /// All lanes equal to lane 1.
    fn splat_y(self) -> Self;
    /// All lanes equal to lane 2.
    fn splat_z(self) -> Self;
    /// The columns of the 3x4 matrix with these rows; lane 3 of each is 0.
    fn transpose(rows: &[Self; 3]) -> [Self; 4];
    /// Lanes 1, 2, 0: (y, z, x) of a vector.
    fn rotate(self) -> Self;
    /// Sum of the products of lanes 0 to 2.
    fn dot(self, other: Self) -> f64;
    /// Bit i is set where lane i is at most that of `other`; a NaN is not.
    fn at_most(self, other: Self) -> u32;
    /// |x| + |y| + |z|, rounded.
    fn norm1(self) -> f64;
    /// Lane by lane the greater one; `other` of zeros of either sign, and if one is a NaN.
    fn max(self, other: Self) -> Self;
    /// Lane by lane the lesser one; `other` like [`Lanes::max`].
    fn min(self, other: Self) -> Self;
    /// Quotient.
    fn div(self, other: Self) -> Self;
    /// Square root.
    fn sqrt(self) -> Self;
    /// The x, the y and the z of four vectors.
    fn components(vectors: &[Self; 4]) -> [Self; 3];
    /// This where the lane of `left` is greater than that of `right`, elsewhere `other`.
    fn where_greater(self, left: Self, right: Self, other: Self) -> Self;
    /// With lane 0 of `other`.
    fn with_first(self, other: Self) -> Self;
    /// Lanes 2 and 3 of one and of the other.
    fn upper_halves(first: Self, second: Self) -> Self;
    /// Whether the products of eight vectors (their x, y and z) with this one, all in single precision, are less than a limit;
    /// a NaN is not.
    fn products_are_below(self, vectors: [&[f32; 8]; 3], limit: f32) -> bool;
    /// The greatest of such products and which it is; the first of equals. Any if one is a NaN.
    fn greatest_product(self, vectors: [&[f32; 8]; 3]) -> (f32, usize);
    /// The least and the greatest of such products over many vectors; any if one is a NaN.
    fn extreme_products(self, vectors: &[[[f32; 8]; 3]]) -> [f32; 2];
    /// Of such products over many vectors which is the greatest, that, and the second. Any if one is a NaN or there are none.
    fn farthest_product(self, vectors: &[[[f32; 8]; 3]]) -> (usize, [f32; 2]);
    /// Which of such products over many vectors is the greatest; of equals, and if one is a NaN, any.
    fn farthest_of(self, vectors: &[[[f32; 8]; 3]]) -> usize;
    /// The least lane and which it is; the first of equals. Any lane if one is a NaN.
    fn least(self) -> (f64, usize);
    /// Prefetches an element that may soon be needed: the first three cache lines, which are the part that marching reads of a
    /// feature. Any index will do.
    #[inline(always)]
    fn prefetch<T>(_elements: &[T], _index: u32) {}
    /// Does the work out of line, compiled for these lanes.
    fn out_of_line<W: Work>(work: &mut W) -> W::Output;

    /// The cross product.
    #[inline(always)]
    fn cross(self, other: Self) -> Self {
        self.mul(other.rotate()).sub(self.rotate().mul(other)).rotate()
    }

    /// The sum, and what its rounding has left off (D. E. Knuth, The Art of Computer Programming, vol. 2, §4.2.2).
    #[inline(always)]
    fn two_sum(self, other: Self) -> [Self; 2] {
        let sum = self.add(other);
        let part = sum.sub(self);
        [sum, self.sub(sum.sub(part)).add(other.sub(part))]
    }

    /// The product, and what its rounding has left off; see [`two_product`].
    #[inline(always)]
    fn two_product(self, other: Self) -> [Self; 2] {
        let product = self.mul(other);
        if Self::IS_FUSED {
            return [product, self.mul_add(other, product.negate())];
        }
        let (x, y) = (self.to_array(), other.to_array());
        [product, Self::load(&std::array::from_fn(|i| two_product(x[i], y[i]).lo))]
    }
}

/// Plain arrays, for any target. `FUSED`: products are added unrounded, by an instruction that the target must have, else by a call
/// of hundreds of nanoseconds.
#[derive(Clone, Copy)]
pub struct Plain<const FUSED: bool>([f64; 4]);

/// Lanes of code that is not dispatched: alike on all machines.
pub type Portable = Plain<false>;

impl<const FUSED: bool> Lanes for Plain<FUSED> {
    type Twins = PortableTwins<FUSED>;
    const IS_FUSED: bool = FUSED;
    #[inline(always)]
    fn twins(self, second: Self) -> PortableTwins<FUSED> {
        PortableTwins::rounded(self.0, second.0)
    }
    #[inline(always)]
    fn splat(x: f64) -> Self {
        Plain([x; 4])
    }
    #[inline(always)]
    fn load(x: &[f64; 4]) -> Self {
        Plain(*x)
    }
    #[inline(always)]
    fn to_array(self) -> [f64; 4] {
        self.0
    }
    #[inline(always)]
    fn store_vector(self, to: &mut [f64; 3]) {
        let [x, y, z, _] = self.0;
        *to = [x, y, z];
    }
    #[inline(always)]
    fn load_single(x: &[u32; 4]) -> Self {
        Plain(x.map(|bits| f32::from_bits(bits).into()))
    }
    #[inline(always)]
    fn store_single(self, to: &mut [u32; 4]) {
        *to = self.0.map(|x| (x as f32).to_bits());
    }
    #[inline(always)]
    fn from_vector(v: &Vector) -> Self {
        Plain([v.x, v.y, v.z, v.z])
    }
    #[inline(always)]
    fn to_vector(self) -> Vector {
        Vector::new(self.0[0], self.0[1], self.0[2])
    }
    #[inline(always)]
    fn add(self, other: Self) -> Self {
        Plain(std::array::from_fn(|i| self.0[i] + other.0[i]))
    }
    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        Plain(std::array::from_fn(|i| self.0[i] - other.0[i]))
    }
    #[inline(always)]
    fn mul(self, other: Self) -> Self {
        Plain(std::array::from_fn(|i| self.0[i] * other.0[i]))
    }
    #[inline(always)]
    fn mul_add(self, factor: Self, addend: Self) -> Self {
        let one = |i: usize| {
            if FUSED { self.0[i].mul_add(factor.0[i], addend.0[i]) } else { self.0[i] * factor.0[i] + addend.0[i] }
        };
        Plain(std::array::from_fn(one))
    }
    #[inline(always)]
    fn negated_mul_add(self, factor: Self, addend: Self) -> Self {
        let one = |i: usize| {
            if FUSED { (-self.0[i]).mul_add(factor.0[i], addend.0[i]) } else { addend.0[i] - self.0[i] * factor.0[i] }
        };
        Plain(std::array::from_fn(one))
    }
    #[inline(always)]
    fn negate(self) -> Self {
        Plain(self.0.map(|x| -x))
    }
    #[inline(always)]
    fn greater(self, other: Self) -> u32 {
        let bit = |i: usize| u32::from(self.0[i] > other.0[i]) << i;
        bit(0) | bit(1) | bit(2) | bit(3)
    }
    #[inline(always)]
    fn splat_x(self) -> Self {
        Plain([self.0[0]; 4])
    }
    #[inline(always)]
    fn splat_y(self) -> Self {
        Plain([self.0[1]; 4])
    }
    #[inline(always)]
    fn splat_z(self) -> Self {
        Plain([self.0[2]; 4])
    }
    #[inline(always)]
    fn transpose(rows: &[Self; 3]) -> [Self; 4] {
        std::array::from_fn(|i| Plain([rows[0].0[i], rows[1].0[i], rows[2].0[i], 0.0]))
    }
    #[inline(always)]
    fn rotate(self) -> Self {
        Plain([self.0[1], self.0[2], self.0[0], self.0[3]])
    }
    #[inline(always)]
    fn dot(self, other: Self) -> f64 {
        self.0[0] * other.0[0] + self.0[1] * other.0[1] + self.0[2] * other.0[2]
    }
    #[inline(always)]
    fn at_most(self, other: Self) -> u32 {
        let bit = |i: usize| u32::from(self.0[i] <= other.0[i]) << i;
        bit(0) | bit(1) | bit(2) | bit(3)
    }
    #[inline(always)]
    fn norm1(self) -> f64 {
        self.0[0].abs() + self.0[1].abs() + self.0[2].abs()
    }
    #[inline(always)]
    fn max(self, other: Self) -> Self {
        self.where_greater(self, other, other)
    }
    #[inline(always)]
    fn min(self, other: Self) -> Self {
        self.where_greater(other, self, other)
    }
    #[inline(always)]
    fn div(self, other: Self) -> Self {
        Plain(std::array::from_fn(|i| self.0[i] / other.0[i]))
    }
    #[inline(always)]
    fn sqrt(self) -> Self {
        Plain(self.0.map(f64::sqrt))
    }
    #[inline(always)]
    fn components(vectors: &[Self; 4]) -> [Self; 3] {
        std::array::from_fn(|k| Plain(std::array::from_fn(|i| vectors[i].0[k])))
    }
    #[inline(always)]
    fn where_greater(self, left: Self, right: Self, other: Self) -> Self {
        Plain(std::array::from_fn(|i| if left.0[i] > right.0[i] { self.0[i] } else { other.0[i] }))
    }
    #[inline(always)]
    fn with_first(self, other: Self) -> Self {
        Plain([other.0[0], self.0[1], self.0[2], self.0[3]])
    }
    #[inline(always)]
    fn upper_halves(first: Self, second: Self) -> Self {
        Plain([first.0[2], first.0[3], second.0[2], second.0[3]])
    }
    #[inline(always)]
    fn products_are_below(self, vectors: [&[f32; 8]; 3], limit: f32) -> bool {
        self.products(vectors).iter().all(|product| *product < limit)
    }
    #[inline(always)]
    fn greatest_product(self, vectors: [&[f32; 8]; 3]) -> (f32, usize) {
        let products = self.products(vectors);
        let mut best = (products[0], 0);
        for (lane, product) in products.into_iter().enumerate() {
            if product > best.0 {
                best = (product, lane);
            }
        }
        best
    }
    #[inline(always)]
    fn extreme_products(self, vectors: &[[[f32; 8]; 3]]) -> [f32; 2] {
        let mut ends = [f32::INFINITY, f32::NEG_INFINITY];
        for [x, y, z] in vectors {
            for product in self.products([x, y, z]) {
                ends = [ends[0].min(product), ends[1].max(product)];
            }
        }
        ends
    }
    #[inline(always)]
    fn farthest_product(self, vectors: &[[[f32; 8]; 3]]) -> (usize, [f32; 2]) {
        let (mut place, mut greatest, mut second) = (0, f32::NEG_INFINITY, f32::NEG_INFINITY);
        for (block, [x, y, z]) in vectors.iter().enumerate() {
            for (lane, product) in self.products([x, y, z]).into_iter().enumerate() {
                second = second.max(greatest.min(product));
                if product > greatest {
                    (place, greatest) = (8 * block + lane, product);
                }
            }
        }
        (place, [greatest, second])
    }
    #[inline(always)]
    fn farthest_of(self, vectors: &[[[f32; 8]; 3]]) -> usize {
        self.farthest_product(vectors).0
    }
    #[inline(always)]
    fn least(self) -> (f64, usize) {
        let mut best = (self.0[0], 0);
        for (lane, value) in self.0.into_iter().enumerate() {
            if value < best.0 {
                best = (value, lane);
            }
        }
        best
    }
    #[inline(never)]
    fn out_of_line<W: Work>(work: &mut W) -> W::Output {
        work.run()
    }
}

impl<const FUSED: bool> Plain<FUSED> {
    #[inline(always)]
    fn products(self, [x, y, z]: [&[f32; 8]; 3]) -> [f32; 8] {
        let [a, b, c, _] = self.0.map(|lane| lane as f32);
        let one = |i: usize| {
            if FUSED { z[i].mul_add(c, y[i].mul_add(b, x[i] * a)) } else { x[i] * a + y[i] * b + z[i] * c }
        };
        std::array::from_fn(one)
    }
}
