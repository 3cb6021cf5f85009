//! Small bodies, whose depth all facets of the Minkowski difference tell.

use swiftprox::math::{Matrix, Pose, Vector};
use swiftprox::pair::{DepthAnswer, DepthCache, Outcome};
use swiftprox::shape::Shape;
use swiftprox::verify::verify_depth;

use testkit::models;
use testkit::random::rotation;
use testkit::shapes::{cuboid, hull};

use crate::{Random, query};

fn prism(sides: u32, half_height: f64, turn: &Matrix) -> Shape {
    let points = models::prism(sides, half_height).unwrap().vertices;
    hull(&points.iter().map(|p| turn * p).collect::<Vec<_>>())
}

/// Boxes, a wedge, prisms and hulls, some turned so that rounding leaves their faces uneven.
fn solids(random: &mut Random) -> Vec<Shape> {
    let turn = random.rotation();
    let corner = |i: usize| Vector::from_fn(|k, _| if i >> k & 1 == 0 { -0.5 } else { 0.5 + 0.1 * k as f64 });
    let mut shapes = vec![
        cuboid([0.5, 0.5, 0.5]),
        cuboid([1.0, 0.3, 0.02]),
        hull(&(0..8).map(|i| turn * corner(i)).collect::<Vec<_>>()),
        hull(&(0..6).map(corner).collect::<Vec<_>>()),
    ];
    shapes.extend([3, 8, 16, 32].map(|sides| prism(sides, 0.5, &Matrix::identity())));
    shapes.push(prism(12, 0.5, &turn));
    shapes.extend([4, 12, 20, 32].map(|n| hull(&(0..n).map(|_| random.direction()).collect::<Vec<_>>())));
    shapes
}

/// Checks an answer and that of a query that remembers it, which overlap.
fn check(pair: [&Shape; 2], placed: [&Pose; 2], cache: &mut DepthCache) -> DepthAnswer {
    let cold = query(pair, placed, &mut DepthCache::default());
    let answer = query(pair, placed, cache);
    assert_eq!(answer.outcome, cold.outcome, "{placed:?} {answer:?} {cold:?}");
    assert!(answer.lower <= cold.upper && cold.lower <= answer.upper, "{placed:?} {answer:?} {cold:?}");
    for (answer, cache) in [(&cold, &DepthCache::default()), (&answer, &*cache)] {
        verify_depth([pair[0].at(placed[0]), pair[1].at(placed[1])], cache, answer)
            .unwrap_or_else(|error| panic!("{error}: {placed:?} {answer:?}"));
    }
    cold
}

/// Faces on faces, tilted and yawed down to what rounding makes of that, as deep as 1e-16: ties of corners, parallel edges.
#[test]
fn depths_of_resting_solids_hold() {
    let mut random = Random::new(71);
    let shapes = solids(&mut random);
    let (mut overlapping, mut by_facets) = (0, 0);
    for round in 0..6_000 {
        let pair = [&shapes[round % shapes.len()], &shapes[random.below(shapes.len())]];
        let half = |shape: &Shape| shape.polyhedron().mass.upper.z;
        let tilt = rotation(&random.direction(), random.pick(&[0.0, 0.0, 1.0]) * random.power(-53, -4));
        let yaw = rotation(&Vector::z(), random.pick(&[0.0, 0.0, 0.3, 1.0]) * random.power(-50, 0));
        let sideways = random.vector() * random.pick(&[0.0, 0.0, 1e-9, 0.3]);
        let depth = random.pick(&[1e-16, 1e-14, 1e-12, 1e-9, 1e-6, 1e-3, 0.1]);
        let height = half(pair[0]) - pair[1].polyhedron().mass.lower.z - depth;
        let all = if random.below(2) == 0 { Matrix::identity() } else { random.rotation() };
        let place = |turn: Matrix, at: Vector| Pose::new(&(all * turn), &(all * at));
        let at = Vector::new(sideways.x, sideways.y, height);
        let mut poses = [place(Matrix::identity(), Vector::zeros()), place(tilt * yaw, at)];
        let mut cache = DepthCache::default();
        for _ in 0..2 {
            let answer = check(pair, [&poses[0], &poses[1]], &mut cache);
            overlapping += usize::from(answer.lower > 0.0);
            by_facets += usize::from(answer.lower > 0.0 && answer.statistics.triangles == 0);
            poses[1] = Pose::new(&(rotation(&random.direction(), 1e-3) * poses[1].rotation()), &poses[1].translation());
        }
    }
    println!("{overlapping} overlap, {by_facets} by facets");
    assert!(overlapping > 5_000 && 10 * by_facets > 7 * overlapping, "{overlapping} {by_facets}");
}

/// At any size within the range of double precision's bounds, in skewed poses, far out.
#[test]
fn depths_of_scaled_and_skewed_solids_hold() {
    let mut random = Random::new(72);
    let (mut overlapping, mut by_facets) = (0, 0);
    for round in 0..1_500 {
        let scale = 2.0_f64.powi(random.pick(&[0, 0, 0, 190, -190, 60, -60]));
        let points =
            [(); 2].map(|()| (0..4 + random.below(20)).map(|_| random.direction() * scale).collect::<Vec<_>>());
        let shapes = points.map(|points| hull(&points));
        let skew = if round % 2 == 0 { 0.0 } else { random.power(-50, -9) };
        let far = random.vector() * (scale * random.pick(&[0.0, 0.0, 1e3, 1e6]));
        let poses = [0.0, 1.0].map(|moved| {
            let turn = random.rotation() + Matrix::from_fn(|_, _| random.signed() * skew);
            Pose::new(&turn, &(far + random.direction() * (moved * scale * random.uniform(0.0, 1.5))))
        });
        let answer = check([&shapes[0], &shapes[1]], [&poses[0], &poses[1]], &mut DepthCache::default());
        // Beyond 2^±100 a polytope is searched, of copies.
        let counts = answer.lower > 0.0 && scale.log2().abs() < 100.0;
        overlapping += usize::from(counts);
        by_facets += usize::from(counts && answer.statistics.triangles == 0);
    }
    println!("{overlapping} overlap, {by_facets} by facets");
    assert!(overlapping > 500 && 2 * by_facets > overlapping, "{overlapping} {by_facets}");
}

