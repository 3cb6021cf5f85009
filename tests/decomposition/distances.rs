//! Decomposed bodies are as far apart as their surfaces.

use swiftprox::math::{Pose, Vector};
use swiftprox::mesh::PolygonMesh;
use swiftprox::pair::{self, Outcome, PairAnswer, PairCache, PairConfig, Placed};
use swiftprox::shape::{InputPolicy, Shape, ShapeOptions};
use testkit::oracle::{Polytope, truth};
use testkit::random::Random;

use crate::bodies::{Named, bodies, moved, sheets};
use crate::pieces::pieces_of;

/// The smallest distance of two sets of convex bodies, with its interval and the pair that has it.
struct Nearest {
    outcome: Outcome,
    lower: f64,
    upper: f64,
    pair: [usize; 2],
}

fn nearest(a: &[Shape], b: &[Shape], poses: &[Pose; 2]) -> Nearest {
    let mut least = Nearest { outcome: Outcome::Separated, lower: f64::INFINITY, upper: f64::INFINITY, pair: [0; 2] };
    for (i, first) in a.iter().enumerate() {
        for (j, second) in b.iter().enumerate() {
            let bodies = [Placed { shape: first, pose: &poses[0] }, Placed { shape: second, pose: &poses[1] }];
            let mut answer = PairAnswer::default();
            pair::distance(bodies, &mut PairCache::default(), &PairConfig::default(), &mut answer).unwrap();
            least.lower = least.lower.min(answer.lower);
            if answer.upper < least.upper {
                (least.upper, least.outcome, least.pair) = (answer.upper, answer.outcome, [i, j]);
            }
        }
    }
    least
}

struct Decomposed {
    name: &'static str,
    pieces: Vec<Shape>,
    triangles: Vec<Shape>,
    exact: Vec<Polytope>,
}

impl Decomposed {
    fn new((name, mesh): Named) -> Decomposed {
        let options = ShapeOptions { input: InputPolicy::Patch, ..Default::default() };
        let pieces = pieces_of(&mesh, 0.0);
        let shape = |triangles: &[[u32; 3]]| {
            let patch = PolygonMesh::new(mesh.vertices.clone(), triangles.concat(), None).unwrap();
            Shape::from_mesh(&patch, &options).unwrap()
        };
        let points = |corners: &[u32; 3]| corners.map(|v| mesh.vertices[v as usize].into());
        Decomposed {
            name,
            pieces: (0..pieces.piece_count()).map(|k| shape(pieces.piece(k))).collect(),
            triangles: pieces.triangles.iter().map(|corners| shape(&[*corners])).collect(),
            exact: pieces.triangles.iter().map(|corners| Polytope::new(&points(corners))).collect(),
        }
    }
}

fn rows(pose: &Pose) -> [f64; 12] {
    let (rotation, translation) = (pose.rotation(), pose.translation());
    std::array::from_fn(|k| if k % 4 == 3 { translation[k / 4] } else { rotation[(k / 4, k % 4)] })
}

/// The triangles' certified intervals say which of them are nearest; the exact distance of those lies in the pieces' interval.
#[test]
fn pieces_are_as_far_apart_as_triangles() {
    let mut random = Random::new(33);
    let all: Vec<Decomposed> = bodies().into_iter().chain(sheets()).map(Decomposed::new).collect();
    let (mut apart, mut together) = (0, 0);
    for (k, a) in all.iter().enumerate() {
        for b in [&all[(k + 1) % all.len()], &all[random.below(all.len())]] {
            let away = random.direction() * random.uniform(0.8, 3.5);
            let poses = [Pose::new(&random.rotation(), &Vector::zeros()), Pose::new(&random.rotation(), &away)];
            let of_pieces = nearest(&a.pieces, &b.pieces, &poses);
            let of_triangles = nearest(&a.triangles, &b.triangles, &poses);
            let [i, j] = of_triangles.pair;
            let truth = truth(&a.exact[i], &rows(&poses[0]), &b.exact[j], &rows(&poses[1]));
            let names = (a.name, b.name);
            if of_triangles.outcome == Outcome::Intersecting {
                assert_eq!(of_pieces.outcome, Outcome::Intersecting, "{names:?}");
                assert!(truth.intersecting());
                together += 1;
            } else {
                assert_eq!(of_pieces.outcome, Outcome::Separated, "{names:?}");
                // The nearest pair is one of those whose intervals overlap: all are as near within their width.
                assert!(of_pieces.lower <= of_triangles.upper && of_triangles.lower <= of_pieces.upper, "{names:?}");
                assert!(truth.lies_between(of_pieces.lower - 1e-13, of_pieces.upper + 1e-13), "{names:?}");
                apart += 1;
            }
        }
    }
    assert!(apart >= 12 && together >= 4, "{apart} apart, {together} together");
}

/// A small body in the notch of an L, in a slot, in the hole of a torus and in a cavity is free: a hull over them would hold it.
#[test]
fn hollows_stay_open() {
    let find = |name: &str| bodies().into_iter().find(|(other, _)| *other == name).unwrap();
    let cube = testkit::models::cuboid([0.05; 3]).unwrap();
    for (name, place) in
        [("L", [1.5, 1.5, 0.0]), ("slot", [0.0, 0.5, 0.0]), ("torus", [0.0, 0.0, 0.0]), ("hollow", [0.2; 3])]
    {
        let body = Decomposed::new(find(name));
        let probe = Decomposed::new(("cube", moved(&cube, &swiftprox::math::Matrix::identity(), Vector::from(place))));
        let found = nearest(&body.pieces, &probe.pieces, &[Pose::IDENTITY; 2]);
        let expected = nearest(&body.triangles, &probe.triangles, &[Pose::IDENTITY; 2]);
        assert_eq!(found.outcome, Outcome::Separated, "{name}");
        assert!((found.upper - expected.upper).abs() < 1e-13, "{name}: {} for {}", found.upper, expected.upper);
    }
}
