//! The look-up tables: sizes, entries, look-up, and that no answer depends on them.

use std::f64::consts::PI;
use std::time::Instant;
use std::{ptr, thread};

use swiftprox::base::simd::Portable;
use swiftprox::body::polyhedron::Polyhedron;
use swiftprox::body::polyhedron::lookup::{Cells, Plan, Shells, Spherical, Table};
use swiftprox::body::tables::nearest_vertex::{AllVertices, NearestVertex};
use swiftprox::body::tables::tuning::LEAST_VERTICES_FOR_TABLE;
use swiftprox::body::tables::{LookupKind, LookupOptions, build_table, table};
use swiftprox::error::Error;
use swiftprox::math::{Pose, Vector};
use swiftprox::mesh::PolygonMesh;
use swiftprox::pair::start::policy::{self, StartFrom};
use swiftprox::pair::start::{Guess, start_pair};
use swiftprox::pair::{self, DecidedBy, Levels, Outcome, PairAnswer, PairCache, PairConfig, Start};
use swiftprox::placed::Pair;
use swiftprox::placed::frame::{Frame, Marker};
use swiftprox::placed::state::State;
use swiftprox::progress::Progress;
use swiftprox::shape::levels::point_distance::PointDistance;
use swiftprox::shape::{InputPolicy, Shape, ShapeOptions};
use swiftprox::verify::verify;
use testkit::models::{cuboid, ellipsoid, grid_on_cube, prism, random_hull};
use testkit::orbits::{ORBITS, Step, poses};
use testkit::random::{Random, rotation};

fn options(kind: LookupKind, resolution: u32) -> ShapeOptions {
    let lookup = LookupOptions { kind, resolution, ..LookupOptions::default() };
    ShapeOptions { input: InputPolicy::Hull, lookup, ..ShapeOptions::default() }
}

fn shape(mesh: &PolygonMesh, kind: LookupKind, resolution: u32) -> Shape {
    Shape::from_mesh(mesh, &options(kind, resolution)).unwrap()
}

/// Round, flat and long ones, a needle, a wafer, boxes, one off its origin, one whose two caps have vertices of high valence.
fn bodies() -> Vec<(&'static str, PolygonMesh)> {
    let mut moved = ellipsoid([1.0, 0.5, 0.25], 150).unwrap();
    for v in &mut moved.vertices {
        *v += Vector::new(7.0, -3.0, 0.5);
    }
    vec![
        ("fat", ellipsoid([1.0; 3], 300).unwrap()),
        ("plate", ellipsoid([1.0, 1.0, 0.1], 300).unwrap()),
        ("long", ellipsoid([1.0, 0.1, 0.1], 300).unwrap()),
        ("wafer", ellipsoid([1.0, 1.0, 1e-4], 300).unwrap()),
        ("needle", ellipsoid([1.0, 1e-4, 1e-4], 300).unwrap()),
        ("moved", moved),
        ("random", random_hull(2_000, 5).unwrap()),
        ("box", cuboid([1.0, 0.2, 0.7]).unwrap()),
        ("prism", prism(64, 0.3).unwrap()),
    ]
}

fn shells(polyhedron: &Polyhedron) -> &Shells {
    let Table::Shells(table) = table(polyhedron) else { panic!("shells") };
    table
}

fn spherical(polyhedron: &Polyhedron) -> &Spherical {
    let Table::Spherical(table) = table(polyhedron) else { panic!("spherical") };
    table
}

/// A point at a multiple of the body's radius from its centre of mass, in centred coordinates.
fn sample(polyhedron: &Polyhedron, factor: f64, direction: &Vector) -> Vector {
    polyhedron.mass.centre_of_mass - polyhedron.centre + direction * (factor * polyhedron.mass.radius)
}

/// The distance of a vertex from a point.
fn distance_of(polyhedron: &Polyhedron, vertex: u32, point: &Vector) -> f64 {
    (polyhedron.vertices[vertex as usize].position - point).norm()
}

fn least_distance(polyhedron: &Polyhedron, point: &Vector) -> f64 {
    polyhedron.vertices.iter().map(|v| (v.position - point).norm()).fold(f64::INFINITY, f64::min)
}

#[test]
fn spherical_tables_have_the_papers_sizes() {
    let mesh = ellipsoid([1.0, 0.6, 0.3], 200).unwrap();
    for (resolution, degrees, entries) in [(32, 5.625, 1986), (16, 11.25, 482), (8, 22.5, 114)] {
        assert_eq!((180.0 / degrees - 1.0) * (360.0 / degrees) + 2.0, f64::from(entries));
        let shape = shape(&mesh, LookupKind::Spherical, resolution);
        let table = spherical(shape.polyhedron());
        assert_eq!(table.cells.len(), entries as usize);
        assert!(matches!(&table.cells, Cells::Narrow(cells) if size_of_val(&cells[..]) == 2 * entries as usize));
    }
}

