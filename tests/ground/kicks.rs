//! No body is kicked: what a contact says is about how far the body is in, on the edges, seams and rims of any ground.

use super::contacts::contacts;
use swiftprox::ground::{Ground, GroundContact, HeightGrid, ground_distance};
use swiftprox::math::{Pose, Vector};
use swiftprox::pair::{PairConfig, Query};
use swiftprox::shape::{InputPolicy, Shape, ShapeOptions};
use testkit::random::{Random, rotation};
use testkit::shapes::{at, cuboid, hull};

/// A box as a ground of twelve triangles.
pub fn block(half: [f64; 3]) -> (Vec<Vector>, Vec<[u32; 3]>) {
    let vertices = (0..8).map(|k| {
        let side = |bit: usize, half: f64| if k & bit == 0 { -half } else { half };
        Vector::new(side(4, half[0]), side(2, half[1]), side(1, half[2]))
    });
    let triangles = [
        [0, 1, 2],
        [1, 3, 2],
        [4, 6, 5],
        [5, 6, 7],
        [0, 4, 1],
        [1, 4, 5],
        [2, 3, 6],
        [3, 7, 6],
        [0, 2, 4],
        [2, 6, 4],
        [1, 5, 3],
        [3, 5, 7],
    ];
    (vertices.collect(), triangles.to_vec())
}

/// A plank lies with one end on a table, its far end raised by a hair; moving it up by 0.001 frees it.
#[test]
fn a_plank_on_the_edge_of_a_table_is_not_kicked() {
    let (vertices, triangles) = block([1.0, 1.0, 0.5]);
    let table = Ground::from_triangles(&vertices, &triangles).unwrap();
    let plank = cuboid([0.2, 0.3, 0.1]);
    for tilt in [0.0, 1e-7, 1e-6, 1e-5, 1e-4, 1e-3] {
        let (sine, cosine) = f64::sin_cos(tilt);
        let place = Vector::new(0.0, 1.1, 0.5 + 0.1 * cosine + 0.3 * sine - 0.001);
        let found = contacts(&plank, &Pose::new(&rotation(&Vector::x(), tilt), &place), &table, 0.0, false);
        assert!(!found.contacts.is_empty(), "{tilt}");
        for contact in &found.contacts {
            assert!(contact.manifold.lower >= -0.001 - 1e-9, "{tilt}: {contact:?}");
            assert!(contact.manifold.normal[2] > 0.999, "{tilt}: {contact:?}");
        }
    }
}

/// Triangles that stand twice change nothing for what lies on them, wherever their corners begin.
#[test]
fn doubled_triangles_push_as_one() {
    let vertices: Vec<Vector> = (0..36).map(|k| Vector::new((k / 6) as f64, (k % 6) as f64, 0.0)).collect();
    let cells = (0..5).flat_map(|i| (0..5).map(move |j| 6 * i + j));
    let once: Vec<[u32; 3]> = cells.flat_map(|a| [[a, a + 6, a + 7], [a, a + 7, a + 1]]).collect();
    let turned = once.iter().map(|[a, b, c]| [*b, *c, *a]);
    let body = cuboid([0.4, 0.3, 0.2]);
    let mut random = Random::new(0xd0b);
    for copies in [once.clone(), turned.collect()] {
        let twice: Vec<[u32; 3]> = once.iter().copied().chain(copies).collect();
        let ground = Ground::from_triangles(&vertices, &twice).unwrap();
        for _ in 0..300 {
            let place = Vector::new(random.uniform(0.6, 4.4), random.uniform(0.6, 4.4), 0.199);
            let pose = Pose::new(&rotation(&Vector::z(), random.uniform(0.0, 3.0)), &place);
            let found = contacts(&body, &pose, &ground, 0.001, false);
            let [contact] = found.contacts[..] else { panic!("{:?}", found.contacts) };
            assert!(contact.manifold.normal[2] > 0.999 && contact.manifold.lower >= -0.001 - 1e-9, "{contact:?}");
        }
    }
}

/// In a groove of steep walls a ball that has got behind one of them is pushed up, or not at all.
#[test]
fn nothing_is_pushed_down_in_a_groove() {
    let heights: Vec<f64> = (0..35).map(|k| f64::sqrt(3.0) * ((k % 5) as f64 - 2.0).abs()).collect();
    let grid = HeightGrid { rows: 7, columns: 5, spacing: [1.0; 2], heights: &heights };
    let (ground, place) = (Ground::from_heights(&grid).unwrap(), at(-2.0, -3.0, 0.0));
    let options = ShapeOptions { input: InputPolicy::Hull, swept_radius: 0.5, ..ShapeOptions::default() };
    let ball = Shape::from_points(&[Vector::zeros()], &options).unwrap();
    for step in 0..=48 {
        let angle = std::f64::consts::PI * f64::from(step) / 48.0;
        let pose = at(-0.4 * angle.sin() + 2.0, 0.3 + 3.0, 0.4 * angle.cos());
        let found = contacts(&ball, &pose, &ground, 0.0, false);
        let is_down = |normal: [f64; 3]| normal[2] <= 0.0;
        assert!(!found.contacts.iter().any(|contact| is_down(contact.manifold.normal)), "{place:?} {found:?}");
    }
}

