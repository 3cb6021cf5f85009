//! Scenes through the public interface: what is listed, in which order, and what changes nothing.

use std::sync::Arc;

use swiftprox::error::Error;
use swiftprox::math::{Matrix, Pose, Vector};
use swiftprox::object::{ObjectId, ObjectOptions};
use swiftprox::pair::{FeatureKind, Outcome, PairAnswer};
use swiftprox::placed::Pair;
use swiftprox::placed::exact::solve;
use swiftprox::scene::{PairResult, Scene, SceneQuery};
use testkit::random_scene::{Random, cuboid, random_pose};
use testkit::shapes::at;

pub fn scene() -> Scene {
    Scene::new()
}

/// Unit cubes with their centres at the given places on the x axis; user data 100, 101, …
pub fn cubes(scene: &mut Scene, places: &[f64]) -> Vec<ObjectId> {
    let cube = cuboid([0.5; 3]);
    let add = |(k, &x): (usize, &f64)| {
        let options = ObjectOptions { pose: at(x, 0.0, 0.0), user_data: 100 + k as u64, ..Default::default() };
        scene.add_object(vec![cube.clone()], &options).unwrap()
    };
    places.iter().enumerate().map(add).collect()
}

pub fn up_to(max_distance: f64) -> SceneQuery {
    SceneQuery { max_distance, ..Default::default() }
}

fn listed(pairs: &[PairResult]) -> Vec<[ObjectId; 2]> {
    pairs.iter().map(|pair| [pair.object1, pair.object2]).collect()
}

pub fn distances(scene: &mut Scene, query: &SceneQuery) -> Vec<[ObjectId; 2]> {
    listed(scene.query_distance(query).unwrap().pairs)
}

fn refused<T: std::fmt::Debug>(result: Result<T, Error>, part: &str) {
    match result {
        Err(error) => assert!(error.message().contains(part), "{error:?} does not speak of {part:?}"),
        Ok(value) => panic!("accepted: {value:?}"),
    }
}

#[test]
fn an_empty_scene_answers() {
    let mut scene = scene();
    let answer = scene.query_contact(&SceneQuery::default()).unwrap();
    assert!(!answer.intersecting && answer.pairs.is_empty());
}

#[test]
fn each_query_lists_what_it_promises() {
    let mut scene = scene();
    // Gaps: 0–1 overlap, 1–2 a gap of 1.5, 0–2 a gap of 2.
    let ids = cubes(&mut scene, &[0.0, 0.5, 3.0]);
    let pair = |k: usize, l: usize| [ids[k], ids[l]];

    let answer = scene.query_intersection(&SceneQuery::default()).unwrap();
    assert!(answer.intersecting);
    assert_eq!(listed(answer.pairs), [pair(0, 1)]);
    assert_eq!(answer.pairs[0].answer.outcome, Outcome::Intersecting);
    assert_eq!((answer.pairs[0].user_data1, answer.pairs[0].user_data2), (100, 101));

    let answer = scene.query_distance(&SceneQuery::default()).unwrap();
    assert!(answer.intersecting);
    assert_eq!(listed(answer.pairs), [pair(0, 1), pair(0, 2), pair(1, 2)]);
    for (result, distance) in answer.pairs.iter().zip([0.0, 2.0, 1.5]) {
        assert!(result.answer.lower <= distance && distance <= result.answer.upper, "{result:?}");
    }

    // At most the tolerance: the pair exactly that far apart is listed, too.
    assert_eq!(listed(scene.query_distance(&up_to(1.5)).unwrap().pairs), [pair(0, 1), pair(1, 2)]);
    assert_eq!(listed(scene.query_distance(&up_to(1.5_f64.next_down())).unwrap().pairs), [pair(0, 1)]);
    assert_eq!(distances(&mut scene, &up_to(1.5)), [pair(0, 1), pair(1, 2)]);

    // Verification says of a separated pair all that the distance does, of an intersecting one the verdict.
    let [overlapping, apart] = scene.query_distance(&up_to(1.5)).unwrap().pairs else { panic!() };
    let points = |answer: &PairAnswer| [answer.local1, answer.local2, answer.world1, answer.world2, answer.normal];
    let features = |answer: &PairAnswer| [answer.feature1.kind, answer.feature2.kind];
    assert!(points(&apart.answer).as_flattened().iter().all(|x| x.is_finite()), "{apart:?}");
    assert!(!features(&apart.answer).contains(&FeatureKind::None) && apart.answer.proof_count == 0, "{apart:?}");
    assert!(apart.answer.upper - apart.answer.lower < 1e-13, "{apart:?}");
    assert!(points(&overlapping.answer).as_flattened().iter().all(|x| x.is_nan()), "{overlapping:?}");
    let PairAnswer { distance, lower, upper, proof_count, .. } = overlapping.answer;
    assert!([distance, lower, upper] == [0.0; 3] && proof_count > 0, "{overlapping:?}");
    assert_eq!(features(&overlapping.answer), [FeatureKind::None; 2]);

    let answer = scene.query_contact(&SceneQuery::default()).unwrap();
    assert_eq!(answer.pairs.len(), 3);
    for PairResult { answer, .. } in answer.pairs {
        let normal = Vector::from(answer.normal);
        assert!((normal.norm() - 1.0).abs() < 1e-12, "{answer:?}");
        let witnesses = answer.world1.iter().chain(&answer.world2).chain(&answer.local1).chain(&answer.local2);
        assert!(witnesses.into_iter().all(|x| x.is_finite()), "{answer:?}");
    }
}

