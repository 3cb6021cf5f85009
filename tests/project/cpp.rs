//! swiftprox.hpp leaves nothing of the C interface out: each function has its counterpart, each member of a config is set. The page
//! about it shows an example that is compiled and run.

use crate::headers::headers;
use std::fs;
use std::path::Path;

/// All files of swiftprox.hpp, one after the other.
fn wrapper() -> String {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("include/swiftprox");
    let files = fs::read_dir(folder).expect("the folder of swiftprox.hpp is there").map(|entry| entry.unwrap().path());
    files
        .filter(|file| file.extension().is_some_and(|extension| extension == "hpp"))
        .map(|file| fs::read_to_string(file).unwrap())
        .collect()
}

/// The lines of the headers without comments.
fn code() -> Vec<String> {
    let is_code = |line: &&str| !line.trim_start().starts_with(['/', '*']);
    headers().concat().lines().filter(is_code).map(str::to_string).collect()
}

#[test]
fn each_function_has_its_counterpart() {
    let wrapper = wrapper();
    let mut count = 0;
    for line in code().iter().filter(|line| !line.starts_with([' ', '#', 't', '}'])) {
        let name = line.split_once('(').map_or("", |(before, _)| before).split([' ', '*']).next_back().unwrap();
        // Configs begin with their defaults by member initialisers, which c_tests/cpp/cpp.cpp compares.
        if name.starts_with("swiftprox_") {
            let is_used = wrapper
                .match_indices(name)
                .any(|(at, _)| !wrapper[at + name.len()..].starts_with(|c: char| c.is_alphanumeric() || c == '_'));
            assert!(is_used, "{name} has no counterpart in swiftprox.hpp");
            count += 1;
        }
    }
    assert!(count > 70, "{count}");
}

#[test]
fn each_member_of_a_config_is_set() {
    let wrapper = wrapper();
    let code = code();
    let mut count = 0;
    let is_default = |line: &String| Some(line.strip_prefix("#define ")?.split_once("_DEFAULT ")?.0.to_lowercase());
    for config in code.iter().filter_map(is_default) {
        let first = code.iter().position(|line| *line == format!("typedef struct {config} {{")).expect(&config);
        let to_c =
            wrapper.split_once(&format!("{config} to_c(")).unwrap_or_else(|| panic!("{config} has no counterpart")).1;
        let to_c = to_c.split_once("return c;").unwrap().0;
        for line in code[first + 1..].iter().take_while(|line| !line.starts_with('}')) {
            let member = line.trim_end_matches(';').split([' ', '*']).next_back().unwrap().split('[').next().unwrap();
            let is_set = ["c.", "c->"]
                .iter()
                .any(|c| to_c.contains(&format!("{c}{member} = ")) || to_c.contains(&format!("{c}{member}[i] = ")));
            assert!(is_set, "{config}::{member} is not set by swiftprox.hpp");
            count += 1;
        }
    }
    assert!(count > 40, "{count}");
}

#[test]
fn the_page_shows_the_example() {
    let page = include_str!("../../docs/cpp.md");
    let block = page
        .split_once("```cpp\n")
        .and_then(|(_, rest)| rest.split_once("```\n"))
        .expect("docs/cpp.md has a block of C++")
        .0;
    assert!(block == include_str!("../../examples/scene.cpp"), "docs/cpp.md and examples/scene.cpp differ");
}
