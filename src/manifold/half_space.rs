//! The manifold of a body and a half-space: the corners of the patch that looks at its plane.

use super::answer::{FOUR, Manifold, ManifoldConfig, ManifoldPoint};
use super::clip::CommonCorner;
use super::id::id_of;
use super::outline::{Axes, Outline};
use super::patch::facing;
use super::places::{CommonPoint, Origin};
use super::reduction::{Thinned, four_of};
use super::witness::witness;
use super::{Fill, Sink};
use crate::answer::{Feature, Outcome, PlacedPoints, Radii, label, moved, placed_points};
use crate::base::double_double::{DoubleDouble, WideVector, wide_difference, wide_dot, widen};
use crate::base::error::Result;
use crate::base::extended_range::Extended;
use crate::base::math::{UNIT_ROUNDOFF as U, Vector, power_of_two};
use crate::base::memory::{in_integers, with_capacity};
use crate::base::simd::environment::with_default;
use crate::pair::{HalfSpace, SignedDistance, above_plane, middle, of_lowest};
use crate::placed::Pair;
use crate::placed::exact::OverPlane;
use crate::placed::state::FeatureId;
use crate::shape::Placed;
use std::ops::RangeInclusive;

/// The contact points of a body, which is object 1, that meets a half-space or is up to `max_distance` apart. They are the corners
/// of the body's face that looks most at the plane, with a gap of at most `max_distance`. The deepest point of the body is among
/// them. Points on the half-space are on its plane, in the world; their features are of no kind.
///
/// For a reduced manifold, four points are chosen anew each time: there is no cache.
///
/// # Errors
/// As of [`half_space_distance`](crate::pair::half_space_distance) and of [`manifold`](crate::manifold::manifold).
pub fn half_space_manifold(
    body: Placed,
    half_space: &HalfSpace,
    config: &ManifoldConfig,
    points: &mut [ManifoldPoint],
) -> Result<Manifold> {
    let capacity = points.len();
    let mut write = |place: usize, fill: Fill| fill(&mut points[place]);
    half_space_manifold_into(body, half_space, config, &mut Sink { capacity, written: 0, write: &mut write })
}

/// The same, written to the caller's place.
pub(crate) fn half_space_manifold_into(
    body: Placed,
    half_space: &HalfSpace,
    config: &ManifoldConfig,
    points: &mut Sink,
) -> Result<Manifold> {
    with_default(|| {
        config.check()?;
        half_space.check()?;
        body.pose.check()?;
        make(body, half_space, config, points)
    })
}

fn make(body: Placed, half_space: &HalfSpace, config: &ManifoldConfig, points: &mut Sink) -> Result<Manifold> {
    let contact = in_integers(|| of_lowest(body, half_space))?;
    let SignedDistance { outcome, lower, upper, normal, .. } = contact;
    let mut answer = Manifold { outcome, reference: 0, lower, upper, normal, point_count: 0, found_count: 0 };
    if lower > config.max_distance {
        answer.outcome = Outcome::Beyond;
        return Ok(answer);
    }
    let polyhedron = body.shape.polyhedron();
    let up = Vector::from(normal);
    let patch = facing(body, &-up, &contact.local1.into(), None, 0.0).map(|facing| facing.patch);
    let axes = Axes::new(&up, &up);
    let outline = Outline::new(polyhedron, body.pose, Vector::zeros(), &axes, patch);
    let plane = Plane::new(body, half_space, &outline)?;
    let mut thinned = Thinned::new(&[0; FOUR]);
    let (mut found, mut is_deep) = (0, false);
    for corner in 0..outline.count {
        let [least, most] = plane.gap(&outline, corner);
        if !(least <= config.max_distance) {
            continue;
        }
        is_deep |= least <= upper;
        found += 1;
        if config.reduces {
            let place = outline.spot(corner);
            let mut spots = [place; 2];
            (spots[0].z, spots[1].z) = (middle([least, most]), 0.0);
            let origin = Origin::Corner(CommonCorner::Vertex { body: 0, corner });
            thinned.add(&CommonPoint { origin, spots, error: 0.5 * (most - least) });
        } else {
            points.push(|point| *point = plane.point(&outline, corner, &normal));
        }
    }
    if config.reduces {
        // The lowest vertex is one of the four.
        let most = if is_deep { FOUR } else { FOUR - 1 };
        for place in four_of(thinned.places(), &[0; FOUR], polyhedron.radius).into_iter().flatten().take(most) {
            if let Origin::Corner(CommonCorner::Vertex { corner, .. }) = place.origin {
                points.push(|point| *point = plane.point(&outline, corner, &normal));
            }
        }
    }
    // The face most parallel to the plane need not hold the lowest vertex.
    if !is_deep {
        points.insist(|point| *point = witness(&contact));
        found += 1;
    }
    answer.reference = if found > 1 { 1 } else { 0 };
    (answer.point_count, answer.found_count) = (points.written as u32, found);
    Ok(answer)
}

/// A plane beside a body.
struct Plane<'a> {
    body: Placed<'a>,
    radii: Radii,
    heights: VertexHeights,
}

/// How far vertices are over a plane: rounded, of the polyhedron.
enum VertexHeights {
    Rounded(RoundedPlane),
    /// Of all corners of the outline, less the swept radius, by integers: doubles are too small or too large to tell.
    Exact(Vec<[f64; 2]>),
}

