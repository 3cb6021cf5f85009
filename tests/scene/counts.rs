//! How much is asked for questions about sets, counted: by the calls of the filter, one before each pair that is asked about, and
//! by the times that were tried.

use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};

use swiftprox::math::{Pose, Vector};
use swiftprox::motion::{CastConfig, CastOutcome, Motion, Screw};
use swiftprox::object::{ObjectId, ObjectOptions};
use swiftprox::scene::{ObjectSet, PairFilter, PoseOrder, Scene, SetScratch};
use testkit::random::Random;
use testkit::shapes::cuboid;

/// Of the links of an arm, and of the bodies around it, on average 4 apart.
const LINKS: usize = 7;
const BODIES: usize = 2000;
const SIZE: f64 = 25.0;

/// A scene whose filter counts.
struct Counted {
    scene: Scene,
    links: Vec<ObjectId>,
    asked: Arc<AtomicUsize>,
}

impl Counted {
    fn new(random: &mut Random) -> Counted {
        let mut scene = Scene::new();
        let cube = Arc::new(cuboid([0.5; 3]));
        let mut add = |pose: Pose| {
            scene.add_object(vec![cube.clone()], &ObjectOptions { pose, ..ObjectOptions::default() }).unwrap()
        };
        let links = (0..LINKS).map(|k| add(Pose::new(&random.rotation(), &(Vector::x() * k as f64)))).collect();
        for _ in 0..BODIES {
            add(Pose::new(&random.rotation(), &(random.vector() * SIZE)));
        }
        let asked = Arc::new(AtomicUsize::new(0));
        let counter = asked.clone();
        scene.set_pair_filter(Some(PairFilter::new(move |_, _| {
            counter.fetch_add(1, Ordering::Relaxed);
            true
        })));
        Counted { scene, links, asked }
    }

    /// How many pairs a question asks about.
    fn count<T>(&self, question: impl FnOnce(&Scene, &ObjectSet) -> T) -> (usize, T) {
        let before = self.asked.load(Ordering::Relaxed);
        let said = question(&self.scene, &ObjectSet { ids: &self.links, poses: None, among: false });
        (self.asked.load(Ordering::Relaxed) - before, said)
    }
}

/// Of 14,000 pairs a few are asked about, whether trees are there or not.
#[test]
fn the_least_distance_asks_about_few_pairs() {
    let mut random = Random::new(0xc0);
    let mut counted = Counted::new(&mut random);
    let mut scratch = SetScratch::default();
    for is_prepared in [false, true] {
        if is_prepared {
            counted.scene.prepare().unwrap();
        }
        let (pairs, said) =
            counted.count(|scene, set| scene.least_distance(set, None, f64::INFINITY, &mut scratch).unwrap());
        assert!(said.upper < f64::INFINITY && pairs <= 3 * LINKS, "{pairs} pairs asked");
    }
}

/// Where half of the times hit, bisection tries few; and of each time few pairs are asked about.
#[test]
fn a_first_hit_tries_few_times() {
    const TIMES: usize = 1024;
    let mut random = Random::new(0xf1);
    let mut counted = Counted::new(&mut random);
    counted.scene.prepare().unwrap();
    // From far above straight down, through the bodies in the second half.
    let poses: Vec<Pose> = (0..TIMES * LINKS)
        .map(|k| {
            let height = 2.0 * SIZE * (1.0 - (k / LINKS) as f64 / TIMES as f64) + 2.0;
            Pose::new(&random.rotation(), &Vector::new((k % LINKS) as f64, 0.0, height))
        })
        .collect();
    let mut scratch = SetScratch::default();
    let mut ask =
        |order: PoseOrder| counted.count(|scene, set| scene.first_hit(set, &poses, order, 0.0, &mut scratch).unwrap());
    let (pairs, hit) = ask(PoseOrder::Bisection);
    assert!(hit.time < TIMES && hit.tried <= 8 && pairs <= 4 * hit.tried, "{pairs} pairs, {hit:?}");
    let (pairs, first) = ask(PoseOrder::InOrder);
    assert!(
        first.time >= TIMES / 4 && first.tried == first.time + 1 && pairs <= first.tried,
        "{pairs} pairs, {first:?}"
    );
}

/// A cast through the crowd asks about the bodies along its way, and about none behind the first contact.
#[test]
fn a_cast_asks_about_the_bodies_on_its_way() {
    let mut random = Random::new(0xca);
    let mut counted = Counted::new(&mut random);
    counted.scene.prepare().unwrap();
    let mut scratch = SetScratch::default();
    let mut hits = 0;
    for _ in 0..20 {
        let start = Pose::new(&random.rotation(), &(random.direction() * 2.0 * SIZE));
        let velocity = random.vector() * 10.0 - start.translation() * 2.0;
        let screw = Screw { start, centre: Vector::zeros(), velocity, rotation: random.vector() };
        let (pairs, said) = counted.count(|scene, set| {
            let one = ObjectSet { ids: &set.ids[..1], ..*set };
            scene.cast(&one, &[Motion::Screw(screw)], &CastConfig::default(), &mut scratch).unwrap()
        });
        hits += usize::from(said.outcome == CastOutcome::Hit);
        assert!(pairs <= 60, "{pairs} pairs, {said:?}");
    }
    assert!(hits > 5, "{hits}");
}
