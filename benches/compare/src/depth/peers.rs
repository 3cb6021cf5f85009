//! The libraries in C and C++ that say depths, all behind the functions of peer.h.

use swiftprox::mesh::PolygonMesh;

use crate::method::{Method, Reply};
use testkit::PosePair;

#[repr(C)]
struct Handle {
    _opaque: [u8; 0],
}

#[repr(C)]
struct Mesh {
    vertices: *const f64,
    vertex_count: usize,
    corners: *const u32,
    triangle_count: usize,
}

/// A library's functions.
#[derive(Clone, Copy)]
struct Functions {
    create: unsafe extern "C" fn(*const [Mesh; 2], f64) -> *mut Handle,
    load: unsafe extern "C" fn(*mut Handle, *const f64, usize),
    forget: unsafe extern "C" fn(*mut Handle),
    ask: unsafe extern "C" fn(*mut Handle, usize, *mut f64) -> f64,
    free: unsafe extern "C" fn(*mut Handle),
}

/// The functions under a library's names; none where it was not there when this was compiled.
macro_rules! functions {
    ($condition:ident: $create:ident, $load:ident, $forget:ident, $ask:ident, $free:ident) => {{
        #[cfg(not($condition))]
        let functions: Option<Functions> = None;
        #[cfg($condition)]
        let functions = {
            unsafe extern "C" {
                fn $create(meshes: *const [Mesh; 2], tolerance: f64) -> *mut Handle;
                fn $load(peer: *mut Handle, poses: *const f64, count: usize);
                fn $forget(peer: *mut Handle);
                fn $ask(peer: *mut Handle, i: usize, normal: *mut f64) -> f64;
                fn $free(peer: *mut Handle);
            }
            Some(Functions { create: $create, load: $load, forget: $forget, ask: $ask, free: $free })
        };
        functions
    }};
}

/// Those that this library is to be held against.
pub fn strongest(meshes: [&PolygonMesh; 2]) -> Vec<Box<dyn Method>> {
    boxed(&[(COAL, 1e-10), (MUJOCO, 1e-6)], meshes)
}

/// Further tolerances, and further libraries; the default of each is among them.
pub fn others(meshes: [&PolygonMesh; 2]) -> Vec<Box<dyn Method>> {
    boxed(&OTHERS, meshes)
}

const OTHERS: [(Library, f64); 11] = [
    (COAL, 1e-6),
    (COAL, 1e-4),
    (COAL, 1e-3),
    (COAL, 1e-2),
    (MUJOCO, 1e-10),
    (CCD_EPA, 1e-4),
    (CCD_EPA, 1e-10),
    (CCD_MPR, 1e-4),
    (BULLET, 1e-4),
    (FCL, 1e-6),
    (FCL, 1e-10),
];

fn boxed(ways: &[(Library, f64)], meshes: [&PolygonMesh; 2]) -> Vec<Box<dyn Method>> {
    let made = ways.iter().filter_map(|(library, tolerance)| Peer::new(*library, *tolerance, meshes));
    made.map(|peer| Box::new(peer) as Box<dyn Method>).collect()
}

/// A library with a tolerance, as in coal-1e-10; none where there is none such, or it refuses a mesh.
pub fn named(name: &str, meshes: [&PolygonMesh; 2]) -> Option<Peer> {
    let (library, tolerance) = [COAL, MUJOCO, CCD_EPA, CCD_MPR, BULLET, FCL].into_iter().find_map(|library| {
        let tolerance = name.strip_prefix(library.0)?.strip_prefix('-')?.parse().ok()?;
        Some((library, tolerance))
    })?;
    Peer::new(library, tolerance, meshes)
}

