//! Contacts of a scene with depths and manifolds: those of the pair functions, whatever moves, whoever works on them and whatever
//! was asked before; and memory for pairs that intersect alone.

use std::sync::Arc;

use swiftprox::error::Error;
use swiftprox::manifold::manifold;
use swiftprox::manifold::{Manifold, ManifoldCache, ManifoldConfig, ManifoldPoint};
use swiftprox::math::{Pose, Vector};
use swiftprox::object::{ObjectId, ObjectOptions};
use swiftprox::pair::{
    DecidedBy, DepthAnswer, DepthCache, DepthConfig, DepthEnding, Outcome, Placed, Query, SignedDistance, depth,
};
use swiftprox::scene::{Contact, ContactDetail, PairResult, Scene, SceneAnswer, SceneQuery, Workers};
use swiftprox::shape::Shape;
use swiftprox::verify::{verify, verify_depth};
use testkit::random::{Random, rotation};
use testkit::random_scene::{cuboid, ellipsoid};
use testkit::shapes::at;

/// Boxes and hulls, one of pieces.
fn families(random: &mut Random) -> Vec<Vec<Arc<Shape>>> {
    let boxes = [[0.5; 3], [0.9, 0.6, 0.1]].map(cuboid);
    let centre = Vector::new(0.3, 0.0, -0.1);
    let [cube, plate] = boxes;
    let [small, large] = [20, 102].map(|count| ellipsoid(random, count, [0.7, 0.6, 0.4], centre));
    vec![vec![cube.clone()], vec![plate.clone(), large.clone()], vec![small], vec![large], vec![cube]]
}

/// Objects in a cube of half side `size`, every tenth in the place of the one before.
fn crowd(random: &mut Random, count: usize, size: f64) -> (Scene, Vec<ObjectId>) {
    let families = families(random);
    let mut scene = Scene::new();
    let mut last = Pose::IDENTITY;
    let ids = (0..count).map(|k| {
        let turn = if k % 2 == 0 { random.quarter_turns() } else { random.rotation() };
        last = if k % 10 == 9 { last } else { Pose::new(&turn, &(random.vector() * size)) };
        let options = ObjectOptions { pose: last, user_data: k as u64, ..ObjectOptions::default() };
        scene.add_object(families[k % families.len()].clone(), &options).unwrap()
    });
    let ids = ids.collect();
    (scene, ids)
}

fn step(random: &mut Random, scene: &mut Scene, ids: &[ObjectId], length: f64) {
    for id in ids.iter().filter(|_| random.below(8) > 0).collect::<Vec<_>>() {
        let pose = *scene.object(*id).unwrap().pose();
        let turn = rotation(&random.direction(), length);
        let moved = Pose::new(&(turn * pose.rotation()), &(pose.translation() + random.vector() * length));
        scene.set_pose(*id, &moved).unwrap();
    }
}

fn asking(detail: ContactDetail, max_distance: f64) -> SceneQuery {
    SceneQuery { detail, max_distance, ..SceneQuery::default() }
}

/// The pieces of a result, and where they are.
fn pieces(scene: &Scene, result: &PairResult) -> [(Arc<Shape>, Pose); 2] {
    [(result.object1, result.piece1), (result.object2, result.piece2)].map(|(id, piece)| {
        let object = scene.object(id).unwrap();
        (object.pieces()[piece as usize].clone(), object.piece_pose_in_world(piece as usize))
    })
}

fn placed(bodies: &[(Arc<Shape>, Pose); 2]) -> [Placed<'_>; 2] {
    bodies.each_ref().map(|(shape, pose)| shape.at(pose))
}

/// What a query said, apart from the scene.
struct Said {
    pairs: Vec<PairResult>,
    contacts: Vec<Contact>,
    points: Vec<Vec<ManifoldPoint>>,
}

