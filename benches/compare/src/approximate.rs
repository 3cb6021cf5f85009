//! What an error tolerance buys: the time of an approximate distance over the error asked for, between intersection and exact distance, for
//! each kind of levels of detail and each way to refine them.

use std::fmt::Write;

use swiftprox::error::Result;
use swiftprox::hierarchy::{HierarchyKind, HierarchyOptions};
use swiftprox::math::Pose;
use swiftprox::pair::{self, Levels, PairAnswer, PairCache, PairConfig, Refinement};
use swiftprox::progress::Progress;
use swiftprox::shape::{Shape, ShapeOptions};

use crate::method::{Method, Reply};
use crate::options::Options;
use crate::scenes::PosePair;
use crate::timing::time_methods;
use crate::{model, motion, report};

/// Of the models' radius, 1.
const ERRORS: [f64; 8] = [1e-1, 3e-2, 1e-2, 3e-3, 1e-3, 1e-4, 1e-5, 1e-6];

/// Kinds of levels, their names, the fraction of triangles that they keep and the fewest.
const HIERARCHIES: [(&str, HierarchyKind, f64, usize); 6] = [
    ("none", HierarchyKind::None, 0.25, 50),
    ("quadric", HierarchyKind::Quadric, 0.25, 50),
    ("quadric-two", HierarchyKind::Quadric, 0.03125, 50),
    ("dobkin-kirkpatrick", HierarchyKind::DobkinKirkpatrick, 0.25, 100),
    ("outer", HierarchyKind::OuterCuts, 0.25, 50),
    ("outer-half", HierarchyKind::OuterCuts, 0.5, 20),
];

const REFINEMENTS: [(&str, Refinement); 4] = [
    ("adaptive", Refinement::Adaptive),
    ("single", Refinement::Single),
    ("single-single", Refinement::SingleSingle),
    ("double-double", Refinement::DoubleDouble),
];

type Query = fn(&Shape, &Pose, &Shape, &Pose, &mut PairCache, &PairConfig, &mut PairAnswer) -> Result<()>;

/// One setting: a kind of levels, how they are used, and what is asked.
struct Setting<'a> {
    hierarchy: &'static str,
    levels: &'static str,
    refinement: &'static str,
    query: &'static str,
    error: f64,
    ask: Query,
    config: PairConfig,
    shape: &'a Shape,
    poses: Vec<[Pose; 2]>,
    cache: PairCache,
    answer: PairAnswer,
}

impl Method for Setting<'_> {
    fn name(&self) -> &str {
        self.hierarchy
    }

    fn load(&mut self, poses: &[PosePair]) {
        let pose = |m: &[f64]| Pose::from_row_major(m.try_into().expect("twelve of 24"));
        self.poses = (poses.iter()).map(|p| [pose(&p[..12]), pose(&p[12..])]).collect();
    }

    fn forget(&mut self) {
        self.cache = PairCache::default();
    }

    #[inline]
    fn ask(&mut self, i: usize) {
        let [pose1, pose2] = &self.poses[i];
        let (cache, answer) = (&mut self.cache, &mut self.answer);
        let done = (self.ask)(self.shape, pose1, self.shape, pose2, cache, &self.config, answer);
        assert!(done.is_ok(), "the poses are sound");
    }

    fn reply(&self) -> Reply {
        let statistics = &self.answer.statistics;
        Reply {
            distance: self.answer.distance,
            width: self.answer.upper - self.answer.lower,
            steps: f64::from(statistics.marching_steps),
            fallback: statistics.levels != [0, 0],
            exact: statistics.exact_iterations > 0,
        }
    }
}

