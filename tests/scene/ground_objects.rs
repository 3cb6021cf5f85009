//! Grounds as objects of a scene: every query says of a piece and a ground what the pair functions say, whatever the scene has
//! seen.

use std::io::Cursor;
use std::sync::Arc;

use swiftprox::error::Error;
use swiftprox::ground::{Ground, GroundContacts, HeightGrid, ground_cast, ground_contacts, ground_distance};
use swiftprox::manifold::ManifoldConfig;
use swiftprox::math::{Pose, Vector};
use swiftprox::motion::{self, CastConfig, CastOutcome, Motion, Moving, Screw};
use swiftprox::object::{ObjectId, ObjectOptions};
use swiftprox::pair::{self, Feature, FeatureKind, Outcome, PairAnswer, PairCache, PairConfig, Query};
use swiftprox::ray::{Ray, RayOutcome, cast_ray};
use swiftprox::scene::{
    ContactDetail, EventState, Listener, ObjectSet, PairFilter, PairResult, PoseOrder, RayHits, Replay, Scene,
    SceneGroundContact, SceneQuery, SetScratch, Workers,
};
use swiftprox::shape::Shape;
use testkit::random::{Random, rotation};
use testkit::shapes::{at, cuboid, hull};

use super::record::{Tape, play};

/// Hills on a square of this many cells, about the origin.
fn hills(random: &mut Random, side: usize) -> Arc<Ground> {
    let heights: Vec<f64> = (0..(side + 1).pow(2)).map(|_| random.uniform(-0.3, 0.3)).collect();
    let grid = HeightGrid { rows: side + 1, columns: side + 1, spacing: [1.0; 2], heights: &heights };
    let half = at(-0.5 * side as f64, -0.5 * side as f64, 0.0);
    Arc::new(Ground::from_grounds(&[Ground::from_heights(&grid).unwrap().at(&half)]).unwrap())
}

/// Heights that stay a grid.
fn grid(random: &mut Random) -> Arc<Ground> {
    let heights: Vec<f64> = (0..20).map(|_| random.uniform(-0.3, 0.3)).collect();
    Arc::new(Ground::from_heights(&HeightGrid { rows: 4, columns: 5, spacing: [0.7, 1.1], heights: &heights }).unwrap())
}

fn level(side: usize) -> Arc<Ground> {
    let heights = vec![0.0; (side + 1).pow(2)];
    let grid = HeightGrid { rows: side + 1, columns: side + 1, spacing: [1.0; 2], heights: &heights };
    let half = at(-0.5 * side as f64, -0.5 * side as f64, 0.0);
    Arc::new(Ground::from_grounds(&[Ground::from_heights(&grid).unwrap().at(&half)]).unwrap())
}

/// Triangles anywhere within a cube of half side 3.
fn soup(random: &mut Random) -> Arc<Ground> {
    let vertices: Vec<Vector> = (0..20).map(|_| random.vector() * 3.0).collect();
    let triangles: Vec<[u32; 3]> = (0..15).map(|_| std::array::from_fn(|_| random.below(20) as u32)).collect();
    Arc::new(Ground::from_triangles(&vertices, &triangles).unwrap().with_thickness(0.5).unwrap())
}

enum Body {
    Pieces(Vec<Arc<Shape>>),
    Ground(Arc<Ground>),
}

/// What the test knows of an object.
struct Known {
    id: ObjectId,
    body: Body,
    pose: Pose,
    fixed: bool,
    groups: u32,
    mask: u32,
}

struct World {
    scene: Scene,
    objects: Vec<Known>,
}

fn anywhere(random: &mut Random) -> Pose {
    let place = Vector::new(random.uniform(-6.0, 6.0), random.uniform(-6.0, 6.0), random.uniform(-1.0, 2.0));
    Pose::new(&random.rotation(), &place)
}

impl World {
    fn new() -> World {
        World { scene: Scene::new(), objects: Vec::new() }
    }

    fn add(&mut self, body: Body, options: ObjectOptions) -> ObjectId {
        let id = match &body {
            Body::Pieces(pieces) => self.scene.add_object(pieces.clone(), &options),
            Body::Ground(ground) => self.scene.add_ground(ground.clone(), &options),
        };
        let ObjectOptions { pose, groups, mask, .. } = options;
        let (id, fixed) = (id.unwrap(), options.fixed || matches!(body, Body::Ground(_)));
        self.objects.push(Known { id, body, pose, fixed, groups, mask });
        id
    }

    /// Three grounds among bodies of one piece and two, hulls, a ball and a cylinder.
    fn random(random: &mut Random, count: usize) -> World {
        let cloud: Vec<Vector> = (0..20).map(|_| random.direction() * 0.4).collect();
        let aside: Vec<Vector> = (0..6).map(|_| random.vector() * 0.3 + Vector::x()).collect();
        let ball = Shape::from_sphere(0.3).unwrap();
        let cylinder = Shape::from_cylinder(0.3, 0.3, 1e-3).unwrap();
        let shapes = [cuboid([0.4, 0.3, 0.2]), hull(&cloud), ball, cylinder, hull(&aside)].map(Arc::new);
        let mut world = World::new();
        for number in 0..count {
            let body = match number {
                3 => Body::Ground(hills(random, 12)),
                10 => Body::Ground(soup(random)),
                20 => Body::Ground(hills(random, 4)),
                _ if number % 5 == 0 => Body::Pieces(vec![shapes[0].clone(), shapes[4].clone()]),
                _ => Body::Pieces(vec![shapes[random.below(4)].clone()]),
            };
            let pose = if number == 3 { at(0.1, 0.0, 0.0) } else { anywhere(random) };
            let (groups, mask) = (1 << random.below(3), if random.below(4) == 0 { 5 } else { u32::MAX });
            let options = ObjectOptions { pose, fixed: random.below(8) == 0, user_data: number as u64, groups, mask };
            world.add(body, options);
        }
        world
    }

