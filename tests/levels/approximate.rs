//! Approximate queries, and queries through levels of detail: more than a million over all settings, each against the exact query's
//! interval. The verdict is the exact one, the intervals have a number in common, none is wider than asked for, whatever the cache.

use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};

use swiftprox::body::tables::{LookupKind, LookupOptions};
use swiftprox::error::Error;
use swiftprox::hierarchy::{Hierarchy, HierarchyKind, HierarchyOptions};
use swiftprox::math::{Matrix, Pose, Vector};
use swiftprox::mesh::PolygonMesh;
use swiftprox::pair::{self, DecidedBy, Levels, Outcome, PairAnswer, PairCache, PairConfig, Placed, Refinement, Start};
use swiftprox::progress::Progress;
use swiftprox::shape::{InputPolicy, Shape, ShapeOptions};
use swiftprox::shape_file::{from_bytes, to_bytes};
use swiftprox::verify::verify;
use testkit::caches::{WORDS, cache_of_words};
use testkit::models::{cuboid, ellipsoid, prism, random_hull};
use testkit::random::{Random, rotation};

const KINDS: [HierarchyKind; 4] =
    [HierarchyKind::None, HierarchyKind::Quadric, HierarchyKind::DobkinKirkpatrick, HierarchyKind::OuterCuts];

const REFINEMENTS: [Refinement; 4] =
    [Refinement::Adaptive, Refinement::Single, Refinement::SingleSingle, Refinement::DoubleDouble];

/// Bodies of many kinds, with every kind of levels.
fn shapes() -> Vec<Shape> {
    let mut meshes: Vec<PolygonMesh> = Vec::new();
    for half_axes in [[1.0, 1.0, 1.0], [1.0, 1.0, 0.1], [1.0, 0.1, 0.1]] {
        meshes.extend([100, 600].map(|n| ellipsoid(half_axes, n).unwrap()));
    }
    meshes.extend([random_hull(200, 5).unwrap(), prism(48, 0.3).unwrap(), cuboid([0.4, 0.9, 0.2]).unwrap()]);
    let mut shapes = Vec::new();
    for (i, mesh) in meshes.iter().enumerate() {
        for kind in KINDS {
            let hierarchy = HierarchyOptions {
                kind,
                decimation: [0.25, 0.5][i % 2],
                minimum_triangles: [50, 12][i / 2 % 2],
                ..HierarchyOptions::default()
            };
            // One in three far from its own origin, sizes from a thousandth to a thousand.
            let translation = Vector::new(1e3, -2.0, 7.0) * if i % 3 == 2 { 1.0 } else { 0.0 };
            let scale = [1.0, 1e-3, 1e3][(i + shapes.len()) % 3];
            let kind = [LookupKind::Automatic, LookupKind::Spherical, LookupKind::Shells][(i + shapes.len() / 4) % 3];
            let lookup = LookupOptions { kind, ..LookupOptions::DEFAULT };
            let options = ShapeOptions { hierarchy, lookup, translation, scale, ..ShapeOptions::default() };
            shapes.push(Shape::from_mesh(mesh, &options).unwrap());
        }
    }
    // Large ones.
    for (half_axes, kind) in [([1.0, 0.3, 0.1], HierarchyKind::Quadric), ([1.0, 1.0, 0.1], HierarchyKind::OuterCuts)] {
        let hierarchy = HierarchyOptions { kind, ..HierarchyOptions::default() };
        let options = ShapeOptions { hierarchy, ..ShapeOptions::default() };
        shapes.push(Shape::from_mesh(&ellipsoid(half_axes, 8_000).unwrap(), &options).unwrap());
    }
    let options = ShapeOptions { input: InputPolicy::Hull, ..ShapeOptions::default() };
    let square = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]].map(|[x, y]| Vector::new(x, y, 0.0));
    for count in [1, 2, 4] {
        shapes.push(Shape::from_points(&square[..count], &options).unwrap());
    }
    shapes
}

/// What went wrong and how often something was checked.
#[derive(Default)]
struct Tally {
    queries: usize,
    by_levels: usize,
    spent: usize,
    intersecting: usize,
    violations: Vec<String>,
}

struct Session<'a> {
    shapes: [&'a Shape; 2],
    poses: [Pose; 2],
    random: Random,
    /// Whatever the queries before have left.
    warm: PairCache,
    tally: Tally,
}

type Query = fn([Placed; 2], &mut PairCache, &PairConfig, &mut PairAnswer) -> Result<(), Error>;

