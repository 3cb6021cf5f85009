//! Levels through C: built, cancelled, counted and read back.

use std::ffi::c_void;
use std::mem::MaybeUninit;
use std::ptr::{null, null_mut};

use swiftprox::ffi::StatusCode;
use swiftprox::ffi::arrays::CMesh;
use swiftprox::ffi::level::*;
use swiftprox::ffi::shape::*;
use swiftprox::ffi::shape_options::*;
use swiftprox::ffi::tuning::*;
use swiftprox::hierarchy::HierarchyKind;
use swiftprox::math::Vector;

use crate::{last_message, release, shape_options, shape_tuning};

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
