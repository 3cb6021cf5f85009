//! Box3D's manifold of two hulls, in single precision, from the vendored sources of boxddd-sys.

use boxddd_sys::ffi::{
    b3CollideHulls, b3CreateHull, b3DestroyHull, b3HullData, b3LocalManifold, b3LocalManifoldPoint, b3Quat, b3SATCache,
    b3Transform, b3Vec3,
};
use swiftprox::mesh::PolygonMesh;

use crate::method::{Method, Reply};
use crate::parry::pose_pair;
use testkit::PosePair;

/// Room for points, as Box3D's own contacts have it.
const ROOM: usize = 32;
/// A hull has at most so many vertices, and half-edges (`constants.h`).
const MOST: usize = 128;

pub struct Box3d {
    hulls: [Hull; 2],
    poses: Vec<[b3Transform; 2]>,
    points: Box<[b3LocalManifoldPoint; ROOM]>,
    manifold: b3LocalManifold,
    cache: b3SATCache,
}

/// Freed once.
struct Hull(*mut b3HullData);

impl Hull {
    /// None where Box3D would take fewer vertices than there are.
    fn new(mesh: &PolygonMesh) -> Option<Hull> {
        let count = mesh.vertices.len();
        if count > MOST {
            return None;
        }
        let points: Vec<b3Vec3> = mesh.vertices.iter().map(|v| vector([v.x, v.y, v.z])).collect();
        // SAFETY: so many points are there, and are copied.
        let hull = unsafe { b3CreateHull(points.as_ptr(), count as i32, count as i32) };
        let made = (!hull.is_null()).then(|| Hull(hull))?;
        // SAFETY: it was just made.
        (unsafe { (*made.0).vertexCount } == count as i32).then_some(made)
    }
}

impl Drop for Hull {
    fn drop(&mut self) {
        // SAFETY: made by `b3CreateHull`, freed once.
        unsafe { b3DestroyHull(self.0) }
    }
}

impl Box3d {
    /// None of bodies that Box3D does not take whole.
    pub fn new(meshes: [&PolygonMesh; 2]) -> Option<Box3d> {
        let hulls = [Hull::new(meshes[0])?, Hull::new(meshes[1])?];
        // SAFETY: all their members are numbers and pointers, of which zeros are values.
        let (points, manifold, cache) = unsafe { std::mem::zeroed() };
        Some(Box3d { hulls, poses: Vec::new(), points: Box::new(points), manifold, cache })
    }
}

impl Method for Box3d {
    fn name(&self) -> &str {
        "box3d-manifold"
    }

    fn load(&mut self, poses: &[PosePair]) {
        let of = |pose: parry3d_f64::math::Pose| {
            let (at, turned) = (pose.translation.to_array(), pose.rotation.to_array());
            let [x, y, z, s] = turned.map(|part| part as f32);
            b3Transform { p: vector(at), q: b3Quat { v: b3Vec3 { x, y, z }, s } }
        };
        self.poses = poses.iter().map(|pair| <[_; 2]>::from(pose_pair(pair)).map(of)).collect();
    }

    fn forget(&mut self) {
        // SAFETY: as above.
        self.cache = unsafe { std::mem::zeroed() };
    }

    #[inline]
    fn ask(&mut self, i: usize) {
        let [a, b] = &self.poses[i];
        self.manifold.points = self.points.as_mut_ptr();
        // SAFETY: the hulls live as long as self, and there is room for so many points.
        unsafe {
            let [first, second] = [&self.hulls[0], &self.hulls[1]];
            b3CollideHulls(&mut self.manifold, ROOM as i32, first.0, second.0, between(a, b), &mut self.cache);
        }
    }

    fn reply(&self) -> Reply {
        let points = &self.points[..self.manifold.pointCount as usize];
        let deepest = points.iter().map(|point| -point.separation).fold(f32::NAN, f32::max);
        Reply::of(deepest.into())
    }
}

fn vector([x, y, z]: [f64; 3]) -> b3Vec3 {
    b3Vec3 { x: x as f32, y: y as f32, z: z as f32 }
}

/// `b3InvMulTransforms`, which is inline in C: b in the frame of a.
fn between(a: &b3Transform, b: &b3Transform) -> b3Transform {
    let cross =
        |u: b3Vec3, v: b3Vec3| b3Vec3 { x: u.y * v.z - u.z * v.y, y: u.z * v.x - u.x * v.z, z: u.x * v.y - u.y * v.x };
    let dot = |u: b3Vec3, v: b3Vec3| u.x * v.x + u.y * v.y + u.z * v.z;
    let plus = |u: b3Vec3, s: f32, v: b3Vec3| b3Vec3 { x: u.x + s * v.x, y: u.y + s * v.y, z: u.z + s * v.z };
    let offset = plus(b.p, -1.0, a.p);
    let twice = cross(a.q.v, offset);
    let p = plus(plus(offset, -2.0 * a.q.s, twice), 2.0, cross(a.q.v, twice));
    let across = cross(b.q.v, a.q.v);
    let v = plus(plus(across, a.q.s, b.q.v), -b.q.s, a.q.v);
    b3Transform { p, q: b3Quat { v, s: a.q.s * b.q.s + dot(a.q.v, b.q.v) } }
}
