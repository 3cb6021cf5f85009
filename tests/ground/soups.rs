//! Closed surfaces that are not convex, as levels are made of: no body that was moved in by a step is kicked, or left without a
//! contact. Solids push out what is in them.

use super::contacts::contacts;
use super::kicks::{block, judge_all, movers};
use std::collections::HashMap;
use swiftprox::ground::Ground;
use swiftprox::math::{Pose, Vector};
use testkit::random::Random;
use testkit::shapes::{at, cuboid};

type Soup = (Vec<Vector>, Vec<[u32; 3]>);

/// A tube around a (2, 3) torus knot.
fn knot(around: u32, along: u32) -> Soup {
    let tau = std::f64::consts::TAU;
    let centre = |i: u32| {
        let t = tau * f64::from(i) / f64::from(along);
        let radius = 2.0 + (3.0 * t).cos();
        Vector::new(radius * (2.0 * t).cos(), radius * (2.0 * t).sin(), (3.0 * t).sin())
    };
    let mut vertices = Vec::new();
    for i in 0..along {
        let ahead = (centre(i + 1) - centre((i + along - 1) % along)).normalize();
        let aside = ahead.cross(&Vector::z()).normalize();
        let up = aside.cross(&ahead);
        for j in 0..around {
            let (sine, cosine) = (tau * f64::from(j) / f64::from(around)).sin_cos();
            vertices.push(centre(i) + (aside * cosine + up * sine) * 0.35);
        }
    }
    let mut triangles = Vec::new();
    for (i, j) in (0..along).flat_map(|i| (0..around).map(move |j| (i, j))) {
        let place = |i: u32, j: u32| i % along * around + j % around;
        let [a, b, c, d] = [place(i, j), place(i + 1, j), place(i + 1, j + 1), place(i, j + 1)];
        triangles.extend([[a, b, c], [a, c, d]]);
    }
    (vertices, triangles)
}

/// The surface of a union of unit cells, so many along an axis: edges and corners of all kinds.
fn cells(random: &mut Random, count: i32) -> Soup {
    let full: std::collections::HashSet<[i32; 3]> = (0..count)
        .flat_map(|x| (0..count).flat_map(move |y| (0..count).map(move |z| [x, y, z])))
        .filter(|[.., z]| *z == 0 || random.below(3) == 0)
        .collect();
    let (mut vertices, mut triangles) = (Vec::new(), Vec::new());
    let mut number = HashMap::new();
    let mut list: Vec<_> = full.iter().copied().collect();
    list.sort_unstable();
    for cell in list {
        for (axis, way) in (0..3).flat_map(|axis| [(axis, 0), (axis, 1)]) {
            let mut beside = cell;
            beside[axis] += 2 * way - 1;
            if full.contains(&beside) {
                continue;
            }
            let (u, v) = ((axis + 1) % 3, (axis + 2) % 3);
            let mut corners = [[0, 0], [1, 0], [1, 1], [0, 1]].map(|[i, j]| {
                let mut place = cell;
                (place[axis], place[u], place[v]) = (cell[axis] + way, cell[u] + i, cell[v] + j);
                *number.entry(place).or_insert_with(|| {
                    let middle = f64::from(count) / 2.0;
                    vertices.push(Vector::from_fn(|k, _| f64::from(place[k]) - middle));
                    vertices.len() as u32 - 1
                })
            });
            if way == 0 {
                corners.reverse();
            }
            let [a, b, c, d] = corners;
            triangles.extend([[a, b, c], [a, c, d]]);
        }
    }
    (vertices, triangles)
}

