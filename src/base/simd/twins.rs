//! Two vectors side by side in single precision, one of each body of a pair: work that needs few digits is done for both at once.

/// Two vectors of four single-precision numbers. For a vector in three dimensions the fourth is unspecified.
pub trait Twins: Copy {
    /// From memory.
    fn load(first: &[f32; 4], second: &[f32; 4]) -> Self;
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

/// Plain arrays, for any target.
#[derive(Clone, Copy)]
pub struct PortableTwins([f32; 8]);

impl PortableTwins {
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

impl Twins for PortableTwins {
    #[inline(always)]
    fn load(first: &[f32; 4], second: &[f32; 4]) -> Self {
        PortableTwins(std::array::from_fn(|i| if i < 4 { first[i] } else { second[i - 4] }))
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
        PortableTwins(std::array::from_fn(|i| self.0[i] * factor.0[i] + addend.0[i]))
    }
    #[inline(always)]
    fn negated_mul_add(self, factor: Self, addend: Self) -> Self {
        PortableTwins(std::array::from_fn(|i| addend.0[i] - self.0[i] * factor.0[i]))
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
}
