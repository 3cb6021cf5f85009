//! Shapes saved and loaded: the same comes back, and bytes of any content give a sound shape or an error.

use std::collections::BTreeSet;
use std::fs;
use std::path::Path;

use swiftprox::body::build::assembly::Labels;
use swiftprox::body::tables::{LookupKind, LookupOptions};
use swiftprox::error::Error;
use swiftprox::hierarchy::{HierarchyKind, HierarchyOptions};
use swiftprox::math::Vector;
use swiftprox::mesh::PolygonMesh;
use swiftprox::progress::Progress;
use swiftprox::shape::{InputPolicy, Shape, ShapeOptions};
use swiftprox::shape_file::{from_bytes, from_bytes_in_steps, load, load_in_steps, save, to_bytes};
use testkit::models::{cuboid, ellipsoid, prism, random_hull};
use testkit::random::Random;

const KINDS: [HierarchyKind; 5] = [
    HierarchyKind::None,
    HierarchyKind::Automatic,
    HierarchyKind::Quadric,
    HierarchyKind::DobkinKirkpatrick,
    HierarchyKind::OuterCuts,
];

fn with_levels(mesh: &PolygonMesh, kind: HierarchyKind) -> Shape {
    let hierarchy = HierarchyOptions { kind, decimation: 0.4, minimum_triangles: 20, most_levels: 5 };
    Shape::from_mesh(mesh, &ShapeOptions { hierarchy, ..ShapeOptions::default() }).unwrap()
}

fn triangulated_cuboid() -> PolygonMesh {
    let polygons = cuboid([1.0, 2.0, 3.0]).unwrap();
    let corners = (0..6).flat_map(|f| {
        let [a, b, c, d] = *polygons.face(f) else { panic!("a quadrilateral") };
        [a, b, c, a, c, d]
    });
    let corners: Vec<u32> = corners.collect();
    PolygonMesh::new(polygons.vertices.clone(), corners, None).unwrap()
}

fn shapes() -> Vec<Shape> {
    let mut all = Vec::new();
    let moved = |by: Vector| {
        let mut mesh = ellipsoid([1.0, 0.7, 0.2], 150).unwrap();
        mesh.vertices.iter_mut().for_each(|v| *v += by);
        mesh
    };
    let meshes = [
        ellipsoid([1.0, 1.0, 0.1], 200).unwrap(),
        random_hull(300, 5).unwrap(),
        prism(40, 0.3).unwrap(),
        moved(Vector::new(1e6, -3e3, 0.1)),
        moved(Vector::new(1.7, 0.0, 0.0)),
        // Two labels a face.
        triangulated_cuboid(),
    ];
    for mesh in &meshes {
        all.extend(KINDS.map(|kind| with_levels(mesh, kind)));
    }
    let coarse = [ellipsoid([1.0, 1.0, 0.1], 200).unwrap(), cuboid([1.0; 3]).unwrap()];
    let given = Shape::from_levels(&coarse, &ShapeOptions::default(), &mut Progress::new(&mut |_| true));
    all.push(given.unwrap());
    for (kind, resolution) in [(LookupKind::None, 0), (LookupKind::Shells, 8), (LookupKind::Spherical, 16)] {
        let lookup = LookupOptions { kind, resolution, radius_factor: 1.5 };
        all.push(Shape::from_mesh(&meshes[0], &ShapeOptions { lookup, ..ShapeOptions::default() }).unwrap());
    }
    // Without interior, with points that are no vertices, of extreme size.
    let hull = ShapeOptions { input: InputPolicy::Hull, ..ShapeOptions::default() };
    let points = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.5, 0.0, 0.0], [0.0, 1.0, 0.0], [1.0, 1.0, 0.0], [0.2, 0.3, 0.4]];
    for count in [1, 3, 4, 5, 6] {
        for scale in [1.0, 1e-250, 1e150] {
            let points: Vec<Vector> = points[..count].iter().map(|p| Vector::from(*p) * scale).collect();
            all.push(Shape::from_points(&points, &hull).unwrap());
        }
    }
    all
}