impl Session<'_> {
    fn ask(&self, query: Query, cache: &mut PairCache, config: &PairConfig) -> PairAnswer {
        let mut answer = PairAnswer::default();
        let ([shape1, shape2], [pose1, pose2]) = (self.shapes, &self.poses);
        query([shape1.at(pose1), shape2.at(pose2)], cache, config, &mut answer).unwrap();
        answer
    }

    fn radius(&self) -> f64 {
        self.shapes[0].polyhedron().radius + self.shapes[1].polyhedron().radius
    }

    /// Any setting that approximate queries have.
    fn any_config(&mut self, distance: f64) -> PairConfig {
        let random = &mut self.random;
        let size = self.shapes[0].polyhedron().radius + self.shapes[1].polyhedron().radius;
        let error = |random: &mut Random| match random.below(8) {
            0 | 1 => 0.0,
            k => 10f64.powi(1 - k as i32),
        };
        PairConfig {
            absolute_error: size * error(random),
            relative_error: error(random),
            max_distance: match random.below(8) {
                0 => size * error(random),
                1 => distance * (1.0 + random.power(-50, -1) * random.signed()),
                _ => f64::INFINITY,
            },
            step_budget: if random.below(8) == 0 { 1 + random.below(12) as u32 } else { u32::MAX },
            levels: random.pick(&[Levels::Automatic, Levels::None, Levels::All, Levels::All]),
            refinement: random.pick(&REFINEMENTS),
            start: random.pick(&[Start::Automatic, Start::Automatic, Start::Cache, Start::Table, Start::Cold]),
        }
    }

    /// One pose: the exact answer, then many others.
    fn check(&mut self) {
        let exact = self.ask(pair::distance, &mut PairCache::default(), &PairConfig::default());
        self.tally.intersecting += usize::from(exact.outcome == Outcome::Intersecting);
        for k in 0..8 {
            let config = self.any_config(exact.distance);
            let queries: [Query; 4] = [pair::approximate, pair::distance, pair::intersection, pair::contact];
            let which = if k < 6 { 0 } else { 1 + self.random.below(3) };
            let mut cache = match self.random.below(8) {
                0 => PairCache::default(),
                1 => garbage(&mut self.random),
                _ => self.warm,
            };
            let answer = self.ask(queries[which], &mut cache, &config);
            self.warm = cache;
            self.tally.queries += 1;
            self.tally.by_levels += usize::from(answer.statistics.levels != [0, 0]);
            self.tally.spent += usize::from(answer.decided_by == DecidedBy::Budget);
            if let Err(what) = self.judge(which, &exact, &answer, &config) {
                self.tally
                    .violations
                    .push(format!("{what}: {answer:?}, exactly {exact:?}, {config:?}, {:?}", self.poses));
            }
        }
    }

    fn judge(
        &mut self,
        which: usize,
        exact: &PairAnswer,
        answer: &PairAnswer,
        config: &PairConfig,
    ) -> Result<(), String> {
        let is_intersecting = exact.outcome == Outcome::Intersecting;
        match answer.outcome {
            Outcome::Undecided if answer.decided_by == DecidedBy::Budget && answer.lower == 0.0 => {}
            Outcome::Intersecting if is_intersecting => return self.verify_some(answer),
            Outcome::Separated if !is_intersecting && answer.lower <= config.max_distance => {}
            Outcome::Beyond if !is_intersecting && answer.lower >= config.max_distance => {}
            _ => return Err("the verdict is wrong".into()),
        }
        // Both intervals hold the true distance.
        if !(answer.lower <= exact.upper && answer.upper >= exact.lower) {
            return Err("the interval is wrong".into());
        }
        let reach = self.poses.iter().map(|pose| pose.translation().amax()).fold(0.0, f64::max);
        let widest = 1e-13 * (self.radius().max(answer.upper) + 2e-3 * reach);
        let asked = config.absolute_error.max(config.relative_error * answer.lower);
        // An intersection query promises no width.
        let tolerance = [asked, 0.0, f64::INFINITY, 0.0][which].max(widest);
        let is_answered = answer.outcome == Outcome::Separated && answer.decided_by != DecidedBy::Budget;
        if is_answered && !(answer.upper - answer.lower <= tolerance) {
            return Err("the interval is too wide".into());
        }
        // Whatever is asked, a distance tolerance is decided.
        if is_answered && answer.upper > config.max_distance {
            return Err("the interval leaves the distance tolerance open".into());
        }
        let [level1, level2] = answer.statistics.levels.map(usize::from);
        let [most1, most2] = self.shapes.map(|shape| shape.hierarchy().levels.len());
        if level1 > most1 || level2 > most2 || (config.levels == Levels::None && level1 + level2 > 0) {
            return Err("there are no such levels".into());
        }
        if answer.outcome == Outcome::Undecided { Ok(()) } else { self.verify_some(answer) }
    }

    /// `verify` takes time in proportion to the vertices.
    fn verify_some(&mut self, answer: &PairAnswer) -> Result<(), String> {
        if self.random.below(16) > 0 {
            return Ok(());
        }
        let ([shape1, shape2], [pose1, pose2]) = (self.shapes, &self.poses);
        verify([shape1.at(pose1), shape2.at(pose2)], answer).map_err(|e| e.to_string())
    }
}

fn garbage(random: &mut Random) -> PairCache {
    // A feature pair of levels is what most bits are not.
    let words: [u32; WORDS] = std::array::from_fn(|i| match i {
        0 => random.below(34) as u32,
        1 | 2 => random.below(300) as u32,
        _ => [random.below(5) as u32, random.next_u64() as u32][usize::from(random.below(8) == 0)],
    });
    cache_of_words(words)
}

