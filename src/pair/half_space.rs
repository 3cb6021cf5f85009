//! A body and a half-space, such as a level ground: how far the body is from it or how deep in it, by its lowest vertex, which
//! integers find.

use super::signed_distance::SignedDistance;
use super::swept::sign;
use crate::answer::{Feature, Outcome, PlacedPoints, Radii, Side, label, moved, normalised, placed_points};
use crate::base::error::{Error, Result};
use crate::base::math::{UNIT_ROUNDOFF, Vector, clamp};
use crate::base::memory::in_integers;
use crate::base::simd::environment::with_default;
use crate::body::tables;
use crate::placed::Pair;
use crate::placed::exact::{self, Height};
use crate::placed::state::FeatureId;
use crate::shape::Placed;

/// The points x of the world with `normal` · x ≤ `offset`.
#[derive(Debug, Clone, Copy, PartialEq)]
#[repr(C)]
pub struct HalfSpace {
    /// Out of the half-space; of any length but 0.
    pub normal: [f64; 3],
    /// Place of its plane: the product of the normal with any of its points.
    pub offset: f64,
}

impl HalfSpace {
    /// # Errors
    /// [`Error::Argument`].
    pub(crate) fn check(&self) -> Result<()> {
        if !self.normal.iter().all(|x| x.is_finite()) || self.normal == [0.0; 3] {
            return Err(Error::Argument(format!(
                "the normal of the half-space is {:?}, it must be finite and not 0",
                self.normal
            )));
        }
        if !self.offset.is_finite() {
            return Err(Error::Argument(format!("the offset of the half-space is {}, it must be finite", self.offset)));
        }
        Ok(())
    }
}

/// Lengths below this are taken for nothing.
const TINY: f64 = 1e-150;

impl HalfSpace {
    /// A lower bound on the height of a box's content above the plane; 0 or less proves nothing, and neither does a NaN. Along
    /// the normal, in the unit of its largest component, the least of the box is off by 8u of the size of all terms.
    pub(crate) fn gap_of_box(&self, lower: [f64; 3], upper: [f64; 3]) -> f64 {
        let scale = self.normal.iter().fold(0.0_f64, |largest, x| largest.max(x.abs()));
        let (normal, offset) = (self.normal.map(|x| x / scale), self.offset / scale);
        let (mut height, mut size) = (-offset, offset.abs());
        for k in 0..3 {
            let least = normal[k] * if normal[k] > 0.0 { lower[k] } else { upper[k] };
            (height, size) = (height + least, size + least.abs());
        }
        (height - 8.0 * UNIT_ROUNDOFF * size) / Vector::from(normal).norm() * (1.0 - 8.0 * UNIT_ROUNDOFF) - TINY
    }
}

/// The distance of a body, which is object 1, from a half-space, or minus its depth: the least way that parts them is along the
/// normal, however deep. The interval holds for the exact body and plane, and is as narrow as doubles are; touching is decided in
/// integers.
///
/// The witness point of the half-space is below or above that of the body, on the plane; its local frame is the world. Its feature
/// is of no kind, that of the body a vertex.
///
/// # Errors
/// [`Error::Pose`] for a pose that is not accepted, as in [`distance`](crate::pair::distance), [`Error::Argument`] for a normal
/// that is 0 or not finite and an offset that is not finite, [`Error::Memory`] where there is none for integers.
pub fn half_space_distance(body: Placed, half_space: &HalfSpace) -> Result<SignedDistance> {
    // Telling what is refused computes, too.
    with_default(|| {
        half_space.check()?;
        body.pose.check()?;
        in_integers(|| of_lowest(body, half_space))
    })
}

/// The same of what is sound, in the default floating-point environment.
///
/// # Panics
/// Fails where integers get no memory, same as [`in_integers`].
pub(crate) fn of_lowest(body: Placed, half_space: &HalfSpace) -> SignedDistance {
    let (polyhedron, pose) = (body.shape.polyhedron(), body.pose);
    let &HalfSpace { normal, offset } = half_space;
    let up = normalised(&normal.into());
    let start = tables::farthest(polyhedron, &pose.rotate_back(&-Vector::from(up))).unwrap_or(0);
    let over = exact::OverPlane::new(polyhedron, pose, normal, offset);
    let lowest = over.lowest(start);
    let height = over.height(lowest);
    let radii = Radii::of_one(body.shape.swept_radius(), body.shape.deviation());
    let (side, interval) = above_plane(&height, &radii);
    let [lower, upper] = interval;
    let distance = middle(interval);
    let point = polyhedron.vertices[lowest as usize].position;
    let points = placed_points(&Pair { polyhedra: [polyhedron; 2], poses: [pose; 2] }, &[point; 2]);
    let PlacedPoints { local: [local, _], world: [world, _] } = moved(&points, [pose; 2], &up, radii.outwards());
    let foot = (Vector::from(world) - Vector::from(up) * distance).into();
    SignedDistance {
        outcome: match side {
            Side::Apart | Side::Beyond => Outcome::Separated,
            Side::Within => Outcome::Intersecting,
            Side::Hidden => Outcome::Undecided,
        },
        distance,
        lower,
        upper,
        local1: local,
        local2: foot,
        world1: world,
        world2: foot,
        normal: up,
        feature1: label(polyhedron, FeatureId::Vertex(lowest), &point),
        feature2: Feature::default(),
    }
}

/// Where the body of the lowest vertex with a ball about it is, and an interval of its height less the radius.
pub(crate) fn above_plane(height: &Height, radii: &Radii) -> (Side, [f64; 2]) {
    let interval = radii.off(height.bounds());
    let [lower, upper] = interval;
    // A height beyond the doubles may be one of them less the radius.
    let is_open = (lower <= 0.0 && upper >= 0.0) || upper == f64::INFINITY;
    let side = |is_apart: bool| if is_apart { Side::Apart } else { Side::Within };
    if height.is_below || !is_open {
        return (side(lower > 0.0), interval);
    }
    if radii.deviation > 0.0 {
        return (Side::of_curved(interval), interval);
    }
    let (is_apart, interval) = sign(&height.distance, radii, interval);
    (side(is_apart), interval)
}

/// A finite number of an interval that holds one, its middle where that is finite.
pub(crate) fn middle([lower, upper]: [f64; 2]) -> f64 {
    debug_assert!(lower <= upper, "{lower:e} {upper:e}");
    clamp(clamp(0.5 * lower + 0.5 * upper, lower, upper), -f64::MAX, f64::MAX)
}
