//! Shapes from meshes, points and files: policies, input transform, errors.

use std::path::Path;

use dashu_ratio::RBig;
use swiftprox::error::Error;
use swiftprox::hierarchy::{Hierarchy, HierarchyOptions, LEAST_VERTICES_FOR_LEVELS};
use swiftprox::math::{Matrix, Pose, Vector};
use swiftprox::mesh::PolygonMesh;
use swiftprox::pair::{self, Levels, Outcome, PairAnswer, PairCache, PairConfig};
use swiftprox::progress::Progress;
use swiftprox::shape::{InputPolicy, Shape, ShapeOptions};

/// A unit cube of six quadrilaterals.
fn cube() -> PolygonMesh {
    let vertices = (0..8).map(|i| Vector::new(f64::from(i & 1), f64::from(i >> 1 & 1), f64::from(i >> 2))).collect();
    #[rustfmt::skip]
    let sides = [0, 2, 3, 1,  4, 5, 7, 6,  0, 1, 5, 4,  2, 6, 7, 3,  0, 4, 6, 2,  1, 3, 7, 5];
    PolygonMesh::new(vertices, sides.to_vec(), Some(&[4; 6])).unwrap()
}

/// A square, one polygon on either side.
fn square() -> PolygonMesh {
    let corners = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]].map(Vector::from);
    PolygonMesh::new(corners.to_vec(), vec![0, 1, 2, 3, 3, 2, 1, 0], Some(&[4, 4])).unwrap()
}

/// An octahedron with one corner pushed in through its centre.
fn dented() -> PolygonMesh {
    let mut vertices = Vec::new();
    for k in 0..3 {
        vertices.extend([Vector::ith(k, 1.0), Vector::ith(k, -1.0)]);
    }
    vertices[4].z = -0.5;
    #[rustfmt::skip]
    let triangles = [0, 2, 4,  2, 1, 4,  1, 3, 4,  3, 0, 4,  2, 0, 5,  1, 2, 5,  3, 1, 5,  0, 3, 5];
    PolygonMesh::new(vertices, triangles.to_vec(), None).unwrap()
}

fn with(input: InputPolicy) -> ShapeOptions {
    ShapeOptions { input, ..Default::default() }
}

/// The default tolerance is relative to the diagonal, which overflows here.
#[test]
fn a_dent_in_the_largest_of_bodies_is_refused() {
    for size in [1.0, f64::MAX] {
        for (depth, is_convex) in [(0.0, true), (0.5, false)] {
            let mut corners = cube();
            corners.vertices.iter_mut().for_each(|v| *v = v.map(|x| (2.0 * x - 1.0) * size));
            let top: Vec<u32> = corners.face(1).to_vec();
            let dent = corners.vertices.len() as u32;
            corners.vertices.push(Vector::new(0.0, 0.0, corners.vertices[top[0] as usize].z * (1.0 - depth)));
            let mut faces: Vec<Vec<u32>> = (0..6).filter(|&f| f != 1).map(|f| corners.face(f).to_vec()).collect();
            faces.extend((0..4).map(|k| vec![top[k], top[(k + 1) % 4], dent]));
            let counts: Vec<u32> = faces.iter().map(|face| face.len() as u32).collect();
            let mesh = PolygonMesh::new(corners.vertices, faces.concat(), Some(&counts)).unwrap();
            let shape = Shape::from_mesh(&mesh, &with(InputPolicy::Strict));
            assert_eq!(shape.is_ok(), is_convex, "{size:e} {depth}: {:?}", shape.err());
        }
    }
}

#[test]
fn a_convex_mesh_passes_every_policy_and_keeps_its_labels() {
    for policy in [InputPolicy::Strict, InputPolicy::Flat, InputPolicy::Hull] {
        let shape = Shape::from_mesh(&cube(), &with(policy)).unwrap();
        let p = shape.polyhedron();
        for f in 0..6 {
            let [label] = *p.labels_of_face(f) else { panic!("one polygon a face") };
            let planes = &p.faces[f as usize].planes;
            let expected = [
                [0.0, 0.0, -1.0],
                [0.0, 0.0, 1.0],
                [0.0, -1.0, 0.0],
                [0.0, 1.0, 0.0],
                [-1.0, 0.0, 0.0],
                [1.0, 0.0, 0.0],
            ];
            assert_eq!([planes.x[0], planes.y[0], planes.z[0]], expected[label as usize]);
        }
    }
}

