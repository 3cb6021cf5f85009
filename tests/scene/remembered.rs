//! What scenes remember and spend: answers do not hang on it.

use std::sync::Arc;

use super::scenes::{cubes, distances, scene, up_to};
use swiftprox::error::Error;
use swiftprox::hierarchy::{HierarchyKind, HierarchyOptions};
use swiftprox::math::{Matrix, Pose, Vector};
use swiftprox::object::{ObjectId, ObjectOptions};
use swiftprox::pair::{self, Levels, Outcome, PairAnswer, PairCache, PairConfig, Start};
use swiftprox::progress::Progress;
use swiftprox::scene::{PairResult, Scene, SceneQuery, SceneStatistics};
use swiftprox::shape::Shape;
use swiftprox::verify::verify;
use testkit::random_scene::{Random, cuboid, ellipsoid, random_pose};
use testkit::shapes::at;

#[test]
fn statistics_add_up() {
    let mut scene = scene();
    cubes(&mut scene, &[0.0, 0.5, 3.0]);
    scene.query_contact(&SceneQuery::default()).unwrap();
    scene.query_contact(&SceneQuery::default()).unwrap();
    let statistics = *scene.statistics();
    assert_eq!((statistics.queries, statistics.pairs), (2, 6));
    let SceneStatistics { marched, coherent, fallback, exact, bounding_spheres, unmoved, .. } = statistics;
    assert_eq!((marched + coherent + fallback + exact + bounding_spheres, unmoved), (3, 3));
    // Another query is asked anew.
    scene.query_distance(&SceneQuery::default()).unwrap();
    assert_eq!((scene.statistics().pairs, scene.statistics().unmoved), (9, 3));
    assert!(statistics.marching_steps + statistics.fallback_iterations + statistics.exact_iterations > 0);
    scene.reset_statistics();
    assert_eq!(scene.statistics(), &SceneStatistics::default());
}

/// Verdicts spend nothing, however wide their intervals are; of distances all that is left open counts, and what a budget of steps
/// leaves undecided most of all.
#[test]
fn error_spent_is_what_distances_leave_open() {
    let mut random = Random::new(0xe4405);
    let mut scene = scene();
    let shape = ellipsoid(&mut random, 300, [0.6, 0.5, 0.2], Vector::zeros());
    for _ in 0..12 {
        let options = ObjectOptions { pose: random_pose(&mut random, 1.5), ..Default::default() };
        scene.add_object(vec![shape.clone()], &options).unwrap();
    }
    scene.query_intersection(&SceneQuery::default()).unwrap();
    scene.query_intersection(&SceneQuery::default()).unwrap();
    assert!(scene.statistics().pairs > 0 && scene.statistics().error_spent == 0.0, "{:?}", scene.statistics());

    let near = SceneQuery { max_distance: 0.5, absolute_error: 0.1, ..Default::default() };
    let hurried = SceneQuery { step_budget: 1, start: Start::Cold, ..near };
    let mut undecided = 0;
    for ask in [Scene::query_distance, Scene::query_contact, Scene::query_approximate] {
        for query in [near, hurried] {
            scene.reset_statistics();
            let pairs = ask(&mut scene, &query).unwrap().pairs;
            let left_open: f64 = pairs.iter().map(|pair| pair.answer.upper - pair.answer.lower).sum();
            undecided += pairs.iter().filter(|pair| pair.answer.outcome == Outcome::Undecided).count();
            assert!(left_open > 0.0);
            assert_eq!(scene.statistics().error_spent, left_open);
        }
    }
    assert!(undecided > 0);
}

/// The steps of the first pair of a scene's list, which is asked anew: no answer with an old number is given again.
fn steps(scene: &mut Scene) -> u32 {
    let first = scene.objects().next().unwrap().id();
    scene.set_user_data(first, 0).unwrap();
    scene.query_intersection(&SceneQuery::default()).unwrap();
    let answer = scene.query_distance(&SceneQuery::default()).unwrap();
    answer.pairs[0].answer.statistics.marching_steps
}

