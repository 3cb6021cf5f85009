//! Meshes that are flat only up to the noise of their coordinates have the manifolds of the meshes that were meant.

use super::{ALL, query};
use std::fs;
use swiftprox::body::polyhedron::FacePart;
use swiftprox::manifold::{Manifold, ManifoldCache, ManifoldConfig, ManifoldPoint};
use swiftprox::math::{Matrix, Pose, Vector};
use swiftprox::pair::{
    DepthAnswer, DepthCache, DepthConfig, Outcome, PairAnswer, PairCache, PairConfig, depth, distance,
};
use swiftprox::shape::{InputPolicy, Shape, ShapeOptions};
use swiftprox::shape_file::{from_bytes, to_bytes};
use testkit::models;
use testkit::random::{Random, rotation};
use testkit::shapes::{cuboid, hull, lattice_box};

/// What becomes of coordinates.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Noise {
    /// Off by up to so much.
    Amplitude(f64),
    Single,
    Decimals(i32),
}

impl Noise {
    fn of(self, x: f64, random: &mut Random) -> f64 {
        match self {
            Noise::Amplitude(most) => x + most * random.signed(),
            Noise::Single => f64::from(x as f32),
            Noise::Decimals(decimals) => {
                let power = 10_f64.powi(decimals);
                (x * power).round() / power
            }
        }
    }

    /// What is to be said of it, where it cannot be told from the coordinates.
    fn option(self) -> Option<f64> {
        match self {
            Noise::Amplitude(most) if most > 1e-6 => Some(most),
            Noise::Decimals(4) => Some(0.5e-4),
            _ => None,
        }
    }
}

const NOISES: [Noise; 9] = [
    Noise::Amplitude(0.0),
    Noise::Amplitude(1e-15),
    Noise::Amplitude(1e-12),
    Noise::Amplitude(1e-9),
    Noise::Single,
    Noise::Decimals(9),
    Noise::Decimals(6),
    Noise::Decimals(4),
    Noise::Amplitude(1e-5),
];

fn prism(sides: usize, radius: f64, half_height: f64) -> Vec<Vector> {
    let unit = models::prism(sides as u32, half_height).unwrap().vertices;
    unit.iter().map(|p| Vector::new(radius * p.x, radius * p.y, p.z)).collect()
}

/// A body whose lower and upper faces are known.
struct Ideal {
    name: &'static str,
    points: Vec<Vector>,
    half_height: f64,
    area: f64,
    corners: usize,
}

fn ideals() -> Vec<Ideal> {
    let regular = |name, sides: usize, radius: f64, half_height: f64| {
        let angle = std::f64::consts::TAU / sides as f64;
        let area = 0.5 * sides as f64 * radius * radius * angle.sin();
        Ideal { name, points: prism(sides, radius, half_height), half_height, area, corners: sides }
    };
    let lattice = |name, half: [f64; 3], along| Ideal {
        name,
        points: lattice_box(half, along),
        half_height: half[2],
        area: 4.0 * half[0] * half[1],
        corners: 4,
    };
    vec![
        lattice("cube", [0.5; 3], 2),
        lattice("plate", [1.0, 0.8, 0.05], 2),
        lattice("plate on edge", [0.5, 0.01, 0.5], 2),
        lattice("lattice", [0.5, 0.4, 0.3], 5),
        regular("prism", 6, 0.6, 0.4),
        regular("drum", 48, 0.5, 0.5),
    ]
}

/// The shape of points that have been turned and then come by their noise, and the pose that turns it back.
fn noisy(points: &[Vector], noise: Noise, random: &mut Random) -> (Shape, Matrix) {
    let turn = random.rotation();
    let off: Vec<Vector> = points.iter().map(|p| (turn * p).map(|x| noise.of(x, random))).collect();
    let options = ShapeOptions { input: InputPolicy::Hull, face_noise: noise.option(), ..Default::default() };
    (Shape::from_points(&off, &options).unwrap(), turn.transpose())
}

