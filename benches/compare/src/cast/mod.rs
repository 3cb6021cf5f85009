//! When does a motion come to contact: casts beside the continuous collision of others, and beside samples along the motion.
//!
//! The truth is the certified answer, proved anew and judged by exact samples. A peer misses what it says is free; a hit that it
//! says of a free motion is false; of a hit the time may be off.

mod box3d;
#[cfg(any(fcl, bullet64))]
mod native;
mod ours;
pub mod parry;
mod peers;
mod rays;
mod scenes;

use std::fmt::Write;
use std::ops::Range;

use crate::options::Options;
use crate::report;
use crate::timing::{Time, Timed, time_methods};
use scenes::{Scene, Truth};

/// A time of contact that is this far off, of a motion that takes 1, is counted.
const OFF: f64 = 1e-3;

/// What a method says of a motion.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Said {
    Free,
    /// The time of the first contact.
    Hit(f64),
    /// It says that it does not know.
    Unknown,
}

/// Casts of one scene's motions.
pub trait Caster {
    fn name(&self) -> &str;

    /// Drops all coherence.
    fn forget(&mut self) {}

    fn cast(&mut self, motion: usize) -> Said;

    /// Certified queries of the last cast; NaN for who does not say.
    fn queries(&self) -> f64 {
        f64::NAN
    }
}

impl Timed for Box<dyn Caster + '_> {
    fn forget(&mut self) {
        (**self).forget();
    }

    fn run_backwards(&mut self, count: usize) {
        for i in (0..count).rev() {
            std::hint::black_box(self.cast(i));
        }
    }

    fn run(&mut self, queries: Range<usize>) {
        for i in queries {
            std::hint::black_box(self.cast(i));
        }
    }
}

/// A method on a scene.
pub struct Row {
    asked: &'static str,
    scene: String,
    method: String,
    count: usize,
    hits: usize,
    time: Time,
    queries: f64,
    misses: usize,
    false_hits: usize,
    off: usize,
    unknown: usize,
}

pub fn run(options: &Options, wanted: &[String]) -> Result<(), String> {
    let mut rows = Vec::new();
    for scene in scenes::scenes(options.count, wanted)? {
        rows.extend(measure(&scene, options)?);
        eprintln!("{} done", scene.name);
    }
    if wanted.is_empty() || wanted.iter().any(|name| name == "rays") {
        rows.extend(rays::measure(options)?);
    }
    print(&rows);
    if let Some(path) = &options.csv {
        report::write(path, options.passes, &csv(&rows))?;
    }
    Ok(())
}

fn measure(scene: &Scene, options: &Options) -> Result<Vec<Row>, String> {
    let truths = scene.truths()?;
    let mut methods = methods(scene)?;
    methods.retain(|method| options.methods.is_empty() || options.methods.iter().any(|name| name == method.name()));
    Ok(compare("cast", &scene.name, &mut methods, &truths, options))
}

/// Judges and times methods.
fn compare(
    asked: &'static str,
    scene: &str,
    methods: &mut [Box<dyn Caster + '_>],
    truths: &[Truth],
    options: &Options,
) -> Vec<Row> {
    let mut rows: Vec<Row> = methods.iter_mut().map(|method| judged(asked, scene, method.as_mut(), truths)).collect();
    for (row, time) in rows.iter_mut().zip(time_methods(methods, truths.len(), options.passes)) {
        row.time = time;
    }
    rows
}

fn methods(scene: &Scene) -> Result<Vec<Box<dyn Caster + '_>>, String> {
    let mut methods: Vec<Box<dyn Caster + '_>> =
        vec![Box::new(ours::Cast::new(scene)), Box::new(parry::Nonlinear::new(scene)?)];
    methods.push(Box::new(ours::Samples::new(scene, 100)));
    if scene.turn == 0.0 {
        methods.push(Box::new(parry::Linear::new(scene)?));
    }
    // These are given the poses at the ends, and turn by the shorter way between them.
    if scene.turn < std::f64::consts::PI {
        methods.push(Box::new(parry::TimeOfImpact::new(scene)));
        methods.extend(box3d::TimeOfImpact::new(scene).map(|caster| Box::new(caster) as Box<dyn Caster + '_>));
        methods.extend(peers::casters(scene)?.into_iter().map(|caster| caster as Box<dyn Caster + '_>));
    }
    methods.push(Box::new(ours::Samples::new(scene, 1000)));
    Ok(methods)
}

fn judged(asked: &'static str, scene: &str, method: &mut dyn Caster, truths: &[Truth]) -> Row {
    let mut row = Row {
        asked,
        scene: scene.into(),
        method: method.name().into(),
        count: truths.len(),
        hits: truths.iter().filter(|truth| matches!(truth, Truth::Hit(_))).count(),
        time: Time { best: f64::NAN, median: f64::NAN },
        queries: 0.0,
        misses: 0,
        false_hits: 0,
        off: 0,
        unknown: 0,
    };
    method.forget();
    for (i, truth) in truths.iter().enumerate() {
        match (method.cast(i), truth) {
            (Said::Unknown, _) => row.unknown += 1,
            (Said::Free, Truth::Hit(_)) => row.misses += 1,
            (Said::Hit(_), Truth::Free) => row.false_hits += 1,
            (Said::Hit(time), Truth::Hit([low, high])) => row.off += usize::from(time < low - OFF || time > high + OFF),
            // What rounding hides may be said either way.
            (Said::Hit(time), Truth::Near(low)) => row.off += usize::from(time < low - OFF),
            (Said::Free, Truth::Free | Truth::Near(_)) => {}
        }
        row.queries += method.queries() / truths.len() as f64;
    }
    row
}

fn csv(rows: &[Row]) -> String {
    let mut text =
        "asked,scene,method,count,hits,best_ns,median_ns,mean_queries,misses,false_hits,off,unknown\n".to_string();
    for row in rows {
        let Row { asked, scene, method, count, hits, time: Time { best, median }, queries, .. } = row;
        let Row { misses, false_hits, off, unknown, .. } = row;
        let _ = writeln!(
            text,
            "{asked},\"{scene}\",{method},{count},{hits},{best:.1},{median:.1},{queries:.2},{misses},{false_hits},{off},{unknown}"
        );
    }
    text
}

fn print(rows: &[Row]) {
    println!("| scene | method | motions | hits | µs | times ours | misses | false hits | off | unknown |");
    println!("|---|---|--:|--:|--:|--:|--:|--:|--:|--:|");
    let mut own = f64::NAN;
    for row in rows {
        let Row { scene, method, count, hits, time, misses, false_hits, off, unknown, .. } = row;
        if method == ours::NAME {
            own = time.best;
        }
        println!(
            "| {scene} | {method} | {count} | {hits} | {:.3} | {:.2} | {misses} | {false_hits} | {off} | {unknown} |",
            time.best * 1e-3,
            time.best / own
        );
    }
}
