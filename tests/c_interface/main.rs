//! The C functions as C calls them, where Rust can look behind them: struct sizes, shares of shapes, messages by thread, the log,
//! any bytes in what a caller hands in. Bad input in general is `c_tests/process/bad_input.c`, which runs under valgrind, too.

#![allow(unsafe_code, reason = "the C functions are unsafe to call")]

mod failures;
mod levels;

use std::ffi::CStr;
use std::mem::MaybeUninit;
use std::ptr::{null, null_mut};

use swiftprox::ffi::StatusCode;
use swiftprox::ffi::allocator::swiftprox_library_set_allocator;
use swiftprox::ffi::arrays::CMesh;
use swiftprox::ffi::library::*;
use swiftprox::ffi::object::*;
use swiftprox::ffi::pair::*;
use swiftprox::ffi::query::*;
use swiftprox::ffi::scene::*;
use swiftprox::ffi::shape::*;
use swiftprox::ffi::shape_options::*;
use swiftprox::ffi::tuning::*;
use swiftprox::object::ObjectId;
use swiftprox::pair::{DecidedBy, FeatureKind, Outcome, PairAnswer};
use swiftprox::shape::Shape;
use testkit::random::Random;

const CORNERS: [f64; 12] = [0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0];
const FACES: [u32; 12] = [0, 2, 1, 0, 1, 3, 1, 2, 3, 0, 3, 2];

fn last_message() -> String {
    // SAFETY: never null, terminated, unchanged until the next failure of this thread.
    unsafe { CStr::from_ptr(swiftprox_library_last_error_message()) }.to_string_lossy().into_owned()
}

/// A tetrahedron with one share, the caller's.
fn tetrahedron() -> *const Shape {
    let mut shape = null();
    let mesh =
        CMesh { vertices: CORNERS.as_ptr(), vertex_count: 4, indices: FACES.as_ptr(), valences: null(), face_count: 4 };
    // SAFETY: arrays of the sizes that are given, and room for the shape.
    let status = unsafe { swiftprox_shape_create_from_mesh(mesh, null(), &mut shape) };
    assert_eq!(status, StatusCode::Ok, "{}", last_message());
    shape
}

fn pair_config() -> CPairConfig {
    CPairConfig::DEFAULT
}

fn shape_options() -> CShapeOptions {
    CShapeOptions::DEFAULT
}

fn shape_tuning() -> CShapeTuning {
    CShapeTuning::DEFAULT
}

/// A shape where it is.
fn placed(shape: *const Shape, pose: &[f64; 12]) -> CPlaced {
    CPlaced { shape, pose: pose.as_ptr() }
}

fn release(shape: *const Shape) {
    // SAFETY: a living shape whose share is given up.
    unsafe { swiftprox_shape_release(shape) };
}

/// The identity moved along x.
fn moved(x: f64) -> [f64; 12] {
    [1.0, 0.0, 0.0, x, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0]
}

/// The distance of a tetrahedron and its copy moved by 3 along x, which is 2.
fn distance(shape: *const Shape, cache: &mut CPairCache, config: *const CPairConfig) -> (StatusCode, PairAnswer) {
    // Bytes that no answer has, as C leaves them.
    let mut answer = MaybeUninit::<PairAnswer>::uninit();
    // SAFETY: every pointer is valid; what the answer holds is not looked at before it is written.
    unsafe {
        answer.as_mut_ptr().cast::<u8>().write_bytes(0xa5, size_of::<PairAnswer>());
        let poses = [moved(0.0), moved(3.0)];
        let status = swiftprox_pair_distance(
            placed(shape, &poses[0]),
            placed(shape, &poses[1]),
            cache,
            config,
            answer.as_mut_ptr(),
        );
        (status, answer.assume_init())
    }
}

#[test]
fn a_pair_is_answered_whatever_is_in_the_cache_and_the_answer() {
    let shape = tetrahedron();
    let mut random = Random::new(1);
    for round in 0..2000 {
        let mut cache = CPairCache::default();
        for word in &mut cache.words {
            // Small words now and then, which look like indices.
            *word = random.next_u64() as u32 >> (round % 32);
        }
        let (status, answer) = distance(shape, &mut cache, null());
        assert_eq!(status, StatusCode::Ok, "{}", last_message());
        assert_eq!(answer.outcome, Outcome::Separated);
        assert!(answer.lower <= 2.0 && 2.0 <= answer.upper, "{answer:?}");
    }
    release(shape);
}