/// A pose pair: near enough to meet or well apart, sometimes skewed, sometimes far from the origin.
fn any_poses(shapes: [&Shape; 2], random: &mut Random) -> [Pose; 2] {
    let size = shapes[0].polyhedron().radius + shapes[1].polyhedron().radius;
    let far = if random.below(4) == 0 { 10f64.powi(2 + random.below(8) as i32) * size } else { 0.0 };
    let far = far * random.direction();
    let skew = if random.below(4) == 0 { 10f64.powi(-3 - random.below(5) as i32) } else { 0.0 };
    let reach = size * [0.6, 1.2, 3.0][random.below(3)];
    let apart = [Vector::zeros(), random.vector() * reach];
    std::array::from_fn(|i| {
        let turn = random.rotation() + Matrix::from_fn(|_, _| skew * random.signed());
        let centre = shapes[i].polyhedron().mass.centre_of_mass;
        Pose::new(&turn, &(far + apart[i] - turn * centre))
    })
}

/// A step of body 2: most are small.
fn step(pose: &Pose, size: f64, random: &mut Random) -> Pose {
    let by = 10f64.powi(-1 - random.below(4) as i32);
    let turn = rotation(&random.direction(), by);
    Pose::new(&(turn * pose.rotation()), &(pose.translation() + random.vector() * (by * size)))
}

#[test]
fn a_million_approximate_queries_hold_the_exact_distance() {
    const CHUNKS: usize = 2_800;
    let shapes = shapes();
    let next = AtomicUsize::new(0);
    let total: Mutex<Tally> = Mutex::default();
    let work = || {
        loop {
            let chunk = next.fetch_add(1, Ordering::Relaxed);
            if chunk >= CHUNKS {
                return;
            }
            let mut random = Random::new(0xa99 + chunk as u64);
            let pair = [random.below(shapes.len()), random.below(shapes.len())].map(|i| &shapes[i]);
            let poses = any_poses(pair, &mut random);
            let size = pair[0].polyhedron().radius + pair[1].polyhedron().radius;
            let mut session =
                Session { shapes: pair, poses, random, warm: PairCache::default(), tally: Tally::default() };
            for _ in 0..50 {
                session.check();
                session.poses[1] = step(&session.poses[1], size, &mut session.random);
                if session.random.below(16) == 0 || session.poses[1].rotation_defect() > 5e-3 {
                    session.poses = any_poses(pair, &mut session.random);
                }
            }
            let mut total = total.lock().unwrap();
            total.queries += session.tally.queries;
            total.by_levels += session.tally.by_levels;
            total.spent += session.tally.spent;
            total.intersecting += session.tally.intersecting;
            total.violations.extend(session.tally.violations);
        }
    };
    std::thread::scope(|scope| {
        scope.spawn(work);
        work();
    });
    let Tally { queries, by_levels, spent, intersecting, mut violations } = total.into_inner().unwrap();
    println!(
        "{queries} queries, {by_levels} answered by levels, {spent} ended by their budget, {intersecting} poses intersecting"
    );
    violations.sort_by_key(String::len);
    assert!(violations.is_empty(), "{} violations: {}", violations.len(), violations[0]);
    assert!(queries >= 1_000_000 && by_levels > 100_000 && spent > 10_000 && intersecting > 10_000);
}

/// Two ellipsoids with levels, apart or overlapping.
fn leveled_pair(kind: HierarchyKind) -> [Shape; 2] {
    [[1.0, 1.0, 0.1], [1.0, 0.1, 0.1]].map(|half_axes| {
        let hierarchy = HierarchyOptions { kind, ..HierarchyOptions::default() };
        let options = ShapeOptions { hierarchy, ..ShapeOptions::default() };
        Shape::from_mesh(&ellipsoid(half_axes, 1002).unwrap(), &options).unwrap()
    })
}

/// However small the budget, the interval holds, and query after query comes nearer to the answer until it is there.
#[test]
fn a_query_goes_on_where_its_budget_ran_out() {
    for kind in KINDS {
        let [a, b] = leveled_pair(kind);
        let mut random = Random::new(7);
        let (mut spent, mut intersecting) = (0, 0);
        for k in 0..150 {
            let poses = any_poses([&a, &b], &mut random);
            let session = Session {
                shapes: [&a, &b],
                poses,
                random: Random::new(k),
                warm: PairCache::default(),
                tally: Tally::default(),
            };
            let exact = session.ask(pair::distance, &mut PairCache::default(), &PairConfig::default());
            for levels in [Levels::All, Levels::None] {
                let budget = 1 + (k % 6) as u32;
                let config = PairConfig { step_budget: budget, levels, ..PairConfig::default() };
                let mut cache = PairCache::default();
                for round in 0.. {
                    let answer = session.ask(pair::approximate, &mut cache, &config);
                    assert!(answer.lower <= exact.upper && answer.upper >= exact.lower, "{answer:?} {exact:?}");
                    if answer.decided_by != DecidedBy::Budget {
                        assert_eq!(answer.outcome, exact.outcome);
                        assert!(answer.upper - answer.lower <= 1e-13 * (2.0 + 2e-3 * poses[0].translation().amax()));
                        intersecting += usize::from(answer.outcome == Outcome::Intersecting);
                        break;
                    }
                    assert!(answer.statistics.marching_steps <= budget, "{answer:?}");
                    assert!(
                        answer.outcome != Outcome::Intersecting
                            && (answer.lower > 0.0) == (answer.outcome == Outcome::Separated)
                    );
                    spent += 1;
                    assert!(round < 1200, "{answer:?} {exact:?}");
                }
            }
        }
        assert!(spent > 500 && intersecting > 10, "{spent} {intersecting}");
    }
}

