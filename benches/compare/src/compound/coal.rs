//! coal's bodies of many pieces, where coal was there when this was compiled: a manager, its dynamic tree, with an object a piece.

use swiftprox::math::Vector;
use testkit::PosePair;

use super::Method;
use super::pairs::Asked;

#[repr(C)]
struct Handle {
    _opaque: [u8; 0],
}

#[cfg(coal)]
unsafe extern "C" {
    fn coal_compound_create(
        coordinates: *const f64,
        vertex_counts: *const usize,
        corners: *const u32,
        triangle_counts: *const usize,
        piece_count: usize,
    ) -> *mut Handle;
    fn coal_compound_load(compound: *mut Handle, poses: *const f64, count: usize);
    fn coal_compound_ask(compound: *mut Handle, k: usize, asks_distance: i32) -> f64;
    fn coal_compound_free(compound: *mut Handle);
}

pub struct Coal {
    #[cfg_attr(not(coal), expect(dead_code))]
    asked: Asked,
    #[cfg_attr(not(coal), expect(dead_code))]
    handle: *mut Handle,
}

impl Coal {
    /// `None` without coal.
    ///
    /// # Errors
    /// coal refuses a piece.
    #[cfg(coal)]
    pub fn new(pieces: &[Vec<Vector>], poses: &[PosePair], asked: Asked) -> Result<Option<Coal>, String> {
        let meshes = pieces.iter().map(|points| testkit::models::hull_mesh(points).map_err(|error| error.to_string()));
        let meshes: Vec<_> = meshes.collect::<Result<_, _>>()?;
        let coordinates: Vec<f64> =
            meshes.iter().flat_map(|mesh| &mesh.vertices).flat_map(|v| [v.x, v.y, v.z]).collect();
        let corners_of = |mesh: &swiftprox::mesh::PolygonMesh| {
            let faces = (0..mesh.face_count()).map(|f| mesh.face(f).to_vec());
            faces.flat_map(|face| (2..face.len()).flat_map(move |k| [face[0], face[k - 1], face[k]])).collect()
        };
        let corners: Vec<Vec<u32>> = meshes.iter().map(corners_of).collect();
        let vertex_counts: Vec<usize> = meshes.iter().map(|mesh| mesh.vertices.len()).collect();
        let triangle_counts: Vec<usize> = corners.iter().map(|corners| corners.len() / 3).collect();
        // SAFETY: the pointers are to arrays of the lengths that are passed; it copies them.
        let handle = unsafe {
            coal_compound_create(
                coordinates.as_ptr(),
                vertex_counts.as_ptr(),
                corners.concat().as_ptr(),
                triangle_counts.as_ptr(),
                pieces.len(),
            )
        };
        if handle.is_null() {
            return Err("coal refuses a body".into());
        }
        // SAFETY: 24 numbers each.
        unsafe { coal_compound_load(handle, poses.as_flattened().as_ptr(), poses.len()) };
        Ok(Some(Coal { asked, handle }))
    }

    #[cfg(not(coal))]
    pub fn new(_: &[Vec<Vector>], _: &[PosePair], _: Asked) -> Result<Option<Coal>, String> {
        Ok(None)
    }
}

impl Drop for Coal {
    fn drop(&mut self) {
        #[cfg(coal)]
        // SAFETY: made by coal_compound_create and freed once.
        unsafe {
            coal_compound_free(self.handle);
        }
    }
}

impl Method for Coal {
    fn name(&self) -> &'static str {
        "coal"
    }

    #[cfg(coal)]
    fn ask(&mut self, k: usize) -> f64 {
        // SAFETY: the handle lives as long as self, and there is such a pose.
        unsafe { coal_compound_ask(self.handle, k, i32::from(self.asked == Asked::Distance)) }
    }

    #[cfg(not(coal))]
    fn ask(&mut self, _: usize) -> f64 {
        f64::NAN
    }
}
