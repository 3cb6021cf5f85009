//! The C headers, in the order of include/contents.txt.

use std::fs;
use std::path::Path;

/// The text of each.
pub fn headers() -> Vec<String> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("include");
    let contents = fs::read_to_string(folder.join("contents.txt")).expect("the list of contents is there");
    let names = contents.lines().filter_map(|line| line.strip_prefix("header ")?.split(' ').next());
    names.map(|name| fs::read_to_string(folder.join(name)).expect(name)).collect()
}
