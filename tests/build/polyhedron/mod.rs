//! Every documented invariant of a built polyhedron, on shapes from points to ten thousand vertices.

mod random;
mod solids;
mod validate;

use random::{ellipsoid, turned};
use swiftprox::body::build::assembly::build;
use swiftprox::body::polyhedron::Polyhedron;
use swiftprox::math::{UNIT_ROUNDOFF, Vector};
use swiftprox::mesh::PolygonMesh;
use testkit::models;
use testkit::random::Random;
use validate::validate;

fn hull(points: &[Vector]) -> Polyhedron {
    let polyhedron = build(points, None).unwrap();
    validate(points, &polyhedron);
    polyhedron
}

fn counts(p: &Polyhedron) -> (usize, usize, usize) {
    (p.vertices.len(), p.edges.len(), p.faces.len())
}

#[test]
fn boxes_have_six_faces() {
    for size in [[1.0, 1.0, 1.0], [1e6, 1.0, 1.0], [1e6, 1e6, 1.0], [1e-9, 2e-9, 3e-9], [1e9, 2e9, 3e9]] {
        let p = hull(&solids::cuboid(size));
        assert_eq!(counts(&p), (8, 12, 6));
        assert!(p.faces.iter().all(|f| f.slack == 0.0), "faces along the axes are exact");
        assert!((p.mass.volume / (size[0] * size[1] * size[2]) - 1.0).abs() < 1e-15);
    }
}

#[test]
fn rotated_boxes_have_six_faces() {
    let mut random = Random::new(1);
    for size in [[1.0, 1.0, 1.0], [1e3, 1.0, 1.0], [1e3, 1e3, 1.0], [3.0, 2.0, 1.0]] {
        for _ in 0..100 {
            let p = hull(&turned(&mut random, &solids::cuboid(size)));
            assert_eq!(counts(&p), (8, 12, 6), "{size:?}");
        }
    }
}

#[test]
fn subdivided_cubes_have_six_faces() {
    let mut random = Random::new(2);
    let grid = models::grid_on_cube(7);
    let p = hull(&grid);
    assert_eq!((p.edges.len(), p.faces.len()), (12, 6));
    let mut whole = 0;
    for _ in 0..20 {
        let p = hull(&turned(&mut random, &grid));
        whole += usize::from((p.edges.len(), p.faces.len()) == (12, 6));
    }
    assert_eq!(whole, 20, "rounding keeps faces apart");
}

#[test]
fn prisms_have_one_cap_each() {
    let mut random = Random::new(3);
    let prism = solids::prism(1000, 1.0);
    for points in [prism.clone(), turned(&mut random, &prism), turned(&mut random, &solids::prism(1000, 1e-6))] {
        let p = hull(&points);
        assert_eq!(counts(&p), (2000, 3000, 1002));
        assert_eq!(p.faces.iter().map(|f| f.side_count).max(), Some(1000));
    }
}

#[test]
fn a_cone_keeps_its_fan() {
    let mut points = solids::prism(1000, 1.0)[..1000].to_vec();
    points.push(Vector::new(0.0, 0.0, 3.0));
    let p = hull(&points);
    assert_eq!(counts(&p), (1001, 2000, 1001));
}

/// Around a vertex with more neighbours than a flood may look at, slacks come from the planes beside an edge: as exact.
#[test]
fn slacks_at_a_vertex_of_many_neighbours_stay_small() {
    let mut random = Random::new(5);
    let meshes = [
        models::cone(1500, 1.0),
        models::cone(1500, 1e-3),
        models::bipyramid(1000, 1.0),
        models::trapezohedron(700, 1.0),
        models::moment_curve(1000),
    ];
    for mesh in meshes {
        let p = hull(&turned(&mut random, &mesh.unwrap().vertices));
        let worst = p.faces.iter().map(|face| face.slack).fold(0.0, f64::max);
        assert!(worst > 0.0 && worst <= 12.0 * UNIT_ROUNDOFF * p.radius, "{:e} of {:e}", worst, p.radius);
    }
}

