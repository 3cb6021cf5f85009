//! FCL's dynamic tree of boxes over collision objects, with its libccd solver.

use super::world::{Step, World};
use super::{Crowd, Found, Question, TOLERANCE};

#[repr(C)]
struct FclCrowd {
    _opaque: [u8; 0],
}

unsafe extern "C" {
    fn fcl_crowd_create() -> *mut FclCrowd;
    fn fcl_crowd_add_mesh(
        crowd: *mut FclCrowd,
        coordinates: *const f64,
        vertex_count: usize,
        corners: *const u32,
        triangle_count: usize,
    );
    fn fcl_crowd_add_body(crowd: *mut FclCrowd, mesh: usize);
    fn fcl_crowd_move(crowd: *mut FclCrowd, body: usize, pose: *const f64);
    fn fcl_crowd_ask(crowd: *mut FclCrowd, question: i32, tolerance: f64, pairs: *mut usize, sum: *mut f64) -> i32;
    fn fcl_crowd_destroy(crowd: *mut FclCrowd);
}

pub struct Fcl {
    question: Question,
    crowd: *mut FclCrowd,
    steps: Vec<Vec<(usize, [f64; 12])>>,
}

impl Fcl {
    pub fn new(world: &World, question: Question) -> Result<Fcl, String> {
        // SAFETY: the shim copies what it is given, arrays of the lengths that are passed.
        let crowd = unsafe { fcl_crowd_create() };
        if crowd.is_null() {
            return Err("FCL has no memory".into());
        }
        for mesh in &world.meshes {
            let coordinates: Vec<f64> = mesh.vertices.iter().flat_map(|v| [v.x, v.y, v.z]).collect();
            assert_eq!(mesh.indices.len(), 3 * mesh.face_count(), "FCL is given triangles only");
            // SAFETY: as above.
            unsafe {
                let corners = mesh.indices.as_ptr();
                fcl_crowd_add_mesh(crowd, coordinates.as_ptr(), mesh.vertices.len(), corners, mesh.face_count());
            }
        }
        for &mesh in &world.mesh_of {
            // SAFETY: a mesh that was added.
            unsafe { fcl_crowd_add_body(crowd, mesh as usize) };
        }
        Ok(Fcl { question, crowd, steps: Vec::new() })
    }
}

impl Drop for Fcl {
    fn drop(&mut self) {
        // SAFETY: made by fcl_crowd_create and freed once.
        unsafe { fcl_crowd_destroy(self.crowd) }
    }
}

impl Crowd for Fcl {
    fn name(&self) -> &'static str {
        "fcl"
    }

    fn load(&mut self, steps: &[Step]) {
        let pose = |step: &Step, i: u32| (i as usize, step.poses[i as usize]);
        self.steps = steps.iter().map(|step| step.moved.iter().map(|&i| pose(step, i)).collect()).collect();
    }

    fn step(&mut self, k: usize) -> Found {
        for (body, pose) in &self.steps[k] {
            // SAFETY: a body that was added, 12 numbers.
            unsafe { fcl_crowd_move(self.crowd, *body, pose.as_ptr()) };
        }
        let mut found = Found::default();
        let question = match self.question {
            Question::Intersection => 0,
            Question::Distance => 1,
            Question::Contact => 2,
        };
        // SAFETY: two numbers to write to.
        let status = unsafe { fcl_crowd_ask(self.crowd, question, TOLERANCE, &mut found.pairs, &mut found.sum) };
        if status != 0 {
            found.sum = f64::NAN;
        }
        found
    }
}
