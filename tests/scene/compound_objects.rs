//! Compounds as objects of a scene, beside a scene whose rows are their pieces: both say the same of every two objects.

use std::collections::BTreeMap;
use std::sync::Arc;

use swiftprox::compound::{Compound, Piece};
use swiftprox::error::Error;
use swiftprox::ground::{Ground, HeightGrid};
use swiftprox::manifold::ManifoldConfig;
use swiftprox::math::{Matrix, Pose, Vector};
use swiftprox::motion::{CastConfig, CastOutcome, Motion, Screw};
use swiftprox::object::{ObjectId, ObjectOptions};
use swiftprox::pair::{Outcome, Query};
use swiftprox::ray::{Ray, RayOutcome};
use swiftprox::scene::{
    ContactDetail, EventState, Listener, ObjectSet, PairFilter, PairResult, PoseOrder, RayHits, Replay, Scene,
    SceneQuery, SetScratch, Workers,
};
use swiftprox::shape::Shape;
use testkit::random::{Random, rotation};
use testkit::shapes::{at, cuboid, hull};

use super::record::{Tape, play};

/// A ring of boxes, each where the ring has it.
pub fn ring(count: usize) -> Vec<Piece> {
    let shape = Arc::new(cuboid([0.15, 0.3, 0.1]));
    let pose = |k: usize| {
        let turn = rotation(&Vector::z(), std::f64::consts::TAU * k as f64 / count as f64);
        Pose::new(&turn, &(turn * Vector::x()))
    };
    (0..count).map(|k| Piece { shape: shape.clone(), pose: pose(k) }).collect()
}

/// Hulls in one frame, some of them round.
pub fn heap(random: &mut Random, count: usize) -> Vec<Piece> {
    let piece = |k: usize| {
        let middle = random.vector() * 0.8;
        let cloud: Vec<Vector> = (0..8).map(|_| random.direction() * 0.4 + middle).collect();
        let shape = if k.is_multiple_of(4) { Shape::from_sphere(0.5).unwrap() } else { hull(&cloud) };
        Piece { shape: Arc::new(shape), pose: Pose::IDENTITY }
    };
    (0..count).map(piece).collect()
}

pub fn hills(random: &mut Random) -> Arc<Ground> {
    let heights: Vec<f64> = (0..81).map(|_| random.uniform(-0.3, 0.3)).collect();
    let grid = HeightGrid { rows: 9, columns: 9, spacing: [1.0; 2], heights: &heights };
    Arc::new(Ground::from_grounds(&[Ground::from_heights(&grid).unwrap().at(&at(-4.0, -4.0, -1.0))]).unwrap())
}

/// The same objects in two scenes: with compounds, and with their pieces. The number of each is its user data.
struct Twins {
    whole: Scene,
    parts: Scene,
    ids: Vec<[ObjectId; 2]>,
}

pub fn anywhere(random: &mut Random) -> Pose {
    Pose::new(&random.rotation(), &(random.vector() * 3.0))
}

impl Twins {
    fn new() -> Twins {
        Twins { whole: Scene::new(), parts: Scene::new(), ids: Vec::new() }
    }

    fn options(&self, pose: Pose) -> ObjectOptions {
        ObjectOptions { pose, user_data: self.ids.len() as u64, ..ObjectOptions::default() }
    }

    fn add_compound(&mut self, compound: &Arc<Compound>, options: &ObjectOptions) {
        let shapes = compound.pieces().iter().map(|piece| piece.shape.clone()).collect();
        let id = self.parts.add_object(shapes, options).unwrap();
        for (k, piece) in (0..).zip(compound.pieces()).filter(|(_, piece)| piece.pose != Pose::IDENTITY) {
            self.parts.set_piece_pose(id, k, &piece.pose).unwrap();
        }
        self.ids.push([self.whole.add_compound(compound.clone(), options).unwrap(), id]);
    }

    fn add_pieces(&mut self, shapes: &[Arc<Shape>], options: &ObjectOptions) {
        self.ids.push([&mut self.whole, &mut self.parts].map(|s| s.add_object(shapes.to_vec(), options).unwrap()));
    }

    fn add_ground(&mut self, ground: &Arc<Ground>, options: &ObjectOptions) {
        self.ids.push([&mut self.whole, &mut self.parts].map(|s| s.add_ground(ground.clone(), options).unwrap()));
    }

