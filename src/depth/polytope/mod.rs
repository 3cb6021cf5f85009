//! How deep two bodies are in each other, by a closed polytope of triangles inside their Minkowski difference around the origin.
//!
//! C = {x − y: x in body 1, y in body 2}. For intersecting bodies the origin lies in C, and the least translation that parts them
//! is as long as the origin is far from the boundary of C.
//!
//! *From below*: a closed oriented cycle of triangles with corners in C, of degree other than 0 about the origin, encloses the
//! ball around the origin that meets no triangle. For a point outside C is parted from it by a plane, so that the cycle has
//! degree 0 about it, and the degree does not change along a way that meets no triangle. Neither convexity nor a manifold is
//! asked for. The ball's radius is the least distance of a triangle from the origin, and of each that is at least min m·v/|m|
//! over its corners v, for any vector m.
//!
//! *From above*: the support h(n) of C in any direction n.
//!
//! The polytope grows where it is nearest, by the support vertex beyond that triangle, as in the expanding polytope algorithm
//! (van den Bergen 2001), until both bounds meet; kept from query to query it needs few new vertices, or none. Being no hull it
//! can be moved on with the bodies: the certificate is checked anew in each query.

mod storage;
mod planes;
mod support;
mod cycle;
mod sliver;
mod first;
mod proposal;
mod degree;
mod expand;
mod witness;

use crate::base::math::{UNIT_ROUNDOFF as U, Vector, power_of_two};
use crate::base::scalar::{Scalar, constant};
use crate::base::simd::Lanes;
use crate::body::polyhedron::Polyhedron;
use crate::placed::frame::{Frame, difference_error};
pub use expand::{Ending, Expansion, SearchStart, WantedDepth, expand};
pub use planes::evaluate;
pub use storage::Polytope;
pub use support::{HEIGHTS, difference, farthest, heights, rough_support, support};
pub use witness::{PolytopeWitness, witness};

/// The rounding errors of the numbers of one pair.
///
/// With M = 1.02(ρ₁ + ρ₂) + |Δ| no difference of vertices is longer than M (‖R‖ ≤ 1.015), nor off by more than e, see
/// [`Frame::difference_error`].
#[derive(Debug, Clone, Copy)]
pub struct PairRounding {
    /// An upper bound of e.
    pub difference: f64,
    /// How far m·v, as computed for a computed difference v and a computed unit vector m, is off from m·v/|m| for the exact v: 3u·M
    /// the product, 5u·M the length of m, e the difference. It is given 10u·M and e.
    pub plane: f64,
    /// With edges e and g of a triangle of computed corners det(v₀, v₁, v₂) = (e × g)·v, as computed, is off by less than this
    /// times
    /// |e||g|: each component of the cross product errs by 3u of its permanent and u of itself, which makes 5.3u·|e||g|, the
    /// product with v by 3u more, all times M.
    pub determinant: f64,
    /// The guaranteed width of an interval: `plane` at each end, and the loss where both meet.
    pub provable: f64,
}

impl PairRounding {
    /// The rounding of a pair.
    #[inline(always)]
    pub fn of<L: Lanes>(frame: &Frame<L>) -> PairRounding {
        let [difference, plane, determinant, provable] = rounding(frame.size, frame.separation);
        PairRounding { difference, plane, determinant, provable }
    }
}

/// The numbers of [`PairRounding`], in its order.
#[inline(always)]
pub fn rounding<S: Scalar>(size: S, separation: S) -> [S; 4] {
    let longest = constant::<S>(1.02) * size + separation;
    let difference = difference_error(size, separation, longest);
    let determinant = constant::<S>(10.0 * U) * longest;
    let plane = difference + determinant;
    [difference, plane, determinant, constant::<S>(2.0) * plane + constant::<S>(8.0 * U) * longest]
}

/// The exponent of the largest and smallest radius that a search takes as it is: beyond, cross products may underflow or overflow.
const MOST_EXPONENT: i32 = 100;

/// Whether a search takes a pair as it is.
#[inline(always)]
pub fn is_in_scale(polyhedra: [&Polyhedron; 2]) -> bool {
    let [radius1, radius2] = polyhedra.map(|polyhedron| polyhedron.radius);
    let radius = if radius1 > radius2 { radius1 } else { radius2 };
    (power_of_two(-MOST_EXPONENT)..=power_of_two(MOST_EXPONENT)).contains(&radius)
}

/// Cross products of edges shorter than this, 2⁻⁴⁰⁰, count as none: the squares of longer ones do not underflow. Pairs whose size
/// is next to 2⁻²⁰⁰ lose their triangles by it, and integers decide them.
const SHORTEST_NORMAL: f64 = f64::from_bits((1023 - 400) << 52);

/// The point inside C from which the polytope is looked at: the difference of the centres of mass.
#[inline(always)]
fn centre_of_differences<L: Lanes>(frame: &Frame<L>) -> Vector {
    let [centre1, centre2] = frame.polyhedra().map(|polyhedron| polyhedron.mass.centre_of_mass - polyhedron.centre);
    frame.difference(&centre1, &centre2).to_vector()
}
