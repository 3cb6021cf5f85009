//! Words of a text file, with the line they are on. A line ends with a line feed (Unix), a carriage return (old Mac systems) or
//! both (Windows), whichever the others of the file end with.

use std::fmt;
use std::num::IntErrorKind;
use std::str::FromStr;

use crate::base::error::{Error, Result};
use crate::base::math::Vector;

/// Reads a text file word by word. Bytes need not be UTF-8: names and comments come in any encoding.
#[derive(Clone)]
pub struct Scanner<'a> {
    /// Stands for the file in messages.
    name: &'a str,
    rest: &'a [u8],
    line: usize,
    /// `#` starts a comment that ends with the line.
    comments: bool,
    /// A backslash before the end of a line continues it.
    continuations: bool,
}

impl<'a> Scanner<'a> {
    /// Plain words: no comments.
    pub fn plain(bytes: &'a [u8], name: &'a str) -> Self {
        Scanner { name, rest: bytes, line: 1, comments: false, continuations: false }
    }

    /// `#` starts a comment.
    pub fn with_comments(bytes: &'a [u8], name: &'a str) -> Self {
        Scanner { comments: true, ..Scanner::plain(bytes, name) }
    }

    /// `#` starts a comment, and a backslash before the end of a line continues it.
    pub fn with_continuations(bytes: &'a [u8], name: &'a str) -> Self {
        Scanner { continuations: true, ..Scanner::with_comments(bytes, name) }
    }

    /// The line of the last word, from 1; after the last word of the file, the last line.
    pub fn line(&self) -> usize {
        self.line
    }

    /// The next word on any line.
    pub fn token(&mut self) -> Option<&'a [u8]> {
        loop {
            if let Some(token) = self.token_on_line() {
                return Some(token);
            }
            if !self.next_line() {
                return None;
            }
        }
    }

    /// The next word on this line.
    pub fn token_on_line(&mut self) -> Option<&'a [u8]> {
        loop {
            let continued = self.continuation(self.rest);
            if continued > 0 {
                self.rest = &self.rest[continued..];
                self.line += 1;
            } else if self.rest.first().is_some_and(|&b| !is_line_end(b) && is_space(b)) {
                self.rest = &self.rest[1..];
            } else {
                break;
            }
        }
        let ends_word = |&i: &usize| {
            let b = self.rest[i];
            is_space(b) || (b == b'#' && self.comments) || self.continuation(&self.rest[i..]) > 0
        };
        let end = (0..self.rest.len()).find(ends_word).unwrap_or(self.rest.len());
        let (token, rest) = self.rest.split_at(end);
        self.rest = rest;
        (!token.is_empty()).then_some(token)
    }

    /// Skips to the line after this one; false when this one is the last.
    pub fn next_line(&mut self) -> bool {
        match self.rest.iter().position(|&b| is_line_end(b)) {
            Some(end) => {
                let both = self.rest[end..].starts_with(b"\r\n");
                self.rest = &self.rest[end + if both { 2 } else { 1 }..];
                self.line += 1;
                true
            }
            None => {
                self.rest = &[];
                false
            }
        }
    }

    /// The length of the continued line end that `bytes` start with, or 0.
    fn continuation(&self, bytes: &[u8]) -> usize {
        match bytes {
            [b'\\', b'\r', b'\n', ..] if self.continuations => 3,
            [b'\\', b'\n' | b'\r', ..] if self.continuations => 2,
            _ => 0,
        }
    }

    /// The next number; `of` names its owner in messages.
    pub fn number(&mut self, of: fmt::Arguments) -> Result<f64> {
        let token = self.token().ok_or_else(|| self.ended(of))?;
        self.parse_number(token, of)
    }

    /// Three numbers.
    pub fn point(&mut self, of: fmt::Arguments) -> Result<Vector> {
        Ok(Vector::new(self.number(of)?, self.number(of)?, self.number(of)?))
    }

    /// The next whole number from 0; `of` names it in messages.
    pub fn index(&mut self, of: fmt::Arguments) -> Result<u32> {
        let token = self.token().ok_or_else(|| self.ended(of))?;
        self.parse_index(token, of)
    }

    /// A word as a whole number from 0; `of` names it in messages.
    pub fn parse_index(&self, token: &[u8], of: fmt::Arguments) -> Result<u32> {
        match text(token).map(u32::from_str) {
            Some(Ok(index)) => Ok(index),
            Some(Err(e)) if *e.kind() == IntErrorKind::PosOverflow => {
                Err(self.error(format_args!("{of}: {} does not fit 32 bits", shown(token))))
            }
            _ => Err(self.error(format_args!("{of}: {} is not a whole number", shown(token)))),
        }
    }

    /// A word as a number; `of` names its owner in messages.
    pub fn parse_number(&self, token: &[u8], of: fmt::Arguments) -> Result<f64> {
        text(token)
            .and_then(|t| f64::from_str(t).ok())
            .ok_or_else(|| self.error(format_args!("{of}: {} is not a number", shown(token))))
    }

    /// The error of a file that ends before `of`.
    pub fn ended(&self, of: fmt::Arguments) -> Error {
        self.error(format_args!("{of}: the file ends here"))
    }

    /// An error at the last word.
    pub fn error(&self, message: fmt::Arguments) -> Error {
        self.error_at(self.line, message)
    }

    /// An error at a line.
    pub fn error_at(&self, line: usize, message: fmt::Arguments) -> Error {
        Error::File(format!("{}: line {line}: {message}", self.name))
    }

    /// An error of the mesh itself, placed at the last word; a lack of memory has no place.
    pub fn place(&self, error: Error) -> Error {
        error.unless_memory(|error| self.error(format_args!("{error}")))
    }
}

/// A word for a message: short, printable.
pub fn shown(token: &[u8]) -> String {
    const MOST: usize = 24;
    let head = String::from_utf8_lossy(&token[..token.len().min(MOST)]);
    let more = if token.len() > MOST { "…" } else { "" };
    format!("\"{}{more}\"", head.escape_debug())
}

fn text(token: &[u8]) -> Option<&str> {
    std::str::from_utf8(token).ok()
}

fn is_line_end(byte: u8) -> bool {
    byte == b'\n' || byte == b'\r'
}

/// White space as C's `isspace` has it.
pub fn is_space(byte: u8) -> bool {
    byte.is_ascii_whitespace() || byte == b'\x0b'
}
