//! One result per pair of objects: the first of all their results, or the nearest, in scenes of pieces, compounds and a ground,
//! beside the same scene that lists every pair of pieces.

use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};

use swiftprox::compound::Compound;
use swiftprox::math::{Pose, Vector};
use swiftprox::object::{ObjectId, ObjectOptions};
use swiftprox::pair::{Outcome, Query};
use swiftprox::scene::{
    ContactDetail, EventState, Listener, PairFilter, PairResult, PiecePairs, Scene, SceneAnswer, SceneQuery, Workers,
};
use swiftprox::shape::Shape;
use testkit::random::Random;
use testkit::shapes::{at, cuboid, hull};

use super::compound_objects::{anywhere, heap, hills, ring};
use super::record::{Tape, play};
use super::threads::careless;

const CHOICES: [PiecePairs; 2] = [PiecePairs::First, PiecePairs::Nearest];

/// The same objects in several scenes; user data 0, 1, …
struct Copies {
    /// One that lists every pair, and for each choice two, of which the second has workers.
    scenes: Vec<Scene>,
    ids: Vec<Vec<ObjectId>>,
    is_compound: Vec<bool>,
    /// How often work was shared.
    shared: Arc<AtomicUsize>,
}

impl Copies {
    fn random(random: &mut Random, count: usize) -> Copies {
        let (ids, shared) = (vec![Vec::new(); 5], Arc::default());
        let mut copies = Copies { scenes: Vec::new(), ids, is_compound: Vec::new(), shared };
        copies.scenes.resize_with(5, Scene::new);
        for scene in [2, 4] {
            let shared = copies.shared.clone();
            copies.scenes[scene].set_workers(Some(Workers::new(3, move |parts, work| {
                shared.fetch_add(1, Ordering::Relaxed);
                careless(parts, work);
            })));
        }
        let compounds = [ring(8), heap(random, 5)].map(|pieces| Arc::new(Compound::new(&pieces).unwrap()));
        let cylinder = Arc::new(Shape::from_cylinder(0.3, 0.3, 1e-2).unwrap());
        let mut cloud = |_| {
            let middle = random.vector() * 0.8;
            Arc::new(hull(&(0..8).map(|_| random.direction() * 0.4 + middle).collect::<Vec<_>>()))
        };
        let mut pieces: Vec<Arc<Shape>> = (0..9).map(&mut cloud).collect();
        pieces[4] = cylinder;
        let ground = hills(random);
        for k in 0..count {
            let options = ObjectOptions {
                pose: anywhere(random),
                fixed: random.below(6) == 0,
                user_data: k as u64,
                ..ObjectOptions::default()
            };
            let shapes = &pieces[..1 + random.below(pieces.len())];
            copies.is_compound.push(k % 5 == 2);
            let compound = &compounds[random.below(2)];
            copies.change(|scene, ids, _| {
                ids.push(match k % 5 {
                    _ if k == 5 => scene.add_ground(ground.clone(), &options).unwrap(),
                    2 => scene.add_compound(compound.clone(), &options).unwrap(),
                    _ => scene.add_object(shapes.to_vec(), &options).unwrap(),
                });
            });
        }
        copies
    }

    /// Changes all, whose numbers `change` gets.
    fn change(&mut self, mut change: impl FnMut(&mut Scene, &mut Vec<ObjectId>, usize)) {
        for (k, (scene, ids)) in self.scenes.iter_mut().zip(&mut self.ids).enumerate() {
            change(scene, ids, k);
        }
    }

    /// Objects come to other places, pieces too, and pairs are switched off and on.
    fn disturb(&mut self, random: &mut Random, step: usize) {
        let count = self.ids[0].len();
        let [k, l] = [random.below(count), random.below(count - 1)];
        let l = if l == k { count - 1 } else { l };
        let (pose, near) = (anywhere(random), Pose::new(&random.rotation(), &(random.vector() * 0.3)));
        let moved: Vec<(usize, Pose)> = match step % 4 {
            0 => (0..count).map(|k| (k, anywhere(random))).collect(),
            1 => vec![(k, pose)],
            2 => vec![],
            _ => (0..3).map(|_| (random.below(count), anywhere(random))).collect(),
        };
        self.change(|scene, ids, _| {
            for (k, pose) in &moved {
                // It may be gone.
                drop(scene.set_pose(ids[*k], pose));
            }
            match step {
                // Its pieces may not be moved.
                2 | 7 | 11 => drop(scene.set_piece_pose(ids[k], 0, &near)),
                3 => drop(scene.set_pair_active(ids[k], ids[l], false)),
                5 => drop(scene.set_object_active(ids[k], false)),
                6 => scene.set_all_active(true),
                8 => {
                    let block = [ids[k.min(l)], ids[k.max(l)]];
                    scene.set_pair_filter(Some(PairFilter::new(move |one, other| [one, other] != block)));
                }
                9 => scene.set_kept_pair_limit(0),
                10 => scene.set_kept_pair_limit(1 << 20),
                12 => drop(scene.remove_object(ids[k])),
                _ => {}
            }
        });
    }
}