#[test]
fn what_is_saved_comes_back() {
    let mut levels = 0;
    for shape in shapes() {
        let bytes = to_bytes(&shape).unwrap();
        let loaded = from_bytes(&bytes).unwrap();
        assert_eq!(loaded, shape);
        assert_eq!(to_bytes(&loaded).unwrap(), bytes);
        levels += shape.hierarchy().levels.len();
    }
    assert!(levels > 40, "{levels}");
}

#[test]
fn through_a_file() {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR"));
    let path = folder.join("through_a_file.shape");
    let shape = with_levels(&ellipsoid([1.0; 3], 100).unwrap(), HierarchyKind::Quadric);
    save(&shape, &path).unwrap();
    assert_eq!(load(&path).unwrap(), shape);
    let message = |path: &Path| match load(path) {
        Err(Error::File(message)) => message,
        other => panic!("{other:?}"),
    };
    // The message names the file and says what is wrong.
    let mut bytes = fs::read(&path).unwrap();
    let middle = bytes.len() / 2;
    bytes[middle] ^= 1;
    fs::write(&path, &bytes).unwrap();
    assert!(
        message(&path).contains("through_a_file.shape: the shape file is damaged: its checksum"),
        "{}",
        message(&path)
    );
    bytes[8] = 1;
    fs::write(&path, &bytes).unwrap();
    assert!(message(&path).contains("version 1; this library reads versions 2 to 4"), "{}", message(&path));
    fs::write(&path, "OFF\n4 4 6\n").unwrap();
    assert!(message(&path).contains("no shape file"), "{}", message(&path));
    // What could not be done, to which file, and the system's words why.
    let begins = |message: &str, path: &Path, what: &str| {
        let why = message.strip_prefix(&format!("{}: {what}: ", path.display()));
        assert!(why.is_some_and(|why| !why.is_empty()), "{message}");
    };
    let missing = folder.join("no-such.shape");
    begins(&message(&missing), &missing, "cannot be read");
    let missing = folder.join("no/such/folder");
    match save(&shape, &missing) {
        Err(Error::File(message)) => begins(&message, &missing, "cannot be written"),
        other => panic!("{other:?}"),
    }
}

/// Of a body with levels, the largest part of the file, and of one without: no wait for a report is long, no fraction falls, and a
/// load that is told to stop stops there.
#[test]
fn loading_tells_how_far_it_is_and_stops_when_told() {
    let mesh = ellipsoid([1.0, 0.6, 0.3], 1_000).unwrap();
    for kind in KINDS {
        let bytes = to_bytes(&with_levels(&mesh, kind)).unwrap();
        let mut told = vec![0.0];
        let loaded = from_bytes_in_steps(
            &bytes,
            &mut Progress::new(&mut |fraction| {
                told.push(fraction);
                true
            }),
        );
        assert_eq!(to_bytes(&loaded.unwrap()).unwrap(), bytes);
        assert!(told.is_sorted() && told.last() == Some(&1.0), "{kind:?}: {told:?}");
        let longest = told.windows(2).map(|pair| pair[1] - pair[0]).fold(0.0, f64::max);
        assert!(longest <= 0.25, "{kind:?}: no report for {longest:.2} of the load");
        for stop_at in 1..told.len() {
            let mut asked = 0;
            let mut callback = |_| {
                asked += 1;
                asked < stop_at
            };
            let result = from_bytes_in_steps(&bytes, &mut Progress::new(&mut callback));
            assert!(matches!(result, Err(Error::Cancelled(_))), "{kind:?}, asked {asked} times: {result:?}");
            assert_eq!(asked, stop_at);
        }
    }
    // Nor is a cancelled load a bad file where there is one, and a bad file is bad however it is read.
    let path = Path::new(env!("CARGO_TARGET_TMPDIR")).join("cancelled.shape");
    save(&with_levels(&mesh, HierarchyKind::Quadric), &path).unwrap();
    let result = load_in_steps(&path, &mut Progress::new(&mut |fraction| fraction < 0.5));
    assert!(matches!(result, Err(Error::Cancelled(_))), "{result:?}");
    fs::write(&path, "OFF\n4 4 6\n").unwrap();
    let result = load_in_steps(&path, &mut Progress::new(&mut |_| true));
    assert!(matches!(&result, Err(Error::File(message)) if message.contains("cancelled.shape")), "{result:?}");
}

