//! Every committed input of every fuzz target, without libFuzzer: the same inputs everywhere.

use std::fs;
use std::panic::{AssertUnwindSafe, catch_unwind, resume_unwind};
use std::path::Path;

use swiftprox_fuzz::targets;

/// Runs the inputs of a target's corpus in the order of their names; a failure names its file.
fn run_corpus(target: &str, run: fn(&[u8])) {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("corpus").join(target);
    let mut files: Vec<_> = fs::read_dir(&folder).unwrap().map(|entry| entry.unwrap().path()).collect();
    files.sort();
    assert!(!files.is_empty(), "no inputs in {}", folder.display());
    for file in &files {
        let bytes = fs::read(file).unwrap();
        if let Err(panic) = catch_unwind(AssertUnwindSafe(|| run(&bytes))) {
            eprintln!("{target} fails on {}", file.display());
            resume_unwind(panic);
        }
    }
}

macro_rules! corpora {
    ($($target:ident)*) => {
        $(
            #[test]
            fn $target() {
                run_corpus(stringify!($target), targets::$target::run);
            }
        )*

        /// A corpus without a target would be run by nobody.
        #[test]
        fn every_corpus_has_its_target() {
            let mut folders: Vec<_> = fs::read_dir(Path::new(env!("CARGO_MANIFEST_DIR")).join("corpus"))
                .unwrap()
                .map(|entry| entry.unwrap().file_name().into_string().unwrap())
                .collect();
            folders.sort();
            assert_eq!(folders, [$(stringify!($target)),*]);
        }
    };
}

corpora! { c_calls casts compounds grounds hull mesh_readers pairs rays recordings shape_files swept }
