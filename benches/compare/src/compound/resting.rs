//! Contacts of two bodies at rest, one upon the other: they tremble from pose to pose as in a simulator.

use std::sync::Arc;

use parry3d_f64::math::Pose as ParryPose;
use parry3d_f64::shape::Compound as ParryCompound;
use swiftprox::compound::{Compound, CompoundContacts, contacts};
use swiftprox::manifold::ManifoldConfig;
use swiftprox::math::{Pose, Vector};
use swiftprox::object::{ObjectId, ObjectOptions};
use swiftprox::scene::{ContactDetail, Scene as SwiftproxScene, SceneQuery};
use testkit::random::{Random, rotation};

use super::parry::Kept;
use super::scenes::{Pieces, chair, gear, torus};
use super::{Method, Row, Scene, ours, parry};
use crate::options::Options;
use crate::parry::pose_of;

/// Points up to so far apart are contacts.
pub const MARGIN: f64 = 0.01;

/// How deep they are in each other, and how much they tremble.
const DEPTH: f64 = 1e-4;

/// A name, the lower and the upper body, and how far above it is when they touch.
fn stacks() -> [(&'static str, [Pieces; 2], f64); 3] {
    [
        ("gear on gear", [gear(40), gear(40)], 0.3),
        ("torus-64 on torus-64", [torus(64), torus(64)], 0.6),
        ("chair on gear", [gear(40), chair()], 0.65),
    ]
}

pub fn measure(options: &Options) -> Result<Vec<Row>, String> {
    let mut rows = Vec::new();
    for (name, pieces, height) in stacks() {
        let told = |error: swiftprox::error::Error| format!("{name}: {error}");
        let ours = [ours::compound(&pieces[0]).map_err(told)?, ours::compound(&pieces[1]).map_err(told)?].map(Arc::new);
        let theirs = [parry::compound(&pieces[0])?, parry::compound(&pieces[1])?];
        let poses = poses(height, options.count);
        let methods: Vec<Box<dyn Method + '_>> = vec![
            Box::new(InScene::new(&ours, &poses).map_err(told)?),
            Box::new(Alone { bodies: &ours, poses: &poses, found: CompoundContacts::default() }),
            Box::new(Parry::new(&theirs, &poses)),
        ];
        let scene = Scene { asked: "contacts", bodies: name, pieces: pieces[1].len(), motion: "rest" };
        // Pairs of pieces at exactly the margin are listed by some.
        rows.extend(scene.measure(methods, [poses.len(), options.passes], f64::INFINITY, |count| count as usize)?);
    }
    Ok(rows)
}

/// Where the upper body is.
fn poses(height: f64, count: usize) -> Vec<Pose> {
    let mut random = Random::new(0x4e57);
    let rest = Vector::new(0.06, 0.04, height - DEPTH);
    let mut pose = |_| {
        let turn = rotation(&random.direction(), 0.5 * DEPTH * random.signed()) * rotation(&Vector::z(), 0.1);
        Pose::new(&turn, &(rest + random.vector() * (0.5 * DEPTH)))
    };
    (0..count).map(&mut pose).collect()
}

/// By a scene, which keeps caches of both bodies.
struct InScene<'a> {
    scene: SwiftproxScene,
    upper: ObjectId,
    poses: &'a [Pose],
}

impl<'a> InScene<'a> {
    fn new(bodies: &[Arc<Compound>; 2], poses: &'a [Pose]) -> Result<InScene<'a>, swiftprox::error::Error> {
        let mut scene = SwiftproxScene::new();
        scene.add_compound(bodies[0].clone(), &ObjectOptions { fixed: true, ..ObjectOptions::default() })?;
        let upper = scene.add_compound(bodies[1].clone(), &ObjectOptions::default())?;
        Ok(InScene { scene, upper, poses })
    }
}

impl Method for InScene<'_> {
    fn name(&self) -> &'static str {
        ours::NAME
    }

    fn ask(&mut self, k: usize) -> f64 {
        self.scene.set_pose(self.upper, &self.poses[k]).expect("a rigid pose");
        let query =
            SceneQuery { max_distance: MARGIN, detail: ContactDetail::ReducedManifold, ..SceneQuery::default() };
        self.scene.query_contact(&query).expect("a sound query").pairs.len() as f64
    }
}

/// By one call without a cache.
struct Alone<'a> {
    bodies: &'a [Arc<Compound>; 2],
    poses: &'a [Pose],
    found: CompoundContacts,
}

impl Method for Alone<'_> {
    fn name(&self) -> &'static str {
        "swiftprox-call"
    }

    fn ask(&mut self, k: usize) -> f64 {
        let bodies = [self.bodies[0].at(&Pose::IDENTITY), self.bodies[1].at(&self.poses[k])];
        let config = ManifoldConfig { max_distance: MARGIN, reduces: true };
        contacts(bodies, &config, &mut self.found).expect("rigid poses");
        self.found.contacts.len() as f64
    }
}

struct Parry<'a> {
    bodies: &'a [ParryCompound; 2],
    poses: Vec<ParryPose>,
    kept: Kept,
}

impl<'a> Parry<'a> {
    fn new(bodies: &'a [ParryCompound; 2], poses: &[Pose]) -> Parry<'a> {
        let poses = poses.iter().map(|pose| pose_of(pose.rows.as_flattened())).collect();
        Parry { bodies, poses, kept: Kept::default() }
    }
}

impl Method for Parry<'_> {
    fn name(&self) -> &'static str {
        parry::NAME
    }

    fn forget(&mut self) {
        self.kept = Kept::default();
    }

    fn ask(&mut self, k: usize) -> f64 {
        let [lower, upper] = self.bodies;
        self.kept.count([(&ParryPose::IDENTITY, lower), (&self.poses[k], upper)], MARGIN) as f64
    }
}
