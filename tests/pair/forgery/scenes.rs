//! Pairs of bodies of every kind, and what the library answers about them.

use std::sync::LazyLock;

use swiftprox::hierarchy::{HierarchyKind, HierarchyOptions};
use swiftprox::math::{Matrix, Pose, Vector};
use swiftprox::pair::{self, Levels, Outcome, PairAnswer, PairCache, PairConfig, Placed};
use swiftprox::shape::{Shape, ShapeOptions};

use testkit::cases::{Case, FAMILIES, Random, coordinates};
use testkit::models::ellipsoid;
use testkit::oracle::Polytope;
use testkit::shapes::{at, hull};

/// Two bodies at their poses.
pub struct Scene {
    pub family: &'static str,
    pub name: String,
    pub points: [Vec<Vector>; 2],
    pub shapes: [Shape; 2],
    pub poses: [Pose; 2],
    /// The bodies in their own frames, as the oracle has them; it is too slow for many vertices.
    pub polytopes: Option<[Polytope; 2]>,
}

/// Made once for all tests.
pub static SCENES: LazyLock<Vec<Scene>> = LazyLock::new(scenes);

fn scene(family: &'static str, number: usize, points: [Vec<Vector>; 2], poses: [Pose; 2]) -> Scene {
    let shapes = [hull(&points[0]), hull(&points[1])];
    let polytopes = Some([Polytope::new(&coordinates(&points[0])), Polytope::new(&coordinates(&points[1]))]);
    Scene { family, name: format!("{family} {number}"), points, shapes, poses, polytopes }
}

/// Cases looked at for two that are apart and one that is not, which some families seldom have.
const CASES_PER_FAMILY: usize = 24;

fn scenes() -> Vec<Scene> {
    let mut scenes = Vec::new();
    for (seed, (family, generate)) in FAMILIES.iter().enumerate() {
        let mut random = Random::new(seed as u64);
        let (mut apart, mut together) = (0, 0);
        for _ in 0..CASES_PER_FAMILY {
            let case = generate(&mut random);
            let number = apart + together;
            let (count, most) = if case.truth().intersecting() { (&mut together, 1) } else { (&mut apart, 2) };
            if *count < most {
                *count += 1;
                let Case { points_a, pose_a, points_b, pose_b } = case;
                scenes.push(scene(family, number, [points_a, points_b], [pose_a, pose_b]));
            }
        }
    }
    let cube = |half: f64| -> Vec<Vector> {
        let sign = |corner: u32, axis: u32| if corner >> axis & 1 == 1 { half } else { -half };
        (0..8).map(|corner| Vector::new(sign(corner, 0), sign(corner, 1), sign(corner, 2))).collect()
    };
    let needle = |size: f64| -> Vec<Vector> {
        [[0.0, 1e-9, 0.0], [0.0, -1e-9, 1e-9], [0.0, 0.0, -1e-9], [1.0, 0.0, 0.0]]
            .map(|p| size * Vector::from(p))
            .to_vec()
    };
    let turned = |x: f64| Pose::new(&Random::new(7).rotation(), &Vector::new(x, 0.3 * x, -0.2 * x));
    for (number, size) in
        [1.0, 2f64.powi(-1060), 2f64.powi(-900), 2f64.powi(250), 2f64.powi(1010)].into_iter().enumerate()
    {
        let apart = [at(0.0, 0.0, 0.0), at(3.0 * size, 0.5 * size, 0.25 * size)];
        scenes.push(scene("cubes", number, [cube(size), cube(size)], apart));
        scenes.push(scene("turned cubes", number, [cube(size), cube(size)], [apart[0], turned(4.0 * size)]));
        scenes.push(scene("needles", number, [needle(size), cube(size)], [apart[0], turned(2.5 * size)]));
        scenes.push(scene("touching cubes", number, [cube(size), cube(size)], [apart[0], at(2.0 * size, 0.0, 0.0)]));
    }
    let near = [at(0.0, 0.0, 0.0), at(1.0_f64.next_up(), 0.0, 0.0)];
    scenes.push(scene("cubes a unit in the last place apart", 0, [cube(0.5), cube(0.5)], near));
    let far = [at(1e9, -2e9, 3e9), at(1e9 + 1.5, -2e9, 3e9)];
    scenes.push(scene("cubes far out", 0, [cube(0.5), cube(0.5)], far));
    let mut skewed = turned(2.0);
    skewed.rows.iter_mut().enumerate().for_each(|(k, row)| row[k] += 3e-3);
    scenes.push(scene("skewed cubes", 0, [cube(0.5), cube(0.5)], [at(0.0, 0.0, 0.0), skewed]));
    scenes.extend(with_levels());
    scenes
}

/// Bodies of so many vertices that they have levels of detail.
fn with_levels() -> Vec<Scene> {
    let mesh = ellipsoid([1.0, 0.7, 0.4], 100).unwrap();
    let hierarchy =
        HierarchyOptions { kind: HierarchyKind::Quadric, minimum_triangles: 12, ..HierarchyOptions::default() };
    let options = ShapeOptions { hierarchy, ..ShapeOptions::default() };
    let shape = || Shape::from_mesh(&mesh, &options).unwrap();
    let there = |x: f64| Pose::new(&Random::new(3).rotation(), &Vector::new(x, 0.2, 0.1));
    let scene = |number: usize, pose: Pose| Scene {
        family: "levels",
        name: format!("levels {number}"),
        points: [mesh.vertices.clone(), mesh.vertices.clone()],
        shapes: [shape(), shape()],
        poses: [Pose::new(&Matrix::identity(), &Vector::zeros()), pose],
        polytopes: None,
    };
    vec![scene(0, there(2.2)), scene(1, there(4.0))]
}

type Query = fn([Placed; 2], &mut PairCache, &PairConfig, &mut PairAnswer) -> swiftprox::error::Result<()>;

impl Scene {
    fn ask(&self, query: Query, config: &PairConfig) -> PairAnswer {
        let ([shape1, shape2], [pose1, pose2]) = (&self.shapes, &self.poses);
        let (mut cache, mut answer) = (PairCache::default(), PairAnswer::default());
        query([shape1.at(pose1), shape2.at(pose2)], &mut cache, config, &mut answer).unwrap();
        answer
    }
}

/// Answers of every tier.
pub fn answers(scene: &Scene) -> Vec<(&'static str, PairAnswer)> {
    let all = PairConfig { levels: Levels::All, ..PairConfig::default() };
    let exact = scene.ask(pair::distance, &PairConfig::default());
    let beyond = PairConfig { max_distance: 0.5 * exact.lower, ..PairConfig::default() };
    let (exact_query, exact) = if exact.outcome == Outcome::Intersecting {
        ("contact", scene.ask(pair::contact, &PairConfig::default()))
    } else {
        ("distance", exact)
    };
    vec![
        (exact_query, exact),
        ("intersection", scene.ask(pair::intersection, &PairConfig::default())),
        ("beyond a tolerance", scene.ask(pair::distance, &beyond)),
        ("through levels", scene.ask(pair::approximate, &PairConfig { relative_error: 0.2, ..all })),
        ("with a budget", scene.ask(pair::approximate, &PairConfig { step_budget: 1, ..all })),
    ]
}