fn copied(answer: SceneAnswer) -> Said {
    let SceneAnswer { pairs, contacts, .. } = answer;
    let points = contacts.contacts.iter().map(|contact| contacts.points_of(contact).to_vec()).collect();
    Said { pairs: pairs.to_vec(), contacts: contacts.contacts.to_vec(), points }
}

fn ids_of(points: &[ManifoldPoint]) -> Vec<u64> {
    let mut ids: Vec<u64> = points.iter().map(|point| point.id).collect();
    ids.sort_unstable();
    ids
}

/// The manifold of the pair function, without a past.
fn own_manifold(bodies: &[(Arc<Shape>, Pose); 2], config: &ManifoldConfig) -> (Manifold, Vec<ManifoldPoint>) {
    let mut points = vec![ManifoldPoint::default(); 500];
    let mut cache = ManifoldCache::default();
    let found = manifold(placed(bodies), &mut cache, config, &mut points).unwrap();
    points.truncate(found.point_count as usize);
    (found, points)
}

/// Each contact is one that the pair functions might say: the check accepts it, and it agrees with theirs without a past. How many
/// pairs intersect, and how many manifolds are the same point by point.
fn check(scene: &Scene, query: &SceneQuery, said: &Said) -> [usize; 2] {
    assert_eq!(said.pairs.len(), said.contacts.len());
    let (mut deep, mut same) = (0, 0);
    for ((result, contact), points) in said.pairs.iter().zip(&said.contacts).zip(&said.points) {
        let bodies = pieces(scene, result);
        verify(placed(&bodies), &result.answer).unwrap();
        let is_deep = result.answer.outcome == Outcome::Intersecting;
        if is_deep {
            deep += 1;
            verify_depth(placed(&bodies), &DepthCache::default(), &contact.depth).unwrap();
            assert_eq!(contact.depth.outcome, Outcome::Intersecting);
            let (mut cache, mut own) = (DepthCache::default(), DepthAnswer::default());
            depth(placed(&bodies), &mut cache, &DepthConfig::default(), &mut own).unwrap();
            assert!(contact.depth.lower <= own.upper && own.lower <= contact.depth.upper, "{contact:?} {own:?}");
        } else {
            assert_eq!(contact.depth.outcome, Outcome::None);
        }
        let reduces = query.detail == ContactDetail::ReducedManifold;
        if query.detail == ContactDetail::Depth {
            assert_eq!((contact.manifold.outcome, points.len()), (Outcome::None, 0));
            continue;
        }
        let config = ManifoldConfig { max_distance: query.max_distance, reduces };
        let (own, own_points) = own_manifold(&bodies, &config);
        let told = &contact.manifold;
        assert_eq!(told.outcome, result.answer.outcome);
        assert_eq!((told.outcome, points.len()), (own.outcome, told.point_count as usize));
        assert!(told.lower <= own.upper && own.lower <= told.upper, "{told:?} {own:?}");
        assert!(!points.is_empty() && (!reduces || points.len() <= 4));
        let normal = Vector::from(told.normal);
        assert!((normal.norm() - 1.0).abs() < 1e-14);
        for point in points {
            let gap = normal.dot(&(Vector::from(point.world1) - Vector::from(point.world2)));
            assert!(point.gap_lower - 1e-12 <= gap && gap <= point.gap_upper + 1e-12, "{point:?}");
            assert!(point.gap_lower <= query.max_distance);
        }
        // Where nothing but the past chooses another least direction, or another reference.
        if (normal - Vector::from(own.normal)).norm() < 1e-12 && told.reference == own.reference {
            same += usize::from(ids_of(points) == ids_of(&own_points));
        }
    }
    [deep, same]
}