#[test]
fn flat_meshes_are_admitted_on_request() {
    let refused = Shape::from_mesh(&square(), &with(InputPolicy::Strict)).unwrap_err();
    assert!(matches!(&refused, Error::Mesh(m) if m.contains("flat") || m.contains("plane")), "{refused}");
    for policy in [InputPolicy::Flat, InputPolicy::Hull] {
        let shape = Shape::from_mesh(&square(), &with(policy)).unwrap();
        assert_eq!((shape.polyhedron().dimension, shape.polyhedron().faces.len()), (2, 2));
    }
}

#[test]
fn the_hull_policy_takes_anything() {
    for policy in [InputPolicy::Strict, InputPolicy::Flat] {
        let refused = Shape::from_mesh(&dented(), &with(policy)).unwrap_err();
        assert!(matches!(refused, Error::Mesh(_)), "{refused}");
    }
    let shape = Shape::from_mesh(&dented(), &with(InputPolicy::Hull)).unwrap();
    assert_eq!((shape.polyhedron().vertices.len(), shape.polyhedron().faces.len()), (5, 5));
    assert_eq!(shape.polyhedron().face_labels, [0, 1, 2, 3, 4]);
}

#[test]
fn points_without_interior() {
    let point = [Vector::new(1.0, 2.0, 3.0)];
    let segment = [Vector::zeros(), Vector::x()];
    let triangle = [Vector::zeros(), Vector::x(), Vector::y()];
    for (points, dimension) in [(&point[..], 0), (&segment[..], 1), (&triangle[..], 2)] {
        for (policy, least) in [(InputPolicy::Strict, 3), (InputPolicy::Flat, 2), (InputPolicy::Hull, 0)] {
            let result = Shape::from_points(points, &with(policy));
            if dimension < least {
                assert!(matches!(result, Err(Error::Mesh(_))));
            } else {
                assert_eq!(result.unwrap().polyhedron().dimension, dimension);
            }
        }
    }
    assert!(matches!(Shape::from_points(&[], &with(InputPolicy::Hull)), Err(Error::Argument(_))));
}

#[test]
fn the_input_transform_rounds_once() {
    // A rotation about z by atan(4/3), whose entries are not doubles, and numbers that cancel.
    let rotation = Matrix::new(0.6, -0.8, 0.0, 0.8, 0.6, 0.0, 0.0, 0.0, 1.0);
    let translation = Vector::new(-2.6, 1e6, 0.1);
    let options = ShapeOptions { rotation, translation, scale: 0.3, ..with(InputPolicy::Hull) };
    let point = Vector::new(1e3, 1.0 / 3.0, -7.0);
    let shape = Shape::from_points(&[point], &options).unwrap();
    let exact = |row: usize| {
        let rational = |x: f64| RBig::try_from(x).unwrap();
        let rotated = (0..3).fold(RBig::ZERO, |sum, k| sum + rational(rotation[(row, k)]) * rational(point[k]));
        (rotated * rational(0.3) + rational(translation[row])).to_f64().value()
    };
    assert_eq!(shape.polyhedron().local_position(0), Vector::new(exact(0), exact(1), exact(2)));
}

