//! Scenes of few pieces, whose spheres and ways follow their poses when somebody asks for them.

use std::sync::Arc;

use swiftprox::math::{Pose, Vector};
use swiftprox::object::{ObjectId, ObjectOptions};
use swiftprox::pair::{self, Outcome, PairAnswer, PairCache, PairConfig, Query};
use swiftprox::scene::{ObjectSet, PairResult, PoseOrder, Scene, SceneQuery, SetScratch};
use swiftprox::shape::{Shape, ShapeOptions};
use swiftprox::verify::verify;
use testkit::random_scene::{Random, random_pose};

use super::scenes::up_to;

/// Hulls, and one with a swept radius.
fn shapes(random: &mut Random) -> Vec<Arc<Shape>> {
    [4, 8, 40, 200]
        .map(|count| {
            let points: Vec<Vector> = (0..count).map(|_| random.direction()).collect();
            let options = ShapeOptions { swept_radius: if count == 8 { 0.25 } else { 0.0 }, ..ShapeOptions::default() };
            Arc::new(Shape::from_points(&points, &options).unwrap())
        })
        .into()
}

/// Objects and where they are.
struct Few {
    scene: Scene,
    ids: Vec<ObjectId>,
    shapes: Vec<Arc<Shape>>,
    poses: Vec<Pose>,
}

impl Few {
    fn new(random: &mut Random, count: usize) -> Few {
        let all = shapes(random);
        let shapes: Vec<Arc<Shape>> = (0..count).map(|k| all[k % all.len()].clone()).collect();
        let poses: Vec<Pose> = (0..count).map(|_| random_pose(random, 2.5)).collect();
        let (scene, ids) = filled(&shapes, &poses);
        Few { scene, ids, shapes, poses }
    }

    fn put(&mut self, k: usize, pose: Pose) {
        self.poses[k] = pose;
        self.scene.set_pose(self.ids[k], &pose).unwrap();
    }

    /// A scene that nobody has asked, with the objects where they are.
    fn anew(&self) -> (Scene, Vec<ObjectId>) {
        filled(&self.shapes, &self.poses)
    }
}

fn filled(shapes: &[Arc<Shape>], poses: &[Pose]) -> (Scene, Vec<ObjectId>) {
    let mut scene = Scene::new();
    let add = |(k, (shape, pose)): (u64, (&Arc<Shape>, &Pose))| {
        let options = ObjectOptions { pose: *pose, user_data: k, ..ObjectOptions::default() };
        scene.add_object(vec![shape.clone()], &options).unwrap()
    };
    let ids = (0..).zip(shapes.iter().zip(poses)).map(add).collect();
    (scene, ids)
}

/// The pairs by their numbers, and their outcomes.
fn outcomes(pairs: &[PairResult]) -> Vec<(u64, u64, Outcome)> {
    pairs.iter().map(|pair| (pair.user_data1, pair.user_data2, pair.answer.outcome)).collect()
}

/// Whatever is asked, and however many have moved since: the same pairs with the same outcomes in the same order as of a scene that
/// is made for the question alone, and each answer stands its test.
#[test]
fn whatever_was_asked_before_is_forgotten() {
    let mut random = Random::new(0xfe3);
    for round in 0..if cfg!(miri) { 1 } else { 12 } {
        let mut few = Few::new(&mut random, 2 + round % 5);
        let count = few.ids.len();
        let mut query = SceneQuery::default();
        for step in 0..120 {
            for _ in 0..random.below(count + 1) {
                let (k, far) = (random.below(count), [0.5, 2.5, 8.0][random.below(3)]);
                few.put(k, random_pose(&mut random, far));
            }
            if step % 10 == 0 {
                query = up_to([f64::INFINITY, 1e300, 1.0, 0.0][random.below(4)]);
                query.early_exit = random.below(4) == 0;
            }
            let kind = [Query::Distance, Query::Distance, Query::Approximate, Query::Intersection][random.below(4)];
            let (mut anew, _) = few.anew();
            let [found, expected] = [&mut few.scene, &mut anew].map(|scene| {
                let answer = match kind {
                    Query::Approximate => scene.query_approximate(&query),
                    Query::Intersection => scene.query_intersection(&query),
                    Query::Distance | Query::Contact => scene.query_distance(&query),
                };
                let answer = answer.unwrap();
                (answer.intersecting, answer.pairs.to_vec(), answer.found.copied())
            });
            let both = [&found, &expected].map(|(intersecting, pairs, stop)| {
                (*intersecting, outcomes(pairs), stop.map(|stop| outcomes(&[stop])))
            });
            assert_eq!(both[0], both[1], "{round}, {step}: {kind:?} {query:?}");
            for pair in found.1.iter().chain(&found.2).filter(|_| kind != Query::Intersection) {
                let bodies =
                    [pair.user_data1, pair.user_data2].map(|k| few.shapes[k as usize].at(&few.poses[k as usize]));
                verify(bodies, &pair.answer).unwrap();
                let (mut cache, mut cold) = (PairCache::default(), PairAnswer::default());
                pair::distance(bodies, &mut cache, &PairConfig::default(), &mut cold).unwrap();
                let overlap = pair.answer.lower <= cold.upper && cold.lower <= pair.answer.upper;
                assert!(overlap, "{round}, {step}: {pair:?} {cold:?}");
                if cold.outcome == Outcome::Separated {
                    assert_eq!((pair.answer.proof, pair.answer.proof_count), ([[0; 2]; 4], 0));
                }
            }
        }
    }
}

