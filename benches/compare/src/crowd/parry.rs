//! parry's bounding volume hierarchy, its pairs handed to its GJK over support maps that climb from where each body's last climb
//! ended.

use std::cell::Cell;
use std::rc::Rc;

use parry3d_f64::bounding_volume::{Aabb, details::point_cloud_aabb_ref};
use parry3d_f64::math::Pose;
use parry3d_f64::partitioning::{Bvh, BvhBuildStrategy, BvhWorkspace};
use parry3d_f64::query::details::{
    closest_points_support_map_support_map_with_params as closest_points,
    contact_support_map_support_map_with_params as contact,
    intersection_test_support_map_support_map_with_params as intersection_test,
};
use parry3d_f64::query::gjk::{GJKResult, VoronoiSimplex};

use super::world::{Step, World};
use super::{Crowd, Found, Question, TOLERANCE};
use crate::parry::{Climber, Rings, pose_of};

/// What keeps the hierarchy good while the bodies move.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Upkeep {
    /// Refitted and optimised a little in every step, as its users do.
    Refit,
    /// Built anew in every step.
    Rebuild,
}

impl Upkeep {
    pub fn name(self) -> &'static str {
        match self {
            Upkeep::Refit => "parry",
            Upkeep::Rebuild => "parry-rebuilt",
        }
    }
}

pub struct Parry {
    question: Question,
    upkeep: Upkeep,
    rings: Vec<Rc<Rings>>,
    ring_of: Vec<u32>,
    poses: Vec<Pose>,
    last: Vec<Cell<u32>>,
    tree: Bvh,
    workspace: BvhWorkspace,
    simplex: VoronoiSimplex,
    steps: Vec<Vec<(u32, Pose)>>,
}

impl Parry {
    pub fn new(world: &World, question: Question, upkeep: Upkeep) -> Parry {
        let count = world.mesh_of.len();
        Parry {
            question,
            upkeep,
            rings: world.meshes.iter().map(|mesh| Rc::new(Rings::new(mesh))).collect(),
            ring_of: world.mesh_of.clone(),
            poses: vec![Pose::IDENTITY; count],
            last: vec![Cell::new(0); count],
            tree: Bvh::new(),
            workspace: BvhWorkspace::default(),
            simplex: VoronoiSimplex::new(),
            steps: Vec::new(),
        }
    }

    /// The tight box, as parry computes that of a hull; two that overlap are at most the tolerance apart on each axis.
    fn aabb(&self, i: u32) -> Aabb {
        let rings = &self.rings[self.ring_of[i as usize] as usize];
        let tight = point_cloud_aabb_ref(&self.poses[i as usize], rings.vertices());
        match self.question {
            Question::Intersection | Question::Contact => tight,
            Question::Distance => tight.loosened(0.5 * TOLERANCE),
        }
    }
}

trait Loosened {
    fn loosened(&self, by: f64) -> Aabb;
}

impl Loosened for Aabb {
    fn loosened(&self, by: f64) -> Aabb {
        parry3d_f64::bounding_volume::BoundingVolume::loosened(self, by)
    }
}

impl Crowd for Parry {
    fn name(&self) -> &'static str {
        self.upkeep.name()
    }

    fn load(&mut self, steps: &[Step]) {
        let pose = |step: &Step, i: u32| (i, pose_of(&step.poses[i as usize]));
        self.steps = steps.iter().map(|step| step.moved.iter().map(|&i| pose(step, i)).collect()).collect();
    }

    fn step(&mut self, k: usize) -> Found {
        let moved = std::mem::take(&mut self.steps[k]);
        for &(i, pose) in &moved {
            self.poses[i as usize] = pose;
            let aabb = self.aabb(i);
            self.tree.insert_or_update_partially(aabb, i, 0.0);
        }
        match self.upkeep {
            Upkeep::Refit => {
                self.tree.refit(&mut self.workspace);
                self.tree.optimize_incremental(&mut self.workspace);
            }
            Upkeep::Rebuild => self.tree.rebuild(&mut self.workspace, BvhBuildStrategy::Binned),
        }
        let (mut found, question) = (Found::default(), self.question);
        let Parry { rings, ring_of, poses, last, tree, workspace, simplex, .. } = self;
        tree.traverse_bvtt_single_tree::<false>(workspace, &mut |a, b| {
            let [first, second] = [a as usize, b as usize]
                .map(|i| (&poses[i], Climber::<false> { rings: &rings[ring_of[i] as usize], last: &last[i] }));
            let pose12 = first.0.inv_mul(second.0);
            let distance = match question {
                Question::Intersection => {
                    intersection_test(&pose12, &first.1, &second.1, simplex, None).0.then_some(0.0)
                }
                Question::Distance => match closest_points(&pose12, &first.1, &second.1, TOLERANCE, simplex, None) {
                    GJKResult::Intersection => Some(0.0),
                    GJKResult::ClosestPoints(point1, point2, _) => Some((point1 - point2).length()),
                    GJKResult::NoIntersection(_) | GJKResult::Proximity(_) => None,
                },
                Question::Contact => match contact(&pose12, &first.1, &second.1, 0.0, simplex, None) {
                    GJKResult::ClosestPoints(point1, point2, normal) => Some(-(point2 - point1).dot(normal)),
                    GJKResult::Intersection | GJKResult::NoIntersection(_) | GJKResult::Proximity(_) => None,
                },
            };
            let is_listed = |distance: &f64| match question {
                Question::Intersection | Question::Distance => *distance <= TOLERANCE,
                Question::Contact => *distance >= 0.0,
            };
            if let Some(distance) = distance.filter(is_listed) {
                found.pairs += 1;
                found.sum += distance;
            }
        });
        self.steps[k] = moved;
        found
    }
}
