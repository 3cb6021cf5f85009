//! parry's linear and nonlinear shape casts of its own convex polyhedra.

use parry3d_f64::math::{Pose, Vector};
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
