//! libccd's MPR (minkowski portal refinement) at its default tolerance of 1e-4, with a support function that climbs from the
//! last support vertex. It says the verdict alone.

use swiftprox::mesh::PolygonMesh;

use crate::method::{Method, Reply};
use testkit::PosePair;

#[repr(C)]
struct Hull {
    _opaque: [u8; 0],
}

unsafe extern "C" {
    fn ccd_shim_hull(
        coordinates: *const f64,
        vertex_count: usize,
        corners: *const u32,
        triangle_count: usize,
    ) -> *mut Hull;
    fn ccd_shim_free(hull: *mut Hull);
    fn ccd_shim_mpr(hull: *const Hull, poses: *const f64, last: *mut u32) -> i32;
}

pub struct Mpr {
    hull: *mut Hull,
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
        let hull = unsafe {
            ccd_shim_hull(coordinates.as_ptr(), mesh.vertices.len(), mesh.indices.as_ptr(), mesh.face_count())
        };
        assert!(!hull.is_null(), "there is memory");
        Mpr { hull, poses: Vec::new(), last: [0; 2], intersecting: false }
    }
}

impl Drop for Mpr {
    fn drop(&mut self) {
        // SAFETY: made by ccd_shim_hull and freed once.
        unsafe { ccd_shim_free(self.hull) }
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
        // SAFETY: `hull` lives as long as self, the poses are 24 numbers, `last` holds two vertices of it.
        self.intersecting = unsafe { ccd_shim_mpr(self.hull, self.poses[i].as_ptr(), self.last.as_mut_ptr()) } != 0;
    }

    fn reply(&self) -> Reply {
        let distance = if self.intersecting { 0.0 } else { f64::INFINITY };
        Reply { distance, width: f64::NAN, steps: f64::NAN, fallback: false, exact: false, by_levels: false }
    }
}