#[test]
fn ellipsoids() {
    let mut random = Random::new(4);
    for (count, semi_axes) in [
        (10, [1.0, 1.0, 1.0]),
        (102, [1.0, 0.9, 0.8]),
        (1002, [1.0, 0.9, 0.1]),
        (1002, [1.0, 1e-3, 1e-3]),
        (10_002, [1.0, 1.0, 0.5]),
    ] {
        let p = hull(&ellipsoid(&mut random, count, semi_axes));
        assert_eq!(counts(&p), (count, 3 * count - 6, 2 * count - 4));
        assert!(p.faces.iter().all(|f| f.slack < 8.0 * f64::EPSILON));
    }
}

#[test]
fn slivers_stay_apart() {
    // A square with a fold along its diagonal, one corner raised by a tiny height, on an apex below.
    for height in [1e-8, 1e-10, 1e-12, 1e-14] {
        let points = [[0.0, 0.0, 0.0], [1.0, 0.0, -height], [1.0, 1.0, 0.0], [0.0, 1.0, -height], [0.5, 0.5, -1.0]];
        let p = hull(&points.map(Vector::from));
        assert_eq!(counts(&p), (5, 9, 6), "height {height:e}");
    }
    let points = [[0.0, 0.0, 0.0], [1.0, 0.0, -1e-16], [1.0, 1.0, 0.0], [0.0, 1.0, -1e-16], [0.5, 0.5, -1.0]];
    assert_eq!(counts(&hull(&points.map(Vector::from))), (5, 8, 5));
}

#[test]
fn caps_flatter_than_rounding() {
    // A patch of a sphere so large that its triangles are coplanar one with the next but not all together, on an apex below.
    let mut random = Random::new(12);
    for curvature in [1e-8, 1e-10, 1e-12, 1e-13, 1e-14, 1e-15, 1e-16] {
        let mut points: Vec<Vector> = (0..300)
            .map(|_| {
                let p = random.vector();
                Vector::new(p.x, p.y, -0.5 * curvature * (p.x * p.x + p.y * p.y))
            })
            .collect();
        points.push(Vector::new(0.0, 0.0, -1.0));
        hull(&points);
        hull(&turned(&mut random, &points));
    }
}

/// A face 10¹³ across takes a sliver beside it in, but for a side that sticks out of it. Found by fuzzing: the sides of the spike
/// left nothing inside the face.
#[test]
fn no_face_has_a_spike() {
    hull(&[
        Vector::new(25.0, 25.0, 25.0),
        Vector::new(25.0, 1.4210854715202004e-12, 0.0),
        Vector::new(5.684341886080802e-14, 0.0, 5.684341886080802e-14),
        Vector::new(0.0, 5.684341886080802e-14, 0.0),
        Vector::zeros(),
        Vector::new(68719476736.0, 0.00390625, 2.220446049250313e-16),
        Vector::new(5.684341886080802e-14, 17592186044416.0, 1.0),
    ]);
}

#[test]
fn flat_bodies_have_two_faces() {
    let mut random = Random::new(5);
    let square = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0], [0.5, 0.0, 0.0], [0.5, 0.5, 0.0]];
    let p = hull(&square.map(Vector::from));
    assert_eq!((p.dimension, counts(&p), p.bevels.len()), (2, (4, 4, 2), 4));
    let disk = &solids::prism(1000, 0.0)[..1000];
    let p = hull(disk);
    assert_eq!((p.dimension, counts(&p)), (2, (1000, 1000, 2)));
    assert!((p.mass.centre_of_mass).norm() < 1e-14);
    // An exactly planar triangle in general position is as flat.
    for _ in 0..20 {
        let p = hull(&(0..3).map(|_| random.vector()).collect::<Vec<_>>());
        assert_eq!((p.dimension, counts(&p)), (2, (3, 3, 2)));
    }
}

#[test]
fn segments_and_points() {
    let p = hull(&[Vector::new(1.0, 2.0, 3.0), Vector::new(1.0, 2.0, 3.0), Vector::new(2.0, 2.0, 3.0)]);
    assert_eq!((p.dimension, p.vertices.len(), p.mass.radius), (1, 2, 0.5 * (1.0 + 4.0 * f64::EPSILON)));
    let p = hull(&[Vector::new(-0.0, 2.0, 1e300), Vector::new(0.0, 2.0, 1e300)]);
    assert_eq!((p.dimension, p.vertices.len(), p.radius), (0, 1, 0.0));
    assert_eq!(p.vertex_labels, [0]);
}

