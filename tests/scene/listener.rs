//! Listeners: what begins, persists and ends, pairs and points of contact, each listener for itself.

use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

use swiftprox::math::Pose;
use swiftprox::object::{ObjectId, ObjectOptions};
use swiftprox::scene::{
    ContactDetail, EventState, Listener, ListenerEvents, Query, Replay, Scene, SceneAnswer, SceneQuery,
};
use swiftprox::shape::Shape;
use testkit::random::Random;
use testkit::random_scene::cuboid;
use testkit::shapes::at;

use EventState::{Began, Ended, Persists};

const TOUCHING: SceneQuery = SceneQuery { max_distance: 0.0, ..NEAR };

/// Pairs at most this far apart.
const NEAR: SceneQuery = SceneQuery {
    max_distance: 0.25,
    detail: ContactDetail::Manifold,
    early_exit: false,
    absolute_error: 0.0,
    relative_error: 0.0,
    error_budget: f64::INFINITY,
    step_budget: u32::MAX,
    levels: swiftprox::pair::Levels::Automatic,
    refinement: swiftprox::pair::Refinement::Adaptive,
    start: swiftprox::pair::Start::Automatic,
    piece_pairs: swiftprox::scene::PiecePairs::Every,
};

/// The same, without contacts.
const PLAIN: SceneQuery = SceneQuery { detail: ContactDetail::None, ..NEAR };

fn add(scene: &mut Scene, pieces: &[Arc<Shape>], pose: Pose, user_data: u64) -> ObjectId {
    let options = ObjectOptions { pose, user_data, ..Default::default() };
    scene.add_object(pieces.to_vec(), &options).unwrap()
}

fn scene() -> Scene {
    Scene::new()
}

/// Of each pair its caller's numbers, its state, that of its objects, and how many of its points are in which state.
fn told(events: ListenerEvents) -> Vec<([u64; 2], EventState, EventState, [usize; 3])> {
    let all = events.pairs.iter().map(|pair| {
        let points = events.points_of(pair);
        let count = |state| points.iter().filter(|point| point.state == state).count();
        let counts = [count(Began), count(Persists), count(Ended)];
        ([pair.user_data1, pair.user_data2], pair.state, pair.objects_state, counts)
    });
    all.collect()
}

/// A cube of side 1 comes to rest on a slab of 4 × 4, slides on it, over its edge, and off.
#[test]
fn a_cube_slides_off_a_slab() {
    let (mut scene, mut listener) = (scene(), Listener::default());
    add(&mut scene, &[cuboid([2.0, 2.0, 0.5])], at(0.0, 0.0, -0.5), 10);
    let cube = add(&mut scene, &[cuboid([0.5; 3])], at(0.0, 0.0, 2.0), 11);
    let mut hear = |scene: &mut Scene| told(scene.listen(&mut listener, Query::Contact, &TOUCHING).unwrap().1);
    let pair = [10, 11];
    assert_eq!(hear(&mut scene), []);
    scene.set_pose(cube, &at(0.0, 0.0, 0.5)).unwrap();
    assert_eq!(hear(&mut scene), [(pair, Began, Began, [4, 0, 0])]);
    // The cube's four lower corners stay.
    scene.set_pose(cube, &at(1.0, 0.25, 0.5)).unwrap();
    assert_eq!(hear(&mut scene), [(pair, Persists, Persists, [0, 4, 0])]);
    assert_eq!(hear(&mut scene), [(pair, Persists, Persists, [0, 4, 0])]);
    // Two of them are over the slab's edge: two of its edges cross that in their place.
    scene.set_pose(cube, &at(2.0, 0.25, 0.5)).unwrap();
    assert_eq!(hear(&mut scene), [(pair, Persists, Persists, [2, 2, 2])]);
    scene.set_pose(cube, &at(5.0, 0.25, 0.5)).unwrap();
    assert_eq!(hear(&mut scene), [(pair, Ended, Ended, [0, 0, 4])]);
    assert_eq!(hear(&mut scene), []);
}

