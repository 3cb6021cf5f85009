//! Prints tables of the levels of detail of the benchmark's bodies: triangles, edges, deviation, bytes and build time of each kind.
//!
//! `cargo run --release --example levels -- [--paper] [VERTICES ...]`; docs/research/levels.md sums up its output. With `--paper`
//! the settings of the figures of Ehmann & Lin 2000 rather than the default ones.

use std::time::Instant;

use swiftprox::body::build::assembly::build;
use swiftprox::body::polyhedron::Polyhedron;
use swiftprox::hierarchy::{Hierarchy, HierarchyKind, HierarchyOptions};
use swiftprox::progress::Progress;
use testkit::models::{ELLIPSOIDS, ellipsoid};

const KINDS: [(HierarchyKind, &str); 3] = [
    (HierarchyKind::Quadric, "quadric"),
    (HierarchyKind::DobkinKirkpatrick, "Dobkin-Kirkpatrick"),
    (HierarchyKind::OuterCuts, "outer cuts"),
];

fn main() {
    let (flags, counts): (Vec<String>, Vec<String>) = std::env::args().skip(1).partition(|word| word.starts_with("--"));
    let counts: Vec<usize> = counts.iter().map(|n| n.parse().expect("a number of vertices")).collect();
    match flags.iter().map(String::as_str).collect::<Vec<_>>()[..] {
        [] => print_kinds(if counts.is_empty() { &[1002, 10002] } else { &counts }),
        ["--paper"] => print_settings(if counts.is_empty() { &[1002] } else { &counts }),
        _ => panic!("no such option: {flags:?}"),
    }
}

/// All kinds with the default options.
fn print_kinds(counts: &[usize]) {
    println!(
        "| body | kind | level: triangles / edges / deviation (of the radius) | bytes, of the body's | build, ms |"
    );
    println!("|---|---|---|--:|--:|");
    for &n in counts {
        for (name, half_axes) in ELLIPSOIDS {
            let mesh = ellipsoid(half_axes, n).expect("an ellipsoid");
            let points = &mesh.vertices;
            let (body, own) = least_time(|| build(points, None).expect("a hull"));
            let triangles = body.triangles.len();
            println!("| {name} {n} | — | {triangles} / {} / 0 | {} | {own:.1} |", body.edges.len(), body.heap_bytes());
            for (kind, kind_name) in KINDS {
                let options = HierarchyOptions { kind, ..HierarchyOptions::default() };
                print_row(&format!("{name} {n}"), &body, &options, kind_name);
            }
        }
    }
}

/// Decimation rates by quadric error and by outer cuts (figures 9 and 10), and Dobkin and Kirkpatrick's cut-offs (7 and 8: of those
/// only 100 can be read).
fn print_settings(counts: &[usize]) {
    println!(
        "| body | kind, setting | level: triangles / edges / deviation (of the radius) | bytes, of the body's | build, ms |"
    );
    println!("|---|---|---|--:|--:|");
    for &n in counts {
        for (name, half_axes) in ELLIPSOIDS {
            let body = build(&ellipsoid(half_axes, n).expect("an ellipsoid").vertices, None).expect("a hull");
            for (kind, kind_name) in KINDS {
                let cut_off = |minimum_triangles| HierarchyOptions { kind, minimum_triangles, ..Default::default() };
                let rate = |decimation| HierarchyOptions { kind, decimation, ..Default::default() };
                if kind == HierarchyKind::DobkinKirkpatrick {
                    for minimum in [4, 20, 50, 100, 250] {
                        print_row(&format!("{name} {n}"), &body, &cut_off(minimum), &format!("{kind_name} {minimum}"));
                    }
                } else {
                    for decimation in [0.5, 0.25, 0.125, 0.0625, 0.03125] {
                        print_row(
                            &format!("{name} {n}"),
                            &body,
                            &rate(decimation),
                            &format!("{kind_name} {decimation}"),
                        );
                    }
                }
            }
        }
    }
}

fn print_row(name: &str, body: &Polyhedron, options: &HierarchyOptions, kind_name: &str) {
    let (hierarchy, time) =
        least_time(|| Hierarchy::build(body, options, &mut Progress::new(&mut |_| true)).expect("levels"));
    let level = |level: &swiftprox::hierarchy::Level| {
        let (triangles, edges) = (level.polyhedron.triangles.len(), level.polyhedron.edges.len());
        format!("{triangles} / {edges} / {}", significant(level.deviation / body.mass.radius))
    };
    let levels: Vec<String> = hierarchy.levels.iter().map(level).collect();
    let share = hierarchy.heap_bytes() as f64 / body.heap_bytes() as f64;
    println!(
        "| {name} | {kind_name} | {} | {} ({:.0} %) | {time:.1} |",
        levels.join(", "),
        hierarchy.heap_bytes(),
        100.0 * share
    );
}

/// Rounded to two digits.
fn significant(x: f64) -> f64 {
    let scale = 10.0_f64.powi(1 - x.abs().log10().floor() as i32);
    (x * scale).round() / scale
}

/// The result of a function, and the least of three times that it took, in milliseconds.
fn least_time<T>(mut f: impl FnMut() -> T) -> (T, f64) {
    let mut least = f64::INFINITY;
    let mut result = None;
    for _ in 0..3 {
        let start = Instant::now();
        result = Some(f());
        least = least.min(start.elapsed().as_secs_f64() * 1e3);
    }
    (result.expect("it ran"), least)
}
