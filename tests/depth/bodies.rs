//! Random and adversarial pairs against the independent check.

use swiftprox::math::{Matrix, Pose, Vector};
use swiftprox::pair::contact;
use swiftprox::pair::{
    DepthAnswer, DepthCache, DepthConfig, DepthEnding, Outcome, PairAnswer, PairCache, PairConfig, depth,
};
use swiftprox::progress::Progress;
use swiftprox::shape::{InputPolicy, Shape, ShapeOptions};
use swiftprox::verify::{verify, verify_depth};

use testkit::hard::families;
use testkit::models;
use testkit::random::rotation;
use testkit::shapes::{cuboid, hull};

use crate::{Random, query};

fn prepared(shape: Shape) -> Shape {
    shape.prepare(&mut Progress::new(&mut |_| true)).unwrap();
    shape
}

fn ellipsoid(random: &mut Random, count: usize, half_axes: [f64; 3]) -> Shape {
    let points: Vec<Vector> = (0..count).map(|_| random.direction().component_mul(&Vector::from(half_axes))).collect();
    prepared(hull(&points))
}

/// A prism over a regular polygon.
fn prism(sides: u32, height: f64) -> Shape {
    prepared(hull(&models::prism(sides, height).unwrap().vertices))
}

/// Bodies of many vertices, of many sizes.
pub fn large(random: &mut Random) -> Vec<Shape> {
    let mut shapes = vec![cuboid([0.5, 0.5, 0.5]), cuboid([1.0, 0.3, 0.05]), prism(5, 0.5), prism(64, 0.1)];
    for (count, half_axes) in
        [(30, [1.0, 1.0, 1.0]), (100, [1.0, 1.0, 0.1]), (300, [1.0, 1.0, 1.0]), (200, [1.0, 0.1, 0.1]), (20, [0.2; 3])]
    {
        shapes.push(ellipsoid(random, count, half_axes));
    }
    shapes
}

fn radius(shape: &Shape) -> f64 {
    shape.polyhedron().radius
}

/// Poses in which bodies are likely to overlap: from concentric to barely, some in line with each other, some skewed, some far out.
pub fn placed_deep(random: &mut Random, shapes: [&Shape; 2]) -> [Pose; 2] {
    let reach = radius(shapes[0]).min(radius(shapes[1]));
    let far = random.pick(&[0.0, 0.0, 0.0, 1e3, 1e7]);
    let origin = random.vector() * far;
    [0, 1].map(|i| {
        let turn = match random.below(4) {
            0 => random.quarter_turns(),
            1 => random.quarter_turns() * rotation(&random.direction(), random.power(-50, -3)),
            2 => random.rotation() + Matrix::from_fn(|_, _| random.signed()) * random.power(-40, -10),
            _ => random.rotation(),
        };
        let away = random.direction() * reach * random.pick(&[0.0, 1e-9, 0.2, 0.5, 0.9]) * i as f64;
        Pose::new(&turn, &(origin + away))
    })
}

/// The width of an interval over what is promised: of ordinary pairs 2e-14 of their size or how far their origins are apart, of
/// hard ones 1e-13 of the larger box and 2e-16 of the largest coordinate.
fn width_of(shapes: [&Shape; 2], poses: [&Pose; 2], is_hard: bool, answer: &DepthAnswer) -> f64 {
    let size = radius(shapes[0]) + radius(shapes[1]);
    let apart = (poses[0].translation() - poses[1].translation()).norm();
    let ordinary = 2e-14 * size.max(apart);
    let diagonal = |shape: &Shape| (shape.polyhedron().mass.upper - shape.polyhedron().mass.lower).norm();
    let largest = diagonal(shapes[0]).max(diagonal(shapes[1]));
    let world = poses[0].translation().amax().max(poses[1].translation().amax()) + largest;
    let promise = if is_hard { ordinary.max(1e-13 * (largest + 2e-3 * world)) } else { ordinary };
    (answer.upper - answer.lower) / promise
}

