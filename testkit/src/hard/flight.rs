//! Sequences flown with the cache carried on, and what the queries did, counted by family.

use std::fmt;
use std::ops::AddAssign;

use swiftprox::error::Result;
use swiftprox::math::Pose;
use swiftprox::pair::{DecidedBy, Outcome, PairAnswer, PairCache, PairConfig, distance};
use swiftprox::shape::{InputPolicy, Shape, ShapeOptions};

use super::Sequence;
use crate::PosePair;

/// The bodies of a sequence, hulls where they have no faces.
pub fn shapes(sequence: &Sequence) -> Result<[Shape; 2]> {
    let options = ShapeOptions { input: InputPolicy::Hull, ..ShapeOptions::default() };
    let [first, second] = &sequence.bodies;
    Ok([Shape::from_mesh(first, &options)?, Shape::from_mesh(second, &options)?])
}

/// The two poses of a pair.
pub fn poses(pair: &PosePair) -> [Pose; 2] {
    [0, 12].map(|base| Pose::from_row_major(&std::array::from_fn(|k| pair[base + k])))
}

/// Asks for the distance at every pose of a sequence, each time from the cache that the last query left.
///
/// # Errors
/// The first query that is refused.
pub fn fly(
    sequence: &Sequence,
    shapes: [&Shape; 2],
    mut each: impl FnMut(usize, &[Pose; 2], &PairAnswer, &PairCache),
) -> Result<()> {
    let mut cache = PairCache::default();
    for (number, pair) in sequence.poses.iter().enumerate() {
        let poses = poses(pair);
        let mut answer = PairAnswer::default();
        let config = PairConfig::default();
        distance([shapes[0].at(&poses[0]), shapes[1].at(&poses[1])], &mut cache, &config, &mut answer)?;
        each(number, &poses, &answer, &cache);
    }
    Ok(())
}

/// What the queries of a family came to.
#[derive(Debug, Default, Clone)]
pub struct Tally {
    pub sequences: usize,
    pub poses: usize,
    pub intersecting: usize,
    /// Verdicts that are not the truth, intervals that miss it, numbers that are due and are not.
    pub wrong: usize,
    pub missed: usize,
    pub not_a_number: usize,
    /// Queries by [`DecidedBy`].
    pub by_decider: [usize; 9],
    pub most_marching_steps: u32,
    pub most_fallback_iterations: u32,
    pub most_exact_iterations: u32,
    /// Vertices of the larger body at the query with the most marching steps.
    pub vertices_there: usize,
}

impl Tally {
    /// Counts an answer; wrong and missed are for the caller, who knows the truth.
    pub fn count(&mut self, answer: &PairAnswer, shapes: [&Shape; 2]) {
        let statistics = &answer.statistics;
        self.poses += 1;
        self.intersecting += usize::from(answer.outcome == Outcome::Intersecting);
        self.not_a_number += usize::from(has_nan(answer));
        self.by_decider[answer.decided_by as usize] += 1;
        if statistics.marching_steps >= self.most_marching_steps {
            self.most_marching_steps = statistics.marching_steps;
            self.vertices_there = shapes.map(|shape| shape.polyhedron().vertices.len()).into_iter().fold(0, usize::max);
        }
        self.most_fallback_iterations = self.most_fallback_iterations.max(statistics.fallback_iterations);
        self.most_exact_iterations = self.most_exact_iterations.max(statistics.exact_iterations);
    }

    /// Queries that nothing decided.
    pub fn unnamed(&self) -> usize {
        self.by_decider[DecidedBy::None as usize]
    }

    /// The head of the columns of [`Tally::row`].
    pub const COLUMNS: [&str; 16] = [
        "sequences",
        "poses",
        "intersecting",
        "wrong",
        "missed",
        "not_a_number",
        "unnamed",
        "marched",
        "coherent",
        "spheres",
        "fallback",
        "exact",
        "most_marching_steps",
        "vertices_there",
        "most_fallback_iterations",
        "most_exact_iterations",
    ];

    pub fn row(&self) -> [usize; 16] {
        let [unnamed, marched, coherent, fallback, exact, _, _, apart, within] = self.by_decider;
        let spheres = apart + within;
        let Tally { sequences, poses, intersecting, wrong, missed, not_a_number, vertices_there, .. } = *self;
        let [marching, falling, exactly] =
            [self.most_marching_steps, self.most_fallback_iterations, self.most_exact_iterations].map(|n| n as usize);
        let verdicts = [sequences, poses, intersecting, wrong, missed, not_a_number, unnamed];
        let statuses = [marched, coherent, spheres, fallback, exact];
        let most = [marching, vertices_there, falling, exactly];
        let mut row = [0; 16];
        let numbers = verdicts.into_iter().chain(statuses).chain(most);
        row.iter_mut().zip(numbers).for_each(|(entry, number)| *entry = number);
        row
    }
}

impl AddAssign<&Tally> for Tally {
    fn add_assign(&mut self, other: &Tally) {
        self.sequences += other.sequences;
        self.poses += other.poses;
        self.intersecting += other.intersecting;
        self.wrong += other.wrong;
        self.missed += other.missed;
        self.not_a_number += other.not_a_number;
        self.by_decider.iter_mut().zip(other.by_decider).for_each(|(mine, others)| *mine += others);
        if other.most_marching_steps >= self.most_marching_steps {
            self.most_marching_steps = other.most_marching_steps;
            self.vertices_there = other.vertices_there;
        }
        self.most_fallback_iterations = self.most_fallback_iterations.max(other.most_fallback_iterations);
        self.most_exact_iterations = self.most_exact_iterations.max(other.most_exact_iterations);
    }
}

/// A table with a row for each family and one for all.
pub struct Table<'a>(pub &'a [(&'static str, Tally)]);

impl Table<'_> {
    /// The rows as comma-separated values, those of the families alone.
    pub fn csv(&self) -> String {
        let mut text = format!("family,{}\n", Tally::COLUMNS.join(","));
        for (name, tally) in self.0 {
            text += &format!("{name},{}\n", tally.row().map(|n| n.to_string()).join(","));
        }
        text
    }
}

impl fmt::Display for Table<'_> {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        let mut all = Tally::default();
        self.0.iter().for_each(|(_, tally)| all += tally);
        let heads = Tally::COLUMNS.map(|column| column.replace("most_", "").replace("_iterations", ""));
        write!(f, "{:17}", "family")?;
        heads.iter().try_for_each(|head| write!(f, " {:>8}", head.get(..8).unwrap_or(head)))?;
        for (name, tally) in self.0.iter().map(|(name, tally)| (*name, tally)).chain([("all", &all)]) {
            write!(f, "\n{name:17}")?;
            tally.row().iter().try_for_each(|n| write!(f, " {n:>8}"))?;
        }
        Ok(())
    }
}

/// Whether something that the answer to a distance query is to say is NaN.
fn has_nan(answer: &PairAnswer) -> bool {
    let PairAnswer { distance, lower, upper, local1, local2, world1, world2, normal, .. } = answer;
    let numbers = [*distance, *lower, *upper];
    let points = [local1, local2, world1, world2, normal];
    let is_separated = answer.outcome != Outcome::Intersecting;
    numbers.iter().any(|x| x.is_nan()) || (is_separated && points.into_iter().flatten().any(|x| x.is_nan()))
}
