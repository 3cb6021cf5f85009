//! The truth about rays and small convex bodies in exact arithmetic, by another algorithm than the library's, and rays at which
//! doubles are at a loss.
//!
//! Where a line comes into the hull of points it is in the hull of three of them at most. So all triangles, segments and points are
//! met with the line, and the first and the last place count. O(n³), so for a dozen points.

use std::cmp::Ordering;
use std::ops::{Add, Mul, Neg, Sub};

use dashu_int::IBig;
use dashu_ratio::RBig;
use swiftprox::math::{Pose, Vector};
use swiftprox::pair::FeatureKind;
use swiftprox::ray::{Ray, RayAnswer, RayOutcome};
use swiftprox::shape::LARGEST_SWEPT_RADIUS;

use crate::cases::row_major;
use crate::oracle::{Polytope, Truth, rational, transform};
use crate::random::Random;

/// Integers: `i128` where numbers are small, `IBig` elsewhere.
pub trait Integer:
    Clone + Ord + From<i64> + Add<Output = Self> + Sub<Output = Self> + Mul<Output = Self> + Neg<Output = Self>
{
}
impl Integer for i128 {}
impl Integer for IBig {}

/// A quotient with a positive denominator.
#[derive(Debug, Clone)]
pub struct Fraction<N> {
    pub numerator: N,
    pub denominator: N,
}

impl<N: Integer> Fraction<N> {
    fn new(numerator: N, denominator: N) -> Fraction<N> {
        match denominator < N::from(0) {
            true => Fraction { numerator: -numerator, denominator: -denominator },
            false => Fraction { numerator, denominator },
        }
    }

    fn compare(&self, other: &Fraction<N>) -> Ordering {
        let left = self.numerator.clone() * other.denominator.clone();
        left.cmp(&(other.numerator.clone() * self.denominator.clone()))
    }
}

fn dot<N: Integer>(a: &[N; 3], b: &[N; 3]) -> N {
    let [x, y, z] = [0, 1, 2].map(|k| a[k].clone() * b[k].clone());
    x + y + z
}

fn cross<N: Integer>(a: &[N; 3], b: &[N; 3]) -> [N; 3] {
    let minor = |i: usize, j: usize| a[i].clone() * b[j].clone() - a[j].clone() * b[i].clone();
    [minor(1, 2), minor(2, 0), minor(0, 1)]
}

fn minus<N: Integer>(a: &[N; 3], b: &[N; 3]) -> [N; 3] {
    [0, 1, 2].map(|k| a[k].clone() - b[k].clone())
}

/// The first and the last place of the line through the origin in the hull of the points, as multiples of its direction.
pub fn line_in_hull<N: Integer>(points: &[[N; 3]], direction: &[N; 3]) -> Option<[Fraction<N>; 2]> {
    let zero = N::from(0);
    let mut found: Option<[Fraction<N>; 2]> = None;
    let mut meet = |place: Fraction<N>| match &mut found {
        None => found = Some([place.clone(), place]),
        Some([first, last]) => {
            if place.compare(first).is_lt() {
                *first = place;
            } else if place.compare(last).is_gt() {
                *last = place;
            }
        }
    };
    let square = dot(direction, direction);
    for (i, a) in points.iter().enumerate() {
        if cross(a, direction).iter().all(|x| *x == zero) {
            meet(Fraction::new(dot(a, direction), square.clone()));
        }
        for (j, b) in points.iter().enumerate().take(i) {
            let along = minus(b, a);
            let across = cross(direction, &along);
            let spread = dot(&across, &across);
            if spread > zero && dot(a, &across) == zero {
                let share = dot(&cross(a, direction), &across);
                if (zero.clone()..=spread.clone()).contains(&share) {
                    meet(Fraction::new(dot(&cross(a, &along), &across), spread));
                }
            }
            for c in points.iter().take(j) {
                let normal = cross(&along, &minus(c, a));
                let towards = dot(&normal, direction);
                if towards == zero {
                    continue;
                }
                let sides = [[a, b], [b, c], [c, a]].map(|[p, q]| dot(direction, &cross(p, q)));
                if sides.iter().all(|s| *s >= zero) || sides.iter().all(|s| *s <= zero) {
                    meet(Fraction::new(dot(&normal, a), towards));
                }
            }
        }
    }
    found
}

