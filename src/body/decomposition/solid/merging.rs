//! Pieces joined while their hulls stay within the tolerance.

use crate::base::error::Result;
use crate::base::memory::{collected, copied, extend, filled, push};
use crate::base::progress::Progress;
use crate::body::decomposition::solid::solid_piece::{ALL, BodyCheck, SolidPiece};

/// Two pieces, and how much larger their hull is than both.
struct PieceUnion {
    pieces: [usize; 2],
    excess: f64,
}

/// Joins pairs, the least excess of volume first, until no pair is left whose hull is within the tolerance.
pub fn merge(pieces: Vec<SolidPiece>, check: &mut BodyCheck, progress: &mut Progress) -> Result<Vec<SolidPiece>> {
    let mut pieces: Vec<Option<SolidPiece>> = collected(pieces.into_iter().map(Some))?;
    let mut unions = Vec::new();
    // The pieces with which each was tried in vain: a larger hull has the same point beyond the tolerance.
    let mut foes: Vec<Vec<usize>> = filled(Vec::new(), pieces.len())?;
    for k in 1..pieces.len() {
        list_unions(&pieces[..=k], &[], check, &mut unions)?;
        progress.steps(64 * k, 0, ALL)?;
    }
    check.done = 0;
    let mut most = unions.len();
    loop {
        // The least at the end.
        unions.sort_by(|a: &PieceUnion, b: &PieceUnion| b.excess.total_cmp(&a.excess));
        let Some(union) = unions.pop() else { break };
        most = most.max(unions.len());
        check.done = check.done.max((ALL as f64 * (1.0 - unions.len() as f64 / most as f64)) as usize);
        let [i, k] = union.pieces;
        let [Some(a), Some(b)] = [&pieces[i], &pieces[k]] else { continue };
        let Some(hull) = hull_of(a, b)? else { continue };
        if check.point_beyond(&hull, &[a, b], progress)?.is_some() {
            push(&mut foes[i], k)?;
            push(&mut foes[k], i)?;
            continue;
        }
        unions.retain(|other| !other.pieces.iter().any(|piece| union.pieces.contains(piece)));
        (pieces[i], pieces[k]) = (None, None);
        push(&mut pieces, Some(hull))?;
        let both = collected(foes[i].iter().chain(&foes[k]).copied())?;
        both.iter().try_for_each(|foe| push(&mut foes[*foe], pieces.len() - 1))?;
        list_unions(&pieces, &both, check, &mut unions)?;
        push(&mut foes, both)?;
    }
    collected(pieces.into_iter().flatten())
}

fn hull_of(a: &SolidPiece, b: &SolidPiece) -> Result<Option<SolidPiece>> {
    let mut corners = copied(&a.corners)?;
    extend(&mut corners, b.corners.iter().copied())?;
    SolidPiece::new(&corners)
}

/// Appends the unions of the last piece with those before it, but for its foes.
fn list_unions(
    pieces: &[Option<SolidPiece>],
    foes: &[usize],
    check: &BodyCheck,
    unions: &mut Vec<PieceUnion>,
) -> Result<()> {
    let Some((Some(piece), before)) = pieces.split_last() else { return Ok(()) };
    for (i, other) in before.iter().enumerate() {
        let Some(other) = other.as_ref().filter(|_| !foes.contains(&i)) else { continue };
        // The hull of pieces farther apart has a point beyond the tolerance, unless a third is between them.
        if (piece.low - other.high).sup(&(other.low - piece.high)).max() > 2.0 * check.tolerance {
            continue;
        }
        if let Some(hull) = hull_of(piece, other)? {
            push(unions, PieceUnion { pieces: [i, before.len()], excess: hull.volume - piece.volume - other.volume })?;
        }
    }
    Ok(())
}
