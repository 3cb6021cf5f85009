//! The committed headers are what cbindgen makes of the source today, in the order of include/contents.txt. They compile in every
//! standard of C and C++ that they promise, where compilers warn of what they should. `BLESS=1 cargo test --test header` rewrites
//! them.

use std::collections::{HashMap, HashSet};
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

/// The files that declare what C sees; cbindgen finds those of `ffi` by itself.
const SOURCES: [&str; 34] = [
    "src/body/tables/options.rs",
    "src/shape/levels/hierarchy/mod.rs",
    "src/shape/mod.rs",
    "src/answer/pair_answer.rs",
    "src/answer/config.rs",
    "src/depth/answer.rs",
    "src/pair/signed_distance.rs",
    "src/manifold/answer.rs",
    "src/pair/half_space.rs",
    "src/pair/gradient.rs",
    "src/ground/surface.rs",
    "src/ground/distance.rs",
    "src/ground/ray.rs",
    "src/ground/cast.rs",
    "src/ground/answer.rs",
    "src/motion/answer.rs",
    "src/motion/clearance.rs",
    "src/ray/query.rs",
    "src/ray/answer.rs",
    "src/point/answer.rs",
    "src/draw/target.rs",
    "src/compound/answer.rs",
    "src/compound/body.rs",
    "src/scene/world/object.rs",
    "src/scene/search/query.rs",
    "src/scene/search/statistics.rs",
    "src/scene/search/events.rs",
    "src/scene/search/listener.rs",
    "src/scene/sets/nearest.rs",
    "src/scene/sets/first_hit.rs",
    "src/scene/sets/rays.rs",
    "src/scene/sets/casts.rs",
    "src/scene/sets/grounds.rs",
    "src/scene/sets/scratch.rs",
];

/// What stands before the declarations of swiftprox.h.
const BEFORE: &str = "\
#include <math.h>
#include <stddef.h>
#include <stdint.h>

/**
 * Stands before functions whose status is not to be ignored: compilers warn. A cast to void silences the attribute of C23 and
 * C++17, and not that of GCC before: SWIFTPROX_IGNORE does so everywhere. A program that wants no such warnings defines this as
 * nothing.
 */
#ifndef SWIFTPROX_NODISCARD
#if (defined(__cplusplus) && __cplusplus >= 201703L) || (defined(__STDC_VERSION__) && __STDC_VERSION__ >= 202311L)
#define SWIFTPROX_NODISCARD [[nodiscard]]
#elif defined(__GNUC__)
#define SWIFTPROX_NODISCARD __attribute__((warn_unused_result))
#else
#define SWIFTPROX_NODISCARD
#endif
#endif

/** Makes a call and ignores its status on purpose, with no warning in any standard. */
#define SWIFTPROX_IGNORE(call) ((void)!(call))

/** What enums are made of: an int32_t, where the language lets them say so, else an int. Any number is safe to hand over. */
#ifndef SWIFTPROX_INT32
#if (defined(__cplusplus) && __cplusplus >= 201103L) || (defined(__STDC_VERSION__) && __STDC_VERSION__ >= 202311L)
#define SWIFTPROX_INT32 : int32_t
#else
#define SWIFTPROX_INT32
#endif
#endif
";

/// The head of a side header.
const SIDE_HEAD: &str = "\
/*
WHAT
 */

/* Generated from the Rust source by `BLESS=1 cargo test --test header`; do not edit. */
";

/// Enums that a compiler makes shorter (-fshort-enums) would not be what the library takes.
const BEHIND_STATUS: &str = "\
/** Does not compile where enums are not as large as an int32_t, as with -fshort-enums. */
typedef char swiftprox_enums_are_32_bits[sizeof(swiftprox_status) == 4 ? 1 : -1];
";

