//! The libraries in C and C++ that are compared with, all behind the functions of peer.h.

use std::io::Write;

use swiftprox::mesh::PolygonMesh;

use crate::method::{Method, Reply};
use testkit::PosePair;

unsafe extern "C" {
    fn _exit(status: i32) -> !;
}

/// Ends the program without destructors of C++: coal from PyPI and Debian's FCL bring an octomap each, and both free one string.
pub fn end(status: u8) -> ! {
    // What cannot be written can no longer be told either.
    let _ = std::io::stdout().flush();
    // SAFETY: it ends the process.
    unsafe { _exit(status.into()) }
}

#[repr(C)]
struct Handle {
    _opaque: [u8; 0],
}

/// As peer.h has it.
#[repr(C)]
pub struct Mesh {
    vertices: *const f64,
    vertex_count: usize,
    corners: *const u32,
    triangle_count: usize,
    radius: f64,
}

impl Mesh {
    /// Points to the arrays, three numbers a vertex and three corners a triangle.
    pub fn new(vertices: &[f64], corners: &[u32], radius: f64) -> Mesh {
        let (vertex_count, triangle_count) = (vertices.len() / 3, corners.len() / 3);
        Mesh { vertices: vertices.as_ptr(), vertex_count, corners: corners.as_ptr(), triangle_count, radius }
    }
}

/// What is asked of a library.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Asked {
    Distance,
    Verdict,
    Depth,
    /// The depth of a manifold's deepest point.
    Manifold,
}

type Ask = unsafe extern "C" fn(*mut Handle, usize, *mut f64) -> f64;

/// A library's functions.
#[derive(Clone, Copy)]
struct Functions {
    create: unsafe extern "C" fn(*const [Mesh; 2], f64) -> *mut Handle,
    load: unsafe extern "C" fn(*mut Handle, *const f64, usize),
    forget: unsafe extern "C" fn(*mut Handle),
    free: unsafe extern "C" fn(*mut Handle),
    distance: Option<Ask>,
    verdict: Option<Ask>,
    depth: Option<Ask>,
    manifold: Option<Ask>,
}

/// One of the ways in which a library answers: the word for tables, and its functions, none where the library was not there when
/// this was compiled.
#[derive(Clone, Copy)]
struct Way {
    word: &'static str,
    functions: Option<Functions>,
}

/// A way under a word: whether its library is there, the four functions that all have, and those of queries that it has.
macro_rules! way {
    ($word:literal, $condition:ident: $create:ident, $load:ident, $forget:ident, $free:ident; $($query:ident: $ask:ident),+) => {{
        #[cfg(not($condition))]
        let functions: Option<Functions> = None;
        #[cfg($condition)]
        let functions = {
            unsafe extern "C" {
                fn $create(meshes: *const [Mesh; 2], tolerance: f64) -> *mut Handle;
                fn $load(peer: *mut Handle, poses: *const f64, count: usize);
                fn $forget(peer: *mut Handle);
                fn $free(peer: *mut Handle);
                $(fn $ask(peer: *mut Handle, i: usize, normal: *mut f64) -> f64;)+
            }
            let none = Functions {
                create: $create, load: $load, forget: $forget, free: $free, distance: None, verdict: None, depth: None,
                manifold: None,
            };
            Some(Functions { $($query: Some($ask),)+ ..none })
        };
        Way { word: $word, functions }
    }};
}

