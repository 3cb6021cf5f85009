//! Manifolds: what boxes on boxes and hulls on hulls have in common, and what of it stays from pose to pose.

mod at_rest;
mod contact_faces;
mod gaps;
mod reduction;
mod signed_distance;
mod thin;
mod verify;

use swiftprox::manifold::manifold;
use swiftprox::manifold::{Manifold, ManifoldCache, ManifoldConfig, ManifoldPoint};
use swiftprox::math::{Matrix, Pose, Vector};
use swiftprox::pair::{DepthAnswer, DepthCache, DepthConfig, FeatureKind, Outcome, depth};
use swiftprox::shape::{InputPolicy, Shape, ShapeOptions};
use testkit::random::{Random, rotation};
use testkit::shapes::{at, cuboid, hull};

const ALL: ManifoldConfig = ManifoldConfig { max_distance: 0.0, reduces: false };
const FOUR: ManifoldConfig = ManifoldConfig { reduces: true, ..ALL };

fn query(
    shapes: [&Shape; 2],
    poses: [&Pose; 2],
    cache: &mut ManifoldCache,
    config: &ManifoldConfig,
) -> (Manifold, Vec<ManifoldPoint>) {
    let mut points = vec![ManifoldPoint::default(); 20_000];
    let answer = manifold([shapes[0].at(poses[0]), shapes[1].at(poses[1])], cache, config, &mut points).unwrap();
    points.truncate(answer.point_count as usize);
    (answer, points)
}

fn ids(points: &[ManifoldPoint]) -> Vec<u64> {
    let mut ids: Vec<u64> = points.iter().map(|point| point.id).collect();
    ids.sort_unstable();
    ids
}

/// What holds of every manifold: the points are on their bodies and about in line along the normal, the gaps those between them.
fn check(shapes: [&Shape; 2], poses: [&Pose; 2], config: &ManifoldConfig, answer: &Manifold, points: &[ManifoldPoint]) {
    let normal = Vector::from(answer.normal);
    assert!((normal.norm() - 1.0).abs() < 1e-15);
    assert!(!points.is_empty() && answer.lower <= answer.upper && answer.lower <= config.max_distance);
    let size: f64 = shapes.iter().map(|shape| shape.polyhedron().radius).sum();
    let rounding = 1e-12 * (size + poses[1].translation().norm());
    // Of four that stayed another may be a little deeper.
    let deep = if config.reduces { 1.1e-5 * (size + poses[0].translation().norm()) } else { rounding };
    // Facets that meet within the noise of coordinates are one: points are as far off as the slab that holds them is thick, seen
    // along a normal that may be as flat to it as 10° at worst.
    let slabs: f64 = shapes.iter().map(|shape| thickest_slab(shape)).sum();
    let (gap_off, off) = (1e-9 * size + 6.0 * slabs, 100.0 * rounding + 6.0 * slabs);
    for point in points {
        let [first, second] = [point.world1, point.world2].map(Vector::from);
        let gap = normal.dot(&(first - second));
        assert!(point.gap_lower - rounding <= gap && gap <= point.gap_upper + rounding, "{point:?} {gap:e}");
        assert!(point.gap_upper - point.gap_lower <= gap_off, "{point:?}");
        // What is as near as 2⁻²⁷ of the size is at one place.
        assert!(((first - second) - normal * gap).norm() <= off + 2e-8 * size, "{point:?}");
        assert!(
            point.gap_lower <= config.max_distance && answer.lower <= point.gap_upper + rounding,
            "{answer:?} {point:?}"
        );
        for (i, local) in [point.local1, point.local2].into_iter().enumerate() {
            let polyhedron = shapes[i].polyhedron();
            let centred = Vector::from(local) - polyhedron.centre;
            let out =
                polyhedron.faces.iter().map(|face| face.planes.value(0, &centred)).fold(f64::NEG_INFINITY, f64::max);
            assert!(out <= off, "{out:e} {point:?}");
        }
    }
    assert!(points.iter().any(|point| point.gap_lower <= answer.upper + deep), "{answer:?} {points:?}");
    let distinct = ids(points);
    assert!(distinct.windows(2).all(|pair| pair[0] != pair[1]), "{points:?}");
}

