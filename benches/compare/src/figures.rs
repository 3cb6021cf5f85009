//! The figures of Ehmann & Lin (2000), section 6, measured anew: nanoseconds a query over the motion from one query to the
//! next, for each pair of models, under the settings of each figure. Beside them what the paper did not measure: the automatic
//! choice against every fixed one, the cost of an approximate distance over the error asked for, and larger models.

use std::fmt::Write;
use std::rc::Rc;

use swiftprox::body::tables::{LookupKind, LookupOptions};
use swiftprox::error::Result;
use swiftprox::hierarchy::{HierarchyKind, HierarchyOptions};
use swiftprox::mesh::PolygonMesh;
use swiftprox::pair::{Levels, PairConfig, Refinement, Start};
use swiftprox::shape::{Shape, ShapeOptions};

use crate::marches::Marching;
use crate::method::{Method, Reply, replies};
use crate::options::Options;
use crate::setting::{Query, setting, verdict_by_marching};
use crate::timing::{Time, time_methods};
use crate::{model, motion, report};
use testkit::PosePair;
use testkit::orbits::{STEPS, Step};

/// One figure: its name, orbits, sizes of the models, steps, and what it shows.
pub struct Figure {
    pub name: &'static str,
    orbits: &'static [&'static str],
    sizes: &'static [usize],
    steps: &'static [Step],
    series: fn(&PolygonMesh) -> Result<Vec<Series>>,
}

const SOME_STEPS: [Step; 4] = [Step::Degrees(0.1), Step::Degrees(1.0), Step::Degrees(10.0), Step::Random];
const PAPER: [usize; 1] = [1002];
/// 2,000, 20,000 and 200,000 triangles.
const GROWING: [usize; 3] = [1002, 10_002, 100_002];

#[rustfmt::skip]
pub const FIGURES: [Figure; 11] = [
    Figure { name: "5", orbits: &["small"], sizes: &PAPER, steps: &STEPS, series: rules },
    Figure { name: "6", orbits: &["small"], sizes: &PAPER, steps: &STEPS, series: tables },
    Figure { name: "7", orbits: &["small"], sizes: &PAPER, steps: &STEPS, series: |mesh| cut_offs(mesh, Query::Intersection) },
    Figure { name: "8", orbits: &["small"], sizes: &PAPER, steps: &STEPS, series: |mesh| cut_offs(mesh, Query::Distance) },
    Figure { name: "9", orbits: &["small"], sizes: &PAPER, steps: &STEPS, series: |mesh| rates(mesh, Query::Intersection) },
    Figure { name: "10", orbits: &["small"], sizes: &PAPER, steps: &STEPS, series: |mesh| rates(mesh, Query::Distance) },
    Figure { name: "11", orbits: &["small", "large"], sizes: &PAPER, steps: &STEPS, series: |mesh| best(mesh, Query::Intersection) },
    Figure { name: "12", orbits: &["small", "large"], sizes: &PAPER, steps: &STEPS, series: |mesh| best(mesh, Query::Distance) },
    Figure { name: "choice", orbits: &["small", "large", "deep"], sizes: &PAPER, steps: &STEPS, series: choices },
    Figure { name: "error", orbits: &["small", "large", "deep"], sizes: &PAPER, steps: &SOME_STEPS, series: errors },
    Figure { name: "size", orbits: &["small"], sizes: &GROWING, steps: &SOME_STEPS, series: sizes },
];

/// A line of a figure, or a point of one.
struct Series {
    query: Query,
    /// The absolute error asked for.
    error: f64,
    method: Box<dyn Method>,
}

impl Series {
    fn new(name: impl Into<String>, query: Query, shape: &Rc<Shape>, config: PairConfig) -> Series {
        Series { query, error: config.absolute_error, method: setting(name, query, shape, config) }
    }

    /// As in the paper: a verdict by marching alone.
    fn of_paper(name: impl Into<String>, query: Query, shape: &Rc<Shape>, config: PairConfig) -> Series {
        match query {
            Query::Intersection => Series { query, error: 0.0, method: verdict_by_marching(name, shape, config) },
            _ => Series::new(name, query, shape, config),
        }
    }
}

// ---------------------------------------------------------------------------------------------------------------------
// The settings
// ---------------------------------------------------------------------------------------------------------------------

const NO_TABLE: LookupOptions = LookupOptions { kind: LookupKind::None, ..LookupOptions::DEFAULT };

