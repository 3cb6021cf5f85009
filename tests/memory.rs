//! Where memory is lacking a call says so and has changed nothing. An allocator refuses one block after the other: every block of
//! at least [`SMALL`] bytes, which no block may have that is not asked for in a way that can be refused; and of queries every
//! block.

// GlobalAlloc is an unsafe trait.
#![allow(unsafe_code)]

use std::alloc::{GlobalAlloc, Layout, System};
use std::cell::Cell;
use std::fmt::Write;
use std::sync::Arc;

use swiftprox::error::{Error, Result};
use swiftprox::ground::{Ground, GroundContacts, HeightGrid, ground_contacts, ground_distance};
use swiftprox::hierarchy::{HierarchyKind, HierarchyOptions};
use swiftprox::manifold::{ManifoldCache, ManifoldConfig, ManifoldPoint};
use swiftprox::math::{Matrix, Pose, Vector};
use swiftprox::mesh::PolygonMesh;
use swiftprox::mesh_io::{parse_mesh, read_mesh};
use swiftprox::motion::{self, CastAnswer, CastConfig, Clearance, ClearanceConfig, Motion, Moving, verify_cast};
use swiftprox::object::{ObjectId, ObjectOptions};
use swiftprox::pair::{
    self, DepthAnswer, DepthCache, DepthConfig, HalfSpace, Outcome, PairAnswer, PairCache, PairConfig, Placed,
    SignedDistance, SignedDistanceCache,
};
use swiftprox::point::locate_point;
use swiftprox::progress::Progress;
use swiftprox::ray::{Ray, cast_ray};
use swiftprox::scene::{
    ContactDetail, GroupFilter, ObjectSet, PairResult, PoseOrder, RayHits, Scene, SceneQuery, SetScratch, Workers,
};
use swiftprox::shape::{InputPolicy, LookupKind, LookupOptions, Shape, ShapeOptions};
use swiftprox::shape_file::{from_bytes, load, save, to_bytes};
use swiftprox::verify::{verify, verify_depth, verify_manifold};
use testkit::random::Random;

/// No block that ends the program when it is refused is as large (`docs/conventions.md`, Memory).
const SMALL: usize = 2048;

/// Vertices of the bodies: of one byte each they fill a block that is not small. Twice as many must make no other block so.
const SIZES: [usize; 2] = [2_100, 4_200];

thread_local! {
    /// From which size on blocks are looked at.
    static LEAST: Cell<usize> = const { Cell::new(SMALL) };
    /// Large blocks asked for since the last refusal was ordered; this thread's alone, as all here.
    static ASKED: Cell<usize> = const { Cell::new(0) };
    /// Which of them is refused; 0 for none.
    static REFUSED: Cell<usize> = const { Cell::new(0) };
    /// Whether all that follow are, too.
    static FOR_GOOD: Cell<bool> = const { Cell::new(false) };
    /// Blocks that were given and not yet given back.
    static BLOCKS: Cell<isize> = const { Cell::new(0) };
}

fn refuses(size: usize) -> bool {
    if size < LEAST.get() {
        return false;
    }
    let asked = ASKED.get() + 1;
    ASKED.set(asked);
    let refused = REFUSED.get();
    refused > 0 && (asked == refused || (asked > refused && FOR_GOOD.get()))
}

struct Refusing;

// SAFETY: every call is handed to the system's allocator unchanged or refused; the counters neither allocate nor have destructors.
unsafe impl GlobalAlloc for Refusing {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        if refuses(layout.size()) {
            return std::ptr::null_mut();
        }
        BLOCKS.set(BLOCKS.get() + 1);
        // SAFETY: the caller's promise, passed on.
        unsafe { System.alloc(layout) }
    }

    unsafe fn dealloc(&self, pointer: *mut u8, layout: Layout) {
        BLOCKS.set(BLOCKS.get() - 1);
        // SAFETY: the caller's promise, passed on; `alloc` and `realloc` hand out the system's pointers.
        unsafe { System.dealloc(pointer, layout) }
    }

    unsafe fn realloc(&self, pointer: *mut u8, layout: Layout, size: usize) -> *mut u8 {
        if refuses(size) {
            return std::ptr::null_mut();
        }
        // SAFETY: as for `dealloc`.
        unsafe { System.realloc(pointer, layout, size) }
    }
}

#[global_allocator]
static ALLOCATOR: Refusing = Refusing;

/// Does some work while the block of a number is refused, and those that follow it if `for_good`; says whether it came to that.
fn without<T>(number: usize, for_good: bool, work: impl FnOnce() -> T) -> (T, bool) {
    ASKED.set(0);
    FOR_GOOD.set(for_good);
    REFUSED.set(number);
    let done = work();
    REFUSED.set(0);
    (done, ASKED.get() >= number)
}

/// The numbers of the blocks that are refused: the first ones all, then a few of a hundred, so that building a body a thousand
/// times is not what takes the time.
fn numbers() -> impl Iterator<Item = usize> {
    std::iter::successors(Some(1), |number| Some(number + 1 + number / 16))
}

