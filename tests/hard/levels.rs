//! Levels of detail of hard bodies, and queries that go through them with any error asked for, any step budget, from any cache: the
//! verdict is that of the exact query, the interval has a number in common with its interval and is as narrow as asked.

use swiftprox::hierarchy::{HierarchyKind, HierarchyOptions};
use swiftprox::math::Pose;
use swiftprox::pair::contact;
use swiftprox::pair::{
    DecidedBy, Levels, Outcome, PairAnswer, PairCache, PairConfig, Refinement, Start, approximate, distance,
    intersection,
};
use swiftprox::shape::{InputPolicy, Shape, ShapeOptions};
use swiftprox::verify::verify;

use crate::history::{Query, words_of_a_cache};
use crate::{Flight, ask, contradiction};
use testkit::caches::cache_of_words;
use testkit::cases::Random;
use testkit::hard::flight::poses;
use testkit::retold::extent;

const KINDS: [HierarchyKind; 3] = [HierarchyKind::Quadric, HierarchyKind::DobkinKirkpatrick, HierarchyKind::OuterCuts];

const REFINEMENTS: [Refinement; 4] =
    [Refinement::Adaptive, Refinement::Single, Refinement::SingleSingle, Refinement::DoubleDouble];

const STARTS: [Start; 5] = [Start::Automatic, Start::Automatic, Start::Cache, Start::Table, Start::Cold];

const QUERIES: [(&str, Query); 6] = [
    ("approximate distance", approximate),
    ("approximate distance", approximate),
    ("approximate distance", approximate),
    ("distance", distance),
    ("contact", contact),
    ("intersection", intersection),
];

/// Asks every pose of a flight through levels. How many answers came from another level than the bodies themselves.
pub fn check(flight: &mut Flight) -> usize {
    let mut random = flight.random(0xa000);
    let bodies = &flight.sequence.bodies;
    let [first, second] = bodies.each_ref().map(|body| {
        let hierarchy = HierarchyOptions {
            kind: KINDS[random.below(3)],
            decimation: [0.25, 0.5, 0.7][random.below(3)],
            minimum_triangles: [4, 12, 50][random.below(3)],
            ..HierarchyOptions::default()
        };
        let options = ShapeOptions { input: InputPolicy::Hull, hierarchy, ..ShapeOptions::default() };
        Shape::from_mesh(body, &options).expect("bodies that the library admits")
    });
    let mut warm = PairCache::default();
    let mut from_levels = 0;
    for (number, pair) in flight.sequence.poses.iter().enumerate() {
        let placed = &poses(pair);
        let exact = ask(flight.shapes, placed.each_ref(), &mut PairCache::default());
        let points = [bodies[0].vertices.as_slice(), bodies[1].vertices.as_slice()];
        let (size, reach) = extent(points, placed.each_ref());
        for _ in 0..4 {
            let (name, query) = QUERIES[random.below(6)];
            let config = any_config(&mut random, size);
            let mut cache = if random.below(6) == 0 { random_places(&mut random, flight.shapes) } else { warm };
            let before = cache;
            let mut answer = PairAnswer::default();
            query([first.at(&placed[0]), second.at(&placed[1])], &mut cache, &config, &mut answer)
                .expect("accepted poses");
            warm = cache;
            from_levels += usize::from(answer.statistics.levels != [0, 0]);
            // As narrow as answers to hard pairs are, or as asked.
            let widest = 1e-13 * (size.max(answer.upper) + 2e-3 * reach);
            let asked = match name {
                "approximate distance" => config.absolute_error.max(config.relative_error * answer.lower).max(widest),
                "intersection" => f64::INFINITY,
                _ => widest,
            };
            let complaint =
                judge(&exact, &answer, &config, asked).or_else(|| not_verified([&first, &second], placed, &answer));
            let complaint = complaint.or_else(|| excess_steps_through_levels([&first, &second], &answer));
            if let Some(what) = complaint {
                flight
                    .violated(number, format!("{name}: {what}: {answer:?}\nexactly {exact:?}\n{config:?} {before:?}"));
            }
        }
    }
    from_levels
}

fn any_config(random: &mut Random, size: f64) -> PairConfig {
    let mut error = || [0.0, 0.0, 1e-15, 1e-9, 1e-3, 0.1, 1.0][random.below(7)];
    let (absolute_error, relative_error, tolerance) = (size * error(), error(), size * error());
    PairConfig {
        absolute_error,
        relative_error,
        max_distance: if random.below(4) == 0 { tolerance } else { f64::INFINITY },
        step_budget: if random.below(6) == 0 { 1 + random.below(12) as u32 } else { u32::MAX },
        levels: [Levels::Automatic, Levels::None, Levels::All, Levels::All][random.below(4)],
        refinement: REFINEMENTS[random.below(4)],
        start: STARTS[random.below(5)],
    }
}

/// Features of levels, of which few exist.
fn random_places(random: &mut Random, shapes: [&Shape; 2]) -> PairCache {
    let most = shapes.map(|shape| shape.polyhedron().edges.len().max(1));
    let mut words = words_of_a_cache(random);
    words[0] = random.below(26) as u32;
    words[1] = random.below(most[0]) as u32;
    words[2] = random.below(most[1]) as u32;
    words[3..5].iter_mut().for_each(|level| *level = random.below(6) as u32);
    cache_of_words(words)
}

fn judge(exact: &PairAnswer, answer: &PairAnswer, config: &PairConfig, asked: f64) -> Option<String> {
    let is_spent = answer.decided_by == DecidedBy::Budget;
    match answer.outcome {
        Outcome::Undecided if is_spent && answer.lower == 0.0 => {
            return (answer.upper < exact.lower).then(|| "an interval that misses".to_string());
        }
        Outcome::Intersecting => {}
        Outcome::Separated if answer.upper <= config.max_distance || is_spent => {}
        Outcome::Beyond if answer.lower >= config.max_distance => {}
        _ => return Some("an unknown outcome".to_string()),
    }
    let is_wide = answer.outcome == Outcome::Separated && !is_spent && !(answer.upper - answer.lower <= asked);
    contradiction(exact, answer).or_else(|| is_wide.then(|| format!("wider than {asked:e}")))
}

/// At every pair of levels 64 steps and one for each vertex of the larger one, there are at most as many pairs as levels of
/// both, and at the bodies themselves what every query may take (`properties::excess_work_without_levels`).
fn excess_steps_through_levels(shapes: [&Shape; 2], answer: &PairAnswer) -> Option<String> {
    let larger = |vertices: [usize; 2]| vertices[0].max(vertices[1]) as u32;
    let finest =
        shapes.map(|shape| shape.hierarchy().levels.first().map_or(0, |level| level.polyhedron.vertices.len()));
    let pairs: usize = shapes.iter().map(|shape| shape.hierarchy().levels.len()).sum();
    let body = larger(shapes.map(|shape| shape.polyhedron().vertices.len()));
    let most = 81 + body + pairs as u32 * (64 + larger(finest).max(body));
    let steps = answer.statistics.marching_steps;
    (steps > most).then(|| format!("{steps} steps, at most {most} were to be made"))
}

fn not_verified(shapes: [&Shape; 2], poses: &[Pose; 2], answer: &PairAnswer) -> Option<String> {
    if answer.outcome == Outcome::Undecided {
        return None;
    }
    verify([shapes[0].at(&poses[0]), shapes[1].at(&poses[1])], answer).err().map(|e| e.to_string())
}
