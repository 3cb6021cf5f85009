//! Levels of detail: that they contain the body, how far they stand off, how they are linked.

mod bodies;
mod validate;

use bodies::{bodies, polyhedron};
use swiftprox::body::polyhedron::Polyhedron;
use swiftprox::error::Error;
use swiftprox::hierarchy::{Hierarchy, HierarchyKind, HierarchyOptions};
use swiftprox::math::Vector;
use swiftprox::mesh::PolygonMesh;
use swiftprox::progress::Progress;
use swiftprox::shape::{Shape, ShapeOptions};
use testkit::models::{cuboid, ellipsoid};
use validate::validate;

fn given(base: &Polyhedron, levels: &[Vec<Vector>]) -> Result<Hierarchy, Error> {
    Hierarchy::from_levels(base, levels, &mut Progress::new(&mut |_| true))
}

/// Every `step`th vertex of a body.
fn some_vertices(body: &Polyhedron, step: usize) -> Vec<Vector> {
    (0..body.vertices.len() as u32).step_by(step).map(|v| body.local_position(v)).collect()
}

#[test]
fn given_levels_are_made_to_bound() {
    let mut with_levels = 0;
    for (name, body) in bodies(&[10, 102, 1002]) {
        let levels: Vec<Vec<Vector>> = [4, 16].map(|step| some_vertices(&body, step)).into();
        let levels: Vec<Vec<Vector>> = levels.into_iter().filter(|points| points.len() >= 6).collect();
        match given(&body, &levels) {
            Ok(hierarchy) => {
                assert_eq!((hierarchy.kind, hierarchy.levels.len()), (HierarchyKind::Given, levels.len()));
                with_levels += usize::from(!levels.is_empty());
                validate(&name, &body, &hierarchy);
            }
            // A few vertices of a body may lie in a plane, or of a wafer very nearly so.
            Err(e) => assert!(matches!(e, Error::Mesh(_)), "{name}: {e}"),
        }
    }
    assert!(with_levels > 15, "{with_levels}");
}

/// The kinds that are built.
const KINDS: [HierarchyKind; 3] = [HierarchyKind::Quadric, HierarchyKind::DobkinKirkpatrick, HierarchyKind::OuterCuts];

fn built(base: &Polyhedron, options: &HierarchyOptions) -> Hierarchy {
    Hierarchy::build(base, options, &mut Progress::new(&mut |_| true)).unwrap()
}

#[test]
fn built_levels_bound_and_shrink() {
    for kind in KINDS {
        for decimation in [0.25, 0.5] {
            let options = HierarchyOptions { kind, decimation, minimum_triangles: 20, most_levels: 40 };
            for (name, body) in bodies(&[10, 102, 1002]) {
                let hierarchy = built(&body, &options);
                let counts: Vec<usize> =
                    hierarchy.levels.iter().map(|level| level.polyhedron.triangles.len()).collect();
                let deviations: Vec<f64> =
                    hierarchy.levels.iter().map(|level| level.deviation / body.mass.radius).collect();
                println!("{name} {kind:?} {decimation}: {} {counts:?} {deviations:.3?}", body.triangles.len());
                validate(&name, &body, &hierarchy);
                let all: Vec<usize> = [body.triangles.len()].into_iter().chain(counts).collect();
                assert!(all.windows(2).all(|pair| pair[1] < pair[0]), "{name}, {kind:?}: {all:?}");
            }
        }
    }
}

fn feature_count(polyhedron: &Polyhedron) -> usize {
    polyhedron.vertices.len() + polyhedron.edges.len() + polyhedron.faces.len()
}

/// Faces of many corners come apart when vertices move: a level of a few triangles less has more features then, and is no level.
#[test]
fn every_level_has_fewer_features_than_the_one_below() {
    let outer = HierarchyOptions { kind: HierarchyKind::OuterCuts, decimation: 0.5, ..HierarchyOptions::default() };
    let round = polyhedron(&ellipsoid([1.0, 1.0, 0.5], 302).unwrap());
    // Three edges at each vertex.
    let simple = built(&round, &outer).levels[0].polyhedron.clone();
    assert_eq!(2 * simple.edges.len(), 3 * simple.vertices.len());
    let mut all = bodies(&[10, 102]);
    all.push(("simple".into(), simple));
    for kind in KINDS {
        for decimation in [0.25, 0.9, 0.99] {
            let options = HierarchyOptions { kind, decimation, minimum_triangles: 0, most_levels: 40 };
            for (name, body) in &all {
                let hierarchy = built(body, &options);
                let polyhedra = hierarchy.levels.iter().map(|level| &level.polyhedron);
                let counts: Vec<[usize; 2]> =
                    [body].into_iter().chain(polyhedra).map(|p| [p.triangles.len(), feature_count(p)]).collect();
                assert!(
                    counts.windows(2).all(|pair| (0..2).all(|i| pair[1][i] < pair[0][i])),
                    "{name}, {kind:?} {decimation}: {counts:?}"
                );
                if name == "simple" {
                    // It has as many features as a triangulated body of half as many vertices, but levels nevertheless.
                    let fraction = counts[1][0] as f64 / counts[0][0] as f64;
                    assert!(
                        counts.len() > 3 && fraction >= 0.95 * decimation.min(0.5),
                        "{kind:?} {decimation}: {counts:?}"
                    );
                    validate(name, body, &hierarchy);
                }
            }
        }
    }
}