/// From the last features whatever the motion, through no levels: "simple marching".
fn simple() -> PairConfig {
    config(Start::Cache, Levels::None, Refinement::Adaptive)
}

/// Where the tables say, whatever the motion.
fn by_tables() -> PairConfig {
    config(Start::Table, Levels::None, Refinement::Adaptive)
}

/// As Ehmann & Lin: through all levels, from the parents of the last features.
fn through_levels(refinement: Refinement) -> PairConfig {
    config(Start::Cache, Levels::All, refinement)
}

fn config(start: Start, levels: Levels, refinement: Refinement) -> PairConfig {
    PairConfig { start, levels, refinement, ..PairConfig::default() }
}

fn shape(mesh: &PolygonMesh, lookup: LookupOptions, hierarchy: HierarchyOptions) -> Result<Rc<Shape>> {
    Ok(Rc::new(Shape::from_mesh(mesh, &ShapeOptions { lookup, hierarchy, ..ShapeOptions::default() })?))
}

fn spherical(resolution: u32, radius_factor: f64) -> LookupOptions {
    LookupOptions { kind: LookupKind::Spherical, resolution, radius_factor }
}

fn dobkin_kirkpatrick(minimum_triangles: usize) -> HierarchyOptions {
    HierarchyOptions { kind: HierarchyKind::DobkinKirkpatrick, minimum_triangles, ..HierarchyOptions::default() }
}

/// Levels with so much of the triangles left from one to the next.
fn decimated(kind: HierarchyKind, decimation: f64) -> HierarchyOptions {
    HierarchyOptions { kind, decimation, ..HierarchyOptions::default() }
}

fn none() -> HierarchyOptions {
    HierarchyOptions { kind: HierarchyKind::None, ..HierarchyOptions::default() }
}

/// Figure 5: the rule by which marching goes on.
fn rules(mesh: &PolygonMesh) -> Result<Vec<Series>> {
    let bare = shape(mesh, NO_TABLE, none())?;
    let methods: [Box<dyn Method>; 2] = [
        Box::new(Marching::<false>::new("most violated", bare.clone())),
        Box::new(Marching::<true>::new("first violated", bare)),
    ];
    Ok(methods.map(|method| Series { query: Query::Distance, error: 0.0, method }).into())
}

/// Figure 6: look-up tables. The radius factor and the resolution in degrees.
fn tables(mesh: &PolygonMesh) -> Result<Vec<Series>> {
    let config = by_tables();
    let mut all = Vec::new();
    for (resolution, degrees) in [(32, "5.625"), (16, "11.25")] {
        for factor in [1.0, 2.0, 4.0] {
            let shape = shape(mesh, spherical(resolution, factor), none())?;
            all.push(Series::new(format!("{factor} {degrees}"), Query::Distance, &shape, config));
        }
    }
    let shape = shape(mesh, LookupOptions::DEFAULT, none())?;
    all.push(Series::new("shells", Query::Distance, &shape, config));
    Ok(all)
}

const POLICIES: [(&str, Refinement); 3] = [
    ("Single", Refinement::Single),
    ("Single-Single", Refinement::SingleSingle),
    ("Double-Double", Refinement::DoubleDouble),
];

/// Figures 7 and 8: Dobkin and Kirkpatrick's levels. The triangles at which they end, and the refinement.
fn cut_offs(mesh: &PolygonMesh, query: Query) -> Result<Vec<Series>> {
    let mut all = Vec::new();
    for minimum in [20, 100, 250] {
        let shape = shape(mesh, NO_TABLE, dobkin_kirkpatrick(minimum))?;
        for (name, refinement) in POLICIES {
            let name = format!("{minimum} {name}");
            all.push(Series::of_paper(name, query, &shape, through_levels(refinement)));
        }
    }
    Ok(all)
}

/// Figures 9 and 10: quadric levels, and cut ones. The fraction of triangles left and the number of levels, the body itself
/// counted.
fn rates(mesh: &PolygonMesh, query: Query) -> Result<Vec<Series>> {
    let mut all = Vec::new();
    for (kind, word, decimations) in [
        (HierarchyKind::Quadric, "quadric", &[0.5, 0.25, 0.125, 0.0625, 0.03125][..]),
        (HierarchyKind::OuterCuts, "cuts", &[0.25, 0.03125][..]),
    ] {
        for &decimation in decimations {
            let shape = shape(mesh, NO_TABLE, decimated(kind, decimation))?;
            let name = format!("{word} {decimation} ({})", 1 + shape.hierarchy().levels.len());
            all.push(Series::of_paper(name, query, &shape, through_levels(Refinement::SingleSingle)));
        }
    }
    Ok(all)
}

