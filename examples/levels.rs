//! Prints a table of the levels of detail of the benchmark's bodies: triangles, deviation, bytes and build time of each kind.
//!
//! `cargo run --release --example levels -- [VERTICES ...]`; docs/levels.md has its output.

#[path = "../benches/common/mod.rs"]
mod common;

use std::time::Instant;

use common::models::{ELLIPSOIDS, ellipsoid};
use swiftprox::hierarchy::{Hierarchy, HierarchyKind, HierarchyOptions};
use swiftprox::polyhedron::Polyhedron;
use swiftprox::polyhedron_build::build;
use swiftprox::progress::Progress;

const KINDS: [(HierarchyKind, &str); 3] = [
    (HierarchyKind::Quadric, "quadric"),
    (HierarchyKind::DobkinKirkpatrick, "Dobkin-Kirkpatrick"),
    (HierarchyKind::OuterCuts, "outer cuts"),
];

fn main() {
    let counts: Vec<usize> = std::env::args().skip(1).map(|n| n.parse().expect("a number of vertices")).collect();
    let counts = if counts.is_empty() { vec![1002, 10002] } else { counts };
    println!("| body | kind | level: triangles / deviation (of the radius) | bytes, of the body's | build, ms |");
    println!("|---|---|---|--:|--:|");
    for n in counts {
        for (name, half_axes) in ELLIPSOIDS {
            let mesh = ellipsoid(half_axes, n).expect("an ellipsoid");
            let points = &mesh.vertices;
            let (body, own) = least_time(|| build(points, None).expect("a hull"));
            let triangles = body.triangles.len();
            println!("| {name} {n} | — | {triangles} / 0 | {} | {own:.1} |", body.heap_bytes());
            for (kind, kind_name) in KINDS {
                print_row(&format!("{name} {n}"), &body, kind, kind_name);
            }
        }
    }
}

fn print_row(name: &str, body: &Polyhedron, kind: HierarchyKind, kind_name: &str) {
    let options = HierarchyOptions { kind, ..HierarchyOptions::default() };
    let (hierarchy, time) =
        least_time(|| Hierarchy::build(body, &options, &mut Progress::new(&mut |_| true)).expect("levels"));
    let level = |level: &swiftprox::hierarchy::Level| {
        format!("{} / {}", level.polyhedron.triangles.len(), significant(level.deviation / body.mass.radius))
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
