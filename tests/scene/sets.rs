//! Questions about sets of objects: against integers for all pairs, whatever was done to the scene before, and from several
//! threads.

use std::sync::{Arc, Barrier};

use dashu_ratio::RBig;
use swiftprox::error::Error;
use swiftprox::math::{Matrix, Pose, Vector};
use swiftprox::motion::{CastAnswer, CastConfig, CastOutcome, Motion, Moving, Screw, cast};
use swiftprox::object::{ObjectId, ObjectOptions};
use swiftprox::pair::PairCache;
use swiftprox::ray::{Ray, RayOutcome};
use swiftprox::scene::{ObjectSet, PairFilter, PoseOrder, RayHits, Scene, SceneQuery, SetScratch};
use swiftprox::shape::Shape;
use testkit::any_size::integers::place;
use testkit::any_size::nearest::nearest;
use testkit::oracle::rational;
use testkit::random::Random;
use testkit::rays::truth;
use testkit::shapes::{at, cuboid, hull};

/// What the test knows of an object.
struct Known {
    id: ObjectId,
    /// The corners of its pieces.
    pieces: Vec<Vec<Vector>>,
    shapes: Vec<Arc<Shape>>,
    pose: Pose,
    fixed: bool,
    groups: u32,
    mask: u32,
}

/// A scene, and all that the answers depend on.
struct World {
    scene: Scene,
    objects: Vec<Known>,
    inactive: Vec<[ObjectId; 2]>,
    /// The filter refuses pairs whose numbers add to a multiple of this.
    refused: Option<u64>,
    /// How far from the middle objects are.
    size: f64,
}

fn pose_in(random: &mut Random, size: f64) -> Pose {
    Pose::new(&random.rotation(), &(random.vector() * size))
}

impl World {
    fn new(random: &mut Random, count: usize, size: f64) -> World {
        let mut scene = Scene::new();
        let mut objects: Vec<Known> = Vec::new();
        for number in 0..count {
            let pieces: Vec<Vec<Vector>> = (0..1 + random.below(2))
                .map(|_| {
                    let middle = random.vector();
                    (0..4 + random.below(5)).map(|_| middle + random.vector() * 0.6).collect()
                })
                .collect();
            let shapes: Vec<Arc<Shape>> = pieces.iter().map(|points| Arc::new(hull(points))).collect();
            let (pose, fixed) = (pose_in(random, size), random.below(3) == 0);
            let (groups, mask) =
                if random.below(4) == 0 { (2, 3) } else { (1, if random.below(5) == 0 { 1 } else { 3 }) };
            let options = ObjectOptions { pose, fixed, user_data: number as u64, groups, mask };
            let id = scene.add_object(shapes.clone(), &options).unwrap();
            objects.push(Known { id, pieces, shapes, pose, fixed, groups, mask });
        }
        World { scene, objects, inactive: Vec::new(), refused: None, size }
    }

    /// Something happens to the scene: what is moved, told or asked must not be seen in answers.
    fn stir(&mut self, random: &mut Random) {
        match random.below(6) {
            0 => {
                for known in &mut self.objects {
                    known.pose = pose_in(random, self.size);
                    self.scene.set_pose(known.id, &known.pose).unwrap();
                }
            }
            1 => {
                let known = random.below(self.objects.len());
                let known = &mut self.objects[known];
                known.pose = pose_in(random, self.size);
                self.scene.set_pose(known.id, &known.pose).unwrap();
            }
            2 => self.scene.prepare().unwrap(),
            3 => {
                let pair = [random.below(self.objects.len()), random.below(self.objects.len())];
                if pair[0] != pair[1] {
                    let ids = pair.map(|k| self.objects[k].id);
                    self.scene.set_pair_active(ids[0], ids[1], false).unwrap();
                    self.inactive.push(ids);
                }
            }
            4 => {
                let tolerance = random.pick(&[0.0, 1.0, f64::INFINITY]);
                self.scene.query_distance(&SceneQuery { max_distance: tolerance, ..SceneQuery::default() }).unwrap();
            }
            _ => {
                let gone = random.below(self.objects.len());
                if self.objects.len() > 12 {
                    self.scene.remove_object(self.objects.remove(gone).id).unwrap();
                }
            }
        }
    }