/// A library's word for tables, and its functions.
type Library = (&'static str, Option<Functions>);

const COAL: Library =
    ("coal", functions!(coal: coal_depth_create, coal_depth_load, coal_depth_forget, coal_depth_ask, coal_depth_free));
const MUJOCO: Library = (
    "mujoco",
    functions!(mujoco: mujoco_depth_create, mujoco_depth_load, mujoco_depth_forget, mujoco_depth_ask, mujoco_depth_free),
);
const CCD_EPA: Library =
    ("libccd-epa", functions!(ccd: ccd_epa_create, ccd_depth_load, ccd_depth_forget, ccd_depth_ask, ccd_depth_free));
const CCD_MPR: Library =
    ("libccd-mpr", functions!(ccd: ccd_mpr_create, ccd_depth_load, ccd_depth_forget, ccd_depth_ask, ccd_depth_free));
const BULLET: Library = (
    "bullet",
    functions!(bullet: bullet_depth_create, bullet_depth_load, bullet_depth_forget, bullet_depth_ask, bullet_depth_free),
);
const FCL: Library =
    ("fcl", functions!(fcl: fcl_depth_create, fcl_depth_load, fcl_depth_forget, fcl_depth_ask, fcl_depth_free));

/// A library that was found.
pub struct Peer {
    name: String,
    functions: Functions,
    handle: *mut Handle,
    /// What the library was handed stays where it is.
    poses: Vec<PosePair>,
    depth: f64,
    normal: [f64; 3],
}

impl Peer {
    /// None where the library is not there, or refuses a mesh.
    fn new((library, functions): Library, tolerance: f64, meshes: [&PolygonMesh; 2]) -> Option<Peer> {
        let functions = functions?;
        let name = format!("{library}-{tolerance:e}");
        let vertices = meshes.map(|mesh| mesh.vertices.iter().flat_map(|v| [v.x, v.y, v.z]).collect::<Vec<f64>>());
        let given = [0, 1].map(|i| {
            let mesh = meshes[i];
            assert_eq!(mesh.indices.len(), 3 * mesh.face_count(), "peers are given triangles only");
            Mesh {
                vertices: vertices[i].as_ptr(),
                vertex_count: mesh.vertices.len(),
                corners: mesh.indices.as_ptr(),
                triangle_count: mesh.face_count(),
            }
        });
        // SAFETY: the pointers are to arrays of the lengths that are passed; the shim copies them.
        let handle = unsafe { (functions.create)(&given, tolerance) };
        if handle.is_null() {
            eprintln!("{name} refuses this model: compared without it");
            return None;
        }
        Some(Peer { name, functions, handle, poses: Vec::new(), depth: f64::NAN, normal: [f64::NAN; 3] })
    }

    /// Along which it said the last depth, of any length and either sign.
    pub fn normal(&self) -> [f64; 3] {
        self.normal
    }
}

impl Drop for Peer {
    fn drop(&mut self) {
        // SAFETY: made by `create` and freed once.
        unsafe { (self.functions.free)(self.handle) }
    }
}

impl Method for Peer {
    fn name(&self) -> &str {
        &self.name
    }

    fn load(&mut self, poses: &[PosePair]) {
        self.poses = poses.to_vec();
        // SAFETY: `poses` are 24 numbers each, and stay until the next are loaded.
        unsafe { (self.functions.load)(self.handle, self.poses.as_flattened().as_ptr(), poses.len()) }
    }

    fn forget(&mut self) {
        // SAFETY: the handle lives as long as self.
        unsafe { (self.functions.forget)(self.handle) }
    }

    #[inline]
    fn ask(&mut self, i: usize) {
        assert!(i < self.poses.len());
        self.normal = [f64::NAN; 3];
        // SAFETY: the handle lives as long as self, there is such a pose, and the normal is three numbers.
        self.depth = unsafe { (self.functions.ask)(self.handle, i, self.normal.as_mut_ptr()) };
    }

    fn reply(&self) -> Reply {
        let distance = self.depth;
        Reply { distance, width: f64::NAN, steps: f64::NAN, fallback: false, exact: false, by_levels: false }
    }
}