/// A query that is to start afresh does, whatever an earlier one spent.
#[test]
fn a_fresh_start_spends_what_the_last_one_spent() {
    let [a, b] = leveled_pair(KINDS[0]);
    let poses = [Vector::zeros(), Vector::new(1.3, 1.1, 0.9)].map(|t| Pose::new(&Matrix::identity(), &t));
    let random = Random::new(1);
    let session = Session { shapes: [&a, &b], poses, random, warm: PairCache::default(), tally: Tally::default() };
    for start in [Start::Table, Start::Cold] {
        for levels in [Levels::All, Levels::None] {
            let config = PairConfig { step_budget: 1, levels, start, ..PairConfig::default() };
            let mut cache = PairCache::default();
            let first = session.ask(pair::approximate, &mut cache, &config);
            assert_eq!(first.decided_by, DecidedBy::Budget, "{first:?}");
            for _ in 0..1200 {
                let again = session.ask(pair::approximate, &mut cache, &config);
                assert_eq!((again.decided_by, again.lower, again.upper), (first.decided_by, first.lower, first.upper));
            }
        }
    }
}

#[test]
fn coarse_questions_are_answered_by_coarse_levels() {
    for kind in &KINDS[1..] {
        let [a, b] = leveled_pair(*kind);
        let apart = Pose::new(&Matrix::identity(), &Vector::new(0.3, 0.2, 1.5));
        let ask = |query: Query, config: PairConfig| {
            let mut answer = PairAnswer::default();
            query([a.at(&Pose::IDENTITY), b.at(&apart)], &mut PairCache::default(), &config, &mut answer).unwrap();
            answer
        };
        let all = PairConfig { levels: Levels::All, ..PairConfig::default() };
        // The coarsest pair of levels that is disjoint decides an intersection query.
        let verdict = ask(pair::intersection, all);
        assert!(verdict.statistics.levels.iter().all(|&level| level > 0), "{verdict:?}");
        // The larger the error, the coarser the levels; exactly, the objects themselves.
        let mut finer = u16::MAX;
        for error in [0.3, 0.1, 0.03, 0.0] {
            let answer = ask(pair::approximate, PairConfig { absolute_error: error, ..all });
            let level = answer.statistics.levels.into_iter().max().unwrap();
            assert!(level <= finer && answer.upper - answer.lower <= error.max(1e-13), "{answer:?}");
            finer = level;
        }
        assert_eq!(finer, 0);
        let exact = ask(pair::distance, all);
        assert_eq!((exact.statistics.levels, exact.decided_by), ([0, 0], DecidedBy::Marching));
        // Beyond the tolerance the coarsest levels may tell.
        let beyond = ask(pair::approximate, PairConfig { max_distance: 0.5, ..all });
        assert_eq!(beyond.outcome, Outcome::Beyond);
        assert!(beyond.statistics.levels.iter().all(|&level| level > 0), "{beyond:?}");
        assert_eq!(ask(pair::distance, PairConfig { max_distance: 0.5, ..all }).outcome, Outcome::Beyond);
    }
}

/// From the coarsest pair on, where all are disjoint, a query ends at the first pair of levels that is tight enough: with errors
/// that each pair just misses these are the pairs that the policy says, in its order.
#[test]
fn each_refinement_visits_the_level_pairs_it_says() {
    let shape = |half_axes, kind, decimation| {
        let hierarchy = HierarchyOptions { kind, decimation, ..HierarchyOptions::default() };
        let options = ShapeOptions { hierarchy, ..ShapeOptions::default() };
        Shape::from_mesh(&ellipsoid(half_axes, 1002).unwrap(), &options).unwrap()
    };
    let many = shape([1.0, 1.0, 0.1], HierarchyKind::Quadric, 0.5);
    let few = shape([1.0, 1.0, 1.0], HierarchyKind::OuterCuts, 0.25);
    assert_eq!([&many, &few].map(|shape| shape.hierarchy().levels.len()), [5, 2]);
    let deviation = |shape: &Shape, level: u16| match level {
        0 => 0.0,
        level => shape.hierarchy().levels[usize::from(level) - 1].deviation,
    };
    let apart = Pose::new(&rotation(&Vector::x(), 1.0), &Vector::new(1.0, 2.0, 2.0));
    for [a, b] in [[&many, &few], [&few, &many]] {
        let paths = REFINEMENTS.map(|refinement| {
            // As the documentation of `Refinement` has it.
            let mut path = vec![[a, b].map(|shape| shape.hierarchy().levels.len() as u16)];
            while let Some(&[level1, level2]) = path.last().filter(|levels| **levels != [0, 0]) {
                let first = [level1.saturating_sub(1), level2];
                let second = [level1, level2.saturating_sub(1)];
                path.push(match refinement {
                    Refinement::Adaptive if deviation(a, level1) > deviation(b, level2) => first,
                    Refinement::Single if level1 >= level2 => first,
                    Refinement::Adaptive | Refinement::Single => second,
                    Refinement::SingleSingle => [level1, level2].map(|level| level.saturating_sub(1)),
                    Refinement::DoubleDouble => [level1, level2].map(|level| level.saturating_sub(2)),
                });
            }
            let mut absolute_error = f64::INFINITY;
            for levels in &path {
                let config = PairConfig {
                    absolute_error,
                    levels: Levels::All,
                    start: Start::Cold,
                    refinement,
                    ..PairConfig::default()
                };
                let (mut cache, mut answer) = (PairCache::default(), PairAnswer::default());
                pair::approximate([a.at(&Pose::IDENTITY), b.at(&apart)], &mut cache, &config, &mut answer).unwrap();
                assert_eq!(answer.statistics.levels, *levels, "{refinement:?}: {path:?}");
                verify([a.at(&Pose::IDENTITY), b.at(&apart)], &answer).unwrap();
                absolute_error = (deviation(a, levels[0]) + deviation(b, levels[1])) * (1.0 - 1e-6);
            }
            path
        });
        // They differ, all of them.
        for (i, path) in paths.iter().enumerate() {
            assert!(!paths[..i].contains(path), "{paths:?}");
        }
    }
}

