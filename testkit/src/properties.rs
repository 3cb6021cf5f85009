//! What every answer must satisfy, whatever the cache held.

use std::fmt;
use std::ops::AddAssign;

use swiftprox::math::{Pose, UNIT_ROUNDOFF as U, Vector};
use swiftprox::pair::contact;
use swiftprox::pair::{
    DecidedBy, Feature, FeatureKind, Outcome, PairAnswer, PairCache, PairConfig, distance, intersection,
};
use swiftprox::shape::Shape;
use swiftprox::verify::verify;

use crate::bodies::Body;
use crate::caches::{WORDS, cache_of_words};
use crate::cases::{Case, Random};

/// Two bodies at their poses.
#[derive(Clone, Copy)]
pub struct Placed<'a> {
    pub bodies: [&'a Body; 2],
    pub poses: [Pose; 2],
}

impl Placed<'_> {
    fn swapped(&self) -> Self {
        let [body1, body2] = self.bodies;
        let [pose1, pose2] = self.poses;
        Placed { bodies: [body2, body1], poses: [pose2, pose1] }
    }

    fn describe(&self) -> String {
        let one = |i: usize| format!("{}\nat {:?}", self.bodies[i].describe(), self.poses[i].rows);
        format!("1: {}\n2: {}", one(0), one(1))
    }
}

/// A property that does not hold, and everything to repeat it.
pub struct Violation {
    pub property: &'static str,
    pub detail: String,
}

/// How many queries ended how.
#[derive(Default, Clone, Copy)]
pub struct Tally {
    pub pairs: usize,
    pub queries: usize,
    intersecting: usize,
    by_decider: [usize; 9],
    /// The most that one query took.
    pub most: Work,
}

/// Steps of marching, iterations of Gilbert-Johnson-Keerthi in floating point, iterations in integers.
#[derive(Debug, Default, Clone, Copy)]
pub struct Work(pub [u32; 3]);

impl Work {
    fn of(answer: &PairAnswer) -> Work {
        let statistics = &answer.statistics;
        Work([statistics.marching_steps, statistics.fallback_iterations, statistics.exact_iterations])
    }

    /// The larger of each.
    pub fn max(self, other: Work) -> Work {
        Work(std::array::from_fn(|i| self.0[i].max(other.0[i])))
    }
}

impl AddAssign for Tally {
    fn add_assign(&mut self, other: Tally) {
        self.pairs += other.pairs;
        self.queries += other.queries;
        self.intersecting += other.intersecting;
        for (mine, others) in self.by_decider.iter_mut().zip(other.by_decider) {
            *mine += others;
        }
        self.most = self.most.max(other.most);
    }
}

impl fmt::Display for Tally {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        let [_, marched, coherent, fallback, exact, _, _, apart, within] = self.by_decider;
        let spheres = apart + within;
        let Tally { pairs, queries, intersecting, .. } = self;
        write!(f, "{pairs} pairs, {queries} queries ({intersecting} intersecting): ")?;
        write!(f, "{marched} marched, {coherent} coherent, {spheres} spheres, {fallback} fallback, {exact} exact; ")?;
        let Work([steps, iterations, exact_iterations]) = self.most;
        write!(f, "at most {steps} steps, {iterations} iterations, {exact_iterations} in integers")
    }
}

/// What the queries of a chunk hand from one to the next.
pub struct Session {
    pub random: Random,
    /// The cache of the pair at hand, kept while it moves or jumps.
    pub own: PairCache,
    /// A cache that goes from pair to pair.
    pub foreign: PairCache,
    pub tally: Tally,
    pub violations: Vec<Violation>,
}

impl Session {
    pub fn new(seed: u64) -> Session {
        Session {
            random: Random::new(seed),
            own: PairCache::default(),
            foreign: PairCache::default(),
            tally: Tally::default(),
            violations: Vec::new(),
        }
    }

    /// Every query about a placed pair, from every kind of cache. The answer to [`distance`] from a cold one, if there is one.
    pub fn check(&mut self, placed: &Placed) -> Option<PairAnswer> {
        self.tally.pairs += 1;
        let found = self.violations.len();
        let cold = self.ask(Question::Distance, placed, &mut PairCache::default());
        if let Some(cold) = &cold {
            self.check_other_queries(placed, cold);
        }
        for violation in &mut self.violations[found..] {
            violation.detail = format!("{}\n{}", violation.detail, placed.describe());
        }
        cold
    }