    fn filter(&mut self, refused: u64) {
        let numbers: Vec<(ObjectId, u64)> =
            self.objects.iter().map(|known| (known.id, self.scene.object(known.id).unwrap().user_data())).collect();
        let number = move |id: ObjectId| numbers.iter().find(|(known, _)| *known == id).unwrap().1;
        self.scene.set_pair_filter(Some(PairFilter::new(move |a, b| (number(a) + number(b)) % refused != 0)));
        self.refused = Some(refused);
    }

    fn is_tested(&self, a: &Known, b: &Known, moved: bool) -> bool {
        let number = |known: &Known| self.scene.object(known.id).unwrap().user_data();
        let is_inactive = self.inactive.iter().any(|pair| *pair == [a.id, b.id] || *pair == [b.id, a.id]);
        a.id != b.id
            && a.groups & b.mask != 0
            && b.groups & a.mask != 0
            && (moved || !(a.fixed && b.fixed))
            && !is_inactive
            && self.refused.is_none_or(|refused| (number(a) + number(b)) % refused != 0)
    }

    /// The squares of the distances of all pairs of pieces that a question is about: object 1, object 2, square.
    fn squares(
        &self,
        of_set: &[(usize, Pose)],
        against: &[(usize, Pose)],
        among: bool,
        moved: bool,
    ) -> Vec<(ObjectId, ObjectId, RBig)> {
        let mut found = Vec::new();
        let mut look = |(a, pose_a): &(usize, Pose), (b, pose_b): &(usize, Pose)| {
            let [a, b] = [&self.objects[*a], &self.objects[*b]];
            if self.is_tested(a, b, moved) {
                for piece_a in &a.pieces {
                    for piece_b in &b.pieces {
                        found.push((a.id, b.id, square_distance(piece_a, pose_a, piece_b, pose_b)));
                    }
                }
            }
        };
        for (k, one) in of_set.iter().enumerate() {
            against.iter().for_each(|other| look(one, other));
            of_set[k + 1..].iter().filter(|_| among).for_each(|other| look(one, other));
        }
        found
    }

    /// All that is in no set, where it is.
    fn others(&self, set: &[usize]) -> Vec<(usize, Pose)> {
        (0..self.objects.len()).filter(|k| !set.contains(k)).map(|k| (k, self.objects[k].pose)).collect()
    }
}

fn square_distance(a: &[Vector], pose_a: &Pose, b: &[Vector], pose_b: &Pose) -> RBig {
    let [a, b]: [Vec<[f64; 3]>; 2] = [a, b].map(|points| points.iter().map(|p| (*p).into()).collect());
    let poses = std::array::from_fn(|k| [pose_a, pose_b][k / 12].rows[k % 12 / 4][k % 4]);
    let placed = place(&a, &b, &poses);
    nearest(&placed).world_square(&placed)
}

fn square(x: f64) -> RBig {
    rational(x) * rational(x)
}

/// Some of the objects, and where a question has them.
fn choose(random: &mut Random, world: &World, most: usize) -> (Vec<usize>, Option<Vec<Pose>>) {
    let mut chosen: Vec<usize> = (0..1 + random.below(most)).map(|_| random.below(world.objects.len())).collect();
    chosen.sort_unstable();
    chosen.dedup();
    let poses = (random.below(2) == 0).then(|| chosen.iter().map(|_| pose_in(random, world.size)).collect());
    (chosen, poses)
}

fn placed(world: &World, chosen: &[usize], poses: &Option<Vec<Pose>>) -> Vec<(usize, Pose)> {
    let pose = |k: usize| poses.as_ref().map_or(world.objects[chosen[k]].pose, |poses| poses[k]);
    (0..chosen.len()).map(|k| (chosen[k], pose(k))).collect()
}

fn ids(world: &World, chosen: &[usize]) -> Vec<ObjectId> {
    chosen.iter().map(|k| world.objects[*k].id).collect()
}

