//! Depths of small pairs against exact integers by another algorithm: the least support of the Minkowski difference over a set of
//! directions that holds the normals of all its facets.

use dashu_int::IBig;
use swiftprox::math::{Matrix, Pose, Vector};
use swiftprox::pair::{DepthAnswer, DepthCache, Outcome};
use swiftprox::shape::Shape;
use swiftprox::verify::verify_depth;

use crate::resting::is_by_facet;
use crate::{Random, query};
use testkit::random::rotation;
use testkit::shapes::hull;

type Integers = [i128; 3];

/// Vertices are multiples of this, up to 1 in magnitude.
const VERTEX_UNIT: f64 = 1.0 / 1024.0;
/// Entries of rotations are multiples of this: these are as skewed as that makes them.
const ROTATION_UNIT: f64 = 1.0 / 4096.0;
/// World coordinates are multiples of this.
const UNIT: f64 = VERTEX_UNIT * ROTATION_UNIT;

fn minus(a: &Integers, b: &Integers) -> Integers {
    [0, 1, 2].map(|k| a[k] - b[k])
}

fn dot(a: &Integers, b: &Integers) -> i128 {
    (0..3).map(|k| a[k] * b[k]).sum()
}

fn cross(a: &Integers, b: &Integers) -> Integers {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

/// World vertices in units of [`UNIT`].
fn placed(points: &[Vector], pose: &Pose) -> Vec<Integers> {
    let integer = |x: f64, unit: f64| {
        let value = x / unit;
        assert_eq!(value, value.round(), "{x} is no multiple of {unit}");
        value as i128
    };
    let place = |p: &Vector| {
        [0, 1, 2].map(|k| {
            let row = &pose.rows[k];
            let rotated = (0..3).map(|j| integer(row[j], ROTATION_UNIT) * integer(p[j], VERTEX_UNIT)).sum::<i128>();
            rotated + integer(row[3], UNIT)
        })
    };
    points.iter().map(place).collect()
}

/// A support of the Minkowski difference: height/√square.
struct Support {
    height: i128,
    square: i128,
}

impl Support {
    fn about(&self) -> f64 {
        self.height as f64 / (self.square as f64).sqrt() * UNIT
    }

    /// Whether it is at least, or at most, a number from 0 on, exactly; the support from 0 on, too.
    fn is_at_least(&self, bound: f64) -> bool {
        self.compare(bound).is_ge()
    }

    fn compare(&self, bound: f64) -> std::cmp::Ordering {
        let bits = bound.to_bits();
        let exponent = (bits >> 52) as i32;
        let (mantissa, exponent) =
            if exponent == 0 { (bits, -1074) } else { (bits & ((1 << 52) - 1) | 1 << 52, exponent - 1075) };
        // height·2⁻²² / √square against mantissa·2^exponent.
        let shift = 2 * (exponent + 22);
        let left = IBig::from(self.height) * IBig::from(self.height);
        let right = IBig::from(mantissa) * IBig::from(mantissa) * IBig::from(self.square);
        if shift >= 0 { left.cmp(&(right << shift as usize)) } else { (left << -shift as usize).cmp(&right) }
    }
}

/// The supports along all directions that may be normals of facets: of planes through three vertices of a body, and across lines
/// through two vertices of each.
fn supports(bodies: [&[Integers]; 2]) -> Vec<Support> {
    let lines = bodies.map(|points| {
        let mut lines = Vec::new();
        for (i, p) in points.iter().enumerate() {
            lines.extend(points[..i].iter().map(|q| minus(p, q)));
        }
        lines
    });
    let mut directions = Vec::new();
    for own in &lines {
        directions.extend(own.iter().enumerate().flat_map(|(i, e)| own[..i].iter().map(move |g| cross(e, g))));
    }
    directions.extend(lines[0].iter().flat_map(|e| lines[1].iter().map(move |g| cross(e, g))));
    // Where the Minkowski difference is flat, those in its plane are what separates; where it is a line, that.
    if let Some(normal) = directions.iter().find(|d| **d != [0; 3]).copied() {
        let is_flat = directions.iter().all(|d| cross(d, &normal) == [0; 3]);
        let in_plane = lines.iter().flatten().map(|e| cross(e, &normal));
        directions.extend(in_plane.filter(|_| is_flat));
    } else {
        directions.extend(lines.iter().flatten());
        directions.extend(lines.iter().flatten().flat_map(|e| [[1, 0, 0], [0, 1, 0], [0, 0, 1]].map(|x| cross(e, &x))));
    }
    directions.extend([[1, 0, 0], [0, 1, 0], [0, 0, 1]]);
    let both = directions.into_iter().filter(|d| *d != [0; 3]).flat_map(|d| [d, d.map(|x| -x)]);
    both.map(|direction| {
        let high = bodies[0].iter().map(|p| dot(&direction, p)).max().unwrap();
        let low = bodies[1].iter().map(|p| dot(&direction, p)).min().unwrap();
        // It saturates for directions in flat Minkowski differences alone, whose depth is 0.
        let square = direction.iter().fold(0_i128, |sum, x| sum.saturating_add(x.saturating_mul(*x)));
        Support { height: high - low, square }
    })
    .collect()
}

fn points(random: &mut Random, kind: usize) -> Vec<Vector> {
    let count = 1 + random.below(6);
    let scale = Vector::from([[1.0, 1.0, 1.0], [1.0, 1.0, 0.0], [1.0, 1.0, 0.01], [1.0, 0.02, 0.02]][kind % 4]);
    let coarse = kind.is_multiple_of(3);
    let point = |random: &mut Random| match coarse {
        true => random.lattice(2).component_mul(&scale.map(f64::ceil)) * 0.25,
        false => random.vector().component_mul(&scale).map(|x| (x / VERTEX_UNIT).round() * VERTEX_UNIT),
    };
    (0..count.max(if kind.is_multiple_of(5) { 1 } else { 4 })).map(|_| point(random)).collect()
}

fn pose(random: &mut Random, kind: usize, reach: f64) -> Pose {
    let rotation = match kind % 3 {
        0 => random.quarter_turns(),
        _ => random.rotation().map(|x| (x / ROTATION_UNIT).round() * ROTATION_UNIT),
    };
    let unit = if kind.is_multiple_of(3) { 0.125 } else { UNIT };
    Pose::new(&rotation, &(random.vector() * reach).map(|x| (x / unit).round() * unit))
}

/// What was seen of many pairs.
#[derive(Default)]
struct Seen {
    overlapping: usize,
    touching: usize,
    separated: usize,
    /// Pairs whose depth all facets told.
    by_facets: usize,
    /// Answers that a facet of before gave.
    at_rest: usize,
    widest: f64,
}

impl Seen {
    /// Asks for a depth, cold and again, and compares it with the exact one.
    fn add(&mut self, bodies: [&[Vector]; 2], shapes: [&Shape; 2], poses: [&Pose; 2]) {
        self.ask(bodies, shapes, poses, &mut DepthCache::default());
    }

    /// The same with what a cache holds.
    fn ask(&mut self, bodies: [&[Vector]; 2], shapes: [&Shape; 2], poses: [&Pose; 2], cache: &mut DepthCache) {
        let placed = [placed(bodies[0], poses[0]), placed(bodies[1], poses[1])];
        let supports = supports([&placed[0], &placed[1]]);
        let least = supports.iter().map(|support| support.height).min().unwrap();
        self.overlapping += usize::from(least > 0);
        self.touching += usize::from(least == 0);
        self.separated += usize::from(least < 0);
        for _ in 0..2 {
            let answer: DepthAnswer = query(shapes, poses, cache);
            let told = || format!("{bodies:?} {poses:?} {answer:?}");
            verify_depth([shapes[0].at(poses[0]), shapes[1].at(poses[1])], cache, &answer)
                .unwrap_or_else(|error| panic!("{error}: {}", told()));
            if least < 0 {
                assert_eq!(answer.outcome, Outcome::Separated, "{}", told());
                assert_eq!((answer.lower, answer.depth, answer.upper), (0.0, 0.0, 0.0));
                continue;
            }
            assert_eq!(answer.outcome, Outcome::Intersecting, "{}", told());
            assert!(answer.lower <= answer.depth && answer.depth <= answer.upper, "{}", told());
            if least == 0 {
                assert_eq!((answer.lower, answer.upper), (0.0, 0.0), "{}", told());
            } else {
                assert!(answer.upper > 0.0, "{}", told());
            }
            self.by_facets += usize::from(answer.lower > 0.0 && answer.statistics.triangles == 0);
            self.at_rest += usize::from(is_by_facet(&answer));
            let truth = supports.iter().map(Support::about).fold(f64::INFINITY, f64::min);
            let near = |support: &&Support| support.about() <= truth * (1.0 + 1e-12);
            let nearest: Vec<&Support> = supports.iter().filter(near).collect();
            assert!(nearest.iter().all(|support| support.is_at_least(answer.lower)), "{truth:e} {}", told());
            assert!(nearest.iter().any(|support| support.compare(answer.upper).is_le()), "{truth:e} {}", told());
            let size: f64 = shapes.iter().map(|shape| shape.polyhedron().radius).sum();
            let apart = (poses[0].translation() - poses[1].translation()).norm();
            let width = (answer.upper - answer.lower) / size.max(apart).max(f64::MIN_POSITIVE);
            self.widest = self.widest.max(width);
            assert!(width <= 2e-14, "{width:e} {truth:e} {}", told());
            // Witness points: their difference is the translation.
            let [x, y, n] = [answer.world1, answer.world2, answer.normal].map(Vector::from);
            let off = (y - x - n * answer.depth).norm();
            assert!(off <= 1e-13 * (size + apart), "{off:e} {}", told());
        }
    }
}

#[test]
fn depths_of_small_pairs_hold_the_exact_ones() {
    let mut random = Random::new(31);
    let mut seen = Seen::default();
    for _ in 0..13_000 {
        let bodies = [0, 1].map(|_| {
            let kind = random.below(60);
            points(&mut random, kind)
        });
        let kind = random.below(60);
        let poses = [pose(&mut random, kind, 0.0), pose(&mut random, kind, 0.35)];
        let shapes = [hull(&bodies[0]), hull(&bodies[1])];
        seen.add([&bodies[0], &bodies[1]], [&shapes[0], &shapes[1]], [&poses[0], &poses[1]]);
    }
    let Seen { overlapping, touching, separated, by_facets, widest, .. } = seen;
    println!(
        "{overlapping} overlapping, {by_facets} by facets, {touching} touching, {separated} separated, {widest:e}"
    );
    assert!(overlapping > 5_000 && touching > 50 && separated > 2000, "{overlapping} {touching} {separated}");
}

/// A box, a wedge, prisms and hulls, on the grid of vertices.
fn solid(random: &mut Random) -> Vec<Vector> {
    let half = [(); 3].map(|()| random.pick(&[0.25, 0.5, 0.75]));
    let corner = |i: usize| Vector::from_fn(|k, _| if i >> k & 1 == 0 { -half[k] } else { half[k] });
    let on_grid = |p: Vector| p.map(|x| (x / VERTEX_UNIT).round() * VERTEX_UNIT);
    match random.below(4) {
        0 => (0..8).map(corner).collect(),
        1 => (0..6).map(corner).collect(),
        2 => {
            let sides = 3 + random.below(4);
            let ring = |k: usize| std::f64::consts::TAU * k as f64 / sides as f64;
            let at = |k: usize, z: f64| on_grid(Vector::new(ring(k).cos(), ring(k).sin(), z));
            (0..sides).flat_map(|k| [at(k, -half[2]), at(k, half[2])]).collect()
        }
        _ => (0..8 + random.below(5)).map(|_| on_grid(random.direction())).collect(),
    }
}

/// Solids in line with each other, tilted and yawed by as little as a rotation's entries allow, skewed up to the limit, and anyhow.
#[test]
fn depths_of_solids_hold_the_exact_ones() {
    let mut random = Random::new(32);
    let mut seen = Seen::default();
    for round in 0..700 {
        let bodies = [solid(&mut random), solid(&mut random)];
        let shapes = [hull(&bodies[0]), hull(&bodies[1])];
        let away = Vector::from(random.pick(&[[0.0, 0.0, 1.0], [0.0, 0.25, 0.75], [0.3, 0.4, 0.5], [0.1, 0.0, 0.0]]));
        let poses = [0.0, 1.0].map(|moved| {
            let turn = match round % 4 {
                0 => random.quarter_turns(),
                1 => random.quarter_turns() * rotation(&random.direction(), random.power(-11, -2)),
                _ => random.rotation(),
            };
            // A skew of 16 units in an entry is 4e-3.
            let skew = if round % 4 == 3 { 16.0 * ROTATION_UNIT } else { 0.0 };
            let turn = turn + Matrix::from_fn(|_, _| random.signed() * skew);
            let moved = (away * moved).map(|x| (x / 0.03125).round() * 0.03125);
            Pose::new(&turn.map(|x| (x / ROTATION_UNIT).round() * ROTATION_UNIT), &moved)
        });
        if poses.iter().all(|pose| pose.check().is_ok()) {
            seen.add([&bodies[0], &bodies[1]], [&shapes[0], &shapes[1]], [&poses[0], &poses[1]]);
        }
    }
    let Seen { overlapping, by_facets, widest, .. } = seen;
    println!("{overlapping} overlapping, {by_facets} by facets, {widest:e}");
    assert!(overlapping > 400 && by_facets > overlapping, "{overlapping} {by_facets}");
}

/// Solids on each other, some on an edge or a corner, that creep and lean from step to step by as little as the grid allows: most
/// answers are a facet's.
#[test]
fn depths_at_rest_hold_the_exact_ones() {
    let mut random = Random::new(33);
    let mut seen = Seen::default();
    let on_grid = |turn: Matrix| turn.map(|x| (x / ROTATION_UNIT).round() * ROTATION_UNIT);
    for round in 0..60 {
        let mut bodies = [solid(&mut random), solid(&mut random)];
        let lower = match round % 3 {
            0 => Matrix::identity(),
            _ => random.rotation(),
        };
        let mut upper = if round % 2 == 0 { rotation(&Vector::z(), random.signed()) } else { random.rotation() };
        let mut aside = random.vector() * 0.2;
        // Equal ones, one straight over the other.
        if round % 4 == 3 {
            bodies[1] = bodies[0].clone();
            (upper, aside) = (lower, Vector::zeros());
        }
        let shapes = [hull(&bodies[0]), hull(&bodies[1])];
        let mut cache = DepthCache::default();
        let deep = random.power(-11, -7);
        for _ in 0..8 {
            let turns = [on_grid(lower), on_grid(upper)];
            let heights = |i: usize| {
                let turn: &Matrix = &turns[i];
                bodies[i].iter().map(move |p| (turn * p).z)
            };
            let above = heights(0).fold(f64::NEG_INFINITY, f64::max) - heights(1).fold(f64::INFINITY, f64::min) - deep;
            let at = Vector::new(aside.x, aside.y, above).map(|x| (x / UNIT).round() * UNIT);
            let poses = [Pose::new(&turns[0], &Vector::zeros()), Pose::new(&turns[1], &at)];
            seen.ask([&bodies[0], &bodies[1]], [&shapes[0], &shapes[1]], [&poses[0], &poses[1]], &mut cache);
            upper = rotation(&random.direction(), 5e-4 * random.signed()) * upper;
            aside += random.vector() * 1e-3;
        }
    }
    let Seen { overlapping, at_rest, widest, .. } = seen;
    println!("{overlapping} overlapping, {at_rest} at rest, {widest:e}");
    assert!(overlapping > 120 && at_rest > overlapping, "{overlapping} {at_rest}");
}
