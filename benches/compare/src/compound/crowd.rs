//! Scenes in which all bodies move: verdicts, distances up to a tolerance, contacts.

use std::collections::HashMap;
use std::sync::Arc;

use parry3d_f64::bounding_volume::BoundingVolume;
use parry3d_f64::math::Pose as ParryPose;
use parry3d_f64::partitioning::{Bvh, BvhWorkspace};
use parry3d_f64::query::{ClosestPoints, closest_points};
use parry3d_f64::shape::{Compound as ParryCompound, Shape};
use swiftprox::error::Error;
use swiftprox::math::{Pose, Vector};
use swiftprox::object::ObjectOptions;
use swiftprox::scene::{ContactDetail, Scene as SwiftproxScene, SceneQuery};
use testkit::random::{Random, rotation};

use super::parry::Kept;
use super::scenes::{Pieces, gear, torus};
use super::{Method, Row, Scene, ours, parry};
use crate::options::Options;
use crate::parry::pose_of;

/// Distances up to this are listed, and contacts up to [`MARGIN`](super::resting::MARGIN).
const TOLERANCE: f64 = 0.1;
const STEPS: usize = 9;

#[derive(Debug, Clone, Copy, PartialEq)]
enum Asked {
    Verdict,
    Distance,
    Contacts,
}

const ASKED: [(&str, Asked); 3] =
    [("verdict", Asked::Verdict), ("distance", Asked::Distance), ("contacts", Asked::Contacts)];

impl Asked {
    /// What is farther apart is not listed.
    fn reach(self) -> f64 {
        match self {
            Asked::Verdict => 0.0,
            Asked::Distance => TOLERANCE,
            Asked::Contacts => super::resting::MARGIN,
        }
    }
}

/// How many bodies in a cube of what side, and their pieces.
fn worlds() -> [(&'static str, usize, f64, Pieces); 2] {
    [("500 gears", 500, 20.0, gear(40)), ("1000 tori", 1000, 26.0, torus(24))]
}

pub fn measure(options: &Options) -> Result<Vec<Row>, String> {
    let mut rows = Vec::new();
    for (name, count, side, pieces) in worlds() {
        let steps = steps(count, side);
        for (asked, what) in ASKED {
            let ours = |rows| InScene::new(&pieces, rows, &steps, what).map_err(|error| format!("{name}: {error}"));
            let methods: Vec<Box<dyn Method + '_>> = vec![
                Box::new(ours(Rows::Compounds)?),
                Box::new(Parry::new(&pieces, &steps, what)?),
                Box::new(ours(Rows::Pieces)?),
            ];
            let scene = Scene { asked, bodies: name, pieces: pieces.len(), motion: "all" };
            // Pieces are listed pair by pair.
            rows.extend(scene.measure(methods, [STEPS, options.passes], f64::INFINITY, |listed| listed as usize)?);
        }
    }
    Ok(rows)
}

/// Each turns by 0.02 about an axis of its own and goes straight on by up to 0.02√3.
fn steps(count: usize, side: f64) -> Vec<Vec<Pose>> {
    let mut random = Random::new(0x5ce);
    let of_body = |_| {
        let (turn, place) = (random.rotation(), random.vector() * (0.5 * side));
        let (axis, way) = (random.direction(), random.vector() * 0.02);
        (turn, place, axis, way)
    };
    let bodies: Vec<_> = (0..count).map(of_body).collect();
    let at = |step: usize| {
        let time = step as f64;
        let pose = |(turn, place, axis, way): &(_, Vector, Vector, Vector)| {
            Pose::new(&(rotation(axis, 0.02 * time) * turn), &(place + way * time))
        };
        bodies.iter().map(pose).collect()
    };
    (0..STEPS).map(at).collect()
}

/// What a row of the scene is.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Rows {
    Compounds,
    Pieces,
}

struct InScene<'a> {
    scene: SwiftproxScene,
    rows: Rows,
    steps: &'a [Vec<Pose>],
    asked: Asked,
}