#[test]
fn the_least_distance_is_that_of_integers() {
    let mut random = Random::new(0x5e7);
    let (mut scratch, mut counts) = (SetScratch::default(), [0; 3]);
    for round in 0..10 {
        let mut world = World::new(&mut random, 20, if round % 2 == 0 { 8.0 } else { 2.5 });
        if round % 3 == 2 {
            world.filter(3);
        }
        for _ in 0..20 {
            world.stir(&mut random);
            let (chosen, poses) = choose(&mut random, &world, 4);
            let (second, second_poses) = choose(&mut random, &world, 6);
            let (against_set, among) = (random.below(3) == 0, random.below(2) == 0);
            let max_distance = random.pick(&[f64::INFINITY, f64::INFINITY, 1.0, 0.0]);
            let of_set = placed(&world, &chosen, &poses);
            let against = if against_set { placed(&world, &second, &second_poses) } else { world.others(&chosen) };
            let moved = poses.is_some() || (against_set && second_poses.is_some());
            let squares = world.squares(&of_set, &against, among, moved);
            let (first_ids, second_ids) = (ids(&world, &chosen), ids(&world, &second));
            let set = ObjectSet { ids: &first_ids, poses: poses.as_deref(), among };
            let other = ObjectSet { ids: &second_ids, poses: second_poses.as_deref(), among: false };
            let answer =
                world.scene.least_distance(&set, against_set.then_some(&other), max_distance, &mut scratch).unwrap();
            let least = squares.iter().map(|(.., square)| square).min();
            let told = format!("{answer:?} {least:?} {max_distance}");
            match least {
                Some(least) if max_distance == f64::INFINITY || *least <= square(max_distance) => {
                    counts[usize::from(least.is_zero())] += 1;
                    assert!(
                        answer.lower >= 0.0 && square(answer.lower) <= *least && *least <= square(answer.upper),
                        "{told}"
                    );
                    assert!(answer.upper - answer.lower <= 1e-12 && (answer.upper == 0.0) == least.is_zero(), "{told}");
                    let nearest = &answer.nearest;
                    let is_it = |(a, b, square_of): &(ObjectId, ObjectId, RBig)| {
                        (*a, *b) == (nearest.object1, nearest.object2) && *square_of <= square(answer.upper)
                    };
                    assert!(squares.iter().any(is_it), "{told}");
                }
                _ => {
                    counts[2] += 1;
                    assert_eq!((answer.lower, answer.upper), (max_distance, f64::INFINITY), "{told}");
                    assert_eq!(answer.nearest.object1, ObjectId::NULL, "{told}");
                }
            }
        }
    }
    assert!(counts.iter().all(|&count| count > 10), "{counts:?}");
}

#[test]
fn the_first_hit_is_that_of_integers() {
    let mut random = Random::new(0x417);
    let (mut scratch, mut hits) = (SetScratch::default(), [0; 2]);
    for round in 0..8 {
        let mut world = World::new(&mut random, 14, if round % 2 == 0 { 8.0 } else { 3.0 });
        if round % 3 == 2 {
            world.filter(4);
        }
        for _ in 0..6 {
            world.stir(&mut random);
            let (chosen, _) = choose(&mut random, &world, 2);
            let (times, among) = (6, random.below(2) == 0);
            let max_distance = random.pick(&[0.0, 0.25]);
            let poses: Vec<Pose> = (0..times * chosen.len()).map(|_| pose_in(&mut random, world.size)).collect();
            let others = world.others(&chosen);
            let does_hit: Vec<bool> = poses
                .chunks(chosen.len())
                .map(|poses| {
                    let squares = world.squares(&placed(&world, &chosen, &Some(poses.to_vec())), &others, among, true);
                    squares.iter().any(|(.., of_pair)| *of_pair <= square(max_distance))
                })
                .collect();
            let ids = ids(&world, &chosen);
            let set = ObjectSet { ids: &ids, poses: None, among };
            let first = does_hit.iter().position(|hit| *hit).unwrap_or(times);
            let in_order = world.scene.first_hit(&set, &poses, PoseOrder::InOrder, max_distance, &mut scratch).unwrap();
            assert_eq!((in_order.time, in_order.tried), (first, times.min(first + 1)), "{in_order:?}");
            let any = world.scene.first_hit(&set, &poses, PoseOrder::Bisection, max_distance, &mut scratch).unwrap();
            assert_eq!(any.time < times, first < times, "{any:?}");
            assert!(any.time == times || does_hit[any.time], "{any:?}");
            hits[usize::from(first < times)] += 1;
        }
    }
    assert!(hits.iter().all(|&count| count > 5), "{hits:?}");
}

