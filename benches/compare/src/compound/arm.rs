//! An arm of seven links of 20 pieces among 200 obstacles: whether a state meets one.

use std::array;
use std::sync::Arc;

use parry3d_f64::bounding_volume::Aabb;
use parry3d_f64::math::Pose as ParryPose;
use parry3d_f64::partitioning::{Bvh, BvhBuildStrategy};
use parry3d_f64::shape::{Compound as ParryCompound, Shape};
use swiftprox::error::Error;
use swiftprox::math::{Matrix, Pose, Vector};
use swiftprox::object::{ObjectId, ObjectOptions};
use swiftprox::scene::{ObjectSet, PoseOrder, Scene as SwiftproxScene, SceneQuery, SetScratch};
use testkit::random::{Random, rotation};

use super::scenes::{Pieces, gear, scaled, torus, tube};
use super::{Method, Row, Scene, met, ours, parry};
use crate::options::Options;
use crate::parry::pose_of;

const LINKS: usize = 7;
const OBSTACLES: usize = 200;
const LENGTH: f64 = 0.25;
/// States of an edge.
const EDGE: usize = 32;

type State = [Pose; LINKS];

/// An obstacle's kind and pose.
type Obstacle = (usize, Pose);

pub fn measure(options: &Options) -> Result<Vec<Row>, String> {
    let kinds: [Pieces; 3] = [torus(24), gear(40), torus(64)].map(|pieces| scaled(&pieces, 0.12));
    let link = tube(0.05, 0.03, LENGTH);
    let obstacles = obstacles();
    let mut rows = Vec::new();
    for motion in ["random", "edges"] {
        let states = states(motion, 4 * options.count);
        let methods: Vec<Box<dyn Method + '_>> = vec![
            Box::new(InSet(Ours::new(&link, &kinds, &obstacles, &states)?, SetScratch::default())),
            Box::new(InScene(Ours::new(&link, &kinds, &obstacles, &states)?)),
            Box::new(Parry::new(&link, &kinds, &obstacles, &states)?),
        ];
        let scene = Scene { asked: "verdict", bodies: "arm", pieces: link.len(), motion };
        rows.extend(scene.measure(methods, [states.len(), options.passes], 0.0, met)?);
    }
    Ok(rows)
}

/// In a ball about the arm's foot, none near it.
fn obstacles() -> Vec<Obstacle> {
    let mut random = Random::new(0xa43);
    let pose = |k: usize| {
        let away = random.uniform(0.45f64.powi(3), 1.9f64.powi(3)).cbrt();
        (k % 3, Pose::new(&random.rotation(), &(random.direction() * away)))
    };
    (0..OBSTACLES).map(pose).collect()
}

/// Any states, or those of edges: joints go in equal steps by up to 0.4.
fn states(motion: &str, count: usize) -> Vec<State> {
    let mut random = Random::new(0x57a7e);
    let mut any = |size: f64| -> [f64; LINKS] { array::from_fn(|_| size * random.signed()) };
    if motion == "random" {
        return (0..count).map(|_| state(&any(2.0))).collect();
    }
    let edge = |_| {
        let (start, way) = (any(2.0), any(0.4));
        (0..EDGE).map(move |k| state(&array::from_fn(|j| start[j] + way[j] * k as f64 / (EDGE - 1) as f64)))
    };
    (0..count / EDGE).flat_map(edge).collect()
}

/// Joints turn about the link's own axis and across it by turns.
fn state(joints: &[f64; LINKS]) -> State {
    let (mut turn, mut foot) = (Matrix::identity(), Vector::zeros());
    array::from_fn(|k| {
        turn *= rotation(&if k % 2 == 0 { Vector::z() } else { Vector::y() }, joints[k]);
        let pose = Pose::new(&turn, &foot);
        foot += turn * Vector::z() * LENGTH;
        pose
    })
}

struct Ours<'a> {
    scene: SwiftproxScene,
    links: Vec<ObjectId>,
    states: &'a [State],
}