    /// Compounds of two kinds, bodies of one and two pieces, a ball, a cylinder and a ground.
    fn random(random: &mut Random, count: usize) -> Twins {
        let mut twins = Twins::new();
        let compounds = [ring(12), heap(random, 6)].map(|pieces| Arc::new(Compound::new(&pieces).unwrap()));
        let aside: Vec<Vector> = (0..6).map(|_| random.vector() * 0.3 + Vector::x()).collect();
        let cylinder = Shape::from_cylinder(0.3, 0.3, 1e-3).unwrap();
        let shapes = [cuboid([0.4, 0.3, 0.2]), Shape::from_sphere(0.3).unwrap(), cylinder, hull(&aside)].map(Arc::new);
        for k in 0..count {
            let options = ObjectOptions { fixed: random.below(6) == 0, ..twins.options(anywhere(random)) };
            match k % 8 {
                0 | 3 | 5 => twins.add_compound(&compounds[random.below(2)], &options),
                1 => twins.add_pieces(&[shapes[0].clone(), shapes[3].clone()], &options),
                4 if k == 4 => twins.add_ground(&hills(random), &options),
                _ => twins.add_pieces(&[shapes[random.below(4)].clone()], &options),
            }
        }
        twins
    }

    fn both(&mut self, change: impl Fn(&mut Scene, &dyn Fn(usize) -> ObjectId)) {
        let ids = &self.ids;
        change(&mut self.whole, &|k| ids[k][0]);
        change(&mut self.parts, &|k| ids[k][1]);
    }

    fn move_some(&mut self, random: &mut Random, step: usize) {
        for k in (random.below(step)..self.ids.len()).step_by(step) {
            let pose = anywhere(random);
            self.both(|scene, id| _ = scene.set_pose(id(k), &pose));
        }
    }

    fn shapes(&self, pair: [u64; 2]) -> [bool; 2] {
        let is_whole = |k: u64| {
            let object = self.whole.object(self.ids[k as usize][0]).unwrap();
            object.ground().is_some() || object.compound().is_some()
        };
        pair.map(is_whole)
    }
}

/// Of every two objects the outcome and the interval of all their results together.
fn by_objects(pairs: &[PairResult]) -> BTreeMap<[u64; 2], (Outcome, [f64; 2])> {
    let mut all: BTreeMap<[u64; 2], (Outcome, [f64; 2])> = BTreeMap::new();
    let rank = |outcome| match outcome {
        Outcome::Intersecting => 0,
        Outcome::Undecided => 1,
        _ => 2,
    };
    for PairResult { user_data1, user_data2, answer, .. } in pairs {
        let known = all.entry([*user_data1, *user_data2]).or_insert((answer.outcome, [f64::INFINITY; 2]));
        if rank(answer.outcome) < rank(known.0) {
            known.0 = answer.outcome;
        }
        known.1 = [known.1[0].min(answer.lower), known.1[1].min(answer.upper)];
    }
    all
}

/// Both scenes list the same pairs of objects with the same outcomes, and intervals that have something in common.
fn assert_same(twins: &Twins, whole: &[PairResult], parts: &[PairResult], of: &str) {
    let (of_whole, of_parts) = (by_objects(whole), by_objects(parts));
    let outcomes = |all: &BTreeMap<[u64; 2], (Outcome, [f64; 2])>| -> Vec<([u64; 2], Outcome)> {
        all.iter().map(|(pair, (outcome, _))| (*pair, *outcome)).collect()
    };
    assert_eq!(outcomes(&of_whole), outcomes(&of_parts), "{of}");
    for (pair, (outcome, [lower, upper])) in &of_whole {
        let [least, most] = of_parts[pair].1;
        assert!(*outcome == Outcome::Intersecting || (lower <= &most && &least <= upper), "{of} {pair:?}");
    }
    // Of every two objects one result, where one of them is a compound or a ground and the other is too or has one piece.
    for pair in whole.windows(2).map(|two| [0, 1].map(|k| [two[k].user_data1, two[k].user_data2])) {
        assert!(pair[0] != pair[1] || twins.shapes(pair[0]) != [true; 2], "{of} {pair:?}");
    }
}

fn up_to(max_distance: f64) -> SceneQuery {
    SceneQuery { max_distance, ..SceneQuery::default() }
}