/// As the pair that is found shows; and no pose of the set is left unseen.
#[test]
fn what_hit_last_is_asked_first() {
    let cube = Arc::new(cuboid([1.0; 3]));
    let mut scene = Scene::new();
    let [_, far] = [0.0, 10.0].map(|x| {
        let options = ObjectOptions { pose: at(x, 0.0, 0.0), ..ObjectOptions::default() };
        scene.add_object(vec![cube.clone()], &options).unwrap()
    });
    let ids = [50.0, 60.0].map(|x| {
        let options = ObjectOptions { pose: at(x, 0.0, 0.0), ..ObjectOptions::default() };
        scene.add_object(vec![cube.clone()], &options).unwrap()
    });
    let mut used = SetScratch::default();
    let ask = |scene: &Scene, xs: [f64; 2], among: bool, scratch: &mut SetScratch| {
        let poses = xs.map(|x| at(x, 0.5, 0.0));
        let set = ObjectSet { ids: &ids, poses: None, among };
        scene.first_hit(&set, &poses, PoseOrder::InOrder, 0.0, scratch).map(|hit| [hit.pair.object1, hit.pair.object2])
    };
    assert_eq!(ask(&scene, [20.0, 10.0], false, &mut used).unwrap(), [ids[1], far]);
    assert_ne!(ask(&scene, [0.0, 10.0], false, &mut SetScratch::default()).unwrap(), [ids[1], far]);
    assert_eq!(ask(&scene, [0.0, 10.0], false, &mut used).unwrap(), [ids[1], far]);
    let refused = ask(&scene, [f64::NAN, 10.0], false, &mut used).unwrap_err();
    assert!(refused.to_string().contains("time 0 of 1: object 0 of 2"), "{refused}");
    // Two of the set: only where they are asked.
    assert_eq!(ask(&scene, [20.0, 20.0], true, &mut used).unwrap(), ids);
    assert_eq!(ask(&scene, [20.0, 20.0], false, &mut used).unwrap(), [ObjectId::NULL; 2]);
    // A scene with fewer rows, and one whose partner is gone.
    assert_eq!(ask(&scene, [20.0, 10.0], false, &mut used).unwrap(), [ids[1], far]);
    let mut small = Scene::new();
    let only = small.add_object(vec![cube.clone()], &ObjectOptions::default()).unwrap();
    let set = ObjectSet { ids: &[only], poses: None, among: false };
    assert_eq!(small.first_hit(&set, &[Pose::IDENTITY], PoseOrder::InOrder, 0.0, &mut used).unwrap().time, 1);
    let set = ObjectSet { ids: &ids[1..], poses: None, among: false };
    let there = [at(10.0, 0.0, 0.0)];
    assert_eq!(scene.first_hit(&set, &there, PoseOrder::InOrder, 0.0, &mut used).unwrap().pair.object2, far);
    scene.remove_object(far).unwrap();
    assert_eq!(scene.first_hit(&set, &there, PoseOrder::InOrder, 0.0, &mut used).unwrap().time, 1);
}

