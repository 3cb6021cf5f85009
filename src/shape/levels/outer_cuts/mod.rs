//! Levels of detail cut out of a block: planes that touch the body take off, again and again, the corner that stands off farthest.
//!
//! Scaling a simplified body until it bounds the original inflates thin bodies absurdly, because the factor that their narrow sides
//! need applies to all of them. Cutting from outside has no such factor: each level is an intersection of supporting
//! half-spaces, and how far it stands off is known at every moment.
//!
//! The level under construction is kept as its *polar dual*: the half-space q·y ≤ 1 is the point q, and the level's vertices
//! are the triangles of the hull of those points. A cut adds a point to that hull (the step of an incremental hull, as in
//! `body/build/hull`), and the signs that decide which triangles it replaces are exact, so that the surface stays a surface
//! however the planes lie. The coordinates y are those in which the body's covariance is the identity. There every convex body
//! holds a ball and lies in one three times as large (R. Kannan, L. Lovász, M. Simonovits, "Isoperimetric Problems for Convex
//! Bodies and a Localization Lemma", Discrete & Computational Geometry 13, 1995, theorem 4.1): needles and wafers are as good
//! as balls.
//!
//! All floating point here only steers. A level's guarantee, that it contains the body, is checked exactly at the end.

mod isotropy;
mod cuts;

use crate::base::error::Result;
use crate::base::math::Vector;
use crate::base::memory::push;
use crate::base::progress::Progress;
use crate::body::polyhedron::Polyhedron;
use cuts::{Block, Cuts};

/// Blocks to begin with: the planes of a box, an octahedron, a rhombic dodecahedron and a regular dodecahedron. Each is given by
/// one normal; the others have the same components in cyclic order and with any signs.
const BLOCKS: [[f64; 3]; 4] = [[1.0, 0.0, 0.0], [1.0, 1.0, 1.0], [0.0, 1.0, 1.0], [0.0, 1.0, GOLDEN_RATIO]];

/// Up to so many planes it matters where the first ones lie. On 28 bodies no block was better than the box in the geometric
/// mean from 18 planes on, but each was better by a third and more on some (2026-11).
const FEW_PLANES: usize = 48;

/// (1 + √5)/2.
const GOLDEN_RATIO: f64 = 1.618_033_988_749_895;

/// Levels around `base` with the given numbers of planes, ascending: the coarsest first. A level of F planes has at most 2F − 4
/// vertices and 3F − 6 edges (and more but tiny faces where several planes meet almost in a point). The last level has fewer
/// planes, and no more follow, where those bound the body to within 10⁻⁹ of its radius; there are none for a body without
/// interior. A level of at most 48 planes is the best of several; each of those with more planes lies in all with fewer.
///
/// Every level contains `base` exactly, the vertices of both in the centred coordinates of `base`, whose `centre` is 0. The result
/// depends on the arguments and the machine's vector units, which round differently.
///
/// Time in proportion to the planes, about eight queries for the distance of a point each, and for each level that of building it.
///
/// # Errors
/// [`Error::Cancelled`](crate::base::error::Error::Cancelled), [`Error::Memory`](crate::base::error::Error::Memory).
pub fn outer_cuts(base: &Polyhedron, plane_counts: &[usize], progress: &mut Progress) -> Result<Vec<Polyhedron>> {
    debug_assert!(plane_counts.is_sorted());
    let mut levels = Vec::new();
    let Some(block) = Block::new(base)? else {
        return Ok(levels);
    };
    let most = plane_counts.last().copied().unwrap_or(0);
    let mut started: Vec<Cuts> = Vec::new();
    let mut start = 0.0;
    for &count in plane_counts {
        let end = count as f64 / most as f64;
        let mut part = progress.part(start, end);
        start = end;
        let blocks = if count > FEW_PLANES { 1 } else { BLOCKS.len() };
        if started.is_empty() {
            for normal in &BLOCKS[..blocks] {
                started.extend(Cuts::new(&block, &directions(*normal))?);
            }
        }
        if started.is_empty() {
            return Ok(levels);
        }
        started.truncate(blocks);
        let mut best = (f64::INFINITY, 0, true);
        for (i, cuts) in started.iter_mut().enumerate() {
            let goes_on =
                cuts.cut_to(count, &mut part.part(i as f64 / blocks as f64, (i + 1) as f64 / blocks as f64))?;
            let deviation = if cuts.plane_count() <= count { cuts.deviation() } else { f64::INFINITY };
            if !goes_on || i == 0 || deviation < best.0 {
                best = (deviation, i, goes_on);
            }
            if !goes_on {
                break;
            }
        }
        let (_, chosen, goes_on) = best;
        if let Some(level) = started[chosen].level()? {
            push(&mut levels, level)?;
        }
        if !goes_on {
            break;
        }
    }
    progress.report(1.0)?;
    Ok(levels)
}

/// All normals of a block.
fn directions(normal: [f64; 3]) -> Vec<Vector> {
    let mut all: Vec<Vector> = Vec::new();
    for shift in 0..3 {
        for signs in 0..8 {
            let signed = |k: usize| if signs >> k & 1 == 0 { normal[k] } else { -normal[k] };
            let direction = Vector::from_fn(|row, _| signed((row + shift) % 3)).normalize();
            if !all.contains(&direction) {
                all.push(direction);
            }
        }
    }
    all
}
