//! Tapes as committed, and what is counted on them. `BLESS=1 cargo test --package proofs` writes the tapes and the table of
//! docs/proofs.md anew.

use std::fs;
use std::path::{Path, PathBuf};

use proofs::kernels::all;
use proofs::library::U;
use proofs::rows::{check, rows};

fn path(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join(name)
}

fn is_to_be_blessed() -> bool {
    std::env::var_os("BLESS").is_some()
}

/// Who changes a kernel or a constant of a bound changes a tape: the proofs are of the new one then, if they still hold.
#[test]
fn tapes_are_as_committed() {
    let kernels = all();
    let mut names: Vec<String> = kernels.iter().map(|kernel| format!("{}.tape", kernel.name)).collect();
    names.sort();
    for kernel in &kernels {
        let (path, text) = (path(&format!("tapes/{}.tape", kernel.name)), kernel.print());
        if is_to_be_blessed() {
            fs::write(&path, &text).unwrap();
        }
        let committed = fs::read_to_string(&path).unwrap_or_default();
        assert!(committed == text, "{}: the code computes something else now, see docs/proofs.md", kernel.name);
    }
    let entries = fs::read_dir(path("tapes")).unwrap();
    let mut found: Vec<String> = entries.map(|entry| entry.unwrap().file_name().into_string().unwrap()).collect();
    found.sort();
    assert_eq!(found, names);
}

#[test]
fn bounds_cover_what_is_counted() {
    check(&all()).unwrap();
}

/// The least that each constant may be made less by is noticed, without any tape to compare with: the enclosure's 12u, the
/// interval's 8u, the sizes' 6.5u of a difference, the planes' 10u, segments' 17u, 12u and 15u, points' 7u, balls' 42u and 8u.
#[test]
fn constants_that_are_too_small_are_found() {
    let mutants = [
        ("determinant_error", 12.0 * U, 6.0 * U),
        ("interval", 8.0 * U, 7.0 * U),
        ("interval", 1.0 + 4.0 * U, 1.0 + 2.0 * U),
        ("bounds", 6.5, 6.0),
        ("bounds", 10.0 * U, 7.0 * U),
        ("determinant_error", 1.0 + 16.0 * U, 1.0 + 4.0 * U),
        ("round_ends", 17.0, 16.0),
        ("round_ends", 12.0, 11.0),
        ("round_ends", 15.0, 14.0),
        ("round_ends", 7.0 * U, 6.0 * U),
        ("balls", 1.0 - 42.0 * U, 1.0 - 39.0 * U),
        ("balls", 8.0 * U, 7.0 * U),
    ];
    for (name, constant, other) in mutants {
        let mut kernels = all();
        let kernel = kernels.iter_mut().find(|kernel| kernel.name == name).unwrap();
        assert!(kernel.tape.replace_constant(constant, other) > 0, "{name} has no {constant:e}");
        assert!(check(&kernels).is_err(), "{name}: {constant:e} may be {other:e}");
    }
}

/// The page's table is what is proved.
#[test]
fn the_page_says_what_is_proved() {
    const ENDS: [&str; 2] = ["<!-- rows -->\n", "<!-- end of rows -->"];
    let mut table = "| where | what, in u of it | claimed | proved | by |\n|---|---|--:|--:|---|\n".to_string();
    for row in rows(&all()) {
        table += &format!("| {} | {} | {:.2} | {:.2} | {} |\n", row.place, row.what, row.claimed, row.proved, row.how);
    }
    let page = path("../docs/proofs.md");
    let text = fs::read_to_string(&page).unwrap();
    let (head, rest) = text.split_once(ENDS[0]).unwrap();
    let (found, tail) = rest.split_once(ENDS[1]).unwrap();
    if is_to_be_blessed() {
        fs::write(&page, [head, ENDS[0], &table, ENDS[1], tail].concat()).unwrap();
    } else {
        assert_eq!(found, table);
    }
}
