//! Depths of bodies of any magnitude, and of any two.

use swiftprox::math::{Pose, Vector};
use swiftprox::pair::{DepthAnswer, DepthCache, Outcome};
use swiftprox::shape::{Shape, ShapeOptions};
use swiftprox::verify::verify_depth;
use testkit::shapes::{at, hull};

use crate::{Random, query};

fn ball(random: &mut Random, scale: f64) -> Shape {
    let points: Vec<Vector> = (0..30).map(|_| random.direction() * scale).collect();
    hull(&points)
}

/// Beyond 2^±200 the interval was that of the world's axes, from 0 on; next to 2⁻²⁰⁰ its lower end was 0. A depth of 2e59 was
/// refused by the check, whose double-double arithmetic ended at 2²⁰⁰ for all lengths together.
#[test]
fn intervals_are_as_narrow_at_any_magnitude() {
    let mut random = Random::new(91);
    for scale in [1e-300, 1e-200, 1e-80, 1e-61, 1e-60, 1e-31, 1e-30, 1e30, 1e31, 2e59, 1e60, 1.5e60, 1e61, 1e200, 1e300]
    {
        let shapes = [ball(&mut random, scale), ball(&mut random, scale)];
        let mut cache = DepthCache::default();
        for _ in 0..4 {
            let poses = [0.0, 0.7].map(|away| Pose::new(&random.rotation(), &(random.direction() * (away * scale))));
            let answer = query([&shapes[0], &shapes[1]], [&poses[0], &poses[1]], &mut cache);
            assert_eq!(answer.outcome, Outcome::Intersecting);
            let width = (answer.upper - answer.lower) / scale;
            assert!(width <= 4e-14 && answer.lower > 0.5 * scale, "{scale:e}: {answer:?}");
            verify_depth([shapes[0].at(&poses[0]), shapes[1].at(&poses[1])], &cache, &answer)
                .unwrap_or_else(|error| panic!("{scale:e}: {error}: {answer:?}"));
        }
    }
}

/// Where only integers tell that bodies overlap, the upper end is the way to the face ahead. No face at the vertex where its search
/// began looked there, so a side face was named: a pose that stretches has it farther off than that end. One that shrinks has it
/// nearer in the world than in the body's frame, in which it seemed farther off.
#[test]
fn the_face_ahead_is_named_where_the_interval_ends_at_it() {
    for half in [3.367982276076923e201, 1e201, 7e230] {
        let cube = |half: f64| {
            let side = |k: usize, bit: usize| if k >> bit & 1 == 0 { -half } else { half };
            hull(&(0..8).map(|k| Vector::new(side(k, 0), side(k, 1), side(k, 2))).collect::<Vec<_>>())
        };
        let shapes = [cube(half), cube(5e-324)];
        for scale in [1.0000000037252903, 0.9999995231628418, 1.004, 0.996] {
            let placed =
                |x: f64, y: f64, z: f64| Pose { rows: [[1.0, 0.0, 0.0, x], [0.0, scale, 0.0, y], [0.0, 0.0, 1.0, z]] };
            let poses = [placed(-24.0, -24.0, -24.0), placed(5e-324, 25.0, 5e-324)];
            let mut cache = DepthCache::default();
            let answer = query([&shapes[0], &shapes[1]], [&poses[0], &poses[1]], &mut cache);
            assert_eq!(answer.outcome, Outcome::Intersecting);
            verify_depth([shapes[0].at(&poses[0]), shapes[1].at(&poses[1])], &cache, &answer)
                .unwrap_or_else(|error| panic!("{half:e} {scale}: {error}: {answer:?}"));
        }
    }
}

#[test]
fn intervals_hold_for_any_two_magnitudes() {
    let mut random = Random::new(92);
    let scales = [1e-310, 1e-200, 1e-61, 1e-30, 1.0, 1e30, 1e60, 1e200];
    for large in scales {
        for small in scales.into_iter().filter(|small| *small <= large) {
            let shapes = [ball(&mut random, large), ball(&mut random, small)];
            let away = random.direction() * (0.3 * large);
            let poses = [Pose::new(&random.rotation(), &Vector::zeros()), Pose::new(&random.rotation(), &away)];
            let mut cache = DepthCache::default();
            let answer = query([&shapes[0], &shapes[1]], [&poses[0], &poses[1]], &mut cache);
            verify_depth([shapes[0].at(&poses[0]), shapes[1].at(&poses[1])], &cache, &answer)
                .unwrap_or_else(|error| panic!("{large:e} {small:e}: {error}: {answer:?}"));
            // Of coordinates so far apart no unit of length holds all exactly.
            if small < 1e-290 * large {
                continue;
            }
            // Next to the least of doubles an interval is as wide as they are apart.
            let width = (answer.upper - answer.lower).max(f64::from_bits(4)) - f64::from_bits(4);
            assert!(width <= 4e-14 * large && answer.lower > 0.01 * large, "{large:e} {small:e}: {answer:?}");
        }
    }
}