impl<'a> InScene<'a> {
    fn new(pieces: &Pieces, rows: Rows, steps: &'a [Vec<Pose>], asked: Asked) -> Result<InScene<'a>, Error> {
        let mut scene = SwiftproxScene::new();
        let (compound, shapes) = (Arc::new(ours::compound(pieces)?), ours::shapes(pieces)?);
        for pose in &steps[0] {
            let options = ObjectOptions { pose: *pose, ..ObjectOptions::default() };
            match rows {
                Rows::Compounds => scene.add_compound(compound.clone(), &options)?,
                Rows::Pieces => scene.add_object(shapes.clone(), &options)?,
            };
        }
        Ok(InScene { scene, rows, steps, asked })
    }
}

impl Method for InScene<'_> {
    fn name(&self) -> &'static str {
        match self.rows {
            Rows::Compounds => ours::NAME,
            Rows::Pieces => "swiftprox-rows",
        }
    }

    fn ask(&mut self, k: usize) -> f64 {
        self.scene.set_all_poses(&self.steps[k]).expect("rigid poses");
        let query = SceneQuery { max_distance: self.asked.reach(), ..SceneQuery::default() };
        let manifolds = SceneQuery { detail: ContactDetail::ReducedManifold, ..query };
        let answer = match self.asked {
            Asked::Verdict => self.scene.query_intersection(&query),
            Asked::Distance => self.scene.query_distance(&query),
            Asked::Contacts => self.scene.query_contact(&manifolds),
        };
        answer.expect("a sound query").pairs.len() as f64
    }
}

/// Its hierarchy over the bodies, refitted in each step, and its queries of compounds for what is near. Contacts are kept while two
/// bodies are near.
struct Parry {
    compound: ParryCompound,
    steps: Vec<Vec<ParryPose>>,
    asked: Asked,
    tree: Bvh,
    workspace: BvhWorkspace,
    /// And the step in which they were near.
    kept: HashMap<(u32, u32), (Kept, u64)>,
    step: u64,
}

impl Parry {
    fn new(pieces: &Pieces, steps: &[Vec<Pose>], asked: Asked) -> Result<Parry, String> {
        let poses = |step: &Vec<Pose>| step.iter().map(|pose| pose_of(pose.rows.as_flattened())).collect();
        Ok(Parry {
            compound: parry::compound(pieces)?,
            steps: steps.iter().map(poses).collect(),
            asked,
            tree: Bvh::new(),
            workspace: BvhWorkspace::default(),
            kept: HashMap::new(),
            step: 0,
        })
    }
}

impl Method for Parry {
    fn name(&self) -> &'static str {
        parry::NAME
    }

    fn ask(&mut self, k: usize) -> f64 {
        let Parry { compound, steps, asked, tree, workspace, kept, step } = self;
        let (poses, reach) = (&steps[k], asked.reach());
        *step += 1;
        for (i, pose) in (0..).zip(poses) {
            tree.insert_or_update_partially(compound.compute_aabb(pose).loosened(0.5 * reach), i, 0.0);
        }
        tree.refit(workspace);
        tree.optimize_incremental(workspace);
        let mut listed = 0;
        tree.traverse_bvtt_single_tree::<false>(workspace, &mut |a, b| {
            let [pose1, pose2] = [a, b].map(|i| &poses[i as usize]);
            let bodies = [(pose1, &*compound), (pose2, &*compound)];
            listed += match asked {
                Asked::Verdict => usize::from(parry::meet(bodies)),
                Asked::Distance => {
                    let found = closest_points(pose1, compound, pose2, compound, reach);
                    usize::from(!matches!(found.expect("parry answers compounds"), ClosestPoints::Disjoint))
                }
                Asked::Contacts => {
                    let (kept, last) = kept.entry((a, b)).or_default();
                    *last = *step;
                    kept.count(bodies, reach)
                }
            };
        });
        kept.retain(|_, (_, last)| *last == *step);
        listed as f64
    }
}
