//! The C functions as C calls them, where Rust can look behind them: struct sizes, shares of shapes, messages by thread, the log,
//! any bytes in what a caller hands in. Bad input in general is `c_tests/bad_input.c`, which runs under valgrind, too.

#![allow(unsafe_code, reason = "the C functions are unsafe to call")]

use std::ffi::{CStr, c_char, c_void};
use std::mem::MaybeUninit;
use std::ptr::{null, null_mut};
use std::sync::Mutex;

use swiftprox::ffi::StatusCode;
use swiftprox::ffi::allocator::swiftprox_library_set_allocator;
use swiftprox::ffi::level::*;
use swiftprox::ffi::library::*;
use swiftprox::ffi::object::*;
use swiftprox::ffi::pair::*;
use swiftprox::ffi::query::*;
use swiftprox::ffi::scene::*;
use swiftprox::ffi::shape::*;
use swiftprox::ffi::shape_options::*;
use swiftprox::ffi::tuning::*;
use swiftprox::hierarchy::HierarchyKind;
use swiftprox::math::Vector;
use swiftprox::object::ObjectId;
use swiftprox::pair::{DecidedBy, FeatureKind, Outcome, PairAnswer};
use swiftprox::scene::SceneStatistics;
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
    // SAFETY: arrays of the sizes that are given, and room for the shape.
    let status =
        unsafe { swiftprox_shape_create_from_mesh(CORNERS.as_ptr(), 4, FACES.as_ptr(), null(), 4, null(), &mut shape) };
    assert_eq!(status, StatusCode::Ok, "{}", last_message());
    shape
}

/// A struct as its `_init` macro fills it: with the size that the program knows.
fn initialised<T>(init: unsafe extern "C" fn(*mut T, usize)) -> T {
    let mut value = MaybeUninit::<T>::uninit();
    // SAFETY: room for the struct; any bytes are a valid one.
    unsafe {
        init(value.as_mut_ptr(), size_of::<T>());
        value.assume_init()
    }
}

fn pair_config() -> CPairConfig {
    initialised(swiftprox_pair_config_init_sized)
}

fn shape_options() -> CShapeOptions {
    initialised(swiftprox_shape_options_init_sized)
}