#[test]
fn options_out_of_range_are_refused() {
    let message = |options: ShapeOptions| match Shape::from_mesh(&cube(), &options) {
        Err(Error::Argument(message)) => message,
        other => panic!("{other:?}"),
    };
    for scale in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        assert!(message(ShapeOptions { scale, ..Default::default() }).contains("scale"));
    }
    for tolerance in [-1.0, f64::NAN, f64::INFINITY] {
        assert!(
            message(ShapeOptions { convexity_tolerance: Some(tolerance), ..Default::default() }).contains("tolerance")
        );
    }
    for rotation in [Matrix::zeros(), -Matrix::identity(), 2.0 * Matrix::identity(), f64::NAN * Matrix::identity()] {
        assert!(message(ShapeOptions { rotation, ..Default::default() }).contains("input transform"));
    }
    let translation = Vector::new(0.0, f64::INFINITY, 0.0);
    assert!(message(ShapeOptions { translation, ..Default::default() }).contains("input transform"));
    assert!(message(ShapeOptions { scale: 1e308, ..Default::default() }).contains("vertex 0"));
}

/// The message of a refusal for what the mesh is.
#[track_caller]
fn mesh_message(refused: Result<Shape, Error>) -> String {
    match refused {
        Err(Error::Mesh(message)) => message,
        other => panic!("{other:?}"),
    }
}

#[test]
fn refusals_of_bodies_without_interior_say_which_policy_admits_them() {
    let corners = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]].map(Vector::from);
    let line = PolygonMesh::new([0.0, 1.0, 2.0].map(|x| Vector::new(x, x, 0.0)).to_vec(), vec![0, 1, 2, 2, 1, 0], None);
    let line = line.unwrap();
    let (strict, flat, hull) = (with(InputPolicy::Strict), with(InputPolicy::Flat), with(InputPolicy::Hull));
    for (refused, named) in [
        (Shape::from_mesh(&square(), &strict), "SWIFTPROX_INPUT_FLAT"),
        (Shape::from_mesh(&line, &strict), "SWIFTPROX_INPUT_HULL"),
        (Shape::from_mesh(&line, &flat), "SWIFTPROX_INPUT_HULL"),
        (Shape::from_points(&corners, &strict), "SWIFTPROX_INPUT_FLAT"),
        (Shape::from_points(&corners[..2], &strict), "SWIFTPROX_INPUT_HULL"),
        (Shape::from_points(&corners[..2], &flat), "SWIFTPROX_INPUT_HULL"),
        (Shape::from_points(&corners[..1], &flat), "SWIFTPROX_INPUT_HULL"),
    ] {
        let message = mesh_message(refused);
        assert_eq!(message.matches("SWIFTPROX_INPUT_").count(), 1, "{message}");
        assert!(message.contains(named), "{message}");
    }
    // And they do.
    assert!(Shape::from_mesh(&square(), &flat).is_ok() && Shape::from_points(&corners, &flat).is_ok());
    assert!(Shape::from_mesh(&line, &hull).is_ok() && Shape::from_points(&corners[..1], &hull).is_ok());
}

#[test]
fn meshes_of_nothing_are_told() {
    let no_vertices = PolygonMesh::new(Vec::new(), Vec::new(), None).unwrap();
    let no_faces = PolygonMesh { indices: Vec::new(), starts: vec![0], ..cube() };
    for policy in [InputPolicy::Strict, InputPolicy::Flat, InputPolicy::Hull] {
        assert_eq!(mesh_message(Shape::from_mesh(&no_vertices, &with(policy))), "the mesh has no vertices");
    }
    assert_eq!(
        mesh_message(Shape::from_mesh(&no_faces, &with(InputPolicy::Flat))),
        "the mesh has no faces; the input policy Hull (SWIFTPROX_INPUT_HULL) takes the hull of the vertices"
    );
    assert!(Shape::from_mesh(&no_faces, &with(InputPolicy::Hull)).is_ok());
}