    fn move_some(&mut self, random: &mut Random, step: usize) {
        for (number, known) in self.objects.iter_mut().enumerate().skip(random.below(step)).step_by(step) {
            known.pose = if number == 3 { at(random.signed(), 0.0, 0.1 * random.signed()) } else { anywhere(random) };
            let moved = self.scene.set_pose(known.id, &known.pose);
            assert!(moved.is_ok() || self.scene.object(known.id).is_err(), "{moved:?}");
        }
    }

    fn may_meet(&self, i: usize, k: usize, moved: bool) -> bool {
        let (one, other) = (&self.objects[i], &self.objects[k]);
        let are_grounds = matches!((&one.body, &other.body), (Body::Ground(_), Body::Ground(_)));
        i != k
            && !are_grounds
            && (moved || !(one.fixed && other.fixed))
            && one.groups & other.mask != 0
            && other.groups & one.mask != 0
            && self.scene.object(one.id).is_ok()
            && self.scene.object(other.id).is_ok()
    }

    /// All answers to a query, by the functions of pairs, for the pairs that are tested, in order.
    fn pairs(&self, query: Query, max_distance: f64) -> Vec<PairResult> {
        let mut found = Vec::new();
        for i in 0..self.objects.len() {
            for k in (i + 1..self.objects.len()).filter(|k| self.may_meet(i, *k, false)) {
                let [one, other] = [&self.objects[i], &self.objects[k]];
                for [piece1, piece2] in pieces(one, other) {
                    let answer = answer(query, [(one, piece1), (other, piece2)], max_distance);
                    let [object1, object2] = [one.id, other.id];
                    let [user_data1, user_data2] = [i as u64, k as u64];
                    let (piece1, piece2) = (piece1 as u32, piece2 as u32);
                    found.push(PairResult { object1, object2, user_data1, user_data2, piece1, piece2, answer });
                }
            }
        }
        found
    }

    /// Those that a query lists.
    fn listed(&self, query: Query, max_distance: f64) -> Vec<PairResult> {
        let mut pairs = self.pairs(query, max_distance);
        pairs.retain(|pair| match pair.answer.outcome {
            Outcome::Intersecting | Outcome::Undecided => true,
            Outcome::Separated => query != Query::Intersection,
            Outcome::Beyond | Outcome::None => false,
        });
        pairs
    }

    fn is_with_ground(&self, pair: &PairResult) -> bool {
        [pair.object1, pair.object2]
            .iter()
            .any(|id| self.scene.object(*id).is_ok_and(|object| object.ground().is_some()))
    }
}

fn count(known: &Known) -> usize {
    if let Body::Pieces(pieces) = &known.body { pieces.len() } else { 1 }
}

fn pieces(one: &Known, other: &Known) -> Vec<[usize; 2]> {
    (0..count(one)).flat_map(|a| (0..count(other)).map(move |b| [a, b])).collect()
}

/// The same seen from the other object.
fn turned(answer: &PairAnswer) -> PairAnswer {
    let mut turned = *answer;
    (turned.local1, turned.local2) = (answer.local2, answer.local1);
    (turned.world1, turned.world2) = (answer.world2, answer.world1);
    (turned.feature1, turned.feature2) = (answer.feature2, answer.feature1);
    turned.normal = answer.normal.map(|x| 0.0 - x);
    turned.proof.iter_mut().for_each(|pair| pair.reverse());
    turned.statistics.levels.reverse();
    turned
}

fn answer(query: Query, objects: [(&Known, usize); 2], max_distance: f64) -> PairAnswer {
    let config = PairConfig { max_distance, ..PairConfig::default() };
    let of_ground = |shape: &Shape, body: &Known, ground: &Ground, other: &Known| {
        let found = ground_distance(query, shape.at(&body.pose), ground.at(&other.pose), &config).unwrap();
        let mut answer = found.answer;
        if (found.triangle as usize) < ground.triangle_count() {
            answer.feature2 = Feature { kind: FeatureKind::Face, ids: [found.triangle, 0] };
        }
        answer
    };
    let [(one, piece1), (other, piece2)] = objects;
    match (&one.body, &other.body) {
        (Body::Pieces(own), Body::Ground(ground)) => of_ground(&own[piece1], one, ground, other),
        (Body::Ground(ground), Body::Pieces(own)) => turned(&of_ground(&own[piece2], other, ground, one)),
        (Body::Pieces(one_of), Body::Pieces(other_of)) => {
            let bodies = [one_of[piece1].at(&one.pose), other_of[piece2].at(&other.pose)];
            let (mut cache, mut answer) = (PairCache::default(), PairAnswer::default());
            let ask = if query == Query::Intersection { pair::intersection } else { pair::distance };
            ask(bodies, &mut cache, &config, &mut answer).unwrap();
            answer
        }
        (Body::Ground(_), Body::Ground(_)) => panic!("no pair"),
    }
}

/// Bits of a result, without NaNs in the way.
fn bits(answer: &PairAnswer) -> String {
    format!("{answer:?}")
}

fn names(pairs: &[PairResult]) -> Vec<(ObjectId, ObjectId, u32, u32, u64, u64, Outcome)> {
    let name = |pair: &PairResult| {
        let &PairResult { object1, object2, piece1, piece2, user_data1, user_data2, answer } = pair;
        (object1, object2, piece1, piece2, user_data1, user_data2, answer.outcome)
    };
    pairs.iter().map(name).collect()
}

/// Compares what is listed; of pairs with grounds every bit.
fn assert_same(world: &World, found: &[PairResult], expected: &[PairResult]) -> usize {
    assert_eq!(names(found), names(expected));
    let with_grounds = || found.iter().zip(expected).filter(|(pair, _)| world.is_with_ground(pair));
    for (found, expected) in with_grounds() {
        assert_eq!(bits(&found.answer), bits(&expected.answer));
    }
    with_grounds().count()
}

