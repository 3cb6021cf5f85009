//! Contacts of two compounds: a manifold for each two pieces that meet.

use super::PlacedCompound;
use super::answer::{CompoundContact, CompoundContacts};
use super::between::{Between, Reaches};
use super::placed::{PlacedPieces, with_pieces};
use super::walk::{Aim, PiecePair, walk};
use crate::base::error::Result;
use crate::base::memory::push;
use crate::base::simd::environment::with_default;
use crate::manifold::{ManifoldCache, ManifoldConfig, add_points, manifold_into};
use crate::pair::Outcome;

/// The manifolds of all pairs of pieces up to `config.max_distance` apart, in order of the pieces, as [`crate::manifold::manifold`]
/// finds each with a cold cache. Pieces overlap where they join, so a body that rests on two of them may have points twice.
///
/// # Errors
/// As of [`crate::manifold::manifold`], and of [`distance`](super::distance) for poses; then `found` holds nothing.
pub fn contacts(bodies: [PlacedCompound; 2], config: &ManifoldConfig, found: &mut CompoundContacts) -> Result<()> {
    found.contacts.clear();
    found.points.clear();
    let bodies = bodies.map(|body| body.placed_pieces());
    let done = with_default(|| find(&bodies, config, found));
    if done.is_err() {
        found.contacts.clear();
        found.points.clear();
    }
    done
}

/// The pairs of pieces whose boxes do not show that they are farther apart than `max_distance`, in order; and a lower bound of the
/// signed distance of all others.
///
/// # Errors
/// As of [`distance`](super::distance) for poses; [`Error::Memory`](crate::base::error::Error::Memory).
pub(crate) fn near_pieces(bodies: &[PlacedPieces; 2], max_distance: f64) -> Result<(Vec<[u32; 2]>, f64)> {
    let between = Between::new(bodies, &Reaches::new(bodies)?);
    let mut near = Vec::new();
    let trees = bodies.map(|body| body.tree);
    let passed = walk(PiecePair { trees, between: &between, aim: Aim::Distance }, max_distance, |pieces| {
        push(&mut near, pieces)?;
        Ok(Some(max_distance))
    })?;
    near.sort_unstable();
    Ok((near, passed))
}

fn find(bodies: &[PlacedPieces; 2], config: &ManifoldConfig, found: &mut CompoundContacts) -> Result<()> {
    config.check()?;
    let (near, _) = near_pieces(bodies, config.max_distance)?;
    for pieces in near {
        let first_point = found.points.len() as u32;
        let mut cache = ManifoldCache::default();
        let manifold = with_pieces(bodies, pieces, |placed| {
            add_points(&mut found.points, |sink| manifold_into(placed, &mut cache, config, sink, None))
        })??;
        if manifold.outcome != Outcome::Beyond {
            let [piece1, piece2] = pieces;
            push(&mut found.contacts, CompoundContact { manifold, first_point, piece1, piece2 })?;
        }
    }
    Ok(())
}