/// The next query begins where the last one ended: at the level pair that was tight enough; above the objects themselves if these
/// were looked at.
#[test]
fn queries_begin_at_the_levels_that_answered_the_last() {
    for kind in &KINDS[1..] {
        let [a, b] = leveled_pair(*kind);
        let all = PairConfig { levels: Levels::All, ..PairConfig::default() };
        let ask = |query: Query, config: PairConfig, pose: &Pose, cache: &mut PairCache| {
            let mut answer = PairAnswer::default();
            query([a.at(&Pose::IDENTITY), b.at(pose)], cache, &config, &mut answer).unwrap();
            answer
        };
        let coarse = PairConfig { absolute_error: 0.1, ..all };
        let afresh = PairConfig { start: Start::Cold, ..coarse };
        let [mut warm, mut coarsened] = [PairCache::default(); 2];
        // Steps: afresh; after the same query; after exact ones through levels, and without; and of these exact ones.
        let mut steps = [0; 6];
        for k in 0..200 {
            let turn = 2e-3 * f64::from(k);
            let pose = Pose::new(&rotation(&Vector::z(), turn), &Vector::new(0.3 + turn, 0.2, 1.5));
            let cold = ask(pair::approximate, afresh, &pose, &mut PairCache::default());
            assert!(cold.statistics.levels != [0, 0], "{cold:?}");
            let mut answers = vec![cold, ask(pair::approximate, coarse, &pose, &mut warm)];
            for (i, levels) in [Levels::All, Levels::None].into_iter().enumerate() {
                let exactly = PairConfig { levels, ..all };
                ask(pair::distance, exactly, &pose, &mut coarsened);
                let exact = ask(pair::distance, exactly, &pose, &mut coarsened);
                assert_eq!(exact.statistics.levels, [0, 0]);
                steps[4 + i] += exact.statistics.marching_steps;
                answers.push(ask(pair::approximate, coarse, &pose, &mut coarsened));
            }
            for (steps, answer) in steps.iter_mut().zip(&answers) {
                *steps += answer.statistics.marching_steps;
                assert!(answer.upper - answer.lower <= 0.1 && answer.statistics.levels != [0, 0], "{answer:?}");
            }
        }
        println!("{kind:?}: {steps:?} steps");
        let [cold, warm, above_levels, above_objects, exact_levels, exact] = steps;
        // One step where nothing has changed.
        assert!(warm < 300 && 5 * warm < cold);
        assert!(3 * above_objects < 2 * cold && above_levels < cold);
        // Through levels an exact query begins above the objects, too; without, at the objects.
        assert!(exact == 200 && exact_levels >= 2 * exact);
    }
}

