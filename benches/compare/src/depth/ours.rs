//! This library's depth, from the 24 numbers of the poses to the whole answer: interval, normal, points and features.

use std::rc::Rc;

use swiftprox::math::Pose;
use swiftprox::pair::{self, DepthAnswer, DepthCache, DepthConfig, Outcome};
use swiftprox::shape::Shape;

use crate::method::{Method, Reply};
use crate::setting::poses_of;
use testkit::PosePair;

/// With the narrowest interval that is provable.
pub const NAME: &str = "swiftprox";

pub struct Depth {
    name: String,
    shapes: [Rc<Shape>; 2],
    config: DepthConfig,
    poses: Vec<[Pose; 2]>,
    cache: DepthCache,
    answer: DepthAnswer,
    failed: bool,
}

impl Depth {
    /// With an interval that may be as wide as `error`.
    pub fn new(shapes: [&Rc<Shape>; 2], error: f64) -> Depth {
        let name = if error > 0.0 { format!("{NAME}-{error:e}") } else { NAME.into() };
        Depth {
            name,
            shapes: shapes.map(Rc::clone),
            config: DepthConfig { absolute_error: error, ..DepthConfig::default() },
            poses: Vec::new(),
            cache: DepthCache::default(),
            answer: DepthAnswer::default(),
            failed: false,
        }
    }
}

impl Method for Depth {
    fn name(&self) -> &str {
        &self.name
    }

    fn load(&mut self, poses: &[PosePair]) {
        self.poses = poses_of(poses);
    }

    fn forget(&mut self) {
        self.cache = DepthCache::default();
    }

    #[inline]
    fn ask(&mut self, i: usize) {
        let ([shape1, shape2], [pose1, pose2]) = (&self.shapes, &self.poses[i]);
        let bodies = [shape1.at(pose1), shape2.at(pose2)];
        self.failed = pair::depth(bodies, &mut self.cache, &self.config, &mut self.answer).is_err();
    }

    fn reply(&self) -> Reply {
        let DepthAnswer { outcome, depth, lower, upper, statistics, .. } = self.answer;
        Reply {
            distance: if self.failed || outcome != Outcome::Intersecting { f64::NAN } else { depth },
            interval: [lower, upper],
            steps: f64::from(statistics.steps),
            fallback: false,
            exact: statistics.exact_iterations > 0,
            by_levels: false,
        }
    }
}
