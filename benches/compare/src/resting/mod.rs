//! Resting contacts: how deep bodies are in each other that hardly move, and their manifold of four points, scene by scene.
//!
//! The truth is the certified interval, of which each answer is re-checked by [`verify_depth`]; a peer errs by as much as its depth
//! is outside of it. The depth of a manifold is that of its deepest point.

mod box3d;
mod scenes;

use std::fmt::Write;
use std::rc::Rc;

use swiftprox::pair::{DepthAnswer, DepthCache, DepthConfig, Outcome, depth};
use swiftprox::shape::{Shape, ShapeOptions};
use swiftprox::verify::verify_depth;

use crate::bodies::manifold::{OwnManifold, ParryManifold};
use crate::depth::{STRONGEST, ours, parry::Contact, triangulated};
use crate::method::{Method, replies};
use crate::options::Options;
use crate::parry::Rings;
use crate::peers::{self, Asked};
use crate::report;
use crate::setting::poses_of;
use crate::timing::{Time, time_methods};
use box3d::Box3d;
use scenes::{SCENES, Scene};
use testkit::PosePair;

/// Our depth with its manifold of at most four points.
const MANIFOLD: &str = "swiftprox-manifold";

/// Peers besides the strongest.
const FURTHER: [&str; 2] = ["bullet-1e-4", "libccd-mpr-1e-4"];

/// Engines' manifolds, beside those of Box3D and parry.
const MANIFOLDS: [&str; 2] = ["mujoco-manifold-1e-6", "bullet-manifold-0"];

pub fn run(options: &Options) -> Result<(), String> {
    let mut rows = Vec::new();
    for scene in &SCENES {
        rows.extend(measure(scene, options)?);
        eprintln!("{} done", scene.name);
    }
    print(&rows);
    if let Some(path) = &options.csv {
        report::write(path, options.passes, &csv(&rows))?;
    }
    Ok(())
}

/// A method on a scene.
struct Row {
    scene: &'static str,
    method: String,
    count: usize,
    time: Time,
    /// Poses of which no depth was said: a failure, or bodies said to be apart.
    failures: usize,
    worst_error: f64,
}

fn measure(scene: &Scene, options: &Options) -> Result<Vec<Row>, String> {
    let told = |e: swiftprox::error::Error| format!("{}: {e}", scene.name);
    let meshes = [scene.bodies[0].mesh().map_err(told)?, scene.bodies[1].mesh().map_err(told)?];
    let shape = |i: usize| Shape::from_mesh(&meshes[i], &ShapeOptions::default()).map(Rc::new).map_err(told);
    let shapes = [shape(0)?, shape(1)?];
    let triangles = [triangulated(&meshes[0]).map_err(told)?, triangulated(&meshes[1]).map_err(told)?];
    let [first, second] = &triangles;

    let poses = scene.poses([&shapes[0], &shapes[1]], options.count).map_err(told)?;
    let truths = truths(&shapes, &poses).map_err(told)?;
    // No two that search alike follow each other: the second would find the branch predictors trained on the very poses.
    let mut methods: Vec<Box<dyn Method>> = vec![Box::new(ours::Depth::new(shapes.each_ref(), 0.0))];
    methods.extend(peers::of_names(Asked::Depth, &STRONGEST, [first, second]));
    methods.push(Box::new(OwnManifold::new(MANIFOLD, shapes.each_ref())));
    methods.extend(peers::of_names(Asked::Depth, &FURTHER, [first, second]));
    methods.push(Box::new(Contact::new([Rc::new(Rings::new(first)), Rc::new(Rings::new(second))])));
    methods.extend(Box3d::new([first, second]).map(|peer| Box::new(peer) as Box<dyn Method>));
    methods.extend(peers::of_names(Asked::Manifold, &MANIFOLDS, [first, second]));
    if let [Some(first), Some(second)] = [0, 1].map(|i| scene.bodies[i].of_parry(&triangles[i])) {
        methods.push(Box::new(ParryManifold::new("parry-manifold", [first, second])));
    }
    methods.retain(|method| options.methods.is_empty() || options.methods.iter().any(|name| name == method.name()));

    methods.iter_mut().for_each(|method| method.load(&poses));
    let replies: Vec<_> = methods.iter_mut().map(|method| replies(method.as_mut(), poses.len())).collect();
    let times = time_methods(&mut methods, poses.len(), options.passes);
    let found = methods.iter().zip(times).zip(replies);
    Ok(found
        .map(|((method, time), replies)| {
            let said = replies.iter().zip(&truths).filter(|(reply, _)| reply.distance > 0.0);
            let error = |depth: f64, [lower, upper]: &[f64; 2]| (lower - depth).max(depth - upper).max(0.0);
            Row {
                scene: scene.name,
                method: method.name().into(),
                count: poses.len(),
                time,
                failures: replies.len() - said.clone().count(),
                worst_error: said.map(|(reply, truth)| error(reply.distance, truth)).fold(0.0, f64::max),
            }
        })
        .collect())
}

