//! The independent check of a depth: from above by the support along the normal, over all vertices; from below by a closed polytope
//! of triangles, each at least so far from the origin, that surrounds it.
//!
//! The source of the polytope is not trusted. Its edges show that it is closed, how far a triangle is by double-double arithmetic
//! or integers, and that it surrounds the origin by a ray that crosses it: not by the orientation of all triangles, as in the
//! search.

use super::apart::{check_on_features, check_points, verify_disjoint};
use super::bounds::Bounds;
use super::checks::{allowed, between_origins, check_normal, check_unit, in_default, proof_of, too_large, unverified};
use super::facets;
use super::numbers::{are_points_said, check_numbers};
use crate::answer::{Outcome, PairAnswer, Radii, sum_above, sum_below};
use crate::base::double_double::{narrow, wide_cross, wide_dot, widen};
use crate::base::error::{Error, Result};
use crate::base::math::{UNIT_ROUNDOFF as U, Vector, clamp, length};
use crate::base::memory::listed;
use crate::base::scalar::determinant;
use crate::depth::{DepthAnswer, DepthCache, ProofFrom, proof};
use crate::placed::Pair;
use crate::placed::exact::{self, Differences, Position, SupportScope, VertexPair};
use crate::shape::Placed;
use std::cmp::Ordering;

/// Re-checks an answer of [`crate::pair::depth`] for the same shapes and poses; `cache` is that of the query, which holds the
/// proof, or any other.
///
/// Verdict and interval are proved for the exact objects R·v + T, without tolerance:
///
/// | outcome | what is proved, d the depth |
/// |---|---|
/// | [`Outcome::Intersecting`] | the objects have a common point; `lower` ≤ d ≤ `upper`; `upper` is 0 just if d is |
/// | [`Outcome::Separated`] | they have none; all of the interval is 0 |
/// | [`Outcome::Undecided`] | d ≤ `upper`, of curved objects; `lower` is 0 |
///
/// `lower` ≤ `depth` ≤ `upper` holds. The other results are rounded, so they hold up to the allowance of [`super::verify`]:
/// points and features as there, and world2 − world1 is `depth` · `normal` up to the allowance and `upper` − `lower`.
///
/// It takes time in proportion to the vertices and to the triangles of the cache. If the cache holds no proof, it searches one.
/// If that fails for small bodies it looks at all facets of the Minkowski difference, which takes time in proportion to triangles
/// times vertices; integers decide the cases that rounding hides there. For larger bodies 10⁹ times as long as they are deep, no
/// proof may be found. The error then reports that the depth is not proved; the answer may hold.
///
/// # Errors
/// As of [`super::verify`]; [`Error::Argument`] also for an `upper` of infinity, a depth beyond the largest double.
pub fn verify_depth(bodies: [Placed; 2], cache: &DepthCache, answer: &DepthAnswer) -> Result<()> {
    let pair = &Pair::of(&bodies);
    let radii = Radii::of(&bodies).unwrap_or(Radii::NONE);
    in_default(|| {
        pair.poses.iter().try_for_each(|pose| pose.check())?;
        if answer.outcome != Outcome::None {
            check_numbers(&answer.into())?;
        }
        match answer.outcome {
            Outcome::Intersecting => check_overlapping(pair, cache, &radii, answer),
            Outcome::Separated => check_separated(pair, &radii, answer),
            Outcome::Undecided => check_hidden(pair, &radii, answer),
            _ => Err(Error::Argument("the answer holds no depth".into())),
        }
    })
}

fn check_separated(pair: &Pair, radii: &Radii, answer: &DepthAnswer) -> Result<()> {
    let polyhedra = pair.polyhedra;
    if (answer.lower, answer.depth, answer.upper) != (0.0, 0.0, 0.0) {
        return Err(unverified("a depth of objects that are said to be separated".into()));
    }
    if are_points_said(&answer.into()) {
        return Err(unverified("points or features of objects that are said to be separated".into()));
    }
    let normal = Vector::from(answer.normal);
    check_unit(&normal)?;
    let bounds = Bounds::new(pair);
    // For bodies without radii, more than 0 is proved; for others, more than their sum.
    let least = if radii.upper > 0.0 { radii.upper.next_up() } else { 0.0 };
    if bounds.is_some_and(|bounds| bounds.prove_lower(&bounds.gap(&normal), &normal, least)) {
        return Ok(());
    }
    let truth = exact::distance(pair, &[]);
    if truth.compare_sum(&radii.most()).is_le() {
        return Err(unverified("the objects have a common point".into()));
    }
    let between = between_origins(pair);
    let allowed = allowed(polyhedra, &between, radii.each).ok_or_else(too_large)?;
    check_normal(pair, &normal, &between, radii.lower - allowed)
}

