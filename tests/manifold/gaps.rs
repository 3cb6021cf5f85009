//! Gaps of points against exact rationals over all vertices, where corners of two faces are nearly in one place.

use super::{ALL, FOUR, query};
use swiftprox::manifold::{Manifold, ManifoldCache, ManifoldConfig, ManifoldPoint};
use swiftprox::math::{Matrix, Pose, Vector};
use swiftprox::pair::Outcome;
use swiftprox::shape::{InputPolicy, Shape, ShapeOptions};
use swiftprox::verify::verify_manifold;
use testkit::manifolds::Gaps;
use testkit::random::{Random, rotation};
use testkit::shapes::{at, cuboid, hull};

/// How far a point may be out of its body, relative to the size of the pair: 2⁻³⁸.
const OUT: f64 = 3.7e-12;

/// Asks for a manifold, and holds it against the truth; what is false is told.
fn ask(
    shapes: [&Shape; 2],
    poses: [&Pose; 2],
    cache: &mut ManifoldCache,
    config: &ManifoldConfig,
) -> Result<(Manifold, Vec<ManifoldPoint>), String> {
    let (answer, points) = query(shapes, poses, cache, config);
    let bodies = [shapes[0].at(poses[0]), shapes[1].at(poses[1])];
    if let Err(error) = verify_manifold(bodies, cache, config, &answer, &points) {
        return Err(format!("{error} {answer:?} {points:?}"));
    }
    if points.is_empty() {
        return Ok((answer, points));
    }
    let gaps = Gaps::new(bodies, &answer.normal);
    for point in &points {
        let outs = gaps.check(point).map_err(|text| format!("{text} {answer:?} {point:?}"))?;
        for (i, out) in outs.into_iter().enumerate() {
            let slabs = &shapes[i].polyhedron().contact_faces.faces;
            let slack = slabs.iter().map(|face| face.slack).fold(0.0, f64::max);
            // A pose that is accepted makes lengths 1.015 times as long at most.
            if !(out <= OUT * size(shapes, poses) + 1.015 * slack) {
                return Err(format!("{out:e} out of body {} {point:?}", i + 1));
            }
        }
    }
    Ok((answer, points))
}

/// Both radii, and how far the middles are apart, with all coordinates that are rounded on the way.
fn size(shapes: [&Shape; 2], poses: [&Pose; 2]) -> f64 {
    let of = |i: usize| {
        let polyhedron = shapes[i].polyhedron();
        polyhedron.radius + polyhedron.centre.norm() + shapes[i].swept_radius() + poses[i].translation().norm()
    };
    of(0) + of(1)
}

fn tetrahedron() -> Vec<Vector> {
    [[1.0, 1.0, 1.0], [-1.0, -1.0, 1.0], [-1.0, 1.0, -1.0], [1.0, -1.0, -1.0]].map(Vector::from).into()
}

fn corners(half: [f64; 3]) -> Vec<Vector> {
    let sign = |k: usize, axis: usize| if k >> axis & 1 == 0 { -half[axis] } else { half[axis] };
    (0..8).map(|k| Vector::new(sign(k, 0), sign(k, 1), sign(k, 2))).collect()
}

/// A quarter turn about z.
fn quarter() -> Matrix {
    Matrix::new(0.0, -1.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0)
}

/// A cube below the edge of a tetrahedron, which begins at y = 1, and a corner of its upper face beside an end of that edge.
/// Cause: corners nearer to a side than 7.5e-9 of the size were taken to be over the tetrahedron's face, whose plane went on
/// beyond its edge; so the gap was up to 1.5e-8 lower than any two points of the bodies have. Cut-off: from 2⁻²⁷ of the size on
/// corners are not at one place. Seen at offset 3.86e-9, where y was 1 − 5.5e-9 on body 2; verify_manifold accepted it.
#[test]
fn a_corner_beside_an_edge_has_the_gap_of_the_edge() {
    let shapes = [cuboid([1.0; 3]), hull(&tetrahedron())];
    let height = 1.999_945_779_930_757_2;
    let mut of_four = 0;
    for k in 0..61 {
        let (offset, z1, z2) = match k {
            0 => (3.859_976_464_277_664_5e-9, 0.254_982_561_203_440_26, 0.254_982_560_501_125_1),
            _ => {
                let offset = 10_f64.powf(-10.0 + 0.05 * k as f64);
                (offset, 0.25 + offset / 3.0, 0.25)
            }
        };
        let poses = [at(offset, height, z1), Pose::new(&quarter(), &Vector::new(0.0, 2.0, z2))];
        let (answer, points) =
            ask(shapes.each_ref(), poses.each_ref(), &mut ManifoldCache::default(), &ALL).expect("it holds");
        assert_eq!((answer.outcome, answer.normal), (Outcome::Intersecting, [0.0, -1.0, 0.0]));
        // In doubles, as both differences are exact.
        let least = 1.0 - (height + 1.0);
        assert!(points.iter().all(|point| least <= point.gap_upper), "{offset:e} {least:e} {points:?}");
        of_four += usize::from(points.len() >= 2);
    }
    assert!(of_four > 0);
}

