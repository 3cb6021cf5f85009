//! This library's scene, as a program uses it: poses of what moved, then one query.

use std::sync::Arc;

use swiftprox::math::Pose;
use swiftprox::object::{ObjectId, ObjectOptions};
use swiftprox::scene::{ContactDetail, Scene, SceneQuery, Workers};
use swiftprox::shape::{InputPolicy, Shape, ShapeOptions};

use super::world::{Step, World};
use super::{Crowd, Found, Question, TOLERANCE};

/// A scene with so many workers.
pub fn name(workers: usize) -> &'static str {
    if workers == 1 { "swiftprox" } else { "swiftprox-2" }
}

pub struct Ours {
    question: Question,
    workers: usize,
    scene: Scene,
    ids: Vec<ObjectId>,
    /// Who moves in each step, and where to.
    steps: Vec<(Vec<ObjectId>, Vec<Pose>)>,
}

impl Ours {
    pub fn new(world: &World, question: Question, workers: usize) -> Result<Ours, String> {
        let options =
            ShapeOptions { swept_radius: world.kind.radius(), input: InputPolicy::Hull, ..ShapeOptions::default() };
        let shapes = world.meshes.iter().map(|mesh| Shape::from_mesh(mesh, &options).map(Arc::new));
        let shapes: Vec<_> = shapes.collect::<Result<_, _>>().map_err(|e| e.to_string())?;
        let mut scene = Scene::new();
        scene.set_workers((workers > 1).then(|| Workers::threads(workers)));
        let mut add = |mesh: &u32| scene.add_object(vec![shapes[*mesh as usize].clone()], &ObjectOptions::default());
        let ids = world.mesh_of.iter().map(&mut add).collect::<Result<_, _>>().map_err(|e| e.to_string())?;
        Ok(Ours { question, workers, scene, ids, steps: Vec::new() })
    }
}

impl Crowd for Ours {
    fn name(&self) -> &'static str {
        name(self.workers)
    }

    fn has_threads(&self) -> bool {
        self.workers > 1
    }

    fn load(&mut self, steps: &[Step]) {
        let pose = |step: &Step, i: u32| (self.ids[i as usize], Pose::from_row_major(&step.poses[i as usize]));
        self.steps = steps.iter().map(|step| step.moved.iter().map(|&i| pose(step, i)).unzip()).collect();
    }

    fn step(&mut self, k: usize) -> Found {
        let (ids, poses) = &self.steps[k];
        self.scene.set_poses(ids, poses).expect("rigid poses");
        let near = SceneQuery { max_distance: TOLERANCE, ..SceneQuery::default() };
        let touching = SceneQuery { max_distance: 0.0, detail: ContactDetail::Manifold, ..SceneQuery::default() };
        let answer = match self.question {
            Question::Intersection => self.scene.query_intersection(&near),
            Question::Distance => self.scene.query_distance(&near),
            Question::Contact => self.scene.query_contact(&touching),
        };
        let answer = answer.expect("a sound query");
        let sum = match self.question {
            Question::Contact => answer.contacts.contacts.iter().map(|contact| contact.depth.depth).sum(),
            _ => answer.pairs.iter().map(|pair| pair.answer.distance).sum(),
        };
        Found { pairs: answer.pairs.len(), sum }
    }
}