/// The short way that mostly answers a query near the last one, through levels that the cache holds, against the exact distance.
#[test]
fn the_short_way_through_levels_holds_the_exact_distance() {
    let half_axes = [[1.0, 1.0, 1.0], [1.0, 1.0, 0.1], [1.0, 0.1, 0.1]];
    let shapes = half_axes.map(|half_axes| {
        let hierarchy = HierarchyOptions { kind: HierarchyKind::Quadric, ..HierarchyOptions::default() };
        let options = ShapeOptions { hierarchy, ..ShapeOptions::default() };
        Shape::from_mesh(&ellipsoid(half_axes, 2_002).unwrap(), &options).unwrap()
    });
    let mut random = Random::new(23);
    let mut tally = [0; 3];
    for step in [1e-3, 1e-2, 0.1, 1.0] {
        for start in [Start::Automatic, Start::Cache] {
            for (absolute_error, relative_error, step_budget) in
                [(0.03, 0.0, u32::MAX), (0.3, 0.0, u32::MAX), (0.0, 0.1, u32::MAX), (0.1, 0.01, 20), (0.1, 0.0, 3)]
            {
                let [a, b] = [0, 1].map(|_| &shapes[random.below(3)]);
                let plain = PairConfig { absolute_error, relative_error, step_budget, start, ..PairConfig::default() };
                let short = PairConfig { levels: Levels::All, ..plain };
                let mut caches = [PairCache::default(); 2];
                let (axis, distance) = (random.direction(), random.uniform(1.3, 3.5));
                for k in 0..150 {
                    let turn = step * f64::from(k);
                    let pose1 = Pose::new(&rotation(&Vector::z(), 0.7), &Vector::new(0.2, -0.1, 0.3));
                    let away = Vector::new(turn.cos(), turn.sin(), 0.1) * distance;
                    let pose2 = Pose::new(&rotation(&axis, 1.1 * turn), &away);
                    let placed = [a.at(&pose1), b.at(&pose2)];
                    let [mut answer, mut exact] = [PairAnswer::default(); 2];
                    pair::approximate(placed, &mut caches[0], &short, &mut answer).unwrap();
                    pair::distance(placed, &mut caches[1], &PairConfig::default(), &mut exact).unwrap();
                    let holds = answer.lower <= exact.upper && exact.lower <= answer.upper;
                    assert!(holds, "{answer:?} of {short:?} at step {k}, exactly {exact:?}");
                    let by_levels = answer.statistics.levels != [0, 0];
                    tally[by_levels as usize * (1 + usize::from(answer.statistics.marching_steps > 1))] += 1;
                }
            }
        }
    }
    println!("by the bodies, by levels in one step, in more: {tally:?}");
    assert!(tally.iter().all(|count| *count > 300), "{tally:?}");
}

/// The automatic choice: levels for what they may answer of large bodies and maps of support functions are too coarse for, none for
/// the rest; the answers hold the exact ones.
#[test]
fn levels_of_large_bodies_are_used_where_they_save_time() {
    let shape = |n, kind| {
        let hierarchy = HierarchyOptions { kind, ..HierarchyOptions::default() };
        let options = ShapeOptions { hierarchy, ..ShapeOptions::default() };
        Shape::from_mesh(&ellipsoid([1.0, 1.0, 0.1], n).unwrap(), &options).unwrap()
    };
    let (large, small) = (shape(30_002, HierarchyKind::Automatic), shape(1002, HierarchyKind::OuterCuts));
    let (unused, bytes, file) = (large.clone(), large.bytes(), to_bytes(&large).unwrap());
    let mut random = Random::new(17);
    let mut by_levels = 0;
    for round in 0..300 {
        let pose1 = Pose::new(&random.rotation(), &Vector::zeros());
        let pose2 = Pose::new(&random.rotation(), &(random.direction() * random.uniform(0.2, 3.0)));
        for (shape, is_large) in [(&large, true), (&small, false)] {
            let ask = |query: Query, absolute_error| {
                let config = PairConfig { absolute_error, ..PairConfig::default() };
                let (mut cache, mut answer) = (PairCache::default(), PairAnswer::default());
                query([shape.at(&pose1), shape.at(&pose2)], &mut cache, &config, &mut answer).unwrap();
                answer
            };
            let exact = ask(pair::distance, 0.0);
            assert_eq!(exact.statistics.levels, [0, 0]);
            // None is made for what it would not answer.
            if round == 0 && is_large {
                ask(pair::approximate, 0.0);
                ask(pair::intersection, 0.05);
                assert!(shape.hierarchy() == &Hierarchy::AUTOMATIC, "{} levels", shape.hierarchy().levels.len());
            }
            for (query, error) in
                [(pair::intersection as Query, 0.0), (pair::approximate, 0.002), (pair::approximate, 1e-6)]
            {
                let answer = ask(query, error);
                assert_eq!(answer.outcome, exact.outcome, "round {round}");
                assert!(answer.lower <= exact.upper && exact.lower <= answer.upper, "{answer:?} {exact:?}");
                let levels = answer.statistics.levels != [0, 0];
                assert!(!levels || (is_large && error == 0.002), "{answer:?}");
                by_levels += usize::from(levels);
            }
        }
    }
    assert!(by_levels > 100, "{by_levels}");
    // They were made by the first query that they may answer, and what is saved or equal does not depend on that.
    assert!(large.hierarchy().levels.len() > 3 && unused.hierarchy().levels.is_empty());
    let table = large.polyhedron().lookup.heap_bytes();
    assert_eq!(large.bytes(), bytes + large.hierarchy().heap_bytes() + table);
    assert_eq!(large, unused);
    assert!(to_bytes(&large).unwrap() == file && from_bytes(&file).unwrap() == large);
}

