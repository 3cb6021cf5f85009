//! Which of the caller's polygons an answer names: the one that holds the place, however the polygons lie on the faces of the hull.

use swiftprox::error::Error;
use swiftprox::math::{Matrix, Pose, Vector};
use swiftprox::mesh::PolygonMesh;
use swiftprox::pair::{self, Feature, FeatureKind, Outcome, PairAnswer, PairCache, PairConfig};
use swiftprox::point::locate_point;
use swiftprox::ray::{Ray, RayOutcome, cast_ray};
use swiftprox::shape::{InputPolicy, NO_FACE, Shape, ShapeOptions};
use swiftprox::verify::verify;
use testkit::random::Random;
use testkit::shapes::hull;

/// A body whose sides are cut, turned and rounded.
struct Cut {
    mesh: PolygonMesh,
    /// Of each polygon its corners before they were turned and rounded, and the outward normal of its side.
    places: Vec<(Vec<Vector>, Vector)>,
    turn: Matrix,
}

/// Where planes cut an axis, ends included.
type Planes = [Vec<f64>; 3];

fn planes(random: &mut Random, half: [f64; 3], most: usize) -> Planes {
    half.map(|half| {
        let mut inner: Vec<f64> = (0..random.below(most)).map(|_| half * (0.9 * random.signed())).collect();
        inner.sort_unstable_by(f64::total_cmp);
        // Strips that are seen beside the rounding.
        inner.dedup_by(|a, b| *a - *b < 0.2 * half);
        [vec![-half], inner, vec![half]].concat()
    })
}

/// The sides of a box that `has` says, by axis and sign, rounded by `round` after a turn.
fn cut(planes: &Planes, turn: Matrix, has: impl Fn(usize, bool) -> bool, round: impl Fn(f64) -> f64) -> Cut {
    let (mut mesh, mut places) = (PolygonMesh::default(), Vec::new());
    let mut known: Vec<([usize; 3], u32)> = Vec::new();
    for axis in 0..3 {
        let (across, up) = ((axis + 1) % 3, (axis + 2) % 3);
        for is_far in [false, true] {
            if !has(axis, is_far) {
                continue;
            }
            for i in 0..planes[across].len() - 1 {
                for j in 0..planes[up].len() - 1 {
                    let mut corners = [[0, 0], [1, 0], [1, 1], [0, 1]].map(|[right, above]| {
                        let mut lattice = [0; 3];
                        lattice[axis] = if is_far { planes[axis].len() - 1 } else { 0 };
                        (lattice[across], lattice[up]) = (i + right, j + above);
                        lattice
                    });
                    if !is_far {
                        corners.reverse();
                    }
                    let position = |lattice: &[usize; 3]| Vector::from_fn(|k, _| planes[k][lattice[k]]);
                    let face = corners.map(|lattice| {
                        let found = known.iter().find(|(other, _)| *other == lattice).map(|(_, vertex)| *vertex);
                        found.unwrap_or_else(|| {
                            let vertex = mesh.vertices.len() as u32;
                            mesh.push_vertex((turn * position(&lattice)).map(&round)).unwrap();
                            known.push((lattice, vertex));
                            vertex
                        })
                    });
                    mesh.push_face(&face).unwrap();
                    let mut normal = Vector::zeros();
                    normal[axis] = if is_far { 1.0 } else { -1.0 };
                    places.push((corners.iter().map(position).collect(), normal));
                }
            }
        }
    }
    Cut { mesh, places, turn }
}

impl Cut {
    /// A place on a polygon, away from its sides, and the normal there, in the frame of the mesh.
    fn place(&self, polygon: usize, random: &mut Random) -> (Vector, Vector) {
        let (corners, normal) = &self.places[polygon];
        let weights: Vec<f64> = corners.iter().map(|_| random.uniform(0.2, 1.0)).collect();
        let sum = corners.iter().zip(&weights).map(|(corner, weight)| corner * *weight).sum::<Vector>();
        let place = sum / weights.iter().sum::<f64>();
        (self.turn * place, self.turn * normal)
    }
}

fn with(input: InputPolicy) -> ShapeOptions {
    ShapeOptions { input, ..ShapeOptions::default() }
}