/// A sphere of cells with a rough surface.
fn rock(random: &mut Random, cells: u32) -> Soup {
    let tau = std::f64::consts::TAU;
    let mut vertices = vec![Vector::z() * 1.5, Vector::z() * -1.5];
    for i in 1..cells {
        for j in 0..2 * cells {
            let ((s, c), (sine, cosine)) = (
                (tau / 2.0 * f64::from(i) / f64::from(cells)).sin_cos(),
                (tau / 2.0 * f64::from(j) / f64::from(cells)).sin_cos(),
            );
            vertices.push(Vector::new(s * cosine, s * sine, c) * random.uniform(1.3, 1.6));
        }
    }
    let place = |i: u32, j: u32| match i {
        0 => 0,
        i if i == cells => 1,
        i => 2 + (i - 1) * 2 * cells + j % (2 * cells),
    };
    let mut triangles = Vec::new();
    for (i, j) in (0..cells).flat_map(|i| (0..2 * cells).map(move |j| (i, j))) {
        let [a, b, c, d] = [place(i, j), place(i + 1, j), place(i + 1, j + 1), place(i, j + 1)];
        triangles.extend([[a, b, c], [a, c, d]]);
    }
    (vertices, triangles)
}

fn ground_of((vertices, triangles): &Soup) -> Ground {
    Ground::from_triangles(vertices, triangles).unwrap()
}

#[test]
fn no_body_is_kicked_on_a_closed_surface() {
    let mut random = Random::new(0x50f);
    let (mut judged, mut wrong) = (0, Vec::new());
    let mut soups: Vec<(&str, f64, Soup)> = vec![("knot", 3.0, knot(8, 60)), ("fine knot", 3.0, knot(16, 200))];
    for _ in 0..3 {
        soups.push(("cells", 2.0, cells(&mut random, 4)));
        soups.push(("rock", 1.0, rock(&mut random, 6)));
        soups.push(("fine rock", 1.0, rock(&mut random, 14)));
    }
    for (name, reach, soup) in &soups {
        for thickness in [0.0, f64::INFINITY] {
            let ground = ground_of(soup).with_thickness(thickness).unwrap();
            let (own, bad) = judge_all(&mut random, &ground, *reach, 60, 0.005);
            judged += own;
            println!("{name}, {thickness} thick: {} of {own}", bad.len());
            wrong.extend(bad.into_iter().map(|what| format!("{name}, {thickness} thick, {what}")));
        }
    }
    println!("{judged} judged, {} wrong", wrong.len());
    wrong.iter().take(8).for_each(|what| println!("{what}"));
    assert!(judged > 900 && wrong.is_empty(), "{judged} {}", wrong.len());
}

/// A plate of heights or a block pushes out of its front what is behind it, from half in to wholly inside.
#[test]
fn solids_push_out_what_is_in_them() {
    let plate = cuboid([0.5, 0.4, 0.1]);
    let heights = super::level(9, 9, 1.0);
    for height in [0.05, 1e-9, 0.0, -1e-9, -0.05, -0.09, -0.15, -0.4] {
        let pose = at(4.3, 4.2, height);
        let thin = contacts(&plate, &pose, &heights, 0.0, false);
        // Rounding decides whether what is half in is behind.
        assert!(height == 0.0 || thin.contacts.is_empty() == (height < 0.0), "{height}");
        let solid = heights.clone().with_thickness(0.5).unwrap();
        let found = contacts(&plate, &pose, &solid, 0.0, false);
        let [contact] = found.contacts[..] else { panic!("{height}: {:?}", found.contacts) };
        assert!((Vector::from(contact.manifold.normal) - Vector::z()).norm() < 1e-12, "{contact:?}");
        assert!((contact.manifold.lower - (height - 0.1)).abs() < 1e-9, "{height}: {contact:?}");
    }
    let deep = heights.clone().with_thickness(0.5).unwrap();
    for [x, z] in [[4.3, -0.8], [-0.7, -0.2]] {
        assert!(contacts(&plate, &at(x, 4.2, z), &deep, 0.0, false).contacts.is_empty());
    }
    let (vertices, triangles) = block([2.0, 2.0, 0.5]);
    let solid = Ground::from_triangles(&vertices, &triangles).unwrap().with_thickness(f64::INFINITY).unwrap();
    let mut random = Random::new(0x501d);
    for body in movers(&mut random) {
        for _ in 0..100 {
            let place = Vector::new(random.uniform(-1.0, 1.0), random.uniform(-1.0, 1.0), random.uniform(-0.6, 0.6));
            let pose = Pose::new(&random.rotation(), &place);
            let found = contacts(&body, &pose, &solid, 0.0, true);
            // Moved out by all of them the body is outside; they agree which way.
            assert!(!found.contacts.is_empty(), "{pose:?}");
            let up = found.contacts[0].manifold.normal[2];
            assert!(
                found.contacts.iter().all(|contact| contact.manifold.normal[2] * up > 0.99),
                "{:?}",
                found.contacts
            );
            let depth = found.contacts.iter().map(|contact| -contact.manifold.lower).fold(0.0, f64::max);
            let out = Pose::new(&pose.rotation(), &(place + Vector::z() * up * (depth + 1e-9)));
            assert!(contacts(&body, &out, &solid, 0.0, true).contacts.is_empty(), "{:?}", found.contacts);
        }
        let outside = Pose::new(&random.rotation(), &Vector::new(0.0, 0.0, 1.4));
        assert!(contacts(&body, &outside, &solid, 0.0, true).contacts.is_empty());
    }
}