#[test]
fn spherical_entries_are_exactly_nearest() {
    for (name, mesh) in bodies() {
        for (resolution, radius_factor) in [(8, 1.0), (13, 2.0), (32, 50.0)] {
            let mut options = options(LookupKind::Spherical, resolution);
            options.lookup.radius_factor = radius_factor;
            let shape = Shape::from_mesh(&mesh, &options).unwrap();
            let polyhedron = shape.polyhedron();
            let table = spherical(polyhedron);
            for cell in 0..table.cells.len() {
                let point = sample(polyhedron, radius_factor, &Spherical::direction(table.resolution, cell));
                let found = distance_of(polyhedron, table.cells.get(cell), &point);
                assert_eq!(found, least_distance(polyhedron, &point), "{name}, entry {cell}");
            }
        }
    }
}

/// The entry by rounding the angles; `None` where that is a matter of rounding errors.
fn entry_by_angles(direction: &Vector, resolution: usize) -> Option<usize> {
    let increments = resolution as f64 / PI;
    let polar = (direction.z / direction.norm()).acos() * increments;
    let azimuth = direction.y.atan2(direction.x).rem_euclid(2.0 * PI) * increments;
    let is_close = |x: f64| (x - x.floor() - 0.5).abs() < 1e-6;
    let ring = polar.round() as usize;
    if is_close(polar) {
        return None;
    }
    match ring {
        0 => Some(0),
        ring if ring == resolution => Some(Spherical::cell_count(resolution) - 1),
        _ if is_close(azimuth) => None,
        ring => Some(1 + (ring - 1) * 2 * resolution + azimuth.round() as usize % (2 * resolution)),
    }
}

#[test]
fn spherical_look_up_rounds_the_angles() {
    let mesh = cuboid([1.0; 3]).unwrap();
    let mut random = Random::new(7);
    for resolution in [2, 3, 8, 16, 32, 45] {
        let shape = shape(&mesh, LookupKind::Spherical, resolution);
        let table = spherical(shape.polyhedron());
        let resolution = resolution as usize;
        let mut compared = 0;
        for _ in 0..20_000 {
            let direction = random.direction() * random.uniform(0.1, 10.0);
            if let Some(expected) = entry_by_angles(&direction, resolution) {
                assert_eq!(table.cell(&direction), expected, "{direction:?} at resolution {resolution}");
                compared += 1;
            }
        }
        assert!(compared > 19_900);
        for cell in 0..table.cells.len() {
            assert_eq!(table.cell(&Spherical::direction(resolution, cell)), cell);
        }
        // Directions that name no entry name some.
        for x in [0.0, f64::NAN, f64::INFINITY, 1e-320] {
            table.towards(&Vector::new(x, -x, x));
        }
    }
}

#[test]
fn shells_find_their_own_sample_points() {
    for (name, mesh) in bodies() {
        let shape = shape(&mesh, LookupKind::Shells, 16);
        let table = shells(shape.polyhedron());
        for (shell, radius) in table.radii.iter().enumerate() {
            for cell in 0..16 * 16 {
                let point = Shells::direction(16, cell / 16, cell % 16) * *radius;
                let found = table.nearest([point.x as f32, point.y as f32, point.z as f32]);
                assert_eq!(found, table.cells.get(shell * 16 * 16 + cell), "{name}, shell {shell}, cell {cell}");
            }
        }
        for x in [0.0, f32::NAN, f32::INFINITY, f32::MAX, 1e-40, -1e-40] {
            table.nearest([x, 0.0, 0.0]);
            table.nearest([x, x, x]);
            table.nearest([0.0, x, -x]);
        }
    }
}

#[test]
fn no_neighbour_of_a_shells_vertex_is_nearer_and_mostly_no_other() {
    // Needles have vertices of the nearest features instead.
    for (name, mesh) in bodies().into_iter().filter(|(name, _)| *name != "needle") {
        let shape = shape(&mesh, LookupKind::Shells, 32);
        let polyhedron = shape.polyhedron();
        let table = shells(polyhedron);
        let (mut nearest, mut worst) = (0, 1.0_f64);
        for index in 0..table.cells.len() {
            let cell = index % (32 * 32);
            let direction = Shells::direction(32, cell / 32, cell % 32);
            let point = sample(polyhedron, table.radii[index / (32 * 32)], &direction);
            let vertex = table.cells.get(index);
            let found = distance_of(polyhedron, vertex, &point);
            for block in polyhedron.neighbour_blocks(vertex) {
                for head in block.head {
                    assert!(distance_of(polyhedron, head, &point) >= found, "{name}: {head} is nearer than {vertex}");
                }
            }
            let least = least_distance(polyhedron, &point);
            nearest += usize::from(found == least);
            worst = worst.max(found / least);
        }
        let share = nearest as f64 / table.cells.len() as f64;
        println!("{name}: {share:.5} of the entries are the nearest vertex of all, {worst:.3} times as far at worst");
        assert!(share > if name == "wafer" { 0.3 } else { 0.85 });
    }
}