/// What was said of the cube and the tetrahedron above: a gap that no two points have, of two places that have it; and places
/// farther inside of a face than b.
#[test]
fn a_gap_below_all_that_points_have_is_refused() {
    let shapes = [cuboid([1.0; 3]), hull(&tetrahedron())];
    let poses = [at(3.8e-9, 1.999_945, 0.254), Pose::new(&quarter(), &Vector::new(0.0, 2.0, 0.254))];
    let mut cache = ManifoldCache::default();
    let (answer, points) = ask(shapes.each_ref(), poses.each_ref(), &mut cache, &ALL).expect("it holds");
    let bodies = [shapes[0].at(&poses[0]), shapes[1].at(&poses[1])];
    for (by, refused) in [(1e-10, true), (3e-9, true), (-1e-6, true), (0.0, false)] {
        for k in 0..points.len() {
            let mut forged = points.clone();
            let point = &mut forged[k];
            // Turned by a quarter, the tetrahedron's x is along y of the world.
            (point.local2[0], point.world2[1]) = (point.local2[0] - by, point.world2[1] - by);
            (point.gap_lower, point.gap_upper) = (point.gap_lower - by, point.gap_upper - by);
            let said = verify_manifold(bodies, &cache, &ALL, &answer, &forged);
            assert_eq!(said.is_err(), refused, "{by:e} {said:?} {points:?}");
        }
    }
    // No places, but the interval alone: twice as deep as any two points, and beyond the far sides.
    for (lower, upper) in [(-5.0, answer.lower - 1e-3), (4.5, 5.0)] {
        let mut forged = points.clone();
        (forged[0].gap_lower, forged[0].gap_upper) = (lower, upper);
        assert!(verify_manifold(bodies, &cache, &ALL, &answer, &forged).is_err());
    }
}

/// Cubes a million off their own origins, which the poses bring together. Cause: where the middle of one is from that of the other
/// was the difference of two sums that agree in nearly all digits, in doubles. Cut-off: 64 u of the size of the pair. Gaps were off
/// by 4e-11, and their intervals 3e-13 wide.
#[test]
fn gaps_of_bodies_far_from_their_own_origins_hold() {
    let mut random = Random::new(0x2_fa4);
    for _ in 0..200 {
        let away = random.direction() * 1e6;
        let far: Vec<Vector> = corners([1.0; 3]).iter().map(|p| p + away).collect();
        let shapes = [hull(&far), cuboid([1.0; 3])];
        let lies = random.rotation();
        let stands = lies * rotation(&Vector::z(), random.signed());
        let place = lies * Vector::new(random.signed(), random.signed(), 2.0 - 1e-3 * random.uniform(0.0, 1.0));
        let poses = [Pose::new(&stands, &(place - stands * away)), Pose::new(&lies, &Vector::zeros())];
        let (answer, points) =
            ask(shapes.each_ref(), poses.each_ref(), &mut ManifoldCache::default(), &ALL).expect("it holds");
        assert_eq!((answer.outcome, points.len() >= 3), (Outcome::Intersecting, true));
        assert!(points.iter().all(|point| point.gap_upper - point.gap_lower < 1e-12), "{points:?}");
    }
}

