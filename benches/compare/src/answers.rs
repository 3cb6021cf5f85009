//! Parry's answers, a line a pose, each written at once, so that a panic costs one pose. The protocol is that of
//! benches/stability/stability.py.

use std::io::{Write, stdout};
use std::path::Path;
use std::rc::Rc;

use parry3d_f64::math::{Pose, Vector};
use parry3d_f64::query;
use parry3d_f64::shape::ConvexPolyhedron;
use swiftprox::mesh::PolygonMesh;
use swiftprox::mesh_io::read_mesh;

use crate::method::Method;
use crate::parry::{Climbing, Parry, Rings, pose_pair};
use testkit::PosePair;
use testkit::files::read_poses;

const PARRY: &str = env!("PARRY");

/// Of parry's own shape and queries (`parry`), the same with the hull made by parry (`parry-hull`), or of the benchmark's support
/// map (`parry-hc`). The files hold exact hulls.
///
/// # Errors
/// A message about the file that cannot be read, or the body that parry refuses.
pub fn run([method, a, b, poses]: &[String; 4]) -> Result<(), String> {
    let meshes = [read(a)?, read(b)?];
    let poses = read_poses(Path::new(poses), usize::MAX)?;
    match method.as_str() {
        "parry" => stock([own_triangles(&meshes[0])?, own_triangles(&meshes[1])?], "from_convex_mesh", &poses),
        "parry-hull" => stock([hull(&meshes[0])?, hull(&meshes[1])?], "from_convex_hull", &poses),
        "parry-hc" => hill_climbing(&meshes, &poses),
        _ => return Err(format!("{method}: no such method")),
    }
    Ok(())
}

fn read(path: &str) -> Result<PolygonMesh, String> {
    read_mesh(Path::new(path)).map_err(|e| e.to_string())
}

fn points(mesh: &PolygonMesh) -> Vec<Vector> {
    mesh.vertices.iter().map(|v| Vector::new(v.x, v.y, v.z)).collect()
}

/// What parry offers for a mesh that is convex.
fn own_triangles(mesh: &PolygonMesh) -> Result<ConvexPolyhedron, String> {
    let (triangles, []) = mesh.indices.as_chunks::<3>() else {
        return Err("parry is given triangles only".into());
    };
    ConvexPolyhedron::from_convex_mesh(points(mesh), triangles).ok_or("from_convex_mesh makes nothing of it".into())
}

/// What parry offers for points.
fn hull(mesh: &PolygonMesh) -> Result<ConvexPolyhedron, String> {
    ConvexPolyhedron::from_convex_hull(&points(mesh)).ok_or("from_convex_hull makes nothing of it".into())
}

fn stock(bodies: [ConvexPolyhedron; 2], maker: &str, poses: &[PosePair]) {
    let [first, second] = bodies;
    let answer = |(pose1, pose2): (Pose, Pose)| -> Result<Option<f64>, query::Unsupported> {
        let meet = query::intersection_test(&pose1, &first, &pose2, &second)?.intersecting;
        Ok(if meet { None } else { Some(query::distance(&pose1, &first, &pose2, &second)?.distance) })
    };
    say(&format!("ready parry3d-f64 {PARRY}, ConvexPolyhedron::{maker}, query::intersection_test, query::distance"));
    for pose in poses {
        match answer(pose_pair(pose)) {
            Ok(None) => say("intersecting"),
            Ok(Some(distance)) => say(&format!("separated {distance:e}")),
            Err(_) => say("failed"),
        }
    }
}

/// The benchmark's method, its memory kept from pose to pose.
fn hill_climbing(meshes: &[PolygonMesh; 2], poses: &[PosePair]) {
    let rings = meshes.each_ref().map(|mesh| Rc::new(Rings::new(mesh)));
    let mut parry = Parry::new(rings, Climbing::First);
    parry.load(poses);
    say(&format!("ready parry3d-f64 {PARRY}, GJK with a support map that climbs, last direction handed back in"));
    for i in 0..poses.len() {
        parry.ask(i);
        let distance = parry.reply().distance;
        if distance == 0.0 {
            say("intersecting");
        } else {
            say(&format!("separated {distance:e}"));
        }
    }
}

fn say(line: &str) {
    let mut out = stdout();
    // A reader that has gone away wants no more.
    let _ = writeln!(out, "{line}").and_then(|()| out.flush());
}