/// How thick a slab a contact face of the shape stands for, at most.
fn thickest_slab(shape: &Shape) -> f64 {
    2.0 * shape.polyhedron().contact_faces.faces.iter().map(|face| face.slack).fold(0.0, f64::max)
}

/// A box of half sides 1, 1, 0.25 over one of 2, 2, 0.5, with a gap.
fn stacked(gap: f64, turn: f64) -> ([Shape; 2], [Pose; 2]) {
    let shapes = [cuboid([1.0, 1.0, 0.25]), cuboid([2.0, 2.0, 0.5])];
    let above = Pose::new(&rotation(&Vector::z(), turn), &Vector::new(0.0, 0.0, 0.75 + gap));
    (shapes, [above, Pose::IDENTITY])
}

#[test]
fn a_box_on_a_larger_box_stands_on_its_four_corners() {
    for gap in [-0.125, -1e-6, 0.0, 1e-6, 0.03125] {
        for turn in [0.0, 0.3, 0.785, 1.2] {
            let ([upper, lower], poses) = stacked(gap, turn);
            let config = ManifoldConfig { max_distance: 0.05, ..ALL };
            let placed = [&poses[0], &poses[1]];
            let mut cache = ManifoldCache::default();
            let (answer, points) = query([&upper, &lower], placed, &mut cache, &config);
            check([&upper, &lower], placed, &config, &answer, &points);
            assert_eq!((points.len(), answer.found_count), (4, 4), "{gap} {turn} {points:?}");
            assert!(points.iter().all(|point| point.feature1.kind == FeatureKind::Vertex));
            assert!(points.iter().all(|point| point.feature2.kind == FeatureKind::Face));
            assert!(points.iter().all(|point| (point.gap_lower - gap).abs() < 1e-12), "{gap} {points:?}");
            assert_eq!(answer.outcome == Outcome::Intersecting, gap <= 0.0);
            // The other way round the same.
            let (other, mirrored) =
                query([&lower, &upper], [placed[1], placed[0]], &mut ManifoldCache::default(), &config);
            assert_eq!((mirrored.len(), other.found_count), (4, 4));
            assert!((Vector::from(other.normal) + Vector::from(answer.normal)).norm() < 1e-14);
        }
    }
}

#[test]
fn a_margin_opens_the_manifold_and_ends_it() {
    let ([upper, lower], poses) = stacked(0.01, 0.2);
    let placed = [&poses[0], &poses[1]];
    let (answer, points) = query([&upper, &lower], placed, &mut ManifoldCache::default(), &ALL);
    assert_eq!((answer.outcome, points.len(), answer.found_count), (Outcome::Beyond, 0, 0));
    let config = ManifoldConfig { max_distance: 0.011, ..ALL };
    let (answer, points) = query([&upper, &lower], placed, &mut ManifoldCache::default(), &config);
    assert_eq!((answer.outcome, points.len()), (Outcome::Separated, 4));
    // Tilted, the far corners are beyond `max_distance`.
    let tilted = Pose::new(&rotation(&Vector::y(), 0.05), &Vector::new(0.0, 0.0, 0.75 + 0.052));
    let (answer, points) = query([&upper, &lower], [&tilted, placed[1]], &mut ManifoldCache::default(), &config);
    check([&upper, &lower], [&tilted, placed[1]], &config, &answer, &points);
    assert_eq!(points.len(), 2, "{points:?}");
}

