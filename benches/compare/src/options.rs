//! The command line.

use std::path::PathBuf;

use crate::setting::Query;
use testkit::models::ELLIPSOIDS;
use testkit::orbits::{ORBITS, STEPS, Step};

pub const HELP: &str = "\
Speed and accuracy of exact distance: swiftprox beside parry3d-f64 and FCL, on ellipsoids that orbit one another.

usage: compare [options]
  --n LIST          vertices of the models (1002)
  --models LIST     of fat, plate, long (all)
  --orbits LIST     of small, large, deep (all)
  --steps LIST      degrees a query, or random (0.1,1,5,10,20,45,90,random)
  --query QUERY     distance; intersection, the verdict alone; or depth, on the intersecting poses, and of resting boxes unless
                    --without-boxes (distance)
  --beside-box      body 2 is a cube of the same bounding radius, not another such body; distance only, without FCL
  --methods LIST    of swiftprox, parry-hc, parry-hc-matrix, parry-hc-steepest, fcl-1e-6, fcl-1e-10 (all);
                    of intersection, of swiftprox, libccd-mpr-1e-4; answers are compared with those of the first of them;
                    of depth, of swiftprox, which may be asked for an error (swiftprox-1e-3), coal, mujoco, jolt, parry-hc,
                    libccd-epa, libccd-mpr, bullet, fcl, most of them with a tolerance (coal-1e-10)
  --count N         poses a scene (3600)
  --passes N        timed passes over each scene (9)
  --workload DIR    MODEL.off and ORBIT_STEP.poses from DIR instead of the built-in generator
  --figures LIST    time the figures of Ehmann & Lin (2000) instead: of 5 to 12, choice (the automatic choice against the
                    fixed ones), error (approximate distances), size (models of up to 200,000 triangles), or all; a
                    figure has its own sizes, orbits and steps
  --bodies LIST     time distances, verdicts, depths and manifolds of bodies whose names begin so, or all, instead: ellipsoids,
                    boxes, prisms, bodies of revolution, and a box beside each of those; at the steps of that option;
                    --meshes DIR adds the hulls of the OFF files in DIR. Some of the answers are held against the truth in integers
  --asked LIST      with --bodies: of distance, verdict, depth, manifold (all)
  --cold            with --bodies: each query as if it were the first; caches are new, peers' guesses and hints dropped
  --instructions OUT
                    with --bodies and --csv, under valgrind --tool=callgrind --instr-atstart=no --callgrind-out-file=OUT: count the
                    instructions of queries instead of timing them
  --crowd LIST      time scenes of so many bodies instead, step by step; --count is the number of steps of 1,000, --methods of
                    swiftprox, swiftprox-2 (two threads), parry, parry-rebuilt, sweep-and-prune, fcl; no method takes more than
                    two seconds on a scene, or three steps
  --motions LIST    with --crowd: of all, brisk, 5%, 1%, rest, teleport (all)
  --resting         time depths and manifolds of four points of bodies at rest instead, scene by scene; --methods of swiftprox,
                    swiftprox-manifold, coal-1e-10, mujoco-1e-6, jolt-1e-6, bullet-1e-4, libccd-mpr-1e-4,
                    parry-hc, and manifolds: box3d-manifold, mujoco-manifold-1e-6, bullet-manifold-0, parry-manifold
  --grounds         time contacts of 1,000 bodies at rest and sliding on a ground of 20,000 triangles instead; --count is rounded up to
                    thousands, --methods of swiftprox, parry, parry-fixed
  --compounds       time bodies of 16 to 500 pieces beside parry, coal, FCL and Bullet instead: verdicts, distances, contacts, an
                    arm and scenes; --count is the number of poses of each motion
  --casts LIST      time casts of the scenes whose names begin so, or all, beside parry, FCL, Bullet and samples instead, and
                    rays; --count is the number of motions a scene, a quarter of that of rays
  --build           time the building of shapes instead
  --answers METHOD A B POSES
                    print METHOD's answers for two meshes and a file of poses instead, in the form that
                    benches/stability reads; METHOD is parry, parry-hull or parry-hc
  --depths METHOD A B POSES
                    the same of depths, in the form that benches/stability/depths.py reads; METHOD is one of --query depth
  --csv FILE        write the results there, too
lists are separated by commas
";

