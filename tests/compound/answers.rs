//! Verdicts and distances.

use super::bodies::{self, Body, for_each_pair, least_truth};
use swiftprox::compound::{Compound, CompoundAnswer, CompoundCache, Piece, PlacedCompound, distance, intersection};
use swiftprox::error::Error;
use swiftprox::math::{Matrix, Pose, Vector};
use swiftprox::pair::{self, Outcome, PairAnswer, PairCache, PairConfig};
use testkit::oracle::Truth;
use testkit::random::Random;

fn within(max_distance: f64) -> PairConfig {
    PairConfig { max_distance, ..PairConfig::default() }
}

fn asked_distance(placed: [PlacedCompound; 2], cache: &mut CompoundCache, config: &PairConfig) -> CompoundAnswer {
    let mut answer = CompoundAnswer::default();
    distance(placed, cache, config, &mut answer).unwrap();
    answer
}

fn asked_verdict(placed: [PlacedCompound; 2], cache: &mut CompoundCache, config: &PairConfig) -> CompoundAnswer {
    let mut answer = CompoundAnswer::default();
    intersection(placed, cache, config, &mut answer).unwrap();
    answer
}

/// A cache of any bytes.
fn any_cache(random: &mut Random) -> CompoundCache {
    let mut words = vec![0_u32; size_of::<CompoundCache>() / 4];
    let small = random.below(2) == 0;
    for word in &mut words {
        *word = if small { random.below(50) as u32 } else { random.next_u64() as u32 };
    }
    assert!(align_of::<CompoundCache>() <= align_of::<u32>());
    // SAFETY: the type is repr(C) and made of 32-bit words, of which any make a valid cache: that is what is tested.
    #[allow(unsafe_code)]
    unsafe {
        words.as_ptr().cast::<CompoundCache>().read()
    }
}

/// All that two queries say, against the truth.
fn check(truth: &Truth, placed: [PlacedCompound; 2], cache: &mut CompoundCache) -> Outcome {
    let counts = placed.map(|body| body.compound.piece_count() as u32);
    let far = asked_distance(placed, cache, &PairConfig::default());
    let CompoundAnswer { answer, piece1, piece2 } = far;
    assert!(truth.lies_between(answer.lower, answer.upper), "{answer:?}");
    assert_eq!(answer.outcome == Outcome::Intersecting, truth.intersecting());
    assert!(answer.lower <= answer.distance && answer.distance <= answer.upper);
    for_each_pair(placed, |pieces, bodies| {
        if pieces == [piece1, piece2] {
            // The interval is that of all: the pieces' own lower end may be greater, so it holds for them, too.
            swiftprox::verify::verify(bodies, &answer).unwrap();
        }
    });
    assert!(piece1 < counts[0] && piece2 < counts[1]);

    let verdict = asked_verdict(placed, cache, &PairConfig::default());
    assert_eq!(verdict.answer.outcome, answer.outcome);
    assert!(truth.lies_between(verdict.answer.lower, verdict.answer.upper));
    match answer.outcome {
        Outcome::Intersecting => assert!(verdict.piece1 < counts[0] && verdict.piece2 < counts[1]),
        _ => {
            assert!(verdict.answer.lower > 0.0 && [verdict.piece1, verdict.piece2] == counts);
            for query in [asked_distance, asked_verdict] {
                let tolerance = 0.5 * answer.lower;
                let below = query(placed, cache, &within(tolerance)).answer;
                assert_eq!(below.outcome, Outcome::Beyond);
                assert!(below.lower >= tolerance && truth.lies_between(below.lower, f64::INFINITY));
                let above = query(placed, cache, &within(2.0 * answer.upper));
                assert_eq!(above.answer.outcome, Outcome::Separated);
                assert!(above.piece1 < counts[0]);
                assert!(truth.lies_between(above.answer.lower, above.answer.upper));
            }
        }
    }
    answer.outcome
}

/// Small bodies of placed, skewed and flat pieces, cold, stale and random caches.
#[test]
fn answers_hold_in_rational_numbers() {
    let mut random = Random::new(0xc0);
    let mut seen = [0; 2];
    for round in 0..150 {
        let parts = [1 + random.below(5), 1 + random.below(5)];
        let bodies = parts.map(|count| bodies::any(&mut random, count));
        let mut cache = if round % 3 == 0 { any_cache(&mut random) } else { CompoundCache::default() };
        for _ in 0..2 {
            let far = if random.below(8) == 0 { 1e4 } else { 0.0 };
            let offset = Vector::repeat(far);
            let poses = [0, 1].map(|_| {
                let near = bodies::pose(&mut random, 0.4);
                Pose::new(&near.rotation(), &(near.translation() + offset))
            });
            let truth = least_truth([&bodies[0], &bodies[1]], [&poses[0], &poses[1]]);
            let placed = [bodies[0].compound.at(&poses[0]), bodies[1].compound.at(&poses[1])];
            seen[usize::from(check(&truth, placed, &mut cache) == Outcome::Intersecting)] += 1;
        }
    }
    assert!(seen.iter().all(|count| *count >= 15), "{seen:?}");
}

