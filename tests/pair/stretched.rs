//! Bodies stretched, flattened and crumpled within their rounding: faces merge whose vertices are not in one plane, and edges are
//! short beside their faces. Any pair of features is forced on the search to begin with, near it or far from it, so that every
//! quick look is taken at what it was not made for. The truth is the exact tier's, the proof is checked by `verify`.
//!
//! `STRETCHED_SEED` and `STRETCHED_COUNT` make other runs.

use std::sync::Mutex;
use std::sync::atomic::{AtomicU64, Ordering};

use swiftprox::body::polyhedron::Polyhedron;
use swiftprox::math::{Matrix, Pose, Vector};
use swiftprox::pair::contact;
use swiftprox::pair::{DecidedBy, Outcome, PairAnswer, PairCache, PairConfig, distance, intersection};
use swiftprox::placed::Pair;
use swiftprox::placed::exact::{ExactAnswer, solve};
use swiftprox::shape::{InputPolicy, Shape, ShapeOptions};
use swiftprox::verify::verify;
use testkit::caches::cache_of_features;
use testkit::random::Random;

/// Of the first 4,189 pairs two find the hole that `slack_of_leaning` closes (src/body/build/assembly/layout.rs).
const COUNT: u64 = 4_000;

/// Pairs of features forced on each pair of bodies.
const STARTS: usize = 12;

#[test]
fn every_pair_of_features_leads_to_the_truth() {
    let setting = |name: &str, default| std::env::var(name).map_or(default, |text| text.parse().expect("a number"));
    let (seed, count) = (setting("STRETCHED_SEED", 1), setting("STRETCHED_COUNT", COUNT));
    let next = AtomicU64::new(1);
    let total = Mutex::new(Tally::default());
    let work = || {
        let mut tally = Tally::default();
        loop {
            let number = next.fetch_add(1, Ordering::Relaxed);
            if number > count {
                break;
            }
            let random = Random::new(seed.wrapping_mul(1_000_003).wrapping_add(number));
            check_pair(random, &mut tally, &format!("seed {seed}, pair {number}"));
        }
        let mut total = total.lock().expect("no panic");
        total.queries += tally.queries;
        total.separated += tally.separated;
        total.marched += tally.marched;
        total.violations.append(&mut tally.violations);
    };
    std::thread::scope(|scope| {
        scope.spawn(work);
        work();
    });
    let Tally { queries, separated, marched, violations } = total.into_inner().expect("no panic");
    println!("{queries} queries, {separated} separated, {marched} marched");
    for violation in violations.iter().take(20) {
        println!("{violation}\n");
    }
    assert!(violations.is_empty(), "{} violations", violations.len());
    // Otherwise they would test little.
    assert!(separated > queries / 5 && marched > separated / 2);
}

#[derive(Default)]
struct Tally {
    queries: u64,
    separated: u64,
    /// Of the separated.
    marched: u64,
    violations: Vec<String>,
}

/// One pair of bodies, from a cold cache and from any pairs of features.
fn check_pair(mut random: Random, tally: &mut Tally, name: &str) {
    let random = &mut random;
    let options = ShapeOptions { input: InputPolicy::Hull, ..ShapeOptions::default() };
    let shapes = [(); 2].map(|()| Shape::from_points(&body(random), &options).expect("finite points"));
    let polyhedra = [shapes[0].polyhedron(), shapes[1].polyhedron()];
    let poses = near_each_other(random, polyhedra);
    let truth = solve(&Pair { polyhedra, poses: [&poses[0], &poses[1]] }, &[]);
    let mut config = PairConfig::default();
    if random.below(4) == 0 {
        config.max_distance = [truth.lower, truth.upper][random.below(2)] * [1.0, random.power(-2, 2)][random.below(2)];
    }
    for start in 0..3 + STARTS {
        let forced = if start < 3 { Some(PairCache::default()) } else { any_features(random, polyhedra) };
        let Some(mut cache) = forced else { continue };
        let query = [distance, intersection, contact][if start < 3 { start } else { random.below(3) }];
        let mut answer = PairAnswer::default();
        query([shapes[0].at(&poses[0]), shapes[1].at(&poses[1])], &mut cache, &config, &mut answer)
            .expect("accepted poses");
        let is_separated = answer.outcome != Outcome::Intersecting;
        tally.queries += 1;
        tally.separated += u64::from(is_separated);
        tally.marched += u64::from(is_separated && answer.decided_by == DecidedBy::Marching);
        if let Err(what) = check_answer(&answer, &truth, config.max_distance) {
            tally.violations.push(format!("{name}: {what}: {answer:?}, the truth is {truth:?}"));
        }
        if let Err(error) = verify([shapes[0].at(&poses[0]), shapes[1].at(&poses[1])], &answer) {
            tally.violations.push(format!("{name}: {error}: {answer:?}"));
        }
    }
}

