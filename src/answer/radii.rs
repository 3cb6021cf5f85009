//! The radii of the balls that are swept over two bodies: what they take off a distance, rounded outwards, and where they move
//! witness points to.
//!
//! A curved body holds its polyhedron P, and reaches no farther from it than its deviation δ. With h the support function,
//! h_P ≤ h ≤ h_P + δ along every direction, so the signed distance of two such bodies is that of the polyhedra less a number from
//! 0 to δ₁ + δ₂: the deviations count in the upper sum of what is taken off, and not in the lower one. Poses may stretch the body;
//! δ holds for all that are accepted.

use super::config::PairConfig;
use super::contact::PlacedPoints;
use crate::base::double_double::two_sum;
use crate::base::math::{Pose, UNIT_ROUNDOFF, Vector};
use crate::base::simd::environment::with_default;
use crate::base::simd::{self, Kernel, Lanes};
use crate::shape::Placed;

/// The swept radii of a pair.
#[derive(Debug, Clone, Copy)]
pub struct Radii {
    /// The radii of body 1 and body 2.
    pub each: [f64; 2],
    /// The sum of the deviations, rounded up.
    pub deviation: f64,
    /// The sum of the radii, rounded down.
    pub lower: f64,
    /// The sum of the radii and the deviation, rounded up.
    pub upper: f64,
}

impl Radii {
    /// The radii of bodies without any.
    pub const NONE: Radii = Radii { each: [0.0; 2], deviation: 0.0, lower: 0.0, upper: 0.0 };

    /// `None` of two bodies without.
    #[inline(always)]
    pub fn of(bodies: &[Placed; 2]) -> Option<Radii> {
        Radii::are_there(bodies).then(|| with_default(|| Radii::of_both(bodies)))
    }

    /// Whether a body has a radius or a deviation.
    #[inline(always)]
    pub fn are_there(bodies: &[Placed; 2]) -> bool {
        // By their bits: where subnormal numbers are flushed, a tiny radius would compare as 0.
        let bits = |body: &Placed| body.shape.swept_radius().to_bits() | body.shape.deviation().to_bits();
        bits(&bodies[0]) | bits(&bodies[1]) != 0
    }

    /// Those of any bodies, in the default floating-point environment.
    #[inline(always)]
    pub fn of_both(bodies: &[Placed; 2]) -> Radii {
        let each = [bodies[0].shape.swept_radius(), bodies[1].shape.swept_radius()];
        let [lower, upper] = [sum_below(each[0], each[1]), sum_above(each[0], each[1])];
        let deviations = [bodies[0].shape.deviation(), bodies[1].shape.deviation()];
        let are_curved = deviations[0].to_bits() | deviations[1].to_bits() != 0;
        // Numbers, not a whole `Radii`, which would be copied as soon as it is stored (R1).
        let (deviation, upper) = if are_curved { with_deviations(upper, deviations) } else { (0.0, upper) };
        Radii { each, deviation, lower, upper }
    }

    /// The radius and the deviation of a body, and of a partner without any.
    pub fn of_one(radius: f64, deviation: f64) -> Radii {
        debug_assert!(radius >= 0.0 && deviation >= 0.0);
        Radii { each: [radius, 0.0], deviation, lower: radius, upper: sum_above(radius, deviation) }
    }

    /// An interval of the signed distance of the polyhedra as one of the swept bodies: of sets that are offset by r it is r less,
    /// be they apart or in each other, as the support function of their difference is r more along every direction.
    #[inline(always)]
    pub fn off(&self, [lower, upper]: [f64; 2]) -> [f64; 2] {
        [sum_below(lower, -self.upper), sum_above(upper, -self.lower)]
    }

    /// The side of two bodies, with the interval of their signed distance as [`Radii::off`] gives it and as it is reported; `None`
    /// where only integers tell. For polyhedra that are beyond the radii and the tolerance the lower end says the rest.
    #[inline(always)]
    pub fn side(&self, interval: [f64; 2], tolerance: f64, is_beyond: bool) -> Option<(Side, [f64; 2])> {
        let [lower, upper] = interval;
        if upper < 0.0 {
            return Some((Side::Within, interval));
        }
        // A distance beyond the doubles may be one of them less the radii.
        if (lower > 0.0) & !is_beyond & (upper <= tolerance) & (upper < f64::INFINITY) {
            return Some((Side::Apart, interval));
        }
        if (lower > 0.0) & (is_beyond | (lower > tolerance)) {
            return Some((Side::Beyond, [lower.max(tolerance.min(f64::MAX)), f64::INFINITY]));
        }
        (self.deviation > 0.0).then(|| (Side::of_curved(interval), interval))
    }

