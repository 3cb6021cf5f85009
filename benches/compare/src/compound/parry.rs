//! parry3d-f64's compounds.

use parry3d_f64::math::Pose as ParryPose;
use parry3d_f64::query::{
    ContactManifold, ContactManifoldsWorkspace, DefaultQueryDispatcher, PersistentQueryDispatcher, distance,
    intersection_test,
};
use parry3d_f64::shape::{Compound, SharedShape};
use swiftprox::math::Vector;
use testkit::PosePair;
use testkit::models::hull_mesh;

use super::Method;
use super::pairs::Asked;
use crate::cast::parry::polyhedron;
use crate::parry::pose_of;

pub const NAME: &str = "parry";

pub fn compound(pieces: &[Vec<Vector>]) -> Result<Compound, String> {
    let piece = |points: &Vec<Vector>| {
        let mesh = hull_mesh(points).map_err(|error| error.to_string())?;
        Ok((ParryPose::IDENTITY, SharedShape::new(polyhedron(&mesh)?)))
    };
    Ok(Compound::new(pieces.iter().map(piece).collect::<Result<Vec<_>, String>>()?))
}

pub fn meet(bodies: [(&ParryPose, &Compound); 2]) -> bool {
    let [(pose1, one), (pose2, two)] = bodies;
    intersection_test(pose1, one, pose2, two).expect("parry answers compounds").intersecting
}

/// The contacts of two compounds from step to step.
#[derive(Default)]
pub struct Kept {
    manifolds: Vec<ContactManifold<(), ()>>,
    workspace: Option<ContactManifoldsWorkspace>,
}

impl Kept {
    /// How many pairs of pieces have points up to `max_distance` apart.
    pub fn count(&mut self, bodies: [(&ParryPose, &Compound); 2], max_distance: f64) -> usize {
        let Kept { manifolds, workspace } = self;
        let [(pose1, one), (pose2, two)] = bodies;
        let dispatcher: &dyn PersistentQueryDispatcher<(), ()> = &DefaultQueryDispatcher;
        let asked = dispatcher.contact_manifolds(&pose1.inv_mul(pose2), one, two, max_distance, manifolds, workspace);
        assert!(asked.is_ok(), "parry answers compounds");
        let has_points = |manifold: &&ContactManifold<(), ()>| manifold.points.iter().any(|p| p.dist <= max_distance);
        manifolds.iter().filter(has_points).count()
    }
}

pub struct Parry<'a> {
    compound: &'a Compound,
    poses: &'a [PosePair],
    asked: Asked,
}

impl<'a> Parry<'a> {
    pub fn new(compound: &'a Compound, poses: &'a [PosePair], asked: Asked) -> Parry<'a> {
        Parry { compound, poses, asked }
    }
}

impl Method for Parry<'_> {
    fn name(&self) -> &'static str {
        NAME
    }

    fn ask(&mut self, k: usize) -> f64 {
        let poses = &self.poses[k];
        let [first, second] = [pose_of(&poses[..12]), pose_of(&poses[12..])];
        match self.asked {
            Asked::Verdict => f64::from(u8::from(!meet([(&first, self.compound), (&second, self.compound)]))),
            Asked::Distance => {
                distance(&first, self.compound, &second, self.compound).expect("parry answers compounds").distance
            }
        }
    }
}
