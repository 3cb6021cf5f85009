//! Motions: an object that flies around another on an ellipse and turns about an axis of its own.

use std::f64::consts::TAU;
use std::fmt;
use std::str::FromStr;

use swiftprox::math::{Matrix, Vector};

use super::PosePair;
use super::random::{Random, rotation};

/// Object 2 turns a little faster than it orbits, so that no pose recurs.
const SPIN: f64 = 1.118_033_988_7;

/// An ellipse around object 1, for models of bounding radius 1.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Orbit {
    pub name: &'static str,
    /// The smaller half axis; the larger is 1.5 times as long.
    pub radius: f64,
}

/// Bounding spheres that touch at the nearest point of the orbit, that stay well apart, and that overlap.
pub const ORBITS: [Orbit; 3] =
    [Orbit { name: "small", radius: 2.0 }, Orbit { name: "large", radius: 3.0 }, Orbit { name: "deep", radius: 1.2 }];

/// How far object 2 moves from one query to the next.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Step {
    /// Degrees along the orbit.
    Degrees(f64),
    /// Anywhere on the orbit in any orientation: no coherence.
    Random,
}

pub const STEPS: [Step; 8] = [
    Step::Degrees(0.1),
    Step::Degrees(1.0),
    Step::Degrees(5.0),
    Step::Degrees(10.0),
    Step::Degrees(20.0),
    Step::Degrees(45.0),
    Step::Degrees(90.0),
    Step::Random,
];

impl fmt::Display for Step {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        match self {
            Step::Degrees(degrees) => write!(f, "{degrees}"),
            Step::Random => write!(f, "random"),
        }
    }
}

impl FromStr for Step {
    type Err = String;

    fn from_str(text: &str) -> Result<Step, String> {
        match text {
            "random" => Ok(Step::Random),
            _ => text.parse().map(Step::Degrees).map_err(|_| format!("{text}: not a step in degrees")),
        }
    }
}

/// The first `count` poses of an orbit.
pub fn poses(orbit: Orbit, step: Step, count: usize) -> Vec<PosePair> {
    let step_bits = match step {
        Step::Degrees(degrees) => degrees.to_bits(),
        Step::Random => 0,
    };
    let mut random = Random::new(orbit.radius.to_bits() ^ step_bits.rotate_left(17));
    let tilt = random.rotation();
    let rotation1 = random.rotation();
    let spin_axis = random.direction();
    let phase = random.uniform(0.0, TAU);
    let mut pose = |i: usize| {
        let (theta, rotation2) = match step {
            Step::Degrees(degrees) => {
                let turned = degrees.to_radians() * i as f64;
                (phase + turned, rotation(&spin_axis, SPIN * turned))
            }
            Step::Random => (random.uniform(0.0, TAU), random.rotation()),
        };
        let on_ellipse = Vector::new(orbit.radius * theta.cos(), 1.5 * orbit.radius * theta.sin(), 0.0);
        pose_pair(&rotation1, &Vector::zeros(), &rotation2, &(tilt * on_ellipse))
    };
    (0..count).map(&mut pose).collect()
}

/// Two rotations and translations as 24 numbers.
pub fn pose_pair(rotation1: &Matrix, translation1: &Vector, rotation2: &Matrix, translation2: &Vector) -> PosePair {
    let mut pair = [0.0; 24];
    for (base, rotation, translation) in [(0, rotation1, translation1), (12, rotation2, translation2)] {
        for row in 0..3 {
            for column in 0..3 {
                pair[base + 4 * row + column] = rotation[(row, column)];
            }
            pair[base + 4 * row + 3] = translation[row];
        }
    }
    pair
}
