//! Triangles over vertices, and which of them are neighbours.

use crate::base::error::Result;
use crate::base::math::Vector;
use crate::base::memory::{collected, copied, extend, filled, with_capacity};

/// Across no side: the surface ends there, or its triangles there make no surface.
pub(super) const NONE: u32 = u32::MAX;

/// A triangle, in 48 bytes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct TriangleRecord {
    pub corners: [u32; 3],
    /// The twins of the half-edges 3t + k, from corner k to the next, or [`NONE`].
    pub twins: [u32; 3],
    /// Unit; 0 of triangles that are left out.
    pub normal: Vector,
}

/// Vertices and the triangles over them.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct GroundTriangles {
    pub vertices: Vec<Vector>,
    pub records: Vec<TriangleRecord>,
}

impl GroundTriangles {
    /// The unit normal of a triangle, out of its front.
    pub fn normal(&self, triangle: u32) -> Vector {
        self.records[triangle as usize].normal
    }

    /// Start of a half-edge.
    pub fn tail(&self, half_edge: u32) -> Vector {
        self.vertices[self.records[half_edge as usize / 3].corners[half_edge as usize % 3] as usize]
    }

    /// The half-edge on the other side, or [`NONE`].
    pub fn twin(&self, half_edge: u32) -> u32 {
        self.records[half_edge as usize / 3].twins[half_edge as usize % 3]
    }

    /// Memory held beside the struct, in bytes.
    pub fn heap_bytes(&self) -> usize {
        size_of_val(&self.vertices[..]) + size_of_val(&self.records[..])
    }

    /// # Errors
    /// [`Error::Memory`](crate::base::error::Error::Memory).
    pub fn try_clone(&self) -> Result<GroundTriangles> {
        Ok(GroundTriangles { vertices: copied(&self.vertices)?, records: copied(&self.records)? })
    }
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
pub(super) fn find_twins(vertices: &[Vector], records: &mut [TriangleRecord]) -> Result<()> {
    let place_of = first_at_same_place(vertices)?;
    let mut sides = sides_of(&place_of, records)?;
    let is_plain =
        |same: &[TriangleSide]| matches!(same, [_]) || matches!(same, [a, b] if a.is_upwards != b.is_upwards);
    if !sides.chunk_by(|one, other| one.ends == other.ends).all(is_plain) {
        leave_out_copies(&place_of, records)?;
        sides = sides_of(&place_of, records)?;
    }
    let mut around = Vec::new();
    for same in sides.chunk_by(|one, other| one.ends == other.ends) {
        match same {
            [_] => {}
            [one, other] if one.is_upwards != other.is_upwards => join(records, one, other),
            [_, _] => {}
            several => {
                around.clear();
                extend(&mut around, several.iter().map(|side| (angle(vertices, records, several, side), *side)))?;
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

/// The angle of a triangle around a side, from the first of those there, the way to which triangles that go upwards face.
fn angle(vertices: &[Vector], records: &[TriangleRecord], several: &[TriangleSide], side: &TriangleSide) -> f64 {
    // Towards the inside, along the normal, for a half-edge that goes upwards.
    let axes = |side: &TriangleSide| {
        let TriangleRecord { corners, normal, .. } = records[side.half_edge as usize / 3];
        let k = side.half_edge as usize % 3;
        let along = vertices[corners[(k + 1) % 3] as usize] - vertices[corners[k] as usize];
        let inward = normal.cross(&along);
        [inward / inward.norm(), if side.is_upwards { normal } else { -normal }]
    };
    let ([inward, ahead], [to, _]) = (axes(&several[0]), axes(side));
    let angle = to.dot(&ahead).atan2(to.dot(&inward));
    // Those of a plane are at one angle, whatever rounding says.
    let angle = (angle * f64::from(1 << 24)).round();
    if angle < 0.0 { angle + (std::f64::consts::TAU * f64::from(1 << 24)).round() } else { angle }
}

/// The sides of all triangles that are not left out, those between two places together.
fn sides_of(place_of: &[u32], records: &[TriangleRecord]) -> Result<Vec<TriangleSide>> {
    let mut sides = with_capacity(3 * records.len())?;
    for (t, record) in records.iter().enumerate().filter(|(_, record)| record.normal != Vector::zeros()) {
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
fn leave_out_copies(place_of: &[u32], records: &mut [TriangleRecord]) -> Result<()> {
    let mut turned = with_capacity(records.len())?;
    for (t, record) in (0_u32..).zip(&*records).filter(|(_, record)| record.normal != Vector::zeros()) {
        let mut places = record.corners.map(|v| place_of[v as usize]);
        while places[0] > places[1].min(places[2]) {
            places.rotate_left(1);
        }
        turned.push((places, t));
    }
    turned.sort_unstable();
    for same in turned.chunk_by(|one, other| one.0 == other.0) {
        same[1..].iter().for_each(|(_, t)| records[*t as usize].normal = Vector::zeros());
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
