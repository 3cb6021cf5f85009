//! Every kind of query of every kind of body, as text: all digits of all members of all answers.

use std::fmt::{self, Debug, Write};

use swiftprox::ground::{Ground, GroundContacts, HeightGrid, ground_cast, ground_contacts};
use swiftprox::hierarchy::{HierarchyKind, HierarchyOptions};
use swiftprox::manifold::{ManifoldCache, ManifoldConfig, ManifoldPoint, manifold_with_distance};
use swiftprox::math::{Pose, Vector};
use swiftprox::motion::{CastAnswer, CastConfig, Motion, Moving, Screw, cast};
use swiftprox::pair::{
    self, DepthAnswer, DepthCache, DepthConfig, Levels, Outcome, PairAnswer, PairCache, PairConfig, SignedDistance,
    SignedDistanceCache,
};
use swiftprox::point::{locate_point, support};
use swiftprox::ray::{Ray, cast_ray};
use swiftprox::shape::{InputPolicy, Shape, ShapeOptions};
use testkit::random::Random;

use crate::Hash;
use crate::flight::{Flyer, in_ball};

const STEPS: usize = 145;

/// What all answers are.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Digits {
    pub answers: usize,
    pub verdicts: Hash,
    pub all: Hash,
    /// The same for each kind of query: where they differ one sees which.
    kinds: [Hash; KINDS],
}

const KINDS: usize = 10;

impl Write for Hash {
    fn write_str(&mut self, text: &str) -> fmt::Result {
        text.bytes().for_each(|byte| self.add_byte(byte));
        Ok(())
    }
}

impl Digits {
    fn add(&mut self, kind: usize, answer: &dyn Debug) {
        self.answers += 1;
        write!(self.all, "{answer:?}").unwrap();
        write!(self.kinds[kind], "{answer:?}").unwrap();
    }

    pub fn of_all() -> Digits {
        let mut digits = Digits { answers: 0, verdicts: Hash::EMPTY, all: Hash::EMPTY, kinds: [Hash::EMPTY; KINDS] };
        let bodies = bodies();
        let mut random = Random::new(49);
        for first in 0..bodies.len() {
            for second in first + 1..bodies.len() {
                digits.add_pair([&bodies[first], &bodies[second]], &mut random);
            }
        }
        let ground = hills(&mut random);
        for body in &bodies {
            digits.add_alone(body, &ground, &mut random);
        }
        digits
    }

    /// All queries of a pair, with caches that go on and cold ones.
    fn add_pair(&mut self, [a, b]: [&Body; 2], random: &mut Random) {
        let mut flyers = [Flyer::new(random), Flyer::new(random)];
        let mut pair_cache = PairCache::default();
        let mut signed_cache = SignedDistanceCache::default();
        let (mut depth_cache, mut manifold_cache) = (DepthCache::default(), ManifoldCache::default());
        let mut points = [ManifoldPoint::default(); 64];
        let config = PairConfig { max_distance: 0.8, ..PairConfig::default() };
        let coarse = PairConfig { relative_error: 0.01, levels: Levels::All, ..PairConfig::default() };
        for step in 0..STEPS {
            let poses = flyers.each_ref().map(Flyer::pose);
            let placed = [a.shape.at(&poses[0]), b.shape.at(&poses[1])];
            let mut answer = PairAnswer::default();
            pair::distance(placed, &mut pair_cache, &config, &mut answer).unwrap();
            self.add(0, &answer);
            self.add_verdict([a, b], answer.outcome);
            pair::intersection(placed, &mut PairCache::default(), &PairConfig::default(), &mut answer).unwrap();
            self.add(1, &answer);
            self.add_verdict([a, b], answer.outcome);
            pair::approximate(placed, &mut pair_cache, &coarse, &mut answer).unwrap();
            self.add(2, &answer);
            let mut signed = SignedDistance::default();
            pair::signed_distance(placed, &mut signed_cache, &config, &mut signed).unwrap();
            self.add(3, &signed);
            let mut depth = DepthAnswer::default();
            pair::depth(placed, &mut depth_cache, &DepthConfig::default(), &mut depth).unwrap();
            self.add(4, &depth);
            let config = ManifoldConfig { max_distance: 0.1, reduces: step % 3 == 0 };
            let found = manifold_with_distance(placed, &mut manifold_cache, &config, &mut points).unwrap();
            self.add(5, &(found, &points[..found.0.point_count as usize]));
            if step % 8 == 0 {
                let motions = poses.map(|pose| motion(pose, random));
                let [first, second] = &motions;
                let moving = [Moving { shape: &a.shape, motion: first }, Moving { shape: &b.shape, motion: second }];
                let mut answer = CastAnswer::default();
                let config = CastConfig { time_tolerance: 1e-6, ..CastConfig::default() };
                cast(moving, &mut pair_cache, &config, &mut answer).unwrap();
                self.add(6, &answer);
            }
            flyers.iter_mut().for_each(|flyer| flyer.step(random));
        }
    }