#[test]
fn contacts_are_those_of_the_pair_functions() {
    for length in [1e-3, 0.05, 1.0] {
        let mut random = Random::new(0xc0);
        let (mut scene, ids) = crowd(&mut random, 120, 2.2);
        let (mut all, mut alike, mut manifolds, mut before) = (0, 0, 0, 0);
        for round in 0..8 {
            step(&mut random, &mut scene, &ids, length);
            let details = [ContactDetail::Manifold, ContactDetail::Depth, ContactDetail::ReducedManifold];
            let query = asking(details[round % 3], if round % 4 < 2 { 0.0 } else { 0.1 });
            let said = copied(scene.query_contact(&query).unwrap());
            let plain = SceneQuery { detail: ContactDetail::None, ..query };
            let [room, used] = scene.remembered_depths();
            let [deep, same] = check(&scene, &query, &said);
            // Depths of pairs that intersect alone, and room for those of two queries.
            assert_eq!(used, deep, "{length} {round}");
            assert!(room <= deep.max(before) + before.max(deep), "{room} of {before} and {deep}");
            before = before.max(deep);
            all += deep;
            if query.detail != ContactDetail::Depth {
                (alike, manifolds) = (alike + same, manifolds + said.pairs.len());
            }
            // The same pairs in the same order as without.
            let listed = copied(scene.query_contact(&plain).unwrap());
            assert!(listed.contacts.is_empty());
            let key = |result: &PairResult| {
                let PairResult { object1, object2, piece1, piece2, answer, .. } = result;
                (*object1, *object2, *piece1, *piece2, answer.outcome)
            };
            assert_eq!(
                said.pairs.iter().map(key).collect::<Vec<_>>(),
                listed.pairs.iter().map(key).collect::<Vec<_>>()
            );
        }
        println!("{length}: {all} intersect, {alike} of {manifolds} manifolds alike");
        assert!(all > 400, "{all}");
        assert!(alike * 10 > manifolds * 8, "{alike} of {manifolds}");
    }
}

#[test]
fn depths_are_forgotten_when_pairs_come_apart_end_or_are_shrunk() {
    let cube = cuboid([0.5; 3]);
    let mut scene = Scene::new();
    let place = |scene: &mut Scene, x: f64| {
        let options = ObjectOptions { pose: at(x, 0.0, 0.0), ..ObjectOptions::default() };
        scene.add_object(vec![cube.clone()], &options).unwrap()
    };
    let ids: Vec<ObjectId> = (0..20).map(|k| place(&mut scene, 0.75 * f64::from(k))).collect();
    let query = asking(ContactDetail::Depth, 0.0);
    scene.query_contact(&query).unwrap();
    assert_eq!(scene.remembered_depths(), [19, 19]);
    // Queries without a detail neither make nor forget any.
    scene.query_contact(&SceneQuery { detail: ContactDetail::None, ..query }).unwrap();
    assert_eq!(scene.remembered_depths(), [19, 19]);
    // Near, and apart: what is free is used again.
    scene.set_pose(ids[10], &at(7.5, 1.125, 0.0)).unwrap();
    scene.query_contact(&query).unwrap();
    assert_eq!(scene.remembered_depths(), [19, 17]);
    scene.set_pose(ids[10], &at(7.5, 0.0, 0.0)).unwrap();
    scene.query_contact(&query).unwrap();
    assert_eq!(scene.remembered_depths(), [19, 19]);
    // Far away, removed, deactivated.
    scene.set_pose(ids[4], &at(3.0, 50.0, 0.0)).unwrap();
    scene.remove_object(ids[0]).unwrap();
    scene.set_pair_active(ids[18], ids[19], false).unwrap();
    scene.query_contact(&query).unwrap();
    assert_eq!(scene.remembered_depths(), [19, 15]);
    scene.shrink().unwrap();
    assert_eq!(scene.remembered_depths(), [15, 15]);
    assert!(scene.contacts().contacts.is_empty());
    let said = copied(scene.query_contact(&query).unwrap());
    check(&scene, &query, &said);
    assert_eq!(scene.remembered_depths(), [15, 15]);
}

