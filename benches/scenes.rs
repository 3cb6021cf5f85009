//! What a step of a scene costs: poses set, one query answered. Ellipsoids of 102 vertices and radius 1 at constant density, moving
//! so that none changes its speed.
//!
//! `cargo bench --bench scenes -- [COUNT …] [MOTION …] [QUERY …]` prints a row for each motion and query: milliseconds a step, mean, median and worst, over
//! a hundred steps or as many as fit a second, behind two that are not timed; and what the queries did, a step.

#[path = "common/mod.rs"]
mod common;

use std::sync::Arc;
use std::time::Instant;

use common::models::{ELLIPSOIDS, ellipsoid};
use common::random::Random;
use swiftprox::math::{Matrix, Pose, Vector};
use swiftprox::object::{ObjectId, ObjectOptions};
use swiftprox::scene::{Scene, SceneOptions, SceneQuery};
use swiftprox::shape::{Shape, ShapeOptions};

/// Objects in a unit of volume: each one's box overlaps those of about 3.4 others.
const DENSITY: f64 = 0.053;

/// How far an object goes in a step, and how far it turns.
const STEP: f64 = 0.03;

const QUERIES: [&str; 3] = ["intersection", "distance", "contacts"];

#[derive(Debug, Clone, Copy, PartialEq)]
enum Motion {
    All,
    OneInTwenty,
    Teleport,
}

struct Flight {
    random: Random,
    size: f64,
    motion: Motion,
    poses: Vec<Pose>,
    velocities: Vec<(Matrix, Vector)>,
}

impl Flight {
    fn new(count: usize, motion: Motion) -> Flight {
        let size = 0.5 * (count as f64 / DENSITY).cbrt();
        let mut random = Random::new(count as u64);
        let poses = (0..count).map(|_| Pose::new(&random.rotation(), &(random.vector() * size))).collect();
        let velocity = |_| {
            let turn = nalgebra::Rotation3::from_scaled_axis(random.direction() * STEP);
            (turn.into_inner(), random.direction() * STEP)
        };
        let velocities = (0..count).map(velocity).collect();
        Flight { random, size, motion, poses, velocities }
    }

    /// The objects that move in the next step.
    fn step(&mut self, moved: &mut Vec<usize>) {
        moved.clear();
        for k in 0..self.poses.len() {
            if self.motion == Motion::OneInTwenty && self.random.below(20) > 0 {
                continue;
            }
            moved.push(k);
            self.poses[k] = if self.motion == Motion::Teleport {
                Pose::new(&self.random.rotation(), &(self.random.vector() * self.size))
            } else {
                let (turn, way) = &mut self.velocities[k];
                let next = self.poses[k].translation() + *way;
                for axis in 0..3 {
                    if next[axis].abs() > self.size {
                        way[axis] = -way[axis];
                    }
                }
                Pose::new(&(*turn * self.poses[k].rotation()), &(self.poses[k].translation() + *way))
            };
        }
    }
}

fn measure(count: usize, motion: Motion, query: &str) {
    let shape =
        Arc::new(Shape::from_mesh(&ellipsoid(ELLIPSOIDS[0].1, 102).unwrap(), &ShapeOptions::default()).unwrap());
    let mut flight = Flight::new(count, motion);
    let mut scene = Scene::new(&SceneOptions::default()).unwrap();
    let add = |pose: &Pose| {
        scene.add_object(vec![shape.clone()], &ObjectOptions { pose: *pose, ..ObjectOptions::default() }).unwrap()
    };
    let ids: Vec<ObjectId> = flight.poses.iter().map(add).collect();
    let near = SceneQuery { distance_tolerance: 0.25, ..SceneQuery::default() };
    let (mut times, mut listed, mut moved) = (Vec::new(), 0, Vec::new());
    let begin = Instant::now();
    for step in 0..102 {
        flight.step(&mut moved);
        let start = Instant::now();
        for &k in &moved {
            scene.set_pose(ids[k], &flight.poses[k]).unwrap();
        }
        let set = start.elapsed();
        let answer = match query {
            "intersection" => scene.query_intersection(&near),
            "distance" => scene.query_exact_distance(&near),
            _ => scene.query_contacts(&near),
        };
        listed += answer.unwrap().pairs.len();
        if step >= 2 {
            times.push((start.elapsed().as_secs_f64() * 1e3, set.as_secs_f64() * 1e3));
        } else {
            scene.reset_statistics();
            listed = 0;
        }
        if begin.elapsed().as_secs_f64() > 2.0 && times.len() > 10 {
            break;
        }
    }
    let steps = times.len();
    let setting = times.iter().map(|(_, set)| set).sum::<f64>() / steps as f64;
    let mean = times.iter().map(|(all, _)| all).sum::<f64>() / steps as f64;
    times.sort_by(|a, b| a.0.total_cmp(&b.0));
    let statistics = scene.statistics();
    let each = |total: u64| total as usize / steps;
    println!(
        "{count},{motion:?},{query},{mean:.4},{:.4},{:.4},{setting:.4},{},{},{},{},{},{},{},{}",
        times[steps / 2].0,
        times[steps - 1].0,
        listed / steps,
        each(statistics.pairs),
        each(statistics.out_of_reach),
        each(statistics.unmoved),
        each(statistics.bounding_spheres),
        each(statistics.inscribed_spheres),
        each(statistics.marched),
        each(statistics.coherent + statistics.fallback + statistics.exact),
    );
}

fn main() {
    println!(
        "objects,motion,query,mean ms,median ms,worst ms,of it poses,listed,looked at,out of reach,unmoved,far apart,balls overlap,marched,others"
    );
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let counts: Vec<usize> = arguments.iter().filter_map(|argument| argument.parse().ok()).collect();
    let is_asked = |names: &[&str], name: &str| {
        let is_one = |argument: &String| names.contains(&argument.as_str());
        !arguments.iter().any(is_one) || arguments.iter().any(|argument| argument == name)
    };
    for count in if counts.is_empty() { vec![100, 1_000, 10_000] } else { counts } {
        for motion in [Motion::All, Motion::OneInTwenty, Motion::Teleport] {
            for query in QUERIES {
                let motions = ["All", "OneInTwenty", "Teleport"];
                if is_asked(&motions, &format!("{motion:?}")) && is_asked(&QUERIES, query) {
                    measure(count, motion, query);
                }
            }
        }
    }
}