/// FNV-1a, to make damage that the checksum does not find.
fn with_checksum(mut content: Vec<u8>) -> Vec<u8> {
    let step = |sum: u64, byte: &u8| (sum ^ u64::from(*byte)).wrapping_mul(0x100_0000_01b3);
    let sum = content.iter().fold(0xcbf2_9ce4_8422_2325, step);
    content.extend(sum.to_le_bytes());
    content
}

#[test]
fn damage_is_found() {
    let bytes = to_bytes(&with_levels(&ellipsoid([1.0, 1.0, 0.1], 60).unwrap(), HierarchyKind::Quadric)).unwrap();
    for length in (0..bytes.len()).step_by(7).chain([bytes.len() - 1]) {
        assert!(matches!(from_bytes(&bytes[..length]), Err(Error::File(_))), "{length}");
    }
    for i in 0..bytes.len() {
        let mut damaged = bytes.clone();
        damaged[i] ^= 1 << (i % 8);
        assert!(matches!(from_bytes(&damaged), Err(Error::File(_))), "{i}");
    }
}

/// An answer that names a vertex by its label names one, or nobody could check its proof.
#[test]
fn vertices_of_one_label_are_refused() {
    let shape = Shape::from_mesh(&triangulated_cuboid(), &ShapeOptions::default()).unwrap();
    let mut polyhedron = shape.polyhedron().clone();
    let mut labels = Labels {
        vertex_labels: polyhedron.vertex_labels.clone(),
        face_labels: polyhedron.face_labels.clone(),
        face_label_starts: polyhedron.face_label_starts.clone(),
        polygon_corners: polyhedron.polygon_corners.clone(),
        polygon_starts: polyhedron.polygon_starts.clone(),
    };
    assert!(labels.clone().give_to(&mut polyhedron).unwrap());
    labels.vertex_labels[5] = labels.vertex_labels[2];
    assert!(!labels.give_to(&mut polyhedron).unwrap());
    assert_eq!(&polyhedron, shape.polyhedron());
}

/// Whatever loads is sound: its levels contain it, and its hull passed the proof when it was loaded.
#[test]
fn forged_files_give_a_sound_shape_or_an_error() {
    let mut random = Random::new(77);
    let (mut accepted, mut refused) = (0, 0);
    let files = shapes().into_iter().map(|shape| to_bytes(&shape).unwrap());
    let originals: Vec<Vec<u8>> = files.filter(|bytes| bytes.len() < 60_000).collect();
    for round in 0..6000 {
        let original = &originals[random.next_u64() as usize % originals.len()];
        let mut content = original[..original.len() - 8].to_vec();
        for _ in 0..1 + round % 3 {
            let place = 12 + random.next_u64() as usize % (content.len() - 12);
            match random.next_u64() % 5 {
                0 => content[place] = random.next_u64() as u8,
                1 => content[place] ^= 1 << (random.next_u64() % 8),
                2 => content.truncate(place.max(13)),
                3 => {
                    let length = (random.next_u64() % 16) as usize;
                    let end = (place + length).min(content.len());
                    let copy = content[12 + (place - 12) / 2..][..end - place].to_vec();
                    content[place..end].copy_from_slice(&copy);
                }
                _ => content.insert(place, random.next_u64() as u8),
            }
        }
        match from_bytes(&with_checksum(content)) {
            Ok(shape) => {
                accepted += 1;
                for level in &shape.hierarchy().levels {
                    assert!(
                        swiftprox::shape::levels::containment::contains(&level.polyhedron, shape.polyhedron()).unwrap()
                    );
                }
                assert_eq!(from_bytes(&to_bytes(&shape).unwrap()).unwrap(), shape);
                let labels = &shape.polyhedron().vertex_labels;
                assert_eq!(labels.iter().collect::<BTreeSet<_>>().len(), labels.len(), "vertices of one name");
            }
            Err(Error::File(_)) => refused += 1,
            Err(other) => panic!("{other:?}"),
        }
    }
    // A label may be any number, and a coordinate may change by a little.
    assert!(accepted > 100 && refused > 1000, "{accepted} {refused}");
}