#[test]
fn a_pair_that_stays_remembers_and_a_deactivated_one_too() {
    let mut random = Random::new(4);
    let shape = ellipsoid(&mut random, 500, [1.0, 0.8, 0.6], Vector::zeros());
    let mut scene = scene();
    let add = |pose: Pose| {
        let options = ObjectOptions { pose, ..Default::default() };
        scene.add_object(vec![shape.clone()], &options).unwrap()
    };
    let ids = [at(0.0, 0.0, 0.0), at(1.0, 2.0, 1.5), at(9.0, 0.0, 0.0)].map(add);
    let cold = steps(&mut scene);
    let warm = steps(&mut scene);
    assert!(warm < cold, "{warm} steps warm, {cold} cold");

    scene.copy_object(ids[0]).unwrap();
    scene.remove_object(ids[2]).unwrap();
    assert_eq!(steps(&mut scene), warm);
    scene.copy_object(ids[0]).unwrap();
    assert_eq!(steps(&mut scene), warm);

    scene.set_object_active(ids[0], false).unwrap();
    scene.query_intersection(&SceneQuery::default()).unwrap();
    scene.set_object_active(ids[0], true).unwrap();
    assert_eq!(steps(&mut scene), warm);
    scene.set_all_active(false);
    scene.set_all_active(true);
    assert_eq!(steps(&mut scene), warm);
}

/// What a query must list, by the pair layer with cold caches over all pairs of pieces.
fn expected(scene: &Scene) -> Vec<PairResult> {
    let objects: Vec<_> = scene.objects().collect();
    let mut results = Vec::new();
    for (k, object1) in objects.iter().enumerate() {
        for object2 in &objects[k + 1..] {
            if !scene.is_pair_active(object1.id(), object2.id()).unwrap() {
                continue;
            }
            for (piece1, shape1) in object1.pieces().iter().enumerate() {
                for (piece2, shape2) in object2.pieces().iter().enumerate() {
                    results.push(PairResult {
                        object1: object1.id(),
                        object2: object2.id(),
                        user_data1: object1.user_data(),
                        user_data2: object2.user_data(),
                        piece1: piece1 as u32,
                        piece2: piece2 as u32,
                        answer: cold(shape1, object1.pose(), shape2, object2.pose()),
                    });
                }
            }
        }
    }
    results
}

fn cold(shape1: &Shape, pose1: &Pose, shape2: &Shape, pose2: &Pose) -> PairAnswer {
    let mut answer = PairAnswer::default();
    let (mut cache, config) = (PairCache::default(), PairConfig::default());
    pair::distance([shape1.at(pose1), shape2.at(pose2)], &mut cache, &config, &mut answer).unwrap();
    answer
}

/// The same pairs in the same order with the same verdicts, and intervals that share a point.
fn agree(actual: &[PairResult], expected: &[PairResult]) {
    assert_eq!(actual.len(), expected.len());
    for (a, e) in actual.iter().zip(expected) {
        let key = |r: &PairResult| (r.object1, r.object2, r.user_data1, r.user_data2, r.piece1, r.piece2);
        assert_eq!(key(a), key(e));
        assert_eq!(a.answer.outcome, e.answer.outcome);
        assert!(a.answer.lower <= e.answer.upper && e.answer.lower <= a.answer.upper, "{a:?} {e:?}");
    }
}

/// Every answer, checked without trust in the solver.
fn verified(scene: &Scene, pairs: &[PairResult]) {
    for pair in pairs {
        let [object1, object2] = [pair.object1, pair.object2].map(|id| scene.object(id).unwrap());
        let (shape1, shape2) = (&object1.pieces()[pair.piece1 as usize], &object2.pieces()[pair.piece2 as usize]);
        let checked = verify([shape1.at(object1.pose()), shape2.at(object2.pose())], &pair.answer);
        checked.unwrap_or_else(|e| panic!("{e}: {pair:?}"));
    }
}