/// A distance that is no double is beyond the next one below it and not beyond the next one above.
#[test]
fn a_tolerance_is_decided_to_the_last_digit() {
    let mut random = Random::new(0x701e);
    let mut exact = 0;
    for _ in 0..300 {
        let mut scene = scene();
        let ids = cubes(&mut scene, &[0.0, 3.0]);
        for (k, id) in ids.iter().enumerate() {
            let pose = random_pose(&mut random, 0.3);
            let along = Vector::new(3.0 * k as f64, 0.0, 0.0);
            scene.set_pose(*id, &Pose::new(&pose.rotation(), &(pose.translation() + along))).unwrap();
        }
        let [one, other] = [scene.object(ids[0]).unwrap(), scene.object(ids[1]).unwrap()];
        let polyhedra = [one, other].map(|object| object.pieces()[0].polyhedron());
        let truth = solve(&Pair { polyhedra, poses: [one.pose(), other.pose()] }, &[]);
        assert!(truth.lower < truth.upper && truth.lower.next_up() == truth.upper, "{truth:?}");
        for query in [Scene::query_distance, Scene::query_contact] {
            assert_eq!(listed(query(&mut scene, &up_to(truth.lower)).unwrap().pairs).len(), 0);
            assert_eq!(listed(query(&mut scene, &up_to(truth.upper)).unwrap().pairs), [[ids[0], ids[1]]]);
        }
        exact += scene.statistics().exact;
    }
    // Intervals in doubles are too wide for this.
    assert!(exact > 300);
}

#[test]
fn touching_is_intersecting() {
    let mut scene = scene();
    let ids = cubes(&mut scene, &[0.0, 1.0]);
    let answer = scene.query_intersection(&SceneQuery::default()).unwrap();
    assert!(answer.intersecting);
    assert_eq!(listed(answer.pairs), [[ids[0], ids[1]]]);
    assert_eq!(distances(&mut scene, &up_to(0.0)), [[ids[0], ids[1]]]);
}