#[test]
fn entries_of_needles_are_vertices_of_the_nearest_feature() {
    for thickness in [1e-2, 1e-4] {
        let shape = shape(&ellipsoid([1.0, thickness, thickness], 300).unwrap(), LookupKind::Shells, 16);
        let polyhedron = shape.polyhedron();
        let table = shells(polyhedron);
        let exact = PointDistance::new(polyhedron).unwrap();
        let (mut outside, mut on_feature, mut nearest) = (0, 0, 0);
        for index in 0..table.cells.len() {
            let cell = index % (16 * 16);
            let direction = Shells::direction(16, cell / 16, cell % 16);
            let point = sample(polyhedron, table.radii[index / (16 * 16)], &direction);
            let vertex = table.cells.get(index);
            let found = exact.nearest(&point, vertex);
            if (found.point - point).norm() > 0.0 {
                outside += 1;
                on_feature += usize::from(found.vertex == vertex);
                nearest += usize::from(distance_of(polyhedron, vertex, &point) == least_distance(polyhedron, &point));
            }
        }
        let share = |count: usize| count as f64 / outside as f64;
        println!(
            "1:{:.0}: {:.2} on the nearest feature, {:.2} nearest",
            1.0 / thickness,
            share(on_feature),
            share(nearest)
        );
        // Where the walk ends on a face that looks away, the entry is on that.
        assert!(share(on_feature) > 0.95 && share(on_feature) > share(nearest) + 0.1);
    }
}

/// All cells of a long cone's table are near its apex or its rim; found by looking at all the faces around the apex in every cell,
/// it took 3,000 times as long as that of a short cone.
#[test]
fn the_table_of_a_needle_with_a_peak_is_made_in_no_time() {
    let cone = |length: f64| {
        let angle = |k: u32| 2.0 * PI * f64::from(k) / 3_000.0;
        let rim = (0..3_000).map(|k| Vector::new(angle(k).cos(), angle(k).sin(), 0.0));
        let points: Vec<Vector> = rim.chain([Vector::new(0.0, 0.0, length)]).collect();
        Shape::from_points(&points, &ShapeOptions::default()).unwrap()
    };
    let [long, short] = [200.0, 3.0].map(|length| {
        let shape = cone(length);
        let start = Instant::now();
        build_table(shape.polyhedron()).unwrap();
        start.elapsed()
    });
    assert!(long < 300 * short, "{long:?} for {short:?}");
}

/// Steps of marching from the tables and afresh, for two like bodies at random poses, and how many of the disjoint pairs marching
/// did not decide.
fn steps_of_disjoint_pairs(half_axes: [f64; 3]) -> ([f64; 2], [f64; 2]) {
    let shape = shape(&ellipsoid(half_axes, 1_002).unwrap(), LookupKind::Shells, 0);
    let mut random = Random::new(5);
    let (mut disjoint, mut steps, mut undecided) = (0, [0; 2], [0; 2]);
    for _ in 0..600 {
        let away = random.direction() * random.uniform(0.3, 2.0);
        let [pose1, pose2] = [Vector::zeros(), away].map(|t| Pose::new(&random.rotation(), &t));
        let mut is_disjoint = false;
        for (i, start) in [Start::Table, Start::Cold].into_iter().enumerate() {
            let config = PairConfig { start, ..PairConfig::default() };
            let mut answer = PairAnswer::default();
            pair::distance([shape.at(&pose1), shape.at(&pose2)], &mut PairCache::default(), &config, &mut answer)
                .unwrap();
            is_disjoint = answer.outcome == Outcome::Separated;
            if is_disjoint {
                steps[i] += answer.statistics.marching_steps;
                undecided[i] += usize::from(answer.decided_by != DecidedBy::Marching);
            }
        }
        disjoint += usize::from(is_disjoint);
    }
    let disjoint = disjoint as f64;
    (steps.map(|count| f64::from(count) / disjoint), undecided.map(|count| count as f64 / disjoint))
}

/// Needles and wafers at random poses, on few of them.
#[test]
fn tables_of_thin_bodies_save_two_fifths_of_the_steps() {
    for thickness in [1e-1, 1e-2, 1e-3, 1e-4] {
        for (name, half_axes) in [("wafer", [1.0, 1.0, thickness]), ("needle", [1.0, thickness, thickness])] {
            let ([steps, steps_afresh], [undecided, undecided_afresh]) = steps_of_disjoint_pairs(half_axes);
            println!(
                "{name} 1:{:.0}: steps {steps:.1}, afresh {steps_afresh:.1}; not by marching {undecided:.3}, {undecided_afresh:.3}",
                1.0 / thickness
            );
            assert!(steps < 0.6 * steps_afresh, "{name} {thickness}");
        }
    }
}

#[test]
fn thin_bodies_have_shells_within_their_bounding_sphere() {
    let count = |half_axes, n| {
        let shape = shape(&ellipsoid(half_axes, n).unwrap(), LookupKind::Shells, 8);
        shells(shape.polyhedron()).radii.len()
    };
    assert_eq!(count([1.0, 1.0, 1.0], 300), 5);
    assert_eq!(count([1.0, 1.0, 0.6], 300), 6);
    assert_eq!(count([1.0, 1.0, 0.1], 300), 8);
    assert_eq!(count([1.0, 0.1, 0.1], 300), 8);
}

