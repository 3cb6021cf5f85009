//! Points and support vertices against integers.

use std::cmp::Ordering;

use dashu_int::IBig;
use dashu_ratio::RBig;
use swiftprox::math::{Matrix, Pose, Vector};
use swiftprox::pair::FeatureKind;
use swiftprox::point::{PointAnswer, PointLocation, locate_point, support};
use swiftprox::shape::{InputPolicy, Shape, ShapeOptions};
use testkit::any_size::depth::depth;
use testkit::any_size::integers::{cross, difference, dot, is_zero, place};
use testkit::any_size::nearest::nearest;
use testkit::oracle::{rational, transform};
use testkit::random::Random;
use testkit::rays::{Case, anywhere, on_lattice, swept};
use testkit::shapes::hull;
use testkit::swept::Length;

/// The row-major 3x4 matrices of a pose and of a point.
fn matrices(pose: &Pose, point: [f64; 3]) -> [f64; 24] {
    std::array::from_fn(|k| match k {
        0..12 => pose.rows[k / 4][k % 4],
        15 | 19 | 23 => point[k / 4 - 3],
        12 | 17 | 22 => 1.0,
        _ => 0.0,
    })
}

/// Whether a point, the last of all, is in the interior of the hull of the others: no plane through it and two of them has all on
/// one side. A point of the surface is in a face, and two corners of that make such a plane.
fn is_interior(all: &[[IBig; 3]]) -> bool {
    let (point, others) = all.split_last().unwrap();
    let from_point: Vec<[IBig; 3]> = others.iter().map(|v| difference(v, point)).collect();
    let mut planes = 0;
    for (k, a) in from_point.iter().enumerate() {
        for b in &from_point[..k] {
            let normal = cross(a, b);
            if is_zero(&normal) {
                continue;
            }
            planes += 1;
            let heights: Vec<IBig> = from_point.iter().map(|v| dot(&normal, v)).collect();
            if heights.iter().all(|h| *h <= IBig::ZERO) || heights.iter().all(|h| *h >= IBig::ZERO) {
                return false;
            }
        }
    }
    planes > 0
}

/// Checks what is said of a point.
fn try_point(points: &[Vector], pose: &Pose, point: [f64; 3]) -> PointAnswer {
    let shape = hull(points);
    let answer = locate_point(shape.at(pose), point).unwrap();
    let corners: Vec<[f64; 3]> = points.iter().map(|p| (*p).into()).collect();
    let poses = matrices(pose, point);
    let placed = place(&corners, &[[0.0; 3]], &poses);
    let told = || format!("{points:?} {pose:?} {point:?} {answer:?}");
    let apart = nearest(&placed);
    let all: Vec<[IBig; 3]> = (0..points.len()).map(|v| placed.a.vertex(v)).chain([placed.b.vertex(0)]).collect();
    let truth = match (apart.square.is_zero(), is_interior(&all)) {
        (false, _) => PointLocation::Outside,
        (true, false) => PointLocation::On,
        (true, true) => PointLocation::Inside,
    };
    assert_eq!(answer.location, truth, "{}", told());
    let square = |x: f64| rational(x) * rational(x);
    match truth {
        PointLocation::Outside => {
            let distance = apart.world_square(&placed);
            assert!(
                answer.lower >= 0.0 && square(answer.lower) <= distance && distance <= square(answer.upper),
                "{}",
                told()
            );
        }
        PointLocation::Inside => {
            // In units of the placed vertices.
            let unit = RBig::from(IBig::ONE << placed.exponent.unsigned_abs() as usize);
            let unit = if placed.exponent < 0 { RBig::ONE / unit } else { unit };
            let depth = depth(&placed, 100);
            let [low, high] = [depth.lower_square, depth.upper_square].map(|square| square * &unit * &unit);
            assert!(answer.upper <= 0.0 && square(answer.upper) <= high && low <= square(answer.lower), "{}", told());
        }
        _ => assert_eq!((answer.lower, answer.distance, answer.upper), (0.0, 0.0, 0.0), "{}", told()),
    }
    assert!(
        (Vector::from(answer.normal).norm() - 1.0).abs() < 1e-12 && answer.feature.kind != FeatureKind::None,
        "{}",
        told()
    );
    answer
}

/// Checks what is said of a direction; whether integers decided.
fn try_direction(points: &[Vector], pose: &Pose, direction: [f64; 3]) -> bool {
    let shape = hull(points);
    let answer = support(shape.at(pose), direction).unwrap();
    let matrix = std::array::from_fn(|k| pose.rows[k / 4][k % 4]);
    let along = direction.map(rational);
    let height = |point: &Vector| {
        let at = transform(&matrix, &[point.x, point.y, point.z].map(rational));
        &at[0] * &along[0] + &at[1] * &along[1] + &at[2] * &along[2]
    };
    let highest = points.iter().map(height).max().unwrap();
    let told = || format!("{points:?} {pose:?} {direction:?} {answer:?}");
    assert_eq!(height(&points[answer.vertex as usize]), highest, "{}", told());
    let [low, high] = answer.height;
    assert!(low == f64::NEG_INFINITY || rational(low) <= highest, "{}", told());
    assert!(high == f64::INFINITY || highest <= rational(high), "{}", told());
    answer.exact == 1
}

