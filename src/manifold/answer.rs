//! The options, the answer and the cache of a manifold query: plain data, laid out for C.

use crate::answer::{Feature, Outcome};
use crate::base::error::{Result, check_range};
use crate::depth::DepthCache;
use crate::pair::SignedDistanceCache;

/// The options of a manifold query.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ManifoldConfig {
    /// Objects up to this far apart have a manifold, and points with a gap of at most this belong to it; 0 is the default, infinity
    /// admits all.
    pub max_distance: f64,
    /// Whether of more than four points four are kept: the deepest, the farthest from it and the extremes on either side of the
    /// line between. None is moved. By default all are.
    pub reduces: bool,
}

impl Default for ManifoldConfig {
    fn default() -> Self {
        ManifoldConfig { max_distance: 0.0, reduces: false }
    }
}

impl ManifoldConfig {
    /// Refuses values out of range.
    ///
    /// # Errors
    /// [`Error::Argument`](crate::base::error::Error::Argument), naming the first such member.
    pub(crate) fn check(&self) -> Result<()> {
        check_range("max_distance", self.max_distance, 0.0..=f64::INFINITY)
    }
}

/// A pair's memory of its manifold. Any bytes are safe; all zero is cold. It changes how fast an answer comes, which of
/// several least directions is said, which of two faces that are about as parallel to it is the reference, and which four points of
/// many stay.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[repr(C)]
pub struct ManifoldCache {
    pub(crate) signed_distance: SignedDistanceCache,
    pub(super) reference: Reference,
}

impl ManifoldCache {
    /// The cached depth.
    pub(crate) fn depth(&self) -> &DepthCache {
        self.signed_distance.depth()
    }
}

/// What a manifold was made over, and what stayed of it. Any numbers are safe.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[repr(C)]
pub(crate) struct Reference {
    /// 1 or 2, the object whose patch was the reference; 0 if there was none.
    pub body: u32,
    /// Both objects' patches.
    pub patches: [u32; 2],
    /// Of a reduced manifold the keys of its points, in order.
    pub kept: [u32; FOUR],
}

impl Reference {
    /// There was none.
    pub const NONE: Reference = Reference { body: 0, patches: [0; 2], kept: [0; FOUR] };
}

/// How many points a reduced manifold has.
pub(super) const FOUR: usize = 4;

/// One contact point: a point of each object, in line along the normal.
///
/// Each is on its object, up to rounding and half of what a contact face is thick. They are in line up to 2^-27 of the pair's size
/// and twice what the contact faces of both are thick: a corner that is no farther outside the other's face has the nearest point
/// of that.
///
/// The gap is certified: each object has a point, no farther from the one that is said than it may be off, and the gap of these two
/// along the normal is in the interval. That holds in exact arithmetic, for the doubles of shapes, poses and normal. So an interval
/// never lies below, or above, the gaps of all points of the objects.
#[derive(Debug, Clone, Copy, PartialEq)]
#[repr(C)]
pub struct ManifoldPoint {
    /// On object 1, in its local frame.
    pub local1: [f64; 3],
    /// On object 2, in its local frame.
    pub local2: [f64; 3],
    /// On object 1, in the world frame.
    pub world1: [f64; 3],
    /// On object 2, in the world frame.
    pub world2: [f64; 3],
    /// The gap: how far the point on object 1 is from that on object 2 along the normal. At least this; negative where the objects
    /// overlap …
    pub gap_lower: f64,
    /// … and at most.
    pub gap_upper: f64,
    /// Feature that holds the point on object 1, in the caller's numbering.
    pub feature1: Feature,
    /// Feature that holds the point on object 2.
    pub feature2: Feature,
    /// Id made of the two features; it stays while they do.
    pub id: u64,
}

impl ManifoldPoint {
    /// The best estimate of the gap, in its interval: its middle.
    pub fn gap(&self) -> f64 {
        self.gap_lower + 0.5 * (self.gap_upper - self.gap_lower)
    }
}

/// No value is set.
impl Default for ManifoldPoint {
    fn default() -> Self {
        const UNSAID: [f64; 3] = [f64::NAN; 3];
        ManifoldPoint {
            local1: UNSAID,
            local2: UNSAID,
            world1: UNSAID,
            world2: UNSAID,
            gap_lower: f64::NAN,
            gap_upper: f64::NAN,
            feature1: Feature::default(),
            feature2: Feature::default(),
            id: 0,
        }
    }
}

/// Contact points of two objects that meet, or nearly do.
#[derive(Debug, Clone, Copy, PartialEq)]
#[repr(C)]
pub struct Manifold {
    /// [`Outcome::Intersecting`], [`Outcome::Separated`] within `max_distance`, or [`Outcome::Beyond`] it.
    pub outcome: Outcome,
    /// 1 or 2: the object whose face is the reference; 0 where no face is, and the manifold has but one point.
    pub reference: u32,
    /// The distance of the objects is at least this; of overlapping ones their depth is at most minus this.
    pub lower: f64,
    /// The distance is at most this; the depth at least minus this.
    pub upper: f64,
    /// Unit normal in the world frame, from object 2 to object 1: along which they are as far apart, or overlap as little, as the
    /// interval says.
    pub normal: [f64; 3],
    /// Points written.
    pub point_count: u32,
    /// Points found, before any were left out.
    pub found_count: u32,
}

/// No value is set.
impl Default for Manifold {
    fn default() -> Self {
        Manifold {
            outcome: Outcome::None,
            reference: 0,
            lower: f64::NAN,
            upper: f64::NAN,
            normal: [f64::NAN; 3],
            point_count: 0,
            found_count: 0,
        }
    }
}
