//! What a scene needs of memory: bytes an object and bytes a near pair, beside results. `docs/scenes.md` has them.

// GlobalAlloc is an unsafe trait.
#![allow(unsafe_code)]

use std::alloc::{GlobalAlloc, Layout, System};
use std::cell::Cell;
use std::sync::Arc;

use swiftprox::ground::{Ground, HeightGrid};
use swiftprox::math::{Matrix, Pose, Vector};
use swiftprox::object::ObjectOptions;
use swiftprox::scene::{PairResult, Scene, SceneQuery};
use testkit::shapes::cuboid;

thread_local! {
    /// Bytes that were given and not yet given back.
    static BYTES: Cell<isize> = const { Cell::new(0) };
}

fn count(bytes: isize) {
    BYTES.set(BYTES.get() + bytes);
}

struct Weighing;

// SAFETY: every call is handed to the system's allocator unchanged; the counter neither allocates nor has a destructor.
unsafe impl GlobalAlloc for Weighing {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        count(layout.size() as isize);
        // SAFETY: the caller's promise, passed on.
        unsafe { System.alloc(layout) }
    }

    unsafe fn dealloc(&self, pointer: *mut u8, layout: Layout) {
        count(-(layout.size() as isize));
        // SAFETY: the caller's promise, passed on; `alloc` and `realloc` hand out the system's pointers.
        unsafe { System.dealloc(pointer, layout) }
    }

    unsafe fn realloc(&self, pointer: *mut u8, layout: Layout, size: usize) -> *mut u8 {
        count(size as isize - layout.size() as isize);
        // SAFETY: as for `dealloc`.
        unsafe { System.realloc(pointer, layout, size) }
    }
}

#[global_allocator]
static ALLOCATOR: Weighing = Weighing;

/// Bytes of a scene of boxes of side 1 in a cubic lattice, all of which have moved, after queries; and how many pairs these listed.
/// Between neighbours is so much room.
fn scene_bytes(side: usize, room: f64) -> (usize, usize) {
    let shape = Arc::new(cuboid([0.5; 3]));
    let before = BYTES.get();
    let mut scene = Scene::new();
    let pose = |k: usize, step: f64| {
        let place = [k % side, k / side % side, k / (side * side)].map(|i| (1.0 + room) * i as f64 + step);
        Pose::new(&Matrix::identity(), &Vector::from(place))
    };
    let mut ids = Vec::new();
    for k in 0..side * side * side {
        let options = ObjectOptions { pose: pose(k, 0.0), ..ObjectOptions::default() };
        ids.push(scene.add_object(vec![shape.clone()], &options).unwrap());
    }
    let query = SceneQuery { max_distance: 0.25, ..SceneQuery::default() };
    let mut listed = 0;
    for step in 0..4 {
        for (k, id) in ids.iter().enumerate() {
            scene.set_pose(*id, &pose(k, 1e-3 * f64::from(step))).unwrap();
        }
        listed = scene.query_distance(&query).unwrap().pairs.len();
    }
    let bytes = BYTES.get() - before - (ids.capacity() * size_of_val(&ids[0])) as isize;
    (bytes as usize, listed)
}

/// What vectors have left for growth is counted, as it is memory; results are not.
#[test]
#[cfg_attr(miri, ignore = "long")]
fn objects_and_near_pairs_are_small() {
    let side = 22;
    let objects = side * side * side;
    let (apart, none) = scene_bytes(side, 4.0);
    assert_eq!(none, 0);
    let (together, pairs) = scene_bytes(side, 0.1);
    assert!(pairs > 11 * objects, "{pairs} of {objects}");
    let of_object = apart / objects;
    let results = pairs * size_of::<PairResult>();
    let of_pair = (together - apart).saturating_sub(results) / pairs;
    println!(
        "{objects} objects: {of_object} B an object, {of_pair} B a near pair and {} B a result",
        size_of::<PairResult>()
    );
    assert!(of_object <= MOST_OF_OBJECT && of_pair <= MOST_OF_PAIR, "{of_object} {of_pair}");
}

/// Bytes an object, its share of the trees and the grid included.
const MOST_OF_OBJECT: usize = 380;

/// Bytes a near pair, with what it remembers.
const MOST_OF_PAIR: usize = 200;

/// An object shares its ground: what it takes does not depend on the triangles. `docs/grounds.md` has the number.
#[test]
fn a_ground_is_shared() {
    let bytes = |side: usize| {
        let heights = vec![0.0; side * side];
        let grid = HeightGrid { rows: side, columns: side, spacing: [1.0; 2], heights: &heights };
        let ground = Arc::new(Ground::from_heights(&grid).unwrap());
        let mut scene = Scene::new();
        let before = BYTES.get();
        scene.add_ground(ground.clone(), &ObjectOptions::default()).unwrap();
        BYTES.get() - before
    };
    let [small, large] = [3, 150].map(bytes);
    println!("{small} bytes");
    assert_eq!(small, large);
    // Most of it is the box that stands for it, a shape.
    assert!(small < 8_500, "{small}");
}