/// A config of this library with what a newer header has behind it.
#[repr(C)]
struct Newer {
    known: CPairConfig,
    unknown: [u8; 16],
}

#[test]
fn a_struct_may_be_of_a_newer_header_as_long_as_it_asks_for_nothing_new() {
    let shape = tetrahedron();
    let known = CPairConfig { struct_size: size_of::<Newer>(), ..CPairConfig::DEFAULT };
    let mut newer = Newer { known, unknown: [0; 16] };
    newer.known.max_distance = 1.0;
    let (status, answer) = distance(shape, &mut CPairCache::default(), (&raw const newer).cast());
    assert_eq!((status, answer.outcome), (StatusCode::Ok, Outcome::Beyond), "{}", last_message());

    newer.unknown[5] = 1;
    let (status, answer) = distance(shape, &mut CPairCache::default(), (&raw const newer).cast());
    assert_eq!((status, answer.outcome), (StatusCode::ErrorStructSize, Outcome::None));
    assert!(last_message().contains("swiftprox_pair_config"), "{}", last_message());

    for size in [0, 8, 15, 1 << 20, usize::MAX] {
        let config = CPairConfig { struct_size: size, ..pair_config() };
        let (status, _) = distance(shape, &mut CPairCache::default(), &config);
        assert_eq!(status, StatusCode::ErrorStructSize, "{size}");
    }
    release(shape);
}

/// Structs of an older header end earlier. Behind them stands what is the program's own.
#[test]
fn a_struct_of_an_older_header_is_read_and_written_as_far_as_it_goes() {
    #[repr(C)]
    struct Older {
        struct_size: usize,
        max_distance: f64,
        own: [u64; 16],
    }
    const OWN: [u64; 16] = [0xa5a5_a5a5_a5a5_a5a5; 16];
    const SIZE: usize = std::mem::offset_of!(Older, own);
    let shape = tetrahedron();
    let mut older = Older { struct_size: SIZE, max_distance: f64::INFINITY, own: OWN };
    let ask = |older: &Older| distance(shape, &mut CPairCache::default(), (&raw const *older).cast());
    assert_eq!(ask(&older).1.outcome, Outcome::Separated, "{}", last_message());
    older.max_distance = 1.0;
    assert_eq!(ask(&older).1.outcome, Outcome::Beyond, "{}", last_message());

    #[repr(C)]
    struct OlderInfo {
        struct_size: usize,
        dimension: i32,
        vertex_count: usize,
        own: [u64; 32],
    }
    let mut info =
        OlderInfo { struct_size: std::mem::offset_of!(OlderInfo, own), dimension: 7, vertex_count: 7, own: [9; 32] };
    // SAFETY: as much room as is said.
    let status = unsafe { swiftprox_shape_get_info(shape, (&raw mut info).cast()) };
    assert_eq!(status, StatusCode::Ok, "{}", last_message());
    assert_eq!((info.dimension, info.vertex_count, info.own), (3, 4, [9; 32]));

    // A newer info: what this library does not know is 0, whatever was there.
    let mut newer = [u64::MAX; 64];
    newer[0] = 8 * 40;
    // SAFETY: as above.
    let status = unsafe { swiftprox_shape_get_info(shape, newer.as_mut_ptr().cast()) };
    assert_eq!(status, StatusCode::Ok, "{}", last_message());
    let known = size_of::<ShapeInfo>() / 8;
    assert_eq!(newer[2], 4);
    assert!(newer[known..40].iter().all(|&word| word == 0) && newer[40..].iter().all(|&word| word == u64::MAX));
    release(shape);
}