/// Every setting on shapes with these levels.
fn settings<'a>(shapes: &'a [Shape]) -> Vec<Setting<'a>> {
    let mut settings = Vec::new();
    for ((hierarchy, kind, ..), shape) in HIERARCHIES.into_iter().zip(shapes) {
        let uses = if kind == HierarchyKind::None { [("none", Levels::None)] } else { [("all", Levels::All)] };
        for (levels_name, levels) in uses {
            let refinements = if levels == Levels::All { &REFINEMENTS[..] } else { &REFINEMENTS[..1] };
            for &(refinement_name, refinement) in refinements {
                let mut add = |query, error, ask: Query| {
                    let config = PairConfig { absolute_error: error, levels, refinement, ..PairConfig::default() };
                    settings.push(Setting {
                        hierarchy,
                        levels: levels_name,
                        refinement: refinement_name,
                        query,
                        error,
                        ask,
                        config,
                        shape,
                        poses: Vec::new(),
                        cache: PairCache::default(),
                        answer: PairAnswer::default(),
                    });
                };
                add("intersection", f64::INFINITY, pair::intersection);
                for error in ERRORS {
                    add("approximate", error, pair::approximate);
                }
                add("exact", 0.0, pair::distance);
            }
        }
    }
    settings
}

pub fn run(options: &Options) -> std::result::Result<(), String> {
    let mut csv = "model,n,orbit,step,hierarchy,levels,refinement,query,error,best_ns,median_ns,mean_steps,by_levels,\
        mean_width\n"
        .to_string();
    for &n in &options.vertices {
        for name in &options.models {
            let mesh = model(options, name, n)?;
            let plain = Shape::from_mesh(&mesh, &ShapeOptions::default()).map_err(|e| e.to_string())?;
            let mut shapes = Vec::new();
            for (hierarchy, kind, decimation, minimum_triangles) in HIERARCHIES {
                let wanted = HierarchyOptions { kind, decimation, minimum_triangles, ..HierarchyOptions::default() };
                let shape = plain.clone().with_levels(&wanted, &mut Progress::new(&mut |_| true));
                let shape = shape.map_err(|e| e.to_string())?;
                for (i, level) in shape.hierarchy().levels.iter().enumerate() {
                    let (vertices, deviation) = (level.polyhedron.vertices.len(), level.deviation);
                    eprintln!("{name} {n} {hierarchy}: level {} of {vertices} vertices, {deviation:.2e}", i + 1);
                }
                shapes.push(shape);
            }
            for orbit in &options.orbits {
                for &step in &options.steps {
                    let poses = motion(options, orbit, step)?;
                    let mut settings = settings(&shapes);
                    let mut told = Vec::new();
                    for setting in &mut settings {
                        setting.load(&poses);
                        told.push(tell(setting, poses.len()));
                    }
                    let labels: Vec<_> = (settings.iter())
                        .map(|s| format!("{},{},{},{},{}", s.hierarchy, s.levels, s.refinement, s.query, s.error))
                        .collect();
                    let mut methods: Vec<Box<dyn Method + '_>> =
                        settings.into_iter().map(|setting| Box::new(setting) as Box<dyn Method + '_>).collect();
                    let times = time_methods(&mut methods, poses.len(), options.passes);
                    for ((label, time), [steps, by_levels, width]) in labels.iter().zip(times).zip(told) {
                        let _ = writeln!(
                            csv,
                            "{name},{n},{orbit},{step},{label},{:.1},{:.1},{steps:.2},{by_levels:.3},{width:.2e}",
                            time.best, time.median
                        );
                    }
                    eprintln!("{name} {n} {orbit} {step} done");
                }
            }
        }
    }
    match &options.csv {
        Some(path) => report::write(path, options.passes, &csv),
        None => {
            print!("{csv}");
            Ok(())
        }
    }
}

/// Means over a pass: steps, the fraction of answers that came from levels, the width of the intervals of disjoint pairs.
fn tell(setting: &mut Setting, count: usize) -> [f64; 3] {
    setting.forget();
    let (mut steps, mut by_levels, mut width, mut disjoint) = (0.0, 0.0, 0.0, 0.0);
    for i in 0..count {
        setting.ask(i);
        let reply = setting.reply();
        steps += reply.steps;
        by_levels += f64::from(u8::from(reply.fallback));
        if reply.distance > 0.0 && reply.width.is_finite() {
            width += reply.width;
            disjoint += 1.0;
        }
    }
    [steps / count as f64, by_levels / count as f64, width / disjoint]
}
