//! Patches that grow over neighbouring triangles as long as their hulls are allowed.

use std::collections::VecDeque;

use crate::base::error::Result;
use crate::base::math::Vector;
use crate::base::memory::{collected, extend, filled, lacking, push};
use crate::base::progress::Progress;
use crate::body::decomposition::separation::{HullOfPatch, SeparatingLine, Separation, near_separation};
use crate::body::decomposition::surface::{CutPlane, MeshSurface, NONE};

/// A box along the axes.
#[derive(Debug, Clone, Copy)]
struct PatchBounds {
    low: Vector,
    high: Vector,
}

impl PatchBounds {
    fn of(surface: &MeshSurface, vertices: &[u32]) -> PatchBounds {
        debug_assert!(!vertices.is_empty());
        let mut bounds = PatchBounds { low: Vector::repeat(f64::INFINITY), high: Vector::repeat(f64::NEG_INFINITY) };
        vertices.iter().for_each(|v| bounds.take_in(&surface.position[*v as usize]));
        bounds
    }

    fn take_in(&mut self, point: &Vector) {
        (self.low, self.high) = (self.low.inf(point), self.high.sup(point));
    }

    fn contains(&self, other: &PatchBounds) -> bool {
        (0..3).all(|k| self.low[k] <= other.low[k] && other.high[k] <= self.high[k])
    }

    /// Whether the other box has a point in the inside of this one, relative to its plane where it is flat.
    fn has_inside(&self, other: &PatchBounds) -> bool {
        (0..3).all(|k| match self.low[k] < self.high[k] {
            true => other.high[k] > self.low[k] && other.low[k] < self.high[k],
            false => other.high[k] >= self.low[k] && other.low[k] <= self.high[k],
        })
    }

    /// Grown on all sides by its longest one.
    fn grown(&self) -> PatchBounds {
        let longest = Vector::repeat((self.high - self.low).max());
        PatchBounds { low: self.low - longest, high: self.high + longest }
    }
}

/// Something that is not of the patch, and the reason why the patch's hull stays away from it, once that was queried.
struct Obstacle<Thing, Kept> {
    thing: Thing,
    kept_by: Option<Kept>,
    /// How many vertices the patch had then.
    vertex_count: usize,
}

impl<Thing, Kept> Obstacle<Thing, Kept> {
    fn new(thing: Thing) -> Self {
        Obstacle { thing, kept_by: None, vertex_count: 0 }
    }

    fn keep(&mut self, kept_by: Option<Kept>, vertex_count: usize) -> bool {
        (self.kept_by, self.vertex_count) = (kept_by, vertex_count);
        self.kept_by.is_some()
    }

    /// Forgets the result for a patch that did not come about: it may hold the whole of a smaller one.
    fn forget_beyond(&mut self, vertex_count: usize) {
        if self.vertex_count > vertex_count {
            self.kept_by = None;
        }
    }
}

/// An edge where the surface ends, or is folded onto itself: a flat hull must not pass over it.
#[derive(Debug, Clone, Copy)]
struct Rim {
    ends: [u32; 2],
    bounds: PatchBounds,
}

/// The patch that is growing.
struct GrowingPatch {
    triangles: Vec<u32>,
    vertices: Vec<u32>,
    /// The planes of its triangles.
    planes: Vec<CutPlane>,
    /// The normal of its seed.
    normal: Vector,
    is_flat: bool,
    is_solid: bool,
    bounds: PatchBounds,
    /// All obstacles and rims in it are listed.
    region: PatchBounds,
    obstacles: Vec<Obstacle<u32, Separation>>,
    rims: Vec<Obstacle<Rim, SeparatingLine>>,
}

/// The triangles that patches have taken.
pub struct PatchGrowth<'a> {
    surface: &'a MeshSurface,
    bounds: Vec<PatchBounds>,
    rims: Vec<Rim>,
    taken: Vec<bool>,
    /// The last seed from which each triangle was tried.
    tried: Vec<u32>,
    /// The last seed whose patch has each vertex.
    holder: Vec<u32>,
}

