//! All that is proved of the library, named in one place.

pub use swiftprox::base::double_double::{DoubleDouble, two_product, two_sum, wide_dot};
pub use swiftprox::base::math::{Pose, ROTATION_LIMIT, UNIT_ROUNDOFF as U, Vector, orthonormality, rotated};
pub use swiftprox::base::normal::over_length;
pub use swiftprox::base::predicates::{
    DOUBLE_DOUBLE_FILTER, FILTER, height_and_spread, normal_and_permanent, wide_height,
};
pub use swiftprox::base::scalar::{Scalar, determinant, dot};
pub use swiftprox::base::simd::{Lanes, Portable, Work};
pub use swiftprox::build::assembly::build;
pub use swiftprox::build::slack::{HEIGHT, height_and_magnitude};
pub use swiftprox::motion::bound::{LEAST_BETWEEN, OF_ANGLE, OF_TURN, least_within};
pub use swiftprox::motion::turn::{axis_and_speed, cosine, half_angle, reduced, rotation_of, sine};
pub use swiftprox::pair::verify::{CLEAR, ERROR, over_both, plus_difference, turned};
pub use swiftprox::polyhedron::PlaneBlock;
pub use swiftprox::polyhedron::Polyhedron;
pub use swiftprox::polyhedron::fan::PointBlock;
pub use swiftprox::ray::SIDE;
pub use swiftprox::solve::certificate::{DIRECTION_ERROR, REMAINDER, RIGID_MISFIT, beside, beside_one, ends};
pub use swiftprox::solve::enclosure::{determinant_error, encloses_origin, length_above};
pub use swiftprox::solve::facets::placed::PlacedFan;
pub use swiftprox::solve::facets::{NODE, NORMAL, ON_ARC, SUPPORT};
pub use swiftprox::solve::frame::{
    Frame, RIGID, RIGID_DEFECT, RIGID_TOGETHER, difference_error, separation, sum_of, tolerance,
};
pub use swiftprox::solve::gjk::{COMBINATION, EXCESS, height_over, plus_weighted};
pub use swiftprox::solve::marching::{
    between_feet, correction, error_along, from_foot, misfit_across_edge, misfit_between_edges, projected,
};
pub use swiftprox::solve::polytope::{HEIGHTS, Polytope, Pyramid, Rounding, evaluate, heights, rounding};
pub use swiftprox::solve::voronoi::{plane_slopes, plane_values};