#[test]
fn unknown_enumerators_are_refused() {
    let shape = tetrahedron();
    let mut tuning: CPairTuning = CPairTuning::DEFAULT;
    let config = |tuning: &CPairTuning| CPairConfig { tuning, ..pair_config() };
    assert_eq!(distance(shape, &mut CPairCache::default(), &config(&tuning)).0, StatusCode::Ok, "{}", last_message());
    tuning.levels = 3;
    assert_eq!(distance(shape, &mut CPairCache::default(), &config(&tuning)).0, StatusCode::ErrorInvalidArgument);
    assert!(last_message().contains("tuning->levels is 3"), "{}", last_message());
    // SAFETY: every pointer is valid; the answer is written as bytes and never read here.
    unsafe {
        let (_, answer) = distance(shape, &mut CPairCache::default(), null());
        let poses = [moved(0.0), moved(3.0)];
        let verify = |answer| swiftprox_pair_verify(placed(shape, &poses[0]), placed(shape, &poses[1]), answer);
        assert_eq!(verify(&answer), StatusCode::Ok, "{}", last_message());
        for member in [std::mem::offset_of!(PairAnswer, outcome), std::mem::offset_of!(PairAnswer, decided_by)] {
            let mut changed = MaybeUninit::new(answer);
            changed.as_mut_ptr().cast::<u8>().add(member).cast::<i32>().write(-1);
            assert_eq!(verify(changed.as_ptr()), StatusCode::ErrorInvalidArgument);
        }
        let wrong = PairAnswer { lower: 2.5, distance: 2.5, upper: 2.5, ..answer };
        assert_eq!(verify(&wrong), StatusCode::ErrorUnverified);

        let options = CShapeOptions { input: 5, ..shape_options() };
        let mut made = shape;
        let status = swiftprox_shape_create_from_points(CORNERS.as_ptr(), 4, &options, &mut made);
        assert_eq!(status, StatusCode::ErrorInvalidArgument);
        assert!(made.is_null());

        for face_noise in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
            let options = CShapeOptions { face_noise, ..shape_options() };
            let status = swiftprox_shape_create_from_points(CORNERS.as_ptr(), 4, &options, &mut made);
            assert_eq!(status, StatusCode::ErrorInvalidArgument);
            assert!(made.is_null() && last_message().contains("options->face_noise"), "{}", last_message());
        }
    }
    release(shape);
}

/// Of objects beyond the tolerance every query says the same things, and what it says holds.
#[test]
fn an_answer_beyond_the_tolerance_says_what_is_documented() {
    let shape = tetrahedron();
    let queries =
        [swiftprox_pair_distance, swiftprox_pair_intersection, swiftprox_pair_contact, swiftprox_pair_approximate];
    let mut deciders = Vec::new();
    for (x, tolerance) in
        [(3.0, 1.0), (3.0, 1.999_999), (1.3, 0.1), (1.3, 0.3_f64.next_down()), (50.0, 0.0), (1.001, 0.0)]
    {
        let config = CPairConfig { max_distance: tolerance, ..pair_config() };
        let (here, there) = (moved(0.0), moved(x));
        for query in queries {
            let mut cache = CPairCache::default();
            for _warm in 0..2 {
                let mut answer = PairAnswer::default();
                // SAFETY: every pointer is valid.
                unsafe {
                    let status = query(placed(shape, &here), placed(shape, &there), &mut cache, &config, &mut answer);
                    assert_eq!((status, answer.outcome), (StatusCode::Ok, Outcome::Beyond), "{x}: {}", last_message());
                    let status = swiftprox_pair_verify(placed(shape, &here), placed(shape, &there), &answer);
                    assert_eq!(status, StatusCode::Ok, "{}", last_message());
                }
                assert!(answer.lower >= tolerance && answer.lower <= x - 1.0, "{answer:?}");
                assert_eq!((answer.distance, answer.upper), (answer.lower, f64::INFINITY));
                let length: f64 = answer.normal.iter().map(|c| c * c).sum();
                assert!((length - 1.0).abs() < 1e-15, "{answer:?}");
                let points = [answer.local1, answer.local2, answer.world1, answer.world2];
                assert!(points.as_flattened().iter().all(|c| c.is_nan()) && answer.proof_count == 0, "{answer:?}");
                assert_eq!([answer.feature1.kind, answer.feature2.kind], [FeatureKind::None; 2]);
                deciders.push(answer.decided_by);
            }
        }
    }
    assert!(deciders.contains(&DecidedBy::Marching) && deciders.contains(&DecidedBy::BoundingSpheres), "{deciders:?}");
    release(shape);
}