    /// One of the other queries, every eighth time all: each agrees with the answer from a cold cache.
    fn check_other_queries(&mut self, placed: &Placed, cold: &PairAnswer) {
        let all = self.random.below(8) == 0;
        let one = self.random.below(OTHER_QUERIES.len());
        for (property, question, origin) in if all { OTHER_QUERIES } else { &OTHER_QUERIES[one..=one] } {
            let mut cache = match origin {
                Origin::Swapped => PairCache::default(),
                Origin::Own | Origin::OwnKept => self.own,
                Origin::ForeignKept => self.foreign,
                Origin::Garbage => garbage_cache(&mut self.random, placed),
            };
            let placed = if matches!(origin, Origin::Swapped) { placed.swapped() } else { *placed };
            let answer = self.ask(*question, &placed, &mut cache);
            self.compare(property, cold, answer);
            match origin {
                Origin::OwnKept => self.own = cache,
                Origin::ForeignKept => self.foreign = cache,
                Origin::Swapped | Origin::Own | Origin::Garbage => (),
            }
        }
        if self.random.below(512) == 0 && placed.bodies.iter().all(|body| body.points.len() <= 10) {
            self.violations.extend(against_truth(placed, cold).err());
        }
    }

    /// Two answers about one pair: the same verdict, intervals with a common point (both hold the truth).
    fn compare(&mut self, property: &'static str, cold: &PairAnswer, other: Option<PairAnswer>) {
        let Some(other) = other else { return };
        if cold.outcome != other.outcome || cold.lower > other.upper || other.lower > cold.upper {
            self.violations.push(Violation { property, detail: format!("{cold:?}\nbut {other:?}") });
        }
    }

    /// One query, its answer checked by itself.
    fn ask(&mut self, question: Question, placed: &Placed, cache: &mut PairCache) -> Option<PairAnswer> {
        let query = match question {
            Question::Distance => distance,
            Question::Contact => contact,
            Question::Intersection => intersection,
        };
        let config = PairConfig::default();
        let ([body1, body2], [pose1, pose2]) = (placed.bodies, &placed.poses);
        let before = *cache;
        let mut answer = PairAnswer::default();
        let asked = query([body1.shape.at(pose1), body2.shape.at(pose2)], cache, &config, &mut answer);
        self.tally.queries += 1;
        self.tally.intersecting += usize::from(answer.outcome == Outcome::Intersecting);
        self.tally.by_decider[answer.decided_by as usize] += 1;
        self.tally.most = self.tally.most.max(Work::of(&answer));
        let answered = asked.is_ok();
        let verified = asked.map_err(|e| violation("an answer", e.to_string())).and_then(|()| {
            let verified = verify([body1.shape.at(pose1), body2.shape.at(pose2)], &answer);
            verified.map_err(|e| violation("verify", e.to_string()))
        });
        let is_tight = matches!(question, Question::Distance | Question::Contact);
        let checks = [
            verified,
            check_interval(placed, &answer, is_tight),
            check_points(placed, &answer),
            check_work(placed, &answer),
        ];
        for Violation { property, detail } in checks.into_iter().filter_map(Result::err) {
            let detail = format!("{detail}; {question:?} from {before:?}: {answer:?}");
            self.violations.push(Violation { property, detail });
        }
        answered.then_some(answer)
    }
}

#[derive(Debug, Clone, Copy, PartialEq)]
enum Question {
    Distance,
    Contact,
    Intersection,
}

/// Where a query's cache comes from.
#[derive(Clone, Copy)]
enum Origin {
    /// A cold cache, the objects swapped.
    Swapped,
    /// The pair's last query, itself left as it was.
    Own,
    /// The pair's last query, which this one replaces.
    OwnKept,
    /// Some query about another pair or this.
    ForeignKept,
    Garbage,
}

/// What each must agree with the answer to `distance` from a cold cache in.
const OTHER_QUERIES: &[(&str, Question, Origin)] = &[
    ("swapped objects", Question::Distance, Origin::Swapped),
    ("contact", Question::Contact, Origin::Own),
    ("intersection", Question::Intersection, Origin::Own),
    ("a warm cache", Question::Distance, Origin::OwnKept),
    ("a warm cache, nothing moved", Question::Distance, Origin::OwnKept),
    ("another pair's cache", Question::Distance, Origin::ForeignKept),
    ("another pair's cache, contact", Question::Contact, Origin::ForeignKept),
    ("a cache of garbage", Question::Distance, Origin::Garbage),
    ("a cache of garbage, contact", Question::Contact, Origin::Garbage),
    ("a cache of garbage, intersection", Question::Intersection, Origin::Garbage),
];