/// The message recommended the hull of all vertices alone, which reaches to those of no face. Of tablelegs-*.obj of mujoco_warp 48
/// of 120 are, and the hull is 0.381 wide where the surface is 0.325. Whoever follows the message now knows, and has both.
#[test]
fn vertices_of_no_face_are_told_of_and_may_be_left_out() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/fixtures/meshes/stray.obj");
    let of_file = |policy| Shape::from_file(&path, &with(policy));
    let cure = "; the input policy Patch (SWIFTPROX_INPUT_PATCH) takes the hull of the faces, the input policy Hull \
                (SWIFTPROX_INPUT_HULL) takes the hull of the vertices, also of those in no face (such as vertex 8)";
    for policy in [InputPolicy::Strict, InputPolicy::Flat, InputPolicy::NearlyConvex] {
        let expected = format!("{}: vertex 8 belongs to no face{cure}", path.display());
        assert_eq!(mesh_message(of_file(policy)), expected);
    }
    let reach = |shape: &Shape| {
        let polyhedron = shape.polyhedron();
        let vertices = (0..polyhedron.vertices.len() as u32).map(|v| polyhedron.local_position(v).x);
        (polyhedron.vertices.len(), vertices.fold(f64::MIN, f64::max))
    };
    let (by_faces, of_all) = (of_file(InputPolicy::Patch).unwrap(), of_file(InputPolicy::Hull).unwrap());
    assert_eq!((reach(&by_faces), reach(&of_all)), ((8, 1.0), (9, 5.0)));
    let of_cube = Shape::from_file(&path.with_file_name("cube.obj"), &ShapeOptions::default()).unwrap();
    assert_eq!(by_faces.polyhedron().face_labels, of_cube.polyhedron().face_labels);
    assert_eq!(by_faces.polyhedron().vertex_labels, of_cube.polyhedron().vertex_labels);

    // Whatever else is wrong; a vertex that equals one of a face is no other.
    let mut mesh = cube();
    mesh.vertices.extend([Vector::zeros(), Vector::new(0.5, 0.5, 9.0)]);
    mesh.indices.truncate(20);
    mesh.starts.truncate(6);
    let message = mesh_message(Shape::from_mesh(&mesh, &ShapeOptions::default()));
    assert!(message.ends_with(&cure.replace("vertex 8", "vertex 9")), "{message}");
    let (by_faces, of_all) =
        (Shape::from_mesh(&mesh, &with(InputPolicy::Patch)), Shape::from_mesh(&mesh, &with(InputPolicy::Hull)));
    assert_eq!((by_faces.unwrap().polyhedron().vertices.len(), of_all.unwrap().polyhedron().vertices.len()), (8, 9));
    mesh.vertices.pop();
    let message = mesh_message(Shape::from_mesh(&mesh, &ShapeOptions::default()));
    assert!(
        message.ends_with("; the input policy Hull (SWIFTPROX_INPUT_HULL) takes the hull of the vertices"),
        "{message}"
    );
    // A face without an area is no part of a patch, so that policy is not recommended.
    mesh.vertices.push(Vector::new(0.5, 0.5, 9.0));
    mesh.push_face(&[0, 1]).unwrap();
    let message = mesh_message(Shape::from_mesh(&mesh, &ShapeOptions::default()));
    assert!(message.contains("face 5 is degenerate") && !message.contains("PATCH"), "{message}");
    assert!(
        message.ends_with("takes the hull of the vertices, also of those in no face (such as vertex 9)"),
        "{message}"
    );
}

#[test]
fn files_whose_mesh_is_refused_are_named() {
    let path = Path::new(env!("CARGO_TARGET_TMPDIR")).join("open.off");
    std::fs::write(&path, "OFF\n4 3 6\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 2 1\n3 0 1 3\n3 1 2 3\n").unwrap();
    let message = mesh_message(Shape::from_file(&path, &ShapeOptions::default()));
    assert!(message.contains("open.off: ") && message.contains("edge"), "{message}");
}

#[test]
fn files_that_are_not_there_are_named() {
    let error = Shape::from_file(Path::new("no/such/file.off"), &ShapeOptions::default()).unwrap_err();
    assert!(matches!(&error, Error::File(m) if m.contains("no/such/file.off")), "{error}");
}

