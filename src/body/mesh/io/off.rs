//! OFF, the Object File Format of Geomview: <http://www.geomview.org/docs/html/OFF.html>.
//!
//! `[ST][C][N]OFF`, the numbers of vertices, faces and edges, the vertices, the faces; `#` starts a comment. Colours, normals and
//! texture coordinates stand behind a position, a colour behind a face: they are left out. As files have it, the word may be
//! missing, in lower case, with its letters in any order or with the first number glued to it (`OFF8 6 0`), and the number of
//! edges may be missing.
//!
//! Such text has two readings:
//!
//! - By lines: each vertex and each face has one of its own. Three numbers of a vertex are its position, the rest of its line is
//!   not.
//! - In free form, as Geomview reads: vertices are numbers on any lines, and a face takes the rest of the line behind its last
//!   corner.
//!
//! Many files begin with plain `OFF` and have colours at their vertices. Read in free form, those would be vertices and faces of
//! another body. So a reading has to fit: as many vertices and faces as the file says, and no number behind them. In free form a
//! face has three corners or more, none twice, and a colour of four numbers at most. A file that one reading fits is read so; one
//! that both fit, as different bodies, is refused. So is a file in free form that fits as well if each vertex has some numbers
//! more.
//!
//! Lines alone count where the header announces more than positions: writers differ in how many numbers a colour has. They alone
//! count as well where all vertices have equally many numbers, more than three: such a file is cut off or damaged if they do not
//! fit.

use crate::base::error::{Error, Result};
use crate::base::math::Vector;
use crate::base::memory::{copied, push};
use crate::body::mesh::PolygonMesh;

use super::scanner::{Scanner, shown};

/// The data that may be announced behind a vertex's position: texture coordinates, a colour, a normal.
const ATTRIBUTES: [&[u8]; 3] = [b"ST", b"C", b"N"];

const MOST_NUMBERS_OF_COLOUR: usize = 4;

/// How many numbers a vertex has with all of them.
const MOST_NUMBERS: usize = 3 + 2 + MOST_NUMBERS_OF_COLOUR + 3;

/// The part before the vertices.
struct Head {
    vertex_count: u32,
    face_count: u32,
    /// Vertices have more than positions, it says.
    has_attributes: bool,
}

/// How many words the lines of vertices have, as far as they were read.
struct Widths {
    lines: u32,
    least: usize,
    most: usize,
}

/// Reads an OFF file: by lines, in free form or not at all, as the head of this file says.
pub fn parse(bytes: &[u8], name: &str) -> Result<PolygonMesh> {
    let mut scanner = Scanner::with_comments(bytes, name);
    let head = read_head(&mut scanner)?;
    let mut widths = Widths { lines: 0, least: usize::MAX, most: 0 };
    let by_lines = read_by_lines(scanner.clone(), &head, &mut widths);
    let lines_alone = head.has_attributes
        || match &by_lines {
            // Without more numbers than positions, both readings are the same.
            Ok(_) => widths.most <= 3,
            Err(Error::Memory(_)) => true,
            Err(_) => widths.lines == head.vertex_count && widths.least == widths.most && widths.most > 3,
        };
    if lines_alone {
        return by_lines;
    }
    match (by_lines, read_free_form(scanner.clone(), &head, 3)) {
        (_, Err(error @ Error::Memory(_))) => Err(error),
        (Ok(by_lines), Ok(free)) if by_lines != free => Err(scanner.error(format_args!(
            "behind these counts there are two bodies, one by lines and one of numbers on any lines; if vertices have colours, \
             begin the file with COFF, else give each vertex a line with nothing but its coordinates"
        ))),
        (Ok(mesh), _) => Ok(mesh),
        // Lines of three numbers tell that vertices have no more, whatever the faces do.
        (Err(_), Ok(free)) if widths.lines == head.vertex_count && widths.most == 3 => Ok(free),
        (Err(_), Ok(free)) => {
            for width in 4..=MOST_NUMBERS {
                match read_free_form(scanner.clone(), &head, width) {
                    Err(error @ Error::Memory(_)) => return Err(error),
                    Err(_) => {}
                    Ok(_) => {
                        return Err(scanner.error(format_args!(
                            "behind these counts there are two bodies, one with 3 numbers at each vertex and one with {width}; give \
                             each vertex and each face a line of its own"
                        )));
                    }
                }
            }
            Ok(free)
        }
        (Err(by_lines), Err(free)) => Err(if widths.lines > 0 { by_lines } else { free }),
    }
}