/// By hand: the centre of a tetrahedron is the mean of its corners, that of a pyramid a quarter of its height above its base's.
#[test]
fn masses_are_those_of_the_textbook() {
    let tetrahedron = hull(&[[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]].map(Vector::from));
    let mass = &tetrahedron.mass;
    assert!((mass.volume - 1.0 / 6.0).abs() < 1e-16 && (mass.centre_of_mass - Vector::repeat(0.25)).norm() < 1e-16);
    assert!((mass.radius - 11.0_f64.sqrt() / 4.0).abs() < 1e-15);
    let base = [[0.0, 0.0], [4.0, 0.0], [4.0, 2.0], [0.0, 2.0]].map(|[x, y]| Vector::new(x, y, 5.0));
    let corners = [&base[..], &[Vector::new(1.0, 0.5, 11.0)]].concat();
    let pyramid = hull(&corners);
    let mass = &pyramid.mass;
    assert!((mass.volume - 16.0).abs() < 1e-14);
    assert!((mass.centre_of_mass - Vector::new(1.75, 0.875, 6.5)).norm() < 1e-14, "{mass:?}");
    let farthest = corners.iter().map(|p| (p - mass.centre_of_mass).norm());
    assert!((mass.radius - farthest.fold(0.0, f64::max)).abs() < 1e-14, "{mass:?}");
}

#[test]
fn far_from_the_origin_nothing_is_lost() {
    let mut random = Random::new(6);
    let offset = Vector::new(1e9, -1e9, 1e9);
    let points: Vec<Vector> = ellipsoid(&mut random, 102, [1.0, 0.5, 0.25]).iter().map(|p| p + offset).collect();
    let p = hull(&points);
    assert!(p.radius < 1.1);
    assert!(p.faces.iter().all(|f| f.slack < 8.0 * f64::EPSILON));
}

#[test]
fn any_scale() {
    let points = ellipsoid(&mut Random::new(7), 52, [1.0, 0.7, 0.4]);
    let p = hull(&points);
    for exponent in [-1000, -180, -30, 30, 180, 1020] {
        let scale = 2.0_f64.powi(exponent);
        let q = build(&points.iter().map(|p| p * scale).collect::<Vec<_>>(), None).unwrap();
        assert_eq!(p.triangles, q.triangles);
        assert!(p.vertices.iter().zip(&q.vertices).all(|(v, w)| v.position * scale == w.position));
        // Bounds are rounded up where scaling may round.
        let is_bound = |x: f64, y: f64| (x * scale..=(x * scale).next_up()).contains(&y);
        assert!(p.faces.iter().zip(&q.faces).all(|(f, g)| is_bound(f.slack, g.slack)));
        assert!(p.edges.iter().zip(&q.edges).all(|(d, e)| d.length * scale == e.length && d.normals == e.normals));
        assert!(is_bound(p.radius, q.radius));
        assert_eq!(p.mass.upper * scale, q.mass.upper);
    }
    // Sizes that doubles can hardly hold, and all of them at once.
    let tiny = f64::from_bits(1);
    for points in [
        vec![[0.0, 0.0, 0.0], [tiny, 0.0, 0.0], [0.0, tiny, 0.0], [0.0, 0.0, tiny]],
        vec![[-f64::MAX, 0.0, 0.0], [f64::MAX, 0.0, 0.0], [0.0, f64::MAX, 0.0], [0.0, 0.0, f64::MAX]],
        vec![[0.0, 0.0, 0.0], [1e300, 0.0, 0.0], [0.0, tiny, 0.0], [0.0, 0.0, 1.0]],
    ] {
        let p = build(&points.into_iter().map(Vector::from).collect::<Vec<_>>(), None).unwrap();
        assert_eq!((p.dimension, counts(&p)), (3, (4, 6, 4)));
    }
    // So small and so far that the scale at which the body is laid out takes its centre beyond the doubles.
    for far in [1e300, f64::MAX] {
        let ends = [[far, -1e-200, 7.0], [far, 3e-200, 7.0]].map(Vector::from);
        let mass = build(&ends, None).unwrap().mass;
        assert_eq!(mass.centre_of_mass, Vector::new(far, 1e-200, 7.0));
    }
}

