//! Forged answers are refused.

use std::cmp::Ordering;

use dashu_ratio::RBig;
use swiftprox::error::Error;
use swiftprox::math::{Matrix, Pose, Vector};
use swiftprox::motion::{CastAnswer, CastConfig, CastOutcome, Motion, Moving, verify_cast};
use swiftprox::pair::contact;
use swiftprox::pair::{PairAnswer, PairCache, PairConfig};
use swiftprox::shape::{InputPolicy, Shape, ShapeOptions};
use testkit::oracle::{Polytope, rational, truth};
use testkit::random::{Random, rotation};
use testkit::shapes::cuboid;

use crate::{at, moving, run, screw, straight};

#[test]
fn forged_answers_are_refused() {
    let (cube, bar) = (cuboid([0.5; 3]), cuboid([0.1, 0.2, 2.0]));
    let still = Motion::Fixed(Pose::IDENTITY);
    let hitting = screw(at(3.0, 0.1, 0.2), [-4.0, 0.0, 0.0], [1.0, 2.0, 0.5]);
    let missing = screw(at(-4.0, 3.2, 0.2), [8.0, 0.0, 0.0], [0.4, 0.2, 0.5]);
    let max_distance = CastConfig { max_distance: 0.1, ..CastConfig::default() };
    for config in [CastConfig::default(), max_distance] {
        let hit = moving([&bar, &cube], [&hitting, &still]);
        let answer = run(hit, &config);
        assert_eq!(answer.outcome, CastOutcome::Hit);
        verify_cast(hit, &config, &answer).unwrap();
        let later = CastAnswer { time_lower: answer.time_upper, ..answer };
        let sooner = CastAnswer { time_upper: answer.time_lower, ..answer };
        let outside = CastAnswer { time_upper: 1.5, ..answer };
        let swapped = CastAnswer { time_lower: answer.time_upper, time_upper: answer.time_lower, ..answer };
        let no_contact = CastAnswer { contact: Default::default(), ..answer };
        let mut far = answer;
        far.contact.world1[0] += 1e-9;
        let mut no_proof = answer;
        (no_proof.proof[0], no_proof.proof_count) = ([0, 0], 1);
        let none = CastAnswer { time_lower: f64::NAN, ..answer };
        let free = CastAnswer {
            outcome: CastOutcome::Free,
            time_lower: 1.0,
            clearance: config.max_distance,
            ..CastAnswer::default()
        };
        let beyond = CastAnswer { outcome: CastOutcome::Budget, time_lower: 0.9, ..CastAnswer::default() };
        for forged in [later, sooner, outside, swapped, no_contact, far, no_proof, none, free, beyond] {
            let refused = verify_cast(hit, &config, &forged);
            assert!(matches!(refused, Err(Error::Unverified(_))), "{forged:?}: {refused:?}");
        }
        let said_nothing = verify_cast(hit, &config, &CastAnswer::default());
        assert!(matches!(said_nothing, Err(Error::Argument(_))), "{said_nothing:?}");

        let free = moving([&bar, &cube], [&missing, &still]);
        let answer = run(free, &config);
        assert_eq!(answer.outcome, CastOutcome::Free, "{answer:?}");
        verify_cast(free, &config, &answer).unwrap();
        let too_far = CastAnswer { clearance: 5.0, ..answer };
        let too_near = CastAnswer { clearance: config.max_distance - 0.01, ..answer };
        let partial = CastAnswer { time_lower: 0.5, ..answer };
        let with_time = CastAnswer { time_upper: 0.5, ..answer };
        let as_near = CastAnswer { outcome: CastOutcome::Near, upper: 0.01, ..answer };
        for forged in [too_far, too_near, partial, with_time, as_near] {
            let refused = verify_cast(free, &config, &forged);
            assert!(matches!(refused, Err(Error::Unverified(_))), "{forged:?}: {refused:?}");
        }
        // Of other motions neither holds.
        let other = straight(at(3.0, 0.1, 0.2), [-4.0, 0.0, 0.0]);
        assert!(verify_cast(moving([&bar, &cube], [&other, &still]), &config, &answer).is_err());
    }
}

fn swept(points: &[Vector], swept_radius: f64) -> Shape {
    let options = ShapeOptions { input: InputPolicy::Hull, swept_radius, ..ShapeOptions::default() };
    Shape::from_points(points, &options).unwrap()
}