/// Refuses one block after the other until the work gets all that it asks for, alone and now and then with all that follow. Every
/// time it must end in [`Error::Memory`] and keep no block. Hands over what is made at last.
fn refuse_each<T>(what: &str, mut work: impl FnMut() -> Result<T>) -> T {
    let mut refusals = 0;
    for number in numbers() {
        let before = BLOCKS.get();
        let (made, came_to_that) = without(number, false, &mut work);
        if !came_to_that {
            assert!(refusals > 0, "{what} asks for no large block");
            return made.unwrap_or_else(|error| panic!("{what}: {error}"));
        }
        refusals += 1;
        let error = made.map(drop).expect_err(what);
        assert!(matches!(error, Error::Memory(_)), "{what}, block {number}: {error:?}");
        assert!(error.message().contains("memory"), "{what}: {error}");
        drop(error);
        assert_eq!(BLOCKS.get(), before, "{what} keeps blocks when block {number} is refused");
        if refusals % 8 == 1 {
            let (made, _) = without(number, true, &mut work);
            assert!(matches!(made.map(drop), Err(Error::Memory(_))), "{what}, from block {number} on");
            assert_eq!(BLOCKS.get(), before, "{what} keeps blocks when all from {number} on are refused");
        }
    }
    unreachable!()
}

/// Points on a ball, in general position.
fn ball(count: usize) -> Vec<Vector> {
    let mut random = Random::new(count as u64);
    (0..count).map(|_| random.direction()).collect()
}

/// What a shape is made of as a mesh of triangles.
fn mesh_of(shape: &Shape) -> PolygonMesh {
    let body = shape.polyhedron();
    let vertices = (0..body.vertices.len() as u32).map(|v| body.local_position(v)).collect();
    PolygonMesh::new(vertices, body.triangles.as_flattened().to_vec(), None).unwrap()
}

/// A prism over a polygon of so many corners: two faces of as many sides, cut into triangles from a hub on one side.
fn prism(corners: u32) -> PolygonMesh {
    let mut vertices = Vec::new();
    for z in [0.0, 1.0] {
        for i in 0..corners {
            let angle = f64::from(i) / f64::from(corners) * std::f64::consts::TAU;
            vertices.push(Vector::new(angle.cos(), angle.sin(), z));
        }
    }
    vertices.push(Vector::new(0.0, 0.0, 1.0));
    let (mut indices, mut valences) = ((0..corners).rev().collect::<Vec<u32>>(), vec![corners]);
    for i in 0..corners {
        let next = (i + 1) % corners;
        indices.extend([i, next, corners + next, corners + i]);
        valences.push(4);
        indices.extend([2 * corners, corners + i, corners + next]);
        valences.push(3);
    }
    PolygonMesh::new(vertices, indices, Some(&valences)).unwrap()
}

fn with_levels(kind: HierarchyKind) -> ShapeOptions {
    ShapeOptions { hierarchy: HierarchyOptions { kind, ..HierarchyOptions::default() }, ..ShapeOptions::default() }
}

fn no_progress<T>(work: impl FnOnce(&mut Progress) -> T) -> T {
    work(&mut Progress::new(&mut |_| true))
}

#[test]
fn shapes_from_points() {
    for size in SIZES {
        let points = ball(size);
        let shape = refuse_each("a ball", || Shape::from_points(&points, &ShapeOptions::default()));
        assert_eq!(shape.polyhedron().vertices.len(), size);
        let with_inner: Vec<Vector> = points.iter().flat_map(|p| [*p, 0.5 * p]).collect();
        refuse_each("a ball with points inside", || Shape::from_points(&with_inner, &ShapeOptions::default()));
        let moved = ShapeOptions { translation: Vector::new(9.0, 0.0, 0.0), ..ShapeOptions::default() };
        refuse_each("a ball elsewhere", || Shape::from_points(&points, &moved));
        let flat: Vec<Vector> = points.iter().map(|p| Vector::new(p.x, p.y, 0.0).normalize()).collect();
        let hull = ShapeOptions { input: InputPolicy::Hull, ..ShapeOptions::default() };
        refuse_each("a polygon", || Shape::from_points(&flat, &hull));
    }
    // Exponents that ask for integers; many points make that slow.
    let wide: Vec<Vector> = ball(SIZES[0]).iter().map(|p| Vector::new(p.x, p.y, 1e-120 * p.z)).collect();
    let hull = ShapeOptions { input: InputPolicy::Hull, ..ShapeOptions::default() };
    let (made, _) = without(1, false, || Shape::from_points(&wide[..700], &hull));
    assert!(matches!(made, Err(Error::Memory(_))));
}

#[test]
fn shapes_from_meshes() {
    for size in SIZES {
        let ball = mesh_of(&Shape::from_points(&ball(size), &ShapeOptions::default()).unwrap());
        refuse_each("a ball's mesh", || Shape::from_mesh(&ball, &ShapeOptions::default()));
        let prism = prism(size as u32);
        let shape = refuse_each("a prism", || Shape::from_mesh(&prism, &ShapeOptions::default()));
        assert_eq!(shape.polyhedron().faces.len(), size + 2);
        // A vertex pulled inwards: all that is looked at in search of what is wrong.
        let mut dented = ball.clone();
        dented.vertices[7] *= 0.5;
        for number in numbers() {
            let (refused, came_to_that) =
                without(number, false, || Shape::from_mesh(&dented, &ShapeOptions::default()));
            match refused.map(drop) {
                Err(Error::Mesh(_)) if !came_to_that => break,
                Err(Error::Memory(_)) if came_to_that => {}
                other => panic!("block {number}: {other:?}"),
            }
        }
        // A mesh whose faces are ignored: never because of memory.
        let hull = ShapeOptions { input: InputPolicy::Hull, ..ShapeOptions::default() };
        let made = refuse_each("a mesh as a hull", || Shape::from_mesh(&prism, &hull));
        assert_eq!(made, shape);
    }
}

