//! Verdicts and distances of two equal bodies, pose by pose.

use super::ours::{self, Ours};
use super::parry::{self, Parry};
use super::{Method, Row, Scene, met, native, scenes};
use crate::options::Options;

/// What is asked.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Asked {
    Verdict,
    Distance,
}

const ASKED: [(&str, Asked); 2] = [("verdict", Asked::Verdict), ("distance", Asked::Distance)];

/// The distances of parry and coal are as good as their tolerances.
const ALLOWED: f64 = 1e-5;

pub fn measure(options: &Options) -> Result<Vec<Row>, String> {
    let mut rows = Vec::new();
    for (name, points) in scenes::bodies() {
        let ours = ours::compound(&points).map_err(|error| format!("{name}: {error}"))?;
        let theirs = parry::compound(&points).map_err(|error| format!("{name}: {error}"))?;
        for motion in scenes::MOTIONS.into_iter().filter(|motion| scenes::has(name, motion)) {
            let poses = scenes::poses(motion, &ours, options.count).map_err(|error| format!("{name}: {error}"))?;
            for (asked, what) in ASKED {
                let mut methods: Vec<Box<dyn Method + '_>> =
                    vec![Box::new(Ours::new(&ours, &poses, what)), Box::new(Parry::new(&theirs, &poses, what))];
                methods.extend(native::methods(&points, &poses, what)?);
                let scene = Scene { asked, bodies: name, pieces: points.len(), motion };
                rows.extend(scene.measure(methods, [poses.len(), options.passes], ALLOWED, met)?);
            }
        }
    }
    Ok(rows)
}
