//! A shape that is in no scene, put somewhere for one question.

use swiftprox::object::ObjectOptions;
use swiftprox::pair::Query;
use swiftprox::scene::{Scene, SceneOptions, SceneQuery};
use testkit::random_scene::cuboid;
use testkit::shapes::at;

/// Cubes around it on all sides, some of them just within the tolerance and some just beyond. A box of the shape that is not
/// widened by its half of the tolerance misses the former; it is widened where the scene keeps a list of near pairs.
#[test]
fn all_objects_within_the_tolerance_of_a_placed_shape_are_listed() {
    let mut scene = Scene::new(&SceneOptions::default()).unwrap();
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
    let query = SceneQuery { distance_tolerance: 1.0, ..SceneQuery::default() };
    for k in 0..60 {
        let answer = scene.query_placed(&cube, &at(100.0 * k as f64, 0.0, 0.0), Query::Distance, &query).unwrap();
        let listed: Vec<u64> = answer.pairs.iter().map(|pair| pair.user_data1).collect();
        assert_eq!(listed, if k % 2 == 0 { vec![k] } else { vec![] });
    }
}
