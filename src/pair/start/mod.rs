//! The start of marching: a policy chooses its source; look-ups or a climb then lead to a vertex of each body.

mod start_pair;
pub mod policy;
mod alternate;
mod farthest;

use crate::body::polyhedron::lookup::{Plan, Table};
use crate::body::tables::nearest_vertex::AllVertices;
use crate::body::tables::table;
use crate::placed::Pair;
use alternate::LookUps;
use farthest::farthest;
use policy::{StartFrom, centre_of_mass};
pub use start_pair::{Guess, StartPair};

/// The start that `from` prescribes, as far as both bodies have tables for it, or one of them has and the other needs none.
/// Otherwise it is at the vertices farthest along the line of the bodies' origins.
#[inline(always)]
pub fn start_pair(pair: &Pair, from: StartFrom) -> StartPair {
    match from {
        StartFrom::Farthest => farthest(pair),
        StartFrom::Centres => look_up(pair, [0; 2], u32::MAX),
        StartFrom::LastVertices { vertices, rounds } => look_up(pair, vertices, rounds),
    }
}

/// At most `rounds` rounds of look-ups from the vertices `last`; where the centres of mass take no more, from these.
#[inline(never)]
fn look_up(pair: &Pair, last: [u32; 2], rounds: u32) -> StartPair {
    let Pair { polyhedra, poses } = *pair;
    let [body1, body2] = polyhedra;
    let from = LookUps { pair: *pair, last, most_rounds: rounds };
    // Returned from where it is found (R1).
    match [body1.lookup.plan, body2.lookup.plan] {
        [Plan::Shells { .. }, Plan::Shells { .. }] => {
            if let (Table::Shells(first), Table::Shells(second)) = (table(body1), table(body2)) {
                return from.alternate(first, second);
            }
        }
        [Plan::AllVertices { rounds: wanted }, Plan::Shells { .. }] => {
            if let Table::Shells(second) = table(body2) {
                let first = &AllVertices { polyhedron: body1, rounds: wanted };
                return from.alternate(first, second);
            }
        }
        [Plan::Shells { .. }, Plan::AllVertices { rounds: wanted }] => {
            if let Table::Shells(first) = table(body1) {
                let second = &AllVertices { polyhedron: body2, rounds: wanted };
                return from.alternate(first, second);
            }
        }
        [Plan::Spherical { .. }, Plan::Spherical { .. }] => {
            if let (Table::Spherical(first), Table::Spherical(second)) = (table(body1), table(body2)) {
                let between = centre_of_mass(body2, poses[1]) - centre_of_mass(body1, poses[0]);
                let vertices =
                    [first.towards(&poses[0].rotate_back(&between)), second.towards(&poses[1].rotate_back(&-between))];
                return StartPair::new(vertices, Guess::Unclear);
            }
        }
        _ => {}
    }
    farthest(pair)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::base::math::{Pose, Vector};
    use crate::body::build::assembly::build;
    use crate::body::tables::{LookupOptions, plan_lookup};
    use swiftprox::random::Random;

    /// Climbs on small bodies took half the time of their queries after a jump.
    #[test]
    fn small_bodies_start_at_their_farthest_vertices() {
        let mut random = Random::new(31);
        for count in [4, 7, 8, 9, 16, 25] {
            let size = random.power(-40, 40);
            let points: Vec<Vector> = (0..count).map(|_| random.direction() * size).collect();
            let mut polyhedron = build(&points, None).unwrap();
            polyhedron.lookup = plan_lookup(&polyhedron, &LookupOptions::DEFAULT).unwrap();
            assert!(matches!(table(&polyhedron), Table::AllVertices(_)));
            for _ in 0..50 {
                let [pose1, pose2] = [(); 2].map(|()| Pose::new(&random.rotation(), &(3.0 * size * random.vector())));
                let origin = |pose: &Pose| pose.transform(&polyhedron.centre);
                let between = origin(&pose2) - origin(&pose1);
                let start =
                    start_pair(&Pair { polyhedra: [&polyhedron; 2], poses: [&pose1, &pose2] }, StartFrom::Farthest);
                for (vertex, towards) in
                    start.vertices().into_iter().zip([pose1.rotate_back(&between), pose2.rotate_back(&-between)])
                {
                    let heights: Vec<f64> = polyhedron.vertices.iter().map(|v| v.position.dot(&towards)).collect();
                    let highest = heights.iter().copied().fold(f64::NEG_INFINITY, f64::max);
                    assert!(heights[vertex as usize] >= highest - 1e-6 * size * between.norm(), "{count} {size}");
                }
            }
        }
    }
}