/// What a query lists, of ids that differ from scene to scene only what they mean.
#[derive(Debug, Clone, Default)]
struct Told {
    pairs: Vec<PairResult>,
    found: Option<PairResult>,
    intersecting: bool,
    depths: Vec<Outcome>,
    bits: String,
}

impl Told {
    fn new(answer: &SceneAnswer) -> Told {
        let of = |pair: &PairResult| format!("{:?} {:?}", name(pair), pair.answer);
        let pairs: Vec<String> = answer.pairs.iter().map(of).collect();
        Told {
            pairs: answer.pairs.to_vec(),
            found: answer.found.copied(),
            intersecting: answer.intersecting,
            depths: answer.contacts.contacts.iter().map(|contact| contact.depth.outcome).collect(),
            bits: format!("{pairs:?} {:?} {:?}", answer.found.map(of), answer.contacts),
        }
    }
}

type Name = ([u64; 2], [u32; 2]);

fn name(pair: &PairResult) -> Name {
    ([pair.user_data1, pair.user_data2], [pair.piece1, pair.piece2])
}

fn ask(scene: &mut Scene, kind: Query, query: &SceneQuery) -> Told {
    let answer = match kind {
        Query::Intersection => scene.query_intersection(query),
        Query::Distance => scene.query_distance(query),
        Query::Contact => scene.query_contact(query),
        Query::Approximate => scene.query_approximate(query),
    };
    Told::new(&answer.unwrap())
}

/// The pairs of pieces of every two objects.
fn of_objects(every: &[PairResult]) -> impl Iterator<Item = &[PairResult]> {
    every.chunk_by(|one, other| name(one).0 == name(other).0)
}

fn intersects(pair: &PairResult) -> bool {
    pair.answer.outcome == Outcome::Intersecting
}

fn is_undecided(pair: &PairResult) -> bool {
    pair.answer.outcome == Outcome::Undecided
}

/// One of every two objects' results, by all of them.
fn check(choice: PiecePairs, every: &Told, one: &Told, names_pieces: impl Fn(u64) -> bool) {
    assert_eq!(of_objects(&every.pairs).count(), one.pairs.len());
    for (all, found) in of_objects(&every.pairs).zip(&one.pairs) {
        // The names of a compound's pieces depend on what was asked before.
        let name = |pair: &PairResult| {
            let (objects, pieces) = name(pair);
            (objects, [0, 1].map(|k| if names_pieces(objects[k]) { pieces[k] } else { 0 }))
        };
        let chosen = match choice {
            PiecePairs::First => &all[0],
            _ => all.iter().find(|pair| intersects(pair)).unwrap_or_else(|| {
                let same = |pair: &&PairResult| name(pair) == name(found);
                all.iter().find(same).unwrap_or_else(|| panic!("{found:?} is none of {all:?}"))
            }),
        };
        let considered = if choice == PiecePairs::First { &all[..1] } else { all };
        let outcome = match chosen.answer.outcome {
            Outcome::Separated if considered.iter().any(is_undecided) => Outcome::Undecided,
            outcome => outcome,
        };
        assert_eq!((name(found), found.answer.outcome), (name(chosen), outcome));
        assert!(found.answer.outcome != Outcome::Separated || found.answer.lower > 0.0, "{found:?}");
        let least = |end: fn(&PairResult) -> f64| considered.iter().map(end).fold(f64::INFINITY, f64::min);
        let [lower, upper] = [least(|pair| pair.answer.lower), least(|pair| pair.answer.upper)];
        let answer = &found.answer;
        let is_common = answer.lower <= upper * (1.0 + 1e-9) && lower <= answer.upper * (1.0 + 1e-9);
        assert!(is_common, "{answer:?} {lower} {upper}");
        assert!(chosen.answer.lower <= upper || intersects(chosen), "{chosen:?} {upper}");
        assert!(answer.lower <= answer.distance && answer.distance <= answer.upper || answer.distance.is_nan());
    }
    assert_eq!(one.intersecting, one.pairs.iter().any(intersects));
    assert!(choice == PiecePairs::First || one.intersecting == every.intersecting);
    assert!(one.depths.is_empty() || one.depths.len() == one.pairs.len());
    for (pair, depth) in one.pairs.iter().zip(&one.depths) {
        assert!(!intersects(pair) || matches!(depth, Outcome::Intersecting | Outcome::None), "{pair:?} {depth:?}");
    }
}

