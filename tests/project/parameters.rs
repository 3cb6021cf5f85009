//! No function of the headers asks for more than six things, none of the library for more than five: more belong together in
//! structs, or are of a type that the function is a method of.

use crate::architecture::{files, read, source};
use crate::headers::headers;

const MOST: usize = 6;

const MOST_INSIDE: usize = 5;

#[test]
fn functions_of_the_headers_have_at_most_six_parameters() {
    let (headers, mut count) = (headers().concat(), 0);
    let without_comments = |text: &str| -> String {
        text.split("/*")
            .enumerate()
            .map(|(k, part)| if k == 0 { part } else { part.split_once("*/").unwrap().1 })
            .collect()
    };
    for declaration in without_comments(&headers).split(';') {
        let Some((before, parameters)) = declaration.split_once('(') else { continue };
        let name = before.split([' ', '*', '\n']).next_back().unwrap();
        if name.starts_with("swiftprox_") {
            let given = parameters.matches(',').count() + 1;
            assert!(given <= MOST, "{name} has {given} parameters");
            count += 1;
        }
    }
    assert!(count > 100, "{count}");
}

/// Others are in side headers, so that a newcomer keeps the core in the head.
#[test]
fn the_core_has_at_most_fifty_functions() {
    let core = &headers()[0];
    let count = core.lines().filter(|line| !line.starts_with([' ', '#', '/', 't', '}']) && line.contains('(')).count();
    assert!((40..=50).contains(&count), "{count}");
}

/// The parameters of the function whose name begins a text; `self` is none.
fn parameters(declaration: &str) -> Vec<&str> {
    let (mut depth, mut start, mut before, mut found) = (0, None, ' ', Vec::new());
    for (at, c) in declaration.char_indices() {
        match c {
            '>' if before == '-' => {}
            '(' | '[' | '{' | '<' => depth += 1,
            ')' | ']' | '}' | '>' => depth -= 1,
            _ => {}
        }
        match start {
            None if (c, depth) == ('(', 1) => start = Some(at + 1),
            Some(from) if depth == 0 || (c, depth) == (',', 1) => {
                found.push(declaration[from..at].trim());
                start = Some(at + 1);
            }
            _ => {}
        }
        if start.is_some() && depth == 0 {
            break;
        }
        before = c;
    }
    let is_self = |parameter: &str| parameter.rsplit([' ', '&']).next() == Some("self");
    found.retain(|parameter| !parameter.is_empty() && !is_self(parameter));
    found
}

#[test]
fn functions_of_the_library_have_at_most_five_parameters() {
    let mut count = 0;
    for file in files(&source("")) {
        if file.starts_with(source("ffi")) {
            continue;
        }
        let text = read(&file);
        for (at, _) in text.match_indices("fn ") {
            let line = text[..at].rsplit('\n').next().unwrap();
            if line.contains("//") || line.ends_with(char::is_alphanumeric) {
                continue;
            }
            let declaration = &text[at + 3..];
            let given = parameters(declaration);
            let name = declaration.split(['(', '<']).next().unwrap();
            assert!(given.len() <= MOST_INSIDE, "{}: {name} has {} parameters: {given:?}", file.display(), given.len());
            count += 1;
        }
    }
    assert!(count > 2000, "{count}");
}
