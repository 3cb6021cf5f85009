//! Wavefront OBJ (Advanced Visualizer manual, appendix B1), as far as it is polygons: `v` and `f`.
//!
//! Indices count from 1, negative ones back from the last vertex so far; in `a/b/c` only the first counts. Weights and colours
//! behind a vertex and all other keywords are skipped; groups and objects become one mesh. A file of other text is told so.

use std::str::FromStr;

use crate::base::error::Result;
use crate::base::math::Vector;
use crate::base::memory::push;
use crate::body::mesh::PolygonMesh;

use super::scanner::{Scanner, shown};

/// Reads an OBJ file.
pub fn parse(bytes: &[u8], name: &str) -> Result<PolygonMesh> {
    let mut scanner = Scanner::with_continuations(bytes, name);
    let mut mesh = PolygonMesh::default();
    // A face may name vertices that come later, so faces wait, with their lines, until all vertices are known.
    let mut corners = Vec::new();
    let mut faces = Vec::new();
    // The first word that no OBJ begins a line with: its line is skipped, but a file of such lines alone is no OBJ.
    let mut stranger = None;
    while let Some(keyword) = scanner.token() {
        match keyword {
            b"v" => read_vertex(&mut scanner, &mut mesh)?,
            b"f" => {
                let start = corners.len();
                while let Some(token) = scanner.token_on_line() {
                    push(&mut corners, vertex_index(&scanner, token, mesh.vertices.len())?)?;
                }
                push(&mut faces, (scanner.line(), start..corners.len()))?;
            }
            _ if keyword.contains(&0) => {
                let message = "a zero byte in a word: this is UTF-16 or no text at all; save it as UTF-8 or ASCII";
                return Err(scanner.error(format_args!("{message}")));
            }
            _ => {
                if stranger.is_none() && !is_keyword(keyword) {
                    stranger = Some((scanner.line(), shown(keyword)));
                }
                while scanner.token_on_line().is_some() {}
            }
        }
    }
    if let (true, Some((line, word))) = (mesh.vertices.is_empty(), stranger) {
        let message = "no line of an OBJ file begins so, and none of this file gives a vertex";
        return Err(scanner.error_at(line, format_args!("{word}: {message}; is it an OBJ file?")));
    }
    let count = mesh.vertices.len();
    for (line, range) in faces {
        let face = &corners[range];
        if let Some(v) = face.iter().find(|&&v| v as usize >= count) {
            let number = u64::from(*v) + 1;
            return Err(scanner.error_at(line, format_args!("vertex {number} does not exist; the file has {count}")));
        }
        mesh.push_face(face).map_err(|e| e.unless_memory(|e| scanner.error_at(line, format_args!("{e}"))))?;
    }
    Ok(mesh)
}

/// Whether a line of an OBJ file may begin with this word.
fn is_keyword(word: &[u8]) -> bool {
    const KEYWORDS: &str = "v vt vn vp f l p o g s mg usemtl mtllib usemap maplib bevel c_interp d_interp lod shadow_obj trace_obj \
                            ctech stech cstype deg bmat step curv curv2 surf parm trim hole scrv sp end con call csh";
    KEYWORDS.split(' ').any(|keyword| keyword.as_bytes() == word)
}

/// The rest of a `v` line: x y z, then perhaps a weight, a colour, or both.
fn read_vertex(scanner: &mut Scanner, mesh: &mut PolygonMesh) -> Result<()> {
    let v = mesh.vertices.len();
    let mut numbers = [0.0; 7];
    let mut count = 0;
    while let Some(token) = scanner.token_on_line() {
        let number = scanner.parse_number(token, format_args!("vertex {v}"))?;
        if let Some(slot) = numbers.get_mut(count) {
            *slot = number;
        }
        count += 1;
    }
    if !(3..=numbers.len()).contains(&count) {
        return Err(scanner.error(format_args!("vertex {v} has {count} numbers; 3 are needed")));
    }
    let position = Vector::new(numbers[0], numbers[1], numbers[2]);
    mesh.push_vertex(position).map_err(|e| scanner.place(e))
}

/// A corner of a face, `a`, `a/b`, `a//c` or `a/b/c`, as the index of its vertex from 0. `so_far`: vertices read so far.
fn vertex_index(scanner: &Scanner, token: &[u8], so_far: usize) -> Result<u32> {
    let first = token.split(|&b| b == b'/').next().unwrap_or_default();
    let number = std::str::from_utf8(first).ok().and_then(|t| i64::from_str(t).ok());
    let index = match number {
        Some(n) if n > 0 => u32::try_from(n - 1).ok(),
        Some(n) if n < 0 => i64::try_from(so_far).ok().and_then(|m| u32::try_from(m + n).ok()),
        Some(_) => return Err(scanner.error(format_args!("vertex 0: OBJ counts from 1"))),
        None => {
            return Err(scanner.error(format_args!("{} is not a vertex number", shown(token))));
        }
    };
    index.ok_or_else(|| scanner.error(format_args!("vertex {} does not exist; {so_far} so far", shown(first))))
}
