//! Where a ray first meets a ground: the first of its triangles, each answered by [`crate::ray`].

use super::PlacedGround;
use super::reach::ROUNDING;
use super::tree::{Bounds, Visit};
use crate::base::error::{Error, Result};
use crate::base::math::{UNIT_ROUNDOFF as U, Vector};
use crate::base::simd::environment::with_default;
use crate::ray::{Ray, RayAnswer, RayOutcome, cast_ray};
use crate::shape::TriangleShape;

/// The answer of a ray cast at a ground.
#[derive(Debug, Clone, Copy, PartialEq)]
#[repr(C)]
pub struct GroundRayAnswer {
    /// That of the triangle. The normal is that of its plane, against the ray, and the feature is in the ground's numbering: a face
    /// is a triangle.
    pub answer: RayAnswer,
    /// The triangle that is hit first; the number of triangles if none is.
    pub triangle: u32,
}

impl PlacedGround<'_> {
    /// Where a ray first meets the surface, from either side. Guaranteed as [`cast_ray`] is.
    ///
    /// # Errors
    /// As of [`cast_ray`]; [`Error::Memory`]: about 4 kB are requested.
    pub fn cast_ray(&self, ray: &Ray) -> Result<GroundRayAnswer> {
        with_default(|| {
            ray.check()?;
            self.pose.check()?;
            let slabs = Slabs::new(self, ray)?;
            let start = Bounds { lower: slabs.point, upper: slabs.point };
            let miss = RayAnswer { outcome: RayOutcome::Miss, ..RayAnswer::default() };
            let found = GroundRayAnswer { answer: miss, triangle: self.ground.triangle_count() as u32 };
            let scratch = self.ground.triangle_shape().copy()?;
            let mut first =
                First { ground: *self, ray, slabs, scratch, found, entry: f64::INFINITY, enough: f64::INFINITY };
            self.ground.tree().walk(&start, &mut first)?;
            if first.found.answer.outcome == RayOutcome::Hit {
                first.found.answer.entry[0] = first.entry;
            }
            Ok(first.found)
        })
    }
}

/// The first hit of the triangles that a walk has reached.
struct First<'a> {
    ground: PlacedGround<'a>,
    ray: &'a Ray,
    slabs: Slabs,
    scratch: TriangleShape,
    found: GroundRayAnswer,
    /// No triangle of those is hit before.
    entry: f64,
    /// Boxes that the ray enters later are passed by.
    enough: f64,
}

impl Visit for First<'_> {
    fn goes_to(&mut self, bounds: &Bounds, _: f64) -> bool {
        let entry = self.slabs.entry(bounds);
        entry <= self.enough && entry < f64::INFINITY
    }

    fn triangle(&mut self, triangle: u32) -> Result<bool> {
        let own = self.ground.ground.triangle(triangle);
        if !self.goes_to(&Bounds::of(&own.corners), 0.0) {
            return Ok(true);
        }
        let answer = cast_ray(self.scratch.of(&own).at(self.ground.pose), self.ray)?;
        match answer.outcome {
            RayOutcome::Inside => {
                self.found = GroundRayAnswer { answer, triangle };
                return Ok(false);
            }
            RayOutcome::Hit => {
                self.entry = self.entry.min(answer.entry[0]);
                let known = &self.found.answer;
                if known.outcome != RayOutcome::Hit || answer.entry[1] < known.entry[1] {
                    self.enough = answer.entry[1];
                    self.found = GroundRayAnswer { answer, triangle };
                }
            }
            // Triangles have no deviation, so no ray is undecided.
            RayOutcome::Miss | RayOutcome::None | RayOutcome::Undecided => {}
        }
        Ok(true)
    }
}

/// The ray in the frame of a ground.
struct Slabs {
    point: Vector,
    /// None of a direction so long or short that turning it might overflow or lose digits: no box is ruled out then.
    direction: Option<Vector>,
    t_max: f64,
    slack: f64,
}

impl Slabs {
    /// Products with R⁻¹ are off by [`ROUNDING`] of the lengths that go in. Where the ray is in the box of all triangles, t·d is no
    /// longer than the way there and the box: the slack holds the error of both. Half of `ROUNDING` would do.
    fn new(ground: &PlacedGround, ray: &Ray) -> Result<Slabs> {
        const PLAIN: std::ops::RangeInclusive<f64> = 1e-290..=1e290;
        let Some(inverse) = ground.pose.rotation().try_inverse() else {
            return Err(Error::Bug("a rotation that was accepted has no inverse".into()));
        };
        let (origin, translation) = (ray.origin(), ground.pose.translation());
        let Bounds { lower, upper } = ground.ground.tree().bounds();
        let size = origin.lp_norm(1) + translation.lp_norm(1) + lower.lp_norm(1) + upper.lp_norm(1);
        let slack = 8.0 * ROUNDING * size + f64::MIN_POSITIVE;
        let is_plain = PLAIN.contains(&ray.direction().amax()) && slack.is_finite();
        let direction = is_plain.then(|| inverse * ray.direction());
        Ok(Slabs { point: inverse * (origin - translation), direction, t_max: ray.t_max, slack })
    }

    /// No point of the ray before this is in a box; infinite where none is. The quotients are right to 4u.
    fn entry(&self, bounds: &Bounds) -> f64 {
        let Some(direction) = self.direction else { return 0.0 };
        let (mut entry, mut exit) = (0.0, self.t_max);
        for k in 0..3 {
            let ways = [bounds.lower[k] - self.slack - self.point[k], bounds.upper[k] + self.slack - self.point[k]];
            let along = direction[k];
            if along == 0.0 {
                if ways[0] > 0.0 || ways[1] < 0.0 {
                    return f64::INFINITY;
                }
                continue;
            }
            let [one, other] = ways.map(|way| way / along);
            let (first, last) = if along > 0.0 { (one, other) } else { (other, one) };
            // Away from each other, whichever their signs; comparisons are false for a NaN.
            let (first, last) = ((first - 8.0 * U * first.abs()).min(f64::MAX), last + 8.0 * U * last.abs());
            if first > entry {
                entry = first;
            }
            if last < exit {
                exit = last;
            }
        }
        if entry > exit { f64::INFINITY } else { entry }
    }
}
