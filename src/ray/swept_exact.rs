//! A ray cast at a body with a swept radius in integers, for any magnitudes.
//!
//! There is one query: whether a stretch of the line is within the radius of the hull. Among stretches from the ray's origin the
//! longer ones are; the ray enters where the answer changes. Among stretches to its end the earlier ones are, up to where it
//! leaves. Both places are found between neighbouring doubles by bisection, from where doubles have them.

use std::cmp::Ordering;

use dashu_int::IBig;

use super::{Ray, RayAnswer, RayOutcome};
use crate::answer::{feature_of_vertices, label, normalised};
use crate::base::math::{Pose, Vector};
use crate::base::predicates::mantissa_and_exponent;
use crate::body::polyhedron::Polyhedron;
use crate::placed::exact::dyadic::bounds_of_quotient_by_root;
use crate::placed::exact::{BesideLine, LinePlace};

/// Casts the ray anew; `guess` is where doubles have both ends, or NaN.
pub(super) fn cast(polyhedron: &Polyhedron, pose: &Pose, ray: &Ray, radius: f64, guess: [f64; 2]) -> RayAnswer {
    debug_assert!(radius > 0.0);
    let cast = SweptCast { line: BesideLine::new(polyhedron, pose, ray.origin, ray.direction), radius };
    let end = if ray.t_max < f64::INFINITY { CastStep::of(ray.t_max) } else { beyond(polyhedron, pose, ray, radius) };
    let mut answer = RayAnswer { outcome: RayOutcome::Miss, exact: 1, ..RayAnswer::default() };
    if cast.compare(CastStep::FIRST, end).is_gt() {
        return answer;
    }
    let origin = cast.line.nearest([CastStep::FIRST.place(); 2]);
    let at_origin = origin.compare(radius);
    // On the surface the slope tells whether the line comes in or goes out there, or grazes.
    let slope = if at_origin.is_eq() { origin.slope() } else { Ordering::Equal };
    let goes_out = slope.is_gt();
    let begins_inside = at_origin.is_lt() || goes_out || (at_origin.is_eq() && slope.is_eq() && cast.is_in(BEFORE));
    answer.exit = if cast.compare(end, end).is_le() {
        [ray.t_max; 2]
    } else if goes_out {
        [0.0; 2]
    } else {
        cast.exit(end, guess[1])
    };
    if begins_inside {
        answer.outcome = RayOutcome::Inside;
        answer.entry = [0.0; 2];
        return answer;
    }
    answer.outcome = RayOutcome::Hit;
    // Outside the body or on its surface, as near to where the ray comes in as doubles are.
    let at;
    (at, answer.entry) = if at_origin.is_gt() { cast.entry(end, guess[0]) } else { (CastStep::FIRST, [0.0; 2]) };
    let nearest = cast.line.nearest([at.place(); 2]).answer();
    let normal = -nearest.direction;
    answer.normal = normalised(&normal);
    let vertices: Vec<u32> = nearest.pairs.iter().map(|pair| pair[0]).collect();
    let weighted = nearest.weights.iter().zip(&vertices);
    let point: Vector = weighted.map(|(weight, &v)| polyhedron.vertices[v as usize].position * *weight).sum();
    let feature = feature_of_vertices(polyhedron, &vertices, &point, &pose.rotate_back(&normal), 0.0);
    answer.feature = label(polyhedron, feature, &point);
    answer
}

struct SweptCast<'a> {
    line: BesideLine<'a>,
    radius: f64,
}

impl SweptCast<'_> {
    /// How far the stretch between two places is from the hull, against the radius.
    fn compare(&self, from: CastStep, to: CastStep) -> Ordering {
        self.line.nearest([from, to].map(CastStep::place)).compare(self.radius)
    }

    fn is_in(&self, place: LinePlace) -> bool {
        self.line.nearest([place; 2]).compare(self.radius).is_le()
    }

    /// The entry of a ray that begins outside: the last place before that is known, and an interval.
    fn entry(&self, end: CastStep, guess: f64) -> (CastStep, [f64; 2]) {
        let [outside, inside] = change([CastStep::FIRST, end], guess, |at| self.compare(CastStep::FIRST, at).is_le());
        // At the radius all along, and nearer right afterwards: it is there, as distances along a line are convex.
        let is_there =
            self.compare(CastStep::FIRST, inside).is_eq() && self.compare(CastStep::FIRST, inside.next()).is_lt();
        let from = if is_there { inside } else { outside };
        (from, [from.bounds()[0], inside.bounds()[1]])
    }

    /// The exit of a ray that ends outside.
    fn exit(&self, end: CastStep, guess: f64) -> [f64; 2] {
        let [inside, outside] = change([CastStep::FIRST, end], guess, |at| self.compare(at, end).is_gt());
        let is_there = inside != CastStep::FIRST
            && self.compare(inside, end).is_eq()
            && self.compare(inside.previous(), end).is_lt();
        [inside.bounds()[0], if is_there { inside } else { outside }.bounds()[1]]
    }
}

