//! Round bodies: spheres, capsules and rounded boxes, with themselves and beside a box, a hull and an ellipsoid. The others answer
//! by their own primitives, not by a polyhedron.

use std::rc::Rc;

use parry3d_f64::math::{Pose, Vector as ParryVector};
use parry3d_f64::query::{self, ClosestPoints};
use parry3d_f64::shape::{Ball, Capsule, Cuboid, RoundShape, Shape};
use swiftprox::math::Vector;
use swiftprox::mesh::PolygonMesh;

use super::list::{Body, Extent};
use super::manifold::parry_polyhedron;
use super::methods::Question;
use crate::method::{Method, Reply};
use crate::model;
use crate::options::Options;
use crate::parry::pose_pair;
use testkit::PosePair;
use testkit::models::{cuboid, random_hull};

pub const FAMILY: &str = "round";

/// Half the segment and the radius; all bodies have a bounding radius of about 1.
const CAPSULE: [f64; 2] = [0.6, 0.4];
const ROUNDED_BOX: ([f64; 3], f64) = ([0.6, 0.45, 0.28], 0.2);
const BOX: [f64; 3] = [0.7, 0.55, 0.45];

/// # Errors
/// A message about what cannot be made.
pub fn bodies(options: &Options) -> Result<Vec<Body>, String> {
    let failed = |e: swiftprox::error::Error| e.to_string();
    let points = |points: Vec<Vector>| PolygonMesh::new(points, Vec::new(), None).map(Rc::new).map_err(failed);
    let [half, radius] = CAPSULE;
    let ends = vec![Vector::new(0.0, 0.0, -half), Vector::new(0.0, 0.0, half)];
    let round = [
        ("sphere", points(vec![Vector::zeros()])?, 1.0),
        ("capsule", points(ends)?, radius),
        ("rounded-box", Rc::new(cuboid(ROUNDED_BOX.0).map_err(failed)?), ROUNDED_BOX.1),
    ];
    let others = [
        ("box", Rc::new(cuboid(BOX).map_err(failed)?)),
        ("hull-102", Rc::new(random_hull(102, 1).map_err(failed)?)),
        ("plate-1002", Rc::new(model(options, "plate", 1002)?)),
    ];
    let mut bodies = Vec::new();
    let mut add = |name: String, meshes: [&Rc<PolygonMesh>; 2], radii: [f64; 2]| {
        let (form, meshes) = ("primitives".to_string(), meshes.map(Rc::clone));
        bodies.push(Body { family: FAMILY, name, form, meshes, radii, extent: Extent::Strongest });
    };
    for (name, core, radius) in &round {
        add(format!("{name}+{name}"), [core, core], [*radius; 2]);
        for (other, mesh) in &others {
            add(format!("{name}+{other}"), [core, mesh], [*radius, 0.0]);
        }
    }
    // What a round body beside each is to be held against.
    for (other, mesh) in &others {
        add(format!("box+{other}"), [&others[0].1, mesh], [0.0; 2]);
    }
    Ok(bodies)
}

/// parry's shape of a core and a radius: a core along the axes is the primitive that it stands for.
pub fn shape(core: &PolygonMesh, radius: f64) -> Box<dyn Shape> {
    let last = core.vertices.last().expect("a body has a vertex");
    match core.vertices.len() {
        1 => Box::new(Ball::new(radius)),
        2 => Box::new(Capsule::new_z(last.z, radius)),
        8 if radius == 0.0 => Box::new(Cuboid::new(ParryVector::new(last.x, last.y, last.z))),
        8 => {
            let inner_shape = Cuboid::new(ParryVector::new(last.x, last.y, last.z));
            Box::new(RoundShape { inner_shape, border_radius: radius })
        }
        _ => parry_polyhedron(core).expect("a hull that parry takes"),
    }
}

/// parry's query of two shapes by its own dispatch, without a cache, which its primitives do not have.
pub struct Round {
    question: Question,
    shapes: [Box<dyn Shape>; 2],
    poses: Vec<(Pose, Pose)>,
    said: f64,
}

impl Round {
    pub fn method(question: Question, cores: [&PolygonMesh; 2], radii: [f64; 2]) -> Box<dyn Method> {
        let shapes = [0, 1].map(|k| shape(cores[k], radii[k]));
        Box::new(Round { question, shapes, poses: Vec::new(), said: f64::NAN })
    }
}

impl Method for Round {
    fn name(&self) -> &str {
        "parry-round"
    }

    fn load(&mut self, poses: &[PosePair]) {
        self.poses = poses.iter().map(pose_pair).collect();
    }

    fn forget(&mut self) {}

    #[inline]
    fn ask(&mut self, i: usize) {
        let ([one, two], (pose1, pose2)) = (&self.shapes, &self.poses[i]);
        let (one, two) = (one.as_ref(), two.as_ref());
        self.said = match self.question {
            Question::Distance => match query::closest_points(pose1, one, pose2, two, f64::MAX) {
                Ok(ClosestPoints::WithinMargin(point1, point2)) => (point1 - point2).length(),
                Ok(ClosestPoints::Intersecting) => 0.0,
                Ok(ClosestPoints::Disjoint) | Err(_) => f64::NAN,
            },
            Question::Verdict => match query::intersection_test(pose1, one, pose2, two) {
                Ok(found) if found.intersecting => 0.0,
                Ok(_) => f64::INFINITY,
                Err(_) => f64::NAN,
            },
            Question::Depth | Question::Manifold => match query::contact(pose1, one, pose2, two, 0.0) {
                Ok(Some(contact)) => -contact.dist,
                Ok(None) => 0.0,
                Err(_) => f64::NAN,
            },
        };
    }

    fn reply(&self) -> Reply {
        Reply::of(self.said)
    }
}
