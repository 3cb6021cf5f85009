//! The mesh readers on files as the world has them: every liberty of the formats, truncated files, garbage.

use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};

use swiftprox::error::Error;
use swiftprox::math::Vector;
use swiftprox::mesh::PolygonMesh;
use swiftprox::mesh_io::{Format, parse_mesh, read_mesh, register_mesh_reader, unregister_mesh_reader};
use swiftprox::shape::{InputPolicy, Shape, ShapeOptions};
use testkit::random::Random;

const FIXTURES: [&str; 10] = [
    "cube.off",
    "cube_one_line.off",
    "cube_colours.off",
    "cube_silent_colours.off",
    "cube_glued.off",
    "cube.poly",
    "cube.obj",
    "cube_cr.obj",
    "cube.stl",
    "tetrahedron.tri",
];

fn fixture(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/fixtures/meshes").join(name)
}

fn bytes_of(name: &str) -> Vec<u8> {
    std::fs::read(fixture(name)).unwrap()
}

/// The cube of the fixtures.
fn cube() -> PolygonMesh {
    let corner = |x: i8, y: i8, z: i8| Vector::new(x.into(), y.into(), z.into());
    let vertices = vec![
        corner(-1, -1, -1),
        corner(1, -1, -1),
        corner(1, 1, -1),
        corner(-1, 1, -1),
        corner(-1, -1, 1),
        corner(1, -1, 1),
        corner(1, 1, 1),
        corner(-1, 1, 1),
    ];
    #[rustfmt::skip]
    let indices = vec![0, 3, 2, 1, 4, 5, 6, 7, 0, 1, 5, 4, 1, 2, 6, 5, 2, 3, 7, 6, 3, 0, 4, 7];
    PolygonMesh::new(vertices, indices, Some(&[4; 6])).unwrap()
}

/// The corners of all triangles, each quadrilateral cut along its first diagonal.
fn triangle_corners(mesh: &PolygonMesh) -> Vec<[Vector; 3]> {
    let mut corners = Vec::new();
    for f in 0..mesh.face_count() {
        let face = mesh.face(f);
        for k in 1..face.len() - 1 {
            corners.push([face[0], face[k], face[k + 1]].map(|v| mesh.vertices[v as usize]));
        }
    }
    corners
}

/// A binary STL file of a mesh.
fn binary_stl(mesh: &PolygonMesh, header: &str) -> Vec<u8> {
    let triangles = triangle_corners(mesh);
    let mut bytes = header.as_bytes().to_vec();
    bytes.resize(80, b' ');
    bytes.extend((triangles.len() as u32).to_le_bytes());
    for corners in triangles {
        bytes.extend([0xff; 12]); // the normal: not numbers
        for x in corners.iter().flat_map(|c| c.iter()) {
            bytes.extend((*x as f32).to_le_bytes());
        }
        bytes.extend([0; 2]);
    }
    bytes
}

fn refusal(text: &str, format: Format) -> String {
    match parse_mesh(text.as_bytes(), Some(format), "m") {
        Err(Error::File(message)) => message,
        other => panic!("{text:?} gave {other:?}"),
    }
}

#[test]
fn every_liberty_of_the_formats_gives_the_same_cube() {
    for name in FIXTURES.into_iter().filter(|name| name.starts_with("cube") && *name != "cube.stl") {
        assert_eq!(read_mesh(&fixture(name)), Ok(cube()), "{name}");
    }
    // By its extension alone: by content it could be anything.
    assert_eq!(read_mesh(&fixture("cube_no_word.off")), Ok(cube()));
    assert!(parse_mesh(&bytes_of("cube_no_word.off"), None, "m").is_err());
}

/// The words that Geomview's grammar has, and those that files have: MeshLab begins with the normals, others write lower case.
#[test]
fn off_words_say_what_vertices_have() {
    let cube_of = |word: &str, behind: &str| {
        let lines =
            |line: &str| if line.split(' ').count() == 3 { format!("{line}{behind}\n") } else { format!("{line}\n") };
        let text = String::from_utf8(bytes_of("cube_no_word.off")).unwrap().replace("8 6\n0\n", "");
        parse_mesh(
            format!("{word}8 6 0\n{}", text.lines().map(lines).collect::<String>()).as_bytes(),
            Some(Format::Off),
            "m",
        )
    };
    for word in [
        "OFF", "off", "COFF", "NOFF", "CNOFF", "STOFF", "STCOFF", "STNOFF", "STCNOFF", "NCOFF", "coff", "noff",
        "stcnoff",
    ] {
        for behind in ["", " 1 0 0", " 1 0 0 1", " 0.5 0.5 0.5 1", " 0 0 1 255 255 255 255 0.5 0.25"] {
            for gap in ["", " ", "\n", "\n\n# counts\n"] {
                assert_eq!(cube_of(&format!("{word}{gap}"), behind), Ok(cube()), "{word}{gap:?}{behind}");
            }
        }
    }
    for word in ["4OFF", "ST4OFF", "nOFF", "C4nOFF", "CCOFF", "STSTOFF", "XOFF", "OFFX", "OFFER "] {
        let message = cube_of(&format!("{word}\n"), "").unwrap_err().to_string();
        assert!(message.starts_with(&format!("m: line 1: \"{}\" ", word.trim())), "{message}");
    }
    // Lower case may say n dimensions as well: such a file has their number first.
    let message = refusal("noff\n3\n4 1 0\n0 0 0\n1 0 0\n0 1 0\n1 1 0\n3 0 1 2\n", Format::Off);
    assert_eq!(message, "m: line 3: \"0\" behind the counts: vertices begin on the next line");
}