    /// Whether an interval of the bodies is too wide for an approximate query, though that of their polyhedra, whose lower end is
    /// larger, was not.
    #[inline(always)]
    pub fn is_too_wide(&self, [lower, upper]: [f64; 2], config: &PairConfig) -> bool {
        // The deviation stays, however narrow the interval of the polyhedra is.
        let width = upper - lower - self.deviation;
        let may_be_wide = (config.absolute_error > 0.0) | (config.relative_error > 0.0);
        let is_narrow = (width <= config.absolute_error) | ((lower > 0.0) & (width <= config.relative_error * lower));
        may_be_wide & (upper > 0.0) & !is_narrow
    }

    /// The least interval of the polyhedra that contains the result of [`Radii::off`] for this. Integers, which may have narrowed
    /// it, know the sum of the radii no better than its two ends; they are not asked where there is a deviation.
    pub fn back_on(&self, [lower, upper]: [f64; 2]) -> [f64; 2] {
        debug_assert!(lower <= upper);
        if self.deviation > 0.0 {
            return [sum_below(lower, self.upper), sum_above(upper, self.lower)];
        }
        [sum_below(lower, self.lower), sum_above(upper, self.upper)]
    }

    /// The lengths whose sum is the most that is taken off, for integers.
    pub fn most(&self) -> [f64; 3] {
        [self.each[0], self.each[1], self.deviation]
    }

    /// Polyhedra of bodies no farther apart than this are no farther apart than …
    #[inline]
    pub fn with(&self, length: f64) -> f64 {
        debug_assert!(length >= 0.0);
        sum_above(length, self.upper)
    }

    /// By how much witness points move along the normal, which is from body 2 to body 1, from the polyhedra to the surfaces.
    pub fn outwards(&self) -> [f64; 2] {
        [-self.each[0], self.each[1]]
    }

    /// … and back.
    pub fn inwards(&self) -> [f64; 2] {
        [self.each[0], -self.each[1]]
    }
}

/// The sum of the deviations, and that with the radii.
#[cold]
fn with_deviations(radii: f64, [deviation1, deviation2]: [f64; 2]) -> (f64, f64) {
    let deviation = sum_above(deviation1, deviation2);
    (deviation, sum_above(radii, deviation))
}

/// The relation of two bodies.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Side {
    /// Farther apart than the tolerance.
    Beyond,
    Apart,
    /// In each other, or touching.
    Within,
    /// Apart or in each other: the deviation hides it.
    Hidden,
}

impl Side {
    /// The relation of curved bodies, by an interval of their signed distance: nothing else tells.
    pub fn of_curved([lower, upper]: [f64; 2]) -> Side {
        if upper <= 0.0 {
            Side::Within
        } else if lower > 0.0 {
            Side::Apart
        } else {
            Side::Hidden
        }
    }
}

/// Points moved by this much along a direction of the world: [`move_points`].
pub fn moved(points: &PlacedPoints, poses: [&Pose; 2], normal: &[f64; 3], by: [f64; 2]) -> PlacedPoints {
    let PlacedPoints { local: [mut local1, mut local2], world: [mut world1, mut world2] } = *points;
    move_points([&mut local1, &mut local2], [&mut world1, &mut world2], poses, normal, by);
    PlacedPoints { local: [local1, local2], world: [world1, world2] }
}

/// Moves points by this much along a direction of the world. A pose does not stretch the ball: the local point is where the pose
/// takes to the moved one.
pub fn move_points(
    [local1, local2]: [&mut [f64; 3]; 2],
    [world1, world2]: [&mut [f64; 3]; 2],
    [pose1, pose2]: [&Pose; 2],
    normal: &[f64; 3],
    [by1, by2]: [f64; 2],
) {
    let normal = &Vector::from(*normal);
    let one = MovingPoint { local: local1, world: world1, pose: pose1, by: by1 };
    let two = MovingPoint { local: local2, world: world2, pose: pose2, by: by2 };
    simd::dispatch(&mut Move { normal, one, two });
}

/// A point of a body, and how far it moves.
struct MovingPoint<'a> {
    local: &'a mut [f64; 3],
    world: &'a mut [f64; 3],
    pose: &'a Pose,
    by: f64,
}

struct Move<'a> {
    normal: &'a Vector,
    one: MovingPoint<'a>,
    two: MovingPoint<'a>,
}

impl Kernel for Move<'_> {
    type Output = ();

    #[inline(always)]
    fn run<L: Lanes>(&mut self) {
        self.one.go::<L>(self.normal);
        self.two.go::<L>(self.normal);
    }
}

impl MovingPoint<'_> {
    /// Products are rounded before they are summed: all machines move points alike.
    #[inline(always)]
    fn go<L: Lanes>(&mut self, normal: &Vector) {
        let (along, by) = (L::from_vector(normal), L::splat(self.by));
        let local = L::from_vector(&Vector::from(*self.local));
        let world = L::from_vector(&Vector::from(*self.world));
        world.add(along.mul(by)).store_vector(self.world);
        local.add(turned_back::<L>(self.pose, normal).mul(by)).store_vector(self.local);
        // No surface that is reported is beyond the doubles: there rounding is longer than what is cut off. Lanes' `max` would
        // raise a flag for a NaN.
        for x in self.world.iter_mut().chain(self.local.iter_mut()) {
            if x.is_infinite() {
                *x = f64::MAX.copysign(*x);
            }
        }
    }
}