/// What became of many queries.
#[derive(Default)]
struct Tally {
    overlapping: usize,
    /// Wider than promised, of those that did not stall, and the widest of them.
    wide: usize,
    widest: f64,
    stalled: usize,
}

impl Tally {
    fn add(&mut self, answer: &DepthAnswer, width: f64) {
        if answer.outcome != Outcome::Intersecting {
            return;
        }
        self.overlapping += 1;
        // Where it is cut short the interval holds all the same.
        if matches!(answer.ending, DepthEnding::Stalled | DepthEnding::Budget) {
            self.stalled += 1;
            return;
        }
        self.wide += usize::from(width > 1.0);
        self.widest = self.widest.max(width);
    }
}

fn check(shapes: [&Shape; 2], poses: [&Pose; 2], cache: &DepthCache, answer: &DepthAnswer) {
    verify_depth([shapes[0].at(poses[0]), shapes[1].at(poses[1])], cache, answer)
        .unwrap_or_else(|error| panic!("{error}: {poses:?} {answer:?}"));
}

/// Bodies of few vertices: those that a query takes little time for.
fn small(random: &mut Random) -> Vec<Shape> {
    let mut shapes = vec![cuboid([0.5, 0.5, 0.5]), cuboid([1.0, 0.3, 0.05]), cuboid([1.0, 1e-3, 1e-3]), prism(5, 0.5)];
    for (count, half_axes) in [
        (4, [1.0; 3]),
        (4, [1.0, 1.0, 0.01]),
        (8, [1.0; 3]),
        (16, [1.0, 0.1, 0.1]),
        (30, [1.0, 1.0, 0.3]),
        (20, [0.2; 3]),
    ] {
        shapes.push(ellipsoid(random, count, half_axes));
    }
    shapes
}

/// Checks pairs of bodies, each in five poses; so many at least must overlap.
fn check_pairs(shapes: &[Shape], pairs: usize, least: usize, random: &mut Random) {
    let mut tally = Tally::default();
    for _ in 0..pairs {
        let pair = [&shapes[random.below(shapes.len())], &shapes[random.below(shapes.len())]];
        let mut poses = placed_deep(random, pair);
        let mut cache = DepthCache::default();
        let step = random.power(-16, -1);
        for _ in 0..5 {
            let placed = [&poses[0], &poses[1]];
            let answer = query(pair, placed, &mut cache);
            check(pair, placed, &cache, &answer);
            tally.add(&answer, width_of(pair, placed, false, &answer));
            let turn = rotation(&random.direction(), step);
            let moved = poses[1].translation() + random.vector() * step * radius(pair[1]);
            poses[1] = Pose::new(&(turn * poses[1].rotation()), &moved);
        }
    }
    let Tally { overlapping, wide, widest, stalled } = tally;
    println!("{overlapping} overlap, {stalled} stalled, {wide} wide, the widest {widest:.2} of the promise");
    assert!(overlapping > least && wide == 0 && stalled < pairs / 100, "{overlapping} {wide} {widest:e} {stalled}");
}

#[test]
fn depths_of_small_bodies_hold() {
    let mut random = Random::new(47);
    let shapes = small(&mut random);
    check_pairs(&shapes, 19_000, 68_000, &mut random);
}

#[test]
fn depths_of_large_bodies_hold() {
    let mut random = Random::new(41);
    let shapes = large(&mut random);
    check_pairs(&shapes, 6_000, 28_000, &mut random);
}