/// A body's points at a pose, and a ray.
#[derive(Debug, Clone)]
pub struct Case {
    pub points: Vec<Vector>,
    pub pose: Pose,
    pub ray: Ray,
    /// Where the ray's line comes in and goes out.
    pub truth: Option<[RBig; 2]>,
}

/// The truth about any finite numbers.
pub fn truth(points: &[Vector], pose: &Pose, ray: &Ray) -> Option<[RBig; 2]> {
    let matrix = std::array::from_fn(|k| pose.rows[k / 4][k % 4]);
    let world: Vec<[RBig; 3]> = points
        .iter()
        .map(|p| {
            let at = transform(&matrix, &[p.x, p.y, p.z].map(rational));
            [0, 1, 2].map(|k| &at[k] - rational(ray.origin[k]))
        })
        .collect();
    let direction = ray.direction.map(rational);
    // Denominators are powers of two.
    let largest = |numbers: &mut dyn Iterator<Item = &RBig>| {
        IBig::from(numbers.map(|x| x.denominator().clone()).max().unwrap_or(dashu_int::UBig::ONE))
    };
    let (of_points, of_direction) = (largest(&mut world.iter().flatten()), largest(&mut direction.iter()));
    let scaled =
        |v: &[RBig; 3], by: &IBig| [0, 1, 2].map(|k| v[k].numerator() * (by / IBig::from(v[k].denominator().clone())));
    let integers: Vec<[IBig; 3]> = world.iter().map(|p| scaled(p, &of_points)).collect();
    let places = line_in_hull(&integers, &scaled(&direction, &of_direction))?;
    Some(places.map(|place| RBig::from(place.numerator * &of_direction) / RBig::from(place.denominator * &of_points)))
}

/// A ray on a lattice, through corners, edges and faces of a body on it, along them or beside them: of any dimension, and in any
/// power of two as the unit.
pub fn on_lattice(random: &mut Random) -> Case {
    let count = 1 + random.below(8);
    let (flat, size) = (random.below(4), 1 + random.below(4));
    let mut points: Vec<Vector> = (0..count).map(|_| random.lattice(size)).collect();
    if flat == 0 {
        points.iter_mut().for_each(|p| p.z = 0.0);
    } else if flat == 1 {
        points =
            (0..8).map(|k| Vector::new(k as f64 % 2.0, (k / 2) as f64 % 2.0, (k / 4) as f64) * size as f64).collect();
    }
    let (turn, shift) = (random.quarter_turns(), random.lattice(5));
    let world: Vec<Vector> = points.iter().map(|p| turn * p + shift).collect();
    // Where it passes: doubled, so that the middles of edges are on the lattice, and tripled for those of triangles.
    let mut any = || world[random.below(world.len())];
    let (a, b, c) = (any(), any(), any());
    let (through, times) = match random.below(5) {
        0 => (a, 1.0),
        1 => (a + b, 2.0),
        2 => (a + b + c, 3.0),
        3 => (a + random.lattice(1), 1.0),
        _ => (random.lattice(8), 1.0),
    };
    let along = match random.below(4) {
        0 => b - a,
        1 => (b - a).cross(&(c - a)),
        _ => random.lattice(3),
    };
    let along = if along == Vector::zeros() { Vector::x() } else { along };
    let back = random.below(9) as f64 - 2.0;
    let origin = through - along * back;
    let t_max = match random.below(4) {
        0 => random.below(9) as f64,
        1 => back.abs(),
        _ => f64::INFINITY,
    };
    let widest = if random.below(8) == 0 { 300 } else { 30 };
    let (unit, step) = (random.power(-widest, widest), random.power(-widest, widest));
    let integers = |v: Vector| [v.x, v.y, v.z].map(|x| x as i128);
    let relative: Vec<[i128; 3]> = world.iter().map(|p| integers(p * times - origin)).collect();
    let places = line_in_hull(&relative, &integers(along));
    // Points of the case are `times` as large, in units of `unit`; the direction in units of `step`.
    let truth = places.map(|places| {
        places.map(|place| {
            RBig::from(IBig::from(place.numerator)) / RBig::from(IBig::from(place.denominator)) * rational(unit)
                / rational(step)
        })
    });
    let exact_t_max = t_max * unit / step;
    Case {
        points: points.iter().map(|p| p * (times * unit)).collect(),
        pose: Pose::new(&turn, &(shift * (times * unit))),
        ray: Ray { origin: (origin * unit).into(), direction: (along * step).into(), t_max: exact_t_max },
        truth,
    }
}

