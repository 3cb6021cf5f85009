//! Writes the catalogue of hard families to a folder, each pose with its exact truth, in the form that `make cases` reads:
//!
//!   cargo run --release --example hard_cases -- DIR [--seed N] [--count N] [--family NAME]...
//!
//! DIR/FAMILY/README says why the family is hard, with sources; DIR/FAMILY/cases.txt has a line `A.off B.off POSES TRUTH` for
//! each of `--count` sequences (the family's sweep of its parameters). A pose is a line of 24 doubles, the row-major 3x4
//! `[R|T]` of A and of B, each with 17 digits. A truth is a line of 13 numbers a pose:
//!
//!   lo hi  ax ay az  bx by bz  depth_lo depth_hi  nx ny nz
//!
//! The distance lies in [lo, hi], both 0 when the closed bodies meet. Disjoint: a and b are nearest points, n runs from A to B.
//! Intersecting: the depth, which is the least translation that leaves the interiors disjoint, lies in [depth_lo, depth_hi]; 0
//! means touching. Moving B by depth·n separates; a and b are a deepest pair, a − b = depth·n, or a common point when touching,
//! or `nan` where the bodies have too many vertices for the depth to be followed to the end. The bodies are the hulls of R·v +
//! T exactly as the doubles say. Every verdict and distance is computed in integers and rationals with nothing of the library
//! (`testkit/src/any_size`): the nearest points prove one bound, a supporting plane over all vertices the other.
//!
//! DIR/counts.csv tells what became of the poses when the library was asked for their distances, in order and with the cache
//! carried on: verdicts and intervals against that truth, the ways of deciding, and the most steps of each.

use std::collections::BTreeMap;
use std::error::Error;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};

use dashu_int::IBig;
use dashu_ratio::RBig;

use swiftprox::mesh::PolygonMesh;
use swiftprox::pair::Outcome;
use testkit::PosePair;
use testkit::any_size::decimal::{direction, root_enclosure, rounded};
use testkit::any_size::depth::depth;
use testkit::any_size::integers::{IntegerPair, place};
use testkit::any_size::nearest::nearest;
use testkit::hard::flight::{Table, Tally, fly, shapes};
use testkit::hard::{Family, Sequence, families, triangles};
use testkit::oracle::Truth;

/// Vertices of the Minkowski difference that are looked for to bound a depth, when the bodies are large.
const DEPTH_LIMIT: usize = 150;

/// The sum of the bodies' vertices up to which a depth is followed to its end.
const SMALL: usize = 120;

struct Arguments {
    folder: PathBuf,
    seed: u64,
    count: Option<usize>,
    families: Vec<String>,
}

fn main() -> ExitCode {
    match arguments().and_then(|arguments| write_all(&arguments)) {
        Ok(()) => ExitCode::SUCCESS,
        Err(message) => {
            eprintln!("hard_cases: {message}");
            ExitCode::from(2)
        }
    }
}

fn arguments() -> Result<Arguments, String> {
    let usage = "hard_cases DIR [--seed N] [--count N] [--family NAME]...";
    let mut words = std::env::args().skip(1);
    let folder = words.next().filter(|word| !word.starts_with('-')).ok_or(usage)?;
    let mut arguments = Arguments { folder: folder.into(), seed: 1, count: None, families: Vec::new() };
    while let Some(word) = words.next() {
        let value = words.next().ok_or(format!("{word}: a value is missing; {usage}"))?;
        let number = || value.parse::<u64>().map_err(|_| format!("{value}: not a number"));
        match word.as_str() {
            "--seed" => arguments.seed = number()?,
            "--count" => arguments.count = Some(number()? as usize),
            "--family" => arguments.families.push(value),
            _ => return Err(format!("{word}: unknown; {usage}")),
        }
    }
    Ok(arguments)
}

fn write_all(arguments: &Arguments) -> Result<(), String> {
    if let Some(unknown) = arguments.families.iter().find(|name| families().all(|family| family.name != **name)) {
        return Err(format!("{unknown}: no such family"));
    }
    let wanted =
        |family: &&Family| arguments.families.is_empty() || arguments.families.contains(&family.name.to_string());
    let mut tallies = Vec::new();
    for family in families().filter(wanted) {
        let folder = arguments.folder.join(family.name);
        let tally = write_family(family, &folder, arguments).map_err(|e| format!("{}: {e}", folder.display()))?;
        tallies.push((family.name, tally));
    }
    let table = Table(&tallies);
    println!("{table}");
    fs::write(arguments.folder.join("counts.csv"), table.csv()).map_err(|e| format!("counts.csv: {e}"))
}

