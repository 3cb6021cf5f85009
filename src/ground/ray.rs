//! Where a ray first meets a ground: the first of its triangles. Those that rounding leaves open are answered by [`crate::ray`].

use super::PlacedGround;
use super::reach::ROUNDING;
use super::tree::{NodeBounds, Visit};
use crate::base::error::{Error, Result};
use crate::base::math::{UNIT_ROUNDOFF as U, Vector};
use crate::base::simd::environment::with_default;
use crate::pair::{Feature, FeatureKind};
use crate::ray::{Ray, RayAnswer, RayOutcome, cast_ray, entry_of_box};
use crate::shape::{Triangle, TriangleShape};

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
            let slabs = BoxSlabs::new(self, ray)?;
            let miss = RayAnswer { outcome: RayOutcome::Miss, ..RayAnswer::default() };
            let found = GroundRayAnswer { answer: miss, triangle: self.ground.triangle_count() as u32 };
            let mut first = FirstRayHit {
                ground: *self,
                ray,
                slabs,
                scratch: None,
                found,
                entry: f64::INFINITY,
                enough: f64::INFINITY,
            };
            self.ground.layout().walk(&mut first)?;
            if first.found.answer.outcome == RayOutcome::Hit {
                first.found.answer.entry[0] = first.entry;
            }
            Ok(first.found)
        })
    }
}

/// The first hit of the triangles that a walk has reached.
struct FirstRayHit<'a> {
    ground: PlacedGround<'a>,
    ray: &'a Ray,
    slabs: BoxSlabs,
    /// Made on first need.
    scratch: Option<TriangleShape>,
    found: GroundRayAnswer,
    /// No triangle of those is hit before.
    entry: f64,
    /// Boxes that the ray enters later are passed by.
    enough: f64,
}

impl Visit for FirstRayHit<'_> {
    fn key(&self, bounds: &NodeBounds) -> f64 {
        self.slabs.entry(bounds)
    }

    fn goes_to(&mut self, _: &NodeBounds, entry: f64) -> bool {
        entry <= self.enough
    }

    fn triangle(&mut self, triangle: u32) -> Result<bool> {
        let own = self.ground.ground.triangle(triangle);
        let entry = self.slabs.entry(&NodeBounds::of(&own.corners));
        if entry > self.enough || entry == f64::INFINITY {
            return Ok(true);
        }
        let answer = match self.rounded(&own) {
            Some(answer) => answer,
            None => {
                let scratch = match &mut self.scratch {
                    Some(scratch) => scratch,
                    none => none.insert(self.ground.ground.triangle_shape().copy()?),
                };
                cast_ray(scratch.of(&own).at(self.ground.pose), self.ray)?
            }
        };
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

/// An interval no wider than this, relative to 1 and to its place, is as good as that of [`cast_ray`].
const NARROW: f64 = f64::from_bits((1023 - 40) << 52);

impl FirstRayHit<'_> {
    /// The answer of a triangle that the ray certainly misses, or certainly goes through from one side to the other; `None` of one
    /// near a side, a plane along the ray, or an end of it.
    ///
    /// Corners are off by 6u of the translation and of twice their local coordinates, ways from the origin by u more of both. With
    /// δ above that, ways of a length of at most A and B, and sides of at most S: the volume of a ray and a side is off by less
    /// than |d|·(2δ·(A + B + δ) + 16u·A·B), the normal by 4δ·(S + δ) + 16u·S², its product with a way by that times A,
    /// 2δ·S², and 8u.
    fn rounded(&self, triangle: &Triangle) -> Option<RayAnswer> {
        let (origin, direction, pose) = (self.ray.origin(), self.ray.direction(), self.ground.pose);
        let ways = triangle.corners.map(|corner| pose.transform(&corner) - origin);
        let local = triangle.corners.iter().map(|corner| corner.lp_norm(1)).sum::<f64>();
        let off = 16.0 * U * (pose.translation().lp_norm(1) + 2.0 * local + origin.lp_norm(1));
        let length = direction.lp_norm(1);
        /// Products of such lengths neither overflow nor underflow.
        const PLAIN: std::ops::RangeInclusive<f64> = 1e-60..=1e60;
        if !(PLAIN.contains(&length) && PLAIN.contains(&off)) {
            return None;
        }
        let lengths = ways.map(|way| way.lp_norm(1));
        let (mut least, mut most, mut is_clear) = (f64::INFINITY, f64::NEG_INFINITY, true);
        for k in 0..3 {
            let next = (k + 1) % 3;
            let volume = direction.dot(&ways[k].cross(&ways[next]));
            let error =
                length * (2.0 * off * (lengths[k] + lengths[next] + off) + 16.0 * U * lengths[k] * lengths[next]);
            is_clear &= volume.abs() > error;
            (least, most) = (least.min(volume + error), most.max(volume - error));
        }
        // False for a NaN.
        if least < 0.0 && most > 0.0 {
            return Some(RayAnswer { outcome: RayOutcome::Miss, ..RayAnswer::default() });
        }
        let [one, other] = [ways[1] - ways[0], ways[2] - ways[0]];
        let normal = one.cross(&other);
        let side = one.lp_norm(1).max(other.lp_norm(1));
        let off_normal = 4.0 * off * (side + off) + 16.0 * U * side * side;
        let (height, fall) = (normal.dot(&ways[0]), normal.dot(&direction));
        let off_height = lengths[0] * (off_normal + 8.0 * U * side * side) + 2.0 * off * side * side;
        let off_fall = length * (off_normal + 8.0 * U * side * side);
        let entry = height / fall;
        let error = 2.0 * (off_height + entry.abs() * off_fall) / fall.abs();
        if !(is_clear && fall.abs() > 4.0 * off_fall && error <= NARROW * (1.0 + entry.abs())) {
            return None;
        }
        if entry + error < 0.0 || entry - error > self.ray.t_max {
            return Some(RayAnswer { outcome: RayOutcome::Miss, ..RayAnswer::default() });
        }
        if !(entry - error > 0.0 && entry + error < self.ray.t_max) {
            return None;
        }
        let within = [entry - error, entry + error];
        // Against the ray; the sum with +0 turns −0 into 0.
        let normal = (normal * (-fall.signum() / normal.norm())).add_scalar(0.0);
        Some(RayAnswer {
            outcome: RayOutcome::Hit,
            entry: within,
            exit: within,
            normal: normal.into(),
            feature: Feature { kind: FeatureKind::Face, ids: [triangle.label, 0] },
            steps: 1,
            ..RayAnswer::default()
        })
    }
}

