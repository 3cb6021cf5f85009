//! Two vectors side by side in single precision, one of each body of a pair: work that needs few digits is done for both at once.
//! Or eight numbers, each of another triangle.

/// Two vectors of four single-precision numbers. For a vector in three dimensions the fourth is unspecified.
pub trait Twins: Copy {
    /// From memory.
    fn load(first: &[f32; 4], second: &[f32; 4]) -> Self;
    /// Eight numbers from memory.
    fn load_eight(numbers: &[f32; 8]) -> Self;
    /// To memory, one after the other.
    fn to_array(self) -> [f32; 8];
    /// All numbers of one vector equal, and all of the other.
    fn splat(first: f32, second: f32) -> Self;
    /// Sums.
    fn add(self, other: Self) -> Self;
    /// Differences.
    fn sub(self, other: Self) -> Self;
    /// Products.
    fn mul(self, other: Self) -> Self;
    /// self·factor + addend; fused where the machine can, which only lowers the rounding error.
    fn mul_add(self, factor: Self, addend: Self) -> Self;
    /// addend − self·factor, like [`Twins::mul_add`].
    fn negated_mul_add(self, factor: Self, addend: Self) -> Self;
    /// The x of each vector in all its places.
    fn splat_x(self) -> Self;
    /// The y.
    fn splat_y(self) -> Self;
    /// The z.
    fn splat_z(self) -> Self;
    /// (y, z, x) of each.
    fn rotate(self) -> Self;
    /// The first with its sign changed, and the second.
    fn negate_first(self) -> Self;
    /// The second vector first.
    fn swap(self) -> Self;
    /// The products of the vectors, three numbers each, with those of another.
    fn dots(self, other: Self) -> [f32; 2];
    /// The same of the first vectors alone.
    fn dot(self, other: Self) -> f32;
    /// Number by number the lesser one; `other` like [`Lanes::max`](super::Lanes::max).
    fn min(self, other: Self) -> Self;
    /// Number by number the greater one, like it.
    fn max(self, other: Self) -> Self;
    /// Quotients.
    fn div(self, other: Self) -> Self;
    /// Square roots.
    fn sqrt(self) -> Self;
    /// Bit i is set where number i is greater than that of `other`; a NaN is not.
    fn greater(self, other: Self) -> u32;
    /// This where the number of `left` is greater than that of `right`, elsewhere `other`.
    fn where_greater(self, left: Self, right: Self, other: Self) -> Self;
    /// The x, the y and the z of the first vectors of four, then of the second ones.
    fn components(twins: &[Self; 4]) -> [Self; 3];
    /// The least number and its place; the first of equals. Any place if one is a NaN.
    fn least(self) -> (f32, usize);

    /// The sum of both vectors, twice.
    #[inline(always)]
    fn sum(self) -> Self {
        self.add(self.swap())
    }

    /// The cross products.
    #[inline(always)]
    fn cross(self, other: Self) -> Self {
        self.mul(other.rotate()).sub(self.rotate().mul(other)).rotate()
    }

    /// The sums of columns times the components of vectors.
    #[inline(always)]
    fn product(columns: &[Self; 3], v: Self) -> Self {
        let [x, y, z] = columns;
        z.mul_add(v.splat_z(), y.mul_add(v.splat_y(), x.mul(v.splat_x())))
    }
}

/// Plain arrays, for any target; `FUSED` as for [`super::lanes::Plain`].
#[derive(Clone, Copy)]
pub struct PortableTwins<const FUSED: bool>([f32; 8]);

impl<const FUSED: bool> PortableTwins<FUSED> {
    /// Both vectors, rounded.
    #[inline(always)]
    pub(super) fn rounded(first: [f64; 4], second: [f64; 4]) -> Self {
        PortableTwins(std::array::from_fn(|i| if i < 4 { first[i] as f32 } else { second[i - 4] as f32 }))
    }

    /// The number at a place of the same vector, of three.
    #[inline(always)]
    fn at(self, place: impl Fn(usize) -> usize) -> Self {
        PortableTwins(std::array::from_fn(|i| self.0[i / 4 * 4 + place(i % 4)]))
    }
}

