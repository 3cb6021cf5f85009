//! Levels after D. P. Dobkin and D. G. Kirkpatrick ("Determining the Separation of Preprocessed Polyhedra: A Unified Approach",
//! ICALP 1990), as Ehmann & Lin 2000, §4.4, make bounding volumes of them.
//!
//! From level to level an independent set of flat vertices is removed, and each hole is filled by the outer hull of the vertices
//! around it: the rest is the exact hull of a part of the body's vertices, and the next removal begins there. For its bounding
//! volume the vertices move outward along rays from the body's centre of mass c, all by one factor at first (scaling), and then
//! back one by one as far as the volume stays convex and bounds the body (relaxation).
//!
//! On those rays both conditions are *linear*. Let r = p − c for each vertex, and let the level have its vertices at r/x. A
//! point q of the body lies in the cone of one triangle, its centre-of-mass region: r_q = α·r_a + β·r_b + γ·r_c with α, β, γ
//! ≥ 0. It is below the plane through the moved corners exactly if α·x_a + β·x_b + γ·x_c ≤ 1. The vertex d beyond the edge of a
//! triangle (a, b, c) is below its plane exactly if α·x_a + β·x_b + γ·x_c ≤ x_d, with r_d = α·r_a + β·r_b + γ·r_c. Neither the
//! cones nor their coefficients change while vertices slide.
//!
//! The combinatorics are exact. Factors are floating point: the caller proves that the level bounds the body (see `hierarchy`).

mod surface;
mod relaxation;

use crate::base::error::Result;
use crate::base::math::{UNIT_ROUNDOFF, Vector};
use crate::base::memory::{collected, copied, extend, filled, listed, push, with_capacity};
use crate::base::progress::Progress;
use crate::body::polyhedron::NONE;
use relaxation::Cone;
pub use surface::DobkinKirkpatrick;
use surface::{SurfaceTriangle, normal, place_of};

/// Vertices above this importance are peaks, and stay: without them the level would have to be scaled by much (Ehmann & Lin
/// 2000, §4.4). A corner of a box has importance 3, so a box gets no level.
const MOST_IMPORTANT: f64 = 1.0;

/// Vertices of more neighbours stay: filling their holes takes time in proportion to the square. No level would be without the
/// tip of a cone anyway.
const LARGEST_VALENCE: usize = 100;

/// A level that saves less than one triangle in sixteen is not worth its memory; without such a limit a body of which only a
/// vertex at a time can go would fill it.
const LEAST_SAVING: usize = 16;

/// The next level as it comes from here.
pub struct Removal {
    /// The vertices of the body that are left, ascending.
    pub vertices: Vec<u32>,
    /// Their positions on this level, in the centred coordinates of the body.
    pub points: Vec<Vector>,
    /// The triangles that fill holes: their corners, ascending, and the removed vertex. Ordered by the corners.
    pub filled: Vec<([u32; 3], u32)>,
}

