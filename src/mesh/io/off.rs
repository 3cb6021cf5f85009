//! OFF, the Object File Format of Geomview: <http://www.geomview.org/docs/html/OFF.html>.
//!
//! A header word, the numbers of vertices, faces and edges (on the same line or the next), the vertices, the faces. `#`
//! starts a comment. The prefixes `ST`, `C`, `N` of the header announce texture coordinates, colours and normals behind
//! each vertex's position, which are skipped to the end of the line; so are colours behind a face.

use crate::base::error::Result;
use crate::base::memory::push;
use crate::mesh::PolygonMesh;

use super::scanner::{Scanner, shown};

/// Reads an OFF file.
pub fn parse(bytes: &[u8], name: &str) -> Result<PolygonMesh> {
    let mut scanner = Scanner::with_comments(bytes, name);
    let header = scanner.token().ok_or_else(|| scanner.ended(format_args!("OFF")))?;
    let Some(prefix) = header.strip_suffix(b"OFF") else {
        return Err(scanner.error(format_args!("{} where OFF should be", shown(header))));
    };
    let attributes = match prefix {
        b"" => false,
        b"ST" | b"C" | b"N" | b"CN" | b"STC" | b"STN" | b"STCN" => true,
        _ => {
            return Err(
                scanner.error(format_args!("{} is not supported: vertices must have three coordinates", shown(header)))
            );
        }
    };
    if scanner.clone().token() == Some(b"BINARY") {
        return Err(scanner.error(format_args!("binary OFF is not supported")));
    }
    let vertex_count = scanner.index(format_args!("the number of vertices"))?;
    let face_count = scanner.index(format_args!("the number of faces"))?;
    // The number of edges, which nobody needs and some programs leave out.
    scanner.token_on_line();

    let mut mesh = PolygonMesh::default();
    for v in 0..vertex_count {
        let position = scanner.point(format_args!("vertex {v} of {vertex_count}"))?;
        mesh.push_vertex(position).map_err(|e| scanner.place(e))?;
        if attributes {
            scanner.next_line();
        }
    }
    let mut corners = Vec::new();
    for f in 0..face_count {
        let of = format_args!("face {f} of {face_count}");
        let valence = scanner.index(of)?;
        corners.clear();
        for _ in 0..valence {
            push(&mut corners, scanner.index(of)?)?;
        }
        mesh.push_face(&corners).map_err(|e| scanner.place(e))?;
        scanner.next_line();
    }
    Ok(mesh)
}
