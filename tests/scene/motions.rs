//! Scenes of many objects list exactly the pairs that a look at all pairs lists, in the same order, however the objects move.
//!
//! Four motions, shapes from fat to long, mixed sizes and pieces, tolerances from 0 to none, fixed objects, skewed poses and places
//! far from the origin: after every step each list is compared with all pairs of the pair layer, asked without a past.

use std::sync::Arc;

use swiftprox::math::{Matrix, Pose, Vector};
use swiftprox::mesh::PolygonMesh;
use swiftprox::object::{ObjectId, ObjectOptions};
use swiftprox::pair::{self, Outcome, PairAnswer, PairCache, PairConfig};
use swiftprox::scene::{PairResult, Scene, SceneQuery};
use swiftprox::shape::{Shape, ShapeOptions};
use testkit::models::{ELLIPSOIDS, cuboid, ellipsoid, random_hull};
use testkit::random::Random;

const OBJECTS: usize = 300;
const STEPS: usize = 5;
const TOLERANCES: [f64; 3] = [0.0, 0.25, 1.0];

#[derive(Debug, Clone, Copy, PartialEq)]
enum Motion {
    AllALittle,
    Few,
    /// Crowded, and hardly anything moves.
    Pile,
    Teleport,
}

#[derive(Debug, Clone, Copy, PartialEq)]
enum Setting {
    Plain,
    /// Every third object is fixed; fixed ones move, too.
    Fixed,
    /// Rotations that are none up to 5e-3.
    Skewed,
    /// Single precision cannot tell neighbours apart.
    FarAway,
}

fn shape(mesh: &PolygonMesh, scale: f64) -> Arc<Shape> {
    Arc::new(Shape::from_mesh(mesh, &ShapeOptions { scale, ..ShapeOptions::default() }).unwrap())
}

/// The pieces of one object after the other, in turn.
fn families() -> Vec<(&'static str, Vec<Vec<Arc<Shape>>>)> {
    let mut families: Vec<_> =
        ELLIPSOIDS.iter().map(|&(name, half)| (name, vec![vec![shape(&ellipsoid(half, 102).unwrap(), 1.0)]])).collect();
    let mixed = [(8, 1.0), (20, 0.3), (102, 2.0), (300, 0.5), (1002, 4.0)];
    let mixed = mixed.iter().map(|&(n, scale)| vec![shape(&random_hull(n, n as u64).unwrap(), scale)]);
    families.push(("mixed", mixed.collect()));
    let moved = |at: [f64; 3]| {
        let mesh = cuboid([0.4, 0.3, 0.2]).unwrap();
        let options = ShapeOptions { translation: Vector::from(at), ..ShapeOptions::default() };
        Arc::new(Shape::from_mesh(&mesh, &options).unwrap())
    };
    // The last one is far from the object's origin, so its centre is its own.
    let pieces = vec![moved([0.0; 3]), moved([0.9, 0.0, 0.0]), moved([0.0, 4.0, 0.3])];
    families.push(("pieces", vec![pieces.clone(), pieces[..1].to_vec()]));
    families
}

fn skewed(pose: &Pose, random: &mut Random, setting: Setting) -> Pose {
    if setting != Setting::Skewed {
        return *pose;
    }
    let skew = Matrix::identity() + Matrix::from_fn(|_, _| random.signed() * 2e-3);
    Pose::new(&(pose.rotation() * skew), &pose.translation())
}

fn anywhere(random: &mut Random, size: f64, setting: Setting) -> Pose {
    let origin = if setting == Setting::FarAway { Vector::new(3e7, -1e7, 2e6) } else { Vector::zeros() };
    let pose = Pose::new(&random.rotation(), &(origin + random.vector() * size));
    skewed(&pose, random, setting)
}

fn stepped(random: &mut Random, pose: &Pose, step: f64) -> Pose {
    let turn = nalgebra::Rotation3::from_scaled_axis(random.vector() * step);
    Pose::new(&(turn.matrix() * pose.rotation()), &(pose.translation() + random.vector() * step))
}

type Key = (ObjectId, ObjectId, u32, u32);

fn key(result: &PairResult) -> Key {
    (result.object1, result.object2, result.piece1, result.piece2)
}