/// Boxes on a lattice, whose faces a ray meets at once, at corners and along edges.
#[test]
fn rays_meet_what_rationals_say() {
    let mut random = Random::new(0x3a7);
    let (mut scratch, mut counts) = (SetScratch::default(), [0; 2]);
    for _ in 0..12 {
        let mut scene = Scene::new();
        let mut bodies = Vec::new();
        for number in 0..12 {
            let points: Vec<Vector> =
                (0..8).map(|k| Vector::new(k as f64 % 2.0, (k / 2) as f64 % 2.0, (k / 4) as f64) * 2.0).collect();
            let pose = match number % 4 {
                3 => Pose::new(&random.rotation(), &(random.vector() * 3.0)),
                _ => Pose::new(&Matrix::identity(), &random.lattice(3)),
            };
            let (fixed, groups) = (number % 2 == 0, 1 << (number % 3));
            let options = ObjectOptions { pose, fixed, groups, user_data: number, ..ObjectOptions::default() };
            scene.add_object(vec![Arc::new(hull(&points))], &options).unwrap();
            bodies.push((points, pose, groups));
        }
        for k in 0..30 {
            if k == 15 {
                scene.prepare().unwrap();
            }
            let origin = random.lattice(5);
            // Anyhow, along the lattice, or at corners and edges of a body.
            let direction = match random.below(4) {
                0 => random.vector(),
                1 => random.lattice(2),
                _ => bodies[random.below(bodies.len())].1.translation() + random.lattice(1) - origin,
            };
            let direction = if direction == Vector::zeros() { Vector::y() } else { direction };
            let t_max = random.pick(&[f64::INFINITY, 4.0, 1.0]);
            let ray = Ray { origin: origin.into(), direction: direction.into(), t_max };
            let mask = random.pick(&[u32::MAX, 3]);
            // Number, where it comes in, where it goes out.
            let mut met: Vec<(u64, RBig, RBig)> = Vec::new();
            for (number, (points, pose, groups)) in (0..).zip(&bodies) {
                if groups & mask != 0
                    && let Some([first, last]) = truth(points, pose, &ray)
                    && last >= RBig::ZERO
                    && (t_max == f64::INFINITY || first <= rational(t_max))
                {
                    met.push((number, first.max(RBig::ZERO), last));
                }
            }
            met.sort_by(|a, b| a.1.cmp(&b.1).then(a.0.cmp(&b.0)));
            let all = scene.cast_ray(&ray, RayHits::All, mask, &mut scratch).unwrap().to_vec();
            let numbers =
                |hits: &[swiftprox::scene::SceneRayHit]| hits.iter().map(|hit| hit.user_data).collect::<Vec<_>>();
            assert_eq!(numbers(&all), met.iter().map(|(number, ..)| *number).collect::<Vec<_>>(), "{ray:?}");
            for (hit, (_, first, last)) in all.iter().zip(&met) {
                let holds = |[low, high]: [f64; 2], t: &RBig| rational(low) <= *t && *t <= rational(high);
                let end = if t_max == f64::INFINITY { last.clone() } else { last.clone().min(rational(t_max)) };
                assert!(holds(hit.answer.entry, first) && holds(hit.answer.exit, &end), "{hit:?}");
            }
            let first = scene.cast_ray(&ray, RayHits::First, mask, &mut scratch).unwrap().to_vec();
            assert_eq!(numbers(&first), numbers(&all[..all.len().min(1)]), "{ray:?}");
            if let (Some(first), Some((_, of_entry, of_exit))) = (first.first(), met.first()) {
                let end = if t_max == f64::INFINITY { of_exit.clone() } else { of_exit.clone().min(rational(t_max)) };
                assert!(rational(first.answer.entry[0]) <= *of_entry && *of_entry <= rational(first.answer.entry[1]));
                assert!(rational(first.answer.exit[0]) <= end && end <= rational(first.answer.exit[1]), "{first:?}");
            }
            let any = scene.cast_ray(&ray, RayHits::Any, mask, &mut scratch).unwrap();
            assert_eq!(any.len(), all.len().min(1));
            assert!(any.iter().all(|hit| hit.answer.outcome != RayOutcome::Miss));
            counts[usize::from(all.len() > 1)] += 1;
        }
    }
    assert!(counts.iter().all(|&count| count > 40), "{counts:?}");
}

/// A motion through the middle of a scene: most meet something.
fn through(random: &mut Random) -> Screw {
    let start = Pose::new(&random.rotation(), &(random.vector() * 9.0));
    let velocity = -2.0 * start.translation() + random.vector();
    Screw { start, centre: random.vector(), velocity, rotation: random.vector() * 2.0 }
}