    /// Rays, points, support vertices, and contacts with a ground.
    fn add_alone(&mut self, body: &Body, ground: &Ground, random: &mut Random) {
        let mut flyer = Flyer::new(random);
        for _ in 0..STEPS {
            let pose = flyer.pose();
            let placed = body.shape.at(&pose);
            let origin = random.vector() * 3.0;
            let towards = pose.translation() + random.vector() * 0.5 - origin;
            let ray = Ray { origin: origin.into(), direction: towards.into(), t_max: f64::INFINITY };
            let answer = cast_ray(placed, &ray).unwrap();
            self.add(7, &answer);
            let point = locate_point(placed, (origin + 0.9 * towards).into()).unwrap();
            self.add(8, &point);
            if !body.is_curved {
                self.verdicts.add(answer.outcome as u64);
                self.verdicts.add(point.location as u64);
            }
            self.add(8, &support(placed, towards.into()).unwrap());
            if !body.is_curved {
                self.add_ground(&body.shape, pose, ground, random);
            }
            flyer.step(random);
        }
    }

    fn add_ground(&mut self, shape: &Shape, pose: Pose, ground: &Ground, random: &mut Random) {
        let ground = ground.at(&Pose::IDENTITY);
        let mut found = GroundContacts::default();
        let config = ManifoldConfig { max_distance: 0.05, reduces: random.below(2) == 0 };
        ground_contacts(shape.at(&pose), ground, &config, &mut found).unwrap();
        self.add(9, &(&found.contacts, &found.points));
        if random.below(8) == 0 {
            let motion = motion(pose, random);
            self.add(6, &ground_cast(Moving { shape, motion: &motion }, ground, &CastConfig::default()).unwrap());
        }
    }

    /// Where a deviation hides the verdict, rounding has a say.
    fn add_verdict(&mut self, bodies: [&Body; 2], outcome: Outcome) {
        if bodies.iter().all(|body| !body.is_curved) {
            self.verdicts.add(outcome as u64);
        }
    }
}

struct Body {
    shape: Shape,
    is_curved: bool,
}

/// Hulls with few and many vertices, levels, tables and faces; flat, thin, large and small ones; round ones; curved ones.
fn bodies() -> Vec<Body> {
    let mut random = Random::new(4);
    let mut hull = |count: usize, half_axes: [f64; 3], kind, swept_radius| {
        let half_axes = Vector::from(half_axes);
        let on_ellipsoid = |v: Vector| (v / v.norm()).component_mul(&half_axes);
        let points: Vec<Vector> = (0..count).map(|_| on_ellipsoid(in_ball(&mut random))).collect();
        let hierarchy = HierarchyOptions { kind, minimum_triangles: 20, ..HierarchyOptions::default() };
        let options = ShapeOptions { hierarchy, swept_radius, input: InputPolicy::Hull, ..ShapeOptions::default() };
        Shape::from_points(&points, &options).unwrap()
    };
    let none = HierarchyKind::None;
    let plain = [
        hull(5, [0.7, 0.6, 0.5], none, 0.0),
        hull(20, [0.8, 0.6, 0.6], none, 0.0),
        hull(14, [0.6, 0.6, 0.0], none, 0.0),
        hull(70, [0.9, 0.5, 0.05], none, 0.0),
        hull(150, [0.4, 0.4, 0.4], HierarchyKind::OuterCuts, 0.0),
        hull(500, [1.0, 0.8, 0.6], HierarchyKind::Quadric, 0.0),
        hull(12, [0.3, 0.4, 0.5], none, 0.1),
        Shape::from_box(&Vector::new(0.5, 0.5, 0.5), 0.0).unwrap(),
        Shape::from_box(&Vector::new(0.9, 0.3, 0.02), 0.0).unwrap(),
        Shape::from_box(&Vector::new(0.3, 0.3, 0.4), 0.1).unwrap(),
        Shape::from_sphere(0.6).unwrap(),
        Shape::from_capsule(0.5, 0.2).unwrap(),
    ];
    let curved = [
        Shape::from_cylinder(0.5, 0.4, 0.01).unwrap(),
        Shape::from_cone(0.5, 0.5, 0.01).unwrap(),
        Shape::from_ellipsoid(&Vector::new(0.8, 0.5, 0.3), 0.02).unwrap(),
    ];
    let body = |is_curved: bool| move |shape| Body { shape, is_curved };
    plain.into_iter().map(body(false)).chain(curved.into_iter().map(body(true))).collect()
}

/// A square of hills about the origin.
fn hills(random: &mut Random) -> Ground {
    const SIDE: usize = 24;
    let heights: Vec<f64> = (0..SIDE * SIDE).map(|_| random.uniform(-0.15, 0.15)).collect();
    let grid = HeightGrid { rows: SIDE, columns: SIDE, spacing: [0.4, 0.3], heights: &heights };
    Ground::from_heights(&grid).unwrap()
}

/// It stays, turns, or goes on a line.
fn motion(pose: Pose, random: &mut Random) -> Motion<'static> {
    match random.below(3) {
        0 => Motion::Fixed(pose),
        1 => {
            let end = Pose::new(&pose.rotation(), &(pose.translation() + random.vector()));
            Motion::Affine { start: pose, end }
        }
        _ => Motion::Screw(Screw {
            start: pose,
            centre: random.vector() * 0.2,
            velocity: random.vector() * 2.0,
            rotation: random.vector() * 3.0,
        }),
    }
}
