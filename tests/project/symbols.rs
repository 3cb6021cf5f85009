//! What the shared library exports: functions of our nouns under our own prefix (`swift_` is that of the Swift language's runtime,
//! which may live in the same process), and nothing else. Needs `nm`, which `make test` installs.

use crate::headers::headers;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

/// The nouns of the C interface.
const NOUNS: [&str; 17] = [
    "library",
    "compound",
    "mesh",
    "shape",
    "pose",
    "pair",
    "ground",
    "replay",
    "depth",
    "manifold",
    "motion",
    "cast",
    "clearance",
    "object",
    "scene",
    "scratch",
    "listener",
];

/// The shared library that this test run built, beside the test.
fn library() -> PathBuf {
    std::env::current_exe().expect("a test knows where it is").with_file_name("libswiftprox.so")
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
    let header = headers().concat();
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
    for line in headers().concat().lines().filter(|line| !line.starts_with([' ', '#', '/'])) {
        let declaration = line.split_once('(').map_or("", |(declaration, _)| declaration);
        let name = declaration.split([' ', '*']).next_back().unwrap_or_default();
        if name.starts_with("swiftprox_") && !declaration.starts_with("typedef") {
            assert!(exports.iter().any(|export| export == name), "{name} is not exported");
            count += 1;
        }
    }
    assert_eq!(count, exports.len());
}

/// What Debian's tools derive dependencies from. A symbol keeps the version that it came with.
#[test]
#[cfg_attr(not(target_os = "linux"), ignore = "shared libraries of Linux")]
fn the_symbols_of_the_debian_package_are_those_exported() {
    let name = format!("libswiftprox{}", so_version());
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("packaging/debian/{name}.symbols"));
    let committed = fs::read_to_string(&path).unwrap_or_default();
    let mut exports = exports();
    exports.sort();
    let mut expected =
        format!("libswiftprox.so.{} {name} #MINVER#\n* Build-Depends-Package: libswiftprox-dev\n", so_version());
    for export in exports {
        let since = committed.lines().find_map(|line| line.strip_prefix(&format!(" {export}@Base ")));
        expected += &format!(" {export}@Base {}\n", since.unwrap_or(env!("CARGO_PKG_VERSION")));
    }
    if std::env::var_os("BLESS").is_some() {
        fs::write(&path, &expected).unwrap();
        return;
    }
    assert!(
        expected == committed,
        "{} is not what is exported; BLESS=1 cargo test --test project symbols",
        path.display()
    );
    let control = include_str!("../../packaging/debian/control");
    assert!(control.contains(&format!("Package: {name}\n")), "packaging/debian/control has no package {name}");
}

/// The version in the shared library's name; build.rs sets it.
fn so_version() -> String {
    match (env!("CARGO_PKG_VERSION_MAJOR"), env!("CARGO_PKG_VERSION_MINOR")) {
        ("0", minor) => format!("0.{minor}"),
        (major, _) => major.to_string(),
    }
}
