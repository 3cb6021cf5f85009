//! Workers of a scene change no bit of what it answers, and one that fails hides no pair. Under the thread sanitizer (`make tsan`)
//! a race is an error. What a program's own threads may do at once c_tests/process/threads.c tests, for helgrind.

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};

use swiftprox::math::Pose;
use swiftprox::object::ObjectId;
use swiftprox::object::ObjectOptions;
use swiftprox::scene::{PairResult, Scene, SceneAnswer, SceneQuery, Workers};
use swiftprox::shape::{Shape, ShapeOptions};
use testkit::models::ellipsoid;
use testkit::random_scene::{Random, random_pose};
use testkit::shapes::{at, cuboid};

/// A flight of many objects: what each query lists, every bit, and what the queries did. `workers` says who works from a step on.
fn flight(mut workers: impl FnMut(usize, &mut Scene)) -> Vec<String> {
    let mut random = Random::new(0x7f11);
    let shape = Arc::new(Shape::from_mesh(&ellipsoid([0.8, 0.7, 0.5], 60).unwrap(), &ShapeOptions::default()).unwrap());
    let mut scene = Scene::new();
    let mut poses: Vec<Pose> = (0..700).map(|_| random_pose(&mut random, 5.0)).collect();
    let add = |(k, pose): (usize, &Pose)| {
        let options = ObjectOptions { pose: *pose, user_data: k as u64, ..ObjectOptions::default() };
        scene.add_object(vec![shape.clone()], &options).unwrap()
    };
    let ids: Vec<ObjectId> = poses.iter().enumerate().map(add).collect();
    // Ids differ from scene to scene.
    let told = |answer: SceneAnswer| {
        let of = |pair: &PairResult| format!("{} {} {:?}", pair.user_data1, pair.user_data2, pair.answer);
        let pairs: Vec<String> = answer.pairs.iter().map(of).collect();
        format!("{} {pairs:?} {:?}", answer.intersecting, answer.found.map(of))
    };
    let mut seen = Vec::new();
    for step in 0..if cfg!(miri) { 1 } else { 6 } {
        workers(step, &mut scene);
        for (pose, id) in poses.iter_mut().zip(&ids).skip(step % 2 * 300) {
            *pose = Pose::new(&pose.rotation(), &(pose.translation() + random.vector() * 0.05));
            scene.set_pose(*id, pose).unwrap();
        }
        let near = SceneQuery { max_distance: 0.2, ..SceneQuery::default() };
        let early = SceneQuery { early_exit: true, ..near };
        seen.push(told(scene.query_intersection(&near).unwrap()));
        // Twice: the second time most answers are given again.
        seen.push(told(scene.query_distance(&near).unwrap()));
        for (pose, id) in poses.iter_mut().zip(&ids).skip(step).step_by(40) {
            *pose = Pose::new(&pose.rotation(), &(pose.translation() + random.vector() * 0.05));
            scene.set_pose(*id, pose).unwrap();
        }
        seen.push(told(scene.query_distance(&near).unwrap()));
        seen.push(told(scene.query_intersection(&early).unwrap()));
        seen.push(format!("{:?}", scene.statistics()));
    }
    assert!(scene.statistics().pairs > 6 * 2048, "parts are worth it: {:?}", scene.statistics());
    seen
}

/// Backwards, one part twice, one never.
pub fn careless(parts: usize, work: &(dyn Fn(usize) + Sync)) {
    for part in (1..parts).rev().chain([1]) {
        work(part);
    }
}

/// More objects than are moved by one thread, of one piece and of two, some fixed: where they are, every bit, and what is listed.
fn crowd(workers: Option<Workers>) -> Vec<String> {
    const COUNT: usize = 2600;
    let mut random = Random::new(0xc0d);
    let boxes = [[0.3; 3], [0.2, 0.4, 0.3]].map(|half| Arc::new(cuboid(half)));
    let mut scene = Scene::new();
    scene.set_workers(workers);
    let mut ids = Vec::new();
    for k in 0..COUNT {
        let options = ObjectOptions {
            pose: random_pose(&mut random, 6.0),
            fixed: k % 7 == 3,
            user_data: k as u64,
            ..ObjectOptions::default()
        };
        ids.push(scene.add_object(boxes[..1 + usize::from(k % 5 == 0)].to_vec(), &options).unwrap());
    }
    for id in ids.iter().step_by(15) {
        scene.set_piece_pose(*id, 1, &at(0.4, 0.1, 0.0)).unwrap();
    }
    // Rows of those that are gone stay for a while.
    for k in (0..COUNT).step_by(100).rev() {
        scene.remove_object(ids.remove(k)).unwrap();
    }
    let mut seen = Vec::new();
    for step in 0..if cfg!(miri) { 1 } else { 8 } {
        let way = [0.02, 0.02, 0.02, 3.0][step % 4];
        let moved = |pose: &Pose, random: &mut Random| {
            Pose::new(&pose.rotation(), &(pose.translation() + random.vector() * way))
        };
        let mut all: Vec<(ObjectId, Pose)> =
            scene.objects().map(|object| (object.id(), moved(object.pose(), &mut random))).collect();
        match step {
            0 => {
                let movable: Vec<Pose> =
                    scene.objects().filter(|object| !object.fixed()).map(|object| *object.pose()).collect();
                scene.set_all_poses(&movable.iter().map(|pose| moved(pose, &mut random)).collect::<Vec<_>>()).unwrap();
                all.clear();
            }
            1 => all.reverse(),
            2 => all.extend_from_within(..300),
            _ => {}
        }
        let (moving, poses): (Vec<ObjectId>, Vec<Pose>) = all.into_iter().unzip();
        if step == 4 {
            // Of two that are refused the first is named, and nothing has moved.
            let before: Vec<Pose> = scene.objects().map(|object| *object.pose()).collect();
            let mut bad = poses.clone();
            (bad[1700].rows[1][1], bad[2500].rows[0][3]) = (2.0, f64::NAN);
            let message = scene.set_poses(&moving, &bad).unwrap_err().to_string();
            assert!(message.contains(&format!("pose 1700 of {}", moving.len())), "{message}");
            assert!(scene.objects().map(|object| *object.pose()).eq(before));
        }
        scene.set_poses(&moving, &poses).unwrap();
        let of = |pair: &PairResult| format!("{} {} {:?}", pair.user_data1, pair.user_data2, pair.answer);
        let near = SceneQuery { max_distance: 0.1, ..SceneQuery::default() };
        seen.extend(scene.query_distance(&near).unwrap().pairs.iter().map(of));
        seen.push(format!("{:?}", scene.statistics()));
        let places = |piece: usize| scene.objects().filter(move |object| object.pieces().len() > piece);
        seen.extend([0, 1].map(|piece| {
            format!("{:?}", places(piece).map(|object| object.piece_pose_in_world(piece)).collect::<Vec<_>>())
        }));
        seen.extend(scene.objects().map(|object| format!("{:?}", object.pose())));
    }
    seen
}

