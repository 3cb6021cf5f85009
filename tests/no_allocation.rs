//! Queries allocate nothing: the pair layer never, a scene not once it has seen as
//! large a crowd. Only integer arithmetic may, and the statistics say when it ran.

use std::sync::Arc;

use swiftprox::draw::{Draw, DrawKind};
use swiftprox::ground::{Ground, GroundContacts, HeightGrid, ground_contacts};
use swiftprox::hierarchy::{HierarchyKind, HierarchyOptions};
use swiftprox::manifold::ManifoldConfig;
use swiftprox::math::{Matrix, Pose, Vector};
use swiftprox::object::{ObjectId, ObjectOptions};
use swiftprox::pair::{self, Levels, PairAnswer, PairCache, PairConfig};
use swiftprox::progress::Progress;
use swiftprox::scene::{GroupFilter, Scene, SceneQuery, SetScratch};
use swiftprox::shape::{Shape, ShapeOptions};
use testkit::counting::{Counting, allocations};
use testkit::random_scene::{Random, cuboid, ellipsoid, random_pose};
use testkit::solids::{Form, SOLIDS};

#[global_allocator]
static ALLOCATOR: Counting = Counting;

fn shapes(random: &mut Random) -> Vec<Arc<Shape>> {
    let mut shapes = vec![cuboid([0.5, 0.5, 0.5]), cuboid([0.1, 0.4, 1.0])];
    for half in [[0.6, 0.6, 0.6], [0.6, 0.6, 0.06], [0.6, 0.06, 0.06]] {
        let plain = ellipsoid(random, 200, half, Vector::zeros());
        let options = HierarchyOptions { kind: HierarchyKind::Quadric, ..HierarchyOptions::default() };
        let leveled = (*plain).clone().with_levels(&options, &mut Progress::new(&mut |_| true)).unwrap();
        assert!(!leveled.hierarchy().levels.is_empty());
        shapes.extend([plain, Arc::new(leveled)]);
    }
    // Large enough for maps of their support functions.
    shapes.extend([[0.6, 0.6, 0.6], [0.6, 0.6, 0.06]].map(|half| ellipsoid(random, 1_000, half, Vector::zeros())));
    // Witness points on its caps of triangles are named by a search.
    let cylinder = SOLIDS.iter().find(|solid| solid.name == "cylinder-64").unwrap().mesh(Form::Turned).unwrap();
    shapes.push(Arc::new(Shape::from_mesh(&cylinder, &ShapeOptions::default()).unwrap()));
    shapes.iter().for_each(|shape| shape.prepare(&mut Progress::new(&mut |_| true)).unwrap());
    shapes
}

#[test]
fn the_counter_counts() {
    assert_eq!(allocations(|| drop(std::hint::black_box(vec![1_u8]))), 1);
}

#[test]
fn pair_queries_allocate_nothing() {
    let mut random = Random::new(5);
    let shapes = shapes(&mut random);
    let queries = [pair::distance, pair::intersection, pair::contact, pair::approximate];
    let mut without_exact_tier = 0;
    for k in 0..4_000 {
        let shape1 = &shapes[random.below(shapes.len())];
        let shape2 = &shapes[random.below(shapes.len())];
        let (pose1, pose2) = (random_pose(&mut random, 0.5), random_pose(&mut random, 0.5));
        let config = PairConfig {
            absolute_error: [0.0, 0.1, 0.01][k % 3],
            levels: [Levels::Automatic, Levels::All, Levels::None, Levels::All][k / 2 % 4],
            step_budget: if k % 7 == 0 { 3 } else { u32::MAX },
            ..Default::default()
        };
        let mut cache = PairCache::default();
        for query in queries {
            let mut answer = PairAnswer::default();
            let count = allocations(|| {
                query([shape1.at(&pose1), shape2.at(&pose2)], &mut cache, &config, &mut answer).unwrap();
            });
            let exact_tier = answer.statistics.exact_iterations > 0;
            assert!(count == 0 || exact_tier, "{count} allocations: {answer:?}");
            without_exact_tier += usize::from(!exact_tier);
        }
    }
    assert!(without_exact_tier > 14_500, "integer arithmetic decided all but {without_exact_tier} of 16,000");
}

/// Twelve objects that fly about, their poses and queries the same each time, in an order of queries that lists much and little.
/// Gives how many queries allocated, and how many did without integer arithmetic.
fn fly(scene: &mut Scene, ids: &[ObjectId]) -> [usize; 2] {
    let mut random = Random::new(7);
    let mut counts = [0; 2];
    for step in 0..400 {
        // Mostly a small step, sometimes a jump.
        for &id in ids {
            let pose = *scene.object(id).unwrap().pose();
            let moved = if step % 50 == 0 {
                random_pose(&mut random, 1.5)
            } else {
                let turn = Matrix::new(0.6, -0.8, 0.0, 0.8, 0.6, 0.0, 0.0, 0.0, 1.0);
                let rotation = if step % 10 == 0 { turn * pose.rotation() } else { pose.rotation() };
                Pose::new(&rotation, &(pose.translation() + (random.vector() * 0.01)))
            };
            scene.set_pose(id, &moved).unwrap();
        }
        scene.reset_statistics();
        let query = SceneQuery {
            early_exit: step % 7 == 0,
            max_distance: if step % 5 == 0 { 0.2 } else { f64::INFINITY },
            absolute_error: if step % 3 == 0 { 0.05 } else { 0.0 },
            error_budget: if step % 11 == 0 { 1.0 } else { f64::INFINITY },
            levels: if step % 4 < 2 { Levels::All } else { Levels::Automatic },
            ..SceneQuery::default()
        };
        let count = allocations(|| {
            let answer = match step % 5 {
                4 => scene.query_approximate(&query),
                0 => scene.query_intersection(&query),
                1 | 2 => scene.query_distance(&query),
                _ => scene.query_contact(&query),
            };
            answer.unwrap();
        });
        let exact_tier = scene.statistics().exact_iterations > 0;
        counts[0] += usize::from(count > 0 && !exact_tier);
        counts[1] += usize::from(!exact_tier);
    }
    counts
}