impl DobkinKirkpatrick<'_> {
    /// The next level, of at least `minimum` triangles. `None` where the construction ends: a tetrahedron or the minimum is
    /// reached, hardly any vertex is flat enough to be removed, or the centre of mass would come to lie outside.
    ///
    /// # Errors
    /// [`crate::base::error::Error::Cancelled`], [`crate::base::error::Error::Memory`].
    pub fn next(&mut self, minimum: usize, progress: &mut Progress) -> Result<Option<Removal>> {
        let set = self.independent_set(minimum.max(4))?;
        if set.is_empty() || 2 * LEAST_SAVING * set.len() < self.triangle_count {
            return Ok(None);
        }
        progress.report(0.1)?;
        let mut filled = Vec::new();
        for &v in &set {
            if !self.remove(v, &mut filled)? {
                return Ok(None);
            }
        }
        filled.sort_unstable();
        progress.report(0.3)?;
        self.left.retain(|v| self.triangle_at[*v as usize] != NONE);
        self.pack_triangles()?;
        let x = self.relaxed(&self.conditions()?)?;
        progress.report(0.9)?;

        // A constraint met with equality becomes one met in spite of rounding: a few u·ρ at planes of the least height.
        let radius = self.base.mass.radius;
        let least = (0..self.triangles.len() as u32).map(|t| self.height(t));
        let grown = 1.0 + 64.0 * UNIT_ROUNDOFF * radius / least.fold(radius, f64::min);
        if !(1.0..2.0).contains(&grown) {
            return Ok(None);
        }
        let centre = self.base.mass.centre_of_mass - self.base.centre;
        let place = |v: &u32| centre + self.rays[*v as usize] * (grown / x[*v as usize]);
        let points = collected(self.left.iter().map(place))?;
        progress.report(1.0)?;
        Ok(Some(Removal { vertices: copied(&self.left)?, points, filled }))
    }

    /// Importance: Σ (1 − n·n′) over the edges of a vertex, n and n′ the normals beside; with the interior dihedral angle θ
    /// this is the paper's Σ (1 + cos θ). 0 where the surface is flat, 3 at the corner of a box.
    fn importance(&self, v: u32, star: &[u32]) -> f64 {
        debug_assert!(star.iter().all(|t| self.triangles[*t as usize].corners.contains(&v)));
        let normal = |k: usize| &self.triangles[star[k % star.len()] as usize].normal;
        (0..star.len()).map(|k| 1.0 - normal(k).dot(normal(k + 1))).sum()
    }

    /// Vertices to be removed, no two of them neighbours: the least important ones first, among equal ones the lowest; ascending.
    ///
    /// Such a vertex is taken unless a less important neighbour is. So they need not be visited in order of importance, which
    /// jumps about in memory: a caller that asks for one decides its less important neighbours before.
    fn independent_set(&self, minimum: usize) -> Result<Vec<u32>> {
        let mut star = Vec::new();
        // Infinite for a vertex that stays in any case.
        let mut importances = filled(f64::INFINITY, self.rays.len())?;
        for &v in &self.left {
            self.star(v, &mut star)?;
            let importance = self.importance(v, &star);
            if importance <= MOST_IMPORTANT && star.len() <= LARGEST_VALENCE {
                importances[v as usize] = importance;
            }
        }
        let by_importance =
            |v: &u32, w: &u32| importances[*v as usize].total_cmp(&importances[*w as usize]).then(v.cmp(w));
        let mut is_decided: Vec<bool> = collected(importances.iter().map(|importance| importance.is_infinite()))?;
        let mut set = Vec::new();
        let mut waiting = Vec::new();
        for &v in &self.left {
            push(&mut waiting, v)?;
            while let Some(&v) = waiting.last() {
                if is_decided[v as usize] {
                    waiting.pop();
                    continue;
                }
                self.star(v, &mut star)?;
                let ring = || star.iter().map(|t| self.following(*t, v));
                match ring().find(|w| !is_decided[*w as usize] && by_importance(w, &v).is_lt()) {
                    Some(w) => push(&mut waiting, w)?,
                    None => {
                        // None of its neighbours is taken: that would have decided this vertex.
                        push(&mut set, v)?;
                        is_decided[v as usize] = true;
                        ring().for_each(|w| is_decided[w as usize] = true);
                    }
                }
            }
        }
        // Each vertex takes two triangles with it.
        let most = self.triangle_count.saturating_sub(minimum) / 2;
        if set.len() > most {
            set.sort_unstable_by(by_importance);
            set.truncate(most);
        }
        set.sort_unstable();
        Ok(set)
    }

    /// Removes a vertex and fills the hole by the outer hull of the vertices around it. `false` if the centre of mass is not inside
    /// of all of the filling.
    fn remove(&mut self, v: u32, filled: &mut Vec<([u32; 3], u32)>) -> Result<bool> {
        let mut star = Vec::new();
        self.star(v, &mut star)?;
        let mut ring = with_capacity(star.len())?;
        let mut outer = with_capacity(star.len())?;
        let mut region = listed([v]);
        for &t in &star {
            let triangle = &mut self.triangles[t as usize];
            let next = (place_of(triangle, v) + 1) % 3;
            ring.push(triangle.corners[next]);
            outer.push(triangle.neighbours[next]);
            triangle.is_free = true;
            let first = triangle.region;
            extend(&mut region, self.region(first))?;
        }
        extend(&mut self.free, star.iter().copied())?;
        self.triangle_at[v as usize] = NONE;
        self.triangle_count -= 2;
        let filling = self.fill(&ring, &outer)?;
        let is_inside = filling.iter().all(|t| self.height(*t) > 64.0 * UNIT_ROUNDOFF * self.base.mass.radius);
        for &t in &filling {
            let mut corners = self.triangles[t as usize].corners;
            corners.sort_unstable();
            push(filled, (corners, v))?;
        }
        let cones: Vec<Cone> = collected(filling.iter().map(|t| self.cone(*t)))?;
        for q in region {
            // The cones of the filling are those of the hole: q is in one of them, up to rounding.
            let ray = &self.rays[q as usize];
            let inside = |cone: &Cone| cone.coefficients(ray).into_iter().fold(f64::INFINITY, f64::min);
            let depths = filling.iter().zip(&cones).map(|(t, cone)| (*t, inside(cone)));
            if let Some((t, _)) = depths.max_by(|(_, a), (_, b)| a.total_cmp(b)) {
                let first = &mut self.triangles[t as usize].region;
                self.next_in_region[q as usize] = std::mem::replace(first, q);
            }
        }
        Ok(is_inside)
    }

    /// Drops free triangles; the others keep their order, in which neighbours are near each other.
    fn pack_triangles(&mut self) -> Result<()> {
        let mut number = 0;
        let numbers: Vec<u32> = collected(self.triangles.iter().map(|triangle| {
            number += u32::from(!triangle.is_free);
            number.wrapping_sub(1)
        }))?;
        self.triangles.retain(|triangle| !triangle.is_free);
        for triangle in &mut self.triangles {
            triangle.neighbours = triangle.neighbours.map(|t| numbers[t as usize]);
        }
        for v in &self.left {
            let t = &mut self.triangle_at[*v as usize];
            *t = numbers[*t as usize];
        }
        self.free.clear();
        Ok(())
    }

    /// Fills the hole within a ring (counter-clockwise from outside; `outer[k]` is the triangle beyond the edge from
    /// `ring[k]`), wrapping each part of the ring like a gift: over the chord from its first to its last vertex the one above
    /// which no other lies. Returns the new triangles. Time in proportion to the square of the ring at worst.
    fn fill(&mut self, ring: &[u32], outer: &[u32]) -> Result<Vec<u32>> {
        debug_assert!(ring.len() >= 3 && outer.len() == ring.len());
        let mut filling = with_capacity(ring.len() - 2)?;
        // Parts of the ring, and the triangle and its side beyond the chord; beyond the first chord, an edge of the ring, it is
        // outer.
        let last = ring.len() - 1;
        let mut parts = listed([(0, last, outer[last], NONE)]);
        while let Some((i, j, beyond, side)) = parts.pop() {
            let (tail, head) = (ring[i], ring[j]);
            if i + 1 == j {
                // An edge of the ring; `beyond` is a new triangle.
                self.triangles[beyond as usize].neighbours[side as usize] = outer[i];
                self.join(outer[i], head, beyond);
                continue;
            }
            let mut apex = i + 1;
            let mut plane = self.exact.plane([tail, ring[apex], head]);
            for k in i + 2..j {
                if self.exact.height(&plane, ring[k]) > 0.0 {
                    apex = k;
                    plane = self.exact.plane([tail, ring[apex], head]);
                }
            }
            let t = self.add([tail, ring[apex], head], beyond)?;
            if side == NONE {
                self.join(beyond, tail, t);
            } else {
                self.triangles[beyond as usize].neighbours[side as usize] = t;
            }
            filling.push(t);
            push(&mut parts, (i, apex, t, 0))?;
            push(&mut parts, (apex, j, t, 1))?;
        }
        Ok(filling)
    }

    /// Makes `other` the neighbour of a triangle across the edge that begins at `from`, seen from that triangle.
    fn join(&mut self, triangle: u32, from: u32, other: u32) {
        let triangle = &mut self.triangles[triangle as usize];
        let place = place_of(triangle, from);
        triangle.neighbours[place] = other;
    }

    /// A new triangle; `across` is beyond the edge from its last corner to its first.
    fn add(&mut self, corners: [u32; 3], across: u32) -> Result<u32> {
        let normal = normal(&self.rays, corners);
        let new = SurfaceTriangle { corners, neighbours: [NONE, NONE, across], normal, region: NONE, is_free: false };
        let t = match self.free.pop() {
            Some(t) => {
                self.triangles[t as usize] = new;
                t
            }
            None => {
                push(&mut self.triangles, new)?;
                self.triangles.len() as u32 - 1
            }
        };
        for v in corners {
            self.triangle_at[v as usize] = t;
        }
        Ok(t)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::body::build::assembly::build;
    use crate::body::polyhedron::Polyhedron;
    use swiftprox::random::Random;

    /// Ellipsoids of few and of many vertices, and a ball with spikes.
    fn bodies() -> Vec<Polyhedron> {
        let mut random = Random::new(21);
        let mut bodies = Vec::new();
        for (count, half_axes) in [(40, [1.0, 1.0, 1.0]), (300, [1.0, 0.7, 0.2]), (1000, [1.0, 1.0, 0.1])] {
            let points: Vec<Vector> =
                (0..count).map(|_| random.direction().component_mul(&Vector::from(half_axes))).collect();
            bodies.push(build(&points, None).unwrap());
        }
        let mut points: Vec<Vector> = (0..300).map(|_| random.direction()).collect();
        points.extend((0..6).map(|_| random.direction() * 4.0));
        bodies.push(build(&points, None).unwrap());
        bodies
    }

    fn next(removing: &mut DobkinKirkpatrick) -> Option<Removal> {
        removing.next(4, &mut Progress::new(&mut |_| true)).unwrap()
    }

    /// The importance and the neighbours of each vertex of the hull of some vertices of a body.
    fn importances(body: &Polyhedron, ids: &[u32]) -> Vec<(f64, Vec<u32>)> {
        let points: Vec<Vector> = ids.iter().map(|v| body.vertices[*v as usize].position).collect();
        let hull = build(&points, None).unwrap();
        assert_eq!(hull.vertices.len(), ids.len());
        let id = |v: u32| ids[hull.vertex_labels[v as usize] as usize];
        let mut beside = std::collections::HashMap::new();
        for corners in &hull.triangles {
            let [a, b, c] = corners.map(|v| hull.vertices[v as usize].position);
            let normal = (b - a).cross(&(c - a)).normalize();
            for k in 0..3 {
                beside.insert((id(corners[k]), id(corners[(k + 1) % 3])), normal);
            }
        }
        let mut all = vec![(0.0, Vec::new()); body.vertices.len()];
        for (&(tail, head), normal) in &beside {
            let (importance, neighbours) = &mut all[tail as usize];
            *importance += 1.0 - normal.dot(&beside[&(head, tail)]);
            neighbours.push(head);
        }
        all
    }

    /// The least important first, none beside another, none of an importance above 1 (Ehmann & Lin 2000, §4.4).
    #[test]
    #[cfg_attr(miri, ignore = "builds levels, which takes it hours")]
    fn flat_vertices_go_and_peaks_stay() {
        let (mut levels, mut peaks) = (0, 0);
        for body in bodies() {
            let mut removing = DobkinKirkpatrick::new(&body).unwrap();
            let mut ids: Vec<u32> = (0..body.vertices.len() as u32).collect();
            while let Some(Removal { vertices, .. }) = next(&mut removing) {
                let all = importances(&body, &ids);
                let mut order = ids.clone();
                order.sort_by(|v, w| all[*v as usize].0.total_cmp(&all[*w as usize].0));
                let mut is_left = vec![true; body.vertices.len()];
                for v in order {
                    let (importance, neighbours) = &all[v as usize];
                    let is_free =
                        neighbours.iter().all(|w| is_left[*w as usize]) && neighbours.len() <= LARGEST_VALENCE;
                    is_left[v as usize] = !is_free || *importance > 1.0;
                    peaks += usize::from(is_free && *importance > 1.0);
                }
                ids.retain(|v| is_left[*v as usize]);
                assert_eq!(vertices, ids);
                levels += 1;
            }
        }
        // There were vertices that nothing but their importance has kept.
        assert!(levels > 15 && peaks > 50, "{levels} {peaks}");
    }

    /// Three right angles at each corner make an importance of 3.
    #[test]
    fn a_box_has_no_vertex_to_remove() {
        let side = |bit: usize, i: usize| if i & bit == 0 { 0.0 } else { bit as f64 };
        let corners: Vec<Vector> = (0..8).map(|i| Vector::new(side(1, i), side(2, i), side(4, i))).collect();
        let cuboid = build(&corners, None).unwrap();
        assert!((0..8).all(|v| (importances(&cuboid, &[0, 1, 2, 3, 4, 5, 6, 7])[v].0 - 3.0).abs() < 1e-12));
        assert!(next(&mut DobkinKirkpatrick::new(&cuboid).unwrap()).is_none());
        // With one corner cut off the three new ones are flatter, but not flat enough.
        let mut cut = corners[..7].to_vec();
        let cut_off = |k: usize| Vector::from_fn(|i, _| corners[7][i] * if i == k { 0.5 } else { 1.0 });
        cut.extend((0..3).map(cut_off));
        assert!(next(&mut DobkinKirkpatrick::new(&build(&cut, None).unwrap()).unwrap()).is_none());
    }

    /// The apex of a flat pyramid is flat enough to be removed. The base fills its hole, below the centre of mass.
    #[test]
    fn what_would_leave_the_centre_of_mass_outside_is_not_removed() {
        let ring =
            (0..24).map(|i| f64::from(i) / 24.0 * std::f64::consts::TAU).map(|a| Vector::new(a.cos(), a.sin(), 0.0));
        let corners: Vec<Vector> = ring.chain([Vector::new(0.0, 0.0, 0.125)]).collect();
        let pyramid = build(&corners, None).unwrap();
        let apex = (0..25).find(|v| pyramid.local_position(*v).z > 0.1).unwrap();
        let mut removing = DobkinKirkpatrick::new(&pyramid).unwrap();
        assert!(!removing.remove(apex, &mut Vec::new()).unwrap());
        // That of a body deep enough stays inside.
        let deep: Vec<Vector> = corners.iter().copied().chain([Vector::new(0.0, 0.0, -2.0)]).collect();
        let top = build(&deep, None).unwrap();
        let apex = (0..26).find(|v| top.local_position(*v).z > 0.1).unwrap();
        let mut removing = DobkinKirkpatrick::new(&top).unwrap();
        assert!(removing.remove(apex, &mut Vec::new()).unwrap());
    }

    /// Vertices move along their rays from the centre of mass, out by the factor that makes the level bound the body, and back
    /// as far as it still does: that brings it nearer to the body than scaling alone.
    #[test]
    #[cfg_attr(miri, ignore = "builds levels, which takes it hours")]
    fn relaxation_draws_vertices_back_along_their_rays() {
        let (mut levels, mut nearer) = (0.0, [0.0; 2]);
        for body in bodies() {
            let centre = body.mass.centre_of_mass - body.centre;
            let mut removing = DobkinKirkpatrick::new(&body).unwrap();
            while let Some(Removal { vertices, points, .. }) = next(&mut removing) {
                let kept: Vec<Vector> = vertices.iter().map(|v| body.vertices[*v as usize].position - centre).collect();
                // The factor, from the planes of the hull of the rest.
                let hull = build(&kept, None).unwrap();
                let mut factor = 1.0_f64;
                for corners in &hull.triangles {
                    let [a, b, c] = corners.map(|v| hull.local_position(v));
                    let normal = (b - a).cross(&(c - a));
                    let support = |v: &crate::body::polyhedron::Vertex| normal.dot(&(v.position - centre));
                    let highest = body.vertices.iter().map(support).fold(0.0, f64::max);
                    factor = factor.max(highest / normal.dot(&a));
                }
                let mut drawn_back = 0;
                for (point, ray) in points.iter().zip(&kept) {
                    let p = point - centre;
                    assert!(p.cross(ray).norm() <= 1e-14 * p.norm() * body.radius);
                    let by = p.norm() / ray.norm();
                    assert!((1.0 - 1e-12..=factor * (1.0 + 1e-9)).contains(&by), "{by} of {factor}");
                    drawn_back += usize::from(by < factor * (1.0 - 1e-6));
                }
                assert!(3 * drawn_back > points.len(), "{drawn_back} of {}", points.len());
                // It bounds the body, and its vertices are less far above the body's planes.
                let level = build(&points, None).unwrap();
                for face in &level.faces {
                    let height = face.normal.dot(&(level.local_position(face.vertex)));
                    let support = body.vertices.iter().map(|v| face.normal.dot(&v.position)).fold(0.0, f64::max);
                    assert!(support <= height + 1e-12 * body.radius, "{support} {height}");
                }
                let above = |p: &Vector| body.faces.iter().map(|face| face.planes.value(0, p)).fold(0.0, f64::max);
                let measure = |points: &mut dyn Iterator<Item = Vector>| {
                    let heights: Vec<f64> = points.map(|p| above(&p)).collect();
                    [heights.iter().copied().fold(0.0, f64::max), heights.iter().sum::<f64>()]
                };
                let relaxed = measure(&mut points.iter().copied());
                let scaled = measure(&mut kept.iter().map(|ray| centre + ray * factor));
                for i in 0..2 {
                    assert!(relaxed[i] <= scaled[i] * (1.0 + 1e-9), "{relaxed:?} {scaled:?}");
                    nearer[i] += 1.0 - relaxed[i] / scaled[i];
                }
                levels += 1.0;
            }
        }
        // The corners of the planes that touch the body can give no way; most others do.
        let [largest, mean] = nearer.map(|sum| sum / levels);
        println!("{levels} levels: the largest deviation of a vertex {largest} less, the mean {mean} less");
        assert!(levels > 15.0 && largest > 0.01 && mean > 0.2);
    }
}
