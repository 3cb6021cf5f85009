//! A long life of a scene: mixed calls drawn from a seeded generator, each query compared with all pairs of the pair layer.
//!
//! `SWIFTPROX_SOAK=1000000 cargo test --release --test scene soak` makes a million calls.

use std::sync::Arc;

use swiftprox::math::{Matrix, Pose, Vector};
use swiftprox::object::{ObjectId, ObjectOptions};
use swiftprox::pair::{self, Outcome, PairAnswer, PairCache, PairConfig};
use swiftprox::scene::{ObjectPair, PairFilter, PairResult, Query, Scene, SceneQuery, Workers};
use swiftprox::shape::Shape;
use testkit::random_scene::{Random, cuboid, ellipsoid, random_pose};

use super::record::{Tape, play};

/// Without the variable.
const CALLS: usize = 10_000;

/// So many calls from the first on are recorded as a whole.
const RECORDED: usize = 1_500;

const MOST_OBJECTS: usize = 40;

/// The scene as a plain list.
struct Model {
    objects: Vec<Object>,
    /// Deactivated pairs, the earlier object first.
    inactive: Vec<[ObjectId; 2]>,
    /// What the filter refuses: pairs whose numbers' sum has this remainder by 5.
    refused: Option<u64>,
    given: Option<Vec<[ObjectId; 2]>>,
    /// Near at the last query about events.
    events: Vec<[ObjectId; 2]>,
}

#[derive(Clone)]
struct Object {
    id: ObjectId,
    pieces: Vec<Arc<Shape>>,
    pose: Pose,
    piece_poses: Vec<Pose>,
    fixed: bool,
    user_data: u64,
    groups: u32,
    mask: u32,
}

impl Object {
    fn world(&self, piece: usize) -> Pose {
        let (outer, inner) = (&self.pose, &self.piece_poses[piece]);
        if self.piece_poses.iter().all(|pose| *pose == Pose::IDENTITY) {
            return self.pose;
        }
        Pose::new(&(outer.rotation() * inner.rotation()), &outer.transform(&inner.translation()))
    }
}

/// What the filter adds up: ids, as it is told no more.
fn refuses(remainder: u64, pair: [ObjectId; 2]) -> bool {
    pair.map(|id| id.to_bits() % 5).iter().sum::<u64>() % 5 == remainder
}

type Key = (ObjectId, ObjectId, u64, u64, u32, u32);

impl Model {
    fn place(&self, id: ObjectId) -> usize {
        self.objects.iter().position(|object| object.id == id).unwrap()
    }

    fn ordered(&self, one: ObjectId, other: ObjectId) -> [ObjectId; 2] {
        if self.place(one) < self.place(other) { [one, other] } else { [other, one] }
    }

    fn set_active(&mut self, pair: [ObjectId; 2], active: bool) {
        self.inactive.retain(|known| *known != pair);
        if !active {
            self.inactive.push(pair);
        }
    }

    fn tests(&self, one: &Object, other: &Object) -> bool {
        let pair = [one.id, other.id];
        !(one.fixed && other.fixed)
            && one.groups & other.mask != 0
            && other.groups & one.mask != 0
            && !self.inactive.contains(&pair)
            && !self.refused.is_some_and(|remainder| refuses(remainder, pair))
            && self.given.as_ref().is_none_or(|given| given.contains(&pair) || given.contains(&[pair[1], pair[0]]))
    }

    /// What is near to a shape that is put somewhere.
    fn near_placed(&self, shape: &Shape, pose: &Pose, tolerance: f64) -> Vec<(Key, PairAnswer)> {
        let mut found = Vec::new();
        for one in &self.objects {
            for (piece, piece_shape) in one.pieces.iter().enumerate() {
                let answer = asked(piece_shape, &one.world(piece), shape, pose, tolerance);
                if answer.outcome != Outcome::Beyond {
                    found.push(((one.id, ObjectId::NULL, one.user_data, 0, piece as u32, 0), answer));
                }
            }
        }
        found
    }