/// The area of a convex polygon's corners, given in any order, across z.
fn area_of(points: &[ManifoldPoint]) -> f64 {
    let mut corners: Vec<Vector> = points.iter().map(|point| Vector::from(point.world1)).collect();
    let middle = corners.iter().sum::<Vector>() / corners.len() as f64;
    corners.sort_by(|a, b| (a - middle).y.atan2((a - middle).x).total_cmp(&(b - middle).y.atan2((b - middle).x)));
    let next = corners.iter().cycle().skip(1);
    corners.iter().zip(next).map(|(a, b)| 0.5 * (a.x * b.y - a.y * b.x)).sum()
}

/// What thin triangles leave of the heights of lines, in doubles.
const THIN: f64 = 1e-8;

/// Heights over which a line along an axis is in a body, right to 2·[`THIN`].
fn heights(shape: &Shape, pose: &Pose, through: &Vector, axis: &Vector) -> Option<[f64; 2]> {
    let polyhedron = shape.polyhedron();
    let at = |v: u32| pose.transform(&(polyhedron.centre + polyhedron.vertices[v as usize].position)) - through;
    let mut range = [f64::NEG_INFINITY, f64::INFINITY];
    for triangle in &polyhedron.triangles {
        let [a, b, c] = triangle.map(at);
        let normal = (b - a).cross(&(c - a));
        if normal.norm() < THIN * (b - a).norm().max((c - b).norm()).max((a - c).norm()) {
            continue;
        }
        let (rise, offset) = (normal.dot(axis), normal.dot(&a));
        let height = offset / rise;
        if rise > 0.0 {
            range[1] = range[1].min(height);
        } else if rise < 0.0 {
            range[0] = range[0].max(height);
        } else if offset < 0.0 {
            return None;
        }
    }
    (range[0] <= range[1]).then_some(range)
}

/// How far body 1 is beyond body 2 along the normal: the gap of support planes.
fn gap_of_support_planes(shapes: [&Shape; 2], poses: [&Pose; 2], normal: &Vector) -> f64 {
    let reach = |i: usize, direction: Vector| {
        let polyhedron = shapes[i].polyhedron();
        let place = |v: u32| poses[i].transform(&(polyhedron.centre + polyhedron.vertices[v as usize].position));
        (0..polyhedron.vertices.len() as u32).map(|v| direction.dot(&place(v))).fold(f64::NEG_INFINITY, f64::max)
    };
    -reach(0, -normal) - reach(1, *normal)
}

/// Whether the true gap of the surfaces is in a point's interval, a hundredth of the way towards the middle of all: at the point
/// itself a line may miss a body, or graze sides that are upright up to noise and cross it anywhere. Between planes a gap is
/// linear. `None` where a line misses all the same. A single point has no such way; it is the witness points, where the gap is
/// that of support planes.
fn holds(
    shapes: [&Shape; 2],
    poses: [&Pose; 2],
    answer: &Manifold,
    points: &[ManifoldPoint],
    point: &ManifoldPoint,
) -> Option<bool> {
    const INWARDS: f64 = 0.01;
    let normal = Vector::from(answer.normal);
    if points.len() == 1 {
        let gap = gap_of_support_planes(shapes, poses, &normal);
        return Some(point.gap_lower - 4.0 * THIN <= gap && gap <= point.gap_upper + 4.0 * THIN);
    }
    let place = |point: &ManifoldPoint| (Vector::from(point.world1) + Vector::from(point.world2)) * 0.5;
    let gap_at = |point: &ManifoldPoint| 0.5 * (point.gap_lower + point.gap_upper);
    let count = points.len() as f64;
    let middle = points.iter().map(place).sum::<Vector>() / count;
    let gap_in_middle = points.iter().map(gap_at).sum::<f64>() / count;
    let through = place(point) * (1.0 - INWARDS) + middle * INWARDS;
    let expected = gap_at(point) * (1.0 - INWARDS) + gap_in_middle * INWARDS;
    let [first, second] = [0, 1].map(|i| heights(shapes[i], poses[i], &through, &normal));
    let gap = first?[0] - second?[1];
    Some((gap - expected).abs() <= 0.5 * (point.gap_upper - point.gap_lower) + 4.0 * THIN)
}

