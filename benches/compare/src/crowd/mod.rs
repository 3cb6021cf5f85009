//! Scenes of many bodies: what a step costs, poses set and query answered, beside parry's bounding volume hierarchy with hill
//! climbing, FCL's dynamic tree, and a three-axis sweep and prune.
//!
//! The methods take turns block by block over the same steps; the clock is the thread's CPU time, of a method with several threads
//! that on the wall. The first step of a scene is not counted: it is there that everything is built. A method that has used up its
//! time on a scene makes no more steps of it.

#[cfg(fcl)]
mod fcl;
mod ours;
mod parry;
mod sweep;
mod world;

use std::fmt::Write;

use crate::options::Options;
use crate::report;
use crate::timing::{measure, measure_on_the_wall, median};
use parry::Upkeep;
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

/// What a method found in a step: pairs, and the sum of their distances or depths.
#[derive(Debug, Clone, Copy, Default)]
struct Found {
    pairs: usize,
    sum: f64,
}

/// A scene of one method.
trait Crowd {
    fn name(&self) -> &'static str;

    /// Whether it has threads beside the caller's.
    fn has_threads(&self) -> bool {
        false
    }

    /// Takes over the next steps in whatever form the method wants them. Not timed.
    fn load(&mut self, steps: &[Step]);

    /// Makes one of these steps and asks.
    fn step(&mut self, k: usize) -> Found;
}

/// Steps that a method makes in its turn.
const BLOCK: usize = 8;

/// Nobody makes fewer in a scene …
const FEWEST_STEPS: usize = 3;

/// … or begins another after so many nanoseconds.
const MOST_NS: f64 = 2e9;

const KINDS: [(&str, Bodies); 4] = [
    ("fat 102", Bodies::Alike("fat")),
    ("mixed 8-1002", Bodies::Mixed),
    ("spheres", Bodies::Spheres),
    ("cubes", Bodies::Cubes),
];

pub fn run(options: &Options, counts: &[usize]) -> Result<(), String> {
    let mut csv =
        "bodies,count,motion,query,method,steps,mean_ms,median_ms,worst_ms,pairs,sum,differing_steps\n".to_string();
    for &count in counts {
        // Few steps of many bodies are as much work as many of few; in too few nothing would settle.
        let steps = (options.count * 1_000 / count.max(1)).clamp(8 * BLOCK, options.count.max(8 * BLOCK));
        for (word, bodies) in KINDS {
            for motion in MOTIONS.into_iter().filter(|motion| is_asked(motion.name(), &options.motions)) {
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

/// Of an empty list all are.
fn is_asked(name: &str, names: &[String]) -> bool {
    names.is_empty() || names.iter().any(|asked| asked == name)
}

fn methods(world: &World, question: Question, options: &Options) -> Result<Vec<Box<dyn Crowd>>, String> {
    let is_wanted = |name: &str| is_asked(name, &options.methods);
    let mut all: Vec<Box<dyn Crowd>> = Vec::new();
    let ours = |workers| ours::Ours::new(world, question, workers).map(|ours| Box::new(ours) as Box<dyn Crowd>);
    if is_wanted(ours::name(1)) {
        all.push(ours(1)?);
    }
    if world.kind.are_primitives() {
        if is_wanted(Upkeep::Refit.name()) {
            all.push(Box::new(parry::Parry::new(world, question, Upkeep::Refit)));
        }
        return Ok(all);
    }
    for upkeep in [Upkeep::Refit, Upkeep::Rebuild] {
        if is_wanted(upkeep.name()) {
            all.push(Box::new(parry::Parry::new(world, question, upkeep)));
        }
    }
    // Where more bodies jump it sorts for minutes.
    if is_wanted("sweep-and-prune") && world.mesh_of.len() <= 10_000 {
        all.push(Box::new(sweep::Sweep::new(world, question)?));
    }
    #[cfg(fcl)]
    if is_wanted("fcl") {
        all.push(Box::new(fcl::Fcl::new(world, question)?));
    }
    // Far from the other one, beside which the branch predictors would have learnt what comes.
    if is_wanted(ours::name(2)) {
        all.push(ours(2)?);
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
        let Found { pairs, sum } = self.last;
        format!("{},{mean:.4},{median:.4},{worst:.4},{pairs},{sum:.6},{}", self.ms.len(), self.differing)
    }
}

impl Times {
    /// Whether the method has made its steps, this one's number from 0 on.
    fn are_enough(&self, step: usize) -> bool {
        step >= FEWEST_STEPS && self.ms.iter().sum::<f64>() * 1e6 > MOST_NS
    }
}

fn time(methods: &mut [Box<dyn Crowd>], world: &mut World, steps: usize) -> Vec<Times> {
    let mut all: Vec<Times> = methods.iter().map(|_| Times::default()).collect();
    for block in 0..steps.div_ceil(BLOCK) {
        let steps = world.steps(BLOCK);
        let mut counts = [None; BLOCK];
        for (method, times) in methods.iter_mut().zip(&mut all) {
            if times.are_enough(block * BLOCK) {
                continue;
            }
            method.load(&steps);
            for k in 0..BLOCK {
                if times.are_enough(block * BLOCK + k) {
                    break;
                }
                let mut found = Found::default();
                let has_threads = method.has_threads();
                let mut step = || found = method.step(k);
                let ns = if has_threads { measure_on_the_wall(&mut step) } else { measure(step) };
                times.differing += usize::from(found.pairs != *counts[k].get_or_insert(found.pairs));
                times.last = found;
                if block > 0 || k > 0 {
                    times.ms.push(1e-6 * ns);
                }
            }
        }
    }
    all
}
