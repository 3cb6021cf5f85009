//! A query of this library under one setting, from the 24 numbers of the poses to the whole answer: what is asked, of which
//! shape, by which configuration.

use std::rc::Rc;

use swiftprox::error::Result;
use swiftprox::math::Pose;
use swiftprox::pair::{self, Outcome, PairAnswer, PairCache, PairConfig, Placed};
use swiftprox::shape::Shape;

use crate::method::{Method, Reply};
use testkit::PosePair;

/// What is asked.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Query {
    Intersection,
    Approximate,
    Distance,
    Contact,
}

impl Query {
    pub fn name(self) -> &'static str {
        match self {
            Query::Intersection => "intersection",
            Query::Approximate => "approximate",
            Query::Distance => "distance",
            Query::Contact => "contact",
        }
    }
}

/// The query of two like bodies under a setting, as a method to be timed.
pub fn setting(name: impl Into<String>, query: Query, shape: &Rc<Shape>, config: PairConfig) -> Box<dyn Method> {
    setting_of_pair(name, query, [shape, shape], config)
}

/// The query of two bodies under a setting, as a method to be timed.
pub fn setting_of_pair(
    name: impl Into<String>,
    query: Query,
    shapes: [&Rc<Shape>; 2],
    config: PairConfig,
) -> Box<dyn Method> {
    let (name, shapes) = (name.into(), shapes.map(Rc::clone));
    match query {
        Query::Intersection => Box::new(Setting::new(name, pair::intersection, shapes, config)),
        Query::Approximate => Box::new(Setting::new(name, pair::approximate, shapes, config)),
        Query::Distance => Box::new(Setting::new(name, pair::distance, shapes, config)),
        Query::Contact => Box::new(Setting::new(name, pair::contact, shapes, config)),
    }
}

/// A verdict as Ehmann & Lin had it, by marching: neither bounding spheres nor the last separating axis are asked.
pub fn verdict_by_marching(name: impl Into<String>, shape: &Rc<Shape>, config: PairConfig) -> Box<dyn Method> {
    Box::new(Setting::new(name.into(), pair::intersection_by_marching, [Rc::clone(shape), Rc::clone(shape)], config))
}

/// A type for each function of the library, so that the compiler sees which is called.
struct Setting<Ask> {
    name: String,
    ask: Ask,
    shapes: [Rc<Shape>; 2],
    config: PairConfig,
    poses: Vec<[Pose; 2]>,
    cache: PairCache,
    answer: PairAnswer,
    failed: bool,
}

impl<Ask> Setting<Ask> {
    fn new(name: String, ask: Ask, shapes: [Rc<Shape>; 2], config: PairConfig) -> Setting<Ask> {
        let (cache, answer) = (PairCache::default(), PairAnswer::default());
        Setting { name, ask, shapes, config, poses: Vec::new(), cache, answer, failed: false }
    }
}

impl<Ask> Method for Setting<Ask>
where
    Ask: Fn([Placed; 2], &mut PairCache, &PairConfig, &mut PairAnswer) -> Result<()>,
{
    fn name(&self) -> &str {
        &self.name
    }

    fn load(&mut self, poses: &[PosePair]) {
        self.poses = poses_of(poses);
    }

    fn forget(&mut self) {
        self.cache = PairCache::default();
    }

    #[inline]
    fn ask(&mut self, i: usize) {
        let [pose1, pose2] = &self.poses[i];
        let ([shape1, shape2], cache, config, answer) = (&self.shapes, &mut self.cache, &self.config, &mut self.answer);
        self.failed = (self.ask)([shape1.at(pose1), shape2.at(pose2)], cache, config, answer).is_err();
    }

    fn reply(&self) -> Reply {
        let answer = &self.answer;
        let distance = match answer.outcome {
            _ if self.failed => f64::NAN,
            Outcome::Separated => answer.distance,
            Outcome::Intersecting => 0.0,
            Outcome::None | Outcome::Beyond | Outcome::Undecided => f64::NAN,
        };
        let statistics = &answer.statistics;
        Reply {
            distance,
            interval: [answer.lower, answer.upper],
            steps: f64::from(statistics.marching_steps),
            fallback: statistics.fallback_iterations > 0,
            exact: statistics.exact_iterations > 0,
            by_levels: statistics.levels != [0, 0],
        }
    }
}

/// A pose is its twelve numbers: nothing is computed here.
pub fn poses_of(poses: &[PosePair]) -> Vec<[Pose; 2]> {
    let pose = |m: &[f64]| Pose::from_row_major(m.try_into().expect("twelve of 24"));
    poses.iter().map(|p| [pose(&p[..12]), pose(&p[12..])]).collect()
}
