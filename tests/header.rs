//! The committed header is what cbindgen makes of the source today, and it compiles in every standard of C and C++ that it
//! promises. `BLESS=1 cargo test --test header` rewrites it.

use std::collections::{HashMap, HashSet};
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

/// The files that declare what C sees; cbindgen finds those of `ffi` by itself.
const SOURCES: [&str; 10] = [
    "src/tables/options.rs",
    "src/levels/hierarchy/mod.rs",
    "src/shape/mod.rs",
    "src/pair/descent.rs",
    "src/pair/answer.rs",
    "src/pair/cache.rs",
    "src/pair/config.rs",
    "src/scene/object.rs",
    "src/scene/mod.rs",
    "src/ffi/mod.rs",
];

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

fn header_path() -> PathBuf {
    root().join("include/swiftprox.h")
}

/// The header as it should be.
fn generate() -> String {
    let config = cbindgen::Config::from_file(root().join("cbindgen.toml")).expect("cbindgen.toml parses");
    let names = config.export.rename.clone();
    let builder = cbindgen::Builder::new().with_config(config);
    let builder = SOURCES.iter().fold(builder, |builder, source| builder.with_src(root().join(source)));
    let mut bytes = Vec::new();
    builder.generate().expect("cbindgen reads the source").write(&mut bytes);
    let text = String::from_utf8(bytes).expect("cbindgen writes UTF-8");
    let text = old_standards(&text);
    let text =
        text.replace("SWIFTPROX_STATUS_", "SWIFTPROX_").replace("swiftprox_object_id_NULL", "SWIFTPROX_OBJECT_ID_NULL");
    ascii(&links(&short_comments(&text), &names))
}

/// What C89 and C++98 want otherwise: enumerators in anonymous enums beside an `int32_t` of the enum's name, no comma behind
/// the last of them, `extern "C"` without C++11, no `//`.
fn old_standards(text: &str) -> String {
    let mut lines: Vec<String> = Vec::new();
    let mut skipping = false;
    for line in text.lines() {
        match line {
            // Of its two forms of an enum's type cbindgen's last one is C99's.
            _ if line.starts_with("#if __STDC_VERSION__") => skipping = true,
            _ if line == "#else" || line.starts_with("#endif // __STDC_VERSION__") => skipping = false,
            _ if skipping => {}
            _ if line.starts_with("enum ") => lines.push("enum {".into()),
            " {" => {}
            "};" => {
                let last = lines.last_mut().expect("an enumerator");
                *last = last.trim_end_matches(',').to_string();
                lines.push(line.into());
            }
            "#include <stdint.h>" => {
                lines.extend([line, "", "#ifdef __cplusplus", "extern \"C\" {", "#endif"].map(String::from));
            }
            _ if line.starts_with("#endif  /*") => {
                lines.extend(["#ifdef __cplusplus", "}", "#endif", "", "#endif"].map(String::from));
            }
            _ => lines.push(line.into()),
        }
    }
    lines.join("\n") + "\n"
}

/// Comments of one line on one line.
fn short_comments(text: &str) -> String {
    let lines: Vec<&str> = text.lines().collect();
    let mut out = String::new();
    let mut i = 0;
    while i < lines.len() {
        if lines[i].trim() == "/**" && i + 2 < lines.len() && lines[i + 2].trim() == "*/" {
            out += lines[i];
            out += lines[i + 1].trim().trim_start_matches('*');
            out += " */";
            i += 3;
        } else {
            out += lines[i];
            i += 1;
        }
        out += "\n";
    }
    out
}

/// Rust's links, [`Type::member`], under the names that C knows.
fn links(text: &str, names: &HashMap<String, String>) -> String {
    let mut out = String::new();
    let mut rest = text;
    while let Some((before, link)) = rest.split_once("[`") {
        let (link, after) = link.split_once("`]").expect("a link ends");
        let (owner, member) = link.split_once("::").unwrap_or((link, ""));
        let owner = names.get(owner).unwrap_or_else(|| panic!("[`{link}`] has no name in cbindgen.toml"));
        out += before;
        out += &match member.chars().next() {
            None => owner.clone(),
            Some(first) if first.is_lowercase() => format!("{owner}_{member}"),
            Some(_) => format!("{owner}_{}", screaming(member)).to_uppercase(),
        };
        rest = after;
    }
    out + rest
}

/// `SomeName` or `SOME_NAME` with its words parted.
fn screaming(name: &str) -> String {
    let mut out = String::new();
    let mut last = '_';
    for c in name.chars() {
        if c.is_uppercase() && last.is_lowercase() {
            out.push('_');
        }
        out.push(c);
        last = c;
    }
    out
}