#[test]
fn thin_bodies_random_and_degenerate() {
    let mut random = Random::new(8);
    for round in 0..200 {
        let count = 4 + random.below(30);
        let digits = 2.0_f64.powi(random.below(50) as i32);
        let thin = 2.0_f64.powi(-(random.below(60) as i32));
        // Coordinates on a grid: many exact and many nearly exact ties.
        let points: Vec<Vector> = (0..count)
            .map(|_| {
                let p = random.vector();
                Vector::new((p.x * digits).round() / digits, (p.y * digits).round() / digits, p.z * thin)
            })
            .collect();
        let points = if round % 2 == 0 { turned(&mut random, &points) } else { points };
        hull(&points);
    }
}

#[test]
fn the_same_input_gives_the_same_arrays() {
    let points = ellipsoid(&mut Random::new(9), 302, [1.0, 0.9, 0.3]);
    assert_eq!(build(&points, None).unwrap(), build(&points, None).unwrap());
}

/// The polyhedron of a mesh, and that its labels are the polygons on each face.
fn from_polygons(mesh: &PolygonMesh) -> Polyhedron {
    let p = build(&mesh.vertices, Some(mesh)).unwrap();
    validate(&mesh.vertices, &p);
    let mut labels = p.face_labels.clone();
    labels.sort_unstable();
    assert_eq!(labels, (0..mesh.face_count() as u32).collect::<Vec<_>>(), "every polygon lies on one face");
    for f in 0..p.faces.len() as u32 {
        let planes = &p.faces[f as usize].planes;
        for &label in p.labels_of_face(f) {
            let corners = mesh.face(label as usize).iter().map(|c| mesh.vertices[*c as usize] - p.centre);
            for corner in corners.clone() {
                assert!(planes.value(0, &corner).abs() <= 64.0 * f64::EPSILON * p.radius);
            }
            let middle = corners.sum::<Vector>() / mesh.face(label as usize).len() as f64;
            assert_eq!(p.polygon_at(f, &middle), label);
        }
    }
    p
}

#[test]
fn labels_are_the_callers_polygons() {
    // A cube of twelve triangles, with a vertex given twice and one in the middle of an edge.
    let mut vertices = solids::cuboid([2.0, 2.0, 2.0]);
    vertices.push(vertices[0]);
    vertices.push(Vector::new(0.0, -1.0, -1.0));
    #[rustfmt::skip]
    let triangles = [
        0, 2, 9,  9, 2, 1,  2, 3, 1,  4, 5, 7,  4, 7, 6,  8, 9, 5,  9, 1, 5,  8, 5, 4,
        2, 6, 3,  3, 6, 7,  8, 4, 2,  2, 4, 6,  1, 3, 5,  3, 7, 5,
    ];
    let mesh = PolygonMesh::new(vertices, triangles.to_vec(), None).unwrap();
    let mut random = Random::new(10);
    for round in 0..50 {
        let mut mesh = mesh.clone();
        if round > 0 {
            mesh.vertices = turned(&mut random, &mesh.vertices);
        }
        let p = from_polygons(&mesh);
        assert_eq!((p.edges.len(), p.faces.len()), (12, 6));
        let mut sizes: Vec<usize> = (0..6).map(|f| p.labels_of_face(f).len()).collect();
        sizes.sort_unstable();
        assert_eq!(sizes, [2, 2, 2, 2, 3, 3]);
        assert!(!p.vertex_labels.contains(&8), "the second of two equal vertices names nothing");
    }
}