#[test]
fn early_exit_lists_nothing_when_something_intersects() {
    let mut scene = scene();
    let ids = cubes(&mut scene, &[0.0, 2.0, 4.5]);
    let query = SceneQuery { early_exit: true, ..Default::default() };
    let answer = scene.query_distance(&query).unwrap();
    assert!(!answer.intersecting);
    assert_eq!((answer.pairs.len(), answer.found), (3, None));

    scene.set_pose(ids[2], &at(2.5, 0.0, 0.0)).unwrap();
    let answer = scene.query_distance(&query).unwrap();
    assert!(answer.intersecting && answer.pairs.is_empty());
    assert_eq!(answer.found.map(|found| [found.object1, found.object2]), Some([ids[1], ids[2]]));
    let answer = scene.query_intersection(&query).unwrap();
    assert!(answer.intersecting && answer.pairs.is_empty());
    assert_eq!(answer.found.map(|found| (found.user_data1, found.user_data2)), Some((101, 102)));
    // Of several the first in the order of results, however the objects came to where they are.
    scene.set_pose(ids[0], &at(1.5, 0.0, 0.0)).unwrap();
    for query in [query, SceneQuery { max_distance: 0.0, ..query }] {
        let found = scene.query_contact(&query).unwrap().found.copied().unwrap();
        assert_eq!([found.object1, found.object2], [ids[0], ids[1]]);
        assert_eq!(found.answer.outcome, Outcome::Intersecting);
    }
    assert_eq!(scene.query_contact(&SceneQuery::default()).unwrap().found, None);
}

/// Distances that no double holds are no reason to lose the others.
#[test]
fn far_objects_cost_no_other_answer() {
    let mut scene = scene();
    let ids = cubes(&mut scene, &[0.0, 0.5, f64::MAX, -f64::MAX, 1e300, 4.0]);
    let answer = scene.query_distance(&SceneQuery::default()).unwrap();
    assert!(answer.intersecting);
    assert_eq!(answer.pairs.len(), 15);
    for pair in answer.pairs {
        let near = [ids[0], ids[1], ids[5]];
        let both_near = near.contains(&pair.object1) && near.contains(&pair.object2);
        let PairAnswer { outcome, lower, upper, .. } = pair.answer;
        assert_eq!(outcome == Outcome::Intersecting, pair.object2 == ids[1], "{pair:?}");
        assert!(lower <= upper && (both_near || lower > 1e299), "{pair:?}");
    }
}

#[test]
fn a_senseless_tolerance_is_refused_and_the_scene_stays_usable() {
    let mut scene = scene();
    cubes(&mut scene, &[0.0, 2.0]);
    for tolerance in [-1.0, -f64::MIN_POSITIVE, f64::NEG_INFINITY, f64::NAN] {
        refused(scene.query_intersection(&up_to(tolerance)), "max_distance");
        refused(scene.query_distance(&up_to(tolerance)), "max_distance");
        refused(scene.query_distance(&up_to(tolerance)), "max_distance");
        refused(scene.query_contact(&up_to(tolerance)), "max_distance");
    }
    assert_eq!(distances(&mut scene, &SceneQuery::default()).len(), 1);
}

#[test]
fn a_bad_pose_is_refused_and_the_object_stays() {
    let mut scene = scene();
    let ids = cubes(&mut scene, &[0.0, 2.0]);
    let mut numbers = [1.0, 0.0, 0.0, 5.0, 0.0, 1.0, 0.0, 6.0, 0.0, 0.0, 1.0, 7.0];
    for (bad, part) in [(f64::NAN, "entry 5"), (f64::INFINITY, "entry 5"), (1.1, "orthonormal")] {
        numbers[5] = bad;
        refused(scene.set_pose(ids[0], &Pose::from_row_major(&numbers)), part);
        let options = ObjectOptions { pose: Pose::from_row_major(&numbers), ..Default::default() };
        refused(scene.add_object(vec![cuboid([1.0; 3])], &options), part);
    }
    numbers[5] = -1.0;
    refused(scene.set_pose(ids[0], &Pose::from_row_major(&numbers)), "reflection");
    assert_eq!(scene.object(ids[0]).unwrap().pose(), &Pose::IDENTITY);
    assert_eq!(scene.object_count(), 2);
    numbers[5] = 1.0;
    scene.set_pose(ids[0], &Pose::from_row_major(&numbers)).unwrap();
    assert_eq!(scene.object(ids[0]).unwrap().pose(), &at(5.0, 6.0, 7.0));
}