    /// All pairs not farther apart than the tolerance, asked of the pair layer.
    fn near(&self, tolerance: f64) -> Vec<(Key, PairAnswer)> {
        let mut found = Vec::new();
        for (k, one) in self.objects.iter().enumerate() {
            for other in &self.objects[k + 1..] {
                if !self.tests(one, other) {
                    continue;
                }
                for (piece1, shape1) in one.pieces.iter().enumerate() {
                    for (piece2, shape2) in other.pieces.iter().enumerate() {
                        let answer = asked(shape1, &one.world(piece1), shape2, &other.world(piece2), tolerance);
                        if answer.outcome != Outcome::Beyond {
                            let users = (one.user_data, other.user_data);
                            let pieces = (piece1 as u32, piece2 as u32);
                            found.push(((one.id, other.id, users.0, users.1, pieces.0, pieces.1), answer));
                        }
                    }
                }
            }
        }
        found
    }
}

/// Without a past.
fn asked(shape1: &Shape, pose1: &Pose, shape2: &Shape, pose2: &Pose, max_distance: f64) -> PairAnswer {
    let (mut cache, mut answer) = (PairCache::default(), PairAnswer::default());
    let config = PairConfig { max_distance, ..PairConfig::default() };
    pair::distance([shape1.at(pose1), shape2.at(pose2)], &mut cache, &config, &mut answer).unwrap();
    answer
}

fn agree(listed: &[PairResult], expected: &[(Key, PairAnswer)], what: &str) {
    let key = |r: &PairResult| (r.object1, r.object2, r.user_data1, r.user_data2, r.piece1, r.piece2);
    let keys: Vec<Key> = expected.iter().map(|(key, _)| *key).collect();
    assert_eq!(listed.iter().map(key).collect::<Vec<_>>(), keys, "{what}");
    for (result, (_, truth)) in listed.iter().zip(expected) {
        assert_eq!(result.answer.outcome, truth.outcome, "{what}");
        assert!(result.answer.lower <= truth.upper && truth.lower <= result.answer.upper, "{what}: {result:?}");
    }
}

fn query(scene: &mut Scene, model: &mut Model, shapes: &[Arc<Shape>], random: &mut Random, what: &str) {
    let max_distance = random.pick(&[0.0, 0.05, 0.3, 2.0, 1e3, f64::INFINITY]);
    let early_exit = random.below(8) == 0;
    let query = SceneQuery { max_distance, early_exit, ..SceneQuery::default() };
    let kind = random.below(9);
    let what = format!("{what}: {kind} {query:?}");
    let verdict_only = kind < 2 || kind > 5 && random.below(2) == 0;
    let tolerance = if verdict_only { 0.0 } else { max_distance };
    let question = if verdict_only { Query::Intersection } else { Query::Distance };
    let mut expected = model.near(tolerance);
    let answer = match kind {
        0 | 1 => scene.query_intersection(&query),
        2 => scene.query_distance(&query),
        3 => scene.query_contact(&query),
        4 => scene.query_approximate(&SceneQuery { absolute_error: 0.01, ..query }),
        5 => scene.query_approximate(&SceneQuery { error_budget: 0.5, ..query }),
        6 if !model.objects.is_empty() => {
            let id = model.objects[random.below(model.objects.len())].id;
            expected.retain(|((one, other, ..), _)| [one, other].contains(&&id));
            scene.query_object(id, question, &query)
        }
        7 => {
            let (shape, pose) = (&shapes[random.below(shapes.len())], random_pose(random, 4.0));
            expected = model.near_placed(shape, &pose, tolerance);
            scene.query_placed(shape, &pose, question, &query)
        }
        _ => return events(scene, model, tolerance, &what),
    };
    let answer = answer.unwrap();
    let intersects = |(_, answer): &(Key, PairAnswer)| answer.outcome == Outcome::Intersecting;
    if verdict_only {
        expected.retain(intersects);
    }
    let first = expected.iter().position(intersects);
    assert_eq!(answer.intersecting, first.is_some(), "{what}");
    match (early_exit, first) {
        (true, Some(first)) => {
            assert!(answer.pairs.is_empty());
            agree(answer.found.map_or(&[], std::slice::from_ref), &expected[first..=first], &what);
        }
        _ => agree(answer.pairs, &expected, &what),
    }
    if kind == 5 && !early_exit {
        let spent: f64 = answer.pairs.iter().map(|pair| pair.answer.upper - pair.answer.lower).sum();
        assert!(spent <= 0.5 * (1.0 + 1e-9), "{what}: {spent}");
    }
}