/// How many points were inside, on and outside.
fn try_all(seed: u64, count: usize, make: fn(&mut Random) -> Case) -> [usize; 3] {
    let mut random = Random::new(seed);
    let mut counts = [0; 3];
    for _ in 0..count {
        let Case { points, pose, ray, .. } = make(&mut random);
        // The ray's origin, and on lattices often a point on the body.
        let answer = try_point(&points, &pose, ray.origin);
        counts[answer.location as usize - 1] += 1;
    }
    counts
}

#[test]
fn points_on_lattices() {
    let counts = try_all(11, 3_000, on_lattice);
    assert!(counts.iter().all(|&count| count > 30), "{counts:?}");
}

/// Points that miss the surface by rounding or by a little.
#[test]
fn points_anywhere() {
    let mut random = Random::new(12);
    let mut counts = [0; 3];
    for _ in 0..600 {
        let Case { points, pose, .. } = anywhere(&mut random);
        let mut any = || points[random.below(points.len())];
        let (a, b, c) = (any(), any(), any());
        let through = pose.transform(&random.pick(&[a, (a + b) * 0.5, a * 0.5 + b * 0.25 + c * 0.25]));
        let reach = points.iter().map(|p| p.norm()).fold(0.0, f64::max);
        let near = random.vector() * (reach * random.pick(&[0.0, 1e-16, 1e-10, 0.1]));
        counts[try_point(&points, &pose, (through + near).into()).location as usize - 1] += 1;
    }
    assert!(counts[0] > 30 && counts[2] > 30, "{counts:?}");
}

/// Bodies with a swept radius, often one that reaches the point up to a rounding: on the surface only exactly there, and points and
/// segments have an inside.
#[test]
fn round_bodies() {
    let mut random = Random::new(14);
    let mut counts = [0; 3];
    for round in 0..1_500 {
        let make = if round % 2 == 0 { anywhere } else { on_lattice };
        let case = make(&mut random);
        let case = swept(&mut random, case);
        let options = ShapeOptions { input: InputPolicy::Hull, swept_radius: case.radius, ..ShapeOptions::default() };
        let shape = Shape::from_points(&case.points, &options).unwrap();
        let answer = locate_point(shape.at(&case.pose), case.ray.origin).unwrap();
        let of_hull = case.apart(true);
        let length = Length::between(&of_hull, [case.radius, 0.0]);
        let truth = match length.compared_with(0.0) {
            Ordering::Greater => PointLocation::Outside,
            Ordering::Equal => PointLocation::On,
            Ordering::Less => PointLocation::Inside,
        };
        assert_eq!(answer.location, truth, "{case:?} {answer:?}");
        // In the hull it is as deep as in that, and the radius deeper.
        let holds = length.compared_with(answer.lower).is_ge()
            && (of_hull.intersecting() || length.compared_with(answer.upper).is_le());
        assert!(holds && answer.lower <= answer.distance && answer.distance <= answer.upper, "{case:?} {answer:?}");
        assert!((Vector::from(answer.normal).norm() - 1.0).abs() < 1e-12 && answer.feature.kind != FeatureKind::None);
        counts[truth as usize - 1] += 1;
    }
    assert!(counts.iter().all(|&count| count > 20), "{counts:?}");
}

#[test]
fn directions() {
    let mut random = Random::new(13);
    let mut exact = 0;
    for round in 0..3_000 {
        let make = if round % 3 == 0 { anywhere } else { on_lattice };
        let Case { points, pose, ray, .. } = make(&mut random);
        exact += usize::from(try_direction(&points, &pose, ray.direction));
    }
    // Both ways of deciding.
    assert!((100..2_900).contains(&exact), "{exact}");
}

/// A needle or a sliver: a body of one to four times eight corners, so many times thinner along one axis or two. Half of them are
/// turned before their corners are rounded.
fn needle(random: &mut Random, round: usize) -> Vec<Vector> {
    let thin = 10f64.powf(-random.uniform(0.0, 12.0));
    let sizes = match round % 3 {
        0 => Vector::new(thin, 0.7 * thin, 1.0),
        1 => Vector::new(thin, 0.8, 1.0),
        _ => Vector::new(thin, thin.sqrt(), 1.0),
    };
    let points: Vec<Vector> = match round % 2 {
        0 => (0..8).map(|k| Vector::from_fn(|axis, _| if k >> axis & 1 == 0 { -0.5 } else { 0.5 })).collect(),
        _ => (0..5 + random.below(6)).map(|_| random.vector()).collect(),
    };
    let turn = if round % 4 < 2 { Matrix::identity() } else { random.rotation() };
    points.iter().map(|point| turn * point.component_mul(&sizes)).collect()
}