/// A pyramid, a cone of five sides, a wedge whose side is bent by rounding to single precision: steep faces beside a flat one, or
/// several that are all but one, outweigh what else is at a corner. Cut-off: the mean of a corner's normals, which all of them had
/// to look along, and which the base of a pyramid does not. Such bodies had no fan, and each query searched by a polytope.
#[test]
fn depths_of_solids_with_steep_corners_are_told_by_all_facets() {
    let mut random = Random::new(73);
    let bent = |turn: Matrix| {
        let points = models::prism(3, 0.5).unwrap().vertices;
        hull(&points.iter().map(|p| (turn * p).map(|x| f64::from(x as f32))).collect::<Vec<_>>())
    };
    let mut shapes: Vec<Shape> = [4, 5].map(|sides| hull(&models::cone(sides, 1.2).unwrap().vertices)).into();
    shapes.extend([(); 3].map(|()| bent(random.rotation())));
    let (mut overlapping, mut by_facets) = (0, 0);
    for round in 0..600 {
        let pair = [&shapes[round % shapes.len()], &shapes[random.below(shapes.len())]];
        let at = random.direction() * random.uniform(0.1, 0.9);
        let poses = [Pose::new(&random.rotation(), &Vector::zeros()), Pose::new(&random.rotation(), &at)];
        let answer = check(pair, [&poses[0], &poses[1]], &mut DepthCache::default());
        overlapping += usize::from(answer.lower > 0.0);
        by_facets += usize::from(answer.lower > 0.0 && answer.statistics.triangles == 0);
    }
    println!("{overlapping} overlap, {by_facets} by facets");
    assert!(overlapping > 300 && 100 * by_facets > 99 * overlapping, "{overlapping} {by_facets}");
}

/// Bodies of middling size: in poses that have nothing to do with those before all facets are looked at, whatever was kept. Where
/// poses hardly change a polytope is made once and moved on from then.
#[test]
fn what_is_kept_of_middling_bodies_is_moved_on_where_poses_hardly_change() {
    let mut random = Random::new(74);
    let shapes = [(); 2].map(|()| hull(&(0..40).map(|_| random.direction()).collect::<Vec<_>>()));
    let pair = [&shapes[0], &shapes[1]];
    let mut cache = DepthCache::default();
    let mut count = |step: f64| {
        let (mut turn, mut at) = (random.rotation(), Vector::new(0.9, 0.3, 0.1));
        let (mut by_facets, mut moved_on) = (0, 0);
        for _ in 0..200 {
            let poses = [Pose::new(&Matrix::identity(), &Vector::zeros()), Pose::new(&turn, &at)];
            let cold = check(pair, [&poses[0], &poses[1]], &mut cache.clone());
            let answer = query(pair, [&poses[0], &poses[1]], &mut cache);
            assert!(cold.lower > 0.0 && answer.lower > 0.0, "{answer:?}");
            by_facets += usize::from(answer.statistics.triangles == 0);
            moved_on += usize::from(answer.statistics.triangles > 0 && answer.statistics.steps < 5);
            let about = random.direction();
            turn = if step > 1.0 { random.rotation() } else { rotation(&about, step) * turn };
            at += random.vector() * (0.1 * step.min(1.0));
            at *= 0.9 / at.norm();
        }
        (by_facets, moved_on)
    };
    let (wild, still) = (count(2.0), count(1e-3));
    println!("{wild:?} {still:?}");
    assert!(wild.0 > 190 && still.1 > 180, "{wild:?} {still:?}");
}

/// A box beside a body of corners 10¹³ times as far out: rounding hides whether a vertex is deep enough below a plane, and integers
/// tell. From fuzzing.
#[test]
fn depths_of_small_bodies_far_out_are_proved() {
    let mut random = Random::new(75);
    let (mut overlapping, mut by_facets) = (0, 0);
    for _ in 0..20_000 {
        let far = random.power(20, 45);
        let points: Vec<Vector> = (0..6)
            .map(|_| {
                Vector::from_fn(
                    |_, _| if random.below(2) == 0 { random.signed() * 32.0 } else { random.pick(&[-far, far]) },
                )
            })
            .collect();
        let (body, block) = (hull(&points), cuboid([30.0, 32.0, 32.0]));
        let skew = Matrix::identity() + Matrix::from_fn(|_, _| random.pick(&[0.0, 0.0, 1.0]) * random.power(-40, -28));
        let poses = [Pose::new(&skew, &random.lattice(16)), Pose::new(&Matrix::identity(), &random.lattice(32))];
        let mut cache = DepthCache::default();
        let answer = check([&body, &block], [&poses[0], &poses[1]], &mut cache);
        overlapping += usize::from(answer.outcome == Outcome::Intersecting);
        by_facets += usize::from(answer.lower > 0.0 && answer.statistics.triangles == 0);
    }
    println!("{overlapping} overlap, {by_facets} by facets");
    assert!(overlapping > 5_000 && by_facets > 1_000, "{overlapping} {by_facets}");
}
