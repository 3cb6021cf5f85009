//! Shapes that are in no scene, put somewhere for one question.

use swiftprox::error::Error;
use swiftprox::math::{Pose, Vector};
use swiftprox::object::ObjectOptions;
use swiftprox::pair::Query;
use swiftprox::scene::{PairResult, Replay, Scene, SceneQuery};
use testkit::random::Random;
use testkit::random_scene::cuboid;
use testkit::shapes::at;

/// Cubes around it on all sides, some of them just within the tolerance and some just beyond. A box of the shape that is not
/// widened by its half of the tolerance misses the former; it is widened where the scene keeps a list of near pairs.
#[test]
fn all_objects_within_the_tolerance_of_a_placed_shape_are_listed() {
    let mut scene = Scene::new();
    let cube = cuboid([0.5; 3]);
    for k in 0..60 {
        let gap = if k % 2 == 0 { 0.999 } else { 1.001 };
        // From another side each, in a row of their own that is far from the others.
        let mut place = [0.0; 3];
        place[k % 3] = (1.0 + gap) * if k % 6 < 3 { 1.0 } else { -1.0 };
        let pose = at(place[0] + 100.0 * k as f64, place[1], place[2]);
        scene
            .add_object(vec![cube.clone()], &ObjectOptions { pose, user_data: k as u64, ..Default::default() })
            .unwrap();
    }
    let query = SceneQuery { max_distance: 1.0, ..SceneQuery::default() };
    for k in 0..60 {
        let answer = scene.query_placed(&cube, &at(100.0 * k as f64, 0.0, 0.0), Query::Distance, &query).unwrap();
        let listed: Vec<u64> = answer.pairs.iter().map(|pair| pair.user_data1).collect();
        assert_eq!(listed, if k % 2 == 0 { vec![k] } else { vec![] });
    }
}

/// A body of several pieces against groups of objects: for each piece what the query of that piece alone says of these, in the
/// order of results, with a list of near pairs and without, and the same again from a recording.
#[test]
fn a_placed_body_of_several_pieces_asks_the_groups_of_its_mask() {
    let mut random = Random::new(0x91ec);
    let mut scene = Scene::new();
    let cube = cuboid([0.5; 3]);
    let mut pose = |scale: f64| {
        let [x, y, z] = [(); 3].map(|()| scale * random.uniform(-1.0, 1.0));
        Pose::new(&random.rotation(), &Vector::new(x, y, z))
    };
    let file = std::env::temp_dir().join(format!("swiftprox-placed-{}.swiftrec", std::process::id()));
    scene.record(&file).unwrap();
    for k in 0..60 {
        let options =
            ObjectOptions { pose: pose(3.0), user_data: k, groups: 1 << (k % 3), mask: 0, ..Default::default() };
        scene.add_object(vec![cube.clone(); 1 + k as usize % 2], &options).unwrap();
    }
    let mut listed = 0;
    for round in 0..24 {
        let pieces = [0.4, 0.8, 1.2].map(|size| (cuboid([size; 3]), pose(2.0)));
        let mask = round % 8;
        let tolerance = if round % 2 == 0 { 0.25 } else { f64::INFINITY };
        scene.set_kept_pair_limit(if round % 4 == 1 { 0 } else { 1 << 20 });
        let query = SceneQuery { max_distance: tolerance, ..SceneQuery::default() };
        let mut expected = Vec::new();
        for (piece, (shape, pose)) in pieces.iter().enumerate() {
            let answer = scene.query_placed(shape, pose, Query::Distance, &query).unwrap();
            let of_mask = answer.pairs.iter().filter(|pair| mask >> (pair.user_data1 % 3) & 1 == 1);
            expected.extend(of_mask.map(|pair| PairResult { piece2: piece as u32, ..*pair }));
        }
        expected.sort_by_key(|pair| (pair.user_data1, pair.piece1, pair.piece2));
        let answer = scene.query_placed_pieces(&pieces, mask as u32, Query::Distance, &query).unwrap();
        assert_eq!(format!("{:?}", answer.pairs), format!("{expected:?}"));
        listed += answer.pairs.len();
    }
    assert!(listed > 500, "{listed}");
    let bad = [(cube.clone(), at(0.0, 0.0, 0.0)), (cube.clone(), at(f64::NAN, 0.0, 0.0))];
    let refused = scene.query_placed_pieces(&bad, 1, Query::Distance, &SceneQuery::default()).unwrap_err();
    assert!(matches!(&refused, Error::Pose(message) if message.starts_with("pose 1 of 2: ")), "{refused}");
    assert!(scene.query_placed_pieces(&[], 1, Query::Distance, &SceneQuery::default()).is_err());
    scene.end_recording().unwrap();
    let mut replay = Replay::open(&file).unwrap();
    let mut again = Scene::new();
    let mut asked = 0;
    while let Some(step) = replay.read().unwrap() {
        replay.change(&mut again).unwrap();
        if step.query.is_some() {
            let answer = replay.ask(&mut again, None).unwrap();
            assert!(answer.check.is_ok() && answer.is_identical);
            asked += 1;
        }
    }
    std::fs::remove_file(&file).unwrap();
    assert_eq!(asked, 24 * 4);
}