/// The faces that manifolds are made over.
fn patches(shape: &Shape) -> usize {
    let (polyhedron, contact) = (shape.polyhedron(), &shape.polyhedron().contact_faces);
    let is_whole = |face: &u32| contact.part(*face) == FacePart::Whole;
    contact.faces.len() + (0..polyhedron.faces.len() as u32).filter(is_whole).count()
}

/// Noisy bodies over larger ones, some in each other and some apart.
fn good_turns(turns: usize) {
    let mut random = Random::new(12);
    let config = ManifoldConfig { max_distance: 0.05, ..ALL };
    let (mut all, mut good, mut rays, mut missed) = (0, 0, 0, 0);
    for ideal in ideals() {
        for noise in NOISES {
            let (mut worst, mut here) = (0.0_f64, 0);
            for turn in 0..turns {
                let larger: Vec<Vector> = ideal.points.iter().map(|p| p * 2.0).collect();
                let (upper, stands) = noisy(&ideal.points, noise, &mut random);
                let (lower, lies) = noisy(&larger, noise, &mut random);
                let gap = if turn % 2 == 0 { -0.003 } else { 0.002 };
                let spin = rotation(&Vector::z(), 0.3 * random.signed());
                // On the larger the smaller has room; the plate on edge does not turn.
                let away = Vector::new(0.01, 0.003 * random.signed(), 3.0 * ideal.half_height + gap);
                let spin = if ideal.name == "plate on edge" { Matrix::identity() } else { spin };
                let poses = [Pose::new(&(spin * stands), &away), Pose::new(&lies, &Vector::zeros())];
                let placed = [&poses[0], &poses[1]];
                let (answer, points) = query([&upper, &lower], placed, &mut ManifoldCache::default(), &config);
                let off = (area_of(&points).abs() / ideal.area - 1.0).abs();
                worst = worst.max(off);
                here += usize::from(off <= 0.01 && points.len() == ideal.corners);
                all += 1;
                for point in &points {
                    rays += 1;
                    match holds([&upper, &lower], placed, &answer, &points, point) {
                        Some(holds) => assert!(holds, "{} {noise:?} {point:?}", ideal.name),
                        None => missed += 1,
                    }
                }
            }
            println!(
                "{:14} {:18} {here} of {turns} good, worst area off by {worst:.2e}",
                ideal.name,
                format!("{noise:?}")
            );
            good += here;
        }
    }
    println!("{good} of {all} good; {missed} of {rays} lines miss a body");
    assert!(good as f64 >= 0.999 * all as f64);
}

#[test]
fn noisy_meshes_have_the_manifolds_of_the_meshes_that_were_meant() {
    good_turns(20);
}

/// The same with fifty times as many turns, for changes of contact faces:
/// `cargo test --profile checked --test manifold -- --ignored`.
#[test]
#[ignore = "takes a minute; the twenty turns above are a sample of it"]
fn noisy_meshes_over_a_thousand_turns() {
    good_turns(1_000);
}

