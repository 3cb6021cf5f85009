//! Many objects added and removed at once, and the caller's numbers of pieces.

use std::sync::Arc;

use swiftprox::error::Error;
use swiftprox::math::Pose;
use swiftprox::object::{ObjectId, ObjectOptions};
use swiftprox::pair::Query;
use swiftprox::scene::{EventState, Listener, PairResult, Replay, Scene, SceneQuery};
use swiftprox::shape::Shape;
use testkit::random::Random;
use testkit::random_scene::cuboid;
use testkit::shapes::at;

fn scene() -> Scene {
    Scene::new()
}

/// Boxes of several sizes at places of a cube.
fn bodies(count: usize) -> (Vec<Arc<Shape>>, Vec<ObjectOptions>) {
    let mut random = Random::new(0xb0d1);
    let sizes: Vec<Arc<Shape>> = (1..4).map(|k| cuboid([0.2 * k as f64; 3])).collect();
    let one = |k: usize| {
        let [x, y, z] = [(); 3].map(|()| random.uniform(-3.0, 3.0));
        let pose = Pose::new(&random.rotation(), &swiftprox::math::Vector::new(x, y, z));
        let options = ObjectOptions { pose, user_data: k as u64, fixed: k.is_multiple_of(7), ..Default::default() };
        (sizes[k % 3].clone(), options)
    };
    (0..count).map(one).unzip()
}

/// Results without ids, which differ from scene to scene.
fn told(pairs: &[PairResult]) -> Vec<(u64, u64, String)> {
    pairs.iter().map(|pair| (pair.user_data1, pair.user_data2, format!("{:?}", pair.answer))).collect()
}

/// Whatever is asked, objects added and removed together are those added and removed one by one, bit for bit.
#[test]
fn together_is_as_one_by_one() {
    let (shapes, options) = bodies(200);
    let (mut together, mut single) = (scene(), scene());
    let query = SceneQuery { max_distance: 0.2, ..SceneQuery::default() };
    let mut ids = [together.add_shapes(&shapes, &options).unwrap(), Vec::new()];
    for (shape, options) in shapes.iter().zip(&options) {
        ids[1].push(single.add_object(vec![shape.clone()], options).unwrap());
    }
    for step in 0..3 {
        let said = told(together.query_distance(&query).unwrap().pairs);
        assert_eq!(said, told(single.query_distance(&query).unwrap().pairs));
        assert!(said.len() > 20, "{}", said.len());
        let gone = ids.each_mut().map(|ids| ids.drain(step * 3..step * 3 + 30).collect::<Vec<ObjectId>>());
        together.remove_objects(&gone[0]).unwrap();
        gone[1].iter().for_each(|id| single.remove_object(*id).unwrap());
        let (shapes, options) = (&shapes[step..step + 9], &options[step..step + 9]);
        ids[0].extend(together.add_shapes(shapes, options).unwrap());
        let one = |(shape, options): (&Arc<Shape>, _)| single.add_object(vec![shape.clone()], options).unwrap();
        ids[1].extend(shapes.iter().zip(options).map(one));
    }
}

