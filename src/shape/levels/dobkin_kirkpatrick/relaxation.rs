//! Scaling a level until it bounds the body, and drawing its vertices back along their rays.

use super::surface::{DobkinKirkpatrick, place_of};
use crate::base::error::Result;
use crate::base::math::Vector;
use crate::base::memory::{extend, filled, push, with_capacity};

/// Sliding ends where no vertex gains more than this fraction of what scaling has moved the farthest one by.
const LEAST_SLIDE: f64 = 1e-2;

/// Slides for each triangle at most; one or two are common.
const MOST_SLIDES: usize = 32;

/// The conditions that the triangles of a level put on the x of their corners a, b, c, each by its coefficients α, β, γ.
pub(super) struct Conditions {
    /// α·x_a + β·x_b + γ·x_c ≤ 1 for the body's vertices in the region of triangle t: `bounds[starts[t]..starts[t + 1]]`.
    bounds: Vec<[f64; 3]>,
    starts: Vec<u32>,
    /// α·x_a + β·x_b + γ·x_c ≤ x_d for the vertex d beyond each edge of each triangle.
    beyond: Vec<[(u32, [f64; 3]); 3]>,
}

/// The cone of a triangle from the centre of mass, to find coefficients of points in.
pub(super) struct Cone {
    /// Normals of its sides, each opposite to a corner.
    sides: [Vector; 3],
    volume: f64,
}

impl Cone {
    /// α, β, γ with q = α·r_a + β·r_b + γ·r_c for the corners of the triangle.
    pub(super) fn coefficients(&self, q: &Vector) -> [f64; 3] {
        self.sides.map(|side| side.dot(q) / self.volume)
    }
}

impl DobkinKirkpatrick<'_> {
    /// The cone of a triangle.
    pub(super) fn cone(&self, t: u32) -> Cone {
        let [a, b, c] = self.triangles[t as usize].corners.map(|v| &self.rays[v as usize]);
        let sides = [b.cross(c), c.cross(a), a.cross(b)];
        Cone { volume: sides[0].dot(a), sides }
    }

    /// The linear conditions of a level; see the head of [`super`].
    pub(super) fn conditions(&self) -> Result<Conditions> {
        debug_assert!(self.triangles.iter().all(|triangle| !triangle.is_free));
        let count = self.triangles.len();
        let mut conditions = Conditions {
            bounds: with_capacity(self.rays.len())?,
            starts: with_capacity(count + 1)?,
            beyond: with_capacity(count)?,
        };
        for (t, triangle) in (0..).zip(&self.triangles) {
            conditions.starts.push(conditions.bounds.len() as u32);
            let cone = self.cone(t);
            let coefficients = |q: u32| cone.coefficients(&self.rays[q as usize]);
            extend(&mut conditions.bounds, self.region(triangle.region).map(coefficients))?;
            conditions.beyond.push([0, 1, 2].map(|k| {
                let opposite = self.opposite(triangle.neighbours[k], triangle.corners[(k + 1) % 3]);
                (opposite, coefficients(opposite))
            }));
        }
        conditions.starts.push(conditions.bounds.len() as u32);
        Ok(conditions)
    }

    /// The x of each vertex that is left after scaling and relaxation: from 1/factor for all, again and again the vertices slide
    /// that can slide far: at first those that can slide by a quarter of what scaling has moved the farthest one by, then by a
    /// sixteenth, and so on. They do so in sweeps along the curve that vertices are in order of: to let always the one slide that
    /// can slide farthest brings the level no nearer to the body, and jumps about in memory. The factor is the one about the centre
    /// of mass that makes the hull of the vertices that are left bound the body.
    pub(super) fn relaxed(&self, conditions: &Conditions) -> Result<Vec<f64>> {
        debug_assert_eq!(conditions.starts.len(), self.triangles.len() + 1);
        let sums = conditions.bounds.iter().map(|cone| cone.iter().sum());
        let factor = sums.fold(1.0, f64::max);
        let mut x = filled(1.0 / factor, self.rays.len())?;
        let farthest = (factor - 1.0) * self.base.mass.radius;
        let least = LEAST_SLIDE * farthest;
        // For each vertex how far it can slide, and to which x; NaN where that has to be found out anew.
        let mut slides = filled((f64::NAN, 0.0), self.rays.len())?;
        let mut star = Vec::new();
        let mut slides_left = MOST_SLIDES * self.triangle_count;
        let mut threshold = farthest;
        let (mut round, mut dirty) = (Vec::new(), Vec::new());
        while threshold > least {
            threshold = (0.25 * threshold).max(least);
            extend(&mut round, self.left.iter().copied().filter(|v| !(slides[*v as usize].0 <= threshold)))?;
            while !round.is_empty() {
                for &v in &round {
                    let (mut slide, mut limit) = slides[v as usize];
                    if slide <= threshold {
                        continue;
                    }
                    self.star(v, &mut star)?;
                    if slide.is_nan() {
                        limit = self.limit(&x, v, &star, conditions);
                        slide = self.rays[v as usize].norm() * (1.0 / x[v as usize] - 1.0 / limit);
                        slides[v as usize] = (slide, limit);
                    }
                    if !(slide > threshold) {
                        continue;
                    }
                    if slides_left == 0 {
                        return Ok(x);
                    }
                    slides_left -= 1;
                    x[v as usize] = limit;
                    slides[v as usize].0 = 0.0;
                    for &t in &star {
                        let next = (place_of(&self.triangles[t as usize], v) + 1) % 3;
                        for w in [self.triangles[t as usize].corners[next], conditions.beyond[t as usize][next].0] {
                            // One that is to be looked at anew already has its turn later in this sweep or in the next.
                            if !slides[w as usize].0.is_nan() {
                                slides[w as usize].0 = f64::NAN;
                                push(&mut dirty, w)?;
                            }
                        }
                    }
                }
                std::mem::swap(&mut round, &mut dirty);
                dirty.clear();
                round.sort_unstable();
            }
        }
        Ok(x)
    }

    /// The largest x of a vertex that the others allow, at least its own.
    fn limit(&self, x: &[f64], v: u32, star: &[u32], conditions: &Conditions) -> f64 {
        debug_assert_eq!(x.len(), self.rays.len());
        let at = |w: u32| x[w as usize];
        let mut limit = 1.0_f64;
        for &t in star {
            let triangle = &self.triangles[t as usize];
            let [first, end] = [0, 1].map(|i| conditions.starts[t as usize + i] as usize);
            let bounds = &conditions.bounds[first..end];
            let k = place_of(triangle, v);
            let [next, last] = [(k + 1) % 3, (k + 2) % 3];
            let [b, c] = [at(triangle.corners[next]), at(triangle.corners[last])];
            for cone in bounds {
                if cone[k] > 0.0 {
                    limit = limit.min((1.0 - cone[next] * b - cone[last] * c) / cone[k]);
                }
            }
            // The vertex beyond the edge to `next` stays below this triangle. Both triangles of an edge say the same.
            let (d, cone) = conditions.beyond[t as usize][k];
            if cone[k] > 0.0 {
                limit = limit.min((at(d) - cone[next] * b - cone[last] * c) / cone[k]);
            }
        }
        // Not f64::max: a NaN of a degenerate cone must not spread.
        if limit > at(v) { limit } else { at(v) }
    }
}