/// Every answer in a list is whole, whatever stood there before: as of a fresh one with the same cache.
#[test]
fn an_answer_shows_nothing_of_the_one_before() {
    let mut random = Random::new(0xfe4);
    for round in 0..if cfg!(miri) { 1 } else { 8 } {
        let mut few = Few::new(&mut random, 2);
        let (mut cache, mut last) = (PairCache::default(), few.poses[1]);
        let query = up_to([f64::INFINITY, 0.7][round % 2]);
        let config = PairConfig { max_distance: query.max_distance, ..PairConfig::default() };
        for step in 0..200 {
            let far = [0.3, 1.6, 3.0][random.below(3)];
            if random.below(3) > 0 {
                last = random_pose(&mut random, far);
            }
            last.rows[0][3] += 1e-4;
            few.put(1, last);
            let pairs = few.scene.query_distance(&query).unwrap().pairs.to_vec();
            let bodies = [0, 1].map(|k| few.shapes[k].at(&few.poses[k]));
            // As text, since NaN is not equal to itself.
            let mut answer = PairAnswer::default();
            pair::distance(bodies, &mut cache, &config, &mut answer).unwrap();
            let is_listed = answer.outcome != Outcome::Beyond;
            assert_eq!(pairs.len(), usize::from(is_listed));
            if is_listed && step > 0 {
                assert_eq!(format!("{:?}", pairs[0].answer), format!("{answer:?}"), "{round}, {step}");
            }
        }
    }
}

/// Moved without a question after it, the pieces have the boxes of where they are, and all that is asked of sets knows that.
#[test]
fn questions_of_sets_know_where_pieces_are() {
    let mut random = Random::new(0xfe5);
    let mut few = Few::new(&mut random, 4);
    for step in 0..if cfg!(miri) { 5 } else { 200 } {
        // Boxes without end.
        if step % 7 == 0 {
            few.scene.query_distance(&SceneQuery::default()).unwrap();
        }
        for k in 0..4 {
            if random.below(3) > 0 {
                let far = [0.7, 4.0, 30.0][random.below(3)];
                few.put(k, random_pose(&mut random, far));
            }
        }
        let (anew, ids) = few.anew();
        for (&one, &other) in few.ids.iter().zip(&ids) {
            assert_eq!(few.scene.object(one).unwrap().world_box(), anew.object(other).unwrap().world_box());
        }
        let answers = [(&few.scene, &few.ids), (&anew, &ids)].map(|(scene, ids)| {
            let mut scratch = SetScratch::default();
            let (set, moved) = (ObjectSet { ids: &ids[..1], poses: None, among: false }, [few.poses[0]]);
            let least = scene.least_distance(&set, None, f64::INFINITY, &mut scratch).unwrap();
            let hit = scene.first_hit(&set, &moved, PoseOrder::InOrder, 0.5, &mut scratch).unwrap();
            (least, hit.time)
        });
        let [(one, time), (other, expected)] = answers;
        assert_eq!(time, expected, "{step}");
        assert!(one.lower <= other.upper && other.lower <= one.upper, "{step}: {one:?} {other:?}");
    }
}

/// A piece comes near by moves of which no question knew: the next verdict counts the whole way.
#[test]
fn a_way_that_nobody_asked_about_counts() {
    let cube = testkit::random_scene::cuboid([0.5; 3]);
    let at = |x: f64| testkit::shapes::at(x, 0.0, 0.0);
    let (mut scene, ids) = filled(&[cube.clone(), cube], &[at(0.0), at(1.2)]);
    for _ in 0..3 {
        // Spheres overlap, so that only the way tells.
        assert!(scene.query_distance(&up_to(0.1)).unwrap().pairs.is_empty());
        assert!(!scene.query_intersection(&SceneQuery::default()).unwrap().intersecting);
        for x in [5.0, 3.0, 1.1, 0.9] {
            scene.set_pose(ids[1], &at(x)).unwrap();
        }
        assert!(scene.query_intersection(&SceneQuery::default()).unwrap().intersecting);
        assert_eq!(scene.query_distance(&up_to(0.1)).unwrap().pairs.len(), 1);
        scene.set_pose(ids[1], &at(1.2)).unwrap();
    }
}