/// A few move or many, nothing moves, grounds go: all queries of pairs list what the functions of pairs say.
#[test]
fn queries_list_grounds_as_pairs_say() {
    let mut random = Random::new(0x6e0);
    let (mut seen, mut near) = ([0; 2], 0);
    for size in [30, 5] {
        let mut world = World::random(&mut random, size);
        for round in 0..12 {
            let max_distance = [0.4, f64::INFINITY, 0.0][round % 3];
            let query = SceneQuery { max_distance, ..SceneQuery::default() };
            for seen in &mut seen {
                let listed = world.listed(Query::Intersection, f64::INFINITY);
                let answer = world.scene.query_intersection(&query).unwrap();
                assert_eq!(answer.intersecting, listed.iter().any(|pair| pair.answer.outcome == Outcome::Intersecting));
                let found = answer.pairs.to_vec();
                // Balls inside prove verdicts of convex pairs; grounds have none.
                *seen += assert_same(&world, &found, &listed);
                let listed = world.listed(Query::Distance, max_distance);
                let found = world.scene.query_distance(&query).unwrap().pairs.to_vec();
                near += assert_same(&world, &found, &listed);
                let found = world.scene.query_approximate(&query).unwrap().pairs.to_vec();
                assert_same(&world, &found, &listed);
            }
            let first = world.listed(Query::Intersection, f64::INFINITY);
            let first = first.iter().find(|pair| pair.answer.outcome == Outcome::Intersecting).copied();
            let stops = SceneQuery { early_exit: true, ..query };
            let found = world.scene.query_intersection(&stops).unwrap().found.copied();
            assert_eq!(found.map(|pair| (pair.object1, pair.object2)), first.map(|pair| (pair.object1, pair.object2)));
            world.move_some(&mut random, [1, 7, 40][round % 3]);
            if round == 8 && size > 20 {
                let ground = world.objects[10].id;
                let Body::Ground(shared) = &world.objects[10].body else { panic!("a ground") };
                let shares = Arc::strong_count(shared);
                world.scene.remove_object(ground).unwrap();
                assert_eq!(Arc::strong_count(shared), shares - 1, "a removed ground is let go at once");
                assert!(matches!(world.scene.set_pose(ground, &Pose::IDENTITY), Err(Error::Handle(_))));
            }
        }
    }
    println!("{seen:?} intersecting, {near} within");
    assert!(seen[0] == seen[1] && seen[0] > 60 && near > 200, "{seen:?} {near}");
}

/// Contacts are points of the triangle that is named; details are left to the contacts with grounds. Queries of one object and of
/// placed bodies ask grounds, too.
#[test]
fn contacts_and_single_objects() {
    let mut random = Random::new(0xc0);
    let mut world = World::random(&mut random, 30);
    let mut touching = 0;
    for _ in 0..5 {
        let query = SceneQuery { max_distance: 0.3, ..SceneQuery::default() };
        let listed = world.listed(Query::Distance, 0.3);
        let found = world.scene.query_contact(&query).unwrap().pairs.to_vec();
        assert_eq!(names(&found), names(&listed));
        for pair in
            found.iter().filter(|pair| world.is_with_ground(pair) && pair.answer.outcome == Outcome::Intersecting)
        {
            let PairAnswer { world1, world2, normal, feature1, feature2, .. } = pair.answer;
            assert!(world1.iter().chain(&world2).all(|x| x.is_finite()), "{pair:?}");
            assert!((Vector::from(normal).norm() - 1.0).abs() < 1e-12);
            let is_first = world.scene.object(pair.object1).unwrap().ground().is_some();
            assert_eq!(if is_first { feature1 } else { feature2 }.kind, FeatureKind::Face);
            touching += 1;
        }
        let deep = SceneQuery { detail: ContactDetail::ReducedManifold, ..query };
        let answer = world.scene.query_contact(&deep).unwrap();
        assert_eq!(names(answer.pairs), names(&listed));
        assert_eq!(answer.contacts.contacts.len(), listed.len());
        for (k, pair) in listed.iter().enumerate() {
            let contact = answer.contacts.contacts[k];
            let is_deep = pair.answer.outcome == Outcome::Intersecting;
            let signed = answer.signed_distance(k);
            if [pair.user_data1, pair.user_data2].iter().any(|number| [3, 10, 20].contains(number)) {
                assert_eq!((contact.manifold.point_count, contact.depth.outcome), (0, Outcome::None));
                assert_eq!(signed.is_err(), is_deep, "{signed:?}");
            } else {
                assert!(signed.is_ok() && (!is_deep || contact.depth.outcome != Outcome::None));
            }
        }
        for number in [3, 4] {
            let id = world.objects[number].id;
            let own = |pair: &PairResult| pair.object1 == id || pair.object2 == id;
            let expected: Vec<PairResult> = listed.iter().copied().filter(own).collect();
            let found = world.scene.query_object(id, Query::Distance, &query).unwrap().pairs.to_vec();
            assert_same(&world, &found, &expected);
        }
        let (shape, pose) = (Arc::new(cuboid([0.5; 3])), anywhere(&mut random));
        let placed = world.scene.query_placed(&shape, &pose, Query::Distance, &query).unwrap().pairs.to_vec();
        let own = Known { id: ObjectId::NULL, body: Body::Pieces(vec![shape]), pose, fixed: false, groups: 1, mask: 1 };
        for number in [3, 10, 20] {
            let expected = answer_of(&own, &world.objects[number]);
            let found = placed.iter().find(|pair| pair.user_data1 == number as u64);
            assert_eq!(found.is_some(), expected.outcome != Outcome::Beyond);
            assert!(found.is_none_or(|pair| bits(&pair.answer) == bits(&expected)));
        }
        world.move_some(&mut random, 1);
    }
    assert!(touching > 20, "{touching}");
}

fn answer_of(placed: &Known, ground: &Known) -> PairAnswer {
    answer(Query::Distance, [(ground, 0), (placed, 0)], 0.3)
}