/// A ray of any doubles at a body in a turned pose, mostly near one of its corners or edges.
pub fn anywhere(random: &mut Random) -> Case {
    let count = 1 + random.below(7);
    let size = random.power(-20, 20);
    let points: Vec<Vector> = (0..count).map(|_| random.vector() * size).collect();
    let distance = size * random.pick(&[0.0, 1.0, 10.0, 1e6]);
    let pose = Pose::new(&random.rotation(), &(random.vector() * distance));
    let (a, b) = (points[random.below(count)], points[random.below(count)]);
    let through = pose.transform(&(a + (b - a) * random.pick(&[0.0, 0.5, 1.0])));
    let near = random.vector() * (size * random.pick(&[0.0, 1e-16, 1e-12, 0.1, 1.0]));
    let direction = match random.below(3) {
        0 => pose.rotate(&(b - a)),
        _ => random.vector() * random.power(-10, 10),
    };
    let direction = if direction == Vector::zeros() { Vector::y() } else { direction };
    let origin = through + near - direction * random.uniform(-2.0, 8.0);
    let t_max = if random.below(2) == 0 { f64::INFINITY } else { random.uniform(0.0, 8.0) };
    let ray = Ray { origin: origin.into(), direction: direction.into(), t_max };
    Case { truth: truth(&points, &pose, &ray), points, pose, ray }
}

/// Whether an answer is the truth and its intervals hold.
pub fn check_intervals(case: &Case, answer: &RayAnswer) {
    let Case { ray, truth, .. } = case;
    let zero = RBig::ZERO;
    let t_max = (ray.t_max < f64::INFINITY).then(|| rational(ray.t_max));
    let hit = truth.as_ref().filter(|[first, last]| *last >= zero && t_max.as_ref().is_none_or(|t| first <= t));
    let Some([first, last]) = hit else {
        assert_eq!(answer.outcome, RayOutcome::Miss, "{case:?} {answer:?}");
        assert!(answer.entry[0].is_nan() && answer.exit[1].is_nan() && answer.normal[0].is_nan());
        return;
    };
    let holds =
        |[low, high]: [f64; 2], t: &RBig| rational(low) <= *t && (high == f64::INFINITY || *t <= rational(high));
    let end = t_max.map_or(last.clone(), |t| t.min(last.clone()));
    assert!(holds(answer.exit, &end), "{case:?} {answer:?}");
    if *first < zero {
        assert_eq!((answer.outcome, answer.entry), (RayOutcome::Inside, [0.0; 2]), "{case:?} {answer:?}");
        return;
    }
    assert_eq!(answer.outcome, RayOutcome::Hit, "{case:?} {answer:?}");
    assert!(holds(answer.entry, first), "{case:?} {answer:?}");
}