/// Plain OFF with numbers behind the vertices was read number by number, so that colours were vertices and faces of another body.
/// Of the cube [3, 4] x [4, 5] x [4, 5] with red vertices (1 0 0 1) came one of [0, 5] in all directions, without a word.
#[test]
fn numbers_behind_vertices_are_never_another_body() {
    let corners = "3 4 4|3 4 5|3 5 4|3 5 5|4 4 4|4 4 5|4 5 4|4 5 5";
    let faces = "4 0 1 3 2\n4 4 6 7 5\n4 0 4 5 1\n4 2 3 7 6\n4 0 2 6 4\n4 1 5 7 3\n";
    let off = |behind: &str| format!("OFF\n8 6 0\n{}{behind}\n{faces}", corners.replace('|', &format!("{behind}\n")));
    let plain = parse_mesh(off("").as_bytes(), None, "m").unwrap();
    assert_eq!((plain.vertices.len(), plain.vertices[0]), (8, Vector::new(3.0, 4.0, 4.0)));
    for behind in [" 1 0 0 1", " 1 1 1", " 255 0 0 255", " .5 .5 .5 1", " 0", " 0 0 1 1 0"] {
        assert_eq!(parse_mesh(off(behind).as_bytes(), None, "m"), Ok(plain.clone()), "{behind}");
    }
}

/// Both readings fit, so it is refused; each cure that the message tells makes one of them certain.
#[test]
fn two_bodies_in_one_file_are_refused_with_a_cure() {
    let faces = "9 0 1\n2 4 5\n6 7 8\n3 0 1 2\n3 2 1 0\n";
    let text = format!("OFF\n9 2 0\n0 0 0 1 0 0\n0 1 0 0 0 1\n1 1 0 1 0 1\n0 1 1\n1 1 1\n2 2 2\n{faces}");
    let message = refusal(&text, Format::Off);
    assert!(message.starts_with("m: line 2: behind these counts there are two bodies"), "{message}");
    assert!(
        message.contains("begin the file with COFF, else give each vertex a line with nothing but its coordinates")
    );
    let read = |text: String| parse_mesh(text.as_bytes(), None, "m").unwrap();
    // By lines, with colours at the first three vertices or without.
    let coloured = read(format!("C{text}"));
    assert_eq!((coloured.vertices[1], coloured.face(0)), (Vector::y(), &[0, 1, 2][..]));
    assert_eq!(read(text.replace(" 1 0 0\n", "\n").replace(" 0 0 1\n", "\n").replace(" 1 0 1\n", "\n")), coloured);
    // In free form, each vertex on its line.
    let free =
        read(text.replace(" 1 0 0\n", "\n1 0 0\n").replace(" 0 0 1\n", "\n0 0 1\n").replace(" 1 0 1\n", "\n1 0 1\n"));
    assert_eq!((free.vertices[1], free.face(0)), (Vector::x(), &[0, 1, 2, 4, 5, 6, 7, 8, 3][..]));
}

/// Nobody writes colours into free form, but what would come of it must not be another body.
#[test]
fn free_form_that_fits_with_colours_as_well_is_refused_with_a_cure() {
    let read = |text: &str| parse_mesh(text.as_bytes(), None, "m");
    let message = refusal("OFF 4 2 0\n0 0 0 1 0 0 0 1 0 0 0 1 3 0 1 2 3 0 1 2\n3 2 1 0\n", Format::Off);
    assert_eq!(
        message,
        "m: line 1: behind these counts there are two bodies, one with 3 numbers at each vertex and one with 4; give each vertex \
         and each face a line of its own"
    );
    let plain = read("OFF 4 2 0\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 1 2\n3 2 1 0\n").unwrap();
    assert_eq!(plain.vertices[3], Vector::z());
    let coloured = read("OFF 4 2 0\n0 0 0 1\n0 0 0 1\n0 0 0 1\n3 0 1 2\n3 0 1 2\n3 2 1 0\n").unwrap();
    assert_eq!(coloured.vertices[3], Vector::new(3.0, 0.0, 1.0));
}