/// Activation, groups, the program's filter and its list of pairs hold for grounds.
#[test]
fn what_filters_leave_out_is_not_asked() {
    let mut world = World::new();
    let ground = world.add(Body::Ground(level(4)), ObjectOptions::default());
    let (shape, low) =
        (Arc::new(cuboid([0.5; 3])), ObjectOptions { pose: at(0.0, 0.0, 0.2), ..ObjectOptions::default() });
    let body = world.add(Body::Pieces(vec![shape.clone()]), low);
    let beside = ObjectOptions { pose: at(-1.5, 0.0, 0.2), ..low };
    let other = world.add(Body::Pieces(vec![shape]), beside);
    let listed = |scene: &mut Scene| -> Vec<ObjectId> {
        let answer = scene.query_intersection(&SceneQuery::default()).unwrap();
        let pairs: Vec<ObjectId> = answer.pairs.iter().map(|pair| pair.object2).collect();
        let mut scratch = SetScratch::default();
        // Questions that change nothing say the same, with trees and without.
        for prepares in [false, true] {
            if prepares {
                scene.prepare().unwrap();
            }
            let found = scene.own_ground_contacts(None, &ManifoldConfig::default(), &mut scratch).unwrap();
            assert!(found.contacts.iter().all(|contact| contact.ground == ground));
            let mut objects: Vec<ObjectId> = found.contacts.iter().map(|contact| contact.object).collect();
            objects.dedup();
            assert_eq!(objects, pairs);
            for id in [body, other] {
                let set = ObjectSet { ids: &[id], ..ObjectSet::default() };
                let least = scene.least_distance(&set, None, f64::INFINITY, &mut scratch).unwrap();
                assert_eq!(least.upper == 0.0, pairs.contains(&id), "{least:?}");
                let poses = [scene.object(id).unwrap().pose()].map(|pose| *pose);
                let hit = scene.first_hit(&set, &poses, PoseOrder::InOrder, 0.0, &mut scratch).unwrap();
                assert_eq!(hit.time == 0, pairs.contains(&id));
            }
        }
        pairs
    };
    let scene = &mut world.scene;
    assert_eq!(listed(scene), [body, other]);
    assert!(scene.is_pair_active(ground, body).unwrap());
    scene.set_pair_active(ground, body, false).unwrap();
    assert_eq!(listed(scene), [other]);
    scene.set_object_active(ground, false).unwrap();
    assert_eq!(listed(scene), []);
    scene.set_object_active(ground, true).unwrap();
    scene.set_filter(ground, 2, 4).unwrap();
    assert_eq!(listed(scene), []);
    scene.set_filter(body, 4, 2).unwrap();
    assert_eq!(listed(scene), [body]);
    scene.set_filter(ground, 1, u32::MAX).unwrap();
    scene.set_filter(body, 1, u32::MAX).unwrap();
    scene.set_pair_filter(Some(PairFilter::new(move |one, two| (one, two) != (ground, other))));
    assert_eq!(listed(scene), [body]);
    scene.set_pair_filter(None);
    scene.set_pairs(Some(&[[other, ground]])).unwrap();
    assert_eq!(listed(scene), [other]);
    scene.set_pairs(None).unwrap();
    scene.set_fixed(other, true).unwrap();
    assert_eq!(scene.query_intersection(&SceneQuery::default()).unwrap().pairs.len(), 1);
}

/// Rays: all hits are those of pairs, in their order; the first is the first of them.
#[test]
fn rays_meet_grounds() {
    let mut random = Random::new(0x4a);
    let mut world = World::random(&mut random, 30);
    let mut scratch = SetScratch::default();
    let (mut grounds, mut firsts) = (0, 0);
    for round in 0..300 {
        if round % 100 == 50 {
            world.scene.prepare().unwrap();
        }
        if round % 100 == 99 {
            world.move_some(&mut random, 3);
        }
        let origin = anywhere(&mut random).translation() + Vector::z() * 3.0;
        let ray = Ray { origin: origin.into(), direction: (random.vector() - Vector::z()).into(), t_max: 10.0 };
        let mut expected = Vec::new();
        for (k, known) in world.objects.iter().enumerate().filter(|(_, known)| known.groups & 3 != 0) {
            for piece in 0..count(known) {
                let answer = match &known.body {
                    Body::Pieces(shapes) => cast_ray(shapes[piece].at(&known.pose), &ray).unwrap(),
                    Body::Ground(ground) => ground.at(&known.pose).cast_ray(&ray).unwrap().answer,
                };
                if answer.outcome != RayOutcome::Miss {
                    expected.push((k, piece as u32, answer));
                }
            }
        }
        expected.sort_by(|a, b| a.2.entry[0].total_cmp(&b.2.entry[0]));
        let name = |known: usize, piece: u32| (world.objects[known].id, piece);
        let all = world.scene.cast_ray(&ray, RayHits::All, 3, &mut scratch).unwrap().to_vec();
        let found: Vec<_> = all.iter().map(|hit| (hit.object, hit.piece)).collect();
        assert_eq!(found, expected.iter().map(|(k, piece, _)| name(*k, *piece)).collect::<Vec<_>>());
        for (hit, (k, _, answer)) in all.iter().zip(&expected) {
            assert!(hit.answer.entry[0] <= answer.entry[1] && answer.entry[0] <= hit.answer.entry[1]);
            if let Body::Ground(ground) = &world.objects[*k].body {
                grounds += 1;
                let triangle = ground.at(&world.objects[*k].pose).cast_ray(&ray).unwrap().triangle;
                assert_eq!(hit.answer.feature, Feature { kind: FeatureKind::Face, ids: [triangle, 0] });
            }
        }
        let first = world.scene.cast_ray(&ray, RayHits::First, 3, &mut scratch).unwrap();
        let certain = expected.iter().all(|(.., answer)| answer.outcome != RayOutcome::Undecided);
        if certain {
            assert_eq!(first.first().map(|hit| (hit.object, hit.piece)), found.first().copied());
            firsts += first.len();
        }
        let any = world.scene.cast_ray(&ray, RayHits::Any, 3, &mut scratch).unwrap();
        assert_eq!(any.len(), all.len().min(1));
    }
    assert!(grounds > 100 && firsts > 100, "{grounds} {firsts}");
}