/// Whether a file that begins with this word is OFF.
pub fn is_keyword(word: &[u8]) -> bool {
    split_keyword(word).is_some()
}

/// A keyword as the letters of the vertices' attributes, the word itself, and the digits that are glued to it.
fn split_keyword(word: &[u8]) -> Option<(&[u8], &[u8], &[u8])> {
    let at = word.windows(3).position(|part| part.eq_ignore_ascii_case(b"OFF"))?;
    let (letters, rest) = word.split_at(at);
    let (off, digits) = rest.split_at(3);
    let is_one = letters.iter().all(|letter| b"STCN4".contains(&letter.to_ascii_uppercase()));
    (is_one && digits.iter().all(u8::is_ascii_digit)).then_some((letters, off, digits))
}

fn read_head(scanner: &mut Scanner) -> Result<Head> {
    let word = scanner.token().ok_or_else(|| scanner.ended(format_args!("OFF")))?;
    let (has_attributes, glued) = if word.iter().all(u8::is_ascii_digit) {
        (false, word)
    } else {
        let Some((letters, off, digits)) = split_keyword(word) else {
            return Err(scanner.error(format_args!("{} where OFF should be", shown(word))));
        };
        check_letters(scanner, word, letters, off == b"off")?;
        (!letters.is_empty(), digits)
    };
    if scanner.clone().token().is_some_and(|word| word.eq_ignore_ascii_case(b"BINARY")) {
        return Err(scanner.error(format_args!("binary OFF is not supported: save the file as text")));
    }
    let of_vertices = format_args!("the number of vertices");
    let vertex_count =
        if glued.is_empty() { scanner.index(of_vertices)? } else { scanner.parse_index(glued, of_vertices)? };
    let face_count = scanner.index(format_args!("the number of faces"))?;
    // The number of edges, which nobody needs: on the same line or alone on the next, where a vertex by lines has three numbers.
    if scanner.token_on_line().is_none() {
        let mut ahead = scanner.clone();
        if ahead.index(format_args!("the number of edges")).is_ok() && ahead.token_on_line().is_none() {
            *scanner = ahead;
        }
    }
    Ok(Head { vertex_count, face_count, has_attributes })
}

/// Refuses a keyword whose vertices are not three coordinates and known attributes.
fn check_letters(scanner: &Scanner, word: &[u8], letters: &[u8], lower_case: bool) -> Result<()> {
    if letters.contains(&b'4') {
        return Err(scanner.error(format_args!(
            "{} is not supported: vertices must have three coordinates; divide them by the fourth and write OFF",
            shown(word)
        )));
    }
    // In lower case throughout, it may well be normals; then the lines tell.
    if letters.contains(&b'n') && !lower_case {
        return Err(scanner.error(format_args!(
            "{} is not supported: vertices must have three coordinates; write OFF if they have, NOFF if normals follow",
            shown(word)
        )));
    }
    let mut seen = [false; ATTRIBUTES.len()];
    let mut rest = letters;
    while !rest.is_empty() {
        let begins = |attribute: &&[u8]| {
            rest.len() >= attribute.len() && rest[..attribute.len()].eq_ignore_ascii_case(attribute)
        };
        match ATTRIBUTES.iter().position(begins) {
            Some(k) if !seen[k] => {
                seen[k] = true;
                rest = &rest[ATTRIBUTES[k].len()..];
            }
            _ => return Err(scanner.error(format_args!("{} where OFF should be", shown(word)))),
        }
    }
    Ok(())
}