#[test]
fn depths_of_hard_families_hold() {
    let mut tally = Tally::default();
    let options = ShapeOptions { input: InputPolicy::Hull, ..ShapeOptions::default() };
    for family in families() {
        for index in 0..family.sweep.min(8) {
            let sequence = family.sequence(5, index);
            let [Ok(first), Ok(second)] = [0, 1].map(|i| Shape::from_mesh(&sequence.bodies[i], &options)) else {
                continue;
            };
            let pair = [&first, &second];
            let mut cache = DepthCache::default();
            for pose in sequence.poses.iter().step_by(1 + sequence.poses.len() / 60) {
                let [first, second] = [0, 12].map(|at| Pose::from_row_major(pose[at..at + 12].try_into().unwrap()));
                let placed = [&first, &second];
                let answer = query(pair, placed, &mut cache);
                check(pair, placed, &cache, &answer);
                tally.add(&answer, width_of(pair, placed, true, &answer));
            }
        }
    }
    let Tally { overlapping, wide, widest, stalled } = tally;
    println!("{overlapping} overlap, {stalled} stalled, {wide} wide, the widest {widest:.2} of the promise");
    // Of dihedral angles of 1e-11 rounding hides the least direction, and integers find out no more than that the bodies overlap.
    assert!(overlapping > 2_000 && wide <= 4 && stalled <= 40, "{overlapping} {wide} {widest:e} {stalled}");
}

/// Prisms over polygons of very many sides, in each other and side by side.
#[test]
fn depths_of_polygons_of_many_sides_hold() {
    let prisms = [prism(5_000, 0.2), prism(5_000, 2.0)];
    let mut random = Random::new(43);
    for round in 0..6 {
        let turn = if round % 2 == 0 { Matrix::identity() } else { random.rotation() };
        let away = random.direction() * random.pick(&[0.0, 1e-6, 0.3, 1.2]);
        let poses = [Pose::IDENTITY, Pose::new(&turn, &away)];
        let (pair, placed) = ([&prisms[0], &prisms[round % 3 / 2]], [&poses[0], &poses[1]]);
        let mut cache = DepthCache::default();
        for _ in 0..2 {
            let answer = query(pair, placed, &mut cache);
            check(pair, placed, &cache, &answer);
            assert!(answer.outcome == Outcome::Intersecting || away.norm() > 0.3, "{answer:?}");
        }
    }
}

/// A body 10¹³ times as long as the other: rounding hides all but that they overlap, and the witness points are a common point, not
/// what the weights of a thin triangle of the polytope make. From fuzzing.
#[test]
fn witness_points_of_bodies_of_very_different_sizes_hold() {
    let long = hull(&[
        Vector::new(-0.5, -0.5, -0.5),
        Vector::new(-0.5, -0.5, -32.0),
        Vector::new(3.0, -25.0, 0.0),
        Vector::new(0.0, 0.0, 16.0),
        Vector::new(16.0, 16.0, 1.1368683772161603e-13),
        Vector::new(16.0, 16.0, 16.0),
        Vector::new(0.0, 281474976710656.0, 16.0),
    ]);
    let cube = cuboid([16.0; 3]);
    let turn = Matrix::new(
        -0.11236050770934487,
        0.18621688389130242,
        0.9760626969929295,
        0.9876480109038247,
        0.12888661725871023,
        0.08910469375585656,
        -0.10920862083652783,
        0.9740182298321831,
        -0.19839850072408208,
    );
    let poses = [
        Pose::new(&turn, &Vector::new(16.0, 16.0, 16.0)),
        Pose::new(&turn, &Vector::new(43.63847005707471, 50.456086549110445, 6.158525235060484)),
    ];
    let (pair, placed) = ([&long, &cube], [&poses[0], &poses[1]]);
    let mut cache = DepthCache::default();
    let answer = query(pair, placed, &mut cache);
    assert_eq!(answer.outcome, Outcome::Intersecting);
    check(pair, placed, &cache, &answer);
}