#[test]
fn the_pose_limit_is_the_scenes() {
    // RᵀR − I has the entry (1 + 1e-4)² − 1 ≈ 2e-4.
    let stretched = Pose::new(&(Matrix::identity() * (1.0 + 1e-4)), &Vector::zeros());
    let cube = cuboid([0.5; 3]);
    let options = ObjectOptions { pose: stretched, ..Default::default() };
    assert!(scene().add_object(vec![cube.clone()], &options).is_ok());
    // And (1 + 1e-2)² − 1 ≈ 2e-2.
    let beyond = Pose::new(&(Matrix::identity() * (1.0 + 1e-2)), &Vector::zeros());
    let mut scene = scene();
    refused(scene.add_object(vec![cube.clone()], &ObjectOptions { pose: beyond, ..Default::default() }), "orthonormal");
    let id = scene.add_object(vec![cube], &ObjectOptions::default()).unwrap();
    refused(scene.set_pose(id, &beyond), "orthonormal");
    refused(scene.set_all_poses(&[beyond]), "pose 0 of 1");
}

#[test]
fn all_poses_are_set_together_or_not_at_all() {
    let mut scene = scene();
    let ids = cubes(&mut scene, &[0.0, 10.0]);
    let fixed = ObjectOptions { fixed: true, ..Default::default() };
    let wall = scene.add_object(vec![cuboid([1.0; 3])], &fixed).unwrap();
    let last = scene.copy_object(ids[0]).unwrap();
    // Creation order, not slot order: the object in the slot used again is the last.
    scene.remove_object(ids[0]).unwrap();
    let again = scene.copy_object(ids[1]).unwrap();

    let poses = [at(1.0, 0.0, 0.0), at(2.0, 0.0, 0.0), at(3.0, 0.0, 0.0)];
    scene.set_all_poses(&poses).unwrap();
    let pose = |scene: &Scene, id| *scene.object(id).unwrap().pose();
    assert_eq!([ids[1], last, again].map(|id| pose(&scene, id)), poses);
    assert_eq!(pose(&scene, wall), Pose::IDENTITY);

    refused(scene.set_all_poses(&poses[..2]), "2 poses for 3 objects");
    let bad = [at(7.0, 0.0, 0.0), at(8.0, 0.0, 0.0), at(f64::NAN, 0.0, 0.0)];
    refused(scene.set_all_poses(&bad), "pose 2 of 3");
    assert_eq!([ids[1], last, again].map(|id| pose(&scene, id)), poses);
    // A fixed object may be moved on its own.
    scene.set_pose(wall, &at(4.0, 0.0, 0.0)).unwrap();
    assert_eq!(pose(&scene, wall), at(4.0, 0.0, 0.0));
}

#[test]
fn two_fixed_objects_make_no_pair() {
    let mut scene = scene();
    let cube = cuboid([1.0; 3]);
    let fixed = ObjectOptions { fixed: true, ..Default::default() };
    let walls = [(); 2].map(|()| scene.add_object(vec![cube.clone()], &fixed).unwrap());
    let moving = scene.add_object(vec![cube], &ObjectOptions::default()).unwrap();
    let pairs = [[walls[0], moving], [walls[1], moving]];
    assert_eq!(distances(&mut scene, &SceneQuery::default()), pairs);
    scene.set_pair_active(walls[0], walls[1], true).unwrap();
    scene.set_all_active(true);
    assert!(!scene.is_pair_active(walls[0], walls[1]).unwrap());
    assert_eq!(distances(&mut scene, &SceneQuery::default()), pairs);
}