/// A plane in double-double arithmetic, its normal in a unit in which no square leaves the range of doubles.
struct RoundedPlane {
    normal: WideVector,
    offset: f64,
    /// The length of the normal, right to 4u.
    length: f64,
    /// By how much the product of the normal with a vertex, less the offset, may be off.
    error: f64,
}

/// The error of double-double arithmetic for a product of sums of products, over the sizes of all parts: some 20 operations at
/// 2⁻¹⁰² each, and a margin for what underflows.
const ERROR: f64 = f64::from_bits((1023 - 90) << 52);

/// Sums of sizes from here, 2⁻⁸⁰⁰, to here, 2⁹⁰⁰, are for double-double arithmetic. Some hundred operations lose 2⁻¹⁰⁷⁴ each where
/// they underflow, less than 2⁻²⁰⁰ of such a sum; products are split by 2²⁷, so nothing overflows.
const SIZES: RangeInclusive<f64> = f64::from_bits((1023 - 800) << 52)..=f64::from_bits((1023 + 900) << 52);

impl RoundedPlane {
    fn new(body: Placed, half_space: &HalfSpace) -> Option<RoundedPlane> {
        let polyhedron = body.shape.polyhedron();
        // A power of two makes the largest component 1 to 2, in two steps as neither end of the range has its inverse. It is exact,
        // but for parts of less than 2⁻¹⁰²² of the largest: they lose 2⁻¹⁰⁷⁴ of it, as do offsets.
        let exponent = -Extended::from(Vector::from(half_space.normal).amax()).exponent;
        let [half, rest] = [exponent / 2, exponent - exponent / 2].map(power_of_two);
        let normal = Vector::from(half_space.normal) * half * rest;
        let offset = half_space.offset * half * rest;
        // |R·p| is at most 1.8 of the 1-norm of p.
        let size = 2.0 * (polyhedron.centre.lp_norm(1) + polyhedron.radius) + body.pose.translation().lp_norm(1);
        let sizes = normal.lp_norm(1) * size + offset.abs();
        let plane = RoundedPlane { normal: widen(&normal), offset, length: normal.norm(), error: ERROR * sizes };
        // False on overflow.
        SIZES.contains(&sizes).then_some(plane)
    }

    /// How far a vertex is over the plane.
    fn height(&self, body: Placed, vertex: u32) -> [f64; 2] {
        let RoundedPlane { normal, offset, length, error } = self;
        let polyhedron = body.shape.polyhedron();
        let local = wide_difference(&polyhedron.vertices[vertex as usize].position, &-polyhedron.centre);
        let world =
            body.pose.rows.map(|[x, y, z, t]| wide_dot(&widen(&Vector::new(x, y, z)), &local) + DoubleDouble::from(t));
        let product = wide_dot(normal, &world) - DoubleDouble::from(*offset);
        let height = product.hi / length;
        // The length, the quotient and the low word.
        let off = 8.0 * U * height.abs() + error / length;
        [height - off, height + off]
    }
}

impl<'a> Plane<'a> {
    /// # Errors
    /// [`Error::Memory`](crate::base::error::Error::Memory).
    fn new(body: Placed<'a>, half_space: &HalfSpace, outline: &Outline) -> Result<Plane<'a>> {
        let radii = Radii::of_one(body.shape.swept_radius(), body.shape.deviation());
        let heights = match RoundedPlane::new(body, half_space) {
            Some(plane) => VertexHeights::Rounded(plane),
            None => {
                let &HalfSpace { normal, offset } = half_space;
                let mut heights = with_capacity(outline.count)?;
                in_integers(|| {
                    let over = OverPlane::new(body.shape.polyhedron(), body.pose, normal, offset);
                    let height = |corner| over.height(outline.vertex(corner));
                    heights.extend((0..outline.count).map(|corner| above_plane(&height(corner), &radii).1));
                })?;
                VertexHeights::Exact(heights)
            }
        };
        Ok(Plane { body, radii, heights })
    }

    /// How far a corner is over the plane, less the swept radius.
    fn gap(&self, outline: &Outline, corner: usize) -> [f64; 2] {
        match &self.heights {
            VertexHeights::Rounded(plane) => self.radii.off(plane.height(self.body, outline.vertex(corner))),
            VertexHeights::Exact(heights) => heights[corner],
        }
    }

    fn point(&self, outline: &Outline, corner: usize, normal: &[f64; 3]) -> ManifoldPoint {
        let (polyhedron, pose, vertex) = (self.body.shape.polyhedron(), self.body.pose, outline.vertex(corner));
        let position = polyhedron.vertices[vertex as usize].position;
        let points = placed_points(&Pair { polyhedra: [polyhedron; 2], poses: [pose; 2] }, &[position; 2]);
        let PlacedPoints { local: [local1, _], world: [world1, _] } =
            moved(&points, [pose; 2], normal, self.radii.outwards());
        let [gap_lower, gap_upper] = self.gap(outline, corner);
        let foot = (Vector::from(world1) - Vector::from(*normal) * middle([gap_lower, gap_upper])).into();
        let (feature1, feature2) = (label(polyhedron, FeatureId::Vertex(vertex), &position), Feature::default());
        let id = id_of(&feature1, &feature2);
        ManifoldPoint { local1, local2: foot, world1, world2: foot, gap_lower, gap_upper, feature1, feature2, id }
    }
}
