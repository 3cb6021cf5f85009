//! Jolt's contacts of bodies with its mesh of triangles, where Jolt was there when this was compiled.

#[cfg(jolt)]
use super::scenes::MARGIN;
use super::scenes::{Hills, Kind};
use super::{Counted, Grounded};
use crate::peers::Mesh;
use swiftprox::math::Pose;

#[repr(C)]
struct Handle {
    _opaque: [u8; 0],
}

#[cfg(jolt)]
unsafe extern "C" {
    fn jolt_ground_create(
        ground: *const Mesh,
        body: *const Mesh,
        half: *const f64,
        margin: f64,
        removes_edges: i32,
    ) -> *mut Handle;
    fn jolt_ground_load(ground: *mut Handle, poses: *const f64, count: usize);
    fn jolt_ground_ask(ground: *mut Handle, i: usize, counted: *mut usize);
    fn jolt_ground_free(ground: *mut Handle);
}

pub struct Jolt {
    name: &'static str,
    handle: *mut Handle,
    counted: [usize; 3],
}

impl Jolt {
    /// `None` without Jolt. `removes_edges`: by its collector that removes inner edges, else by the edges that it marks as active.
    ///
    /// # Errors
    /// Jolt refuses the ground or the body.
    #[cfg(jolt)]
    pub fn new(hills: &Hills, kind: Kind, poses: &[Pose], removes_edges: bool) -> Result<Option<Jolt>, String> {
        let mesh = kind.mesh().map_err(|error| error.to_string())?;
        let flat =
            |vertices: &[swiftprox::math::Vector]| vertices.iter().flat_map(|v| [v.x, v.y, v.z]).collect::<Vec<f64>>();
        let (ground, body) = (flat(&hills.vertices), flat(&mesh.vertices));
        let meshes = [Mesh::new(&ground, hills.triangles.as_flattened(), 0.0), Mesh::new(&body, &mesh.indices, 0.0)];
        let half = match kind {
            Kind::Box(half) => Some(half),
            _ => None,
        };
        let half = half.as_ref().map_or(std::ptr::null(), |half| half.as_ptr());
        // SAFETY: it copies what the pointers lead to.
        let handle = unsafe { jolt_ground_create(&meshes[0], &meshes[1], half, MARGIN, i32::from(removes_edges)) };
        if handle.is_null() {
            return Err("Jolt refuses a ground or a body".into());
        }
        let rows: Vec<f64> = poses.iter().flat_map(|pose| pose.rows.as_flattened().to_vec()).collect();
        // SAFETY: twelve numbers a pose.
        unsafe { jolt_ground_load(handle, rows.as_ptr(), poses.len()) };
        Ok(Some(Jolt { name: if removes_edges { "jolt-removing" } else { "jolt" }, handle, counted: [0; 3] }))
    }

    #[cfg(not(jolt))]
    pub fn new(_: &Hills, _: Kind, _: &[Pose], _: bool) -> Result<Option<Jolt>, String> {
        Ok(None)
    }
}

impl Drop for Jolt {
    fn drop(&mut self) {
        #[cfg(jolt)]
        // SAFETY: made by the library, and not freed before.
        unsafe {
            jolt_ground_free(self.handle);
        }
    }
}

impl Grounded for Jolt {
    fn name(&self) -> &'static str {
        self.name
    }

    fn forget(&mut self) {}

    fn ask(&mut self, i: usize) {
        #[cfg(jolt)]
        // SAFETY: there are so many poses, and three numbers.
        unsafe {
            jolt_ground_ask(self.handle, i, self.counted.as_mut_ptr());
        }
        #[cfg(not(jolt))]
        unreachable!("without Jolt there is none: {i} {:?}", self.handle);
    }

    fn counted(&self) -> Counted {
        let [normals, points, ghosts] = self.counted;
        Counted { normals, points, ghosts }
    }
}