/// Figures 11 and 12: the best of each, and ours.
fn best(mesh: &PolygonMesh, query: Query) -> Result<Vec<Series>> {
    let bare = shape(mesh, NO_TABLE, none())?;
    let table = shape(mesh, spherical(32, 2.0), none())?;
    let removed = shape(mesh, NO_TABLE, dobkin_kirkpatrick(100))?;
    let quadric = shape(mesh, NO_TABLE, decimated(HierarchyKind::Quadric, 0.03125))?;
    let cuts = shape(mesh, NO_TABLE, decimated(HierarchyKind::OuterCuts, 0.03125))?;
    let ours = shape(mesh, LookupOptions::DEFAULT, none())?;
    Ok(vec![
        Series::of_paper("nothing", query, &bare, simple()),
        Series::of_paper("LUT 2 5.625", query, &table, by_tables()),
        Series::of_paper("DK 100 Double-Double", query, &removed, through_levels(Refinement::DoubleDouble)),
        Series::of_paper("quadric 0.03125", query, &quadric, through_levels(Refinement::SingleSingle)),
        Series::of_paper("cuts 0.03125", query, &cuts, through_levels(Refinement::SingleSingle)),
        Series::new("automatic", query, &ours, PairConfig::default()),
    ])
}

/// The automatic choice, and all that it could have been. No two of the same code follow each other, see [`crate::timing`].
fn choices(mesh: &PolygonMesh) -> Result<Vec<Series>> {
    let ours = shape(mesh, LookupOptions::DEFAULT, none())?;
    let quadric = shape(mesh, LookupOptions::DEFAULT, decimated(HierarchyKind::Quadric, 0.03125))?;
    let cuts = shape(mesh, LookupOptions::DEFAULT, decimated(HierarchyKind::OuterCuts, 0.25))?;
    let mut all = Vec::new();
    for query in [Query::Intersection, Query::Approximate, Query::Distance, Query::Contact] {
        let absolute_error = if query == Query::Approximate { 1e-2 } else { 0.0 };
        let mut add = |name, shape, start, levels| {
            let config = PairConfig { absolute_error, ..config(start, levels, Refinement::Adaptive) };
            all.push(Series::new(name, query, shape, config));
        };
        add("automatic", &ours, Start::Automatic, Levels::Automatic);
        add("quadric 0.03125", &quadric, Start::Automatic, Levels::All);
        add("cache", &ours, Start::Cache, Levels::None);
        add("cold", &ours, Start::Cold, Levels::None);
        add("cuts 0.25", &cuts, Start::Automatic, Levels::All);
        add("table", &ours, Start::Table, Levels::None);
    }
    Ok(all)
}

/// Of the models' radius, 1.
const ERRORS: [f64; 8] = [1e-1, 3e-2, 1e-2, 3e-3, 1e-3, 1e-4, 1e-5, 1e-6];

/// Approximate distances between intersection (an infinite error) and exact distance (none).
fn errors(mesh: &PolygonMesh) -> Result<Vec<Series>> {
    let mut all = Vec::new();
    for (name, hierarchy, levels) in [
        ("no levels", none(), Levels::Automatic),
        ("quadric 0.25", decimated(HierarchyKind::Quadric, 0.25), Levels::All),
        ("quadric 0.03125", decimated(HierarchyKind::Quadric, 0.03125), Levels::All),
        ("cuts 0.25", decimated(HierarchyKind::OuterCuts, 0.25), Levels::All),
    ] {
        let shape = shape(mesh, LookupOptions::DEFAULT, hierarchy)?;
        let mut add = |query, absolute_error| {
            let config = PairConfig { absolute_error, ..config(Start::Automatic, levels, Refinement::Adaptive) };
            all.push(Series::new(name, query, &shape, config));
        };
        add(Query::Intersection, f64::INFINITY);
        for error in ERRORS {
            add(Query::Approximate, error);
        }
        add(Query::Distance, 0.0);
    }
    Ok(all)
}