pub struct Options {
    pub vertices: Vec<usize>,
    pub models: Vec<String>,
    pub orbits: Vec<String>,
    pub steps: Vec<Step>,
    pub query: Query,
    pub depth: bool,
    pub beside_box: bool,
    pub without_boxes: bool,
    /// Empty: all.
    pub methods: Vec<String>,
    pub count: usize,
    pub passes: usize,
    pub workload: Option<PathBuf>,
    pub resting: bool,
    pub grounds: bool,
    pub compounds: bool,
    pub build: bool,
    /// Numbers of bodies.
    pub crowd: Option<Vec<usize>>,
    /// Of a crowd; empty: all.
    pub motions: Vec<String>,
    /// Beginnings of names; empty: all.
    pub casts: Option<Vec<String>>,
    pub answers: Option<[String; 4]>,
    pub depths: Option<[String; 4]>,
    /// Which figures; empty: all.
    pub figures: Option<Vec<String>>,
    /// Beginnings of names; empty: all.
    pub bodies: Option<Vec<String>>,
    /// Where callgrind writes: instructions are counted, not times.
    pub instructions: Option<PathBuf>,
    pub meshes: Option<PathBuf>,
    /// Names of questions about bodies; empty: all.
    pub asked: Vec<String>,
    pub cold: bool,
    pub csv: Option<PathBuf>,
    pub help: bool,
}

/// # Errors
/// A message about the first argument that is not understood.
pub fn parse(arguments: impl IntoIterator<Item = String>) -> Result<Options, String> {
    let mut options = Options {
        vertices: vec![1002],
        models: ELLIPSOIDS.iter().map(|(name, _)| name.to_string()).collect(),
        orbits: ORBITS.iter().map(|orbit| orbit.name.to_string()).collect(),
        steps: STEPS.to_vec(),
        query: Query::Distance,
        depth: false,
        beside_box: false,
        without_boxes: false,
        methods: Vec::new(),
        count: 3600,
        passes: 9,
        workload: None,
        resting: false,
        grounds: false,
        compounds: false,
        build: false,
        crowd: None,
        motions: Vec::new(),
        casts: None,
        answers: None,
        depths: None,
        figures: None,
        bodies: None,
        instructions: None,
        meshes: None,
        asked: Vec::new(),
        cold: false,
        csv: None,
        help: false,
    };
    let mut arguments = arguments.into_iter();
    while let Some(name) = arguments.next() {
        let mut value = || arguments.next().ok_or_else(|| format!("{name}: a value is missing"));
        let number = |text: &str| text.parse().map_err(|_| format!("{name}: {text} is not a number"));
        match name.as_str() {
            "--n" => options.vertices = list(&value()?).map(number).collect::<Result<_, _>>()?,
            "--models" => options.models = list(&value()?).map(str::to_string).collect(),
            "--orbits" => options.orbits = list(&value()?).map(str::to_string).collect(),
            "--steps" => options.steps = list(&value()?).map(str::parse).collect::<Result<_, _>>()?,
            "--query" => {
                let query = value()?;
                options.depth = query == "depth";
                options.query = match query.as_str() {
                    "distance" | "depth" => Query::Distance,
                    "intersection" => Query::Intersection,
                    other => return Err(format!("--query: {other} is neither distance, intersection nor depth")),
                }
            }
            "--beside-box" => options.beside_box = true,
            "--without-boxes" => options.without_boxes = true,
            "--methods" => options.methods = list(&value()?).map(str::to_string).collect(),
            "--count" => options.count = number(&value()?)?.max(1),
            "--passes" => options.passes = number(&value()?)?.max(1),
            "--workload" => options.workload = Some(value()?.into()),
            "--crowd" => options.crowd = Some(list(&value()?).map(number).collect::<Result<_, _>>()?),
            "--motions" => options.motions = list(&value()?).map(str::to_string).collect(),
            "--resting" => options.resting = true,
            "--grounds" => options.grounds = true,
            "--compounds" => options.compounds = true,
            "--casts" => {
                options.casts = Some(list(&value()?).filter(|name| *name != "all").map(str::to_string).collect())
            }
            "--build" => options.build = true,
            "--answers" => options.answers = Some([value()?, value()?, value()?, value()?]),
            "--depths" => options.depths = Some([value()?, value()?, value()?, value()?]),
            "--figures" => {
                options.figures = Some(list(&value()?).filter(|name| *name != "all").map(str::to_string).collect())
            }
            "--bodies" => {
                options.bodies = Some(list(&value()?).filter(|name| *name != "all").map(str::to_string).collect())
            }
            "--instructions" => options.instructions = Some(value()?.into()),
            "--meshes" => options.meshes = Some(value()?.into()),
            "--asked" => options.asked = list(&value()?).map(str::to_string).collect(),
            "--cold" => options.cold = true,
            "--csv" => options.csv = Some(value()?.into()),
            "--help" => options.help = true,
            _ => return Err(format!("{name}: no such option (see --help)")),
        }
    }
    if options.beside_box && (options.depth || options.query != Query::Distance) {
        return Err("--beside-box: only for distance".into());
    }
    Ok(options)
}

fn list(text: &str) -> impl Iterator<Item = &str> {
    text.split(',').filter(|item| !item.is_empty())
}