impl PatchGrowth<'_> {
    pub fn new(surface: &MeshSurface) -> Result<PatchGrowth<'_>> {
        Ok(PatchGrowth {
            surface,
            bounds: collected(surface.triangles.iter().map(|corners| PatchBounds::of(surface, corners)))?,
            rims: rims(surface)?,
            taken: filled(false, surface.triangles.len())?,
            tried: filled(NONE, surface.triangles.len())?,
            holder: filled(NONE, surface.position.len())?,
        })
    }

    pub fn is_taken(&self, triangle: u32) -> bool {
        self.taken[triangle as usize]
    }

    /// The triangles of the patch around a seed, which it takes. `done` triangles are taken.
    pub fn grow(&mut self, seed: u32, done: usize, progress: &mut Progress) -> Result<Vec<u32>> {
        debug_assert!(!self.taken[seed as usize]);
        let surface = self.surface;
        let corners = surface.triangles[seed as usize];
        let bounds = PatchBounds::of(surface, &corners);
        let mut patch = GrowingPatch {
            triangles: Vec::new(),
            vertices: Vec::new(),
            planes: Vec::new(),
            normal: surface.normal(corners),
            is_flat: true,
            is_solid: surface.is_solid[seed as usize],
            bounds,
            region: bounds.grown(),
            obstacles: Vec::new(),
            rims: Vec::new(),
        };
        extend(&mut patch.vertices, corners)?;
        corners.iter().for_each(|v| self.holder[*v as usize] = seed);
        self.list_obstacles(&mut patch)?;
        let mut open = VecDeque::new();
        self.take(seed, &mut patch, &mut open)?;
        self.tried[seed as usize] = seed;
        // One without area has no plane to be flat in.
        let grows = surface.doubled_area(seed as usize) > 0.0;
        while let Some(t) = open.pop_front().filter(|_| grows) {
            if self.taken[t as usize] || std::mem::replace(&mut self.tried[t as usize], seed) == seed {
                continue;
            }
            progress.steps(patch.obstacles.len() + patch.vertices.len(), done, surface.triangles.len())?;
            if self.admits(&mut patch, seed, t)? {
                self.take(t, &mut patch, &mut open)?;
            }
        }
        Ok(patch.triangles)
    }

    fn take(&mut self, t: u32, patch: &mut GrowingPatch, open: &mut VecDeque<u32>) -> Result<()> {
        debug_assert!(!self.taken[t as usize]);
        self.taken[t as usize] = true;
        push(&mut patch.triangles, t)?;
        push(&mut patch.planes, self.surface.plane(self.surface.triangles[t as usize]))?;
        open.try_reserve(3).map_err(|e| lacking::<u32>(open.len() + 3, &e))?;
        open.extend(
            self.surface.across[t as usize].iter().filter(|next| **next != NONE && !self.taken[**next as usize]),
        );
        Ok(())
    }

    /// Whether the patch may have a triangle at its border; if so it has its vertices then.
    fn admits(&mut self, patch: &mut GrowingPatch, seed: u32, t: u32) -> Result<bool> {
        let surface = self.surface;
        let corners = surface.triangles[t as usize];
        let fresh = corners.into_iter().find(|v| self.holder[*v as usize] != seed);
        let lies_in_plane = |v: u32| surface.side(&patch.planes[0], v) == 0.0;
        let is_level = corners.into_iter().all(lies_in_plane);
        let stays_flat = patch.is_flat && is_level;
        if !patch.is_solid && !stays_flat || stays_flat && surface.normal(corners).dot(&patch.normal) < 0.0 {
            return Ok(false);
        }
        let plane = surface.plane(corners);
        let rises = |plane: &CutPlane, v: u32| surface.side(plane, v) > 0.0;
        let is_convex = !patch.vertices.iter().any(|v| rises(&plane, *v))
            && !fresh.is_some_and(|v| patch.planes.iter().any(|plane| rises(plane, v)));
        if !is_convex {
            return Ok(false);
        }
        let bounds = patch.bounds;
        if let Some(v) = fresh {
            push(&mut patch.vertices, v)?;
            patch.bounds.take_in(&surface.position[v as usize]);
            if !patch.region.contains(&patch.bounds) {
                patch.region = patch.bounds.grown();
                self.list_obstacles(patch)?;
            }
        }
        let is_free =
            self.passes_obstacles(patch, t, fresh, stays_flat)? && (!stays_flat || self.passes_rims(patch, fresh)?);
        if is_free {
            patch.is_flat = stays_flat;
            fresh.iter().for_each(|v| self.holder[*v as usize] = seed);
        } else if fresh.is_some() {
            patch.vertices.pop();
            patch.bounds = bounds;
            let count = patch.vertices.len();
            patch.obstacles.iter_mut().for_each(|obstacle| obstacle.forget_beyond(count));
            patch.rims.iter_mut().for_each(|rim| rim.forget_beyond(count));
        }
        Ok(is_free)
    }

    /// All that is in the region of the patch.
    fn list_obstacles(&self, patch: &mut GrowingPatch) -> Result<()> {
        let near = (0..).zip(&self.bounds).filter(|(_, bounds)| patch.region.has_inside(bounds));
        patch.obstacles = collected(near.map(|(triangle, _)| Obstacle::new(triangle)))?;
        let near = self.rims.iter().filter(|rim| patch.region.has_inside(&rim.bounds));
        patch.rims = collected(near.map(|rim| Obstacle::new(*rim)))?;
        Ok(())
    }

    /// Whether no triangle but those of the patch, and `t`, passes through its hull. A flat hull may lie on others of its plane:
    /// they are of the surface, as it is.
    fn passes_obstacles(&self, patch: &mut GrowingPatch, t: u32, fresh: Option<u32>, stays_flat: bool) -> Result<bool> {
        let surface = self.surface;
        let GrowingPatch { obstacles, vertices, planes, bounds, triangles, .. } = patch;
        let seed = triangles[0];
        let mut hull = None;
        for obstacle in obstacles.iter_mut() {
            let triangle = obstacle.thing as usize;
            let is_own = obstacle.thing == t || self.taken[triangle] && self.tried[triangle] == seed;
            if is_own || !bounds.has_inside(&self.bounds[triangle]) {
                continue;
            }
            if obstacle.kept_by.is_some_and(|kept| fresh.is_none_or(|v| kept.is_kept_by(surface, v))) {
                continue;
            }
            let corners = surface.triangles[triangle];
            if stays_flat && corners.iter().all(|v| surface.side(&planes[0], *v) == 0.0) {
                continue;
            }
            let mut found = near_separation(surface, planes, vertices, corners);
            if found.is_none() {
                if hull.is_none() {
                    hull = Some(HullOfPatch::new(surface, vertices)?);
                }
                found = hull.as_ref().and_then(|hull| hull.separation(surface, vertices, corners));
            }
            if !obstacle.keep(found, vertices.len()) {
                return Ok(false);
            }
        }
        Ok(true)
    }

    /// Whether the hull of a patch that stays flat passes over no rim.
    fn passes_rims(&self, patch: &mut GrowingPatch, fresh: Option<u32>) -> Result<bool> {
        let surface = self.surface;
        let GrowingPatch { rims, vertices, triangles, planes, normal, bounds, .. } = patch;
        for rim in rims.iter_mut() {
            let Rim { ends, bounds: of_rim } = rim.thing;
            let is_in_plane = || ends.iter().all(|v| surface.side(&planes[0], *v) == 0.0);
            if rim.kept_by.is_some_and(|kept| fresh.is_none_or(|v| kept.is_kept_by(surface, v)))
                || !bounds.has_inside(&of_rim)
                || !is_in_plane()
            {
                continue;
            }
            let found = SeparatingLine::between(surface, *normal, vertices, triangles, ends);
            if !rim.keep(found, vertices.len()) {
                return Ok(false);
            }
        }
        Ok(true)
    }
}

/// The edges of triangles with area that have nothing beyond them, a triangle in the same plane that faces the other way, or one
/// without area, for which neither is known.
fn rims(surface: &MeshSurface) -> Result<Vec<Rim>> {
    let mut found = Vec::new();
    for (t, corners) in surface.triangles.iter().enumerate() {
        if surface.doubled_area(t) == 0.0 {
            continue;
        }
        let (plane, normal) = (surface.plane(*corners), surface.normal(*corners));
        for (k, next) in surface.across[t].into_iter().enumerate() {
            let is_rim = next == NONE || {
                let beyond = surface.triangles[next as usize];
                let is_level = beyond.iter().all(|v| surface.side(&plane, *v) == 0.0);
                is_level && surface.normal(beyond).dot(&normal) <= 0.0
            };
            if is_rim {
                let ends = [corners[k], corners[(k + 1) % 3]];
                push(&mut found, Rim { ends, bounds: PatchBounds::of(surface, &ends) })?;
            }
        }
    }
    Ok(found)
}
