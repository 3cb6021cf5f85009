//! Swept bodies in scenes, files and recordings.

use std::io::Cursor;
use std::sync::{Arc, Mutex};

use crate::{capsule, sphere, swept};
use swiftprox::math::{Pose, Vector};
use swiftprox::object::ObjectOptions;
use swiftprox::pair::{Outcome, PairAnswer, PairCache, PairConfig, distance};
use swiftprox::progress::Progress;
use swiftprox::ray::{Ray, RayAnswer, RayOutcome};
use swiftprox::scene::{ContactDetail, RayHits, Replay, Scene, SceneQuery, SetScratch};
use swiftprox::shape::Shape;
use swiftprox::shape_file::{from_bytes, to_bytes};
use testkit::random::Random;
use testkit::rays::SweptCase;
use testkit::shapes::{at, cuboid, lattice_box};

/// Whatever moves, a scene finds the pairs that all pairs asked one by one are, with their answers: no box and no sphere is too
/// small.
#[test]
fn a_scene_finds_what_all_pairs_are() {
    let mut random = Random::new(0x5ce1);
    let cloud: Vec<Vector> = (0..10).map(|_| random.vector() * 0.2).collect();
    let shapes = [sphere(0.3), capsule(0.4, 0.1), swept(&cloud, 0.15), swept(&cloud, 0.0)].map(Arc::new);
    let mut scene = Scene::new();
    let mut ids = Vec::new();
    for k in 0..120 {
        let pose = Pose::new(&random.rotation(), &(random.vector() * 2.0));
        ids.push(scene.add_object(vec![shapes[k % 4].clone()], &ObjectOptions { pose, ..Default::default() }).unwrap());
    }
    let mut found = [0; 2];
    for round in 0..12 {
        for id in &ids {
            let pose = *scene.object(*id).unwrap().pose();
            let shift = random.vector() * if round % 4 == 3 { 0.3 } else { 0.01 };
            scene.set_pose(*id, &Pose::new(&pose.rotation(), &(pose.translation() + shift))).unwrap();
        }
        let poses: Vec<Pose> = ids.iter().map(|id| *scene.object(*id).unwrap().pose()).collect();
        let tolerance = 0.05;
        let mut expected = Vec::new();
        for a in 0..ids.len() {
            for b in a + 1..ids.len() {
                let mut answer = PairAnswer::default();
                let config = PairConfig { max_distance: tolerance, ..PairConfig::default() };
                let bodies = [shapes[a % 4].at(&poses[a]), shapes[b % 4].at(&poses[b])];
                distance(bodies, &mut PairCache::default(), &config, &mut answer).unwrap();
                if answer.outcome != Outcome::Beyond {
                    expected.push((ids[a], ids[b], answer.outcome, answer.distance));
                }
            }
        }
        let query = SceneQuery { max_distance: tolerance, ..SceneQuery::default() };
        let answer = scene.query_distance(&query).unwrap();
        assert_eq!(answer.pairs.len(), expected.len());
        for (pair, (a, b, outcome, length)) in answer.pairs.iter().zip(&expected) {
            assert_eq!((pair.object1, pair.object2, pair.answer.outcome), (*a, *b, *outcome));
            assert!((pair.answer.distance - length).abs() < 1e-13);
            found[usize::from(*outcome == Outcome::Intersecting)] += 1;
        }
        let meeting: Vec<_> = expected.iter().filter(|pair| pair.2 == Outcome::Intersecting).collect();
        let answer = scene.query_intersection(&SceneQuery::default()).unwrap();
        assert_eq!(answer.pairs.len(), meeting.len());
        assert!(answer.pairs.iter().zip(&meeting).all(|(pair, (a, b, ..))| (pair.object1, pair.object2) == (*a, *b)));
        let contacts = SceneQuery { detail: ContactDetail::Manifold, ..query };
        let answer = scene.query_contact(&contacts).unwrap();
        for (pair, contact) in answer.pairs.iter().zip(answer.contacts.contacts) {
            assert_eq!(pair.answer.outcome, contact.manifold.outcome);
            assert!(contact.manifold.point_count > 0);
        }
    }
    assert!(found.iter().all(|&count| count > 100), "{found:?}");
}