/// Every kind of query while objects and pieces move or rest, come, go and are filtered.
#[test]
fn the_first_and_the_nearest_of_every_two_objects_are_listed() {
    let mut random = Random::new(0x91ec);
    let (mut many, mut hits, mut unmoved, mut shared) = (0, 0, 0, 0);
    for round in 0..if cfg!(miri) { 1 } else { 3 } {
        let mut copies = Copies::random(&mut random, if cfg!(miri) { 6 } else { 28 });
        for step in 0..14 {
            copies.disturb(&mut random, step);
            for kind in [Query::Intersection, Query::Distance, Query::Contact, Query::Approximate] {
                let max_distance = [0.4, f64::INFINITY, 0.0][(step + round) % 3];
                let mut query = SceneQuery { max_distance, ..SceneQuery::default() };
                match kind {
                    Query::Contact => {
                        query.max_distance = max_distance.min(0.4);
                        query.detail = [ContactDetail::Manifold, ContactDetail::None, ContactDetail::Depth][step % 3];
                    }
                    Query::Approximate if step % 2 == 0 => query.error_budget = 3.0,
                    Query::Approximate => query.relative_error = 0.1,
                    _ => {}
                }
                let every = ask(&mut copies.scenes[0], kind, &query);
                let has_detail = query.detail != ContactDetail::None;
                for (k, piece_pairs) in CHOICES.into_iter().enumerate() {
                    let query = SceneQuery { piece_pairs, ..query };
                    let [alone, shared] = copies.scenes.get_disjoint_mut([2 * k + 1, 2 * k + 2]).unwrap();
                    let one = ask(alone, kind, &query);
                    let is_compound = |object: u64| copies.is_compound[object as usize];
                    check(piece_pairs, &every, &one, |object| has_detail || !is_compound(object));
                    let of = format!("{round} {step} {kind:?} {query:?}");
                    assert!(ask(shared, kind, &query).bits == one.bits, "{of}");
                    // At rest, if the scene keeps its pairs, and at the first that intersects.
                    let again = [&mut *alone, &mut *shared].map(|scene| ask(scene, kind, &query).bits);
                    assert!(again[0] == again[1] && (again[0] == one.bits || step == 9), "{of}");
                    let stops = SceneQuery { early_exit: true, ..query };
                    let stopped = ask(alone, kind, &stops);
                    let found = |told: &Told| told.found.map(|pair| name(&pair).0);
                    assert_eq!(
                        found(&stopped),
                        one.pairs.iter().find(|pair| intersects(pair)).map(|pair| name(pair).0)
                    );
                    assert!(ask(shared, kind, &stops).bits == stopped.bits, "{of}");
                    hits += one.pairs.iter().filter(|pair| intersects(pair)).count();
                }
                many += of_objects(&every.pairs).filter(|all| all.len() > 1).count();
            }
            for k in [1, 3] {
                let of = |scene: usize| *copies.scenes[scene].statistics();
                assert_eq!(of(k), of(k + 1), "round {round}, step {step}");
                unmoved += of(k).unmoved;
            }
        }
        shared += copies.shared.load(Ordering::Relaxed);
    }
    let counts = [many, hits, unmoved as usize, 10 * shared];
    assert!(cfg!(miri) || counts.iter().all(|count| *count > 1000), "{counts:?}");
}

