//! Finds the triangles that lie in one plane up to rounding.

use super::faces::Triangles;
use crate::base::error::Result;
use crate::base::math::Vector;
use crate::base::memory::{filled, listed, push, with_capacity};
use crate::base::normal::{area_vector, normal_of};
use crate::base::progress::Progress;
use crate::base::sorting::sort_in_steps;
use crate::body::polyhedron::NONE;
use crate::body::polyhedron::triangulation::{Triangulation, previous};

/// The region of each triangle, and the unit normal of each region: connected, each within `bound` of one plane and facing one way,
/// each a disk.
///
/// # Errors
/// [`crate::base::error::Error::Cancelled`] when the caller does not want to go on.
pub fn coplanar_regions(triangles: &Triangles, bound: f64, progress: &mut Progress) -> Result<(Vec<u32>, Vec<Vector>)> {
    let &Triangles { surface, positions, normals, areas } = triangles;
    let mut regions = Regions {
        surface,
        positions,
        triangle_normals: normals,
        bound,
        region_of: filled(NONE, surface.triangles.len())?,
        normals: with_capacity(surface.triangles.len())?,
        out: filled(NONE, positions.len())?,
        failures: filled(0, surface.triangles.len())?,
    };
    // Largest first, and most meshes have few triangles that can begin anything.
    let of_seeds = &mut progress.part(0.0, 0.3);
    let mut seeds = Vec::new();
    for t in 0..surface.triangles.len() as u32 {
        of_seeds.step(t as usize, surface.triangles.len())?;
        if regions.has_coplanar_neighbour(t) {
            push(&mut seeds, t)?;
        }
    }
    let larger_first = |s: &u32, t: &u32| areas[*t as usize].total_cmp(&areas[*s as usize]).then(s.cmp(t));
    sort_in_steps(&mut seeds, larger_first, &mut progress.part(0.3, 0.4))?;
    let of_regions = &mut progress.part(0.4, 1.0);
    for (done, &seed) in seeds.iter().enumerate() {
        if regions.region_of[seed as usize] == NONE {
            regions.add(seed, &mut |steps| of_regions.steps(steps, done, seeds.len()))?;
        }
    }
    for (region, normal) in regions.region_of.iter_mut().zip(normals) {
        if *region == NONE {
            *region = regions.normals.len() as u32;
            regions.normals.push(*normal);
        }
    }
    Ok((regions.region_of, regions.normals))
}

/// The most failed regions (given up) that a triangle may be in before it gets one; after that it is left out of the regions of
/// others. Regions that creep around a smooth needle take in half of it each time.
const MOST_FAILURES: u8 = 8;

/// Regions of triangles while they grow.
struct Regions<'a> {
    surface: &'a Triangulation,
    positions: &'a [Vector],
    triangle_normals: &'a [Vector],
    bound: f64,
    region_of: Vec<u32>,
    /// No more than triangles.
    normals: Vec<Vector>,
    /// Scratch: a region's boundary half-edge out of each vertex, NONE elsewhere.
    out: Vec<u32>,
    /// How often each triangle was in a region that was none.
    failures: Vec<u8>,
}

