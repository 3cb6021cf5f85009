//! Readers for TRI, POLY, OFF, OBJ and STL files, and for others that a program registers. Each format is a file here, and one of
//! [`Format`].
//!
//! Vertices and faces keep the file's order, so that index i of the file (counted from 0) is index i of the mesh. STL
//! has no vertex list: there, vertices are numbered by first occurrence. Nothing is allocated from a count that the file
//! only claims.

mod scanner;
mod obj;
mod off;
mod registered;
mod stl;
mod tri_poly;

use std::path::Path;

use crate::base::error::{Error, Result};
use crate::base::files::read_whole;
use crate::base::simd::environment::with_default;
use crate::body::mesh::PolygonMesh;
pub use registered::{MeshReader, register_mesh_reader, unregister_mesh_reader};
use scanner::Scanner;

/// Some Windows programs start a text file with it (UTF-8).
const BYTE_ORDER_MARK: &[u8] = b"\xef\xbb\xbf";

/// How text begins that is UTF-16, in both orders of bytes.
const UTF_16_MARKS: [&[u8]; 2] = [b"\xff\xfe", b"\xfe\xff"];

/// A mesh file format.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Format {
    /// SWIFT's own: `TRI` or `POLY`, the first word says which.
    TriPoly,
    /// Geomview's Object File Format.
    Off,
    /// Wavefront OBJ.
    Obj,
    /// Stereolithography, ASCII or binary.
    Stl,
}

impl Format {
    /// The format that a file name's extension stands for.
    pub fn from_extension(path: &Path) -> Option<Format> {
        let extension = path.extension()?.to_str()?.to_ascii_lowercase();
        match extension.as_str() {
            "tri" | "poly" => Some(Format::TriPoly),
            "off" => Some(Format::Off),
            "obj" => Some(Format::Obj),
            "stl" => Some(Format::Stl),
            _ => None,
        }
    }

    /// The format that the first bytes of a file look like.
    pub fn from_content(bytes: &[u8]) -> Option<Format> {
        if stl::is_binary(bytes) {
            return Some(Format::Stl);
        }
        let word = Scanner::with_comments(bytes, "").token()?;
        match word {
            b"TRI" | b"POLY" => Some(Format::TriPoly),
            b"v" | b"vn" | b"vt" | b"f" | b"o" | b"g" | b"s" | b"mtllib" | b"usemtl" | b"OBJ" => Some(Format::Obj),
            _ if word.eq_ignore_ascii_case(b"solid") => Some(Format::Stl),
            _ if off::is_keyword(word) => Some(Format::Off),
            _ => None,
        }
    }
}

/// Reads a mesh file: by the reader registered for its first bytes ([`register_mesh_reader`]) if there is one, else in the format
/// of its extension (`tri`, `poly`, `off`, `obj`, `stl`), else in that of its content. Only regular files of at most
/// [`MOST_FILE_BYTES`](crate::base::files::MOST_FILE_BYTES) are read; a pipe or a device is refused, not waited for.
///
/// # Errors
/// [`Error::File`] naming the file and the line, the triangle of a binary file, or the registered reader and its message.
pub fn read_mesh(path: &Path) -> Result<PolygonMesh> {
    let name = path.display().to_string();
    let bytes = read_whole(path, &name)?;
    match registered::parse(&bytes, &name) {
        Some(mesh) => with_vertices(mesh?, &name),
        None => parse_format(&bytes, Format::from_extension(path), &name),
    }
}

/// Reads a mesh from the bytes of a file. `format`: `None` goes by the first bytes, for which a reader may be registered. `name`
/// stands for the file in messages.
///
/// # Errors
/// [`Error::File`] naming the file and the line, the triangle of a binary file, or the registered reader and its message.
pub fn parse_mesh(bytes: &[u8], format: Option<Format>, name: &str) -> Result<PolygonMesh> {
    if format.is_none()
        && let Some(mesh) = registered::parse(bytes, name)
    {
        return with_vertices(mesh?, name);
    }
    parse_format(bytes, format, name)
}

/// In one of the formats known here, `None` by content.
fn parse_format(bytes: &[u8], format: Option<Format>, name: &str) -> Result<PolygonMesh> {
    let bytes = without_mark(bytes);
    if UTF_16_MARKS.iter().any(|mark| bytes.starts_with(mark)) && !stl::is_binary(bytes) {
        return Err(Error::File(format!(
            "{name}: line 1: the file begins as UTF-16 text does; save it as UTF-8 or ASCII"
        )));
    }
    let format = format
        .or_else(|| Format::from_content(bytes))
        .ok_or_else(|| Error::File(format!("{name}: not a TRI, POLY, OFF, OBJ or STL file, by its first bytes")))?;
    let mesh = with_default(|| match format {
        Format::TriPoly => tri_poly::parse(bytes, name),
        Format::Off => off::parse(bytes, name),
        Format::Obj => obj::parse(bytes, name),
        Format::Stl => stl::parse(bytes, name),
    })?;
    with_vertices(mesh, name)
}

/// A file without its byte order mark.
fn without_mark(bytes: &[u8]) -> &[u8] {
    bytes.strip_prefix(BYTE_ORDER_MARK).unwrap_or(bytes)
}

/// Refuses a mesh without vertices.
fn with_vertices(mesh: PolygonMesh, name: &str) -> Result<PolygonMesh> {
    if mesh.vertices.is_empty() {
        return Err(Error::File(format!("{name}: there are no vertices in it")));
    }
    Ok(mesh)
}