fn face(polygon: usize) -> Feature {
    Feature { kind: FeatureKind::Face, ids: [polygon as u32, 0] }
}

/// Asks for what is below places over all polygons in every way that names one, and has answers verified, and others refused.
fn check(cut: &Cut, shape: &Shape, random: &mut Random) -> usize {
    let point = hull(&[Vector::zeros()]);
    let mut asked = 0;
    for polygon in 0..cut.places.len() {
        let (place, normal) = cut.place(polygon, random);
        let pose = Pose::new(&random.rotation(), &(random.vector() * 3.0));
        let at = |height: f64| pose.transform(&(place + normal * height));
        let there = Pose::new(&Matrix::identity(), &at(0.5));
        let bodies = [shape.at(&pose), point.at(&there)];
        let mut answer = PairAnswer::default();
        pair::distance(bodies, &mut PairCache::default(), &PairConfig::default(), &mut answer).unwrap();
        assert_eq!(answer.outcome, Outcome::Separated);
        // The hull may have an edge or a vertex there, by rounding.
        if answer.feature1.kind == FeatureKind::Face {
            asked += 1;
            assert_eq!(answer.feature1, face(polygon), "{answer:?}");
            verify(bodies, &answer).unwrap();
            for other in [polygon + 1, polygon + cut.places.len() / 2].map(|other| other % cut.places.len()) {
                // A plate without thickness has both sides in one place.
                if cut.places[other].1 == -cut.places[polygon].1 {
                    continue;
                }
                let lie = PairAnswer { feature1: face(other), ..answer };
                assert!(matches!(verify(bodies, &lie), Err(Error::Unverified(_))), "{polygon} {other}");
            }
        }
        let found = locate_point(shape.at(&pose), at(0.5).into()).unwrap();
        assert!(found.feature.kind != FeatureKind::Face || found.feature == face(polygon), "{found:?}");
        let down = pose.rotate(&-normal);
        let ray = Ray { origin: at(0.5).into(), direction: down.into(), t_max: f64::INFINITY };
        let hit = cast_ray(shape.at(&pose), &ray).unwrap();
        assert_eq!((hit.outcome, hit.feature), (RayOutcome::Hit, face(polygon)), "{hit:?}");
        assert!(shape.find_face(polygon as u32).is_some());
    }
    asked
}

type Rounding = fn(f64) -> f64;

const ROUNDINGS: [Rounding; 4] =
    [|x| (x * 1e3).round() / 1e3, |x| (x * 1e6).round() / 1e6, |x| f64::from(x as f32), |x| x];

/// Cubes whose sides are squares, rounded: the hull's faces over them are triangles that go their own ways, over several polygons
/// at once. Each polygon was the label of the one face nearest to its plane, and 19 to 34 % of answers named a neighbour, up to two
/// edges away; verify took them. From 2 x 2 squares of 6 decimals on.
#[test]
fn a_face_over_several_polygons_has_them_all() {
    let mut random = Random::new(0x50a5);
    let (mut asked, mut all) = (0, 0);
    for round in 0..80 {
        let half = [1.0, random.uniform(0.3, 1.0), random.uniform(0.3, 1.0)];
        let planes = match round % 4 {
            // Squares, as they were reported.
            0 => [(); 3]
                .map(|()| (0..=2 + round / 4 % 3).map(|k| 2.0 * k as f64 / (2 + round / 4 % 3) as f64 - 1.0).collect()),
            _ => planes(&mut random, half, 6),
        };
        let rounding = ROUNDINGS[round % ROUNDINGS.len()];
        let cut = cut(&planes, random.rotation(), |_, _| true, rounding);
        let shape = Shape::from_mesh(&cut.mesh, &with(InputPolicy::NearlyConvex)).unwrap();
        asked += check(&cut, &shape, &mut random);
        all += cut.places.len();
    }
    assert!(asked > all / 2 && asked > 1_000, "{asked} of {all}");
}

