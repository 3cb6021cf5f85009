//! One compound asked about a ray or a point, nearest boxes first.

use super::PlacedCompound;
use super::answer::{CompoundPointAnswer, CompoundRayAnswer};
use super::between::check_pieces;
use super::fit::Fitted;
use super::placed::PlacedPieces;
use super::tree::DEEPEST;
use crate::base::error::Result;
use crate::base::math::{Pose, UNIT_ROUNDOFF as U, Vector};
use crate::base::simd::environment::with_default;
use crate::point::{PointLocation, check_finite};
use crate::ray::{Ray, RayAnswer, RayOutcome, entry_of_box};

/// Where a ray enters a compound, and in which piece: the first entry over all pieces. Guaranteed as
/// [`crate::ray::cast_ray`] is.
///
/// # Errors
/// As of [`crate::ray::cast_ray`].
pub fn cast_ray(body: PlacedCompound, ray: &Ray) -> Result<CompoundRayAnswer> {
    with_default(|| {
        let body = body.placed_pieces();
        ray.check()?;
        let frame = CompoundPoint::new(&body, &ray.origin())?;
        let direction = body.pose.rotate_back(&ray.direction());
        /// Directions of such lengths neither overflow nor lose digits when they are turned; others rule no box out.
        const PLAIN: std::ops::RangeInclusive<f64> = 1e-290..=1e290;
        let is_plain = PLAIN.contains(&ray.direction().amax());
        let slabs = Slabs { frame: &frame, direction: is_plain.then_some(direction), t_max: ray.t_max };
        let mut nearest = NearestOfPieces::new(&body);
        let miss = RayAnswer { outcome: RayOutcome::Miss, ..RayAnswer::default() };
        let mut first = CompoundRayAnswer { answer: miss, piece: body.count() as u32 };
        let mut entry = f64::INFINITY;
        while let Some(piece) = nearest.next(|fitted| slabs.entry(fitted)) {
            let mut own = Pose::IDENTITY;
            let answer = crate::ray::cast_ray(body.piece(piece, &mut own), ray)?;
            if answer.outcome == RayOutcome::Inside {
                return Ok(CompoundRayAnswer { answer, piece });
            }
            if answer.outcome == RayOutcome::Hit {
                entry = entry.min(answer.entry[0]);
                if first.answer.outcome != RayOutcome::Hit || answer.entry[1] < first.answer.entry[1] {
                    first = CompoundRayAnswer { answer, piece };
                    nearest.enough = answer.entry[1];
                }
            }
        }
        if first.answer.outcome == RayOutcome::Hit {
            first.answer.entry[0] = entry;
        }
        Ok(first)
    })
}

/// The same, the entry as neighbouring doubles: of all pieces that may be the first, in integers.
///
/// # Errors
/// As of [`cast_ray`].
pub(crate) fn cast_ray_in_integers(body: PlacedCompound, ray: &Ray) -> Result<CompoundRayAnswer> {
    with_default(|| {
        let mut first = cast_ray(body, ray)?;
        if first.answer.outcome == RayOutcome::Miss {
            return Ok(first);
        }
        let (body, until) = (body.placed_pieces(), first.answer.entry[1]);
        let mut is_known = false;
        for piece in 0..body.count() as u32 {
            let mut own = Pose::IDENTITY;
            let placed = body.piece(piece, &mut own);
            let near = crate::ray::cast_ray(placed, &Ray { t_max: until.min(ray.t_max), ..*ray })?;
            if near.outcome == RayOutcome::Miss {
                continue;
            }
            let answer = crate::ray::cast_ray_in_integers(placed, ray)?;
            let is_earlier = answer.entry.map(|t| t + 0.0) < first.answer.entry.map(|t| t + 0.0);
            if answer.outcome != RayOutcome::Miss && (!is_known || is_earlier) {
                (first, is_known) = (CompoundRayAnswer { answer, piece }, true);
            }
        }
        Ok(first)
    })
}

/// Where a point of the world is relative to a compound. Guaranteed as [`crate::point::locate_point`] is; it allocates.
///
/// # Errors
/// As of [`crate::point::locate_point`].
pub fn locate_point(body: PlacedCompound, point: [f64; 3]) -> Result<CompoundPointAnswer> {
    with_default(|| {
        let body = body.placed_pieces();
        check_finite("point", &point)?;
        let frame = CompoundPoint::new(&body, &point.into())?;
        let mut nearest = NearestOfPieces::new(&body);
        let (mut least, mut lower) = (CompoundPointAnswer::default(), f64::INFINITY);
        while let Some(piece) = nearest.next(|fitted| frame.distance(fitted)) {
            let mut own = Pose::IDENTITY;
            let answer = crate::point::locate_point(body.piece(piece, &mut own), point)?;
            lower = lower.min(answer.lower);
            let known = least.answer;
            let is_less = (answer.location as i32, answer.upper) < (known.location as i32, known.upper);
            if known.location == PointLocation::None || is_less {
                least = CompoundPointAnswer { answer, piece };
                nearest.enough = answer.upper;
            }
        }
        least.answer.lower = lower;
        Ok(least)
    })
}

