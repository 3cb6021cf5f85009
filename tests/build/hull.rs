//! The exact hull against brute force with exact predicates, on the inputs where hull builders
//! fail.

use std::collections::BTreeSet;

use swiftprox::base::predicates::ExactPoints;
use swiftprox::body::build::check::check_hull;
use swiftprox::body::build::hull::{Hull, convex_hull};
use swiftprox::math::Vector;
use testkit::random::Random;

use super::turned;

/// The corners of the hull of a set that spans a plane or space, by definition, O(n⁴): the corners of
/// the polygon in every supporting plane. Exact duplicates once, by their lowest index.
fn brute_force_corners(points: &[Vector]) -> Vec<u32> {
    let exact = ExactPoints::new(points).unwrap();
    let n = points.len() as u32;
    let mut corners = BTreeSet::new();
    for a in 0..n {
        for b in a + 1..n {
            for c in b + 1..n {
                if exact.collinear([a, b, c]) {
                    continue;
                }
                let signs: Vec<f64> = (0..n).map(|d| exact.orientation([a, b, c], d)).collect();
                if signs.iter().any(|s| *s > 0.0) && signs.iter().any(|s| *s < 0.0) {
                    continue;
                }
                let in_plane: Vec<u32> = (0..n).filter(|d| signs[*d as usize] == 0.0).collect();
                let axis = (0..3).find(|k| exact.projected_orientation(*k, [a, b, c]) != 0.0).unwrap();
                for &p in &in_plane {
                    if is_polygon_corner(points, &exact, axis, &in_plane, p) {
                        corners.insert(p);
                    }
                }
            }
        }
    }
    corners.into_iter().collect()
}

/// Whether `p` is a corner of the hull of the coplanar points `set`: no segment and no triangle of other
/// points holds it.
fn is_polygon_corner(points: &[Vector], exact: &ExactPoints, axis: usize, set: &[u32], p: u32) -> bool {
    let others: Vec<u32> = set.iter().copied().filter(|&q| points[q as usize] != points[p as usize]).collect();
    if set.iter().any(|&q| q < p && points[q as usize] == points[p as usize]) {
        return false;
    }
    let turn = |a: u32, b: u32, c: u32| exact.projected_orientation(axis, [a, b, c]);
    for (i, &q) in others.iter().enumerate() {
        for (j, &r) in others.iter().enumerate().skip(i + 1) {
            if turn(q, r, p) == 0.0 && between(points, q, p, r) {
                return false;
            }
            for &s in &others[j + 1..] {
                let signs = [turn(q, r, p), turn(r, s, p), turn(s, q, p)];
                if turn(q, r, s) != 0.0 && (signs.iter().all(|x| *x >= 0.0) || signs.iter().all(|x| *x <= 0.0)) {
                    return false;
                }
            }
        }
    }
    true
}

/// For collinear points: whether `p` lies between `q` and `r`.
fn between(points: &[Vector], q: u32, p: u32, r: u32) -> bool {
    let key = |i: u32| <[f64; 3]>::from(points[i as usize]);
    (key(q) <= key(p) && key(p) <= key(r)) || (key(r) <= key(p) && key(p) <= key(q))
}

/// The hull, proved by `check_hull`.
fn proved_hull(points: &[Vector]) -> Hull {
    let hull = convex_hull(points).unwrap();
    check_hull(points, &hull).unwrap_or_else(|e| panic!("{e}"));
    hull
}

/// The points of a grid of `n` cells an edge on the faces of the cube [0, n]³.
fn cube_grid(n: u32) -> Vec<Vector> {
    let on_surface = |c: &[u32; 3]| c.iter().any(|x| *x == 0 || *x == n);
    let all = (0..(n + 1).pow(3)).map(|i| [i / (n + 1).pow(2), i / (n + 1) % (n + 1), i % (n + 1)]);
    all.filter(on_surface).map(|c| Vector::from(c.map(f64::from))).collect()
}

