//! All that is proved of the library, named in one place.

pub use swiftprox::base::angles::{cosine, reduced, sine};
pub use swiftprox::base::double_double::{DoubleDouble, two_product, two_sum, wide_dot};
pub use swiftprox::base::math::{Pose, UNIT_ROUNDOFF as U, Vector, orthonormality, rotated};
pub use swiftprox::base::normal::over_length;
pub use swiftprox::base::predicates::{
    DOUBLE_DOUBLE_FILTER, FILTER, height_and_spread, normal_and_permanent, wide_height,
};
pub use swiftprox::base::scalar::{Scalar, determinant, dot};
pub use swiftprox::base::simd::{Lanes, Portable, Work};
pub use swiftprox::body::build::assembly::build;
pub use swiftprox::body::build::slack::{HEIGHT, height_and_magnitude};
pub use swiftprox::body::polyhedron::PlaneBlock;
pub use swiftprox::body::polyhedron::Polyhedron;
pub use swiftprox::body::polyhedron::fan::PointBlock;
pub use swiftprox::depth::facets::placed::PlacedFan;
pub use swiftprox::depth::facets::{NODE, NORMAL, ON_ARC, SUPPORT};
pub use swiftprox::depth::polytope::{HEIGHTS, PairRounding, Polytope, evaluate, heights, rounding};
pub use swiftprox::distance::certificate::{
    DIRECTION_ERROR, Interval, REMAINDER, RIGID_MISFIT, beside, beside_one, ends, reciprocal_length,
};
pub use swiftprox::distance::enclosure::{determinant_error, encloses_origin, length_above};
pub use swiftprox::distance::gjk::{COMBINATION, EXCESS, height_over, plus_weighted};
pub use swiftprox::distance::marching::{
    between_feet, correction, error_along, from_foot, misfit_across_edge, misfit_between_edges, projected,
};
pub use swiftprox::motion::bound::{LEAST_BETWEEN, OF_ANGLE, OF_TURN, least_within};
pub use swiftprox::motion::turn::{angle, axis_and_speed, crossed, entry, versine};
pub use swiftprox::pair::{
    NearestOfRound, ends_of_points, ends_of_segments, shrunk, square_between, square_of_rigid, together,
};
pub use swiftprox::placed::Pair;
pub use swiftprox::placed::frame::{
    Frame, RIGID, RIGID_DEFECT, RIGID_TOGETHER, difference_error, rest_of, separation, sum_of, tolerance,
};
pub use swiftprox::placed::voronoi::{plane_slopes, plane_values};
pub use swiftprox::ray::SIDE;
pub use swiftprox::verify::{CLEAR, ERROR, over_both, plus_difference, turned};