fn events(scene: &mut Scene, model: &mut Model, distance: f64, what: &str) {
    let mut expected = model.near(distance);
    if distance == 0.0 {
        expected.retain(|(_, answer)| answer.outcome == Outcome::Intersecting);
    }
    let mut near: Vec<[ObjectId; 2]> = expected.iter().map(|((one, other, ..), _)| [*one, *other]).collect();
    near.dedup();
    let found = scene.query_events(distance).unwrap();
    let ids = |pairs: &[ObjectPair]| pairs.iter().map(|pair| [pair.object1, pair.object2]).collect::<Vec<_>>();
    let new: Vec<_> = near.iter().filter(|pair| !model.events.contains(pair)).copied().collect();
    let old: Vec<_> = model.events.iter().filter(|pair| !near.contains(pair)).copied().collect();
    assert_eq!((ids(found.began), ids(found.ended)), (new, old), "{what}");
    model.events = near;
}

#[test]
fn a_long_life() {
    let calls = std::env::var("SWIFTPROX_SOAK").map_or(CALLS, |count| count.parse().expect("a number of calls"));
    let mut random = Random::new(0x50a4);
    let mut shapes = vec![cuboid([0.5, 0.3, 0.2]), cuboid([0.1, 0.1, 1.5]), cuboid([1.5, 1.5, 0.02])];
    shapes.push(ellipsoid(&mut random, 40, [0.6, 0.4, 0.2], Vector::zeros()));
    shapes.push(ellipsoid(&mut random, 12, [0.3, 0.3, 0.3], Vector::new(0.4, 0.0, 0.0)));
    shapes.push(ellipsoid(&mut random, 600, [0.6, 0.6, 0.6], Vector::new(3.0, 0.0, 0.1)));
    let mut scene = Scene::new();
    let mut tape = Some(Tape::default());
    scene.record_to(tape.clone().unwrap_or_default()).unwrap();
    let mut model = Model { objects: Vec::new(), inactive: Vec::new(), refused: None, given: None, events: Vec::new() };
    for call in 0..calls {
        let what = format!("call {call}");
        let count = model.objects.len();
        let any = if count > 0 { random.below(count) } else { 0 };
        match random.below(40) {
            0..3 if count < MOST_OBJECTS => {
                let pieces: Vec<_> =
                    (0..1 + random.below(3)).map(|_| shapes[random.below(shapes.len())].clone()).collect();
                let (pose, fixed) = (random_pose(&mut random, 4.0), random.below(4) == 0);
                let (groups, mask) = (1 << random.below(3), if random.below(3) == 0 { 0b110 } else { u32::MAX });
                let options = ObjectOptions { pose, fixed, user_data: call as u64, groups, mask };
                let id = scene.add_object(pieces.clone(), &options).unwrap();
                let piece_poses = vec![Pose::IDENTITY; pieces.len()];
                let user_data = call as u64;
                model.objects.push(Object { id, pieces, pose, piece_poses, fixed, user_data, groups, mask });
            }
            3 if count > 0 => {
                let Object { id, .. } = model.objects.remove(any);
                scene.remove_object(id).unwrap();
                model.inactive.retain(|pair| !pair.contains(&id));
            }
            4 if count > 0 && count < MOST_OBJECTS => {
                let original = &model.objects[any];
                let id = scene.copy_object(original.id).unwrap();
                let copy = Object { id, ..original.clone() };
                model.objects.push(copy);
            }
            5 if count > 0 => {
                model.objects[any].user_data = call as u64;
                scene.set_user_data(model.objects[any].id, call as u64).unwrap();
            }
            6..8 if count > 1 => {
                let other = (any + 1 + random.below(count - 1)) % count;
                let (one, other) = (model.objects[any].id, model.objects[other].id);
                let active = random.below(2) == 0;
                scene.set_pair_active(one, other, active).unwrap();
                model.set_active(model.ordered(one, other), active);
            }
            8 if count > 0 => {
                let (id, active) = (model.objects[any].id, random.below(2) == 0);
                scene.set_object_active(id, active).unwrap();
                let others: Vec<ObjectId> = model.objects.iter().map(|object| object.id).filter(|&o| o != id).collect();
                for other in others {
                    model.set_active(model.ordered(id, other), active);
                }
            }
            9 if random.below(4) == 0 => {
                let active = random.below(4) > 0;
                scene.set_all_active(active);
                model.inactive.clear();
                for k in 0..if active { 0 } else { count } {
                    for l in k + 1..count {
                        model.inactive.push([model.objects[k].id, model.objects[l].id]);
                    }
                }
            }
            10..13 if count > 0 => {
                let pose = random_pose(&mut random, 4.0);
                model.objects[any].pose = pose;
                scene.set_pose(model.objects[any].id, &pose).unwrap();
            }
            13..16 => {
                let step = random.power(-30, -2);
                let mut poses = Vec::new();
                for object in model.objects.iter_mut().filter(|object| !object.fixed) {
                    let turn = nalgebra::Rotation3::from_scaled_axis(random.vector() * step);
                    let rotation: Matrix = turn.matrix() * object.pose.rotation();
                    object.pose = Pose::new(&rotation, &(object.pose.translation() + random.vector() * step));
                    poses.push(object.pose);
                }
                scene.set_all_poses(&poses).unwrap();
            }
            16 if count > 0 => {
                let fixed = random.below(3) == 0;
                scene.set_fixed(model.objects[any].id, fixed).unwrap();
                model.objects[any].fixed = fixed;
            }
            17 if count > 0 => {
                let (groups, mask) = (1 << random.below(3), random.pick(&[0b110, 0b11, u32::MAX, 0]));
                scene.set_filter(model.objects[any].id, groups, mask).unwrap();
                (model.objects[any].groups, model.objects[any].mask) = (groups, mask);
            }
            18 if count > 0 => {
                let piece = random.below(model.objects[any].pieces.len());
                let pose = if random.below(4) == 0 { Pose::IDENTITY } else { random_pose(&mut random, 0.5) };
                scene.set_piece_pose(model.objects[any].id, piece as u32, &pose).unwrap();
                model.objects[any].piece_poses[piece] = pose;
            }
            19 if count > 1 => {
                let ids: Vec<ObjectId> = (0..random.below(5)).map(|k| model.objects[(any + k) % count].id).collect();
                let poses: Vec<Pose> = ids.iter().map(|_| random_pose(&mut random, 4.0)).collect();
                scene.set_poses(&ids, &poses).unwrap();
                for (id, pose) in ids.iter().zip(poses) {
                    let place = model.place(*id);
                    model.objects[place].pose = pose;
                }
            }
            20 if random.below(3) == 0 => {
                model.refused = if random.below(2) == 0 { Some(random.below(5) as u64) } else { None };
                let filter = model.refused.map(|remainder| PairFilter::new(move |a, b| !refuses(remainder, [a, b])));
                scene.set_pair_filter(filter);
            }
            21 if count > 1 && random.below(3) == 0 => {
                let mut pair = || {
                    let one = random.below(count);
                    [model.objects[one].id, model.objects[(one + 1 + random.below(count - 1)) % count].id]
                };
                let pairs: Vec<[ObjectId; 2]> = (0..60).map(|_| pair()).collect();
                model.given = Some(pairs);
                scene.set_pairs(model.given.as_deref()).unwrap();
            }
            22 if random.below(2) == 0 => {
                model.given = None;
                scene.set_pairs(None).unwrap();
            }
            23 => scene.shrink().unwrap(),
            24 => scene.filter_again(),
            25 => scene.set_workers(Some(Workers::threads(1 + random.below(3)))),
            26 if call > RECORDED && random.below(4) == 0 => match tape.take() {
                // What was recorded from the middle of the scene's life lists the same when it is played.
                Some(tape) => {
                    scene.end_recording().unwrap();
                    play(&tape.bytes(), None).unwrap();
                }
                None => scene.record_to(tape.insert(Tape::default()).clone()).unwrap(),
            },
            _ => query(&mut scene, &mut model, &shapes, &mut random, &what),
        }
        if call == RECORDED
            && let Some(tape) = tape.take()
        {
            scene.end_recording().unwrap();
            let played = play(&tape.bytes(), None).unwrap();
            assert!(played.asked > RECORDED / 4 && played.identical == played.asked, "{played:?}");
        }
        assert_eq!(scene.object_count(), model.objects.len());
    }
    drop(scene);
    for shape in &shapes {
        model.objects.clear();
        assert_eq!(Arc::strong_count(shape), 1, "an ended scene gives its shares back");
    }
}