#[test]
fn levels_of_each_kind() {
    for kind in [HierarchyKind::Quadric, HierarchyKind::DobkinKirkpatrick, HierarchyKind::OuterCuts] {
        let points = ball(SIZES[0]);
        let shape = refuse_each(&format!("{kind:?}"), || Shape::from_points(&points, &with_levels(kind)));
        assert!(!shape.hierarchy().levels.is_empty());
    }
    let meshes: Vec<PolygonMesh> = SIZES
        .iter()
        .rev()
        .map(|size| mesh_of(&Shape::from_points(&ball(*size), &ShapeOptions::default()).unwrap()))
        .collect();
    refuse_each("levels that are given", || {
        no_progress(|progress| Shape::from_levels(&meshes, &ShapeOptions::default(), progress))
    });
    // In a frame that is not the body's own.
    let moved = ShapeOptions { translation: Vector::new(9.0, 0.0, 0.0), ..ShapeOptions::default() };
    let (points, options) = (ball(SIZES[0]), with_levels(HierarchyKind::Quadric).hierarchy);
    refuse_each("levels of a body elsewhere", || {
        let body = Shape::from_points(&points, &moved)?;
        no_progress(|progress| body.with_levels(&options, progress))
    });
}

#[test]
fn mesh_files() {
    for size in SIZES {
        let mesh = mesh_of(&Shape::from_points(&ball(size), &ShapeOptions::default()).unwrap());
        let count = mesh.face_count();
        let (mut obj, mut stl) = (String::new(), "solid ball\n".to_string());
        let mut rest = String::new();
        for p in &mesh.vertices {
            writeln!(obj, "v {} {} {}", p.x, p.y, p.z).unwrap();
            writeln!(rest, "{} {} {}", p.x, p.y, p.z).unwrap();
        }
        let (mut tri, mut polygons) = (rest.clone(), rest);
        for f in 0..count {
            let [a, b, c] = *mesh.face(f).first_chunk().unwrap();
            writeln!(obj, "f {} {} {}", a + 1, b + 1, c + 1).unwrap();
            writeln!(tri, "{a} {b} {c}").unwrap();
            writeln!(polygons, "3 {a} {b} {c}").unwrap();
            stl += "facet normal 0 0 0\nouter loop\n";
            for v in [a, b, c] {
                let p = mesh.vertices[v as usize];
                writeln!(stl, "vertex {} {} {}", p.x, p.y, p.z).unwrap();
            }
            stl += "endloop\nendfacet\n";
        }
        stl += "endsolid ball\n";
        let files = [
            ("obj", obj),
            ("stl", stl),
            ("tri", format!("TRI {size} {count}\n{tri}")),
            ("poly", format!("POLY {size} {count}\n{polygons}")),
            ("off", format!("OFF {size} {count} 0\n{polygons}")),
        ];
        for (extension, content) in files {
            let read = refuse_each(extension, || parse_mesh(content.as_bytes(), None, "a file"));
            assert_eq!((read.vertices.len(), read.face_count()), (size, count));
            let path = std::env::temp_dir().join(format!("swiftprox-memory-{}-{size}.{extension}", std::process::id()));
            std::fs::write(&path, content).unwrap();
            refuse_each("a file", || read_mesh(&path));
            std::fs::remove_file(&path).unwrap();
        }
    }
}

#[test]
fn shape_files() {
    for kind in [HierarchyKind::None, HierarchyKind::Quadric] {
        let shape = Shape::from_mesh(&prism(SIZES[0] as u32), &with_levels(HierarchyKind::None)).unwrap();
        let shape = no_progress(|progress| shape.with_levels(&with_levels(kind).hierarchy, progress)).unwrap();
        let bytes = refuse_each("a shape as bytes", || to_bytes(&shape));
        let path = std::env::temp_dir().join(format!("swiftprox-memory-{}-{kind:?}.shape", std::process::id()));
        std::fs::write(&path, "as it was").unwrap();
        let (refused, _) = without(1, false, || save(&shape, &path));
        assert!(matches!(refused, Err(Error::Memory(_))));
        assert_eq!(std::fs::read(&path).unwrap(), b"as it was");
        save(&shape, &path).unwrap();
        assert_eq!(std::fs::read(&path).unwrap(), bytes);
        assert_eq!(refuse_each("a shape from bytes", || from_bytes(&bytes)), shape);
        let (refused, _) = without(1, true, || load(&path));
        assert!(matches!(refused, Err(Error::Memory(_))));
        assert_eq!(load(&path).unwrap(), shape);
        std::fs::remove_file(&path).unwrap();
    }
}

/// A distance query of two of a shape, by a cache of its own.
fn distance(shape: &Shape, config: &PairConfig) -> PairAnswer {
    let (mut cache, mut answer) = (PairCache::default(), PairAnswer::default());
    let there = Pose::new(&Matrix::identity(), &Vector::new(2.5, 1.0, 0.25));
    pair::distance([shape.at(&Pose::IDENTITY), shape.at(&there)], &mut cache, config, &mut answer).unwrap();
    answer
}

