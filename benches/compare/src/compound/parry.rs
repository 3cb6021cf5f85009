//! parry3d-f64's compounds.

use parry3d_f64::math::Pose as ParryPose;
use parry3d_f64::query::{distance, intersection_test};
use parry3d_f64::shape::{Compound, SharedShape};
use swiftprox::math::Vector;
use testkit::PosePair;
use testkit::models::hull_mesh;

use super::{Asked, Bodies};
use crate::cast::parry::polyhedron;
use crate::parry::pose_of;

pub fn compound(pieces: &[Vec<Vector>]) -> Result<Compound, String> {
    let piece = |points: &Vec<Vector>| {
        let mesh = hull_mesh(points).map_err(|error| error.to_string())?;
        Ok((ParryPose::IDENTITY, SharedShape::new(polyhedron(&mesh)?)))
    };
    Ok(Compound::new(pieces.iter().map(piece).collect::<Result<Vec<_>, String>>()?))
}

pub struct Parry<'a> {
    compound: &'a Compound,
    asked: Asked,
}

impl<'a> Parry<'a> {
    pub fn new(compound: &'a Compound, asked: Asked) -> Parry<'a> {
        Parry { compound, asked }
    }
}

impl Bodies for Parry<'_> {
    fn name(&self) -> &'static str {
        "parry"
    }

    fn forget(&mut self) {}

    fn ask(&mut self, poses: &PosePair) -> f64 {
        let [first, second] = [pose_of(&poses[..12]), pose_of(&poses[12..])];
        let found = match self.asked {
            Asked::Verdict => intersection_test(&first, self.compound, &second, self.compound)
                .map(|found| f64::from(u8::from(!found.intersecting))),
            Asked::Distance => distance(&first, self.compound, &second, self.compound).map(|found| found.distance),
        };
        match found {
            Ok(found) => found,
            Err(error) => panic!("parry answers compounds: {error}"),
        }
    }
}
