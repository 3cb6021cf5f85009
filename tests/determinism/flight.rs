//! A flight of eight objects: every query of scenes and of pairs.

use std::sync::Arc;

use swiftprox::hierarchy::{HierarchyKind, HierarchyOptions};
use swiftprox::math::{Matrix, Pose, Vector};
use swiftprox::object::{ObjectId, ObjectOptions};
use swiftprox::pair::{self, Feature, Levels, PairAnswer, PairCache, PairConfig, Refinement, Start};
use swiftprox::scene::{Scene, SceneAnswer, SceneQuery};
use swiftprox::shape::{Shape, ShapeOptions};
use testkit::random::Random;
use testkit::shapes::cuboid;

use crate::Hash;

const STEPS: usize = 150;

impl Hash {
    fn add_answer(&mut self, answer: &PairAnswer) {
        let PairAnswer { distance, lower, upper, local1, local2, world1, world2, normal, statistics, .. } = *answer;
        let numbers = [[distance, lower, upper], local1, local2, world1, world2, normal];
        for number in numbers.iter().flatten() {
            // Machines differ in the bits of a NaN that an operation makes.
            self.add(if number.is_nan() { u64::MAX } else { number.to_bits() });
        }
        for Feature { kind, ids: [first, second] } in [answer.feature1, answer.feature2] {
            [kind as u32, first, second].into_iter().for_each(|number| self.add(number.into()));
        }
        answer.proof.iter().flatten().for_each(|vertex| self.add((*vertex).into()));
        let steps = [statistics.marching_steps, statistics.fallback_iterations, statistics.exact_iterations];
        let levels = statistics.levels.map(u32::from);
        let others = [answer.outcome as u32, answer.decided_by as u32, answer.proof_count];
        steps.iter().chain(&levels).chain(&others).for_each(|number| self.add((*number).into()));
    }
}

/// What a flight found.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Flight {
    pub verdicts: Hash,
    pub bits: Hash,
    /// Answers by their outcome: separated, beyond, intersecting, undecided.
    pub outcomes: [usize; 4],
}

impl Flight {
    /// `is_decided` says that the outcome is the same on every machine: no step budget has a say in it.
    fn add(&mut self, names: [u64; 4], answer: &PairAnswer, is_decided: bool) {
        for name in names {
            self.verdicts.add(name);
            self.bits.add(name);
        }
        if is_decided {
            self.verdicts.add(answer.outcome as u64);
        }
        self.bits.add_answer(answer);
        self.outcomes[answer.outcome as usize - 1] += 1;
    }

    fn add_list(&mut self, answer: SceneAnswer, is_decided: bool) {
        self.verdicts.add(answer.intersecting.into());
        self.verdicts.add(answer.pairs.len() as u64);
        for pair in answer.pairs {
            let pieces = [pair.piece1, pair.piece2].map(u64::from);
            self.add([pair.user_data1, pair.user_data2, pieces[0], pieces[1]], &pair.answer, is_decided);
        }
    }
}

/// Uniform in the unit ball, without its centre.
pub fn in_ball(random: &mut Random) -> Vector {
    loop {
        let v = random.vector();
        if (0.01..1.0).contains(&v.norm_squared()) {
            return v;
        }
    }
}

/// A box, hulls of points in a ball and on a grid, ellipsoids with every kind of levels.
pub fn shapes() -> Vec<Arc<Shape>> {
    let mut random = Random::new(2000);
    let in_a_ball: Vec<Vector> = (0..60).map(|_| in_ball(&mut random)).collect();
    let on_a_grid: Vec<Vector> = (0..40).map(|_| random.lattice(4) * 0.25).collect();
    let shape = |points: &[Vector], kind| {
        let hierarchy = HierarchyOptions { kind, minimum_triangles: 20, ..HierarchyOptions::default() };
        Arc::new(Shape::from_points(points, &ShapeOptions { hierarchy, ..ShapeOptions::default() }).unwrap())
    };
    let mut shapes = vec![
        Arc::new(cuboid([0.4, 0.9, 0.2])),
        shape(&in_a_ball, HierarchyKind::None),
        shape(&on_a_grid, HierarchyKind::None),
    ];
    for (count, half_axes, kind) in [
        (200, [1.0, 1.0, 1.0], HierarchyKind::Quadric),
        (300, [1.0, 1.0, 0.1], HierarchyKind::DobkinKirkpatrick),
        (400, [1.0, 0.1, 0.1], HierarchyKind::OuterCuts),
    ] {
        let half_axes = Vector::from(half_axes);
        let on_ellipsoid = |v: Vector| (v / v.norm()).component_mul(&half_axes);
        let points: Vec<Vector> = (0..count).map(|_| on_ellipsoid(in_ball(&mut random))).collect();
        shapes.push(shape(&points, kind));
    }
    shapes
}