/// Queries that need a table go on without, and say the same; [`Shape::prepare`] says what is lacking.
#[test]
fn the_first_query_of_a_shape() {
    for kind in [LookupKind::Automatic, LookupKind::Spherical] {
        let lookup = LookupOptions { kind, ..LookupOptions::default() };
        let new = || Shape::from_points(&ball(SIZES[0]), &ShapeOptions { lookup, ..ShapeOptions::default() }).unwrap();
        let config = PairConfig::default();
        let expected = distance(&new(), &config);
        assert_eq!(expected.outcome, Outcome::Separated);
        for number in 1.. {
            let shape = new();
            let bytes = shape.bytes();
            let (answer, came_to_that) = without(number, false, || distance(&shape, &config));
            assert!(
                answer.outcome == Outcome::Separated
                    && answer.lower <= expected.upper
                    && expected.lower <= answer.upper
            );
            if !came_to_that {
                assert!(number > 3 && shape.bytes() > bytes);
                break;
            }
            // No query tries again, as that takes long; what insists on the table makes it.
            let (_, asks) = without(1, false, || distance(&shape, &config));
            assert!(!asks && shape.bytes() == bytes, "{kind:?}: block {number}");
            no_progress(|progress| shape.prepare(progress)).unwrap();
            assert!(shape.bytes() > bytes);
            assert_eq!(distance(&shape, &config), expected);
        }
        let points = ball(SIZES[0]);
        refuse_each("to prepare", || {
            let shape = Shape::from_points(&points, &ShapeOptions { lookup, ..ShapeOptions::default() })?;
            no_progress(|progress| shape.prepare(progress))
        });
    }
}

/// Automatic levels, which only large bodies have: for some of the blocks.
#[test]
fn automatic_levels() {
    let new = || Shape::from_points(&ball(30_000), &ShapeOptions::default()).unwrap();
    let ask = |shape: &Shape| {
        let (mut cache, mut answer) = (PairCache::default(), PairAnswer::default());
        let there = Pose::new(&Matrix::identity(), &Vector::new(2.5, 1.0, 0.25));
        // Too little for maps of support functions.
        let config = PairConfig { relative_error: 0.002, ..PairConfig::default() };
        pair::approximate([shape.at(&Pose::IDENTITY), shape.at(&there)], &mut cache, &config, &mut answer).unwrap();
        answer
    };
    let shape = new();
    let expected = ask(&shape);
    assert!(!shape.hierarchy().levels.is_empty(), "the query goes through levels");
    for number in [1, 9, 40, 100] {
        let shape = new();
        let (answer, _) = without(number, number % 2 == 0, || ask(&shape));
        assert!(shape.hierarchy().levels.is_empty(), "block {number}");
        assert!(
            answer.outcome == Outcome::Separated && answer.lower <= expected.upper && expected.lower <= answer.upper
        );
        let (refused, _) = without(number, false, || no_progress(|progress| shape.prepare(progress)));
        assert!(matches!(refused, Err(Error::Memory(_))), "{refused:?}");
        no_progress(|progress| shape.prepare(progress)).unwrap();
        let answer = ask(&shape);
        assert_eq!((answer.lower, answer.upper), (expected.lower, expected.upper));
    }
}

/// A scene of so many boxes in a row, each touching the next.
fn row(count: usize) -> (Scene, Vec<swiftprox::object::ObjectId>) {
    let corners: Vec<Vector> = (0..8).map(|i| Vector::from_fn(|k, _| f64::from(i >> k & 1))).collect();
    let shape = Arc::new(Shape::from_points(&corners, &ShapeOptions::default()).unwrap());
    let mut scene = Scene::new();
    let ids = (0..count).map(|i| {
        let pose = Pose::new(&Matrix::identity(), &Vector::new(i as f64, 0.0, 0.0));
        scene.add_object(vec![shape.clone()], &ObjectOptions { pose, ..ObjectOptions::default() }).unwrap()
    });
    let ids = ids.collect();
    (scene, ids)
}

#[test]
fn scenes() {
    let (mut scene, mut ids) = row(2);
    let original = ids[0];
    let mut refusals = [0; 3];
    // Objects one by one: most calls need no block, whatever is refused.
    while ids.len() < 3_000 {
        let before = scene.object_count();
        match without(1, false, || scene.copy_object(original)).0 {
            Ok(id) => ids.push(id),
            Err(Error::Memory(_)) => {
                refusals[0] += 1;
                assert_eq!(scene.object_count(), before);
                ids.push(scene.copy_object(original).unwrap());
            }
            Err(error) => panic!("{error}"),
        }
    }
    for (i, id) in ids.iter().enumerate().skip(1) {
        let (said, _) = without(1, false, || scene.set_pair_active(original, *id, i % 2 == 0));
        if said.is_err() {
            assert!(matches!(said, Err(Error::Memory(_))));
            refusals[1] += 1;
            assert!(scene.is_pair_active(original, *id).unwrap());
            scene.set_pair_active(original, *id, i % 2 == 0).unwrap();
        }
        assert_eq!(scene.is_pair_active(original, *id).unwrap(), i % 2 == 0);
    }
    // Removing needs no memory.
    let (left, _) = without(1, true, || ids.drain(20..).try_for_each(|id| scene.remove_object(id)));
    left.unwrap();

    let (mut scene, ids) = row(60);
    type Query = for<'a> fn(&'a mut Scene, &SceneQuery) -> Result<swiftprox::scene::SceneAnswer<'a>>;
    let queries: [Query; 4] =
        [Scene::query_intersection, Scene::query_distance, Scene::query_contact, Scene::query_approximate];
    for query in queries {
        scene.set_pair_active(ids[0], ids[5], false).unwrap(); // the list of pairs is out of date
        let statistics = *scene.statistics();
        for number in 1.. {
            let config = SceneQuery { max_distance: 0.5, ..SceneQuery::default() };
            let (said, came_to_that) =
                without(number, false, || query(&mut scene, &config).map(|said| said.pairs.len()));
            if !came_to_that {
                assert_eq!(said, Ok(59), "each touches the next");
                break;
            }
            refusals[2] += 1;
            assert!(matches!(said, Err(Error::Memory(_))), "{said:?}");
            assert_eq!(*scene.statistics(), statistics);
        }
    }
    assert!(refusals.iter().all(|count| *count > 1), "{refusals:?}");
}

