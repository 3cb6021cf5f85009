//! Pairs of points and segments, of which spheres and capsules are made: the nearest points in closed form (Ericson 2005, §5.1.9).
//! The supports of the four ends prove them, whatever they are.

use super::signed_distance::SignedDistance;
#[cfg(doc)]
use crate::answer::PairConfig;
use crate::answer::{DecidedBy, Feature, Outcome, PairAnswer, Query, Radii, Statistics, fill_nothing, label};
use crate::base::math::{Pose, UNIT_ROUNDOFF as U, Vector, clamp};
use crate::base::scalar::{Scalar, constant};
use crate::base::simd::{self, Kernel, Lanes, Portable};
use crate::body::polyhedron::{Polyhedron, Vertex};
use crate::distance::certificate::{Interval, reciprocal_length};
use crate::placed::Pair;
use crate::placed::frame::{Frame, are_acceptable};
use crate::placed::state::FeatureId;
use crate::shape::Placed;

/// Fills normal, points and features of an answer of either kind: no references to its members go through memory (R2).
macro_rules! fill_surfaces {
    ($round:ident, $frame:ident, $nearest:ident, $answer:ident) => {
        $nearest.normal.store_vector(&mut $answer.normal);
        let [out1, out2] = [-$round.radii.each[0], $round.radii.each[1]];
        $round.local($frame, &$nearest, 0, out1).store_vector(&mut $answer.local1);
        $nearest.world($frame, 0, out1).store_vector(&mut $answer.world1);
        $answer.feature1 = $nearest.feature($frame, 0);
        $round.local($frame, &$nearest, 1, out2).store_vector(&mut $answer.local2);
        $nearest.world($frame, 1, out2).store_vector(&mut $answer.world2);
        $answer.feature2 = $nearest.feature($frame, 1);
    };
}

/// Whether both bodies are points or segments.
#[inline(always)]
pub(super) fn are_round(bodies: &[Placed; 2]) -> bool {
    let [body1, body2] = [bodies[0].shape.polyhedron(), bodies[1].shape.polyhedron()];
    body1.dimension.max(body2.dimension) < 2
}

/// A query of two such bodies with balls swept over them.
pub(super) struct Round<'a> {
    /// The bodies.
    pub bodies: &'a [Placed<'a>; 2],
    /// The balls.
    pub radii: &'a Radii,
    /// Beyond what distance nothing more is asked.
    pub tolerance: f64,
}

