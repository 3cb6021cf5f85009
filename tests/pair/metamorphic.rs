//! The same pair told in other ways, over bodies on both sides of every size threshold of the library: scaled by powers of two,
//! vertices permuted and duplicated, bodies swapped, moved in their own frames and in the world without rounding. The verdict
//! stays, intervals have a point in common, and every label names the vertex or face that it did.

use swiftprox::body::build::hull::convex_hull;
use swiftprox::math::{Matrix, Pose, Vector, power_of_two};
use swiftprox::mesh::PolygonMesh;
use swiftprox::pair::contact;
use swiftprox::pair::{Levels, Outcome, PairAnswer, PairCache, PairConfig, approximate, distance, intersection};
use swiftprox::shape::{Shape, ShapeOptions};
use testkit::models::spiral;
use testkit::random::Random;
use testkit::retold::{renumbered, shifted_exactly, shuffled};
use testkit::shapes::hull;

/// Exponents of the scaling: about the sizes from which bodies are laid out at another (2^±200), those that expansions do not
/// reach beside others (2⁻³⁰⁰), where squares and products of three lengths overflow (2^±512, 2^±341), and the ends.
const EXPONENTS: [i32; 20] =
    [-900, -700, -513, -400, -342, -301, -299, -203, -198, -1, 1, 198, 203, 299, 301, 342, 400, 513, 700, 900];

/// How far the middles of the bodies, whose radii are about 1, are apart: in few bits, as all coordinates are.
const PLACEMENTS: [f64; 6] = [0.25, 1.5, 1.953_125, 2.0, 2.0 + 1.0 / 1024.0, 7.5];

/// What is told in another way, beyond the scale.
#[derive(Debug, Clone, Copy, Default)]
struct Retelling {
    exponent: i32,
    permuted: bool,
    duplicated: bool,
    swapped: bool,
    /// Vertices moved in their own frame, the pose back.
    off_centre: bool,
    /// Both bodies moved in the world.
    moved: bool,
}

impl Retelling {
    const NOTHING: Retelling =
        Retelling { exponent: 0, permuted: false, duplicated: false, swapped: false, off_centre: false, moved: false };

    fn any(exponent: i32, random: &mut Random) -> Retelling {
        let mut coin = || random.below(2) == 0;
        Retelling { exponent, permuted: coin(), duplicated: coin(), swapped: coin(), off_centre: coin(), moved: coin() }
    }

    fn offset(&self) -> Vector {
        if self.off_centre { Vector::new(8.0, -5.25, 3.0) } else { Vector::zeros() }
    }

    fn points(&self, points: &[Vector], random: &mut Random) -> Vec<Vector> {
        let mut told = points.to_vec();
        if self.duplicated {
            told.extend((0..points.len() / 4 + 1).map(|_| points[random.below(points.len())]));
        }
        if self.permuted {
            told = shuffled(&told, random);
        }
        told.iter().map(|p| (p + self.offset()) * power_of_two(self.exponent)).collect()
    }

    fn poses(&self, placement: f64) -> [Pose; 2] {
        let turn = Matrix::new(0.0, -1.0, 0.0, 0.0, 0.0, -1.0, 1.0, 0.0, 0.0);
        let step = if self.moved { Vector::new(-3.5, 40.0, 0.125) } else { Vector::zeros() };
        let direction = Vector::new(1.0, 0.0, 0.0) * placement;
        [(turn, Vector::zeros()), (Matrix::identity(), direction)].map(|(turn, at)| {
            let back = Pose::new(&turn, &(at - turn * self.offset()));
            let pose = shifted_exactly(&back, &step).expect("few bits");
            Pose::new(&turn, &(pose.translation() * power_of_two(self.exponent)))
        })
    }
}