/// Verdicts and distances, while objects move, come, go, and are filtered.
#[test]
fn answers_are_those_of_all_pairs_of_pieces() {
    let mut random = Random::new(0xc0b1);
    let (mut listed, mut hits) = (0, 0);
    for round in 0..if cfg!(miri) { 1 } else { 6 } {
        let mut twins = Twins::random(&mut random, 20);
        for step in 0..12 {
            twins.move_some(&mut random, 1 + step % 3);
            let k = random.below(20);
            match step {
                3 => twins.both(|scene, id| _ = scene.remove_object(id(k))),
                4 => twins.both(|scene, id| _ = scene.set_filter(id(k), 2, 5)),
                5 => twins.both(|scene, id| _ = scene.set_object_active(id(k), false)),
                6 => twins.both(|scene, _| {
                    scene.set_pair_filter(Some(PairFilter::new(|a, b| (a.to_bits() ^ b.to_bits()) & 7 != 1)));
                }),
                7 => twins.both(|scene, _| scene.set_pair_filter(None)),
                8 => twins.both(|scene, id| _ = scene.set_fixed(id(k), true)),
                9 => twins.both(|scene, _| scene.shrink().unwrap()),
                _ => {}
            }
            if step == 6 {
                continue;
            }
            for query in [Query::Intersection, Query::Distance, Query::Contact, Query::Approximate] {
                for distance in [0.0, 0.4, f64::INFINITY] {
                    let ask = |scene: &mut Scene| {
                        let query_of = up_to(distance);
                        let answer = match query {
                            Query::Intersection => scene.query_intersection(&query_of),
                            Query::Distance => scene.query_distance(&query_of),
                            Query::Contact => scene.query_contact(&query_of),
                            Query::Approximate => scene.query_approximate(&query_of),
                        };
                        answer.unwrap().pairs.to_vec()
                    };
                    let (whole, parts) = (ask(&mut twins.whole), ask(&mut twins.parts));
                    let kept: Vec<PairResult> = whole
                        .iter()
                        .copied()
                        .filter(|pair| {
                            twins.whole.object(pair.object1).is_ok() && twins.whole.object(pair.object2).is_ok()
                        })
                        .collect();
                    assert_eq!(kept.len(), whole.len());
                    assert_same(&twins, &whole, &parts, &format!("{round} {step} {query:?} {distance}"));
                    for pair in whole.iter().filter(|pair| query == Query::Contact && pair.answer.lower < 1.0) {
                        let is_unit = (Vector::from(pair.answer.normal).norm() - 1.0).abs() < 1e-6;
                        assert!(is_unit || pair.answer.outcome == Outcome::Undecided, "{pair:?}");
                    }
                    listed += whole.len();
                    hits += whole.iter().filter(|pair| pair.answer.outcome == Outcome::Intersecting).count();
                }
            }
            // Any object alone, and a shape that is in no scene.
            let k = random.below(20);
            if let (Ok(_), Ok(_)) = (twins.whole.object(twins.ids[k][0]), twins.parts.object(twins.ids[k][1])) {
                let [one, other] = twins.ids[k];
                let whole = twins.whole.query_object(one, Query::Distance, &up_to(0.4)).unwrap().pairs.to_vec();
                let parts = twins.parts.query_object(other, Query::Distance, &up_to(0.4)).unwrap().pairs.to_vec();
                assert_same(&twins, &whole, &parts, "object");
            }
            let (shape, pose) = (Arc::new(cuboid([0.5; 3])), anywhere(&mut random));
            let placed = |scene: &mut Scene| {
                scene.query_placed(&shape, &pose, Query::Distance, &up_to(0.4)).unwrap().pairs.to_vec()
            };
            let (whole, parts) = (placed(&mut twins.whole), placed(&mut twins.parts));
            assert_same(&twins, &whole, &parts, "placed");
        }
    }
    assert!(cfg!(miri) || (listed > 5000 && hits > 500), "{listed} {hits}");
}