/// The least over all pairs of pieces, each asked cold.
fn brute_force(placed: [PlacedCompound; 2]) -> PairAnswer {
    let mut least = PairAnswer { upper: f64::INFINITY, lower: f64::INFINITY, ..PairAnswer::default() };
    for_each_pair(placed, |_, bodies| {
        let mut answer = PairAnswer::default();
        pair::distance(bodies, &mut PairCache::default(), &PairConfig::default(), &mut answer).unwrap();
        let lower = least.lower.min(answer.lower);
        if answer.upper < least.upper {
            least = answer;
        }
        least.lower = lower;
    });
    least
}

fn agree(placed: [PlacedCompound; 2], cache: &mut CompoundCache) -> Outcome {
    let expected = brute_force(placed);
    let found = asked_distance(placed, cache, &PairConfig::default()).answer;
    assert_eq!(found.outcome, expected.outcome);
    assert!(found.lower <= expected.upper && expected.lower <= found.upper, "{found:?} {expected:?}");
    assert!(found.upper - found.lower <= 1e-13 * (4.0 + found.upper), "{found:?}");
    let verdict = asked_verdict(placed, cache, &PairConfig::default()).answer;
    assert_eq!(verdict.outcome, expected.outcome);
    assert!(verdict.lower <= expected.upper);
    found.outcome
}

/// Rings and gears that turn past each other, with one cache all along: it goes stale, and is now and then any bytes.
#[test]
fn trees_find_the_least_over_all_pairs() {
    let mut random = Random::new(0xc1);
    let pairs: [[Body; 2]; 4] = [
        [bodies::torus(24), bodies::torus(24)],
        [bodies::gear(20), bodies::gear(20)],
        [bodies::placed_torus(16), bodies::gear(12)],
        [bodies::any(&mut random, 40), bodies::any(&mut random, 1)],
    ];
    let mut seen = [0; 2];
    for [one, two] in &pairs {
        let mut cache = CompoundCache::default();
        for round in 0..60 {
            let poses = match round % 4 {
                0 => [Pose::IDENTITY, bodies::pose(&mut random, 2.5)],
                1 => [bodies::pose(&mut random, 1.0), bodies::pose(&mut random, 1.0)],
                2 => [bodies::pose(&mut random, 1e3), bodies::pose(&mut random, 10.0)],
                // Interlocked.
                _ => {
                    let turn = testkit::random::rotation(&Vector::x(), 1.57 + 0.01 * f64::from(round));
                    [Pose::IDENTITY, Pose::new(&turn, &Vector::new(1.0, 0.0, 0.0))]
                }
            };
            if round % 10 == 9 {
                cache = any_cache(&mut random);
            }
            let outcome = agree([one.compound.at(&poses[0]), two.compound.at(&poses[1])], &mut cache);
            seen[usize::from(outcome == Outcome::Intersecting)] += 1;
        }
    }
    assert!(seen.iter().all(|count| *count > 40), "{seen:?}");
}

/// A walk in small steps: each answer from the last one's cache.
#[test]
fn small_steps_change_no_answer() {
    let mut random = Random::new(0xc2);
    let [one, two] = [bodies::gear(16), bodies::torus(20)];
    for _ in 0..4 {
        let mut cache = CompoundCache::default();
        let (axis, start, way) = (random.direction(), random.rotation(), random.direction() * 0.03);
        for step in 0..50 {
            let turn = testkit::random::rotation(&axis, 0.02 * f64::from(step)) * start;
            let pose = Pose::new(&turn, &(way * f64::from(step) + Vector::new(0.9, 0.0, 0.0)));
            agree([one.compound.at(&Pose::IDENTITY), two.compound.at(&pose)], &mut cache);
        }
    }
}