/// Curved bodies whose polyhedra are apart, and may themselves be.
fn check_hidden(pair: &Pair, radii: &Radii, answer: &DepthAnswer) -> Result<()> {
    let &DepthAnswer { outcome, lower, depth, upper, local1, local2, world1, world2, normal, .. } = answer;
    let &DepthAnswer { feature1, feature2, .. } = answer;
    check_interval(answer)?;
    if radii.deviation == 0.0 || lower != 0.0 {
        return Err(unverified("the depth of objects that are said to be undecided".into()));
    }
    let points = PairAnswer { local1, local2, world1, world2, normal, feature1, feature2, ..PairAnswer::UNSAID };
    // Their distance is at most what the deviations are.
    let signed = PairAnswer { outcome, lower: -upper, distance: -depth, upper: radii.deviation, ..points };
    let allowed = verify_disjoint(pair, radii, &signed)?;
    check_points(pair, radii, allowed, &signed)
}

fn check_interval(answer: &DepthAnswer) -> Result<()> {
    let DepthAnswer { lower, depth, upper, .. } = *answer;
    if upper == f64::INFINITY {
        return Err(too_large());
    }
    if 0.0 <= lower && lower <= depth && depth <= upper {
        return Ok(());
    }
    Err(unverified(format!("not 0 ≤ lower ≤ depth ≤ upper: {lower:e}, {depth:e}, {upper:e}")))
}

fn check_overlapping(pair: &Pair, cache: &DepthCache, radii: &Radii, answer: &DepthAnswer) -> Result<()> {
    let &DepthAnswer { outcome, lower, depth, upper, local1, local2, world1, world2, normal, .. } = answer;
    let &DepthAnswer { feature1, feature2, .. } = answer;
    check_interval(answer)?;
    let normal = Vector::from(normal);
    let (position, allowed) = prove_depth(pair, cache, radii, &normal, [lower, upper])?;
    let signed = PairAnswer {
        outcome,
        lower: -upper,
        distance: -depth,
        upper: -lower,
        local1,
        local2,
        world1,
        world2,
        normal: normal.into(),
        feature1,
        feature2,
        ..PairAnswer::UNSAID
    };
    if position == Polyhedra::Apart {
        return check_points(pair, radii, allowed, &signed);
    }
    let apart = check_on_features(pair, radii, allowed, &signed)?;
    let off = length(&(apart + normal * (depth - radii.upper)));
    if off <= allowed + (upper - lower) {
        return Ok(());
    }
    Err(unverified(format!("the witness points are {off:e} off the translation by {depth:e} along the normal")))
}

/// The position of the polyhedra of objects with a common point.
#[derive(PartialEq)]
pub(super) enum Polyhedra {
    /// They have a common point, too.
    Meeting,
    /// Only the balls that are swept over them meet.
    Apart,
}