/// What says that the counts are wrong, or that a body is not all there.
#[test]
fn off_files_that_do_not_fit_are_refused() {
    let cube = |change: &[(&str, &str)]| {
        let text = String::from_utf8(bytes_of("cube_silent_colours.off")).unwrap();
        change.iter().fold(text, |text, (from, to)| text.replacen(from, to, 1))
    };
    let bare = |text: String| text.replace(" 1 0 0 1\n", "\n");
    let cases = [
        (bare(cube(&[("8 6 0", "7 6 0")])), "m: line 10: face 0 of 6: \"-1\" is not a whole number"),
        (
            cube(&[("8 6 0", "8 5 0")]),
            "m: line 16: \"4\" behind the last face: the file says that it has 8 vertices and 5 faces",
        ),
        (cube(&[("8 6 0", "8 7 0")]), "m: line 17: face 6 of 7: the file ends here"),
        (cube(&[("4 1 2 6 5", "4 1 2 6")]), "m: line 14: face 3 of 6: 3 of 4 corners on its line"),
        (cube(&[("1 1 -1 1 0 0 1", "1 1")]), "m: line 5: vertex 2 of 8: 2 of 3 coordinates on its line"),
        (cube(&[("1 1 -1", "1 one -1")]), "m: line 5: vertex 2 of 8: \"one\" is not a number"),
        (
            "OFF 3 1 0 0 0 0 1 0 0 0 1 0 2 0 1".into(),
            "m: line 1: face 0 of 1: it has not three different corners or more; \
          if it is one, give each vertex and each face a line of its own",
        ),
    ];
    for (text, expected) in cases {
        assert_eq!(refusal(&text, Format::Off), expected);
    }
    // The advice, followed.
    assert!(parse_mesh(b"OFF 3 1 0\n0 0 0\n1 0 0\n0 1 0\n2 0 1", None, "m").is_ok());
    // Words are no part of a body.
    assert!(parse_mesh(cube(&[]).as_bytes(), None, "m") == parse_mesh((cube(&[]) + "}\n\x1a").as_bytes(), None, "m"));
}

#[test]
fn tri() {
    let mesh = read_mesh(&fixture("tetrahedron.tri")).unwrap();
    assert_eq!(mesh.vertices[3], Vector::z());
    assert_eq!((mesh.face_count(), mesh.face(2)), (4, &[0, 3, 2][..]));
    assert!(!mesh.single_precision);
}

#[test]
fn stl_welds_equal_vertices_in_order_and_drops_triangles_without_area() {
    let expected = triangle_corners(&cube());
    let ascii = read_mesh(&fixture("cube.stl")).unwrap();
    // A header that starts like ASCII STL, as some programs write it.
    let binary = parse_mesh(&binary_stl(&cube(), "solid cube"), None, "m").unwrap();
    assert_eq!(ascii, binary);
    assert!(ascii.single_precision);
    assert_eq!(ascii.vertices.len(), 8);
    assert_eq!(&ascii.indices[..6], [0, 1, 2, 0, 2, 3]);
    assert_eq!(triangle_corners(&ascii), expected);
}

#[test]
fn stl_welds_zeros_of_either_sign() {
    let mut mesh = cube();
    for v in &mut mesh.vertices {
        v.x = 0.0_f64.copysign(v.x);
    }
    let welded = parse_mesh(&binary_stl(&mesh, ""), None, "m").unwrap();
    // The square x = 0 twice, a quadrilateral for each side; the other four sides have no area.
    assert_eq!((welded.vertices.len(), welded.face_count()), (4, 4));
}

/// HalfDonut.stl of numpy-stl has a byte behind its triangles. Others are filled up to whole blocks, or have data of their own
/// there; some programs leave the count at 0. All that was refused.
#[test]
fn binary_stl_files_of_another_length() {
    let stl = binary_stl(&cube(), "");
    let read = |bytes: &[u8]| parse_mesh(bytes, Some(Format::Stl), "m");
    let expected = read(&stl);
    assert_eq!(expected.as_ref().map(|mesh| mesh.face_count()), Ok(12));
    let with = |behind: &[u8]| read(&[&stl, behind].concat());
    for behind in [&b"\n"[..], b"\r\n", &[7; 49], &[0; 340], &[0; 50], &[0; 5000], &[0xff; 149]] {
        assert_eq!(with(behind), expected, "{} bytes", behind.len());
    }
    let counted = |count: u32| [&stl[..80], &count.to_le_bytes(), &stl[84..]].concat();
    assert_eq!(read(&counted(0)), expected);
    // A count that is less than what is there, as far as the length tells.
    let message = read(&counted(10)).unwrap_err().to_string();
    assert_eq!(
        message,
        "m: the triangle count is 10, and behind these is as much as 2 more would take; if they are triangles, make the count 12, \
         else cut the file off behind 584 bytes"
    );
    assert_eq!(read(&counted(12)), expected);
    assert_eq!(read(&counted(10)[..584]).map(|mesh| mesh.face_count()), Ok(10));
    let message = read(&[&counted(0)[..], b"\n"].concat()).unwrap_err().to_string();
    assert_eq!(message, "m: the triangle count is 0, and what follows is no whole number of triangles of 50 bytes");
    assert!(read(&[0; 84]).is_err() && read(&[0; 984]).is_err());
}

/// A place of zeros that no triangle was written to made a vertex at the origin, and hulls reached to it.
#[test]
fn stl_triangles_of_one_point_leave_no_vertex() {
    let mut mesh = cube();
    mesh.vertices.iter_mut().for_each(|v| v.x += 7.0);
    let mut stl = binary_stl(&mesh, "");
    let expected = parse_mesh(&stl, None, "m").unwrap();
    stl.splice(84..84, [0; 50]);
    stl[80..84].copy_from_slice(&13_u32.to_le_bytes());
    assert_eq!(parse_mesh(&stl, None, "m"), Ok(expected));
}