/// What is surely so without a look at the bodies is looked at all the same when its depth is asked.
#[test]
fn balls_that_overlap_have_depths() {
    let mut random = Random::new(3);
    let ball = ellipsoid(&mut random, 200, [1.0; 3], Vector::zeros());
    let mut scene = Scene::new();
    for x in [0.0, 1e-3] {
        let options = ObjectOptions { pose: at(x, 0.0, 0.0), ..ObjectOptions::default() };
        scene.add_object(vec![ball.clone()], &options).unwrap();
    }
    let verdicts = scene.query_intersection(&SceneQuery::default()).unwrap();
    assert_eq!(verdicts.pairs[0].answer.decided_by, DecidedBy::InscribedSpheres);
    let query = asking(ContactDetail::Manifold, 0.0);
    let said = copied(scene.query_contact(&query).unwrap());
    assert_eq!(check(&scene, &query, &said), [1, 1]);
    assert!(said.contacts[0].depth.lower > 1.8);
}

/// Asked again of what has not moved, of one object and of all, the same is said; a query that stops says the contact that it
/// found.
#[test]
fn repeated_queries_and_those_of_objects_agree() {
    let mut random = Random::new(0xc1);
    let (mut scene, ids) = crowd(&mut random, 60, 1.8);
    let query = asking(ContactDetail::Manifold, 0.05);
    let told = |said: &Said| format!("{:?} {:?} {:?}", said.pairs, said.contacts, said.points);
    let first = copied(scene.query_contact(&query).unwrap());
    let again = copied(scene.query_contact(&query).unwrap());
    assert_eq!(told(&first), told(&again));
    assert!(first.pairs.len() > 40);
    let mut seen = 0;
    for id in &ids {
        let own = copied(scene.query_object(*id, Query::Contact, &query).unwrap());
        check(&scene, &query, &own);
        seen += own.pairs.len();
    }
    assert_eq!(seen, 2 * first.pairs.len());
    let pose = Pose::new(&random.rotation(), &(random.vector() * 0.5));
    let placed = scene.query_placed(&cuboid([0.8; 3]), &pose, Query::Contact, &query).unwrap();
    assert!(placed.pairs.len() > 3 && placed.contacts.contacts.len() == placed.pairs.len());
    assert!(placed.contacts.contacts.iter().any(|contact| contact.depth.lower > 0.0));
    for (number, (result, contact)) in placed.pairs.iter().zip(placed.contacts.contacts).enumerate() {
        let SignedDistance { outcome, lower, upper, .. } = placed.signed_distance(number).unwrap();
        let (answer, depth) = (&result.answer, &contact.depth);
        let is_deep = answer.outcome == Outcome::Intersecting;
        let ends = if is_deep { [-depth.upper, -depth.lower] } else { [answer.lower, answer.upper] };
        assert_eq!((outcome, [lower, upper]), (answer.outcome, ends));
    }
    assert!(matches!(placed.signed_distance(placed.pairs.len()), Err(Error::Argument(_))));

    let early = SceneQuery { early_exit: true, ..query };
    let stopped = scene.query_contact(&early).unwrap();
    let found = *stopped.found.unwrap();
    let apart = stopped.signed_distance(0).unwrap();
    assert_eq!((apart.outcome, apart.upper), (Outcome::Intersecting, -stopped.contacts.contacts[0].depth.lower));
    assert!(stopped.pairs.is_empty() && stopped.contacts.contacts.len() == 1);
    let contact = stopped.contacts.contacts[0];
    assert_eq!(stopped.contacts.points_of(&contact).len(), contact.manifold.point_count as usize);
    let said = Said {
        pairs: vec![found],
        contacts: vec![contact],
        points: vec![stopped.contacts.points_of(&contact).to_vec()],
    };
    check(&scene, &query, &said);
}

