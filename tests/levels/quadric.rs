//! Quadric simplification: the counts asked for, on surfaces that stay closed; flat regions first; degenerate bodies; the work it
//! takes; cancelling.

use std::collections::HashSet;

use swiftprox::body::build::assembly::build;
use swiftprox::body::polyhedron::Polyhedron;
use swiftprox::error::Error;
use swiftprox::hierarchy::{Hierarchy, HierarchyKind, HierarchyOptions};
use swiftprox::math::Vector;
use swiftprox::progress::Progress;
use swiftprox::shape::levels::quadric::{Simplified, simplify};
use testkit::models::{ELLIPSOIDS, ellipsoid, prism};
use testkit::random::Random;

fn hull(points: &[Vector]) -> Polyhedron {
    build(points, None).unwrap()
}

fn positions(polyhedron: &Polyhedron) -> Vec<Vector> {
    polyhedron.vertices.iter().map(|v| v.position).collect()
}

fn simplified(polyhedron: &Polyhedron, target: usize) -> Simplified {
    simplify(&positions(polyhedron), &polyhedron.triangles, target, &mut Progress::new(&mut |_| true)).unwrap()
}

/// Every edge has one triangle on either side, every vertex is used, and V − E + F = 2.
fn assert_is_a_sphere(surface: &Simplified) {
    let mut edges = HashSet::new();
    for &[a, b, c] in &surface.triangles {
        for edge in [[a, b], [b, c], [c, a]] {
            assert!(edge[0] != edge[1] && edges.insert(edge), "{edge:?} comes twice");
        }
    }
    assert!(edges.iter().all(|&[a, b]| edges.contains(&[b, a])));
    let used: HashSet<u32> = surface.triangles.iter().flatten().copied().collect();
    assert_eq!(used.len(), surface.points.len());
    assert_eq!(surface.points.len() + surface.triangles.len(), edges.len() / 2 + 2);
}

/// The volume enclosed.
fn volume(points: &[Vector], triangles: &[[u32; 3]]) -> f64 {
    triangles.iter().map(|t| t.map(|v| points[v as usize])).map(|[a, b, c]| a.dot(&b.cross(&c)) / 6.0).sum()
}

#[test]
fn every_rate_reaches_its_count() {
    for (name, half_axes) in ELLIPSOIDS {
        let body = hull(&ellipsoid(half_axes, 1002).unwrap().vertices);
        let all = body.triangles.len();
        assert_eq!(all, 2000);
        for rate in [0.5, 0.25, 0.125, 0.0625, 0.03125] {
            let target = (rate * all as f64) as usize;
            let surface = simplified(&body, target);
            // A closed surface has an even number of triangles.
            assert_eq!(surface.triangles.len(), target / 2 * 2, "{name} {rate}");
            assert_is_a_sphere(&surface);
            let kept = volume(&surface.points, &surface.triangles) / body.mass.volume;
            let lost = [0.01, 0.01, 0.02, 0.04, 0.08];
            let bound = lost[(-rate.log2()) as usize - 1];
            assert!((kept - 1.0).abs() < bound, "{name} {rate}: {kept} of the volume");
        }
    }
}

/// The levels of Ehmann & Lin 2000, figures 9 and 10, for a cut-off between 31 and 62 triangles; P₀ not counted.
#[test]
fn the_numbers_of_levels_of_the_paper() {
    for (name, half_axes) in ELLIPSOIDS {
        let body = hull(&ellipsoid(half_axes, 1002).unwrap().vertices);
        for (decimation, levels) in [(0.5, 5), (0.25, 2), (0.125, 1), (0.0625, 1), (0.03125, 1)] {
            let kind = HierarchyKind::Quadric;
            let options = HierarchyOptions { kind, decimation, minimum_triangles: 50, ..Default::default() };
            let hierarchy = Hierarchy::build(&body, &options, &mut Progress::new(&mut |_| true)).unwrap();
            let counts: Vec<usize> = hierarchy.levels.iter().map(|level| level.polyhedron.triangles.len()).collect();
            assert_eq!(counts.len(), levels, "{name}, {decimation}: {counts:?}");
            // The hull drops the points that simplification left inside: a few.
            let mut expected = 2000.0;
            for count in counts {
                expected *= decimation;
                assert!((0.8 * expected - 2.0..=expected).contains(&(count as f64)), "{name}: {count} of {expected}");
            }
        }
    }
}

/// Half a sphere, and on it a dome that is nearly flat, sampled alike: a fine and flat region goes first (Ehmann & Lin 2000, §4.5).
#[test]
fn flat_regions_go_first() {
    let mut random = Random::new(5);
    let mut points = Vec::new();
    for _ in 0..2000 {
        let mut p = random.direction();
        if p.z > 0.0 {
            p.z = 0.02 * (1.0 - p.x * p.x - p.y * p.y);
        }
        points.push(p);
    }
    let body = hull(&points);
    let on_dome = |points: &[Vector]| points.iter().filter(|p| p.z > 1e-3).count() as f64;
    let on_sphere = |points: &[Vector]| points.iter().filter(|p| p.z < -0.05).count() as f64;
    let before = positions(&body);
    let after = simplified(&body, body.triangles.len() / 4).points;
    let (dome, sphere) = (on_dome(&after) / on_dome(&before), on_sphere(&after) / on_sphere(&before));
    assert!(dome < 0.1 && sphere > 0.3, "kept: {dome} of the dome, {sphere} of the sphere");
}

