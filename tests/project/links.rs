//! Links of all pages lead somewhere.

use std::path::{Path, PathBuf};

/// README.md, ARCHITECTURE.md, and those of `docs`, `docs/research`, `benches` and `fuzz`.
fn pages() -> Vec<PathBuf> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let files = ["", "docs", "docs/research", "benches", "fuzz"]
        .iter()
        .flat_map(|folder| root.join(folder).read_dir().unwrap());
    files.map(|entry| entry.unwrap().path()).filter(|path| path.extension().is_some_and(|end| end == "md")).collect()
}

/// Every file that a page links to is there.
#[test]
fn links_lead_somewhere() {
    let mut count = 0;
    for page in pages() {
        let text = std::fs::read_to_string(&page).unwrap();
        let targets = text.split("](").skip(1).filter_map(|rest| rest.split_once(')')).map(|(target, _)| target);
        // Badges lead to the host of the repository, wherever that is.
        let is_elsewhere = |target: &&str| target.starts_with("http") || target.starts_with("../../actions/workflows/");
        for target in targets.filter(|target| !is_elsewhere(target)) {
            let file = target.split_once('#').map_or(target, |(file, _)| file);
            assert!(page.with_file_name(file).exists(), "{} links to {target}, which is not there", page.display());
            count += 1;
        }
    }
    assert!(count > 50, "{count}");
}