/// Queries for one object, and for a body that is in no scene.
#[test]
fn one_body_has_one_result_with_each_object() {
    let mut random = Random::new(0x91ed);
    for round in 0..if cfg!(miri) { 1 } else { 20 } {
        let mut copies = Copies::random(&mut random, 14);
        let body = [0.3, 0.6, 0.9].map(|size| (Arc::new(cuboid([size, 0.3, 0.2])), anywhere(&mut random)));
        let kind = [Query::Intersection, Query::Distance, Query::Contact, Query::Approximate][round % 4];
        let query = SceneQuery { max_distance: [0.5, f64::INFINITY][round / 4 % 2], ..SceneQuery::default() };
        let mut told = |k: usize, piece_pairs, object: Option<usize>| {
            let (query, scene) = (SceneQuery { piece_pairs, ..query }, &mut copies.scenes[k]);
            let answer = match object {
                Some(object) => scene.query_object(copies.ids[k][object], kind, &query),
                None => scene.query_placed_pieces(&body, u32::MAX, kind, &query),
            };
            Told::new(&answer.unwrap())
        };
        for object in [Some(0), Some(2), Some(5), Some(7), None] {
            let every = told(0, PiecePairs::Every, object);
            for (k, choice) in CHOICES.into_iter().enumerate() {
                let one = told(2 * k + 1, choice, object);
                // The body is in no scene, and so no compound; its user data is 0, as the first object's.
                check(choice, &every, &one, |object| !copies.is_compound[object as usize]);
            }
        }
    }
}

/// Beside pieces that are apart for certain, a cylinder of which that is not known.
#[test]
fn objects_that_may_meet_are_undecided() {
    let mut random = Random::new(0x91f0);
    let block = || Arc::new(cuboid([0.5, 0.5, 0.5]));
    let cylinder = Arc::new(Shape::from_cylinder(0.3, 0.3, 1e-2).unwrap());
    let (mut apart, mut undecided) = (0, 0);
    for round in 0..if cfg!(miri) { 4 } else { 60 } {
        let [of_block, of_cylinder] = [1e-3, 1e-4 * (random.below(100) + 1) as f64];
        let mut pieces = [(block(), at(1.0 + of_block, 0.0, 0.0)), (cylinder.clone(), at(0.0, 0.8 + of_cylinder, 0.0))];
        if round % 2 == 1 {
            pieces.reverse();
        }
        let mut scene = Scene::new();
        scene.add_object(vec![block()], &ObjectOptions::default()).unwrap();
        let other =
            scene.add_object(pieces.each_ref().map(|(shape, _)| shape.clone()).to_vec(), &ObjectOptions::default());
        let other = other.unwrap();
        for (k, (_, pose)) in (0..).zip(&pieces) {
            scene.set_piece_pose(other, k, pose).unwrap();
        }
        for kind in [Query::Intersection, Query::Distance, Query::Contact, Query::Approximate] {
            let detail = [ContactDetail::None, ContactDetail::Manifold][usize::from(kind == Query::Contact)];
            let query =
                SceneQuery { max_distance: [0.02, f64::INFINITY][round / 2 % 2], detail, ..SceneQuery::default() };
            let every = ask(&mut scene, kind, &query);
            for piece_pairs in CHOICES {
                let query = SceneQuery { piece_pairs, ..query };
                let one = ask(&mut scene, kind, &query);
                check(piece_pairs, &every, &one, |_| true);
                assert_eq!(ask(&mut scene, kind, &query).bits, one.bits, "at rest");
                if let ([all @ .., _], PiecePairs::Nearest) = (&*every.pairs, piece_pairs) {
                    let is_mixed = !all.is_empty() && every.pairs.iter().filter(|pair| is_undecided(pair)).count() == 1;
                    undecided += usize::from(is_mixed && is_undecided(&one.pairs[0]));
                    apart += usize::from(!is_undecided(&one.pairs[0]));
                }
            }
        }
    }
    assert!(cfg!(miri) || apart > 20 && undecided > 20, "{apart} {undecided}");
}

