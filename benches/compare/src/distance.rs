//! Exact distance with witness points, or the verdict alone: every method on every scene.

use std::rc::Rc;

use swiftprox::mesh::PolygonMesh;
use swiftprox::pair::PairConfig;
use swiftprox::shape::{Shape, ShapeOptions};

use crate::accuracy::Accuracy;
use crate::method::{Method, replies};
use crate::options::Options;
use crate::parry::{Climbing, Parry, Rings};
use crate::peers::{self, Asked};
use crate::report::{self, Row};
use crate::setting::{Query, setting, setting_of_pair};
use crate::timing::{Time, time_methods};
use crate::{model, motion};
use testkit::models::cuboid;

pub fn run(options: &Options) -> Result<(), String> {
    // A workload's models have the number of vertices that they have.
    let sizes = if options.workload.is_some() { vec![0] } else { options.vertices.clone() };
    let mut rows = Vec::new();
    for n in sizes {
        for name in &options.models {
            let mesh = model(options, name, n)?;
            let mut methods = methods(&mesh, options)?;
            let pair = if options.beside_box { format!("{name}+box") } else { name.clone() };
            for orbit in &options.orbits {
                for &step in &options.steps {
                    let poses = motion(options, orbit, step)?;
                    for method in &mut methods {
                        method.load(&poses);
                    }
                    let replies: Vec<_> =
                        methods.iter_mut().map(|method| replies(method.as_mut(), poses.len())).collect();
                    let times = times(&mut methods, options, poses.len());
                    for (m, method) in methods.iter().enumerate() {
                        let scene = (pair.as_str(), mesh.vertices.len(), orbit.as_str(), step);
                        let accuracy = Accuracy::of(options.query, &replies[m], &replies[0]);
                        rows.push(Row::new(scene, method.name(), &replies[m], times[m], accuracy));
                    }
                    eprintln!("{name} {} {orbit} {step} done", mesh.vertices.len());
                }
            }
        }
    }
    report::print_distance(&rows);
    if let Some(path) = &options.csv {
        report::write(path, options.passes, &report::distance_csv(&rows))?;
    }
    Ok(())
}

/// The methods asked for that are there, in the order of `--help`.
fn methods(mesh: &PolygonMesh, options: &Options) -> Result<Vec<Box<dyn Method>>, String> {
    let wanted = &options.methods;
    let mut all = match options.query {
        Query::Intersection => of_intersection(mesh)?,
        _ if options.beside_box => beside_box(mesh)?,
        _ => of_distance(mesh)?,
    };
    all.retain(|method| wanted.is_empty() || wanted.iter().any(|name| name == method.name()));
    if all.is_empty() { Err("--methods: none of these is there".into()) } else { Ok(all) }
}

fn of_intersection(mesh: &PolygonMesh) -> Result<Vec<Box<dyn Method>>, String> {
    let mut all = vec![setting("swiftprox", Query::Intersection, &shape(mesh)?, PairConfig::default())];
    all.extend(peers::of_names(Asked::Verdict, &["libccd-mpr-1e-4"], [mesh; 2]));
    Ok(all)
}

/// No two that search alike follow each other: the second would find the branch predictors trained on the very poses.
fn of_distance(mesh: &PolygonMesh) -> Result<Vec<Box<dyn Method>>, String> {
    let shape = shape(mesh)?;
    let rings = Rc::new(Rings::new(mesh));
    let parry = |climbing| Box::new(Parry::new([rings.clone(), rings.clone()], climbing));
    let mut all: Vec<Box<dyn Method>> = vec![
        setting("swiftprox", Query::Distance, &shape, PairConfig::default()),
        parry(Climbing::First),
        parry(Climbing::Steepest),
    ];
    debug_assert_eq!(all.len(), FIRST_TURNS);
    for peer in ["fcl-1e-6", "fcl-1e-10"] {
        all.extend(peers::of_names(Asked::Distance, &[peer], [mesh; 2]));
        if peer == "fcl-1e-6" {
            all.push(parry(Climbing::FirstWithMatrix));
        }
    }
    Ok(all)
}

/// Body 2 is a cube of bounding radius 1.
fn beside_box(mesh: &PolygonMesh) -> Result<Vec<Box<dyn Method>>, String> {
    let cube = cuboid([f64::sqrt(1.0 / 3.0); 3]).map_err(|e| e.to_string())?;
    let shapes = [&shape(mesh)?, &shape(&cube)?];
    let rings = [Rc::new(Rings::new(mesh)), Rc::new(Rings::new(&cube))];
    Ok(vec![
        setting_of_pair("swiftprox", Query::Distance, shapes, PairConfig::default()),
        Box::new(Parry::new(rings.clone(), Climbing::First)),
        Box::new(Parry::new(rings, Climbing::Steepest)),
    ])
}

fn shape(mesh: &PolygonMesh) -> Result<Rc<Shape>, String> {
    Ok(Rc::new(Shape::from_mesh(mesh, &ShapeOptions::default()).map_err(|e| e.to_string())?))
}

/// FCL takes its turns when these methods have taken theirs: it takes thirty times as long, and what it leaves in the caches and
/// the branch predictors costs those after it up to a tenth, the fastest the most.
const FIRST_TURNS: usize = 3;

fn times(methods: &mut [Box<dyn Method>], options: &Options, count: usize) -> Vec<Time> {
    let is_split = options.query == Query::Distance && options.methods.is_empty();
    let (first, second) = methods.split_at_mut(if is_split { FIRST_TURNS } else { methods.len() });
    [time_methods(first, count, options.passes), time_methods(second, count, options.passes)].concat()
}
