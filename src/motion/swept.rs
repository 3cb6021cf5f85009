//! The region that one object sweeps over in a range of times: its places at some of them, and how far it may be from these in
//! between.

use super::bound::{Travel, rounding_of_place};
use super::carried::Carried;
use super::config::check_times;
use super::path::Path;
use crate::base::error::Result;
use crate::base::math::{Pose, UNIT_ROUNDOFF as U};

/// A range of times is cut into parts in which no point bends away from its chord by more than this part of the body's radius …
const MOST_SAG: f64 = 0.25;

/// … and its centre goes no farther than this many radii, as boxes around long ways are mostly empty …
const MOST_TRAVEL: f64 = 4.0;

/// … but into no more parts.
const MOST_PARTS: u32 = 64;

/// An object in motion over a range of times.
pub(crate) struct Swept<'a> {
    body: Carried<'a>,
    path: Path<'a>,
    range: [f64; 2],
    parts: u32,
    /// No point of the motion is farther from the hull of where it is at both ends of a part.
    sag: f64,
}

/// The place of an object at one end of a part.
pub(crate) struct PartEnd {
    pub time: f64,
    pub pose: Pose,
    /// No point of the motion, in the parts that end here, is farther from the hull of both ends' poses.
    pub off: f64,
}

impl<'a> Swept<'a> {
    /// # Errors
    /// Those of the motion, same as for [`super::cast`]; [`Error::Argument`](crate::base::error::Error::Argument) for times out
    /// of range.
    pub fn new(body: Carried<'a>, range: [f64; 2]) -> Result<Swept<'a>> {
        check_times(range)?;
        body.motion.check()?;
        let path = Path::new(body.motion);
        let travel = Travel::new(&body, &path, range)?;
        // Within a time h a point stays within a·h²/8 of its chord, with a the largest acceleration.
        let most = travel.most_acceleration();
        let whole = most * (range[1] - range[0]).powi(2) / 8.0;
        let polyhedron = body.shape.polyhedron();
        let by_sag = (whole / (MOST_SAG * polyhedron.radius)).sqrt();
        let ends = [body.pose(&path, range[0])?, body.pose(&path, range[1])?];
        let way = ends[1].transform(&polyhedron.centre) - ends[0].transform(&polyhedron.centre);
        let wanted = by_sag.max(way.norm() / (MOST_TRAVEL * polyhedron.radius)).ceil();
        // False for a NaN, of a point that bends by nothing.
        let parts = if wanted > 1.0 { wanted.min(f64::from(MOST_PARTS)) as u32 } else { 1 };
        // Each time is off by u of itself and 2u of the range.
        let longest = (range[1] - range[0]) / f64::from(parts) + 8.0 * U * range[0].abs().max(range[1].abs());
        let sag = most * longest * longest / 8.0 * (1.0 + 32.0 * U) + travel.rounding;
        Ok(Swept { body, path, range, parts, sag })
    }

    /// Its places at the ends of the parts, the beginning first.
    ///
    /// # Errors
    /// [`Error::Pose`](crate::base::error::Error::Pose) for a pose that no query accepts.
    pub fn places(&self) -> impl Iterator<Item = Result<PartEnd>> {
        let [begin, end] = self.range;
        (0..=self.parts).map(move |k| {
            let time =
                if k == self.parts { end } else { begin + (end - begin) * (f64::from(k) / f64::from(self.parts)) };
            let pose = self.body.pose(&self.path, time)?;
            Ok(PartEnd { time, pose, off: (self.sag + rounding_of_place(&self.body, &pose)).next_up() })
        })
    }
}