/// One vertex 10⁸ times as far out as the others. Found by fuzzing.
#[test]
fn levels_of_a_body_with_a_far_vertex_come_back() {
    let points = [
        [0.9999999999999993, 7.0, 3.375],
        [3.3749999999999973, -2.25, 0.0],
        [-0.875, -0.8750000000000011, 20.0],
        [-2.0, 30.0, -30.0],
        [0.0, 2.5, -1.375],
        [7.0, -0.125, 26.0],
        [1e-9, 1.375, 8.0],
        [-2.375, 0.0, -32.0],
        [-32.0, -32.00000000000011, 32.00000000000011],
        [3.625, 3.625000000000001, 2.0],
        [1.999999999999998, -6.01220703125, -6.012207031249994],
        [7.0, 7.000000000000007, -17.0],
        [-4.0, -6.01220703125, -6.012207031249994],
        [7.0, 7.000000000000007, -17.0],
        [10.0, -3.25, 16.0],
        [16.0, 0.0, 0.1],
        [858993459.2, 858993459.2000008, -858993459.2000008],
        [-3.25, -9.0, -0.375],
        [2.5, -32.0, -30.0],
        [-30.00000000000002, 0.0, 0.5],
    ];
    let hierarchy = HierarchyOptions {
        kind: HierarchyKind::DobkinKirkpatrick,
        decimation: 0.75,
        minimum_triangles: 7,
        ..HierarchyOptions::default()
    };
    let lookup = LookupOptions { kind: LookupKind::Spherical, resolution: 8, radius_factor: 2.0 };
    let options = ShapeOptions { input: InputPolicy::Hull, hierarchy, lookup, ..ShapeOptions::default() };
    let shape = Shape::from_points(&points.map(Vector::from), &options).unwrap();
    let loaded = from_bytes(&to_bytes(&shape).unwrap()).unwrap();
    assert_eq!(loaded.polyhedron(), shape.polyhedron());
    for (i, (level, again)) in shape.hierarchy().levels.iter().zip(&loaded.hierarchy().levels).enumerate() {
        assert_eq!(level.deviation, again.deviation, "level {i}");
        assert_eq!(level.polyhedron, again.polyhedron, "level {i}");
    }
    assert_eq!(loaded, shape);
}

/// A file of version 2 has no radius, one of version 3 no deviation; what is no length is damage.
#[test]
fn files_of_before_radii_were_are_read() {
    let ends = [Vector::zeros(), Vector::x()];
    let capsule = |swept_radius| {
        let options = ShapeOptions { input: InputPolicy::Hull, swept_radius, ..ShapeOptions::default() };
        Shape::from_points(&ends, &options).unwrap()
    };
    let mut bytes = to_bytes(&capsule(0.375)).unwrap();
    bytes.truncate(bytes.len() - 8);
    let at = bytes.windows(8).position(|part| part == 0.375_f64.to_le_bytes()).unwrap();
    for (version, length, radius) in [(2, 0, 0.0), (3, 8, 0.375)] {
        let mut old = [&bytes[..at + length], &bytes[at + 16..]].concat();
        old[8] = version;
        assert_eq!(from_bytes(&with_checksum(old)).unwrap(), capsule(radius));
    }
    for wrong in [-1.0, f64::NAN, f64::INFINITY] {
        let damaged = [&bytes[..at], &f64::to_le_bytes(wrong), &bytes[at + 8..]].concat();
        let refused = from_bytes(&with_checksum(damaged)).unwrap_err();
        assert!(refused.to_string().contains("swept radius"), "{refused}");
        let damaged = [&bytes[..at + 8], &f64::to_le_bytes(wrong), &bytes[at + 16..]].concat();
        let refused = from_bytes(&with_checksum(damaged)).unwrap_err();
        assert!(refused.to_string().contains("deviation"), "{refused}");
    }
}
