//! The readers of mesh files: any bytes in any format are a mesh or a refusal that names the file, and a mesh that was read is
//! made into a shape or refused. A body that is written in a dialect of a format is read as that body or refused.

use std::fmt::Write;

use swiftprox::base::predicates::ExactPoints;
use swiftprox::body::decomposition::decompose;
use swiftprox::error::Error;
use swiftprox::mesh::PolygonMesh;
use swiftprox::mesh_io::{Format, parse_mesh};
use swiftprox::progress::Progress;
use swiftprox::shape::{InputPolicy, Shape, ShapeOptions};
use testkit::mesh_dialects::MeshFile;

const FORMATS: [Option<Format>; 5] =
    [None, Some(Format::TriPoly), Some(Format::Off), Some(Format::Obj), Some(Format::Stl)];

/// From this on, a first byte says that the others choose a body and a dialect, below it the format of a file that they are.
const FIRST_OF_DIALECTS: u8 = 192;

pub fn run(bytes: &[u8]) {
    let Some((&format, bytes)) = bytes.split_first() else { return };
    if format >= FIRST_OF_DIALECTS {
        return check_dialect(bytes);
    }
    let format = FORMATS[usize::from(format) % FORMATS.len()];
    match parse_mesh(bytes, format, "the file") {
        Ok(mesh) => {
            check_mesh(&mesh);
            check_writing(&mesh);
            check_shape(&mesh);
            check_pieces(&mesh);
        }
        Err(error @ (Error::File(_) | Error::Limit(_))) => assert!(error.message().contains("the file"), "{error}"),
        Err(error) => panic!("another kind of error: {error:?}"),
    }
}

/// Each choice takes a byte, and is 0 behind the last.
fn check_dialect(bytes: &[u8]) {
    let mut bytes = bytes.iter();
    let file = MeshFile::any(&mut |n| bytes.next().map_or(0, |byte| usize::from(*byte) % n));
    match parse_mesh(&file.bytes, Some(file.format), "the file") {
        Ok(mesh) => assert!(file.is_body(&mesh), "another body"),
        Err(Error::File(message)) => assert!(!file.is_plain, "{message}"),
        Err(error) => panic!("another kind of error: {error:?}"),
    }
}

fn check_mesh(mesh: &PolygonMesh) {
    assert!(!mesh.vertices.is_empty());
    assert!(mesh.vertices.iter().flatten().all(|x| x.is_finite()));
    assert!((0..mesh.face_count()).flat_map(|f| mesh.face(f)).all(|&v| (v as usize) < mesh.vertices.len()));
    assert_eq!(mesh.starts.last().map(|&end| end as usize), Some(mesh.indices.len()));
}

/// What is written as OFF, every digit of it, reads as the same.
fn check_writing(mesh: &PolygonMesh) {
    let mut text = format!("OFF\n{} {} 0\n", mesh.vertices.len(), mesh.face_count());
    for v in &mesh.vertices {
        writeln!(text, "{:?} {:?} {:?}", v.x, v.y, v.z).expect("memory");
    }
    for f in 0..mesh.face_count() {
        let face = mesh.face(f);
        write!(text, "{}", face.len()).expect("memory");
        face.iter().for_each(|v| write!(text, " {v}").expect("memory"));
        text.push('\n');
    }
    if (0..mesh.face_count()).any(|f| mesh.face(f).is_empty()) {
        return;
    }
    let again = parse_mesh(text.as_bytes(), Some(Format::Off), "the file").expect("what was written");
    let bits = |mesh: &PolygonMesh| mesh.vertices.iter().flatten().map(|x| x.to_bits()).collect::<Vec<_>>();
    assert_eq!((&again.indices, &again.starts), (&mesh.indices, &mesh.starts));
    assert_eq!(bits(&again), bits(mesh));
}

/// What a policy admits the laxer ones admit, and they make the same of it.
fn check_shape(mesh: &PolygonMesh) {
    let make = |input| Shape::from_mesh(mesh, &ShapeOptions { input, ..ShapeOptions::default() });
    let policies =
        [InputPolicy::Strict, InputPolicy::Flat, InputPolicy::Hull, InputPolicy::NearlyConvex, InputPolicy::Patch];
    let [strict, flat, hull, nearly_convex, patch] = policies.map(make);
    let hull = hull.expect("every mesh has a hull");
    for shape in [&strict, &flat] {
        match shape {
            Ok(shape) => assert!(*shape == hull),
            Err(error) => assert!(matches!(error, Error::Mesh(_)), "{error:?}"),
        }
    }
    assert!(strict.is_err() || flat.is_ok());
    match (&flat, &nearly_convex) {
        (Ok(flat), Ok(nearly_convex)) => assert!(flat == nearly_convex),
        // Labels are those of faces that the hull alone is not given.
        (Err(_), Ok(nearly_convex)) => {
            assert_eq!(nearly_convex.polyhedron().triangles.len(), hull.polyhedron().triangles.len())
        }
        (Ok(_), Err(error)) => panic!("{error}"),
        (Err(_), Err(error)) => assert!(matches!(error, Error::Mesh(_)), "{error:?}"),
    }
    if let Err(error) = patch {
        assert!(matches!(error, Error::Mesh(_)), "{error:?}");
    }
}

/// Any mesh comes to convex pieces, all its triangles once, or is refused.
fn check_pieces(mesh: &PolygonMesh) {
    match decompose(mesh, 0.0, &mut Progress::new(&mut |_| true)) {
        Err(error) => assert!(matches!(error, Error::Mesh(_)), "{error:?}"),
        Ok(pieces) => {
            let exact = ExactPoints::new(&mesh.vertices).expect("memory");
            for piece in (0..pieces.piece_count()).map(|k| pieces.piece(k)) {
                let is_above =
                    |corners: &[u32; 3]| piece.iter().flatten().any(|v| exact.orientation(*corners, *v) > 0.0);
                assert!(!piece.is_empty() && !piece.iter().any(is_above), "{piece:?}");
            }
        }
    }
}