/// R⁻¹·n: Rᵀ·n, put right by what R makes of it; where that is more than rounding, by the inverse.
#[inline(always)]
fn turned_back<L: Lanes>(pose: &Pose, normal: &Vector) -> L {
    let rows = [L::load(&pose.rows[0]), L::load(&pose.rows[1]), L::load(&pose.rows[2])];
    let [x, y, z, _] = L::transpose(&rows);
    let along = L::from_vector(normal);
    let turned = combined(rows, along);
    let rest = along.sub(combined([x, y, z], turned));
    let limit = L::splat(64.0 * UNIT_ROUNDOFF * normal.amax());
    // False for a NaN.
    let is_right = rest.at_most(limit) & rest.negate().at_most(limit) & 0b111 == 0b111;
    if is_right { turned.add(combined(rows, rest)) } else { L::from_vector(&inverted(pose, normal)) }
}

/// The sum of three vectors, each times its lane of `by`.
#[inline(always)]
fn combined<L: Lanes>([x, y, z]: [L; 3], by: L) -> L {
    x.mul(by.splat_x()).add(y.mul(by.splat_y())).add(z.mul(by.splat_z()))
}

#[cold]
fn inverted(pose: &Pose, normal: &Vector) -> Vector {
    pose.rotation().try_inverse().map_or_else(|| pose.rotate_back(normal), |back| back * normal)
}

/// a + b, rounded down: at most the largest double where both are finite; infinite or NaN only if a or b is.
#[inline(always)]
pub fn sum_below(a: f64, b: f64) -> f64 {
    // First, as the rest of a sum that is infinite has no value.
    let high = a + b;
    if !high.is_finite() {
        return beyond([a, b], high, f64::MAX);
    }
    let sum = two_sum(a, b);
    // Without a branch, which would be taken every other time. (0 is exact.)
    let step = if sum.hi < 0.0 { 1 } else { u64::MAX };
    f64::from_bits(sum.hi.to_bits().wrapping_add(if sum.lo < 0.0 { step } else { 0 }))
}

/// a + b, rounded up: the same of the other side.
#[inline(always)]
pub fn sum_above(a: f64, b: f64) -> f64 {
    // First, as the rest of a sum that is infinite has no value.
    let high = a + b;
    if !high.is_finite() {
        return beyond([a, b], high, f64::MIN);
    }
    let sum = two_sum(a, b);
    let step = if sum.hi < 0.0 { u64::MAX } else { 1 };
    f64::from_bits(sum.hi.to_bits().wrapping_add(if sum.lo > 0.0 { step } else { 0 }))
}

/// A sum that is no finite double, rounded away from the infinity that has the sign of `last`: the last double before it where both
/// terms are finite.
#[cold]
fn beyond(terms: [f64; 2], sum: f64, last: f64) -> f64 {
    let has_overflowed = terms.iter().all(|term| term.is_finite()) && sum * last > 0.0;
    if has_overflowed { last } else { sum }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::base::math::Matrix;
    use swiftprox::random::Random;

    /// The pose takes the moved local point to the point moved in the world, be it rigid or skewed, whatever lanes compute it.
    #[test]
    fn local_points_go_where_the_pose_takes_them_to_the_surface() {
        let mut random = Random::new(0x3ad1);
        for round in 0..if cfg!(miri) { 5 } else { 2_000 } {
            let skew = [0.0, 1e-15, 1e-9, 3e-3][round % 4];
            let skewed = Matrix::from_fn(|i, k| f64::from(u8::from(i == k)) + random.uniform(-skew, skew));
            let pose = Pose::new(&(random.rotation() * skewed), &random.vector());
            let (normal, by) = (random.direction(), random.uniform(-2.0, 2.0));
            let local = random.vector();
            let points = PlacedPoints { local: [local.into(); 2], world: [pose.transform(&local).into(); 2] };
            let moved = moved(&points, [&pose; 2], &normal.into(), [by, -by]);
            for (i, by) in [by, -by].into_iter().enumerate() {
                let (found, expected) = (Vector::from(moved.world[i]), pose.transform(&local) + normal * by);
                assert_eq!(found, expected, "{round}");
                let seen = pose.transform(&Vector::from(moved.local[i]));
                assert!((seen - expected).amax() < 8e-15, "{round}: {seen} {expected}");
            }
            let portable: simd::Portable = turned_back(&pose, &normal);
            let expected = Vector::from(moved.local[0]) - local;
            assert!((portable.to_vector() * by - expected).amax() <= 4e-15, "{round}");
        }
    }
}
