//! Shapes, pairs and scenes as lines, points and texts.

use super::depth::{CManifoldConfig, read_manifold_config};
use super::failure::{Checked, Failure, StatusCode};
use super::guard::{call_out, guard};
use super::pair::{CPlaced, bodies, body};
use super::scene::{SceneHandle, look};
use super::structs::{Versioned, read_struct};
use crate::draw::{self, Draw, DrawKind};
use std::ffi::{CString, c_char, c_void};

/// Receives a line. `start` and `end` have 3 numbers, valid during the call; `user` is the pointer of swiftprox_draw.
pub type DrawLineCallback =
    Option<unsafe extern "C-unwind" fn(user: *mut c_void, kind: DrawKind, start: *const f64, end: *const f64)>;

/// Receives a point of 3 numbers, valid during the call.
pub type DrawPointCallback = Option<unsafe extern "C-unwind" fn(user: *mut c_void, kind: DrawKind, place: *const f64)>;

/// Receives a text and its place of 3 numbers, both valid during the call.
pub type DrawTextCallback =
    Option<unsafe extern "C-unwind" fn(user: *mut c_void, kind: DrawKind, place: *const f64, text: *const c_char)>;

/// Who receives what is drawn. Initialise with SWIFTPROX_DRAW_DEFAULT. Callbacks run in the calling thread, during the call. They
/// must return; a C++ exception that leaves one ends the program. They may call the library, but not change the drawn scene.
#[derive(Debug, Clone, Copy)]
#[repr(C)]
pub struct CDraw {
    /// Set by SWIFTPROX_DRAW_DEFAULT.
    pub struct_size: usize,
    /// Which kinds are drawn, and searched for: kind k if bit 1 << k is set. Default: UINT32_MAX, all.
    pub kinds: u32,
    /// The length of a drawn normal. Default: 1.
    pub normal_length: f64,
    /// Passed to each callback. Default: null.
    pub user: *mut c_void,
    /// Receives lines. Default: null, nobody does.
    pub line: DrawLineCallback,
    /// Receives points. Default: null, nobody does.
    pub point: DrawPointCallback,
    /// Receives texts. Default: null, nobody does.
    pub text: DrawTextCallback,
}

// SAFETY: repr(C), struct_size first; the callbacks are the caller's, and any other bytes are valid.
unsafe impl Versioned for CDraw {
    const NAME: &'static str = "swiftprox_draw";
}

impl CDraw {
    /// The defaults, as in the header.
    pub const DEFAULT: CDraw = CDraw {
        struct_size: size_of::<CDraw>(),
        kinds: u32::MAX,
        normal_length: 1.0,
        user: std::ptr::null_mut(),
        line: None,
        point: None,
        text: None,
    };
}

impl Draw for CDraw {
    fn wants(&self, kind: DrawKind) -> bool {
        self.kinds >> kind as i32 & 1 != 0
    }

    fn normal_length(&self) -> f64 {
        self.normal_length
    }

    fn line(&mut self, kind: DrawKind, start: [f64; 3], end: [f64; 3]) {
        if let Some(line) = self.line {
            // SAFETY: the callback takes its own user pointer, and reads 3 numbers twice.
            call_out(|| unsafe { line(self.user, kind, start.as_ptr(), end.as_ptr()) });
        }
    }

    fn point(&mut self, kind: DrawKind, place: [f64; 3]) {
        if let Some(point) = self.point {
            // SAFETY: the callback takes its own user pointer, and reads 3 numbers.
            call_out(|| unsafe { point(self.user, kind, place.as_ptr()) });
        }
    }

    fn text(&mut self, kind: DrawKind, place: [f64; 3], words: &str) {
        if let Some(text) = self.text {
            let words = CString::new(words).unwrap_or_default();
            // SAFETY: the callback takes its own user pointer, and reads 3 numbers and a string.
            call_out(|| unsafe { text(self.user, kind, place.as_ptr(), words.as_ptr()) });
        }
    }
}

/// Draws the edges of a shape, for debugging.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn swiftprox_shape_draw(object: CPlaced, draw: *const CDraw) -> StatusCode {
    guard(|| {
        // SAFETY: the header's pointer rules.
        let (mut draw, object) = unsafe { (read_draw(draw)?, body(object, ["object.shape", "object.pose"])?) };
        Ok(draw::shape(object, &mut draw)?)
    })
}

/// Draws what a query does, for debugging: both shapes; each step of the march; witness points and normal of the signed distance;
/// the points of the manifold; the polytope of overlapping objects. docs/tools.md has a table.
///
/// The queries are run anew, cold; `config` is that of swiftprox_pair_manifold. The march is that of swiftprox_pair_distance with
/// SWIFTPROX_LEVELS_NONE. March and polytope are those of the polyhedra over which radii are swept. Small bodies, whose depth is
/// searched by all facets, are drawn with a polytope, too. One of more than 56 vertices is replaced by that of a search to 1 % or
/// 10 %.
///
/// Same errors as swiftprox_pair_manifold; nothing is drawn then.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn swiftprox_pair_draw(
    object1: CPlaced,
    object2: CPlaced,
    config: *const CManifoldConfig,
    draw: *const CDraw,
) -> StatusCode {
    guard(|| {
        // SAFETY: the header's pointer rules.
        let (mut draw, bodies, config) =
            unsafe { (read_draw(draw)?, bodies(object1, object2)?, read_manifold_config(config)?) };
        Ok(draw::pair(bodies, &config, &mut draw)?)
    })
}

/// Draws a scene, for debugging: edges and boxes of its objects, the pairs that its last query found near, and the results that it
/// listed, each with what the query gave: witness points, normal, points of the manifold. Results stay where they were found, even
/// if objects have moved since. Grounds are drawn as all their triangles, one edge after the other.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn swiftprox_scene_draw(scene: *const SceneHandle, draw: *const CDraw) -> StatusCode {
    // SAFETY: the header's pointer rules.
    guard(|| unsafe {
        let mut draw = read_draw(draw)?;
        look(scene, |scene| {
            scene.draw(&mut draw);
            Ok(())
        })
    })
}

/// The caller's struct, which must be there: without callbacks there is nothing to do.
///
/// # Safety
/// `draw` meets the header's pointer rules.
unsafe fn read_draw(draw: *const CDraw) -> Checked<CDraw> {
    if draw.is_null() {
        return Err(Failure::null("draw"));
    }
    // SAFETY: by the caller.
    unsafe { read_struct(draw, CDraw::DEFAULT) }
}
