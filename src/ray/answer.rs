//! The answer of a ray cast: plain data, laid out for C.

use crate::pair::Feature;

/// Whether a ray meets a body.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[repr(i32)]
pub enum RayOutcome {
    /// No answer yet: the value of a fresh answer.
    #[default]
    None = 0,
    /// No point of the ray is in the body.
    Miss = 1,
    /// The ray enters the body, or touches it, from its origin on.
    Hit = 2,
    /// The ray begins in the body, at a place that is not the first of its line in it.
    Inside = 3,
    /// The deviation of a cylinder, cone or ellipsoid hides whether the ray meets it, or whether it begins in it. If it meets it,
    /// it enters and leaves within the intervals.
    Undecided = 4,
}

/// The part of a ray that is in a body, `entry ≤ t ≤ exit`. Unset numbers are NaN.
#[derive(Debug, Clone, Copy, PartialEq)]
#[repr(C)]
pub struct RayAnswer {
    /// Whether there is such a part.
    pub outcome: RayOutcome,
    /// Whether integers decided what rounding hides: 1 or 0. They allocate.
    pub exact: i32,
    /// `entry[0]` ≤ where it begins ≤ `entry[1]`; 0 from inside.
    pub entry: [f64; 2],
    /// `exit[0]` ≤ where it ends ≤ `exit[1]`: where the ray leaves the body, or `t_max` if that comes first.
    pub exit: [f64; 2],
    /// For a hit, the outward unit normal of the feature's face there, in the world frame, rounded. A segment or a point has no
    /// face, and the normal is against the ray. For a flat body met edge-on it is the normal of its plane. With a swept radius it
    /// is that of the round surface.
    pub normal: [f64; 3],
    /// For a hit, the face that the ray enters through; one of those that meet where it enters. A segment has an edge, a point a
    /// vertex. With a swept radius it is the vertex, edge or face of the body without the ball that is nearest to where the ray
    /// enters.
    pub feature: Feature,
    /// Faces that the search visited; with a swept radius vertices.
    pub steps: u32,
}

impl Default for RayAnswer {
    fn default() -> Self {
        RayAnswer {
            outcome: RayOutcome::None,
            exact: 0,
            entry: [f64::NAN; 2],
            exit: [f64::NAN; 2],
            normal: [f64::NAN; 3],
            feature: Feature::default(),
            steps: 0,
        }
    }
}