/// A body whose coordinates are small numbers and large ones.
fn of_near_and_far(random: &mut Random, large: f64, kind: usize) -> Option<Shape> {
    let mut point = || {
        let reach = random.pick(&[large, 30.0]);
        Vector::from_fn(|_, _| {
            let size = match (kind, random.below(4)) {
                (0, 0) => 0.0,
                (0, 1) => 1.0 + random.below(30) as f64,
                (1, _) => reach * random.signed(),
                (2, 0) => large * random.signed(),
                (2, 1) => random.signed(),
                _ => large,
            };
            size * random.pick(&[-1.0, 1.0])
        })
    };
    let points: Vec<Vector> = (0..24).map(|_| point()).collect();
    let count = random.pick(&[1, 2, 4, 6, 8, 20]) + random.below(4);
    let options = ShapeOptions { input: InputPolicy::Hull, ..ShapeOptions::default() };
    Shape::from_points(&points[..count], &options).ok()
}

/// The least direction meets triangles next to one corner with the others far out, and in the middle of slivers 10¹² times as long
/// as they are wide. From fuzzing.
#[test]
fn witness_points_on_slivers_hold() {
    let mut random = Random::new(40);
    let mut overlapping = 0;
    for _ in 0..20_000 {
        let (large, kind) = (random.pick(&[1e6, 1e9, 1e13, 17_592_186_044_416.0, 1e15]), random.below(3));
        let shapes = [(); 2].map(|()| of_near_and_far(&mut random, large, kind));
        let [Some(first), Some(second)] = &shapes else { continue };
        let mut poses = [(); 2].map(|()| {
            let turn = if random.below(2) == 0 { Matrix::identity() } else { random.rotation() };
            Pose::new(&turn, &random.lattice(5))
        });
        let mut cache = DepthCache::default();
        for _ in 0..2 {
            let (pair, placed) = ([first, second], [&poses[0], &poses[1]]);
            let answer = query(pair, placed, &mut cache);
            check(pair, placed, &cache, &answer);
            overlapping += usize::from(answer.outcome == Outcome::Intersecting);
            poses[1] = Pose::new(&poses[1].rotation(), &(poses[1].translation() + random.vector() * 0.25));
        }
    }
    assert!(overlapping > 20_000, "{overlapping}");
}

/// A small body inside a needle: seen from it the needle's nearest facet is two triangles 10³ to 10⁶ times as long as wide, and the
/// least direction meets their common side. From fuzzing.
#[test]
fn witness_points_on_a_side_of_slivers_hold() {
    let mut random = Random::new(41);
    let mut overlapping = 0;
    for _ in 0..10_000 {
        let thin = random.power(-20, -8);
        let needle: Vec<Vector> = {
            let turn = random.rotation();
            let half = Vector::new(1.0, thin * random.power(-4, 0), thin);
            let corner = |i: usize| Vector::from_fn(|k, _| if i >> k & 1 == 0 { -half[k] } else { half[k] });
            (0..8).map(|i| turn * corner(i)).collect()
        };
        let small: Vec<Vector> = (0..8).map(|_| random.vector() * thin * 1e-6).collect();
        let (needle, small) = (hull(&needle), hull(&small));
        let poses = [Pose::new(&random.rotation(), &Vector::zeros()), Pose::new(&random.rotation(), &Vector::zeros())];
        let (pair, placed) = ([&small, &needle], [&poses[0], &poses[1]]);
        let mut cache = DepthCache::default();
        let answer = query(pair, placed, &mut cache);
        check(pair, placed, &cache, &answer);
        overlapping += usize::from(answer.outcome == Outcome::Intersecting);
    }
    assert_eq!(overlapping, 10_000);
}

