//! The worst cases over the number of vertices: how many steps queries take, how often they need the fallback and integers, and
//! how long they and building take, for bodies that are hard for marching: many vertices, many neighbours of one vertex, many sides
//! of one face, flat and long bodies. Prints a CSV, one line for each body, number of vertices and motion; `make steps` draws it.

use std::fmt;
use std::process::ExitCode;
use std::time::Instant;

use swiftprox::error::{Error, Result};
use swiftprox::math::{Pose, Vector};
use swiftprox::mesh::PolygonMesh;
use swiftprox::pair::{
    self, DecidedBy, DepthAnswer, DepthCache, DepthConfig, DepthEnding, PairAnswer, PairCache, PairConfig,
};
use swiftprox::shape::{Shape, ShapeOptions};
use testkit::models;
use testkit::provenance::provenance;
use testkit::random::Random;

const USAGE: &str = "usage: cargo bench --bench worst_case -- [--n N]... [--body NAME]... [--motion NAME]... [--queries COUNT] [--csv PATH]";

const BODIES: [&str; 11] = [
    "sphere",
    "plate",
    "needle",
    "cone",
    "flat cone",
    "bipyramid",
    "trapezohedron",
    "prism",
    "flat prism",
    "antiprism",
    "moment curve",
];

/// About this many vertices.
const SIZES: [usize; 9] = [10, 30, 100, 300, 1000, 3000, 10_000, 30_000, 100_000];

/// Runs of each query, of which the quickest counts.
const REPEATS: u32 = 5;

/// What becomes of the poses and of the cache from one query to the next.
#[derive(Clone, Copy, PartialEq)]
enum Motion {
    /// A distance, any orientation, a cold cache.
    Cold,
    /// A distance, any orientation, the cache of the last query.
    Teleport,
    /// A distance of 1e-9 to 0.1, a cold cache.
    Close,
    /// A contact of two bodies whose centres are less than 1 apart, a cold cache.
    Deep,
    /// How deep such bodies are in each other, a cold cache: expansions of the proof, and no times.
    Depth,
}

const MOTIONS: [(Motion, &str); 5] = [
    (Motion::Cold, "cold"),
    (Motion::Teleport, "teleport"),
    (Motion::Close, "close"),
    (Motion::Deep, "deep"),
    (Motion::Depth, "depth"),
];

/// What a run over one body and motion came to.
#[derive(Default)]
struct Row {
    queries: u32,
    /// By the tier that decided.
    fallback: u32,
    exact: u32,
    steps: u64,
    worst_steps: u32,
    worst_fallback_iterations: u32,
    worst_exact_iterations: u32,
    nanoseconds: f64,
    worst_nanoseconds: f64,
}

impl fmt::Display for Row {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        let count = f64::from(self.queries.max(1));
        write!(f, "{},{:.2},{}", self.queries, self.steps as f64 / count, self.worst_steps)?;
        write!(f, ",{},{}", self.fallback, self.worst_fallback_iterations)?;
        write!(f, ",{},{}", self.exact, self.worst_exact_iterations)?;
        write!(f, ",{:.0},{:.0}", self.nanoseconds / count, self.worst_nanoseconds)
    }
}

const HEAD: &str = "body,n,build_ms,motion,queries,mean_steps,worst_steps,fallback,worst_fallback_iterations,exact,\
                    worst_exact_iterations,mean_ns,worst_ns";

struct Options {
    sizes: Vec<usize>,
    bodies: Vec<String>,
    /// Names of motions; none for all.
    motions: Vec<String>,
    queries: u32,
    csv: Option<String>,
}

fn main() -> ExitCode {
    let run = || {
        let options = options()?;
        let csv = run(&options).map_err(|e| e.to_string())?;
        let Some(path) = &options.csv else { return Ok(()) };
        std::fs::write(path, csv).map_err(|e| format!("{path}: {e}"))
    };
    match run() {
        Ok(()) => ExitCode::SUCCESS,
        Err(message) => {
            eprintln!("worst_case: {message}");
            ExitCode::FAILURE
        }
    }
}

fn options() -> std::result::Result<Options, String> {
    let mut options = Options { sizes: Vec::new(), bodies: Vec::new(), motions: Vec::new(), queries: 100, csv: None };
    let mut arguments = std::env::args().skip(1);
    while let Some(name) = arguments.next() {
        // What cargo adds.
        if name == "--bench" {
            continue;
        }
        let value = arguments.next().ok_or(USAGE)?;
        let number = || value.parse().map_err(|e| format!("{name} {value}: {e}"));
        match name.as_str() {
            "--n" => options.sizes.push(number()?),
            "--body" => options.bodies.push(value),
            "--motion" => options.motions.push(value),
            "--queries" => options.queries = number()? as u32,
            "--csv" => options.csv = Some(value),
            _ => return Err(USAGE.into()),
        }
    }
    if options.sizes.is_empty() {
        options.sizes = SIZES.to_vec();
    }
    if options.bodies.is_empty() {
        options.bodies = BODIES.map(String::from).to_vec();
    }
    Ok(options)
}