/// Contacts of compounds are those of their pieces as rows, bit for bit in new scenes; at rest they are given again.
#[test]
fn contacts_are_those_of_pieces() {
    let mut random = Random::new(0xc0b2);
    let mut points = 0;
    for detail in [ContactDetail::Depth, ContactDetail::Manifold, ContactDetail::ReducedManifold] {
        for _ in 0..if cfg!(miri) { 1 } else { 6 } {
            let mut twins = Twins::new();
            let compounds = [ring(12), heap(&mut random, 6)].map(|pieces| Arc::new(Compound::new(&pieces).unwrap()));
            let cube = Arc::new(cuboid([0.4, 0.3, 0.2]));
            for k in 0..10 {
                let options = twins.options(Pose::new(&random.rotation(), &(random.vector() * 1.5)));
                match k % 4 {
                    3 => twins.add_pieces(std::slice::from_ref(&cube), &options),
                    kind => twins.add_compound(&compounds[kind % 2], &options),
                }
            }
            let query = SceneQuery { detail, ..up_to(0.1) };
            let ask = |scene: &mut Scene| {
                let answer = scene.query_contact(&query).unwrap();
                let contacts = answer.contacts;
                let of = |(pair, contact): (&PairResult, _)| {
                    let names = [(pair.user_data1, pair.piece1), (pair.user_data2, pair.piece2)];
                    format!("{names:?} {:?} {contact:?} {:?}", pair.answer, contacts.points_of(contact))
                };
                answer.pairs.iter().zip(contacts.contacts).map(of).collect::<Vec<_>>()
            };
            let (whole, parts) = (ask(&mut twins.whole), ask(&mut twins.parts));
            assert_eq!(whole.len(), parts.len());
            let strip = |text: &String| text.replace("first_point", "");
            for (one, other) in whole.iter().zip(&parts) {
                assert_eq!(strip(one), strip(other));
            }
            points += whole.len();
            assert_eq!(ask(&mut twins.whole), whole, "at rest");
            // One moves, the others' contacts are given again among the new ones.
            let pose = Pose::new(&random.rotation(), &random.vector());
            twins.both(|scene, id| scene.set_pose(id(4), &pose).unwrap());
            let (whole, mut fresh) = (ask(&mut twins.whole), Scene::new());
            for [id, _] in &twins.ids {
                let object = twins.whole.object(*id).unwrap();
                let options =
                    ObjectOptions { pose: *object.pose(), user_data: object.user_data(), ..ObjectOptions::default() };
                match object.compound() {
                    Some(compound) => fresh.add_compound(compound.clone(), &options),
                    None => fresh.add_object(object.pieces().to_vec(), &options),
                }
                .unwrap();
            }
            let again = ask(&mut fresh);
            let names = |all: &[String]| -> Vec<String> {
                all.iter().map(|text| text.split(']').next().unwrap().to_string()).collect()
            };
            assert_eq!(names(&whole), names(&again));
            // One that stops finds the first that intersects.
            let stops = SceneQuery { early_exit: true, ..query };
            let found = twins.whole.query_contact(&stops).unwrap().found.copied();
            let first = twins.whole.query_contact(&query).unwrap();
            let first = first.pairs.iter().find(|pair| pair.answer.outcome == Outcome::Intersecting);
            let name = |pair: &PairResult| (pair.object1, pair.object2, pair.piece1, pair.piece2);
            assert_eq!(found.as_ref().map(name), first.map(name));
        }
    }
    assert!(cfg!(miri) || points > 300, "{points}");
}

/// What a scene remembers of contacts of compounds that move slowly, into each other and apart, changes no outcome, and no depth
/// beyond its interval.
#[test]
fn contacts_that_are_remembered_are_right() {
    let mut random = Random::new(0xc0b5);
    let (mut listed, mut deep) = (0, 0);
    for round in 0..if cfg!(miri) { 1 } else { 8 } {
        let detail = [ContactDetail::Manifold, ContactDetail::ReducedManifold][round % 2];
        let query = SceneQuery { detail, ..up_to(0.05) };
        let compounds = [ring(24), heap(&mut random, 6)].map(|pieces| Arc::new(Compound::new(&pieces).unwrap()));
        let mut places: Vec<(Matrix, Vector)> = (0..6).map(|_| (random.rotation(), random.vector() * 1.2)).collect();
        let add = |scene: &mut Scene, k: usize, (turn, place): &(Matrix, Vector)| {
            let pose = Pose::new(turn, place);
            let options = ObjectOptions { pose, user_data: k as u64, ..ObjectOptions::default() };
            scene.add_compound(compounds[k % 2].clone(), &options).unwrap()
        };
        let mut scene = Scene::new();
        let ids: Vec<ObjectId> = places.iter().enumerate().map(|(k, place)| add(&mut scene, k, place)).collect();
        let ways: Vec<(Vector, Vector)> =
            (0..6).map(|_| (random.direction() * 0.01, random.direction() * 0.01)).collect();
        let name =
            |pair: &PairResult| ([pair.user_data1, pair.user_data2], [pair.piece1, pair.piece2], pair.answer.outcome);
        for step in 0..if cfg!(miri) { 2 } else { 40 } {
            for (((turn, place), (axis, way)), id) in places.iter_mut().zip(&ways).zip(&ids) {
                *turn = rotation(&axis.normalize(), axis.norm()) * *turn;
                *place += if step < 20 { *way } else { -way };
                scene.set_pose(*id, &Pose::new(turn, place)).unwrap();
            }
            let mut fresh = Scene::new();
            places.iter().enumerate().for_each(|(k, place)| _ = add(&mut fresh, k, place));
            let (warm, cold) = (scene.query_contact(&query).unwrap(), fresh.query_contact(&query).unwrap());
            assert!(warm.pairs.iter().map(name).eq(cold.pairs.iter().map(name)), "{round} {step}");
            for (one, other) in warm.contacts.contacts.iter().zip(cold.contacts.contacts) {
                assert_eq!(one.depth.outcome, other.depth.outcome);
                if one.depth.outcome == Outcome::Intersecting {
                    assert!(one.depth.lower <= other.depth.upper && other.depth.lower <= one.depth.upper);
                    deep += 1;
                }
                assert_eq!(one.manifold.point_count == 0, other.manifold.point_count == 0, "{round} {step}");
            }
            listed += warm.pairs.len();
        }
    }
    assert!(cfg!(miri) || (listed > 5_000 && deep > 2_000), "{listed} {deep}");
}