/// Sizes near the ends of the doubles, and swept radii.
#[test]
fn any_size_is_answered() {
    for scale in [1e-160, 1e-60, 1e60, 1e140, 1e152] {
        let cube: Vec<Vector> =
            (0..8).map(|i| Vector::from_fn(|k, _| if i >> k & 1 == 0 { 0.0 } else { scale })).collect();
        let part = |x: f64| (cube.clone(), Pose::new(&Matrix::identity(), &Vector::new(x * scale, 0.0, 0.0)));
        let body = Body::new(vec![part(0.0), part(2.0), part(4.0)]);
        for (x, outcome) in [(1.5, Outcome::Intersecting), (5.5, Outcome::Separated), (40.0, Outcome::Separated)] {
            let pose = Pose::new(&Matrix::identity(), &Vector::new(x * scale, 0.0, 0.0));
            let placed = [body.compound.at(&Pose::IDENTITY), body.compound.at(&pose)];
            let mut cache = CompoundCache::default();
            assert_eq!(asked_verdict(placed, &mut cache, &PairConfig::default()).answer.outcome, outcome);
            let answer = asked_distance(placed, &mut cache, &PairConfig::default()).answer;
            assert_eq!(answer.outcome, outcome);
            if outcome == Outcome::Separated {
                let truth = (x - 5.0) * scale;
                assert!(answer.lower <= truth * (1.0 + 1e-12) && truth * (1.0 - 1e-12) <= answer.upper, "{answer:?}");
            }
        }
    }
}

/// Boxes tell how far a body is from a triangle 10¹⁴ long, where a query's normal, which nobody asked for, is off by more than the
/// check allows: integers prove the distance.
#[test]
fn what_boxes_tell_of_a_long_body_is_proved() {
    let compound = |points: &[[f64; 3]]| {
        let points: Vec<Vector> = points.iter().map(|point| Vector::from(*point)).collect();
        let shape = std::sync::Arc::new(testkit::shapes::hull(&points));
        Compound::new(&[Piece { shape, pose: Pose::IDENTITY }]).unwrap()
    };
    let small = compound(&[
        [0.6, 0.0, 0.8],
        [-0.6758097397797128, 0.6190970809322855, 0.4],
        [0.08742572471695988, -0.9961710408648278, 0.0],
        [0.5576434272376702, 0.7273471028736042, -0.4],
        [-0.590828091189257, -0.10450917022758696, -0.8],
    ]);
    let mut pose = Pose::new(&Matrix::identity(), &Vector::repeat(-32.0));
    pose.rows[0][0] = 1.00390625;
    for length in [44, 46, 47, 48, 49, 50] {
        let depth = -f64::from(1_u32 << 16) * f64::from(1_u32 << 24) * f64::from(1_u32 << (length - 40));
        let long = compound(&[[-31.0, -16.0, depth], [-32.0, -25.0, 0.0], [-16.0, -32.0, 0.0]]);
        let placed = [small.at(&pose), long.at(&pose)];
        let far = asked_distance(placed, &mut CompoundCache::default(), &PairConfig::default());
        for part in [0.0, 0.5, 0.9, 0.99, 1.0] {
            let found = asked_distance(placed, &mut CompoundCache::default(), &within(part * far.answer.lower));
            assert_ne!(found.answer.outcome, Outcome::Intersecting);
            swiftprox::compound::verify(placed, &found)
                .unwrap_or_else(|error| panic!("{error}: {part} of {far:?}, {found:?}"));
        }
    }
}

fn sphere(radius: f64) -> swiftprox::shape::Shape {
    use swiftprox::shape::{InputPolicy, Shape, ShapeOptions};
    let options = ShapeOptions { input: InputPolicy::Hull, swept_radius: radius, ..ShapeOptions::default() };
    Shape::from_points(&[Vector::zeros()], &options).unwrap()
}

/// Balls on lines: distances in closed form, under poses that stretch the lines and not the balls.
#[test]
fn swept_pieces_keep_their_radius() {
    let mut random = Random::new(0xc3);
    let ball = std::sync::Arc::new(sphere(0.25));
    let at = |x: f64| Piece { shape: ball.clone(), pose: Pose::new(&Matrix::identity(), &Vector::new(x, 0.0, 0.0)) };
    let chain = Compound::new(&(0..6).map(|k| at(f64::from(k))).collect::<Vec<_>>()).unwrap();
    for _ in 0..200 {
        let poses = [bodies::pose(&mut random, 2.0), bodies::pose(&mut random, 2.0)];
        let centre = |pose: &Pose, k: i32| pose.transform(&Vector::new(f64::from(k), 0.0, 0.0));
        let between = (0..36).map(|n| (centre(&poses[0], n / 6) - centre(&poses[1], n % 6)).norm() - 0.5);
        let truth = between.fold(f64::INFINITY, f64::min);
        let placed = [chain.at(&poses[0]), chain.at(&poses[1])];
        let answer = asked_distance(placed, &mut CompoundCache::default(), &PairConfig::default()).answer;
        let verdict = asked_verdict(placed, &mut CompoundCache::default(), &PairConfig::default()).answer;
        assert_eq!((answer.outcome, verdict.outcome == Outcome::Intersecting), (verdict.outcome, truth <= 0.0));
        if truth > 0.0 {
            assert!(answer.lower <= truth + 1e-13 && truth - 1e-13 <= answer.upper, "{truth} {answer:?}");
        }
    }
}