/// A scene with a past (objects moved, added, removed, copied, activated and not, queries of every kind in between) answers
/// as the pair layer does without one.
#[test]
fn answers_do_not_depend_on_the_past() {
    let mut random = Random::new(3);
    let mut shapes = vec![cuboid([0.5, 0.3, 0.2]), cuboid([0.1, 0.1, 0.8])];
    shapes.push(ellipsoid(&mut random, 40, [0.6, 0.4, 0.2], Vector::zeros()));
    shapes.push(ellipsoid(&mut random, 12, [0.3, 0.3, 0.3], Vector::new(0.4, 0.0, 0.0)));
    let mut scene = scene();
    let mut ids = Vec::new();
    let mut seen = [0; 2];
    for step in 0..400_u64 {
        match random.below(10) {
            0..3 if ids.len() < 9 => {
                let pieces = (0..1 + random.below(3)).map(|_| shapes[random.below(4)].clone()).collect();
                let options = ObjectOptions {
                    pose: random_pose(&mut random, 1.5),
                    fixed: random.below(3) == 0,
                    user_data: step,
                    ..Default::default()
                };
                ids.push(scene.add_object(pieces, &options).unwrap());
            }
            3 if ids.len() > 4 => scene.remove_object(ids.swap_remove(random.below(ids.len()))).unwrap(),
            4 if ids.len() > 1 => {
                let active = random.below(2) == 1;
                let (id1, id2) = (ids[0], ids[1 + random.below(ids.len() - 1)]);
                scene.set_pair_active(id1, id2, active).unwrap();
            }
            5 if step % 3 == 0 => scene.set_all_active(random.below(4) > 0),
            5 if !ids.is_empty() => scene.set_object_active(ids[random.below(ids.len())], true).unwrap(),
            6 if !ids.is_empty() => {
                scene.set_pose(ids[random.below(ids.len())], &random_pose(&mut random, 1.5)).unwrap()
            }
            _ => {
                // A small step for everything that moves: here the caches are of use.
                let drift = random.vector() * 0.02;
                let moving = scene.objects().filter(|object| !object.fixed());
                let step = |pose: &Pose| Pose::new(&pose.rotation(), &(pose.translation() + drift));
                let poses: Vec<Pose> = moving.map(|object| step(object.pose())).collect();
                scene.set_all_poses(&poses).unwrap();
            }
        }
        let expected = expected(&scene);
        let intersects = |r: &&PairResult| r.answer.outcome == Outcome::Intersecting;
        let intersecting: Vec<PairResult> = expected.iter().filter(intersects).copied().collect();
        seen[0] += intersecting.len();
        seen[1] += expected.len();

        let answer = scene.query_distance(&SceneQuery::default()).unwrap();
        assert_eq!(answer.intersecting, !intersecting.is_empty());
        agree(answer.pairs, &expected);
        let mut answers = answer.pairs.to_vec();
        let answer = scene.query_intersection(&SceneQuery::default()).unwrap();
        assert_eq!(answer.intersecting, !intersecting.is_empty());
        agree(answer.pairs, &intersecting);
        answers.extend(answer.pairs);
        let answer = scene.query_contact(&SceneQuery::default()).unwrap();
        agree(answer.pairs, &expected);
        answers.extend(answer.pairs);
        verified(&scene, &answers);

        let tolerance = 0.3;
        let near: Vec<PairResult> = expected.into_iter().filter(|r| r.answer.lower <= tolerance).collect();
        agree(scene.query_distance(&up_to(tolerance)).unwrap().pairs, &near);
        let early = SceneQuery { early_exit: true, ..up_to(tolerance) };
        let answer = scene.query_contact(&early).unwrap();
        assert_eq!(answer.intersecting, !intersecting.is_empty());
        agree(answer.pairs, if intersecting.is_empty() { &near } else { &[] });
        agree(answer.found.map_or(&[], std::slice::from_ref), &intersecting[..intersecting.len().min(1)]);
    }
    // The test saw what it is about.
    assert!(seen[0] > 1_000 && seen[1] - seen[0] > 1_000, "{seen:?}");
}