/// Pairs of very many contacts are found anew each time.
#[test]
fn many_contacts_at_rest_stay() {
    let mut scene = Scene::new();
    let pieces: Vec<Piece> =
        (0..18).map(|k| Piece { shape: Arc::new(cuboid([1.0 + 0.01 * k as f64; 3])), pose: Pose::IDENTITY }).collect();
    let compound = Arc::new(Compound::new(&pieces).unwrap());
    for x in [0.0, 0.3] {
        scene
            .add_compound(compound.clone(), &ObjectOptions { pose: at(x, 0.0, 0.0), ..ObjectOptions::default() })
            .unwrap();
    }
    let query = SceneQuery { detail: ContactDetail::Depth, ..up_to(0.0) };
    for _ in 0..3 {
        let answer = scene.query_contact(&query).unwrap();
        let pieces: Vec<[u32; 2]> = answer.pairs.iter().map(|pair| [pair.piece1, pair.piece2]).collect();
        assert!(pieces.len() == 324 && pieces.is_sorted());
        assert!(answer.contacts.contacts.iter().all(|contact| contact.depth.outcome == Outcome::Intersecting));
    }
}

/// Sets, rays and casts against all pairs of pieces.
#[test]
fn sets_rays_and_casts_are_those_of_pieces() {
    let mut random = Random::new(0xc0b3);
    let mut scratch = [SetScratch::default(), SetScratch::default()];
    let mut seen = [0; 5];
    for round in 0..if cfg!(miri) { 1 } else { 60 } {
        let mut twins = Twins::random(&mut random, 16);
        if round % 2 == 0 {
            twins.both(|scene, _| _ = scene.query_intersection(&SceneQuery::default()).unwrap());
        }
        let of_set = [[0, 7], [2, 3], [1, 8]][round % 3];
        let among = round % 4 == 0;
        let poses: Vec<Pose> = (0..10).map(|_| anywhere(&mut random)).collect();
        let mut ask = |k: usize| {
            let (scene, scratch) = (if k == 0 { &twins.whole } else { &twins.parts }, &mut scratch[k]);
            let ids = of_set.map(|number| twins.ids[number][k]);
            let set = ObjectSet { ids: &ids, poses: None, among };
            let hit = scene.first_hit(&set, &poses, PoseOrder::InOrder, [0.0, 0.2][round % 2], scratch).unwrap();
            let least = scene.least_distance(&set, None, f64::INFINITY, scratch).unwrap();
            let moved = ObjectSet { poses: Some(&poses[..2]), ..set };
            let second = ObjectSet { ids: &[twins.ids[5][k], twins.ids[6][k]], poses: None, among: false };
            let two = scene.least_distance(&moved, Some(&second), f64::INFINITY, scratch).unwrap();
            (hit, least, two)
        };
        let (whole, parts) = (ask(0), ask(1));
        // Any pair that hits may be the one that is named.
        assert_eq!(whole.0.time, parts.0.time, "{round}");
        for (one, other) in [(whole.1, parts.1), (whole.2, parts.2)] {
            assert!(one.lower <= other.upper && other.lower <= one.upper, "{round}: {one:?} {other:?}");
        }
        seen[0] += usize::from(whole.0.time < 5);
        for _ in 0..10 {
            let ray = Ray { origin: (random.direction() * 5.0).into(), direction: random.vector().into(), t_max: 1e3 };
            let mut cast = |k: usize, wanted: RayHits| {
                let scene = if k == 0 { &twins.whole } else { &twins.parts };
                scene.cast_ray(&ray, wanted, u32::MAX, &mut scratch[k]).unwrap().to_vec()
            };
            let (first, expected) = (cast(0, RayHits::First), cast(1, RayHits::First));
            assert_eq!(first.len(), expected.len());
            for (one, other) in first.iter().zip(&expected) {
                let ([from, to], [least, most]) = (one.answer.entry, other.answer.entry);
                assert!(from <= most && least <= to, "{round}: {one:?} {other:?}");
                assert_eq!(one.user_data, other.user_data);
                seen[1] += usize::from(one.answer.outcome == RayOutcome::Hit);
            }
            let (all, of_pieces) = (cast(0, RayHits::All), cast(1, RayHits::All));
            let mut objects: Vec<u64> = of_pieces.iter().map(|hit| hit.user_data).collect();
            let (mut met, mut once) = (all.iter().map(|hit| hit.user_data).collect::<Vec<_>>(), objects.clone());
            met.sort_unstable();
            objects.sort_unstable();
            once.sort_unstable();
            met.dedup();
            once.dedup();
            assert_eq!(met, once);
            assert!(all.windows(2).all(|two| two[0].answer.entry[0] <= two[1].answer.entry[0]));
            assert_eq!(cast(0, RayHits::Any).is_empty(), all.is_empty());
        }
        let mut cast = |k: usize, [start, centre, velocity, turn]: [Vector; 4]| {
            let (scene, scratch) = (if k == 0 { &twins.whole } else { &twins.parts }, &mut scratch[k]);
            let ids = of_set.map(|number| twins.ids[number][k]);
            let motion = |x: f64| {
                let start = Pose::new(&Matrix::identity(), &(start + Vector::new(x, 0.0, 0.0)));
                Motion::Screw(Screw { start, centre, velocity, rotation: turn })
            };
            let set = ObjectSet { ids: &ids, poses: None, among };
            let config = CastConfig { max_distance: 0.01, ..CastConfig::default() };
            scene.cast(&set, &[motion(0.0), motion(3.0)], &config, scratch).unwrap()
        };
        for _ in 0..3 {
            let numbers = [random.direction() * 6.0, random.vector(), random.vector() * 8.0, random.vector()];
            let (one, other) = (cast(0, numbers), cast(1, numbers));
            assert_eq!(one.outcome, other.outcome, "{round}: {one:?} {other:?}");
            if one.outcome == CastOutcome::Hit {
                assert!(one.time_lower <= other.time_upper && other.time_lower <= one.time_upper, "{one:?} {other:?}");
                assert!(one.pair.object1 != ObjectId::NULL);
            }
            seen[2] += usize::from(one.outcome == CastOutcome::Hit);
            seen[3] += usize::from(one.outcome == CastOutcome::Free);
        }
        let config = ManifoldConfig { max_distance: 0.1, ..ManifoldConfig::default() };
        if round % 3 == 0 {
            // Curved bodies make no contacts with grounds.
            let floor = hills(&mut random);
            let mut scenes = Twins::new();
            let compound = Arc::new(Compound::new(&ring(12)).unwrap());
            for _ in 0..4 {
                let options = scenes.options(anywhere(&mut random));
                scenes.add_compound(&compound, &options);
            }
            let options = scenes.options(Pose::IDENTITY);
            scenes.add_ground(&floor, &options);
            let mut found = |k: usize| {
                let scene = if k == 0 { &scenes.whole } else { &scenes.parts };
                let found = scene.own_ground_contacts(None, &config, &mut scratch[k]).unwrap();
                let name = |contact: &swiftprox::scene::SceneGroundContact| {
                    (contact.user_data, contact.piece, contact.contact)
                };
                (found.contacts.iter().map(name).collect::<Vec<_>>(), found.points.to_vec())
            };
            let (whole, parts) = (found(0), found(1));
            assert!(whole == parts);
            seen[4] += whole.0.len();
        }
    }
    assert!(cfg!(miri) || seen.iter().all(|count| *count > 20), "{seen:?}");
}