/// On gentle hills four points hold up a body; each of two walls gets its own four.
#[test]
fn four_points_hold_up_a_body() {
    let mut random = Random::new(0x4f0);
    let mut most = 0;
    for _ in 0..20 {
        let (vertices, triangles) = super::hills(&mut random, 16, f64::tan(16_f64.to_radians()));
        let vertices: Vec<Vector> = vertices.iter().map(|vertex| vertex * 0.25).collect();
        let ground = Ground::from_triangles(&vertices, &triangles).unwrap();
        for _ in 0..20 {
            let place = Vector::new(random.uniform(1.2, 2.5), random.uniform(1.2, 2.5), 0.23);
            let pose = Pose::new(&rotation(&Vector::z(), random.uniform(0.0, 3.0)), &place);
            let all = contacts(&cuboid([0.5, 0.4, 0.25]), &pose, &ground, 0.02, false);
            let few = contacts(&cuboid([0.5, 0.4, 0.25]), &pose, &ground, 0.02, true);
            let deepest = |points: &[swiftprox::manifold::ManifoldPoint]| {
                points.iter().map(|point| point.gap_upper).fold(f64::INFINITY, f64::min)
            };
            assert!(few.points.len() <= 4, "{}", few.points.len());
            assert!((deepest(&all.points) - deepest(&few.points)).abs() < 1e-9);
            assert!(few.points.iter().all(|point| all.points.contains(point)));
            most = most.max(all.points.len());
        }
    }
    assert!(most > 12, "{most}");
}

/// Bodies at rest on hills tremble: of a thousand reduced points all but one are there in the next step. Corners of a drum tie:
/// chosen by the most alone, one of 400 was exchanged.
#[test]
fn points_at_rest_keep_their_ids() {
    let mut random = Random::new(0x1d5);
    let bodies = movers(&mut random);
    let (mut known, mut all) = (0, 0);
    for round in 0..180 {
        let (vertices, triangles) = super::hills(&mut random, 16, f64::tan(16_f64.to_radians()));
        let ground = Ground::from_triangles(&vertices, &triangles).unwrap();
        let shape = &bodies[round % bodies.len()];
        let (turn, tremble) = (random.rotation(), random.pick(&[1e-9, 1e-7, 1e-5]));
        let aside = [random.uniform(5.0, 10.0), random.uniform(5.0, 10.0)];
        // Down to a few thousandths of overlap.
        let overlaps = |z: f64| {
            let pose = Pose::new(&turn, &Vector::new(aside[0], aside[1], z));
            !contacts(shape, &pose, &ground, 0.0, true).points.is_empty()
        };
        let mut z = 4.0;
        while !overlaps(z) && z > -4.0 {
            z -= 3e-3;
        }
        let mut before: Vec<u64> = Vec::new();
        for _ in 0..40 {
            let place = Vector::new(aside[0], aside[1], z) + random.vector() * tremble;
            let pose = Pose::new(&(rotation(&random.direction(), tremble * random.signed()) * turn), &place);
            let ids: Vec<u64> =
                contacts(shape, &pose, &ground, 0.02, true).points.iter().map(|point| point.id).collect();
            if !before.is_empty() {
                all += ids.len();
                known += ids.iter().filter(|id| before.contains(id)).count();
            }
            before = ids;
        }
    }
    println!("{known} of {all}");
    assert!(all > 2000 && 1000 * (all - known) <= all, "{known} of {all}");
}

/// A triangular prism along y, as a ground: its ridge is at z = 0 and has this angle inside.
fn roof(angle: f64, cells: u32) -> Ground {
    let (drop, aside) = (4.0 * (0.5 * angle).cos(), 4.0 * (0.5 * angle).sin());
    let corners = [[0.0, 0.0], [-aside, -drop], [aside, -drop]];
    let mut vertices = Vec::new();
    for i in 0..=cells {
        let y = 8.0 * f64::from(i) / f64::from(cells) - 4.0;
        vertices.extend(corners.map(|[x, z]| Vector::new(x, y, z)));
    }
    let last = 3 * cells;
    let mut triangles = vec![[0, 1, 2], [last, last + 2, last + 1]];
    for a in (0..cells).map(|i| 3 * i) {
        let sides = [[0, 1], [1, 2], [2, 0]];
        triangles.extend(sides.iter().flat_map(|[k, l]| [[a + k, a + 3 + k, a + 3 + l], [a + k, a + 3 + l, a + l]]));
    }
    Ground::from_triangles(&vertices, &triangles).unwrap()
}