/// A query that is shared out, every part in this thread: whatever block is refused, it says so, and the next one says what a scene
/// without workers says.
#[test]
fn shared_queries() {
    // So many that boxes and cells are shared as well.
    const SIDE: usize = 13;
    let shape = Arc::new(testkit::shapes::cuboid([0.5; 3]));
    let lattice = |workers: Option<Workers>| {
        let mut scene = Scene::new();
        scene.set_workers(workers);
        for k in 0..SIDE * SIDE * SIDE {
            let [x, y, z] = [k % SIDE, k / SIDE % SIDE, k / (SIDE * SIDE)].map(|i| 1.1 * i as f64);
            let pose = Pose::new(&Matrix::identity(), &Vector::new(x, y, z));
            let options = ObjectOptions { pose, user_data: k as u64, ..ObjectOptions::default() };
            scene.add_object(vec![shape.clone()], &options).unwrap();
        }
        scene
    };
    let in_turn = |parts: usize, work: &(dyn Fn(usize) + Sync)| (0..parts).for_each(work);
    let query = SceneQuery { max_distance: 0.15, ..SceneQuery::default() };
    let listed = |scene: &mut Scene| {
        let said = scene.query_distance(&query).unwrap();
        let of = |pair: &PairResult| (pair.user_data1, pair.user_data2, pair.answer.distance.to_bits());
        said.pairs.iter().map(of).collect::<Vec<_>>()
    };
    let expected = listed(&mut lattice(None));
    assert!(expected.len() > 2_048, "it is worth sharing");
    let mut refusals = 0;
    for number in numbers() {
        // Memory that the scene keeps it need not ask for again.
        let mut scene = lattice(Some(Workers::new(3, in_turn)));
        let (said, came_to_that) = without(number, false, || scene.query_distance(&query).map(|said| said.pairs.len()));
        assert_eq!(listed(&mut scene), expected, "after block {number} was refused");
        if !came_to_that {
            assert_eq!(said, Ok(expected.len()));
            break;
        }
        refusals += 1;
        assert!(matches!(said, Err(Error::Memory(_))), "block {number}: {said:?}");
    }
    assert!(refusals > 20, "{refusals}");
}

/// Many poses at once, by one thread and by several: each block is refused once, and all objects stay where they are.
#[test]
fn many_poses() {
    const COUNT: usize = 2_100;
    let in_turn = |parts: usize, work: &(dyn Fn(usize) + Sync)| (0..parts).for_each(work);
    let shape = Arc::new(testkit::shapes::cuboid([0.5; 3]));
    let poses = |step: f64| (0..COUNT).map(move |k| Pose::new(&Matrix::identity(), &Vector::new(k as f64, step, 0.0)));
    let moved: Vec<Pose> = poses(3.0).collect();
    for (workers, fewest_refusals) in [(Workers::new(1, in_turn), 1), (Workers::new(40, in_turn), 3)] {
        let mut scene = Scene::new();
        scene.set_workers(Some(workers));
        for pose in poses(0.0) {
            scene.add_object(vec![shape.clone()], &ObjectOptions { pose, ..ObjectOptions::default() }).unwrap();
        }
        let mut refusals = 0;
        for number in numbers() {
            let (said, came_to_that) = without(number, false, || scene.set_all_poses(&moved));
            if !came_to_that {
                assert_eq!(said, Ok(()));
                break;
            }
            refusals += 1;
            assert!(matches!(said, Err(Error::Memory(_))), "block {number}: {said:?}");
            assert!(scene.objects().zip(poses(0.0)).all(|(object, pose)| *object.pose() == pose), "block {number}");
        }
        assert!(refusals >= fewest_refusals, "{refusals}");
        assert!(scene.objects().zip(&moved).all(|(object, pose)| object.pose() == pose));
    }
}

/// Depths, their memory and the points of manifolds: each block is refused once, and the next query says all of it.
#[test]
fn contacts_of_scenes() {
    let (mut scene, _) = row(60);
    let query = SceneQuery { detail: ContactDetail::Manifold, max_distance: 0.5, ..SceneQuery::default() };
    let mut refusals = 0;
    for number in 1.. {
        let (said, came_to_that) = without(number, number % 4 == 0, || {
            scene.query_contact(&query).map(|said| (said.pairs.len(), said.contacts.points.len()))
        });
        if !came_to_that {
            assert_eq!(said, Ok((59, 59 * 4)), "each stands on the next by four corners");
            break;
        }
        refusals += 1;
        assert!(matches!(said, Err(Error::Memory(_))), "{said:?}");
        assert!(scene.contacts().contacts.is_empty());
        let [room, used] = scene.remembered_depths();
        assert!(used <= 59 && room <= 59);
    }
    assert!(refusals > 5, "{refusals}");
    assert_eq!(scene.remembered_depths()[1], 59);
}

/// A number that tells answers from others, without a block of memory.
fn digest(numbers: impl IntoIterator<Item = u64>) -> u64 {
    numbers.into_iter().fold(7, |sum: u64, x| (sum ^ x).wrapping_mul(0x9e37_79b9_7f4a_7c15).rotate_left(29))
}

fn bits(numbers: impl IntoIterator<Item = f64>) -> u64 {
    digest(numbers.into_iter().map(f64::to_bits))
}

