//! Box3D's time of impact of hulls of points, in single precision, of motions between the poses at both ends by the shorter turn.

use boxddd_sys::ffi::{
    b3Quat, b3ShapeProxy, b3Sweep, b3TOIInput, b3TOIState_b3_toiStateHit as HIT,
    b3TOIState_b3_toiStateOverlapped as OVERLAPPED, b3TOIState_b3_toiStateSeparated as SEPARATED, b3TimeOfImpact,
    b3Vec3,
};
use swiftprox::math::Pose;

use super::scenes::Scene;
use super::{Caster, Said};
use crate::parry::pose_of;

/// Box3D takes no more points (`B3_MAX_SHAPE_CAST_POINTS`).
const MOST: usize = 64;

pub struct TimeOfImpact {
    points: [Vec<b3Vec3>; 2],
    sweeps: Vec<[b3Sweep; 2]>,
}

impl TimeOfImpact {
    /// None of bodies that Box3D does not take whole.
    pub fn new(scene: &Scene) -> Option<TimeOfImpact> {
        if scene.meshes.iter().any(|mesh| mesh.vertices.len() > MOST) {
            return None;
        }
        let points = [0, 1].map(|k| scene.meshes[k].vertices.iter().map(|v| vector([v.x, v.y, v.z])).collect());
        let sweeps = scene.cases.iter().map(|case| {
            let [start, end] = [case.poses(0.0), case.poses(1.0)];
            [0, 1].map(|i| sweep([&start[i], &end[i]]))
        });
        Some(TimeOfImpact { points, sweeps: sweeps.collect() })
    }
}

impl Caster for TimeOfImpact {
    fn name(&self) -> &str {
        "box3d"
    }

    fn cast(&mut self, motion: usize) -> Said {
        let proxy =
            |points: &[b3Vec3]| b3ShapeProxy { points: points.as_ptr(), count: points.len() as i32, radius: 0.0 };
        let [sweep1, sweep2] = self.sweeps[motion];
        let input = b3TOIInput {
            proxyA: proxy(&self.points[0]),
            proxyB: proxy(&self.points[1]),
            sweepA: sweep1,
            sweepB: sweep2,
            maxFraction: 1.0,
        };
        // SAFETY: the points live as long as self, and are as many as said.
        let said = unsafe { b3TimeOfImpact(&input) };
        match said.state {
            HIT | OVERLAPPED => Said::Hit(said.fraction.into()),
            SEPARATED => Said::Free,
            _ => Said::Unknown,
        }
    }
}

/// About the local origin; turns whose quaternions are on one side go the shorter way.
fn sweep(poses: [&Pose; 2]) -> b3Sweep {
    let [first, last] = poses.map(|pose| pose_of(pose.rows.as_flattened()));
    let [from, mut to] = [first, last].map(|pose| pose.rotation.to_array());
    if from.iter().zip(&to).map(|(a, b)| a * b).sum::<f64>() < 0.0 {
        to = to.map(|part| -part);
    }
    let turned = |[x, y, z, s]: [f64; 4]| b3Quat { v: vector([x, y, z]), s: s as f32 };
    b3Sweep {
        localCenter: vector([0.0; 3]),
        c1: vector(first.translation.to_array()),
        c2: vector(last.translation.to_array()),
        q1: turned(from),
        q2: turned(to),
    }
}

fn vector([x, y, z]: [f64; 3]) -> b3Vec3 {
    b3Vec3 { x: x as f32, y: y as f32, z: z as f32 }
}
