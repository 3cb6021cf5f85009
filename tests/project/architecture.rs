//! The order of the code: `src/lib.rs` lists the folders, one for each stage, in the order of the data flow, and each `mod.rs` its
//! files. What stands in a folder uses only folders above it, a file only files above it, and `ARCHITECTURE.md` lists the same.

use std::fs;
use std::path::{Path, PathBuf};

/// Longer files do more than one thing.
const MOST_LINES: usize = 600;

fn read(path: impl AsRef<Path>) -> String {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(path);
    fs::read_to_string(&path).unwrap_or_else(|e| panic!("{}: {e}", path.display()))
}

/// The modules that a file declares, in order.
fn modules(path: impl AsRef<Path>) -> Vec<String> {
    let text = read(path);
    let (code, _for_tests) = text.split_once("#[cfg(test)]").unwrap_or((&text, ""));
    let module = |line: &str| {
        let declared = ["pub(crate) ", "pub "].iter().find_map(|public| line.strip_prefix(public)).unwrap_or(line);
        Some(declared.strip_prefix("mod ")?.strip_suffix(';')?.to_string())
    };
    code.lines().filter_map(module).collect()
}

fn folders() -> Vec<String> {
    let folders = modules("src/lib.rs");
    assert!(folders.len() > 8, "{folders:?}");
    folders
}

/// All source files below a folder.
fn files(folder: &Path) -> Vec<PathBuf> {
    let entries = fs::read_dir(folder).unwrap_or_else(|e| panic!("{}: {e}", folder.display()));
    let mut found = Vec::new();
    for path in entries.map(|entry| entry.unwrap().path()) {
        if path.is_dir() {
            found.extend(files(&path));
        } else {
            found.push(path);
        }
    }
    found.sort();
    found
}

fn source(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("src").join(name)
}

/// Calls `check` with the line's number and each path behind `before` in a file, without its tests.
fn for_each_path(file: &Path, before: &str, mut check: impl FnMut(usize, &str)) {
    let text = read(file);
    for (number, line) in text.lines().enumerate().take_while(|(_, line)| *line != "#[cfg(test)]") {
        for used in line.split(before).skip(1) {
            check(number + 1, used);
        }
    }
}

/// The first name of a path.
fn first(path: &str) -> &str {
    path.split(|c: char| !c.is_alphanumeric() && c != '_').next().unwrap()
}

#[test]
fn a_folder_uses_only_folders_above_it() {
    let folders = folders();
    for (place, folder) in folders.iter().enumerate() {
        for file in files(&source(folder)) {
            for_each_path(&file, "crate::", |line, path| {
                let above = folders[..=place].iter().any(|other| other == first(path));
                assert!(above, "{}:{line}: `{folder}` stands above `{}`", file.display(), first(path));
            });
        }
    }
}

#[test]
fn a_file_uses_only_files_of_its_folder_that_stand_above_it() {
    let mut folders = folders();
    while let Some(folder) = folders.pop() {
        let modules = modules(source(&folder).join("mod.rs"));
        for (place, module) in modules.iter().enumerate() {
            let nested = source(&folder).join(module);
            if nested.is_dir() {
                folders.push(format!("{folder}/{module}"));
            }
            let module_files =
                if nested.is_dir() { files(&nested) } else { vec![source(&folder).join(format!("{module}.rs"))] };
            for file in module_files {
                let own_folder = format!("crate::{}::", folder.replace('/', "::"));
                let check = |line: usize, path: &str| {
                    let below = modules[place + 1..].iter().any(|other| other == first(path));
                    assert!(!below, "{}:{line}: `{module}` stands above `{}`", file.display(), first(path));
                };
                for_each_path(&file, &own_folder, check);
                if !nested.is_dir() {
                    for_each_path(&file, "super::", check);
                }
            }
        }
    }
}

#[test]
fn modules_are_written_in_one_style_and_files_do_one_thing() {
    for folder in folders() {
        for file in files(&source(&folder)) {
            assert!(!file.with_extension("").is_dir(), "{}: beside a folder of its name", file.display());
            let lines = read(&file).lines().count();
            assert!(lines <= MOST_LINES, "{}: {lines} lines, at most {MOST_LINES}", file.display());
        }
        let opening = read(source(&folder).join("mod.rs"));
        assert!(opening.starts_with("//! "), "src/{folder}/mod.rs does not open with what it knows");
    }
}

#[test]
fn unsafe_code_is_in_ffi_and_simd_only() {
    for folder in folders().iter().filter(|folder| *folder != "ffi") {
        for file in files(&source(folder)).iter().filter(|file| !file.to_string_lossy().contains("/base/simd")) {
            for (number, line) in read(file).lines().enumerate() {
                let code = line.split("//").next().unwrap();
                let word = code.split(|c: char| !c.is_alphanumeric() && c != '_').find(|word| word.contains("unsafe"));
                assert!(word.is_none(), "{}:{}: {line}", file.display(), number + 1);
            }
        }
    }
}

#[test]
fn the_architecture_page_lists_the_folders_and_their_files_in_order() {
    let name = |row: &str| Some(row.strip_prefix("| `")?.split_once('`')?.0.to_string());
    let listed: Vec<String> = read("ARCHITECTURE.md").lines().filter_map(name).collect();
    let mut expected = Vec::new();
    for folder in folders() {
        expected.push(format!("{folder}/"));
        expected.extend(modules(source(&folder).join("mod.rs")).iter().map(|module| {
            let nested = source(&folder).join(module).is_dir();
            format!("{folder}/{module}{}", if nested { "/" } else { ".rs" })
        }));
    }
    assert_eq!(listed, expected);
}
