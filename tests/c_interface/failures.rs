//! What is told when a call fails: messages, the log, words for numbers, and answers that say nothing.

use std::ffi::{CStr, c_char, c_void};
use std::mem::MaybeUninit;
use std::ptr::{null, null_mut};
use std::sync::Mutex;

use swiftprox::ffi::StatusCode;
use swiftprox::ffi::level::*;
use swiftprox::ffi::library::*;
use swiftprox::ffi::object::*;
use swiftprox::ffi::pair::*;
use swiftprox::ffi::query::*;
use swiftprox::ffi::scene::*;
use swiftprox::ffi::shape::*;
use swiftprox::object::ObjectId;
use swiftprox::pair::{DecidedBy, FeatureKind, Outcome, PairAnswer};
use swiftprox::scene::SceneStatistics;

use crate::{last_message, moved, pair_config, release, tetrahedron};

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

/// Limits of lengths have some 300 digits; messages have an exponent.
#[test]
fn limits_in_messages_are_readable() {
    let mut shape = null();
    for (half_extent, radius, expected) in [
        (-1.0, 0.0, "half_extents[0] is -1.0, it must be positive and at most 1.0715086071862673e301"),
        (1.0, -0.5, "radius is -0.5, it must be at least 0 and at most 1.0715086071862673e301"),
    ] {
        // SAFETY: three numbers, and a place for the shape.
        let status = unsafe { swiftprox_shape_create_box([half_extent, 1.0, 1.0].as_ptr(), radius, &raw mut shape) };
        assert_eq!((status, shape), (StatusCode::ErrorInvalidArgument, null()));
        assert_eq!(last_message(), expected);
    }
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
    let config = CPairConfig { max_distance: -1.0, ..pair_config() };
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
                let status = unsafe {
                    query(
                        CPlaced { shape: shape1, pose: pose1 },
                        CPlaced { shape: shape2, pose: pose2 },
                        cache,
                        config,
                        &mut answer,
                    )
                };
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