/// Events of pairs of objects, and of one listener, are those of pieces.
#[test]
fn events_are_those_of_pieces() {
    let mut random = Random::new(0xc0b4);
    let mut twins = Twins::random(&mut random, 16);
    let (mut listener, mut told) = (Listener::default(), [0; 3]);
    for step in 0..20 {
        twins.move_some(&mut random, 1 + step % 5);
        let events = |scene: &mut Scene| {
            let events = scene.query_events(0.2).unwrap();
            let name = |pair: &swiftprox::scene::ObjectPair| [pair.user_data1, pair.user_data2];
            [events.began, events.ended].map(|pairs| pairs.iter().map(name).collect::<Vec<_>>())
        };
        assert_eq!(events(&mut twins.whole), events(&mut twins.parts));
        let (_, heard) = twins.whole.listen(&mut listener, Query::Distance, &up_to(0.2)).unwrap();
        for pair in heard.pairs {
            assert_eq!(pair.state == EventState::Ended, pair.result == usize::MAX);
            told[pair.state as usize - 1] += 1;
        }
        // Nothing has moved: all goes on.
        let (_, heard) = twins.whole.listen(&mut listener, Query::Distance, &up_to(0.2)).unwrap();
        assert!(heard.pairs.iter().all(|pair| pair.state == EventState::Persists));
    }
    assert!(told.iter().all(|count| *count > 10), "{told:?}");
}