fn is_refused(pair: [Moving; 2], config: &CastConfig, forged: &CastAnswer) -> bool {
    matches!(verify_cast(pair, config, forged), Err(Error::Unverified(_)))
}

/// A pose at a time as the motion's entries are computed.
fn computed(start: &Pose, end: &Pose, time: f64) -> Pose {
    let entry = |i: usize, k: usize| (1.0 - time) * start.rows[i][k] + time * end.rows[i][k];
    Pose { rows: std::array::from_fn(|i| std::array::from_fn(|k| entry(i, k))) }
}

/// Points at a time, as the motion's entries are in rational numbers.
fn points_at(points: &[Vector], [start, end]: &[Pose; 2], time: f64) -> Polytope {
    let (time, rest) = (rational(time), RBig::ONE - rational(time));
    let at = |p: &Vector| {
        std::array::from_fn(|i| {
            let entry = |k: usize| &rest * rational(start.rows[i][k]) + &time * rational(end.rows[i][k]);
            (0..3).fold(entry(3), |sum, k| sum + entry(k) * rational(p[k]))
        })
    };
    Polytope::from_rationals(points.iter().map(at).collect())
}

/// Round bodies whose poses change linearly from one skewed pose to another. Between two doubles they are apart at the first and
/// not at the second, in rational numbers: free until the second is refused, and a hit at the first.
#[test]
fn one_double_beyond_the_first_contact_is_refused() {
    const IDENTITY: [f64; 12] = [1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0];
    let mut random = Random::new(0xf1257);
    let mut hits = 0;
    for round in 0..60 {
        let points =
            [1 + round % 4, 1 + round / 4 % 4].map(|count| (0..count).map(|_| random.vector()).collect::<Vec<_>>());
        let radii = [random.pick(&[0.0, 0.3]), random.uniform(0.1, 1.0)];
        let shapes = [swept(&points[0], radii[0]), swept(&points[1], radii[1])];
        let skew = random.pick(&[0.0, 1e-9, 1e-3]);
        let poses = [0, 1].map(|i| {
            let turn = random.rotation() + Matrix::from_fn(|_, _| skew * random.signed());
            let later = rotation(&random.direction(), random.uniform(0.0, 0.1)) * turn;
            let [from, to] =
                [[4.0, 0.5], [-4.0, 0.2]][i].map(|x| Vector::new(x, 0.5 * random.signed(), 0.5 * random.signed()));
            [Pose::new(&turn, &from), Pose::new(&later, &to)]
        });
        let motions = poses.map(|[start, end]| Motion::Affine { start, end });
        let pair = moving([&shapes[0], &shapes[1]], [&motions[0], &motions[1]]);
        let max_distance = random.pick(&[0.0, 0.125]);
        let config = CastConfig { max_distance, ..CastConfig::default() };
        let answer = run(pair, &config);
        assert_eq!(verify_cast(pair, &config, &answer), Ok(()), "{round} {answer:?}");
        if answer.outcome != CastOutcome::Hit || answer.time_lower == 0.0 {
            continue;
        }
        hits += 1;
        let reach = rational(radii[0]) + rational(radii[1]) + rational(max_distance);
        let beyond = |time: f64| {
            let [first, second] = [0, 1].map(|i| points_at(&points[i], &poses[i], time));
            truth(&first, &IDENTITY, &second, &IDENTITY).squared_distance.cmp(&(&reach * &reach))
        };
        let (mut apart, mut within) = (answer.time_lower, answer.time_upper);
        assert!(beyond(apart) == Ordering::Greater && beyond(within) != Ordering::Greater, "{round} {answer:?}");
        while apart.next_up() < within {
            let middle = 0.5 * (apart + within);
            *(if beyond(middle) == Ordering::Greater { &mut apart } else { &mut within }) = middle;
        }
        let contact_at = |time: f64| {
            let [first, second] = poses.map(|[start, end]| computed(&start, &end, time));
            let mut answer = PairAnswer::default();
            let placed = [shapes[0].at(&first), shapes[1].at(&second)];
            contact(placed, &mut PairCache::default(), &PairConfig::default(), &mut answer).unwrap();
            answer
        };
        for time_lower in [within, answer.time_upper] {
            assert!(
                is_refused(
                    pair,
                    &config,
                    &CastAnswer { time_lower, time_upper: time_lower.max(answer.time_upper), ..answer }
                ),
                "{round} {time_lower}"
            );
            let budget = CastAnswer { outcome: CastOutcome::Budget, time_lower, ..CastAnswer::default() };
            assert!(is_refused(pair, &config, &budget), "{round} {time_lower}");
        }
        for time_upper in [apart, answer.time_lower] {
            let PairAnswer { proof, proof_count, .. } = contact_at(time_upper);
            let sooner = CastAnswer { time_upper, proof, proof_count, ..answer };
            assert!(is_refused(pair, &config, &sooner), "{round} {time_upper}");
            assert!(is_refused(pair, &config, &CastAnswer { time_upper, ..answer }), "{round} {time_upper}");
        }
    }
    assert!(hits > 30, "{hits}");
}