#[test]
fn small_integer_sets_match_brute_force() {
    let mut random = Random::new(1);
    let mut dimensions = [0; 4];
    for round in 0..1000 {
        let n = 1 + random.below(13);
        let size = 1 + random.below(4);
        let points: Vec<Vector> = (0..n)
            .map(|_| {
                let mut coordinate = || random.below(size) as f64;
                Vector::new(coordinate(), coordinate(), coordinate())
            })
            .collect();
        let hull = proved_hull(&points);
        dimensions[hull.dimension as usize] += 1;
        if hull.dimension >= 2 {
            assert_eq!(hull.vertices, brute_force_corners(&points), "round {round}: {points:?}");
        }
    }
    assert!(dimensions.iter().all(|count| *count > 20), "{dimensions:?}");
}

/// The same sets turned off the axes: what was coplanar or collinear is so up to rounding only.
#[test]
fn nearly_degenerate_sets_match_brute_force() {
    let mut random = Random::new(7);
    for round in 0..300 {
        let n = 5 + random.below(8);
        let points: Vec<Vector> = (0..n)
            .map(|_| {
                let mut coordinate = || random.below(3) as f64;
                turned(&Vector::new(coordinate(), coordinate(), coordinate())) / 7.0
            })
            .collect();
        let hull = proved_hull(&points);
        if hull.dimension >= 2 {
            assert_eq!(hull.vertices, brute_force_corners(&points), "round {round}: {points:?}");
        }
    }
}

#[test]
fn spheres_and_slivers_keep_every_vertex() {
    let mut random = Random::new(2);
    let sphere: Vec<Vector> = (0..1002).map(|_| random.direction()).collect();
    for (y, z) in [(1.0, 1.0), (1.0, 1e-4), (1.0, 1e-8), (1.0, 1e-12), (1e-8, 1e-12), (1e-4, 1e-4)] {
        let points: Vec<Vector> = sphere.iter().map(|v| Vector::new(v.x, v.y * y, v.z * z)).collect();
        let hull = proved_hull(&points);
        assert_eq!((hull.vertices.len(), hull.triangles.len()), (1002, 2000), "1:{y}:{z}");
    }
}

#[test]
fn extreme_scales_and_scale_mixtures_are_exact() {
    let mut random = Random::new(3);
    let sphere: Vec<Vector> = (0..60).map(|_| random.direction()).collect();
    let reference = proved_hull(&sphere).vertices;
    for scale in [1e-300, 1e-150, 1e150, 1e300] {
        // Uniform scaling by a number that is no power of two: every point stays a vertex (nothing
        // underflows).
        let points: Vec<Vector> = sphere.iter().map(|v| v * scale).collect();
        assert_eq!(proved_hull(&points).vertices, reference, "{scale}");
        // One axis 10^±300 times the others.
        let points: Vec<Vector> = sphere.iter().map(|v| Vector::new(v.x, v.y, v.z * scale)).collect();
        assert_eq!(proved_hull(&points).vertices, reference, "z times {scale}");
    }
    // A big tetrahedron, and a tiny one that sticks out of its face z = 0 at the origin by 1e-300
    // or does not.
    let big = [[1e300, -1e300, 0.0], [-1e300, -1e300, 0.0], [0.0, 1e300, 0.0], [0.0, 0.0, 1e300]];
    for (z, count) in [(-1e-300, 5), (0.0, 4), (1e-300, 4), (-5e-324, 5)] {
        let mut points: Vec<Vector> = big.iter().map(|p| Vector::from(*p)).collect();
        points.push(Vector::new(1e-300, 3e-300, z));
        assert_eq!(proved_hull(&points).vertices.len(), count, "z = {z:e}");
    }
    // The smallest tetrahedron there is: no double lies inside.
    let d = 5e-324;
    let points = [[0.0, 0.0, 0.0], [d, 0.0, 0.0], [0.0, d, 0.0], [0.0, 0.0, d]].map(Vector::from);
    assert_eq!(proved_hull(&points).triangles.len(), 4);
    // The largest.
    let m = f64::MAX;
    let points = [[m, m, m], [m, -m, -m], [-m, m, -m], [-m, -m, m]].map(Vector::from);
    assert_eq!(proved_hull(&points).triangles.len(), 4);
}