/// Any bytes, or bytes that look like a cache's: small kinds and indices near the pair's own counts.
fn garbage_cache(random: &mut Random, placed: &Placed) -> PairCache {
    let mut words = [(); WORDS].map(|()| random.next_u64() as u32);
    if random.below(4) != 0 {
        words[0] = random.below(14) as u32;
        let most = placed.bodies.map(|body| body.points.len());
        for word in &mut words[1..11] {
            let body = random.below(2);
            *word = random.below(most[body] + 2) as u32;
        }
    }
    cache_of_words(words)
}

fn violation(property: &'static str, detail: String) -> Violation {
    Violation { property, detail }
}

/// `Ok` if `holds`.
fn require(holds: bool, property: &'static str, detail: impl FnOnce() -> String) -> Result<(), Violation> {
    if holds { Ok(()) } else { Err(violation(property, detail())) }
}

/// One step where the last query ended and sixteen from there, then 64 and one for each vertex of the larger body; 128
/// iterations of Gilbert-Johnson-Keerthi in floating point. Those in integers end by a proof, not by a count.
fn check_work(placed: &Placed, answer: &PairAnswer) -> Result<(), Violation> {
    let excess = excess_work_without_levels(placed.bodies.map(|body| &body.shape), answer);
    require(excess.is_none(), "bounded work", || excess.unwrap_or_default())
}

/// What a query without levels of detail did more than it may.
pub fn excess_work_without_levels(shapes: [&Shape; 2], answer: &PairAnswer) -> Option<String> {
    let larger = shapes.map(|shape| shape.polyhedron().vertices.len() as u32).into_iter().fold(0, u32::max);
    let Work([steps, iterations, _]) = Work::of(answer);
    let holds = steps <= 1 + 16 + 64 + larger && iterations <= 128;
    (!holds).then(|| format!("{steps} steps, {iterations} iterations, {larger} vertices"))
}

fn check_interval(placed: &Placed, answer: &PairAnswer, is_tight: bool) -> Result<(), Violation> {
    let PairAnswer { outcome, decided_by, lower, upper, .. } = *answer;
    let is_verdict = matches!(outcome, Outcome::Separated | Outcome::Intersecting) && decided_by != DecidedBy::None;
    require(is_verdict, "a verdict", String::new)?;
    require((upper > 0.0) == (outcome == Outcome::Separated), "upper > 0 iff separated", String::new)?;
    let size = placed.bodies[0].radius() + placed.bodies[1].radius();
    let allowed = 2e-14 * size.max(upper);
    require(!is_tight || upper - lower <= allowed, "a tight interval", || {
        format!("{:e} wide, allowed {allowed:e}", upper - lower)
    })
}

/// Witness points, normal and features, where they are said. In units of about the larger of size and distance, so that no
/// square leaves the range of doubles.
fn check_points(placed: &Placed, answer: &PairAnswer) -> Result<(), Violation> {
    if answer.feature1.kind == FeatureKind::None {
        return Ok(());
    }
    let reach = placed.bodies[0].reach() + placed.bodies[1].reach();
    let unit = 1.0 / reach.max(answer.upper).clamp(1e-300, 1e300);
    let [local1, local2, world1, world2] =
        [answer.local1, answer.local2, answer.world1, answer.world2].map(|p| Vector::from(p) * unit);
    let normal = Vector::from(answer.normal);
    let is_unit = (normal.norm_squared() - 1.0).abs() <= 16.0 * U;
    require(is_unit, "a unit normal", || format!("{:e}", normal.norm_squared() - 1.0))?;
    for (i, (local, world)) in [(local1, world1), (local2, world2)].iter().enumerate() {
        let translation = placed.poses[i].translation() * unit;
        let error = (world - translation - placed.poses[i].rotate(local)).norm();
        let allowed = 32.0 * U * (placed.bodies[i].reach() * unit + translation.norm());
        require(error <= allowed, "world = pose · local", || format!("off by {:e}", error / unit))?;
    }
    let between = world1 - world2;
    let allowed = 64.0 * U * (reach + answer.upper) * unit + 8.0 * U * (world1.norm() + world2.norm());
    if answer.outcome == Outcome::Intersecting {
        // As wide as the widest interval of a hard pair, 1e-13·(size + 2e-3·reach of the world), and rounding.
        let allowed = allowed + 1e-13 * (reach * unit + 2e-3 * world1.amax().max(world2.amax()));
        return require(between.norm() <= allowed, "one common point", || {
            format!("{:e} apart, rounding {:e}", between.norm() / unit, allowed / unit)
        });
    }
    // Together: the angle between them is at most √(2·(upper − lower)/distance).
    let along = normal.dot(&between);
    let holds = along >= answer.lower * unit - allowed && between.norm() <= answer.upper * unit + allowed;
    require(holds, "normal along points", || {
        let [along, across, allowed] = [along, between.norm(), allowed].map(|x| x / unit);
        format!("{along:e} along the normal, {across:e} between the points, rounding {allowed:e}")
    })?;
    for (i, (feature, local)) in [(&answer.feature1, local1), (&answer.feature2, local2)].into_iter().enumerate() {
        let body = placed.bodies[i];
        // A point is nearest, and so on the surface, as far as the interval tells: a large partner widens it.
        let allowed = (64.0 * U * (body.reach() + answer.upper) + (answer.upper - answer.lower)) * unit;
        check_feature(body, feature, &local, unit, allowed).map_err(|what| {
            let property = match feature.kind {
                FeatureKind::None => "a feature",
                FeatureKind::Vertex => "the vertex is the witness point",
                FeatureKind::Edge => "the edge holds the witness point",
                FeatureKind::Face => "the face holds the witness point",
            };
            violation(property, format!("object {}: {what}, rounding {:e}", i + 1, allowed / unit))
        })?;
    }
    Ok(())
}