/// The same from level to level: what is curved, the sphere and the rim of the dome, has ever more of the vertices.
#[test]
fn flat_regions_lose_their_share_from_level_to_level() {
    let mut random = Random::new(6);
    let point = |p: Vector| if p.z > 0.0 { Vector::new(p.x, p.y, 0.02 * (1.0 - p.x * p.x - p.y * p.y)) } else { p };
    let body = hull(&(0..4000).map(|_| point(random.direction())).collect::<Vec<_>>());
    // Levels stand off from the body by more than the dome is high: it is what is above the inside of the sphere.
    let shares = shares_by_level(&body, |p| p.z < -0.2 || p.xy().norm() > 0.9);
    assert!(shares.len() == 7 && shares.windows(2).all(|pair| pair[1] > pair[0]), "{shares:?}");
    assert!(shares[0] < 0.75 && shares[6] > 0.95, "{shares:?}");
}

/// A sphere that is eight times as dense in the north as in the south: of coarse levels either half has about half.
#[test]
fn density_becomes_equal() {
    let mut random = Random::new(7);
    let mut points: Vec<Vector> = (0..4500).map(|_| random.direction()).collect();
    for p in &mut points[..3500] {
        p.z = p.z.abs();
    }
    let body = hull(&points);
    let shares = shares_by_level(&body, |p| p.z < 0.0);
    assert!(
        shares.len() == 7 && shares[0] < 0.12 && shares[..4].windows(2).all(|pair| pair[1] > pair[0]),
        "{shares:?}"
    );
    assert!(shares[4..].iter().all(|share| (0.4..0.6).contains(share)), "{shares:?}");
}

/// The share of the vertices for which something holds, of the body and of quadric levels that halve the triangles.
fn shares_by_level(body: &Polyhedron, holds: impl Fn(&Vector) -> bool) -> Vec<f64> {
    let options = HierarchyOptions {
        kind: HierarchyKind::Quadric,
        decimation: 0.5,
        minimum_triangles: 100,
        ..HierarchyOptions::default()
    };
    let hierarchy = Hierarchy::build(body, &options, &mut Progress::new(&mut |_| true)).unwrap();
    let polyhedra = [body].into_iter().chain(hierarchy.levels.iter().map(|level| &level.polyhedron));
    let share = |polyhedron: &Polyhedron| {
        let count = polyhedron.vertices.iter().filter(|v| holds(&(v.position + polyhedron.centre))).count();
        count as f64 / polyhedron.vertices.len() as f64
    };
    polyhedra.map(share).collect()
}

/// The corners of a cube whose sides bulge by 1e-7 and are tessellated finely stay where they are.
#[test]
fn what_is_flat_vanishes_and_corners_stay() {
    let mut points = Vec::new();
    let n = 12;
    for axis in 0..3 {
        for i in 0..=n {
            for j in 0..=n {
                for side in [-1.0, 1.0] {
                    let at = |i: usize| 2.0 * i as f64 / f64::from(n as u32) - 1.0;
                    let mut p = Vector::zeros();
                    (p[axis], p[(axis + 1) % 3], p[(axis + 2) % 3]) = (side, at(i), at(j));
                    points.push(p * (1.0 - 1e-7 * (p.norm_squared() - 1.0)));
                }
            }
        }
    }
    let body = hull(&points);
    assert!(body.triangles.len() > 1500, "{}", body.triangles.len());
    let surface = simplified(&body, 12);
    assert_eq!(surface.triangles.len(), 12);
    for corner in 0..8 {
        let at = Vector::from_fn(|k, _| if corner >> k & 1 == 0 { -1.0 } else { 1.0 });
        let nearest = surface.points.iter().map(|p| (p - at).norm()).fold(f64::INFINITY, f64::min);
        assert!(nearest < 1e-5, "corner {corner} moved by {nearest:e}");
    }
}

#[test]
fn the_same_input_gives_the_same_bits() {
    let body = hull(&ellipsoid([1.0, 1.0, 0.1], 300).unwrap().vertices);
    assert_eq!(simplified(&body, 100), simplified(&body, 100));
    // Many equal costs: ties go by index.
    let prism = hull(&prism(64, 0.5).unwrap().vertices);
    assert_eq!(simplified(&prism, 60), simplified(&prism, 60));
}

