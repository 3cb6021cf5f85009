//! A triangle laid out in the place of another: its polyhedron without asking for memory, in a tenth of the time of building it.

use crate::base::math::{UNIT_ROUNDOFF, Vector};
use crate::body::build::assembly::centre_of;
use crate::body::build::assembly::layout::{edge_between, plane_normal, set_plane, slack_of_leaning};
use crate::body::build::slack::rise_over;
use crate::body::polyhedron::{Bevel, LARGEST, MassProperties, Polyhedron, SMALLEST};

/// Moves the three vertices of a triangle that [`build`](super::build) made, vertex v to `corners[v]`. Besides those, only the
/// data that a manifold reads are moved: the normals and slacks of its two faces. `normals` are theirs, of unit length, right to
/// a few u. Labels stay. The corners are not on a line, no coordinate is beyond [`LARGEST`], and the triangle, centred, is not
/// within [`SMALLEST`].
pub fn move_outline(polyhedron: &mut Polyhedron, corners: &[Vector; 3], normals: &[Vector; 2]) {
    let centre = centre_of(corners);
    // The sum with +0 turns −0 into 0.
    let positions = corners.map(|p| (p - centre).add_scalar(0.0));
    let longest = positions.iter().map(|p| p.norm()).fold(0.0, f64::max);
    // The norm is right to 3u.
    polyhedron.radius = longest * (1.0 + 8.0 * UNIT_ROUNDOFF);
    polyhedron.centre = centre;
    let [front, back] = normals;
    let slack = width(front, &positions, &positions);
    // Turned round it is as wide.
    let slacks = [slack, if *back == -front { slack } else { width(back, &positions, &positions) }];
    for ((face, normal), slack) in polyhedron.faces.iter_mut().zip(normals).zip(slacks) {
        (face.normal, face.slack) = (*normal, slack);
    }
    for (vertex, position) in polyhedron.vertices.iter_mut().zip(positions) {
        vertex.position = position;
    }
}

/// Moves the data that [`move_outline`] leaves where they were, which takes far longer.
pub fn move_inner(polyhedron: &mut Polyhedron) {
    let positions = [0, 1, 2].map(|v: usize| polyhedron.vertices[v].position);
    let normals = [0, 1].map(|f: usize| polyhedron.faces[f].normal);
    let slacks = [0, 1].map(|f: usize| polyhedron.faces[f].slack);
    let centre = polyhedron.centre;
    polyhedron.simple = centre == Vector::zeros() && (SMALLEST..=LARGEST).contains(&polyhedron.radius);
    polyhedron.mass = mass_of(&positions).about(&centre);
    move_edges(polyhedron, &positions, &normals, &slacks);
    move_planes(polyhedron, &positions);
    move_neighbours(polyhedron, &positions);
}

fn mass_of(positions: &[Vector; 3]) -> MassProperties {
    let [a, b, c] = positions;
    let centre_of_mass = (a + b + c) / 3.0;
    let farthest = positions.iter().map(|p| (p - centre_of_mass).norm()).fold(0.0, f64::max);
    let [lower, upper] = [f64::min, f64::max].map(|pick| a.zip_map(b, pick).zip_map(c, pick));
    MassProperties { volume: 0.0, centre_of_mass, radius: farthest * (1.0 + 8.0 * UNIT_ROUNDOFF), lower, upper }
}

/// An upper bound of max over the triangle of n·x minus min over some of its vertices of n·x.
fn width(normal: &Vector, positions: &[Vector; 3], some: &[Vector]) -> f64 {
    some.iter().map(|s| rise_over(normal, positions, s)).fold(0.0, f64::max)
}

fn move_edges(polyhedron: &mut Polyhedron, positions: &[Vector; 3], normals: &[Vector; 2], slacks: &[f64; 2]) {
    for edge in &mut polyhedron.edges {
        let ends = [edge.tail(), edge.head()];
        let mut moved = edge_between(ends, positions, [edge.left(), edge.right()], normals, slacks);
        (moved.labels, moved.bevel) = (edge.labels, edge.bevel);
        // Same as for any sharp edge: minus the sum of the inward side directions.
        let normal = (plane_normal(&moved.planes, 2) + plane_normal(&moved.planes, 3)).normalize();
        let slack = width(&normal, positions, &ends.map(|v| positions[v as usize]));
        moved.slack = moved.slack.max(slack) + slack_of_leaning(&moved, polyhedron.radius);
        if let Some(bevel) = polyhedron.bevels.get_mut(moved.bevel as usize) {
            *bevel = Bevel { normal, slack };
        }
        *edge = moved;
    }
}