/// 200,000 triangles: the callback is asked so often that no wait for it is long, and a build that is told to stop stops there.
#[test]
fn a_large_build_tells_how_far_it_is_and_stops_when_told() {
    let mesh = testkit::models::ellipsoid([1.0, 1.0, 0.1], 100_002).unwrap();
    let build = |callback: &mut dyn FnMut(f64) -> bool| {
        Shape::from_mesh_in_steps(&mesh, &ShapeOptions::default(), &mut Progress::new(callback))
    };
    let mut told = vec![0.0];
    build(&mut |fraction| {
        told.push(fraction);
        true
    })
    .unwrap();
    assert!(told.is_sorted(), "a fraction falls");
    assert_eq!(told.last(), Some(&1.0));
    // Fractions are of the time that the parts of such a build were measured to take.
    let longest = told.windows(2).map(|pair| pair[1] - pair[0]).fold(0.0, f64::max);
    assert!(longest < 0.2, "no report for {longest:.2} of the build");
    let count = told.len() - 1;
    for stop_at in [1, 2, count / 2, count - 1, count] {
        let mut asked = 0;
        let result = build(&mut |_| {
            asked += 1;
            asked < stop_at
        });
        assert!(matches!(result, Err(Error::Cancelled(_))), "asked {asked} times");
        assert_eq!(asked, stop_at);
    }
}

/// A body of automatic levels.
fn body_of_automatic_levels() -> Shape {
    let mesh = testkit::models::ellipsoid([1.0, 0.6, 0.3], LEAST_VERTICES_FOR_LEVELS).unwrap();
    Shape::from_mesh(&mesh, &ShapeOptions::default()).unwrap()
}

/// Its levels, as they are built where nobody stops it.
fn automatic_levels(shape: &Shape) -> Hierarchy {
    Hierarchy::build(shape.polyhedron(), &HierarchyOptions::default(), &mut Progress::new(&mut |_| true)).unwrap()
}

/// Asks for a distance through levels: the shape is answered whatever it lacks, and then lacks nothing.
fn check_usable(shape: &Shape) {
    let away = Pose::new(&Matrix::identity(), &Vector::new(4.0, 1.0, 0.5));
    let config = PairConfig { levels: Levels::All, absolute_error: 0.5, ..PairConfig::default() };
    let (mut cache, mut answer) = (PairCache::default(), PairAnswer::default());
    pair::approximate([shape.at(&Pose::IDENTITY), shape.at(&away)], &mut cache, &config, &mut answer).unwrap();
    assert_eq!(answer.outcome, Outcome::Separated);
    assert!(answer.statistics.levels[0] > 0, "{answer:?}");
}

#[test]
fn preparing_tells_how_far_it_is_and_stops_when_told() {
    let shape = body_of_automatic_levels();
    let expected = automatic_levels(&shape);
    assert!(!expected.levels.is_empty());
    let prepare = |callback: &mut dyn FnMut(f64) -> bool| shape.prepare(&mut Progress::new(callback));
    // Cancelled early, in the middle, and when it is done: as if it had never been.
    for stop_at in [0.0, 0.3, 0.9, 1.0] {
        let mut last = -1.0;
        let result = prepare(&mut |fraction| {
            assert!(fraction >= last && last < stop_at, "{fraction} after {last}");
            last = fraction;
            fraction < stop_at
        });
        assert!(matches!(result, Err(Error::Cancelled(_))), "{result:?}");
        assert_eq!(shape.hierarchy(), &Hierarchy::AUTOMATIC, "{stop_at}");
    }
    check_usable(&shape.clone());
    assert_eq!(shape.hierarchy(), &Hierarchy::AUTOMATIC, "the clone's are its own");

    let mut told = vec![0.0];
    prepare(&mut |fraction| {
        told.push(fraction);
        true
    })
    .unwrap();
    assert!(told.is_sorted() && told.last() == Some(&1.0), "{told:?}");
    let longest = told.windows(2).map(|pair| pair[1] - pair[0]).fold(0.0, f64::max);
    assert!(longest < 0.25, "no report for {longest:.2} of it");
    assert_eq!(shape.hierarchy(), &expected);
    assert!(shape.polyhedron().lookup.made.get().is_some());

    // What is made is not made again, and nothing takes it back.
    let (bytes, mut told) = (shape.bytes(), Vec::new());
    prepare(&mut |fraction| {
        told.push(fraction);
        true
    })
    .unwrap();
    assert_eq!(told, [0.0, 1.0]);
    assert!(matches!(prepare(&mut |_| false), Err(Error::Cancelled(_))));
    assert_eq!((shape.bytes(), shape.hierarchy()), (bytes, &expected));
    check_usable(&shape);
}