/// Answers of all queries to all placements, the interval in units of the scale.
fn answers(shape: &Shape, how: &Retelling, with_levels: bool) -> Vec<(Outcome, f64, f64)> {
    let mut told = Vec::new();
    for placement in PLACEMENTS {
        let mut poses = how.poses(placement);
        if how.swapped {
            poses.reverse();
        }
        let mut cache = PairCache::default();
        for query in [distance, intersection, contact, distance] {
            let mut answer = PairAnswer::default();
            let config = PairConfig::default();
            query([shape.at(&poses[0]), shape.at(&poses[1])], &mut cache, &config, &mut answer)
                .expect("accepted poses");
            told.push(answer);
        }
        if with_levels {
            let absolute_error = 0.125 * power_of_two(how.exponent);
            let config = PairConfig { absolute_error, levels: Levels::All, ..PairConfig::default() };
            let mut answer = PairAnswer::default();
            approximate([shape.at(&poses[0]), shape.at(&poses[1])], &mut cache, &config, &mut answer)
                .expect("accepted poses");
            told.push(answer);
        }
    }
    let unit = power_of_two(-how.exponent);
    told.iter().map(|answer| (answer.outcome, answer.lower * unit, answer.upper * unit)).collect()
}

fn assert_same(name: &str, how: &Retelling, one: &[(Outcome, f64, f64)], other: &[(Outcome, f64, f64)]) {
    assert_eq!(one.len(), other.len());
    for (a, b) in one.iter().zip(other) {
        let verdicts = [a, b].map(|answer| answer.0 == Outcome::Intersecting);
        let meet = a.1 <= b.2 && b.1 <= a.2;
        assert!(verdicts[0] == verdicts[1] && meet, "{name}, {how:?}: {a:?} but {b:?}");
    }
}

/// Every vertex is where the point of its label is.
fn assert_labels(name: &str, shape: &Shape, points: &[Vector]) {
    let polyhedron = shape.polyhedron();
    for (v, label) in polyhedron.vertex_labels.iter().enumerate() {
        assert_eq!(polyhedron.local_position(v as u32), points[*label as usize], "{name}: vertex {v}, label {label}");
    }
    for edge in &polyhedron.edges {
        let labels = [edge.tail(), edge.head()].map(|v| polyhedron.vertex_labels[v as usize]);
        assert_eq!(edge.labels, labels, "{name}");
    }
}

fn check(name: &str, points: &[Vector], retellings: &[Retelling], with_levels: bool, random: &mut Random) {
    let reference = hull(points);
    let expected = answers(&reference, &Retelling::NOTHING, with_levels);
    let intersecting = expected.iter().filter(|answer| answer.0 == Outcome::Intersecting).count();
    assert!(intersecting > 0 && intersecting < expected.len(), "{name}: {expected:?}");
    for how in retellings {
        let told = how.points(points, random);
        let shape = hull(&told);
        assert_eq!(shape.polyhedron().vertices.len(), reference.polyhedron().vertices.len(), "{name}, {how:?}");
        assert_labels(name, &shape, &told);
        assert_same(name, how, &expected, &answers(&shape, how, with_levels));
    }
}

/// Each way alone, and any of them together at each scale.
fn all_ways(random: &mut Random) -> Vec<Retelling> {
    let nothing = Retelling::NOTHING;
    let mut ways = vec![
        Retelling { permuted: true, ..nothing },
        Retelling { duplicated: true, ..nothing },
        Retelling { swapped: true, ..nothing },
        Retelling { off_centre: true, ..nothing },
        Retelling { moved: true, ..nothing },
    ];
    ways.extend(EXPONENTS.map(|exponent| Retelling { exponent, permuted: true, ..nothing }));
    ways.extend(EXPONENTS.map(|exponent| Retelling::any(exponent, random)));
    ways
}

/// A few bits each, so that sums with what they are moved by are exact.
fn on_grid(v: Vector) -> Vector {
    v.map(|x| (x * power_of_two(20)).round() * power_of_two(-20))
}

/// Spread over the unit sphere.
fn ball(count: usize) -> Vec<Vector> {
    spiral(count).into_iter().map(on_grid).collect()
}

fn prism(sides: usize) -> Vec<Vector> {
    let corner = |k: usize| {
        let (sin, cos) = (std::f64::consts::TAU * k as f64 / sides as f64).sin_cos();
        on_grid(Vector::new(cos, sin, 0.0))
    };
    (0..sides).flat_map(|k| [corner(k), corner(k) + Vector::new(0.0, 0.0, 0.5)]).collect()
}