/// Where pairs have no caches, those of two objects are gone through a block at a time, and no farther than is needed.
#[test]
fn of_many_pieces_no_more_pairs_are_kept_than_a_block() {
    let mut random = Random::new(0x91f1);
    let counts: [usize; 6] = if cfg!(miri) { [1, 17, 3, 17, 2, 1] } else { [1, 30, 3, 30, 20, 2] };
    let (asked, mut scenes) = (Arc::new(AtomicUsize::new(0)), [Scene::new(), Scene::new()]);
    let counted = asked.clone();
    scenes[1].set_kept_pair_limit(0);
    scenes[1].set_pair_filter(Some(PairFilter::new(move |_, _| {
        counted.fetch_add(1, Ordering::Relaxed);
        true
    })));
    let pieces: Vec<Arc<Shape>> = (0..30)
        .map(|_| {
            let middle = random.vector() * 0.8;
            Arc::new(hull(&(0..8).map(|_| random.direction() * 0.3 + middle).collect::<Vec<_>>()))
        })
        .collect();
    let ids = scenes.each_mut().map(|scene| {
        let add = |(k, count): (usize, &usize)| {
            let options = ObjectOptions { user_data: k as u64, ..ObjectOptions::default() };
            scene.add_object(pieces[..*count].to_vec(), &options).unwrap()
        };
        counts.iter().enumerate().map(add).collect::<Vec<_>>()
    });
    let [mut few, mut many] = [0; 2];
    for round in 0..if cfg!(miri) { 1 } else { 12 } {
        for k in 0..counts.len() {
            let pose = Pose::new(&random.rotation(), &(random.vector() * [2.0, 6.0][round % 2]));
            scenes.iter_mut().zip(&ids).for_each(|(scene, ids)| scene.set_pose(ids[k], &pose).unwrap());
        }
        for kind in [Query::Distance, Query::Contact, Query::Approximate] {
            let detail = [ContactDetail::None, ContactDetail::Manifold][usize::from(kind == Query::Contact)];
            let query = SceneQuery { detail, relative_error: 0.1, ..SceneQuery::default() };
            let every = ask(&mut scenes[0], kind, &query);
            for piece_pairs in CHOICES {
                let query = SceneQuery { piece_pairs, ..query };
                asked.store(0, Ordering::Relaxed);
                let one = ask(&mut scenes[1], kind, &query);
                check(piece_pairs, &every, &one, |_| true);
                let asked = asked.load(Ordering::Relaxed);
                let all: usize = of_objects(&every.pairs).map(<[_]>::len).sum();
                // At most a block, and the pair behind it, of two objects each.
                let most: usize = of_objects(&every.pairs).map(|all| all.len().min(257)).sum();
                if piece_pairs == PiecePairs::First || one.pairs.iter().all(intersects) {
                    assert!(asked <= most, "{asked} {most} {all}");
                    few += 1;
                } else {
                    many += usize::from(asked > most);
                }
                let stopped = ask(&mut scenes[1], kind, &SceneQuery { early_exit: true, ..query });
                let names = [stopped.found, one.pairs.iter().find(|pair| intersects(pair)).copied()];
                let [found, expected] = names.map(|pair| pair.map(|pair| name(&pair)));
                assert_eq!(found, expected);
            }
        }
    }
    assert!(cfg!(miri) || few > 20 && many > 5, "{few} {many}");
}

/// Two combs of pieces, one of which is another time the first within reach, or the nearest.
#[test]
fn a_listener_hears_of_pieces_and_of_objects() {
    let bar: Vec<Arc<Shape>> =
        [0.0, 2.0, 4.0].map(|x| Arc::new(hull(&[0, 1, 2, 3, 4, 5, 6, 7].map(|k| corner(x, k))))).to_vec();
    let mut scene = Scene::new();
    let ids = [at(0.0, 0.0, 0.0), at(0.0, 1.5, 0.0)]
        .map(|pose| scene.add_object(bar.clone(), &ObjectOptions { pose, ..ObjectOptions::default() }).unwrap());
    let query = SceneQuery { max_distance: 1.0, piece_pairs: PiecePairs::Nearest, ..SceneQuery::default() };
    let mut listener = Listener::default();
    let mut hear = |scene: &mut Scene, pose: Pose| {
        scene.set_pose(ids[1], &pose).unwrap();
        let (_, events) = scene.listen(&mut listener, Query::Distance, &query).unwrap();
        events.pairs.iter().map(|e| ([e.piece1, e.piece2], e.state, e.objects_state)).collect::<Vec<_>>()
    };
    use EventState::{Began, Ended, Persists};
    assert_eq!(hear(&mut scene, at(0.0, 1.5, 0.0)), [([0, 0], Began, Began)], "of several as near the first");
    assert_eq!(hear(&mut scene, at(0.0, 1.6, 0.0)), [([0, 0], Persists, Persists)]);
    let other = [([0, 0], Ended, Persists), ([1, 0], Began, Persists)];
    assert_eq!(hear(&mut scene, at(2.0, 1.6, 0.0)), other);
    assert_eq!(hear(&mut scene, at(9.0, 1.6, 0.0)), [([1, 0], Ended, Ended)]);
}

