//! How long shapes take to build.

use std::hint::black_box;

use parry3d_f64::math::Vector;
use parry3d_f64::transformation::try_convex_hull;
use swiftprox::shape::{Shape, ShapeOptions};

use crate::model;
use crate::options::Options;
use crate::report::{self, BuildRow};
use crate::timing::{Time, measure, median};

pub fn run(options: &Options) -> Result<(), String> {
    let defaults = ShapeOptions::default();
    let mut rows = Vec::new();
    for &n in &options.vertices {
        for name in &options.models {
            let mesh = model(options, name, n)?;
            let points: Vec<Vector> = mesh.vertices.iter().map(|v| Vector::new(v.x, v.y, v.z)).collect();
            let mut push = |method, work: &dyn Fn() -> bool| {
                let time = time_build(options.passes, work).ok_or_else(|| format!("{name} {n}: {method} fails"))?;
                rows.push(BuildRow { model: name.clone(), n: mesh.vertices.len(), method, time });
                Ok::<(), String>(())
            };
            push("swiftprox-mesh", &|| Shape::from_mesh(black_box(&mesh), &defaults).is_ok())?;
            push("swiftprox-points", &|| Shape::from_points(black_box(&mesh.vertices), &defaults).is_ok())?;
            push("parry-hull", &|| try_convex_hull(black_box(&points)).is_ok())?;
        }
    }
    report::print_build(&rows);
    if let Some(path) = &options.csv {
        report::write(path, options.passes, &report::build_csv(&rows))?;
    }
    Ok(())
}

/// `None` when the work fails.
fn time_build(passes: usize, work: &dyn Fn() -> bool) -> Option<Time> {
    let mut times = Vec::with_capacity(passes);
    for _ in 0..passes {
        let mut good = false;
        times.push(measure(|| good = work()));
        if !good {
            return None;
        }
    }
    let median = median(&mut times);
    Some(Time { best: times[0], median })
}
