//! Configurations from issue threads of other libraries, with the numbers that were reported.

use swiftprox::math::Vector;

use super::bodies::{cuboid, hull_of};
use super::placing::{moved, power_of_ten};
use super::{Family, Sequence};
use crate::PosePair;
use crate::orbits::pose_pair;
use crate::random::Random;
use swiftprox::math::Matrix;
use swiftprox::mesh::PolygonMesh;

pub const FAMILIES: &[Family] = &[Family {
    name: "threads",
    sweep: 25,
    why: "what users of other libraries reported, with the numbers given there, and the same a hair away",
    sources: &["one thread a case, its address in threads.txt"],
    make: threads,
}];

/// What was reported: its address, two bodies, poses.
struct Thread {
    address: &'static str,
    bodies: Vec<PolygonMesh>,
    poses: Vec<PosePair>,
}

fn threads(random: &mut Random, index: usize) -> Sequence {
    let mut all = parsed(include_str!("threads.txt"));
    let Thread { address, bodies, poses: reported } = all.swap_remove(index % all.len());
    let mut poses = reported.clone();
    for _ in 0..10 {
        let pair = random.pick(&reported);
        let hair = power_of_ten(random, -16, -3) * random.vector();
        let mut near = pair;
        (0..3).for_each(|k| near[15 + 4 * k] += hair[k]);
        poses.push(near);
        // The whole seen from another frame.
        let turn = random.rotation();
        let [(r1, t1), (r2, t2)] = [0, 12].map(|base| {
            let rotation = Matrix::from_fn(|row, column| pair[base + 4 * row + column]);
            (turn * rotation, turn * Vector::from_fn(|row, _| pair[base + 4 * row + 3]))
        });
        poses.push(moved(pose_pair(&r1, &t1, &r2, &t2), &random.vector()));
    }
    let bodies = <[PolygonMesh; 2]>::try_from(bodies).expect("two bodies a thread");
    let words: Vec<&str> = address.rsplit('/').collect();
    Sequence { name: format!("{}{}", words[2].to_lowercase(), words[0]), bodies, poses }
}

fn parsed(text: &'static str) -> Vec<Thread> {
    let mut threads: Vec<Thread> = Vec::new();
    for line in text.lines().filter(|line| !line.starts_with('#')) {
        let (word, rest) = line.split_once(' ').expect("a word and what it is about");
        if word == "thread" {
            threads.push(Thread { address: rest, bodies: Vec::new(), poses: Vec::new() });
            continue;
        }
        let numbers: Vec<f64> = rest.split(' ').map(|x| x.parse().expect("a number")).collect();
        let thread = threads.last_mut().expect("an address first");
        match word {
            "box" => thread.bodies.push(cuboid([numbers[0], numbers[1], numbers[2]])),
            "points" => thread.bodies.push(hull_of(numbers.chunks(3).map(Vector::from_column_slice).collect())),
            _ => thread.poses.push(numbers.try_into().expect("24 numbers")),
        }
    }
    threads
}
