//! This library's scene, as a program uses it: poses of what moved, then one query.

use std::sync::Arc;

use swiftprox::math::Pose;
use swiftprox::object::{ObjectId, ObjectOptions};
use swiftprox::scene::{ContactDetail, PairResult, Scene, SceneOptions, SceneQuery};
use swiftprox::shape::{Shape, ShapeOptions};

use super::world::{Step, World};
use super::{Crowd, Found, Question, TOLERANCE};

pub struct Ours {
    question: Question,
    scene: Scene,
    ids: Vec<ObjectId>,
    steps: Vec<Vec<(ObjectId, Pose)>>,
}

impl Ours {
    pub fn new(world: &World, question: Question) -> Result<Ours, String> {
        let shapes = world.meshes.iter().map(|mesh| Shape::from_mesh(mesh, &ShapeOptions::default()).map(Arc::new));
        let shapes: Vec<_> = shapes.collect::<Result<_, _>>().map_err(|e| e.to_string())?;
        let mut scene = Scene::new(&SceneOptions::default()).map_err(|e| e.to_string())?;
        let mut add = |mesh: &u32| scene.add_object(vec![shapes[*mesh as usize].clone()], &ObjectOptions::default());
        let ids = world.mesh_of.iter().map(&mut add).collect::<Result<_, _>>().map_err(|e| e.to_string())?;
        Ok(Ours { question, scene, ids, steps: Vec::new() })
    }
}

impl Crowd for Ours {
    fn name(&self) -> &'static str {
        "swiftprox"
    }

    fn load(&mut self, steps: &[Step]) {
        let pose = |step: &Step, i: u32| (self.ids[i as usize], Pose::from_row_major(&step.poses[i as usize]));
        self.steps = steps.iter().map(|step| step.moved.iter().map(|&i| pose(step, i)).collect()).collect();
    }

    fn step(&mut self, k: usize) -> Found {
        for (id, pose) in &self.steps[k] {
            self.scene.set_pose(*id, pose).expect("a rigid pose");
        }
        let query = SceneQuery { distance_tolerance: TOLERANCE, ..SceneQuery::default() };
        let distances = |pairs: &[PairResult]| pairs.iter().map(|pair| pair.answer.distance).sum();
        match self.question {
            Question::Intersection => {
                let pairs = self.scene.query_intersection(&query).expect("a sound query").pairs;
                Found { pairs: pairs.len(), sum: distances(pairs) }
            }
            Question::Distance => {
                let pairs = self.scene.query_exact_distance(&query).expect("a sound query").pairs;
                Found { pairs: pairs.len(), sum: distances(pairs) }
            }
            Question::Contact => {
                let query =
                    SceneQuery { detail: ContactDetail::Manifold, distance_tolerance: 0.0, ..SceneQuery::default() };
                let contacts = self.scene.query_contacts(&query).expect("a sound query").contacts.contacts;
                Found { pairs: contacts.len(), sum: contacts.iter().map(|contact| contact.depth.depth).sum() }
            }
        }
    }
}