#[test]
fn scene_queries_allocate_nothing_once_they_have_seen_the_crowd() {
    let mut random = Random::new(6);
    let mut scene = Scene::new();
    let shapes = shapes(&mut random);
    let add = |k: usize| {
        // Every third object of two pieces.
        let pieces =
            (0..1 + usize::from(k.is_multiple_of(3))).map(|p| shapes[(k + p) % shapes.len()].clone()).collect();
        let options = ObjectOptions { pose: random_pose(&mut random, 1.5), ..Default::default() };
        scene.add_object(pieces, &options).unwrap()
    };
    let ids: Vec<ObjectId> = (0..12).map(add).collect();
    // Two lists of results take turns.
    let [first, _] = fly(&mut scene, &ids);
    fly(&mut scene, &ids);
    assert!(first > 0, "room is made when it is needed");
    let [allocating, without_exact_tier] = fly(&mut scene, &ids);
    assert_eq!(allocating, 0);
    assert!(without_exact_tier > 300, "integer arithmetic ran in all but {without_exact_tier} of 400 queries");
}

/// What a ground is asked about twice, in the room that the first time has made.
#[test]
fn contacts_with_grounds_allocate_nothing_once_there_is_room() {
    let mut random = Random::new(8);
    let heights: Vec<f64> = (0..441).map(|_| random.uniform(-0.1, 0.1)).collect();
    let grid = HeightGrid { rows: 21, columns: 21, spacing: [0.5; 2], heights: &heights };
    let (ground, here) = (Ground::from_heights(&grid).unwrap(), Pose::IDENTITY);
    let shapes = shapes(&mut random);
    let mut scene = Scene::new();
    let bodies: Vec<(Arc<Shape>, Pose)> = (0..200)
        .map(|k| {
            let place = Vector::new(random.uniform(2.0, 8.0), random.uniform(2.0, 8.0), random.uniform(0.1, 0.6));
            let pose = Pose::new(&random_pose(&mut random, 1.0).rotation(), &place);
            let shape = shapes[k % shapes.len()].clone();
            scene.add_object(vec![shape.clone()], &ObjectOptions { pose, ..Default::default() }).unwrap();
            (shape, pose)
        })
        .collect();
    scene.prepare().unwrap();
    let (mut found, mut scratch) = (GroundContacts::default(), SetScratch::default());
    let mut counts = [[0; 2]; 2];
    for counts in &mut counts {
        for reduces in [false, true] {
            let config = ManifoldConfig { max_distance: 0.05, reduces };
            for (shape, pose) in &bodies {
                let ask = || ground_contacts(shape.at(pose), ground.at(&here), &config, &mut found).unwrap();
                counts[0] += allocations(ask);
            }
            let filter = GroupFilter::default();
            counts[1] += allocations(|| {
                scene.ground_contacts(None, ground.at(&here), &config, filter, &mut scratch).unwrap();
            });
        }
    }
    assert!(counts[0].iter().all(|count| *count > 0), "room is made when it is needed");
    assert_eq!(counts[1], [0; 2]);
}

/// Counts the edges alone.
struct EdgeCount(usize);

impl Draw for EdgeCount {
    fn wants(&self, kind: DrawKind) -> bool {
        kind == DrawKind::Edge
    }

    fn line(&mut self, _: DrawKind, _: [f64; 3], _: [f64; 3]) {
        self.0 += 1;
    }

    fn point(&mut self, _: DrawKind, _: [f64; 3]) {}

    fn text(&mut self, _: DrawKind, _: [f64; 3], _: &str) {}
}

/// A million triangles go to the drawer edge by edge, and to an array part by part.
#[test]
fn reading_a_large_ground_allocates_nothing() {
    const ROWS: usize = 501;
    const COLUMNS: usize = 1_001;
    let heights = vec![0.0; ROWS * COLUMNS];
    let grid = HeightGrid { rows: ROWS, columns: COLUMNS, spacing: [1.0; 2], heights: &heights };
    let ground = Arc::new(Ground::from_heights(&grid).unwrap());
    let mut scene = Scene::new();
    scene.add_ground(ground.clone(), &ObjectOptions::default()).unwrap();
    let mut count = EdgeCount(0);
    assert_eq!(allocations(|| scene.draw(&mut count)), 0);
    let (cells, rims) = ((ROWS - 1) * (COLUMNS - 1), ROWS - 1 + COLUMNS - 1);
    assert_eq!((ground.triangle_count(), count.0), (1_000_000, 3 * cells + rims));
    let sum = |first| ground.triangles(first, 1_000).unwrap().map(|(_, corners)| corners[2].x).sum::<f64>();
    let mut total = 0.0;
    assert_eq!(allocations(|| total = (0..1_000_000).step_by(1_000).map(sum).sum()), 0);
    assert_eq!(total, (ROWS - 1) as f64 * (1..COLUMNS).map(|x| (2 * x - 1) as f64).sum::<f64>());
    assert!(ground.triangles(999_999, 2).is_err() && ground.triangles(usize::MAX, 2).is_err());
}
