//! Solid pieces: they hold the body, and reach beyond it by no more than the tolerance.

use std::f64::consts::TAU;

use swiftprox::body::build::hull::convex_hull;
use swiftprox::body::decomposition::solid::decompose_solid;
use swiftprox::compound::Compound;
use swiftprox::error::Error;
use swiftprox::math::{Matrix, Vector};
use swiftprox::mesh::PolygonMesh;
use swiftprox::progress::Progress;
use testkit::models::{cuboid, ellipsoid};
use testkit::random::Random;

use crate::bodies::{bodies, extruded, l_shape, moved, sheets, together, toothed, torus, turned, turned_round};

/// A body as triangles.
struct Solid {
    triangles: Vec<[Vector; 3]>,
    low: Vector,
    high: Vector,
}

impl Solid {
    /// Faces are convex, or star-shaped around their first corner.
    fn new(mesh: &PolygonMesh) -> Solid {
        let fan = |f: usize| {
            let corners: Vec<Vector> = mesh.face(f).iter().map(|v| mesh.vertices[*v as usize]).collect();
            (1..corners.len() - 1).map(|k| [corners[0], corners[k], corners[k + 1]]).collect::<Vec<_>>()
        };
        let [low, high] = mesh.vertices.iter().fold([mesh.vertices[0]; 2], |[low, high], p| [low.inf(p), high.sup(p)]);
        Solid { triangles: (0..mesh.face_count()).flat_map(fan).collect(), low, high }
    }

    fn diagonal(&self) -> f64 {
        (self.high - self.low).norm()
    }

    fn holds(&self, point: &Vector) -> bool {
        let angle = |triangle: &[Vector; 3]| {
            let [a, b, c] = triangle.map(|corner| corner - point);
            let [x, y, z] = [a, b, c].map(|v| v.norm());
            2.0 * a.dot(&b.cross(&c)).atan2(x * y * z + a.dot(&b) * z + b.dot(&c) * x + c.dot(&a) * y)
        };
        self.triangles.iter().map(angle).sum::<f64>().abs() > TAU
    }

    /// The distance from the surface.
    fn gap(&self, point: &Vector) -> f64 {
        let to_segment = |a: &Vector, b: &Vector| {
            let along = b - a;
            let place = (along.dot(&(point - a)) / along.norm_squared()).clamp(0.0, 1.0);
            (a + along * place - point).norm()
        };
        let to_triangle = |[a, b, c]: &[Vector; 3]| {
            let normal = (b - a).cross(&(c - a)).normalize();
            let is_over =
                [(a, b), (b, c), (c, a)].iter().all(|(p, q)| normal.dot(&(*q - *p).cross(&(point - *p))) >= 0.0);
            let rim = to_segment(a, b).min(to_segment(b, c)).min(to_segment(c, a));
            if is_over { rim.min(normal.dot(&(point - a)).abs()) } else { rim }
        };
        self.triangles.iter().map(to_triangle).fold(f64::INFINITY, f64::min)
    }
}

/// The triangles of a hull, and their planes.
struct Hull {
    triangles: Vec<[Vector; 3]>,
    planes: Vec<(Vector, f64)>,
}

impl Hull {
    fn new(points: &[Vector]) -> Hull {
        let hull = convex_hull(points).unwrap();
        assert_eq!(hull.dimension, 3);
        let triangles: Vec<[Vector; 3]> = hull.triangles.iter().map(|t| t.map(|v| points[v as usize])).collect();
        let plane = |[a, b, c]: &[Vector; 3]| {
            let normal = (b - a).cross(&(c - a)).normalize();
            // All points are below it, however thin the triangle.
            (normal, points.iter().map(|p| normal.dot(p)).fold(f64::NEG_INFINITY, f64::max))
        };
        // Those of no area, rounded, have no plane.
        let planes = triangles.iter().map(plane).filter(|(normal, _)| normal.norm() > 0.5).collect();
        Hull { planes, triangles }
    }

    fn holds(&self, point: &Vector, margin: f64) -> bool {
        self.planes.iter().all(|(normal, height)| normal.dot(point) <= height + margin)
    }
}

fn solid(mesh: &PolygonMesh, tolerance: f64) -> Vec<Vec<Vector>> {
    decompose_solid(mesh, tolerance, &mut Progress::new(&mut |_| true)).unwrap()
}