/// A knife whose sides are flat up to noise, its edge down on a box: both ends of the edge are points. Cause: the sides' contact
/// face stands upright, and the slab was taken to be as thick along the normal as it is in its plane. Cut-off: 89.94°, a cosine of
/// 10⁻³, from where on the ends were left out and the witness points were all.
#[test]
fn a_knife_of_noisy_sides_stands_on_both_ends_of_its_edge() {
    let mut random = Random::new(0x4e1f);
    for round in 0..100 {
        let half = 10_f64.powf(random.uniform(-4.0, -2.0));
        let mut points = vec![Vector::new(-1.0, 0.0, -1.0), Vector::new(1.0, 0.0, -1.0)];
        for [x, z] in [[-1.0, 0.0], [0.0, 0.0], [1.0, 0.0], [-1.0, 1.0], [1.0, 1.0]] {
            let width = 0.5 * half * (z + 1.0);
            let off = 1e-9 * random.signed();
            points.extend([width + off, -width - off].map(|y| Vector::new(x, y, z)));
        }
        let shapes = [hull(&points), cuboid([2.0, 2.0, 1.0])];
        assert!(!shapes[0].polyhedron().contact_faces.faces.is_empty());
        let turn = rotation(&Vector::z(), random.uniform(0.0, 3.0));
        let poses = [Pose::new(&turn, &Vector::new(0.1, 0.2, 2.0 - 1e-3)), Pose::IDENTITY];
        let (_, points) =
            ask(shapes.each_ref(), poses.each_ref(), &mut ManifoldCache::default(), &ALL).expect("it holds");
        let vertices: Vec<u32> = points.iter().map(|point| point.feature1.ids[0]).collect();
        assert!(vertices.contains(&0) && vertices.contains(&1), "{round} {half:e} {points:?}");
    }
}

/// Corners of boxes and tetrahedra, wedges, needles and plates to 10⁻¹² of their length, and noisy cubes.
fn any_points(random: &mut Random) -> Vec<Vector> {
    let thin = 10_f64.powf(random.uniform(-12.0, 0.0));
    match random.below(8) {
        0 => corners([1.0; 3]),
        1 => tetrahedron(),
        2 => {
            let turn = random.rotation();
            tetrahedron().iter().map(|p| turn * p).collect()
        }
        3 => {
            // The edge down, or up.
            let up = if random.below(2) == 0 { 1.0 } else { -1.0 };
            [[-1.0, 0.0, -up], [1.0, 0.0, -up], [-1.0, thin, up], [1.0, thin, up], [-1.0, -thin, up], [1.0, -thin, up]]
                .map(Vector::from)
                .into()
        }
        4 => corners([1.0, thin, thin]),
        5 => corners([1.0, 1.0, thin]),
        6 => {
            let turn = random.rotation();
            corners([1.0, 0.8, 0.6]).iter().map(|p| (turn * p).map(|x| f64::from(x as f32))).collect()
        }
        _ => {
            let profile = [[-1.0, 0.0], [1.0, thin], [1.0, -0.5 * thin]];
            profile.into_iter().flat_map(|[x, y]| [-0.5, 0.5].map(|z| Vector::new(x, y, z))).collect()
        }
    }
}

fn any_shape(random: &mut Random) -> Shape {
    let mut points = any_points(random);
    let away =
        if random.below(4) == 0 { random.vector() * 10_f64.powf(random.uniform(0.0, 8.0)) } else { Vector::zeros() };
    points.iter_mut().for_each(|p| *p += away);
    let face_noise = match random.below(4) {
        0 => Some(10_f64.powf(random.uniform(-12.0, -1.0))),
        1 => Some(0.0),
        _ => None,
    };
    let swept_radius = if random.below(4) == 0 { random.power(-20, 0) } else { 0.0 };
    let options = ShapeOptions { input: InputPolicy::Hull, face_noise, swept_radius, ..ShapeOptions::default() };
    Shape::from_points(&points, &options).unwrap()
}

/// Body 1 upon body 2, a little in it or above it, a corner of the one nearly over a corner of the other.
fn nearly_in_line(shapes: &[Shape; 2], radii: f64, random: &mut Random) -> [Pose; 2] {
    let mut turn = || {
        let mut turn = random.quarter_turns();
        if random.below(2) == 0 {
            turn = rotation(&random.direction(), 10_f64.powf(random.uniform(-12.0, 0.0))) * turn;
        }
        if random.below(4) == 0 {
            turn *= Matrix::identity() + Matrix::from_fn(|_, _| 1.5e-3 * random.signed());
        }
        turn
    };
    let turns = [turn(), turn()];
    let placed = [0, 1].map(|i| {
        let polyhedron = shapes[i].polyhedron();
        let of = |v: u32| turns[i] * polyhedron.local_position(v);
        (0..polyhedron.vertices.len() as u32).map(of).collect::<Vec<Vector>>()
    });
    let low = placed[0].iter().map(|p| p.z).fold(f64::INFINITY, f64::min);
    let high = placed[1].iter().map(|p| p.z).fold(f64::NEG_INFINITY, f64::max);
    let [p, q] = [0, 1].map(|i| placed[i][random.below(placed[i].len())]);
    let offset = random.direction() * 10_f64.powf(random.uniform(-11.0, -5.0));
    let gap = radii + random.signed() * 10_f64.powf(random.uniform(-12.0, -0.5));
    let there = if random.below(3) == 0 { random.vector() * 1e3 } else { Vector::zeros() };
    let above = Vector::new(q.x - p.x + offset.x, q.y - p.y + offset.y, high - low + gap);
    [Pose::new(&turns[0], &(above + there)), Pose::new(&turns[1], &there)]
}