/// Two bodies that no unit of length brings into the range of the search, and a pose that shrinks one: the common point is farther
/// from the feature in the object's frame than the interval is wide. From fuzzing, the small body smaller.
#[test]
fn a_wide_interval_in_a_shrunk_pose_holds() {
    let (large, small) = (cuboid([1.5445794735293872e157; 3]), cuboid([2.498001805406602e-200; 3]));
    let shrunk = Matrix::new(0.0, -0.99609375, 0.0, 0.0, 0.0, -1.0, 1.0, 0.0, 0.0);
    let stretched = Matrix::from_diagonal(&Vector::new(1.00390625, 1.0, 1.0));
    let poses = [Pose::new(&shrunk, &Vector::zeros()), Pose::new(&stretched, &Vector::new(-32.0, -4.0, -32.0))];
    let (pair, placed) = ([&large, &small], [&poses[0], &poses[1]]);
    let mut cache = DepthCache::default();
    let answer = query(pair, placed, &mut cache);
    assert_eq!((answer.outcome, answer.ending), (Outcome::Intersecting, DepthEnding::Integers));
    check(pair, placed, &cache, &answer);
}

/// As narrow as asked for, and no more steps than that takes; a budget ends in an interval that holds.
#[test]
fn errors_and_budgets_are_kept() {
    let mut random = Random::new(44);
    let shape = ellipsoid(&mut random, 300, [1.0, 0.8, 0.6]);
    let pair = [&shape, &shape];
    let mut steps = [0; 4];
    for _ in 0..300 {
        let poses = [Pose::IDENTITY, Pose::new(&random.rotation(), &(random.direction() * 0.7))];
        let placed = [&poses[0], &poses[1]];
        let asked = |config: DepthConfig| {
            let (mut cache, mut answer) = (DepthCache::default(), DepthAnswer::default());
            depth([pair[0].at(placed[0]), pair[1].at(placed[1])], &mut cache, &config, &mut answer).unwrap();
            check(pair, placed, &cache, &answer);
            answer
        };
        for (k, error) in [0.0, 1e-6, 1e-3, 1e-1].into_iter().enumerate() {
            let absolute = asked(DepthConfig { absolute_error: error, ..DepthConfig::default() });
            steps[k] += absolute.statistics.steps;
            assert!(absolute.upper - absolute.lower <= error.max(2e-14 * 2.0), "{error} {absolute:?}");
            let relative = asked(DepthConfig { relative_error: error, ..DepthConfig::default() });
            let most = (error * relative.lower).max(2e-14 * 2.0) * (1.0 + 1e-9);
            assert!(relative.upper - relative.lower <= most, "{error} {relative:?}");
        }
        let short = asked(DepthConfig { step_budget: 3, ..DepthConfig::default() });
        assert!(short.statistics.steps <= 3 && short.outcome != Outcome::None, "{short:?}");
        let anything = asked(DepthConfig {
            absolute_error: f64::INFINITY,
            relative_error: f64::INFINITY,
            ..DepthConfig::default()
        });
        assert!(anything.outcome != Outcome::None);
    }
    assert!(steps[0] >= steps[1] && steps[1] > steps[2] && steps[2] > steps[3], "{steps:?}");
}

#[test]
fn what_is_no_pose_or_option_is_refused() {
    let shape = cuboid([1.0; 3]);
    let (mut cache, mut answer) = (DepthCache::default(), DepthAnswer::default());
    let mut asked = |pose: &Pose, config: &DepthConfig| {
        depth([shape.at(&Pose::IDENTITY), shape.at(pose)], &mut cache, config, &mut answer)
    };
    let default = DepthConfig::default();
    let at = |x: f64| Pose::new(&Matrix::identity(), &Vector::new(x, 0.0, 0.0));
    assert!(asked(&at(f64::NAN), &default).is_err());
    assert!(asked(&Pose::new(&(Matrix::identity() * -1.0), &Vector::zeros()), &default).is_err());
    assert!(asked(&Pose::IDENTITY, &DepthConfig { absolute_error: -1.0, ..default }).is_err());
    assert!(asked(&Pose::IDENTITY, &DepthConfig { relative_error: f64::NAN, ..default }).is_err());
    assert!(asked(&Pose::IDENTITY, &DepthConfig { step_budget: 0, ..default }).is_err());
    assert!(asked(&at(1.0), &default).is_ok());
    assert_eq!(answer.outcome, Outcome::Intersecting);
}

