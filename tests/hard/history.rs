//! Any answer from any warm start is the cold one: the right start, the last one, one of another pose, one of another pair, random
//! bytes, and such as are made to mislead; with any look-up table, and wherever a query is told to start.

use std::cell::OnceCell;

use swiftprox::body::tables::{LookupKind, LookupOptions};
use swiftprox::math::{Pose, Vector};
use swiftprox::pair::contact;
use swiftprox::pair::{DecidedBy, Outcome, PairAnswer, PairCache, PairConfig, Placed, Start, distance, intersection};
use swiftprox::shape::{InputPolicy, Shape, ShapeOptions};
use swiftprox::verify::verify;

use crate::truth::ExactPair;
use crate::{Flight, ask, contradiction};
use testkit::caches::{WORDS, cache_of_words};
use testkit::cases::Random;
use testkit::hard::flight::{fly, poses};
use testkit::properties::excess_work_without_levels;

/// The kinds of caches with something in them: 1 to 6 are pairs of features, 9 to 12 one to four vertex pairs.
const KINDS: [u32; 10] = [1, 2, 3, 4, 5, 6, 9, 10, 11, 12];

pub type Query = fn([Placed; 2], &mut PairCache, &PairConfig, &mut PairAnswer) -> swiftprox::error::Result<()>;

/// Every query there is.
const QUERIES: [(&str, Query); 3] = [("distance", distance), ("contact", contact), ("intersection", intersection)];

/// Every table that a shape may have.
const TABLES: [LookupKind; 3] = [LookupKind::None, LookupKind::Shells, LookupKind::Spherical];

const STARTS: [Start; 5] = [Start::Automatic, Start::Automatic, Start::Cache, Start::Table, Start::Cold];

/// Asks every pose of a flight from caches of every kind.
pub fn check(flight: &mut Flight) {
    let shapes = flight.shapes;
    let mut random = flight.random(0x8000);
    let mut flown = Vec::new();
    let mut flown_answers = Vec::new();
    fly(flight.sequence, shapes, |_, _, answer, cache| {
        flown.push(*cache);
        flown_answers.push(*answer);
    })
    .expect("accepted poses");
    let foreign = foreign_caches(flight);
    let [other1, other2] = flight.sequence.bodies.each_ref().map(|body| {
        let lookup = LookupOptions { kind: TABLES[random.below(3)], ..LookupOptions::default() };
        let options = ShapeOptions { input: InputPolicy::Hull, lookup, ..ShapeOptions::default() };
        Shape::from_mesh(body, &options).expect("bodies that the library admits")
    });
    let exact = ExactPair::of(flight.sequence);
    for (number, pair) in flight.sequence.poses.iter().enumerate() {
        let placed = &poses(pair);
        let truth = OnceCell::new();
        let is_within = |limit| truth.get_or_init(|| exact.truth(pair)).lies_between(0.0, limit);
        let cold = ask(shapes, placed.each_ref(), &mut PairCache::default());
        if let Some(what) = contradiction(&cold, &flown_answers[number]) {
            flight.violated(number, format!("the cache carried on: {what}"));
        }
        let any = |random: &mut Random, caches: &[PairCache]| caches[random.below(caches.len())];
        let starts = [
            ("right", flown[number]),
            ("of another pose", any(&mut random, &flown)),
            ("of another pair", any(&mut random, &foreign)),
            ("of random bytes", cache_of_words(words_of_a_cache(&mut random))),
            ("of random features", random_features(&mut random, shapes)),
            ("of the farthest vertices", farthest(shapes, placed, &mut random)),
            ("of an axis", random_axis(&mut random, shapes, placed, &cold)),
        ];
        for (start, cache) in starts {
            // Axes are for the verdict alone.
            let asked = if start == "of an axis" { 2 } else { random.below(3) };
            let (name, query) = QUERIES[asked];
            // Without a limit to the distance, or with one that is as near to it as can be.
            let limits = [f64::INFINITY, 0.0, cold.lower, cold.upper, cold.distance.next_up(), 0.5 * cold.distance];
            let max_distance = limits[random.below(12).saturating_sub(6)];
            let start_at = STARTS[random.below(5)];
            let config = PairConfig { max_distance, start: start_at, ..PairConfig::default() };
            let shapes = if random.below(2) == 0 { shapes } else { [&other1, &other2] };
            let (mut used, mut answer) = (cache, PairAnswer::default());
            query([shapes[0].at(&placed[0]), shapes[1].at(&placed[1])], &mut used, &config, &mut answer)
                .expect("accepted poses");
            let checked =
                verify([shapes[0].at(&placed[0]), shapes[1].at(&placed[1])], &answer).err().map(|e| e.to_string());
            let is_beyond = max_distance < f64::INFINITY && !is_within(max_distance);
            let complaints = [
                contradiction(&cold, &answer),
                checked,
                not_as_asked(name, &answer),
                (is_beyond != (answer.outcome == Outcome::Beyond)).then(|| "the limit is decided wrongly".to_string()),
                excess_work_without_levels(shapes, &answer),
            ];
            for what in complaints.into_iter().flatten() {
                flight.violated(number, format!("{name} {config:?}, a start {start}, {cache:?}: {what}\n{answer:?}"));
            }
            // What it leaves behind is as good a start as any.
            if let Some(what) = contradiction(&cold, &ask(shapes, placed.each_ref(), &mut used)) {
                flight.violated(number, format!("after {name}, a start {start}, {cache:?}: {what}"));
            }
        }
    }
}