/// The place of the answer, which stays as it is where nothing is proved.
pub(super) enum AnswerPlace<'a> {
    /// To a query.
    Pair(Query, &'a mut PairAnswer),
    /// For a signed distance.
    Signed(&'a mut SignedDistance),
}

impl Round<'_> {
    /// Whether doubles answer.
    #[inline(always)]
    pub(super) fn answers(&self, place: AnswerPlace) -> bool {
        let polyhedra = [self.bodies[0].shape.polyhedron(), self.bodies[1].shape.polyhedron()];
        let is_simple = polyhedra[0].simple & polyhedra[1].simple;
        let mut rigid = OfRigid { round: self, polyhedra, place };
        if is_simple && let Some(is_answered) = simd::dispatch(&mut rigid) {
            return is_answered;
        }
        self.answers_any(polyhedra, rigid.place)
    }

    /// The same for poses that are not rigid, and bodies whose centres are not their origins.
    #[cold]
    #[inline(never)]
    fn answers_any(&self, polyhedra: [&Polyhedron; 2], place: AnswerPlace) -> bool {
        let poses = self.poses();
        let frame = Frame::<Portable>::new(&Pair { polyhedra, poses });
        // A point has no size that could be out of range: all errors are in proportion to the distance.
        let are_points = frame.size == 0.0 && are_acceptable(poses);
        (frame.in_range || are_points) && self.is_filled(&frame, place)
    }

    fn poses(&self) -> [&Pose; 2] {
        [self.bodies[0].pose, self.bodies[1].pose]
    }

    #[inline(always)]
    fn is_filled<L: Lanes>(&self, frame: &Frame<L>, place: AnswerPlace) -> bool {
        let nearest = NearestOfRound::of(frame);
        let [lower, upper] = self.radii.off([nearest.interval.lower, nearest.interval.upper]);
        // For overlapping bodies a query reports no more than that.
        let is_met = (upper < 0.0) & matches!(place, AnswerPlace::Pair(..));
        if !is_met && !nearest.interval.is_tight(frame.size) {
            return false;
        }
        let is_apart = lower > 0.0;
        let is_settled = (lower > self.tolerance) | (upper <= self.tolerance);
        if !(is_apart & is_settled) & !(upper < 0.0) {
            return false;
        }
        let distance = clamp(nearest.distance - self.radii.each[0] - self.radii.each[1], lower, upper);
        let outcome = match is_apart {
            false => Outcome::Intersecting,
            true if upper > self.tolerance => Outcome::Beyond,
            true => Outcome::Separated,
        };
        match place {
            // The common point of a contact is made of the nearest points of the polyhedra.
            AnswerPlace::Pair(Query::Contact, _) if outcome == Outcome::Intersecting => return false,
            AnswerPlace::Pair(query, answer) => {
                answer.outcome = outcome;
                answer.decided_by = DecidedBy::Marching;
                answer.statistics = Statistics { marching_steps: 1, ..Statistics::default() };
                answer.proof_count = 0;
                (answer.distance, answer.lower, answer.upper) = (distance, lower, upper);
                if query == Query::Intersection || outcome != Outcome::Separated {
                    fill_nothing(answer);
                    match outcome {
                        Outcome::Intersecting => (answer.distance, answer.lower, answer.upper) = (0.0, 0.0, 0.0),
                        Outcome::Beyond => (answer.distance, answer.upper) = (lower, f64::INFINITY),
                        _ => {}
                    }
                    if is_apart {
                        nearest.normal.store_vector(&mut answer.normal);
                    }
                    return true;
                }
                fill_surfaces!(self, frame, nearest, answer);
            }
            AnswerPlace::Signed(answer) => {
                if outcome == Outcome::Beyond {
                    let mut beyond =
                        SignedDistance { outcome, distance: lower, lower, upper: f64::INFINITY, ..Default::default() };
                    nearest.normal.store_vector(&mut beyond.normal);
                    *answer = beyond;
                    return true;
                }
                answer.outcome = outcome;
                (answer.distance, answer.lower, answer.upper) = (distance, lower, upper);
                fill_surfaces!(self, frame, nearest, answer);
            }
        }
        true
    }

    /// A point on a body's surface in its frame, its radius from that of the polyhedron: `out` along the normal.
    #[inline(always)]
    fn local<L: Lanes>(&self, frame: &Frame<L>, nearest: &NearestOfRound<L>, i: usize, out: f64) -> L {
        let body = &frame.bodies[i];
        let point = nearest.points[i].add(L::from_vector(&body.polyhedron.centre));
        body.turn_back(nearest.normal).mul_add(L::splat(out), point)
    }
}

/// The common case: poses that are right up to rounding.
struct OfRigid<'a, 'b> {
    round: &'a Round<'a>,
    polyhedra: [&'a Polyhedron; 2],
    place: AnswerPlace<'b>,
}

impl Kernel for OfRigid<'_, '_> {
    /// Whether doubles answer; `None` for other poses.
    type Output = Option<bool>;

    #[inline(always)]
    fn run<L: Lanes>(&mut self) -> Option<bool> {
        let frame = Frame::<L>::of_rigid(&Pair { polyhedra: self.polyhedra, poses: self.round.poses() });
        let place = match &mut self.place {
            AnswerPlace::Pair(query, answer) => AnswerPlace::Pair(*query, answer),
            AnswerPlace::Signed(answer) => AnswerPlace::Signed(answer),
        };
        // No closure: the compiler may leave one without the vector unit's instructions.
        if frame.in_range { Some(self.round.is_filled(&frame, place)) } else { None }
    }
}

/// Nearest points of two placed points or segments, and what they prove.
pub struct NearestOfRound<L> {
    /// In centred local coordinates.
    points: [L; 2],
    /// Mapped by their bodies' rotations.
    rotated: [L; 2],
    /// From body 2 to body 1, of unit length.
    normal: L,
    /// Between them.
    pub distance: f64,
    /// That holds the distance of the bodies.
    pub interval: Interval,
    features: [FeatureId; 2],
}

/// Square of the sine below which segments are parallel for a cross product: above, it has all but three of its digits.
const PARALLEL: f64 = 1e-6;

impl<L: Lanes> NearestOfRound<L> {
    /// As [`Round::local`], in the world.
    #[inline(always)]
    fn world(&self, frame: &Frame<L>, i: usize, out: f64) -> L {
        self.normal.mul_add(L::splat(out), self.rotated[i].add(frame.bodies[i].translation))
    }