/// The feature is one of the body, in the caller's numbering, and holds the point, which is given in the unit.
fn check_feature(body: &Body, feature: &Feature, point: &Vector, unit: f64, allowed: f64) -> Result<(), String> {
    let [first, second] = feature.ids.map(|id| id as usize);
    let vertex = |id: usize| body.points.get(id).map(|p| p * unit).ok_or(format!("no vertex {id}"));
    let misses = match feature.kind {
        FeatureKind::None => return Err("none".into()),
        FeatureKind::Vertex if vertex(first)? == *point => 0.0,
        FeatureKind::Vertex => return Err("another point than the vertex".into()),
        FeatureKind::Edge => {
            if !body.has_edge(feature.ids) {
                return Err("no edge".into());
            }
            distance_to_segment(point, &vertex(first)?, &vertex(second)?)
        }
        FeatureKind::Face => {
            let corners = body.polygons.get(first).ok_or(format!("no face {first}"))?;
            let corners = corners.iter().map(|p| p * unit).collect::<Vec<_>>();
            distance_to_polygon(point, &corners)
        }
    };
    if misses <= allowed { Ok(()) } else { Err(format!("{:e} from the feature", misses / unit)) }
}

fn distance_to_segment(point: &Vector, a: &Vector, b: &Vector) -> f64 {
    let along = b - a;
    // The length may be too small for its square.
    let largest = along.amax().max(f64::MIN_POSITIVE);
    let direction = along / largest;
    let t = (point - a).dot(&direction) / largest / direction.norm_squared().max(f64::MIN_POSITIVE);
    (point - a - along * t.clamp(0.0, 1.0)).norm()
}

/// Distance to a point of the convex polygon, the nearest up to rounding: in each triangle of a fan the best inside or on a
/// side.
fn distance_to_polygon(point: &Vector, corners: &[Vector]) -> f64 {
    let triangles = (2..corners.len()).map(|k| {
        let [a, b, c] = [corners[0], corners[k - 1], corners[k]];
        let sides = [(a, b), (b, c), (c, a)].map(|(p, q)| distance_to_segment(point, &p, &q));
        sides.into_iter().fold(distance_to_inside(point, &a, &b, &c), f64::min)
    });
    triangles.fold(f64::INFINITY, f64::min)
}

/// Distance to the foot of the perpendicular in a triangle, or +∞ if it lies outside. By orthogonal directions in the plane,
/// not by normal equations, which lose the inside of a sliver.
fn distance_to_inside(point: &Vector, a: &Vector, b: &Vector, c: &Vector) -> f64 {
    let (u, v, w) = (b - a, c - a, point - a);
    let along = u.normalize();
    let (v_along, w_along) = (v.dot(&along), w.dot(&along));
    let (v_across, w_across) = (v - along * v_along, w - along * w_along);
    let t = w_across.dot(&v_across) / v_across.norm_squared();
    let s = (w_along - v_along * t) / u.norm();
    if s >= 0.0 && t >= 0.0 && s + t <= 1.0 { (w - u * s - v * t).norm() } else { f64::INFINITY }
}

/// Against exact rationals.
fn against_truth(placed: &Placed, answer: &PairAnswer) -> Result<(), Violation> {
    let [points_a, points_b] = placed.bodies.map(|body| body.points.clone());
    let case = Case { points_a, pose_a: placed.poses[0], points_b, pose_b: placed.poses[1] };
    let truth = case.truth();
    let holds = truth.intersecting() == (answer.outcome == Outcome::Intersecting)
        && truth.lies_between(answer.lower, answer.upper);
    require(holds, "the truth", || format!("{answer:?}, the truth is {truth:?}\n{}", case.describe()))
}