/// A recording has compounds by their pieces; a replay says the same, also where it begins later.
#[test]
fn recordings_have_compounds() {
    let mut random = Random::new(0xc0b5);
    for begins in [0, 3] {
        let mut twins = Twins::random(&mut random, 14);
        for _ in 0..begins {
            twins.move_some(&mut random, 2);
            twins.whole.query_intersection(&SceneQuery::default()).unwrap();
            twins.whole.query_distance(&up_to(0.3)).unwrap();
        }
        let tape = Tape::default();
        twins.whole.record_to(tape.clone()).unwrap();
        let added = Arc::new(Compound::new(&ring(5)).unwrap());
        let id = twins.whole.add_compound(added, &ObjectOptions::default()).unwrap();
        twins.whole.copy_object(id).unwrap();
        let mut asked = 0;
        for round in 0..8 {
            twins.move_some(&mut random, 1 + round % 4);
            twins.whole.query_distance(&up_to(0.5)).unwrap();
            twins.whole.query_intersection(&SceneQuery::default()).unwrap();
            twins.whole.query_contact(&SceneQuery { detail: ContactDetail::Manifold, ..up_to(0.1) }).unwrap();
            twins.whole.query_events(0.2).unwrap();
            asked += 4;
        }
        twins.whole.end_recording().unwrap();
        let played = play(&tape.bytes(), None).unwrap();
        assert_eq!((played.asked, played.cut_off), (asked, false));
        assert!(begins > 0 || played.identical == asked, "{played:?}");
        let mut replay = Replay::from_reader(std::io::Cursor::new(tape.bytes())).unwrap();
        let mut again = Scene::new();
        while replay.read().unwrap().is_some() {
            replay.change(&mut again).unwrap();
        }
        let counts = |scene: &Scene| -> Vec<usize> {
            scene.objects().filter_map(|object| object.compound().map(|compound| compound.piece_count())).collect()
        };
        assert_eq!(counts(&again), counts(&twins.whole));
    }
}