/// A body of automatic levels between ones that have none, and all levels asked for.
#[test]
fn automatic_levels_are_made_where_all_are_asked_for() {
    let shape = |n| Shape::from_mesh(&ellipsoid([1.0, 0.6, 0.3], n).unwrap(), &ShapeOptions::default()).unwrap();
    let (large, small) = (shape(30_000), shape(29_999));
    let away = Pose::new(&Matrix::identity(), &Vector::new(4.0, 1.0, 0.5));
    let config = PairConfig { levels: Levels::All, absolute_error: 0.5, ..PairConfig::default() };
    let (mut cache, mut answer) = (PairCache::default(), PairAnswer::default());
    pair::approximate([large.at(&Pose::IDENTITY), small.at(&away)], &mut cache, &config, &mut answer).unwrap();
    assert!(answer.upper - answer.lower <= 0.5, "{answer:?}");
    assert!(answer.statistics.levels[0] > 0 && answer.statistics.levels[1] == 0, "{answer:?}");
    assert!(!large.hierarchy().levels.is_empty() && small.hierarchy().levels.is_empty());
    // Spheres that overlap, bodies that do not: whatever is asked, prepared or not, the answer is the same.
    let near = Pose::new(&Matrix::identity(), &Vector::new(0.0, 0.0, 0.8));
    for query in [pair::approximate as Query, pair::intersection, pair::distance, pair::contact] {
        let answers = [false, true].map(|is_prepared| {
            let shape = shape(30_000);
            if is_prepared {
                shape.prepare(&mut Progress::new(&mut |_| true)).unwrap();
                assert_eq!(shape.hierarchy(), large.hierarchy());
            }
            let (mut cache, mut answer) = (PairCache::default(), PairAnswer::default());
            query([shape.at(&Pose::IDENTITY), small.at(&near)], &mut cache, &config, &mut answer).unwrap();
            assert!(!shape.hierarchy().levels.is_empty());
            assert_eq!(answer.outcome, Outcome::Separated);
            // NaN is not equal to NaN.
            format!("{answer:?} {cache:?}")
        });
        assert_eq!(answers[0], answers[1]);
    }
}

/// A relative error allows for as much as it is of the distance of the bounding spheres, of large and of small bodies. (More than
/// that of large ones is answered by maps of support functions.)
#[test]
fn a_relative_error_is_answered_by_levels_of_bodies_far_apart() {
    let shape = |n| Shape::from_mesh(&ellipsoid([1.0, 0.6, 0.3], n).unwrap(), &ShapeOptions::default()).unwrap();
    let large = shape(30_000);
    let [plate, long] = leveled_pair(HierarchyKind::Quadric);
    let relative = PairConfig { relative_error: 0.05, ..PairConfig::default() };
    let all = PairConfig { levels: Levels::All, ..relative };
    let ask = |[a, b]: [&Shape; 2], pose: &Pose, config: PairConfig, cache: &mut PairCache| {
        let mut answer = PairAnswer::default();
        pair::approximate([a.at(&Pose::IDENTITY), b.at(pose)], cache, &config, &mut answer).unwrap();
        answer
    };
    // Spheres that overlap promise no distance, and of a small one 0.5 % are too little.
    let at = |x: f64| Pose::new(&rotation(&Vector::y(), 0.5), &Vector::new(0.3, 0.2, x));
    let near =
        [(0.9, 0.05), (2.01, 0.005)].map(|(x, relative_error)| (at(x), PairConfig { relative_error, ..relative }));
    for (pose, config) in &near {
        let answer = ask([&large, &large], pose, *config, &mut PairCache::default());
        assert!(answer.outcome == Outcome::Separated && answer.statistics.levels == [0, 0], "{answer:?}");
    }
    assert_eq!(large.hierarchy(), &Hierarchy::AUTOMATIC);
    let little = PairConfig { relative_error: 0.002, ..relative };
    for (shapes, config) in [([&large, &large], little), ([&plate, &long], all)] {
        let mut cache = PairCache::default();
        for k in 0..20 {
            let pose = at(3.0 + 0.01 * f64::from(k));
            let mut fresh = PairCache::default();
            for cache in [&mut cache, &mut fresh] {
                let answer = ask(shapes, &pose, config, cache);
                assert!(answer.statistics.levels.iter().all(|level| *level > 0), "{k}: {answer:?}");
                let most = config.relative_error * answer.lower;
                assert!(answer.lower > 0.0 && answer.upper - answer.lower <= most, "{k}: {answer:?}");
                verify([shapes[0].at(&Pose::IDENTITY), shapes[1].at(&pose)], &answer).unwrap();
            }
        }
    }
    assert!(!large.hierarchy().levels.is_empty());
    // Made already, they answer no more than before.
    for (pose, config) in &near {
        let answer = ask([&large, &large], pose, *config, &mut PairCache::default());
        assert_eq!(answer.statistics.levels, [0, 0], "{answer:?}");
    }
}