/// A point in a plate 10³⁴ times as long as thick: half the thickness deep, as all facets of the plate tell. Cause: facets were
/// looked at of two bodies with an interior alone, and no polytope is found in doubles; `verify_depth` refused what was true. From
/// fuzzing.
#[test]
fn a_point_in_a_thin_plate_is_proved_to_be_deep() {
    let half = [6.20260064581006e-266, 3.10130032290503e-266, 2.9864435792103004e-300];
    let corner = |k: usize| Vector::from_fn(|i, _| if k >> i & 1 == 0 { -half[i] } else { half[i] });
    let (plate, point) = (hull(&(0..8).map(corner).collect::<Vec<_>>()), hull(&[Vector::zeros()]));
    let mut pose = Pose::IDENTITY;
    pose.rows[1][1] += 2f64.powi(-28);
    (0..3).for_each(|i| pose.rows[i][3] = f64::from_bits(1));
    for shapes in [[&plate, &point], [&point, &plate]] {
        let mut cache = DepthCache::default();
        let answer = query(shapes, [&pose; 2], &mut cache);
        assert_eq!((answer.outcome, answer.lower, answer.upper), (Outcome::Intersecting, half[2], half[2]));
        let bodies = [shapes[0].at(&pose), shapes[1].at(&pose)];
        for cache in [cache, DepthCache::default()] {
            assert_eq!(verify_depth(bodies, &cache, &answer), Ok(()));
            let more = half[2].next_up();
            let forged = DepthAnswer { lower: more, depth: more, upper: more, ..answer };
            assert!(verify_depth(bodies, &cache, &forged).is_err());
        }
    }
}

/// A needle with vertices from 1e-174 to 7e211 in a box 2e232 wide, 1/256 wider along x in the world: the pair has no unit of
/// length. Cause: the normal goes along y, but the face reported for the point, which is in the middle, was the one across x. That
/// lies 1/256 of the interval farther off than the interval is wide.
#[test]
fn a_point_without_a_search_leaves_by_the_face_along_the_normal() {
    let needle = [
        [0.0, 1.5, -7e211],
        [1.0; 3],
        [-32.0, -32.0, 2.0],
        [0.0, -17.0, -17.0],
        [1.1, -8e-174, -3e105],
        [-4e92, -4e79, -5e66],
    ];
    let needle = hull(&needle.map(Vector::from));
    let half = 2.484028947681142e232;
    let corners: Vec<Vector> =
        (0..8).map(|i| Vector::from([i & 1, i >> 1 & 1, i >> 2].map(|side| (2 * side - 1) as f64 * half))).collect();
    let block = hull(&corners);
    let stretched = Pose { rows: [[1.00390625, 0.0, 0.0, -32.0], [0.0, 1.0, 0.0, -32.0], [0.0, 0.0, 1.0, -32.0]] };
    let mut cache = DepthCache::default();
    let answer = query([&needle, &block], [&at(0.0, 0.0, 0.0), &stretched], &mut cache);
    assert_eq!(answer.outcome, Outcome::Intersecting);
    verify_depth([needle.at(&at(0.0, 0.0, 0.0)), block.at(&stretched)], &cache, &answer)
        .unwrap_or_else(|error| panic!("{error}: {answer:?}"));
}
/// A prism 1e185 long, and a tetrahedron 0.75 deep in its lower face. Cause: a swept radius of −0 counted as one, by its bits, and
/// the distance of objects that may touch was [0, 0] less radii of 0. The rounding of so long a body is 3e171.
#[test]
fn a_swept_radius_of_minus_zero_is_none() {
    let (across, half, length) = (5.438853046443695e185, 2.71942652322185e185, 4.710184905670624e185);
    let triangle = [[-half, -length], [across, 0.0], [-half, length]];
    let prism: Vec<Vector> = [0.0, across].iter().flat_map(|z| triangle.map(|[x, y]| Vector::new(x, y, *z))).collect();
    let corners = [[0.1, -0.9, -0.25], [0.4, 0.5, -0.75], [-0.7, 0.6, 0.25], [0.6, 0.0, 0.75]].map(Vector::from);
    let options = ShapeOptions { swept_radius: -0.0, ..ShapeOptions::default() };
    let shapes = [hull(&prism), Shape::from_points(&corners, &options).unwrap()];
    let poses = [at(-32.0, -32.0, -32.0); 2];
    let mut cache = DepthCache::default();
    let answer = query([&shapes[0], &shapes[1]], [&poses[0], &poses[1]], &mut cache);
    assert_eq!(answer.outcome, Outcome::Intersecting);
    assert!(answer.lower <= 0.75 && 0.75 <= answer.upper && answer.upper < 1e-13 * across, "{answer:?}");
    verify_depth([shapes[0].at(&poses[0]), shapes[1].at(&poses[1])], &cache, &answer)
        .unwrap_or_else(|error| panic!("{error}: {answer:?}"));
}