#[test]
fn stl_words_in_two_and_old_line_ends() {
    let text = String::from_utf8(bytes_of("cube.stl")).unwrap();
    let expected = read_mesh(&fixture("cube.stl"));
    for (from, to) in
        [("endloop", "end loop"), ("endfacet", "End Facet"), ("endsolid", "end solid"), ("ENDSOLID", "END SOLID")]
    {
        assert!(text.contains(from) || from == "ENDSOLID", "{from}");
        assert_eq!(parse_mesh(text.replace(from, to).as_bytes(), None, "m"), expected, "{to}");
    }
    let message = refusal("solid\nend\nloop", Format::Stl);
    assert_eq!(message, "m: line 3: \"loop\" where \"solid\" should be");
}

/// Old Mac systems ended lines with a carriage return: all such a file was one line.
#[test]
fn all_text_may_have_any_line_ends() {
    for name in FIXTURES {
        let text = String::from_utf8(bytes_of(name)).unwrap().replace("\r\n", "\n").replace('\r', "\n");
        for ends in ["\n", "\r\n", "\r"] {
            let read = parse_mesh(text.replace('\n', ends).as_bytes(), None, name);
            assert_eq!(read, read_mesh(&fixture(name)), "{name} {ends:?}");
        }
    }
    let lines = refusal("v 0 0 0\rv 1 0 0\r\r\nv 0 1\r", Format::Obj);
    assert_eq!(lines, "m: line 4: vertex 2 has 2 numbers; 3 are needed");
}

#[test]
fn format_by_content() {
    for name in FIXTURES {
        let bytes = bytes_of(name);
        let by_content = parse_mesh(&bytes, None, name).unwrap();
        assert_eq!(Ok(by_content), read_mesh(&fixture(name)), "{name}");
    }
    let unknown = parse_mesh(b"ply\nformat ascii 1.0\n", None, "m").unwrap_err();
    assert_eq!(unknown.message(), "m: not a TRI, POLY, OFF, OBJ or STL file, by its first bytes");
    assert!(parse_mesh(b"", None, "m").is_err());
}

#[test]
fn format_by_extension() {
    for (name, format) in [
        ("a.TRI", Some(Format::TriPoly)),
        ("a.b.poly", Some(Format::TriPoly)),
        ("a.Off", Some(Format::Off)),
        ("a.obj", Some(Format::Obj)),
        ("a.stl", Some(Format::Stl)),
        ("off", None),
        ("a.ply", None),
    ] {
        assert_eq!(Format::from_extension(Path::new(name)), format, "{name}");
    }
}

#[test]
fn a_missing_file_is_named() {
    let message = read_mesh(Path::new("no/such.off")).unwrap_err().to_string();
    assert!(message.starts_with("no/such.off: cannot be read: "), "{message}");
}

/// Some programs write edges and crumpled faces among the faces: whoever takes the hull does not mind.
#[test]
fn degenerate_faces_are_read_as_they_are() {
    let tetrahedron = "0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 2 1\n3 0 1 3\n3 0 3 2\n3 1 2 3\n";
    let text = format!("OFF\n4 7 0\n{tetrahedron}2 0 1\n3 2 2 1\n0\n");
    let mesh = parse_mesh(text.as_bytes(), None, "m").unwrap();
    assert_eq!((mesh.face(4), mesh.face(5), mesh.face(6)), (&[0, 1][..], &[2, 2, 1][..], &[][..]));
    let mut options = ShapeOptions::default();
    let refusal = Shape::from_mesh(&mesh, &options).unwrap_err();
    assert!(refusal.message().starts_with("face 4 is degenerate"), "{refusal}");
    options.input = InputPolicy::Hull;
    assert_eq!(Shape::from_mesh(&mesh, &options).unwrap().polyhedron().faces.len(), 4);
}