#[rustfmt::skip]
const WAYS: [Way; 13] = [
    way!("coal-round", coal: coal_round_create, coal_peer_load, coal_peer_forget, coal_peer_free;
         distance: coal_distance, verdict: coal_verdict, depth: coal_depth),
    way!("bullet-round", bullet64: bullet_round_create, bullet_round_load, bullet_round_forget, bullet_round_free;
         distance: bullet_round_distance, verdict: bullet_round_verdict, depth: bullet_round_depth),
    way!("coal", coal: coal_peer_create, coal_peer_load, coal_peer_forget, coal_peer_free;
         distance: coal_distance, verdict: coal_verdict, depth: coal_depth),
    way!("mujoco", mujoco: mujoco_peer_create, mujoco_peer_load, mujoco_peer_forget, mujoco_peer_free;
         distance: mujoco_distance, verdict: mujoco_verdict, depth: mujoco_depth),
    way!("mujoco-manifold", mujoco: mujoco_peer_create, mujoco_peer_load, mujoco_peer_forget, mujoco_peer_free;
         manifold: mujoco_manifold),
    way!("bullet-manifold", bullet64: bullet_rest_create, bullet_rest_load, bullet_rest_forget, bullet_rest_free;
         manifold: bullet_rest_manifold),
    way!("jolt", jolt: jolt_peer_create, jolt_peer_load, jolt_peer_forget, jolt_peer_free;
         distance: jolt_distance, verdict: jolt_verdict, depth: jolt_depth),
    way!("bullet", bullet: bullet_peer_create, bullet_peer_load, bullet_peer_forget, bullet_peer_free;
         distance: bullet_distance, depth: bullet_depth),
    way!("libccd-gjk", ccd: ccd_peer_create, ccd_peer_load, ccd_peer_forget, ccd_peer_free; verdict: ccd_gjk_verdict),
    way!("libccd-mpr", ccd: ccd_peer_create, ccd_peer_load, ccd_peer_forget, ccd_peer_free;
         verdict: ccd_mpr_verdict, depth: ccd_mpr_depth),
    way!("libccd-epa", ccd: ccd_peer_create, ccd_peer_load, ccd_peer_forget, ccd_peer_free; depth: ccd_epa_depth),
    way!("fcl-indep", fcl: fcl_peer_create, fcl_peer_load, fcl_peer_forget, fcl_peer_free;
         distance: fcl_indep_distance, verdict: fcl_indep_verdict),
    way!("fcl", fcl: fcl_peer_create, fcl_peer_load, fcl_peer_forget, fcl_peer_free;
         distance: fcl_distance, verdict: fcl_verdict, depth: fcl_depth),
];

/// Those of these names, such as coal-1e-10, that are there and take the meshes.
pub fn of_names(asked: Asked, names: &[&str], meshes: [&PolygonMesh; 2]) -> Vec<Box<dyn Method>> {
    let made = names.iter().filter_map(|name| named(asked, name, meshes));
    made.map(|peer| Box::new(peer) as Box<dyn Method>).collect()
}

/// A library with a tolerance, as in coal-1e-10; none where it is not there, does not know the query, or refuses a mesh.
pub fn named(asked: Asked, name: &str, meshes: [&PolygonMesh; 2]) -> Option<Peer> {
    swept(asked, name, meshes, [0.0; 2])
}

/// The same of bodies with balls swept over them, which the way's primitives stand for.
pub fn round(asked: Asked, name: &str, cores: [&PolygonMesh; 2], radii: [f64; 2]) -> Option<Box<dyn Method>> {
    Some(Box::new(swept(asked, name, cores, radii)?))
}

fn swept(asked: Asked, name: &str, meshes: [&PolygonMesh; 2], radii: [f64; 2]) -> Option<Peer> {
    let (functions, tolerance) = WAYS.into_iter().find_map(|way| {
        let tolerance = name.strip_prefix(way.word)?.strip_prefix('-')?.parse().ok()?;
        Some((way.functions?, tolerance))
    })?;
    let ask = match asked {
        Asked::Distance => functions.distance,
        Asked::Verdict => functions.verdict,
        Asked::Depth => functions.depth,
        Asked::Manifold => functions.manifold,
    };
    Peer::new(name, (functions, ask?), tolerance, meshes, radii)
}

/// A library that was found.
pub struct Peer {
    name: String,
    functions: Functions,
    ask: Ask,
    handle: *mut Handle,
    /// What the library was handed stays where it is.
    poses: Vec<PosePair>,
    said: f64,
    normal: [f64; 3],
}

impl Peer {
    /// None where the library refuses a mesh.
    fn new(
        name: &str,
        (functions, ask): (Functions, Ask),
        tolerance: f64,
        meshes: [&PolygonMesh; 2],
        radii: [f64; 2],
    ) -> Option<Peer> {
        let vertices = meshes.map(|mesh| mesh.vertices.iter().flat_map(|v| [v.x, v.y, v.z]).collect::<Vec<f64>>());
        let given = [0, 1].map(|i| {
            let mesh = meshes[i];
            assert_eq!(mesh.indices.len(), 3 * mesh.face_count(), "peers are given triangles only");
            Mesh::new(&vertices[i], &mesh.indices, radii[i])
        });
        // SAFETY: the pointers are to arrays of the lengths that are passed; the shim copies them.
        let handle = unsafe { (functions.create)(&given, tolerance) };
        if handle.is_null() {
            eprintln!("{name} refuses this model: compared without it");
            return None;
        }
        Some(Peer {
            name: name.into(),
            functions,
            ask,
            handle,
            poses: Vec::new(),
            said: f64::NAN,
            normal: [f64::NAN; 3],
        })
    }

    /// Along which the last distance or depth is, of any length and either sign.
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
        self.said = unsafe { (self.ask)(self.handle, i, self.normal.as_mut_ptr()) };
    }

    fn reply(&self) -> Reply {
        Reply::of(self.said)
    }
}
