//! The readers of mesh files: any bytes in any format are a mesh or a refusal that names the file, and a mesh that was read is
//! made into a shape or refused.
#![no_main]

use std::fmt::Write;

use libfuzzer_sys::fuzz_target;
use swiftprox::error::Error;
use swiftprox::mesh::PolygonMesh;
use swiftprox::mesh_io::{Format, parse_mesh};
use swiftprox::shape::{InputPolicy, Shape, ShapeOptions};

const FORMATS: [Option<Format>; 5] =
    [None, Some(Format::TriPoly), Some(Format::Off), Some(Format::Obj), Some(Format::Stl)];

// The first byte is the format.
fuzz_target!(|input: (u8, &[u8])| {
    let (format, bytes) = input;
    let format = FORMATS[usize::from(format) % FORMATS.len()];
    match parse_mesh(bytes, format, "the file") {
        Ok(mesh) => {
            check_mesh(&mesh);
            check_writing(&mesh);
            check_shape(&mesh);
        }
        Err(error @ (Error::File(_) | Error::Limit(_))) => assert!(error.message().contains("the file"), "{error}"),
        Err(error) => panic!("another kind of error: {error:?}"),
    }
});

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
    let [strict, flat, hull] = [InputPolicy::Strict, InputPolicy::Flat, InputPolicy::Hull].map(make);
    let hull = hull.expect("every mesh has a hull");
    for shape in [&strict, &flat] {
        match shape {
            Ok(shape) => assert!(*shape == hull),
            Err(error) => assert!(matches!(error, Error::Mesh(_)), "{error:?}"),
        }
    }
    assert!(strict.is_err() || flat.is_ok());
}