/// All pairs of the pair layer with cold caches: those not farther apart than the tolerance.
fn all_pairs(scene: &Scene, tolerance: f64) -> Vec<(Key, PairAnswer)> {
    let objects: Vec<_> = scene.objects().collect();
    let config = PairConfig { max_distance: tolerance, ..PairConfig::default() };
    let mut found = Vec::new();
    for (k, object1) in objects.iter().enumerate() {
        for object2 in objects[k + 1..].iter().filter(|object2| !(object1.fixed() && object2.fixed())) {
            for (piece1, shape1) in (0..).zip(object1.pieces()) {
                for (piece2, shape2) in (0..).zip(object2.pieces()) {
                    let (mut cache, mut answer) = (PairCache::default(), PairAnswer::default());
                    let (pose1, pose2) = (object1.pose(), object2.pose());
                    pair::distance([shape1.at(pose1), shape2.at(pose2)], &mut cache, &config, &mut answer).unwrap();
                    if answer.outcome != Outcome::Beyond {
                        found.push(((object1.id(), object2.id(), piece1, piece2), answer));
                    }
                }
            }
        }
    }
    found
}

/// The list is what of all pairs is within the tolerance.
fn agree(listed: &[PairResult], all: &[(Key, PairAnswer)], is_listed: impl Fn(&PairAnswer) -> bool, what: &str) {
    let expected: Vec<&(Key, PairAnswer)> = all.iter().filter(|(_, answer)| is_listed(answer)).collect();
    let keys: Vec<Key> = expected.iter().map(|(key, _)| *key).collect();
    assert_eq!(listed.iter().map(key).collect::<Vec<_>>(), keys, "{what}");
    for (result, (_, truth)) in listed.iter().zip(expected) {
        let answer = &result.answer;
        assert_eq!(answer.outcome, truth.outcome, "{what}");
        assert!(answer.lower <= truth.upper && truth.lower <= answer.upper, "{what}: {answer:?} {truth:?}");
    }
}

fn check(scene: &mut Scene, without_tolerance: bool, what: &str) -> usize {
    let all = all_pairs(scene, TOLERANCES[2]);
    let intersects = |answer: &PairAnswer| answer.outcome == Outcome::Intersecting;
    // A pair at the tolerance itself would have to be decided in integers.
    let within = |tolerance: f64| {
        move |answer: &PairAnswer| {
            assert!(!(answer.lower <= tolerance && tolerance < answer.upper));
            intersects(answer) || answer.upper <= tolerance
        }
    };
    agree(scene.query_intersection(&SceneQuery::default()).unwrap().pairs, &all, intersects, what);
    for max_distance in TOLERANCES {
        let query = SceneQuery { max_distance, ..SceneQuery::default() };
        agree(scene.query_distance(&query).unwrap().pairs, &all, within(max_distance), what);
        let coarse = SceneQuery { absolute_error: 0.05, ..query };
        let listed = scene.query_approximate(&coarse).unwrap().pairs;
        assert!(listed.iter().all(|result| result.answer.upper - result.answer.lower <= 0.05));
        agree(listed, &all, within(max_distance), what);
    }
    let first = all.iter().find(|(_, answer)| intersects(answer)).map(|(key, _)| *key);
    let early = SceneQuery { early_exit: true, ..SceneQuery::default() };
    assert_eq!(scene.query_intersection(&early).unwrap().found.map(key), first, "{what}");
    if without_tolerance {
        let touching = SceneQuery { max_distance: 0.0, ..SceneQuery::default() };
        agree(scene.query_contact(&touching).unwrap().pairs, &all, intersects, what);
        let all = all_pairs(scene, f64::INFINITY);
        agree(scene.query_distance(&SceneQuery::default()).unwrap().pairs, &all, |_| true, what);
    }
    all.len()
}