/// Refuses every block that a question asks for, one at a time and whatever its size. Each time it is answered as without that, or
/// ends in [`Error::Memory`]; asked again of the same it is answered. Returns how often that was; many a question asks for none.
///
/// Integers panicked where they got no memory (48 to 64 bytes, of touching cubes), and lists beside them ended the program: in C
/// that was SWIFTPROX_ERROR_BUG, and a scene was poisoned.
fn refuse_every_block<S>(what: &str, make: impl Fn() -> S, ask: impl Fn(&mut S) -> Result<u64>) -> usize {
    let expected = ask(&mut make()).unwrap();
    let mut refusals = 0;
    for number in 1.. {
        let mut state = make();
        LEAST.set(1);
        let (said, came_to_that) = without(number, false, || ask(&mut state));
        LEAST.set(SMALL);
        match said {
            Ok(answer) => assert_eq!(answer, expected, "{what}, block {number}"),
            Err(Error::Memory(_)) => refusals += 1,
            Err(other) => panic!("{what}, block {number}: {other:?}"),
        }
        assert_eq!(ask(&mut state), Ok(expected), "{what}, after block {number} was refused");
        if !came_to_that {
            break;
        }
    }
    refusals
}

/// The panics that become errors are printed by nobody here.
fn keep_quiet() {
    static ONCE: std::sync::Once = std::sync::Once::new();
    ONCE.call_once(|| {
        let before = std::panic::take_hook();
        std::panic::set_hook(Box::new(move |info| {
            let is_of_integers = info.location().is_some_and(|location| location.file().contains("dashu-int"));
            let message = info.payload().downcast_ref::<&str>();
            if !is_of_integers && message != Some(&"out of memory") {
                before(info);
            }
        }));
    });
}

/// A cube of side 2, turned by an angle whose sine and cosine are no doubles, and another one above it that it just touches.
fn touching() -> [Pose; 2] {
    let turn = Matrix::new(0.8, -0.6, 0.0, 0.6, 0.8, 0.0, 0.0, 0.0, 1.0);
    [Pose::IDENTITY, Pose::new(&turn, &Vector::new(0.0, 0.0, 2.0))]
}

fn said_of_pair(answer: &PairAnswer) -> u64 {
    digest([answer.outcome as u64, bits([answer.lower, answer.distance, answer.upper])])
}

#[test]
fn every_block_of_pairs() {
    keep_quiet();
    let mut refusals = 0;
    let cube = testkit::shapes::cuboid([1.0; 3]);
    let huge = testkit::shapes::cuboid([1e300; 3]);
    let ball = Shape::from_points(
        &[Vector::zeros()],
        &ShapeOptions { input: InputPolicy::Hull, swept_radius: 1.0, ..ShapeOptions::default() },
    )
    .unwrap();
    let poses = touching();
    type Ask = fn([Placed; 2], &mut PairCache, &PairConfig, &mut PairAnswer) -> Result<()>;
    let queries: [(&str, Ask); 4] = [
        ("distance", pair::distance),
        ("intersection", pair::intersection),
        ("contact", pair::contact),
        ("approximate", pair::approximate),
    ];
    for (name, query) in queries {
        for (kind, bodies) in [
            ("cubes", [cube.at(&poses[0]), cube.at(&poses[1])]),
            ("a cube and a huge one", [cube.at(&poses[0]), huge.at(&poses[1])]),
            ("a cube and a ball", [cube.at(&poses[0]), ball.at(&poses[1])]),
        ] {
            let ask = |(cache, answer): &mut (PairCache, PairAnswer)| {
                let before = answer.outcome;
                query(bodies, cache, &PairConfig::default(), answer)
                    .inspect_err(|_| assert_eq!(before, answer.outcome))?;
                Ok(said_of_pair(answer))
            };
            refusals += refuse_every_block(&format!("{name} of {kind}"), Default::default, ask);
        }
    }
    for (kind, bodies) in [
        ("cubes", [cube.at(&poses[0]), cube.at(&poses[1])]),
        ("a cube and a huge one", [cube.at(&poses[0]), huge.at(&poses[1])]),
        ("a cube and a ball", [cube.at(&poses[0]), ball.at(&poses[1])]),
    ] {
        let depth = |cache: &mut DepthCache| {
            let mut answer = DepthAnswer::default();
            pair::depth(bodies, cache, &DepthConfig::default(), &mut answer)?;
            Ok(digest([answer.outcome as u64, u64::from(answer.lower == 0.0)]))
        };
        refusals += refuse_every_block(&format!("the depth of {kind}"), Default::default, depth);
        let signed = |cache: &mut SignedDistanceCache| {
            let mut answer = SignedDistance::default();
            pair::signed_distance(bodies, cache, &PairConfig::default(), &mut answer)?;
            Ok(digest([answer.outcome as u64, u64::from(answer.upper <= 0.0)]))
        };
        refusals += refuse_every_block(&format!("the signed distance of {kind}"), Default::default, signed);
        let manifold = |cache: &mut ManifoldCache| {
            let mut points = [ManifoldPoint::default(); 16];
            let asked = swiftprox::manifold::manifold(bodies, cache, &ManifoldConfig::default(), &mut points);
            if asked.is_err() {
                assert!(points.iter().all(|point| point.id == 0), "points are as they were");
            }
            let found = asked?;
            Ok(digest([found.outcome as u64, u64::from(found.found_count)]))
        };
        refusals += refuse_every_block(&format!("the manifold of {kind}"), Default::default, manifold);
    }
    let above = Pose::new(&poses[1].rotation(), &Vector::new(0.0, 0.0, 1.0));
    for (normal, offset) in [([0.0, 0.0, 1.0], 0.0), ([5e-324; 3], 1e300)] {
        let half_space = HalfSpace { normal, offset };
        let distance = |(): &mut ()| {
            let found = pair::half_space_distance(cube.at(&above), &half_space)?;
            Ok(digest([found.outcome as u64, bits([found.lower, found.distance, found.upper])]))
        };
        refusals += refuse_every_block("a half-space", || (), distance);
        let manifold = |(): &mut ()| {
            let mut points = [ManifoldPoint::default(); 16];
            let config = ManifoldConfig::default();
            let asked = swiftprox::manifold::half_space_manifold(cube.at(&above), &half_space, &config, &mut points);
            if asked.is_err() {
                assert!(points.iter().all(|point| point.id == 0), "points are as they were");
            }
            let found = asked?;
            Ok(digest([found.outcome as u64, u64::from(found.found_count), bits(points.map(|point| point.gap_lower))]))
        };
        refusals += refuse_every_block("the manifold of a half-space", || (), manifold);
    }
    let verified = |(): &mut ()| {
        let bodies = [cube.at(&poses[0]), cube.at(&poses[1])];
        let (mut cache, mut answer) = (PairCache::default(), PairAnswer::default());
        pair::contact(bodies, &mut cache, &PairConfig::default(), &mut answer)?;
        verify(bodies, &answer)?;
        let (mut cache, config) = (ManifoldCache::default(), ManifoldConfig::default());
        let mut points = [ManifoldPoint::default(); 16];
        let found = swiftprox::manifold::manifold(bodies, &mut cache, &config, &mut points)?;
        verify_manifold(bodies, &cache, &config, &found, &points)?;
        let deep = [poses[0], Pose::new(&poses[1].rotation(), &Vector::new(0.3, 0.2, 1.9))];
        let bodies = [cube.at(&deep[0]), cube.at(&deep[1])];
        let (mut cache, mut depth) = (DepthCache::default(), DepthAnswer::default());
        pair::depth(bodies, &mut cache, &DepthConfig::default(), &mut depth)?;
        verify_depth(bodies, &cache, &depth)?;
        let apart = [cube.at(&deep[0]), ball.at(&poses[1])];
        let mut answer = PairAnswer::default();
        pair::distance(apart, &mut PairCache::default(), &PairConfig::default(), &mut answer)?;
        verify(apart, &answer)?;
        Ok(0)
    };
    refusals += refuse_every_block("verified answers", || (), verified);
    assert!(refusals > 100, "{refusals}");
}