#[test]
fn all_or_none() {
    let (shapes, mut options) = bodies(20);
    let mut scene = scene();
    let ids = scene.add_shapes(&shapes, &options).unwrap();
    options[13].pose.rows[1][2] = f64::NAN;
    options[17].pose.rows[0][0] = 9.0;
    let refused = scene.add_shapes(&shapes, &options).unwrap_err();
    assert!(matches!(&refused, Error::Pose(message) if message.starts_with("options[13]: ")), "{refused}");
    assert!(matches!(scene.add_shapes(&shapes, &options[..19]), Err(Error::Argument(_))));
    let foreign = Scene::new().add_shapes(&shapes[..1], &options[..1]).unwrap()[0];
    let stale = scene.add_object(vec![shapes[0].clone()], &options[0]).unwrap();
    scene.remove_object(stale).unwrap();
    for (wrong, at) in [(ObjectId::NULL, 4), (foreign, 0), (stale, 19)] {
        let mut list = ids.clone();
        list[at] = wrong;
        let refused = scene.remove_objects(&list).unwrap_err();
        assert!(
            matches!(&refused, Error::Handle(message) if message.starts_with(&format!("ids[{at}]: "))),
            "{refused}"
        );
    }
    let twice = [ids[3], ids[5], ids[7], ids[5], ids[3]];
    let refused = scene.remove_objects(&twice).unwrap_err();
    assert!(matches!(&refused, Error::Argument(message) if message.starts_with("ids[3]: ")), "{refused}");
    assert_eq!(scene.object_count(), 20);
    scene.remove_objects(&[]).unwrap();
    assert!(scene.add_shapes(&[], &[]).unwrap().is_empty());
    scene.remove_objects(&ids).unwrap();
    assert_eq!(scene.object_count(), 0);
}

/// Numbers of pieces are 0 until they are set, go with copies, into events and recordings, and end with their objects.
#[test]
fn pieces_have_numbers() {
    let (mut scene, cube) = (scene(), cuboid([0.5; 3]));
    let first = scene.add_object(vec![cube.clone(); 3], &ObjectOptions::default()).unwrap();
    let numbers = |scene: &Scene, id| [0, 1, 2].map(|piece| scene.object(id).unwrap().piece_user_data(piece));
    assert_eq!(numbers(&scene, first), [0; 3]);
    scene.set_piece_user_data(first, 1, 11).unwrap();
    scene.set_piece_user_data(first, 2, u64::MAX).unwrap();
    let copy = scene.copy_object(first).unwrap();
    scene.set_piece_user_data(first, 1, 0).unwrap();
    assert_eq!((numbers(&scene, first), numbers(&scene, copy)), ([0, 0, u64::MAX], [0, 11, u64::MAX]));
    assert!(matches!(scene.set_piece_user_data(first, 3, 1), Err(Error::Argument(_))));
    assert!(matches!(scene.set_piece_user_data(ObjectId::NULL, 0, 1), Err(Error::Handle(_))));

    let mut listener = Listener::default();
    let (_, events) = scene.listen(&mut listener, Query::Intersection, &SceneQuery::default()).unwrap();
    assert_eq!(events.pairs.len(), 9);
    for pair in events.pairs {
        let expected = [[0, 0, u64::MAX][pair.piece1 as usize], [0, 11, u64::MAX][pair.piece2 as usize]];
        assert_eq!([pair.piece_user_data1, pair.piece_user_data2], expected);
    }

    // What there is when a recording begins, and what is done later.
    let file = std::env::temp_dir().join(format!("swiftprox-numbers-{}.swiftrec", std::process::id()));
    scene.record(&file).unwrap();
    scene.set_piece_user_data(copy, 0, 5).unwrap();
    scene.end_recording().unwrap();
    let mut replay = Replay::open(&file).unwrap();
    let mut again = Scene::new();
    while replay.read().unwrap().is_some() {
        replay.change(&mut again).unwrap();
    }
    std::fs::remove_file(&file).unwrap();
    let ids: Vec<ObjectId> = again.objects().map(|object| object.id()).collect();
    assert_eq!((numbers(&again, ids[0]), numbers(&again, ids[1])), ([0, 0, u64::MAX], [5, 11, u64::MAX]));

    scene.remove_object(first).unwrap();
    let (_, events) = scene.listen(&mut listener, Query::Intersection, &SceneQuery::default()).unwrap();
    let last = events.pairs.last().unwrap();
    assert_eq!((last.state, last.piece_user_data1, last.piece_user_data2), (EventState::Ended, u64::MAX, u64::MAX));
    let new = scene.add_object(vec![cube.clone(); 3], &ObjectOptions { pose: at(9.0, 0.0, 0.0), ..Default::default() });
    assert_eq!(numbers(&scene, new.unwrap()), [0; 3]);
}
