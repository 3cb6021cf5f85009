//! Bodies of 16 to 500 pieces: this library's compounds beside parry3d-f64's and, for two bodies, coal, FCL and Bullet. Verdicts
//! and distances of two, contacts of two at rest, an arm among obstacles, and scenes in which all move.

mod arm;
mod crowd;
mod native;
mod ours;
mod pairs;
mod parry;
mod resting;
mod scenes;

use std::fmt::Write;
use std::ops::Range;

use crate::options::Options;
use crate::report;
use crate::timing::{Time, Timed, time_methods};

/// A way to answer the questions of a scene, one by one.
pub trait Method {
    fn name(&self) -> &'static str;

    /// Drops all coherence.
    fn forget(&mut self) {}

    /// How far its answers may be off, where that is more than a scene allows.
    fn error(&self) -> f64 {
        0.0
    }

    /// The answer to question k: a distance, 0 for what meets and 1 for what does not, or a number of contacts.
    fn ask(&mut self, k: usize) -> f64;
}

impl Timed for Box<dyn Method + '_> {
    fn forget(&mut self) {
        (**self).forget();
    }

    fn run_backwards(&mut self, count: usize) {
        for k in (0..count).rev() {
            std::hint::black_box(self.ask(k));
        }
    }

    fn run(&mut self, queries: Range<usize>) {
        for k in queries {
            std::hint::black_box(self.ask(k));
        }
    }
}

/// A question about a scene.
#[derive(Clone, Copy)]
struct Scene {
    asked: &'static str,
    bodies: &'static str,
    /// Of one body.
    pieces: usize,
    motion: &'static str,
}

/// A method on a scene.
struct Row {
    scene: Scene,
    method: &'static str,
    count: usize,
    /// How many poses intersect, or how many pairs or contacts are listed.
    found: usize,
    time: Time,
}

impl Scene {
    /// Asks and times all methods, the first of them this library. `found` counts what answers say.
    ///
    /// # Errors
    /// An answer differs from this library's by more than what is allowed.
    fn measure(
        self,
        mut methods: Vec<Box<dyn Method + '_>>,
        [count, passes]: [usize; 2],
        allowed: f64,
        found: impl Fn(f64) -> usize,
    ) -> Result<Vec<Row>, String> {
        let answers: Vec<Vec<f64>> =
            methods.iter_mut().map(|method| (0..count).map(|k| method.ask(k)).collect()).collect();
        for (method, others) in methods.iter().zip(&answers) {
            let allowed = allowed.max(method.error());
            let mut pairs = answers[0].iter().zip(others).enumerate();
            // A NaN differs, too.
            if let Some((k, (a, b))) = pairs.find(|(_, (a, b))| !matches!((*a - *b).abs(), d if d <= allowed)) {
                let Scene { asked, bodies, motion, .. } = self;
                return Err(format!("{bodies}, {motion}, {asked} {k}: {a:e}, by {} {b:e}", method.name()));
            }
        }
        let times = time_methods(&mut methods, count, passes);
        let rows = methods.iter().zip(times).zip(answers).map(|((method, time), answers)| Row {
            scene: self,
            method: method.name(),
            count,
            found: answers.into_iter().map(&found).sum(),
            time,
        });
        Ok(rows.collect())
    }
}

/// Of verdicts and distances: 1 for what meets.
fn met(answer: f64) -> usize {
    usize::from(answer == 0.0)
}

pub fn run(options: &Options) -> Result<(), String> {
    let mut rows = pairs::measure(options)?;
    rows.extend(resting::measure(options)?);
    rows.extend(arm::measure(options)?);
    rows.extend(crowd::measure(options)?);
    print(&rows);
    if let Some(path) = &options.csv {
        report::write(path, options.passes, &csv(&rows))?;
    }
    Ok(())
}

fn csv(rows: &[Row]) -> String {
    let mut text = "asked,bodies,pieces,motion,method,count,found,best_ns,median_ns\n".to_string();
    for Row { scene: Scene { asked, bodies, pieces, motion }, method, count, found, time } in rows {
        let Time { best, median } = time;
        let _ = writeln!(text, "{asked},{bodies},{pieces},{motion},{method},{count},{found},{best:.1},{median:.1}");
    }
    text
}

/// Of each method ns a query, and how many times as long as ours.
fn print(rows: &[Row]) {
    println!("| asked | motion | bodies | method | found | ns | times ours |\n|---|---|---|---|--:|--:|--:|");
    let mut own = f64::NAN;
    for Row { scene: Scene { asked, bodies, motion, .. }, method, found, time, .. } in rows {
        if *method == ours::NAME {
            own = time.best;
        }
        let ratio = time.best / own;
        println!("| {asked} | {motion} | {bodies} | {method} | {found} | {:.0} | {ratio:.2} |", time.best);
    }
}
