//! The options of a cast.

use super::bound::LARGEST_TIME;
use crate::base::error::{Error, Result, check_range};
use crate::base::math::UNIT_ROUNDOFF as U;

/// The options of a cast.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CastConfig {
    /// The start of the range of times; by default 0.
    pub time_begin: f64,
    /// The end of the range, not before it begins; by default 1.
    pub time_end: f64,
    /// How wide the interval of a hit may be, and the shortest step; by default 1e-9. From 2⁻⁵⁰ of the larger end on.
    pub time_tolerance: f64,
    /// Objects are free where they are farther apart than this: from 0, the default, to the largest double.
    pub max_distance: f64,
    /// Certified queries after which it stops with its proved result, 1 or more; by default 100,000. It makes at most
    /// 60, then six for each time tolerance in the range, and a dozen in the end.
    pub step_budget: u32,
    /// Whether objects that are in contact at the beginning, and part within 1,024 time tolerances, are cast from where they have
    /// parted, [`time_parted`](super::CastAnswer::time_parted); by default such a start is a hit.
    pub ignores_parting: bool,
}

impl Default for CastConfig {
    fn default() -> Self {
        CastConfig {
            time_begin: 0.0,
            time_end: 1.0,
            time_tolerance: 1e-9,
            max_distance: 0.0,
            step_budget: 100_000,
            ignores_parting: false,
        }
    }
}

/// The shortest step over the larger end of a range.
const SHORTEST_STEP: f64 = 8.0 * U;

/// The shortest step that times in a range can resolve.
pub(super) fn shortest_step(range: [f64; 2]) -> f64 {
    (SHORTEST_STEP * range[0].abs().max(range[1].abs())).max(f64::MIN_POSITIVE)
}

/// Refuses a range of times that is empty or not finite.
///
/// # Errors
/// [`Error::Argument`], naming the end.
pub(super) fn check_times([begin, end]: [f64; 2]) -> Result<()> {
    check_range("time_begin", begin, -LARGEST_TIME..=LARGEST_TIME)?;
    check_range("time_end", end, -LARGEST_TIME..=LARGEST_TIME)?;
    if end < begin {
        return Err(Error::Argument(format!("time_end is {end:?}, before time_begin, {begin:?}")));
    }
    Ok(())
}

impl CastConfig {
    pub(crate) fn range(&self) -> [f64; 2] {
        [self.time_begin, self.time_end]
    }

    /// Refuses values out of range.
    ///
    /// # Errors
    /// [`Error::Argument`], naming the first such member.
    pub(crate) fn check(&self) -> Result<()> {
        check_times(self.range())?;
        check_range("time_tolerance", self.time_tolerance, shortest_step(self.range())..=f64::MAX)?;
        check_range("max_distance", self.max_distance, 0.0..=f64::MAX)?;
        if self.step_budget == 0 {
            return Err(Error::Argument("step_budget is 0, it must be at least 1".into()));
        }
        Ok(())
    }
}
