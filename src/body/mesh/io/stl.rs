//! STL, ASCII and binary (3D Systems, Stereolithography Interface Specification, 1989).
//!
//! STL repeats every vertex in every triangle: exactly equal ones become one here, in order of first occurrence. A triangle with
//! two equal corners has no area, and its other two sides coincide, so the surface closes without it: it is dropped, and later
//! triangles move up. One with three equal corners is a place that nobody filled in, and yields no vertex. Normals are not read:
//! vertices say the same, more accurately.
//!
//! A binary file may go on behind its triangles, with bytes that make no whole number of them or with zeros. Its count is 0 if
//! the program that wrote it did not come back to the header. Then the file's length tells the count, if it is that of whole
//! triangles. The ASCII words `endloop`, `endfacet` and `endsolid` may be two words.
//!
//! The coordinates of a binary file are single precision. So are nearly always those of an ASCII file, being printed from
//! the same programs' floats, hence both are marked as such.

use std::collections::HashMap;
use std::fmt;

use crate::base::error::{Error, Result};
use crate::base::math::Vector;
use crate::base::memory::lacking;
use crate::body::mesh::PolygonMesh;

use super::scanner::{Scanner, shown};

/// A binary file starts with 80 free bytes and the number of triangles.
const HEADER: usize = 84;
/// Normal and three corners in single precision, and two free bytes.
const TRIANGLE: usize = 50;

/// Whether the file has exactly the size that its triangle count says as a binary file. This is safer than the first word: the
/// free bytes of a binary file may well start with "solid". Only a caller that knows that a file is STL may take another size
/// ([`parse`]).
pub fn is_binary(bytes: &[u8]) -> bool {
    claimed_size(bytes) == Some(bytes.len() as u64)
}

/// Reads an STL file.
pub fn parse(bytes: &[u8], name: &str) -> Result<PolygonMesh> {
    // Text has no zero bytes; the count of a binary file ends in one unless the file has 16,777,216 triangles or more.
    let head = &bytes[..bytes.len().min(HEADER)];
    let word = Scanner::plain(bytes, name).token().unwrap_or_default();
    if !is_binary(bytes) && word.eq_ignore_ascii_case(b"solid") && !head.contains(&0) {
        return parse_ascii(bytes, name);
    }
    parse_binary(triangles_of(bytes, name)?, name)
}

/// The triangles of a binary file, without the bytes before and behind them.
fn triangles_of<'a>(bytes: &'a [u8], name: &str) -> Result<&'a [u8]> {
    let length = bytes.len() as u64;
    let refusal = |problem: String| {
        Err(Error::File(format!("{name}: neither ASCII STL (which starts with \"solid\") nor binary: {problem}")))
    };
    let Some(size) = claimed_size(bytes) else {
        return refusal(format!("{length} bytes are too few"));
    };
    let body = &bytes[HEADER..];
    let has_whole_triangles = body.len().is_multiple_of(TRIANGLE);
    if size > length {
        return refusal(format!("its triangle count asks for {size} bytes, the file has {length}"));
    }
    if size == HEADER as u64 {
        let problem = "the triangle count is 0, and what follows is no whole number of triangles of 50 bytes";
        return if has_whole_triangles { Ok(body) } else { Err(Error::File(format!("{name}: {problem}"))) };
    }
    // It fits: no more than the length.
    let (triangles, rest) = body.split_at(size as usize - HEADER);
    if has_whole_triangles && rest.iter().any(|byte| *byte != 0) {
        let (said, more) = (triangles.len() / TRIANGLE, rest.len() / TRIANGLE);
        return Err(Error::File(format!(
            "{name}: the triangle count is {said}, and behind these is as much as {more} more would take; if they are triangles, \
             make the count {}, else cut the file off behind {size} bytes",
            said + more
        )));
    }
    Ok(triangles)
}

/// The size of a binary file with the triangle count that is at its place; `None` for a file without that place.
fn claimed_size(bytes: &[u8]) -> Option<u64> {
    let count = bytes.get(HEADER - 4..HEADER)?.first_chunk()?;
    Some(HEADER as u64 + TRIANGLE as u64 * u64::from(u32::from_le_bytes(*count)))
}

fn parse_binary(triangles: &[u8], name: &str) -> Result<PolygonMesh> {
    let mut welder = Welder::default();
    for (t, triangle) in triangles.chunks_exact(TRIANGLE).enumerate() {
        let coordinate = |k: usize| {
            let at = 12 + 4 * k;
            let b = &triangle[at..at + 4];
            f64::from(f32::from_le_bytes([b[0], b[1], b[2], b[3]]))
        };
        let corner = |k: usize| Vector::new(coordinate(3 * k), coordinate(3 * k + 1), coordinate(3 * k + 2));
        welder
            .push_triangle([corner(0), corner(1), corner(2)])
            .map_err(|e| e.unless_memory(|e| Error::File(format!("{name}: triangle {t}: {e}"))))?;
    }
    Ok(welder.mesh)
}

