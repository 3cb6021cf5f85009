//! Mesh files as programs write them: a body of small whole numbers in any dialect of a format. A reader gives the same body or
//! refuses the file; numbers that are colours look like coordinates and corners here.

use std::fmt::Write;

use swiftprox::math::Vector;
use swiftprox::mesh::PolygonMesh;
use swiftprox::mesh_io::Format;

/// Gives a number below its argument.
pub type Choose<'a> = &'a mut dyn FnMut(usize) -> usize;

/// A body in a file.
pub struct MeshFile {
    pub body: PolygonMesh,
    pub format: Format,
    pub bytes: Vec<u8>,
    /// Nothing about the file is in doubt: a refusal is a fault.
    pub is_plain: bool,
}

impl MeshFile {
    /// Any body in any dialect.
    pub fn any(choose: Choose) -> MeshFile {
        let body = any_body(choose);
        match choose(5) {
            0 | 1 => off(body, choose),
            2 => obj(body, choose),
            3 => stl(body, choose),
            _ => poly(body, choose),
        }
    }

    /// Whether this is the body; of STL its triangles alone count, without those of fewer than three different corners.
    pub fn is_body(&self, mesh: &PolygonMesh) -> bool {
        match self.format {
            Format::Stl => triangles_of(mesh) == triangles_of(&self.body),
            _ => *mesh == self.body,
        }
    }
}

/// Vertices of the lattice, and polygons of different corners over them: readers look no further.
fn any_body(choose: Choose) -> PolygonMesh {
    let vertex_count = 4 + choose(6);
    let vertices = (0..vertex_count).map(|_| Vector::new(0.0, 0.0, 0.0).map(|_| choose(6) as f64)).collect();
    let mut mesh = PolygonMesh { vertices, ..PolygonMesh::default() };
    for _ in 0..1 + choose(2 * vertex_count) {
        let (first, valence) = (choose(vertex_count), 3 + choose(2));
        let corners: Vec<u32> = (0..valence).map(|k| ((first + k) % vertex_count) as u32).collect();
        mesh.push_face(&corners).expect("its vertices are there");
    }
    mesh
}

fn triangles_of(mesh: &PolygonMesh) -> Vec<[Vector; 3]> {
    let faces = (0..mesh.face_count()).map(|f| mesh.face(f));
    let fans = faces.flat_map(|face| (1..face.len() - 1).map(move |k| [face[0], face[k], face[k + 1]]));
    let corners = fans.map(|corners| corners.map(|v| mesh.vertices[v as usize]));
    corners.filter(|[a, b, c]| a != b && b != c && c != a).collect()
}

/// How lines end: a file keeps to one way.
fn with_line_ends(text: String, choose: Choose) -> Vec<u8> {
    text.replace('\n', ["\n", "\r\n", "\r"][choose(3)]).into_bytes()
}

/// What stands between two lines.
fn noise(choose: Choose) -> &'static str {
    ["", "", "", "\n", "  \t\n", "# 3 0 1 2\n"][choose(6)]
}

/// Numbers behind a vertex or a face.
fn colour(count: usize, kind: usize, choose: Choose) -> String {
    (0..count).fold(String::new(), |text, _| match kind {
        0 => format!("{text} {}", choose(6)),
        1 => format!("{text} {}", choose(256)),
        _ => format!("{text} 0.{}", choose(10)),
    })
}

fn coordinates(v: &Vector) -> String {
    format!("{} {} {}", v.x, v.y, v.z)
}

fn corners(face: &[u32]) -> String {
    face.iter().fold(face.len().to_string(), |text, v| format!("{text} {v}"))
}

fn off(body: PolygonMesh, choose: Choose) -> MeshFile {
    const ANNOUNCED: [&str; 11] =
        ["COFF", "NOFF", "CNOFF", "STOFF", "STCOFF", "STNOFF", "STCNOFF", "NCOFF", "NSTOFF", "coff", "noff"];
    const SILENT: [&str; 4] = ["OFF", "OFF", "off", ""];
    let is_announced = choose(3) == 0;
    let word = if is_announced { ANNOUNCED[choose(ANNOUNCED.len())] } else { SILENT[choose(SILENT.len())] };
    let width = if choose(2) == 0 { 0 } else { 1 + choose(7) };
    let (kind, face_width) = (choose(3), choose(5));
    let (mut is_bare, mut is_plain) = (true, true);

    let edges = ["", " 0", " 12", "\n0"][choose(4)];
    let counts = format!("{} {}{edges}\n", body.vertices.len(), body.face_count());
    let mut text = format!("{}{word}{}{counts}", noise(choose), ["", " ", "\n"][choose(3)]);
    let by_lines = choose(4) > 0;
    if by_lines {
        for v in &body.vertices {
            let width = if choose(40) == 0 { choose(8) } else { width };
            let behind = colour(width, kind, choose);
            is_bare &= width == 0;
            text += &format!("{}{}{behind}\n", noise(choose), coordinates(v));
        }
        for f in 0..body.face_count() {
            let behind = colour(face_width, kind, choose);
            text += &format!("{}{}{behind}\n", noise(choose), corners(body.face(f)));
        }
        // By chance the colours are another body, too.
        is_plain &= is_announced || is_bare;
    } else {
        // Some vertices on a line, then faces by lines or all on the last one.
        let on_line = 1 + choose(body.vertices.len());
        for (k, v) in body.vertices.iter().enumerate() {
            let behind = colour(width, kind, choose);
            text += &format!("{}{behind}{}", coordinates(v), if k % on_line == on_line - 1 { "\n" } else { " " });
        }
        let behind = if choose(2) == 0 { "\n" } else { " " };
        for f in 0..body.face_count() {
            text += &format!("{}{behind}", corners(body.face(f)));
        }
        // A second face on a line would be the colour of the first.
        is_plain = !is_announced && width == 0 && on_line == 1 && (behind == "\n" || body.face_count() == 1);
    }
    let rest = ["", "\n\n", "# the end\n", "the end\n", "7 7\n"][choose(5)];
    is_plain &= rest != "7 7\n";
    MeshFile { body, format: Format::Off, bytes: with_line_ends(text + rest, choose), is_plain }
}