#[test]
fn tables_are_made_where_they_are_asked_for() {
    let made = |mesh: &PolygonMesh, kind| table(shape(mesh, kind, 0).polyhedron()).clone();
    let (small, large) = (cuboid([1.0; 3]).unwrap(), ellipsoid([1.0; 3], LEAST_VERTICES_FOR_TABLE).unwrap());
    assert!(matches!(made(&small, LookupKind::Automatic), Table::AllVertices(blocks) if blocks.len() == 1));
    assert!(matches!(made(&large, LookupKind::Automatic), Table::Shells(_)));
    assert_eq!(made(&large, LookupKind::None), Table::None);
    // Squares on a cube make no large body of it.
    assert!(turned_grid(5, LookupKind::Automatic).polyhedron().vertices.len() > LEAST_VERTICES_FOR_TABLE);
    assert!(matches!(table(turned_grid(5, LookupKind::Automatic).polyhedron()), Table::AllVertices(_)));
    assert!(matches!(made(&small, LookupKind::Shells), Table::Shells(_)));
    assert!(matches!(made(&small, LookupKind::Spherical), Table::Spherical(t) if t.resolution == 32));
    // Equal input, equal tables.
    assert_eq!(made(&large, LookupKind::Automatic), made(&large, LookupKind::Automatic));
}

#[test]
fn tables_are_made_by_the_first_query_that_looks_into_them() {
    let shape = |kind| shape(&ellipsoid([1.0, 0.7, 0.4], 300).unwrap(), kind, 0);
    let bytes = |shape: &Shape| (shape.polyhedron().lookup.heap_bytes(), shape.bytes());
    let mut away = Pose::IDENTITY;
    away.rows[0][3] = 3.0;
    for (kind, start, looks) in [
        (LookupKind::Automatic, Start::Automatic, true),
        (LookupKind::Automatic, Start::Cold, false),
        (LookupKind::None, Start::Automatic, false),
        (LookupKind::Spherical, Start::Table, true),
    ] {
        let [first, second] = [shape(kind), shape(kind)];
        let (before, body) = bytes(&first);
        assert_eq!(before, 0);
        let config = PairConfig { start, ..PairConfig::default() };
        let (mut cache, mut answer) = (PairCache::default(), PairAnswer::default());
        pair::distance([first.at(&Pose::IDENTITY), second.at(&away)], &mut cache, &config, &mut answer).unwrap();
        for shape in [&first, &second] {
            let (made, all) = bytes(shape);
            assert_eq!((made > 0, all), (looks, body + made), "{kind:?} {start:?}");
        }
    }
}

#[test]
fn a_prepared_shape_has_its_table() {
    let shape = shape(&ellipsoid([1.0, 0.7, 0.4], 300).unwrap(), LookupKind::Automatic, 0);
    shape.prepare(&mut Progress::new(&mut |_| true)).unwrap();
    let bytes = shape.bytes();
    assert_eq!(shape.polyhedron().lookup.made.get(), Some(&build_table(shape.polyhedron()).unwrap()));
    shape.prepare(&mut Progress::new(&mut |_| true)).unwrap();
    assert_eq!(shape.bytes(), bytes);
}

#[test]
fn threads_that_look_at_once_see_one_table() {
    let body = shape(&ellipsoid([1.0, 0.8, 0.5], 2_000).unwrap(), LookupKind::Automatic, 0);
    let tables: Vec<usize> = thread::scope(|scope| {
        let look = || ptr::from_ref(table(body.polyhedron())).addr();
        let all: Vec<_> = (0..8).map(|_| scope.spawn(look)).collect();
        all.into_iter().map(|thread| thread.join().unwrap()).collect()
    });
    assert!(tables.iter().all(|t| *t == tables[0]));
    assert_eq!(*table(body.polyhedron()), build_table(body.polyhedron()).unwrap());
}

#[test]
fn bodies_without_interior_have_tables_too() {
    let square = [[0.0, 0.0, 1.0], [1.0, 0.0, 1.0], [1.0, 1.0, 1.0], [0.0, 1.0, 1.0]].map(Vector::from);
    for count in [1, 2, 4] {
        for kind in [LookupKind::Shells, LookupKind::Spherical] {
            let shape = Shape::from_points(&square[..count], &options(kind, 0)).unwrap();
            // A point has no radius.
            assert_eq!(shape.polyhedron().lookup.plan == Plan::None, count == 1);
            let pose = Pose::IDENTITY;
            let mut away = pose;
            away.rows[2][3] = 3.0;
            let (mut cache, mut answer) = (PairCache::default(), PairAnswer::default());
            pair::distance([shape.at(&pose), shape.at(&away)], &mut cache, &PairConfig::default(), &mut answer)
                .unwrap();
            assert_eq!(answer.outcome, Outcome::Separated);
            assert!(answer.lower <= 3.0 && answer.upper >= 3.0, "{answer:?}");
        }
    }
}