/// The id of no object: what C++ and C89 want otherwise.
const BEHIND_OBJECT_ID: &str = "\
/** Names no object. In C it is a compound literal of C99; swiftprox_object_id id = {0} does in every standard. */
#if defined(__cplusplus)
#define SWIFTPROX_OBJECT_ID_NULL (swiftprox_object_id())
#else
#define SWIFTPROX_OBJECT_ID_NULL ((swiftprox_object_id){0})
#endif
";

/// Marks of functions; the head of swiftprox.h says what they mean.
const STABLE: &str = "Stable.";
const EXPERIMENTAL: &str = "Experimental.";

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

/// The headers as they should be, by name.
fn generate() -> Vec<(String, String)> {
    let mut config = cbindgen::Config::from_file(root().join("cbindgen.toml")).expect("cbindgen.toml parses");
    let head = config.header.take().expect("a head");
    let names = config.export.rename.clone();
    let builder = cbindgen::Builder::new().with_config(config).with_src(root().join("src/ffi/mod.rs"));
    let builder = SOURCES.iter().fold(builder, |builder, source| builder.with_src(root().join(source)));
    let mut bytes = Vec::new();
    builder.generate().expect("cbindgen reads the source").write(&mut bytes);
    let text = String::from_utf8(bytes).expect("cbindgen writes UTF-8");
    let text = short_comments(&text).replace("/** The defaults, as in the header. */\n", "");
    let text = links(&text, &names).replace("SWIFTPROX_STATUS_", "SWIFTPROX_");
    let mut declared: HashMap<String, String> = HashMap::new();
    for declaration in declarations(&text) {
        declared.insert(name_of(&declaration), old_standards(&declaration));
    }
    let headers = laid_out(head.trim_start(), &mut declared);
    let forgotten: Vec<&String> = declared.keys().collect();
    assert!(forgotten.is_empty(), "include/contents.txt says no place for {forgotten:?}");
    headers.into_iter().map(|(name, text)| (name, ascii(&text))).collect()
}

/// The declarations with their comments.
fn declarations(text: &str) -> Vec<String> {
    let mut all = vec![String::new()];
    let mut depth = 0;
    for line in text.lines() {
        // An enum's brace opens behind what only C23 sees.
        if line.is_empty() && depth == 0 {
            all.push(String::new());
            continue;
        }
        let is_comment = line.trim_start().starts_with(['*', '/']);
        // A constant of C99's beside a struct, which C++ does not know.
        if !is_comment && !line.starts_with("#define swiftprox_") {
            depth += line.matches('{').count() as i32 - line.matches('}').count() as i32;
        }
        // The null id is written by hand; what cbindgen says of it is the comment alone.
        if !line.starts_with("#define swiftprox_") && line != "/** Names no object. */" {
            let last = all.last_mut().expect("the first is there");
            *last += line;
            last.push('\n');
        }
    }
    all.retain(|declaration| !declaration.is_empty());
    all
}

/// The name that a declaration declares.
fn name_of(declaration: &str) -> String {
    let line = declaration.lines().find(|line| !line.trim_start().starts_with(['*', '/'])).unwrap_or_default();
    let before = line.split_once("(*").map_or(line, |(_, name)| name.split(')').next().unwrap_or_default());
    let before = before.split('(').next().unwrap_or_default();
    let words: Vec<&str> = before.split_whitespace().collect();
    let name = match words[..] {
        ["typedef", "struct" | "enum", name, ..] | ["#define" | "enum", name, ..] | [.., name] => name,
        [] => panic!("no declaration: {declaration}"),
    };
    name.trim_start_matches('*').trim_end_matches(';').to_string()
}

