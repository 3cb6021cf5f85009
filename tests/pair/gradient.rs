//! Gradients against central differences of intervals, where they exist; against one-sided ones, where they do not.

use swiftprox::error::Error;
use swiftprox::math::{Pose, Vector};
use swiftprox::pair::{
    DepthAnswer, DepthCache, DepthConfig, Gradient, Outcome, PairAnswer, PairCache, PairConfig, Placed, SignedDistance,
    SignedDistanceCache, depth, distance, gradient, signed_distance,
};
use swiftprox::shape::{InputPolicy, Shape, ShapeOptions};
use testkit::random::{Random, rotation};
use testkit::shapes::{at, cuboid, lattice_box};

fn ask(bodies: [Placed; 2]) -> SignedDistance {
    let mut answer = SignedDistance::default();
    signed_distance(bodies, &mut SignedDistanceCache::default(), &PairConfig::default(), &mut answer).unwrap();
    answer
}

/// A pose after moving by a twist about a point.
fn moved(pose: &Pose, about: &Vector, twist: &[f64; 6], by: f64) -> Pose {
    let [linear, angular] = [0, 3].map(|k| Vector::new(twist[k], twist[k + 1], twist[k + 2]) * by);
    let turn = if angular == Vector::zeros() {
        swiftprox::math::Matrix::identity()
    } else {
        rotation(&angular.normalize(), angular.norm())
    };
    Pose::new(&(turn * pose.rotation()), &(about + linear + turn * (pose.translation() - about)))
}

struct Case {
    shapes: [Shape; 2],
    poses: [Pose; 2],
    /// Where both turn.
    about: [Vector; 2],
}

impl Case {
    fn at(&self, twists: &[[f64; 6]; 2], by: f64) -> SignedDistance {
        let poses = [0, 1].map(|i| moved(&self.poses[i], &self.about[i], &twists[i], by));
        ask([self.shapes[0].at(&poses[0]), self.shapes[1].at(&poses[1])])
    }

    fn gradient(&self, answer: &SignedDistance) -> Gradient {
        let bodies = [self.shapes[0].at(&self.poses[0]), self.shapes[1].at(&self.poses[1])];
        gradient(bodies, answer, self.about.map(|about| Some(about.into()))).unwrap()
    }
}

fn product(gradient: &Gradient, twists: &[[f64; 6]; 2]) -> f64 {
    let each = [gradient.object1, gradient.object2];
    each.as_flattened().iter().zip(twists.as_flattened()).map(|(a, b)| a * b).sum()
}

fn any_twists(random: &mut Random) -> [[f64; 6]; 2] {
    [(); 2].map(|()| [(); 6].map(|()| random.signed()))
}

fn body(random: &mut Random, kind: usize) -> Shape {
    let swept = |points: &[Vector], swept_radius: f64| {
        let options = ShapeOptions { input: InputPolicy::Hull, swept_radius, ..ShapeOptions::default() };
        Shape::from_points(points, &options).unwrap()
    };
    let cloud = |random: &mut Random, count: usize| (0..count).map(|_| random.vector()).collect::<Vec<_>>();
    match kind % 5 {
        0 => cuboid([random.uniform(0.3, 1.0), random.uniform(0.3, 1.0), random.uniform(0.3, 1.0)]),
        1 => swept(&cloud(random, 20), 0.0),
        2 => swept(&cloud(random, 2), random.uniform(0.1, 0.5)),
        3 => swept(&lattice_box([0.5; 3], 2), 0.2),
        _ => swept(&cloud(random, 1), random.uniform(0.2, 0.6)),
    }
}

/// Boxes, hulls, capsules, rounded boxes and balls, apart and in each other, about any reference points. Differences over h and h/2
/// that are not the same within 1e-6 straddle an edge of the function; they are rare.
#[test]
fn gradients_are_what_differences_of_intervals_say() {
    let mut random = Random::new(0x66ad);
    let (mut compared, mut skipped, mut worst) = ([0; 2], 0, [0.0_f64; 2]);
    for round in 0..1_500 {
        let shapes = [body(&mut random, round), body(&mut random, round / 5)];
        let apart = random.direction() * random.pick(&[0.2, 0.7, 1.5, 3.0, 5.0]);
        let far = random.vector() * random.pick(&[0.0, 10.0]);
        let poses = [Pose::new(&random.rotation(), &(far + apart)), Pose::new(&random.rotation(), &far)];
        let about = poses.map(|pose| pose.translation() + random.vector());
        let case = Case { shapes, poses, about };
        let answer = case.at(&[[0.0; 6]; 2], 0.0);
        let found = case.gradient(&answer);
        let twists = any_twists(&mut random);
        // Bounds of the quotient, by the ends of the intervals.
        let quotient = |h: f64| {
            let [before, after] = [case.at(&twists, -h), case.at(&twists, h)];
            [(after.lower - before.upper) / (2.0 * h), (after.upper - before.lower) / (2.0 * h)]
        };
        let ([low, high], [low2, high2]) = (quotient(1e-4), quotient(5e-5));
        let off = |x: f64, low: f64, high: f64| (low - x).max(x - high).max(0.0);
        if off(low2, low, high) > 1e-6 || off(high2, low, high) > 1e-6 || answer.distance.abs() < 1e-3 {
            skipped += 1;
            continue;
        }
        let side = usize::from(answer.outcome == Outcome::Intersecting);
        let error = off(product(&found, &twists), low2, high2);
        worst[side] = worst[side].max(error);
        compared[side] += 1;
        assert!(found.is_unique == 1, "{round}: {answer:?}");
        assert!(error < 2e-6, "{round}: {error:e} {found:?} {answer:?}");
    }
    println!("{compared:?} compared, worst {worst:?}, {skipped} skipped");
    assert!(compared.iter().all(|&count| count > 300) && skipped < 150, "{compared:?} {skipped}");
}