/// Some compilers read headers in the code page of the day.
fn ascii(text: &str) -> String {
    let plain = [
        ('≤', "<="),
        ('≥', ">="),
        ('∞', "infinity"),
        ('ᵀ', "^T "),
        ('−', "-"),
        ('·', "*"),
        ('…', "..."),
        ('–', "-"),
        ('²', "^2"),
    ];
    let text = plain.iter().fold(text.to_string(), |text, (from, to)| text.replace(*from, to));
    if let Some(line) = text.lines().find(|line| !line.is_ascii()) {
        panic!("the header must be plain ASCII: {line}");
    }
    text
}

#[test]
fn committed_header_is_current() {
    let expected = generate();
    if std::env::var_os("BLESS").is_some() {
        fs::write(header_path(), &expected).expect("the header can be written");
    }
    let committed = fs::read_to_string(header_path()).unwrap_or_default();
    let different = expected.lines().zip(committed.lines()).find(|(new, old)| new != old);
    assert!(
        expected == committed,
        "include/swiftprox.h is not what the source says (first difference: {different:?}); BLESS=1 cargo test --test header"
    );
}

#[test]
fn version_macros_are_those_of_the_crate() {
    for (name, value) in [
        ("MAJOR", env!("CARGO_PKG_VERSION_MAJOR")),
        ("MINOR", env!("CARGO_PKG_VERSION_MINOR")),
        ("PATCH", env!("CARGO_PKG_VERSION_PATCH")),
    ] {
        let line = format!("#define SWIFTPROX_VERSION_{name} {value}");
        assert!(generate().lines().any(|l| l == line), "no line `{line}`");
    }
}

/// All libraries share the names of C.
#[test]
fn every_name_begins_with_swiftprox() {
    let header = generate();
    let is_name = |c: char| c.is_ascii_alphanumeric() || c == '_';
    let mut count = 0;
    for line in header.lines() {
        let declared = match line.split_whitespace().collect::<Vec<_>>()[..] {
            ["#define" | "struct" | "enum", name, ..] => Some(name),
            ["typedef", .., name] | ["}", name] => Some(name),
            // Enumerators stand at two blanks with a value.
            [name, "=", ..] if line.starts_with("  ") => Some(name),
            _ => None,
        };
        let Some(name) = declared.map(|name| name.trim_end_matches(|c| !is_name(c))) else { continue };
        // The last word of a function type is an argument, that of an opening brace nothing.
        if !name.is_empty() && !line.contains('(') {
            assert!(name.to_lowercase().starts_with("swiftprox"), "{line}");
            count += 1;
        }
    }
    assert!(count > 100, "{count} names");
}

/// Included twice, so that its guard is seen to work. There must be a C and a C++ compiler, which `make test` installs; of the
/// others those that are here.
#[test]
fn header_compiles_in_every_standard() {
    let source = "#include \"swiftprox.h\"\n#include \"swiftprox.h\"\nint unit(void);\n\
                  int unit(void) { swiftprox_pair_cache cache = {{0}}; return (int)cache.words[0] + SWIFTPROX_OK; }\n";
    let scratch = Path::new(env!("CARGO_TARGET_TMPDIR"));
    fs::write(scratch.join("swiftprox.h"), generate()).expect("the scratch folder can be written");
    let mut tested = HashSet::new();
    for (compiler, extension, standards) in [
        ("gcc", "c", &["c89", "c99", "c11", "c17"][..]),
        ("clang", "c", &["c89", "c99", "c11"]),
        ("g++", "cpp", &["c++98", "c++11", "c++17", "c++20"]),
        ("clang++", "cpp", &["c++98", "c++17"]),
    ] {
        if Command::new(compiler).arg("--version").output().is_err() {
            println!("{compiler} is not here: not tested");
            continue;
        }
        tested.insert(extension);
        for standard in standards {
            let unit = scratch.join(format!("header-{compiler}-{standard}.{extension}"));
            fs::write(&unit, source).expect("as above");
            let output = Command::new(compiler)
                .arg(format!("-std={standard}"))
                .args(["-pedantic-errors", "-Wall", "-Wextra", "-Werror", "-fsyntax-only", "-I"])
                .arg(scratch)
                .arg(&unit)
                .output()
                .expect("the compiler runs");
            let messages = String::from_utf8_lossy(&output.stderr);
            assert!(output.status.success(), "{compiler} -std={standard}:\n{messages}");
        }
    }
    assert_eq!(tested.len(), 2, "no compiler for one of C and C++ is here");
}
