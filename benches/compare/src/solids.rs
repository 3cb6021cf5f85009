//! Exact distance of bodies as CAD systems and games have them, and of hulls from files, each beside another like it.

use std::path::{Path, PathBuf};
use std::rc::Rc;

use swiftprox::mesh::PolygonMesh;
use swiftprox::mesh_io::read_mesh;
use swiftprox::pair::PairConfig;
use swiftprox::shape::{Shape, ShapeOptions};

use crate::accuracy::Accuracy;
use crate::method::{Method, replies};
use crate::options::Options;
use crate::parry::{Climbing, Parry, Rings};
use crate::report::{self, Row};
use crate::setting::{Query, setting};
use crate::timing::time_methods;
use crate::{model, motion};
use testkit::models::{ELLIPSOIDS, hull_mesh, normalised};
use testkit::solids::{Form, SOLIDS};

/// A body to be measured.
struct Body {
    name: String,
    mesh: PolygonMesh,
}

pub fn run(options: &Options, wanted: &[String]) -> Result<(), String> {
    let mut rows = Vec::new();
    for body in bodies(options, wanted)? {
        let mut methods = methods(&body.mesh, options)?;
        for orbit in &options.orbits {
            for &step in &options.steps {
                let poses = motion(options, orbit, step)?;
                methods.iter_mut().for_each(|method| method.load(&poses));
                let replies: Vec<_> = methods.iter_mut().map(|method| replies(method.as_mut(), poses.len())).collect();
                let times = time_methods(&mut methods, poses.len(), options.passes);
                for (m, method) in methods.iter().enumerate() {
                    let scene = (body.name.as_str(), body.mesh.vertices.len(), orbit.as_str(), step);
                    let accuracy = Accuracy::of(Query::Distance, &replies[m], &replies[0]);
                    rows.push(Row::new(scene, method.name(), &replies[m], times[m], accuracy));
                }
            }
        }
        eprintln!("{} done", body.name);
    }
    report::print_ratios(&rows);
    if let Some(path) = &options.csv {
        report::write(path, options.passes, &report::distance_csv(&rows))?;
    }
    Ok(())
}

/// Solids in all forms, the ellipsoids, and the hulls of `--meshes`, of those names or all.
fn bodies(options: &Options, wanted: &[String]) -> Result<Vec<Body>, String> {
    let is_wanted = |name: &str| wanted.is_empty() || wanted.iter().any(|start| name.starts_with(start.as_str()));
    let mut bodies = Vec::new();
    for solid in &SOLIDS {
        for (form_name, form) in Form::ALL {
            let name = format!("{}/{form_name}", solid.name);
            if is_wanted(&name) {
                bodies.push(Body { name, mesh: solid.mesh(form).map_err(|e| e.to_string())? });
            }
        }
    }
    for (name, _) in ELLIPSOIDS.iter().filter(|(name, _)| is_wanted(name)) {
        for &n in &options.vertices {
            bodies.push(Body { name: format!("{name}/{n}"), mesh: model(options, name, n)? });
        }
    }
    if let Some(directory) = &options.meshes {
        for path in files(directory)? {
            let name = path.file_stem().unwrap_or_default().to_string_lossy().into_owned();
            if is_wanted(&name) {
                let mesh = read_mesh(&path).map_err(|e| e.to_string())?;
                // Moved and scaled with rounding, not all of its vertices need be extreme any more.
                let mesh = hull_mesh(&normalised(mesh).vertices).map_err(|e| e.to_string())?;
                bodies.push(Body { name, mesh });
            }
        }
    }
    if bodies.is_empty() { Err("--solids: there are no bodies of these names".into()) } else { Ok(bodies) }
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

/// In its strongest configuration each.
fn methods(mesh: &PolygonMesh, options: &Options) -> Result<Vec<Box<dyn Method>>, String> {
    let shape = Rc::new(Shape::from_mesh(mesh, &ShapeOptions::default()).map_err(|e| e.to_string())?);
    let rings = Rc::new(Rings::new(mesh));
    let mut all: Vec<Box<dyn Method>> = vec![
        setting("swiftprox", Query::Distance, &shape, PairConfig::default()),
        Box::new(Parry::new([rings.clone(), rings], Climbing::First)),
    ];
    all.retain(|method| options.methods.is_empty() || options.methods.iter().any(|name| name == method.name()));
    if all.is_empty() { Err("--methods: none of these is there".into()) } else { Ok(all) }
}