#[test]
fn every_block_of_points_rays_casts_and_grounds() {
    keep_quiet();
    let mut refusals = 0;
    let cube = testkit::shapes::cuboid([1.0; 3]);
    let needle = testkit::shapes::cuboid([5e-11, 3e-11, 0.5]);
    let [_, pose] = touching();
    for (body, at) in [(&cube, [0.0, 0.0, 3.0]), (&cube, [0.1, 0.2, 3.0]), (&needle, [0.0, 0.0, 2.1])] {
        let locate = |(): &mut ()| {
            let answer = locate_point(body.at(&pose), at)?;
            Ok(digest([answer.location as u64, bits([answer.lower, answer.distance, answer.upper])]))
        };
        refusals += refuse_every_block("a point", || (), locate);
    }
    let huge = testkit::shapes::cuboid([1e300; 3]);
    for (body, origin, direction) in [
        (&cube, [1.0, 1.0, -5.0], [0.0, 0.0, 1.0]),
        (&cube, [0.0, -9.0, 1.0], [0.0, 1.0, 0.0]),
        (&huge, [0.0, 0.0, -1.5e300], [0.0, 0.0, 1e300]),
    ] {
        let cast = |(): &mut ()| {
            let ray = Ray { origin, direction, t_max: f64::INFINITY };
            let answer = cast_ray(body.at(&Pose::IDENTITY), &ray)?;
            Ok(digest([answer.outcome as u64, bits(answer.entry), bits(answer.exit)]))
        };
        refusals += refuse_every_block("a ray", || (), cast);
    }
    let start = Pose::new(&pose.rotation(), &Vector::new(0.0, 0.0, 5.0));
    let moves =
        |height: f64| Motion::Affine { start, end: Pose::new(&pose.rotation(), &Vector::new(0.0, 0.0, height)) };
    for height in [0.0, 2.0] {
        let motions = [Motion::Fixed(Pose::IDENTITY), moves(height)];
        let bodies = || [0, 1].map(|i| Moving { shape: &cube, motion: &motions[i] });
        let cast = |cache: &mut PairCache| {
            let (config, mut answer) = (CastConfig::default(), CastAnswer::default());
            motion::cast(bodies(), cache, &config, &mut answer)?;
            verify_cast(bodies(), &config, &answer)?;
            Ok(answer.outcome as u64)
        };
        refusals += refuse_every_block("a cast", PairCache::default, cast);
        let clearance = |cache: &mut PairCache| {
            let mut answer = Clearance::default();
            motion::clearance(bodies(), cache, &ClearanceConfig::default(), &mut answer)?;
            Ok(u64::from(answer.upper > 0.0))
        };
        refusals += refuse_every_block("a clearance", PairCache::default, clearance);
    }
    let heights = [0.0; 4];
    let grid = HeightGrid { rows: 2, columns: 2, spacing: [1.0; 2], heights: &heights };
    let ground = Ground::from_heights(&grid).unwrap();
    let rests = Pose::new(&pose.rotation(), &Vector::new(0.5, 0.5, 1.0));
    let contacts = |found: &mut GroundContacts| {
        ground_contacts(cube.at(&rests), ground.at(&Pose::IDENTITY), &ManifoldConfig::default(), found)?;
        Ok(digest([found.contacts.len() as u64, found.points.len() as u64]))
    };
    refusals += refuse_every_block("contacts on a ground", GroundContacts::default, contacts);
    let distance = |(): &mut ()| {
        let config = PairConfig::default();
        let found = ground_distance(pair::Query::Distance, cube.at(&rests), ground.at(&Pose::IDENTITY), &config)?;
        Ok(said_of_pair(&found.answer))
    };
    refusals += refuse_every_block("the distance of a ground", || (), distance);
    assert!(refusals > 20, "{refusals}");
}

