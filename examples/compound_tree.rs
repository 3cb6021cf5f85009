//! Draws docs/pictures/compound-tree.svg: a gear of convex pieces, seen from above, boxes of its tree, and the front of two gears.
//!
//! `cargo run --release --example compound_tree > docs/pictures/compound-tree.svg`

use std::sync::Arc;

use swiftprox::compound::{Compound, CompoundAnswer, CompoundCache, Piece, intersection};
use swiftprox::math::{Matrix, Pose, Vector};
use swiftprox::pair::{Outcome, PairConfig};
use swiftprox::shape::{Shape, ShapeOptions};

const TEETH: usize = 20;
/// The width of a panel, and pixels for a length of 1.
const PANEL: f64 = 250.0;
const SCALE: f64 = 84.0;
const LEVELS: [usize; 3] = [1, 3, 5];
/// Hues that the colour-blind can tell apart, as in benches/charts.py.
const COLOURS: [&str; 4] = ["#0072b2", "#d55e00", "#009e73", "#cc79a7"];

fn main() {
    let pieces = pieces();
    let piece = |points: &Vec<Vector>| {
        let shape = Shape::from_points(points, &ShapeOptions::default()).expect("a convex piece");
        Piece { shape: Arc::new(shape), pose: Pose::IDENTITY }
    };
    let gear = Compound::new(&pieces.iter().map(piece).collect::<Vec<_>>()).expect("pieces");
    let (width, height) = (PANEL * (LEVELS.len() + 1) as f64, PANEL + 30.0);
    println!(
        r##"<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {width} {height}" font-family="sans-serif" font-size="12">
<rect width="{width}" height="{height}" fill="white"/>"##
    );
    for (k, level) in LEVELS.into_iter().enumerate() {
        let middle = [PANEL * (k as f64 + 0.5), 30.0 + 0.5 * PANEL];
        for points in &pieces {
            // Of each corner the lower one: inner and outer radius at one end, outer and inner at the other.
            let corners = [0, 2, 6, 4].map(|corner| points[corner]);
            polygon(corners, middle, r##"fill="#dddddd" stroke="#888888" stroke-width="0.6""##);
        }
        let boxes = gear.tree_boxes(level).expect("memory");
        for ([centre, half1, half2, half3], colour) in boxes.iter().zip(COLOURS.iter().cycle()) {
            // The edge along the line of sight is not seen.
            let mut halves = [*half1, *half2, *half3];
            halves.sort_by(|a, b| (a.z.abs() / a.norm()).total_cmp(&(b.z.abs() / b.norm())));
            let [one, other, _] = halves;
            let corners = [-one - other, one - other, one + other, other - one].map(|corner| centre + corner);
            let look = format!(r#"fill="{colour}" fill-opacity="0.12" stroke="{colour}" stroke-width="1.2""#);
            polygon(corners, middle, &look);
        }
        let x = middle[0];
        println!(r#"<text x="{x}" y="20" text-anchor="middle">level {level}: {} boxes</text>"#, boxes.len());
    }
    draw_front(&gear, [PANEL * LEVELS.len() as f64 + 5.0, 35.0]);
    println!("</svg>");
}

/// The front of two gears whose teeth nearly touch: what a walk did with the pairs of their pieces. Those of one gear are from left
/// to right, those of the other from top to bottom, in the order of the tree.
fn draw_front(gear: &Compound, [left, top]: [f64; 2]) {
    let half_tooth = std::f64::consts::PI / TEETH as f64;
    let (sin, cos) = half_tooth.sin_cos();
    let turned = Matrix::new(cos, -sin, 0.0, sin, cos, 0.0, 0.0, 0.0, 1.0);
    let poses = [Pose::IDENTITY, Pose::new(&turned, &Vector::new(2.8, 0.0, 0.0))];
    let (mut cache, mut answer) = (CompoundCache::default(), CompoundAnswer::default());
    // The second query finds the place of the first.
    for _ in 0..2 {
        let placed = [gear.at(&poses[0]), gear.at(&poses[1])];
        intersection(placed, &mut cache, &PairConfig::default(), &mut answer).expect("poses");
    }
    assert!(answer.answer.outcome == Outcome::Separated);
    let tiles = cache.front_tiles([gear, gear]).expect("memory");
    let side = (PANEL - 10.0) / gear.piece_count() as f64;
    for leaves in &tiles {
        let [[x0, x1], [y0, y1]] = leaves.map(|ends| ends.map(|end| f64::from(end) * side));
        let (x, y, width, height) = (left + x0, top + y0, x1 - x0, y1 - y0);
        println!(
            r##"<rect x="{x:.1}" y="{y:.1}" width="{width:.1}" height="{height:.1}" fill="#dce9f3" stroke="{}" stroke-width="0.8"/>"##,
            COLOURS[0]
        );
    }
    let x = left - 5.0 + 0.5 * PANEL;
    println!(r#"<text x="{x}" y="20" text-anchor="middle">front: {} pairs of nodes</text>"#, tiles.len());
}

fn polygon(corners: [Vector; 4], [x, y]: [f64; 2], look: &str) {
    let points = corners.map(|corner| format!("{:.1},{:.1}", x + SCALE * corner.x, y - SCALE * corner.y)).join(" ");
    println!(r#"<polygon points="{points}" {look}/>"#);
}

/// Sectors of a hub, a tooth on each.
fn pieces() -> Vec<Vec<Vector>> {
    let sector = |[from, to]: [f64; 2], radii: [f64; 2]| -> Vec<Vector> {
        let turn = std::f64::consts::TAU / TEETH as f64;
        let corner = |angle: f64, radius: f64, z: f64| Vector::new(radius * angle.cos(), radius * angle.sin(), z);
        let at = |step: f64| radii.map(|radius| [-0.15, 0.15].map(|z| corner(step * turn, radius, z)));
        [at(from), at(to)].as_flattened().as_flattened().to_vec()
    };
    let of_tooth = |k: f64| [sector([k, k + 1.0], [0.5, 1.15]), sector([k + 0.25, k + 0.75], [1.1, 1.4])];
    (0..TEETH).flat_map(|k| of_tooth(k as f64)).collect()
}