impl Regions<'_> {
    /// Whether the triangle's plane holds a neighbour that faces the same way.
    fn has_coplanar_neighbour(&self, t: u32) -> bool {
        let normal = &self.triangle_normals[t as usize];
        let origin = &self.positions[self.surface.tail(3 * t) as usize];
        self.surface.twins[3 * t as usize..3 * t as usize + 3].iter().any(|&twin| {
            let apex = &self.positions[self.surface.tail(previous(twin)) as usize];
            normal.dot(&(apex - origin)).abs() <= self.bound
                && self.triangle_normals[twin as usize / 3].dot(normal) > 0.0
        })
    }

    /// Makes a region from a triangle that has none: everything coplanar around it, or single triangles if that
    /// is no disk.
    fn add(&mut self, seed: u32, tell: &mut impl FnMut(usize) -> Result<()>) -> Result<()> {
        let region = self.normals.len() as u32;
        let (triangles, normal) = self.grow(seed, region, tell)?;
        if triangles.len() == 1 || self.is_disk(&triangles)? {
            self.normals.push(normal);
            return Ok(());
        }
        for t in triangles {
            self.region_of[t as usize] = self.normals.len() as u32;
            self.normals.push(self.triangle_normals[t as usize]);
        }
        Ok(())
    }

    /// Marks the triangles around `seed` that lie within the bound of one plane as `region`; returns them and the plane's normal.
    ///
    /// The plane is that of a reference triangle among the region's vertices: the seed first, later one at least twice as large
    /// whenever there is one. So a cap of thin triangles is measured by a large one and not by the extrapolation of a sliver.
    /// If the last plane does not hold all of the region (it crept around a smooth body), the seed stays alone. Tells of steps.
    fn grow(
        &mut self,
        seed: u32,
        region: u32,
        tell: &mut impl FnMut(usize) -> Result<()>,
    ) -> Result<(Vec<u32>, Vector)> {
        let surface = self.surface;
        let position = |v: u32| &self.positions[v as usize];
        let mut reference = surface.triangles[seed as usize];
        let mut normal = self.triangle_normals[seed as usize];
        let mut size = 0.0; // computed when there is a neighbour to compare with
        self.region_of[seed as usize] = region;
        let mut triangles = listed([seed]);
        let mut done = 0;
        while done < triangles.len() {
            let t = triangles[done];
            done += 1;
            tell(1)?;
            for h in 3 * t..3 * t + 3 {
                let twin = surface.twins[h as usize];
                let neighbour = twin / 3;
                if self.region_of[neighbour as usize] != NONE
                    || self.failures[neighbour as usize] == MOST_FAILURES
                    || self.triangle_normals[neighbour as usize].dot(&normal) <= 0.0
                {
                    continue;
                }
                let apex = surface.tail(previous(twin));
                if normal.dot(&(position(apex) - position(reference[0]))).abs() > self.bound {
                    continue;
                }
                self.region_of[neighbour as usize] = region;
                push(&mut triangles, neighbour)?;
                let area = |[a, b, c]: [u32; 3]| (position(b) - position(a)).cross(&(position(c) - position(a))).norm();
                if size == 0.0 {
                    size = area(reference);
                }
                for k in 0..3 {
                    let mut candidate = reference;
                    candidate[k] = apex;
                    let candidate_size = area(candidate);
                    // If squares underflow, all sizes are 0.
                    if candidate_size > 0.0 && candidate_size >= 2.0 * size {
                        let [a, b, c] = candidate.map(position);
                        let candidate_normal = normal_of(&area_vector(a, b, c), a, b, c);
                        normal = if candidate_normal.dot(&normal) < 0.0 { -candidate_normal } else { candidate_normal };
                        (reference, size) = (candidate, candidate_size);
                    }
                }
            }
        }
        let off = |t: &u32| {
            surface.triangles[*t as usize]
                .iter()
                .any(|&v| normal.dot(&(position(v) - position(reference[0]))).abs() > self.bound)
                || self.triangle_normals[*t as usize].dot(&normal) <= 0.0
        };
        if triangles.len() > 1 && triangles.iter().any(off) {
            for &t in &triangles[1..] {
                self.region_of[t as usize] = NONE;
                self.failures[t as usize] += 1;
            }
            triangles.truncate(1);
            normal = self.triangle_normals[seed as usize];
        }
        Ok((triangles, normal))
    }

    /// Whether the region is bounded by one simple loop. On a sphere, that makes it a disk.
    fn is_disk(&mut self, triangles: &[u32]) -> Result<bool> {
        let region = self.region_of[triangles[0] as usize];
        let mut boundary = Vec::new();
        let mut simple = true;
        for h in triangles.iter().flat_map(|t| 3 * t..3 * t + 3) {
            if self.region_of[self.surface.twins[h as usize] as usize / 3] != region {
                let out = &mut self.out[self.surface.tail(h) as usize];
                simple &= *out == NONE;
                *out = h;
                push(&mut boundary, h)?;
            }
        }
        let mut length = 0;
        if simple && let Some(&first) = boundary.first() {
            // As many half-edges arrive at a vertex as leave it, so `out` leads on from everywhere.
            let mut h = first;
            loop {
                length += 1;
                h = self.out[self.surface.head(h) as usize];
                if h == first {
                    break;
                }
            }
        }
        for h in &boundary {
            self.out[self.surface.tail(*h) as usize] = NONE;
        }
        Ok(length > 0 && length == boundary.len())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::body::build::hull::convex_hull;
    use crate::body::build::merge::merge_bound;

    /// Points of a smooth body about the x axis, whose other half axes are `thin`.
    fn needle(count: usize, thin: f64) -> Vec<Vector> {
        let golden = std::f64::consts::PI * (3.0 - 5f64.sqrt());
        let point = |k: usize| {
            let x = 1.0 - (2 * k + 1) as f64 / count as f64;
            let (sine, cosine) = (golden * k as f64).sin_cos();
            let r = thin * (1.0 - x * x).sqrt();
            Vector::new(x, r * cosine, r * sine)
        };
        (0..count).map(point).collect()
    }

    /// Grows all regions; triangles taken into one, and how often each was in one that was none.
    fn growth(points: &[Vector]) -> (usize, Vec<u8>) {
        let hull = convex_hull(points).unwrap();
        let mut index = vec![NONE; points.len()];
        (0..).zip(&hull.vertices).for_each(|(new, old)| index[*old as usize] = new);
        let positions: Vec<Vector> = hull.vertices.iter().map(|v| points[*v as usize]).collect();
        let triangles: Vec<[u32; 3]> = hull.triangles.iter().map(|t| t.map(|v| index[v as usize])).collect();
        let corners = triangles.iter().map(|t| t.map(|v| positions[v as usize]));
        let normals: Vec<Vector> = corners.map(|[a, b, c]| normal_of(&area_vector(&a, &b, &c), &a, &b, &c)).collect();
        let count = triangles.len();
        let surface = Triangulation::new(triangles, &normals, positions.len()).unwrap();
        let mut regions = Regions {
            surface: &surface,
            positions: &positions,
            triangle_normals: &normals,
            bound: merge_bound(1.0),
            region_of: vec![NONE; count],
            normals: Vec::new(),
            out: vec![NONE; positions.len()],
            failures: vec![0; count],
        };
        let mut taken = 0;
        for seed in 0..count as u32 {
            if regions.region_of[seed as usize] == NONE {
                let mut tell = |steps| {
                    taken += steps;
                    Ok(())
                };
                regions.add(seed, &mut tell).unwrap();
            }
        }
        (taken, regions.failures)
    }

    /// Around a smooth needle regions creep and are given up: a triangle is in [`MOST_FAILURES`] of them, then left alone.
    #[test]
    fn growing_takes_each_triangle_a_bounded_number_of_times() {
        let mut left_alone = 0;
        for exponent in 10..17 {
            let (taken, failures) = growth(&needle(1_500, 10f64.powi(-exponent)));
            left_alone += failures.iter().filter(|count| **count == MOST_FAILURES).count();
            // It begins one region besides, or is in one that stays.
            assert!(taken <= (usize::from(MOST_FAILURES) + 1) * failures.len(), "1e-{exponent}: {taken}");
        }
        assert!(left_alone > 0, "no body crosses the limit");
    }
}
