//! parry's linear and nonlinear shape casts of its own convex polyhedra, and its time of impact of hulls of points.

use parry3d_f64::math::{Pose, Vector};
use parry3d_f64::query::sweep_toi::{Sweep, SweepToiStatus, ToiProxy, sweep_time_of_impact};
use parry3d_f64::query::{NonlinearRigidMotion, ShapeCastOptions, cast_shapes, cast_shapes_nonlinear};
use parry3d_f64::shape::ConvexPolyhedron;
use swiftprox::mesh::PolygonMesh;
use swiftprox::motion::{Motion, Screw};

use super::scenes::Scene;
use super::{Caster, Said};
use crate::parry::pose_of;

/// Its own form of a mesh.
pub fn polyhedron(mesh: &PolygonMesh) -> Result<ConvexPolyhedron, String> {
    let vertices = mesh.vertices.iter().map(|v| Vector::new(v.x, v.y, v.z)).collect();
    let faces = (0..mesh.face_count()).map(|f| mesh.face(f));
    let fan = |face: &[u32]| (2..face.len()).map(|k| [face[0], face[k - 1], face[k]]).collect::<Vec<_>>();
    let triangles: Vec<[u32; 3]> = faces.flat_map(fan).collect();
    ConvexPolyhedron::from_convex_mesh(vertices, &triangles).ok_or_else(|| "parry refuses a mesh".into())
}

fn polyhedra(scene: &Scene) -> Result<[ConvexPolyhedron; 2], String> {
    Ok([polyhedron(&scene.meshes[0])?, polyhedron(&scene.meshes[1])?])
}

/// The motion about the local origin; no scene has another.
fn motion(motion: &Motion) -> NonlinearRigidMotion {
    let vector = |v: &swiftprox::math::Vector| Vector::new(v.x, v.y, v.z);
    let (start, velocity, rotation) = match motion {
        Motion::Screw(Screw { start, velocity, rotation, .. }) => (start, vector(velocity), vector(rotation)),
        Motion::Fixed(pose) => (pose, Vector::ZERO, Vector::ZERO),
        Motion::Affine { .. } | Motion::Callback(_) => unreachable!("no scene has such a motion"),
    };
    NonlinearRigidMotion::new(pose_of(start.rows.as_flattened()), Vector::ZERO, velocity, rotation)
}

fn motions(scene: &Scene) -> Vec<[NonlinearRigidMotion; 2]> {
    scene.cases.iter().map(|case| [motion(&case.motions[0]), motion(&case.motions[1])]).collect()
}

/// `cast_shapes_nonlinear`.
pub struct Nonlinear {
    polyhedra: [ConvexPolyhedron; 2],
    motions: Vec<[NonlinearRigidMotion; 2]>,
}

impl Nonlinear {
    pub fn new(scene: &Scene) -> Result<Nonlinear, String> {
        Ok(Nonlinear { polyhedra: polyhedra(scene)?, motions: motions(scene) })
    }
}

impl Caster for Nonlinear {
    fn name(&self) -> &str {
        "parry-nonlinear"
    }

    fn cast(&mut self, motion: usize) -> Said {
        let ([first, second], [body1, body2]) = (&self.motions[motion], &self.polyhedra);
        match cast_shapes_nonlinear(first, body1, second, body2, 0.0, 1.0, true) {
            Ok(Some(hit)) => Said::Hit(hit.time_of_impact),
            Ok(None) => Said::Free,
            Err(_) => Said::Unknown,
        }
    }
}

/// `sweep_time_of_impact`, of motions between the poses at both ends by the shorter turn.
pub struct TimeOfImpact {
    points: [Vec<Vector>; 2],
    sweeps: Vec<[Sweep; 2]>,
}

/// How far apart bodies are in contact for it: its root finder stops within a quarter of it.
const SLOP: f64 = 1e-6;

impl TimeOfImpact {
    pub fn new(scene: &Scene) -> TimeOfImpact {
        let points = |k: usize| scene.meshes[k].vertices.iter().map(|v| Vector::new(v.x, v.y, v.z)).collect();
        let sweeps = scene.cases.iter().map(|case| {
            let [start, end] =
                [case.poses(0.0), case.poses(1.0)].map(|poses| poses.map(|p| pose_of(p.rows.as_flattened())));
            [0, 1].map(|i| Sweep::from_poses(&start[i], &end[i], Vector::ZERO))
        });
        TimeOfImpact { points: [points(0), points(1)], sweeps: sweeps.collect() }
    }
}

impl Caster for TimeOfImpact {
    fn name(&self) -> &str {
        "parry-sweep"
    }

    fn cast(&mut self, motion: usize) -> Said {
        let ([points1, points2], [sweep1, sweep2]) = (&self.points, &self.sweeps[motion]);
        let proxies = [ToiProxy::from_points(points1, 0.0), ToiProxy::from_points(points2, 0.0)];
        let said = sweep_time_of_impact(&proxies[0], sweep1, &proxies[1], sweep2, 1.0, SLOP);
        match said.status {
            SweepToiStatus::Hit | SweepToiStatus::Overlapped => Said::Hit(said.fraction),
            SweepToiStatus::Separated => Said::Free,
            SweepToiStatus::Failed => Said::Unknown,
        }
    }
}

/// `cast_shapes`, of motions that do not turn.
pub struct Linear {
    polyhedra: [ConvexPolyhedron; 2],
    /// Where both are, and how fast.
    motions: Vec<[(Pose, Vector); 2]>,
}

impl Linear {
    pub fn new(scene: &Scene) -> Result<Linear, String> {
        let straight = |motions: [NonlinearRigidMotion; 2]| motions.map(|motion| (motion.start, motion.linvel));
        Ok(Linear { polyhedra: polyhedra(scene)?, motions: motions(scene).into_iter().map(straight).collect() })
    }
}

impl Caster for Linear {
    fn name(&self) -> &str {
        "parry-linear"
    }

    fn cast(&mut self, motion: usize) -> Said {
        let ([(pose1, velocity1), (pose2, velocity2)], [body1, body2]) = (&self.motions[motion], &self.polyhedra);
        let options = ShapeCastOptions::with_max_time_of_impact(1.0);
        match cast_shapes(pose1, *velocity1, body1, pose2, *velocity2, body2, options) {
            Ok(Some(hit)) => Said::Hit(hit.time_of_impact),
            Ok(None) => Said::Free,
            Err(_) => Said::Unknown,
        }
    }
}