/// Before, the pair refused what is the default of scenes, and its message wrote the largest double with all its digits.
#[test]
fn an_infinite_margin_admits_all() {
    let ([upper, lower], poses) = stacked(1e3, 0.2);
    let placed = [&poses[0], &poses[1]];
    let config = ManifoldConfig { max_distance: f64::INFINITY, ..ALL };
    let (answer, points) = query([&upper, &lower], placed, &mut ManifoldCache::default(), &config);
    assert_eq!((answer.outcome, points.len()), (Outcome::Separated, 4));
    for max_distance in [f64::NAN, -1.0, f64::NEG_INFINITY] {
        let bodies = [upper.at(placed[0]), lower.at(placed[1])];
        let config = ManifoldConfig { max_distance, ..ALL };
        let refused = manifold(bodies, &mut ManifoldCache::default(), &config, &mut []).unwrap_err();
        assert!(refused.message().ends_with("it must be at least 0"), "{refused:?}");
    }
}

/// Boxes whose sides lie on each other along the normal, tilted: where sides cross was anywhere along them, and one of 15,000
/// such manifolds had a fifth point whose gap was as wide as the whole wedge.
#[test]
fn sides_that_lie_on_each_other_have_no_crossings() {
    let mut random = Random::new(10);
    for _ in 0..2_000 {
        let shapes = [cuboid([0.5, 0.4, 0.3]), cuboid([0.5, 1.0, 0.25])];
        let tilt = rotation(&Vector::x(), 0.1 * random.signed());
        let turn = random.rotation();
        let away = Vector::new(0.0, 0.3 * random.signed(), 0.53);
        let poses = [Pose::new(&(turn * tilt), &(turn * away)), Pose::new(&turn, &Vector::zeros())];
        let placed = [&poses[0], &poses[1]];
        let config = ManifoldConfig { max_distance: 0.2, ..ALL };
        let (answer, points) = query([&shapes[0], &shapes[1]], placed, &mut ManifoldCache::default(), &config);
        check([&shapes[0], &shapes[1]], placed, &config, &answer, &points);
        assert!(points.len() <= 4, "{points:?}");
        assert!(points.iter().all(|point| point.gap_upper - point.gap_lower < 1e-12), "{points:?}");
    }
}

/// Equal boxes in line with each other, and turned by 45°: the octagon.
#[test]
fn ties_and_crossings_are_told_once() {
    let cube = cuboid([0.5; 3]);
    let pair = [&cube, &cube];
    for (turn, count) in [(0.0, 4), (std::f64::consts::FRAC_PI_4, 8), (0.01, 8)] {
        for sink in [0.0, 1e-3, 0.25] {
            let above = Pose::new(&rotation(&Vector::z(), turn), &Vector::new(0.0, 0.0, 1.0 - sink));
            let placed = [&above, &Pose::IDENTITY];
            let (answer, points) = query(pair, placed, &mut ManifoldCache::default(), &ALL);
            check(pair, placed, &ALL, &answer, &points);
            assert_eq!(points.len(), count, "{turn} {sink} {points:?}");
            let (reduced, four) = query(pair, placed, &mut ManifoldCache::default(), &FOUR);
            assert_eq!((reduced.found_count as usize, four.len()), (count, 4));
            // Dropped, never moved.
            assert!(four.iter().all(|point| points.contains(point)));
        }
    }
    // Half over: two corners of each.
    let placed = [&at(0.4, 0.3, 1.0), &at(0.0, 0.0, 0.0)];
    let (answer, points) = query(pair, placed, &mut ManifoldCache::default(), &ALL);
    check(pair, placed, &ALL, &answer, &points);
    assert_eq!(points.len(), 4, "{points:?}");
}

#[test]
fn crossing_edges_meet_in_one_point() {
    let cube = cuboid([0.5; 3]);
    let edge_down = Pose::new(&rotation(&Vector::x(), std::f64::consts::FRAC_PI_4), &Vector::new(0.0, 0.0, 1.4));
    let edge_up = Pose::new(&rotation(&Vector::y(), std::f64::consts::FRAC_PI_4), &Vector::zeros());
    let placed = [&edge_down, &edge_up];
    let (answer, points) = query([&cube, &cube], placed, &mut ManifoldCache::default(), &ALL);
    check([&cube, &cube], placed, &ALL, &answer, &points);
    assert_eq!((answer.reference, points.len()), (0, 1));
    assert_eq!([points[0].feature1.kind, points[0].feature2.kind], [FeatureKind::Edge; 2]);
}

