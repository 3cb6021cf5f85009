//! Triangles over vertices, which of them are neighbours, and the tree that finds them: less than 52 bytes a triangle of a surface
//! with half as many vertices.

use super::tree::{GroundTree, NodeBounds};
use crate::base::angles::around;
use crate::base::error::{Error, Result};
use crate::base::math::Vector;
use crate::base::memory::{collected, copied, extend, filled, push, with_capacity};
use crate::base::normal::{area_vector, normal_of, over_length};
use crate::body::polyhedron::SMALLEST;

/// Across no side: the surface ends there, or its triangles there make no surface.
pub(super) const NONE: u32 = u32::MAX;

/// A triangle.
#[derive(Debug, Clone, Copy, PartialEq)]
struct TriangleRecord {
    /// All one of a triangle that is left out.
    corners: [u32; 3],
    /// The twins of the half-edges 3t + k, from corner k to the next, or [`NONE`].
    twins: [u32; 3],
}

/// Triangles in any order.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Soup {
    vertices: Vec<Vector>,
    records: Vec<TriangleRecord>,
    tree: GroundTree,
}

impl Soup {
    /// From vertices within 2²⁰⁰ that have no −0, and triangles over them.
    ///
    /// # Errors
    /// [`Error::Mesh`]: no triangle has an area. [`Error::Memory`].
    pub fn new(vertices: Vec<Vector>, triangles: &[[u32; 3]]) -> Result<Soup> {
        debug_assert!(triangles.as_flattened().iter().all(|v| (*v as usize) < vertices.len()));
        let (mut records, mut normals) = (with_capacity(triangles.len())?, with_capacity(triangles.len())?);
        for &corners in triangles {
            let [a, b, c] = corners.map(|v| vertices[v as usize]);
            let is_left_out = (b - a).amax().max((c - a).amax()) < 2.0 * SMALLEST;
            normals.push(if is_left_out { Vector::zeros() } else { unit_normal(&[a, b, c]) });
            records.push(TriangleRecord { corners, twins: [NONE; 3] });
        }
        find_twins(&vertices, &mut records, &mut normals)?;
        let mut items = Vec::new();
        for ((t, record), normal) in (0..).zip(&mut records).zip(&normals) {
            if *normal == Vector::zeros() {
                record.corners = [record.corners[0]; 3];
            } else {
                push(&mut items, (t, NodeBounds::of(&record.corners.map(|v| vertices[v as usize]))))?;
            }
        }
        if items.is_empty() {
            return Err(Error::Mesh(format!("none of the {} triangles of the ground has an area", records.len())));
        }
        let tree = GroundTree::new(&mut items)?;
        Ok(Soup { vertices, records, tree })
    }

    /// # Errors
    /// [`Error::Memory`].
    pub fn try_clone(&self) -> Result<Soup> {
        Ok(Soup { vertices: copied(&self.vertices)?, records: copied(&self.records)?, tree: self.tree.try_clone()? })
    }

    /// Memory held beside the struct, in bytes.
    pub fn heap_bytes(&self) -> usize {
        size_of_val(&self.vertices[..]) + size_of_val(&self.records[..]) + self.tree.heap_bytes()
    }

    pub fn triangle_count(&self) -> usize {
        self.records.len()
    }

    pub fn vertex_count(&self) -> usize {
        self.vertices.len()
    }

    pub fn vertex(&self, vertex: u32) -> Vector {
        self.vertices[vertex as usize]
    }

    /// The vertices of a triangle, all one of a triangle that is left out.
    pub fn corners(&self, triangle: u32) -> [u32; 3] {
        self.records[triangle as usize].corners
    }

    /// The unit normal of a triangle, 0 of one that is left out.
    pub fn normal(&self, triangle: u32) -> Vector {
        let corners = self.corners(triangle);
        if corners[0] == corners[1] {
            return Vector::zeros();
        }
        unit_normal(&corners.map(|v| self.vertex(v)))
    }

    /// The half-edge on the other side, or [`NONE`].
    pub fn twin(&self, half_edge: u32) -> u32 {
        self.records[half_edge as usize / 3].twins[half_edge as usize % 3]
    }

    pub fn tree(&self) -> &GroundTree {
        &self.tree
    }
}

/// The unit normal of a triangle, out of its front, right to 16u; 0 of corners on a line. `corners` are within 2²⁰⁰ of each other.
///
/// At the corner opposite the longest side the product of two sides is right to 6u of their lengths. Where their angle is at least
/// 30° off a line that is 12u of it, and dividing by its length adds 4u.
fn unit_normal(corners: &[Vector; 3]) -> Vector {
    let [a, b, c] = corners;
    let squares = [(c - b).norm_squared(), (a - c).norm_squared(), (b - a).norm_squared()];
    let [at, next, last] = match squares {
        [x, y, z] if x >= y && x >= z => [0, 1, 2],
        [_, y, z] if y >= z => [1, 2, 0],
        _ => [2, 0, 1],
    };
    let normal = (corners[next] - corners[at]).cross(&(corners[last] - corners[at]));
    if normal.norm_squared() > 0.25 * squares[next] * squares[last] {
        return Vector::from(over_length(<[f64; 3]>::from(normal))).add_scalar(0.0);
    }
    normal_of(&area_vector(a, b, c), a, b, c)
}

/// The next half-edge around a triangle.
pub(super) fn next(half_edge: u32) -> u32 {
    if half_edge % 3 == 2 { half_edge - 2 } else { half_edge + 1 }
}

/// The half-edge before.
pub(super) fn previous(half_edge: u32) -> u32 {
    if half_edge.is_multiple_of(3) { half_edge + 2 } else { half_edge - 1 }
}