/// What a box may be simplified to is no simpler, and a tetrahedron is the simplest body; whatever is asked for.
#[test]
fn a_box_or_a_tetrahedron_gets_no_level() {
    for kind in KINDS {
        let options = HierarchyOptions { kind, decimation: 0.9, minimum_triangles: 0, most_levels: 40 };
        let tetrahedron = [Vector::zeros(), Vector::x(), Vector::y(), Vector::z()];
        let tetrahedron = Shape::from_points(&tetrahedron, &ShapeOptions::default()).unwrap();
        assert_eq!(built(tetrahedron.polyhedron(), &options).levels.len(), 0);
        let cuboid = Shape::from_mesh(&cuboid([1.0, 2.0, 3.0]).unwrap(), &ShapeOptions::default()).unwrap();
        let defaults = HierarchyOptions { kind, ..HierarchyOptions::default() };
        assert_eq!(built(cuboid.polyhedron(), &defaults).levels.len(), 0);
    }
}

#[test]
fn stopping_rules() {
    let body = polyhedron(&ellipsoid([1.0, 1.0, 1.0], 1002).unwrap());
    // The level counts that the paper's figures name, the body included: 6, 3, 2, 2, 2.
    for (decimation, levels) in [(0.5, 5), (0.25, 2), (0.125, 1), (0.0625, 1), (0.03125, 1)] {
        let options = HierarchyOptions { kind: HierarchyKind::Quadric, decimation, ..HierarchyOptions::default() };
        assert_eq!(built(&body, &options).levels.len(), levels, "{decimation}");
    }
    for kind in KINDS {
        let options = HierarchyOptions { kind, decimation: 0.5, minimum_triangles: 300, most_levels: 40 };
        let all = built(&body, &options);
        assert!(all.levels.iter().all(|level| level.polyhedron.triangles.len() >= 300), "{kind:?}");
        let some = built(&body, &HierarchyOptions { most_levels: 1, ..options });
        assert_eq!(some.levels.len(), 1);
        // The first levels of many are the first of few.
        if kind != HierarchyKind::OuterCuts {
            assert_eq!(some.levels[0], all.levels[0]);
        }
        assert_eq!(built(&body, &HierarchyOptions { most_levels: 0, ..options }).levels.len(), 0);
    }
    assert_eq!(built(&body, &HierarchyOptions::default()).levels.len(), 0);
}

#[test]
fn options_out_of_range_are_refused() {
    let body = polyhedron(&cuboid([1.0; 3]).unwrap());
    let refused = |options: HierarchyOptions| {
        let result = Hierarchy::build(&body, &options, &mut Progress::new(&mut |_| true));
        assert!(matches!(result, Err(Error::Argument(_))), "{options:?}");
    };
    for decimation in [0.0, 1.0, -1.0, f64::NAN, f64::INFINITY] {
        refused(HierarchyOptions { decimation, ..HierarchyOptions::default() });
    }
    refused(HierarchyOptions { kind: HierarchyKind::Given, ..HierarchyOptions::default() });
}

/// By the general scheme all levels share the body's centre of mass, and so do given ones; Dobkin and Kirkpatrick's and cut
/// ones need not.
#[test]
fn levels_share_the_centre_of_mass() {
    let check = |name: &str, body: &Polyhedron, hierarchy: &Hierarchy| {
        for level in &hierarchy.levels {
            let aside = (level.polyhedron.mass.centre_of_mass - body.mass.centre_of_mass).norm();
            assert!(aside <= 1e-13 * body.radius + 1e-15 * body.centre.amax(), "{name}: {aside:e}");
        }
    };
    let options = HierarchyOptions { kind: HierarchyKind::Quadric, ..HierarchyOptions::default() };
    for (name, body) in bodies(&[102, 1002]) {
        check(&name, &body, &built(&body, &options));
        if let Ok(hierarchy) = given(&body, &[some_vertices(&body, 3)]) {
            check(&name, &body, &hierarchy);
        }
    }
}