/// The walk down one tree.
struct NearestOfPieces<'a> {
    body: &'a PlacedPieces<'a>,
    /// Nodes with a greater bound are passed by.
    enough: f64,
    waiting: [(f64, u32); DEEPEST + 2],
    count: usize,
}

impl<'a> NearestOfPieces<'a> {
    fn new(body: &'a PlacedPieces<'a>) -> NearestOfPieces<'a> {
        let waiting = [(f64::NEG_INFINITY, 0); DEEPEST + 2];
        NearestOfPieces { body, enough: f64::INFINITY, waiting, count: 1 }
    }

    /// The next piece, where a bound says nothing against it; infinite bounds rule out.
    fn next(&mut self, bound: impl Fn(&Fitted) -> f64) -> Option<u32> {
        let nodes = self.body.tree.nodes;
        while self.count > 0 {
            self.count -= 1;
            let (least, number) = self.waiting[self.count];
            if least > self.enough || least == f64::INFINITY {
                continue;
            }
            let node = &nodes[number as usize];
            if let Some(piece) = node.piece() {
                return Some(piece);
            }
            let children = node.children().map(|child| (bound(&nodes[child as usize].fitted), child));
            let first = usize::from(children[1].0 < children[0].0);
            for child in [children[1 - first], children[first]] {
                self.waiting[self.count] = child;
                self.count += 1;
            }
        }
        None
    }
}

/// A point of the world in the frame of a compound, by Rᵀ.
///
/// A point x of the compound is at R·x + T, so Rᵀ(p − T) − x is Rᵀ(p − (R·x + T)) + (RᵀR − I)·x. The slack holds the last, at most
/// 3d·L for the largest entry d of |RᵀR − I|, half of it again for swept balls, and what rounding makes of all: some 24u of
/// |p − T| + L, and of pieces that are placed what [`between`](super::between) says.
struct CompoundPoint {
    point: Vector,
    slack: f64,
    shrink: f64,
    grow: f64,
}

impl CompoundPoint {
    fn new(body: &PlacedPieces, world: &Vector) -> Result<CompoundPoint> {
        let defect = body.pose.checked_defect()? + 8.0 * U;
        let reach = body.reach;
        let way = world - body.pose.translation();
        let size = way.lp_norm(1) + reach.lever;
        let mut slack = (64.0 * U + 16.0 * defect) * size + f64::MIN_POSITIVE;
        if reach.placing > 0.0 {
            slack += 64.0 * U * reach.placing + 8.0 * U * body.pose.translation().lp_norm(1);
        }
        /// Squares of what is below are finite.
        const LARGEST: f64 = 1e150;
        // False for a NaN.
        let is_in_range = slack < LARGEST && size < LARGEST;
        check_pieces(body, defect, is_in_range)?;
        if !is_in_range {
            slack = f64::INFINITY;
        }
        let (shrink, grow) = (1.0 - 2.0 * defect - 16.0 * U, 1.0 + 4.0 * defect + 16.0 * U);
        Ok(CompoundPoint { point: body.pose.rotate_back(&way), slack, shrink, grow })
    }

    /// The signed distance from all that is in a box is at least this.
    fn distance(&self, fitted: &Fitted) -> f64 {
        let gaps = [0, 1, 2].map(|k| (self.point[k] - fitted.centre[k]).abs() - fitted.half[k] - self.slack);
        let most = gaps.into_iter().fold(f64::NEG_INFINITY, f64::max);
        if !(most > 0.0) {
            return most * self.grow;
        }
        let square: f64 = gaps.into_iter().map(|gap| gap.max(0.0)).map(|gap| gap * gap).sum();
        /// Squares above have lost nothing by underflow that counts.
        const LEAST_SQUARE: f64 = 1e-290;
        (if square > LEAST_SQUARE { square.sqrt() } else { most }) * self.shrink
    }
}

/// The ray in the frame of a compound: its origin is the frame's point.
struct Slabs<'a> {
    frame: &'a CompoundPoint,
    direction: Option<Vector>,
    t_max: f64,
}

impl Slabs<'_> {
    /// No point of the ray before this is in a box; infinite where none is.
    ///
    /// For t where the ray is in the compound |t·d| is at most 1.02·(|p − T| + L), of which 4u are the error of Rᵀ·d: the slack
    /// holds it.
    fn entry(&self, fitted: &Fitted) -> f64 {
        let Some(direction) = &self.direction else { return 0.0 };
        let ways = |k: usize| {
            let (way, reach) = (fitted.centre[k] - self.frame.point[k], fitted.half[k] + self.frame.slack);
            [way - reach, way + reach]
        };
        entry_of_box(ways, direction, self.t_max)
    }
}
