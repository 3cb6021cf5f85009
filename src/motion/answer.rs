//! The answer of a cast: plain data, laid out for C.

use crate::pair::PairAnswer;

/// How a cast came out.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[repr(i32)]
pub enum CastOutcome {
    /// Nothing is said yet: the value of a fresh answer.
    #[default]
    None = 0,
    /// Farther apart than `max_distance` at every time of the range.
    Free = 1,
    /// Farther apart than `max_distance` at every time before `time_lower` and at it, no farther than `max_distance` at
    /// `time_upper`. Both are the beginning where that is no farther. `time_upper` − `time_lower` is at most the time tolerance
    /// wherever contact can be proved so soon.
    Hit = 2,
    /// Farther apart than `max_distance` up to `time_lower`, and hardly farther there: the objects graze, and rounding hides
    /// whether they meet.
    Near = 3,
    /// The step budget ran out: farther apart than `max_distance` up to `time_lower`, and nothing is said of what follows.
    Budget = 4,
}

/// The answer to a cast. Unset numbers are NaN.
#[derive(Debug, Clone, Copy, PartialEq)]
#[repr(C)]
pub struct CastAnswer {
    /// How it came out.
    pub outcome: CastOutcome,
    /// Certified queries made.
    pub queries: u32,
    /// The objects are farther apart than `max_distance` from the beginning, or from `time_parted`, up to here; the end of the
    /// range if they are free.
    pub time_lower: f64,
    /// For a hit: a time at which they are no farther apart than `max_distance`.
    pub time_upper: f64,
    /// For free objects: their distance is at least this at every time of the range.
    pub clearance: f64,
    /// For a hit: their distance at `time_upper` is at most this, 0 if they intersect. For a near miss: the same at `time_lower`.
    pub upper: f64,
    /// For a start in contact that was ignored because the bodies part: they are farther apart than `max_distance` from this time
    /// on. Nothing is said of earlier times.
    pub time_parted: f64,
    /// For a hit or a near miss: the distance at `time_lower`, with witness points, normal and features, for the poses there as
    /// rounded. Next to a hit the distance is next to nothing; if one of the features is a face, the normal is that face's. For a
    /// hit that begins in contact: that contact.
    pub contact: PairAnswer,
    /// For a hit with a `max_distance` of 0: vertex pairs, in the caller's numbering. The hull of their differences at `time_upper`
    /// holds the origin.
    pub proof: [[u32; 2]; 4],
    /// How many entries of `proof` are used: 1 to 4; 0 if there is no such proof, as for objects that meet by their swept radii
    /// alone.
    pub proof_count: u32,
}

impl Default for CastAnswer {
    fn default() -> Self {
        CastAnswer {
            outcome: CastOutcome::None,
            queries: 0,
            time_lower: f64::NAN,
            time_upper: f64::NAN,
            clearance: f64::NAN,
            upper: f64::NAN,
            time_parted: f64::NAN,
            contact: PairAnswer::default(),
            proof: [[0; 2]; 4],
            proof_count: 0,
        }
    }
}