/// Earliest of all pairs, each cast for itself: the free ones say that nothing was missed, at whatever time.
#[test]
fn casts_end_with_the_earliest_of_all_pairs() {
    let mut random = Random::new(0xca57);
    let (mut scratch, mut counts) = (SetScratch::default(), [0; 2]);
    for round in 0..8 {
        let mut world = World::new(&mut random, 14, 8.0);
        if round % 3 == 2 {
            world.filter(3);
        }
        for _ in 0..6 {
            world.stir(&mut random);
            let (chosen, _) = choose(&mut random, &world, 3);
            let (together, among) = (random.below(2) == 0, random.below(2) == 0);
            let motions: Vec<Motion> =
                (0..if together { 1 } else { chosen.len() }).map(|_| Motion::Screw(through(&mut random))).collect();
            let config = CastConfig { max_distance: random.pick(&[0.0, 0.1]), ..CastConfig::default() };
            let ids = ids(&world, &chosen);
            let set = ObjectSet { ids: &ids, poses: None, among };
            let answer = world.scene.cast(&set, &motions, &config, &mut scratch).unwrap();
            // All pairs, each with its own answer.
            let of = |k: usize| if together { motions[0] } else { motions[k] };
            let mut pairs: Vec<(ObjectId, ObjectId, CastAnswer)> = Vec::new();
            let mut look = |(a, motion_a): (usize, Motion), (b, motion_b): (usize, Motion)| {
                let [a, b] = [&world.objects[a], &world.objects[b]];
                if world.is_tested(a, b, true) {
                    for shape_a in &a.shapes {
                        for shape_b in &b.shapes {
                            let bodies = [
                                Moving { shape: shape_a, motion: &motion_a },
                                Moving { shape: shape_b, motion: &motion_b },
                            ];
                            let mut said = CastAnswer::default();
                            cast(bodies, &mut PairCache::default(), &config, &mut said).unwrap();
                            pairs.push((a.id, b.id, said));
                        }
                    }
                }
            };
            for (k, &a) in chosen.iter().enumerate() {
                for (b, pose) in world.others(&chosen) {
                    look((a, of(k)), (b, Motion::Fixed(pose)));
                }
                for (j, &b) in chosen.iter().enumerate().skip(k + 1).filter(|_| among) {
                    look((a, of(k)), (b, of(j)));
                }
            }
            let met = pairs.iter().filter(|(.., said)| said.outcome != CastOutcome::Free);
            let earliest = met.clone().map(|(.., said)| said.time_lower).fold(1.0, f64::min);
            let certain = met.map(|(.., said)| said.time_upper).fold(f64::INFINITY, f64::min);
            let told = format!("{answer:?} {earliest} {certain}");
            counts[usize::from(certain < f64::INFINITY)] += 1;
            // Two proofs of one time differ by what both are wide.
            assert!((answer.time_lower - earliest).abs() <= 1e-6, "{told}");
            if certain < f64::INFINITY {
                assert_eq!(answer.outcome, CastOutcome::Hit, "{told}");
                assert!(
                    (answer.time_upper - certain).abs() <= 1e-6 && answer.time_lower <= answer.time_upper,
                    "{told}"
                );
                let of_pair = |(a, b, said): &(ObjectId, ObjectId, CastAnswer)| {
                    (*a, *b) == (answer.pair.object1, answer.pair.object2) && said.time_upper <= certain + 2e-6
                };
                assert!(pairs.iter().any(of_pair), "{told}");
            } else if answer.outcome == CastOutcome::Free {
                assert_eq!((answer.time_lower, answer.pair.object1), (1.0, ObjectId::NULL), "{told}");
            }
            let mut batch = [answer; 2];
            let twice: Vec<Motion> = motions.iter().chain(&motions).copied().collect();
            world.scene.cast_batch(&set, &twice, &config, &mut scratch, &mut batch).unwrap();
            for edge in batch {
                assert_eq!(edge.outcome, answer.outcome);
                assert!((edge.time_lower - answer.time_lower).abs() <= 1e-6);
            }
        }
    }
    assert!(counts.iter().all(|&count| count > 3), "{counts:?}");
}

