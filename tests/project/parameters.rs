//! No function of the headers asks for more than six things: more belong together in structs.

use crate::headers::headers;

const MOST: usize = 6;

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
