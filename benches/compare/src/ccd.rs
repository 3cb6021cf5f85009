//! libccd's MPR (minkowski portal refinement) at its default tolerance of 1e-4, with a support function that climbs from the
//! last support vertex. It says the verdict alone.

use swiftprox::mesh::PolygonMesh;

use crate::method::{Method, Reply};
use testkit::PosePair;

#[repr(C)]
struct Body {
    _opaque: [u8; 0],
}

unsafe extern "C" {
    fn ccd_shim_body(
        coordinates: *const f64,
        vertex_count: usize,
        corners: *const u32,
        triangle_count: usize,
    ) -> *mut Body;
    fn ccd_shim_free(body: *mut Body);
    fn ccd_shim_mpr(body: *const Body, poses: *const f64, last: *mut u32) -> i32;
}

pub struct Mpr {
    body: *mut Body,
    poses: Vec<PosePair>,
    last: [u32; 2],
    intersecting: bool,
}

impl Mpr {
    /// Of a triangle mesh.
    pub fn new(mesh: &PolygonMesh) -> Mpr {
        let coordinates: Vec<f64> = mesh.vertices.iter().flat_map(|v| [v.x, v.y, v.z]).collect();
        assert_eq!(mesh.indices.len(), 3 * mesh.face_count(), "libccd's support function is given triangles only");
        // SAFETY: the pointers are to arrays of the lengths that are passed; the shim copies them.
        let body = unsafe {
            ccd_shim_body(coordinates.as_ptr(), mesh.vertices.len(), mesh.indices.as_ptr(), mesh.face_count())
        };
        assert!(!body.is_null(), "there is memory");
        Mpr { body, poses: Vec::new(), last: [0; 2], intersecting: false }
    }
}

impl Drop for Mpr {
    fn drop(&mut self) {
        // SAFETY: made by ccd_shim_body and freed once.
        unsafe { ccd_shim_free(self.body) }
    }
}

impl Method for Mpr {
    fn name(&self) -> &str {
        "libccd-mpr"
    }

    fn load(&mut self, poses: &[PosePair]) {
        self.poses = poses.to_vec();
    }

    fn forget(&mut self) {
        self.last = [0; 2];
    }

    #[inline]
    fn ask(&mut self, i: usize) {
        // SAFETY: `body` lives as long as self, the poses are 24 numbers, `last` holds two vertices of the body.
        self.intersecting = unsafe { ccd_shim_mpr(self.body, self.poses[i].as_ptr(), self.last.as_mut_ptr()) } != 0;
    }

    fn reply(&self) -> Reply {
        let distance = if self.intersecting { 0.0 } else { f64::INFINITY };
        Reply { distance, width: f64::NAN, steps: f64::NAN, fallback: false, exact: false, by_levels: false }
    }
}
