//! How deep: every method on the intersecting poses of the deep orbit, and on boxes that rest on each other.
//!
//! The truth is the certified interval, of which each answer is re-checked by [`verify_depth`]; a peer errs by as much as its depth
//! is outside of it.

pub mod answers;
pub mod ours;
pub mod parry;

use std::fmt::Write;
use std::rc::Rc;

use swiftprox::math::{Matrix, Vector};
use swiftprox::mesh::PolygonMesh;
use swiftprox::pair::{DepthAnswer, DepthCache, DepthConfig, Outcome, Placed, depth};
use swiftprox::shape::{Shape, ShapeOptions};
use swiftprox::verify::verify_depth;

use crate::method::{Method, Reply, replies};
use crate::options::Options;
use crate::parry::Rings;
use crate::peers::{self, Asked};
use crate::setting::poses_of;
use crate::timing::{Time, median, time_methods};
use crate::{model, motion, report};
use testkit::PosePair;
use testkit::models::cuboid;
use testkit::orbits::pose_pair;
use testkit::random::rotation;

/// The errors that this library is asked for, besides the narrowest provable interval.
pub const ERRORS: [f64; 5] = [1e-8, 1e-6, 1e-4, 1e-3, 1e-2];

/// Those that this library is to be held against.
pub const STRONGEST: [&str; 3] = ["coal-1e-10", "mujoco-1e-6", "jolt-1e-6"];

/// Further tolerances, and further libraries; the default of each is among them.
pub const OTHERS: [&str; 13] = [
    "coal-1e-6",
    "coal-1e-4",
    "coal-1e-3",
    "coal-1e-2",
    "mujoco-1e-10",
    "jolt-1e-4",
    "jolt-1e-2",
    "libccd-epa-1e-4",
    "libccd-epa-1e-10",
    "libccd-mpr-1e-4",
    "bullet-1e-4",
    "fcl-1e-6",
    "fcl-1e-10",
];

pub fn run(options: &Options) -> Result<(), String> {
    let mut rows = Vec::new();
    for &n in &options.vertices {
        for name in &options.models {
            let mesh = model(options, name, n)?;
            let mut compared = Compared::new(&mesh, options)?;
            for orbit in &options.orbits {
                for &step in &options.steps {
                    let scene = Scene { model: name.clone(), n, orbit: orbit.clone(), step: step.to_string() };
                    rows.extend(compared.measure(scene, &motion(options, orbit, step)?, options)?);
                }
            }
        }
    }
    if !options.without_boxes {
        let cube = cuboid([0.5; 3]).map_err(|e| e.to_string())?;
        let scene = Scene { model: "box".into(), n: 8, orbit: "resting".into(), step: "resting".into() };
        rows.extend(Compared::new(&cube, options)?.measure(scene, &resting(options.count), options)?);
    }
    print(&rows);
    if let Some(path) = &options.csv {
        report::write(path, options.passes, &csv(&rows))?;
    }
    Ok(())
}

/// A box on a like one under gravity as a simulator sees it: a little in it and hardly tilted, it creeps and turns a little, so
/// that from one query to the next another corner may come to be the deepest.
fn resting(count: usize) -> Vec<PosePair> {
    let pose = |i: usize| {
        let time = 1e-3 * i as f64;
        let sunk = 1e-3 + 1e-5 * (7.0 * time).sin();
        let lean = Vector::new(time.cos(), time.sin(), 0.0);
        let upper = rotation(&lean, 1e-5) * rotation(&Vector::z(), 0.3 + 0.1 * time);
        pose_pair(&Matrix::identity(), &Vector::zeros(), &upper, &Vector::new(0.1 + 0.01 * time, 0.05, 1.0 - sunk))
    };
    (0..count).map(pose).collect()
}

/// Peers are given triangles.
pub fn triangulated(mesh: &PolygonMesh) -> swiftprox::error::Result<PolygonMesh> {
    let faces = (0..mesh.face_count()).map(|f| mesh.face(f));
    let triangles = faces.flat_map(|face| (2..face.len()).flat_map(move |k| [face[0], face[k - 1], face[k]]));
    PolygonMesh::new(mesh.vertices.clone(), triangles.collect(), None)
}

/// A model, and the methods that are asked how deep it is in itself.
struct Compared {
    shape: Rc<Shape>,
    methods: Vec<Box<dyn Method>>,
    /// How many of them take their turns first.
    first_turns: usize,
}

impl Compared {
    /// No two that search alike follow each other: the second would find the branch predictors trained on the very poses.
    fn new(mesh: &PolygonMesh, options: &Options) -> Result<Compared, String> {
        let shape = Rc::new(Shape::from_mesh(mesh, &ShapeOptions::default()).map_err(|e| e.to_string())?);
        let mesh = &triangulated(mesh).map_err(|e| e.to_string())?;
        let rings = Rc::new(Rings::new(mesh));
        let mut first: Vec<Box<dyn Method>> = vec![Box::new(ours::Depth::new([&shape, &shape], 0.0))];
        first.extend(peers::of_names(Asked::Depth, &STRONGEST, [mesh; 2]));
        first.push(Box::new(parry::Contact::new([rings.clone(), rings])));
        let mut further = ERRORS.map(|error| Box::new(ours::Depth::new([&shape, &shape], error))).into_iter();
        let mut second: Vec<Box<dyn Method>> = Vec::new();
        for peer in peers::of_names(Asked::Depth, &OTHERS, [mesh; 2]) {
            second.extend(further.next().map(|method| method as Box<dyn Method>));
            second.push(peer);
        }
        second.extend(further.map(|method| method as Box<dyn Method>));
        let wanted = |method: &Box<dyn Method>| {
            options.methods.is_empty() || options.methods.iter().any(|name| name == method.name())
        };
        first.retain(wanted);
        second.retain(wanted);
        let first_turns = first.len();
        first.append(&mut second);
        Ok(Compared { shape, methods: first, first_turns })
    }

