//! FCL's GJK on its `Convex` shape (libccd solver), called directly below the collision objects. Its support climbs
//! from vertex 0 each time; it has no coherence to keep.

use crate::method::{Method, Reply};
use swiftprox::mesh::PolygonMesh;
use testkit::PosePair;

#[repr(C)]
struct Convex {
    _opaque: [u8; 0],
}

unsafe extern "C" {
    fn fcl_shim_convex(
        coordinates: *const f64,
        vertex_count: usize,
        corners: *const u32,
        triangle_count: usize,
    ) -> *mut Convex;
    fn fcl_shim_free(convex: *mut Convex);
    fn fcl_shim_distance(convex: *const Convex, poses: *const f64, tolerance: f64, points: *mut f64) -> f64;
}

pub struct Fcl {
    name: String,
    convex: *mut Convex,
    tolerance: f64,
    poses: Vec<PosePair>,
    distance: f64,
    points: [f64; 6],
}

impl Fcl {
    /// A triangle mesh; `tolerance` is the solver's `distance_tolerance` (its default is 1e-6). `None` when FCL refuses
    /// the mesh.
    pub fn new(mesh: &PolygonMesh, tolerance: f64) -> Option<Fcl> {
        let coordinates: Vec<f64> = mesh.vertices.iter().flat_map(|v| [v.x, v.y, v.z]).collect();
        assert_eq!(mesh.indices.len(), 3 * mesh.face_count(), "FCL is given triangles only");
        // SAFETY: the pointers are to arrays of the lengths that are passed; the shim copies them.
        let convex = unsafe {
            fcl_shim_convex(coordinates.as_ptr(), mesh.vertices.len(), mesh.indices.as_ptr(), mesh.face_count())
        };
        (!convex.is_null()).then(|| Fcl {
            name: format!("fcl-{tolerance:e}"),
            convex,
            tolerance,
            poses: Vec::new(),
            distance: f64::NAN,
            points: [f64::NAN; 6],
        })
    }
}

impl Drop for Fcl {
    fn drop(&mut self) {
        // SAFETY: made by fcl_shim_convex and freed once.
        unsafe { fcl_shim_free(self.convex) }
    }
}

impl Method for Fcl {
    fn name(&self) -> &str {
        &self.name
    }

    fn load(&mut self, poses: &[PosePair]) {
        self.poses = poses.to_vec();
    }

    fn forget(&mut self) {}

    #[inline]
    fn ask(&mut self, i: usize) {
        let poses = self.poses[i].as_ptr();
        // SAFETY: `convex` lives as long as self, `poses` points to 24 numbers, `points` to 6.
        self.distance = unsafe { fcl_shim_distance(self.convex, poses, self.tolerance, self.points.as_mut_ptr()) };
    }

    fn reply(&self) -> Reply {
        Reply {
            distance: self.distance,
            width: f64::NAN,
            steps: f64::NAN,
            fallback: false,
            exact: false,
            by_levels: false,
        }
    }
}