/// Each pair within its error, all pairs within the budget, and what levels answered in the statistics.
#[test]
fn approximate_distances_and_a_budget_for_all() {
    let mut random = Random::new(77);
    let mut scene = Scene::new();
    let options = HierarchyOptions { kind: HierarchyKind::OuterCuts, ..HierarchyOptions::default() };
    let plain = ellipsoid(&mut random, 500, [0.6, 0.6, 0.1], Vector::zeros());
    let shape = Arc::new((*plain).clone().with_levels(&options, &mut Progress::new(&mut |_| true)).unwrap());
    for _ in 0..12 {
        let options = ObjectOptions { pose: random_pose(&mut random, 3.0), ..Default::default() };
        scene.add_object(vec![shape.clone()], &options).unwrap();
    }
    let exact: Vec<PairResult> = scene.query_distance(&SceneQuery::default()).unwrap().pairs.to_vec();
    let all = SceneQuery { levels: Levels::All, ..SceneQuery::default() };
    let wide = SceneQuery { absolute_error: 0.2, ..all };
    let budget = SceneQuery { error_budget: 6.6, ..all };
    let tight = SceneQuery { error_budget: 1e-6, ..all };
    for (query, error, total) in [(wide, 0.2, f64::INFINITY), (budget, 6.6, 6.6), (tight, 1e-6, 1e-6)] {
        for _ in 0..2 {
            scene.reset_statistics();
            let answer = scene.query_approximate(&query).unwrap();
            assert_eq!(answer.pairs.len(), 66);
            for (pair, exact) in answer.pairs.iter().zip(&exact) {
                let (answer, exact) = (&pair.answer, &exact.answer);
                assert_eq!(answer.outcome, exact.outcome);
                assert!(answer.lower <= exact.upper && exact.lower <= answer.upper);
                assert!(answer.upper - answer.lower <= error, "{answer:?}");
            }
            let statistics = scene.statistics();
            assert!(statistics.error_spent <= total && statistics.by_level.iter().sum::<u64>() == 66);
            assert_eq!(statistics.by_level[1..].iter().any(|&count| count > 0), error > 0.01, "{statistics:?}");
        }
    }
    for query in [
        SceneQuery { absolute_error: f64::NAN, ..Default::default() },
        SceneQuery { relative_error: -1.0, ..Default::default() },
        SceneQuery { error_budget: -1.0, ..Default::default() },
        SceneQuery { step_budget: 0, ..Default::default() },
        SceneQuery { max_distance: f64::NAN, ..Default::default() },
    ] {
        // By every query, whether it does without the member or not.
        assert!(matches!(scene.query_approximate(&query), Err(Error::Argument(_))));
        assert!(matches!(scene.query_intersection(&query), Err(Error::Argument(_))));
        assert!(matches!(scene.query_distance(&query), Err(Error::Argument(_))));
        assert!(matches!(scene.query_distance(&query), Err(Error::Argument(_))));
        assert!(matches!(scene.query_contact(&query), Err(Error::Argument(_))));
    }
}

/// Bodies without levels spend a budget, too, and an error: on maps of their support functions.
#[test]
fn maps_of_support_functions_spend_a_budget() {
    let mut random = Random::new(0x3a9);
    let shape = ellipsoid(&mut random, 600, [0.6, 0.6, 0.4], Vector::zeros());
    let mut scene = Scene::new();
    for _ in 0..8 {
        let options = ObjectOptions { pose: random_pose(&mut random, 3.0), ..Default::default() };
        scene.add_object(vec![shape.clone()], &options).unwrap();
    }
    let exact: Vec<PairResult> = scene.query_distance(&SceneQuery::default()).unwrap().pairs.to_vec();
    let budget = SceneQuery { error_budget: 1.0, ..SceneQuery::default() };
    let error = SceneQuery { absolute_error: 0.03, ..SceneQuery::default() };
    for (query, total) in [(budget, 1.0), (error, 28.0 * 0.03)] {
        scene.reset_statistics();
        let answer = scene.query_approximate(&query).unwrap();
        assert_eq!(answer.pairs.len(), 28);
        for (pair, exact) in answer.pairs.iter().zip(&exact) {
            let (answer, exact) = (&pair.answer, &exact.answer);
            assert_eq!(answer.outcome, exact.outcome);
            assert!(answer.lower <= exact.upper && exact.lower <= answer.upper, "{answer:?} {exact:?}");
        }
        let statistics = scene.statistics();
        assert!(statistics.error_spent <= total && statistics.error_spent > 1e-3, "{statistics:?}");
        assert!(statistics.within_tolerance > 14 && statistics.by_level[1..].iter().all(|&count| count == 0));
    }
}