/// The same of strict meshes: as they are, and with a tolerance that admits rounded ones.
#[test]
fn so_it_is_of_strict_meshes() {
    let mut random = Random::new(0x50a6);
    let mut asked = 0;
    for round in 0..60 {
        let planes = planes(&mut random, [1.0; 3], 6);
        let (rounding, convexity_tolerance) = [(ROUNDINGS[3], None), (ROUNDINGS[1], Some(1e-5))][round % 2];
        let cut = cut(&planes, random.rotation(), |_, _| true, rounding);
        let options = ShapeOptions { convexity_tolerance, ..with(InputPolicy::Strict) };
        let shape = Shape::from_mesh(&cut.mesh, &options).unwrap();
        asked += check(&cut, &shape, &mut random);
    }
    assert!(asked > 1_000, "{asked}");
}

/// Plates of no thickness, or of that which rounding gives them: a polygon whose upper side is a fan around one corner, its lower
/// one around another.
#[test]
fn so_it_is_of_flat_plates() {
    let mut random = Random::new(0x50a7);
    let mut asked = 0;
    for round in 0..40 {
        let corners = 5 + random.below(8);
        let angle = |k: usize| std::f64::consts::TAU * (k % corners) as f64 / corners as f64;
        let position = |k: usize| Vector::new(angle(k).cos(), 0.6 * angle(k).sin(), 0.0);
        let turn = if round % 2 == 0 { random.quarter_turns() } else { random.rotation() };
        let rounding = ROUNDINGS[1 + round % 3];
        let (mut mesh, mut places) = (PolygonMesh::default(), Vec::new());
        for k in 0..corners {
            mesh.push_vertex((turn * position(k)).map(rounding)).unwrap();
        }
        for k in 1..corners - 1 {
            for (fan, normal) in [([0, k, k + 1], Vector::z()), ([1, k + 2, k + 1], -Vector::z())] {
                mesh.push_face(&fan.map(|corner| (corner % corners) as u32)).unwrap();
                places.push((fan.map(position).to_vec(), normal));
            }
        }
        // Rounding may have put the lower side above the upper one. That is a body inside out: its faces are turned.
        let corner = |fan: &[u32], k: usize| mesh.vertices[fan[k] as usize];
        let faces = (0..mesh.face_count()).map(|f| mesh.face(f));
        let volume: f64 = faces.map(|fan| corner(fan, 0).cross(&corner(fan, 1)).dot(&corner(fan, 2))).sum();
        if volume < -1e-12 {
            places.iter_mut().for_each(|(_, normal)| *normal = -*normal);
        }
        let cut = Cut { mesh, places, turn };
        for input in [InputPolicy::Flat, InputPolicy::NearlyConvex] {
            match Shape::from_mesh(&cut.mesh, &with(input)) {
                Ok(shape) => asked += check(&cut, &shape, &mut random),
                Err(error) => assert!(input == InputPolicy::Flat && round % 2 == 1, "{input:?} {round}: {error}"),
            }
        }
    }
    assert!(asked > 400, "{asked}");
}

/// Patches: sides of a box without the others. Of those that are not there the hull's faces are called so.
#[test]
fn so_it_is_of_patches() {
    let mut random = Random::new(0x50a8);
    let (mut asked, mut bare) = (0, 0);
    for round in 0..60 {
        let planes = planes(&mut random, [1.0; 3], 5);
        let missing = round % 3;
        let rounding = ROUNDINGS[1 + round % 3];
        let turn = random.rotation();
        let part = cut(&planes, turn, |axis, is_far| axis != missing || is_far, rounding);
        let shape = Shape::from_mesh(&part.mesh, &with(InputPolicy::Patch)).unwrap();
        asked += check(&part, &shape, &mut random);
        // Below, in the middle.
        let mut below = Vector::zeros();
        below[missing] = -2.0;
        let ray = Ray { origin: (turn * below).into(), direction: (turn * -below).into(), t_max: 1.0 };
        let hit = cast_ray(shape.at(&Pose::IDENTITY), &ray).unwrap();
        assert_eq!((hit.outcome, hit.feature.ids[0]), (RayOutcome::Hit, NO_FACE), "{hit:?}");
        bare += 1;
    }
    assert!(asked > 1_000 && bare == 60, "{asked}");
}
