//! parry's bounding volume hierarchy, its pairs handed to its GJK over support maps that climb from where each body's last climb
//! ended; spheres and boxes to the queries that parry dispatches to for them.

use std::cell::Cell;

use parry3d_f64::bounding_volume::{Aabb, details::point_cloud_aabb_ref};
use parry3d_f64::math::Pose;
use parry3d_f64::partitioning::{Bvh, BvhBuildStrategy, BvhWorkspace};
use parry3d_f64::query::details::{
    closest_points_support_map_support_map_with_params as closest_points,
    contact_support_map_support_map_with_params as contact,
    intersection_test_support_map_support_map_with_params as intersection_test,
};
use parry3d_f64::query::gjk::{GJKResult, VoronoiSimplex};
use parry3d_f64::query::{self, ClosestPoints};
use parry3d_f64::shape::Shape;

use super::world::{Step, World};
use super::{Crowd, Found, Question, TOLERANCE};
use crate::bodies::round;
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

/// What parry takes a mesh for.
enum Form {
    Hull(Rings),
    Primitive(Box<dyn Shape>),
}

pub struct Parry {
    question: Question,
    upkeep: Upkeep,
    forms: Vec<Form>,
    form_of: Vec<u32>,
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
        let form = |mesh| match world.kind.are_primitives() {
            true => Form::Primitive(round::shape(mesh, world.kind.radius())),
            false => Form::Hull(Rings::new(mesh)),
        };
        Parry {
            question,
            upkeep,
            forms: world.meshes.iter().map(form).collect(),
            form_of: world.mesh_of.clone(),
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
        let pose = &self.poses[i as usize];
        let tight = match &self.forms[self.form_of[i as usize] as usize] {
            Form::Hull(rings) => point_cloud_aabb_ref(pose, rings.vertices()),
            Form::Primitive(shape) => shape.compute_aabb(pose),
        };
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
        let Parry { forms, form_of, poses, last, tree, workspace, simplex, .. } = self;
        tree.traverse_bvtt_single_tree::<false>(workspace, &mut |a, b| {
            let [one, two] = [a as usize, b as usize];
            let distance = match [one, two].map(|i| &forms[form_of[i] as usize]) {
                [Form::Hull(rings1), Form::Hull(rings2)] => {
                    let [first, second] =
                        [(rings1, one), (rings2, two)].map(|(rings, i)| Climber::<false> { rings, last: &last[i] });
                    of_hulls(question, &poses[one].inv_mul(&poses[two]), [&first, &second], simplex)
                }
                [Form::Primitive(shape1), Form::Primitive(shape2)] => {
                    of_primitives(question, [(&poses[one], shape1.as_ref()), (&poses[two], shape2.as_ref())])
                }
                _ => unreachable!("a scene has hulls or primitives"),
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

/// A distance or depth, None where there is none to list.
fn of_hulls(
    question: Question,
    pose12: &Pose,
    hulls: [&Climber<false>; 2],
    simplex: &mut VoronoiSimplex,
) -> Option<f64> {
    let [one, two] = hulls;
    match question {
        Question::Intersection => intersection_test(pose12, one, two, simplex, None).0.then_some(0.0),
        Question::Distance => match closest_points(pose12, one, two, TOLERANCE, simplex, None) {
            GJKResult::Intersection => Some(0.0),
            GJKResult::ClosestPoints(point1, point2, _) => Some((point1 - point2).length()),
            GJKResult::NoIntersection(_) | GJKResult::Proximity(_) => None,
        },
        Question::Contact => match contact(pose12, one, two, 0.0, simplex, None) {
            GJKResult::ClosestPoints(point1, point2, normal) => Some(-(point2 - point1).dot(normal)),
            GJKResult::Intersection | GJKResult::NoIntersection(_) | GJKResult::Proximity(_) => None,
        },
    }
}

/// The same by parry's own dispatch.
fn of_primitives(question: Question, [(pose1, one), (pose2, two)]: [(&Pose, &dyn Shape); 2]) -> Option<f64> {
    const KNOWN: &str = "parry has a query of spheres and boxes";
    match question {
        Question::Intersection => {
            query::intersection_test(pose1, one, pose2, two).expect(KNOWN).intersecting.then_some(0.0)
        }
        Question::Distance => match query::closest_points(pose1, one, pose2, two, TOLERANCE).expect(KNOWN) {
            ClosestPoints::Intersecting => Some(0.0),
            ClosestPoints::WithinMargin(point1, point2) => Some((point1 - point2).length()),
            ClosestPoints::Disjoint => None,
        },
        Question::Contact => query::contact(pose1, one, pose2, two, 0.0).expect(KNOWN).map(|contact| -contact.dist),
    }
}