/// A budget holds however objects move, few or all, and however little it is, and intersecting pairs take nothing of it. Answers
/// of pairs that rest are given again beside others: their shares count still.
#[test]
fn a_budget_holds_while_objects_move() {
    let mut random = Random::new(0xb4d);
    let options = HierarchyOptions { kind: HierarchyKind::Quadric, minimum_triangles: 12, ..Default::default() };
    let plain = ellipsoid(&mut random, 300, [0.6, 0.6, 0.4], Vector::zeros());
    let shape = Arc::new((*plain).clone().with_levels(&options, &mut Progress::new(&mut |_| true)).unwrap());
    let (mut scene, mut ids) = (Scene::new(), Vec::new());
    for _ in 0..12 {
        let options = ObjectOptions { pose: random_pose(&mut random, 2.0), ..Default::default() };
        ids.push(scene.add_object(vec![shape.clone()], &options).unwrap());
    }
    let (mut spent, mut again) = (0.0_f64, 0);
    for step in 0..120 {
        let moving = [1, 3, 12][step % 3];
        for id in ids.iter().cycle().skip(random.below(12)).take(moving) {
            scene.set_pose(*id, &random_pose(&mut random, 2.0)).unwrap();
        }
        let error_budget = [8.0, 1.0, 0.02][step / 3 % 3];
        let query = SceneQuery { error_budget, levels: Levels::All, max_distance: 1.5, ..SceneQuery::default() };
        for is_repeated in [false, true] {
            scene.reset_statistics();
            let answer = scene.query_approximate(&query).unwrap();
            let widths: f64 = answer.pairs.iter().map(|pair| pair.answer.upper - pair.answer.lower).sum();
            assert!(widths <= error_budget + 1e-11, "{widths} {error_budget} {step}");
            spent = spent.max(widths / error_budget);
            // At rest all answers of before stand.
            let statistics = scene.statistics();
            assert!(!is_repeated || statistics.unmoved == statistics.pairs, "{statistics:?}");
            again += statistics.unmoved;
        }
        let approximate: Vec<PairResult> = scene.query_approximate(&query).unwrap().pairs.to_vec();
        let exact = scene.query_distance(&query).unwrap().pairs;
        assert_eq!(approximate.len(), exact.len());
        for (approximate, exact) in approximate.iter().zip(exact) {
            let (approximate, exact) = (&approximate.answer, &exact.answer);
            assert_eq!(approximate.outcome, exact.outcome);
            assert!(approximate.lower <= exact.upper && exact.lower <= approximate.upper);
        }
    }
    assert!(spent > 0.1 && again > 0, "{spent} {again}");
}

/// Large bodies within a tolerance and beyond it: approximate answers take no more steps than exact ones, with an error or a
/// budget, and at rest none. With a finite tolerance the search used to begin at the coarsest levels each time, and a budget asked
/// two questions by turns, neither of which was answered again. (Cut-off: five to ten times the steps of exact answers at 0.1°.)
#[test]
fn approximate_distances_within_a_tolerance_cost_no_more_than_exact_ones() {
    let shape = ellipsoid(&mut Random::new(0xa99), 30_100, [1.0, 0.8, 0.6], Vector::zeros());
    let near = SceneQuery { max_distance: 0.6, ..SceneQuery::default() };
    let queries = [
        near,
        SceneQuery { absolute_error: 0.1, ..near },
        SceneQuery { absolute_error: 0.01, ..near },
        SceneQuery { error_budget: 1.0, ..near },
    ];
    let counts = queries.map(|query| {
        let is_exact = query == near;
        let (mut scene, mut ids) = (Scene::new(), Vec::new());
        for _ in 0..4 {
            ids.push(scene.add_object(vec![shape.clone()], &ObjectOptions::default()).unwrap());
        }
        let (mut rest, mut listed) = (0, 0);
        for step in 0..60 {
            for (k, id) in ids.iter().enumerate() {
                let (sin, cos) = (0.01 * f64::from(step) * (k + 1) as f64).sin_cos();
                let turn = Matrix::new(cos, -sin, 0.0, sin, cos, 0.0, 0.0, 0.0, 1.0);
                scene.set_pose(*id, &Pose::new(&turn, &(Vector::x() * (2.4 * k as f64)))).unwrap();
            }
            for is_at_rest in [false, true] {
                let before = scene.statistics().marching_steps;
                let answer = if is_exact { scene.query_distance(&query) } else { scene.query_approximate(&query) };
                listed += answer.unwrap().pairs.len();
                rest += if is_at_rest { scene.statistics().marching_steps - before } else { 0 };
            }
        }
        assert!(rest == 0 && listed > 100, "{rest} {listed} {query:?}");
        scene.statistics().marching_steps
    });
    for count in &counts[1..] {
        assert!(*count as f64 <= 1.1 * counts[0] as f64, "{counts:?}");
    }
}