#[test]
fn refusals_name_the_line() {
    use Format::{Obj, Off, Stl, TriPoly};
    let cases = [
        (TriPoly, "TRIANGLE 1", "m: line 1: \"TRIANGLE\" where TRI or POLY should be"),
        (TriPoly, "", "m: line 1: TRI or POLY: the file ends here"),
        (TriPoly, "TRI\n1 1\n0 0 x", "m: line 3: vertex 0 of 1: \"x\" is not a number"),
        (TriPoly, "TRI\n1 1\n0 0 1e400", "m: line 3: vertex 0: z is not finite (inf)"),
        (TriPoly, "TRI\n-1 1", "m: line 2: the number of vertices: \"-1\" is not a whole number"),
        (
            TriPoly,
            "POLY 3 1\n0 0 0\n1 0 0\n0 1 0\n3 0 1 3",
            "m: line 5: face 0, corner 2: vertex index 3 is out of range (3 vertices)",
        ),
        (
            Off,
            "4OFF\n",
            "m: line 1: \"4OFF\" is not supported: vertices must have three coordinates; divide them by the fourth and write OFF",
        ),
        (
            Off,
            "nOFF\n",
            "m: line 1: \"nOFF\" is not supported: vertices must have three coordinates; write OFF if they have, NOFF if normals \
             follow",
        ),
        (Off, "OFF BINARY\n", "m: line 1: binary OFF is not supported: save the file as text"),
        (Off, "COFF\nBinary\n", "m: line 1: binary OFF is not supported: save the file as text"),
        (Off, "ply\n", "m: line 1: \"ply\" where OFF should be"),
        (Off, "8 6 0\n", "m: line 2: vertex 0 of 8: the file ends here"),
        (Off, "OFF\n# none\n\n", "m: line 4: the number of vertices: the file ends here"),
        (Off, "OFF 0 0 0\n", "m: there are no vertices in it"),
        (Obj, "v 0 0\n", "m: line 1: vertex 0 has 2 numbers; 3 are needed"),
        (Obj, "v 0 0 0\rv 1 0\r", "m: line 2: vertex 1 has 2 numbers; 3 are needed"),
        (Obj, "v 0 0 0\nf 1 1/ 0\n", "m: line 2: vertex 0: OBJ counts from 1"),
        (Obj, "v 0 0 0\nf 1 a 1\n", "m: line 2: \"a\" is not a vertex number"),
        (Obj, "v 0 0 0\n\nf 1 2 3\n", "m: line 3: vertex 2 does not exist; the file has 1"),
        (Obj, "v 0 0 0\nf 1 1 -2\n", "m: line 2: vertex \"-2\" does not exist; 1 so far"),
        (Obj, "v 0 0 0\nf 1 1 99999999999\n", "m: line 2: vertex \"99999999999\" does not exist; 1 so far"),
        (Obj, "\n# a letter\nDear reader,\nv is a letter\n", "m: line 4: vertex 0: \"is\" is not a number"),
        (
            Obj,
            "o letter\nDear reader,\nthere is no body here\n",
            "m: line 2: \"Dear\": no line of an OBJ file begins so, and none of this file gives a vertex; is it an OBJ file?",
        ),
        (
            Obj,
            "garbage\n\0\0\n",
            "m: line 2: a zero byte in a word: this is UTF-16 or no text at all; save it as UTF-8 or ASCII",
        ),
        (
            Obj,
            "v\0 \0\x30\0\n\0",
            "m: line 1: a zero byte in a word: this is UTF-16 or no text at all; save it as UTF-8 or ASCII",
        ),
        (Obj, "g nothing\nusemtl none\n", "m: there are no vertices in it"),
        (Stl, "solid a\nfacet normal 0 0 1\nouter lop", "m: line 3: \"lop\" where \"loop\" should be"),
        (Stl, "solid a\n", "m: line 2: triangle 0 or \"endsolid\": the file ends here"),
        (Stl, "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0\n", "m: line 5: triangle 0: the file ends here"),
        (Stl, "solid a\nendsolid a\n", "m: there are no vertices in it"),
        (Stl, "OFF", "m: neither ASCII STL (which starts with \"solid\") nor binary: 3 bytes are too few"),
    ];
    for (format, text, expected) in cases {
        assert_eq!(refusal(text, format), expected);
    }
    let long = "x".repeat(1000);
    assert!(refusal(&format!("TRI {long}"), TriPoly).len() < 100);
}

/// As editors of Windows save text.
#[test]
fn text_of_sixteen_bits_is_told_so() {
    let text = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n";
    let expected = "m: line 1: the file begins as UTF-16 text does; save it as UTF-8 or ASCII";
    for encode in [u16::to_le_bytes as fn(u16) -> [u8; 2], u16::to_be_bytes] {
        let bytes: Vec<u8> = std::iter::once(0xfeff).chain(text.encode_utf16()).flat_map(encode).collect();
        for format in [None, Some(Format::Obj), Some(Format::Off), Some(Format::TriPoly), Some(Format::Stl)] {
            assert_eq!(parse_mesh(&bytes, format, "m").unwrap_err().to_string(), expected, "{format:?}");
        }
        let message = parse_mesh(&bytes[2..], Some(Format::Obj), "m").unwrap_err().to_string();
        assert!(message.starts_with("m: line 1: a zero byte in a word: this is UTF-16"), "{message}");
    }
    assert!(parse_mesh(text.as_bytes(), None, "m").is_ok());
}

