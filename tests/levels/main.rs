//! Levels of detail, and queries through them.

mod approximate;
mod errors;
mod hierarchy;
mod outer_cuts;
mod point_distance;
mod quadric;