/// A side of a triangle between two places.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
struct TriangleSide {
    /// The lesser place first.
    ends: [u32; 2],
    half_edge: u32,
    is_upwards: bool,
}

/// Joins sides whose ends are at equal places and that go opposite ways, and leaves out triangles that stand there before: their
/// normals become 0. At a side of several triangles two are neighbours that have nothing before their fronts but each other.
fn find_twins(vertices: &[Vector], records: &mut [TriangleRecord], normals: &mut [Vector]) -> Result<()> {
    let place_of = first_at_same_place(vertices)?;
    let mut sides = sides_of(&place_of, records, normals)?;
    let is_plain =
        |same: &[TriangleSide]| matches!(same, [_]) || matches!(same, [a, b] if a.is_upwards != b.is_upwards);
    if !sides.chunk_by(|one, other| one.ends == other.ends).all(is_plain) {
        leave_out_copies(&place_of, records, normals)?;
        sides = sides_of(&place_of, records, normals)?;
    }
    let mut around = Vec::new();
    for same in sides.chunk_by(|one, other| one.ends == other.ends) {
        match same {
            [_] => {}
            [one, other] if one.is_upwards != other.is_upwards => join(records, one, other),
            [_, _] => {}
            several => {
                around.clear();
                let axes = |side: &TriangleSide| side.axes(vertices, records, normals);
                let first = axes(&several[0]);
                extend(&mut around, several.iter().map(|side| (angle(first, axes(side)[0]), *side)))?;
                // Along a sheet of two triangles, back to back, the one that faces backwards is met first.
                around.sort_unstable_by(|(a, one), (b, other)| {
                    a.total_cmp(b).then(one.is_upwards.cmp(&other.is_upwards))
                });
                for (at, (_, one)) in around.iter().enumerate() {
                    let (_, other) = &around[(at + 1) % around.len()];
                    if one.is_upwards && !other.is_upwards {
                        join(records, one, other);
                    }
                }
            }
        }
    }
    Ok(())
}

fn join(records: &mut [TriangleRecord], one: &TriangleSide, other: &TriangleSide) {
    records[one.half_edge as usize / 3].twins[one.half_edge as usize % 3] = other.half_edge;
    records[other.half_edge as usize / 3].twins[other.half_edge as usize % 3] = one.half_edge;
}

impl TriangleSide {
    /// Towards the inside of the triangle, and the way to which it faces; along the normal for a half-edge that goes upwards.
    fn axes(&self, vertices: &[Vector], records: &[TriangleRecord], normals: &[Vector]) -> [Vector; 2] {
        let (triangle, k) = (self.half_edge as usize / 3, self.half_edge as usize % 3);
        let (corners, normal) = (records[triangle].corners, normals[triangle]);
        let along = vertices[corners[(k + 1) % 3] as usize] - vertices[corners[k] as usize];
        let inward = normal.cross(&along);
        [inward / inward.norm(), if self.is_upwards { normal } else { -normal }]
    }
}

/// The angle of a triangle around a side, from the first of those there, the way to which triangles that go upwards face.
fn angle([inward, ahead]: [Vector; 2], to: Vector) -> f64 {
    let angle = around(to.dot(&inward), to.dot(&ahead));
    // Those of a plane are at one angle, whatever rounding says.
    (angle * f64::from(1 << 24)).round() % f64::from(4 << 24)
}

/// The sides of all triangles that are not left out, those between two places together.
fn sides_of(place_of: &[u32], records: &[TriangleRecord], normals: &[Vector]) -> Result<Vec<TriangleSide>> {
    let mut sides = with_capacity(3 * records.len())?;
    for (t, record) in records.iter().enumerate().filter(|(t, _)| normals[*t] != Vector::zeros()) {
        let places = record.corners.map(|v| place_of[v as usize]);
        for k in 0..3 {
            let [from, to] = [places[k], places[(k + 1) % 3]];
            sides.push(TriangleSide {
                ends: [from.min(to), from.max(to)],
                half_edge: (3 * t + k) as u32,
                is_upwards: from < to,
            });
        }
    }
    sides.sort_unstable();
    Ok(sides)
}

/// Leaves out all but the first of triangles with equal corners in the same turn.
fn leave_out_copies(place_of: &[u32], records: &[TriangleRecord], normals: &mut [Vector]) -> Result<()> {
    let mut turned = with_capacity(records.len())?;
    for (t, record) in (0_u32..).zip(records).filter(|(t, _)| normals[*t as usize] != Vector::zeros()) {
        let mut places = record.corners.map(|v| place_of[v as usize]);
        while places[0] > places[1].min(places[2]) {
            places.rotate_left(1);
        }
        turned.push((places, t));
    }
    turned.sort_unstable();
    for same in turned.chunk_by(|one, other| one.0 == other.0) {
        same[1..].iter().for_each(|(_, t)| normals[*t as usize] = Vector::zeros());
    }
    Ok(())
}

/// For each vertex, the first one with equal coordinates.
fn first_at_same_place(vertices: &[Vector]) -> Result<Vec<u32>> {
    let mut order: Vec<u32> = collected(0..vertices.len() as u32)?;
    let key = |v: u32| <[f64; 3]>::from(vertices[v as usize]);
    // No coordinate is a NaN or −0.
    order.sort_unstable_by(|a, b| key(*a).partial_cmp(&key(*b)).unwrap_or(std::cmp::Ordering::Equal).then(a.cmp(b)));
    let mut place_of = filled(0, vertices.len())?;
    for same in order.chunk_by(|a, b| key(*a) == key(*b)) {
        same.iter().for_each(|v| place_of[*v as usize] = same[0]);
    }
    Ok(place_of)
}
