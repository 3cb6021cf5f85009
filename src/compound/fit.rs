//! Boxes around points: along the axes of the body, and turned to fit.

use crate::base::math::{Matrix, UNIT_ROUNDOFF as U, Vector, are_finite, is_unit};

/// A box: the points x with |a·(x − `centre`)| ≤ `half` for each of three axes a. Of each array the last number is 0.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Fitted {
    pub centre: [f64; 4],
    pub half: [f64; 4],
}

/// A box along axes of its own, orthonormal up to [`MOST_SKEW`].
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Oriented {
    pub fitted: Fitted,
    pub axes: [[f64; 4]; 3],
}

/// No entry of QᵀQ − I exceeds this for the axes Q of a box.
pub(super) const MOST_SKEW: f64 = 16.0 * U;

/// A group of points as boxes see it.
#[derive(Debug, Clone, Copy)]
pub(super) struct Cloud<'a> {
    /// The points of each piece.
    pub groups: &'a [&'a [Vector]],
    /// All that belongs to a point is no farther from it than this.
    pub margin: f64,
    /// No point is farther from the origin.
    pub reach: f64,
}

impl Cloud<'_> {
    fn ends(&self, axis: &Vector) -> [f64; 2] {
        let along = self.groups.iter().flat_map(|group| group.iter()).map(|point| axis.dot(point));
        along.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], x| [low.min(x), high.max(x)])
    }

    /// The box along these axes.
    ///
    /// A product with an axis of length 1 + 16u is off by at most 6u·reach, the centre is by 16u·reach along each axis, and the
    /// differences by u of themselves: 32u·reach in all, and twice that is added.
    pub fn box_along(&self, axes: &[Vector; 3]) -> Fitted {
        debug_assert!(axes.iter().all(is_unit));
        let ends = [0, 1, 2].map(|k| self.ends(&axes[k]));
        let middles = ends.map(|[low, high]| 0.5 * low + 0.5 * high);
        let centre = axes[0] * middles[0] + axes[1] * middles[1] + axes[2] * middles[2];
        let slack = self.margin * (1.0 + 4.0 * U) + 64.0 * U * self.reach;
        let half = [0, 1, 2].map(|k| (ends[k][1] - middles[k]).max(middles[k] - ends[k][0]) + slack);
        Fitted { centre: [centre.x, centre.y, centre.z, 0.0], half: [half[0], half[1], half[2], 0.0] }
    }

    /// The box of the least surface among those along the given axes, and the body's own.
    pub fn best_box(&self, candidates: impl Iterator<Item = [Vector; 3]>) -> Oriented {
        let own = [Vector::x(), Vector::y(), Vector::z()];
        let mut best = (self.box_along(&own), own);
        for axes in candidates {
            let fitted = self.box_along(&axes);
            // False for a NaN.
            if fitted.surface() < best.0.surface() {
                best = (fitted, axes);
            }
        }
        Oriented { fitted: best.0, axes: best.1.map(|axis| [axis.x, axis.y, axis.z, 0.0]) }
    }

    /// The axes of the points' scatter.
    pub fn principal_axes(&self) -> Option<[Vector; 3]> {
        let points = || self.groups.iter().flat_map(|group| group.iter());
        let count = points().count() as f64;
        // In units of the reach, so that no square leaves the doubles.
        let unit = 1.0 / self.reach;
        let mean = points().map(|point| point * unit).sum::<Vector>() / count;
        let scatter = points().map(|point| point * unit - mean).map(|d| d * d.transpose()).sum::<Matrix>();
        if !scatter.iter().all(|x| x.is_finite()) {
            return None;
        }
        const MOST_ROUNDS: usize = 64;
        let vectors = scatter.try_symmetric_eigen(f64::EPSILON, MOST_ROUNDS)?.eigenvectors;
        axes_of(&vectors.column(0).into(), &vectors.column(1).into())
    }
}

impl Fitted {
    /// A quarter of the box's surface.
    pub fn surface(&self) -> f64 {
        let [x, y, z, _] = self.half;
        x * y + y * z + z * x
    }

    /// The square of half the diagonal.
    pub fn size(&self) -> f64 {
        self.half.iter().map(|x| x * x).sum()
    }
}

/// Orthonormal axes, the first along `first`, the second as near as may be to `second`; `None` if these are not independent.
pub(super) fn axes_of(first: &Vector, second: &Vector) -> Option<[Vector; 3]> {
    let x = first.try_normalize(f64::MIN_POSITIVE)?;
    // Twice: what rounding leaves of the first axis after the first time is large where they are nearly along one line.
    let once = (second - x * x.dot(second)).try_normalize(f64::MIN_POSITIVE)?;
    let y = (once - x * x.dot(&once)).try_normalize(f64::MIN_POSITIVE)?;
    let z = x.cross(&y);
    let skew = Matrix::from_columns(&[x, y, z]);
    let defect = (skew.transpose() * skew - Matrix::identity()).amax();
    ([x, y, z].iter().all(are_finite) && defect <= MOST_SKEW - 4.0 * U).then_some([x, y, z])
}