/// A box whose top is in the ground is met where the ground is: they come in order of creation, by integers.
#[test]
fn a_ray_that_meets_both_at_once_names_the_earlier_created() {
    let thirds = [1.0 / 3.0; 4];
    let grid = HeightGrid { rows: 2, columns: 2, spacing: [1.0; 2], heights: &thirds };
    let ground = Arc::new(Ground::from_heights(&grid).unwrap());
    let corners: Vec<Vector> = (0..8)
        .map(|k| Vector::new(f64::from(k & 1), f64::from(k >> 1 & 1), [0.0, 1.0 / 3.0][k as usize >> 2]))
        .collect();
    let shape = Arc::new(hull(&corners));
    let ray = Ray { origin: [0.4, 0.3, 1.7], direction: [0.1, 0.05, -1.1], t_max: 5.0 };
    for ground_first in [false, true] {
        let mut world = World::new();
        let mut bodies = vec![Body::Pieces(vec![shape.clone()]), Body::Ground(ground.clone())];
        if ground_first {
            bodies.reverse();
        }
        let ids: Vec<ObjectId> = bodies.into_iter().map(|body| world.add(body, ObjectOptions::default())).collect();
        let mut scratch = SetScratch::default();
        let hits = world.scene.cast_ray(&ray, RayHits::All, 1, &mut scratch).unwrap();
        assert_eq!(hits.iter().map(|hit| hit.object).collect::<Vec<_>>(), ids);
        assert_eq!(hits[0].answer.entry, hits[1].answer.entry);
        assert!(hits.iter().all(|hit| hit.answer.exact != 0));
        let first = world.scene.cast_ray(&ray, RayHits::First, 1, &mut scratch).unwrap();
        assert_eq!(first[0].object, ids[0]);
    }
}

/// The least distance of a set is the least of its pairs.
#[test]
fn sets_are_as_far_as_their_nearest_pair() {
    let mut random = Random::new(0x1d);
    let mut world = World::random(&mut random, 30);
    let mut scratch = SetScratch::default();
    let mut nearest = 0;
    for round in 0..60 {
        if round % 2 == 0 {
            world.scene.prepare().unwrap();
        }
        // The set may hold a ground, and with a pose it may be elsewhere.
        let chosen: Vec<usize> = (0..3).map(|k| (random.below(10)) * 3 + k).collect();
        let ids: Vec<ObjectId> = chosen.iter().map(|k| world.objects[*k].id).collect();
        let poses: Vec<Pose> = chosen.iter().map(|_| anywhere(&mut random)).collect();
        let moves = round % 3 == 0;
        let kept: Vec<Pose> = chosen.iter().map(|k| world.objects[*k].pose).collect();
        if moves {
            chosen.iter().zip(&poses).for_each(|(k, pose)| world.objects[*k].pose = *pose);
        }
        let (mut lower, mut upper) = (f64::INFINITY, f64::INFINITY);
        for &i in &chosen {
            for k in (0..world.objects.len()).filter(|k| !chosen.contains(k) && world.may_meet(i, *k, moves)) {
                let [one, other] = [&world.objects[i], &world.objects[k]];
                for [a, b] in pieces(one, other) {
                    let answer = answer(Query::Distance, [(one, a), (other, b)], f64::INFINITY);
                    (lower, upper) = (lower.min(answer.lower), upper.min(answer.upper));
                }
            }
        }
        let set = ObjectSet { ids: &ids, poses: moves.then_some(&poses[..]), among: false };
        let found = world.scene.least_distance(&set, None, f64::INFINITY, &mut scratch).unwrap();
        assert!(found.lower <= upper && lower <= found.upper, "{found:?} {lower} {upper}");
        assert!((found.upper - upper).abs() <= 1e-12 + (upper - lower), "{found:?} {lower} {upper}");
        assert!(ids.contains(&found.nearest.object1) && !ids.contains(&found.nearest.object2));
        nearest += usize::from(world.is_with_ground(&found.nearest));
        if moves {
            let hit = world.scene.first_hit(&set, &poses, PoseOrder::InOrder, 0.1, &mut scratch).unwrap();
            assert_eq!(hit.time == 0, found.upper <= 0.1, "{hit:?} {found:?}");
        }
        chosen.iter().zip(kept).for_each(|(k, pose)| world.objects[*k].pose = pose);
    }
    assert!(nearest > 20, "{nearest}");
}

/// Casts end at the first of all pairs, at grounds, too; pieces of two move with their object.
#[test]
fn casts_end_where_the_first_pair_does() {
    let mut random = Random::new(0xca);
    let mut world = World::random(&mut random, 30);
    let mut scratch = SetScratch::default();
    let (mut hits, mut at_grounds) = (0, 0);
    for round in 0..40 {
        if round % 2 == 0 {
            world.scene.prepare().unwrap();
        }
        let number = [0, 5, 15, 7, 8][round % 5];
        let id = world.objects[number].id;
        let start =
            Pose::new(&random.rotation(), &Vector::new(random.uniform(-5.0, 5.0), random.uniform(-5.0, 5.0), 3.0));
        let (velocity, rotation) = (Vector::new(random.signed(), random.signed(), -4.0), random.vector());
        let motion = Motion::Screw(Screw { start, centre: Vector::zeros(), velocity, rotation });
        let config = CastConfig { max_distance: [0.0, 0.05][round % 2], time_tolerance: 1e-6, ..CastConfig::default() };
        let (mut lower, mut upper) = (1.0_f64, f64::INFINITY);
        let Body::Pieces(shapes) = &world.objects[number].body else { panic!("pieces") };
        for other in (0..world.objects.len()).filter(|k| world.may_meet(number, *k, true)) {
            let rests = Motion::Fixed(world.objects[other].pose);
            for shape in shapes {
                let moving = Moving { shape, motion: &motion };
                let answers = match &world.objects[other].body {
                    Body::Ground(ground) => {
                        vec![ground_cast(moving, ground.at(&world.objects[other].pose), &config).unwrap().answer]
                    }
                    Body::Pieces(shapes) => {
                        let cast = |shape: &Arc<Shape>| {
                            let (mut cache, mut answer) = (PairCache::default(), motion::CastAnswer::default());
                            let resting = Moving { shape, motion: &rests };
                            motion::cast([moving, resting], &mut cache, &config, &mut answer).unwrap();
                            answer
                        };
                        shapes.iter().map(cast).collect()
                    }
                };
                for answer in answers.iter().filter(|answer| answer.outcome != CastOutcome::Free) {
                    lower = lower.min(answer.time_lower);
                    upper = if answer.outcome == CastOutcome::Hit { upper.min(answer.time_upper) } else { upper };
                }
            }
        }
        let set = ObjectSet { ids: &[id], ..ObjectSet::default() };
        let found = world.scene.cast(&set, std::slice::from_ref(&motion), &config, &mut scratch).unwrap();
        assert_eq!(found.outcome == CastOutcome::Free, lower == 1.0, "{found:?} {lower}");
        if found.outcome == CastOutcome::Hit {
            assert!((found.time_upper - upper).abs() < 1e-5, "{found:?} {lower} {upper}");
            assert!(found.time_lower <= upper && lower <= found.time_upper);
            hits += 1;
            if world.is_with_ground(&found.pair) {
                at_grounds += 1;
                assert_eq!((found.pair.piece2, found.pair.answer.feature2.kind), (0, FeatureKind::Face));
            }
        }
    }
    assert!(hits > 15 && at_grounds > 8, "{hits} {at_grounds}");
}