/// The ray in the frame of a ground.
struct BoxSlabs {
    point: Vector,
    /// None of a direction so long or short that turning it might overflow or lose digits: no box is ruled out then.
    direction: Option<Vector>,
    t_max: f64,
    slack: f64,
}

impl BoxSlabs {
    /// Products with R⁻¹ are off by [`ROUNDING`] of the lengths that go in. Where the ray is in the box of all triangles, t·d is no
    /// longer than the way there and the box: the slack holds the error of both. Half of `ROUNDING` would do.
    fn new(ground: &PlacedGround, ray: &Ray) -> Result<BoxSlabs> {
        const PLAIN: std::ops::RangeInclusive<f64> = 1e-290..=1e290;
        let Some(inverse) = ground.pose.rotation().try_inverse() else {
            return Err(Error::Bug("a rotation that was accepted has no inverse".into()));
        };
        let (origin, translation) = (ray.origin(), ground.pose.translation());
        let NodeBounds { lower, upper } = ground.ground.layout().bounds();
        let size = origin.lp_norm(1) + translation.lp_norm(1) + lower.lp_norm(1) + upper.lp_norm(1);
        let slack = 8.0 * ROUNDING * size + f64::MIN_POSITIVE;
        let is_plain = PLAIN.contains(&ray.direction().amax()) && slack.is_finite();
        let direction = is_plain.then(|| inverse * ray.direction());
        Ok(BoxSlabs { point: inverse * (origin - translation), direction, t_max: ray.t_max, slack })
    }

    /// No point of the ray before this is in a box; infinite where none is.
    fn entry(&self, bounds: &NodeBounds) -> f64 {
        let Some(direction) = &self.direction else { return 0.0 };
        let ways =
            |k: usize| [bounds.lower[k] - self.slack - self.point[k], bounds.upper[k] + self.slack - self.point[k]];
        entry_of_box(ways, direction, self.t_max)
    }
}