/// Two bodies of 100,000 vertices, for which a verdict near by is worth levels.
#[test]
fn no_levels_are_made_where_nothing_asks_for_them() {
    let shape = Shape::from_mesh(&ellipsoid([1.0, 0.6, 0.3], 100_000).unwrap(), &ShapeOptions::default()).unwrap();
    let at = |x: f64| Pose::new(&Matrix::identity(), &Vector::new(x, 0.0, 0.0));
    let mut skewed = at(0.7);
    skewed.rows[0][0] = f64::NAN;
    let ask = |query: Query, pose: &Pose, config: PairConfig| {
        let (mut cache, mut answer) = (PairCache::default(), PairAnswer::default());
        query([shape.at(&Pose::IDENTITY), shape.at(pose)], &mut cache, &config, &mut answer).map(|()| answer.decided_by)
    };
    let plain = PairConfig::default();
    let nan = PairConfig { max_distance: f64::NAN, ..plain };
    assert_eq!(ask(pair::intersection, &at(1000.0), plain), Ok(DecidedBy::BoundingSpheres));
    let within = PairConfig { max_distance: 10.0, absolute_error: 0.1, ..plain };
    assert_eq!(ask(pair::approximate, &at(1000.0), within), Ok(DecidedBy::BoundingSpheres));
    assert!(matches!(ask(pair::intersection, &skewed, plain), Err(Error::Pose(_))));
    for x in [0.7, 1000.0] {
        assert!(matches!(ask(pair::intersection, &at(x), nan), Err(Error::Argument(_))));
    }
    // The finest level will stand off by more than 1e-4.
    for absolute_error in [1e-300, 5e-5] {
        ask(pair::approximate, &at(0.7), PairConfig { absolute_error, ..plain }).unwrap();
    }
    ask(pair::intersection, &at(0.7), PairConfig { levels: Levels::None, ..plain }).unwrap();
    ask(pair::contact, &at(0.7), plain).unwrap();
    assert_eq!(shape.hierarchy(), &Hierarchy::AUTOMATIC);
    // One vertex less than it takes.
    let smaller = Shape::from_mesh(&ellipsoid([1.0, 0.6, 0.3], 99_999).unwrap(), &ShapeOptions::default()).unwrap();
    let (mut cache, mut answer) = (PairCache::default(), PairAnswer::default());
    pair::intersection([shape.at(&Pose::IDENTITY), smaller.at(&at(1.2))], &mut cache, &plain, &mut answer).unwrap();
    assert_eq!((shape.hierarchy(), smaller.hierarchy()), (&Hierarchy::AUTOMATIC, &Hierarchy::AUTOMATIC));
    ask(pair::intersection, &at(1.2), plain).unwrap();
    assert!(shape.hierarchy().levels.len() > 3);
    assert!(2.0 * shape.hierarchy().levels[0].deviation > 1e-4);
}

/// A body whose finest level stands off by less than an automatic choice expects: a cap of very many vertices. Whatever levels are
/// made already, the answer is the same.
#[test]
fn what_is_made_already_changes_no_answer() {
    let cap = |i: usize| {
        let (turn, part) = (2.4 * i as f64, (i as f64 / 31_000.0).sqrt());
        let (x, y) = (1e-3 * part * turn.cos(), 1e-3 * part * turn.sin());
        Vector::new(x, y, (1.0 - x * x - y * y).sqrt())
    };
    let far = [[1.0, 0.0, 0.0], [-1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, -1.0, 0.0], [0.0, 0.0, -1.0]];
    let points: Vec<Vector> = (0..31_000).map(cap).chain(far.map(Vector::from)).collect();
    let shape = || Shape::from_points(&points, &ShapeOptions::default()).unwrap();
    let prepared = shape();
    prepared.prepare(&mut Progress::new(&mut |_| true)).unwrap();
    let finest = prepared.hierarchy().levels[0].deviation;
    assert!(finest < 1e-5, "{finest:e}");
    let away = Pose::new(&Matrix::identity(), &Vector::new(0.1, 0.2, 1.5));
    for absolute_error in [1.0, 2.5, 1e3].map(|times| 2.0 * finest * times) {
        let answers = [[false; 2], [true, false], [false, true], [true; 2]].map(|made| {
            let shapes = made.map(|is_made| if is_made { prepared.clone() } else { shape() });
            let (mut cache, mut answer) = (PairCache::default(), PairAnswer::default());
            let config = PairConfig { absolute_error, ..PairConfig::default() };
            let [a, b] = &shapes;
            pair::approximate([a.at(&Pose::IDENTITY), b.at(&away)], &mut cache, &config, &mut answer).unwrap();
            // NaN is not equal to NaN.
            format!("{answer:?} {cache:?}")
        });
        assert!(answers.iter().all(|answer| *answer == answers[0]), "{answers:?}");
    }
}

#[test]
fn settings_out_of_range_are_refused() {
    let [a, b] = leveled_pair(HierarchyKind::None);
    let good = PairConfig::default();
    for config in [
        PairConfig { absolute_error: -1.0, ..good },
        PairConfig { absolute_error: f64::NAN, ..good },
        PairConfig { relative_error: -1e-300, ..good },
        PairConfig { relative_error: f64::NAN, ..good },
        PairConfig { max_distance: f64::NAN, ..good },
        PairConfig { step_budget: 0, ..good },
    ] {
        for levels in [Levels::Automatic, Levels::All] {
            let config = PairConfig { levels, ..config };
            let (mut cache, mut answer) = (PairCache::default(), PairAnswer::default());
            let result =
                pair::approximate([a.at(&Pose::IDENTITY), b.at(&Pose::IDENTITY)], &mut cache, &config, &mut answer);
            assert!(matches!(result, Err(Error::Argument(_))), "{config:?}");
            assert_eq!((answer.outcome, cache), (Outcome::None, PairCache::default()));
        }
    }
}
