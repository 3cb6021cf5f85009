//! `compare --help`.

mod accuracy;
mod answers;
mod bodies;
mod build_time;
mod callgrind;
mod cast;
mod compound;
mod crowd;
mod depth;
mod distance;
mod figures;
mod ground;
mod marches;
mod method;
mod options;
mod parry;
mod peers;
mod report;
mod resting;
mod setting;
mod timing;

use options::Options;
use swiftprox::mesh::PolygonMesh;
use swiftprox::mesh_io::read_mesh;
use testkit::PosePair;
use testkit::models::{ELLIPSOIDS, ellipsoid};
use testkit::orbits::{ORBITS, Orbit, Step, poses};

fn main() -> ! {
    let run = || {
        let options = options::parse(std::env::args().skip(1))?;
        if options.help {
            print!("{}", options::HELP);
            return Ok(());
        }
        if let Some(arguments) = &options.answers {
            return answers::run(arguments);
        }
        if let Some(arguments) = &options.depths {
            return depth::answers::run(arguments);
        }
        if let Some(wanted) = &options.figures {
            figures::run(&options, wanted)
        } else if let Some(wanted) = &options.bodies {
            bodies::run(&options, wanted)
        } else if let Some(wanted) = &options.casts {
            cast::run(&options, wanted)
        } else if let Some(counts) = &options.crowd {
            crowd::run(&options, counts)
        } else if options.build {
            build_time::run(&options)
        } else if options.resting {
            resting::run(&options)
        } else if options.grounds {
            ground::run(&options)
        } else if options.compounds {
            compound::run(&options)
        } else if options.depth {
            depth::run(&options)
        } else {
            distance::run(&options)
        }
    };
    match run() {
        Ok(()) => peers::end(0),
        Err(message) => {
            let message: String = message;
            eprintln!("compare: {message}");
            peers::end(2)
        }
    }
}

/// The model of that name with `n` vertices, or the workload's.
fn model(options: &Options, name: &str, n: usize) -> Result<PolygonMesh, String> {
    if let Some(directory) = &options.workload {
        return read_mesh(&directory.join(format!("{name}.off"))).map_err(|e| e.to_string());
    }
    let known = ELLIPSOIDS.iter().find(|(known, _)| *known == name);
    let (_, half_axes) = known.ok_or_else(|| format!("{name}: no such model"))?;
    ellipsoid(*half_axes, n).map_err(|e| e.to_string())
}

fn motion(options: &Options, orbit: &str, step: Step) -> Result<Vec<PosePair>, String> {
    if let Some(directory) = &options.workload {
        return testkit::files::read_poses(&directory.join(format!("{orbit}_{step}.poses")), options.count);
    }
    let known: Option<&Orbit> = ORBITS.iter().find(|known| known.name == orbit);
    Ok(poses(*known.ok_or_else(|| format!("{orbit}: no such orbit"))?, step, options.count))
}