#[test]
fn refusals_say_what_and_change_nothing() {
    let message = |result: Result<Compound, Error>| result.unwrap_err().message().to_string();
    assert_eq!(message(Compound::new(&[])), "a compound needs at least one piece");
    let shape = std::sync::Arc::new(testkit::shapes::cuboid([1.0; 3]));
    let piece = |pose| Piece { shape: shape.clone(), pose };
    let mirrored = Pose::new(&-Matrix::identity(), &Vector::zeros());
    let refused = message(Compound::new(&[piece(Pose::IDENTITY), piece(mirrored)]));
    assert!(refused.starts_with("piece 1: the rotation is a reflection"), "{refused}");

    let stretched = |by: f64| Pose::new(&(Matrix::identity() * by), &Vector::zeros());
    let body = Compound::new(&[piece(stretched(1.004)), piece(stretched(1.0))]).unwrap();
    let (mut cache, mut answer) = (CompoundCache::default(), CompoundAnswer::default());
    let untouched = (cache.clone(), format!("{answer:?}"));
    let mut ask = |pose: &Pose, config: &PairConfig| {
        let refused = distance([body.at(&Pose::IDENTITY), body.at(pose)], &mut cache, config, &mut answer).unwrap_err();
        assert_eq!((cache.clone(), format!("{answer:?}")), untouched);
        refused.message().to_string()
    };
    let infinite = Pose::new(&Matrix::identity(), &Vector::new(f64::INFINITY, 0.0, 0.0));
    assert!(ask(&infinite, &PairConfig::default()).contains("is not finite"));
    assert!(ask(&Pose::IDENTITY, &within(f64::NAN)).contains("max_distance"));
    // Each is accepted, their product is not.
    let both = ask(&stretched(1.004), &PairConfig::default());
    assert!(both.starts_with("piece 0 at that pose: the rotation is not orthonormal"), "{both}");
}

/// Linked rings that tremble, then part: verdicts from the front are those of fresh walks, and the front follows the bodies.
#[test]
fn verdicts_begin_at_the_front_of_the_last() {
    let (ring, mut random) = (bodies::torus(24), Random::new(0xf07));
    let upright = Matrix::new(1.0, 0.0, 0.0, 0.0, 0.0, -1.0, 0.0, 1.0, 0.0);
    let (mut cache, mut lengths, mut seen) = (CompoundCache::default(), Vec::new(), [0; 2]);
    for step in 0..160 {
        // To one side, until they meet; back, and straight out of each other.
        let way = match step {
            0..80 => Vector::x() * (1.0 + 0.005 * f64::from(step)),
            _ => Vector::x() + Vector::x() * (0.05 * f64::from(step - 80)),
        };
        let poses = [Pose::new(&upright, &(way + random.vector() * 0.003)), Pose::IDENTITY];
        let placed = [ring.compound.at(&poses[0]), ring.compound.at(&poses[1])];
        let found = asked_verdict(placed, &mut cache, &PairConfig::default()).answer;
        let fresh = asked_verdict(placed, &mut CompoundCache::default(), &PairConfig::default()).answer;
        assert_eq!(found.outcome, fresh.outcome);
        let exact = asked_distance(placed, &mut CompoundCache::default(), &PairConfig::default()).answer;
        assert!(found.lower <= exact.upper && (found.lower > 0.0) == (found.outcome == Outcome::Separated));
        seen[usize::from(found.outcome == Outcome::Intersecting)] += 1;
        lengths.push(cache.front_tiles([&ring.compound, &ring.compound]).unwrap().len());
    }
    assert!(seen.iter().all(|count| *count >= 20), "{seen:?}");
    // The first verdict leaves a place alone.
    assert!(lengths[0] == 1 && lengths[1..10].iter().all(|length| *length > 10), "{lengths:?}");
    // Where they are far apart it is short again.
    assert!(lengths[159] < lengths[1] / 2, "{lengths:?}");
}
