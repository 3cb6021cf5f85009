//! The catalogue of hard families (`testkit/src/hard`) against everything that answers promise: the truth, computed in
//! integers without the library; the independence of warm starts and of levels of detail; the independence of how a pair is told.
//!
//! `HARD_SEED` and `HARD_COUNT` (sequences a family, each family's sweep of its parameters otherwise) make other runs,
//! `HARD_FAMILY` runs one family alone. The counts of every family, how its queries ended and in how many steps, are printed:
//! `cargo test --profile checked --test hard -- --nocapture`.

mod history;
mod levels;
mod retelling;
mod truth;

use std::collections::BTreeSet;
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};

use swiftprox::pair::{Outcome, PairAnswer, PairCache};
use swiftprox::shape::Shape;
use swiftprox::verify::verify;
use testkit::bodies::Body;
use testkit::cases::{Case, Random};
use testkit::hard::flight::{Table, Tally, fly, poses, shapes};
use testkit::hard::{Family, Sequence, families, triangles};
use testkit::properties::{Placed, Session, excess_work_without_levels};
use truth::ExactPair;

/// What a test does not like, and how to repeat it.
struct Violation {
    what: String,
    /// Family, seed and index of the sequence, number of the pose.
    place: String,
}

/// A sequence at work: its bodies and where it comes from.
struct Flight<'a> {
    family: &'a Family,
    seed: u64,
    index: usize,
    sequence: &'a Sequence,
    shapes: [&'a Shape; 2],
    tally: Tally,
    violations: Vec<Violation>,
}

impl Flight<'_> {
    fn violated(&mut self, number: usize, what: String) {
        let place = format!("{} seed {} sequence {} pose {number}", self.family.name, self.seed, self.index);
        self.violations.push(Violation { what, place });
    }

    /// A seed of its own for a test.
    fn seed_of(&self, test: u64) -> u64 {
        test ^ self.seed.rotate_left(32) ^ (self.index as u64) << 8 ^ self.family.name.len() as u64
    }

    /// Randomness of its own for a test.
    fn random(&self, test: u64) -> Random {
        Random::new(self.seed_of(test))
    }
}

fn setting(name: &str, default: u64) -> u64 {
    std::env::var(name).map_or(default, |text| text.parse().unwrap_or_else(|_| panic!("{name}={text}: not a number")))
}

/// Runs a test over the sequences of every family, on two threads, and fails with what it found.
fn over_all_families(test: &str, run: impl Fn(&mut Flight) + Sync) -> Vec<(&'static str, Tally)> {
    let seed = setting("HARD_SEED", 1);
    let only = std::env::var("HARD_FAMILY").ok();
    let wanted: Vec<&Family> =
        families().filter(|family| only.as_ref().is_none_or(|name| name == family.name)).collect();
    assert!(!wanted.is_empty(), "HARD_FAMILY: no such family");
    let count = |family: &Family| setting("HARD_COUNT", family.sweep as u64) as usize;
    let jobs: Vec<(usize, usize)> =
        (0..wanted.len()).flat_map(|which| (0..count(wanted[which])).map(move |index| (which, index))).collect();
    let results = Mutex::new((vec![Tally::default(); wanted.len()], Vec::new()));
    let next = AtomicUsize::new(0);
    let work = || {
        loop {
            let Some(&(which, index)) = jobs.get(next.fetch_add(1, Ordering::Relaxed)) else { return };
            let sequence = wanted[which].sequence(seed, index);
            let [first, second] = shapes(&sequence).expect("bodies that the library admits");
            let mut flight = Flight {
                family: wanted[which],
                seed,
                index,
                sequence: &sequence,
                shapes: [&first, &second],
                tally: Tally { sequences: 1, ..Tally::default() },
                violations: Vec::new(),
            };
            run(&mut flight);
            let mut results = results.lock().expect("no panic");
            results.0[which] += &flight.tally;
            results.1.append(&mut flight.violations);
        }
    };
    std::thread::scope(|scope| {
        scope.spawn(work);
        work();
    });
    let (tallies, violations) = results.into_inner().expect("no panic");
    for Violation { what, place } in violations.iter().take(20) {
        println!("{test}: {place}: {what}\n");
    }
    assert!(violations.is_empty(), "{test}: {} violations", violations.len());
    wanted.iter().map(|family| family.name).zip(tallies).collect()
}

#[test]
fn answers_are_the_truth() {
    let tallies = over_all_families("answers are the truth", |flight| {
        let exact = ExactPair::of(flight.sequence);
        let mut complaints = Vec::new();
        let (sequence, shapes) = (flight.sequence, flight.shapes);
        let flown = fly(sequence, shapes, |number, poses, answer, _| {
            let before = [flight.tally.wrong, flight.tally.missed, flight.tally.not_a_number, flight.tally.unnamed()];
            let truth = exact.truth(&sequence.poses[number]);
            let is_right = truth.intersecting() == (answer.outcome == Outcome::Intersecting);
            flight.tally.count(answer, shapes);
            flight.tally.wrong += usize::from(!is_right);
            flight.tally.missed += usize::from(!truth.lies_between(answer.lower, answer.upper));
            let after = [flight.tally.wrong, flight.tally.missed, flight.tally.not_a_number, flight.tally.unnamed()];
            if after != before {
                complaints.push((number, format!("{answer:?}, the truth is {truth:?}")));
            }
            if let Err(e) = verify([shapes[0].at(&poses[0]), shapes[1].at(&poses[1])], answer) {
                complaints.push((number, format!("{e}: {answer:?}")));
            }
            complaints.extend(excess_work_without_levels(shapes, answer).map(|what| (number, what)));
        });
        complaints.into_iter().for_each(|(number, what)| flight.violated(number, what));
        if let Err(e) = flown {
            flight.violated(flight.tally.poses, format!("refused: {e}"));
        }
    });
    println!("{}", Table(&tallies));
}

