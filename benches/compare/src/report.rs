//! Results as CSV for the charts and as tables for the eye.

use std::collections::BTreeMap;
use std::fmt::Write;
use std::fs;
use std::path::Path;

use crate::accuracy::Accuracy;
use crate::method::Reply;
use crate::timing::{Time, median};
use testkit::orbits::Step;
use testkit::provenance::provenance;

/// The methods that ratios are against: the first of them that is there.
const PEERS: [&str; 2] = ["parry-hc", "libccd-mpr-1e-4"];

/// A method on a scene.
pub struct Row {
    model: String,
    n: usize,
    orbit: String,
    step: Step,
    method: String,
    count: usize,
    time: Time,
    steps: f64,
    median_width: f64,
    worst_width: f64,
    accuracy: Accuracy,
    fallbacks: usize,
    exacts: usize,
}

impl Row {
    pub fn new(
        (model, n, orbit, step): (&str, usize, &str, Step),
        method: &str,
        replies: &[Reply],
        time: Time,
        accuracy: Accuracy,
    ) -> Row {
        let mut widths: Vec<f64> =
            replies.iter().filter(|r| r.distance > 0.0 && !r.width().is_nan()).map(Reply::width).collect();
        let median_width = median(&mut widths);
        Row {
            model: model.into(),
            n,
            orbit: orbit.into(),
            step,
            method: method.into(),
            count: replies.len(),
            time,
            steps: replies.iter().map(|r| r.steps).sum::<f64>() / replies.len() as f64,
            median_width,
            worst_width: widths.last().copied().unwrap_or(f64::NAN),
            accuracy,
            fallbacks: replies.iter().filter(|r| r.fallback).count(),
            exacts: replies.iter().filter(|r| r.exact).count(),
        }
    }
}

/// A way to build on a model.
pub struct BuildRow {
    pub model: String,
    pub n: usize,
    pub method: &'static str,
    pub time: Time,
    /// Of what is built; 0 where that is not known.
    pub bytes: usize,
}

pub fn distance_csv(rows: &[Row]) -> String {
    let mut text = "model,n,orbit,step,method,count,best_ns,median_ns,mean_steps,disagreements,median_error,\
        worst_error,median_width,worst_width,fallbacks,exacts\n"
        .to_string();
    for r in rows {
        let (time, accuracy) = (r.time, r.accuracy);
        let _ = writeln!(
            text,
            "{},{},{},{},{},{},{:.1},{:.1},{:.2},{},{:.2e},{:.2e},{:.2e},{:.2e},{},{}",
            r.model,
            r.n,
            r.orbit,
            r.step,
            r.method,
            r.count,
            time.best,
            time.median,
            r.steps,
            accuracy.disagreements,
            accuracy.median_error,
            accuracy.worst_error,
            r.median_width,
            r.worst_width,
            r.fallbacks,
            r.exacts
        );
    }
    text
}

pub fn build_csv(rows: &[BuildRow]) -> String {
    let mut text = "model,n,method,best_ms,median_ms,bytes\n".to_string();
    for r in rows {
        let (best, median) = (r.time.best * 1e-6, r.time.median * 1e-6);
        let _ = writeln!(text, "{},{},{},{best:.3},{median:.3},{}", r.model, r.n, r.method, r.bytes);
    }
    text
}

/// Writes a CSV, its folder too, under a line that says on what it was measured.
pub fn write(path: &Path, passes: usize, csv: &str) -> Result<(), String> {
    write_as(path, &format!("{passes} passes"), csv)
}

/// The same of what was not measured in passes.
pub fn write_as(path: &Path, how: &str, csv: &str) -> Result<(), String> {
    let head = format!("# {}, {how}, {}\n", provenance(), env!("COMPILER"));
    let folder = path.parent().unwrap_or(Path::new("."));
    fs::create_dir_all(folder)
        .and_then(|()| fs::write(path, head + csv))
        .map_err(|e| format!("{}: {e}", path.display()))
}

/// A table for each size and orbit: geometric means over the models, and how many times as long the peer takes.
pub fn print_distance(rows: &[Row]) {
    let mut scenes: Vec<(usize, &str)> = Vec::new();
    for r in rows {
        if !scenes.contains(&(r.n, &r.orbit)) {
            scenes.push((r.n, &r.orbit));
        }
    }
    for (n, orbit) in scenes {
        let here: Vec<&Row> = rows.iter().filter(|r| r.n == n && r.orbit == orbit).collect();
        println!(
            "\n{n} vertices, {orbit} orbit: ns a query, geometric mean over the models (times faster than the peer)\n"
        );
        print_means(&here);
    }
    println!();
    let reference = rows.first().map_or("", |r| &r.method);
    for method in in_order(rows.iter().map(|r| r.method.as_str())).into_iter().skip(1) {
        let own = || rows.iter().filter(|r| r.method == method);
        let count: usize = own().map(|r| r.count).sum();
        let disagreements: usize = own().map(|r| r.accuracy.disagreements).sum();
        let worst = own().map(|r| r.accuracy.worst_error).fold(0.0, f64::max);
        println!("{method}: {disagreements} of {count} answers differ from {reference}'s, worst error {worst:.1e}");
    }
}

fn print_means(rows: &[&Row]) {
    let methods = in_order(rows.iter().map(|r| r.method.as_str()));
    let peer = PEERS.into_iter().find(|peer| methods.contains(peer)).unwrap_or_default();
    println!("| step | {} |", methods.join(" | "));
    println!("|---|{}", "--:|".repeat(methods.len()));
    for step in in_order(rows.iter().map(|r| r.step.to_string())) {
        let mut means = BTreeMap::new();
        for method in &methods {
            let times = rows.iter().filter(|r| r.step.to_string() == step && r.method == *method);
            means.insert(*method, geometric_mean(times.map(|r| r.time.best)));
        }
        print!("| {step} |");
        for method in &methods {
            let mean = means[method];
            match means.get(peer) {
                Some(time) if *method != peer => print!(" {mean:.0} ({:.1}) |", time / mean),
                _ => print!(" {mean:.0} |"),
            }
        }
        println!();
    }
}

pub fn print_build(rows: &[BuildRow]) {
    println!("| model | vertices | method | best ms | median ms | bytes |\n|---|--:|---|--:|--:|--:|");
    for r in rows {
        let (best, median) = (r.time.best * 1e-6, r.time.median * 1e-6);
        println!("| {} | {} | {} | {best:.3} | {median:.3} | {} |", r.model, r.n, r.method, r.bytes);
    }
}

/// What is there, each once, in the order of its first appearance.
pub fn in_order<T: PartialEq>(items: impl Iterator<Item = T>) -> Vec<T> {
    let mut seen = Vec::new();
    for item in items {
        if !seen.contains(&item) {
            seen.push(item);
        }
    }
    seen
}

pub fn geometric_mean(values: impl Iterator<Item = f64>) -> f64 {
    let (mut sum, mut count) = (0.0, 0);
    for value in values {
        sum += value.ln();
        count += 1;
    }
    (sum / f64::from(count)).exp()
}
