//! What the shared library exports: functions of our nouns under our own prefix (`swift_` is that of the Swift language's runtime,
//! which may live in the same process), and nothing else. Needs `nm`, which `make test` installs.

use std::path::PathBuf;
use std::process::Command;

/// The nouns of the C interface.
const NOUNS: [&str; 12] = [
    "library",
    "mesh",
    "shape",
    "pair",
    "replay",
    "depth",
    "manifold",
    "motion",
    "cast",
    "clearance",
    "object",
    "scene",
];

/// The shared library that this test run built, beside the test.
fn library() -> PathBuf {
    std::env::current_exe().expect("a test knows where it is").with_file_name("libswiftprox.so")
}

/// What a program includes.
fn headers() -> String {
    [include_str!("../../include/swiftprox.h"), include_str!("../../include/swiftprox_tuning.h")].concat()
}

/// Names of the dynamic symbols that are defined.
fn exports() -> Vec<String> {
    let output = Command::new("nm").args(["-D", "--defined-only"]).arg(library()).output();
    let output = output.expect("nm is installed (Debian: binutils)");
    assert!(output.status.success(), "nm: {}", String::from_utf8_lossy(&output.stderr));
    let text = String::from_utf8(output.stdout).expect("symbols are plain");
    text.lines().filter_map(|line| line.split_whitespace().last()).map(str::to_string).collect()
}

#[test]
#[cfg_attr(not(target_os = "linux"), ignore = "shared libraries of Linux")]
fn only_functions_of_our_nouns_are_exported() {
    let exports = exports();
    let header = headers();
    assert!(exports.len() > 30, "{exports:?}");
    for name in exports {
        let word = name.strip_prefix("swiftprox_").unwrap_or_else(|| panic!("{name} is exported without the prefix"));
        let noun = word.split('_').next().unwrap_or_default();
        assert!(NOUNS.contains(&noun), "{name}: `{noun}` is no noun of the interface");
        assert!(header.contains(&format!("{name}(")), "{name} is exported and not in the header");
    }
}

#[test]
#[cfg_attr(not(target_os = "linux"), ignore = "shared libraries of Linux")]
fn every_function_of_the_header_is_exported() {
    let exports = exports();
    let mut count = 0;
    for line in headers().lines().filter(|line| !line.starts_with([' ', '#', '/'])) {
        let declaration = line.split_once('(').map_or("", |(declaration, _)| declaration);
        let name = declaration.split([' ', '*']).next_back().unwrap_or_default();
        if name.starts_with("swiftprox_") && !declaration.starts_with("typedef") {
            assert!(exports.iter().any(|export| export == name), "{name} is not exported");
            count += 1;
        }
    }
    assert_eq!(count, exports.len());
}