/// A fan around one vertex.
fn cone(sides: usize) -> Vec<Vector> {
    let rim = prism(sides).into_iter().step_by(2);
    rim.chain([Vector::new(0.0, 0.0, 0.5)]).collect()
}

#[test]
fn small_bodies() {
    let mut random = Random::new(0x7001);
    // Tables of vertices begin at 32, their resolutions double at 64, 256 and 1024.
    for count in [4, 16, 17, 31, 32, 33, 64, 65, 256, 257, 1024, 1025] {
        check(&format!("ball {count}"), &ball(count), &all_ways(&mut random), false, &mut random);
    }
    // Blocks of four sides and eight neighbours; bisection from 32 new facets and 128 sides; scans of 64 and 100 neighbours.
    for sides in [3, 4, 5, 8, 9, 31, 32, 33, 34, 63, 64, 65, 99, 101, 127, 128, 129, 1000] {
        check(&format!("prism {sides}"), &prism(sides), &all_ways(&mut random), false, &mut random);
        check(&format!("cone {sides}"), &cone(sides), &all_ways(&mut random), false, &mut random);
    }
}

/// From 4,096 points on all is put in order along a curve, from 4,000 vertices on tables hold more.
#[test]
fn bodies_of_thousands() {
    let mut random = Random::new(0x7002);
    for count in [4000, 4096] {
        check(&format!("ball {count}"), &ball(count), &all_ways(&mut random), false, &mut random);
    }
}

/// Sorts merge blocks from 16,384 items on; from 30,000 vertices on bodies have levels, which pairs of 60,000 go through.
#[test]
fn bodies_with_levels() {
    let mut random = Random::new(0x7003);
    let nothing = Retelling::NOTHING;
    check("ball 16,385", &ball(16_385), &[Retelling::any(-300, &mut random)], true, &mut random);
    let ways = [
        Retelling { exponent: -1, swapped: true, duplicated: true, permuted: true, ..nothing },
        Retelling { exponent: 300, permuted: true, moved: true, ..nothing },
    ];
    check("ball 29,999", &ball(29_999), &ways[..1], true, &mut random);
    check("ball 30,001", &ball(30_001), &ways, true, &mut random);
}

/// Pairs on both sides of 200,000 vertices: from there on a verdict goes through levels, too. Tables of more than 65,536 vertices
/// hold longer numbers.
#[test]
fn bodies_of_a_hundred_thousand() {
    let mut random = Random::new(0x7004);
    let how = Retelling { exponent: -250, permuted: true, swapped: true, ..Retelling::NOTHING };
    for count in [99_999, 100_001] {
        check(&format!("ball {count}"), &ball(count), &[how], false, &mut random);
    }
}

/// A mesh keeps its faces' labels in whatever order and at whatever scale it comes.
#[test]
fn labels_of_faces() {
    let mut random = Random::new(0x7005);
    for count in [100, 4095, 4096, 5000] {
        let points = ball(count);
        let hull = convex_hull(&points).expect("finite points");
        let indices = hull.triangles.as_flattened().to_vec();
        let mesh = PolygonMesh::new(points, indices, None).expect("triangles");
        for exponent in [0, 250, -250, 900, -900] {
            let mut told = renumbered(&mesh, &mut random);
            told.vertices.iter_mut().for_each(|v| *v *= power_of_two(exponent));
            let shape = Shape::from_mesh(&told, &ShapeOptions::default()).expect("a convex mesh");
            let name = format!("mesh {count}, 2^{exponent}");
            assert_labels(&name, &shape, &told.vertices);
            let polyhedron = shape.polyhedron();
            assert_eq!(polyhedron.faces.len(), told.face_count(), "{name}");
            let mut labelled = 0;
            for (triangle, &face) in polyhedron.triangles.iter().zip(&polyhedron.face_of_triangle) {
                let [label] = *polyhedron.labels_of_face(face) else { panic!("{name}: face {face}") };
                let mut corners = triangle.map(|v| polyhedron.vertex_labels[v as usize]);
                let mut expected = told.face(label as usize).to_vec();
                corners.sort_unstable();
                expected.sort_unstable();
                assert_eq!(corners[..], expected[..], "{name}: face {face}");
                labelled += 1;
            }
            assert_eq!(labelled, told.face_count(), "{name}");
        }
    }
}
