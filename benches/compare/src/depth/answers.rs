//! The depths that a method says of a case, a line a pose, each written at once, so that a crash costs one pose. The protocol is
//! that of benches/stability/depths.py.

use std::io::{Write, stdout};
use std::path::Path;
use std::rc::Rc;

use swiftprox::math::Vector;
use swiftprox::mesh::PolygonMesh;
use swiftprox::pair::{DepthAnswer, DepthCache, DepthConfig, Outcome, Placed, depth};
use swiftprox::shape::{InputPolicy, Shape, ShapeOptions};

use super::ours;
use super::parry::Contact;
use crate::method::Method;
use crate::parry::Rings;
use crate::peers::{self, Asked};
use crate::setting::poses_of;
use testkit::PosePair;
use testkit::files::read_poses;

/// Of the exact hulls of two meshes.
///
/// # Errors
/// A message about the file that cannot be read, the method that is not there, or the body that it refuses.
pub fn run([method, a, b, poses]: &[String; 4]) -> Result<(), String> {
    let shapes = [read(a)?, read(b)?];
    let hulls = [hull(&shapes[0])?, hull(&shapes[1])?];
    let poses = read_poses(Path::new(poses), usize::MAX)?;
    let bodies = [&hulls[0], &hulls[1]];
    if method == ours::NAME {
        own(&shapes, bodies, &poses);
    } else if method == "parry-hc" {
        let mut parry = Contact::new(hulls.each_ref().map(|hull| Rc::new(Rings::new(hull))));
        answer_all(&mut parry, bodies, &poses, |parry| parry.normal());
    } else {
        let peer = peers::named(Asked::Depth, method, bodies)
            .ok_or_else(|| format!("{method}: not there, or refuses a body"))?;
        answer_all(&mut { peer }, bodies, &poses, |peer| peer.normal());
    }
    Ok(())
}

fn read(path: &str) -> Result<Shape, String> {
    let options = ShapeOptions { input: InputPolicy::Hull, ..ShapeOptions::default() };
    Shape::from_file(Path::new(path), &options).map_err(|e| e.to_string())
}

fn hull(shape: &Shape) -> Result<PolygonMesh, String> {
    let polyhedron = shape.polyhedron();
    let vertices = polyhedron.vertices.iter().map(|vertex| vertex.position + polyhedron.centre).collect();
    PolygonMesh::new(vertices, polyhedron.triangles.as_flattened().to_vec(), None).map_err(|e| e.to_string())
}

/// Behind the depth and the overlap along the normal this library's line has the interval.
fn own(shapes: &[Shape; 2], hulls: [&PolygonMesh; 2], poses: &[PosePair]) {
    let (mut cache, mut answer) = (DepthCache::default(), DepthAnswer::default());
    say("ready pair::depth, defaults");
    for (pose, [pose1, pose2]) in poses.iter().zip(poses_of(poses)) {
        let bodies = [Placed { shape: &shapes[0], pose: &pose1 }, Placed { shape: &shapes[1], pose: &pose2 }];
        let done = depth(bodies, &mut cache, &DepthConfig::default(), &mut answer);
        match (done, answer.outcome) {
            (Ok(()), Outcome::Intersecting) => {
                let along = overlap(hulls, pose, answer.normal);
                say(&format!("depth {:e} {along:e} {:e} {:e}", answer.depth, answer.lower, answer.upper));
            }
            (Ok(()), _) => say("separated"),
            (Err(_), _) => say("failed"),
        }
    }
}

fn answer_all<M: Method>(
    method: &mut M,
    hulls: [&PolygonMesh; 2],
    poses: &[PosePair],
    normal: impl Fn(&M) -> [f64; 3],
) {
    method.load(poses);
    method.forget();
    say(&format!("ready {}", method.name()));
    for (i, pose) in poses.iter().enumerate() {
        method.ask(i);
        let depth = method.reply().distance;
        if depth == 0.0 {
            say("separated");
        } else if depth.is_nan() {
            say("failed");
        } else {
            say(&format!("depth {depth:e} {:e}", overlap(hulls, pose, normal(method))));
        }
    }
}

/// By how much two hulls overlap along a direction or its opposite, as plain doubles tell; NaN of none.
fn overlap(hulls: [&PolygonMesh; 2], pose: &PosePair, normal: [f64; 3]) -> f64 {
    let along = Vector::from(normal);
    let along = along / along.norm();
    let [first, second] = [0, 1].map(|i| {
        let m = &pose[12 * i..12 * i + 12];
        let own = Vector::from(std::array::from_fn(|k| m[k] * along.x + m[4 + k] * along.y + m[8 + k] * along.z));
        let at = m[3] * along.x + m[7] * along.y + m[11] * along.z;
        let heights = hulls[i].vertices.iter().map(|vertex| own.dot(vertex) + at);
        heights.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], height| [low.min(height), high.max(height)])
    });
    let [forth, back] = [first[1] - second[0], second[1] - first[0]];
    if along.norm().is_nan() { f64::NAN } else { forth.min(back) }
}

fn say(line: &str) {
    let mut out = stdout();
    // A reader that has gone away wants no more.
    let _ = writeln!(out, "{line}").and_then(|()| out.flush());
}