/// A bullet that a hundred samples step over, and a turn whose ends are free.
#[test]
fn what_lies_between_the_ends_is_met() {
    let mut scene = Scene::new();
    let mut add = |half: [f64; 3], pose: Pose, fixed: bool| {
        let options = ObjectOptions { pose, fixed, ..ObjectOptions::default() };
        scene.add_object(vec![Arc::new(cuboid(half))], &options).unwrap()
    };
    let bullet = add([0.01; 3], at(-10.0, 0.0, 0.0), false);
    let plate = add([5e-4, 1.0, 1.0], at(0.0, 0.0, 0.0), true);
    let bar = add([2.0, 0.1, 0.1], at(0.0, 10.0, 0.0), false);
    let post = add([0.1; 3], at(0.0, 11.5, 0.0), true);
    scene.prepare().unwrap();
    let mut scratch = SetScratch::default();
    let mut ask = |id: ObjectId, screw: Screw| {
        let set = ObjectSet { ids: &[id], poses: None, among: false };
        scene.cast(&set, &[Motion::Screw(screw)], &CastConfig::default(), &mut scratch).unwrap()
    };
    let still = Vector::zeros();
    let flight =
        Screw { start: at(-10.0, 0.0, 0.0), centre: still, velocity: Vector::new(20.0, 0.0, 0.0), rotation: still };
    let hit = ask(bullet, flight);
    let time = (10.0 - 0.01 - 5e-4) / 20.0;
    assert_eq!((hit.outcome, hit.pair.object1, hit.pair.object2), (CastOutcome::Hit, bullet, plate));
    assert!(hit.time_lower <= time && time <= hit.time_upper && hit.time_upper - hit.time_lower <= 1.01e-9, "{hit:?}");
    let half_turn = Screw { start: at(0.0, 10.0, 0.0), centre: still, velocity: still, rotation: Vector::z() * 3.0 };
    let hit = ask(bar, half_turn);
    assert_eq!((hit.outcome, hit.pair.object2), (CastOutcome::Hit, post));
    let beside = Screw { start: at(-10.0, 0.0, 1.1), ..flight };
    let free = ask(bullet, beside);
    assert_eq!((free.outcome, free.time_lower, free.pair.object1), (CastOutcome::Free, 1.0, ObjectId::NULL));
}

/// Threads that ask one scene at once get, bit for bit, what one thread gets.
#[test]
fn threads_ask_one_scene_at_once() {
    let mut random = Random::new(0x7d);
    let mut world = World::new(&mut random, 20, 8.0);
    world.filter(5);
    world.scene.prepare().unwrap();
    // Some have escaped since.
    for _ in 0..3 {
        let known = random.below(20);
        world.scene.set_pose(world.objects[known].id, &pose_in(&mut random, 8.0)).unwrap();
    }
    let scene = &world.scene;
    let questions: Vec<(ObjectId, Pose, Screw)> =
        (0..12).map(|k| (world.objects[k].id, pose_in(&mut random, 8.0), through(&mut random))).collect();
    let ask = |(id, pose, screw): &(ObjectId, Pose, Screw)| {
        let mut scratch = SetScratch::default();
        let (ids, poses) = ([*id], [*pose]);
        let set = ObjectSet { ids: &ids, poses: Some(&poses), among: false };
        let ray = Ray { origin: pose.translation().into(), direction: [1.0, 2.0, -1.0], t_max: f64::INFINITY };
        let nearest = scene.least_distance(&set, None, f64::INFINITY, &mut scratch).unwrap();
        let hit = scene.first_hit(&set, &poses, PoseOrder::Bisection, 0.0, &mut scratch).unwrap();
        let cast = scene.cast(&set, &[Motion::Screw(*screw)], &CastConfig::default(), &mut scratch).unwrap();
        let rays = scene.cast_ray(&ray, RayHits::All, u32::MAX, &mut scratch).unwrap();
        // As text, since NaN is not equal to itself.
        format!("{nearest:?} {hit:?} {cast:?} {rays:?}")
    };
    let alone: Vec<String> = questions.iter().map(ask).collect();
    let start = Barrier::new(4);
    std::thread::scope(|threads| {
        for thread in 0..4 {
            let (questions, alone, start, ask) = (&questions, &alone, &start, &ask);
            threads.spawn(move || {
                start.wait();
                for k in (thread..questions.len()).chain(0..thread) {
                    assert_eq!(ask(&questions[k]), alone[k]);
                }
            });
        }
    });
}