/// While a box slides and rocks by less than its features change, the ids stay.
#[test]
fn ids_stay_over_small_motions() {
    let ([upper, lower], _) = stacked(0.0, 0.0);
    let mut random = Random::new(7);
    let mut cache = ManifoldCache::default();
    let mut known: Option<(Vec<u64>, [f64; 3])> = None;
    for _ in 0..500 {
        let turn = rotation(&Vector::z(), 0.3) * rotation(&random.direction(), 1e-7);
        let above = Pose::new(&turn, &(Vector::new(0.1, -0.2, 0.75 - 1e-4) + random.vector() * 1e-5));
        let placed = [&above, &Pose::IDENTITY];
        let (answer, points) = query([&upper, &lower], placed, &mut cache, &FOUR);
        check([&upper, &lower], placed, &FOUR, &answer, &points);
        let (before, normal) = known.get_or_insert((ids(&points), answer.normal));
        assert_eq!(*before, ids(&points));
        assert!((Vector::from(*normal) - Vector::from(answer.normal)).norm() < 1e-6);
    }
}

/// Of two boxes alike in size the reference stays the one it was, though rounding makes now this, now that one the more parallel.
#[test]
fn the_reference_stays() {
    let cube = cuboid([0.5; 3]);
    let mut random = Random::new(8);
    let mut cache = ManifoldCache::default();
    let mut first = None;
    for _ in 0..300 {
        let above = Pose::new(&rotation(&random.direction(), 1e-9), &Vector::new(0.1, 0.07, 0.999));
        let (answer, _) = query([&cube, &cube], [&above, &Pose::IDENTITY], &mut cache, &ALL);
        assert_eq!(*first.get_or_insert(answer.reference), answer.reference);
        assert!(answer.reference > 0);
    }
}

/// Random hulls, overlapping or near.
#[test]
fn hulls_on_hulls_have_points_on_both() {
    let mut random = Random::new(9);
    let (mut several, mut single) = (0, 0);
    for round in 0..3_000 {
        let shapes = [0, 1].map(|_| match random.below(3) {
            0 => cuboid([0.5, 0.3, 0.4]),
            1 => {
                let points: Vec<Vector> = (0..6 + random.below(40)).map(|_| random.direction()).collect();
                hull(&points)
            }
            _ => {
                let count = 3 + random.below(30);
                let corner = |k: usize| {
                    let angle = std::f64::consts::TAU * (k / 2) as f64 / count as f64;
                    Vector::new(angle.cos(), angle.sin(), if k.is_multiple_of(2) { -0.4 } else { 0.4 })
                };
                hull(&(0..2 * count).map(corner).collect::<Vec<_>>())
            }
        });
        let pair = [&shapes[0], &shapes[1]];
        let turn = if round % 2 == 0 { rotation(&Vector::z(), random.signed()) } else { random.rotation() };
        let away = Vector::new(random.signed(), random.signed(), 0.8 * random.signed()) * 0.7;
        let poses = [Pose::new(&turn, &away), Pose::new(&random.quarter_turns(), &Vector::zeros())];
        let placed = [&poses[0], &poses[1]];
        let config = ManifoldConfig { max_distance: 0.05, ..ALL };
        let (answer, points) = query(pair, placed, &mut ManifoldCache::default(), &config);
        if answer.outcome == Outcome::Beyond {
            continue;
        }
        check(pair, placed, &config, &answer, &points);
        several += usize::from(points.len() > 1);
        single += usize::from(points.len() == 1);
        let reduced = ManifoldConfig { reduces: true, ..config };
        let (_, four) = query(pair, placed, &mut ManifoldCache::default(), &reduced);
        assert!(four.len() <= 4 && four.iter().all(|point| points.contains(point)), "{four:?} {points:?}");
        let deepest =
            |points: &[ManifoldPoint]| points.iter().map(|point| point.gap_lower).fold(f64::INFINITY, f64::min);
        assert_eq!(deepest(&four), deepest(&points));
    }
    assert!(several > 2_000 && single > 100, "{several} {single}");
}

