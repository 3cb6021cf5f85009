//! Decides which vertices of the merged faces are corners, and which lie inside a straight edge up to rounding.

use super::faces::MergedFaces;
use crate::base::error::Result;
use crate::base::math::Vector;
use crate::base::memory::{collected, copied, filled, listed, push, with_capacity};
use crate::base::progress::Progress;
use crate::body::polyhedron::triangulation::Triangulation;

/// Decides which vertices are corners: those where three or more faces meet, and as many of those where two meet as it takes to
/// stay within the bound of the boundary (U. Ramer, "An Iterative Procedure for the Polygonal Approximation of Plane
/// Curves", 1972).
///
/// # Errors
/// [`crate::base::error::Error::Cancelled`] when the caller does not want to go on.
pub fn straighten_edges(
    surface: &Triangulation,
    positions: &[Vector],
    faces: &mut MergedFaces,
    bound: f64,
    progress: &mut Progress,
) -> Result<()> {
    let degree = |v: u32| surface.around(v).iter().filter(|h| faces.is_boundary(surface, **h)).count();
    let mut degrees: Vec<usize> = with_capacity(positions.len())?;
    let all = 2 * positions.len();
    for v in 0..positions.len() as u32 {
        progress.steps(surface.around(v).len(), v as usize, all)?;
        degrees.push(degree(v));
    }
    let mut corners: Vec<bool> = collected(degrees.iter().map(|d| *d > 2))?;
    let mut on_chain = filled(false, positions.len())?;
    let chain_from = |first: u32, corners: &[bool]| -> Result<Vec<u32>> {
        let mut chain = listed([surface.tail(first), surface.head(first)]);
        let mut h = first;
        while !corners[surface.head(h) as usize] && surface.head(h) != chain[0] {
            h = faces.next_on_boundary(surface, h);
            push(&mut chain, surface.head(h))?;
        }
        Ok(chain)
    };
    let mut chains = Vec::new();
    for v in 0..positions.len() as u32 {
        progress.steps(surface.around(v).len(), positions.len() + v as usize, all)?;
        for &h in surface.around(v) {
            let middle = surface.head(h) as usize;
            if degrees[v as usize] > 2 && degrees[middle] == 2 && !on_chain[middle] && faces.is_boundary(surface, h) {
                let chain = chain_from(h, &corners)?;
                chain[1..chain.len() - 1].iter().for_each(|w| on_chain[*w as usize] = true);
                push(&mut chains, chain)?;
            }
        }
    }
    for chain in &chains {
        keep_bends(positions, chain, bound, &mut corners, progress)?;
    }
    // The rest are two faces that share their whole boundary: a flat body.
    for v in 0..positions.len() as u32 {
        if degrees[v as usize] == 2 && !on_chain[v as usize] {
            let Some(&h) = surface.around(v).iter().find(|h| faces.is_boundary(surface, **h)) else {
                continue;
            };
            let closed = chain_from(h, &corners)?;
            closed.iter().for_each(|w| on_chain[*w as usize] = true);
            keep_bends_of_polygon(positions, &closed, bound, &mut corners, progress)?;
            push(&mut chains, closed)?;
        }
    }
    faces.corners = corners;

    // A face that is thinner than the bound keeps its corners all the same: a polygon has three.
    let mut side_counts = filled(0_u32, faces.normals.len())?;
    for h in 0..surface.twins.len() as u32 {
        if faces.is_boundary(surface, h) && faces.corners[surface.tail(h) as usize] {
            side_counts[faces.left(h) as usize] += 1;
        }
    }
    for chain in chains {
        let touches_thin_face = |v: u32| surface.around(v).iter().any(|h| side_counts[faces.left(*h) as usize] < 3);
        if chain.iter().any(|v| degrees[*v as usize] == 2 && touches_thin_face(*v)) {
            chain.iter().for_each(|v| faces.corners[*v as usize] = true);
        }
    }
    Ok(())
}

/// Marks the inner vertices of a chain that are needed to stay within the bound of it; its ends are corners.
fn keep_bends(
    positions: &[Vector],
    chain: &[u32],
    bound: f64,
    corners: &mut [bool],
    progress: &mut Progress,
) -> Result<()> {
    let mut parts = listed([(0, chain.len() - 1)]);
    while let Some((first, last)) = parts.pop() {
        progress.steps(last - first, 1, 1)?;
        let a = &positions[chain[first] as usize];
        let b = &positions[chain[last] as usize];
        let direction = b - a;
        let length = direction.norm();
        let distance = |v: u32| {
            let offset = positions[v as usize] - a;
            let along = offset.dot(&direction);
            if along < 0.0 || along > length * length {
                f64::INFINITY // beyond the ends: a fold, not a straight edge
            } else {
                offset.cross(&direction).norm() / length
            }
        };
        let farthest = (first + 1..last)
            .map(|i| (i, distance(chain[i])))
            .reduce(|best, other| if other.1 > best.1 { other } else { best });
        if let Some((i, distance)) = farthest
            && (distance > bound || distance.is_nan())
        {
            corners[chain[i] as usize] = true;
            push(&mut parts, (first, i))?;
            push(&mut parts, (i, last))?;
        }
    }
    Ok(())
}

/// The same for a closed chain, whose first vertex comes again as its last. The lexicographically first vertex and the one
/// farthest from it are corners of the convex polygon.
fn keep_bends_of_polygon(
    positions: &[Vector],
    closed: &[u32],
    bound: f64,
    corners: &mut [bool],
    progress: &mut Progress,
) -> Result<()> {
    let mut ring = copied(&closed[1..])?;
    let key = |v: &u32| positions[*v as usize];
    let first = (0..ring.len())
        .min_by(|i, j| {
            let (p, q) = (key(&ring[*i]), key(&ring[*j]));
            (p.x.total_cmp(&q.x)).then(p.y.total_cmp(&q.y)).then(p.z.total_cmp(&q.z))
        })
        .unwrap_or(0);
    ring.rotate_left(first);
    let distance = |v: &u32| (key(v) - key(&ring[0])).norm_squared();
    let far = (1..ring.len()).max_by(|i, j| distance(&ring[*i]).total_cmp(&distance(&ring[*j]))).unwrap_or(0);
    corners[ring[0] as usize] = true;
    corners[ring[far] as usize] = true;
    let again = ring[0];
    push(&mut ring, again)?;
    keep_bends(positions, &ring[..=far], bound, corners, progress)?;
    keep_bends(positions, &ring[far..], bound, corners, progress)
}
