//! Where a ray first meets a ground: the first of its triangles. Those that rounding leaves open are answered by [`crate::ray`].

use super::PlacedGround;
use super::reach::ROUNDING;
use super::tree::{FOUR, FourBoxes, NodeBounds, Visit};
use crate::base::error::{Error, Result};
use crate::base::math::{Matrix, Pose, UNIT_ROUNDOFF as U, Vector};
use crate::base::simd::environment::with_default;
use crate::pair::{Feature, FeatureKind};
use crate::ray::{Ray, RayAnswer, RayOutcome, cast_ray, cast_ray_in_integers};
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
        self.first_hit(ray, false)
    }

    /// The same, and both ends of the entry are neighbouring doubles.
    ///
    /// # Errors
    /// As of [`PlacedGround::cast_ray`].
    pub(crate) fn cast_ray_in_integers(&self, ray: &Ray) -> Result<GroundRayAnswer> {
        self.first_hit(ray, true)
    }

    fn first_hit(&self, ray: &Ray, in_integers: bool) -> Result<GroundRayAnswer> {
        with_default(|| {
            ray.check()?;
            self.pose.check()?;
            let local = LocalRay::new(self, ray)?;
            let miss = RayAnswer { outcome: RayOutcome::Miss, ..RayAnswer::default() };
            let found = GroundRayAnswer { answer: miss, triangle: self.ground.triangle_count() as u32 };
            let mut first = FirstRayHit {
                ground: *self,
                ray,
                in_integers,
                local,
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
    in_integers: bool,
    local: LocalRay,
    /// Made on first need.
    scratch: Option<TriangleShape>,
    found: GroundRayAnswer,
    /// No triangle of those is hit before.
    entry: f64,
    /// Boxes that the ray enters later are passed by.
    enough: f64,
}

impl Visit for FirstRayHit<'_> {
    fn keys(&self, boxes: &FourBoxes) -> [f64; FOUR] {
        self.local.entries(boxes)
    }

    fn goes_to(&mut self, _: &NodeBounds, entry: f64) -> bool {
        entry <= self.enough
    }

    fn triangle(&mut self, triangle: u32) -> Result<bool> {
        let answer = match self.local.rounded(&self.ground.ground.layout().points(triangle), triangle) {
            Some(answer) if !self.in_integers || answer.outcome == RayOutcome::Miss => answer,
            _ => {
                let scratch = match &mut self.scratch {
                    Some(scratch) => scratch,
                    none => none.insert(self.ground.ground.triangle_shape().copy()?),
                };
                let cast = if self.in_integers { cast_ray_in_integers } else { cast_ray };
                cast(scratch.of(&self.ground.ground.triangle(triangle)).at(self.ground.pose), self.ray)?
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

/// An interval no wider than this, relative to 1, to its place and to where the ray begins, is as good as that of [`cast_ray`].
const NARROW: f64 = f64::from_bits((1023 - 40) << 52);

/// The ray in the frame of a ground.
struct LocalRay {
    point: Vector,
    direction: Vector,
    /// How far both may be off.
    off: [f64; 2],
    /// Whether products with the direction neither overflow nor underflow. If not, no box is ruled out and no triangle answered.
    is_plain: bool,
    /// One over the direction's parts; 0 where that is no number.
    over: [f64; 3],
    t_max: f64,
    /// By how much boxes are widened.
    slack: f64,
    /// Takes normals to the world.
    inverse: Matrix,
}

impl LocalRay {
    /// Products with R⁻¹ are off by [`ROUNDING`] of the lengths that go in, those with 1 not at all. Where the ray is in the box of
    /// all triangles, t·d is no longer than the way there and the box: the slack holds the error of both. Half of it would do.
    fn new(ground: &PlacedGround, ray: &Ray) -> Result<LocalRay> {
        const PLAIN: std::ops::RangeInclusive<f64> = 1e-60..=1e60;
        let Some(inverse) = ground.pose.rotation().try_inverse() else {
            return Err(Error::Bug("a rotation that was accepted has no inverse".into()));
        };
        let (origin, translation) = (ray.origin(), ground.pose.translation());
        let NodeBounds { lower, upper } = ground.ground.layout().bounds();
        let from = origin.lp_norm(1) + translation.lp_norm(1);
        let size = from + lower.lp_norm(1) + upper.lp_norm(1);
        let slack = 8.0 * ROUNDING * size + f64::MIN_POSITIVE;
        let is_plain = PLAIN.contains(&ray.direction().amax()) && PLAIN.contains(&slack);
        let direction = inverse * ray.direction();
        let is_placed = *ground.pose != Pose::IDENTITY;
        let off = if is_placed { [ROUNDING * from, ROUNDING * ray.direction().lp_norm(1)] } else { [0.0; 2] };
        let over = [0, 1, 2].map(|k| if direction[k].abs() >= f64::MIN_POSITIVE { 1.0 / direction[k] } else { 0.0 });
        let point = inverse * (origin - translation);
        Ok(LocalRay { point, direction, off, is_plain, over, t_max: ray.t_max, slack, inverse })
    }

    /// No point of the ray before these is in the boxes; infinite where none is. A product with what is one over a part of the
    /// direction is right to 2u; where that is no number, the axis rules nothing out.
    fn entries(&self, boxes: &FourBoxes) -> [f64; FOUR] {
        let (mut entry, mut exit) = ([0.0; FOUR], [self.t_max; FOUR]);
        if !self.is_plain {
            return entry;
        }
        for k in (0..3).filter(|k| self.over[*k] != 0.0) {
            let (over, point) = (self.over[k], self.point[k]);
            let (near, far, slack) = if over > 0.0 {
                (&boxes.lower[k], &boxes.upper[k], self.slack)
            } else {
                (&boxes.upper[k], &boxes.lower[k], -self.slack)
            };
            for lane in 0..FOUR {
                let (first, last) = ((near[lane] - slack - point) * over, (far[lane] + slack - point) * over);
                let (first, last) = (first - 8.0 * U * first.abs(), last + 8.0 * U * last.abs());
                // False for a NaN, of infinite boxes.
                entry[lane] = if first > entry[lane] { first } else { entry[lane] };
                exit[lane] = if last < exit[lane] { last } else { exit[lane] };
            }
        }
        std::array::from_fn(|lane| if entry[lane] > exit[lane] { f64::INFINITY } else { entry[lane].min(f64::MAX) })
    }

    /// The answer of a triangle that the ray certainly misses, or certainly goes through from one side to the other; `None` of one
    /// near a side, a plane along the ray, or an end of it.
    ///
    /// Ways from the origin are off by δ, which is its own error and u of them, and the direction by ε. With ways of a length of at
    /// most A and B, and sides of at most S: the volume of a ray and a side is off by less than |d|·(2δ·(A + B + δ) + 16u·A·B) +
    /// 2ε·(A + δ)·(B + δ), the normal by 16u·S², its product with a way by 24u·S²·A + 2δ·S², and with the direction by 24u·S²·|d| +
    /// 2ε·S².
    fn rounded(&self, corners: &[Vector; 3], triangle: u32) -> Option<RayAnswer> {
        if !self.is_plain {
            return None;
        }
        let (direction, [a, b, c]) = (&self.direction, corners);
        let ways = [a - self.point, b - self.point, c - self.point];
        let lengths = [ways[0].lp_norm(1), ways[1].lp_norm(1), ways[2].lp_norm(1)];
        let longest = lengths[0].max(lengths[1]).max(lengths[2]);
        let (off, off_direction) = (self.off[0] + 2.0 * U * longest, self.off[1]);
        let length = direction.lp_norm(1);
        let reach = longest + off;
        let error = length * (2.0 * off * (2.0 * longest + off) + 16.0 * U * longest * longest)
            + 2.0 * off_direction * reach * reach
            + f64::MIN_POSITIVE;
        let volume = |one: &Vector, other: &Vector| direction.dot(&one.cross(other));
        let [x, y, z] = [volume(&ways[0], &ways[1]), volume(&ways[1], &ways[2]), volume(&ways[2], &ways[0])];
        let (least, most) = (x.min(y).min(z), x.max(y).max(z));
        // False for a NaN.
        if least < -error && most > error {
            return Some(RayAnswer { outcome: RayOutcome::Miss, ..RayAnswer::default() });
        }
        let [one, other] = [b - a, c - a];
        let normal = one.cross(&other);
        let side = one.lp_norm(1).max(other.lp_norm(1));
        let (height, fall) = (normal.dot(&ways[0]), normal.dot(direction));
        let square = side * side;
        let off_height = 24.0 * U * square * lengths[0] + 2.0 * off * square;
        let off_fall = 24.0 * U * square * length + 2.0 * off_direction * square;
        // False for a NaN.
        if !((least > error || most < -error) && fall.abs() > 4.0 * off_fall) {
            return None;
        }
        let entry = height / fall;
        let wide = 2.0 * (off_height + entry.abs() * off_fall) / fall.abs();
        let is_narrow = wide <= NARROW * (1.0 + entry.abs() + self.slack / (8.0 * ROUNDING * length));
        if !is_narrow {
            return None;
        }
        if entry + wide < 0.0 || entry - wide > self.t_max {
            return Some(RayAnswer { outcome: RayOutcome::Miss, ..RayAnswer::default() });
        }
        if !(entry - wide > 0.0 && entry + wide < self.t_max) {
            return None;
        }
        let within = [entry - wide, entry + wide];
        // Against the ray; the sum with +0 turns −0 into 0.
        let normal = self.inverse.tr_mul(&normal);
        let normal = (normal * (-fall.signum() / normal.norm())).add_scalar(0.0);
        Some(RayAnswer {
            outcome: RayOutcome::Hit,
            entry: within,
            exit: within,
            normal: normal.into(),
            feature: Feature { kind: FeatureKind::Face, ids: [triangle, 0] },
            steps: 1,
            ..RayAnswer::default()
        })
    }
}
