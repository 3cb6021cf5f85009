//! Casters in C++, each behind the functions of peer.h.

use std::ffi::c_void;

use swiftprox::mesh::PolygonMesh;

use super::scenes::Scene;
use super::{Caster, Said};
use crate::peers::Mesh;

/// Its functions under the names of one library.
pub struct Functions {
    pub create: unsafe extern "C" fn(*const Mesh, *const f64, usize) -> *mut c_void,
    pub ask: unsafe extern "C" fn(*mut c_void, usize) -> f64,
    pub free: unsafe extern "C" fn(*mut c_void),
}

pub struct Native {
    name: &'static str,
    functions: Functions,
    peer: *mut c_void,
    /// Of each motion those of both bodies at the beginning and at the end; the peer looks at them.
    _poses: Vec<f64>,
}

impl Native {
    pub fn new(name: &'static str, functions: Functions, scene: &Scene) -> Result<Native, String> {
        let ends = scene.cases.iter().flat_map(|case| [case.poses(0.0), case.poses(1.0)]);
        let poses: Vec<f64> = ends.flatten().flat_map(|pose| pose.rows.as_flattened().to_vec()).collect();
        let arrays = [0, 1].map(|k| arrays(&scene.meshes[k]));
        let meshes = [0, 1].map(|k| {
            let (vertices, corners): &(Vec<f64>, Vec<u32>) = &arrays[k];
            Mesh::new(vertices, corners, 0.0)
        });
        // SAFETY: two meshes, and so many poses as 48 numbers a motion are, which live as long as the peer.
        let peer = unsafe { (functions.create)(meshes.as_ptr(), poses.as_ptr(), scene.cases.len()) };
        if peer.is_null() {
            return Err(format!("{name} refuses {}", scene.name));
        }
        Ok(Native { name, functions, peer, _poses: poses })
    }
}

/// Coordinates, and the corners of triangles.
fn arrays(mesh: &PolygonMesh) -> (Vec<f64>, Vec<u32>) {
    let faces = (0..mesh.face_count()).map(|f| mesh.face(f));
    let corners = faces.flat_map(|face| (2..face.len()).flat_map(move |k| [face[0], face[k - 1], face[k]]));
    (mesh.vertices.iter().flat_map(|v| [v.x, v.y, v.z]).collect(), corners.collect())
}

impl Drop for Native {
    fn drop(&mut self) {
        // SAFETY: made by create and freed once.
        unsafe { (self.functions.free)(self.peer) }
    }
}

impl Caster for Native {
    fn name(&self) -> &str {
        self.name
    }

    fn cast(&mut self, motion: usize) -> Said {
        // SAFETY: made by create, of more motions than that.
        match unsafe { (self.functions.ask)(self.peer, motion) } {
            time if time.is_nan() => Said::Unknown,
            time if time > 1.0 => Said::Free,
            time => Said::Hit(time),
        }
    }
}