#[test]
fn tables_hold_numbers_only() {
    // Of a body across the whole range: found by fuzzing, positions were NaN.
    let wide = [
        [31.0, -f64::MAX, f64::MAX],
        [31.0, f64::MAX, -32.0],
        [31.0, -32.0, -32.0],
        [31.0, -5.4861240687642383e303, -1.0565890622713304e270],
    ];
    let wide = Shape::from_points(&wide.map(Vector::from), &options(LookupKind::Shells, 4)).unwrap();
    assert_eq!(*table(wide.polyhedron()), Table::None);
    for (size, has_table) in [(1e-300, false), (1e-59, true), (1e59, true), (1e150, false), (1e300, false)] {
        let mut mesh = ellipsoid([1.0, 0.7, 0.4], 100).unwrap();
        mesh.vertices.iter_mut().for_each(|v| *v *= size);
        for kind in [LookupKind::Shells, LookupKind::Spherical] {
            match table(shape(&mesh, kind, 0).polyhedron()) {
                Table::None => assert!(!has_table, "{size:e}"),
                Table::Shells(shells) => {
                    assert!(has_table && shells.positions.iter().flatten().all(|x| x.abs() < 1.000_001), "{size:e}");
                }
                Table::Spherical(_) => assert!(has_table, "{size:e}"),
                Table::AllVertices(_) => panic!("of 100 vertices not all are looked at"),
            }
        }
    }
}

#[test]
fn options_out_of_range_are_refused() {
    let mesh = cuboid([1.0; 3]).unwrap();
    for (kind, resolution) in [
        (LookupKind::Automatic, 2),
        (LookupKind::Shells, 2),
        (LookupKind::Shells, 24),
        (LookupKind::Shells, 1024),
        (LookupKind::Spherical, 1),
        (LookupKind::Spherical, 513),
    ] {
        let refused = Shape::from_mesh(&mesh, &options(kind, resolution)).unwrap_err();
        assert!(matches!(&refused, Error::Argument(m) if m.contains("resolution")), "{refused}");
    }
    for factor in [0.99, f64::NAN, f64::INFINITY] {
        let mut options = options(LookupKind::Spherical, 8);
        options.lookup.radius_factor = factor;
        let refused = Shape::from_mesh(&mesh, &options).unwrap_err();
        assert!(matches!(&refused, Error::Argument(m) if m.contains("radius factor")), "{refused}");
    }
}

/// Every pair of kinds of tables, every start, the cache of whatever query was before: one verdict, intervals with a common point,
/// and answers that pass their check.
#[test]
fn answers_do_not_depend_on_tables_or_starts() {
    let kinds = [LookupKind::Automatic, LookupKind::None, LookupKind::Spherical];
    let starts = [Start::Automatic, Start::Cache, Start::Table, Start::Cold];
    let mut intersecting = 0;
    for (name, mesh) in bodies() {
        let shapes = kinds.map(|kind| shape(&mesh, kind, 0));
        for orbit in ORBITS {
            let mut caches = [PairCache::default(); 36];
            for (index, numbers) in poses(orbit, Step::Random, 60).iter().enumerate() {
                let pose = |k: usize| Pose::from_row_major(numbers[12 * k..12 * k + 12].try_into().unwrap());
                let poses = [pose(0), pose(1)];
                let mut first: Option<PairAnswer> = None;
                for (k, cache) in caches.iter_mut().enumerate() {
                    let shapes = [&shapes[k % 3], &shapes[k / 3 % 3]];
                    let config = PairConfig { start: starts[k / 9], ..PairConfig::default() };
                    let mut answer = PairAnswer::default();
                    pair::distance([shapes[0].at(&poses[0]), shapes[1].at(&poses[1])], cache, &config, &mut answer)
                        .unwrap();
                    verify([shapes[0].at(&poses[0]), shapes[1].at(&poses[1])], &answer).unwrap();
                    let first = first.get_or_insert(answer);
                    let agrees =
                        first.outcome == answer.outcome && first.lower <= answer.upper && answer.lower <= first.upper;
                    assert!(agrees, "{name}, {} orbit, pose {index}: {first:?}\nbut {answer:?}", orbit.name);
                    intersecting += usize::from(answer.outcome == Outcome::Intersecting);
                }
            }
        }
    }
    assert!(intersecting > 1_000, "{intersecting}");
}

/// To ask for all levels of shapes that have none is to ask for none, and a cold start is one: no tables are looked into.
#[test]
fn a_cold_start_is_one_through_all_levels_too() {
    let shape = shape(&ellipsoid([1.0, 0.1, 0.1], 300).unwrap(), LookupKind::Automatic, 0);
    for numbers in &poses(ORBITS[0], Step::Random, 100) {
        let placed = [0, 1].map(|k| Pose::from_row_major(numbers[12 * k..12 * k + 12].try_into().unwrap()));
        let [none, all] = [Levels::None, Levels::All].map(|levels| {
            let config = PairConfig { start: Start::Cold, levels, ..PairConfig::default() };
            let (mut cache, mut answer) = (PairCache::default(), PairAnswer::default());
            pair::distance([shape.at(&placed[0]), shape.at(&placed[1])], &mut cache, &config, &mut answer).unwrap();
            answer.statistics.marching_steps
        });
        assert_eq!(none, all);
    }
    assert!(shape.polyhedron().lookup.made.get().is_none());
}

/// The mean number of steps of marching on the small orbit, from pose to pose; every answer is checked.
fn mean_steps([shape1, shape2]: [&Shape; 2], start: Start, step: Step) -> f64 {
    let (mut cache, mut answer, mut steps) = (PairCache::default(), PairAnswer::default(), 0);
    let config = PairConfig { start, ..PairConfig::default() };
    let poses = poses(ORBITS[0], step, 500);
    for numbers in &poses {
        let [pose1, pose2] = [0, 1].map(|k| Pose::from_row_major(numbers[12 * k..12 * k + 12].try_into().unwrap()));
        pair::distance([shape1.at(&pose1), shape2.at(&pose2)], &mut cache, &config, &mut answer).unwrap();
        verify([shape1.at(&pose1), shape2.at(&pose2)], &answer).unwrap();
        steps += answer.statistics.marching_steps;
    }
    f64::from(steps) / poses.len() as f64
}