impl<const FUSED: bool> Twins for PortableTwins<FUSED> {
    #[inline(always)]
    fn load(first: &[f32; 4], second: &[f32; 4]) -> Self {
        PortableTwins(std::array::from_fn(|i| if i < 4 { first[i] } else { second[i - 4] }))
    }
    #[inline(always)]
    fn load_eight(numbers: &[f32; 8]) -> Self {
        PortableTwins(*numbers)
    }
    #[inline(always)]
    fn to_array(self) -> [f32; 8] {
        self.0
    }
    #[inline(always)]
    fn splat(first: f32, second: f32) -> Self {
        PortableTwins(std::array::from_fn(|i| if i < 4 { first } else { second }))
    }
    #[inline(always)]
    fn add(self, other: Self) -> Self {
        PortableTwins(std::array::from_fn(|i| self.0[i] + other.0[i]))
    }
    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        PortableTwins(std::array::from_fn(|i| self.0[i] - other.0[i]))
    }
    #[inline(always)]
    fn mul(self, other: Self) -> Self {
        PortableTwins(std::array::from_fn(|i| self.0[i] * other.0[i]))
    }
    #[inline(always)]
    fn mul_add(self, factor: Self, addend: Self) -> Self {
        let one = |i: usize| {
            if FUSED { self.0[i].mul_add(factor.0[i], addend.0[i]) } else { self.0[i] * factor.0[i] + addend.0[i] }
        };
        PortableTwins(std::array::from_fn(one))
    }
    #[inline(always)]
    fn negated_mul_add(self, factor: Self, addend: Self) -> Self {
        let one = |i: usize| {
            if FUSED { (-self.0[i]).mul_add(factor.0[i], addend.0[i]) } else { addend.0[i] - self.0[i] * factor.0[i] }
        };
        PortableTwins(std::array::from_fn(one))
    }
    #[inline(always)]
    fn splat_x(self) -> Self {
        self.at(|_| 0)
    }
    #[inline(always)]
    fn splat_y(self) -> Self {
        self.at(|_| 1)
    }
    #[inline(always)]
    fn splat_z(self) -> Self {
        self.at(|_| 2)
    }
    #[inline(always)]
    fn rotate(self) -> Self {
        self.at(|i| [1, 2, 0, 3][i])
    }
    #[inline(always)]
    fn negate_first(self) -> Self {
        PortableTwins(std::array::from_fn(|i| if i < 4 { -self.0[i] } else { self.0[i] }))
    }
    #[inline(always)]
    fn swap(self) -> Self {
        PortableTwins(std::array::from_fn(|i| self.0[(i + 4) % 8]))
    }
    #[inline(always)]
    fn dots(self, other: Self) -> [f32; 2] {
        let products = self.mul(other).0;
        [products[0] + products[1] + products[2], products[4] + products[5] + products[6]]
    }
    #[inline(always)]
    fn dot(self, other: Self) -> f32 {
        self.dots(other)[0]
    }
    #[inline(always)]
    fn min(self, other: Self) -> Self {
        self.where_greater(other, self, other)
    }
    #[inline(always)]
    fn max(self, other: Self) -> Self {
        self.where_greater(self, other, other)
    }
    #[inline(always)]
    fn div(self, other: Self) -> Self {
        PortableTwins(std::array::from_fn(|i| self.0[i] / other.0[i]))
    }
    #[inline(always)]
    fn sqrt(self) -> Self {
        PortableTwins(self.0.map(f32::sqrt))
    }
    #[inline(always)]
    fn greater(self, other: Self) -> u32 {
        (0..8).map(|i| u32::from(self.0[i] > other.0[i]) << i).sum()
    }
    #[inline(always)]
    fn where_greater(self, left: Self, right: Self, other: Self) -> Self {
        PortableTwins(std::array::from_fn(|i| if left.0[i] > right.0[i] { self.0[i] } else { other.0[i] }))
    }
    #[inline(always)]
    fn components(twins: &[Self; 4]) -> [Self; 3] {
        std::array::from_fn(|axis| PortableTwins(std::array::from_fn(|i| twins[i % 4].0[i / 4 * 4 + axis])))
    }
    #[inline(always)]
    fn least(self) -> (f32, usize) {
        let mut best = (self.0[0], 0);
        for (place, value) in self.0.into_iter().enumerate() {
            if value < best.0 {
                best = (value, place);
            }
        }
        best
    }
}
