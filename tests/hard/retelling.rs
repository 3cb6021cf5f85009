//! The same pair told another way has the same verdict, and intervals with a common point: the objects swapped, vertices and
//! faces in another order, frames turned and moved without rounding. Where a motion rounds, the distance may change by
//! 1e-12·L + 2e-15·W.

use swiftprox::math::{Matrix, Pose, Vector};
use swiftprox::mesh::PolygonMesh;
use swiftprox::pair::PairCache;
use swiftprox::shape::{InputPolicy, Shape, ShapeOptions};

use crate::{Flight, ask, contradiction};
use testkit::cases::Random;
use testkit::hard::flight::poses;
use testkit::retold::{extent, mirror, mirrored, product, reframed, renumbered, shifted_exactly};

/// Tells every pose of a flight in other ways. How many of them could be moved without rounding.
pub fn check(flight: &mut Flight) -> usize {
    let mut shifted = 0;
    let mut random = flight.random(0x9000);
    let (shapes, bodies) = (flight.shapes, &flight.sequence.bodies);
    let [other1, other2] = bodies.each_ref().map(|body| shape(&renumbered(body, &mut random)));
    let turn = random.quarter_turns();
    let turned = shape(&mapped(&bodies[0], &turn));
    let [mirrored1, mirrored2] = bodies.each_ref().map(|body| shape(&mapped(body, &mirror())));
    for (number, pair) in flight.sequence.poses.iter().enumerate() {
        let placed = &poses(pair);
        let [pose1, pose2] = placed;
        let answer = ask(shapes, [pose1, pose2], &mut PairCache::default());
        let mut compare = |what: &str, shapes: [&Shape; 2], poses: [&Pose; 2]| {
            let other = ask(shapes, poses, &mut PairCache::default());
            if let Some(difference) = contradiction(&answer, &other) {
                flight.violated(number, format!("{what}: {difference}"));
            }
        };
        compare("swapped objects", [shapes[1], shapes[0]], [pose2, pose1]);
        compare("other numbers", [&other1, &other2], [pose1, pose2]);
        compare("one frame turned by quarters", [&turned, shapes[1]], [&reframed(&turn, pose1), pose2]);
        compare("everything mirrored", [&mirrored1, &mirrored2], [&mirrored(pose1), &mirrored(pose2)]);
        let turn = random.quarter_turns();
        compare("the world turned by quarters", shapes, [&product(&turn, pose1), &product(&turn, pose2)]);
        let step = exact_step(placed, &mut random);
        if let [Some(moved1), Some(moved2)] = [pose1, pose2].map(|pose| shifted_exactly(pose, &step)) {
            compare("a translation", shapes, [&moved1, &moved2]);
            shifted += 1;
        }
        // Any other motion, which rounds.
        let turn = random.rotation();
        let (size, reach) = extent(points(bodies), [pose1, pose2]);
        let step = size * random.power(-3, 10) * random.vector();
        let moved = |pose: &Pose| Pose::new(&(turn * pose.rotation()), &(turn * pose.translation() + step));
        let [moved1, moved2] = [moved(pose1), moved(pose2)];
        let (_, other_reach) = extent(points(bodies), [&moved1, &moved2]);
        let band = 1e-12 * size + 2e-15 * reach.max(other_reach);
        let other = ask(shapes, [&moved1, &moved2], &mut PairCache::default());
        if answer.lower - other.upper > band || other.lower - answer.upper > band {
            flight.violated(number, format!("a motion changes more than {band:e}: {answer:?}\nto {other:?}"));
        }
    }
    shifted
}

fn points(bodies: &[PolygonMesh; 2]) -> [&[Vector]; 2] {
    [&bodies[0].vertices, &bodies[1].vertices]
}

fn shape(mesh: &PolygonMesh) -> Shape {
    let options = ShapeOptions { input: InputPolicy::Hull, ..ShapeOptions::default() };
    Shape::from_mesh(mesh, &options).expect("bodies that the library admits")
}

/// A body under a signed permutation; a mirrored one has its faces the other way round.
fn mapped(mesh: &PolygonMesh, by: &Matrix) -> PolygonMesh {
    let mut mesh = mesh.clone();
    mesh.vertices.iter_mut().for_each(|v| *v = by * *v);
    if by.determinant() < 0.0 {
        for f in 0..mesh.face_count() {
            let (first, last) = (mesh.starts[f] as usize, mesh.starts[f + 1] as usize);
            mesh.indices[first..last].reverse();
        }
    }
    mesh
}

/// A translation that often rounds nothing: a few units in one of the last places of the coordinates.
fn exact_step(poses: &[Pose; 2], random: &mut Random) -> Vector {
    let largest = poses.iter().map(|pose| pose.translation().amax()).fold(f64::MIN_POSITIVE, f64::max);
    let unit = 2f64.powi(largest.log2().floor() as i32 - [50, 20, 1][random.below(3)]);
    unit * random.lattice(3)
}
