//! Verdicts and distances of two bodies of 80 to 500 pieces: this library's compounds beside parry3d-f64's, pose by pose.

mod ours;
mod parry;
mod scenes;

use std::fmt::Write;
use std::ops::Range;

use testkit::PosePair;

use crate::options::Options;
use crate::report;
use crate::timing::{Time, Timed, time_methods};
use scenes::{MOTIONS, bodies};

/// What is asked.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Asked {
    Verdict,
    Distance,
}

const ASKED: [(&str, Asked); 2] = [("verdict", Asked::Verdict), ("distance", Asked::Distance)];

/// Two bodies, pose by pose.
pub trait Bodies {
    fn name(&self) -> &'static str;

    /// Drops all coherence.
    fn forget(&mut self);

    /// The distance; of a verdict 0 for bodies that intersect and 1 for others.
    fn ask(&mut self, poses: &PosePair) -> f64;
}

/// A method and the poses that it is asked about.
struct Run<'a> {
    method: Box<dyn Bodies + 'a>,
    poses: &'a [PosePair],
}

impl Timed for Run<'_> {
    fn forget(&mut self) {
        self.method.forget();
    }

    fn run_backwards(&mut self, count: usize) {
        for poses in self.poses[..count].iter().rev() {
            std::hint::black_box(self.method.ask(poses));
        }
    }

    fn run(&mut self, queries: Range<usize>) {
        for poses in &self.poses[queries] {
            std::hint::black_box(self.method.ask(poses));
        }
    }
}

/// A method on a scene.
struct Row {
    asked: &'static str,
    bodies: &'static str,
    pieces: usize,
    motion: &'static str,
    method: &'static str,
    count: usize,
    hits: usize,
    time: Time,
}

pub fn run(options: &Options) -> Result<(), String> {
    let mut rows = Vec::new();
    for (name, points) in bodies() {
        let ours = ours::compound(&points).map_err(|error| format!("{name}: {error}"))?;
        let theirs = parry::compound(&points).map_err(|error| format!("{name}: {error}"))?;
        for motion in MOTIONS.iter().filter(|motion| scenes::has(name, motion)) {
            let poses = scenes::poses(motion, &ours, options.count).map_err(|error| format!("{name}: {error}"))?;
            for (asked, what) in ASKED {
                let methods: [Box<dyn Bodies>; 2] =
                    [Box::new(ours::Ours::new(&ours, what)), Box::new(parry::Parry::new(&theirs, what))];
                let mut runs: Vec<Run> = methods.into_iter().map(|method| Run { method, poses: &poses }).collect();
                let answers: Vec<Vec<f64>> =
                    runs.iter_mut().map(|run| poses.iter().map(|poses| run.method.ask(poses)).collect()).collect();
                check(&answers).map_err(|error| format!("{name}, {motion}, {asked}: {error}"))?;
                let hits = answers[0].iter().filter(|answer| **answer == 0.0).count();
                let times = time_methods(&mut runs, poses.len(), options.passes);
                rows.extend(runs.iter().zip(times).map(|(run, time)| Row {
                    asked,
                    bodies: name,
                    pieces: points.len(),
                    motion,
                    method: run.method.name(),
                    count: poses.len(),
                    hits,
                    time,
                }));
            }
        }
    }
    print(&rows);
    if let Some(path) = &options.csv {
        report::write(path, options.passes, &csv(&rows))?;
    }
    Ok(())
}

/// Answers agree where parry's rounding leaves any.
fn check(answers: &[Vec<f64>]) -> Result<(), String> {
    const ALLOWED: f64 = 1e-6;
    let differs = |(k, (a, b)): (usize, (&f64, &f64))| ((a - b).abs() > ALLOWED).then(|| format!("{k}: {a:e}, {b:e}"));
    match answers[0].iter().zip(&answers[1]).enumerate().find_map(differs) {
        Some(found) => Err(format!("ours and parry's differ at pose {found}")),
        None => Ok(()),
    }
}

fn csv(rows: &[Row]) -> String {
    let mut text = "asked,bodies,pieces,motion,method,count,hits,best_ns,median_ns\n".to_string();
    for Row { asked, bodies, pieces, motion, method, count, hits, time: Time { best, median } } in rows {
        let _ = writeln!(text, "{asked},{bodies},{pieces},{motion},{method},{count},{hits},{best:.1},{median:.1}");
    }
    text
}

/// For each question and motion and for each two bodies: ns a query, and how many times as long parry takes.
fn print(rows: &[Row]) {
    println!("| asked | motion | bodies | ours, ns | parry / ours |\n|---|---|---|--:|--:|");
    for (asked, _) in ASKED {
        for motion in MOTIONS {
            let of_motion: Vec<&[Row]> =
                rows.chunks(2).filter(|pair| pair[0].asked == asked && pair[0].motion == motion).collect();
            let ratio = |pair: &[Row]| pair[1].time.best / pair[0].time.best;
            for pair in &of_motion {
                let own = pair[0].time.best;
                println!("| {asked} | {motion} | {} | {own:.0} | {:.2} |", pair[0].bodies, ratio(pair));
            }
            let logarithms: f64 = of_motion.iter().map(|pair| ratio(pair).ln()).sum();
            println!("| {asked} | {motion} | mean | | {:.2} |", (logarithms / of_motion.len() as f64).exp());
        }
    }
}
