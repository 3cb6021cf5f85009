//! parry3d-f64's contact of support maps, GJK and EPA, the hulls climbed from the vertex of the call before and the last normal
//! handed back in.

use std::rc::Rc;

use parry3d_f64::query::details::contact_support_map_support_map_with_params as contact;
use parry3d_f64::query::gjk::{GJKResult, VoronoiSimplex};

use crate::method::{Method, Reply};
use crate::parry::{ClimbedPair, Rings};
use testkit::PosePair;

pub struct Contact {
    pair: ClimbedPair,
    simplex: VoronoiSimplex,
    answer: GJKResult,
    /// The pose asked about last.
    asked: usize,
}

impl Contact {
    pub fn new(rings: [Rc<Rings>; 2]) -> Contact {
        Contact {
            pair: ClimbedPair::new(rings),
            simplex: VoronoiSimplex::new(),
            answer: GJKResult::Intersection,
            asked: 0,
        }
    }

    /// Along which it said the last depth, in the world.
    pub fn normal(&self) -> [f64; 3] {
        let GJKResult::ClosestPoints(_, _, normal) = self.answer else { return [f64::NAN; 3] };
        let rotation = self.pair.poses[self.asked].0.rotation;
        (rotation * normal).to_array()
    }
}

impl Method for Contact {
    fn name(&self) -> &str {
        "parry-hc"
    }

    fn load(&mut self, poses: &[PosePair]) {
        self.pair.load(poses);
    }

    fn forget(&mut self) {
        self.pair.forget();
    }

    #[inline]
    fn ask(&mut self, i: usize) {
        self.asked = i;
        let pose12 = self.pair.relative_pose(i);
        let [climber1, climber2] = self.pair.climbers::<false>();
        self.answer = contact(&pose12, &climber1, &climber2, 0.0, &mut self.simplex, self.pair.direction);
        self.pair.direction = match self.answer {
            GJKResult::ClosestPoints(_, _, normal) => Some(normal),
            _ => None,
        };
    }

    fn reply(&self) -> Reply {
        let distance = match self.answer {
            GJKResult::ClosestPoints(point1, point2, normal) => (point1 - point2).dot(normal),
            GJKResult::NoIntersection(_) | GJKResult::Proximity(_) | GJKResult::Intersection => f64::NAN,
        };
        Reply::of(distance)
    }
}