fn run(motion: Motion, setting: Setting, family: &[Vec<Arc<Shape>>], what: &str) -> usize {
    let mut random = Random::new(0x5ce4e + motion as u64 * 17 + setting as u64);
    let size = if motion == Motion::Pile { 4.0 } else { 9.0 };
    let mut scene = Scene::new();
    let mut ids = Vec::new();
    for k in 0..OBJECTS {
        let fixed = setting == Setting::Fixed && k % 3 == 0;
        let options = ObjectOptions {
            pose: anywhere(&mut random, size, setting),
            fixed,
            user_data: k as u64,
            ..Default::default()
        };
        ids.push(scene.add_object(family[k % family.len()].clone(), &options).unwrap());
    }
    let mut near = 0;
    for step in 0..STEPS {
        for &id in &ids {
            let pose = *scene.object(id).unwrap().pose();
            let moved = match motion {
                Motion::AllALittle => stepped(&mut random, &pose, 0.02),
                Motion::Few if random.below(20) == 0 => stepped(&mut random, &pose, 0.3),
                Motion::Pile if random.below(50) == 0 => stepped(&mut random, &pose, 1e-5),
                Motion::Teleport => anywhere(&mut random, size, setting),
                Motion::Few | Motion::Pile => continue,
            };
            // What has drifted from a rotation is one again, or skewed anew.
            scene.set_pose(id, &moved).unwrap();
        }
        // The list's tolerance goes up and down.
        near += check(&mut scene, step + 1 == STEPS, &format!("{what}, {motion:?}, {setting:?}, step {step}"));
    }
    near
}

fn run_all(setting: Setting) {
    for (name, family) in families() {
        for motion in [Motion::AllALittle, Motion::Few, Motion::Pile, Motion::Teleport] {
            let near = run(motion, setting, &family, name);
            assert!(near > 100 * STEPS, "{name} {motion:?}: {near} near pairs are too few to tell");
        }
    }
}

/// The same query step after step, so that most answers are given again: while few objects move, others come and go, are left out
/// for a step, and sometimes get other user data.
#[test]
fn answers_given_again_are_those_of_all_pairs() {
    for (name, family) in families() {
        for verdicts in [true, false] {
            let mut random = Random::new(0xa6a1);
            let mut scene = Scene::new();
            let add = |scene: &mut Scene, random: &mut Random| {
                let pose = anywhere(random, 5.0, Setting::Plain);
                let options = ObjectOptions { pose, user_data: random.below(1000) as u64, ..Default::default() };
                scene.add_object(family[random.below(family.len())].clone(), &options).unwrap();
            };
            (0..OBJECTS / 2).for_each(|_| add(&mut scene, &mut random));
            for step in 0..3 * STEPS {
                let ids: Vec<ObjectId> = scene.objects().map(|object| object.id()).collect();
                let mut left_out = Vec::new();
                for &id in &ids {
                    let pose = *scene.object(id).unwrap().pose();
                    match random.below(100) {
                        0..5 => scene.set_pose(id, &stepped(&mut random, &pose, 0.1)).unwrap(),
                        5 => scene.remove_object(id).unwrap(),
                        6 => add(&mut scene, &mut random),
                        7 => left_out.push(id),
                        8 if step % 3 == 0 => scene.set_user_data(id, 1000 + step as u64).unwrap(),
                        _ => {}
                    }
                }
                // All pairs of an object that is added later are active.
                left_out.iter().for_each(|&id| scene.set_object_active(id, false).unwrap());
                let mut all = all_pairs(&scene, 0.25);
                all.retain(|((id1, id2, ..), _)| !left_out.contains(id1) && !left_out.contains(id2));
                let query = SceneQuery { max_distance: 0.25, ..SceneQuery::default() };
                let what = format!("{name}, verdicts {verdicts}, step {step}");
                let listed = if verdicts {
                    let listed = scene.query_intersection(&query).unwrap().pairs.to_vec();
                    agree(&listed, &all, |answer| answer.outcome == Outcome::Intersecting, &what);
                    listed
                } else {
                    let listed = scene.query_distance(&query).unwrap().pairs.to_vec();
                    agree(&listed, &all, |_| true, &what);
                    listed
                };
                for result in &listed {
                    let of = |id: ObjectId| scene.object(id).unwrap().user_data();
                    assert_eq!(
                        (result.user_data1, result.user_data2),
                        (of(result.object1), of(result.object2)),
                        "{what}"
                    );
                }
                left_out.iter().for_each(|&id| scene.set_object_active(id, true).unwrap());
            }
            let statistics = scene.statistics();
            assert!(3 * statistics.unmoved > statistics.pairs, "{name}: {statistics:?}");
        }
    }
}

#[test]
fn plain_scenes() {
    run_all(Setting::Plain);
}

#[test]
fn scenes_with_fixed_objects() {
    run_all(Setting::Fixed);
}

#[test]
fn scenes_of_skewed_poses() {
    run_all(Setting::Skewed);
}

#[test]
fn scenes_far_from_the_origin() {
    run_all(Setting::FarAway);
}