#[test]
fn a_fan_of_a_thousand_triangles_is_one_face() {
    let n = 1000;
    let mut random = Random::new(11);
    let mut vertices = solids::prism(n as usize, 1.0);
    vertices.push(Vector::new(0.0, 0.0, 1.0));
    let mut indices: Vec<u32> = (0..n).rev().collect();
    let mut valences = vec![n];
    for i in 0..n {
        let j = (i + 1) % n;
        indices.extend([i, j, n + j, n + i]);
        indices.extend([n + i, n + j, 2 * n]);
        valences.extend([4, 3]);
    }
    for _ in 0..3 {
        let mesh = PolygonMesh::new(turned(&mut random, &vertices), indices.clone(), Some(&valences)).unwrap();
        let p = from_polygons(&mesh);
        assert_eq!((p.edges.len(), p.faces.len()), (3000, 1002));
        assert_eq!((0..1002).map(|f| p.labels_of_face(f).len()).max(), Some(1000));
    }
}

#[test]
fn both_sides_of_a_flat_body_have_labels() {
    let square = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]].map(Vector::from);
    let mesh = PolygonMesh::new(square.to_vec(), vec![3, 2, 1, 0, 0, 1, 2, 0, 2, 3], Some(&[4, 3, 3])).unwrap();
    let p = from_polygons(&mesh);
    let up = (0..2).find(|f| p.faces[*f as usize].planes.z[0] > 0.0).unwrap();
    assert_eq!((p.labels_of_face(up), p.labels_of_face(1 - up)), (&[1, 2][..], &[0][..]));
}

#[test]
fn vertices_an_ulp_inside_keep_every_polygon_on_some_face() {
    // A sphere of quadrilateral cells through single precision: many vertices and whole cells lie inside the hull by rounding.
    let (rings, sectors) = (40_u32, 80_u32);
    let mut vertices = Vec::new();
    for ring in 1..rings {
        for sector in 0..sectors {
            let (sine, z) = (std::f64::consts::PI * f64::from(ring) / f64::from(rings)).sin_cos();
            let (y, x) = (std::f64::consts::TAU * f64::from(sector) / f64::from(sectors)).sin_cos();
            vertices.push(Vector::new(sine * x, sine * y, z).map(|x| f64::from(x as f32)));
        }
    }
    let last = (rings - 2) * sectors;
    let mut indices: Vec<u32> = (0..sectors).chain((last..last + sectors).rev()).collect();
    let mut valences = vec![sectors, sectors];
    for ring in 0..rings - 2 {
        for sector in 0..sectors {
            let (i, j) = (ring * sectors + sector, ring * sectors + (sector + 1) % sectors);
            indices.extend([i, i + sectors, j + sectors, j]);
            valences.push(4);
        }
    }
    let mesh = PolygonMesh::new(vertices, indices, Some(&valences)).unwrap();
    let p = build(&mesh.vertices, Some(&mesh)).unwrap();
    validate(&mesh.vertices, &p);
    assert!(p.faces.len() > mesh.face_count(), "rounding breaks cells");
    for f in 0..p.faces.len() {
        let n = Vector::new(p.faces[f].planes.x[0], p.faces[f].planes.y[0], p.faces[f].planes.z[0]);
        for &label in p.labels_of_face(f as u32) {
            let corners = mesh.face(label as usize).iter().map(|c| mesh.vertices[*c as usize]);
            let middle = corners.sum::<Vector>().normalize();
            assert!(middle.dot(&n) > 0.995, "polygon {label} on face {f}");
        }
    }
}

/// Along (1, 1, 1) times the smallest double each product of a double with it rounds to 0 or ±1 of it, and all four edges of a
/// ring rise.
#[test]
fn the_climb_ends_for_any_length_of_its_direction() {
    let steps = [[0.72, -0.49, -0.49], [-0.49, 0.72, -0.49], [-0.49, -0.49, 0.72]].map(Vector::from);
    let ring = [Vector::zeros(), steps[0], steps[0] + steps[1], steps[0] + steps[1] + steps[2]];
    let tetrahedron = build(&ring, None).unwrap();
    for start in 0..4 {
        let (top, climbed) = tetrahedron.support(&Vector::repeat(1.0), start);
        assert!(climbed < 4);
        for length in [5e-324, 1e-300, 1e-40, 1e40, 1e300] {
            assert_eq!(tetrahedron.support(&Vector::repeat(length), start), (top, climbed));
        }
    }
}