/// As [`check_intervals`]; and the normal is that of a plane that the body is behind.
pub fn check(case: &Case, answer: &RayAnswer) {
    check_intervals(case, answer);
    if answer.outcome != RayOutcome::Hit {
        return;
    }
    let Case { points, pose, ray, .. } = case;
    let normal = Vector::from(answer.normal);
    assert!((normal.norm() - 1.0).abs() < 1e-12, "{case:?} {answer:?}");
    if answer.feature.kind != FeatureKind::Face {
        return;
    }
    // In units that keep squares among the doubles; the entry is a vertex, on an edge or in a face that the body is behind.
    let largest = points.iter().map(|p| p.amax()).fold(0.0, f64::max).max(f64::MIN_POSITIVE);
    let world = points.iter().map(|p| pose.rotate(&(p / largest)));
    let from = (Vector::from(ray.origin) - pose.translation()) / largest;
    let advanced = Vector::from(ray.direction) * answer.entry[0] / largest;
    let entry = from + advanced;
    let slack = 1e-9 * (1.0 + from.amax() + advanced.amax());
    for point in world {
        assert!(normal.dot(&(point - entry)) <= slack, "{case:?} {answer:?}");
    }
}

/// A body with a ball swept over it, and a ray. What is asked of the oracle is whether stretches of the ray's line are within the
/// radius of the hull, by the pairs of all features.
#[derive(Debug, Clone)]
pub struct SweptCase {
    pub points: Vec<Vector>,
    pub radius: f64,
    pub pose: Pose,
    pub ray: Ray,
}

/// Farther along a line than any double goes, as a power of two.
const FAR: isize = 2_200;

/// Where a stretch ends that leaves out 0 and nothing else.
const NEAR_0: isize = -70_000;

impl SweptCase {
    /// The square of the distance of the hull and the line between two places.
    fn square(&self, hull: &Polytope, from: &RBig, to: &RBig) -> RBig {
        let place = |t: &RBig| -> [RBig; 3] {
            std::array::from_fn(|k| rational(self.ray.origin[k]) + rational(self.ray.direction[k]) * t)
        };
        let ends = if from == to { vec![place(from)] } else { vec![place(from), place(to)] };
        let here = row_major(&Pose::IDENTITY);
        crate::oracle::truth(hull, &row_major(&self.pose), &Polytope::from_rationals(ends), &here).squared_distance
    }

    /// How far the hull is from all of the ray, or from its origin.
    pub fn apart(&self, of_origin: bool) -> Truth {
        let end = if of_origin { RBig::ZERO } else { self.end() };
        Truth { squared_distance: self.square(&self.hull(), &RBig::ZERO, &end) }
    }

    /// The same, rounded.
    fn distance(&self, of_origin: bool) -> f64 {
        self.apart(of_origin).squared_distance.to_f64().value().sqrt()
    }

    fn hull(&self) -> Polytope {
        Polytope::new(&self.points.iter().map(|p| (*p).into()).collect::<Vec<_>>())
    }

    fn end(&self) -> RBig {
        if self.ray.t_max < f64::INFINITY { rational(self.ray.t_max) } else { power(FAR) }
    }

    /// Whether an answer is the truth; what integers said of both ends are neighbouring doubles, and the normal is that of a plane
    /// that the body is behind.
    pub fn check(&self, answer: &RayAnswer) {
        self.check_part(answer);
        if answer.exact == 1 && answer.outcome != RayOutcome::Miss {
            assert!([answer.entry, answer.exit].iter().all(|[a, b]| *b <= a.next_up()), "{self:?} {answer:?}");
        }
        if answer.outcome == RayOutcome::Hit {
            self.check_surface(answer);
        }
    }

