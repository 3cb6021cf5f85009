//! The name of a type stands for one thing in the whole crate: whoever reads it in a signature need not look which is imported.

use crate::architecture::{files, read, source};
use std::collections::HashMap;

/// The type that a line declares. Indented aliases are those of traits, which say what they are by whose they are.
fn declared(line: &str) -> Option<&str> {
    let mut words = line.split_whitespace().skip_while(|word| word.starts_with("pub") || *word == "unsafe");
    match words.next()? {
        "struct" | "enum" | "trait" | "union" => (),
        "type" if !line.starts_with(' ') => (),
        _ => return None,
    }
    words.next()?.split(|c: char| !c.is_alphanumeric()).next()
}

#[test]
fn no_two_types_have_one_name() {
    let mut places = HashMap::new();
    for file in files(&source("")) {
        for (number, line) in read(&file).lines().enumerate() {
            let Some(name) = declared(line) else { continue };
            let place = format!("{}:{}", file.display(), number + 1);
            if let Some(other) = places.insert(name.to_string(), place.clone()) {
                panic!("`{name}` is declared twice: {other} and {place}");
            }
        }
    }
    assert!(places.len() > 500, "{}", places.len());
}