/// Points in, on and beside needles. Their polytopes of vertex differences are flat where ends tell nothing of the sides: the depth
/// was said to be in [0, 0.2] of a needle 1e-10 thick, its estimate −0, and the nearest point to be the point itself, from ratios
/// of about 1e-7 on. A body's triangles tell.
#[test]
fn points_in_needles() {
    let mut random = Random::new(14);
    let mut counts = [0; 3];
    for round in 0..600 {
        let points = needle(&mut random, round);
        let stretch = Matrix::identity() + Matrix::from_fn(|_, _| 2e-3 * random.signed());
        let turn = if round % 5 == 0 { random.rotation() * stretch } else { random.rotation() };
        // Only without a pose are corners on the body exactly.
        let pose = match round % 5 {
            1 => Pose::IDENTITY,
            _ => Pose::new(&turn, &(random.vector() * random.pick(&[0.0, 1.0, 1.0]))),
        };
        let inside = points.iter().fold(Vector::zeros(), |sum, p| sum + p * random.uniform(0.1, 1.0));
        let weights = points.len() as f64 * 0.55;
        let on = points[random.below(points.len())];
        let any = random.vector();
        let local = random.pick(&[inside / weights * 0.9, inside / weights, on, on * 1.5, any]);
        let at = pose.transform(&local);
        let answer = try_point(&points, &pose, at.into());
        counts[answer.location as usize - 1] += 1;
        let told = || format!("{round} {points:?} {pose:?} {at:?} {answer:?}");
        let sign = match answer.location {
            PointLocation::Inside => -1.0,
            PointLocation::Outside => 1.0,
            _ => 0.0,
        };
        assert_eq!(if answer.distance == 0.0 { 0.0 } else { answer.distance.signum() }, sign, "{}", told());
        // docs/conventions.md promises this share of the radius.
        let radius = points.iter().map(Vector::norm).fold(1.0, f64::max);
        assert!(answer.upper - answer.lower <= 2e-14 * (radius + pose.translation().amax()), "{}", told());
        // The nearest point is as far away, along the normal.
        let to_point = at - Vector::from(answer.world);
        let off = 4e-15 + (answer.upper - answer.lower);
        assert!((to_point - Vector::from(answer.normal) * answer.distance).norm() < off, "{}", told());
        assert!(
            (pose.transform(&Vector::from(answer.local)) - Vector::from(answer.world)).norm() < 4e-15,
            "{}",
            told()
        );
    }
    assert!(counts[0] > 30 && counts[1] > 15 && counts[2] > 30, "{counts:?}");
}

/// A body with a swept radius reaches so much farther: place and height were those of the vertex.
#[test]
fn support_of_swept_bodies() {
    let mut random = Random::new(15);
    for round in 0..300 {
        let Case { points, pose, ray, .. } = anywhere(&mut random);
        let size = points.iter().map(|p| p.amax()).fold(0.0, f64::max);
        let radius = size * random.uniform(0.0, 2.0);
        let options = ShapeOptions { input: InputPolicy::Hull, swept_radius: radius, ..ShapeOptions::default() };
        let shape = Shape::from_points(&points, &options).unwrap();
        let direction = Vector::from(ray.direction) * random.power(-300, 200);
        let answer = support(shape.at(&pose), direction.into()).unwrap();
        let plain = support(hull(&points).at(&pose), direction.into()).unwrap();
        assert_eq!(answer.vertex, plain.vertex);
        // Of the height h less that of the vertex, v, both ends and so their squares: r²·|d|² is between (l − v)² and (u − v)².
        let matrix = std::array::from_fn(|k| pose.rows[k / 4][k % 4]);
        let vertex = points[answer.vertex as usize];
        let at = transform(&matrix, &[vertex.x, vertex.y, vertex.z].map(rational));
        let along = [direction.x, direction.y, direction.z].map(rational);
        let height = &at[0] * &along[0] + &at[1] * &along[1] + &at[2] * &along[2];
        let square = along.iter().fold(RBig::ZERO, |sum, x| sum + x * x) * rational(radius) * rational(radius);
        let told = || format!("{round} {points:?} {pose:?} {direction:?} {radius:e} {answer:?}");
        let [low, high] = answer.height.map(|end| rational(end) - &height);
        assert!(low <= RBig::ZERO || &low * &low <= square, "{}", told());
        assert!(high >= RBig::ZERO && &high * &high >= square, "{}", told());
        let unit = direction.normalize();
        let reach = Vector::from(answer.world) - Vector::from(plain.world);
        assert!((reach - unit * radius).norm() <= 1e-14 * (size + pose.translation().norm()), "{}", told());
        let back = pose.transform(&Vector::from(answer.local));
        assert!((back - Vector::from(answer.world)).norm() <= 1e-13 * (size + pose.translation().norm()), "{}", told());
    }
}