/// Proves that the depth of objects is in an interval, and checks the normal; returns where the polyhedra are, and the rounding
/// allowance for a length.
pub(super) fn prove_depth(
    pair: &Pair,
    cache: &DepthCache,
    radii: &Radii,
    normal: &Vector,
    [lower, upper]: [f64; 2],
) -> Result<(Polyhedra, f64)> {
    let polyhedra = pair.polyhedra;
    let is_round = radii.upper > 0.0;
    if is_round {
        let truth = exact::distance(pair, &[]);
        if !truth.is_zero() {
            check_swept_position(&truth, radii, upper)?;
            let (outcome, normal) = (Outcome::Intersecting, (*normal).into());
            let signed =
                PairAnswer { outcome, lower: -upper, distance: -upper, upper: -lower, normal, ..PairAnswer::UNSAID };
            return Ok((Polyhedra::Apart, verify_disjoint(pair, radii, &signed)?));
        }
    }
    check_unit(normal)?;
    let facts = Facts::new(pair);
    let between = between_origins(pair);
    let allowed = allowed(polyhedra, &between, radii.each).ok_or_else(too_large)?;
    // The remainder for the polyhedra, rounded inwards.
    let (least, most) = (sum_above(lower, -radii.lower), sum_below(upper, -radii.upper));
    if !(most >= 0.0) {
        return Err(unverified(format!("the radii alone make the depth more than {upper:e}")));
    }
    check_upper(&facts, normal, most, allowed)?;
    if least > 0.0 {
        prove_lower(&facts, cache, least)?;
    }
    // Round objects whose polyhedra have a common point overlap in any case.
    if most == 0.0 || (least <= 0.0 && !is_round) {
        check_position(pair, most)?;
    }
    Ok((Polyhedra::Meeting, allowed))
}

/// Bodies whose polyhedra are apart have a common point, and overlap if an overlap is reported.
fn check_swept_position(truth: &exact::ExactDistance, radii: &Radii, upper: f64) -> Result<()> {
    match (truth.compare_sum(&radii.each), upper > 0.0) {
        (Ordering::Greater, _) => Err(unverified("the objects have no common point".into())),
        (Ordering::Equal, true) if radii.deviation == 0.0 => {
            Err(unverified("an overlap of objects that only touch".into()))
        }
        (Ordering::Less, false) => Err(unverified("no overlap of objects that overlap".into())),
        (Ordering::Equal, _) | (Ordering::Less, true) => Ok(()),
    }
}

/// If the ends are 0, the position must be proved.
fn check_position(pair: &Pair, upper: f64) -> Result<()> {
    match exact::locate(pair, &[], SupportScope::OfAll) {
        Position::Separated(_) => Err(unverified("the objects have no common point".into())),
        Position::Touching { .. } if upper > 0.0 => Err(unverified("an overlap of objects that only touch".into())),
        Position::Overlapping(_) if upper == 0.0 => Err(unverified("no overlap of objects that overlap".into())),
        Position::Touching { .. } | Position::Overlapping(_) => Ok(()),
    }
}

/// Whether four differences of vertices that prove an intersection hold a ball around the origin in their hull: objects are as deep
/// in each other as its radius, more than 0.
pub(crate) fn holds_ball(bodies: [Placed; 2], answer: &PairAnswer, radius: f64) -> bool {
    let pair = &Pair::of(&bodies);
    let pairs = proof_of(pair.polyhedra, answer).unwrap_or_default();
    let &[p, q, r, s] = pairs.as_slice() else { return false };
    let tetrahedron = [[p, q, r], [p, s, q], [q, s, r], [p, r, s]];
    encloses_ball(&Facts::new(pair), &tetrahedron, radius).is_ok()
}

/// The objects overlap by at most `upper` along the normal; of 0 that holds as far as the normal is rounded. Objects with a common
/// point overlap along every direction, by 0 at least.
fn check_upper(facts: &Facts, normal: &Vector, upper: f64, allowed: f64) -> Result<()> {
    let most = if upper > 0.0 { upper } else { allowed };
    let apart = || unverified("along the normal the objects are apart".into());
    if let Some(bounds) = &facts.bounds {
        let gap = bounds.gap(normal);
        if bounds.is_open(&gap) {
            return Err(apart());
        }
        if bounds.prove_overlap(&gap, normal, most) {
            // An overlap that double-double arithmetic cannot distinguish from a gap is left to the proof of the lower end.
            return Ok(());
        }
    }
    let overlap = facts.exact.overlap_along(normal).ok_or_else(apart)?;
    if overlap.compare(most).is_le() {
        return Ok(());
    }
    let (least, _) = overlap.bounds();
    Err(unverified(format!("along the normal the objects overlap by {least:e}, not {upper:e}")))
}

type PairTriangle = [VertexPair; 3];