/// What the tables are for: hardly more steps anywhere than for a body of a tenth of the vertices.
#[test]
fn steps_from_a_table_hardly_grow_with_the_number_of_vertices() {
    for half_axes in [[1.0, 1.0, 1.0], [1.0, 1.0, 0.1], [1.0, 0.1, 0.1]] {
        let shape = Shape::from_mesh(&ellipsoid(half_axes, 1_000).unwrap(), &ShapeOptions::default()).unwrap();
        let [automatic, table, cache] = [Start::Automatic, Start::Table, Start::Cache]
            .map(|start| mean_steps([&shape, &shape], start, Step::Random));
        println!("{half_axes:?}: {automatic} steps, {table} from the table, {cache} from the cache");
        assert!(automatic < 5.5 && table < 5.5 && cache > 15.0);
    }
}

/// Body 2 goes around body 1 by one angle and turns by another, about an axis that shows it, both bodies anywhere.
#[test]
fn how_far_a_pair_has_moved_is_told() {
    let body = shape(&ellipsoid([1.0; 3], 300).unwrap(), LookupKind::Automatic, 0);
    let polyhedra = [body.polyhedron(); 2];
    let mut random = Random::new(3);
    for separation in [1.0, 3.0, 30.0] {
        for (around, turned) in [(0.0, 0.0), (0.1, 0.0), (0.0, 0.1), (0.1, 0.1), (0.1, -0.1), (0.02, 0.3)] {
            let (world, origin) = (random.rotation(), random.direction() * 5.0);
            let placed = |around: f64, turned: f64| {
                let there = rotation(&Vector::z(), around) * Vector::x() * separation;
                let pose = Pose::new(&(world * rotation(&Vector::z(), turned)), &(origin + world * there));
                [Pose::new(&world, &origin), pose]
            };
            let [before, after] = [placed(0.0, 0.0), placed(around, turned)];
            let mut marker = Marker::default();
            frame(polyhedra, &before).mark(&mut marker);
            // Going around is measured by the size of both bodies at least.
            let around = around * f64::min(1.0, separation / (2.0 * body.polyhedron().radius));
            let angle = f64::hypot(around, turned);
            let moved = |square| frame(polyhedra, &after).has_moved(&marker, square);
            assert!(moved(0.98 * angle * angle - 1e-9), "{separation} {around} {turned}");
            assert!(!moved(angle * angle + 1e-9), "{separation} {around} {turned}");
            // A cold cache knows of no place.
            assert!(frame(polyhedra, &after).has_moved(&Marker::default(), 0.25));
        }
    }
}

fn frame<'a>(polyhedra: [&'a Polyhedron; 2], poses: &'a [Pose; 2]) -> Frame<'a, Portable> {
    Frame::new(&Pair { polyhedra, poses: poses.each_ref() })
}

/// The farther a pair has moved the less its last features say: first they are where the search starts, then their vertices with
/// ever more rounds of look-ups, in the end the centres of mass.
#[test]
fn the_farther_a_pair_has_moved_the_less_its_last_features_say() {
    let body = shape(&ellipsoid([1.0, 0.1, 0.1], 1_002).unwrap(), LookupKind::Automatic, 0);
    let polyhedra = [body.polyhedron(); 2];
    let mut random = Random::new(8);
    let there = Pose::new(&random.rotation(), &(random.direction() * 3.0));
    let mut last = Marker::default();
    frame(polyhedra, &[Pose::IDENTITY, there]).mark(&mut last);
    for axis in [Vector::y(), Vector::z()] {
        let rank = |degrees: u32| {
            let turn = rotation(&axis, f64::from(degrees).to_radians());
            let turned = Pose::new(&(there.rotation() * turn), &there.translation());
            match policy::choose(&frame(polyhedra, &[Pose::IDENTITY, turned]), &last, State::vertex_vertex([0, 0])) {
                None => 0,
                Some(StartFrom::LastVertices { rounds, .. }) => rounds,
                Some(StartFrom::Centres) => u32::MAX,
                Some(StartFrom::Farthest) => panic!("tables are there"),
            }
        };
        let ranks: Vec<u32> = (0..90).map(rank).collect();
        assert!(ranks.is_sorted() && ranks[0] == 0 && ranks[89] == u32::MAX, "{ranks:?}");
        assert!(ranks.iter().any(|rank| (1..u32::MAX).contains(rank)), "{ranks:?}");
    }
}

