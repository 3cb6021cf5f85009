//! What threads may do at once: const calls on one scene, pair queries on shapes that all share, scenes of their own. Under the
//! thread sanitizer (`make tsan`) a race is an error; `c_tests/threads.c` is the same through C, for helgrind.

use std::sync::{Arc, Barrier};

use swiftprox::object::ObjectOptions;
use swiftprox::pair::{PairAnswer, PairCache, PairConfig, contact};
use swiftprox::scene::{Scene, SceneOptions, SceneQuery};
use swiftprox::shape::{Shape, ShapeOptions};
use swiftprox::verify::verify;
use testkit::models::ellipsoid;
use testkit::shapes::{at, cuboid};

const THREADS: usize = 4;
const ROUNDS: usize = 20;

#[test]
fn threads_share_shapes_and_a_scene() {
    let boxes = [[0.5; 3], [0.5, 1.0, 0.25]].map(cuboid);
    // The first thread that looks into the table of this one makes it.
    let round = Shape::from_mesh(&ellipsoid([0.5, 0.4, 0.3], 200).unwrap(), &ShapeOptions::default()).unwrap();
    let [first, second] = boxes;
    let shapes = [first, second, round].map(Arc::new);
    let mut shared = Scene::new(&SceneOptions::default()).unwrap();
    let ids: Vec<_> = (0..)
        .zip(&shapes)
        .map(|(i, shape)| {
            let options = ObjectOptions { pose: at(3.0 * f64::from(i), 0.0, 0.0), ..ObjectOptions::default() };
            shared.add_object(vec![shape.clone()], &options).unwrap()
        })
        .collect();
    shared.query_exact_distance(&SceneQuery::default()).unwrap();
    let (shared, start) = (&shared, Barrier::new(THREADS));
    let work = || {
        start.wait();
        let mut distances = Vec::new();
        for round in 0..ROUNDS {
            let mut cache = PairCache::default();
            for i in 0..16 {
                let (a, b) = (shapes[i % 3].clone(), &shapes[(i + 1) % 3]);
                let poses = [at(0.0, 0.0, 0.0), at(0.375 * i as f64, 0.25 * i as f64, 0.0)];
                let mut answer = PairAnswer::default();
                contact(&a, &poses[0], b, &poses[1], &mut cache, &PairConfig::default(), &mut answer).unwrap();
                verify(&a, &poses[0], b, &poses[1], &answer).unwrap();
                distances.push(answer.distance);
            }
            for (k, id) in ids.iter().enumerate() {
                assert!(shared.is_pair_active(*id, ids[(k + 1) % 3]).unwrap());
                assert!(Arc::ptr_eq(&shared.object(*id).unwrap().pieces()[0], &shapes[k]));
            }
            assert_eq!(shared.statistics().queries, 1);
            let mut own = Scene::new(&SceneOptions::default()).unwrap();
            for object in shared.objects() {
                let options = ObjectOptions { pose: *object.pose(), ..ObjectOptions::default() };
                own.add_object(object.pieces().to_vec(), &options).unwrap();
            }
            let listed = own.query_exact_distance(&SceneQuery::default()).unwrap();
            assert_eq!(listed.pairs.len(), 3, "round {round}");
            distances.extend(listed.pairs.iter().map(|pair| pair.answer.distance));
        }
        distances
    };
    let all: Vec<Vec<f64>> = std::thread::scope(|scope| {
        let threads = [(); THREADS].map(|()| scope.spawn(work));
        threads.into_iter().map(|thread| thread.join().expect("no panic")).collect()
    });
    assert!(all.iter().all(|distances| *distances == all[0]), "threads disturb each other");
}
