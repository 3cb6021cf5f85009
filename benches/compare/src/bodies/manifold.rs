//! Contact manifolds of bodies that intersect: this library's, and parry3d-f64's of its boxes and convex polyhedra.

use std::rc::Rc;

use parry3d_f64::math::{Pose as ParryPose, Vector};
use parry3d_f64::query::{ContactManifold, DefaultQueryDispatcher, PersistentQueryDispatcher};
use parry3d_f64::shape::{ConvexPolyhedron, Shape as ParryShape};
use swiftprox::manifold::manifold;
use swiftprox::manifold::{Manifold, ManifoldCache, ManifoldConfig, ManifoldPoint};
use swiftprox::math::Pose;
use swiftprox::mesh::PolygonMesh;
use swiftprox::pair::Outcome;
use swiftprox::shape::Shape;

use crate::method::{Method, Reply};
use crate::parry::pose_pair;
use crate::setting::poses_of;
use testkit::PosePair;

/// Room for so many points, as a solver of contacts has it.
const MOST_POINTS: usize = 4;

pub struct OwnManifold {
    name: &'static str,
    shapes: [Rc<Shape>; 2],
    config: ManifoldConfig,
    poses: Vec<[Pose; 2]>,
    cache: ManifoldCache,
    points: [ManifoldPoint; MOST_POINTS],
    /// None after a failure.
    answer: Option<Manifold>,
}

impl OwnManifold {
    pub fn new(name: &'static str, shapes: [&Rc<Shape>; 2]) -> OwnManifold {
        OwnManifold {
            name,
            shapes: shapes.map(Rc::clone),
            config: ManifoldConfig { reduces: true, ..ManifoldConfig::default() },
            poses: Vec::new(),
            cache: ManifoldCache::default(),
            points: [ManifoldPoint::default(); MOST_POINTS],
            answer: None,
        }
    }
}

impl Method for OwnManifold {
    fn name(&self) -> &str {
        self.name
    }

    fn load(&mut self, poses: &[PosePair]) {
        self.poses = poses_of(poses);
    }

    fn forget(&mut self) {
        self.cache = ManifoldCache::default();
    }

    #[inline]
    fn ask(&mut self, i: usize) {
        let ([shape1, shape2], [pose1, pose2]) = (&self.shapes, &self.poses[i]);
        let bodies = [shape1.at(pose1), shape2.at(pose2)];
        self.answer = manifold(bodies, &mut self.cache, &self.config, &mut self.points).ok();
    }

    fn reply(&self) -> Reply {
        match self.answer {
            Some(Manifold { outcome: Outcome::Intersecting, lower, upper, .. }) => {
                // The depth that the certified normal says, which lies in the interval.
                Reply { interval: [-upper, -lower], ..Reply::of(-0.5 * (lower + upper)) }
            }
            _ => Reply::of(f64::NAN),
        }
    }
}

pub struct ParryManifold {
    name: &'static str,
    bodies: [Box<dyn ParryShape>; 2],
    poses: Vec<(ParryPose, ParryPose)>,
    manifold: ContactManifold<(), ()>,
}

impl ParryManifold {
    pub fn new(name: &'static str, bodies: [Box<dyn ParryShape>; 2]) -> ParryManifold {
        ParryManifold { name, bodies, poses: Vec::new(), manifold: ContactManifold::new() }
    }
}

/// A mesh of triangles as parry's convex polyhedron; none where parry takes it for no convex one.
pub fn parry_polyhedron(mesh: &PolygonMesh) -> Option<Box<dyn ParryShape>> {
    let points = mesh.vertices.iter().map(|v| Vector::new(v.x, v.y, v.z)).collect();
    let corners: Vec<[u32; 3]> = mesh.indices.chunks_exact(3).map(|c| [c[0], c[1], c[2]]).collect();
    Some(Box::new(ConvexPolyhedron::from_convex_mesh(points, &corners)?))
}

impl Method for ParryManifold {
    fn name(&self) -> &str {
        self.name
    }

    fn load(&mut self, poses: &[PosePair]) {
        self.poses = poses.iter().map(pose_pair).collect();
    }

    fn forget(&mut self) {
        self.manifold = ContactManifold::new();
    }

    #[inline]
    fn ask(&mut self, i: usize) {
        let (pose1, pose2) = &self.poses[i];
        let ([first, second], between) = (&self.bodies, pose1.inv_mul(pose2));
        DefaultQueryDispatcher
            .contact_manifold_convex_convex(&between, &**first, &**second, None, None, 0.0, &mut self.manifold)
            .expect("parry has manifolds of boxes and polyhedra");
    }

    fn reply(&self) -> Reply {
        Reply::of(self.manifold.find_deepest_contact().map_or(f64::NAN, |contact| -contact.dist))
    }
}