/// Contacts with the scene's own grounds are those of each pair, for all objects and for a set elsewhere.
#[test]
fn contacts_with_own_grounds_are_those_of_pairs() {
    let mut random = Random::new(0xc7);
    let mut world = World::random(&mut random, 60);
    // A cylinder has no contacts with grounds, and says so.
    let (config, mut scratch) = (ManifoldConfig { max_distance: 0.05, reduces: true }, SetScratch::default());
    let refused = world.scene.own_ground_contacts(None, &config, &mut scratch).unwrap_err();
    assert!(matches!(&refused, Error::Argument(message) if message.contains("cylinder")), "{refused:?}");
    let is_curved = |known: &Known| matches!(&known.body, Body::Pieces(own) if own[0].deviation() > 0.0);
    for known in world.objects.iter_mut().filter(|known| is_curved(known)) {
        known.groups = 0;
        world.scene.set_filter(known.id, 0, 0).unwrap();
    }
    let mut met = 0;
    for round in 0..10 {
        let elsewhere: Vec<Pose> = world.objects.iter().map(|_| anywhere(&mut random)).collect();
        for (prepares, poses) in [(false, None), (true, None), (true, Some(&elsewhere[..]))] {
            if prepares {
                world.scene.prepare().unwrap();
            }
            let (mut contacts, mut points) = (Vec::new(), Vec::new());
            let mut found = GroundContacts::default();
            let bodies: Vec<usize> = (0..60).filter(|k| matches!(world.objects[*k].body, Body::Pieces(_))).collect();
            for &k in &bodies {
                let Body::Pieces(shapes) = &world.objects[k].body else { panic!("pieces") };
                let pose = poses.map_or(world.objects[k].pose, |poses| poses[k]);
                for (piece, shape) in (0..).zip(shapes) {
                    for number in [3, 10, 20].into_iter().filter(|n| world.may_meet(k, *n, poses.is_some())) {
                        let Body::Ground(ground) = &world.objects[number].body else { panic!("a ground") };
                        let placed = ground.at(&world.objects[number].pose);
                        ground_contacts(shape.at(&pose), placed, &config, &mut found).unwrap();
                        let first = points.len();
                        points.extend_from_slice(&found.points);
                        contacts.extend(found.contacts.iter().map(|contact| {
                            let mut contact = *contact;
                            contact.first_point += first;
                            let (object, ground) = (world.objects[k].id, world.objects[number].id);
                            SceneGroundContact { object, user_data: k as u64, ground, piece, contact }
                        }));
                    }
                }
            }
            let ids: Vec<ObjectId> = bodies.iter().map(|k| world.objects[*k].id).collect();
            let own: Option<Vec<Pose>> = poses.map(|poses| bodies.iter().map(|k| poses[*k]).collect());
            let set = own.as_ref().map(|own| ObjectSet { ids: &ids, poses: Some(own), among: false });
            for scratch in [&mut scratch, &mut SetScratch::default()] {
                let found = world.scene.own_ground_contacts(set.as_ref(), &config, scratch).unwrap();
                assert_eq!(found.contacts, contacts, "{round}");
                assert_eq!(found.points, points, "{round}");
            }
            met += contacts.len();
        }
        world.move_some(&mut random, 2);
    }
    assert!(met > 150, "{met}");
}