fn shape_tuning() -> CShapeTuning {
    initialised(swiftprox_shape_tuning_init_sized)
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
            shape,
            poses[0].as_ptr(),
            shape,
            poses[1].as_ptr(),
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
    let mut newer = MaybeUninit::<Newer>::uninit();
    // SAFETY: room for the struct; all of it is written.
    let mut newer = unsafe {
        newer.as_mut_ptr().cast::<u8>().write_bytes(7, size_of::<Newer>());
        swiftprox_pair_config_init_sized(newer.as_mut_ptr().cast(), size_of::<Newer>());
        newer.assume_init()
    };
    assert_eq!((newer.known.struct_size, newer.unknown), (size_of::<Newer>(), [0; 16]));
    newer.known.distance_tolerance = 1.0;
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
        distance_tolerance: f64,
        own: [u64; 16],
    }
    const OWN: [u64; 16] = [0xa5a5_a5a5_a5a5_a5a5; 16];
    const SIZE: usize = std::mem::offset_of!(Older, own);
    let shape = tetrahedron();
    let mut older = Older { struct_size: 0, distance_tolerance: 0.0, own: OWN };
    // SAFETY: as much room as is said.
    unsafe { swiftprox_pair_config_init_sized((&raw mut older).cast(), SIZE) };
    assert_eq!((older.struct_size, older.distance_tolerance, older.own), (SIZE, f64::INFINITY, OWN));
    let ask = |older: &Older| distance(shape, &mut CPairCache::default(), (&raw const *older).cast());
    assert_eq!(ask(&older).1.outcome, Outcome::Separated, "{}", last_message());
    older.distance_tolerance = 1.0;
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
    let mut tuning: CPairTuning = initialised(swiftprox_pair_tuning_init_sized);
    let config = |tuning: &CPairTuning| CPairConfig { tuning, ..pair_config() };
    assert_eq!(distance(shape, &mut CPairCache::default(), &config(&tuning)).0, StatusCode::Ok, "{}", last_message());
    tuning.levels = 3;
    assert_eq!(distance(shape, &mut CPairCache::default(), &config(&tuning)).0, StatusCode::ErrorInvalidArgument);
    assert!(last_message().contains("tuning->levels is 3"), "{}", last_message());
    // SAFETY: every pointer is valid; the answer is written as bytes and never read here.
    unsafe {
        let (_, answer) = distance(shape, &mut CPairCache::default(), null());
        let poses = [moved(0.0), moved(3.0)];
        let verify = |answer| swiftprox_pair_verify(shape, poses[0].as_ptr(), shape, poses[1].as_ptr(), answer);
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
        let config = CPairConfig { distance_tolerance: tolerance, ..pair_config() };
        let (here, there) = (moved(0.0), moved(x));
        for query in queries {
            let mut cache = CPairCache::default();
            for _warm in 0..2 {
                let mut answer = PairAnswer::default();
                // SAFETY: every pointer is valid.
                unsafe {
                    let status = query(shape, here.as_ptr(), shape, there.as_ptr(), &mut cache, &config, &mut answer);
                    assert_eq!((status, answer.outcome), (StatusCode::Ok, Outcome::Beyond), "{x}: {}", last_message());
                    let status = swiftprox_pair_verify(shape, here.as_ptr(), shape, there.as_ptr(), &answer);
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

/// How far the callback below was told that a build is, and when it is to stop.
struct Told {
    reports: usize,
    last: f64,
    stop_after: usize,
}

unsafe extern "C-unwind" fn tell(user: *mut c_void, fraction: f64) -> i32 {
    // SAFETY: the test passes a Told that nobody else uses meanwhile.
    let told = unsafe { &mut *user.cast::<Told>() };
    assert!(fraction >= told.last);
    (told.reports, told.last) = (told.reports + 1, fraction);
    i32::from(told.reports > told.stop_after)
}

/// Points on a sphere, along a spiral.
fn many_points() -> Vec<f64> {
    let point = |i: i32| {
        let (z, angle) = (1.0 - f64::from(2 * i + 1) / 400.0, 2.4 * f64::from(i));
        let r = (1.0 - z * z).sqrt();
        [r * angle.cos(), r * angle.sin(), z]
    };
    (0..400).flat_map(point).collect()
}

#[test]
fn levels_are_built_counted_and_read_back() {
    let points = many_points();
    // SAFETY: every pointer is valid; the options are initialised, the infos all zero first.
    unsafe {
        let tuning = CShapeTuning { hierarchy: HierarchyKind::Quadric as i32, ..shape_tuning() };
        let mut options = CShapeOptions { tuning: &tuning, ..shape_options() };
        let mut told = Told { reports: 0, last: 0.0, stop_after: usize::MAX };
        options.progress = Some(tell);
        options.progress_user = (&raw mut told).cast();
        let mut shape = null();
        let status = swiftprox_shape_create_from_points(points.as_ptr(), 400, &options, &mut shape);
        assert_eq!(status, StatusCode::Ok, "{}", last_message());
        assert!(told.reports > 4 && told.last == 1.0, "{}", told.reports);

        let mut info = MaybeUninit::<ShapeInfo>::zeroed().assume_init();
        info.struct_size = size_of::<ShapeInfo>();
        assert_eq!(swiftprox_shape_get_info(shape, &mut info), StatusCode::Ok);
        let mut has = MaybeUninit::<TuningInfo>::zeroed().assume_init();
        has.struct_size = size_of::<TuningInfo>();
        assert_eq!(swiftprox_shape_get_tuning_info(shape, &mut has), StatusCode::Ok);
        assert_eq!((has.hierarchy, has.level_count), (HierarchyKind::Quadric as i32, 1));
        let mut level = MaybeUninit::<LevelInfo>::zeroed().assume_init();
        assert_eq!(swiftprox_shape_get_level_info(shape, 0, &mut level), StatusCode::ErrorStructSize);
        level.struct_size = size_of::<LevelInfo>();
        assert_eq!(swiftprox_shape_get_level_info(shape, 0, &mut level), StatusCode::Ok);
        assert_eq!((level.vertex_count, level.triangle_count, level.deviation), (400, 796, 0.0));
        assert_eq!(swiftprox_shape_get_level_info(shape, 1, &mut level), StatusCode::Ok);
        assert!((50..200).contains(&level.triangle_count) && level.deviation > 0.0 && level.deviation < 0.3);
        assert_eq!(level.bytes, has.level_bytes);
        assert!(info.bytes > has.level_bytes);
        let mut none = level;
        assert_eq!(swiftprox_shape_get_level_info(shape, 2, &mut none), StatusCode::ErrorInvalidArgument);
        assert!(last_message().contains("no level 2"), "{}", last_message());

        // The level holds the points and is read back as it is; given back as a level of the same body it stays as it is, nearly.
        let (count, triangles) = (level.vertex_count, level.triangle_count);
        let (mut vertices, mut corners) = (vec![f64::NAN; 3 * count], vec![u32::MAX; 3 * triangles]);
        let status = swiftprox_shape_copy_level_vertices(shape, 1, vertices.as_mut_ptr(), count);
        assert_eq!(status, StatusCode::Ok);
        let status = swiftprox_shape_copy_level_triangles(shape, 1, corners.as_mut_ptr(), triangles);
        assert_eq!(status, StatusCode::Ok);
        for [a, b, c] in corners.as_chunks::<3>().0 {
            let corner = |v: &u32| Vector::from_column_slice(&vertices[3 * *v as usize..][..3]);
            let (a, b, c) = (corner(a), corner(b), corner(c));
            let normal = (b - a).cross(&(c - a)).normalize();
            let above = |p: &[f64; 3]| normal.dot(&(Vector::from(*p) - a)) > 1e-14;
            assert!(!points.as_chunks::<3>().0.iter().any(above));
        }
        for call in [
            swiftprox_shape_copy_level_vertices(shape, 1, vertices.as_mut_ptr(), count - 1),
            swiftprox_shape_copy_level_triangles(shape, 1, corners.as_mut_ptr(), 0),
            swiftprox_shape_copy_level_vertices(shape, 9, vertices.as_mut_ptr(), count),
        ] {
            assert_eq!(call, StatusCode::ErrorInvalidArgument);
        }

        let (mut fine, mut faces) = (vec![f64::NAN; 3 * 400], vec![0; 3 * 796]);
        assert_eq!(swiftprox_shape_copy_vertices(shape, fine.as_mut_ptr(), null_mut(), 400), StatusCode::Ok);
        assert_eq!(swiftprox_shape_copy_triangles(shape, faces.as_mut_ptr(), 796), StatusCode::Ok);
        let mesh = |vertices: &[f64], faces: &[u32]| CMesh {
            vertices: vertices.as_ptr(),
            vertex_count: vertices.len() / 3,
            indices: faces.as_ptr(),
            valences: null(),
            face_count: faces.len() / 3,
        };
        let levels = [mesh(&fine, &faces), mesh(&vertices, &[])];
        let mut given = null();
        assert_eq!(
            swiftprox_shape_create_from_levels(levels.as_ptr(), 2, null(), &mut given),
            StatusCode::Ok,
            "{}",
            last_message()
        );
        let mut same = level;
        assert_eq!(swiftprox_shape_get_level_info(given, 1, &mut same), StatusCode::Ok);
        assert_eq!((same.vertex_count, same.triangle_count), (count, triangles));
        assert!((same.deviation - level.deviation).abs() < 1e-12, "{:e} {:e}", same.deviation, level.deviation);

        // Through a file.
        let path = std::path::Path::new(env!("CARGO_TARGET_TMPDIR")).join("c_interface.shape");
        let path = std::ffi::CString::new(path.to_str().unwrap()).unwrap();
        let mut loaded = null();
        assert_eq!(swiftprox_shape_save(given, path.as_ptr()), StatusCode::Ok, "{}", last_message());
        assert_eq!(
            swiftprox_shape_load(path.as_ptr(), None, null_mut(), &mut loaded),
            StatusCode::Ok,
            "{}",
            last_message()
        );
        assert!(*loaded == *given);
        release(loaded);
        assert_eq!(swiftprox_shape_save(null(), path.as_ptr()), StatusCode::ErrorNullPointer);
        assert_eq!(swiftprox_shape_load(null(), None, null_mut(), &mut loaded), StatusCode::ErrorNullPointer);
        assert_eq!(
            swiftprox_shape_load(c"no/such/file".as_ptr(), None, null_mut(), &mut loaded),
            StatusCode::ErrorFile
        );
        assert!(loaded.is_null() && last_message().contains("no/such/file"), "{}", last_message());
        release(given);

        let bad = [levels[0], mesh(&vertices[..9], &[])];
        assert_eq!(swiftprox_shape_create_from_levels(bad.as_ptr(), 2, null(), &mut given), StatusCode::ErrorMesh);
        assert!(last_message().contains("level 1") && given.is_null(), "{}", last_message());
        let bad = [levels[0], CMesh { vertices: null(), ..levels[1] }];
        assert_eq!(
            swiftprox_shape_create_from_levels(bad.as_ptr(), 2, null(), &mut given),
            StatusCode::ErrorNullPointer
        );
        assert!(last_message().contains("levels[1]"), "{}", last_message());
        assert_eq!(swiftprox_shape_create_from_levels(null(), 2, null(), &mut given), StatusCode::ErrorNullPointer);
        assert_eq!(swiftprox_shape_create_from_levels(null(), 0, null(), &mut given), StatusCode::ErrorInvalidArgument);
        let tuning = CShapeTuning { hierarchy: HierarchyKind::Given as i32, ..shape_tuning() };
        let options = CShapeOptions { tuning: &tuning, ..shape_options() };
        let status = swiftprox_shape_create_from_levels(levels.as_ptr(), 2, &options, &mut given);
        assert_eq!(status, StatusCode::ErrorInvalidArgument);
        assert!(last_message().contains("SWIFTPROX_HIERARCHY_NONE"), "{}", last_message());
        release(shape);
    }
}

/// Messages are UTF-8 whatever they quote; on Unix a path is bytes.
#[test]
#[cfg(target_os = "linux")]
fn a_path_may_be_any_bytes_and_messages_are_utf8() {
    let folder = std::path::Path::new(env!("CARGO_TARGET_TMPDIR"));
    let mut path = folder.join("Grüße ").into_os_string().into_encoded_bytes();
    path.extend(b"\xff\xc3(.shape");
    let path = std::ffi::CString::new(path).unwrap();
    let shape = tetrahedron();
    let mut loaded = null();
    // SAFETY: strings, a living shape, and room for another.
    unsafe {
        assert_eq!(swiftprox_shape_save(shape, path.as_ptr()), StatusCode::Ok, "{}", last_message());
        assert_eq!(
            swiftprox_shape_load(path.as_ptr(), None, null_mut(), &mut loaded),
            StatusCode::Ok,
            "{}",
            last_message()
        );
        assert!(*loaded == *shape);
        release(loaded);
        let file = <std::ffi::OsStr as std::os::unix::ffi::OsStrExt>::from_bytes(path.to_bytes());
        std::fs::remove_file(file).unwrap();
        assert_eq!(swiftprox_shape_load(path.as_ptr(), None, null_mut(), &mut loaded), StatusCode::ErrorFile);
        let message = CStr::from_ptr(swiftprox_library_last_error_message()).to_str().unwrap();
        assert!(message.contains("Grüße \u{fffd}\u{fffd}(.shape: cannot be read"), "{message}");
    }
    release(shape);
}

#[test]
fn a_build_can_be_cancelled_and_its_options_are_checked() {
    let points = many_points();
    // SAFETY: every pointer is valid; the options are initialised.
    unsafe {
        let tuning = CShapeTuning { hierarchy: HierarchyKind::DobkinKirkpatrick as i32, ..shape_tuning() };
        let mut options = CShapeOptions { tuning: &tuning, ..shape_options() };
        let mut told = Told { reports: 0, last: 0.0, stop_after: 2 };
        options.progress = Some(tell);
        options.progress_user = (&raw mut told).cast();
        let mut shape = null();
        let mut make = |options: &CShapeOptions| {
            let status = swiftprox_shape_create_from_points(points.as_ptr(), 400, options, &mut shape);
            assert!(status == StatusCode::Ok || shape.is_null());
            status
        };
        assert_eq!(make(&options), StatusCode::ErrorCancelled);
        assert_eq!(told.reports, 3);
        // Without levels, too.
        told = Told { reports: 0, last: 0.0, stop_after: 2 };
        assert_eq!(make(&CShapeOptions { tuning: null(), ..options }), StatusCode::ErrorCancelled);
        assert_eq!(told.reports, 3);
        options.progress = None;
        for hierarchy in [HierarchyKind::Given as i32, 99, -1] {
            let tuning = CShapeTuning { hierarchy, ..tuning };
            assert_eq!(make(&CShapeOptions { tuning: &tuning, ..options }), StatusCode::ErrorInvalidArgument);
            // Who gives levels is told where they go.
            let is_told = last_message().contains("swiftprox_shape_create_from_levels");
            assert_eq!(is_told, hierarchy == HierarchyKind::Given as i32, "{}", last_message());
        }
        for (decimation, shown) in [(0.0, "0.0"), (1.0, "1.0"), (f64::NAN, "NaN")] {
            let tuning = CShapeTuning { decimation, ..tuning };
            assert_eq!(make(&CShapeOptions { tuning: &tuning, ..options }), StatusCode::ErrorInvalidArgument);
            let expected = format!("decimation is {shown}, it must be between 0 and 1, both exclusive");
            assert_eq!(last_message(), expected);
        }
    }
}

#[test]
fn a_scene_holds_shares_of_its_own() {
    let shape = tetrahedron();
    // SAFETY: every pointer is valid, and the scene is used by this thread only.
    unsafe {
        let mut scene = null_mut();
        assert_eq!(swiftprox_scene_create(null(), &mut scene), StatusCode::Ok);
        let mut options: CObjectOptions = initialised(swiftprox_object_options_init_sized);
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

#[test]
fn messages_belong_to_their_thread() {
    std::thread::scope(|threads| {
        for i in 0..4_u32 {
            threads.spawn(move || {
                assert_eq!(last_message(), "");
                for _ in 0..100 {
                    assert_eq!(swiftprox_library_check_version(9, i as i32, 0), StatusCode::ErrorVersion);
                    assert!(last_message().contains(&format!("9.{i}.0")), "{}", last_message());
                    assert_eq!(
                        swiftprox_library_check_version(VERSION_MAJOR, VERSION_MINOR, VERSION_PATCH),
                        StatusCode::Ok
                    );
                    assert!(last_message().contains(&format!("9.{i}.0")), "a success leaves the message");
                }
            });
        }
    });
}

#[test]
fn the_log_hears_of_every_failure() {
    static HEARD: Mutex<Vec<(i32, String)>> = Mutex::new(Vec::new());
    unsafe extern "C-unwind" fn hear(status: i32, message: *const c_char, user: *mut c_void) {
        // SAFETY: the library hands a message that lives during the call.
        let message = unsafe { CStr::from_ptr(message) }.to_string_lossy().into_owned();
        // Other tests of this process fail on purpose meanwhile; this one tells its failures by a number.
        if message.contains("7331") && user.addr() == 42 {
            HEARD.lock().unwrap().push((status, message));
        }
    }
    swiftprox_library_set_log(Some(hear), std::ptr::without_provenance_mut(42));
    swiftprox_library_check_version(7331, 0, 0);
    swiftprox_library_set_log(None, null_mut());
    swiftprox_library_check_version(7331, 1, 0);
    let heard = HEARD.lock().unwrap();
    assert_eq!(heard.len(), 1, "{heard:?}");
    assert_eq!(heard[0].0, StatusCode::ErrorVersion as i32);
}

/// The C libraries' allocator is tested by c_tests/allocator.c.
#[test]
#[cfg(not(feature = "allocator"))]
fn a_rust_program_keeps_its_allocator() {
    assert_eq!(swiftprox_library_set_allocator(None, None, null_mut()), StatusCode::ErrorUnsupported);
    assert!(last_message().contains("feature `allocator`"));
}

#[test]
fn every_status_outcome_and_feature_kind_has_words_of_its_own() {
    type InWords = extern "C" fn(i32) -> *const c_char;
    for (in_words, last, unknown) in [
        (swiftprox_library_status_string as InWords, StatusCode::ErrorBusy as i32, "not a status"),
        (swiftprox_library_outcome_string, Outcome::Undecided as i32, "not an outcome"),
        (swiftprox_library_decided_by_string, DecidedBy::InscribedSpheres as i32, "not what decides"),
        (swiftprox_library_feature_kind_string, FeatureKind::Face as i32, "not a feature kind"),
    ] {
        let words = |number: i32| {
            // SAFETY: never null, terminated, valid for ever.
            unsafe { CStr::from_ptr(in_words(number)) }.to_str().unwrap()
        };
        let all: Vec<&str> = (0..=last).map(words).collect();
        for (i, one) in all.iter().enumerate() {
            assert!(!one.is_empty() && *one != unknown && !all[..i].contains(one), "{i}: {one}");
        }
        for number in [i32::MIN, -1, last + 1, i32::MAX] {
            assert_eq!(words(number), unknown, "{number}");
        }
    }
}

/// A zero of a distance reads as a contact: what a failed call does not say is NaN, and counts are 0.
#[test]
fn what_a_failed_call_does_not_say_is_nan() {
    let shape = tetrahedron();
    let bad_pose = [f64::NAN; 12];
    let (here, there) = (moved(0.0), moved(3.0));
    let (here, there) = (here.as_ptr(), there.as_ptr());
    let config = CPairConfig { distance_tolerance: -1.0, ..pair_config() };
    let small = CPairConfig { struct_size: 8, ..pair_config() };
    let queries =
        [swiftprox_pair_distance, swiftprox_pair_intersection, swiftprox_pair_contact, swiftprox_pair_approximate];
    let arguments = [
        (null(), here, shape, there, null()),
        (shape, null(), shape, there, null()),
        (shape, here, null(), there, null()),
        (shape, here, shape, null(), null()),
        (shape, bad_pose.as_ptr(), shape, there, null()),
        (shape, here, shape, bad_pose.as_ptr(), null()),
        (shape, here, shape, there, &raw const config),
        (shape, here, shape, there, &raw const small),
    ];
    for query in queries {
        for (i, &(shape1, pose1, shape2, pose2, config)) in arguments.iter().enumerate() {
            for has_cache in [true, false] {
                let mut answer = PairAnswer { distance: 0.0, lower: 0.0, upper: 0.0, ..PairAnswer::default() };
                let mut cache = CPairCache::default();
                let cache: *mut CPairCache = if has_cache { &mut cache } else { null_mut() };
                // SAFETY: every pointer is valid or null.
                let status = unsafe { query(shape1, pose1, shape2, pose2, cache, config, &mut answer) };
                assert_ne!(status, StatusCode::Ok, "{i}");
                let PairAnswer { distance, lower, upper, local1, local2, world1, world2, normal, .. } = answer;
                let vectors = [local1, local2, world1, world2, normal];
                assert!(
                    vectors.iter().flatten().chain(&[distance, lower, upper]).all(|x| x.is_nan()),
                    "{i}: {answer:?}"
                );
                assert_eq!((answer.outcome, answer.proof_count), (Outcome::None, 0));
            }
        }
    }

    // Bytes that are no answer, with the right sizes.
    let mut shape_info = MaybeUninit::<ShapeInfo>::zeroed();
    let mut level_info = MaybeUninit::<LevelInfo>::zeroed();
    let mut object_info = MaybeUninit::<ObjectInfo>::zeroed();
    let mut statistics = SceneStatistics { queries: 7, error_spent: 0.0, ..SceneStatistics::default() };
    let mut scene = null_mut();
    // SAFETY: every pointer is valid or null; all bytes are zero but the sizes, which make valid structs.
    unsafe {
        assert_eq!(swiftprox_scene_create(null(), &mut scene), StatusCode::Ok);
        (*shape_info.as_mut_ptr()).struct_size = size_of::<ShapeInfo>();
        assert_eq!(swiftprox_shape_get_info(null(), shape_info.as_mut_ptr()), StatusCode::ErrorNullPointer);
        let info = shape_info.assume_init();
        let vectors = [info.centre_of_mass, info.lower_corner, info.upper_corner];
        let mut numbers = vectors.into_iter().flatten().chain(info.inertia).chain([info.volume, info.radius]);
        assert!(numbers.all(|x| x.is_nan()), "{info:?}");

        for (of, level) in [(null(), 0), (shape, 1), (shape, usize::MAX)] {
            level_info.as_mut_ptr().write_bytes(0, 1);
            (*level_info.as_mut_ptr()).struct_size = size_of::<LevelInfo>();
            assert_ne!(swiftprox_shape_get_level_info(of, level, level_info.as_mut_ptr()), StatusCode::Ok);
            let info = level_info.assume_init();
            assert!(info.deviation.is_nan() && info.vertex_count == 0, "{info:?}");
        }

        for (of, id) in [(null(), 1), (scene.cast_const(), 0), (scene, 99)] {
            object_info.as_mut_ptr().write_bytes(0, 1);
            (*object_info.as_mut_ptr()).struct_size = size_of::<ObjectInfo>();
            let status = swiftprox_scene_get_object_info(of, ObjectId::from_bits(id), object_info.as_mut_ptr());
            assert_ne!(status, StatusCode::Ok);
            let info = object_info.assume_init();
            assert!(info.pose.iter().all(|x| x.is_nan()) && info.piece_count == 0, "{info:?}");
        }

        assert_eq!(swiftprox_scene_get_statistics(null(), &mut statistics), StatusCode::ErrorNullPointer);
        assert!(statistics.error_spent.is_nan() && statistics.queries == 0, "{statistics:?}");
        assert_eq!(swiftprox_scene_destroy(scene), StatusCode::Ok);
    }
    release(shape);
}