/// One round piece anywhere made `cast_ray` fail for the first hit and for all, however far it was from the ray; for any hit it
/// depended on which object was added first. The cause: rays at swept radii were refused, and a scene that is not prepared casts at
/// all pieces. A ball 100 away beside a cube that the ray meets shows it.
#[test]
fn a_ray_meets_what_is_there_in_any_order() {
    let (cube, ball) = (Arc::new(cuboid([1.0; 3])), Arc::new(sphere(0.5)));
    let ray = Ray { origin: [-5.0, 0.0, 0.0], direction: [1.0, 0.0, 0.0], t_max: f64::INFINITY };
    for (away, met) in [(100.0, 1), (3.0, 2)] {
        for ball_first in [false, true] {
            let mut scene = Scene::new();
            let mut add = |is_ball: bool| {
                let (shape, pose) =
                    if is_ball { (&ball, at(away, away - 3.0, 0.0)) } else { (&cube, at(0.0, 0.0, 0.0)) };
                let options = ObjectOptions { pose, user_data: u64::from(is_ball), ..Default::default() };
                scene.add_object(vec![shape.clone()], &options).unwrap();
            };
            [ball_first, !ball_first].into_iter().for_each(&mut add);
            let mut scratch = SetScratch::default();
            let mut hits = |wanted| {
                let hits = scene.cast_ray(&ray, wanted, u32::MAX, &mut scratch).unwrap();
                hits.iter().map(|hit| hit.user_data).collect::<Vec<_>>()
            };
            assert_eq!(hits(RayHits::First), [0]);
            assert_eq!(hits(RayHits::All), (0..met).collect::<Vec<_>>());
            assert_eq!(hits(RayHits::Any).len(), 1);
        }
    }
}

/// Balls, capsules, boxes with and without round edges on a lattice: each as rationals have it, in the order of their entries,
/// whichever was added first and whether the scene is prepared or not.
#[test]
fn rays_meet_what_rationals_say() {
    let mut random = Random::new(0x5ce2);
    let box_points = lattice_box([1.0; 3], 2);
    let clouds = [vec![Vector::zeros()], vec![-Vector::x(), Vector::x()], box_points.clone(), box_points];
    let radii = [1.0, 0.5, 0.5, 0.0];
    let mut counts = [0; 3];
    for round in 0..6 {
        let poses: Vec<Pose> = (0..8).map(|_| Pose::new(&random.quarter_turns(), &random.lattice(2))).collect();
        let shapes: Vec<Arc<Shape>> = (0..4).map(|kind| Arc::new(swept(&clouds[kind], radii[kind]))).collect();
        let mut scenes = [0, 1].map(|_| Scene::new());
        for (backwards, scene) in scenes.iter_mut().enumerate() {
            for k in 0..8 {
                let k = if backwards == 1 { 7 - k } else { k };
                let options = ObjectOptions { pose: poses[k], user_data: k as u64, ..Default::default() };
                scene.add_object(vec![shapes[k % 4].clone()], &options).unwrap();
            }
        }
        scenes[round % 2].prepare().unwrap();
        for _ in 0..24 {
            let origin = random.lattice(4) * random.pick(&[0.5, 1.0]);
            let ways = [random.vector(), random.lattice(2), Vector::y()];
            let direction = random.pick(&ways);
            let direction = if direction == Vector::zeros() { Vector::x() } else { direction };
            let t_max = random.pick(&[f64::INFINITY, 4.0]);
            let ray = Ray { origin: origin.into(), direction: direction.into(), t_max };
            let mut scratch = SetScratch::default();
            let [all, backwards] = [0, 1].map(|k| {
                let scene = &scenes[k];
                let all = scene.cast_ray(&ray, RayHits::All, u32::MAX, &mut scratch).unwrap().to_vec();
                let first = scene.cast_ray(&ray, RayHits::First, u32::MAX, &mut scratch).unwrap().to_vec();
                assert_eq!(first.first().map(|hit| hit.user_data), all.first().map(|hit| hit.user_data), "{ray:?}");
                let any = scene.cast_ray(&ray, RayHits::Any, u32::MAX, &mut scratch).unwrap();
                assert_eq!(any.len(), all.len().min(1), "{ray:?}");
                assert!(any.iter().all(|any| all.iter().any(|hit| hit.user_data == any.user_data)));
                all
            });
            assert!(all.windows(2).all(|two| two[0].answer.entry[0] <= two[1].answer.entry[1]));
            for (k, pose) in poses.iter().enumerate().filter(|(k, _)| radii[k % 4] > 0.0) {
                let case = SweptCase { points: clouds[k % 4].clone(), radius: radii[k % 4], pose: *pose, ray };
                for hits in [&all, &backwards] {
                    let hit = hits.iter().find(|hit| hit.user_data == k as u64);
                    let missed = RayAnswer { outcome: RayOutcome::Miss, ..RayAnswer::default() };
                    let answer = hit.map_or(missed, |hit| hit.answer);
                    case.check_part(&answer);
                    counts[answer.outcome as usize - 1] += 1;
                }
            }
        }
    }
    assert!(counts.iter().all(|&count| count > 20), "{counts:?}");
}