/// Objects and pieces that begin and cease to touch a ground are events, in the scene's order, also where the ground moves.
#[test]
fn events_tell_of_grounds() {
    let mut world = World::new();
    let (shape, above) = (Arc::new(cuboid([0.4; 3])), |x: f64, z: f64| ObjectOptions {
        pose: at(x, 0.0, z),
        ..ObjectOptions::default()
    });
    let early = world.add(Body::Pieces(vec![shape.clone()]), above(-2.0, 2.0));
    let ground = world.add(Body::Ground(level(8)), ObjectOptions::default());
    let late = world.add(Body::Pieces(vec![shape]), above(2.0, 2.0));
    let scene = &mut world.scene;
    let mut listener = Listener::default();
    let mut states = |scene: &mut Scene| {
        let events = scene.query_events(0.0).unwrap();
        let pairs =
            |pairs: &[swiftprox::scene::ObjectPair]| pairs.iter().map(|p| [p.object1, p.object2]).collect::<Vec<_>>();
        let changes = [pairs(events.began), pairs(events.ended)];
        let (_, heard) = scene.listen(&mut listener, Query::Intersection, &SceneQuery::default()).unwrap();
        let heard: Vec<_> = heard.pairs.iter().map(|event| ([event.object1, event.object2], event.state)).collect();
        (changes, heard)
    };
    let (one, two) = ([early, ground], [ground, late]);
    assert_eq!(states(scene), ([vec![], vec![]], vec![]));
    scene.set_pose(early, &at(-2.0, 0.0, 0.3)).unwrap();
    assert_eq!(states(scene), ([vec![one], vec![]], vec![(one, EventState::Began)]));
    scene.set_pose(late, &at(2.0, 0.0, 0.3)).unwrap();
    let both = vec![(one, EventState::Persists), (two, EventState::Began)];
    assert_eq!(states(scene), ([vec![two], vec![]], both));
    scene.set_pose(ground, &at(0.0, 0.0, -5.0)).unwrap();
    let both = vec![(one, EventState::Ended), (two, EventState::Ended)];
    assert_eq!(states(scene), ([vec![], vec![one, two]], both));
    scene.set_pose(ground, &Pose::IDENTITY).unwrap();
    let before = scene.statistics().pairs;
    let both = vec![(one, EventState::Began), (two, EventState::Began)];
    assert_eq!(states(scene), ([vec![one, two], vec![]], both));
    assert!(scene.statistics().pairs >= before + 4, "pairs with grounds are counted");
    scene.remove_object(ground).unwrap();
    let (changes, heard) = states(scene);
    assert_eq!((changes[1].len(), heard.len()), (2, 2));
}

/// Enough bodies over one ground for several threads to share: they say bit for bit the same.
#[test]
fn threads_say_the_same_of_grounds() {
    let answers = |workers: Option<Workers>| {
        let mut random = Random::new(0x72);
        let mut world = World::new();
        world.scene.set_workers(workers);
        world.add(Body::Ground(hills(&mut random, 60)), ObjectOptions::default());
        let shape = Arc::new(cuboid([0.2, 0.15, 0.1]));
        let mut place = || {
            let place =
                Vector::new(random.uniform(-29.0, 29.0), random.uniform(-29.0, 29.0), random.uniform(-0.2, 0.6));
            Pose::new(&rotation(&random.direction(), random.uniform(0.0, 3.0)), &place)
        };
        for _ in 0..3000 {
            let options = ObjectOptions { pose: place(), ..ObjectOptions::default() };
            world.add(Body::Pieces(vec![shape.clone()]), options);
        }
        // Ids tell scenes apart; the numbers of their objects are the same.
        let bits = |pairs: &[PairResult]| -> Vec<String> {
            let of = |id: ObjectId| id.to_bits() & 0xff_ffff;
            pairs.iter().map(|pair| format!("{} {} {:?}", of(pair.object1), of(pair.object2), pair.answer)).collect()
        };
        let mut said = Vec::new();
        for _ in 0..3 {
            let query = SceneQuery { max_distance: 0.1, ..SceneQuery::default() };
            said.push(bits(world.scene.query_intersection(&query).unwrap().pairs));
            said.push(bits(world.scene.query_distance(&query).unwrap().pairs));
            let poses: Vec<Pose> = (0..3000).map(|_| place()).collect();
            world.scene.set_all_poses(&poses).unwrap();
        }
        said
    };
    let one = answers(None);
    assert!(one.iter().all(|pairs| pairs.len() > 500), "{:?}", one.iter().map(Vec::len).collect::<Vec<_>>());
    let two = answers(Some(Workers::threads(2)));
    assert!(one == two, "threads change what is said");
}

/// A recording with grounds, from the beginning and from the middle, gives the same answers; a copy shares its ground.
#[test]
fn recordings_hold_grounds() {
    let mut random = Random::new(0x4ec);
    for begins in [0, 5] {
        let mut world = World::random(&mut random, if begins == 0 { 0 } else { 30 });
        let tape = Tape::default();
        world.scene.record_to(tape.clone()).unwrap();
        if begins == 0 {
            for number in 0..20 {
                let options =
                    ObjectOptions { pose: anywhere(&mut random), user_data: number, ..ObjectOptions::default() };
                let body = match number % 6 {
                    1 => Body::Ground(soup(&mut random)),
                    4 => Body::Ground(grid(&mut random)),
                    _ => Body::Pieces(vec![Arc::new(cuboid([0.4; 3]))]),
                };
                world.add(body, options);
            }
            let Body::Ground(shared) = &world.objects[1].body else { panic!("a ground") };
            let (shares, original) = (Arc::strong_count(shared), world.objects[1].id);
            let copy = world.scene.copy_object(original).unwrap();
            assert_eq!(Arc::strong_count(shared), shares + 1);
            assert!(Arc::ptr_eq(world.scene.object(copy).unwrap().ground().unwrap(), shared));
            world.scene.set_pose(copy, &anywhere(&mut random)).unwrap();
            world.scene.remove_object(original).unwrap();
            world.objects.remove(1);
        }
        let (mut asked, mut listed) = (0, 0);
        for round in 0..10 {
            world.move_some(&mut random, 1 + round % 4);
            let query = SceneQuery { max_distance: 0.5, ..SceneQuery::default() };
            listed += world.scene.query_distance(&query).unwrap().pairs.len();
            world.scene.query_intersection(&query).unwrap();
            world.scene.query_contact(&query).unwrap();
            world.scene.query_events(0.2).unwrap();
            asked += 4;
        }
        world.scene.end_recording().unwrap();
        let played = play(&tape.bytes(), None).unwrap();
        assert_eq!((played.asked, played.cut_off), (asked, false));
        assert!(begins > 0 || played.identical == asked, "{played:?}");
        // The grounds are there again, also how thick they are.
        let mut replay = Replay::from_reader(Cursor::new(tape.bytes())).unwrap();
        let mut again = Scene::new();
        while replay.read().unwrap().is_some() {
            replay.change(&mut again).unwrap();
        }
        let grounds = |scene: &Scene| -> Vec<Arc<Ground>> {
            scene.objects().filter_map(|object| object.ground().cloned()).collect()
        };
        assert!(grounds(&again) == grounds(&world.scene), "a ground is another one");
        assert!(grounds(&again).len() >= 3 && grounds(&again).iter().any(|ground| ground.thickness() == 0.5));
        assert!(listed > 50);
    }
}