/// Two that prepare, one that is cancelled, one that asks through the levels: nobody hangs, and the levels are those of any one.
#[test]
fn threads_may_prepare_cancel_and_ask_at_once() {
    let shape = body_of_automatic_levels();
    std::thread::scope(|threads| {
        for _ in 0..2 {
            threads.spawn(|| shape.prepare(&mut Progress::new(&mut |_| true)).unwrap());
        }
        threads.spawn(|| drop(shape.prepare(&mut Progress::new(&mut |fraction| fraction < 0.5))));
        threads.spawn(|| check_usable(&shape));
    });
    assert_eq!(shape.hierarchy(), &automatic_levels(&shape));
}

/// A body of so many vertices that it is built in an order of its own: labels and messages are in the caller's numbers.
#[test]
#[cfg_attr(miri, ignore = "builds a large body, which takes it hours")]
fn large_meshes_keep_their_numbers() {
    let mut mesh = testkit::models::ellipsoid([1.0, 1.0, 0.1], 5000).unwrap();
    // In no order at all.
    let mut random = testkit::random::Random::new(3);
    let mut faces: Vec<[u32; 3]> = mesh.indices.chunks(3).map(|corners| corners.try_into().unwrap()).collect();
    for i in (1..faces.len()).rev() {
        faces.swap(i, random.uniform(0.0, i as f64) as usize);
    }
    mesh.indices = faces.concat();
    let shape = Shape::from_mesh(&mesh, &ShapeOptions::default()).unwrap();
    let polyhedron = shape.polyhedron();
    let mut seen = vec![false; mesh.face_count()];
    for face in 0..polyhedron.faces.len() as u32 {
        for &label in polyhedron.labels_of_face(face) {
            assert!(!std::mem::replace(&mut seen[label as usize], true));
            let planes = &polyhedron.faces[face as usize].planes;
            let corners = mesh.face(label as usize).iter().map(|v| mesh.vertices[*v as usize] - polyhedron.centre);
            assert!(corners.into_iter().all(|corner| planes.value(0, &corner).abs() < 1e-14));
        }
    }
    assert!(seen.iter().all(|seen| *seen));
    let of_points = Shape::from_points(&mesh.vertices, &ShapeOptions::default()).unwrap();
    for polyhedron in [shape.polyhedron(), of_points.polyhedron()] {
        for (v, label) in (0..).zip(&polyhedron.vertex_labels) {
            assert_eq!(polyhedron.local_position(v), mesh.vertices[*label as usize]);
        }
    }

    let message = |mesh: &PolygonMesh| Shape::from_mesh(mesh, &ShapeOptions::default()).unwrap_err().to_string();
    let as_given =
        |mesh: &PolygonMesh| swiftprox::body::build::check::check_mesh(mesh, 2e-9, false).unwrap_err().to_string();
    let before_tolerance = |message: String| message.split(" (allowed").next().unwrap().to_string();
    mesh.indices[3 * 1234..3 * 1235].reverse();
    assert!(message(&mesh).contains("runs in the same direction in face") && message(&mesh).contains("1234"));
    let cure = "; the input policy Hull (SWIFTPROX_INPUT_HULL) takes the hull of the vertices";
    assert_eq!(message(&mesh), as_given(&mesh) + cure);
    mesh.indices[3 * 1234..3 * 1235].reverse();
    mesh.vertices[faces[1234][0] as usize] *= 0.5;
    assert_eq!(before_tolerance(message(&mesh)), before_tolerance(as_given(&mesh)));
}