fn parse_ascii(bytes: &[u8], name: &str) -> Result<PolygonMesh> {
    let mut scanner = Scanner::plain(bytes, name);
    let mut welder = Welder::default();
    let mut triangle_count = 0_usize;
    // A file may hold several solids, one after the other; they become one mesh.
    while let Some(word) = scanner.token() {
        expect(&scanner, word, "solid")?;
        // The name of the solid.
        scanner.next_line();
        loop {
            let of = format_args!("triangle {triangle_count} or \"endsolid\"");
            let word = scanner.token().ok_or_else(|| scanner.ended(of))?;
            let is_half = word.eq_ignore_ascii_case(b"end");
            if is_half {
                expect_next(&mut scanner, of, "solid")?;
            }
            if is_half || word.eq_ignore_ascii_case(b"endsolid") {
                scanner.next_line();
                break;
            }
            expect(&scanner, word, "facet")?;
            let corners = read_facet(&mut scanner, format_args!("triangle {triangle_count}"))?;
            welder.push_triangle(corners).map_err(|e| scanner.place(e))?;
            triangle_count += 1;
        }
    }
    Ok(welder.mesh)
}

/// A facet behind its first word; `of` says in messages which.
fn read_facet(scanner: &mut Scanner, of: fmt::Arguments) -> Result<[Vector; 3]> {
    expect_next(scanner, of, "normal")?;
    // The normal itself may be anything: some programs print "nan" or "-nan(ind)".
    for _ in 0..3 {
        scanner.token();
    }
    expect_next(scanner, of, "outer")?;
    expect_next(scanner, of, "loop")?;
    let mut corners = [Vector::zeros(); 3];
    for corner in &mut corners {
        expect_next(scanner, of, "vertex")?;
        *corner = scanner.point(of)?;
    }
    expect_end(scanner, of, "endloop")?;
    expect_end(scanner, of, "endfacet")?;
    Ok(corners)
}

/// A word that begins with "end", which may be a word of its own.
fn expect_end(scanner: &mut Scanner, of: fmt::Arguments, expected: &str) -> Result<()> {
    let word = scanner.token().ok_or_else(|| scanner.ended(of))?;
    if word.eq_ignore_ascii_case(b"end") {
        return expect_next(scanner, of, expected.trim_start_matches("end"));
    }
    expect(scanner, word, expected)
}

fn expect_next(scanner: &mut Scanner, of: fmt::Arguments, expected: &str) -> Result<()> {
    let word = scanner.token().ok_or_else(|| scanner.ended(of))?;
    expect(scanner, word, expected)
}

/// Words of STL are in lower case by the book, in upper case from some programs.
fn expect(scanner: &Scanner, word: &[u8], expected: &str) -> Result<()> {
    if word.eq_ignore_ascii_case(expected.as_bytes()) {
        Ok(())
    } else {
        Err(scanner.error(format_args!("{} where \"{expected}\" should be", shown(word))))
    }
}

/// Builds a mesh from loose triangles.
struct Welder {
    mesh: PolygonMesh,
    /// Indices by the bits of the coordinates, −0 as 0.
    indices: HashMap<[u64; 3], u32>,
}

impl Default for Welder {
    fn default() -> Self {
        let mesh = PolygonMesh { single_precision: true, ..PolygonMesh::default() };
        Welder { mesh, indices: HashMap::new() }
    }
}

impl Welder {
    fn push_triangle(&mut self, corners: [Vector; 3]) -> Result<()> {
        // Not for values that are no numbers: they are refused below.
        let is_point = corners.iter().all(|corner| corner == &corners[0] && corner.iter().all(|x| x.is_finite()));
        if is_point {
            return Ok(());
        }
        let mut face = [0; 3];
        for (index, corner) in face.iter_mut().zip(&corners) {
            *index = self.vertex(corner)?;
        }
        let [a, b, c] = face;
        if a == b || b == c || c == a {
            return Ok(());
        }
        self.mesh.push_face(&face)
    }

    /// The index of the vertex at this position, new or not.
    fn vertex(&mut self, position: &Vector) -> Result<u32> {
        // −0 + 0 = 0: numbers that compare equal get one key.
        let key = [position.x, position.y, position.z].map(|x| (x + 0.0).to_bits());
        if let Some(&index) = self.indices.get(&key) {
            return Ok(index);
        }
        // `push_vertex` refuses a count that does not fit 32 bits.
        let index = self.mesh.vertices.len() as u32;
        self.indices.try_reserve(1).map_err(|e| lacking::<([u64; 3], u32)>(self.indices.len() + 1, &e))?;
        self.mesh.push_vertex(*position)?;
        self.indices.insert(key, index);
        Ok(index)
    }
}