/// The headers that the list of contents asks for.
fn laid_out(head: &str, declared: &mut HashMap<String, String>) -> Vec<(String, String)> {
    let contents = fs::read_to_string(root().join("include/contents.txt")).expect("the list of contents is there");
    let mut headers: Vec<(String, String)> = Vec::new();
    let mut is_open = false;
    let (mut mark, mut last) = ("", "");
    for line in contents.lines().filter(|line| !line.is_empty() && !line.starts_with('#')) {
        let (word, rest) = line.split_once(' ').unwrap_or((line, ""));
        match word {
            "header" => {
                close(headers.last_mut(), &mut is_open);
                let (name, what) = rest.split_once(' ').unwrap_or((rest, ""));
                let side = SIDE_HEAD.replace("WHAT", &head_of(what));
                let opening = if what.is_empty() {
                    guarded(head, name) + BEFORE + &format!("\n{}", external("{"))
                } else {
                    guarded(&side, name)
                };
                headers.push((name.to_string(), opening));
            }
            "default" => {
                let (_, text) = headers.last_mut().expect("a header before its declarations");
                *text += &format!("{}\n", default_of(last, rest));
            }
            "include" => {
                let (name, text) = headers.last_mut().expect("a header before what it includes");
                let near = match name.rsplit_once('/') {
                    Some((folder, _)) => {
                        rest.strip_prefix(&format!("{folder}/")).map_or(format!("../{rest}"), str::to_string)
                    }
                    None => rest.to_string(),
                };
                // One header may include several.
                let opened = format!("\n{}", external("{"));
                if let Some(before) = text.strip_suffix(&opened) {
                    *text = before.to_string();
                }
                *text += &format!("#include \"{near}\"\n{opened}");
            }
            "group" => {
                let (_, text) = headers.last_mut().expect("a header before its groups");
                *text += if is_open { "/** @} */\n\n" } else { "" };
                let words: Vec<&str> = rest.splitn(3, ' ').collect();
                let [name, word, title] = words[..] else { panic!("no name, mark and title: {line}") };
                mark = mark_of(word);
                *text += &format!("/**\n * @defgroup swiftprox_{name} {title}\n * @{{\n */\n\n");
                is_open = true;
            }
            _ => {
                let (_, text) = headers.last_mut().expect("a header before its declarations");
                last = line;
                let declaration = declared.remove(line).unwrap_or_else(|| panic!("{line} is not declared"));
                *text += &if is_function(&declaration) { marked(&declaration, mark) } else { declaration };
                text.push('\n');
                match line {
                    "swiftprox_status" => *text += &format!("{BEHIND_STATUS}\n"),
                    "swiftprox_object_id" => *text += &format!("{BEHIND_OBJECT_ID}\n"),
                    _ => {}
                }
            }
        }
    }
    close(headers.last_mut(), &mut is_open);
    headers
}

/// A head and the guard of a header.
fn guarded(head: &str, name: &str) -> String {
    let guard = name.to_uppercase().replace(['.', '/'], "_");
    format!("{head}\n#ifndef {guard}\n#define {guard}\n\n")
}

/// What a side header is for, in the lines of a comment.
fn head_of(what: &str) -> String {
    let mut lines = vec![" *".to_string()];
    for word in format!("swiftprox. {what} The conventions are those of swiftprox.h.").split(' ') {
        if lines.last().expect("the first is there").len() + word.len() >= 132 {
            lines.push(" *".to_string());
        }
        let last = lines.last_mut().expect("the first is there");
        *last += &format!(" {word}");
    }
    lines.join("\n")
}

/// The constant that a struct begins with. tests/project/layout.rs compares it with the library's defaults.
fn default_of(name: &str, members: &str) -> String {
    let define = format!("#define {}_DEFAULT", name.to_uppercase());
    let line = format!("{define} {{sizeof({name}), {members}}}");
    let line = if line.len() <= 132 { line } else { format!("{define} \\\n  {{sizeof({name}), {members}}}") };
    format!("/** Begins a {name}: the defaults. In C and C++, as an initialiser. */\n{line}\n")
}

/// What a function's comment says of its future.
fn mark_of(word: &str) -> &'static str {
    match word {
        "stable" => STABLE,
        "experimental" => EXPERIMENTAL,
        _ => panic!("{word} is neither stable nor experimental"),
    }
}