/// Nothing may be allocated from a count that the file only claims: these would be 100 GB and more.
#[test]
fn absurd_counts_are_refused() {
    let cases = [
        (Format::Off, "OFF\n4000000000 1 0\n0 0 0\n", "vertex 1 of 4000000000: the file ends here"),
        (Format::Off, "OFF\n1 4000000000 0\n0 0 0\n", "face 0 of 4000000000: the file ends here"),
        (Format::Off, "OFF\n1 1 0\n0 0 0\n4294967295 0 0\n", "face 0 of 1: 2 of 4294967295 corners on its line"),
        (Format::Off, "OFF 1 1 0 0 0 0 4294967295 0 0\n", "face 0 of 1: the file ends here"),
        (Format::Off, "OFF\n4294967296 1 0\n", "the number of vertices: \"4294967296\" does not fit 32 bits"),
        (Format::TriPoly, "TRI 4000000000 4000000000 0 0 0", "vertex 1 of 4000000000: the file ends here"),
        (
            Format::TriPoly,
            "TRI 99999999999999999999999999 1",
            "the number of vertices: \"999999999999999999999999…\" does not fit 32 bits",
        ),
    ];
    for (format, text, expected) in cases {
        let message = refusal(text, format);
        assert!(message.ends_with(expected), "{message}");
    }
    let mut stl = binary_stl(&cube(), "");
    stl[80..84].copy_from_slice(&u32::MAX.to_le_bytes());
    let message = parse_mesh(&stl, Some(Format::Stl), "m").unwrap_err().to_string();
    assert!(message.ends_with("asks for 214748364834 bytes, the file has 684"), "{message}");
}

#[test]
fn a_binary_stl_file_names_the_triangle() {
    let mut stl = binary_stl(&cube(), "");
    stl[84 + 50 * 7 + 16..84 + 50 * 7 + 20].copy_from_slice(&f32::INFINITY.to_le_bytes());
    let message = parse_mesh(&stl, None, "m").unwrap_err().to_string();
    assert_eq!(message, "m: triangle 7: vertex 8: y is not finite (inf)");
}

/// Every prefix that misses the last face or more is refused. OBJ has no end mark and no counts: there, nothing tells.
#[test]
fn truncated_files_are_refused() {
    for name in FIXTURES.into_iter().filter(|name| !name.ends_with(".obj")) {
        let bytes = bytes_of(name);
        let last: &[u8] = match name {
            // The end of the first solid: nothing tells that another one should follow.
            "cube.stl" => b"endsolid",
            "tetrahedron.tri" => b"1 2 3\r\n",
            _ => b"4 3 0 4 7",
        };
        let end = bytes.windows(last.len()).rposition(|window| window == last).unwrap();
        let format = Format::from_extension(Path::new(name));
        for length in 0..end {
            assert!(parse_mesh(&bytes[..length], format, name).is_err(), "{name}: {length} bytes");
        }
    }
    let stl = binary_stl(&cube(), "solid");
    for length in 0..stl.len() {
        assert!(parse_mesh(&stl[..length], Some(Format::Stl), "m").is_err(), "{length} bytes");
    }
}

/// One random damage: a byte changed, a piece removed, repeated or overwritten with something that parsers dislike.
fn damage(bytes: &mut Vec<u8>, random: &mut Random) {
    const WORDS: [&[u8]; 12] =
        [b"-1", b"0", b"4294967295", b"1e999", b"nan", b"\0", b"\\\n", b"#", b"\n", b"/", b"\xff\xfe", b" "];
    let at = random.below(bytes.len() + 1);
    let end = (at + random.below(20)).min(bytes.len());
    match random.below(5) {
        0 if at < bytes.len() => bytes[at] = random.next_u64() as u8,
        1 => drop(bytes.drain(at..end)),
        2 => {
            let piece = bytes[at..end].to_vec();
            bytes.splice(at..at, piece);
        }
        3 => bytes.truncate(at),
        _ => drop(bytes.splice(at..end, WORDS[random.below(WORDS.len())].iter().copied())),
    }
}

/// Whatever the bytes, a reader returns a mesh that is safe to index, or an error that names the file.
#[test]
fn damaged_files_never_panic() {
    let mut random = Random::new(1);
    let mut files: Vec<Vec<u8>> = FIXTURES.iter().map(|name| bytes_of(name)).collect();
    files.push(binary_stl(&cube(), "solid"));
    let formats = [None, Some(Format::TriPoly), Some(Format::Off), Some(Format::Obj), Some(Format::Stl)];
    let (mut read, mut refused) = (0, 0);
    for round in 0..40_000 {
        let mut bytes = files[round % files.len()].clone();
        for _ in 0..=random.below(3) {
            damage(&mut bytes, &mut random);
        }
        for format in formats {
            match parse_mesh(&bytes, format, "the file") {
                Ok(mesh) => {
                    read += 1;
                    let given = PolygonMesh {
                        single_precision: mesh.single_precision,
                        ..PolygonMesh::new(
                            mesh.vertices.clone(),
                            mesh.indices.clone(),
                            Some(&(0..mesh.face_count()).map(|f| mesh.face(f).len() as u32).collect::<Vec<_>>()),
                        )
                        .unwrap()
                    };
                    assert_eq!(mesh, given);
                }
                Err(e) => {
                    refused += 1;
                    assert!(matches!(e, Error::File(_)), "{e:?}");
                    assert!(e.message().starts_with("the file: "), "{e}");
                }
            }
        }
    }
    // The damage is neither always fatal nor always harmless.
    assert!(read > 5_000 && refused > 5_000, "{read} read, {refused} refused");
}

// --- Registered readers. The registry is the process's own: each test has magics of its own. ---------------------------------