fn move_planes(polyhedron: &mut Polyhedron, positions: &[Vector; 3]) {
    let Polyhedron { faces, edges, .. } = polyhedron;
    for (f, face) in (0..).zip(faces) {
        let heights = positions.map(|p| face.normal.dot(&p));
        let [low, high] = [f64::min, f64::max].map(|pick| pick(pick(heights[0], heights[1]), heights[2]));
        set_plane(&mut face.planes, 0, &face.normal, -0.5 * (low + high));
        for (side, edge) in face.first_sides.into_iter().enumerate() {
            let edge = &edges[edge as usize];
            let lane = if edge.left() == f { 2 } else { 3 };
            set_plane(&mut face.planes, 1 + side, &-plane_normal(&edge.planes, lane), -edge.planes.offset[lane]);
        }
    }
}

fn move_neighbours(polyhedron: &mut Polyhedron, positions: &[Vector; 3]) {
    let Polyhedron { vertices, edges, vertex_blocks, rough_blocks, .. } = polyhedron;
    // The last one is repeated.
    for (lane, position) in [0, 1, 2, 2].map(|v: usize| &positions[v]).into_iter().enumerate() {
        vertex_blocks.iter_mut().for_each(|block| {
            [block.x[lane], block.y[lane], block.z[lane]] = (*position).into();
        });
        rough_blocks.iter_mut().filter(|_| lane < 3).for_each(|block| {
            [0, 1, 2].into_iter().for_each(|axis| block[axis][lane] = position[axis] as f32);
        });
    }
    for (v, vertex) in (0..).zip(vertices) {
        let block = &mut vertex.neighbours;
        for lane in 0..block.head.len() {
            let edge = &edges[block.edge[lane] as usize];
            let along = plane_normal(&edge.planes, 0) * if edge.tail() == v { 1.0 } else { -1.0 };
            [block.x[lane], block.y[lane], block.z[lane]] = [along.x, along.y, along.z].map(|d| d as f32);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::body::build::assembly::build;
    use swiftprox::random::Random;

    /// Against building: for any triangle, near the origin and far from it, large and small, thick and thin, all data that
    /// queries run on are the same but for the slack, which bounds the same.
    #[test]
    fn a_triangle_moved_is_one_built() {
        let mut random = Random::new(0x7a1);
        for round in 0..500 {
            let (size, aside) = (random.power(-60, 60), random.power(-30, 30));
            let aside = if round % 3 == 0 { Vector::zeros() } else { random.vector() * size * aside };
            let mut corners: [Vector; 3] = std::array::from_fn(|_| random.vector() * size + aside);
            if round % 4 == 0 {
                let way = random.power(-20, -1);
                corners[2] = (corners[0] + corners[1]) * 0.5 + random.vector() * size * way;
            }
            let Ok(built) = build(&corners, None) else { panic!("{corners:?}") };
            if built.dimension < 2 {
                continue;
            }
            let mut moved = built.copy().unwrap();
            let elsewhere = std::array::from_fn(|_| random.vector());
            move_outline(&mut moved, &elsewhere, &[random.direction(), random.direction()]);
            move_inner(&mut moved);
            let own: [Vector; 3] = std::array::from_fn(|v| built.vertices[v].position + built.centre);
            move_outline(&mut moved, &own, &[built.faces[0].normal, built.faces[1].normal]);
            move_inner(&mut moved);
            let slack = 64.0 * UNIT_ROUNDOFF * built.radius;
            for (one, other) in built.edges.iter().zip(&mut moved.edges) {
                assert!(one.slack <= slack && other.slack <= slack, "{} {}", one.slack, other.slack);
                other.slack = one.slack;
                other.labels = one.labels;
            }
            for (one, other) in built.faces.iter().zip(&mut moved.faces) {
                assert!(one.slack <= slack && other.slack <= slack, "{} {}", one.slack, other.slack);
                other.slack = one.slack;
            }
            for (one, other) in built.bevels.iter().zip(&mut moved.bevels) {
                assert!((one.normal - other.normal).norm() < 1e-15 && other.slack <= slack);
                *other = *one;
            }
            assert!((built.mass.centre_of_mass - moved.mass.centre_of_mass).norm() <= 1e-15 * (size + aside.norm()));
            moved.mass = built.mass;
            assert_eq!(built, moved);
        }
    }
}
