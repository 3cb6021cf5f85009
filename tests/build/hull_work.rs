//! What a hull costs grows about as the number of its points, whatever these are, and a build that is told to stop stops soon. Work
//! is counted in reports: there is one at least for every 2,048 tests of a point, each at most some microseconds long.

use std::f64::consts::TAU;

use swiftprox::body::build::check::check_hull;
use swiftprox::body::build::hull::{convex_hull, convex_hull_in_steps};
use swiftprox::error::Error;
use swiftprox::math::Vector;
use swiftprox::progress::Progress;
use swiftprox::shape::{InputPolicy, Shape, ShapeOptions};
use testkit::models::spiral;

use super::turned;

/// Tests between two reports.
const STEPS_A_REPORT: usize = 2048;

fn ring(sides: usize, radius: f64, z: f64) -> impl Iterator<Item = Vector> {
    (0..sides).map(move |k| {
        let (sin, cos) = (TAU * k as f64 / sides as f64).sin_cos();
        Vector::new(radius * cos, radius * sin, z)
    })
}

/// A grid on the faces of a box, turned, so that rounding crumples it.
fn crumpled_box(count: usize) -> Vec<Vector> {
    let n = (count / 6).isqrt();
    let on_face = |face: usize, i: usize, j: usize| {
        let mut p = Vector::zeros();
        p[face % 3] = if face < 3 { 0.0 } else { n as f64 };
        (p[(face + 1) % 3], p[(face + 2) % 3]) = (i as f64, j as f64);
        turned(&p) / 7.0
    };
    let all = (0..6).flat_map(|face| (0..n * n).map(move |k| (face, k / n, k % n)));
    all.map(|(face, i, j)| on_face(face, i, j)).collect()
}

/// Bodies of about so many points that hulls are slow at.
fn bodies(count: usize) -> Vec<(&'static str, Vec<Vector>)> {
    let half = count / 2;
    let flat_prism = || ring(half, 1e200, 0.0).chain(ring(half, 1e200, 1e-200));
    let curve = |k: usize, power: f64| {
        // From 1 down to 2⁻⁹⁰⁰, so that the farthest points peel off a few at a time.
        let t = 2f64.powf(-900.0 * k as f64 / count as f64);
        Vector::new(t, t * t, if k.is_multiple_of(2) { t.powf(power) } else { -t.powf(power) })
    };
    let mut tiny_corner = crumpled_box(count);
    tiny_corner[5].x = 3e-310;
    let spread = crumpled_box(count).into_iter().enumerate();
    vec![
        ("a sphere", spiral(count)),
        ("a prism of height 1e-200 and radius 1e200", flat_prism().collect()),
        ("the same below an apex", flat_prism().chain([Vector::new(0.0, 0.0, 1e200)]).collect()),
        ("a needle of radius 1e-200", ring(half, 1e-200, 0.0).chain(ring(half, 1e-200, 1e200)).collect()),
        ("a flat cone", ring(count, 1e200, 0.0).chain([Vector::new(0.0, 0.0, 1e-200)]).collect()),
        ("a sphere flattened to 1e-250", spiral(count).iter().map(|v| Vector::new(v.x, v.y, 1e-250 * v.z)).collect()),
        ("a curve of falling size", (0..count).map(|k| curve(k, 1.1)).collect()),
        ("a crumpled box", crumpled_box(count)),
        ("a crumpled box with a tiny coordinate", tiny_corner),
        (
            "a crumpled box with sizes spread in each axis",
            spread.map(|(k, v)| if k % 3 == 0 { v } else { v * 2f64.powi(-400) }).collect(),
        ),
        (
            "points along the axis above a disc, each hiding the one before",
            ring(half, 1.0, 0.0)
                .chain((0..half).map(|k| {
                    let t = k as f64 / half as f64;
                    Vector::new(1e-3 * t, 1e-3 * t * t, 1.0 + 1e-9 * t)
                }))
                .collect(),
        ),
        ("a disc and a far apex over it, flat", ring(count, 1.0, 0.0).collect()),
    ]
}

/// Reports of a hull.
fn work(points: &[Vector]) -> usize {
    let mut reports = 0;
    let mut count = |_| {
        reports += 1;
        true
    };
    convex_hull_in_steps(points, &mut Progress::new(&mut count)).expect("finite points");
    reports
}

#[test]
fn work_grows_about_as_the_points() {
    for ((name, few), (_, many)) in bodies(500).into_iter().zip(bodies(4_000)) {
        let [some, more] = [&few, &many].map(|points| work(points));
        // Every point takes several steps, and not in silence.
        assert!(more >= 4 * many.len() / STEPS_A_REPORT, "{name}: {more} reports");
        // Eight times the points: n·(log n)² grows twelvefold, n² by 64.
        assert!(more <= 16 * some.max(4), "{name}: {some} reports for {}, {more} for {}", few.len(), many.len());
        // What the farthest points may take, and as many again and more in random order.
        let most = 64 * many.len() * many.len().ilog2() as usize / STEPS_A_REPORT;
        assert!(more <= most, "{name}: {more} reports");
    }
}

#[test]
fn hulls_that_were_slow_are_right() {
    for (name, points) in bodies(1_500) {
        let hull = convex_hull(&points).unwrap_or_else(|error| panic!("{name}: {error}"));
        check_hull(&points, &hull).unwrap_or_else(|error| panic!("{name}: {error}"));
    }
}

/// The builds of slow bodies go on for no longer than the hulls, and stop at the report at which they are told to.
#[test]
fn builds_stop_when_told() {
    let options = ShapeOptions { input: InputPolicy::Hull, ..ShapeOptions::default() };
    for (name, points) in bodies(1_500) {
        let mut told = vec![0.0];
        let mut listen = |fraction| {
            told.push(fraction);
            true
        };
        Shape::from_points_in_steps(&points, &options, &mut Progress::new(&mut listen)).expect("finite points");
        assert!(told.is_sorted() && told.last() == Some(&1.0), "{name}");
        let count = told.len() - 1;
        for stop_at in [1, count / 2, count] {
            let mut asked = 0;
            let mut stop = |_| {
                asked += 1;
                asked < stop_at
            };
            let built = Shape::from_points_in_steps(&points, &options, &mut Progress::new(&mut stop));
            assert!(matches!(built, Err(Error::Cancelled(_))), "{name}: asked {asked} times");
            assert_eq!(asked, stop_at, "{name}");
        }
    }
}