#[test]
fn answers_do_not_depend_on_history() {
    over_all_families("history", history::check);
}

#[test]
fn answers_do_not_depend_on_the_telling() {
    let shifted = AtomicUsize::new(0);
    let tallies = over_all_families("telling", |flight| {
        flight.tally.poses += flight.sequence.poses.len();
        shifted.fetch_add(retelling::check(flight), Ordering::Relaxed);
    });
    let poses: usize = tallies.iter().map(|(_, tally)| tally.poses).sum();
    println!("{} of {poses} poses moved without rounding", shifted.load(Ordering::Relaxed));
    assert!(shifted.into_inner() > poses / 10);
}

#[test]
fn levels_of_detail_change_no_verdict() {
    let from_levels = AtomicUsize::new(0);
    over_all_families("levels", |flight| {
        from_levels.fetch_add(levels::check(flight), Ordering::Relaxed);
    });
    println!("{} answers from levels", from_levels.load(Ordering::Relaxed));
    assert!(from_levels.into_inner() > 0);
}

/// Everything that the million queries of `tests/million` are held against: tight intervals, witness points, normals, features.
#[test]
fn answers_keep_every_promise() {
    over_all_families("promises", |flight| {
        let bodies = flight.sequence.bodies.each_ref().map(|body| Body::from_points(body.vertices.clone()));
        let mut session = Session::new(flight.seed_of(0x7000));
        for (number, pair) in flight.sequence.poses.iter().enumerate() {
            session.check(&Placed { bodies: bodies.each_ref(), poses: poses(pair) });
            for violation in session.violations.drain(..) {
                let detail: String = violation.detail.chars().take(600).collect();
                flight.violated(number, format!("{}: {detail}", violation.property));
            }
        }
    });
}

/// The oracle for bodies of any size against the one that looks at all pairs of features.
#[test]
fn the_two_oracles_agree() {
    let mut compared = 0;
    for family in families() {
        for index in 0..4 {
            let sequence = family.sequence(77, index);
            if sequence.bodies.iter().any(|body| body.vertices.len() > 9) {
                continue;
            }
            let exact = ExactPair::of(&sequence);
            for pair in sequence.poses.iter().take(8) {
                let [points_a, points_b] = sequence.bodies.each_ref().map(|body| body.vertices.clone());
                let [pose_a, pose_b] = poses(pair);
                let truth = Case { points_a, pose_a, points_b, pose_b }.truth();
                assert_eq!(exact.truth(pair), truth, "{} sequence {index}", family.name);
                compared += 1;
            }
        }
    }
    println!("{compared} pairs compared");
    assert!(compared > 100);
}

#[test]
fn the_catalogue_is_in_order() {
    let names: BTreeSet<&str> = families().map(|family| family.name).collect();
    assert_eq!(names.len(), families().count(), "two families of one name");
    for family in families() {
        let is_word = |text: &str| text.chars().all(|c| c.is_ascii_alphanumeric() || "_.-".contains(c));
        assert!(
            is_word(family.name) && family.sweep > 0 && !family.why.is_empty() && !family.sources.is_empty(),
            "{}",
            family.name
        );
        let [one, again, other] = [(5, 1), (5, 1), (6, 1)].map(|(seed, index)| family.sequence(seed, index));
        assert!(is_word(&one.name), "{}: {}", family.name, one.name);
        assert_eq!((&one.poses, &one.bodies), (&again.poses, &again.bodies), "{} is not reproducible", family.name);
        assert_ne!(one.poses, other.poses, "{} does not depend on the seed", family.name);
        let is_in_range = |t: &[u32; 3], body: usize| t.iter().all(|&v| (v as usize) < one.bodies[body].vertices.len());
        assert!(
            (0..2).all(|body| triangles(&one.bodies[body]).iter().all(|t| is_in_range(t, body))),
            "{}",
            family.name
        );
    }
}

/// Two answers about one pair: the same verdict, intervals with a common point. If not, what is said about it.
fn contradiction(one: &PairAnswer, other: &PairAnswer) -> Option<String> {
    let [meets1, meets2] = [one, other].map(|answer| answer.outcome == Outcome::Intersecting);
    let agree = meets1 == meets2 && one.lower <= other.upper && other.lower <= one.upper;
    (!agree).then(|| format!("{one:?}\nbut {other:?}"))
}

/// The answer to `distance` from a cache.
fn ask(shapes: [&Shape; 2], poses: [&swiftprox::math::Pose; 2], cache: &mut PairCache) -> PairAnswer {
    let mut answer = PairAnswer::default();
    let config = swiftprox::pair::PairConfig::default();
    swiftprox::pair::distance([shapes[0].at(poses[0]), shapes[1].at(poses[1])], cache, &config, &mut answer)
        .expect("accepted poses");
    answer
}