/// Returns what the library makes of it.
fn write_family(family: &Family, folder: &Path, arguments: &Arguments) -> Result<Tally, Box<dyn Error>> {
    fs::create_dir_all(folder)?;
    let sources = family.sources.join(", ");
    let (seed, count) = (arguments.seed, arguments.count.unwrap_or(family.sweep));
    let truth = "truth: exact integers and rationals, without the library (testkit/src/any_size)";
    fs::write(
        folder.join("README"),
        format!("{}: {}\nsources: {sources}\nseed {seed}, {count} sequences\n{truth}\n", family.name, family.why),
    )?;
    let (mut list, mut tally) = (String::new(), Tally::default());
    for index in 0..count {
        let sequence = family.sequence(seed, index);
        let stem = format!("c{index}_{}", sequence.name);
        let meshes = [format!("m{}.off", 2 * index), format!("m{}.off", 2 * index + 1)];
        for (name, body) in meshes.iter().zip(&sequence.bodies) {
            fs::write(folder.join(name), off(body))?;
        }
        fs::write(folder.join(format!("{stem}.poses")), pose_lines(&sequence.poses))?;
        let found = truths(&sequence);
        let lines: String = found.iter().map(|(line, _)| line.as_str()).collect();
        fs::write(folder.join(format!("{stem}.truth")), lines)?;
        list += &format!("{} {} {stem}.poses {stem}.truth\n", meshes[0], meshes[1]);
        let [first, second] = &shapes(&sequence)?;
        tally.sequences += 1;
        fly(&sequence, [first, second], |number, _, answer, _| {
            let truth = &found[number].1;
            tally.count(answer, [first, second]);
            tally.wrong += usize::from(truth.intersecting() != (answer.outcome == Outcome::Intersecting));
            tally.missed += usize::from(!truth.lies_between(answer.lower, answer.upper));
        })?;
    }
    fs::write(folder.join("cases.txt"), list)?;
    Ok(tally)
}

fn off(body: &PolygonMesh) -> String {
    let triangles = triangles(body);
    let mut text = format!("OFF\n{} {} 0\n", body.vertices.len(), triangles.len());
    for v in &body.vertices {
        text += &format!("{:.16e} {:.16e} {:.16e}\n", v.x, v.y, v.z);
    }
    for [a, b, c] in triangles {
        text += &format!("3 {a} {b} {c}\n");
    }
    text
}

fn pose_lines(poses: &[PosePair]) -> String {
    let line = |pair: &PosePair| pair.map(|x| format!("{x:.16e}")).join(" ") + "\n";
    poses.iter().map(line).collect()
}

/// The truth of every pose and its line, two threads taking pose after pose.
fn truths(sequence: &Sequence) -> Vec<(String, Truth)> {
    let points =
        sequence.bodies.each_ref().map(|body| body.vertices.iter().map(|&v| v.into()).collect::<Vec<[f64; 3]>>());
    let next = AtomicUsize::new(0);
    let found = Mutex::new(BTreeMap::new());
    let work = || {
        loop {
            let index = next.fetch_add(1, Ordering::Relaxed);
            let Some(pair) = sequence.poses.get(index) else { return };
            let truth = truth(&place(&points[0], &points[1], pair));
            found.lock().expect("no panic").insert(index, truth);
        }
    };
    std::thread::scope(|scope| {
        scope.spawn(work);
        work();
    });
    found.into_inner().expect("no panic").into_values().collect()
}

fn truth(placed: &IntegerPair) -> (String, Truth) {
    let e = placed.exponent;
    let written = |point: &[RBig; 3]| point.each_ref().map(|x| rounded(x, e)).join(" ");
    let found = nearest(placed);
    let truth = Truth { squared_distance: found.world_square(placed) };
    let [a, b] = [found.point(&placed.a, 0), found.point(&placed.b, 1)];
    if !truth.intersecting() {
        let [lo, hi] = root_enclosure(&found.square, e);
        let towards_b = [0, 1, 2].map(|k| &b[k] - &a[k]);
        let normal = direction(&integers(&towards_b)).join(" ");
        return (format!("{lo} {hi} {} {} 0 0 {normal}\n", written(&a), written(&b)), truth);
    }
    let limit = if placed.a.count() + placed.b.count() <= SMALL { usize::MAX } else { DEPTH_LIMIT };
    let depth = depth(placed, limit);
    let [[lo, _], [_, hi]] = [&depth.lower_square, &depth.upper_square].map(|square| root_enclosure(square, e));
    let points = if hi == "0" {
        format!("{} {}", written(&a), written(&b))
    } else {
        depth.points.map_or("nan nan nan nan nan nan".to_string(), |[a, b]| format!("{} {}", written(&a), written(&b)))
    };
    (format!("0 0 {points} {lo} {hi} {}\n", direction(&depth.direction).join(" ")), truth)
}

/// A vector with rational components times their common denominator.
fn integers(v: &[RBig; 3]) -> [IBig; 3] {
    let product = v.iter().fold(IBig::ONE, |product, x| product * IBig::from(x.denominator().clone()));
    v.each_ref().map(|x| x.numerator() * (&product / IBig::from(x.denominator().clone())))
}