#[test]
fn info_is_cut_to_the_size_that_the_caller_has() {
    let shape = tetrahedron();
    // SAFETY: every pointer is valid; the info is all zero first.
    unsafe {
        let mut info = MaybeUninit::<ShapeInfo>::zeroed().assume_init();
        assert_eq!(swiftprox_shape_get_info(shape, &mut info), StatusCode::ErrorStructSize);
        info.struct_size = size_of::<ShapeInfo>();
        assert_eq!(swiftprox_shape_get_info(shape, &mut info), StatusCode::Ok, "{}", last_message());
        assert_eq!((info.dimension, info.vertex_count, info.edge_count), (3, 4, 6));
        assert_eq!((info.face_count, info.triangle_count), (4, 4));
        assert!((info.volume - 1.0 / 6.0).abs() < 1e-15 && info.bytes > 1000, "{info:?}");
        assert_eq!((info.lower_corner, info.upper_corner), ([0.0; 3], [1.0; 3]));

        let (mut vertices, mut labels, mut corners) = ([f64::NAN; 12], [9; 4], [9; 12]);
        let status = swiftprox_shape_copy_vertices(shape, vertices.as_mut_ptr(), labels.as_mut_ptr(), 4);
        assert_eq!(status, StatusCode::Ok);
        for (vertex, &label) in vertices.chunks(3).zip(&labels) {
            assert_eq!(vertex, &CORNERS[3 * label as usize..][..3]);
        }
        assert_eq!(swiftprox_shape_copy_triangles(shape, corners.as_mut_ptr(), 4), StatusCode::Ok);
        assert!(corners.iter().all(|&corner| corner < 4));
        let status = swiftprox_shape_copy_triangles(shape, corners.as_mut_ptr(), 3);
        assert_eq!(status, StatusCode::ErrorInvalidArgument);
    }
    release(shape);
}

#[test]
fn a_scene_holds_shares_of_its_own() {
    let shape = tetrahedron();
    // SAFETY: every pointer is valid, and the scene is used by this thread only.
    unsafe {
        let mut scene = null_mut();
        assert_eq!(swiftprox_scene_create(null(), &mut scene), StatusCode::Ok);
        let mut options: CObjectOptions = CObjectOptions::DEFAULT;
        let mut ids = [ObjectId::NULL; 2];
        for (i, id) in ids.iter_mut().enumerate() {
            options.user_data = 10 + i as u64;
            options.pose = moved(3.0 * i as f64);
            let pieces = [shape; 2];
            assert_eq!(swiftprox_scene_add_object(scene, pieces.as_ptr(), 2, &options, id), StatusCode::Ok);
        }
        // The scene's shares outlive the caller's.
        release(shape);
        let mut answer = MaybeUninit::<CSceneAnswer>::uninit();
        assert_eq!(swiftprox_scene_query_distance(scene, null(), answer.as_mut_ptr()), StatusCode::Ok);
        let answer = answer.assume_init();
        assert_eq!((answer.count, answer.intersecting), (4, 0));
        for (k, pair) in std::slice::from_raw_parts(answer.pairs, answer.count).iter().enumerate() {
            assert_eq!([pair.object1, pair.object2], ids);
            assert_eq!([pair.user_data1, pair.user_data2], [10, 11]);
            assert_eq!([pair.piece1, pair.piece2], [k as u32 / 2, k as u32 % 2]);
            assert!(pair.answer.lower <= 2.0 && 2.0 <= pair.answer.upper, "{pair:?}");
        }

        let mut piece = null();
        assert_eq!(swiftprox_scene_get_piece(scene, ids[0], 1, &mut piece), StatusCode::Ok);
        assert_eq!(piece, shape);
        assert_eq!(swiftprox_shape_retain(piece), piece);
        assert_eq!(swiftprox_scene_destroy(scene), StatusCode::Ok);
        // And the caller's share outlives the scene.
        assert_eq!(distance(piece, &mut CPairCache::default(), null()).0, StatusCode::Ok);
        release(piece);
    }
}

/// The C libraries' allocator is tested by c_tests/process/allocator.c.
#[test]
#[cfg(not(feature = "allocator"))]
fn a_rust_program_keeps_its_allocator() {
    assert_eq!(swiftprox_library_set_allocator(None, None, null_mut()), StatusCode::ErrorUnsupported);
    assert!(last_message().contains("feature `allocator`"));
}
