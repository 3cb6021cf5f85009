//! Which of the caller's polygons on a face holds a point: if they are few, all are looked at, if many, a search tells.

use crate::base::error::Result;
use crate::base::math::{Vector, clamp, is_unit, moderate_unit};
use crate::body::polyhedron::Polyhedron;
use crate::body::polyhedron::polygon_search::{FEW_POLYGONS, Partitions, Polygons};

impl Polyhedron {
    /// The caller's polygon that holds a (centred) point of a face, the lowest where several do; the one that misses it least if
    /// rounding puts it in none: that alone takes time in proportion to the polygons merged into the face.
    pub fn polygon_at(&self, face: u32, point: &Vector) -> u32 {
        debug_assert!((face as usize) < self.faces.len());
        let labels = self.labels_of_face(face);
        if labels.len() == 1 || self.polygon_starts.is_empty() {
            return labels[0];
        }
        if labels.len() > FEW_POLYGONS
            && let Some(polygon) = self.polygon_around(face, point)
        {
            return self.face_labels[polygon as usize];
        }
        self.nearest_polygon(face, point)
    }

    /// By a look at all polygons of a face.
    fn nearest_polygon(&self, face: u32, point: &Vector) -> u32 {
        let labels = self.labels_of_face(face);
        let normal = &self.faces[face as usize].normal;
        let mut best = (f64::INFINITY, labels[0]);
        for (k, &label) in (self.face_label_starts[face as usize]..).zip(labels) {
            let misses = misses_polygon(self.polygons(), k, normal, point);
            if misses < best.0 {
                best = (misses, label);
            }
            if misses == 0.0 {
                break;
            }
        }
        best.1
    }

    /// By a search, made on first need; none where memory is lacking for it.
    fn polygon_around(&self, face: u32, point: &Vector) -> Option<u32> {
        let made = &self.polygon_search.made;
        let partitions = match made.get() {
            Some(partitions) => partitions,
            None => made.make(|| self.partitions())?,
        };
        partitions.find(self.polygons(), face, &self.faces[face as usize].normal, point)
    }

    /// Makes the search that finds polygons on faces of many, if it is not made.
    ///
    /// # Errors
    /// [`Error::Memory`](crate::base::error::Error::Memory).
    pub(crate) fn insist_on_polygon_search(&self) -> Result<()> {
        let is_many = |starts: &[u32]| (starts[1] - starts[0]) as usize > FEW_POLYGONS;
        if !self.polygon_starts.is_empty() && self.face_label_starts.windows(2).any(is_many) {
            self.polygon_search.made.insist(|| self.partitions())?;
        }
        Ok(())
    }

    fn partitions(&self) -> Result<Partitions> {
        let ranges = self.face_label_starts.windows(2).map(|starts| starts[0]..starts[1]);
        let normals = self.faces.iter().map(|face| face.normal);
        Partitions::new(self.polygons(), ranges.zip(normals), self.radius)
    }

    fn polygons(&self) -> Polygons<'_> {
        Polygons { corners: &self.polygon_corners, starts: &self.polygon_starts, radius: self.radius }
    }
}

