//! The order of the code: `src/lib.rs` lists the folders, one for each stage, in the order of the data flow, and each `mod.rs` its
//! files. What stands in a folder uses only folders above it, a file only files above it, and `ARCHITECTURE.md` lists the same.

use std::fs;
use std::path::{Path, PathBuf};

pub fn read(path: impl AsRef<Path>) -> String {
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
pub fn files(folder: &Path) -> Vec<PathBuf> {
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

pub fn source(name: &str) -> PathBuf {
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

/// All folders with files of their own, each with its `mod.rs`.
fn all_folders() -> Vec<String> {
    let mut found = Vec::new();
    let mut open = folders();
    while let Some(folder) = open.pop() {
        let nested = |module: &String| source(&folder).join(module).is_dir();
        open.extend(
            modules(source(&folder).join("mod.rs")).iter().filter(|m| nested(m)).map(|m| format!("{folder}/{m}")),
        );
        found.push(folder);
    }
    found
}

/// Whatever way it names them: `crate::`, `super::`, in braces, or by a name that `mod.rs` passes on. What stands in `mod.rs`
/// itself is used only by files that it does not use.
#[test]
fn a_file_uses_only_files_of_its_folder_that_stand_above_it() {
    let mut found = Vec::new();
    for folder in all_folders() {
        let modules = modules(source(&folder).join("mod.rs"));
        let (_, used) = passed_on_and_used(&folder, &modules);
        let place = |module: &str| modules.iter().position(|other| other == module);
        for (from, to, file) in graph(&folder) {
            let goes_up = match (place(&from), place(&to)) {
                (Some(from), Some(to)) => from < to,
                (Some(_), None) => used.contains(&from),
                (None, _) => false,
            };
            if goes_up {
                found.push(format!("{}: `{from}` uses `{to}`, which stands below it in `{folder}`", file.display()));
            }
        }
    }
    found.dedup();
    assert!(found.is_empty(), "{}", found.join("\n"));
}

#[test]
fn modules_are_written_in_one_style() {
    for folder in folders() {
        for file in files(&source(&folder)) {
            assert!(!file.with_extension("").is_dir(), "{}: beside a folder of its name", file.display());
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

// --- Imports between the files of a folder ---------------------------------------------------------------------------------------

/// Where a file uses a path: both from the root of the crate.
struct Import {
    file: PathBuf,
    /// The module that the file is.
    from: Vec<String>,
    to: Vec<String>,
}

/// The module that a source file is: `scene/near/mod.rs` is `scene::near`.
fn module_of(file: &Path) -> Vec<String> {
    let relative = file.strip_prefix(source("")).unwrap().with_extension("");
    let mut module: Vec<String> = relative.iter().map(|part| part.to_str().unwrap().to_string()).collect();
    module.pop_if(|last| last == "mod");
    module
}

/// The code of a file without comments, without its tests, and without imports for the documentation alone.
fn code(file: &Path) -> String {
    let text = read(file);
    let mut is_for_docs = false;
    let lines = text.lines().take_while(|line| *line != "#[cfg(test)]").filter(|line| {
        let skips = is_for_docs || line.trim_start().starts_with("//") || *line == "#[cfg(doc)]";
        // It goes on until the statement ends.
        is_for_docs = *line == "#[cfg(doc)]" || is_for_docs && !line.ends_with(';');
        !skips
    });
    lines.collect::<Vec<_>>().join("\n")
}

/// All paths that a piece of code begins with: of `{a, b::c}` two.
fn paths(code: &str) -> Vec<Vec<String>> {
    let code = code.trim_start();
    if let Some(mut group) = code.strip_prefix('{') {
        let mut found = Vec::new();
        loop {
            found.extend(paths(group));
            let mut depth = 0;
            let end = group.find(|c: char| {
                depth += i32::from(c == '{') - i32::from(c == '}');
                depth < 0 || depth == 0 && c == ','
            });
            match end.map(|end| group.split_at(end)) {
                Some((_, rest)) if rest.starts_with(',') => group = rest[1..].trim_start(),
                _ => return found,
            }
        }
    }
    let name = first(code);
    if name.is_empty() {
        return Vec::new();
    }
    let behind = code[name.len()..].strip_prefix("::").map(paths).unwrap_or_default();
    let joined = |path: Vec<String>| [vec![name.to_string()], path].concat();
    if behind.is_empty() { vec![joined(Vec::new())] } else { behind.into_iter().map(joined).collect() }
}

/// All imports below a folder, by `crate::`, `super::` and `self::`.
fn imports(folder: &Path) -> Vec<Import> {
    let mut found = Vec::new();
    for file in files(folder) {
        let (from, code) = (module_of(&file), code(&file));
        for start in ["crate::", "super::", "self::"] {
            for (at, _) in code.match_indices(start) {
                if code[..at].ends_with(|c: char| c.is_alphanumeric() || c == '_' || c == ':') {
                    continue;
                }
                for path in paths(&code[at..]) {
                    let mut to = if path[0] == "crate" { Vec::new() } else { from.clone() };
                    for name in &path {
                        match name.as_str() {
                            "crate" | "self" => {}
                            "super" => drop(to.pop()),
                            name => to.push(name.to_string()),
                        }
                    }
                    found.push(Import { file: file.clone(), from: from.clone(), to });
                }
            }
        }
    }
    found
}

/// The names that a folder's `mod.rs` passes on, each with the file or folder that has it; and of which files it uses something.
fn passed_on_and_used(folder: &str, modules: &[String]) -> (Vec<(String, String)>, Vec<String>) {
    let (mut passed_on, mut used) = (Vec::new(), Vec::new());
    let code = code(&source(folder).join("mod.rs"));
    for statement in code.split_inclusive([';', '}']) {
        let Some((before, path)) = statement.split_once("use ") else { continue };
        for path in paths(path) {
            let inside: Vec<&String> = path.iter().skip_while(|name| !modules.contains(name)).collect();
            match inside[..] {
                [module, .., name] if before.trim_start().starts_with("pub") => {
                    passed_on.push((name.clone(), module.clone()));
                }
                [module, ..] => used.push(module.clone()),
                [] => {}
            }
        }
    }
    (passed_on, used)
}

/// Between the files and folders of a folder: who uses whom, where; `mod` is the folder's own file.
fn graph(folder: &str) -> Vec<(String, String, PathBuf)> {
    let modules = modules(source(folder).join("mod.rs"));
    let (passed_on, _) = passed_on_and_used(folder, &modules);
    let own: Vec<String> = folder.split('/').map(str::to_string).collect();
    let inside = |path: &[String]| path.strip_prefix(&own[..]).and_then(|rest| rest.first()).cloned();
    let mut graph = Vec::new();
    for Import { file, from, to } in imports(&source(folder)) {
        let Some(from) = inside(&from) else { continue };
        if let Some(to) = inside(&to) {
            let known = passed_on.iter().find(|(name, _)| *name == to).map(|(_, module)| module.clone());
            let to = if modules.contains(&to) { to } else { known.unwrap_or("mod".into()) };
            if from != to {
                graph.push((from, to, file));
            }
        }
    }
    graph
}

/// Where integers get no memory a panic says that an option is unwrapped (`base/memory.rs`): so nothing else may say that.
#[test]
fn no_option_is_unwrapped() {
    for file in files(&source("")) {
        for_each_path(&file, ".unwrap()", |line, _| panic!("{}, line {line}: an option is unwrapped", file.display()));
    }
}
