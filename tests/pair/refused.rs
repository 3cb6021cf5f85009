//! A pair query that is refused changes nothing: answer and cache are as they were, wherever marching was to start, whatever the
//! cache remembered.

use swiftprox::error::{Error, Result};
use swiftprox::hierarchy::{HierarchyKind, HierarchyOptions};
use swiftprox::math::{Matrix, Pose, Vector};
use swiftprox::pair::{self, DecidedBy, Levels, PairAnswer, PairCache, PairConfig, Placed, Start};
use swiftprox::shape::{Shape, ShapeOptions};
use testkit::models::ellipsoid;
use testkit::shapes::at;

type Query = fn([Placed; 2], &mut PairCache, &PairConfig, &mut PairAnswer) -> Result<()>;

const QUERIES: [Query; 4] = [pair::distance, pair::intersection, pair::contact, pair::approximate];
const STARTS: [Start; 4] = [Start::Automatic, Start::Cache, Start::Table, Start::Cold];

/// A body with levels, on which the caches of all queries are of the kinds that there are.
fn body() -> Shape {
    let hierarchy = HierarchyOptions { kind: HierarchyKind::Quadric, ..HierarchyOptions::default() };
    let options = ShapeOptions { hierarchy, ..ShapeOptions::default() };
    Shape::from_mesh(&ellipsoid([1.0, 0.7, 0.4], 400).unwrap(), &options).unwrap()
}

/// Every query with every start, through levels or not, with and without a budget of steps.
fn configurations() -> Vec<(Query, PairConfig)> {
    let mut all = Vec::new();
    for query in QUERIES {
        for start in STARTS {
            for levels in [Levels::None, Levels::All] {
                for step_budget in [u32::MAX, 3] {
                    all.push((query, PairConfig { start, levels, step_budget, ..PairConfig::default() }));
                }
            }
        }
    }
    all
}

#[test]
fn a_refused_query_leaves_cache_and_answer_alone() {
    let body = body();
    let mut coherent = 0;
    for (query, config) in configurations() {
        for x in [0.1, 5.0] {
            let (mut cache, mut answer) = (PairCache::default(), PairAnswer::default());
            for _ in 0..2 {
                query([body.at(&at(0.0, 0.0, 0.0)), body.at(&at(x, 0.0, 0.0))], &mut cache, &config, &mut answer)
                    .unwrap();
            }
            coherent += usize::from(answer.decided_by == DecidedBy::Coherence);
            let (cache_before, answer_before) = (cache, answer);
            let mirrored = Pose::new(&Matrix::from_diagonal(&Vector::new(1.0, 1.0, -1.0)), &Vector::zeros());
            for pose in [at(f64::NAN, 0.0, 0.0), at(f64::INFINITY, 0.0, 0.0), mirrored] {
                let result = query([body.at(&pose), body.at(&at(x, 0.0, 0.0))], &mut cache, &config, &mut answer);
                assert!(matches!(result, Err(Error::Pose(_))), "{result:?} of {config:?} at {pose:?}");
            }
            for refused in
                [PairConfig { max_distance: f64::NAN, ..config }, PairConfig { max_distance: -1.0, ..config }]
            {
                let result =
                    query([body.at(&at(0.0, 0.0, 0.0)), body.at(&at(x, 0.0, 0.0))], &mut cache, &refused, &mut answer);
                assert!(matches!(result, Err(Error::Argument(_))), "{result:?} of {refused:?}");
            }
            assert_eq!(cache, cache_before, "{config:?} at {x}");
            assert_eq!(format!("{answer:?}"), format!("{answer_before:?}"), "{config:?} at {x}");
        }
    }
    assert!(coherent > 0, "no cache held a proof of intersection");
}

/// What is for approximate queries alone changes nothing for the others, whatever it holds.
#[test]
fn exact_queries_do_not_look_at_what_is_for_approximate_ones() {
    let body = body();
    for query in [pair::distance as Query, pair::intersection, pair::contact] {
        for levels in [Levels::None, Levels::All] {
            for x in [0.1, 1.5, 5.0] {
                let ask = |config: PairConfig| {
                    let (mut cache, mut answer) = (PairCache::default(), PairAnswer::default());
                    let poses = [at(0.0, 0.0, 0.0), at(x, 0.0, 0.0)];
                    query([body.at(&poses[0]), body.at(&poses[1])], &mut cache, &config, &mut answer).unwrap();
                    format!("{answer:?} {cache:?}")
                };
                let config = PairConfig { levels, ..PairConfig::default() };
                let expected = ask(config);
                assert_eq!(ask(PairConfig { absolute_error: -1.0, ..config }), expected);
                assert_eq!(ask(PairConfig { relative_error: f64::NAN, ..config }), expected);
                assert_eq!(ask(PairConfig { step_budget: 0, ..config }), expected);
            }
        }
    }
}