/// Members stand behind blanks, callbacks behind `typedef`.
fn is_function(declaration: &str) -> bool {
    let mut code = declaration.lines().filter(|line| !line.starts_with([' ', '*', '/', '#']));
    code.any(|line| !line.starts_with("typedef") && line.contains('('))
}

/// A function with its mark at the end of its comment.
fn marked(declaration: &str, mark: &str) -> String {
    let (comment, code) = declaration.split_once("*/\n").expect("a function has a comment");
    let comment = match comment.strip_prefix("/** ") {
        Some(line) => format!("/**\n * {line}\n"),
        None => comment.trim_end_matches(' ').to_string(),
    };
    format!("{} *\n * {mark}\n */\n{code}", comment.replace(" \n", "\n"))
}

/// Ends a header.
fn close(header: Option<&mut (String, String)>, is_open: &mut bool) {
    if let Some((_, text)) = header {
        *text += &format!("/** @}} */\n\n{}#endif\n", external("}"));
        *is_open = false;
    }
}

/// Opens or closes what C++ is told of as C's.
fn external(brace: &str) -> String {
    let line = if brace == "{" { "extern \"C\" {" } else { "}" };
    format!("#ifdef __cplusplus\n{line}\n#endif\n\n")
}

/// What C89 and C++98 want otherwise: enums without a comma behind the last enumerator, their size by a macro; no literal that
/// begins with a minus in a macro. Before a status the attribute.
fn old_standards(declaration: &str) -> String {
    let mut lines: Vec<String> = Vec::new();
    let mut skipping = false;
    let mut enum_name = "";
    for line in declaration.lines() {
        match line {
            // cbindgen's own ways to an enum's type are C23's, and an alias of an integer.
            _ if line.starts_with("#if __STDC_VERSION__") => skipping = true,
            _ if line.starts_with("#endif") => skipping = false,
            _ if skipping => {}
            _ if line.starts_with("enum ") => {
                enum_name = line.trim_start_matches("enum ");
                lines.push(format!("typedef enum {enum_name} SWIFTPROX_INT32 {{"));
            }
            " {" => {}
            "};" => {
                let last = lines.last_mut().expect("an enumerator");
                *last = last.trim_end_matches(',').to_string();
                lines.push(format!("}} {enum_name};"));
            }
            // What a sink refuses it remembers itself.
            _ if line.starts_with("swiftprox_status ") && !line.contains(" swiftprox_mesh_sink_") => {
                lines.extend(["SWIFTPROX_NODISCARD".to_string(), line.into()]);
            }
            _ if line.starts_with("#define ") && line.contains(" -") => lines.push(line.replace(" -", " (-") + ")"),
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

/// One of the headers.
fn header(name: &str) -> String {
    let (_, text) = generate().into_iter().find(|(other, _)| other == name).expect("a header of that name");
    text
}

#[test]
fn committed_headers_are_current() {
    for (name, expected) in generate() {
        let path = root().join("include").join(&name);
        if std::env::var_os("BLESS").is_some() {
            fs::write(&path, &expected).expect("the header can be written");
        }
        let committed = fs::read_to_string(&path).unwrap_or_default();
        let different = expected.lines().zip(committed.lines()).find(|(new, old)| new != old);
        assert!(
            expected == committed,
            "include/{name} is not what the source says (first difference: {different:?}); BLESS=1 cargo test --test header"
        );
    }
}

#[test]
fn version_macros_are_those_of_the_crate() {
    let header = header("swiftprox.h");
    for (name, value) in [
        ("MAJOR", env!("CARGO_PKG_VERSION_MAJOR")),
        ("MINOR", env!("CARGO_PKG_VERSION_MINOR")),
        ("PATCH", env!("CARGO_PKG_VERSION_PATCH")),
    ] {
        let line = format!("#define SWIFTPROX_VERSION_{name} {value}");
        assert!(header.lines().any(|l| l == line), "no line `{line}`");
    }
}

/// In its own comment, once; and of both kinds there are some.
#[test]
fn each_function_says_whether_it_is_stable() {
    let mut counts = HashMap::new();
    for (_, header) in generate() {
        let blocks = header.split("\n\n").filter(|block| block.starts_with("/**") && is_function(block));
        for block in blocks {
            let marks: Vec<&str> = block.lines().filter_map(|line| line.strip_prefix(" * ")).collect();
            let marks: Vec<&str> = marks.into_iter().filter(|line| [STABLE, EXPERIMENTAL].contains(line)).collect();
            let [mark] = marks[..] else { panic!("marked by {marks:?}: {block}") };
            *counts.entry(mark.to_string()).or_insert(0) += 1;
        }
    }
    assert!(counts[STABLE] > 80 && counts[EXPERIMENTAL] > 10, "{counts:?}");
}

/// All libraries share the names of C.
#[test]
fn every_name_begins_with_swiftprox() {
    let is_name = |c: char| c.is_ascii_alphanumeric() || c == '_';
    let mut count = 0;
    for (_, header) in generate() {
        for line in header.lines() {
            let declared = match line.split_whitespace().collect::<Vec<_>>()[..] {
                ["#define" | "struct" | "enum", name, ..] => Some(name),
                ["typedef", "struct" | "enum", name, ..] | ["typedef", .., name] | ["}", name] => Some(name),
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
    }
    assert!(count > 100, "{count} names");
}

// --- Compilers -----------------------------------------------------------------------------------------------------------

const COMPILERS: [(&str, &str, &[&str]); 4] = [
    ("gcc", "c", &["c89", "c99", "c11", "c17"]),
    ("clang", "c", &["c89", "c99", "c11"]),
    ("g++", "cpp", &["c++98", "c++11", "c++17", "c++20"]),
    ("clang++", "cpp", &["c++98", "c++17"]),
];

/// Calls `check` with each compiler, extension and standard. There must be a C and a C++ compiler, which `make test` installs; of
/// the others those that are here.
fn with_compilers(mut check: impl FnMut(&str, &str, &str)) {
    let mut tested = HashSet::new();
    for (compiler, extension, standards) in COMPILERS {
        if Command::new(compiler).arg("--version").output().is_err() {
            println!("{compiler} is not here: not tested");
            continue;
        }
        tested.insert(extension);
        for standard in standards {
            check(compiler, extension, standard);
        }
    }
    assert_eq!(tested.len(), 2, "no compiler for one of C and C++ is here");
}

/// A folder of a test's own, with the headers.
fn scratch(test: &str) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join(test);
    fs::create_dir_all(&folder).expect("the scratch folder can be written");
    fs::create_dir_all(folder.join("swiftprox")).expect("the scratch folder can be written");
    for (name, text) in generate() {
        fs::write(folder.join(name), text).expect("the scratch folder can be written");
    }
    folder
}

fn compile(folder: &Path, compiler: &str, extension: &str, standard: &str, source: &str) -> Output {
    let unit = folder.join(format!("{compiler}-{standard}.{extension}"));
    fs::write(&unit, source).expect("the scratch folder can be written");
    let mut command = Command::new(compiler);
    command.arg(format!("-std={standard}")).args(["-pedantic-errors", "-Wall", "-Wextra", "-Werror", "-c", "-I"]);
    // Not the syntax alone: gcc sees a status ignored only when it makes code.
    command.arg(folder).arg(&unit).arg("-o").arg(unit.with_extension("o")).output().expect("the compiler runs")
}

/// Alone, as the first that a program includes.
#[test]
fn each_header_compiles_alone() {
    let folder = scratch("alone");
    for (name, _) in generate() {
        // A unit without declarations is no unit in C.
        let source = format!("#include \"{name}\"\nextern int nothing;\n");
        with_compilers(|compiler, extension, standard| {
            let output = compile(&folder, compiler, extension, standard, &source);
            assert!(output.status.success(), "{name}, {compiler} -std={standard}: {output:?}");
        });
    }
}

/// Included twice, so that guards are seen to work. What `create` gives goes to every call as it is, and sizes are the program's.
#[test]
fn headers_compile_in_every_standard() {
    let folder = scratch("every-standard");
    let source = r#"
#include "swiftprox/tuning.h"
#include "swiftprox.h"
#include "swiftprox/scene.h"
#include "swiftprox.h"
#include "swiftprox/tuning.h"
swiftprox_status unit(swiftprox_scene *scene, const double *points);
swiftprox_status unit(swiftprox_scene *scene, const double *points)
{
    swiftprox_pair_cache cache = {{0}};
    swiftprox_object_id id = {0};
    swiftprox_shape_options options = SWIFTPROX_SHAPE_OPTIONS_DEFAULT;
    swiftprox_shape_tuning tuning = SWIFTPROX_SHAPE_TUNING_DEFAULT;
    swiftprox_pair_config config = SWIFTPROX_PAIR_CONFIG_DEFAULT;
    swiftprox_pair_answer answer;
    const swiftprox_shape *shape;
    swiftprox_placed object;
    swiftprox_status status;
    options.tuning = &tuning;
    status = swiftprox_shape_create_from_points(points, 4, &options, &shape);
    if (status == SWIFTPROX_OK) {
        status = swiftprox_scene_add_object(scene, &shape, 1, NULL, &id);
    }
    if (status == SWIFTPROX_OK) {
        status = swiftprox_scene_add_object(scene, &shape, 1, NULL, &id);
    }
    if (status == SWIFTPROX_OK) {
        status = swiftprox_scene_get_piece(scene, id, 0, &shape);
    }
    object.shape = shape;
    object.pose = points;
    if (status == SWIFTPROX_OK) {
        status = swiftprox_pair_distance(object, object, &cache, &config, &answer);
    }
    swiftprox_shape_release(shape);
    return status;
}
"#;
    with_compilers(|compiler, extension, standard| {
        let output = compile(&folder, compiler, extension, standard, source);
        assert!(output.status.success(), "{compiler} -std={standard}:\n{}", String::from_utf8_lossy(&output.stderr));
    });
}

/// A status that is ignored on purpose.
const IGNORED: &str = "SWIFTPROX_IGNORE(swiftprox_scene_set_pair_active(scene, 0, 0, 1));";

/// Each of these compiles no more, under usual warnings that are errors here.
#[test]
fn compilers_see_what_is_mixed_up_or_ignored() {
    let folder = scratch("mixed-up");
    for (what, line) in [
        ("a status ignored", "swiftprox_scene_set_pair_active(scene, 0, 0, 1);"),
        (
            "what decided, compared with a status",
            "return answer->decided_by == swiftprox_scene_set_pair_active(scene, 0, 0, 1);",
        ),
        ("what decided, compared with a status's name", "return answer->decided_by == SWIFTPROX_OK;"),
        ("an outcome, compared with what decided", "return answer->outcome == answer->decided_by;"),
        ("an id for a number", "return id == 0;"),
        ("a scene for a shape", "swiftprox_shape_release(scene);"),
    ] {
        let source = |line: &str| {
            format!(
                "#include \"swiftprox.h\"\n\
                 int unit(swiftprox_scene *scene, const swiftprox_pair_answer *answer, swiftprox_object_id id);\n\
                 int unit(swiftprox_scene *scene, const swiftprox_pair_answer *answer, swiftprox_object_id id)\n\
                 {{\n    {line}\n    return scene && answer && id.bits;\n}}\n"
            )
        };
        with_compilers(|compiler, extension, standard| {
            let sound = compile(&folder, compiler, extension, standard, &source(IGNORED));
            assert!(sound.status.success(), "{}", String::from_utf8_lossy(&sound.stderr));
            let output = compile(&folder, compiler, extension, standard, &source(line));
            // To clang's C an enumerator is an int and no more.
            let is_unseen = compiler == "clang" && line.ends_with("SWIFTPROX_OK;");
            assert!(is_unseen || !output.status.success(), "{compiler} -std={standard} takes {what}");
        });
    }
}