/// Proves a depth of at least `lower` by the polytope of the cache, or by one that is searched for, as a query does or
/// until it proves it; of small bodies else by all facets.
fn prove_lower(facts: &Facts, cache: &DepthCache, lower: f64) -> Result<()> {
    let mut why = Ok(());
    for from in [ProofFrom::Cache(cache), ProofFrom::Search(0.0), ProofFrom::Search(lower)] {
        let polytope = proof(&facts.pair, from)?;
        why = encloses_ball(facts, &polytope, lower);
        if why.is_ok() {
            return Ok(());
        }
    }
    let by_facets = |bounds| facets::prove_lower(facts.pair.polyhedra, bounds, &facts.exact, lower);
    if facts.bounds.as_ref().is_some_and(by_facets) || facets::prove_point(facts.pair.polyhedra, &facts.exact, lower) {
        return Ok(());
    }
    why.map_err(|why| unverified(format!("a depth of at least {lower:e} is not proved: {why}")))
}

/// Whether a polytope encloses the ball of a radius around the origin, or why it may not.
fn encloses_ball(facts: &Facts, polytope: &[PairTriangle], radius: f64) -> std::result::Result<(), &'static str> {
    if polytope.is_empty() {
        return Err("there is no polytope around the origin");
    }
    if !is_closed(polytope) {
        return Err("the polytope is not closed");
    }
    if !polytope.iter().all(|triangle| facts.is_beyond(triangle, radius)) {
        return Err("a triangle of the polytope is nearer");
    }
    if !surrounds_origin(facts, polytope) {
        return Err("the polytope does not surround the origin");
    }
    Ok(())
}

/// Every edge is walked as often one way as the other.
fn is_closed(polytope: &[PairTriangle]) -> bool {
    let mut edges = listed(polytope.iter().flat_map(|triangle| {
        [0, 1, 2].map(|k| {
            let (tail, head) = (triangle[k], triangle[(k + 1) % 3]);
            match tail.cmp(&head) {
                Ordering::Less => (tail, head, 1),
                Ordering::Greater => (head, tail, -1),
                Ordering::Equal => (tail, head, 0),
            }
        })
    }));
    edges.sort_unstable();
    edges.chunk_by(|a, b| (a.0, a.1) == (b.0, b.1)).all(|same| same.iter().map(|edge| edge.2).sum::<i32>() == 0)
}

/// Rays tried before a polytope is assumed not to surround the origin: one that meets an edge proves nothing.
const RAYS: usize = 16;

/// Whether the polytope's degree about the origin is not 0: the sum of the signs with which a ray crosses it. No triangle holds the
/// origin.
fn surrounds_origin(facts: &Facts, polytope: &[PairTriangle]) -> bool {
    let crossing_of = |ray: &Vector| {
        let mut degree = 0;
        for triangle in polytope {
            degree += facts.crossing(triangle, ray)?;
        }
        Some(degree)
    };
    let rays = (0..RAYS).map(|attempt| {
        let triangle = &polytope[attempt * 7919 % polytope.len()];
        let [p, q, r] = triangle.map(|pair| facts.position(pair));
        // Beside the middle, so that no symmetry leads it through an edge.
        p * 0.31 + q * 0.3301 + r * 0.3599
    });
    rays.filter_map(|ray| crossing_of(&ray)).next().is_some_and(|degree| degree != 0)
}

/// See [`Facts::clear_sign`].
pub const CLEAR: f64 = 16.0 * U;

/// Provable facts about vertex differences.
struct Facts<'a> {
    pair: Pair<'a>,
    exact: Differences<'a>,
    bounds: Option<Bounds<'a>>,
}

