//! The pair layer of this library: from the 24 numbers to the whole answer (interval, witness points, normal, features).

use swiftprox::error::Result;
use swiftprox::math::Pose;
use swiftprox::mesh::PolygonMesh;
use swiftprox::pair::{self, Bounds, Outcome, PairAnswer, PairCache, PairConfig};
use swiftprox::shape::{Shape, ShapeOptions};

use crate::method::{Method, Reply};
use crate::scenes::PosePair;

pub struct Ours {
    name: &'static str,
    shape: Shape,
    poses: Vec<[Pose; 2]>,
    config: PairConfig,
    cache: PairCache,
    answer: PairAnswer,
    failed: bool,
}

impl Ours {
    pub fn new(mesh: &PolygonMesh, bounds: Bounds) -> Result<Ours> {
        Ok(Ours {
            name: match bounds {
                Bounds::Tight => "swiftprox",
                Bounds::Verdict => "swiftprox-verdict",
            },
            shape: Shape::from_mesh(mesh, &ShapeOptions::default())?,
            poses: Vec::new(),
            config: PairConfig { bounds, ..PairConfig::default() },
            cache: PairCache::default(),
            answer: PairAnswer::default(),
            failed: false,
        })
    }
}

impl Method for Ours {
    fn name(&self) -> &str {
        self.name
    }

    fn load(&mut self, poses: &[PosePair]) {
        // A pose is its twelve numbers: nothing is computed here.
        let pose = |m: &[f64]| Pose::from_row_major(m.try_into().expect("twelve of 24"));
        self.poses = (poses.iter()).map(|p| [pose(&p[..12]), pose(&p[12..])]).collect();
    }

    fn forget(&mut self) {
        self.cache = PairCache::default();
    }

    #[inline]
    fn ask(&mut self, i: usize) {
        let [pose1, pose2] = &self.poses[i];
        let (cache, answer) = (&mut self.cache, &mut self.answer);
        self.failed = pair::distance(&self.shape, pose1, &self.shape, pose2, cache, &self.config, answer).is_err();
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
            width: answer.upper - answer.lower,
            steps: f64::from(statistics.marching_steps),
            fallback: statistics.fallback_iterations > 0,
            exact: statistics.exact_iterations > 0,
        }
    }
}
