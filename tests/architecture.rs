//! `src/lib.rs` lists the modules in the order of the data flow, each file uses only files above it, and
//! `ARCHITECTURE.md` lists the same files in the same order.

use std::fs;
use std::path::{Path, PathBuf};

fn read(path: impl AsRef<Path>) -> String {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(path);
    fs::read_to_string(&path).unwrap_or_else(|e| panic!("{}: {e}", path.display()))
}

/// The modules of `src/lib.rs`, in order.
fn modules() -> Vec<String> {
    let lib = read("src/lib.rs");
    let (modules, _for_tests) = lib.split_once("#[cfg(test)]").unwrap_or((&lib, ""));
    let module = |line: &str| {
        let declared = line.strip_prefix("pub ").unwrap_or(line);
        Some(declared.strip_prefix("mod ")?.strip_suffix(';')?.to_string())
    };
    let modules: Vec<String> = modules.lines().filter_map(module).collect();
    assert!(modules.len() > 10, "{modules:?}");
    modules
}

fn source(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("src").join(name)
}

/// The source files of a module: `m.rs`, or those in `m/`, or both.
fn files(module: &str) -> Vec<PathBuf> {
    let own = source(&format!("{module}.rs"));
    let parts = fs::read_dir(source(module)).into_iter().flatten().map(|entry| entry.unwrap().path());
    parts.chain(own.exists().then_some(own)).collect()
}

#[test]
fn a_file_uses_only_files_above_it() {
    let modules = modules();
    for (place, module) in modules.iter().enumerate() {
        for file in files(module) {
            let text = read(&file);
            for (number, line) in text.lines().enumerate() {
                for used in line.split("crate::").skip(1) {
                    let name = used.split(|c: char| !c.is_alphanumeric() && c != '_').next().unwrap();
                    let above = modules[..=place].iter().any(|other| other == name);
                    assert!(above, "{}:{}: `{module}` stands above `{name}`", file.display(), number + 1);
                }
            }
        }
    }
}

#[test]
fn unsafe_code_is_in_ffi_and_simd_only() {
    for module in modules().iter().filter(|module| !["ffi", "simd"].contains(&module.as_str())) {
        for file in files(module) {
            for (number, line) in read(&file).lines().enumerate() {
                let code = line.split("//").next().unwrap();
                let word = code.split(|c: char| !c.is_alphanumeric() && c != '_').find(|word| word.contains("unsafe"));
                assert!(word.is_none(), "{}:{}: {line}", file.display(), number + 1);
            }
        }
    }
}

#[test]
fn the_architecture_page_lists_the_files_in_order() {
    let name = |row: &str| Some(row.strip_prefix("| `")?.split_once('`')?.0.to_string());
    let listed: Vec<String> = read("ARCHITECTURE.md").lines().filter_map(name).collect();
    let file =
        |module: &String| format!("{module}{}", if source(module).join("mod.rs").exists() { "/" } else { ".rs" });
    assert_eq!(listed, modules().iter().map(file).collect::<Vec<_>>());
}
