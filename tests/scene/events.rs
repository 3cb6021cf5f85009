//! Events, all of a small scene by hand: none is lost, none said twice, in whichever way a pair begins or ends being near.

use std::sync::Arc;

use swiftprox::object::{ObjectId, ObjectOptions};
use swiftprox::scene::Scene;
use swiftprox::shape::Shape;
use testkit::random_scene::cuboid;
use testkit::shapes::at;

/// Unit cubes on the x axis.
fn cubes(places: &[f64]) -> (Scene, Vec<ObjectId>) {
    let mut scene = Scene::new();
    let cube: Arc<Shape> = cuboid([0.5; 3]);
    let ids = places.iter().enumerate().map(|(k, &x)| {
        let options = ObjectOptions { pose: at(x, 0.0, 0.0), user_data: k as u64, ..Default::default() };
        scene.add_object(vec![cube.clone()], &options).unwrap()
    });
    let ids = ids.collect();
    (scene, ids)
}

/// Asks for the events and compares them with pairs of user data.
fn expect(scene: &mut Scene, distance: f64, began: &[[u64; 2]], ended: &[[u64; 2]]) {
    let events = scene.query_events(distance).unwrap();
    let [said_began, said_ended] = [events.began, events.ended]
        .map(|pairs| pairs.iter().map(|pair| [pair.user_data1, pair.user_data2]).collect::<Vec<_>>());
    assert_eq!((said_began.as_slice(), said_ended.as_slice()), (began, ended));
}

fn put(scene: &mut Scene, id: ObjectId, x: f64) {
    scene.set_pose(id, &at(x, 0.0, 0.0)).unwrap();
}

/// The first, one in the middle, the last, all and none of the list come and go, in lists of all lengths up to three.
#[test]
fn every_subset_of_pairs_comes_and_goes() {
    // Pair k is of cubes 2k and 2k + 1, far from the others; the second one of each comes and goes.
    let (mut scene, ids) = cubes(&[0.0, 5.0, 10.0, 15.0, 20.0, 25.0]);
    expect(&mut scene, 0.0, &[], &[]);
    let mut was = 0_usize;
    // Each subset of three after each.
    for step in 0..64 {
        let is = (step * 29 + step / 8) % 8;
        for k in 0..3 {
            put(&mut scene, ids[2 * k + 1], 10.0 * k as f64 + if is >> k & 1 == 1 { 0.5 } else { 5.0 });
        }
        let pairs = |set: usize| -> Vec<[u64; 2]> {
            (0..3).filter(|k| set >> k & 1 == 1).map(|k| [2 * k, 2 * k + 1]).collect()
        };
        expect(&mut scene, 0.0, &pairs(is & !was), &pairs(was & !is));
        expect(&mut scene, 0.0, &[], &[]);
        was = is;
    }
}

#[test]
fn other_queries_in_between_lose_no_event() {
    let (mut scene, ids) = cubes(&[0.0, 0.5, 3.0]);
    expect(&mut scene, 0.0, &[[0, 1]], &[]);
    put(&mut scene, ids[2], 1.2);
    scene.query_intersection(&Default::default()).unwrap();
    scene.query_distance(&Default::default()).unwrap();
    scene.query_contact(&Default::default()).unwrap();
    expect(&mut scene, 0.0, &[[1, 2]], &[]);
    // There and back again between two questions is no event.
    put(&mut scene, ids[2], 9.0);
    scene.query_intersection(&Default::default()).unwrap();
    put(&mut scene, ids[2], 1.2);
    expect(&mut scene, 0.0, &[], &[]);
    // A question that is refused changes nothing.
    put(&mut scene, ids[2], 9.0);
    assert!(scene.query_events(-1.0).is_err() && scene.query_events(f64::NAN).is_err());
    expect(&mut scene, 0.0, &[], &[[1, 2]]);
}

#[test]
fn distances_removals_and_activation_are_events() {
    let (mut scene, ids) = cubes(&[0.0, 1.5, 3.5]);
    expect(&mut scene, 0.0, &[], &[]);
    expect(&mut scene, 0.5, &[[0, 1]], &[]);
    expect(&mut scene, 1.0, &[[1, 2]], &[]);
    expect(&mut scene, 0.5, &[], &[[1, 2]]);
    scene.set_pair_active(ids[0], ids[1], false).unwrap();
    expect(&mut scene, 1.0, &[[1, 2]], &[[0, 1]]);
    scene.set_pair_active(ids[0], ids[1], true).unwrap();
    expect(&mut scene, 1.0, &[[0, 1]], &[]);
    scene.remove_object(ids[1]).unwrap();
    expect(&mut scene, 1.0, &[], &[[0, 1], [1, 2]]);
    expect(&mut scene, f64::INFINITY, &[[0, 2]], &[]);
}