/// 5,000-gons: the common part of both, in time in proportion to the corners.
#[test]
fn polygons_of_very_many_sides_are_clipped() {
    let prism = |count: usize| {
        let corner = |k: usize| {
            let angle = std::f64::consts::TAU * (k / 2) as f64 / count as f64;
            Vector::new(angle.cos(), angle.sin(), if k.is_multiple_of(2) { -0.4 } else { 0.4 })
        };
        // With no noise: by default corners that are off a line by a millionth are none.
        let options = ShapeOptions { input: InputPolicy::Hull, face_noise: Some(0.0), ..Default::default() };
        Shape::from_points(&(0..2 * count).map(corner).collect::<Vec<_>>(), &options).unwrap()
    };
    let shapes = [prism(5_000), prism(4_999)];
    let above = at(0.3, 0.2, 0.79);
    let placed = [&above, &Pose::IDENTITY];
    let (answer, points) = query([&shapes[0], &shapes[1]], placed, &mut ManifoldCache::default(), &ALL);
    check([&shapes[0], &shapes[1]], placed, &ALL, &answer, &points);
    // The lens of two discs: about as many corners as one of them has, and two crossings.
    let crossings = points.iter().filter(|point| point.feature1.kind == FeatureKind::Edge).count();
    assert!((3_000..5_000).contains(&points.len()), "{}", points.len());
    assert_eq!(crossings, 2);
}

#[test]
fn any_cache_gives_the_same_depth() {
    let ([upper, lower], poses) = stacked(-0.1, 0.4);
    let placed = [&poses[0], &poses[1]];
    let mut cache = ManifoldCache::default();
    let (clean, _) = query([&upper, &lower], placed, &mut cache, &ALL);
    let mut answer = DepthAnswer::default();
    let config = DepthConfig::default();
    depth([upper.at(placed[0]), lower.at(placed[1])], &mut DepthCache::default(), &config, &mut answer).unwrap();
    assert!(-answer.upper <= clean.upper && clean.lower <= -answer.lower);
    // Another pair's.
    let far = at(0.0, 0.0, 5.0);
    query([&lower, &upper], [&far, placed[1]], &mut cache, &ALL);
    let other = cuboid([0.2; 3]);
    query([&other, &upper], [placed[1], &Pose::new(&Matrix::identity(), &Vector::zeros())], &mut cache, &ALL);
    let (again, points) = query([&upper, &lower], placed, &mut cache, &ALL);
    assert!(again.lower <= clean.upper && clean.lower <= again.upper);
    assert_eq!(points.len(), 4);
}

/// With room for none nothing is written, and the deepest point, which must be among them, is written where there is room for one.
/// All are counted.
#[test]
fn any_room_will_do() {
    let mut random = Random::new(10);
    for _ in 0..200 {
        let shapes = [(); 2].map(|()| hull(&(0..20).map(|_| random.direction()).collect::<Vec<_>>()));
        let poses =
            [Pose::new(&random.rotation(), &Vector::zeros()), Pose::new(&random.rotation(), &random.direction())];
        let pair = [shapes[0].at(&poses[0]), shapes[1].at(&poses[1])];
        let (all, _) = query([&shapes[0], &shapes[1]], [&poses[0], &poses[1]], &mut ManifoldCache::default(), &ALL);
        for config in [ALL, FOUR] {
            for room in 0..4 {
                let mut points = vec![ManifoldPoint::default(); room];
                let answer = manifold(pair, &mut ManifoldCache::default(), &config, &mut points).unwrap();
                assert_eq!((answer.outcome, answer.found_count), (all.outcome, all.found_count));
                assert!(answer.point_count as usize <= room && (room == 0 || answer.point_count > 0), "{answer:?}");
            }
        }
    }
}