/// A scene lives on, and answers the same.
#[test]
fn every_block_of_scenes() {
    keep_quiet();
    let mut refusals = 0;
    let cube = Arc::new(testkit::shapes::cuboid([1.0; 3]));
    let make = || {
        let mut scene = Scene::new();
        let ids = touching().map(|pose| {
            scene.add_object(vec![cube.clone()], &ObjectOptions { pose, ..ObjectOptions::default() }).unwrap()
        });
        (scene, ids, SetScratch::default())
    };
    type World = (Scene, [ObjectId; 2], SetScratch);
    type Query = for<'a> fn(&'a mut Scene, &SceneQuery) -> Result<swiftprox::scene::SceneAnswer<'a>>;
    let queries: [(&str, Query); 4] = [
        ("intersection", Scene::query_intersection),
        ("distance", Scene::query_distance),
        ("contact", Scene::query_contact),
        ("approximate", Scene::query_approximate),
    ];
    for (name, query) in queries {
        for detail in [ContactDetail::None, ContactDetail::Depth, ContactDetail::Manifold] {
            if detail != ContactDetail::None && name != "contact" {
                continue;
            }
            let ask = |(scene, ..): &mut World| {
                let said = query(scene, &SceneQuery { detail, ..SceneQuery::default() })?;
                let points = said.contacts.points.len() as u64;
                Ok(digest(said.pairs.iter().map(|pair| said_of_pair(&pair.answer)).chain([points])))
            };
            refusals += refuse_every_block(&format!("{name} in a scene, {detail:?}"), make, ask);
        }
    }
    let prepared = || {
        let mut world = make();
        world.0.prepare().unwrap();
        world
    };
    let ask_ray = |(scene, _, scratch): &mut World| {
        let ray = Ray { origin: [1.0, 1.0, -5.0], direction: [0.0, 0.0, 1.0], t_max: f64::INFINITY };
        let hits = scene.cast_ray(&ray, RayHits::All, u32::MAX, scratch)?;
        Ok(digest(hits.iter().map(|hit| bits(hit.answer.entry))))
    };
    refusals += refuse_every_block("a ray in a scene", prepared, ask_ray);
    let config = ManifoldConfig::default();
    let ask_half_space = |(scene, _, scratch): &mut World| {
        let half_space = HalfSpace { normal: [0.0, 0.0, 1.0], offset: -1.0 };
        let found = scene.half_space_contacts(None, &half_space, &config, GroupFilter::default(), scratch)?;
        Ok(digest([found.contacts.len() as u64, found.points.len() as u64]))
    };
    refusals += refuse_every_block("a half-space in a scene", prepared, ask_half_space);
    let heights = [-1.0; 4];
    let grid = HeightGrid { rows: 2, columns: 2, spacing: [1.0; 2], heights: &heights };
    let ground = Ground::from_heights(&grid).unwrap();
    let ask_ground = |(scene, _, scratch): &mut World| {
        let placed = ground.at(&Pose::IDENTITY);
        let found = scene.ground_contacts(None, placed, &config, GroupFilter::default(), scratch)?;
        Ok(digest([found.contacts.len() as u64, found.points.len() as u64]))
    };
    refusals += refuse_every_block("a ground in a scene", prepared, ask_ground);
    let ask_least = |(scene, ids, scratch): &mut World| {
        let set = ObjectSet { ids: &ids[..1], ..ObjectSet::default() };
        let found = scene.least_distance(&set, None, f64::INFINITY, scratch)?;
        Ok(bits([found.lower, found.upper]))
    };
    refusals += refuse_every_block("the least distance of a set", prepared, ask_least);
    let ask_hit = |(scene, ids, scratch): &mut World| {
        let set = ObjectSet { ids: &ids[..1], ..ObjectSet::default() };
        let poses = [Pose::IDENTITY];
        let found = scene.first_hit(&set, &poses, PoseOrder::InOrder, 0.0, scratch)?;
        Ok(found.time as u64)
    };
    refusals += refuse_every_block("a first hit of a set", prepared, ask_hit);
    let ask_cast = |(scene, ids, scratch): &mut World| {
        let set = ObjectSet { ids: &ids[1..], ..ObjectSet::default() };
        let [_, pose] = touching();
        let start = Pose::new(&pose.rotation(), &Vector::new(0.0, 0.0, 5.0));
        let found = scene.cast(&set, &[Motion::Affine { start, end: pose }], &CastConfig::default(), scratch)?;
        Ok(found.outcome as u64)
    };
    refusals += refuse_every_block("a cast of a set", prepared, ask_cast);
    assert!(refusals > 20, "{refusals}");
}

/// What `docs/conventions.md` says of the blocks that may end the program.
#[test]
fn records_are_no_larger_than_the_page_says() {
    let sizes = [
        ("Shape", size_of::<Shape>()),
        ("Scene", size_of::<Scene>()),
        ("SetScratch", size_of::<SetScratch>()),
        ("Ground", size_of::<Ground>()),
        ("Workers", size_of::<Workers>()),
    ];
    assert!(sizes.iter().all(|(_, size)| *size <= 5120), "{sizes:?}");
}