impl<'a> Ours<'a> {
    fn new(
        link: &Pieces,
        kinds: &[Pieces; 3],
        obstacles: &[Obstacle],
        states: &'a [State],
    ) -> Result<Ours<'a>, String> {
        let make = || -> Result<Ours<'a>, Error> {
            let mut scene = SwiftproxScene::new();
            let compounds = kinds.iter().map(|pieces| Ok(Arc::new(ours::compound(pieces)?)));
            let compounds: Vec<_> = compounds.collect::<Result<_, Error>>()?;
            for (kind, pose) in obstacles {
                let options = ObjectOptions { fixed: true, pose: *pose, groups: 2, ..ObjectOptions::default() };
                scene.add_compound(compounds[*kind].clone(), &options)?;
            }
            let link = Arc::new(ours::compound(link)?);
            // Links do not look at one another.
            let options = ObjectOptions { mask: 2, ..ObjectOptions::default() };
            let links = (0..LINKS).map(|_| scene.add_compound(link.clone(), &options)).collect::<Result<_, _>>()?;
            scene.prepare()?;
            Ok(Ours { scene, links, states })
        };
        make().map_err(|error| format!("arm: {error}"))
    }
}

/// A question about a set, which leaves the scene as it is.
struct InSet<'a>(Ours<'a>, SetScratch);

impl Method for InSet<'_> {
    fn name(&self) -> &'static str {
        ours::NAME
    }

    fn ask(&mut self, k: usize) -> f64 {
        let InSet(Ours { scene, links, states }, scratch) = self;
        let set = ObjectSet { ids: links, poses: None, among: false };
        let hit = scene.first_hit(&set, &states[k], PoseOrder::InOrder, 0.0, scratch).expect("rigid poses");
        hit.time as f64
    }
}

/// The links are moved, and the scene is asked.
struct InScene<'a>(Ours<'a>);

impl Method for InScene<'_> {
    fn name(&self) -> &'static str {
        "swiftprox-scene"
    }

    fn ask(&mut self, k: usize) -> f64 {
        let Ours { scene, links, states } = &mut self.0;
        scene.set_poses(links, &states[k]).expect("rigid poses");
        let query = SceneQuery { early_exit: true, ..SceneQuery::default() };
        f64::from(u8::from(scene.query_intersection(&query).expect("a sound query").found.is_none()))
    }
}

struct Parry {
    link: ParryCompound,
    obstacles: Vec<(usize, ParryPose)>,
    kinds: Vec<ParryCompound>,
    tree: Bvh,
    states: Vec<[ParryPose; LINKS]>,
}

impl Parry {
    fn new(link: &Pieces, kinds: &[Pieces; 3], obstacles: &[Obstacle], states: &[State]) -> Result<Parry, String> {
        let pose = |pose: &Pose| pose_of(pose.rows.as_flattened());
        let kinds = kinds.iter().map(|pieces| parry::compound(pieces)).collect::<Result<Vec<_>, _>>()?;
        let obstacles: Vec<_> = obstacles.iter().map(|(kind, at)| (*kind, pose(at))).collect();
        let boxes: Vec<Aabb> = obstacles.iter().map(|(kind, at)| kinds[*kind].compute_aabb(at)).collect();
        let tree = Bvh::from_leaves(BvhBuildStrategy::Binned, &boxes);
        let states = states.iter().map(|state| array::from_fn(|k| pose(&state[k]))).collect();
        Ok(Parry { link: parry::compound(link)?, obstacles, kinds, tree, states })
    }
}

impl Method for Parry {
    fn name(&self) -> &'static str {
        parry::NAME
    }

    fn ask(&mut self, k: usize) -> f64 {
        let meets = self.states[k].iter().any(|pose| {
            let near = self.link.compute_aabb(pose);
            let meets = |k: u32| {
                let (kind, at) = &self.obstacles[k as usize];
                parry::meet([(pose, &self.link), (at, &self.kinds[*kind])])
            };
            self.tree.intersect_aabb(&near).any(meets)
        });
        f64::from(u8::from(!meets))
    }
}