#[test]
fn the_same_input_gives_the_same_levels() {
    for kind in KINDS {
        let options = HierarchyOptions { kind, ..HierarchyOptions::default() };
        for half_axes in [[1.0, 1.0, 1.0], [1.0, 0.1, 0.1]] {
            let body = polyhedron(&ellipsoid(half_axes, 500).unwrap());
            assert_eq!(built(&body, &options), built(&body, &options));
        }
    }
}

#[test]
fn a_build_reports_progress_and_can_be_cancelled() {
    let body = polyhedron(&ellipsoid([1.0, 1.0, 0.1], 800).unwrap());
    for kind in KINDS {
        let options = HierarchyOptions { kind, ..HierarchyOptions::default() };
        let mut reports = Vec::new();
        let mut listen = |fraction: f64| {
            reports.push(fraction);
            true
        };
        let whole = Hierarchy::build(&body, &options, &mut Progress::new(&mut listen)).unwrap();
        assert!(!whole.levels.is_empty() && reports.len() >= 8, "{kind:?}: {reports:?}");
        assert!(reports.is_sorted() && reports[0] >= 0.0 && reports.last() == Some(&1.0), "{kind:?}: {reports:?}");
        let largest_step = reports.windows(2).map(|pair| pair[1] - pair[0]).fold(reports[0], f64::max);
        assert!(largest_step <= 0.5, "{kind:?}: {reports:?}");
        for stop in (0..reports.len()).step_by(5) {
            let mut left = stop;
            let mut cancel = |_| {
                left = left.wrapping_sub(1);
                left != usize::MAX
            };
            let result = Hierarchy::build(&body, &options, &mut Progress::new(&mut cancel));
            assert!(matches!(result, Err(Error::Cancelled(_))), "{kind:?} {stop}");
            // Nothing was asked after the refusal.
            assert_eq!(left, usize::MAX, "{kind:?} {stop}");
        }
    }
}

#[test]
fn shapes_have_levels_on_request() {
    let mesh = ellipsoid([1.0, 1.0, 0.1], 500).unwrap();
    let plain = Shape::from_mesh(&mesh, &ShapeOptions::default()).unwrap();
    assert!(plain.hierarchy().levels.is_empty());
    let hierarchy = HierarchyOptions { kind: HierarchyKind::Quadric, ..HierarchyOptions::default() };
    let shape = Shape::from_mesh(&mesh, &ShapeOptions { hierarchy, ..ShapeOptions::default() }).unwrap();
    assert_eq!(shape.polyhedron(), plain.polyhedron());
    assert_eq!(shape.hierarchy(), &built(plain.polyhedron(), &hierarchy));
    assert_eq!(shape.bytes(), plain.bytes() + shape.hierarchy().heap_bytes());
    let again = plain.with_levels(&hierarchy, &mut Progress::new(&mut |_| true)).unwrap();
    assert_eq!(again, shape);
}

#[test]
fn given_levels_go_through_the_input_transform() {
    let fine = ellipsoid([1.0, 1.0, 0.3], 300).unwrap();
    let coarse = cuboid([2.0, 1.0, 0.5]).unwrap();
    let make = |meshes: &[PolygonMesh], options: &ShapeOptions| {
        Shape::from_levels(meshes, options, &mut Progress::new(&mut |_| true))
    };
    let options = ShapeOptions { scale: 4.0, translation: Vector::new(8.0, 0.0, 0.0), ..ShapeOptions::default() };
    let [plain, moved] =
        [&ShapeOptions::default(), &options].map(|options| make(&[fine.clone(), coarse.clone()], options).unwrap());
    for shape in [&plain, &moved] {
        assert_eq!(shape.hierarchy().kind, HierarchyKind::Given);
        assert_eq!(shape.hierarchy().levels[0].polyhedron.triangles.len(), 12);
        validate("given", shape.polyhedron(), shape.hierarchy());
    }
    let [plain, moved] = [&plain, &moved].map(|shape| shape.hierarchy().levels[0].deviation);
    assert!((moved - 4.0 * plain).abs() <= 1e-12 * moved, "{moved:e} {plain:e}");

    let message = |meshes: &[PolygonMesh], options: &ShapeOptions| make(meshes, options).unwrap_err().to_string();
    assert!(message(&[], &ShapeOptions::default()).contains("no level"));
    let flat = PolygonMesh::new(vec![Vector::zeros(), Vector::x(), Vector::y()], vec![0, 1, 2], None).unwrap();
    assert!(message(&[fine.clone(), coarse, flat], &ShapeOptions::default()).contains("level 2 has no interior"));
    let hierarchy = HierarchyOptions { kind: HierarchyKind::Quadric, ..HierarchyOptions::default() };
    assert!(message(&[fine], &ShapeOptions { hierarchy, ..ShapeOptions::default() }).contains("built"));
}