/// Answers of what rests are given again whatever else is asked in between, and though other bodies come and go. Any query between
/// two of contacts used to end what the first had found; one that was refused had the next read contacts that were not there.
#[test]
fn answers_outlive_queries_of_other_kinds() {
    let mut random = Random::new(0xa5);
    let (mut scene, ids) = crowd(&mut random, 60, 1.8);
    let query = asking(ContactDetail::Manifold, 0.05);
    let told = |said: &Said| format!("{:?} {:?} {:?}", said.pairs, said.contacts, said.points);
    let shape = cuboid([0.3; 3]);
    let far = ObjectOptions { pose: Pose::new(&random.rotation(), &Vector::new(50.0, 0.0, 0.0)), ..Default::default() };
    for id in ids.iter().take(5) {
        let others = scene.add_object(vec![shape.clone()], &far).unwrap();
        assert!(scene.query_contact(&SceneQuery { max_distance: -1.0, ..query }).is_err());
        let first = told(&copied(scene.query_contact(&query).unwrap()));
        scene.query_distance(&SceneQuery { max_distance: f64::NAN, ..query }).unwrap_err();
        scene.query_distance(&query).unwrap_err();
        let plain = SceneQuery { detail: ContactDetail::None, ..query };
        scene.query_intersection(&plain).unwrap();
        scene.query_distance(&plain).unwrap();
        scene.query_approximate(&SceneQuery { error_budget: 1.0, ..plain }).unwrap();
        scene.query_object(*id, Query::Distance, &plain).unwrap();
        scene.query_placed(&shape, &far.pose, Query::Contact, &query).unwrap();
        scene.remove_object(others).unwrap();
        scene.query_events(0.0).unwrap();
        scene.reset_statistics();
        let again = copied(scene.query_contact(&query).unwrap());
        let done = *scene.statistics();
        assert!(done.pairs > 40 && done.unmoved == done.pairs, "{done:?}");
        assert_eq!(told(&again), first);
    }
    // What moves is asked anew, after other queries too.
    for _ in 0..5 {
        step(&mut random, &mut scene, &ids[..3], 0.05);
        scene.query_events(0.0).unwrap();
        let moved = copied(scene.query_contact(&query).unwrap());
        check(&scene, &query, &moved);
        let (mut fresh, _) = crowd(&mut Random::new(0xa5), 60, 1.8);
        for (id, object) in ids.iter().zip(fresh.objects().map(|object| object.id()).collect::<Vec<_>>()) {
            fresh.set_pose(object, scene.object(*id).unwrap().pose()).unwrap();
        }
        let listed = |said: &Said| {
            said.pairs.iter().map(|pair| (pair.piece1, pair.piece2, pair.answer.outcome)).collect::<Vec<_>>()
        };
        assert_eq!(listed(&moved), listed(&copied(fresh.query_contact(&query).unwrap())));
    }
}

/// A scene that has gone through other poses says the same pairs, outcomes and depths as one that has not.
#[test]
fn the_past_changes_no_verdict() {
    let mut random = Random::new(0xc2);
    let (mut old, ids) = crowd(&mut random, 80, 2.0);
    let query = asking(ContactDetail::ReducedManifold, 0.02);
    for _ in 0..5 {
        step(&mut random, &mut old, &ids, 0.02);
        old.query_contact(&query).unwrap();
    }
    let mut new = Scene::new();
    for object in old.objects() {
        let options = ObjectOptions { pose: *object.pose(), user_data: object.user_data(), ..ObjectOptions::default() };
        new.add_object(object.pieces().to_vec(), &options).unwrap();
    }
    let [first, second] = [&mut old, &mut new].map(|scene| copied(scene.query_contact(&query).unwrap()));
    let key = |result: &PairResult| {
        (result.user_data1, result.user_data2, result.piece1, result.piece2, result.answer.outcome)
    };
    assert_eq!(first.pairs.iter().map(key).collect::<Vec<_>>(), second.pairs.iter().map(key).collect::<Vec<_>>());
    for (one, other) in first.contacts.iter().zip(&second.contacts) {
        assert_eq!(one.depth.outcome, other.depth.outcome);
        assert!(!(one.depth.lower > other.depth.upper) && !(other.depth.lower > one.depth.upper));
    }
}