/// Magnitudes that double precision's bounds do not cover are searched in another unit, and decided in integers.
#[test]
fn any_magnitude_has_a_depth() {
    for scale in [1e-300, 1e-80, 1e80, 1e300] {
        let shape = cuboid([scale; 3]);
        for x in [0.0, 1.5, 2.0, 2.5] {
            let poses = [Pose::IDENTITY, Pose::new(&Matrix::identity(), &Vector::new(x * scale, 0.0, 0.0))];
            let answer = query([&shape, &shape], [&poses[0], &poses[1]], &mut DepthCache::default());
            let depth = (2.0 - x) * scale;
            assert_eq!(answer.outcome == Outcome::Separated, x > 2.0, "{answer:?}");
            assert!(answer.lower <= depth.max(0.0) && depth.max(0.0) <= answer.upper * (1.0 + 1e-15), "{answer:?}");
            assert_eq!(answer.upper == 0.0, x >= 2.0, "{answer:?}");
        }
    }
}

/// Bodies a thousand million million times as long as they are thick: what a search makes of them has two ends all the same.
#[test]
fn stretched_bodies_have_depths() {
    let mut random = Random::new(45);
    let mut overlapping = 0;
    for _ in 0..6_000 {
        let shapes = [(); 2].map(|()| {
            let stretch = [(); 3].map(|()| random.power(-50, 0));
            let points: Vec<Vector> =
                (0..4 + random.below(6)).map(|_| random.vector().component_mul(&Vector::from(stretch))).collect();
            let turn = random.rotation();
            hull(&points.iter().map(|p| turn * p).collect::<Vec<_>>())
        });
        let pair = [&shapes[0], &shapes[1]];
        let away = random.vector() * random.power(-50, -1);
        let poses = [Pose::IDENTITY, Pose::new(&random.rotation(), &away)];
        let placed = [&poses[0], &poses[1]];
        let mut cache = DepthCache::default();
        for _ in 0..2 {
            let answer = query(pair, placed, &mut cache);
            check(pair, placed, &cache, &answer);
            overlapping += usize::from(answer.outcome == Outcome::Intersecting);
        }
    }
    assert!(overlapping > 1_000, "{overlapping}");
}

/// Bodies whose faces are slivers thinner than rounding. Cause: the sides of such a face are noise, and told that a point half a
/// body away is on it; the check refused the answer. It showed on bodies 4e276 long and 5e-48 wide.
#[test]
fn faces_thinner_than_rounding_hold_their_points() {
    let mut random = Random::new(276);
    for round in 0..60 {
        let sizes = [[1.0, 1e-17, 1e-34], [1.0, 1e-20, 1e-30], [4e276, 5e-48, 2.5e-253]][round % 3];
        let points: Vec<Vector> = (0..45).map(|_| random.direction().component_mul(&Vector::from(sizes))).collect();
        let (needle, prism) = (hull(&points), hull(&models::prism(13, 1.0).unwrap().vertices));
        let place = Pose::new(&Matrix::identity(), &Vector::new(random.signed() * 0.5, 0.0, random.pick(&[0.0, 0.5])));
        let bodies = [prism.at(&place), needle.at(&Pose::IDENTITY)];
        let (mut cache, mut answer) = (PairCache::default(), PairAnswer::default());
        contact(bodies, &mut cache, &PairConfig::default(), &mut answer).unwrap();
        verify(bodies, &answer).unwrap_or_else(|error| panic!("{round}: {error} {answer:?}"));
        let (mut cache, mut answer) = (DepthCache::default(), DepthAnswer::default());
        depth(bodies, &mut cache, &DepthConfig::default(), &mut answer).unwrap();
        verify_depth(bodies, &cache, &answer).unwrap_or_else(|error| panic!("{round}: {error} {answer:?}"));
    }
}