/// Boxes face to face and edge beside edge, apart and in each other: not unique. Along no motion the distance grows faster than the
/// numbers say, and along some it grows slower by far. A tilt of 1e-4 makes it unique.
#[test]
fn where_faces_and_edges_are_parallel_the_gradient_is_above() {
    let mut random = Random::new(0x66ae);
    let mut slower = 0;
    for round in 0..200 {
        let edges_up = rotation(&Vector::x(), std::f64::consts::FRAC_PI_4);
        let shapes = [cuboid([1.0, 0.5, 0.5]), cuboid([2.0, 2.0, 1.0])];
        let (turn, rest) = if round % 2 == 0 {
            (rotation(&Vector::z(), random.signed()), 1.5)
        } else {
            (edges_up, 1.0 + 0.5_f64.sqrt())
        };
        let gap = random.pick(&[-0.05, 0.1, 1.0]);
        let frame = random.rotation();
        let poses = [
            Pose::new(&(frame * turn), &(frame * Vector::new(0.3, 0.2, rest + gap))),
            Pose::new(&frame, &Vector::zeros()),
        ];
        let about = poses.map(|pose| pose.translation());
        let case = Case { shapes, poses, about };
        let answer = case.at(&[[0.0; 6]; 2], 0.0);
        let found = case.gradient(&answer);
        assert_eq!(found.is_unique, 0, "{round} {answer:?}");
        for _ in 0..10 {
            let (twists, h) = (any_twists(&mut random), 1e-5);
            let grown = (case.at(&twists, h).upper - answer.lower) / h;
            let said = product(&found, &twists);
            assert!(grown <= said + 1e-3, "{round} {grown} {said}");
            slower += usize::from(grown < said - 0.05);
        }
        let axis = case.poses[0].rotation() * Vector::y();
        let tilted = Pose::new(&(rotation(&axis, 1e-4) * case.poses[0].rotation()), &case.poses[0].translation());
        let case = Case { poses: [tilted, case.poses[1]], ..case };
        let answer = case.at(&[[0.0; 6]; 2], 0.0);
        if round % 2 == 1 {
            assert_eq!(case.gradient(&answer).is_unique, 1, "{round} {answer:?}");
        }
    }
    assert!(slower > 500, "{slower}");
}

/// Closed form: a ball beside a box, apart and in it, turned about a point 3 above its centre.
#[test]
fn gradients_that_are_known() {
    let options = ShapeOptions { input: InputPolicy::Hull, swept_radius: 0.5, ..ShapeOptions::default() };
    let ball = Shape::from_points(&[Vector::zeros()], &options).unwrap();
    let cube = cuboid([1.0; 3]);
    for (x, sign) in [(2.0, 1.0), (1.25, 1.0), (0.75, 1.0)] {
        let poses = [at(x, 0.0, 0.0), Pose::IDENTITY];
        let bodies = [ball.at(&poses[0]), cube.at(&poses[1])];
        let answer = ask(bodies);
        assert!((answer.distance - (x - 1.5)).abs() < 1e-12);
        let found = gradient(bodies, &answer, [Some([x, 0.0, 3.0]), None]).unwrap();
        // (x − r) × n = (·, 0, −3) × (1, 0, 0) = (0, −3, 0).
        assert_eq!((found.object1, found.is_unique), ([sign, 0.0, 0.0, 0.0, -3.0, 0.0], 1));
        assert_eq!(found.object2[..3], [-sign, 0.0, 0.0]);
        // The same from a distance, or from a depth.
        let again = if answer.outcome == Outcome::Separated {
            let mut apart = PairAnswer::default();
            distance(bodies, &mut PairCache::default(), &PairConfig::default(), &mut apart).unwrap();
            SignedDistance::from(&apart)
        } else {
            let mut deep = DepthAnswer::default();
            depth(bodies, &mut DepthCache::default(), &DepthConfig::default(), &mut deep).unwrap();
            SignedDistance::from(&deep)
        };
        assert_eq!(gradient(bodies, &again, [Some([x, 0.0, 3.0]), None]).unwrap().object1, found.object1);
    }
}

#[test]
fn what_has_no_gradient_is_refused() {
    let cube = cuboid([1.0; 3]);
    let poses = [at(5.0, 0.0, 0.0), Pose::IDENTITY];
    let bodies = [cube.at(&poses[0]), cube.at(&poses[1])];
    let answer = ask(bodies);
    let refused = |answer: &SignedDistance, references| match gradient(bodies, answer, references).unwrap_err() {
        Error::Argument(message) => message,
        error => panic!("{error}"),
    };
    let mut near = PairAnswer::default();
    let config = PairConfig { max_distance: 1.0, ..PairConfig::default() };
    distance(bodies, &mut PairCache::default(), &config, &mut near).unwrap();
    assert_eq!(near.outcome, Outcome::Beyond);
    assert!(refused(&SignedDistance::from(&near), [None; 2]).contains("normal"));
    assert!(refused(&SignedDistance::default(), [None; 2]).contains("normal"));
    assert!(refused(&answer, [None, Some([0.0, f64::NAN, 0.0])]).contains("reference2"));
}