    #[inline(always)]
    fn feature(&self, frame: &Frame<L>, i: usize) -> Feature {
        label(frame.bodies[i].polyhedron, self.features[i], &Vector::zeros())
    }

    /// Any weights s and t of the ends make points of the bodies, and any direction a gap: what rounding makes of both costs width.
    #[inline(always)]
    pub fn of(frame: &Frame<L>) -> NearestOfRound<L> {
        let [body1, body2] = &frame.bodies;
        let [ends1, ends2] = [&body1.polyhedron.vertices, &body2.polyhedron.vertices];
        let (tail1, tail2) = (L::from_vector(&ends1[0].position), L::from_vector(&ends2[0].position));
        let (is_segment1, is_segment2) = (ends1.len() > 1, ends2.len() > 1);
        let nowhere = L::splat(0.0);
        // A point is its own centre: nothing is turned.
        debug_assert!([ends1, ends2].iter().all(|ends| ends.len() > 1 || ends[0].position == Vector::zeros()));
        let rotated1 = if is_segment1 { body1.rotate(&ends1[0].position) } else { nowhere };
        let rotated2 = if is_segment2 { body2.rotate(&ends2[0].position) } else { nowhere };
        let seen1 = rotated1.add(body1.offset);
        let tails = seen1.sub(rotated2);
        // The way to each head in the world, if there is one.
        let way1 = if is_segment1 { body1.rotate(&ends1[1].position).sub(rotated1) } else { nowhere };
        let way2 = if is_segment2 { body2.rotate(&ends2[1].position).sub(rotated2) } else { nowhere };
        let (mut s, mut t, mut difference) = (0.0, 0.0, tails);
        let mut crossing = None;
        // The least height of the ends' differences along the direction.
        let mut others = [tails; 3];
        if is_segment1 & is_segment2 {
            let (square1, square2, both) = (way1.dot(way1), way2.dot(way2), way1.dot(way2));
            let (along1, along2) = (way1.dot(tails), way2.dot(tails));
            let sine = square1 * square2 - both * both;
            let free = if sine > 1e-12 * square1 * square2 { (both * along2 - along1 * square2) / sine } else { 0.0 };
            let (inverse1, inverse2) = (1.0 / square1, 1.0 / square2);
            s = clamp(free, 0.0, 1.0);
            t = clamp((both * s + along2) * inverse2, 0.0, 1.0);
            // Once more, as the first s is not the nearest where t ends, or where the segments are nearly parallel.
            s = clamp((both * t - along1) * inverse1, 0.0, 1.0);
            t = clamp((both * s + along2) * inverse2, 0.0, 1.0);
            difference = way2.negated_mul_add(L::splat(t), way1.mul_add(L::splat(s), tails));
            let is_inside = (s > 0.0) & (s < 1.0) & (t > 0.0) & (t < 1.0);
            // Across both, this direction keeps its digits where the segments nearly meet.
            if is_inside & (sine > PARALLEL * square1 * square2) {
                let across = way1.cross(way2);
                crossing = Some(if across.dot(tails) < 0.0 { across.negate() } else { across });
            }
            let (head1, head2) = (body1.rotate(&ends1[1].position).add(body1.offset), body2.rotate(&ends2[1].position));
            others = [head1.sub(rotated2), seen1.sub(head2), head1.sub(head2)];
        } else if is_segment1 {
            s = clamp(-way1.dot(tails) / way1.dot(way1), 0.0, 1.0);
            difference = way1.mul_add(L::splat(s), tails);
            others = [body1.rotate(&ends1[1].position).add(body1.offset).sub(rotated2); 3];
        } else if is_segment2 {
            t = clamp(way2.dot(tails) / way2.dot(way2), 0.0, 1.0);
            difference = way2.negated_mul_add(L::splat(t), tails);
            others = [seen1.sub(body2.rotate(&ends2[1].position)); 3];
        }
        let direction = crossing.unwrap_or(difference);
        let inverse = reciprocal_length(direction.dot(direction));
        let normal = direction.mul(L::splat(inverse));
        let distance = difference.dot(difference).sqrt();
        let mut least = direction.dot(tails);
        if is_segment1 | is_segment2 {
            for other in others {
                let height = direction.dot(other);
                least = if height < least { height } else { least };
            }
        }
        let interval = interval(distance, least * inverse, frame.size, frame.separation);
        NearestOfRound {
            points: [between(ends1, tail1, s), between(ends2, tail2, t)],
            rotated: [way1.mul_add(L::splat(s), rotated1), way2.mul_add(L::splat(t), rotated2)],
            normal,
            distance,
            interval,
            features: [feature(s, is_segment1), feature(t, is_segment2)],
        }
    }
}

/// From the distance of two points of the bodies and the least difference of ends along a unit direction, both as computed.
#[inline(always)]
fn interval(distance: f64, least: f64, size: f64, separation: f64) -> Interval {
    if size == 0.0 {
        let [lower, upper] = ends_of_points(distance, least, separation);
        // A square that underflows bounds no distance.
        return Interval { lower, upper: if least.is_nan() { f64::NAN } else { upper } };
    }
    let [lower, upper] = ends_of_segments(distance, least, size, separation);
    Interval { lower, upper }
}

/// The ends of an interval, all errors times u. With ρ the sum of the radii and σ [`Frame::separation`], no difference is longer
/// than σ + 1.02ρ, and no segment than 2.03 times its radius. The offset is rounded once, where centres are not origins with
/// a sum that is off by 16u times the M of which σ holds 16u: by σ either way.
///
/// Below: a difference of ends is off by 8.3ρ + 3σ ([`Frame::difference_error`]); its product with the direction by 3 of its
/// length, the direction's length by 1.5, root, quotient and product by one each; the last sum by one: 16.9ρ + 11.5σ. A direction
/// too short is a NaN, and proves nothing.
///
/// Above: rotated ends are off by 5.3 of their radius, and so are points between them, as the difference of tails and the way to a
/// head have the same tail. Sums are off by one of themselves: the tail of body 1 seen from body 2 and the difference of tails by
/// 2σ + 3.1ρ, a way and its multiple by 4.1 radii, the difference with one of both multiples by the distance and 2.1 radii, that
/// with both by the distance: 14.4ρ + 3.2σ. The length is off by 2.5 of itself, the last sum by one.
#[inline(always)]
pub fn ends_of_segments<S: Scalar>(distance: S, least: S, size: S, separation: S) -> [S; 2] {
    let [below_by_size, below_by_separation] = [constant::<S>(17.0), constant(12.0)];
    let [above_by_size, above_by_separation, by_distance] = [constant::<S>(15.0), constant(4.0), constant(6.0)];
    let lower = least - constant::<S>(U) * (below_by_size * size + below_by_separation * separation);
    let above = above_by_size * size + above_by_separation * separation + by_distance * distance;
    [lower, distance + constant::<S>(U) * above]
}

/// The same of points: their difference is the offset, and the direction. Its square is off by 3u and divided by its own root,
/// which leaves half of that; root, quotient, product and the last sum add one each: 6.7σ.
#[inline(always)]
pub fn ends_of_points<S: Scalar>(distance: S, least: S, separation: S) -> [S; 2] {
    let lower = least - constant::<S>(7.0 * U) * separation;
    let above = constant::<S>(2.0) * separation + constant::<S>(4.0) * distance;
    [lower, distance + constant::<S>(U) * above]
}

/// The point of a body by its weight between the ends.
#[inline(always)]
fn between<L: Lanes>(ends: &[Vertex], tail: L, share: f64) -> L {
    match ends {
        [first, head] => L::from_vector(&(head.position - first.position)).mul_add(L::splat(share), tail),
        _ => tail,
    }
}

/// The feature on which a weight between the ends of a body lies.
#[inline(always)]
fn feature(share: f64, is_segment: bool) -> FeatureId {
    match share {
        1.0 if is_segment => FeatureId::Vertex(1),
        share if is_segment & (share > 0.0) => FeatureId::Edge(0),
        _ => FeatureId::Vertex(0),
    }
}