/// Two, three and four levels down to about 62 triangles, and levels from the tables, against none.
fn sizes(mesh: &PolygonMesh) -> Result<Vec<Series>> {
    let triangles = mesh.face_count() as f64;
    let mut shapes = vec![
        ("nothing", shape(mesh, NO_TABLE, none())?, simple()),
        ("LUT 2 5.625", shape(mesh, spherical(32, 2.0), none())?, by_tables()),
    ];
    for (count, name) in [(1, "2 levels"), (2, "3 levels"), (3, "4 levels")] {
        let decimation = (62.0 / triangles).powf(1.0 / f64::from(count));
        let quadric = shape(mesh, NO_TABLE, decimated(HierarchyKind::Quadric, decimation))?;
        shapes.push((name, quadric, through_levels(Refinement::SingleSingle)));
    }
    // Each its own shape, so that none finds what the one before has left in the machine's caches.
    for (name, hierarchy, levels) in [
        ("levels and table", decimated(HierarchyKind::Quadric, 0.25), Levels::All),
        ("table alone", none(), Levels::None),
        ("automatic", HierarchyOptions::default(), Levels::Automatic),
    ] {
        let ours = shape(mesh, LookupOptions::DEFAULT, hierarchy)?;
        shapes.push((name, ours, config(Start::Automatic, levels, Refinement::Adaptive)));
    }
    let mut all = Vec::new();
    for query in [Query::Intersection, Query::Approximate, Query::Distance] {
        let absolute_error = if query == Query::Approximate { 1e-2 } else { 0.0 };
        for (name, shape, config) in &shapes {
            all.push(Series::new(*name, query, shape, PairConfig { absolute_error, ..*config }));
        }
    }
    Ok(all)
}

// ---------------------------------------------------------------------------------------------------------------------
// The measurement
// ---------------------------------------------------------------------------------------------------------------------

pub fn run(options: &Options, wanted: &[String]) -> std::result::Result<(), String> {
    let mut csv =
        "figure,model,n,orbit,step,query,error,series,best_ns,median_ns,mean_steps,by_levels,undone,mean_width\n"
            .to_string();
    let known = |name: &String| FIGURES.iter().any(|figure| figure.name == name);
    if let Some(name) = wanted.iter().find(|name| !known(name)) {
        return Err(format!("--figures: there is none called {name}"));
    }
    for figure in FIGURES.iter().filter(|figure| wanted.is_empty() || wanted.iter().any(|name| name == figure.name)) {
        for &n in figure.sizes {
            for name in &options.models {
                let series = (figure.series)(&model(options, name, n)?).map_err(|e| e.to_string())?;
                let (asked, mut methods): (Vec<_>, Vec<_>) =
                    series.into_iter().map(|series| ((series.query, series.error), series.method)).unzip();
                for orbit in figure.orbits {
                    for &step in figure.steps {
                        let scene = format!("{},{name},{n},{orbit},{step}", figure.name);
                        let poses = motion(options, orbit, step)?;
                        let told: Vec<[f64; 4]> =
                            methods.iter_mut().map(|method| tell(method.as_mut(), &poses)).collect();
                        let times = time_methods(&mut methods, poses.len(), options.passes);
                        for (i, [steps, by_levels, undone, width]) in told.into_iter().enumerate() {
                            let ((query, error), series) = (asked[i], methods[i].name());
                            let (query, Time { best, median }) = (query.name(), times[i]);
                            let _ = writeln!(
                                csv,
                                "{scene},{query},{error},{series},{best:.1},{median:.1},{steps:.2},{by_levels:.3},{undone:.4},{width:.2e}"
                            );
                        }
                        eprintln!("{scene} done");
                    }
                }
            }
        }
    }
    match &options.csv {
        Some(path) => report::write(path, options.passes, &csv),
        None => {
            print!("{csv}");
            Ok(())
        }
    }
}

/// Means over a pass: steps, the fraction of answers that came from levels, the fraction that marching did not come to, the
/// width of the intervals of disjoint pairs.
fn tell(method: &mut dyn Method, poses: &[PosePair]) -> [f64; 4] {
    method.load(poses);
    let replies = replies(method, poses.len());
    let share = |is: fn(&Reply) -> bool| replies.iter().filter(|reply| is(reply)).count() as f64 / poses.len() as f64;
    let steps = replies.iter().map(|reply| reply.steps).sum::<f64>() / poses.len() as f64;
    let widths = || replies.iter().filter(|reply| reply.distance > 0.0 && reply.width().is_finite()).map(Reply::width);
    let width = widths().sum::<f64>() / widths().count() as f64;
    [steps, share(|reply| reply.by_levels), share(|reply| reply.fallback || reply.exact), width]
}
