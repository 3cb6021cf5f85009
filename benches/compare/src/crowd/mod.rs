//! Scenes of many bodies: what a step costs, poses set and query answered, beside parry's bounding volume hierarchy with hill
//! climbing, FCL's dynamic tree, and a three-axis sweep and prune.
//!
//! The methods take turns block by block over the same steps; the clock is the thread's CPU time. The first step of a scene is not
//! counted: it is there that everything is built.

#[cfg(fcl)]
mod fcl;
mod ours;
mod parry;
mod sweep;
mod world;

use std::fmt::Write;

use crate::options::Options;
use crate::report;
use crate::timing::{measure, median};
use world::{Bodies, MOTIONS, Step, World};

/// What is asked of all pairs.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Question {
    /// Which intersect.
    Intersection,
    /// Which are at most [`TOLERANCE`] apart, and how far.
    Distance,
    /// How deep those are in each other that intersect; this library says their manifolds, too.
    Contact,
}

const TOLERANCE: f64 = 0.25;

impl Question {
    fn name(self) -> &'static str {
        match self {
            Question::Intersection => "intersection",
            Question::Distance => "distance",
            Question::Contact => "contact",
        }
    }
}

/// What a method found in a step: pairs, and the sum of their distances, or of their depths.
#[derive(Debug, Clone, Copy, Default)]
struct Found {
    pairs: usize,
    sum: f64,
}

/// A scene of one method.
trait Crowd {
    fn name(&self) -> &'static str;

    /// Takes over the next steps in whatever form the method wants them. Not timed.
    fn load(&mut self, steps: &[Step]);

    /// Makes one of these steps and asks.
    fn step(&mut self, k: usize) -> Found;
}

/// Steps that a method makes in its turn.
const BLOCK: usize = 8;

pub fn run(options: &Options, counts: &[usize]) -> Result<(), String> {
    let mut csv = "bodies,count,motion,query,method,mean_ms,median_ms,worst_ms,pairs,sum,differing_steps\n".to_string();
    for &count in counts {
        // Few steps of many bodies are as much work as many of few.
        let steps = (options.count * 1_000 / count.max(1)).clamp(2 * BLOCK, options.count.max(2 * BLOCK));
        for (word, bodies) in [("fat 102", Bodies::Alike("fat")), ("mixed 8-1002", Bodies::Mixed)] {
            for motion in MOTIONS {
                for question in [Question::Intersection, Question::Distance, Question::Contact] {
                    let mut world = World::new(bodies, motion, count)?;
                    let mut methods = methods(&world, question, options)?;
                    let scene = format!("{word},{count},{},{}", motion.name(), question.name());
                    let times = time(&mut methods, &mut world, steps);
                    for (method, times) in methods.iter().zip(times) {
                        let _ = writeln!(csv, "{scene},{},{}", method.name(), times.row());
                        eprintln!("{scene},{},{}", method.name(), times.row());
                    }
                }
            }
        }
    }
    match &options.csv {
        Some(path) => report::write(path, 1, &csv),
        None => {
            print!("{csv}");
            Ok(())
        }
    }
}

fn methods(world: &World, question: Question, options: &Options) -> Result<Vec<Box<dyn Crowd>>, String> {
    let mut all: Vec<Box<dyn Crowd>> = vec![
        Box::new(ours::Ours::new(world, question)?),
        Box::new(parry::Parry::new(world, question, parry::Upkeep::Refit)),
        Box::new(parry::Parry::new(world, question, parry::Upkeep::Rebuild)),
    ];
    // Where more bodies jump it sorts for minutes.
    if world.mesh_of.len() <= 10_000 && question != Question::Contact {
        all.push(Box::new(sweep::Sweep::new(world, question)?));
    }
    #[cfg(fcl)]
    all.push(Box::new(fcl::Fcl::new(world, question)?));
    if !options.methods.is_empty() {
        all.retain(|method| options.methods.iter().any(|wanted| wanted == method.name()));
    }
    Ok(all)
}

/// What one method took, step by step.
#[derive(Default)]
struct Times {
    ms: Vec<f64>,
    last: Found,
    /// Steps in which it found another number of pairs than the first method.
    differing: usize,
}

impl Times {
    fn row(&self) -> String {
        let mut ms = self.ms.clone();
        let mean = ms.iter().sum::<f64>() / ms.len() as f64;
        let worst = ms.iter().copied().fold(0.0, f64::max);
        let median = median(&mut ms);
        format!("{mean:.4},{median:.4},{worst:.4},{},{:.6},{}", self.last.pairs, self.last.sum, self.differing)
    }
}

fn time(methods: &mut [Box<dyn Crowd>], world: &mut World, steps: usize) -> Vec<Times> {
    let mut all: Vec<Times> = methods.iter().map(|_| Times::default()).collect();
    for block in 0..steps.div_ceil(BLOCK) {
        let steps = world.steps(BLOCK);
        let mut counts = [0; BLOCK];
        for (m, method) in methods.iter_mut().enumerate() {
            method.load(&steps);
            for k in 0..BLOCK {
                let mut found = Found::default();
                let ns = measure(|| found = method.step(k));
                if m == 0 {
                    counts[k] = found.pairs;
                }
                let times = &mut all[m];
                times.differing += usize::from(found.pairs != counts[k]);
                times.last = found;
                if block > 0 || k > 0 {
                    times.ms.push(1e-6 * ns);
                }
            }
        }
    }
    all
}
