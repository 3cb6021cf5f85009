//! Levels of detail: that they contain the body, how far they stand off, how they are linked.

#[path = "../../benches/common/mod.rs"]
mod common;

mod bodies;
mod validate;

use bodies::bodies;
use swiftprox::error::Error;
use swiftprox::hierarchy::{Hierarchy, HierarchyKind, HierarchyOptions};
use swiftprox::math::Vector;
use swiftprox::polyhedron::Polyhedron;
use swiftprox::progress::Progress;
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
const KINDS: [HierarchyKind; 2] = [HierarchyKind::Quadric, HierarchyKind::DobkinKirkpatrick];

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
