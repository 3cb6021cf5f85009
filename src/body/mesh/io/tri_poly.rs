//! SWIFT's own text formats (manual of SWIFT 1.0):
//!
//! ```text
//! TRI  nv nf  (x y z) × nv  (i j k) × nf
//! POLY nv nf  (x y z) × nv  (n i1 … in) × nf
//! ```
//!
//! Words separated by white space, any line breaks, no comments, indices from 0; text after the last face is ignored.

use crate::base::error::Result;
use crate::base::memory::push;
use crate::body::mesh::PolygonMesh;

use super::scanner::{Scanner, shown};

/// Reads a TRI or POLY file.
pub fn parse(bytes: &[u8], name: &str) -> Result<PolygonMesh> {
    let mut scanner = Scanner::plain(bytes, name);
    let polygons = match scanner.token() {
        Some(b"TRI") => false,
        Some(b"POLY") => true,
        Some(other) => {
            return Err(scanner.error(format_args!("{} where TRI or POLY should be", shown(other))));
        }
        None => return Err(scanner.ended(format_args!("TRI or POLY"))),
    };
    let vertex_count = scanner.index(format_args!("the number of vertices"))?;
    let face_count = scanner.index(format_args!("the number of faces"))?;
    let mut mesh = PolygonMesh::default();
    for v in 0..vertex_count {
        let position = scanner.point(format_args!("vertex {v} of {vertex_count}"))?;
        mesh.push_vertex(position).map_err(|e| scanner.place(e))?;
    }
    let mut corners = Vec::new();
    for f in 0..face_count {
        let of = format_args!("face {f} of {face_count}");
        let valence = if polygons { scanner.index(of)? } else { 3 };
        corners.clear();
        for _ in 0..valence {
            push(&mut corners, scanner.index(of)?)?;
        }
        mesh.push_face(&corners).map_err(|e| scanner.place(e))?;
    }
    Ok(mesh)
}