/// What an answer does not say though it was asked.
fn not_as_asked(name: &str, answer: &PairAnswer) -> Option<String> {
    let PairAnswer { local1, local2, world1, world2, normal, distance, lower, upper, .. } = answer;
    let is_said = |points: &[&[f64; 3]]| points.iter().all(|point| point.iter().all(|x| x.is_finite()));
    let points_due = match answer.outcome {
        Outcome::Separated => name != "intersection",
        Outcome::Intersecting => name == "contact",
        Outcome::Beyond | Outcome::Undecided | Outcome::None => false,
    };
    if points_due && !is_said(&[local1, local2, world1, world2, normal]) {
        Some("points or the normal are not said".to_string())
    } else if answer.outcome != Outcome::Intersecting && !is_said(&[normal]) {
        Some("the normal is missing".to_string())
    } else if answer.decided_by == DecidedBy::None
        || answer.outcome == Outcome::None
        || [distance, lower, upper].iter().any(|x| x.is_nan())
    {
        Some("nothing is said".to_string())
    } else {
        None
    }
}

/// Caches of another sequence of the same family: other bodies.
fn foreign_caches(flight: &Flight) -> Vec<PairCache> {
    let other = flight.family.sequence(flight.seed ^ 0xf0, flight.index + 1);
    let [first, second] = testkit::hard::flight::shapes(&other).expect("bodies that the library admits");
    let mut caches = Vec::new();
    fly(&other, [&first, &second], |_, _, _, cache| caches.push(*cache)).expect("accepted poses");
    caches
}

/// Features that exist, in every combination of kinds, with directions that need not be numbers.
fn random_features(random: &mut Random, shapes: [&Shape; 2]) -> PairCache {
    let mut words = [0; WORDS];
    words[0] = KINDS[random.below(KINDS.len())];
    let counts = shapes.map(|shape| {
        let hull = shape.polyhedron();
        [hull.vertices.len(), hull.edges.len(), hull.faces.len()][random.below(3)].max(1)
    });
    for (k, word) in words[1..11].iter_mut().enumerate() {
        *word = random.below(counts[k % 2]) as u32;
    }
    for word in &mut words[11..] {
        *word = [f32::NAN, f32::INFINITY, 0.0, -1e30, random.signed() as f32][random.below(5)].to_bits();
    }
    cache_of_words(words)
}

/// Features that exist and beside them a separating axis: the one that the cold answer knows, tilted or not, or any.
fn random_axis(random: &mut Random, shapes: [&Shape; 2], placed: &[Pose; 2], cold: &PairAnswer) -> PairCache {
    let mut words = [0; WORDS];
    words[0] = KINDS[random.below(6)];
    for (k, word) in words[1..5].iter_mut().enumerate() {
        *word = random.below(shapes[k % 2].polyhedron().vertices.len()) as u32;
    }
    let tilt = [0.0, 1e-12, 1e-7, 1e-3, 0.3][random.below(5)];
    let tilted = Vector::from(cold.normal) + Vector::new(random.signed(), random.signed(), random.signed()) * tilt;
    let local = placed[0].rotate_back(&tilted);
    let any = [f32::NAN, f32::INFINITY, 0.0, -1e30, 1e-30, random.signed() as f32];
    let is_known = cold.outcome == Outcome::Separated && random.below(4) > 0;
    for k in 0..3 {
        let component = if is_known { local[k] as f32 } else { any[random.below(6)] };
        words[5 + k] = component.to_bits();
    }
    words[8] = u32::from_ne_bytes(*b"axis");
    cache_of_words(words)
}

/// The vertices that are farthest from each other as a pair of features, or as the pairs of an enclosing tetrahedron.
fn farthest(shapes: [&Shape; 2], poses: &[Pose; 2], random: &mut Random) -> PairCache {
    let hulls = shapes.map(Shape::polyhedron);
    let centre = |i: usize| poses[i].transform(&hulls[i].centre);
    let away = centre(0) - centre(1);
    let away = if away.norm() > 0.0 { away } else { Vector::x() };
    let support = |i: usize, direction: &Vector| {
        let local = poses[i].rotate_back(direction);
        let heights = hulls[i].vertices.iter().map(|v| local.dot(&v.position));
        heights.enumerate().max_by(|(_, one), (_, other)| one.total_cmp(other)).map_or(0, |(v, _)| v as u32)
    };
    let mut words = [0; WORDS];
    words[0] = KINDS[[0, 6, 9][random.below(3)]];
    words[1..11].chunks_mut(2).for_each(|pair| pair.copy_from_slice(&[support(0, &away), support(1, &-away)]));
    cache_of_words(words)
}

/// Random bits, as many as a cache has.
pub fn words_of_a_cache(random: &mut Random) -> [u32; WORDS] {
    [(); WORDS].map(|()| random.next_u64() as u32)
}