/// A corner of a unit cube around (x, 0, 0).
fn corner(x: f64, k: usize) -> Vector {
    let end = |bit: usize| if k >> bit & 1 == 0 { -0.5 } else { 0.5 };
    Vector::new(x + end(0), end(1), end(2))
}

/// Without the later pairs there is less to do, and nearer ones are soon found to be no nearer.
#[test]
fn later_pairs_are_not_tested() {
    let row: Vec<Arc<Shape>> =
        (0..10).map(|x| Arc::new(hull(&[0, 1, 2, 3, 4, 5, 6, 7].map(|k| corner(x as f64 * 0.9, k))))).collect();
    let mut scene = Scene::new();
    for y in [0.0, 0.5] {
        scene.add_object(row.clone(), &ObjectOptions { pose: at(0.0, y, 0.0), ..ObjectOptions::default() }).unwrap();
    }
    let mut tested = |piece_pairs, detail| {
        scene.reset_statistics();
        let query = SceneQuery { max_distance: 9.0, piece_pairs, detail, ..SceneQuery::default() };
        let count = scene.query_contact(&query).unwrap().pairs.len();
        (count, scene.statistics().pairs)
    };
    for detail in [ContactDetail::None, ContactDetail::Manifold] {
        assert_eq!(tested(PiecePairs::Every, detail), (100, 100));
        for choice in CHOICES {
            assert_eq!(tested(choice, detail), (1, 1), "the first two intersect");
        }
    }
    // Of few pieces, too, which the same question is asked of again as they move.
    let mut few = Scene::new();
    let ids = [0.0, 3.0].map(|y| {
        let options = ObjectOptions { pose: at(0.0, y, 0.0), ..ObjectOptions::default() };
        few.add_object(row[..2].to_vec(), &options).unwrap()
    });
    let turns = [PiecePairs::Every, PiecePairs::Every, PiecePairs::First, PiecePairs::Nearest, PiecePairs::Every];
    let counts = turns.map(|piece_pairs| {
        ids.iter().for_each(|id| {
            let pose = *few.object(*id).unwrap().pose();
            few.set_pose(*id, &Pose::new(&pose.rotation(), &(pose.translation() * 1.1))).unwrap();
        });
        few.query_distance(&SceneQuery { piece_pairs, ..SceneQuery::default() }).unwrap().pairs.len()
    });
    assert_eq!(counts, [4, 4, 1, 1, 4]);
}

/// A recording has the choice, and a replay lists the same, wherever it begins.
#[test]
fn recordings_have_the_choice() {
    let mut random = Random::new(0x91ef);
    let mut copies = Copies::random(&mut random, 14);
    let [scene, tape] = [0; 2].map(|_| Tape::default());
    let mut asked = 0;
    for step in 0..12 {
        for tape in [(step == 0).then_some(&scene), (step == 6).then_some(&tape)].into_iter().flatten() {
            copies.scenes[0].end_recording().unwrap();
            copies.scenes[0].record_to(tape.clone()).unwrap();
        }
        copies.disturb(&mut random, step);
        for piece_pairs in [PiecePairs::Every, PiecePairs::First, PiecePairs::Nearest] {
            for detail in [ContactDetail::None, ContactDetail::Manifold] {
                let query = SceneQuery { max_distance: 0.4, piece_pairs, detail, ..SceneQuery::default() };
                ask(&mut copies.scenes[0], Query::Contact, &query);
                asked += 1;
            }
        }
    }
    copies.scenes[0].end_recording().unwrap();
    let played = [scene, tape].map(|tape| play(&tape.bytes(), None).unwrap());
    assert_eq!(played.each_ref().map(|played| played.asked), [asked / 2; 2]);
    assert_eq!(played[0].identical, asked / 2);
}