/// Wider intervals, and budgets that go on the next time.
#[test]
fn errors_and_budgets_of_depths_are_kept() {
    let mut random = Random::new(0xc3);
    let shape = ellipsoid(&mut random, 300, [1.0, 0.9, 0.8], Vector::zeros());
    let mut scene = Scene::new();
    for x in [0.0, 1.1, 2.2, 3.3] {
        let pose = Pose::new(&random.rotation(), &Vector::new(x, 0.0, 0.0));
        scene.add_object(vec![shape.clone()], &ObjectOptions { pose, ..ObjectOptions::default() }).unwrap();
    }
    let query = asking(ContactDetail::Depth, 0.0);
    let short = SceneQuery { step_budget: 2, ..query };
    let said = copied(scene.query_contact(&short).unwrap());
    assert!(said.contacts.iter().all(|contact| contact.depth.ending == DepthEnding::Budget), "{:?}", said.contacts);
    check(&scene, &short, &said);
    let next = copied(scene.query_contact(&short).unwrap());
    // Those of the three pairs that are apart stand, no depth.
    assert_eq!((next.pairs.len(), scene.statistics().unmoved), (3, 3));
    check(&scene, &short, &next);
    let wide = SceneQuery { absolute_error: 0.05, ..query };
    let said = copied(scene.query_contact(&wide).unwrap());
    assert_eq!(check(&scene, &wide, &said)[0], 3);
    assert!(said.contacts.iter().all(|contact| contact.depth.upper - contact.depth.lower <= 0.05));
    assert!(said.contacts.iter().any(|contact| contact.depth.upper - contact.depth.lower > 1e-6));
    for (max_distance, is_good) in [(-1.0, false), (f64::NAN, false), (0.0, true), (f64::INFINITY, true)] {
        assert_eq!(scene.query_contact(&SceneQuery { max_distance, ..query }).is_ok(), is_good);
    }
}

/// The distance that lists pairs limits their points: all listed pairs have some, others none.
#[test]
fn manifolds_are_those_of_listed_pairs() {
    let cube = cuboid([0.5; 3]);
    let mut scene = Scene::new();
    for z in [0.0, 1.01, 2.06, 3.06] {
        let options = ObjectOptions { pose: at(0.0, 0.0, z), ..ObjectOptions::default() };
        scene.add_object(vec![cube.clone()], &options).unwrap();
    }
    let query = asking(ContactDetail::Manifold, 0.02);
    let said = copied(scene.query_contact(&query).unwrap());
    let told = said.contacts.iter().map(|contact| (contact.manifold.outcome, contact.manifold.point_count));
    let expected = [(Outcome::Separated, 4), (Outcome::Intersecting, 4)];
    assert_eq!(told.collect::<Vec<_>>(), expected);
}

/// A flight, every bit of what is said.
fn flight(workers: Option<Workers>) -> Vec<String> {
    let mut random = Random::new(0xc4);
    let (mut scene, ids) = crowd(&mut random, 700, 4.0);
    scene.set_workers(workers);
    let mut seen = Vec::new();
    for round in 0..3 {
        step(&mut random, &mut scene, &ids, 0.02);
        let detail = if round == 1 { ContactDetail::Depth } else { ContactDetail::Manifold };
        let query = asking(detail, 0.1);
        // Twice: the second time most answers are given again.
        for _ in 0..2 {
            let said = copied(scene.query_contact(&query).unwrap());
            let of = |pair: &PairResult| format!("{} {} {:?}", pair.user_data1, pair.user_data2, pair.answer);
            let pairs: Vec<String> = said.pairs.iter().map(of).collect();
            seen.push(format!("{pairs:?} {:?} {:?}", said.contacts, said.points));
            seen.push(format!("{:?}", scene.remembered_depths()[1]));
        }
    }
    assert!(scene.statistics().pairs > 6 * 2048, "parts are worth it: {:?}", scene.statistics());
    seen
}

#[test]
fn workers_change_no_bit_of_contacts() {
    let expected = flight(None);
    for count in [2, 5] {
        assert!(flight(Some(Workers::threads(count))) == expected, "{count} threads");
    }
}