/// Plain OFF by lines, each vertex with one to seven small whole numbers behind it, equally many at each.
pub fn coloured_off(choose: Choose) -> MeshFile {
    let body = any_body(choose);
    let width = 1 + choose(7);
    let mut text = format!("OFF\n{} {} 0\n", body.vertices.len(), body.face_count());
    for v in &body.vertices {
        text += &format!("{}{}\n", coordinates(v), colour(width, 0, choose));
    }
    (0..body.face_count()).for_each(|f| text += &format!("{}\n", corners(body.face(f))));
    MeshFile { body, format: Format::Off, bytes: text.into_bytes(), is_plain: false }
}

fn obj(body: PolygonMesh, choose: Choose) -> MeshFile {
    let (width, kind, count) = ([0, 1, 3, 4][choose(4)], choose(3), body.vertices.len());
    let mut text = String::new();
    for v in &body.vertices {
        text += &format!("{}v {}{}\n", noise(choose), coordinates(v), colour(width, kind, choose));
    }
    for f in 0..body.face_count() {
        text += "f";
        for v in body.face(f) {
            let (number, back) = (v + 1, i64::from(*v) - count as i64);
            let _ = match choose(5) {
                0 => write!(text, " {back}"),
                1 => write!(text, " {number}/1"),
                2 => write!(text, " {number}//1"),
                3 => write!(text, " \\\n{number}/2/3"),
                _ => write!(text, " {number}"),
            };
        }
        text += "\n";
    }
    MeshFile { body, format: Format::Obj, bytes: with_line_ends(text, choose), is_plain: true }
}

fn poly(body: PolygonMesh, choose: Choose) -> MeshFile {
    let mut text = format!("POLY {} {}\n", body.vertices.len(), body.face_count());
    for v in &body.vertices {
        text += &format!("{}\n", coordinates(v));
    }
    for f in 0..body.face_count() {
        text += &format!("{}{}", corners(body.face(f)), ["\n", " ", "\n\n"][choose(3)]);
    }
    MeshFile { body, format: Format::TriPoly, bytes: with_line_ends(text, choose), is_plain: true }
}

fn stl(body: PolygonMesh, choose: Choose) -> MeshFile {
    let is_plain = !triangles_of(&body).is_empty();
    let faces = (0..body.face_count()).map(|f| body.face(f));
    let fans = faces.flat_map(|face| (1..face.len() - 1).map(move |k| [face[0], face[k], face[k + 1]]));
    let triangles: Vec<[Vector; 3]> = fans.map(|corners| corners.map(|v| body.vertices[v as usize])).collect();
    if choose(2) == 0 {
        let loop_end = ["endloop", "end loop"][choose(2)];
        let mut text = "solid a body\n".to_string();
        for corners in triangles {
            text += "facet normal 0 0 1\nouter loop\n";
            corners.iter().for_each(|v| text += &format!("{}vertex {}\n", ["", "\t"][choose(2)], coordinates(v)));
            text += &format!("{loop_end}\nendfacet\n");
        }
        text += ["endsolid\n", "end solid\n", "endsolid a body", "END SOLID a body\n"][choose(4)];
        return MeshFile { body, format: Format::Stl, bytes: with_line_ends(text, choose), is_plain };
    }
    // With a count of 0 the length counts, and all of it is triangles.
    let has_count = choose(3) > 0;
    let count = if has_count { triangles.len() as u32 } else { 0 };
    let mut bytes = [b' '; 80].to_vec();
    bytes.extend(count.to_le_bytes());
    for corners in &triangles {
        bytes.extend([0; 12]);
        bytes.extend(corners.iter().flatten().flat_map(|x| (*x as f32).to_le_bytes()));
        bytes.extend([0; 2]);
    }
    let (behind, fill) = (if has_count { choose(200) } else { 0 }, [0, b'\n', 0xff][choose(3)]);
    bytes.resize(bytes.len() + behind, fill);
    let is_certain = behind % 50 != 0 || behind == 0 || fill == 0;
    MeshFile { body, format: Format::Stl, bytes, is_plain: is_plain && is_certain }
}