#[test]
fn scaling_by_a_power_of_two_changes_nothing() {
    let body = hull(&ellipsoid([1.0, 0.1, 0.1], 200).unwrap().vertices);
    let reference = simplified(&body, 80);
    for exponent in [-900, -30, 30, 900] {
        let factor = 2.0_f64.powi(exponent);
        let scaled: Vec<Vector> = positions(&body).iter().map(|p| p * factor).collect();
        let result = simplify(&scaled, &body.triangles, 80, &mut Progress::new(&mut |_| true)).unwrap();
        assert_eq!(result.triangles, reference.triangles, "2^{exponent}");
        assert_eq!(result.points, reference.points.iter().map(|p| p * factor).collect::<Vec<_>>());
    }
}

#[test]
fn thin_bodies_reach_their_count() {
    for half_axes in [[1.0, 1e-5, 1e-5], [1.0, 1.0, 1e-5], [1.0, 1e-3, 1e-6], [1.0, 1.0, 1e-9]] {
        let points: Vec<Vector> = {
            let mut random = Random::new(9);
            (0..1000).map(|_| random.direction().component_mul(&Vector::from(half_axes))).collect()
        };
        let body = hull(&points);
        for target in [1000, 250, 62] {
            let surface = simplified(&body, target);
            assert_is_a_sphere(&surface);
            assert!(surface.points.iter().all(|p| p.iter().all(|x| x.is_finite())));
            assert_eq!(surface.triangles.len(), target, "{half_axes:?}");
        }
    }
}

#[test]
fn the_smallest_bodies() {
    let tetrahedron = hull(&[Vector::zeros(), Vector::x(), Vector::y(), Vector::z()]);
    assert_eq!(simplified(&tetrahedron, 0).points, positions(&tetrahedron));
    let corners = (0..8).map(|i| Vector::new(f64::from(i & 1), f64::from(i >> 1 & 1), f64::from(i >> 2)));
    let cube = hull(&corners.collect::<Vec<_>>());
    assert_eq!(simplified(&cube, 12).points, positions(&cube));
    let four = simplified(&cube, 0);
    assert_eq!(four.triangles.len(), 4);
    assert_is_a_sphere(&four);
}

#[test]
fn flat_bodies_stay_as_they_are() {
    let polygon: Vec<Vector> = (0..20)
        .map(|i| {
            let (sine, cosine) = (f64::from(i) * 0.3).sin_cos();
            Vector::new(cosine, sine, 0.0)
        })
        .collect();
    let body = hull(&polygon);
    assert_eq!(body.dimension, 2);
    assert_eq!(simplified(&body, 4).points, positions(&body));
}

/// Reports come once per 2¹⁴ neighbours that were looked at: their number is the work, whatever the machine.
fn neighbours_looked_at(body: &Polyhedron, target: usize) -> usize {
    let mut reports = 0;
    let mut last = 0.0;
    let mut progress = |fraction: f64| {
        assert!((last..=1.0).contains(&fraction), "{fraction} after {last}");
        last = fraction;
        reports += 1;
        true
    };
    let surface = simplify(&positions(body), &body.triangles, target, &mut Progress::new(&mut progress)).unwrap();
    assert!(surface.triangles.len() <= target);
    reports << 14
}

#[test]
fn the_work_grows_with_the_number_of_triangles() {
    for half_axes in [[1.0, 1.0, 1.0], [1.0, 1.0, 0.1], [1.0, 0.1, 0.1]] {
        let body = hull(&ellipsoid(half_axes, 100_002).unwrap().vertices);
        assert_eq!(body.triangles.len(), 200_000);
        let looked_at = neighbours_looked_at(&body, 100);
        assert!(looked_at < 25 * 100_000, "{half_axes:?}: {looked_at}");
    }
}

/// One vertex of valence 20,000, two of them, and the two large faces of a prism, flat and tall.
#[test]
fn high_valence_does_not_blow_up() {
    let rim = |z: f64| {
        (0..20_000).map(move |i| {
            let (sine, cosine) = (std::f64::consts::TAU * f64::from(i) / 20_000.0).sin_cos();
            Vector::new(cosine, sine, z)
        })
    };
    let apexes = |z: f64| [Vector::new(0.0, 0.0, -z), Vector::new(0.0, 0.0, z)];
    let bodies = [
        rim(0.0).chain([Vector::new(0.0, 0.0, 100.0)]).collect::<Vec<_>>(),
        rim(0.0).chain(apexes(1.0)).collect(),
        rim(0.0).chain(apexes(1e-3)).collect(),
        rim(0.0).chain(rim(1e-5)).collect(),
        rim(0.0).chain(rim(10.0)).collect(),
    ];
    for (number, points) in bodies.iter().enumerate() {
        let body = hull(points);
        let looked_at = neighbours_looked_at(&body, 100);
        assert!(looked_at < 25 * points.len(), "body {number}: {looked_at}");
    }
}

#[test]
fn it_can_be_cancelled() {
    let body = hull(&ellipsoid([1.0, 1.0, 1.0], 5000).unwrap().vertices);
    let mut reports = 0;
    let mut stop_at_second = |_| {
        reports += 1;
        reports < 2
    };
    let result = simplify(&positions(&body), &body.triangles, 50, &mut Progress::new(&mut stop_at_second));
    assert!(matches!(result, Err(Error::Cancelled(_))));
    assert_eq!(reports, 2);
}
