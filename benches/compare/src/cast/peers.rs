//! The casters in C++ that are installed.

use super::Caster;
use super::scenes::Scene;

pub fn casters(scene: &Scene) -> Result<Vec<Box<dyn Caster>>, String> {
    #[allow(unused_mut, reason = "nothing is pushed where neither is installed")]
    let mut found: Vec<Box<dyn Caster>> = Vec::new();
    #[cfg(fcl)]
    found.push(Box::new(fcl(scene)?));
    #[cfg(bullet64)]
    found.push(Box::new(bullet(scene)?));
    let _ = scene;
    Ok(found)
}

#[cfg(fcl)]
fn fcl(scene: &Scene) -> Result<super::native::Native, String> {
    use super::native::{Functions, Native};
    use crate::peers::Mesh;
    unsafe extern "C" {
        fn fcl_cast_create(meshes: *const Mesh, poses: *const f64, count: usize) -> *mut std::ffi::c_void;
        fn fcl_cast_ask(peer: *mut std::ffi::c_void, motion: usize) -> f64;
        fn fcl_cast_free(peer: *mut std::ffi::c_void);
    }
    Native::new("fcl", Functions { create: fcl_cast_create, ask: fcl_cast_ask, free: fcl_cast_free }, scene)
}

#[cfg(bullet64)]
fn bullet(scene: &Scene) -> Result<super::native::Native, String> {
    use super::native::{Functions, Native};
    use crate::peers::Mesh;
    unsafe extern "C" {
        fn bullet_cast_create(meshes: *const Mesh, poses: *const f64, count: usize) -> *mut std::ffi::c_void;
        fn bullet_cast_ask(peer: *mut std::ffi::c_void, motion: usize) -> f64;
        fn bullet_cast_free(peer: *mut std::ffi::c_void);
    }
    Native::new("bullet", Functions { create: bullet_cast_create, ask: bullet_cast_ask, free: bullet_cast_free }, scene)
}