/// A lattice box of 98 points over a cuboid: its manifold is its lower face's.
fn check_lattice_boxes(noise: Noise, turns: usize) {
    let mut random = Random::new(17);
    let lattice = lattice_box([0.5, 0.4, 0.3], 5);
    let floor = cuboid([1.0, 0.8, 0.6]);
    for turn in 0..turns {
        let (upper, stands) = noisy(&lattice, noise, &mut random);
        let spin = rotation(&Vector::z(), 0.3 * random.signed());
        let pose = Pose::new(&(spin * stands), &Vector::new(0.01, 0.0, 0.902));
        let placed = [&pose, &Pose::IDENTITY];
        let config = ManifoldConfig { max_distance: 0.05, ..ALL };
        let (answer, points) = query([&upper, &floor], placed, &mut ManifoldCache::default(), &config);
        assert_eq!(answer.outcome, Outcome::Separated, "{turn}");
        assert!((area_of(&points) / 0.8 - 1.0).abs() < 0.01, "{turn} {points:?}");
        for point in &points {
            assert_ne!(holds([&upper, &floor], placed, &answer, &points, point), Some(false), "{turn} {point:?}");
        }
    }
}

/// A lattice box whose coordinates are off by rounding has vertices, on the face away from the other body, whose neighbours are all
/// as high up to rounding. The climb to the face towards the other body ended there, and in 6 of 1,000 turns the manifold was one
/// point.
#[test]
fn a_climb_that_ends_on_the_far_face_is_seen() {
    check_lattice_boxes(Noise::Amplitude(1e-15), 600);
}

/// A vertex on an edge of a lattice box that is turned and no more has slivers between itself and a face next to it. That face was
/// not found from there, and in 10 of 1,000 turns the manifold was that of the other face: two points.
#[test]
fn a_vertex_that_slivers_keep_from_its_face_finds_it() {
    check_lattice_boxes(Noise::Amplitude(0.0), 1_000);
}

/// An STL file of a turned drum, written with the digits that such files have.
#[test]
fn a_drum_from_an_stl_file_has_all_its_corners() {
    let path = std::path::Path::new(env!("CARGO_TARGET_TMPDIR")).join("contact_faces.stl");
    let mut random = Random::new(13);
    for _ in 0..10 {
        let turn = random.rotation();
        let there = Vector::new(0.1, -0.2, 0.3);
        let drum = hull(&prism(48, 0.5, 0.5));
        let mut text = String::from("solid drum\n");
        for triangle in &drum.polyhedron().triangles {
            text += "facet normal 0 0 0\nouter loop\n";
            for v in triangle {
                let p = turn * drum.polyhedron().local_position(*v) + there;
                text += &format!("vertex {:.6e} {:.6e} {:.6e}\n", p.x, p.y, p.z);
            }
            text += "endloop\nendfacet\n";
        }
        text += "endsolid drum\n";
        fs::write(&path, text).unwrap();
        let shape = Shape::from_file(&path, &ShapeOptions { input: InputPolicy::Hull, ..Default::default() }).unwrap();
        let back = turn.transpose();
        let pose = Pose::new(&back, &(Vector::new(0.0, 0.0, 1.0 - 1e-3) - back * there));
        let floor = cuboid([2.0, 2.0, 0.5]);
        let placed = [&pose, &Pose::IDENTITY];
        let (answer, points) = query([&shape, &floor], placed, &mut ManifoldCache::default(), &ALL);
        assert_eq!((answer.outcome, points.len()), (Outcome::Intersecting, 48));
    }
}

/// A sphere of 10,242 vertices is round.
#[test]
fn round_bodies_have_no_false_faces() {
    let golden = (1.0 + 5_f64.sqrt()) / 2.0;
    let mut mesh = hull(
        &[-1.0, 1.0]
            .into_iter()
            .flat_map(|a| [-golden, golden].map(|b| [[0.0, a, b], [a, b, 0.0], [b, 0.0, a]]))
            .flatten()
            .map(|p| Vector::from(p).normalize())
            .collect::<Vec<_>>(),
    );
    for _ in 0..5 {
        let polyhedron = mesh.polyhedron();
        let place = |v: u32| polyhedron.local_position(v);
        let middles = polyhedron.triangles.iter().flat_map(|t| [[t[0], t[1]], [t[1], t[2]], [t[2], t[0]]]);
        let middles = middles.filter(|[a, b]| a < b).map(|[a, b]| (place(a) + place(b)).normalize());
        let points: Vec<Vector> = (0..polyhedron.vertices.len() as u32).map(place).chain(middles).collect();
        mesh = hull(&points);
    }
    let points: Vec<Vector> = (0..10_242).map(|v| mesh.polyhedron().local_position(v)).collect();
    let mut random = Random::new(14);
    for noise in [Noise::Amplitude(0.0), Noise::Single, Noise::Decimals(6), Noise::Amplitude(1e-5)] {
        let (shape, _) = noisy(&points, noise, &mut random);
        assert_eq!(shape.polyhedron().contact_faces.faces.len(), 0, "{noise:?}");
    }
}