/// Both promises, by samples; the number of pieces.
fn check(name: &str, mesh: &PolygonMesh, body: &Solid, tolerance: f64) -> usize {
    let pieces = solid(mesh, tolerance);
    let hulls: Vec<Hull> = pieces.iter().map(|piece| Hull::new(piece)).collect();
    let mut random = Random::new(5);
    let (diagonal, size) = (body.diagonal(), body.high - body.low);
    let mut inside = 0;
    for _ in 0..1500 {
        let place = Vector::new(random.uniform(0.0, 1.0), random.uniform(0.0, 1.0), random.uniform(0.0, 1.0));
        let point = body.low + place.component_mul(&size);
        let is_covered = hulls.iter().any(|hull| hull.holds(&point, 1e-8 * diagonal));
        if body.holds(&point) {
            inside += 1;
            assert!(is_covered, "{name}: {point:?} is in no piece");
        } else if is_covered {
            let gap = body.gap(&point);
            assert!(gap <= tolerance * diagonal * (1.0 + 1e-7), "{name}: {gap} from the body");
        }
    }
    assert!(inside > 20, "{name}: {inside} points");
    // Corners of the surface, too, and points of the pieces' faces.
    for point in body.triangles.iter().flatten() {
        assert!(hulls.iter().any(|hull| hull.holds(point, 1e-8 * diagonal)), "{name}: corner {point:?}");
    }
    for [a, b, c] in hulls.iter().flat_map(|hull| &hull.triangles) {
        for _ in 0..4 {
            let [u, v] = [random.uniform(0.0, 1.0), random.uniform(0.0, 1.0)];
            let [u, v] = if u + v > 1.0 { [1.0 - u, 1.0 - v] } else { [u, v] };
            let point = a + (b - a) * u + (c - a) * v;
            let gap = if body.holds(&point) { 0.0 } else { body.gap(&point) };
            assert!(gap <= tolerance * diagonal * (1.0 + 1e-7), "{name}: {gap} from the body");
        }
    }
    pieces.len()
}

/// A surface of revolution around z: a closed profile of radii and heights, counter-clockwise.
fn lathed(profile: &[[f64; 2]], around: u32) -> PolygonMesh {
    let mut mesh = PolygonMesh::default();
    let count = profile.len() as u32;
    for i in 0..around {
        let angle = TAU * f64::from(i) / f64::from(around);
        profile.iter().for_each(|[r, z]| mesh.push_vertex(Vector::new(r * angle.cos(), r * angle.sin(), *z)).unwrap());
    }
    let at = |i: u32, j: u32| (i % around) * count + j % count;
    for (i, j) in (0..around).flat_map(|i| (0..count).map(move |j| (i, j))) {
        mesh.push_face(&[at(i, j), at(i + 1, j), at(i + 1, j + 1)]).unwrap();
        mesh.push_face(&[at(i, j), at(i + 1, j + 1), at(i, j + 1)]).unwrap();
    }
    mesh
}

fn shifted(mesh: &PolygonMesh, by: [f64; 3]) -> PolygonMesh {
    moved(mesh, &Matrix::identity(), Vector::from(by))
}

fn scaled(mesh: &PolygonMesh, by: f64) -> PolygonMesh {
    moved(mesh, &(Matrix::identity() * by), Vector::zeros())
}

fn displaced_sphere() -> PolygonMesh {
    let mut mesh = ellipsoid([1.0; 3], 300).unwrap();
    mesh.vertices.iter_mut().for_each(|v| *v *= 1.0 + 0.2 * (4.0 * v.x).sin() * (3.0 * v.y + 1.0).cos());
    let mut triangles = PolygonMesh { vertices: mesh.vertices.clone(), ..PolygonMesh::default() };
    for f in 0..mesh.face_count() {
        let face = mesh.face(f);
        (1..face.len() - 1).for_each(|k| triangles.push_face(&[face[0], face[k], face[k + 1]]).unwrap());
    }
    triangles
}

/// A cup whose handle goes into its wall: two surfaces that pass through each other.
fn cup() -> PolygonMesh {
    let wall = [[0.01, 0.0], [0.5, 0.0], [0.5, 1.2], [0.42, 1.2], [0.42, 0.1], [0.01, 0.1]];
    let upright = Matrix::new(0.35, 0.0, 0.0, 0.0, 0.0, -0.35, 0.0, 0.35, 0.0);
    let handle = moved(&torus(16, 6), &upright, Vector::new(0.62, 0.0, 0.6));
    together(&[lathed(&wall, 20), handle])
}

/// An angle with a rib that passes into both plates.
fn bracket() -> PolygonMesh {
    let angle = extruded(&[[0.0, 0.0], [2.0, 0.0], [2.0, 0.2], [0.2, 0.2], [0.2, 1.5], [0.0, 1.5]], 0.5);
    together(&[angle, extruded(&[[0.1, 0.1], [1.0, 0.1], [0.1, 1.0]], 0.1)])
}