/// How far a point over a convex polygon's plane lies out of its prism: 0 inside, else the distance to the nearest side, in a unit
/// that all polygons of the body share. At the sharp corner of a sliver a point may violate the sides by next to nothing and still
/// be far away.
fn misses_polygon(polygons: Polygons, k: u32, normal: &Vector, point: &Vector) -> f64 {
    debug_assert!(is_unit(normal));
    if polygons.holds(k, normal, point) {
        return 0.0;
    }
    let corners = polygons.corners_of(k);
    let unit = moderate_unit(polygons.radius);
    let mut nearest = f64::INFINITY;
    for (i, a) in corners.iter().enumerate() {
        let along = (corners[(i + 1) % corners.len()] - a) * unit;
        let from = (point - a) * unit;
        let square = along.norm_squared();
        // A side without length is a point.
        let t = if square > 0.0 { clamp(from.dot(&along) / square, 0.0, 1.0) } else { 0.0 };
        nearest = nearest.min((from - along * t).norm());
    }
    nearest
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::body::build::assembly::build;
    use crate::body::mesh::PolygonMesh;
    use std::collections::HashSet;
    use swiftprox::random::Random;

    const SIDES: u32 = 60;

    /// A right prism whose lower cap is one polygon and whose upper cap is triangles, over corners and further points of the cap.
    fn prism(further: &[[f64; 2]], triangles: &[u32]) -> Polyhedron {
        let angle = |i: u32| std::f64::consts::TAU * f64::from(i % SIDES) / f64::from(SIDES);
        let corner = |i: u32| Vector::new(angle(i).cos(), angle(i).sin(), f64::from(i / SIDES));
        let mut vertices: Vec<Vector> = (0..2 * SIDES).map(corner).collect();
        vertices.extend(further.iter().map(|[x, y]| Vector::new(*x, *y, 1.0)));
        let mut indices: Vec<u32> = (0..SIDES).rev().collect();
        let mut valences = vec![SIDES];
        for i in 0..SIDES {
            let next = (i + 1) % SIDES;
            indices.extend([i, next, SIDES + next, SIDES + i]);
            valences.push(4);
        }
        indices.extend(triangles);
        valences.extend(vec![3; triangles.len() / 3]);
        let mesh = PolygonMesh::new(vertices, indices, Some(&valences)).unwrap();
        build(&mesh.vertices, Some(&mesh)).unwrap()
    }

    /// Caps as programs triangulate them: fans from a corner and from a hub, and a strip from side to side.
    fn caps() -> [Polyhedron; 3] {
        let top = |i: u32| SIDES + i;
        let fan: Vec<u32> = (1..SIDES - 1).flat_map(|i| [top(0), top(i), top(i + 1)]).collect();
        let hub: Vec<u32> = (0..SIDES).flat_map(|i| [2 * SIDES, top(i), top((i + 1) % SIDES)]).collect();
        let strip: Vec<u32> = (0..SIDES / 2 - 1)
            .flat_map(|i| {
                let [a, b] = [i, i + 1].map(|i| [top(i), top(SIDES - 1 - i)]);
                [a[0], b[0], a[1], b[0], b[1], a[1]]
            })
            .collect();
        [prism(&[], &fan), prism(&[[0.0, 0.0]], &hub), prism(&[], &strip)]
    }

    #[test]
    fn a_search_finds_the_polygon_that_a_look_at_all_finds() {
        let mut random = Random::new(30);
        for polyhedron in caps() {
            let is_top = |face: &u32| polyhedron.labels_of_face(*face).len() > FEW_POLYGONS;
            let face = (0..polyhedron.faces.len() as u32).find(is_top).expect("the upper cap");
            let (mut names, mut most_leaves) = (HashSet::new(), 0);
            for _ in 0..if cfg!(miri) { 20 } else { 2_000 } {
                let point = Vector::new(random.signed(), random.signed(), 1.0) - polyhedron.centre;
                let expected = polyhedron.nearest_polygon(face, &point);
                assert_eq!(polyhedron.polygon_at(face, &point), expected, "{point:?}");
                if let Some(found) = polyhedron.polygon_around(face, &point) {
                    assert_eq!(polyhedron.face_labels[found as usize], expected, "{point:?}");
                    names.insert(found);
                }
                let mut leaves = 0;
                polyhedron.partitions().unwrap().for_each_leaf(face, &point, |_| leaves += 1);
                most_leaves = most_leaves.max(leaves);
            }
            assert!(cfg!(miri) || names.len() > 40, "{}", names.len());
            // A look at all 58 took four fifths of a query of a cap of 498.
            assert!(most_leaves <= 3, "{most_leaves} of at least 15");
        }
    }
}
