//! How long shapes take to build, as a whole and part by part, and the memory that they take.

use std::hint::black_box;

use parry3d_f64::math::Vector;
use parry3d_f64::transformation::try_convex_hull;
use swiftprox::body::polyhedron::lookup::Lookup;
use swiftprox::body::tables::build_table;
use swiftprox::hierarchy::{Hierarchy, HierarchyKind, HierarchyOptions};
use swiftprox::progress::Progress;
use swiftprox::shape::{Shape, ShapeOptions};

use crate::model;
use crate::options::Options;
use crate::report::{self, BuildRow};
use crate::timing::{Time, measure, median};

pub fn run(options: &Options) -> Result<(), String> {
    let mut rows = Vec::new();
    for &n in &options.vertices {
        for name in &options.models {
            let mesh = model(options, name, n)?;
            let points: Vec<Vector> = mesh.vertices.iter().map(|v| Vector::new(v.x, v.y, v.z)).collect();
            let defaults = ShapeOptions::default();
            let body = Shape::from_mesh(&mesh, &defaults).map_err(|e| e.to_string())?;
            let polyhedron = body.polyhedron();
            let mut push = |method, work: &dyn Fn() -> Option<usize>| {
                let (time, bytes) =
                    time_build(options.passes, work).ok_or_else(|| format!("{name} {n}: {method} fails"))?;
                rows.push(BuildRow { model: name.clone(), n: mesh.vertices.len(), method, time, bytes });
                Ok::<(), String>(())
            };
            let bytes = |shape: swiftprox::error::Result<Shape>| shape.ok().map(|shape| shape.bytes());
            push("swiftprox-mesh", &|| bytes(Shape::from_mesh(black_box(&mesh), &defaults)))?;
            push("swiftprox-points", &|| bytes(Shape::from_points(black_box(&mesh.vertices), &defaults)))?;
            push("parry-hull", &|| try_convex_hull(black_box(&points)).ok().map(|_| 0))?;
            push("table", &|| {
                let table = black_box(build_table(black_box(polyhedron)).unwrap());
                Some(Lookup { made: table.into(), ..polyhedron.lookup.clone() }.heap_bytes())
            })?;
            for (method, kind) in [
                ("quadric", HierarchyKind::Quadric),
                ("outer cuts", HierarchyKind::OuterCuts),
                ("Dobkin-Kirkpatrick", HierarchyKind::DobkinKirkpatrick),
            ] {
                let wanted = HierarchyOptions { kind, ..HierarchyOptions::default() };
                push(method, &|| {
                    let hierarchy = Hierarchy::build(black_box(polyhedron), &wanted, &mut Progress::new(&mut |_| true));
                    hierarchy.ok().map(|hierarchy| hierarchy.heap_bytes())
                })?;
            }
            eprintln!("{name} {n} done");
        }
    }
    report::print_build(&rows);
    if let Some(path) = &options.csv {
        report::write(path, options.passes, &report::build_csv(&rows))?;
    }
    Ok(())
}

/// The time, and the bytes that the work says; `None` when it fails.
fn time_build(passes: usize, work: &dyn Fn() -> Option<usize>) -> Option<(Time, usize)> {
    let mut times = Vec::with_capacity(passes);
    let mut bytes = 0;
    for _ in 0..passes {
        let mut done = None;
        times.push(measure(|| done = work()));
        bytes = done?;
    }
    let median = median(&mut times);
    Some((Time { best: times[0], median }, bytes))
}