fn u_shape() -> PolygonMesh {
    let corners = [[0.0, 0.0], [3.0, 0.0], [3.0, 2.0], [2.0, 2.0], [2.0, 1.0], [1.0, 1.0], [1.0, 2.0], [0.0, 2.0]];
    extruded(&corners, 0.5)
}

/// The triangles of faces that are not star-shaped, by the surface's own decomposition, which other tests check.
fn body_of(mesh: &PolygonMesh) -> Solid {
    let whole = swiftprox::body::decomposition::decompose(mesh, 0.0, &mut Progress::new(&mut |_| true)).unwrap();
    let corners = |t: &[u32; 3]| t.map(|v| mesh.vertices[v as usize]);
    Solid { triangles: whole.triangles.iter().map(corners).collect(), ..Solid::new(mesh) }
}

#[test]
fn pieces_hold_the_body_and_stay_within_the_tolerance() {
    let gear = extruded(&toothed(48, 2, 0.8), 0.2);
    let apart = together(&[cuboid([1.0; 3]).unwrap(), shifted(&cuboid([0.5; 3]).unwrap(), [3.0, 0.2, 0.0])]);
    let cases = [
        ("torus", torus(24, 10), 0.02, 10),
        ("gear", gear.clone(), 0.01, 28),
        ("turned gear", turned(&gear), 0.01, 28),
        ("displaced sphere", displaced_sphere(), 0.02, 16),
        ("cup", cup(), 0.02, 30),
        ("bracket", bracket(), 0.01, 6),
        ("L", l_shape(), 0.01, 2),
        ("turned L", turned(&l_shape()), 0.001, 2),
        ("U", u_shape(), 0.01, 3),
        ("two boxes", apart, 0.01, 2),
        ("cuboid", cuboid([1.0, 0.5, 0.1]).unwrap(), 0.001, 1),
    ];
    for (name, mesh, tolerance, most) in cases {
        let count = check(name, &mesh, &body_of(&mesh), tolerance);
        println!("{name}: {count} pieces");
        assert!(count <= most, "{name}: {count} pieces");
    }
}

/// A void within a box: what is farther from the walls than the tolerance is in no piece.
#[test]
fn a_void_stays_open_up_to_the_tolerance() {
    let mesh = together(&[cuboid([1.0; 3]).unwrap(), turned_round(&cuboid([0.6; 3]).unwrap())]);
    assert!(check("hollow", &mesh, &body_of(&mesh), 0.01) <= 8);
    let pieces = solid(&mesh, 0.01);
    let hulls: Vec<Hull> = pieces.iter().map(|piece| Hull::new(piece)).collect();
    assert!(!hulls.iter().any(|hull| hull.holds(&Vector::zeros(), 0.0)));
    // Its middle is 0.6 from the walls, the diagonal 2√3: a part of 0.173.
    assert_eq!(solid(&mesh, 0.18).len(), 1);
}

#[test]
fn bodies_within_the_tolerance_of_their_hull_are_one_piece() {
    for (name, mesh) in bodies() {
        assert_eq!(solid(&mesh, 1.0).len(), 1, "{name}");
    }
}

/// Two cubes that share an edge, which four faces have.
fn pinched() -> PolygonMesh {
    let mut both = together(&[cuboid([0.5; 3]).unwrap(), shifted(&cuboid([0.5; 3]).unwrap(), [1.0, 1.0, 0.0])]);
    let first = |v: &Vector, all: &[Vector]| all.iter().position(|p| (p - v).norm() < 1e-9).unwrap() as u32;
    let vertices = both.vertices.clone();
    both.indices.iter_mut().for_each(|v| *v = first(&vertices[*v as usize], &vertices));
    both
}

#[test]
fn imperfect_meshes_are_taken_where_the_inside_is_known() {
    let mesh = pinched();
    assert!(check("pinched", &mesh, &Solid::new(&mesh), 0.005) <= 2);
    // Three faces of ten the other way round.
    let right = torus(18, 8);
    let mut wrong = right.clone();
    for f in (0..wrong.face_count()).filter(|f| f % 10 < 3) {
        let ends = [f, f + 1].map(|k| wrong.starts[k] as usize);
        wrong.indices[ends[0]..ends[1]].reverse();
    }
    let body = body_of(&right);
    let count = check("faces turned", &wrong, &body, 0.02);
    assert_eq!(count, check("as it is", &right, &body, 0.02));
    assert_eq!(count, check("inside out", &turned_round(&right), &body, 0.02));
}