/// Bodies of all such kinds upon each other: of each point the gap, and how far it is out of its body.
fn check_pairs(seed: u64, rounds: usize) {
    let mut random = Random::new(seed);
    let (mut several, mut single, mut failures) = (0, 0, Vec::new());
    for round in 0..rounds {
        let shapes = [any_shape(&mut random), any_shape(&mut random)];
        let radii = shapes[0].swept_radius() + shapes[1].swept_radius();
        let poses = nearly_in_line(&shapes, radii, &mut random);
        let max_distance = random.pick(&[0.0, 0.05, f64::INFINITY]);
        let config = ManifoldConfig { max_distance, ..if random.below(4) == 0 { FOUR } else { ALL } };
        match ask(shapes.each_ref(), poses.each_ref(), &mut ManifoldCache::default(), &config) {
            Ok((_, points)) => {
                several += usize::from(points.len() > 1);
                single += usize::from(points.len() == 1);
            }
            Err(text) => failures.push(format!("{round}: {text}")),
        }
    }
    println!("{several} of several points, {single} of one; {} failures", failures.len());
    assert!(failures.is_empty(), "{} of {rounds}:\n{}", failures.len(), failures[..failures.len().min(5)].join("\n"));
    assert!(several > rounds / 4 && single > rounds / 50, "{several} {single}");
}

/// Cause and cut-off as above; of the kind as well: noise, to which corners are at one place, and planes that lean by nearly a
/// right angle, on which a place that is off by the noise is far out of the body.
#[test]
fn gaps_of_corners_nearly_in_line_are_those_of_points_of_the_bodies() {
    check_pairs(1, 4_000);
}

/// A hundred times as many: `cargo test --profile checked --test manifold -- --ignored`.
#[test]
#[ignore = "takes minutes; the test above is a sample of it"]
fn gaps_of_very_many_corners_nearly_in_line() {
    (2..102).for_each(|seed| check_pairs(seed, 4_000));
}

/// Bodies of a few lattice points, and up to two far away: 10⁵ to 10¹² times as long as thick, so all within the noise of their
/// contact faces, which lean by nearly a right angle. Cause: a place that is off by the noise was put into the plane of such a
/// face, and a point of a body 7·10⁹ long and 36 thick was 1,300 out of it, half the width of its gap's interval. Cut-off: a corner
/// up to the noise outside a face. One in six such pairs had a false gap, or a point out of its body. From fuzzing.
#[test]
fn points_of_needles_within_their_noise_are_on_them() {
    let mut random = Random::new(1);
    let (mut several, mut failures) = (0, Vec::new());
    for round in 0..2_000 {
        let points = [(); 2].map(|()| needle(&mut random));
        let shapes = points.each_ref().map(|points| hull(points));
        let turn = if random.below(2) == 0 { Matrix::identity() } else { random.rotation() };
        let (p, q) = (points[0][random.below(4)], points[1][random.below(4)]);
        let poses = [Pose::new(&turn, &(q - turn * p + random.lattice(1) * random.power(-30, 3))), Pose::IDENTITY];
        let config = ManifoldConfig { max_distance: random.pick(&[0.0, 1.0, f64::INFINITY]), ..ALL };
        match ask(shapes.each_ref(), poses.each_ref(), &mut ManifoldCache::default(), &config) {
            Ok((_, points)) => several += usize::from(points.len() > 1),
            Err(text) => failures.push(format!("{round}: {text}")),
        }
    }
    assert!(failures.is_empty(), "{}:\n{}", failures.len(), failures[..failures.len().min(5)].join("\n"));
    assert!(several > 200, "{several}");
}

fn needle(random: &mut Random) -> Vec<Vector> {
    let mut points: Vec<Vector> = (0..4 + random.below(4)).map(|_| random.lattice(32)).collect();
    let far = 10_f64.powf(random.uniform(5.0, 12.0));
    for _ in 0..random.below(3) {
        let direction = match random.below(3) {
            0 => Vector::ith(random.below(3), 1.0),
            1 => Vector::new(0.0, 1.0, 1.0),
            _ => random.direction(),
        };
        points.push(direction * far + random.lattice(32));
    }
    points
}
