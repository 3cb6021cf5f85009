//! Which bodies: the paper's, real hulls, bodies as CAD systems have them, a box beside each of those, and round bodies.

use std::path::{Path, PathBuf};
use std::rc::Rc;

use swiftprox::mesh::PolygonMesh;
use swiftprox::mesh_io::read_mesh;

use super::round;
use crate::model;
use crate::options::Options;
use testkit::models::{ELLIPSOIDS, hull_mesh, normalised};
use testkit::solids::{Form, SOLIDS};

/// Of the paper's bodies; the last is measured of the first model alone.
const VERTICES: [usize; 5] = [10, 102, 1002, 10_002, 100_002];
/// Of these every method is measured.
const USUAL_VERTICES: usize = 1002;
/// Of real hulls and CAD-like bodies, every method is measured of one in so many.
const ONE_IN: usize = 4;

/// How much is measured of a body.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Extent {
    /// All methods at all their tolerances.
    All,
    /// The strongest way of each library.
    Strongest,
    /// As that, of fewer queries: a body that differs from another in its coordinates' last digits alone.
    Form,
}

/// Two bodies that are measured beside each other.
pub struct Body {
    pub family: &'static str,
    pub name: String,
    pub form: String,
    /// Of a round body the core: a point, a segment or a box.
    pub meshes: [Rc<PolygonMesh>; 2],
    /// Of the balls swept over the meshes.
    pub radii: [f64; 2],
    pub extent: Extent,
}

/// The bodies whose names begin so, or all; real hulls are those of `--meshes`.
///
/// # Errors
/// A message about the file that cannot be read, or that there is no such body.
pub fn bodies(options: &Options, wanted: &[String]) -> Result<Vec<Body>, String> {
    let mut bodies = paper(options)?;
    if let Some(directory) = &options.meshes {
        bodies.extend(real(directory)?);
    }
    bodies.extend(cad()?);
    bodies.extend(round::bodies(options)?);
    bodies.retain(|body| wanted.is_empty() || wanted.iter().any(|start| body.name.starts_with(start.as_str())));
    if bodies.is_empty() { Err("--bodies: there are none of these names".into()) } else { Ok(bodies) }
}

fn paper(options: &Options) -> Result<Vec<Body>, String> {
    let mut bodies = Vec::new();
    for (number, (name, _)) in ELLIPSOIDS.iter().enumerate() {
        let most = VERTICES.len() - usize::from(number > 0);
        for &n in &VERTICES[..most] {
            let mesh = Rc::new(model(options, name, n)?);
            let extent = if n == USUAL_VERTICES { Extent::All } else { Extent::Strongest };
            bodies.push(alike("paper", name.to_string(), n.to_string(), mesh, extent));
        }
    }
    Ok(bodies)
}

fn real(directory: &Path) -> Result<Vec<Body>, String> {
    let mut bodies = Vec::new();
    for (number, path) in files(directory)?.iter().enumerate() {
        let part =
            |path: Option<&Path>| path.and_then(Path::file_stem).unwrap_or_default().to_string_lossy().into_owned();
        let name = format!("{}/{}", part(path.parent()), part(Some(path)));
        let mesh = read_mesh(path).map_err(|e| e.to_string())?;
        // Moved and scaled with rounding, not all of its vertices need be extreme any more.
        let mesh = hull_mesh(&normalised(mesh).vertices).map_err(|e| e.to_string())?;
        bodies.push(alike("real", name, "hull".into(), Rc::new(mesh), extent(number)));
    }
    Ok(bodies)
}

/// The OFF files of a folder and of those in it, in order.
fn files(directory: &Path) -> Result<Vec<PathBuf>, String> {
    let failed = |e: std::io::Error| format!("{}: {e}", directory.display());
    let mut found = Vec::new();
    for entry in std::fs::read_dir(directory).map_err(failed)? {
        let path = entry.map_err(failed)?.path();
        if path.is_dir() {
            found.extend(files(&path)?);
        } else if path.extension().is_some_and(|extension| extension == "off") {
            found.push(path);
        }
    }
    found.sort();
    Ok(found)
}

/// Each in all its forms, and beside a box.
fn cad() -> Result<Vec<Body>, String> {
    let failed = |e: swiftprox::error::Error| e.to_string();
    let cuboid = Rc::new(SOLIDS[0].mesh(Form::Turned).map_err(failed)?);
    let mut bodies = Vec::new();
    for (number, solid) in SOLIDS.iter().enumerate() {
        let mesh = |form| solid.mesh(form).map(Rc::new).map_err(failed);
        for (name, form) in Form::ALL {
            let extent = if form == Form::Turned { extent(number) } else { Extent::Form };
            bodies.push(alike("cad", solid.name.into(), name.into(), mesh(form)?, extent));
        }
        bodies.push(Body {
            family: "unlike",
            name: format!("box+{}", solid.name),
            form: "turned".into(),
            meshes: [cuboid.clone(), mesh(Form::Turned)?],
            radii: [0.0; 2],
            extent: Extent::Strongest,
        });
    }
    // Families one after the other.
    bodies.sort_by_key(|body| body.family);
    Ok(bodies)
}

fn extent(number: usize) -> Extent {
    if number.is_multiple_of(ONE_IN) { Extent::All } else { Extent::Strongest }
}

fn alike(family: &'static str, name: String, form: String, mesh: Rc<PolygonMesh>, extent: Extent) -> Body {
    Body { family, name, form, meshes: [mesh.clone(), mesh], radii: [0.0; 2], extent }
}