/// All pairs of 200 objects, which are more than 16,384, remember their answers as far as the limit allows; what is listed is the
/// same.
#[test]
fn all_pairs_are_kept_up_to_a_limit() {
    let places: Vec<f64> = (0..200).map(|k| 1.5 * f64::from(k)).collect();
    let listed = [(None, 19_900), (Some(19_900), 19_900), (Some(19_899), 0), (Some(0), 0)].map(|(limit, again)| {
        let mut scene = scene();
        cubes(&mut scene, &places);
        if let Some(limit) = limit {
            scene.set_kept_pair_limit(limit);
        }
        let mut list = || -> Vec<[u64; 2]> {
            let answer = scene.query_distance(&SceneQuery::default()).unwrap();
            answer.pairs.iter().map(|pair| [pair.user_data1, pair.user_data2]).collect()
        };
        let lists = [list(), list()];
        assert_eq!(lists[0], lists[1]);
        assert_eq!((scene.statistics().pairs, scene.statistics().unmoved), (39_800, again));
        lists
    });
    assert!(listed.iter().all(|lists| *lists == listed[0]));
}

/// All pairs of up to six objects are near, whatever the tolerance: a look at them takes less than boxes. Of more objects, those
/// within it.
#[test]
fn few_pairs_are_near_whatever_the_tolerance_and_many_are_not() {
    let places: Vec<f64> = (0..300).map(|k| 50.0 * f64::from(k)).collect();
    for shrinks in [false, true] {
        let mut scene = scene();
        let few = cubes(&mut scene, &places[..6]);
        let looked_at = |scene: &mut Scene| {
            scene.reset_statistics();
            assert!(scene.query_distance(&up_to(0.5)).unwrap().pairs.is_empty());
            scene.statistics().pairs
        };
        assert_eq!(looked_at(&mut scene), 15);
        if shrinks {
            scene.shrink().unwrap();
        }
        let many = cubes(&mut scene, &places[6..]);
        assert_eq!(looked_at(&mut scene), 0);
        for id in many {
            scene.remove_object(id).unwrap();
        }
        assert_eq!(looked_at(&mut scene), 15);
        // One that comes near is found in either.
        scene.set_pose(few[5], &at(1.25, 0.0, 0.0)).unwrap();
        assert_eq!(scene.query_distance(&up_to(0.5)).unwrap().pairs.len(), 1);
        cubes(&mut scene, &places[6..]);
        assert_eq!(scene.query_distance(&up_to(0.5)).unwrap().pairs.len(), 1);
    }
}

/// All pairs of a few objects are kept; when they become many, only near ones are.
#[test]
fn a_crowd_that_grows_keeps_no_state_of_all_pairs() {
    let mut scene = scene();
    let places: Vec<f64> = (0..2_000).map(|k| 1.5 * f64::from(k)).collect();
    cubes(&mut scene, &places[..100]);
    assert_eq!(distances(&mut scene, &SceneQuery::default()).len(), 4_950);
    cubes(&mut scene, &places[100..]);
    for shrunk in [false, true] {
        if shrunk {
            scene.shrink().unwrap();
        }
        scene.reset_statistics();
        assert_eq!(scene.query_distance(&up_to(0.5)).unwrap().pairs.len(), 1_999);
        assert!(scene.statistics().pairs < 10_000, "{:?}", scene.statistics());
    }
    // Deactivated pairwise, by object and wholly, it stays as small.
    let ids: Vec<ObjectId> = scene.objects().map(|object| object.id()).collect();
    for pair in ids.windows(2).step_by(2) {
        scene.set_pair_active(pair[0], pair[1], false).unwrap();
    }
    assert_eq!(scene.query_distance(&up_to(0.5)).unwrap().pairs.len(), 999);
    scene.set_all_active(false);
    scene.reset_statistics();
    assert_eq!(scene.query_distance(&up_to(0.5)).unwrap().pairs.len(), 0);
    assert_eq!(scene.statistics().pairs, 0);
}