/// The intervals that hold the depths.
fn truths(shapes: &[Rc<Shape>; 2], poses: &[PosePair]) -> swiftprox::error::Result<Vec<[f64; 2]>> {
    let (mut cache, mut answer) = (DepthCache::default(), DepthAnswer::default());
    let mut truths = Vec::with_capacity(poses.len());
    for [pose1, pose2] in &poses_of(poses) {
        let bodies = [shapes[0].at(pose1), shapes[1].at(pose2)];
        depth(bodies, &mut cache, &DepthConfig::default(), &mut answer)?;
        verify_depth(bodies, &cache, &answer)?;
        assert!(answer.outcome == Outcome::Intersecting && answer.lower > 0.0, "bodies at rest overlap");
        truths.push([answer.lower, answer.upper]);
    }
    Ok(truths)
}

fn csv(rows: &[Row]) -> String {
    let mut text = "scene,method,count,best_ns,median_ns,failures,worst_error\n".to_string();
    for Row { scene, method, count, time: Time { best, median }, failures, worst_error } in rows {
        let _ = writeln!(text, "\"{scene}\",{method},{count},{best:.1},{median:.1},{failures},{worst_error:.2e}");
    }
    text
}

/// A row for each scene: ns per query of each method, of peers also how many times as long as ours that is; then geometric means.
fn print(rows: &[Row]) {
    let Some(first) = rows.first() else { return };
    let methods: Vec<&str> =
        rows.iter().take_while(|row| row.scene == first.scene).map(|row| row.method.as_str()).collect();
    println!("| scene | {} |\n|---|{}", methods.join(" | "), "--:|".repeat(methods.len()));
    let line = |name: &str, times: &[Option<f64>]| {
        let own = |method: &str| {
            let own = if method.contains("manifold") { MANIFOLD } else { ours::NAME };
            methods.iter().position(|other| *other == own).and_then(|k| times[k]).unwrap_or(f64::NAN)
        };
        let cell = |(method, time): (&&str, &Option<f64>)| match time {
            Some(time) if method.starts_with(ours::NAME) => format!("{time:.0}"),
            Some(time) => format!("{time:.0} ({:.2})", time / own(method)),
            None => String::new(),
        };
        let cells: Vec<String> = methods.iter().zip(times).map(cell).collect();
        println!("| {name} | {} |", cells.join(" | "));
    };
    let of = |scene: &str, method: &str| {
        rows.iter().find(|row| row.scene == scene && row.method == method).map(|row| row.time.best)
    };
    for scene in &SCENES {
        line(scene.name, &methods.iter().map(|method| of(scene.name, method)).collect::<Vec<_>>());
    }
    let mean = |method: &&str| {
        let times: Option<Vec<f64>> = SCENES.iter().map(|scene| of(scene.name, method)).collect();
        times.map(|times| report::geometric_mean(times.into_iter()))
    };
    line("geometric mean", &methods.iter().map(mean).collect::<Vec<_>>());
}