fn run(options: &Options) -> Result<String> {
    let head = format!("# {}, {} queries a line, best of {REPEATS}\n{HEAD}", provenance(), options.queries);
    println!("{head}");
    let mut csv = head + "\n";
    for body in &options.bodies {
        for &n in &options.sizes {
            let mesh = mesh(body, n)?;
            let start = Instant::now();
            let shape = Shape::from_mesh(&mesh, &ShapeOptions::default())?;
            let build = start.elapsed().as_secs_f64() * 1e3;
            let is_wanted =
                |name: &str| options.motions.is_empty() || options.motions.iter().any(|wanted| wanted == name);
            for (motion, name) in MOTIONS.into_iter().filter(|(_, name)| is_wanted(name)) {
                let row = measure(&shape, motion, options.queries)?;
                let line = format!("{body},{n},{build:.3},{name},{row}");
                println!("{line}");
                csv = csv + &line + "\n";
            }
        }
    }
    Ok(csv)
}

/// A body of about `n` vertices and radius 1, or √2 for the prisms and the curve.
fn mesh(body: &str, n: usize) -> Result<PolygonMesh> {
    let sides = |corners: usize| corners.max(3) as u32;
    match body {
        "sphere" => models::ellipsoid([1.0, 1.0, 1.0], n),
        "plate" => models::ellipsoid([1.0, 1.0, 1e-3], n),
        "needle" => models::ellipsoid([1.0, 1e-3, 1e-3], n),
        "cone" => models::cone(sides(n - 1), 1.0),
        "flat cone" => models::cone(sides(n - 1), 1e-3),
        "bipyramid" => models::bipyramid(sides(n - 2), 1.0),
        "trapezohedron" => models::trapezohedron(sides(n / 2 - 1), 1.0),
        "prism" => models::prism(sides(n / 2), 1.0),
        "flat prism" => models::prism(sides(n / 2), 1e-3),
        "antiprism" => models::antiprism(sides(n / 2), 1.0),
        "moment curve" => models::moment_curve(n),
        _ => Err(Error::Argument(format!("{body}: one of {}", BODIES.join(", ")))),
    }
}

/// The body against itself.
fn measure(shape: &Shape, motion: Motion, queries: u32) -> Result<Row> {
    let mut random = Random::new(7);
    let config = PairConfig::default();
    let (mut cache, mut answer) = (PairCache::default(), PairAnswer::default());
    let mut row = Row { queries, ..Row::default() };
    for _ in 0..queries {
        let pose1 = Pose::new(&random.rotation(), &Vector::zeros());
        let rotation2 = random.rotation();
        let apart = if matches!(motion, Motion::Deep | Motion::Depth) {
            random.uniform(0.0, 1.0)
        } else {
            random.uniform(3.0, 5.0)
        };
        let mut translation2 = random.direction() * apart;
        if motion == Motion::Close {
            let pose2 = Pose::new(&rotation2, &translation2);
            pair::distance([shape.at(&pose1), shape.at(&pose2)], &mut PairCache::default(), &config, &mut answer)?;
            let gap = 10.0_f64.powf(random.uniform(-9.0, -1.0));
            translation2 += Vector::from(answer.normal) * (answer.distance - gap);
        }
        let pose2 = Pose::new(&rotation2, &translation2);
        if motion == Motion::Depth {
            let mut answer = DepthAnswer::default();
            let placed = [shape.at(&pose1), shape.at(&pose2)];
            pair::depth(placed, &mut DepthCache::default(), &DepthConfig::default(), &mut answer)?;
            row.add_depth(&answer);
            continue;
        }
        if motion != Motion::Teleport {
            cache = PairCache::default();
        }
        let query = if motion == Motion::Deep { pair::contact } else { pair::distance };
        // The best of a few, each from the same cache.
        let before = cache;
        let mut nanoseconds = f64::INFINITY;
        for _ in 0..REPEATS {
            cache = before;
            let start = Instant::now();
            query([shape.at(&pose1), shape.at(&pose2)], &mut cache, &config, &mut answer)?;
            nanoseconds = nanoseconds.min(start.elapsed().as_secs_f64() * 1e9);
        }
        row.add(&answer, nanoseconds);
    }
    Ok(row)
}

impl Row {
    fn add(&mut self, answer: &PairAnswer, nanoseconds: f64) {
        let statistics = answer.statistics;
        self.fallback += u32::from(answer.decided_by == DecidedBy::Fallback);
        self.exact += u32::from(answer.decided_by == DecidedBy::Integers);
        self.steps += u64::from(statistics.marching_steps);
        self.worst_steps = self.worst_steps.max(statistics.marching_steps);
        self.worst_fallback_iterations = self.worst_fallback_iterations.max(statistics.fallback_iterations);
        self.worst_exact_iterations = self.worst_exact_iterations.max(statistics.exact_iterations);
        self.nanoseconds += nanoseconds;
        self.worst_nanoseconds = self.worst_nanoseconds.max(nanoseconds);
    }

    fn add_depth(&mut self, answer: &DepthAnswer) {
        let statistics = answer.statistics;
        self.exact += u32::from(answer.ending == DepthEnding::Integers);
        self.steps += u64::from(statistics.steps);
        self.worst_steps = self.worst_steps.max(statistics.steps);
        self.worst_exact_iterations = self.worst_exact_iterations.max(statistics.exact_iterations);
        (self.nanoseconds, self.worst_nanoseconds) = (f64::NAN, f64::NAN);
    }
}
