//! Scenes with grounds and compounds, drawn: all edges where they are.

use std::collections::{HashMap, HashSet};
use std::sync::Arc;

use swiftprox::compound::{Compound, Piece};
use swiftprox::draw::{Draw, DrawKind};
use swiftprox::ground::{Ground, HeightGrid};
use swiftprox::math::{Pose, Vector};
use swiftprox::object::ObjectOptions;
use swiftprox::scene::Scene;
use swiftprox::shape::Shape;
use testkit::random::Random;
use testkit::shapes::hull;

/// Ends of a line by their bits, the lesser first.
type Line = [[u64; 3]; 2];

/// How often each edge was drawn.
#[derive(Default)]
struct Sheet {
    edges: HashMap<Line, usize>,
    boxes: usize,
}

fn line(mut ends: [[f64; 3]; 2]) -> Line {
    ends.sort_by(|a, b| a.partial_cmp(b).unwrap());
    ends.map(|end| end.map(|x| (x + 0.0).to_bits()))
}

impl Draw for Sheet {
    fn line(&mut self, kind: DrawKind, start: [f64; 3], end: [f64; 3]) {
        match kind {
            DrawKind::Edge => *self.edges.entry(line([start, end])).or_default() += 1,
            DrawKind::Box => self.boxes += 1,
            _ => panic!("nothing was asked: {kind:?}"),
        }
    }

    fn point(&mut self, kind: DrawKind, _: [f64; 3]) {
        panic!("no points: {kind:?}");
    }

    fn text(&mut self, kind: DrawKind, _: [f64; 3], _: &str) {
        panic!("no texts: {kind:?}");
    }
}

/// The sides of triangles that have three corners, placed.
fn sides(vertices: &[Vector], triangles: &[[u32; 3]], pose: &Pose) -> HashMap<Line, usize> {
    let mut found = HashMap::new();
    for [a, b, c] in triangles.iter().filter(|[a, b, c]| a != b && b != c && c != a) {
        for ends in [[a, b], [b, c], [c, a]] {
            let ends = ends.map(|v| pose.transform(&vertices[*v as usize]).into());
            found.insert(line(ends), 1);
        }
    }
    found
}

/// Vertices and triangles of a grid, by its definition: none of a cell with a hole at a corner.
fn triangles_of(grid: &HeightGrid) -> (Vec<Vector>, Vec<[u32; 3]>) {
    let at = |v: usize| {
        let [x, y] = [v % grid.columns, v / grid.columns].map(|k| k as f64);
        Vector::new(x * grid.spacing[0], y * grid.spacing[1], grid.heights[v])
    };
    let mut triangles = Vec::new();
    for (i, j) in (0..grid.rows - 1).flat_map(|i| (0..grid.columns - 1).map(move |j| (i, j))) {
        let least = i * grid.columns + j;
        let [a, b, c, d] = [least, least + 1, least + grid.columns + 1, least + grid.columns];
        if [a, b, c, d].iter().all(|v| !grid.heights[*v].is_nan()) {
            triangles.extend([[a, b, c], [a, c, d]].map(|corners| corners.map(|v| v as u32)));
        }
    }
    ((0..grid.heights.len()).map(at).collect(), triangles)
}

fn draw(ground: Ground, pose: Pose) -> Sheet {
    let mut scene = Scene::new();
    let options = ObjectOptions { pose, ..Default::default() };
    scene.add_ground(Arc::new(ground), &options).unwrap();
    let mut sheet = Sheet::default();
    scene.draw(&mut sheet);
    sheet
}

fn anywhere(random: &mut Random) -> Pose {
    Pose::new(&random.rotation(), &(random.vector() * 9.0))
}