/// Each vertex and each face has a line.
fn read_by_lines(mut scanner: Scanner, head: &Head, widths: &mut Widths) -> Result<PolygonMesh> {
    if let Some(word) = scanner.token_on_line() {
        return Err(scanner.error(format_args!("{} behind the counts: vertices begin on the next line", shown(word))));
    }
    let mut mesh = PolygonMesh::default();
    for v in 0..head.vertex_count {
        let of = format_args!("vertex {v} of {}", head.vertex_count);
        let mut position = Vector::new(scanner.number(of)?, 0.0, 0.0);
        for k in 1..3 {
            let token = scanner.token_on_line();
            let token = token.ok_or_else(|| scanner.error(format_args!("{of}: {k} of 3 coordinates on its line")))?;
            position[k] = scanner.parse_number(token, of)?;
        }
        mesh.push_vertex(position).map_err(|e| scanner.place(e))?;
        let mut width = 3;
        while scanner.token_on_line().is_some() {
            width += 1;
        }
        *widths = Widths { lines: v + 1, least: widths.least.min(width), most: widths.most.max(width) };
    }
    let mut corners = Vec::new();
    for f in 0..head.face_count {
        let of = format_args!("face {f} of {}", head.face_count);
        let valence = scanner.index(of)?;
        corners.clear();
        for k in 0..valence {
            let token = scanner.token_on_line();
            let token =
                token.ok_or_else(|| scanner.error(format_args!("{of}: {k} of {valence} corners on its line")))?;
            push(&mut corners, scanner.parse_index(token, of)?)?;
        }
        mesh.push_face(&corners).map_err(|e| scanner.place(e))?;
        scanner.next_line();
    }
    check_end(scanner, head)?;
    Ok(mesh)
}

/// Vertices of `width` numbers, the first three of which are the position, on any lines; the rest of the line behind a face's
/// last corner is its colour.
fn read_free_form(mut scanner: Scanner, head: &Head, width: usize) -> Result<PolygonMesh> {
    let mut mesh = PolygonMesh::default();
    for v in 0..head.vertex_count {
        let of = format_args!("vertex {v} of {}", head.vertex_count);
        let position = scanner.point(of)?;
        for _ in 3..width {
            scanner.number(of)?;
        }
        mesh.push_vertex(position).map_err(|e| scanner.place(e))?;
    }
    let mut corners = Vec::new();
    for f in 0..head.face_count {
        let of = format_args!("face {f} of {}", head.face_count);
        let valence = scanner.index(of)?;
        corners.clear();
        for _ in 0..valence {
            push(&mut corners, scanner.index(of)?)?;
        }
        let mut sorted = copied(&corners)?;
        sorted.sort_unstable();
        if sorted.len() < 3 || sorted.windows(2).any(|pair| pair[0] == pair[1]) {
            return Err(scanner.error(format_args!(
                "{of}: it has not three different corners or more; if it is one, give each vertex and each face a line of its own"
            )));
        }
        mesh.push_face(&corners).map_err(|e| scanner.place(e))?;
        for k in 0.. {
            let Some(word) = scanner.token_on_line() else { break };
            if k == MOST_NUMBERS_OF_COLOUR {
                return Err(scanner.error(format_args!(
                    "{of}: {} behind it and its colour; give each face a line of its own",
                    shown(word)
                )));
            }
        }
    }
    check_end(scanner, head)?;
    Ok(mesh)
}

/// Refuses numbers behind the last face: they belong to the body that was meant.
fn check_end(mut scanner: Scanner, head: &Head) -> Result<()> {
    match scanner.token() {
        Some(word) if scanner.parse_number(word, format_args!("")).is_ok() => Err(scanner.error(format_args!(
            "{} behind the last face: the file says that it has {} vertices and {} faces",
            shown(word),
            head.vertex_count,
            head.face_count
        ))),
        _ => Ok(()),
    }
}