#[test]
fn what_is_refused_says_why() {
    let mut random = Random::new(0xbad);
    let world = World::new(&mut random, 3, 8.0);
    let (scene, mut scratch) = (&world.scene, SetScratch::default());
    let ids = ids(&world, &[0, 1]);
    let set = ObjectSet { ids: &ids, poses: None, among: false };
    let nowhere = at(f64::NAN, 0.0, 0.0);
    let config = CastConfig::default();
    let stray = ObjectSet { ids: &[ids[0], ObjectId::NULL], ..set };
    let lost = [at(0.0, 0.0, 0.0), nowhere];
    let still = [Motion::Fixed(Pose::IDENTITY); 3];
    let ray = Ray { origin: [0.0; 3], direction: [0.0; 3], t_max: 1.0 };
    for (error, named) in [
        (
            scene.least_distance(&stray, None, 1.0, &mut scratch).unwrap_err(),
            "object 1 of 2 of the set: the object id is null",
        ),
        (scene.least_distance(&set, None, -1.0, &mut scratch).unwrap_err(), "max_distance"),
        (
            scene.least_distance(&ObjectSet { poses: Some(&lost[..1]), ..set }, None, 1.0, &mut scratch).unwrap_err(),
            "1 poses for a set of 2",
        ),
        (
            scene.least_distance(&ObjectSet { poses: Some(&lost), ..set }, None, 1.0, &mut scratch).unwrap_err(),
            "object 1 of 2 of the set",
        ),
        (
            scene.first_hit(&set, &lost[..1], PoseOrder::InOrder, 0.0, &mut scratch).unwrap_err(),
            "1 poses for a set of 2 objects",
        ),
        (scene.first_hit(&set, &lost, PoseOrder::InOrder, f64::NAN, &mut scratch).unwrap_err(), "max_distance"),
        (
            scene.first_hit(&set, &lost, PoseOrder::InOrder, 0.0, &mut scratch).unwrap_err(),
            "time 0 of 1: object 1 of 2",
        ),
        (scene.cast(&set, &still, &config, &mut scratch).unwrap_err(), "3 motions for a set of 2"),
        (scene.cast(&stray, &still[..1], &config, &mut scratch).unwrap_err(), "object 1 of 2 of the set"),
        (scene.cast(&set, &[Motion::Fixed(nowhere)], &config, &mut scratch).unwrap_err(), "object 0 of 2 of the set"),
        (
            scene.cast(&set, &still[..1], &CastConfig { max_distance: -1.0, ..config }, &mut scratch).unwrap_err(),
            "max_distance",
        ),
        (
            scene.cast_batch(&set, &still, &config, &mut scratch, &mut [Default::default(); 2]).unwrap_err(),
            "3 motions for 2 edges",
        ),
        (scene.cast_ray(&ray, RayHits::All, 1, &mut scratch).unwrap_err(), "direction"),
    ] {
        let kind_fits = match named {
            "object 1 of 2 of the set" | "object 0 of 2 of the set" => {
                matches!(error, Error::Pose(_) | Error::Handle(_))
            }
            _ => true,
        };
        assert!(kind_fits && error.message().contains(named), "{named}: {error:?}");
    }
}

/// A program with a broad phase of its own says which pairs there are; two fixed objects make one only if the question moves one.
#[test]
fn given_pairs_and_fixed_objects_are_heeded() {
    let mut scene = Scene::new();
    let cube = Arc::new(cuboid([0.5; 3]));
    let [near, middle, far] = [0.0, 3.0, 10.0].map(|x| {
        let options = ObjectOptions { pose: at(x, 0.0, 0.0), fixed: x > 0.0, ..ObjectOptions::default() };
        scene.add_object(vec![cube.clone()], &options).unwrap()
    });
    let mut scratch = SetScratch::default();
    let mut nearest = |scene: &Scene, id: ObjectId, pose: Option<Pose>| {
        let poses = pose.map(|pose| [pose]);
        let set = ObjectSet { ids: &[id], poses: poses.as_ref().map(|poses| &poses[..]), among: false };
        scene.least_distance(&set, None, f64::INFINITY, &mut scratch).unwrap().nearest.object2
    };
    assert_eq!(nearest(&scene, near, None), middle);
    assert_eq!(nearest(&scene, far, None), near);
    assert_eq!(nearest(&scene, far, Some(at(9.0, 0.0, 0.0))), middle);
    scene.set_pairs(Some(&[[far, near]])).unwrap();
    for prepared in [false, true] {
        if prepared {
            scene.prepare().unwrap();
        }
        assert_eq!(nearest(&scene, near, None), far);
        assert_eq!(nearest(&scene, middle, Some(at(3.0, 0.0, 0.0))), ObjectId::NULL);
    }
    scene.set_pairs(None).unwrap();
    assert_eq!(nearest(&scene, near, None), middle);
}