/// A radius comes back from a file, is scaled with a shape, and files of before radii were are read.
#[test]
fn files_keep_the_radius() {
    let shape = capsule(0.5, 0.375);
    let bytes = to_bytes(&shape).unwrap();
    let again = from_bytes(&bytes).unwrap();
    assert_eq!((again.swept_radius(), again == shape), (0.375, true));
    assert_ne!(shape, capsule(0.5, 0.25));
    let doubled = shape.scaled(2.0, &mut Progress::new(&mut |_| true)).unwrap();
    assert_eq!(doubled.swept_radius(), 0.75);
    assert_eq!(doubled, capsule(1.0, 0.75));
}

/// Whatever an object's pieces are, all their vertices with the ball around them are in its box, which is hardly larger.
#[test]
fn a_box_contains_its_object() {
    let mut random = Random::new(0xb0c5);
    let mut scene = Scene::new();
    for round in 0..60 {
        let radius = [0.0, 0.25][round % 2];
        let clouds = [1, 2, 30].map(|count| (0..count).map(|_| random.vector()).collect::<Vec<_>>());
        let count = 1 + round % 3;
        let pieces = clouds[..count].iter().map(|cloud| Arc::new(swept(cloud, radius))).collect();
        let pose = Pose::new(&random.rotation(), &(random.vector() * 3.0));
        let id = scene.add_object(pieces, &ObjectOptions { pose, ..Default::default() }).unwrap();
        if count > 1 {
            let moved = Pose::new(&random.rotation(), &random.vector());
            scene.set_piece_pose(id, 1, &moved).unwrap();
        }
        let object = scene.object(id).unwrap();
        let [lower, upper] = object.world_box();
        for axis in 0..3 {
            let places = clouds[..count].iter().enumerate().flat_map(|(piece, cloud)| {
                let pose = object.piece_pose_in_world(piece);
                cloud.iter().map(move |point| pose.transform(point)[axis]).collect::<Vec<_>>()
            });
            let (least, most) = places.fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), x| (a.min(x), b.max(x)));
            assert!(lower[axis] <= least - radius && most + radius <= upper[axis]);
            assert!(least - radius - lower[axis] < 1e-4 && upper[axis] - most - radius < 1e-4);
        }
    }
}

/// A sink that stays readable.
#[derive(Clone, Default)]
struct Shared(Arc<Mutex<Vec<u8>>>);

impl std::io::Write for Shared {
    fn write(&mut self, bytes: &[u8]) -> std::io::Result<usize> {
        self.0.lock().unwrap().extend_from_slice(bytes);
        Ok(bytes.len())
    }

    fn flush(&mut self) -> std::io::Result<()> {
        Ok(())
    }
}

#[test]
fn a_recording_is_replayed_with_its_radii() {
    let kept = Shared::default();
    let mut scene = Scene::new();
    scene.record_to(kept.clone()).unwrap();
    let shape: Arc<Shape> = Arc::new(sphere(0.5));
    for k in 0..4 {
        let pose = at(0.75 * f64::from(k), 0.0, 0.0);
        scene.add_object(vec![shape.clone()], &ObjectOptions { pose, ..Default::default() }).unwrap();
    }
    assert_eq!(scene.query_intersection(&SceneQuery::default()).unwrap().pairs.len(), 3);
    scene.end_recording().unwrap();
    drop(scene);
    let bytes = kept.0.lock().unwrap().clone();
    let mut replay = Replay::from_reader(Cursor::new(bytes)).unwrap();
    let mut again = Scene::new();
    let mut asked = 0;
    while let Some(step) = replay.read().unwrap() {
        replay.change(&mut again).unwrap();
        if step.query.is_some() {
            let answer = replay.ask(&mut again, None).unwrap();
            assert_eq!((answer.answer.pairs.len(), answer.is_identical), (3, true));
            answer.check.unwrap();
            asked += 1;
        }
    }
    assert_eq!(asked, 1);
}