/// Tiles of one terrain given as one ground, and T-junctions of finer beside coarser triangles, push as one surface.
#[test]
fn no_seam_pushes_sideways() {
    let height = |x: f64, y: f64| 0.2 * (x * 0.5).sin() + 0.1 * (y * 0.7).cos();
    let tile = |first: f64| {
        let heights: Vec<f64> = (0..17 * 17).map(|k| height(f64::from(k % 17) + first, f64::from(k / 17))).collect();
        let grid = swiftprox::ground::HeightGrid { rows: 17, columns: 17, spacing: [1.0; 2], heights: &heights };
        Ground::from_heights(&grid).unwrap()
    };
    let (tiles, places) = ([tile(0.0), tile(16.0)], [at(0.0, 0.0, 0.0), at(16.0, 0.0, 0.0)]);
    let seams = Ground::from_grounds(&[tiles[0].at(&places[0]), tiles[1].at(&places[1])]).unwrap();
    // A level of one long triangle pair beside one of small ones, over each other by a strip.
    let (coarse, fine) = (super::level(2, 2, 16.0), super::level(17, 17, 1.0));
    let beside = [at(0.0, 0.0, 0.0), at(15.5, 0.0, 0.0), at(16.0, 0.0, 0.0)];
    let junctions = Ground::from_grounds(&[coarse.at(&beside[0]), fine.at(&beside[2])]).unwrap();
    let overlapping = Ground::from_grounds(&[coarse.at(&beside[0]), fine.at(&beside[1])]).unwrap();
    let mut random = Random::new(0x5ea);
    let mut seen = 0;
    for body in movers(&mut random) {
        for round in 0..300 {
            let (x, y) = (random.uniform(15.2, 16.6), random.uniform(1.0, 15.0));
            for (ground, floor, steepest) in
                [(&seams, height(x, y), 0.97), (&junctions, 0.0, 1.0 - 1e-9), (&overlapping, 0.0, 1.0 - 1e-9)]
            {
                let turn =
                    if round % 2 == 0 { random.rotation() } else { testkit::random::rotation(&Vector::z(), 0.3) };
                let lowest = {
                    let polyhedron = body.polyhedron();
                    let place = |v: u32| (turn * polyhedron.local_position(v)).z;
                    (0..polyhedron.vertices.len() as u32).map(place).fold(f64::INFINITY, f64::min) - body.swept_radius()
                };
                let pose = Pose::new(&turn, &Vector::new(x, y, floor - lowest - 0.01));
                for contact in contacts(&body, &pose, ground, 0.05, false).contacts {
                    assert!(contact.manifold.normal[2] > steepest, "{contact:?} {pose:?}");
                    seen += 1;
                }
            }
        }
    }
    assert!(seen > 5000, "{seen}");
}