/// One round from the last vertices is one look-up of each in the other's table; round bodies are not asked for it.
#[test]
fn after_a_short_jump_look_ups_begin_at_the_last_vertices() {
    let poses = poses(ORBITS[0], Step::Random, 300);
    let body = |half_axes, n| shape(&ellipsoid(half_axes, n).unwrap(), LookupKind::Automatic, 0);
    let [long, plate] = [body([1.0, 0.1, 0.1], 1_002), body([1.0, 1.0, 0.1], 700)];
    let [round, smaller] = [body([1.0; 3], 1_002), body([0.7; 3], 700)];
    for (shapes, is_thin) in [([&long, &plate], true), ([&round, &long], true), ([&round, &smaller], false)] {
        let polyhedra = shapes.map(Shape::polyhedron);
        let (tables, mut random) = (polyhedra.map(shells), Random::new(6));
        let (mut alike, mut moved) = (0, 0);
        for numbers in &poses {
            let placed = [0, 1].map(|k| Pose::from_row_major(numbers[12 * k..12 * k + 12].try_into().unwrap()));
            let last = polyhedra.map(|polyhedron| random.below(polyhedron.vertices.len()) as u32);
            let from = |from| start_pair(&Pair { polyhedra, poses: [&placed[0], &placed[1]] }, from);
            let after = |rounds| from(StartFrom::LastVertices { vertices: last, rounds });
            let anew = from(StartFrom::Centres);
            assert_eq!(after(tables[0].rounds.max(tables[1].rounds)), anew);
            let after = after(1);
            assert!(is_thin || after == anew);
            moved += usize::from(after.vertices() != anew.vertices());
            // Where the bodies seem to overlap it looks once more.
            let seen = |to: usize| {
                let from = 1 - to;
                let mass = &polyhedra[to].mass;
                let world = placed[from].transform(&polyhedra[from].local_position(last[from]));
                let way = world - placed[to].transform(&mass.centre_of_mass);
                let point = placed[to].rotate_back(&way) / mass.radius;
                tables[to].nearest([point.x as f32, point.y as f32, point.z as f32])
            };
            alike += usize::from(after.guess == Guess::Overlapping || after.vertices() == [seen(0), seen(1)]);
        }
        // Rounding may lead to the next cell.
        assert!(!is_thin || (alike > 290 && moved > 200), "{alike} {moved}");
    }
}

/// In steps of 10° thin bodies are looked up, which saves steps; needles once were not.
#[test]
fn thin_bodies_are_looked_up_after_ten_degrees() {
    for (half_axes, most) in [([1.0, 1.0, 0.1], 0.85), ([1.0, 0.1, 0.1], 0.65), ([1.0, 0.01, 0.01], 0.65)] {
        let shape = Shape::from_mesh(&ellipsoid(half_axes, 1_002).unwrap(), &ShapeOptions::default()).unwrap();
        let [automatic, cache] =
            [Start::Automatic, Start::Cache].map(|start| mean_steps([&shape, &shape], start, Step::Degrees(10.0)));
        println!("{half_axes:?}: {automatic} steps, {cache} from the cache");
        assert!(automatic < most * cache);
    }
}

/// Plates that roll about body 2's own first axis, by 60° a query, do not begin at vertices that are elsewhere by now: without that
/// it would be five steps more than from the tables.
#[test]
fn rolling_plates_do_not_begin_at_their_last_vertices() {
    for half_axes in [[1.0, 1.0, 0.1], [0.1, 1.0, 1.0]] {
        let shape = Shape::from_mesh(&ellipsoid(half_axes, 1_002).unwrap(), &ShapeOptions::default()).unwrap();
        let [automatic, table] = [Start::Automatic, Start::Table].map(|start| {
            let (mut cache, mut answer, mut steps) = (PairCache::default(), PairAnswer::default(), 0);
            let config = PairConfig { start, ..PairConfig::default() };
            for (i, numbers) in poses(ORBITS[0], Step::Degrees(7.0), 500).iter().enumerate() {
                let placed = [0, 1].map(|k| Pose::from_row_major(numbers[12 * k..12 * k + 12].try_into().unwrap()));
                let roll = rotation(&Vector::x(), i as f64 * PI / 3.0);
                let rolled = Pose::new(&(placed[1].rotation() * roll), &placed[1].translation());
                pair::distance([shape.at(&placed[0]), shape.at(&rolled)], &mut cache, &config, &mut answer).unwrap();
                steps += answer.statistics.marching_steps;
            }
            f64::from(steps) / 500.0
        });
        println!("{half_axes:?}: {automatic} steps, {table} from the table");
        assert!(automatic < table + 3.5);
    }
}

/// A turned cube with a grid of points on each face: by rounding many of them are vertices, but no corners.
fn turned_grid(n: usize, kind: LookupKind) -> Shape {
    let turn = Random::new(9).rotation();
    let points: Vec<Vector> = grid_on_cube(n).iter().map(|p| turn * p).collect();
    Shape::from_points(&points, &options(kind, 0)).unwrap()
}

