//! The libraries in C++ that were there when this was compiled, each behind the functions of peer.h.

use std::collections::HashMap;
use std::ffi::c_void;

use swiftprox::math::Vector;
use swiftprox::mesh::PolygonMesh;
use testkit::PosePair;
use testkit::models::hull_mesh;

use super::Method;
use super::pairs::Asked;
use super::scenes::Pieces;
use crate::peers::Mesh;

/// As peer.h has it.
#[repr(C)]
struct CompoundScene {
    pieces: *const Mesh,
    piece_count: usize,
    surface: Mesh,
    poses: *const f64,
    pose_count: usize,
    asks_distance: i32,
}

#[derive(Clone, Copy)]
struct Functions {
    create: unsafe extern "C" fn(*const CompoundScene) -> *mut c_void,
    ask: unsafe extern "C" fn(*mut c_void, usize) -> f64,
    free: unsafe extern "C" fn(*mut c_void),
}

/// One of the ways in which a library answers.
#[derive(Clone, Copy)]
struct Way {
    name: &'static str,
    /// None where the library is not there.
    functions: Option<Functions>,
    asked: &'static [Asked],
    /// As `Method::error` has it.
    error: f64,
}

macro_rules! functions {
    ($condition:ident: $create:ident, $ask:ident, $free:ident) => {{
        #[cfg(not($condition))]
        let functions = None;
        #[cfg($condition)]
        let functions = {
            unsafe extern "C" {
                fn $create(scene: *const CompoundScene) -> *mut c_void;
                fn $ask(peer: *mut c_void, k: usize) -> f64;
                fn $free(peer: *mut c_void);
            }
            Some(Functions { create: $create, ask: $ask, free: $free })
        };
        functions
    }};
}

const BOTH: &[Asked] = &[Asked::Verdict, Asked::Distance];

/// No two neighbours run the same code.
const WAYS: [Way; 4] = [
    Way {
        name: "coal-pieces",
        functions: functions!(coal: coal_pieces_create, coal_pieces_ask, coal_pieces_free),
        asked: BOTH,
        error: 0.0,
    },
    Way {
        name: "fcl",
        functions: functions!(fcl: fcl_pieces_create, fcl_pieces_ask, fcl_pieces_free),
        asked: BOTH,
        error: 1e-4,
    },
    Way {
        name: "coal-bvh",
        functions: functions!(coal: coal_bvh_create, coal_bvh_ask, coal_bvh_free),
        asked: BOTH,
        error: 0.0,
    },
    Way {
        name: "bullet",
        functions: functions!(bullet64: bullet_pieces_create, bullet_pieces_ask, bullet_pieces_free),
        asked: &[Asked::Verdict],
        error: 0.0,
    },
];

/// Those that are asked such a question.
///
/// # Errors
/// A library refuses the body.
pub fn methods(pieces: &Pieces, poses: &[PosePair], asked: Asked) -> Result<Vec<Box<dyn Method>>, String> {
    let meshes = pieces.iter().map(|points| hull_mesh(points).map_err(|error| error.to_string()));
    let meshes: Vec<PolygonMesh> = meshes.collect::<Result<_, _>>()?;
    let ways = WAYS.into_iter().filter(|way| way.asked.contains(&asked));
    let ways = ways.filter_map(|way| Some((way, way.functions?)));
    ways.map(|(way, functions)| Ok(Box::new(Native::new(way, functions, &meshes, poses, asked)?) as Box<_>)).collect()
}

struct Native {
    way: Way,
    functions: Functions,
    peer: *mut c_void,
}

impl Native {
    fn new(
        way: Way,
        functions: Functions,
        pieces: &[PolygonMesh],
        poses: &[PosePair],
        asked: Asked,
    ) -> Result<Native, String> {
        let coordinates: Vec<Vec<f64>> = pieces.iter().map(|piece| coordinates(&piece.vertices)).collect();
        let meshes = pieces.iter().zip(&coordinates).map(|(piece, vertices)| Mesh::new(vertices, &piece.indices, 0.0));
        let meshes: Vec<Mesh> = meshes.collect();
        let (all, corners) = (coordinates.concat(), outer_corners(pieces));
        let scene = CompoundScene {
            pieces: meshes.as_ptr(),
            piece_count: meshes.len(),
            surface: Mesh::new(&all, &corners, 0.0),
            poses: poses.as_flattened().as_ptr(),
            pose_count: poses.len(),
            asks_distance: i32::from(asked == Asked::Distance),
        };
        // SAFETY: the pointers are to arrays of the lengths that are passed; the shim copies them.
        let peer = unsafe { (functions.create)(&scene) };
        if peer.is_null() {
            return Err(format!("{} refuses a body", way.name));
        }
        Ok(Native { way, functions, peer })
    }
}

fn coordinates(vertices: &[Vector]) -> Vec<f64> {
    vertices.iter().flat_map(|v| [v.x, v.y, v.z]).collect()
}

/// The corners of all pieces' triangles, but of those whose corners are another piece's, too: walls between two pieces, which are
/// no part of the surface, and without which boxes over triangles are much smaller.
fn outer_corners(pieces: &[PolygonMesh]) -> Vec<u32> {
    // Up to rounding.
    let key = |v: &Vector| [v.x, v.y, v.z].map(|x| (x * 1e9).round() as i64);
    let mut owners: HashMap<[i64; 3], Vec<usize>> = HashMap::new();
    for (k, piece) in pieces.iter().enumerate() {
        piece.vertices.iter().for_each(|v| owners.entry(key(v)).or_default().push(k));
    }
    let (mut corners, mut first) = (Vec::new(), 0);
    for (k, piece) in pieces.iter().enumerate() {
        for triangle in piece.indices.chunks(3) {
            let [a, b, c] = [0, 1, 2].map(|i| &owners[&key(&piece.vertices[triangle[i] as usize])]);
            if !a.iter().any(|other| *other != k && b.contains(other) && c.contains(other)) {
                corners.extend(triangle.iter().map(|corner| first + corner));
            }
        }
        first += piece.vertices.len() as u32;
    }
    corners
}

impl Drop for Native {
    fn drop(&mut self) {
        // SAFETY: made by `create` and freed once.
        unsafe { (self.functions.free)(self.peer) }
    }
}

impl Method for Native {
    fn name(&self) -> &'static str {
        self.way.name
    }

    fn error(&self) -> f64 {
        self.way.error
    }

    fn ask(&mut self, k: usize) -> f64 {
        // SAFETY: the peer lives as long as self, and there is such a pose.
        unsafe { (self.functions.ask)(self.peer, k) }
    }
}