#[test]
fn gridded_cubes() {
    let points = cube_grid(8);
    let corner = |v: &Vector| v.iter().all(|x| *x == 0.0 || *x == 8.0);
    let corners = (0..points.len() as u32).filter(|i| corner(&points[*i as usize]));
    assert_eq!(proved_hull(&points).vertices, corners.collect::<Vec<u32>>());
    // Off the grid of doubles every rounding error is a bump: the hull is whatever it exactly is.
    let rotated: Vec<Vector> = points.iter().map(|v| turned(v) / 7.0 + Vector::new(0.1, 0.2, 0.3)).collect();
    let hull = proved_hull(&rotated);
    assert!(hull.vertices.len() >= 8);
    let small: Vec<Vector> = cube_grid(2).iter().map(|v| turned(v) / 7.0).collect();
    assert_eq!(proved_hull(&small).vertices, brute_force_corners(&small));
}

#[test]
fn prisms_and_cones_over_a_thousand_corners() {
    let n = 1000;
    let corner = |i: usize, z: f64| {
        let angle = i as f64 / n as f64 * std::f64::consts::TAU;
        Vector::new(angle.cos(), angle.sin(), z)
    };
    let prism: Vec<Vector> = (0..n).flat_map(|i| [corner(i, 0.0), corner(i, 1.0)]).collect();
    assert_eq!(proved_hull(&prism).vertices.len(), 2 * n);
    let cone: Vec<Vector> = (0..n).map(|i| corner(i, 0.0)).chain([Vector::new(0.0, 0.0, 1.0)]).collect();
    assert_eq!(proved_hull(&cone).vertices.len(), n + 1);
    let polygon = &cone[..n];
    let hull = proved_hull(polygon);
    assert_eq!((hull.dimension, hull.vertices.len(), hull.triangles.len()), (2, n, 2 * (n - 2)));
    let rotated: Vec<Vector> = prism.iter().map(turned).collect();
    assert_eq!(proved_hull(&rotated).vertices.len(), 2 * n);
}

#[test]
fn permuting_the_input_keeps_the_vertices() {
    let mut random = Random::new(4);
    let mut sets: Vec<Vec<Vector>> = vec![
        (0..200).map(|_| random.direction()).collect(),
        (0..200).map(|_| turned(&random.direction()).component_mul(&Vector::new(1.0, 1.0, 1e-9))).collect(),
        cube_grid(3).iter().map(|v| turned(v) / 7.0).collect(),
        cube_grid(3),
    ];
    let doubled: Vec<Vector> = sets[0].iter().chain(&sets[0]).copied().collect();
    sets.push(doubled);
    for points in &mut sets {
        let corners = |points: &[Vector]| -> BTreeSet<[u64; 3]> {
            let vertices = proved_hull(points).vertices;
            vertices.iter().map(|v| <[f64; 3]>::from(points[*v as usize]).map(f64::to_bits)).collect()
        };
        let reference = corners(points);
        for _ in 0..5 {
            for i in (1..points.len()).rev() {
                points.swap(i, random.below(i + 1));
            }
            assert_eq!(corners(points), reference);
        }
    }
}

#[test]
fn duplicates_count_once_and_the_first_stays() {
    let mut random = Random::new(5);
    let base: Vec<Vector> = (0..30).map(|_| random.direction()).collect();
    let points: Vec<Vector> = (0..300).map(|i| base[i * 7 % 30]).collect();
    assert_eq!(proved_hull(&points).vertices, (0..30).collect::<Vec<u32>>());
    // Zeros of either sign are the same coordinate.
    let points = [[0.0, 0.0, 0.0], [-0.0, 0.0, -0.0], [1.0, -0.0, 0.0], [1.0, 0.0, 0.0]].map(Vector::from);
    let hull = proved_hull(&points);
    assert_eq!((hull.dimension, &hull.vertices[..]), (1, &[0, 2][..]));
    let hull = proved_hull(&points[..2]);
    assert_eq!((hull.dimension, &hull.vertices[..]), (0, &[0][..]));
}