/// Where squares of lengths overflow the manifold is the pair of witness points; no number is NaN. From fuzzing.
#[test]
fn any_magnitude_has_a_manifold() {
    for scale in [1e-300, 1e-160, 1e-100, 1e100, 1e149, 1e160, 1e300] {
        let shapes = [cuboid([scale, scale, 0.25 * scale]), cuboid([2.0 * scale, 2.0 * scale, 0.5 * scale])];
        for gap in [-0.125, 0.0, 0.125] {
            let above = Pose::new(&Matrix::identity(), &Vector::new(0.0, 0.0, (0.75 + gap) * scale));
            let config = ManifoldConfig { max_distance: 0.2 * scale, ..ALL };
            let placed = [&above, &Pose::IDENTITY];
            let (answer, points) = query([&shapes[0], &shapes[1]], placed, &mut ManifoldCache::default(), &config);
            assert_eq!(answer.found_count, if scale > 1e150 { 1 } else { 4 }, "{scale:e} {gap} {answer:?}");
            for point in &points {
                let (expected, slack) = (gap * scale, 1e-12 * scale);
                assert!(point.gap_lower <= expected + slack && point.gap_upper >= expected - slack, "{point:?}");
                let places = [point.local1, point.local2, point.world1, point.world2];
                assert!(places.as_flattened().iter().all(|x| x.is_finite()), "{point:?}");
            }
        }
    }
}

/// Bars down to 1e-300 thick, on a box and across each other, asked three times after a question at another pose. Where normal and
/// reference stay the same, the points keep their ids.
#[test]
fn the_same_question_has_the_same_ids() {
    let mut random = Random::new(0x1d5);
    let (mut asked, mut changed) = (0, Vec::new());
    for exponent in (0..=300).step_by(2).chain([271; 40]) {
        for round in 0..24 {
            let thin = 10f64.powi(-exponent);
            let half = [[1.0, thin, thin], [1.0, 0.5, thin], [1.0, thin, 0.5]][round % 3];
            let bar = cuboid(half);
            let other = match round % 4 {
                0 | 1 => cuboid([2.0, 2.0, 0.5]),
                2 => cuboid([thin, 1.0, thin]),
                _ => cuboid([0.5, 1.0, thin]),
            };
            let turn = if round % 8 < 4 { random.rotation() } else { rotation(&Vector::z(), 0.3 * random.signed()) };
            let away = Vector::new(0.3 * random.signed(), 0.3 * random.signed(), 0.5 + thin * random.signed());
            let away = if round < 12 { away } else { away.component_mul(&Vector::new(1.0, 1.0, thin)) };
            let before = Pose::new(&(rotation(&random.direction(), random.signed()) * turn), &away);
            let pose = Pose::new(&turn, &away);
            for config in [ALL, FOUR] {
                let config = ManifoldConfig { max_distance: random.pick(&[0.0, 0.1, 2.0]), ..config };
                let mut cache = ManifoldCache::default();
                let mut ask = |pose: &Pose| query([&bar, &other], [pose, &Pose::IDENTITY], &mut cache, &config);
                ask(&before);
                ask(&pose);
                let ((second, points2), (third, points3)) = (ask(&pose), ask(&pose));
                asked += usize::from(second.point_count > 0);
                if (second.normal, second.reference) == (third.normal, third.reference)
                    && ids(&points2) != ids(&points3)
                {
                    changed.push(format!("1e-{exponent} {round}: {second:?} {points2:?} {third:?} {points3:?}"));
                }
            }
        }
    }
    assert!(changed.is_empty(), "{} of {asked}: {}", changed.len(), changed[..changed.len().min(4)].join("\n"));
    assert!(asked > 3_000, "{asked}");
}