    fn measure(&mut self, scene: Scene, poses: &[PosePair], options: &Options) -> Result<Vec<Row>, String> {
        let (poses, truths) = self.intersecting(poses)?;
        if poses.is_empty() {
            return Ok(Vec::new());
        }
        self.methods.iter_mut().for_each(|method| method.load(&poses));
        let replies: Vec<_> = self.methods.iter_mut().map(|method| replies(method.as_mut(), poses.len())).collect();
        let (first, second) = self.methods.split_at_mut(self.first_turns);
        let [first, second] = [first, second].map(|methods| time_methods(methods, poses.len(), options.passes));
        eprintln!("{} {} {} {} done", scene.model, scene.n, scene.orbit, scene.step);
        let times = first.into_iter().chain(second);
        let found = self.methods.iter().zip(times).zip(replies);
        Ok(found.map(|((method, time), replies)| Row::new(&scene, method.name(), time, &replies, &truths)).collect())
    }

    /// The poses whose bodies overlap, and the intervals that hold their depths.
    fn intersecting(&self, poses: &[PosePair]) -> Result<(Vec<PosePair>, Vec<[f64; 2]>), String> {
        let (mut cache, mut answer) = (DepthCache::default(), DepthAnswer::default());
        let mut found = (Vec::new(), Vec::new());
        for (pose, [pose1, pose2]) in poses.iter().zip(poses_of(poses)) {
            let bodies = [&pose1, &pose2].map(|pose| Placed { shape: &self.shape, pose });
            depth(bodies, &mut cache, &DepthConfig::default(), &mut answer)
                .and_then(|()| verify_depth(bodies, &cache, &answer))
                .map_err(|e| format!("the truth of {pose:?}: {e}"))?;
            if answer.outcome == Outcome::Intersecting && answer.lower > 0.0 {
                found.0.push(*pose);
                found.1.push([answer.lower, answer.upper]);
            }
        }
        Ok(found)
    }
}

/// On what was measured.
#[derive(Clone)]
struct Scene {
    model: String,
    n: usize,
    orbit: String,
    step: String,
}

/// A method on a scene.
struct Row {
    scene: Scene,
    method: String,
    count: usize,
    time: Time,
    steps: f64,
    /// Poses of which no depth was said: a failure, or bodies said to be apart.
    failures: usize,
    median_error: f64,
    worst_error: f64,
    median_width: f64,
    worst_width: f64,
}

impl Row {
    fn new(scene: &Scene, method: &str, time: Time, replies: &[Reply], truths: &[[f64; 2]]) -> Row {
        let (mut errors, mut widths) = (Vec::new(), Vec::new());
        for (reply, [lower, upper]) in replies.iter().zip(truths) {
            if reply.distance > 0.0 {
                errors.push((lower - reply.distance).max(reply.distance - upper).max(0.0));
            }
            if !reply.width().is_nan() {
                widths.push(reply.width());
            }
        }
        let [median_error, median_width] = [median(&mut errors), median(&mut widths)];
        let worst = |sorted: &[f64]| sorted.last().copied().unwrap_or(f64::NAN);
        Row {
            scene: scene.clone(),
            method: method.into(),
            count: replies.len(),
            time,
            steps: replies.iter().map(|reply| reply.steps).sum::<f64>() / replies.len() as f64,
            failures: replies.len() - errors.len(),
            median_error,
            worst_error: worst(&errors),
            median_width,
            worst_width: worst(&widths),
        }
    }
}

fn csv(rows: &[Row]) -> String {
    let mut text =
        "asked,model,n,orbit,step,method,count,best_ns,median_ns,mean_steps,failures,median_error,worst_error,\
        median_width,worst_width\n"
            .to_string();
    for row in rows {
        let Row { scene: Scene { model, n, orbit, step }, method, count, time, steps, failures, .. } = row;
        let Row { median_error, worst_error, median_width, worst_width, .. } = row;
        let Time { best, median } = time;
        let _ = writeln!(
            text,
            "depth,{model},{n},{orbit},{step},{method},{count},{best:.1},{median:.1},{steps:.2},{failures},{median_error:.2e},\
            {worst_error:.2e},{median_width:.2e},{worst_width:.2e}"
        );
    }
    text
}

fn print(rows: &[Row]) {
    println!(
        "| model | n | step | poses | method | ns | times ours | failures | median error | worst error | widest |"
    );
    println!("|---|--:|--:|--:|---|--:|--:|--:|--:|--:|--:|");
    let mut own = f64::NAN;
    for row in rows {
        let Scene { model, n, step, .. } = &row.scene;
        let Row { method, count, time, failures, median_error, worst_error, worst_width, .. } = row;
        if method == ours::NAME {
            own = time.best;
        }
        println!(
            "| {model} | {n} | {step} | {count} | {method} | {:.0} | {:.2} | {failures} | {median_error:.1e} | \
            {worst_error:.1e} | {worst_width:.1e} |",
            time.best,
            time.best / own
        );
    }
}