/// Rows of objects that are gone are dropped: grounds are found at their new ones.
#[test]
fn grounds_are_found_when_rows_are_dropped() {
    let mut world = World::new();
    let shape = Arc::new(cuboid([0.4; 3]));
    let far = |k: usize| ObjectOptions { pose: at(50.0 + 10.0 * k as f64, 0.0, 0.0), ..ObjectOptions::default() };
    let many: Vec<ObjectId> = (0..200).map(|k| world.add(Body::Pieces(vec![shape.clone()]), far(k))).collect();
    let ground = world.add(Body::Ground(level(4)), ObjectOptions::default());
    let low = ObjectOptions { pose: at(0.0, 0.0, 0.3), ..ObjectOptions::default() };
    let body = world.add(Body::Pieces(vec![shape]), low);
    let mut scratch = SetScratch::default();
    for gone in many.chunks(100) {
        world.scene.remove_objects(gone).unwrap();
        for _ in 0..2 {
            let found = world.scene.query_intersection(&SceneQuery::default()).unwrap();
            let pairs: Vec<_> = found.pairs.iter().map(|pair| (pair.object1, pair.object2)).collect();
            assert_eq!(pairs, [(ground, body)]);
            let contacts = world.scene.own_ground_contacts(None, &ManifoldConfig::default(), &mut scratch).unwrap();
            assert!(contacts.contacts.iter().all(|contact| (contact.object, contact.ground) == (body, ground)));
            assert_eq!(contacts.contacts.len(), 1);
            assert!(world.scene.object(ground).unwrap().ground().is_some());
        }
    }
}

/// However large, small, flat or far away a ground is: its box holds it, and is not much larger.
#[test]
fn the_box_of_a_ground_holds_it() {
    let mut random = Random::new(0x5a);
    let mut seen = [0; 3];
    for round in 0..400 {
        let (size, thin) = (random.power(-90, 90), [1.0, random.power(-50, 0), 0.0][round % 3]);
        let (away, at) = (random.vector() * size * random.power(-4, 8), random.vector() * size);
        let mut vertex = || away + random.vector().component_mul(&Vector::new(size, size, size * thin));
        let vertices: Vec<Vector> = (0..9).map(|_| vertex()).collect();
        let Ok(ground) = Ground::from_triangles(&vertices, &[[0, 1, 2], [3, 4, 5], [6, 7, 8]]) else { continue };
        let pose = Pose::new(&random.rotation(), &at);
        let mut scene = Scene::new();
        let id = scene.add_ground(Arc::new(ground), &ObjectOptions { pose, ..ObjectOptions::default() }).unwrap();
        let [lower, upper] = scene.object(id).unwrap().world_box().map(Vector::from);
        let far = 1e-5 * (size + away.norm() + at.norm());
        for vertex in &vertices {
            let point = pose.transform(vertex);
            assert!(point.inf(&lower) == lower && point.sup(&upper) == upper, "{round}: {point} {lower} {upper}");
        }
        // A turned box is as long as its diagonal.
        assert!((upper - lower).amax() <= 4.0 * size + far, "{round}: {lower} {upper} {size}");
        seen[round % 3] += 1;
    }
    assert!(seen.iter().all(|count| *count > 50), "{seen:?}");
}

/// What a ground cannot do is refused, with the reason and a cure, and nothing has changed.
#[test]
fn what_grounds_cannot_do_is_refused() {
    let mut random = Random::new(0xba);
    let mut world = World::new();
    let ground =
        world.add(Body::Ground(hills(&mut random, 2)), ObjectOptions { user_data: 7, ..ObjectOptions::default() });
    let body = world.add(Body::Pieces(vec![Arc::new(cuboid([0.4; 3]))]), ObjectOptions::default());
    let scene = &mut world.scene;
    let is_refused = |result: Result<(), Error>, words: &str| {
        assert!(matches!(&result, Err(Error::Argument(message)) if message.contains(words)), "{result:?}");
    };
    is_refused(scene.set_piece_pose(ground, 0, &Pose::IDENTITY), "a ground, which has no pieces");
    is_refused(scene.set_piece_user_data(ground, 0, 1), "a ground, which has no pieces");
    is_refused(scene.set_fixed(ground, false), "grounds are fixed");
    scene.set_fixed(ground, true).unwrap();
    let mut scratch = SetScratch::default();
    let set = ObjectSet { ids: &[body, ground], ..ObjectSet::default() };
    let (centre, rotation) = (Vector::zeros(), Vector::zeros());
    let motions = [Motion::Screw(Screw { start: Pose::IDENTITY, centre, velocity: Vector::x(), rotation })];
    let cast = scene.cast(&set, &motions, &CastConfig::default(), &mut scratch).map(drop);
    is_refused(cast, "object 1 of 2 of the set: it is a ground");
    let contacts = scene.own_ground_contacts(Some(&set), &ManifoldConfig::default(), &mut scratch).map(drop);
    is_refused(contacts, "object 1 of 2 of the set: it is a ground");
    let parts = CastConfig { ignores_parting: true, ..CastConfig::default() };
    let alone = ObjectSet { ids: &[body], ..ObjectSet::default() };
    is_refused(scene.cast(&alone, &motions, &parts, &mut scratch).map(drop), "ignores_parting");
    let skewed = Pose::new(&(2.0 * Pose::IDENTITY.rotation()), &Vector::zeros());
    let options = ObjectOptions { pose: skewed, ..ObjectOptions::default() };
    assert!(matches!(scene.add_ground(hills(&mut random, 2), &options), Err(Error::Pose(_))));
    let object = scene.object(ground).unwrap();
    assert!(object.fixed() && object.pieces().is_empty() && object.user_data() == 7);
    assert_eq!((scene.object_count(), scene.objects().filter(|object| object.ground().is_some()).count()), (2, 1));
}
