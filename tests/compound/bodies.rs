//! Bodies of several pieces, and all pairs of them by brute force.

use std::sync::Arc;
use swiftprox::compound::{Compound, Piece, PlacedCompound};
use swiftprox::math::{Matrix, Pose, Vector};
use swiftprox::pair::Placed;
use testkit::oracle::{Polytope, Truth, truth};
use testkit::random::Random;
use testkit::shapes::hull;

/// Pieces and the points that they were made of.
pub struct Body {
    pub compound: Compound,
    clouds: Vec<Vec<Vector>>,
}

impl Body {
    pub fn new(parts: Vec<(Vec<Vector>, Pose)>) -> Body {
        let pieces: Vec<Piece> =
            parts.iter().map(|(points, pose)| Piece { shape: Arc::new(hull(points)), pose: *pose }).collect();
        let compound = Compound::new(&pieces).unwrap();
        Body { compound, clouds: parts.into_iter().map(|(points, _)| points).collect() }
    }
}

/// The corners of a ring's sector with a square cross-section.
fn wedge(count: usize, k: usize) -> Vec<Vector> {
    let corner = |step: usize, radius: f64, z: f64| {
        let angle = std::f64::consts::TAU * step as f64 / count as f64;
        Vector::new(radius * angle.cos(), radius * angle.sin(), z)
    };
    [k, k + 1].iter().flat_map(|step| [0.7, 1.3].map(|r| [-0.3, 0.3].map(|z| corner(*step, r, z)))).flatten().collect()
}

/// A torus of wedges.
pub fn torus(count: usize) -> Body {
    Body::new((0..count).map(|k| (wedge(count, k), Pose::IDENTITY)).collect())
}

/// The same, each wedge about its own origin and placed there.
pub fn placed_torus(count: usize) -> Body {
    let placed = |k: usize| {
        let turn = testkit::random::rotation(&Vector::z(), std::f64::consts::TAU * k as f64 / count as f64);
        let centre = turn * Vector::x();
        let points = wedge(count, 0).iter().map(|p| p - Vector::x()).collect();
        (points, Pose::new(&turn, &centre))
    };
    Body::new((0..count).map(placed).collect())
}

/// A gear: a hub of sectors with a tooth on each.
pub fn gear(teeth: usize) -> Body {
    let sector = |k: usize, from: f64, to: f64, radii: [f64; 2]| {
        let corner = |step: f64, radius: f64, z: f64| {
            let angle = std::f64::consts::TAU * (k as f64 + step) / teeth as f64;
            Vector::new(radius * angle.cos(), radius * angle.sin(), z)
        };
        [from, to].iter().flat_map(|s| radii.map(|r| [-0.15, 0.15].map(|z| corner(*s, r, z)))).flatten().collect()
    };
    let parts = (0..teeth).flat_map(|k| [sector(k, 0.0, 1.0, [0.4, 0.9]), sector(k, 0.2, 0.6, [0.85, 1.1])]);
    Body::new(parts.map(|points: Vec<Vector>| (points, Pose::IDENTITY)).collect())
}

/// A few hulls of a few points; some placed, some flat.
pub fn any(random: &mut Random, count: usize) -> Body {
    let part = |random: &mut Random| {
        let size = random.uniform(0.1, 0.6);
        let points = 4 + random.below(4);
        let flat = if random.below(6) == 0 { 0.0 } else { 1.0 };
        let axes = Vector::new(1.0, random.uniform(0.2, 1.0), flat) * size;
        let middle = random.vector();
        let points: Vec<Vector> = (0..points).map(|_| random.vector().component_mul(&axes) + middle).collect();
        let pose = match random.below(3) {
            0 => Pose::IDENTITY,
            1 => Pose::new(&Matrix::identity(), &random.vector()),
            _ => Pose::new(&random.rotation(), &random.vector()),
        };
        (points, pose)
    };
    Body::new((0..count).map(|_| part(random)).collect())
}

/// Any pose, now and then one that is skewed or far from the origin.
pub fn pose(random: &mut Random, size: f64) -> Pose {
    let skew = [0.0, 1e-7, 2e-3][[0, 0, 0, 1, 2][random.below(5)]];
    let skewed = Matrix::identity() + Matrix::from_diagonal(&(random.vector() * skew));
    Pose::new(&(random.rotation() * skewed), &(random.vector() * size))
}

/// Where a piece is: the product of both poses, each number rounded; the pose of the body for one at the identity.
pub fn placed(body: PlacedCompound, k: usize) -> Pose {
    let own = body.compound.pieces()[k].pose;
    if own == Pose::IDENTITY {
        return *body.pose;
    }
    Pose::new(&(body.pose.rotation() * own.rotation()), &body.pose.transform(&own.translation()))
}

/// All pairs of pieces where they are.
pub fn for_each_pair(bodies: [PlacedCompound; 2], mut work: impl FnMut([u32; 2], [Placed; 2])) {
    let [one, two] = bodies;
    for (i, piece1) in one.compound.pieces().iter().enumerate() {
        let pose1 = placed(one, i);
        for (j, piece2) in two.compound.pieces().iter().enumerate() {
            let pose2 = placed(two, j);
            work([i as u32, j as u32], [piece1.shape.at(&pose1), piece2.shape.at(&pose2)]);
        }
    }
}

/// The truth about two bodies in rational numbers: the least over all pairs of pieces.
pub fn least_truth(bodies: [&Body; 2], poses: [&Pose; 2]) -> Truth {
    let rows = |pose: &Pose| std::array::from_fn(|k| pose.rows[k / 4][k % 4]);
    let polytopes = bodies.map(|body| {
        let polytope = |cloud: &Vec<Vector>| Polytope::new(&cloud.iter().map(|p| (*p).into()).collect::<Vec<_>>());
        body.clouds.iter().map(polytope).collect::<Vec<_>>()
    });
    let mut least: Option<Truth> = None;
    for (i, one) in polytopes[0].iter().enumerate() {
        for (j, two) in polytopes[1].iter().enumerate() {
            let places = [placed(bodies[0].compound.at(poses[0]), i), placed(bodies[1].compound.at(poses[1]), j)];
            let found = truth(one, &rows(&places[0]), two, &rows(&places[1]));
            if least.as_ref().is_none_or(|least| found.squared_distance < least.squared_distance) {
                least = Some(found);
            }
        }
    }
    least.unwrap()
}
