//! Pieces joined while their hulls stay within the tolerance.

use crate::base::error::Result;
use crate::base::memory::{collected, copied, extend, push};
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
    for k in 1..pieces.len() {
        list_unions(&pieces, k, check, &mut unions)?;
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
        let [Some(a), Some(b)] = union.pieces.map(|k| pieces[k].as_ref()) else { continue };
        let Some(hull) = hull_of(a, b)? else { continue };
        if check.point_beyond(&hull, &[a, b], progress)?.is_some() {
            continue;
        }
        unions.retain(|other| !other.pieces.iter().any(|k| union.pieces.contains(k)));
        union.pieces.iter().for_each(|k| pieces[*k] = None);
        push(&mut pieces, Some(hull))?;
        list_unions(&pieces, pieces.len() - 1, check, &mut unions)?;
    }
    collected(pieces.into_iter().flatten())
}

fn hull_of(a: &SolidPiece, b: &SolidPiece) -> Result<Option<SolidPiece>> {
    let mut corners = copied(&a.corners)?;
    extend(&mut corners, b.corners.iter().copied())?;
    SolidPiece::new(&corners)
}

/// Appends the unions of piece `k` with those before it.
fn list_unions(
    pieces: &[Option<SolidPiece>],
    k: usize,
    check: &BodyCheck,
    unions: &mut Vec<PieceUnion>,
) -> Result<()> {
    let Some(piece) = &pieces[k] else { return Ok(()) };
    for (i, other) in pieces[..k].iter().enumerate() {
        let Some(other) = other else { continue };
        // The hull of pieces farther apart has a point beyond the tolerance, unless a third is between them.
        if (piece.low - other.high).sup(&(other.low - piece.high)).max() > 2.0 * check.tolerance {
            continue;
        }
        if let Some(hull) = hull_of(piece, other)? {
            push(unions, PieceUnion { pieces: [i, k], excess: hull.volume - piece.volume - other.volume })?;
        }
    }
    Ok(())
}