fn check_answer(answer: &PairAnswer, truth: &ExactAnswer, max_distance: f64) -> Result<(), &'static str> {
    if (answer.outcome == Outcome::Intersecting) != truth.intersecting {
        return Err("the verdict is wrong");
    }
    if (answer.outcome == Outcome::Beyond) != (truth.upper > max_distance) {
        return Err("the distance tolerance is decided wrongly");
    }
    if answer.lower > truth.upper || answer.upper < truth.lower {
        return Err("the interval is wrong");
    }
    Ok(())
}

/// Some points; stretched, with one of them far out, crumpled, a crumpled plate, turned, of any size, or not.
fn body(random: &mut Random) -> Vec<Vector> {
    let mut points = base(random);
    for _ in 0..random.below(3) {
        let (axis, factor) = (random.below(3), random.power(-50, 50));
        points.iter_mut().for_each(|p| p[axis] *= factor);
    }
    if random.below(3) == 0 {
        let (far, axis) = (random.below(points.len()), random.below(3));
        points[far][axis] *= random.power(0, 50);
    }
    let radius = points.iter().map(|p| p.norm()).fold(0.0, f64::max);
    // From an eighth of a rounding to 64: more than what still merges (`build::merge::merge_bound`).
    let depth = radius * random.power(-56, -46);
    match random.below(4) {
        0 => points.iter_mut().for_each(|p| *p += depth * random.vector()),
        1 => {
            let across = random.below(3);
            points.iter_mut().for_each(|p| p[across] = depth * random.signed());
        }
        _ => {}
    }
    if random.below(2) == 0 {
        let rotation = random.rotation();
        points.iter_mut().for_each(|p| *p = rotation * *p);
    }
    let size = [radius, 1.0, random.power(-10, 10)][random.below(3)];
    points.iter().map(|p| p * (size / radius)).collect()
}

/// Points around or within 1 of the origin.
fn base(random: &mut Random) -> Vec<Vector> {
    let count = 3 + random.below(6);
    match random.below(6) {
        0 => prism(random, count),
        1 => {
            let side = |k: usize, bit: usize| if k >> bit & 1 == 0 { -1.0 } else { 1.0 };
            let mut points: Vec<Vector> = (0..8).map(|k| Vector::from_fn(|axis, _| side(k, axis))).collect();
            for _ in 0..random.below(4) {
                let mut on_face = random.vector();
                on_face[random.below(3)] = 1.0;
                points.push(on_face);
            }
            points
        }
        2 => (0..=count).map(|_| random.vector()).collect(),
        3 => {
            let mut points: Vec<Vector> = (0..=count).map(|_| random.lattice(2)).collect();
            points.push(Vector::x());
            points
        }
        4 => {
            // A needle, flat or not, two of its long sides so near each other that rounding may make them diverge.
            let blunt = random.power(-40, -10) * random.direction();
            let mut points = vec![random.direction(), blunt, blunt + random.power(-57, -10) * random.vector()];
            points.extend((0..random.below(2)).map(|_| 0.1 * random.vector()));
            points
        }
        _ => {
            // Short sides in a row.
            let short = random.power(-40, -1);
            let at = |k: f64, along: f64| Vector::new(1.0 - short * k * k, short * k * along, 0.0);
            let mut points: Vec<Vector> = (0..count).map(|k| at(k as f64, random.power(0, 6))).collect();
            points.extend([(); 3].map(|()| random.vector()));
            points
        }
    }
}