/// Of two like bodies at random poses, begun with an empty cache each or going on from pose to pose: how many are disjoint, how
/// many of these marching did not decide, and on how many of those it had set out.
fn undecided_at_random(shape: &Shape, start: Start, goes_on: bool) -> [usize; 3] {
    let mut random = Random::new(7);
    let config = PairConfig { start, ..PairConfig::default() };
    let (mut cache, mut answer, mut counts) = (PairCache::default(), PairAnswer::default(), [0; 3]);
    for _ in 0..2_000 {
        let [pose1, pose2] = [0, 1].map(|_| Pose::new(&random.rotation(), &(random.vector() * 3.0)));
        if !goes_on {
            cache = PairCache::default();
        }
        pair::distance([shape.at(&pose1), shape.at(&pose2)], &mut cache, &config, &mut answer).unwrap();
        verify([shape.at(&pose1), shape.at(&pose2)], &answer).unwrap();
        if answer.outcome == Outcome::Separated {
            counts[0] += 1;
            let is_undecided = answer.decided_by != DecidedBy::Marching;
            counts[1] += usize::from(is_undecided);
            counts[2] += usize::from(is_undecided && answer.statistics.marching_steps > 0);
        }
    }
    counts
}

/// Marching from a vertex inside a face, past which its neighbours are, went round in circles: one pair in seven.
#[test]
fn marching_leaves_flat_vertices() {
    let shape = turned_grid(20, LookupKind::Shells);
    let polyhedron = shape.polyhedron();
    let table = shells(polyhedron);
    let is_flat = |v: u32| polyhedron.face_around(v).is_some();
    assert!((0..table.cells.len()).filter(|cell| is_flat(table.cells.get(*cell))).count() > table.cells.len() / 4);
    let [disjoint, undecided, marched] = undecided_at_random(&shape, Start::Table, false);
    // The others look as if they overlapped.
    assert!(disjoint > 1_000 && 100 * undecided < disjoint && marched == 0, "{undecided}, {marched} of {disjoint}");
}

/// Boxes that intersected and have jumped apart: one in four was left to the fallback, as they have no tables to begin from.
#[test]
fn boxes_that_jump_apart_march() {
    let shape = shape(&cuboid([1.0; 3]).unwrap(), LookupKind::Automatic, 0);
    let [disjoint, undecided, _] = undecided_at_random(&shape, Start::Automatic, true);
    assert!(disjoint > 1_000 && 15 * undecided < disjoint, "{undecided} of {disjoint}");
}

#[test]
fn of_few_vertices_all_are_looked_at() {
    let mut mesh = random_hull(25, 3).unwrap();
    for v in &mut mesh.vertices {
        *v = *v * 3.0 + Vector::new(7.0, -3.0, 0.5);
    }
    let shape = shape(&mesh, LookupKind::Automatic, 0);
    let polyhedron = shape.polyhedron();
    assert!(matches!(polyhedron.lookup.plan, Plan::AllVertices { rounds: 1 }));
    let all = AllVertices { polyhedron, rounds: 1 };
    let mut random = Random::new(4);
    for _ in 0..1_000 {
        let direction = random.direction();
        let factor = random.uniform(0.1, 5.0) as f32;
        let towards = [direction.x as f32, direction.y as f32, direction.z as f32];
        let direction = Vector::from(towards.map(f64::from));
        let point = sample(polyhedron, 1.0, &(direction * f64::from(factor)));
        let nearest = distance_of(polyhedron, all.nearest(towards.map(|x| x * factor)), &point);
        assert!(nearest <= least_distance(polyhedron, &point) + 1e-5);
        let height = |v: u32| polyhedron.vertices[v as usize].position.dot(&direction);
        let highest = (0..polyhedron.vertices.len() as u32).map(height).fold(f64::NEG_INFINITY, f64::max);
        assert_eq!(height(all.farthest(towards)), highest);
    }
    for v in 0..polyhedron.vertices.len() as u32 {
        let [x, y, z, _] = all.position(v).map(f64::from);
        assert!(
            (sample(polyhedron, 1.0, &Vector::new(x, y, z)) - polyhedron.vertices[v as usize].position).norm() < 1e-5
        );
        assert!(
            distance_of(
                polyhedron,
                all.nearest([x as f32, y as f32, z as f32]),
                &polyhedron.vertices[v as usize].position
            ) == 0.0
        );
    }
}

/// A box needs no table, but what stands beside it may have one.
#[test]
fn a_box_beside_a_large_body_is_found_from_its_table() {
    let small = shape(&cuboid([0.577; 3]).unwrap(), LookupKind::Automatic, 0);
    // With so many flat vertices that it has a table; it is larger, and some pairs intersect.
    let grid = turned_grid(20, LookupKind::Automatic);
    for half_axes in [[1.0, 1.0, 1.0], [1.0, 1.0, 0.1], [1.0, 0.1, 0.1]] {
        let large = shape(&ellipsoid(half_axes, 1_000).unwrap(), LookupKind::Automatic, 0);
        for shapes in [[&small, &large], [&large, &small]] {
            let [automatic, table, cache] =
                [Start::Automatic, Start::Table, Start::Cache].map(|start| mean_steps(shapes, start, Step::Random));
            println!("{half_axes:?}: {automatic} steps, {table} from the table, {cache} from the cache");
            assert!(automatic < 6.5 && table < 5.5 && cache > 15.0);
        }
        let [automatic, cache] =
            [Start::Automatic, Start::Cache].map(|start| mean_steps([&grid, &large], start, Step::Random));
        println!("{half_axes:?}: beside squares on a cube {automatic} steps, {cache} from the cache");
        assert!(automatic < 7.5 && cache > 1.5 * automatic);
    }
    assert!(matches!(small.polyhedron().lookup.plan, Plan::AllVertices { .. }));
}