/// A file of that name and content in the folder for tests.
fn written(name: &str, content: &[u8]) -> PathBuf {
    let path = Path::new(env!("CARGO_TARGET_TMPDIR")).join(name);
    std::fs::write(&path, content).unwrap();
    path
}

/// A tetrahedron of edge length `size`.
fn tetrahedron(size: f64) -> PolygonMesh {
    let corners = [Vector::zeros(), size * Vector::x(), size * Vector::y(), size * Vector::z()];
    PolygonMesh::new(corners.to_vec(), vec![0, 2, 1, 0, 1, 3, 1, 2, 3, 0, 3, 2], None).unwrap()
}

/// How large the tetrahedron in a file is, or the message.
fn size(read: swiftprox::error::Result<PolygonMesh>) -> Result<f64, String> {
    read.map(|mesh| mesh.vertices[1].x).map_err(|error| {
        assert!(matches!(error, Error::File(_)), "{error:?}");
        error.message().to_string()
    })
}

#[test]
fn a_registered_reader_goes_before_extension_and_content() {
    const OFF: &[u8] = b"OFFSET\n4 4 6";
    let path = written("registered.off", OFF);
    let marked = written("marked.stl", &[b"\xef\xbb\xbf \t\r\n\x0b", OFF].concat());
    let before = size(read_mesh(&path)).unwrap_err();
    assert!(before.ends_with("line 1: \"OFFSET\" where OFF should be"), "{before}");

    register_mesh_reader(
        b"OFFSET",
        Arc::new(|bytes| {
            // The whole file but the byte order mark.
            assert!(bytes == OFF || bytes == [b" \t\r\n\x0b", OFF].concat(), "{bytes:?}");
            Ok(tetrahedron(2.0))
        }),
    )
    .unwrap();
    assert_eq!(size(read_mesh(&path)), Ok(2.0));
    assert_eq!(size(read_mesh(&marked)), Ok(2.0));
    assert_eq!(size(parse_mesh(OFF, None, "m")), Ok(2.0));
    // Whoever says which format it is gets that.
    assert!(parse_mesh(OFF, Some(Format::Off), "m").is_err());
    // Other files are read as ever, though this one begins with a part of the magic.
    assert_eq!(read_mesh(&fixture("cube.off")), Ok(cube()));
    assert_eq!(Shape::from_file(&path, &ShapeOptions::default()).unwrap().polyhedron().vertices.len(), 4);

    register_mesh_reader(b"OFFSET", Arc::new(|_| Ok(tetrahedron(3.0)))).unwrap();
    assert_eq!(size(read_mesh(&path)), Ok(3.0));
    assert!(unregister_mesh_reader(b"OFFSET") && !unregister_mesh_reader(b"OFFSET"));
    assert_eq!(size(read_mesh(&path)), Err(before));
}

#[test]
fn what_a_registered_reader_refuses_names_file_and_reader() {
    let path = written("refused.mesh", b"Refusal 1");
    let name = path.display();
    for error in [Error::Mesh("not today".into()), Error::File("not today".into()), Error::Limit("not today".into())] {
        register_mesh_reader(b"Refusal", Arc::new(move |_| Err(error.clone()))).unwrap();
        let expected = format!("{name}: the reader registered for \"Refusal\": not today");
        assert_eq!(size(read_mesh(&path)), Err(expected));
    }
    register_mesh_reader(b"Refusal", Arc::new(|_| Ok(PolygonMesh::default()))).unwrap();
    assert_eq!(size(read_mesh(&path)), Err(format!("{name}: there are no vertices in it")));
    unregister_mesh_reader(b"Refusal");
}

#[test]
fn magics_that_no_file_or_two_readers_could_claim_are_refused() {
    let register = |magic: &[u8]| {
        register_mesh_reader(magic, Arc::new(|_| Ok(tetrahedron(1.0)))).map_err(|error| {
            assert!(matches!(error, Error::Argument(_)), "{error:?}");
            error.message().to_string()
        })
    };
    assert_eq!(register(b""), Err("the magic of a mesh reader is empty".into()));
    for magic in [&b" Claim"[..], b"\nClaim", b"\xef\xbb\xbfClaim"] {
        assert!(register(magic).unwrap_err().contains("begins with white space or a byte order mark"));
    }
    assert_eq!(register(b"Claim"), Ok(()));
    for magic in [&b"Claim2"[..], b"Cla"] {
        let message = register(magic).unwrap_err();
        assert!(message.ends_with("would have two mesh readers: there is one for \"Claim\""), "{message}");
    }
    // What was refused is not there, what was there is.
    assert!(size(parse_mesh(b"Cla 1", None, "m")).is_err());
    assert_eq!(size(parse_mesh(b"Claim2", None, "m")), Ok(1.0));
    assert_eq!(register(b"Claw"), Ok(()));
    assert!(unregister_mesh_reader(b"Claim") && unregister_mesh_reader(b"Claw"));
    assert_eq!(register(b"Cla"), Ok(()));
    assert!(unregister_mesh_reader(b"Cla"));
    // Bytes that are no text.
    assert_eq!(register(b"\x89\xff\0"), Ok(()));
    assert_eq!(size(parse_mesh(b"\x89\xff\0\x01", None, "m")), Ok(1.0));
    assert!(unregister_mesh_reader(b"\x89\xff\0"));
}