fn refusal(mesh: &PolygonMesh, tolerance: f64) -> Error {
    decompose_solid(mesh, tolerance, &mut Progress::new(&mut |_| true)).unwrap_err()
}

#[test]
fn other_meshes_are_refused_with_the_edge_and_the_cure() {
    for (name, mesh) in sheets().iter().filter(|(name, _)| *name != "leaf") {
        let message = refusal(mesh, 0.01).to_string();
        assert!(message.contains("has no face beyond it: the mesh is open; close the hole"), "{name}: {message}");
    }
    assert!(refusal(&sheets()[2].1, 0.01).to_string().contains("encloses no volume"));
    // A wall inside: an edge of three faces.
    let mut wall = cuboid([1.0; 3]).unwrap();
    wall.push_face(&[0, 1, 6]).unwrap();
    let message = refusal(&wall, 0.01).to_string();
    assert!(message.contains("face") && message.contains("edge"), "{message}");
    for tolerance in [0.0, 1e-5, -1.0, 1.1, f64::NAN] {
        let error = refusal(&l_shape(), tolerance);
        assert!(matches!(&error, Error::Argument(message) if message.contains("tolerance")), "{error:?}");
    }
    assert!(matches!(refusal(&PolygonMesh::default(), 0.1), Error::Mesh(_)));
}

/// The same pieces at any size and place.
#[test]
fn sizes_do_not_matter() {
    let mesh = u_shape();
    for factor in [1e-6, 1e6, 1e-150, 1e150] {
        let other = scaled(&mesh, factor);
        let pieces = solid(&other, 0.01);
        assert_eq!(pieces.len(), 3, "{factor}");
        let back: Vec<Vec<Vector>> = pieces.iter().map(|piece| piece.iter().map(|p| p / factor).collect()).collect();
        let hulls: Vec<Hull> = back.iter().map(|piece| Hull::new(piece)).collect();
        for v in &mesh.vertices {
            assert!(hulls.iter().any(|hull| hull.holds(v, 1e-7)), "{factor}: {v:?}");
        }
    }
    assert_eq!(solid(&shifted(&mesh, [1e6, -2e6, 1e5]), 0.01).len(), 3);
}

#[test]
fn it_can_be_cancelled_and_tells_how_far_it_is() {
    let mesh = torus(24, 10);
    let (mut last, mut reports) = (0.0, 0);
    let mut hear = |fraction: f64| {
        assert!((last..=1.0).contains(&fraction), "{fraction} after {last}");
        (last, reports) = (fraction, reports + 1);
        true
    };
    let compound = Compound::from_mesh(&mesh, 0.01, &mut Progress::new(&mut hear)).unwrap();
    assert!(last == 1.0 && reports > 10 && compound.piece_count() > 4, "{last}, {reports}");
    for limit in [0.0, 0.3, 0.7] {
        let cancelled = decompose_solid(&mesh, 0.01, &mut Progress::new(&mut |fraction| fraction < limit));
        assert!(matches!(cancelled, Err(Error::Cancelled(_))), "{limit}");
    }
}

/// A small body in the middle of the material meets the compound, which surface pieces leave open.
#[test]
fn compounds_are_solid_above_tolerance_0() {
    use swiftprox::compound::{CompoundAnswer, CompoundCache, PlacedCompound, intersection};
    use swiftprox::math::Pose;
    use swiftprox::pair::{Outcome, PairConfig};
    let probe = scaled(&cuboid([1.0; 3]).unwrap(), 1e-3);
    let probe = Compound::from_mesh(&probe, 0.0, &mut Progress::new(&mut |_| true)).unwrap();
    let body = Compound::from_mesh(&torus(24, 10), 0.01, &mut Progress::new(&mut |_| true)).unwrap();
    let mut random = Random::new(3);
    for _ in 0..50 {
        let (angle, off) = (random.uniform(0.0, TAU), random.direction() * random.uniform(0.0, 0.35));
        let (radius, place) = (1.0 + off.x, Vector::new(angle.cos(), angle.sin(), 0.0));
        let poses = [Pose::IDENTITY, Pose::new(&Matrix::identity(), &(place * radius + Vector::z() * off.z))];
        let placed = [&body, &probe].into_iter().zip(&poses).map(|(compound, pose)| PlacedCompound { compound, pose });
        let placed: Vec<_> = placed.collect();
        let mut answer = CompoundAnswer::default();
        let cache = &mut CompoundCache::default();
        intersection([placed[0], placed[1]], cache, &PairConfig::default(), &mut answer).unwrap();
        assert_eq!(answer.answer.outcome, Outcome::Intersecting);
    }
}