#[test]
fn objects_persist_while_any_of_their_pieces_do() {
    let (mut scene, mut listener) = (scene(), Listener::default());
    let cube = cuboid([0.5; 3]);
    let two = add(&mut scene, &[cube.clone(), cube.clone()], at(0.0, 0.0, 0.0), 1);
    scene.set_piece_pose(two, 1, &at(5.0, 0.0, 0.0)).unwrap();
    let other = add(&mut scene, std::slice::from_ref(&cube), at(0.75, 0.0, 0.0), 2);
    let mut hear = |scene: &mut Scene| {
        let (_, events) = scene
            .listen(&mut listener, Query::Intersection, &SceneQuery { detail: ContactDetail::None, ..TOUCHING })
            .unwrap();
        assert!(events.points.is_empty());
        events.pairs.iter().map(|pair| (pair.piece1, pair.state, pair.objects_state)).collect::<Vec<_>>()
    };
    assert_eq!(hear(&mut scene), [(0, Began, Began)]);
    scene.set_pose(other, &at(4.25, 0.0, 0.0)).unwrap();
    assert_eq!(hear(&mut scene), [(0, Ended, Persists), (1, Began, Persists)]);
    scene.set_piece_pose(two, 0, &at(4.0, 0.0, 0.0)).unwrap();
    assert_eq!(hear(&mut scene), [(0, Began, Persists), (1, Persists, Persists)]);
    // What was removed has ended, with the ids and numbers of then.
    scene.remove_object(two).unwrap();
    assert_eq!(hear(&mut scene), [(0, Ended, Ended), (1, Ended, Ended)]);
}

type Keys = BTreeMap<(u64, u64, u32, u32), BTreeSet<u64>>;

/// What is listed, by the callers' numbers, with the ids of its points.
fn listed(answer: &SceneAnswer) -> Keys {
    let of = |(k, pair): (usize, &swiftprox::scene::PairResult)| {
        let contact = answer.contacts.contacts.get(k);
        let ids = contact.map(|contact| answer.contacts.points_of(contact).iter().map(|point| point.id).collect());
        ((pair.user_data1, pair.user_data2, pair.piece1, pair.piece2), ids.unwrap_or_default())
    };
    answer.pairs.iter().enumerate().map(of).collect()
}

/// Holds what was heard against what was listed before and is now, by sets.
fn check(was: &Keys, answer: &SceneAnswer, events: ListenerEvents) {
    let is = listed(answer);
    let none = BTreeSet::new();
    let mut seen = BTreeSet::new();
    for pair in events.pairs {
        let key = (pair.user_data1, pair.user_data2, pair.piece1, pair.piece2);
        assert!(seen.insert(key), "{key:?} twice");
        let expected = match (was.contains_key(&key), is.contains_key(&key)) {
            (false, true) => Began,
            (true, true) => Persists,
            (true, false) => Ended,
            (false, false) => panic!("{key:?} is nowhere"),
        };
        assert_eq!(pair.state, expected);
        let [before, now] = [was, &is].map(|keys| keys.get(&key).unwrap_or(&none));
        let mut points: BTreeMap<u64, EventState> = BTreeMap::new();
        for point in events.points_of(pair) {
            points.insert(point.id, point.state);
            match point.state {
                Ended => assert!(point.point == usize::MAX && before.contains(&point.id) && !now.contains(&point.id)),
                state => {
                    assert_eq!(state == Persists, before.contains(&point.id));
                    assert_eq!(answer.contacts.points[point.point].id, point.id);
                }
            }
        }
        assert!(points.keys().eq(before.union(now)), "{key:?}");
        match pair.state {
            Ended => assert_eq!(pair.result, usize::MAX),
            Began | Persists => {
                let result = &answer.pairs[pair.result];
                assert_eq!((result.object1, result.object2), (pair.object1, pair.object2));
            }
        }
    }
    assert!(seen.iter().eq(was.keys().chain(is.keys()).collect::<BTreeSet<_>>()));
}