/// No lock is held while a reader runs or while what it holds is dropped: else this would never end.
#[test]
fn a_reader_may_read_register_and_be_dropped_anywhere() {
    struct RegistersWhenDropped;
    impl Drop for RegistersWhenDropped {
        fn drop(&mut self) {
            register_mesh_reader(b"Heir", Arc::new(|_| Ok(tetrahedron(7.0)))).unwrap();
        }
    }
    let inner = written("inner.mesh", b"Inner");
    register_mesh_reader(b"Inner", Arc::new(|_| Ok(tetrahedron(5.0)))).unwrap();
    let last = RegistersWhenDropped;
    register_mesh_reader(
        b"Outer",
        Arc::new(move |_| {
            let _ = &last;
            let mesh = read_mesh(&inner)?;
            register_mesh_reader(b"Outer", Arc::new(|_| Ok(tetrahedron(6.0))))?;
            unregister_mesh_reader(b"Inner");
            Ok(mesh)
        }),
    )
    .unwrap();
    assert!(parse_mesh(b"Heir", None, "m").is_err());
    assert_eq!(size(parse_mesh(b"Outer", None, "m")), Ok(5.0));
    assert_eq!(size(parse_mesh(b"Outer", None, "m")), Ok(6.0));
    assert!(parse_mesh(b"Inner", None, "m").is_err());
    assert_eq!(size(parse_mesh(b"Heir", None, "m")), Ok(7.0));
    assert!(unregister_mesh_reader(b"Outer") && unregister_mesh_reader(b"Heir"));
}

#[test]
fn readers_may_be_replaced_while_others_read() {
    let read = AtomicUsize::new(0);
    std::thread::scope(|threads| {
        for _ in 0..3 {
            threads.spawn(|| {
                for _ in 0..2000 {
                    match size(parse_mesh(b"Turns", None, "m")) {
                        Ok(size) => assert!((1.0..=3.0).contains(&size)),
                        Err(message) => assert!(message.contains("not a TRI"), "{message}"),
                    }
                    read.fetch_add(1, Ordering::Relaxed);
                }
            });
        }
        threads.spawn(|| {
            let mut turn = 0;
            while read.load(Ordering::Relaxed) < 6000 {
                turn += 1;
                let size = f64::from(turn % 3 + 1);
                register_mesh_reader(b"Turns", Arc::new(move |_| Ok(tetrahedron(size)))).unwrap();
                if turn % 5 == 0 {
                    assert!(unregister_mesh_reader(b"Turns"));
                }
            }
            unregister_mesh_reader(b"Turns");
        });
    });
}

/// What is no regular file is refused at once: a pipe is not waited for, a device without end not read.
#[cfg(unix)]
#[test]
fn only_regular_files_are_read() {
    let folder = std::env::temp_dir().join(format!("swiftprox-files-{}", std::process::id()));
    std::fs::create_dir_all(&folder).unwrap();
    let pipe = folder.join("pipe.off");
    assert!(std::process::Command::new("mkfifo").arg(&pipe).status().unwrap().success());
    let sparse = folder.join("sparse.obj");
    std::fs::File::create(&sparse).unwrap().set_len(swiftprox::files::MOST_FILE_BYTES + 1).unwrap();
    let cases: [(&Path, &str); 4] = [
        (&pipe, "a FIFO (a pipe); only regular files are read"),
        (Path::new("/dev/zero"), "a device; only regular files are read"),
        (&folder, "a directory; only regular files are read"),
        (&sparse, "larger than 4294967296 bytes"),
    ];
    for (path, said) in cases {
        let refused = [
            read_mesh(path).map(drop).unwrap_err(),
            swiftprox::shape_file::load(path).map(drop).unwrap_err(),
            Shape::from_file(path, &ShapeOptions::default()).map(drop).unwrap_err(),
        ];
        for error in refused {
            assert!(matches!(error, Error::File(_)), "{error:?}");
            assert!(error.message().contains(said) && error.message().contains(path.to_str().unwrap()), "{error}");
        }
    }
    // Nor is anything written where a reader would have to be waited for.
    let tetrahedron = Shape::from_mesh(&tetrahedron(1.0), &ShapeOptions::default()).unwrap();
    let error = swiftprox::shape_file::save(&tetrahedron, &pipe).unwrap_err();
    assert!(matches!(error, Error::File(_)) && error.message().contains("cannot be written"), "{error:?}");
    let error = swiftprox::shape_file::save(&tetrahedron, Path::new("/dev/null")).unwrap_err();
    assert!(error.message().contains("it is a device; only regular files are written"), "{error}");
    // A link to a file is the file.
    let link = folder.join("cube.off");
    std::os::unix::fs::symlink(std::fs::canonicalize(fixture("cube.off")).unwrap(), &link).unwrap();
    assert_eq!(read_mesh(&link), Ok(cube()));
    std::fs::remove_dir_all(&folder).unwrap();
}