    /// Whether the outcome is the truth and both intervals hold.
    pub fn check_part(&self, answer: &RayAnswer) {
        let Ray { t_max, .. } = self.ray;
        let (hull, end, zero) = (self.hull(), self.end(), RBig::ZERO);
        let square_of_radius = rational(self.radius) * rational(self.radius);
        let compare = |from: &RBig, to: &RBig| self.square(&hull, from, to).cmp(&square_of_radius);
        if compare(&zero, &end).is_gt() {
            assert_eq!(answer.outcome, RayOutcome::Miss, "{self:?} {answer:?}");
            assert!(answer.entry[0].is_nan() && answer.exit[1].is_nan() && answer.normal[0].is_nan());
            return;
        }
        let before = || compare(&-power(FAR), &-power(NEAR_0));
        let at_origin = compare(&zero, &zero);
        let begins_inside = at_origin.is_lt() || (at_origin.is_eq() && before().is_le());
        let outcome = if begins_inside { RayOutcome::Inside } else { RayOutcome::Hit };
        assert_eq!(answer.outcome, outcome, "{self:?} {answer:?}");
        let [first, until] = answer.exit;
        assert!((0.0..=t_max).contains(&first) && until <= t_max, "{self:?} {answer:?}");
        if compare(&end, &end).is_le() {
            assert_eq!(until, t_max, "{self:?} {answer:?}");
        } else {
            assert!(compare(&rational(first), &end).is_le(), "{self:?} {answer:?}");
            assert!(until == f64::INFINITY || compare(&rational(until), &end).is_ge(), "{self:?} {answer:?}");
        }
        let [from, last] = answer.entry;
        if begins_inside || at_origin.is_eq() {
            assert_eq!(answer.entry, [0.0; 2], "{self:?} {answer:?}");
        } else {
            assert!(from >= 0.0 && compare(&zero, &rational(from)).is_ge(), "{self:?} {answer:?}");
            assert!(last == f64::INFINITY || compare(&zero, &rational(last)).is_le(), "{self:?} {answer:?}");
        }
    }

    fn check_surface(&self, answer: &RayAnswer) {
        let normal = Vector::from(answer.normal);
        assert!((normal.norm() - 1.0).abs() < 1e-12, "{self:?} {answer:?}");
        let Ray { origin, direction, .. } = self.ray;
        // In units that keep squares among the doubles.
        let largest = self.points.iter().map(|p| p.amax()).fold(self.radius, f64::max);
        let world = self.points.iter().map(|p| self.pose.rotate(&(p / largest)));
        let from = (Vector::from(origin) - self.pose.translation()) / largest;
        let advanced = Vector::from(direction) * answer.entry[0] / largest;
        let entry = from + advanced;
        let size = 1.0 + from.amax() + advanced.amax();
        if !(size < 1e100) {
            return;
        }
        let highest = world.map(|point| normal.dot(&(point - entry))).fold(f64::NEG_INFINITY, f64::max);
        assert!((highest + self.radius / largest).abs() <= 1e-9 * size, "{self:?} {answer:?}");
    }
}

/// A ball over the points of another case: of a length of theirs, or such that it reaches the ray, or its origin, up to roundings.
pub fn swept(random: &mut Random, case: Case) -> SweptCase {
    let Case { points, pose, ray, .. } = case;
    let mut swept = SweptCase { points, radius: 0.0, pose, ray };
    let largest = swept.points.iter().map(|p| p.amax()).fold(f64::MIN_POSITIVE, f64::max);
    let radius = match random.below(6) {
        0 => swept.distance(false),
        1 => swept.distance(true),
        2 => largest * random.pick(&[1e-30, 1e-12, 1e-3, 1e3, 1e30]),
        3 => largest * random.uniform(0.0, 2.0),
        _ => largest * random.pick(&[0.25, 0.5, 1.0, 1.25, 2.0, 2.5, 5.0]),
    };
    let radius = match random.below(4) {
        0 => radius.next_up(),
        1 => radius.next_down(),
        _ => radius,
    };
    swept.radius = radius.clamp(f64::MIN_POSITIVE, LARGEST_SWEPT_RADIUS);
    swept
}

/// A power of two.
fn power(exponent: isize) -> RBig {
    let size = RBig::from(IBig::ONE << exponent.unsigned_abs());
    if exponent < 0 { RBig::ONE / size } else { size }
}