#[test]
fn activation_decides_what_is_tested() {
    let mut scene = scene();
    let ids = cubes(&mut scene, &[0.0, 0.5, 1.0]);
    let all = SceneQuery::default();
    let pair = |k: usize, l: usize| [ids[k], ids[l]];
    assert_eq!(distances(&mut scene, &all), [pair(0, 1), pair(0, 2), pair(1, 2)]);

    // In either order, and remembered.
    scene.set_pair_active(ids[1], ids[0], false).unwrap();
    assert!(!scene.is_pair_active(ids[0], ids[1]).unwrap());
    assert_eq!(distances(&mut scene, &all), [pair(0, 2), pair(1, 2)]);
    assert_eq!(distances(&mut scene, &all), [pair(0, 2), pair(1, 2)]);

    // An object's word covers all its pairs.
    scene.set_object_active(ids[1], true).unwrap();
    assert_eq!(distances(&mut scene, &all).len(), 3);
    scene.set_object_active(ids[2], false).unwrap();
    assert_eq!(distances(&mut scene, &all), [pair(0, 1)]);

    // A robot among obstacles: one object active, all others not, and what comes later is active.
    scene.set_all_active(false);
    let answer = scene.query_intersection(&all).unwrap();
    assert!(!answer.intersecting && answer.pairs.is_empty());
    scene.set_object_active(ids[0], true).unwrap();
    assert_eq!(distances(&mut scene, &all), [pair(0, 1), pair(0, 2)]);
    let later = scene.copy_object(ids[2]).unwrap();
    let expected = [pair(0, 1), pair(0, 2), [ids[0], later], [ids[1], later], [ids[2], later]];
    assert_eq!(distances(&mut scene, &all), expected);

    refused(scene.set_pair_active(ids[0], ids[0], false), "twice");
    refused(scene.is_pair_active(later, later), "twice");
}

#[test]
fn a_removed_object_is_gone_and_its_id_stale() {
    let mut scene = scene();
    let ids = cubes(&mut scene, &[0.0, 2.0, 4.0]);
    assert_eq!(distances(&mut scene, &SceneQuery::default()).len(), 3);
    scene.set_pair_active(ids[0], ids[2], false).unwrap();
    scene.remove_object(ids[0]).unwrap();
    assert_eq!(distances(&mut scene, &SceneQuery::default()), [[ids[1], ids[2]]]);

    refused(scene.object(ids[0]), "stale");
    refused(scene.set_pose(ids[0], &Pose::IDENTITY), "stale");
    refused(scene.copy_object(ids[0]), "stale");
    refused(scene.remove_object(ids[0]), "stale");
    refused(scene.set_object_active(ids[0], true), "stale");
    refused(scene.set_pair_active(ids[1], ids[0], true), "stale");
    refused(scene.set_user_data(ids[0], 1), "stale");
    refused(scene.object(ObjectId::NULL), "null");
    let foreign = self::scene().add_object(vec![cuboid([1.0; 3])], &ObjectOptions::default()).unwrap();
    refused(scene.object(foreign), "not of this scene");

    // The slot's next object inherits nothing, and comes last.
    let again = scene.copy_object(ids[2]).unwrap();
    assert_eq!(distances(&mut scene, &SceneQuery::default()), [[ids[1], ids[2]], [ids[1], again], [ids[2], again]]);
    let order: Vec<ObjectId> = scene.objects().map(|object| object.id()).collect();
    assert_eq!(order, [ids[1], ids[2], again]);
}

#[test]
fn a_copy_shares_the_geometry_and_stands_where_its_original_does() {
    let mut scene = scene();
    let options = ObjectOptions { pose: at(1.0, 2.0, 3.0), fixed: true, user_data: 7, ..Default::default() };
    let id = scene.add_object(vec![cuboid([1.0; 3]), cuboid([2.0; 3])], &options).unwrap();
    let copy = scene.copy_object(id).unwrap();
    let (original, copied) = (scene.object(id).unwrap(), scene.object(copy).unwrap());
    assert_eq!(original.pieces().len(), 2);
    for (a, b) in original.pieces().iter().zip(copied.pieces()) {
        assert!(Arc::ptr_eq(a, b));
    }
    assert_eq!((copied.pose(), copied.fixed(), copied.user_data()), (&options.pose, true, 7));
    scene.set_user_data(copy, 8).unwrap();
    assert_eq!((scene.object(id).unwrap().user_data(), scene.object(copy).unwrap().user_data()), (7, 8));
    refused(scene.add_object(Vec::new(), &ObjectOptions::default()), "at least one piece");
}