impl<'a> Facts<'a> {
    fn new(pair: &Pair<'a>) -> Facts<'a> {
        Facts { pair: *pair, exact: Differences::new(pair), bounds: Bounds::new(pair) }
    }

    /// A difference in units of the pair, right to [`Facts::position_error`] and u of itself.
    fn position(&self, pair: VertexPair) -> Vector {
        self.bounds.as_ref().map_or_else(Vector::zeros, |bounds| narrow(&bounds.difference(pair)))
    }

    /// By how much a position may be off beside its rounding to doubles: as each of three coordinates, times √3 and rounded up.
    fn position_error(&self) -> f64 {
        self.bounds.as_ref().map_or(f64::INFINITY, |bounds| 2.0 * bounds.error())
    }

    /// The sign of a determinant of positions and rays, where it is clear.
    ///
    /// If no column is shorter than its error over u, each is right to 2u of itself: u by that, and u by its rounding. The
    /// determinant then changes by 6.1u of the product of the lengths. Products and sums err by 5u of the permanent of the
    /// magnitudes, which is at most √2 times that product. Together that is less than 14u of it. The lengths are off by a few u.
    /// Underflow, of less than 2⁻¹⁰⁰⁰, is nothing beside a product of three lengths over 2⁻¹²⁰ each.
    fn clear_sign(&self, columns: [&Vector; 3]) -> Option<Ordering> {
        let [a, b, c] = columns;
        let [length_a, length_b, length_c] = columns.map(length);
        let shortest = length_a.min(length_b).min(length_c);
        let value = determinant([(*a).into(), (*b).into(), (*c).into()]);
        let is_clear = shortest * U > self.position_error() && value.abs() > CLEAR * length_a * length_b * length_c;
        is_clear.then(|| value.total_cmp(&0.0))
    }

    /// Whether a triangle is at least so far from the origin.
    fn is_beyond(&self, triangle: &PairTriangle, radius: f64) -> bool {
        if self.bounds.as_ref().is_some_and(|bounds| plane_is_beyond(bounds, triangle, radius)) {
            return true;
        }
        self.exact.distance_of_hull(triangle).is_some_and(|distance| distance.compare(radius).is_ge())
    }

    /// How a ray from the origin crosses a triangle: 1 from behind, −1 from before, 0 not at all; `None` if it meets its
    /// boundary, or the plane of it passes through the origin.
    fn crossing(&self, triangle: &PairTriangle, ray: &Vector) -> Option<i32> {
        let corners = triangle.map(|pair| self.position(pair));
        let [a, b, c] = &corners;
        let side = |p: &Vector, q: &Vector| self.clear_sign([ray, p, q]);
        let sides = [(0, side(a, b)), (1, side(b, c)), (2, side(c, a))].map(|(k, clear)| {
            clear.unwrap_or_else(|| self.exact.side_of_ray(ray, [triangle[k], triangle[(k + 1) % 3]]))
        });
        if sides.contains(&Ordering::Less) && sides.contains(&Ordering::Greater) {
            return Some(0);
        }
        if sides.contains(&Ordering::Equal) {
            return None;
        }
        // All on one side: the line of the ray crosses the triangle, the ray itself where its orientation is the same.
        let orientation = self.clear_sign([a, b, c]).unwrap_or_else(|| self.exact.orientation(*triangle));
        if orientation == Ordering::Equal {
            return None;
        }
        Some(if orientation == sides[0] { orientation as i32 } else { 0 })
    }
}

/// Whether the triangle's plane, or another through its nearest point, proves it to be so far from the origin: for any m that is
/// at least min m·v/|m|.
fn plane_is_beyond(bounds: &Bounds, triangle: &PairTriangle, radius: f64) -> bool {
    let corners = triangle.map(|pair| bounds.difference(pair));
    let edge = |k: usize| [0, 1, 2].map(|axis| corners[k][axis] - corners[0][axis]);
    let normal = narrow(&wide_cross(&edge(1), &edge(2)));
    let rounded = [0, 1, 2].map(|k| narrow(&corners[k]));
    let candidates = [normal, nearest_on_side(&rounded)];
    candidates.iter().any(|normal| {
        let scale = normal.amax();
        if !(scale > 0.0 && scale < f64::INFINITY) {
            return false;
        }
        let unit = normal / scale;
        // Square root and its argument are right to 3u.
        let needed = bounds.in_units(radius) * unit.norm() * (1.0 + 8.0 * U);
        corners.iter().all(|corner| bounds.is_more(wide_dot(&widen(&unit), corner), needed))
    })
}

/// The point of a triangle's sides nearest to the origin, about.
fn nearest_on_side(corners: &[Vector; 3]) -> Vector {
    let nearest = |k: usize| {
        let (from, along) = (corners[k], corners[(k + 1) % 3] - corners[k]);
        from + along * clamp(-from.dot(&along) / along.norm_squared(), 0.0, 1.0)
    };
    let nearer = |a: Vector, b: Vector| if b.norm_squared() < a.norm_squared() { b } else { a };
    nearer(nearer(nearest(0), nearest(1)), nearest(2))
}