/// What queries of distance and depth say does not hang on the option: not a bit.
#[test]
fn distance_and_depth_do_not_look_at_contact_faces() {
    let mut random = Random::new(15);
    for round in 0..200 {
        let turn = random.rotation();
        let points: Vec<Vector> = prism(12, 0.5, 0.5).iter().map(|p| (turn * p).map(|x| f64::from(x as f32))).collect();
        let make = |face_noise| {
            let options = ShapeOptions { input: InputPolicy::Hull, face_noise, ..Default::default() };
            Shape::from_points(&points, &options).unwrap()
        };
        let shapes = [make(Some(0.0)), make(None)];
        assert!(shapes[0].polyhedron().contact_faces.faces.is_empty());
        assert_eq!(patches(&shapes[1]), 14);
        let poses = [Pose::new(&random.rotation(), &(random.direction() * 0.9)), Pose::IDENTITY];
        let answers = shapes.each_ref().map(|shape| {
            let bodies = || [shape.at(&poses[0]), shape.at(&poses[1])];
            let (mut near, mut deep) = (PairAnswer::default(), DepthAnswer::default());
            distance(bodies(), &mut PairCache::default(), &PairConfig::default(), &mut near).unwrap();
            depth(bodies(), &mut DepthCache::default(), &DepthConfig::default(), &mut deep).unwrap();
            format!("{near:?} {deep:?}")
        });
        assert_eq!(answers[0], answers[1], "{round}");
    }
}

#[test]
fn a_saved_shape_keeps_its_noise_and_its_contact_faces() {
    let mut random = Random::new(16);
    let (shape, _) = noisy(&prism(48, 0.5, 0.5), Noise::Decimals(4), &mut random);
    let contact = &shape.polyhedron().contact_faces;
    assert_eq!((contact.noise, patches(&shape)), (0.5e-4, 50));
    let loaded = from_bytes(&to_bytes(&shape).unwrap()).unwrap();
    assert_eq!(loaded.polyhedron().contact_faces, *contact);
    assert_eq!(loaded, shape);
    let larger = shape.scaled(4.0, &mut swiftprox::progress::Progress::new(&mut |_| true)).unwrap();
    assert_eq!(larger.polyhedron().contact_faces.noise, 2e-4);
    assert_eq!(larger.polyhedron().contact_faces.corners, contact.corners);
}

#[test]
fn a_noise_that_is_no_length_is_refused() {
    for face_noise in [f64::NAN, f64::INFINITY, -1.0] {
        let options = ShapeOptions { face_noise: Some(face_noise), ..Default::default() };
        let refused = Shape::from_points(&prism(6, 1.0, 1.0), &options).unwrap_err();
        assert!(refused.message().contains("it must be finite and at least 0"), "{refused:?}");
    }
    // The largest makes one face of nothing: no triangle has a plane to tell.
    let options = ShapeOptions { face_noise: Some(f64::MAX), ..Default::default() };
    let shape = Shape::from_points(&prism(6, 1.0, 1.0), &options).unwrap();
    assert!(shape.polyhedron().contact_faces.faces.is_empty());
}
