//! parry3d-f64's contact of support maps, GJK and EPA, the hulls climbed from the vertex of the call before and the last normal
//! handed back in.

use std::cell::Cell;
use std::rc::Rc;

use parry3d_f64::math::{Pose, Vector};
use parry3d_f64::query::details::contact_support_map_support_map_with_params as contact;
use parry3d_f64::query::gjk::{GJKResult, VoronoiSimplex};

use crate::method::{Method, Reply};
use crate::parry::{Climber, Rings, pose_pair};
use testkit::PosePair;

pub struct Contact {
    rings: [Rc<Rings>; 2],
    poses: Vec<(Pose, Pose)>,
    last: [Cell<u32>; 2],
    direction: Option<Vector>,
    simplex: VoronoiSimplex,
    answer: GJKResult,
    /// The pose asked about last.
    asked: usize,
}

impl Contact {
    pub fn new(rings: [Rc<Rings>; 2]) -> Contact {
        Contact {
            rings,
            poses: Vec::new(),
            last: [Cell::new(0), Cell::new(0)],
            direction: None,
            simplex: VoronoiSimplex::new(),
            answer: GJKResult::Intersection,
            asked: 0,
        }
    }

    /// Along which it said the last depth, in the world.
    pub fn normal(&self) -> [f64; 3] {
        let GJKResult::ClosestPoints(_, _, normal) = self.answer else { return [f64::NAN; 3] };
        let rotation = self.poses[self.asked].0.rotation;
        (rotation * normal).to_array()
    }
}

impl Method for Contact {
    fn name(&self) -> &str {
        "parry-hc"
    }

    fn load(&mut self, poses: &[PosePair]) {
        self.poses = poses.iter().map(pose_pair).collect();
    }

    fn forget(&mut self) {
        self.last = [Cell::new(0), Cell::new(0)];
        self.direction = None;
    }

    #[inline]
    fn ask(&mut self, i: usize) {
        self.asked = i;
        let (pose1, pose2) = &self.poses[i];
        let pose12 = pose1.inv_mul(pose2);
        let [climber1, climber2] = [0, 1].map(|k| Climber::<false> { rings: &self.rings[k], last: &self.last[k] });
        self.answer = contact(&pose12, &climber1, &climber2, 0.0, &mut self.simplex, self.direction);
        self.direction = match self.answer {
            GJKResult::ClosestPoints(_, _, normal) => Some(normal),
            _ => None,
        };
    }

    fn reply(&self) -> Reply {
        let distance = match self.answer {
            GJKResult::ClosestPoints(point1, point2, normal) => (point1 - point2).dot(normal),
            GJKResult::NoIntersection(_) | GJKResult::Proximity(_) | GJKResult::Intersection => f64::NAN,
        };
        Reply { distance, width: f64::NAN, steps: f64::NAN, fallback: false, exact: false, by_levels: false }
    }
}