/// A ball of 1/2 that flies at a cube of half side 1 from x = 3: at time t they are 1.5 − 2t apart. Another passes it at a
/// distance of a quarter; and one whose pose at time 1, where it touches, is told exactly.
#[test]
fn closed_forms_of_flights_are_told_to_the_double_or_to_rounding() {
    let (ball, cube) = (swept(&[Vector::zeros()], 0.5), cuboid([1.0; 3]));
    let still = Motion::Fixed(Pose::IDENTITY);
    let to = |start: Pose, end: Pose| Motion::Affine { start, end };
    // Moved about its own middle, which a ball does not see.
    let shrunk = |x: f64| Pose::new(&Matrix::from_diagonal_element(1.0 - 1e-3), &Vector::new(x, 0.0, 0.0));
    for flight in [
        straight(at(3.0, 0.0, 0.0), [-2.0, 0.0, 0.0]),
        to(at(3.0, 0.0, 0.0), shrunk(1.0)),
        to(shrunk(3.0), at(1.0, 0.0, 0.0)),
    ] {
        let pair = moving([&ball, &cube], [&flight, &still]);
        for max_distance in [0.0, 0.25] {
            let config = CastConfig { max_distance, ..CastConfig::default() };
            let answer = run(pair, &config);
            let first = 0.75 - 0.5 * max_distance;
            assert_eq!((answer.outcome, verify_cast(pair, &config, &answer)), (CastOutcome::Hit, Ok(())), "{answer:?}");
            let free_before = CastAnswer { outcome: CastOutcome::Budget, ..CastAnswer::default() };
            let until = |time_lower: f64| verify_cast(pair, &config, &CastAnswer { time_lower, ..free_before });
            assert_eq!(until(first - 1e-12), Ok(()));
            assert!([first, first.next_up()].iter().all(|&time_lower| until(time_lower).is_err()));
            assert!(is_refused(pair, &config, &CastAnswer { time_upper: first.next_down(), ..answer }));
            if max_distance > 0.0 {
                let apart = 1.5 - 2.0 * answer.time_upper;
                // The width that docs/conventions.md promises, of centres at most 1.25 apart.
                assert!(answer.upper >= apart && answer.upper < apart + 2e-14 * 1.25, "{:e}", answer.upper - apart);
                for upper in [apart.next_down(), 0.0] {
                    assert!(is_refused(pair, &config, &CastAnswer { upper, ..answer }), "{upper:e}");
                }
            }
        }
    }
    let passing = straight(at(-4.0, 1.75, 0.0), [8.0, 0.0, 0.0]);
    let pair = moving([&ball, &cube], [&passing, &still]);
    let config = CastConfig::default();
    let answer = run(pair, &config);
    assert_eq!((answer.outcome, verify_cast(pair, &config, &answer)), (CastOutcome::Free, Ok(())), "{answer:?}");
    let with = |clearance: f64| verify_cast(pair, &config, &CastAnswer { clearance, ..answer });
    assert_eq!(with(0.25 - 1e-12), Ok(()));
    assert!([0.25, 0.25_f64.next_up(), 0.3].iter().all(|&clearance| with(clearance).is_err()));

    let arriving = to(at(3.5, 0.0, 0.0), at(1.5, 0.0, 0.0));
    let pair = moving([&ball, &cube], [&arriving, &still]);
    let answer = run(pair, &config);
    assert_eq!(
        (answer.outcome, answer.time_upper, verify_cast(pair, &config, &answer)),
        (CastOutcome::Hit, 1.0, Ok(()))
    );
    assert!(is_refused(pair, &config, &CastAnswer { time_upper: 1.0_f64.next_down(), ..answer }));
    assert!(is_refused(pair, &config, &CastAnswer { time_lower: 1.0, ..answer }));
}