/// Two threads give the bits of one, and what is listed does not depend on what was asked before.
#[test]
fn neither_threads_nor_the_past_change_answers() {
    let answers = |workers: Option<Workers>| {
        let mut random = Random::new(0xc0b6);
        let mut twins = Twins::random(&mut random, 60);
        twins.whole.set_workers(workers);
        let mut all = Vec::new();
        for step in 0..6 {
            twins.move_some(&mut random, 1 + step % 3);
            let detail = SceneQuery { detail: ContactDetail::Manifold, ..up_to(0.1) };
            all.push(format!("{:?}", twins.whole.query_intersection(&SceneQuery::default()).unwrap()));
            all.push(format!("{:?}", twins.whole.query_distance(&up_to(0.5)).unwrap().pairs));
            all.push(format!("{:?}", twins.whole.query_contact(&detail).unwrap().contacts));
        }
        // Ids have the number of the scene in them.
        (twins, all.into_iter().map(|text| text.replace("object", "")).collect::<Vec<_>>())
    };
    let strip = |text: &String| -> String {
        text.split("bits: ").map(|part| part.trim_start_matches(|c: char| c.is_ascii_digit())).collect()
    };
    let ((mut twins, one), (_, two)) = (answers(None), answers(Some(Workers::threads(2))));
    assert!(one.iter().map(strip).eq(two.iter().map(strip)));
    let mut fresh = Scene::new();
    for [id, _] in &twins.ids {
        let object = twins.whole.object(*id).unwrap();
        let [groups, mask] = [object.groups(), object.mask()];
        let options =
            ObjectOptions { pose: *object.pose(), fixed: object.fixed(), user_data: object.user_data(), groups, mask };
        match (object.compound(), object.ground()) {
            (Some(compound), _) => fresh.add_compound(compound.clone(), &options),
            (_, Some(ground)) => fresh.add_ground(ground.clone(), &options),
            _ => fresh.add_object(object.pieces().to_vec(), &options),
        }
        .unwrap();
    }
    let listed = |scene: &mut Scene| -> Vec<_> {
        let mut found = by_objects(scene.query_distance(&up_to(0.5)).unwrap().pairs);
        found.values_mut().for_each(|(_, interval)| *interval = [0.0; 2]);
        found
            .into_iter()
            .chain(by_objects(scene.query_intersection(&up_to(0.5)).unwrap().pairs))
            .map(|(k, v)| (k, v.0))
            .collect()
    };
    assert_eq!(listed(&mut twins.whole), listed(&mut fresh));
}

/// What a compound cannot do is refused, with the reason and a cure, and nothing has changed.
#[test]
fn what_compounds_cannot_do_is_refused() {
    let mut scene = Scene::new();
    let compound = Arc::new(Compound::new(&ring(5)).unwrap());
    let id = scene.add_compound(compound.clone(), &ObjectOptions { user_data: 7, ..ObjectOptions::default() }).unwrap();
    let body = scene.add_object(vec![Arc::new(cuboid([0.4; 3]))], &ObjectOptions::default()).unwrap();
    let is_refused = |result: Result<(), Error>, words: &str| {
        assert!(matches!(&result, Err(Error::Argument(message)) if message.contains(words)), "{result:?}");
    };
    is_refused(scene.set_piece_pose(id, 0, &Pose::IDENTITY), "a compound, whose pieces stay as they were made");
    is_refused(scene.set_piece_user_data(id, 0, 1), "a compound, whose pieces stay as they were made");
    let mut scratch = SetScratch::default();
    let (centre, rotation) = (Vector::zeros(), Vector::zeros());
    let motions = [Motion::Screw(Screw { start: Pose::IDENTITY, centre, velocity: Vector::x(), rotation })];
    let parts = CastConfig { ignores_parting: true, ..CastConfig::default() };
    let alone = ObjectSet { ids: &[body], ..ObjectSet::default() };
    is_refused(scene.cast(&alone, &motions, &parts, &mut scratch).map(drop), "ignores_parting");
    // The product of both poses is refused, and neither is.
    let skew = |x: f64| Pose::new(&Matrix::from_diagonal(&Vector::new(1.0 + x, 1.0, 1.0)), &Vector::zeros());
    let bent = Piece { shape: Arc::new(cuboid([0.4; 3])), pose: skew(4e-3) };
    let bent = Arc::new(Compound::new(&[bent]).unwrap());
    let bent_id = scene.add_compound(bent.clone(), &ObjectOptions::default()).unwrap();
    assert!(matches!(scene.set_pose(bent_id, &skew(4e-3)), Err(Error::Pose(_))));
    assert!(matches!(scene.set_poses(&[bent_id], &[skew(4e-3)]), Err(Error::Pose(_))));
    let options = ObjectOptions { pose: skew(4e-3), ..ObjectOptions::default() };
    assert!(matches!(scene.add_compound(bent, &options), Err(Error::Pose(_))));
    scene.set_pose(bent_id, &skew(-1e-3)).unwrap();
    assert_eq!(*scene.object(bent_id).unwrap().pose(), skew(-1e-3));
    let object = scene.object(id).unwrap();
    assert!(object.pieces().is_empty() && object.user_data() == 7 && !object.fixed());
    assert!(Arc::ptr_eq(object.compound().unwrap(), &compound));
    assert_eq!(scene.object_count(), 3);
    assert!(scene.query_intersection(&SceneQuery::default()).unwrap().intersecting);
}
