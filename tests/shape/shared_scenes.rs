//! The scenes shared by tests, benchmarks and examples are what they say.

use swiftprox::math::{Pose, Vector};
use swiftprox::mesh::PolygonMesh;
use testkit::models::{ELLIPSOIDS, cuboid, ellipsoid, prism, random_hull};
use testkit::orbits::{ORBITS, STEPS, Step, poses};

/// Six times the volume; positive for outward faces. Also checks that every edge is shared by two opposite sides.
fn sixfold_volume(mesh: &PolygonMesh) -> f64 {
    let mut sides = std::collections::HashSet::new();
    let mut volume = 0.0;
    for f in 0..mesh.face_count() {
        let face = mesh.face(f);
        let corner = |k: usize| mesh.vertices[face[k] as usize];
        for k in 0..face.len() {
            assert!(sides.insert((face[k], face[(k + 1) % face.len()])), "a side occurs twice");
        }
        for k in 2..face.len() {
            volume += corner(0).dot(&corner(k - 1).cross(&corner(k)));
        }
    }
    assert!(sides.iter().all(|&(a, b)| sides.contains(&(b, a))), "the surface is open");
    volume
}

#[test]
fn models_are_closed_and_outward() {
    assert_eq!(sixfold_volume(&cuboid([1.0, 2.0, 3.0]).unwrap()), 6.0 * 48.0);
    let circle = |sides: u32| f64::from(sides) / 2.0 * (std::f64::consts::TAU / f64::from(sides)).sin();
    for sides in [3, 4, 17] {
        let volume = sixfold_volume(&prism(sides, 0.5).unwrap()) / 6.0;
        assert!((volume - circle(sides)).abs() < 1e-14, "{sides} sides: volume {volume}");
    }
    assert!(sixfold_volume(&random_hull(100, 1).unwrap()) > 0.0);
}

#[test]
fn ellipsoids_are_normalised() {
    for (name, half_axes) in ELLIPSOIDS {
        let mesh = ellipsoid(half_axes, 102).unwrap();
        assert_eq!(mesh.vertices.len(), 102, "{name}: points on an ellipsoid are all extreme");
        let radius = mesh.vertices.iter().map(Vector::norm).fold(0.0, f64::max);
        assert!((radius - 1.0).abs() < 1e-15, "{name}: radius {radius}");
        // A hull of 102 points reaches nearly to the ellipsoid's ends along each axis.
        for axis in 0..3 {
            let reach = mesh.vertices.iter().map(|v| v[axis].abs()).fold(0.0, f64::max);
            assert!((0.8..1.2).contains(&(reach / half_axes[axis])), "{name}: axis {axis} reaches {reach}");
        }
        assert!(sixfold_volume(&mesh) > 0.0, "{name}: faces point inwards");
    }
}

#[test]
fn orbits_keep_their_radius_and_step() {
    for orbit in ORBITS {
        for step in STEPS {
            let scene = poses(orbit, step, 40);
            let placed: Vec<[Pose; 2]> = (scene.iter())
                .map(|pair| [0, 12].map(|at| Pose::from_row_major(pair[at..at + 12].try_into().unwrap())))
                .collect();
            for [pose1, pose2] in &placed {
                assert!(pose1.rotation_defect() <= 1e-14 && pose2.rotation_defect() <= 1e-14);
                let distance = (pose2.translation() - pose1.translation()).norm() / orbit.radius;
                assert!((1.0 - 1e-14..1.5 + 1e-14).contains(&distance), "{} {step}", orbit.name);
            }
            if let Step::Degrees(degrees) = step {
                // Object 2 turns by the spin per step: cos of the angle from the trace of R₀ᵀR₁.
                let turn = placed[0][1].rotation().transpose() * placed[1][1].rotation();
                let cosine = (turn.trace() - 1.0) / 2.0;
                let expected = (1.118_033_988_7 * degrees.to_radians()).cos();
                assert!((cosine - expected).abs() < 1e-13, "{} {step}: cosine {cosine}", orbit.name);
            }
            assert_eq!(scene[..7], poses(orbit, step, 7), "a shorter scene is a part of the longer one");
        }
    }
}