#[test]
fn flat_sets_off_the_axes() {
    // All multiples of one vector, exactly collinear; and a grid in an oblique plane, exactly
    // coplanar.
    let line: Vec<Vector> = [3.0, -1.0, 7.0, 2.0].iter().map(|t| Vector::new(1.0, 2.0, 4.0) * *t).collect();
    let hull = proved_hull(&line);
    assert_eq!((hull.dimension, &hull.vertices[..]), (1, &[1, 2][..]));
    let grid: Vec<Vector> = (0..25)
        .map(|i| Vector::new(1.0, 2.0, 3.0) * f64::from(i / 5) + Vector::new(-2.0, 1.0, 5.0) * f64::from(i % 5))
        .collect();
    let hull = proved_hull(&grid);
    assert_eq!((hull.dimension, &hull.vertices[..]), (2, &[0, 4, 20, 24][..]));
    assert_eq!(hull.triangles.len(), 4);
}

#[test]
fn bad_points_are_named() {
    assert!(convex_hull(&[]).is_err());
    let points = [Vector::zeros(), Vector::new(0.0, f64::NAN, 0.0)];
    let message = convex_hull(&points).unwrap_err().to_string();
    assert!(message.contains("vertex 1: y"), "{message}");
    let points = [Vector::new(f64::NEG_INFINITY, 0.0, 0.0)];
    assert!(convex_hull(&points).unwrap_err().to_string().contains("vertex 0: x"));
}

/// The proof is worth something only if it fails on what is no hull.
#[test]
fn the_proof_refuses_what_is_no_hull() {
    let mut random = Random::new(6);
    let points: Vec<Vector> = (0..40).map(|_| random.direction()).collect();
    let hull = proved_hull(&points);
    let refused = |change: &dyn Fn(&mut Hull)| {
        let mut wrong = hull.clone();
        change(&mut wrong);
        check_hull(&points, &wrong).is_err()
    };
    assert!(refused(&|h| h.triangles.truncate(75)), "a hole");
    assert!(refused(&|h| h.triangles[3].swap(0, 1)), "a triangle turned over");
    assert!(refused(&|h| h.triangles.iter_mut().for_each(|t| t.swap(0, 1))), "inside out");
    assert!(refused(&|h| h.vertices.push(0)), "a vertex twice");
    assert!(refused(&|h| h.triangles[0][0] = 40), "an index out of range");
    assert!(refused(&|h| h.triangles.extend(hull.triangles.clone())), "the surface twice");
    // Each edge flipped: the surface has a dent.
    for t in 0..hull.triangles.len() {
        let [a, b, c] = hull.triangles[t];
        let other = hull.triangles.iter().position(|o| (0..3).any(|i| (o[i], o[(i + 1) % 3]) == (b, a)));
        let other = other.unwrap();
        let d = *hull.triangles[other].iter().find(|v| **v != a && **v != b).unwrap();
        assert!(refused(&|h| {
            h.triangles[t] = [c, a, d];
            h.triangles[other] = [d, b, c];
        }));
    }
    // The hull of all points but one.
    for left_out in 0..40 {
        let keep: Vec<u32> = (0..40).filter(|i| *i != left_out).collect();
        let rest: Vec<Vector> = keep.iter().map(|i| points[*i as usize]).collect();
        let mut smaller = convex_hull(&rest).unwrap();
        smaller.vertices.iter_mut().for_each(|v| *v = keep[*v as usize]);
        smaller.triangles.iter_mut().flatten().for_each(|v| *v = keep[*v as usize]);
        assert!(check_hull(&points, &smaller).is_err());
    }
}

/// A closed surface, all edges convex, all faces seen from inside, that winds about its axis twice:
/// a double pyramid over a pentagram. Only the ray finds it.
#[test]
fn the_proof_refuses_a_surface_that_winds_twice() {
    let corner = |i: u32| {
        let angle = f64::from(i) * 0.8 * std::f64::consts::PI;
        Vector::new(angle.cos(), angle.sin(), 0.0)
    };
    let mut points: Vec<Vector> = (0..5).map(corner).collect();
    points.extend([Vector::new(0.0, 0.0, 1.0), Vector::new(0.0, 0.0, -1.0)]);
    let triangles = (0..5).flat_map(|i| [[i, (i + 1) % 5, 5], [(i + 1) % 5, i, 6]]).collect();
    let star = Hull { dimension: 3, vertices: (0..7).collect(), triangles };
    let message = check_hull(&points, &star).unwrap_err().to_string();
    assert!(message.contains("overlap"), "{message}");
    proved_hull(&points);
}