/// A regular polygon or nearly, with another above it, a tip, or next to none.
fn prism(random: &mut Random, count: usize) -> Vec<Vector> {
    let height = [random.power(-40, 0), 1.0, random.power(-30, 0)];
    let kind = random.below(3);
    let mut points = Vec::new();
    for k in 0..count {
        let shift = if random.below(3) == 0 { 0.45 * random.signed() } else { 0.0 };
        let angle = (k as f64 + shift) / count as f64 * std::f64::consts::TAU;
        let corner = Vector::new(angle.cos(), angle.sin(), 0.0);
        points.push(corner);
        if kind > 0 {
            points.push(corner + Vector::z() * height[kind]);
        }
    }
    if kind == 0 {
        points.push(Vector::z() * height[kind]);
    }
    points
}

/// Poses, skewed ones among them, that bring a point of one surface to a point of the other, or some way off.
fn near_each_other(random: &mut Random, polyhedra: [&Polyhedron; 2]) -> [Pose; 2] {
    let mut rotations = [(); 2].map(|()| match random.below(4) {
        0 => Matrix::identity(),
        1 => random.quarter_turns(),
        _ => random.rotation(),
    });
    if random.below(3) == 0 {
        rotations[1] = rotations[0];
    }
    if random.below(4) == 0 {
        let skew = random.power(-46, -9);
        rotations.iter_mut().flat_map(|rotation| rotation.iter_mut()).for_each(|x| *x += skew * random.signed());
    }
    let [point1, point2] = polyhedra.map(|polyhedron| surface_point(random, polyhedron));
    let [small, large] = {
        let [radius1, radius2] = polyhedra.map(|polyhedron| polyhedron.radius);
        [radius1.min(radius2), radius1.max(radius2)]
    };
    let gap = match random.below(4) {
        0 => 0.0,
        1 => large * random.power(-54, 3),
        2 => random.power(-30, 3),
        _ => small * random.power(-40, 4),
    };
    let place = if random.below(2) == 0 { Vector::zeros() } else { small * random.power(-5, 30) * random.vector() };
    let pose1 = Pose::new(&rotations[0], &place);
    // A needle's tip is looked at along the needle.
    let direction = match polyhedra[1].edges.len() {
        edges @ 1.. if random.below(3) == 0 => {
            let edge = &polyhedra[1].edges[random.below(edges)];
            rotations[1] * polyhedra[1].direction_to(edge.tail(), edge.head())
        }
        _ => random.direction(),
    };
    let translation = pose1.transform(&point1) + gap * direction - rotations[1] * point2;
    [pose1, Pose::new(&rotations[1], &translation)]
}

/// A vertex, or a point of an edge or a triangle.
fn surface_point(random: &mut Random, polyhedron: &Polyhedron) -> Vector {
    let vertex = |v: u32| polyhedron.local_position(v);
    let (s, t) = (random.uniform(0.0, 1.0), random.uniform(0.0, 1.0));
    match random.below(4) {
        1 if !polyhedron.edges.is_empty() => {
            let edge = &polyhedron.edges[random.below(polyhedron.edges.len())];
            vertex(edge.tail()).lerp(&vertex(edge.head()), t)
        }
        2 | 3 if !polyhedron.triangles.is_empty() => {
            let [a, b, c] = polyhedron.triangles[random.below(polyhedron.triangles.len())].map(vertex);
            a.lerp(&b, s).lerp(&c, t)
        }
        _ => vertex(random.below(polyhedron.vertices.len()) as u32),
    }
}

/// The cache of any pair of features of which marching knows the kind, if the bodies have such.
fn any_features(random: &mut Random, polyhedra: [&Polyhedron; 2]) -> Option<PairCache> {
    // The dimensions of the features of the kinds 1 to 6.
    const DIMENSIONS: [[usize; 2]; 6] = [[0, 0], [0, 1], [1, 0], [0, 2], [2, 0], [1, 1]];
    let kind = random.below(6);
    let counts: [usize; 2] = std::array::from_fn(|i| {
        let Polyhedron { vertices, edges, faces, .. } = polyhedra[i];
        [vertices.len(), edges.len(), faces.len()][DIMENSIONS[kind][i]]
    });
    let exist = counts.iter().all(|count| *count > 0);
    exist.then(|| cache_of_features(kind as u32 + 1, counts.map(|count| random.below(count) as u32)))
}