/// The matrix of a quaternion of any length.
fn turned([w, x, y, z]: [f64; 4]) -> Matrix {
    let length = (w * w + x * x + y * y + z * z).sqrt();
    let [w, x, y, z] = [w, x, y, z].map(|part| part / length);
    Matrix::new(
        1.0 - 2.0 * (y * y + z * z),
        2.0 * (x * y - w * z),
        2.0 * (x * z + w * y),
        2.0 * (x * y + w * z),
        1.0 - 2.0 * (x * x + z * z),
        2.0 * (y * z - w * x),
        2.0 * (x * z - w * y),
        2.0 * (y * z + w * x),
        1.0 - 2.0 * (x * x + y * y),
    )
}

/// Something that turns while it flies through the middle and back, and jumps now and then.
pub struct Flyer {
    turn: [f64; 4],
    turning: [f64; 4],
    place: Vector,
    velocity: Vector,
}

impl Flyer {
    pub fn new(random: &mut Random) -> Flyer {
        let four = |random: &mut Random| [1, 2, 3, 4].map(|_| random.signed());
        Flyer {
            turn: four(random),
            turning: four(random).map(|part| 0.03 * part),
            place: random.vector() * 2.0,
            velocity: random.vector() * 0.06,
        }
    }

    pub fn step(&mut self, random: &mut Random) {
        if random.below(50) == 0 {
            *self = Flyer::new(random);
        }
        for (part, by) in self.turn.iter_mut().zip(self.turning) {
            *part += by;
        }
        self.velocity -= 0.002 * self.place;
        self.place += self.velocity;
    }

    pub fn pose(&self) -> Pose {
        Pose::new(&turned(self.turn), &self.place)
    }
}

/// Every query of scenes and of pairs over one flight of eight objects.
pub fn fly(shapes: &[Arc<Shape>]) -> Flight {
    let mut random = Random::new(17);
    let mut flight = Flight { verdicts: Hash::EMPTY, bits: Hash::EMPTY, outcomes: [0; 4] };
    let mut scene = Scene::new();
    let mut flyers: Vec<Flyer> = (0..8).map(|_| Flyer::new(&mut random)).collect();
    let mut ids: Vec<ObjectId> = Vec::new();
    for (k, flyer) in flyers.iter().enumerate() {
        // The last two have two pieces each, the same ones.
        let mut pieces = vec![shapes[k % shapes.len()].clone()];
        pieces.extend((k >= shapes.len()).then(|| shapes[2].clone()));
        let options = ObjectOptions { pose: flyer.pose(), user_data: 100 + k as u64, ..ObjectOptions::default() };
        ids.push(scene.add_object(pieces, &options).unwrap());
    }
    let mut caches = vec![PairCache::default(); shapes.len()];
    for step in 0..STEPS {
        if step == STEPS / 2 {
            scene.set_pair_active(ids[1], ids[4], false).unwrap();
            scene.remove_object(ids.remove(3)).unwrap();
            flyers.remove(3);
        }
        let poses: Vec<Pose> = flyers.iter().map(Flyer::pose).collect();
        scene.set_all_poses(&poses).unwrap();
        let all = SceneQuery::default();
        let near = SceneQuery { max_distance: 0.3, ..all };
        flight.add_list(scene.query_intersection(&all).unwrap(), true);
        flight.add_list(scene.query_intersection(&SceneQuery { early_exit: true, ..all }).unwrap(), true);
        flight.add_list(scene.query_distance(&near).unwrap(), true);
        flight.add_list(scene.query_distance(&all).unwrap(), true);
        flight.add_list(scene.query_distance(&near).unwrap(), true);
        flight.add_list(scene.query_contact(&near).unwrap(), true);
        let coarse = SceneQuery { absolute_error: 0.05, levels: Levels::All, ..all };
        flight.add_list(scene.query_approximate(&coarse).unwrap(), true);
        let thrifty = SceneQuery { step_budget: 2, start: Start::Cold, refinement: Refinement::SingleSingle, ..coarse };
        flight.add_list(scene.query_approximate(&thrifty).unwrap(), false);

        // Pairs of neighbours, each query with the cache that the last one left.
        for (k, cache) in caches.iter_mut().enumerate() {
            let (a, b) = (&shapes[k], &shapes[(k + 1) % shapes.len()]);
            let [pose1, pose2] = [&poses[k], &poses[(k + 1) % poses.len()]];
            let config =
                PairConfig { max_distance: 0.5, relative_error: 0.01, levels: Levels::All, ..PairConfig::default() };
            for query in [pair::intersection, pair::distance, pair::contact, pair::approximate] {
                let mut answer = PairAnswer::default();
                query([a.at(pose1), b.at(pose2)], cache, &config, &mut answer).unwrap();
                flight.add([step as u64, k as u64, 0, 0], &answer, true);
            }
        }
        flyers.iter_mut().for_each(|flyer| flyer.step(&mut random));
    }
    flight
}
