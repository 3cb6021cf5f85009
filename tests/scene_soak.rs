//! A long life of a scene: mixed calls drawn from a seeded generator, each query compared with all pairs of the pair layer.
//!
//! `SWIFTPROX_SOAK=1000000 cargo test --release --test scene_soak` makes a million calls.

#[path = "../benches/common/random.rs"]
mod random;
mod random_scene;
mod shapes;

use std::sync::Arc;

use random_scene::{Random, cuboid, ellipsoid, random_pose};
use swiftprox::math::{Matrix, Pose, Vector};
use swiftprox::object::{ObjectId, ObjectOptions};
use swiftprox::pair::{self, Outcome, PairAnswer, PairCache, PairConfig};
use swiftprox::scene::{PairResult, Scene, SceneOptions, SceneQuery};
use swiftprox::shape::Shape;

/// Without the variable.
const CALLS: usize = 3_000;

const MOST_OBJECTS: usize = 40;

/// The scene as a plain list.
struct Model {
    objects: Vec<Object>,
    /// Deactivated pairs, the earlier object first.
    inactive: Vec<[ObjectId; 2]>,
}

struct Object {
    id: ObjectId,
    pieces: Vec<Arc<Shape>>,
    pose: Pose,
    fixed: bool,
    user_data: u64,
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

    /// All pairs not farther apart than the tolerance, asked of the pair layer.
    fn near(&self, tolerance: f64) -> Vec<(Key, PairAnswer)> {
        let mut found = Vec::new();
        for (k, one) in self.objects.iter().enumerate() {
            for other in &self.objects[k + 1..] {
                if one.fixed && other.fixed || self.inactive.contains(&[one.id, other.id]) {
                    continue;
                }
                for (piece1, shape1) in (0..).zip(&one.pieces) {
                    for (piece2, shape2) in (0..).zip(&other.pieces) {
                        let (mut cache, mut answer) = (PairCache::default(), PairAnswer::default());
                        let config = PairConfig { distance_tolerance: tolerance, ..PairConfig::default() };
                        pair::distance(shape1, &one.pose, shape2, &other.pose, &mut cache, &config, &mut answer)
                            .unwrap();
                        if answer.outcome != Outcome::Beyond {
                            found.push(((one.id, other.id, one.user_data, other.user_data, piece1, piece2), answer));
                        }
                    }
                }
            }
        }
        found
    }
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

fn query(scene: &mut Scene, model: &Model, random: &mut Random, what: &str) {
    let distance_tolerance = random.pick(&[0.0, 0.05, 0.3, 2.0, 1e3, f64::INFINITY]);
    let early_exit = random.below(8) == 0;
    let query = SceneQuery { distance_tolerance, early_exit, ..SceneQuery::default() };
    let kind = random.below(6);
    let answer = match kind {
        0 | 1 => scene.query_intersection(&query),
        2 => scene.query_exact_distance(&query),
        3 => scene.query_contacts(&query),
        4 => scene.query_approximate_distance(&SceneQuery { absolute_error: 0.01, ..query }),
        _ => scene.query_approximate_distance(&SceneQuery { error_budget: 0.5, ..query }),
    };
    let answer = answer.unwrap();
    let what = format!("{what}: {kind} {query:?}");
    let mut expected = model.near(if kind < 2 { 0.0 } else { distance_tolerance });
    let intersects = |(_, answer): &(Key, PairAnswer)| answer.outcome == Outcome::Intersecting;
    if kind < 2 {
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

#[test]
fn a_long_life() {
    let calls = std::env::var("SWIFTPROX_SOAK").map_or(CALLS, |count| count.parse().expect("a number of calls"));
    let mut random = Random::new(0x50a4);
    let mut shapes = vec![cuboid([0.5, 0.3, 0.2]), cuboid([0.1, 0.1, 1.5]), cuboid([1.5, 1.5, 0.02])];
    shapes.push(ellipsoid(&mut random, 40, [0.6, 0.4, 0.2], Vector::zeros()));
    shapes.push(ellipsoid(&mut random, 12, [0.3, 0.3, 0.3], Vector::new(0.4, 0.0, 0.0)));
    shapes.push(ellipsoid(&mut random, 600, [0.6, 0.6, 0.6], Vector::new(3.0, 0.0, 0.1)));
    let mut scene = Scene::new(&SceneOptions::default()).unwrap();
    let mut model = Model { objects: Vec::new(), inactive: Vec::new() };
    for call in 0..calls {
        let what = format!("call {call}");
        let count = model.objects.len();
        let any = if count > 0 { random.below(count) } else { 0 };
        match random.below(24) {
            0..3 if count < MOST_OBJECTS => {
                let pieces: Vec<_> =
                    (0..1 + random.below(3)).map(|_| shapes[random.below(shapes.len())].clone()).collect();
                let (pose, fixed) = (random_pose(&mut random, 4.0), random.below(4) == 0);
                let options = ObjectOptions { pose, fixed, user_data: call as u64 };
                let id = scene.add_object(pieces.clone(), &options).unwrap();
                model.objects.push(Object { id, pieces, pose, fixed, user_data: call as u64 });
            }
            3 if count > 0 => {
                let Object { id, .. } = model.objects.remove(any);
                scene.remove_object(id).unwrap();
                model.inactive.retain(|pair| !pair.contains(&id));
            }
            4 if count > 0 && count < MOST_OBJECTS => {
                let original = &model.objects[any];
                let id = scene.copy_object(original.id).unwrap();
                let (pieces, pose) = (original.pieces.clone(), original.pose);
                let (fixed, user_data) = (original.fixed, original.user_data);
                model.objects.push(Object { id, pieces, pose, fixed, user_data });
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
            _ => query(&mut scene, &model, &mut random, &what),
        }
        assert_eq!(scene.object_count(), model.objects.len());
    }
    drop(scene);
    for shape in &shapes {
        model.objects.clear();
        assert_eq!(Arc::strong_count(shape), 1, "an ended scene gives its shares back");
    }
}
