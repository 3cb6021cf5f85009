//! Readers for TRI, POLY, OFF, OBJ and STL files.
//!
//! Vertices and faces keep the file's order, so that index i of the file (counted from 0) is index i of the mesh. STL
//! has no vertex list: there, vertices are numbered by first occurrence. Nothing is allocated from a count that the file
//! only claims.

mod obj;
mod off;
mod scanner;
mod stl;
mod tri_poly;

use std::path::Path;

use crate::error::{Error, Result};
use crate::mesh::PolygonMesh;
use scanner::Scanner;

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
            _ if word.ends_with(b"OFF") => Some(Format::Off),
            _ => None,
        }
    }
}

/// Reads a mesh file: the format by extension (`tri`, `poly`, `off`, `obj`, `stl`), else by content.
///
/// # Errors
/// [`Error::File`] naming the file and the line, or the triangle of a binary file.
pub fn read_mesh(path: &Path) -> Result<PolygonMesh> {
    let name = path.display().to_string();
    let bytes = std::fs::read(path).map_err(|e| Error::File(format!("{name}: cannot be read: {e}")))?;
    parse_mesh(&bytes, Format::from_extension(path), &name)
}

/// Reads a mesh from the bytes of a file. `format`: `None` goes by content. `name` stands for the file in messages.
///
/// # Errors
/// [`Error::File`] naming the file and the line, or the triangle of a binary file.
pub fn parse_mesh(bytes: &[u8], format: Option<Format>, name: &str) -> Result<PolygonMesh> {
    // Some Windows programs start a text file with a UTF-8 byte order mark.
    let bytes = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes);
    let format = format
        .or_else(|| Format::from_content(bytes))
        .ok_or_else(|| Error::File(format!("{name}: not a TRI, POLY, OFF, OBJ or STL file, by its first bytes")))?;
    let mesh = match format {
        Format::TriPoly => tri_poly::parse(bytes, name),
        Format::Off => off::parse(bytes, name),
        Format::Obj => obj::parse(bytes, name),
        Format::Stl => stl::parse(bytes, name),
    }?;
    if mesh.vertices.is_empty() {
        return Err(Error::File(format!("{name}: there are no vertices in it")));
    }
    Ok(mesh)
}