#[test]
fn workers_move_and_find_what_one_thread_does() {
    let expected = crowd(None);
    let shared = Arc::new(AtomicUsize::new(0));
    let counted = shared.clone();
    let careless = move |parts: usize, work: &(dyn Fn(usize) + Sync)| {
        counted.fetch_add(1, Ordering::Relaxed);
        careless(parts, work);
    };
    for workers in [Workers::threads(2), Workers::threads(5), Workers::new(3, careless)] {
        let seen = crowd(Some(workers));
        assert_eq!(seen.len(), expected.len());
        for (one, other) in seen.iter().zip(&expected) {
            assert_eq!(one, other);
        }
    }
    // Poses are looked at and set, pairs looked at and put together; at times boxes are fitted and the grid is searched, too.
    let shared = shared.load(Ordering::Relaxed);
    assert!(cfg!(miri) || shared > 8 * 4, "{shared}");
}

/// A program's threads fail while they move objects: some have moved, and queries go on from where all are.
#[test]
#[cfg_attr(miri, ignore = "long")]
fn a_panic_while_objects_are_moved_hides_no_pair() {
    const COUNT: usize = 2300;
    let shape = Arc::new(cuboid([0.5; 3]));
    let scene_of = |poses: &[Pose]| {
        let mut scene = Scene::new();
        for (k, pose) in poses.iter().enumerate() {
            let options = ObjectOptions { pose: *pose, user_data: k as u64, ..ObjectOptions::default() };
            scene.add_object(vec![shape.clone()], &options).unwrap();
        }
        scene
    };
    let listed = |scene: &mut Scene| {
        let near = SceneQuery { max_distance: 0.1, ..SceneQuery::default() };
        let of = |pair: &PairResult| (pair.user_data1, pair.user_data2, pair.answer.outcome);
        scene.query_distance(&near).unwrap().pairs.iter().map(of).collect::<Vec<_>>()
    };
    let mut random = Random::new(0xfa11);
    let poses: Vec<Pose> = (0..COUNT).map(|_| random_pose(&mut random, 12.0)).collect();
    let mut scene = scene_of(&poses);
    let before = listed(&mut scene);
    let calls = AtomicUsize::new(0);
    scene.set_workers(Some(Workers::new(2, move |parts, work| {
        // The poses are looked at first.
        let moves = calls.fetch_add(1, Ordering::Relaxed) == 1;
        (0..parts).filter(|part| !moves || part % 2 == 0).for_each(work);
        assert!(!moves, "the threads fail");
    })));
    let moved: Vec<Pose> = (0..COUNT).map(|_| random_pose(&mut random, 12.0)).collect();
    assert!(catch_unwind(AssertUnwindSafe(|| scene.set_all_poses(&moved))).is_err());
    let at: Vec<Pose> = scene.objects().map(|object| *object.pose()).collect();
    let count = at.iter().zip(&moved).filter(|(at, moved)| at == moved).count();
    assert!((COUNT / 3..COUNT * 2 / 3).contains(&count), "{count} have moved");
    let now = listed(&mut scene);
    assert_eq!(now, listed(&mut scene_of(&at)));
    assert_ne!(now, before);
}

#[test]
fn workers_change_no_bit() {
    let expected = flight(|_, _| {});
    for workers in [Workers::threads(2), Workers::threads(5), Workers::new(3, careless)] {
        let mut workers = Some(workers);
        let from_the_first_step_on = |_, scene: &mut Scene| {
            if let Some(workers) = workers.take() {
                scene.set_workers(Some(workers));
            }
        };
        assert_eq!(flight(from_the_first_step_on), expected);
    }
    // Others in each step, and none; more than there are parts.
    let others = |step: usize, scene: &mut Scene| {
        let count = [2, 0, 9, 1, usize::MAX, 3][step];
        scene.set_workers((count > 0).then(|| Workers::threads(count)));
    };
    assert_eq!(flight(others), expected);
}
