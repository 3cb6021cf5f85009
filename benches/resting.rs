//! Manifolds of four of pairs at rest, in one process: nanoseconds per query, the least of many passes. With a scene's name it runs
//! that alone, for callgrind.

use std::time::Instant;

use nalgebra::UnitQuaternion;
use swiftprox::error::Result;
use swiftprox::manifold::manifold;
use swiftprox::manifold::{ManifoldCache, ManifoldConfig, ManifoldPoint};
use swiftprox::math::{Matrix, Pose, Vector};
use swiftprox::shape::Shape;
use testkit::models;
use testkit::random::Random;
use testkit::shapes::{cuboid, hull};

const STEPS: usize = 600;

/// A body that rests on another, 1e-3 to 3e-3 deep, and moves by at most 0.1° and 1e-3 a step; its tilt jitters by 1e-4.
struct Scene {
    name: &'static str,
    bodies: [Shape; 2],
    aside: Vector,
    yaw: f64,
    moves: bool,
}

fn scenes() -> Result<Vec<Scene>> {
    let slab = || cuboid([2.0, 2.0, 0.5]);
    let cube = || cuboid([0.5; 3]);
    let drum = |sides: u32| -> Result<Shape> { Ok(hull(&models::prism(sides, 0.5)?.vertices)) };
    let mut random = Random::new(7);
    let around = |random: &mut Random| random.direction().component_mul(&Vector::new(0.6, 0.5, 0.45));
    let points: Vec<Vector> = (0..42).map(|_| around(&mut random)).collect();
    let aside = Vector::new(0.3, -0.2, 0.0);
    let scene = |name, bodies, aside, yaw, moves| Scene { name, bodies, aside, yaw, moves };
    Ok(vec![
        scene("box-moving", [slab(), cube()], aside, 0.0, true),
        scene("box-still", [slab(), cube()], aside, 0.0, false),
        scene("drum16", [slab(), drum(16)?], aside, 0.0, true),
        scene("drum32", [slab(), drum(32)?], aside, 0.0, true),
        scene("hull42", [slab(), hull(&points)], aside, 0.0, true),
        scene("box-box", [cube(), cube()], Vector::new(0.3, 0.2, 0.0), 0.4, true),
        scene("drum-drum", [drum(16)?, drum(16)?], Vector::new(0.3, 0.2, 0.0), 0.1, true),
    ])
}

impl Scene {
    fn poses(&self) -> Vec<[Pose; 2]> {
        let mut random = Random::new(11);
        let extreme = |shape: &Shape, turn: &Matrix, sign: f64| {
            let height = |vertex: &Vector| sign * (turn * vertex).z;
            let vertices = shape.polyhedron().vertices.iter();
            vertices.map(|vertex| height(&vertex.position)).fold(f64::NEG_INFINITY, f64::max) * sign
        };
        let about = |axis: Vector, angle: f64| UnitQuaternion::from_scaled_axis(axis * angle);
        let (mut turn, mut aside) = (about(Vector::z(), self.yaw), self.aside);
        (0..STEPS)
            .map(|_| {
                let (mut placed, mut deep) = (turn, 2e-3);
                if self.moves {
                    turn = UnitQuaternion::new_normalize(*(about(Vector::z(), 1.7e-3 * random.signed()) * turn));
                    let tilted = about(random.direction(), 1e-4 * random.signed()) * turn;
                    placed = UnitQuaternion::new_normalize(*tilted);
                    aside += Vector::new(random.signed(), random.signed(), 0.0) * 1e-3;
                    deep += 1e-3 * random.signed();
                }
                let placed: Matrix = placed.to_rotation_matrix().into_inner();
                let top = extreme(&self.bodies[0], &Matrix::identity(), 1.0);
                let height = top - extreme(&self.bodies[1], &placed, -1.0) - deep;
                let at = Vector::new(aside.x, aside.y, height);
                [Pose::new(&Matrix::identity(), &Vector::zeros()), Pose::new(&placed, &at)]
            })
            .collect()
    }
}

fn main() -> Result<()> {
    let arguments: Vec<String> = std::env::args().skip(1).filter(|argument| argument != "--bench").collect();
    let passes = if arguments.is_empty() { 60 } else { 1 };
    let config = ManifoldConfig { reduces: true, ..ManifoldConfig::default() };
    for scene in scenes()? {
        if !arguments.is_empty() && !arguments.iter().any(|argument| argument == scene.name) {
            continue;
        }
        let poses = scene.poses();
        let (mut points, mut cache) = ([ManifoldPoint::default(); 4], ManifoldCache::default());
        let (mut least, mut found) = (f64::INFINITY, 0);
        for _ in 0..passes {
            let begin = Instant::now();
            for [pose1, pose2] in &poses {
                let bodies = [scene.bodies[0].at(pose1), scene.bodies[1].at(pose2)];
                found += manifold(bodies, &mut cache, &config, &mut points)?.found_count;
            }
            least = least.min(begin.elapsed().as_secs_f64());
        }
        println!("{}: {:.0} ns, {} points found", scene.name, least * 1e9 / STEPS as f64, found);
    }
    Ok(())
}