/// Each edge once, of grids with holes and of the same triangles as a soup.
#[test]
fn each_edge_of_a_ground_is_drawn_once_where_it_is() {
    let mut random = Random::new(0xd4a1);
    for round in 0..60 {
        let (rows, columns) = (2 + round % 5, 2 + round % 7);
        let has_holes = round % 3 == 0;
        let height = |random: &mut Random| {
            if has_holes && random.uniform(0.0, 1.0) < 0.15 { f64::NAN } else { random.uniform(-1.0, 1.0) }
        };
        let heights: Vec<f64> = (0..rows * columns).map(|_| height(&mut random)).collect();
        let grid = HeightGrid { rows, columns, spacing: [0.7, 1.3], heights: &heights };
        let (vertices, triangles) = triangles_of(&grid);
        if triangles.is_empty() {
            assert!(Ground::from_heights(&grid).is_err());
            continue;
        }
        let pose = anywhere(&mut random);
        let wanted = sides(&vertices, &triangles, &pose);
        let sheet = draw(Ground::from_heights(&grid).unwrap(), pose);
        assert_eq!((sheet.edges == wanted, sheet.boxes), (true, 12));
        let flat: Vec<Vector> = vertices.iter().map(|v| v.map(|x| if x.is_nan() { 0.0 } else { x })).collect();
        // One without area, and a copy of the first: neither is drawn.
        let more = [[0, 0, 1], triangles[0]];
        let all: Vec<[u32; 3]> = triangles.iter().chain(&more).copied().collect();
        let sheet = draw(Ground::from_triangles(&flat, &all).unwrap(), pose);
        assert!(sheet.edges == wanted);
    }
}

/// Triangles that make no surface: all their sides, and nothing else.
#[test]
fn all_sides_of_a_soup_are_drawn() {
    let mut random = Random::new(0xd4a2);
    for _ in 0..60 {
        let vertices: Vec<Vector> = (0..12).map(|_| random.vector()).collect();
        let triangles: Vec<[u32; 3]> = (0..20).map(|_| std::array::from_fn(|_| random.below(12) as u32)).collect();
        let pose = anywhere(&mut random);
        let wanted = sides(&vertices, &triangles, &pose);
        let sheet = draw(Ground::from_triangles(&vertices, &triangles).unwrap(), pose);
        let keys = |edges: HashMap<Line, usize>| edges.into_keys().collect::<HashSet<Line>>();
        assert!(keys(sheet.edges) == keys(wanted));
    }
}

/// A compound is drawn as the same pieces are that make an object, each edge once.
#[test]
fn a_compound_is_drawn_by_its_pieces() {
    let mut random = Random::new(0xd4a3);
    for round in 0..30 {
        let cloud = |random: &mut Random| (0..9).map(|_| random.vector()).collect::<Vec<_>>();
        let shapes: Vec<Arc<Shape>> = (0..3).map(|_| Arc::new(hull(&cloud(&mut random)))).collect();
        let pieces: Vec<Piece> = (0..1 + round % 6)
            .map(|k| {
                let pose = if k == 0 { Pose::IDENTITY } else { anywhere(&mut random) };
                Piece { shape: shapes[random.below(3)].clone(), pose }
            })
            .collect();
        let options = ObjectOptions { pose: anywhere(&mut random), ..Default::default() };
        let [mut whole, mut parts] = [Scene::new(), Scene::new()];
        whole.add_compound(Arc::new(Compound::new(&pieces).unwrap()), &options).unwrap();
        let id = parts.add_object(pieces.iter().map(|piece| piece.shape.clone()).collect(), &options).unwrap();
        for (k, piece) in (0..).zip(&pieces).skip(1) {
            parts.set_piece_pose(id, k, &piece.pose).unwrap();
        }
        let sheets = [whole, parts].map(|scene| {
            let mut sheet = Sheet::default();
            scene.draw(&mut sheet);
            sheet
        });
        assert!(sheets[0].edges == sheets[1].edges && sheets[0].edges.len() > pieces.len());
        assert!(sheets[0].edges.values().all(|count| *count == 1));
        assert_eq!(sheets.map(|sheet| sheet.boxes), [12, 12]);
    }
}