/// The neighbouring steps between which a test becomes true, given two of which the second passes it. A guess is tried first.
fn change([mut before, mut after]: [CastStep; 2], guess: f64, test: impl Fn(CastStep) -> bool) -> [CastStep; 2] {
    debug_assert!(before < after);
    let mut stride = 1;
    let mut at = if guess > 0.0 && guess < f64::INFINITY { CastStep::of(guess) } else { CastStep::FIRST };
    let mut gallops_back = None;
    while before < at && at < after {
        let passes = test(at);
        if passes {
            after = at
        } else {
            before = at
        }
        if *gallops_back.get_or_insert(passes) != passes {
            break;
        }
        at = if passes { CastStep(at.0.saturating_sub(stride)) } else { CastStep(at.0 + stride) };
        stride *= 2;
    }
    while before.next() < after {
        let middle = CastStep(before.0 + (after.0 - before.0) / 2);
        if test(middle) { after = middle } else { before = middle }
    }
    [before, after]
}

/// Places from 0 on in order, as the bits of doubles are, with exponents that reach farther: a biased exponent, and 52 bits of the
/// mantissa.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
struct CastStep(u64);

/// The biased exponent of 1: that of the least double and of the farthest place of a line in a body, 2^2110, fit in twelve bits.
const BIAS: i32 = 1200;

/// Nearer to 0 than any place but 0 at which a line that grazes a body begins to. With coordinates of 4,400 bits, over one power of
/// two, that is a quotient of polynomials of at most the ninth degree in them: its denominator has less bits than this.
const BEFORE: LinePlace = LinePlace { mantissa: -1, exponent: -65_536 };

impl CastStep {
    const FIRST: CastStep = CastStep(0);

    /// The step of a double from 0 on; infinity is 2^1024, as its bits go on.
    fn of(t: f64) -> CastStep {
        debug_assert!(t >= 0.0);
        let (mantissa, exponent) = mantissa_and_exponent(t);
        if mantissa == 0 {
            return CastStep::FIRST;
        }
        // So that bit 52 leads.
        let shift = mantissa.leading_zeros() - 11;
        CastStep::new((mantissa as u64) << shift, exponent + 52 - shift as i32)
    }

    /// `mantissa`/2⁵² · 2^exponent, from 1 to 2 and no zero bits above.
    fn new(mantissa: u64, exponent: i32) -> CastStep {
        debug_assert!(mantissa >> 52 == 1 && (1..4096).contains(&(exponent + BIAS)), "{mantissa:x} {exponent}");
        CastStep(((exponent + BIAS) as u64) << 52 | (mantissa & ((1 << 52) - 1)))
    }

    fn place(self) -> LinePlace {
        if self == CastStep::FIRST {
            return LinePlace { mantissa: 0, exponent: 0 };
        }
        let mantissa = self.0 & ((1 << 52) - 1) | 1 << 52;
        LinePlace { mantissa: mantissa as i64, exponent: (self.0 >> 52) as i32 - BIAS - 52 }
    }

    fn next(self) -> CastStep {
        CastStep(self.0 + 1)
    }

    fn previous(self) -> CastStep {
        debug_assert!(self > CastStep::FIRST);
        CastStep(self.0 - 1)
    }

    /// The doubles next to it, below and above; both itself where it is one.
    fn bounds(self) -> [f64; 2] {
        let LinePlace { mantissa, exponent } = self.place();
        if mantissa == 0 {
            return [0.0; 2];
        }
        let (below, above) = bounds_of_quotient_by_root(&IBig::from(mantissa), &IBig::ONE, exponent);
        [below, above]
    }
}

/// A place from which on a ray is outside the body. No coordinate of the body is larger than 1.02·√3 times those of two vectors in
/// its own axes, and of one in the world, and the radius: less than 8 times the largest. There, 16 times it are behind the ray. (A
/// body's radius that overflows is less than 2^1025.)
fn beyond(polyhedron: &Polyhedron, pose: &Pose, ray: &Ray, radius: f64) -> CastStep {
    let lengths = [ray.origin().amax(), pose.translation().amax(), polyhedron.centre.amax(), polyhedron.radius, radius];
    let largest = lengths.iter().map(|length| CastStep::of(*length)).max().unwrap_or(CastStep::FIRST);
    let exponent = |step: CastStep| (step.0 >> 52) as i32 - BIAS;
    // Less than twice the power of two with this exponent.
    CastStep::new(1 << 52, exponent(largest).max(-1074) + 5 - exponent(CastStep::of(ray.direction().amax())))
}
