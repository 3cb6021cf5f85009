//! The options and the answer of a depth query: plain data, laid out for C.

use crate::answer::{Feature, Outcome, check_accuracy};
use crate::base::error::Result;

/// The options of a depth query.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DepthConfig {
    /// `upper − lower` may be as large as this …
    pub absolute_error: f64,
    /// … or as this times `lower`. Both 0 (the default): as narrow as double precision can prove.
    pub relative_error: f64,
    /// Expansions after which the query stops with its current result, 1 or more; UINT32_MAX (the default): no limit but the
    /// library's own, 400. The rest of the verdict is still decided, in integers.
    pub step_budget: u32,
}

impl Default for DepthConfig {
    fn default() -> Self {
        DepthConfig { absolute_error: 0.0, relative_error: 0.0, step_budget: u32::MAX }
    }
}

impl DepthConfig {
    /// Refuses values out of range.
    ///
    /// # Errors
    /// [`Error::Argument`](crate::base::error::Error::Argument), naming the first such member.
    #[inline]
    pub(crate) fn check(&self) -> Result<()> {
        check_accuracy(self.absolute_error, self.relative_error, self.step_budget)
    }
}

/// How a depth query ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[repr(i32)]
pub enum DepthEnding {
    /// Nothing was asked yet.
    #[default]
    None = 0,
    /// The interval is as narrow as was asked for, or as double precision can prove.
    Narrow = 1,
    /// A direction separates the objects.
    Separated = 2,
    /// Integer arithmetic decided what rounding hides: whether the objects are apart, touch or overlap. Touching is depth 0.
    Integers = 3,
    /// The step budget was spent; the interval holds.
    Budget = 4,
    /// No further vertex could be added to the proof: it has no room for more, or rounding hides where. The interval holds.
    Stalled = 5,
}

/// Work of a depth query.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[repr(C)]
pub struct DepthStatistics {
    /// Expansions of the proof.
    pub steps: u32,
    /// Support vertices asked for.
    pub supports: u32,
    /// Triangles of the proof.
    pub triangles: u32,
    /// Iterations in integer arithmetic, which allocates.
    pub exact_iterations: u32,
}

/// How deep two objects are in each other. Unset numbers are NaN, features of no kind.
///
/// The depth is the length of the shortest translation after which a plane has one object on either side: 0 of objects that touch,
/// and of flat ones that lie in one plane. Moving object 1 by `depth · normal`, or object 2 by the opposite, parts them, as far as
/// the interval is wide.
#[derive(Debug, Clone, Copy, PartialEq)]
#[repr(C)]
pub struct DepthAnswer {
    /// [`Outcome::Intersecting`] (touching included) or [`Outcome::Separated`]. Of separated objects only a normal that
    /// separates them is said, and a depth of 0.
    pub outcome: Outcome,
    /// How the query ended.
    pub ending: DepthEnding,
    /// The best estimate, `lower ≤ depth ≤ upper`.
    pub depth: f64,
    /// Lower end of the rigorous interval; more than 0 only for objects that overlap.
    pub lower: f64,
    /// Upper end of the rigorous interval; 0 only for objects that touch, or are separated.
    pub upper: f64,
    /// Witness point on object 1, in its local frame: among those that are deepest in object 2 along the normal.
    pub local1: [f64; 3],
    /// Witness point on object 2, in its local frame.
    pub local2: [f64; 3],
    /// Witness point on object 1, in the world frame; `world2 − world1` is `depth · normal` up to rounding.
    pub world1: [f64; 3],
    /// Witness point on object 2, in the world frame.
    pub world2: [f64; 3],
    /// Unit normal in the world frame, from object 2 to object 1, along which the objects overlap by `upper` at most.
    pub normal: [f64; 3],
    /// The feature of object 1 that holds its witness point.
    pub feature1: Feature,
    /// The feature of object 2 that holds its witness point.
    pub feature2: Feature,
    /// Work of the query.
    pub statistics: DepthStatistics,
}

/// Says nothing: no number of it reads as a depth.
impl Default for DepthAnswer {
    fn default() -> Self {
        const UNSAID: [f64; 3] = [f64::NAN; 3];
        DepthAnswer {
            outcome: Outcome::None,
            ending: DepthEnding::None,
            depth: f64::NAN,
            lower: f64::NAN,
            upper: f64::NAN,
            local1: UNSAID,
            local2: UNSAID,
            world1: UNSAID,
            world2: UNSAID,
            normal: UNSAID,
            feature1: Feature::default(),
            feature2: Feature::default(),
            statistics: DepthStatistics::default(),
        }
    }
}