/// Two listeners with questions of their own ask at different times, objects move, come and go, other queries are made: each hears
/// the difference of its own two answers, and a recording of it all says the same.
#[test]
fn listeners_hear_what_changed_for_themselves() {
    let mut random = Random::new(0x115e);
    let (mut scene, cube) = (scene(), cuboid([0.5; 3]));
    let file = std::env::temp_dir().join(format!("swiftprox-listener-{}.swiftrec", std::process::id()));
    scene.record(&file).unwrap();
    let mut place = |scale: f64| {
        let [x, y, z] = [(); 3].map(|()| scale * random.uniform(-1.0, 1.0));
        (Pose::new(&random.rotation(), &swiftprox::math::Vector::new(x, y, z)), random.below(6))
    };
    let mut ids: Vec<ObjectId> =
        (0..25).map(|k| add(&mut scene, std::slice::from_ref(&cube), place(2.0).0, k)).collect();
    let mut listeners = [(); 3].map(|()| (Listener::default(), Keys::new()));
    let asked = [(Query::Contact, TOUCHING), (Query::Contact, NEAR), (Query::Distance, PLAIN)];
    let (mut heard, mut next) = (0, 25);
    for _ in 0..150 {
        for _ in 0..3 {
            let at = place(2.0);
            let k = at.1 * 4;
            scene.set_pose(ids[k], &at.0).unwrap();
        }
        match place(1.0).1 {
            0 => {
                scene.remove_object(ids.swap_remove(3)).unwrap();
                ids.push(add(&mut scene, std::slice::from_ref(&cube), place(2.0).0, next));
                next += 1;
            }
            1 => drop(scene.query_events(0.1).unwrap()),
            2 => drop(scene.query_contact(&NEAR).unwrap()),
            who => {
                let (kind, query) = asked[who - 3];
                let (listener, was) = &mut listeners[who - 3];
                let (answer, events) = scene.listen(listener, kind, &query).unwrap();
                check(was, &answer, events);
                heard += events.pairs.iter().filter(|pair| pair.state != Persists).count();
                *was = listed(&answer);
                // One that is refused is forgotten at once.
                assert!(scene.listen(listener, kind, &SceneQuery { early_exit: true, ..query }).is_err());
            }
        }
    }
    assert!(heard > 300, "{heard}");
    scene.end_recording().unwrap();
    for ((listener, was), (kind, query)) in listeners.iter_mut().zip(asked) {
        assert!(scene.listen(listener, kind, &SceneQuery { absolute_error: -1.0, ..query }).is_err());
        let (answer, events) = scene.listen(listener, kind, &query).unwrap();
        check(was, &answer, events);
    }
    let mut replay = Replay::open(&file).unwrap();
    let mut again = Scene::new();
    while let Some(step) = replay.read().unwrap() {
        replay.change(&mut again).unwrap();
        if step.query.is_some() {
            let answer = replay.ask(&mut again, None).unwrap();
            assert!(answer.check.is_ok() && answer.is_identical);
        }
    }
    std::fs::remove_file(&file).unwrap();
}

/// Objects of two scenes with the same places in the order of creation are not taken for one another.
#[test]
fn of_another_scene_all_begins_anew() {
    let mut listener = Listener::default();
    for (mut scene, first) in [(scene(), true), (scene(), false)] {
        for k in 0..2 {
            add(&mut scene, &[cuboid([0.5; 3])], at(0.5 * k as f64, 0.0, 0.0), k);
        }
        let (_, events) = scene
            .listen(&mut listener, Query::Intersection, &SceneQuery { detail: ContactDetail::None, ..TOUCHING })
            .unwrap();
        let mut states: Vec<EventState> = events.pairs.iter().map(|pair| pair.state).collect();
        states.sort_by_key(|state| *state as i32);
        assert_eq!(states, if first { vec![Began] } else { vec![Began, Ended] });
    }
}
