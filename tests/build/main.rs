//! From points and polygons to a polyhedron.

mod hull;
mod hull_check;
mod hull_work;
mod polyhedron;