/// Boxes, planks, drums, capsules and rocks, about 1 across.
pub fn movers(random: &mut Random) -> Vec<Shape> {
    let drum: Vec<Vector> = (0..32)
        .map(|k| {
            let (sine, cosine) = f64::sin_cos(std::f64::consts::TAU * f64::from(k / 2) / 16.0);
            Vector::new(0.3 * cosine, 0.3 * sine, if k % 2 == 0 { -0.4 } else { 0.4 })
        })
        .collect();
    let rock: Vec<Vector> = (0..40).map(|_| random.direction() * 0.4).collect();
    let swept = |points: &[Vector], swept_radius: f64| {
        let options = ShapeOptions { input: InputPolicy::Hull, swept_radius, ..ShapeOptions::default() };
        Shape::from_points(points, &options).unwrap()
    };
    vec![
        cuboid([0.3, 0.4, 0.25]),
        cuboid([0.6, 0.12, 0.05]),
        hull(&drum),
        hull(&rock),
        swept(&[Vector::z() * 0.3, Vector::z() * -0.3], 0.2),
        swept(&[Vector::zeros()], 0.3),
    ]
}

fn distance(body: &Shape, pose: &Pose, ground: &Ground) -> f64 {
    let found = ground_distance(
        Query::Distance,
        body.at(pose),
        ground.at(&Pose::IDENTITY),
        &PairConfig { max_distance: f64::INFINITY, ..PairConfig::default() },
    );
    found.unwrap().answer.lower
}

/// Moves a body that is free along a direction until it touches, and in by a step; `None` if it passes by.
pub fn moved_in(body: &Shape, from: &Pose, direction: &Vector, step: f64, ground: &Ground) -> Option<Pose> {
    let along = |way: f64| Pose::new(&from.rotation(), &(from.translation() + direction * way));
    let mut way = 0.0;
    for _ in 0..300 {
        let gap = distance(body, &along(way), ground);
        if gap <= 1e-9 {
            return (way > 0.0).then(|| along(way + step));
        }
        way += gap;
        if way > 20.0 {
            return None;
        }
    }
    None
}

/// What a body that was moved in by a step is told: at least one contact, and none that is more than twice as deep as the step.
/// Moving along a contact by its depth frees the body of its triangle.
pub fn judge(body: &Shape, pose: &Pose, step: f64, ground: &Ground) -> Result<(), String> {
    let found = contacts(body, pose, ground, 0.0, false);
    if found.contacts.is_empty() && distance(body, pose, ground) == 0.0 {
        return Err("none".into());
    }
    for contact in &found.contacts {
        let normal = Vector::from(contact.manifold.normal);
        let out = Pose::new(&pose.rotation(), &(pose.translation() - normal * contact.manifold.lower));
        let is_same = |other: &&GroundContact| {
            other.triangle == contact.triangle && (Vector::from(other.manifold.normal) - normal).norm() < 1e-6
        };
        let after = contacts(body, &out, ground, 0.0, false);
        if let Some(again) = after.contacts.iter().find(is_same).filter(|again| again.manifold.upper < -1e-9) {
            return Err(format!("deep again: {contact:?} {again:?}"));
        }
    }
    match found.contacts.iter().find(|contact| contact.manifold.lower < -2.0 * step - 1e-9) {
        Some(contact) => Err(format!("{:.1} times: {contact:?}", -contact.manifold.lower / step)),
        None => Ok(()),
    }
}

/// The movers of many kinds, from outside onto grounds; how many were judged, and what was wrong.
pub fn judge_all(random: &mut Random, ground: &Ground, reach: f64, count: usize, step: f64) -> (usize, Vec<String>) {
    let (bodies, mut wrong, mut judged) = (movers(random), Vec::new(), 0);
    for round in 0..count {
        let body = &bodies[round % bodies.len()];
        let target = Vector::new(random.signed(), random.signed(), random.signed()) * reach;
        let from = random.direction() * (3.0 * reach + 6.0);
        let turn = match random.below(3) {
            0 => random.rotation(),
            1 => rotation(&Vector::z(), random.uniform(0.0, 3.0)),
            _ => rotation(&random.direction(), random.power(-20, -3)),
        };
        let start = Pose::new(&turn, &from);
        let Some(pose) = moved_in(body, &start, &(target - from).normalize(), step, ground) else { continue };
        judged += 1;
        if let Err(what) = judge(body, &pose, step, ground) {
            wrong.push(format!("round {round} body {}: {what} at {pose:?}", round % bodies.len()));
        }
    }
    (judged, wrong)
}

#[test]
fn no_body_is_kicked_on_a_roof() {
    let mut random = Random::new(0x400f);
    let (mut judged, mut wrong) = (0, Vec::new());
    for angle in [30.0, 45.0, 60.0, 75.0, 90.0, 105.0, 120.0, 135.0, 150.0] {
        for cells in [1, 7] {
            let ground = roof(f64::to_radians(angle), cells);
            let (own, bad) = judge_all(&mut random, &ground, 1.0, 90, 0.005);
            judged += own;
            wrong.extend(bad.into_iter().map(|what| format!("{angle}° in {cells}, {what}")));
        }
    }
    println!("{judged} judged, {} wrong", wrong.len());
    wrong.iter().take(5).for_each(|what| println!("{what}"));
    assert!(judged > 1000 && wrong.is_empty(), "{judged} {}", wrong.len());
}
