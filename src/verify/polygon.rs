//! Whether the polygon of the caller's that is named holds a point of a face which several share.

use crate::base::math::{Vector, clamp, length, moderate};
use crate::body::polyhedron::Polyhedron;

/// By how much a point over a face is farther from the polygon of a label there than from the nearest of those that share the face.
pub fn beyond_nearest(polyhedron: &Polyhedron, face: u32, label: u32, point: &Vector) -> f64 {
    let labels = polyhedron.labels_of_face(face);
    if labels.len() < 2 || polyhedron.polygon_starts.is_empty() {
        return 0.0;
    }
    let normal = &polyhedron.faces[face as usize].normal;
    let (mut own, mut nearest) = (f64::INFINITY, f64::INFINITY);
    for (k, &other) in (polyhedron.face_label_starts[face as usize] as usize..).zip(labels) {
        let [start, end] = [k, k + 1].map(|k| polyhedron.polygon_starts[k] as usize);
        let distance = distance_from_prism(&polyhedron.polygon_corners[start..end], normal, point);
        nearest = nearest.min(distance);
        if other == label {
            own = own.min(distance);
        }
    }
    own - nearest
}

/// 0 over or under a convex polygon, seen along a normal that it goes around counter-clockwise; else how far the nearest side is.
fn distance_from_prism(corners: &[Vector], normal: &Vector, point: &Vector) -> f64 {
    let sides = || corners.iter().zip(corners.iter().cycle().skip(1));
    let is_inside = |(tail, head): (&Vector, &Vector)| {
        moderate(&(head - tail)).cross(&moderate(&(point - tail))).dot(normal) >= 0.0
    };
    if sides().all(is_inside) {
        return 0.0;
    }
    sides().map(|(tail, head)| distance_from_segment(&[*tail, *head], point)).fold(f64::INFINITY, f64::min)
}

/// The distance of a point from a segment.
fn distance_from_segment(ends: &[Vector; 2], point: &Vector) -> f64 {
    let along = ends[1] - ends[0];
    let whole = length(&along);
    if whole == 0.0 {
        return length(&(point - ends[0]));
    }
    let direction = along / whole;
    let t = clamp((point - ends[0]).dot(&direction) / whole, 0.0, 1.0);
    length(&(point - ends[0] - along * t))
}
